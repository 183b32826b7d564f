//! Pressure of the water at a point: P(x) = Σ V_b [P_b (ρ₀/ρ_b)² + ρ₀ g·(x − r_b)] W / Σ V_b W. P_b is the pressure that acts in
//! the pair force ([`System::lattice_pressure`]). The term ρ₀ g·(x − r_b) is hydrostatic, so the point may lie on a wall.

use serde::{Deserialize, Serialize};

use super::{
    PointsConfig, Probe, ProbeDefinition, ProbeLocation, ProbeRow, ProbeScope, empty_row, interpolate,
    mounting::MountedPoint,
};
use crate::{
    error::Result,
    math::{Bounds, Vector},
    simulation::Simulation,
    system::System,
};

/// Pressure at points.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct PressurePlan {
    /// The points, m.
    pub places: Vec<Vec<f64>>,
    /// The solid that they go with, in whose frame they are.
    pub on: Option<String>,
}

impl ProbeDefinition for PressurePlan {
    type Config = PointsConfig;
    const LABEL: &'static str = "pressure";
    const EXAMPLE: &'static str = "pressure = [0.75, 0.03]";
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
        ProbeRow::at_places(&self.places, |at| Ok(Box::new(PressureProbe::mounted(system, at, self.on.as_deref())?)))
    }
}

/// Measures the pressure (Pa, relative to the air) at a point, which may move with a solid. The pressure at a dry point is 0.
pub struct PressureProbe<const D: usize> {
    at: MountedPoint<D>,
}

impl<const D: usize> PressureProbe<D> {
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
    /// The errors of [`PressureProbe::new`]; `Scene` if there is no such solid.
    pub fn on_solid(system: &System<D>, solid: &str, at: &[f64]) -> Result<Self> {
        Self::mounted(system, at, Some(solid))
    }

    fn mounted(system: &System<D>, at: &[f64], on: Option<&str>) -> Result<Self> {
        Ok(Self { at: MountedPoint::in_world(at, D)?.on(system, on)? })
    }
}

impl<const D: usize> Probe<D> for PressureProbe<D> {
    fn water_ranges(&self, system: &System<D>) -> Option<Vec<Bounds<D>>> {
        Some(vec![system.reading_range(&self.at.position(system))])
    }

    fn columns(&self) -> Vec<String> {
        vec!["p_Pa".into()]
    }

    fn sample(&self, sim: &Simulation<D>) -> Vec<f64> {
        if self.at.is_removed(sim.system()) {
            return empty_row(self);
        }
        vec![pressure(sim.system(), &self.at.position(sim.system()))]
    }
}

/// Returns the pressure (Pa) at the point `at` (m), or 0 if the point is dry.
pub(super) fn pressure<const D: usize>(system: &System<D>, at: &Vector<D>) -> f64 {
    let (fluid, gravity) = (system.water_and_buffers(), system.gravity());
    let read = |b: usize, r: &Vector<D>| {
        let head = gravity.dot(&(at - r));
        [system.lattice_pressure(fluid.rho[b]) + system.properties().rho0 * head]
    };
    interpolate(system, at, read).unwrap_or([0.0])[0]
}
