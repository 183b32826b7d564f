//! Water that has passed through an open boundary: mass, momentum and energy.

use serde::{Deserialize, Serialize};

use super::{Probe, ProbeDefinition, ProbeScope};
use crate::{
    error::{Error, ErrorKind, Result},
    simulation::Simulation,
    system::System,
};

/// Plan of a probe of the water that passes through an open boundary.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct OpenBoundaryPlan {
    /// Name of the open boundary.
    pub face: String,
}

impl ProbeDefinition for OpenBoundaryPlan {
    type Config = String;
    const LABEL: &'static str = "water through an open boundary";
    const EXAMPLE: &'static str = "face = \"inflow\"";

    fn verify(face: &String, key: &str, scene: &dyn ProbeScope) -> Result<()> {
        scene.require_constraint(key, "open boundary", face)
    }

    fn from_config(face: &String) -> Self {
        Self { face: face.clone() }
    }

    fn default_name(face: &String) -> Option<String> {
        Some(face.clone())
    }

    fn is_cumulative(&self, column: &str) -> bool {
        !column.starts_with("water_")
    }

    fn build<const D: usize>(&self, system: &System<D>) -> Result<Box<dyn Probe<D>>> {
        Ok(Box::new(OpenBoundaryProbe::new(system, &self.face)?))
    }
}

/// Measures what has passed through an open boundary since the start.
pub struct OpenBoundaryProbe {
    face: usize,
}

impl OpenBoundaryProbe {
    /// Creates the probe of the open boundary called `face`.
    ///
    /// # Errors
    /// `Usage` if there is no such open boundary.
    pub fn new<const D: usize>(system: &System<D>, face: &str) -> Result<Self> {
        let face = system.open_boundaries().iter().position(|own| own.name == face);
        match face {
            Some(face) => Ok(Self { face }),
            None => Err(Error::new(ErrorKind::Usage, "there is no open boundary of this name")),
        }
    }
}

impl<const D: usize> Probe<D> for OpenBoundaryProbe {
    fn columns(&self) -> Vec<String> {
        let (mass, momentum, energy) = if D == 2 { ("kg_per_m", "Ns_per_m", "J_per_m") } else { ("kg", "Ns", "J") };
        let momentum = ["x", "y", "z"][..D].iter().map(|axis| format!("momentum_{axis}_{momentum}"));
        let masses = ["entered", "left", "water"].iter().map(|name| format!("{name}_{mass}"));
        masses.chain(momentum).chain([format!("energy_{energy}")]).collect()
    }

    fn sample(&self, sim: &Simulation<D>) -> Vec<f64> {
        let system = sim.system();
        let mass = system.particle_mass() * system.water_multiplicity();
        let Some(exchange) = system.face_exchange().get(self.face) else { return vec![f64::NAN; D + 4] };
        let masses = [exchange.entered as f64, exchange.left as f64, system.fluid().len() as f64].map(|n| n * mass);
        masses.into_iter().chain(exchange.momentum.iter().copied()).chain([exchange.energy]).collect()
    }
}
