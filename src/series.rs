//! Values over time: interpolation and differentiation. No files.

use crate::error::{Error, Result};

/// A quantity sampled at increasing times.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Series {
    t: Vec<f64>,
    x: Vec<f64>,
}

impl Series {
    /// The series of values `x` at times `t` (s).
    ///
    /// # Errors
    /// `Scene` if the lengths differ, fewer than two samples are given, a number is not finite, or the
    /// times do not increase: says which sample.
    pub fn new(t: impl Into<Vec<f64>>, x: impl Into<Vec<f64>>) -> Result<Self> {
        let (t, x) = (t.into(), x.into());
        if t.len() != x.len() || t.len() < 2 {
            return Err(Error::scene(format!(
                "a series needs two samples or more, and a value for each time; got {} times and {} values",
                t.len(),
                x.len()
            )));
        }
        if let Some(i) = (0..t.len()).find(|&i| !t[i].is_finite() || !x[i].is_finite()) {
            return Err(Error::scene(format!("sample {} of the series is not a finite number", i + 1)));
        }
        if let Some(i) = (1..t.len()).find(|&i| t[i] <= t[i - 1]) {
            return Err(Error::scene(format!(
                "times must increase: sample {} is at {} s, after {} s",
                i + 1,
                t[i],
                t[i - 1]
            )));
        }
        Ok(Self { t, x })
    }

    /// Sample times, s.
    pub fn times(&self) -> &[f64] {
        &self.t
    }

    /// Sample values.
    pub fn values(&self) -> &[f64] {
        &self.x
    }

    /// First and last time, s.
    pub fn span(&self) -> (f64, f64) {
        (self.t[0], self.t[self.t.len() - 1])
    }

    /// Value at time `t` (s), linear between samples; the end values outside the span.
    pub fn at(&self, t: f64) -> f64 {
        let (i, s) = self.locate(t);
        self.x[i] + s * (self.x[i + 1] - self.x[i])
    }

    /// Value and rate at time `t` (s) of the smooth curve through the samples: a cubic Hermite spline
    /// with the slopes of the parabola through each sample and its neighbours, so both are continuous.
    /// Outside the span the end value, at rest.
    pub fn smooth(&self, t: f64) -> (f64, f64) {
        let (first, last) = self.span();
        if t <= first || t >= last {
            return (self.at(t), 0.0);
        }
        let (i, s) = self.locate(t);
        let step = self.t[i + 1] - self.t[i];
        let (x0, x1) = (self.x[i], self.x[i + 1]);
        let (m0, m1) = (self.slope(i) * step, self.slope(i + 1) * step);
        let (a, b) = (2.0 * (x0 - x1) + m0 + m1, 3.0 * (x1 - x0) - 2.0 * m0 - m1);
        let value = x0 + s * (m0 + s * (b + s * a));
        let rate = (m0 + s * (2.0 * b + s * 3.0 * a)) / step;
        (value, rate)
    }

    /// Interval index and the place in it (0…1) of time `t`, clamped to the span.
    fn locate(&self, t: f64) -> (usize, f64) {
        let i = self.t.partition_point(|&x| x <= t).clamp(1, self.t.len() - 1) - 1;
        let s = (t - self.t[i]) / (self.t[i + 1] - self.t[i]);
        (i, s.clamp(0.0, 1.0))
    }

    /// Slope at sample `i` of the parabola through it and its two neighbours; zero at the ends, where
    /// the motion starts and stops at rest.
    fn slope(&self, i: usize) -> f64 {
        if i == 0 || i + 1 == self.t.len() {
            return 0.0;
        }
        let (h0, h1) = (self.t[i] - self.t[i - 1], self.t[i + 1] - self.t[i]);
        let (d0, d1) = ((self.x[i] - self.x[i - 1]) / h0, (self.x[i + 1] - self.x[i]) / h1);
        (h1 * d0 + h0 * d1) / (h0 + h1)
    }
}
