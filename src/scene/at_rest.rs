//! The rest of the bodies that start at their equilibrium: `afloat` lifts them in their given orientation; here they turn with all that is
//! tied to them, and move to where their ropes are taut.
//!
//! `statics::poses_at_rest` finds the stable rest beside the lifted bodies. The pull of mooring lines, the hollows in which bodies lie and
//! the solids on which they stand are those of a place, so the rest is found anew from each place until it no longer changes.

use super::{
    Scene,
    afloat::PlacedSolids,
    context::{Context, FileNote},
    section::{
        solid::SolidConfig,
        water::{StillWater, WaterBody},
    },
};
use crate::{
    geometry::{Shape, world_bounds},
    math::{Bounds, Pose, Vector, format::three_digits},
    solid::{
        Constraints, FreeBody, Kinematics, Role, RopeSpec, SolidSpec,
        decks::supports_of,
        mooring::end_stiffness_at_rest,
        statics::{MooredEnd, NO_WATER, StaticBody, StaticSystem, WaterAtRest, poses_at_rest},
    },
};

/// Most searches, each from the place that the last has found.
const PASSES: usize = 30;

/// Way of a body (dp) in a search below which its place no longer changes.
const CLOSE: f64 = 1e-6;

/// Distance (dp) from another solid below which a body touches it.
const TOUCH: f64 = 0.05;

/// Share of its length by which a rope may be slack and still counts as taut.
const TAUT: f64 = 1e-6;

/// Way (dp) of a body below which it stays where it is lifted.
const LEAST: f64 = 1e-3;

/// Turn (rad) below which a body does not turn.
const LEAST_TURN: f64 = 1e-6;

/// What surrounds the solids while they are brought to rest.
pub(super) struct RestState<'a, const D: usize> {
    pub(super) scene: &'a Scene,
    pub(super) ctx: &'a Context<'a>,
    pub(super) water: &'a [WaterBody<D>],
    pub(super) pool: &'a StillWater<D>,
    /// The constraints at the start, for the lifted solids, with a fixed joint for each body that stands on a deck.
    pub(super) constraints: &'a Constraints<D>,
    /// Pairs of a body and the deck on which it stands.
    pub(super) decks: &'a [[usize; 2]],
    /// Whether each solid lies in a dry hollow of another.
    pub(super) sheltered: &'a [bool],
}

/// Returns the poses of the lifted solids `placed` at rest: those in which they are lifted, where they need not turn or move, where they
/// touch others, or where no stable rest is near.
pub(super) fn rest_poses<const D: usize>(state: &RestState<D>, placed: &PlacedSolids<D>) -> Vec<Pose<D>> {
    let lifted: Vec<Pose<D>> = placed.specs.iter().map(|spec| spec.pose).collect();
    let (mut poses, dp) = (lifted.clone(), state.scene.dp);
    // Of each solid, the first of those that are tied to it and start at their equilibrium, and their way in the last search.
    let mut tied_to: Vec<Option<usize>> = vec![None; lifted.len()];
    let mut ways = vec![0.0; lifted.len()];
    let mut given_up = vec![false; lifted.len()];
    let follows = state.followers(&placed.specs);
    let given: Vec<Kinematics<D>> = placed.specs.iter().map(SolidSpec::initial_kinematics).collect();
    for _ in 0..PASSES {
        let found = state.search(placed, &given, &poses, (&given_up, &follows));
        ways.fill(0.0);
        for (tied, rest) in found {
            let first = tied[0];
            tied.iter().for_each(|i| tied_to[*i] = Some(first));
            match rest {
                Some(rest) => {
                    for (i, pose) in rest {
                        ways[first] = f64::max(ways[first], way(&placed.specs[i], &poses[i], &pose));
                        poses[i] = pose;
                    }
                }
                None => given_up[first] = true,
            }
        }
        if ways.iter().all(|way| *way <= CLOSE * dp) {
            break;
        }
    }
    for first in 0..lifted.len() {
        let tied = || (0..lifted.len()).filter(|i| tied_to[*i] == Some(first));
        let whole = tied().map(|i| way(&placed.specs[i], &lifted[i], &poses[i])).fold(0.0, f64::max);
        if given_up[first] || ways[first] > LEAST * dp || whole <= LEAST * dp {
            tied().for_each(|i| poses[i] = lifted[i]);
        }
    }
    for ((spec, lifted), pose) in placed.specs.iter().zip(&lifted).zip(&mut poses) {
        // A body that a rope pulls down does not turn by round-off.
        if (pose.rotation - lifted.rotation).amax() < LEAST_TURN {
            let centre = spec.initial_body().map_or_else(Vector::zeros, |body| body.centre);
            let position = pose.position + (pose.rotation - lifted.rotation) * centre;
            *pose = Pose { position, rotation: lifted.rotation };
        }
    }
    poses
}

/// Adds a note about each body that starts at rest away from its `lifted` pose.
pub(super) fn note_rest<const D: usize>(scene: &Scene, ctx: &Context, specs: &[SolidSpec<D>], lifted: &[Pose<D>]) {
    let has_moved = |i: &usize| way(&specs[*i], &lifted[*i], &specs[*i].pose) > LEAST * scene.dp;
    for i in (0..specs.len()).filter(has_moved) {
        let (spec, lifted) = (&specs[i], &lifted[i]);
        let turn = spec.pose.rotation * lifted.rotation.transpose();
        // In 3-D the angle is that of the vertical.
        let angle = match D {
            2 => turn[(1, 0)].atan2(turn[(0, 0)]),
            _ => turn[(D - 1, D - 1)].clamp(-1.0, 1.0).acos(),
        };
        let centre = spec.initial_body().map_or_else(Vector::zeros, |body| body.centre);
        let rise = (spec.pose.point(&centre) - lifted.point(&centre))[D - 1];
        let way = if rise < 0.0 { "lower" } else { "higher" };
        let turned = match angle.abs() > LEAST_TURN {
            true => format!("turned by {}°, ", three_digits(angle.to_degrees())),
            false => String::new(),
        };
        let what = format!(
            "\"{}\" starts at rest, {turned}its centre of mass {} m {way} than without that turn and taut ropes; \
             its horizontal place stays, also where a horizontal force makes it drift",
            spec.name,
            three_digits(rise.abs())
        );
        let (turn, height) = if D == 2 { ("angle_deg = 0.0", "y") } else { ("turn_deg = [0.0, 0.0, 0.0]", "z") };
        let remedy = match (scene.solid[i].is_afloat(), turned.is_empty()) {
            (true, false) => format!("write  {turn}  to keep it upright, or  {height}  in place of draft"),
            (true, true) => format!("write  {height}  in place of draft to keep another height"),
            (false, _) => "it is tied to a body with  draft = \"equilibrium\",  and moves with it".into(),
        };
        ctx.add_note(FileNote::note("turned_to_rest", what, remedy));
    }
}

/// Returns the largest way (m) of a corner of the box of a solid between two poses.
fn way<const D: usize>(spec: &SolidSpec<D>, from: &Pose<D>, to: &Pose<D>) -> f64 {
    spec.shape.bounds().corners().map(|x| (to.point(&x) - from.point(&x)).norm()).fold(0.0, f64::max)
}

/// Returns the corners, and the middles of the edges and sides, of the box around a shape that lie on its faces.
fn places_on_faces<const D: usize>(shape: &Shape<D>) -> Vec<Vector<D>> {
    let (Bounds { min, max }, size) = (shape.bounds(), shape.bounds().size().max());
    let place = |n: usize| {
        Vector::from_fn(|axis, _| {
            let part = (n / 3usize.pow(axis as u32) % 3) as f64 / 2.0;
            min[axis] + part * (max[axis] - min[axis])
        })
    };
    let places = (0..3usize.pow(D as u32)).map(place);
    places.filter(|x| shape.signed_distance(x).abs() < 1e-6 * size).collect()
}

/// Bodies that are tied together, and their poses at rest by the number of the solid, if there is such a rest.
type TiedRest<const D: usize> = (Vec<usize>, Option<Vec<(usize, Pose<D>)>>);

impl<const D: usize> RestState<'_, D> {
    /// Returns whether each solid moves to the rest: it starts at its equilibrium, or a joint, a deck or a rope that is taut where the bodies
    /// are lifted ties it to one that does. Other bodies keep the place that the scene gives, even on a slack rope or a spring.
    fn followers(&self, specs: &[SolidSpec<D>]) -> Vec<bool> {
        let is_taut = |rope: &&RopeSpec<D>| {
            let length = (rope.ends[1].at - rope.ends[0].at).norm();
            rope.max_length.is_none_or(|most| length >= most * (1.0 - TAUT))
        };
        let ropes = self.constraints.ropes.iter().filter(is_taut).map(|rope| rope.ends.each_ref().map(|end| end.solid));
        let ties = self.constraints.joints.iter().map(|joint| joint.between).chain(ropes);
        let is_free = |i: usize| matches!(specs[i].role, Role::Free(_));
        let pairs: Vec<[usize; 2]> = ties
            .filter_map(|ends| match ends {
                [Some(a), Some(b)] if is_free(a) && is_free(b) => Some([a, b]),
                _ => None,
            })
            .collect();
        let mut follows: Vec<bool> = self.scene.solid.iter().map(SolidConfig::is_afloat).collect();
        while let Some(pair) = pairs.iter().find(|[a, b]| follows[*a] != follows[*b]) {
            pair.iter().for_each(|i| follows[*i] = true);
        }
        follows
    }

    /// Returns the rest, beside the `poses`, of all bodies that start at their equilibrium, with all that is tied to them. The places of
    /// constraints are those for the solids `given`.
    fn search(
        &self,
        placed: &PlacedSolids<D>,
        given: &[Kinematics<D>],
        poses: &[Pose<D>],
        (given_up, follows): (&[bool], &[bool]),
    ) -> Vec<TiedRest<D>> {
        let at = |(spec, pose): (&SolidSpec<D>, &Pose<D>)| SolidSpec { pose: *pose, ..spec.clone() };
        let specs: Vec<SolidSpec<D>> = placed.specs.iter().zip(poses).map(at).collect();
        let now: Vec<Kinematics<D>> = specs.iter().map(SolidSpec::initial_kinematics).collect();
        let constraints = self.constraints.moved(given, &now);
        let specs: Vec<&SolidSpec<D>> = specs.iter().collect();
        let bodies: Vec<Option<FreeBody<D>>> = specs.iter().map(|spec| spec.initial_body()).collect();
        let water = WaterAtRest {
            rho0: self.ctx.rho0.unwrap_or_default(),
            g: self.ctx.initial_gravity_norm(),
            level: self.pool.still.level,
        };
        let body = |(i, body)| self.static_body(placed, i, (body, &poses[i]), (&specs, poses));
        let system = StaticSystem::new(
            bodies.iter().enumerate().filter_map(|(i, own)| Some(body((i, own.as_ref()?)))).collect(),
            &specs,
            &constraints,
            water,
        );
        let system = system.with_mooring_stiffness(moored_ends(&specs, &constraints, &water));
        let mut seen = vec![false; specs.len()];
        let mut found = Vec::new();
        for (number, body) in system.bodies.iter().enumerate() {
            if seen[body.solid] || !self.scene.solid[body.solid].is_afloat() {
                continue;
            }
            let tied: Vec<usize> = system.tied_to(number).iter().map(|j| system.bodies[*j].solid).collect();
            tied.iter().for_each(|i| seen[*i] = true);
            let rest = match given_up[tied[0]] {
                true => None,
                false if tied.iter().any(|i| self.touches(&specs, *i)) => None,
                false => {
                    let stays = |i: usize| self.scene.solid[i].is_afloat();
                    let keeps_turn = |i: usize, axis: usize| axis >= D && self.keeps_turn(specs[i], i, axis - D);
                    poses_at_rest(&system, number, &stays, &|i, axis| !follows[i] || keeps_turn(i, axis))
                }
            };
            found.push((tied, rest));
        }
        found
    }

    /// Returns free solid number `i` with its water and the height below which it cannot sink.
    fn static_body<'a>(
        &self,
        placed: &'a PlacedSolids<D>,
        i: usize,
        (body, pose): (&'a FreeBody<D>, &Pose<D>),
        (specs, poses): (&[&SolidSpec<D>], &[Pose<D>]),
    ) -> StaticBody<'a, D> {
        let floats = self.scene.solid[i].is_afloat() || placed.levels[i].is_some();
        let level = if floats && !self.sheltered[i] { placed.level(i) } else { NO_WATER };
        let hull = placed.hull_at(i, pose, placed.level(i), self.water);
        let low = hull.extent(pose)[0];
        let is_borne = supports_of(specs, poses, self.constraints, i, self.scene.dp).any(|j| {
            // A deck moves along.
            !self.decks.contains(&[i, j]) && !self.decks.contains(&[j, i])
        });
        let bed = self.pool.basin(&world_bounds(&placed.specs[i].shape, pose)).bottom();
        let bottom = if is_borne { low } else { low.min(bed) };
        StaticBody { solid: i, hull, body, pose: *pose, bottom, level }
    }

    /// Returns whether solid number `i` touches another one that is neither its deck nor on it: then contacts bear a part of its load.
    fn touches(&self, specs: &[&SolidSpec<D>], i: usize) -> bool {
        let reach = TOUCH * self.scene.dp;
        let meets = |a: &SolidSpec<D>, b: &SolidSpec<D>| {
            let pose = b.initial_kinematics().pose;
            let near = |x: Vector<D>| b.shape.signed_distance(&pose.local(&a.pose.point(&x))) < reach;
            places_on_faces(&a.shape).into_iter().any(near)
        };
        (0..specs.len()).any(|j| {
            j != i
                && self.constraints.can_touch(i, j)
                && !self.decks.iter().any(|pair| pair.contains(&i) && pair.contains(&j))
                && (meets(specs[i], specs[j]) || meets(specs[j], specs[i]))
        })
    }

    /// Returns whether solid number `i` keeps its turn about an axis: the scene gives its tilt, or a symmetry plane cuts it.
    fn keeps_turn(&self, spec: &SolidSpec<D>, i: usize, axis: usize) -> bool {
        let config = &self.scene.solid[i];
        let planes: [Option<f64>; D] = self.scene.symmetry.clone().unwrap_or_default().build();
        let bounds = world_bounds(&spec.shape, &spec.pose);
        let cuts = |(k, at): (usize, &Option<f64>)| {
            at.is_some_and(|at| bounds.min[k] < at && at < bounds.max[k]) && (D == 2 || axis != k)
        };
        (config.is_afloat() && config.gives_tilt()) || planes.iter().enumerate().any(cuts)
    }
}

/// Returns the ends of the mooring lines on free bodies, with their stiffness. A line in a mooring point has none of its own.
fn moored_ends<const D: usize>(
    specs: &[&SolidSpec<D>],
    constraints: &Constraints<D>,
    water: &WaterAtRest,
) -> Vec<MooredEnd<D>> {
    let is_free = |solid: usize| matches!(specs[solid].role, Role::Free(_));
    let ends = |spec| MooredEnd::of(spec, is_free, |k| end_stiffness_at_rest(spec, k, specs, water));
    constraints.moorings.iter().filter(|spec| !spec.is_joined()).flat_map(ends).collect()
}
