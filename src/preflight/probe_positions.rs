//! Checks that water can reach the place of each probe.

use super::{Finding, PreflightContext, SoundSpeed};
use crate::{
    geometry::world_bounds,
    math::{
        Bounds, Pose, Vector,
        format::{coordinates, three_digits},
    },
    probe::ProbeLocation,
    solid::Solid,
    system::symmetry::SymmetryPlane,
};

/// Height above its level that water can reach, over its depth, –: that of a dam break at a wall.
const SPLASH: f64 = 2.0;

/// A place (m) of a probe.
struct Place<'a, const D: usize> {
    probe: &'a str,
    at: &'a [f64],
    /// Name of the solid in whose frame it is given, if it is not the world.
    on: Option<&'a str>,
    /// Pose of this frame.
    frame: Pose<D>,
}

impl<const D: usize> Place<'_, D> {
    /// Describes a point (m) of the world in this frame.
    fn described(&self, x: &Vector<D>) -> String {
        self.named(self.frame.local(x).as_slice())
    }

    fn named(&self, at: &[f64]) -> String {
        let on = self.on.map_or(String::new(), |name| format!(" on \"{name}\""));
        format!("{} m{on}", coordinates(at))
    }

    /// Returns the point (m) of the world; a place with `D` − 1 coordinates has the height 0.
    fn point(&self) -> Vector<D> {
        self.frame.point(&Vector::from_fn(|i, _| self.at.get(i).copied().unwrap_or(0.0)))
    }
}

impl<const D: usize> PreflightContext<'_, D> {
    /// Adds findings about probes inside solids, outside all water and solids, or above the height that water can reach.
    pub(super) fn check_probes(&self, sound: &SoundSpeed, findings: &mut Vec<Finding>) {
        let solids = self.solids().iter().map(|s| world_bounds(&s.spec.shape, &s.kinematics.pose));
        let water = Bounds::around(self.system.fluid().r).grown(0.5 * self.dp());
        let all = &solids.fold(water, |a, b| a.union(&b));
        for probe in &self.plan.probes {
            let name = &probe.name;
            let frame_of =
                |on: &str| self.solids().iter().find(|own| own.spec.name == on).map(|own| own.kinematics.pose);
            let place = |at, on: Option<_>| Place {
                probe: name,
                at,
                on,
                frame: on.and_then(frame_of).unwrap_or_else(Pose::identity),
            };
            match probe.kind.location() {
                Some(ProbeLocation::Points(places, on)) => {
                    let in_world = places.iter().filter(|_| on.is_none());
                    findings.extend(in_world.filter_map(|at| self.beyond_the_water(name, at)));
                    let points = places.iter().filter(|at| at.len() == D);
                    findings.extend(points.filter_map(|at| self.point(&place(at, on), all, sound)));
                }
                Some(ProbeLocation::Columns(places, on)) => {
                    let in_world = places.iter().filter(|_| on.is_none());
                    findings.extend(in_world.filter_map(|at| self.beyond_the_water(name, at)));
                    let columns = places.iter().filter(|at| at.len() == D - 1);
                    findings.extend(columns.filter_map(|at| self.gauge(&place(at, on), all, sound)));
                }
                Some(ProbeLocation::Section([from, to])) if from.len() == D && to.len() == D => {
                    let ends = [from, to].map(|at| self.beyond_the_water(name, at));
                    if let [Some(finding), Some(_)] = ends {
                        findings.push(finding);
                    }
                    let ends = [from, to].map(|at| Vector::from_fn(|i, _| at[i]));
                    findings.extend(self.section(name, ends, all));
                }
                _ => {}
            }
        }
    }

    /// A place beyond a symmetry plane or a periodic side has no particles.
    fn beyond_the_water(&self, name: &str, at: &[f64]) -> Option<Finding> {
        self.beyond_plane(name, at).or_else(|| self.beyond_side(name, at))
    }

    /// A place beyond a symmetry plane has no particles: only one side is computed.
    fn beyond_plane(&self, name: &str, at: &[f64]) -> Option<Finding> {
        let depth = |(axis, plane): &(usize, SymmetryPlane)| at.get(*axis).map_or(0.0, |x| plane.depth(*x));
        let (axis, plane) = self.system.symmetry_planes().each().find(|own| depth(own) < -1e-9)?;
        let (letter, height) = (["x", "y", "z"][axis], three_digits(plane.at));
        let what = format!(
            "probe \"{name}\" at {} m is beyond the symmetry plane {letter} = {height} m, on the side that is not computed: no \
             water comes there",
            coordinates(at)
        );
        let mend = format!("measure at its mirror image, {letter} = {}", three_digits(2.0 * plane.at - at[axis]));
        Some(Finding::warning("probe_outside", what, mend))
    }

    /// A place beyond a periodic side has no particles: the water comes in again at the opposite side.
    fn beyond_side(&self, name: &str, at: &[f64]) -> Option<Finding> {
        let mut sides = self.system.periodic().iter().enumerate().filter_map(|(axis, sides)| Some((axis, (*sides)?)));
        let is_beyond =
            |(axis, [from, to]): &(usize, [f64; 2])| at.get(*axis).is_some_and(|x| *x < from - 1e-9 || *x > to + 1e-9);
        let (axis, [from, to]) = sides.find(is_beyond)?;
        let letter = ["x", "y", "z"][axis];
        let side = if at[axis] < from { from } else { to };
        let what = format!(
            "probe \"{name}\" at {} m is beyond the periodic side {letter} = {} m: no water comes there",
            coordinates(at),
            three_digits(side)
        );
        let inside = from + (at[axis] - from).rem_euclid(to - from);
        Some(Finding::warning("probe_outside", what, format!("measure at  {letter} = {}", three_digits(inside))))
    }

    /// A section needs a place on its line, in 3-D on its diagonal, that no solid covers.
    fn section(&self, name: &str, [from, to]: [Vector<D>; 2], all: &Bounds<D>) -> Option<Finding> {
        let steps = ((to - from).norm() / self.dp()).ceil().clamp(1.0, 10_000.0) as usize;
        let places = || (0..steps).map(|k| from + (to - from) * ((k as f64 + 0.5) / steps as f64));
        let outside = !places().any(|x| all.contains(&x));
        if !outside && places().any(|x| self.signed_distance(&x, |_| true) > 0.0) {
            return None;
        }
        let why = if outside { "is outside of everything" } else { "lies inside a solid" };
        let what = format!(
            "section \"{name}\" from {} to {} m {why}: no water goes through it",
            coordinates(&from),
            coordinates(&to)
        );
        let topic = if outside { "probe_outside" } else { "probe_inside_solid" };
        Some(Finding::warning(
            topic,
            what,
            self.nearest_water(&((from + to) * 0.5), |r| format!("{} m", coordinates(r))),
        ))
    }

    /// The height (m) above which no water is expected; infinite without gravity.
    fn highest(&self, sound: &SoundSpeed) -> f64 {
        if self.g == 0.0 {
            return f64::INFINITY;
        }
        self.still_water.level + SPLASH * self.still_water.depth + sound.fastest().powi(2) / (2.0 * self.g)
    }

    fn point(&self, own: &Place<D>, all: &Bounds<D>, sound: &SoundSpeed) -> Option<Finding> {
        let (x, name, place) = (own.point(), own.probe, own.named(own.at));
        let inside = |solid: &&Solid<D>| {
            // A probe may lie on a face.
            solid.distance(&x) < -1e-9
        };
        let nearest = || self.nearest_water(&x, |r| own.described(r));
        if let Some(solid) = self.solids().iter().find(inside) {
            let what = format!("probe \"{name}\" at {place} is inside solid \"{}\"", solid.spec.name);
            return Some(Finding::warning("probe_inside_solid", what, nearest()));
        }
        if !all.contains(&x) && x[D - 1] <= all.max[D - 1] {
            let what = format!("probe \"{name}\" at {place} is outside of everything: no water comes there");
            return Some(Finding::warning("probe_outside", what, nearest()));
        }
        let highest = self.highest(sound);
        (x[D - 1] > highest).then(|| {
            let what = format!(
                "probe \"{name}\" at {place} is {} m above the still level: no water comes there",
                three_digits(x[D - 1] - self.still_water.level)
            );
            let reach = format!("{}; water may come to {} m", nearest(), three_digits(highest));
            Finding::warning("probe_above", what, reach)
        })
    }

    /// A gauge needs a height between the lowest water and the highest at which there is no fixed solid. Where a solid fills the place
    /// at the level of the water, the gauge measures the water under that solid.
    fn gauge(&self, own: &Place<D>, all: &Bounds<D>, sound: &SoundSpeed) -> Option<Finding> {
        let (foot, name, place) = (own.point(), own.probe, own.named(own.at));
        let column = |z: f64| Vector::from_fn(|i, _| if i + 1 < D { foot[i] } else { z });
        let (low, high) = (all.min[D - 1], self.highest(sound).min(all.max[D - 1]));
        let outside = !all.contains(&column(low));
        let steps = ((high - low) / self.dp()).ceil().clamp(1.0, 10_000.0) as usize;
        let step = (high - low) / steps as f64;
        let free = |k: usize| self.signed_distance(&column(low + (k as f64 + 0.5) * step), |_| true) > -1e-9;
        let nearest = |level: f64| self.nearest_water(&column(level), |r| own.described(r));
        if outside || !(0..steps).any(free) {
            let why = if outside { "is outside of everything" } else { "stands inside a solid" };
            let what = format!("gauge \"{name}\" at {place} {why}: no water comes there");
            let topic = if outside { "probe_outside" } else { "probe_inside_solid" };
            return Some(Finding::warning(topic, what, nearest(self.still_water.level)));
        }
        let around = |water: &&Bounds<D>| (0..D - 1).all(|i| water.min[i] <= foot[i] && foot[i] <= water.max[i]);
        let level = self.open_water.iter().filter(around).map(|water| water.max[D - 1]).reduce(f64::max)?;
        let solid = self.solids().iter().find(|solid| solid.distance(&column(level)) < -1e-9)?;
        let beside = |r: &&Vector<D>| (0..D - 1).all(|i| (r[i] - foot[i]).abs() <= self.dp());
        let mut heights = self.system.fluid().r.iter().filter(beside).map(|r| r[D - 1]);
        // On a beach that is dry at the start, a gauge measures what runs up.
        if heights.clone().next().is_none() || heights.any(|height| height > level) {
            return None;
        }
        let what = format!(
            "gauge \"{name}\" at {place} stands in solid \"{}\" at the still level: it measures the water under that, which has \
             no free surface",
            solid.spec.name
        );
        Some(Finding::note("gauge_under_solid", what, nearest(level)))
    }

    /// Tells the place of the water nearest to `x` (m), as `described`.
    fn nearest_water(&self, x: &Vector<D>, described: impl Fn(&Vector<D>) -> String) -> String {
        let distance = |r: &&Vector<D>| (**r - x).norm_squared();
        let nearest = self.system.fluid().r.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        nearest.map_or_else(String::new, |r| format!("the nearest water is at {}", described(r)))
    }
}
