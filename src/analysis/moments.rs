//! Extremes, mean and standard deviation of a series.

use crate::math::{readings::Readings, time_series::TimeSeries};

/// Statistics of a series.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Moments {
    /// Least value and its time, s.
    pub min: (f64, f64),
    /// Largest value and its time, s.
    pub max: (f64, f64),
    /// Mean over time.
    pub mean: f64,
    /// Standard deviation over time.
    pub standard_deviation: f64,
    /// Last value.
    pub last: f64,
}

/// Returns the statistics of `series`:
///
///   x̄ = 1/T ∫ x dt,   σ² = 1/T ∫ (x − x̄)² dt
///
/// The function integrates by the trapezoidal rule over the samples; results are in the unit of the series.
pub(crate) fn moments(series: &TimeSeries) -> Moments {
    weighted_moments(series, None)
}

/// As [`moments`], of readings. Gaps do not count in means, and a reading that is a mean counts for its interval.
pub(crate) fn moments_of_readings(readings: &Readings) -> Moments {
    weighted_moments(readings.series(), readings.weights())
}

fn weighted_moments(series: &TimeSeries, weights: Option<&[f64]>) -> Moments {
    let (t, x) = (series.times(), series.values());
    let (first, last) = series.span();
    let mean_of = |f: &dyn Fn(f64) -> f64| {
        if let Some(weights) = weights {
            return weights.iter().zip(x).map(|(w, &x)| w * f(x)).sum::<f64>() / weights.iter().sum::<f64>();
        }
        let parts = t.windows(2).zip(x.windows(2)).map(|(t, x)| 0.5 * (f(x[0]) + f(x[1])) * (t[1] - t[0]));
        parts.sum::<f64>() / (last - first)
    };
    let mean = mean_of(&|x| x);
    let mut of = Moments {
        min: (f64::INFINITY, first),
        max: (f64::NEG_INFINITY, first),
        mean,
        standard_deviation: mean_of(&|x| (x - mean).powi(2)).sqrt(),
        last: x[x.len() - 1],
    };
    for (&t, &x) in t.iter().zip(x) {
        if x < of.min.0 {
            of.min = (x, t);
        }
        if x > of.max.0 {
            of.max = (x, t);
        }
    }
    of
}

#[cfg(test)]
#[path = "../../tests/unit/analysis/moments.rs"]
mod tests;
