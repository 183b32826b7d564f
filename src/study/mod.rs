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

pub use cases::{Case, Extent, cases, find};
pub use estimate::{Planned, USUAL, plan};
pub use grid::{Grid, Vary, heads, interval, split};
pub use job::{Job, Ran, State};
pub use order::{Convergence, convergence, least_squares};
pub use plot::{Line, Style, curves, log_log};
pub use rows::{Row, csv, rows};
pub use sheet::Sheet;
pub use spread::{CHANCE, Spread, spreads};
pub use validation::Validation;
