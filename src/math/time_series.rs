//! Values over time: interpolation and differentiation.

use super::format::three_digits;
use crate::error::{Error, Result};

/// Largest distance of the parabola's tangent from the chord, over the range, at a sample of a dense record. A sine with
/// 18 samples a period has it.
const DENSE: f64 = 1.0 / 32.0;

/// Largest overshoot at the end of a hold of a dense record, over the range.
const HOLD_OVERSHOOT: f64 = 5e-4;

/// Number of equal intervals that make a hold. Shorter ones come from the resolution of an instrument.
const HOLD: usize = 4;

/// Relative round-off of times.
const ROUND_OFF: f64 = 1e-12;

/// How the samples of a table become those of a run: x · `scale` at the times t · `time_factor` + `offset`.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct SampleScaling {
    /// Factor on the values, –.
    pub scale: f64,
    /// Factor on the times, –; positive.
    pub time_factor: f64,
    /// Time added to the times, s.
    pub offset: f64,
}

impl Default for SampleScaling {
    fn default() -> Self {
        Self { scale: 1.0, time_factor: 1.0, offset: 0.0 }
    }
}

/// A quantity sampled at increasing times.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct TimeSeries {
    t: Vec<f64>,
    x: Vec<f64>,
    /// Largest value minus least value.
    range: f64,
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
        Ok(Self::of_valid(t, x))
    }

    /// The series of valid samples.
    fn of_valid(t: Vec<f64>, x: Vec<f64>) -> Self {
        let (least, most) = x.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(*x), b.max(*x)));
        Self { t, x, range: most - least }
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

    /// Value and rate at time `t` (s) of the smooth curve through the samples, both continuous. The curve is a cubic
    /// Hermite spline. Its slope at a sample is that of the parabola through the sample and its neighbours, limited
    /// where the record is not dense so that the curve stays between its samples @hyman1983. Outside the span the curve
    /// has the end value, at rest.
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
            let [first, last] = [first, last].map(three_digits);
            return Err(Error::scene(format!(
                "fewer than two samples lie between {from} and {until} s; the series goes from {first} to {last} s"
            )));
        }
        Ok(Self::of_valid(self.t[range.clone()].to_vec(), self.x[range].to_vec()))
    }

    /// The same `by` seconds later.
    pub(crate) fn shifted(&self, by: f64) -> Self {
        Self { t: self.t.iter().map(|t| t + by).collect(), ..self.clone() }
    }

    /// The same samples in the scale and on the clock of a run.
    ///
    /// # Errors
    /// As [`TimeSeries::new`], as for a time factor that is not positive.
    pub(crate) fn scaled(&self, by: &SampleScaling) -> Result<Self> {
        let times: Vec<f64> = self.t.iter().map(|t| t * by.time_factor + by.offset).collect();
        Self::new(times, self.x.iter().map(|x| x * by.scale).collect::<Vec<f64>>())
    }

    /// The same with `offset` taken off every value.
    pub(crate) fn minus(&self, offset: f64) -> Self {
        Self::of_valid(self.t.clone(), self.x.iter().map(|x| x - offset).collect())
    }

    /// The reading of an instrument that takes the mean over `seconds`:
    ///
    ///   x̄(t) = 1/s ∫ x dt over t − s/2 … t + s/2
    ///
    /// by the trapezoidal rule over the samples, at those sample times whose whole interval lies within the span.
    ///
    /// # Errors
    /// `Scene` if there are fewer than two such times.
    pub fn running_mean(&self, seconds: f64) -> Result<Self> {
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
        // Round-off may leave the end of an interval slightly outside.
        let slack = ROUND_OFF * (last - first);
        let is_whole = |t: &f64| t - 0.5 * seconds >= first - slack && t + 0.5 * seconds <= last + slack;
        let times: Vec<f64> = self.t.iter().copied().filter(is_whole).collect();
        let mean = |&t: &f64| {
            let (a, b) = ((t - 0.5 * seconds).max(first), (t + 0.5 * seconds).min(last));
            (integral(b) - integral(a)) / (b - a)
        };
        let means: Vec<f64> = times.iter().map(mean).collect();
        Self::new(times, means).map_err(|_| {
            Error::scene(format!("a mean over {seconds} s needs a longer series than that from {first} to {last} s"))
        })
    }

    /// The first time (s) at which |x| reaches `threshold`, linear between samples; none if it never does, or is beyond it at the
    /// first sample: the time is before the samples then.
    pub(crate) fn first_crossing(&self, threshold: f64) -> Option<f64> {
        let i = self.x.iter().position(|x| x.abs() >= threshold)?;
        let Some(before) = i.checked_sub(1) else {
            return (self.x[0].abs() <= threshold * (1.0 + ROUND_OFF)).then_some(self.t[0]);
        };
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

    /// Length (s) and slope of interval `i`.
    fn interval(&self, i: usize) -> (f64, f64) {
        let step = self.t[i + 1] - self.t[i];
        (step, (self.x[i + 1] - self.x[i]) / step)
    }

    /// Slope of the curve at sample `i`; zero at the ends, where the motion starts and stops at rest.
    ///
    /// It is the slope of the parabola through the sample and its neighbours. If the record is not dense there, the
    /// slope lies between zero and three times that of each adjacent interval. This is sufficient for a monotone curve
    /// @fritsch1980, and the slope is zero where the record turns. A dense record keeps the parabola,
    /// except where it holds a value: there the curve leaves the value by [`HOLD_OVERSHOOT`] at most.
    fn slope(&self, i: usize) -> f64 {
        let last = self.t.len() - 1;
        if i == 0 || i == last {
            return 0.0;
        }
        let ((h0, d0), (h1, d1)) = (self.interval(i - 1), self.interval(i));
        let parabola = (h1 * d0 + h0 * d1) / (h0 + h1);
        let dense = (i - 1..=i + 1).all(|k| self.tangent_distance(k) <= DENSE * self.range);
        let holds = |k: usize| k + HOLD <= last && (k..k + HOLD).all(|k| self.x[k] == self.x[k + 1]);
        if dense && !holds(i) && !i.checked_sub(HOLD).is_some_and(holds) {
            return parabola;
        }
        [(h0, d0), (h1, d1)].into_iter().fold(parabola, |slope, (h, d)| {
            // s (1 − s)² of the unit interval is 4/27 at most.
            let more = if dense { 27.0 / 4.0 * HOLD_OVERSHOOT * self.range / h } else { 0.0 };
            slope.clamp((3.0 * d).min(0.0) - more, (3.0 * d).max(0.0) + more)
        })
    }

    /// Distance of the parabola's tangent at sample `i` from the chord, at the other end of the longer adjacent
    /// interval; zero at the ends.
    fn tangent_distance(&self, i: usize) -> f64 {
        if i == 0 || i + 1 == self.t.len() {
            return 0.0;
        }
        let ((h0, d0), (h1, d1)) = (self.interval(i - 1), self.interval(i));
        (d1 - d0).abs() * h0.max(h1).powi(2) / (h0 + h1)
    }
}

#[cfg(test)]
#[path = "../../tests/unit/math/time_series.rs"]
mod tests;
