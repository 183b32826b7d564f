//! Contacts: Newton's law of restitution, conservation, stacks of unequal masses, and contact loads.

use super::*;

/// Position, velocity and spin after 0.2 s of a cube of 0.1 m that hits a wall flat with 1 m/s, 1 cm off the middle of the wall. Both
/// have the restitution `e`.
fn bounced<const D: usize>(e: f64) -> (f64, Vector<D>, Bivector<D>)
where
    Dim<D>: HasEngine<D>,
{
    let mut velocity = Vector::zeros();
    velocity[0] = 1.0;
    let (mut wall, mut start) = ([0.0; D], [0.0; D]);
    (wall[0], wall[1], start[0]) = (0.65, 0.01, 0.0);
    let mut solids = [
        solid("wall", cube(1.0), wall, Role::Fixed),
        solid("cube", cube(0.1), start, Role::Free(FreeBody { velocity, ..light() })),
    ];
    solids.iter_mut().for_each(|solid| solid.restitution = e);
    let mut engine = engine(&solids, Vector::zeros()).unwrap();
    for _ in 0..200 {
        engine.step(1e-3, &idle(2), &[None, None]).unwrap();
    }
    let now = engine.kinematics(1);
    (now.pose.position[0], now.velocity, now.spin)
}

fn bounces<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    for e in [0.2, 0.5, 1.0] {
        let (x, velocity, spin) = bounced::<D>(e);
        // Newton's law to round-off; the cube rebounds up to a step and a half before the wall, 0.1 m away.
        assert!((velocity[0] + e).abs() < 1e-9 && spin.0.norm() < 1e-7, "{e}: {velocity} {spin:?}");
        assert!((x - (0.1 - 0.1 * e)).abs() < 3.1e-3, "{e}: at {x} m");
    }
}

#[test]
fn a_cube_rebounds_with_its_restitution_and_without_spin() {
    bounces::<2>();
    bounces::<3>();
}

/// Largest relative error of the rebound speed of cubes that fall from 25 heights on a floor in steps of `dt` (s), all with the
/// restitution `e`. The places of the last step before the floor are spread evenly over the way of a step.
fn worst_rebound<const D: usize>(e: f64, edge: f64, dt: f64) -> f64
where
    Dim<D>: HasEngine<D>,
{
    let mut worst: f64 = 0.0;
    for drop in 0..25 {
        let height = 0.378 + 1e-4 * f64::from(drop);
        let mut solids = [floor(), solid("cube", cube(edge), at_height(height + 0.5 * edge), Role::Free(light::<D>()))];
        solids.iter_mut().for_each(|solid| solid.restitution = e);
        let mut engine = engine(&solids, down()).unwrap();
        let mut rising = 0.0;
        while rising <= 0.0 {
            engine.step(dt, &idle(2), &[None, None]).unwrap();
            rising = engine.kinematics(1).velocity[D - 1];
        }
        worst = worst.max((rising / (e * (2.0 * G * height).sqrt()) - 1.0).abs());
    }
    worst
}

/// Newton's law: the speed after is e √(2 g h). The cube rebounds up to a step and a half before the floor, where its speed is lower
/// by 1.5 g Δt, and has lost g Δt after its first step up: 0.7 % of 2.72 m/s at e = 1, and 0.9 % at e = 0.5. A thin cube needs a search
/// far ahead.
#[test]
fn the_rebound_has_the_restitution_from_any_height() {
    for (e, edge) in [(0.5, 0.1), (1.0, 0.1), (0.5, 0.01)] {
        for worst in [worst_rebound::<2>(e, edge, 7e-4), worst_rebound::<3>(e, edge, 7e-4)] {
            assert!(worst < 0.01, "e = {e}, {edge} m: {worst}");
        }
    }
}

fn collides<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    let mut velocity = Vector::zeros();
    (velocity[0], velocity[D - 1]) = (2.0, 0.3);
    let (mut left, mut right) = ([0.0; D], [0.0; D]);
    (left[0], right[0], right[D - 1]) = (-0.2, 0.0, 0.04);
    let heavy = FreeBody { mass: 60.0, ..light() };
    let mut solids = [
        solid("striking", cube(0.1), left, Role::Free(FreeBody { velocity, ..light() })),
        solid("struck", cube(0.1), right, Role::Free(heavy)),
    ];
    solids.iter_mut().for_each(|solid| solid.restitution = 0.8);
    let mut engine = engine(&solids, Vector::zeros()).unwrap();
    let bodies = [light::<D>(), heavy];
    let measure = |engine: &dyn Engine<D>| {
        let (mut momentum, mut energy) = (Vector::zeros(), 0.0);
        for (i, body) in bodies.iter().enumerate() {
            let now = engine.kinematics(i);
            let spin = now.spin.axial();
            momentum += now.velocity * body.mass;
            // The bodies rotate about one axis mainly, so their inertia is that of the start.
            let turning = (0..Bivector::<D>::COMPONENTS).map(|k| body.inertia[(k, k)] * spin[k] * spin[k]).sum::<f64>();
            energy += 0.5 * (body.mass * now.velocity.norm_squared() + turning);
        }
        (momentum, energy)
    };
    let before = measure(&*engine);
    for _ in 0..200 {
        engine.step(1e-3, &idle(2), &[None, None]).unwrap();
    }
    let after = measure(&*engine);
    assert!((after.0 - before.0).norm() < 1e-10 * before.0.norm(), "momentum {before:?} {after:?}");
    assert!(after.1 < before.1 && engine.kinematics(1).velocity[0] > 0.05, "energy {before:?} {after:?}");
}

#[test]
fn a_collision_conserves_momentum_and_gains_no_energy() {
    collides::<2>();
    collides::<3>();
}

/// Sinkage (m) in 0.5 s of the upper of two cubes on a floor, `ratio` times as heavy as the lower one, with steps of 1 ms.
fn stack_sinkage<const D: usize>(ratio: f64) -> f64
where
    Dim<D>: HasEngine<D>,
{
    let heavy = FreeBody { mass: 2.0 * ratio, inertia: light::<D>().inertia * ratio, ..light() };
    let solids = [
        floor(),
        solid("lower", cube(0.1), at_height(0.05), Role::Free(light())),
        solid("upper", cube(0.1), at_height(0.15), Role::Free(heavy)),
    ];
    let mut engine = engine(&solids, down()).unwrap();
    for _ in 0..500 {
        engine.step(1e-3, &idle(3), &[None; 3]).unwrap();
    }
    0.15 - engine.kinematics(2).pose.position[D - 1]
}

#[test]
fn a_light_box_supports_a_box_ten_thousand_times_as_heavy() {
    // Two contacts deform as under equal boxes: a millimetre with springs of 50 Hz at this step. The bound is a tenth of
    // dp = 2 cm, as in `pontoon stress`.
    for ratio in [1.0, 100.0, 1e4] {
        let sinks = [stack_sinkage::<2>(ratio), stack_sinkage::<3>(ratio)];
        assert!(sinks.iter().all(|sink| (0.0..2e-3).contains(sink)), "{ratio}: {sinks:?}");
    }
}

/// Relative difference of the sum of contact loads, weight and `load` from the change of momentum of solid `i` in the last step.
fn relative_residual<const D: usize>(
    engine: &dyn Engine<D>,
    i: usize,
    before: &Kinematics<D>,
    load: Load<D>,
    dt: f64,
) -> f64 {
    let (now, mobility) = (engine.kinematics(i), engine.mobility(i));
    let contacts = engine.contacts();
    let touches = contacts.iter().flat_map(|c| c.between.into_iter().zip(c.loads)).filter(|(solid, _)| *solid == i);
    let touches: Load<D> = touches.map(|(_, load)| load).sum();
    let all =
        Load { force: touches.force + load.force + down() / mobility.linear[0], torque: touches.torque + load.torque };
    let change = (now.velocity - before.velocity) / (dt * mobility.linear[0]);
    let linear = (change - all.force).norm() / touches.force.norm().max(change.norm()).max(load.force.norm()).max(1.0);
    // In 3-D the engine rotates the body during the step, so only the 2-D torque balance is exact.
    if D == 3 {
        return linear;
    }
    let turn = (now.spin + before.spin * -1.0).axial()[0] / (dt * mobility.angular[(0, 0)]);
    linear.max((turn - all.torque.axial()[0]).abs() / touches.torque.axial()[0].abs().max(1.0))
}

fn adds_up<const D: usize>(heavy: f64, restitution: f64)
where
    Dim<D>: HasEngine<D>,
{
    let body = |mass: f64, side: f64| FreeBody {
        mass,
        inertia: Matrix::identity() * (mass * side * side / 6.0),
        velocity: Vector::from_fn(|i, _| if i == 0 { 0.4 } else { 0.0 }),
        ..light()
    };
    let mut solids = [
        floor(),
        solid("lower", cube(0.1), at_height(0.06), Role::Free(body(2.0, 0.1))),
        solid("upper", cube(0.08), at_height(0.17), Role::Free(body(heavy, 0.08))),
    ];
    solids.iter_mut().for_each(|solid| solid.restitution = restitution);
    let mut engine = engine(&solids, down()).unwrap();
    let mut touched = [0; 2];
    for step in 0..4000 {
        let mut loads = idle(3);
        loads[1].force[0] = 3.0 * (0.01 * f64::from(step)).sin();
        let before = [1, 2].map(|i| engine.kinematics(i));
        engine.step(1e-4, &loads, &[None; 3]).unwrap();
        for (i, before) in [1, 2].into_iter().zip(&before) {
            let off = relative_residual(&*engine, i, before, loads[i], 1e-4);
            assert!(off < 1e-9, "{D}-D, {heavy} kg, restitution {restitution}, step {step}, solid {i}: {off:e}");
            touched[i - 1] += engine.contacts().iter().filter(|c| c.between.contains(&i)).count();
        }
    }
    assert!(touched.iter().all(|&steps| steps > 100), "the bodies land, slide and rest: {touched:?}");
}

#[test]
fn contact_loads_sum_to_the_change_of_momentum() {
    // Round-off of forces of 1e2 N that nearly cancel. The third case has several iterations a step, the last one rebounds.
    for (heavy, restitution) in [(1.0, 0.0), (20.0, 0.0), (200.0, 0.0), (2.0, 0.5)] {
        adds_up::<2>(heavy, restitution);
        adds_up::<3>(heavy, restitution);
    }
}

/// A frictionless impact acts through the centre of a ball: at the point of a floor under it, and of another ball beside it, at any
/// speed along the face and with any spin.
fn glances<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    let spin = Bivector::from_axial(&[0.5, 3.0, -1.0][..Bivector::<D>::COMPONENTS]);
    let ball = |at: [f64; D], velocity: [f64; 2]| {
        let velocity = Vector::from_fn(|i, _| {
            if i == 0 {
                velocity[0]
            } else if i == D - 1 {
                velocity[1]
            } else {
                0.0
            }
        });
        let role = Role::Free(FreeBody { velocity, spin, inertia: Matrix::identity() * 2e-3, ..light() });
        SolidSpec { restitution: 1.0, friction: 0.0, ..solid("ball", Shape::Ball { radius: 0.1 }, at, role) }
    };
    let mut across = at_height(0.3);
    across[0] = 0.06;
    let long = Vector::from_fn(|i, _| if i == 0 { 40.0 } else { 1.0 });
    let under = SolidSpec {
        restitution: 1.0,
        friction: 0.0,
        ..solid("floor", Shape::Box { size: long }, at_height(-0.5), Role::Fixed)
    };
    for solids in [
        vec![under.clone(), ball(at_height(0.15), [10.0, -2.0])],
        vec![ball(at_height(0.15), [10.0, -2.0]), under],
        vec![ball(at_height(0.05), [3.0, 0.0]), ball(across, [3.0, -2.0])],
    ] {
        let mut engine = engine(&solids, Vector::zeros()).unwrap();
        let mut hits = 0;
        for _ in 0..100 {
            engine.step(1e-3, &idle(2), &[None; 2]).unwrap();
            hits += engine.contacts().len();
        }
        assert!(hits > 0, "{D}-D: they touch");
        for (i, ball) in solids.iter().enumerate().filter(|(_, solid)| matches!(solid.role, Role::Free(_))) {
            let off = (engine.kinematics(i).spin + ball.initial_kinematics().spin * -1.0).0.norm();
            // The search for the nearest points of curved faces ends within 1e-9 of their size.
            assert!(off < 1e-6, "{D}-D: {} gains {off} rad/s", ball.name);
        }
    }
}

#[test]
fn a_frictionless_impact_leaves_the_spin_of_a_ball() {
    glances::<2>();
    glances::<3>();
}

/// A box that slides, turned by 45°, hits a frictionless floor with a corner: the impulse j = (1 + e) v m/(1 + r²/k²) acts at the corner,
/// r beside the centre, and gives the spin j r/I.
fn strikes_with_a_corner<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    let (edge, turn, [mass, inertia]) = (0.1, 0.6_f64, [2.0, 2e-3]);
    let half = 0.5 * edge * 2f64.sqrt();
    // The lowest corner lies at −135° in the frame of the box.
    let corner = [half * (turn - 0.75 * std::f64::consts::PI).cos(), half * (turn - 0.75 * std::f64::consts::PI).sin()];
    let velocity = Vector::from_fn(|i, _| {
        if i == 0 {
            10.0
        } else if i == D - 1 {
            -2.0
        } else {
            0.0
        }
    });
    let role = Role::Free(FreeBody { mass, velocity, inertia: Matrix::identity() * inertia, ..light() });
    // About −y in 3-D, which turns x to z.
    let axial = if D == 2 { vec![turn] } else { vec![0.0, -turn, 0.0] };
    let mut body = solid("box", cube(edge), at_height(0.05 - corner[1]), role);
    body.pose.rotation = Bivector::from_axial(&axial).exp();
    let long = Vector::from_fn(|i, _| if i == 0 { 40.0 } else { 1.0 });
    let mut solids = [solid("floor", Shape::Box { size: long }, at_height(-0.5), Role::Fixed), body];
    solids.iter_mut().for_each(|solid| (solid.restitution, solid.friction) = (0.5, 0.0));
    let mut engine = engine(&solids, Vector::zeros()).unwrap();
    for _ in 0..28 {
        engine.step(1e-3, &idle(2), &[None; 2]).unwrap();
    }
    let impulse = 1.5 * 2.0 / (1.0 / mass + corner[0] * corner[0] / inertia);
    let now = engine.kinematics(1);
    let axial = now.spin.axial();
    let spin = if D == 2 { axial[0] } else { -axial[1] };
    let rise = now.velocity[D - 1] + 2.0;
    assert!((rise / (impulse / mass) - 1.0).abs() < 1e-6, "{D}-D: {rise} m/s of {} m/s", impulse / mass);
    assert!((spin / (impulse * corner[0] / inertia) - 1.0).abs() < 1e-6, "{D}-D: {spin} rad/s");
}

#[test]
fn an_impact_with_a_corner_acts_at_the_corner() {
    strikes_with_a_corner::<2>();
    strikes_with_a_corner::<3>();
}

/// An engine of `solids` without friction and gravity, with the restitution `e` and this joint.
fn joined<const D: usize>(mut solids: Vec<SolidSpec<D>>, e: f64, joint: JointSpec<D>) -> Box<dyn Engine<D>>
where
    Dim<D>: HasEngine<D>,
{
    solids.iter_mut().for_each(|solid| (solid.restitution, solid.friction) = (e, 0.0));
    let start: Vec<_> = solids.iter().map(SolidSpec::initial_kinematics).collect();
    let links = Constraints { joints: vec![joint], ..Constraints::default() };
    Dim::<D>::engine(&solids, &start, &links, &Vector::zeros(), 0.01).unwrap()
}

/// A ball of 10 kg with 2 m/s along the first axis.
fn missile<const D: usize>(x: f64, height: f64) -> SolidSpec<D> {
    let mut at = at_height(height);
    at[0] = x;
    let (shape, mut velocity) = (Shape::Ball { radius: 0.1 }, Vector::zeros());
    velocity[0] = 2.0;
    let body = FreeBody::from_mass(&shape, 10.0).velocity(velocity);
    solid("ball", shape, at, Role::Free(body))
}

fn rebounds_from_a_jointed_body<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    let mut size = Vector::<D>::repeat(0.2);
    size[D - 1] = 1.0;
    let shape = Shape::Box { size };
    let own = FreeBody::from_mass(&shape, 20.0);
    let axis = Vector::from_fn(|i, _| if i == 1 { 1.0 } else { 0.0 });
    for e in [0.5, 1.0] {
        // A bar hangs from a hinge at the origin, and the ball strikes it a = 0.8 m below. About the hinge
        //   m a v + I ω = m a v₀ and ω a − v = e v₀.
        let bar = solid("bar", shape.clone(), at_height(-0.5), Role::Free(own));
        let hinge = JointSpec::new("hinge", JointKind::Hinge, [None, Some(0)], Vector::zeros(), axis);
        let mut engine = joined(vec![bar, missile(-0.3, -0.8)], e, hinge);
        let inertia = own.inertia[if D == 2 { (0, 0) } else { (1, 1) }] + 20.0 * 0.25;
        let spin = 10.0 * 0.8 * 2.0 * (1.0 + e) / (inertia + 10.0 * 0.64);
        let mut now = engine.kinematics(1);
        while now.velocity[0] > 1.99 {
            engine.step(1e-3, &idle(2), &[None; 2]).unwrap();
            now = engine.kinematics(1);
        }
        // The residual of the joints' equations is at most 1e-6; the hinge takes the rest in the step.
        assert!((now.velocity[0] - (spin * 0.8 - 2.0 * e)).abs() < 4e-6, "{e}: {now:?}, spin {spin}");
        let turned = engine.kinematics(0).spin.0.norm() / 2f64.sqrt();
        assert!((turned - spin).abs() < 1e-5 * spin, "{e}: the bar turns with {turned} rad/s, exact {spin}");

        // A plate of the mass of the ball, which a joint holds to the ground, is as a wall.
        let plate = solid("plate", cube(0.4), [0.0; D], Role::Free(FreeBody::from_mass(&cube(0.4), 10.0)));
        let held = JointSpec::new("held", JointKind::Fixed, [None, Some(0)], Vector::zeros(), Vector::zeros());
        let mut engine = joined(vec![plate, missile(-0.4, 0.0)], e, held);
        for _ in 0..100 {
            engine.step(1e-3, &idle(2), &[None; 2]).unwrap();
        }
        assert!((engine.kinematics(1).velocity[0] + 2.0 * e).abs() < 4e-6, "{e}: {:?}", engine.kinematics(1));
    }
}

#[test]
fn a_ball_rebounds_from_a_jointed_body_with_its_restitution() {
    rebounds_from_a_jointed_body::<2>();
    rebounds_from_a_jointed_body::<3>();
}

/// The way (m) in 0.5 s of a body of unit mass and this moment of inertia (kg m²) about its axle, which rolls down a slope of 10°.
fn rolled<const D: usize>(shape: Shape<D>, inertia: f64) -> f64
where
    Dim<D>: HasEngine<D>,
{
    let mut gravity = down::<D>() * 10f64.to_radians().cos();
    gravity[0] = G * 10f64.to_radians().sin();
    let body = FreeBody { mass: 1.0, inertia: Matrix::from_fn(|i, j| if i == j { inertia } else { 0.0 }), ..light() };
    let mut start = at_height(0.1);
    start[0] = -0.3;
    let solids = [floor(), solid("roller", shape, start, Role::Free(body))];
    let mut engine = engine(&solids, gravity).unwrap();
    for _ in 0..1000 {
        engine.step(5e-4, &idle(2), &[None; 2]).unwrap();
    }
    engine.kinematics(1).centre[0] - start[0]
}

#[test]
fn cylinders_and_capsules_roll_as_balls_do() {
    // ½ g sin φ t²/(1 + I/(m r²)), which the engine exceeds by one step in time.
    let inertia = 0.5 * 0.01;
    let exact = 0.5 * G * 10f64.to_radians().sin() * 0.25 / 1.5;
    let cylinder = Shape::Cylinder { length: 0.2, radius: 0.1, axis: 1 };
    let hub = (Pose::identity(), Shape::Ball { radius: 0.05 });
    let compound = Shape::Compound(vec![(Pose::identity(), cylinder.clone()), hub]);
    let rollers = [
        ("ball", rolled::<2>(Shape::Ball { radius: 0.1 }, inertia)),
        ("capsule in 2-D", rolled::<2>(Shape::Capsule { length: 1e-6, radius: 0.1, axis: 0 }, inertia)),
        ("capsule", rolled::<3>(Shape::Capsule { length: 0.2, radius: 0.1, axis: 1 }, inertia)),
        ("cylinder", rolled::<3>(cylinder, inertia)),
        ("cylinder of a compound", rolled::<3>(compound, inertia)),
    ];
    for (what, way) in rollers {
        assert!((way / exact - 1.0).abs() < 3e-3, "{what}: {way} m, exact {exact} m");
    }
}

#[test]
fn the_load_of_a_body_at_rest_does_not_depend_on_the_length_of_the_step() {
    let solids = [floor(), solid("box", cube(0.1), at_height(0.05), Role::Free(light::<2>()))];
    let mut engine = engine(&solids, down()).unwrap();
    let weight = 2.0 * G;
    let mut load = |steps: i32, dt: f64| -> [f64; 2] {
        let mut range = [f64::INFINITY, 0.0_f64];
        for _ in 0..steps {
            engine.step(dt, &idle(2), &[None; 2]).unwrap();
            let now = engine.contacts()[0].normal_force;
            range = [range[0].min(now), range[1].max(now)];
        }
        range
    };
    load(500, 1e-3);
    // A single short step, as the last of a run; then short steps for longer than the contact needs to follow.
    for (steps, dt) in [(1, 4e-4), (1, 1e-3), (1, 1e-6), (5, 1e-3), (3000, 1e-4)] {
        let [least, most] = load(steps, dt);
        // The stiffness of the contact changes by at most 2 % in the time in which the contact follows.
        assert!(
            least > 0.95 * weight && most < 1.05 * weight,
            "{steps} steps of {dt} s: {least} to {most} N of {weight}"
        );
    }
}
