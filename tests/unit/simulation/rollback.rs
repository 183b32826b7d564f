//! Unit tests of `src/simulation/rollback.rs`.

use super::*;
use crate::{
    geometry::Shape,
    math::Vector,
    model::Model,
    simulation::{Setup, Simulation},
    solid::SolidSpec,
};

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

/// A small dam break on `ranks`, 700 steps of which take a moment.
fn dam_break(ranks: &Ranks) -> Simulation<2> {
    let dp = 0.02;
    let place = |i: i32| Vector::from([0.01 + dp * f64::from(i % 10), 0.01 + dp * f64::from(i / 10)]);
    let water = (0..100).map(place).collect::<Vec<_>>();
    let tank = SolidSpec::fixed("tank", Shape::Tank { size: Vector::from([0.6, 0.4]), thickness: 4.0 * dp });
    let setup = Setup::<2>::new(Model::water(2, dp, 0.2)).water(water, 0.2).solid(tank);
    Simulation::on_ranks(setup, ranks).expect("a sound setup")
}

/// What each of `count` ranks returns, each a thread.
fn on_ranks<T: Send>(count: usize, work: impl Fn(&Ranks) -> T + Sync) -> Vec<T> {
    std::thread::scope(|scope| {
        let work = &work;
        let ranks = Ranks::in_threads(count).into_iter();
        let threads: Vec<_> = ranks.map(|ranks| scope.spawn(move || work(&ranks))).collect();
        threads.into_iter().map(|thread| thread.join().expect("a rank does not panic")).collect()
    })
}

/// The state of step 500 has the water that a rank had then; at the alarm, at step 680, the ranks part it otherwise.
#[test]
fn ranks_return_to_the_states_that_each_has_stored_of_its_own_water() {
    let states = |count: usize| {
        on_ranks(count, |ranks| {
            let mut sim = dam_break(ranks);
            let take = |sim: &mut Simulation<2>, steps: usize| {
                (0..steps).for_each(|_| sim.step_with_own_water(f64::INFINITY).expect("the run goes on"));
            };
            take(&mut sim, 680);
            // The state of the start is of all water, which all ranks have then.
            let is_own = sim.rollback.states.last().is_some_and(|(steps, _, state)| match state {
                StoredState::Memory(bytes) => *steps == 500 && bytes.first() == Some(&1),
                StoredState::File(_) => false,
            });
            assert_eq!(is_own, count > 1);
            sim.gather_water(true);
            let fast = 2.0 * sim.system().model().c0;
            sim.set_water_velocity(|r| if r[0] < 0.03 { Vector::from([fast, 0.0]) } else { Vector::zeros() });
            take(&mut sim, 30);
            assert_eq!(sim.rollbacks().len(), 1);
            sim.gather_water(true);
            sim.save().expect("a state")
        })
    };
    let alone = states(1).swap_remove(0);
    for count in [2, 3] {
        assert!(states(count).into_iter().all(|state| state == alone), "{count} ranks");
    }
}

/// A rank that cannot read its state keeps all from going back; a state of all water is that of the first.
#[test]
fn ranks_go_back_if_all_have_a_state() {
    let shared =
        |states: [&'static [u8]; 2]| on_ranks(2, move |ranks| shared_state(ranks, states[ranks.rank()].to_vec()));
    assert_eq!(shared([&[1, 7], &[1, 8]]), [[1, 7], [1, 8]]);
    assert_eq!(shared([&[1, 7], &[]]), [[0; 0], [0; 0]]);
    assert_eq!(shared([&[0, 7], &[]]), [[0, 7], [0, 7]]);
    assert_eq!(shared([&[], &[]]), [[0; 0], [0; 0]]);
}

/// What is written on all ranks at once is, on the first, what one process writes.
#[test]
fn the_first_rank_writes_the_state_of_all() {
    let written = |count: usize| {
        on_ranks(count, |ranks| {
            let mut sim = dam_break(ranks);
            (0..50).for_each(|_| sim.step_with_own_water(f64::INFINITY).expect("a sound run"));
            let mut bytes = Vec::new();
            sim.write_state(0, &mut bytes).expect("memory takes all");
            assert!(count == 1 || !sim.system().status.has_all_water, "no rank has all water");
            bytes
        })
    };
    let alone = written(1).swap_remove(0);
    for count in [2, 3] {
        assert!(written(count).swap_remove(0) == alone, "{count} ranks");
    }
}
