//! Analysis of series: error metrics against references, verdicts, moments, zero crossings, spectra, reflection, RAOs.
//! Pure functions of [`Series`](crate::math::time_series::Series) and tables; they run nothing.

mod alignment;
mod error_metrics;
pub mod format_verdicts;
mod harmonic;
mod moments;
mod rao;
mod reference_table;
mod reflection;
mod spectrum;
mod verdict;
mod zero_crossings;

pub use crate::plan::{Align, CheckWords, Reference, Score};
pub use alignment::{Aligned, Arrival, best_delay};
pub use error_metrics::{amplitude, deviation, off, peak};
pub use harmonic::{Harmonic, harmonic};
pub use moments::{Moments, moments};
pub use rao::{Band, ENOUGH, Response, response, transfer};
pub use reflection::{Reflection, reflection};
pub use spectrum::{Spectrum, spectra, spectrum, swing};
pub use verdict::{Check, Curves, Figures, Meaned, Verdict};
pub use zero_crossings::{Waves, waves};
