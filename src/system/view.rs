//! What may be read of a system.

use std::{collections::BTreeMap, time::Duration};

use rayon::prelude::*;

use super::{
    Driving, FaceExchange, Fluid, OpenBoundary, Periodic, System, own_water, reflected,
    slip_rates::SlipRates,
    symmetry::{AxisSet, SymmetryPlanes, reflected_turn},
};
use crate::{
    interaction::PairSums,
    math::{Bivector, Bounds, Pose, Vector},
    model::{Model, TimeScheme},
    neighbours::{CHUNK, Division},
    particles::{ParticlesView, optional_bytes},
    solid::{Constraints, Load, LoadContext, Role, Solid},
    sph::{FluidProperties, boundary::WallExtrapolation},
};

#[cfg(feature = "gpu")]
use crate::math::Matrix;

impl<const D: usize> System<D> {
    /// The model.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The constants that the laws share.
    pub fn properties(&self) -> &FluidProperties<D> {
        &self.properties
    }

    /// The water.
    pub fn fluid(&self) -> ParticlesView<'_, D> {
        self.fluid.particles.first_n(self.particle_count())
    }

    /// The water, and after it that of the buffers of open boundaries.
    pub(crate) fn water_and_buffers(&self) -> ParticlesView<'_, D> {
        self.fluid.particles.first_n(self.own_count())
    }

    /// Whether water passes the ends of `axis`: through periodic sides or open boundaries.
    pub(crate) fn is_open(&self, axis: usize) -> bool {
        self.periodic()[axis].is_some() || self.open_boundaries().iter().any(|face| face.axis == axis)
    }

    /// How ranks share the water, if each has its own and none needs to have that of others.
    pub(crate) fn divided_water(&self) -> Option<&Division> {
        own_water::divided(&self.neighbours)
    }

    /// The boundary particles of all solids.
    pub fn boundary(&self) -> ParticlesView<'_, D> {
        self.boundary.particles.first_n(self.boundary.particles.len())
    }

    /// The solids.
    pub fn solids(&self) -> &[Solid<D>] {
        &self.solids
    }

    /// What ties the solids, as it was made.
    pub(crate) fn constraints(&self) -> &Constraints<D> {
        &self.constraints
    }

    /// Number of the solid of that name.
    pub fn find_solid(&self, name: &str) -> Option<usize> {
        self.solids.iter().position(|s| s.spec.name == name)
    }

    /// What drives water and bodies beside gravity.
    pub fn driving(&self) -> &Driving {
        &self.driving.driving
    }

    /// Acceleration (m/s²) by the force that holds the current; 0 without one.
    pub fn current_acceleration(&self) -> f64 {
        self.driving.current.acceleration
    }

    /// Discharge (m³/s; m²/s in 2-D) along the periodic axis number `axis`, a mean over the length of the period; `None` along another.
    pub fn discharge(&self, axis: usize) -> Option<f64> {
        self.periodic().get(axis)?.as_ref()?;
        let water = self.fluid().v;
        // Chunks are added in order.
        let parts: Vec<f64> = water.par_chunks(CHUNK).map(|v| v.iter().map(|v| v[axis]).sum()).collect();
        self.discharge_by(axis, parts.iter().sum())
    }

    /// The same if the velocities of the water along the axis add up to `sum` (m/s).
    pub(super) fn discharge_by(&self, axis: usize, sum: f64) -> Option<f64> {
        let [from, to] = (*self.periodic().get(axis)?)?;
        let volume = self.properties.particle_volume() * self.water_multiplicity();
        Some(sum * volume / (to - from))
    }

    /// The open boundaries.
    pub fn open_boundaries(&self) -> &[OpenBoundary<D>] {
        &self.fluid_domain.open_boundaries
    }

    /// Place (m), velocity (m/s) and density (kg/m³) of each particle in the buffer of open boundary number `face`.
    pub fn buffer_particles(&self, face: usize) -> impl Iterator<Item = (&Vector<D>, &Vector<D>, f64)> {
        let (water, particles) = (self.particle_count(), &self.fluid.particles);
        let own = self.fluid.buffer.tags.iter().enumerate().filter(move |(_, tag)| tag.face() == face);
        own.map(move |(i, _)| (&particles.r[water + i], &particles.v[water + i], particles.rho[water + i]))
    }

    /// What messages call particle number `i` of the water and the buffers.
    pub(crate) fn particle_name(&self, i: usize) -> String {
        let Some(id) = self.fluid.particles.id.get(i) else { return "the run".into() };
        let place = i.checked_sub(self.particle_count()).and_then(|place| self.fluid.buffer.tags.get(place));
        match place.and_then(|tag| self.open_boundaries().get(tag.face())) {
            None => format!("water particle {id}"),
            Some(face) => format!("particle {id} in the buffer of open boundary {:?}", face.name),
        }
    }

    /// What has passed through each open boundary since the start, in their order.
    pub fn face_exchange(&self) -> &[FaceExchange<D>] {
        &self.fluid.buffer.exchange
    }

    /// Where particles may be.
    pub(crate) fn domain(&self) -> &Bounds<D> {
        &self.fluid_domain.domain
    }

    /// Which sides are periodic.
    pub(crate) fn periodic(&self) -> &Periodic<D> {
        &self.fluid.images.periodic
    }

    /// Mass of every particle, ρ₀ dpᴰ (kg; kg/m in 2-D).
    pub fn particle_mass(&self) -> f64 {
        self.properties.rho0 * self.properties.particle_volume()
    }

    /// Pressure (Pa) at density `rho` (kg/m³).
    pub fn pressure(&self, rho: f64) -> f64 {
        self.properties.rho0 * self.equation_of_state.pressure(rho / self.properties.rho0 - 1.0)
    }

    /// Pressure (Pa) with which water of density `rho` (kg/m³) acts where its particles lie dp apart: a little less than
    /// [`System::pressure`].
    pub(crate) fn lattice_pressure(&self, rho: f64) -> f64 {
        self.properties.rho0 * self.equation_of_state.lattice_pressure(rho / self.properties.rho0 - 1.0)
    }

    /// Energy of compression (J/kg) at density `rho` (kg/m³), from ρ₀.
    pub fn compression_energy(&self, rho: f64) -> f64 {
        self.equation_of_state.compression_energy(rho / self.properties.rho0 - 1.0)
    }

    /// Energy (J; J/m in 2-D) of a water particle of density `rho` (kg/m³) that moves at `v` (m/s) at `r` (m), and of its images
    /// across symmetry planes: motion, height, compression.
    pub(crate) fn particle_energy(&self, r: &Vector<D>, v: &Vector<D>, rho: f64) -> f64 {
        let height = self.non_periodic_gravity().dot(r);
        let mass = self.particle_mass() * self.water_multiplicity();
        mass * (0.5 * v.norm_squared() - height + self.compression_energy(rho))
    }

    /// Acceleration (m/s²) of water particle `i` at the last force pass, gravity included; zero in a restored state until the next.
    pub fn fluid_acceleration(&self, i: usize) -> Vector<D> {
        if self.rates.current { self.fluid_rates().of(i).acceleration } else { Vector::zeros() }
    }

    /// Rate of density (kg/m³/s) of water particle `i` at the last force pass; zero in a restored state until the next.
    pub fn fluid_density_rate(&self, i: usize) -> f64 {
        if self.rates.current { self.fluid_rates().of(i).compression_rate * self.properties.rho0 } else { 0.0 }
    }

    /// Number of boundary particles that have water near them; the others cost nothing.
    pub(crate) fn boundary_near_fluid_count(&self) -> usize {
        self.neighbours.boundary_near_fluid().len()
    }

    /// Time spent so far on lists and sorting, and on pairs.
    pub(crate) fn time_spent(&self) -> (Duration, Duration) {
        (self.status.neighbour_time, self.pair_loop.time_spent())
    }

    /// Force passes so far.
    pub(crate) fn force_passes(&self) -> u64 {
        self.status.passes
    }

    /// Acceleration of gravity, m/s².
    pub fn gravity(&self) -> Vector<D> {
        self.properties.gravity
    }

    /// What is around the solids that feel `loads` (N, N m) of the water.
    pub(crate) fn load_context(&self, loads: &[Load<D>]) -> LoadContext<D> {
        let with_weight = |(load, solid): (&Load<D>, &Solid<D>)| match &solid.body {
            Some(body) => Load { force: load.force + self.gravity() * body.mass, ..*load },
            None => *load,
        };
        let loads = loads.iter().zip(&self.solids).map(with_weight).collect();
        let wet = self.solids.iter().map(|solid| solid.load != Load::zero()).collect();
        LoadContext { loads, wet, sound_crossing_time: self.properties.h / self.properties.c0 }
    }

    /// Energy of the water's motion, Σ ½ m v², J (J/m in 2-D), on both sides of symmetry planes.
    pub fn kinetic_energy(&self) -> f64 {
        let half = 0.5 * self.particle_mass() * self.fluid().v.iter().map(|v| v.norm_squared()).sum::<f64>();
        half * self.water_multiplicity()
    }

    /// Acceleration of gravity (m/s²) along the axes that have a height: those that are not periodic.
    pub(crate) fn non_periodic_gravity(&self) -> Vector<D> {
        self.non_periodic(&self.potential_gravity())
    }

    /// Gravity (m/s²) that has a potential: without the accelerations of a current and of a towed frame, which depend on time.
    pub(crate) fn potential_gravity(&self) -> Vector<D> {
        self.properties.gravity - self.driving.acceleration
    }

    /// The components of a vector along the axes that are not periodic.
    pub(crate) fn non_periodic(&self, x: &Vector<D>) -> Vector<D> {
        Vector::from_fn(|i, _| if self.fluid.images.periodic[i].is_some() { 0.0 } else { x[i] })
    }

    /// Power on the water of gravity along periodic axes and of a current and a towed frame, Σ m g·v, W (W/m in 2-D).
    pub(crate) fn periodic_gravity_power(&self) -> f64 {
        let along = self.properties.gravity - self.non_periodic_gravity();
        if along.norm_squared() == 0.0 {
            return 0.0;
        }
        self.particle_mass() * self.water_multiplicity() * self.fluid().v.iter().map(|v| along.dot(v)).sum::<f64>()
    }

    /// The symmetry planes.
    pub(crate) fn symmetry_planes(&self) -> &SymmetryPlanes<D> {
        &self.fluid.images.planes
    }

    /// Number of images of the computed water, itself counted: its energy times this number is that of all water.
    pub(crate) fn water_multiplicity(&self) -> f64 {
        self.symmetry_planes().multiplicity(0)
    }

    /// Number of images of solid number `i`, itself counted. A plane that cuts the solid gives it no other image.
    pub(crate) fn solid_multiplicity(&self, i: usize) -> f64 {
        self.symmetry_planes().multiplicity(self.solids[i].division.cut)
    }

    /// The share (–) of the boundary particle at `r` (m) of `solid` that the computed side has.
    pub(crate) fn computed_share(&self, solid: &Solid<D>, r: &Vector<D>) -> f64 {
        self.symmetry_planes().share(solid.division.cut, r, self.model.dp)
    }

    /// Whether the moving solid number `i` at `pose`, which no plane cuts, reaches a plane, where it meets its image.
    pub(crate) fn meets_its_image(&self, i: usize, pose: &Pose<D>) -> bool {
        let (planes, cut) = (self.symmetry_planes(), self.solids[i].division.cut);
        let mut apart = planes.each().filter(|(axis, _)| cut >> axis & 1 == 0).peekable();
        if apart.peek().is_none() || matches!(self.solids[i].spec.role, Role::Fixed) {
            return false;
        }
        // The rows of the solid and of its image are a row apart then.
        let near = 0.5 * self.model.dp;
        let corners: Vec<Vector<D>> = self.boundary.local_bounds[i].corners().map(|x| pose.point(&x)).collect();
        apart.any(|(axis, plane)| corners.iter().any(|x| plane.depth(x[axis]) < near))
    }

    /// The load on the whole `solid`, if the computed side gives `load` about its centre.
    pub(super) fn load_on_whole(&self, solid: &Solid<D>, load: Load<D>) -> Load<D> {
        let (planes, cut) = (self.symmetry_planes(), solid.division.cut);
        let cutting = planes.each().filter(|(axis, _)| cut >> axis & 1 == 1);
        cutting.fold(load, |load, (axis, plane)| {
            let axes = 1 << axis;
            let force = reflected(axes, load.force);
            // The reflected torque is one about the reflected centre.
            let mut arm = Vector::zeros();
            arm[axis] = 2.0 * (plane.at - solid.kinematics.centre[axis]);
            load + Load { force, torque: reflected_turn(axes, &load.torque) + Bivector::torque(&arm, &force) }
        })
    }

    /// Force (N; N/m in 2-D) of the computed water and of the computed parts of the solids on the symmetry plane normal to
    /// axis number `axis`, positive outwards, at the last force pass: the force that the other side would receive. 0 without a
    /// plane, and in a restored or fetched state until the next pass.
    ///
    /// Along its normal, gravity, this force and the supports of the solids change the momentum of the computed side.
    pub fn symmetry_plane_force(&self, axis: usize) -> f64 {
        let plane = self.symmetry_planes().0.get(axis).copied().flatten();
        let Some(plane) = plane.filter(|_| self.rates.current) else { return 0.0 };
        let (mass, g, rates) = (self.particle_mass(), self.properties.gravity[axis], self.fluid_rates());
        let water: f64 = (0..self.particle_count()).map(|i| rates.of(i).acceleration[axis] - g).sum();
        let mut solids = 0.0;
        for (&i, sums) in self.neighbours.boundary_near_fluid().iter().zip(&self.rates.boundary) {
            let (i, solid) = (i as usize, &self.solids[self.owner(i as usize)]);
            if i < solid.boundary.start + solid.division.own {
                solids += sums.acceleration[axis] * self.computed_share(solid, &self.boundary.particles.r[i]);
            }
        }
        mass * (water + solids) * if plane.is_upper { 1.0 } else { -1.0 }
    }

    /// Velocity (m/s) of water particle `i` as seen at `place` (m), which is its own or that of its image.
    pub(crate) fn velocity_seen_at(&self, i: usize, place: &Vector<D>) -> Vector<D> {
        let Fluid { particles, images, .. } = &self.fluid;
        let axes = images.planes.axes_beyond(place) ^ images.planes.axes_beyond(&particles.r[i]);
        reflected(axes, particles.v[i])
    }

    /// Whether the force of the water on a boundary particle at `x` (m) counts: between the periodic sides and between the faces
    /// of open boundaries, beyond which a buffer prescribes the pressure.
    #[inline]
    pub(super) fn is_in_counted_water(&self, x: &Vector<D>) -> bool {
        self.is_between_sides(x) && self.fluid_domain.open_boundaries.iter().all(|face| face.beyond(x) <= 0.0)
    }

    /// Whether `x` (m) lies between the periodic sides.
    pub(crate) fn is_between_sides(&self, x: &Vector<D>) -> bool {
        self.fluid.images.is_inside(x)
    }

    /// The place between the periodic sides that is whole periods from `x` (m), or its image on the computed side of the symmetry
    /// planes.
    pub fn wrapped(&self, x: &Vector<D>) -> Vector<D> {
        self.fluid.images.wrapped(x)
    }

    /// Calls `visit` with index, place (m) and kernel value W (1/mᴰ) of each water particle whose support holds `x` (m). Across
    /// a periodic side or a symmetry plane the place is that of its image.
    pub fn visit_fluid_near(&self, x: &Vector<D>, visit: &mut dyn FnMut(usize, &Vector<D>, f64)) {
        let water = self.particle_count();
        self.visit_water_and_buffers_near(x, &mut |b, r, w| {
            if b < water {
                visit(b, r, w);
            }
        });
    }

    /// The same with the water of the buffers of open boundaries, whose indices are those of [`System::water_and_buffers`].
    pub(crate) fn visit_water_and_buffers_near(&self, x: &Vector<D>, visit: &mut dyn FnMut(usize, &Vector<D>, f64)) {
        let real = self.own_count();
        self.neighbours.visit_fluid_around(x, &mut |i| {
            let own = i.checked_sub(real).map_or(i, |k| self.fluid.images.originals[k] as usize);
            self.visit_within_support(&self.fluid.particles.r[i], x, own, visit);
        });
    }

    /// Stress (m²/s²) and correction of the gradients (–) of water particle `i`, as the pair loop reads them. For comparisons.
    #[cfg(feature = "gpu")]
    #[doc(hidden)]
    pub fn pair_tensors(&self, i: usize) -> [Matrix<D>; 2] {
        let of = |tensors: &Option<Vec<Matrix<D>>>| tensors.as_ref().map_or_else(Matrix::zeros, |tensors| tensors[i]);
        [of(&self.fluid.stress), of(&self.fluid.gradient_correction)]
    }

    /// The box (m) of the water whose support holds `x` (m).
    pub(crate) fn reading_range(&self, x: &Vector<D>) -> Bounds<D> {
        Bounds { min: *x, max: *x }.grown(self.model.support_radius())
    }

    /// Calls `visit` with index, place (m) and kernel value W (1/mᴰ) of each boundary particle whose support holds `x` (m).
    pub fn visit_boundary_near(&self, x: &Vector<D>, visit: &mut dyn FnMut(usize, &Vector<D>, f64)) {
        let at_rebuild = || match &self.boundary.poses_at_rebuild {
            Some(poses) => self.boundary.positions_at(poses, &self.solids, &self.fluid.images),
            None => self.boundary.particles.r.clone(),
        };
        self.neighbours.visit_boundary_around(at_rebuild, x, &mut |i| {
            self.visit_within_support(&self.boundary.particles.r[i], x, i, visit);
        });
    }

    /// The boundary particles near water, in ascending order, and their sums in the last force pass, which a device may have made.
    fn boundary_sums(&self) -> (&[u32], &[PairSums<D>]) {
        #[cfg(feature = "gpu")]
        if let Some((near, sums)) = self.boundary.on_device.as_ref().and_then(|own| own.sums.as_ref()) {
            return (near, sums);
        }
        (self.neighbours.boundary_near_fluid(), &self.rates.boundary)
    }

    /// Calls `visit` with the index of each boundary particle of solid number `solid` beside water, that of the particle whose image
    /// across symmetry planes it is with the axes of these planes (itself and none), and the force (N; N/m in 2-D) of the water on it
    /// at the last force pass. They sum up to the solid's load.
    pub(crate) fn visit_boundary_forces(
        &self,
        solid: usize,
        visit: &mut dyn FnMut(usize, (usize, AxisSet), Vector<D>),
    ) {
        let (mass, own) = (self.particle_mass(), &self.solids[solid]);
        let skin = if own.copied_axes != 0 { own.boundary.clone() } else { own.boundary_of_copy(0) };
        let (mut forces, (near, sums)) = (BTreeMap::new(), self.boundary_sums());
        for (&i, sums) in near.iter().zip(sums) {
            let r = &self.boundary.particles.r[i as usize];
            if !skin.contains(&(i as usize)) || !self.is_in_counted_water(r) {
                continue;
            }
            if own.division.cut == 0 {
                visit(i as usize, (i as usize, 0), sums.acceleration * mass);
                continue;
            }
            // What lies on a plane gets the force from both sides.
            let (planes, share) = (self.symmetry_planes(), self.computed_share(own, r));
            let on_planes = planes.axes_of_planes_at(own.division.cut, r, self.model.dp);
            let both = |f: Vector<D>, axis: usize| f + reflected(1 << axis, f);
            let axes = (0..D).filter(|axis| on_planes >> axis & 1 == 1);
            let force = axes.fold(sums.acceleration * (mass * share), both);
            visit(i as usize, (i as usize, 0), force);
            forces.insert(i as usize, force);
        }
        for (i, original, axes) in self.boundary.each_mirrored((solid, own)) {
            if let Some(force) = forces.get(&original).filter(|_| own.boundary_of_whole().contains(&i)) {
                visit(i, (original, axes), reflected(axes, *force));
            }
        }
    }

    fn visit_within_support(
        &self,
        r: &Vector<D>,
        x: &Vector<D>,
        i: usize,
        visit: &mut dyn FnMut(usize, &Vector<D>, f64),
    ) {
        let r2 = (r - x).norm_squared();
        if r2 < self.model.support_radius().powi(2) {
            visit(i, r, self.model.kernel_value(r2, D));
        }
    }

    /// Memory of the arrays between two steps, B: particles, lists, and the buffers of a force pass.
    pub(crate) fn memory_bytes(&self) -> usize {
        let water = self.fluid.particles.len();
        let tensors = optional_bytes(&self.fluid.stress) + optional_bytes(&self.fluid.gradient_correction);
        let before = match self.model.scheme {
            TimeScheme::Verlet { .. } => {
                water * size_of::<(Vector<D>, f64)>() + size_of_val(&self.boundary.particles.rho[..])
            }
            TimeScheme::Symplectic => 0,
        };
        self.fluid.particles.memory_bytes()
            + tensors
            + size_of_val(&self.fluid.images.originals[..])
            + size_of_val(self.neighbours.positions_at_build())
            + before
            + self.neighbours.memory_bytes()
            + self.pair_loop.memory_bytes()
            + self.boundary.memory_bytes()
            + size_of_val(&self.rates.boundary[..])
            + self.rates.slip.as_ref().map_or(0, SlipRates::memory_bytes)
    }

    /// Additional memory (B) that a step takes for a while beside [`System::memory_bytes`]: the start of a symplectic step,
    /// shifts, and the extrapolation of the water to the walls, which takes the place of the sums of boundary particles.
    pub(crate) fn step_memory_bytes(&self) -> usize {
        let (water, wet) = (self.fluid.particles.len(), self.boundary_near_fluid_count());
        let start = match self.model.scheme {
            TimeScheme::Verlet { .. } => 0,
            TimeScheme::Symplectic => water * size_of::<(Vector<D>, Vector<D>, f64)>() + wet * size_of::<f64>(),
        };
        let shifts = if self.model.shift().is_some() { water * size_of::<Vector<D>>() } else { 0 };
        start + shifts + wet * (size_of::<WallExtrapolation<f64, D>>() - size_of::<PairSums<D>>())
    }
}
