//! Bodies on ties that leave a motion free: their rest with all that is tied to them, and the balance at the start of bodies on a
//! hinge to the ground. At the turn φ about the hinge the moments of buoyancy, weight, steady
//! forces and the motor are M(φ); the turn to rest is about −M(0)/M'(0).

use serde::Serialize;

use super::{Finding, PreflightContext, floating_bodies::Tilt, hollows::hull, turns::LEVEL};
use crate::{
    math::{Bivector, Pose, Vector, format::three_digits},
    solid::{
        Constraints, JointKind, JointSpec, Kinematics,
        statics::{FreeRest, NO_WATER, StaticSystem, Support, free_rest},
    },
};

/// Half of the angle (rad) of the difference that gives M'.
const TILT: f64 = 1e-4;

/// Part of the weight times the size of a body below which a moment is round-off.
const LEAST: f64 = 1e-6;

/// Bodies that joints, ropes and springs tie together, with the motions free that these leave free.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FreeAssembly {
    /// Natural periods at rest without added mass, s, from the longest.
    pub periods_s: Vec<f64>,
    /// Turn of each body from the start to rest, degrees.
    pub turns_deg: Vec<(String, f64)>,
    /// Draft of each body at rest, m.
    pub drafts_m: Vec<(String, f64)>,
    /// Tension of each rope at rest, N (N/m in 2-D).
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub tensions_n: Vec<(String, f64)>,
    /// Whether they have a stable rest near their start; if not, they fall over.
    pub is_stable: bool,
}

/// Returns body `number`, the first one afloat of those tied to it, with them and their ties free; `None` without a tie that leaves a
/// motion free, and if their rest is not found.
pub(super) fn free_assembly<const D: usize>(
    context: &PreflightContext<D>,
    statics: &StaticSystem<D>,
    number: usize,
) -> Option<FreeAssembly> {
    let first = statics.tied_to(number).into_iter().find(|j| context.support(statics, *j) == Support::Water);
    // A single body on joints to the ground is judged by its metacentric height.
    let is_alone = statics.tied_to(number).len() == 1 && !statics.is_roped(number);
    if is_alone || !statics.has_loose_ties(number) || first != Some(number) {
        return None;
    }
    Some(named(context, statics, free_rest(statics, number)?))
}

/// Returns this rest with the names of the bodies.
fn named<const D: usize>(context: &PreflightContext<D>, statics: &StaticSystem<D>, found: FreeRest) -> FreeAssembly {
    let named = |(number, x): (usize, f64)| (context.solids()[statics.bodies[number].solid].spec.name.clone(), x);
    let degrees = found.turns.into_iter().map(|(number, turn)| (number, turn.to_degrees()));
    FreeAssembly {
        periods_s: found.periods,
        turns_deg: degrees.map(named).collect(),
        drafts_m: found.drafts.into_iter().map(named).collect(),
        tensions_n: found.tensions,
        is_stable: !found.is_unstable,
    }
}

/// Returns a finding about tied bodies that turn to their rest or have none. They have a name and a word for "their"
/// ([`PreflightContext::called`]), and the `tilts` of one rigid body.
pub(super) fn free_assembly_finding(
    free: &FreeAssembly,
    (name, its): (String, &str),
    tilts: &[Tilt],
) -> Option<Finding> {
    let (verb, has) = if its == "its" { ("turns", "it has") } else { ("turn", "they have") };
    if !free.is_stable {
        let least = tilts.iter().map(|tilt| tilt.gm_m).fold(0.0, f64::min);
        let height = match least < 0.0 {
            true => format!("; as one body {its} metacentric height is {} m", three_digits(least)),
            false => String::new(),
        };
        let what = format!("{name} will fall over: with {its} ties free, {has} no stable rest near the start{height}");
        let mend = "make a joint fixed, give it a motor with stiffness or end stops, or lower the centres of mass";
        return Some(Finding::warning("capsizes", what, mend.into()));
    }
    let most = free.turns_deg.iter().map(|(_, turn)| *turn).fold(0.0, f64::max);
    (most > LEVEL.to_degrees()).then(|| {
        let turns: Vec<String> =
            free.turns_deg.iter().map(|(name, turn)| format!("\"{name}\" by {}°", three_digits(*turn))).collect();
        let what = format!("{name} {verb} to {its} rest with free ties: {}", turns.join(", "));
        Finding::note(
            "lists",
            what,
            "turn them by so much (angle_deg, turn_deg), or shift their centres of mass".into(),
        )
    })
}

/// Adds findings about tied bodies none of which floats freely, as those on a joint to the ground or under water on a rope. A
/// single hinge to the ground without other ties has a note of its own.
pub(super) fn held_findings<const D: usize>(
    context: &PreflightContext<D>,
    statics: &StaticSystem<D>,
    number: usize,
    findings: &mut Vec<Finding>,
) {
    let tied = statics.tied_to(number);
    let is_held = |j: &usize| matches!(context.support(statics, *j), Support::Held | Support::Lines);
    if tied[0] != number || !tied.iter().all(is_held) || !statics.has_loose_ties(number) {
        return;
    }
    let constraints = context.system.constraints().at_start();
    let solid = statics.bodies[number].solid;
    if tied.len() == 1 && constraints.joints.iter().any(|joint| has_own_note(joint, solid, context, &constraints)) {
        return;
    }
    let Some(found) = free_rest(statics, number) else { return };
    findings.extend(free_assembly_finding(&named(context, statics, found), context.called(statics, &tied), &[]));
}

/// Adds a note about each body on a single hinge to the ground, without lines and end stops, that starts out of balance.
pub(super) fn check<const D: usize>(context: &PreflightContext<D>, findings: &mut Vec<Finding>) {
    if context.g == 0.0 {
        return;
    }
    let constraints = context.system.constraints().at_start();
    let is_free = |i: usize| context.solids()[i].body.is_some();
    for joint in &constraints.joints {
        let free: Vec<usize> = joint.between.into_iter().flatten().filter(|i| is_free(*i)).collect();
        let &[i] = &free[..] else { continue };
        if !has_own_note(joint, i, context, &constraints) {
            continue;
        }
        let moment = |turn: f64| moment(context, i, joint, turn);
        let (start, stiffness) = (moment(0.0), (moment(-TILT) - moment(TILT)) / (2.0 * TILT));
        let solid = &context.solids()[i];
        let scale =
            solid.body.as_ref().map_or(0.0, |body| body.mass * context.g) * solid.spec.shape.bounds().size().norm();
        if start.abs() <= LEAST * scale || (stiffness > 0.0 && start.abs() < LEVEL * stiffness) {
            continue;
        }
        let way = match stiffness > 0.0 {
            true => {
                format!("about {}°, estimated for small angles", three_digits((start.abs() / stiffness).to_degrees()))
            }
            false => "away".into(),
        };
        let what = format!(
            "\"{}\" starts out of balance on hinge \"{}\": a moment of {} N m turns it {way}",
            solid.spec.name,
            joint.name,
            three_digits(start)
        );
        let mend = "turn it by so much about the hinge, or change its centre of mass".into();
        findings.push(Finding::note("lists", what, mend));
    }
}

/// Returns whether a joint is a hinge of free solid number `i` to the ground without end stops, and its only tie.
fn has_own_note<const D: usize>(
    joint: &JointSpec<D>,
    i: usize,
    context: &PreflightContext<D>,
    constraints: &Constraints<D>,
) -> bool {
    let joints = constraints.joints.iter().filter(|other| other.between.contains(&Some(i))).count();
    let free = joint.between.into_iter().flatten().filter(|j| context.solids()[*j].body.is_some());
    joint.kind == JointKind::Hinge
        && joint.limits.is_none()
        && free.eq([i])
        && joints == 1
        && !constraints.lines().any(|(ends, _)| ends.iter().any(|end| end.solid == Some(i)))
}

/// Returns the moment (N m) about the hinge on free solid number `i`, turned about it by `turn` (rad).
fn moment<const D: usize>(context: &PreflightContext<D>, i: usize, joint: &JointSpec<D>, turn: f64) -> f64 {
    let solid = &context.solids()[i];
    let Some(body) = &solid.body else { return 0.0 };
    let axis: Vec<f64> = if D == 2 { vec![1.0] } else { joint.axis.normalize().iter().copied().collect() };
    let turned = Bivector::<D>::from_axial(&axis.iter().map(|a| a * turn).collect::<Vec<_>>()).exp();
    let now = &solid.kinematics.pose;
    let around = |x: &Vector<D>| joint.at + turned * (x - joint.at);
    let pose = Pose { position: around(&now.position), rotation: turned * now.rotation };
    let (volume, centroid) = hull(context, i).submerged_volume(&pose, context.level_around(i).unwrap_or(NO_WATER));
    let up = Vector::from_fn(|k, _| if k == D - 1 { context.g } else { 0.0 });
    let about = |x: Vector<D>, force: Vector<D>| Bivector::torque(&(x - joint.at), &force);
    let mut sum = about(centroid, up * (context.system.model().rho0 * volume));
    sum = sum + about(pose.point(&body.centre), up * -body.mass);
    for force in context.system.constraints().at_start().forces.iter().filter(|force| force.solid == i) {
        let Some((load, torque)) = force.steady_load(&pose.rotation) else { continue };
        let at = force.at.as_ref().map_or_else(|| pose.point(&body.centre), around);
        sum = sum + about(at, load) + torque;
    }
    let of_motor = joint.motor.as_ref().map_or(0.0, |motor| {
        let sign = if joint.between[1] == Some(i) { 1.0 } else { -1.0 };
        let command = motor.command_at(0.0);
        let start: Vec<Kinematics<D>> = context.solids().iter().map(|solid| solid.kinematics).collect();
        let at = joint.coordinate_at_start(&start) + sign * turn;
        let drive = command.force + command.stiffness * (command.position - at);
        sign * drive.clamp(-motor.max_force, motor.max_force)
    });
    of_motor + sum.axial().iter().zip(&axis).map(|(t, a)| t * a).sum::<f64>()
}
