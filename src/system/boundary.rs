//! Boundary particles: their arrays, and the density and velocity with which they act on the water.
//!
//! Every array of boundary particles is declared, extended, cut, saved and restored here and nowhere else.

use std::ops::Range;

use rayon::prelude::*;

use super::{System, boundary_extension::ExtensionParticle, periodic::Images};
use crate::{
    error::{Error, Result},
    math::{Bounds, Pose, Vector},
    model::{Model, Walls},
    neighbours::NeighbourLists,
    particles::{PARTICLES_PER_TASK, Particles},
    solid::{Kinematics, Role, Solid, SolidSpec, boundary_motion},
    sph::boundary::{DynamicBoundary, Slip, SupportCoverage, WallExtrapolation, no_slip_velocity},
};

/// The boundary particles of all solids, one solid after the other.
pub(crate) struct Boundary<const D: usize> {
    pub(crate) particles: Particles<D>,
    /// Positions in the frames of their solids, m.
    local_positions: Vec<Vector<D>>,
    /// Share of the kernel's support that water fills, Σ V_f W, of each one near water, –; `None` unless a body needs it.
    pub(crate) wetness: Option<Vec<f64>>,
    /// Depths below the face, m; `None` unless the density relaxes to the water's pressure or water sticks to the face.
    depths: Option<Vec<f64>>,
    /// Outward normals in the frames of their solids; `None` unless water sticks to the face.
    normals: Option<Vec<Vector<D>>>,
    /// Target density (kg/m³) and the fraction applied when it lies above the current one; `None` unless walls relax.
    target_density: Option<Vec<(f64, f64)>>,
    /// Velocities (m/s) with which they act on the water; `None` where those are their own.
    pub(super) extrapolated_velocity: Option<Vec<Vector<D>>>,
    /// Beside which of them water is not shifted; `None` unless water is shifted.
    pub(super) shifting_suppressed: Option<Vec<bool>>,
    coverage: SupportCoverage,
    /// The box around the boundary particles of each solid, in its frame, m.
    pub(super) local_bounds: Vec<Bounds<D>>,
    /// Poses of the solids when the neighbour lists were built; `None` if they must be built anew.
    pub(super) poses_at_rebuild: Option<Vec<Pose<D>>>,
}

impl<const D: usize> Boundary<D> {
    /// No boundary particles yet.
    pub(super) fn new(model: &Model) -> Self {
        let volume = model.fluid_properties::<D>().particle_volume();
        let (sticks, relaxes) = (model.slip == Slip::None, model.walls == Walls::RelaxedAdami);
        Self {
            particles: Particles::default(),
            local_positions: Vec::new(),
            wetness: None,
            depths: (sticks || relaxes).then(Vec::new),
            normals: sticks.then(Vec::new),
            target_density: None,
            extrapolated_velocity: None,
            shifting_suppressed: None,
            coverage: SupportCoverage::new(
                |r2| model.kernel_value(r2, D) * volume,
                model.dp,
                model.support_radius(),
                D,
            ),
            local_bounds: Vec::new(),
            poses_at_rebuild: None,
        }
    }

    /// Appends `copies` of the boundary particles of a solid that moves as `kinematics`, the `extension` last in each;
    /// returns their range. All copies stand in the place of the solid.
    pub(super) fn append(
        &mut self,
        model: &Model,
        spec: &SolidSpec<D>,
        (kinematics, copies): (&Kinematics<D>, usize),
        extension: &[ExtensionParticle<D>],
    ) -> Result<Range<usize>> {
        let first = self.particles.len();
        let mut faces = spec
            .shape
            .boundary_points(model.dp, model.boundary_layers())
            .into_iter()
            .map(|point| point.r)
            .collect::<Vec<_>>();
        let places: Vec<Vector<D>> = faces.iter().copied().chain(extension.iter().map(|particle| particle.r)).collect();
        for r in (0..copies).flat_map(|_| &places) {
            self.particles.push(kinematics.pose.point(r), model.rho0);
            self.local_positions.push(*r);
        }
        faces.extend(extension.iter().map(|particle| particle.behind_face));
        if self.particles.len() == first {
            return Err(Error::scene(format!("solid {:?} is too small for a single boundary particle", spec.name))
                .help("make it larger or dp smaller"));
        }
        if let Some(depths) = &mut self.depths {
            let own: Vec<f64> = faces.par_iter().map(|r| -spec.shape.signed_distance(r)).collect();
            (0..copies).for_each(|_| depths.extend_from_slice(&own));
        }
        if let Some(normals) = &mut self.normals {
            let own: Vec<_> = faces.par_iter().map(|r| spec.shape.outward_normal(r, 0.05 * model.dp)).collect();
            (0..copies).for_each(|_| normals.extend_from_slice(&own));
        }
        self.local_bounds.push(Bounds::around(&self.local_positions[first..]));
        Ok(first..self.particles.len())
    }

    /// Removes the boundary particles `gone`, which are those of solid number `solid`.
    pub(super) fn remove_range(&mut self, gone: &Range<usize>, solid: usize) {
        let Self { particles: Particles { r, v, rho, id }, local_positions, depths, normals, .. } = self;
        let Self { target_density, extrapolated_velocity, local_bounds, .. } = self;
        for vectors in [r, v, local_positions].into_iter().chain(normals).chain(extrapolated_velocity) {
            remove_range(vectors, gone);
        }
        [rho].into_iter().chain(depths).for_each(|numbers| remove_range(numbers, gone));
        target_density.iter_mut().for_each(|targets| remove_range(targets, gone));
        id.truncate(self.particles.r.len());
        local_bounds[solid] = Bounds { min: Vector::zeros(), max: Vector::zeros() };
    }

    /// Middle (m) of the boundary particles of solid number `number` at `pose`.
    pub(super) fn middle(&self, number: usize, pose: &Pose<D>) -> Vector<D> {
        let Bounds { min, max } = &self.local_bounds[number];
        pose.point(&((min + max) * 0.5))
    }

    /// Ranges of the copies of the boundary particles of `solid`, number `number`, at `pose`, and the ways (m) to them.
    pub(super) fn copies<'a>(
        &'a self,
        images: &'a Images<D>,
        (number, solid): (usize, &'a Solid<D>),
        pose: &'a Pose<D>,
    ) -> impl Iterator<Item = (Range<usize>, Vector<D>)> + 'a {
        (0..solid.copies).map(move |copy| {
            let none = solid.copies == 1;
            let way = if none { Vector::zeros() } else { images.way_to_copy(&self.middle(number, pose), copy) };
            (solid.boundary_of_copy(copy), way)
        })
    }

    /// The positions `r` (m) of all boundary particles, with those of each solid as at its pose.
    pub(super) fn positions_at(
        &self,
        mut r: Vec<Vector<D>>,
        poses: &[Pose<D>],
        solids: &[Solid<D>],
        images: &Images<D>,
    ) -> Vec<Vector<D>> {
        for (numbered, pose) in solids.iter().enumerate().zip(poses) {
            for (range, way) in self.copies(images, numbered, pose) {
                for i in range {
                    r[i] = pose.point(&self.local_positions[i]) + way;
                }
            }
        }
        r
    }

    /// Places the boundary particles of `solid`, number `number`, where its kinematics say.
    pub(super) fn place(&mut self, number: usize, solid: &Solid<D>, images: &Images<D>) {
        let copies: Vec<_> = self.copies(images, (number, solid), &solid.kinematics.pose).collect();
        let Particles { r, v, .. } = &mut self.particles;
        for (range, way) in copies {
            let local = &self.local_positions[range.clone()];
            let r = &mut r[range.clone()];
            boundary_motion::place_boundary_particles(&solid.kinematics, local, r, &mut v[range]);
            if way != Vector::<D>::zeros() {
                r.iter_mut().for_each(|r| *r += way);
            }
        }
    }

    /// Gives the copies of each boundary particle the density and the velocity, with which it acts, of that between the
    /// sides.
    pub(super) fn update_copies(&mut self, solids: &[Solid<D>], images: &Images<D>) {
        let Self { particles: Particles { r, rho, .. }, extrapolated_velocity, .. } = self;
        for solid in solids.iter().filter(|solid| solid.copies > 1) {
            for own in solid.boundary_of_copy(0) {
                let count = solid.boundary.len() / solid.copies;
                let copies = || (0..solid.copies).map(|copy| own + copy * count);
                let Some(inside) = copies().find(|i| images.is_inside(&r[*i])) else { continue };
                let density = rho[inside];
                copies().for_each(|i| rho[i] = density);
                if let Some(acting) = extrapolated_velocity {
                    let velocity = acting[inside];
                    copies().for_each(|i| acting[i] = velocity);
                }
            }
        }
    }

    /// Sets the target densities of the boundary particles near water.
    fn set_targets(&mut self, neighbours: &NeighbourLists<D>, targets: Vec<(f64, f64)>, rho0: f64) {
        let count = self.particles.len();
        let all = self.target_density.get_or_insert_default();
        all.resize(count, (rho0, 0.0));
        for (&i, target) in neighbours.boundary_near_fluid().iter().zip(targets) {
            all[i as usize] = target;
        }
    }
}

impl<const D: usize> System<D> {
    /// Puts the boundary particles of solid `i` where its kinematics say.
    pub(crate) fn place_boundary(&mut self, i: usize) {
        self.boundary.place(i, &self.solids[i], &self.fluid.images);
    }

    /// Finds the boundary particles beside which water is not shifted.
    pub(super) fn update_shifting_suppression(&mut self) {
        if self.model.shift().is_none() {
            return;
        }
        let mut suppressed = vec![false; self.boundary.particles.len()];
        for solid in &self.solids {
            let fixed = matches!(solid.spec.role, Role::Fixed);
            suppressed[solid.boundary.clone()].fill(self.model.shifting.suppressed_beside(fixed));
        }
        self.boundary.shifting_suppressed = Some(suppressed);
    }

    /// Gives each boundary particle of `range` near water the density of still water at its depth.
    pub(super) fn init_hydrostatic(&mut self, range: Range<usize>) {
        let (water, boundary) = (&self.fluid.particles, &self.boundary.particles);
        let still: Vec<f64> = self
            .neighbours
            .boundary_near_fluid()
            .par_iter()
            .map(|&i| {
                let x = &boundary.r[i as usize];
                let mut nearest = (f64::INFINITY, 0.0);
                self.neighbours.visit_fluid_around(x, &mut |j| {
                    let d = (water.r[j] - x).norm_squared();
                    if d < nearest.0 {
                        let head = self.equation_of_state.pressure(water.rho[j] / self.properties.rho0 - 1.0);
                        nearest = (d, head + self.properties.gravity.dot(&(x - water.r[j])));
                    }
                });
                self.properties.rho0 * (1.0 + self.equation_of_state.compression(nearest.1.max(0.0)))
            })
            .collect();
        self.set_boundary_density(0.0, |k, i, rho| if range.contains(&i) { still[k] } else { rho });
    }

    /// Sets the density (kg/m³) of each boundary particle near water to what `rho` makes of its place among them, its
    /// index and its density, but not below what the wall law allows, and relaxes it by the fraction `relaxation` (–)
    /// towards its target. The others stay at ρ₀.
    pub(crate) fn set_boundary_density(&mut self, relaxation: f64, mut rho: impl FnMut(usize, usize, f64) -> f64) {
        let (rho0, Boundary { particles, target_density, .. }) = (self.properties.rho0, &mut self.boundary);
        for (k, &i) in self.neighbours.boundary_near_fluid().iter().enumerate() {
            let i = i as usize;
            let bare = rho(k, i, particles.rho[i]);
            particles.rho[i] = match target_density.as_ref().and_then(|targets| targets.get(i)) {
                None => DynamicBoundary.limited_density(bare, rho0),
                Some(&(target, fraction)) => {
                    let own = DynamicBoundary.limited_density(bare, target.min(rho0));
                    own + (target - own) * if target > own { relaxation * fraction } else { relaxation }
                }
            };
        }
    }

    /// Extrapolates the water to each boundary particle near it: the pressure there becomes its target density, if walls
    /// relax to that, and the velocity the one with which it acts, if water sticks to the face.
    pub(super) fn update_wall_state(&mut self) {
        let (relaxes, sticks) = (self.model.walls == Walls::RelaxedAdami, self.model.slip == Slip::None);
        if !relaxes && !sticks && self.boundary.wetness.is_none() {
            return;
        }
        let Self { pair_loop, neighbours, fluid, boundary, properties, equation_of_state, .. } = self;
        let mut input = Self::pair_input(neighbours, fluid, boundary, properties, equation_of_state);
        input.boundary_velocity = &boundary.particles.v;
        let mut fits = vec![WallExtrapolation::filled_with(0.0); neighbours.boundary_near_fluid().len()];
        pair_loop.extrapolate_to_boundary(&input, sticks, &mut fits);
        if let Some(wetness) = &mut self.boundary.wetness {
            *wetness = fits.iter().map(|fit| fit.weight_sum).collect();
        }
        if relaxes {
            self.update_wall_pressure(&fits);
        }
        if sticks {
            self.update_wall_velocity(&fits);
        }
    }

    /// Makes target densities of the extrapolated pressures of `fits`, one for each boundary particle near water.
    fn update_wall_pressure(&mut self, fits: &[WallExtrapolation<f64, D>]) {
        let (medium, Boundary { depths, coverage, .. }) = (&self.properties, &self.boundary);
        let depths = depths.as_deref().unwrap_or_default();
        let target = |(&i, fit): (&u32, &WallExtrapolation<f64, D>)| {
            let i = i as usize;
            let owner = self.owner(i);
            let place = self.place_on_solid(owner, i);
            let pull = medium.gravity - self.solids[owner].acceleration_at(&place);
            let pressure = fit.pressure(&pull, &medium.gravity, depths[i]);
            let density = medium.rho0 * (1.0 + self.equation_of_state.compression(pressure));
            (density, coverage.fraction(fit.weight_sum, depths[i]))
        };
        let wet = self.neighbours.boundary_near_fluid();
        let targets = wet.par_iter().zip(fits).with_min_len(PARTICLES_PER_TASK).map(target).collect();
        self.boundary.set_targets(&self.neighbours, targets, medium.rho0);
    }

    /// Makes the velocities with which boundary particles act of `fits`, one for each boundary particle near water.
    fn update_wall_velocity(&mut self, fits: &[WallExtrapolation<f64, D>]) {
        let Boundary { particles, depths, normals, .. } = &self.boundary;
        let (depths, normals) = (depths.as_deref().unwrap_or_default(), normals.as_deref().unwrap_or_default());
        let velocity = |(&i, fit): (&u32, &WallExtrapolation<f64, D>)| {
            let i = i as usize;
            let normal = self.solids[self.owner(i)].kinematics.pose.rotation * normals[i];
            no_slip_velocity(fit, particles.v[i], &normal, depths[i])
        };
        let (wet, count) = (self.neighbours.boundary_near_fluid(), particles.len());
        let velocities: Vec<Vector<D>> =
            wet.par_iter().zip(fits).with_min_len(PARTICLES_PER_TASK).map(velocity).collect();
        let all = self.boundary.extrapolated_velocity.get_or_insert_default();
        all.resize(count, Vector::zeros());
        for (&i, v) in wet.iter().zip(velocities) {
            all[i as usize] = v;
        }
    }

    /// Number of the solid of boundary particle `i`.
    fn owner(&self, i: usize) -> usize {
        self.solids.partition_point(|solid| solid.boundary.end <= i)
    }

    /// Position (m) of boundary particle `i` on its solid, number `number`, without the way to its copy.
    pub(crate) fn place_on_solid(&self, number: usize, i: usize) -> Vector<D> {
        let (solid, r) = (&self.solids[number], &self.boundary.particles.r[i]);
        if solid.copies == 1 {
            return *r;
        }
        let copy = (i - solid.boundary.start) * solid.copies / solid.boundary.len();
        r - self.fluid.images.way_to_copy(&self.boundary.middle(number, &solid.kinematics.pose), copy)
    }

    /// Pose of solid number `solid`; that of its copy with its middle between the periodic sides, if it has several.
    pub(crate) fn home_pose(&self, solid: usize) -> Pose<D> {
        let own = &self.solids[solid];
        let mut pose = own.kinematics.pose;
        if own.copies > 1 {
            let middle = self.boundary.middle(solid, &pose);
            let images = &self.fluid.images;
            pose.position += images.way_to_copy(&middle, images.home_copy(&middle, own.copies));
        }
        pose
    }

    /// Indices of the boundary particles of solid number `solid`; of several copies those with their middle between the
    /// periodic sides.
    pub(crate) fn home_boundary(&self, solid: usize) -> Range<usize> {
        let own = &self.solids[solid];
        let middle = self.boundary.middle(solid, &own.kinematics.pose);
        own.boundary_of_copy(self.fluid.images.home_copy(&middle, own.copies))
    }
}

/// Removes `gone` from an array that may be shorter.
fn remove_range<T>(array: &mut Vec<T>, gone: &Range<usize>) {
    let end = gone.end.min(array.len());
    array.drain(gone.start.min(end)..end);
}
