//! Estimates the duration of a list of runs from the finished runs, or from a default speed.

use super::{Job, JobResult, JobState};
use crate::{error::Result, preflight::DEFAULT_SPEED, scene::SizeEstimate};

/// An estimate of a job before its run.
#[derive(Clone, Debug, PartialEq)]
pub struct TimeEstimate {
    /// The estimated size.
    pub size: SizeEstimate,
    /// The estimated duration, s; 0 if the job has run.
    pub seconds: f64,
    /// Whether the speed comes from a finished run instead of the default.
    pub measured: bool,
}

/// Returns the sizes and durations of `jobs` on `threads` threads; `ran` contains the known results.
///
/// The duration of a run is proportional to water particles × steps × passes. The speed comes from the finished runs of
/// the same group, otherwise from those of the same dimension, otherwise from the default.
///
/// # Errors
/// The errors of reading a scene; no job should start after such an error.
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
