//! The page of a run in progress, and the data that the run has added since. All data are read from the run's folder, so that a
//! reader shares no memory with the run.

use std::{
    collections::BTreeMap,
    fmt,
    fs::File,
    io::{Read, Seek, SeekFrom},
    path::{Path, PathBuf},
    str::FromStr,
    sync::{Arc, Mutex, PoisonError},
};

use serde::Serialize;
use serde_json::{Value, json};

use super::{
    animation::{Animation, ShownParticles},
    encoding::BinaryData,
    page::{LIVE_FRAMES, LIVE_SAMPLES, live_page_html},
    run_data::{RunData, SceneGeometry},
};
use crate::{
    error::{Error, Result},
    output::FrameSequence,
    run::outputs::series_folder,
};

/// Most bytes of a table, and most samples (a particle in a frame), in an increment.
const MOST_BYTES: u64 = 128 << 10;
const MOST_SAMPLES: usize = 400_000;

/// Most frames in an increment; if there are more, it contains the newest.
const MOST_FRAMES: usize = 16;

/// Position of a reader in the files of a run: number of frames, and bytes of each table.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct FeedPosition {
    frames: usize,
    tables: Vec<u64>,
}

impl fmt::Display for FeedPosition {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}", self.frames)?;
        self.tables.iter().try_for_each(|bytes| write!(f, ".{bytes}"))
    }
}

impl FromStr for FeedPosition {
    type Err = std::num::ParseIntError;

    fn from_str(text: &str) -> std::result::Result<Self, Self::Err> {
        let (frames, tables) = text.split_once('.').unwrap_or((text, ""));
        let tables = tables.split('.').filter(|bytes| !bytes.is_empty());
        Ok(Self { frames: frames.parse()?, tables: tables.map(str::parse).collect::<std::result::Result<_, _>>()? })
    }
}

/// The data that a run has added.
#[derive(Debug, Default, Serialize)]
pub(crate) struct Increment {
    /// The new rows of each table, as columns of which the first is the time (s).
    rows: BTreeMap<String, Vec<Vec<f64>>>,
    /// The new frames, preceded by the last frame before them.
    #[serde(skip_serializing_if = "Option::is_none")]
    reel: Option<Animation>,
    /// The numbers of the frames.
    #[serde(skip_serializing_if = "Option::is_none")]
    blob: Option<String>,
    /// Whether the run has added more than this.
    #[serde(skip)]
    pub more: bool,
}

impl Increment {
    /// Whether nothing was added.
    pub(crate) fn is_empty(&self) -> bool {
        self.rows.is_empty() && self.reel.is_none()
    }
}

/// The parts of a run that do not change while it goes on.
struct Basis {
    tables: Vec<String>,
    geometry: Option<SceneGeometry>,
    shown: Option<ShownParticles>,
}

/// A run in progress.
pub(crate) struct LiveRun {
    folder: PathBuf,
    basis: Mutex<Option<Arc<Basis>>>,
    /// The length of the list of frames (bytes) when it was last read, and the frames. Of each frame, only the time is kept.
    listed: Mutex<(u64, Option<Arc<FrameSequence>>)>,
}

impl LiveRun {
    /// The run in `folder`, of which nothing is read yet.
    pub(crate) fn new(folder: &Path) -> Self {
        Self { folder: folder.to_owned(), basis: Mutex::default(), listed: Mutex::default() }
    }

    /// The folder of the run.
    pub(crate) fn folder(&self) -> &Path {
        &self.folder
    }

    /// Returns the page of the run so far. It contains `data` for its scripts, with the `position` from which the later
    /// increments start.
    ///
    /// # Errors
    /// As [`super::write`].
    pub(crate) fn page(&self, mut data: Value) -> Result<String> {
        // One page after the other: each needs the memory of a report.
        let mut basis = self.basis.lock().unwrap_or_else(PoisonError::into_inner);
        let names = || table_names(&series_folder(&self.folder));
        let tables = basis.as_ref().map_or_else(names, |basis| basis.tables.clone());
        // The ends of the tables are read first, so that rows written meanwhile are sent twice rather than never.
        let ends = tables.iter().map(|name| self.table_end(name)).collect::<Result<_>>()?;
        let run = RunData::read(&self.folder)?;
        let frames = run.frames.as_ref().map_or(0, |film| film.times().len());
        data["position"] = json!(FeedPosition { frames, tables: ends }.to_string());
        let page = live_page_html(&run, &data);
        if basis.as_ref().is_none_or(|basis| basis.shown.is_none()) {
            let choose = |film| ShownParticles::choose(&run, film, LIVE_SAMPLES, frames.max(LIVE_FRAMES));
            let shown = run.frames.as_ref().map(choose).transpose()?;
            *basis = Some(Arc::new(Basis { tables, geometry: run.geometry, shown }));
        }
        Ok(page)
    }

    /// Returns what was added since `position`, and advances `position`. Returns `None` if the page must be reloaded:
    /// `position` is from another run, the run has rolled back behind it, or the first frame has arrived.
    ///
    /// # Errors
    /// `File` if a table or the list of frames cannot be read.
    pub(crate) fn increment(&self, position: &mut FeedPosition) -> Result<Option<Increment>> {
        let basis = self.basis.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let Some(basis) = basis.filter(|basis| basis.tables.len() == position.tables.len()) else { return Ok(None) };
        let mut added = Increment::default();
        for (name, offset) in basis.tables.iter().zip(&mut position.tables) {
            let Some(text) = read_rows(&self.table_path(name), offset)? else { return Ok(None) };
            added.more |= text.len() as u64 > MOST_BYTES / 2;
            if let Some(columns) = parse_rows(&text) {
                added.rows.insert(name.clone(), columns);
            }
        }
        let film = self.frames()?;
        let count = film.as_ref().map_or(0, |film| film.times().len());
        if count < position.frames || count > 0 && basis.shown.is_none() {
            return Ok(None);
        }
        if let Some(film) = film.filter(|_| count > position.frames) {
            add_frames(&basis, &film, position, &mut added);
        }
        Ok(Some(added))
    }

    /// Returns the frames. The function reads their list only if its length has changed, and then only the new part.
    fn frames(&self) -> Result<Option<Arc<FrameSequence>>> {
        let length = std::fs::metadata(self.folder.join("frames.pvd")).map_or(0, |file| file.len());
        let mut listed = self.listed.lock().unwrap_or_else(PoisonError::into_inner);
        if length != listed.0 {
            match &mut listed.1 {
                Some(film) => Arc::make_mut(film).update()?,
                none => *none = FrameSequence::open(&self.folder)?.map(Arc::new),
            }
            listed.0 = length;
        }
        Ok(listed.1.clone())
    }

    fn table_path(&self, name: &str) -> PathBuf {
        series_folder(&self.folder).join(format!("{name}.csv"))
    }

    /// Returns the length of the complete rows of a table, bytes.
    fn table_end(&self, name: &str) -> Result<u64> {
        let path = self.table_path(name);
        let refused = |why| Error::read(&path, &why);
        let mut file = File::open(&path).map_err(refused)?;
        let length = file.metadata().map_err(refused)?.len();
        let from = length.saturating_sub(MOST_BYTES);
        let mut last = Vec::new();
        file.seek(SeekFrom::Start(from)).map_err(refused)?;
        file.take(length - from).read_to_end(&mut last).map_err(refused)?;
        Ok(last.iter().rposition(|byte| *byte == b'\n').map_or(from, |i| from + i as u64 + 1))
    }
}

/// Adds the newest frames to an increment.
fn add_frames(basis: &Basis, film: &FrameSequence, position: &mut FeedPosition, added: &mut Increment) {
    let Some(shown) = &basis.shown else { return };
    let count = film.times().len();
    let most = (MOST_SAMPLES / shown.count()).clamp(2, MOST_FRAMES);
    // The frame before the new ones tells how the particles moved.
    let from = position.frames.max(count.saturating_sub(most)).saturating_sub(1);
    let numbers: Vec<usize> = (from..count).collect();
    let mut blob = BinaryData::default();
    // A frame that a rollback removes meanwhile is left out.
    if let Ok(reel) = shown.encode(film, &numbers, basis.geometry.as_ref(), false, &mut blob) {
        (added.reel, added.blob) = (Some(reel), Some(blob.to_base64()));
    }
    position.frames = count;
}

/// Returns the names of the tables in the folder `series`, sorted.
fn table_names(series: &Path) -> Vec<String> {
    let paths = std::fs::read_dir(series).into_iter().flatten().flatten().map(|entry| entry.path());
    let tables = paths.filter(|path| path.extension().is_some_and(|end| end == "csv"));
    let mut names: Vec<String> = tables.filter_map(|path| Some(path.file_stem()?.to_str()?.into())).collect();
    names.sort();
    names
}

/// Returns the complete rows from `offset` on and moves it to their end, or `None` if the table is shorter.
fn read_rows(path: &Path, offset: &mut u64) -> Result<Option<String>> {
    let refused = |why| Error::read(path, &why);
    let mut file = File::open(path).map_err(refused)?;
    if file.metadata().map_err(refused)?.len() < *offset {
        return Ok(None);
    }
    let mut bytes = Vec::new();
    file.seek(SeekFrom::Start(*offset)).map_err(refused)?;
    file.take(MOST_BYTES).read_to_end(&mut bytes).map_err(refused)?;
    bytes.truncate(bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |i| i + 1));
    *offset += bytes.len() as u64;
    Ok(Some(String::from_utf8_lossy(&bytes).into_owned()))
}

/// Returns the columns of the rows in `text`, with NaN for empty fields, or `None` if it has no row of numbers.
fn parse_rows(text: &str) -> Option<Vec<Vec<f64>>> {
    let mut columns: Vec<Vec<f64>> = Vec::new();
    for line in text.lines() {
        let row: Vec<f64> = line.split(',').map(|field| field.parse().unwrap_or(f64::NAN)).collect();
        if columns.is_empty() {
            columns.resize(row.len(), Vec::new());
        }
        // The header has no time.
        if row[0].is_finite() && row.len() == columns.len() {
            columns.iter_mut().zip(row).for_each(|(column, x)| column.push(x));
        }
    }
    columns.first().is_some_and(|times| !times.is_empty()).then_some(columns)
}

#[cfg(test)]
#[path = "../../tests/unit/report/live.rs"]
mod tests;
