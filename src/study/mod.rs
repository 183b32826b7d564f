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
pub mod stress; //HIDE
mod validation;

pub(crate) use convergence::Convergence; //NARROW
pub(crate) use convergence::convergence; //NARROW
pub(crate) use convergence::least_squares; //NARROW
pub use job::Job; //HIDE
pub use job::JobResult; //HIDE
pub use job::JobState; //HIDE
pub use parameter_grid::ParameterGrid; //HIDE
pub use parameter_grid::VariedKey; //HIDE
pub use parameter_grid::distinguishing_labels; //HIDE
pub use parameter_grid::frame_interval; //HIDE
pub use parameter_grid::split_values; //HIDE
pub use repeat_spread::REPEATS_NOTE; //HIDE
pub(crate) use repeat_spread::Spread; //NARROW
pub use repeat_spread::spread_table; //HIDE
pub use result_rows::ResultRow; //HIDE
pub(crate) use result_rows::result_rows; //NARROW
pub(crate) use result_rows::rows_to_csv; //NARROW
pub use results::StudyResults; //HIDE
pub use time_estimate::DEFAULT_SPEED; //HIDE
pub use time_estimate::TimeEstimate; //HIDE
pub use time_estimate::estimate_times; //HIDE
pub use validation::Validation; //HIDE
pub(crate) use validation_cases::CaseResolution; //NARROW
pub use validation_cases::ValidationCase; //HIDE
pub use validation_cases::select_cases; //HIDE
pub use validation_cases::validation_cases; //HIDE
