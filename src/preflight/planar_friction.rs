//! Bodies in 3-D that move in a plane and hang on a rope that leaves the plane: the engine computes no friction for them.
//!
//! rapier solves both directions of friction at once, with the inverse of a 2 × 2 matrix, which is singular if a contact point can move
//! in one of the two directions only. The module `solid::rapier::planar_friction` mends this where nothing acts across the plane.

use super::{Finding, PreflightContext};
use crate::{math::Bivector, solid::Role};

/// Distance of both ends of a rope across the plane over their distance, up to which the rope lies in the plane, –.
const IN_PLANE: f64 = 1e-3;

/// Adds a note for each free body on such a rope that can neither move along an axis nor turn out of the plane normal to it.
pub(super) fn check<const D: usize>(context: &PreflightContext<D>, findings: &mut Vec<Finding>) {
    if D < 3 {
        return;
    }
    for (i, solid) in context.solids().iter().enumerate() {
        let Role::Free(body) = &solid.spec.role else { continue };
        let is_normal = |axis: &usize| {
            let turns = (0..Bivector::<D>::COMPONENTS).filter(|turn| turn != axis);
            body.locked_translations[*axis] && turns.into_iter().all(|turn| body.locked_rotations[turn])
        };
        let can_move = body.locked_translations.contains(&false);
        let Some(axis) = (0..D).find(is_normal).filter(|_| can_move) else { continue };
        let leaves = context.system.constraints().ropes.iter().find(|rope| {
            let [a, b] = &rope.ends;
            [a, b].iter().any(|end| end.solid == Some(i))
                && (a.at[axis] - b.at[axis]).abs() > IN_PLANE * (a.at - b.at).norm()
        });
        let Some(rope) = leaves else { continue };
        let what = format!(
            "\"{}\" moves in a plane, by its locks or by a symmetry plane that cuts it, and the rope \"{}\" leaves this plane: in \
             contacts the body has no friction",
            solid.spec.name, rope.name
        );
        let mend = "where friction matters, free a turn out of the plane, or compute the whole model";
        findings.push(Finding::note("planar_friction", what, mend.into()));
    }
}
