//! The list of the frames of a run for ParaView, a .pvd file. The whole list is never in memory, because a run may have very many
//! frames.

use std::{
    fs::File,
    io::{self, BufRead, BufReader, BufWriter, Read, Seek, SeekFrom, Write},
    path::{Path, PathBuf},
};

use super::{commit_partial, write_partial};
use crate::error::{Error, Result};

const HEAD: &str = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n";
const TAIL: &str = "</Collection>\n</VTKFile>\n";

/// Writer of a list of frames. Each frame has a file for each of the parts.
pub(super) struct FrameIndex {
    path: PathBuf,
    /// Folder of the files, beside the list.
    folder: &'static str,
    parts: &'static [&'static str],
    /// Length of the list without its end, bytes; 0 if it was not written yet.
    length: u64,
}

impl FrameIndex {
    /// The writer of the list at `path` of files in the adjacent `folder`. Nothing is written yet.
    pub(super) fn new(path: PathBuf, folder: &'static str, parts: &'static [&'static str]) -> Self {
        Self { path, folder, parts, length: 0 }
    }

    /// Writes the list of frames at these `times` (s).
    ///
    /// # Errors
    /// `File` if it cannot be written; the old list remains.
    pub(super) fn write(&mut self, times: &[f64]) -> Result<()> {
        self.replace(None, times, 0)
    }

    /// Writes the list of frames at these `times` (s), of which only the last is new.
    ///
    /// # Errors
    /// As [`FrameIndex::write`].
    pub(super) fn append(&mut self, times: &[f64]) -> Result<()> {
        let whole = self.length + TAIL.len() as u64;
        let old = File::open(&self.path).ok().filter(|_| self.length > 0);
        let old = old.filter(|old| old.metadata().is_ok_and(|file| file.len() == whole));
        let first = if old.is_some() { times.len() - 1 } else { 0 };
        self.replace(old, times, first)
    }

    /// Replaces the list by a copy of the `old` list, if any, followed by the frames from number `first` on.
    fn replace(&mut self, old: Option<File>, times: &[f64], first: usize) -> Result<()> {
        let mut length = 0;
        write_partial(&self.path, |file| {
            length = match old {
                Some(old) => io::copy(&mut old.take(self.length), file)?,
                None => 0,
            };
            let mut out = BufWriter::new(file);
            length += write_entries(&mut out, first, &times[first..], self.folder, self.parts)?;
            out.flush()
        })?;
        self.length = length;
        commit_partial(&self.path)
    }
}

/// Writes the entries of frames from number `first` on at these `times` (s), and the end of the list. If `first` is 0, also
/// writes its beginning. Returns the number of bytes without the end.
pub(super) fn write_entries(
    out: &mut dyn Write,
    first: usize,
    times: &[f64],
    folder: &str,
    parts: &[&str],
) -> io::Result<u64> {
    let head = if first == 0 { HEAD } else { "" };
    out.write_all(head.as_bytes())?;
    let mut length = head.len();
    for (i, t) in (first..).zip(times) {
        for (part, name) in parts.iter().enumerate() {
            let entry = format!(
                "<DataSet timestep=\"{t:?}\" part=\"{part}\" name=\"{name}\" file=\"{folder}/{name}_{i:05}.vtu\"/>\n"
            );
            out.write_all(entry.as_bytes())?;
            length += entry.len();
        }
    }
    out.write_all(TAIL.as_bytes())?;
    Ok(length as u64)
}

/// Adds the times (s) in the list at `path` to `times`, from byte `from` on. Returns where the last entry begins.
///
/// # Errors
/// `File` if the list cannot be read or is not one of this program.
pub(super) fn read_times(path: &Path, from: u64, times: &mut Vec<f64>) -> Result<u64> {
    let refused = |why| Error::read(path, &why);
    let mut file = File::open(path).map_err(refused)?;
    file.seek(SeekFrom::Start(from)).map_err(refused)?;
    let (mut at, mut last) = (from, from);
    for tag in BufReader::new(file).split(b'>') {
        let tag = tag.map_err(refused)?;
        let text = String::from_utf8_lossy(&tag);
        if text.contains("<DataSet ") && text.contains("name=\"water\"") {
            let time = text.split_once("timestep=\"").and_then(|(_, rest)| rest.split('"').next()?.parse().ok());
            times.push(time.ok_or_else(|| Error::file(path, "is not a list of frames of this program"))?);
            last = at;
        }
        at += tag.len() as u64 + 1;
    }
    Ok(last)
}

#[cfg(test)]
#[path = "../../tests/unit/output/frame_index.rs"]
mod tests;
