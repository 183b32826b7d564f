//! Unit tests of `src/output/interval_mean.rs`.

use super::IntervalMean;

#[test]
fn a_mean_is_that_of_the_line_through_the_readings_and_gaps_do_not_count() {
    let mut mean = IntervalMean::default();
    mean.add(0.0, vec![1.0, f64::NAN, 0.0]);
    assert_eq!(mean.take(1)[0], 1.0, "of a single reading it is the reading");
    mean.add(1.0, vec![3.0, 5.0, 1.0]);
    mean.add(2.0, vec![3.0, 7.0, 4.0]);
    assert_eq!(mean.take(1), [2.5, 6.0, 4.0], "2 and 3 over a second each; 6 where it was known; the total itself");
    mean.add(2.5, vec![5.0, 7.0, 5.0]);
    assert_eq!(mean.take(1), [4.0, 7.0, 5.0], "it begins anew where the row before was written");
}
