//! Time integration: the length of a step and the schemes that advance the water. No sums over pairs.

mod sponge;
pub mod step_size;
mod symplectic;
mod verlet;

pub(crate) use symplectic::Symplectic;
pub(crate) use verlet::Verlet;
#[cfg(feature = "gpu")]
pub(crate) use verlet::{FOLDINGS, VerletHistory};

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::{
    coupling::{Accounting, Interval},
    interaction::RequestedSums,
    math::Vector,
    model::{Model, TimeScheme},
    particles::PARTICLES_PER_TASK,
    sph::{AuxiliarySums, FluidProperties, boundary::relaxation, particle_shifting::Shift},
    system::{FluidRates, MomentumTransfer, Reordering, System, repel_from_thin_faces},
};

/// The chosen scheme with its state.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) enum Stepper<const D: usize> {
    /// Verlet.
    Verlet(Verlet<D>),
    /// Symplectic.
    Symplectic,
}

impl<const D: usize> Stepper<D> {
    /// The stepper of a model's scheme, at the start of a run.
    pub(crate) fn new(model: &Model) -> Self {
        match model.scheme {
            TimeScheme::Verlet { euler_every } => Self::Verlet(Verlet::new(euler_every, model)),
            TimeScheme::Symplectic => Self::Symplectic,
        }
    }

    /// Reorders the arrays of particles with the water, whose reference density is `rho0` (kg/m³).
    pub(crate) fn reorder(&mut self, reordering: &Reordering<D>, rho0: f64) {
        if let Self::Verlet(verlet) = self {
            verlet.reorder(reordering, rho0);
        }
    }

    /// Adds the impulses that the water got to the velocities from which the next step starts.
    pub(crate) fn add_transfers(&mut self, transfers: &[MomentumTransfer<D>]) {
        if let Self::Verlet(verlet) = self {
            let before = verlet.previous_velocities_mut();
            let changes = transfers.iter().flat_map(|transfer| &transfer.changes);
            changes.for_each(|(i, change)| before[*i] += change);
        }
    }

    /// The sums that the force pass at the start of a step computes. Shifting and stress need theirs once a step: at the middle of a
    /// symplectic one.
    pub(crate) fn sums_at_start(&self) -> RequestedSums {
        match self {
            Self::Verlet(_) => RequestedSums::All,
            Self::Symplectic => RequestedSums::Rates,
        }
    }

    /// Discards the step before, after particles were added or removed; the next step is one that needs none.
    pub(crate) fn reset(&mut self) {
        if let Self::Verlet(verlet) = self {
            verlet.reset();
        }
    }

    /// Advances the water of `system`, whose rates at the start are known, over an interval; returns the factor of the loads of
    /// the last force pass on the bodies, –.
    pub(crate) fn step(
        &mut self,
        system: &mut System<D>,
        over: Interval,
        mut accounting: Option<&mut Accounting<D>>,
    ) -> f64 {
        let weight = match self {
            Self::Verlet(verlet) => verlet.step(system, over, accounting.as_deref_mut()),
            Self::Symplectic => Symplectic.step(system, over, accounting.as_deref_mut()),
        };
        if let Some((transfer, impulses)) = repel_from_thin_faces(system, over.dt, weight) {
            let accounting = accounting.as_deref_mut();
            accounting.into_iter().for_each(|accounting| accounting.add_repelled(system, transfer.energy, &impulses));
            self.add_transfers(&[transfer]);
        }
        let before = if let Self::Verlet(verlet) = self { Some(verlet.previous_velocities_mut()) } else { None };
        let measured = accounting.as_ref().is_some_and(|accounting| accounting.has_energy_budget());
        let absorbed = sponge::damp_velocities(system, over.dt, before, measured);
        accounting.into_iter().for_each(|accounting| accounting.add_absorbed(absorbed));
        weight
    }
}

/// The shifting of the water in a step.
#[derive(Clone, Copy)]
struct Shifts<const D: usize> {
    law: Shift,
    dt: f64,
    properties: FluidProperties<D>,
}

impl<const D: usize> Shifts<D> {
    /// That of a step `dt` (s), which is added to the budget; `None` if the model does not shift.
    fn of(system: &System<D>, dt: f64, accounting: &mut Option<&mut Accounting<D>>) -> Option<Self> {
        let shifts = Self { law: system.model().shift()?, dt, properties: *system.properties() };
        if let Some(accounting) = accounting {
            let rates = system.fluid_rates();
            let water = system.fluid.particles.v.par_iter().enumerate().with_min_len(PARTICLES_PER_TASK);
            let all: Vec<_> = water.map(|(i, v)| shifts.displacement(&rates, i, v)).collect();
            accounting.add_shifting(system, &all);
        }
        Some(shifts)
    }

    /// Displacement (m) of water particle `i` of velocity `v` (m/s).
    fn displacement(&self, rates: &FluidRates<'_, D>, i: usize, v: &Vector<D>) -> Vector<D> {
        let mut sums = AuxiliarySums::filled_with(0.0);
        rates.read_auxiliary_of(i, &mut sums);
        if sums.shifting_suppressed > 0.0 {
            return Vector::zeros();
        }
        self.law.displacement(&sums, v.norm(), self.dt, &self.properties).into()
    }
}

/// Sets the densities of boundary particles near water to what `rho` makes of their rate dx/dt (1/s), index and density, and
/// relaxes them over `dt` (s).
fn step_boundary_density<const D: usize>(
    system: &mut System<D>,
    dt: f64,
    mut rho: impl FnMut(f64, [usize; 2], f64) -> f64,
) {
    let medium = system.properties();
    let relaxation = relaxation(dt, medium.h, medium.c0);
    let rates = std::mem::take(&mut system.rates.boundary);
    system.set_boundary_density(Some(relaxation), |[place, k, i], now| rho(rates[k].compression_rate, [place, i], now));
    system.rates.boundary = rates;
}
