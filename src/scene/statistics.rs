//! The words of `[[statistic]]`: what is said of series after a run.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    Scene,
    build::StillWaterLevel,
    verify::{quoted_list, suggestion},
};
use crate::{
    error::Result,
    plan::{StatisticKind, StatisticPlan},
};

/// One `[[statistic]]`: exactly one of waves, reflection and rao. A series is `probe.column`; the name of a probe alone
/// means the elevations of a gauge or of a row of them, the displacements and turns of a motion.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct StatisticConfig {
    /// What it is called.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// A series: its extremes, mean and deviation, its waves one by one, its spectrum.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub waves: Option<String>,
    /// Gauges in the order in which the waves that come pass them: what goes back.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reflection: Option<Vec<String>>,
    /// How a motion answers a wave.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rao: Option<RaoConfig>,
    /// Period of regular waves, s; all waves about the peak if not said.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub period: Option<f64>,
    /// Depth at the gauges, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub depth: Option<f64>,
    /// First time of the run that counts, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from: Option<f64>,
    /// Last time of the run that counts, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub until: Option<f64>,
}

/// A motion and the wave that it answers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RaoConfig {
    /// A series, or the name of a motion.
    pub motion: String,
    /// A series, or the name of a gauge.
    pub wave: String,
}

/// A series, and the gauge's place (m) if it is an elevation.
type SeriesAtPlace = (String, Option<Vec<f64>>);

impl StatisticConfig {
    fn kinds(&self) -> Vec<&'static str> {
        let given =
            [("waves", self.waves.is_some()), ("reflection", self.reflection.is_some()), ("rao", self.rao.is_some())];
        given.into_iter().filter(|(_, given)| *given).map(|(word, _)| word).collect()
    }
}

impl Scene {
    /// Refuses statistics that cannot be meant.
    pub(super) fn verify_statistics(&self) -> Result<()> {
        for (i, entry) in self.statistic.iter().enumerate() {
            let key = format!("statistic.{i}");
            if entry.kinds().len() != 1 {
                let what = format!("a statistic is of one kind; this one of {}", quoted_list(&entry.kinds()));
                return Err(self.error_with_help(
                    &key,
                    what,
                    "one of waves, reflection, rao; a [[statistic]] section for each",
                ));
            }
            self.require_positive(&format!("{key}.period"), entry.period)?;
            self.require_positive(&format!("{key}.depth"), entry.depth)?;
            if let Some(name) = &entry.name {
                self.require_file_name(&format!("{key}.name"), name)?;
            }
            let words = [
                ("period", entry.period.is_some() && entry.waves.is_some()),
                ("depth", entry.depth.is_some() && entry.reflection.is_none()),
            ];
            if let Some((word, _)) = words.into_iter().find(|(_, odd)| *odd) {
                let what = format!("{} needs no {word}", entry.kinds()[0]);
                return Err(self.error_with_help(&format!("{key}.{word}"), what, "remove it"));
            }
            if let (Some(from), Some(until)) = (entry.from, entry.until)
                && from >= until
            {
                let what = format!("nothing lies between from = {from} and until = {until}");
                return Err(self.error_with_help(&format!("{key}.until"), what, "until is the later time of the run"));
            }
            self.kind_of(&key, entry, 1.0, 1.0)?;
        }
        Ok(())
    }

    /// What is said of the series, from a scene with its defaults filled in, over water as it is at rest.
    pub(super) fn statistic_plans(&self, still: &StillWaterLevel) -> Result<Vec<StatisticPlan>> {
        let g = self.gravity.iter().flatten().map(|x| x * x).sum::<f64>().sqrt();
        let words = |(i, entry): (usize, &super::StatisticConfig)| {
            let depth = entry.depth.unwrap_or(still.depth);
            Ok(StatisticPlan {
                name: entry.name.clone().unwrap_or_default(),
                what: self.kind_of(&format!("statistic.{i}"), entry, depth, g)?,
                from: entry.from,
                until: entry.until,
            })
        };
        self.statistic.iter().enumerate().map(words).collect()
    }

    fn kind_of(&self, key: &str, entry: &StatisticConfig, depth: f64, g: f64) -> Result<StatisticKind> {
        let period = entry.period;
        let plain = |found: Vec<SeriesAtPlace>| found.into_iter().map(|(series, _)| series).collect::<Vec<_>>();
        match entry {
            StatisticConfig { waves: Some(word), .. } => {
                Ok(StatisticKind::Waves { series: plain(self.find_series(&format!("{key}.waves"), word)?) })
            }
            StatisticConfig { reflection: Some(words), .. } => {
                let key = format!("{key}.reflection");
                let mut gauges = Vec::new();
                for word in words {
                    gauges.extend(self.find_series(&key, word)?);
                }
                Ok(StatisticKind::Reflection { gauges: self.gauges_along(&key, gauges)?, depth, g, period })
            }
            StatisticConfig { rao: Some(RaoConfig { motion, wave }), .. } => {
                let motions = plain(self.find_series(&format!("{key}.rao.motion"), motion)?);
                let key = format!("{key}.rao.wave");
                match &plain(self.find_series(&key, wave)?)[..] {
                    [wave] => Ok(StatisticKind::Rao { motions, wave: wave.clone(), period }),
                    _ => Err(self.error_with_help(
                        &key,
                        format!("\"{wave}\" is more than one series"),
                        "name one, as in \"gauge.eta_m\"",
                    )),
                }
            }
            _ => Err(self.error_at(key, "what is it of?")),
        }
    }

    /// Gauges, by how far they are from the first in the direction of the last, m.
    fn gauges_along(&self, key: &str, gauges: Vec<SeriesAtPlace>) -> Result<Vec<(String, f64)>> {
        let help = "name three elevation gauges, or a row of them, in the order in which waves pass them";
        let wrong = |what: String| self.error_with_help(key, what, help);
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

    /// The series that `word` means.
    fn find_series(&self, key: &str, word: &str) -> Result<Vec<SeriesAtPlace>> {
        let names = self.probe_names();
        let (name, column) = word.split_once('.').map_or((word, None), |(name, column)| (name, Some(column)));
        let Some(i) = names.iter().position(|known| known == name) else {
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            let what = format!("no probe is called \"{name}\"{}", suggestion(name, &names));
            return Err(self.error_with_help(key, what, format!("known: {}", names.join(", "))));
        };
        let Some(plan) = self.probe[i].to_plan(self.until) else {
            return Err(self.list_has_no_series(key, name));
        };
        let series = plan.kind.series(self.dimension).into_iter();
        let all: Vec<SeriesAtPlace> = series.map(|(column, at)| (format!("{name}.{column}"), at)).collect();
        match column {
            Some(_) => Ok(vec![all.into_iter().find(|(series, _)| series == word).unwrap_or((word.into(), None))]),
            None if all.is_empty() => {
                let help = "a series is a probe and its column with a point between, as in \"box.heave_m\"";
                Err(self.error_with_help(key, format!("which column of \"{name}\" is meant?"), help))
            }
            None => Ok(all),
        }
    }

    /// Stem of each statistic's name where it has none: its kind, with a number from the second on.
    pub(super) fn statistic_names(&self) -> Vec<String> {
        let mut kinds: Vec<&str> = Vec::new();
        let name = |entry: &StatisticConfig| {
            let kind = entry.kinds().first().copied().unwrap_or("statistic");
            kinds.push(kind);
            match kinds.iter().filter(|before| **before == kind).count() {
                1 => kind.to_string(),
                n => format!("{kind}_{n}"),
            }
        };
        self.statistic.iter().map(name).collect()
    }
}
