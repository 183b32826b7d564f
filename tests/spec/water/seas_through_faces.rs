//! Irregular waves that enter through a face on its current.

use std::f64::consts::TAU;

use pontoon::{
    error::Error,
    probe::{ElevationProbe, Probe},
    simulation::Simulation,
};

use crate::common;

/// A channel, 4 m long and 0.4 m deep, with a current of 0.5 m/s and these waves.
fn channel(wave: &str) -> Result<Simulation<2>, Error> {
    common::scene_simulation::<2>(&format!(
        r#"
        dimension = 2
        dp = 0.04
        until = 19.0
        inflow = [{{ x = 0.0, velocity = 0.5, wave = {{ {wave} }} }}]
        outflow = [{{ x = 4.0, velocity = 0.5, absorb_period = 1.3 }}]
        [[water]]
        fill = {{ box = {{ min = [0.0, 0.0], max = [4.0, 0.4] }} }}
        velocity = [0.5, 0.0]
        [[solid]]
        name = "bed"
        fixed = true
        shape = {{ box = {{ size = [8.0, 0.2] }} }}
        at = {{ x = 2.0, y = -0.1 }}
        "#
    ))
}

/// Significant height 4 √m₀ (m) and energy period m₋₁/m₀ (s) of a series of samples `dt` (s) apart, from its Fourier components
/// between half and three times the frequency of a wave of 1.3 s.
fn height_and_period(series: &[f64], dt: f64) -> [f64; 2] {
    let span = series.len() as f64 * dt;
    let mean = series.iter().sum::<f64>() / series.len() as f64;
    let [lowest, highest] = [0.5, 3.0].map(|times| (times * span / 1.3) as usize);
    let [mut energy, mut moment] = [0.0; 2];
    for j in lowest.max(1)..=highest {
        let omega = TAU * j as f64 / span;
        let at = |i: usize| omega * dt * i as f64;
        let [c, s] = [f64::cos, f64::sin]
            .map(|f| series.iter().enumerate().map(|(i, x)| (x - mean) * f(at(i))).sum::<f64>() / series.len() as f64);
        let own = 2.0 * (c * c + s * s);
        energy += own;
        moment += own * span / j as f64;
    }
    [4.0 * energy.sqrt(), moment / energy]
}

/// At a gauge 1.2 m behind the face the sea has the significant height and the energy period of linear theory with the same components
/// over the same ten peak periods, within 10 % and 3 %: the height is 1.5 dp, and linear theory leaves out that the waves steepen. The two
/// series rise and fall together, and no water passes the faces in the wrong sense.
#[test]
fn a_sea_enters_through_a_face_with_its_height_and_period() {
    let mut sim = channel("jonswap = { height = 0.06, peak_period = 1.3, seed = 4 }").expect("a sound scene");
    let gauge = ElevationProbe::new(sim.system(), &[1.2]).expect("a place in the water");
    let waves = sim.system().open_boundaries()[0].waves.clone().expect("waves");
    let dt = 0.05;
    let [mut measured, mut theory] = [Vec::new(), Vec::new()];
    common::run_to(&mut sim, 6.0).expect("a sound run");
    for i in 0..260 {
        let time = 6.0 + dt * f64::from(i);
        common::run_to(&mut sim, time).expect("a sound run");
        measured.push(gauge.sample(&sim)[1]);
        theory.push(waves.elevation(1.2, sim.time()));
    }
    let [height, period] = height_and_period(&measured, dt);
    let [expected_height, expected_period] = height_and_period(&theory, dt);
    assert!((height / expected_height - 1.0).abs() < 0.1, "{height} m of {expected_height} m");
    assert!((period / expected_period - 1.0).abs() < 0.03, "{period} s of {expected_period} s");
    let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64;
    let [a, b] = [mean(&measured), mean(&theory)];
    let product = |x: &[f64], y: &[f64], a: f64, b: f64| x.iter().zip(y).map(|(x, y)| (x - a) * (y - b)).sum::<f64>();
    let together = product(&measured, &theory, a, b)
        / (product(&measured, &measured, a, a) * product(&theory, &theory, b, b)).sqrt();
    assert!(together > 0.9, "the correlation is {together}");
    let [first, last] = [sim.system().face_exchange()[0], sim.system().face_exchange()[1]];
    assert_eq!(first.left + last.entered, 0, "water passed a face in the wrong sense");
}

#[test]
fn seas_that_cannot_enter_are_refused_with_their_key_and_a_remedy() {
    for (wave, key, said) in [
        ("ramp = 2.0", "inflow.0.wave", "which wave?"),
        (
            "regular = { height = 0.05, period = 1.3 }, jonswap = { height = 0.05, peak_period = 1.3 }",
            "inflow.0.wave",
            "one kind of wave",
        ),
        ("regular = { height = 0.05, period = 1.3, order = 2 }", "inflow.0.wave.regular.order", "theory of order 1"),
        ("jonswap = { height = 0.05 }", "inflow.0.wave.jonswap.peak_period", "peak_period is missing"),
        (
            "bretschneider = { height = 0.05, peak_period = 1.3, gamma = 2.0 }",
            "inflow.0.wave.bretschneider.gamma",
            "jonswap",
        ),
        ("jonswap = { height = 0.5, peak_period = 1.3 }", "inflow.0.wave", "breaks"),
        ("jonswap = { height = 0.15, peak_period = 1.3 }", "inflow.0.wave", "to and fro"),
        ("jonswap = { height = 0.05, peak_period = 1.3, components = 0 }", "inflow.0.wave", "1 to 2000 components"),
    ] {
        let error = channel(wave).err().expect(wave);
        let place = error.location.as_ref().map(|place| place.key.clone()).unwrap_or_default();
        let text = format!("{} {}", error.message, error.help.unwrap_or_default());
        assert!(place.starts_with(key) && text.contains(said), "{wave}: {place}: {text}");
    }
}
