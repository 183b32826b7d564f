//! Force and pressure on a part of a solid's face: a panel of a wall, a pressure plate.
//!
//! The part is that of the face which lies in a box at the start, and goes with the solid from then on. The force is that on
//! the boundary particles behind it, Σ m_k f_k; pressures are those of a pressure gauge at places on it, dp apart.

use super::{Probe, axes, find_solid, pressure::pressure};
use crate::{
    error::{Error, Result},
    math::{Bounds, Vector},
    simulation::Simulation,
    system::System,
};

/// Watches the force (N; N/m in 2-D) of the water on a part of a solid's face, and the mean and the largest pressure
/// there (Pa, above the air's).
pub struct PatchProbe<const D: usize> {
    solid: usize,
    /// Which of the solid's boundary particles lie behind it.
    behind: Vec<bool>,
    /// Places on it, in the solid's frame, m.
    places: Vec<Vector<D>>,
}

impl<const D: usize> PatchProbe<D> {
    /// The part of the face of the solid called `solid` that lies between the corners `min` and `max` (m) now.
    ///
    /// # Errors
    /// `Usage` if the corners have another number of coordinates; `Scene` if there is no such solid, or none of its face
    /// there.
    pub fn new(system: &System<D>, solid: &str, min: &[f64], max: &[f64]) -> Result<Self> {
        let part = Bounds { min: super::point(min, D)?, max: super::point(max, D)? };
        let number = find_solid(system, solid)?;
        let (of, dp) = (&system.solids()[number], system.model().dp);
        let (shape, pose) = (&of.spec.shape, &of.kinematics.pose);
        // A place on an edge of the box belongs to it; no boundary particle lies deeper than the kernel reaches.
        let (inside, near) = (part.grown(1e-9), part.grown(system.model().support_radius() + dp));
        let (mut behind, mut places) = (Vec::new(), Vec::new());
        for r in &system.boundary().r[of.boundary.clone()] {
            let local = pose.local(r);
            let depth = -shape.signed_distance(&local);
            let foot = local + shape.outward_normal(&local, 0.05 * dp) * depth;
            let chosen = near.contains(r) && inside.contains(&pose.point(&foot));
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
}

impl<const D: usize> Probe<D> for PatchProbe<D> {
    fn columns(&self) -> Vec<String> {
        let wide = if D == 2 { "_per_m" } else { "" };
        let forces = axes::<D>().iter().map(|a| format!("f{a}_N{wide}"));
        forces.chain(["p_mean_Pa", "p_max_Pa"].map(String::from)).collect()
    }

    fn sample(&self, sim: &Simulation<D>) -> Vec<f64> {
        let system = sim.system();
        let solid = &system.solids()[self.solid];
        let mut force = Vector::<D>::zeros();
        system.visit_boundary_forces(self.solid, &mut |i, f| {
            if self.behind[i - solid.boundary.start] {
                force += f;
            }
        });
        let (mut sum, mut most) = (0.0, f64::NEG_INFINITY);
        for place in &self.places {
            let p = pressure(system, &solid.kinematics.pose.point(place));
            (sum, most) = (sum + p, most.max(p));
        }
        force.iter().copied().chain([sum / self.places.len() as f64, most]).collect()
    }
}
