//! Symplectic position Verlet: half a step with the forces at n, then the whole step with the forces at n+½.
//!
//!   r^{n+½} = r^n + ½Δt v^n,  v^{n+½} = v^n + ½Δt F^n,  ρ^{n+½} = ρ^n + ½Δt R^n
//!   v^{n+1} = v^n + Δt F^{n+½},  r^{n+1} = r^n + ½Δt (v^n + v^{n+1}),
//!   ρ^{n+1} = ρ^n (2 − ε)/(2 + ε),  ε = −Δt R^{n+½}/ρ^{n+½}
//!
//! Pair forces along r_ab at r^{n+½} conserve linear and angular momentum to round-off. Bodies get the
//! same F^{n+½} over the same Δt.

use rayon::prelude::*;

use super::{Books, Interval, bodies};
use crate::{
    particles::PER_TASK,
    system::{Seen, System},
};

/// The scheme [@dominguez2022]; it remembers nothing between steps.
pub struct Symplectic;

impl Symplectic {
    /// Moves the water, whose rates at the start are known, over an interval; returns the weight of the loads on bodies.
    pub(super) fn step<const D: usize>(
        &self,
        system: &mut System<D>,
        over: Interval,
        mut books: Option<&mut Books<D>>,
    ) -> f64 {
        let (dt, half) = (over.dt, 0.5 * over.dt);
        let rho0 = system.medium().rho0;
        let start = (system.fluid.clone(), system.skin.rho.clone());

        let (sums, fluid) = (&system.sums, &mut system.fluid);
        let now = fluid.r.par_iter_mut().zip(&mut fluid.v).zip(&mut fluid.rho).zip(sums);
        system.seen = now
            .zip(system.near.built())
            .with_min_len(PER_TASK)
            .map(|((((r, v), rho), s), then)| {
                *r += *v * half;
                *v += s.dv * half;
                *rho += rho0 * s.dx * half;
                Seen::on_its_way(then, r)
            })
            .reduce(|| Seen::NOTHING, Seen::and);
        let rates = std::mem::take(&mut system.skin_sums);
        system.set_skin_density(half, |k, _, rho| rho + rho0 * rates[k].dx * half);
        system.skin_sums = rates;
        bodies::drift(system, over);

        system.relist();
        system.rates();

        books.iter_mut().for_each(|books| books.water(system, dt));
        let shifts = system.shifts(dt);
        let whole = |rho_start: f64, rho_half: f64, dx: f64| {
            let epsilon = -dt * rho0 * dx / rho_half;
            rho_start * (2.0 - epsilon) / (2.0 + epsilon)
        };
        let guard = system.guard();
        let (sums, was) = (&system.sums, &start.0);
        let fluid = &mut system.fluid;
        let now = fluid.r.par_iter_mut().zip(&mut fluid.v).zip(&mut fluid.rho).zip(sums);
        system.seen = now
            .zip(system.near.built())
            .enumerate()
            .with_min_len(PER_TASK)
            .map(|(i, ((((r, v), rho), s), then))| {
                *v = was.v[i] + s.dv * dt;
                *r = was.r[i] + (was.v[i] + *v) * half;
                *rho = whole(was.rho[i], *rho, s.dx);
                guard.see(then, r, v, *rho)
            })
            .reduce(|| Seen::NOTHING, Seen::and);
        if let Some(shifts) = shifts {
            books.iter_mut().for_each(|books| books.shifted(system, &shifts));
            let fluid = &mut system.fluid;
            fluid.r.par_iter_mut().zip(&shifts).with_min_len(PER_TASK).for_each(|(r, shift)| *r += shift);
            system.look();
        }
        let rates = std::mem::take(&mut system.skin_sums);
        system.set_skin_density(dt, |k, i, rho| whole(start.1[i], rho, rates[k].dx));
        system.skin_sums = rates;
        1.0
    }
}
