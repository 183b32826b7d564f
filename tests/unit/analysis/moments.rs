//! Unit tests of `src/analysis/moments.rs`.

use super::*;
use crate::error::Result;

#[test]
fn the_mean_of_a_ramp_is_its_middle_and_its_deviation_is_its_length_over_root_twelve() -> Result<()> {
    let t: Vec<f64> = (0..=1000).map(|i| f64::from(i) * 1e-3).collect();
    let of = moments(&TimeSeries::new(t.clone(), t)?);
    assert!((of.mean - 0.5).abs() < 1e-12, "the trapezoid is exact for a line; got {}", of.mean);
    let error = of.standard_deviation * 12.0_f64.sqrt() - 1.0;
    assert!(error.abs() < 1e-5, "of second order in a step of 1e-3; off by {error:e}");
    assert_eq!((of.min, of.max, of.last), ((0.0, 0.0), (1.0, 1.0), 1.0));
    Ok(())
}

/// A value of 1 for two seconds and of 3 for one, with rows at uneven times, has the mean 5/3 and the variance 8/9.
#[test]
fn means_count_for_their_intervals_and_gaps_do_not_count() {
    let all = [f64::NEG_INFINITY, f64::INFINITY];
    let means = Readings::new(&[0.0, 0.5, 2.0, 3.0], &[9.0, 1.0, 1.0, 3.0], true, all).unwrap();
    let of = moments_of_readings(&means);
    assert!((of.mean - 5.0 / 3.0).abs() < 1e-15 && (of.standard_deviation.powi(2) - 8.0 / 9.0).abs() < 1e-15, "{of:?}");
    // Eleven readings of 1, a gap of a hundred rows, and eleven of 3: a line across the gap would count it as well.
    let t: Vec<f64> = (0..122).map(f64::from).collect();
    let value = |i: usize| {
        if i < 11 {
            1.0
        } else if i < 111 {
            f64::NAN
        } else {
            3.0
        }
    };
    let x: Vec<f64> = (0..122).map(value).collect();
    let of = moments_of_readings(&Readings::new(&t, &x, false, all).unwrap());
    assert!((of.mean - 2.0).abs() < 1e-15 && (of.standard_deviation - 1.0).abs() < 1e-15, "{of:?}");
}
