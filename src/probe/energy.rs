//! Energies of the water and of the free bodies.
//!
//! Water: kinetic Σ ½ m v²; potential −Σ m g·r; compression Σ m e(ρ) with
//! e = ∫ P/ρ² dρ from ρ₀ to ρ.
//! Bodies: ½ M V² + ½ Ω·I Ω; potential −M g·R₀. Here g is gravity without the accelerations of a current and of a towed frame.
//! Potential energies start at zero. With symmetry planes all sums include the images.

use serde::{Deserialize, Serialize};

use super::{EnergyReading, Probe, ProbeDefinition, ProbeScope, require_true};
use crate::{error::Result, simulation::Simulation, solid::Solid, system::System};

/// Plan of a probe of the energies of water and bodies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EnergyPlan;

impl ProbeDefinition for EnergyPlan {
    type Config = bool;
    const LABEL: &'static str = "energy";
    const EXAMPLE: &'static str = "energy = true";

    fn verify(config: &bool, key: &str, scene: &dyn ProbeScope) -> Result<()> {
        require_true(*config, key, scene)
    }

    fn from_config(_: &bool) -> Self {
        Self
    }

    fn energy_reading(&self) -> Option<EnergyReading> {
        Some(EnergyReading::Total)
    }

    fn build<const D: usize>(&self, system: &System<D>) -> Result<Box<dyn Probe<D>>> {
        Ok(Box::new(EnergyProbe::new(system)))
    }
}

/// Measures the energies (J; J/m in 2-D) of water and free bodies and their sum.
///
/// The sum changes by the work of fixed and driven solids on the water, and by the dissipation of viscosity, diffusion, friction
/// and impacts.
pub struct EnergyProbe {
    initial_water_potential: f64,
    initial_bodies_potential: f64,
}

impl EnergyProbe {
    /// Creates the probe. Potential energies count from the present state of `system`.
    pub fn new<const D: usize>(system: &System<D>) -> Self {
        Self { initial_water_potential: water_potential(system), initial_bodies_potential: bodies_potential(system) }
    }

    /// Returns the kinetic, potential and compression energy of the water, and the kinetic and potential energy of the
    /// bodies.
    fn parts<const D: usize>(&self, system: &System<D>) -> [f64; 5] {
        let (mass, fluid) = (system.particle_mass() * system.water_multiplicity(), system.fluid());
        let compressed = mass * fluid.rho.iter().map(|&rho| system.compression_energy(rho)).sum::<f64>();
        let of_all = |(i, solid): (usize, &Solid<D>)| solid.kinetic_energy() * system.solid_multiplicity(i);
        let moving = system.solids().iter().enumerate().map(of_all).sum::<f64>();
        let (water, bodies) = (
            water_potential(system) - self.initial_water_potential,
            bodies_potential(system) - self.initial_bodies_potential,
        );
        [system.kinetic_energy(), water, compressed, moving, bodies]
    }

    /// Returns the sum of all energies.
    pub(super) fn total<const D: usize>(&self, system: &System<D>) -> f64 {
        self.parts(system).iter().sum()
    }
}

impl<const D: usize> Probe<D> for EnergyProbe {
    fn read_start(&mut self, system: &System<D>) {
        *self = Self::new(system);
    }

    fn columns(&self) -> Vec<String> {
        let unit = if D == 2 { "J_per_m" } else { "J" };
        ["water_kinetic", "water_potential", "water_compression", "bodies_kinetic", "bodies_potential", "total"]
            .iter()
            .map(|name| format!("{name}_{unit}"))
            .collect()
    }

    fn sample(&self, sim: &Simulation<D>) -> Vec<f64> {
        let mut row = self.parts(sim.system()).to_vec();
        row.push(row.iter().sum());
        row
    }
}

/// Returns −Σ m g·r of the water (J). A periodic axis does not contribute, because gravity does work along it.
fn water_potential<const D: usize>(system: &System<D>) -> f64 {
    let g = system.non_periodic_gravity();
    -system.particle_mass() * system.water_multiplicity() * system.fluid().r.iter().map(|r| g.dot(r)).sum::<f64>()
}

/// Returns −Σ M g·R₀ of the free bodies (J).
fn bodies_potential<const D: usize>(system: &System<D>) -> f64 {
    let of_all = |(i, solid): (usize, &Solid<D>)| {
        solid.potential_energy(&system.potential_gravity()) * system.solid_multiplicity(i)
    };
    system.solids().iter().enumerate().map(of_all).sum()
}
