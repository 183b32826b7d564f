//! Range and speed of a paddle for its wave, independent of the end time of a run.

use super::{LinearWave, PaddleMotion};
use crate::error::{Error, Result};

/// Samples per period, and the least and greatest number of samples.
const SAMPLES: f64 = 50.0;
const LEAST: f64 = 500.0;
const MOST: f64 = 10_000.0;

/// Number of periods that the code samples for an irregular sea.
const PERIODS: f64 = 20.0;

/// Ratio of paddle speed to crest speed above which small-motion theory is inaccurate.
pub(crate) const LINEAR_SPEED_RATIO_MAX: f64 = 0.5;

impl PaddleMotion {
    /// Returns successive samples of the displacement (m) and rate (m/s) of the face at the still level. For a regular
    /// wave the samples cover the motion at full amplitude; for a solitary wave, the whole motion. For other waves the
    /// samples extend to `until` (s), or over twenty periods if that is longer.
    pub(crate) fn sample_motion(&self, until: f64) -> Vec<(f64, f64)> {
        let period = self.facts.linear_wave.map_or(f64::INFINITY, |train| train.period());
        let many = until.max(self.ramp + PERIODS * period);
        let (from, to) = match (self.facts.solitary, self.facts.focus) {
            (Some(own), _) => (0.0, own.duration()),
            (_, Some((_, time))) => (0.0, many.max(time + 2.0 * period)),
            _ if self.facts.kind == "regular" => (self.ramp, self.ramp + 2.0 * period),
            _ => (0.0, many),
        };
        let steps = (SAMPLES * (to - from) / period).clamp(LEAST, MOST).ceil() as usize;
        (0..=steps).map(|i| self.displacement(from + (to - from) * i as f64 / steps as f64)).collect()
    }

    /// Refuses the regular wave `train` if the paddle would move faster than the wave crests allow.
    pub(super) fn check_speed(self, train: &LinearWave) -> Result<Self> {
        let (speed, celerity) =
            (self.sample_motion(0.0).iter().map(|x| x.1.abs()).fold(0.0, f64::max), train.celerity());
        if speed <= celerity {
            return Ok(self);
        }
        // The first-order speed is proportional to the height, the second-order speed to the square of the height.
        let height = LINEAR_SPEED_RATIO_MAX * celerity / speed * self.facts.height;
        let shorter = train.stokes_period_max(self.facts.height).filter(|period| *period < train.period());
        let shorter =
            shorter.map(|period| format!("; Stokes' theory holds from  period = {:.2}  down", period - 0.005));
        let what = format!("the paddle would go at {speed:.3} m/s, faster than the crests, {celerity:.3} m/s");
        Err(Error::scene(what)
            .help(format!("height = {height:.4}  keeps it below half of that{}", shorter.unwrap_or_default())))
    }
}
