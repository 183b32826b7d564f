//! The pair loop: applies the terms of `sph` to all pairs of particles, in parallel, in a SIMD form and an f64 reference. It has no
//! equations of its own.
//!
//! `reference` is the f64 reference. `simd` computes eight pairs at a time, each pair once. Both own their threads and
//! buffers; only the code in `compiled` is compiled for each combination of terms.

mod accumulators;
mod boundary_sums;
mod compiled;
mod exchange;
mod pair_contribution;
mod reference;
mod simd;
mod simd_layout;
mod simd_slab;
#[cfg(feature = "gpu")]
mod trace;

#[cfg(feature = "gpu")]
pub use trace::{PairTraces, RowLayout};

use std::time::Duration;

use crate::{
    math::simd::Level,
    math::{Matrix, Vector},
    neighbours::NeighbourLists,
    particles::Particles,
    sph::{
        AuxiliarySums, FluidProperties, Term, Units, boundary::WallExtrapolation, equation_of_state::EquationOfState,
        gradient_correction::RenormalizationTerm, kernel::Kernel,
    },
};

/// Input of a force pass.
pub struct PairLoopInput<'a, const D: usize> {
    /// Neighbour lists.
    pub neighbours: &'a NeighbourLists<D>,
    /// The water.
    pub fluid: &'a Particles<D>,
    /// The boundary particles.
    pub boundary: &'a Particles<D>,
    /// Velocities with which the boundary particles act on the water, m/s.
    pub boundary_velocity: &'a [Vector<D>],
    /// Stress of the water, m²/s²; empty unless a law reads it.
    pub stress: &'a [Matrix<D>],
    /// B − 1 of the water's corrected gradients, –; empty unless a law reads it.
    pub gradient_correction: &'a [Matrix<D>],
    /// Whether each boundary particle suppresses the shifting of water near it; empty unless a law reads it.
    pub shifting_suppressed: &'a [bool],
    /// Constants of the water.
    pub properties: &'a FluidProperties<D>,
    /// Its equation of state.
    pub equation_of_state: &'a EquationOfState,
}

/// The sums of one particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairSums<const D: usize> {
    /// Acceleration, m/s²; for a boundary particle, force over m = ρ₀ dpᴰ.
    pub acceleration: Vector<D>,
    /// Rate of x = ρ/ρ₀ − 1, 1/s.
    pub compression_rate: f64,
}

impl<const D: usize> PairSums<D> {
    /// No neighbour.
    pub fn zero() -> Self {
        Self { acceleration: Vector::zeros(), compression_rate: 0.0 }
    }
}

/// The largest values that limit a time step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepLimits {
    /// Largest acceleration of a water particle, m/s².
    pub acceleration: f64,
    /// Largest |v_ab·r_ab|/(r² + η²), 1/s.
    pub approach_rate: f64,
}

/// Which sums a force pass computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RequestedSums {
    /// Acceleration and density rate.
    Rates,
    /// These, and the sums that only some terms need.
    All,
}

/// A pair loop with its terms compiled in. One call a pass goes through the trait object; inside, no branch depends on
/// the choice of terms.
pub trait PairLoop<const D: usize>: Send + Sync {
    /// Time spent on pairs so far.
    fn time_spent(&self) -> Duration;

    /// Computes the fluid-to-wall extrapolation sums, with the velocity if `flow`, and writes those of the boundary particles
    /// near water to `fits`. If `own` is given, it contains the places among these of the particles that this rank advances, and
    /// only their sums are written. Call before [`PairLoop::rates`], which reuses the packed fluid data; the neighbour lists must
    /// hold.
    fn extrapolate_to_boundary(
        &mut self,
        input: &PairLoopInput<'_, D>,
        flow: bool,
        own: Option<&[u32]>,
        fits: &mut [WallExtrapolation<f64, D>],
    );

    /// Writes the moments M (–) of the neighbours of the water to `moments`, if the terms correct gradients. Call before
    /// [`PairLoop::rates`], as the extrapolation; the neighbour lists must hold.
    fn moments(&mut self, input: &PairLoopInput<'_, D>, moments: &mut [Matrix<D>]);

    /// Takes the acceleration of gravity of the next pass from `properties`.
    fn set_gravity(&mut self, properties: &FluidProperties<D>) {
        let _ = properties;
    }

    /// The sums `requested` over all pairs; the neighbour lists must hold. Writes the sums of the boundary particles near water to
    /// `boundary`, in the order of [`NeighbourLists::boundary_near_fluid`], and keeps those of the water.
    fn rates(
        &mut self,
        input: &PairLoopInput<'_, D>,
        requested: RequestedSums,
        boundary: &mut [PairSums<D>],
    ) -> StepLimits;

    /// Its terms as traces; `None` for the SIMD pair loop.
    #[cfg(feature = "gpu")]
    fn traces(&self) -> Option<PairTraces> {
        None
    }

    /// Memory of the buffers of a pass, B.
    fn memory_bytes(&self) -> usize;

    /// Says that the stress of the water or the marks of boundary particles have changed since the last pass.
    fn inputs_changed(&mut self) {}

    /// Frees the buffers of a pass, before the neighbour lists are rebuilt; the sums of the last pass go with them.
    fn free_buffers(&mut self);

    /// Completes the sums of the water by the last [`PairLoop::rates`] on all ranks, where these have those of their own particles only.
    fn share_fluid_sums(&mut self, neighbours: &NeighbourLists<D>) {
        let _ = neighbours;
    }

    /// The sums of water particle `i`, gravity included, by the last [`PairLoop::rates`], which had these lists.
    fn fluid_sums(&self, neighbours: &NeighbourLists<D>, i: usize) -> PairSums<D>;

    /// Sets those of `sums` that some terms need to the sums of water particle `i` by the last [`PairLoop::rates`], which computed
    /// [`RequestedSums::All`] and had these lists.
    fn read_auxiliary_sums(&self, neighbours: &NeighbourLists<D>, i: usize, sums: &mut AuxiliarySums<f64, D>);
}

/// The pair loop of the terms `inner` between water particles and `wall` between water and solids, with the properties `medium`
/// in `units`: in SIMD lanes with the instruction set `level`, or, without one, as the reference in SI units.
pub fn compile<K, T, W, const D: usize>(
    kernel: K,
    inner: T,
    wall: W,
    medium: &FluidProperties<D>,
    units: Units,
    level: Option<Level>,
) -> Box<dyn PairLoop<D>>
where
    K: Kernel + 'static,
    T: Term<D> + 'static,
    W: Term<D> + 'static,
{
    let laws = Box::new(compiled::CompiledTerms::new(kernel, inner, wall, medium));
    let moments = T::GRADIENT_CORRECTION.then(|| -> Box<dyn compiled::PairTerms<D>> {
        Box::new(compiled::CompiledTerms::new(kernel, RenormalizationTerm, RenormalizationTerm, medium))
    });
    let fits =
        Box::new(boundary_sums::KernelSums { kernel: kernel.normalised_on_lattice(medium), reach2: laws.reach2 });
    match level {
        Some(level) => Box::new(simd::SimdPairLoop::new(laws, moments, fits, units, level)),
        None => Box::new(reference::ReferencePairLoop::new(laws, moments, fits)),
    }
}
