//! Response amplitude operator of a float in an irregular sea, compared with its equation of motion.

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

/// Natural frequency of the float (Hz) and its damping ratio.
const OSCILLATOR: (f64, f64) = (0.6, 0.15);

/// A JONSWAP sea of 400 s with its peak at 0.5 Hz: elevations (m) at intervals of `dt`/2 (s).
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

/// Motion (m) of the float from rest in the sea `eta`: z̈ + 2ζω ż + ω² z = ω² η, by the Runge-Kutta method of fourth order.
fn response(eta: &[f64], dt: f64) -> Vec<f64> {
    let (omega, damping) = (TAU * OSCILLATOR.0, OSCILLATOR.1);
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

/// A finished run with the tables of the float in the sea. Its pitch is 100 degrees per metre of heave.
fn run_of_a_sea(name: &str) -> Result<TestFolder> {
    let home = TestFolder::with_scene(&format!("rao-{name}"), SCENE);
    let out = home.join("run");
    let options = RunOptions { out: Some(out.clone()), threads: Some(1), ..RunOptions::default() };
    run::run(&home.join("scene.toml"), &options, &mut |_: &Progress| true)?;
    assert!(!out.join(run::RAO_FILE).exists(), "a run without waves has no RAO file");
    let dt = 0.05;
    let eta = sea(dt);
    let mut gauge = String::from("t_s,level_m,eta_m\n");
    let mut buoy = String::from("t_s,x_m,y_m,surge_m,heave_m,pitch_deg,vx_mps,vy_mps,spin_radps\n");
    for (i, heave) in response(&eta, dt).into_iter().enumerate() {
        let (t, eta) = (i as f64 * dt, eta[2 * i]);
        gauge += &format!("{t:?},{:?},{eta:?}\n", 0.4 + eta);
        buoy += &format!("{t:?},3.0,0.4,0.0,{heave:?},{:?},0.0,0.0,0.0\n", 100.0 * heave);
    }
    fs::write(out.join("series/gauge.csv"), gauge).unwrap();
    fs::write(out.join("series/buoy.csv"), buoy).unwrap();
    Ok(home)
}

#[test]
fn the_rao_of_a_float_in_an_irregular_sea_agrees_with_its_equation_of_motion() -> Result<()> {
    let home = run_of_a_sea("all")?;
    let statistics = run::statistics(&home.join("run"), &StatisticsFilter::default())?;
    let of =
        |series: &str| -> Vec<RaoResult> { statistics.raos.iter().filter(|a| a.series == series).cloned().collect() };
    assert!(statistics.raos.iter().all(|rao| rao.name == "rao"), "a statistic with a period has no RAO over frequency");
    assert!(of("buoy.surge_m").is_empty(), "a series without motion has no RAO");
    let (heave, pitch) = (of("buoy.heave_m"), of("buoy.pitch_deg"));
    // Bands of 1/95 Hz from 0.34 to 1.1 Hz, where the density of this sea is 2 % of its peak.
    assert!((60..80).contains(&heave.len()), "{} bands", heave.len());
    for rao in &heave {
        let (r, band) = (rao.point.frequency / OSCILLATOR.0, rao.point);
        let (real, imaginary) = (1.0 - r * r, 2.0 * OSCILLATOR.1 * r);
        // Segments of 95 s resolve a resonance 0.18 Hz wide to 3 % and 2 degrees. The transient before 20 s is excluded.
        assert!(rao.unit == "m/m" && band.coherence > 0.9, "{rao:?}");
        assert!((band.ratio * real.hypot(imaginary) - 1.0).abs() < 0.05, "{rao:?}");
        let off = (rao.phase_degrees() + imaginary.atan2(real).to_degrees()).rem_euclid(360.0);
        assert!(off.min(360.0 - off) < 5.0, "{rao:?}");
    }
    assert_eq!(pitch.len(), heave.len());
    // Pitch is a multiple of heave, so its RAO is the same multiple up to round-off.
    assert!(heave.iter().zip(&pitch).all(|(h, p)| (p.point.ratio / (100.0 * h.point.ratio) - 1.0).abs() < 1e-9));
    assert_eq!(pitch[0].unit, "°/m");
    Ok(())
}

#[test]
fn a_record_with_too_few_waves_has_a_remark_with_the_required_number() -> Result<()> {
    let home = run_of_a_sea("few")?;
    let late = StatisticsFilter { from: Some(370.0), ..StatisticsFilter::default() };
    let statistics = run::statistics(&home.join("run"), &late)?;
    assert!(statistics.raos.is_empty(), "30 s contain about 17 waves of this sea");
    // The statistic with a `period` has no such remark.
    let [remark] = &statistics.remarks[..] else { panic!("{:?}", statistics.remarks) };
    assert!(remark.starts_with("statistic rao: ") && remark.contains("and 32 are needed"), "{remark}");
    Ok(())
}
