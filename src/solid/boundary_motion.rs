//! Boundary particles follow their solid: r = pose · local, v = V + Ω (r − centre). They are not integrated and do not drift.

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
pub(crate) fn place_boundary_particles<const D: usize>(
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
#[path = "../../tests/unit/solid/boundary_motion.rs"]
mod tests;
