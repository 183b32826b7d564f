//! Meshes beside a scene: STL, as text or binary, and OBJ, in any unit; the size limit of files.

use std::{
    fs::File,
    io::{Cursor, Read},
    path::Path,
};

use crate::{
    error::{Error, Result},
    geometry::{Mesh, mesh::MAX_FACETS},
    math::Vector,
};

/// Size of the largest mesh or drawing, B.
const MOST_BYTES: u64 = 64 << 20;

/// Longest line of a mesh in text, B: the loaders store a whole line.
const LONGEST: usize = 10_000;

/// Corners, in the file's unit, and facets.
type Facets = (Vec<Vector<3>>, Vec<[u32; 3]>);

/// Reads the solid in the file at `path`, whose unit is `unit` (m). `flip` reverses the facets.
///
/// # Errors
/// `File` if the file cannot be read; `Scene` if the file is neither STL nor OBJ, too large, damaged, or not a solid.
pub(crate) fn read(path: &Path, unit: f64, flip: bool) -> Result<Mesh> {
    let kind = path.extension().and_then(|e| e.to_str()).unwrap_or("").to_ascii_lowercase();
    let load = match kind.as_str() {
        "stl" => stl,
        "obj" => obj,
        _ => {
            let what =
                format!("{} is not a mesh that is known: its name ends in neither .stl nor .obj", path.display());
            return Err(Error::scene(what).help("export it as STL (text or binary) or OBJ"));
        }
    };
    let (mut points, mut facets) = load(path, bytes(path)?)?;
    points.iter_mut().for_each(|p| *p *= unit);
    if flip {
        facets.iter_mut().for_each(|f| f.swap(0, 1));
    }
    Mesh::new(&points, &facets).map_err(|e| Error { message: format!("{}: {}", path.display(), e.message), ..e })
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

/// Returns the error that the mesh has too many facets, without their number.
fn too_many(path: &Path) -> Error {
    Error::scene(format!("{} has more than {MAX_FACETS} facets", path.display()))
        .help("thin it out (\"decimate\"): what is finer than dp cannot be seen")
}

/// Returns whether the file is text whose lines are short enough for the loaders.
fn is_text(bytes: &[u8]) -> bool {
    bytes.split(|b| *b == b'\n').all(|line| line.len() <= LONGEST)
}

fn stl(path: &Path, mut bytes: Vec<u8>) -> Result<Facets> {
    // A file of 84 bytes plus 50 bytes for each facet is binary, even if it begins with the keyword of the text format.
    let count = bytes.get(80..84).and_then(|c| c.try_into().ok()).map_or(0, |c| u32::from_le_bytes(c) as usize);
    let binary = bytes.len() >= 84 && bytes.len() - 84 >= 50 * count.min(bytes.len());
    let begun = bytes.iter().position(|b| !b.is_ascii_whitespace()).unwrap_or(0);
    let named = bytes[begun..].get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    let fits = binary && bytes.len() == 84 + 50 * count;
    if named && !fits {
        if !is_text(&bytes) {
            return Err(damaged(path, format!("it has a line of more than {LONGEST} bytes")));
        }
        // The loader requires lower case and a name after the first keyword.
        let text = bytes[begun..].to_ascii_lowercase();
        let rest = text.iter().position(|b| *b == b'\n').map_or(&[][..], |end| &text[end..]);
        bytes = [b"solid mesh", rest].concat();
    } else if !binary {
        return Err(damaged(path, "it is neither STL as text, which begins with \"solid\", nor as long as it says"));
    } else {
        bytes[0] = b' ';
    }
    let mut bytes = Cursor::new(bytes);
    let (mut points, mut facets) = (Vec::new(), Vec::new());
    for facet in stl_io::create_stl_reader(&mut bytes).map_err(|why| damaged(path, why))? {
        if facets.len() == MAX_FACETS {
            return Err(too_many(path));
        }
        let first = points.len() as u32;
        let corners = facet.map_err(|why| damaged(path, why))?.vertices;
        points.extend(corners.map(|p| Vector::from_fn(|i, _| f64::from(p[i]))));
        facets.push([first, first + 1, first + 2]);
    }
    Ok((points, facets))
}

fn obj(path: &Path, bytes: Vec<u8>) -> Result<Facets> {
    if !is_text(&bytes) {
        return Err(damaged(path, format!("it has a line of more than {LONGEST} bytes")));
    }
    let options =
        tobj::LoadOptions { triangulate: true, ignore_points: true, ignore_lines: true, ..Default::default() };
    let no_colours = |_: &Path| Err(tobj::LoadError::OpenFileFailed);
    let (models, _) =
        tobj::load_obj_buf(&mut Cursor::new(bytes), &options, no_colours).map_err(|why| damaged(path, why))?;
    let (mut points, mut facets) = (Vec::new(), Vec::new());
    for tobj::Model { mesh, .. } in models {
        let first = points.len() as u32;
        points.extend(mesh.positions.chunks_exact(3).map(Vector::from_column_slice));
        facets.extend(mesh.indices.chunks_exact(3).map(|f| [first + f[0], first + f[1], first + f[2]]));
        if facets.len() > MAX_FACETS {
            return Err(too_many(path));
        }
    }
    Ok((points, facets))
}
