//! What is said of a run's series at its end: `statistics.csv`, a row for each figure.

mod answers;
mod spectra;

use std::{collections::BTreeMap, f64::consts::PI, path::Path};

use serde::Serialize;

use super::{outputs::series_folder, scene_file};
use crate::{
    analysis::{self, Band, moments, reflection, response, spectrum, transfer},
    error::{Error, Kind, Result},
    math::format::unit,
    math::time_series::Series,
    output::{Manifest, Readings, write_whole},
    plan::{Plan, StatisticKind, StatisticWords},
    scene::Scene,
};

pub use answers::{Answer, RAO};
pub use spectra::SPECTRA;

/// The file, in the run's folder.
pub const STATISTICS: &str = "statistics.csv";

/// A figure of a series, or of several.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Statistic {
    /// Name of the `[[statistic]]`; empty for what is said of every series.
    pub name: String,
    /// Which series, as `probe.column`; of a reflection the first gauge's, of an RAO the motion's.
    pub series: String,
    /// Which figure, as `H_max`.
    pub quantity: &'static str,
    /// Its value.
    pub value: f64,
    /// Its unit.
    pub unit: String,
    /// First time that counts, s.
    pub from_s: f64,
    /// Last time that counts, s.
    pub until_s: f64,
}

/// What is asked of a run's series beside what its scene asks.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Asked {
    /// Only of this probe, or of this series.
    pub series: Option<String>,
    /// First time that counts, s.
    pub from: Option<f64>,
    /// Last time that counts, s.
    pub until: Option<f64>,
}

/// Figures of a run, and why some are missing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Told {
    /// The figures.
    pub rows: Vec<Statistic>,
    /// How motions answer irregular waves over frequency.
    pub answers: Vec<Answer>,
    /// What could not be formed, in words.
    pub remarks: Vec<String>,
}

/// The figures of the run in `folder`, however far it came.
///
/// # Errors
/// `Restart` if there is no run in `folder`; `Usage` if it has no such series; else as [`Scene::read`].
pub fn statistics(folder: &Path, asked: &Asked) -> Result<Told> {
    let manifest = Manifest::read(folder)?;
    let sets: Vec<(String, String)> = manifest.set.into_iter().collect();
    let plan = Scene::read(&scene_file(&folder.join("scene")), &sets)?.plan()?;
    let told = told(folder, &plan, asked);
    if told.rows.is_empty() {
        apart(folder, &plan, asked)?;
    }
    match &asked.series {
        Some(series) if told.rows.is_empty() => {
            let names: Vec<&str> = plan.probes.iter().map(|probe| probe.name.as_str()).collect();
            let what = format!("there is nothing to tell of {series:?} in {}", folder.display());
            Err(Error::new(Kind::Usage, what).help(format!("the probes are: {}", names.join(", "))))
        }
        _ => Ok(told),
    }
}

/// That the time asked for is not apart from that of the run in `folder`.
fn apart(folder: &Path, plan: &Plan, asked: &Asked) -> Result<()> {
    let tables = tables(folder, plan);
    let times = || tables.values().flat_map(|table| table.t.first().into_iter().chain(table.t.last()));
    let [first, last] = [times().copied().fold(f64::INFINITY, f64::min), times().copied().fold(0.0, f64::max)];
    let (run, from, until) = (folder.display(), asked.from.unwrap_or(first), asked.until.unwrap_or(last));
    let what = match () {
        () if from >= last => format!("the readings in {run} end at {last} s: there are none after {from} s"),
        () if until <= first => format!("the readings in {run} begin at {first} s: there are none before {until} s"),
        () if from > until => format!("from {from} s until {until} s there is no time"),
        () if asked.series.is_some() || asked.from.or(asked.until).is_none() => return Ok(()),
        () => format!("no series in {run} has two readings from {from} s until {until} s"),
    };
    let help = format!("choose --from and --until between {first} and {last} s");
    if tables.is_empty() { Ok(()) } else { Err(Error::new(Kind::Usage, what).help(help)) }
}

/// Writes the figures and the spectra of the run in `folder`; what is missing, in words.
///
/// # Errors
/// `File` if they cannot be written.
pub(super) fn write(folder: &Path, plan: &Plan) -> Result<Vec<String>> {
    let tables = tables(folder, plan);
    let Told { rows, answers, remarks } = of(&tables, plan, &Asked::default());
    let mut text = String::from("name,series,quantity,value,unit,from_s,until_s\n");
    for Statistic { name, series, quantity, value, unit, from_s, until_s } in rows {
        text += &format!("{name},{series},{quantity},{value:?},{unit},{from_s:?},{until_s:?}\n");
    }
    write_whole(&folder.join(STATISTICS), text.as_bytes())?;
    answers::write(folder, &answers)?;
    spectra::write(folder, &tables)?;
    Ok(remarks)
}

/// The tables of a run by the names of their probes; those that cannot be read are left out.
type Tables = BTreeMap<String, Readings>;

/// Reads them.
fn tables(folder: &Path, plan: &Plan) -> Tables {
    let series = series_folder(folder);
    let read = |name: &String| Some((name.clone(), Readings::read(&series.join(format!("{name}.csv"))).ok()?));
    plan.probes.iter().filter_map(|probe| read(&probe.name)).collect()
}

pub(crate) fn told(folder: &Path, plan: &Plan, asked: &Asked) -> Told {
    of(&tables(folder, plan), plan, asked)
}

/// The figures of these tables.
fn of(tables: &Tables, plan: &Plan, asked: &Asked) -> Told {
    let window = (asked.from.unwrap_or(f64::NEG_INFINITY), asked.until.unwrap_or(f64::INFINITY));
    let meant = |name: &str| {
        asked.series.as_deref().is_none_or(|of| of == name || name.split_once('.').is_some_and(|n| n.0 == of))
    };
    let mut told = Told::default();
    for probe in &plan.probes {
        for column in tables.get(&probe.name).iter().flat_map(|table| &table.columns) {
            let name = format!("{}.{column}", probe.name);
            if meant(&name)
                && let Some(series) = find(tables, &name, window)
            {
                told.all_of("", &name, &series);
            }
        }
    }
    for words in &plan.statistics {
        if words.what.series().into_iter().any(meant) {
            let window = (asked.from.or(words.from), asked.until.or(words.until));
            told.declared(tables, words, (window.0.unwrap_or(f64::NEG_INFINITY), window.1.unwrap_or(f64::INFINITY)));
        }
    }
    told
}

/// The part of a series in the window (s).
fn find(tables: &Tables, name: &str, (from, until): (f64, f64)) -> Option<Series> {
    let (probe, column) = name.split_once('.')?;
    tables.get(probe)?.series(column, from, until)
}

impl Told {
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

    /// Everything that is said of one series.
    fn all_of(&mut self, name: &str, of: &str, series: &Series) {
        let (own, m) = (unit(of), moments(series));
        let plain =
            [("mean", m.mean, own), ("std", m.deviation, own), ("min", m.least.0, own), ("max", m.largest.0, own)];
        self.push(name, of, series.span(), &plain);
        let Some(w) = analysis::waves(series) else { return };
        let count = w.count as f64;
        let waves = [
            ("waves", count, "–"),
            ("H_mean", w.mean, own),
            ("H_third", w.third, own),
            ("H_max", w.largest, own),
            ("T_z", w.period, "s"),
            ("T_third", w.third_period, "s"),
        ];
        self.push(name, of, series.span(), &waves);
        if let Some(s) = spectrum(series) {
            let spectral = [("H_m0", s.height(), own), ("T_p", s.peak_period(), "s"), ("T_m02", s.mean_period(), "s")];
            self.push(name, of, series.span(), &spectral);
        }
    }

    /// How a motion answers irregular waves over frequency.
    fn answer(&mut self, name: &str, series: &str, unit: &str, bands: Vec<Band>) {
        let answer = |band| Answer { name: name.into(), series: series.into(), unit: unit.into(), band };
        self.answers.extend(bands.into_iter().map(answer));
    }

    /// Says of waves too few for an answer over frequency how many are needed.
    fn too_few(&mut self, name: &str, wave: &Series) {
        if let Some(waves) = analysis::waves(wave).filter(|waves| waves.count < analysis::ENOUGH) {
            self.remarks.push(format!(
                "statistic {name}: nothing is told over frequency: its time has {} waves, and {} are needed; of regular waves \
                 name the `period`",
                waves.count,
                analysis::ENOUGH
            ));
        }
    }

    /// What the scene asks for.
    fn declared(&mut self, tables: &Tables, words: &StatisticWords, window: (f64, f64)) {
        let found: Option<Vec<Series>> =
            words.what.series().into_iter().map(|name| find(tables, name, window)).collect();
        let Some(found) = found else {
            self.remarks.push(format!("statistic {}: a series has no two readings in its time", words.name));
            return;
        };
        let all = || words.what.series().into_iter().zip(&found);
        let before = self.rows.len();
        match &words.what {
            StatisticKind::Waves { .. } => all().for_each(|(of, series)| self.all_of(&words.name, of, series)),
            StatisticKind::Reflection { gauges, depth, g, period } => {
                let (of, own) = (&gauges[0].0, unit(&gauges[0].0));
                let placed: Vec<(f64, &Series)> = gauges.iter().map(|(_, x)| *x).zip(&found).collect();
                if let Some(r) = reflection(&placed, *depth, *g, *period) {
                    let figures = [
                        ("reflection", r.coefficient(), "–"),
                        ("H_incident", r.incident, own),
                        ("H_reflected", r.reflected, own),
                    ];
                    self.push(&words.name, of, found[0].span(), &figures);
                }
            }
            StatisticKind::Rao { motions, wave, period } => {
                let (motion, last) = found.split_at(motions.len());
                if period.is_none() {
                    self.too_few(&words.name, &last[0]);
                }
                for (of, series) in motions.iter().zip(motion) {
                    let own = format!("{}/{}", unit(of), unit(wave));
                    if period.is_none() {
                        self.answer(&words.name, of, &own, transfer(series, &last[0]));
                    }
                    let Some(r) = response(series, &last[0], *period) else { continue };
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
