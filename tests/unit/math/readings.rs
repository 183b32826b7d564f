//! Unit tests of `src/math/readings.rs`.

use super::*;

const ALL: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

#[test]
fn a_mean_belongs_to_the_middle_of_its_interval_and_counts_for_its_length() {
    // Rows at 0, 1, 3 and 4 s: the second mean covers two seconds.
    let of = Readings::new(&[0.0, 1.0, 3.0, 4.0], &[9.0, 1.0, 2.0, 3.0], true, ALL).unwrap();
    assert_eq!(of.series().times(), [0.0, 0.5, 2.0, 3.5]);
    assert_eq!(of.weights(), Some(&[0.0, 1.0, 2.0, 1.0][..]));
    // The interval of a mean begins at the previous row, also if that row is empty.
    let of = Readings::new(&[0.0, 1.0, 2.0, 3.0], &[9.0, 1.0, f64::NAN, 3.0], true, ALL).unwrap();
    assert_eq!((of.series().times(), of.weights()), (&[0.0, 0.5, 2.5][..], Some(&[0.0, 1.0, 1.0][..])));
    // The middle of an interval decides on which side of a time limit it lies.
    let of = Readings::new(&[0.0, 1.0, 2.0, 3.0], &[9.0, 1.0, 2.0, 3.0], true, [1.0, 2.6]).unwrap();
    assert_eq!(of.series().values(), [2.0, 3.0]);
}

#[test]
fn empty_rows_between_readings_are_gaps_and_those_before_and_after_are_none() {
    let none = f64::NAN;
    let t: Vec<f64> = (0..8).map(f64::from).collect();
    let of = Readings::new(&t, &[none, 1.0, 2.0, none, none, 5.0, 6.0, none], false, ALL).unwrap();
    assert_eq!((of.missing_share(), of.longest_gap()), (2.0 / 6.0, 3.0));
    // Each reading counts for half the interval to each neighbouring row, the first and the last to one side.
    assert_eq!(of.weights(), Some(&[0.5, 1.0, 1.0, 0.5][..]));
    let whole = Readings::new(&t, &t, false, ALL).unwrap();
    assert_eq!((whole.weights(), whole.missing_share(), whole.longest_gap()), (None, 0.0, 0.0));
    assert!(Readings::new(&t, &[none, none, 1.0, none, none, none, none, none], false, ALL).is_none());
}
