//! Slip: the tangential velocity of the water at a face.
//!
//! Partial slip: boundary particles act on the water with the velocity v_w of their solid. No slip: a boundary particle lies d
//! below the face, and the water near it has the mean velocity ⟨v⟩ at the mean height d̄ above the face. Along the face, the
//! particle acts with
//!
//!   u_t = v_w − (d/d̄)(⟨v⟩ − v_w)_t,
//!
//! which continues a linear shear exactly. Free slip: no viscous force between water and solid.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::WallExtrapolation;
use crate::{math::Vector, sph::Num};

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

/// Largest d/d̄, –: at the rim of the support the mean over few particles is inaccurate.
const MAX_RATIO: f64 = 4.0;

/// The velocity (m/s) with which a boundary particle acts on the water without slip. It lies `depth` (m) below the face with
/// outward normal `normal`; its solid moves there with `v` (m/s); `fit` are its sums over the water. If the water is not before
/// that face, the velocity is `v`.
pub fn no_slip_velocity<const D: usize>(
    fit: &WallExtrapolation<f64, D>,
    v: Vector<D>,
    normal: &Vector<D>,
    depth: f64,
) -> Vector<D> {
    v - Vector::from(no_slip_difference(fit, &v.into(), &(*normal).into(), depth))
}

/// The velocity of the solid less the velocity with which a boundary particle acts on the water without slip: see
/// [`no_slip_velocity`].
pub(crate) fn no_slip_difference<N: Num, const D: usize>(
    fit: &WallExtrapolation<N, D>,
    v: &[N; D],
    normal: &[N; D],
    depth: N,
) -> [N; D] {
    let weight = fit.weight_sum;
    let zero = weight.constant(0.0);
    // r_wf points from the water to the wall.
    let height = -dot(normal, &fit.offset_sum) / weight - depth;
    let past: [N; D] = std::array::from_fn(|k| fit.velocity_sum[k] / weight - v[k]);
    let across = dot(normal, &past);
    let ratio = Num::min(depth / height, weight.constant(MAX_RATIO));
    std::array::from_fn(|k| {
        let before_face = zero.select_below(height, (past[k] - normal[k] * across) * ratio, zero);
        weight.select_below(weight.constant(1e-9), zero, before_face)
    })
}

fn dot<N: Num, const D: usize>(a: &[N; D], b: &[N; D]) -> N {
    (1..D).fold(a[0] * b[0], |sum, k| sum + a[k] * b[k])
}
