//! Individual waves of a series, each between two successive upward crossings of the mean. @goda2010, ch. 10.

use super::moments;
use crate::math::{readings::Readings, time_series::TimeSeries};

/// Smallest excursion of a wave to both sides of the mean, relative to the standard deviation: smaller oscillations do
/// not count as waves.
const BAND: f64 = 0.1;

/// Smallest range of a series with waves, relative to its largest magnitude and in its unit: a smaller range is
/// round-off.
const ROUND_OFF: [f64; 2] = [1e-9, 1e-12];

/// Largest gap between readings of waves, in mean periods. A straight line over a gap of this length lowers a crest by
/// 1 − cos(π/10) of the amplitude, 5 %.
pub(crate) const LARGEST_GAP: f64 = 0.1;

/// Statistics of the waves of a series. Heights are from trough to crest, in the unit of the series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ZeroCrossingWaves {
    /// Number of waves.
    pub count: usize,
    /// Mean height of the waves.
    pub mean_height: f64,
    /// Mean height of the highest third of the waves, H₁/₃: the significant height.
    pub significant_height: f64,
    /// Height of the highest wave.
    pub max_height: f64,
    /// Mean period T_z, s.
    pub mean_period: f64,
    /// Mean period of the highest third of the waves, T₁/₃, s.
    pub significant_period: f64,
}

/// Returns the zero-crossing waves of `series`, or `None` if it has fewer than two waves. The function interpolates
/// crossings linearly between samples. A wave exceeds a tenth of the standard deviation on both sides of the mean. A
/// series has no waves if its range is round-off: below 1e-9 of its largest magnitude, or below 1e-12 in its unit.
pub(crate) fn zero_crossing_waves(series: &TimeSeries) -> Option<ZeroCrossingWaves> {
    let of = moments(series);
    let (least, largest) = (of.min.0, of.max.0);
    if largest - least < (ROUND_OFF[0] * largest.abs().max(least.abs())).max(ROUND_OFF[1]) {
        return None;
    }
    let (t, x) = (series.times(), series.values());
    let band = BAND * of.standard_deviation;
    let (mut below, mut crossing, mut ups) = (false, None, Vec::new());
    for i in 1..t.len() {
        let (a, b) = (x[i - 1] - of.mean, x[i] - of.mean);
        below |= a < -band;
        if a < 0.0 && b >= 0.0 {
            crossing = Some((t[i - 1] + (t[i] - t[i - 1]) * a / (a - b), i));
        }
        if below && b > band {
            ups.extend(crossing.take());
            below = false;
        }
    }
    // Height and period of each wave.
    let mut all: Vec<(f64, f64)> = ups
        .windows(2)
        .map(|w| {
            let wave = &x[w[0].1..w[1].1];
            let (least, largest) =
                wave.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &x| (l.min(x), h.max(x)));
            (largest - least, w[1].0 - w[0].0)
        })
        .collect();
    if all.len() < 2 {
        return None;
    }
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mean =
        |waves: &[(f64, f64)], of: fn(&(f64, f64)) -> f64| waves.iter().map(of).sum::<f64>() / waves.len() as f64;
    // The highest third is a third of the number of waves, rounded to the nearest integer: one of two waves.
    let highest = &all[..(all.len() + 1) / 3];
    Some(ZeroCrossingWaves {
        count: all.len(),
        mean_height: mean(&all, |w| w.0),
        significant_height: mean(highest, |w| w.0),
        max_height: all[0].0,
        mean_period: mean(&all, |w| w.1),
        significant_period: mean(highest, |w| w.1),
    })
}

/// Returns the zero-crossing waves of `readings`, or `None` if they have fewer than two waves or if gaps hide waves.
pub(crate) fn waves_of_readings(readings: &Readings) -> Option<ZeroCrossingWaves> {
    zero_crossing_waves(readings.series()).filter(|_| !gaps_hide_waves(readings))
}

/// Returns whether `readings` have waves and a gap longer than a tenth of their mean period. Waves and spectra are then unknown.
pub(crate) fn gaps_hide_waves(readings: &Readings) -> bool {
    let gap = readings.longest_gap();
    gap > 0.0 && zero_crossing_waves(readings.series()).is_some_and(|waves| gap > LARGEST_GAP * waves.mean_period)
}

#[cfg(test)]
#[path = "../../tests/unit/analysis/zero_crossings.rs"]
mod tests;
