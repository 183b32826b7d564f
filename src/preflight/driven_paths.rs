//! Driven solids whose law takes them out of the scene, or moves them faster than sound, in the water and above it, and
//! those that start with a speed in water.

use super::{Finding, PreflightContext, wavemaker_site::is_wall};
use crate::{
    geometry::world_bounds,
    math::{Bounds, Vector, format::three_digits},
    solid::{PrescribedMotion, Role, Solid},
};

/// Number of times at which a driven solid is sampled.
const TIMES_SEEN: usize = 10_000;

/// Mean speed between two times, over the larger of the speeds at these times, above which the way between them is looked at.
const JUMP: f64 = 2.0;

/// Number of times that the interval of a jump is halved.
const HALVINGS: u32 = 20;

/// Speed against the water at the start over that of sound, above which the start is told: the pressure ρ c₀ V of the pulse is then a
/// fifth of that of the depth, ρ c₀²/100.
const SUDDEN: f64 = 0.002;

/// The correction of a law with such values.
const MEND: &str = "check the law near that time: its unit, and codes for missing values in a record";

/// Driven solids that go farther than the scene is large, or faster than sound.
pub(super) fn check<const D: usize>(context: &PreflightContext<'_, D>, findings: &mut Vec<Finding>) {
    let mut scene = Bounds::around(context.system.fluid().r);
    for solid in context.solids() {
        let own = world_bounds(&solid.spec.shape, &solid.kinematics.pose);
        scene = Bounds { min: scene.min.inf(&own.min), max: scene.max.sup(&own.max) };
    }
    let is_periodic = context.system.periodic().iter().any(Option::is_some);
    // A tank takes its water along, and periodic sides have no end.
    let size = |solid: &Solid<D>| {
        let endless = is_periodic || is_wall(&solid.spec.shape);
        if endless { f64::INFINITY } else { scene.size().norm() }
    };
    for (i, solid) in context.solids().iter().enumerate() {
        let Role::Driven(motion) = &solid.spec.role else { continue };
        if motion.wave().is_none() {
            let removals = context.system.constraints().removals.iter().filter(|removal| removal.solid == i);
            let end = removals.map(|removal| removal.at).fold(context.end_time(), f64::min);
            findings.extend(far_or_fast(context.system.model().c0, solid, motion, size(solid), end));
            findings.extend(sudden_start(context, i));
        }
    }
}

/// The largest mean speed (m/s) of a point that is `at` a place, and its time (s), in the halves of the `interval` (s) with the longer
/// way, and in their halves.
fn largest_mean_speed<const D: usize>(at: impl Fn(f64) -> Vector<D>, interval: [f64; 2]) -> (f64, f64) {
    let [mut from, mut to] = interval;
    let mut fastest = (0.0, from);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (from + to);
        let [first, second] = [[from, middle], [middle, to]].map(|[a, b]| (at(b) - at(a)).norm());
        let speed = first.max(second) / (0.5 * (to - from));
        [from, to] = if first > second { [from, middle] } else { [middle, to] };
        if speed > fastest.0 {
            fastest = (speed, from);
        }
    }
    fastest
}

/// A solid whose faces push the water at the start with a speed that it does not have.
fn sudden_start<const D: usize>(context: &PreflightContext<'_, D>, i: usize) -> Option<Finding> {
    let model = context.system.model();
    let solid = &context.solids()[i];
    let water = Bounds::around(context.system.fluid().r).grown(model.support_radius());
    if !world_bounds(&solid.spec.shape, &solid.kinematics.pose).meets(&water) {
        return None;
    }
    let speed = context.pushing_speed(i, 0.0, &mean(context.system.fluid().v));
    (speed > SUDDEN * model.c0).then(|| {
        let what = format!(
            "\"{}\" sets out at {} m/s against the water: a pressure of {} Pa at once",
            solid.spec.name,
            three_digits(speed),
            three_digits(model.rho0 * model.c0 * speed)
        );
        let mend =
            "write a law with the rate 0 at the start, as  0.05*(1-cos(2*pi*t)),  or give the water this velocity";
        Finding::note("sudden_start", what, mend.into())
    })
}

/// The mean of `vectors`; zero of none.
fn mean<const D: usize>(vectors: &[Vector<D>]) -> Vector<D> {
    vectors.iter().sum::<Vector<D>>() / vectors.len().max(1) as f64
}

/// A solid that goes farther from its start than `size` (m) until the time `end` (s), or faster than sound, `c0` (m/s).
fn far_or_fast<const D: usize>(
    c0: f64,
    solid: &Solid<D>,
    motion: &PrescribedMotion<D>,
    size: f64,
    end: f64,
) -> Option<Finding> {
    let start = world_bounds(&solid.spec.shape, &solid.kinematics.pose);
    let start = 0.5 * (start.min + start.max);
    let local = solid.kinematics.pose.local(&start);
    let place_and_speed = |t: f64| {
        let now = motion.kinematics(&solid.spec.pose, t);
        let x = now.pose.point(&local);
        (x, (now.velocity + now.spin.velocity_at(&(x - now.centre))).norm())
    };
    let place = |t: f64| place_and_speed(t).0;
    let (mut farthest, mut fastest) = ((0.0, 0.0), (0.0, 0.0));
    let mut before = (0.0, place_and_speed(0.0));
    for t in (0..=TIMES_SEEN).map(|k| end * k as f64 / TIMES_SEEN as f64) {
        let (x, speed) = place_and_speed(t);
        let way = (x - start).norm();
        if way > farthest.0 {
            farthest = (way, t);
        }
        let (earlier, (old, old_speed)) = before;
        let mean = (x - old).norm() / (t - earlier);
        // If the speeds do not explain the way, the solid jumps between the two times.
        let own = if mean > JUMP * speed.max(old_speed) { largest_mean_speed(place, [earlier, t]) } else { (speed, t) };
        if own.0 > fastest.0 {
            fastest = own;
        }
        before = (t, (x, speed));
    }
    let name = &solid.spec.name;
    let what = match (farthest, fastest) {
        ((way, t), _) if way > size => format!(
            "the law of \"{name}\" takes it {} m away from its start at {} s, and the scene is {} m large",
            three_digits(way),
            three_digits(t),
            three_digits(size)
        ),
        (_, (speed, t)) if speed > c0 => format!(
            "the law of \"{name}\" moves it at {} m/s at {} s, and sound goes at {} m/s",
            three_digits(speed),
            three_digits(t),
            three_digits(c0)
        ),
        _ => return None,
    };
    Some(Finding::warning("far_or_fast_law", what, MEND.into()))
}
