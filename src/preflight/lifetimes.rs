//! Times of checks, constraints and solids that the run does not reach, and lines and joints that break at the start or before rest.

use super::{Finding, PreflightContext};
use crate::{
    math::format::{three_digits, two_digits_up},
    plan::Reference,
    solid::{Lifetime, statics::Overload},
};

/// Adds findings about springs whose tension at the start exceeds their strength.
pub(super) fn check_strength<const D: usize>(context: &PreflightContext<'_, D>, findings: &mut Vec<Finding>) {
    for spring in context.system.constraints().springs.iter().filter(|spring| spring.breaks_at_start()) {
        let what = format!("spring \"{}\" breaks at the start", spring.name);
        let least = |load: &str| format!("breaks = {{ tension = {load} }} or more, or a length with less tension");
        findings.push(strength_finding(
            "breaks_at_start",
            (&what, ""),
            ([spring.start_tension(), spring.lifetime.strength], force_unit::<D>()),
            least,
        ));
    }
}

/// The finding about a line or a joint that breaks before the bodies are at rest.
pub(super) fn overload<const D: usize>(overload: Overload) -> Finding {
    let Overload { kind, name, load, strength, is_torque } = overload;
    let what = format!("{kind} \"{name}\" breaks before the bodies are at rest");
    let key = match kind {
        "joint" if is_torque => "torque",
        "joint" => "force",
        _ => "tension",
    };
    let least = |load: &str| format!("breaks = {{ {key} = {load} }} or more, or less load on it");
    let unit = match is_torque {
        true if D == 2 => "N m/m",
        true => "N m",
        false => force_unit::<D>(),
    };
    strength_finding("breaks_at_rest", (&what, " then"), ([load, strength], unit), least)
}

/// The unit of a force.
pub(super) fn force_unit<const D: usize>() -> &'static str {
    if D == 2 { "N/m" } else { "N" }
}

/// The finding `what` that a load of this unit, which acts `when`, exceeds the strength of the element that carries it; `mend` gets
/// the load, rounded up.
pub(super) fn strength_finding(
    topic: &'static str,
    (what, when): (&str, &str),
    ([load, bears], unit): ([f64; 2], &str),
    mend: impl Fn(&str) -> String,
) -> Finding {
    let what = format!("{what}: it has {} {unit}{when} and bears {} {unit}", three_digits(load), three_digits(bears));
    Finding::warning(topic, what, mend(&two_digits_up(load)))
}

/// Elements that begin, end or are removed after the end of the run, and bodies that are released then.
pub(super) fn check<const D: usize>(context: &PreflightContext<'_, D>, findings: &mut Vec<Finding>) {
    let links = context.system.constraints();
    let joints = links.joints.iter().map(|joint| ("joint", &joint.name, joint.lifetime));
    let springs = links.springs.iter().map(|spring| ("spring", &spring.name, spring.lifetime));
    let ropes = links.ropes.iter().map(|rope| ("rope", &rope.name, rope.lifetime));
    let forces = links.forces.iter().map(|force| ("force", &force.name, force.lifetime));
    let removed = links.removals.iter().map(|removal| {
        let name = &context.solids()[removal.solid].spec.name;
        ("solid", name, Lifetime::default().until(removal.at))
    });
    let end = context.end_time();
    let unreached = context.plan.checks.iter().filter_map(|check| {
        let of_response = match &check.reference {
            Reference::Response(response) => response.from,
            Reference::Table { .. } | Reference::Formula(_) => None,
        };
        let times = [("from", check.from), ("zero", check.zero), ("response.from", of_response)];
        let (key, at) = times.into_iter().find_map(|(key, at)| Some((key, at.filter(|at| *at >= end)?)))?;
        Some(format!("\"{}\" ({key} = {} s)", check.series, three_digits(at)))
    });
    let unreached: Vec<_> = unreached.collect();
    if !unreached.is_empty() {
        let what = format!(
            "the run ends at {} s, before its checks of {} begin: they judge nothing",
            three_digits(end),
            unreached.join(", ")
        );
        // A shortened run is judged less on purpose, so that this is no warning.
        findings.push(Finding::note("event_after_end", what, "begin them earlier, or run longer".into()));
    }
    for statistic in &context.plan.statistics {
        if let Some(from) = statistic.from.filter(|from| *from >= end) {
            let what = format!(
                "statistic \"{}\" begins at {} s, and the run ends at {} s: it has no samples",
                statistic.name,
                three_digits(from),
                three_digits(end)
            );
            findings.push(Finding::warning("event_after_end", what, "begin earlier, or run longer".into()));
        }
    }
    for hold in links.holds.iter().filter(|hold| hold.until >= end) {
        let name = &context.solids()[hold.solid].spec.name;
        let what = format!(
            "solid \"{name}\" never moves: it is released at {} s, and the run ends at {} s",
            hold.until,
            three_digits(end)
        );
        findings.push(Finding::warning("event_after_end", what, "release it earlier, or run longer".into()));
    }
    for (kind, name, lifetime) in joints.chain(springs).chain(ropes).chain(forces).chain(removed) {
        let run = format!("the run ends at {} s", three_digits(end));
        if lifetime.since >= end {
            let what = format!("{kind} \"{name}\" never acts: it begins at {} s, and {run}", lifetime.since);
            findings.push(Finding::warning("event_after_end", what, "begin earlier, or run longer".into()));
        } else if lifetime.until.is_finite() && lifetime.until >= end {
            let what = format!("{kind} \"{name}\" stays to the end: until is {} s, and {run}", lifetime.until);
            findings.push(Finding::note("event_after_end", what, "end it earlier, or run longer".into()));
        }
    }
}
