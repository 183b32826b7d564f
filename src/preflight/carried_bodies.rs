//! Bodies whose equilibrium afloat is not the measure: on other bodies, and held by a joint that lets loads through.

use super::{BodySummary, Finding, PreflightContext};
use crate::{
    geometry::world_bounds,
    math::{Vector, format::three_digits},
    solid::{
        JointKind, JointSpec, Solid, SolidSpec,
        decks::{deck_of, may_stand},
    },
};

/// Part of the weight of a body below which a load does not count.
const LEAST_LOAD: f64 = 1e-6;

/// Adds notes about free bodies whose draft and periods say little. `touching` tells which solids touch another.
pub(super) fn check<const D: usize>(
    context: &PreflightContext<D>,
    touching: &[bool],
    bodies: &[BodySummary],
    findings: &mut Vec<Finding>,
) {
    if context.g == 0.0 {
        return;
    }
    for (i, solid) in context.solids().iter().enumerate() {
        let Some(body) = bodies.iter().find(|body| body.name == solid.spec.name) else { continue };
        if let Some(deck) = context.decks[i] {
            let what = format!(
                "\"{}\" stands on \"{}\": draft, GM and periods are those of both as one body",
                body.name,
                context.solids()[deck].spec.name
            );
            let mend = "whether it slides or tips shows in the run".into();
            findings.push(Finding::note("carried_body", what, mend));
            continue;
        }
        let stands = touching[i] && body.support == "solid";
        if let Some(lower) =
            (0..bodies.len()).map(|j| &bodies[j].name).find(|name| stands && is_below(context, name, i))
        {
            let what =
                format!("\"{}\" stands on \"{lower}\", whose draft and GM are given without that weight", body.name);
            let mend = "a joint between them gives those of both".into();
            findings.push(Finding::note("carried_body", what, mend));
        }
        let is_afloat = (body.displaced_kg - body.mass_kg).abs() <= LEAST_LOAD * body.mass_kg;
        let is_loaded = body.load_kg.abs() > LEAST_LOAD * body.mass_kg;
        if body.support == "held" && is_afloat && is_loaded {
            let joints = context.system.constraints().at_start().joints;
            let joint = joints.iter().find(|joint| joint.between.contains(&Some(i)) && lets_rise(joint));
            findings.extend(joint.map(|joint| {
                let what = format!(
                    "\"{}\" starts at its draft without the load of {} kg on it, and joint \"{}\" lets it give way to that",
                    body.name,
                    three_digits(body.load_kg),
                    joint.name
                );
                let mend = "give it the height or the angle at which it rests under its load";
                Finding::note("off_draft", what, mend.into())
            }));
        }
    }
}

/// Returns the free body on which each free body stands in the air, with nothing else to carry it.
pub(super) fn find_decks<const D: usize>(context: &PreflightContext<D>) -> Vec<Option<usize>> {
    let solids = context.solids();
    let constraints = &context.system.constraints().at_start();
    let specs: Vec<&SolidSpec<D>> = solids.iter().map(|solid| &solid.spec).collect();
    let poses: Vec<_> = solids.iter().map(|solid| solid.kinematics.pose).collect();
    let is_dry = |i: usize| {
        let below = |level: f64| solids[i].spec.shape.submerged_volume(&poses[i], level).0;
        context.level_around(i).is_none_or(|level| below(level) <= 0.0)
    };
    let deck = |i: usize| {
        let may = context.g > 0.0 && may_stand(specs[i], i, constraints) && is_dry(i);
        if may { deck_of(&specs, &poses, constraints, i, context.dp()) } else { None }
    };
    (0..solids.len()).map(deck).collect()
}

/// Whether the free solid called `name` is under solid number `i`, in contact.
fn is_below<const D: usize>(context: &PreflightContext<D>, name: &str, i: usize) -> bool {
    let bounds = |solid: &Solid<D>| world_bounds(&solid.spec.shape, &solid.kinematics.pose);
    let own = bounds(&context.solids()[i]);
    let other = context.solids().iter().enumerate().find(|(j, solid)| *j != i && solid.spec.name == name);
    other.is_some_and(|(_, solid)| {
        let other = bounds(solid);
        let overlaps = (0..D - 1).all(|axis| other.min[axis] < own.max[axis] && other.max[axis] > own.min[axis]);
        overlaps && other.min[D - 1] < own.min[D - 1] && other.max[D - 1] > own.min[D - 1] - context.dp()
    })
}

/// Whether the motion that a joint leaves free can raise a body.
fn lets_rise<const D: usize>(joint: &JointSpec<D>) -> bool {
    match joint.kind {
        JointKind::Fixed => false,
        JointKind::Slider | JointKind::Tow => {
            let along: Vector<D> = joint.axis.normalize();
            along[D - 1].abs() > LEAST_LOAD
        }
        JointKind::Hinge | JointKind::Ball | JointKind::Generic => true,
    }
}
