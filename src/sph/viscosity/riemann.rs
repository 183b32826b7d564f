//! Dissipation of a limited Riemann solver:  dv_a/dt = −Σ m_b (q_ab/ρ₀) ∇_a W,  q_ab = min(η u², c₀²) for particles that approach with
//! u = −v_ab·r_ab/|r_ab|, else 0.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::sph::{FluidProperties, Num, Pair, Term};

/// The dissipation of the low-dissipation Riemann solver, limiter η @zhang2017: quadratic in the approach, so that it stops
/// impacts and hardly damps a wave. The source goes on with the linear c₀ u from u = c₀/η on; here q stays quadratic up to the
/// c₀² that the source reaches at u = c₀, which needs no root.
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
    /// The kinematic viscosity ν (m²/s) of a flow with the shear rate γ = `shear` (1/s), for the smoothing length `h` (m):
    /// 0.0295 η γ h² in 2-D, 0.0243 η γ h² in 3-D. Half of the pairs approach, with u = γ r |n_x n_y|. The stress over ρ is
    /// ½ η γ² ⟨|n_x n_y|³⟩/2 (D + 2) ⟨r²⟩ in `dimension` D. Here ⟨|n_x n_y|³⟩ is 1/(6π) in 2-D and 0.0243 in 3-D; ⟨r²⟩ of the
    /// Wendland kernel is 5/9 h² in 2-D and 4/5 h² in 3-D.
    pub fn effective(&self, h: f64, dimension: usize, shear: f64) -> f64 {
        let constant = if dimension == 3 { 0.0243 } else { 0.0295 };
        self.eta * constant * shear * h * h
    }

    /// The law in water of the given constants; `share` (–) of it acts.
    pub fn term<const D: usize>(&self, properties: &FluidProperties<D>, share: f64) -> RiemannTerm {
        RiemannTerm { eta: self.eta * share, most: share * properties.c0 * properties.c0 }
    }
}

/// The law of [`Riemann`].
#[derive(Clone, Copy, Debug)]
pub struct RiemannTerm {
    eta: f64,
    most: f64,
}

impl<const D: usize> Term<D> for RiemannTerm {
    #[inline(always)]
    fn along_r<N: Num>(&self, ab: &Pair<N, D>, sum: N) -> N {
        // u = −v_ab·r_ab/|r_ab|, so that u² = (v_ab·r_ab)²/r².
        let approach = ab.velocity_along_r.min(ab.constant(0.0));
        sum - (approach * approach * ab.inv_r2 * ab.constant(self.eta)).min(ab.constant(self.most))
    }
}
