//! Without a scene: water, tank and laws put together by hand, and a start that no scene can say. The water
//! begins flat, with the velocity of the tank's first standing wave, u = ∇φ, φ ~ cos(kx) cosh(ky), k = π/L.
//! Half a period later the surface is flat again: linear theory says T = 2π/√(g k tanh(k depth)).
//!
//! `cargo run --release --example own_setup`, some seconds.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program prints and a demonstration may panic"
)]

use std::f64::consts::PI;

use pontoon::{
    Result,
    geometry::Shape,
    math::Vector,
    model::{Model, Viscosity},
    probe::{ElevationProbe, Probe},
    simulation::{Setup, Simulation},
    solid::SolidSpec,
    sph::viscosity::Artificial,
};

/// Length and depth of the water, m.
const SIZE: [f64; 2] = [1.0, 0.4];

/// Particle spacing, m.
const DP: f64 = 0.02;

const GRAVITY: f64 = 9.81;

fn main() -> Result<()> {
    let mut sim = Simulation::new(setup()?)?;
    let k = PI / SIZE[0];
    let top = 0.05;
    sim.set_water_velocity(|r| {
        let (up, along) = ((k * r[1]).sinh(), (k * r[1]).cosh());
        Vector::from([-(k * r[0]).sin() * along, (k * r[0]).cos() * up]) * (top / (k * SIZE[1]).sinh())
    });
    sim.update_rates();

    // Where the level at the left passes its start on the way down, half a period is over.
    let gauge = ElevationProbe::new(sim.system(), &[0.1])?;
    let (mut before, mut highest) = ((0.0, 0.0), 0.0_f64);
    let half = loop {
        sim.step()?;
        let now = (sim.time(), gauge.sample(&sim)[1]);
        highest = highest.max(now.1);
        if highest > 0.005 && now.1 <= 0.0 {
            break before.0 + (now.0 - before.0) * before.1 / (before.1 - now.1);
        }
        before = now;
    };

    let theory = 2.0 * PI / (GRAVITY * k * (k * SIZE[1]).tanh()).sqrt();
    println!("highest level at x = 0.1 m   {:.1} mm", 1e3 * highest);
    println!("period                       {:.4} s", 2.0 * half);
    println!("linear theory                {theory:.4} s, {:+.1} %", 100.0 * (2.0 * half / theory - 1.0));
    assert!((2.0 * half / theory - 1.0).abs() < 0.03, "20 spacings of depth give the period within 3 %");
    Ok(())
}

/// Still water in a tank.
fn setup() -> Result<Setup<2>> {
    let viscosity = Viscosity::Artificial(Artificial { alpha: 0.01 });
    let model = Model::water(2, DP, SIZE[1]).viscosity(viscosity);
    let tank = Shape::Tank { size: Vector::from([SIZE[0], 0.6]), thickness: 4.0 * DP };
    Setup::new(model).solid(SolidSpec::fixed("tank", tank)).fill_box([0.0, 0.0], SIZE)
}
