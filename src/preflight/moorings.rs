//! Mooring lines at rest: tension, touchdown, the step of the line, and the natural period of the surge of moored bodies.

use serde::Serialize;

use super::{
    Finding, PreflightContext,
    lifetimes::{force_unit, strength_finding},
};
use crate::{
    math::{Vector, format::three_digits},
    simulation::Simulation,
    solid::{MooringReading, MooringSpec, Role, WinchTarget, statics::MooredEnd},
};

/// A mooring line at rest that acts at the start.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MooringSummary {
    /// Name of the line.
    pub name: String,
    /// Length without tension, m.
    pub length_m: f64,
    /// Tension at the first end, N (N/m in 2-D).
    pub fairlead_n: f64,
    /// Tension at the second end, N (N/m in 2-D).
    pub anchor_n: f64,
    /// Length on fixed solids, m.
    pub on_bed_m: f64,
    /// Coordinates of the touchdown point, m; absent unless part of the line lies on a fixed solid.
    pub touchdown_m: Option<Vec<f64>>,
    /// Angle of the second end above the horizontal, degrees.
    pub anchor_angle_deg: f64,
    /// Its shape at rest: coordinates of its nodes from the first end on, m.
    pub shape_m: Vec<Vec<f64>>,
    /// Longest step of the line, s.
    pub step_s: f64,
}

/// The surge of a moored body.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MooredSurge {
    /// Name of the body.
    pub name: String,
    /// Stiffness of its mooring lines along x, N/m (N/m² in 2-D).
    pub stiffness_npm: f64,
    /// Natural period without added mass, s; absent unless the stiffness is positive.
    pub period_s: Option<f64>,
}

/// Returns mooring lines and the surge stiffness and period of moored bodies. Adds notes about lines with many steps and
/// winches that do not start at their target tension, and warnings about lines that break at once or enter solids.
pub(super) fn summaries<const D: usize>(
    context: &PreflightContext<'_, D>,
    sim: &Simulation<D>,
    findings: &mut Vec<Finding>,
) -> (Vec<MooringSummary>, Vec<MooredSurge>) {
    let specs = &context.system.constraints().moorings;
    let readings = sim.mooring_readings();
    let line = |(i, now): (usize, &MooringReading<D>)| {
        if now.nodes.is_empty() {
            return None;
        }
        // The touchdown point is where the lying part ends, seen from the lower end.
        let from_second = now.nodes[0][D - 1] >= now.nodes[specs[i].segments][D - 1];
        let lying = sim.mooring_lying_nodes(i);
        let node = if from_second { lying.first() } else { lying.last() };
        Some(MooringSummary {
            name: specs[i].name.clone(),
            length_m: specs[i].length,
            fairlead_n: now.end_forces[0].norm(),
            anchor_n: now.end_forces[1].norm(),
            on_bed_m: now.on_bed,
            touchdown_m: node.map(|node| now.nodes[*node].iter().copied().collect()),
            anchor_angle_deg: now.anchor_angle.to_degrees(),
            shape_m: now.nodes.iter().map(|x| x.iter().copied().collect()).collect(),
            step_s: sim.mooring_step(i),
        })
    };
    let lines: Vec<MooringSummary> = readings.iter().enumerate().filter_map(line).collect();
    for own in lines.iter().filter(|own| own.step_s * MOST_INNER_STEPS < sim.step_limit()) {
        let inner = (sim.step_limit() / own.step_s).ceil();
        let what = format!(
            "mooring \"{}\" takes {} steps in each step of the water: it is stiff for its mass and the length of its segments",
            own.name,
            three_digits(inner)
        );
        let mend = "fewer segments or a lower stiffness make it cheaper, as long as its strain stays below 1 %".into();
        findings.push(Finding::note("stiff_mooring", what, mend));
    }
    let force = force_unit::<D>();
    for (spec, own) in specs.iter().filter_map(|spec| Some((spec, lines.iter().find(|line| line.name == spec.name)?))) {
        let Some(WinchTarget::Tension { tension, .. }) = spec.winch.map(|winch| winch.target) else { continue };
        if (own.fairlead_n / tension - 1.0).abs() > 0.01 {
            let what = format!(
                "mooring \"{}\" starts with {} {force}, and its winch holds {} {force}",
                own.name,
                three_digits(own.fairlead_n),
                three_digits(tension)
            );
            let mend =
                "the run begins with the way there; a length with the tension of the winch makes it start at rest"
                    .into();
            findings.push(Finding::note("winch_starts", what, mend));
        }
    }
    for (spec, own) in specs.iter().filter_map(|spec| Some((spec, lines.iter().find(|line| line.name == spec.name)?))) {
        let (most, strength) = (own.fairlead_n.max(own.anchor_n), spec.lifetime.strength);
        if most > strength {
            let what = format!("mooring \"{}\" breaks at the start", own.name);
            let least = |load: &str| format!("breaks = {load} or more, or a length with less tension");
            findings.push(strength_finding("breaks_at_start", (&what, ""), ([most, strength], force), least));
        }
    }
    let buried = readings.iter().zip(specs).filter_map(|(now, spec)| lies_in_solid(context, spec, &now.nodes));
    findings.extend(buried);
    let surge = |(i, solid): (usize, &crate::solid::Solid<D>)| {
        let body = solid.body.as_ref()?;
        let moored = specs.iter().any(|spec| spec.ends.iter().any(|end| end.solid == Some(i)));
        moored.then(|| {
            // The stiffness of a line that hangs straight down, or of round-off, is negligible beside the weight of the line.
            let least = lines.iter().map(|line| 1e-6 * line.fairlead_n / line.length_m).fold(0.0, f64::max);
            let stiffness = Some(sim.mooring_surge_stiffness(i)).filter(|k| k.abs() > least).unwrap_or(0.0);
            let period = (stiffness > 0.0).then(|| std::f64::consts::TAU * (body.mass / stiffness).sqrt());
            MooredSurge { name: solid.spec.name.clone(), stiffness_npm: stiffness, period_s: period }
        })
    };
    let surges = context.solids().iter().enumerate().filter_map(surge).collect();
    (lines, surges)
}

/// Returns the ends of the mooring lines on free bodies, with their stiffness.
pub(super) fn moored_ends<const D: usize>(context: &PreflightContext<'_, D>, sim: &Simulation<D>) -> Vec<MooredEnd<D>> {
    let is_free = |solid: usize| matches!(context.solids()[solid].spec.role, Role::Free(_));
    let moorings = context.system.constraints().moorings.iter().enumerate();
    let ends = |(i, spec)| MooredEnd::of(spec, is_free, |k| sim.mooring_end_stiffness(i, k));
    moorings.filter(|(i, _)| sim.mooring_acts(*i)).flat_map(ends).collect()
}

/// A warning about a line with nodes deep in a fixed solid or behind it: deeper than a bed yields.
fn lies_in_solid<const D: usize>(
    context: &PreflightContext<'_, D>,
    spec: &MooringSpec<D>,
    nodes: &[Vector<D>],
) -> Option<Finding> {
    let (dp, last) = (context.system.model().dp, nodes.len().checked_sub(1)?);
    let depth = |x: &Vector<D>| {
        let solids = context.solids().iter().filter(|solid| matches!(solid.spec.role, Role::Fixed));
        let depths = solids.map(|solid| {
            let local = solid.kinematics.pose.local(x);
            (-solid.spec.shape.signed_distance(&local), solid.spec.name.as_str())
        });
        depths.max_by(|a, b| a.0.total_cmp(&b.0))
    };
    // Between two nodes a line may go through a thin wall.
    let steps = (0..last).flat_map(|s| [0.25, 0.5, 0.75, 1.0].map(|u| nodes[s] * (1.0 - u) + nodes[s + 1] * u));
    let (deepest, name) =
        std::iter::once(nodes[0]).chain(steps).filter_map(|x| depth(&x)).max_by(|a, b| a.0.total_cmp(&b.0))?;
    (deepest > 0.5 * dp).then(|| {
        let what = format!(
            "mooring \"{}\" goes {} m deep into the fixed solid \"{name}\": no bed bears a line there",
            spec.name,
            three_digits(deepest)
        );
        Finding::warning("mooring_in_solid", what, "put its ends on the surface of the solid, or lead it around".into())
    })
}

/// Steps of a line in a step of the water from which on a note names them.
const MOST_INNER_STEPS: f64 = 200.0;
