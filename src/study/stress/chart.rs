//! A map as a picture: a cell for each case, its sign and colour by how it came out.

use super::{Entry, Map, judge::Outcome};
use crate::study::page::escape;

/// Size of a cell and of the margins around all, pixels.
const CELL: [usize; 2] = [74, 34];
const LEFT: usize = 190;
const TOP: usize = 64;

/// Sign and colour (Okabe & Ito: told apart by everyone) of an outcome, or of no run.
fn look(outcome: Option<Outcome>) -> (&'static str, &'static str) {
    match outcome {
        Some(Outcome::Right) => ("●", "#0072b2"),
        Some(Outcome::Stopped) => ("■", "#e69f00"),
        Some(Outcome::Wrong) => ("✕", "#d55e00"),
        Some(Outcome::Unfinished) => ("…", "#999999"),
        None => ("", "#ffffff"),
    }
}

/// An outcome in a word.
pub(super) fn name(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Right => "right",
        Outcome::Stopped => "stopped",
        Outcome::Wrong => "wrong",
        Outcome::Unfinished => "unfinished",
    }
}

/// The picture of `map` with its cases.
pub(super) fn picture(map: &Map, entries: &[&Entry]) -> String {
    let (columns, rows) = (map.x.words(), map.y.as_ref().map_or(vec![String::new()], |y| y.words()));
    let (width, height) = ((LEFT + CELL[0] * columns.len() + 20).max(640), TOP + CELL[1] * rows.len() + 92);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" \
         font-family=\"sans-serif\" font-size=\"13\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
    );
    svg += &text(16, 24, "start", 15, &map.name);
    svg += &text(16, 44, "start", 12, &map.about);
    for entry in entries {
        svg += &cell(entry);
    }
    let bottom = TOP + CELL[1] * rows.len();
    for (i, word) in columns.iter().enumerate() {
        svg += &text(LEFT + CELL[0] * i + CELL[0] / 2, bottom + 18, "middle", 12, &clipped(word, 11));
    }
    for (j, word) in rows.iter().enumerate() {
        svg += &text(LEFT - 8, TOP + CELL[1] * j + CELL[1] / 2 + 5, "end", 12, &clipped(word, 14));
    }
    svg += &text(LEFT, bottom + 40, "start", 13, &format!("→ {}", label(&map.x.label, &map.x.unit)));
    if let Some(y) = &map.y {
        svg += &text(LEFT, bottom + 58, "start", 13, &format!("↓ {}", label(&y.label, &y.unit)));
    }
    for (k, outcome) in [Outcome::Right, Outcome::Stopped, Outcome::Wrong, Outcome::Unfinished].into_iter().enumerate()
    {
        let (sign, colour) = look(Some(outcome));
        let of = |entry: &&&Entry| entry.verdict().is_some_and(|(found, _)| found == outcome);
        let said = format!("{sign} {} {}", entries.iter().filter(of).count(), name(outcome));
        let line = text(16 + 130 * k, bottom + 80, "start", 13, &said);
        svg += &line.replacen("<text ", &format!("<text fill=\"{colour}\" font-weight=\"bold\" "), 1);
    }
    svg + "</svg>\n"
}

fn label(what: &str, unit: &str) -> String {
    if unit.is_empty() { what.into() } else { format!("{what}, {unit}") }
}

/// A cell; what it says in full is shown where the pointer rests.
fn cell(entry: &Entry) -> String {
    let verdict = entry.verdict();
    let (sign, colour) = look(verdict.as_ref().map(|(outcome, _)| *outcome));
    let [i, j] = entry.case.place;
    let (x, y) = (LEFT + CELL[0] * i, TOP + CELL[1] * j);
    let said = super::said(entry);
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

fn text(x: usize, y: usize, anchor: &str, size: usize, words: &str) -> String {
    let words = escape(words);
    format!("<text x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\" font-size=\"{size}\">{words}</text>\n")
}

/// `word`, cut to `most` characters.
fn clipped(word: &str, most: usize) -> String {
    if word.chars().count() <= most { word.into() } else { word.chars().take(most - 1).chain(['…']).collect() }
}
