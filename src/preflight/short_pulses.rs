//! Pulses of forces, motors and winds that are shorter than some steps. A step has the value in its middle, so that it misses such a
//! pulse or gives it a wrong impulse.

use super::{Finding, PreflightContext, StepSizeLimits};
use crate::{
    math::format::{three_digits, two_digits_down},
    solid::TimeFunction,
};

/// Number of steps that resolve a pulse: rectangular ones then have their impulse within a quarter.
const STEPS: f64 = 4.0;

/// Number of samples in a pulse of this length.
const SAMPLES: usize = 32;

/// Most samples of a law.
const MOST: usize = 2_000_000;

/// Least height of a pulse above the values before and after it, over the range of the law, and over that in a surrounding four times
/// as long: a slow change is no pulse.
const HEIGHTS: [f64; 2] = [0.1, 0.5];

/// Adds a warning for each force, torque, motor and wind with pulses too short for the steps.
pub(super) fn check<const D: usize>(
    context: &PreflightContext<'_, D>,
    step: &StepSizeLimits,
    findings: &mut Vec<Finding>,
) {
    let constraints = context.system.constraints();
    let forces = constraints.forces.iter().flat_map(|force| {
        let laws = force.force.iter().chain(&force.torque);
        laws.map(|law| (format!("force \"{}\"", force.name), law, [force.lifetime.since, force.lifetime.until]))
    });
    let motors = constraints.joints.iter().filter_map(|joint| {
        let what = format!("the motor of joint \"{}\"", joint.name);
        Some((what, &joint.motor.as_ref()?.force, [joint.lifetime.since, joint.lifetime.until]))
    });
    let winds = constraints.winds.iter().flat_map(|wind| &wind.velocity);
    let winds = winds.map(|law| ("the wind".into(), law, [0.0, f64::INFINITY]));
    for (what, law, [from, until]) in forces.chain(motors).chain(winds) {
        let span = [from, until.min(context.end_time())];
        let Some((at, length)) = short_pulse(law, span, STEPS * step.dt_s) else { continue };
        let what = format!(
            "{what} has a pulse of {} s at t = {} s, and a step of {} s has the value in its middle: the impulse is wrong",
            three_digits(length),
            three_digits(at),
            three_digits(step.dt_s)
        );
        let mend = format!(
            "make it {} s long or longer with the same impulse, or write  dt_max = {}  in [time]",
            three_digits(STEPS * step.dt_s),
            two_digits_down(length / STEPS)
        );
        findings.push(Finding::warning("short_pulse", what, mend));
    }
}

/// Time and length (s) of the first pulse of `law` in the `span` (s) that is shorter than `longest` (s).
fn short_pulse(law: &TimeFunction, [from, until]: [f64; 2], longest: f64) -> Option<(f64, f64)> {
    if law.steady_value().is_some() || until <= from {
        return None;
    }
    let shortest = match law {
        TimeFunction::Table(series) => series.times().windows(2).map(|t| t[1] - t[0]).fold(longest, f64::min),
        TimeFunction::Formula(_) | TimeFunction::Wave(_) => longest,
    };
    let spacing = (longest / SAMPLES as f64).min(0.5 * shortest).max((until - from) / MOST as f64);
    let count = ((until - from) / spacing) as usize;
    let values: Vec<f64> = (0..=count).map(|i| law.value_and_rate(from + spacing * i as f64).0).collect();
    let bounds = |values: &[f64]| {
        values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(*x), high.max(*x)])
    };
    let range = |values: &[f64]| bounds(values)[1] - bounds(values)[0];
    let height = |values: &[f64]| {
        let ([low, high], [below, above]) = (bounds(values), bounds(&[values[0], values[values.len() - 1]]));
        (high - above).max(below - low)
    };
    let (least, window) = (HEIGHTS[0] * range(&values), (longest / spacing) as usize);
    let has_pulse = |values: &[f64]| height(values) > least;
    let is_alone = |start: usize| {
        let around = start.saturating_sub(3 * window / 2)..values.len().min(start + 5 * window / 2 + 1);
        height(&values[start..=start + window]) > HEIGHTS[1] * range(&values[around])
    };
    let mut windows = values.windows(window + 1).enumerate();
    let (start, _) = windows.find(|(start, part)| has_pulse(part) && is_alone(*start))?;
    // The shortest part of the window that still holds the pulse.
    let mut part = &values[start..=start + window];
    let mut first = start;
    while part.len() > 3 && has_pulse(&part[1..]) {
        (part, first) = (&part[1..], first + 1);
    }
    while part.len() > 3 && has_pulse(&part[..part.len() - 1]) {
        part = &part[..part.len() - 1];
    }
    let length = spacing * (part.len() - 1) as f64;
    Some((from + spacing * first as f64 + 0.5 * length, length))
}

#[cfg(test)]
#[path = "../../tests/unit/preflight/short_pulses.rs"]
mod tests;
