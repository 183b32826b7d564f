//! A probe of your own: how much water stands left of a plane, beside the probes of the program. In a dam break it must fall,
//! and what falls on the left comes on the right.
//!
//! `cargo run --release --example own_probe`, some seconds.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program prints and a demonstration may panic"
)]

use std::path::Path;

use pontoon::{Result, probe::Probe, scene::Scene, simulation::Simulation};

const SCENE: &str = r#"
dimension = 2
dp = 0.02
until = 1.0
water = [{ fill = { box = { min = [0, 0], max = [0.5, 0.4] } } }]
[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [1.5, 0.8] } }
"#;

/// Area of the water on either side of a plane across the x axis.
struct Split {
    /// Position of the plane, m.
    x: f64,
}

impl<const D: usize> Probe<D> for Split {
    fn columns(&self) -> Vec<String> {
        vec!["left_m2".into(), "right_m2".into()]
    }

    fn sample(&self, sim: &Simulation<D>) -> Vec<f64> {
        let (water, mass) = (sim.system().fluid(), sim.system().particle_mass());
        let mut areas = [0.0; 2];
        for (r, rho) in water.r.iter().zip(water.rho) {
            areas[usize::from(r[0] > self.x)] += mass / rho;
        }
        areas.to_vec()
    }
}

fn main() -> Result<()> {
    let scene = Scene::parse(SCENE, Path::new(""), &[])?;
    let mut sim = Simulation::new(scene.build::<2>()?.setup)?;
    let probe = Split { x: 0.5 };
    let start = probe.sample(&sim);
    while sim.time() < 0.5 {
        sim.step()?;
    }
    let end = probe.sample(&sim);
    for (name, (before, after)) in Probe::<2>::columns(&probe).iter().zip(start.iter().zip(&end)) {
        println!("{name:<10} {before:.4} -> {after:.4}");
    }
    assert!(end[0] < 0.7 * start[0], "the column has collapsed after 0.5 s");
    let (before, after) = (start[0] + start[1], end[0] + end[1]);
    assert!((after / before - 1.0).abs() < 0.01, "water is compressible by less than 1 %");
    Ok(())
}
