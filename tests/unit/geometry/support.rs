//! Boxes around turned shapes.

use super::*;

#[test]
fn a_turned_box_reaches_as_far_as_its_corner() {
    let shape = Shape::<2>::Box { size: Vector::from([0.2, 0.2]) };
    let bounds = world_bounds(&shape, &Pose::rotated(Vector::from([0.0, 0.7]), &[45f64.to_radians()]));
    let half_diagonal = 0.1 * 2f64.sqrt();
    // Round-off of a sine and a product: a few 1e-16.
    assert!((bounds.min[1] - 0.7 + half_diagonal).abs() < 1e-15);
    assert!((bounds.max[1] - 0.7 - half_diagonal).abs() < 1e-15);
}

#[test]
fn a_turned_wall_reaches_as_far_as_its_outline_also_as_a_part() {
    let points = [[-0.3, 0.3], [0.0, 0.0], [0.3, 0.3]].map(Vector::from).to_vec();
    let wall = Shape::Polyline { points, thickness: 0.06 };
    let pose = Pose::<2>::rotated(Vector::from([1.0, 2.0]), &[45f64.to_radians()]);
    // The left leg lies level on its far side, 0.06 m below its line through the origin.
    let bounds = world_bounds(&wall, &pose);
    assert!((bounds.min[1] - (2.0 - 0.06)).abs() < 1e-14, "{}", bounds.min[1]);
    let other = Pose::<2>::rotated(Vector::from([1.0, 2.0]), &[-45f64.to_radians()]);
    assert!((world_bounds(&wall, &other).min[1] - (2.0 - 0.06)).abs() < 1e-14);
    let part = Shape::Compound(vec![(Pose::at(Vector::from([0.5, 0.0])), wall)]);
    let along = pose.rotation * Vector::from([0.5, 0.0]);
    assert!((world_bounds(&part, &pose).min[1] - (2.0 - 0.06 + along[1])).abs() < 1e-14);
}
