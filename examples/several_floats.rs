//! Three blocks of wood afloat side by side: the scene is built in code and stepped, and the drafts that the
//! water gives them are held against Archimedes, draft = height × density / density of water. Then the oak is taken out while
//! a beam comes on the water: the level changes by what floats more or less, mass / (density of water × length of the tank).
//!
//! `cargo run --release --example several_floats`, half a minute.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program prints and a demonstration may panic"
)]

use pontoon::{
    Result,
    geometry::Shape,
    math::Vector,
    probe::{ElevationProbe, Probe},
    scene::{PlacementConfig, Scene, ShapeConfig, SolidConfig},
    simulation::Simulation,
    solid::SolidSpec,
};

/// Name, density (kg/m³) and place (m) of each block.
const BLOCKS: [(&str, f64, f64); 3] = [("balsa", 200.0, 0.2), ("pine", 500.0, 0.6), ("oak", 800.0, 1.0)];

/// Width and height of each block, m.
const SIZE: [f64; 2] = [0.2, 0.1];

/// Length of the tank, m.
const LENGTH: f64 = 1.2;

/// Width and height (m) of the beam that comes later, and its density, kg/m³.
const BEAM: ([f64; 2], f64) = ([0.1, 0.05], 800.0);

/// The longest time in which water swings to and fro in the tank, 2 L/√(g depth), s.
const SLOSH: f64 = 1.75;

/// Particle spacing, m.
const DP: f64 = 0.01;

fn main() -> Result<()> {
    let mut scene = Scene::new(2, DP, 1.0)
        .title("Three blocks")
        .water_box([0.0, 0.0], [LENGTH, 0.2])
        .solid(SolidConfig::fixed("tank", ShapeConfig::tank([LENGTH, 0.4])));
    for (name, density, x) in BLOCKS {
        let block = SolidConfig::free(name, ShapeConfig::cuboid(SIZE), density);
        scene = scene.solid(block.at(PlacementConfig::afloat(&[x])));
    }
    scene.model.c0_factor = Some(12.0);
    let built = scene.build::<2>()?;
    let (start, until) = (0.5, built.plan.until);
    let mut sim = Simulation::new(built.setup)?;
    let gauge = ElevationProbe::new(sim.system(), &[0.4])?;

    // Means over the second half.
    let (mut drafts, mut levels, mut weight) = ([0.0; BLOCKS.len()], 0.0, 0.0);
    while sim.time() < until {
        sim.step_to(until)?;
        if sim.time() < start {
            continue;
        }
        let level = gauge.sample(&sim)[0];
        for (draft, (name, ..)) in drafts.iter_mut().zip(BLOCKS) {
            let block = sim.system().solids().iter().find(|s| s.spec.name == name);
            let height = block.map_or(f64::NAN, |s| s.kinematics.centre[1]);
            *draft += (level - (height - 0.5 * SIZE[1])) * sim.dt();
        }
        levels += level * sim.dt();
        weight += sim.dt();
    }

    println!("{:8} {:>10} {:>11} {:>12} {:>10}", "block", "draft (m)", "theory (m)", "off by (mm)", "(dp)");
    for (draft, (name, density, _)) in drafts.iter().zip(BLOCKS) {
        let (draft, theory) = (draft / weight, SIZE[1] * density / 1000.0);
        let off = draft - theory;
        println!("{name:8} {draft:10.4} {theory:11.4} {:12.2} {:10.3}", 1e3 * off, off / DP);
        assert!(off.abs() < 0.1 * DP, "within a tenth of a spacing of Archimedes");
    }
    exchange(sim, levels / weight)
}

/// Takes the oak out, lets a beam come on the water between the others, and holds the level against that `before` (m).
fn exchange(mut sim: Simulation<2>, before: f64) -> Result<()> {
    let oak = sim.system().find_solid("oak").unwrap_or_default();
    sim.remove_solid(oak)?;
    let (size, density) = BEAM;
    let shape = Shape::Box { size: Vector::from(size) };
    let beam = SolidSpec::free("beam", shape, density).at([0.4, before + 0.5 * size[1] + 0.5 * DP]);
    assert_eq!(sim.add_solid(beam)?.displaced, 0, "it comes on the water, not into it");

    // The water closes over the oak's place with a splash; the mean is over a whole swing after it.
    let gauges: Vec<_> =
        [0.8, 0.9, 1.0, 1.1].map(|x| ElevationProbe::new(sim.system(), &[x])).into_iter().collect::<Result<_>>()?;
    let (from, until) = (2.5, 2.5 + SLOSH);
    let mut levels = 0.0;
    while sim.time() < until {
        sim.step_to(until)?;
        if sim.time() > from {
            let level: f64 = gauges.iter().map(|gauge| gauge.sample(&sim)[0]).sum();
            levels += level / gauges.len() as f64 * sim.dt();
        }
    }
    let risen = levels / SLOSH - before;
    let theory = (size[0] * size[1] * density - SIZE[0] * SIZE[1] * BLOCKS[2].1) / (1000.0 * LENGTH);
    println!("\noak out, beam in: the level rises by {:.2} mm, theory {:.2} mm", 1e3 * risen, 1e3 * theory);
    assert!((risen - theory).abs() < 0.1 * DP, "within a tenth of a spacing");
    Ok(())
}
