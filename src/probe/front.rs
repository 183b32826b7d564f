//! How far the water has come: max x_a + dp/2 over the water.

use super::Probe;
use crate::simulation::Simulation;

/// Watches the leading edge of the water (m) along x: the end of the particle that has come farthest, spray
/// too, so that it means something only until the water meets a wall.
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
