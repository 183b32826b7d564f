//! Unit tests of `src/simulation/rollback.rs`.

use super::*;

#[test]
fn a_run_goes_back_far_enough_and_only_while_that_helps() {
    let mut rescue = RollbackControl::default();
    assert!(rescue.needs_state(0));
    for step in [0, 500, 1000] {
        rescue.drop_oldest_state();
        rescue.store(step, step as f64 * 1e-3, vec![(step / 500) as u8]);
    }
    assert!(rescue.needs_state(1500) && !rescue.needs_state(1501));
    // The state of step 1000 is too young.
    assert_eq!(rescue.state_before("speed", 1050, 1.05), Some(vec![1]));
    let log = &rescue.log[0];
    assert_eq!((log.back_to, log.at), (0.5, 1.05));
    assert!((log.halved_until - 1.6).abs() < 1e-12);
    assert_eq!((rescue.step_factor(1.0), rescue.step_factor(1.7)), (0.5, 1.0));
    rescue.store(900, 0.9, vec![9]);
    assert_eq!(rescue.state_before("speed", 1200, 1.2), None, "it returned while the step was halved");
    assert!(rescue.state_before("speed", 9000, 9.0).is_some(), "later trouble is other trouble");
    assert_eq!(RollbackControl::disabled().state_before("speed", 9000, 9.0), None);
}
