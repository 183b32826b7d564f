//! Unit tests of `src/math/format.rs`.

use super::*;

#[test]
fn units_and_labels_follow_from_column_names() {
    assert_eq!(["fx_N_per_m", "fx_N", "heave_m, 0 at 2 s", "vx_mps", "x"].map(unit), ["N/m", "N", "m", "m/s", "–"]);
    assert_eq!(unit("front_m (2)"), "m", "the second check of a series");
    assert_eq!(["power_W_per_m", "flow_m2ps", "eta_at_1.5_m"].map(unit), ["W/m", "m²/s", "m"]);
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
