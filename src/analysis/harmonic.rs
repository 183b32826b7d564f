//! The harmonic component of a series at a known period.

use nalgebra::{Matrix3, Vector3};

use crate::math::time_series::TimeSeries;

/// Harmonic component of a series: x(t) ≈ mean + amplitude · cos(ωt + phase).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Harmonic {
    /// Mean, in the unit of the series.
    pub mean: f64,
    /// Amplitude, in the unit of the series.
    pub amplitude: f64,
    /// Phase, rad.
    pub phase: f64,
}

/// Returns the harmonic of angular frequency `omega` (1/s) in `series`, by least squares over the samples. The fit is
/// exact for a series without other components, whatever the sample times. Returns `None` if the samples do not
/// determine the harmonic, for example if they are too few.
pub fn harmonic(series: &TimeSeries, omega: f64) -> Option<Harmonic> {
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for (&t, &x) in series.times().iter().zip(series.values()) {
        let row = Vector3::new(1.0, (omega * t).cos(), (omega * t).sin());
        normal += row * row.transpose();
        right += row * x;
    }
    let found = normal.cholesky()?.solve(&right);
    let [mean, cos, sin] = found.into();
    let swings = mean.is_finite() && cos.is_finite() && sin.is_finite();
    swings.then(|| Harmonic { mean, amplitude: cos.hypot(sin), phase: (-sin).atan2(cos) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Result;

    #[test]
    fn a_swing_is_found_exactly_between_uneven_samples() -> Result<()> {
        let t: Vec<f64> = (0..200).map(|i| 0.031 * f64::from(i) + 0.004 * f64::from(i * i % 7)).collect();
        let x: Vec<f64> = t.iter().map(|t| 0.3 + 0.05 * (5.0 * t + 1.2).cos()).collect();
        let Some(found) = harmonic(&TimeSeries::new(t, x)?, 5.0) else { panic!("it swings") };
        let error = (found.mean - 0.3).abs().max((found.amplitude - 0.05).abs()).max((found.phase - 1.2).abs());
        assert!(error < 1e-12, "the model holds exactly, so only round-off is left; got {error:e}");
        Ok(())
    }
}
