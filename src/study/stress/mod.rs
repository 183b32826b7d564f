//! `pontoon stress`: many short runs over maps of hard cases, each judged by physics.
//!
//! `maps` contains scenes with placeholders and the axes that supply their values. `CaseRun` runs a case in memory and
//! measures its figures. `Criteria` compares the figures with their bounds. [`StressResults`] runs the list of cases
//! and stores the results.
//! A case is right, wrong, stopped with a reason, or unfinished because its budget ended.

mod map_chart;
mod criteria;
mod result_store;
mod maps;
mod measurements;
mod case_run;

pub(crate) use case_run::{CaseEnd, CaseRun};
pub use criteria::CaseOutcome;
pub(crate) use maps::StressCase;
pub use maps::{StressMap, maps, select_maps};
pub use result_store::{CaseResult, StressResults};

/// Returns the result of a case in one line.
pub fn summary_line(entry: &CaseResult) -> String {
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
