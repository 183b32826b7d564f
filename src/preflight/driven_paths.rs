//! Driven solids whose law takes them out of the scene, or moves them faster than sound, in the water and above it.

use super::{Finding, PreflightContext, wavemaker_site::is_wall};
use crate::{
    math::{Bounds, format::three_digits},
    scene::world_bounds,
    solid::{PrescribedMotion, Role, Solid},
};

/// Number of times at which a driven solid is sampled.
const TIMES_SEEN: usize = 10_000;

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
        }
    }
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
    let (mut farthest, mut fastest) = ((0.0, 0.0), (0.0, 0.0));
    for k in 0..=TIMES_SEEN {
        let t = end * k as f64 / TIMES_SEEN as f64;
        let now = motion.kinematics(&solid.spec.pose, t);
        let x = now.pose.point(&local);
        let (way, speed) = ((x - start).norm(), (now.velocity + now.spin.velocity_at(&(x - now.centre))).norm());
        if way > farthest.0 {
            farthest = (way, t);
        }
        if speed > fastest.0 {
            fastest = (speed, t);
        }
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
