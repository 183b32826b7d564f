//! Values over time: interpolation and differentiation.

use crate::error::{Error, Result};

/// A quantity sampled at increasing times.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct TimeSeries {
    t: Vec<f64>,
    x: Vec<f64>,
}

impl TimeSeries {
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
    pub(crate) fn span(&self) -> (f64, f64) {
        (self.t[0], self.t[self.t.len() - 1])
    }

    /// Value at time `t` (s), linear between samples; the end values outside the span.
    pub fn value_at(&self, t: f64) -> f64 {
        let (i, s) = self.locate(t);
        self.x[i] + s * (self.x[i + 1] - self.x[i])
    }

    /// Value and rate at time `t` (s) of the smooth curve through the samples: a cubic Hermite spline
    /// with the slopes of the parabola through each sample and its neighbours, so both are continuous.
    /// Outside the span the end value, at rest.
    pub(crate) fn value_and_rate(&self, t: f64) -> (f64, f64) {
        let (first, last) = self.span();
        if t <= first || t >= last {
            return (self.value_at(t), 0.0);
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

    /// The part from `from` to `until` (s).
    ///
    /// # Errors
    /// `Scene` if fewer than two samples lie there.
    pub fn window(&self, from: f64, until: f64) -> Result<Self> {
        let range = self.t.partition_point(|&t| t < from)..self.t.partition_point(|&t| t <= until);
        if range.len() < 2 {
            let (first, last) = self.span();
            return Err(Error::scene(format!(
                "fewer than two samples lie between {from} and {until} s; the series goes from {first} to {last} s"
            )));
        }
        Ok(Self { t: self.t[range.clone()].to_vec(), x: self.x[range].to_vec() })
    }

    /// The same `by` seconds later.
    pub(crate) fn shifted(&self, by: f64) -> Self {
        Self { t: self.t.iter().map(|t| t + by).collect(), x: self.x.clone() }
    }

    /// The same with `offset` taken off every value.
    pub(crate) fn minus(&self, offset: f64) -> Self {
        Self { t: self.t.clone(), x: self.x.iter().map(|x| x - offset).collect() }
    }

    /// What an instrument shows that takes the mean over `seconds`:
    ///
    ///   x̄(t) = 1/s ∫ x dt over t − s/2 … t + s/2
    ///
    /// by the trapezoid over the samples, at the same times; near an end over what there is.
    pub fn running_mean(&self, seconds: f64) -> Self {
        let mut total = vec![0.0];
        for i in 1..self.t.len() {
            total.push(total[i - 1] + 0.5 * (self.t[i] - self.t[i - 1]) * (self.x[i] + self.x[i - 1]));
        }
        let integral = |t: f64| {
            let (i, s) = self.locate(t);
            let step = s * (self.t[i + 1] - self.t[i]);
            total[i] + step * (self.x[i] + 0.5 * s * (self.x[i + 1] - self.x[i]))
        };
        let (first, last) = self.span();
        let mean = |&t: &f64| {
            let (a, b) = ((t - 0.5 * seconds).max(first), (t + 0.5 * seconds).min(last));
            (integral(b) - integral(a)) / (b - a)
        };
        Self { x: self.t.iter().map(mean).collect(), t: self.t.clone() }
    }

    /// The first time (s) at which |x| reaches `threshold`, linear between samples; none if it never does.
    pub(crate) fn first_crossing(&self, threshold: f64) -> Option<f64> {
        let i = self.x.iter().position(|x| x.abs() >= threshold)?;
        let Some(before) = i.checked_sub(1) else { return Some(self.t[0]) };
        let (x0, x1) = (self.x[before], self.x[i]);
        // |x| = threshold on the way from x0 to x1, on the side on which x1 lies.
        let s = (threshold.copysign(x1) - x0) / (x1 - x0);
        Some(self.t[before] + s * (self.t[i] - self.t[before]))
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
