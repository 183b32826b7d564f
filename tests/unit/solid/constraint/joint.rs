//! Joints and motors without water: periods, reactions, damping, laws, stops and towing.

mod generic_joint;

use std::f64::consts::{FRAC_PI_2, TAU};

use crate::{
    math::{Bivector, Vector, expression::Formula},
    solid::{
        Constraints, Dim, ForceSpec, HasEngine, JointKind, JointSpec, Lifetime, Motor, PrescribedMotion, Role,
        SolidSpec, TimeFunction,
        constraint::assembly::tests::{DrySystem, G, bar, body, hinge, inertia, joined, point, slider},
    },
};

/// A bar that hangs from a hinge at the origin, 0.2 m above its centre.
fn pendulum<const D: usize>(motor: Option<Motor>) -> DrySystem<D>
where
    Dim<D>: HasEngine<D>,
{
    let solids = vec![bar("bar", 0.4, point(0.0, -0.2), false)];
    let joint = JointSpec { motor, ..hinge([None, Some(0)], Vector::zeros()) };
    DrySystem::new(solids, joined(joint), G)
}

fn swings<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    let mut air = pendulum::<D>(None);
    let spec = &air.solids[0];
    let (m, i) = (body(spec).mass, inertia(spec) + body(spec).mass * 0.04);
    let exact = TAU * (i / (m * G * 0.2)).sqrt();
    // An amplitude of 0.01 rad lengthens the period by 0.01²/16.
    let w = 0.01 * TAU / exact;
    let spin = Bivector::torque(&point(0.0, -1.0), &point(1.0, 0.0)) * w;
    air.engine.set_velocity(0, &spin.velocity_at(&point(0.0, -0.2)), &spin);
    let period = air.period(1e-3, 3, |air| air.assembly.joint_reading(0).position);
    assert!((period / exact - 1.0).abs() < 1e-4, "{D}-D: {period} s, exact {exact} s");
    // The hinge does not move.
    assert!((air.now()[0].pose.point(&point(0.0, 0.2))).norm() < 1e-7);
}

#[test]
fn a_hinged_bar_swings_with_the_period_of_a_pendulum() {
    swings::<2>();
    swings::<3>();
}

fn reacts<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    // A bar released level from a hinge at its end: at its lowest position ω² = 2 m g d/I, and the hinge carries m (g + ω² d).
    let solids = vec![bar("bar", 0.4, point(0.2, 0.0), true)];
    let (m, i) = (body(&solids[0]).mass, inertia(&solids[0]) + body(&solids[0]).mass * 0.04);
    let mut air = DrySystem::new(solids, joined(hinge([None, Some(0)], Vector::<D>::zeros())), G);
    air.step(1e-4);
    // Immediately after the release the hinge carries m (g − d α) with α = m g d/I.
    let first = air.assembly.joint_reading(0);
    assert!((first.force[D - 1] / (m * G * (1.0 - 0.04 * m / i)) - 1.0).abs() < 1e-6, "{D}-D: {first:?}");
    let mut before = air.assembly.joint_reading(0).position;
    while (air.assembly.joint_reading(0).position.abs() - FRAC_PI_2) * (before.abs() - FRAC_PI_2) > 0.0 {
        before = air.assembly.joint_reading(0).position;
        air.step(1e-4);
    }
    let reading = air.assembly.joint_reading(0);
    let w2 = 2.0 * m * G * 0.2 / i;
    assert!((reading.rate.powi(2) / w2 - 1.0).abs() < 1e-3, "{D}-D: {reading:?}");
    assert!((reading.force[D - 1] / (m * (G + w2 * 0.2)) - 1.0).abs() < 1e-3, "{D}-D: {reading:?}");
    assert!(reading.torque.0.norm() < 1e-6 * m * G, "a free hinge carries no torque: {reading:?}");
}

#[test]
fn a_hinge_carries_weight_and_centripetal_force_of_a_swinging_bar() {
    reacts::<2>();
    reacts::<3>();
}

fn hangs<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    // A cantilever of two bars, joined end to end: the wall carries the weights and moments of both.
    let solids = vec![bar("near", 0.4, point(0.2, 0.0), true), bar("far", 0.4, point(0.6, 0.0), true)];
    let weight = body(&solids[0]).mass * G;
    let weld = |name: &str, between, x: f64| {
        JointSpec::new(name, JointKind::Fixed, between, point::<D>(x, 0.0), Vector::zeros())
    };
    let joints = vec![weld("wall", [None, Some(0)], 0.0), weld("middle", [Some(0), Some(1)], 0.4)];
    let mut air = DrySystem::new(solids, Constraints { joints, ..Constraints::default() }, G);
    air.run(1e-4, 0.2);
    for (joint, weights, moment) in [(0, 2.0, 0.2 + 0.6), (1, 1.0, 0.2)] {
        let reading = air.assembly.joint_reading(joint);
        assert!((reading.force - point(0.0, weights * weight)).norm() < 1e-3 * weight, "{D}-D: {reading:?}");
        let lever = Bivector::torque(&point(moment, 0.0), &point(0.0, weight));
        assert!((reading.torque + lever * -1.0).0.norm() < 1e-3 * weight, "{D}-D: {reading:?} for {lever:?}");
    }
    assert!(air.now()[1].pose.position[D - 1].abs() < 1e-6, "the cantilever does not sag");
}

#[test]
fn fixed_joints_carry_the_weight_and_moment_of_a_cantilever() {
    hangs::<2>();
    hangs::<3>();
}

fn damps<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    // A flap about a hinge at its end, without gravity: I ẇ = −c w.
    let flap = bar("flap", 0.4, point(0.0, 0.2), false);
    let i = inertia(&flap) + body(&flap).mass * 0.04;
    let c = 3.0 * i;
    let joint = hinge([None, Some(0)], Vector::<D>::zeros()).motor(Motor::default().damping(c));
    let mut air = DrySystem::new(vec![flap], joined(joint), 0.0);
    let spin = Bivector::torque(&point(0.0, -1.0), &point(1.0, 0.0)) * 0.5;
    air.engine.set_velocity(0, &spin.velocity_at(&point(0.0, 0.2)), &spin);
    air.run(1e-4, 1.0);
    let reading = air.assembly.joint_reading(0);
    assert!((reading.rate / (0.5 * (-c / i).exp()) - 1.0).abs() < 1e-3, "{D}-D: {reading:?}");
    assert!((reading.motor_force / (-c * reading.rate) - 1.0).abs() < 1e-3);
    let lost = 0.5 * i * (0.25 - reading.rate.powi(2));
    assert!((reading.absorbed_energy / lost - 1.0).abs() < 1e-5, "{} of {lost} J", reading.absorbed_energy);

    // A float on an inclined guide, with its line of motion beside its centre: m v̇ = −c v.
    let float = bar("float", 0.2, point(0.1, 0.0), false);
    let (m, along) = (body(&float).mass, point::<D>(0.6, 0.8));
    let c = 2.0 * m;
    let joint = slider([None, Some(0)], Vector::zeros(), along * 3.0).motor(Motor::default().damping(c));
    let mut air = DrySystem::new(vec![float], joined(joint), 0.0);
    air.engine.set_velocity(0, &(along * 0.5), &Bivector::zero());
    air.run(1e-4, 1.0);
    let now = air.now()[0];
    assert!((now.velocity.dot(&along) / (0.5 * (-2.0f64).exp()) - 1.0).abs() < 1e-3, "{now:?}");
    // The displacement is along the line only, by (1 − e⁻²)/2 · 0.5 m.
    let way = now.pose.position - point(0.1, 0.0);
    assert!((way - along * (0.25 * (1.0 - (-2.0f64).exp()))).norm() < 1e-4, "{way:?}");
    assert!((air.assembly.joint_reading(0).position - way.norm()).abs() < 1e-9);
}

#[test]
fn a_damping_motor_damps_exponentially_and_records_the_absorbed_energy() {
    damps::<2>();
    damps::<3>();
}

fn motors<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    let formula = |text: &str| TimeFunction::Formula(Formula::parse(text).unwrap());
    // A torque by a formula: the bar gains ∫ F dt/I.
    let bar = bar("bar", 0.4, point::<D>(0.0, -0.2), false);
    let i = inertia(&bar) + body(&bar).mass * 0.04;
    let push = Motor { force: formula("3*t"), ..Motor::default() };
    let mut air = DrySystem::new(vec![bar], joined(hinge([None, Some(0)], Vector::zeros()).motor(push)), 0.0);
    air.run(1e-4, 0.2);
    // In 3-D the constraint solver with four iterations leaves 1e-7; a formula evaluated half a step late would err by 2.5e-4.
    assert!(
        (air.assembly.joint_reading(0).rate / (1.5 * 0.04 / i) - 1.0).abs() < 1e-6,
        "{:?}",
        air.assembly.joint_reading(0)
    );
    // A servo holds its angle against the weight up to the deflection F/k, and a drive keeps its speed.
    let servo = Motor { position: formula("0.4*min(t, 1)"), ..Motor::default().damping(300.0) };
    let mut air = pendulum::<D>(Some(Motor { stiffness: TimeFunction::constant(2e4), ..servo }));
    air.run(1e-3, 2.0);
    let (reading, m) = (air.assembly.joint_reading(0), body(&air.solids[0]).mass);
    let weight = m * G * 0.2 * reading.position.sin();
    assert!((reading.motor_force / weight - 1.0).abs() < 1e-3, "{D}-D: {reading:?} for {weight}");
    assert!((0.4 - reading.position - weight / 2e4).abs() < 1e-5, "{D}-D: {reading:?}");
    let drive = Motor { velocity: Some(TimeFunction::constant(-1.5)), ..Motor::default().damping(1e9) };
    let mut air = pendulum::<D>(Some(drive.clone()));
    air.run(1e-3, 4.0);
    // The drive is stiff compared with the step and rotates past half a turn, where the angle goes on.
    let turned = air.assembly.joint_reading(0).position;
    // The rate is exact up to the effect of the weight in one step.
    assert!(
        (air.assembly.joint_reading(0).rate + 1.5).abs() < 1e-3 * m * G * 0.2 / i,
        "{D}-D: {:?}",
        air.assembly.joint_reading(0)
    );
    assert!((turned + 6.0).abs() < 1e-2, "{D}-D: {turned}");
    // A spring in the hinge that bears a torque of 20 N m rests at F₀/k = 4 rad, beyond half a turn.
    let spring = Motor::default().force(20.0).stiffness(5.0).damping(6.0);
    let hung = vec![air.solids[0].clone()];
    let mut air = DrySystem::new(hung, joined(hinge([None, Some(0)], Vector::zeros()).motor(spring)), 0.0);
    air.run(1e-3, 20.0);
    let reading = air.assembly.joint_reading(0);
    // Of the start e^(−16) is left after 20 s: k/c = 0.83/s.
    assert!((reading.position - 4.0).abs() < 1e-4, "{D}-D: {reading:?}");
    // A motor with too small a maximum does not lift the bar.
    let mut air = pendulum::<D>(Some(Motor { max_force: 0.1 * m * G * 0.2, ..drive }));
    air.run(1e-3, 2.0);
    assert!(air.assembly.joint_reading(0).position.abs() < 0.25, "{D}-D: {:?}", air.assembly.joint_reading(0));
}

#[test]
fn a_motor_follows_its_force_position_and_velocity_laws() {
    motors::<2>();
    motors::<3>();
}

fn brakes<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    // A weight on a vertical rail with a step of 1 ms: Δt c/m from 0.05 to 5e6.
    let weight = bar("weight", 0.2, point::<D>(0.0, 0.0), true);
    let m = body(&weight).mass;
    for stiff in [0.05, 0.1, 0.5, 5.0, 500.0, 5e6] {
        let c = stiff * m / 1e-3;
        let rail = slider([None, Some(0)], Vector::zeros(), point(0.0, 1.0)).motor(Motor::default().damping(c));
        let mut air = DrySystem::new(vec![weight.clone()], joined(rail), G);
        air.run(1e-3, 0.5);
        // After at least 25 relaxation times m/c the speed is m g/c. The damping acts at the end of the step, so that it has no error
        // of the step; at Δt c/m = 5e6 round-off of the loads is 1e-10 of it.
        let speed = -air.assembly.joint_reading(0).rate / (m * G / c);
        assert!((speed - 1.0).abs() < 1e-6, "{D}-D, Δt c/m = {stiff}: {speed} of m g/c");
        assert!(
            (air.assembly.joint_reading(0).motor_force / (m * G) - 1.0).abs() < 1e-6,
            "{D}-D, {stiff}: {:?}",
            air.assembly.joint_reading(0)
        );
    }
    // Two motors on one rail: the second takes account of the first, so that no oscillation occurs.
    let along = point(0.0, 1.0);
    let second = slider([None, Some(0)], point(0.0, 0.05), along).motor(Motor::default().damping(1e9));
    let second = JointSpec { name: "second".into(), ..second };
    let first = slider([None, Some(0)], Vector::zeros(), along).motor(Motor::default().damping(1e9));
    let mut air =
        DrySystem::new(vec![weight.clone()], Constraints { joints: vec![first, second], ..Constraints::default() }, G);
    air.run(1e-3, 0.5);
    assert!(air.now()[0].velocity.norm() < 1e-6, "{D}-D: {:?}", air.now());
    // The stop carries a weight that rests on it, not a damping motor of usual strength: its force from one step of weight is 5e-5 of m g.
    let rail =
        slider([None, Some(0)], Vector::zeros(), along).limits(-0.01, 0.01).motor(Motor::default().damping(5.0 * m));
    let mut air = DrySystem::new(vec![weight], joined(rail), G);
    air.run(1e-4, 1.0);
    let reading = air.assembly.joint_reading(0);
    assert!(reading.motor_force.abs() < 1e-3 * m * G && (reading.position + 0.01).abs() < 1e-6, "{D}-D: {reading:?}");
}

#[test]
fn a_loaded_damping_motor_moves_at_load_over_damping_for_any_damping() {
    brakes::<2>();
    brakes::<3>();
}

fn stops<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    let solids = vec![bar("bar", 0.4, point(0.2, 0.0), true)];
    let m = body(&solids[0]).mass;
    let joint = hinge([None, Some(0)], Vector::<D>::zeros()).limits(-0.5, 0.5);
    let mut air = DrySystem::new(solids, joined(joint), G);
    air.run(1e-4, 1.5);
    let reading = air.assembly.joint_reading(0);
    assert!((reading.position.abs() - 0.5).abs() < 1e-5, "{D}-D: {reading:?}");
    // At rest on its stop, the stop carries the moment of the weight.
    let moment = Bivector::torque(&point(0.2 * 0.5f64.cos(), 0.0), &point(0.0, m * G));
    assert!((reading.torque + moment * -1.0).0.norm() < 1e-3 * m * G, "{D}-D: {reading:?} for {moment:?}");

    let weight = bar("weight", 0.2, point(0.3, 1.0), false);
    let joint = slider([None, Some(0)], point(0.0, 1.0), point::<D>(0.0, 1.0)).limits(-0.25, 0.1);
    let mut air = DrySystem::new(vec![weight], joined(joint), G);
    air.run(1e-4, 1.0);
    assert!((air.now()[0].pose.position[D - 1] - 0.75).abs() < 1e-6, "{:?}", air.now());
    assert!((air.assembly.joint_reading(0).force[D - 1] / (body(&air.solids[0]).mass * G) - 1.0).abs() < 1e-3);
}

#[test]
fn an_end_stop_limits_the_motion_and_carries_the_load_on_it() {
    stops::<2>();
    stops::<3>();
}

fn steady_stops<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    // Where the stop lies decides by round-off whether the engine finds the resting body at it or before it.
    for (across, limit) in [0.0, 0.7, 1.0].into_iter().flat_map(|x| [0.1, 0.2, 0.23, 0.3].map(|limit| (x, limit))) {
        let weight = bar("weight", 0.2, point(0.0, 1.0), false);
        let (m, along) = (body(&weight).mass, point::<D>(across, 1.0));
        let rail = slider([None, Some(0)], point(0.0, 1.0), along).limits(-limit, 0.1);
        let mut air = DrySystem::new(vec![weight], joined(rail), G);
        air.run(2e-3, 1.0);
        for _ in 0..20 {
            air.step(2e-3);
            // The rail and its stop bear the whole weight. Each step the engine lets stops yield by 1e-9 of the load.
            let reading = air.assembly.joint_reading(0);
            assert!((reading.force - point(0.0, m * G)).norm() < 1e-6 * m * G, "{D}-D, {across}, {limit}: {reading:?}");
            assert!((reading.position + limit).abs() < 1e-6, "{D}-D, {across}, {limit}: {reading:?}");
        }
    }
    for limit in [0.3, 0.5, 1.1] {
        let solids = vec![bar("bar", 0.4, point(0.2, 0.0), true)];
        let m = body(&solids[0]).mass;
        let joint = hinge([None, Some(0)], Vector::<D>::zeros()).limits(-limit, limit);
        let mut air = DrySystem::new(solids, joined(joint), G);
        air.run(2e-3, 3.0);
        let moment = Bivector::torque(&point(0.2 * limit.cos(), 0.0), &point(0.0, m * G));
        for _ in 0..20 {
            air.step(2e-3);
            let reading = air.assembly.joint_reading(0);
            // In 3-D four sweeps of the solver leave 1e-6.
            assert!(
                (reading.torque + moment * -1.0).0.norm() < 1e-5 * m * G,
                "{D}-D, {limit}: {reading:?}, {moment:?}"
            );
        }
    }
}

#[test]
fn an_end_stop_bears_the_same_load_in_every_step() {
    steady_stops::<2>();
    steady_stops::<3>();
}

#[test]
fn a_ball_joint_rotates_about_every_axis_and_a_hinge_about_one() {
    let spin = Bivector::<3>::from_axial(&[1.0, -2.0, 3.0]);
    let run = |kind| {
        let solids = vec![bar("bar", 0.4, point(0.0, 0.2), false)];
        let joint = JointSpec::new("joint", kind, [None, Some(0)], Vector::zeros(), Vector::from([0.0, 1.0, 0.0]));
        let mut air = DrySystem::new(solids, joined(joint), 0.0);
        air.engine.set_velocity(0, &spin.velocity_at(&point(0.0, 0.2)), &spin);
        air.run(1e-4, 0.5);
        let now = air.now()[0];
        assert!(now.pose.point(&point(0.0, -0.2)).norm() < 1e-6, "the bar stays at its joint: {now:?}");
        now.spin.axial()
    };
    let free = run(JointKind::Ball);
    assert!(free.iter().all(|w| w.abs() > 0.1), "{free:?}");
    let held = run(JointKind::Hinge);
    assert!(held[0].abs() < 1e-6 && held[2].abs() < 1e-6 && (held[1] + 2.0).abs() < 1e-3, "{held:?}");
}

#[test]
fn a_hinge_on_a_driven_cart_follows_the_cart() {
    let motion =
        PrescribedMotion::slide(Vector::from([1.0, 0.0]), TimeFunction::Formula(Formula::parse("0.1*t^2").unwrap()));
    let cart = SolidSpec { role: Role::Driven(motion), ..bar::<2>("cart", 0.2, point(0.0, 0.0), true) };
    let solids = vec![cart, bar("bar", 0.4, point(0.0, -0.2), false)];
    let m = body(&solids[1]).mass;
    let joint = hinge([Some(0), Some(1)], Vector::zeros()).motor(Motor::default().damping(30.0));
    let mut air = DrySystem::new(solids, joined(joint), G);
    air.run(1e-4, 3.0);
    // The bar lags by atan(a/g) with a = 0.2 m/s² and has the speed of the cart.
    let reading = air.assembly.joint_reading(0);
    assert!((reading.position.abs() - (0.2f64 / G).atan()).abs() < 1e-4, "{reading:?}");
    assert!((reading.force - Vector::from([0.2 * m, G * m])).norm() < 1e-2 * m, "{reading:?}");
    assert!((air.now()[1].velocity[0] - 0.6).abs() < 1e-3);
}

#[test]
fn an_impact_on_jointed_bodies_conserves_momentum_and_angular_momentum() {
    let mut solids = vec![bar::<2>("left", 0.4, point(-0.21, 0.0), true), bar("right", 0.4, point(0.21, 0.0), true)];
    solids.push(bar("ball", 0.1, point(0.35, 0.3), true));
    let Role::Free(ball) = &mut solids[2].role else { panic!() };
    ball.velocity = Vector::from([0.0, -1.0]);
    let mut air = DrySystem::new(solids, joined(hinge([Some(0), Some(1)], Vector::zeros())), 0.0);
    let momentum = |air: &DrySystem<2>| {
        air.now().iter().zip(&air.solids).fold((Vector::<2>::zeros(), 0.0), |(p, l), (now, solid)| {
            let linear = now.velocity * body(solid).mass;
            let own = inertia(solid) * now.spin.axial()[0];
            (p + linear, l + own + Bivector::torque(&now.centre, &linear).axial()[0])
        })
    };
    let before = momentum(&air);
    air.run(1e-4, 1.0);
    let after = momentum(&air);
    assert!(
        air.now()[0].velocity.norm() > 0.01,
        "the impact reaches the other bar through the hinge: {:?}",
        air.now()[0]
    );
    assert!((after.0 - before.0).norm() < 1e-10 * before.0.norm(), "{before:?} {after:?}");
    // The contact and joint points move during the step: first order in the step.
    assert!((after.1 / before.1 - 1.0).abs() < 1e-4, "{before:?} {after:?}");
}

#[test]
fn a_tow_joint_couples_one_translation_and_leaves_the_other_motions_free() {
    let motion =
        PrescribedMotion::slide(Vector::from([1.0, 0.0]), TimeFunction::Formula(Formula::parse("0.2*t^2").unwrap()));
    let carriage = SolidSpec { role: Role::Driven(motion), ..bar::<2>("carriage", 0.2, point(0.0, 1.0), true) };
    let mut solids = vec![carriage, bar("model", 0.4, point(0.1, 0.0), true)];
    let Role::Free(model) = &mut solids[1].role else { panic!() };
    model.spin = Bivector::from_axial(&[0.7]);
    let tow = JointSpec::new("tow", JointKind::Tow, [Some(0), Some(1)], point(0.1, 0.0), Vector::from([1.0, 0.0]));
    let mut air = DrySystem::new(solids, joined(tow), G);
    air.run(1e-4, 1.0);
    let (now, m) = (air.now()[1], body(&air.solids[1]).mass);
    // First order in the step: ½ g t Δt of the fall.
    assert!((now.centre - Vector::from([0.3, -0.5 * G])).norm() < 1e-3, "{now:?}");
    assert!((now.spin.axial()[0] - 0.7).abs() < 1e-9 && (now.velocity[0] - 0.4).abs() < 1e-3);
    let reading = air.assembly.joint_reading(0);
    assert!((reading.force - Vector::from([0.4 * m, 0.0])).norm() < 1e-2 * m, "the tow force is m a: {reading:?}");
}

fn carries<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    let mut carriage = bar::<D>("carriage", 0.2, point(0.0, 1.0), true);
    let Role::Free(body_of_it) = &mut carriage.role else { panic!() };
    body_of_it.locked_translations = std::array::from_fn(|i| i != 0);
    body_of_it.locked_rotations = [true; 3];
    let mut solids = vec![carriage, bar("buoy", 0.4, Vector::zeros(), true)];
    let Role::Free(buoy) = &mut solids[1].role else { panic!() };
    buoy.spin = Bivector::from_axial(&[0.7, 0.0, 0.0][..if D == 2 { 1 } else { 3 }]);
    let force = (0..D).map(|i| TimeFunction::constant(if i == 0 || i == D - 1 { 12.0 } else { 0.0 })).collect();
    let push = ForceSpec {
        name: "push".into(),
        solid: 1,
        at: None,
        force,
        torque: vec![],
        rotates_with_solid: false,
        lifetime: Lifetime::default(),
    };
    let tow = JointSpec::new("rail", JointKind::Tow, [Some(0), Some(1)], Vector::zeros(), point(1.0, 0.0));
    let links = Constraints { joints: vec![tow], forces: vec![push], ..Constraints::default() };
    let mut air = DrySystem::new(solids, links, 0.0);
    air.run(1e-4, 1.0);
    let (now, [more, m]) = (air.now()[1], [0, 1].map(|i| body(&air.solids[i]).mass));
    assert!((now.velocity[0] - 12.0 / (m + more)).abs() < 1e-9, "along the rail the inertia is that of both: {now:?}");
    assert!((now.velocity[D - 1] - 12.0 / m).abs() < 1e-9, "across the rail the inertia is that of the buoy: {now:?}");
    assert!((now.spin.axial()[0] - 0.7).abs() < 1e-9, "the rotation is free: {now:?}");
}

#[test]
fn a_free_carriage_adds_its_mass_along_its_rail_only() {
    carries::<2>();
    carries::<3>();
}
