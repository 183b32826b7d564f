//! Verdicts as text: one row for each verdict, with only the columns that at least one verdict uses. Terminals and web
//! pages show these rows.

use super::Verdict;
use crate::{math::format, plan::Score};

/// Returns a metric with three decimals, or a dash.
pub(crate) fn format_metric(x: Option<f64>) -> String {
    x.map_or("–".into(), |x| format!("{x:.3}"))
}

/// Returns a value in the unit of its series, with three significant digits.
pub(crate) fn format_value(x: Option<f64>) -> String {
    x.map_or("–".into(), |x| format::significant_digits(x, 3, 0.0..f64::INFINITY))
}

/// Returns a delay in ms, with its sign.
pub(crate) fn format_delay(seconds: f64) -> String {
    format!("{:+.0} ms", seconds * 1e3)
}

/// Returns the bound as text.
pub(crate) fn format_bound(bound: Option<Score>) -> String {
    let Some(b) = bound else { return String::new() };
    let said = [
        ("N", b.relative_l2),
        ("|M − 1|", b.amplitude_ratio),
        ("peak", b.peak),
        ("off", b.off),
        ("aligned N", b.aligned_relative_l2),
    ];
    let mut words: Vec<String> = said.iter().filter_map(|(word, x)| x.map(|x| format!("{word} ≤ {x}"))).collect();
    words.extend(b.delay.map(|x| format!("|delay| ≤ {x} s")));
    words.extend(b.period.map(|x| format!("period ≤ {x}")));
    words.join(", ")
}

/// Returns whether the run meets the bound, or the reason for an unknown result.
pub(crate) fn format_outcome(verdict: &Verdict) -> String {
    match (verdict.passed, &verdict.note) {
        (Some(true), _) => "kept".into(),
        (Some(false), Some(note)) => format!("MISSED: {}", first_line(note)),
        (Some(false), None) => "MISSED".into(),
        (None, Some(note)) => first_line(note).into(),
        (None, None) => String::new(),
    }
}

fn first_line(text: &str) -> &str {
    text.lines().next().unwrap_or_default()
}

/// A column of the table: its head, and the function that returns its text for a verdict. The text is empty if the
/// verdict has no such value.
type VerdictColumn = (&'static str, fn(&Verdict) -> String);

/// Columns before the bound. The table shows those after the first three only if at least one verdict has a value for
/// them.
const COLUMNS: [VerdictColumn; 14] = [
    ("check", |v| v.series.clone()),
    ("N", |v| format_metric(v.metrics.relative_l2)),
    ("M", |v| format_metric(v.metrics.amplitude_ratio)),
    ("mean over", |v| v.meaned.map_or(String::new(), |m| format!("{} ms", 1e3 * m.seconds))),
    ("mean N", |v| v.meaned.map_or(String::new(), |m| format_metric(m.metrics.relative_l2))),
    ("mean M", |v| v.meaned.map_or(String::new(), |m| format_metric(m.metrics.amplitude_ratio))),
    ("aligned N", |v| v.aligned.map_or(String::new(), |a| format_metric(Some(a.relative_l2)))),
    ("aligned M", |v| v.aligned.map_or(String::new(), |a| format_metric(Some(a.amplitude_ratio)))),
    ("delay", |v| v.aligned.map_or(String::new(), |a| format_delay(a.delay))),
    (
        "peak",
        |v| if is_impact_load(v) || has_limit(v, |s| s.peak) { format_metric(v.metrics.peak) } else { String::new() },
    ),
    ("mean peak", |v| v.meaned.filter(|_| is_impact_load(v)).map_or(String::new(), |m| format_metric(m.metrics.peak))),
    ("off", |v| if has_limit(v, |s| s.off) { format_value(v.metrics.off) } else { String::new() }),
    ("period", |v| v.metrics.period.map_or(String::new(), |x| format_metric(Some(x)))),
    ("paper N, M", |v| {
        v.paper.map_or(String::new(), |p| {
            format!("{}, {}", format_metric(p.relative_l2), format_metric(p.amplitude_ratio))
        })
    }),
];

/// Returns whether the series is a load with a running mean of an instrument, so that its first peak is the first
/// impact.
fn is_impact_load(verdict: &Verdict) -> bool {
    // The name of a second check of a series has a suffix, as in "force.fx_N (2)".
    let column = verdict.series.split(" (").next().unwrap_or_default();
    verdict.meaned.is_some() && ["N", "N/m", "Pa"].contains(&format::unit(column))
}

/// Returns whether the bound or the paper has a value for the metric that `which` selects.
fn has_limit(verdict: &Verdict, which: fn(&Score) -> Option<f64>) -> bool {
    [&verdict.bound, &verdict.paper].into_iter().flatten().any(|score| which(score).is_some())
}

/// Returns the table of `verdicts`; the first row is the head. The leading cells of each verdict precede its columns,
/// under the headings `heads`.
pub fn verdict_rows(verdicts: &[(&[String], &Verdict)], heads: &[&str]) -> Vec<Vec<String>> {
    let used = |(i, (_, text)): &(usize, &VerdictColumn)| *i < 3 || verdicts.iter().any(|(_, v)| !text(v).is_empty());
    let columns: Vec<&VerdictColumn> = COLUMNS.iter().enumerate().filter(used).map(|(_, column)| column).collect();
    let mut head: Vec<String> = heads.iter().map(|h| h.to_string()).collect();
    head.extend(columns.iter().map(|(name, _)| name.to_string()));
    head.extend(["bound".to_string(), String::new()]);
    let row = |(before, verdict): &(&[String], &Verdict)| {
        let mut row = before.to_vec();
        row.extend(columns.iter().map(|(_, text)| text(verdict)));
        row.extend([format_bound(verdict.bound), format_outcome(verdict)]);
        row
    };
    std::iter::once(head).chain(verdicts.iter().map(row)).collect()
}
