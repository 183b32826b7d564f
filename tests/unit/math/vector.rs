//! Unit tests of `src/math/vector.rs`.

use super::*;

#[test]
fn the_exponential_of_a_bivector_is_orthogonal_and_has_its_rotation_vector() {
    // In release builds this also detects the compiler fault that `exp` works around.
    for turn in [[0.0, 0.0, 1.5], [0.3, -0.4, 0.5], [1e-5, 0.0, -1e-9], [-1.0, 2.0, 0.7]] {
        let r = Bivector::<3>::from_axial(&turn).exp();
        assert!((r * r.transpose() - Matrix::identity()).norm() < 1e-14, "{r}");
        let back = Pose { position: Vector::<3>::zeros(), rotation: r }.rotation_vector();
        assert!(back.iter().zip(&turn).all(|(a, b)| (a - b).abs() < 1e-13), "{back:?}");
    }
    let quarter = Bivector::<2>::from_axial(&[std::f64::consts::FRAC_PI_2]).exp();
    assert!((quarter * Vector::from([1.0, 0.0]) - Vector::from([0.0, 1.0])).norm() < 1e-15);
}

#[test]
fn an_upward_force_on_the_right_has_a_counter_clockwise_torque() {
    let torque = Bivector::torque(&Vector::from([1.0, 0.0]), &Vector::from([0.0, 1.0]));
    assert_eq!(torque.axial(), vec![1.0]);
    assert_eq!(torque.power(&Bivector::from_axial(&[3.0])), 3.0);
}
