//! Loops over pairs: the one place where laws meet arrays and threads. No formulas.

mod gather;

pub use gather::Gather;

use rayon::prelude::*;

use crate::{
    law::{Extra, Side},
    near::{CHUNK, Lists},
    space::{Matrix, Vector},
};

/// A particle as the sweep reads it: what a pair needs, packed together.
#[derive(Clone, Copy, Debug)]
pub struct Node<const D: usize> {
    /// Position, m.
    pub r: [f64; D],
    /// Velocity, m/s.
    pub v: [f64; D],
    /// Excess density ρ/ρ₀ − 1, –.
    pub x: f64,
    /// Pressure P/ρ₀, m²/s².
    pub p: f64,
    /// Specific volume ρ₀/ρ, –.
    pub s: f64,
}

impl<const D: usize> Node<D> {
    /// The side of a pair that this particle is.
    #[inline(always)]
    pub fn side(&self, stress: [[f64; D]; D]) -> Side<f64, D> {
        Side { x: self.x, p: self.p, s: self.s, stress }
    }
}

/// What a sweep reads.
pub struct Input<'a, const D: usize> {
    /// Neighbours.
    pub lists: &'a Lists,
    /// The water.
    pub water: &'a [Node<D>],
    /// The boundary particles.
    pub skin: &'a [Node<D>],
    /// Stress of the water, m²/s²; empty unless a law reads it.
    pub stress: &'a [Matrix<D>],
}

/// The sums of one particle.
#[derive(Clone, Copy, Debug)]
pub struct Sums<const D: usize> {
    /// Acceleration by pair forces (no gravity), m/s²; for a boundary particle, force over m = ρ₀ dpᴰ.
    pub dv: Vector<D>,
    /// Rate of x = ρ/ρ₀ − 1, 1/s.
    pub dx: f64,
    /// max |v_ab·r_ab|/(r² + η²) over the neighbours, 1/s.
    pub closing: f64,
}

impl<const D: usize> Sums<D> {
    /// No neighbour.
    pub fn zero() -> Self {
        Self { dv: Vector::zeros(), dx: 0.0, closing: 0.0 }
    }
}

/// A sweep with its laws compiled in: the sums of one chunk of particles. One call a chunk goes through the
/// trait object; inside there is no branch on a choice of law.
pub trait Sweep<const D: usize>: Send + Sync {
    /// Whether [`Extra`] sums are made.
    fn extra(&self) -> bool;

    /// Sums over all neighbours of the water particles of chunk `chunk` into `sums`, and into `extra` where
    /// the laws need it (else empty).
    fn water(&self, input: &Input<'_, D>, chunk: usize, sums: &mut [Sums<D>], extra: &mut [Extra<f64, D>]);

    /// Sums over the water around the boundary particles of chunk `chunk`.
    fn skin(&self, input: &Input<'_, D>, chunk: usize, sums: &mut [Sums<D>]);
}

/// Sweeps all chunks of water and skin, each by one thread.
pub fn all<const D: usize>(
    sweep: &dyn Sweep<D>,
    input: &Input<'_, D>,
    sums: &mut [Sums<D>],
    skin_sums: &mut [Sums<D>],
    extra: &mut [Extra<f64, D>],
) {
    let chunks = sums.par_chunks_mut(CHUNK).enumerate();
    if sweep.extra() {
        chunks.zip(extra.par_chunks_mut(CHUNK)).for_each(|((c, sums), extra)| sweep.water(input, c, sums, extra));
    } else {
        chunks.for_each(|(c, sums)| sweep.water(input, c, sums, &mut []));
    }
    skin_sums.par_chunks_mut(CHUNK).enumerate().for_each(|(c, sums)| sweep.skin(input, c, sums));
}
