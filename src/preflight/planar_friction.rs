//! Bodies in 3-D that move in a plane: the engine computes no friction for them.
//!
//! rapier solves both directions of friction at once, with the inverse of a 2 × 2 matrix. If a contact point can move in one of the two
//! directions only, this matrix is singular, and the engine takes the impulse as zero.

use super::{Finding, PreflightContext};
use crate::{math::Bivector, solid::Role};

/// Adds a note for each free body that can neither move along an axis nor turn out of the plane normal to it.
pub(super) fn check<const D: usize>(context: &PreflightContext<D>, findings: &mut Vec<Finding>) {
    if D < 3 {
        return;
    }
    for solid in context.solids() {
        let Role::Free(body) = &solid.spec.role else { continue };
        let is_planar = |axis: usize| {
            let turns = (0..Bivector::<D>::COMPONENTS).filter(|turn| *turn != axis);
            body.locked_translations[axis] && turns.into_iter().all(|turn| body.locked_rotations[turn])
        };
        let can_move = body.locked_translations.contains(&false);
        if !can_move || !(0..D).any(is_planar) {
            continue;
        }
        let what = format!(
            "\"{}\" moves in a plane, by its locks or by a symmetry plane that cuts it: in contacts it has no friction",
            solid.spec.name
        );
        let mend = "where friction matters, free a turn out of the plane, or compute the whole model";
        findings.push(Finding::note("planar_friction", what, mend.into()));
    }
}
