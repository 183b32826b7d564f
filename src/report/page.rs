//! The page: words and tables in HTML, then the numbers of players and plots, then what moves them.

use serde::Serialize;

use super::{
    MOST_BYTES,
    blob::Blob,
    charts::{self, Answered, Held, Plotted},
    colour::{MAPS, Maps},
    figures,
    film::{Reel, reel},
    format::escape,
    kept::{Kept, Set},
    outline::Outline,
    rim::Rim,
    sections,
};
use crate::error::Result;

const FRAME: &str = include_str!("assets/page.html");
const STYLE: [&str; 2] = [include_str!("assets/uplot.min.css"), include_str!("assets/page.css")];
const SCRIPT: [&str; 6] = [
    include_str!("assets/uplot.min.js"),
    include_str!("assets/film.js"),
    include_str!("assets/paint.js"),
    include_str!("assets/view.js"),
    include_str!("assets/deck.js"),
    include_str!("assets/plots.js"),
];

/// Samples (a particle in a frame) that a page has room for: five bytes each, where four were the most that was seen.
const SAMPLES: f64 = (MOST_BYTES - 2_000_000) as f64 / 5.0;

/// What the scripts are told.
#[derive(Serialize)]
struct Told<'a> {
    maps: Maps,
    runs: Vec<Run<'a>>,
}

/// A run as the scripts take it.
#[derive(Serialize)]
struct Run<'a> {
    name: &'a str,
    title: &'a str,
    until: f64,
    stage: Option<Stage<'a>>,
    reel: Option<Reel>,
    tables: Vec<Plotted>,
    checks: Vec<Held>,
    answers: Vec<Answered<'a>>,
}

/// What stands around the water.
#[derive(Serialize)]
struct Stage<'a> {
    dimension: usize,
    dp: f64,
    level: f64,
    rho0: f64,
    g: f64,
    solids: Vec<Solid<'a>>,
    gauges: Vec<Gauge<'a>>,
}

#[derive(Serialize)]
struct Solid<'a> {
    name: &'a str,
    role: &'a str,
    lines: &'a [Outline],
    rim: &'a Rim,
}

#[derive(Serialize)]
struct Gauge<'a> {
    name: &'a str,
    what: &'a str,
    at: &'a [f64],
}

impl<'a> From<&'a Set> for Stage<'a> {
    fn from(set: &'a Set) -> Self {
        let solids =
            set.solids.iter().map(|s| Solid { name: &s.name, role: s.role, lines: &s.lines, rim: &s.rim }).collect();
        let gauges = set.gauges().map(|(name, what, at)| Gauge { name, what, at }).collect();
        Self { dimension: set.dimension, dp: set.dp, level: set.level, rho0: set.rho0, g: set.g, solids, gauges }
    }
}

/// The page of `runs`.
///
/// # Errors
/// `File` if a frame cannot be read.
pub fn page(runs: &[Kept]) -> Result<String> {
    let mut samples = SAMPLES;
    loop {
        let text = attempt(runs, (samples / runs.len() as f64) as usize)?;
        if text.len() <= MOST_BYTES || samples < 1e4 {
            return Ok(text);
        }
        samples *= 0.9 * MOST_BYTES as f64 / text.len() as f64;
    }
}

/// The page with about so many `samples` a run.
fn attempt(runs: &[Kept], samples: usize) -> Result<String> {
    let mut blob = Blob::default();
    let mut told = Told { maps: MAPS, runs: Vec::new() };
    for run in runs {
        let reel = run.film.as_ref().map(|film| reel(run, film, samples, &mut blob)).transpose()?;
        told.runs.push(Run {
            name: &run.name,
            title: &run.manifest.title,
            until: run.manifest.until_s,
            stage: run.set.as_ref().map(Stage::from),
            reel,
            tables: run.tables.iter().map(|table| charts::plotted(table, &mut blob)).collect(),
            checks: charts::held(run, sections::caption, &mut blob),
            answers: charts::answered(&run.told.answers, &mut blob),
        });
    }
    let data = serde_json::to_string(&told).unwrap_or_default().replace('<', "\\u003c");
    let (title, body) = match runs {
        [run] => (run.manifest.title.clone(), single(run, &told.runs[0])),
        _ => (format!("{} runs compared", runs.len()), several(runs, &told.runs)),
    };
    let parts = [
        ("{{title}}", escape(&title)),
        ("{{style}}", STYLE.concat()),
        ("{{body}}", body),
        ("{{version}}", env!("CARGO_PKG_VERSION").to_string()),
        ("{{script}}", SCRIPT.join("\n")),
        ("{{data}}", data),
        ("{{blob}}", blob.text()),
    ];
    // One after the other from the front: what a user wrote is never searched for the next sign.
    let (mut text, mut rest) = (String::new(), FRAME);
    for (sign, part) in parts {
        let (before, after) = rest.split_once(sign).unwrap_or((rest, ""));
        text += before;
        text += &part;
        rest = after;
    }
    Ok(text + rest)
}

fn section(id: &str, title: &str, body: &str) -> String {
    if body.is_empty() {
        return String::new();
    }
    format!(
        "<section id=\"{id}\" aria-labelledby=\"{id}-title\">\n<h2 id=\"{id}-title\">{title}</h2>\n{body}</section>\n"
    )
}

/// The place of the players.
fn player(told: &[Run]) -> String {
    let reels: Vec<(&str, &Reel)> = told.iter().filter_map(|run| Some((run.name, run.reel.as_ref()?))).collect();
    if reels.is_empty() {
        return "<p>No frames were kept of this run (<code>[frames]</code> in the scene), so there is nothing to play.</p>\n".into();
    }
    let notes: String = reels
        .iter()
        .map(|(name, reel)| {
            let name = if told.len() > 1 { format!("{}: ", escape(name)) } else { String::new() };
            format!("<p class=\"quiet\">{name}{}</p>\n", sections::shown(reel))
        })
        .collect();
    format!("<div id=\"deck\"></div>\n{notes}")
}

fn single(run: &Kept, told: &Run) -> String {
    let figures = figures::rows(&run.tables);
    let held = sections::verdicts(std::slice::from_ref(run));
    let charts = |id: &str, any: bool| if any { format!("<div id=\"{id}\"></div>\n") } else { String::new() };
    sections::head(run)
        + &sections::warnings(std::slice::from_ref(run))
        + &section("player", "Player", &player(std::slice::from_ref(told)))
        + &section("checks", "Against references", &(held + &charts("held", !told.checks.is_empty())))
        + &section("series", "Series", &charts("charts", !told.tables.is_empty()))
        + &section(
            "statistics",
            "Statistics",
            &(sections::statistics(run) + &charts("answers", !told.answers.is_empty())),
        )
        + &section("energy", "Energy", &sections::energy(run))
        + &section(
            "figures",
            "Figures of the series",
            &if figures.len() > 1 { sections::wide(&figures) + WAVES } else { String::new() },
        )
        + &section("what", "What was run", &sections::what(run))
        + &section("files", "Files", &sections::files(run))
}

const WAVES: &str = "<p class=\"quiet\">Waves are counted between crossings of the mean upwards; one counts if it goes a tenth of the \
    standard deviation to both sides. Means are over time. Entries of a budget or a balance that are 0 throughout are left out.</p>\n";

fn several(runs: &[Kept], told: &[Run]) -> String {
    let names: Vec<String> = runs.iter().map(|run| escape(&run.name)).collect();
    let any = |id: &str, any: bool| if any { format!("<div id=\"{id}\"></div>\n") } else { String::new() };
    format!("<p class=\"over\">pontoon · comparison</p>\n<h1>{}</h1>\n", names.join(" · "))
        + &section("runs", "The runs", &sections::beside(runs))
        + &sections::warnings(runs)
        + &section("player", "Players, at equal times and colours", &player(told))
        + &section("differences", "What differs", &sections::differences(runs))
        + &section(
            "checks",
            "Against references",
            &(sections::verdicts(runs) + &any("held", told.iter().any(|run| !run.checks.is_empty()))),
        )
        + &section(
            "series",
            "Series",
            &(sections::alone(runs) + &any("charts", told.iter().any(|run| !run.tables.is_empty()))),
        )
}
