//! A study as a table: one row for each run and check.

use serde::Serialize;

use super::{Job, JobResult, JobState};
use crate::{
    analysis::{ErrorMetrics, Verdict},
    error::{Error, ErrorKind, Result},
};

/// A run under one of its checks; a figure is none where it is not known.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ResultRow {
    /// Name of the run; repeats share it.
    pub run: String,
    /// Which repeat of it, from 1.
    pub repeat: usize,
    /// Particle spacing, m.
    pub dp: f64,
    /// Keys and values that make this run another than the rest.
    pub varied: Vec<(String, String)>,
    /// What was compared, as `probe.column`; empty for a run without checks.
    pub check: String,
    /// What came out.
    #[serde(flatten)]
    pub metrics: ErrorMetrics,
    /// N of the running mean, –.
    #[serde(rename = "mean_N")]
    pub mean_relative_l2: Option<f64>,
    /// N with the delay taken out, –.
    #[serde(rename = "aligned_N")]
    pub aligned_relative_l2: Option<f64>,
    /// That delay, s.
    pub delay_s: Option<f64>,
    /// Whether the bound is kept, where there is one.
    pub passed: Option<bool>,
    /// Particles of water.
    pub water: Option<usize>,
    /// Wall time, s.
    pub wall_s: Option<f64>,
    /// Processor time, s.
    pub cpu_s: Option<f64>,
    /// Particles × force passes.
    pub particle_steps: Option<u64>,
    /// `planned`, `interrupted`, `finished` or `failed`.
    pub status: &'static str,
    /// Why it failed.
    pub reason: Option<String>,
}

/// An error that is plotted: its name, and how a row tells it.
pub(crate) type Metric = (&'static str, fn(&ResultRow) -> Option<f64>);

/// The errors relative to the reference: N, and N with the delay taken out.
pub(crate) const RELATIVE_METRICS: [Metric; 2] =
    [("N", |r| r.metrics.relative_l2), ("aligned N", |r| r.aligned_relative_l2)];

/// The largest distance from the reference, in the unit of its series.
pub(crate) const MAX_ABS_METRIC: Metric = ("largest distance", |r| r.metrics.off);

/// The rows of `jobs`, of which the first have `ran`. A run that has not finished has a row for each of
/// `checks` too.
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

/// Names of checks: their series, with a number from the second of a series on.
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

/// The rows as CSV: `keys` are the varied ones, a column each.
///
/// # Errors
/// `File` if the text cannot be made.
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
        let ErrorMetrics { relative_l2, amplitude_ratio, peak, off } = row.metrics;
        cells.extend(
            [relative_l2, amplitude_ratio, peak, off, row.mean_relative_l2, row.aligned_relative_l2, row.delay_s]
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
