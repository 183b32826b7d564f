//! Water and solids at one instant, and their rates: neighbour lists, pair sums, loads.
//!
//! No function here knows the length of a time step: time integration and coupling pass the quantities that depend on it.

mod boundary;
mod boundary_extension;
mod change;
mod checkpoint;
#[cfg(feature = "gpu")]
pub(crate) mod device_films;
#[cfg(feature = "gpu")]
pub(crate) mod device_state;
mod driving;
pub(crate) mod film;
mod fluid;
mod free_surface;
mod gap_pressure;
mod impulses;
mod open_boundary;
pub(crate) mod known_water;
pub(crate) mod own_water;
pub(crate) mod periodic;
mod setup;
mod slip_rates;
pub(crate) mod solid_loads;
mod sponge_layer;
pub(crate) mod squeezed_water;
mod step_check;
mod symmetric_setup;
pub(crate) mod symmetry;
pub(crate) mod thin_faces;
mod thin_layers;
mod thin_sides;
mod view;
mod water_column;

pub(crate) use boundary::Boundary;
pub(crate) use checkpoint::{SavedWater, SystemState};
use driving::DrivingState;
pub use driving::{Current, Driving, TowedFrame};
pub(crate) use driving::{driven_speeds, passing_speeds, set_gravity_at, update_current};
pub(crate) use fluid::{Fluid, permute};
use gap_pressure::GapPressure;
#[cfg(feature = "gpu")]
pub(crate) use impulses::has_water_beside;
pub(crate) use impulses::{MomentumTransfer, bounds_beside, return_impulse, spread_impulses};
pub use open_boundary::{FaceExchange, OpenBoundary};
pub(crate) use open_boundary::{
    buffer_length, check as check_open_boundary, face_reached, prescribed_discharge, set_buffer_time, update_buffer,
};
pub(crate) use periodic::Periodic;
use periodic::{Images, SortedWater};
pub use setup::Setup;
pub use sponge_layer::SpongeLayer;
pub use step_check::{Escape, ExitPath, ParticleLimits, RemovedParticle};
pub(crate) use step_check::{LimitViolation, StepCheck};
pub(crate) use symmetry::{AxisSet, reflected, reflected_tensor};
pub(crate) use thin_faces::repel as repel_from_thin_faces;

use own_water::StateAtStart;
use slip_rates::SlipRates;
use symmetry::{reflect_auxiliary, reflected_sums};

pub use crate::interaction::StepLimits;

use std::{
    ops::Range,
    time::{Duration, Instant},
};

use rayon::prelude::*;

use crate::{
    error::{Error, Result},
    interaction::{PairLoop, PairLoopInput, PairSums, RequestedSums},
    math::{Bounds, Matrix, Pose, Vector},
    model::{Model, PressureGradient},
    neighbours::{Columns, NeighbourLists},
    particles::{PARTICLES_PER_TASK, Particles, zeros},
    ranks::{RankPart, WaterShare},
    solid::{Constraints, Solid, TimeFunction},
    sph::{AuxiliarySums, FluidProperties, equation_of_state::EquationOfState, gradient_correction},
};

/// Water and solids at one instant.
pub struct System<const D: usize> {
    model: Model,
    properties: FluidProperties<D>,
    equation_of_state: EquationOfState,
    pair_loop: Box<dyn PairLoop<D>>,
    pub(crate) neighbours: NeighbourLists<D>,
    pub(crate) fluid: Fluid<D>,
    pub(crate) boundary: Boundary<D>,
    gap_pressure: GapPressure<D>,
    pub(crate) solids: Vec<Solid<D>>,
    constraints: Constraints<D>,
    /// Components of gravity as functions of time, m/s²; empty if it is constant.
    gravity_law: Vec<TimeFunction>,
    driving: DrivingState<D>,
    fluid_domain: FluidDomain<D>,
    pub(crate) rates: Rates<D>,
    pub(crate) status: Status,
}

/// Where water may be, and how it is treated there.
struct FluidDomain<const D: usize> {
    /// Where particles may be.
    domain: Bounds<D>,
    limits: ParticleLimits,
    sponge_layers: Vec<SpongeLayer<D>>,
    open_boundaries: Vec<OpenBoundary<D>>,
    /// Height of the highest water at the start, m.
    initial_water_height: f64,
    /// Number of water particles at the start.
    initial_count: usize,
}

/// Sums over pairs from the last force pass; the pair loop keeps those of the water.
pub(crate) struct Rates<const D: usize> {
    /// Whether the sums of the water belong to the present neighbour lists.
    current: bool,
    /// Whether the gradient corrections belong to the present neighbour lists.
    corrections_current: bool,
    /// One for each boundary particle near water.
    pub(crate) boundary: Vec<PairSums<D>>,
    /// Density rates by the slip of boundary particles; `None` unless water sticks to faces.
    slip: Option<SlipRates>,
}

/// The sums of the water from the last force pass. An image has those of its original.
#[derive(Clone, Copy)]
pub(crate) struct FluidRates<'a, const D: usize> {
    pair_loop: &'a dyn PairLoop<D>,
    neighbours: &'a NeighbourLists<D>,
    slip: Option<&'a SlipRates>,
    originals: &'a [u32],
    reflections: &'a [AxisSet],
    /// Number of particles that are no images.
    real: usize,
    /// Number of water particles; those after them, before the images, are in buffers.
    water: usize,
}

impl<'a, const D: usize> FluidRates<'a, D> {
    /// Acceleration and density rate of water particle `i`.
    #[inline(always)]
    pub(crate) fn of(&self, i: usize) -> PairSums<D> {
        let original = self.original(i);
        if original >= self.water {
            return PairSums::zero();
        }
        let mut sums = self.pair_loop.fluid_sums(self.neighbours, original);
        if let Some(slip) = self.slip {
            sums.compression_rate += slip.of(original);
        }
        if self.reflections.is_empty() { sums } else { reflected_sums(self.reflection(i), sums) }
    }

    /// Sets `sums`, which are 0, to those of water particle `i` that only some laws need.
    #[inline(always)]
    pub(crate) fn read_auxiliary_of(&self, i: usize, sums: &mut AuxiliarySums<f64, D>) {
        let original = self.original(i);
        if original >= self.water {
            return;
        }
        self.pair_loop.read_auxiliary_sums(self.neighbours, original, sums);
        if !self.reflections.is_empty() {
            reflect_auxiliary(self.reflection(i), sums);
        }
    }

    /// Along which axes particle `i` is reflected.
    fn reflection(&self, i: usize) -> AxisSet {
        i.checked_sub(self.real).map_or(0, |image| self.reflections[image])
    }

    /// The positions of the water for which the lists were made, m.
    pub(crate) fn positions_at_build(&self) -> &'a [Vector<D>] {
        self.neighbours.positions_at_build()
    }

    /// The range of particles that this rank advances, and which ones there; `None` if all there.
    pub(crate) fn own_water(&self) -> (Range<usize>, Option<&'a [bool]>) {
        own_water::own(self.neighbours, self.neighbours.positions_at_build().len())
    }

    fn original(&self, i: usize) -> usize {
        i.checked_sub(self.real).map_or(i, |image| self.originals[image] as usize)
    }
}

/// Counters and extremes of the steps so far.
pub(crate) struct Status {
    /// The largest values that limit the next step.
    step_limits: StepLimits,
    /// What the last step saw of the water particles.
    pub(crate) step_check: StepCheck,
    /// Force passes so far.
    passes: u64,
    /// Whether solids have been added, which may have displaced water.
    solids_added: bool,
    /// Time spent on neighbour lists and sorting so far.
    neighbour_time: Duration,
    /// Whether this rank has the present water of all ranks.
    pub(crate) has_all_water: bool,
}

/// How arrays of particles change when the neighbour lists are rebuilt.
#[derive(Default)]
pub(crate) struct Reordering<const D: usize> {
    /// New order of the water: `order[new] = old`. Empty where each rank has its own water.
    pub(crate) order: Vec<u32>,
    /// Along which axes the vectors of each particle, in the new order, are reflected; empty without a symmetry plane.
    pub(crate) reflections: Vec<AxisSet>,
    /// Boundary particles that have no water near them any more.
    pub(crate) dried: Vec<u32>,
    /// Particles that were removed.
    pub(crate) removed: Vec<RemovedParticle<D>>,
    /// Energy (J; J/m in 2-D) of the water that has entered through open boundaries less that of the water that has left.
    pub(crate) exchanged_energy: f64,
}

impl<const D: usize> System<D> {
    /// Places the water of `setup` in hydrostatic balance below its levels, and the solids with their boundary particles.
    /// The water of `setup` is this rank's `share`. Afterwards each rank has its own, if the setup allows this.
    pub(crate) fn new(setup: Setup<D>, pair_loop: Box<dyn PairLoop<D>>, share: WaterShare<'_>) -> Result<Self> {
        let WaterShare { ranks, part } = share;
        let planes = setup.symmetry_planes();
        let Setup {
            mut model,
            gravity_law,
            water,
            surface_levels,
            velocity,
            pressure,
            solids: specs,
            constraints,
            domain,
            periodic,
            symmetry: _,
            limits,
            sponge_layers,
            open_boundaries,
            driving,
        } = setup;
        if !gravity_law.is_empty() {
            model.gravity = setup::gravity_at::<D>(&gravity_law, 0.0).iter().copied().collect();
        }
        if let Some(what) = model.conflict() {
            return Err(Error::scene(what));
        }
        let (properties, support) = (model.fluid_properties::<D>(), model.support_radius());
        let equation_of_state = EquationOfState::new(properties.c0, properties.gamma);
        // Depth along g: the level is a height on the last axis.
        let depth = |r: &Vector<D>, level: f64| (level - r[D - 1]).max(0.0) * -properties.gravity[D - 1];
        let more = pressure.into_iter().chain(std::iter::repeat(0.0));
        // The densities take the place of the levels.
        let mut rho = surface_levels;
        for ((rho, r), p) in rho.iter_mut().zip(&water).zip(more) {
            let head = depth(r, *rho) + p / properties.rho0;
            *rho = properties.rho0 * (1.0 + equation_of_state.hydrostatic_compression(head));
        }
        let bounds = own_water::bounds_of_all(ranks, &water, part);
        let RankPart { first, count } = part.unwrap_or(RankPart { first: 0, count: water.len() });
        let mut fluid = Fluid::new(&model, water, velocity, rho, Images::new(periodic, planes, support));
        fluid.particles.id.iter_mut().for_each(|id| *id += first as u32);
        let region = FluidDomain {
            domain: domain.unwrap_or_else(Bounds::empty),
            limits,
            sponge_layers,
            open_boundaries,
            initial_water_height: bounds.max[D - 1],
            initial_count: count,
        };
        let mut system = Self {
            pair_loop,
            neighbours: NeighbourLists::new(support, model.dp, model.pair_loop.instruction_set())
                .on_ranks(ranks.clone()),
            rates: Rates {
                current: false,
                corrections_current: false,
                boundary: Vec::new(),
                slip: SlipRates::new::<D>(&model),
            },
            boundary: Boundary::new(&model),
            gap_pressure: GapPressure::new(&model),
            model,
            properties,
            equation_of_state,
            fluid,
            solids: Vec::new(),
            constraints,
            gravity_law,
            driving: DrivingState::new(driving),
            fluid_domain: region,
            status: Status {
                step_limits: StepLimits { acceleration: 0.0, approach_rate: 0.0 },
                step_check: StepCheck::INITIAL,
                passes: 0,
                solids_added: false,
                neighbour_time: Duration::ZERO,
                has_all_water: true,
            },
        };
        let extensions: Vec<_> =
            (0..specs.len()).map(|i| boundary_extension::extension_particles(i, &specs, &system.model)).collect();
        for (spec, extension) in specs.into_iter().zip(&extensions) {
            let kinematics = spec.initial_kinematics();
            system.append_solid(spec, kinematics, extension)?;
        }
        system.update_shifting_suppression();
        if domain.is_none() {
            let everything = bounds.union(&Bounds::around(&system.boundary.particles.r));
            system.fluid_domain.domain = everything.grown(everything.size().max() + support);
        }
        // Images may be as far beyond a plane as the water is before it.
        let Bounds { min, max } = system.fluid_domain.domain;
        for (axis, _) in planes.each() {
            let bounds = &mut system.fluid_domain.domain;
            let ends = [&min, &max].map(|end| planes.mirrored(1 << axis, end)[axis]);
            (bounds.min[axis], bounds.max[axis]) = (min[axis].min(ends[1]), max[axis].max(ends[0]));
        }
        // Most are of fixed solids: velocities that nothing writes take no memory.
        system.boundary.particles.v = zeros(system.boundary.particles.len());
        for i in 0..system.solids.len() {
            system.place_boundary(i);
        }
        open_boundary::extend_domain_by_buffers(&mut system);
        open_boundary::start_buffers(&mut system);
        driving::start_current(&mut system);
        own_water::divide_at_start(&mut system, part);
        system.rebuild_neighbours();
        open_boundary::update_buffer(&mut system, 0.0, 0.0);
        system.check_water();
        system.init_hydrostatic(0..system.boundary.particles.len());
        driving::set_gravity_at(&mut system, 0.0);
        system.update_rates(RequestedSums::All);
        Ok(system)
    }

    /// Sorts the water along the columns and rebuilds the neighbour lists, if necessary. Returns the reordering for particle
    /// arrays that are stored elsewhere.
    pub(crate) fn rebuild_neighbours(&mut self) -> Option<Reordering<D>> {
        if !self.needs_rebuild() && !open_boundary::needs_exchange(self) && !self.is_water_far_out() {
            return None;
        }
        let start = Instant::now();
        if own_water::is_apart(&self.neighbours) && self.fluid.displaced.is_none() {
            self.pair_loop.free_buffers();
            let (columns, removed) = own_water::sort(self);
            self.status.neighbour_time += start.elapsed();
            let dried = self.rebuild_lists(columns);
            return Some(Reordering { dried, removed, ..Reordering::default() });
        }
        own_water::gather(self, true);
        let exchanged = |system: &Self| system.face_exchange().iter().map(|face| face.energy).sum::<f64>();
        let before = exchanged(self);
        let (SortedWater { order, reflections }, removed) = self.sort_water();
        let exchanged_energy = exchanged(self) - before;
        self.status.neighbour_time += start.elapsed();
        Some(Reordering { order, reflections, dried: self.rebuild_lists(None), removed, exchanged_energy })
    }

    /// Rebuilds the neighbour lists within a step that began at `at_start`, if that is needed; the water keeps its order.
    pub(crate) fn rebuild_within_step(&mut self, at_start: &mut StateAtStart<D>) {
        if self.needs_rebuild() {
            self.pair_loop.free_buffers();
            let boundary = at_start.all_boundary_densities(self);
            let columns =
                own_water::is_apart(&self.neighbours).then(|| own_water::share_out(self, Some(at_start), false));
            self.rebuild_lists(columns);
            at_start.set_boundary_densities(self, &boundary);
        }
    }

    /// Whether particles have moved so far that the lists may miss a pair.
    pub(crate) fn needs_rebuild(&self) -> bool {
        let Some(then) = &self.boundary.poses_at_rebuild else { return true };
        let moved = self.status.step_check.max_displacement2.sqrt() + self.solids_displacement(then);
        moved.is_nan() || moved >= self.neighbours.margin()
    }

    /// How far (m) a boundary particle of a solid may have moved since the solids had the poses `then`.
    fn solids_displacement(&self, then: &[Pose<D>]) -> f64 {
        let moved = |(solid, (then, bounds)): (&Solid<D>, (&Pose<D>, &Bounds<D>))| {
            // A rigid motion moves no point of a box further than its furthest corner.
            let now = &solid.kinematics.pose;
            bounds.corners().map(|x| (now.point(&x) - then.point(&x)).norm()).fold(0.0, f64::max)
        };
        self.solids.iter().zip(then.iter().zip(&self.boundary.local_bounds)).map(moved).fold(0.0, f64::max)
    }

    /// Rebuilds the neighbour lists and resets boundary particles without water near them to ρ₀. Returns those that had water
    /// near them before. If the water is already shared out between ranks, `columns` are the columns by which it is.
    fn rebuild_lists(&mut self, columns: Option<Columns<D>>) -> Vec<u32> {
        let start = Instant::now();
        (self.rates.current, self.rates.corrections_current) = (false, false);
        self.pair_loop.free_buffers();
        let mut dried = self.neighbours.boundary_near_fluid().to_vec();
        if own_water::is_apart(&self.neighbours) {
            let columns = columns.unwrap_or_else(|| own_water::share_out(self, None, false));
            let next = own_water::take_next_slab(self, &columns);
            self.neighbours.build_own(&columns, &self.fluid.particles.r, &next, &self.boundary.particles.r);
        } else {
            self.neighbours.build(&self.fluid.particles.r, &self.boundary.particles.r);
        }
        self.boundary.poses_at_rebuild = Some(self.solids.iter().map(|s| s.kinematics.pose).collect());
        self.status.step_check.max_displacement2 = 0.0;
        self.rates.boundary = vec![PairSums::zero(); self.neighbours.boundary_near_fluid().len()];
        let r = std::mem::take(&mut self.boundary.particles.r);
        self.find_gaps(&r);
        self.boundary.particles.r = r;
        let mut wet = self.neighbours.boundary_near_fluid().iter().copied().peekable();
        dried.retain(|&i| {
            while wet.next_if(|&w| w < i).is_some() {}
            wet.peek() != Some(&i)
        });
        for &i in &dried {
            self.boundary.particles.rho[i as usize] = self.properties.rho0;
        }
        self.status.neighbour_time += start.elapsed();
        dried
    }

    /// What the pair loop reads.
    fn pair_input<'a>(
        neighbours: &'a NeighbourLists<D>,
        fluid: &'a Fluid<D>,
        boundary: &'a Boundary<D>,
        medium: &'a FluidProperties<D>,
        state: &'a EquationOfState,
    ) -> PairLoopInput<'a, D> {
        PairLoopInput {
            neighbours,
            fluid: &fluid.particles,
            boundary: &boundary.particles,
            boundary_velocity: boundary.extrapolated_velocity.as_ref().unwrap_or(&boundary.particles.v),
            stress: fluid.stress.as_deref().unwrap_or_default(),
            gradient_correction: fluid.gradient_correction.as_deref().unwrap_or_default(),
            shifting_suppressed: boundary.shifting_suppressed.as_deref().unwrap_or_default(),
            properties: medium,
            equation_of_state: state,
        }
    }

    /// Computes the rates of the water and the loads on the solids at the present positions, velocities and densities;
    /// the neighbour lists must hold.
    pub(crate) fn update_rates(&mut self, requested: RequestedSums) {
        // The sums of boundary particles of the last pass make room for the extrapolation to the walls.
        self.rates.boundary = Vec::new();
        self.update_wall_state();
        self.boundary.update_copies(&self.solids, &self.fluid.images);
        self.boundary.update_mirrored(&self.solids);
        self.update_gradient_corrections();
        let Self { pair_loop, neighbours, fluid, boundary, properties, equation_of_state, rates, gap_pressure, .. } =
            self;
        let input = Self::pair_input(neighbours, fluid, boundary, properties, equation_of_state);
        rates.boundary = vec![PairSums::zero(); neighbours.boundary_near_fluid().len()];
        self.status.step_limits = pair_loop.rates(&input, requested, &mut rates.boundary);
        if let Some(slip) = &mut rates.slip {
            let near = neighbours.boundary_near_fluid();
            slip.update(&fluid.particles, boundary, (near, &mut rates.boundary));
        }
        rates.current = true;
        Self::add_gap_pressure(gap_pressure, &input, &mut rates.boundary);
        self.limit_step_by_originals();
        if requested == RequestedSums::All {
            self.update_stress();
        }
        let films = film::loads(self, &self.rates.boundary);
        let loads = solid_loads::of_pass(self, &self.rates.boundary, &films.loads);
        self.solids.iter_mut().zip(loads).for_each(|(solid, load)| solid.load = load);
        squeezed_water::update(self, &films.excess);
        self.status.passes += 1;
    }

    /// Adds the accelerations of boundary particles by the pressure across gaps to the sums of those near water.
    fn add_gap_pressure(gaps: &GapPressure<D>, input: &PairLoopInput<'_, D>, sums: &mut [PairSums<D>]) {
        let (boundary, rho0) = (input.boundary, input.properties.rho0);
        let pressure = |i: usize| input.equation_of_state.pressure(boundary.rho[i] / rho0 - 1.0);
        gaps.add_to(sums, input.neighbours.boundary_near_fluid(), &boundary.r, pressure);
    }

    /// Finds the narrow gaps, the films and the water that sticks to faces at the positions `r` (m) of the boundary particles for
    /// which the lists were built. The water beside thin parts is found when it is pushed.
    fn find_gaps(&mut self, r: &[Vector<D>]) {
        let Self { gap_pressure, neighbours, solids, .. } = self;
        gap_pressure.find(solids, r, neighbours.boundary_near_fluid(), neighbours.margin());
        if let Some(poses) = &self.boundary.poses_at_rebuild {
            let films = film::find(self, poses, r);
            self.boundary.films.set(films);
        }
        slip_rates::find(self, r);
        self.boundary.thin.faces.forget_water();
    }

    /// The sums of the water from the last force pass.
    pub(crate) fn fluid_rates(&self) -> FluidRates<'_, D> {
        self.fluid_rates_of(&*self.pair_loop)
    }

    /// The sums of the water from the last pass of a pair loop at the present lists.
    pub(crate) fn fluid_rates_of<'a>(&'a self, pair_loop: &'a dyn PairLoop<D>) -> FluidRates<'a, D> {
        let Images { originals, reflections, .. } = &self.fluid.images;
        let (real, water, slip) = (self.own_count(), self.particle_count(), self.rates.slip.as_ref());
        FluidRates { pair_loop, neighbours: &self.neighbours, slip, originals, reflections, real, water }
    }

    /// The water's particles, and their sums from the last force pass.
    pub(crate) fn fluid_and_rates(&mut self) -> (&mut Particles<D>, FluidRates<'_, D>) {
        let (real, water) = (self.own_count(), self.particle_count());
        let Fluid { particles, images, .. } = &mut self.fluid;
        let (pair_loop, neighbours, slip) = (&*self.pair_loop, &self.neighbours, self.rates.slip.as_ref());
        let Images { originals, reflections, .. } = images;
        (particles, FluidRates { pair_loop, neighbours, slip, originals, reflections, real, water })
    }

    /// The stress that the next force pass reads, from the sums of this one.
    fn update_stress(&mut self) {
        let Some((mut stress, law)) = self.fluid.stress.take().zip(self.model.viscosity.stress()) else { return };
        let (medium, rates, rho) = (&self.properties, self.fluid_rates(), &self.fluid.particles.rho);
        stress.par_iter_mut().enumerate().with_min_len(PARTICLES_PER_TASK).for_each(|(i, stress)| {
            let mut sums = AuxiliarySums::filled_with(0.0);
            rates.read_auxiliary_of(i, &mut sums);
            let rows = law.stress(&sums.strain, medium.rho0 / rho[i], medium);
            *stress = Matrix::from_fn(|i, j| rows[i][j]);
        });
        self.fluid.stress = Some(stress);
        self.pair_loop.inputs_changed();
    }

    /// The corrected gradients, made for new neighbour lists and for every [`gradient_correction::PASSES`]th pass. Still water keeps
    /// its lists for long, and corrections that do not change make it circulate.
    fn update_gradient_corrections(&mut self) {
        if self.rates.corrections_current && !self.status.passes.is_multiple_of(gradient_correction::PASSES) {
            return;
        }
        self.rates.corrections_current = true;
        let Some(mut corrections) = self.fluid.gradient_correction.take() else { return };
        let Self { pair_loop, neighbours, fluid, boundary, properties, equation_of_state, .. } = self;
        let input = Self::pair_input(neighbours, fluid, boundary, properties, equation_of_state);
        pair_loop.moments(&input, &mut corrections);
        let weight = properties.gravity.norm() * properties.dp;
        let (gradient, rho0) = (self.model.gradient, properties.rho0);
        let (these, _) = own_water::own(neighbours, corrections.len());
        let rho = &fluid.particles.rho[these.clone()];
        corrections[these].par_iter_mut().zip(rho).with_min_len(PARTICLES_PER_TASK).for_each(|(correction, &rho)| {
            let share = if gradient == PressureGradient::Corrected {
                1.0
            } else {
                gradient_correction::near_surface(equation_of_state.pressure(rho / rho0 - 1.0), weight)
            };
            let moment = std::array::from_fn(|i| std::array::from_fn(|j| correction[(i, j)]));
            let rows = if share > 0.0 { gradient_correction::correction(&moment) } else { [[0.0; D]; D] };
            *correction = Matrix::from_fn(|i, j| share * rows[i][j]);
        });
        own_water::take_next_corrections(neighbours, &mut corrections);
        let real = corrections.len() - fluid.images.originals.len();
        let (real, images) = corrections.split_at_mut(real);
        let Images { originals, reflections, .. } = &fluid.images;
        images.iter_mut().zip(originals).for_each(|(image, &i)| *image = real[i as usize]);
        images.iter_mut().zip(reflections).for_each(|(image, &axes)| *image = reflected_tensor(axes, image));
        fluid.gradient_correction = Some(corrections);
    }

    /// The largest values that limit the next step.
    pub fn step_limits(&self) -> StepLimits {
        self.status.step_limits
    }
}
