//! Loops over pairs: the one place where laws meet arrays and threads. No formulas.
//!
//! `gather` is the oracle, in f64; `lanes` does the same eight pairs at a time, each pair once. Threads and buffers are
//! theirs; what is compiled anew for every choice of laws is in `laws` and no more.

mod accumulators;
mod boundary_sums;
mod compiled;
mod reference;
mod simd;
mod simd_layout;

use std::time::Duration;

use crate::{
    math::simd::Level,
    math::{Matrix, Vector},
    neighbours::Near,
    particles::Particles,
    sph::{Extra, Medium, Term, Units, boundary::Fit, equation_of_state::State, kernel::Kernel},
};

/// What a sweep reads.
pub struct Input<'a, const D: usize> {
    /// Which particles meet.
    pub near: &'a Near<D>,
    /// The water.
    pub water: &'a Particles<D>,
    /// The boundary particles.
    pub skin: &'a Particles<D>,
    /// The velocities that they show, m/s.
    pub shown: &'a [Vector<D>],
    /// Stress of the water, m²/s²; empty unless a law reads it.
    pub stress: &'a [Matrix<D>],
    /// B − 1 of the water's corrected gradients, –; empty unless a law reads it.
    pub forms: &'a [Matrix<D>],
    /// Beside which boundary particles water is not shifted; empty unless a law reads it.
    pub marks: &'a [bool],
    /// Constants of the water.
    pub medium: &'a Medium<D>,
    /// Its equation of state.
    pub state: &'a State,
}

/// Where a sweep writes.
pub struct Output<'a, const D: usize> {
    /// One for each water particle; gravity is in it.
    pub water: &'a mut [Sums<D>],
    /// One for each wet boundary particle, in the order of [`Near::wet`].
    pub skin: &'a mut [Sums<D>],
    /// One for each water particle, or none if no law needs it.
    pub extra: &'a mut [Extra<f64, D>],
}

/// The sums of one particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sums<const D: usize> {
    /// Acceleration, m/s²; for a boundary particle, force over m = ρ₀ dpᴰ.
    pub dv: Vector<D>,
    /// Rate of x = ρ/ρ₀ − 1, 1/s.
    pub dx: f64,
}

impl<const D: usize> Sums<D> {
    /// No neighbour.
    pub fn zero() -> Self {
        Self { dv: Vector::zeros(), dx: 0.0 }
    }
}

/// The largest values that limit a time step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peaks {
    /// Largest acceleration of a water particle, m/s².
    pub acceleration: f64,
    /// Largest |v_ab·r_ab|/(r² + η²), 1/s.
    pub closing: f64,
}

/// A sweep with its laws compiled in. One call a pass goes through the trait object; inside there is no branch
/// on a choice of law.
pub trait Sweep<const D: usize>: Send + Sync {
    /// Whether [`Extra`] sums are made.
    fn extra(&self) -> bool;

    /// Time spent on pairs so far.
    fn spent(&self) -> Duration;

    /// Sums of the wet boundary particles over the water, for walls that settle or that it sticks to (with its `flow`); the
    /// lists must hold, and [`Sweep::rates`] comes next, with the same water.
    fn fits(&mut self, input: &Input<'_, D>, flow: bool, fits: &mut [Fit<f64, D>]);

    /// Sums over all pairs; the lists must hold.
    fn rates(&mut self, input: &Input<'_, D>, output: &mut Output<'_, D>) -> Peaks;
}

/// The sweep of the laws `inner` among water and `wall` between water and solids, made for `medium`, which is counted
/// in `units`: in lanes with the instructions of `level`, or else by the oracle, in SI.
pub fn compile<K, T, W, const D: usize>(
    kernel: K,
    inner: T,
    wall: W,
    medium: &Medium<D>,
    units: Units,
    level: Option<Level>,
) -> Box<dyn Sweep<D>>
where
    K: Kernel + 'static,
    T: Term<D> + 'static,
    W: Term<D> + 'static,
{
    let laws = Box::new(compiled::Compiled::new(kernel, inner, wall, medium));
    let fits = Box::new(boundary_sums::Weighed(kernel.on_lattice(medium)));
    match level {
        Some(level) => Box::new(simd::Lanes::new(laws, fits, units, level)),
        None => Box::new(reference::Gather::new(laws, fits)),
    }
}
