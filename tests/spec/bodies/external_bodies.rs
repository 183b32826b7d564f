//! Programs that have pontoon inside: hooks round the bodies' step, worlds of bodies of their own, solids that come and go.

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
    Simulation::new(Scene::parse(POOL, Path::new(""), &[])?.build::<2>()?.setup)
}

fn block(name: &str, at: [f64; 2], density: f64) -> pontoon::solid::SolidSpec<2> {
    let mut block = common::float(Shape::Box { size: Vector::from([0.1, 0.08]) }, at, density);
    block.name = name.into();
    block
}

fn steps(sim: &mut Simulation<2>, n: usize) -> Result<()> {
    (0..n).try_for_each(|_| sim.step())
}

#[test]
fn looking_on_between_water_and_bodies_changes_no_bit() -> Result<()> {
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
fn a_push_at_the_handover_is_a_push() -> Result<()> {
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
    assert!(early.save()? == late.save()?, "at the centre of a light body too");
    Ok(())
}

/// The floats of the pool in a world of rapier's, set up as anybody would who reads docs/how-to/use-from-rust.md.
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
fn floats_of_a_world_of_ones_own_move_as_pontoons_do() -> Result<()> {
    let setup = || -> Result<_> { Ok(Scene::parse(POOL, Path::new(""), &[])?.build::<2>()?.setup) };
    let (mut inside, mut hosted) = (Simulation::new(setup()?)?, Simulation::with_external_bodies(setup()?)?);
    let (mut world, bodies) = world(&hosted);
    for (body, name) in bodies.iter().zip(["float", "foam"]) {
        let spec = rapier2d::solid_from_body(name, *body, &world.bodies, &world.colliders)?;
        let known = &hosted.system().solids()[hosted.system().find_solid(name).unwrap_or_default()].spec;
        let (Role::Free(taken), Role::Free(said)) = (&spec.role, &known.role) else { panic!("both are free") };
        assert!((taken.mass / said.mass - 1.0).abs() < 1e-12 && spec.shape == known.shape && spec.pose == known.pose);
        assert!((taken.inertia - said.inertia).norm() < 1e-12 * said.inertia.norm() && taken.spin == said.spin);
    }
    for _ in 0..200 {
        inside.step()?;
        hosted.step_with(f64::INFINITY, |step| {
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
        let (a, b) = (&inside.system().solids()[i].kinematics, &hosted.system().solids()[i].kinematics);
        // The same engine with the same forces; single precision in the sweep may make more of a last bit.
        let off = (a.pose.position - b.pose.position).norm() + (a.pose.rotation - b.pose.rotation).norm();
        assert!(off < 1e-9, "{i}: {off} apart after 200 steps");
        assert!((a.velocity - b.velocity).norm() < 1e-6);
    }
    Ok(())
}

#[test]
fn a_hosted_body_that_nobody_places_is_told_by_name() -> Result<()> {
    let mut sim = Simulation::with_external_bodies(Scene::parse(POOL, Path::new(""), &[])?.build::<2>()?.setup)?;
    let error = sim.step().expect_err("nobody moved them");
    assert!(error.kind == ErrorKind::Usage && error.message.contains("\"float\""), "{error}");
    let error = sim.step_with(1.0, |step| step.advance_bodies()).expect_err("it has no bodies of its own");
    assert!(error.help.is_some_and(|help| help.contains("step.solids")));
    Ok(())
}

#[test]
fn bodies_of_rapiers_become_solids_with_their_shapes() -> Result<()> {
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
    assert!((body_.centre - volume.centroid).norm() < 1e-9, "and where they lie");
    assert_eq!(body_.locked_rotations, [true; 3]);
    let hull = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Point::from_array);
    let mut other = PhysicsWorld::default();
    let tetra = other.insert_body(RigidBodyBuilder::fixed());
    other.insert_collider(ColliderBuilder::convex_hull(&hull).expect("a hull"), Some(tetra));
    let spec = rapier3d::solid_from_body("rock", tetra, &other.bodies, &other.colliders)?;
    assert!(matches!(spec.role, Role::Fixed) && (spec.shape.volume_properties().volume - 1.0 / 6.0).abs() < 1e-12);
    other.insert_collider(ColliderBuilder::cone(0.1, 0.1), Some(tetra));
    let error =
        rapier3d::solid_from_body("rock", tetra, &other.bodies, &other.colliders).expect_err("water feels no cone");
    assert!(error.message.contains("Cone") && error.help.is_some(), "{error}");
    assert!(rapier3d::solid_from_body("gone", tetra, &world.bodies, &ColliderSet::new()).is_err());
    Ok(())
}

#[test]
fn a_solid_that_comes_takes_the_place_of_water_and_one_that_goes_leaves_it() -> Result<()> {
    let mut sim = pool()?;
    steps(&mut sim, 20)?;
    let water = sim.system().fluid().len();
    let added = sim.add_solid(block("late", [0.5, 0.1], 800.0))?;
    // 5 × 4 cells of the lattice, which has hardly moved.
    assert!(added.solid == 3 && (16..=24).contains(&added.displaced), "{added:?}");
    assert_eq!(sim.system().fluid().len(), water - added.displaced);
    steps(&mut sim, 100)?;
    assert!(sim.system().solids()[3].kinematics.velocity[1] > 0.0, "it rises");
    let kinetic = |sim: &Simulation<2>| sim.system().fluid().v.iter().map(|v| v.norm()).fold(0.0, f64::max);
    sim.remove_solid(3)?;
    let skin = sim.system().boundary().len();
    assert!(sim.system().solids()[3].boundary.is_empty() && skin == pool()?.system().boundary().len());
    sim.remove_solid(1)?;
    while sim.time() < 0.6 {
        sim.step_to(0.6)?;
    }
    let near = sim.system().fluid().r.iter().filter(|r| (*r - Vector::from([0.5, 0.1])).amax() < 0.05).count();
    assert!(near >= 20, "water is back where the block was: {near} particles of 25");
    assert!(kinetic(&sim) < 2.0 && sim.rollbacks().is_empty(), "in peace: {} m/s", kinetic(&sim));
    assert!(sim.system().solids()[2].kinematics.centre[1] > 0.25, "the foam floats on");
    Ok(())
}

#[test]
fn solids_that_come_and_go_give_the_same_bits_at_any_number_of_threads_and_after_a_restart() -> Result<()> {
    let course = |sim: &mut Simulation<2>| -> Result<()> {
        steps(sim, 15)?;
        sim.add_solid(block("first", [0.5, 0.4], 30.0))?;
        steps(sim, 15)?;
        sim.remove_solid(1)?;
        // Where the first would stand in the way if it had not moved on.
        sim.add_solid(block("second", [0.3, 0.25], 700.0))?;
        steps(sim, 15)
    };
    let run = |threads: usize| -> Result<(Vec<u8>, Vec<u8>)> {
        let pool_of = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool_of.install(|| {
            let mut sim = pool()?;
            course(&mut sim)?;
            let kept = sim.save()?;
            steps(&mut sim, 40)?;
            Ok((kept, sim.save()?))
        })
    };
    let (kept, end) = run(1)?;
    assert!(run(2)? == (kept.clone(), end.clone()), "two threads");
    let mut resumed = pool()?;
    assert!(resumed.restore(&kept).is_err(), "other solids");
    let mut resumed = pool()?;
    resumed.restore_with_added_solids(
        &kept,
        vec![block("first", [0.5, 0.4], 30.0), block("second", [0.3, 0.25], 700.0)],
    )?;
    assert!(resumed.save()? == kept, "what was kept comes back whole");
    steps(&mut resumed, 40)?;
    assert!(resumed.save()? == end, "and goes on to the same bits");
    Ok(())
}

#[test]
fn what_cannot_come_or_go_is_refused_in_words_and_nothing_changes() -> Result<()> {
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
fn the_first_free_body_may_come_late() -> Result<()> {
    let text = POOL.split("[[solid]]\nname  = \"float\"").next().unwrap_or_default();
    let mut sim = Simulation::new(Scene::parse(text, Path::new(""), &[])?.build::<2>()?.setup)?;
    steps(&mut sim, 5)?;
    sim.add_solid(block("late", [0.5, 0.36], 500.0))?;
    while sim.time() < 1.5 {
        sim.step_to(1.5)?;
    }
    let height = sim.system().solids()[1].kinematics.centre[1];
    // Half of it under water, to a dp while it still bobs.
    assert!((height - 0.3).abs() < DP, "{height} m");
    Ok(())
}
