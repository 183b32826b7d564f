//! Decomposition of a measured elevation into Fourier components of the record's length.

use std::f64::consts::TAU;

use super::{COMPONENTS_MAX, WaveComponent};
use crate::{
    error::{Error, Result},
    math::time_series::TimeSeries,
};

/// Fraction of the energy that the decomposition omits at each end of the spectrum, as drift and noise.
const LEFT_OUT: f64 = 0.005;

/// Returns the components η = a cos(ω t + φ) of `series` (m over s).
///
/// # Errors
/// `Scene` if the series has fewer than eight samples, is constant, or is so long that its waves have too many frequencies.
pub(super) fn fourier_components(series: &TimeSeries) -> Result<Vec<WaveComponent>> {
    let count = series.times().len();
    if count < 8 {
        return Err(Error::scene(format!("the record has {count} samples; waves need eight and more")));
    }
    let (first, last) = series.span();
    let (span, step) = (last - first, (last - first) / (count - 1) as f64);
    let samples: Vec<f64> = (0..count - 1).map(|i| series.value_at(first + step * i as f64)).collect();
    let mean = samples.iter().sum::<f64>() / samples.len() as f64;
    let many = samples.len();
    let circle: Vec<(f64, f64)> = (0..many).map(|i| (TAU * i as f64 / many as f64).sin_cos()).collect();
    let part = |n: usize| {
        let (sine, cosine) = samples.iter().enumerate().fold((0.0, 0.0), |(sine, cosine), (i, x)| {
            let (s, c) = circle[n * i % many];
            (sine + (x - mean) * s, cosine + (x - mean) * c)
        });
        let omega = TAU * n as f64 / span;
        let amplitude = 2.0 * cosine.hypot(sine) / many as f64;
        WaveComponent { amplitude, omega, phase: -sine.atan2(cosine) - omega * first }
    };
    // By Parseval's theorem, without the highest frequency of an even number of samples, whose phase is not known.
    let sign = |i: usize| if i.is_multiple_of(2) { 1.0 } else { -1.0 };
    let highest: f64 = samples.iter().enumerate().map(|(i, x)| sign(i) * (x - mean)).sum::<f64>() / many as f64;
    let highest = if many.is_multiple_of(2) { highest } else { 0.0 };
    let variance = samples.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / many as f64;
    let energy = 2.0 * (variance - highest * highest);
    if energy.is_nan() || energy <= 0.0 {
        return Err(Error::scene("nothing moves in this record"));
    }
    let (mut below, mut kept) = (0.0, Vec::new());
    for component in (1..=(many - 1) / 2).map(part) {
        if below >= 1.0 - LEFT_OUT {
            break;
        }
        below += component.amplitude.powi(2) / energy;
        if below > LEFT_OUT {
            kept.push(component);
        }
        if kept.len() > COMPONENTS_MAX {
            let what = format!("the waves of this record of {span} s have more than {COMPONENTS_MAX} frequencies");
            return Err(Error::scene(what).help("a shorter record has fewer: keep the part that the run needs"));
        }
    }
    Ok(kept)
}
