//! The solids of a scene in their places: bodies that start at their equilibrium, and hollows that start dry.

use super::{
    Scene,
    at_rest::{RestState, note_rest, rest_poses},
    constraints::build_constraints,
    context::{Context, FileNote},
    section::{
        solid::SolidConfig,
        water::{StillWater, WaterBody},
    },
};
use crate::{
    error::{Error, Result},
    geometry::{
        fill::EnclosedSpace,
        hollow::{Enclosure, Hollow, may_enclose},
        world_bounds,
    },
    math::{Pose, Vector},
    solid::{
        Constraints, Kinematics, SolidSpec,
        constraint::links::check_rope_reach,
        decks::{deck_of, may_stand, standing_joint},
        hydrostatics::{HollowWater, Hull},
        mooring::forces_at_rest,
        statics::WaterAtRest,
        tie_loads::{StartState, TieLoads},
    },
};

/// Most repetitions of the search for the places of bodies, one of which may lie in a hollow of another.
const SHELTER_PASSES: usize = 4;

/// The solids of a scene, in their places.
pub(super) struct PlacedSolids<const D: usize> {
    pub(super) specs: Vec<SolidSpec<D>>,
    /// The space that each solid encloses in its place.
    pub(super) enclosures: Vec<Option<Enclosure<D>>>,
    /// The still level (m) at the place of each solid; `None` beside all water.
    pub(super) levels: Vec<Option<f64>>,
    /// The highest level, m.
    highest: f64,
    /// The solids where the scene gives their constraints: before they turned to rest.
    given: Vec<Kinematics<D>>,
}

/// Returns the solids in their places in `water`. If `all` is true, or a body starts at its equilibrium, the result includes
/// the space that each solid encloses.
pub(super) fn placed_solids<const D: usize>(
    scene: &Scene,
    ctx: &Context,
    water: &[WaterBody<D>],
    all: bool,
) -> Result<PlacedSolids<D>> {
    let pool = StillWater::of(water);
    let configs = scene.solid.iter().enumerate();
    let specs: Vec<SolidSpec<D>> =
        configs.map(|(i, solid)| solid.build(ctx, &format!("solid.{i}"), &pool)).collect::<Result<_>>()?;
    let levels = specs.iter().map(|spec| pool.level_at(&world_bounds(&spec.shape, &spec.pose))).collect();
    let floats = scene.solid.iter().any(SolidConfig::is_afloat);
    let (highest, given) = (pool.still.level, Vec::new());
    let mut placed = PlacedSolids { specs, enclosures: Vec::new(), levels, highest, given };
    let enclosed = |(i, spec): (usize, &SolidSpec<D>)| -> Result<Option<Enclosure<D>>> {
        let named = water.iter().any(|body| body.inside == Some(i));
        let found = if all || floats { enclosure(spec, named, &pool, scene.dp) } else { None };
        if all && found.is_none() && (scene.solid[i].dry == Some(true) || named) {
            let key = if named { "water" } else { &format!("solid.{i}.dry") };
            let what = format!("\"{}\" encloses no space that could be dry or hold water", spec.name);
            let help = "a hull encloses space below its rim, two dp deep or more, as it is placed";
            return Err(ctx.error_with_help(key, what, help));
        }
        Ok(found)
    };
    placed.enclosures = placed.specs.iter().enumerate().map(enclosed).collect::<Result<_>>()?;
    if !floats {
        placed.given = placed.specs.iter().map(SolidSpec::initial_kinematics).collect();
        return Ok(placed);
    }
    note_gravity(ctx);
    let poses = float_bodies(scene, ctx, &mut placed, water, &pool)?;
    placed.given = placed.specs.iter().map(SolidSpec::initial_kinematics).collect();
    let lifted: Vec<Pose<D>> = placed.specs.iter().map(|spec| spec.pose).collect();
    for (i, pose) in poses.into_iter().enumerate().filter(|(i, pose)| *pose != lifted[*i]) {
        placed.specs[i].pose = pose;
        placed.enclosures[i] = enclosed((i, &placed.specs[i]))?;
    }
    note_rest(scene, ctx, &placed.specs, &lifted);
    Ok(placed)
}

/// Adds the warning for bodies that start at their equilibrium, if gravity does not point downwards.
fn note_gravity(ctx: &Context) {
    let Some(gravity) = ctx.gravity.as_ref().filter(|gravity| gravity.strongest > 0.0) else { return };
    let strength = gravity.initial.iter().map(|g| g * g).sum::<f64>().sqrt();
    if gravity.initial.last().is_some_and(|g| -g > 0.9 * strength) {
        return;
    }
    ctx.add_note(FileNote::warning(
        "gravity_direction",
        format!(
            "gravity is {:?} m/s² at the start, and draft = \"equilibrium\" is that of a gravity downwards",
            gravity.initial
        ),
        "point it along the last axis, downwards, or give the heights of the bodies".into(),
    ));
}

/// Lifts the bodies that start at their equilibrium, and returns the poses of all solids at rest. They carry their constraints in the
/// state at the start: springs, steady forces, and bodies at given heights that are joined to them, hang on taut ropes or stand on their
/// decks. What lies in a dry hollow of another body displaces no water; the hollow is known in its place only, so the places are found
/// again with it.
fn float_bodies<const D: usize>(
    scene: &Scene,
    ctx: &Context,
    placed: &mut PlacedSolids<D>,
    water: &[WaterBody<D>],
    pool: &StillWater<D>,
) -> Result<Vec<Pose<D>>> {
    let mut constraints = build_constraints(scene, ctx, &placed.specs, &placed.levels)?.at_start();
    let find = |sheltered: &[bool]| laden_rises(scene, ctx, placed, (water, pool), (&constraints, sheltered));
    let mut sheltered = vec![false; placed.specs.len()];
    let (mut rises, mut decks) = find(&sheltered)?;
    for _ in 0..SHELTER_PASSES {
        let found: Vec<bool> = (0..rises.len()).map(|i| placed.is_sheltered(i, &rises, water)).collect();
        if found == sheltered {
            break;
        }
        sheltered = found;
        (rises, decks) = find(&sheltered)?;
    }
    for (spec, rise) in placed.specs.iter_mut().zip(rises) {
        spec.pose.position[D - 1] += rise;
    }
    let specs: Vec<&SolidSpec<D>> = placed.specs.iter().collect();
    constraints.joints.extend(decks.iter().map(|pair| standing_joint(&specs, *pair)));
    let (constraints, decks, sheltered) = (&constraints, &decks[..], &sheltered[..]);
    Ok(rest_poses(&RestState { scene, ctx, water, pool, constraints, decks, sheltered }, placed))
}

/// Returns the rise (m) of each body to its equilibrium with the bodies at given heights that stand on its deck there, and pairs of these
/// bodies and their decks.
fn laden_rises<const D: usize>(
    scene: &Scene,
    ctx: &Context,
    placed: &PlacedSolids<D>,
    (water, pool): (&[WaterBody<D>], &StillWater<D>),
    (constraints, sheltered): (&Constraints<D>, &[bool]),
) -> Result<(Vec<f64>, Vec<[usize; 2]>)> {
    let specs: Vec<&SolidSpec<D>> = placed.specs.iter().collect();
    let height = |i: usize| world_bounds(&specs[i].shape, &specs[i].pose).min[D - 1];
    let rho0 = ctx.rho0.unwrap_or_default();
    let mut loose: Vec<usize> = (0..specs.len())
        .filter(|i| !scene.solid[*i].is_afloat() && may_stand(specs[*i], *i, constraints))
        .filter(|i| sheltered[*i] || placed.displaced_mass(*i, rho0, water) <= 0.0)
        .collect();
    loose.sort_by(|i, j| height(*i).total_cmp(&height(*j)));
    let mut decks = placed.possible_decks(scene, &specs, constraints, &loose);
    // Of the bodies that do not stand there, the highest falls: without it the deck is higher.
    while !decks.is_empty() {
        let mut laden = constraints.clone();
        laden.joints.extend(decks.iter().map(|pair| standing_joint(&specs, *pair)));
        let found = equilibrium_rises(scene, ctx, placed, (water, pool), (&laden, sheltered));
        let stands = |rises: &Vec<f64>, [upper, deck]: [usize; 2]| {
            deck_of(&specs, &placed.risen(rises), constraints, upper, scene.dp) == Some(deck)
        };
        let falls = match &found {
            Ok(rises) => decks.iter().rposition(|pair| !stands(rises, *pair)),
            Err(_) => Some(decks.len() - 1),
        };
        let Some(falls) = falls else { return Ok((found?, decks)) };
        decks.remove(falls);
    }
    Ok((equilibrium_rises(scene, ctx, placed, (water, pool), (constraints, sheltered))?, decks))
}

/// Returns the rise (m) of each body to its equilibrium; 0 for one at a given height. `sheltered` tells which lie in dry hollows.
fn equilibrium_rises<const D: usize>(
    scene: &Scene,
    ctx: &Context,
    placed: &PlacedSolids<D>,
    (water, pool): (&[WaterBody<D>], &StillWater<D>),
    (constraints, sheltered): (&Constraints<D>, &[bool]),
) -> Result<Vec<f64>> {
    let (rho0, level) = (ctx.rho0.unwrap_or_default(), pool.still.level);
    let specs: Vec<&SolidSpec<D>> = placed.specs.iter().collect();
    let afloat: Vec<bool> = scene.solid.iter().map(SolidConfig::is_afloat).collect();
    let g = ctx.initial_gravity_norm();
    let mut pulls = vec![Vector::zeros(); specs.len()];
    let lines = (&constraints.moorings[..], &constraints.mooring_points[..]);
    let at_rest = forces_at_rest(lines, &specs, &WaterAtRest { rho0, g, level });
    for (spec, forces) in constraints.moorings.iter().zip(at_rest) {
        let ends = spec.ends.iter().zip(forces);
        ends.for_each(|(end, force)| end.solid.into_iter().for_each(|i| pulls[i] -= force / g));
    }
    let state = StartState {
        specs: &specs,
        afloat: &afloat,
        displaced: &|i| if sheltered[i] { 0.0 } else { placed.displaced_mass(i, rho0, water) },
        above_bottom: &|i| {
            let own = world_bounds(&specs[i].shape, &specs[i].pose);
            own.min[D - 1] - pool.basin(&own).bottom() - 0.5 * scene.dp
        },
        moored: &|i| pulls[i],
        g,
    };
    let loads = TieLoads::at_start(&state, constraints);
    let rise = |i: usize, mass: f64, others: &[usize]| {
        let alone = |e: Error| match others.iter().find(|other| **other != i) {
            Some(other) => {
                let what =
                    format!("{}; \"{}\", to which it is tied, does not change that", e.message, specs[*other].name);
                let help = "each body of an assembly finds its equilibrium alone first; give the heights of this one";
                Error { message: what, ..e }.help(help)
            }
            None => e,
        };
        placed
            .rise_to_equilibrium(i, mass, rho0, water)
            .map_err(|e| ctx.with_location(alone(loads.explain(i, e)), &format!("solid.{i}.at.draft")))
    };
    let mut rises = vec![0.0; specs.len()];
    for group in loads.groups() {
        let own: Vec<usize> = group.iter().copied().filter(|i| afloat[*i]).collect();
        for &i in &own {
            let Some(body) = specs[i].initial_body() else { continue };
            // A single body carries all loads; several bodies first carry their own loads, and then the rest together.
            let carried = if own.len() == 1 { loads.of_group(i) } else { 0.0 } + loads.on(i);
            rises[i] = rise(i, body.mass + carried, &own)?;
        }
        let left = own.first().map_or(0.0, |i| loads.of_group(*i));
        if own.len() > 1 && left != 0.0 {
            let more = placed.common_rise(&own, &rises, left, rho0, water);
            let error = || {
                let what =
                    format!("the bodies that are tied to \"{}\" are too heavy for it to float", specs[own[0]].name);
                ctx.error_with_help(&format!("solid.{}.at.draft", own[0]), what, "make them lighter, or give heights")
            };
            let more = more.ok_or_else(error)?;
            own.iter().for_each(|i| rises[*i] += more);
        }
    }
    Ok(rises)
}

/// Returns the space that a solid encloses, if it can matter; `named`: whether a body of water names the solid.
fn enclosure<const D: usize>(spec: &SolidSpec<D>, named: bool, pool: &StillWater<D>, dp: f64) -> Option<Enclosure<D>> {
    let open = named || spec.may_be_hull(&pool.bounds);
    may_enclose(&spec.shape, open).then(|| Enclosure::of(&spec.shape, &spec.initial_kinematics().pose.rotation, dp))?
}

/// Returns whether the region of `body` reaches below its level into a hollow of a solid at `pose`.
fn enters<const D: usize>(hollow: &Hollow<D>, pose: &Pose<D>, body: &WaterBody<D>) -> bool {
    hollow.middles_below(pose, body.level).any(|x| body.contains(&x))
}

impl<const D: usize> PlacedSolids<D> {
    /// Returns the same constraints, which the scene gives for the solids before they turned to rest, between the solids at rest.
    ///
    /// # Errors
    /// `Scene` if a rope is shorter than the distance of its ends there.
    pub(super) fn moved(&self, ctx: &Context, constraints: Constraints<D>) -> Result<Constraints<D>> {
        let now: Vec<Kinematics<D>> = self.specs.iter().map(SolidSpec::initial_kinematics).collect();
        let has_moved = self.given.iter().zip(&now).any(|(given, now)| given.pose != now.pose);
        let made = if has_moved { constraints.moved(&self.given, &now) } else { constraints };
        for (i, rope) in made.ropes.iter().enumerate() {
            check_rope_reach(rope).map_err(|e| ctx.with_location(e, &format!("rope.{i}")))?;
        }
        Ok(made)
    }

    /// Returns the level (m) from which the draft of solid number `i` is measured.
    pub(super) fn level(&self, i: usize) -> f64 {
        self.levels[i].unwrap_or(self.highest)
    }

    /// Returns whether solid number `i` at `pose` keeps water that surrounds it out of a hollow. So it does, if the scene does not say,
    /// for a closed hollow and for one with water of its own.
    fn keeps_out(&self, i: usize, hollow: &Hollow<D>, pose: &Pose<D>, water: &[WaterBody<D>]) -> bool {
        let own = |body: &WaterBody<D>| body.inside == Some(i) && enters(hollow, pose, body);
        self.specs[i].dry.unwrap_or_else(|| hollow.is_closed() || water.iter().any(own))
    }

    /// Returns the rise (m) of solid number `i` to its equilibrium as a body of `mass` (kg), in water of density `rho0` (kg/m³).
    /// A hollow is dry if it stays dry in that place and no body of water fills it.
    fn rise_to_equilibrium(&self, i: usize, mass: f64, rho0: f64, water: &[WaterBody<D>]) -> Result<f64> {
        let (spec, level) = (&self.specs[i], self.level(i));
        let hollows = self.enclosures[i].as_ref().map_or(&[][..], |enclosure| &enclosure.hollows);
        let mut hull = Hull { dry: hollows.iter().collect(), ..Hull::new(&spec.shape) };
        // Each pass returns, or takes a hollow out of the dry ones.
        loop {
            let rise = hull.equilibrium_height(&spec.pose, mass, rho0, level);
            match &rise {
                Ok(rise) => {
                    let mut pose = spec.pose;
                    pose.position[D - 1] += rise;
                    let next = self.hull_at(i, &pose, level, water);
                    let filled = |own: &Hollow<D>| next.dry.iter().all(|hollow| !std::ptr::eq(*hollow, own));
                    if !hull.dry.iter().any(|hollow| filled(hollow)) {
                        return Ok(*rise);
                    }
                    // A hollow that fills in one place stays full.
                    let dry = |hollow: &&Hollow<D>| hull.dry.iter().any(|own| std::ptr::eq(*own, *hollow));
                    hull = Hull { dry: next.dry.into_iter().filter(dry).collect(), ..next };
                }
                // Without the hollow that floods first.
                Err(_) => {
                    let (rim, before) = (hull.rim_height(&spec.pose), hull.dry.len());
                    hull.dry.retain(|hollow| {
                        self.keeps_out(i, hollow, &spec.pose, water) || hollow.rim_height(&spec.pose) > rim
                    });
                    if hull.dry.len() == before {
                        return rise;
                    }
                }
            }
        }
    }

    /// Returns solid number `i` at `pose` in `water`, whose still level outside is `level` (m), with its hollows.
    pub(super) fn hull_at(&self, i: usize, pose: &Pose<D>, level: f64, water: &[WaterBody<D>]) -> Hull<'_, D> {
        let mut hull = Hull::new(&self.specs[i].shape);
        for hollow in self.enclosures[i].as_ref().map_or(&[][..], |enclosure| &enclosure.hollows) {
            match self.level_in(i, hollow, pose, water) {
                None => hull.dry.push(hollow),
                // Water as high as outside carries nothing.
                Some(own) if own == level => (),
                Some(own) => hull.filled.push((hollow, HollowWater::Level(own))),
            }
        }
        hull
    }

    /// Returns the mass (kg) of the water that solid number `i` displaces where it is.
    fn displaced_mass(&self, i: usize, rho0: f64, water: &[WaterBody<D>]) -> f64 {
        let (pose, level) = (&self.specs[i].pose, self.level(i));
        rho0 * self.hull_at(i, pose, level, water).submerged_volume(pose, level).0
    }

    /// Returns the poses of the solids that have risen by `rises` (m).
    fn risen(&self, rises: &[f64]) -> Vec<Pose<D>> {
        let pose = |(spec, rise): (&SolidSpec<D>, &f64)| {
            let mut pose = spec.initial_kinematics().pose;
            pose.position[D - 1] += rise;
            pose
        };
        self.specs.iter().zip(rises).map(pose).collect()
    }

    /// Returns pairs of a body of `loose` and a body on which it may stand: the one at a given height under it, or the only one at
    /// its equilibrium above or below it.
    fn possible_decks(
        &self,
        scene: &Scene,
        specs: &[&SolidSpec<D>],
        constraints: &Constraints<D>,
        loose: &[usize],
    ) -> Vec<[usize; 2]> {
        let bounds: Vec<_> = specs.iter().map(|spec| world_bounds(&spec.shape, &spec.pose)).collect();
        let poses = self.risen(&vec![0.0; specs.len()]);
        let over = |i: usize, j: usize| {
            let (a, b) = (&bounds[i], &bounds[j]);
            (0..D - 1).all(|axis| a.min[axis] < b.max[axis] && a.max[axis] > b.min[axis])
        };
        let deck = |i: usize| {
            let given = deck_of(specs, &poses, constraints, i, scene.dp).filter(|j| loose.contains(j));
            let mut afloat = (0..specs.len()).filter(|j| scene.solid[*j].is_afloat() && over(i, *j));
            given.or_else(|| afloat.next().filter(|_| afloat.next().is_none()))
        };
        loose.iter().filter_map(|i| Some([*i, deck(*i)?])).collect()
    }

    /// Returns the common rise (m) of these bodies from the places `rises` (m) at which they displace the additional mass `more`
    /// (kg); `None` if they cannot.
    fn common_rise(
        &self,
        bodies: &[usize],
        rises: &[f64],
        more: f64,
        rho0: f64,
        water: &[WaterBody<D>],
    ) -> Option<f64> {
        let size = bodies.iter().map(|i| self.specs[*i].shape.bounds().size().norm()).fold(0.0, f64::max);
        let displaced = |rise: f64| -> f64 {
            let one = |i: &usize| {
                let (mut pose, level) = (self.specs[*i].pose, self.level(*i));
                pose.position[D - 1] += rises[*i] + rise;
                self.hull_at(*i, &pose, level, water).submerged_volume(&pose, level).0
            };
            rho0 * bodies.iter().map(one).sum::<f64>()
        };
        let wanted = displaced(0.0) + more;
        let (mut under, mut over) = (-size, size);
        if displaced(under) < wanted || displaced(over) > wanted {
            return None;
        }
        for _ in 0..60 {
            let middle = 0.5 * (under + over);
            if displaced(middle) > wanted { under = middle } else { over = middle }
        }
        Some(0.5 * (under + over))
    }

    /// Returns whether solid number `i` lies between the sides of another one with its middle in a hollow that is dry, if the solids
    /// have risen by `rises` (m).
    fn is_sheltered(&self, i: usize, rises: &[f64], water: &[WaterBody<D>]) -> bool {
        let poses = self.risen(rises);
        let own = world_bounds(&self.specs[i].shape, &poses[i]);
        (0..self.specs.len()).filter(|j| *j != i).any(|j| {
            let (shape, pose) = (&self.specs[j].shape, poses[j]);
            let Some(around) = &self.enclosures[j] else { return false };
            let Some(number) = around.number_around(shape, &pose, &own) else { return false };
            let (hollow, hull) = (&around.hollows[number], self.hull_at(j, &pose, self.level(j), water));
            hollow.rim_height(&pose) > self.level(j) && hull.dry.iter().any(|dry| std::ptr::eq(*dry, hollow))
        })
    }

    /// Returns the level (m) of the water that fills a hollow of solid number `i` at `pose`; `None` if it is dry.
    fn level_in(&self, i: usize, hollow: &Hollow<D>, pose: &Pose<D>, water: &[WaterBody<D>]) -> Option<f64> {
        let spec = &self.specs[i];
        let fills = |body: &&WaterBody<D>| {
            let may_enter = match body.inside {
                Some(solid) => solid == i,
                None => {
                    let (own, other) = (spec.shape.bounds_at(pose), body.bounds_below_level());
                    !self.keeps_out(i, hollow, pose, water) || (own.contains(&other.min) && own.contains(&other.max))
                }
            };
            may_enter && enters(hollow, pose, body)
        };
        water.iter().filter(fills).map(|body| body.level).reduce(f64::max)
    }

    /// Returns the enclosed spaces for a filling around the solids at `poses`.
    pub(super) fn spaces<'a>(&'a self, poses: &'a [Pose<D>], water: &[WaterBody<D>]) -> Vec<EnclosedSpace<'a, D>> {
        let all = self.specs.iter().zip(poses).zip(&self.enclosures).enumerate();
        let space = |(solid, ((spec, pose), enclosure)): (usize, ((&'a SolidSpec<D>, &'a Pose<D>), &'a Option<_>))| {
            let enclosure: &Enclosure<D> = enclosure.as_ref()?;
            let keeps_out = |hollow| self.keeps_out(solid, hollow, pose, water);
            let keeps_out = enclosure.hollows.iter().map(keeps_out).collect();
            Some(EnclosedSpace { solid, shape: &spec.shape, pose, enclosure, keeps_out })
        };
        all.filter_map(space).collect()
    }
}
