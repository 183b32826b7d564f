//! Unit tests of `src/study/repeat_spread.rs`.

use super::*;
use crate::analysis::ErrorMetrics;

fn row(run: &str, repeat: usize, n: Option<f64>) -> ResultRow {
    let figures = ErrorMetrics { relative_l2: n, ..ErrorMetrics::default() };
    let status = if n.is_some() { "finished" } else { "failed" };
    ResultRow {
        run: run.into(),
        repeat,
        check: "box.surge_m".into(),
        metrics: figures,
        status,
        cpu_s: Some(2.0),
        ..ResultRow::default()
    }
}

#[test]
fn the_spread_of_repeats_excludes_failed_runs() {
    let rows = [
        row("a", 1, Some(0.10)),
        row("a", 2, Some(0.14)),
        row("a", 3, None),
        row("b", 1, Some(0.2)),
        row("b", 2, Some(0.2)),
    ];
    let all = repeat_spreads(&rows);
    assert_eq!(all.iter().map(|a| (a.run.as_str(), a.spread.runs)).collect::<Vec<_>>(), [("a", 2), ("b", 2)]);
    let table = spread_table(&rows);
    assert_eq!(table[0], ["run", "check", "runs", "N", "processors, s"]);
    assert_eq!(table[1], ["a", "box.surge_m", "2", "0.120 ± 0.028 (0.100 to 0.140)", "2.0"]);
    assert_eq!(table[2][3], "0.200 ± 0.000");
}

#[test]
fn single_runs_have_no_spread() {
    assert!(repeat_spreads(&[row("a", 1, Some(0.1)), row("b", 1, Some(0.2))]).is_empty());
    assert!(spread_table(&[row("a", 1, Some(0.1))]).is_empty());
    assert_eq!(Spread::of([]), None);
    let format = |values: &[f64]| Spread::of(values.iter().copied()).map(|s| s.format(format_verdicts::format_value));
    assert_eq!(format(&[0.25]), Some("0.250".into()));
    assert_eq!(format(&[0.25, 0.25 + 1e-7]), Some("0.250 ± 7e-8".into()), "no row of zeros");
}
