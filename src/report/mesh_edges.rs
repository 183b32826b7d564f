//! Converts a mesh to lines: its sharp edges, and cross-sections of its smooth parts.

use std::collections::BTreeMap;

use super::outline::Outline;
use crate::{geometry::Mesh, math::Vector};

/// The dihedral angle below which two adjacent facets form one smooth face, rad.
const SHARP: f64 = 0.5;

/// The dihedral angle below which two adjacent facets form one flat face, rad.
const FLAT: f64 = 1e-3;

/// The largest number of drawn edges; cross-sections represent a mesh with more sharp edges.
const MOST_EDGES: usize = 3000;

/// The positions of the cross-sections along the longest side, –. The other sides have one cross-section in the middle.
const CUTS: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];

/// An edge, as the numbers of its two corners in ascending order.
type EdgeCorners = [u32; 2];

/// Returns the lines of a mesh: its sharp edges, and cross-sections unless all faces are flat.
pub(crate) fn mesh_lines(mesh: &Mesh) -> Vec<Outline> {
    let turns = dihedral_angles(mesh);
    let sharp: Vec<&EdgeCorners> = turns.iter().filter(|(_, turn)| **turn >= SHARP).map(|(edge, _)| edge).collect();
    let smooth = turns.values().any(|turn| (FLAT..SHARP).contains(turn));
    let mut lines = Vec::new();
    if sharp.len() <= MOST_EDGES {
        let corner = |i: u32| mesh.points()[i as usize].into();
        lines.extend(sharp.iter().map(|edge| Outline { closed: false, points: edge.map(corner).to_vec() }));
    }
    if smooth || sharp.len() > MOST_EDGES {
        let (low, size) = (mesh.bounds().min, mesh.bounds().size());
        let longest = size.imax();
        for axis in 0..3 {
            let places = if axis == longest { &CUTS[..] } else { &[0.5] };
            lines.extend(places.iter().flat_map(|place| plane_section(mesh, axis, low[axis] + place * size[axis])));
        }
    }
    lines
}

/// Returns the angle between the normals of the two facets at each edge, rad.
fn dihedral_angles(mesh: &Mesh) -> BTreeMap<EdgeCorners, f64> {
    let mut normals: BTreeMap<EdgeCorners, Vec<Vector<3>>> = BTreeMap::new();
    for facet in mesh.facets() {
        let [a, b, c] = facet.map(|i| mesh.points()[i as usize]);
        let normal = (b - a).cross(&(c - a)).normalize();
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            normals.entry(edge(facet[i], facet[j])).or_default().push(normal);
        }
    }
    let turn = |normals: &Vec<Vector<3>>| match normals[..] {
        [a, b] => a.angle(&b),
        _ => std::f64::consts::PI,
    };
    normals.iter().map(|(edge, normals)| (*edge, turn(normals))).collect()
}

fn edge(a: u32, b: u32) -> EdgeCorners {
    [a.min(b), a.max(b)]
}

/// Returns the closed lines in which the plane `at` (m) across `axis` intersects a mesh.
///
/// On each intersected facet, one edge crosses the plane upwards and one edge crosses the plane downwards. A shared
/// edge has opposite directions on its two facets.
fn plane_section(mesh: &Mesh, axis: usize, at: f64) -> Vec<Outline> {
    let above = |i: u32| mesh.points()[i as usize][axis] >= at;
    let mut next: BTreeMap<EdgeCorners, EdgeCorners> = BTreeMap::new();
    for facet in mesh.facets() {
        let ends = [(0, 1), (1, 2), (2, 0)].map(|(i, j)| (facet[i], facet[j]));
        let leads =
            |up: bool| ends.into_iter().find(|&(a, b)| above(a) != up && above(b) == up).map(|(a, b)| edge(a, b));
        if let (Some(up), Some(down)) = (leads(true), leads(false)) {
            next.insert(up, down);
        }
    }
    let place = |[a, b]: EdgeCorners| -> [f64; 3] {
        let [a, b] = [a, b].map(|i| mesh.points()[i as usize]);
        (a + (b - a) * ((at - a[axis]) / (b[axis] - a[axis]))).into()
    };
    let mut lines = Vec::new();
    while let Some((start, mut now)) = next.pop_first() {
        let mut points = vec![place(start)];
        while now != start {
            points.push(place(now));
            let Some(then) = next.remove(&now) else { break };
            now = then;
        }
        lines.push(Outline { closed: true, points });
    }
    lines
}

#[cfg(all(test, feature = "dim3"))]
#[path = "../../tests/unit/report/mesh_edges.rs"]
mod tests;
