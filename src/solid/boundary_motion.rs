//! Boundary particles follow their solid: r = pose · local, v = V + Ω (r − centre). They are not integrated, so they do not drift.

use crate::math::Vector;
use crate::solid::Kinematics;

/// Places boundary particles with their solid.
///
///   r = x + R r_local,   v = V + Ω (r − centre)
///
/// `local`: positions in the solid's frame (m). Writes world positions `r` (m) and velocities `v` (m/s), in
/// the same order; all three have the same length.
///
/// Source: @pirkhalili2023, eq. (25).
pub fn place_boundary_particles<const D: usize>(
    kinematics: &Kinematics<D>,
    local: &[Vector<D>],
    r: &mut [Vector<D>],
    v: &mut [Vector<D>],
) {
    assert!(local.len() == r.len() && local.len() == v.len(), "a skin has one r and one v a particle");
    for ((local, r), v) in local.iter().zip(r).zip(v) {
        *r = kinematics.pose.point(local);
        *v = kinematics.velocity + kinematics.spin.velocity_at(&(*r - kinematics.centre));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Bivector, Pose};

    #[test]
    fn a_turning_solid_carries_its_skin() {
        let quarter = std::f64::consts::FRAC_PI_2;
        let kinematics = Kinematics {
            pose: Pose::rotated(Vector::from([1.0, 2.0]), &[quarter]),
            centre: Vector::from([1.0, 2.0]),
            velocity: Vector::from([0.5, 0.0]),
            spin: Bivector::from_axial(&[2.0]),
        };
        let (mut r, mut v) = (vec![Vector::zeros()], vec![Vector::zeros()]);
        place_boundary_particles(&kinematics, &[Vector::from([3.0, 0.0])], &mut r, &mut v);
        // The arm (3, 0) is turned to (0, 3); a counter-clockwise spin of 2 rad/s moves it to −x at 6 m/s.
        assert!((r[0] - Vector::from([1.0, 5.0])).norm() < 1e-15);
        assert!((v[0] - Vector::from([-5.5, 0.0])).norm() < 1e-14);
    }
}
