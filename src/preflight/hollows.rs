//! Hollows of solids: those that are dry at the start, and hulls that water enters although the scene does not ask for it.

use super::{Finding, PreflightContext, initial_water::OFF_LATTICE};
use crate::{
    geometry::{
        hollow::{Enclosure, Hollow, Place},
        world_bounds,
    },
    math::{Vector, format::three_digits},
    solid::{
        Role, Solid,
        hydrostatics::{HollowWater, Hull},
    },
    system::System,
};

/// Share of a hollow's volume below the still level that water may take while the hollow counts as dry.
const DRY: f64 = 0.05;

/// The space that a solid encloses, before the first step.
pub(super) struct SolidHollows<const D: usize> {
    enclosure: Enclosure<D>,
    /// Number of water particles in each hollow, with their mirror images.
    pub(super) particles: Vec<usize>,
}

impl<const D: usize> SolidHollows<D> {
    /// Counts the particles of the water of `system`, and their mirror images, in the hollows of `solid`.
    pub(super) fn new(enclosure: Enclosure<D>, solid: &Solid<D>, system: &System<D>) -> Self {
        let (shape, pose, planes) = (&solid.spec.shape, &solid.kinematics.pose, system.symmetry_planes());
        let (bounds, mut particles) = (shape.bounds_at(pose), vec![0; enclosure.hollows.len()]);
        let water = system.fluid().r.iter().flat_map(|x| planes.images(x));
        for x in water.filter(|x| bounds.contains(x)) {
            if let Place::Hollow(hollow) = enclosure.place(shape, &pose.local(&x)) {
                particles[hollow] += 1;
            }
        }
        Self { enclosure, particles }
    }
}

/// Returns solid number `i` with its hollows that are dry at the start, and those with water of their own.
pub(super) fn hull<'a, const D: usize>(context: &'a PreflightContext<D>, i: usize) -> Hull<'a, D> {
    let solid = &context.solids()[i];
    let mut hull = Hull::new(&solid.spec.shape);
    let Some(own) = &context.hollows[i] else { return hull };
    let (pose, level, dp) = (&solid.kinematics.pose, context.draft_level(i), context.dp());
    for (hollow, particles) in own.enclosure.hollows.iter().zip(&own.particles) {
        let volume_below = |level: f64| hollow.volume_and_moment_below(pose, level).0;
        let water = *particles as f64 * dp.powi(D as i32);
        if water <= DRY * volume_below(level) {
            hull.dry.push(hollow);
        } else if hollow.rim_height(pose) > level {
            // Half a row is the error of a count.
            let as_outside = volume_below(level - 0.6 * dp) < water && water < volume_below(level + 0.6 * dp);
            let water = if as_outside { volume_below(level) } else { water };
            hull.filled.push((hollow, HollowWater::Volume(water)));
        }
    }
    hull
}

/// Returns whether the point `x` (m, own frame) of solid number `i` lies in a hollow that is closed, or that the scene keeps dry, and
/// that has no water of its own.
pub(super) fn is_kept_dry<const D: usize>(context: &PreflightContext<D>, i: usize, x: &Vector<D>) -> bool {
    let (spec, Some(own)) = (&context.solids()[i].spec, &context.hollows[i]) else { return false };
    let Place::Hollow(hollow) = own.enclosure.place(&spec.shape, x) else { return false };
    own.particles[hollow] == 0 && spec.dry.unwrap_or_else(|| own.enclosure.hollows[hollow].is_closed())
}

/// Returns whether the point `x` (m, own frame) of solid number `i` lies in a hollow that is dry at the start.
pub(super) fn is_in_dry_hollow<const D: usize>(context: &PreflightContext<D>, i: usize, x: &Vector<D>) -> bool {
    let Some(own) = &context.hollows[i] else { return false };
    let place = own.enclosure.place(&context.solids()[i].spec.shape, x);
    matches!(place, Place::Hollow(hollow) if own.particles[hollow] == 0)
}

/// Adds findings about hulls with water inside that the scene does not ask for, and about dry hulls that flood.
pub(super) fn check_hollows<const D: usize>(context: &PreflightContext<D>, findings: &mut Vec<Finding>) {
    if context.g == 0.0 {
        return;
    }
    for (i, (solid, own)) in context.solids().iter().zip(&context.hollows).enumerate() {
        let (Some(own), name) = (own, &solid.spec.name) else { continue };
        let (pose, level) = (&solid.kinematics.pose, context.draft_level(i));
        let above = |hollow: &Hollow<D>| !hollow.is_closed() && hollow.rim_height(pose) > level;
        let filled = own.enclosure.hollows.iter().zip(&own.particles).filter(|(hollow, n)| **n > 0 && above(hollow));
        let particles: usize = filled.map(|(_, n)| n).sum();
        if particles > 0 && solid.spec.dry.is_none() {
            let what = format!(
                "{particles} water particles start inside \"{name}\", below its rim and beside the water outside: it is \
                 a hull full of water"
            );
            let mend = format!(
                "dry = true  of the solid keeps them out;  dry = false, or a [[water]] with  inside = \"{name}\",  says \
                 that they are meant"
            );
            findings.push(match solid.spec.role {
                Role::Fixed => Finding::note("water_inside", what, mend),
                _ => Finding::warning("water_inside", what, mend),
            });
        }
        let rim = hull(context, i).dry.iter().map(|hollow| hollow.rim_height(pose)).fold(f64::INFINITY, f64::min);
        if solid.spec.dry == Some(true) && rim < level - 0.5 * context.dp() {
            let what = format!(
                "the rim of \"{name}\" starts {} m below the still water: water runs in",
                three_digits(level - rim)
            );
            let mend = "place it higher, make it lighter or its sides higher".into();
            findings.push(Finding::warning("hull_floods", what, mend));
        }
    }
}

/// Returns the number of water particles in the hollow of solid number `hull` between whose sides solid number `i` lies, with its
/// middle in the hollow; `None` if it does not.
pub(super) fn particles_around<const D: usize>(context: &PreflightContext<D>, i: usize, hull: usize) -> Option<usize> {
    let own = context.hollows[hull].as_ref().filter(|_| i != hull)?;
    let (solid, other) = (&context.solids()[hull], &context.solids()[i]);
    let bounds = world_bounds(&other.spec.shape, &other.kinematics.pose);
    let around = own.enclosure.number_around(&solid.spec.shape, &solid.kinematics.pose, &bounds)?;
    Some(own.particles[around])
}

/// Returns whether solid number `i` lies in a hollow of solid number `hull`.
pub(super) fn lies_in_hollow<const D: usize>(context: &PreflightContext<D>, i: usize, hull: usize) -> bool {
    particles_around(context, i, hull).is_some()
}

/// The volume (m³; m² in 2-D) of solid number `i` below `level` (m).
fn solid_below<const D: usize>(context: &PreflightContext<D>, i: usize, level: f64) -> f64 {
    let solid = &context.solids()[i];
    solid.spec.shape.submerged_volume(&solid.kinematics.pose, level).0
}

/// Adds findings about water of hulls, given as (number of the hull, level in m): above the rim, or with a mass that is not that of
/// its level.
pub(super) fn check_own_water<const D: usize>(
    context: &PreflightContext<D>,
    inside: &[(usize, f64)],
    findings: &mut Vec<Finding>,
) {
    let dp = context.dp();
    for &(i, level) in inside {
        let (solid, Some(own)) = (&context.solids()[i], &context.hollows[i]) else { continue };
        let (name, pose) = (&solid.spec.name, &solid.kinematics.pose);
        let filled = || own.enclosure.hollows.iter().zip(&own.particles).filter(|(_, n)| **n > 0);
        let rim = filled().map(|(hollow, _)| hollow.rim_height(pose)).fold(f64::INFINITY, f64::min);
        if level > rim + 0.5 * dp {
            let what = format!(
                "the water inside \"{name}\" is given to {} m, above its rim at {} m: it holds that below the rim",
                three_digits(level),
                three_digits(rim)
            );
            findings.push(Finding::note(
                "hull_floods",
                what,
                format!("give it a level of {} m or less", three_digits(rim)),
            ));
        }
        let level = level.min(rim);
        let volume =
            |level: f64| filled().map(|(hollow, _)| hollow.volume_and_moment_below(pose, level).0).sum::<f64>();
        let within = (0..context.solids().len()).filter(|j| lies_in_hollow(context, *j, i));
        let others: f64 = within.map(|j| solid_below(context, j, level)).sum();
        let wanted = (volume(level) - others).max(0.0);
        let found = filled().map(|(_, n)| *n as f64).sum::<f64>() * dp.powi(D as i32);
        let area = (volume(level) - volume(level - dp)) / dp;
        if (found - wanted).abs() > OFF_LATTICE * dp * area {
            let rho0 = context.system.model().rho0;
            let what = format!(
                "the particles of the water inside \"{name}\" have {} kg, and its level gives {} kg",
                three_digits(rho0 * found),
                three_digits(rho0 * wanted)
            );
            let mend = "place the floor of the hull and the level of its water on the lattice of the water".into();
            findings.push(Finding::note("surface_off_lattice", what, mend));
        }
    }
}

#[cfg(all(test, feature = "dim2", feature = "dim3"))]
#[path = "../../tests/unit/preflight/hollows.rs"]
mod tests;
