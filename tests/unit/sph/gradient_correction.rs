//! Unit tests of `src/sph/gradient_correction.rs`.

use super::*;
use crate::math::Matrix;

/// The full correction matrix B of a moment matrix.
fn b<const D: usize>(moment: &[[f64; D]; D]) -> [[f64; D]; D] {
    let mut b = correction(moment);
    (0..D).for_each(|i| b[i][i] += 1.0);
    b
}

#[test]
fn the_gradient_correction_is_the_inverse_moment_matrix_with_enough_neighbours() {
    // Round-off of a handful of operations.
    let rows = [[0.9, 0.0, 0.0], [0.1, 1.1, 0.0], [-0.05, 0.07, 0.95]];
    let (inverse, moment) = (b(&rows), Matrix::<3>::from_fn(|i, j| rows[i.max(j)][i.min(j)]));
    let product = moment * Matrix::from_fn(|i, j| inverse[i][j]);
    assert!((product - Matrix::identity()).amax() < 1e-14);
}

#[test]
fn the_gradient_correction_fades_with_fewer_neighbours_and_is_bounded() {
    assert_eq!(correction(&[[0.0; 2]; 2]), [[0.0; 2]; 2]);
    assert_eq!(correction(&[[1.0, 0.0], [1.0, 1.0]]), [[0.0; 2]; 2], "a single pair has no gradient across it");
    // w (1/λ − 1) with w = 2 λ μ is at most 2 μ for every λ.
    for small in [1e-12, 1e-6, 1e-3, 0.1, 0.3] {
        let c = correction(&[[small, 0.0], [0.0, 0.8]]);
        assert!(c[0][0] <= 1.6 && c[0][0] >= 0.0, "{small}: {c:?}");
    }
    // A flat surface has half of all neighbours, so w = ½ of C = 1.
    let c = correction(&[[0.5, 0.0], [0.0, 0.5]]);
    assert!((c[0][0] - 0.5).abs() < 1e-15 && c[0][1] == 0.0);
}
