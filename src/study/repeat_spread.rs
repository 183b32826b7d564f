//! Computes the spread of the repeats of a run, which is the random part of an error.

use serde::Serialize;

use super::{
    ResultRow,
    result_rows::{MAX_ABS_METRIC, Metric},
};
use crate::analysis::format_verdicts;

/// The metrics for which the program reports a spread.
const SPREAD_METRICS: [Metric; 5] = [
    ("N", |r| r.metrics.relative_l2),
    ("M", |r| r.metrics.amplitude_ratio),
    ("peak", |r| r.metrics.peak),
    ("aligned N", |r| r.aligned_relative_l2),
    MAX_ABS_METRIC,
];

/// The statistics of a metric over all finished repeats of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// The number of repeats.
    pub runs: usize,
    /// The mean of the metric over the repeats.
    pub mean: f64,
    /// The sample standard deviation of the repeats (n − 1), or `None` for a single repeat.
    pub deviation: Option<f64>,
    /// The smallest value.
    pub least: f64,
    /// The largest value.
    pub greatest: f64,
}

/// The spread of a metric over the repeats of a run, for one check.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RepeatSpread {
    /// The name of the run.
    pub run: String,
    /// The compared series, as `probe.column`.
    pub check: String,
    /// The name of the metric.
    pub figure: &'static str,
    /// The spread of the repeats.
    #[serde(flatten)]
    pub spread: Spread,
}

impl Spread {
    /// Returns the spread of `values`, or `None` without values.
    ///
    /// ```
    /// # use pontoon::study::Spread;
    /// let spread = Spread::of([0.1, 0.2, 0.3]).unwrap();
    /// assert!((spread.mean - 0.2).abs() < 1e-15 && (spread.deviation.unwrap() - 0.1).abs() < 1e-15);
    /// assert_eq!((spread.runs, spread.least, spread.greatest), (3, 0.1, 0.3));
    /// ```
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let all: Vec<f64> = values.into_iter().collect();
        let runs = all.len();
        let mean = all.iter().sum::<f64>() / runs as f64;
        let squares: f64 = all.iter().map(|x| (x - mean) * (x - mean)).sum();
        (runs > 0).then(|| Self {
            runs,
            mean,
            deviation: (runs > 1).then(|| (squares / (runs - 1) as f64).sqrt()),
            least: all.iter().copied().fold(f64::INFINITY, f64::min),
            greatest: all.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        })
    }

    /// Returns the spread as text: mean ± deviation (least to greatest), with numbers in the format of `number`.
    pub fn format(&self, number: fn(Option<f64>) -> String) -> String {
        let [mean, least, greatest] = [self.mean, self.least, self.greatest].map(|x| number(Some(x)));
        let deviation = match self.deviation {
            None => return mean,
            // The deviation is too small for the digits of the mean.
            Some(x) if x > 0.0 && x < 1e-3 * self.mean.abs() => format!("{x:.0e}"),
            x => number(x),
        };
        let ends = if least == greatest { String::new() } else { format!(" ({least} to {greatest})") };
        format!("{mean} ± {deviation}{ends}")
    }
}

/// Returns the finished rows, grouped by run and check so that repeats form one group. The groups are in the order of
/// `rows`.
pub fn group_repeats(rows: &[ResultRow]) -> Vec<Vec<&ResultRow>> {
    let mut all: Vec<Vec<&ResultRow>> = Vec::new();
    for row in rows.iter().filter(|row| row.status == "finished") {
        match all.iter_mut().find(|of| of[0].run == row.run && of[0].check == row.check) {
            Some(of) => of.push(row),
            None => all.push(vec![row]),
        }
    }
    all
}

/// Returns the spread of a metric over the rows `of` one run and check, or `None` if no row has a value of the metric.
pub fn spread_of(of: &[&ResultRow], figure: fn(&ResultRow) -> Option<f64>) -> Option<Spread> {
    Spread::of(of.iter().filter_map(|row| figure(row)))
}

/// Returns the spread of each metric over the repeats of each run, or an empty list if no run has repeats.
pub fn repeat_spreads(rows: &[ResultRow]) -> Vec<RepeatSpread> {
    let figure = |of: &[&ResultRow], (figure, value): Metric| {
        Some(RepeatSpread { run: of[0].run.clone(), check: of[0].check.clone(), figure, spread: spread_of(of, value)? })
    };
    let repeated = group_repeats(rows).into_iter().filter(|of| of.len() > 1);
    repeated.flat_map(|of| SPREAD_METRICS.into_iter().filter_map(move |metric| figure(&of, metric))).collect()
}

/// Returns whether any run has repeats.
pub fn has_repeats(rows: &[ResultRow]) -> bool {
    rows.iter().any(|row| row.repeat > 1)
}

/// A point of a plot of error over processor time, from all runs with one name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CostPoint {
    /// The mean processor time, s, and the mean error.
    pub place: (f64, f64),
    /// The smallest and the largest error.
    pub span: (f64, f64),
    /// The particle spacing, m.
    pub dp: f64,
}

impl CostPoint {
    /// Returns the point of the rows `of` one run and check, or `None` if the rows have no error or no processor time.
    pub fn new(of: &[&ResultRow], error: fn(&ResultRow) -> Option<f64>) -> Option<Self> {
        let (cost, error) = (spread_of(of, |row| row.cpu_s)?.mean, spread_of(of, error)?);
        Some(Self { place: (cost, error.mean), span: (error.least, error.greatest), dp: of[0].dp })
    }
}

/// Returns the note on the error bars of a plot, or an empty text if no run has repeats.
pub fn error_bar_note(rows: &[ResultRow]) -> &'static str {
    match has_repeats(rows) {
        true => " A point is the mean of its repeats, its bar goes from the least to the greatest.",
        false => "",
    }
}

/// Returns the spreads as a table of text, with a header row and a row for each run and check. The table is empty if no
/// run has repeats.
pub fn spread_table(rows: &[ResultRow]) -> Vec<Vec<String>> {
    let all: Vec<Vec<&ResultRow>> = group_repeats(rows).into_iter().filter(|of| of.len() > 1).collect();
    let known = |(_, figure): &Metric| all.iter().any(|of| spread_of(of, *figure).is_some());
    let used: Vec<Metric> = SPREAD_METRICS.into_iter().filter(known).collect();
    let row = |of: &Vec<&ResultRow>| {
        let told = |(name, figure): &Metric| {
            let number =
                if *name == MAX_ABS_METRIC.0 { format_verdicts::format_value } else { format_verdicts::format_metric };
            spread_of(of, *figure).map_or("–".into(), |spread| spread.format(number))
        };
        let mut cells = vec![of[0].run.clone(), of[0].check.clone(), of.len().to_string()];
        cells.extend(used.iter().map(told));
        cells.push(spread_of(of, |row| row.cpu_s).map_or("–".into(), |spread| format!("{:.1}", spread.mean)));
        cells
    };
    let head = ["run", "check", "runs"].into_iter().chain(used.iter().map(|(name, _)| *name)).chain(["processors, s"]);
    let head = (!all.is_empty()).then(|| head.map(String::from).collect());
    head.into_iter().chain(all.iter().map(row)).collect()
}

/// The note below the table of spreads.
pub const REPEATS_NOTE: &str = "Repeats start with their water moved by a millionth of dp more each time: what differs between them is chance. \
    Mean ± standard deviation of one run (least to greatest). Two laws whose means are nearer than that are not told apart by one run of each.";

#[cfg(test)]
#[path = "../../tests/unit/study/repeat_spread.rs"]
mod tests;
