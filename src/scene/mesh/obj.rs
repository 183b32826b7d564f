//! OBJ files: corners and facets of any number of corners. Colours, textures, normals, groups, points and lines are not
//! used.

use std::path::Path;

use super::{MeshFile, coordinate, damaged, text};
use crate::{
    error::Result,
    geometry::triangulation::{MOST_CORNERS, triangulate},
    math::Vector,
};

/// Keywords without effect on the surface.
const UNUSED: [&str; 24] = [
    "vt",
    "vn",
    "vp",
    "g",
    "o",
    "s",
    "mg",
    "l",
    "p",
    "usemtl",
    "mtllib",
    "usemap",
    "maplib",
    "lod",
    "bevel",
    "c_interp",
    "d_interp",
    "shadow_obj",
    "trace_obj",
    "csh",
    "call",
    "ctech",
    "stech",
    "end",
];

/// Keywords of curved surfaces, which have no facets.
const CURVED: [&str; 5] = ["surf", "curv", "curv2", "cstype", "deg"];

/// Returns the content of an OBJ file.
pub(super) fn parse(path: &Path, bytes: &[u8]) -> Result<MeshFile> {
    let (text, notes) = text(path, bytes)?;
    let mut file = MeshFile { notes, ..MeshFile::default() };
    // Corners of the facets, from 0, and line and number of corners of each facet. Corners may follow their facets.
    let (mut corners, mut faces): (Vec<i64>, Vec<(usize, usize)>) = (Vec::new(), Vec::new());
    let mut lines = text.lines().enumerate().map(|(i, line)| (i + 1, line));
    while let Some((number, line)) = lines.next() {
        // A backslash at its end continues the line.
        let mut line = line.split('#').next().unwrap_or_default().trim().to_string();
        while let Some(begin) = line.strip_suffix('\\') {
            let after = lines.next().map_or("", |(_, after)| after);
            line = format!("{begin} {}", after.split('#').next().unwrap_or_default().trim());
        }
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            None => {}
            Some("v") => {
                let mut next = || coordinate(path, number, words.next());
                let point = Vector::from([next()?, next()?, next()?]);
                let others: Vec<&str> = words.collect();
                if let [weight] = others[..]
                    && coordinate(path, number, Some(weight))? != 1.0
                {
                    return Err(damaged(path, format!("line {number}: a corner with the weight {weight}, not 1")));
                }
                file.surface.points.push(point);
            }
            Some("f" | "fo") => {
                let before = corners.len();
                for word in words {
                    corners.push(index(path, number, word, file.surface.points.len())?);
                }
                if corners.len() > before + MOST_CORNERS {
                    return Err(damaged(path, format!("line {number}: a facet of more than {MOST_CORNERS} corners")));
                }
                if corners.len() < before + 3 {
                    return Err(damaged(path, format!("line {number}: a facet has three corners or more")));
                }
                faces.push((number, corners.len() - before));
            }
            Some(word) if CURVED.contains(&word) => {
                let why = format!("line {number}: \"{word}\" describes a curved surface, which is not read");
                return Err(damaged(path, why).help("export it as triangles (\"mesh\", \"tessellate\")"));
            }
            Some(word) if UNUSED.contains(&word) => {}
            Some(word) => {
                let word: String = word.chars().take(20).collect();
                return Err(damaged(path, format!("line {number}: \"{word}\" is no word of OBJ")));
            }
        }
    }
    let count = file.surface.points.len();
    let mut rest = &corners[..];
    for (line, size) in faces {
        let (face, after) = rest.split_at(size);
        rest = after;
        if let Some(missing) = face.iter().find(|corner| !(0..count as i64).contains(*corner)) {
            let why = format!("line {line}: there is no corner {}, only {count}", missing + 1);
            return Err(damaged(path, why));
        }
        let face: Vec<u32> = face.iter().map(|&corner| corner as u32).collect();
        for facet in triangles(&file.surface.points, &face) {
            file.push_indices(path, facet, 0)?;
        }
    }
    file.surface.parts = connected_parts(file.surface.points.len(), &file.surface.facets);
    Ok(file)
}

/// Returns the number, from 0, of the corner that `word` names; negative numbers count back from the `count` corners
/// before the line.
fn index(path: &Path, line: usize, word: &str, count: usize) -> Result<i64> {
    let number: Option<i64> = word.split('/').next().and_then(|number| number.parse().ok());
    match number {
        Some(number) if number > 0 => Ok(number - 1),
        Some(number) if number < 0 && number >= -(count as i64) => Ok(count as i64 + number),
        Some(number) => Err(damaged(path, format!("line {line}: there is no corner {number}"))),
        None => Err(damaged(path, format!("line {line}: \"{word}\" is no corner"))),
    }
}

/// Returns the triangles of a polygon: those around its first corner if it is convex, otherwise ears.
fn triangles(points: &[Vector<3>], face: &[u32]) -> Vec<[u32; 3]> {
    let at = |i: usize| points[face[i % face.len()] as usize];
    let fan = (1..face.len() - 1).map(|i| [face[0], face[i], face[i + 1]]).collect();
    let normal = (1..face.len() - 1).map(|i| (at(i) - at(0)).cross(&(at(i + 1) - at(0)))).sum::<Vector<3>>();
    let convex = (0..face.len()).all(|i| (at(i + 1) - at(i)).cross(&(at(i + 2) - at(i + 1))).dot(&normal) >= 0.0)
        && (1..face.len() - 1).all(|i| (at(i) - at(0)).cross(&(at(i + 1) - at(0))).dot(&normal) >= 0.0);
    let Some(normal) = normal.try_normalize(0.0).filter(|_| !convex) else { return fan };
    let across = if normal[0].abs() < 0.6 { Vector::from([1.0, 0.0, 0.0]) } else { Vector::from([0.0, 1.0, 0.0]) };
    let first = normal.cross(&across).normalize();
    let second = normal.cross(&first);
    let flat: Vec<[f64; 2]> =
        (0..face.len()).map(|i| [first.dot(&(at(i) - at(0))), second.dot(&(at(i) - at(0)))]).collect();
    let ring: Vec<u32> = (0..face.len() as u32).collect();
    match triangulate(&flat, &ring, &[]) {
        Some(triangles) => triangles.into_iter().map(|t| t.map(|i| face[i as usize])).collect(),
        None => fan,
    }
}

/// Returns the part of each facet: facets that share corners of the file are one part.
fn connected_parts(corners: usize, facets: &[[u32; 3]]) -> Vec<u32> {
    // Each corner refers to an earlier corner of its part; the first corner refers to itself.
    let mut above: Vec<u32> = (0..corners as u32).collect();
    fn first(above: &mut [u32], mut i: u32) -> u32 {
        while above[i as usize] != i {
            above[i as usize] = above[above[i as usize] as usize];
            i = above[i as usize];
        }
        i
    }
    for facet in facets {
        let [a, b, c] = facet.map(|p| first(&mut above, p));
        let least = a.min(b).min(c);
        [a, b, c].iter().for_each(|&p| above[p as usize] = least);
    }
    facets.iter().map(|facet| first(&mut above, facet[0])).collect()
}
