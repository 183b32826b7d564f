//! Frames for ParaView: `frames.pvd` lists the frames. Each frame has two files, such as `frames/water_00000.vtu` and
//! `frames/solids_00000.vtu`; with mooring lines also `frames/moorings_00000.vtu`. Points have three coordinates; in 2-D
//! the third coordinate is zero. The data have single precision and are compressed (zlib).

use std::{
    fs::File,
    io,
    ops::Range,
    path::{Path, PathBuf},
};

use super::{
    cannot_write,
    frame_index::FrameIndex,
    sync_folder,
    vtu::{self, Cells, DataArray, Values},
    write_atomically,
};
use crate::{
    error::{Error, ErrorCode, Result, nearest_name},
    math::Vector,
    particles::ParticlesView,
    plan::FramesPlan,
    solid::MooringReading,
    system::System,
};

/// Fields that a frame can contain.
pub(crate) const FIELDS: [&str; 4] = ["velocity", "density", "pressure", "id"];

/// Ratio of compressed to uncompressed size of a frame with moving water, –; for water at rest it is a third.
const COMPRESSED: f64 = 0.6;

/// Returns the usual upper limit of the bytes per water particle and per boundary particle in a frame with these
/// `fields`. The bytes are those of the compressed position, vertex and fields.
pub fn particle_bytes(fields: &[String]) -> (f64, f64) {
    let fields: f64 = fields.iter().map(|field| if field == "velocity" { 12.0 } else { 4.0 }).sum();
    let place = 12.0 + 8.0 + 8.0 + 1.0;
    (COMPRESSED * (place + fields), COMPRESSED * (place + fields + 4.0))
}

/// VTK's number of a cell that is one point.
const VERTEX: u8 = 1;

/// VTK's number of a cell that is a line between two points.
const LINE: u8 = 3;

/// The parts of a frame, with one file for each part; the last only with mooring lines.
const PARTS: [&str; 3] = ["water", "solids", "moorings"];

/// Writer of the frames of a run. Boundary particles have the number of their solid in addition to the chosen fields.
pub(crate) struct FrameWriter {
    folder: PathBuf,
    fields: Vec<String>,
    /// The parts of a frame.
    parts: &'static [&'static str],
    /// Lowest and highest corner (m) of the box of water in the frames; `None` for all water.
    crop: Option<[Vec<f64>; 2]>,
    times: Vec<f64>,
    /// Size of all frames, B.
    bytes: u64,
    /// Number of frames that are confirmed to be on the disk.
    synced: usize,
    index: FrameIndex,
}

impl FrameWriter {
    /// Makes the writer of frames in the run's `folder`. `words` gives the fields to write and the box whose water is
    /// written; `times` (s) are the times of the existing frames.
    ///
    /// # Errors
    /// `Scene` for an unknown field; `File` if the folder `frames` cannot be made.
    pub(crate) fn new(folder: &Path, words: &FramesPlan, times: Vec<f64>) -> Result<Self> {
        let FramesPlan { fields, crop, moorings, .. } = words.clone();
        if let Some(word) = fields.iter().find(|f| !FIELDS.contains(&f.as_str())) {
            let help = match nearest_name(word, FIELDS) {
                Some(near) => format!("did you mean {near:?}?"),
                None => format!("the fields are: {}", FIELDS.join(", ")),
            };
            return Err(Error::scene(format!("unknown field {word:?} of a frame"))
                .with_code(ErrorCode::UnknownName)
                .help(help));
        }
        let files = folder.join("frames");
        std::fs::create_dir_all(&files).map_err(|e| cannot_write(&files, &e))?;
        let (synced, parts) = (times.len(), &PARTS[..if moorings { 3 } else { 2 }]);
        let index = FrameIndex::new(folder.join("frames.pvd"), "frames", parts);
        let mut frames = Self { folder: folder.to_owned(), fields, parts, crop, times, bytes: 0, synced, index };
        frames.update_size();
        Ok(frames)
    }

    /// Removes all frames except the first `kept` frames.
    ///
    /// # Errors
    /// `File` if the operating system reports an error.
    pub(crate) fn truncate(&mut self, kept: usize) -> Result<()> {
        if kept >= self.times.len() {
            return Ok(());
        }
        let gone = kept..self.times.len();
        self.times.truncate(kept);
        self.synced = self.synced.min(kept);
        self.index.write(&self.times)?;
        for path in gone.flat_map(|number| self.piece_names(number)).map(|name| self.folder.join("frames").join(name)) {
            match std::fs::remove_file(&path) {
                Err(why) if why.kind() != io::ErrorKind::NotFound => return Err(cannot_write(&path, &why)),
                _ => {}
            }
        }
        self.update_size();
        Ok(())
    }

    /// Updates the total size of the frames.
    fn update_size(&mut self) {
        let files = self.folder.join("frames");
        let there = (0..self.times.len()).flat_map(|number| self.piece_names(number));
        self.bytes = there.filter_map(|name| Some(std::fs::metadata(files.join(name)).ok()?.len())).sum();
    }

    /// Returns the times of the frames so far, s.
    pub(crate) fn times(&self) -> &[f64] {
        &self.times
    }

    /// Returns the size of the frames on the disk, B.
    pub(crate) fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Adds a frame of `system` with its mooring lines at time `t` (s).
    ///
    /// # Errors
    /// `File` if the frame cannot be written; the earlier frames remain unchanged.
    pub(crate) fn write<const D: usize>(
        &mut self,
        system: &System<D>,
        moorings: &[MooringReading<D>],
        t: f64,
    ) -> Result<()> {
        let number = self.times.len();
        let water = system.fluid();
        let kept = self.crop.as_ref().map(|[min, max]| {
            let inside = |i: &usize| (0..D).all(|k| (min[k]..=max[k]).contains(&water.r[*i][k]));
            water.select((0..water.len()).filter(inside))
        });
        let water = kept.as_ref().map_or(water, |kept| kept.first_n(kept.len()));
        let names = self.piece_names(number);
        let mut bytes = self.write_piece(&names[0], system, water, None)?;
        let ranges: Vec<Range<usize>> = (0..system.solids().len()).map(|i| system.home_boundary(i)).collect();
        let owner = ranges.iter().enumerate().flat_map(|(i, range)| range.clone().map(move |_| i as f32)).collect();
        let boundary = system.boundary();
        let has_copies = ranges.iter().map(Range::len).sum::<usize>() < boundary.len();
        let kept = has_copies.then(|| boundary.select(ranges.into_iter().flatten()));
        let boundary = kept.as_ref().map_or(boundary, |kept| kept.first_n(kept.len()));
        bytes += self.write_piece(&names[1], system, boundary, Some(owner))?;
        if let Some(name) = names.get(2) {
            bytes += self.write_lines(name, moorings)?;
        }
        self.bytes += bytes;
        self.times.push(t);
        self.index.append(&self.times)
    }

    /// Waits until all frames are on the disk.
    ///
    /// # Errors
    /// `File` if a frame cannot be opened or the operating system reports an error.
    pub(crate) fn sync(&mut self) -> Result<()> {
        let files = self.folder.join("frames");
        for number in self.synced..self.times.len() {
            for name in self.piece_names(number).into_iter().map(|name| files.join(name)) {
                File::open(&name).and_then(|file| file.sync_data()).map_err(|e| cannot_write(&name, &e))?;
            }
        }
        if self.synced < self.times.len() {
            sync_folder(&files);
            self.synced = self.times.len();
        }
        Ok(())
    }

    /// Returns the names of the files of a frame.
    fn piece_names(&self, number: usize) -> Vec<String> {
        self.parts.iter().map(|part| format!("{part}_{number:05}.vtu")).collect()
    }

    /// Writes the mooring lines of a frame with the tension and the number of the line of each node; returns the size, B.
    fn write_lines<const D: usize>(&self, name: &str, moorings: &[MooringReading<D>]) -> Result<u64> {
        let (mut points, mut connectivity, mut tension, mut owner) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for (i, mooring) in moorings.iter().enumerate() {
            let first = points.len() as i64;
            let whole = (0..mooring.tensions.len()).filter(|s| mooring.broken != Some(*s));
            connectivity.extend(whole.flat_map(|s| [first + s as i64, first + s as i64 + 1]));
            points.extend_from_slice(&mooring.nodes);
            let beside =
                |node: usize| &mooring.tensions[node.saturating_sub(1)..(node + 1).min(mooring.tensions.len())];
            let mean = |t: &[f64]| (t.iter().sum::<f64>() / t.len() as f64) as f32;
            tension.extend((0..mooring.nodes.len()).map(|node| mean(beside(node))));
            owner.extend(std::iter::repeat_n(i as f32, mooring.nodes.len()));
        }
        let fields = vec![DataArray::new("tension", 1, tension), DataArray::new("mooring", 1, owner)];
        let path = self.folder.join("frames").join(name);
        let cells = Cells { connectivity, points_per_cell: 2, cell_type: LINE };
        let bytes = vtu::write(to_3d(&points), cells, fields).map_err(|why| cannot_write(&path, &why))?;
        write_atomically(&path, &bytes)?;
        Ok(bytes.len() as u64)
    }

    /// Writes one part of a frame; returns its size, B.
    fn write_piece<const D: usize>(
        &self,
        name: &str,
        system: &System<D>,
        particles: ParticlesView<'_, D>,
        owner: Option<Vec<f32>>,
    ) -> Result<u64> {
        let mut fields: Vec<DataArray> = self.fields.iter().map(|name| field(name, system, particles)).collect();
        fields.extend(owner.map(|numbers| DataArray::new("solid", 1, numbers)));
        let path = self.folder.join("frames").join(name);
        let bytes = points_vtu(particles.r, fields).map_err(|why| cannot_write(&path, &why))?;
        write_atomically(&path, &bytes)?;
        Ok(bytes.len() as u64)
    }
}

/// Returns the field called `name` of all particles.
fn field<const D: usize>(name: &str, system: &System<D>, particles: ParticlesView<'_, D>) -> DataArray {
    let all = |f: &dyn Fn(usize) -> f64| (0..particles.len()).map(|i| f(i) as f32).collect();
    match name {
        "velocity" => DataArray::new(name, 3, to_3d(particles.v)),
        "density" => DataArray::new(name, 1, all(&|i| particles.rho[i])),
        "pressure" => DataArray::new(name, 1, all(&|i| system.pressure(particles.rho[i]))),
        _ => DataArray { name: name.into(), components: 1, values: Values::U32(particles.id.to_vec()) },
    }
}

/// Returns three components for each vector, in a single list.
fn to_3d<const D: usize>(vectors: &[Vector<D>]) -> Vec<f32> {
    vectors.iter().flat_map(|v| (0..3).map(|i| if i < D { v[i] as f32 } else { 0.0 })).collect()
}

/// Returns a .vtu file with a vertex at each point.
fn points_vtu<const D: usize>(points: &[Vector<D>], fields: Vec<DataArray>) -> io::Result<Vec<u8>> {
    let connectivity = (0..points.len() as i64).collect();
    vtu::write(to_3d(points), Cells { connectivity, points_per_cell: 1, cell_type: VERTEX }, fields)
}

#[cfg(test)]
#[path = "../../tests/unit/output/frame.rs"]
mod tests;
