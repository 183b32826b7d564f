//! Step checks and rollback: particles outside the limits or the domain, the response of a run, and restart after it.

use pontoon::{
    error::ErrorKind,
    geometry::Shape,
    math::Vector,
    model::Model,
    run::{self, InspectOptions},
    simulation::{Escape, ParticleLimits, Setup, Simulation},
    solid::Role,
};

use crate::common::{self, TestFolder};

/// A small dam break, a thousand steps of which take half a second.
fn dam_break() -> Simulation<2> {
    let dp = 0.02;
    let water = common::lattice([0.0, 0.0], [0.2, 0.2], dp);
    common::simulation(Model::water(2, dp, 0.2), water, 0.2, vec![common::tank([0.6, 0.4], dp)])
}

/// Sets water at the left end of the bed to twice the speed of sound, which no flow reaches.
fn set_supersonic(sim: &mut Simulation<2>) {
    let c0 = sim.system().model().c0;
    sim.set_water_velocity(|r| if r[0] < 0.03 { Vector::from([2.0 * c0, 0.0]) } else { Vector::zeros() });
}

#[test]
fn the_first_alarm_rolls_the_run_back_and_halves_the_step() {
    let mut sim = dam_break();
    common::steps(&mut sim, 700);
    let (time, limit) = (sim.time(), sim.step_limit());
    set_supersonic(&mut sim);
    sim.step().expect("the run rolls back");
    // The run keeps a state every 500 steps. That of step 500 is old enough, 200 steps before the alarm.
    assert_eq!(sim.steps(), 500);
    let rollbacks = sim.rollbacks().to_vec();
    assert_eq!(rollbacks.len(), 1);
    assert!(
        rollbacks[0].alarm.contains("speed of sound") && rollbacks[0].back_to == sim.time() && rollbacks[0].at >= time,
        "{rollbacks:?}"
    );
    // Half of the limit, apart from its change with the flow.
    assert!(sim.step_limit() < 0.6 * limit, "{} after {limit}", sim.step_limit());
    while sim.time() < rollbacks[0].halved_until {
        sim.step().expect("the restored state is sound");
    }
    sim.step().expect("the restored state is sound");
    assert!(sim.step_limit() > 0.8 * limit, "the full step is restored: {} after {limit}", sim.step_limit());
}

#[test]
fn an_alarm_that_recurs_after_a_rollback_ends_the_run_with_a_fault() {
    let mut sim = dam_break();
    common::steps(&mut sim, 700);
    set_supersonic(&mut sim);
    sim.step().expect("the run rolls back");
    set_supersonic(&mut sim);
    let error = sim.step().expect_err("the alarm recurs");
    assert_eq!(error.kind, ErrorKind::Fault);
    assert!(error.fault.is_some_and(|fault| fault.who.starts_with("water particle")));
}

#[test]
fn a_run_after_a_rollback_keeps_the_halved_step_across_a_restart() {
    let mut whole = dam_break();
    common::steps(&mut whole, 700);
    set_supersonic(&mut whole);
    common::steps(&mut whole, 20);
    let saved = whole.save().unwrap();
    let mut again = dam_break();
    again.restore(&saved).unwrap();
    assert!(whole.time() < whole.rollbacks()[0].halved_until && again.rollbacks() == whole.rollbacks());
    // 900 steps pass the period of 400 halved steps.
    common::steps(&mut whole, 900);
    common::steps(&mut again, 900);
    assert!(whole.time() > whole.rollbacks()[0].halved_until);
    assert!(whole.save().unwrap() == again.save().unwrap());
}

#[test]
fn rollback_changes_no_bit_of_a_run_without_alarms() {
    let (mut with, mut without) = (dam_break(), dam_break().without_rollback());
    common::steps(&mut with, 600);
    common::steps(&mut without, 600);
    assert!(with.rollbacks().is_empty());
    assert!(with.save().unwrap() == without.save().unwrap());
}

/// A block of water that falls out of its domain, with these limits.
fn falling(limits: ParticleLimits) -> Simulation<2> {
    let dp = 0.02;
    let water = common::lattice([0.0, 0.0], [0.1, 0.1], dp);
    let setup =
        Setup::<2>::new(Model::water(2, dp, 10.0)).water(water, 0.1).domain([-1.0, -0.05], [1.1, 1.0]).limits(limits);
    Simulation::new(setup).expect("a sound setup").without_rollback()
}

#[test]
fn a_particle_that_leaves_the_domain_stops_the_run_unless_escape_is_remove() {
    let mut stopping = falling(ParticleLimits::default());
    let error = (0..10_000).find_map(|_| stopping.step().err()).expect("the water falls out");
    assert!(error.to_string().contains("escape from the domain"), "{error}");
    let mut removing = falling(ParticleLimits::default().escape(Escape::Remove));
    while removing.system().fluid().len() > 5 {
        removing.step().expect("those that leave are taken out");
    }
    // Twenty of twenty-five particles are removed. Each is listed once, below the domain and moving down.
    let lost = removing.removed_particles();
    assert_eq!(lost.len(), 25 - removing.system().fluid().len());
    let mut ids: Vec<u32> =
        lost.iter().map(|(_, lost)| lost.id).chain(removing.system().fluid().id.iter().copied()).collect();
    ids.sort_unstable();
    assert!(ids.iter().copied().eq(0..25), "{ids:?}");
    for (t, lost) in lost {
        assert!(*t > 0.0 && lost.r[1] < -0.05 && lost.v[1] < 0.0, "{t} {lost:?}");
        assert!(lost.exit.to_string().contains("through"), "{lost:?}");
    }
}

#[test]
fn a_particle_that_falls_from_above_the_initial_water_is_recorded_as_over_a_wall() {
    // The water rises by v²/2g = 0.32 m, more than three support radii, and leaves below, as splash beside a tank does.
    let mut thrown = falling(ParticleLimits::default().escape(Escape::Remove));
    thrown.set_water_velocity(|_| Vector::from([0.0, 2.5]));
    while thrown.removed_particles().is_empty() {
        thrown.step().expect("particles that leave are removed");
    }
    for (_, lost) in thrown.removed_particles() {
        assert!(lost.r[1] < -0.05 && lost.exit.to_string().contains("over a wall"), "{lost:?}");
    }
}

#[test]
fn a_resumed_run_with_removed_particles_reaches_the_same_bits() {
    let limits = ParticleLimits::default().escape(Escape::Remove);
    let mut whole = falling(limits);
    while whole.removed_particles().is_empty() {
        whole.step().unwrap();
    }
    let saved = whole.save().unwrap();
    let mut again = falling(limits);
    again.restore(&saved).unwrap();
    for sim in [&mut whole, &mut again] {
        (0..50).for_each(|_| sim.step().unwrap());
    }
    assert!(whole.save().unwrap() == again.save().unwrap());
}

#[test]
fn density_and_speed_outside_the_limits_of_the_scene_stop_the_run() {
    for (limits, word) in [
        (ParticleLimits::default().density(0.9, 1.1), "guard.density"),
        (ParticleLimits::default().speed(0.1), "guard.speed"),
    ] {
        let exceed = |sim: &mut Simulation<2>| {
            let c0 = sim.system().model().c0;
            match word {
                "guard.density" => sim.set_water_density(|_| 1150.0),
                _ => sim.set_water_velocity(|_| Vector::from([0.2 * c0, 0.0])),
            }
        };
        let (mut narrow, mut usual) = (falling(limits), falling(ParticleLimits::default()));
        exceed(&mut narrow);
        exceed(&mut usual);
        let error = narrow.step().expect_err("outside the limits of the scene");
        assert!(error.to_string().contains(word), "{error}");
        usual.step().expect("inside the default limits");
    }
}

#[test]
fn a_value_that_is_not_finite_stops_the_run_at_its_step() {
    for what in ["velocity", "density"] {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut sim = falling(ParticleLimits::default());
            sim.step().expect("a sound start");
            match what {
                "velocity" => sim.set_water_velocity(|r| Vector::repeat(if r[0] < 0.02 { bad } else { 0.0 })),
                _ => sim.set_water_density(|r| if r[0] < 0.02 { bad } else { 1000.0 }),
            }
            let fault = sim.step().expect_err(what).fault.expect("a fault");
            // The step before the change and the step after it.
            assert!(fault.who.starts_with("water particle") && fault.step <= 2, "{what} {bad}: {fault:?}");
        }
    }
}

/// A box beside some water that flies out of the domain, 0.5 m off, at 10 m/s.
fn thrown() -> Simulation<2> {
    let dp = 0.02;
    let water = common::lattice([0.0, 0.0], [0.2, 0.2], dp);
    let mut float = common::float(Shape::Box { size: Vector::from([0.1, 0.1]) }, [0.5, 0.6], 500.0);
    if let Role::Free(body) = &mut float.role {
        body.velocity = Vector::from([10.0, 0.0]);
    }
    let setup = Setup::<2>::new(Model::water(2, dp, 0.2))
        .water(water, 0.2)
        .solids([common::tank([0.2, 0.4], dp), float])
        .domain([-1.0, -1.0], [1.0, 1.0]);
    Simulation::new(setup).expect("a sound setup").without_rollback()
}

#[test]
fn a_body_that_leaves_the_domain_is_named_with_its_step_also_after_a_restart() {
    let mut whole = thrown();
    common::steps(&mut whole, 20);
    let saved = whole.save().unwrap();
    let mut again = thrown();
    again.restore(&saved).unwrap();
    let [first, second] = [&mut whole, &mut again].map(|sim| {
        let error = (0..1000).find_map(|_| sim.step().err()).expect("the body leaves the domain");
        assert!(error.to_string().contains("escape from the domain of body \"float\""), "{error}");
        *error.fault.expect("a fault")
    });
    // Half a metre at 10 m/s: the step in which the centre passes the side of the domain.
    assert!((first.time - 0.05).abs() < 1e-3 && first.position[0] > 1.0, "{first:?}");
    assert_eq!((first.step, first.time), (second.step, second.time));
    assert_eq!(first.step, whole.steps(), "the number of the failed step counts from the start of the run");
}

#[test]
fn a_timing_stops_at_the_first_alarm_and_reports_it() {
    // A paddle moves at up to 30 m/s in water with c₀ = 10 m/s.
    let scene = "dimension = 2\ndp = 0.02\nuntil = 1.0\n\
        water = [{ fill = { box = { min = [0.0, 0.0], max = [1.0, 0.1] } } }]\n\
        [[solid]]\nname = \"tank\"\nfixed = true\nshape = { tank = { size = [1.0, 0.3] } }\n\
        [[solid]]\nname = \"paddle\"\nshape = { box = { size = [0.1, 0.2] } }\nat = { x = 0.3, bottom = 0.0 }\n\
        driven = { along = [1.0, 0.0], distance = { formula = \"0.1*sin(300*t)\" } }\n";
    let home = TestFolder::with_scene("timing-alarm", scene);
    let asked = InspectOptions { threads: Some(1), timing: true, ..InspectOptions::default() };
    let report = run::inspect(&home.join("scene.toml"), &asked).unwrap().report().unwrap();
    let finding =
        report.preflight.findings.iter().find(|finding| finding.topic == "breaks_down").expect("the run fails");
    let after = |word: &str| finding.what.split(word).nth(1).and_then(|rest| rest.split([' ', ',']).next());
    let count = |word: &str| after(word).and_then(|number| number.parse::<u64>().ok()).unwrap_or_default();
    // "after 9 steps: ... step 10, t = ...": with a rollback the two numbers would differ by more than one.
    assert_eq!(count("after ") + 1, count(", step "), "{}", finding.what);
}
