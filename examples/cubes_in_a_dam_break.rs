//! A stack of cubes is dropped onto a dry floor, and a column of water breaks on it: contacts, blows and water at once. It falls, makes no
//! energy, and in the end the cubes, half as heavy as water, float with their middles at the level that is left.
//!
//! `cargo run --release --example cubes_in_a_dam_break`, some seconds.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program prints and a demonstration may panic"
)]

use pontoon::{
    Result,
    probe::{EnergyProbe, Probe},
    scene::{PlacementConfig, Scene, ShapeConfig, SolidConfig},
    simulation::Simulation,
};

/// Edge of a cube, m.
const EDGE: f64 = 0.08;

/// How many there are.
const CUBES: usize = 5;

/// Width and height of the column, m, and length of the tank.
const COLUMN: [f64; 2] = [0.4, 0.3];
const TANK: f64 = 1.6;

/// Period of the longest wave in the tank at the end, s: 2 L/√(g d).
const WAVE: f64 = 3.5;

fn main() -> Result<()> {
    let dp = 0.01;
    let mut scene = Scene::new(2, dp, 8.5)
        .title("Cubes in a dam break")
        .water_box([0.0, 0.0], COLUMN)
        .solid(SolidConfig::fixed("tank", ShapeConfig::tank([TANK, 0.8])));
    for i in 0..CUBES {
        // Let fall from 20 mm, each a millimetre above the one below.
        let at = PlacementConfig::point(&[1.0]).bottom(0.02 + i as f64 * (EDGE + 0.001));
        let cube = SolidConfig::free(format!("cube-{i}"), ShapeConfig::cuboid([EDGE; 2]), 500.0);
        scene = scene.solid(cube.at(at).friction(0.5));
    }
    let built = scene.build::<2>()?;
    let until = built.plan.until;
    let mut sim = Simulation::new(built.setup)?;
    let energy = EnergyProbe::new(sim.system());
    let column = Probe::<2>::columns(&energy).iter().position(|name| name.starts_with("total")).unwrap_or_default();

    let (start, mut least, mut made) = (energy.sample(&sim)[column], f64::INFINITY, 0.0_f64);
    let (mut fell, mut struck) = (None, 0.0_f64);
    let (mut height, mut weight) = (0.0, 0.0);
    while sim.time() < until {
        sim.step_to(until)?;
        let now = energy.sample(&sim)[column];
        least = least.min(now);
        made = made.max(now - least);
        struck = sim.contacts().iter().map(|pair| pair.normal_force).fold(struck, f64::max);
        let cubes = &sim.system().solids()[1..];
        let top = cubes[CUBES - 1].kinematics.pose;
        if fell.is_none() && (top.position[0] - 1.0).abs() > 0.5 * EDGE {
            fell = Some(sim.time());
        }
        if sim.time() > until - WAVE {
            height += cubes.iter().map(|cube| cube.kinematics.centre[1]).sum::<f64>() / CUBES as f64 * sim.dt();
            weight += sim.dt();
        }
    }
    let cubes = &sim.system().solids()[1..];
    println!("the stack falls at          {:.2} s", fell.unwrap_or(f64::NAN));
    println!("largest force of contact    {struck:.0} N/m");
    let places: Vec<String> = cubes.iter().map(|cube| format!("{:.2}", cube.kinematics.centre[0])).collect();
    println!("cubes end at                {} m", places.join(", "));
    println!("energy                      {:.1} J/m lost, {made:.2} J/m made on the way", start - least);
    let level = (COLUMN[0] * COLUMN[1] + 0.5 * CUBES as f64 * EDGE * EDGE) / TANK;
    println!("middles of the cubes        {:.4} m", height / weight);
    println!("level, from the volumes     {level:.4} m");
    assert!(fell.is_some_and(|t| (0.2..2.0).contains(&t)), "the water throws the stack over");
    assert!(made < 0.02 * (start - least), "blows and contacts make no energy");
    assert!((height / weight - level).abs() < dp, "half of each under water, to a spacing while waves run");
    Ok(())
}
