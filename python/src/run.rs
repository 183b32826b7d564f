//! Starts, resumes and reads runs with their files.

use std::{
    path::{Path, PathBuf},
    sync::{
        Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
        mpsc::{self, RecvTimeoutError},
    },
    time::Duration,
};

use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pontoon::{
    Result,
    error::Error,
    output::{FramePoints, FrameSequence, manifest::RunStatus},
    run::{
        Progress, RunObserver, RunOutcome, RunStart, StatisticsFilter, resume as resume_run,
        statistics as run_statistics,
    },
};
use pyo3::{exceptions::PyRuntimeError, prelude::*, types::PyDict};

use crate::{
    error::{OrRaise, usage},
    threads::with_threads,
};

/// Wall time between two checks for signals, and between two calls of the progress function.
pub const LOOK: Duration = Duration::from_millis(50);

/// The end of a run: its folder, its status, and whether a check exceeds its bound.
pub type Ended = (PathBuf, &'static str, bool);

/// What a run and the thread that waits for it share.
#[derive(Default)]
struct Shared {
    stop: AtomicBool,
    progress: Mutex<(PathBuf, Option<Progress>)>,
}

/// The observer on the side of the run.
struct Watch<'a>(&'a Shared);

impl RunObserver for Watch<'_> {
    fn start(&mut self, start: &RunStart) {
        self.0.progress.lock().unwrap_or_else(PoisonError::into_inner).0 = start.folder.to_owned();
    }

    fn step(&mut self, now: &Progress) -> bool {
        self.0.progress.lock().unwrap_or_else(PoisonError::into_inner).1 = Some(*now);
        !self.0.stop.load(Ordering::Relaxed)
    }
}

/// Runs `job` on a thread of its own. Meanwhile the calling thread checks for signals and calls `progress`; a signal or `False`
/// stops the run with a checkpoint.
///
/// # Errors
/// The error of the run, or the exception of the signal or of `progress`, with the folder of the run in its attribute
/// `folder`.
pub fn watched(
    py: Python<'_>,
    job: impl FnOnce(&mut dyn RunObserver) -> Result<RunOutcome> + Send,
    progress: Option<Py<PyAny>>,
) -> PyResult<Ended> {
    let shared = Shared::default();
    let (outcome, raised) = py.detach(|| run_and_watch(job, &shared, progress.as_ref()));
    let folder = shared.progress.lock().unwrap_or_else(PoisonError::into_inner).0.clone();
    if let Some(why) = raised {
        // An exception without attributes is raised as it is.
        let _ = why.value(py).setattr("folder", folder);
        return Err(why);
    }
    let outcome = outcome.ok_or_else(|| PyRuntimeError::new_err("the run ended with an internal error"))?;
    if progress.is_some() && outcome.is_ok() {
        tell(py, &shared, progress.as_ref())?;
    }
    let outcome = outcome.or_raise(py)?;
    let status = match outcome.manifest.status {
        RunStatus::Interrupted => "interrupted",
        _ => "finished",
    };
    let failed = outcome.has_failed_checks();
    Ok((outcome.folder, status, failed))
}

/// Runs `job` on a thread of its own; meanwhile checks for signals and calls `progress`. Returns the outcome, which is absent
/// after an internal error, and the first exception.
fn run_and_watch(
    job: impl FnOnce(&mut dyn RunObserver) -> Result<RunOutcome> + Send,
    shared: &Shared,
    progress: Option<&Py<PyAny>>,
) -> (Option<Result<RunOutcome>>, Option<PyErr>) {
    let mut raised = None;
    let outcome = std::thread::scope(|scope| {
        let (done, finished) = mpsc::channel();
        // The receiver waits for it.
        scope.spawn(move || drop(done.send(job(&mut Watch(shared)))));
        loop {
            match finished.recv_timeout(LOOK) {
                Ok(outcome) => break Some(outcome),
                Err(RecvTimeoutError::Disconnected) => break None,
                Err(RecvTimeoutError::Timeout) if raised.is_some() => {}
                Err(RecvTimeoutError::Timeout) => {
                    let look = |py: Python<'_>| py.check_signals().and_then(|()| tell(py, shared, progress));
                    if let Err(why) = Python::attach(look) {
                        shared.stop.store(true, Ordering::Relaxed);
                        raised = Some(why);
                    }
                }
            }
        }
    });
    (outcome, raised)
}

/// Calls `progress` with the last progress, if there is one; `False` stops the run.
fn tell(py: Python<'_>, shared: &Shared, progress: Option<&Py<PyAny>>) -> PyResult<()> {
    let Some(call) = progress else { return Ok(()) };
    let (folder, now) = shared.progress.lock().unwrap_or_else(PoisonError::into_inner).clone();
    let Some(now) = now else { return Ok(()) };
    let answer = call.call1(py, (folder, now.time, now.until, now.dt, now.steps, now.wall))?;
    if matches!(answer.extract::<bool>(py), Ok(false)) {
        shared.stop.store(true, Ordering::Relaxed);
    }
    Ok(())
}

/// Goes on with the interrupted run in `folder`, with changed keys of its guard.
#[pyfunction]
pub fn resume(
    py: Python<'_>,
    folder: PathBuf,
    guards: Vec<(String, String)>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Ended> {
    watched(py, |watch: &mut dyn RunObserver| resume_run(&folder, &guards, threads, watch), progress)
}

/// Returns the statistics of the run in `folder` as JSON: rows, RAOs and remarks.
#[pyfunction]
pub fn statistics(
    py: Python<'_>,
    folder: PathBuf,
    series: Option<String>,
    start: Option<f64>,
    end: Option<f64>,
) -> PyResult<String> {
    let asked = StatisticsFilter { series, from: start, until: end };
    let all = py.detach(|| with_threads(|| run_statistics(&folder, &asked))).or_raise(py)?;
    let json = serde_json::json!({ "rows": all.rows, "raos": all.raos, "remarks": all.remarks });
    serde_json::to_string(&json).map_err(|why| usage(py, &why.to_string(), ""))
}

/// Writes the page of the run in `folder` and returns its path.
#[pyfunction]
pub fn write_report(py: Python<'_>, folder: PathBuf) -> PyResult<PathBuf> {
    py.detach(|| with_threads(|| pontoon::report::write(&folder))).map(|page| page.path).or_raise(py)
}

/// Returns the unit of a column by its name.
#[pyfunction]
pub fn unit(column: &str) -> &'static str {
    pontoon::math::format::unit(column)
}

fn frames(folder: &Path) -> Result<FrameSequence> {
    FrameSequence::open(folder)?.ok_or_else(|| {
        Error::new(pontoon::error::ErrorKind::Usage, format!("the run in {} has no frames", folder.display()))
            .help("set frames.every in the scene")
    })
}

/// Returns the times of the frames of the run in `folder`, s; none if it has no frames.
#[pyfunction]
pub fn frame_times(py: Python<'_>, folder: PathBuf) -> PyResult<Vec<f64>> {
    let frames = FrameSequence::open(&folder).or_raise(py)?;
    Ok(frames.map_or_else(Vec::new, |frames| frames.times().to_vec()))
}

/// Returns the arrays of the water, or of the boundary particles, in frame `number`.
#[pyfunction]
pub fn frame<'py>(py: Python<'py>, folder: PathBuf, number: usize, solids: bool) -> PyResult<Bound<'py, PyDict>> {
    let read = || {
        let frames = frames(&folder)?;
        if solids { frames.solids(number) } else { frames.water(number) }
    };
    let points: FramePoints = py.detach(read).or_raise(py)?;
    let arrays = PyDict::new(py);
    let triples = |x: &[[f32; 3]]| -> PyResult<Bound<'py, PyArray2<f32>>> {
        PyArray1::from_slice(py, x.as_flattened()).reshape([x.len(), 3])
    };
    arrays.set_item("position", triples(&points.position)?)?;
    if !points.velocity.is_empty() {
        arrays.set_item("velocity", triples(&points.velocity)?)?;
    }
    for (name, field) in [("density", points.density), ("pressure", points.pressure), ("solid", points.solid_index)] {
        if !field.is_empty() {
            arrays.set_item(name, PyArray1::from_vec(py, field))?;
        }
    }
    if !points.id.is_empty() {
        arrays.set_item("id", PyArray1::from_vec(py, points.id))?;
    }
    Ok(arrays)
}
