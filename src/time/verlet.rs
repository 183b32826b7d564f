//! Verlet:  v⁺ = v⁻ + (Δt⁻ + Δt) F,  r⁺ = r + Δt v + ½Δt² F,  ρ⁺ = ρ⁻ + (Δt⁻ + Δt) R;  every so many steps
//! Euler's  v⁺ = v + Δt F,  ρ⁺ = ρ + Δt R,  so that even and odd steps stay together.
//!
//! Δt⁻ is the step before: with a constant step this is 2Δt, eqs. (12), (13) of the paper, and with a varying one
//! it is centred still. A body gets the impulse ½(Δt⁻ + Δt) F a step, by which ½(P⁺ + P) of the water and
//! P⁺ of the bodies add up to a constant: their plain sum differs from it by half a step's change of the
//! water's momentum, ½(P⁺ − P), and does not drift. An Euler step gives Δt F and adds ½Δt times the change of F in half a step.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::{Bodies, Interval};
use crate::{
    error::Result,
    space::Vector,
    system::{System, permute},
};

/// The scheme [@verlet1967], eqs. (12), (13) of [@pirkhalili2023], and the step before.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Verlet<const D: usize> {
    euler_every: u32,
    /// Steps to the next Euler step.
    to_euler: u32,
    dt_before: f64,
    v_before: Vec<Vector<D>>,
    rho_before: Vec<f64>,
    skin_rho_before: Vec<f64>,
}

impl<const D: usize> Verlet<D> {
    /// At the start of a run; the first step is Euler's.
    pub fn new(euler_every: u32) -> Self {
        Self {
            euler_every: euler_every.max(1),
            to_euler: 0,
            dt_before: 0.0,
            v_before: Vec::new(),
            rho_before: Vec::new(),
            skin_rho_before: Vec::new(),
        }
    }

    /// Follows the water into a new order.
    pub fn permute(&mut self, order: &[u32]) {
        permute(&mut self.v_before, order);
        permute(&mut self.rho_before, order);
    }

    /// Moves the system, whose rates at the start are known, over an interval.
    pub fn step(&mut self, system: &mut System<D>, bodies: &mut Bodies<D>, over: Interval) -> Result<()> {
        let dt = over.dt;
        let rho0 = system.medium().rho0;
        let euler = self.to_euler == 0;
        // An Euler step is a Verlet step whose step before had no length and ended here.
        if euler {
            self.to_euler = self.euler_every;
            self.v_before.clone_from(&system.fluid.v);
            self.rho_before.clone_from(&system.fluid.rho);
            self.skin_rho_before.clone_from(&system.skin.rho);
        }
        let span = if euler { dt } else { self.dt_before + dt };
        let shifts = system.shifts(dt);

        let sums = &system.sums;
        let fluid = &mut system.fluid;
        let before = self.v_before.par_iter_mut().zip(&mut self.rho_before);
        fluid.r.par_iter_mut().zip(&mut fluid.v).zip(&mut fluid.rho).zip(sums).zip(before).for_each(
            |((((r, v), rho), s), (v_before, rho_before))| {
                *r += *v * dt + s.dv * (0.5 * dt * dt);
                (*v_before, *v) = (*v, *v_before + s.dv * span);
                (*rho_before, *rho) = (*rho, *rho_before + rho0 * s.dx * span);
            },
        );
        if let Some(shifts) = shifts {
            fluid.r.par_iter_mut().zip(&shifts).for_each(|(r, shift)| *r += shift);
        }
        let now = system.skin.rho.clone();
        let (rates, was) = (system.skin_sums.clone(), &self.skin_rho_before);
        system.set_skin_density(|i| was[i] + rho0 * rates[i].dx * span);
        self.skin_rho_before = now;

        let weight = if euler { 1.0 } else { 0.5 * span / dt };
        bodies.advance(system, over, weight)?;
        self.dt_before = dt;
        self.to_euler -= 1;
        Ok(())
    }
}
