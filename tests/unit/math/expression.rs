//! Unit tests of `src/math/expression.rs`.

use super::*;

#[test]
fn operators_have_mathematical_precedence() {
    for (text, value) in [
        ("-t^2", -9.0),
        ("2^3^2", 512.0),
        ("2^-t", 0.125),
        ("8/4/2", 1.0),
        ("8 / 2 * 4", 16.0),
        ("1-2+3", 2.0),
        ("2e-3*t + 1.5E3", 1500.006),
        ("-(1+t)*-2", 8.0),
        ("max(t, 1) - min(t, 1)", 2.0),
        ("(-t)^2", 9.0),
    ] {
        assert_eq!(Formula::parse(text).unwrap().value_and_rate(3.0).0, value, "{text}");
    }
}

#[test]
fn the_rate_of_a_formula_is_its_derivative() {
    for (name, _) in FUNCTIONS {
        check_rate(&format!("{name}(0.3 + 0.4*t)"));
    }
    for text in ["t^3 - 2^t + t^t", "exp(-t^2)/(1+t)", "0.05*sin(2*pi*t/1.2)*tanh(t)", "max(t^2, t)", "7", "-t*-t"] {
        check_rate(text);
    }
    assert_eq!(Formula::parse("t^2").unwrap().value_and_rate(0.0), (0.0, 0.0));
    assert_eq!(Formula::parse("(t-1)^3").unwrap().value_and_rate(0.0), (-1.0, 3.0));
}

/// The central difference of step 1e-5 is exact to 1e-10 f''' and to the round-off 1e-11 of its quotient.
fn check_rate(text: &str) {
    let formula = Formula::parse(text).unwrap();
    let (t, step) = (0.7, 1e-5);
    let difference = (formula.value_and_rate(t + step).0 - formula.value_and_rate(t - step).0) / (2.0 * step);
    let rate = formula.value_and_rate(t).1;
    assert!((rate - difference).abs() < 1e-8 * (1.0 + rate.abs()), "{text}: {rate} against {difference}");
}

#[test]
fn an_invalid_formula_is_refused_with_its_position_and_reason() {
    let message = |text: &str| Formula::parse(text).unwrap_err().to_string();
    assert!(message("2*sinus(t)").contains("character 3: \"sinus\" is not known; did you mean \"sin"));
    assert!(message("2*x").contains("\"x\" is not known"));
    assert!(message("3t").contains("an operator is expected before 't'"));
    assert!(message("sin(t").contains("it ends where ')' is expected"));
    assert!(message("1.2.3").contains("\"1.2.3\" is not a number"));
    for text in ["", "t*", ")", "sin t", "min(t)", "1e", "π", "t²", "2**t"] {
        assert!(message(text).contains("known: "), "{text}");
    }
    assert!(message(&"(".repeat(900)).contains("nested"));
    assert!(message(&"-".repeat(900)).contains("nested"));
    assert!(message(&"1+".repeat(900)).contains("longer"));
}

/// The extreme of a number and a root of a negative number has no value, in either order; a limit below the root gives one.
#[test]
fn an_extreme_of_no_value_has_no_value() {
    for text in ["max(0, sqrt(t - 0.2))", "max(sqrt(t - 0.2), 0)", "min(0, sqrt(t - 0.2))", "min(sqrt(t - 0.2), 0)"] {
        assert!(Formula::parse(text).unwrap().value_and_rate(0.1).0.is_nan(), "{text}");
    }
    let limited = Formula::parse("sqrt(max(t - 0.2, 0))").unwrap();
    assert_eq!([0.1, 0.45].map(|t| limited.value_and_rate(t).0), [0.0, 0.5]);
}
