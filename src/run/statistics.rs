//! The statistics of a run's series at its end: `statistics.csv`, with a row for each value.

mod rao_table;
mod spectra_table;

use std::{collections::BTreeMap, f64::consts::PI, path::Path};

use serde::Serialize;

use super::{outputs::series_folder, run_folder::scene_file};
use crate::{
    analysis::{
        self, LARGEST_GAP, RaoPoint, gaps_hide_waves, moments_of_readings, rao, rao_over_frequency, reflection,
        spectrum,
    },
    error::{Error, ErrorKind, Result, suggestion},
    math::{
        format::{three_digits, unit},
        readings::Readings,
        time_series::TimeSeries,
    },
    output::{Manifest, SeriesTable, write_atomically},
    plan::{Plan, StatisticKind, StatisticPlan},
    probe::ProbePlan,
    scene::Scene,
};

pub use rao_table::{RAO_FILE, RaoResult};
pub use spectra_table::SPECTRA_FILE;

/// Name of the statistics file in the run's folder.
pub(crate) const STATISTICS_FILE: &str = "statistics.csv";

/// Least span of the readings for a harmonic over its period: the last reading may be a part of it before the end.
const SHORTEST_SPAN: f64 = 0.9;

/// Largest height of reflected waves over that of incident ones; a full reflection measures 1 within some per cent.
const LARGEST_REFLECTION: f64 = 1.1;

/// A statistic of one or several series.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Statistic {
    /// Name of the `[[statistic]]`; empty for a statistic that is computed for every series.
    pub name: String,
    /// Name of the series as `probe.column`: for a reflection the series of the first gauge, for an RAO the series of
    /// the motion.
    pub series: String,
    /// Name of the quantity, as `H_max`.
    pub quantity: &'static str,
    /// Value of the quantity.
    pub value: f64,
    /// Unit of the value.
    pub unit: String,
    /// First time that is evaluated, s.
    pub from_s: f64,
    /// Last time that is evaluated, s.
    pub until_s: f64,
}

/// A filter for the statistics of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StatisticsFilter {
    /// The only probe or the only series to evaluate.
    pub series: Option<String>,
    /// First time to evaluate, s.
    pub from: Option<f64>,
    /// Last time to evaluate, s.
    pub until: Option<f64>,
}

/// The statistics of a run, and the reasons for missing statistics.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunStatistics {
    /// The statistics.
    pub rows: Vec<Statistic>,
    /// The RAOs of motions in irregular waves, over frequency.
    pub raos: Vec<RaoResult>,
    /// The reasons for missing statistics.
    pub remarks: Vec<String>,
}

/// Returns the statistics of the run in `folder`, which may be unfinished.
///
/// # Errors
/// `Restart` if `folder` holds no run; `Usage` if the run has no such series; otherwise as [`Scene::read`].
pub fn statistics(folder: &Path, asked: &StatisticsFilter) -> Result<RunStatistics> {
    let manifest = Manifest::read(folder)?;
    let sets: Vec<(String, String)> = manifest.set.into_iter().collect();
    let plan = Scene::read(&scene_file(&folder.join("scene")), &sets)?.plan()?;
    let tables = read_tables(folder, &plan);
    let mut told = from_tables(&tables, &plan, asked);
    let names: Vec<&str> = plan.probes.iter().map(|probe| probe.name.as_str()).collect();
    let missing = missing_tables(folder, &plan);
    if !names.is_empty() && missing.len() == names.len() {
        let what =
            format!("{} has none of the tables of the run: {}", series_folder(folder).display(), names.join(", "));
        let help = "put them back, each as NAME.csv, or start the run afresh with `pontoon run`";
        return Err(Error::new(ErrorKind::Restart, what).help(help));
    }
    told.remarks.extend(damages(&missing, &tables));
    if told.rows.is_empty() {
        require_known_series(folder, &tables, &names, asked)?;
        check_time_range(folder, &tables, asked)?;
    }
    Ok(told)
}

/// Checks that the requested series is one of `tables`, or all series of a probe of `names`.
fn require_known_series(folder: &Path, tables: &ProbeTables, names: &[&str], asked: &StatisticsFilter) -> Result<()> {
    let Some(series) = &asked.series else { return Ok(()) };
    let of_table = |(probe, table): (&String, &SeriesTable)| -> Vec<String> {
        table.columns.iter().map(|column| format!("{probe}.{column}")).collect()
    };
    let known: Vec<String> =
        tables.iter().flat_map(of_table).chain(names.iter().map(|name| name.to_string())).collect();
    if known.contains(series) {
        return Ok(());
    }
    let near = suggestion(series, known.iter().map(String::as_str));
    let what = format!("there is nothing to tell of {series:?} in {}{near}", folder.display());
    Err(Error::new(ErrorKind::Usage, what).help(format!("the probes are: {}", names.join(", "))))
}

/// Returns the reason why no series has statistics in the requested time range of the run in `folder`. Returns `Ok` if no
/// series and no time range is requested.
fn check_time_range(folder: &Path, tables: &ProbeTables, asked: &StatisticsFilter) -> Result<()> {
    let times = || tables.values().flat_map(|table| table.times.first().into_iter().chain(table.times.last()));
    let [first, last] = [times().copied().fold(f64::INFINITY, f64::min), times().copied().fold(0.0, f64::max)];
    let (run, from, until) = (folder.display(), asked.from.unwrap_or(first), asked.until.unwrap_or(last));
    let series = asked.series.as_ref().map_or("no series".into(), |series| format!("{series:?}"));
    let has = if asked.series.is_some() { "has no" } else { "has" };
    let what = match () {
        () if tables.is_empty() || (asked.from.or(asked.until).is_none() && asked.series.is_none()) => return Ok(()),
        () if from > until => format!("from {from} s until {until} s there is no time"),
        () if from >= last && from > first => {
            format!("the readings in {run} end at {last} s: there are none after {from} s")
        }
        () if until <= first && until < last => {
            format!("the readings in {run} begin at {first} s: there are none before {until} s")
        }
        () => format!("{series} in {run} {has} two readings from {from} s until {until} s"),
    };
    let help = format!("choose --from and --until between {first} and {last} s");
    Err(Error::new(ErrorKind::Usage, what).help(help))
}

/// Writes the statistics and the spectra of the run in `folder`, and returns the reasons for missing statistics.
///
/// # Errors
/// `File` if a file cannot be written.
pub(super) fn write(folder: &Path, plan: &Plan) -> Result<Vec<String>> {
    let tables = read_tables(folder, plan);
    let RunStatistics { rows, raos, remarks } = from_tables(&tables, plan, &StatisticsFilter::default());
    let mut text = String::from("name,series,quantity,value,unit,from_s,until_s\n");
    for Statistic { name, series, quantity, value, unit, from_s, until_s } in rows {
        text += &format!("{name},{series},{quantity},{value:?},{unit},{from_s:?},{until_s:?}\n");
    }
    write_atomically(&folder.join(STATISTICS_FILE), text.as_bytes())?;
    rao_table::write(folder, &raos)?;
    spectra_table::write(folder, &tables)?;
    Ok(remarks)
}

/// The tables of a run by the names of their probes; tables that cannot be read are absent.
type ProbeTables = BTreeMap<String, SeriesTable>;

/// Reads the tables of the run in `folder`.
fn read_tables(folder: &Path, plan: &Plan) -> ProbeTables {
    let series = series_folder(folder);
    let read = |probe: &ProbePlan| {
        let table = SeriesTable::read(&series.join(format!("{}.csv", probe.name))).ok()?;
        Some((probe.name.clone(), table.with_means(|column| probe.is_mean(column))))
    };
    plan.probes.iter().filter_map(read).collect()
}

/// Returns the names of the tables that the run in `folder` should have and has not.
fn missing_tables<'a>(folder: &Path, plan: &'a Plan) -> Vec<&'a str> {
    let series = series_folder(folder);
    let names = plan.probes.iter().map(|probe| probe.name.as_str());
    names.filter(|name| !series.join(format!("{name}.csv")).is_file()).collect()
}

/// Returns a sentence for each table that is missing or damaged.
fn damages(missing: &[&str], tables: &ProbeTables) -> Vec<String> {
    let missing = missing.iter().map(|name| format!("series/{name}.csv is missing: its series are left out"));
    missing.chain(tables.iter().filter_map(|(name, table)| table.damage(name))).collect()
}

/// Returns the statistics of the whole run in `folder`, and a sentence for each table that is missing or damaged.
#[cfg(feature = "cli")]
pub(crate) fn run_statistics(folder: &Path, plan: &Plan) -> (RunStatistics, Vec<String>) {
    let tables = read_tables(folder, plan);
    let damages = damages(&missing_tables(folder, plan), &tables);
    (from_tables(&tables, plan, &StatisticsFilter::default()), damages)
}

/// Returns the statistics of `tables`.
fn from_tables(tables: &ProbeTables, plan: &Plan, asked: &StatisticsFilter) -> RunStatistics {
    let window = (asked.from.unwrap_or(f64::NEG_INFINITY), asked.until.unwrap_or(f64::INFINITY));
    let meant = |name: &str| {
        asked.series.as_deref().is_none_or(|of| of == name || name.split_once('.').is_some_and(|n| n.0 == of))
    };
    let mut told = RunStatistics::default();
    for probe in &plan.probes {
        let columns = tables.get(&probe.name).into_iter().flat_map(|table| &table.columns);
        let meant = columns.filter(|column| meant(&format!("{}.{column}", probe.name)));
        let known: Vec<(&String, Readings)> = meant
            .filter_map(|column| Some((column, tables[&probe.name].readings(column, window.0, window.1)?)))
            .collect();
        known.iter().for_each(|(column, of)| told.push_series("", &format!("{}.{column}", probe.name), of));
        told.remarks.extend(remark_on_gaps(&probe.name, &known));
    }
    for words in &plan.statistics {
        if words.what.series().into_iter().any(meant) {
            let from = words.from.map_or(window.0, |from| from.max(window.0));
            let until = words.until.map_or(window.1, |until| until.min(window.1));
            told.push_declared(tables, words, (from, until));
        }
    }
    told
}

/// Returns the readings of the series `name` in the time window (s).
fn readings_in_window(tables: &ProbeTables, name: &str, (from, until): (f64, f64)) -> Option<Readings> {
    let (probe, column) = name.split_once('.')?;
    tables.get(probe)?.readings(column, from, until)
}

/// Returns a remark for each probe with missing readings between others, from its `columns` with their readings.
fn remark_on_gaps(probe: &str, columns: &[(&String, Readings)]) -> Option<String> {
    let with_gaps = || columns.iter().filter(|(_, readings)| readings.longest_gap() > 0.0);
    let (column, worst) = with_gaps().max_by(|a, b| a.1.longest_gap().total_cmp(&b.1.longest_gap()))?;
    let others = match with_gaps().count() - 1 {
        0 => String::new(),
        count => format!(", the worst of {} columns of {probe}", count + 1),
    };
    let [share, gap] = [100.0 * worst.missing_share(), worst.longest_gap()].map(three_digits);
    let waves = match with_gaps().any(|(_, readings)| gaps_hide_waves(readings)) {
        true => format!("; waves and spectra are not given over gaps of more than {LARGEST_GAP} mean periods"),
        false => String::new(),
    };
    Some(format!(
        "{probe}.{column}{others}: {share} % of its readings are missing, at most for {gap} s; means leave gaps out{waves}"
    ))
}

/// Returns the remark that a series of the statistic is shorter than its period.
fn too_short(words: &StatisticPlan, found: &[Readings]) -> Option<String> {
    let (StatisticKind::Reflection { period, .. } | StatisticKind::Rao { period, .. }) = words.what else {
        return None;
    };
    let lasts = found.iter().map(|of| of.series().span().1 - of.series().span().0).fold(f64::INFINITY, f64::min);
    let period = period.filter(|period| lasts < SHORTEST_SPAN * period)?;
    let (name, lasts) = (&words.name, three_digits(lasts));
    Some(format!("statistic {name}: its readings span {lasts} s, less than a period of {period} s: nothing is told"))
}

impl RunStatistics {
    fn push(&mut self, name: &str, series: &str, span: (f64, f64), figures: &[(&'static str, f64, &str)]) {
        self.rows.extend(figures.iter().filter(|figure| figure.1.is_finite()).map(|&(quantity, value, unit)| {
            Statistic {
                name: name.into(),
                series: series.into(),
                quantity,
                value,
                unit: unit.into(),
                from_s: span.0,
                until_s: span.1,
            }
        }));
    }

    /// Adds all statistics of one series.
    fn push_series(&mut self, name: &str, of: &str, readings: &Readings) {
        let (own, m, series) = (unit(of), moments_of_readings(readings), readings.series());
        let plain =
            [("mean", m.mean, own), ("std", m.standard_deviation, own), ("min", m.min.0, own), ("max", m.max.0, own)];
        self.push(name, of, series.span(), &plain);
        let Some(w) = analysis::waves_of_readings(readings) else { return };
        let count = w.count as f64;
        let waves = [
            ("waves", count, "–"),
            ("H_mean", w.mean_height, own),
            ("H_third", w.significant_height, own),
            ("H_max", w.max_height, own),
            ("T_z", w.mean_period, "s"),
            ("T_third", w.significant_period, "s"),
        ];
        self.push(name, of, series.span(), &waves);
        if let Some(s) = spectrum(series) {
            let spectral =
                [("H_m0", s.significant_height(), own), ("T_p", s.peak_period(), "s"), ("T_m02", s.mean_period(), "s")];
            self.push(name, of, series.span(), &spectral);
        }
    }

    /// Adds the RAO of a motion in irregular waves over frequency.
    fn push_rao(&mut self, name: &str, series: &str, unit: &str, bands: Vec<RaoPoint>) {
        let answer = |band| RaoResult { name: name.into(), series: series.into(), unit: unit.into(), point: band };
        self.raos.extend(bands.into_iter().map(answer));
    }

    /// Adds a remark with the number of waves that an RAO over frequency requires, if the series has too few waves.
    fn remark_too_few_waves(&mut self, name: &str, wave: &TimeSeries) {
        if let Some(waves) =
            analysis::zero_crossing_waves(wave).filter(|waves| waves.count < analysis::MIN_WAVES_FOR_RAO)
        {
            self.remarks.push(format!(
                "statistic {name}: nothing is told over frequency: its time has {} waves, and {} are needed; of regular waves \
                 name the `period`",
                waves.count,
                analysis::MIN_WAVES_FOR_RAO
            ));
        }
    }

    /// Adds the statistics that the scene declares.
    fn push_declared(&mut self, tables: &ProbeTables, words: &StatisticPlan, window: (f64, f64)) {
        let found: Option<Vec<Readings>> =
            words.what.series().into_iter().map(|name| readings_in_window(tables, name, window)).collect();
        let Some(found) = found else {
            self.remarks.push(format!("statistic {}: a series has no two readings in its time", words.name));
            return;
        };
        if let Some(remark) = too_short(words, &found) {
            self.remarks.push(remark);
            return;
        }
        if let StatisticKind::Reflection { period: None, .. } | StatisticKind::Rao { period: None, .. } = words.what
            && found.iter().any(gaps_hide_waves)
        {
            self.remarks.push(format!(
                "statistic {}: its series have gaps of more than {LARGEST_GAP} mean periods: nothing is formed from spectra; of \
                 regular waves name the `period`",
                words.name
            ));
            return;
        }
        let all = || words.what.series().into_iter().zip(&found);
        let before = self.rows.len();
        match &words.what {
            StatisticKind::Waves { .. } => all().for_each(|(of, series)| self.push_series(&words.name, of, series)),
            StatisticKind::Reflection { gauges, depth, g, period } => {
                let (of, own) = (&gauges[0].0, unit(&gauges[0].0));
                let placed: Vec<(f64, &TimeSeries)> =
                    gauges.iter().map(|(_, x)| *x).zip(found.iter().map(Readings::series)).collect();
                if let Some(r) = reflection(&placed, *depth, *g, *period) {
                    let figures = [
                        ("reflection", r.coefficient(), "–"),
                        ("H_incident", r.incident, own),
                        ("H_reflected", r.reflected, own),
                    ];
                    self.push(&words.name, of, found[0].series().span(), &figures);
                    if r.coefficient() > LARGEST_REFLECTION {
                        self.remarks.push(format!(
                            "statistic {}: the reflected waves are {} times as high as the incident ones: name the gauges in the \
                             order in which the incident waves pass them",
                            words.name,
                            three_digits(r.coefficient())
                        ));
                    }
                }
            }
            StatisticKind::Rao { motions, wave, period } => {
                let (motion, last) = found.split_at(motions.len());
                let wave_series = last[0].series();
                if period.is_none() {
                    self.remark_too_few_waves(&words.name, wave_series);
                }
                for (of, series) in motions.iter().zip(motion.iter().map(Readings::series)) {
                    let own = format!("{}/{}", unit(of), unit(wave));
                    if period.is_none() {
                        self.push_rao(&words.name, of, &own, rao_over_frequency(series, wave_series));
                    }
                    let Some(r) = rao(series, wave_series, *period) else { continue };
                    let figures = [
                        ("rao", r.ratio, own.as_str()),
                        ("phase", r.phase * 180.0 / PI, "°"),
                        ("period", r.period, "s"),
                    ];
                    self.push(&words.name, of, series.span(), &figures);
                }
            }
        }
        if self.rows.len() == before {
            let why = "the series are too short, or the gauges stand so that they cannot tell";
            self.remarks.push(format!("statistic {}: nothing could be formed: {why}", words.name));
        }
    }
}
