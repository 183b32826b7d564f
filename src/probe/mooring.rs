//! Tension, touchdown and angle of a mooring line with mass.

use serde::{Deserialize, Serialize};

use super::{Probe, ProbeDefinition, ProbeReads, ProbeScope};
use crate::{
    error::Result,
    simulation::{Simulation, find_by_name},
    system::System,
};

/// Plan of a probe of a mooring line with mass.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct MooringPlan {
    /// The line's name.
    pub mooring: String,
}

impl ProbeDefinition for MooringPlan {
    type Config = String;
    const LABEL: &'static str = "mooring line";
    const EXAMPLE: &'static str = "mooring = \"west\"";

    fn verify(config: &String, key: &str, scene: &dyn ProbeScope) -> Result<()> {
        scene.require_constraint(key, "mooring", config)
    }

    fn from_config(config: &String) -> Self {
        Self { mooring: config.clone() }
    }

    fn default_name(config: &String) -> Option<String> {
        Some(config.clone())
    }

    fn build<const D: usize>(&self, system: &System<D>) -> Result<Box<dyn Probe<D>>> {
        Ok(Box::new(MooringProbe::new(system, &self.mooring)?))
    }
}

/// Measures the tension (N; N/m in 2-D) of a mooring line at its first end (the fairlead), at its second end (the anchor), at a
/// quarter, half and three quarters of its length from the first end, and the largest tension. Also measures the length (m) that lies on fixed solids, and the angle (deg) of the second end above the horizontal. The tension at an end is the
/// mean force over the last step on the solid or point that holds it.
pub struct MooringProbe {
    line: usize,
}

/// Shares of the length at which the tension along a line is measured, with their names.
const ALONG: [(&str, f64); 3] = [("quarter", 0.25), ("middle", 0.5), ("three_quarters", 0.75)];

impl MooringProbe {
    /// Creates the probe of the mooring line called `name`.
    ///
    /// # Errors
    /// `Scene` if there is no such line.
    pub fn new<const D: usize>(system: &System<D>, name: &str) -> Result<Self> {
        let moorings = &system.constraints().moorings;
        let line = find_by_name("mooring", name, moorings.iter().map(|mooring| mooring.name.as_str()))?;
        Ok(Self { line })
    }
}

impl<const D: usize> Probe<D> for MooringProbe {
    fn reads(&self) -> ProbeReads {
        ProbeReads::Solids
    }

    fn columns(&self) -> Vec<String> {
        let unit = if D == 2 { "N_per_m" } else { "N" };
        let tensions = ["fairlead", "anchor"].into_iter().chain(ALONG.map(|(name, _)| name)).chain(["largest"]);
        let shape = ["on_bed_m", "anchor_angle_deg"].map(String::from);
        tensions.map(|name| format!("{name}_{unit}")).chain(shape).collect()
    }

    fn sample(&self, sim: &Simulation<D>) -> Vec<f64> {
        let now = sim.mooring_reading(self.line);
        let along = ALONG.map(|(_, share)| tension_at(&now.tensions, share));
        let largest = now.tensions.iter().copied().fold(0.0, f64::max);
        let shape = [now.on_bed, now.anchor_angle.to_degrees()];
        let ends = now.end_forces.map(|force| force.norm());
        ends.into_iter().chain(along).chain([largest]).chain(shape).collect()
    }
}

/// Returns the tension at the place of `share` of the length, interpolated between the middles of the segments; 0 without
/// segments, as while a line does not act.
fn tension_at(tensions: &[f64], share: f64) -> f64 {
    let Some(last) = tensions.len().checked_sub(1) else { return 0.0 };
    let place = (share * tensions.len() as f64 - 0.5).clamp(0.0, last as f64);
    let (first, part) = (place.floor() as usize, place.fract());
    let second = (first + 1).min(last);
    tensions[first] + part * (tensions[second] - tensions[first])
}

#[cfg(test)]
#[path = "../../tests/unit/probe/mooring.rs"]
mod tests;
