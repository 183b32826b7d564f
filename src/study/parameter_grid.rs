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
    /// How often each run is made, each time from a start that is a hair's breadth another ([`Job::repeated`]).
    pub repeat: usize,
}

impl ParameterGrid {
    /// The jobs, in folders of `out`, with the values of each: cheap ones first, so that a mistake shows
    /// early.
    ///
    /// # Errors
    /// `Usage` if a spacing or a list of values is empty or given twice; those of [`Job::repeated`].
    pub fn jobs(&self, out: &Path) -> Result<Vec<Job>> {
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
    pub fn combinations(&self) -> Vec<Vec<(String, String)>> {
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
/// # use pontoon::study::interval;
/// assert_eq!(interval(&[0.3, 0.5], 1.5), 0.1);
/// assert_eq!(interval(&[], 1.5), 1.5);
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
pub fn combination_label(varied: &[(String, String)]) -> String {
    varied.iter().map(|(key, value)| format!("{key} = {value}")).collect::<Vec<_>>().join(", ")
}

/// `text` at its commas, but for those within brackets, braces and quotes.
///
/// ```
/// # use pontoon::study::split;
/// assert_eq!(split("none,{ artificial = { alpha = 0.02, x = [1,2] } }, \"a,b\""),
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
mod tests {
    use super::*;

    fn grid(dp: &[f64], vary: &[(&str, &[&str])]) -> ParameterGrid {
        let vary = vary.iter().map(|(key, values)| VariedKey {
            key: key.to_string(),
            values: values.iter().map(|v| v.to_string()).collect(),
        });
        ParameterGrid {
            name: "x".into(),
            scene: "x".into(),
            dp: dp.into(),
            vary: vary.collect(),
            overrides: vec![],
            frames: None,
            repeat: 1,
        }
    }

    #[test]
    fn every_spacing_meets_every_combination_and_the_coarsest_comes_first() -> Result<()> {
        let values: [(&str, &[&str]); 2] = [("model.kernel", &["cubic", "wendland"]), ("time.cfl", &["0.1", "0.2"])];
        let jobs = grid(&[0.01, 0.02, 0.005], &values).jobs(Path::new("out"))?;
        assert_eq!(jobs.len(), 12);
        assert_eq!(jobs[0].folder, Path::new("out/runs/dp-0.02_kernel-cubic_cfl-0.1"));
        assert_eq!(jobs[11].name, "dp-0.005_kernel-wendland_cfl-0.2");
        assert_eq!(jobs[11].group, "model.kernel = wendland, time.cfl = 0.2");
        assert_eq!(jobs[11].overrides.last(), Some(&("dp".to_string(), "0.005".to_string())));
        assert_eq!(grid(&[0.01], &[]).jobs(Path::new("out"))?[0].name, "dp-0.01");
        Ok(())
    }

    #[test]
    fn columns_are_headed_by_what_differs_and_frames_are_kept_at_their_times() -> Result<()> {
        let laws: [(&str, &[&str]); 1] = [("model.diffusion", &["none", "fourtakas"])];
        let named = |grid: ParameterGrid| grid.jobs(Path::new("out")).map(|jobs| distinguishing_labels(&jobs));
        assert_eq!(named(grid(&[0.01], &laws))?, ["diffusion = none", "diffusion = fourtakas"]);
        assert_eq!(named(grid(&[0.01, 0.02], &[]))?, ["dp = 0.02 m", "dp = 0.01 m"]);
        assert_eq!(named(grid(&[0.01], &[]))?, ["dp-0.01"]);
        let kept =
            ParameterGrid { frames: Some(0.1), ..grid(&[0.01], &[]) }.jobs(Path::new("out"))?[0].overrides[0].clone();
        assert_eq!((kept.0.as_str(), kept.1.starts_with("{ every = 0.1,")), ("frames", true));
        // Times that have no long interval in common: 200 frames, the nearest of which is taken.
        assert_eq!(
            [frame_interval(&[0.0], 2.0), frame_interval(&[0.5, 1.25], 2.0), frame_interval(&[0.333, 1.0], 2.0)],
            [2.0, 0.25, 0.01]
        );
        Ok(())
    }

    #[test]
    fn repeats_share_a_name_and_start_a_millionth_of_dp_apart() -> Result<()> {
        let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/still-tank");
        let thrice = |sets: &[(&str, &str)]| {
            let sets = sets.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
            ParameterGrid { scene: scene.clone(), overrides: sets, repeat: 3, ..grid(&[0.05], &[]) }
                .jobs(Path::new("out"))
        };
        let jobs = thrice(&[])?;
        assert!(jobs.iter().all(|job| job.name == "dp-0.05" && job.group.is_empty()));
        let folders = ["out/runs/dp-0.05", "out/runs/dp-0.05_repeat-2", "out/runs/dp-0.05_repeat-3"];
        assert_eq!(jobs.iter().map(|job| job.folder.as_path()).collect::<Vec<_>>(), folders.map(Path::new));
        assert_eq!(distinguishing_labels(&jobs), ["repeat 1", "repeat 2", "repeat 3"]);
        let starts = |jobs: &[Job]| jobs.iter().map(|job| Ok(job.read_scene()?.jitter)).collect::<Result<Vec<_>>>();
        // The first is what it would be without repeats, so that a study that has been run can be repeated.
        assert_eq!(starts(&jobs)?, [None, Some(1e-6), Some(2e-6)]);
        assert_eq!(starts(&thrice(&[("jitter", "1e-3")])?)?, [1e-3, 1e-3 + 1e-6, 1e-3 + 2e-6].map(Some));
        let refused = |grid: ParameterGrid| grid.jobs(Path::new("out")).err().map(|e| e.kind);
        assert_eq!(refused(ParameterGrid { repeat: 0, ..grid(&[0.05], &[]) }), Some(ErrorKind::Usage));
        let varied = grid(&[0.05], &[("jitter", &["1e-7", "1e-6"])]);
        assert_eq!(refused(ParameterGrid { repeat: 2, ..varied }), Some(ErrorKind::Usage));
        Ok(())
    }

    #[test]
    fn what_is_given_twice_or_not_at_all_is_refused() {
        let refused = |grid: ParameterGrid| grid.jobs(Path::new("out")).err().map(|e| e.kind);
        assert_eq!(refused(grid(&[0.01, 0.01], &[])), Some(ErrorKind::Usage));
        assert_eq!(refused(grid(&[], &[])), Some(ErrorKind::Usage));
        assert_eq!(refused(grid(&[0.01], &[("dp", &["0.01", "0.02"])])), Some(ErrorKind::Usage));
        assert_eq!(refused(grid(&[0.01], &[("a", &["1", ""])])), Some(ErrorKind::Usage));
    }

    #[test]
    fn a_long_name_is_cut_but_stays_its_own() -> Result<()> {
        let long =
            "{ artificial = { alpha = 0.0200000000000000000000000000000000000000000000000000000000000000000001 } }";
        let jobs =
            grid(&[0.01], &[("model.viscosity", &[long, &long.replace("1 }", "2 }")])]).jobs(Path::new("out"))?;
        assert!(jobs.iter().all(|job| job.name.len() <= LONGEST));
        assert!(jobs[0].name.starts_with("dp-0.01_viscosity-artificial-alpha-0.02"));
        Ok(())
    }
}
