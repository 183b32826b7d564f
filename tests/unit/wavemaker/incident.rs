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

/// The numbers that the message proposes do: the greatest current, and the shortest period; a tenth more or less does not.
#[test]
fn a_current_that_stops_waves_is_refused_with_the_numbers_that_would_do() {
    let (height, depth) = (0.001, 0.5);
    let wave = |period: f64, current: f64| IncidentWaves::regular(height, period, 0.0, depth, current, G, 0.0);
    let error = wave(1.2, -0.6).expect_err("the current is too fast");
    let help = error.help.expect("a remedy");
    let numbers: Vec<f64> = help.split(' ').filter_map(|word| word.parse().ok()).collect();
    let [current, period] = numbers[..] else { panic!("{help}") };
    assert!(wave(1.2, -current).is_ok() && wave(1.2, -1.1 * current).is_err(), "{help}");
    assert!(wave(period, -0.6).is_ok() && wave(0.9 * period, -0.6).is_err(), "{help}");
    // A wave of this height breaks; the highest of its period does not, nor the shortest of its height.
    let help =
        IncidentWaves::regular(0.33, 0.7, 0.0, depth, 1.5, G, 0.0).expect_err("it breaks").help.expect("a remedy");
    let numbers: Vec<f64> = help.split(' ').filter_map(|word| word.parse().ok()).collect();
    let [highest, shortest] = numbers[..] else { panic!("{help}") };
    let wave = |height: f64, period: f64| IncidentWaves::regular(height, period, 0.0, depth, 1.5, G, 0.0);
    assert!(wave(highest - 1e-3, 0.7).is_ok() && wave(highest + 1e-3, 0.7).is_err(), "{help}");
    assert!(wave(0.33, shortest).is_ok() && wave(0.33, 0.9 * shortest).is_err(), "{help}");
    let wave = |period: f64, current: f64| IncidentWaves::regular(height, period, 0.0, depth, current, G, 0.0);
    // Faster than any wave in this depth.
    let help = wave(1.2, -3.0).expect_err("the current is too fast").help.expect("a remedy");
    assert!(help.contains("against this one no wave moves"), "{help}");
}

/// The surface of a sea has the significant height that was asked for, a particle is found again from its place in the waves, and none
/// moves faster or further than the sea says of itself.
#[test]
fn a_sea_has_its_height_and_keeps_its_particles() {
    let water = WaterAtFace { depth: 0.5, current: 0.6, g: G, ramp: Some(2.0), until: 300.0 };
    let spectrum = WaveSpectrum::jonswap(1.3, 3.3);
    let waves = IncidentWaves::irregular(0.05, &spectrum, (7, 40), &water).expect("a sea");
    let times = (0..5800).map(|i| 10.0 + 0.05 * f64::from(i));
    let square = times.clone().map(|t| waves.elevation(0.3, t).powi(2)).sum::<f64>() / 5800.0;
    // 220 waves; m₀ of so many scatters by 1/√220 or so, and the height by half of that.
    assert!((4.0 * square.sqrt() / 0.05 - 1.0).abs() < 0.04, "{} m", 4.0 * square.sqrt());
    for t in times.step_by(7) {
        for z in [0.0, -0.1, -0.5] {
            let rest = [0.3 - 0.6 * 0.1, z];
            let now = waves.orbit_of(rest, t);
            assert!(now.displacement[0].abs() < waves.excursion());
            assert!(now.velocity[0].hypot(now.velocity[1]) < waves.orbital_speed());
            let (again, height) = waves.orbit(rest[0] + now.displacement[0], z + now.displacement[1], t);
            // Near the crests the iteration converges with the slope of the surface.
            assert!((height - z).abs() < 1e-4 && (again.head - now.head).abs() < 1e-4, "{height} m for {z} m at {t} s");
        }
    }
    // The current stops the shortest component, of 0.41 times the peak period.
    let against = WaterAtFace { current: -0.4, ..water };
    let error = IncidentWaves::irregular(0.05, &spectrum, (7, 40), &against).expect_err("they are stopped");
    assert!(error.message.contains("the sea has components of 0.5"), "{}", error.message);
    assert!(error.help.as_deref().unwrap_or_default().contains("the peak period is"), "{:?}", error.help);
}

/// Against a current a sea enters without the short components that the current stops, as high as with them; waves of a table are the
/// user's own, and refused.
#[test]
fn a_sea_against_a_current_lacks_the_components_that_are_stopped() {
    let with = WaterAtFace { depth: 0.5, current: 0.3, g: G, ramp: Some(2.0), until: 30.0 };
    let against = WaterAtFace { current: -0.3, ..with };
    let sea = |water: &WaterAtFace| IncidentWaves::irregular(0.03, &WaveSpectrum::jonswap(1.3, 3.3), (7, 40), water);
    let [all, left] = [sea(&with), sea(&against)].map(|waves| waves.expect("a sea"));
    let energy =
        |waves: &IncidentWaves| waves.trains.iter().map(|train| train.component.amplitude.powi(2)).sum::<f64>();
    assert!(all.component_count() == 40 && (30..40).contains(&left.component_count()), "{}", left.component_count());
    assert!((energy(&left) / energy(&all) - 1.0).abs() < 1e-12);
    // Less than the part above which a sea is refused.
    assert!(all.left_out() == 0.0 && (0.001..0.15).contains(&left.left_out()), "{}", left.left_out());
    // A current a tenth faster stops none of them: in deep water it would stop those above g/(4 U).
    let shortest = left.trains.iter().map(|train| train.component.omega).fold(0.0, f64::max);
    assert!(shortest < G / (4.0 * 1.1 * 0.3), "{shortest} rad/s");
    let table = [WaveComponent { amplitude: 0.001, omega: 10.0, phase: 0.0 }];
    assert!(IncidentWaves::components(&table, &against).is_err());
}

/// The components of a table have their phases at the face: η = Σ a cos(ω t + φ) there, and none moves the water as a paddle would not.
#[test]
fn components_make_their_surface_at_the_face() {
    let water = WaterAtFace { depth: 0.5, current: 0.5, g: G, ramp: Some(0.0), until: 20.0 };
    let components = [(0.004, 4.0, 0.3), (0.002, 6.5, -1.2)];
    let components = components.map(|(amplitude, omega, phase)| WaveComponent { amplitude, omega, phase });
    let waves = IncidentWaves::components(&components, &water).expect("two waves");
    for t in [0.0, 1.7, 5.2] {
        let eta: f64 = components.iter().map(|c| c.amplitude * (c.omega * t + c.phase).cos()).sum();
        // Of second order: k a² is 1e-4 m at most.
        assert!((waves.elevation(0.0, t) - eta).abs() < 1e-4, "{} m for {eta} m at {t} s", waves.elevation(0.0, t));
    }
    let (height, omega, _) = waves.main_train();
    let m0 = 0.5 * (0.004f64.powi(2) + 0.002f64.powi(2));
    assert!((height - 4.0 * m0.sqrt()).abs() < 1e-12 && omega == 4.0);
    assert!(IncidentWaves::components(&[], &water).is_err());
}
