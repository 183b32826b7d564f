//! Particle shifting.

use serde::{Deserialize, Serialize};

/// Fickian shifting with a free-surface factor.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Shift {
    /// A, –.
    pub a: f64,
}

impl Default for Shift {
    fn default() -> Self {
        Self { a: 2.0 }
    }
}
