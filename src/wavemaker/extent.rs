//! How far and how fast a paddle goes for its wave, whatever the time at which a run ends.

use super::{LinearWave, PaddleMotion};
use crate::error::{Error, Result};

/// Samples of a period, and how many there are at least and at most.
const SAMPLES: f64 = 50.0;
const LEAST: f64 = 500.0;
const MOST: f64 = 10_000.0;

/// Periods of a sea that are looked at.
const PERIODS: f64 = 20.0;

/// Speed of a paddle over that of its crests beyond which small motions are no good theory.
pub(crate) const LINEAR_SPEED_RATIO_MAX: f64 = 0.5;

impl PaddleMotion {
    /// Displacement (m) and rate (m/s) of the face at the still level, one after the other: of a regular wave in full
    /// motion, of a solitary one all the way, of another to `until` (s), or for twenty periods if that is longer.
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

    /// Refuses the regular wave of `train` whose paddle would run ahead of its crests.
    pub(super) fn check_speed(self, train: &LinearWave) -> Result<Self> {
        let (speed, celerity) =
            (self.sample_motion(0.0).iter().map(|x| x.1.abs()).fold(0.0, f64::max), train.celerity());
        if speed <= celerity {
            return Ok(self);
        }
        // The first order's speed goes with the height, the second's with its square.
        let height = LINEAR_SPEED_RATIO_MAX * celerity / speed * self.facts.height;
        let shorter = train.stokes_period_max(self.facts.height).filter(|period| *period < train.period());
        let shorter =
            shorter.map(|period| format!("; Stokes' theory holds from  period = {:.2}  down", period - 0.005));
        let what = format!("the paddle would go at {speed:.3} m/s, faster than the crests, {celerity:.3} m/s");
        Err(Error::scene(what)
            .help(format!("height = {height:.4}  keeps it below half of that{}", shorter.unwrap_or_default())))
    }
}
