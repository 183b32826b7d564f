//! The grid of a study: every spacing with every combination of values.

use std::path::{Path, PathBuf};

use super::Job;
use crate::{
    error::{Error, ErrorKind, Result},
    output::checkpoint::fnv1a,
};

/// Longest name of a folder that is made of the values themselves.
const LONGEST: usize = 80;

/// Most frames that a run keeps for a picture.
const MOST_FRAMES: f64 = 200.0;

/// A key of the scene and the values that it takes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VariedKey {
    /// The key.
    pub key: String,
    /// Its values, as TOML.
    pub values: Vec<String>,
}

/// A grid of runs of one scene.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterGrid {
    /// The scene's name.
    pub name: String,
    /// The scene, a folder or a file.
    pub scene: PathBuf,
    /// Spacings, m, the coarsest first.
    pub dp: Vec<f64>,
    /// What else is varied.
    pub vary: Vec<VariedKey>,
    /// Keys that are changed in all runs.
    pub overrides: Vec<(String, String)>,
    /// Simulated time between the frames that each run keeps for a picture, s; without it none are kept.
    pub frames: Option<f64>,
    /// How often each run is made, each time from a start that is a hair's breadth another (`Job::repeated`).
    pub repeat: usize,
}

impl ParameterGrid {
    /// The jobs, in folders of `out`, with the values of each: cheap ones first, so that a mistake shows
    /// early.
    ///
    /// # Errors
    /// `Usage` if a spacing or a list of values is empty or given twice; those of `Job::repeated`.
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

    /// Every combination of the varied values; one that is empty if nothing is varied.
    pub(crate) fn combinations(&self) -> Vec<Vec<(String, String)>> {
        self.vary.iter().fold(vec![vec![]], |all, vary| {
            let with = |before: &Vec<(String, String)>, value: &String| {
                before.iter().cloned().chain([(vary.key.clone(), value.clone())]).collect()
            };
            all.iter().flat_map(|before| vary.values.iter().map(move |value| with(before, value))).collect()
        })
    }
}

/// The longest interval (s) of which all `times` (s) are multiples, to a millisecond, as long as that makes no more than 200
/// frames in a run of `until` (s); `until` if there is no time but the start.
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

/// What makes each of `jobs` another than the rest, briefly.
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

/// A combination in words.
pub(crate) fn combination_label(varied: &[(String, String)]) -> String {
    varied.iter().map(|(key, value)| format!("{key} = {value}")).collect::<Vec<_>>().join(", ")
}

/// `text` at its commas, but for those within brackets, braces and quotes.
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

/// The name of a run's folder: its spacing and its values, as far as a file can be called so.
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
