//! Guards: what they see, and what a run does about it.

use pontoon::{error::Kind, model::Model, simulation::Simulation, space::Vector};

use crate::rig;

/// A small dam break, a thousand steps of which take half a second.
fn dam_break() -> Simulation<2> {
    let dp = 0.02;
    let water = rig::lattice([0.0, 0.0], [0.2, 0.2], dp);
    rig::simulation(Model::water(2, dp, 0.2), water, 0.2, vec![rig::tank([0.6, 0.4], dp)])
}

fn steps(sim: &mut Simulation<2>, n: u32) {
    for _ in 0..n {
        sim.step().expect("a sound run");
    }
}

/// Gives the water nearest the bed's left end twice the speed of sound: no flow does that.
fn plant(sim: &mut Simulation<2>) {
    let c0 = sim.system().model().c0;
    sim.set_water_velocity(|r| if r[0] < 0.03 { Vector::from([2.0 * c0, 0.0]) } else { Vector::zeros() });
}

#[test]
fn the_first_alarm_is_answered_by_going_back_and_halving_the_step() {
    let mut sim = dam_break();
    steps(&mut sim, 700);
    let (time, limit) = (sim.time(), sim.limit());
    plant(&mut sim);
    sim.step().expect("the run goes back");
    // States are kept every 500 steps; that of step 500 is old enough, 200 steps before.
    assert_eq!(sim.steps(), 500);
    let told = sim.rescued().to_vec();
    assert_eq!(told.len(), 1);
    assert!(
        told[0].alarm.contains("speed of sound") && told[0].back_to == sim.time() && told[0].at >= time,
        "{told:?}"
    );
    // Half, but for what the flow itself asks for by then.
    assert!(sim.limit() < 0.6 * limit, "{} after {limit}", sim.limit());
    while sim.time() < told[0].halved_until {
        sim.step().expect("the good state goes on");
    }
    sim.step().expect("the good state goes on");
    assert!(sim.limit() > 0.8 * limit, "the step is whole again: {} after {limit}", sim.limit());
}

#[test]
fn an_alarm_that_returns_ends_the_run_with_its_report() {
    let mut sim = dam_break();
    steps(&mut sim, 700);
    plant(&mut sim);
    sim.step().expect("the run goes back");
    plant(&mut sim);
    let error = sim.step().expect_err("the alarm returned");
    assert_eq!(error.kind, Kind::Fault);
    assert!(error.fault.is_some_and(|fault| fault.who.starts_with("water particle")));
}

#[test]
fn a_healthy_run_is_not_changed_by_a_bit() {
    let (mut with, mut without) = (dam_break(), dam_break().without_rescue());
    steps(&mut with, 600);
    steps(&mut without, 600);
    assert!(with.rescued().is_empty());
    assert!(with.save().unwrap() == without.save().unwrap());
}
