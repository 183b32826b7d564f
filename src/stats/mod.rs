//! What is said of series after a run: extremes and means, waves between crossings, spectra, what is reflected, how a
//! motion answers a wave, at one frequency and over all. Pure functions of [`TimeSeries`](crate::math::time_series::Series): no files.

mod harmonic;
mod moments;
mod reflection;
mod response;
mod spectrum;
mod waves;

pub use harmonic::{Harmonic, harmonic};
pub use moments::{Moments, moments};
pub use reflection::{Reflection, reflection};
pub use response::{Band, ENOUGH, Response, response, transfer};
pub use spectrum::{Spectrum, spectra, spectrum, swing};
pub use waves::{Waves, waves};
