//! Water for a rapier world of your own. The world below knows nothing of pontoon: a raft, a crate that is let fall on it, and
//! gravity. Water is added to the raft alone: each step it takes forces out and puts the raft's pose in. With the crate on board
//! the raft lies deeper by crate's mass / (ρ₀ × width).
//!
//! `cargo run --release --example own_world`, some seconds.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program prints and a demonstration may panic"
)]

use pontoon::{
    Result,
    probe::{ElevationProbe, Probe},
    scene::{Scene, ShapeConfig, SolidConfig},
    simulation::Simulation,
    solid::rapier2d::{self, rapier::prelude::*},
};

/// Width and height of the raft, m.
const SIZE: [f64; 2] = [0.4, 0.1];

/// Mass of the crate, kg per metre.
const CRATE: f64 = 4.0;

/// Depth of the water, m.
const DEPTH: f64 = 0.2;

fn main() -> Result<()> {
    let (mut world, raft, load) = world();
    let mut water = water(&world, raft)?;
    let gauge = ElevationProbe::new(water.system(), &[0.15])?;

    let until = 3.0;
    let (mut drafts, mut weights) = ([0.0; 2], [0.0; 2]);
    while water.time() < until {
        if water.time() > 0.8 && !world.bodies[load].is_enabled() {
            world.bodies[load].set_enabled(true);
        }
        water.step_with(until, |step| {
            rapier2d::apply_load(&mut world.bodies[raft], &step.loads()[1]);
            world.integration_parameters.dt = step.dt();
            world.step();
            step.solids[1] = rapier2d::kinematics(&world.bodies[raft]);
            Ok(())
        })?;
        // Means over the half second before the crate falls, and over the last second.
        let time = water.time();
        let which = usize::from(time > 0.8);
        if (0.3..0.8).contains(&time) || time > until - 1.0 {
            let bottom = world.bodies[raft].translation().y - 0.5 * SIZE[1];
            drafts[which] += (gauge.sample(&water)[0] - bottom) * water.dt();
            weights[which] += water.dt();
        }
    }
    let [alone, laden] = [drafts[0] / weights[0], drafts[1] / weights[1]];
    println!("{:14} {:>10} {:>11}", "", "draft (m)", "theory (m)");
    println!("{:14} {alone:10.4} {:11.4}", "alone", 0.5 * SIZE[1]);
    println!("{:14} {laden:10.4} {:11.4}", "with the crate", 0.5 * SIZE[1] + CRATE / (1000.0 * SIZE[0]));
    let deeper = laden - alone;
    let theory = CRATE / (1000.0 * SIZE[0]);
    println!("{:14} {deeper:10.4} {theory:11.4}", "deeper by");
    assert!((deeper - theory).abs() < 0.001, "within a tenth of a spacing");
    assert!(world.bodies[load].translation().y > DEPTH, "the crate is on board");
    Ok(())
}

/// A world of rigid bodies, as anybody has one.
fn world() -> (PhysicsWorld, RigidBodyHandle, RigidBodyHandle) {
    let mut world = PhysicsWorld { gravity: Vector::new(0.0, -9.81), ..PhysicsWorld::default() };
    // One iteration: more of them hold the water's force over parts of a step, which feeds energy into what bobs.
    world.integration_parameters.num_solver_iterations = 1;
    let raft = world.insert_body(RigidBodyBuilder::dynamic().translation(Vector::new(0.5, DEPTH)).can_sleep(false));
    world.insert_collider(ColliderBuilder::cuboid(0.5 * SIZE[0], 0.5 * SIZE[1]).density(500.0), Some(raft));
    let above = Vector::new(0.5, DEPTH + 0.5 * SIZE[1] + 0.05);
    let load = world.insert_body(RigidBodyBuilder::dynamic().translation(above).enabled(false).can_sleep(false));
    world.insert_collider(ColliderBuilder::cuboid(0.04, 0.04).density(CRATE / 0.0064), Some(load));
    // Masses are known from here on.
    for body in [raft, load] {
        world.bodies[body].recompute_mass_properties_from_colliders(&world.colliders);
    }
    (world, raft, load)
}

/// A tank of water with the raft in it.
fn water(world: &PhysicsWorld, raft: RigidBodyHandle) -> Result<Simulation<2>> {
    let mut scene = Scene::new(2, 0.01, 3.0)
        .water_box([0.0, 0.0], [1.0, DEPTH])
        .solid(SolidConfig::fixed("tank", ShapeConfig::tank([1.0, 0.4])));
    scene.model.c0_factor = Some(12.0);
    let mut water = Simulation::with_external_bodies(scene.build::<2>()?.setup)?;
    // The raft gets number 1, after the tank; the water in its place goes.
    water.add_solid(rapier2d::solid_from_body("raft", raft, &world.bodies, &world.colliders)?)?;
    Ok(water)
}
