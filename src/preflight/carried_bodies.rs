//! Bodies for which the level of the sea is not the measure: on other bodies, in the water of a hull, and held by a joint that lets
//! loads through.

use super::{BodySummary, Finding, PreflightContext, gaps::Gaps, hollows::lies_in_hollow};
use crate::{
    math::{Vector, format::three_digits},
    solid::{ForceSpec, JointKind, JointSpec},
};

/// Part of the weight of a body below which a load does not count.
const LEAST_LOAD: f64 = 1e-6;

/// Adds notes about free bodies whose draft and periods say little. `gaps` tells which solids touch, and `inside` has the level (m) of
/// the water of each hull by its number.
pub(super) fn check<const D: usize>(
    context: &PreflightContext<D>,
    (gaps, inside): (&Gaps, &[(usize, f64)]),
    bodies: &[BodySummary],
    findings: &mut Vec<Finding>,
) {
    if context.g == 0.0 {
        return;
    }
    for (i, solid) in context.solids().iter().enumerate() {
        let Some(body) = bodies.iter().find(|body| body.name == solid.spec.name) else { continue };
        let (sea, dp) = (context.still_water.level, context.dp());
        let decks = if body.support == "solid" { decks_below(context, gaps, i) } else { Vec::new() };
        if let Some(lower) = decks.first().map(|j| &context.solids()[*j].spec.name) {
            let gives = match deck_below(context, gaps, i) {
                Some(_) => "draft and GM are given with that weight, and whose periods without",
                None => "draft and GM are given without that weight",
            };
            let what = format!("\"{}\" stands on \"{lower}\", whose {gives}", body.name);
            let mend = "a joint between them gives those of both".into();
            findings.push(Finding::note("carried_body", what, mend));
        }
        let is_in = |(hull, level): &&(usize, f64)| (level - sea).abs() > dp && lies_in_hollow(context, i, *hull);
        if let Some((hull, level)) = inside.iter().find(is_in) {
            let what = format!(
                "\"{}\" starts in the water inside \"{}\", which stands to {} m: its draft and periods are those in the sea, at {} m",
                body.name,
                context.solids()[*hull].spec.name,
                three_digits(*level),
                three_digits(sea)
            );
            findings.push(Finding::note("other_level", what, "give its height instead of a draft".into()));
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

/// Returns solid number `i` and the only free solid on which it stands, if it is free and in the air.
pub(super) fn deck_below<const D: usize>(context: &PreflightContext<D>, gaps: &Gaps, i: usize) -> Option<[usize; 2]> {
    let solid = &context.solids()[i];
    let &[deck] = &decks_below(context, gaps, i)[..] else { return None };
    let level = context.still_water.level;
    let is_dry = solid.spec.shape.submerged_volume(&solid.kinematics.pose, level).0 <= 0.0;
    (is_dry && solid.body.is_some()).then_some([i, deck])
}

/// Returns the weight of solid number `i` as a force on solid number `deck`.
pub(super) fn weight_on<const D: usize>(context: &PreflightContext<D>, [i, deck]: [usize; 2]) -> Option<ForceSpec<D>> {
    let solid = &context.solids()[i];
    let weight = solid.body.as_ref()?.mass * context.g;
    let force = (0..D).map(|axis| if axis == D - 1 { -weight } else { 0.0 });
    Some(ForceSpec::new(&solid.spec.name, deck).force(force).at(solid.kinematics.centre))
}

/// Returns the free solids under solid number `i`, in contact.
fn decks_below<const D: usize>(context: &PreflightContext<D>, gaps: &Gaps, i: usize) -> Vec<usize> {
    let solids = context.solids();
    let bounds = |i: usize| solids[i].spec.shape.bounds_at(&solids[i].kinematics.pose);
    let own = bounds(i);
    let is_below = |j: usize| {
        let other = bounds(j);
        let overlaps = (0..D - 1).all(|axis| other.min[axis] < own.max[axis] && other.max[axis] > own.min[axis]);
        overlaps && other.min[D - 1] < own.min[D - 1] && other.max[D - 1] > own.min[D - 1] - context.dp()
    };
    let touched = gaps.pairs.iter().filter(|pair| pair.contains(&i)).map(|pair| pair[0] + pair[1] - i);
    touched.filter(|j| solids[*j].body.is_some() && is_below(*j)).collect()
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
