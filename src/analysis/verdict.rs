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
        readings::reading_times,
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

/// A series of a run, as its table has it.
struct RunSeries {
    /// The readings.
    sim: TimeSeries,
    /// The running mean, if the check has an instrument and the readings suffice.
    running_mean: Option<TimeSeries>,
    /// The end of the run, s.
    end: f64,
    /// Times (s) of successive readings with an empty row between them.
    gaps: Vec<(f64, f64)>,
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
    /// Makes the check of a run from its plan `words`; relative table paths refer to `folder`. A bound without a figure is none.
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
        let bound = words.bound.filter(|bound| *bound != Score::default());
        Ok(Self { plan: CheckPlan { bound, ..words.clone() }, reference })
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
        let run = self.run_series(folder)?;
        let (reference, ..) = self.overlap(folder, &run)?;
        let exact = !matches!(self.reference, KnownReference::Table(_));
        Ok(CheckCurves { sim: run.sim, running_mean: run.running_mean, reference, exact })
    }

    /// Returns the verdict on the run with tables in `folder`, over the times that run and reference both cover. The
    /// function never fails. If a comparison is impossible, the note of the verdict states the reason. The run then
    /// misses its bound, if the check has a bound, unless the run ends before half of the reference.
    pub fn verdict(&self, folder: &Path) -> Verdict {
        let mut verdict = self.empty_verdict();
        let run = match self.run_series(folder) {
            Ok(run) => run,
            Err(why) => {
                verdict.passed = self.plan.bound.map(|_| false);
                return Verdict { note: Some(why.to_string()), ..verdict };
            }
        };
        let (reference, covered, start) = match self.overlap(folder, &run) {
            Ok(common) => common,
            Err(why) => {
                verdict.passed = self.plan.bound.filter(|_| self.is_reached(&run)).map(|_| false);
                return Verdict { note: Some(why.to_string()), ..verdict };
            }
        };
        verdict.covered = covered;
        let is_reached = self.is_reached(&run);
        let (sim, meaned) = (run.sim, run.running_mean);
        if let KnownReference::Response(words) = &self.reference {
            return verdict.of_response(self.response(folder, &sim, words).ok()).judged(is_reached);
        }
        let no_peak =
            self.plan.bound.and_then(|bound| bound.peak).and_then(|_| self.peak(&sim, &reference, start).err());
        verdict.note = relative_l2(&sim, &reference).err().or(no_peak).map(|why| why.to_string());
        verdict.metrics = self.metrics(&sim, &reference, start);
        verdict.meaned = self
            .plan
            .mean
            .zip(meaned.as_ref())
            .map(|(seconds, meaned)| RunningMeanMetrics { seconds, metrics: self.metrics(meaned, &reference, start) });
        if let (Some(seconds), None) = (self.plan.mean, &meaned) {
            verdict.note = Some(format!("the readings are too few for a mean over {seconds} s"));
        } else if let Some(how) = self.plan.align {
            (verdict.aligned, verdict.arrival) = match how {
                Align::Start(_) => (None, Some(ArrivalTimes { run: Some(start), reference: Some(0.0) })),
                how => self.aligned(meaned.as_ref().unwrap_or(&sim), &reference, how, start),
            };
            if verdict.aligned.is_none() && verdict.note.is_none() {
                let (from, until) = window(&self.plan, start);
                let run = meaned.unwrap_or(sim).window(from, until).ok();
                verdict.note = why_unaligned(how, verdict.arrival, [run.as_ref(), Some(&reference)]);
            }
        }
        verdict.judged(is_reached)
    }

    /// Returns whether the run is long enough to be judged.
    fn is_reached(&self, run: &RunSeries) -> bool {
        let end = run.end;
        if self.plan.zero.is_some_and(|at| at > end) {
            return false;
        }
        let start = self.reference_start(&run.sim).ok();
        match &self.reference {
            KnownReference::Table(whole) => start.is_some_and(|start| {
                let (first, last) = whole.span();
                end - start >= 0.5 * (first + last)
            }),
            _ => {
                let (from, until) = window(&self.plan, start.unwrap_or(0.0));
                let from = if from.is_finite() { from } else { 0.0 };
                end > from && (until.is_infinite() || end - from >= 0.5 * (until - from))
            }
        }
    }

    /// Returns the metrics after removal of a delay, over the times that `sim` has in common with `reference`.
    fn aligned(
        &self,
        sim: &TimeSeries,
        reference: &TimeSeries,
        how: Align,
        start: f64,
    ) -> (Option<AlignedMetrics>, Option<ArrivalTimes>) {
        let (first, last) = sim.span();
        let common = reference.window(first, last);
        common.map_or((None, None), |reference| align(sim, &reference, how, window(&self.plan, start)))
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

    /// Returns the checked series of the run with tables in `folder`.
    fn run_series(&self, folder: &Path) -> Result<RunSeries> {
        let mut run = self.own_series(folder, &self.plan.series)?;
        if let Some(at) = self.plan.zero {
            run.sim = run.sim.minus(run.sim.value_at(at));
        }
        run.running_mean = self.plan.mean.and_then(|seconds| run.sim.running_mean(seconds).ok());
        Ok(run)
    }

    /// Returns the series `name` of the run with tables in `folder`, without a running mean.
    fn own_series(&self, folder: &Path, name: &str) -> Result<RunSeries> {
        let (probe, column) = name.split_once('.').unwrap_or((name, ""));
        let path: PathBuf = folder.join(format!("{probe}.csv"));
        let mut table = TableReader::open(&path)?;
        let column = ColumnName::from(column);
        let time = table.time_column(&"t_s".into(), &column);
        let [rows] = table.columns([time.clone()])?;
        let [known, x] = table.columns([time, column.clone()])?;
        let are_means = self.plan.means.iter().any(|mean| mean == name);
        let times = reading_times(&rows, are_means);
        let row = |t: f64| rows.partition_point(|row| *row < t);
        let at = |t: &f64| times[row(*t)];
        let pairs = known.windows(2).filter(|pair| row(pair[1]) > row(pair[0]) + 1);
        let gaps = pairs.map(|pair| (at(&pair[0]), at(&pair[1]))).collect();
        let sim = TimeSeries::new(known.iter().map(at).collect::<Vec<_>>(), x);
        let sim = sim.map_err(|e| e.at(path.display().to_string(), None, column.to_string()))?;
        Ok(RunSeries { sim, running_mean: None, end: rows.last().copied().unwrap_or_default(), gaps })
    }

    /// Returns the time of the run at which the reference's clock starts, s: 0 unless the reference has its own clock.
    fn reference_start(&self, sim: &TimeSeries) -> Result<f64> {
        let Some(Align::Start(threshold)) = self.plan.align else { return Ok(0.0) };
        sim.first_crossing(threshold).ok_or_else(|| {
            let why = why_no_crossing(Some(sim), threshold);
            Error::scene(format!("the run {why}: its passage starts the clock of the reference"))
        })
    }

    /// Returns the reference over the times at which the run has readings, the share of the reference that they cover, and the start of
    /// its clock.
    fn overlap(&self, folder: &Path, run: &RunSeries) -> Result<(TimeSeries, f64, f64)> {
        let sim = &run.sim;
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
                let common = without_gaps(&common, &run.gaps)?;
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
        let wave = self.own_series(folder, &words.to)?.sim;
        let wave = wave.window(words.from.unwrap_or(from), words.until.unwrap_or(until))?;
        Response::new(&sim.window(from, until)?, &wave, words).ok_or_else(|| {
            let what =
                format!("{} or {} does not swing for two periods of {} s", self.plan.series, words.to, words.period);
            Error::scene(what)
        })
    }

    /// Returns the relative error of the first peak. Beyond the ends of the reference the run may have larger ones, of which the
    /// reference tells nothing.
    fn peak(&self, sim: &TimeSeries, reference: &TimeSeries, start: f64) -> Result<f64> {
        let ((from, until), (first, last)) = (window(&self.plan, start), reference.span());
        first_peak_error(&sim.window(from.max(first), until.min(last))?, reference)
    }

    /// Returns the metrics of `sim` over the times that it has in common with `reference`.
    fn metrics(&self, sim: &TimeSeries, reference: &TimeSeries, start: f64) -> ErrorMetrics {
        let (first, last) = sim.span();
        let Ok(reference) = &reference.window(first, last) else { return ErrorMetrics::default() };
        ErrorMetrics {
            period: None,
            relative_l2: relative_l2(sim, reference).ok(),
            amplitude_ratio: amplitude_ratio(sim, reference).ok(),
            peak: self.peak(sim, reference, start).ok(),
            off: max_abs(sim, reference).ok(),
        }
    }
}

impl Verdict {
    /// Returns this verdict with the figures of a response.
    fn of_response(self, response: Option<Response>) -> Self {
        let metrics = response.as_ref().map_or_else(ErrorMetrics::default, Response::metrics);
        let aligned = response.as_ref().and_then(Response::aligned);
        Self { metrics, aligned, ..self }
    }

    /// Returns this verdict with the outcome of its bound. A run that covers less than half of its reference has none, unless it
    /// `is_reached`: the run goes on to half of the reference, and readings are missing.
    fn judged(mut self, is_reached: bool) -> Self {
        match self.bound {
            Some(_) if self.covered < 0.5 && is_reached => {
                self.note = Some("less than half of the reference has readings".into());
                self.passed = Some(false);
            }
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

/// Returns the samples of `reference` outside `gaps` (s), in which a run has no readings.
fn without_gaps(reference: &TimeSeries, gaps: &[(f64, f64)]) -> Result<TimeSeries> {
    let is_known = |t: f64| !gaps.iter().any(|gap| gap.0 < t && t < gap.1);
    let samples = reference.times().iter().copied().zip(reference.values().iter().copied());
    let (t, x): (Vec<f64>, Vec<f64>) = samples.filter(|(t, _)| is_known(*t)).unzip();
    TimeSeries::new(t, x).map_err(|_| Error::scene("the run has no readings at the times of its reference"))
}

/// Returns the reason why `how` gives no delay between `run` and `reference`; `None` if it is not meant to.
fn why_unaligned(
    how: Align,
    arrival: Option<ArrivalTimes>,
    [run, reference]: [Option<&TimeSeries>; 2],
) -> Option<String> {
    match (how, arrival) {
        (Align::Start(_), _) => None,
        (Align::Crossing(threshold), Some(ArrivalTimes { run: None, .. })) => {
            Some(format!("the run {}: not aligned", why_no_crossing(run, threshold)))
        }
        (Align::Crossing(threshold), Some(ArrivalTimes { reference: None, .. })) => {
            Some(format!("the reference {}: not aligned", why_no_crossing(reference, threshold)))
        }
        (Align::Crossing(_), _) => Some("moved by the delay, the reference leaves the run: not aligned".into()),
        (Align::Best, _) => Some(
            "the best delay is beyond those that can be tried, 0.3 s and a tenth of the reference: not aligned".into(),
        ),
    }
}

/// Returns the reason why `series` has no first crossing of a threshold.
fn why_no_crossing(series: Option<&TimeSeries>, threshold: f64) -> String {
    match series.is_some_and(|series| series.values()[0].abs() >= threshold) {
        true => format!("is beyond {threshold} from its first reading on"),
        false => format!("never passes {threshold}"),
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
