//! Three blocks of wood afloat side by side: the scene is built in code and stepped, and the drafts that the
//! water gives them are held against Archimedes, draft = height × density / density of water.
//!
//! `cargo run --release --example several_floats`, some seconds.

use pontoon::{
    Result,
    probe::{Elevation, Probe},
    scene::{AtWords, Scene, ShapeWords, SolidWords},
    simulation::Simulation,
};

/// Name, density (kg/m³) and place (m) of each block.
const BLOCKS: [(&str, f64, f64); 3] = [("balsa", 200.0, 0.2), ("pine", 500.0, 0.6), ("oak", 800.0, 1.0)];

/// Width and height of each block, m.
const SIZE: [f64; 2] = [0.2, 0.1];

/// Particle spacing, m.
const DP: f64 = 0.01;

fn main() -> Result<()> {
    let mut scene = Scene::new(2, DP, 1.0)
        .title("Three blocks")
        .water_box([0.0, 0.0], [1.2, 0.2])
        .solid(SolidWords::fixed("tank", ShapeWords::tank([1.2, 0.4])));
    for (name, density, x) in BLOCKS {
        let block = SolidWords::free(name, ShapeWords::cuboid(SIZE), density);
        scene = scene.solid(block.at(AtWords::afloat(&[x])));
    }
    scene.model.c0_factor = Some(12.0);
    let built = scene.build::<2>()?;
    let (start, until) = (0.5, built.plan.until);
    let mut sim = Simulation::new(built.setup)?;
    let gauge = Elevation::new(sim.system(), &[0.4])?;

    // Means over the second half.
    let (mut drafts, mut weight) = ([0.0; BLOCKS.len()], 0.0);
    while sim.time() < until {
        sim.step_to(until)?;
        if sim.time() < start {
            continue;
        }
        let level = gauge.look(&sim)[0];
        for (draft, (name, ..)) in drafts.iter_mut().zip(BLOCKS) {
            let block = sim.system().solids().iter().find(|s| s.spec.name == name);
            let height = block.map_or(f64::NAN, |s| s.kinematics.centre[1]);
            *draft += (level - (height - 0.5 * SIZE[1])) * sim.dt();
        }
        weight += sim.dt();
    }

    println!("{:8} {:>10} {:>11} {:>12} {:>10}", "block", "draft (m)", "theory (m)", "off by (mm)", "(dp)");
    for (draft, (name, density, _)) in drafts.iter().zip(BLOCKS) {
        let (draft, theory) = (draft / weight, SIZE[1] * density / 1000.0);
        let off = draft - theory;
        println!("{name:8} {draft:10.4} {theory:11.4} {:12.2} {:10.3}", 1e3 * off, off / DP);
        assert!(off.abs() < 0.1 * DP, "within a tenth of a spacing of Archimedes");
    }
    Ok(())
}
