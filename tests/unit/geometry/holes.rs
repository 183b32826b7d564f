//! Unit tests of `src/geometry/holes.rs`.

use super::*;

/// Places half a dp apart in a square of 12 dp, between two rows at heights of 0 and `gap` (dp), and the points of these rows: square
/// lattices over one another, the first points the middle 8 dp.
fn rows(gap: f64) -> (Vec<Vector<3>>, usize, Vec<Vector<3>>) {
    let (mut middle, mut edge, mut places) = (Vec::new(), Vec::new(), Vec::new());
    let is_edge = |n: i32| !(2..10).contains(&n);
    for (i, j) in (0..12).flat_map(|i| (0..12).map(move |j| (i, j))) {
        for height in [0.0, gap] {
            let x = Vector::from([f64::from(i), f64::from(j), height]);
            if is_edge(i) || is_edge(j) { edge.push(x) } else { middle.push(x) }
        }
        if !is_edge(i) && !is_edge(j) {
            places.extend((0..4).map(|k| Vector::from([i.into(), j.into(), 0.5 * gap]) + offset(k)));
        }
    }
    let movable = middle.len();
    middle.extend(edge);
    (middle, movable, places)
}

fn offset(k: u32) -> Vector<3> {
    Vector::from([0.5 * f64::from(k % 2), 0.5 * f64::from(k / 2), 0.0])
}

#[test]
fn the_holes_between_rows_over_one_another_are_found() {
    // A hole lies in the middle of each cell of 1 × 1 × 1.3, at half its diagonal from the corners.
    let (points, _, places) = rows(1.3);
    let found = holes(&points, &places, 1.0, Some);
    let exact = 0.5 * (2.0_f64 + 1.3 * 1.3).sqrt();
    for (i, j) in (2..9).flat_map(|i| (2..9).map(move |j| (i, j))) {
        let centre = Vector::from([f64::from(i) + 0.5, f64::from(j) + 0.5, 0.65]);
        // The last step of the climb is 0.01 dp long.
        let is_this = |(x, radius): &&Hole<3>| (x - centre).norm() < 0.03 && (radius - exact).abs() < 0.02;
        assert!(found.iter().any(|hole| is_this(&hole)), "no hole at {centre}");
    }
}

#[test]
fn points_move_into_wide_holes_and_stay_apart() {
    // Rows 1.35 apart with 1.16 points for each square of 1 × 1: over one another they have holes of 0.95, staggered ones of 0.82.
    // The fixed edge keeps some from being staggered; water did not get through holes of 0.91.
    let (mut points, movable, places) = rows(1.35);
    points.iter_mut().for_each(|x| (x[0], x[1]) = (0.93 * x[0], 0.93 * x[1]));
    for (i, x) in points[..movable].iter_mut().enumerate() {
        let (sin, cos) = (2.4 * i as f64).sin_cos();
        (x[0], x[1]) = (x[0] + 0.1 * sin, x[1] + 0.1 * cos);
    }
    let fixed = points[movable..].to_vec();
    let largest = |points: &[Vector<3>]| holes(points, &places, 1.0, Some).iter().map(|h| h.1).fold(0.0, f64::max);
    let before = largest(&points);
    let flat = |_: usize, from: &Vector<3>, x: &mut Vector<3>| x[2] = from[2];
    let between = |x: Vector<3>| Some(Vector::from([x[0], x[1], x[2].clamp(0.0, 1.35)]));
    close_holes(&mut points, movable, &places, 1.0, between, flat);
    let after = largest(&points);
    assert!(before > 0.93 && after < 0.91, "{before} became {after}");
    assert_eq!(points[movable..], fixed);
    let pairs = (1..points.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
    let least = pairs.map(|(i, j)| (points[i] - points[j]).norm()).fold(f64::INFINITY, f64::min);
    assert!(least > 0.7, "two points are {least} dp apart");
}
