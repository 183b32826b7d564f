//! Unit tests of `src/analysis/spectrum.rs`.

use super::*;
use crate::error::Result;
use std::f64::consts::TAU;

/// A sea of `count` components at equal intervals of frequency, with irregular phases from the golden angle.
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

/// JONSWAP spectrum with the peak frequency `peak` (Hz) and γ = 3.3, not normalised.
fn jonswap(f: f64, peak: f64) -> f64 {
    let sigma = if f <= peak { 0.07 } else { 0.09 };
    let bump = (-0.5 * ((f / peak - 1.0) / sigma).powi(2)).exp();
    f.powi(-5) * (-1.25 * (peak / f).powi(4)).exp() * 3.3_f64.powf(bump)
}

#[test]
fn the_spectrum_of_a_sine_has_its_period_and_a_height_of_four_deviations() -> Result<()> {
    let t: Vec<f64> = (0..1000).map(|i| f64::from(i) * 0.02).collect();
    let x: Vec<f64> = t.iter().map(|t| 0.3 + 0.1 * (TAU * t / 1.37).sin()).collect();
    let Some(found) = spectrum(&TimeSeries::new(t, x)?) else { panic!("a spectrum") };
    // 14.6 periods are not a whole number: the variance is within 2 %, its root within half of that.
    assert!((found.significant_height() / (0.4 / 2.0_f64.sqrt()) - 1.0).abs() < 0.02, "{}", found.significant_height());
    // Lines are 1/20 Hz apart; the centroid of a Hann window is its middle, up to leakage to other lines.
    assert!((found.peak_period() / 1.37 - 1.0).abs() < 0.01, "{}", found.peak_period());
    Ok(())
}

#[test]
fn the_spectrum_of_a_jonswap_sea_has_its_significant_height_and_peak_period() -> Result<()> {
    let (peak, step, count) = (0.5, 0.0025, 800);
    let m0: f64 = (0..count).map(|i| jonswap((f64::from(i) + 0.5) * step, peak) * step).sum();
    let height = 0.1;
    let scale = height * height / (16.0 * m0);
    // 400 s is the repeat time of the sum of components: the record has the whole variance and 200 peak periods.
    let series = sea(|f| scale * jonswap(f, peak), step, count, 400.0)?;
    let Some(found) = spectrum(&series) else { panic!("a spectrum") };
    assert!(
        (found.significant_height() / height - 1.0).abs() < 0.02,
        "H_m0 within 2 %: {}",
        found.significant_height()
    );
    // Lines of a quarter of the record are 1/100 Hz apart, and the peak of one sea of 200 waves varies by as much.
    assert!((found.peak_period() * peak - 1.0).abs() < 0.05, "T_p within 5 %: {}", found.peak_period());
    Ok(())
}

#[test]
fn a_constant_or_short_series_has_no_spectrum() -> Result<()> {
    let t: Vec<f64> = (0..100).map(f64::from).collect();
    assert_eq!(spectrum(&TimeSeries::new(t.clone(), vec![0.3; 100])?), None);
    assert_eq!(spectrum(&TimeSeries::new(t[..8].to_vec(), t[..8].to_vec())?), None, "too short");
    Ok(())
}
