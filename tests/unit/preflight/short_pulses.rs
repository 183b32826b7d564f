//! Pulses of laws, beside changes that steps follow.

use super::short_pulse;
use crate::{
    math::{expression::Formula, time_series::TimeSeries},
    solid::TimeFunction,
};

fn formula(text: &str) -> TimeFunction {
    Formula::parse(text).unwrap().into()
}

/// A triangle of 0.4 ms is found at its time and with its length.
#[test]
fn a_pulse_shorter_than_four_steps_is_found_at_its_time() {
    let series = TimeSeries::new([0.0, 0.5, 0.5001, 0.5003, 0.5004, 1.0], [0.0, 0.0, 1e5, 1e5, 0.0, 0.0]).unwrap();
    for (law, at, length) in [
        (formula("2e4*max(0,1-abs(t-0.5003)/2e-4)"), 0.5003, 4e-4),
        (formula("5-3*max(0,1-abs(t-0.2)/2e-4)"), 0.2, 4e-4),
        (TimeFunction::Table(series), 0.5002, 4e-4),
    ] {
        let (found, found_length) = short_pulse(&law, [0.0, 1.0], 4.0 * 1.4e-3).expect("a pulse");
        // Within two samples of 0.175 ms, and the pulse counts from a tenth of its height.
        assert!((found - at).abs() < 3.5e-4 && (found_length - length).abs() < 3.5e-4, "{found} s, {found_length} s");
    }
}

#[test]
fn steps_ramps_and_waves_are_no_pulses() {
    for text in ["max(0,min(1,(t-0.5)*1e9))", "20*sin(40*t)", "t", "3*max(0,1-abs(t-0.5)/0.02)"] {
        assert_eq!(short_pulse(&formula(text), [0.0, 1.0], 4.0 * 1.4e-3), None, "{text}");
    }
}
