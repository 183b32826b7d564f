//! Measures of the difference between two series: deviation N, amplitude M, first peak, largest difference.

use crate::{
    error::{Error, Result},
    math::time_series::TimeSeries,
};

/// Returns the relative deviation of a simulated series from a measured series: 0 is perfect.
///
///   N = √( Σ (sim_i − ref_i)² / Σ ref_i² )
///
/// `sim` and `reference` are values over time (s) in the same unit, with at least two samples each. The function
/// interpolates `sim` linearly to the reference's times. Returns N (–). Use [`amplitude_ratio`] to compare the
/// magnitudes alone.
///
/// # Errors
/// `Scene` if the reference extends beyond the simulated span (the error names both spans; shorten the reference or
/// lengthen the run). `Scene` also if the reference is zero throughout (use [`amplitude_ratio`] with both series
/// exchanged).
///
/// Source: @pirkhalili2023, eq. (26).
/// ```
/// # use pontoon::{analysis::relative_l2, math::time_series::TimeSeries};
/// let reference = TimeSeries::new([0.0, 1.0, 2.0], [3.0, 4.0, 0.0])?;
/// let sim = TimeSeries::new([0.0, 2.0], [3.0, 3.0])?;   // off by 0, −1, 3
/// assert_eq!(relative_l2(&sim, &reference)?, (10.0_f64 / 25.0).sqrt());
/// # Ok::<(), pontoon::Error>(())
/// ```
pub fn relative_l2(sim: &TimeSeries, reference: &TimeSeries) -> Result<f64> {
    relative_norm(sim, reference, |s, r| (s - r) * (s - r))
}

/// Returns the amplitude of a simulated series relative to a measured series: 1 is perfect.
///
///   M = √( Σ sim_i² / Σ ref_i² )
///
/// Arguments and errors as for [`relative_l2`]. Returns M (–).
///
/// Source: @pirkhalili2023, eq. (27).
/// ```
/// # use pontoon::{analysis::amplitude_ratio, math::time_series::TimeSeries};
/// let reference = TimeSeries::new([0.0, 1.0, 2.0], [3.0, 4.0, 0.0])?;
/// let sim = TimeSeries::new([0.0, 2.0], [6.0, 6.0])?;
/// assert_eq!(amplitude_ratio(&sim, &reference)?, (108.0_f64 / 25.0).sqrt());
/// # Ok::<(), pontoon::Error>(())
/// ```
pub fn amplitude_ratio(sim: &TimeSeries, reference: &TimeSeries) -> Result<f64> {
    relative_norm(sim, reference, |s, _| s * s)
}

/// Returns the relative error of the first peak, for example of the first impact on a wall: 0 is perfect.
///
///   |peak_sim − peak_ref| / |peak_ref|
///
/// The first peak is the largest |x| of the first stretch in which |x| is at least half the largest |x| of the series.
/// Ripples before the peak therefore do not count. A stretch whose largest |x| is the first or the last sample has no
/// peak: the series may grow beyond it. Each series has its own first peak, and their times may differ. Returns the
/// error (–).
///
/// # Errors
/// `Scene` if the reference is zero throughout, or if one of the series has no peak.
/// ```
/// # use pontoon::{analysis::first_peak_error, math::time_series::TimeSeries};
/// let t = [0.0, 1.0, 2.0, 3.0, 4.0];
/// let reference = TimeSeries::new(t, [0.0, 1.0, 8.0, 2.0, 10.0])?;   // first peak 8
/// let sim = TimeSeries::new(t, [0.0, 0.0, 1.0, 6.0, 2.0])?;          // 6
/// assert_eq!(first_peak_error(&sim, &reference)?, 0.25);
/// # Ok::<(), pontoon::Error>(())
/// ```
pub fn first_peak_error(sim: &TimeSeries, reference: &TimeSeries) -> Result<f64> {
    let peak = |series: &TimeSeries, name: &str| {
        first_peak(series.values()).ok_or_else(|| {
            Error::scene(format!("{name} has no peak in the time range: its maximum is at an end"))
                .help("choose a range that begins before the peak and ends after it")
        })
    };
    if reference.values().iter().all(|x| *x == 0.0) {
        return Err(all_zero());
    }
    let expected = peak(reference, "the reference")?;
    Ok((peak(sim, "the run")? - expected).abs() / expected.abs())
}

/// Returns the largest absolute difference of a simulated series from its reference: 0 is perfect. The measure is also
/// defined where the reference is zero.
///
///   max |sim_i − ref_i|
///
/// Arguments as for [`relative_l2`]. Returns the difference, in the unit of the series.
///
/// # Errors
/// `Scene` if the reference extends beyond the simulated span.
/// ```
/// # use pontoon::{analysis::max_abs, math::time_series::TimeSeries};
/// let still = TimeSeries::new([0.0, 1.0, 2.0], [0.0, 0.0, 0.0])?;
/// let sim = TimeSeries::new([0.0, 2.0], [0.0, -0.5])?;
/// assert_eq!(max_abs(&sim, &still)?, 0.5);
/// # Ok::<(), pontoon::Error>(())
/// ```
pub fn max_abs(sim: &TimeSeries, reference: &TimeSeries) -> Result<f64> {
    require_coverage(sim, reference)?;
    let pairs = reference.times().iter().zip(reference.values());
    Ok(pairs.map(|(&t, &r)| (sim.value_at(t) - r).abs()).fold(0.0, f64::max))
}

/// Returns the value of the first peak, with its sign; `None` if every stretch above half of the largest |x| is largest at the
/// start or at the end of the series.
fn first_peak(x: &[f64]) -> Option<f64> {
    let half = 0.5 * x.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let is_high = |i: &usize| x[*i].abs() >= half;
    let all: Vec<usize> = (0..x.len()).collect();
    let mut stretches = all.chunk_by(|a, b| is_high(a) == is_high(b)).filter(|stretch| is_high(&stretch[0]));
    let peak = |stretch: &[usize]| {
        let peak = stretch.iter().fold(0.0, |peak: f64, &i| if x[i].abs() > peak.abs() { x[i] } else { peak });
        let is_at_end = [0, x.len() - 1].iter().any(|end| stretch.contains(end) && x[*end].abs() == peak.abs());
        (!is_at_end).then_some(peak)
    };
    stretches.find_map(peak)
}

/// Returns √( Σ term(sim_i, ref_i) / Σ ref_i² ) over the reference's times.
fn relative_norm(sim: &TimeSeries, reference: &TimeSeries, term: impl Fn(f64, f64) -> f64) -> Result<f64> {
    require_coverage(sim, reference)?;
    let size: f64 = reference.values().iter().map(|r| r * r).sum();
    if size == 0.0 {
        return Err(all_zero());
    }
    let pairs = reference.times().iter().zip(reference.values());
    let sum: f64 = pairs.map(|(&t, &r)| term(sim.value_at(t), r)).sum();
    Ok((sum / size).sqrt())
}

/// Refuses a reference that extends beyond the simulated span.
fn require_coverage(sim: &TimeSeries, reference: &TimeSeries) -> Result<()> {
    let (inner, outer) = (reference.span(), sim.span());
    if inner.0 < outer.0 || inner.1 > outer.1 {
        let what = format!(
            "the reference spans {} to {} s, the simulated series only {} to {} s",
            inner.0, inner.1, outer.0, outer.1
        );
        return Err(Error::scene(what).help("lengthen the run (`until`), or shorten the reference"));
    }
    Ok(())
}

fn all_zero() -> Error {
    Error::scene("the reference is zero throughout, so nothing can be relative to it")
        .help("compare with a quantity that is not zero, such as the level instead of its change")
}
