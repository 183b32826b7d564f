//! The harmonic component of a series at a known period.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};

use crate::math::time_series::TimeSeries;

/// Least number of periods in a fit with a drift: with fewer, a drift and a harmonic look alike.
pub(super) const MIN_PERIODS: f64 = 2.0;

/// Harmonic component of a series: x(t) ≈ mean + drift · (t − middle) + amplitude · cos(ωt + phase), with the middle of the
/// record.
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
/// exact for a series without other components than a mean and a drift, whatever the sample times; in less than two periods a
/// drift is not fitted. Returns `None` if the samples do not determine the harmonic, for example if they are too few.
pub fn harmonic(series: &TimeSeries, omega: f64) -> Option<Harmonic> {
    let (first, last) = series.span();
    let (middle, half) = (0.5 * (first + last), 0.5 * (last - first));
    let has_drift = 2.0 * half * omega >= MIN_PERIODS * TAU;
    let row = |t: f64| {
        let mut row = vec![1.0, (omega * t).cos(), (omega * t).sin()];
        row.extend(has_drift.then_some((t - middle) / half));
        DVector::from(row)
    };
    let size = 3 + usize::from(has_drift);
    let (mut normal, mut right) = (DMatrix::zeros(size, size), DVector::zeros(size));
    for (&t, &x) in series.times().iter().zip(series.values()) {
        let row = row(t);
        normal += &row * row.transpose();
        right += row * x;
    }
    let found = normal.cholesky()?.solve(&right);
    let (mean, cos, sin) = (found[0], found[1], found[2]);
    let swings = found.iter().all(|x| x.is_finite());
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

    #[test]
    fn a_drift_beside_the_swing_does_not_count() -> Result<()> {
        let period = 1.1;
        let swing = |until: f64, drift: f64| {
            let t: Vec<f64> = (0..=(until / 0.01) as usize).map(|i| 0.01 * i as f64).collect();
            let x: Vec<f64> = t.iter().map(|t| 0.3 + drift * t + 0.03 * (TAU * t / period - 0.7).cos()).collect();
            TimeSeries::new(t, x)
        };
        // A mean and a harmonic alone would take 0.2 T/π = 0.07 of the drift for a swing. Less than two periods have no drift.
        for (until, drift) in [(20.0, 0.2), (2.3, 0.2), (1.5, 0.0)] {
            let Some(found) = harmonic(&swing(until, drift)?, TAU / period) else { panic!("it swings") };
            let error = (found.amplitude - 0.03).abs().max((found.phase + 0.7).abs());
            assert!(error < 1e-10, "the model holds exactly, so only round-off is left; got {error:e} in {until} s");
        }
        Ok(())
    }
}
