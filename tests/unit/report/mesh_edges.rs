//! Unit tests of `src/report/mesh_edges.rs`.

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

/// A ball of radius 1 m with this number of belts of facets.
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
fn the_lines_of_a_block_are_its_twelve_edges() -> Result<()> {
    let lines = mesh_lines(&block([0.4, 0.2, 0.1])?);
    let length = |line: &Outline| (Vector::from(line.points[0]) - Vector::from(line.points[1])).norm();
    assert_eq!(lines.len(), 12, "no diagonals, no cuts");
    assert!((lines.iter().map(length).sum::<f64>() - 4.0 * 0.7).abs() < 1e-12);
    Ok(())
}

#[test]
fn the_lines_of_a_ball_are_closed_cuts_on_its_surface() -> Result<()> {
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
        // Chords of 24 belts are shorter than the circle by at most (π/24)²/4, and their depth is of the same order.
        let exact = std::f64::consts::TAU * radius.sqrt();
        assert!((length / exact - 1.0).abs() < 0.01, "{length} m of {exact} m");
    }
    Ok(())
}

/// Distance (m) of the plane of a cut from the origin.
fn off(line: &Outline) -> f64 {
    let level = |axis: usize| line.points.iter().all(|x| (x[axis] - line.points[0][axis]).abs() < 1e-12);
    (0..3).find(|&axis| level(axis)).map_or(f64::NAN, |axis| line.points[0][axis])
}
