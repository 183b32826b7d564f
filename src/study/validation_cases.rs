//! Reads the cases of `pontoon validate` from the built-in file `scenes/validation.toml`.

use std::{collections::BTreeMap, path::Path};

use serde::Deserialize;

use super::Job;
use crate::{
    error::{Error, ErrorCode, ErrorKind, Result, nearest_name},
    plan::Score,
    scene::Scene,
};

const TEXT: &str = include_str!("../../scenes/validation.toml");

/// A scene with overridden keys, a quick and a full resolution, and the expected results of its checks.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ValidationCase {
    /// The name of the case.
    pub name: String,
    /// The entry of `[base]` that supplies the default values.
    base: Option<String>,
    /// The name of the scene.
    pub scene: String,
    /// The subject of the case, in a sentence.
    pub about: String,
    /// A note that accompanies the results.
    pub note: String,
    set: BTreeMap<String, toml::Value>,
    paper: BTreeMap<String, Score>,
    bound: BTreeMap<String, Score>,
    /// The resolution of the quick run, which takes minutes.
    pub quick: CaseResolution,
    /// The resolution of the full run, for comparison with the paper.
    pub full: CaseResolution,
}

/// The particle spacing and the duration of a case.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct CaseResolution {
    /// The particle spacing, m; without a value, the spacing of the scene applies.
    pub dp: Option<f64>,
    /// The simulated end time, s; without a value, the end time of the scene applies.
    pub until: Option<f64>,
    /// Whether the case runs if the user names no case.
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

/// Returns all cases.
///
/// # Errors
/// `Scene` if the built-in list is invalid; a test excludes this error.
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

/// Returns the cases with the given `names`. Without names, returns all cases, or only the usual cases in the quick
/// mode.
///
/// # Errors
/// `Usage` if a case does not exist; the message contains the most similar name.
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
    /// Returns this case, with missing entries taken from `base`.
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

    /// Returns the job of this case, quick or `full`, with the scene at `scene` and a folder below `out`.
    ///
    /// # Errors
    /// The errors of reading the scene; `Scene` if the case names a check that the scene does not contain.
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

/// Returns the entries of both maps; for a key in both maps, the entry of `own` applies.
fn over<T: Clone>(own: BTreeMap<String, T>, base: &BTreeMap<String, T>) -> BTreeMap<String, T> {
    base.iter().map(|(key, value)| (key.clone(), value.clone())).chain(own).collect()
}

#[cfg(test)]
#[path = "../../tests/unit/study/validation_cases.rs"]
mod tests;
