use super::*;
use crate::wavemaker::wave_number;

const G: f64 = 9.81;

/// ω = k U + √(g k tanh kd), with the current and against it; without one it is the wave number of water at rest. In deep water k has a
/// closed form, and no wave moves against a current above a quarter of its phase speed @peregrine1976.
#[test]
fn wave_numbers_on_a_current_are_those_of_theory() {
    let omega = 5.0;
    for current in [-0.2, 0.0, 0.3] {
        let k = wave_number_on_current(omega, 0.4, current, G).expect("a wave");
        let back = k * current + (G * k * (k * 0.4).tanh()).sqrt();
        assert!((back / omega - 1.0).abs() < 1e-12, "{back} rad/s at {current} m/s");
    }
    let still = wave_number_on_current(omega, 0.4, 0.0, G).expect("a wave");
    assert!((still / wave_number(omega, 0.4, G) - 1.0).abs() < 1e-12);
    let celerity = G / omega;
    let (below, above) = (-0.2499 * celerity, -0.2501 * celerity);
    assert!(wave_number_on_current(omega, 50.0, below, G).is_some());
    assert!(wave_number_on_current(omega, 50.0, above, G).is_none());
}

/// The velocity is the rate of the displacement along a particle that drifts with the current, the pressure of the surface is zero to
/// first order, and the place without waves is found again from the place in them.
#[test]
fn orbits_keep_their_particles() {
    let waves = IncidentWaves::regular(0.03, 1.2, 0.4, 0.5, 0.3, G, 2.0).expect("a wave");
    let dt = 1e-5;
    for (t, z) in [(0.7, 0.0), (1.9, -0.2), (5.3, -0.5)] {
        let at = |t: f64| waves.orbit_of([0.1 + 0.3 * t, z], t);
        let [before, now, after] = [t - dt, t, t + dt].map(at);
        for k in 0..2 {
            let rate = (after.displacement[k] - before.displacement[k]) / (2.0 * dt);
            assert!((rate - now.velocity[k]).abs() < 1e-7, "{rate} for {} m/s", now.velocity[k]);
        }
        let x = [0.1 + 0.3 * t + now.displacement[0], z + now.displacement[1]];
        let (again, rest) = waves.orbit(x[0], x[1], t);
        assert!((rest - z).abs() < 1e-6, "{rest} m for {z} m");
        assert!((again.head - now.head).abs() < 1e-6);
        if z == 0.0 {
            assert!((now.head - now.displacement[1]).abs() < 1e-12, "pressure at the surface");
        }
        if z == -0.5 {
            assert_eq!(now.displacement[1], 0.0, "the bed is level");
        }
    }
}

/// Waves that break, that the current stops, and that move water through the face to and fro are refused.
#[test]
fn waves_that_cannot_enter_are_refused() {
    let wave = |height: f64, current: f64| IncidentWaves::regular(height, 1.2, 0.0, 0.5, current, G, 0.0);
    assert!(wave(0.03, 0.3).is_ok());
    for (height, current, word) in
        [(0.5, 3.0, "breaks"), (0.03, -0.6, "no wave"), (0.03, 0.05, "to and fro"), (-1.0, 0.3, "high")]
    {
        let error = wave(height, current).expect_err(word);
        assert!(error.message.contains(word), "{}", error.message);
    }
}
