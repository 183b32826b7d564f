//! A mesh as lines: its sharp edges, and cuts through what is smooth of it.

use std::collections::BTreeMap;

use super::outline::Outline;
use crate::{geometry::Mesh, math::Vector};

/// Two facets that meet at a smaller turn than this are one smooth face, rad.
const SHARP: f64 = 0.5;

/// Two facets that meet at a smaller turn than this are one flat face, rad.
const FLAT: f64 = 1e-3;

/// Most edges that are drawn; a surface rough all over shows by its cuts.
const MOST_EDGES: usize = 3000;

/// Where its longest side is cut, –. Its other sides are cut in the middle.
const CUTS: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];

/// An edge by the numbers of its two corners, the lower first.
type EdgeCorners = [u32; 2];

/// The lines of a mesh: edges at which its faces turn sharply, and unless all faces are flat, cuts across its sides.
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

/// By how much the two facets at each edge are turned against each other, rad.
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

/// The closed lines in which the plane across `axis` at `at` (m) cuts a mesh.
///
/// Round each facet that it cuts one edge leads up through it and one down; where one facet has it down, its neighbour has it up.
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
