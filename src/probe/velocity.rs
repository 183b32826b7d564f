//! The water's velocity at a point: v(x) = Σ V_b v_b W / Σ V_b W.

use serde::{Deserialize, Serialize};

use super::{
    PointsConfig, Probe, ProbeDefinition, ProbeLocation, ProbeRow, ProbeScope, axes, empty_row, interpolate,
    mounting::MountedPoint,
};
use crate::{
    error::Result,
    math::{Bounds, Vector},
    simulation::Simulation,
    system::System,
};

/// Velocity of the water at points.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct VelocityPlan {
    /// The points, m.
    pub places: Vec<Vec<f64>>,
    /// The solid that they go with, in whose frame they are.
    pub on: Option<String>,
}

impl ProbeDefinition for VelocityPlan {
    type Config = PointsConfig;
    const LABEL: &'static str = "velocity of the water";
    const EXAMPLE: &'static str = "velocity = [0.75, 0.03]";
    const MOUNTABLE: bool = true;

    fn mount(&mut self, on: &str) {
        self.on = Some(on.into());
    }

    fn verify(config: &PointsConfig, key: &str, scene: &dyn ProbeScope) -> Result<()> {
        config.verify(key, scene)
    }

    fn from_config(config: &PointsConfig) -> Self {
        Self { places: config.places(), on: None }
    }

    fn location(&self) -> Option<ProbeLocation<'_>> {
        Some(ProbeLocation::Points(&self.places, self.on.as_deref()))
    }

    fn build<const D: usize>(&self, system: &System<D>) -> Result<Box<dyn Probe<D>>> {
        ProbeRow::at_places(&self.places, |at| Ok(Box::new(VelocityProbe::mounted(system, at, self.on.as_deref())?)))
    }
}

/// Measures the velocity (m/s) of the water at a point; NaN while the point is dry. At a point of a solid, the velocity is
/// relative to this point and along the solid's axes.
pub struct VelocityProbe<const D: usize> {
    at: MountedPoint<D>,
}

impl<const D: usize> VelocityProbe<D> {
    /// Creates the probe at the point `at` (m; `D` coordinates).
    ///
    /// # Errors
    /// `Usage` if the number of coordinates differs from `D` or a coordinate is not finite.
    pub fn new(at: &[f64]) -> Result<Self> {
        Ok(Self { at: MountedPoint::in_world(at, D)? })
    }

    /// Creates the probe at `at` (m; `D` coordinates) in the frame of the solid called `solid`. The point moves with the solid.
    ///
    /// # Errors
    /// The errors of [`VelocityProbe::new`]; `Scene` if there is no such solid.
    pub fn on_solid(system: &System<D>, solid: &str, at: &[f64]) -> Result<Self> {
        Self::mounted(system, at, Some(solid))
    }

    fn mounted(system: &System<D>, at: &[f64], on: Option<&str>) -> Result<Self> {
        Ok(Self { at: MountedPoint::in_world(at, D)?.on(system, on)? })
    }
}

impl<const D: usize> Probe<D> for VelocityProbe<D> {
    fn water_ranges(&self, system: &System<D>) -> Option<Vec<Bounds<D>>> {
        Some(vec![system.reading_range(&self.at.position(system))])
    }

    fn columns(&self) -> Vec<String> {
        axes::<D>().iter().map(|a| format!("v{a}_mps")).collect()
    }

    fn sample(&self, sim: &Simulation<D>) -> Vec<f64> {
        let system = sim.system();
        if self.at.is_removed(system) {
            return empty_row(self);
        }
        let seen = |b: usize, r: &Vector<D>| -> [f64; D] { system.velocity_seen_at(b, r).into() };
        let mean = interpolate(system, &self.at.position(system), seen);
        if !self.at.is_mounted() {
            return mean.unwrap_or([f64::NAN; D]).to_vec();
        }
        let (velocity, axes) = self.at.velocity_and_axes(system);
        let relative = axes.transpose() * (Vector::from(mean.unwrap_or([f64::NAN; D])) - velocity);
        relative.iter().copied().collect()
    }
}
