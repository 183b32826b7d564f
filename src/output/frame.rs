//! Frames for ParaView: `frames.pvd` lists the frames. Each frame has two files, such as `frames/water_00000.vtu` and
//! `frames/solids_00000.vtu`; with mooring lines also `frames/moorings_00000.vtu`. Points have three coordinates; in 2-D
//! the third coordinate is zero. The data have single precision and are compressed (zlib).

use std::{
    fs::File,
    io::{self, Seek, Write},
    ops::Range,
    path::{Path, PathBuf},
};

use bytemuck::Pod;

use super::{
    cannot_write, commit_partial,
    frame_index::FrameIndex,
    sync_folder,
    vtu::{self, ArrayPieces, Cells, DataArray, Values},
    write_atomically, write_partial,
};
use crate::{
    error::{Error, ErrorCode, Result, nearest_name},
    math::Vector,
    neighbours::Division,
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

/// Particles whose values are compressed at a time.
const PIECE: usize = 1 << 13;

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
        let names = self.piece_names(number);
        let path = self.folder.join("frames").join(&names[0]);
        let (fields, crop) = (&self.fields, self.crop.as_ref());
        let mut is_given = false;
        let written = write_partial(&path, |file| {
            is_given = true;
            write_water(file, system, fields, crop)
        });
        if !is_given {
            // The other ranks give what the file cannot take.
            let _ = write_water(&mut io::empty(), system, fields, crop);
        }
        let mut bytes = written?;
        commit_partial(&path)?;
        let ranges: Vec<Range<usize>> = (0..system.solids().len()).map(|i| system.home_boundary(i)).collect();
        let owner = ranges.iter().enumerate().flat_map(|(i, range)| range.clone().map(move |_| i as f32)).collect();
        let numbers: Vec<u32> = (0..system.boundary().len() as u32).collect();
        let boundary = ParticlesView { id: &numbers, ..system.boundary() };
        let has_copies = ranges.iter().map(Range::len).sum::<usize>() < boundary.len();
        let kept = has_copies.then(|| boundary.select(ranges.into_iter().flatten()));
        let boundary = kept.as_ref().map_or(boundary, |kept| kept.first_n(kept.len()));
        let path = self.folder.join("frames").join(&names[1]);
        let solids = Shown { particles: boundary, division: None, shown: None };
        bytes += write_partial(&path, |file| solids.write(file, system, &self.fields, Some(owner)))?;
        commit_partial(&path)?;
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
}

/// Writes the `file` of the water in a frame with these `fields`, in the box with the corners `crop` (m) if there is one; returns
/// its size, B. Where each rank has its own water, all ranks must call this. The first rank writes all particles; it gets those
/// of the others piece by piece.
///
/// # Errors
/// Errors of the file, after the other ranks have sent their water.
pub(crate) fn write_water<const D: usize>(
    file: &mut (impl Write + Seek),
    system: &System<D>,
    fields: &[String],
    crop: Option<&[Vec<f64>; 2]>,
) -> io::Result<u64> {
    let mut water = Shown { particles: system.fluid(), division: system.divided_water(), shown: None };
    water.shown = crop.map(|[min, max]| {
        let mut kept = Vec::new();
        let is_inside = |r: &Vector<D>| (0..D).all(|k| (min[k]..=max[k]).contains(&r[k]));
        water.give(water.particles.r, |piece| kept.extend(piece.iter().map(is_inside)));
        kept
    });
    water.write(file, system, fields, None)
}

/// Particles of a part of a frame.
struct Shown<'a, const D: usize> {
    particles: ParticlesView<'a, D>,
    /// How ranks share the particles, if each has its own.
    division: Option<&'a Division>,
    /// Which particles are in the frame; all if there is none.
    shown: Option<Vec<bool>>,
}

impl<'a, const D: usize> Shown<'a, D> {
    /// Number of particles in the frame; 0 on ranks that write none.
    fn count(&self) -> usize {
        match (&self.shown, self.division.is_some_and(|division| division.ranks.rank() > 0)) {
            (_, true) => 0,
            (Some(kept), _) => kept.iter().filter(|kept| **kept).count(),
            (None, _) => self.particles.len(),
        }
    }

    /// Gives the values in `all` of the particles in the frame to `use_piece`, piece by piece.
    fn give<T: Pod>(&self, all: &[T], mut use_piece: impl FnMut(&[T])) {
        let mut rest = self.shown.as_deref();
        let mut chosen = Vec::new();
        let use_kept = |piece: &[T]| match &mut rest {
            None => use_piece(piece),
            Some(rest) => {
                let (these, later) = rest.split_at(piece.len());
                *rest = later;
                chosen.clear();
                chosen.extend(piece.iter().zip(these).filter(|(_, kept)| **kept).map(|(x, _)| *x));
                use_piece(&chosen);
            }
        };
        match self.division {
            Some(division) => division.collect(all, use_kept),
            None => all.chunks(PIECE).for_each(use_kept),
        }
    }

    /// Writes the `file` of the particles with these `fields` and, for particles of solids, the number of the `owner` of each.
    /// Returns its size, B.
    fn write(
        &self,
        file: &mut (impl Write + Seek),
        system: &'a System<D>,
        fields: &[String],
        owner: Option<Vec<f32>>,
    ) -> io::Result<u64> {
        let ParticlesView { r, v, rho, id } = self.particles;
        let count = self.count();
        let vectors = move |all: &'a [Vector<D>]| {
            move |use_piece: &mut dyn FnMut(&Values)| self.give(all, |piece| use_piece(&Values::F32(to_3d(piece))))
        };
        let scalars = |name: &str, of: Box<dyn Fn(f64) -> f64 + 'a>| {
            ArrayPieces::new((name, 1), (Values::F32(Vec::new()), count), move |use_piece| {
                self.give(rho, |piece| use_piece(&Values::F32(piece.iter().map(|&rho| of(rho) as f32).collect())));
            })
        };
        let field = |name: &String| match name.as_str() {
            "velocity" => ArrayPieces::new((name, 3), (Values::F32(Vec::new()), 3 * count), vectors(v)),
            "density" => scalars(name, Box::new(|rho| rho)),
            "pressure" => scalars(name, Box::new(|rho| system.pressure(rho))),
            _ => ArrayPieces::new((name, 1), (Values::U32(Vec::new()), count), move |use_piece| {
                self.give(id, |piece| use_piece(&Values::U32(piece.to_vec())));
            }),
        };
        let mut fields: Vec<ArrayPieces<'_>> = fields.iter().map(field).collect();
        fields.extend(owner.map(|numbers| DataArray::new("solid", 1, numbers).into()));
        vtu::write_vertices(file, count, vectors(r), fields)
    }
}

/// Returns three components for each vector, in a single list.
fn to_3d<const D: usize>(vectors: &[Vector<D>]) -> Vec<f32> {
    vectors.iter().flat_map(|v| (0..3).map(|i| if i < D { v[i] as f32 } else { 0.0 })).collect()
}

#[cfg(test)]
#[path = "../../tests/unit/output/frame.rs"]
mod tests;
