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
pub struct ZeroCrossingWaves {
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
pub fn zero_crossing_waves(series: &TimeSeries) -> Option<ZeroCrossingWaves> {
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
mod tests {
    use super::*;
    use crate::error::Result;
    use std::f64::consts::TAU;

    fn sampled(f: impl Fn(f64) -> f64, until: f64) -> Result<TimeSeries> {
        let t: Vec<f64> = (0..=(until * 100.0) as usize).map(|i| i as f64 * 0.01).collect();
        let x: Vec<f64> = t.iter().map(|&t| f(t)).collect();
        TimeSeries::new(t, x)
    }

    #[test]
    fn a_sine_has_its_period_and_twice_its_amplitude() -> Result<()> {
        let found = zero_crossing_waves(&sampled(|t| 0.5 + 0.1 * (TAU * t / 1.25).sin(), 10.0)?);
        let Some(found) = found else { panic!("a sine has waves") };
        // The crossings are linear between samples 0.01 s apart, the crests up to half of that off.
        assert_eq!(found.count, 6, "8 periods: the first begins with the record, the last does not come up again");
        for (what, x, exact) in [
            ("T_z", found.mean_period, 1.25),
            ("T third", found.significant_period, 1.25),
            ("H mean", found.mean_height, 0.2),
            ("H third", found.significant_height, 0.2),
            ("H max", found.max_height, 0.2),
        ] {
            assert!((x - exact).abs() < 1e-4, "{what}: {x}");
        }
        Ok(())
    }

    #[test]
    fn the_significant_height_is_the_mean_of_the_highest_third() -> Result<()> {
        // Groups of three waves of heights 1, 2 and 3, each a whole sine.
        let height = |t: f64| 1.0 + (t.floor() as i64).rem_euclid(3) as f64;
        let found = zero_crossing_waves(&sampled(|t| 0.5 * height(t) * (TAU * t).sin(), 30.0)?);
        let Some(found) = found else { panic!("it has waves") };
        assert!((found.significant_height - 3.0).abs() < 1e-2 && (found.max_height - 3.0).abs() < 1e-2, "{found:?}");
        // The first wave begins with the record and is none, nor is the last: 28 of 30, of which nine are 3 high.
        assert!((found.mean_height - 2.0).abs() < 0.05, "{found:?}");
        Ok(())
    }

    #[test]
    fn round_off_has_no_waves() -> Result<()> {
        let sine = |mean: f64, size: f64| sampled(move |t| mean + size * (TAU * t / 1.25).sin(), 10.0);
        for (mean, size) in [(0.0, 5e-15), (0.0, 1e-17), (1e5, 1e-5), (3.0, 1e-13)] {
            assert_eq!(zero_crossing_waves(&sine(mean, size)?), None, "{mean} ± {size}");
        }
        for (mean, size) in [(0.0, 1e-11), (1e5, 1e-3)] {
            assert!(zero_crossing_waves(&sine(mean, size)?).is_some(), "{mean} ± {size}");
        }
        Ok(())
    }

    #[test]
    fn a_series_that_trembles_has_no_waves() -> Result<()> {
        assert_eq!(zero_crossing_waves(&sampled(|t| t + 0.1 * (t * 2.0).sin(), 100.0)?), None);
        Ok(())
    }
}
