//! Paddles that absorb: what they are tuned to, what they may, and what they leave of other waves.

use serde::Serialize;

use super::PreflightContext;
use crate::solid::Role;

/// A shorter and a longer wave than that to which a paddle is tuned, over its period.
const BESIDE: [f64; 2] = [2.0 / 3.0, 1.5];

/// A paddle that takes the waves which come to it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AbsorberSummary {
    /// Name of the solid.
    pub solid: String,
    /// The period whose waves it takes whole, s.
    pub period_s: f64,
    /// From its face to its gauge, m.
    pub gauge_m: f64,
    /// How far it may go from end to end, m.
    pub stroke_m: f64,
    /// How fast it may go, m/s.
    pub speed_mps: f64,
    /// Periods of a shorter and a longer wave (s), and the share of their amplitude that goes out again by linear theory, –.
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
