//! How a motion answers a wave: the response amplitude operator, RAO = X/A at a frequency.

use std::f64::consts::TAU;

use realfft::num_complex::Complex;

use super::{harmonic, spectra, spectrum};
use crate::series::Series;

/// How far about the peak of the waves lines count, over its frequency.
const BESIDE: f64 = 0.1;

/// An answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// Amplitude of the motion over that of the wave, in the units of both.
    pub ratio: f64,
    /// Phase of the motion less that of the wave, rad, −π to π: positive if the motion is ahead.
    pub phase: f64,
    /// At which period, s.
    pub period: f64,
}

/// How `motion` answers `wave`: by a fit of both harmonics of this `period` (s), or else within a tenth about the peak of the
/// waves, as the cross spectrum over that of the waves. None if there is no such wave, or the series are too short.
pub fn response(motion: &Series, wave: &Series, period: Option<f64>) -> Option<Response> {
    let (ratio, period) = match period {
        Some(period) => {
            let of = |series| harmonic(series, TAU / period).map(|h| Complex::from_polar(h.amplitude, h.phase));
            let (x, a) = (of(motion)?, of(wave)?);
            (x / a, period)
        }
        None => {
            let peak = spectrum(wave)?.peak();
            let (step, lines) = spectra(&[motion, wave])?;
            let near = |j: &usize| ((*j as f64 * step) / peak - 1.0).abs() <= BESIDE.max(0.5 * step / peak);
            let both: Vec<(Complex<f64>, Complex<f64>)> =
                (1..lines[0].len()).filter(near).map(|j| (lines[0][j], lines[1][j])).collect();
            let cross: Complex<f64> = both.iter().map(|(x, a)| x * a.conj()).sum();
            (cross / both.iter().map(|(_, a)| a.norm_sqr()).sum::<f64>(), 1.0 / peak)
        }
    };
    ratio.norm().is_finite().then(|| Response { ratio: ratio.norm(), phase: ratio.arg(), period })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Result;

    #[test]
    fn a_motion_that_lags_its_wave_is_told_by_ratio_and_phase() -> Result<()> {
        let (period, phase) = (1.3, -0.8);
        let t: Vec<f64> = (0..1500).map(|i| 0.02 * f64::from(i)).collect();
        let made = |a: f64, phase: f64| {
            Series::new(t.clone(), t.iter().map(|t| 0.1 + a * (TAU * t / period + phase).cos()).collect::<Vec<_>>())
        };
        let (wave, motion) = (made(0.05, 0.3)?, made(0.08, 0.3 + phase)?);
        // The fit is exact; of lines about the peak the spline through 65 samples a period keeps a thousandth.
        for (given, bound) in [(Some(period), 1e-9), (None, 1e-3)] {
            let Some(found) = response(&motion, &wave, given) else { panic!("it answers") };
            let error = (found.ratio / 1.6 - 1.0).abs().max((found.phase - phase).abs());
            assert!(error < bound, "{given:?}: {found:?}");
        }
        Ok(())
    }
}
