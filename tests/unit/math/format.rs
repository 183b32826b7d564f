//! Unit tests of `src/math/format.rs`.

use super::*;

#[test]
fn units_and_labels_follow_from_column_names() {
    assert_eq!(["fx_N_per_m", "fx_N", "heave_m, 0 at 2 s", "vx_mps", "x"].map(unit), ["N/m", "N", "m", "m/s", "–"]);
    assert_eq!(unit("front_m (2)"), "m", "the second check of a series");
    assert_eq!(["power_W_per_m", "flow_m2ps", "eta_at_1.5_m"].map(unit), ["W/m", "m²/s", "m"]);
    let faces = ["entered_kg_per_m", "momentum_x_Ns_per_m", "momentum_x_Ns", "left_kg", "acceleration_mps2"];
    assert_eq!(faces.map(unit), ["kg/m", "N s/m", "N s", "kg", "m/s²"]);
    assert_eq!(faces.map(column_label)[..2], ["entered", "momentum x"]);
    assert_eq!(["fx_N_per_m", "water_kinetic_J", "x"].map(column_label), ["fx", "water kinetic", "x"]);
    let row = ["eta_at_1.5_m", "below_1_at_-0.5_0.3_m", "vx_at_1_0.2_mps", "p_at_0_0_Pa"];
    assert_eq!(row.map(column_label), ["eta at 1.5 m", "below 1 at -0.5, 0.3 m", "vx at 1, 0.2 m", "p at 0, 0 m"]);
    assert_eq!(row.map(unit), ["m", "m", "m/s", "Pa"]);
}

#[test]
fn sizes_and_durations_have_short_formats() {
    assert_eq!([bytes(12.0), bytes(1_500_000.0)], ["12 B", "1.5 MB"]);
    assert_eq!([duration(3.21), duration(125.0), duration(7260.0)], ["3.2 s", "2 min 05 s", "2 h 01 min"]);
}

#[test]
fn numbers_have_their_significant_digits() {
    assert_eq!(
        [three_digits(0.123456), three_digits(-12.0), three_digits(1234.4), three_digits(2e-7), three_digits(2e-10)],
        ["0.123", "-12", "1234", "2.00e-7", "2.00e-10"]
    );
    assert_eq!(
        [four_digits(-0.0123449), four_digits(1234.4), four_digits(0.0), four_digits(1e-7), four_digits(f64::NAN)],
        ["−0.01234", "1234", "0", "1.000e−7", "–"]
    );
    let three = |x: f64| significant_digits(x, 3, 0.0..f64::INFINITY);
    assert_eq!(
        [three(0.5), three(-1e-8), three(1e7), three(f64::INFINITY)],
        ["0.500", "-0.000000010", "10000000", "inf"]
    );
}

#[test]
fn numbers_are_rounded_to_the_side_that_helps() {
    assert_eq!(
        [
            two_digits_down(0.01),
            two_digits_down(0.0129),
            two_digits_up(0.0121),
            two_digits_up(131.0),
            two_digits_down(2.0)
        ],
        ["0.01", "0.012", "0.013", "140", "2"]
    );
    assert_eq!(coordinates(&[0.1 + 0.2, -1e-17]), "[0.3, 0]");
    assert_eq!([decimals(0.1 + 0.2, 9), decimals(-1e-9, 6), decimals(3000.0, 9)], ["0.3", "0", "3000"]);
}

#[test]
fn large_numbers_are_short_or_grouped() {
    assert_eq!([metric_prefix(1.234e6), metric_prefix(5.0), metric_prefix(123.4)], ["1.23 M", "5.00", "123"]);
    assert_eq!([thousands(999), thousands(1234567)], ["999", "1\u{202f}234\u{202f}567"]);
}

#[test]
fn a_terminal_obeys_no_title() {
    assert_eq!(without_control("a \u{1b}[31mred tank,\n1 m³\u{7}"), "a \\u{1b}[31mred tank,\n1 m³\\u{7}");
}
