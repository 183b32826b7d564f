//! Wavemaker theory compared with textbook limits.

use std::f64::consts::{PI, TAU};

use super::*;

pub(super) const G: f64 = 9.81;

pub(super) fn maker(depth: f64, paddle: Paddle) -> Wavemaker {
    Wavemaker { depth, g: G, paddle }
}

/// All kinds of waves in 0.4 m of water.
pub(super) fn all() -> Vec<(&'static str, PaddleMotion)> {
    let piston = maker(0.4, Paddle::Piston);
    let flap = maker(0.4, Paddle::Flap { arm: 0.3 });
    let sea = WaveSpectrum::jonswap(1.4, 3.3);
    let times: Vec<f64> = (0..400).map(|i| 0.05 * i as f64).collect();
    let eta: Vec<f64> = times.iter().map(|t| 0.02 * (TAU * t / 1.3).sin() + 0.01 * (TAU * t / 0.9).cos()).collect();
    vec![
        ("regular", piston.regular(0.08, 1.2, 0.4, 1).unwrap()),
        ("second order", piston.regular(0.08, 1.2, 0.4, 2).unwrap()),
        ("flap", flap.regular(0.08, 1.2, 0.4, 2).unwrap()),
        ("sea", flap.irregular(0.05, &sea, 7, 100).unwrap()),
        ("focused", piston.focused(0.05, &sea, 4.0, 10.0, 100).unwrap()),
        ("recorded", piston.measured(&TimeSeries::new(times, eta).unwrap(), 1.0, 2.0).unwrap()),
        ("boussinesq", piston.solitary(0.1, SolitaryTheory::Boussinesq).unwrap()),
        ("rayleigh", piston.solitary(0.1, SolitaryTheory::Rayleigh).unwrap()),
    ]
}

#[test]
fn the_dispersion_relation_holds_to_round_off() {
    for depth in [0.05, 0.4, 3.0, 100.0] {
        for period in [0.3, 1.0, 4.0, 30.0, 300.0] {
            let train = LinearWave::new(TAU / period, depth, G);
            let omega2 = G * train.k * train.kd().tanh();
            assert!((omega2 / train.omega.powi(2) - 1.0).abs() < 1e-12, "d = {depth}, T = {period}");
        }
    }
    // Phase and group velocity are √(gd) in shallow water, and g/ω and half of it in deep water.
    let (long, deep) = (LinearWave::new(1e-3, 1.0, G), LinearWave::new(10.0, 10.0, G));
    assert!(
        (long.celerity() / G.sqrt() - 1.0).abs() < 1e-6 && (long.group_velocity() / long.celerity() - 1.0).abs() < 1e-6
    );
    assert!(
        (deep.celerity() / 0.981 - 1.0).abs() < 1e-9 && (deep.group_velocity() / deep.celerity() - 0.5).abs() < 1e-9
    );
    assert_eq!((long.depth_regime(), deep.depth_regime()), (DepthRegime::Shallow, DepthRegime::Deep));
}

#[test]
fn evanescent_wave_numbers_satisfy_the_dispersion_relation_of_the_paddle() {
    for (j, kappa) in train::evanescent_wave_numbers(5.0, 0.4, G, 100).into_iter().enumerate() {
        let kd = 0.4 * kappa;
        assert!((25.0 + G * kappa * kd.tan()).abs() < 1e-9 * G * kappa * (1.0 + kd.tan().powi(2)), "{j}");
        assert!((j as f64 + 0.5) * PI < kd && kd < (j as f64 + 1.0) * PI, "{j}");
    }
}

#[test]
fn transfer_functions_have_the_textbook_limits() {
    let train = |kd: f64| LinearWave { depth: 1.0, g: G, omega: (G * kd * kd.tanh()).sqrt(), k: kd };
    let (piston, flap) = (Paddle::Piston, Paddle::Flap { arm: 1.0 });
    // H/S = kd and kd/2; the next term is of (kd)², relative.
    assert!((piston.transfer_function(&train(0.01)) / 0.01 - 1.0).abs() < 1e-3);
    assert!((flap.transfer_function(&train(0.01)) / 0.005 - 1.0).abs() < 1e-3);
    // 2 and 2 (1 − 1/kd) in deep water.
    assert!(
        (piston.transfer_function(&train(20.0)) - 2.0).abs() < 1e-9
            && (flap.transfer_function(&train(20.0)) - 1.9).abs() < 1e-9
    );
    for kd in [0.3_f64, 1.0, 3.0] {
        let exact = 2.0 * ((2.0 * kd).cosh() - 1.0) / ((2.0 * kd).sinh() + 2.0 * kd);
        assert!((piston.transfer_function(&train(kd)) / exact - 1.0).abs() < 1e-12);
        let exact = 4.0 * (kd.sinh() / kd) * (kd * kd.sinh() - kd.cosh() + 1.0) / ((2.0 * kd).sinh() + 2.0 * kd);
        assert!((flap.transfer_function(&train(kd)) / exact - 1.0).abs() < 1e-12);
        // A flap with a very deep hinge equals a piston. A higher hinge moves less water.
        assert!(
            (Paddle::Flap { arm: 1e6 }.transfer_function(&train(kd)) / piston.transfer_function(&train(kd)) - 1.0)
                .abs()
                < 1e-5
        );
        let all = [2.0, 1.0, 0.5, 0.2].map(|arm| Paddle::Flap { arm }.transfer_function(&train(kd)));
        assert!(all.is_sorted_by(|a, b| a > b), "{all:?}");
    }
    // The function is continuous beyond the range of the hyperbolic functions.
    let edge = [299.0, 301.0].map(|kd| flap.transfer_function(&train(kd)));
    assert!((edge[0] / edge[1] - 1.0).abs() < 1e-4, "{edge:?}");
}

#[test]
fn the_second_order_of_a_piston_agrees_with_madsen_in_shallow_water() {
    // Madsen omits the evanescent waves at the paddle, a relative (kd)².
    for (kd, close) in [(0.2, 0.003), (0.3, 0.006), (0.5, 0.05)] {
        let k = kd / 0.4;
        let train = LinearWave { depth: 0.4, g: G, omega: (G * k * f64::tanh(kd)).sqrt(), k };
        let (c, a) = (Paddle::Piston.transfer_function(&train), 0.01);
        let height = 2.0 * c * a;
        let madsen = height * height / (32.0 * 0.4) * (3.0 * f64::cosh(kd) / f64::sinh(kd).powi(3) - 2.0 / c);
        let ours = second_order::correction(&Paddle::Piston, &train, a);
        assert!((ours.norm() / madsen - 1.0).abs() < close, "kd = {kd}: {} against {madsen}", ours.norm());
        // Madsen has sin 2ωt for a sin ωt; this code has a cosine, a quarter of a period earlier.
        assert!((ours.arg() - 0.5 * PI).abs() < 0.01, "{}", ours.arg());
        // The correction is quadratic, and a flap with a very deep hinge equals a piston.
        let double = second_order::correction(&Paddle::Piston, &train, 2.0 * a);
        let far = second_order::correction(&Paddle::Flap { arm: 1e6 }, &train, a);
        assert!((double / ours - 4.0).norm() < 1e-9 && (far / ours - 1.0).norm() < 1e-4);
    }
}

#[test]
fn a_paddle_starts_at_rest_at_its_initial_position() {
    for (name, wave) in all() {
        assert_eq!(wave.coordinate_and_rate(0.0), (0.0, 0.0), "{name}");
        // The rate grows at least with the square of the time: after a hundredth of the ramp it is below 3e-3 of its
        // maximum.
        let fastest = (0..4000).map(|i| wave.coordinate_and_rate(0.01 * f64::from(i)).1.abs()).fold(0.0, f64::max);
        assert!(wave.coordinate_and_rate(0.01 * wave.ramp_time()).1.abs() < 3e-3 * fastest, "{name}");
    }
}

#[test]
fn the_rate_of_a_paddle_is_the_derivative_of_its_coordinate() {
    for (name, wave) in all() {
        let fastest = (0..4000).map(|i| wave.coordinate_and_rate(0.01 * f64::from(i)).1.abs()).fold(0.0, f64::max);
        for t in [0.05, 0.3, 0.7, 1.9, 3.3, 9.8, 19.0, 20.7] {
            let step = 1e-5;
            let difference =
                (wave.coordinate_and_rate(t + step).0 - wave.coordinate_and_rate(t - step).0) / (2.0 * step);
            // Truncation step² x‴/6, about 1e-8 of the speed at 60 rad/s; round-off 1e-16/step.
            assert!((difference - wave.coordinate_and_rate(t).1).abs() < 1e-7 * fastest + 1e-10, "{name} at {t}");
        }
    }
}

#[test]
fn an_irregular_sea_has_the_requested_height_and_peak_period() {
    for spectrum in [WaveSpectrum::jonswap(1.4, 3.3), WaveSpectrum::bretschneider(1.4)] {
        let wave = maker(5.0, Paddle::Piston).irregular(0.1, &spectrum, 3, 1000).unwrap();
        let Course::Tones(tones) = &wave.course else { panic!("a sea is a sum") };
        let surface = |tone: &WaveComponent| {
            tone.amplitude * Paddle::Piston.transfer_function(&LinearWave::new(tone.omega, 5.0, G))
        };
        let m0: f64 = tones.iter().map(|tone| 0.5 * surface(tone).powi(2)).sum();
        assert!((4.0 * m0.sqrt() / 0.1 - 1.0).abs() < 1e-12);
        // Components of equal energy are densest at the peak, to the width of twenty of them.
        let spans: Vec<(f64, f64)> =
            tones.windows(21).map(|w| (w[20].omega - w[0].omega, 0.5 * (w[20].omega + w[0].omega))).collect();
        let closest = spans.iter().min_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
        assert!((closest.1 * 1.4 / TAU - 1.0).abs() < 0.02, "{}", closest.1);
        // The energy below f agrees with the integral of the spectrum.
        let below = |x: f64| tones.iter().filter(|tone| tone.omega < x * TAU / 1.4).count() as f64 / 1000.0;
        let sum = |to: f64| {
            (0..10_000)
                .map(|i| spectrum.density(0.5 + (to - 0.5) * (f64::from(i) + 0.5) / 1e4) * (to - 0.5))
                .sum::<f64>()
        };
        for x in [0.9, 1.0, 1.2, 2.0] {
            assert!((below(x) - sum(x) / sum(3.0)).abs() < 2e-3, "{x}");
        }
    }
    // 0.0081 g²/5ω_p⁴ = (H/4)²: T_p = 5.0 √H.
    let grown = WaveSpectrum::pierson_moskowitz(4.0, G);
    assert!((grown.peak_period - 10.0).abs() < 0.02, "{}", grown.peak_period);
}

#[test]
fn a_seed_determines_the_bits_of_a_sea() {
    let sea =
        |seed: u64| maker(0.4, Paddle::Piston).irregular(0.05, &WaveSpectrum::jonswap(1.4, 3.3), seed, 100).unwrap();
    let course = |wave: PaddleMotion| {
        (0..100).map(|i| wave.coordinate_and_rate(0.37 * f64::from(i)).0.to_bits()).collect::<Vec<u64>>()
    };
    assert_eq!(course(sea(5)), course(sea(5)));
    assert_ne!(course(sea(5)), course(sea(6)));
}

#[test]
fn a_focused_group_has_its_crest_at_the_focus() {
    let wave =
        maker(0.4, Paddle::Flap { arm: 0.5 }).focused(0.05, &WaveSpectrum::jonswap(1.4, 3.3), 4.0, 12.0, 80).unwrap();
    let at = |x: f64, t: f64| wave.elevation(x, t).unwrap();
    assert!((at(4.0, 12.0) - 0.05).abs() < 1e-12);
    // The elevation is lower at all other positions and times within some wavelengths and periods.
    for (x, t) in [(3.5, 12.0), (4.5, 12.0), (4.0, 11.5), (4.0, 12.5), (2.0, 11.0), (6.0, 13.5)] {
        assert!(at(x, t).abs() < 0.045, "{x} {t}");
    }
}

#[test]
fn the_stroke_of_a_solitary_wave_displaces_the_volume_of_the_wave() {
    let (h, d) = (0.1, 0.4);
    let wave = maker(d, Paddle::Piston).solitary(h, SolitaryTheory::Boussinesq).unwrap();
    let own = wave.properties().solitary.unwrap();
    // S = √(16 H d/3), Goring; the omitted tails are e^−10 of it.
    assert!((own.stroke() / (16.0 * h * d / 3.0_f64).sqrt() - 1.0).abs() < 1e-12);
    assert!((wave.coordinate_and_rate(30.0).0 / own.stroke() - 1.0).abs() < 1e-4);
    // The displaced volume is that of the wave: ∫η dx = 2H/κ = S d.
    assert!((2.0 * h / own.kappa / d / own.stroke() - 1.0).abs() < 1e-12);
    // The largest speed is that of the water under the crest, cH/(d + H).
    let fastest = (0..100_000).map(|i| wave.coordinate_and_rate(1e-4 * f64::from(i)).1).fold(0.0, f64::max);
    assert!((fastest / (own.celerity * h / (d + h)) - 1.0).abs() < 1e-6, "{fastest}");
}

#[test]
fn a_wave_from_a_record_reproduces_the_recorded_elevation() {
    let maker = maker(0.4, Paddle::Piston);
    let eta = |t: f64| 0.02 * (TAU * t / 1.25 + 0.3).sin() + 0.01 * (TAU * t / 0.8).cos();
    let times: Vec<f64> = (0..=1000).map(|i| 2.0 + 0.02 * f64::from(i)).collect();
    let values: Vec<f64> = times.iter().map(|t| eta(*t)).collect();
    let wave = maker.measured(&TimeSeries::new(times, values).unwrap(), 1.5, 3.0).unwrap();
    for t in [4.0, 7.3, 11.1, 19.0] {
        let reproduced = wave.elevation(1.5, t + 3.0).unwrap();
        // The record contains whole periods of both components: the error is round-off and the half per cent at either end.
        assert!((reproduced - eta(t)).abs() < 1e-4, "{t}: {reproduced} against {}", eta(t));
    }
    assert_eq!(wave.coordinate_and_rate(25.1), (0.0, 0.0), "the record ends at 22 s and has a delay of 3 s");
}

/// Of 3000 s, the first 2000 frequencies end at 0.67 Hz.
#[test]
fn a_wave_from_a_long_record_keeps_its_short_waves_or_is_refused() {
    let maker = maker(0.4, Paddle::Piston);
    let record = |eta: &dyn Fn(f64) -> f64| {
        let times: Vec<f64> = (0..=15_000).map(|i| 0.2 * f64::from(i)).collect();
        let values: Vec<f64> = times.iter().map(|t| eta(*t)).collect();
        maker.measured(&TimeSeries::new(times, values).unwrap(), 0.0, 0.0)
    };
    let eta = |t: f64| 0.02 * (TAU * t / 1.25 + 0.3).sin() + 0.01 * (TAU * t / 0.8).cos();
    let wave = record(&eta).unwrap();
    for t in [4.0, 700.2, 1500.8, 2900.0] {
        let reproduced = wave.elevation(0.0, t).unwrap();
        assert!((reproduced - eta(t)).abs() < 1e-4, "{t}: {reproduced} against {}", eta(t));
    }
    // A sweep from 0.2 Hz to 1.8 Hz has 4800 frequencies.
    let sweep = |t: f64| 0.02 * (TAU * t * (0.2 + 1.6 * t / 6000.0)).sin();
    let message = record(&sweep).unwrap_err().to_string();
    assert!(
        message.contains("3000 s have more than 2000 frequencies") && message.contains("keep the part"),
        "{message}"
    );
}

#[test]
fn breaking_and_invalid_waves_are_refused_with_the_possible_height() {
    let piston = maker(0.4, Paddle::Piston);
    let message = |wave: Result<PaddleMotion>| wave.unwrap_err().to_string();
    // 0.142 L tanh kd is below 0.78 d here.
    let most = LinearWave::new(TAU / 1.2, 0.4, G).breaking_height();
    let breaking = message(piston.regular(0.4, 1.2, 0.0, 1));
    let told = (most * 1e3).floor() / 1e3;
    assert!(breaking.contains("breaks") && breaking.contains(&format!("{told} m")), "{breaking}");
    assert!(message(piston.solitary(0.35, SolitaryTheory::Rayleigh)).contains("0.312 m"));
    assert!(message(maker(0.4, Paddle::Flap { arm: 0.4 }).solitary(0.1, SolitaryTheory::Rayleigh)).contains("piston"));
    assert!(message(piston.regular(0.05, 1.2, 0.0, 3)).contains("order"));
    assert!(message(piston.regular(0.05, -1.0, 0.0, 1)).contains("period"));
    assert!(message(piston.irregular(0.05, &WaveSpectrum::jonswap(1.4, 3.3), 1, 0)).contains("components"));
}

#[test]
fn theory_regions_follow_height_and_depth() {
    let region = |d: f64, t: f64, h: f64| LinearWave::new(TAU / t, d, G).theory_region(h);
    // In deep water H/gT² = 0.001 separates Airy from Stokes, and a quarter of breaking separates second from higher order.
    assert_eq!(region(10.0, 1.0, 0.009), TheoryRegion::Airy);
    assert_eq!(region(10.0, 1.0, 0.02), TheoryRegion::Stokes2);
    assert_eq!(region(10.0, 1.0, 0.1), TheoryRegion::Stokes5);
    assert_eq!(region(10.0, 1.0, 0.25), TheoryRegion::Breaking);
    assert_eq!(region(0.3, 3.0, 0.1), TheoryRegion::Cnoidal);
    assert_eq!(region(0.3, 3.0, 0.3), TheoryRegion::Breaking);
}
