//! What becomes of the water's energy at a force pass: a second pass, of the pressure alone, tells the laws apart.
//!
//! With the pressure force (P_a + P_b)/(ρ_a ρ_b) and the volume form of continuity, what pairs of water particles do to one
//! another is taken from the motion of one and put into the compression of the other, with nothing left over
//! [@colagrossi2003]. So of the powers, with e(ρ) the energy of compression and F·V, T·Ω the power on a solid,
//!
//!   Ė = Σ m (v·(a − g) + P/ρ² ρ̇)         of the water but for its weight
//!   viscous    Σ m v·(a − a′) + Σ ((F − F′)·V + (T − T′)·Ω)
//!   diffusion  Σ m P/ρ² (ρ̇ − ρ̇′)
//!   walls      Σ m (v·(a′ − g) + P/ρ² ρ̇′) + Σ (F′·V + T′·Ω)
//!   work       −Σ (F·V + T·Ω)             of the solids on the water
//!
//! with the dashed ones those of the pressure alone: Ė = viscous + diffusion + walls + work. What is called walls is what the
//! boundary particles, which are springs of their own, and their barrier give to the water. The sum of the three needs no second pass.
//! Where gradients are corrected, the force does not take from the motion what compression gets; a third pass, of the pressure with
//! plain gradients, tells by how much, as viscosity is told, and that is called gradient.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::System;
use crate::{
    model::{Diffusion, Dimension, Gradient, Model, Shifting, Viscosity},
    near::CHUNK,
    solid::{Dim, Load},
    space::Vector,
    sweep::{Input, Output, Sums, Sweep},
};

/// Powers of the water at a force pass, W (W/m in 2-D).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Powers {
    /// What viscosity gives: negative.
    pub(crate) viscous: f64,
    /// What the diffusion of density gives.
    pub(crate) diffusion: f64,
    /// What the correction of gradients gives.
    pub(crate) gradient: f64,
}

/// The passes of the pressure alone.
pub(super) struct Meter<const D: usize> {
    pressure: Box<dyn Sweep<D>>,
    /// With plain gradients, if they are corrected.
    plain: Option<Box<dyn Sweep<D>>>,
    sums: Vec<Sums<D>>,
    skin: Vec<Sums<D>>,
}

impl<const D: usize> Meter<D> {
    /// The meter of a system of that model.
    pub(super) fn new(model: &Model) -> Self
    where
        Dim<D>: Dimension<D>,
    {
        let pressure =
            Model { viscosity: Viscosity::None, diffusion: Diffusion::None, shifting: Shifting::None, ..model.clone() };
        let plain = Model { gradient: Gradient::Plain, ..pressure.clone() };
        let plain = (model.gradient != Gradient::Plain).then(|| Dim::<D>::sweep(&plain));
        Self { pressure: Dim::<D>::sweep(&pressure), plain, sums: Vec::new(), skin: Vec::new() }
    }
}

impl<const D: usize> System<D> {
    /// Makes ready to tell the laws apart.
    pub(crate) fn meter(&mut self)
    where
        Dim<D>: Dimension<D>,
    {
        self.meter = Some(Meter::new(&self.model));
    }

    /// The powers at the last force pass, and the loads of the pressure alone on the solids; the state must be that of the pass.
    pub(crate) fn tell_apart(&mut self) -> Option<(Powers, Vec<Load<D>>)> {
        let Meter { mut pressure, mut plain, mut sums, mut skin } = self.meter.take()?;
        sums.resize(self.fluid.len(), Sums::zero());
        skin.resize(self.near.wet().len(), Sums::zero());
        let mut pass = |sweep: &mut dyn Sweep<D>| self.pass(sweep, &mut sums, &mut skin);
        let (gains, loads) = pass(&mut *pressure);
        let before = plain.as_mut().map(|plain| pass(&mut **plain));
        let all = self.gains(&self.sums);
        let on_solids = |more: &dyn Fn(usize) -> Load<D>| -> f64 {
            self.solids.iter().enumerate().map(|(i, solid)| more(i).power(&solid.kinematics)).sum()
        };
        let powers = Powers {
            viscous: all[0] - gains[0] + on_solids(&|i| self.solids[i].load - loads[i]),
            diffusion: all[1] - gains[1],
            gradient: before
                .map_or(0.0, |(plain, plain_loads)| gains[0] - plain[0] + on_solids(&|i| loads[i] - plain_loads[i])),
        };
        self.meter = Some(Meter { pressure, plain, sums, skin });
        Some((powers, loads))
    }

    /// What the water gains ([`System::gains`]) and the loads on the solids by another sweep, at the places of the last force pass.
    fn pass(&self, sweep: &mut dyn Sweep<D>, sums: &mut [Sums<D>], on: &mut [Sums<D>]) -> ([f64; 2], Vec<Load<D>>) {
        let Self { near, fluid, skin, shown, stress, forms, marks, medium, state, .. } = self;
        let shown = if shown.is_empty() { &skin.v } else { shown };
        let input = Input { near, water: fluid, skin, shown, stress, forms, marks, medium, state };
        sweep.rates(&input, &mut Output { water: sums, skin: on, extra: &mut [] });
        (self.gains(sums), self.loads(on))
    }

    /// viscous + diffusion + gradient + walls, W: what the water gained at the last force pass beyond the work of the solids.
    pub(crate) fn unworked(&self) -> f64 {
        let on_solids: f64 = self.solids.iter().map(|solid| solid.load.power(&solid.kinematics)).sum();
        self.gains(&self.sums).iter().sum::<f64>() + on_solids
    }

    /// What motion and compression of the water gain (W) by the rates `sums` but for its weight, added up in chunks in order.
    fn gains(&self, sums: &[Sums<D>]) -> [f64; 2] {
        let (real, rho0, g) = (self.real(), self.medium.rho0, self.medium.gravity);
        let water = self.fluid.v[..real].par_chunks(CHUNK).zip(self.fluid.rho[..real].par_chunks(CHUNK));
        let chunk = |((v, rho), sums): ((&[Vector<D>], &[f64]), &[Sums<D>])| {
            v.iter().zip(rho).zip(sums).fold([0.0; 2], |[motion, compression], ((v, rho), s)| {
                let pressed = rho0 * self.state.pressure(rho / rho0 - 1.0) / (rho * rho);
                [motion + v.dot(&(s.dv - g)), compression + pressed * s.dx * rho0]
            })
        };
        let parts: Vec<[f64; 2]> = water.zip(sums[..real].par_chunks(CHUNK)).map(chunk).collect();
        let mass = self.particle_mass();
        parts.iter().fold([0.0; 2], |[a, b], part| [a + part[0] * mass, b + part[1] * mass])
    }
}
