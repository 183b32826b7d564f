//! What a run reads and judges: the probes and checks that its plan asks for.

use crate::{
    analysis::ReferenceCheck,
    error::{Error, Result, nearest_name},
    model::Dimension,
    probe::{self, Probe},
    scene::{CheckPlan, Plan, ProbeKind, ProbePlan},
    simulation::Simulation,
    solid::Dim,
    system::System,
};

/// The probes that `plan` asks for, made from the simulation at its start, which keeps the books that they read.
///
/// # Errors
/// `Scene` or `Usage` if one names no solid or a place with the wrong number of coordinates.
pub fn probes_from_plan<const D: usize>(plan: &Plan, sim: &mut Simulation<D>) -> Result<Vec<Box<dyn Probe<D>>>>
where
    Dim<D>: Dimension<D>,
{
    if plan.probes.iter().any(|words| words.what == ProbeKind::Budget) {
        sim.enable_energy_budget();
    }
    if plan.probes.iter().any(|words| matches!(words.what, ProbeKind::Balance { .. })) {
        sim.enable_load_breakdown();
    }
    let system = sim.system();
    plan.probes.iter().map(|words| build_probe(words, system)).collect()
}

fn build_probe<const D: usize>(words: &ProbePlan, system: &System<D>) -> Result<Box<dyn Probe<D>>> {
    if words.name.is_empty() || words.name.starts_with('.') || words.name.contains(['/', '\\', ':', '\0']) {
        return Err(Error::scene(format!("{:?} cannot name a file, so no probe either", words.name)));
    }
    Ok(match &words.what {
        ProbeKind::Motion { solid } => Box::new(probe::MotionProbe::new(system, solid)?),
        ProbeKind::Force { solid } => Box::new(probe::ForceProbe::new(system, solid)?),
        ProbeKind::Joint { joint } => Box::new(probe::JointProbe::new(system, joint)?),
        ProbeKind::Spring { spring } => Box::new(probe::LineProbe::spring(system, spring)?),
        ProbeKind::Rope { rope } => Box::new(probe::LineProbe::rope(system, rope)?),
        ProbeKind::Elevation { places, surface } => {
            probe_at_places(places, |at| Ok(Box::new(probe::ElevationProbe::with_surface(system, at, *surface)?)))?
        }
        ProbeKind::Velocity { places } => probe_at_places(places, |at| Ok(Box::new(probe::VelocityProbe::new(at)?)))?,
        ProbeKind::Pressure { places } => probe_at_places(places, |at| Ok(Box::new(probe::PressureProbe::new(at)?)))?,
        ProbeKind::Flow { from, to } => Box::new(probe::FlowProbe::new(from, to)?),
        ProbeKind::Runup { solid } => Box::new(probe::RunupProbe::new(system, solid)?),
        ProbeKind::Patch { solid, min, max } => Box::new(probe::PatchProbe::new(system, solid, min, max)?),
        ProbeKind::Front => Box::new(probe::FrontProbe),
        ProbeKind::Energy => Box::new(probe::EnergyProbe::new(system)),
        ProbeKind::Balance { solid } => Box::new(probe::LoadBalanceProbe::new(system, solid)?),
        ProbeKind::Contact { between: [a, b] } => Box::new(probe::ContactForceProbe::new(system, [a, b])?),
        ProbeKind::Budget => Box::new(probe::EnergyBudgetProbe::new(system)),
    })
}

/// A probe at each of `places`; of a single place the probe itself.
fn probe_at_places<const D: usize>(
    places: &[Vec<f64>],
    make: impl Fn(&[f64]) -> Result<Box<dyn Probe<D>>>,
) -> Result<Box<dyn Probe<D>>> {
    match places {
        [at] => make(at),
        _ => {
            let members: Result<Vec<_>> = places.iter().map(|at| Ok((at.clone(), make(at)?))).collect();
            Ok(Box::new(probe::ProbeRow::new(members?)))
        }
    }
}

/// That `series`, which a check or a statistic names, is none of `known`.
fn unknown_series(series: &str, known: &[String]) -> Error {
    let help = match nearest_name(series, known.iter().map(String::as_str)) {
        Some(near) => format!("did you mean {near:?}?"),
        None => format!("the series are: {}", known.join(", ")),
    };
    Error::scene(format!("no probe writes the series {series:?}")).help(help)
}

/// The checks that `plan` asks for, their references read.
///
/// # Errors
/// `Scene` if one, or a statistic, names no series of `probes`; else as [`ReferenceCheck::new`].
pub fn checks_from_plan<const D: usize>(plan: &Plan, probes: &[Box<dyn Probe<D>>]) -> Result<Vec<ReferenceCheck>> {
    let columns = plan.probes.iter().zip(probes);
    let known: Vec<String> =
        columns.flat_map(|(words, p)| p.columns().into_iter().map(move |c| format!("{}.{c}", words.name))).collect();
    let told = plan.statistics.iter().flat_map(|words| words.what.series());
    if let Some(series) = told.into_iter().find(|series| !known.iter().any(|known| known == series)) {
        return Err(unknown_series(series, &known));
    }
    let check = |words: &CheckPlan| {
        if !known.contains(&words.series) {
            return Err(unknown_series(&words.series, &known));
        }
        ReferenceCheck::new(words, &plan.folder)
    };
    plan.checks.iter().map(check).collect()
}
