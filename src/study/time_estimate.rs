//! How long a list of runs will take: from the runs that have finished, else from a usual speed.

use super::{Job, JobResult, JobState};
use crate::{error::Result, scene::SizeEstimate};

/// Water particles × force passes a second of one thread, in 2-D and 3-D, where no run has told yet: half of what
/// `pontoon bench` gives on a slow machine with the default laws.
pub const DEFAULT_SPEED: [f64; 2] = [4e6, 1.2e6];

/// A job before it is run.
#[derive(Clone, Debug, PartialEq)]
pub struct TimeEstimate {
    /// About how large it is.
    pub size: SizeEstimate,
    /// About how long it will take, s; 0 if it has been run.
    pub seconds: f64,
    /// Whether the speed is that of a run that has finished, not the usual one.
    pub measured: bool,
}

/// The sizes and times of `jobs`, of which `ran` is known, on `threads` threads.
///
/// A run's time is taken as proportional to water particles × steps × passes; the speed is that of the
/// finished runs of the same group, else of the same dimension, else the usual one.
///
/// # Errors
/// Those of a scene's words: nothing should be run then.
pub fn estimate_times(jobs: &[Job], ran: &[JobResult], threads: usize) -> Result<Vec<TimeEstimate>> {
    let sizes = jobs.iter().map(Job::estimated_size).collect::<Result<Vec<SizeEstimate>>>()?;
    let speed = |same: &dyn Fn(usize) -> bool| {
        let finished =
            (0..jobs.len()).filter(|&i| ran.get(i).is_some_and(|r| r.state == JobState::Finished) && same(i));
        let known = finished.filter_map(|i| Some((sizes[i].particle_passes(), ran[i].manifest.as_ref()?.wall_s)));
        let (work, wall) = known.fold((0.0, 0.0), |sum, x| (sum.0 + x.0, sum.1 + x.1));
        (wall > 0.0).then(|| work / wall)
    };
    let planned = |i: usize| {
        let size = sizes[i];
        let alike = speed(&|j| jobs[j].group == jobs[i].group && sizes[j].dimension == size.dimension);
        let told = alike.or_else(|| speed(&|j| sizes[j].dimension == size.dimension));
        let rate = told.unwrap_or(DEFAULT_SPEED[size.dimension - 2] * threads as f64);
        let left = match ran.get(i).map(|r| (&r.state, &r.manifest)) {
            Some((JobState::Finished | JobState::Failed(_), Some(_))) => 0.0,
            Some((JobState::Interrupted, Some(m))) => 1.0 - m.simulated_s / m.until_s,
            _ => 1.0,
        };
        TimeEstimate { size, seconds: left * size.particle_passes() / rate, measured: told.is_some() }
    };
    Ok((0..jobs.len()).map(planned).collect())
}
