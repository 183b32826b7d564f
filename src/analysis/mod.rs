//! Analysis of series: error metrics against references, verdicts, moments, zero crossings, spectra, reflection, RAOs.
//! Pure functions of [`TimeSeries`](crate::math::time_series::TimeSeries) and tables; they run nothing.

mod alignment;
mod error_metrics;
pub mod format_verdicts;
mod harmonic;
mod moments;
mod rao;
mod reflection;
mod response;
mod spectrum;
mod verdict;
mod zero_crossings;

pub use crate::plan::{Align, CheckPlan, Reference, ResponseReference, Score};
pub use alignment::best_delay;
pub use alignment::{AlignedMetrics, ArrivalTimes};
pub use error_metrics::{amplitude_ratio, first_peak_error, max_abs, relative_l2};
pub use harmonic::{Harmonic, harmonic};
pub(crate) use moments::{moments, moments_of_readings};
pub use rao::RaoPoint;
pub(crate) use rao::{MIN_WAVES_FOR_RAO, rao, rao_over_frequency};
pub(crate) use reflection::reflection;
pub(crate) use spectrum::{complex_amplitudes, displayed_spectrum, spectrum};
pub use verdict::CheckCurves;
pub use verdict::{ErrorMetrics, ReferenceCheck, RunningMeanMetrics, Verdict};
pub(crate) use zero_crossings::{LARGEST_GAP, gaps_hide_waves, waves_of_readings, zero_crossing_waves};
