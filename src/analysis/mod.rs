//! Analysis of series: error metrics against references, verdicts, moments, zero crossings, spectra, reflection, RAOs.
//! Pure functions of [`TimeSeries`](crate::math::time_series::TimeSeries) and tables; they run nothing.

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

pub use crate::plan::Align;
pub use crate::plan::CheckPlan;
pub use crate::plan::Reference;
pub use crate::plan::Score;
pub use error_metrics::amplitude_ratio;
pub use error_metrics::first_peak_error;
pub use error_metrics::max_abs;
pub use error_metrics::relative_l2;
pub use harmonic::Harmonic;
pub use harmonic::harmonic;
pub(crate) use moments::moments; //NARROW
pub(crate) use rao::MIN_WAVES_FOR_RAO; //NARROW
pub use rao::RaoPoint;
pub(crate) use rao::rao; //NARROW
pub(crate) use rao::rao_over_frequency; //NARROW
pub(crate) use reflection::reflection; //NARROW
pub(crate) use spectrum::complex_amplitudes; //NARROW
pub(crate) use spectrum::displayed_spectrum; //NARROW
pub(crate) use spectrum::spectrum; //NARROW
pub(crate) use verdict::CheckCurves; //NARROW
pub use verdict::ErrorMetrics;
pub use verdict::ReferenceCheck;
pub use verdict::Verdict;
pub(crate) use zero_crossings::zero_crossing_waves; //NARROW
pub use alignment::AlignedMetrics;
pub use alignment::ArrivalTimes;
pub use verdict::RunningMeanMetrics;
