//! The water's pressure at a point: P(x) = Σ V_b P_b W / Σ V_b W.

use super::{Probe, interpolate, point};
use crate::{error::Result, simulation::Simulation, space::Vector};

/// Watches the pressure (Pa, above the air's) at a fixed point; NaN while the point is dry.
///
/// At a wall the mean reaches into the water only, so it belongs to a place about half a smoothing length
/// off the wall; put the point there.
pub struct Pressure<const D: usize> {
    at: Vector<D>,
}

impl<const D: usize> Pressure<D> {
    /// The probe at the point `at` (m; `D` coordinates).
    ///
    /// # Errors
    /// `Usage` if the count of coordinates is another or one is not finite.
    pub fn new(at: &[f64]) -> Result<Self> {
        Ok(Self { at: point(at, D)? })
    }
}

impl<const D: usize> Probe<D> for Pressure<D> {
    fn columns(&self) -> Vec<String> {
        vec!["p_Pa".into()]
    }

    fn look(&self, sim: &Simulation<D>) -> Vec<f64> {
        let system = sim.system();
        let rho = &system.fluid().rho;
        let mean = interpolate(system, &self.at, |b| [system.pressure(rho[b])]);
        mean.unwrap_or([f64::NAN]).to_vec()
    }
}
