//! `pontoon stress`: many short runs over maps of hard cases, each judged by physics.
//!
//! [`maps`] are scenes with holes that axes fill; [`Trial`] runs a case in memory and measures it; [`Judge`] holds the
//! figures against bounds; [`EnergyBudget`] works the list off and keeps what came out. A case is right, stopped with a
//! reason, wrong, or cut by its budget: unfinished.

mod chart;
mod judge;
mod ledger;
mod maps;
mod measure;
mod trial;

pub use judge::{Bound, Course, Figures, Judge, Of, Outcome};
pub use ledger::{EnergyBudget, Entry};
pub use maps::{Axis, Case, Map, choose, maps};
pub use trial::{BUDGET, End, Trial};

/// What came out of a case, in a line.
pub fn said(entry: &Entry) -> String {
    let values = entry.case.values.join(", ");
    let Some((outcome, missed)) = entry.verdict() else { return format!("{values}: not run") };
    let why = match entry.trial.as_ref().map(|trial| &trial.end) {
        Some(End::Stopped(why)) => format!(": {why}"),
        Some(End::Refused(why)) => format!(": refused: {why}"),
        Some(End::Panicked(why)) => format!(": panicked: {why}"),
        _ if missed.is_empty() => String::new(),
        _ => format!(": {}", missed.join("; ")),
    };
    format!("{values}: {}{why}", chart::name(outcome))
}
