//! The water's pressure at a point: P(x) = Σ V_b [P_b (ρ₀/ρ_b)² + ρ₀ g·(x − r_b)] W / Σ V_b W: what acts
//! (see [`State::lattice_pressure`](crate::sph::equation_of_state::State::acting)). What stands between the point and
//! the water that it sees is added as still water's weight, so that the point may lie on a wall.

use super::{Probe, interpolate, point};
use crate::{error::Result, math::Vector, simulation::Simulation, system::System};

/// Watches the pressure (Pa, above the air's) at a fixed point; 0 while the point is dry.
pub struct PressureProbe<const D: usize> {
    at: Vector<D>,
}

impl<const D: usize> PressureProbe<D> {
    /// The probe at the point `at` (m; `D` coordinates).
    ///
    /// # Errors
    /// `Usage` if the count of coordinates is another or one is not finite.
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

/// The pressure (Pa) at the point `at` (m); 0 where it is dry.
pub(super) fn pressure<const D: usize>(system: &System<D>, at: &Vector<D>) -> f64 {
    let (fluid, gravity) = (system.fluid(), system.gravity());
    let read = |b: usize, r: &Vector<D>| {
        let head = gravity.dot(&(at - r));
        [system.lattice_pressure(fluid.rho[b]) + system.properties().rho0 * head]
    };
    interpolate(system, at, read).unwrap_or([0.0])[0]
}
