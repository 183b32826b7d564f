//! Pressure force:  dv_a/dt = −Σ m_b (P_a + P_b)/(ρ_a ρ_b) ∇_a W, and Monaghan's tensile correction.

use super::{Num, Pair, Term};

/// Pressure, in the form of @colagrossi2003, eq. (4) of @pirkhalili2023.
#[derive(Clone, Copy, Debug)]
pub struct Pressure;

impl<const D: usize> Term<D> for Pressure {
    #[inline(always)]
    fn along_r<N: Num>(&self, ab: &Pair<N, D>, sum: N) -> N {
        (-(ab.a.p + ab.b.p)).fma(ab.a.specific_volume * ab.b.specific_volume, sum)
    }
}

/// Tensile correction, which keeps particles under the cubic spline from pairing:
/// adds (R_a + R_b)(W_ab/W(dp))⁴ to the pressure bracket, with R the particles' `repulsion` @monaghan2000.
#[derive(Clone, Copy, Debug)]
pub struct Tensile {
    /// 1/(V₀ W(dp)), –.
    pub inv_w_dp: f64,
}

/// R = 0.01 P/ρ² where P > 0 and 0.2 |P|/ρ² where P < 0, of a particle of pressure `p` (P/ρ₀) and specific volume `s`,
/// as ρ₀ R, m²/s² @monaghan2000.
#[inline(always)]
pub(crate) fn repulsion<N: Num>(p: N, s: N) -> N {
    p.select_below(p.constant(0.0), p.constant(-0.2), p.constant(0.01)) * p * (s * s)
}

impl<const D: usize> Term<D> for Tensile {
    const REPULSION: bool = true;

    #[inline(always)]
    fn along_r<N: Num>(&self, ab: &Pair<N, D>, sum: N) -> N {
        let f = ab.w * ab.constant(self.inv_w_dp);
        let f2 = f * f;
        (-(ab.a.repulsion + ab.b.repulsion)).fma(f2 * f2, sum)
    }
}
