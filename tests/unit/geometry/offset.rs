//! Unit tests of `src/geometry/offset.rs`.

use super::*;

fn line(points: &[[f64; 2]]) -> Vec<Vector<2>> {
    points.iter().map(|&p| Vector::from(p)).collect()
}

/// The largest distance from a point of the face to its nearest boundary point.
fn largest_gap(face: &[Vector<2>], particles: &[BoundaryPoint<2>]) -> f64 {
    let at = |ab: &[Vector<2>], u: f64| ab[0] + (ab[1] - ab[0]) * u;
    let places = face.windows(2).flat_map(|ab| (0..200).map(|i| at(ab, (i as f64 + 0.5) / 200.0)).collect::<Vec<_>>());
    let nearest = |x: Vector<2>| particles.iter().map(|p| (p.r - x).norm()).fold(f64::INFINITY, f64::min);
    places.map(nearest).fold(0.0, f64::max)
}

#[test]
fn a_square_polygon_has_the_boundary_points_of_a_box() {
    let square = Shape::Polygon { points: line(&[[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]]) };
    let block = Shape::Box { size: Vector::from([1.0, 1.0]) }.boundary_points(0.1, 4);
    let drawn = square.boundary_points(0.1, 4);
    assert_eq!(drawn.len(), block.len());
    for p in &drawn {
        assert!(block.iter().any(|q| q.layer == p.layer && (q.r - p.r).norm() < 1e-7));
    }
}

#[test]
fn a_polyline_tank_has_the_boundary_points_of_a_tank() {
    let size = Vector::from([1.0, 0.5]);
    let wall = Shape::Polyline { points: line(&[[0.0, 0.5], [0.0, 0.0], [1.0, 0.0], [1.0, 0.5]]), thickness: 0.3 };
    let (drawn, tank) = (wall.boundary_points(0.1, 3), Shape::Tank { size, thickness: 0.3 }.boundary_points(0.1, 3));
    assert_eq!(drawn.len(), tank.len());
    for p in &drawn {
        assert!(tank.iter().any(|q| q.layer == p.layer && (q.r - p.r).norm() < 1e-7));
    }
}

#[test]
fn polyline_walls_with_bends_are_covered_by_points_at_the_right_depth() {
    let dp = 0.1;
    let smooth: Vec<_> = (0..60).map(|i| [0.04 * i as f64, (0.2 * i as f64).sin() * 0.3]).collect();
    let walls = [
        line(&[[0.0, 0.0], [1.03, 0.0], [2.1, 0.37]]),
        line(&[[0.0, 0.8], [0.6, 0.0], [1.2, 0.8]]),
        line(&[[0.0, 0.0], [1.0, 0.7], [2.0, 0.0]]),
        line(&[[0.0, 0.0], [0.9, 0.0], [0.9, 0.45], [1.4, 0.45], [1.4, 0.0], [2.0, 0.0]]),
        line(&smooth),
    ];
    for points in walls {
        let particles = Shape::Polyline { points: points.clone(), thickness: 0.3 }.boundary_points(dp, 3);
        for p in &particles {
            let LineSide::Right(depth) = side_of_line(&p.r, &points) else { panic!("{p:?} is in the water") };
            // Spans are sampled at intervals of dp/8; a shallow dip between two samples is not resolved.
            assert!(depth >= (p.layer as f64 + 0.5 - 1e-3) * dp, "{p:?} at {depth}");
        }
        // Half a dp of depth and half a spacing along the wall are 0.71 dp; the gap at the tip of a ridge is larger.
        assert!(largest_gap(&points, &particles) < 1.0 * dp, "{points:?}: {}", largest_gap(&points, &particles));
    }
}

#[test]
fn a_fine_polygon_has_as_many_boundary_points_as_a_disc() {
    let circle = |i: usize| (std::f64::consts::TAU * i as f64 / 90.0).sin_cos();
    let points: Vec<_> = (0..90).map(|i| Vector::from([circle(i).1, circle(i).0])).collect();
    let particles = Shape::Polygon { points }.boundary_points(0.1, 3);
    let disc = Shape::<2>::Ball { radius: 1.0 }.boundary_points(0.1, 3);
    assert_eq!(particles.len(), disc.len());
}
