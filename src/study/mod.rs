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
pub use time_estimate::{DEFAULT_SPEED, TimeEstimate, estimate_times};
pub use validation::Validation;
pub use validation_cases::{ValidationCase, select_cases, validation_cases};
