//! Verdicts in words: a row for each, and only columns that one of them uses. For terminals and pages alike.

use super::Verdict;
use crate::{math::format, plan::Score};

/// A figure with three decimals, or a dash.
pub fn figure(x: Option<f64>) -> String {
    x.map_or("–".into(), |x| format!("{x:.3}"))
}

/// A figure in the unit of its series: three digits that count.
pub fn digits(x: Option<f64>) -> String {
    match x {
        None => "–".into(),
        Some(0.0) => "0".into(),
        Some(x) => {
            let places = (2 - x.abs().log10().floor() as i32).clamp(0, 9) as usize;
            format!("{x:.places$}")
        }
    }
}

/// A delay in ms, with its sign.
pub fn delay(seconds: f64) -> String {
    format!("{:+.0} ms", seconds * 1e3)
}

/// The bound in words.
pub fn bound(bound: Option<Score>) -> String {
    let Some(b) = bound else { return String::new() };
    let said = [("N", b.n), ("|M − 1|", b.m), ("peak", b.peak), ("off", b.off), ("aligned N", b.aligned_n)];
    let mut words: Vec<String> = said.iter().filter_map(|(word, x)| x.map(|x| format!("{word} ≤ {x}"))).collect();
    words.extend(b.delay.map(|x| format!("|delay| ≤ {x} s")));
    words.join(", ")
}

/// Whether the bound is kept, or why nobody knows.
pub fn remark(verdict: &Verdict) -> String {
    match (verdict.passed, &verdict.note) {
        (Some(true), _) => "kept".into(),
        (Some(false), _) => "MISSED".into(),
        (None, Some(note)) => note.lines().next().unwrap_or("").to_string(),
        (None, None) => String::new(),
    }
}

/// A column of the table: its head, and its text for a verdict; an empty one says that it has none.
type Column = (&'static str, fn(&Verdict) -> String);

/// Columns before the bound. Those after the first three stand only if some check has something to say there.
const COLUMNS: [Column; 13] = [
    ("check", |v| v.series.clone()),
    ("N", |v| figure(v.figures.n)),
    ("M", |v| figure(v.figures.m)),
    ("mean over", |v| v.meaned.map_or(String::new(), |m| format!("{} ms", 1e3 * m.seconds))),
    ("mean N", |v| v.meaned.map_or(String::new(), |m| figure(m.figures.n))),
    ("mean M", |v| v.meaned.map_or(String::new(), |m| figure(m.figures.m))),
    ("aligned N", |v| v.aligned.map_or(String::new(), |a| figure(Some(a.n)))),
    ("aligned M", |v| v.aligned.map_or(String::new(), |a| figure(Some(a.m)))),
    ("delay", |v| v.aligned.map_or(String::new(), |a| delay(a.delay))),
    ("peak", |v| if strikes(v) || names(v, |s| s.peak) { figure(v.figures.peak) } else { String::new() }),
    ("mean peak", |v| v.meaned.filter(|_| strikes(v)).map_or(String::new(), |m| figure(m.figures.peak))),
    ("off", |v| if names(v, |s| s.off) { digits(v.figures.off) } else { String::new() }),
    ("paper N, M", |v| v.paper.map_or(String::new(), |p| format!("{}, {}", figure(p.n), figure(p.m)))),
];

/// Whether the series is a load as an instrument takes it: its first peak is the first impact.
fn strikes(verdict: &Verdict) -> bool {
    // A second check of a series is told as "force.fx_N (2)".
    let column = verdict.series.split(" (").next().unwrap_or_default();
    verdict.meaned.is_some() && ["N", "N/m", "Pa"].contains(&format::unit(column))
}

/// Whether the bound or the paper names a figure.
fn names(verdict: &Verdict, which: fn(&Score) -> Option<f64>) -> bool {
    [&verdict.bound, &verdict.paper].into_iter().flatten().any(|score| which(score).is_some())
}

/// The table of `verdicts`, the first row its head; before each stand the cells that it comes with, under
/// `heads`.
pub fn rows(verdicts: &[(&[String], &Verdict)], heads: &[&str]) -> Vec<Vec<String>> {
    let used = |(i, (_, text)): &(usize, &Column)| *i < 3 || verdicts.iter().any(|(_, v)| !text(v).is_empty());
    let columns: Vec<&Column> = COLUMNS.iter().enumerate().filter(used).map(|(_, column)| column).collect();
    let mut head: Vec<String> = heads.iter().map(|h| h.to_string()).collect();
    head.extend(columns.iter().map(|(name, _)| name.to_string()));
    head.extend(["bound".to_string(), String::new()]);
    let row = |(before, verdict): &(&[String], &Verdict)| {
        let mut row = before.to_vec();
        row.extend(columns.iter().map(|(_, text)| text(verdict)));
        row.extend([bound(verdict.bound), remark(verdict)]);
        row
    };
    std::iter::once(head).chain(verdicts.iter().map(row)).collect()
}
