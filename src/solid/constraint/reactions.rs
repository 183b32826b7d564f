//! Reactions of locks, end stops and ropes along their rows, where the engine reports only part of them.
//!
//! With several solver iterations rapier reports only the last impulse; with one, position correction leaves 1e-6 unreported.
//! The momentum of the solids gives the rest: with R its unexplained change, the reactions f satisfy Σ f Jᵀ = R. Starting from the last impulse times the
//! number of iterations they are corrected row by row, f ← f + J M⁻¹ R/(J M⁻¹ Jᵀ), until R vanishes (Kaczmarz 1937).

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

    /// Takes `loads` from what is `left` of both.
    fn take(&self, loads: [Load<D>; 2], left: &mut [Load<D>]) {
        for (end, load) in self.between.iter().zip(loads) {
            if let Some(solid) = end {
                left[*solid] = left[*solid] - load;
            }
        }
    }

    /// The force along the row that what is `left` of both asks for.
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

/// Mends the `pulls` so that they come to `told` of each solid.
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
mod tests {
    use super::*;
    use crate::math::Bivector;

    #[test]
    fn pulls_are_found_from_what_they_did() {
        // Two bodies of 2 and 3 kg and 0.1, 0.2 kg m² on two ropes, to one another and to the ground.
        let body = |x: f64| Kinematics {
            pose: Pose::at(Vector::<2>::new(x, 0.0)),
            centre: Vector::<2>::new(x, 0.0),
            velocity: Vector::zeros(),
            spin: Bivector::zero(),
        };
        let mobility = |mass: f64, inertia: f64| {
            let mut mobility = Mobility::<2>::none();
            mobility.linear = Vector::<2>::repeat(1.0 / mass);
            mobility.angular[(0, 0)] = 1.0 / inertia;
            mobility
        };
        let (a, b, ground) = (mobility(2.0, 0.1), mobility(3.0, 0.2), Mobility::none());
        let row = |n: [f64; 2], at: [f64; 2], ends: [f64; 2]| {
            ConstraintJacobian::at_point(Vector::from(n), &Vector::from(at), &ends.map(body))
        };
        let pull = |between, row, mobility, force| Reaction { between, jacobian: row, mobility, force };
        let mut pulls = [
            pull([Some(0), Some(1)], row([0.8, 0.6], [0.3, 0.1], [0.0, 1.0]), [a, b], 40.0),
            pull([Some(1), None], row([0.0, 1.0], [1.1, 0.0], [1.0, 0.0]), [b, ground], -7.0),
        ];
        let mut told = [Load::zero(); 2];
        for pull in &pulls {
            for (end, load) in pull.between.iter().zip(pull.loads()) {
                end.iter().for_each(|solid| told[*solid] += load);
            }
        }
        pulls.iter_mut().for_each(|pull| pull.force = 1.0);
        project(&mut pulls, &told);
        // Each sweep leaves some part; what is left of forces of 40 N is round-off.
        assert!((pulls[0].force - 40.0).abs() < 1e-9 && (pulls[1].force + 7.0).abs() < 1e-9);
    }
}
