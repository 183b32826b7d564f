//! Areas and coverage of triangulated polygons.

use super::*;

/// Returns the sum of the areas of the triangles. Asserts that each runs counter-clockwise.
fn area(points: &[Position], triangles: &[[u32; 3]]) -> f64 {
    let at = |i: u32| points[i as usize];
    let areas = triangles.iter().map(|&[a, b, c]| 0.5 * cross(at(a), at(b), at(c)));
    areas.inspect(|area| assert!(*area > -1e-12, "a triangle runs clockwise")).sum()
}

#[test]
fn a_concave_polygon_is_filled_once() {
    // A comb of three teeth: 7 × 1 less two gaps of 1 × 0.8 each; 5.4.
    let points = [
        [0.0, 0.0],
        [7.0, 0.0],
        [7.0, 1.0],
        [5.0, 1.0],
        [5.0, 0.2],
        [4.0, 0.2],
        [4.0, 1.0],
        [3.0, 1.0],
        [3.0, 0.2],
        [2.0, 0.2],
        [2.0, 1.0],
        [0.0, 1.0],
    ];
    let ring: Vec<u32> = (0..12).collect();
    let triangles = triangulate(&points, &ring, &[]).unwrap();
    assert_eq!(triangles.len(), 10);
    assert!((area(&points, &triangles) - 5.4).abs() < 1e-14);
}

#[test]
fn holes_stay_empty() {
    // A square of 4 × 4 with two holes of 1 × 1, clockwise: 14.
    let square = |x: f64, y: f64, size: f64| [[x, y], [x + size, y], [x + size, y + size], [x, y + size]];
    let points = [square(0.0, 0.0, 4.0), square(0.5, 1.0, 1.0), square(2.5, 1.5, 1.0)].concat();
    let triangles = triangulate(&points, &[0, 1, 2, 3], &[vec![7, 6, 5, 4], vec![11, 10, 9, 8]]).unwrap();
    // n corners and h holes give n + 2 h − 2 triangles.
    assert_eq!(triangles.len(), 14);
    assert!((area(&points, &triangles) - 14.0).abs() < 1e-14);
}

#[test]
fn every_corner_on_a_straight_side_is_used() {
    // A rectangle with 20 corners on each long side.
    let long = |y: f64| (0..20).map(move |i| [f64::from(i) / 19.0, y]);
    let points: Vec<Position> = long(0.0).chain(long(0.3).rev()).collect();
    let ring: Vec<u32> = (0..40).collect();
    let triangles = triangulate(&points, &ring, &[]).unwrap();
    assert!((area(&points, &triangles) - 0.3).abs() < 1e-14);
    let degenerate = triangles.iter().filter(|t| area(&points, &[**t]) < 1e-9).count();
    assert_eq!((triangles.len(), degenerate), (38, 0));
}
