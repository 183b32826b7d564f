//! `pontoon stress`: many short runs over maps of hard cases, each judged by physics.
//!
//! `maps` are scenes with holes that axes fill; [`CaseRun`] runs a case in memory and measures it; [`Criteria`] holds the
//! figures against bounds; [`StressResults`] works the list off and keeps what came out. A case is right, stopped with a
//! reason, wrong, or cut by its budget: unfinished.

mod map_chart;
mod criteria;
mod result_store;
mod maps;
mod measurements;
mod case_run;

pub(crate) use case_run::BUDGET; //NARROW
pub(crate) use case_run::CaseEnd; //NARROW
pub(crate) use case_run::CaseRun; //NARROW
pub(crate) use criteria::Bound; //NARROW
pub use criteria::CaseOutcome; //HIDE
pub(crate) use criteria::Criteria; //NARROW
pub(crate) use criteria::MeasuredFigures; //NARROW
pub(crate) use criteria::MotionBound; //NARROW
pub(crate) use criteria::SolidBound; //NARROW
pub(crate) use maps::MapAxis; //NARROW
pub(crate) use maps::StressCase; //NARROW
pub use maps::StressMap; //HIDE
pub use maps::maps; //HIDE
pub use maps::select_maps; //HIDE
pub use result_store::CaseResult; //HIDE
pub use result_store::StressResults; //HIDE

/// What came out of a case, in a line.
pub fn summary_line(entry: &CaseResult) -> String { //HIDE
    let values = entry.case.values.join(", ");
    let Some((outcome, missed)) = entry.verdict() else { return format!("{values}: not run") };
    let why = match entry.run.as_ref().map(|trial| &trial.end) {
        Some(CaseEnd::Stopped(why)) => format!(": {why}"),
        Some(CaseEnd::Refused(why)) => format!(": refused: {why}"),
        Some(CaseEnd::Panicked(why)) => format!(": panicked: {why}"),
        _ if missed.is_empty() => String::new(),
        _ => format!(": {}", missed.join("; ")),
    };
    format!("{values}: {}{why}", map_chart::outcome_name(outcome))
}
