//! Many runs as one question: a grid over spacing and laws, or a list of cases with references.
//!
//! A [`Job`] is one run in a folder of its own; it is skipped where it has been run, and goes on where it was
//! interrupted. [`ParameterGrid`] makes the jobs of `pontoon study`, [`ValidationCase`] those of `pontoon validate`; rows, orders
//! and pages say what came out. [`stress`] makes and judges many short runs in memory.

mod validation_cases;
mod cost_plot;
mod time_estimate;
mod parameter_grid;
mod job;
mod convergence;
mod html_page;
mod result_rows;
mod results;
mod repeat_spread;
pub(crate) mod stress; //NARROW
mod validation;

pub(crate) use convergence::Convergence; //NARROW
pub(crate) use convergence::convergence; //NARROW
pub(crate) use convergence::least_squares; //NARROW
pub(crate) use job::Job; //NARROW
pub(crate) use job::JobResult; //NARROW
pub(crate) use job::JobState; //NARROW
pub(crate) use parameter_grid::ParameterGrid; //NARROW
pub(crate) use parameter_grid::VariedKey; //NARROW
pub(crate) use parameter_grid::distinguishing_labels; //NARROW
pub(crate) use parameter_grid::frame_interval; //NARROW
pub(crate) use parameter_grid::split_values; //NARROW
pub(crate) use repeat_spread::REPEATS_NOTE; //NARROW
pub(crate) use repeat_spread::Spread; //NARROW
pub(crate) use repeat_spread::spread_table; //NARROW
pub(crate) use result_rows::ResultRow; //NARROW
pub(crate) use result_rows::result_rows; //NARROW
pub(crate) use result_rows::rows_to_csv; //NARROW
pub(crate) use results::StudyResults; //NARROW
pub(crate) use time_estimate::DEFAULT_SPEED; //NARROW
pub(crate) use time_estimate::TimeEstimate; //NARROW
pub(crate) use time_estimate::estimate_times; //NARROW
pub(crate) use validation::Validation; //NARROW
pub(crate) use validation_cases::CaseResolution; //NARROW
pub(crate) use validation_cases::ValidationCase; //NARROW
pub(crate) use validation_cases::select_cases; //NARROW
pub(crate) use validation_cases::validation_cases; //NARROW
