//! Absorbing paddles compared with linear theory.

use std::f64::consts::TAU;

use super::{
    super::{
        WaveSpectrum,
        tests::{G, all, maker},
    },
    *,
};
use crate::math::time_series::TimeSeries;

/// A paddle in 0.4 m of water without a wave of its own that absorbs waves of `period` (s), with its gauge at least 0.04 m before it.
fn absorber(paddle: Paddle, period: f64) -> Absorber {
    let maker = maker(0.4, paddle);
    let tuning =
        AbsorptionSettings { period: None, gauge_distance: 0.04, water_level: 0.4, max_stroke: None, max_speed: None };
    Absorber::new(&maker, &maker.at_rest(period).unwrap(), &tuning).unwrap()
}

#[test]
fn an_absorbing_paddle_reflects_nothing_at_its_period_and_little_near_it() {
    let flap = |arm: f64| Paddle::Flap { arm };
    for paddle in [Paddle::Piston, flap(0.6), flap(0.4), flap(0.3)] {
        for period in [0.9, 1.2, 2.0, 4.0] {
            let absorber = absorber(paddle, period);
            let back = |share: f64| absorber.reflection_coefficient(share * period);
            assert!(back(1.0) < 1e-9, "{paddle:?} {period}: {}", back(1.0));
            // A fixed wall reflects all. Dispersion, evanescent waves and the distance to the gauge cause the remainder.
            assert!(back(1.5) < 0.15 && back(0.67) < 0.35, "{paddle:?} {period}: {} {}", back(1.5), back(0.67));
            // The return to the rest position limits the absorption of long waves, but never amplifies them.
            assert!((1..40).all(|i| back(f64::from(i)) <= 1.0), "{paddle:?} {period}");
        }
    }
    // In shallow water x′ = −√(g/d) e for every period.
    let gain = absorber(Paddle::Piston, 8.0).gain;
    assert!((gain / (G / 0.4_f64).sqrt() - 1.0).abs() < 0.01, "{gain}");
}

#[test]
fn an_absorbing_paddle_follows_its_law_within_its_limits_and_returns_to_rest() {
    let (period, amplitude, step) = (1.2, 0.01, 1e-3);
    let (absorber, silent) = (absorber(Paddle::Piston, period), maker(0.4, Paddle::Piston).at_rest(period).unwrap());
    let run = |amplitude: f64, until: f64| {
        let level = |t: f64| if t < 60.0 { 0.4 + amplitude * (TAU * t / period).sin() } else { 0.4 };
        let (mut now, mut most) = (AbsorptionState::default(), (0.0_f64, 0.0_f64));
        for i in 0..(until / step) as usize {
            let t = i as f64 * step;
            now = absorber.update(&silent, &now, t, Some(level(t)));
            if t > 50.0 {
                most = (most.0.max(now.offset_and_rate(t).0.abs()), most.1.max(now.offset_and_rate(t).1.abs()));
            }
        }
        (most, now.offset_and_rate(until).0)
    };
    // T x″ + x′ + x/τ = −F e.
    let omega = TAU / period;
    let size = absorber.gain * amplitude / (omega * omega * absorber.lag - 1.0 / absorber.home).hypot(omega);
    let ((far, _), _) = run(amplitude, 60.0);
    assert!((far / size - 1.0).abs() < 0.01, "{far} against {size}; the step is a hundredth of the lag T");
    // Thirty times the amplitude exceeds the limits: stroke and speed stay within them, and e^−4 of the stroke is left at the end.
    let ((far, fast), left) = run(30.0 * amplitude, 60.0 + 4.0 * absorber.home);
    let (stroke, speed) = absorber.motion_limits();
    assert!(far <= 0.5 * stroke * 1.001 && fast <= speed * 1.001, "{far} {fast} of {stroke} {speed}");
    assert!(left.abs() < 0.02 * 0.5 * stroke, "{left}");
    // Without water at the gauge the paddle does not move.
    let dry = absorber.update(&silent, &AbsorptionState::default(), 1.0, None);
    assert_eq!(dry.offset_and_rate(2.0), (0.0, 0.0));
}

#[test]
fn an_absorbing_paddle_does_not_react_to_its_own_wave() {
    for (name, wave) in all() {
        let maker = maker(0.4, wave.paddle());
        let tuning = AbsorptionSettings {
            period: None,
            gauge_distance: 0.04,
            water_level: 0.4,
            max_stroke: None,
            max_speed: None,
        };
        let own = Absorber::new(&maker, &wave, &tuning).unwrap();
        let mut now = AbsorptionState::default();
        for i in 0..4000 {
            let t = 2e-3 * f64::from(i);
            let place = wave.displacement(t).0 + now.offset_and_rate(t).0;
            now = own.update(&wave, &now, t, Some(0.4 + own.wanted(&wave, place + own.gauge_distance, t)));
            assert!(now.offset_and_rate(t).0.abs() < 1e-12, "{name} at {t}");
        }
    }
    // Far from the evanescent waves the expected elevation is that of the wave: η of linear theory, at x = 3 d.
    let wave = maker(0.4, Paddle::Piston).regular(0.02, 1.2, 0.4, 1).unwrap();
    let tuning =
        AbsorptionSettings { period: None, gauge_distance: 0.04, water_level: 0.4, max_stroke: None, max_speed: None };
    let mut own = Absorber::new(&maker(0.4, Paddle::Piston), &wave, &tuning).unwrap();
    own.own[0].staying = 0.0;
    assert!((own.wanted(&wave, 1.2, 7.0) - wave.elevation(1.2, 7.0).unwrap()).abs() < 1e-12);
}

/// A group and a record whose largest waves come after 300 periods have the limits of the same waves after 30 periods.
#[test]
fn a_late_crest_has_the_room_of_an_early_one() {
    let maker = maker(0.4, Paddle::Piston);
    let tuning = AbsorptionSettings {
        period: Some(1.2),
        gauge_distance: 0.04,
        water_level: 0.4,
        max_stroke: None,
        max_speed: None,
    };
    let limits = |wave: &PaddleMotion| Absorber::new(&maker, wave, &tuning).unwrap().motion_limits();
    let group = |time: f64| maker.focused(0.05, &WaveSpectrum::jonswap(1.2, 3.3), 4.0, time, 100).unwrap();
    let record = |time: f64| {
        let times: Vec<f64> = (0..=4000).map(|i| 0.1 * f64::from(i)).collect();
        let eta = |t: f64| 0.02 * (-((t - time) / 10.0).powi(2)).exp() * (TAU * t / 1.25).sin();
        let values: Vec<f64> = times.iter().map(|t| eta(*t)).collect();
        maker.measured(&TimeSeries::new(times, values).unwrap(), 0.0, 0.0).unwrap()
    };
    for (early, late) in [(group(36.0), group(360.0)), (record(40.0), record(340.0))] {
        let (early, late) = (limits(&early), limits(&late));
        // Forty samples in a period catch a crest to 1 − cos(π/40), 0.3 %; the components of a late group have other round-off.
        assert!((late.0 / early.0 - 1.0).abs() < 0.01 && (late.1 / early.1 - 1.0).abs() < 0.01, "{late:?} {early:?}");
    }
}
