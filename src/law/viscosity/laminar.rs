//! Laminar viscosity:  dv_a/dt = Σ m_b 4 ν₀ r_ab·∇_a W/((ρ_a + ρ_b)(r² + η²)) v_ab.

use serde::{Deserialize, Serialize};

use crate::law::{Num, Pair, Term};

/// Laminar viscosity [@lo2002]; eqs. (6), (7) of [@pirkhalili2023].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Laminar {
    /// Kinematic viscosity ν₀, m²/s.
    pub nu0: f64,
}

impl Default for Laminar {
    /// Water: 1e-6 m²/s.
    fn default() -> Self {
        Self { nu0: 1e-6 }
    }
}

impl Laminar {
    /// The law.
    pub fn term(&self) -> LaminarTerm {
        LaminarTerm { nu0: self.nu0 }
    }
}

/// The law of [`Laminar`].
#[derive(Clone, Copy, Debug)]
pub struct LaminarTerm {
    nu0: f64,
}

impl<N: Num, const D: usize> Term<N, D> for LaminarTerm {
    #[inline(always)]
    fn along_v(&self, ab: &Pair<N, D>, sum: N) -> N {
        sum + N::of(2.0 * self.nu0) * ab.r2 * ab.inv_r2 * ab.s_mean
    }
}
