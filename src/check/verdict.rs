//! Verdicts: a column of the run's own CSV against a column of a reference CSV.
//!
//! Lines that open with `#` are comments. Empty fields are gaps. Several references at one instant, as
//! digitised figures have them, count as their mean.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::measure::{amplitude, deviation, peak};
use crate::{
    error::{Error, Result, nearest},
    plan::Score,
    series::Series,
};

/// A reference that a run is to be held against.
#[derive(Clone, Debug)]
pub struct Check {
    series: String,
    reference: Series,
    paper: Option<Score>,
    bound: Option<Score>,
}

/// How a run did against a reference.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    /// Which series, as `probe.column`.
    pub series: String,
    /// Relative deviation, –.
    #[serde(rename = "N")]
    pub n: Option<f64>,
    /// Amplitude ratio, –.
    #[serde(rename = "M")]
    pub m: Option<f64>,
    /// Relative error of the first peak, –.
    pub peak: Option<f64>,
    /// What the paper reached.
    pub paper: Option<Score>,
    /// What the run must reach.
    pub bound: Option<Score>,
    /// Share of the reference's samples that lie within the simulated time, –.
    pub covered: f64,
    /// Whether the bound is kept; none if there is no bound or too little to judge by.
    pub passed: Option<bool>,
    /// Why a figure is missing.
    pub note: Option<String>,
}

impl Check {
    /// The check of `series` (as in `box.heave_m`) against `column` over `time` (s) of the table at
    /// `reference`, whose times are moved by `delay` (s): what it calls t happens at t + delay of the run.
    ///
    /// # Errors
    /// `File` if the table cannot be read; `Scene` if it lacks a column or has fewer than two samples.
    pub fn new(
        series: &str,
        reference: &Path,
        [time, column]: [&str; 2],
        delay: f64,
        [paper, bound]: [Option<Score>; 2],
    ) -> Result<Self> {
        let mut rows = read_columns(reference, time, column)?;
        rows.iter_mut().for_each(|row| row.0 += delay);
        let reference = series_of(rows).map_err(|e| e.at(reference.display().to_string(), None, column))?;
        Ok(Self { series: series.into(), reference, paper, bound })
    }

    /// Probe and column of the run that it looks at.
    pub fn series(&self) -> (&str, &str) {
        self.series.rsplit_once('.').unwrap_or((&self.series, ""))
    }

    /// The verdict on the table of the probe in `folder`, over the times that both cover. Never fails: a
    /// comparison that cannot be made says so in its note.
    pub fn judge(&self, folder: &Path) -> Verdict {
        let mut verdict = Verdict {
            series: self.series.clone(),
            n: None,
            m: None,
            peak: None,
            paper: self.paper,
            bound: self.bound,
            covered: 0.0,
            passed: None,
            note: None,
        };
        if let Err(why) = self.measure(folder, &mut verdict) {
            verdict.note = Some(why.to_string());
        }
        verdict
    }

    fn measure(&self, folder: &Path, verdict: &mut Verdict) -> Result<()> {
        let (probe, column) = self.series();
        let path: PathBuf = folder.join(format!("{probe}.csv"));
        let sim = series_of(read_columns(&path, "t_s", column)?)?;
        let (first, last) = sim.span();
        let all = self.reference.times().iter().copied().zip(self.reference.values().iter().copied());
        let common: Vec<(f64, f64)> = all.filter(|(t, _)| (first..=last).contains(t)).collect();
        verdict.covered = common.len() as f64 / self.reference.times().len() as f64;
        let reference = series_of(common).map_err(|_| {
            let (from, to) = self.reference.span();
            Error::scene(format!(
                "the reference begins at {from} s and ends at {to} s, the run at {first} and {last} s"
            ))
        })?;
        verdict.n = Some(deviation(&sim, &reference)?);
        verdict.m = Some(amplitude(&sim, &reference)?);
        verdict.peak = peak(&sim, &reference).ok();
        match self.bound {
            Some(_) if verdict.covered < 0.5 => {
                verdict.note = Some("the run covers less than half of the reference: not judged".into());
            }
            Some(bound) => verdict.passed = Some(within(bound, verdict.n, verdict.m)),
            None => {}
        }
        Ok(())
    }
}

/// Whether the figures keep the bound; a figure that is not a number does not.
fn within(bound: Score, n: Option<f64>, m: Option<f64>) -> bool {
    let kept = |limit: Option<f64>, off: Option<f64>| limit.is_none_or(|limit| off.is_some_and(|off| off <= limit));
    kept(bound.n, n) && kept(bound.m, m.map(|m| (m - 1.0).abs()))
}

/// The rows (time, value) of a CSV table in which both columns hold a number.
///
/// # Errors
/// `File` if it cannot be read; `Scene` if a column is missing (names the nearest) or a field is no number.
fn read_columns(path: &Path, time: &str, column: &str) -> Result<Vec<(f64, f64)>> {
    let broken = |why: csv::Error| Error::file(path, why);
    let mut reader =
        csv::ReaderBuilder::new().comment(Some(b'#')).trim(csv::Trim::All).from_path(path).map_err(broken)?;
    let header = reader.headers().map_err(broken)?.clone();
    let place = |name: &str| {
        header.iter().position(|h| h == name).ok_or_else(|| {
            let help = match nearest(name, &header) {
                Some(near) => format!("did you mean {near:?}?"),
                None => format!("its columns are: {}", header.iter().collect::<Vec<_>>().join(", ")),
            };
            Error::scene(format!("{} has no column {name:?}", path.display())).help(help)
        })
    };
    let (t, x) = (place(time)?, place(column)?);
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(broken)?;
        let line = record.position().map_or(0, |p| p.line() as usize);
        let field = |i: usize| match record.get(i).unwrap_or("") {
            "" => Ok(None),
            word => word.parse::<f64>().map(Some).map_err(|_| {
                Error::scene(format!("{word:?} is not a number")).at(
                    path.display().to_string(),
                    Some((line, 1)),
                    &header[i],
                )
            }),
        };
        if let (Some(t), Some(x)) = (field(t)?, field(x)?) {
            rows.push((t, x));
        }
    }
    Ok(rows)
}

/// The series of `rows`, in the order of time, several at an instant as their mean.
fn series_of(mut rows: Vec<(f64, f64)>) -> Result<Series> {
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    let groups = rows.chunk_by(|a, b| a.0 == b.0);
    let (t, x): (Vec<f64>, Vec<f64>) =
        groups.map(|g| (g[0].0, g.iter().map(|row| row.1).sum::<f64>() / g.len() as f64)).unzip();
    Series::new(t, x)
}
