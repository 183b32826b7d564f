//! Continuity, in the volume form:  dρ_a/dt = ρ_a Σ V_b v_ab·∇_a W,  V_b = m_b/ρ_b.
//!
//! This form is the one that conserves energy with the pressure force (P_a + P_b)/(ρ_a ρ_b): the work of
//! the pair force is exactly what both particles' compression takes up (Colagrossi & Landrini 2003).

use super::{Num, Pair, Term};

/// Continuity @colagrossi2003.
#[derive(Clone, Copy, Debug)]
pub struct Continuity;

impl<const D: usize> Term<D> for Continuity {
    #[inline(always)]
    fn rate<N: Num>(&self, ab: &Pair<N, D>, sum: (N, N)) -> (N, N) {
        let one = ab.constant(1.0);
        (
            ((one + ab.a.compression) * ab.b.specific_volume).fma(ab.velocity_along_r, sum.0),
            ((one + ab.b.compression) * ab.a.specific_volume).fma(ab.velocity_along_r, sum.1),
        )
    }
}
