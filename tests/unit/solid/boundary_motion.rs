//! Unit tests of `src/solid/boundary_motion.rs`.

use super::*;
use crate::math::{Bivector, Pose};

#[test]
fn boundary_particles_move_with_a_rotating_solid() {
    let quarter = std::f64::consts::FRAC_PI_2;
    let kinematics = Kinematics {
        pose: Pose::rotated(Vector::from([1.0, 2.0]), &[quarter]),
        centre: Vector::from([1.0, 2.0]),
        velocity: Vector::from([0.5, 0.0]),
        spin: Bivector::from_axial(&[2.0]),
    };
    let (mut r, mut v) = (vec![Vector::zeros()], vec![Vector::zeros()]);
    place_boundary_particles(&kinematics, &[Vector::from([3.0, 0.0])], &mut r, &mut v);
    // The arm (3, 0) is rotated to (0, 3); a counter-clockwise spin of 2 rad/s moves its end towards −x at 6 m/s.
    assert!((r[0] - Vector::from([1.0, 5.0])).norm() < 1e-15);
    assert!((v[0] - Vector::from([-5.5, 0.0])).norm() < 1e-14);
}
