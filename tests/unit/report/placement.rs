//! Unit tests of `src/report/placement.rs`.

use super::*;
use crate::math::Vector;

#[test]
fn the_pose_of_a_solid_is_fitted_to_its_points() {
    let single = |x: Vector<3>| [x[0] as f32, x[1] as f32, x[2] as f32];
    let local: Vec<Vector<3>> =
        (0..40).map(|i| Vector::from([f64::from(i % 4), f64::from(i / 4 % 3), f64::from(i / 12)]) * 0.1).collect();
    let (start, end) = (
        Pose::<3>::rotated(Vector::from([1.0, 2.0, 3.0]), &[0.1, 0.2, 0.3]),
        Pose::<3>::rotated(Vector::from([1.5, 2.0, 2.0]), &[-1.0, 2.0, 0.7]),
    );
    let points = |pose: &Pose<3>| local.iter().map(|x| single(pose.point(x))).collect::<Vec<_>>();
    let found = Placement::from_pose(&start).fitted_to(&points(&start), &points(&end));
    let expected = Placement::from_pose(&end);
    let x = [0.3, -0.2, 0.1];
    let off = found.to_world(&x).iter().zip(expected.to_world(&x)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off < 1e-6, "the points have single precision, 1e-7 of 3 m; error {off}");
}

#[test]
fn the_fitted_pose_of_a_2d_solid_rotates_in_its_plane() {
    let start = Pose::<2>::at(Vector::from([1.0, 0.0]));
    let end = Pose::<2>::rotated(Vector::from([1.0, 0.0]), &[0.5]);
    let points = |pose: &Pose<2>| {
        [[0.1, 0.0], [0.0, 0.2], [-0.1, 0.0], [0.0, -0.2]]
            .map(|x| to_3d(&pose.point(&Vector::from(x))).map(|c| c as f32))
    };
    let found = Placement::from_pose(&start).fitted_to(&points(&start), &points(&end));
    assert!((found.turn[1][0] - 0.5_f64.sin()).abs() < 1e-6 && (found.turn[2][2] - 1.0).abs() < 1e-6, "{found:?}");
}
