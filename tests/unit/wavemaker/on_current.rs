use std::f64::consts::TAU;

use super::*;
use crate::wavemaker::wave_number;

#[test]
fn the_wave_number_solves_the_doppler_shifted_dispersion_relation() {
    for (period, depth, current) in
        [(1.0, 0.5, 0.0), (1.0, 0.5, 0.3), (1.5, 0.4, -0.2), (3.0, 0.5, 1.0), (0.8, 5.0, -0.2)]
    {
        let omega = TAU / period;
        let k = relative_wave_number(omega, depth, current, 9.81).expect("a wave");
        let sigma = (9.81 * k * (k * depth).tanh()).sqrt();
        assert!((k * current + sigma - omega).abs() < 1e-9 * omega, "{period} s on {current} m/s");
    }
    let still = relative_wave_number(TAU, 0.5, 0.0, 9.81).expect("a wave");
    assert!((still - wave_number(TAU, 0.5, 9.81)).abs() < 1e-9 * still);
}

#[test]
fn a_wave_is_longer_on_a_following_current_and_an_opposing_one_stops_it_at_a_quarter_of_its_speed() {
    let length = |current: f64| TAU / relative_wave_number(TAU, 50.0, current, 9.81).expect("a wave");
    assert!(length(0.3) > length(0.0) && length(0.0) > length(-0.3));
    // In deep water c = g T/(2 π) = 1.561 m/s.
    let speed = 9.81 / TAU;
    assert!(relative_wave_number(TAU, 50.0, -0.249 * speed, 9.81).is_some());
    assert!(relative_wave_number(TAU, 50.0, -0.251 * speed, 9.81).is_none());
    let error = WaveOnCurrent::new(0.1, 1.0, (50.0, -1.0, 9.81), 1.0).expect_err("stopped");
    assert!(error.help.expect("a remedy").contains("period"));
}

#[test]
fn the_surface_follows_the_wave_and_the_bed_is_impermeable() {
    let wave = WaveOnCurrent::new(0.1, 1.2, (0.5, 0.2, 9.81), 1.0).expect("a wave");
    let (t, dt, s) = (3.0, 1e-6, 0.7);
    assert_eq!(wave.motion(s, 0.0, t).up, 0.0);
    let top = |t: f64, s: f64| wave.motion(s, 0.5, t);
    // The kinematic condition on the current: w = ∂η/∂t + U ∂η/∂s.
    let rate = (top(t + dt, s).rise - top(t - dt, s).rise) / (2.0 * dt);
    let slope = (top(t, s + dt).rise - top(t, s - dt).rise) / (2.0 * dt);
    assert!((top(t, s).up - rate - 0.2 * slope).abs() < 1e-7);
    // The dynamic condition: p = ρ g η at the still level.
    assert!((top(t, s).pressure - 9.81 * top(t, s).rise).abs() < 1e-12);
    // p = ρ c u at every height.
    let middle = wave.motion(s, 0.2, t);
    assert!((middle.pressure - wave.relative_speed() * middle.along).abs() < 1e-12);
}
