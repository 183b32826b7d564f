//! A lock lets only one program write in a run's folder. The system releases the lock of a killed run; the file `run.lock`
//! remains.

use std::{
    fs::{self, File, OpenOptions, TryLockError},
    io::Write,
    path::{Path, PathBuf},
};

use crate::error::{Error, ErrorKind, Result};

/// The file.
const LOCK: &str = "run.lock";

/// Number of the process that writes in the run's `folder`, or that was killed there; `None` if no process has left its number.
pub fn lock_owner(folder: &Path) -> Option<u32> {
    fs::read_to_string(folder.join(LOCK)).ok()?.trim().parse().ok()
}

/// The right to write in a run's folder; dropping it removes the file.
pub(crate) struct Lock {
    path: PathBuf,
    _file: File,
}

impl Lock {
    /// Takes the right to write in `folder`.
    ///
    /// # Errors
    /// `Restart`, with the process, if a run goes on; `File` if the file cannot be written.
    pub(crate) fn acquire(folder: &Path) -> Result<Self> {
        let path = folder.join(LOCK);
        let refused = |why: std::io::Error| Error::write(&path, "written", &why);
        let mut file = OpenOptions::new().write(true).create(true).truncate(false).open(&path).map_err(refused)?;
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            let process = fs::read_to_string(&path).unwrap_or_default();
            let what = format!("the run in {} still goes on: process {}", folder.display(), process.trim());
            let help = "wait for its end, or stop it with Ctrl-C and resume it then";
            return Err(Error::new(ErrorKind::Restart, what).help(help));
        }
        // A run is not refused because the file system has no locks.
        file.set_len(0).and_then(|()| writeln!(file, "{}", std::process::id())).map_err(refused)?;
        Ok(Self { path, _file: file })
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        // A file that remains does no harm: the system has released its lock.
        let _ = fs::remove_file(&self.path);
    }
}

#[cfg(test)]
#[path = "../../tests/unit/run/lock.rs"]
mod tests;
