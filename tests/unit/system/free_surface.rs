//! Unit tests of `src/system/free_surface.rs`.

use super::half_crossings;

#[test]
fn surfaces_are_the_downward_crossings_of_one_half_from_the_highest_down() {
    let two_layers = |z: f64| if (0.1..0.2).contains(&z) || (0.0..0.05).contains(&z) { 1.0 } else { 0.1 };
    let found: Vec<f64> = half_crossings(two_layers, 0.0, 0.4, 0.01, 1e-5).collect();
    assert_eq!(found.len(), 2);
    for (found, expected) in found.iter().zip([0.2, 0.05]) {
        assert!((found - expected).abs() <= 1e-5, "within the requested tolerance; got {found}");
    }
    assert_eq!(half_crossings(|_| 0.4, 0.0, 1.0, 0.01, 1e-5).next(), None);
    assert_eq!(half_crossings(|_| 0.0, f64::INFINITY, f64::NEG_INFINITY, 0.01, 1e-5).next(), None);
}
