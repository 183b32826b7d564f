//! Checks that water can reach the place of each probe.

use super::{Finding, PreflightContext, SoundSpeed};
use crate::{
    math::{
        Bounds, Pose, Vector,
        format::{coordinates, three_digits},
    },
    probe::ProbeLocation,
    scene::world_bounds,
    solid::Solid,
    system::symmetry::SymmetryPlane,
};

/// Height above its level that water can reach, over its depth, –: that of a dam break at a wall.
const SPLASH: f64 = 2.0;

/// The frame of the place of a probe: that of the solid that carries it, else the world.
#[derive(Clone, Copy)]
struct Frame<'a, const D: usize> {
    pose: Pose<D>,
    /// Name of the solid.
    on: Option<&'a str>,
}

impl<const D: usize> Frame<'_, D> {
    fn world() -> Self {
        Self { pose: Pose::identity(), on: None }
    }

    /// Describes a place in this frame.
    fn place(&self, at: &[f64]) -> String {
        let on = self.on.map_or(String::new(), |name| format!(" on \"{name}\""));
        format!("at {} m{on}", coordinates(at))
    }

    /// Returns the world point (m) of a place (m) with `D` coordinates, or with `D` − 1 and the height 0.
    fn point(&self, at: &[f64]) -> Vector<D> {
        self.pose.point(&Vector::from_fn(|i, _| at.get(i).copied().unwrap_or(0.0)))
    }
}

impl<const D: usize> PreflightContext<'_, D> {
    /// Adds findings about probes inside solids, outside all water and solids, or above the height that water can reach.
    pub(super) fn check_probes(&self, sound: &SoundSpeed, findings: &mut Vec<Finding>) {
        let solids = self.solids().iter().map(|s| world_bounds(&s.spec.shape, &s.kinematics.pose));
        let all = &solids.fold(Bounds::around(self.system.fluid().r), |a, b| a.union(&b));
        for probe in &self.plan.probes {
            let name = &probe.name;
            let on = |on| self.solids().iter().find(|solid| solid.spec.name == on);
            let on =
                |name| on(name).map_or_else(Frame::world, |own| Frame { pose: own.kinematics.pose, on: Some(name) });
            match probe.kind.location() {
                Some(ProbeLocation::Points(places)) => {
                    findings.extend(places.iter().filter_map(|at| self.beyond_plane(name, at)));
                    let points = places.iter().filter(|at| at.len() == D);
                    findings.extend(points.filter_map(|at| self.point(name, at, &Frame::world(), (all, sound))));
                }
                Some(ProbeLocation::PointsOn(places, solid)) => {
                    let points = places.iter().filter(|at| at.len() == D);
                    findings.extend(points.filter_map(|at| self.point(name, at, &on(solid), (all, sound))));
                }
                Some(ProbeLocation::Columns(places)) => {
                    findings.extend(places.iter().filter_map(|at| self.beyond_plane(name, at)));
                    let places = places.iter().filter(|at| at.len() == D - 1);
                    findings.extend(places.filter_map(|at| self.gauge(name, at, &Frame::world(), (all, sound))));
                }
                Some(ProbeLocation::ColumnsOn(places, solid)) => {
                    let places = places.iter().filter(|at| at.len() == D - 1);
                    findings.extend(places.filter_map(|at| self.gauge(name, at, &on(solid), (all, sound))));
                }
                Some(ProbeLocation::Section([from, to])) if from.len() == D && to.len() == D => {
                    findings.extend([from, to].into_iter().find_map(|at| self.beyond_plane(&probe.name, at)));
                    let ends = [from, to].map(|at| Vector::from_fn(|i, _| at[i]));
                    findings.extend(self.section(&probe.name, ends, all));
                }
                _ => {}
            }
        }
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
        Some(Finding::warning(topic, what, self.nearest_water(&((from + to) * 0.5), &Frame::world())))
    }

    /// The height (m) above which no water is expected; infinite without gravity.
    fn highest(&self, sound: &SoundSpeed) -> f64 {
        if self.g == 0.0 {
            return f64::INFINITY;
        }
        self.still_water.level + SPLASH * self.still_water.depth + sound.fastest().powi(2) / (2.0 * self.g)
    }

    fn point(
        &self,
        name: &str,
        at: &[f64],
        frame: &Frame<D>,
        (all, sound): (&Bounds<D>, &SoundSpeed),
    ) -> Option<Finding> {
        let (x, place) = (frame.point(at), frame.place(at));
        let inside = |solid: &&Solid<D>| {
            // A probe may lie on a face.
            solid.distance(&x) < -1e-9
        };
        let nearest = || self.nearest_water(&x, frame);
        if let Some(solid) = self.solids().iter().find(inside) {
            let what = format!("probe \"{name}\" {place} is inside solid \"{}\"", solid.spec.name);
            return Some(Finding::warning("probe_inside_solid", what, nearest()));
        }
        if !all.contains(&x) && x[D - 1] <= all.max[D - 1] {
            let what = format!("probe \"{name}\" {place} is outside of everything: no water comes there");
            return Some(Finding::warning("probe_outside", what, nearest()));
        }
        let highest = self.highest(sound);
        (x[D - 1] > highest).then(|| {
            let what = format!(
                "probe \"{name}\" {place} is {} m above the still level: no water comes there",
                three_digits(x[D - 1] - self.still_water.level)
            );
            let reach = format!("{}; water may come to {} m", nearest(), three_digits(highest));
            Finding::warning("probe_above", what, reach)
        })
    }

    /// A gauge needs a height between the lowest water and the highest at which there is no fixed solid. Where a solid fills the place
    /// at the level of the water, the gauge measures the water under that solid.
    fn gauge(
        &self,
        name: &str,
        at: &[f64],
        frame: &Frame<D>,
        (all, sound): (&Bounds<D>, &SoundSpeed),
    ) -> Option<Finding> {
        let (foot, place) = (frame.point(at), frame.place(at));
        let column = |z: f64| Vector::from_fn(|i, _| if i + 1 < D { foot[i] } else { z });
        let (low, high) = (all.min[D - 1], self.highest(sound).min(all.max[D - 1]));
        let outside = !all.contains(&column(low));
        let steps = ((high - low) / self.dp()).ceil().clamp(1.0, 10_000.0) as usize;
        let step = (high - low) / steps as f64;
        let free = |k: usize| self.signed_distance(&column(low + (k as f64 + 0.5) * step), |_| true) > 0.0;
        let nearest = |level: f64| self.nearest_water(&column(level), frame);
        if outside || !(0..steps).any(free) {
            let why = if outside { "is outside of everything" } else { "stands inside a solid" };
            let what = format!("gauge \"{name}\" {place} {why}: no water comes there");
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
            "gauge \"{name}\" {place} stands in solid \"{}\" at the still level: it measures the water under that, which has \
             no free surface",
            solid.spec.name
        );
        Some(Finding::note("gauge_under_solid", what, nearest(level)))
    }

    /// Describes the place of the water nearest to `x` (m) in `frame`.
    fn nearest_water(&self, x: &Vector<D>, frame: &Frame<D>) -> String {
        let distance = |r: &&Vector<D>| (**r - x).norm_squared();
        let nearest = self.system.fluid().r.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        nearest.map_or_else(String::new, |r| format!("the nearest water is at {}", coordinates(&frame.pose.local(r))))
    }
}
