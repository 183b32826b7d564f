//! The power of each term of the equations on the water, from a second force pass with the pressure alone.
//!
//! With the pressure force (P_a + P_b)/(ρ_a ρ_b) and the volume form of continuity, a pair of water particles exchanges kinetic
//! energy and energy of compression without a remainder @colagrossi2003. With e(ρ) the energy of compression and F·V, T·Ω the
//! power on a solid, the powers are
//!
//!   Ė = Σ m (v·(a − g) + P/ρ² ρ̇)         of the water without its weight
//!   viscous    Σ m v·(a − a′) + Σ ((F − F′)·V + (T − T′)·Ω)
//!   diffusion  Σ m P/ρ² (ρ̇ − ρ̇′)
//!   walls      Σ m (v·(a′ − g) + P/ρ² ρ̇′) + Σ (F′·V + T′·Ω)
//!   work       −Σ (F·V + T·Ω)             of the solids on the water
//!
//! A prime marks the pass with the pressure alone. Ė = viscous + diffusion + walls + work. `walls` is the power of the boundary
//! particles and their repulsion. The sum of viscous, diffusion and walls needs no second pass. With corrected gradients the
//! pressure does not exchange energy exactly. The difference `gradient` follows from a third pass with uncorrected gradients.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::{
    interaction::PairLoop,
    math::Vector,
    model::{Diffusion, HasPairLoop, Model, PressureGradient, Shifting, Viscosity},
    neighbours::CHUNK,
    solid::{Dim, Load, Solid},
    system::{FluidRates, System, solid_loads},
};

/// Powers on the water at a force pass, W (W/m in 2-D).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct PowerBreakdown {
    /// Power of viscosity: negative.
    pub(super) viscous: f64,
    /// Power of density diffusion.
    pub(super) diffusion: f64,
    /// Power of the gradient correction.
    pub(super) gradient: f64,
}

/// A pass with the pressure alone: the powers on the motion and on the compression of the water, W, and the loads on the solids.
pub(crate) type PressurePass<const D: usize> = ([f64; 2], Vec<Load<D>>);

/// The force passes with the pressure alone.
pub(super) struct PowerMeter<const D: usize> {
    pressure: Box<dyn PairLoop<D>>,
    /// Pair loop with uncorrected gradients, if the model corrects the gradients.
    plain: Option<Box<dyn PairLoop<D>>>,
}

impl<const D: usize> PowerMeter<D> {
    /// Creates the force passes for systems with the given `model`.
    pub(super) fn new(model: &Model) -> Self
    where
        Dim<D>: HasPairLoop<D>,
    {
        let (pressure, plain) = pressure_models(model);
        Self { pressure: Dim::<D>::pair_loop(&pressure), plain: plain.map(|plain| Dim::<D>::pair_loop(&plain)) }
    }

    /// Returns the powers at the last force pass, and the loads of the pressure alone on the solids. The state of
    /// `system` must not have changed since that pass.
    pub(super) fn decompose(&mut self, system: &System<D>) -> (PowerBreakdown, Vec<Load<D>>) {
        let Self { pressure, plain } = self;
        let pass = |pair_loop: &mut dyn PairLoop<D>| {
            let loads = solid_loads::of_pair_loop(system, pair_loop);
            (gains(system, system.fluid_rates_of(pair_loop)), loads)
        };
        let gained = pass(&mut **pressure);
        let plain = plain.as_mut().map(|plain| pass(&mut **plain));
        breakdown(system, gains_of_last_pass(system), gained, plain)
    }
}

/// The model with the pressure alone, and the same with uncorrected gradients if `model` corrects them.
pub(crate) fn pressure_models(model: &Model) -> (Model, Option<Model>) {
    let pressure =
        Model { viscosity: Viscosity::None, diffusion: Diffusion::None, shifting: Shifting::None, ..model.clone() };
    let plain = Model { gradient: PressureGradient::Plain, ..pressure.clone() };
    (pressure, (model.gradient != PressureGradient::Plain).then_some(plain))
}

/// Returns the powers at the last force pass, which gave the water the powers `all` (W), and the loads of the pressure alone, from the
/// passes with the pressure alone and with uncorrected gradients.
pub(super) fn breakdown<const D: usize>(
    system: &System<D>,
    all: [f64; 2],
    (gained, loads): PressurePass<D>,
    plain: Option<PressurePass<D>>,
) -> (PowerBreakdown, Vec<Load<D>>) {
    let powers = PowerBreakdown {
        viscous: all[0] - gained[0] + power_on_solids(system, |i| system.solids[i].load - loads[i]),
        diffusion: all[1] - gained[1],
        gradient: plain.map_or(0.0, |(plain, plain_loads)| {
            gained[0] - plain[0] + power_on_solids(system, |i| loads[i] - plain_loads[i])
        }),
    };
    (powers, loads)
}

/// Returns the power (W) of these loads on all solids.
fn power_on_solids<const D: usize>(system: &System<D>, load: impl Fn(usize) -> Load<D>) -> f64 {
    let power = |(i, solid): (usize, &Solid<D>)| load(i).power(&solid.kinematics) * system.solid_multiplicity(i);
    system.solids.iter().enumerate().map(power).sum()
}

/// Returns the power on the water at the last force pass, without the work of the solids: viscous + diffusion + gradient +
/// walls, W. The pass gave the water the powers `gains` (W).
pub(super) fn total_power<const D: usize>(system: &System<D>, gains: [f64; 2]) -> f64 {
    gains.iter().sum::<f64>() + power_on_solids(system, |i| system.solids[i].load)
}

/// Returns the powers (W) on the motion and on the compression of the water by the last force pass, without the weight of the water.
pub(super) fn gains_of_last_pass<const D: usize>(system: &System<D>) -> [f64; 2] {
    gains(system, system.fluid_rates())
}

/// Returns the powers (W) on the motion and on the compression of the water by its `rates`, without the weight
/// of the water. The sums over chunks are added in order, and count the images across symmetry planes.
fn gains<const D: usize>(system: &System<D>, rates: FluidRates<'_, D>) -> [f64; 2] {
    let (water, rho0, g) = (system.fluid(), system.properties().rho0, system.gravity());
    let particles = water.v.par_chunks(CHUNK).zip(water.rho.par_chunks(CHUNK));
    let chunk = |(c, (v, rho)): (usize, (&[Vector<D>], &[f64]))| {
        (c * CHUNK..).zip(v.iter().zip(rho)).fold([0.0; 2], |[motion, compression], (i, (v, rho))| {
            let (s, pressed) = (rates.of(i), system.pressure(*rho) / (rho * rho));
            [motion + v.dot(&(s.acceleration - g)), compression + pressed * s.compression_rate * rho0]
        })
    };
    let parts: Vec<[f64; 2]> = particles.enumerate().map(chunk).collect();
    let mass = system.particle_mass() * system.water_multiplicity();
    parts.iter().fold([0.0; 2], |[a, b], part| [a + part[0] * mass, b + part[1] * mass])
}
