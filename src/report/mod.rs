//! One page for a run, or for several laid over one another: a file that stands alone and opens anywhere. Reads only
//! what stands in the runs' folders.
//!
//! ```no_run
//! let page = pontoon::report::write("runs/raft".as_ref())?;
//! assert!(page.path.ends_with("report.html") && page.bytes < 15_000_000);
//! # Ok::<(), pontoon::Error>(())
//! ```

mod blob;
mod charts;
mod colour;
mod easel;
mod figures;
mod film;
mod ink;
mod kept;
mod outline;
mod page;
mod picture;
mod pose;
mod rim;
mod sections;
mod wire;
pub(crate) mod format;

pub use picture::{Field, Shot, picture};

use std::{
    path::{Path, PathBuf},
    time::Instant,
};

use crate::{
    error::{Error, Kind, Result},
    output::{has_folder, write_whole},
};

use kept::Kept;

/// Most bytes of a page.
pub const MOST_BYTES: usize = 15_000_000;

/// Name of the page in a run's folder.
pub const FILE: &str = "report.html";

/// A page that was written.
#[derive(Clone, Debug, PartialEq)]
pub struct Page {
    /// Where.
    pub path: PathBuf,
    /// Its size, B.
    pub bytes: usize,
    /// How long it took, s.
    pub seconds: f64,
    /// What could not be read and is not on it.
    pub remarks: Vec<String>,
}

/// Writes the page of the run in `folder`, however far it came, as `report.html` in it.
///
/// # Errors
/// `Restart` if there is no run in `folder`; `File` if a frame cannot be read or the page cannot be written.
pub fn write(folder: &Path) -> Result<Page> {
    laid(&[folder.to_owned()], &folder.join(FILE))
}

/// Writes a page of the runs in `folders`, laid over one another, to `out`.
///
/// # Errors
/// `Usage` if there are fewer than two; else as [`write`].
pub fn compare(folders: &[PathBuf], out: &Path) -> Result<Page> {
    if folders.len() < 2 {
        return Err(Error::new(Kind::Usage, "a comparison needs two runs or more")
            .help("name their folders, as in `pontoon compare runs/raft runs/raft-2`"));
    }
    has_folder(out)?;
    laid(folders, out)
}

fn laid(folders: &[PathBuf], out: &Path) -> Result<Page> {
    let begun = Instant::now();
    let runs = Kept::all(folders)?;
    let text = page::page(&runs)?;
    write_whole(out, text.as_bytes())?;
    let apart = sections::strangers(&runs).then(|| "the runs have no series in common: each is drawn by itself".into());
    let remarks = runs.into_iter().flat_map(|run| run.remarks).chain(apart).collect();
    Ok(Page { path: out.to_owned(), bytes: text.len(), seconds: begun.elapsed().as_secs_f64(), remarks })
}
