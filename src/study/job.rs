//! One run of a list: what stands in its folder already, and what is to be done about it.

use std::{
    fs,
    path::{Path, PathBuf},
};

use crate::{
    analysis::{Check, Curves, Verdict},
    error::{Error, Kind, Result},
    output::{Manifest, manifest::Status},
    run::{self, Options, Watch},
    scene::{FrameOutputConfig, FramesConfig, Scene, Size, current_key},
};

/// How far further off its place the water of each repeat starts than that of the one before, dp.
const APART: f64 = 1e-6;

/// The key that tells repeats apart.
const JITTER: &str = "jitter";

/// Keys of a scene that change what is kept or judged of a run, never the run.
const BESIDE: [&str; 4] = ["title", "frames", "checkpoint", "check"];

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
    pub sets: Vec<(String, String)>,
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
pub enum State {
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
pub struct Ran {
    /// How it stands.
    pub state: State,
    /// The run's manifest, if there is one.
    pub manifest: Option<Manifest>,
    /// The run against the references of the scene as it is now.
    pub verdicts: Vec<Verdict>,
}

impl Ran {
    fn nothing(state: State) -> Self {
        Self { state, manifest: None, verdicts: vec![] }
    }
}

impl Job {
    /// This job `times` times over. Each repeat starts with its water moved by a millionth of dp more than the one before,
    /// the first as the scene says: what then differs between them is chance.
    ///
    /// # Errors
    /// `Usage` for no time, or if the job varies `jitter` itself; those of the scene's words.
    pub fn repeated(self, times: usize) -> Result<Vec<Self>> {
        if times == 0 {
            return Err(Error::new(Kind::Usage, "0 repeats run nothing").help("write  --repeat 5"));
        }
        if times > 1 && self.varied.iter().any(|(key, _)| current_key(key) == JITTER) {
            return Err(Error::new(Kind::Usage, "jitter tells repeats apart: it cannot be varied too")
                .help("leave out  --vary jitter  or  --repeat"));
        }
        let own = if times > 1 { self.read()?.jitter.unwrap_or(0.0) } else { 0.0 };
        let nth = |repeat: usize| {
            let mut job = Self { repeat, ..self.clone() };
            if repeat > 1 {
                job.sets.push((JITTER.into(), format!("{:?}", own + APART * (repeat - 1) as f64)));
                job.folder.as_mut_os_string().push(format!("_repeat-{repeat}"));
            }
            job
        };
        Ok((1..=times).map(nth).collect())
    }

    /// Its name, with the number of the repeat from the second on.
    pub fn said(&self) -> String {
        match self.repeat {
            1 => self.name.clone(),
            n => format!("{}, repeat {n}", self.name),
        }
    }

    /// The scene with the job's changes.
    ///
    /// # Errors
    /// As [`Scene::read`].
    pub fn read(&self) -> Result<Scene> {
        Scene::read(&self.scene, &self.sets)
    }

    /// About how large the run is.
    ///
    /// # Errors
    /// Those of the scene's words.
    pub fn size(&self) -> Result<Size> {
        let scene = self.read()?;
        scene.plan()?;
        scene.size()
    }

    /// The checks of the scene as it is now, whatever it was when the run was made.
    ///
    /// # Errors
    /// Those of the scene's words and tables.
    pub fn checks(&self) -> Result<Vec<Check>> {
        let plan = self.read()?.plan()?;
        plan.checks.iter().map(|words| Check::new(words, &plan.folder)).collect()
    }

    /// The lines of the checks of a run that has finished, none where there is nothing to draw.
    ///
    /// # Errors
    /// As [`Job::checks`].
    pub fn curves(&self) -> Result<Vec<Option<Curves>>> {
        let series = run::series_folder(&self.folder);
        Ok(self.checks()?.iter().map(|check| check.curves(&series).ok()).collect())
    }

    /// What stands in the job's folder; a run of another scene or another version of the program is nothing.
    ///
    /// # Errors
    /// Those of the scene's words and tables.
    pub fn look(&self) -> Result<Ran> {
        match Manifest::read(&self.folder) {
            Ok(manifest) if self.is_of(&manifest)? => self.judged(manifest),
            _ => Ok(Ran::nothing(State::Planned)),
        }
    }

    /// Runs the job, or goes on with it, or leaves it as it is where it has come to its end. A folder that
    /// holds a run of another scene or version is set aside as `<folder>.old`.
    ///
    /// # Errors
    /// Those of the scene's words and tables. That the run itself fails is no error: the result says so.
    pub fn attempt(&self, threads: Option<usize>, watch: &mut dyn Watch) -> Result<Ran> {
        let before = self.look()?;
        let broke_down = before.manifest.as_ref().is_some_and(|m| m.fault.is_some());
        let outcome = match before.state {
            State::Finished => return Ok(before),
            // The same start breaks down at the same step.
            State::Failed(_) if broke_down => return Ok(before),
            State::Interrupted => run::resume(&self.folder, &[], threads, watch),
            State::Planned | State::Failed(_) => self.fresh(threads, watch),
        };
        match outcome {
            Ok(outcome) => self.judged(outcome.manifest),
            Err(error) => {
                let ran = self.look()?;
                Ok(Ran { state: State::Failed(error.to_string()), ..ran })
            }
        }
    }

    fn fresh(&self, threads: Option<usize>, watch: &mut dyn Watch) -> Result<run::Outcome> {
        if fs::read_dir(&self.folder).is_ok_and(|mut entries| entries.next().is_some()) {
            // Whoever still runs there keeps the folder.
            drop(run::Lock::take(&self.folder)?);
            set_aside(&self.folder)?;
        }
        let options = Options { out: Some(self.folder.clone()), sets: self.sets.clone(), threads };
        run::run(&self.scene, &options, watch)
    }

    /// Whether `manifest` is of a run of this scene by this program.
    fn is_of(&self, manifest: &Manifest) -> Result<bool> {
        let scene = self.read()?;
        let words = scene.to_toml()?;
        let own = bare(&words);
        // References are read anew whenever they are needed.
        let references: Vec<&str> = scene.check.iter().filter_map(|check| check.reference.as_deref()).collect();
        Ok(manifest.version == env!("CARGO_PKG_VERSION")
            && has_frames(&scene, manifest)
            && own.is_some()
            && own == bare(&manifest.scene)
            && run::same_tables(&run::scene_file(&self.scene), &words, &self.folder, &references))
    }

    fn judged(&self, manifest: Manifest) -> Result<Ran> {
        let state = match manifest.status {
            Status::Finished => State::Finished,
            Status::Failed => State::Failed(manifest.error.clone().unwrap_or_default()),
            _ if run::has_checkpoint(&self.folder) => State::Interrupted,
            _ => State::Planned,
        };
        let series = run::series_folder(&self.folder);
        let judge = |check: Check| check.judge(&series);
        let verdicts = if state == State::Finished { self.checks()?.into_iter().map(judge).collect() } else { vec![] };
        Ok(Ran { state, manifest: Some(manifest), verdicts })
    }
}

/// Whether a run kept the frames that its scene now asks for, if it names their times; there may be others between them.
fn has_frames(scene: &Scene, manifest: &Manifest) -> bool {
    let Some(FramesConfig::On(FrameOutputConfig { every: Some(every), .. })) = &scene.frames else { return true };
    let words = manifest.scene.parse::<toml::Table>().ok();
    let kept = words.and_then(|words| words.get("frames")?.get("every")?.as_float());
    kept.map(|kept| every / kept).is_some_and(|each| each > 0.5 && (each - each.round()).abs() < 1e-6)
}

/// The words of a scene that decide what a run computes.
fn bare(scene: &str) -> Option<toml::Table> {
    let mut words = scene.parse::<toml::Table>().ok()?;
    BESIDE.iter().for_each(|key| {
        words.remove(*key);
    });
    Some(words)
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
