//! The water's velocity at a point: v(x) = Σ V_b v_b W / Σ V_b W.

use super::{Probe, axes, interpolate, point};
use crate::{error::Result, math::Vector, simulation::Simulation};

/// Watches the water's velocity (m/s) at a fixed point; NaN while the point is dry.
pub struct VelocityProbe<const D: usize> {
    at: Vector<D>,
}

impl<const D: usize> VelocityProbe<D> {
    /// The probe at the point `at` (m; `D` coordinates).
    ///
    /// # Errors
    /// `Usage` if the count of coordinates is another or one is not finite.
    pub fn new(at: &[f64]) -> Result<Self> {
        Ok(Self { at: point(at, D)? })
    }
}

impl<const D: usize> Probe<D> for VelocityProbe<D> {
    fn columns(&self) -> Vec<String> {
        axes::<D>().iter().map(|a| format!("v{a}_mps")).collect()
    }

    fn sample(&self, sim: &Simulation<D>) -> Vec<f64> {
        let v = sim.system().fluid().v;
        let mean = interpolate(sim.system(), &self.at, |b, _| -> [f64; D] { v[b].into() });
        mean.unwrap_or([f64::NAN; D]).to_vec()
    }
}
