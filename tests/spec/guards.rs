//! Guards: what they see, and what a run does about it.

use pontoon::{
    error::ErrorKind,
    geometry::Shape,
    math::Vector,
    model::Model,
    run::{self, InspectOptions},
    simulation::{Escape, ParticleLimits, Setup, Simulation},
    solid::Role,
};

use crate::rig::{self, Home};

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
    let (time, limit) = (sim.time(), sim.step_limit());
    plant(&mut sim);
    sim.step().expect("the run goes back");
    // States are kept every 500 steps; that of step 500 is old enough, 200 steps before.
    assert_eq!(sim.steps(), 500);
    let told = sim.rollbacks().to_vec();
    assert_eq!(told.len(), 1);
    assert!(
        told[0].alarm.contains("speed of sound") && told[0].back_to == sim.time() && told[0].at >= time,
        "{told:?}"
    );
    // Half, but for what the flow itself asks for by then.
    assert!(sim.step_limit() < 0.6 * limit, "{} after {limit}", sim.step_limit());
    while sim.time() < told[0].halved_until {
        sim.step().expect("the good state goes on");
    }
    sim.step().expect("the good state goes on");
    assert!(sim.step_limit() > 0.8 * limit, "the step is whole again: {} after {limit}", sim.step_limit());
}

#[test]
fn an_alarm_that_returns_ends_the_run_with_its_report() {
    let mut sim = dam_break();
    steps(&mut sim, 700);
    plant(&mut sim);
    sim.step().expect("the run goes back");
    plant(&mut sim);
    let error = sim.step().expect_err("the alarm returned");
    assert_eq!(error.kind, ErrorKind::Fault);
    assert!(error.fault.is_some_and(|fault| fault.who.starts_with("water particle")));
}

#[test]
fn a_run_that_was_rescued_goes_on_with_half_the_step_after_a_restart() {
    let mut whole = dam_break();
    steps(&mut whole, 700);
    plant(&mut whole);
    steps(&mut whole, 20);
    let kept = whole.save().unwrap();
    let mut again = dam_break();
    again.restore(&kept).unwrap();
    assert!(whole.time() < whole.rollbacks()[0].halved_until && again.rollbacks() == whole.rollbacks());
    // Past the time of half steps: 400 of them.
    steps(&mut whole, 900);
    steps(&mut again, 900);
    assert!(whole.time() > whole.rollbacks()[0].halved_until);
    assert!(whole.save().unwrap() == again.save().unwrap());
}

#[test]
fn a_healthy_run_is_not_changed_by_a_bit() {
    let (mut with, mut without) = (dam_break(), dam_break().without_rollback());
    steps(&mut with, 600);
    steps(&mut without, 600);
    assert!(with.rollbacks().is_empty());
    assert!(with.save().unwrap() == without.save().unwrap());
}

/// A block of water that falls out of a domain whose sides are a metre away, with these limits.
fn falling(limits: ParticleLimits) -> Simulation<2> {
    let dp = 0.02;
    let water = rig::lattice([0.0, 0.0], [0.1, 0.1], dp);
    let setup =
        Setup::<2>::new(Model::water(2, dp, 10.0)).water(water, 0.1).domain([-1.0, -0.05], [1.1, 1.0]).limits(limits);
    Simulation::new(setup).expect("a sound setup").without_rollback()
}

#[test]
fn a_particle_that_leaves_stops_the_run_unless_it_is_to_be_removed() {
    let mut stops = falling(ParticleLimits::default());
    let error = (0..10_000).find_map(|_| stops.step().err()).expect("the water falls out");
    assert!(error.to_string().contains("escape from the domain"), "{error}");
    let mut goes_on = falling(ParticleLimits::default().escape(Escape::Remove));
    while goes_on.system().fluid().len() > 5 {
        goes_on.step().expect("those that leave are taken out");
    }
    // Twenty of twenty-five are gone, each listed once, below the domain, on its way down.
    let lost = goes_on.removed_particles();
    assert_eq!(lost.len(), 25 - goes_on.system().fluid().len());
    let mut ids: Vec<u32> =
        lost.iter().map(|(_, lost)| lost.id).chain(goes_on.system().fluid().id.iter().copied()).collect();
    ids.sort_unstable();
    assert!(ids.iter().copied().eq(0..25), "{ids:?}");
    for (t, lost) in lost {
        assert!(*t > 0.0 && lost.r[1] < -0.05 && lost.v[1] < 0.0, "{t} {lost:?}");
        assert!(lost.exit.to_string().contains("through"), "{lost:?}");
    }
}

#[test]
fn who_falls_from_higher_than_water_stood_went_over_a_wall() {
    // Thrown up by v²/2g = 0.32 m, three supports and more above where it stood, it leaves below, as splash does beside a tank.
    let mut thrown = falling(ParticleLimits::default().escape(Escape::Remove));
    thrown.set_water_velocity(|_| Vector::from([0.0, 2.5]));
    while thrown.removed_particles().is_empty() {
        thrown.step().expect("those that leave are taken out");
    }
    for (_, lost) in thrown.removed_particles() {
        assert!(lost.r[1] < -0.05 && lost.exit.to_string().contains("over a wall"), "{lost:?}");
    }
}

#[test]
fn a_run_that_lost_particles_goes_on_to_the_same_bits() {
    let limits = ParticleLimits::default().escape(Escape::Remove);
    let mut whole = falling(limits);
    while whole.removed_particles().is_empty() {
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
        (ParticleLimits::default().density(0.9, 1.1), "guard.density"),
        (ParticleLimits::default().speed(0.1), "guard.speed"),
    ] {
        let plant = |sim: &mut Simulation<2>| {
            let c0 = sim.system().model().c0;
            match word {
                "guard.density" => sim.set_water_density(|_| 1150.0),
                _ => sim.set_water_velocity(|_| Vector::from([0.2 * c0, 0.0])),
            }
        };
        let (mut narrow, mut usual) = (falling(limits), falling(ParticleLimits::default()));
        plant(&mut narrow);
        plant(&mut usual);
        let error = narrow.step().expect_err("outside what the scene allows");
        assert!(error.to_string().contains(word), "{error}");
        usual.step().expect("inside what is usual");
    }
}

#[test]
fn what_is_not_finite_is_told_by_the_step_that_sees_it() {
    for what in ["velocity", "density"] {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut sim = falling(ParticleLimits::default());
            sim.step().expect("a sound start");
            match what {
                "velocity" => sim.set_water_velocity(|r| Vector::repeat(if r[0] < 0.02 { bad } else { 0.0 })),
                _ => sim.set_water_density(|r| if r[0] < 0.02 { bad } else { 1000.0 }),
            }
            let fault = sim.step().expect_err(what).fault.expect("a fault");
            // The step before and this one.
            assert!(fault.who.starts_with("water particle") && fault.step <= 2, "{what} {bad}: {fault:?}");
        }
    }
}

/// A box beside some water that flies out of the domain, 0.5 m off, at 10 m/s.
fn thrown() -> Simulation<2> {
    let dp = 0.02;
    let water = rig::lattice([0.0, 0.0], [0.2, 0.2], dp);
    let mut float = rig::float(Shape::Box { size: Vector::from([0.1, 0.1]) }, [0.5, 0.6], 500.0);
    if let Role::Free(body) = &mut float.role {
        body.velocity = Vector::from([10.0, 0.0]);
    }
    let setup = Setup::<2>::new(Model::water(2, dp, 0.2))
        .water(water, 0.2)
        .solids([rig::tank([0.2, 0.4], dp), float])
        .domain([-1.0, -1.0], [1.0, 1.0]);
    Simulation::new(setup).expect("a sound setup").without_rollback()
}

#[test]
fn a_body_that_leaves_is_named_with_its_step_also_after_a_restart() {
    let mut whole = thrown();
    steps(&mut whole, 20);
    let kept = whole.save().unwrap();
    let mut again = thrown();
    again.restore(&kept).unwrap();
    let [first, second] = [&mut whole, &mut again].map(|sim| {
        let error = (0..1000).find_map(|_| sim.step().err()).expect("it flies out");
        assert!(error.to_string().contains("escape from the domain of body \"float\""), "{error}");
        *error.fault.expect("a fault")
    });
    // Half a metre at 10 m/s; the step in which its centre went over the side.
    assert!((first.time - 0.05).abs() < 1e-3 && first.position[0] > 1.0, "{first:?}");
    assert_eq!((first.step, first.time), (second.step, second.time));
    assert_eq!(first.step, whole.steps(), "the step that could not be made, counted from the start of the run");
}

#[test]
fn a_timing_stops_at_the_first_alarm_and_tells_it() {
    // A paddle at up to 30 m/s where sound has 10 m/s.
    let scene = "dimension = 2\ndp = 0.02\nuntil = 1.0\n\
        water = [{ fill = { box = { min = [0.0, 0.0], max = [1.0, 0.1] } } }]\n\
        [[solid]]\nname = \"tank\"\nfixed = true\nshape = { tank = { size = [1.0, 0.3] } }\n\
        [[solid]]\nname = \"paddle\"\nshape = { box = { size = [0.1, 0.2] } }\nat = { x = 0.3, bottom = 0.0 }\n\
        driven = { along = [1.0, 0.0], distance = { formula = \"0.1*sin(300*t)\" } }\n";
    let home = Home::with("timing-alarm", scene);
    let asked = InspectOptions { threads: Some(1), timing: true, ..InspectOptions::default() };
    let report = run::inspect(&home.0.join("scene.toml"), &asked).unwrap();
    let told = report.preflight.findings.iter().find(|finding| finding.topic == "breaks_down").expect("it breaks down");
    let after = |word: &str| told.what.split(word).nth(1).and_then(|rest| rest.split([' ', ',']).next());
    let count = |word: &str| after(word).and_then(|number| number.parse::<u64>().ok()).unwrap_or_default();
    // "after 9 steps: ... step 10, t = ...": a run that went back meanwhile would have made more steps than it tells of.
    assert_eq!(count("after ") + 1, count(", step "), "{}", told.what);
}
