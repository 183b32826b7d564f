//! Motions at the start that a joint forbids.

use super::joint::{Joint, JointSpec, mode_count};
use crate::solid::Kinematics;

/// Returns the speed (m/s) and the spin (rad/s) of the second solid of `joint` relative to the first along the locked modes, for
/// solids that start as `start`: what the joint takes away in the first step.
pub(crate) fn forbidden_motion<const D: usize>(joint: &JointSpec<D>, start: &[Kinematics<D>]) -> [f64; 2] {
    let joint = Joint::new(joint.clone(), start);
    let ends = joint.end_kinematics(start);
    let rate = |modes: std::ops::Range<usize>| {
        let locked = modes.filter(|mode| joint.spec.is_locked(*mode));
        locked.map(|mode| joint.row(mode, &ends).rate(&ends).powi(2)).sum::<f64>().sqrt()
    };
    [rate(0..D), rate(D..mode_count::<D>())]
}
