//! A map as a picture: a cell for each case, its sign and colour by how it came out.

use super::{CaseResult, StressMap, criteria::CaseOutcome};
use crate::study::html_page::escape;

/// Size of a cell and of the margins around all, pixels.
const CELL: [usize; 2] = [74, 34];
const LEFT: usize = 190;
const TOP: usize = 64;

/// Sign and colour (Okabe & Ito: told apart by everyone) of an outcome, or of no run.
fn cell_style(outcome: Option<CaseOutcome>) -> (&'static str, &'static str) {
    match outcome {
        Some(CaseOutcome::Right) => ("●", "#0072b2"),
        Some(CaseOutcome::Stopped) => ("■", "#e69f00"),
        Some(CaseOutcome::Wrong) => ("✕", "#d55e00"),
        Some(CaseOutcome::Unfinished) => ("…", "#999999"),
        None => ("", "#ffffff"),
    }
}

/// An outcome in a word.
pub(super) fn outcome_name(outcome: CaseOutcome) -> &'static str {
    match outcome {
        CaseOutcome::Right => "right",
        CaseOutcome::Stopped => "stopped",
        CaseOutcome::Wrong => "wrong",
        CaseOutcome::Unfinished => "unfinished",
    }
}

/// The picture of `map` with its cases.
pub(super) fn map_svg(map: &StressMap, entries: &[&CaseResult]) -> String {
    let (columns, rows) = (map.x.value_labels(), map.y.as_ref().map_or(vec![String::new()], |y| y.value_labels()));
    let (width, height) = ((LEFT + CELL[0] * columns.len() + 20).max(640), TOP + CELL[1] * rows.len() + 92);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" \
         font-family=\"sans-serif\" font-size=\"13\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
    );
    svg += &svg_text(16, 24, "start", 15, &map.name);
    svg += &svg_text(16, 44, "start", 12, &map.about);
    for entry in entries {
        svg += &cell(entry);
    }
    let bottom = TOP + CELL[1] * rows.len();
    for (i, word) in columns.iter().enumerate() {
        svg += &svg_text(LEFT + CELL[0] * i + CELL[0] / 2, bottom + 18, "middle", 12, &clipped(word, 11));
    }
    for (j, word) in rows.iter().enumerate() {
        svg += &svg_text(LEFT - 8, TOP + CELL[1] * j + CELL[1] / 2 + 5, "end", 12, &clipped(word, 14));
    }
    svg += &svg_text(LEFT, bottom + 40, "start", 13, &format!("→ {}", label(&map.x.label, &map.x.unit)));
    if let Some(y) = &map.y {
        svg += &svg_text(LEFT, bottom + 58, "start", 13, &format!("↓ {}", label(&y.label, &y.unit)));
    }
    for (k, outcome) in
        [CaseOutcome::Right, CaseOutcome::Stopped, CaseOutcome::Wrong, CaseOutcome::Unfinished].into_iter().enumerate()
    {
        let (sign, colour) = cell_style(Some(outcome));
        let of = |entry: &&&CaseResult| entry.verdict().is_some_and(|(found, _)| found == outcome);
        let said = format!("{sign} {} {}", entries.iter().filter(of).count(), outcome_name(outcome));
        let line = svg_text(16 + 130 * k, bottom + 80, "start", 13, &said);
        svg += &line.replacen("<text ", &format!("<text fill=\"{colour}\" font-weight=\"bold\" "), 1);
    }
    svg + "</svg>\n"
}

fn label(what: &str, unit: &str) -> String {
    if unit.is_empty() { what.into() } else { format!("{what}, {unit}") }
}

/// A cell; what it says in full is shown where the pointer rests.
fn cell(entry: &CaseResult) -> String {
    let verdict = entry.verdict();
    let (sign, colour) = cell_style(verdict.as_ref().map(|(outcome, _)| *outcome));
    let [i, j] = entry.case.cell;
    let (x, y) = (LEFT + CELL[0] * i, TOP + CELL[1] * j);
    let said = super::summary_line(entry);
    format!(
        "<g><title>{}</title><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{colour}\" fill-opacity=\"0.18\" \
         stroke=\"{colour}\"/>\n<text x=\"{}\" y=\"{}\" text-anchor=\"middle\" font-size=\"17\" fill=\"{colour}\">{sign}</text></g>\n",
        escape(&said),
        x + 1,
        y + 1,
        CELL[0] - 2,
        CELL[1] - 2,
        x + CELL[0] / 2,
        y + CELL[1] / 2 + 6,
    )
}

fn svg_text(x: usize, y: usize, anchor: &str, size: usize, words: &str) -> String {
    let words = escape(words);
    format!("<text x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\" font-size=\"{size}\">{words}</text>\n")
}

/// `word`, cut to `most` characters.
fn clipped(word: &str, most: usize) -> String {
    if word.chars().count() <= most { word.into() } else { word.chars().take(most - 1).chain(['…']).collect() }
}
