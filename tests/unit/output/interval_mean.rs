//! Unit tests of `src/output/interval_mean.rs`.

use super::IntervalMean;

/// The last column is a total.
const MEANS: [bool; 3] = [true, true, false];

#[test]
fn an_interval_mean_is_the_trapezoidal_mean_without_gaps() {
    let mut mean = IntervalMean::default();
    mean.add(0.0, vec![1.0, f64::NAN, 0.0]);
    assert_eq!(mean.take(&MEANS)[0], 1.0, "the mean of a single reading is the reading");
    mean.add(1.0, vec![3.0, 5.0, 1.0]);
    mean.add(2.0, vec![3.0, 7.0, 4.0]);
    assert_eq!(
        mean.take(&MEANS),
        [2.5, 6.0, 4.0],
        "2 and 3 over a second each; 6 over the interval with readings; the total itself"
    );
    mean.add(2.5, vec![5.0, 7.0, 5.0]);
    assert_eq!(mean.take(&MEANS), [4.0, 7.0, 5.0], "the next interval starts at the previous row");
}
