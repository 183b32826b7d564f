//! Viscosities, one a file.

use serde::{Deserialize, Serialize};

/// Monaghan's artificial viscosity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Artificial {
    /// α, –.
    pub alpha: f64,
}

impl Default for Artificial {
    fn default() -> Self {
        Self { alpha: 0.02 }
    }
}

/// Laminar viscosity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Laminar {
    /// Kinematic viscosity ν₀, m²/s.
    pub nu0: f64,
}

impl Default for Laminar {
    fn default() -> Self {
        Self { nu0: 1e-6 }
    }
}

/// Laminar viscosity and sub-particle-scale stress.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Sps {
    /// Kinematic viscosity ν₀, m²/s.
    pub nu0: f64,
    /// Smagorinsky constant C_s, –.
    pub smagorinsky: f64,
    /// Isotropic constant C_I, –.
    pub isotropic: f64,
}

impl Default for Sps {
    fn default() -> Self {
        Self { nu0: 1e-6, smagorinsky: 0.12, isotropic: 0.0066 }
    }
}
