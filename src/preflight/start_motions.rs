//! Velocities and spins at the start that a joint forbids: the first step takes them away.

use super::{Finding, PreflightContext};
use crate::{
    math::{Vector, format::three_digits},
    solid::{JointKind, JointSpec, Kinematics, constraint::start_motion::forbidden_motion},
};

/// Part of the motion of a body that a joint may take away without a finding, –.
const LEAST: f64 = 0.01;

/// Adds a warning about each joint that takes away a part of the motion at the start of its free bodies.
pub(super) fn check<const D: usize>(context: &PreflightContext<D>, findings: &mut Vec<Finding>) {
    let start: Vec<Kinematics<D>> = context.solids().iter().map(|solid| solid.kinematics).collect();
    for joint in &context.system.constraints().at_start().joints {
        let free = || joint.between.into_iter().flatten().filter(|i| context.solids()[*i].body.is_some());
        let spin = |i: usize| start[i].spin.axial().iter().map(|x| x * x).sum::<f64>().sqrt();
        let speed = |i: usize| start[i].velocity.norm() + spin(i) * (joint.at - start[i].centre).norm();
        let Some(fastest) = free().max_by(|a, b| speed(*a).total_cmp(&speed(*b))) else { continue };
        let spins = free().map(spin).fold(0.0, f64::max);
        let [lost_speed, lost_spin] = forbidden_motion(joint, &start);
        let is_lost = |lost: f64, of: f64| of > 0.0 && lost > LEAST * of;
        let lost = [(lost_speed, speed(fastest), "m/s"), (lost_spin, spins, "rad/s")];
        let lost: Vec<String> = lost
            .into_iter()
            .filter(|(lost, of, _)| is_lost(*lost, *of))
            .map(|(lost, _, unit)| format!("{} {unit}", three_digits(lost)))
            .collect();
        if lost.is_empty() {
            continue;
        }
        let what = format!(
            "\"{}\" starts with a motion that joint \"{}\" forbids: the first step takes away {}, relative to what holds it there",
            context.solids()[fastest].spec.name,
            joint.name,
            lost.join(" and ")
        );
        let mend = match fitting_velocity(joint, fastest, &start) {
            Some(velocity) if !is_lost(lost_spin, spins) => {
                let components: Vec<String> = velocity.iter().map(|v| three_digits(*v)).collect();
                format!("for its spin write  velocity = [{}]", components.join(", "))
            }
            _ => "give it a velocity and a spin along the motions that the joint leaves free".into(),
        };
        findings.push(Finding::warning("forbidden_motion", what, mend));
    }
}

/// Returns the velocity (m/s) with which solid number `i` turns about `joint` with its spin at the start; `None` for a joint that is
/// no hinge.
fn fitting_velocity<const D: usize>(joint: &JointSpec<D>, i: usize, start: &[Kinematics<D>]) -> Option<Vec<f64>> {
    if !matches!(joint.kind, JointKind::Hinge | JointKind::Ball) {
        return None;
    }
    let other = joint.between.into_iter().flatten().find(|end| *end != i);
    let turning = |i: usize, x: &Vector<D>, about: &Vector<D>| start[i].spin.velocity_at(&(x - about));
    let at_joint =
        other.map_or_else(Vector::zeros, |end| start[end].velocity + turning(end, &joint.at, &start[end].centre));
    Some((at_joint + turning(i, &start[i].centre, &joint.at)).iter().copied().collect())
}
