//! Density diffusion, with one law in each file. The rest of the program uses the laws through this module only.

mod fourtakas;
mod molteni;

pub use fourtakas::{Fourtakas, FourtakasTerm};
pub use molteni::Molteni;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::FluidProperties;

/// The density diffusion. Scene key `model.diffusion`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Diffusion {
    /// None.
    None,
    /// Molteni & Colagrossi (2009).
    Molteni(Molteni),
    /// Fourtakas et al. (2019): without the hydrostatic part of the density difference.
    Fourtakas(Fourtakas),
}

impl Diffusion {
    /// The term in the pair loop.
    pub(crate) fn term<const D: usize>(&self, properties: &FluidProperties<D>) -> Option<FourtakasTerm<D>> {
        match self {
            Self::None => None,
            Self::Molteni(law) => Some(law.term(properties)),
            Self::Fourtakas(law) => Some(law.term(properties)),
        }
    }

    /// λ h/c₀ (–), where λ is the rate (1/s) at which the diffusion damps the shortest waves: 7 δ.
    pub(crate) fn damping(&self) -> f64 {
        7.0 * match self {
            Self::None => 0.0,
            Self::Molteni(law) => law.delta,
            Self::Fourtakas(law) => law.delta,
        }
    }
}
