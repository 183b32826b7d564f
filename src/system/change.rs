//! Adding and removing solids: their boundary particles, and the water that they displace.

use rayon::prelude::*;

use super::{Reordering, System, boundary_extension::ExtensionParticle};
use crate::{
    error::Result,
    math::{Bivector, Vector},
    solid::{Kinematics, Load, Role, Solid, SolidDivision, SolidSpec},
};

impl<const D: usize> System<D> {
    /// Appends a solid that moves as `kinematics`, with its boundary particles, the `extension` last.
    pub(super) fn append_solid(
        &mut self,
        spec: SolidSpec<D>,
        kinematics: Kinematics<D>,
        extension: &[ExtensionParticle<D>],
    ) -> Result<()> {
        let copied_axes = self.fluid.images.copied_axes(&spec);
        let (skin, division) = self.boundary.append(
            &self.model,
            &spec,
            (&kinematics, 1 << copied_axes.count_ones()),
            extension,
            &self.fluid.images,
        )?;
        let (acceleration, whirl, load) = (Vector::zeros(), Bivector::zero(), Load::zero());
        let yielding = Default::default();
        self.solids.push(Solid {
            body: spec.initial_body(),
            spec,
            kinematics,
            acceleration,
            angular_acceleration: whirl,
            boundary: skin,
            copied_axes,
            division,
            load,
            absorption: yielding,
        });
        Ok(())
    }

    /// Adds a solid that moves as `kinematics`; an error leaves all unchanged. The neighbour lists must be rebuilt then.
    pub(crate) fn add_body(&mut self, spec: SolidSpec<D>, kinematics: Kinematics<D>) -> Result<()> {
        self.append_solid(spec, kinematics, &[])?;
        self.update_shifting_suppression();
        self.place_boundary(self.solids.len() - 1);
        self.boundary.poses_at_rebuild = None;
        self.status.solids_added = true;
        Ok(())
    }

    /// Removes the water inside the last solid, whose boundary particles start with the pressure of the remaining water.
    /// Returns how particle arrays must change, the number of particles removed, and their energy (J).
    pub(crate) fn displace(&mut self) -> (Option<Reordering<D>>, usize, f64) {
        let (before, mut count, mut energy) = (self.particle_count(), 0, 0.0);
        if let Some(solid) = self.solids.last() {
            let (pose, water) = (solid.kinematics.pose, &self.fluid.particles);
            let inside = |x: &Vector<D>| solid.spec.shape.signed_distance(&pose.local(x)) < 0.0;
            let displaced: Vec<bool> = water.r[..before].par_iter().map(inside).collect();
            let gone = (0..before).filter(|&i| displaced[i]);
            count = gone.clone().count();
            energy = gone.map(|i| self.particle_energy(&water.r[i], &water.v[i], water.rho[i])).sum();
            self.fluid.displaced = Some(displaced);
        }
        let reordering = self.rebuild_neighbours();
        self.fluid.displaced = None;
        self.init_hydrostatic(self.solids.last().map_or(0..0, |solid| solid.boundary.clone()));
        self.check_water();
        (reordering, count, energy)
    }

    /// Sets the masses of the free solids with ballast to those of time `t` (s), after their kinematics were restored.
    pub(crate) fn set_masses_at(&mut self, t: f64) {
        for solid in &mut self.solids {
            if solid.body.is_some() && !solid.spec.ballast.is_empty() {
                solid.body = solid.spec.body_at(t);
            }
        }
    }

    /// Removes solid number `i`: it keeps its number, stays at rest at its position, and has no boundary particles.
    pub(crate) fn remove_body(&mut self, i: usize) {
        let gone = self.solids[i].boundary.clone();
        self.boundary.remove_range(&gone, i);
        self.neighbours.remove_boundary(gone.clone());
        let solid = &mut self.solids[i];
        (solid.spec.role, solid.body) = (Role::Fixed, None);
        (solid.kinematics.velocity, solid.kinematics.spin) = (Vector::zeros(), Bivector::zero());
        (solid.acceleration, solid.angular_acceleration) = (Vector::zeros(), Bivector::zero());
        solid.load = Load::zero();
        solid.boundary = gone.start..gone.start;
        solid.division = SolidDivision { cut: 0, own: 0, whole: 0 };
        for later in &mut self.solids[i + 1..] {
            later.boundary = later.boundary.start - gone.len()..later.boundary.end - gone.len();
        }
        self.update_shifting_suppression();
        self.boundary.poses_at_rebuild = None;
    }
}
