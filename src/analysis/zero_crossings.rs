//! Waves of a series, one by one: from one crossing of the mean upwards to the next. @goda2010, ch. 10.

use super::moments;
use crate::math::time_series::TimeSeries;

/// How far a wave must go to both sides of the mean to be one, over the standard deviation: what trembles about the mean
/// is none.
const BAND: f64 = 0.1;

/// Least range of a series that has waves, over its largest magnitude and in its unit: below, it is round-off.
const ROUND_OFF: [f64; 2] = [1e-9, 1e-12];

/// Waves of a series. Heights are from trough to crest, in the unit of the series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ZeroCrossingWaves {
    /// How many.
    pub count: usize,
    /// Mean height.
    pub mean_height: f64,
    /// Mean height of the highest third, H₁/₃: the significant height.
    pub significant_height: f64,
    /// Height of the highest.
    pub max_height: f64,
    /// Mean period T_z, s.
    pub mean_period: f64,
    /// Mean period of the highest third, T₁/₃, s.
    pub significant_period: f64,
}

/// The waves of `series`; none if there are fewer than two. Crossings are linear between samples; a wave goes a tenth of
/// the standard deviation to both sides of the mean. Round-off has none: a range below 1e-9 of the largest magnitude, or below
/// 1e-12 in the unit of the series.
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
    // Height and period of each.
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
    // A third to the nearest whole number, of two waves one.
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

#[cfg(test)]
#[path = "../../tests/unit/analysis/zero_crossings.rs"]
mod tests;
