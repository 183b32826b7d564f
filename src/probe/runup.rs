//! How far water has run up a solid: the highest water that lies on its face.

use super::{Probe, find_solid};
use crate::{error::Result, math::Vector, simulation::Simulation, system::System};

/// How near to the face water lies on it, over dp: rows of particles are half a dp from a face, and one and a half.
const ON: f64 = 1.0;

/// The least share of the kernel's weight that must be full of water for it to be more than a drop.
const MORE_THAN_A_DROP: f64 = 0.25;

/// Watches where the waterline on a solid is highest (m), and its height above that at the start; NaN while it is dry.
pub struct RunupProbe<const D: usize> {
    solid: usize,
    start: f64,
}

impl<const D: usize> RunupProbe<D> {
    /// The run-up on the solid called `solid`; the waterline now counts as 0.
    ///
    /// # Errors
    /// `Scene` if there is no such solid.
    pub fn new(system: &System<D>, solid: &str) -> Result<Self> {
        let solid = find_solid(system, solid)?;
        Ok(Self { solid, start: highest_waterline(system, solid)[D - 1] })
    }
}

impl<const D: usize> Probe<D> for RunupProbe<D> {
    fn columns(&self) -> Vec<String> {
        let places = super::axes::<D>().iter().map(|a| format!("{a}_m"));
        places.chain(["runup_m".into()]).collect()
    }

    fn sample(&self, sim: &Simulation<D>) -> Vec<f64> {
        let tip = highest_waterline(sim.system(), self.solid);
        tip.iter().copied().chain([tip[D - 1] - self.start]).collect()
    }
}

/// The foot (m) on solid `solid` of the highest water that lies on its face.
fn highest_waterline<const D: usize>(system: &System<D>, solid: usize) -> Vector<D> {
    let (solid, dp) = (&system.solids()[solid], system.model().dp);
    let (shape, pose) = (&solid.spec.shape, &solid.kinematics.pose);
    let mut highest = Vector::from_element(f64::NAN);
    for r in system.fluid().r {
        if r[D - 1] <= highest[D - 1] {
            continue;
        }
        let local = pose.local(r);
        let distance = shape.signed_distance(&local);
        if distance < ON * dp && !is_isolated_drop(system, r) {
            highest = *r;
        }
    }
    if highest[D - 1].is_nan() {
        return highest;
    }
    let local = pose.local(&highest);
    pose.point(&(local - shape.outward_normal(&local, 0.05 * dp) * shape.signed_distance(&local)))
}

/// Whether the water at `x` (m) is no more than a drop.
fn is_isolated_drop<const D: usize>(system: &System<D>, x: &Vector<D>) -> bool {
    let (mass, rho) = (system.particle_mass(), system.fluid().rho);
    let mut filled = 0.0;
    system.visit_fluid_near(x, &mut |b, _, w| filled += mass / rho[b] * w);
    filled < MORE_THAN_A_DROP
}
