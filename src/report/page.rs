//! Assembles the page: text and tables in HTML, the data of players and plots, and the scripts.

use serde::Serialize;
use serde_json::Value;

use super::{
    MAX_PAGE_BYTES,
    animation::{Animation, encode_animation},
    charts::{self, CheckPlot, RaoPlot, TablePlots},
    colour::{FIELD_COLOUR_MAPS, FieldColourMaps},
    encoding::BinaryData,
    html::escape,
    outline::Outline,
    run_data::{RunData, SceneGeometry},
    sections, summary_tables,
    ties::Tie,
};

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

/// The additional style and script of a live page.
const LIVE_STYLE: &str = include_str!("assets/live.css");
const LIVE_SCRIPT: &str = include_str!("assets/live.js");

/// A sentence of the footer, and its replacement in a live page.
const ALONE: &str = "This file stands alone: it loads nothing and sends nothing.";
const LIVE: &str = "This page follows a run in progress on this machine; the run writes its own page at its end.";

/// The number of samples of a live page: few enough for any page, and for the memory of a browser.
pub(crate) const LIVE_SAMPLES: usize = 2_000_000;

/// The least number of frames for which a live page chooses its particles.
pub(crate) const LIVE_FRAMES: usize = 60;

/// The number of samples (a particle in a frame) that fit into a page. Each sample needs at most five bytes; the
/// largest observed size is four bytes.
const SAMPLES: f64 = (MAX_PAGE_BYTES - 2_000_000) as f64 / 5.0;

/// The data for the scripts.
#[derive(Serialize)]
struct PageData<'a> {
    maps: FieldColourMaps,
    runs: Vec<PageRun<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    live: Option<&'a Value>,
}

/// The data of a run for the scripts.
#[derive(Serialize)]
struct PageRun<'a> {
    name: &'a str,
    title: &'a str,
    until: f64,
    stage: Option<PageScene<'a>>,
    reel: Option<Animation>,
    /// Remarks on frames that cannot be read.
    #[serde(skip)]
    lost_frames: Vec<String>,
    tables: Vec<TablePlots>,
    checks: Vec<CheckPlot>,
    answers: Vec<RaoPlot<'a>>,
}

/// The geometry of a scene for the scripts.
#[derive(Serialize)]
struct PageScene<'a> {
    dimension: usize,
    dp: f64,
    level: f64,
    rho0: f64,
    g: f64,
    ends: &'a [(usize, f64)],
    solids: Vec<PageSolid<'a>>,
    ties: &'a [Tie],
    gauges: Vec<PageGauge<'a>>,
}

#[derive(Serialize)]
struct PageSolid<'a> {
    name: &'a str,
    role: &'a str,
    lines: &'a [Outline],
}

#[derive(Serialize)]
struct PageGauge<'a> {
    name: &'a str,
    what: &'a str,
    at: &'a [f64],
}

impl<'a> From<&'a SceneGeometry> for PageScene<'a> {
    fn from(set: &'a SceneGeometry) -> Self {
        let solids = set.solids.iter().map(|s| PageSolid { name: &s.name, role: s.role, lines: &s.lines }).collect();
        let gauges = set.gauges().map(|(name, what, at)| PageGauge { name, what, at }).collect();
        let SceneGeometry { dimension, dp, level, rho0, g, ref ends, ref ties, .. } = *set;
        Self { dimension, dp, level, rho0, g, ends, solids, ties, gauges }
    }
}

/// Returns the page of `runs`, and remarks on frames that cannot be read.
pub(crate) fn page_html(runs: &[RunData]) -> (String, Vec<String>) {
    let mut samples = SAMPLES;
    loop {
        let (text, remarks) = page_with_samples(runs, (samples / runs.len() as f64) as usize, None);
        if text.len() <= MAX_PAGE_BYTES || samples < 1e4 {
            return (text, remarks);
        }
        samples *= 0.9 * MAX_PAGE_BYTES as f64 / text.len() as f64;
    }
}

/// Returns the page of a `run` in progress, whose scripts find `live` in their data.
pub(crate) fn live_page_html(run: &RunData, live: &Value) -> String {
    page_with_samples(std::slice::from_ref(run), LIVE_SAMPLES, Some(live)).0
}

/// Returns the page with about `samples` samples for each run, and remarks on frames that cannot be read; it is a live page if it
/// has `live` data.
fn page_with_samples(runs: &[RunData], samples: usize, live: Option<&Value>) -> (String, Vec<String>) {
    let mut blob = BinaryData::default();
    let mut told = PageData { maps: FIELD_COLOUR_MAPS, runs: Vec::new(), live };
    let expected = if live.is_some() { LIVE_FRAMES } else { 0 };
    for run in runs {
        let reel = run.frames.as_ref().map(|film| encode_animation(run, film, samples, expected, &mut blob));
        let (reel, lost_frames) = match reel.transpose() {
            Ok(reel) => reel.map_or((None, Vec::new()), |(reel, lost)| (Some(reel), lost)),
            Err(why) => (None, vec![format!("no frame is shown: {}", why.message)]),
        };
        told.runs.push(PageRun {
            name: &run.name,
            title: &run.manifest.title,
            until: run.manifest.until_s,
            stage: run.geometry.as_ref().map(PageScene::from),
            reel,
            lost_frames,
            tables: run.tables.iter().map(|table| charts::encode_table(table, &mut blob)).collect(),
            checks: charts::encode_checks(run, sections::caption, &mut blob),
            answers: charts::encode_raos(&run.statistics.raos, &mut blob),
        });
    }
    let data = serde_json::to_string(&told).unwrap_or_default().replace('<', "\\u003c");
    let (title, body) = match runs {
        [run] => (run.manifest.title.clone(), single_run(run, &told.runs[0], live.is_some())),
        _ => (format!("{} runs compared", runs.len()), comparison(runs, &told.runs)),
    };
    let parts = [
        ("{{title}}", escape(&title)),
        ("{{style}}", STYLE.concat() + live.map_or("", |_| LIVE_STYLE)),
        ("{{body}}", body),
        ("{{version}}", env!("CARGO_PKG_VERSION").to_string()),
        ("{{script}}", SCRIPT.join("\n") + live.map_or("", |_| LIVE_SCRIPT)),
        ("{{data}}", data),
        ("{{blob}}", blob.to_base64()),
    ];
    // The placeholders are replaced in order from the front, so that text of the user is never searched for a
    // placeholder.
    let frame = if live.is_some() { FRAME.replace(ALONE, LIVE) } else { FRAME.into() };
    let (mut text, mut rest) = (String::new(), frame.as_str());
    for (sign, part) in parts {
        let (before, after) = rest.split_once(sign).unwrap_or((rest, ""));
        text += before;
        text += &part;
        rest = after;
    }
    (text + rest, told.runs.into_iter().flat_map(|run| run.lost_frames).collect())
}

fn section(id: &str, title: &str, body: &str) -> String {
    if body.is_empty() {
        return String::new();
    }
    format!(
        "<section id=\"{id}\" aria-labelledby=\"{id}-title\">\n<h2 id=\"{id}-title\">{title}</h2>\n{body}</section>\n"
    )
}

/// Returns the HTML of the players.
fn player_html(told: &[PageRun]) -> String {
    let reels: Vec<(&str, &Animation)> = told.iter().filter_map(|run| Some((run.name, run.reel.as_ref()?))).collect();
    let remark = |text: &String| format!("<p class=\"quiet\">{}</p>\n", escape(text));
    let lost: String = told.iter().flat_map(|run| &run.lost_frames).map(remark).collect();
    if reels.is_empty() && !lost.is_empty() {
        return lost;
    }
    if reels.is_empty() {
        return "<p>No frames were kept of this run (<code>[frames]</code> in the scene), so there is nothing to play.</p>\n".into();
    }
    let notes: String = reels
        .iter()
        .map(|(name, reel)| {
            let name = if told.len() > 1 { format!("{}: ", escape(name)) } else { String::new() };
            format!("<p class=\"quiet\">{name}{}</p>\n", sections::animation_note(reel))
        })
        .collect();
    format!("<div id=\"deck\"></div>\n{notes}{lost}")
}

fn single_run(run: &RunData, told: &PageRun, live: bool) -> String {
    let figures = summary_tables::summary_rows(&run.tables);
    let held = sections::verdicts(std::slice::from_ref(run));
    let charts = |id: &str, any: bool| if any { format!("<div id=\"{id}\"></div>\n") } else { String::new() };
    let state = if live { "<div id=\"live\"></div>\n".into() } else { sections::failure(&run.manifest) };
    sections::page_head(run, live)
        + &state
        + &sections::warnings(std::slice::from_ref(run))
        + &section("player", "Player", &player_html(std::slice::from_ref(told)))
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
            &if figures.len() > 1 { sections::scrolling_table(&figures) + WAVES } else { String::new() },
        )
        + &section("what", "What was run", &sections::scene_and_values(run))
        + &section("files", "Files", &sections::files(run))
}

const WAVES: &str = "<p class=\"quiet\">Waves are counted between crossings of the mean upwards; one counts if it goes a tenth of the \
    standard deviation to both sides. Means are over time. Entries of a budget or a balance that are 0 throughout are left out.</p>\n";

fn comparison(runs: &[RunData], told: &[PageRun]) -> String {
    let names: Vec<String> = runs.iter().map(|run| escape(&run.name)).collect();
    let any = |id: &str, any: bool| if any { format!("<div id=\"{id}\"></div>\n") } else { String::new() };
    format!("<p class=\"over\">pontoon · comparison</p>\n<h1>{}</h1>\n", names.join(" · "))
        + &section("runs", "The runs", &sections::facts_table(runs))
        + &sections::warnings(runs)
        + &section("player", "Players, at equal times and colours", &player_html(told))
        + &section("differences", "What differs", &sections::differences(runs))
        + &section(
            "checks",
            "Against references",
            &(sections::verdicts(runs) + &any("held", told.iter().any(|run| !run.checks.is_empty()))),
        )
        + &section(
            "series",
            "Series",
            &(sections::missing_series(runs) + &any("charts", told.iter().any(|run| !run.tables.is_empty()))),
        )
}
