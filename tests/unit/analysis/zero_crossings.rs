//! Unit tests of `src/analysis/zero_crossings.rs`.

use super::*;
use crate::error::Result;
use std::f64::consts::TAU;

fn sampled(f: impl Fn(f64) -> f64, until: f64) -> Result<TimeSeries> {
    let t: Vec<f64> = (0..=(until * 100.0) as usize).map(|i| i as f64 * 0.01).collect();
    let x: Vec<f64> = t.iter().map(|&t| f(t)).collect();
    TimeSeries::new(t, x)
}

#[test]
fn the_waves_of_a_sine_have_its_period_and_twice_its_amplitude() -> Result<()> {
    let found = zero_crossing_waves(&sampled(|t| 0.5 + 0.1 * (TAU * t / 1.25).sin(), 10.0)?);
    let Some(found) = found else { panic!("a sine has waves") };
    // Crossings are interpolated linearly between samples at 0.01 s; crests are up to half of that off.
    assert_eq!(
        found.count, 6,
        "8 periods: the first begins with the record, and the last has no final upward crossing"
    );
    for (what, x, exact) in [
        ("T_z", found.mean_period, 1.25),
        ("T third", found.significant_period, 1.25),
        ("H mean", found.mean_height, 0.2),
        ("H third", found.significant_height, 0.2),
        ("H max", found.max_height, 0.2),
    ] {
        assert!((x - exact).abs() < 1e-4, "{what}: {x}");
    }
    Ok(())
}

#[test]
fn the_significant_height_is_the_mean_of_the_highest_third() -> Result<()> {
    // Groups of three waves of heights 1, 2 and 3, each a whole sine.
    let height = |t: f64| 1.0 + (t.floor() as i64).rem_euclid(3) as f64;
    let found = zero_crossing_waves(&sampled(|t| 0.5 * height(t) * (TAU * t).sin(), 30.0)?);
    let Some(found) = found else { panic!("waves") };
    assert!((found.significant_height - 3.0).abs() < 1e-2 && (found.max_height - 3.0).abs() < 1e-2, "{found:?}");
    // The first and the last wave are incomplete and do not count: 28 of 30, of which nine have the height 3.
    assert!((found.mean_height - 2.0).abs() < 0.05, "{found:?}");
    Ok(())
}

#[test]
fn round_off_has_no_waves() -> Result<()> {
    let sine = |mean: f64, size: f64| sampled(move |t| mean + size * (TAU * t / 1.25).sin(), 10.0);
    for (mean, size) in [(0.0, 5e-15), (0.0, 1e-17), (1e5, 1e-5), (3.0, 1e-13)] {
        assert_eq!(zero_crossing_waves(&sine(mean, size)?), None, "{mean} ± {size}");
    }
    for (mean, size) in [(0.0, 1e-11), (1e5, 1e-3)] {
        assert!(zero_crossing_waves(&sine(mean, size)?).is_some(), "{mean} ± {size}");
    }
    Ok(())
}

#[test]
fn a_rising_series_with_small_oscillations_has_no_waves() -> Result<()> {
    assert_eq!(zero_crossing_waves(&sampled(|t| t + 0.1 * (t * 2.0).sin(), 100.0)?), None);
    Ok(())
}

/// Over a tenth of a period a straight line lowers a crest by 5 %; over half a period it removes the crest.
#[test]
fn waves_are_unknown_over_gaps_of_more_than_a_tenth_of_their_period() -> Result<()> {
    let whole = sampled(|t| (TAU * t).sin(), 20.0)?;
    let without = |rows: std::ops::Range<usize>| {
        let mut x = whole.values().to_vec();
        x[rows].fill(f64::NAN);
        Readings::new(whole.times(), &x, false, [f64::NEG_INFINITY, f64::INFINITY]).unwrap()
    };
    // Crest at 5.25 s; the readings on both sides are 0.09 and 0.12 s apart.
    let (short, long) = (without(521..529), without(520..531));
    assert!(waves_of_readings(&short).is_some_and(|waves| waves.count == 18 && !gaps_hide_waves(&short)));
    assert!(waves_of_readings(&long).is_none() && gaps_hide_waves(&long));
    Ok(())
}
