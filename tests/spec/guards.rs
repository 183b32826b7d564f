//! Guards: what they see, and what a run does about it.

use pontoon::{
    error::Kind,
    model::Model,
    simulation::{Escape, Limits, Setup, Simulation},
    space::{Bounds, Vector},
};

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

/// A block of water that falls out of a domain whose sides are a metre away, with these limits.
fn falling(limits: Limits) -> Simulation<2> {
    let dp = 0.02;
    let water = rig::lattice([0.0, 0.0], [0.1, 0.1], dp);
    let levels = vec![0.1; water.len()];
    let mut setup = Setup::new(Model::water(2, dp, 10.0), water, levels, vec![]);
    setup.domain = Some(Bounds { min: Vector::from([-1.0, -0.05]), max: Vector::from([1.1, 1.0]) });
    setup.limits = limits;
    Simulation::new(setup).expect("a sound setup").without_rescue()
}

#[test]
fn a_particle_that_leaves_stops_the_run_unless_it_is_to_be_removed() {
    let mut stops = falling(Limits::default());
    let error = (0..10_000).find_map(|_| stops.step().err()).expect("the water falls out");
    assert!(error.to_string().contains("escape from the domain"), "{error}");
    let mut goes_on = falling(Limits { escape: Escape::Remove, ..Limits::default() });
    while goes_on.system().fluid().len() > 5 {
        goes_on.step().expect("those that leave are taken out");
    }
    // Twenty of twenty-five are gone, each listed once, below the domain, on its way down.
    let lost = goes_on.lost();
    assert_eq!(lost.len(), 25 - goes_on.system().fluid().len());
    let mut ids: Vec<u32> =
        lost.iter().map(|(_, lost)| lost.id).chain(goes_on.system().fluid().id.iter().copied()).collect();
    ids.sort_unstable();
    assert!(ids.iter().copied().eq(0..25), "{ids:?}");
    for (t, lost) in lost {
        assert!(*t > 0.0 && lost.r[1] < -0.05 && lost.v[1] < 0.0, "{t} {lost:?}");
        assert!(lost.way.to_string().contains("through"), "{lost:?}");
    }
}

#[test]
fn a_run_that_lost_particles_goes_on_to_the_same_bits() {
    let limits = Limits { escape: Escape::Remove, ..Limits::default() };
    let mut whole = falling(limits);
    while whole.lost().is_empty() {
        whole.step().unwrap();
    }
    let kept = whole.save().unwrap();
    let mut again = falling(limits);
    again.restore(&kept).unwrap();
    for sim in [&mut whole, &mut again] {
        (0..50).for_each(|_| sim.step().unwrap());
    }
    assert!(whole.save().unwrap() == again.save().unwrap());
}

#[test]
fn density_and_speed_are_held_within_the_bounds_of_the_scene() {
    for (limits, word) in [
        (Limits { density: [0.9, 1.1], ..Limits::default() }, "guard.density"),
        (Limits { speed: 0.1, ..Limits::default() }, "guard.speed"),
    ] {
        let plant = |sim: &mut Simulation<2>| {
            let c0 = sim.system().model().c0;
            match word {
                "guard.density" => sim.set_water_density(|_| 1150.0),
                _ => sim.set_water_velocity(|_| Vector::from([0.2 * c0, 0.0])),
            }
        };
        let (mut narrow, mut usual) = (falling(limits), falling(Limits::default()));
        plant(&mut narrow);
        plant(&mut usual);
        let error = narrow.step().expect_err("outside what the scene allows");
        assert!(error.to_string().contains(word), "{error}");
        usual.step().expect("inside what is usual");
    }
}
