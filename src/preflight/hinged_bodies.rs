//! Bodies on joints with a free motion: the rest of assemblies whose joints are free, and the balance at the start of bodies on a
//! hinge to the ground. At the turn φ about the hinge the moments of buoyancy, weight, steady
//! forces and the motor are M(φ); the turn to rest is about −M(0)/M'(0).

use serde::Serialize;

use super::{Finding, PreflightContext, hollows::hull, turns::LEVEL};
use crate::{
    math::{Bivector, Pose, Vector, format::three_digits},
    solid::{
        JointKind, JointSpec,
        statics::{NO_WATER, StaticSystem, free_joints},
    },
};

/// Half of the angle (rad) of the difference that gives M'.
const TILT: f64 = 1e-4;

/// Part of the weight times the size of a body below which a moment is round-off.
const LEAST: f64 = 1e-6;

/// An assembly with the joints between its bodies free.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FreeAssembly {
    /// Natural periods at rest without added mass, s, from the longest.
    pub periods_s: Vec<f64>,
    /// Turn of each body from the start to rest, degrees.
    pub turns_deg: Vec<(String, f64)>,
    /// Whether the assembly stays at rest; if not, its parts fall over.
    pub is_stable: bool,
}

/// Returns the assembly of body `number`, its first one afloat, with its joints free; `None` without such joints, and if it is not
/// judged.
pub(super) fn free_assembly<const D: usize>(
    context: &PreflightContext<D>,
    statics: &StaticSystem<D>,
    number: usize,
) -> Option<FreeAssembly> {
    if statics.loose_joints(number).is_empty() || !context.is_first_afloat(statics, number) {
        return None;
    }
    let found = free_joints(statics, number)?;
    let name = |number: usize| context.solids()[statics.bodies[number].solid].spec.name.clone();
    let turns_deg = found.turns.iter().map(|(number, turn)| (name(*number), turn.to_degrees())).collect();
    Some(FreeAssembly { periods_s: found.periods, turns_deg, is_stable: !found.is_unstable })
}

/// Returns a finding about an assembly with free joints that turns to its rest or has none.
pub(super) fn free_assembly_finding(free: &FreeAssembly, name: &str) -> Option<Finding> {
    if !free.is_stable {
        let what = format!("{name} will fall over: with their joints free, they have no stable rest near the start");
        let mend = "make a joint fixed, give it a motor with stiffness or end stops, or lower the centres of mass";
        return Some(Finding::warning("capsizes", what, mend.into()));
    }
    let most = free.turns_deg.iter().map(|(_, turn)| *turn).fold(0.0, f64::max);
    (most > LEVEL.to_degrees()).then(|| {
        let turns: Vec<String> =
            free.turns_deg.iter().map(|(name, turn)| format!("\"{name}\" by {}°", three_digits(*turn))).collect();
        let what = format!("{name} turn to their rest with free joints: {}", turns.join(", "));
        Finding::note(
            "lists",
            what,
            "turn them by so much (angle_deg, turn_deg), or shift their centres of mass".into(),
        )
    })
}

/// Adds a note about each body on a single hinge to the ground, without lines and end stops, that starts out of balance.
pub(super) fn check<const D: usize>(context: &PreflightContext<D>, findings: &mut Vec<Finding>) {
    if context.g == 0.0 {
        return;
    }
    let constraints = context.system.constraints().at_start();
    let is_free = |i: usize| context.solids()[i].body.is_some();
    for joint in constraints.joints.iter().filter(|joint| joint.kind == JointKind::Hinge && joint.limits.is_none()) {
        let free: Vec<usize> = joint.between.into_iter().flatten().filter(|i| is_free(*i)).collect();
        let &[i] = &free[..] else { continue };
        let lines = constraints.springs.iter().flat_map(|line| &line.ends);
        let lines = lines.chain(constraints.ropes.iter().flat_map(|line| &line.ends));
        let mut lines = lines.chain(constraints.moorings.iter().flat_map(|line| &line.ends));
        let joints = constraints.joints.iter().filter(|other| other.between.contains(&Some(i))).count();
        if joints > 1 || lines.any(|end| end.solid == Some(i)) {
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
        let Some((load, torque)) = force.steady_load() else { continue };
        let at = force.at.as_ref().map_or_else(|| pose.point(&body.centre), around);
        sum = sum + about(at, load) + torque;
    }
    let of_motor = joint.motor.as_ref().map_or(0.0, |motor| {
        let sign = if joint.between[1] == Some(i) { 1.0 } else { -1.0 };
        let command = motor.command_at(0.0);
        let drive = command.force + command.stiffness * (command.position - sign * turn);
        sign * drive.clamp(-motor.max_force, motor.max_force)
    });
    of_motor + sum.axial().iter().zip(&axis).map(|(t, a)| t * a).sum::<f64>()
}
