//! How strong should the brake of a hinged raft be? Two pontoons in waves, once for each brake: the power that it takes has a maximum
//! between a hinge that turns freely and one that hardly turns.
//!
//! `cargo run --release --example hinged_raft`, a minute or two.

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
        DrivenConfig, JointConfig, JointKindConfig, MotorConfig, PlacementConfig, Scene, ShapeConfig, SolidConfig,
        SpringConfig,
    },
    simulation::Simulation,
};

/// Period of the waves, s.
const PERIOD: f64 = 0.8;

/// A raft with this brake in its hinge, N m s/rad per metre of width.
fn raft(brake: f64) -> Scene {
    let pontoon = |name, x: f64| {
        SolidConfig::free(name, ShapeConfig::cuboid([0.25, 0.075]), 500.0).at(PlacementConfig::afloat(&[x]))
    };
    let mooring = SpringConfig::mooring("mooring", "fore", [0.775, 0.25], [0.3, 0.0], 50.0).length(0.6).damping(5.0);
    let paddle = DrivenConfig::slide([1.0, 0.0], format!("0.025*(1-cos(2*pi*t/{PERIOD}))"));
    Scene::new(2, 0.0125, 6.0 * PERIOD)
        .title("A hinged raft")
        .water_box([0.0, 0.0], [2.5, 0.25])
        .solid(SolidConfig::fixed("tank", ShapeConfig::tank([2.6, 0.6])).at(PlacementConfig::point(&[-0.1, 0.0])))
        .solid(SolidConfig::fixed("beach", ShapeConfig::polygon([[1.9, 0.0], [2.5, 0.0], [2.5, 0.36]])))
        .solid(
            SolidConfig::driven("paddle", ShapeConfig::cuboid([0.05, 0.5]), paddle)
                .at(PlacementConfig::point(&[-0.025]).bottom(0.0)),
        )
        .solid(pontoon("fore", 0.9))
        .solid(pontoon("aft", 1.2))
        .joint(
            JointConfig::new("hinge", JointKindConfig::Hinge, ["fore", "aft"], [1.05, 0.25])
                .motor(MotorConfig::default().damping(brake)),
        )
        .spring(mooring)
}

fn main() -> Result<()> {
    println!("{:>22} {:>18} {:>14}", "brake (N m s/rad/m)", "mean power (W/m)", "swing (deg)");
    for brake in [0.1, 2.0, 20.0] {
        let built = raft(brake).build::<2>()?;
        let (until, from) = (built.plan.until, built.plan.until - 2.0 * PERIOD);
        let mut sim = Simulation::new(built.setup)?;
        let hinge = sim.find_joint("hinge")?;
        while sim.time() < from {
            sim.step_to(from)?;
        }
        // Over the last two periods.
        let before = sim.joint_reading(hinge).absorbed_energy;
        let mut swing: f64 = 0.0;
        while sim.time() < until {
            sim.step_to(until)?;
            swing = swing.max(sim.joint_reading(hinge).position.abs());
        }
        let power = (sim.joint_reading(hinge).absorbed_energy - before) / (until - from);
        println!("{brake:22.1} {power:18.4} {:14.2}", swing.to_degrees());
        assert!(power > 0.0, "a brake only takes");
    }
    Ok(())
}
