//! One constant delay between a run and its reference: clocks that differ, a gate that took time to open.

use serde::{Deserialize, Serialize};

use super::error_metrics::{amplitude_ratio, relative_l2};
use crate::{math::time_series::TimeSeries, plan::Align};

/// The largest delay of either sign that [`best_delay`] looks at, s.
const MAX_DELAY: f64 = 0.3;

/// From one delay that is tried to the next, s: a hundredth of the period of the shortest waves in a tank.
const STEP: f64 = 0.002;

/// Share of the reference that must lie within the run for a delay to count, –: else the best would be that
/// which moves the difficult part out of sight.
const MIN_OVERLAP: f64 = 0.9;

/// A run against its reference once one constant delay is taken out.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AlignedMetrics {
    /// By how much the run is late, s; negative where it leads.
    pub delay: f64,
    /// Relative deviation then, –.
    #[serde(rename = "N")]
    pub relative_l2: f64,
    /// Amplitude ratio then, –.
    #[serde(rename = "M")]
    pub amplitude_ratio: f64,
}

/// When both series first pass a threshold, s; none if they never do.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ArrivalTimes {
    /// The run.
    pub run: Option<f64>,
    /// Its reference; 0 where its clock starts then.
    pub reference: Option<f64>,
}

/// The two once the delay is taken out that `align` means, and when they arrive if it says so; `sim` may
/// reach further than `window`, in which arrivals count.
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

/// The delay (s) within ±0.3 s by which `sim` is late for the least N against `reference`; none if there is
/// no such delay, as where the reference is zero.
///
/// Every 2 ms is tried, the smallest first, and the best is refined by golden sections to a microsecond.
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
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut a, mut b) = ((middle - STEP).max(-MAX_DELAY), (middle + STEP).min(MAX_DELAY));
    while b - a > 1e-6 {
        let (x, y) = (b - golden * (b - a), a + golden * (b - a));
        if n(x).unwrap_or(f64::INFINITY) <= n(y).unwrap_or(f64::INFINITY) { b = y } else { a = x }
    }
    let fine = 0.5 * (a + b);
    Some(if n(fine).is_some_and(|n| n < least) { fine } else { middle })
}

/// `reference` as much later as the run is late, where the run covers it; none if it covers too little.
fn shifted_reference(sim: &TimeSeries, reference: &TimeSeries, delay: f64) -> Option<TimeSeries> {
    let (first, last) = sim.span();
    let moved = reference.shifted(delay).window(first, last).ok()?;
    (moved.times().len() as f64 >= MIN_OVERLAP * reference.times().len() as f64).then_some(moved)
}
