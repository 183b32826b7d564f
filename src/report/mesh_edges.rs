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
pub fn mesh_lines(mesh: &Mesh) -> Vec<Outline> {
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
mod tests {
    use super::*;
    use crate::error::Result;

    /// A block of the size of each side, m.
    fn block(size: [f64; 3]) -> Result<Mesh> {
        let points: Vec<Vector<3>> =
            (0..8).map(|i| Vector::from([0, 1, 2].map(|axis| size[axis] * f64::from(i >> axis & 1)))).collect();
        let facets = [
            [0, 2, 1],
            [1, 2, 3],
            [4, 5, 6],
            [5, 7, 6],
            [0, 1, 4],
            [1, 5, 4],
            [2, 6, 3],
            [3, 6, 7],
            [0, 4, 2],
            [2, 4, 6],
            [1, 3, 5],
            [3, 7, 5],
        ];
        Mesh::new(&points, &facets)
    }

    /// A ball of radius 1 m by so many belts of facets.
    fn ball(belts: u32) -> Result<Mesh> {
        let (around, step) = (2 * belts, std::f64::consts::PI / f64::from(belts));
        let on = |i: u32, j: u32| {
            let (polar, turn) = (f64::from(i) * step, f64::from(j) * step);
            Vector::from([polar.sin() * turn.cos(), polar.sin() * turn.sin(), polar.cos()])
        };
        let mut points = vec![on(0, 0)];
        points.extend((1..belts).flat_map(|i| (0..around).map(move |j| on(i, j))));
        points.push(on(belts, 0));
        let at = |i: u32, j: u32| match i {
            0 => 0,
            i if i == belts => 1 + (belts - 1) * around,
            i => 1 + (i - 1) * around + j % around,
        };
        let mut facets = Vec::new();
        for (i, j) in (0..belts).flat_map(|i| (0..around).map(move |j| (i, j))) {
            if i > 0 {
                facets.push([at(i, j), at(i + 1, j), at(i, j + 1)]);
            }
            if i + 1 < belts {
                facets.push([at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)]);
            }
        }
        Mesh::new(&points, &facets)
    }

    #[test]
    fn a_block_is_drawn_by_its_twelve_edges() -> Result<()> {
        let lines = mesh_lines(&block([0.4, 0.2, 0.1])?);
        let length = |line: &Outline| (Vector::from(line.points[0]) - Vector::from(line.points[1])).norm();
        assert_eq!(lines.len(), 12, "no diagonals, no cuts");
        assert!((lines.iter().map(length).sum::<f64>() - 4.0 * 0.7).abs() < 1e-12);
        Ok(())
    }

    #[test]
    fn a_ball_is_drawn_by_closed_cuts_that_lie_on_it() -> Result<()> {
        let mesh = ball(24)?;
        let lines = mesh_lines(&mesh);
        assert_eq!(lines.len(), CUTS.len() + 2);
        for line in &lines {
            assert!(line.closed);
            assert!(
                line.points.iter().all(|x| mesh.distance_and_normal(&Vector::from(*x)).0.abs() < 1e-9),
                "on its surface"
            );
            let round = line.points.iter().zip(line.points.iter().cycle().skip(1));
            let length: f64 = round.map(|(a, b)| (Vector::from(*a) - Vector::from(*b)).norm()).sum();
            let radius = Vector::from(line.points[0]).norm_squared() - off(line).powi(2);
            // Chords of 24 belts are shorter by at most (π/24)²/4 of the circle, and lie deeper by as much.
            let exact = std::f64::consts::TAU * radius.sqrt();
            assert!((length / exact - 1.0).abs() < 0.01, "{length} m of {exact} m");
        }
        Ok(())
    }

    /// How far the plane of a cut is from the origin, m.
    fn off(line: &Outline) -> f64 {
        let level = |axis: usize| line.points.iter().all(|x| (x[axis] - line.points[0][axis]).abs() < 1e-12);
        (0..3).find(|&axis| level(axis)).map_or(f64::NAN, |axis| line.points[0][axis])
    }
}
