//! Readings of a probe: a series with the time for which each reading counts in a mean, and its gaps.

use super::time_series::TimeSeries;

/// The readings in one column of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Readings {
    /// The readings that exist.
    series: TimeSeries,
    /// Time for which each reading counts in a mean, s; `None` if the trapezoidal rule over the series gives it.
    weights: Option<Vec<f64>>,
    missing_share: f64,
    longest_gap: f64,
}

/// Returns the time to which each reading of a table with rows at `times` (s) belongs, s: the middle of the interval since the
/// previous row if the readings `are_means` over it.
pub(crate) fn reading_times(times: &[f64], are_means: bool) -> Vec<f64> {
    let middle = |i: usize| if are_means && i > 0 { 0.5 * (times[i - 1] + times[i]) } else { times[i] };
    (0..times.len()).map(middle).collect()
}

impl Readings {
    /// Returns the finite readings in `values`, of a table with rows at `times` (s), from `from` to `until` (s). If the readings
    /// `are_means` since the previous row, each belongs to the middle of its interval. Returns `None` if there are fewer than two
    /// readings.
    pub fn new(times: &[f64], values: &[f64], are_means: bool, [from, until]: [f64; 2]) -> Option<Self> {
        let at = reading_times(times, are_means);
        let rows: Vec<usize> = (0..at.len()).filter(|&i| (from..=until).contains(&at[i])).collect();
        let has_reading = |i: &&usize| values[**i].is_finite();
        let first = rows.iter().position(|i| has_reading(&i))?;
        let last = rows.iter().rposition(|i| has_reading(&i))?;
        let rows = &rows[first..=last];
        let known: Vec<usize> = rows.iter().filter(has_reading).copied().collect();
        let series = TimeSeries::new(
            known.iter().map(|&i| at[i]).collect::<Vec<_>>(),
            known.iter().map(|&i| values[i]).collect::<Vec<_>>(),
        )
        .ok()?;
        let missing = rows.len() - known.len();
        let around = |i: usize| [rows[0].max(i.saturating_sub(1)), rows[rows.len() - 1].min(i + 1)];
        let weight = |i: usize| match are_means {
            true => times[i] - times[i.saturating_sub(1)],
            false => 0.5 * (at[around(i)[1]] - at[around(i)[0]]),
        };
        let gaps = known.windows(2).filter(|pair| pair[1] > pair[0] + 1).map(|pair| at[pair[1]] - at[pair[0]]);
        Some(Self {
            weights: (are_means || missing > 0).then(|| known.iter().map(|&i| weight(i)).collect()),
            missing_share: missing as f64 / rows.len() as f64,
            longest_gap: gaps.fold(0.0, f64::max),
            series,
        })
    }

    /// Returns the readings that exist, linear across gaps.
    pub fn series(&self) -> &TimeSeries {
        &self.series
    }

    /// Returns the time (s) for which each reading counts in a mean, or `None` if the trapezoidal rule over the series gives it.
    /// Gaps do not count, nor does a first reading of means, which has no interval.
    pub(crate) fn weights(&self) -> Option<&[f64]> {
        self.weights.as_deref()
    }

    /// Returns the share of the rows between the first and the last reading that have none, –.
    pub fn missing_share(&self) -> f64 {
        self.missing_share
    }

    /// Returns the longest time between successive readings with an empty row between them, s; 0 if no reading is missing.
    pub fn longest_gap(&self) -> f64 {
        self.longest_gap
    }
}

#[cfg(test)]
#[path = "../../tests/unit/math/readings.rs"]
mod tests;
