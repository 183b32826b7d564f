//! Laminar viscosity:  dv_a/dt = Σ m_b 4 ν₀ r_ab·∇_a W/((ρ_a + ρ_b)(r² + η²)) v_ab.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::sph::{Num, Pair, Term, Units};

/// Laminar viscosity @lo2002; eqs. (6), (7) of @pirkhalili2023.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
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
    /// The law, in `units`. η² reduces a viscous force on a lattice by the factor `damped` (–); the law compensates for this, by
    /// 0.8 % at h = 1.7 dp.
    pub fn term(&self, units: &Units, damped: f64) -> LaminarTerm {
        LaminarTerm { nu0: self.nu0 / damped * units.time / (units.length * units.length) }
    }
}

/// The law of [`Laminar`].
#[derive(Clone, Copy, Debug)]
pub struct LaminarTerm {
    nu0: f64,
}

impl<const D: usize> Term<D> for LaminarTerm {
    const ALONG_V: bool = true;

    #[inline(always)]
    fn along_v<N: Num>(&self, ab: &Pair<N, D>, sum: N) -> N {
        (ab.constant(2.0 * self.nu0) * ab.r2).fma(ab.viscous_factor, sum)
    }
}
