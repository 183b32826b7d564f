//! Spectra by Welch's method: means of Hann-windowed periodograms of half-overlapping parts of a record. @welch1967

use realfft::{RealFftPlanner, num_complex::Complex};

use super::{moments, zero_crossing_waves};
use crate::math::time_series::TimeSeries;

/// Fewest samples of a record.
const LEAST: usize = 16;

/// Waves that a part of a record holds at least, where the record is cut at all.
const WAVES_A_PART: usize = 16;

/// Into how many quarters a long record is cut; with those that lie half over two there are seven.
pub(super) const SEGMENTS: usize = 4;

/// Waves that a series has at least whose spectrum is shown: fewer lines than that a wave's width are no spectrum.
const SHOWN_WAVES: usize = 8;

/// How much of a spectrum's variance is shown, –; what is faster is noise.
const DISPLAYED_VARIANCE: f64 = 0.999;

/// Complex amplitudes, from frequency 0 up.
pub(crate) type ComplexAmplitudes = Vec<Complex<f64>>;

/// A one-sided spectrum, its integral the variance of the record.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct WelchSpectrum {
    /// From one frequency to the next, Hz; the first is 0.
    pub frequency_step: f64,
    /// Density, in the squared unit of the series a Hz.
    pub density: Vec<f64>,
}

impl WelchSpectrum {
    /// Frequencies, Hz.
    pub(crate) fn frequencies(&self) -> impl Iterator<Item = f64> + '_ {
        (0..self.density.len()).map(|i| i as f64 * self.frequency_step)
    }

    /// ∫ fⁿ S df from `from` to `until` (Hz).
    pub(crate) fn moment(&self, n: i32, from: f64, until: f64) -> f64 {
        let inside = self.frequencies().zip(&self.density).filter(|(f, _)| (from..=until).contains(f));
        inside.map(|(f, s)| f.powi(n) * s).sum::<f64>() * self.frequency_step
    }

    /// Significant height H_m0 = 4 √m₀, in the unit of the series.
    pub(crate) fn significant_height(&self) -> f64 {
        4.0 * self.moment(0, 0.0, f64::INFINITY).sqrt()
    }

    /// Peak frequency, Hz: the centroid of the highest line and two on either side, over which a Hann window spreads what
    /// swings with one period.
    pub(crate) fn peak_frequency(&self) -> f64 {
        let lines = 0..self.density.len();
        let top = lines.max_by(|a, b| self.density[*a].total_cmp(&self.density[*b])).unwrap_or(0);
        let near = || self.frequencies().zip(&self.density).take(top + 3).skip(top.saturating_sub(2));
        near().map(|(f, s)| f * s).sum::<f64>() / near().map(|(_, s)| s).sum::<f64>()
    }

    /// Peak period T_p, s.
    pub(crate) fn peak_period(&self) -> f64 {
        1.0 / self.peak_frequency()
    }

    /// Mean period T_m02 = √(m₀/m₂), s.
    pub(crate) fn mean_period(&self) -> f64 {
        (self.moment(0, 0.0, f64::INFINITY) / self.moment(2, 0.0, f64::INFINITY)).sqrt()
    }
}

/// The spectrum of `series`; none if it is constant or has fewer than 16 samples.
///
/// Samples are taken evenly from the smooth curve through the series, less their mean. A record of 64 waves or more is cut
/// into quarters that overlap by half; a shorter one is taken whole.
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

/// The spectrum of `series` as it is shown: of eight waves or more, up to the frequency below which 99.9 % of the variance lies.
pub(crate) fn displayed_spectrum(series: &TimeSeries) -> Option<WelchSpectrum> {
    zero_crossing_waves(series).filter(|waves| waves.count >= SHOWN_WAVES)?;
    let mut all = spectrum(series)?;
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

/// Amplitudes of several series at common frequencies: from one frequency to the next (Hz), and for each series
/// its amplitudes of cos(2πft + phase) as `amplitude · e^{i phase}`, but for a factor common to all. None as for [`spectrum`].
pub(crate) fn complex_amplitudes(series: &[&TimeSeries]) -> Option<(f64, Vec<ComplexAmplitudes>)> {
    let (step, parts) = segment_transforms(series, 1)?;
    Some((step, parts.into_iter().map(|mut of| of.swap_remove(0)).collect()))
}

/// From one frequency to the next (Hz), and for each series the transforms of its windowed parts, over the time that all
/// cover: `cut` into so many, and those that lie half over two.
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
