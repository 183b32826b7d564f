//! How a motion answers a wave: the response amplitude operator, RAO = X/A at a frequency.

use std::f64::consts::TAU;

use realfft::num_complex::Complex;

use super::{
    complex_amplitudes, harmonic, spectrum,
    spectrum::{SEGMENTS, segment_transforms},
    zero_crossing_waves,
};
use crate::math::time_series::TimeSeries;

/// How far about the peak of the waves lines count, over its frequency.
const PEAK_HALF_WIDTH: f64 = 0.1;

/// Waves of a record at least of which the answer is told over frequency: eight in each quarter.
pub(crate) const MIN_WAVES_FOR_RAO: usize = 8 * SEGMENTS;

/// Least density of the waves at a frequency at which they are answered, over that at their peak, –.
const MIN_WAVE_DENSITY: f64 = 0.02;

/// An answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rao {
    /// Amplitude of the motion over that of the wave, in the units of both.
    pub ratio: f64,
    /// Phase of the motion less that of the wave, rad, −π to π: positive if the motion is ahead.
    pub phase: f64,
    /// At which period, s.
    pub period: f64,
}

/// How `motion` answers `wave`: by a fit of both harmonics of this `period` (s), or else within a tenth about the peak of the
/// waves, as the cross spectrum over that of the waves. None if there is no such wave, or the series are too short.
pub(crate) fn rao(motion: &TimeSeries, wave: &TimeSeries, period: Option<f64>) -> Option<Rao> {
    let (ratio, period) = match period {
        Some(period) => {
            let of = |series| harmonic(series, TAU / period).map(|h| Complex::from_polar(h.amplitude, h.phase));
            let (x, a) = (of(motion)?, of(wave)?);
            (x / a, period)
        }
        None => {
            let peak = spectrum(wave)?.peak_frequency();
            let (step, lines) = complex_amplitudes(&[motion, wave])?;
            let near = |j: &usize| ((*j as f64 * step) / peak - 1.0).abs() <= PEAK_HALF_WIDTH.max(0.5 * step / peak);
            let both: Vec<(Complex<f64>, Complex<f64>)> =
                (1..lines[0].len()).filter(near).map(|j| (lines[0][j], lines[1][j])).collect();
            let cross: Complex<f64> = both.iter().map(|(x, a)| x * a.conj()).sum();
            (cross / both.iter().map(|(_, a)| a.norm_sqr()).sum::<f64>(), 1.0 / peak)
        }
    };
    ratio.norm().is_finite().then(|| Rao { ratio: ratio.norm(), phase: ratio.arg(), period })
}

/// An answer at one frequency of irregular waves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RaoPoint {
    /// Hz.
    pub frequency: f64,
    /// Amplitude of the motion over that of the wave, in the units of both.
    pub ratio: f64,
    /// Phase of the motion less that of the wave, rad, −π to π: positive if the motion is ahead.
    pub phase: f64,
    /// Coherence γ², 0 to 1: the share of the motion's variance here that answers the wave.
    pub coherence: f64,
}

/// How `motion` answers the irregular `wave` over frequency:
///
///   H₁ = S_ax/S_aa,   γ² = |S_ax|²/(S_aa S_xx)
///
/// by means over seven parts, quarters of the record and those that lie half over two (@bendat2010, @welch1967). Only where
/// the waves have a fiftieth of the density at their peak or more. None of fewer than 32 waves, or where nothing moves.
pub(crate) fn rao_over_frequency(motion: &TimeSeries, wave: &TimeSeries) -> Vec<RaoPoint> {
    let swings = zero_crossing_waves(motion).is_some()
        && zero_crossing_waves(wave).is_some_and(|waves| waves.count >= MIN_WAVES_FOR_RAO);
    let Some((step, parts)) = swings.then(|| segment_transforms(&[motion, wave], SEGMENTS)).flatten() else {
        return Vec::new();
    };
    let pairs = |j: usize| parts[0].iter().zip(&parts[1]).map(move |(x, a)| (x[j], a[j]));
    let lines = 1..parts[1].first().map_or(1, Vec::len);
    let density = |j: usize| pairs(j).map(|(_, a)| a.norm_sqr()).sum::<f64>();
    let faint = MIN_WAVE_DENSITY * lines.clone().map(density).fold(0.0, f64::max);
    let band = |j: usize| {
        let cross: Complex<f64> = pairs(j).map(|(x, a)| x * a.conj()).sum();
        let (of_motion, of_wave) = (pairs(j).map(|(x, _)| x.norm_sqr()).sum::<f64>(), density(j));
        let (answer, coherence) = (cross / of_wave, cross.norm_sqr() / (of_motion * of_wave));
        RaoPoint { frequency: j as f64 * step, ratio: answer.norm(), phase: answer.arg(), coherence }
    };
    lines.filter(|&j| density(j) >= faint).map(band).filter(|band| band.coherence.is_finite()).collect()
}

#[cfg(test)]
#[path = "../../tests/unit/analysis/rao.rs"]
mod tests;
