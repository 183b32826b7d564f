//! Constraints that begin, end or break during a run, without water.

use crate::{
    math::{Bivector, Vector, expression::Formula},
    solid::{
        Constraints, Dim, ForceSpec, HasEngine, JointKind, JointSpec, Lifetime, LineEnd, RopeSpec, SpringSpec,
        TimeFunction,
        constraint::assembly::tests::{DrySystem, G, bar, body, hinge, joined, point},
    },
};

const DT: f64 = 1e-3;

fn law(text: &str) -> TimeFunction {
    TimeFunction::Formula(Formula::parse(text).unwrap())
}

fn fixed<const D: usize>(between: [Option<usize>; 2], at: Vector<D>) -> JointSpec<D> {
    JointSpec::new("lock", JointKind::Fixed, between, at, Vector::zeros())
}

/// The times of the events, with their texts up to the time.
fn events<const D: usize>(air: &DrySystem<D>) -> Vec<(String, f64)> {
    let text = |text: String| text.split(" at t").next().unwrap().to_string();
    air.assembly.events().iter().map(|event| (text(event.to_string()), event.time)).collect()
}

fn ends_at_a_time<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    // A joint holds the body until 0.5 s; then it falls as a stone.
    let solids = || vec![bar::<D>("box", 0.2, point(0.0, 0.0), true)];
    let lock = fixed([None, Some(0)], point(0.0, 0.0)).lifetime(Lifetime::default().until(0.5));
    let mut air = DrySystem::new(solids(), joined(lock), G);
    air.run(DT, 0.5);
    let weight = body(&air.solids[0]).mass * G;
    assert!((air.assembly.joint_reading(0).force[D - 1] / weight - 1.0).abs() < 1e-6, "the joint bears the weight");
    air.run(DT, 0.9);
    let now = air.now()[0];
    // The engine gives free fall exactly.
    assert!((now.velocity[D - 1] + G * 0.4).abs() < 1e-9, "{D}-D: {}", now.velocity[D - 1]);
    assert!((now.centre[D - 1] + 0.5 * G * 0.16).abs() < 1e-6, "{D}-D: {}", now.centre[D - 1]);
    assert_eq!(air.assembly.joint_reading(0).force.norm(), 0.0);
    assert_eq!(air.assembly.joint_gap(0, &air.now()), [0.0; 2], "a joint that does not act is not violated");
    assert_eq!(events(&air)[0].0, "joint \"lock\" is released");
    assert!((events(&air)[0].1 - 0.5).abs() < 1e-9);
    // A spring without gravity: the body goes on with the speed that it has at the end.
    let ends = [LineEnd::ground(point::<D>(1.0, 0.0)), LineEnd::on(0, point::<D>(0.0, 0.0))];
    let k = 400.0;
    let spring = SpringSpec::new("pull", ends, k).rest_length(0.5).lifetime(Lifetime::default().until(0.05));
    let mut air = DrySystem::new(solids(), Constraints { springs: vec![spring], ..Constraints::default() }, 0.0);
    let limit = air.assembly.next_event(0.0);
    assert!((limit - 0.05).abs() < 1e-15, "no step passes the end");
    air.run(1e-4, 0.3);
    let omega = (k / body(&air.solids[0]).mass).sqrt();
    let speed = 0.5 * omega * (omega * 0.05).sin();
    // The explicit force is late by half a step of 1e-4 s.
    assert!((air.now()[0].velocity[0] / speed - 1.0).abs() < 3e-3, "{} of {speed}", air.now()[0].velocity[0]);
    assert_eq!(air.assembly.spring_reading(0).tension, 0.0);
    assert_eq!(air.assembly.step_limit(&*air.engine, &air.now(), air.t), f64::INFINITY, "it bounds no step");
}

#[test]
fn joints_and_springs_end_at_their_times() {
    ends_at_a_time::<2>();
    ends_at_a_time::<3>();
}

fn counts_from_its_begin<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    // A bar turns by 3 rad, nearly half a turn, before a hinge begins to act, and by 1 rad after that.
    let pin = hinge([None, Some(0)], Vector::zeros()).lifetime(Lifetime::default().since(0.75));
    let mut air = DrySystem::new(vec![bar::<D>("bar", 0.4, Vector::zeros(), true)], joined(pin), 0.0);
    let spin = Bivector::torque(&point(1.0, 0.0), &point(0.0, 1.0)) * 4.0;
    air.engine.set_velocity(0, &Vector::zeros(), &spin);
    air.run(DT, 1.0);
    // The first step of the joint may begin within a step of its time.
    let turned = air.assembly.joint_reading(0).position.abs();
    assert!((turned - 1.0).abs() < 4.0 * DT + 1e-6, "{D}-D: {turned} rad");
}

#[test]
fn a_hinge_that_begins_later_counts_its_angle_from_then() {
    counts_from_its_begin::<2>();
    counts_from_its_begin::<3>();
}

fn begins_at_a_time<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    // Two bodies pass; from 0.5 s on a joint holds them as they are then.
    let solids = || vec![bar::<D>("a", 0.2, point(0.0, 0.0), true), bar("b", 0.4, point::<D>(2.0, 0.0), true)];
    let lock = fixed([Some(0), Some(1)], point(1.0, 0.0)).lifetime(Lifetime::default().since(0.5));
    let mut air = DrySystem::new(solids(), joined(lock), 0.0);
    air.engine.set_velocity(1, &point(-1.0, 0.0), &Bivector::zero());
    air.run(DT, 0.5);
    assert_eq!(air.now()[0].velocity.norm(), 0.0, "the joint does not act yet");
    air.run(DT, 0.6);
    // Momentum is conserved: b has two thirds of the mass.
    for i in 0..2 {
        assert!((air.now()[i].velocity[0] + 2.0 / 3.0).abs() < 1e-6, "{D}-D: {}", air.now()[i].velocity[0]);
    }
    let distance = (air.now()[1].centre - air.now()[0].centre).norm();
    // The joint takes the difference of speed, 1 m/s, within one step.
    assert!((distance - 1.5).abs() < 1.1 * DT, "{D}-D: {distance}");
    assert!(air.assembly.joint_gap(0, &air.now())[0] < 1e-5);
    // A rope that is hooked on at 0.5 s is as long as the distance then.
    let ends = [LineEnd::on(0, point::<D>(0.1, 0.0)), LineEnd::on(1, point::<D>(1.8, 0.0))];
    let rope = RopeSpec::new("rope", ends).lifetime(Lifetime::default().since(0.5));
    let mut air = DrySystem::new(solids(), Constraints { ropes: vec![rope], ..Constraints::default() }, 0.0);
    air.engine.set_velocity(1, &point(1.0, 0.0), &Bivector::zero());
    air.run(DT, 1.0);
    let length = air.assembly.rope_reading(0).length;
    assert!((length - 2.2).abs() < 2e-3, "1.7 m at the start, 0.5 m later: {length}");
    assert!((air.now()[0].velocity[0] - 2.0 / 3.0).abs() < 1e-3, "{}", air.now()[0].velocity[0]);
    assert_eq!(events(&air)[0].0, "rope \"rope\" is connected");
    // A spring without a length is without tension where it begins.
    let spring = SpringSpec::new("spring", ends, 100.0).lifetime(Lifetime::default().since(0.5).until(0.9));
    let mut air = DrySystem::new(solids(), Constraints { springs: vec![spring], ..Constraints::default() }, 0.0);
    air.engine.set_velocity(1, &point(1.0, 0.0), &Bivector::zero());
    air.run(DT, 0.5);
    assert_eq!(air.assembly.spring_reading(0).tension, 0.0);
    air.run(DT, 0.502);
    let tension = air.assembly.spring_reading(0).tension;
    assert!((tension - 0.2).abs() < 1e-3, "stretched by 2 mm, which is two steps at 1 m/s: {tension}");
}

#[test]
fn joints_ropes_and_springs_begin_where_the_solids_are_at_that_time() {
    begins_at_a_time::<2>();
    begins_at_a_time::<3>();
}

/// A body on a line or joint of `strength` times its weight, pulled down by 20 N/s more and more.
fn loaded<const D: usize>(make: impl Fn(Lifetime, [LineEnd<D>; 2]) -> Constraints<D>) -> DrySystem<D>
where
    Dim<D>: HasEngine<D>,
{
    let solids = vec![bar::<D>("box", 0.2, point(0.0, 0.0), true)];
    let weight = body(&solids[0]).mass * G;
    let ends = [LineEnd::ground(point::<D>(0.0, 1.0)), LineEnd::on(0, point::<D>(0.0, 0.0))];
    let pull = ForceSpec::new("pull", 0).force((0..D).map(|i| law(if i == D - 1 { "-20*t" } else { "0" })));
    let links = make(Lifetime::default().strength(weight + 10.0), ends);
    DrySystem::new(solids, Constraints { forces: vec![pull], ..links }, G)
}

fn breaks<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    let rope = |lifetime, ends| {
        let ropes = vec![RopeSpec::new("line", ends).lifetime(lifetime)];
        Constraints { ropes, ..Constraints::default() }
    };
    let joint = |lifetime: Lifetime, _| joined(fixed([None, Some(0)], point(0.0, 0.0)).lifetime(lifetime));
    // The spring bears the weight from the start.
    let stretch = body(&bar::<D>("box", 0.2, point(0.0, 0.0), true)).mass * G / 1e5;
    let stiff = |lifetime, ends| {
        let spring = SpringSpec::new("line", ends, 1e5).damping(1e3).rest_length(1.0 - stretch).lifetime(lifetime);
        Constraints { springs: vec![spring], ..Constraints::default() }
    };
    for (name, mut air) in [("rope", loaded(rope)), ("joint", loaded(joint)), ("spring", loaded(stiff))] {
        air.run(DT, 0.4);
        assert!(events(&air).is_empty(), "{D}-D {name}: {:?}", events(&air));
        air.run(DT, 1.0);
        let [(text, time)] = &events(&air)[..] else { panic!("{D}-D {name}: {:?}", events(&air)) };
        assert!(text.starts_with(name) && text.ends_with("breaks"), "{text}");
        // 10 N more than the weight pull at 0.5 s; the stretching of the spring makes it 1 % late or early.
        assert!((time - 0.5).abs() < 5e-3, "{D}-D {name}: {time}");
        let after = 1.0 - time;
        let mass = body(&air.solids[0]).mass;
        let speed = G * after + 10.0 * (1.0 - time * time) / mass;
        let fell = -air.now()[0].velocity[D - 1];
        // The body moves by less than 0.02 m/s when the spring breaks.
        assert!((fell - speed).abs() < 0.02, "{D}-D {name}: {fell} of {speed}");
        let tension = match name {
            "rope" => air.assembly.rope_reading(0).tension,
            "spring" => air.assembly.spring_reading(0).tension,
            _ => air.assembly.joint_reading(0).force.norm(),
        };
        assert_eq!(tension, 0.0, "{D}-D {name}");
    }
}

#[test]
fn lines_and_joints_break_under_their_strength_and_stay_broken() {
    breaks::<2>();
    breaks::<3>();
}

#[test]
fn a_joint_breaks_under_a_torque() {
    let solids = vec![bar::<2>("box", 0.2, point(0.0, 0.0), true)];
    let lock = fixed([None, Some(0)], point(0.0, 0.0)).lifetime(Lifetime::default().torque_strength(5.0));
    let twist = ForceSpec::new("twist", 0).torque([law("10*t")]);
    let mut air = DrySystem::new(solids, Constraints { forces: vec![twist], ..joined(lock) }, 0.0);
    air.run(DT, 1.0);
    let all = events(&air);
    assert!(all.len() == 1 && (all[0].1 - 0.5).abs() < 2.0 * DT, "{all:?}");
    // The angular momentum after it: the integral of 10 t.
    let spin = air.now()[0].spin.axial()[0];
    let expected = 5.0 * (1.0 - all[0].1 * all[0].1) / body(&air.solids[0]).inertia[(0, 0)];
    assert!((spin / expected - 1.0).abs() < 1e-3, "{spin} of {expected}");
}

fn restores<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    let make = || {
        let solids = vec![bar::<D>("a", 0.2, point(0.0, 0.0), true), bar("b", 0.4, point::<D>(1.0, 0.0), true)];
        let ends = [LineEnd::on(0, point::<D>(0.1, 0.0)), LineEnd::on(1, point::<D>(0.8, 0.0))];
        let lock = fixed([Some(0), Some(1)], point(0.5, 0.0)).lifetime(Lifetime::default().since(0.25).until(0.6));
        let rope = RopeSpec::new("rope", ends).lifetime(Lifetime::default().since(0.2));
        let spring = SpringSpec::new("spring", ends, 80.0).lifetime(Lifetime::default().since(0.1).strength(8.0));
        let links = Constraints { springs: vec![spring], ropes: vec![rope], ..joined(lock) };
        let mut air = DrySystem::new(solids, links, G);
        air.engine.set_velocity(1, &point(1.0, 0.3), &Bivector::zero());
        air
    };
    let mut whole = make();
    whole.run(DT, 0.3);
    let (engine, state, t) = (whole.engine.save().unwrap(), whole.assembly.save(), whole.t);
    let mut other = make();
    // The state is taken up after the other system has gone another way.
    other.run(DT, 0.05);
    other.engine.restore(&engine).unwrap();
    assert!(other.assembly.matches(&state));
    other.assembly.restore(state);
    other.assembly.restore_ropes(&mut *other.engine);
    other.t = t;
    whole.run(DT, 0.9);
    other.run(DT, 0.9);
    assert_eq!(whole.now(), other.now());
    assert_eq!(whole.assembly.events(), other.assembly.events());
    assert_eq!(whole.engine.save().unwrap(), other.engine.save().unwrap());
    assert!(events(&whole).len() >= 4, "{:?}", events(&whole));
}

#[test]
fn a_restart_between_events_reaches_the_same_bits() {
    restores::<2>();
    restores::<3>();
}
