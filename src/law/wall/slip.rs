//! Slip: with what velocity along its face a boundary particle shows itself to the water.
//!
//! The water near it moves on the mean with ⟨v⟩, at a height d̄ above the face; the particle lies d below it. Without slip it
//! shows the velocity that continues the water's through the wall's at the face, with free slip the water's own:
//!
//!   no slip   u_t = v_w − (d/d̄)(⟨v⟩ − v_w)_t,      free slip   u_t = ⟨v⟩_t.
//!
//! Across the face it shows the wall's. A shear that is linear from the face on is continued exactly.

use serde::{Deserialize, Serialize};

use super::Fit;
use crate::space::Vector;

/// How water slips along solids. Scene word `model.slip`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Slip {
    /// Boundary particles show the velocity of their solid: the water sticks to them, half a dp and more behind the face.
    #[default]
    Partial,
    /// The water sticks to the face [@morris1997].
    None,
    /// No drag along the face.
    Free,
}

/// Most d/d̄: at the rim of the support the mean of few particles says little.
const MOST: f64 = 4.0;

impl Slip {
    /// The velocity (m/s) that a particle shows whose solid moves there with `v` (m/s), `depth` (m) below the face with outward
    /// normal `normal`, with sums `fit` over the water. Where the water is not before that face, its solid's.
    pub fn close<const D: usize>(self, fit: &Fit<f64, D>, v: Vector<D>, normal: &Vector<D>, depth: f64) -> Vector<D> {
        if self == Self::Partial || fit.weight < 1e-9 {
            return v;
        }
        // r_wf points from the water to the wall.
        let height = -normal.dot(&Vector::from(fit.arm)) / fit.weight - depth;
        if height <= 0.0 {
            return v;
        }
        let past = Vector::from(fit.flow) / fit.weight - v;
        let along = past - normal * normal.dot(&past);
        match self {
            Self::Free => v + along,
            _ => v - along * (depth / height).min(MOST),
        }
    }
}
