//! The cases of `pontoon validate`: `scenes/validation.toml`, compiled into the program.

use std::{collections::BTreeMap, path::Path};

use serde::Deserialize;

use super::Job;
use crate::{
    error::{Error, ErrorCode, ErrorKind, Result, nearest_name},
    plan::Score,
    scene::Scene,
};

const TEXT: &str = include_str!("../../scenes/validation.toml");

/// A scene with some keys changed, run coarse or fine, and what its checks are expected to say.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ValidationCase {
    /// Its name.
    pub name: String,
    /// The entry of `[base]` that it starts from.
    base: Option<String>,
    /// Name of its scene.
    pub scene: String,
    /// What it is, in a sentence.
    pub about: String,
    /// What must be said beside its figures.
    pub note: String,
    set: BTreeMap<String, toml::Value>,
    paper: BTreeMap<String, Score>,
    bound: BTreeMap<String, Score>,
    /// How it is run in minutes.
    pub quick: CaseResolution,
    /// How it is run to be compared with the paper.
    pub full: CaseResolution,
}

/// How fine and how long a case is run.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct CaseResolution {
    /// Particle spacing, m; the scene's if none.
    pub dp: Option<f64>,
    /// Simulated time at the end, s; the scene's if none.
    pub until: Option<f64>,
    /// Whether it belongs to those that are run when none is named.
    pub usual: bool,
    set: BTreeMap<String, toml::Value>,
    bound: BTreeMap<String, Score>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CasesFile {
    base: BTreeMap<String, ValidationCase>,
    case: Vec<ValidationCase>,
}

/// All cases.
///
/// # Errors
/// `Scene` if the list that was compiled in is wrong, which its test rules out.
pub fn validation_cases() -> Result<Vec<ValidationCase>> {
    let CasesFile { base, case } =
        toml::from_str(TEXT).map_err(|e| Error::scene(e.message().to_string()).at("validation.toml", None, ""))?;
    case.into_iter()
        .map(|case| match &case.base {
            None => Ok(case),
            Some(name) => match base.get(name) {
                Some(base) => Ok(case.with_defaults(base)),
                None => {
                    Err(Error::scene(format!("no base is called \"{name}\"")).at("validation.toml", None, case.name))
                }
            },
        })
        .collect()
}

/// The cases called `names`; if none is named, all, or of the quick ones the usual.
///
/// # Errors
/// `Usage` if there is no such case: names the nearest.
pub fn select_cases(names: &[String], full: bool) -> Result<Vec<ValidationCase>> {
    let all = validation_cases()?;
    if names.is_empty() {
        return Ok(all.into_iter().filter(|case| full || case.quick.usual).collect());
    }
    let case = |name: &String| {
        all.iter().find(|case| case.name == *name).cloned().ok_or_else(|| {
            let help = match nearest_name(name, all.iter().map(|case| case.name.as_str())) {
                Some(near) => format!("did you mean {near:?}? `pontoon validate --list` lists all"),
                None => "`pontoon validate --list` lists all".into(),
            };
            Error::new(ErrorKind::Usage, format!("there is no case {name:?}"))
                .with_code(ErrorCode::UnknownName)
                .help(help)
        })
    };
    names.iter().map(case).collect()
}

impl ValidationCase {
    /// This case with what it does not say itself from `base`.
    fn with_defaults(self, base: &Self) -> Self {
        let text = |own: String, other: &String| if own.is_empty() { other.clone() } else { own };
        Self {
            scene: text(self.scene, &base.scene),
            about: text(self.about, &base.about),
            note: text(self.note, &base.note),
            set: over(self.set, &base.set),
            paper: over(self.paper, &base.paper),
            bound: over(self.bound, &base.bound),
            quick: self.quick.with_defaults(&base.quick),
            full: self.full.with_defaults(&base.full),
            ..self
        }
    }

    /// The run of this case, quick or `full`, of the scene at `scene`, in a folder of `out`.
    ///
    /// # Errors
    /// Those of the scene's words; `Scene` if the case names a check that the scene has not.
    pub(crate) fn job(&self, full: bool, scene: &Path, out: &Path) -> Result<Job> {
        let extent = if full { &self.full } else { &self.quick };
        let words = Scene::read(scene, &[])?;
        let mut sets = vec![("frames".to_string(), "off".to_string())];
        let written = over(extent.set.clone(), &self.set);
        sets.extend(written.iter().map(|(key, value)| (key.clone(), value.to_string())));
        for (word, scores) in [("paper", &self.paper), ("bound", &over(extent.bound.clone(), &self.bound))] {
            for (series, score) in scores {
                let Some(i) = words.check.iter().position(|check| check.series == *series) else {
                    let series = format!("no check of \"{}\" is of {series}", self.scene);
                    return Err(Error::scene(series).at("validation.toml", None, self.name.clone()));
                };
                let value = toml::Value::try_from(score).map_err(|e| Error::scene(e.to_string()))?;
                sets.push((format!("check.{i}.{word}"), value.to_string()));
            }
        }
        sets.extend(extent.until.map(|until| ("until".into(), format!("{until:?}"))));
        let dp = extent.dp.unwrap_or(words.dp);
        sets.push(("dp".into(), format!("{dp:?}")));
        let name = format!("{}-{}", self.name, if full { "full" } else { "quick" });
        Ok(Job {
            folder: out.join("runs").join(&name),
            name: self.name.clone(),
            repeat: 1,
            scene: scene.to_owned(),
            overrides: sets,
            group: self.scene.clone(),
            dp,
            varied: vec![],
        })
    }
}

impl CaseResolution {
    fn with_defaults(self, base: &Self) -> Self {
        Self {
            dp: self.dp.or(base.dp),
            until: self.until.or(base.until),
            usual: self.usual || base.usual,
            set: over(self.set, &base.set),
            bound: over(self.bound, &base.bound),
        }
    }
}

/// The entries of both; where both have one, that of `own`.
fn over<T: Clone>(own: BTreeMap<String, T>, base: &BTreeMap<String, T>) -> BTreeMap<String, T> {
    base.iter().map(|(key, value)| (key.clone(), value.clone())).chain(own).collect()
}

#[cfg(test)]
#[path = "../../tests/unit/study/validation_cases.rs"]
mod tests;
