//! Pressure of the water at a point: P(x) = Σ V_b [P_b (ρ₀/ρ_b)² + ρ₀ g·(x − r_b)] W / Σ V_b W, with the pressure that acts in the
//! pair force ([`System::lattice_pressure`]). The term ρ₀ g·(x − r_b) is hydrostatic, so the point may lie on a wall.

use serde::{Deserialize, Serialize};

use super::{PointsConfig, Probe, ProbeDefinition, ProbeLocation, ProbeRow, ProbeScope, interpolate, point};
use crate::{error::Result, math::Vector, simulation::Simulation, system::System};

/// Pressure at points.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct PressurePlan {
    /// The points, m.
    pub places: Vec<Vec<f64>>,
}

impl ProbeDefinition for PressurePlan {
    type Config = PointsConfig;
    const LABEL: &'static str = "pressure";
    const EXAMPLE: &'static str = "pressure = [0.75, 0.03]";

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
        ProbeRow::at_places(&self.places, |at| Ok(Box::new(PressureProbe::new(at)?)))
    }
}

/// Measures the pressure (Pa, relative to the air) at a fixed point. The pressure is 0 while the point is dry.
pub struct PressureProbe<const D: usize> {
    at: Vector<D>,
}

impl<const D: usize> PressureProbe<D> {
    /// Creates the probe at the point `at` (m; `D` coordinates).
    ///
    /// # Errors
    /// `Usage` if the number of coordinates differs from `D` or a coordinate is not finite.
    pub fn new(at: &[f64]) -> Result<Self> {
        Ok(Self { at: point(at, D)? })
    }
}

impl<const D: usize> Probe<D> for PressureProbe<D> {
    fn columns(&self) -> Vec<String> {
        vec!["p_Pa".into()]
    }

    fn sample(&self, sim: &Simulation<D>) -> Vec<f64> {
        vec![pressure(sim.system(), &self.at)]
    }
}

/// Returns the pressure (Pa) at the point `at` (m), or 0 if the point is dry.
pub(super) fn pressure<const D: usize>(system: &System<D>, at: &Vector<D>) -> f64 {
    let (fluid, gravity) = (system.fluid(), system.gravity());
    let read = |b: usize, r: &Vector<D>| {
        let head = gravity.dot(&(at - r));
        [system.lattice_pressure(fluid.rho[b]) + system.properties().rho0 * head]
    };
    interpolate(system, at, read).unwrap_or([0.0])[0]
}
