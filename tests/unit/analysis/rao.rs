//! Unit tests of `src/analysis/rao.rs`.

use super::*;
use crate::error::Result;

/// Response of an oscillator of 0.6 Hz with 15 % of critical damping and base excitation.
fn oscillator(f: f64) -> Complex<f64> {
    let r = f / 0.6;
    Complex::new(1.0 - r * r, 0.3 * r).inv()
}

/// Times, elevations and oscillator response of a JONSWAP sea of 400 s with its peak at 0.5 Hz and H_s = 0.1 m, sampled at 0.05 s.
fn sea() -> (Vec<f64>, Vec<f64>, Vec<f64>) {
    let form = |f: f64| {
        let bump = (-0.5 * ((f / 0.5 - 1.0) / if f <= 0.5 { 0.07 } else { 0.09 }).powi(2)).exp();
        f.powi(-5) * (-1.25 * (0.5 / f).powi(4)).exp() * 3.3_f64.powf(bump)
    };
    let all: Vec<f64> = (0..800).map(|i| (f64::from(i) + 0.5) * 0.0025).collect();
    let scale = 0.025 / all.iter().map(|f| form(*f)).sum::<f64>().sqrt();
    let parts: Vec<_> = (0u32..)
        .zip(&all)
        .map(|(i, &f)| {
            let wave = Complex::from_polar(scale * (2.0 * form(f)).sqrt(), 2.399_963 * f64::from(i) * f64::from(i));
            (TAU * f, wave, wave * oscillator(f))
        })
        .collect();
    let t: Vec<f64> = (0..=8000).map(|i| 0.05 * f64::from(i)).collect();
    let at = |t: f64| {
        let turned = parts.iter().map(|(omega, a, x)| (Complex::from_polar(1.0, omega * t), a, x));
        turned.fold((0.0, 0.0), |(wave, motion), (turn, a, x)| (wave + (turn * a).re, motion + (turn * x).re))
    };
    let (wave, motion) = t.iter().map(|&t| at(t)).unzip();
    (t, wave, motion)
}

#[test]
fn the_rao_of_an_oscillator_in_an_irregular_sea_has_its_exact_ratio_and_phase() -> Result<()> {
    let (t, wave, motion) = sea();
    let bands = rao_over_frequency(&TimeSeries::new(t.clone(), motion)?, &TimeSeries::new(t, wave)?);
    // Bands of 1/100 Hz over the frequencies with at least 2 % of the peak density.
    assert!((65..80).contains(&bands.len()), "{} bands", bands.len());
    for RaoPoint { frequency, ratio, phase, coherence } in bands {
        let exact = oscillator(frequency);
        assert!(
            coherence > 0.9 && coherence < 1.0 + 1e-9,
            "the wave is the only excitation: {coherence} at {frequency} Hz"
        );
        // A window of three lines smooths a resonance 0.18 Hz wide by 3 % and 2 degrees.
        assert!((ratio / exact.norm() - 1.0).abs() < 0.05, "{ratio} at {frequency} Hz");
        let off = (Complex::from_polar(1.0, phase) * exact.conj()).arg();
        assert!(off.abs() < 5.0_f64.to_radians(), "{off} rad at {frequency} Hz");
    }
    Ok(())
}

#[test]
fn noise_reduces_the_coherence_where_the_motion_is_small() -> Result<()> {
    let (t, wave, motion) = sea();
    let deviation = (motion.iter().map(|x| x * x).sum::<f64>() / motion.len() as f64).sqrt();
    // Uniform white noise of half the standard deviation of the motion.
    let mut seed = 1u64;
    let mut noise = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        0.5 * deviation * 12.0_f64.sqrt() * ((seed >> 11) as f64 / 2.0_f64.powi(53) - 0.5)
    };
    let noisy: Vec<f64> = motion.iter().map(|x| x + noise()).collect();
    let bands = rao_over_frequency(&TimeSeries::new(t.clone(), noisy)?, &TimeSeries::new(t, wave)?);
    let inside = |from: f64, until: f64| bands.iter().filter(move |b| b.frequency > from && b.frequency < until);
    // Near the resonance the motion is dozens of times the noise; above 0.8 Hz both are of the same size.
    for band in inside(0.45, 0.65) {
        let off = (band.ratio / oscillator(band.frequency).norm() - 1.0).abs();
        assert!(band.coherence > 0.95 && off < 0.15, "{band:?}");
    }
    let weak: Vec<f64> = inside(0.8, 2.0).map(|band| band.coherence).collect();
    assert!(weak.iter().sum::<f64>() < 0.6 * weak.len() as f64, "{weak:?}");
    Ok(())
}

#[test]
fn too_few_waves_or_no_motion_have_no_rao_over_frequency() -> Result<()> {
    let t: Vec<f64> = (0..1000).map(|i| 0.05 * f64::from(i)).collect();
    let swings = |f: f64| TimeSeries::new(t.clone(), t.iter().map(|t| (TAU * f * t).sin()).collect::<Vec<_>>());
    assert!(rao_over_frequency(&swings(0.5)?, &swings(0.5)?).is_empty(), "25 waves");
    assert!(rao_over_frequency(&TimeSeries::new(t.clone(), vec![0.2; 1000])?, &swings(1.0)?).is_empty(), "no motion");
    assert!(!rao_over_frequency(&swings(1.0)?, &swings(1.0)?).is_empty(), "50 waves");
    Ok(())
}

#[test]
fn the_rao_of_a_regular_wave_has_the_exact_ratio_and_phase_lag() -> Result<()> {
    let (period, phase) = (1.3, -0.8);
    let t: Vec<f64> = (0..1500).map(|i| 0.02 * f64::from(i)).collect();
    let made = |a: f64, phase: f64| {
        TimeSeries::new(t.clone(), t.iter().map(|t| 0.1 + a * (TAU * t / period + phase).cos()).collect::<Vec<_>>())
    };
    let (wave, motion) = (made(0.05, 0.3)?, made(0.08, 0.3 + phase)?);
    // With a given period the fit is exact; otherwise the spline through 65 samples a period has an error of a thousandth.
    for (given, bound) in [(Some(period), 1e-9), (None, 1e-3)] {
        let Some(found) = rao(&motion, &wave, given) else { panic!("a motion with an RAO") };
        let error = (found.ratio / 1.6 - 1.0).abs().max((found.phase - phase).abs());
        assert!(error < bound, "{given:?}: {found:?}");
    }
    Ok(())
}
