//! Findings about the turn of a body or an assembly from its start to its rest.

use std::f64::consts::PI;

use super::{
    Finding,
    floating_bodies::{Equilibrium, Tilt},
};
use crate::{
    math::format::{three_digits, two_digits_up},
    solid::{righting::Turn, statics::StaticSystem},
};

/// Heel (rad) from equilibrium below which no finding is reported: half a degree.
pub(super) const LEVEL: f64 = 0.5 * PI / 180.0;

/// Turn (rad) to rest beyond which a body turns over.
const OVER: f64 = 0.5 * PI;

/// Turn (rad) to rest up to which a body with a negative metacentric height does not turn over: ten degrees.
const SMALL_TURN: f64 = PI / 18.0;

/// Largest heel (degrees) that is estimated for small angles.
pub(super) const LARGEST_ESTIMATE: f64 = 45.0;

/// Returns the estimated heel (rad) of an assembly between its start and rest, from its levers and metacentric heights at the
/// start.
pub(super) fn linear_heel<const D: usize>(statics: &StaticSystem<D>, number: usize, tilts: &[Tilt]) -> f64 {
    let along = |axis: &[f64]| statics.lever(number, axis, 0.0).iter().zip(axis).map(|(l, a)| l * a).sum::<f64>();
    // A body of revolution on its side has GM = 0 and no heel.
    let heel = |t: &Tilt| if t.gm_m == 0.0 { 0.0 } else { along(&t.axis) / t.gm_m };
    tilts.iter().fold(0.0, |sum: f64, t| sum.hypot(heel(t)))
}

/// Returns a finding about the turn of an assembly from its start to its rest; `called`: its name, and the endings of words
/// about it.
pub(super) fn turn_finding<const D: usize>(
    afloat: &Equilibrium,
    (statics, number): (&StaticSystem<D>, usize),
    (name, verb, its): (&str, &str, &str),
) -> Option<Finding> {
    let least = afloat.tilts.iter().map(|t| t.gm_m).fold(f64::INFINITY, f64::min);
    let level_it = "turn it by so much (angle_deg, turn_deg), or put its centre of mass under its buoyancy";
    let lower = || {
        format!("lower {its} centre of mass by {} m or more (centre_offset), or lock {its} turn", two_digits_up(-least))
    };
    match afloat.turn {
        Some(Turn::Floods(angle)) => {
            let at = three_digits(angle.to_degrees());
            let what = format!("{name} floods as it turns: {at}° from its start the still water stands at its rim");
            Some(Finding::warning("hull_floods", what, level_it.into()))
        }
        Some(Turn::Rests(angle)) => {
            let is_unstable = least < 0.0 && linear_heel(statics, number, &afloat.tilts) < LEVEL;
            let rest = three_digits(angle.to_degrees());
            if angle > OVER || (is_unstable && angle > SMALL_TURN) {
                let height = match is_unstable {
                    true => format!(": its metacentric height is {} m", three_digits(least)),
                    false => String::new(),
                };
                let what = format!("{name} will turn over, to rest at {rest}° from its start{height}");
                let mend = match is_unstable {
                    true => lower(),
                    false => "put its centre of mass under its buoyancy (centre_offset), or lock its turn".into(),
                };
                return Some(Finding::warning("capsizes", what, mend));
            }
            (angle > LEVEL)
                .then(|| Finding::note("lists", format!("{name} turns by {rest}° to its rest"), level_it.into()))
        }
        None if least < 0.0 => {
            let what = format!("{name} will turn over: {its} metacentric height is {} m", three_digits(least));
            Some(Finding::warning("capsizes", what, lower()))
        }
        None => {
            let heel = afloat.heel_deg.filter(|heel| *heel > LEVEL.to_degrees())?;
            let far = if heel < LARGEST_ESTIMATE { "about" } else { "more than" };
            let rests = if verb == "s" { "it rests" } else { "they rest" };
            let what = format!(
                "{name} start{verb} {far} {}° out of the trim in which {rests}, estimated for small angles",
                three_digits(heel)
            );
            Some(Finding::note("lists", what, level_it.into()))
        }
    }
}
