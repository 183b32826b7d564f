//! δ-diffusion:  dρ_a/dt += 2 δ h c₀ Σ (ρ_b − ρ_a) (r_b − r_a)·∇_a W/r² V_b.
//!
//! With ∇_a W = ∂W r_ab the r² cancels and −2 δ h c₀ (ρ_b − ρ_a) ∂W V_b is left, which needs no η² and
//! diffuses, as ∂W < 0.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Fourtakas, FourtakasTerm};
use crate::{math::Vector, sph::FluidProperties};

/// Molteni & Colagrossi's diffusion @molteni2009; eq. (15) of @pirkhalili2023 with the sign that diffuses.
/// It lets a deep tank at rest sink slowly: see [`super::Fourtakas`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Molteni {
    /// δ, –.
    pub delta: f64,
}

impl Default for Molteni {
    /// δ = 0.1, the paper's.
    fn default() -> Self {
        Self { delta: 0.1 }
    }
}

impl Molteni {
    /// The law in water of the given constants: that of [`super::Fourtakas`] without the hydrostatic part. So both diffusions
    /// share one compiled pair loop for each choice of the other laws.
    pub fn term<const D: usize>(&self, medium: &FluidProperties<D>) -> FourtakasTerm<D> {
        let mut term = Fourtakas { delta: self.delta }.term(&FluidProperties { gravity: Vector::zeros(), ..*medium });
        term.c2 = f64::INFINITY;
        term
    }
}
