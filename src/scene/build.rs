//! Builds a scene: opens the files that it names, makes shapes and poses, fills the water.

mod open_water;

use super::{
    CurrentConfig, Scene,
    afloat::{PlacedSolids, placed_solids},
    constraints::build_constraints,
    context::{Context, FileNote},
    file_units::require_plausible_units,
    section::{
        analysis::{CheckConfig, ProbeSeries},
        gravity,
        model::require_depth,
        shape::vector,
        solid::require_solid,
        water::{StillWaterLevel, WaterBody, WaterConfig, open_boxes},
    },
};
use crate::{
    error::{Error, ErrorKind, Result},
    geometry::{
        Shape,
        fill::{Filled, Filling, WaterRegion},
        hollow::Enclosure,
        world_bounds,
    },
    math::{Bounds, Pose, Vector, in_dimension},
    model::{Model, TimeScheme},
    plan::{ControlPlan, FramesPlan, Plan},
    ranks::{RankPart, Ranks},
    simulation::{Driving, Setup},
    solid::{Constraints, Role, SolidSpec, TimeFunction},
    system::{Periodic, check_open_boundary, own_water::allow_division, periodic},
};

/// Largest number of particles of a process: they need about 100 GB of memory.
const MOST_PARTICLES: f64 = 2e8;

/// A scene after construction.
pub struct BuiltScene<const D: usize> {
    /// The initial state of a simulation.
    pub setup: Setup<D>,
    /// Which part of the water `setup` has, where each rank has one.
    pub(crate) part: Option<RankPart>,
    /// The probes, files, checks and statistics of a run.
    pub plan: Plan,
    /// The water at the start, for the pre-flight.
    pub initial_water: InitialWater<D>,
    /// Notes about the files that the scene names.
    pub file_notes: Vec<FileNote>,
}

/// The water of a scene at the start, without its particles.
pub struct InitialWater<const D: usize> {
    /// The water at rest.
    pub still: StillWaterLevel,
    /// Number of lattice points without a particle because they lie in a solid.
    pub removed_by_solids: usize,
    /// Number of lattice points without a new particle because they lie in an earlier body of water.
    pub removed_by_water: usize,
    /// The space that each solid encloses in its place.
    pub(crate) enclosures: Vec<Option<Enclosure<D>>>,
    /// The box around each body of water that no solid encloses, up to its level.
    pub(crate) boxes: Vec<Bounds<D>>,
    /// The number of the body of water in each of these boxes.
    pub(crate) box_numbers: Vec<usize>,
    /// The level (m) of each body of water inside a solid, with the number of the solid.
    pub(crate) inside: Vec<(usize, f64)>,
}

/// All parts of a simulation except for the particles.
pub(crate) struct SceneParts<const D: usize> {
    /// The scene with all defaults.
    pub(super) scene: Scene,
    pub(super) water: Vec<WaterBody<D>>,
    pub(super) still: StillWaterLevel,
    gravity_law: Vec<TimeFunction>,
    pub(super) model: Model,
    pub(super) placed: PlacedSolids<D>,
    constraints: Constraints<D>,
    domain: Option<Bounds<D>>,
    periodic: Periodic<D>,
    file_notes: Vec<FileNote>,
}

/// The data that a drawing of a scene needs: the solids, the model and the still water level.
pub struct SceneLayout<const D: usize> {
    /// The solids at their initial positions.
    pub solids: Vec<SolidSpec<D>>,
    /// The laws and constants.
    pub model: Model,
    /// The water at rest.
    pub still_water: StillWaterLevel,
}

/// Estimated size of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SizeEstimate {
    /// 2 or 3.
    pub dimension: usize,
    /// Number of water particles.
    pub fluid: f64,
    /// Number of boundary particles.
    pub boundary: f64,
    /// The largest time step that sound and the Courant number allow, s.
    pub dt: f64,
    /// Number of steps to the end with the time step `dt`. A run takes slightly more steps.
    pub steps: f64,
    /// Number of force evaluations in a step.
    pub passes: f64,
}

impl SizeEstimate {
    /// Returns the number of water particles × force evaluations. It is about proportional to the computing time of a
    /// run.
    pub fn particle_passes(&self) -> f64 {
        self.fluid * self.steps * self.passes
    }
}

impl Scene {
    /// Opens the files that the scene names. Returns the initial state of a
    /// [`Simulation`](crate::simulation::Simulation) and the plan of the run.
    ///
    /// # Errors
    /// `Usage` if `D` is not the scene's dimension; `Scene` if the scene is wrong, a shape is not valid,
    /// a body sinks that should float, or the particles are too many; `File` if a table cannot be read.
    pub fn build<const D: usize>(&self) -> Result<BuiltScene<D>> {
        self.build_on(&Ranks::default())
    }

    /// As [`Scene::build`], but the `ranks` share the filling: see [`SceneParts::fill`].
    ///
    /// # Errors
    /// Those of [`Scene::build`]; `Usage` if another rank cannot open its files.
    pub(crate) fn build_on<const D: usize>(&self, ranks: &Ranks) -> Result<BuiltScene<D>> {
        let built = in_dimension((), |()| self.build_2d(ranks), |()| self.build_3d(ranks));
        built.unwrap_or_else(|| Err(self.other_dimension(D)))
    }

    #[inline(never)]
    fn build_2d(&self, ranks: &Ranks) -> Result<BuiltScene<2>> {
        ranks.agree(self.parts(ranks.count()), |_| String::new())?.fill(ranks)
    }

    #[inline(never)]
    fn build_3d(&self, ranks: &Ranks) -> Result<BuiltScene<3>> {
        ranks.agree(self.parts(ranks.count()), |_| String::new())?.fill(ranks)
    }

    fn other_dimension(&self, asked: usize) -> Error {
        Error::new(ErrorKind::Usage, format!("this scene is {}-D, not {asked}-D", self.dimension))
    }

    /// Opens the files that the scene names, and returns all parts of the simulation except for the particles. At most `ranks` processes
    /// share the water.
    ///
    /// # Errors
    /// The errors of [`Scene::build`], except for those of the filling.
    pub(crate) fn parts<const D: usize>(&self, ranks: usize) -> Result<SceneParts<D>> {
        if self.dimension != D {
            return Err(self.other_dimension(D));
        }
        let (scene, _) = self.with_defaults()?;
        let ctx = &scene.context();
        let water = scene.water_bodies::<D>(ctx)?;
        let still = StillWaterLevel::of(&water);
        let gravity_law =
            scene.gravity.as_ref().map(|config| gravity::build(ctx, config)).transpose()?.unwrap_or_default();
        let model = scene.model.build(ctx, &scene.time, &still)?;
        scene.model.require_stable_lattice::<D>(ctx, &model)?;
        require_depth(ctx, &still, &model)?;
        let placed = placed_solids::<D>(&scene, ctx, &water, true).map_err(|e| ctx.with_warnings(e))?;
        let solids = &placed.specs;
        require_plausible_units(ctx, &self.solid, &water, solids)?;
        let constrained = || placed.moved(ctx, build_constraints(&scene, ctx, solids, &placed.levels)?);
        let constraints = constrained().map_err(|e| ctx.with_warnings(e))?;
        let domain = scene.domain.as_ref().map(|d| Bounds { min: vector(&d.min), max: vector(&d.max) });
        domain.iter().try_for_each(|domain| require_inside_domain(ctx, domain, &water, solids))?;
        let periodic = scene.periodic.clone().unwrap_or_default().build();
        let has_planes = scene.symmetry.as_ref().is_some_and(|planes| planes.build::<D>().iter().any(Option::is_some));
        periodic::check(&periodic, has_planes, &model, solids, &constraints)
            .and_then(|()| periodic::check_motions(&periodic, has_planes, &model, solids, scene.until))
            .map_err(|e| ctx.with_location(e, "periodic"))?;
        require_affordable(ctx, &water, solids, ranks)?;
        let file_notes = ctx.file_notes.take();
        Ok(SceneParts { scene, water, still, gravity_law, model, placed, constraints, domain, periodic, file_notes })
    }

    /// Returns the solids and the water at rest without creating particles.
    ///
    /// # Errors
    /// The same errors as [`Scene::build`].
    pub fn layout<const D: usize>(&self) -> Result<SceneLayout<D>> {
        let (scene, _) = self.with_defaults()?;
        let ctx = &scene.context();
        let water = scene.water_bodies::<D>(ctx)?;
        let still = StillWaterLevel::of(&water);
        let model = scene.model.build(ctx, &scene.time, &still)?;
        Ok(SceneLayout { solids: placed_solids::<D>(&scene, ctx, &water, false)?.specs, model, still_water: still })
    }

    /// Returns the probes, files, checks and statistics of a run without creating particles.
    ///
    /// # Errors
    /// `Scene` if the scene is wrong, or a table that a check names is missing or wrong.
    pub fn plan(&self) -> Result<Plan> {
        let (scene, _) = self.with_defaults()?;
        scene.resolved_plan(&scene.context(), &scene.still_water()?)
    }

    /// Returns the estimated size of a run of this scene.
    ///
    /// # Errors
    /// `Scene` if the scene is wrong, a shape is not valid, or the particles are too many.
    pub fn estimate_size(&self) -> Result<SizeEstimate> {
        let (scene, _) = self.with_defaults()?;
        match scene.dimension {
            2 => scene.estimate::<2>(),
            _ => scene.estimate::<3>(),
        }
    }

    fn estimate<const D: usize>(&self) -> Result<SizeEstimate> {
        let ctx = &self.context();
        let water = self.water_bodies::<D>(ctx)?;
        let model = self.model.build(ctx, &self.time, &StillWaterLevel::of(&water))?;
        let solids = placed_solids::<D>(self, ctx, &water, false)?.specs;
        require_plausible_units(ctx, &self.solid, &water, &solids)?;
        require_affordable(ctx, &water, &solids, 1)?;
        Ok(self.size_estimate(ctx, &water, &model, &solids))
    }

    /// Returns the estimated size of a run with this water and these solids.
    fn size_estimate<const D: usize>(
        &self,
        ctx: &Context,
        water: &[WaterBody<D>],
        model: &Model,
        solids: &[SolidSpec<D>],
    ) -> SizeEstimate {
        let (fluid, boundary) = estimated_counts(ctx, water, solids);
        let fluid = fluid * self.computed_share(water);
        let dt = (model.cfl * model.h / model.c0).min(model.dt_max);
        let passes = if matches!(model.scheme, TimeScheme::Verlet { .. }) { 1.0 } else { 2.0 };
        SizeEstimate { dimension: D, fluid, boundary, dt, steps: (self.until / dt).ceil(), passes }
    }

    /// Returns the share of the water on the computed side of the symmetry planes, by the boxes around it.
    fn computed_share<const D: usize>(&self, water: &[WaterBody<D>]) -> f64 {
        let planes: [Option<f64>; D] = self.symmetry.clone().unwrap_or_default().build();
        let boxes: Vec<Bounds<D>> = water.iter().map(|b| world_bounds(&b.region.shape, &b.region.pose)).collect();
        let mut share = 1.0;
        for (axis, at) in planes.into_iter().enumerate().filter_map(|(axis, at)| Some((axis, at?))) {
            let is_upper = boxes.iter().any(|bounds| bounds.max[axis] > at + 0.5 * self.dp);
            let side = |x: f64| if is_upper { x.max(at) } else { x.min(at) };
            let length = |bounds: &Bounds<D>, of: &dyn Fn(f64) -> f64| of(bounds.max[axis]) - of(bounds.min[axis]);
            let volume = |of: &dyn Fn(f64) -> f64| -> f64 {
                let others = |bounds: &Bounds<D>| bounds.size().product() / length(bounds, &|x| x);
                boxes.iter().map(|bounds| others(bounds) * length(bounds, of)).sum()
            };
            share *= volume(&side) / volume(&|x| x);
        }
        share
    }

    /// Returns the approximate number of water particles, without the volume of the solids, or 0 if the water cannot be
    /// built.
    pub(super) fn water_particles(&self) -> f64 {
        fn count<const D: usize>(scene: &Scene) -> Result<f64> {
            let ctx = &scene.context();
            Ok(estimated_counts::<D>(ctx, &scene.water_bodies(ctx)?, &[]).0)
        }
        let counted = if self.dimension == 2 { count::<2>(self) } else { count::<3>(self) };
        counted.unwrap_or(0.0)
    }

    /// The water at rest.
    pub(super) fn still_water(&self) -> Result<StillWaterLevel> {
        let ctx = &self.context();
        Ok(match self.dimension {
            2 => StillWaterLevel::of(&self.water_bodies::<2>(ctx)?),
            _ => StillWaterLevel::of(&self.water_bodies::<3>(ctx)?),
        })
    }

    fn water_bodies<const D: usize>(&self, ctx: &Context) -> Result<Vec<WaterBody<D>>> {
        let body = |(i, water): (usize, &WaterConfig)| {
            let mut body = water.build(ctx, &format!("water.{i}"))?;
            if let Some(name) = &water.inside {
                require_solid(ctx, &self.solid, &format!("water.{i}.inside"), name)?;
                body.inside = self.solid.iter().position(|solid| solid.name == *name);
            }
            Ok(body)
        };
        self.water.iter().enumerate().map(body).collect()
    }

    /// Returns the plan of a run. The defaults of the scene must be filled in.
    fn resolved_plan(&self, ctx: &Context, still: &StillWaterLevel) -> Result<Plan> {
        let series = ProbeSeries { probes: &self.probe, names: &self.probe_names() };
        let statistics = self.statistic.iter().enumerate();
        let (checkpoint, probes) = (self.checkpoint.clone().unwrap_or_default(), self.probe_plans());
        let check = |(i, check): (usize, &CheckConfig)| check.build(ctx, &format!("check.{i}"), &probes);
        let checks = self.check.iter().enumerate().map(check).collect::<Result<_>>()?;
        Ok(Plan {
            title: self.title.clone().unwrap_or_default(),
            until: self.until,
            checks,
            contacts: self.probe.iter().filter_map(|probe| probe.to_contact_list(self.until)).collect(),
            frames: (self.frames.as_ref().and_then(|frames| frames.build(ctx)))
                .map(|frames| FramesPlan { moorings: !self.mooring.is_empty(), ..frames }),
            checkpoint_every: checkpoint.every,
            checkpoint_wall: checkpoint.wall_time(),
            probes,
            statistics: statistics
                .map(|(i, statistic)| statistic.build(ctx, &format!("statistic.{i}"), &series, still))
                .collect::<Result<_>>()?,
            controls: self.controls(ctx)?,
            folder: self.origin.folder.clone(),
        })
    }

    /// Returns the numbers that may be changed during a run.
    pub(super) fn controls(&self, ctx: &Context) -> Result<Vec<ControlPlan>> {
        let controls = self.control.iter().enumerate();
        let built: Vec<ControlPlan> = controls
            .map(|(i, control)| control.build(ctx, &format!("control.{i}"), &self.joint, &self.force))
            .collect::<Result<_>>()?;
        match (1..built.len()).find(|&i| built[..i].iter().any(|other| other.target == built[i].target)) {
            Some(i) => Err(ctx.error_at(&format!("control.{i}.key"), format!("{} is controlled twice", built[i].key))),
            None => Ok(built),
        }
    }
}

impl<const D: usize> SceneParts<D> {
    /// Returns the estimated size of a run.
    pub(crate) fn estimated_size(&self) -> SizeEstimate {
        self.scene.size_estimate(&self.scene.context(), &self.water, &self.model, &self.placed.specs)
    }

    /// Creates the water particles. The `ranks` share the work. Each gets a part of the particles, if the run may be divided, else all.
    ///
    /// # Errors
    /// `Scene` if no water is left, or the plan of the run is wrong; `File` if a table cannot be read.
    pub(crate) fn fill(self, ranks: &Ranks) -> Result<BuiltScene<D>> {
        let Self { scene, mut water, still, gravity_law, model, mut placed, constraints, domain, periodic, file_notes } =
            self;
        let (ctx, solids) = (&scene.context(), &placed.specs);
        ctx.add_file_notes(file_notes);
        let driving = Driving {
            current: scene.current.as_ref().map(CurrentConfig::build),
            towed: scene.towed.as_ref().map(|towed| towed.build(ctx)).transpose()?,
        };
        let own_levels = water.iter().filter_map(|body| Some((body.inside?, body.level))).collect();
        let boxes = open_boxes(&water);
        let box_numbers = (0..water.len()).filter(|i| water[*i].inside.is_none()).collect();
        let first_buffer = water.len();
        let (mut open_boundaries, buffers) = open_water::open_boundaries(&scene, ctx, &water, &model)?;
        water.extend(buffers);
        let regions: Vec<WaterRegion<D>> =
            water.iter().map(|b| WaterRegion { shape: b.region.shape.clone(), pose: b.region.pose }).collect();
        // The initial position of a driven solid follows from its motion.
        let starts: Vec<Pose<D>> = solids.iter().map(|s| s.initial_kinematics().pose).collect();
        let rests = |s: &SolidSpec<D>| !matches!(s.role, Role::Free(_));
        let solid_shapes: Vec<(&Shape<D>, &Pose<D>, bool)> =
            solids.iter().zip(&starts).map(|(s, start)| (&s.shape, start, rests(s))).collect();
        let spaces = placed.spaces(&starts, &water);
        let inside = water.iter().map(|body| body.inside).collect();
        let symmetry = scene.symmetry.clone().unwrap_or_default().build();
        let is_shared = allow_division(&model, &driving)
            && open_boundaries.is_empty()
            && periodic.iter().chain(&symmetry.map(|at: Option<f64>| at.map(|at| [at; 2]))).all(Option::is_none)
            && scene.jitter.is_none();
        let alone = Ranks::default();
        let owners = if is_shared { ranks } else { &alone };
        require_affordable(ctx, &water, solids, owners.count())?;
        // A box by its corners ends at its level.
        let levels = scene.water.iter().map(|own| own.level.filter(|_| own.fill.shape.is_some())).collect();
        let filling =
            Filling { regions: &regions, inside, levels, solids: &solid_shapes, spaces: &spaces, ranks, owners };
        let Filled { water: mut filled, home, has_own_water } =
            filling.fill(scene.dp).map_err(|e| ctx.with_location(e, "water"))?;
        let (bodies, buffers) = water.split_at(first_buffer);
        open_water::set_depths_at_faces(&scene, ctx, &mut open_boundaries, (bodies, buffers, &filled.r), &model)?;
        let part = owners.part(filled.r.len());
        if part.count == 0 {
            return Err(no_water_error(ctx, &water, solids));
        }
        let mut counts = vec![0; water.len()];
        home.iter().for_each(|own| counts[*own as usize] += 1);
        owners.add_numbers(&mut counts);
        if let Some(i) = counts[..first_buffer].iter().position(|count| *count == 0) {
            return Err(empty_water_error(ctx, i, water[i].inside.map(|solid| &solids[solid].name)));
        }
        let own_water: Vec<usize> =
            spaces.iter().zip(has_own_water).filter(|(_, own)| *own).map(|(space, _)| space.solid).collect();
        let plan = scene.resolved_plan(ctx, &still)?;
        let origin = |home: &u32| &water[*home as usize];
        let levels = home.iter().map(|home| origin(home).level).collect();
        let moves = scene.water.iter().any(|water| water.velocity.is_some() || water.pressure.is_some());
        let (mut velocity, mut pressure) = (Vec::new(), Vec::new());
        for (x, home) in filled.r.iter().zip(&home).take(if moves { filled.r.len() } else { 0 }) {
            if (*home as usize) < first_buffer {
                origin(home).flow.require_possible(ctx, &format!("water.{home}"), x, model.c0)?;
            }
            let (v, p) = origin(home).flow.at(x);
            velocity.push(v);
            pressure.push(p);
        }
        if let Some(towed) = &driving.towed {
            let moving =
                velocity.iter().zip(&home).filter(|(_, home)| (**home as usize) < first_buffer).map(|(v, _)| v);
            open_water::note_start_of_tow(ctx, towed, moving);
        }
        if let Some(part) = scene.jitter {
            jitter(&mut filled.r, part * scene.dp);
        }
        let limits = scene.guard.clone().unwrap_or_default().build();
        let sponge_layers = scene.damping.iter().map(|layer| layer.build(ctx, &still)).collect();
        // Water in a hull is intended if its region does not reach around the hull.
        own_water.into_iter().for_each(|i| {
            placed.specs[i].dry.get_or_insert(false);
        });
        let solids = placed.specs;
        let mut setup = Setup {
            model,
            gravity_law,
            water: filled.r,
            surface_levels: levels,
            velocity,
            pressure,
            solids,
            constraints,
            domain,
            periodic,
            symmetry,
            limits,
            sponge_layers,
            open_boundaries,
            driving,
        };
        for (i, (key, _, _)) in open_water::open_faces(&scene).enumerate() {
            check_open_boundary(&setup, i, scene.until).map_err(|e| ctx.with_location(e, &key))?;
        }
        setup.apply_symmetry().map_err(|e| ctx.with_location(e, "symmetry"))?;
        Ok(BuiltScene {
            setup,
            part: (owners.count() > 1).then_some(part),
            plan,
            initial_water: InitialWater {
                still,
                removed_by_solids: filled.removed_in_solids,
                removed_by_water: filled.removed_in_regions,
                enclosures: placed.enclosures,
                boxes,
                box_numbers,
                inside: own_levels,
            },
            file_notes: ctx.file_notes.take(),
        })
    }
}

/// Refuses water and moving solids that start outside the domain.
fn require_inside_domain<const D: usize>(
    ctx: &Context,
    domain: &Bounds<D>,
    water: &[WaterBody<D>],
    solids: &[SolidSpec<D>],
) -> Result<()> {
    let out = |shape: &Shape<D>, pose: &Pose<D>| {
        let bounds = world_bounds(shape, pose);
        !(domain.contains(&bounds.min) && domain.contains(&bounds.max))
    };
    let help = "enlarge the domain: what leaves it stops the run. Leave [domain] out for one with room on all sides";
    if let Some(i) = water.iter().position(|body| out(&body.region.shape, &body.region.pose)) {
        return Err(ctx.error_with_help(&format!("water.{i}"), "this water is not wholly inside the domain", help));
    }
    let still = |solid: &SolidSpec<D>| matches!(solid.role, Role::Fixed);
    match solids.iter().position(|solid| !still(solid) && out(&solid.shape, &solid.pose)) {
        Some(i) => {
            let what = format!("solid \"{}\" starts outside the domain", solids[i].name);
            Err(ctx.error_with_help(&format!("solid.{i}.at"), what, help))
        }
        None => Ok(()),
    }
}

/// Returns the error that no water is left. Its message names the first free body that is larger than the water.
fn no_water_error<const D: usize>(ctx: &Context, water: &[WaterBody<D>], solids: &[SolidSpec<D>]) -> Error {
    let boxes = water.iter().map(|body| world_bounds(&body.region.shape, &body.region.pose));
    let room = boxes.fold(Bounds::empty(), |a, b| a.union(&b)).size();
    let free = solids.iter().enumerate().filter(|(_, solid)| matches!(solid.role, Role::Free(_)));
    let mut sizes = free.map(|(i, solid)| (i, world_bounds(&solid.shape, &solid.pose).size()));
    let larger = |(i, size): (usize, Vector<D>)| Some((i, size, (0..D).find(|&axis| size[axis] >= room[axis])?));
    let Some((i, size, axis)) = sizes.find_map(larger) else {
        return ctx.error_at("water", "no water is left: it is thinner than dp, or solids fill it");
    };
    let way = if axis == D - 1 { "high" } else { ["long along x", "long along y"][axis] };
    let (name, size, room) = (&solids[i].name, size[axis], room[axis]);
    let what = format!("no water is left: \"{name}\" is {size:.4} m {way} and the water {room:.4} m");
    ctx.error_with_help(&format!("solid.{i}.shape"), what, "make it smaller, or the tank and its water larger")
}

/// Returns the error that body of water number `i`, inside the solid of this name, has no particle.
fn empty_water_error(ctx: &Context, i: usize, inside: Option<&String>) -> Error {
    let (what, help) = match inside {
        Some(name) => (
            format!("no particle of this water is left: it meets no hollow of \"{name}\" below its level"),
            "let its region and its level reach into the hollow as the solid is placed",
        ),
        None => (
            "no particle of this water is left: solids, hollows that stay dry or an earlier [[water]] take its place"
                .into(),
            "move it, or remove it: its level and its bottom count for the depth and for the speed of sound",
        ),
    };
    ctx.error_with_help(&format!("water.{i}.fill"), what, help)
}

/// Returns the approximate numbers of water particles and boundary particles.
fn estimated_counts<const D: usize>(ctx: &Context, water: &[WaterBody<D>], solids: &[SolidSpec<D>]) -> (f64, f64) {
    let (volume, surface) = volume_and_surface(water, solids);
    let dimension = D as i32;
    (volume / ctx.dp.powi(dimension), surface * ctx.layers() as f64 / ctx.dp.powi(dimension - 1))
}

/// Refuses a scene with more particles than [`MOST_PARTICLES`] for each of `ranks` processes, which share the water, before any particle
/// is created.
fn require_affordable<const D: usize>(
    ctx: &Context,
    water: &[WaterBody<D>],
    solids: &[SolidSpec<D>],
    ranks: usize,
) -> Result<()> {
    let (fluid, boundary) = estimated_counts(ctx, water, solids);
    let (all, own) = (fluid + boundary, fluid / ranks as f64 + boundary);
    // Particles have numbers of 32 bits.
    if own <= MOST_PARTICLES && all < f64::from(u32::MAX) {
        return Ok(());
    }
    let (volume, surface) = volume_and_surface(water, solids);
    // Rounds to six digits: 0.3 instead of 0.30000000000000004.
    let volume = format!("{volume:.5e}").parse().unwrap_or(volume);
    let (space, face) = if D == 3 { ("m³", "m²") } else { ("m²", "m") };
    let what = format!(
        "the scene asks for {all:.1e} particles: {volume} {space} of water / dp{} + {surface:.3} {face} of solids × \
         {} layers / dp{}",
        ["²", "³"][D - 2],
        ctx.layers(),
        ["", "²"][D - 2],
    );
    let dp = 1.05 * ctx.dp * (own / MOST_PARTICLES).powf(1.0 / D as f64);
    let help = format!("the most is {MOST_PARTICLES:.0e} a process: write  dp = {dp:.1e}  or more");
    Err(ctx.error_with_help("dp", what, help))
}

/// Returns the volume of the water (m³; m² in 2-D) and the surface of the solids (m²; m).
fn volume_and_surface<const D: usize>(water: &[WaterBody<D>], solids: &[SolidSpec<D>]) -> (f64, f64) {
    let volume = water.iter().map(|body| body.region.shape.volume_properties().volume).sum();
    (volume, solids.iter().map(|solid| solid.shape.surface_area()).sum())
}

/// Moves every point by up to `by` (m) in each direction. The displacement depends only on the index of the point.
fn jitter<const D: usize>(points: &mut [Vector<D>], by: f64) {
    for (n, x) in (1u64..).zip(points.iter_mut().flat_map(|x| x.iter_mut())) {
        // The mixing function of splitmix64 (Steele et al. 2014) computes a pseudo-random number from the index.
        let mut z = n.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let part = ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64;
        *x += by * (2.0 * part - 1.0);
    }
}

#[cfg(test)]
#[path = "../../tests/unit/scene/build.rs"]
mod tests;
