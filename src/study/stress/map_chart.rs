//! Draws a stress map as SVG: a cell for each case, with the symbol and colour of its outcome.

use super::{CaseResult, StressMap, criteria::CaseOutcome};
use crate::report::{
    html::escape,
    plot::{svg_document, svg_text},
};

/// The width and height of a cell, pixels.
const CELL: [f64; 2] = [74.0, 34.0];

/// The left edge of the first cell.
const LEFT: f64 = 190.0;

/// The upper edge of the first cell.
const TOP: f64 = 64.0;

/// Returns the symbol and colour of an outcome or of a missing run. The colours (Okabe & Ito) suit colour-blind
/// readers.
fn cell_style(outcome: Option<CaseOutcome>) -> (&'static str, &'static str) {
    match outcome {
        Some(CaseOutcome::Right) => ("●", "#0072b2"),
        Some(CaseOutcome::Stopped) => ("■", "#e69f00"),
        Some(CaseOutcome::Wrong) => ("✕", "#d55e00"),
        Some(CaseOutcome::Unfinished) => ("…", "#999999"),
        None => ("", "#ffffff"),
    }
}

/// Returns the name of an outcome.
pub(super) fn outcome_name(outcome: CaseOutcome) -> &'static str {
    match outcome {
        CaseOutcome::Right => "right",
        CaseOutcome::Stopped => "stopped",
        CaseOutcome::Wrong => "wrong",
        CaseOutcome::Unfinished => "unfinished",
    }
}

/// Returns the chart of `map` with its cases.
pub(super) fn map_svg(map: &StressMap, entries: &[&CaseResult]) -> String {
    let (columns, rows) = (map.x.value_labels(), map.y.as_ref().map_or(vec![String::new()], |y| y.value_labels()));
    let bottom = TOP + CELL[1] * rows.len() as f64;
    let (width, height) = ((LEFT + CELL[0] * columns.len() as f64 + 20.0).max(640.0), bottom + 92.0);
    let write = |x, y, anchor, size, words: &str| svg_text([x, y], anchor, size, "black", words);
    let mut svg = write(16.0, 24.0, "start", 15.0, &map.name) + &write(16.0, 44.0, "start", 12.0, &map.about);
    svg.extend(entries.iter().map(|entry| cell(entry)));
    for (i, word) in columns.iter().enumerate() {
        svg += &write(LEFT + CELL[0] * (i as f64 + 0.5), bottom + 18.0, "middle", 12.0, &clipped(word, 11));
    }
    for (j, word) in rows.iter().enumerate() {
        svg += &write(LEFT - 8.0, TOP + CELL[1] * (j as f64 + 0.5) + 5.0, "end", 12.0, &clipped(word, 14));
    }
    svg += &write(LEFT, bottom + 40.0, "start", 13.0, &format!("→ {}", label(&map.x.label, &map.x.unit)));
    if let Some(y) = &map.y {
        svg += &write(LEFT, bottom + 58.0, "start", 13.0, &format!("↓ {}", label(&y.label, &y.unit)));
    }
    let outcomes = [CaseOutcome::Right, CaseOutcome::Stopped, CaseOutcome::Wrong, CaseOutcome::Unfinished];
    svg += "<g font-weight=\"bold\">\n";
    for (k, outcome) in outcomes.into_iter().enumerate() {
        let (sign, colour) = cell_style(Some(outcome));
        let of = |entry: &&&CaseResult| entry.verdict().is_some_and(|(found, _)| found == outcome);
        let count = format!("{sign} {} {}", entries.iter().filter(of).count(), outcome_name(outcome));
        svg += &svg_text([16.0 + 130.0 * k as f64, bottom + 80.0], "start", 13.0, colour, &count);
    }
    svg_document([width, height], &(svg + "</g>\n"))
}

fn label(what: &str, unit: &str) -> String {
    if unit.is_empty() { what.into() } else { format!("{what}, {unit}") }
}

/// Returns a cell; a browser shows the full outcome as a tooltip.
fn cell(entry: &CaseResult) -> String {
    let verdict = entry.verdict();
    let (sign, colour) = cell_style(verdict.as_ref().map(|(outcome, _)| *outcome));
    let [i, j] = entry.case.cell;
    let (x, y) = (LEFT + CELL[0] * i as f64, TOP + CELL[1] * j as f64);
    format!(
        "<g><title>{}</title><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{colour}\" fill-opacity=\"0.18\" \
         stroke=\"{colour}\"/>\n{}</g>\n",
        escape(&super::summary_line(entry)),
        x + 1.0,
        y + 1.0,
        CELL[0] - 2.0,
        CELL[1] - 2.0,
        svg_text([x + 0.5 * CELL[0], y + 0.5 * CELL[1] + 6.0], "middle", 17.0, colour, sign)
    )
}

/// Returns `word`, shortened to `most` characters.
fn clipped(word: &str, most: usize) -> String {
    if word.chars().count() <= most { word.into() } else { word.chars().take(most - 1).chain(['…']).collect() }
}
