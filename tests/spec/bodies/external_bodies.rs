//! Host programs: hooks around the body step, bodies in a rapier world of the host, and solids added and removed in a run.

use std::path::Path;

use pontoon::{
    Result,
    error::ErrorKind,
    geometry::Shape,
    math::{Bivector, Vector},
    scene::Scene,
    simulation::Simulation,
    solid::{
        Load, Role,
        rapier2d::{self, rapier::prelude as rapier},
        rapier3d,
    },
};

use crate::common;

const DP: f64 = 0.02;

/// Water 0.3 m deep in a tank, and two floats, one of them as light as foam.
const POOL: &str = r#"
dimension = 2
dp        = 0.02
until     = 9.0

[[water]]
fill = { box = { min = [0.0, 0.0], max = [1.0, 0.3] } }

[[solid]]
name  = "tank"
fixed = true
shape = { tank = { size = [1.0, 0.6] } }

[[solid]]
name  = "float"
shape = { box = { size = [0.2, 0.1] } }
at    = { x = 0.3, draft = "equilibrium" }
free  = { density = 500.0, spin = 0.3 }

[[solid]]
name  = "foam"
shape = { ball = { radius = 0.06 } }
at    = { x = 0.7, y = 0.34 }
free  = { density = 30.0 }
"#;

fn pool() -> Result<Simulation<2>> {
    common::scene_simulation::<2>(POOL)
}

fn block(name: &str, at: [f64; 2], density: f64) -> pontoon::solid::SolidSpec<2> {
    let mut block = common::float(Shape::Box { size: Vector::from([0.1, 0.08]) }, at, density);
    block.name = name.into();
    block
}

#[test]
fn read_access_between_water_and_body_step_changes_no_bit() -> Result<()> {
    let (mut plain, mut watched) = (pool()?, pool()?);
    let mut lift = 0.0;
    for i in 0..60 {
        plain.step()?;
        watched.step_with(f64::INFINITY, |step| {
            lift += step.loads()[1].force[1] * step.dt();
            if i % 2 == 0 {
                step.advance_bodies()?;
                assert!(step.solids[1].velocity.norm() < 1.0 && step.time() >= 0.0);
            }
            Ok(())
        })?;
    }
    assert!(plain.save()? == watched.save()?);
    assert!(lift > 0.0);
    Ok(())
}

#[test]
fn a_push_in_the_hook_equals_a_push_before_the_step() -> Result<()> {
    let (mut early, mut late) = (pool()?, pool()?);
    let force = Vector::from([3.0, 1.0]);
    for _ in 0..40 {
        let at = early.system().solids()[2].kinematics.centre;
        early.push(2, &force, &at);
        early.step()?;
        late.step_with(f64::INFINITY, |step| {
            step.push(2, &Load { force, torque: Bivector::zero() });
            Ok(())
        })?;
    }
    assert!(early.save()? == late.save()?, "also at the centre of a light body");
    Ok(())
}

/// The floats of the pool in a rapier world, set up as docs/how-to/use-from-rust.md describes.
fn world(sim: &Simulation<2>) -> (rapier::PhysicsWorld, Vec<rapier::RigidBodyHandle>) {
    let mut world =
        rapier::PhysicsWorld { gravity: rapier::Vector::new(0.0, -9.81), ..rapier::PhysicsWorld::default() };
    world.integration_parameters.num_solver_iterations = 1;
    let mut bodies = Vec::new();
    for solid in &sim.system().solids()[1..] {
        let Role::Free(body) = &solid.spec.role else { panic!("a float") };
        let collider = match &solid.spec.shape {
            Shape::Box { size } => rapier::ColliderBuilder::cuboid(0.5 * size[0], 0.5 * size[1]),
            _ => rapier::ColliderBuilder::ball(0.06),
        };
        let at = rapier::Vector::new(solid.spec.pose.position[0], solid.spec.pose.position[1]);
        let builder = rapier::RigidBodyBuilder::dynamic().translation(at).angvel(body.spin.axial()[0]).can_sleep(false);
        let handle = world.insert_body(builder);
        world.insert_collider(collider.mass(body.mass), Some(handle));
        world.bodies[handle].recompute_mass_properties_from_colliders(&world.colliders);
        bodies.push(handle);
    }
    (world, bodies)
}

#[test]
fn floats_in_a_rapier_world_of_the_host_move_as_internal_ones() -> Result<()> {
    let setup = || -> Result<_> { Ok(Scene::parse(POOL, Path::new(""), &[])?.build::<2>()?.setup) };
    let (mut internal, mut external) = (Simulation::new(setup()?)?, Simulation::with_external_bodies(setup()?)?);
    let (mut world, bodies) = world(&external);
    for (body, name) in bodies.iter().zip(["float", "foam"]) {
        let spec = rapier2d::solid_from_body(name, *body, &world.bodies, &world.colliders)?;
        let known = &external.system().solids()[external.system().find_solid(name).unwrap_or_default()].spec;
        let (Role::Free(converted), Role::Free(expected)) = (&spec.role, &known.role) else { panic!("both are free") };
        assert!(
            (converted.mass / expected.mass - 1.0).abs() < 1e-12
                && spec.shape == known.shape
                && spec.pose == known.pose
        );
        assert!(
            (converted.inertia - expected.inertia).norm() < 1e-12 * expected.inertia.norm()
                && converted.spin == expected.spin
        );
    }
    for _ in 0..200 {
        internal.step()?;
        external.step_with(f64::INFINITY, |step| {
            for (i, &body) in bodies.iter().enumerate() {
                rapier2d::apply_load(&mut world.bodies[body], &step.loads()[i + 1]);
            }
            world.integration_parameters.dt = step.dt();
            world.step();
            for (i, &body) in bodies.iter().enumerate() {
                step.solids[i + 1] = rapier2d::kinematics(&world.bodies[body]);
            }
            Ok(())
        })?;
    }
    for i in 1..3 {
        let (a, b) = (&internal.system().solids()[i].kinematics, &external.system().solids()[i].kinematics);
        // Engine and forces are the same; single precision in the pair loop may amplify differences of the last bit.
        let off = (a.pose.position - b.pose.position).norm() + (a.pose.rotation - b.pose.rotation).norm();
        assert!(off < 1e-9, "{i}: difference {off} after 200 steps");
        assert!((a.velocity - b.velocity).norm() < 1e-6);
    }
    Ok(())
}

#[test]
fn an_external_body_without_a_new_pose_is_named_in_the_error() -> Result<()> {
    let mut sim = Simulation::with_external_bodies(Scene::parse(POOL, Path::new(""), &[])?.build::<2>()?.setup)?;
    let error = sim.step().expect_err("the host moved no body");
    assert!(error.kind == ErrorKind::Usage && error.message.contains("\"float\""), "{error}");
    let error = sim.step_with(1.0, |step| step.advance_bodies()).expect_err("the simulation has no bodies to advance");
    assert!(error.help.is_some_and(|help| help.contains("step.solids")));
    Ok(())
}

#[test]
fn rapier_bodies_become_solids_with_the_same_shape_and_mass() -> Result<()> {
    use rapier3d::rapier::prelude::{
        ColliderBuilder, ColliderSet, PhysicsWorld, RigidBodyBuilder, SharedShape, Vector as Point,
    };
    let mut world = PhysicsWorld::default();
    let body = world.insert_body(RigidBodyBuilder::dynamic().translation(Point::new(0.0, 0.0, 1.0)).lock_rotations());
    let made = |world: &PhysicsWorld| rapier3d::solid_from_body("boat", body, &world.bodies, &world.colliders);
    assert!(made(&world).is_err_and(|e| e.message.contains("no collider")));
    for (x, shape) in [
        (0.0, SharedShape::cuboid(0.1, 0.2, 0.3)),
        (1.0, SharedShape::ball(0.1)),
        (2.0, SharedShape::capsule(Point::new(0.0, -0.1, -0.1), Point::new(0.0, 0.1, 0.1), 0.05)),
        (3.0, SharedShape::cylinder(0.2, 0.1)),
    ] {
        world.insert_collider(
            ColliderBuilder::new(shape).translation(Point::new(x, 0.0, 0.0)).density(500.0),
            Some(body),
        );
    }
    world.bodies[body].recompute_mass_properties_from_colliders(&world.colliders);
    let spec = made(&world)?;
    let Role::Free(body_) = &spec.role else { panic!("a free body") };
    let volume = spec.shape.volume_properties();
    assert!((body_.mass / (500.0 * volume.volume) - 1.0).abs() < 1e-9, "mass and volume agree");
    assert!((body_.centre - volume.centroid).norm() < 1e-9, "centre of mass and centroid agree");
    assert_eq!(body_.locked_rotations, [true; 3]);
    let hull = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Point::from_array);
    let mut other = PhysicsWorld::default();
    let tetra = other.insert_body(RigidBodyBuilder::fixed());
    other.insert_collider(ColliderBuilder::convex_hull(&hull).expect("a hull"), Some(tetra));
    let spec = rapier3d::solid_from_body("rock", tetra, &other.bodies, &other.colliders)?;
    assert!(matches!(spec.role, Role::Fixed) && (spec.shape.volume_properties().volume - 1.0 / 6.0).abs() < 1e-12);
    other.insert_collider(ColliderBuilder::cone(0.1, 0.1), Some(tetra));
    let error =
        rapier3d::solid_from_body("rock", tetra, &other.bodies, &other.colliders).expect_err("a cone is not supported");
    assert!(error.message.contains("Cone") && error.help.is_some(), "{error}");
    assert!(rapier3d::solid_from_body("gone", tetra, &world.bodies, &ColliderSet::new()).is_err());
    Ok(())
}

#[test]
fn an_added_solid_displaces_water_and_water_fills_the_space_of_a_removed_one() -> Result<()> {
    let mut sim = pool()?;
    common::steps(&mut sim, 20);
    let water = sim.system().fluid().len();
    let added = sim.add_solid(block("late", [0.5, 0.1], 800.0))?;
    // 5 × 4 cells of the lattice, whose particles have hardly moved.
    assert!(added.solid == 3 && (16..=24).contains(&added.displaced), "{added:?}");
    assert_eq!(sim.system().fluid().len(), water - added.displaced);
    common::steps(&mut sim, 100);
    assert!(sim.system().solids()[3].kinematics.velocity[1] > 0.0, "the light block rises");
    let fastest = |sim: &Simulation<2>| sim.system().fluid().v.iter().map(|v| v.norm()).fold(0.0, f64::max);
    sim.remove_solid(3)?;
    let boundary = sim.system().boundary().len();
    assert!(sim.system().solids()[3].boundary.is_empty() && boundary == pool()?.system().boundary().len());
    sim.remove_solid(1)?;
    while sim.time() < 0.6 {
        sim.step_to(0.6)?;
    }
    let refilled = sim.system().fluid().r.iter().filter(|r| (*r - Vector::from([0.5, 0.1])).amax() < 0.05).count();
    assert!(refilled >= 20, "water fills the space of the block: {refilled} particles of 25");
    assert!(fastest(&sim) < 2.0 && sim.rollbacks().is_empty(), "no violent flow: {} m/s", fastest(&sim));
    assert!(sim.system().solids()[2].kinematics.centre[1] > 0.25, "the foam stays afloat");
    Ok(())
}

#[test]
fn a_run_with_added_and_removed_solids_has_the_same_bits_on_any_number_of_threads_and_after_a_restart() -> Result<()> {
    let change_solids = |sim: &mut Simulation<2>| -> Result<()> {
        common::steps(sim, 15);
        sim.add_solid(block("first", [0.5, 0.4], 30.0))?;
        common::steps(sim, 15);
        sim.remove_solid(1)?;
        // The first solid would overlap this position if it had not moved.
        sim.add_solid(block("second", [0.3, 0.25], 700.0))?;
        common::steps(sim, 15);
        Ok(())
    };
    let run = |threads: usize| -> Result<(Vec<u8>, Vec<u8>)> {
        common::on_threads(threads, || {
            let mut sim = pool()?;
            change_solids(&mut sim)?;
            let saved = sim.save()?;
            common::steps(&mut sim, 40);
            Ok((saved, sim.save()?))
        })
    };
    let (saved, end) = run(1)?;
    assert!(run(2)? == (saved.clone(), end.clone()), "two threads");
    let mut resumed = pool()?;
    assert!(resumed.restore(&saved).is_err(), "the solids of the checkpoint differ");
    let mut resumed = pool()?;
    resumed.restore_with_added_solids(
        &saved,
        vec![block("first", [0.5, 0.4], 30.0), block("second", [0.3, 0.25], 700.0)],
    )?;
    assert!(resumed.save()? == saved, "a restored state saves to the same bytes");
    common::steps(&mut resumed, 40);
    assert!(resumed.save()? == end, "the resumed run reaches the same bits");
    Ok(())
}

#[test]
fn an_invalid_addition_or_removal_is_refused_and_changes_nothing() -> Result<()> {
    let mut sim = pool()?;
    let before = sim.save()?;
    let inside = sim.add_solid(block("late", [0.35, 0.3], 500.0)).expect_err("inside the float");
    assert!(inside.message.contains("\"late\" would come") && inside.message.contains("\"float\""), "{inside}");
    let twice = sim.add_solid(block("float", [0.5, 0.5], 500.0)).expect_err("the name is taken");
    assert!(twice.message.contains("\"float\""), "{twice}");
    assert!(sim.add_solid(block("ghost", [0.5, 0.5], -1.0)).is_err());
    assert!(sim.remove_solid(7).is_err_and(|e| e.message.contains("number 7")));
    assert!(sim.save()? == before);
    Ok(())
}

#[test]
fn the_first_free_body_can_be_added_during_a_run() -> Result<()> {
    let text = POOL.split("[[solid]]\nname  = \"float\"").next().unwrap_or_default();
    let mut sim = common::scene_simulation::<2>(text)?;
    common::steps(&mut sim, 5);
    sim.add_solid(block("late", [0.5, 0.36], 500.0))?;
    while sim.time() < 1.5 {
        sim.step_to(1.5)?;
    }
    let height = sim.system().solids()[1].kinematics.centre[1];
    // Half of it is under water, to a dp while it still oscillates.
    assert!((height - 0.3).abs() < DP, "{height} m");
    Ok(())
}
