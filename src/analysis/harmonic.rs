//! The harmonic component of a series at a known period.

use std::f64::consts::TAU;

use nalgebra::{Matrix4, Vector4};

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

/// A series by least squares: x(t) ≈ mean + drift · (t − middle) + cosine · cos ω(t − origin) + sine · sin ω(t − origin), with the
/// middle of the record.
pub(super) struct LeastSquares {
    omega: f64,
    origin: f64,
    /// Middle and half of the record, s.
    pub(super) middle: f64,
    half: f64,
    /// Mean, drift over half of the record, cosine and sine, in the unit of the series.
    found: Vector4<f64>,
}

impl LeastSquares {
    /// Returns the fit of `series` with the angular frequency `omega` (1/s) and the phase zero at `origin` (s), with a drift if
    /// `has_drift`. Returns `None` if the samples do not determine it.
    pub(super) fn new(series: &TimeSeries, omega: f64, origin: f64, has_drift: bool) -> Option<Self> {
        let (first, last) = series.span();
        let (middle, half) = (0.5 * (first + last), 0.5 * (last - first));
        let mut fit = Self { omega, origin, middle, half, found: Vector4::zeros() };
        let (mut normal, mut right) = (Matrix4::zeros(), Vector4::zeros());
        for (&t, &x) in series.times().iter().zip(series.values()) {
            let row = fit.row(t);
            normal += row * row.transpose();
            right += row * x;
        }
        if !has_drift {
            // Its equation alone has the solution 0.
            normal.row_mut(1).fill(0.0);
            normal.column_mut(1).fill(0.0);
            (normal[(1, 1)], right[1]) = (1.0, 0.0);
        }
        fit.found = normal.cholesky()?.solve(&right);
        fit.found.iter().all(|x| x.is_finite()).then_some(fit)
    }

    fn row(&self, t: f64) -> Vector4<f64> {
        let (sin, cos) = (self.omega * (t - self.origin)).sin_cos();
        Vector4::new(1.0, (t - self.middle) / self.half, cos, sin)
    }

    /// Returns its value at the time `t` (s).
    pub(super) fn value(&self, t: f64) -> f64 {
        self.found.dot(&self.row(t))
    }

    /// Returns its drift, in the unit of the series over s.
    pub(super) fn drift(&self) -> f64 {
        self.found[1] / self.half
    }

    /// Returns its mean and its harmonic.
    pub(super) fn harmonic(&self) -> Harmonic {
        let [mean, _, cos, sin] = self.found.into();
        Harmonic { mean, amplitude: cos.hypot(sin), phase: (-sin).atan2(cos) }
    }
}

/// Returns the harmonic of angular frequency `omega` (1/s) in `series`, by least squares over the samples. The fit is
/// exact for a series without other components than a mean and a drift, whatever the sample times; in less than two periods a
/// drift is not fitted. Returns `None` if the samples do not determine the harmonic, for example if they are too few.
pub fn harmonic(series: &TimeSeries, omega: f64) -> Option<Harmonic> {
    let (first, last) = series.span();
    let has_drift = (last - first) * omega >= MIN_PERIODS * TAU;
    LeastSquares::new(series, omega, 0.0, has_drift).map(|fit| fit.harmonic())
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
