//! Poles of known functions.

use super::find_pole;
use crate::math::expression::Formula;

fn pole(text: &str, range: [f64; 2]) -> Option<f64> {
    let formula = Formula::parse(text).unwrap();
    find_pole(|t| formula.value_and_rate(t).0, range)
}

#[test]
fn a_pole_is_found_where_it_is() {
    for (text, range, at) in [
        ("20/(t-0.5)", [0.0, 1.0], 0.5),
        ("20/(t-0.50037)", [0.0, 1.0], 0.50037),
        ("1e-4/(t-1/3)+sin(20*t)", [0.0, 1.0], 1.0 / 3.0),
        ("1/(t-700.123)^2", [0.0, 1000.0], 700.123),
        ("1/sqrt(abs(t-0.2))", [0.0, 1.0], 0.2),
        ("tan(pi*t/2)", [0.0, 1.0], 1.0),
        ("tan(pi*t/2)", [0.0, 2.0], 1.0),
        ("1/t", [0.0, 1.0], 0.0),
    ] {
        let found = pole(text, range).unwrap_or_else(|| panic!("{text} has a pole"));
        // The intervals are narrowed down to 1e-12 of the range.
        assert!((found - at).abs() < 1e-11 * range[1], "{text}: {found} in place of {at}");
    }
}

#[test]
fn peaks_steps_and_gaps_are_no_poles() {
    for text in [
        "0",
        "5",
        "t",
        "sin(40*t)",
        "sin(t-0.5)/(t-0.5)",
        "exp(-((t-0.50037)/1e-5)^2)",
        "2e4*max(0,1-abs(t-0.5003)/2e-4)",
        "max(0,min(1,(t-0.5)*1e9))",
        "ln(abs(t-0.5)+1e-9)",
        "1/(1.001-t)",
    ] {
        assert_eq!(pole(text, [0.0, 1.0]), None, "{text}");
    }
}
