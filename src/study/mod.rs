//! Performs sets of runs: a grid over particle spacings and models, or a list of cases with references.
//!
//! A [`Job`] is one run in its own folder. The program skips a finished job and resumes an interrupted job.
//! [`ParameterGrid`] creates the jobs of `pontoon study`, and [`ValidationCase`] those of `pontoon validate`. Tables,
//! orders of convergence and pages present the results. [`stress`] runs and judges many short runs in memory.

mod validation_cases;
mod cost_plot;
mod time_estimate;
mod parameter_grid;
mod job;
pub mod convergence;
mod html_page;
mod result_rows;
mod results;
mod repeat_spread;
pub mod stress;
mod validation;

pub use convergence::{convergence, least_squares};
pub use job::{Job, JobResult, JobState};
pub use parameter_grid::{ParameterGrid, VariedKey, distinguishing_labels, frame_interval, split_values};
pub use repeat_spread::{REPEATS_NOTE, Spread, spread_table};
pub use result_rows::ResultRow;
pub(crate) use result_rows::rows_to_csv;
pub use results::StudyResults;
pub use time_estimate::{TimeEstimate, estimate_times};
pub use validation::Validation;
pub use validation_cases::{ValidationCase, select_cases, validation_cases};
