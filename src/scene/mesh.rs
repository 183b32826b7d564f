//! Meshes beside a scene: STL, as text or binary, and OBJ, in any unit; the size limit of files.

mod obj;
mod stl;

use std::{fs::File, io::Read, path::Path};

use super::{
    context::FileNote,
    file_content::{self, Text},
};
use crate::{
    error::{Error, Result},
    geometry::{
        Mesh,
        mesh::{Completion, MAX_FACETS, Surface},
    },
    math::Vector,
};

/// Size of the largest mesh or drawing, B.
const MOST_BYTES: u64 = 64 << 20;

/// Longest word of a mesh in text, B.
const LONGEST: usize = 10_000;

/// Largest shift of corners by single precision without a warning, dp.
const MOST_SHIFT: f64 = 1e-3;

/// The interpretation of a mesh file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MeshOptions {
    /// Length of the file's unit, m.
    pub(crate) unit: f64,
    /// Whether the facets are reversed.
    pub(crate) flip: bool,
    /// Completion of a surface that is not closed. The tolerance of crossings follows from dp.
    pub(crate) completion: Completion,
    /// Particle spacing, m.
    pub(crate) dp: f64,
}

/// The content of a mesh file, in its own unit.
#[derive(Default)]
struct MeshFile {
    surface: Surface,
    /// Sentences about the content.
    notes: Vec<String>,
    /// Whether the coordinates are in single precision.
    single: bool,
}

impl MeshFile {
    /// Adds a facet with its own corners.
    fn push(&mut self, path: &Path, corners: [[f64; 3]; 3], part: u32) -> Result<()> {
        let first = self.surface.points.len() as u32;
        self.surface.points.extend(corners.map(Vector::<3>::from));
        self.push_indices(path, [first, first + 1, first + 2], part)
    }

    /// Adds a facet of corners that were added before.
    fn push_indices(&mut self, path: &Path, facet: [u32; 3], part: u32) -> Result<()> {
        if self.surface.facets.len() == MAX_FACETS {
            let what = format!("{} has more than {MAX_FACETS} facets", path.display());
            return Err(Error::scene(what).help("thin it out (\"decimate\"): what is finer than dp cannot be seen"));
        }
        self.surface.facets.push(facet);
        self.surface.parts.push(part);
        Ok(())
    }
}

/// A reader of the bytes of a file; the path is for messages.
type Parser = fn(&Path, &[u8]) -> Result<MeshFile>;

/// Reads the solid in the file at `path`, and notes about its content.
///
/// # Errors
/// `File` if the file cannot be read; `Scene` if the file is neither STL nor OBJ, too large, damaged, or not a solid.
pub(crate) fn read(path: &Path, options: &MeshOptions) -> Result<(Mesh, Vec<FileNote>)> {
    let kind = path.extension().and_then(|e| e.to_str()).unwrap_or("").to_ascii_lowercase();
    let (parse, wanted): (Parser, _) = match kind.as_str() {
        "stl" => (stl::parse, "STL"),
        "obj" => (obj::parse, "OBJ"),
        _ => {
            let what =
                format!("{} is not a mesh that is known: its name ends in neither .stl nor .obj", path.display());
            let help = match kind.as_str() {
                "gz" | "zip" | "7z" | "rar" => "unpack it, and give the STL or OBJ file in it",
                _ => "export it as STL (text or binary) or OBJ",
            };
            return Err(Error::scene(what).help(help));
        }
    };
    let bytes = bytes(path)?;
    file_content::check(path, &bytes, wanted)?;
    let MeshFile { mut surface, mut notes, single } = parse(path, &bytes)?;
    surface.points.iter_mut().for_each(|p| *p *= options.unit);
    if options.flip {
        surface.facets.iter_mut().for_each(|f| f.swap(0, 1));
    }
    let farthest = surface.points.iter().flat_map(|p| p.iter()).fold(0.0, |most: f64, x| most.max(x.abs()));
    let completion = Completion { crossing: MOST_SHIFT * options.dp, ..options.completion };
    let (mesh, changes) = surface.into_solid(&completion).map_err(|e| {
        let first = if notes.is_empty() { String::new() } else { format!("{}. ", notes.join("; ")) };
        Error { message: format!("{}: {first}{}", path.display(), e.message), ..e }
    })?;
    notes.extend(changes);
    let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    let compare = "compare its volume (`pontoon inspect --json`: solids, mesh) with that of the program that made it";
    let mut notes: Vec<FileNote> =
        notes.into_iter().map(|what| FileNote::note("mesh", format!("{name}: {what}"), compare.into())).collect();
    // Half of the distance between neighbouring numbers of 24 bits.
    let shift = farthest * f64::from(f32::EPSILON) / 2.0;
    if single && shift > MOST_SHIFT * options.dp {
        let what = format!(
            "{name}: binary STL has single precision; so far from the origin, up to {farthest:.4e} m, its corners are off \
             by up to {shift:.1e} m, {:.1e} dp",
            shift / options.dp
        );
        let mend = "move the model to the origin before its export, or export it as text (STL or OBJ)";
        notes.push(FileNote::warning("mesh_precision", what, mend.into()));
    }
    Ok((mesh, notes))
}

/// Returns the bytes of the file at `path`.
///
/// # Errors
/// `File` if the file cannot be read, `Scene` if the file is too large.
pub(crate) fn bytes(path: &Path) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let opened = File::open(path).and_then(|file| file.take(MOST_BYTES + 1).read_to_end(&mut bytes));
    opened.map_err(|why| Error::read(path, &why))?;
    if bytes.len() as u64 > MOST_BYTES {
        let what = format!("{} has more than {} MiB", path.display(), MOST_BYTES >> 20);
        return Err(Error::scene(what).help("thin it out: what is finer than dp cannot be seen"));
    }
    Ok(bytes)
}

fn damaged(path: &Path, why: impl std::fmt::Display) -> Error {
    Error::scene(format!("{} cannot be read: {why}", path.display())).help("export it again; a mesh is STL or OBJ")
}

/// Returns the text of the file, with `\n` for `\r` if lines end in `\r` alone, and a note about its encoding.
fn text(path: &Path, bytes: &[u8]) -> Result<(String, Vec<String>)> {
    let Text { text, encoding } = file_content::decode(bytes);
    let text = if text.contains('\n') { text } else { text.replace('\r', "\n") };
    if text.split_ascii_whitespace().any(|word| word.len() > LONGEST) {
        return Err(damaged(path, format!("it has a word of more than {LONGEST} bytes")));
    }
    Ok((text, encoding.map(|encoding| format!("it is {encoding}")).into_iter().collect()))
}

/// Returns the coordinate that `word` in `line` (from 1) gives.
fn coordinate(path: &Path, line: usize, word: Option<&str>) -> Result<f64> {
    let Some(word) = word else { return Err(damaged(path, format!("line {line}: a corner has three coordinates"))) };
    let parsed = word.parse().or_else(|_| word.replace(['d', 'D'], "e").parse::<f64>());
    match parsed {
        Ok(x) if x.is_finite() => Ok(x),
        Ok(_) => Err(damaged(path, format!("line {line}: the coordinate {word} is not a finite number"))),
        Err(_) if word.contains(',') => {
            let why = format!("line {line}: the coordinate {word} has a comma in place of the decimal point");
            Err(damaged(path, why).help("export it with decimal points (a setting of the language, often)"))
        }
        Err(_) => Err(damaged(path, format!("line {line}: {word} is not a number"))),
    }
}

#[cfg(all(test, feature = "dim3"))]
#[path = "../../tests/unit/scene/mesh.rs"]
mod tests;
