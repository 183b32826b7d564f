//! What is kept of a run: tables (CSV), frames (VTK), checkpoints, the manifest. No opinion on any of it.

pub mod frame;
pub mod manifest;
pub mod restart;
pub mod table;

pub use frame::Frames;
pub use manifest::Manifest;
pub use restart::Checkpoint;
pub use table::Table;

use std::{
    fs::{self, File},
    io::{self, Write},
    path::Path,
};

use crate::error::{Error, Result};

/// Writes the file at `path` all at once: a reader sees the old file or the new one, never a part.
///
/// # Errors
/// `File`, naming the file, if the disk is full or the folder cannot be written; the old file stays.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<()> {
    replace(path, |file| file.write_all(bytes))
}

/// As [`write_whole`], and waits for the disk, some milliseconds: the next start after a power cut, too, sees
/// the old file or the new one.
///
/// # Errors
/// As [`write_whole`].
pub fn write_lasting(path: &Path, bytes: &[u8]) -> Result<()> {
    replace(path, |file| file.write_all(bytes).and_then(|()| file.sync_all()))
}

fn replace(path: &Path, fill: impl FnOnce(&mut File) -> io::Result<()>) -> Result<()> {
    let mut temporary = path.as_os_str().to_owned();
    temporary.push(".part");
    let temporary = Path::new(&temporary);
    let written = File::create(temporary).and_then(|mut file| {
        fill(&mut file)?;
        fs::rename(temporary, path)
    });
    written.map_err(|why| {
        // The part is of no use; that it cannot be removed either would hide the first trouble.
        let _ = fs::remove_file(temporary);
        cannot_write(path, &why)
    })
}

/// The error of a file that cannot be written.
fn cannot_write(path: &Path, why: &io::Error) -> Error {
    Error::file(path, format!("cannot be written: {why}"))
        .help("what was written before is intact; free some space or choose another folder with --out")
}
