//! One case run in memory, on one thread, within a budget, whatever happens in it.

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
    model::Dimension,
    run::{missing_dimension, thread_pool},
    simulation::Simulation,
    solid::Dim,
};

/// Water and wet boundary particles × force passes that a case may take: about half a minute of a slow processor in 2-D, two
/// in 3-D. In particles, not seconds, so that every machine cuts the same cases.
pub(crate) const BUDGET: f64 = 1.5e8;

/// What came out of a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CaseRun {
    /// The map.
    pub map: String,
    /// The values along its axes.
    pub values: Vec<String>,
    /// What makes it another than any other.
    pub key: String,
    /// How it ended.
    pub end: CaseEnd,
    /// What was measured.
    pub figures: MeasuredFigures,
    /// Simulated time reached, s.
    pub time_s: f64,
    /// Steps.
    pub steps: u64,
    /// Water particles.
    pub water: usize,
    /// Processor time, s.
    pub cpu_s: f64,
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CaseEnd {
    /// At its end.
    Reached,
    /// The budget was used up.
    Cut,
    /// It could not go on, for the reason said.
    Stopped(String),
    /// It was refused before the first step, for the reason said.
    Refused(String),
    /// The program panicked.
    Panicked(String),
}

impl CaseRun {
    /// Runs `case`.
    ///
    /// # Errors
    /// `Usage` if its thread cannot be started. That the run fails is no error: the trial says so.
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
            // What is left of a run that panicked is thrown away whole; only numbers already written are kept.
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

    /// How it is to be taken: `missed` is what of its figures misses a bound.
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
        // A rescue would move the border that is asked for.
        let tied = !built.setup.constraints.is_empty();
        let mut sim = Simulation::new(built.setup)?.without_rollback();
        if tied {
            // What springs and motors do is no energy made.
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
            // Of what belongs to the second half or the end nothing is known.
            let asked = case.criteria.bounds();
            asked.into_iter().for_each(|(name, _)| _ = self.figures.entry(name).or_insert(0.0));
        }
        end
    }
}

/// An error in one line.
fn one_line(error: &Error) -> String {
    error.message.lines().next().unwrap_or_default().into()
}

fn panic_message(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|s| s.to_string()).or_else(|| panic.downcast_ref::<String>().cloned());
    text.unwrap_or_else(|| "panicked without words".into())
}
