//! Defines the parameter grid of a study: each particle spacing with each combination of values.

use std::path::{Path, PathBuf};

use super::Job;
use crate::{
    error::{Error, ErrorKind, Result},
    output::checkpoint::fnv1a,
    scene::{Scene, current_key},
};

/// The largest length of a folder name made from the values.
const LONGEST: usize = 80;

/// The largest number of frames that a run saves for pictures.
const MOST_FRAMES: f64 = 200.0;

/// A scene key and its values in the study.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VariedKey {
    /// The scene key.
    pub key: String,
    /// The values, as TOML.
    pub values: Vec<String>,
}

/// A grid of runs of one scene.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterGrid {
    /// The name of the scene.
    pub name: String,
    /// The path of the scene, which is a folder or a file.
    pub scene: PathBuf,
    /// The particle spacings, m, from coarse to fine.
    pub dp: Vec<f64>,
    /// The other varied keys.
    pub vary: Vec<VariedKey>,
    /// The scene keys that are overridden in all runs.
    pub overrides: Vec<(String, String)>,
    /// The simulated time between the frames for pictures, s; without a value, the runs save no frames for pictures.
    pub frames: Option<f64>,
    /// The number of repeats of each run, each with a slightly different initial state (see `Job::repeated`).
    pub repeat: usize,
}

impl ParameterGrid {
    /// Returns the jobs, each with its values and a folder below `out`. The cheapest jobs come first, so that mistakes
    /// become visible early.
    ///
    /// # Errors
    /// `Usage` if a spacing or a list of values is empty or repeated, or if two keys vary the same value; the errors of `Job::repeated`.
    pub(crate) fn jobs(&self, out: &Path) -> Result<Vec<Job>> {
        let mut dp = self.dp.clone();
        dp.sort_by(|a, b| b.total_cmp(a));
        if dp.is_empty() || self.vary.iter().any(|vary| vary.values.iter().any(String::is_empty)) {
            return Err(Error::new(ErrorKind::Usage, "a list of values has nothing in it")
                .help("write  --dp 0.02,0.01 --vary model.viscosity=none,laminar"));
        }
        if self.vary.iter().any(|vary| vary.key == "dp") {
            return Err(Error::new(ErrorKind::Usage, "the spacing is varied apart from other keys")
                .help("write  --dp 0.02,0.01"));
        }
        self.require_different_keys()?;
        let frames = self
            .frames
            .map_or("off".into(), |every| format!("{{ every = {every:?}, fields = [\"velocity\", \"pressure\"] }}"));
        let mut jobs: Vec<Job> = Vec::new();
        for &dp in &dp {
            for varied in self.combinations() {
                let mut sets = vec![("frames".to_string(), frames.clone())];
                sets.extend(self.overrides.iter().chain(&varied).cloned());
                sets.push(("dp".into(), format!("{dp:?}")));
                let name = folder_name(dp, &varied);
                let group = combination_label(&varied);
                let (folder, scene) = (out.join("runs").join(&name), self.scene.clone());
                jobs.push(Job { folder, name, repeat: 1, scene, overrides: sets, group, dp, varied });
            }
        }
        match (0..jobs.len()).find(|&i| jobs[..i].iter().any(|job| job.name == jobs[i].name)) {
            Some(i) => Err(Error::new(ErrorKind::Usage, format!("two runs would be called {:?}", jobs[i].name))
                .help("give each spacing and each value once")),
            None => Ok(jobs.into_iter().map(|job| job.repeated(self.repeat)).collect::<Result<Vec<_>>>()?.concat()),
        }
    }

    /// Checks that no varied key is another one or a part of it, by a former name or by a number in place of a name either.
    ///
    /// # Errors
    /// `Usage`, with both keys.
    fn require_different_keys(&self) -> Result<()> {
        // An invalid key or value is an error of its run.
        let known = |key: &String, value: &String| {
            let sets: Vec<_> = self.overrides.iter().cloned().chain([(key.clone(), value.clone())]).collect();
            Scene::read(&self.scene, &sets).ok()?.override_keys().last().cloned()
        };
        let number_of = |vary: &VariedKey| vary.values.first().and_then(|value| known(&vary.key, value));
        let keys: Vec<String> =
            self.vary.iter().map(|vary| number_of(vary).unwrap_or_else(|| current_key(&vary.key))).collect();
        let is_part =
            |part: &str, of: &str| part.strip_prefix(of).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'));
        for (j, later) in keys.iter().enumerate() {
            if let Some(i) = (0..j).find(|&i| is_part(later, &keys[i]) || is_part(&keys[i], later)) {
                let [first, second] = [i, j].map(|i| &self.vary[i].key);
                let what = match first == second {
                    true => format!("\"{first}\" is varied twice"),
                    false => format!("\"{first}\" and \"{second}\" vary the same value"),
                };
                return Err(Error::new(ErrorKind::Usage, what).help("give all values of a key in one  --vary"));
            }
        }
        Ok(())
    }

    /// Returns every combination of the varied values, or a single empty combination if nothing varies.
    pub(crate) fn combinations(&self) -> Vec<Vec<(String, String)>> {
        self.vary.iter().fold(vec![vec![]], |all, vary| {
            let with = |before: &Vec<(String, String)>, value: &String| {
                before.iter().cloned().chain([(vary.key.clone(), value.clone())]).collect()
            };
            all.iter().flat_map(|before| vary.values.iter().map(move |value| with(before, value))).collect()
        })
    }
}

/// Returns the longest interval (s) of which all `times` (s) are multiples, to within a millisecond. The interval is
/// long enough for at most 200 frames in a run of `until` (s). Returns `until` if `times` contains no time after the
/// start.
///
/// ```
/// # use pontoon::study::frame_interval;
/// assert_eq!(frame_interval(&[0.3, 0.5], 1.5), 0.1);
/// assert_eq!(frame_interval(&[], 1.5), 1.5);
/// ```
pub fn frame_interval(times: &[f64], until: f64) -> f64 {
    let common = |mut a: u64, mut b: u64| {
        while b > 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    match times.iter().map(|t| (t * 1e3).round() as u64).fold(0, common) {
        0 => until,
        every => (every as f64 / 1e3).max(until / MOST_FRAMES),
    }
}

/// Returns a short label for each of `jobs` that distinguishes the job from the others.
pub fn distinguishing_labels(jobs: &[Job]) -> Vec<String> {
    let spacings = jobs.windows(2).any(|pair| pair[0].dp != pair[1].dp);
    let head = |job: &Job| {
        let spacing = spacings.then(|| format!("dp = {} m", job.dp));
        let short = |(key, value): &(String, String)| format!("{} = {value}", key.rsplit('.').next().unwrap_or(key));
        let repeat = jobs.iter().any(|job| job.repeat > 1).then(|| format!("repeat {}", job.repeat));
        let words: Vec<String> = spacing.into_iter().chain(job.varied.iter().map(short)).chain(repeat).collect();
        if words.is_empty() { job.name.clone() } else { words.join(", ") }
    };
    jobs.iter().map(head).collect()
}

/// Returns a combination as text.
pub(crate) fn combination_label(varied: &[(String, String)]) -> String {
    varied.iter().map(|(key, value)| format!("{key} = {value}")).collect::<Vec<_>>().join(", ")
}

/// Returns the parts of `text` between its commas. Commas within brackets, braces and quotes do not split the text.
///
/// ```
/// # use pontoon::study::split_values;
/// assert_eq!(split_values("none,{ artificial = { alpha = 0.02, x = [1,2] } }, \"a,b\""),
///     ["none", "{ artificial = { alpha = 0.02, x = [1,2] } }", "\"a,b\""]);
/// ```
pub fn split_values(text: &str) -> Vec<String> {
    let (mut parts, mut part, mut depth, mut quote) = (Vec::new(), String::new(), 0, None);
    for c in text.chars() {
        match (quote, c) {
            (Some(open), _) if c == open => quote = None,
            (None, '"' | '\'') => quote = Some(c),
            (None, '[' | '{' | '(') => depth += 1,
            (None, ']' | '}' | ')') => depth -= 1,
            (None, ',') if depth <= 0 => {
                parts.push(std::mem::take(&mut part).trim().to_string());
                continue;
            }
            _ => {}
        }
        part.push(c);
    }
    parts.push(part.trim().to_string());
    parts
}

/// Returns the folder name of a run, made from its spacing and values with characters that are valid in file names.
fn folder_name(dp: f64, varied: &[(String, String)]) -> String {
    let mut name = format!("dp-{dp}");
    for (key, value) in varied {
        let key = key.rsplit('.').next().unwrap_or(key);
        let words: Vec<String> = value
            .split(|c: char| !c.is_alphanumeric() && c != '.' && c != '-')
            .filter(|word| !word.is_empty())
            .map(String::from)
            .collect();
        name += &format!("_{key}-{}", words.join("-"));
    }
    if name.chars().count() <= LONGEST {
        return name;
    }
    let short: String = name.chars().take(LONGEST - 9).collect();
    format!("{short}-{:08x}", fnv1a(name.as_bytes()) as u32)
}

#[cfg(test)]
#[path = "../../tests/unit/study/parameter_grid.rs"]
mod tests;
