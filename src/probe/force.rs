//! The water's force and torque on a solid, F = Σ m_k f_k and T = Σ (r_k − R₀) × m_k f_k.

use serde::{Deserialize, Serialize};

use super::{Probe, ProbeDefinition, ProbeReads, ProbeScope, axes, empty_row, find_solid};
use crate::{error::Result, simulation::Simulation, system::System};

/// Plan of a probe of the force and torque of the water on a solid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ForcePlan {
    /// The solid's name.
    pub solid: String,
}

impl ProbeDefinition for ForcePlan {
    type Config = String;
    const LABEL: &'static str = "force of the water";
    const EXAMPLE: &'static str = "force = \"box\"";

    fn verify(config: &String, key: &str, scene: &dyn ProbeScope) -> Result<()> {
        scene.require_solid(key, config)
    }

    fn from_config(config: &String) -> Self {
        Self { solid: config.clone() }
    }

    fn default_name(config: &String) -> Option<String> {
        Some(format!("{config}_force"))
    }

    fn build<const D: usize>(&self, system: &System<D>) -> Result<Box<dyn Probe<D>>> {
        Ok(Box::new(ForceProbe::new(system, &self.solid)?))
    }
}

/// Measures the force (N) of the water on a solid and the torque (N m) about its centre. Both include pressure and
/// viscosity, without weight and contacts. In 2-D both are per metre of width, as the names of the columns state.
pub struct ForceProbe {
    solid: usize,
}

impl ForceProbe {
    /// Creates the probe of the solid called `solid`, which is fixed, driven or free.
    ///
    /// # Errors
    /// `Scene` if there is no such solid.
    pub fn new<const D: usize>(system: &System<D>, solid: &str) -> Result<Self> {
        Ok(Self { solid: find_solid(system, solid)? })
    }
}

impl<const D: usize> Probe<D> for ForceProbe {
    fn reads(&self) -> ProbeReads {
        ProbeReads::Solids
    }

    fn columns(&self) -> Vec<String> {
        if D == 2 {
            return ["fx_N_per_m", "fy_N_per_m", "torque_Nm_per_m"].map(String::from).to_vec();
        }
        let forces = axes::<D>().iter().map(|a| format!("f{a}_N"));
        forces.chain(axes::<D>().iter().map(|a| format!("t{a}_Nm"))).collect()
    }

    fn sample(&self, sim: &Simulation<D>) -> Vec<f64> {
        let solid = &sim.system().solids()[self.solid];
        if solid.is_removed() {
            return empty_row::<D>(self);
        }
        let load = &solid.load;
        load.force.iter().copied().chain(load.torque.axial()).collect()
    }
}
