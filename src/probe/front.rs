//! Leading edge of the water: max x_a + dp/2 over the water.

use serde::{Deserialize, Serialize};

use super::{Probe, ProbeDefinition, ProbeScope, require_true};
use crate::{error::Result, simulation::Simulation, system::System};

/// Plan of a probe of the leading edge of the water along x.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrontPlan;

impl ProbeDefinition for FrontPlan {
    type Config = bool;
    const LABEL: &'static str = "leading edge of the water";
    const EXAMPLE: &'static str = "front = true";

    fn verify(config: &bool, key: &str, scene: &dyn ProbeScope) -> Result<()> {
        require_true(*config, key, scene)
    }

    fn from_config(_: &bool) -> Self {
        Self
    }

    fn build<const D: usize>(&self, _: &System<D>) -> Result<Box<dyn Probe<D>>> {
        Ok(Box::new(FrontProbe))
    }
}

/// Measures the leading edge of the water (m) along x: the far side of the foremost particle. Spray counts, so the column is
/// meaningful only until the water meets a wall.
pub struct FrontProbe;

impl<const D: usize> Probe<D> for FrontProbe {
    fn columns(&self) -> Vec<String> {
        vec!["front_m".into()]
    }

    fn sample(&self, sim: &Simulation<D>) -> Vec<f64> {
        let system = sim.system();
        let farthest = system.fluid().r.iter().map(|r| r[0]).fold(f64::NEG_INFINITY, f64::max);
        vec![farthest + 0.5 * system.model().dp]
    }
}
