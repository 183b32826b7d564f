//! A controller in the loop: each step it reads how the raft lies and how high the water stands, and presses
//! the raft down. In the end the raft lies 10 mm deeper, and the force that this takes must be the weight of
//! the water displaced: ρ g × width × 10 mm.
//!
//! `cargo run --release --example push_a_raft`, some seconds.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program prints and a demonstration may panic"
)]

use pontoon::{
    Result,
    math::Vector,
    probe::{ElevationProbe, Probe},
    scene::{PlacementConfig, Scene, ShapeConfig, SolidConfig},
    simulation::Simulation,
};

/// Width and height of the raft, m.
const SIZE: [f64; 2] = [0.4, 0.1];

/// How much deeper than afloat it shall lie, m.
const DEEPER: f64 = 0.01;

fn main() -> Result<()> {
    let mut scene = Scene::new(2, 0.01, 2.5)
        .title("A raft under a hand")
        .water_box([0.0, 0.0], [1.0, 0.2])
        .solid(SolidConfig::fixed("tank", ShapeConfig::tank([1.0, 0.4])))
        .solid(SolidConfig::free("raft", ShapeConfig::cuboid(SIZE), 500.0).at(PlacementConfig::afloat(&[0.5])));
    scene.model.c0_factor = Some(12.0);
    let built = scene.build::<2>()?;
    let until = built.plan.until;
    let mut sim = Simulation::new(built.setup)?;
    let gauge = ElevationProbe::new(sim.system(), &[0.15])?;
    let raft = pontoon::probe::find_solid(sim.system(), "raft")?;
    let draft =
        |sim: &Simulation<2>| gauge.sample(sim)[0] - (sim.system().solids()[raft].kinematics.centre[1] - 0.5 * SIZE[1]);
    // First it finds its own draft.
    while sim.time() < 0.5 {
        sim.step_to(0.5)?;
    }
    let wanted = draft(&sim) + DEEPER;

    // Proportional, integral and a damper, all per metre of width: soft beside the water's own ρ g × width.
    let (spring, reset, damper) = (2000.0, 12000.0, 400.0);
    let (mut sum, mut mean, mut next) = (0.0, 0.0, 0.5);
    println!("{:>7} {:>12} {:>10} {:>15}", "t (s)", "deeper (mm)", "v (m/s)", "force (N per m)");
    while sim.time() < until {
        let now = sim.system().solids()[raft].kinematics;
        let missing = wanted - draft(&sim);
        sum += missing * sim.dt();
        // Downwards is positive here; the world's last axis points up.
        let press = spring * missing + reset * sum + damper * now.velocity[1];
        sim.push(raft, &Vector::from([0.0, -press]), &now.centre);
        sim.step_to(until)?;
        if sim.time() > 1.5 {
            mean += press * sim.dt() / (until - 1.5);
        }
        if sim.time() >= next {
            let deeper = 1e3 * (DEEPER - missing);
            println!("{:7.2} {deeper:12.2} {:10.4} {press:15.2}", sim.time(), now.velocity[1]);
            next += 0.25;
        }
    }
    let theory = 1000.0 * 9.81 * SIZE[0] * DEEPER;
    println!("mean force of the last second {mean:.2} N per m, Archimedes {theory:.2} N per m");
    assert!((mean / theory - 1.0).abs() < 0.1, "within 10 %: the draft is known to a tenth of a spacing");
    Ok(())
}
