//! Unit tests of `src/preflight/driven_motion.rs`.

use std::f64::consts::TAU;

use super::*;

#[test]
fn the_largest_stroke_is_found_with_a_ramp_and_with_noise() {
    let displacement = |t: f64| 0.1 * (t / 4.0).min(1.0) * (TAU * t).sin() + 1e-3 * (57.0 * t).sin();
    let samples: Vec<f64> = (0..=1000).map(|i| displacement(0.01 * i as f64)).collect();
    let (stroke, steps) = largest_stroke(&samples).unwrap_or((0.0, 0));
    // Noise shifts the turning points by a few samples and the stroke by 2 per cent.
    assert!((stroke - 0.2).abs() < 0.005 && (45..=55).contains(&steps), "{stroke} {steps}");
    assert_eq!(largest_stroke(&[0.0, 0.1, 0.3, 0.4]), None, "a monotonic motion has no stroke");
}
