//! Loads of joints and ropes in series, which share a free solid.
//!
//! In each step the engine starts from zero and corrects one row after the other. In a chain, a sweep leaves most of the error: the
//! part n/(n + 1) for a light body between two ropes with n times its mass below. The bodies then sink until their position error, of
//! order g Δt², makes up for it. This error belongs to the length of the step: in a shorter step it causes a false load. Therefore
//! this module computes the loads λ with which all rows of the chain are at rest after the step:
//!
//!   J M⁻¹ Jᵀ λ = −(ẋ/Δt + ẍ)
//!
//! ẋ is the rate of a row before the step and ẍ its acceleration under the other loads, without contacts. A rope only pulls, and only
//! if it would become longer than its limit. The method is that of conjugate gradients with the diagonal as preconditioner. The engine
//! applies λ as forces and corrects the rest.

use super::jacobian::{ConstraintJacobian, Mobility, kinematics_of_end};
use crate::solid::{Kinematics, Load};

/// Most changes of the set of taut ropes in a step.
const ROUNDS: usize = 50;

/// Largest relative residual, –, of loads that the engine applies; it corrects the rest.
const RESIDUAL: f64 = 1e-6;

/// Inverse effective mass of a row along which locks hold its solids, over that without locks, –.
const LOCKED: f64 = 1e-20;

/// A lock, or a rope, of a chain.
pub(in crate::solid) struct SeriesRow<const D: usize> {
    /// Its solids; `None` is the world.
    pub(in crate::solid) between: [Option<usize>; 2],
    pub(in crate::solid) jacobian: ConstraintJacobian<D>,
    pub(in crate::solid) mobility: [Mobility<D>; 2],
    /// Rate at which a rope reaches its limit at the end of the step, m/s; `None` for a lock, whose rate is 0.
    pub(in crate::solid) limit: Option<f64>,
    /// Part of the pull in this step by which a rope can give way, N.
    pub(in crate::solid) pull: f64,
}

impl<const D: usize> SeriesRow<D> {
    /// Its acceleration under a load on each solid, m/s² or rad/s².
    fn acceleration(&self, loads: &[Load<D>]) -> f64 {
        let ends = self.between.map(|end| end.map_or_else(Load::zero, |solid| loads[solid]));
        self.jacobian.acceleration(&ends, &self.mobility)
    }

    /// Adds the loads of a `force` (N or N m) along it.
    fn add_loads(&self, force: f64, loads: &mut [Load<D>]) {
        for (end, load) in self.between.iter().zip(self.jacobian.loads(force)) {
            if let Some(solid) = end {
                loads[*solid] += load;
            }
        }
    }

    /// Whether its solids can move along it. If they cannot, round-off of its direction may leave a small component along a free axis.
    fn is_movable(&self) -> bool {
        let freely = |(load, mobility): (&Load<D>, &Mobility<D>)| {
            mobility.linear.max() * load.force.norm_squared() + mobility.angular.norm() * load.torque.0.norm_squared()
        };
        let loads = self.jacobian.loads(1.0);
        self.inverse_effective_mass() > LOCKED * loads.iter().zip(&self.mobility).map(freely).sum::<f64>()
    }

    /// The inverse effective mass of its two solids, 1/kg or 1/(kg m²).
    fn inverse_effective_mass(&self) -> f64 {
        self.jacobian.inverse_effective_mass(&self.jacobian, &self.mobility)
    }
}

/// Returns the sum of the loads of `forces` along `rows` on each of `solids` solids.
pub(in crate::solid) fn sum_loads<const D: usize>(
    rows: &[SeriesRow<D>],
    forces: &[f64],
    solids: usize,
) -> Vec<Load<D>> {
    let mut sum = vec![Load::zero(); solids];
    rows.iter().zip(forces).for_each(|(row, force)| row.add_loads(*force, &mut sum));
    sum
}

/// Returns the force (N or N m) along each row, on its second solid, in a step of `dt` (s) from the state `solids` under the
/// other `loads`. Returns zeros if the rows contradict one another.
pub(in crate::solid) fn series_forces<const D: usize>(
    rows: &[SeriesRow<D>],
    solids: &[Kinematics<D>],
    loads: &[Load<D>],
    dt: f64,
) -> Vec<f64> {
    let lacking = |row: &SeriesRow<D>| {
        let rate = row.jacobian.rate(&row.between.map(|end| kinematics_of_end(end, solids)));
        (row.limit.unwrap_or(0.0) - rate) / dt - row.acceleration(loads)
    };
    let wanted: Vec<f64> = rows.iter().map(lacking).collect();
    let scale = wanted.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let mut active: Vec<bool> = rows.iter().map(SeriesRow::is_movable).collect();
    let movable = active.clone();
    for _ in 0..ROUNDS {
        let Some(forces) = conjugate_gradients(rows, &active, &wanted, loads.len()) else { break };
        let given = sum_loads(rows, &forces, loads.len());
        let mut changed = false;
        for (i, row) in rows.iter().enumerate().filter(|(i, row)| row.limit.is_some() && movable[*i]) {
            let slack =
                if active[i] { forces[i] > row.pull } else { row.acceleration(&given) <= wanted[i] + 1e-9 * scale };
            changed |= active[i] == slack;
            active[i] = !slack;
        }
        if !changed {
            return forces;
        }
    }
    vec![0.0; rows.len()]
}

/// Solves J M⁻¹ Jᵀ λ = `wanted` for the `active` rows; the others bear nothing. Returns `None` if that is not possible.
fn conjugate_gradients<const D: usize>(
    rows: &[SeriesRow<D>],
    active: &[bool],
    wanted: &[f64],
    solids: usize,
) -> Option<Vec<f64>> {
    let masses: Vec<f64> = rows.iter().map(|row| 1.0 / row.inverse_effective_mass()).collect();
    let weigh = |rest: &[f64]| -> Vec<f64> {
        (0..rows.len()).map(|i| if active[i] { rest[i] * masses[i] } else { 0.0 }).collect()
    };
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let (mut forces, mut rest) = (vec![0.0; rows.len()], wanted.to_vec());
    let mut weighed = weigh(&rest);
    let (mut along, mut size) = (weighed.clone(), dot(&rest, &weighed));
    let first = size;
    for _ in 0..10 * rows.len() + 10 {
        if size <= 1e-28 * first {
            break;
        }
        let loads = sum_loads(rows, &along, solids);
        let answer: Vec<f64> = rows.iter().map(|row| row.acceleration(&loads)).collect();
        let part = size / dot(&along, &answer);
        if !part.is_finite() {
            break;
        }
        for i in 0..rows.len() {
            forces[i] += part * along[i];
            rest[i] -= part * answer[i];
        }
        weighed = weigh(&rest);
        let before = std::mem::replace(&mut size, dot(&rest, &weighed));
        along.iter_mut().zip(&weighed).for_each(|(along, new)| *along = new + *along * (size / before));
    }
    (size <= RESIDUAL * RESIDUAL * first).then_some(forces)
}

#[cfg(all(test, feature = "dim2", feature = "dim3"))]
#[path = "../../../tests/unit/solid/constraint/series.rs"]
mod tests;
