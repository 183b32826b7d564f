//! Slip: the tangential velocity of the water at a face.
//!
//! Partial: boundary particles act with the velocity v_w of their solid. No slip: where the water near a boundary particle, which
//! lies d below the face, has the mean velocity ⟨v⟩ at a height d̄ above it, the particle acts along the face with
//!
//!   u_t = v_w − (d/d̄)(⟨v⟩ − v_w)_t,
//!
//! which continues a linear shear exactly. Free slip: no viscous force between water and solid.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::WallExtrapolation;
use crate::math::Vector;

/// Slip along solids. Scene key `model.slip`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Slip {
    /// No slip at the boundary particles, which lie half a dp and more behind the face.
    Partial,
    /// No slip at the face @morris1997.
    None,
    /// No tangential force.
    Free,
}

impl Slip {
    /// Share of the viscosity that acts between water and solids, –.
    pub(crate) fn wall_viscosity_factor(self) -> f64 {
        if self == Self::Free { 0.0 } else { 1.0 }
    }
}

/// Most d/d̄: at the rim of the support the mean of few particles says little.
const MAX_RATIO: f64 = 4.0;

/// The velocity (m/s) without slip of a boundary particle whose solid moves there with `v` (m/s), `depth` (m) below the face with
/// outward normal `normal`, with sums `fit` over the water. Where the water is not before that face, its solid's.
pub fn no_slip_velocity<const D: usize>(
    fit: &WallExtrapolation<f64, D>,
    v: Vector<D>,
    normal: &Vector<D>,
    depth: f64,
) -> Vector<D> {
    if fit.weight_sum < 1e-9 {
        return v;
    }
    // r_wf points from the water to the wall.
    let height = -normal.dot(&Vector::from(fit.offset_sum)) / fit.weight_sum - depth;
    if height <= 0.0 {
        return v;
    }
    let past = Vector::from(fit.velocity_sum) / fit.weight_sum - v;
    let along = past - normal * normal.dot(&past);
    v - along * (depth / height).min(MAX_RATIO)
}
