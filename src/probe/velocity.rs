//! The water's velocity at a point: v(x) = Σ V_b v_b W / Σ V_b W.

use serde::{Deserialize, Serialize};

use super::{PointsConfig, Probe, ProbeDefinition, ProbeLocation, ProbeRow, ProbeScope, axes, interpolate, point};
use crate::{error::Result, math::Vector, simulation::Simulation, system::System};

/// Velocity of the water at points.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct VelocityPlan {
    /// The points, m.
    pub places: Vec<Vec<f64>>,
}

impl ProbeDefinition for VelocityPlan {
    type Config = PointsConfig;
    const LABEL: &'static str = "velocity of the water";
    const EXAMPLE: &'static str = "velocity = [0.75, 0.03]";

    fn verify(config: &PointsConfig, key: &str, scene: &dyn ProbeScope) -> Result<()> {
        config.verify(key, scene)
    }

    fn from_config(config: &PointsConfig) -> Self {
        Self { places: config.places() }
    }

    fn location(&self) -> Option<ProbeLocation<'_>> {
        Some(ProbeLocation::Points(&self.places))
    }

    fn build<const D: usize>(&self, _: &System<D>) -> Result<Box<dyn Probe<D>>> {
        ProbeRow::at_places(&self.places, |at| Ok(Box::new(VelocityProbe::new(at)?)))
    }
}

/// Measures the velocity (m/s) of the water at a fixed point. The velocity is NaN while the point is dry.
pub struct VelocityProbe<const D: usize> {
    at: Vector<D>,
}

impl<const D: usize> VelocityProbe<D> {
    /// Creates the probe at the point `at` (m; `D` coordinates).
    ///
    /// # Errors
    /// `Usage` if the number of coordinates differs from `D` or a coordinate is not finite.
    pub fn new(at: &[f64]) -> Result<Self> {
        Ok(Self { at: point(at, D)? })
    }
}

impl<const D: usize> Probe<D> for VelocityProbe<D> {
    fn columns(&self) -> Vec<String> {
        axes::<D>().iter().map(|a| format!("v{a}_mps")).collect()
    }

    fn sample(&self, sim: &Simulation<D>) -> Vec<f64> {
        let v = sim.system().fluid().v;
        let mean = interpolate(sim.system(), &self.at, |b, _| -> [f64; D] { v[b].into() });
        mean.unwrap_or([f64::NAN; D]).to_vec()
    }
}
