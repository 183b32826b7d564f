//! δ-diffusion:  dρ_a/dt += 2 δ h c₀ Σ (ρ_b − ρ_a) (r_b − r_a)·∇_a W/r² V_b.
//!
//! With ∇_a W = ∂W r_ab the r² cancels and −2 δ h c₀ (ρ_b − ρ_a) ∂W V_b is left, which needs no η² and
//! diffuses, as ∂W < 0.

use serde::{Deserialize, Serialize};

use crate::law::{Medium, Num, Pair, Term};

/// Molteni & Colagrossi's diffusion [@molteni2009]; eq. (15) of [@pirkhalili2023] with the sign that diffuses.
/// It lets a deep tank at rest sink slowly: see [`super::Fourtakas`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
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
    /// The law in water of the given constants.
    pub fn term<const D: usize>(&self, medium: &Medium<D>) -> MolteniTerm {
        MolteniTerm { strength: 2.0 * self.delta * medium.h * medium.c0 }
    }
}

/// The law of [`Molteni`].
#[derive(Clone, Copy, Debug)]
pub struct MolteniTerm {
    strength: f64,
}

impl<N: Num, const D: usize> Term<N, D> for MolteniTerm {
    #[inline(always)]
    fn rate(&self, ab: &Pair<N, D>, sum: (N, N)) -> (N, N) {
        let d = N::of(self.strength) * (ab.b.x - ab.a.x);
        (sum.0 - d * ab.b.s, sum.1 + d * ab.a.s)
    }
}
