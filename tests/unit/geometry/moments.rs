//! Unit tests of `src/geometry/moments.rs`.

use super::*;

fn near(a: f64, b: f64) {
    assert!((a - b).abs() < 1e-12 * (1.0 + b.abs()), "{a} differs from {b}");
}

#[test]
fn a_compound_of_two_rotated_halves_has_the_moments_of_the_box() {
    let half = Shape::Box { size: Vector::from([1.0, 2.0]) };
    let whole = Shape::Box { size: Vector::from([2.0, 2.0]) }.volume_properties();
    let at = |x: f64| Pose::rotated(Vector::from([x, 3.0]), &[std::f64::consts::PI]);
    let joined = Shape::Compound(vec![(at(0.5), half.clone()), (at(1.5), half)]).volume_properties();
    near(joined.volume, whole.volume);
    near(joined.centroid[0], 1.0);
    near((joined.second_moment - whole.second_moment).norm(), 0.0);
}

#[test]
fn a_rectangular_polygon_has_the_moments_of_the_box() {
    let points = [[1.0, 1.0], [4.0, 1.0], [4.0, 3.0], [1.0, 3.0]].map(Vector::from).to_vec();
    let drawn = Shape::Polygon { points };
    let v = drawn.volume_properties();
    near(v.volume, 6.0);
    near((v.centroid - Vector::from([2.5, 2.0])).norm(), 0.0);
    near(v.second_moment[(0, 0)], 6.0 * 9.0 / 12.0);
    near(v.second_moment[(0, 1)], 0.0);
    near(drawn.surface_area(), 10.0);
}

#[test]
fn round_shapes_have_the_textbook_moments() {
    let ball = Shape::<3>::Ball { radius: 2.0 };
    let tr = ball.volume_properties().second_moment.trace();
    near(2.0 / 3.0 * tr, 0.4 * ball.volume_properties().volume * 4.0); // 2/5 m r²
    near(ball.surface_area(), 16.0 * PI);
    let can = Shape::<3>::Cylinder { length: 3.0, radius: 1.0, axis: 2 }.volume_properties();
    near(can.second_moment[(0, 0)] + can.second_moment[(1, 1)], 0.5 * 3.0 * PI); // m r²/2
    // A capsule of no length is a ball.
    let short = Shape::<3>::Capsule { length: 1e-14, radius: 2.0, axis: 0 }.volume_properties();
    near((short.second_moment - ball.volume_properties().second_moment).norm(), 0.0);
    let disc = Shape::<2>::Capsule { length: 2.0, radius: 1.0, axis: 0 };
    near(disc.volume_properties().volume, 4.0 + PI);
    near(disc.surface_area(), 4.0 + 2.0 * PI);
    // ∫ x²: 2·2³/12 of the middle, π/4 + 2·4/3 + π of the ends.
    near(disc.volume_properties().second_moment[(0, 0)], 4.0 / 3.0 + PI / 4.0 + 8.0 / 3.0 + PI);
}

#[test]
fn a_tank_has_the_moments_of_its_three_slabs() {
    let tank = Shape::Tank { size: Vector::from([4.0, 2.0]), thickness: 0.5 };
    let v = tank.volume_properties();
    near(v.volume, 2.5 + 2.0);
    near(v.centroid[0], 2.0);
    near(v.centroid[1], (2.5 * -0.25 + 2.0 * 1.0) / 4.5);
    near(tank.surface_area(), 5.0 + 2.0 * 2.5 + 2.0 * 0.5 + 2.0 * 2.0 + 4.0);
    let points = [[0.0, 2.0], [0.0, 0.0], [4.0, 0.0], [4.0, 2.0]].map(Vector::from).to_vec();
    let wall = Shape::Polyline { points, thickness: 0.5 };
    near((wall.volume_properties().second_moment - v.second_moment).norm(), 0.0);
    near((wall.bounds().min - tank.bounds().min).norm(), 0.0);
}
