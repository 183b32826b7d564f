//! Unit tests of `src/report/charts.rs`.

use super::*;

/// A table of readings that are no means.
fn probe_table(
    [name, what]: [&'static str; 2],
    columns: Vec<String>,
    times: Vec<f64>,
    values: Vec<Vec<f64>>,
) -> ProbeTable {
    let are_means = vec![false; columns.len()];
    ProbeTable { name: name.into(), what, columns, times, values, are_means }
}

fn table(rows: usize) -> ProbeTable {
    let t: Vec<f64> = (0..rows).map(|i| i as f64).collect();
    let mut x = vec![0.0; rows];
    x[rows / 2 + 1] = 5.0;
    probe_table(["p", "pressure"], vec!["p_Pa".into()], t, vec![x])
}

#[test]
fn a_long_table_is_thinned_without_losing_its_peak() {
    let long = table(1_000_000);
    let rows = thinned_rows(&long);
    assert!(rows.len() <= MOST_ROWS + 2 && rows.contains(&500_001), "{} rows", rows.len());
    assert!(rows.contains(&0) && rows.contains(&999_999), "the end points remain");
    assert_eq!(thinned_rows(&table(MOST_ROWS)).len(), MOST_ROWS);
}

#[test]
fn an_oscillating_series_has_a_spectrum_with_its_frequency() {
    let t: Vec<f64> = (0..2000).map(|i| f64::from(i) * 0.01).collect();
    let wave = t.iter().map(|t| 0.05 * (std::f64::consts::TAU * 1.25 * t).sin()).collect();
    let (rising, name) = (t.clone(), |name: &str| name.to_string());
    let columns = vec![name("eta_m"), name("front_m")];
    let table = probe_table(["gauge", "elevation"], columns, t, vec![wave, rising]);
    let mut blob = BinaryData::default();
    let found = encode_table(&table, &mut blob).spectra;
    assert_eq!((found.len(), found[0].column), (1, 0), "a rising series has no spectrum");
    // Lines of a record of 20 s are 0.05 Hz apart, and a Hann window spreads 1.25 Hz over two lines on either side.
    assert!((25..30).contains(&found[0].rows), "the chart ends at the last line with energy: {} lines", found[0].rows);
}

#[test]
fn every_column_is_in_one_chart() {
    let names = ["x_m", "y_m", "surge_m", "heave_m", "pitch_deg", "vx_mps", "odd_kg"].map(String::from);
    let charts = group_columns(&names);
    let mut all: Vec<usize> = charts.iter().flat_map(|chart| chart.columns.clone()).collect();
    all.sort_unstable();
    assert_eq!(all, [0, 1, 2, 3, 4, 5, 6]);
    assert_eq!(charts[0], Chart { columns: vec![2, 3], folded: false, title: None });
    assert!(!super::group_columns(&["x_m".into()])[0].folded, "a single chart is open");
}

#[test]
fn a_load_breakdown_has_a_chart_for_each_direction_with_its_non_zero_kinds() {
    let kinds = ["pressure", "viscous", "weight", "residual"];
    let columns: Vec<String> = kinds.iter().flat_map(|kind| ["fx_N", "fz_N"].map(|f| format!("{kind}_{f}"))).collect();
    // There is no viscous load, and the weight acts downwards only.
    let x = [1.0, 2.0, 0.0, 0.0, 0.0, -2.0, 1e-9, 1e-9].map(|x| vec![0.0, x]).to_vec();
    let t = vec![0.0, 1.0];
    let table = probe_table(["box_balance", "loads by kind"], columns, t, x);
    let (charts, idle) = breakdown_charts(&table);
    let found: Vec<_> = charts.iter().map(|c| (c.title.as_deref(), &c.columns[..], c.folded)).collect();
    let expected: [(_, &[usize], _); 4] = [
        (Some("fx by kind"), &[0], false),
        (Some("fz by kind"), &[1, 5], false),
        (Some("residual fx"), &[6], true),
        (Some("residual fz"), &[7], true),
    ];
    assert_eq!(found, expected);
    assert_eq!(idle, ["viscous"]);
}
