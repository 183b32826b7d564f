//! A boat with two hulls and a wheel between them, turned by a motor. The boat is the same fore and aft: with the wheel turned the other way
//! it must go as far astern as it went ahead. Printed are the way made, the motor's power, and how much of the wheel's rim speed the boat has.
//!
//! `cargo run --release --example wheel_boat`, half a minute.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program prints and a demonstration may panic"
)]

use pontoon::{
    Result,
    scene::{
        CompoundPartConfig, FreeBodyConfig, JointConfig, JointKindConfig, PlacementConfig, Scene, ShapeConfig,
        SolidConfig,
    },
    simulation::Simulation,
    solid::Motor,
};

/// Particle spacing, depth of the water and length of the pool, m.
const DP: f64 = 0.02;
const DEPTH: f64 = 0.3;
const POOL: f64 = 3.2;

/// Radius of the wheel and height of its hub above the water, m.
const RADIUS: f64 = 0.2;
const HUB: f64 = 0.1;

/// How fast it is turned, rad/s.
const TURNING: f64 = 5.0;

/// How long, s.
const UNTIL: f64 = 3.0;

fn part(size: [f64; 2], at: [f64; 2]) -> CompoundPartConfig {
    CompoundPartConfig::new(ShapeConfig::cuboid(size), PlacementConfig::point(&at))
}

/// The boat afloat in the middle of the pool; its frame is at the water's surface.
fn boat() -> Result<Simulation<2>> {
    let hull = ShapeConfig::Compound(vec![
        part([0.3, 0.12], [-0.42, 0.0]),
        part([0.3, 0.12], [0.42, 0.0]),
        part([0.06, 0.28], [-0.42, 0.2]),
        part([0.06, 0.28], [0.42, 0.2]),
        part([0.9, 0.04], [0.0, 0.36]),
    ]);
    let arm = RADIUS - 0.02;
    let wheel = ShapeConfig::Compound(vec![
        part([2.0 * RADIUS, 0.04], [0.0, 0.0]),
        part([0.04, arm], [0.0, 0.02 + 0.5 * arm]),
        part([0.04, arm], [0.0, -0.02 - 0.5 * arm]),
    ]);
    let middle = 0.5 * POOL;
    // Hulls of 0.6 m together carry boat and wheel with half their height under water.
    let mass = 1000.0 * 0.6 * 0.06;
    let wheel = SolidConfig::free("wheel", wheel, 200.0).at(PlacementConfig::point(&[middle, DEPTH + HUB]));
    // The wheel displaces some water itself, so that the boat starts a little high.
    let body = FreeBodyConfig::from_mass(mass - 200.0 * 0.04 * (2.0 * RADIUS + 2.0 * arm));
    let hull = SolidConfig::with_body("boat", hull, body).at(PlacementConfig::point(&[middle, DEPTH]));
    let built = Scene::new(2, DP, UNTIL)
        .title("A boat with a wheel")
        .water_box([0.0, 0.0], [POOL, DEPTH])
        .solid(SolidConfig::fixed("pool", ShapeConfig::tank([POOL, 0.6])))
        .solid(hull)
        .solid(wheel)
        .joint(JointConfig::new("axle", JointKindConfig::Hinge, ["boat", "wheel"], [middle, DEPTH + HUB]))
        .build::<2>()?;
    Simulation::new(built.setup)
}

fn main() -> Result<()> {
    println!("{:8} {:>8} {:>12} {:>16} {:>18}", "", "way (m)", "speed (m/s)", "power (W/m)", "speed over rim's");
    let mut ways = Vec::new();
    for (name, turning) in [("ahead", -TURNING), ("astern", TURNING)] {
        let mut sim = boat()?;
        let axle = sim.find_joint("axle")?;
        let (mut work, mut speed) = (0.0, 0.0);
        let start = sim.system().solids()[1].kinematics.centre[0];
        while sim.time() < UNTIL {
            // The motor is run up within half a second.
            let wanted = turning * (2.0 * sim.time()).min(1.0);
            let motor = Motor::default().velocity(wanted).damping(20.0);
            sim.set_motor(axle, Some(motor.command_at(0.0)));
            sim.step_to(UNTIL)?;
            work -= sim.joint_reading(axle).absorbed_power() * sim.dt();
            if sim.time() > UNTIL - 1.0 {
                speed += sim.system().solids()[1].kinematics.velocity[0] * sim.dt();
            }
        }
        let way = sim.system().solids()[1].kinematics.centre[0] - start;
        let slip = speed.abs() / (TURNING * RADIUS);
        println!("{name:8} {way:8.3} {speed:12.3} {:16.2} {slip:18.2}", work / UNTIL);
        assert!(work > 0.0 && slip < 1.0, "a motor only gives, and no wheel drives faster than its rim");
        ways.push(way);
    }
    let [ahead, astern] = ways[..] else { return Ok(()) };
    println!("ahead and astern differ by {:.1} %", 100.0 * (ahead + astern).abs() / ahead);
    assert!(ahead > 0.2 && (ahead + astern).abs() < 0.1 * ahead, "the boat is the same fore and aft");
    Ok(())
}
