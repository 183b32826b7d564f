//! A gripper takes a float out of the water: a carriage on a lift, two jaws on it, one that is moved to its place and one that presses. What
//! the lift's motor carries in the end is the gripper and the weight of the float, which friction alone holds.
//!
//! `cargo run --release --example gripper`, some seconds.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program prints and a demonstration may panic"
)]

use pontoon::{
    Result,
    scene::{JointConfig, JointKindConfig, MotorConfig, PlacementConfig, Scene, ShapeConfig, SolidConfig},
    simulation::Simulation,
    solid::{Role, Solid},
};

const DEPTH: f64 = 0.2;

/// Width, height (m) and density (kg/m³) of the float.
const FLOAT: [f64; 2] = [0.16, 0.08];
const DENSITY: f64 = 600.0;

/// How far the lift goes (m), between which times (s).
const LIFT: f64 = 0.2;
const TIMES: [f64; 2] = [1.5, 3.0];

fn slider<const N: usize>(
    name: &str,
    between: [&str; N],
    at: [f64; 2],
    along: [f64; 2],
    motor: MotorConfig,
) -> JointConfig {
    JointConfig::new(name, JointKindConfig::Slider, between, at).along(along).motor(motor)
}

fn gripper() -> Scene {
    let rise = format!("{LIFT}*min(max((t-{})/{},0),1)", TIMES[0], TIMES[1] - TIMES[0]);
    let servo = |law: String| MotorConfig::default().position(law).stiffness(2e5).damping(5e3);
    // Jaws 2 cm from the float close at 0.5 s; 150 N press, of which friction makes 0.6 on each side.
    let close = "0.02*min(max((t-0.5)/0.3,0),1)".to_string();
    let press = MotorConfig::default().force("-150*min(max((t-0.8)/0.2,0),1)").damping(300.0);
    let jaw = |name, x: f64| {
        // Its tip is a little above the water, beside the float's dry part.
        let at = PlacementConfig::point(&[x]).bottom(DEPTH + 0.004);
        SolidConfig::free(name, ShapeConfig::cuboid([0.04, 0.16]), 500.0).at(at).friction(0.6)
    };
    let aside = 0.5 * FLOAT[0] + 0.04;
    let float = SolidConfig::free("float", ShapeConfig::cuboid(FLOAT), DENSITY)
        .at(PlacementConfig::afloat(&[0.5]))
        .friction(0.6);
    Scene::new(2, 0.02, 4.0)
        .title("A gripper and a float")
        .water_box([0.0, 0.0], [1.0, DEPTH])
        .solid(SolidConfig::fixed("tank", ShapeConfig::tank([1.0, 0.4])))
        .solid(float)
        .solid(
            SolidConfig::free("carriage", ShapeConfig::cuboid([0.4, 0.06]), 500.0)
                .at(PlacementConfig::point(&[0.5, DEPTH + 0.24])),
        )
        .solid(jaw("left", 0.5 - aside))
        .solid(jaw("right", 0.5 + aside))
        .joint(slider("lift", ["carriage"], [0.5, DEPTH + 0.24], [0.0, 1.0], servo(rise)))
        .joint(slider("mover", ["carriage", "left"], [0.5 - aside, DEPTH + 0.16], [1.0, 0.0], servo(close)))
        .joint(slider("presser", ["carriage", "right"], [0.5 + aside, DEPTH + 0.16], [1.0, 0.0], press))
}

fn main() -> Result<()> {
    let built = gripper().build::<2>()?;
    let until = built.plan.until;
    let mut sim = Simulation::new(built.setup)?;
    let (lift, presser) = (sim.find_joint("lift")?, sim.find_joint("presser")?);
    // What the lift carries in the end.
    let (mut carried, mut weight, mut next) = (0.0, 0.0, 0.0);
    println!("{:>7} {:>11} {:>12} {:>14} {:>14}", "t (s)", "lift (mm)", "float (mm)", "lift (N/m)", "press (N/m)");
    while sim.time() < until {
        sim.step_to(until)?;
        let (time, motor) = (sim.time(), sim.joint_reading(lift).motor_force);
        let float = sim.system().solids()[1].kinematics.centre[1] - DEPTH;
        if time >= next {
            let (up, press) = (1e3 * sim.joint_reading(lift).position, sim.joint_reading(presser).motor_force);
            println!("{time:7.2} {up:11.2} {:12.2} {motor:14.2} {press:14.2}", 1e3 * float);
            next += 0.25;
        }
        if time > until - 0.5 {
            carried += motor * sim.dt();
            weight += sim.dt();
        }
    }
    let weigh = |solid: &Solid<2>| if let Role::Free(body) = &solid.spec.role { body.mass * 9.81 } else { 0.0 };
    let [float, gripper] = [1..2, 2..5].map(|which| sim.system().solids()[which].iter().map(weigh).sum::<f64>());
    let held = carried / weight - gripper;
    println!("lift {:.2} N/m, less the gripper's own weight of {gripper:.2} N/m: {held:.2} N/m", carried / weight);
    println!("weight of the float {float:.2} N/m");
    assert!((held / float - 1.0).abs() < 0.005, "it hangs in the air, held by friction");
    Ok(())
}
