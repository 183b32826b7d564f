//! Particle shifting:  δr = −A h |v| Δt ∇C,  ∇C = Σ V_b ∇_a W, weakened near the free surface by
//! A_FSC = (∇·r − A_FST)/(D − A_FST), ∇·r = −Σ V_b r_ab·∇_a W.
//!
//! Reading of the paper's eqs. (19)–(21): no shift where ∇·r < A_FST, the factor A_FSC above it, the full shift inside.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{AuxiliarySums, FluidProperties, Num, Pair, Term};

/// Fickian shifting with a free-surface factor @skillen2013, @lee2008; eqs. (16)–(22) of @pirkhalili2023.
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
    /// Displacement (m) in a step `dt` (s) of a particle of speed `speed` (m/s), from its finished sums; each component is
    /// limited to 0.1 dp, so that no shift can move a particle past another.
    pub fn displacement<N: Num, const D: usize>(
        &self,
        sums: &AuxiliarySums<N, D>,
        speed: N,
        dt: N,
        medium: &FluidProperties<D>,
    ) -> [N; D] {
        let of = |x: f64| speed.constant(x);
        let threshold = if D == 2 { 1.5 } else { 2.75 };
        let surface = (sums.position_divergence - of(threshold)) / of(D as f64 - threshold);
        let factor = of(-self.a * medium.h) * speed * dt * surface.max(of(0.0)).min(of(1.0));
        let limit = of(0.1 * medium.dp);
        sums.concentration_gradient.map(|gradient| (factor * gradient).max(-limit).min(limit))
    }
}

/// The sums of [`Shift`], over water and solids.
#[derive(Clone, Copy, Debug)]
pub struct ShiftTerm;

impl<const D: usize> Term<D> for ShiftTerm {
    const SHIFT: bool = true;

    #[inline(always)]
    fn auxiliary<N: Num>(&self, ab: &Pair<N, D>, factor: N, a: &mut AuxiliarySums<N, D>, b: &mut AuxiliarySums<N, D>) {
        let (of_b, of_a) = (factor * ab.b.specific_volume, factor * ab.a.specific_volume);
        for i in 0..D {
            a.concentration_gradient[i] = of_b.fma(ab.r_ab[i], a.concentration_gradient[i]);
            b.concentration_gradient[i] = (-of_a).fma(ab.r_ab[i], b.concentration_gradient[i]);
        }
        a.position_divergence = (-of_b).fma(ab.r2, a.position_divergence);
        b.position_divergence = (-of_a).fma(ab.r2, b.position_divergence);
    }
}

/// Sums the marked boundary particles within the support: there shifting is suppressed.
#[derive(Clone, Copy, Debug)]
pub struct ShiftingSuppressionTerm;

impl<const D: usize> Term<D> for ShiftingSuppressionTerm {
    const SHIFTING_SUPPRESSION: bool = true;

    #[inline(always)]
    fn auxiliary<N: Num>(&self, ab: &Pair<N, D>, factor: N, a: &mut AuxiliarySums<N, D>, b: &mut AuxiliarySums<N, D>) {
        a.shifting_suppressed = (-factor).fma(ab.b.shifting_suppressed, a.shifting_suppressed);
        b.shifting_suppressed = (-factor).fma(ab.a.shifting_suppressed, b.shifting_suppressed);
    }
}
