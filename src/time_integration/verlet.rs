//! Verlet:  v⁺ = v⁻ + (Δt⁻ + Δt) F,  r⁺ = r + Δt v + ½Δt² F,  ρ⁺ = ρ⁻ + (Δt⁻ + Δt) R;  every so many steps
//! Euler's  v⁺ = v + Δt F,  ρ⁺ = ρ + Δt R,  so that even and odd steps stay together.
//!
//! Δt⁻ is the step before: with a constant step this is 2Δt, eqs. (12), (13) of the paper, and with a varying one
//! it is centred still. A body gets the impulse ½(Δt⁻ + Δt) F a step, by which ½(P⁺ + P) of the water and
//! P⁺ of the bodies add up to a constant: their plain sum differs from it by half a step's change of the
//! water's momentum, ½(P⁺ − P), and does not drift. An Euler step gives Δt F and adds ½(P − P⁻ − Δt F),
//! less than the largest change in a step.
//!
//! A leapfrog amplifies what damps: under diffusion and viscosity the difference of even and odd steps grows as
//! exp(λt), λ = (7 δ + 3.5 α) c₀/h for the shortest waves (Σ V |∂W| = 3.5/h² under Wendland C2). With δ = 0.1 and
//! CFL 0.2 fifty steps are seven e-foldings, and a still tank blows up; so an Euler step comes after 3.5 of them
//! (there every 25 steps), or after `euler_every` steps if that is sooner.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::{Shifts, step_boundary_density};
use crate::{
    coupling::{Accounting, Interval},
    math::Vector,
    model::Model,
    particles::PARTICLES_PER_TASK,
    system::{Reordering, StepCheck, System, permute, reflected},
};

/// How many e-foldings of the difference of even and odd steps are let grow. A still tank (2-D, 10 dp deep, h = √3 dp)
/// stands with 3.5 between Euler steps and is lost with 7.
pub(crate) const FOLDINGS: f64 = 3.5;

/// The scheme @verlet1967, eqs. (12), (13) of @pirkhalili2023, and the step before.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Verlet<const D: usize> {
    euler_every: u32,
    /// λ, 1/s.
    growth: f64,
    /// Steps since the last Euler step, and e-foldings since.
    steps: u32,
    foldings: f64,
    dt_before: f64,
    v_before: Vec<Vector<D>>,
    rho_before: Vec<f64>,
    skin_rho_before: Vec<f64>,
}

/// The step before: what a device takes and gives back.
#[cfg(feature = "gpu")]
pub(crate) struct VerletHistory<const D: usize> {
    /// Velocities of the water, m/s; empty before the first step.
    pub(crate) velocity: Vec<Vector<D>>,
    /// Its densities, kg/m³.
    pub(crate) density: Vec<f64>,
    /// Densities of the boundary particles, kg/m³.
    pub(crate) boundary_density: Vec<f64>,
    /// Length of the step, s.
    pub(crate) dt: f64,
    /// Steps since the last Euler step, and e-foldings since.
    pub(crate) steps: u32,
    pub(crate) foldings: f64,
}

impl<const D: usize> Verlet<D> {
    /// At the start of a run with this model; the first step is Euler's.
    pub(crate) fn new(euler_every: u32, model: &Model) -> Self {
        Self {
            euler_every: euler_every.max(1),
            growth: (model.diffusion.damping() + model.viscosity.damping()) * model.c0 / model.h,
            steps: 0,
            foldings: 0.0,
            dt_before: 0.0,
            v_before: Vec::new(),
            rho_before: Vec::new(),
            skin_rho_before: Vec::new(),
        }
    }

    /// The step before, for a device.
    #[cfg(feature = "gpu")]
    pub(crate) fn history(&self) -> VerletHistory<D> {
        VerletHistory {
            velocity: self.v_before.clone(),
            density: self.rho_before.clone(),
            boundary_density: self.skin_rho_before.clone(),
            dt: self.dt_before,
            steps: self.steps,
            foldings: self.foldings,
        }
    }

    /// Takes the step before from a device.
    #[cfg(feature = "gpu")]
    pub(crate) fn set_history(&mut self, history: VerletHistory<D>) {
        (self.v_before, self.rho_before) = (history.velocity, history.density);
        self.skin_rho_before = history.boundary_density;
        (self.dt_before, self.steps, self.foldings) = (history.dt, history.steps, history.foldings);
    }

    /// The velocities (m/s) from which the next step goes on.
    pub(crate) fn previous_velocities_mut(&mut self) -> &mut [Vector<D>] {
        &mut self.v_before
    }

    /// Follows the water into a new order; the dried boundary particles are at `rho0` (kg/m³).
    pub(crate) fn reorder(&mut self, reordering: &Reordering<D>, rho0: f64) {
        permute(&mut self.v_before, &reordering.order);
        self.v_before.iter_mut().zip(&reordering.reflections).for_each(|(v, axes)| *v = reflected(*axes, *v));
        permute(&mut self.rho_before, &reordering.order);
        if !self.skin_rho_before.is_empty() {
            reordering.dried.iter().for_each(|&i| self.skin_rho_before[i as usize] = rho0);
        }
    }

    /// Forgets the step before: the next step is Euler's.
    pub(crate) fn reset(&mut self) {
        self.v_before.clear();
        self.rho_before.clear();
        self.skin_rho_before.clear();
    }

    /// Advances the water, whose rates at the start are known, over an interval; returns the factor of the loads on bodies.
    pub(super) fn step(
        &mut self,
        system: &mut System<D>,
        over: Interval,
        mut accounting: Option<&mut Accounting<D>>,
    ) -> f64 {
        let dt = over.dt;
        let rho0 = system.properties().rho0;
        let first = self.v_before.is_empty() && self.skin_rho_before.is_empty();
        let euler = first || self.steps >= self.euler_every || self.foldings > FOLDINGS;
        // An Euler step is a Verlet step whose step before had no length and ended here.
        if euler {
            (self.steps, self.foldings) = (0, 0.0);
            self.v_before.clone_from(&system.fluid.particles.v);
            self.rho_before.clone_from(&system.fluid.particles.rho);
            self.skin_rho_before.clone_from(&system.boundary.particles.rho);
        }
        let span = if euler { dt } else { self.dt_before + dt };
        accounting.iter_mut().for_each(|accounting| accounting.add_force_pass(system, dt));
        let shifts = Shifts::of(system, dt, &mut accounting);

        let guard = system.valid_range();
        let (fluid, rates) = system.fluid_and_rates();
        let before = self.v_before.par_iter_mut().zip(&mut self.rho_before);
        let now = fluid.r.par_iter_mut().zip(&mut fluid.v).zip(&mut fluid.rho);
        system.status.step_check = now
            .zip(before)
            .zip(rates.positions_at_build())
            .enumerate()
            .with_min_len(PARTICLES_PER_TASK)
            .map(|(i, ((((r, v), rho), (v_before, rho_before)), then))| {
                let s = rates.of(i);
                let shift = shifts.map(|shifts| shifts.displacement(&rates, i, v));
                *r += *v * dt + s.acceleration * (0.5 * dt * dt);
                if let Some(shift) = shift {
                    *r += shift;
                }
                (*v_before, *v) = (*v, *v_before + s.acceleration * span);
                (*rho_before, *rho) = (*rho, *rho_before + rho0 * s.compression_rate * span);
                guard.check(then, r, v, *rho)
            })
            .reduce(|| StepCheck::INITIAL, StepCheck::combine);
        let before = &mut self.skin_rho_before;
        step_boundary_density(system, span, |dx, [_, i], rho| {
            std::mem::replace(&mut before[i], rho) + rho0 * dx * span
        });

        self.dt_before = dt;
        self.steps += 1;
        self.foldings += self.growth * dt;
        if euler { 1.0 } else { 0.5 * span / dt }
    }
}
