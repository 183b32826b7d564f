//! Frames for ParaView: `frames.pvd` is the film, `frames/water_00000.vtu` and `frames/solids_00000.vtu`
//! are its pictures. Points have three coordinates; in 2-D the third is zero. Single precision, packed (zlib).

use std::{
    fs::File,
    path::{Path, PathBuf},
};

use vtkio::{
    model::{
        Attribute, Attributes, ByteOrder, CellType, Cells, DataArrayBase, DataSet, ElementType, IOBuffer,
        UnstructuredGridPiece, Version, VertexNumbers, Vtk,
    },
    xml::Compressor,
};

use super::{cannot_write, sync_folder, write_atomically};
use crate::{
    error::{Error, ErrorKind, Result, nearest_name},
    math::Vector,
    particles::ParticlesView,
    plan::FramesPlan,
    system::System,
};

/// Fields that a frame may hold.
pub const FIELDS: [&str; 4] = ["velocity", "density", "pressure", "id"];

/// What zlib leaves of a frame of water in motion, –; of water at rest it leaves a third.
const PACKED: f64 = 0.6;

/// Bytes of a particle of water and of a boundary particle in a frame with these `fields`, rarely more: place, vertex and fields,
/// packed and in base 64.
pub fn particle_bytes(fields: &[String]) -> (f64, f64) {
    let fields: f64 = fields.iter().map(|field| if field == "velocity" { 12.0 } else { 4.0 }).sum();
    let place = 12.0 + 8.0 + 8.0 + 1.0;
    (4.0 / 3.0 * PACKED * (place + fields), 4.0 / 3.0 * PACKED * (place + fields + 4.0))
}

/// The pictures of a frame.
const PARTS: [&str; 2] = ["water", "solids"];

/// The frames of a run. Solids carry the number of their solid besides the chosen fields.
pub struct FrameWriter {
    folder: PathBuf,
    fields: Vec<String>,
    /// Lowest and highest corner (m) of the box whose water is kept; all if none.
    crop: Option<[Vec<f64>; 2]>,
    times: Vec<f64>,
    /// What they take, B.
    bytes: u64,
    /// How many of them are on the disk itself.
    synced: usize,
}

impl FrameWriter {
    /// The frames in the run's `folder`, holding what `words` say (fields of [`FIELDS`]); `times` (s) are those that are
    /// there already.
    ///
    /// # Errors
    /// `Scene` for an unknown field; `File` if the folder `frames` cannot be made.
    pub fn new(folder: &Path, words: &FramesPlan, times: Vec<f64>) -> Result<Self> {
        let FramesPlan { fields, crop, .. } = words.clone();
        if let Some(word) = fields.iter().find(|f| !FIELDS.contains(&f.as_str())) {
            let help = match nearest_name(word, FIELDS) {
                Some(near) => format!("did you mean {near:?}?"),
                None => format!("the fields are: {}", FIELDS.join(", ")),
            };
            return Err(Error::scene(format!("unknown field {word:?} of a frame")).help(help));
        }
        let pictures = folder.join("frames");
        std::fs::create_dir_all(&pictures).map_err(|e| cannot_write(&pictures, &e))?;
        let mut frames = Self { folder: folder.to_owned(), fields, crop, synced: times.len(), times, bytes: 0 };
        frames.update_size();
        Ok(frames)
    }

    /// Takes back all frames but the first `kept`.
    ///
    /// # Errors
    /// `File` if the disk refuses.
    pub fn truncate(&mut self, kept: usize) -> Result<()> {
        if kept >= self.times.len() {
            return Ok(());
        }
        let gone = kept..self.times.len();
        self.times.truncate(kept);
        self.synced = self.synced.min(kept);
        self.write_index()?;
        for path in gone.flat_map(piece_names).map(|name| self.folder.join("frames").join(name)) {
            match std::fs::remove_file(&path) {
                Err(why) if why.kind() != std::io::ErrorKind::NotFound => return Err(cannot_write(&path, &why)),
                _ => {}
            }
        }
        self.update_size();
        Ok(())
    }

    /// Sums up what the frames take.
    fn update_size(&mut self) {
        let pictures = self.folder.join("frames");
        let there = (0..self.times.len()).flat_map(piece_names);
        self.bytes = there.filter_map(|name| Some(std::fs::metadata(pictures.join(name)).ok()?.len())).sum();
    }

    /// Writes the list of all frames.
    fn write_index(&self) -> Result<()> {
        write_atomically(&self.folder.join("frames.pvd"), pvd_index(&self.times, "frames", &PARTS).as_bytes())
    }

    /// Times of the frames so far, s.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// What they take on the disk, B.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Adds a frame of `system` at time `t` (s).
    ///
    /// # Errors
    /// `File` if it cannot be written; the frames before stay as they are.
    pub fn write<const D: usize>(&mut self, system: &System<D>, t: f64) -> Result<()> {
        let number = self.times.len();
        let water = system.fluid();
        let kept = self.crop.as_ref().map(|[min, max]| {
            let inside = |i: &usize| (0..D).all(|k| (min[k]..=max[k]).contains(&water.r[*i][k]));
            water.select((0..water.len()).filter(inside))
        });
        let water = kept.as_ref().map_or(water, |kept| kept.first_n(kept.len()));
        let [wet, dry] = piece_names(number);
        let mut bytes = self.write_piece(&wet, system, water, None)?;
        let mut owner = vec![0.0; system.boundary().len()];
        for (i, solid) in system.solids().iter().enumerate() {
            owner[solid.boundary.clone()].fill(i as f32);
        }
        bytes += self.write_piece(&dry, system, system.boundary(), Some(owner))?;
        self.bytes += bytes;
        self.times.push(t);
        self.write_index()
    }

    /// Waits until all frames are on the disk itself.
    ///
    /// # Errors
    /// `File` if one cannot be opened or the disk refuses.
    pub fn sync(&mut self) -> Result<()> {
        let pictures = self.folder.join("frames");
        for number in self.synced..self.times.len() {
            for name in piece_names(number).map(|name| pictures.join(name)) {
                File::open(&name).and_then(|file| file.sync_data()).map_err(|e| cannot_write(&name, &e))?;
            }
        }
        if self.synced < self.times.len() {
            sync_folder(&pictures);
            self.synced = self.times.len();
        }
        Ok(())
    }

    /// Writes a picture; its size, B.
    fn write_piece<const D: usize>(
        &self,
        name: &str,
        system: &System<D>,
        particles: ParticlesView<'_, D>,
        owner: Option<Vec<f32>>,
    ) -> Result<u64> {
        let mut fields: Vec<Attribute> = self.fields.iter().map(|name| attribute(name, system, particles)).collect();
        fields.extend(
            owner.map(|numbers| data_array("solid", ElementType::Scalars { num_comp: 1, lookup_table: None }, numbers)),
        );
        let path = self.folder.join("frames").join(name);
        let bytes = points_vtu(particles.r, fields)
            .map_err(|e| Error::new(ErrorKind::File, format!("{}: {e}", path.display())))?;
        write_atomically(&path, &bytes)?;
        Ok(bytes.len() as u64)
    }
}

/// The files of a frame.
fn piece_names(number: usize) -> [String; 2] {
    PARTS.map(|part| format!("{part}_{number:05}.vtu"))
}

/// The chosen field of all particles.
fn attribute<const D: usize>(field: &str, system: &System<D>, particles: ParticlesView<'_, D>) -> Attribute {
    let scalar = ElementType::Scalars { num_comp: 1, lookup_table: None };
    let all = |f: &dyn Fn(usize) -> f64| (0..particles.len()).map(|i| f(i) as f32).collect();
    match field {
        "velocity" => data_array(field, ElementType::Vectors, to_3d(particles.v)),
        "density" => data_array(field, scalar, all(&|i| particles.rho[i])),
        "pressure" => data_array(field, scalar, all(&|i| system.pressure(particles.rho[i]))),
        _ => Attribute::DataArray(DataArrayBase {
            name: field.into(),
            elem: scalar,
            data: IOBuffer::U32(particles.id.to_vec()),
        }),
    }
}

pub(super) fn data_array(name: &str, elem: ElementType, numbers: Vec<f32>) -> Attribute {
    Attribute::DataArray(DataArrayBase { name: name.into(), elem, data: IOBuffer::F32(numbers) })
}

/// Three components for each vector, in a row.
fn to_3d<const D: usize>(vectors: &[Vector<D>]) -> Vec<f32> {
    vectors.iter().flat_map(|v| (0..3).map(|i| if i < D { v[i] as f32 } else { 0.0 })).collect()
}

/// The text of a .vtu file with a vertex at each point.
fn points_vtu<const D: usize>(
    points: &[Vector<D>],
    fields: Vec<Attribute>,
) -> std::result::Result<Vec<u8>, vtkio::Error> {
    let count = points.len() as u64;
    let cells = Cells {
        cell_verts: VertexNumbers::XML { connectivity: (0..count).collect(), offsets: (1..=count).collect() },
        types: vec![CellType::Vertex; points.len()],
    };
    mesh_vtu(to_3d(points), cells, fields)
}

/// The text of a .vtu file with these points (three coordinates each, m), cells and fields of the points.
pub(super) fn mesh_vtu(
    points: Vec<f32>,
    cells: Cells,
    fields: Vec<Attribute>,
) -> std::result::Result<Vec<u8>, vtkio::Error> {
    let piece = UnstructuredGridPiece {
        points: IOBuffer::F32(points),
        cells,
        data: Attributes { point: fields, cell: vec![] },
    };
    let vtk = Vtk {
        version: Version::new_xml(1, 0),
        title: String::new(),
        byte_order: ByteOrder::LittleEndian,
        file_path: None,
        data: DataSet::inline(piece),
    };
    let mut text = Vec::new();
    vtk.try_into_xml_format(Compressor::ZLib, 1)?.write(&mut text)?;
    Ok(text)
}

/// The text of a .pvd file: which pictures, of all `parts` and in the `folder` beside it, belong to which time.
pub(super) fn pvd_index(times: &[f64], folder: &str, parts: &[&str]) -> String {
    let mut text = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n",
    );
    for (i, t) in times.iter().enumerate() {
        for (part, name) in parts.iter().enumerate() {
            text += &format!(
                "<DataSet timestep=\"{t:?}\" part=\"{part}\" name=\"{name}\" file=\"{folder}/{name}_{i:05}.vtu\"/>\n"
            );
        }
    }
    text + "</Collection>\n</VTKFile>\n"
}

#[cfg(test)]
#[path = "../../tests/unit/output/frame.rs"]
mod tests;
