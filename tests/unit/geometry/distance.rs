//! Unit tests of `src/geometry/distance.rs`.

use super::*;
use crate::math::Pose;

fn v<const D: usize>(x: [f64; D]) -> Vector<D> {
    Vector::from(x)
}

fn near(a: f64, b: f64) {
    assert!((a - b).abs() < 1e-12, "{a} differs from {b}");
}

#[test]
fn signed_distances_are_exact_and_negative_inside() {
    let block = Shape::Box { size: v([2.0, 4.0, 6.0]) };
    near(block.signed_distance(&v([0.5, 0.0, 0.0])), -0.5);
    near(block.signed_distance(&v([4.0, 6.0, 0.0])), 5.0);
    near(Shape::Ball { radius: 1.0 }.signed_distance(&v([3.0, 4.0])), 4.0);
    let capsule = Shape::Capsule { length: 2.0, radius: 0.5, axis: 1 };
    near(capsule.signed_distance(&v([0.0, 2.0])), 0.5);
    near(capsule.signed_distance(&v([0.25, 0.7])), -0.25);
    let can = Shape::Cylinder { length: 2.0, radius: 1.0, axis: 0 };
    near(can.signed_distance(&v([0.9, 0.0, 0.0])), -0.1);
    near(can.signed_distance(&v([4.0, 5.0, 0.0])), 5.0);
    let both = Shape::Compound(vec![
        (Pose::at(v([3.0, 0.0])), Shape::Ball { radius: 1.0 }),
        (Pose::identity(), Shape::Ball { radius: 1.0 }),
    ]);
    near(both.signed_distance(&v([3.0, 0.5])), -0.5);
}

#[test]
fn a_polyline_wall_is_solid_to_the_right_of_its_line() {
    let points = [[0.0, 1.0], [0.0, 0.0], [2.0, 0.0]].map(Vector::from).to_vec();
    let wall = Shape::Polyline { points, thickness: 0.4 };
    near(wall.signed_distance(&v([0.3, 0.5])), 0.3);
    near(wall.signed_distance(&v([1.0, -0.1])), -0.1);
    near(wall.signed_distance(&v([1.0, -0.9])), 0.5);
    near(wall.signed_distance(&v([-0.03, -0.04])), -0.05);
    near(wall.signed_distance(&v([2.3, -0.2])), 0.3);
}

#[test]
fn a_tank_is_solid_in_its_walls_only() {
    let tank = Shape::Tank { size: v([4.0, 2.0]), thickness: 0.5 };
    near(tank.signed_distance(&v([1.0, 1.5])), 1.0);
    near(tank.signed_distance(&v([2.0, -0.2])), -0.2);
    near(tank.signed_distance(&v([-0.2, 1.9])), -0.1);
    near(tank.signed_distance(&v([0.3, 2.4])), 0.5);
    near(tank.signed_distance(&v([-1.5, 1.0])), 1.0);
    near(tank.signed_distance(&v([-0.3, -0.4])), -0.1);
}

#[test]
fn the_notch_of_a_concave_polygon_is_outside() {
    let points = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 1.0], [0.0, 2.0]].map(Vector::from).to_vec();
    let notch = Shape::Polygon { points };
    near(notch.signed_distance(&v([1.0, 1.5])), 0.125_f64.sqrt());
    near(notch.signed_distance(&v([1.0, 0.25])), -0.25);
}
