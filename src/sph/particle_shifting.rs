//! Particle shifting:  δr = −A h |v| Δt ∇C,  ∇C = Σ V_b ∇_a W, weakened near the free surface by
//! A_FSC = (∇·r − A_FST)/(D − A_FST), ∇·r = −Σ V_b r_ab·∇_a W.
//!
//! What the paper's eqs. (19)–(21) mean: no shift where ∇·r < A_FST, A_FSC of it above, the whole in the interior.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Extra, Medium, Num, Pair, Term};
use crate::math::Vector;

/// Fickian shifting with a free-surface factor [@skillen2013], [@lee2008]; eqs. (16)–(22) of [@pirkhalili2023].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Shift {
    /// A, – (1 to 6).
    pub a: f64,
}

impl Default for Shift {
    /// A = 2, the paper's.
    fn default() -> Self {
        Self { a: 2.0 }
    }
}

impl Shift {
    /// Displacement (m) in a step `dt` (s) of a particle of speed `speed` (m/s), from its finished sums; each
    /// component is held to 0.1 dp, so that no shift can carry a particle past another.
    pub fn close<const D: usize>(&self, sums: &Extra<f64, D>, speed: f64, dt: f64, medium: &Medium<D>) -> Vector<D> {
        let threshold = if D == 2 { 1.5 } else { 2.75 };
        let surface = ((sums.div_r - threshold) / (D as f64 - threshold)).clamp(0.0, 1.0);
        let factor = -self.a * medium.h * speed * dt * surface;
        let limit = 0.1 * medium.dp;
        Vector::from_fn(|i, _| (factor * sums.grad_c[i]).clamp(-limit, limit))
    }
}

/// The sums of [`Shift`], over water and solids.
#[derive(Clone, Copy, Debug)]
pub struct ShiftTerm;

impl<const D: usize> Term<D> for ShiftTerm {
    const SHIFT: bool = true;

    #[inline(always)]
    fn extra<N: Num>(&self, ab: &Pair<N, D>, factor: N, a: &mut Extra<N, D>, b: &mut Extra<N, D>) {
        let (of_b, of_a) = (factor * ab.b.s, factor * ab.a.s);
        for i in 0..D {
            a.grad_c[i] = of_b.fma(ab.r_ab[i], a.grad_c[i]);
            b.grad_c[i] = (-of_a).fma(ab.r_ab[i], b.grad_c[i]);
        }
        a.div_r = (-of_b).fma(ab.r2, a.div_r);
        b.div_r = (-of_a).fma(ab.r2, b.div_r);
    }
}

/// Notes which particles have a marked one within the support: there shifting is held back.
#[derive(Clone, Copy, Debug)]
pub struct HeldTerm;

impl<const D: usize> Term<D> for HeldTerm {
    const MARK: bool = true;

    #[inline(always)]
    fn extra<N: Num>(&self, ab: &Pair<N, D>, factor: N, a: &mut Extra<N, D>, b: &mut Extra<N, D>) {
        a.held = (-factor).fma(ab.b.mark, a.held);
        b.held = (-factor).fma(ab.a.mark, b.held);
    }
}
