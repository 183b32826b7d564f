//! Bodies and constraints that are probably mistakes: a body beside the water or longer than it, an inertia larger than the size
//! explains, an attachment far from its body.

use super::{Finding, PreflightContext};
use crate::{
    geometry::world_bounds,
    math::{
        Bounds, Vector,
        format::{three_digits, two_digits_up},
    },
    solid::{FreeBody, Role, Solid},
};

impl<const D: usize> PreflightContext<'_, D> {
    /// Adds findings about implausible free bodies and constraints; `touching` tells which solids touch another.
    pub(super) fn misplaced_bodies(&self, touching: &[bool], findings: &mut Vec<Finding>) {
        let computed = Bounds::around(self.system.fluid().r);
        let planes = self.system.symmetry_planes();
        let corners: Vec<_> = [computed.min, computed.max].iter().flat_map(|corner| planes.images(corner)).collect();
        let water = Bounds::around(&corners).grown(0.5 * self.dp());
        for (i, solid) in self.solids().iter().enumerate() {
            let Some(body) = &solid.body else { continue };
            if self.g > 0.0 && !touching[i] {
                findings.extend(self.outside_water(i, solid, &water));
            }
            let size = solid.spec.shape.bounds().size().norm();
            let radius = |body: &FreeBody<D>| {
                let inertia = if D == 2 { body.inertia[(0, 0)] } else { body.inertia.diagonal().max() };
                (inertia / body.mass).sqrt()
            };
            let gyration = radius(body);
            if gyration > size {
                let what = format!(
                    "\"{}\" has a radius of gyration of {} m and is {} m large: it hardly turns",
                    solid.spec.name,
                    three_digits(gyration),
                    three_digits(size)
                );
                let by_ballast = matches!(&solid.spec.role, Role::Free(own) if radius(own) <= size);
                let mend = match by_ballast {
                    true => "place its ballast nearer to it",
                    false => "leave inertia out, which is then the homogeneous shape's",
                };
                let mend = mend.into();
                findings.push(Finding::warning("large_inertia", what, mend));
            }
        }
        self.distant_attachments(findings);
    }

    /// A finding about a body that starts where no water is, or is longer than the water.
    fn outside_water(&self, i: usize, solid: &Solid<D>, water: &Bounds<D>) -> Option<Finding> {
        let (name, own) = (&solid.spec.name, world_bounds(&solid.spec.shape, &solid.kinematics.pose));
        let (long, there) = (own.size(), water.size());
        if own.contains(&water.min) && own.contains(&water.max) {
            // All the water is its own.
            return None;
        }
        if own.max[D - 1] < water.min[D - 1] {
            let (up, low) = (["y", "z"][D - 2], three_digits(water.min[D - 1]));
            let what = format!("\"{name}\" starts below the water, whose lowest point is at {up} = {low} m");
            let mend = "raise it: a draft is the depth of its lowest point below the still level".into();
            return Some(Finding::warning("beside_water", what, mend));
        }
        for (axis, word) in ["x", "y"].iter().enumerate().take(D - 1) {
            let [first, last] = [water.min[axis], water.max[axis]].map(three_digits);
            if own.min[axis] > water.max[axis] || own.max[axis] < water.min[axis] {
                let what = format!("\"{name}\" starts beside the water, which is from {word} = {first} to {last} m");
                let mend = "put it over the water, or on something that carries it".into();
                return Some(Finding::warning("beside_water", what, mend));
            }
            if long[axis] > there[axis] + 2.0 * self.dp() {
                let what = format!(
                    "\"{name}\" is {} m long along {word}, and the water is {} m: it cannot float there",
                    three_digits(long[axis]),
                    three_digits(there[axis])
                );
                let mend =
                    format!("make it smaller, or the tank longer by {} m", two_digits_up(long[axis] - there[axis]));
                return Some(Finding::warning("larger_than_water", what, mend));
            }
        }
        let falls = self.level_around(i).is_none() && self.system.constraints().constraint_on(i, 0.0).is_none();
        falls.then(|| {
            let what = format!("\"{name}\" starts where no water is, and touches nothing: it falls");
            let mend = "put it in the water, or on what carries it; a draft is measured from the highest level there";
            Finding::warning("beside_water", what, mend.into())
        })
    }

    /// Adds findings about ends of joints, lines and forces whose distance from their free body exceeds the body's size.
    fn distant_attachments(&self, findings: &mut Vec<Finding>) {
        let links = self.system.constraints();
        let joints = links.joints.iter().flat_map(|j| j.between.map(|end| ("joint", &j.name, end, j.at)));
        let springs = links.springs.iter().flat_map(|s| s.ends.map(|end| ("spring", &s.name, end.solid, end.at)));
        let ropes = links.ropes.iter().flat_map(|r| r.ends.map(|end| ("rope", &r.name, end.solid, end.at)));
        let moorings = links.moorings.iter().flat_map(|m| m.ends.map(|end| ("mooring", &m.name, end.solid, end.at)));
        let forces = links.forces.iter().filter_map(|f| Some(("force", &f.name, Some(f.solid), f.at?)));
        for (kind, name, end, at) in joints.chain(springs).chain(ropes).chain(moorings).chain(forces) {
            let Some(solid) = end.map(|solid| &self.solids()[solid]) else { continue };
            findings.extend(self.distant_attachment(kind, name, solid, &at));
        }
    }

    fn distant_attachment(&self, kind: &str, name: &str, solid: &Solid<D>, at: &Vector<D>) -> Option<Finding> {
        let size = solid.spec.shape.bounds().size().norm();
        let off = solid.distance(at);
        (matches!(solid.spec.role, Role::Free(_)) && off > size).then(|| {
            let body = &solid.spec.name;
            let what = format!("{kind} \"{name}\" is made fast to \"{body}\" {} m off it", three_digits(off));
            let mend =
                format!("\"{body}\" is {} m large: is the place meant, a point of the world?", three_digits(size));
            Finding::note("far_tie", what, mend)
        })
    }
}
