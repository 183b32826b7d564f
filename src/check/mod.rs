//! Checks: how far a run is from what was measured or is known. They run nothing.

mod measure;
mod verdict;

pub use crate::plan::Score;
pub use measure::{amplitude, deviation, peak};
pub use verdict::{Check, Verdict};
