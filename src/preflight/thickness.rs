//! Thickness of solids: the distance inward from a face to the next one, compared with the kernel's support radius.

use super::{
    Finding, PreflightContext,
    surface_samples::{self, SurfaceSample},
};
use crate::{
    geometry::Shape,
    math::{
        Pose, Vector,
        format::{coordinates, three_digits, two_digits_down, two_digits_up},
    },
    solid::Role,
};

/// Largest number of places of a solid that are sampled.
const PLACES_SEEN: usize = 1000;

/// Share of the face that does not count as the thinnest part although it is thinner, such as tips and edges.
const TIPS: f64 = 0.1;

/// The distance (m) from `face` straight through the solid to the opposite face, at most `most` (m). `distance` is the signed
/// distance of the solid.
fn chord<const D: usize>(face: &SurfaceSample<D>, dp: f64, most: f64, distance: impl Fn(&Vector<D>) -> f64) -> f64 {
    // No face is nearer than the signed distance; the smallest step leads across joints, where that is zero.
    let mut way = 0.25 * dp;
    while way < most {
        let d = distance(&(face.x - face.n * way));
        if d > 1e-6 * dp {
            return way - d;
        }
        way += (-d).max(0.05 * dp);
    }
    most
}

/// The thinnest part of a shape (m), but for the thinnest tenth of its face, and a place (m, own frame) there; `None`
/// without a face.
pub(crate) fn thinnest_part<const D: usize>(shape: &Shape<D>, faces: &[SurfaceSample<D>], dp: f64) -> Option<f64> {
    let most = shape.bounds().size().norm();
    let distance = |x: &Vector<D>| shape.signed_distance(x);
    shortest_chord(
        surface_samples::thinned(faces, PLACES_SEEN).map(|face| (chord(face, dp, most, distance), face.x)).collect(),
    )
    .map(|x| x.0)
}

/// The least of these distances after the shortest tenth, with its place.
fn shortest_chord<const D: usize>(mut ways: Vec<(f64, Vector<D>)>) -> Option<(f64, Vector<D>)> {
    ways.sort_by(|a, b| a.0.total_cmp(&b.0));
    ways.get((TIPS * ways.len() as f64) as usize).copied()
}

/// Returns what the boundary particles of a part of this thickness (dp), below the reach of the kernel, do to the water on its two sides
/// (`system::thin_sides`).
pub(super) fn effect_on_sides<const D: usize>(thickness_dp: f64) -> &'static str {
    match thickness_dp {
        x if D == 2 && x < 1.0 - 1e-6 => {
            "one layer of boundary particles stands for it, with the pressure of each side where both are wet"
        }
        _ => "water on its two sides interacts, and its boundary particles have one pressure for both",
    }
}

/// Returns the error of the load of water on one side of a wall of this thickness (dp): in tests a dry wall had a load of 0.7 to 1.4
/// times the exact one at 1 dp, of 1.02 times at 1.5 dp, and the exact one from 2 dp on.
pub(super) fn load_error(thickness_dp: f64) -> &'static str {
    match thickness_dp {
        x if x < 1.25 => ", and the load of water on one side of it swings by up to 40 %",
        x if x < 1.75 => ", and the load of water on one side of it errs by 2 %",
        _ => "",
    }
}

/// Returns the error of the buoyancy of a part of this thickness (dp) that is no whole number of dp: held in still water (2-D,
/// dp 20 mm, level and at 30°), boxes of 1.25, 1.35, 1.5, 1.75, 2.25 and 2.5 dp have 0.92, 0.88, 1.09, 1.05, 0.97 and 1.05 of it, polygons
/// 0.88, 0.86, 0.85, 1.06, 0.98 and 0.97. Below dp it is corrected.
pub(super) fn buoyancy_error(thickness_dp: f64) -> &'static str {
    match thickness_dp {
        x if (x - x.round()).abs() < 0.1 => "",
        x if (1.0..2.0).contains(&x) => "; as it is no whole number of dp thick, its buoyancy errs by up to 15 %",
        x if (2.0..3.0).contains(&x) => "; as it is no whole number of dp thick, its buoyancy errs by up to 6 %",
        _ => "",
    }
}

impl<const D: usize> PreflightContext<'_, D> {
    /// Compares the thickness of fixed and driven solids with the kernel's support radius. Fixed solids in contact are one wall.
    pub(super) fn check_thickness(&self, findings: &mut Vec<Finding>) {
        let (dp, reach) = (self.dp(), self.system.model().support_radius());
        for (solid, faces) in self.solids().iter().zip(&self.surface_samples) {
            let pose = &solid.kinematics.pose;
            let fixed = matches!(solid.spec.role, Role::Fixed);
            if matches!(solid.spec.role, Role::Free(_)) {
                continue;
            }
            let alone = |x: &Vector<D>| solid.spec.shape.signed_distance(&pose.local(x));
            let together = |x: &Vector<D>| self.signed_distance(x, |role| matches!(role, Role::Fixed));
            let way = |face: &SurfaceSample<D>| {
                let face = SurfaceSample { x: pose.point(&face.x), n: pose.rotation * face.n };
                let way = if fixed { chord(&face, dp, reach, together) } else { chord(&face, dp, reach, alone) };
                (way, face.x)
            };
            let Some((thick, at)) = shortest_chord(surface_samples::thinned(faces, PLACES_SEEN).map(way).collect())
            else {
                continue;
            };
            if thick < reach * (1.0 - 1e-6) {
                let what = format!(
                    "\"{}\" is {} m thick at {}, {} dp, and the kernel reaches {} dp: {}, or water meets \
                     too few boundary particles{}{}",
                    solid.spec.name,
                    three_digits(thick),
                    coordinates(&at),
                    three_digits(thick / dp),
                    three_digits(self.support_radius_dp()),
                    effect_on_sides::<D>(thick / dp),
                    load_error(thick / dp),
                    buoyancy_error(thick / dp),
                );
                let mend = format!(
                    "make it {} m thick, or dp = {}",
                    two_digits_up(reach),
                    two_digits_down(thick / self.support_radius_dp())
                );
                findings.push(Finding::warning("thin_wall", what, mend));
            }
        }
    }

    /// Signed distance (m) of the world point `x` (m) from the solids whose role is `wanted`.
    pub(super) fn signed_distance(&self, x: &Vector<D>, wanted: impl Fn(&Role<D>) -> bool) -> f64 {
        let of = |pose: &Pose<D>, shape: &Shape<D>| shape.signed_distance(&pose.local(x));
        let solids = self.solids().iter().filter(|s| wanted(&s.spec.role));
        solids.map(|s| of(&s.kinematics.pose, &s.spec.shape)).fold(f64::INFINITY, f64::min)
    }
}

#[cfg(test)]
#[path = "../../tests/unit/preflight/thickness.rs"]
mod tests;
