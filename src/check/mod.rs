//! Checks: how far a run is from what was measured or is known. They run nothing.

mod align;
mod measure;
pub mod said;
mod table;
mod verdict;

pub use crate::plan::{Align, CheckWords, Reference, Score};
pub use align::{Aligned, Arrival, best_delay};
pub use measure::{amplitude, deviation, off, peak};
pub use verdict::{Check, Curves, Figures, Meaned, Verdict};
