//! Artificial viscosity:  dv_a/dt = −Σ m_b Π_ab ∇_a W,  Π_ab = −α c̄ μ_ab/ρ̄_ab for approaching particles,
//! else 0;  μ_ab = h v_ab·r_ab/(r² + η²).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::sph::{FluidProperties, Num, Pair, Term};

/// Monaghan's artificial viscosity @monaghan1992; eqs. (4), (5) of @pirkhalili2023. c̄ is c₀: both
/// particles' speeds of sound differ from it by less than 3 % as density varies below 1 %.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Artificial {
    /// α, –.
    pub alpha: f64,
}

impl Default for Artificial {
    /// α = 0.02, the paper's.
    fn default() -> Self {
        Self { alpha: 0.02 }
    }
}

impl Artificial {
    /// The law in water of the given constants.
    pub fn term<const D: usize>(&self, medium: &FluidProperties<D>) -> ArtificialTerm {
        ArtificialTerm { alpha_c_h: self.alpha * medium.c0 * medium.h }
    }
}

/// The law of [`Artificial`].
#[derive(Clone, Copy, Debug)]
pub struct ArtificialTerm {
    alpha_c_h: f64,
}

impl<const D: usize> Term<D> for ArtificialTerm {
    #[inline(always)]
    fn along_r<N: Num>(&self, ab: &Pair<N, D>, sum: N) -> N {
        (ab.constant(self.alpha_c_h) * ab.velocity_along_r.min(ab.constant(0.0))).fma(ab.viscous_factor, sum)
    }
}
