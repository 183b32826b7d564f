//! Paddles that absorb waves: the period to which they are tuned, the limits of their motion, and the share of other waves that
//! they send back.

use serde::Serialize;

use super::PreflightContext;
use crate::solid::Role;

/// Periods of a shorter and a longer wave, over the period to which a paddle is tuned, –.
const BESIDE: [f64; 2] = [2.0 / 3.0, 1.5];

/// A paddle that absorbs the waves which come to it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AbsorberSummary {
    /// Name of the solid.
    pub solid: String,
    /// Period of the waves that it absorbs completely, s.
    pub period_s: f64,
    /// Distance from its face to its gauge, m.
    pub gauge_m: f64,
    /// Largest stroke from end to end, m.
    pub stroke_m: f64,
    /// Largest speed, m/s.
    pub speed_mps: f64,
    /// For a shorter and a longer wave: the period (s), and the share (–) of the amplitude that the paddle sends back by linear
    /// theory.
    pub sends_back: [(f64, f64); 2],
}

impl<const D: usize> PreflightContext<'_, D> {
    /// The paddles that absorb.
    pub(super) fn absorbers(&self) -> Vec<AbsorberSummary> {
        let one = |solid: &crate::solid::Solid<D>| {
            let Role::Driven(motion) = &solid.spec.role else { return None };
            let own = motion.absorber()?;
            let (stroke_m, speed_mps) = own.motion_limits();
            Some(AbsorberSummary {
                solid: solid.spec.name.clone(),
                period_s: own.period(),
                gauge_m: own.gauge_distance(),
                stroke_m,
                speed_mps,
                sends_back: BESIDE
                    .map(|share| (share * own.period(), own.reflection_coefficient(share * own.period()))),
            })
        };
        self.solids().iter().filter_map(one).collect()
    }
}
