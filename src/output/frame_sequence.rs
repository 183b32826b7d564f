//! Frames read back, as [`Frames`](super::FrameWriter) wrote them.

use std::path::{Path, PathBuf};

use vtkio::model::{Attribute, DataSet, IOBuffer, Piece, Vtk};

use crate::error::{Error, Result};

/// The film of a run.
#[derive(Clone, Debug)]
pub struct FrameSequence {
    folder: PathBuf,
    times: Vec<f64>,
}

/// The points of a picture. A field that was not kept is empty.
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
    /// Numbers of the particles, the same in all frames.
    pub id: Vec<u32>,
    /// Of boundary particles: the number of the solid.
    pub solid_index: Vec<f32>,
}

impl FrameSequence {
    /// The film of the run in `folder`; none if it has no frames.
    ///
    /// # Errors
    /// `File` if `frames.pvd` cannot be read.
    pub fn open(folder: &Path) -> Result<Option<Self>> {
        let path = folder.join("frames.pvd");
        let text = match std::fs::read_to_string(&path) {
            Ok(text) => text,
            Err(why) if why.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            Err(why) => return Err(Error::file(&path, why)),
        };
        let after = |text: &str, word: &str| Some(text.split_once(word)?.1.split('"').next()?.to_string());
        let pictures = text.split("<DataSet ").skip(1).filter(|p| p.contains("name=\"water\""));
        let times: Option<Vec<f64>> = pictures.map(|p| after(p, "timestep=\"")?.parse().ok()).collect();
        match times {
            Some(times) => Ok((!times.is_empty()).then(|| Self { folder: folder.join("frames"), times })),
            None => Err(Error::file(&path, "is not a film of this program")),
        }
    }

    /// Times of the frames, s.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The number of the frame nearest to time `t` (s).
    pub fn nearest_index(&self, t: f64) -> usize {
        let off = |i: &usize| (self.times[*i] - t).abs();
        (0..self.times.len()).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0)
    }

    /// Bytes that the pictures of frame `number` have on the disk.
    pub fn bytes(&self, number: usize) -> u64 {
        let size = |part: &str| std::fs::metadata(self.path(part, number)).map_or(0, |file| file.len());
        size("water") + size("solids")
    }

    /// The water in frame `number`.
    ///
    /// # Errors
    /// `File` if it cannot be read.
    pub fn water(&self, number: usize) -> Result<FramePoints> {
        read_points(&self.path("water", number))
    }

    /// The boundary particles in frame `number`.
    ///
    /// # Errors
    /// `File` if they cannot be read.
    pub fn solids(&self, number: usize) -> Result<FramePoints> {
        read_points(&self.path("solids", number))
    }

    fn path(&self, part: &str, number: usize) -> PathBuf {
        self.folder.join(format!("{part}_{number:05}.vtu"))
    }
}

fn read_points(path: &Path) -> Result<FramePoints> {
    let text = std::fs::read(path).map_err(|why| Error::file(path, why))?;
    parse_points(&text).map_err(|why| Error::file(path, format!("is not a frame of this program: {why}")))
}

/// The points in the text of a .vtu file.
fn parse_points(text: &[u8]) -> std::result::Result<FramePoints, vtkio::Error> {
    let lacking = || vtkio::Error::UnknownFileExtension(None);
    let DataSet::UnstructuredGrid { pieces, .. } = Vtk::parse_xml(text)?.data else { return Err(lacking()) };
    let Some(Piece::Inline(piece)) = pieces.into_iter().next() else { return Err(lacking()) };
    let mut cloud = FramePoints { position: triples(piece.points), ..FramePoints::default() };
    for attribute in piece.data.point {
        let Attribute::DataArray(array) = attribute else { continue };
        match array.name.as_str() {
            "velocity" => cloud.velocity = triples(array.data),
            "density" => cloud.density = numbers(array.data),
            "pressure" => cloud.pressure = numbers(array.data),
            "solid" => cloud.solid_index = numbers(array.data),
            "id" => cloud.id = array.data.into_vec().unwrap_or_default(),
            _ => {}
        }
    }
    let whole = |count: usize| count == 0 || count == cloud.position.len();
    let fields =
        [cloud.density.len(), cloud.pressure.len(), cloud.solid_index.len(), cloud.id.len(), cloud.velocity.len()];
    if fields.into_iter().all(whole) { Ok(cloud) } else { Err(lacking()) }
}

fn numbers(buffer: IOBuffer) -> Vec<f32> {
    buffer.cast_into().unwrap_or_default()
}

fn triples(buffer: IOBuffer) -> Vec<[f32; 3]> {
    numbers(buffer).chunks_exact(3).map(|x| [x[0], x[1], x[2]]).collect()
}
