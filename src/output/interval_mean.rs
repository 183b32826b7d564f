//! Time means, from one row of a table to the next, of values that are read at every step.

use serde::{Deserialize, Serialize};

/// An unfinished mean, with all data that a restart needs to continue bit for bit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct IntervalMean {
    /// Time (s) and values of the last reading.
    last: Option<(f64, Vec<f64>)>,
    /// ∫ x dt since the last row by the trapezoidal rule, and the time (s) for which x was finite: one pair for each
    /// column.
    sums: Vec<(f64, f64)>,
}

impl IntervalMean {
    /// Returns the time (s) and the values of the last reading, or `None` before the first reading.
    pub(crate) fn last(&self) -> Option<(f64, &[f64])> {
        self.last.as_ref().map(|(t, row)| (*t, row.as_slice()))
    }

    /// Adds the reading `row` at time `t` (s), which is later than the last reading.
    pub(crate) fn add(&mut self, t: f64, row: Vec<f64>) {
        self.sums.resize(row.len(), (0.0, 0.0));
        if let Some((before, old)) = &self.last {
            for ((sum, known), (a, b)) in self.sums.iter_mut().zip(old.iter().zip(&row)) {
                if a.is_finite() && b.is_finite() {
                    *sum += 0.5 * (t - before) * (a + b);
                    *known += t - before;
                }
            }
        }
        self.last = Some((t, row));
    }

    /// Returns the means since the last row, and begins the next interval. For columns that are no means by `are_means`, and for
    /// columns without an interval of finite values, it returns the last reading.
    pub(crate) fn take(&mut self, are_means: &[bool]) -> Vec<f64> {
        let row = self.last.as_ref().map_or(&[][..], |(_, row)| row);
        let of = |((x, (sum, known)), is_mean): ((&f64, &(f64, f64)), &bool)| {
            if *is_mean && *known > 0.0 { sum / known } else { *x }
        };
        let taken = row.iter().zip(&self.sums).zip(are_means).map(of).collect();
        self.sums.fill((0.0, 0.0));
        taken
    }
}

#[cfg(test)]
#[path = "../../tests/unit/output/interval_mean.rs"]
mod tests;
