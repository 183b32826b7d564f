//! A job is one run of a list. This module reads the state of the job's folder and starts or resumes the run.

use std::{
    fs,
    path::{Path, PathBuf},
};

use crate::{
    analysis::{CheckCurves, ReferenceCheck, Verdict},
    error::{Error, ErrorKind, Result},
    output::{Manifest, manifest::RunStatus},
    run::{self, RunObserver, RunOptions, outputs, resume_point, run_folder},
    scene::{FramesChoice, FramesConfig, MOST_JITTER, Scene, SizeEstimate, current_key},
};

/// Additional initial displacement of the water from each repeat to the next, dp.
const REPEAT_OFFSET: f64 = 1e-6;

/// The scene key that distinguishes repeats.
const JITTER: &str = "jitter";

/// Scene keys that change only the output or the checks of a run, not its computation.
const OUTPUT_KEYS: [&str; 4] = ["title", "frames", "checkpoint", "check"];

/// One run of a list.
#[derive(Clone, Debug, PartialEq)]
pub struct Job {
    /// The name of the run in the list; all repeats of the run share this name.
    pub name: String,
    /// The number of this repeat, counted from 1.
    pub repeat: usize,
    /// The path of the scene, which is a folder or a file.
    pub scene: PathBuf,
    /// The scene keys that the job overrides, with their new values.
    pub overrides: Vec<(String, String)>,
    /// The folder of the run.
    pub folder: PathBuf,
    /// The group of the job; jobs of one group run at about the same speed.
    pub group: String,
    /// Particle spacing, m.
    pub dp: f64,
    /// The other keys and values that distinguish this job from the other jobs.
    pub varied: Vec<(String, String)>,
}

/// The state of a job.
#[derive(Clone, Debug, PartialEq)]
pub enum JobState {
    /// The run has not started.
    Planned,
    /// The run stopped on request, and resumes when the job runs again.
    Interrupted,
    /// The run reached its end time.
    Finished,
    /// The run failed; the string contains the reason.
    Failed(String),
}

/// A job and its result.
#[derive(Clone, Debug)]
pub struct JobResult {
    /// The state of the job.
    pub state: JobState,
    /// The manifest of the run, if the folder contains a manifest.
    pub manifest: Option<Manifest>,
    /// The comparison of the run with the references of the current scene.
    pub verdicts: Vec<Verdict>,
}

impl JobResult {
    fn without_run(state: JobState) -> Self {
        Self { state, manifest: None, verdicts: vec![] }
    }
}

impl Job {
    /// Returns `times` repeats of this job. The first repeat starts from the unchanged scene. Each further repeat
    /// displaces the initial water by another millionth of dp, so differences between repeats are random.
    ///
    /// # Errors
    /// `Usage` if `times` is zero or if the job already varies `jitter`; the errors of reading the scene.
    pub(crate) fn repeated(self, times: usize) -> Result<Vec<Self>> {
        if times == 0 {
            return Err(Error::new(ErrorKind::Usage, "0 repeats run nothing").help("write  --repeat 5"));
        }
        if times > 1 && self.varied.iter().any(|(key, _)| current_key(key) == JITTER) {
            return Err(Error::new(ErrorKind::Usage, "jitter tells repeats apart: it cannot be varied too")
                .help("leave out  --vary jitter  or  --repeat"));
        }
        let own = if times > 1 { self.read_scene()?.jitter.unwrap_or(0.0) } else { 0.0 };
        // Less of a jitter that is near the largest.
        let offset = if own > 0.5 * MOST_JITTER { -REPEAT_OFFSET } else { REPEAT_OFFSET };
        let nth = |repeat: usize| {
            let mut job = Self { repeat, ..self.clone() };
            if repeat > 1 {
                job.overrides.push((JITTER.into(), format!("{:?}", own + offset * (repeat - 1) as f64)));
                job.folder.as_mut_os_string().push(format!("_repeat-{repeat}"));
            }
            job
        };
        Ok((1..=times).map(nth).collect())
    }

    /// Returns the name of the job, with the number of the repeat appended from the second repeat on.
    pub fn display_name(&self) -> String {
        match self.repeat {
            1 => self.name.clone(),
            n => format!("{}, repeat {n}", self.name),
        }
    }

    /// Returns the scene with the overrides of the job applied.
    ///
    /// # Errors
    /// As [`Scene::read`].
    pub(crate) fn read_scene(&self) -> Result<Scene> {
        Scene::read(&self.scene, &self.overrides)
    }

    /// Returns an estimate of the size of the run.
    ///
    /// # Errors
    /// The errors of reading the scene.
    pub(crate) fn estimated_size(&self) -> Result<SizeEstimate> {
        let scene = self.read_scene()?;
        scene.plan()?;
        scene.estimate_size()
    }

    /// Returns the checks of the current scene, even if the run used an earlier version of the scene.
    ///
    /// # Errors
    /// The errors of reading the scene and its tables.
    pub(crate) fn checks(&self) -> Result<Vec<ReferenceCheck>> {
        let plan = self.read_scene()?.plan()?;
        plan.checks.iter().map(|words| ReferenceCheck::new(words, &plan.folder)).collect()
    }

    /// Returns the curves of each check of a finished run; a check without curves has `None`.
    ///
    /// # Errors
    /// As [`Job::checks`].
    pub(crate) fn curves(&self) -> Result<Vec<Option<CheckCurves>>> {
        let series = outputs::series_folder(&self.folder);
        Ok(self.checks()?.iter().map(|check| check.curves(&series).ok()).collect())
    }

    /// Returns the result in the folder of the job. A run of another scene or program version counts as no run.
    ///
    /// # Errors
    /// The errors of reading the scene and its tables.
    pub fn existing_result(&self) -> Result<JobResult> {
        match Manifest::read(&self.folder) {
            Ok(manifest) if self.matches(&manifest)? => self.with_verdicts(manifest),
            _ => Ok(JobResult::without_run(JobState::Planned)),
        }
    }

    /// Starts the job, or resumes an interrupted run; a run that has already ended stays unchanged. A folder that
    /// contains a run of another scene or program version is renamed to `<folder>.old`.
    ///
    /// # Errors
    /// The errors of reading the scene and its tables. A failure of the run itself is not an error; the result contains
    /// the failure.
    pub fn run_or_resume(&self, threads: Option<usize>, watch: &mut dyn RunObserver) -> Result<JobResult> {
        let before = self.existing_result()?;
        let broke_down = before.manifest.as_ref().is_some_and(|m| m.fault.is_some());
        let outcome = match before.state {
            JobState::Finished => return Ok(before),
            // A run from the same initial state breaks down at the same step.
            JobState::Failed(_) if broke_down => return Ok(before),
            JobState::Interrupted => run::resume(&self.folder, &[], threads, watch),
            JobState::Planned | JobState::Failed(_) => self.run_fresh(threads, watch),
        };
        match outcome {
            Ok(outcome) => self.with_verdicts(outcome.manifest),
            Err(error) => {
                let ran = self.existing_result()?;
                Ok(JobResult { state: JobState::Failed(error.to_string()), ..ran })
            }
        }
    }

    fn run_fresh(&self, threads: Option<usize>, watch: &mut dyn RunObserver) -> Result<run::RunOutcome> {
        if fs::read_dir(&self.folder).is_ok_and(|mut entries| entries.next().is_some()) {
            // If another process still runs in the folder, the lock fails and the folder stays in place.
            drop(run::Lock::acquire(&self.folder)?);
            set_aside(&self.folder)?;
        }
        let options = RunOptions { out: Some(self.folder.clone()), overrides: self.overrides.clone(), threads };
        run::run(&self.scene, &options, watch)
    }

    /// Returns whether `manifest` belongs to a run of this scene by this program version.
    fn matches(&self, manifest: &Manifest) -> Result<bool> {
        let scene = self.read_scene()?;
        let words = scene.to_toml()?;
        let own = computed_keys(&words);
        // The program rereads the references for each comparison, so changed references do not invalidate a run.
        let references: Vec<&str> = scene.check.iter().filter_map(|check| check.reference.as_deref()).collect();
        Ok(manifest.version == env!("CARGO_PKG_VERSION")
            && has_frames(&scene, manifest)
            && own.is_some()
            && own == computed_keys(&manifest.scene)
            && files_unchanged(&run_folder::scene_file(&self.scene), &words, &self.folder, &references))
    }

    fn with_verdicts(&self, manifest: Manifest) -> Result<JobResult> {
        let state = match manifest.status {
            RunStatus::Finished => JobState::Finished,
            RunStatus::Failed => JobState::Failed(manifest.error.clone().unwrap_or_default()),
            _ if resume_point::has_checkpoint(&self.folder) => JobState::Interrupted,
            _ => JobState::Planned,
        };
        let series = outputs::series_folder(&self.folder);
        let judge = |check: ReferenceCheck| check.verdict(&series);
        let verdicts =
            if state == JobState::Finished { self.checks()?.into_iter().map(judge).collect() } else { vec![] };
        Ok(JobResult { state, manifest: Some(manifest), verdicts })
    }
}

/// Returns whether the run saved all frame times that the scene lists. The run may contain additional frames.
fn has_frames(scene: &Scene, manifest: &Manifest) -> bool {
    let Some(FramesChoice::On(FramesConfig { every: Some(every), .. })) = &scene.frames else { return true };
    let words = manifest.scene.parse::<toml::Table>().ok();
    let kept = words.and_then(|words| words.get("frames")?.get("every")?.as_float());
    kept.map(|kept| every / kept).is_some_and(|each| each > 0.5 && (each - each.round()).abs() < 1e-6)
}

/// Returns the scene keys that determine the computation of a run.
fn computed_keys(scene: &str) -> Option<toml::Table> {
    let mut words = scene.parse::<toml::Table>().ok()?;
    OUTPUT_KEYS.iter().for_each(|key| {
        words.remove(*key);
    });
    Some(words)
}

/// Returns whether the files that `scene` names are identical beside `file` and in the run's `folder`. The comparison
/// omits the `ignored` files.
fn files_unchanged(file: &Path, scene: &str, folder: &Path, ignored: &[&str]) -> bool {
    let (beside, kept) = (file.parent().unwrap_or(Path::new("")), folder.join("scene"));
    let same = |name: &String| fs::read(beside.join(name)).ok() == fs::read(kept.join(name)).ok();
    run_folder::referenced_files(scene).iter().filter(|name| !ignored.contains(&name.as_str())).all(same)
}

/// Renames `folder` to the first unused name of `<folder>.old`, `<folder>.old-2`, …
fn set_aside(folder: &Path) -> Result<()> {
    let name = |number: usize| {
        let mut name = folder.as_os_str().to_owned();
        name.push(if number == 1 { ".old".to_string() } else { format!(".old-{number}") });
        PathBuf::from(name)
    };
    let free = (1..).map(name).find(|path| !path.exists()).unwrap_or_else(|| name(1));
    fs::rename(folder, &free)
        .map_err(|why| Error::file(folder, format!("cannot be set aside as {}: {why}", free.display())))
}
