//! Force and pressure on a part of a solid's face: a panel of a wall, a pressure plate.
//!
//! A box selects the part at the start. The part then moves with the solid. The force is Σ m_k f_k over the boundary
//! particles behind the part. The pressures are values of pressure probes on the part, about dp apart.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Probe, ProbeDefinition, ProbeReads, ProbeScope, axes, empty_row, find_solid, pressure::pressure};
use crate::{
    error::{Error, Result},
    math::{Bounds, BoxConfig, Vector},
    simulation::Simulation,
    system::System,
};

/// A part of a solid's face.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct PatchConfig {
    /// Name of the solid.
    pub solid: String,
    /// The box in which the part lies at the start.
    #[serde(rename = "box")]
    pub corners: BoxConfig,
}

/// Plan of a probe of the force and pressure on a part of a solid's face.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct PatchPlan {
    /// The solid's name.
    pub solid: String,
    /// Lowest corner of the box in which the part lies at the start, m.
    pub min: Vec<f64>,
    /// Highest corner of this box, m.
    pub max: Vec<f64>,
}

impl ProbeDefinition for PatchPlan {
    type Config = PatchConfig;
    const LABEL: &'static str = "force and pressure on a part of a face";
    const EXAMPLE: &'static str = "patch = { solid = \"wall\", box = { min = [0.9, 0.1], max = [1.1, 0.2] } }";

    fn verify(config: &PatchConfig, key: &str, scene: &dyn ProbeScope) -> Result<()> {
        scene.require_solid(&format!("{key}.solid"), &config.solid)?;
        scene.require_box(&format!("{key}.box"), &config.corners)
    }

    fn from_config(PatchConfig { solid, corners }: &PatchConfig) -> Self {
        Self { solid: solid.clone(), min: corners.min.clone(), max: corners.max.clone() }
    }

    fn default_name(config: &PatchConfig) -> Option<String> {
        Some(format!("{}_patch", config.solid))
    }

    fn build<const D: usize>(&self, system: &System<D>) -> Result<Box<dyn Probe<D>>> {
        Ok(Box::new(PatchProbe::new(system, &self.solid, &self.min, &self.max)?))
    }
}

/// Measures the force (N; N/m in 2-D) of the water on a part of a solid's face, and the mean and the largest pressure there
/// (Pa, above that of the air).
pub struct PatchProbe<const D: usize> {
    solid: usize,
    /// For each boundary particle of the solid, whether it lies behind the part.
    behind: Vec<bool>,
    /// Places on the part, in the solid's frame, m.
    places: Vec<Vector<D>>,
}

impl<const D: usize> PatchProbe<D> {
    /// Creates the probe of the part of the face of the solid called `solid` that now lies between the corners `min`
    /// and `max` (m).
    ///
    /// # Errors
    /// `Usage` if the number of coordinates of the corners differs from `D`; `Scene` if there is no such solid, or if
    /// no part of its face lies in the box.
    pub fn new(system: &System<D>, solid: &str, min: &[f64], max: &[f64]) -> Result<Self> {
        let part = Bounds { min: super::point(min, D)?, max: super::point(max, D)? };
        let number = find_solid(system, solid)?;
        let (of, dp) = (&system.solids()[number], system.model().dp);
        let (shape, pose) = (&of.spec.shape, &of.kinematics.pose);
        // A place on an edge of the box belongs to it; no boundary particle lies deeper than the kernel reaches.
        let (inside, near) = (part.grown(1e-9), part.grown(system.model().support_radius() + dp));
        let (mut behind, mut places) = (Vec::new(), Vec::new());
        for r in of.boundary_of_whole().map(|i| system.place_on_solid(number, i)) {
            let local = pose.local(&r);
            let depth = -shape.signed_distance(&local);
            let foot = local + shape.outward_normal(&local, 0.05 * dp) * depth;
            let chosen = near.contains(&r) && inside.contains(&pose.point(&foot));
            behind.push(chosen);
            if chosen && depth < 0.75 * dp {
                places.push(foot);
            }
        }
        if places.is_empty() {
            let what = format!("no face of solid {solid:?} is between {min:?} and {max:?} m");
            return Err(Error::scene(what).help("a box that holds a part of the face, a dp of it or more"));
        }
        Ok(Self { solid: number, behind, places })
    }

    /// The places on the part now, m.
    fn places(&self, system: &System<D>) -> impl Iterator<Item = Vector<D>> {
        let pose = system.solids()[self.solid].kinematics.pose;
        self.places.iter().map(move |place| system.wrapped(&pose.point(place)))
    }
}

impl<const D: usize> Probe<D> for PatchProbe<D> {
    fn reads(&self) -> ProbeReads {
        ProbeReads::BoundaryForces
    }

    fn water_ranges(&self, system: &System<D>) -> Option<Vec<Bounds<D>>> {
        Some(self.places(system).map(|place| system.reading_range(&place)).collect())
    }

    fn columns(&self) -> Vec<String> {
        let wide = if D == 2 { "_per_m" } else { "" };
        let forces = axes::<D>().iter().map(|a| format!("f{a}_N{wide}"));
        forces.chain(["p_mean_Pa", "p_max_Pa"].map(String::from)).collect()
    }

    fn sample(&self, sim: &Simulation<D>) -> Vec<f64> {
        let system = sim.system();
        let solid = &system.solids()[self.solid];
        if solid.is_removed() {
            return empty_row(self);
        }
        let mut force = Vector::<D>::zeros();
        system.visit_boundary_forces(self.solid, &mut |i, f| {
            if self.behind[i - solid.boundary.start] {
                force += f;
            }
        });
        let (mut sum, mut most) = (0.0, f64::NEG_INFINITY);
        for place in self.places(system) {
            let p = pressure(system, &place);
            (sum, most) = (sum + p, most.max(p));
        }
        force.iter().copied().chain([sum / self.places.len() as f64, most]).collect()
    }
}
