//! Unit tests of `src/geometry/submerged_volume.rs`.

use super::*;

#[test]
fn a_submerged_shape_displaces_its_volume_at_its_centroid() {
    let pose = Pose::rotated(Vector::from([1.0, 2.0, 3.0]), &[0.3, -0.4, 0.5]);
    for shape in [
        Shape::Box { size: Vector::from([1.0, 2.0, 0.5]) },
        Shape::Ball { radius: 0.7 },
        Shape::Capsule { length: 1.0, radius: 0.3, axis: 0 },
        Shape::Cylinder { length: 1.0, radius: 0.3, axis: 1 },
        Shape::Tank { size: Vector::from([1.0, 2.0, 0.5]), thickness: 0.1 },
    ] {
        let (exact, (volume, centroid)) = (shape.volume_properties(), shape.submerged_volume(&pose, 9.0));
        assert!((volume / exact.volume - 1.0).abs() < 1e-10, "{shape:?}: {volume}");
        assert!((centroid - pose.point(&exact.centroid)).norm() < 1e-9, "{shape:?}: {centroid}");
        assert_eq!(shape.submerged_volume(&pose, -9.0).0, 0.0);
    }
}

#[test]
fn half_of_a_symmetric_shape_is_submerged_at_half_draft() {
    for axis in 0..3 {
        let capsule = Shape::Capsule { length: 1.0, radius: 0.3, axis };
        let (wet, _) = capsule.submerged_volume(&Pose::at(Vector::from([5.0, 5.0, 1.0])), 1.0);
        assert!((2.0 * wet / capsule.volume_properties().volume - 1.0).abs() < 1e-10);
    }
}

#[test]
fn submerged_volumes_at_partial_draft_follow_the_formulas() {
    // A standing box and cylinder: area times draft.
    let pose = Pose::at(Vector::from([0.2, 0.0, 0.0]));
    let (v, c) = Shape::Box { size: Vector::from([2.0, 3.0, 1.0]) }.submerged_volume(&pose, 0.2);
    assert!((v - 6.0 * 0.7).abs() < 1e-12 && (c - Vector::from([0.2, 0.0, -0.15])).norm() < 1e-12);
    let (v, _) = Shape::Cylinder { length: 1.0, radius: 0.5, axis: 2 }.submerged_volume(&pose, 0.1);
    assert!((v - PI * 0.25 * 0.6).abs() < 1e-10);
    // A lying cylinder: the circle's segment times the length.
    let (v, _) = Shape::Cylinder { length: 2.0, radius: 0.5, axis: 0 }.submerged_volume(&pose, 0.3);
    let (segment, _) = Shape::<2>::Ball { radius: 0.5 }.submerged_volume(&Pose::identity(), 0.3);
    assert!((v / (2.0 * segment) - 1.0).abs() < 1e-5, "{v}");
    // A standing capsule cut in its lower cap is a ball's cap.
    let (v, c) = Shape::<3>::Capsule { length: 1.0, radius: 0.5, axis: 2 }.submerged_volume(&Pose::identity(), -0.7);
    let (cap, at) = Shape::<3>::Ball { radius: 0.5 }.submerged_volume(&Pose::at(Vector::from([0.0, 0.0, -0.5])), -0.7);
    assert!((v - cap).abs() < 1e-5 * (PI / 4.0 + PI / 6.0) && (c - at).norm() < 1e-4, "{v} {cap}");
    // A 2-D wedge with its tip down: at half its height a quarter of its area is submerged.
    let points = [[0.0, 0.0], [1.0, 1.0], [-1.0, 1.0]].map(Vector::from).to_vec();
    let (v, c) = Shape::Polygon { points }.submerged_volume(&Pose::identity(), 0.5);
    assert!((v - 0.25).abs() < 1e-14 && (c[1] - 1.0 / 3.0).abs() < 1e-14);
}
