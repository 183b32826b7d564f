//! Reader of the frames that [`FrameWriter`](super::FrameWriter) writes.

use std::{
    collections::HashSet,
    path::{Path, PathBuf},
};

use super::{
    frame_index::read_times,
    vtu::{self, Values},
};
use crate::error::{Error, Result};

/// The frames of a run.
#[derive(Clone, Debug)]
pub struct FrameSequence {
    folder: PathBuf,
    times: Vec<f64>,
    /// Where the last entry begins in the list, bytes.
    last_entry: u64,
}

/// The points of one part of a frame. Fields that the file does not contain are empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FramePoints {
    /// Positions, m; in 2-D the third coordinate is zero.
    pub position: Vec<[f32; 3]>,
    /// Velocities, m/s.
    pub velocity: Vec<[f32; 3]>,
    /// Densities, kg/m³.
    pub density: Vec<f32>,
    /// Pressures, Pa.
    pub pressure: Vec<f32>,
    /// Identifiers of the particles, the same in all frames.
    pub id: Vec<u32>,
    /// Number of the solid of each boundary particle; empty for water.
    pub solid_index: Vec<f32>,
    /// Number of the mooring line of each node; empty for water and solids.
    pub line_index: Vec<f32>,
}

impl FrameSequence {
    /// Opens the frames of the run in `folder`; returns `None` if the run has no frames.
    ///
    /// # Errors
    /// `File` if `frames.pvd` cannot be read.
    pub fn open(folder: &Path) -> Result<Option<Self>> {
        let path = list_path(folder);
        if !path.exists() {
            return Ok(None);
        }
        let mut times = Vec::new();
        let last_entry = read_times(&path, 0, &mut times)?;
        Ok((!times.is_empty()).then(|| Self { folder: folder.to_owned(), times, last_entry }))
    }

    /// Reads the entries added since the last reading, or the whole list if it is another one.
    ///
    /// # Errors
    /// As [`FrameSequence::open`].
    pub fn update(&mut self) -> Result<()> {
        let known = self.times.len();
        let (last, path) = (self.times.pop(), list_path(&self.folder));
        self.last_entry = read_times(&path, self.last_entry, &mut self.times)?;
        // The last entry is read again: it tells that the list before it is the known one.
        if known == 0 || self.times.get(known - 1) != last.as_ref() {
            self.times.clear();
            self.last_entry = read_times(&path, 0, &mut self.times)?;
        }
        Ok(())
    }

    /// Returns the times of the frames, s.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Returns the number of the frame nearest to time `t` (s).
    pub fn nearest_index(&self, t: f64) -> usize {
        let off = |i: &usize| (self.times[*i] - t).abs();
        (0..self.times.len()).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0)
    }

    /// Returns the size of frame `number` on the disk, bytes.
    pub fn bytes(&self, number: usize) -> u64 {
        let size = |part: &str| std::fs::metadata(self.path(part, number)).map_or(0, |file| file.len());
        size("water") + size("solids") + size("moorings")
    }

    /// Reads the water particles in frame `number`.
    ///
    /// # Errors
    /// `File` if the frame cannot be read.
    pub fn water(&self, number: usize) -> Result<FramePoints> {
        read_points(&self.path("water", number))
    }

    /// Reads the boundary particles in frame `number`.
    ///
    /// # Errors
    /// `File` if the frame cannot be read.
    pub fn solids(&self, number: usize) -> Result<FramePoints> {
        read_points(&self.path("solids", number))
    }

    /// Reads the nodes (m) of the mooring lines in frame `number`: one list for each line that acts, two for a line that has
    /// broken. Returns no list if the frame has no lines.
    ///
    /// # Errors
    /// `File` if the frame cannot be read.
    pub fn moorings(&self, number: usize) -> Result<Vec<Vec<[f32; 3]>>> {
        let path = self.path("moorings", number);
        if !path.exists() {
            return Ok(Vec::new());
        }
        let (FramePoints { position, .. }, cells) =
            read_file(&path, |file| Ok((parse_points(file)?, vtu::read_connectivity(file)?)))?;
        // A segment joins a node to the next.
        let joined: HashSet<i64> = cells.chunks(2).map(|segment| segment[0]).collect();
        let parts = (0..position.len()).collect::<Vec<_>>();
        let parts = parts.chunk_by(|k, _| joined.contains(&(*k as i64)));
        Ok(parts.map(|nodes| nodes.iter().map(|k| position[*k]).collect()).collect())
    }

    fn path(&self, part: &str, number: usize) -> PathBuf {
        self.folder.join("frames").join(format!("{part}_{number:05}.vtu"))
    }
}

/// Path of the list of frames of the run in `folder`.
fn list_path(folder: &Path) -> PathBuf {
    folder.join("frames.pvd")
}

fn read_points(path: &Path) -> Result<FramePoints> {
    read_file(path, parse_points)
}

/// Returns what `parse` reads in the file at `path`.
fn read_file<T>(path: &Path, parse: impl Fn(&[u8]) -> std::result::Result<T, String>) -> Result<T> {
    let file = std::fs::read(path).map_err(|why| Error::read(path, &why))?;
    parse(&file).map_err(|why| Error::file(path, format!("is not a frame of this program: {why}")))
}

/// Returns the points in a .vtu `file`.
fn parse_points(file: &[u8]) -> std::result::Result<FramePoints, String> {
    let (points, fields) = vtu::read_points(file)?;
    let mut all = FramePoints { position: triples(&points), ..FramePoints::default() };
    for field in fields {
        match (field.name.as_str(), field.components, field.values) {
            ("velocity", 3, Values::F32(x)) => all.velocity = triples(&x),
            ("density", 1, Values::F32(x)) => all.density = x,
            ("pressure", 1, Values::F32(x)) => all.pressure = x,
            ("solid", 1, Values::F32(x)) => all.solid_index = x,
            ("mooring", 1, Values::F32(x)) => all.line_index = x,
            ("id", 1, Values::U32(x)) => all.id = x,
            (name @ ("velocity" | "density" | "pressure" | "solid" | "mooring" | "id"), ..) => {
                return Err(format!("the field \"{name}\" has another type"));
            }
            _ => {}
        }
    }
    Ok(all)
}

/// Divides numbers into groups of three.
fn triples(numbers: &[f32]) -> Vec<[f32; 3]> {
    numbers.as_chunks().0.to_vec()
}

#[cfg(test)]
#[path = "../../tests/unit/output/frame_sequence.rs"]
mod tests;
