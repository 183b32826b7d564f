//! Symplectic position Verlet: half a step with the forces at n, then the whole step with the forces at n+½.
//!
//!   r^{n+½} = r^n + ½Δt v^n,  v^{n+½} = v^n + ½Δt F^n,  ρ^{n+½} = ρ^n + ½Δt R^n
//!   v^{n+1} = v^n + Δt F^{n+½},  r^{n+1} = r^n + ½Δt (v^n + v^{n+1}),
//!   ρ^{n+1} = ρ^n (2 − ε)/(2 + ε),  ε = −Δt R^{n+½}/ρ^{n+½}
//!
//! Pair forces along r_ab at r^{n+½} conserve linear and angular momentum to round-off. Bodies get the
//! same F^{n+½} over the same Δt.

use rayon::prelude::*;

use super::{Bodies, Interval};
use crate::{error::Result, particles::PER_TASK, system::System};

/// The scheme [@dominguez2022]; it remembers nothing between steps.
pub struct Symplectic;

impl Symplectic {
    /// Moves the system, whose rates at the start are known, over an interval.
    pub fn step<const D: usize>(&self, system: &mut System<D>, bodies: &mut Bodies<D>, over: Interval) -> Result<()> {
        let (dt, half) = (over.dt, 0.5 * over.dt);
        let rho0 = system.medium().rho0;
        let start = (system.fluid.clone(), system.skin.rho.clone());

        let sums = &system.sums;
        let fluid = &mut system.fluid;
        fluid.r.par_iter_mut().zip(&mut fluid.v).zip(&mut fluid.rho).zip(sums).with_min_len(PER_TASK).for_each(
            |(((r, v), rho), s)| {
                *r += *v * half;
                *v += s.dv * half;
                *rho += rho0 * s.dx * half;
            },
        );
        let rates = system.skin_sums.clone();
        system.set_skin_density(|i| start.1[i] + rho0 * rates[i].dx * half);
        bodies.drift(system, over);

        system.relist();
        system.rates();

        let shifts = system.shifts(dt);
        let whole = |rho_start: f64, rho_half: f64, dx: f64| {
            let epsilon = -dt * rho0 * dx / rho_half;
            rho_start * (2.0 - epsilon) / (2.0 + epsilon)
        };
        let (sums, was) = (&system.sums, &start.0);
        let fluid = &mut system.fluid;
        fluid
            .r
            .par_iter_mut()
            .zip(&mut fluid.v)
            .zip(&mut fluid.rho)
            .zip(sums)
            .enumerate()
            .with_min_len(PER_TASK)
            .for_each(|(i, (((r, v), rho), s))| {
                *v = was.v[i] + s.dv * dt;
                *r = was.r[i] + (was.v[i] + *v) * half;
                *rho = whole(was.rho[i], *rho, s.dx);
            });
        if let Some(shifts) = shifts {
            fluid.r.par_iter_mut().zip(&shifts).with_min_len(PER_TASK).for_each(|(r, shift)| *r += shift);
        }
        let (rates, at_half) = (system.skin_sums.clone(), system.skin.rho.clone());
        system.set_skin_density(|i| whole(start.1[i], at_half[i], rates[i].dx));
        bodies.advance(system, over, 1.0)
    }
}
