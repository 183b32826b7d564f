//! Loops over pairs: the one place where laws meet arrays and threads. No formulas.

mod gather;

pub use gather::Gather;

use crate::{
    law::{Extra, Side},
    near::Lists,
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

/// A sweep with its laws compiled in.
pub trait Sweep<const D: usize>: Send + Sync {
    /// Whether [`Extra`] sums are made.
    fn extra(&self) -> bool;

    /// Sums over all neighbours of the water into `sums`, and into `extra` where the laws need it (else empty).
    fn water(&self, input: &Input<'_, D>, sums: &mut [Sums<D>], extra: &mut [Extra<f64, D>]);

    /// Sums over the water around each boundary particle.
    fn skin(&self, input: &Input<'_, D>, sums: &mut [Sums<D>]);
}
