//! Reactions of locks, end stops and ropes along their rows, where the engine reports only part of them.
//!
//! With several solver iterations rapier reports only the impulse of the last one. With one iteration it omits 1e-6 of the
//! impulse, from position correction. The momentum of the solids gives the rest: for its unexplained change R, the reactions f
//! satisfy Σ f Jᵀ = R. The method starts from the last impulse times the number of iterations. It corrects row by row,
//! f ← f + J M⁻¹ R/(J M⁻¹ Jᵀ), until R vanishes (Kaczmarz 1937).

use super::jacobian::{ConstraintJacobian, Mobility};
use crate::{
    math::{Pose, Vector},
    solid::{Kinematics, Load},
};

/// Most iterations over all reactions.
const SWEEPS: usize = 200;

/// A reaction along a row of two solids.
pub(in crate::solid) struct Reaction<const D: usize> {
    /// Their numbers; `None` is the world.
    pub(in crate::solid) between: [Option<usize>; 2],
    pub(in crate::solid) jacobian: ConstraintJacobian<D>,
    pub(in crate::solid) mobility: [Mobility<D>; 2],
    /// On the second, along the row, N or N m.
    pub(in crate::solid) force: f64,
}

impl<const D: usize> Reaction<D> {
    /// Its loads on both solids.
    pub(in crate::solid) fn loads(&self) -> [Load<D>; 2] {
        self.jacobian.loads(self.force)
    }

    /// Subtracts `loads` from the unexplained loads `left` on both solids.
    fn take(&self, loads: [Load<D>; 2], left: &mut [Load<D>]) {
        for (end, load) in self.between.iter().zip(loads) {
            if let Some(solid) = end {
                left[*solid] = left[*solid] - load;
            }
        }
    }

    /// The force along the row that the unexplained loads `left` on both solids require.
    fn lacks(&self, left: &[Load<D>]) -> f64 {
        let ends = [0, 1].map(|k| {
            let load = self.between[k].map_or_else(Load::zero, |solid| left[solid]);
            let mobility = &self.mobility[k];
            let velocity = mobility.linear.component_mul(&load.force);
            Kinematics {
                pose: Pose::identity(),
                centre: Vector::zeros(),
                velocity,
                spin: mobility.spin_change(&load.torque),
            }
        });
        let ease = self.jacobian.inverse_effective_mass(&self.jacobian, &self.mobility);
        if ease > 0.0 { self.jacobian.rate(&ends) / ease } else { 0.0 }
    }
}

/// Returns the part of the acceleration `reaction` by joints, ropes and contacts in the last step that opposes the `known`
/// acceleration, and no more than it, m/s² or rad/s². The load of an impact does not last.
pub(super) fn borne(known: f64, reaction: f64) -> f64 {
    reaction.clamp((-known).min(0.0), (-known).max(0.0))
}

/// Corrects the `pulls` so that they add up to the load `told` on each solid.
pub(in crate::solid) fn project<const D: usize>(pulls: &mut [Reaction<D>], told: &[Load<D>]) {
    let mut left = told.to_vec();
    pulls.iter().for_each(|pull| pull.take(pull.loads(), &mut left));
    for _ in 0..SWEEPS {
        let (mut change, mut largest) = (0.0f64, 0.0f64);
        for pull in pulls.iter_mut() {
            let more = pull.lacks(&left);
            pull.force += more;
            pull.take(pull.jacobian.loads(more), &mut left);
            (change, largest) = (change.max(more.abs()), largest.max(pull.force.abs()));
        }
        if change <= 1e-14 * largest {
            break;
        }
    }
}

#[cfg(test)]
#[path = "../../../tests/unit/solid/constraint/reactions.rs"]
mod tests;
