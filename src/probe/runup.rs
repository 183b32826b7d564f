//! Run-up on a solid: the highest water that lies on its face.

use serde::{Deserialize, Serialize};

use super::{Probe, ProbeDefinition, ProbeScope, empty_row, find_solid};
use crate::{error::Result, math::Vector, simulation::Simulation, system::System};

/// Plan of a probe of the highest waterline on a solid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct RunupPlan {
    /// The solid's name.
    pub solid: String,
}

impl ProbeDefinition for RunupPlan {
    type Config = String;
    const LABEL: &'static str = "run-up";
    const EXAMPLE: &'static str = "runup = \"slope\"";

    fn verify(config: &String, key: &str, scene: &dyn ProbeScope) -> Result<()> {
        scene.require_solid(key, config)
    }

    fn from_config(config: &String) -> Self {
        Self { solid: config.clone() }
    }

    fn default_name(config: &String) -> Option<String> {
        Some(format!("{config}_runup"))
    }

    fn build<const D: usize>(&self, system: &System<D>) -> Result<Box<dyn Probe<D>>> {
        Ok(Box::new(RunupProbe::new(system, &self.solid)?))
    }
}

/// Largest distance of water on a face, over dp. Rows of particles are 0.5 dp and 1.5 dp from a face.
const ON_FACE: f64 = 1.0;

/// Least share (–) of the kernel's weight that water fills if it is more than a drop.
const MIN_FILLED: f64 = 0.25;

/// Measures the highest level (m) of the waterline on a solid, and its height above the initial waterline. Both are NaN
/// while the solid is dry.
pub struct RunupProbe<const D: usize> {
    solid: usize,
    start: f64,
}

impl<const D: usize> RunupProbe<D> {
    /// Creates the probe of the run-up on the solid called `solid`. The height counts from the present waterline.
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
        if sim.system().solids()[self.solid].is_removed() {
            return empty_row(self);
        }
        let tip = highest_waterline(sim.system(), self.solid);
        tip.iter().copied().chain([tip[D - 1] - self.start]).collect()
    }
}

/// Returns the nearest point (m) on solid number `solid` to the highest water that lies on its face.
fn highest_waterline<const D: usize>(system: &System<D>, solid: usize) -> Vector<D> {
    let (shape, pose, dp) = (&system.solids()[solid].spec.shape, &system.home_pose(solid), system.model().dp);
    let mut highest = Vector::from_element(f64::NAN);
    for r in system.fluid().r {
        if r[D - 1] <= highest[D - 1] {
            continue;
        }
        let local = pose.local(r);
        let distance = shape.signed_distance(&local);
        if distance < ON_FACE * dp && !is_isolated_drop(system, r) {
            highest = *r;
        }
    }
    if highest[D - 1].is_nan() {
        return highest;
    }
    let local = pose.local(&highest);
    pose.point(&(local - shape.outward_normal(&local, 0.05 * dp) * shape.signed_distance(&local)))
}

/// Returns whether the water at `x` (m) is an isolated drop.
fn is_isolated_drop<const D: usize>(system: &System<D>, x: &Vector<D>) -> bool {
    let (mass, rho) = (system.particle_mass(), system.fluid().rho);
    let mut filled = 0.0;
    system.visit_fluid_near(x, &mut |b, _, w| filled += mass / rho[b] * w);
    filled < MIN_FILLED
}
