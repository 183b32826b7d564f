//! Many runs as one question: a grid over spacing and laws, or a list of cases with references.
//!
//! A [`Job`] is one run in a folder of its own; it is skipped where it has been run, and goes on where it was
//! interrupted. [`Grid`] makes the jobs of `pontoon study`, [`Case`] those of `pontoon validate`; rows, orders
//! and pages say what came out. [`stress`] makes and judges many short runs in memory.

mod cases;
mod cost;
mod estimate;
mod grid;
mod job;
mod order;
mod page;
mod plot;
mod rows;
mod sheet;
mod spread;
pub mod stress;
mod validation;

pub use cases::{CaseResolution, ValidationCase, select_cases, validation_cases};
pub use estimate::{DEFAULT_SPEED, TimeEstimate, estimate_times};
pub use grid::{ParameterGrid, VariedKey, distinguishing_labels, frame_interval, split_values};
pub use job::{Job, JobResult, JobState};
pub use order::{Convergence, convergence, least_squares};
pub use plot::{LineStyle, PlotLine, line_plot, log_log_plot};
pub use rows::{ResultRow, result_rows, rows_to_csv};
pub use sheet::StudyResults;
pub use spread::{REPEATS_NOTE, Spread, spread_table};
pub use validation::Validation;
