//! One run of a list: what stands in its folder already, and what is to be done about it.

use std::{
    fs,
    path::{Path, PathBuf},
};

use crate::{
    analysis::{CheckCurves, ReferenceCheck, Verdict},
    error::{Error, ErrorKind, Result},
    output::{Manifest, manifest::RunStatus},
    run::{self, RunObserver, RunOptions, outputs, resume_point, run_folder},
    scene::{FramesChoice, FramesConfig, Scene, SizeEstimate, current_key},
};

/// How far further off its place the water of each repeat starts than that of the one before, dp.
const REPEAT_OFFSET: f64 = 1e-6;

/// The key that tells repeats apart.
const JITTER: &str = "jitter";

/// Keys of a scene that change what is kept or judged of a run, never the run.
const OUTPUT_KEYS: [&str; 4] = ["title", "frames", "checkpoint", "check"];

/// One run of a list.
#[derive(Clone, Debug, PartialEq)]
pub struct Job {
    /// Its name in the list; repeats share it.
    pub name: String,
    /// Which of the runs of this name it is: 1, or more where runs are repeated.
    pub repeat: usize,
    /// The scene, a folder or a file.
    pub scene: PathBuf,
    /// Keys of the scene that are changed, and their values.
    pub overrides: Vec<(String, String)>,
    /// The run's folder.
    pub folder: PathBuf,
    /// Jobs of one group have about the same speed.
    pub group: String,
    /// Particle spacing, m.
    pub dp: f64,
    /// What else makes this job another than the rest: keys and values.
    pub varied: Vec<(String, String)>,
}

/// How a job stands.
#[derive(Clone, Debug, PartialEq)]
pub enum JobState {
    /// Nothing has been run.
    Planned,
    /// It was asked to stop, and goes on when it is run again.
    Interrupted,
    /// It reached its end.
    Finished,
    /// It could not go on: why.
    Failed(String),
}

/// A job and what came out of it.
#[derive(Clone, Debug)]
pub struct JobResult {
    /// How it stands.
    pub state: JobState,
    /// The run's manifest, if there is one.
    pub manifest: Option<Manifest>,
    /// The run against the references of the scene as it is now.
    pub verdicts: Vec<Verdict>,
}

impl JobResult {
    fn without_run(state: JobState) -> Self {
        Self { state, manifest: None, verdicts: vec![] }
    }
}

impl Job {
    /// This job `times` times over. Each repeat starts with its water moved by a millionth of dp more than the one before,
    /// the first as the scene says: what then differs between them is chance.
    ///
    /// # Errors
    /// `Usage` for no time, or if the job varies `jitter` itself; those of the scene's words.
    pub(crate) fn repeated(self, times: usize) -> Result<Vec<Self>> {
        if times == 0 {
            return Err(Error::new(ErrorKind::Usage, "0 repeats run nothing").help("write  --repeat 5"));
        }
        if times > 1 && self.varied.iter().any(|(key, _)| current_key(key) == JITTER) {
            return Err(Error::new(ErrorKind::Usage, "jitter tells repeats apart: it cannot be varied too")
                .help("leave out  --vary jitter  or  --repeat"));
        }
        let own = if times > 1 { self.read_scene()?.jitter.unwrap_or(0.0) } else { 0.0 };
        let nth = |repeat: usize| {
            let mut job = Self { repeat, ..self.clone() };
            if repeat > 1 {
                job.overrides.push((JITTER.into(), format!("{:?}", own + REPEAT_OFFSET * (repeat - 1) as f64)));
                job.folder.as_mut_os_string().push(format!("_repeat-{repeat}"));
            }
            job
        };
        Ok((1..=times).map(nth).collect())
    }

    /// Its name, with the number of the repeat from the second on.
    pub fn display_name(&self) -> String {
        match self.repeat {
            1 => self.name.clone(),
            n => format!("{}, repeat {n}", self.name),
        }
    }

    /// The scene with the job's changes.
    ///
    /// # Errors
    /// As [`Scene::read`].
    pub(crate) fn read_scene(&self) -> Result<Scene> {
        Scene::read(&self.scene, &self.overrides)
    }

    /// About how large the run is.
    ///
    /// # Errors
    /// Those of the scene's words.
    pub(crate) fn estimated_size(&self) -> Result<SizeEstimate> {
        let scene = self.read_scene()?;
        scene.plan()?;
        scene.estimate_size()
    }

    /// The checks of the scene as it is now, whatever it was when the run was made.
    ///
    /// # Errors
    /// Those of the scene's words and tables.
    pub(crate) fn checks(&self) -> Result<Vec<ReferenceCheck>> {
        let plan = self.read_scene()?.plan()?;
        plan.checks.iter().map(|words| ReferenceCheck::new(words, &plan.folder)).collect()
    }

    /// The lines of the checks of a run that has finished, none where there is nothing to draw.
    ///
    /// # Errors
    /// As [`Job::checks`].
    pub(crate) fn curves(&self) -> Result<Vec<Option<CheckCurves>>> {
        let series = outputs::series_folder(&self.folder);
        Ok(self.checks()?.iter().map(|check| check.curves(&series).ok()).collect())
    }

    /// What stands in the job's folder; a run of another scene or another version of the program is nothing.
    ///
    /// # Errors
    /// Those of the scene's words and tables.
    pub fn existing_result(&self) -> Result<JobResult> {
        match Manifest::read(&self.folder) {
            Ok(manifest) if self.matches(&manifest)? => self.with_verdicts(manifest),
            _ => Ok(JobResult::without_run(JobState::Planned)),
        }
    }

    /// Runs the job, or goes on with it, or leaves it as it is where it has come to its end. A folder that
    /// holds a run of another scene or version is set aside as `<folder>.old`.
    ///
    /// # Errors
    /// Those of the scene's words and tables. That the run itself fails is no error: the result says so.
    pub fn run_or_resume(&self, threads: Option<usize>, watch: &mut dyn RunObserver) -> Result<JobResult> {
        let before = self.existing_result()?;
        let broke_down = before.manifest.as_ref().is_some_and(|m| m.fault.is_some());
        let outcome = match before.state {
            JobState::Finished => return Ok(before),
            // The same start breaks down at the same step.
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
            // Whoever still runs there keeps the folder.
            drop(run::Lock::acquire(&self.folder)?);
            set_aside(&self.folder)?;
        }
        let options = RunOptions { out: Some(self.folder.clone()), overrides: self.overrides.clone(), threads };
        run::run(&self.scene, &options, watch)
    }

    /// Whether `manifest` is of a run of this scene by this program.
    fn matches(&self, manifest: &Manifest) -> Result<bool> {
        let scene = self.read_scene()?;
        let words = scene.to_toml()?;
        let own = computed_keys(&words);
        // References are read anew whenever they are needed.
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

/// Whether a run kept the frames that its scene now asks for, if it names their times; there may be others between them.
fn has_frames(scene: &Scene, manifest: &Manifest) -> bool {
    let Some(FramesChoice::On(FramesConfig { every: Some(every), .. })) = &scene.frames else { return true };
    let words = manifest.scene.parse::<toml::Table>().ok();
    let kept = words.and_then(|words| words.get("frames")?.get("every")?.as_float());
    kept.map(|kept| every / kept).is_some_and(|each| each > 0.5 && (each - each.round()).abs() < 1e-6)
}

/// The words of a scene that decide what a run computes.
fn computed_keys(scene: &str) -> Option<toml::Table> {
    let mut words = scene.parse::<toml::Table>().ok()?;
    OUTPUT_KEYS.iter().for_each(|key| {
        words.remove(*key);
    });
    Some(words)
}

/// Whether the files that the text of a `scene` names, except `ignored` ones, are the same beside its `file` and in the run's
/// `folder`.
fn files_unchanged(file: &Path, scene: &str, folder: &Path, ignored: &[&str]) -> bool {
    let (beside, kept) = (file.parent().unwrap_or(Path::new("")), folder.join("scene"));
    let same = |name: &String| fs::read(beside.join(name)).ok() == fs::read(kept.join(name)).ok();
    run_folder::referenced_files(scene).iter().filter(|name| !ignored.contains(&name.as_str())).all(same)
}

/// Renames `folder` to the first free of `<folder>.old`, `<folder>.old-2`, …
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
