//! Unit tests of `src/simulation/rollback.rs`.

use super::*;

/// The state of a run on one rank.
fn own(state: Vec<u8>) -> Vec<u8> {
    state
}

#[test]
fn a_rollback_uses_a_state_of_sufficient_age_and_a_recurring_alarm_has_none() {
    let mut rollback = RollbackControl::default();
    assert!(rollback.needs_state(0));
    for step in [0, 500, 1000] {
        rollback.drop_oldest_state();
        rollback.store(step, step as f64 * 1e-3, StoredState::Memory(vec![(step / 500) as u8]));
    }
    assert!(rollback.needs_state(1500) && !rollback.needs_state(1501));
    // The state of step 1000 is too recent.
    assert_eq!(rollback.state_before("speed", 1050, 1.05, own), Some(vec![1]));
    let log = &rollback.log[0];
    assert_eq!((log.back_to, log.at), (0.5, 1.05));
    assert!((log.halved_until - 1.6).abs() < 1e-12);
    assert_eq!((rollback.step_factor(1.0), rollback.step_factor(1.7)), (0.5, 1.0));
    rollback.store(900, 0.9, StoredState::Memory(vec![9]));
    assert_eq!(rollback.state_before("speed", 1200, 1.2, own), None, "the alarm recurs while the step is halved");
    assert!(rollback.state_before("speed", 9000, 9.0, own).is_some(), "a later alarm is independent");
    rollback.store(9500, 9.5, StoredState::Memory(Vec::new()));
    assert_eq!(rollback.state_before("speed", 99_000, 99.0, own), None, "a state that cannot be read");
    assert_eq!(RollbackControl::disabled().state_before("speed", 9000, 9.0, own), None);
}

#[test]
fn a_state_in_a_folder_has_no_name_there_and_returns_its_bytes() -> io::Result<()> {
    let folder = std::env::temp_dir().join(format!("pontoon-rollback-{}", std::process::id()));
    fs::create_dir_all(&folder)?;
    let mut rollback = RollbackControl::default();
    for step in [0, 500] {
        rollback.drop_oldest_state();
        let state = StoredState::in_folder(&folder, |out| out.write_all(&[(step / 2) as u8, 7]))?;
        rollback.store(step, step as f64 * 1e-3, state);
    }
    assert_eq!(fs::read_dir(&folder)?.count(), 0);
    fs::remove_dir(&folder)?;
    assert_eq!(rollback.state_before("speed", 700, 0.7, own), Some(vec![250, 7]));
    Ok(())
}
