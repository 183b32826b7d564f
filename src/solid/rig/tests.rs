//! What ties promise, on the engine alone: no water.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::{JointReading, Rig};
use crate::{
    error::Result,
    shape::Shape,
    solid::{
        ContactSpec, Dim, Drive, Elastic, End, Engine, ForceSpec, Formula, FreeBody, HasEngine, Hold, JointKind,
        JointSpec, Kinematics, Law, Links, Load, Motion, Motor, Role, RopeSpec, SolidSpec, SpringSpec,
    },
    space::{Pose, Vector, Wedge},
};

const G: f64 = 9.81;

/// Solids and their ties in air.
struct Air<const D: usize> {
    solids: Vec<SolidSpec<D>>,
    engine: Box<dyn Engine<D>>,
    rig: Rig<D>,
    t: f64,
}

impl<const D: usize> Air<D>
where
    Dim<D>: HasEngine<D>,
{
    fn new(solids: Vec<SolidSpec<D>>, links: Links<D>, gravity: f64) -> Self {
        Self::made(solids, links, gravity).unwrap()
    }

    fn made(solids: Vec<SolidSpec<D>>, links: Links<D>, gravity: f64) -> Result<Self> {
        let start: Vec<_> = solids.iter().map(SolidSpec::start).collect();
        let mut down = Vector::zeros();
        down[D - 1] = -gravity;
        let engine = Dim::<D>::engine(&solids, &start, &links, &down, 0.01)?;
        Ok(Self { rig: Rig::new(&links, start), solids, engine, t: 0.0 })
    }

    fn now(&self) -> Vec<Kinematics<D>> {
        let one = |(i, solid): (usize, &SolidSpec<D>)| match &solid.role {
            Role::Fixed => solid.start(),
            Role::Driven(motion) => motion.kinematics(&solid.pose, self.t),
            Role::Free(_) => self.engine.kinematics(i),
        };
        self.solids.iter().enumerate().map(one).collect()
    }

    fn step(&mut self, dt: f64) {
        let before = self.now();
        self.rig.act(&mut *self.engine, &before, self.t, dt);
        self.t += dt;
        let driven = |solid: &SolidSpec<D>| match &solid.role {
            Role::Driven(motion) => Some(motion.kinematics(&solid.pose, self.t)),
            _ => None,
        };
        let targets: Vec<_> = self.solids.iter().map(driven).collect();
        let idle = Load { force: Vector::zeros(), torque: Wedge::zero() };
        self.engine.step(dt, &vec![idle; targets.len()], &targets).unwrap();
        self.rig.learn(&*self.engine, &before, &self.now(), dt);
    }

    fn run(&mut self, dt: f64, until: f64) {
        while self.t < until - 0.5 * dt {
            self.step(dt);
        }
    }

    /// The mean time between the first rising passages of zero of what `look` sees, over `count` of them.
    fn period(&mut self, dt: f64, count: usize, look: impl Fn(&Self) -> f64) -> f64 {
        let (mut passages, mut before) = (Vec::new(), look(self));
        while passages.len() <= count {
            assert!(self.t < 100.0, "it does not swing");
            self.step(dt);
            let now = look(self);
            if before < 0.0 && now >= 0.0 {
                passages.push(self.t - dt * now / (now - before));
            }
            before = now;
        }
        (passages[count] - passages[0]) / count as f64
    }
}

fn point<const D: usize>(across: f64, up: f64) -> Vector<D> {
    Vector::from_fn(|i, _| {
        if i == 0 {
            across
        } else if i == D - 1 {
            up
        } else {
            0.0
        }
    })
}

/// The axis across the plane of x and up, in the sense that turns up to x and, in 2-D, none: both are the same motion.
fn across<const D: usize>() -> Vector<D> {
    Vector::from_fn(|i, _| if D == 3 && i == 1 { -1.0 } else { 0.0 })
}

/// A homogeneous free bar of 0.1 m and `length` (m) that stands, hangs or lies around `at`, 1000 kg/m³.
fn bar<const D: usize>(name: &str, length: f64, at: Vector<D>, lies: bool) -> SolidSpec<D> {
    let long = if lies { 0 } else { D - 1 };
    let shape = Shape::Box { size: Vector::from_fn(|i, _| if i == long { length } else { 0.1 }) };
    let role = Role::Free(FreeBody::from_density(&shape, 1000.0));
    SolidSpec { name: name.into(), shape, pose: Pose::at(at), role, friction: 0.5, restitution: 0.0 }
}

fn body<const D: usize>(solid: &SolidSpec<D>) -> FreeBody<D> {
    match &solid.role {
        Role::Free(body) => *body,
        _ => panic!("not free"),
    }
}

/// Inertia about the axis across, through the centre of mass.
fn inertia<const D: usize>(solid: &SolidSpec<D>) -> f64 {
    if D == 2 { body(solid).inertia[(0, 0)] } else { body(solid).inertia[(1, 1)] }
}

fn hinge<const D: usize>(between: [Option<usize>; 2], at: Vector<D>) -> JointSpec<D> {
    JointSpec::new("hinge", JointKind::Hinge, between, at, across())
}

fn slider<const D: usize>(between: [Option<usize>; 2], at: Vector<D>, along: Vector<D>) -> JointSpec<D> {
    JointSpec::new("slider", JointKind::Slider, between, at, along)
}

fn joined<const D: usize>(joint: JointSpec<D>) -> Links<D> {
    Links { joints: vec![joint], ..Links::default() }
}

/// A bar that hangs from a hinge at the origin, 0.2 m above its centre.
fn pendulum<const D: usize>(motor: Option<Motor>) -> Air<D>
where
    Dim<D>: HasEngine<D>,
{
    let solids = vec![bar("bar", 0.4, point(0.0, -0.2), false)];
    let joint = JointSpec { motor, ..hinge([None, Some(0)], Vector::zeros()) };
    Air::new(solids, joined(joint), G)
}

fn swings<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    let mut air = pendulum::<D>(None);
    let spec = &air.solids[0];
    let (m, i) = (body(spec).mass, inertia(spec) + body(spec).mass * 0.04);
    let exact = TAU * (i / (m * G * 0.2)).sqrt();
    // An amplitude of 0.01 rad makes the period longer by 0.01²/16.
    let w = 0.01 * TAU / exact;
    let spin = Wedge::torque(&point(0.0, -1.0), &point(1.0, 0.0)) * w;
    air.engine.set_velocity(0, &spin.at(&point(0.0, -0.2)), &spin);
    let period = air.period(1e-3, 3, |air| air.rig.joint(0).position);
    assert!((period / exact - 1.0).abs() < 1e-4, "{D}-D: {period} s, exact {exact} s");
    // The hinge stays where it is.
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
    // A bar let go level from the hinge at its end: at its lowest it turns with ω² = 2 m g d/I, and the hinge carries m (g + ω² d).
    let solids = vec![bar("bar", 0.4, point(0.2, 0.0), true)];
    let (m, i) = (body(&solids[0]).mass, inertia(&solids[0]) + body(&solids[0]).mass * 0.04);
    let mut air = Air::new(solids, joined(hinge([None, Some(0)], Vector::<D>::zeros())), G);
    air.step(1e-4);
    // Just let go, the hinge carries m (g − d α) with α = m g d/I.
    let first = air.rig.joint(0);
    assert!((first.force[D - 1] / (m * G * (1.0 - 0.04 * m / i)) - 1.0).abs() < 1e-6, "{D}-D: {first:?}");
    let mut before = air.rig.joint(0).position;
    while (air.rig.joint(0).position.abs() - FRAC_PI_2) * (before.abs() - FRAC_PI_2) > 0.0 {
        before = air.rig.joint(0).position;
        air.step(1e-4);
    }
    let reading = air.rig.joint(0);
    let w2 = 2.0 * m * G * 0.2 / i;
    assert!((reading.rate.powi(2) / w2 - 1.0).abs() < 1e-3, "{D}-D: {reading:?}");
    assert!((reading.force[D - 1] / (m * (G + w2 * 0.2)) - 1.0).abs() < 1e-3, "{D}-D: {reading:?}");
    assert!(reading.torque.0.norm() < 1e-6 * m * G, "a free hinge carries no torque: {reading:?}");
}

#[test]
fn a_hinge_carries_the_weight_and_the_pull_of_the_swing() {
    reacts::<2>();
    reacts::<3>();
}

fn hangs<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    // A cantilever of two bars, welded end to end: the wall carries both, and their moments.
    let solids = vec![bar("near", 0.4, point(0.2, 0.0), true), bar("far", 0.4, point(0.6, 0.0), true)];
    let weight = body(&solids[0]).mass * G;
    let weld = |name: &str, between, x: f64| {
        JointSpec::new(name, JointKind::Fixed, between, point::<D>(x, 0.0), Vector::zeros())
    };
    let joints = vec![weld("wall", [None, Some(0)], 0.0), weld("middle", [Some(0), Some(1)], 0.4)];
    let mut air = Air::new(solids, Links { joints, ..Links::default() }, G);
    air.run(1e-4, 0.2);
    for (joint, weights, moment) in [(0, 2.0, 0.2 + 0.6), (1, 1.0, 0.2)] {
        let reading = air.rig.joint(joint);
        assert!((reading.force - point(0.0, weights * weight)).norm() < 1e-3 * weight, "{D}-D: {reading:?}");
        let lever = Wedge::torque(&point(moment, 0.0), &point(0.0, weight));
        assert!((reading.torque + lever * -1.0).0.norm() < 1e-3 * weight, "{D}-D: {reading:?} for {lever:?}");
    }
    assert!(air.now()[1].pose.position[D - 1].abs() < 1e-6, "it does not sag");
}

#[test]
fn a_cantilever_gives_its_weight_and_moment_to_the_wall() {
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
    let joint = hinge([None, Some(0)], Vector::<D>::zeros()).motor(Motor::damping(c));
    let mut air = Air::new(vec![flap], joined(joint), 0.0);
    let spin = Wedge::torque(&point(0.0, -1.0), &point(1.0, 0.0)) * 0.5;
    air.engine.set_velocity(0, &spin.at(&point(0.0, 0.2)), &spin);
    air.run(1e-4, 1.0);
    let reading = air.rig.joint(0);
    assert!((reading.rate / (0.5 * (-c / i).exp()) - 1.0).abs() < 1e-3, "{D}-D: {reading:?}");
    assert!((reading.motor / (-c * reading.rate) - 1.0).abs() < 1e-3);
    let lost = 0.5 * i * (0.25 - reading.rate.powi(2));
    assert!((reading.absorbed / lost - 1.0).abs() < 1e-5, "{} of {lost} J", reading.absorbed);

    // A float on an oblique guide, its line of motion beside its centre: m v̇ = −c v.
    let float = bar("float", 0.2, point(0.1, 0.0), false);
    let (m, along) = (body(&float).mass, point::<D>(0.6, 0.8));
    let c = 2.0 * m;
    let joint = slider([None, Some(0)], Vector::zeros(), along * 3.0).motor(Motor::damping(c));
    let mut air = Air::new(vec![float], joined(joint), 0.0);
    air.engine.set_velocity(0, &(along * 0.5), &Wedge::zero());
    air.run(1e-4, 1.0);
    let now = air.now()[0];
    assert!((now.velocity.dot(&along) / (0.5 * (-2.0f64).exp()) - 1.0).abs() < 1e-3, "{now:?}");
    // Along the line only, (1 − e⁻²)/2 · 0.5 m far.
    let way = now.pose.position - point(0.1, 0.0);
    assert!((way - along * (0.25 * (1.0 - (-2.0f64).exp()))).norm() < 1e-4, "{way:?}");
    assert!((air.rig.joint(0).position - way.norm()).abs() < 1e-9);
}

#[test]
fn a_power_take_off_damps_exponentially_and_counts_its_energy() {
    damps::<2>();
    damps::<3>();
}

fn motors<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    let formula = |text: &str| Law::Formula(Formula::parse(text).unwrap());
    // A torque by a law: the bar gets ∫ F dt/I.
    let mut air = pendulum::<D>(Some(Motor { force: formula("3*t"), ..Motor::default() }));
    let i = inertia(&air.solids[0]) + body(&air.solids[0]).mass * 0.04;
    air = Air::new(air.solids, joined(air.rig.joints.remove(0).spec), 0.0);
    air.run(1e-4, 0.2);
    assert!((air.rig.joint(0).rate / (1.5 * 0.04 / i) - 1.0).abs() < 1e-9, "{:?}", air.rig.joint(0));
    // A servo holds its angle against the weight but for the sag F/k, and a drive keeps its pace.
    let servo = Motor { position: formula("0.4*min(t, 1)"), ..Motor::damping(300.0) };
    let mut air = pendulum::<D>(Some(Motor { stiffness: Law::constant(2e4), ..servo }));
    air.run(1e-3, 2.0);
    let (reading, m) = (air.rig.joint(0), body(&air.solids[0]).mass);
    let weight = m * G * 0.2 * reading.position.sin();
    assert!((reading.motor / weight - 1.0).abs() < 1e-3, "{D}-D: {reading:?} for {weight}");
    assert!((0.4 - reading.position - weight / 2e4).abs() < 1e-5, "{D}-D: {reading:?}");
    let drive = Motor { velocity: Some(Law::constant(-1.5)), ..Motor::damping(1e9) };
    let mut air = pendulum::<D>(Some(drive.clone()));
    air.run(1e-3, 4.0);
    // Stiffer than any step, and past half a turn.
    let turned = air.rig.joint(0).position;
    // As fast as it should but for what the weight gathers in a step.
    assert!((air.rig.joint(0).rate + 1.5).abs() < 1e-3 * m * G * 0.2 / i, "{D}-D: {:?}", air.rig.joint(0));
    assert!((turned - (TAU - 6.0)).abs() < 1e-2, "{D}-D: {turned}");
    // One that is too weak does not lift the bar.
    let mut air = pendulum::<D>(Some(Motor { strongest: 0.1 * m * G * 0.2, ..drive }));
    air.run(1e-3, 2.0);
    assert!(air.rig.joint(0).position.abs() < 0.25, "{D}-D: {:?}", air.rig.joint(0));
}

#[test]
fn a_motor_pushes_holds_and_turns_as_its_laws_say() {
    motors::<2>();
    motors::<3>();
}

fn stops<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    let solids = vec![bar("bar", 0.4, point(0.2, 0.0), true)];
    let m = body(&solids[0]).mass;
    let joint = hinge([None, Some(0)], Vector::<D>::zeros()).limits(-0.5, 0.5);
    let mut air = Air::new(solids, joined(joint), G);
    air.run(1e-4, 1.5);
    let reading = air.rig.joint(0);
    assert!((reading.position.abs() - 0.5).abs() < 1e-5, "{D}-D: {reading:?}");
    // At rest on its stop: that carries the moment of the weight.
    let moment = Wedge::torque(&point(0.2 * 0.5f64.cos(), 0.0), &point(0.0, m * G));
    assert!((reading.torque + moment * -1.0).0.norm() < 1e-3 * m * G, "{D}-D: {reading:?} for {moment:?}");

    let weight = bar("weight", 0.2, point(0.3, 1.0), false);
    let joint = slider([None, Some(0)], point(0.0, 1.0), point::<D>(0.0, 1.0)).limits(-0.25, 0.1);
    let mut air = Air::new(vec![weight], joined(joint), G);
    air.run(1e-4, 1.0);
    assert!((air.now()[0].pose.position[D - 1] - 0.75).abs() < 1e-6, "{:?}", air.now());
    assert!((air.rig.joint(0).force[D - 1] / (body(&air.solids[0]).mass * G) - 1.0).abs() < 1e-3);
}

#[test]
fn an_end_stop_holds_and_carries_what_rests_on_it() {
    stops::<2>();
    stops::<3>();
}

#[test]
fn a_ball_joint_turns_every_way_and_a_hinge_one() {
    let spin = Wedge::<3>::from_axial(&[1.0, -2.0, 3.0]);
    let run = |kind| {
        let solids = vec![bar("bar", 0.4, point(0.0, 0.2), false)];
        let joint = JointSpec::new("joint", kind, [None, Some(0)], Vector::zeros(), Vector::from([0.0, 1.0, 0.0]));
        let mut air = Air::new(solids, joined(joint), 0.0);
        air.engine.set_velocity(0, &spin.at(&point(0.0, 0.2)), &spin);
        air.run(1e-4, 0.5);
        let now = air.now()[0];
        assert!(now.pose.point(&point(0.0, -0.2)).norm() < 1e-6, "it left its joint: {now:?}");
        now.spin.axial()
    };
    let free = run(JointKind::Ball);
    assert!(free.iter().all(|w| w.abs() > 0.1), "{free:?}");
    let held = run(JointKind::Hinge);
    assert!(held[0].abs() < 1e-6 && held[2].abs() < 1e-6 && (held[1] + 2.0).abs() < 1e-3, "{held:?}");
}

#[test]
fn a_hinge_goes_where_what_it_is_pinned_to_is_driven() {
    let motion = Motion::slide(Vector::from([1.0, 0.0]), Law::Formula(Formula::parse("0.1*t^2").unwrap()));
    let cart = SolidSpec { role: Role::Driven(motion), ..bar::<2>("cart", 0.2, point(0.0, 0.0), true) };
    let solids = vec![cart, bar("bar", 0.4, point(0.0, -0.2), false)];
    let m = body(&solids[1]).mass;
    let joint = hinge([Some(0), Some(1)], Vector::zeros()).motor(Motor::damping(30.0));
    let mut air = Air::new(solids, joined(joint), G);
    air.run(1e-4, 3.0);
    // It trails behind by atan(a/g), towed with a = 0.2 m/s² at the speed of the cart.
    let reading = air.rig.joint(0);
    assert!((reading.position.abs() - (0.2f64 / G).atan()).abs() < 1e-4, "{reading:?}");
    assert!((reading.force - Vector::from([0.2 * m, G * m])).norm() < 1e-2 * m, "{reading:?}");
    assert!((air.now()[1].velocity[0] - 0.6).abs() < 1e-3);
}

#[test]
fn jointed_bodies_that_are_hit_keep_momentum_and_angular_momentum() {
    let mut solids = vec![bar::<2>("left", 0.4, point(-0.21, 0.0), true), bar("right", 0.4, point(0.21, 0.0), true)];
    solids.push(bar("ball", 0.1, point(0.35, 0.3), true));
    let Role::Free(ball) = &mut solids[2].role else { panic!() };
    ball.velocity = Vector::from([0.0, -1.0]);
    let mut air = Air::new(solids, joined(hinge([Some(0), Some(1)], Vector::zeros())), 0.0);
    let momentum = |air: &Air<2>| {
        air.now().iter().zip(&air.solids).fold((Vector::<2>::zeros(), 0.0), |(p, l), (now, solid)| {
            let linear = now.velocity * body(solid).mass;
            let own = inertia(solid) * now.spin.axial()[0];
            (p + linear, l + own + Wedge::torque(&now.centre, &linear).axial()[0])
        })
    };
    let before = momentum(&air);
    air.run(1e-4, 1.0);
    let after = momentum(&air);
    assert!(air.now()[0].velocity.norm() > 0.01, "the blow went through the hinge: {:?}", air.now()[0]);
    assert!((after.0 - before.0).norm() < 1e-10 * before.0.norm(), "{before:?} {after:?}");
    // The contact's and the joint's points differ by what they give: first order in the step.
    assert!((after.1 / before.1 - 1.0).abs() < 1e-4, "{before:?} {after:?}");
}

fn springs<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    let solids = vec![bar("a", 0.2, point(0.0, 0.0), true), bar("b", 0.2, point::<D>(1.0, 0.0), true)];
    let ends = [(Some(0), 0.1), (Some(1), 0.9)].map(|(solid, x)| End { solid, at: point(x, 0.0) });
    let spec = SpringSpec {
        name: "spring".into(),
        ends,
        stiffness: 400.0,
        damping: 0.0,
        length: Some(0.7),
        tension_only: false,
    };
    let m = body(&solids[0]).mass;
    let links = Links { springs: vec![spec.clone()], ..Links::default() };
    let mut air = Air::new(solids.clone(), links, 0.0);
    // Two equal masses: ω² = 2 k/m.
    let omega = (800.0 / m).sqrt();
    let limit = air.rig.limit(&*air.engine, &air.now(), air.t);
    assert!((limit * omega - 0.2).abs() < 1e-9, "the bound is exact for a pair: {limit}");
    let period = air.period(0.5 * limit, 5, |air| air.rig.spring(0).length - 0.7);
    // (0.1)²/24 too fast at half of the longest step.
    assert!((period * omega / TAU - 1.0).abs() < 6e-4, "{D}-D: {period}");
    let most = (0..2000).fold(0.0, |most: f64, _| {
        air.step(1e-3);
        most.max(air.rig.spring(0).tension)
    });
    // No energy is lost; where in a step it turned changes the amplitude by (Δt ω)²/8, twice.
    assert!((most / 40.0 - 1.0).abs() < 2.6e-3, "{most}");

    // A mooring line lets what comes nearer come nearer, and pulls what goes away.
    let slack = SpringSpec { tension_only: true, length: None, ..spec };
    let mut air = Air::new(solids, Links { springs: vec![slack], ..Links::default() }, 0.0);
    air.engine.set_velocity(1, &point(-0.1, 0.0), &Wedge::zero());
    air.run(1e-3, 1.0);
    assert_eq!((air.now()[1].velocity[0], air.rig.spring(0).tension), (-0.1, 0.0));
    air.engine.set_velocity(1, &point(0.5, 0.0), &Wedge::zero());
    air.run(1e-3, 2.0);
    assert!(air.now()[0].velocity[0] > 0.1, "{:?}", air.now());
}

#[test]
fn springs_swing_with_their_period_and_mooring_lines_never_push() {
    springs::<2>();
    springs::<3>();
}

#[test]
fn a_damped_spring_settles_whatever_its_damping() {
    for damping in [200.0, 600.0, 2000.0, 1e7] {
        let solids = vec![bar::<2>("box", 0.2, point(0.0, 0.0), true)];
        let weight = body(&solids[0]).mass * G;
        let ends = [End { solid: Some(0), at: point(0.0, 0.05) }, End { solid: None, at: point(0.0, 1.0) }];
        let spec =
            SpringSpec { name: "line".into(), ends, stiffness: 2000.0, damping, length: None, tension_only: true };
        let mut air = Air::new(solids, Links { springs: vec![spec], ..Links::default() }, G);
        let limit = air.rig.limit(&*air.engine, &air.now(), air.t);
        assert!((limit - 0.2 / 10.0).abs() < 1e-12, "damping does not shorten the step: {limit}");
        air.run(1e-3, 20.0);
        let reading = air.rig.spring(0);
        let sag = (reading.length - 0.95) / (weight / 2000.0);
        if damping == 1e7 {
            // Far too stiff for the step, it creeps down, and never faster than the weight gathers speed in a step.
            assert!(0.0 < sag && sag < 1.0 && air.now()[0].velocity[1].abs() < 1.01 * G * 1e-3, "{reading:?}");
            continue;
        }
        assert!((sag - 1.0).abs() < 1e-6 && (reading.tension / weight - 1.0).abs() < 1e-6, "{damping}: {reading:?}");
    }
}

fn ropes<const D: usize>(dt: f64, speed: f64)
where
    Dim<D>: HasEngine<D>,
{
    // Thrown across, made fast beside its centre: it runs out the slack, is jerked round, and swings on.
    let solids = vec![bar("stone", 0.2, point::<D>(0.2, -0.5), true)];
    let ends = [End { solid: None, at: Vector::zeros() }, End { solid: Some(0), at: point(0.25, -0.45) }];
    let rope = RopeSpec { name: "rope".into(), ends, length: Some(0.8) };
    let mut air = Air::new(solids, Links { ropes: vec![rope], ..Links::default() }, G);
    air.engine.set_velocity(0, &point(speed, 0.2), &Wedge::zero());
    let (mut longest, mut taut): (f64, f64) = (0.0, 0.0);
    while air.t < 2.0 {
        air.step(dt);
        longest = longest.max(air.rig.rope(0).length);
        taut = taut.max(air.rig.rope(0).tension);
    }
    assert!(taut > 0.0 && longest > 0.8 * (1.0 - 1e-3), "it came taut: {longest}");
    assert!(longest < 0.8 * (1.0 + 1e-6), "{D}-D, {speed} m/s, {dt} s: {:e} too long", longest / 0.8 - 1.0);
}

#[test]
fn a_rope_is_never_longer_than_its_length() {
    for speed in [0.0, 1.0, 3.0] {
        ropes::<2>(2e-4, speed);
        ropes::<3>(2e-4, speed);
    }
}

#[test]
fn a_rope_at_rest_carries_the_weight() {
    let solids = vec![bar::<2>("stone", 0.2, point(0.0, -0.5), true)];
    let weight = body(&solids[0]).mass * G;
    let ends = [End { solid: None, at: Vector::zeros() }, End { solid: Some(0), at: point(0.0, -0.45) }];
    let rope = RopeSpec { name: "rope".into(), ends, length: None };
    let mut air = Air::new(solids, Links { ropes: vec![rope], ..Links::default() }, G);
    air.run(1e-3, 1.0);
    assert!((air.rig.rope(0).tension / weight - 1.0).abs() < 1e-6, "{:?}", air.rig.rope(0));
}

#[test]
fn a_thrust_turns_with_its_body_and_wind_does_not() {
    let run = |turns: bool, at: Option<Vector<2>>| {
        let solids = vec![bar::<2>("boat", 0.4, point(0.0, 0.0), true)];
        let force = vec![Law::constant(12.0), Law::constant(0.0)];
        let thrust = ForceSpec { name: "thrust".into(), solid: 0, at, force, torque: vec![], turns };
        let mut air = Air::new(solids, Links { forces: vec![thrust], ..Links::default() }, 0.0);
        air.engine.set_velocity(0, &Vector::zeros(), &Wedge::from_axial(&[PI]));
        air.run(1e-4, 1.0);
        (air.now()[0], body(&air.solids[0]), inertia(&air.solids[0]))
    };
    let (wind, boat, inertia) = run(false, None);
    assert!((wind.velocity - Vector::from([12.0 / boat.mass, 0.0])).norm() < 1e-12);
    // Turned by half a turn in 1 s: ∫ (cos πt, sin πt) dt = (0, 2/π).
    let (thrust, ..) = run(true, None);
    assert!((thrust.velocity - Vector::from([0.0, 12.0 / boat.mass * 2.0 / PI])).norm() < 1e-4, "{thrust:?}");
    // Beside the centre, turning with the body, it gives a constant torque.
    let (beside, ..) = run(true, Some(Vector::from([0.0, 0.05])));
    assert!((beside.spin.axial()[0] - PI + 12.0 * 0.05 / inertia).abs() < 1e-9, "{beside:?}");
}

/// How fast a box of friction 0.5 runs down a plane of friction 0.5 after 1 s, of a slope of 20 degrees.
fn slides(contact: Option<ContactSpec>) -> f64 {
    let slope = 20f64.to_radians();
    let tilt = |x: f64, y: f64| Pose {
        position: Pose::turned(Vector::zeros(), &[slope]).point(&[x, y].into()),
        ..Pose::turned(Vector::zeros(), &[slope])
    };
    let plane =
        SolidSpec { pose: tilt(0.0, -0.05), role: Role::Fixed, ..bar::<2>("plane", 8.0, Vector::zeros(), true) };
    let stone = SolidSpec { pose: tilt(0.0, 0.05), ..bar("stone", 0.2, Vector::zeros(), true) };
    let links = Links { contacts: contact.into_iter().collect(), ..Links::default() };
    let mut air = Air::new(vec![plane, stone], links, G);
    air.run(1e-4, 1.0);
    air.now()[1].velocity.norm()
}

#[test]
fn a_box_slides_above_the_angle_of_friction_and_sticks_below() {
    let pair =
        |friction: f64| ContactSpec { between: [1, 0], touch: true, friction: Some(friction), restitution: None };
    let (limit, slope) = (20f64.to_radians().tan(), 20f64.to_radians());
    assert!(slides(None) < 1e-6, "tan 20° is below the mean of both frictions, 0.5");
    assert!(slides(Some(pair(1.02 * limit))) < 1e-3, "sticks");
    // Just above, and without friction: v = g t (sin − μ cos).
    for friction in [0.98 * limit, 0.5 * limit, 0.0] {
        let exact = G * (slope.sin() - friction * slope.cos());
        let found = slides(Some(pair(friction)));
        assert!((found - exact).abs() < 1e-2 * exact + 1e-3, "{friction}: {found}, exact {exact}");
    }
    let apart = ContactSpec { touch: false, ..pair(0.0) };
    assert!((slides(Some(apart)) / G - 1.0).abs() < 1e-9, "falls through");
}

#[test]
fn a_towed_body_goes_with_its_carriage_and_is_free_in_all_else() {
    let motion = Motion::slide(Vector::from([1.0, 0.0]), Law::Formula(Formula::parse("0.2*t^2").unwrap()));
    let carriage = SolidSpec { role: Role::Driven(motion), ..bar::<2>("carriage", 0.2, point(0.0, 1.0), true) };
    let mut solids = vec![carriage, bar("model", 0.4, point(0.1, 0.0), true)];
    let Role::Free(model) = &mut solids[1].role else { panic!() };
    model.spin = Wedge::from_axial(&[0.7]);
    let tow = JointSpec::new("tow", JointKind::Tow, [Some(0), Some(1)], point(0.1, 0.0), Vector::from([1.0, 0.0]));
    let mut air = Air::new(solids, joined(tow), G);
    air.run(1e-4, 1.0);
    let (now, m) = (air.now()[1], body(&air.solids[1]).mass);
    // First order in the step: ½ g t Δt of the fall.
    assert!((now.centre - Vector::from([0.3, -0.5 * G])).norm() < 1e-3, "{now:?}");
    assert!((now.spin.axial()[0] - 0.7).abs() < 1e-9 && (now.velocity[0] - 0.4).abs() < 1e-3);
    let reading = air.rig.joint(0);
    assert!((reading.force - Vector::from([0.4 * m, 0.0])).norm() < 1e-2 * m, "it is towed with m a: {reading:?}");
}

#[test]
fn a_held_body_stays_until_it_is_let_go() {
    let solids = vec![bar::<2>("stone", 0.2, point(0.0, 0.0), true)];
    let mut air = Air::new(solids, Links { holds: vec![Hold { solid: 0, until: 0.5 }], ..Links::default() }, G);
    air.engine.push(0, &Vector::from([50.0, 0.0]), &Vector::from([0.0, 0.3]));
    air.run(1e-3, 0.4999);
    assert_eq!((air.now()[0].velocity, air.now()[0].centre), (Vector::zeros(), Vector::zeros()));
    assert!((air.rig.limit(&*air.engine, &air.now(), 0.4999) - 1e-4).abs() < 1e-12, "no step goes past the letting go");
    air.run(1e-3, 1.5);
    assert!((air.now()[0].velocity - Vector::from([0.0, -G])).norm() < 1e-2, "{:?}", air.now()[0]);
}

fn restores<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    let make = || {
        let mut solids: Vec<SolidSpec<D>> =
            (0..4).map(|i| bar(&format!("link{i}"), 0.3, point(0.15 + 0.3 * f64::from(i), 0.0), true)).collect();
        let motion = Motion::slide(point(0.0, 1.0), Law::Formula(Formula::parse("0.05*sin(3*t)").unwrap()));
        solids.push(SolidSpec { role: Role::Driven(motion), ..bar("cart", 0.3, point(1.35, 0.0), true) });
        let mut joints: Vec<_> =
            (0..4).map(|i| hinge([Some(i), Some(i + 1)], point(0.3 * (i + 1) as f64, 0.0))).collect();
        joints[1].motor =
            Some(Motor { force: Law::Formula(Formula::parse("sin(5*t)").unwrap()), ..Motor::damping(3.0) });
        joints[2].limits = Some([-0.3, 0.3]);
        for (i, joint) in joints.iter_mut().enumerate() {
            joint.name = format!("hinge{i}");
        }
        let line = |a: Option<usize>, x: f64, y: f64| {
            [End { solid: Some(0), at: point(0.1, 0.0) }, End { solid: a, at: point(x, y) }]
        };
        let spring = SpringSpec {
            name: "spring".into(),
            ends: line(None, 0.1, 1.0),
            stiffness: 200.0,
            damping: 5.0,
            length: None,
            tension_only: true,
        };
        let rope = RopeSpec { name: "rope".into(), ends: line(None, 0.1, 0.3), length: None };
        Air::new(solids, Links { joints, springs: vec![spring], ropes: vec![rope], ..Links::default() }, G)
    };
    let mut whole = make();
    whole.run(5e-4, 0.3);
    let drive = Drive { force: 1.0, position: 0.1, velocity: 0.0, stiffness: 10.0, damping: 1.0, strongest: 5.0 };
    whole.rig.drive(0, Some(drive));
    *whole.rig.elastic(0) = Elastic { stiffness: 300.0, damping: 1.0, length: 0.9 };
    whole.run(5e-4, 0.4);
    let (kept, state, t) = (whole.engine.save().unwrap(), whole.rig.save(), whole.t);
    let mut other = make();
    other.engine.restore(&kept).unwrap();
    assert!(other.rig.restore(state));
    other.t = t;
    whole.run(5e-4, 0.8);
    other.run(5e-4, 0.8);
    assert_eq!(whole.now(), other.now());
    let readings = |air: &Air<D>| (0..4).map(|i| air.rig.joint(i)).collect::<Vec<JointReading<D>>>();
    assert_eq!(readings(&whole), readings(&other));
    assert_eq!(whole.engine.save().unwrap(), other.engine.save().unwrap());
    assert!(readings(&whole)[1].absorbed != 0.0 && whole.rig.rope(0).tension > 0.0);
    // The chain holds together: no hinge opens by more than 10 µm.
    for i in 0..4 {
        let ends = whole.rig.joints[i].ends(&whole.now());
        let gap = ends[0].pose.point(&point(0.15, 0.0)) - ends[1].pose.point(&point(-0.15, 0.0));
        assert!(gap.norm() < 1e-5, "{D}-D, hinge {i}: {}", gap.norm());
    }
}

#[test]
fn restored_ties_go_on_to_the_same_bits() {
    restores::<2>();
    restores::<3>();
}

#[test]
fn ties_that_cannot_be_meant_are_refused_in_words() {
    let solids = || {
        let fixed = SolidSpec { role: Role::Fixed, ..bar::<2>("wall", 0.2, point(0.0, 1.0), true) };
        vec![bar("box", 0.2, point(0.0, 0.0), true), fixed]
    };
    let said = |links: Links<2>| Air::made(solids(), links, G).map(|_| ()).unwrap_err().to_string();
    let joint = |joint: JointSpec<2>| said(joined(joint));
    let at = Vector::zeros();
    assert!(joint(hinge([None, Some(1)], at)).contains("\"wall\" is not free"));
    assert!(joint(hinge([Some(0), Some(0)], at)).contains("to itself"));
    assert!(joint(hinge([None, Some(7)], at)).contains("not there"));
    assert!(joint(slider([None, Some(0)], at, Vector::zeros())).contains("has no axis"));
    assert!(joint(hinge([None, Some(0)], at).limits(0.1, 0.5)).contains("has limits 0.1 to 0.5"));
    assert!(
        joint(JointSpec { kind: JointKind::Fixed, ..hinge([None, Some(0)], at).limits(-0.1, 0.5) })
            .contains("no coordinate")
    );
    let twice = Links { joints: vec![hinge([None, Some(0)], at), hinge([None, Some(0)], at)], ..Links::default() };
    assert!(said(twice).contains("sits where joint \"hinge\""));
    let ends = [End { solid: Some(0), at }, End { solid: None, at: point(0.0, 1.0) }];
    let spring = |stiffness: f64, damping: f64| {
        let spring = SpringSpec { name: "s".into(), ends, stiffness, damping, length: None, tension_only: false };
        said(Links { springs: vec![spring], ..Links::default() })
    };
    assert!(spring(-1.0, 0.0).contains("stiffness of -1") && spring(1.0, -2.0).contains("damping of -2"));
    assert!(spring(0.0, 0.0).contains("neither stiff nor damped"));
    let rope = RopeSpec { name: "r".into(), ends, length: Some(0.9) };
    assert!(said(Links { ropes: vec![rope], ..Links::default() }).contains("start 1 m apart"));
}
