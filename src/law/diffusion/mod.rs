//! Density diffusions, one a file.

use serde::{Deserialize, Serialize};

/// Molteni & Colagrossi's density diffusion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Molteni {
    /// δ, –.
    pub delta: f64,
}

impl Default for Molteni {
    fn default() -> Self {
        Self { delta: 0.1 }
    }
}

/// Fourtakas' density diffusion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Fourtakas {
    /// δ, –.
    pub delta: f64,
}

impl Default for Fourtakas {
    fn default() -> Self {
        Self { delta: 0.1 }
    }
}
