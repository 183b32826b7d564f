//! Unit tests of `src/analysis/response.rs`.

use std::f64::consts::TAU;

use super::*;
use crate::error::Result;

fn series(from: f64, until: f64, x: impl Fn(f64) -> f64) -> Result<TimeSeries> {
    let times: Vec<f64> = (0..).map(|i| from + 0.01 * f64::from(i)).take_while(|t| *t <= until).collect();
    let values: Vec<f64> = times.iter().map(|t| x(*t)).collect();
    TimeSeries::new(times, values)
}

fn reference(ratio: f64, lag: Option<f64>) -> ResponseReference {
    ResponseReference { to: "gauge.eta_m".into(), period: 1.2, ratio, lag, from: None, until: None }
}

#[test]
fn a_drift_and_a_mean_do_not_count_as_amplitude_and_the_period_met_is_found() -> Result<()> {
    let x = |t: f64| 5.0 + 0.025 * t + 0.0222 * (TAU * t / 1.221 - 0.7).cos();
    let Some(found) = fundamental(&series(7.5, 13.6, x)?, 1.2) else { panic!("it swings") };
    // The model holds exactly; the search ends at 1e-9 of the frequency.
    assert!((found.amplitude - 0.0222).abs() < 1e-9 && (found.period - 1.221).abs() < 1e-7, "{found:?}");
    assert!((found.drift - 0.025).abs() < 1e-9, "{found:?}");
    Ok(())
}

#[test]
fn a_response_has_the_ratio_lag_and_period_with_which_it_was_made() -> Result<()> {
    let wave = series(4.0, 7.6, |t| 0.02 * (TAU * t / 1.2).cos())?;
    let motion = series(7.5, 13.6, |t| 1.0 - 0.01 * t + 0.03 * (TAU * (t / 1.2 - 0.3)).cos())?;
    let Some(exact) = Response::new(&motion, &wave, &reference(1.5, Some(1.3))) else { panic!("both swing") };
    let metrics = exact.metrics();
    // Round-off and the end of the search; whole periods of a lag mean nothing.
    assert!(metrics.relative_l2.is_some_and(|n| n < 1e-5) && metrics.period.is_some_and(|p| p < 1e-7), "{metrics:?}");
    let Some(late) = Response::new(&motion, &wave, &reference(3.0, Some(0.05))) else { panic!("both swing") };
    let (metrics, aligned) = (late.metrics(), late.aligned());
    // Half the amplitude a quarter of a period late: N² = ½² + 1.
    assert!(metrics.relative_l2.is_some_and(|n| (n - 1.25_f64.sqrt()).abs() < 1e-5), "{metrics:?}");
    let Some(aligned) = aligned else { panic!("the reference has a lag") };
    assert!((aligned.delay - 0.3).abs() < 1e-5 && (aligned.relative_l2 - 0.5).abs() < 1e-5, "{aligned:?}");
    // Without a lag only the amplitude counts, and the expected motion lies on that of the run.
    let Some(free) = Response::new(&motion, &wave, &reference(1.5, None)) else { panic!("both swing") };
    assert!(free.metrics().relative_l2.is_some_and(|n| n < 1e-9) && free.aligned().is_none());
    let off = free.expected(motion.times()).iter().zip(motion.values()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off < 1e-7, "{off}");
    Ok(())
}

#[test]
fn less_than_two_periods_or_a_series_at_rest_have_no_response() -> Result<()> {
    let short = series(0.0, 2.3, |t| t.sin())?;
    assert!(fundamental(&short, 1.2).is_none());
    assert!(fundamental(&series(0.0, 5.0, |_| 0.0)?, 1.2).is_none(), "nothing swings");
    Ok(())
}
