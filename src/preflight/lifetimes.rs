//! Times of constraints and solids that the run does not reach, and springs that break at the start.

use super::{Finding, PreflightContext};
use crate::{
    math::format::{three_digits, two_digits_up},
    solid::Lifetime,
};

/// Springs with more tension at the start than they bear.
pub(super) fn check_strength<const D: usize>(context: &PreflightContext<'_, D>, findings: &mut Vec<Finding>) {
    let force = if D == 2 { "N/m" } else { "N" };
    for spring in context.system.constraints().springs.iter().filter(|spring| spring.breaks_at_start()) {
        let tension = spring.start_tension();
        let what = format!(
            "spring \"{}\" breaks at the start: it has {} {force} and bears {} {force}",
            spring.name,
            three_digits(tension),
            three_digits(spring.lifetime.strength)
        );
        let mend =
            format!("breaks = {{ tension = {} }} or more, or a length with less tension", two_digits_up(tension));
        findings.push(Finding::warning("breaks_at_start", what, mend));
    }
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
