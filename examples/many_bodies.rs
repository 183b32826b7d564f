//! What do many bodies cost? Boxes of four densities fall in rows into a tank (2-D); the same boxes fixed where they start, in the air,
//! cost nothing. Prints for each number of them the processor time of a step with free and with fixed boxes, what part of it the bodies and the
//! rigid-body engine are, and whether the pile has made energy.
//!
//! `cargo run --release --example many_bodies` takes some seconds; `-- 100000 400 1000` says how many particles of water,
//! how many steps, and how many bodies at most, and takes minutes.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program prints and a demonstration may panic"
)]

use cpu_time::ProcessTime;
use pontoon::{
    Result,
    probe::{EnergyProbe, Probe},
    scene::{PlacementConfig, Scene, ShapeConfig, SolidConfig},
    simulation::Simulation,
};

/// Particle spacing, m.
const DP: f64 = 0.01;

/// Width and height of a box, dp.
const SIZE: [f64; 2] = [10.0, 8.0];

/// Densities, kg/m³: what floats high and low, and what sinks.
const DENSITIES: [f64; 4] = [300.0, 600.0, 900.0, 1500.0];

fn main() -> Result<()> {
    let mut words = std::env::args().skip(1).map(|word| word.parse::<usize>().unwrap_or(0));
    let (water, steps, most) = (words.next().unwrap_or(4000), words.next().unwrap_or(150), words.next().unwrap_or(100));
    println!("{water} particles of water, means over {steps} steps, processor time of all threads\n");
    println!("| bodies | free, ms/step | fixed, ms/step | bodies, % | engine, % | contacts | energy made, % |");
    println!("|---|---|---|---|---|---|---|");
    for count in [1, 10, 100, 1000].into_iter().filter(|&count| count <= most) {
        let (mut free, mut fixed) = (tank(water, count, true)?, tank(water, count, false)?);
        let energy = EnergyProbe::new(free.system());
        let column = Probe::<2>::columns(&energy).iter().position(|name| name.starts_with("total")).unwrap_or_default();
        let total = |sim: &Simulation<2>| energy.sample(sim)[column];
        let (start, mut least, mut made) = (total(&free), f64::INFINITY, 0.0_f64);
        let mut cost = [0.0; 2];
        let before = free.time_spent();
        // In turns, as a shared machine changes its speed.
        for step in 0..steps {
            for (cost, sim) in cost.iter_mut().zip([&mut free, &mut fixed]) {
                let begun = ProcessTime::now();
                sim.step()?;
                *cost += begun.elapsed().as_secs_f64() * 1e3 / steps as f64;
            }
            if step % 10 == 9 {
                let now = total(&free);
                least = least.min(now);
                made = made.max(now - least);
            }
        }
        // Both of the wall clock, which others on the machine move alike.
        let spent = free.time_spent();
        let share = (spent.bodies - before.bodies).as_secs_f64() / (spent.steps - before.steps).as_secs_f64();
        let (part, share, fallen) = (100.0 * (1.0 - cost[1] / cost[0]), 100.0 * share, start - least);
        println!(
            "| {count} | {:.3} | {:.3} | {part:.1} | {share:.1} | {} | {:.2} |",
            cost[0],
            cost[1],
            free.contacts().len(),
            100.0 * made / fallen
        );
        assert!(made < 0.05 * fallen, "a pile that falls into water makes no energy");
    }
    Ok(())
}

/// A tank of so many particles of water, and boxes above it.
fn tank(water: usize, count: usize, free: bool) -> Result<Simulation<2>> {
    let deep = (0.4 * water as f64).sqrt().round();
    let long = (water as f64 / deep).round();
    let across = ((long - 4.0) / (SIZE[0] + 2.0)).floor();
    let rows = (count as f64 / across).ceil();
    let high = deep + (rows + 4.0) * (SIZE[1] + 1.0);
    let mut scene = Scene::new(2, DP, 100.0)
        .title("Many bodies")
        .water_box([0.0, 0.0], [long * DP, deep * DP])
        .solid(SolidConfig::fixed("tank", ShapeConfig::tank([long * DP, high * DP])));
    for i in 0..count {
        let (row, column) = ((i as f64 / across).floor(), i as f64 % across);
        let aside = if row % 2.0 == 0.0 { 0.0 } else { 1.5 };
        let x = 2.5 + 0.5 * SIZE[0] + column * (SIZE[0] + 1.9) + aside;
        let at = PlacementConfig::point(&[x * DP]).bottom((deep + 0.5 + row * (SIZE[1] + 0.3)) * DP);
        let (name, shape) = (format!("box-{i}"), ShapeConfig::cuboid(SIZE.map(|size| size * DP)));
        let solid = match free {
            true => SolidConfig::free(name, shape, DENSITIES[i % 4]),
            false => SolidConfig::fixed(name, shape),
        };
        scene = scene.solid(solid.at(at).friction(0.4));
    }
    // Nothing falls faster than 4 m/s here.
    scene.model.c0 = Some(40.0);
    Simulation::new(scene.build::<2>()?.setup)
}
