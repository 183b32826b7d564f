//! Computes the placement of a solid in a frame: the rigid motion that best fits its boundary particles.

use nalgebra::{Matrix3, Vector3};
use serde::Serialize;

use super::outline::to_3d;
use crate::math::Pose;

/// A pose in three coordinates; in 2-D the third coordinate does not change.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct Placement {
    /// The position of the origin of the local frame, m.
    pub at: [f64; 3],
    /// The rows of the matrix that rotates local directions to world directions, –.
    pub turn: [[f64; 3]; 3],
}

impl Placement {
    /// Returns the placement equal to `pose`.
    pub(crate) fn from_pose<const D: usize>(pose: &Pose<D>) -> Self {
        let entry = |i: usize, j: usize| if i < D && j < D { pose.rotation[(i, j)] } else { f64::from(i == j) };
        let turn = std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)));
        Self { at: to_3d(&pose.position), turn }
    }

    /// Returns the world position (m) of the local point `x` (m).
    pub(crate) fn to_world(self, x: &[f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| self.at[i] + (0..3).map(|j| self.turn[i][j] * x[j]).sum::<f64>())
    }

    /// Returns the local coordinates (m) of the world point `x` (m).
    pub(crate) fn to_local(self, x: &[f32; 3]) -> [f64; 3] {
        std::array::from_fn(|i| (0..3).map(|j| self.turn[j][i] * (f64::from(x[j]) - self.at[j])).sum())
    }

    /// Returns this placement after the rigid motion that moves the points `from` to `to`, by least squares over all
    /// points (Kabsch 1976).
    pub(crate) fn fitted_to(&self, from: &[[f32; 3]], to: &[[f32; 3]]) -> Self {
        let mean = |x: &[[f32; 3]]| {
            let total = |i: usize| x.iter().map(|x| f64::from(x[i])).sum::<f64>();
            Vector3::from_fn(|i, _| total(i) / x.len().max(1) as f64)
        };
        let (a, b) = (mean(from), mean(to));
        let both = |i: usize, j: usize| {
            let pairs = from.iter().zip(to);
            pairs.map(|(x, y)| (f64::from(y[i]) - b[i]) * (f64::from(x[j]) - a[j])).sum::<f64>()
        };
        let spread = Matrix3::from_fn(both);
        let svd = spread.svd(true, true);
        let (Some(u), Some(v)) = (svd.u, svd.v_t) else { return *self };
        // A reflection is not a rigid motion.
        let flip = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, (u * v).determinant().signum()));
        let turn = if from.len() < 3 { Matrix3::identity() } else { u * flip * v };
        let own = Matrix3::from_fn(|i, j| self.turn[i][j]);
        let (at, turned) = (turn * (Vector3::from(self.at) - a) + b, turn * own);
        Self { at: at.into(), turn: std::array::from_fn(|i| std::array::from_fn(|j| turned[(i, j)])) }
    }
}

#[cfg(test)]
#[path = "../../tests/unit/report/placement.rs"]
mod tests;
