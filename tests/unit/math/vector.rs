//! Unit tests of `src/math/vector.rs`.

use std::hint::black_box;

use super::*;

#[test]
fn the_exponential_of_a_bivector_is_orthogonal_and_has_its_rotation_vector() {
    for turn in [[0.0, 0.0, 1.5], [0.3, -0.4, 0.5], [1e-5, 0.0, -1e-9], [-1.0, 2.0, 0.7]] {
        let r = Bivector::<3>::from_axial(&turn).exp();
        assert!((r * r.transpose() - Matrix::identity()).norm() < 1e-14, "{r}");
        let back = Pose { position: Vector::<3>::zeros(), rotation: r }.rotation_vector();
        assert!(back.iter().zip(&turn).all(|(a, b)| (a - b).abs() < 1e-13), "{back:?}");
    }
    let quarter = Bivector::<2>::from_axial(&[std::f64::consts::FRAC_PI_2]).exp();
    assert!((quarter * Vector::from([1.0, 0.0]) - Vector::from([0.0, 1.0])).norm() < 1e-15);
}

/// The product of two matrices, entry by entry: `black_box` keeps the compiler from vectorising it.
fn product<const D: usize>(a: &Matrix<D>, b: &Matrix<D>) -> Matrix<D> {
    let term = |i: usize, k: usize, j: usize| black_box(black_box(a[(i, k)]) * black_box(b[(k, j)]));
    Matrix::from_fn(|i, j| (1..D).fold(term(i, 0, j), |sum, k| black_box(sum + term(i, k, j))))
}

/// Bivectors and symmetric tensors of all magnitudes, and one whose entries the compiler fault falsifies.
fn samples() -> impl Iterator<Item = (Bivector<3>, Matrix<3>)> {
    let mut state = 1_u64;
    let mut random = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let mut axial = move |size: f64| [0.0; 3].map(|_| size * random());
    let sizes = (0..200).map(|i| 10_f64.powf(0.02 * f64::from(i) - 3.0));
    let random = sizes.map(move |size| (axial(size), axial(1.0), axial(1.0)));
    [([0.3, -0.4, 0.5], [1.0, 2.0, 3.0], [0.1, 0.2, -0.3])].into_iter().chain(random).map(|(turn, d, o)| {
        let tensor = Matrix::<3>::new(d[0], o[0], o[1], o[0], d[1], o[2], o[1], o[2], d[2]);
        (Bivector::from_axial(&turn), tensor)
    })
}

#[test]
fn sums_of_matrix_products_have_the_bits_of_scalar_sums() {
    // rustc 1.95 at opt-level 3 returns 0.5217 in place of 0.4018 for entry (1, 0) of the first exponential if the source
    // writes it as `identity + w * a + w * w * b`.
    for (spin, tensor) in samples() {
        let rotation = spin.exp();
        let angle = (0.5 * spin.0.norm_squared()).sqrt();
        let (a, b) = (angle.sin() / angle, (1.0 - angle.cos()) / (angle * angle));
        let square = product(&spin.0, &spin.0);
        let entry = |i: usize, j: usize| f64::from(u8::from(i == j)) + (spin.0[(i, j)] * a + square[(i, j)] * b);
        assert_eq!(rotation, Matrix::<3>::from_fn(entry), "exp {spin:?}");
        let expected = product(&product(&rotation, &tensor), &rotation.transpose());
        assert_eq!(rotated_tensor(&rotation, &tensor), expected, "{tensor} by {rotation}");
        let (pose, inner) =
            (Pose { position: Vector::zeros(), rotation }, Pose::rotated(Vector::zeros(), &[0.5, 1.0, -2.0]));
        assert_eq!(pose.then(&inner).rotation, product(&rotation, &inner.rotation));
    }
}

#[test]
fn an_upward_force_on_the_right_has_a_counter_clockwise_torque() {
    let torque = Bivector::torque(&Vector::from([1.0, 0.0]), &Vector::from([0.0, 1.0]));
    assert_eq!(torque.axial(), vec![1.0]);
    assert_eq!(torque.power(&Bivector::from_axial(&[3.0])), 3.0);
}
