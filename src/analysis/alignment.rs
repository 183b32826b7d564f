//! Removal of one constant delay between a run and its reference, for example from different clocks or the opening time
//! of a gate.

use serde::{Deserialize, Serialize};

use super::error_metrics::{amplitude_ratio, relative_l2};
use crate::{math::time_series::TimeSeries, plan::Align};

/// Largest magnitude of the delays that [`best_delay`] tries, s.
const MAX_DELAY: f64 = 0.3;

/// Interval between the delays that [`best_delay`] tries, s: a hundredth of the period of the shortest waves in a tank.
const STEP: f64 = 0.002;

/// Smallest share of the reference that must lie within the run for a valid delay, –. Otherwise the best delay could
/// exclude the difficult part of the reference.
const MIN_OVERLAP: f64 = 0.9;

/// Metrics of a run and its reference after removal of one constant delay.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AlignedMetrics {
    /// Delay of the run, s; negative where the run leads.
    pub delay: f64,
    /// Relative deviation after removal of the delay, –.
    #[serde(rename = "N")]
    pub relative_l2: f64,
    /// Amplitude ratio after removal of the delay, –.
    #[serde(rename = "M")]
    pub amplitude_ratio: f64,
}

/// Times at which both series first pass a threshold, s; `None` if a series never passes it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ArrivalTimes {
    /// Arrival time in the run.
    pub run: Option<f64>,
    /// Arrival time in the reference; 0 where the reference's clock starts at the arrival.
    pub reference: Option<f64>,
}

/// Returns the metrics after removal of the delay that `align` defines, and the arrival times if `align` sets a
/// threshold. `sim` may extend beyond `window`, which limits the arrivals.
pub(crate) fn align(
    sim: &TimeSeries,
    reference: &TimeSeries,
    align: Align,
    window: (f64, f64),
) -> (Option<AlignedMetrics>, Option<ArrivalTimes>) {
    let (delay, arrival) = match align {
        Align::Crossing(threshold) => {
            let run = sim.window(window.0, window.1).ok().and_then(|sim| sim.first_crossing(threshold));
            let arrival = ArrivalTimes { run, reference: reference.first_crossing(threshold) };
            (arrival.run.zip(arrival.reference).map(|(run, reference)| run - reference), Some(arrival))
        }
        Align::Start(_) => (None, None),
        Align::Best => (best_delay(sim, reference), None),
    };
    let aligned = delay.and_then(|delay| {
        let moved = shifted_reference(sim, reference, delay)?;
        Some(AlignedMetrics {
            delay,
            relative_l2: relative_l2(sim, &moved).ok()?,
            amplitude_ratio: amplitude_ratio(sim, &moved).ok()?,
        })
    });
    (aligned, arrival)
}

/// Returns the delay (s) of `sim` within ±0.3 s for which N against `reference` is least. Returns `None` if no such delay
/// exists, for example where the reference is zero, or if it is the first or last that can be tried: N then goes on falling.
///
/// The function tries every 2 ms, in order of magnitude, and refines the best delay by golden-section search to a
/// microsecond.
/// ```
/// # use pontoon::{analysis::best_delay, math::time_series::TimeSeries};
/// let t: Vec<f64> = (0..400).map(|i| 0.01 * i as f64).collect();
/// let wave = |late: f64| t.iter().map(|t| (3.0 * (t - late)).sin()).collect::<Vec<_>>();
/// let (sim, reference) = (TimeSeries::new(t.clone(), wave(0.05))?, TimeSeries::new(t.clone(), wave(0.0))?);
/// let delay = best_delay(&sim, &reference.window(0.5, 3.5)?).unwrap();
/// assert!((delay - 0.05).abs() < 1e-4);
/// # Ok::<(), pontoon::Error>(())
/// ```
pub fn best_delay(sim: &TimeSeries, reference: &TimeSeries) -> Option<f64> {
    let n = |delay: f64| shifted_reference(sim, reference, delay).and_then(|moved| relative_l2(sim, &moved).ok());
    let count = (MAX_DELAY / STEP).round() as i32;
    let mut best: Option<(f64, f64)> = None;
    for i in (0..=count).flat_map(|i| [i, -i]) {
        let delay = f64::from(i) * STEP;
        if let Some(n) = n(delay)
            && best.is_none_or(|(_, least)| n < least)
        {
            best = Some((delay, n));
        }
    }
    let (middle, least) = best?;
    let around = [middle - STEP, middle + STEP];
    let is_tried = |delay: f64| delay.abs() <= MAX_DELAY + 0.5 * STEP && n(delay).is_some();
    if !around.into_iter().all(is_tried) {
        return None;
    }
    let fine = least_by_golden_section(around, 1e-6, |delay| n(delay).unwrap_or(f64::INFINITY));
    Some(if n(fine).is_some_and(|n| n < least) { fine } else { middle })
}

/// Returns the position of the only minimum of `f` in the range from `a` to `b`, to `tolerance`.
pub(super) fn least_by_golden_section([mut a, mut b]: [f64; 2], tolerance: f64, f: impl Fn(f64) -> f64) -> f64 {
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    while b - a > tolerance {
        let (x, y) = (b - golden * (b - a), a + golden * (b - a));
        if f(x) <= f(y) { b = y } else { a = x }
    }
    0.5 * (a + b)
}

/// Returns `reference` shifted by the delay of the run, over the times of the run, or `None` if the run covers too
/// little of it.
fn shifted_reference(sim: &TimeSeries, reference: &TimeSeries, delay: f64) -> Option<TimeSeries> {
    let (first, last) = sim.span();
    let moved = reference.shifted(delay).window(first, last).ok()?;
    (moved.times().len() as f64 >= MIN_OVERLAP * reference.times().len() as f64).then_some(moved)
}
