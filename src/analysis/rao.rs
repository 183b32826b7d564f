//! Response of a motion to a wave: the response amplitude operator, RAO = X/A at a frequency.

use std::f64::consts::TAU;

use realfft::num_complex::Complex;

use super::{
    complex_amplitudes, harmonic, spectrum,
    spectrum::{SEGMENTS, segment_transforms},
    zero_crossing_waves,
};
use crate::math::time_series::TimeSeries;

/// Half width of the frequency range about the peak of the waves, relative to the peak frequency.
const PEAK_HALF_WIDTH: f64 = 0.1;

/// Smallest number of waves in a record with an RAO over frequency: eight in each quarter.
pub(crate) const MIN_WAVES_FOR_RAO: usize = 8 * SEGMENTS;

/// Smallest spectral density of the waves at a frequency with an RAO, relative to the density at their peak, –.
const MIN_WAVE_DENSITY: f64 = 0.02;

/// A response amplitude operator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rao {
    /// Amplitude of the motion over that of the wave, in the units of both.
    pub ratio: f64,
    /// Phase of the motion less that of the wave, rad, −π to π: positive if the motion is ahead.
    pub phase: f64,
    /// Period of the response, s.
    pub period: f64,
}

/// Returns the RAO of `motion` to `wave`. With a `period` (s), the function fits the harmonics of both series. Without
/// a period, it divides the cross spectrum by the wave spectrum within a tenth of the peak frequency on both sides of
/// the peak. Returns `None` if the wave has no such component, or the series are too short.
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

/// An RAO at one frequency of irregular waves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RaoPoint {
    /// Frequency, Hz.
    pub frequency: f64,
    /// Amplitude of the motion over that of the wave, in the units of both.
    pub ratio: f64,
    /// Phase of the motion less that of the wave, rad, −π to π: positive if the motion is ahead.
    pub phase: f64,
    /// Coherence γ², 0 to 1: the share of the motion's variance at this frequency that is linearly related to the wave.
    pub coherence: f64,
}

/// Returns the RAO of `motion` to the irregular `wave` over frequency:
///
///   H₁ = S_ax/S_aa,   γ² = |S_ax|²/(S_aa S_xx)
///
/// The spectra are means over seven segments: quarters of the record, and the segments that overlap them by half
/// (@bendat2010, @welch1967). The list contains only frequencies at which the waves have at least a fiftieth of their
/// peak density. The list is empty if there are fewer than 32 waves or the motion is zero.
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
