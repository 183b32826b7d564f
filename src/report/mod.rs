//! Writes a page for one run, or for a comparison of several runs. The page is a single file without external
//! resources, and the module reads only the folders of the runs.
//!
//! ```no_run
//! let page = pontoon::report::write("runs/raft".as_ref())?;
//! assert!(page.path.ends_with("report.html") && page.bytes < 15_000_000);
//! # Ok::<(), pontoon::Error>(())
//! ```

mod encoding;
mod charts;
mod colour;
mod canvas;
mod summary_tables;
mod animation;
pub(crate) mod live;
mod text;
mod run_data;
mod outline;
mod page;
mod picture;
mod placement;
mod ties;
pub(crate) mod plot;
mod sections;
mod mesh_edges;
pub(crate) mod html;

pub use picture::{ColourField, PictureOptions, write_picture};
pub use plot::{LineStyle, PlotLine, line_plot, log_log_plot};

use std::{
    path::{Path, PathBuf},
    time::Instant,
};

use crate::{
    error::{Error, ErrorKind, Result},
    output::{require_parent_folder, write_atomically},
};

use run_data::RunData;

/// The largest size of a page, bytes.
pub const MAX_PAGE_BYTES: usize = 15_000_000;

/// The file name of the page in the folder of a run.
pub const REPORT_FILE: &str = "report.html";

/// A written page.
#[derive(Clone, Debug, PartialEq)]
pub struct Page {
    /// The path of the page.
    pub path: PathBuf,
    /// The size of the page, B.
    pub bytes: usize,
    /// The time to create the page, s.
    pub seconds: f64,
    /// The parts of the run that could not be read and are absent from the page.
    pub remarks: Vec<String>,
}

/// Writes the page of the run in `folder` as `report.html` in this folder; the run may be unfinished.
///
/// # Errors
/// `Restart` if `folder` contains no run; `File` if the page cannot be written.
pub fn write(folder: &Path) -> Result<Page> {
    write_page(&[folder.to_owned()], &folder.join(REPORT_FILE))
}

/// Writes a page that compares the runs in `folders` to `out`.
///
/// # Errors
/// `Usage` for fewer than two folders; otherwise the errors of [`write()`].
pub fn compare(folders: &[PathBuf], out: &Path) -> Result<Page> {
    if folders.len() < 2 {
        return Err(Error::new(ErrorKind::Usage, "a comparison needs two runs or more")
            .help("name their folders, as in `pontoon compare runs/raft runs/raft-2`"));
    }
    require_parent_folder(out)?;
    write_page(folders, out)
}

fn write_page(folders: &[PathBuf], out: &Path) -> Result<Page> {
    let begun = Instant::now();
    let runs = RunData::read_all(folders)?;
    let (text, lost_frames) = page::page_html(&runs);
    write_atomically(out, text.as_bytes())?;
    let apart =
        sections::no_common_series(&runs).then(|| "the runs have no series in common: each is drawn by itself".into());
    let remarks = runs.into_iter().flat_map(|run| run.remarks).chain(lost_frames).chain(apart).collect();
    Ok(Page { path: out.to_owned(), bytes: text.len(), seconds: begun.elapsed().as_secs_f64(), remarks })
}
