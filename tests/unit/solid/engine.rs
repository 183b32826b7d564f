//! Contract of the rapier engines in both dimensions: flight, loads, contacts, restart, faults and shapes.

use std::sync::Arc;

#[path = "contacts.rs"]
mod contacts;

use super::{
    Constraints, Dim, Engine, FreeBody, HasEngine, JointKind, JointSpec, Kinematics, Load, PrescribedMotion, Role,
    SolidSpec, TimeFunction,
};
use crate::{
    error::{ErrorKind, Result},
    geometry::{ContactGeometry, Mesh, Shape},
    math::expression::Formula,
    math::{Bivector, Matrix, Pose, Vector},
};

const G: f64 = 9.81;

fn down<const D: usize>() -> Vector<D> {
    let mut gravity = Vector::zeros();
    gravity[D - 1] = -G;
    gravity
}

fn solid<const D: usize>(name: &str, shape: Shape<D>, at: [f64; D], role: Role<D>) -> SolidSpec<D> {
    let (name, pose) = (name.into(), Pose::at(at.into()));
    SolidSpec {
        name,
        shape,
        pose,
        role,
        friction: 0.5,
        restitution: 0.0,
        contact_skin: 0.0,
        dry: None,
        ballast: Vec::new(),
    }
}

/// A free body of 2 kg with the moments of inertia 1, 2, 2.5 g m² (in 2-D: 1 g m²).
fn light<const D: usize>() -> FreeBody<D> {
    FreeBody {
        mass: 2.0,
        centre: Vector::zeros(),
        inertia: Matrix::from_fn(|i, j| if i == j { [1e-3, 2e-3, 2.5e-3][i] } else { 0.0 }),
        velocity: Vector::zeros(),
        spin: Bivector::zero(),
        locked_translations: [false; D],
        locked_rotations: [false; 3],
    }
}

fn cube<const D: usize>(edge: f64) -> Shape<D> {
    Shape::Box { size: Vector::repeat(edge) }
}

/// A floor with its top at height 0.
fn floor<const D: usize>() -> SolidSpec<D> {
    let mut at = [0.0; D];
    at[D - 1] = -0.5;
    solid("floor", cube(1.0), at, Role::Fixed)
}

fn at_height<const D: usize>(height: f64) -> [f64; D] {
    let mut at = [0.0; D];
    at[D - 1] = height;
    at
}

fn engine<const D: usize>(solids: &[SolidSpec<D>], gravity: Vector<D>) -> Result<Box<dyn Engine<D>>>
where
    Dim<D>: HasEngine<D>,
{
    let start: Vec<_> = solids.iter().map(SolidSpec::initial_kinematics).collect();
    Dim::<D>::engine(solids, &start, &Constraints::default(), &gravity, 0.01)
}

fn idle<const D: usize>(count: usize) -> Vec<Load<D>> {
    vec![Load::zero(); count]
}

fn free_flight<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    let mut body = light::<D>();
    (body.velocity[0], body.velocity[D - 1]) = (0.3, 5.0);
    body.spin = Bivector::from_axial(&[2.0, 3.0, -1.0][..Bivector::<D>::COMPONENTS]);
    body.centre[0] = 0.02;
    // The bodies are far apart. Their masses differ, so that the engine would iterate if they were near.
    let other = solid("pebble", cube(0.1), [9.0; D], Role::Free(FreeBody { mass: 0.01, ..light() }));
    let solids = [solid("stone", cube(0.1), [0.0; D], Role::Free(body)), other];
    let mut first = engine(&solids, down()).unwrap();
    let fly = |engine: &mut dyn Engine<D>, steps: std::ops::Range<i32>| -> f64 {
        let lengths = steps.map(|step| 1e-4 * (1.2 + f64::from(step).cos()));
        lengths.inspect(|dt| engine.step(*dt, &idle(2), &[None; 2]).unwrap()).sum()
    };
    let mut t = fly(&mut *first, 0..5000);
    let saved = first.save().unwrap();
    t += fly(&mut *first, 5000..10_000);
    let now = first.kinematics(0);
    let thrown = body.centre + body.velocity * t + down() * (0.5 * t * t);
    let distance = G * t * t;
    // Round-off of 10,000 steps.
    assert!(
        (now.centre - thrown).norm() < 1e-12 * distance,
        "{:e} of the distance",
        (now.centre - thrown).norm() / distance
    );
    assert!((now.velocity - body.velocity - down() * t).norm() < 1e-12 * G * t);
    assert!((now.centre - now.pose.point(&body.centre)).norm() < 1e-15 * distance);
    let mut again = engine(&solids, down()).unwrap();
    again.restore(&saved).unwrap();
    fly(&mut *again, 5000..10_000);
    assert_eq!(again.kinematics(0), now, "the same bits after a restart in mid-flight");
}

#[test]
fn a_thrown_body_follows_a_parabola_to_round_off() {
    free_flight::<2>();
    free_flight::<3>();
}

fn held_up<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    let mut engine = engine(&[solid("box", cube(0.1), [0.3; D], Role::Free(light()))], down()).unwrap();
    let (start, lift) = (engine.kinematics(0), Load { force: down() * -2.0, torque: Bivector::zero() });
    for _ in 0..100 {
        engine.step(1e-3, &[lift], &[None]).unwrap();
    }
    assert!((engine.kinematics(0).centre - start.centre).norm() < 1e-15);
}

#[test]
fn a_body_held_by_its_weight_does_not_move() {
    held_up::<2>();
    held_up::<3>();
}

#[test]
fn an_upward_force_on_the_right_causes_counter_clockwise_rotation() {
    let mut body = light::<2>();
    body.centre = Vector::from([0.1, 0.0]);
    let spec = solid("lever", cube(0.1), [0.0, 0.0], Role::Free(body));
    let mut engine = engine(&[spec], Vector::zeros()).unwrap();
    // Force (0, 1) N at the arm (1, 0) m from the centre of mass: 1 N m on 1 g m² for 1 ms.
    engine.push(0, &Vector::from([0.0, 1.0]), &Vector::from([1.1, 0.0]));
    engine.step(1e-3, &idle(1), &[None]).unwrap();
    assert!((engine.kinematics(0).spin.axial()[0] - 1.0).abs() < 1e-12);
    assert!((engine.kinematics(0).velocity - Vector::from([0.0, 0.5e-3])).norm() < 1e-15);
    let load = Load { force: Vector::zeros(), torque: Bivector::from_axial(&[-1.0]) };
    engine.step(1e-3, &[load], &[None]).unwrap();
    // The push applies to one step only, and the opposite torque cancels its effect.
    assert!(engine.kinematics(0).spin.axial()[0].abs() < 1e-12);
}

fn rests<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    rests_on(floor::<D>());
    // A driven floor at rest equals a fixed floor.
    let stands = PrescribedMotion::slide(at_height(1.0).into(), TimeFunction::constant(0.0));
    rests_on(SolidSpec { role: Role::Driven(stands), ..floor::<D>() });
}

fn rests_on<const D: usize>(floor: SolidSpec<D>)
where
    Dim<D>: HasEngine<D>,
{
    let driven = matches!(floor.role, Role::Driven(_)).then(|| floor.initial_kinematics());
    let solids = [floor, solid("box", cube(0.1), at_height(0.05), Role::Free(light()))];
    let mut engine = engine(&solids, down()).unwrap();
    for _ in 0..5000 {
        engine.step(1e-4, &idle(2), &[driven, None]).unwrap();
    }
    // A contact of 500 Hz sinks g/(2πf)² = 1 µm; the bound also covers the landing.
    let sink = 0.05 - engine.kinematics(1).pose.position[D - 1];
    assert!((0.0..50e-6).contains(&sink), "sinks {sink} m");
    let contacts = engine.contacts();
    assert_eq!((contacts.len(), contacts[0].between), (1, [0, 1]));
    assert!((contacts[0].normal_force / (2.0 * G) - 1.0).abs() < 1e-3, "{contacts:?}");
    // The contact point is between the faces in the middle of the box; the centre of the floor is half a metre below.
    assert!(contacts[0].at.norm() < 1e-3, "{contacts:?}");
    // The centre of the floor is vertically below, so the weight causes no moment about it.
    assert!(contacts[0].loads[0].torque.0.norm() < 2e-3 * 2.0 * G, "{contacts:?}");
}

#[test]
fn a_box_at_rest_loads_the_floor_with_its_weight() {
    rests::<2>();
    rests::<3>();
    // Along the edge of two facets the engine treats the contact points of both as those of one face.
    let seabed = meshed([1.0, 1.0, 1.0], false, ContactGeometry::Fitting);
    rests_on(solid("seabed", seabed, [0.0, 0.0, -0.5], Role::Fixed));
}

#[test]
fn a_driven_paddle_pushes_a_free_body() {
    let motion =
        PrescribedMotion::slide(Vector::from([1.0, 0.0]), TimeFunction::Formula(Formula::parse("0.5*t").unwrap()));
    let paddle = solid("paddle", cube(0.1), [-0.101, 0.0], Role::Driven(motion.clone()));
    let solids = [paddle, solid("box", cube(0.1), [0.0, 0.0], Role::Free(light()))];
    let mut engine = engine(&solids, Vector::zeros()).unwrap();
    for step in 1..=1000 {
        let then = motion.kinematics(&solids[0].pose, 1e-4 * f64::from(step));
        engine.step(1e-4, &idle(2), &[Some(then), None]).unwrap();
    }
    // Without restitution the box has the speed of the paddle after the gap of 1 mm is closed.
    let now = engine.kinematics(1);
    assert!((now.velocity[0] - 0.5).abs() < 1e-3, "{now:?}");
    assert!((now.pose.position[0] - 0.049).abs() < 1e-4, "{now:?}");
}

fn restores<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    let solids = [
        floor(),
        solid("lower", cube(0.1), at_height(0.051), Role::Free(light())),
        solid("upper", cube(0.08), at_height(0.145), Role::Free(light())),
    ];
    let mut engine = engine(&solids, down()).unwrap();
    let run = |engine: &mut dyn Engine<D>, from: i32| {
        for step in from..from + 400 {
            let mut loads = idle(3);
            loads[2].force[0] = 4.0 * f64::from(step).sin();
            engine.step(1e-4 * (1.2 + f64::from(step).cos()), &loads, &[None; 3]).unwrap();
        }
    };
    run(&mut *engine, 0);
    engine.push(2, &down(), &Vector::zeros());
    let saved = engine.save().unwrap();
    run(&mut *engine, 400);
    let uninterrupted: Vec<_> = (1..3).map(|i| engine.kinematics(i)).collect();
    let contacts = engine.contacts();
    assert!(contacts.len() == 2, "both contacts persist: {contacts:?}");
    let start: Vec<_> = solids.iter().map(SolidSpec::initial_kinematics).collect();
    let mut other = Dim::<D>::engine(&solids, &start, &Constraints::default(), &down(), 0.01).unwrap();
    other.restore(&saved).unwrap();
    run(&mut *other, 400);
    assert_eq!(uninterrupted, (1..3).map(|i| other.kinematics(i)).collect::<Vec<_>>());
    assert_eq!(contacts, other.contacts());
    assert_eq!(other.restore(&saved[..saved.len() / 2]).unwrap_err().kind, ErrorKind::Restart);
    assert_eq!(other.restore(b"\x03abc").unwrap_err().kind, ErrorKind::Restart);
}

#[test]
fn a_restored_engine_reaches_the_same_bits() {
    restores::<2>();
    restores::<3>();
}

#[test]
fn values_that_are_not_finite_cause_a_fault_and_no_panic() {
    let solids = [floor(), solid("box", cube(0.1), [0.2, 0.3], Role::Free(light()))];
    for force in [f64::NAN, f64::INFINITY, 1e300] {
        let mut engine = engine(&solids, down()).unwrap();
        engine.step(1e-4, &idle(2), &[None, None]).unwrap();
        let mut loads = idle(2);
        loads[1].force[0] = force;
        let fault = engine.step(1e-4, &loads, &[None, None]).unwrap_err();
        assert_eq!((fault.solid, fault.position[0]), (1, 0.2));
        assert!(fault.reason.contains("not finite"));
    }
    let mut engine = engine(&solids, down()).unwrap();
    engine.set_velocity(1, &Vector::from([f64::NAN, 0.0]), &Bivector::zero());
    assert_eq!(engine.step(1e-4, &idle(2), &[None, None]).unwrap_err().solid, 1);
}

#[test]
fn overlapping_bodies_are_refused() {
    let near = |gap: f64| {
        let solids = [floor(), solid("box", cube(0.1), [0.2, 0.05 + gap], Role::Free(light()))];
        engine(&solids, down()).map(|_| ())
    };
    assert!(near(0.0).is_ok() && near(-0.0004).is_ok());
    let error = near(-0.0006).unwrap_err().to_string();
    assert!(error.contains("\"box\" starts 0.00060 m inside \"floor\""), "{error}");
    let massless = FreeBody { mass: 0.0, ..light() };
    let error = engine(&[solid("ghost", cube(0.1), [0.0, 0.0], Role::Free(massless))], down()).map(|_| ());
    assert!(error.unwrap_err().to_string().contains("\"ghost\": its mass is 0 kg"));
}

#[test]
fn a_torque_accelerates_a_body_by_its_own_moments_of_inertia() {
    // With equal smaller moments the principal axes of the engine's own decomposition are wrong: it swapped 1.2 and 0.75.
    let turned = nalgebra::Rotation3::from_euler_angles(0.3, -0.7, 1.1).into_inner();
    let disc = |moments: [f64; 3]| Matrix::<3>::from_diagonal(&moments.into());
    let tensors = [
        disc([1.2, 0.75, 0.75]),
        disc([0.75, 1.2, 0.75]),
        disc([0.75, 0.75, 1.2]),
        disc([0.5, 0.8, 0.8]),
        disc([0.8, 0.8, 0.8]),
        disc([0.6, 0.75, 1.2]),
        turned * disc([1.2, 0.75, 0.75]) * turned.transpose(),
        Matrix::from_row_slice(&[0.6, 0.1, 0.1, 0.1, 0.6, 0.1, 0.1, 0.1, 0.6]),
        Matrix::from_row_slice(&[0.6, 0.0, 0.1, 0.0, 0.5, 0.0, 0.1, 0.0, 0.6]),
    ];
    for inertia in tensors {
        let body = solid("body", cube::<3>(0.1), [0.0, 0.0, 5.0], Role::Free(FreeBody { inertia, ..light() }));
        let mut engine = engine(&[body], Vector::zeros()).unwrap();
        let torque = [0.3, -0.2, 0.5];
        let load = Load { force: Vector::zeros(), torque: Bivector::from_axial(&torque) };
        engine.step(1e-3, &[load], &[None]).unwrap();
        let spin = engine.kinematics(0).spin;
        let rate = inertia.try_inverse().unwrap() * Vector::<3>::from(torque) * 1e-3;
        let found = Vector::<3>::new(spin.0[(2, 1)], spin.0[(0, 2)], spin.0[(1, 0)]);
        // Round-off of a decomposition and its inverse; gyroscopic torques are of the second order in the step.
        assert!((found - rate).norm() < 1e-6 * rate.norm(), "{inertia}: {found}, exactly {rate}");
    }
}

#[test]
fn a_body_with_locked_motions_moves_only_along_the_free_ones() {
    let mut body = light::<3>();
    body.inertia[(0, 1)] = 4e-4;
    body.inertia[(1, 0)] = 4e-4;
    body.locked_translations = [true, true, false];
    body.locked_rotations = [true, false, true];
    let mut engine = engine(&[solid("buoy", cube(0.1), [0.0; 3], Role::Free(body))], Vector::zeros()).unwrap();
    let load = Load { force: Vector::repeat(1.0), torque: Bivector::from_axial(&[1.0, 1.0, 1.0]) };
    for _ in 0..10 {
        engine.step(1e-4, &[load], &[None]).unwrap();
    }
    let now = engine.kinematics(0);
    assert!((now.velocity - Vector::from([0.0, 0.0, 0.5e-3])).norm() < 1e-15);
    // 1 N m on 2 g m² for 1 ms.
    assert!((Vector::<3>::from_column_slice(&now.spin.axial()) - Vector::from([0.0, 0.5, 0.0])).norm() < 1e-9);
}

/// Height of the lower end of a ball of radius 20 mm at rest, released 5 mm above `face` over the point `at`.
fn settled<const D: usize>(shape: Shape<D>, mut at: [f64; D], face: f64) -> f64
where
    Dim<D>: HasEngine<D>,
{
    at[D - 1] = face + 0.025;
    let solids = [
        solid("obstacle", shape, [0.0; D], Role::Fixed),
        solid("ball", Shape::Ball { radius: 0.02 }, at, Role::Free(light())),
    ];
    let mut engine = engine(&solids, down()).unwrap();
    for _ in 0..2000 {
        engine.step(1e-4, &idle(2), &[None, None]).unwrap();
    }
    engine.kinematics(1).pose.position[D - 1] - 0.02
}

#[test]
fn a_ball_rests_on_the_exact_face_of_every_shape() {
    let points = |list: &[[f64; 2]]| list.iter().map(|&p| p.into()).collect::<Vec<Vector<2>>>();
    let ell = points(&[[0.0, 0.0], [0.4, 0.0], [0.4, 0.1], [0.1, 0.1], [0.1, 0.3], [0.0, 0.3]]);
    let bed = points(&[[0.0, 0.5], [0.2, 0.2], [0.8, 0.2], [1.0, 0.5]]);
    let inner = Shape::Box { size: [0.2, 0.1].into() };
    let pair = Shape::Compound(vec![(Pose::at([0.0, 0.5].into()), inner.clone()), (Pose::identity(), inner)]);
    let flat: [(Shape<2>, [f64; 2], f64); 5] = [
        (Shape::Polygon { points: ell }, [0.25, 0.0], 0.1),
        (Shape::Polyline { points: bed, thickness: 0.1 }, [0.5, 0.0], 0.2),
        (Shape::Tank { size: [0.4, 0.3].into(), thickness: 0.02 }, [0.2, 0.0], 0.0),
        (Shape::Capsule { length: 0.2, radius: 0.05, axis: 0 }, [0.0, 0.0], 0.05),
        (pair, [0.0, 0.0], 0.55),
    ];
    let deep: [(Shape<3>, [f64; 3], f64); 3] = [
        (Shape::Cylinder { length: 0.2, radius: 0.1, axis: 2 }, [0.03, 0.02, 0.0], 0.1),
        (Shape::Cylinder { length: 0.2, radius: 0.07, axis: 1 }, [0.0, 0.02, 0.0], 0.07),
        (Shape::Tank { size: [0.4, 0.3, 0.3].into(), thickness: 0.02 }, [0.2, 0.1, 0.0], 0.0),
    ];
    // A contact sinks 1 µm at this dt; the bound of 20 µm also covers the landing.
    for (shape, at, face) in flat {
        let height = settled(shape.clone(), at, face);
        assert!((height - face).abs() < 20e-6, "{shape:?}: {height} for {face}");
    }
    for (shape, at, face) in deep {
        let height = settled(shape.clone(), at, face);
        assert!((height - face).abs() < 20e-6, "{shape:?}: {height} for {face}");
    }
}

/// A block around the origin as a mesh; with `notch` its top has a groove along y, down to the middle.
fn meshed(size: [f64; 3], notch: bool, contact: ContactGeometry) -> Shape<3> {
    let [x, y, z] = size.map(|s| 0.5 * s);
    let mut outline = vec![[-x, -z], [x, -z], [x, z], [-x, z]];
    if notch {
        outline.splice(3..3, [[0.3 * x, z], [0.3 * x, 0.0], [-0.3 * x, 0.0], [-0.3 * x, z]]);
    }
    let n = outline.len() as u32;
    let at = |y: f64| outline.iter().map(move |p| Vector::from([p[0], y, p[1]]));
    let points: Vec<Vector<3>> = at(-y).chain(at(y)).collect();
    // The outline is counter-clockwise seen from −y; the other end is reversed.
    let flat: &[[u32; 3]] = if notch {
        &[[0, 1, 5], [0, 5, 6], [0, 6, 7], [5, 1, 4], [1, 2, 3], [1, 3, 4]]
    } else {
        &[[0, 1, 2], [0, 2, 3]]
    };
    let ends = flat.iter().flat_map(|&[a, b, c]| [[a, b, c], [a + n, c + n, b + n]]);
    let sides = (0..n).map(|i| (i, (i + 1) % n)).flat_map(|(a, b)| [[a, b + n, b], [a, a + n, b + n]]);
    let mesh = Mesh::new(&points, &ends.chain(sides).collect::<Vec<_>>()).unwrap();
    Shape::Mesh { mesh: Arc::new(mesh), contact }
}

#[test]
fn a_ball_rests_on_the_exact_face_and_in_the_groove_of_a_mesh() {
    let size = [0.4, 0.4, 0.2];
    for contact in [ContactGeometry::Fitting, ContactGeometry::Surface, ContactGeometry::Hull] {
        let height = settled(meshed(size, false, contact), [0.03, 0.02, 0.0], 0.1);
        assert!((height - 0.1).abs() < 20e-6, "{contact:?}: {height}");
    }
    let height = settled(meshed(size, true, ContactGeometry::Fitting), [0.0, 0.02, 0.0], 0.0);
    assert!(height.abs() < 20e-6, "a ball lies in the groove: {height}");
    let height = settled(meshed(size, true, ContactGeometry::Hull), [0.0, 0.02, 0.0], 0.1);
    assert!((height - 0.1).abs() < 20e-6, "the hull has no groove: {height}");
}

#[test]
fn a_free_mesh_rests_on_its_contact_parts_and_survives_a_restart() {
    let size = [0.1, 0.1, 0.1];
    for (shape, off) in [
        (meshed(size, false, ContactGeometry::Fitting), 20e-6),
        (meshed(size, true, ContactGeometry::Fitting), 1e-3), // the contact parts are built from voxels of a sixtieth of its width
    ] {
        let seabed =
            solid("seabed", meshed([1.0, 1.0, 1.0], false, ContactGeometry::Fitting), [0.0, 0.0, -0.5], Role::Fixed);
        let solids = [seabed, solid("body", shape, [0.0, 0.0, 0.055], Role::Free(light()))];
        let (mut first, mut second) = (engine(&solids, down()).unwrap(), engine(&solids, down()).unwrap());
        let run = |engine: &mut Box<dyn Engine<3>>, n: usize| {
            (0..n).for_each(|_| engine.step(1e-4, &idle(2), &[None, None]).unwrap());
            engine.kinematics(1)
        };
        let whole = run(&mut first, 2000);
        assert!((whole.pose.position[2] - 0.05).abs() < off, "{}", whole.pose.position[2]);
        run(&mut second, 700);
        let mut third = engine(&solids, down()).unwrap();
        third.restore(&second.save().unwrap()).unwrap();
        assert_eq!(run(&mut third, 1300), whole, "the same bits after a restart");
    }
}

fn keeps_locks<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    let turn = if D == 2 { 0 } else { 1 };
    let body = light::<D>().lock_translation(0).lock_rotation(turn);
    let start = |body: FreeBody<D>| engine(&[solid("locked", cube(0.1), [0.0; D], Role::Free(body))], Vector::zeros());
    let mut engine = start(body).unwrap();
    let spin = Bivector::from_axial(&[2.0, 3.0, -1.0][..Bivector::<D>::COMPONENTS]);
    engine.set_velocity(0, &Vector::repeat(1.5), &spin);
    let now = engine.kinematics(0);
    let expected = Vector::from_fn(|i, _| if i == 0 { 0.0 } else { 1.5 });
    let kept: Vec<f64> = spin.axial().iter().enumerate().map(|(i, rate)| if i == turn { 0.0 } else { *rate }).collect();
    assert_eq!((now.velocity, now.spin.axial()), (expected, kept));
    for moving in [body.velocity(Vector::repeat(1.0)), body.spin(spin)] {
        let refused = start(moving);
        assert!(refused.err().unwrap().message.contains("a motion that is locked"));
    }
}

#[test]
fn a_set_velocity_leaves_locked_motions_at_rest() {
    keeps_locks::<2>();
    keeps_locks::<3>();
}

/// The engine of a body that a joint holds to solid 0, or to the ground, at the origin.
fn tied(solids: &[SolidSpec<3>], joint: JointKind, between: [Option<usize>; 2]) -> Box<dyn Engine<3>> {
    let start: Vec<_> = solids.iter().map(SolidSpec::initial_kinematics).collect();
    let joint = JointSpec::new("tie", joint, between, Vector::zeros(), Vector::zeros());
    let links = Constraints { joints: vec![joint], ..Constraints::default() };
    Dim::<3>::engine(solids, &start, &links, &Vector::zeros(), 0.01).unwrap()
}

#[test]
fn a_body_fixed_to_a_driven_arm_turns_with_it_at_every_angle() {
    // Two turns about each axis, forward and back: a rotation has two quaternions, and the form with w ≥ 0 is not continuous.
    for axis in [[0.6, 0.8, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]] {
        for rate in [4.0, -4.0] {
            let law = TimeFunction::Formula(Formula::parse(&format!("{rate}*t")).unwrap());
            let motion = PrescribedMotion::hinge(Vector::zeros(), &axis, law);
            let body = FreeBody { spin: Bivector::from_axial(&axis.map(|a| a * rate)), ..light::<3>() };
            let arm = solid("arm", cube(0.1), [0.0; 3], Role::Driven(motion.clone()));
            let solids = [arm, solid("hand", cube(0.1), [0.0, 0.0, 0.0], Role::Free(body))];
            let mut engine = tied(&solids, JointKind::Fixed, [Some(0), Some(1)]);
            for step in 1..=1600 {
                let then = motion.kinematics(&solids[0].pose, 2e-3 * f64::from(step));
                engine.step(2e-3, &idle(2), &[Some(then), None]).unwrap();
                let off = (engine.kinematics(1).spin + then.spin * -1.0).0.norm();
                // The spin is constant. The engine takes it from the poses, with the error (ωΔt)²/24 of a finite rotation.
                assert!(off < 1e-4, "about {axis:?} at {rate} rad/s, step {step}: {off} rad/s off");
            }
        }
    }
}

#[test]
fn a_body_whose_joint_has_ended_tumbles_as_a_free_one() {
    let spin = Bivector::from_axial(&[3.0, -2.0, 4.0]);
    let solids = [solid("block", cube(0.1), [0.0; 3], Role::Free(FreeBody { spin, ..light::<3>() }))];
    let mut free = engine(&solids, Vector::zeros()).unwrap();
    let mut ended = tied(&solids, JointKind::Ball, [None, Some(0)]);
    ended.set_joint(0, None);
    for _ in 0..500 {
        for engine in [&mut free, &mut ended] {
            engine.step(1e-3, &idle(1), &[None]).unwrap();
        }
    }
    assert_eq!(free.kinematics(0), ended.kinematics(0));
}
