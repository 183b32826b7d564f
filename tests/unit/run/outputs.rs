//! Unit tests of `src/run/outputs.rs`.

use super::OutputSchedule;

#[test]
fn an_output_is_due_once_at_each_multiple_and_missed_multiples_are_skipped() {
    let mut due = OutputSchedule { every: 0.1, next: 0 };
    let times = [0.0, 0.05, 0.1 - 1e-15, 0.15, 0.2999999999999999, 0.3, 0.31, 0.75, 0.79, 0.8];
    let taken: Vec<f64> = times.into_iter().filter(|&t| due.advance_if_due(t)).collect();
    assert_eq!(taken, [0.0, 0.1 - 1e-15, 0.2999999999999999, 0.75, 0.8]);
    let mut every_step = OutputSchedule { every: 0.0, next: 0 };
    assert!(every_step.advance_if_due(0.0) && every_step.advance_if_due(1e-6) && every_step.advance_if_due(2e-6));
    // The number of multiples exceeds the range of integers: an output is due at every step.
    let mut hardly = OutputSchedule { every: 1e-300, next: 0 };
    assert!(hardly.advance_if_due(0.0) && hardly.advance_if_due(1.0) && hardly.advance_if_due(2.0));
}
