//! Runs one case in memory, on one thread and within a budget. The module handles every failure of the run.

use std::panic::{AssertUnwindSafe, catch_unwind};

use cpu_time::ThreadTime;
use serde::{Deserialize, Serialize};

use super::{
    StressCase,
    criteria::{CaseOutcome, MeasuredFigures},
    measurements::Measurements,
};
use crate::{
    error::{Error, ErrorKind, Result},
    run::{missing_dimension, thread_pool},
    simulation::{Dimension, Simulation},
    solid::Dim,
};

/// The largest product of particles (water and wet boundary) and force passes of a case. On a slow processor, this
/// budget takes about half a minute in 2-D and two minutes in 3-D. A budget in particles stops the same cases on every
/// machine, unlike a budget in seconds.
pub(crate) const BUDGET: f64 = 1.5e8;

/// The result of a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CaseRun {
    /// The name of the map.
    pub map: String,
    /// The values along the axes.
    pub values: Vec<String>,
    /// The key that identifies the case.
    pub key: String,
    /// The end of the run.
    pub end: CaseEnd,
    /// The measured figures.
    pub figures: MeasuredFigures,
    /// The simulated time reached, s.
    pub time_s: f64,
    /// The number of steps.
    pub steps: u64,
    /// The number of water particles.
    pub water: usize,
    /// The processor time, s.
    pub cpu_s: f64,
}

/// The way in which a run ended.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CaseEnd {
    /// The run reached its end time.
    Reached,
    /// The budget ended before the run.
    Cut,
    /// The run stopped for the given reason.
    Stopped(String),
    /// The program rejected the case before the first step, for the given reason.
    Refused(String),
    /// The program panicked.
    Panicked(String),
}

impl CaseRun {
    /// Runs `case`, and returns its result.
    ///
    /// # Errors
    /// `Usage` if the thread cannot be started. A failure of the run is not an error; the result contains the failure.
    pub(crate) fn execute(case: &StressCase) -> Result<Self> {
        let mut trial = Self {
            map: case.map.clone(),
            values: case.values.clone(),
            key: case.key.clone(),
            end: CaseEnd::Reached,
            figures: MeasuredFigures::new(),
            time_s: 0.0,
            steps: 0,
            water: 0,
            cpu_s: 0.0,
        };
        let pool = thread_pool(Some(1))?;
        let attempt = || {
            let begun = ThreadTime::now();
            // The program discards all data of a run that panicked, and keeps only the numbers already recorded.
            let end = catch_unwind(AssertUnwindSafe(|| match case.scene.dimension {
                #[cfg(feature = "dim2")]
                2 => trial.step_through::<2>(case),
                #[cfg(feature = "dim3")]
                3 => trial.step_through::<3>(case),
                other => Err(missing_dimension(other)),
            }));
            trial.end = match end {
                Ok(Ok(end)) => end,
                Ok(Err(error)) if error.kind == ErrorKind::Fault => CaseEnd::Stopped(one_line(&error)),
                Ok(Err(error)) => CaseEnd::Refused(one_line(&error)),
                Err(panic) => CaseEnd::Panicked(panic_message(panic.as_ref())),
            };
            trial.cpu_s = begun.elapsed().as_secs_f64();
        };
        pool.install(attempt);
        Ok(trial)
    }

    /// Returns the outcome of the case; `missed` contains the figures that exceed their bounds.
    pub(crate) fn outcome(&self, missed: &[String]) -> CaseOutcome {
        match &self.end {
            CaseEnd::Panicked(_) => CaseOutcome::Wrong,
            CaseEnd::Stopped(_) | CaseEnd::Refused(_) => CaseOutcome::Stopped,
            _ if !missed.is_empty() => CaseOutcome::Wrong,
            CaseEnd::Cut => CaseOutcome::Unfinished,
            CaseEnd::Reached => CaseOutcome::Right,
        }
    }

    fn step_through<const D: usize>(&mut self, case: &StressCase) -> Result<CaseEnd>
    where
        Dim<D>: Dimension<D>,
    {
        let built = case.scene.build::<D>()?;
        let level = built.setup.surface_levels.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        // A rollback would change the limit that the case explores.
        let tied = !built.setup.constraints.is_empty();
        let mut sim = Simulation::new(built.setup)?.without_rollback();
        if tied {
            // The work of springs and motors does not count as spurious energy.
            sim.enable_load_breakdown();
        }
        self.water = sim.system().fluid().len();
        let mut measure = Measurements::new(case, &sim, level)?;
        let (mut spent, mut passes) = (0.0, sim.force_passes());
        let end = loop {
            if sim.time() >= case.scene.until {
                break Ok(CaseEnd::Reached);
            }
            if spent > BUDGET {
                break Ok(CaseEnd::Cut);
            }
            let before = sim.time();
            if let Err(error) = sim.step_to(case.scene.until) {
                break Err(error);
            }
            measure.step(&sim, sim.time() - before)?;
            spent +=
                ((sim.force_passes() - passes) as f64) * (self.water + sim.system().boundary_near_fluid_count()) as f64;
            passes = sim.force_passes();
        };
        (self.time_s, self.steps) = (sim.time(), sim.steps());
        self.figures = measure.figures();
        if matches!(end, Ok(CaseEnd::Cut)) {
            // Figures of the second half or of the end of the run are unknown.
            let asked = case.criteria.bounds();
            asked.into_iter().for_each(|(name, _)| _ = self.figures.entry(name).or_insert(0.0));
        }
        end
    }
}

/// Returns an error as one line of text.
fn one_line(error: &Error) -> String {
    error.message.lines().next().unwrap_or_default().into()
}

fn panic_message(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|s| s.to_string()).or_else(|| panic.downcast_ref::<String>().cloned());
    text.unwrap_or_else(|| "panicked without words".into())
}
