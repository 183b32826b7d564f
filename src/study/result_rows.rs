//! The results of a study as a table, with one row for each run and check.

use serde::Serialize;

use super::{Job, JobResult, JobState};
use crate::{
    analysis::{ErrorMetrics, Verdict},
    error::{Error, ErrorKind, Result},
};

/// A row for a run and one of its checks; an unknown value is `None`.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ResultRow {
    /// The name of the run; all repeats of the run share this name.
    pub run: String,
    /// The number of the repeat, counted from 1.
    pub repeat: usize,
    /// The particle spacing, m.
    pub dp: f64,
    /// The keys and values that distinguish this run from the others.
    pub varied: Vec<(String, String)>,
    /// The compared series, as `probe.column`; empty for a run without checks.
    pub check: String,
    /// The metrics of the check.
    #[serde(flatten)]
    pub metrics: ErrorMetrics,
    /// N of the running mean, –.
    #[serde(rename = "mean_N")]
    pub mean_relative_l2: Option<f64>,
    /// N after removal of the delay, –.
    #[serde(rename = "aligned_N")]
    pub aligned_relative_l2: Option<f64>,
    /// The removed delay, s.
    pub delay_s: Option<f64>,
    /// Whether the check meets its bound, or `None` without a bound.
    pub passed: Option<bool>,
    /// The number of water particles.
    pub water: Option<usize>,
    /// The wall time, s.
    pub wall_s: Option<f64>,
    /// The processor time, s.
    pub cpu_s: Option<f64>,
    /// The number of particles × force passes.
    pub particle_steps: Option<u64>,
    /// The state: `planned`, `interrupted`, `finished` or `failed`.
    pub status: &'static str,
    /// The reason for the failure of the run.
    pub reason: Option<String>,
}

/// An error for a plot: its name, and the function that returns its value from a row.
pub(crate) type Metric = (&'static str, fn(&ResultRow) -> Option<f64>);

/// The errors relative to the reference: N, and N after removal of the delay.
pub(crate) const RELATIVE_METRICS: [Metric; 2] =
    [("N", |r| r.metrics.relative_l2), ("aligned N", |r| r.aligned_relative_l2)];

/// The largest distance from the reference, in the unit of the series.
pub(crate) const MAX_ABS_METRIC: Metric = ("largest distance", |r| r.metrics.off);

/// Returns the rows of `jobs`; `ran` contains the results of the first jobs. An unfinished run also has a row for each
/// of `checks`.
pub(crate) fn result_rows(jobs: &[Job], ran: &[JobResult], checks: &[String]) -> Vec<ResultRow> {
    let of = |(i, job): (usize, &Job)| {
        let first = ResultRow {
            run: job.name.clone(),
            repeat: job.repeat,
            dp: job.dp,
            varied: job.varied.clone(),
            status: "planned",
            ..ResultRow::default()
        };
        let ran = ran.get(i);
        let first = ran.map_or(first.clone(), |ran| with_costs(first, ran));
        let verdicts = ran.map_or(&[][..], |ran| &ran.verdicts[..]);
        match (verdicts, checks) {
            ([], []) => vec![first],
            ([], checks) => checks.iter().map(|check| ResultRow { check: check.clone(), ..first.clone() }).collect(),
            (verdicts, _) => check_labels(verdicts.iter().map(|v| v.series.as_str()))
                .into_iter()
                .zip(verdicts)
                .map(|(check, verdict)| with_verdict(ResultRow { check, ..first.clone() }, verdict))
                .collect(),
        }
    };
    jobs.iter().enumerate().flat_map(of).collect()
}

/// Returns the labels of checks. A label is the series, with a number from the second check of a series on.
pub(crate) fn check_labels(series: impl IntoIterator<Item = impl Into<String>>) -> Vec<String> {
    let all: Vec<String> = series.into_iter().map(Into::into).collect();
    let label = |i: usize| match all[..i].iter().filter(|other| **other == all[i]).count() {
        0 => all[i].clone(),
        before => format!("{} ({})", all[i], before + 1),
    };
    (0..all.len()).map(label).collect()
}

fn with_costs(row: ResultRow, ran: &JobResult) -> ResultRow {
    let (status, reason) = match &ran.state {
        JobState::Planned => ("planned", None),
        JobState::Interrupted => ("interrupted", None),
        JobState::Finished => ("finished", None),
        JobState::Failed(why) => ("failed", Some(why.clone())),
    };
    let Some(manifest) = &ran.manifest else { return ResultRow { status, reason, ..row } };
    ResultRow {
        water: Some(manifest.particles.fluid),
        wall_s: Some(manifest.wall_s),
        cpu_s: Some(manifest.cpu_s),
        particle_steps: Some(manifest.particle_steps),
        status,
        reason,
        ..row
    }
}

fn with_verdict(row: ResultRow, verdict: &Verdict) -> ResultRow {
    ResultRow {
        metrics: verdict.metrics,
        mean_relative_l2: verdict.meaned.and_then(|m| m.metrics.relative_l2),
        aligned_relative_l2: verdict.aligned.map(|a| a.relative_l2),
        delay_s: verdict.aligned.map(|a| a.delay),
        passed: verdict.passed,
        ..row
    }
}

/// Returns the rows as CSV, with a column for each of the varied `keys`.
///
/// # Errors
/// `File` if the CSV text cannot be created.
pub(crate) fn rows_to_csv(rows: &[ResultRow], keys: &[String]) -> Result<Vec<u8>> {
    let broken = |why: csv::Error| Error::new(ErrorKind::File, format!("the table cannot be made: {why}"));
    let mut writer = csv::Writer::from_writer(Vec::new());
    let mut head = ["run", "repeat", "dp_m"].map(String::from).to_vec();
    head.extend(keys.iter().cloned());
    let rest = [
        "check",
        "N",
        "M",
        "peak",
        "off",
        "mean_N",
        "aligned_N",
        "delay_s",
        "period",
        "passed",
        "water",
        "wall_s",
        "cpu_s",
        "particle_steps",
        "status",
        "reason",
    ];
    head.extend(rest.map(String::from));
    writer.write_record(&head).map_err(broken)?;
    for row in rows {
        let number = |x: Option<f64>| x.map_or(String::new(), |x| format!("{x:?}"));
        let mut cells = vec![row.run.clone(), row.repeat.to_string(), format!("{:?}", row.dp)];
        let value = |key: &String| row.varied.iter().find(|(k, _)| k == key).map_or(String::new(), |(_, v)| v.clone());
        cells.extend(keys.iter().map(value));
        cells.push(row.check.clone());
        let ErrorMetrics { relative_l2, amplitude_ratio, peak, off, period } = row.metrics;
        cells.extend(
            [
                relative_l2,
                amplitude_ratio,
                peak,
                off,
                row.mean_relative_l2,
                row.aligned_relative_l2,
                row.delay_s,
                period,
            ]
            .map(number),
        );
        cells.push(row.passed.map_or(String::new(), |kept| kept.to_string()));
        cells.push(row.water.map_or(String::new(), |n| n.to_string()));
        cells.extend([row.wall_s, row.cpu_s].map(number));
        cells.push(row.particle_steps.map_or(String::new(), |n| n.to_string()));
        cells.extend([row.status.to_string(), row.reason.clone().unwrap_or_default().replace('\n', " ")]);
        writer.write_record(&cells).map_err(broken)?;
    }
    writer.into_inner().map_err(|why| Error::new(ErrorKind::File, format!("the table cannot be made: {why}")))
}

#[cfg(test)]
#[path = "../../tests/unit/study/result_rows.rs"]
mod tests;
