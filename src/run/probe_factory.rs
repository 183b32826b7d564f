//! Builds the probes and checks of a plan.

use crate::{
    analysis::ReferenceCheck,
    error::{Error, ErrorCode, Result, nearest_name},
    math::Bounds,
    plan::{CheckPlan, Plan, Reference},
    probe::{Probe, ProbePlan, ProbeReads},
    simulation::{Dimension, Simulation, water_of_ranks},
    solid::Dim,
    system::System,
};

/// Builds the probes of `plan` at the start of the simulation and enables the records that they read. Where ranks share the water, all
/// ranks must call this; the first has the water then that these probes read.
///
/// # Errors
/// `Scene` or `Usage` if a probe names an unknown solid, or a place with the wrong number of coordinates.
pub(crate) fn probes_from_plan<const D: usize>(plan: &Plan, sim: &mut Simulation<D>) -> Result<Vec<Box<dyn Probe<D>>>>
where
    Dim<D>: Dimension<D>,
{
    plan.probes.iter().for_each(|probe| probe.kind.enable_records(sim));
    let mut probes: Vec<_> = plan.probes.iter().map(|probe| build_probe(probe, sim.system())).collect::<Result<_>>()?;
    match water_ranges(probes.iter().map(|probe| &**probe), sim.system()) {
        Some(ranges) => water_of_ranks::know_within(sim, &ranges),
        None => sim.gather_water(false),
    }
    probes.iter_mut().for_each(|probe| probe.read_start(sim.system()));
    Ok(probes)
}

/// The boxes (m) in which those of `probes` that read the water read it now, or `None` if they may read all water.
pub(crate) fn water_ranges<'a, const D: usize>(
    probes: impl Iterator<Item = &'a dyn Probe<D>>,
    system: &System<D>,
) -> Option<Vec<Bounds<D>>> {
    let of_water = probes.filter(|probe| probe.reads() != ProbeReads::Solids);
    let ranges: Option<Vec<_>> = of_water.map(|probe| probe.water_ranges(system)).collect();
    ranges.map(|ranges| ranges.concat())
}

fn build_probe<const D: usize>(plan: &ProbePlan, system: &System<D>) -> Result<Box<dyn Probe<D>>> {
    if plan.name.is_empty() || plan.name.starts_with('.') || plan.name.contains(['/', '\\', ':', '\0']) {
        return Err(Error::scene(format!("{:?} cannot name a file, so no probe either", plan.name)));
    }
    plan.kind.build_unread(system).map_err(|e| {
        let error = Error { message: format!("probe \"{}\": {}", plan.name, e.message), ..e };
        let is_placed = error.location.is_some();
        if is_placed { error } else { error.at("", None, format!("probe.{}", plan.name)) }
    })
}

/// The error for a `series` of the check or the statistic at `key` that is none of `known`.
fn unknown_series(series: &str, known: &[String], key: &str) -> Error {
    let help = match nearest_name(series, known.iter().map(String::as_str)) {
        Some(near) => format!("did you mean {near:?}?"),
        None => format!("the series are: {}", known.join(", ")),
    };
    let error = Error::scene(format!("no probe writes the series {series:?}"));
    error.with_code(ErrorCode::UnknownName).help(help).at("", None, key)
}

/// Builds the checks of `plan` and reads their references.
///
/// # Errors
/// `Scene` if a check or a statistic names a series that none of the `probes` has; else as [`ReferenceCheck::new`].
pub(crate) fn checks_from_plan<const D: usize>(
    plan: &Plan,
    probes: &[Box<dyn Probe<D>>],
) -> Result<Vec<ReferenceCheck>> {
    let columns = plan.probes.iter().zip(probes);
    let known: Vec<String> =
        columns.flat_map(|(words, p)| p.columns().into_iter().map(move |c| format!("{}.{c}", words.name))).collect();
    let told = plan.statistics.iter().enumerate();
    let mut told = told.flat_map(|(i, words)| words.what.series().into_iter().map(move |series| (i, series)));
    if let Some((i, series)) = told.find(|(_, series)| !known.iter().any(|known| known == series)) {
        return Err(unknown_series(series, &known, &format!("statistic.{i}")));
    }
    let check = |(i, words): (usize, &CheckPlan)| {
        let wave = match &words.reference {
            Reference::Response(response) => Some(&response.to),
            _ => None,
        };
        let named = [(&words.series, "series")].into_iter().chain(wave.map(|wave| (wave, "response.to")));
        if let Some((series, word)) = named.into_iter().find(|(series, _)| !known.contains(series)) {
            return Err(unknown_series(series, &known, &format!("check.{i}.{word}")));
        }
        ReferenceCheck::new(words, &plan.folder)
    };
    plan.checks.iter().enumerate().map(check).collect()
}
