//! A kernel and laws compiled together. Every choice of laws is compiled separately, so this file contains only the code that
//! differs between choices.

use super::{
    PairSums, RequestedSums, accumulators::RequiredSums, reference, reference::ReferenceParticle,
    simd_layout::PackedParticles, simd_slab,
};
use crate::{
    math::simd::{LaneRow, Level},
    neighbours::{ParticleListChunk, Slab},
    sph::{
        AuxiliarySums, FluidProperties, Term,
        kernel::{Kernel, SUPPORT_RATIO},
    },
};

/// One combination of terms, called once a slab or a chunk of particles.
pub(super) trait PairTerms<const D: usize>: Send + Sync {
    /// The inputs and sums that they need.
    fn required_sums(&self) -> RequiredSums;

    /// Takes the acceleration of gravity of the next pass, in the units of the terms.
    fn set_gravity(&mut self, gravity: &[f64; D]);

    /// By the reference: the sums of the water particles of a chunk, of which `first` is the first; returns the largest
    /// |v_ab·r_ab|/(r² + η²).
    fn sum_fluid(
        &self,
        nodes: [&[ReferenceParticle<D>]; 2],
        first: usize,
        lists: &ParticleListChunk,
        sums: &mut [PairSums<D>],
        extra: &mut [AuxiliarySums<f64, D>],
    ) -> f64;

    /// By the reference: the sums of the boundary particles `wet`.
    fn sum_boundary(
        &self,
        nodes: [&[ReferenceParticle<D>]; 2],
        wet: &[u32],
        lists: &ParticleListChunk,
        sums: &mut [PairSums<D>],
    );

    /// The traces of pairs of water particles, and of water and boundary particles.
    #[cfg(feature = "gpu")]
    fn traces(&self) -> [crate::sph::trace::Trace; 2];

    /// Square of the kernel's support.
    #[cfg(feature = "gpu")]
    fn reach2(&self) -> f64;

    /// In SIMD lanes: the sums `requested` of a slab and of the next one; returns the largest |v_ab·r_ab|/(r² + η²).
    fn sum_slab(
        &self,
        level: Level,
        packed: &PackedParticles<D>,
        requested: RequestedSums,
        slab: &Slab,
        sums: &mut [LaneRow],
    ) -> f32;
}

/// Terms `T` between water particles and `W` between water and solids, under a kernel.
#[derive(Clone, Copy, Debug)]
pub(super) struct CompiledTerms<K, T, W> {
    /// Multiplied by the volume of a particle at ρ₀.
    pub(super) kernel: K,
    pub(super) fluid: T,
    pub(super) wall: W,
    pub(super) eta2: f64,
    /// Square of the kernel's support.
    pub(super) reach2: f64,
}

impl<K: Kernel, T, W> CompiledTerms<K, T, W> {
    /// With kernel and terms in the units of `medium`.
    pub(super) fn new<const D: usize>(kernel: K, inner: T, wall: W, medium: &FluidProperties<D>) -> Self {
        let (kernel, reach2) = (kernel.normalised_on_lattice(medium), (SUPPORT_RATIO * medium.h).powi(2));
        Self { kernel, fluid: inner, wall, eta2: medium.eta2(), reach2 }
    }
}

impl<K: Kernel, T: Term<D>, W: Term<D>, const D: usize> PairTerms<D> for CompiledTerms<K, T, W> {
    fn required_sums(&self) -> RequiredSums {
        RequiredSums::of_terms::<(T, W), D>()
    }

    fn set_gravity(&mut self, gravity: &[f64; D]) {
        self.fluid.set_gravity(gravity);
        self.wall.set_gravity(gravity);
    }

    fn sum_fluid(
        &self,
        nodes: [&[ReferenceParticle<D>]; 2],
        first: usize,
        lists: &ParticleListChunk,
        sums: &mut [PairSums<D>],
        extra: &mut [AuxiliarySums<f64, D>],
    ) -> f64 {
        reference::sum_fluid(self, nodes, first, lists, sums, extra)
    }

    fn sum_boundary(
        &self,
        nodes: [&[ReferenceParticle<D>]; 2],
        wet: &[u32],
        lists: &ParticleListChunk,
        sums: &mut [PairSums<D>],
    ) {
        reference::sum_boundary(self, nodes, wet, lists, sums);
    }

    #[cfg(feature = "gpu")]
    fn traces(&self) -> [crate::sph::trace::Trace; 2] {
        let all = RequiredSums::of_terms::<(T, W), D>();
        [super::trace::pair(self, &self.fluid, all), super::trace::pair(self, &self.wall, all)]
    }

    #[cfg(feature = "gpu")]
    fn reach2(&self) -> f64 {
        self.reach2
    }

    fn sum_slab(
        &self,
        level: Level,
        packed: &PackedParticles<D>,
        requested: RequestedSums,
        slab: &Slab,
        sums: &mut [LaneRow],
    ) -> f32 {
        simd_slab::sum_slab(self, level, packed, requested, slab, sums)
    }
}
