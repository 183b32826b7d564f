//! Response to a regular wave: the fundamental of a motion relative to that of the wave. Each fundamental has its own period, and
//! the fit also contains a mean and a drift.

use std::f64::consts::TAU;

use super::{
    AlignedMetrics, ErrorMetrics,
    alignment::least_by_golden_section,
    harmonic::{Harmonic, LeastSquares, MIN_PERIODS},
};
use crate::{math::time_series::TimeSeries, plan::ResponseReference};

/// Range of the fitted period about the stated period, relative to this: a body that drifts with a fifth of the wave's speed
/// meets a period 25 % longer.
const RANGE: f64 = 0.25;

/// Number of frequencies that the search tries in this range before it refines the best one.
const TRIED: u32 = 100;

/// The fundamental of a series: x(t) ≈ mean + drift · (t − middle) + amplitude · cos(2π (t − middle)/period + phase).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fundamental {
    /// Middle of the fitted time range, s.
    middle: f64,
    /// Mean, in the unit of the series.
    mean: f64,
    /// Drift, in the unit of the series over s.
    drift: f64,
    /// Amplitude, in the unit of the series.
    pub(super) amplitude: f64,
    /// Phase in the middle, rad.
    phase: f64,
    /// Period, s.
    pub(super) period: f64,
    /// Sum of the squared deviations.
    remainder: f64,
}

/// A response of a run and its comparison with the reference.
pub(super) struct Response {
    /// The fundamental of the motion.
    motion: Fundamental,
    /// Amplitude that the reference gives to the motion, in its unit.
    expected_amplitude: f64,
    /// Lag of the run less that of the reference, in periods, −½ to ½; `None` if the reference has no lag.
    late: Option<f64>,
    /// Period of the motion over that of the reference, –.
    period_ratio: f64,
}

/// Returns the fundamental of `series` with a period near `period` (s), by least squares. Returns `None` if the series
/// has less than two periods, or does not swing.
pub(super) fn fundamental(series: &TimeSeries, period: f64) -> Option<Fundamental> {
    let (first, last) = series.span();
    if last - first < MIN_PERIODS * period {
        return None;
    }
    let fit = |frequency: f64| fit_at(series, frequency);
    let remainder = |frequency: f64| fit(frequency).map_or(f64::INFINITY, |fit| fit.remainder);
    let (low, high) = (1.0 / (period * (1.0 + RANGE)), (1.0 + RANGE) / period);
    let step = (high - low) / f64::from(TRIED);
    let tried = (0..=TRIED).map(|i| low + f64::from(i) * step);
    let best = tried.min_by(|a, b| remainder(*a).total_cmp(&remainder(*b)))?;
    let around = [(best - step).max(low), (best + step).min(high)];
    fit(least_by_golden_section(around, 1e-9 * best, remainder)).filter(|fit| fit.amplitude > 0.0)
}

/// Returns the fit of `series` with this `frequency` (Hz).
fn fit_at(series: &TimeSeries, frequency: f64) -> Option<Fundamental> {
    let (first, last) = series.span();
    let fit = LeastSquares::new(series, TAU * frequency, 0.5 * (first + last), true)?;
    let samples = series.times().iter().zip(series.values());
    let remainder: f64 = samples.map(|(&t, x)| (x - fit.value(t)).powi(2)).sum();
    let Harmonic { mean, amplitude, phase } = fit.harmonic();
    let (middle, drift, period) = (fit.middle, fit.drift(), 1.0 / frequency);
    remainder.is_finite().then_some(Fundamental { middle, mean, drift, amplitude, phase, period, remainder })
}

impl Fundamental {
    /// Returns its phase at the time `t` (s), rad.
    fn phase_at(&self, t: f64) -> f64 {
        self.phase + TAU * (t - self.middle) / self.period
    }

    /// Returns its value at the time `t` (s), with another `amplitude` and a delay by `late` periods.
    fn value(&self, t: f64, amplitude: f64, late: f64) -> f64 {
        self.mean + self.drift * (t - self.middle) + amplitude * (self.phase_at(t) - TAU * late).cos()
    }
}

impl Response {
    /// Returns the response of `motion` to `wave`, both within the times that count, or `None` if one has no
    /// fundamental.
    pub(super) fn new(motion: &TimeSeries, wave: &TimeSeries, reference: &ResponseReference) -> Option<Self> {
        let motion = fundamental(motion, reference.period)?;
        let wave = fundamental(wave, reference.period)?;
        let lag = (wave.phase_at(motion.middle) - motion.phase) / TAU;
        let late = reference.lag.map(|expected| lag - expected).map(|late| late - late.round());
        let expected_amplitude = reference.ratio * wave.amplitude;
        Some(Self { motion, expected_amplitude, late, period_ratio: motion.period / reference.period })
    }

    /// Returns the amplitude of the run over that of the reference.
    fn amplitude_ratio(&self) -> f64 {
        self.motion.amplitude / self.expected_amplitude
    }

    /// Returns N and M of the two fundamentals, N from the deviation of the complex amplitudes, and the relative error
    /// of the period.
    pub(super) fn metrics(&self) -> ErrorMetrics {
        let m = self.amplitude_ratio();
        // |m e^{iφ} − 1|² = (m − 1)² + 2 m (1 − cos φ)
        let turned = self.late.map_or(0.0, |late| 2.0 * m * (1.0 - (TAU * late).cos()));
        ErrorMetrics {
            relative_l2: Some(((m - 1.0).powi(2) + turned).sqrt()),
            amplitude_ratio: Some(m),
            period: Some((self.period_ratio - 1.0).abs()),
            ..ErrorMetrics::default()
        }
    }

    /// Returns the delay and the figures without it, if the reference has a lag.
    pub(super) fn aligned(&self) -> Option<AlignedMetrics> {
        let m = self.amplitude_ratio();
        let delay = self.late? * self.motion.period;
        Some(AlignedMetrics { delay, relative_l2: (m - 1.0).abs(), amplitude_ratio: m })
    }

    /// Returns the motion that the reference gives at `times`, with the mean, the drift and the period of the run. If the
    /// reference has no lag, the phase is also that of the run.
    pub(super) fn expected(&self, times: &[f64]) -> Vec<f64> {
        let late = -self.late.unwrap_or(0.0);
        times.iter().map(|t| self.motion.value(*t, self.expected_amplitude, late)).collect()
    }
}

#[cfg(test)]
#[path = "../../tests/unit/analysis/response.rs"]
mod tests;
