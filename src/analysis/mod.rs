//! Analysis of series: error metrics against references, verdicts, moments, zero crossings, spectra, reflection, RAOs.
//! Pure functions of [`TimeSeries`](crate::math::time_series::TimeSeries) and tables; they run nothing.

mod alignment;
mod error_metrics;
pub mod format_verdicts; //HIDE
mod harmonic;
mod moments;
mod rao;
mod reference_table;
mod reflection;
mod spectrum;
mod verdict;
mod zero_crossings;

pub use crate::plan::Align; //HIDE
pub use crate::plan::CheckPlan; //HIDE
pub use crate::plan::Reference; //HIDE
pub use crate::plan::Score; //HIDE
pub(crate) use alignment::AlignedMetrics; //NARROW
pub(crate) use alignment::ArrivalTimes; //NARROW
pub(crate) use alignment::best_delay; //NARROW
pub use error_metrics::amplitude_ratio; //HIDE
pub use error_metrics::first_peak_error; //HIDE
pub use error_metrics::max_abs; //HIDE
pub use error_metrics::relative_l2; //HIDE
pub use harmonic::Harmonic; //HIDE
pub use harmonic::harmonic; //HIDE
pub(crate) use moments::Moments; //NARROW
pub(crate) use moments::moments; //NARROW
pub(crate) use rao::MIN_WAVES_FOR_RAO; //NARROW
pub(crate) use rao::Rao; //NARROW
pub(crate) use rao::RaoPoint; //NARROW
pub(crate) use rao::rao; //NARROW
pub(crate) use rao::rao_over_frequency; //NARROW
pub(crate) use reflection::Reflection; //NARROW
pub(crate) use reflection::reflection; //NARROW
pub(crate) use spectrum::WelchSpectrum; //NARROW
pub(crate) use spectrum::complex_amplitudes; //NARROW
pub(crate) use spectrum::displayed_spectrum; //NARROW
pub(crate) use spectrum::spectrum; //NARROW
pub(crate) use verdict::CheckCurves; //NARROW
pub(crate) use verdict::ErrorMetrics; //NARROW
pub use verdict::ReferenceCheck; //HIDE
pub(crate) use verdict::RunningMeanMetrics; //NARROW
pub use verdict::Verdict; //HIDE
pub(crate) use zero_crossings::ZeroCrossingWaves; //NARROW
pub(crate) use zero_crossings::zero_crossing_waves; //NARROW
