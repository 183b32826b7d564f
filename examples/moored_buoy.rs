//! A winch in the loop: a buoy on a mooring line is hauled down until it is under water. The tension rises with what it displaces,
//! to buoyancy less weight, (ρ₀ − ρ) g × its volume.
//!
//! `cargo run --release --example moored_buoy`, some seconds.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program prints and a demonstration may panic"
)]

use pontoon::{
    Result,
    scene::{PlacementConfig, Scene, ShapeConfig, SolidConfig, SpringConfig},
    simulation::Simulation,
};

/// Width and height of the buoy, m, and its density, kg/m³.
const SIZE: [f64; 2] = [0.2, 0.1];
const DENSITY: f64 = 500.0;

fn main() -> Result<()> {
    // Afloat its bottom is 0.05 m under the surface.
    let line = SpringConfig::mooring("line", "buoy", [0.5, 0.35], [0.5, 0.0], 10000.0).damping(500.0);
    let built = Scene::new(2, 0.02, 4.0)
        .title("A buoy on a winch")
        .water_box([0.0, 0.0], [1.0, 0.4])
        .solid(SolidConfig::fixed("tank", ShapeConfig::tank([1.0, 0.7])))
        .solid(SolidConfig::free("buoy", ShapeConfig::cuboid(SIZE), DENSITY).at(PlacementConfig::afloat(&[0.5])))
        .spring(line)
        .build::<2>()?;
    let mut sim = Simulation::new(built.setup)?;
    let line = sim.find_spring("line")?;
    let (mut next, mut mean) = (0.0, 0.0);
    println!("{:>7} {:>12} {:>15}", "t (s)", "line (m)", "tension (N/m)");
    while sim.time() < 4.0 {
        // The winch takes in 0.2 m in 2 s, far enough for the water to close over the buoy.
        sim.spring_parameters(line).rest_length = 0.35 - 0.1 * (sim.time() - 0.5).clamp(0.0, 2.0);
        sim.step_to(4.0)?;
        let now = sim.spring_reading(line);
        if sim.time() >= next {
            println!("{:7.2} {:12.4} {:15.2}", sim.time(), now.length, now.tension);
            next += 0.25;
        }
        if sim.time() > 3.0 {
            mean += now.tension * sim.dt();
        }
    }
    let exact = (1000.0 - DENSITY) * 9.81 * SIZE[0] * SIZE[1];
    println!("mean of the last second {mean:.2} N/m, Archimedes {exact:.2} N/m");
    assert!((mean / exact - 1.0).abs() < 0.05, "within 5 %: a buoy 5 dp high");
    Ok(())
}
