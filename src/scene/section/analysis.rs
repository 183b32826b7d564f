//! `[[check]]` and `[[statistic]]`: the evaluation of the series of a run.

use std::path::Path;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::water::StillWaterLevel;
use crate::{
    error::{Error, ErrorCode, Result, suggestion},
    math::{
        expression::Formula,
        format::three_digits,
        table::{self, ColumnName},
        time_series::TimeSeries,
    },
    plan::{Align, CheckPlan, Reference, ResponseReference, Score, StatisticKind, StatisticPlan},
    probe::{ProbeConfig, ProbePlan},
    scene::{
        context::{Context, Defaults, FileNote, quoted_list, set_keys},
        files, finite_law,
        record::{self, Record},
    },
};

/// Largest difference between the depth of a reflection and that of the scene, over the latter and besides one dp, without a note, –.
const OTHER_DEPTH: f64 = 0.05;

/// Round-off of a time, over the interval between readings.
const ROUND_OFF: f64 = 1e-9;

/// A section `[[check]]`: compares a column of a probe with a column of a reference table, or with a formula.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct CheckConfig {
    /// `probe.column`, as in `box.heave_m`.
    pub series: String,
    /// The reference table, beside the scene.
    pub reference: Option<String>,
    /// Its column of values.
    pub column: Option<ColumnName>,
    /// Its column of times, s.
    pub time: Option<ColumnName>,
    /// Factor on its values, –.
    pub scale: Option<f64>,
    /// Factor on its times, –.
    pub time_factor: Option<f64>,
    /// Time added to its times, s.
    #[schemars(extend("also" = "delay"))]
    pub offset: Option<f64>,
    /// The reference as a formula in the run's time t (s), in place of a table.
    pub formula: Option<String>,
    /// The reference as a response to a regular wave, in place of a table.
    pub response: Option<ResponseConfig>,
    /// First time of the run that counts, s.
    pub from: Option<f64>,
    /// Last time of the run that counts, s.
    pub until: Option<f64>,
    /// Time of the run at which the instrument was set to zero, s.
    pub zero: Option<f64>,
    /// Time over which the instrument takes its mean, s.
    pub mean: Option<f64>,
    /// How the run is moved in time to lie on its reference.
    pub align: Option<Align>,
    /// The scores of the paper.
    pub paper: Option<Score>,
    /// The scores that the run must reach.
    pub bound: Option<Score>,
}

/// What the fundamental of a series is to that of another series of the run; means and drifts do not count.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct ResponseConfig {
    /// The other series, as `gauge.eta_m`.
    pub to: String,
    /// Period of the wave, s.
    pub period: f64,
    /// Amplitude over that of the other series, in the units of both.
    pub ratio: f64,
    /// Lag behind the other series, in periods.
    pub lag: Option<f64>,
    /// First time of the other series that counts, s.
    pub from: Option<f64>,
    /// Last time of the other series that counts, s.
    pub until: Option<f64>,
}

/// One `[[statistic]]`: exactly one of waves, reflection and rao. A series is `probe.column`; the name of a probe alone
/// means the elevations of a gauge or of a row of them, the displacements and turns of a motion.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[non_exhaustive]
pub struct StatisticConfig {
    /// Its name.
    pub name: Option<String>,
    /// A series: its extremes, mean, deviation, single waves and spectrum.
    pub waves: Option<String>,
    /// Reflection: gauges in the order in which incident waves pass them.
    pub reflection: Option<Vec<String>>,
    /// Response amplitude operator.
    pub rao: Option<RaoConfig>,
    /// Period of regular waves, s; by default all waves about the peak.
    pub period: Option<f64>,
    /// Depth at the gauges, m.
    pub depth: Option<f64>,
    /// First time of the run that counts, s.
    pub from: Option<f64>,
    /// Last time of the run that counts, s.
    pub until: Option<f64>,
}

/// A motion and the wave that excites it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct RaoConfig {
    /// A series, or the name of a motion.
    pub motion: String,
    /// A series, or the name of a gauge.
    pub wave: String,
}

/// The series of a run: its probes with their names.
pub(crate) struct ProbeSeries<'a> {
    /// The probes.
    pub(crate) probes: &'a [ProbeConfig],
    /// Their names, in the same order.
    pub(crate) names: &'a [String],
}

/// A series, and the position of the gauge (m) if it is an elevation.
type SeriesAtPlace = (String, Option<Vec<f64>>);

impl ProbeSeries<'_> {
    /// The number of the probe of this name.
    fn probe(&self, ctx: &Context, key: &str, name: &str) -> Result<usize> {
        self.names.iter().position(|known| known == name).ok_or_else(|| {
            let names: Vec<&str> = self.names.iter().map(String::as_str).collect();
            let what = format!("no probe is called \"{name}\"{}", suggestion(name, names.iter().copied()));
            let help = match names.is_empty() {
                true => "the scene has no probe; one is  [[probe]]  with  motion = \"box\"".into(),
                false => format!("known: {}", names.join(", ")),
            };
            ctx.error_with_help(key, what, help).with_code(ErrorCode::UnknownName)
        })
    }

    /// Refuses a `word` that is not a column of a probe.
    fn require_column(&self, ctx: &Context, key: &str, word: &str) -> Result<()> {
        let Some((name, _)) = word.split_once('.') else {
            return Err(ctx.error_at(key, "a series is a probe and its column, with a point between"));
        };
        let i = self.probe(ctx, key, name)?;
        if self.probes[i].contacts.is_some() { Err(list_has_no_series(ctx, key, name)) } else { Ok(()) }
    }

    /// The series that `word` names.
    fn find(&self, ctx: &Context, key: &str, word: &str) -> Result<Vec<SeriesAtPlace>> {
        let (name, column) = word.split_once('.').map_or((word, None), |(name, column)| (name, Some(column)));
        let i = self.probe(ctx, key, name)?;
        let Some(plan) = self.probes[i].to_plan(ctx.until) else {
            return Err(list_has_no_series(ctx, key, name));
        };
        let series = plan.kind.series(ctx.dimension).into_iter();
        let all: Vec<SeriesAtPlace> = series.map(|(column, at)| (format!("{name}.{column}"), at)).collect();
        match column {
            Some(_) => Ok(vec![all.into_iter().find(|(series, _)| series == word).unwrap_or((word.into(), None))]),
            None if all.is_empty() => {
                let help = "a series is a probe and its column with a point between, as in \"box.heave_m\"";
                Err(ctx.error_with_help(key, format!("which column of \"{name}\" is meant?"), help))
            }
            None => Ok(all),
        }
    }
}

impl CheckConfig {
    /// Refuses a check of an unknown series, without a reference, or with impossible times or bounds.
    pub(crate) fn verify(&self, ctx: &Context, key: &str, series: &ProbeSeries) -> Result<()> {
        series.require_column(ctx, &format!("{key}.series"), &self.series)?;
        self.verify_reference(ctx, key)?;
        if let Some(response) = &self.response {
            series.require_column(ctx, &format!("{key}.response.to"), &response.to)?;
            response.verify(ctx, &format!("{key}.response"))?;
        }
        self.verify_times(ctx, key)?;
        self.verify_figures(ctx, key)
    }

    /// Fills in the defaults.
    pub(crate) fn fill(&mut self, defaults: &mut Defaults, key: &str) {
        if self.formula.is_none() && self.response.is_none() {
            defaults.fill(format!("{key}.time"), &mut self.time, "t_s".into(), "the name our own tables have");
            defaults.fill(format!("{key}.scale"), &mut self.scale, 1.0, "as in the table");
            defaults.fill(format!("{key}.time_factor"), &mut self.time_factor, 1.0, "as in the table");
            defaults.fill(format!("{key}.offset"), &mut self.offset, 0.0, "the clocks agree");
        }
    }

    /// Refuses a reference that is not exactly one of a table, a formula and a response.
    fn verify_reference(&self, ctx: &Context, key: &str) -> Result<()> {
        let of_table = [
            ("reference", self.reference.is_some()),
            ("column", self.column.is_some()),
            ("time", self.time.is_some()),
            ("scale", self.scale.is_some()),
            ("time_factor", self.time_factor.is_some()),
            ("offset", self.offset.is_some()),
        ];
        let kind = if self.response.is_some() { "response" } else { "formula" };
        if let Some((word, _)) =
            of_table.iter().find(|(_, given)| *given && (self.formula.is_some() || kind == "response"))
        {
            let what = format!("a check by a {kind} has no {word}: that is of a table");
            let help = format!("give either {kind}, or reference and column");
            return Err(ctx.error_with_help(&format!("{key}.{word}"), what, help));
        }
        match (&self.formula, &self.response) {
            (Some(_), Some(_)) => {
                let what = "a check has one reference, and this one has a formula and a response";
                Err(ctx.error_with_help(&format!("{key}.response"), what, "remove one of them"))
            }
            (Some(text), None) => {
                let place = |e: Error| ctx.with_location(e, &format!("{key}.formula"));
                let formula = Formula::parse(text).map_err(place)?;
                let span = [self.from.unwrap_or(0.0), self.until.unwrap_or(ctx.until)];
                // An alignment moves the clock of the formula by a time that is known after the run.
                match self.align {
                    None => finite_law::require_finite(ctx, &format!("{key}.formula"), text, &formula, span),
                    Some(_) => Ok(()),
                }
            }
            (None, Some(_)) => self.verify_response_alone(ctx, key),
            (None, None) => match of_table[..2].iter().find(|(_, given)| !given) {
                Some((word, _)) => {
                    let what = format!("\"{word}\" is missing: a check needs something to be held against");
                    Err(ctx.error_at(&format!("{key}.{word}"), what))
                }
                None => record::verify_scaling(ctx, key, [self.scale, self.time_factor, self.offset]),
            },
        }
    }

    /// Refuses keys beside a response that it does not use.
    fn verify_response_alone(&self, ctx: &Context, key: &str) -> Result<()> {
        let unused =
            set_keys([("zero", self.zero.is_some()), ("mean", self.mean.is_some()), ("align", self.align.is_some())]);
        let Some(word) = unused.first() else { return Ok(()) };
        let what = format!("a check by a response has no {word}: means do not count, and its lag gives the delay");
        Err(ctx.error_with_help(&format!("{key}.{word}"), what, "remove it"))
    }

    /// Refuses times out of range.
    fn verify_times(&self, ctx: &Context, key: &str) -> Result<()> {
        ctx.require_positive(&format!("{key}.mean"), self.mean)?;
        if let Some(zero) = self.zero.filter(|zero| !(*zero >= 0.0 && zero.is_finite())) {
            return Err(
                ctx.error_at(&format!("{key}.zero"), format!("zero is a time of the run, and {zero} s is none"))
            );
        }
        match self.align {
            Some(Align::Crossing(threshold)) => {
                ctx.require_positive(&format!("{key}.align.crossing"), Some(threshold))?
            }
            Some(Align::Start(threshold)) => ctx.require_positive(&format!("{key}.align.start"), Some(threshold))?,
            Some(Align::Best) | None => {}
        }
        let help = "until is the later time, in the run's own time";
        ctx.require_interval(key, self.from, self.until, help)
    }

    /// Refuses bounds on figures that the check does not compute.
    fn verify_figures(&self, ctx: &Context, key: &str) -> Result<()> {
        let Some(bound) = self.bound else { return Ok(()) };
        let figures = [
            ("N", bound.relative_l2),
            ("M", bound.amplitude_ratio),
            ("peak", bound.peak),
            ("off", bound.off),
            ("aligned_N", bound.aligned_relative_l2),
            ("delay", bound.delay),
            ("period", bound.period),
        ];
        if let Some((word, figure)) = figures.iter().find(|(_, figure)| figure.is_some_and(|x| x < 0.0)) {
            let what = format!("{word} is the largest that passes, and {} is below 0", figure.unwrap_or_default());
            return Err(ctx.error_at(&format!("{key}.bound.{word}"), what));
        }
        if bound.period.is_some() && self.response.is_none() {
            let what = "the bound names period, which only a response has";
            return Err(ctx.error_with_help(&format!("{key}.bound.period"), what, "remove it"));
        }
        let aligned = figures[4..6].iter().find(|(_, figure)| figure.is_some());
        if let (Some(ResponseConfig { lag: None, .. }), Some((word, _))) = (&self.response, aligned) {
            let what = format!("the bound names {word}, but the response has no lag");
            let help = "write  lag = 0.25, in periods, in the response";
            return Err(ctx.error_with_help(&format!("{key}.bound.{word}"), what, help));
        }
        if self.response.is_none()
            && matches!(self.align, None | Some(Align::Start(_)))
            && let Some((word, _)) = aligned
        {
            let what = format!("the bound names {word}, but nothing is aligned");
            return Err(ctx.error_with_help(
                &format!("{key}.bound.{word}"),
                what,
                "write  align = \"best\"  in this check",
            ));
        }
        Ok(())
    }

    /// Refuses times between which the reference has fewer than two samples.
    fn require_samples(&self, ctx: &Context, key: &str, file: &str, series: &TimeSeries) -> Result<()> {
        let (from, until) = (self.from.unwrap_or(f64::NEG_INFINITY), self.until.unwrap_or(f64::INFINITY));
        let within = series.times().iter().filter(|t| (from..=until).contains(*t)).count();
        let is_limited = self.from.or(self.until).is_some();
        if within >= 2 || !is_limited || self.align.is_some() {
            return Ok(());
        }
        let word = if self.from.is_some() { "from" } else { "until" };
        let (first, last) = series.span();
        let what = format!("the check has {within} samples of {file} between its times, and needs two or more");
        let help = format!("{file} goes from {first} to {last} s: give  from  and  until  within it");
        Err(ctx.error_with_help(&format!("{key}.{word}"), what, help).with_code(ErrorCode::OutOfRange))
    }

    /// Notes that the run covers too little of the reference to judge it.
    fn note_uncovered(&self, ctx: &Context, file: &str, series: &TimeSeries) {
        let (from, until) = (self.from.unwrap_or(f64::NEG_INFINITY), self.until.unwrap_or(f64::INFINITY));
        let counted = || series.times().iter().filter(|t| (from..=until).contains(*t));
        let (all, covered) = (counted().count(), counted().filter(|t| (0.0..=ctx.until).contains(*t)).count());
        let is_judged = covered >= 2 && (2 * covered >= all || self.bound.is_none());
        if is_judged || self.align.is_some() || from >= ctx.until {
            return;
        }
        let (first, last) = series.span();
        let what = format!(
            "the check of \"{}\" is not judged: the run, from 0 to {} s, covers {covered} of the {all} samples of {file} that \
             count, from {first} to {last} s",
            self.series, ctx.until
        );
        let remedy = "run longer, end the check earlier by  until, or move the samples by  offset".into();
        ctx.add_note(FileNote { is_warning: false, topic: "event_after_end", what, remedy });
    }

    /// Notes that the time range of a check lies outside the run, or between two readings. A time range after the end of the run
    /// is another finding.
    fn note_time_range(&self, ctx: &Context, probes: &[ProbePlan]) {
        let mut ranges = vec![(&self.series, self.from, self.until)];
        ranges.extend(self.response.iter().map(|of| (&of.to, of.from.or(self.from), of.until.or(self.until))));
        for (series, from, until) in ranges {
            let Some((probe, column)) = ProbePlan::of_series(probes, series) else { continue };
            if self.reference.is_some() || from.or(until).is_none() || matches!(self.align, Some(Align::Start(_))) {
                continue;
            }
            let (first, last) = (from.unwrap_or(0.0), until.unwrap_or(ctx.until));
            // A mean belongs to half an interval before its row. The last row is at the end of the run.
            let delay = if probe.is_mean(column) { 0.5 * probe.every } else { 0.0 };
            let rows_until =
                |t: f64| if t >= ctx.until { (ctx.until / probe.every).ceil() } else { (t / probe.every).floor() };
            let first_row = ((first.max(0.0) + delay) / probe.every - ROUND_OFF).ceil();
            if first >= ctx.until || rows_until(last + delay + ROUND_OFF * probe.every) - first_row >= 1.0 {
                continue;
            }
            let what = format!(
                "the check of \"{}\" has less than two readings of \"{series}\" from {first} to {last} s: the run, from 0 to {} s, \
                 reads it every {} s",
                self.series, ctx.until, probe.every
            );
            let remedy = "give  from  and  until  within the run, with two readings between them".into();
            ctx.add_note(FileNote { is_warning: false, topic: "event_after_end", what, remedy });
        }
    }

    /// Returns the check of the run. Opens its table and verifies that it has the columns.
    pub(crate) fn build(&self, ctx: &Context, key: &str, probes: &[ProbePlan]) -> Result<CheckPlan> {
        let reference = match (&self.formula, &self.response) {
            (Some(text), _) => Reference::Formula(text.clone()),
            (None, Some(response)) => Reference::Response(response.plan()),
            (None, None) => {
                let file = self.reference.clone().unwrap_or_default();
                let time = self.time.clone().unwrap_or_else(|| "t_s".into());
                let column = self.column.clone().unwrap_or_default();
                let scaling = record::scaling([self.scale, self.time_factor, self.offset]);
                let open = files::open_table(ctx.folder(), &file);
                let table =
                    open.map_err(|e| ctx.with_location(files::with_line_in_message(e), &format!("{key}.reference")))?;
                let mut record = Record {
                    ctx,
                    key,
                    file: &file,
                    table,
                    time: time.clone(),
                    column: column.clone(),
                    scaling,
                    unit: table::of_series(&self.series),
                };
                let series = record.read()?;
                let series = series.scaled(&scaling).map_err(|e| ctx.with_location(e, &format!("{key}.scale")))?;
                self.require_samples(ctx, key, &file, &series)?;
                self.note_uncovered(ctx, &file, &series);
                Reference::Table { file: Path::new(&file).to_path_buf(), time, column, scaling }
            }
        };
        let mut plan = CheckPlan {
            series: self.series.clone(),
            reference,
            from: self.from,
            until: self.until,
            zero: self.zero,
            mean: self.mean,
            align: self.align,
            paper: self.paper,
            bound: self.bound,
            means: Vec::new(),
        };
        let are_means = |series: &&String| {
            ProbePlan::of_series(probes, series).is_some_and(|(probe, column)| probe.is_mean(column))
        };
        plan.means = plan.series_names().filter(are_means).cloned().collect();
        self.note_time_range(ctx, probes);
        Ok(plan)
    }
}

impl ResponseConfig {
    /// Refuses numbers out of range.
    fn verify(&self, ctx: &Context, key: &str) -> Result<()> {
        ctx.require_positive(&format!("{key}.period"), Some(self.period))?;
        ctx.require_positive(&format!("{key}.ratio"), Some(self.ratio))?;
        if let Some(lag) = self.lag.filter(|lag| !lag.is_finite()) {
            return Err(ctx.error_at(&format!("{key}.lag"), format!("a lag is a number of periods, and {lag} is none")));
        }
        ctx.require_interval(key, self.from, self.until, "until is the later time, in the run's own time")
    }

    fn plan(&self) -> ResponseReference {
        ResponseReference {
            to: self.to.clone(),
            period: self.period,
            ratio: self.ratio,
            lag: self.lag,
            from: self.from,
            until: self.until,
        }
    }
}

impl StatisticConfig {
    /// The keys that give its kind.
    fn named_kinds(&self) -> Vec<&'static str> {
        set_keys([
            ("waves", self.waves.is_some()),
            ("reflection", self.reflection.is_some()),
            ("rao", self.rao.is_some()),
        ])
    }

    /// Refuses a statistic that is not of exactly one kind, of unknown series, or with keys of another kind.
    pub(crate) fn verify(&self, ctx: &Context, key: &str, series: &ProbeSeries) -> Result<()> {
        if self.named_kinds().len() != 1 {
            let what = format!("a statistic is of one kind; this one of {}", quoted_list(&self.named_kinds()));
            let help = "one of waves, reflection, rao; a [[statistic]] section for each";
            return Err(ctx.error_with_help(key, what, help));
        }
        ctx.require_positive(&format!("{key}.period"), self.period)?;
        ctx.require_positive(&format!("{key}.depth"), self.depth)?;
        if let Some(name) = &self.name {
            ctx.require_file_name(&format!("{key}.name"), name)?;
        }
        let foreign = set_keys([
            ("period", self.period.is_some() && self.waves.is_some()),
            ("depth", self.depth.is_some() && self.reflection.is_none()),
        ]);
        if let Some(word) = foreign.first() {
            let what = format!("{} needs no {word}", self.named_kinds()[0]);
            return Err(ctx.error_with_help(&format!("{key}.{word}"), what, "remove it"));
        }
        ctx.require_interval(key, self.from, self.until, "until is the later time of the run")?;
        self.kind(ctx, series, key, 1.0, 1.0).map(|_| ())
    }

    /// The statistic, over water at rest.
    pub(crate) fn build(
        &self,
        ctx: &Context,
        key: &str,
        series: &ProbeSeries,
        still: &StillWaterLevel,
    ) -> Result<StatisticPlan> {
        let depth = self.depth.unwrap_or(still.depth);
        if (depth - still.depth).abs() > OTHER_DEPTH * still.depth + ctx.dp {
            let [given, deep] = [depth, still.depth].map(three_digits);
            let what = format!("{key} is for water {given} m deep, and that of the scene is {deep} m deep");
            let mend = "leave depth out, unless the bed below the gauges is at another height";
            ctx.add_note(FileNote::note("other_depth", what, mend.into()));
        }
        Ok(StatisticPlan {
            name: self.name.clone().unwrap_or_default(),
            what: self.kind(ctx, series, key, depth, ctx.gravity_norm())?,
            from: self.from,
            until: self.until,
        })
    }

    /// The quantity over water of this `depth` (m) under gravity `g` (m/s²).
    fn kind(&self, ctx: &Context, series: &ProbeSeries, key: &str, depth: f64, g: f64) -> Result<StatisticKind> {
        let period = self.period;
        let plain = |found: Vec<SeriesAtPlace>| found.into_iter().map(|(series, _)| series).collect::<Vec<_>>();
        match self {
            StatisticConfig { waves: Some(word), .. } => {
                Ok(StatisticKind::Waves { series: plain(series.find(ctx, &format!("{key}.waves"), word)?) })
            }
            StatisticConfig { reflection: Some(config), .. } => {
                let key = format!("{key}.reflection");
                let mut gauges = Vec::new();
                for word in config {
                    gauges.extend(series.find(ctx, &key, word)?);
                }
                Ok(StatisticKind::Reflection { gauges: gauge_positions(ctx, &key, gauges)?, depth, g, period })
            }
            StatisticConfig { rao: Some(RaoConfig { motion, wave }), .. } => {
                let motions = plain(series.find(ctx, &format!("{key}.rao.motion"), motion)?);
                let key = format!("{key}.rao.wave");
                match &plain(series.find(ctx, &key, wave)?)[..] {
                    [wave] => Ok(StatisticKind::Rao { motions, wave: wave.clone(), period }),
                    _ => Err(ctx.error_with_help(
                        &key,
                        format!("\"{wave}\" is more than one series"),
                        "name one, as in \"gauge.eta_m\"",
                    )),
                }
            }
            _ => Err(ctx.error_at(key, "what is it of?")),
        }
    }
}

/// Gauges with their distance from the first in the direction of the last, m.
fn gauge_positions(ctx: &Context, key: &str, gauges: Vec<SeriesAtPlace>) -> Result<Vec<(String, f64)>> {
    let help = "name three elevation gauges, or a row of them, in the order in which waves pass them";
    let wrong = |what: String| ctx.error_with_help(key, what, help);
    let places: Option<Vec<Vec<f64>>> = gauges.iter().map(|(_, at)| at.clone()).collect();
    let Some(places) = places else {
        return Err(wrong("what is reflected is told by elevation gauges, and one of these is none".into()));
    };
    let (Some(first), Some(last)) = (places.first(), places.last().filter(|_| places.len() > 1)) else {
        return Err(wrong(format!("{} gauge cannot tell what comes from what goes", places.len())));
    };
    let way: Vec<f64> = first.iter().zip(last).map(|(a, b)| b - a).collect();
    let length = way.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length == 0.0 {
        return Err(wrong("the first gauge stands where the last does".into()));
    }
    let far = |at: &Vec<f64>| at.iter().zip(first).zip(&way).map(|((x, o), w)| (x - o) * w).sum::<f64>() / length;
    Ok(gauges.iter().zip(&places).map(|((series, _), at)| (series.clone(), far(at))).collect())
}

/// The error that the probe `name` is a list of contacts and has no series.
fn list_has_no_series(ctx: &Context, key: &str, name: &str) -> Error {
    let what = format!("\"{name}\" lists all contacts, many at one time, and has no series");
    let help = "of two solids there is one in a [[probe]] of their own:  contact = [\"crate\", \"raft\"]";
    ctx.error_with_help(key, what, help)
}

/// The default name of each statistic: its kind, with a number from the second on.
pub(crate) fn default_names(statistics: &[StatisticConfig]) -> Vec<String> {
    let mut kinds: Vec<&str> = Vec::new();
    let name = |entry: &StatisticConfig| {
        let kind = entry.named_kinds().first().copied().unwrap_or("statistic");
        kinds.push(kind);
        match kinds.iter().filter(|before| **before == kind).count() {
            1 => kind.to_string(),
            n => format!("{kind}_{n}"),
        }
    };
    statistics.iter().map(name).collect()
}

/// Refuses two statistics of one name, whose rows could not be told apart.
///
/// # Errors
/// `Scene`, at the later one.
pub(crate) fn require_different_names(ctx: &Context, statistics: &[StatisticConfig]) -> Result<()> {
    let is_taken = |i: &usize| statistics[..*i].iter().any(|before| before.name == statistics[*i].name);
    let Some(i) = (1..statistics.len()).find(is_taken) else { return Ok(()) };
    let name = statistics[i].name.as_deref().unwrap_or_default();
    let what = format!("two statistics are called \"{name}\"");
    Err(ctx.error_with_help(&format!("statistic.{i}.name"), what, "give each statistic a name of its own"))
}
