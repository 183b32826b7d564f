//! Where a solid is in a frame: the rigid motion that carries its boundary particles there.

use nalgebra::{Matrix3, Vector3};
use serde::Serialize;

use super::outline::to_3d;
use crate::math::Pose;

/// A pose in three coordinates; in 2-D the third stays as it is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Placement {
    /// Position of the frame's origin, m.
    pub at: [f64; 3],
    /// Rows of the matrix that turns local into world directions, –.
    pub turn: [[f64; 3]; 3],
}

impl Placement {
    /// The same as `pose`.
    pub fn from_pose<const D: usize>(pose: &Pose<D>) -> Self {
        let entry = |i: usize, j: usize| if i < D && j < D { pose.rotation[(i, j)] } else { f64::from(i == j) };
        let turn = std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)));
        Self { at: to_3d(&pose.position), turn }
    }

    /// World position (m) of the local point `x` (m).
    pub fn to_world(self, x: &[f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| self.at[i] + (0..3).map(|j| self.turn[i][j] * x[j]).sum::<f64>())
    }

    /// Local coordinates (m) of the world point `x` (m).
    pub fn to_local(self, x: &[f32; 3]) -> [f64; 3] {
        std::array::from_fn(|i| (0..3).map(|j| self.turn[j][i] * (f64::from(x[j]) - self.at[j])).sum())
    }

    /// This pose once the solid has moved as its points have `from` → `to`: least squares over all of them
    /// (Kabsch 1976).
    pub fn fitted_to(&self, from: &[[f32; 3]], to: &[[f32; 3]]) -> Self {
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
        // A mirror image is no motion.
        let flip = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, (u * v).determinant().signum()));
        let turn = if from.len() < 3 { Matrix3::identity() } else { u * flip * v };
        let own = Matrix3::from_fn(|i, j| self.turn[i][j]);
        let (at, turned) = (turn * (Vector3::from(self.at) - a) + b, turn * own);
        Self { at: at.into(), turn: std::array::from_fn(|i| std::array::from_fn(|j| turned[(i, j)])) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vector;

    #[test]
    fn the_motion_of_a_solid_is_found_from_its_points() {
        let single = |x: Vector<3>| [x[0] as f32, x[1] as f32, x[2] as f32];
        let local: Vec<Vector<3>> =
            (0..40).map(|i| Vector::from([f64::from(i % 4), f64::from(i / 4 % 3), f64::from(i / 12)]) * 0.1).collect();
        let (start, end) = (
            Pose::<3>::rotated(Vector::from([1.0, 2.0, 3.0]), &[0.1, 0.2, 0.3]),
            Pose::<3>::rotated(Vector::from([1.5, 2.0, 2.0]), &[-1.0, 2.0, 0.7]),
        );
        let points = |pose: &Pose<3>| local.iter().map(|x| single(pose.point(x))).collect::<Vec<_>>();
        let found = Placement::from_pose(&start).fitted_to(&points(&start), &points(&end));
        let asked = Placement::from_pose(&end);
        let x = [0.3, -0.2, 0.1];
        let off = found.to_world(&x).iter().zip(asked.to_world(&x)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 1e-6, "the points are known in single precision: 1e-7 of 3 m; off by {off}");
    }

    #[test]
    fn a_flat_solid_turns_in_its_plane() {
        let start = Pose::<2>::at(Vector::from([1.0, 0.0]));
        let end = Pose::<2>::rotated(Vector::from([1.0, 0.0]), &[0.5]);
        let points = |pose: &Pose<2>| {
            [[0.1, 0.0], [0.0, 0.2], [-0.1, 0.0], [0.0, -0.2]]
                .map(|x| to_3d(&pose.point(&Vector::from(x))).map(|c| c as f32))
        };
        let found = Placement::from_pose(&start).fitted_to(&points(&start), &points(&end));
        assert!((found.turn[1][0] - 0.5_f64.sin()).abs() < 1e-6 && (found.turn[2][2] - 1.0).abs() < 1e-6, "{found:?}");
    }
}
