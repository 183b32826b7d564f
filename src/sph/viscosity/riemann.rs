//! Dissipation of a limited Riemann solver:  dv_a/dt = −Σ m_b (ρ̄ q_ab)/(ρ_a ρ_b) ∇_a W,  q_ab = c₀ u min(η u/c₀, 1) for
//! particles that approach with u = −v_ab·r_ab/|r_ab|, else 0.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::sph::{FluidProperties, Num, Pair, Term};

/// The dissipation of the low-dissipation Riemann solver, limiter η @zhang2017: quadratic in the approach, so that it stops
/// impacts and hardly damps a wave; at u ≥ c₀/η it is that of the acoustic solver, ρ̄ c₀ u.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Riemann {
    /// η, –.
    pub eta: f64,
}

impl Default for Riemann {
    /// η = 3, that of the source.
    fn default() -> Self {
        Self { eta: 3.0 }
    }
}

impl Riemann {
    /// The law in water of the given constants; `share` (–) of it acts.
    pub fn term<const D: usize>(&self, properties: &FluidProperties<D>, share: f64) -> RiemannTerm {
        RiemannTerm { eta: self.eta * share, c0: properties.c0 * share }
    }
}

/// The law of [`Riemann`].
#[derive(Clone, Copy, Debug)]
pub struct RiemannTerm {
    eta: f64,
    c0: f64,
}

impl<const D: usize> Term<D> for RiemannTerm {
    #[inline(always)]
    fn along_r<N: Num>(&self, ab: &Pair<N, D>, sum: N) -> N {
        // u = −v_ab·r_ab/|r_ab|, so that u² = (v_ab·r_ab)²/r².
        let approach = ab.velocity_along_r.min(ab.constant(0.0));
        let square = approach * approach * ab.inv_r2;
        sum - (square * ab.constant(self.eta)).min(square.sqrt() * ab.constant(self.c0))
    }
}
