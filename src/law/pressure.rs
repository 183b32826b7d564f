//! Pressure force:  dv_a/dt = −Σ m_b (P_a + P_b)/(ρ_a ρ_b) ∇_a W, and Monaghan's tensile correction.

use super::{Num, Pair, Term};

/// Pressure, in the form of [@colagrossi2003], eq. (4) of [@pirkhalili2023].
#[derive(Clone, Copy, Debug)]
pub struct Pressure;

impl<N: Num, const D: usize> Term<N, D> for Pressure {
    #[inline(always)]
    fn along_r(&self, ab: &Pair<N, D>, sum: N) -> N {
        sum - (ab.a.p + ab.b.p) * (ab.a.s * ab.b.s)
    }
}

/// Tensile correction, which keeps particles under the cubic spline from pairing:
/// adds (R_a + R_b)(W_ab/W(dp))⁴ to the pressure bracket, R = 0.01 P/ρ² where P > 0 and 0.2 |P|/ρ² where
/// P < 0 [@monaghan2000].
#[derive(Clone, Copy, Debug)]
pub struct Tensile {
    /// 1/W(dp), mᴰ.
    pub inv_w_dp: f64,
}

impl<N: Num, const D: usize> Term<N, D> for Tensile {
    #[inline(always)]
    fn along_r(&self, ab: &Pair<N, D>, sum: N) -> N {
        let repulsion = |p: N, s: N| p.if_below(N::of(0.0), N::of(-0.2), N::of(0.01)) * p * s * s;
        let f = ab.w * N::of(self.inv_w_dp);
        let f2 = f * f;
        sum - (repulsion(ab.a.p, ab.a.s) + repulsion(ab.b.p, ab.b.s)) * (f2 * f2)
    }
}
