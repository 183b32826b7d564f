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
