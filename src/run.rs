//! The commands `run`, `resume` and `inspect` as functions. They read the scene, select the dimension, build the
//! simulation, step it, record its outputs and evaluate its checks.
//!
//! ```no_run
//! use pontoon::run::{RunOptions, Progress, run};
//!
//! let mut watch = |now: &Progress| now.wall < 3600.0;   // false asks the run to stop
//! let outcome = run("scenes/raft".as_ref(), &RunOptions::default(), &mut watch)?;
//! assert!(outcome.folder.join("manifest.json").exists());
//! # Ok::<(), pontoon::Error>(())
//! ```

mod controls;
mod device;
mod runner;
mod energy_drift;
pub(crate) mod orders;
pub(crate) mod run_folder;
mod inspect;
pub(crate) mod resume_point;
mod lock;
mod processor_time;
pub(crate) mod probe_factory;
pub(crate) mod outputs;
pub(crate) mod statistics;

pub use controls::Control;
pub use energy_drift::EnergyDrift;
#[doc(hidden)]
pub use inspect::{
    CostEstimate, InspectOptions, InspectReport, Inspection, LARGE, MeshSummary, SeriesColumns, SolidSummary,
    StepTiming, inspect, inspect_scene,
};
pub(crate) use lock::Lock;
#[doc(hidden)]
pub use lock::lock_owner;
#[doc(hidden)]
pub use statistics::{RAO_FILE, RaoResult, RunStatistics, SPECTRA_FILE, Statistic, StatisticsFilter, statistics};

use std::path::{Path, PathBuf};

use resume_point::ResumePoint;

use crate::{
    error::{Error, ErrorKind, Result},
    output::{Checkpoint, Manifest, manifest::RunStatus},
    plan::ControlChange,
    ranks::Ranks,
    scene::{RenamedName, Scene},
    simulation::{Dimension, Rollback},
    solid::ConstraintEvent,
    solid::Dim,
};

/// The options of a run in addition to its scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunOptions {
    /// Folder for the results, new or empty. The default is `runs/<scene>`, with a number appended if that folder
    /// exists.
    pub out: Option<PathBuf>,
    /// Scene keys and the values that replace the values of the scene, as in `("dp", "0.02")`.
    pub overrides: Vec<(String, String)>,
    /// Number of threads; the default is one for each processor. It changes the speed but never the result.
    pub threads: Option<usize>,
}

/// The data that are known when a run begins.
#[derive(Clone, Copy, Debug)]
pub struct RunStart<'a> {
    /// The run's folder.
    pub folder: &'a Path,
    /// The manifest at the start: caption, particles, threads, warnings.
    pub manifest: &'a Manifest,
    /// The keys and values that the scene writes with a former name.
    pub renamed: &'a [RenamedName],
    /// The numbers that may be changed while the run goes on.
    pub controls: &'a [Control],
}

/// The progress of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Simulated time, s.
    pub time: f64,
    /// Simulated time at the end, s.
    pub until: f64,
    /// Last time step, s.
    pub dt: f64,
    /// Number of completed steps.
    pub steps: u64,
    /// Wall time so far, s, including the time before an interruption.
    pub wall: f64,
    /// (Water particles + boundary particles near water) × force passes ÷ wall time of stepping, 1/s.
    pub rate: f64,
    /// The energy drift, if a probe measures it.
    pub energy: Option<EnergyDrift>,
}

/// A request of an observer to a run, fulfilled between two steps.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum RunRequest {
    /// Write a checkpoint.
    Checkpoint,
    /// Write a checkpoint and stop.
    Stop,
    /// Change a number of a motor or force; a value outside its range has no effect.
    Set {
        /// Number of the control in [`RunStart::controls`].
        control: usize,
        /// The value from now on.
        value: f64,
    },
}

/// An observer of a run. Every `FnMut(&Progress) -> bool` implements this trait.
pub trait RunObserver: Send {
    /// Receives the start of the run, once, before the first step.
    fn start(&mut self, start: &RunStart) {
        let _ = start;
    }

    /// Receives a rollback, when the run returns to an earlier valid state after an alarm.
    fn rolled_back(&mut self, how: &Rollback) {
        let _ = how;
    }

    /// Receives the beginning or the end of a joint, spring, rope or solid during the run.
    fn event(&mut self, event: &ConstraintEvent) {
        let _ = event;
    }

    /// Receives a change of a control, which the run has made at the request of this observer.
    fn control_changed(&mut self, change: &ControlChange) {
        let _ = change;
    }

    /// Receives the progress before the first step and after each step. If it returns `false`, the run writes a
    /// checkpoint and stops.
    fn step(&mut self, now: &Progress) -> bool;

    /// Returns what the run is to do before its next step, or `None` to go on. The run asks again after each request. An
    /// observer that waits here pauses the run.
    fn request(&mut self) -> Option<RunRequest> {
        None
    }
}

impl<F: FnMut(&Progress) -> bool + Send> RunObserver for F {
    fn step(&mut self, now: &Progress) -> bool {
        self(now)
    }
}

/// The state of a free body at the end.
#[derive(Clone, Debug, PartialEq)]
pub struct FinalBodyState {
    /// Its name.
    pub name: String,
    /// Position of its centre of mass, m.
    pub position: Vec<f64>,
    /// Speed of its centre of mass, m/s.
    pub speed: f64,
    /// Rotation of its frame, deg: one angle in 2-D, a rotation vector in 3-D.
    pub rotation_deg: Vec<f64>,
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub struct RunOutcome {
    /// The run's folder.
    pub folder: PathBuf,
    /// The manifest as it is written in the folder.
    pub manifest: Manifest,
    /// The final states of the free bodies.
    pub bodies: Vec<FinalBodyState>,
    /// The last warnings of the manifest, which only the end of the run could determine.
    pub end_warnings: Vec<String>,
}

impl RunOutcome {
    /// Returns whether any check exceeds its bound.
    pub fn has_failed_checks(&self) -> bool {
        self.manifest.checks.iter().any(|verdict| verdict.passed == Some(false))
    }
}

/// Runs the scene at `path`, which is a scene file or a folder with a `scene.toml`.
///
/// # Errors
/// `Scene`, `Usage` or `File` before anything is written; `File` when a file cannot be written; `Fault` when the
/// computation cannot continue. After a `Fault` the run's folder holds all output up to the fault and `failure.json`.
pub fn run(path: &Path, options: &RunOptions, watch: &mut dyn RunObserver) -> Result<RunOutcome> {
    run_on(&Ranks::default(), path, options, watch).and_then(of_first_rank)
}

/// Runs the scene at `path` on several `ranks`, each of which calls this function with the same arguments. The first rank writes
/// the files and reports to its `watch`; the others return `None`.
///
/// # Errors
/// On the first rank, those of [`run`]; on another, that of its step, if the first rank's did not fail.
pub fn run_on(
    ranks: &Ranks,
    path: &Path,
    options: &RunOptions,
    watch: &mut dyn RunObserver,
) -> Result<Option<RunOutcome>> {
    let file = run_folder::scene_file(path);
    let prepared = || Ok((thread_pool(options.threads)?, Scene::read(&file, &options.overrides)?));
    let digest = |(_, scene): &(_, Scene)| orders::scene_digest(scene, file.parent().unwrap_or(Path::new("")));
    match ranks.agree(prepared(), digest) {
        Err(_) if ranks.rank() > 0 => Ok(None),
        prepared => {
            let (pool, scene) = prepared?;
            let (text, out, overrides) = (None, options.out.as_deref(), &options.overrides[..]);
            let origin = RunOrigin::Fresh { file: &file, text, out, overrides };
            pool.install(|| by_dimension(&scene, origin, ranks, watch))
        }
    }
}

/// Runs the scene in `text`. The files that the scene names must be in `folder`, as in [`Scene::parse`].
///
/// # Errors
/// As [`run`].
pub fn run_text(text: &str, folder: &Path, options: &RunOptions, watch: &mut dyn RunObserver) -> Result<RunOutcome> {
    let scene = Scene::parse(text, folder, &options.overrides)?;
    let (file, out) = (folder.join("scene.toml"), options.out.as_deref());
    let origin = RunOrigin::Fresh { file: &file, text: Some(text), out, overrides: &options.overrides };
    with_threads(options.threads, || by_dimension(&scene, origin, &Ranks::default(), watch)).and_then(of_first_rank)
}

/// Writes the scene `text` to `folder/scene/scene.toml`. Copies beside it the files in `from` that `scene`, parsed from `text`,
/// names. Returns the path of the scene.
///
/// # Errors
/// `File` if a file cannot be read or written.
pub fn copy_text_scene(text: &str, from: &Path, scene: &Scene, folder: &Path) -> Result<PathBuf> {
    run_folder::copy_scene(&from.join("scene.toml"), Some(text), &scene.to_toml()?, folder)?;
    Ok(folder.join(run_folder::SCENE))
}

/// Continues the interrupted run in `folder`; the results are bitwise identical to an uninterrupted run. The run continues from
/// its last checkpoint or, if that is missing or damaged, from the previous one; the manifest then records a warning. `guards`
/// holds keys of the scene's `[guard]`, or `model.device`, and their new values: a run that a guard stopped can continue with
/// another guard.
///
/// # Errors
/// `Restart` if the run has finished or is still in progress, holds no complete checkpoint, or its scene has changed
/// since; `Usage` if `guards` names any other key; otherwise as [`run`].
pub fn resume(
    folder: &Path,
    guards: &[(String, String)],
    threads: Option<usize>,
    watch: &mut dyn RunObserver,
) -> Result<RunOutcome> {
    resume_on(&Ranks::default(), folder, guards, threads, watch).and_then(of_first_rank)
}

/// Continues the interrupted run in `folder` on several `ranks`, as [`run_on`] runs a scene. The number of ranks may have
/// changed.
///
/// # Errors
/// As [`resume`] and [`run_on`].
pub fn resume_on(
    ranks: &Ranks,
    folder: &Path,
    guards: &[(String, String)],
    threads: Option<usize>,
    watch: &mut dyn RunObserver,
) -> Result<Option<RunOutcome>> {
    let prepared = || {
        let lock = if ranks.rank() == 0 { Some(lock_unfinished(folder)?) } else { None };
        let found = resume_point::latest_resume_point(folder)?.with_guard_overrides(folder, guards)?;
        Ok((thread_pool(threads)?, lock, found))
    };
    let digest = |(_, _, point): &(_, _, ResumePoint)| {
        let scene = orders::scene_digest(&point.scene, &folder.join("scene"));
        format!("{scene} {:x}", crate::output::checkpoint::fnv1a(&point.checkpoint.state))
    };
    match ranks.agree(prepared(), digest) {
        Err(_) if ranks.rank() > 0 => Ok(None),
        prepared => {
            let (pool, lock, ResumePoint { checkpoint, scene, warning }) = prepared?;
            let origin = RunOrigin::Resumed { folder, checkpoint: Box::new(checkpoint), warning, lock };
            pool.install(|| by_dimension(&scene, origin, ranks, watch))
        }
    }
}

/// Locks the `folder` of a run that has not finished.
fn lock_unfinished(folder: &Path) -> Result<Lock> {
    Manifest::read(folder)?;
    let lock = Lock::acquire(folder)?;
    // The manifest is read again under the lock, because a run in progress may have finished since.
    if Manifest::read(folder)?.status == RunStatus::Finished {
        let what = format!("the run in {} has finished: there is nothing to go on with", folder.display());
        return Err(
            Error::new(ErrorKind::Restart, what).help("`pontoon run` with a larger --until starts a longer one")
        );
    }
    Ok(lock)
}

/// The outcome of a run that the first rank leads.
pub(crate) fn of_first_rank(outcome: Option<RunOutcome>) -> Result<RunOutcome> {
    outcome.ok_or_else(|| Error::new(ErrorKind::Usage, "the first rank alone has the outcome of a run"))
}

/// The origin of a run.
enum RunOrigin<'a> {
    /// A scene file. The run's folder is `out`, or the program chooses it. If `text` is given, it replaces the content of the
    /// file, which need not exist.
    Fresh { file: &'a Path, text: Option<&'a str>, out: Option<&'a Path>, overrides: &'a [(String, String)] },
    /// A checkpoint in the run's folder.
    Resumed { folder: &'a Path, checkpoint: Box<Checkpoint>, warning: Option<String>, lock: Option<Lock> },
}

/// Selects the dimension; no other function does.
fn by_dimension(
    scene: &Scene,
    origin: RunOrigin,
    ranks: &Ranks,
    watch: &mut dyn RunObserver,
) -> Result<Option<RunOutcome>> {
    match scene.dimension {
        #[cfg(feature = "dim2")]
        2 => run_in_dimension::<2>(scene, origin, ranks, watch),
        #[cfg(feature = "dim3")]
        3 => run_in_dimension::<3>(scene, origin, ranks, watch),
        other => Err(missing_dimension(other)),
    }
}

fn run_in_dimension<const D: usize>(
    scene: &Scene,
    origin: RunOrigin,
    ranks: &Ranks,
    watch: &mut dyn RunObserver,
) -> Result<Option<RunOutcome>>
where
    Dim<D>: Dimension<D>,
{
    if ranks.rank() > 0 {
        let checkpoint = match origin {
            RunOrigin::Fresh { .. } => None,
            RunOrigin::Resumed { checkpoint, .. } => Some(*checkpoint),
        };
        return orders::follow::<D>(scene, checkpoint, ranks).map(|()| None);
    }
    runner::Runner::<D>::new(scene, origin, ranks)?.run(scene.renamed_names(), watch).map(Some)
}

/// Returns the error for a scene whose dimension is not compiled into this program.
pub(crate) fn missing_dimension(dimension: usize) -> Error {
    Error::new(ErrorKind::Usage, format!("this program was built without the {dimension}-D engine"))
        .help(format!("build it with the feature dim{dimension}: cargo build --release --features dim{dimension}"))
}

/// Runs `work` in a pool of `threads` threads and returns its result.
fn with_threads<T: Send>(threads: Option<usize>, work: impl FnOnce() -> Result<T> + Send) -> Result<T> {
    thread_pool(threads)?.install(work)
}

/// Largest number of threads of a run. More than the processors make it slower.
pub const MOST_THREADS: usize = 1024;

/// Creates a pool of `threads` threads, by default one for each processor.
///
/// # Errors
/// `Usage` if the number is not from 1 to [`MOST_THREADS`], or the threads cannot be started.
pub fn thread_pool(threads: Option<usize>) -> Result<rayon::ThreadPool> {
    if let Some(count) = threads.filter(|count| !(1..=MOST_THREADS).contains(count)) {
        let what = format!("{count} threads cannot be had: from 1 to {MOST_THREADS}");
        return Err(Error::new(ErrorKind::Usage, what).help("leave the number out to use one for each processor"));
    }
    rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).build().map_err(|why| {
        Error::new(ErrorKind::Usage, format!("the threads cannot be started: {why}"))
            .help("ask for fewer with --threads")
    })
}
