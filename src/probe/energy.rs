//! Energies of the water and of the free bodies.
//!
//! Water: kinetic Σ ½ m v²; potential −Σ m g·r since the start; compression Σ m e(ρ) with
//! e = ∫ P/ρ² dρ from ρ₀ to ρ.
//! Bodies: ½ M V² + ½ Ω·I Ω; −M g·R₀ since the start.

use super::Probe;
use crate::{
    simulation::Simulation,
    solid::{Role, Solid},
    space::{Matrix, Vector},
    system::System,
};

/// Watches the energies (J; J/m in 2-D) of water and free bodies and their sum.
///
/// The sum changes by what fixed and driven solids do to the water and by what viscosity, diffusion,
/// friction and impacts dissipate.
pub struct Energy {
    water: f64,
    bodies: f64,
}

impl Energy {
    /// The probe; potential energies count from now.
    pub fn new<const D: usize>(system: &System<D>) -> Self {
        Self { water: water_potential(system), bodies: bodies_potential(system) }
    }

    /// Motion, height and compression of the water, motion and height of the bodies.
    fn parts<const D: usize>(&self, system: &System<D>) -> [f64; 5] {
        let (mass, fluid) = (system.particle_mass(), system.fluid());
        let compressed = mass * fluid.rho.iter().map(|&rho| system.compression(rho)).sum::<f64>();
        let moving = system.solids().iter().map(body_kinetic).sum::<f64>();
        let (water, bodies) = (water_potential(system) - self.water, bodies_potential(system) - self.bodies);
        [system.kinetic(), water, compressed, moving, bodies]
    }

    /// Their sum.
    pub(super) fn total<const D: usize>(&self, system: &System<D>) -> f64 {
        self.parts(system).iter().sum()
    }
}

impl<const D: usize> Probe<D> for Energy {
    fn columns(&self) -> Vec<String> {
        let unit = if D == 2 { "J_per_m" } else { "J" };
        ["water_kinetic", "water_potential", "water_compression", "bodies_kinetic", "bodies_potential", "total"]
            .iter()
            .map(|name| format!("{name}_{unit}"))
            .collect()
    }

    fn look(&self, sim: &Simulation<D>) -> Vec<f64> {
        let mut row = self.parts(sim.system()).to_vec();
        row.push(row.iter().sum());
        row
    }
}

/// −Σ m g·r of the water (J). Along a periodic axis there is no height, and gravity does work.
fn water_potential<const D: usize>(system: &System<D>) -> f64 {
    let g = system.height_gravity();
    -system.particle_mass() * system.fluid().r.iter().map(|r| g.dot(r)).sum::<f64>()
}

/// −Σ M g·R₀ of the free bodies (J).
fn bodies_potential<const D: usize>(system: &System<D>) -> f64 {
    let g = system.gravity();
    system
        .solids()
        .iter()
        .map(|s| if let Role::Free(b) = &s.spec.role { -b.mass * g.dot(&s.kinematics.centre) } else { 0.0 })
        .sum()
}

/// ½ M V² + ½ Ω·I Ω of a free body (J), zero for any other solid.
fn body_kinetic<const D: usize>(solid: &Solid<D>) -> f64 {
    let Role::Free(body) = &solid.spec.role else { return 0.0 };
    let now = &solid.kinematics;
    0.5 * body.mass * now.velocity.norm_squared() + 0.5 * turning(&body.inertia, &now.pose.rotation, &now.spin.axial())
}

/// Ω·I Ω with the inertia given in the body's frame, which is turned by `rotation`.
fn turning<const D: usize>(inertia: &Matrix<D>, rotation: &Matrix<D>, spin: &[f64]) -> f64 {
    if D == 2 {
        return inertia[(0, 0)] * spin[0] * spin[0];
    }
    let local = rotation.transpose() * Vector::<D>::from_iterator(spin.iter().copied());
    local.dot(&(inertia * local))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turning_energy_follows_the_body_frame() {
        let inertia = Matrix::<3>::from_diagonal(&Vector::<3>::new(1.0, 2.0, 3.0));
        let quarter = crate::space::Wedge::<3>::from_axial(&[0.0, 0.0, std::f64::consts::FRAC_PI_2]).exp();
        let energy = turning(&inertia, &quarter, &[1.0, 0.0, 0.0]);
        assert!((energy - 2.0).abs() < 1e-14, "the world's x is the body's −y; got {energy}");
    }
}
