//! Whether probes stand where there is, or may come, water.

use super::{
    Finding, Look, Sound,
    format::{place, three},
};
use crate::{
    math::{Bounds, Vector},
    plan::ProbeKind,
    scene::world_bounds,
    solid::Solid,
};

/// How much higher than its level water may come, in depths: what a dam break throws up a wall.
const SPLASH: f64 = 2.0;

impl<const D: usize> Look<'_, D> {
    /// Probes inside solids, outside of everything, above where water can come.
    pub(super) fn probes(&self, sound: &Sound, findings: &mut Vec<Finding>) {
        let solids = self.solids().iter().map(|s| world_bounds(&s.spec.shape, &s.kinematics.pose));
        let all = solids.fold(Bounds::around(self.system.fluid().r), |a, b| a.union(&b));
        for probe in &self.plan.probes {
            match &probe.what {
                ProbeKind::Velocity { places } | ProbeKind::Pressure { places } => {
                    let points = places.iter().filter(|at| at.len() == D);
                    findings.extend(
                        points.filter_map(|at| self.point(&probe.name, Vector::from_fn(|i, _| at[i]), &all, sound)),
                    );
                }
                ProbeKind::Elevation { places, .. } => {
                    let places = places.iter().filter(|at| at.len() == D - 1);
                    findings.extend(places.filter_map(|at| self.gauge(&probe.name, at, &all, sound)));
                }
                ProbeKind::Flow { from, to } if from.len() == D && to.len() == D => {
                    let ends = [from, to].map(|at| Vector::from_fn(|i, _| at[i]));
                    findings.extend(self.section(&probe.name, ends, &all));
                }
                _ => {}
            }
        }
    }

    /// A section needs a place on its way, in 3-D on its diagonal, at which there is no solid.
    fn section(&self, name: &str, [from, to]: [Vector<D>; 2], all: &Bounds<D>) -> Option<Finding> {
        let steps = ((to - from).norm() / self.dp()).ceil().clamp(1.0, 10_000.0) as usize;
        let places = || (0..steps).map(|k| from + (to - from) * ((k as f64 + 0.5) / steps as f64));
        let outside = !places().any(|x| all.contains(&x));
        if !outside && places().any(|x| self.distance(&x, |_| true) > 0.0) {
            return None;
        }
        let why = if outside { "is outside of everything" } else { "lies inside a solid" };
        let what =
            format!("section \"{name}\" from {} to {} m {why}: no water goes through it", place(&from), place(&to));
        let topic = if outside { "probe_outside" } else { "probe_inside_solid" };
        Some(Finding::warning(topic, what, self.moved(&((from + to) * 0.5))))
    }

    /// The height (m) above which no water is to be expected; none without gravity.
    fn highest(&self, sound: &Sound) -> f64 {
        if self.g == 0.0 {
            return f64::INFINITY;
        }
        self.still.level + SPLASH * self.still.depth + sound.fastest().powi(2) / (2.0 * self.g)
    }

    fn point(&self, name: &str, x: Vector<D>, all: &Bounds<D>, sound: &Sound) -> Option<Finding> {
        let at = place(&x);
        let inside = |solid: &&Solid<D>| {
            // A probe may lie on a face.
            solid.spec.shape.signed_distance(&solid.kinematics.pose.local(&x)) < -1e-9
        };
        if let Some(solid) = self.solids().iter().find(inside) {
            let what = format!("probe \"{name}\" at {at} m is inside solid \"{}\"", solid.spec.name);
            return Some(Finding::warning("probe_inside_solid", what, self.moved(&x)));
        }
        if !all.contains(&x) && x[D - 1] <= all.max[D - 1] {
            let what = format!("probe \"{name}\" at {at} m is outside of everything: no water comes there");
            return Some(Finding::warning("probe_outside", what, self.moved(&x)));
        }
        let highest = self.highest(sound);
        (x[D - 1] > highest).then(|| {
            let what = format!(
                "probe \"{name}\" at {at} m is {} m above the still level: no water comes there",
                three(x[D - 1] - self.still.level)
            );
            Finding::warning("probe_above", what, format!("{}; water may come to {} m", self.moved(&x), three(highest)))
        })
    }

    /// A gauge needs a height between the lowest water and the highest at which there is no fixed solid.
    fn gauge(&self, name: &str, at: &[f64], all: &Bounds<D>, sound: &Sound) -> Option<Finding> {
        let column = |z: f64| Vector::from_fn(|i, _| at.get(i).copied().unwrap_or(z));
        let (low, high) = (all.min[D - 1], self.highest(sound).min(all.max[D - 1]));
        let outside = !all.contains(&column(low));
        let steps = ((high - low) / self.dp()).ceil().clamp(1.0, 10_000.0) as usize;
        let step = (high - low) / steps as f64;
        let free = |k: usize| self.distance(&column(low + (k as f64 + 0.5) * step), |_| true) > 0.0;
        if !outside && (0..steps).any(free) {
            return None;
        }
        let why = if outside { "is outside of everything" } else { "stands inside a solid" };
        let what = format!("gauge \"{name}\" at {} m {why}: no water comes there", place(at));
        let topic = if outside { "probe_outside" } else { "probe_inside_solid" };
        Some(Finding::warning(topic, what, self.moved(&column(self.still.level))))
    }

    /// Where the nearest water is.
    fn moved(&self, x: &Vector<D>) -> String {
        let distance = |r: &&Vector<D>| (**r - x).norm_squared();
        let nearest = self.system.fluid().r.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        nearest.map_or_else(String::new, |r| format!("the nearest water is at {}", place(r)))
    }
}
