//! Unit tests of `src/analysis/reflection.rs`.

use super::*;
use crate::error::Result;

const DEPTH: f64 = 0.4;
const PLACES: [f64; 3] = [2.0, 2.21, 2.58];

/// Elevation at `x` of waves of these frequencies (Hz) and amplitudes with the reflection coefficient `back`.
fn elevation(x: f64, back: f64, parts: &[(f64, f64)], until: f64) -> Result<TimeSeries> {
    let t: Vec<f64> = (0..=(until * 50.0) as usize).map(|i| i as f64 * 0.02).collect();
    let at = |t: f64| -> f64 {
        let part = |(n, (f, a)): (usize, &(f64, f64))| {
            let (omega, phase) = (TAU * f, 2.399_963 * (n * n) as f64);
            let k = wave_number(omega, DEPTH, 9.81);
            a * (omega * t - k * x + phase).cos() + back * a * (omega * t + k * x + phase + 0.7).cos()
        };
        parts.iter().enumerate().map(part).sum()
    };
    let x: Vec<f64> = t.iter().map(|&t| at(t)).collect();
    TimeSeries::new(t, x)
}

#[test]
fn incident_and_reflected_regular_waves_are_separated_exactly() -> Result<()> {
    let series: Result<Vec<TimeSeries>> = PLACES.iter().map(|&x| elevation(x, 0.3, &[(0.8, 0.05)], 11.3)).collect();
    let series = series?;
    let gauges: Vec<(f64, &TimeSeries)> = PLACES.into_iter().zip(&series).collect();
    let Some(found) = reflection(&gauges, DEPTH, 9.81, Some(1.25)) else { panic!("a separation") };
    assert!((found.coefficient() - 0.3).abs() < 1e-6, "{found:?}");
    assert!((found.incident - 0.1).abs() < 1e-6 * 0.1, "{found:?}");
    Ok(())
}

#[test]
fn incident_and_reflected_irregular_waves_are_separated_line_by_line() -> Result<()> {
    let parts: Vec<(f64, f64)> = (0..60).map(|i| (0.5 + 0.01 * f64::from(i), 0.004)).collect();
    let series: Result<Vec<TimeSeries>> = PLACES.iter().map(|&x| elevation(x, 0.2, &parts, 200.0)).collect();
    let series = series?;
    let gauges: Vec<(f64, &TimeSeries)> = PLACES.into_iter().zip(&series).collect();
    let Some(found) = reflection(&gauges, DEPTH, 9.81, None) else { panic!("a separation") };
    // Lines are 1/200 Hz apart, and a window three lines wide mixes neighbours.
    assert!((found.coefficient() / 0.2 - 1.0).abs() < 0.05, "{found:?}");
    Ok(())
}

#[test]
fn gauges_half_a_wavelength_apart_cannot_separate_the_waves() -> Result<()> {
    let half = 0.5 * TAU / wave_number(TAU * 0.8, DEPTH, 9.81);
    let places = [1.0, 1.0 + half, 1.0 + 2.0 * half];
    let series: Result<Vec<TimeSeries>> = places.iter().map(|&x| elevation(x, 0.3, &[(0.8, 0.05)], 10.0)).collect();
    let series = series?;
    let gauges: Vec<(f64, &TimeSeries)> = places.into_iter().zip(&series).collect();
    assert_eq!(reflection(&gauges, DEPTH, 9.81, Some(1.25)), None);
    Ok(())
}
