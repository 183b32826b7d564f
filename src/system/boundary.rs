//! Boundary particles: their arrays, and the density and velocity with which they act on the water.
//!
//! Every array of boundary particles is declared, extended, cut, saved and restored here and nowhere else.

use std::{borrow::Cow, ops::Range};

use rayon::prelude::*;

#[cfg(feature = "gpu")]
use super::device_state::BoundaryOnDevice;
use super::{
    System,
    boundary_extension::ExtensionParticle,
    film::{self, Films},
    known_water, own_water,
    periodic::Images,
    symmetry::{AxisSet, Division, MirroredParticle, reflected},
    thin_layers::{self, ThinLayers, WaterAround},
};
use crate::{
    error::{Error, Result},
    math::{Bounds, Pose, Vector},
    model::{Model, Walls},
    particles::{PARTICLES_PER_TASK, Particles, optional_bytes, zeros},
    solid::{Kinematics, Role, Solid, SolidDivision, SolidSpec, boundary_motion},
    sph::boundary::{
        DynamicBoundary, Slip, SupportCoverage, WallExtrapolation, WallTarget, no_slip_velocity, promptness,
    },
};

/// The boundary particles of all solids, one solid after the other.
pub(crate) struct Boundary<const D: usize> {
    pub(crate) particles: Particles<D>,
    /// Positions in the frame of each solid, m; none of a fixed solid, whose particles stay where they are.
    pub(super) local_positions: Vec<Vec<Vector<D>>>,
    /// Index and wet share of the boundary particles near water, in ascending order. The wet share is the share of the kernel
    /// support that water fills, Σ V_f W, –. `None` unless a body needs it; on a device only for the particles that a body needs.
    pub(crate) wetness: Option<Vec<(u32, f64)>>,
    /// Depths below the face, m; `None` unless the density relaxes to the water's pressure or water sticks to the face.
    pub(super) depths: Option<Vec<f64>>,
    /// Outward normals in the frames of their solids; `None` unless water sticks to the face.
    pub(super) normals: Option<Vec<Vector<D>>>,
    /// Target densities of the particles that this rank advances and that had water near them in the last pass, in ascending
    /// order; `None` unless walls relax.
    target_density: Option<Vec<TargetDensity>>,
    /// Velocities (m/s) with which they act on the water; `None` where those are their own.
    pub(super) extrapolated_velocity: Option<Vec<Vector<D>>>,
    /// Beside which of them water is not shifted; `None` unless water is shifted.
    pub(super) shifting_suppressed: Option<Vec<bool>>,
    pub(super) coverage: SupportCoverage,
    /// The box around the boundary particles of each solid, in its frame, m.
    pub(super) local_bounds: Vec<Bounds<D>>,
    /// The mirror images of the boundary particles of each solid, in their order in the arrays; empty without a symmetry plane.
    pub(super) mirrored: Vec<Vec<MirroredParticle>>,
    /// The films of water between solids.
    pub(super) films: Films<D>,
    /// The parts thinner than dp.
    pub(super) thin: ThinLayers<D>,
    /// Poses of the solids when the neighbour lists were built; `None` if they must be built anew.
    pub(super) poses_at_rebuild: Option<Vec<Pose<D>>>,
    /// What the host has of them, if a device has the particles.
    #[cfg(feature = "gpu")]
    pub(super) on_device: Option<BoundaryOnDevice<D>>,
}

/// The density to which a boundary particle relaxes.
#[derive(Clone, Copy)]
struct TargetDensity {
    /// Index of the boundary particle.
    particle: u32,
    target: WallTarget<f64>,
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
            mirrored: Vec::new(),
            films: Films::new(model),
            thin: ThinLayers::new(model),
            poses_at_rebuild: None,
            #[cfg(feature = "gpu")]
            on_device: None,
        }
    }

    /// Appends `copies` of the boundary particles of a solid with these `kinematics`, each with the `extension` last, and their
    /// mirror images across the symmetry planes. Returns their range. All copies start at the position of the solid.
    pub(super) fn append(
        &mut self,
        model: &Model,
        spec: &SolidSpec<D>,
        (kinematics, copies): (&Kinematics<D>, usize),
        extension: &[ExtensionParticle<D>],
        images: &Images<D>,
    ) -> Result<(Range<usize>, SolidDivision)> {
        let first = self.particles.len();
        let points = spec.shape.boundary_points(model.dp, model.boundary_layers());
        self.thin.faces.append(&spec.shape, &points, model.dp);
        let mut faces = points.into_iter().map(|point| point.r).collect::<Vec<_>>();
        let local: Vec<Vector<D>> = faces.iter().copied().chain(extension.iter().map(|particle| particle.r)).collect();
        faces.extend(extension.iter().map(|particle| particle.behind_face));
        let (local, faces, division, mirrored) = match images.planes.any() {
            false => (local, faces, None, Vec::new()),
            true => {
                let points: Vec<_> = local.iter().map(|r| kinematics.pose.point(r)).collect();
                let Division { cut, own, mirrored, whole } =
                    images.planes.divide(spec, &points, (model.dp, images.width));
                let local: Vec<_> = own.iter().map(|(_, r)| kinematics.pose.local(r)).collect();
                let faces = own.iter().map(|(i, _)| faces[*i as usize]).collect();
                (local, faces, Some(SolidDivision { cut, own: own.len(), whole }), mirrored)
            }
        };
        let division = division.unwrap_or(SolidDivision { cut: 0, own: local.len(), whole: local.len() });
        self.particles.reserve_exact(copies * local.len() + mirrored.len());
        for r in (0..copies).flat_map(|_| &local) {
            self.particles.push(kinematics.pose.point(r), model.rho0);
        }
        for image in &mirrored {
            let own = kinematics.pose.point(&local[image.own as usize]);
            self.particles.push(images.planes.mirrored(image.axes, &own), model.rho0);
        }
        if self.particles.len() == first {
            return Err(Error::scene(format!("solid {:?} is too small for a single boundary particle", spec.name))
                .help("make it larger or dp smaller"));
        }
        if let Some(depths) = &mut self.depths {
            let own: Vec<f64> = faces.par_iter().map(|r| -spec.shape.signed_distance(r)).collect();
            self.thin.append((&spec.shape, &kinematics.pose.rotation), &faces, &own, model.dp);
            (0..copies).for_each(|_| depths.extend_from_slice(&own));
            depths.extend(mirrored.iter().map(|image| own[image.own as usize]));
        }
        if let Some(normals) = &mut self.normals {
            let own: Vec<_> = faces.par_iter().map(|r| spec.shape.outward_normal(r, 0.05 * model.dp)).collect();
            (0..copies).for_each(|_| normals.extend_from_slice(&own));
            normals.extend(mirrored.iter().map(|image| own[image.own as usize]));
        }
        self.mirrored.push(mirrored);
        self.local_bounds.push(Bounds::around(&local));
        self.local_positions.push(if matches!(spec.role, Role::Fixed) { Vec::new() } else { local });
        Ok((first..self.particles.len(), division))
    }

    /// Removes the boundary particles `gone`, which are those of solid number `solid`.
    pub(super) fn remove_range(&mut self, gone: &Range<usize>, solid: usize) {
        let Self { particles: Particles { r, v, rho, .. }, local_positions, depths, normals, .. } = self;
        let Self { target_density, extrapolated_velocity, local_bounds, mirrored, thin, .. } = self;
        for vectors in [r, v].into_iter().chain(normals).chain(extrapolated_velocity) {
            remove_range(vectors, gone);
        }
        local_positions[solid] = Vec::new();
        mirrored[solid] = Vec::new();
        [rho].into_iter().chain(depths).for_each(|numbers| remove_range(numbers, gone));
        if let Some(targets) = target_density {
            targets.retain(|target| !gone.contains(&(target.particle as usize)));
            let later = targets.partition_point(|target| (target.particle as usize) < gone.start);
            targets[later..].iter_mut().for_each(|target| target.particle -= gone.len() as u32);
        }
        thin.remove(solid);
        local_bounds[solid] = Bounds { min: Vector::zeros(), max: Vector::zeros() };
    }

    /// Memory of the arrays, B.
    pub(super) fn memory_bytes(&self) -> usize {
        let local: usize = self.local_positions.iter().map(|local| size_of_val(&local[..])).sum();
        let local = local + self.mirrored.iter().map(|mirrored| size_of_val(&mirrored[..])).sum::<usize>();
        let vectors = optional_bytes(&self.normals) + optional_bytes(&self.extrapolated_velocity);
        let numbers = optional_bytes(&self.depths) + optional_bytes(&self.wetness);
        let marks = optional_bytes(&self.target_density) + optional_bytes(&self.shifting_suppressed);
        self.particles.memory_bytes() + local + vectors + numbers + marks
    }

    /// Middle (m) of the boundary particles of solid number `number` at `pose`.
    pub(super) fn middle(&self, number: usize, pose: &Pose<D>) -> Vector<D> {
        let Bounds { min, max } = &self.local_bounds[number];
        pose.point(&((min + max) * 0.5))
    }

    /// Ranges of the copies of the boundary particles of `solid`, number `number`, at `pose`, and the displacements (m) to them.
    pub(super) fn copies<'a>(
        &'a self,
        images: &'a Images<D>,
        (number, solid): (usize, &'a Solid<D>),
        pose: &'a Pose<D>,
    ) -> impl Iterator<Item = (Range<usize>, Vector<D>)> + 'a {
        (0..solid.copies()).map(move |copy| {
            let none = solid.copied_axes == 0;
            let axes = solid.copied_axes;
            let way = if none { Vector::zeros() } else { images.way_to_copy(&self.middle(number, pose), axes, copy) };
            (solid.boundary_of_copy(copy), way)
        })
    }

    /// The positions (m) of all boundary particles, with the solids at these `poses`.
    pub(super) fn positions_at(&self, poses: &[Pose<D>], solids: &[Solid<D>], images: &Images<D>) -> Vec<Vector<D>> {
        let mut r = self.particles.r.clone();
        for (numbered, pose) in solids.iter().enumerate().zip(poses) {
            for (range, way) in self.copies(images, numbered, pose) {
                let local = &self.local_positions[numbered.0];
                r[range].iter_mut().zip(local).for_each(|(r, local)| *r = pose.point(local) + way);
            }
            self.each_mirrored(numbered).for_each(|(i, own, axes)| r[i] = images.planes.mirrored(axes, &r[own]));
        }
        r
    }

    /// Places the boundary particles of `solid`, number `number`, where its kinematics say.
    pub(super) fn place(&mut self, number: usize, solid: &Solid<D>, images: &Images<D>) {
        let copies: Vec<_> = self.copies(images, (number, solid), &solid.kinematics.pose).collect();
        let (local, Particles { r, v, .. }) = (&self.local_positions[number], &mut self.particles);
        for (range, way) in copies.into_iter().filter(|_| !local.is_empty()) {
            let r = &mut r[range.clone()];
            boundary_motion::place_boundary_particles(&solid.kinematics, local, r, &mut v[range]);
            if way != Vector::<D>::zeros() {
                r.iter_mut().for_each(|r| *r += way);
            }
        }
        let Self { particles: Particles { r, v, .. }, mirrored, .. } = self;
        for (i, own, axes) in mirrored_of(&mirrored[number], solid) {
            (r[i], v[i]) = (images.planes.mirrored(axes, &r[own]), reflected(axes, v[own]));
        }
    }

    /// The mirror images of the boundary particles of a solid: their indices, those of their originals, and the axes of the planes.
    pub(super) fn each_mirrored<'a>(
        &'a self,
        (number, solid): (usize, &'a Solid<D>),
    ) -> impl Iterator<Item = (usize, usize, AxisSet)> + 'a {
        mirrored_of(&self.mirrored[number], solid)
    }

    /// Gives the mirror image of each boundary particle its density and, reflected, the velocity with which it acts.
    pub(super) fn update_mirrored(&mut self, solids: &[Solid<D>]) {
        let Self { particles: Particles { rho, .. }, extrapolated_velocity, mirrored, .. } = self;
        for (mirrored, solid) in mirrored.iter().zip(solids) {
            for (i, own, axes) in mirrored_of(mirrored, solid) {
                rho[i] = rho[own];
                if let Some(acting) = extrapolated_velocity {
                    acting[i] = reflected(axes, acting[own]);
                }
            }
        }
    }

    /// Gives the copies of each boundary particle the density and the acting velocity of the copy between the periodic sides.
    pub(super) fn update_copies(&mut self, solids: &[Solid<D>], images: &Images<D>) {
        let Self { particles: Particles { r, rho, .. }, extrapolated_velocity, .. } = self;
        for solid in solids.iter().filter(|solid| solid.copied_axes != 0) {
            for own in solid.boundary_of_copy(0) {
                let count = solid.boundary.len() / solid.copies();
                let copies = || (0..solid.copies()).map(|copy| own + copy * count);
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
}

impl<const D: usize> System<D> {
    /// Puts the boundary particles of solid `i` where its kinematics say.
    pub(crate) fn place_boundary(&mut self, i: usize) {
        #[cfg(feature = "gpu")]
        if self.boundary.on_device.is_some() {
            return;
        }
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
        self.pair_loop.inputs_changed();
    }

    /// Gives each boundary particle of `range` near water the density of still water at its depth, but not below ρ₀. It reads nothing
    /// of the last force pass, which a restored state does not hold.
    pub(super) fn init_hydrostatic(&mut self, range: Range<usize>) {
        known_water::know_adjacent_slabs(self);
        let (water, boundary, rho0) = (&self.fluid.particles, &self.boundary.particles, self.properties.rho0);
        let near = self.neighbours.boundary_near_fluid();
        let within = |i: &u32| range.contains(&(*i as usize));
        let near: Vec<u32> = match own_water::own_boundary(&self.neighbours) {
            None => near.iter().copied().filter(within).collect(),
            Some(places) => places.iter().map(|&k| near[k as usize]).filter(within).collect(),
        };
        let still: Vec<f64> = near
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
                rho0 * (1.0 + self.equation_of_state.compression(nearest.1.max(0.0)))
            })
            .collect();
        for (&i, still) in near.iter().zip(still) {
            self.boundary.particles.rho[i as usize] = DynamicBoundary.limited_density(still, rho0);
        }
        own_water::share_boundary_density(&self.neighbours, &mut self.boundary.particles.rho);
        if own_water::is_apart(&self.neighbours) {
            self.neighbours.forget_known();
        }
    }

    /// Sets the density (kg/m³) of each boundary particle near water that this rank advances to what `rho` makes of its place among
    /// these, its place among all near water, its index and its density, but not below what the wall law allows; then it relaxes to its
    /// target, by the share `relaxation` (–) where that takes time, or not at all. The others stay at ρ₀.
    pub(crate) fn set_boundary_density(
        &mut self,
        relaxation: Option<f64>,
        mut rho: impl FnMut([usize; 3], f64) -> f64,
    ) {
        let (rho0, Boundary { particles, target_density, .. }) = (self.properties.rho0, &mut self.boundary);
        let mut targets = target_density.iter().flatten().peekable();
        let near = self.neighbours.boundary_near_fluid();
        let own = own_water::own_boundary(&self.neighbours);
        for place in 0..own.map_or(near.len(), <[u32]>::len) {
            let k = own.map_or(place, |own| own[place] as usize);
            let i = near[k];
            while targets.next_if(|target| target.particle < i).is_some() {}
            let target = targets.next_if(|target| target.particle == i);
            let i = i as usize;
            let bare = rho([place, k, i], particles.rho[i]);
            particles.rho[i] = match target {
                None => DynamicBoundary.limited_density(bare, rho0),
                Some(TargetDensity { target, .. }) => {
                    let own = DynamicBoundary.limited_density(bare, target.density.min(rho0));
                    relaxation.map_or(own, |relaxation| own + target.change(own, relaxation))
                }
            };
        }
        own_water::share_boundary_density(&self.neighbours, &mut self.boundary.particles.rho);
    }

    /// Extrapolates the water to each boundary particle near it. If walls relax, the pressure there gives the target density; if
    /// water sticks to the face, the velocity there gives the velocity with which the particle acts.
    pub(super) fn update_wall_state(&mut self) {
        let (relaxes, sticks) = (self.model.walls == Walls::RelaxedAdami, self.model.slip == Slip::None);
        if !relaxes && !sticks && self.boundary.wetness.is_none() {
            return;
        }
        let Self { pair_loop, neighbours, fluid, boundary, gap_pressure, properties, equation_of_state, .. } = self;
        let mut input = Self::pair_input(neighbours, fluid, boundary, properties, equation_of_state);
        input.boundary_velocity = &boundary.particles.v;
        // Only these read the water beside boundary particles of other ranks.
        let read_by_all = boundary.wetness.is_some()
            || !gap_pressure.is_empty()
            || !boundary.films.is_empty()
            || !boundary.thin.is_empty();
        let made = own_water::own_boundary(neighbours).filter(|_| !read_by_all);
        let count = made.map_or(neighbours.boundary_near_fluid().len(), <[u32]>::len);
        let mut fits = vec![WallExtrapolation::filled_with(0.0); count];
        pair_loop.extrapolate_to_boundary(&input, sticks || relaxes, made, &mut fits);
        if let Some(wetness) = &mut self.boundary.wetness {
            let near = self.neighbours.boundary_near_fluid().iter();
            *wetness = near.zip(&fits).map(|(i, fit)| (*i, fit.weight_sum)).collect();
        }
        if relaxes {
            self.gap_pressure.update_directions(&fits);
            let place = |system: &Self, i: u32| system.neighbours.boundary_near_fluid().binary_search(&i).ok();
            film::update_water(self, |system, solid, i| {
                let fit = &fits[place(system, i)?];
                Some((system.extrapolated_pressure(fit, solid, i as usize), fit.direction().into()))
            });
            let around = |fit: &WallExtrapolation<f64, D>| WaterAround {
                weight: fit.weight_sum,
                // Offsets point from the water to the wall.
                offset: -Vector::from(fit.offset_sum) / fit.weight_sum.max(f64::MIN_POSITIVE),
            };
            thin_layers::update_water(self, |system, i| place(system, i).map(|place| around(&fits[place])));
        }
        let near = self.neighbours.boundary_near_fluid();
        let wet: Cow<'_, [u32]> = match own_water::own_boundary(&self.neighbours) {
            None => Cow::Borrowed(near),
            Some(own) => {
                if read_by_all {
                    fits = own.iter().map(|&k| fits[k as usize]).collect();
                }
                own.iter().map(|&k| near[k as usize]).collect()
            }
        };
        let mut targets = self.boundary.target_density.take();
        if relaxes {
            self.wall_targets(&wet, &fits, targets.get_or_insert_default());
        }
        let velocities = sticks.then(|| self.wall_velocities(&wet, &fits));
        if let Some(velocities) = velocities {
            let count = self.boundary.particles.len();
            let all = self.boundary.extrapolated_velocity.get_or_insert_with(|| zeros(count));
            all.resize(count, Vector::zeros());
            wet.iter().zip(velocities).for_each(|(&i, v)| all[i as usize] = v);
            own_water::share_boundary_velocity(&self.neighbours, all);
        }
        self.boundary.target_density = targets;
    }

    /// Makes `targets` of the extrapolated pressures of `fits`, one for each of the boundary particles `wet`.
    fn wall_targets(&self, wet: &[u32], fits: &[WallExtrapolation<f64, D>], targets: &mut Vec<TargetDensity>) {
        let (medium, Boundary { particles, depths, coverage, .. }) = (&self.properties, &self.boundary);
        let (depths, gravity) = (depths.as_deref().unwrap_or_default(), medium.gravity);
        let solids: Vec<_> = self.solids.iter().map(|s| (s.may_accelerate(), self.wall_promptness(s))).collect();
        let target = |(&particle, fit): (&u32, &WallExtrapolation<f64, D>)| {
            let i = particle as usize;
            let number = self.owner(i);
            let (may_accelerate, promptness) = solids[number];
            let pull = if may_accelerate { self.pull_at(number, i) } else { gravity };
            let pressure = fit.pressure(&pull.into(), &gravity.into(), depths[i]);
            let density = medium.rho0 * (1.0 + self.equation_of_state.compression(pressure));
            let (approach, cover) = (fit.approach(&particles.v[i].into()), coverage.cover(fit.weight_sum, depths[i]));
            let (own, constants) = (particles.rho[i], [medium.rho0, medium.c0]);
            TargetDensity { particle, target: WallTarget::new(density, own, approach, cover, promptness, constants) }
        };
        wet.par_iter().zip(fits).with_min_len(PARTICLES_PER_TASK).map(target).collect_into_vec(targets);
    }

    /// The pressure (P/ρ₀, m²/s²) of the water of `fit` at boundary particle `i` of solid number `owner`.
    pub(super) fn extrapolated_pressure(&self, fit: &WallExtrapolation<f64, D>, owner: usize, i: usize) -> f64 {
        let (gravity, depths) = (self.properties.gravity, self.boundary.depths.as_deref().unwrap_or_default());
        fit.pressure(&self.pull_at(owner, i).into(), &gravity.into(), depths[i])
    }

    /// Gravity less the acceleration of boundary particle `i` of solid number `owner`, m/s².
    fn pull_at(&self, owner: usize, i: usize) -> Vector<D> {
        self.properties.gravity - self.solids[owner].acceleration_at(&self.place_on_solid(owner, i))
    }

    /// Share (–) of a prompt change of density at the walls of `solid`.
    pub(crate) fn wall_promptness(&self, solid: &Solid<D>) -> f64 {
        let water_in_place = self.particle_mass() * solid.division.whole as f64;
        promptness(solid.body.as_ref().map_or(f64::INFINITY, |body| body.mass / water_in_place))
    }

    /// The velocities with which the boundary particles `wet` act by `fits`, one for each of them.
    fn wall_velocities(&self, wet: &[u32], fits: &[WallExtrapolation<f64, D>]) -> Vec<Vector<D>> {
        let Boundary { particles, depths, normals, .. } = &self.boundary;
        let (depths, normals) = (depths.as_deref().unwrap_or_default(), normals.as_deref().unwrap_or_default());
        let velocity = |(&i, fit): (&u32, &WallExtrapolation<f64, D>)| {
            let i = i as usize;
            let normal = self.solids[self.owner(i)].kinematics.pose.rotation * normals[i];
            no_slip_velocity(fit, particles.v[i], &normal, depths[i])
        };
        wet.par_iter().zip(fits).with_min_len(PARTICLES_PER_TASK).map(velocity).collect()
    }

    /// Number of the solid of boundary particle `i`.
    pub(super) fn owner(&self, i: usize) -> usize {
        self.solids.partition_point(|solid| solid.boundary.end <= i)
    }

    /// Position (m) of boundary particle `i` on its solid, number `number`, without the way to its copy.
    pub(crate) fn place_on_solid(&self, number: usize, i: usize) -> Vector<D> {
        let (solid, r) = (&self.solids[number], &self.boundary.particles.r[i]);
        if solid.copied_axes == 0 {
            return *r;
        }
        let copy = (i - solid.boundary.start) * solid.copies() / solid.boundary.len();
        let middle = self.boundary.middle(number, &solid.kinematics.pose);
        r - self.fluid.images.way_to_copy(&middle, solid.copied_axes, copy)
    }

    /// Pose of solid number `solid`. If it has several copies: pose of the copy with its middle between the periodic sides.
    pub(crate) fn home_pose(&self, solid: usize) -> Pose<D> {
        self.home_of(solid, &self.solids[solid].kinematics.pose)
    }

    /// The same with the solid at `pose`.
    pub(super) fn home_of(&self, solid: usize, pose: &Pose<D>) -> Pose<D> {
        let (mut pose, axes) = (*pose, self.solids[solid].copied_axes);
        if axes != 0 {
            let middle = self.boundary.middle(solid, &pose);
            let images = &self.fluid.images;
            pose.position += images.way_to_copy(&middle, axes, images.home_copy(&middle, axes));
        }
        pose
    }

    /// Indices of the boundary particles of solid number `solid`. If it has several copies: indices of the copy with its middle
    /// between the periodic sides.
    pub(crate) fn home_boundary(&self, solid: usize) -> Range<usize> {
        self.home_boundary_at(solid, &self.solids[solid].kinematics.pose)
    }

    /// The same with the solid at `pose`.
    pub(super) fn home_boundary_at(&self, solid: usize, pose: &Pose<D>) -> Range<usize> {
        let own = &self.solids[solid];
        let middle = self.boundary.middle(solid, pose);
        own.boundary_of_copy(self.fluid.images.home_copy(&middle, own.copied_axes))
    }
}

/// The mirror images of the boundary particles of `solid`: their indices, those of their originals, and the axes of the planes.
fn mirrored_of<const D: usize>(
    mirrored: &[MirroredParticle],
    solid: &Solid<D>,
) -> impl Iterator<Item = (usize, usize, AxisSet)> {
    let (start, first) = (solid.boundary.start, solid.boundary.start + solid.division.own);
    mirrored.iter().enumerate().map(move |(k, image)| (first + k, start + image.own as usize, image.axes))
}

/// Removes `gone` from an array that may be shorter.
fn remove_range<T>(array: &mut Vec<T>, gone: &Range<usize>) {
    let end = gone.end.min(array.len());
    array.drain(gone.start.min(end)..end);
}
