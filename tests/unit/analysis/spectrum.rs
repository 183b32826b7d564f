//! Unit tests of `src/analysis/spectrum.rs`.

use super::*;
use crate::error::Result;
use std::f64::consts::TAU;

/// A sea of so many components evenly apart in frequency, with phases that a golden angle apart make irregular.
fn sea(density: impl Fn(f64) -> f64, step: f64, count: u32, until: f64) -> Result<TimeSeries> {
    let t: Vec<f64> = (0..=(until / 0.05) as usize).map(|i| i as f64 * 0.05).collect();
    let part = |t: f64, i: u32| {
        let f = (f64::from(i) + 0.5) * step;
        let phase = 2.399_963 * f64::from(i) * f64::from(i);
        (2.0 * density(f) * step).sqrt() * (TAU * f * t + phase).cos()
    };
    let x: Vec<f64> = t.iter().map(|&t| (0..count).map(|i| part(t, i)).sum()).collect();
    TimeSeries::new(t, x)
}

/// JONSWAP of peak frequency `peak` (Hz) and γ = 3.3, not normed.
fn jonswap(f: f64, peak: f64) -> f64 {
    let sigma = if f <= peak { 0.07 } else { 0.09 };
    let bump = (-0.5 * ((f / peak - 1.0) / sigma).powi(2)).exp();
    f.powi(-5) * (-1.25 * (peak / f).powi(4)).exp() * 3.3_f64.powf(bump)
}

#[test]
fn a_sine_has_its_period_and_four_deviations() -> Result<()> {
    let t: Vec<f64> = (0..1000).map(|i| f64::from(i) * 0.02).collect();
    let x: Vec<f64> = t.iter().map(|t| 0.3 + 0.1 * (TAU * t / 1.37).sin()).collect();
    let Some(found) = spectrum(&TimeSeries::new(t, x)?) else { panic!("it has a spectrum") };
    // 14.6 periods, not a whole number: the variance of what is over is within 2 %, half of that of the root.
    assert!((found.significant_height() / (0.4 / 2.0_f64.sqrt()) - 1.0).abs() < 0.02, "{}", found.significant_height());
    // Lines are 1/20 Hz apart; the centroid of a Hann window's is its middle, but for what other lines have of it.
    assert!((found.peak_period() / 1.37 - 1.0).abs() < 0.01, "{}", found.peak_period());
    Ok(())
}

#[test]
fn a_jonswap_sea_has_its_significant_height_and_its_peak() -> Result<()> {
    let (peak, step, count) = (0.5, 0.0025, 800);
    let m0: f64 = (0..count).map(|i| jonswap((f64::from(i) + 0.5) * step, peak) * step).sum();
    let height = 0.1;
    let scale = height * height / (16.0 * m0);
    // 400 s, the time after which a sum of such components repeats itself: all its variance, 200 peak periods.
    let series = sea(|f| scale * jonswap(f, peak), step, count, 400.0)?;
    let Some(found) = spectrum(&series) else { panic!("it has a spectrum") };
    assert!(
        (found.significant_height() / height - 1.0).abs() < 0.02,
        "H_m0 within 2 %: {}",
        found.significant_height()
    );
    // Lines of a quarter of the record are 1/100 Hz apart, and the peak of one sea of 200 waves wanders by as much.
    assert!((found.peak_period() * peak - 1.0).abs() < 0.05, "T_p within 5 %: {}", found.peak_period());
    Ok(())
}

#[test]
fn what_does_not_change_has_no_spectrum() -> Result<()> {
    let t: Vec<f64> = (0..100).map(f64::from).collect();
    assert_eq!(spectrum(&TimeSeries::new(t.clone(), vec![0.3; 100])?), None);
    assert_eq!(spectrum(&TimeSeries::new(t[..8].to_vec(), t[..8].to_vec())?), None, "too short");
    Ok(())
}
