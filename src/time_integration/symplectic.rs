//! Symplectic position Verlet: half a step with the forces at n, then the whole step with the forces at n+½.
//!
//!   r^{n+½} = r^n + ½Δt v^n,  v^{n+½} = v^n + ½Δt F^n,  ρ^{n+½} = ρ^n + ½Δt R^n
//!   v^{n+1} = v^n + Δt F^{n+½},  r^{n+1} = r^n + ½Δt (v^n + v^{n+1}),
//!   ρ^{n+1} = ρ^n (2 − ε)/(2 + ε),  ε = −Δt R^{n+½}/ρ^{n+½}
//!
//! Pair forces along r_ab at r^{n+½} conserve linear and angular momentum to round-off. Bodies get the
//! same F^{n+½} over the same Δt.

use rayon::prelude::*;

use super::{Shifts, step_boundary_density};
use crate::{
    coupling::{Accounting, Interval, drift_half_step},
    interaction::RequestedSums,
    particles::PARTICLES_PER_TASK,
    system::{StepCheck, System, own_water, own_water::StateAtStart},
};

/// The scheme @dominguez2022; it keeps no state between steps.
pub(crate) struct Symplectic;

impl Symplectic {
    /// Advances the water, whose rates at the start are known, over an interval; returns the factor of the loads on bodies.
    pub(super) fn step<const D: usize>(
        &self,
        system: &mut System<D>,
        over: Interval,
        mut accounting: Option<&mut Accounting<D>>,
    ) -> f64 {
        let (dt, half) = (over.dt, 0.5 * over.dt);
        let rho0 = system.properties().rho0;
        let mut start = StateAtStart::of(system);
        let (fluid, rates) = system.fluid_and_rates();
        let (these, own) = rates.own_water();
        let now =
            fluid.r[these.clone()].par_iter_mut().zip(&mut fluid.v[these.clone()]).zip(&mut fluid.rho[these.clone()]);
        system.status.step_check = now
            .zip(&rates.positions_at_build()[these.clone()])
            .enumerate()
            .with_min_len(PARTICLES_PER_TASK)
            .map(|(i, (((r, v), rho), then))| {
                let i = these.start + i;
                if own.is_some_and(|own| !own[i]) {
                    return StepCheck::INITIAL;
                }
                let s = rates.of(i);
                *r += *v * half;
                *v += s.acceleration * half;
                *rho += rho0 * s.compression_rate * half;
                StepCheck::displacement(then, r)
            })
            .reduce(|| StepCheck::INITIAL, StepCheck::combine);
        own_water::combine_checks(system);
        step_boundary_density(system, half, |dx, _, rho| rho + rho0 * dx * half);
        drift_half_step(system, over);

        system.rebuild_within_step(&mut start);
        system.update_rates(RequestedSums::All);

        accounting.iter_mut().for_each(|accounting| accounting.add_force_pass(system, dt));
        let shifts = Shifts::of(system, dt, &mut accounting);
        let whole = |rho_start: f64, rho_half: f64, dx: f64| {
            let epsilon = -dt * rho0 * dx / rho_half;
            rho_start * (2.0 - epsilon) / (2.0 + epsilon)
        };
        let guard = system.valid_range();
        let (fluid, rates) = system.fluid_and_rates();
        let (these, own) = rates.own_water();
        let now =
            fluid.r[these.clone()].par_iter_mut().zip(&mut fluid.v[these.clone()]).zip(&mut fluid.rho[these.clone()]);
        system.status.step_check = now
            .zip(&rates.positions_at_build()[these.clone()])
            .enumerate()
            .with_min_len(PARTICLES_PER_TASK)
            .map(|(i, (((r, v), rho), then))| {
                let i = these.start + i;
                if own.is_some_and(|own| !own[i]) {
                    return StepCheck::INITIAL;
                }
                let (s, (r_start, v_start, rho_start)) = (rates.of(i), start.particle(i));
                let shift = shifts.map(|shifts| shifts.displacement(&rates, i, v));
                *v = v_start + s.acceleration * dt;
                *r = r_start + (v_start + *v) * half;
                if let Some(shift) = shift {
                    *r += shift;
                }
                *rho = whole(rho_start, *rho, s.compression_rate);
                guard.check(then, r, v, *rho)
            })
            .reduce(|| StepCheck::INITIAL, StepCheck::combine);
        own_water::combine_checks(system);
        step_boundary_density(system, dt, |dx, [place, _], rho| whole(start.boundary_density(place), rho, dx));
        1.0
    }
}
