//! A kernel and laws compiled together: all that differs from one choice of laws to another, and no more, as every
//! choice is compiled for itself.

use super::{Sums, accumulators::Needs, reference, reference::Node, simd, simd_layout::Packed};
use crate::{
    math::simd::{Level, Row},
    neighbours::{Chunk, Slab},
    sph::{
        Extra, Medium, Term,
        kernel::{Kernel, REACH},
    },
};

/// One choice of laws, called once a slab or a chunk of particles.
pub(super) trait Laws<const D: usize>: Send + Sync {
    /// What they need.
    fn needs(&self) -> Needs;

    /// By the oracle, the sums of the water particles of a chunk, the first of them `first`; gives the largest
    /// |v_ab·r_ab|/(r² + η²).
    fn water(
        &self,
        nodes: [&[Node<D>]; 2],
        first: usize,
        lists: &Chunk,
        sums: &mut [Sums<D>],
        extra: &mut [Extra<f64, D>],
    ) -> f64;

    /// By the oracle, the sums of the boundary particles `wet`.
    fn skin(&self, nodes: [&[Node<D>]; 2], wet: &[u32], lists: &Chunk, sums: &mut [Sums<D>]);

    /// In lanes, the sums of a slab and of the one after it; gives the largest |v_ab·r_ab|/(r² + η²).
    fn slab(&self, level: Level, packed: &Packed<D>, slab: &Slab, sums: &mut [Row]) -> f32;
}

/// Laws `T` among water and `W` between water and solids under a kernel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Compiled<K, T, W> {
    /// Weighed with a particle's volume at ρ₀.
    pub(super) kernel: K,
    pub(super) inner: T,
    pub(super) wall: W,
    pub(super) eta2: f64,
    /// Square of the kernel's support.
    pub(super) reach2: f64,
}

impl<K: Kernel, T, W> Compiled<K, T, W> {
    /// With kernel and laws made for `medium`, in its units.
    pub(super) fn new<const D: usize>(kernel: K, inner: T, wall: W, medium: &Medium<D>) -> Self {
        let (kernel, reach2) = (kernel.on_lattice(medium), (REACH * medium.h).powi(2));
        Self { kernel, inner, wall, eta2: medium.eta2(), reach2 }
    }
}

impl<K: Kernel, T: Term<D>, W: Term<D>, const D: usize> Laws<D> for Compiled<K, T, W> {
    fn needs(&self) -> Needs {
        Needs::of::<(T, W), D>()
    }

    fn water(
        &self,
        nodes: [&[Node<D>]; 2],
        first: usize,
        lists: &Chunk,
        sums: &mut [Sums<D>],
        extra: &mut [Extra<f64, D>],
    ) -> f64 {
        reference::water(self, nodes, first, lists, sums, extra)
    }

    fn skin(&self, nodes: [&[Node<D>]; 2], wet: &[u32], lists: &Chunk, sums: &mut [Sums<D>]) {
        reference::skin(self, nodes, wet, lists, sums);
    }

    fn slab(&self, level: Level, packed: &Packed<D>, slab: &Slab, sums: &mut [Row]) -> f32 {
        simd::slab(self, level, packed, slab, sums)
    }
}
