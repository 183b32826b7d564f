//! The water's force and torque on a solid, F = Σ m_k f_k and T = Σ (r_k − R₀) × m_k f_k.

use super::{Probe, axes, find_solid};
use crate::{error::Result, simulation::Simulation, system::System};

/// Watches the force (N) and the torque about the solid's centre (N m) that the water exerts: pressure and
/// viscosity, no weight, no contacts. In 2-D both are per metre of width, and the columns say so.
pub struct ForceProbe {
    solid: usize,
}

impl ForceProbe {
    /// The probe of the solid called `solid`: fixed, driven or free.
    ///
    /// # Errors
    /// `Scene` if there is no such solid.
    pub fn new<const D: usize>(system: &System<D>, solid: &str) -> Result<Self> {
        Ok(Self { solid: find_solid(system, solid)? })
    }
}

impl<const D: usize> Probe<D> for ForceProbe {
    fn columns(&self) -> Vec<String> {
        if D == 2 {
            return ["fx_N_per_m", "fy_N_per_m", "torque_Nm_per_m"].map(String::from).to_vec();
        }
        let forces = axes::<D>().iter().map(|a| format!("f{a}_N"));
        forces.chain(axes::<D>().iter().map(|a| format!("t{a}_Nm"))).collect()
    }

    fn sample(&self, sim: &Simulation<D>) -> Vec<f64> {
        let load = &sim.system().solids()[self.solid].load;
        load.force.iter().copied().chain(load.torque.axial()).collect()
    }
}
