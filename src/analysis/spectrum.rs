//! Spectra by Welch's method: each is the mean of Hann-windowed periodograms of half-overlapping segments of a record.
//! @welch1967

use realfft::{RealFftPlanner, num_complex::Complex};

use super::{moments, waves_of_readings, zero_crossing_waves};
use crate::math::{readings::Readings, time_series::TimeSeries};

/// Smallest number of samples of a record.
const LEAST: usize = 16;

/// Smallest number of waves in a segment of a record, where the record is divided.
const WAVES_A_PART: usize = 16;

/// Number of quarters into which a long record is divided; together with the half-overlapping segments there are seven.
pub(super) const SEGMENTS: usize = 4;

/// Smallest number of waves in a series with a displayed spectrum: with fewer waves the frequency resolution is too
/// coarse.
const SHOWN_WAVES: usize = 8;

/// Share of the variance that a displayed spectrum contains, –; the highest frequencies are noise.
const DISPLAYED_VARIANCE: f64 = 0.999;

/// Complex amplitudes, from frequency 0 upwards.
pub(crate) type ComplexAmplitudes = Vec<Complex<f64>>;

/// A one-sided spectrum; its integral is the variance of the record.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct WelchSpectrum {
    /// Interval between frequencies, Hz; the first frequency is 0.
    pub frequency_step: f64,
    /// Spectral density, in the squared unit of the series per Hz.
    pub density: Vec<f64>,
}

impl WelchSpectrum {
    /// Returns the frequencies, Hz.
    pub(crate) fn frequencies(&self) -> impl Iterator<Item = f64> + '_ {
        (0..self.density.len()).map(|i| i as f64 * self.frequency_step)
    }

    /// Returns ∫ fⁿ S df from `from` to `until` (Hz).
    pub(crate) fn moment(&self, n: i32, from: f64, until: f64) -> f64 {
        let inside = self.frequencies().zip(&self.density).filter(|(f, _)| (from..=until).contains(f));
        inside.map(|(f, s)| f.powi(n) * s).sum::<f64>() * self.frequency_step
    }

    /// Returns the significant height H_m0 = 4 √m₀, in the unit of the series.
    pub(crate) fn significant_height(&self) -> f64 {
        4.0 * self.moment(0, 0.0, f64::INFINITY).sqrt()
    }

    /// Returns the peak frequency, Hz: the centroid of the highest line and two lines on either side. A Hann window
    /// spreads a harmonic component over these lines.
    pub(crate) fn peak_frequency(&self) -> f64 {
        let lines = 0..self.density.len();
        let top = lines.max_by(|a, b| self.density[*a].total_cmp(&self.density[*b])).unwrap_or(0);
        let near = || self.frequencies().zip(&self.density).take(top + 3).skip(top.saturating_sub(2));
        near().map(|(f, s)| f * s).sum::<f64>() / near().map(|(_, s)| s).sum::<f64>()
    }

    /// Returns the peak period T_p, s.
    pub(crate) fn peak_period(&self) -> f64 {
        1.0 / self.peak_frequency()
    }

    /// Returns the mean period T_m02 = √(m₀/m₂), s.
    pub(crate) fn mean_period(&self) -> f64 {
        (self.moment(0, 0.0, f64::INFINITY) / self.moment(2, 0.0, f64::INFINITY)).sqrt()
    }
}

/// Returns the spectrum of `series`, or `None` if the series is constant or has fewer than 16 samples.
///
/// The function takes evenly spaced samples of the smooth curve through the series, and subtracts their mean. It
/// divides a record of 64 waves or more into quarters, with further segments that overlap them by half. It uses a
/// shorter record as a single segment.
pub(crate) fn spectrum(series: &TimeSeries) -> Option<WelchSpectrum> {
    let of = moments(series);
    if of.min.0 == of.max.0 {
        return None;
    }
    let variance = of.standard_deviation.powi(2);
    let cut = zero_crossing_waves(series).is_some_and(|w| w.count >= SEGMENTS * WAVES_A_PART);
    let (step, parts) = segment_transforms(&[series], if cut { SEGMENTS } else { 1 })?;
    let count = parts[0].first()?.len();
    let mut density = vec![0.0; count];
    for part in &parts[0] {
        density.iter_mut().zip(part).for_each(|(s, a)| *s += a.norm_sqr());
    }
    let sum = density.iter().sum::<f64>() * step;
    if !(sum > 0.0 && variance > 0.0) {
        return None;
    }
    density.iter_mut().for_each(|s| *s *= variance / sum);
    Some(WelchSpectrum { frequency_step: step, density })
}

/// Returns the displayed spectrum of `readings`, up to the frequency below which 99.9 % of the variance lies, or `None`
/// if they have fewer than eight waves or if gaps hide waves.
pub(crate) fn displayed_spectrum(readings: &Readings) -> Option<WelchSpectrum> {
    waves_of_readings(readings).filter(|waves| waves.count >= SHOWN_WAVES)?;
    let mut all = spectrum(readings.series())?;
    let whole: f64 = all.density.iter().sum();
    let mut sum = 0.0;
    let below = all.density.iter().take_while(|s| {
        sum += **s;
        sum - **s < DISPLAYED_VARIANCE * whole
    });
    let rows = below.count();
    all.density.truncate(rows);
    Some(all)
}

/// Returns the interval (Hz) between the common frequencies of several series, and the complex amplitudes of each
/// series. The amplitude of cos(2πft + phase) is `amplitude · e^{i phase}`, except for a factor common to all series.
/// Returns `None` if a series has fewer than 16 samples, or the series have no time in common.
pub(crate) fn complex_amplitudes(series: &[&TimeSeries]) -> Option<(f64, Vec<ComplexAmplitudes>)> {
    let (step, parts) = segment_transforms(series, 1)?;
    Some((step, parts.into_iter().map(|mut of| of.swap_remove(0)).collect()))
}

/// Returns the interval between frequencies (Hz), and for each series the transforms of its windowed segments. The time
/// that all series cover is divided into `cut` equal segments. One more is centred on each inner boundary.
pub(super) fn segment_transforms(series: &[&TimeSeries], cut: usize) -> Option<(f64, Vec<Vec<ComplexAmplitudes>>)> {
    let spans = series.iter().map(|s| s.span());
    let (from, until) = spans.fold((f64::NEG_INFINITY, f64::INFINITY), |(a, b), (x, y)| (a.max(x), b.min(y)));
    let count = series.iter().map(|s| s.times().len()).min()?;
    if count < LEAST || until <= from {
        return None;
    }
    let dt = (until - from) / (count - 1) as f64;
    let length = (count / cut) & !1;
    let mut planner = RealFftPlanner::<f64>::new();
    let plan = planner.plan_fft_forward(length);
    let hann = |i: usize| 0.5 - 0.5 * (std::f64::consts::TAU * i as f64 / length as f64).cos();
    let mut all = Vec::new();
    for series in series {
        let samples: Vec<f64> = (0..count).map(|i| series.value_and_rate(from + i as f64 * dt).0).collect();
        let mean = samples.iter().sum::<f64>() / count as f64;
        let mut parts = Vec::new();
        for start in (0..=count - length).step_by(length / 2) {
            let mut part: Vec<f64> = (0..length).map(|i| hann(i) * (samples[start + i] - mean)).collect();
            let mut found = plan.make_output_vec();
            plan.process(&mut part, &mut found).ok()?;
            parts.push(found);
        }
        all.push(parts);
    }
    Some((1.0 / (length as f64 * dt), all))
}

#[cfg(test)]
#[path = "../../tests/unit/analysis/spectrum.rs"]
mod tests;
