//! Checks that water can reach the place of each probe.

use super::{Finding, PreflightContext, SoundSpeed};
use crate::{
    math::{
        Bounds, Vector,
        format::{coordinates, three_digits},
    },
    probe::ProbeLocation,
    scene::world_bounds,
    solid::Solid,
    system::symmetry::SymmetryPlane,
};

/// Height above its level that water can reach, over its depth, –: that of a dam break at a wall.
const SPLASH: f64 = 2.0;

impl<const D: usize> PreflightContext<'_, D> {
    /// Adds findings about probes inside solids, outside all water and solids, or above the height that water can reach.
    pub(super) fn check_probes(&self, sound: &SoundSpeed, findings: &mut Vec<Finding>) {
        let solids = self.solids().iter().map(|s| world_bounds(&s.spec.shape, &s.kinematics.pose));
        let all = solids.fold(Bounds::around(self.system.fluid().r), |a, b| a.union(&b));
        for probe in &self.plan.probes {
            match probe.kind.location() {
                Some(ProbeLocation::Points(places)) => {
                    findings.extend(places.iter().filter_map(|at| self.beyond_plane(&probe.name, at)));
                    let points = places.iter().filter(|at| at.len() == D);
                    findings.extend(
                        points.filter_map(|at| self.point(&probe.name, Vector::from_fn(|i, _| at[i]), &all, sound)),
                    );
                }
                Some(ProbeLocation::Columns(places)) => {
                    findings.extend(places.iter().filter_map(|at| self.beyond_plane(&probe.name, at)));
                    let places = places.iter().filter(|at| at.len() == D - 1);
                    findings.extend(places.filter_map(|at| self.gauge(&probe.name, at, &all, sound)));
                }
                Some(ProbeLocation::Section([from, to])) if from.len() == D && to.len() == D => {
                    findings.extend([from, to].into_iter().find_map(|at| self.beyond_plane(&probe.name, at)));
                    let ends = [from, to].map(|at| Vector::from_fn(|i, _| at[i]));
                    findings.extend(self.section(&probe.name, ends, &all));
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
        Some(Finding::warning(topic, what, self.nearest_water(&((from + to) * 0.5))))
    }

    /// The height (m) above which no water is expected; infinite without gravity.
    fn highest(&self, sound: &SoundSpeed) -> f64 {
        if self.g == 0.0 {
            return f64::INFINITY;
        }
        self.still_water.level + SPLASH * self.still_water.depth + sound.fastest().powi(2) / (2.0 * self.g)
    }

    fn point(&self, name: &str, x: Vector<D>, all: &Bounds<D>, sound: &SoundSpeed) -> Option<Finding> {
        let at = coordinates(&x);
        let inside = |solid: &&Solid<D>| {
            // A probe may lie on a face.
            solid.distance(&x) < -1e-9
        };
        if let Some(solid) = self.solids().iter().find(inside) {
            let what = format!("probe \"{name}\" at {at} m is inside solid \"{}\"", solid.spec.name);
            return Some(Finding::warning("probe_inside_solid", what, self.nearest_water(&x)));
        }
        if !all.contains(&x) && x[D - 1] <= all.max[D - 1] {
            let what = format!("probe \"{name}\" at {at} m is outside of everything: no water comes there");
            return Some(Finding::warning("probe_outside", what, self.nearest_water(&x)));
        }
        let highest = self.highest(sound);
        (x[D - 1] > highest).then(|| {
            let what = format!(
                "probe \"{name}\" at {at} m is {} m above the still level: no water comes there",
                three_digits(x[D - 1] - self.still_water.level)
            );
            Finding::warning(
                "probe_above",
                what,
                format!("{}; water may come to {} m", self.nearest_water(&x), three_digits(highest)),
            )
        })
    }

    /// A gauge needs a height between the lowest water and the highest at which there is no fixed solid.
    fn gauge(&self, name: &str, at: &[f64], all: &Bounds<D>, sound: &SoundSpeed) -> Option<Finding> {
        let column = |z: f64| Vector::from_fn(|i, _| at.get(i).copied().unwrap_or(z));
        let (low, high) = (all.min[D - 1], self.highest(sound).min(all.max[D - 1]));
        let outside = !all.contains(&column(low));
        let steps = ((high - low) / self.dp()).ceil().clamp(1.0, 10_000.0) as usize;
        let step = (high - low) / steps as f64;
        let free = |k: usize| self.signed_distance(&column(low + (k as f64 + 0.5) * step), |_| true) > 0.0;
        if !outside && (0..steps).any(free) {
            return None;
        }
        let why = if outside { "is outside of everything" } else { "stands inside a solid" };
        let what = format!("gauge \"{name}\" at {} m {why}: no water comes there", coordinates(at));
        let topic = if outside { "probe_outside" } else { "probe_inside_solid" };
        Some(Finding::warning(topic, what, self.nearest_water(&column(self.still_water.level))))
    }

    /// Describes the place of the nearest water.
    fn nearest_water(&self, x: &Vector<D>) -> String {
        let distance = |r: &&Vector<D>| (**r - x).norm_squared();
        let nearest = self.system.fluid().r.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        nearest.map_or_else(String::new, |r| format!("the nearest water is at {}", coordinates(r)))
    }
}
