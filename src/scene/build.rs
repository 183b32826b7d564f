//! From words to a simulation's start: opens the files that the scene names, makes shapes and poses, fills
//! the water.

use super::{
    FillConfig, FramesChoice, FramesPlan, Plan, Scene,
    build_waves::StillWater,
    flow::InitialFlow,
    geometry::{pose, shape, vector, world_bounds},
    resolve::CHECKPOINT_WALL,
};
use crate::{
    error::{Error, ErrorKind, Result},
    geometry::{
        Shape,
        fill::{WaterRegion, fill},
    },
    math::{Bounds, Pose, Vector},
    model::Model,
    simulation::Setup,
    solid::{Role, SolidSpec},
    system::periodic,
};

/// Most particles that a scene may ask for: about 100 GB of memory.
const MOST_PARTICLES: f64 = 2e8;

/// Least stiffness μ of the lattice, –: below it still water round a float has come to move at 0.07 to 0.13 √(g depth) within a
/// second, above it at up to 0.08 (docs/stability.md).
const MIN_LATTICE_STIFFNESS: f64 = -0.07;

/// Least depth of still water over the reach of the kernel, –: of 0.67 it rises by some per cent of dp, of 0.75 by none
/// (docs/stability.md).
const MIN_DEPTH_RATIO: f64 = 0.75;

/// What a scene was built into.
pub struct BuiltScene<const D: usize> {
    /// What a simulation starts from.
    pub setup: Setup<D>,
    /// What the run watches, keeps and judges.
    pub plan: Plan,
    /// Places of the water's lattice left empty because a solid is there.
    pub removed_by_solids: usize,
    /// Places left empty because an earlier body of water is there.
    pub removed_by_water: usize,
    /// The water at rest.
    pub still_water: StillWaterLevel,
}

/// The water at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StillWaterLevel {
    /// The highest level, from which drafts are measured, m.
    pub level: f64,
    /// From the lowest water to there, m.
    pub depth: f64,
}

/// What stands around the water: enough to draw a scene.
pub(crate) struct SceneLayout<const D: usize> {
    /// The solids, where they start.
    pub(crate) solids: Vec<SolidSpec<D>>,
    /// The laws and constants.
    pub(crate) model: Model,
    /// The water at rest.
    pub(crate) still_water: StillWaterLevel,
}

/// A body of water: where it is and how high it stands.
pub(super) struct WaterBody<const D: usize> {
    pub(super) region: WaterRegion<D>,
    bottom: f64,
    pub(super) level: f64,
    flow: InitialFlow<D>,
}

impl<const D: usize> WaterBody<D> {
    /// Signed distance (m) of the point `x` (m) from this water, negative inside.
    fn distance(&self, x: &Vector<D>) -> f64 {
        self.region.shape.signed_distance(&self.region.pose.local(x))
    }

    /// Whether `x` (m) is in this water, or so near to it that only round-off says otherwise.
    fn contains(&self, x: &Vector<D>) -> bool {
        self.distance(x) < 1e-9
    }
}

impl StillWaterLevel {
    pub(super) fn of<const D: usize>(water: &[WaterBody<D>]) -> Self {
        let level = water.iter().map(|body| body.level).fold(f64::NEG_INFINITY, f64::max);
        let bottom = water.iter().map(|body| body.bottom).fold(f64::INFINITY, f64::min);
        Self { level, depth: level - bottom }
    }
}

impl Scene {
    /// Opens the files that the scene names and makes what a [`Simulation`](crate::simulation::Simulation)
    /// starts from, and the plan of the run.
    ///
    /// # Errors
    /// `Usage` if `D` is not the scene's dimension; `Scene` if the words contradict one another, a shape is
    /// none, a body sinks that should float, the particles are too many; `File` if a table cannot be read.
    pub fn build<const D: usize>(&self) -> Result<BuiltScene<D>> {
        if self.dimension != D {
            return Err(Error::new(ErrorKind::Usage, format!("this scene is {}-D, not {D}-D", self.dimension)));
        }
        let (scene, _) = self.with_defaults()?;
        let water = scene.water_bodies::<D>()?;
        let still = StillWaterLevel::of(&water);
        let model = scene.build_model(&water)?;
        scene.require_stable_lattice::<D>(&model)?;
        scene.require_depth(&still, &model)?;
        let solids = scene.solids::<D>(&StillWater::of(&water))?;
        let links = scene.build_constraints(&solids)?;
        let domain = scene.domain.as_ref().map(|d| Bounds { min: vector(&d.min), max: vector(&d.max) });
        if let Some(domain) = &domain {
            scene.require_inside_domain(domain, &water, &solids)?;
        }
        let periodic = scene.periods();
        periodic::check(&periodic, &model, &solids).map_err(|e| scene.origin.with_location(e, "periodic"))?;
        scene.require_affordable(&water, &solids)?;
        let regions: Vec<WaterRegion<D>> =
            water.iter().map(|b| WaterRegion { shape: b.region.shape.clone(), pose: b.region.pose }).collect();
        // A driven solid starts where its law says.
        let starts: Vec<Pose<D>> = solids.iter().map(|s| s.initial_kinematics().pose).collect();
        let solid_shapes: Vec<(&Shape<D>, &Pose<D>)> =
            solids.iter().zip(&starts).map(|(s, start)| (&s.shape, start)).collect();
        let mut filled = fill(&regions, &solid_shapes, scene.dp).map_err(|e| scene.origin.with_location(e, "water"))?;
        if scene.water.iter().any(|w| w.level.is_some() && w.fill.shape.is_some()) {
            filled.r.retain(|x| water.iter().any(|body| body.contains(x) && x[D - 1] < body.level));
        }
        if filled.r.is_empty() {
            return Err(scene.no_water_error(&water, &solids));
        }
        let plan = scene.resolved_plan(&still)?;
        // Packing may have moved a particle a little way out of its water.
        let nearest = |x: &Vector<D>| water.iter().min_by(|a, b| a.distance(x).total_cmp(&b.distance(x)));
        let level = |x: &Vector<D>| nearest(x).map_or(still.level, |body| body.level);
        let levels = filled.r.iter().map(level).collect();
        let flow = |x: &Vector<D>| nearest(x).map_or((Vector::zeros(), 0.0), |body| body.flow.at(x));
        let moves = scene.water.iter().any(|words| words.velocity.is_some() || words.pressure.is_some());
        let (velocity, pressure) = filled.r.iter().filter(|_| moves).map(flow).unzip();
        if let Some(part) = scene.scatter {
            jitter(&mut filled.r, part * scene.dp);
        }
        let (limits, water) = (scene.limits(), filled.r);
        let damping = scene.sponge_layers(&still);
        let setup = Setup {
            model,
            water,
            surface_levels: levels,
            velocity,
            pressure,
            solids,
            constraints: links,
            domain,
            periodic,
            limits,
            sponge_layers: damping,
        };
        Ok(BuiltScene {
            setup,
            plan,
            removed_by_solids: filled.removed_in_solids,
            removed_by_water: filled.removed_in_regions,
            still_water: still,
        })
    }

    /// The solids and the water at rest; makes no particles.
    ///
    /// # Errors
    /// As [`Scene::build`].
    pub(crate) fn layout<const D: usize>(&self) -> Result<SceneLayout<D>> {
        let (scene, _) = self.with_defaults()?;
        let water = scene.water_bodies::<D>()?;
        let still = StillWaterLevel::of(&water);
        Ok(SceneLayout {
            solids: scene.solids::<D>(&StillWater::of(&water))?,
            model: scene.build_model(&water)?,
            still_water: still,
        })
    }

    /// What a run watches, keeps and judges; makes no particles.
    ///
    /// # Errors
    /// `Scene` if the words contradict one another, or a table that a check names is missing or wrong.
    pub fn plan(&self) -> Result<Plan> {
        let (scene, _) = self.with_defaults()?;
        let still = match scene.dimension {
            2 => StillWaterLevel::of(&scene.water_bodies::<2>()?),
            _ => StillWaterLevel::of(&scene.water_bodies::<3>()?),
        };
        scene.resolved_plan(&still)
    }

    /// Speed of sound, m/s: given, or from the depth.
    pub(super) fn sound_speed<const D: usize>(&self) -> Result<f64> {
        Ok(self.build_model(&self.water_bodies::<D>()?)?.c0)
    }

    pub(super) fn water_bodies<const D: usize>(&self) -> Result<Vec<WaterBody<D>>> {
        let mut bodies = Vec::new();
        for (i, words) in self.water.iter().enumerate() {
            let key = format!("water.{i}");
            let place = |e: Error| self.origin.with_location(e, &format!("{key}.fill"));
            let (shape, pose) = match &words.fill {
                FillConfig { corners: Some(corners), .. } => {
                    let (min, mut max): (Vector<D>, Vector<D>) = (vector(&corners.min), vector(&corners.max));
                    max[D - 1] = words.level.unwrap_or(f64::INFINITY).min(max[D - 1]).max(min[D - 1]);
                    (Shape::Box { size: max - min }, Pose::at(0.5 * (min + max)))
                }
                FillConfig { shape: words, at, .. } => {
                    let Some(words) = words else { return Err(self.error_at(&key, "what does the water fill?")) };
                    let shape = shape(self, words).map_err(place)?;
                    let pose = at.as_ref().map_or_else(Pose::identity, |at| pose(at, &shape, 0.0));
                    (shape, pose)
                }
            };
            let bounds = world_bounds(&shape, &pose);
            let (bottom, top) = (bounds.min[D - 1], bounds.max[D - 1]);
            let level = words.level.unwrap_or(f64::INFINITY).min(top);
            if level <= bottom {
                let what = format!("the level is not above {bottom} m, the bottom of this water");
                return Err(self.error_at(&format!("{key}.level"), what));
            }
            bodies.push(WaterBody {
                region: WaterRegion { shape, pose },
                bottom,
                level,
                flow: self.initial_flow(&key, words)?,
            });
        }
        Ok(bodies)
    }

    pub(super) fn build_model<const D: usize>(&self, water: &[WaterBody<D>]) -> Result<Model> {
        let (words, time) = (&self.model, &self.time);
        let gravity = self.gravity.clone().unwrap_or_else(|| vec![0.0; D]);
        let top = water.iter().map(|body| body.level).fold(f64::NEG_INFINITY, f64::max);
        let bottom = water.iter().map(|body| body.bottom).fold(f64::INFINITY, f64::min);
        let g = gravity.iter().map(|x| x * x).sum::<f64>().sqrt();
        let c0 = words.c0.unwrap_or(words.c0_factor.unwrap_or_default() * (g * (top - bottom)).sqrt());
        if !(c0.is_finite() && c0 > 0.0) {
            let help = "write  c0 = ...  in [model]: 10 to 20 times the largest speed expected, m/s";
            return Err(self.error_with_help("model.c0", "without gravity the depth gives no speed of sound", help));
        }
        let missing = |key: &str| self.error_at(key, "this law has no value");
        Ok(Model {
            kernel: words.kernel.ok_or_else(|| missing("model.kernel"))?,
            h: self.smoothing_length(),
            dp: self.dp,
            rho0: words.rho0.ok_or_else(|| missing("model.rho0"))?,
            c0,
            gamma: words.gamma.ok_or_else(|| missing("model.gamma"))?,
            gravity,
            gradient: words.gradient.ok_or_else(|| missing("model.gradient"))?,
            viscosity: words.viscosity.ok_or_else(|| missing("model.viscosity"))?,
            diffusion: words.diffusion.ok_or_else(|| missing("model.diffusion"))?,
            shifting: words.shifting.ok_or_else(|| missing("model.shifting"))?,
            walls: words.walls.ok_or_else(|| missing("model.walls"))?,
            slip: words.slip.ok_or_else(|| missing("model.slip"))?,
            pair_loop: words.sweep.unwrap_or_default(),
            scheme: time.scheme.ok_or_else(|| missing("time.scheme"))?,
            cfl: time.cfl.ok_or_else(|| missing("time.cfl"))?,
            dt_max: time.dt_max.unwrap_or(f64::INFINITY),
        })
    }

    /// Refuses water and bodies outside the domain.
    fn require_inside_domain<const D: usize>(
        &self,
        domain: &Bounds<D>,
        water: &[WaterBody<D>],
        solids: &[SolidSpec<D>],
    ) -> Result<()> {
        let out = |shape: &Shape<D>, pose: &Pose<D>| {
            let bounds = world_bounds(shape, pose);
            !(domain.contains(&bounds.min) && domain.contains(&bounds.max))
        };
        let help =
            "enlarge the domain: what leaves it stops the run. Leave [domain] out for one with room on all sides";
        if let Some(i) = water.iter().position(|body| out(&body.region.shape, &body.region.pose)) {
            return Err(self.error_with_help(
                &format!("water.{i}"),
                "this water is not wholly inside the domain",
                help,
            ));
        }
        let still = |solid: &SolidSpec<D>| matches!(solid.role, Role::Fixed);
        match solids.iter().position(|solid| !still(solid) && out(&solid.shape, &solid.pose)) {
            Some(i) => {
                let what = format!("solid \"{}\" starts outside the domain", solids[i].name);
                Err(self.error_with_help(&format!("solid.{i}.at"), what, help))
            }
            None => Ok(()),
        }
    }

    /// The error that no water is left: names the first free body that has no room in it.
    fn no_water_error<const D: usize>(&self, water: &[WaterBody<D>], solids: &[SolidSpec<D>]) -> Error {
        let boxes = water.iter().map(|body| world_bounds(&body.region.shape, &body.region.pose));
        let room = boxes.fold(Bounds::empty(), |a, b| a.union(&b)).size();
        let free = solids.iter().enumerate().filter(|(_, solid)| matches!(solid.role, Role::Free(_)));
        let mut sizes = free.map(|(i, solid)| (i, world_bounds(&solid.shape, &solid.pose).size()));
        let larger = |(i, size): (usize, Vector<D>)| Some((i, size, (0..D).find(|&axis| size[axis] >= room[axis])?));
        let Some((i, size, axis)) = sizes.find_map(larger) else {
            return self.error_at("water", "no water is left: it is thinner than dp, or solids fill it");
        };
        let way = if axis == D - 1 { "high" } else { ["long along x", "long along y"][axis] };
        let (name, size, room) = (&solids[i].name, size[axis], room[axis]);
        let what = format!("no water is left: \"{name}\" is {size:.4} m {way} and the water {room:.4} m");
        self.error_with_help(&format!("solid.{i}.shape"), what, "make it smaller, or the tank and its water larger")
    }

    /// Refuses laws that do not go together, and a kernel under which the lattice on which water starts gives way by its own
    /// pressure.
    fn require_stable_lattice<const D: usize>(&self, model: &Model) -> Result<()> {
        if let Some(what) = model.conflict() {
            let help = "write  kernel = \"wendland\"  and  shifting = \"none\", or  gradient = \"plain\"";
            return Err(self.error_with_help("model.gradient", what, help));
        }
        if model.gravity.iter().all(|g| *g == 0.0) {
            return Ok(());
        }
        let (h, stiffness) = (model.h / model.dp, model.lattice_stiffness::<D>());
        if stiffness > MIN_LATTICE_STIFFNESS {
            return Ok(());
        }
        let key = if self.model.c_h.is_some() { "model.c_h" } else { "model.h_over_dp" };
        let what = format!(
            "with this kernel at h = {h:.2} dp still water does not stay still: the lattice on which it starts gives way in shear \
             (its stiffness over its pressure is {stiffness:.3}, and {MIN_LATTICE_STIFFNESS} the least)"
        );
        Err(self.error_with_help(key, what, "write  h_over_dp = 1.7  and  kernel = \"wendland\""))
    }

    /// Refuses still water whose surface is so near its bed that no kernel is whole between them.
    fn require_depth(&self, still: &StillWaterLevel, model: &Model) -> Result<()> {
        let reach = model.support_radius();
        if model.gravity.last().is_none_or(|g| *g == 0.0) || still.depth > 0.999 * MIN_DEPTH_RATIO * reach {
            return Ok(());
        }
        let what = format!(
            "the water is {:.2} dp deep and the kernel reaches {:.2} dp: between bed and surface no sum is whole, and it would rise",
            still.depth / self.dp,
            reach / self.dp
        );
        let dp = still.depth * self.dp / (MIN_DEPTH_RATIO * reach);
        Err(self.error_with_help(
            "water",
            what,
            format!("{MIN_DEPTH_RATIO} of the reach is the least: write  dp = {dp:.2e}  or less"),
        ))
    }

    /// About how many particles of water and of skins there will be.
    pub(super) fn estimated_counts<const D: usize>(
        &self,
        water: &[WaterBody<D>],
        solids: &[SolidSpec<D>],
    ) -> (f64, f64) {
        let (volume, surface) = volume_and_surface(water, solids);
        let dimension = D as i32;
        (volume / self.dp.powi(dimension), surface * self.boundary_layers() as f64 / self.dp.powi(dimension - 1))
    }

    /// Refuses a scene that asks for more particles than a machine holds, before any is made.
    pub(super) fn require_affordable<const D: usize>(
        &self,
        water: &[WaterBody<D>],
        solids: &[SolidSpec<D>],
    ) -> Result<()> {
        self.require_near_origin(water)?;
        let (fluid, boundary) = self.estimated_counts(water, solids);
        let all = fluid + boundary;
        if all.is_finite() && all <= MOST_PARTICLES {
            return Ok(());
        }
        let (volume, surface) = volume_and_surface(water, solids);
        // Six digits say it: 0.3, not 0.30000000000000004.
        let volume = format!("{volume:.5e}").parse().unwrap_or(volume);
        let (space, face) = if D == 3 { ("m³", "m²") } else { ("m²", "m") };
        let what = format!(
            "the scene asks for {all:.1e} particles: {volume} {space} of water / dp{} + {surface:.3} {face} of solids × \
             {} layers / dp{}",
            ["²", "³"][D - 2],
            self.boundary_layers(),
            ["", "²"][D - 2],
        );
        let dp = 1.05 * self.dp * (all / MOST_PARTICLES).powf(1.0 / D as f64);
        let help = format!("the most is {MOST_PARTICLES:.0e}: write  dp = {dp:.1e}  or more");
        Err(self.error_with_help("dp", what, help))
    }

    /// What the run watches, keeps and judges, from a scene with its defaults filled in.
    fn resolved_plan(&self, still: &StillWaterLevel) -> Result<Plan> {
        let frames = match &self.frames {
            Some(FramesChoice::On(words)) => Some(FramesPlan {
                every: words.every.unwrap_or(self.until),
                fields: words.fields.clone().unwrap_or_default(),
                crop: words.corners.as_ref().map(|corners| [corners.min.clone(), corners.max.clone()]),
            }),
            _ => None,
        };
        Ok(Plan {
            title: self.title.clone().unwrap_or_default(),
            until: self.until,
            probes: self.probe.iter().filter_map(|probe| probe.to_plan(self.until)).collect(),
            contacts: self.probe.iter().filter_map(|probe| probe.to_contact_list(self.until)).collect(),
            frames,
            checkpoint_every: self.checkpoint.as_ref().and_then(|c| c.every),
            checkpoint_wall: self.checkpoint.as_ref().and_then(|c| c.wall).unwrap_or(CHECKPOINT_WALL),
            checks: self.check_plans()?,
            statistics: self.statistic_plans(still)?,
            folder: self.origin.folder.clone(),
        })
    }
}

/// Volume of the water (m³; m² in 2-D) and surface of the solids (m²; m).
fn volume_and_surface<const D: usize>(water: &[WaterBody<D>], solids: &[SolidSpec<D>]) -> (f64, f64) {
    let volume = water.iter().map(|body| body.region.shape.volume_properties().volume).sum();
    (volume, solids.iter().map(|solid| solid.shape.surface_area()).sum())
}

/// Moves every point by up to `by` (m) in each direction, always to the same place: by its number.
fn jitter<const D: usize>(points: &mut [Vector<D>], by: f64) {
    for (n, x) in (1u64..).zip(points.iter_mut().flat_map(|x| x.iter_mut())) {
        // The mixing of splitmix64 (Steele et al. 2014) makes a number of its place in a row.
        let mut z = n.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let part = ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64;
        *x += by * (2.0 * part - 1.0);
    }
}
