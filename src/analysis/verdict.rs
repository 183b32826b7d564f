//! Verdicts: the module compares a column of the run's own CSV with a column of a reference CSV, or with a formula.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::{
    alignment::{AlignedMetrics, ArrivalTimes, align},
    error_metrics::{amplitude_ratio, first_peak_error, max_abs, relative_l2},
    response::Response,
};
use crate::{
    error::{Error, Result},
    math::{
        expression::Formula,
        table::{ColumnName, TableReader},
        time_series::{SampleScaling, TimeSeries},
    },
    plan::{Align, CheckPlan, Reference, ResponseReference, Score},
};

/// A reference for a comparison with a run.
#[derive(Clone, Debug)]
pub struct ReferenceCheck {
    plan: CheckPlan,
    reference: KnownReference,
}

/// The data of a reference.
#[derive(Clone, Debug)]
enum KnownReference {
    /// Samples in the window, with their delay added.
    Table(TimeSeries),
    /// A formula, which has a value at any time.
    Formula(Formula),
    /// A response to another series of the run.
    Response(ResponseReference),
}

/// The curves of a run and its reference.
#[derive(Clone, Debug)]
pub struct CheckCurves {
    /// The run, from its start to its end.
    pub sim: TimeSeries,
    /// The run after the running mean of the check's instrument, if the check defines an instrument.
    pub running_mean: Option<TimeSeries>,
    /// The reference, over the times that both the window and the run cover.
    pub reference: TimeSeries,
    /// Whether the reference is a formula.
    pub exact: bool,
}

/// Metrics of a comparison; a metric is `None` where it is not defined.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ErrorMetrics {
    /// Relative deviation, –.
    #[serde(rename = "N")]
    pub relative_l2: Option<f64>,
    /// Amplitude ratio, –.
    #[serde(rename = "M")]
    pub amplitude_ratio: Option<f64>,
    /// Relative error of the first peak, –.
    pub peak: Option<f64>,
    /// Largest |run − reference|, in the unit of the series.
    pub off: Option<f64>,
    /// Relative error of the period of a response, –.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub period: Option<f64>,
}

/// Metrics of the run after the running mean of an instrument.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunningMeanMetrics {
    /// Averaging time of the running mean, s.
    pub seconds: f64,
    /// Metrics of the running mean.
    #[serde(flatten)]
    pub metrics: ErrorMetrics,
}

/// Result of the comparison of a run with a reference.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    /// Name of the series, as `probe.column`.
    pub series: String,
    /// Metrics of the run without a running mean.
    #[serde(flatten)]
    pub metrics: ErrorMetrics,
    /// Metrics of the running mean, if the check asks for a running mean.
    pub meaned: Option<RunningMeanMetrics>,
    /// N and M after removal of one constant delay; they refer to the running mean if the check has one.
    pub aligned: Option<AlignedMetrics>,
    /// Times at which run and reference first pass the threshold of the check, if it has a threshold.
    pub arrival: Option<ArrivalTimes>,
    /// Metrics that the paper reports.
    pub paper: Option<Score>,
    /// Metrics that the run must reach.
    pub bound: Option<Score>,
    /// Share of the reference that lies within the simulated time, –.
    pub covered: f64,
    /// Whether the run meets the bound; `None` if there is no bound or the data do not suffice.
    pub passed: Option<bool>,
    /// Reason for a missing metric.
    pub note: Option<String>,
}

impl ReferenceCheck {
    /// Makes the check of a run from its plan `words`; relative table paths refer to `folder`.
    ///
    /// # Errors
    /// `File` if the table cannot be read. `Scene` if the table lacks a column or has fewer than two samples in the
    /// window, or if the formula is invalid.
    pub fn new(words: &CheckPlan, folder: &Path) -> Result<Self> {
        let reference = match &words.reference {
            Reference::Formula(text) => KnownReference::Formula(Formula::parse(text)?),
            Reference::Response(response) => KnownReference::Response(response.clone()),
            Reference::Table { file, time, column, scaling } => {
                let path = folder.join(file);
                let (from, until) = window(words, 0.0);
                let whole = read_series(&path, time, column, scaling)?;
                KnownReference::Table(
                    whole
                        .window(from, until)
                        .map_err(|e| e.at(path.display().to_string(), None, column.to_string()))?,
                )
            }
        };
        Ok(Self { plan: words.clone(), reference })
    }

    /// Returns the plan of the check.
    pub fn plan(&self) -> &CheckPlan {
        &self.plan
    }

    /// Returns the curves of the run with tables in `folder`, and of its reference.
    ///
    /// # Errors
    /// `File` if the run's table cannot be read; `Scene` if the table lacks the column, or the run and the reference
    /// have no time in common.
    pub fn curves(&self, folder: &Path) -> Result<CheckCurves> {
        let (sim, meaned) = self.run_series(folder)?;
        let (reference, ..) = self.overlap(folder, &sim)?;
        let exact = !matches!(self.reference, KnownReference::Table(_));
        Ok(CheckCurves { sim, running_mean: meaned, reference, exact })
    }

    /// Returns the verdict on the run with tables in `folder`, over the times that run and reference both cover. The
    /// function never fails. If a comparison is impossible, the note of the verdict states the reason. The run then
    /// misses its bound, if the check has a bound, unless the run is too short.
    pub fn verdict(&self, folder: &Path) -> Verdict {
        let mut verdict = self.empty_verdict();
        let (sim, meaned) = match self.run_series(folder) {
            Ok(run) => run,
            Err(why) => {
                verdict.passed = self.plan.bound.map(|_| false);
                return Verdict { note: Some(why.to_string()), ..verdict };
            }
        };
        let (reference, covered, start) = match self.overlap(folder, &sim) {
            Ok(common) => common,
            Err(why) => {
                // A run that ends before its reference begins, or before its zero time, is too short; it is not a
                // failure.
                let (from, until) = window(&self.plan, 0.0);
                let set = self.plan.zero.is_none_or(|at| at <= sim.span().1);
                let reaches = set
                    && !matches!(self.reference, KnownReference::Table(_))
                    && sim.window(from, until).is_ok()
                    && covered_share((from, until), sim.span()) >= 0.5;
                verdict.passed = self.plan.bound.filter(|_| reaches).map(|_| false);
                return Verdict { note: Some(why.to_string()), ..verdict };
            }
        };
        verdict.covered = covered;
        if let KnownReference::Response(words) = &self.reference {
            return self.of_response(verdict, self.response(folder, &sim, words).ok());
        }
        verdict.note = relative_l2(&sim, &reference).err().map(|why| why.to_string());
        verdict.metrics = self.metrics(&sim, &reference, start);
        verdict.meaned = self
            .plan
            .mean
            .zip(meaned.as_ref())
            .map(|(seconds, meaned)| RunningMeanMetrics { seconds, metrics: self.metrics(meaned, &reference, start) });
        if let Some(how) = self.plan.align {
            let shown = meaned.as_ref().unwrap_or(&sim);
            (verdict.aligned, verdict.arrival) = match how {
                Align::Start(_) => (None, Some(ArrivalTimes { run: Some(start), reference: Some(0.0) })),
                how => align(shown, &reference, how, window(&self.plan, start)),
            };
            let is_without = verdict.aligned.is_none() && verdict.note.is_none();
            verdict.note = if is_without { why_unaligned(how, verdict.arrival) } else { verdict.note };
        }
        verdict.judged()
    }

    /// Returns `verdict` with the figures of a response.
    fn of_response(&self, verdict: Verdict, response: Option<Response>) -> Verdict {
        let metrics = response.as_ref().map_or_else(ErrorMetrics::default, Response::metrics);
        let aligned = response.as_ref().and_then(Response::aligned);
        Verdict { metrics, aligned, ..verdict }.judged()
    }

    fn empty_verdict(&self) -> Verdict {
        Verdict {
            series: self.plan.label(),
            metrics: ErrorMetrics::default(),
            meaned: None,
            aligned: None,
            arrival: None,
            paper: self.plan.paper,
            bound: self.plan.bound,
            covered: 0.0,
            passed: None,
            note: None,
        }
    }

    /// Returns the series of the run, and its running mean if the check has an instrument.
    fn run_series(&self, folder: &Path) -> Result<(TimeSeries, Option<TimeSeries>)> {
        let mut sim = own_series(folder, &self.plan.series)?;
        if let Some(at) = self.plan.zero {
            sim = sim.minus(sim.value_at(at));
        }
        let meaned = self.plan.mean.map(|seconds| sim.running_mean(seconds));
        Ok((sim, meaned))
    }

    /// Returns the time of the run at which the reference's clock starts, s: 0 unless the reference has its own clock.
    fn reference_start(&self, sim: &TimeSeries) -> Result<f64> {
        let Some(Align::Start(threshold)) = self.plan.align else { return Ok(0.0) };
        sim.first_crossing(threshold).ok_or_else(|| {
            Error::scene(format!("the run never passes {threshold}, with which the clock of its reference starts"))
        })
    }

    /// Returns the reference over the times of the run, the share of the reference that they cover, and the start of
    /// its clock.
    fn overlap(&self, folder: &Path, sim: &TimeSeries) -> Result<(TimeSeries, f64, f64)> {
        let (first, last) = sim.span();
        if let Some(at) = self.plan.zero.filter(|at| *at > last) {
            return Err(Error::scene(format!("the run ends at {last} s, before it is set to zero at {at} s")));
        }
        let start = self.reference_start(sim)?;
        let (from, until) = window(&self.plan, start);
        match &self.reference {
            KnownReference::Table(whole) => {
                let whole = whole.shifted(start);
                let common = whole.window(first, last).map_err(|_| {
                    let (from, to) = whole.span();
                    Error::scene(format!(
                        "the reference begins at {from} s and ends at {to} s, the run at {first} and {last} s"
                    ))
                })?;
                let covered = common.times().len() as f64 / whole.times().len() as f64;
                Ok((common, covered, start))
            }
            KnownReference::Formula(formula) => {
                let times = sim.window(from, until)?.times().to_vec();
                let values: Vec<f64> = times.iter().map(|&t| formula.value_and_rate(t - start).0).collect();
                if let Some(i) = values.iter().position(|x| !x.is_finite()) {
                    return Err(Error::scene(format!("the formula gives {} at t = {} s", values[i], times[i])));
                }
                Ok((TimeSeries::new(times, values)?, covered_share((from, until), (first, last)), start))
            }
            KnownReference::Response(words) => {
                let times = sim.window(from, until)?.times().to_vec();
                let values = self.response(folder, sim, words)?.expected(&times);
                Ok((TimeSeries::new(times, values)?, covered_share((from, until), (first, last)), start))
            }
        }
    }

    /// Returns the response of `sim` to another series of the run, which is in `folder`.
    fn response(&self, folder: &Path, sim: &TimeSeries, words: &ResponseReference) -> Result<Response> {
        let (from, until) = window(&self.plan, 0.0);
        let wave = own_series(folder, &words.to)?;
        let wave = wave.window(words.from.unwrap_or(from), words.until.unwrap_or(until))?;
        Response::new(&sim.window(from, until)?, &wave, words).ok_or_else(|| {
            let what =
                format!("{} or {} does not swing for two periods of {} s", self.plan.series, words.to, words.period);
            Error::scene(what)
        })
    }

    fn metrics(&self, sim: &TimeSeries, reference: &TimeSeries, start: f64) -> ErrorMetrics {
        let (from, until) = window(&self.plan, start);
        ErrorMetrics {
            period: None,
            relative_l2: relative_l2(sim, reference).ok(),
            amplitude_ratio: amplitude_ratio(sim, reference).ok(),
            peak: sim.window(from, until).and_then(|sim| first_peak_error(&sim, reference)).ok(),
            off: max_abs(sim, reference).ok(),
        }
    }
}

impl Verdict {
    /// Returns this verdict with the outcome of its bound; a run that covers less than half of its reference has none.
    fn judged(mut self) -> Self {
        match self.bound {
            Some(_) if self.covered < 0.5 => {
                self.note = Some("the run covers less than half of the reference: not judged".into());
            }
            bound => self.passed = bound.map(|bound| self.meets(&bound)),
        }
        self
    }

    /// Returns whether every metric that `bound` names exists and is within the bound.
    pub(crate) fn meets(&self, bound: &Score) -> bool {
        let within =
            |limit: Option<f64>, figure: Option<f64>| limit.is_none_or(|most| figure.is_some_and(|x| x <= most));
        within(bound.relative_l2, self.metrics.relative_l2)
            && within(bound.amplitude_ratio, self.metrics.amplitude_ratio.map(|m| (m - 1.0).abs()))
            && within(bound.peak, self.metrics.peak)
            && within(bound.off, self.metrics.off)
            && within(bound.aligned_relative_l2, self.aligned.map(|a| a.relative_l2))
            && within(bound.delay, self.aligned.map(|a| a.delay.abs()))
            && within(bound.period, self.metrics.period)
    }
}

/// Returns the reason why `how` gives no delay; `None` if it is not meant to.
fn why_unaligned(how: Align, arrival: Option<ArrivalTimes>) -> Option<String> {
    match (how, arrival) {
        (Align::Start(_), _) => None,
        (Align::Crossing(threshold), Some(ArrivalTimes { run: None, .. })) => {
            Some(format!("the run never passes {threshold}: not aligned"))
        }
        (Align::Crossing(threshold), Some(ArrivalTimes { reference: None, .. })) => {
            Some(format!("the reference never passes {threshold}: not aligned"))
        }
        (Align::Crossing(_), _) => Some("moved by the delay, the reference leaves the run: not aligned".into()),
        (Align::Best, _) => Some(
            "the best delay is beyond those that can be tried, 0.3 s and a tenth of the reference: not aligned".into(),
        ),
    }
}

/// Returns the first and last time of the run in the comparison, s, if the reference's clock starts at `start` (s).
fn window(words: &CheckPlan, start: f64) -> (f64, f64) {
    let from = match words.align {
        Some(Align::Start(_)) => 0.0,
        _ => f64::NEG_INFINITY,
    };
    (words.from.unwrap_or(from) + start, words.until.unwrap_or(f64::INFINITY) + start)
}

/// Returns the share of the time range `of` that lies within `span`; 1 for a range without an end.
fn covered_share(of: (f64, f64), span: (f64, f64)) -> f64 {
    let ((from, until), (first, last)) = (of, span);
    let from = from.max(first);
    if until.is_finite() { ((last.min(until) - from) / (until - from)).clamp(0.0, 1.0) } else { 1.0 }
}

/// Returns the series `name` of the run with tables in `folder`.
fn own_series(folder: &Path, name: &str) -> Result<TimeSeries> {
    let (probe, column) = name.split_once('.').unwrap_or((name, ""));
    let path: PathBuf = folder.join(format!("{probe}.csv"));
    read_series(&path, &"t_s".into(), &column.into(), &SampleScaling::default())
}

/// Returns the series of `column` over `time` of the table at `path`, in the scale and on the clock of the run. Rows may
/// be in any order. Digitised figures can have several values at the same time; the function uses their mean.
fn read_series(path: &Path, time: &ColumnName, column: &ColumnName, scaling: &SampleScaling) -> Result<TimeSeries> {
    let mut table = TableReader::open(path)?;
    let time = table.time_column(time, column);
    let [t, x] = table.columns([&time, column])?;
    let mut rows: Vec<(f64, f64)> = t.into_iter().zip(x).collect();
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    let groups = rows.chunk_by(|a, b| a.0 == b.0);
    let (t, x): (Vec<f64>, Vec<f64>) =
        groups.map(|g| (g[0].0, g.iter().map(|row| row.1).sum::<f64>() / g.len() as f64)).unzip();
    let series = TimeSeries::new(t, x).and_then(|series| series.scaled(scaling));
    series.map_err(|e| e.at(path.display().to_string(), None, column.to_string()))
}
