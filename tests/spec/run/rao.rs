//! How a float answers an irregular sea over frequency: what a run's tables hold, against the float's own equation.

use std::{f64::consts::TAU, fs};

use pontoon::{
    Result,
    run::{self, Progress, RaoResult, RunOptions, StatisticsFilter},
};

use crate::common::TestFolder;

const SCENE: &str = r#"
dimension = 2
dp = 0.05
until = 0.01
frames = "off"
[[water]]
fill = { box = { min = [0.0, 0.0], max = [4.0, 0.4] } }
[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [4.0, 0.8] } }
[[solid]]
name = "buoy"
shape = { box = { size = [0.4, 0.4] } }
at = { x = 3.0, bottom = 0.2 }
free = { density = 500.0 }
[[probe]]
name = "gauge"
elevation = { x = 1.0 }
[[probe]]
motion = "buoy"
[[statistic]]
rao = { motion = "buoy", wave = "gauge" }
from = 20.0
[[statistic]]
name = "regular"
rao = { motion = "buoy", wave = "gauge" }
period = 2.0
"#;

/// Natural frequency of the float, Hz, and its damping over critical damping.
const OWN: (f64, f64) = (0.6, 0.15);

/// A sea of 400 s of JONSWAP's form with its peak at 0.5 Hz, every half of `dt` (s), m.
fn sea(dt: f64) -> Vec<f64> {
    let form = |f: f64| {
        let bump = (-0.5 * ((f / 0.5 - 1.0) / if f <= 0.5 { 0.07 } else { 0.09 }).powi(2)).exp();
        f.powi(-5) * (-1.25 * (0.5 / f).powi(4)).exp() * 3.3_f64.powf(bump)
    };
    let all: Vec<(f64, f64)> = (0..800).map(|i| f64::from(i) + 0.5).map(|i| (i * 0.0025, form(i * 0.0025))).collect();
    let scale = 0.025 / all.iter().map(|(_, s)| s).sum::<f64>().sqrt();
    let part = |(i, (f, s)): (usize, &(f64, f64)), t: f64| {
        scale * (2.0 * s).sqrt() * (TAU * f * t + 2.399_963 * (i * i) as f64).cos()
    };
    let count = 2 * (400.0 / dt) as usize;
    (0..=count).map(|n| all.iter().enumerate().map(|of| part(of, 0.5 * dt * n as f64)).sum()).collect()
}

/// How the float moves from rest in the sea `eta`: z̈ + 2ζω ż + ω² z = ω² η, by Runge and Kutta's fourth order, m.
fn float(eta: &[f64], dt: f64) -> Vec<f64> {
    let (omega, damping) = (TAU * OWN.0, OWN.1);
    let rate = |[z, v]: [f64; 2], eta: f64| [v, omega * omega * (eta - z) - 2.0 * damping * omega * v];
    let mut state = [0.0, 0.0];
    let mut moved = vec![0.0];
    for of in eta.windows(3).step_by(2) {
        let on = |by: f64, k: [f64; 2]| [state[0] + by * k[0], state[1] + by * k[1]];
        let a = rate(state, of[0]);
        let b = rate(on(0.5 * dt, a), of[1]);
        let c = rate(on(0.5 * dt, b), of[1]);
        let d = rate(on(dt, c), of[2]);
        state = [0, 1].map(|i| state[i] + dt / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
        moved.push(state[0]);
    }
    moved
}

/// A finished run whose tables are those of the float in the sea; its pitch is 100 degrees a metre of heave.
fn run_of_a_sea(name: &str) -> Result<TestFolder> {
    let home = TestFolder::with_scene(&format!("rao-{name}"), SCENE);
    let out = home.join("run");
    let options = RunOptions { out: Some(out.clone()), threads: Some(1), ..RunOptions::default() };
    run::run(&home.join("scene.toml"), &options, &mut |_: &Progress| true)?;
    assert!(!out.join(run::RAO_FILE).exists(), "a run of no waves has no such file");
    let dt = 0.05;
    let eta = sea(dt);
    let mut gauge = String::from("t_s,level_m,eta_m\n");
    let mut buoy = String::from("t_s,x_m,y_m,surge_m,heave_m,pitch_deg,vx_mps,vy_mps,spin_radps\n");
    for (i, heave) in float(&eta, dt).into_iter().enumerate() {
        let (t, eta) = (i as f64 * dt, eta[2 * i]);
        gauge += &format!("{t:?},{:?},{eta:?}\n", 0.4 + eta);
        buoy += &format!("{t:?},3.0,0.4,0.0,{heave:?},{:?},0.0,0.0,0.0\n", 100.0 * heave);
    }
    fs::write(out.join("series/gauge.csv"), gauge).unwrap();
    fs::write(out.join("series/buoy.csv"), buoy).unwrap();
    Ok(home)
}

#[test]
fn a_float_in_an_irregular_sea_is_told_over_frequency_as_its_equation_says() -> Result<()> {
    let home = run_of_a_sea("all")?;
    let told = run::statistics(&home.join("run"), &StatisticsFilter::default())?;
    let of = |series: &str| -> Vec<RaoResult> { told.raos.iter().filter(|a| a.series == series).cloned().collect() };
    assert!(told.raos.iter().all(|answer| answer.name == "rao"), "a regular wave is told at its period alone");
    assert!(of("buoy.surge_m").is_empty(), "what does not move does not answer");
    let (heave, pitch) = (of("buoy.heave_m"), of("buoy.pitch_deg"));
    // Lines 1/95 Hz apart, from 0.34 to 1.1 Hz, where this sea has 2 % of its peak's density.
    assert!((60..80).contains(&heave.len()), "{} bands", heave.len());
    for answer in &heave {
        let (r, band) = (answer.point.frequency / OWN.0, answer.point);
        let (real, imaginary) = (1.0 - r * r, 2.0 * OWN.1 * r);
        // Quarters of 95 s hold a resonance 0.18 Hz wide to 3 % and 2 degrees; what came before 20 s is forgotten.
        assert!(answer.unit == "m/m" && band.coherence > 0.9, "{answer:?}");
        assert!((band.ratio * real.hypot(imaginary) - 1.0).abs() < 0.05, "{answer:?}");
        let off = (answer.phase_degrees() + imaginary.atan2(real).to_degrees()).rem_euclid(360.0);
        assert!(off.min(360.0 - off) < 5.0, "{answer:?}");
    }
    assert_eq!(pitch.len(), heave.len());
    // A multiple answers by the same multiple, but for round-off.
    assert!(heave.iter().zip(&pitch).all(|(h, p)| (p.point.ratio / (100.0 * h.point.ratio) - 1.0).abs() < 1e-9));
    assert_eq!(pitch[0].unit, "°/m");
    Ok(())
}

#[test]
fn of_too_few_waves_it_is_told_how_many_are_needed() -> Result<()> {
    let home = run_of_a_sea("few")?;
    let late = StatisticsFilter { from: Some(370.0), ..StatisticsFilter::default() };
    let told = run::statistics(&home.join("run"), &late)?;
    assert!(told.raos.is_empty(), "30 s hold some 17 waves of this sea");
    // That of a `period` asks for nothing over frequency.
    let [remark] = &told.remarks[..] else { panic!("{:?}", told.remarks) };
    assert!(remark.starts_with("statistic rao: ") && remark.contains("and 32 are needed"), "{remark}");
    Ok(())
}
