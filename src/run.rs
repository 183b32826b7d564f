//! The commands `run`, `resume` and `inspect` as functions: read the scene, choose the dimension, build,
//! step, record, check.
//!
//! ```no_run
//! use pontoon::run::{RunOptions, Progress, run};
//!
//! let mut watch = |now: &Progress| now.wall < 3600.0;   // false asks the run to stop
//! let outcome = run("scenes/raft".as_ref(), &RunOptions::default(), &mut watch)?;
//! assert!(outcome.folder.join("manifest.json").exists());
//! # Ok::<(), pontoon::Error>(())
//! ```

mod runner;
mod energy_drift;
pub(crate) mod run_folder;
mod inspect;
pub(crate) mod resume_point;
mod lock;
mod processor_time;
pub(crate) mod probe_factory;
pub(crate) mod outputs;
pub(crate) mod statistics;

pub use energy_drift::EnergyDrift;
#[doc(hidden)]
pub use inspect::{InspectOptions, InspectReport, MeshSummary, SeriesColumns, SolidSummary, StepTiming, inspect};
pub(crate) use lock::Lock;
#[doc(hidden)]
pub use lock::lock_owner;
#[doc(hidden)]
pub use statistics::{RAO_FILE, RaoResult, RunStatistics, SPECTRA_FILE, Statistic, StatisticsFilter, statistics};

use std::path::{Path, PathBuf};

use resume_point::ResumePoint;

use crate::{
    error::{Error, ErrorKind, Result},
    model::Dimension,
    output::{Checkpoint, Manifest, manifest::RunStatus},
    scene::{RenamedName, Scene},
    simulation::Rollback,
    solid::Dim,
};

/// What a run is asked for beside its scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunOptions {
    /// Folder for the results, new or empty. By default `runs/<scene>`, with a number if that is taken.
    pub out: Option<PathBuf>,
    /// Keys of the scene and the values that replace the scene's own, as in `("dp", "0.02")`.
    pub overrides: Vec<(String, String)>,
    /// Threads; by default one for each processor. They change the speed, never the result.
    pub threads: Option<usize>,
}

/// What is known when a run begins.
#[derive(Clone, Copy, Debug)]
pub struct RunStart<'a> {
    /// The run's folder.
    pub folder: &'a Path,
    /// What the manifest says at the start: caption, particles, threads, warnings.
    pub manifest: &'a Manifest,
    /// The keys and values that the scene writes with an old name.
    pub renamed: &'a [RenamedName],
}

/// How far a run is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Simulated time, s.
    pub time: f64,
    /// Simulated time at the end, s.
    pub until: f64,
    /// Last time step, s.
    pub dt: f64,
    /// Steps done.
    pub steps: u64,
    /// Wall time so far, s, that before an interruption included.
    pub wall: f64,
    /// Water and boundary particles beside it × force passes ÷ wall time of stepping, 1/s.
    pub rate: f64,
    /// What became of the energy, if a probe watches it.
    pub energy: Option<EnergyDrift>,
}

/// Someone who follows a run. Any `FnMut(&Progress) -> bool` does.
pub trait RunObserver: Send {
    /// Told once, before the first step.
    fn start(&mut self, start: &RunStart) {
        let _ = start;
    }

    /// Told when the run goes back to a good state after an alarm.
    fn rolled_back(&mut self, how: &Rollback) {
        let _ = how;
    }

    /// Told before the first step and after each; `false` asks the run to stop now, with a checkpoint.
    fn step(&mut self, now: &Progress) -> bool;
}

impl<F: FnMut(&Progress) -> bool + Send> RunObserver for F {
    fn step(&mut self, now: &Progress) -> bool {
        self(now)
    }
}

/// Where a free body is at the end.
#[derive(Clone, Debug, PartialEq)]
pub struct FinalBodyState {
    /// Its name.
    pub name: String,
    /// Position of its centre of mass, m.
    pub position: Vec<f64>,
    /// Speed of its centre of mass, m/s.
    pub speed: f64,
    /// Axial angles of its frame, deg: one in 2-D, a rotation vector in 3-D.
    pub rotation_deg: Vec<f64>,
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub struct RunOutcome {
    /// The run's folder.
    pub folder: PathBuf,
    /// The manifest as written there.
    pub manifest: Manifest,
    /// The free bodies.
    pub bodies: Vec<FinalBodyState>,
    /// The last of the manifest's warnings: those that only the end could tell.
    pub end_warnings: Vec<String>,
}

impl RunOutcome {
    /// Whether a check misses its bound.
    pub fn has_failed_checks(&self) -> bool {
        self.manifest.checks.iter().any(|verdict| verdict.passed == Some(false))
    }
}

/// Runs the scene at `path`, a folder with a `scene.toml` or such a file.
///
/// # Errors
/// `Scene`, `Usage`, `File` before anything is written or when a file cannot be written; `Fault` when the
/// computation cannot go on: then the run's folder holds everything up to then and `failure.json`.
pub fn run(path: &Path, options: &RunOptions, watch: &mut dyn RunObserver) -> Result<RunOutcome> {
    let file = run_folder::scene_file(path);
    let scene = Scene::read(&file, &options.overrides)?;
    let origin = RunOrigin::Fresh { file: &file, out: options.out.as_deref(), overrides: &options.overrides };
    with_threads(options.threads, || by_dimension(&scene, origin, watch))
}

/// Goes on with the interrupted run in `folder`, to the same bits as if it had not been interrupted: from its last
/// checkpoint, or the one before where that is missing or damaged; a warning in the manifest says so. `guards` are
/// keys of the scene's `[guard]` and their new values: a run that a guard stopped may go on with another.
///
/// # Errors
/// `Restart` if it has finished or still goes on, holds no whole checkpoint, or its scene has changed since;
/// `Usage` if `guards` names any other key; else as [`run`].
pub fn resume(
    folder: &Path,
    guards: &[(String, String)],
    threads: Option<usize>,
    watch: &mut dyn RunObserver,
) -> Result<RunOutcome> {
    Manifest::read(folder)?;
    let lock = Lock::acquire(folder)?;
    // Read again under the lock: a run that was still going on may have finished since.
    if Manifest::read(folder)?.status == RunStatus::Finished {
        let what = format!("the run in {} has finished: there is nothing to go on with", folder.display());
        return Err(
            Error::new(ErrorKind::Restart, what).help("`pontoon run` with a larger --until starts a longer one")
        );
    }
    let ResumePoint { checkpoint, scene, warning } =
        resume_point::latest_resume_point(folder)?.with_guard_overrides(folder, guards)?;
    let origin = RunOrigin::Resumed { folder, checkpoint: Box::new(checkpoint), warning, lock };
    with_threads(threads, || by_dimension(&scene, origin, watch))
}

/// Where a run comes from.
enum RunOrigin<'a> {
    /// A scene file, for the folder `out` or one of our choice.
    Fresh { file: &'a Path, out: Option<&'a Path>, overrides: &'a [(String, String)] },
    /// A checkpoint in the run's folder.
    Resumed { folder: &'a Path, checkpoint: Box<Checkpoint>, warning: Option<String>, lock: Lock },
}

/// Chooses the dimension: the one place.
fn by_dimension(scene: &Scene, origin: RunOrigin, watch: &mut dyn RunObserver) -> Result<RunOutcome> {
    match scene.dimension {
        #[cfg(feature = "dim2")]
        2 => run_in_dimension::<2>(scene, origin, watch),
        #[cfg(feature = "dim3")]
        3 => run_in_dimension::<3>(scene, origin, watch),
        other => Err(missing_dimension(other)),
    }
}

fn run_in_dimension<const D: usize>(scene: &Scene, origin: RunOrigin, watch: &mut dyn RunObserver) -> Result<RunOutcome>
where
    Dim<D>: Dimension<D>,
{
    runner::Runner::<D>::new(scene, origin)?.run(scene.renamed_names(), watch)
}

/// The error of a scene in a dimension that this program was built without.
pub(crate) fn missing_dimension(dimension: usize) -> Error {
    Error::new(ErrorKind::Usage, format!("this program was built without the {dimension}-D engine"))
        .help(format!("build it with the feature dim{dimension}: cargo build --release --features dim{dimension}"))
}

/// Runs `work` in a pool of `threads` threads.
fn with_threads<T: Send>(threads: Option<usize>, work: impl FnOnce() -> Result<T> + Send) -> Result<T> {
    thread_pool(threads)?.install(work)
}

/// A pool of `threads` threads, by default one for each processor.
pub(crate) fn thread_pool(threads: Option<usize>) -> Result<rayon::ThreadPool> {
    if threads == Some(0) {
        return Err(
            Error::new(ErrorKind::Usage, "0 threads cannot run anything").help("leave --threads out to use them all")
        );
    }
    rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).build().map_err(|why| {
        Error::new(ErrorKind::Usage, format!("the threads cannot be started: {why}"))
            .help("ask for fewer with --threads")
    })
}
