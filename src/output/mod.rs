//! The files of a run: tables (CSV), frames (VTK), checkpoints, the manifest.

pub(crate) mod checkpoint;
pub(crate) mod csv;
#[doc(hidden)]
pub mod frame;
mod frame_index;
pub(crate) mod frame_sequence;
pub(crate) mod gdf;
#[doc(hidden)]
pub mod manifest;
pub(crate) mod interval_mean;
#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod npz;
pub(crate) mod removed_particles;
mod base64;
mod vtu;
#[cfg(feature = "surface")]
#[doc(hidden)]
pub mod free_surface_mesh;

pub use checkpoint::{Checkpoint, OutputPositions};
pub(crate) use csv::CsvTable;
pub use csv::SeriesTable;
pub(crate) use frame::FrameWriter;
pub use frame_sequence::{FramePoints, FrameSequence};
#[doc(hidden)]
pub use interval_mean::IntervalMean;
pub use manifest::Manifest;

use std::{
    fs::{self, File},
    io::{self, Write},
    path::{Path, PathBuf},
};

use crate::error::{Error, ErrorCode, Result};

/// Writes the file at `path` atomically: a reader sees either the old file or the new file, never a partial file.
///
/// # Errors
/// `File`, with the name of the file, if the disk is full or the folder is not writable; the old file remains.
pub(crate) fn write_atomically(path: &Path, bytes: &[u8]) -> Result<()> {
    write_partial(path, |file| file.write_all(bytes))?;
    commit_partial(path)
}

/// Checks that the folder for the file at `path` exists, before a run computes results for it.
///
/// # Errors
/// `File` if the folder does not exist.
#[doc(hidden)]
pub fn require_parent_folder(path: &Path) -> Result<()> {
    match path.parent().filter(|folder| !folder.as_os_str().is_empty() && !folder.is_dir()) {
        Some(folder) => Err(Error::file(path, format!("there is no folder {}", folder.display()))
            .with_code(ErrorCode::FileNotFound)
            .help("make it first, or name a file in another")),
        None => Ok(()),
    }
}

/// Fills the temporary file that replaces the file at `path` later; returns what `fill` returns.
fn write_partial<T>(path: &Path, fill: impl FnOnce(&mut File) -> io::Result<T>) -> Result<T> {
    let part = partial_path(path);
    File::create(&part).and_then(|mut file| fill(&mut file)).map_err(|why| {
        // The partial file has no use. An error from its removal would hide the original error.
        let _ = fs::remove_file(&part);
        cannot_write(path, &why)
    })
}

/// Renames the complete temporary file to its final name.
fn commit_partial(path: &Path) -> Result<()> {
    fs::rename(partial_path(path), path).map_err(|why| {
        let _ = fs::remove_file(partial_path(path));
        cannot_write(path, &why)
    })
}

/// Returns the temporary name of the file at `path` until the file is complete.
fn partial_path(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".part");
    name.into()
}

/// Waits until the file names in `folder` are on the disk. Some systems do not support this; they write the names soon
/// afterwards.
fn sync_folder(folder: &Path) {
    let _ = File::open(folder).and_then(|folder| folder.sync_all());
}

/// Returns the error of a file that cannot be written.
fn cannot_write(path: &Path, why: &io::Error) -> Error {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or_else(|| Path::new("."));
    let help = match why.kind() {
        io::ErrorKind::NotFound if !folder.exists() => {
            format!("the folder {} is gone, and with it what was written there", folder.display())
        }
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            format!("allow writing in the folder {}, or use another one", folder.display())
        }
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
            "what was written before is intact; free some space, or use another disk".into()
        }
        _ => "what was written before is intact; use another folder".into(),
    };
    Error::write(path, "written", why).help(help)
}

#[cfg(test)]
#[path = "../../tests/unit/output/write_errors.rs"]
mod tests;
