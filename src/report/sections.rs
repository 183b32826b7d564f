//! Creates the text and tables of a page, which are readable without scripts and in print.

use std::{fs, time::SystemTime};

use super::{
    animation::Animation,
    html::{escape, table},
    run_data::{ProbeTable, RunData},
    summary_tables,
};
use crate::{
    analysis::{Verdict, format_verdicts},
    math::format::{bytes, duration, four_digits, thousands, with_minus_sign},
    output::{Manifest, manifest::RunStatus},
};

/// Returns the state of a run as text, and the CSS class of its badge.
pub(crate) fn status_badge(manifest: &Manifest) -> (&'static str, &'static str) {
    match manifest.status {
        RunStatus::Finished if manifest.checks.iter().any(|check| check.passed == Some(false)) => {
            ("finished, a check is missed", "bad")
        }
        RunStatus::Finished => ("finished", "good"),
        RunStatus::Interrupted => ("interrupted", "odd"),
        RunStatus::Failed => ("failed", "bad"),
        RunStatus::Running => ("unfinished", "odd"),
    }
}

/// Returns the date and time, UTC.
fn date(time: SystemTime) -> String {
    let text = humantime::format_rfc3339_seconds(time).to_string();
    text.replace('T', " ").trim_end_matches('Z').chars().take(16).collect::<String>() + " UTC"
}

/// Returns the facts below the title, each as a label and a value.
pub(crate) fn facts(run: &RunData) -> Vec<(&'static str, String)> {
    let m = &run.manifest;
    let mut facts = Vec::new();
    if let Some(set) = &run.geometry {
        facts.push(("Spacing", format!("dp = {} m, {}-D", set.dp, set.dimension)));
    }
    let count = m.particles;
    facts.push((
        "Particles",
        format!("{} water, {} boundary", thousands(count.fluid as u64), thousands(count.boundary as u64)),
    ));
    let reached = if m.simulated_s < m.until_s { format!("{} of ", four_digits(m.simulated_s)) } else { String::new() };
    facts.push(("Simulated", format!("{reached}{} s in {} steps", m.until_s, thousands(m.steps))));
    facts.push(("Wall time", format!("{}, {}", duration(m.wall_s), m.workers())));
    facts.extend(run.written.map(|time| ("Written", date(time))));
    facts.push(("Program", program_version(m)));
    facts
}

/// Returns the version and commit of the program.
fn program_version(m: &Manifest) -> String {
    match &m.commit {
        Some(commit) => format!("pontoon {}, commit {commit}", m.version),
        None => format!("pontoon {}", m.version),
    }
}

/// Returns the header of a page of one run. A `live` page shows the progress itself.
pub(crate) fn page_head(run: &RunData, live: bool) -> String {
    let (word, class) = status_badge(&run.manifest);
    let mut facts = facts(run);
    facts.retain(|(label, _)| !live || !["Simulated", "Wall time"].contains(label));
    let facts = facts.iter().map(|(k, x)| format!("<div><dt>{k}</dt><dd>{}</dd></div>", escape(x))).collect::<String>();
    format!(
        "<p class=\"over\">pontoon · {}</p>\n<h1>{}</h1>\n<p><span class=\"badge {class}\">{word}</span></p>\n\
         <dl class=\"facts\">{facts}</dl>\n",
        escape(&run.name),
        escape(&run.manifest.title)
    )
}

/// Returns the reason for the early end of a run, with the report on the particle or body.
pub(crate) fn failure(m: &Manifest) -> String {
    let reached = format!("It reached t = {} s of {} s.", four_digits(m.simulated_s), m.until_s);
    let said = match m.status {
        RunStatus::Finished => return String::new(),
        RunStatus::Running => {
            format!("<strong>This run has not finished: it still goes on, or was killed.</strong> {reached}")
        }
        RunStatus::Interrupted => {
            format!("<strong>This run was interrupted.</strong> {reached} <code>pontoon resume</code> goes on with it.")
        }
        RunStatus::Failed => {
            let why = escape(m.error.as_deref().unwrap_or("no reason is kept"));
            format!("<strong>This run could not go on.</strong> {reached}<pre>{why}</pre>")
        }
    };
    let fault = m.fault.as_ref().and_then(|fault| fault.as_object()).map_or(String::new(), |fault| {
        let rows = fault.iter().map(|(key, value)| {
            let value = value.as_str().map_or_else(|| value.to_string(), String::from);
            format!("<tr><th scope=\"row\">{}</th><td>{}</td></tr>", escape(key), escape(&value))
        });
        format!("<table>{}</table>", rows.collect::<String>())
    });
    format!("<div class=\"note bad\" role=\"alert\"><p>{said}</p>{fault}</div>\n")
}

/// Returns the warnings of the runs with the remarks of the page, the notes on their files, and their events.
pub(crate) fn warnings(runs: &[RunData]) -> String {
    let shown = |title: &str, class: &str, of: fn(&RunData) -> Vec<&String>| {
        let items = runs.iter().flat_map(|run| {
            let name = if runs.len() > 1 { format!("{}: ", run.name) } else { String::new() };
            of(run).into_iter().map(move |text| format!("<li>{}</li>", escape(&format!("{name}{text}"))))
        });
        match items.collect::<String>() {
            items if items.is_empty() => items,
            items => format!("<div class=\"{class}\"><p><strong>{title}</strong></p><ul>{items}</ul></div>\n"),
        }
    };
    shown("Warnings", "note odd", |run| run.manifest.warnings.iter().chain(&run.remarks).collect())
        + &shown("Notes", "note", |run| run.manifest.notes.iter().collect())
        + &shown("Events", "note", |run| run.manifest.events.iter().collect())
}

/// Returns the numbers of a verdict as a caption.
pub(crate) fn caption(verdict: &Verdict) -> String {
    let rows = format_verdicts::verdict_rows(&[(&[], verdict)], &[]);
    let figures = rows[0].iter().zip(&rows[1]).skip(1).filter(|(_, figure)| !figure.is_empty() && *figure != "–");
    let said: Vec<String> = figures.map(|(head, figure)| format!("{head} {figure}").trim().to_string()).collect();
    with_minus_sign(&said.join("; "))
}

/// Returns a table that scrolls horizontally on a narrow page.
pub(crate) fn scrolling_table(rows: &[Vec<String>]) -> String {
    format!("<div class=\"wide\" tabindex=\"0\">{}</div>\n", table(rows))
}

/// Returns the verdicts of all runs.
pub(crate) fn verdicts(runs: &[RunData]) -> String {
    let names: Vec<[String; 1]> = runs.iter().map(|run| [run.name.clone()]).collect();
    let several = runs.len() > 1;
    let pairs: Vec<(&[String], &Verdict)> = runs
        .iter()
        .zip(&names)
        .flat_map(|(run, name)| {
            let before: &[String] = if several { name } else { &[] };
            run.manifest.checks.iter().map(move |verdict| (before, verdict))
        })
        .collect();
    if pairs.is_empty() {
        let waiting = runs.iter().any(|run| !run.checks.is_empty());
        return if waiting { "<p>Checks are judged when a run has finished.</p>\n".into() } else { String::new() };
    }
    let said = "<p class=\"quiet\">N is the relative deviation (0 is perfect), M the ratio of the amplitudes (1 is perfect).</p>\n";
    scrolling_table(&format_verdicts::verdict_rows(&pairs, if several { &["run"] } else { &[] })) + said
}

/// Returns the statistics of the series that the scene requests, or an empty text without requests.
pub fn statistics(run: &RunData) -> String {
    let mut rows =
        vec![["statistic", "series", "figure", "value", "unit", "from, s", "until, s"].map(String::from).to_vec()];
    rows.extend(run.statistics.rows.iter().filter(|row| !row.name.is_empty()).map(|row| {
        let [from, until] = [row.from_s, row.until_s].map(|t| format!("{t:.3}"));
        let [name, series, unit] = [&row.name, &row.series, &row.unit].map(String::clone);
        vec![name, series, row.quantity.into(), four_digits(row.value), unit, from, until]
    }));
    let remarks = run.statistics.remarks.iter().map(|remark| format!("<p class=\"quiet\">{}</p>\n", escape(remark)));
    let table = if rows.len() > 1 { scrolling_table(&rows) } else { String::new() };
    table + &remarks.collect::<String>()
}

/// Returns the energies and the energy budget, or an empty text if the run has no such table.
pub(crate) fn energy(run: &RunData) -> String {
    let budgets = run
        .tables
        .iter()
        .filter_map(|table| summary_tables::energy_summary(table).or_else(|| summary_tables::budget_summary(table)));
    budgets
        .map(|(verdict_rows, one_line)| format!("{}<p>{}</p>\n", scrolling_table(&verdict_rows), escape(&one_line)))
        .collect()
}

/// Returns the text of the scene, all parameter values of the run, and the machine.
pub(crate) fn scene_and_values(run: &RunData) -> String {
    let m = &run.manifest;
    let machine = &m.machine;
    let rows = [
        ("scene", run.manifest.title.clone()),
        ("changed on the command line", m.set.iter().map(|(k, v)| format!("{k} = {v}")).collect::<Vec<_>>().join(", ")),
        ("program", program_version(m)),
        ("bodies moved by", m.engine.clone()),
        ("processor", format!("{}, {} processors", machine.processor, machine.cpus)),
        ("instructions", machine.instructions.clone().unwrap_or_else(|| "no lanes".into())),
        ("system", format!("{}, {}", machine.os, machine.arch)),
        (if m.ranks.is_some() { "processor time of the first rank" } else { "processor time" }, duration(m.cpu_s)),
        (
            "particle-steps",
            format!("{}, {:.2} million a second", thousands(m.particle_steps), m.particle_steps_per_second / 1e6),
        ),
    ];
    let rows: String = rows
        .iter()
        .filter(|(_, x)| !x.is_empty())
        .map(|(k, x)| format!("<tr><th scope=\"row\">{k}</th><td>{}</td></tr>\n", escape(x)))
        .collect();
    let mut values = vec![["key", "value", "said by"].map(String::from).to_vec()];
    values.extend(m.values.iter().map(|v| vec![v.key.clone(), v.value.clone(), v.source.clone()]));
    format!(
        "<div class=\"wide\"><table>{rows}</table></div>\n<details><summary>The scene as written</summary><pre tabindex=\"0\">{}</pre></details>\n\
         <details><summary>All {} effective values and their sources</summary>{}</details>\n",
        escape(&run.scene_text),
        m.values.len(),
        scrolling_table(&values)
    )
}

/// Returns the paths of the files of the run.
pub(crate) fn files(run: &RunData) -> String {
    let folder = run.folder.canonicalize().unwrap_or_else(|_| run.folder.clone());
    let mut rows = vec![["file", "size"].map(String::from).to_vec()];
    for file in &run.manifest.files {
        let size = fs::metadata(run.folder.join(file))
            .map_or("–".into(), |f| if f.is_dir() { String::new() } else { bytes(f.len() as f64) });
        rows.push(vec![file.clone(), size]);
    }
    if let Some(film) = &run.frames {
        let count = film.times().len();
        rows.push(vec![
            format!("frames/ ({count} frames)"),
            format!("about {}", bytes((film.bytes(count / 2) * count as u64) as f64)),
        ]);
    }
    format!("<p>In <code>{}</code>:</p>\n{}", escape(&folder.display().to_string()), scrolling_table(&rows))
}

/// Returns a note on the shown and omitted parts of an animation.
pub(crate) fn animation_note(reel: &Animation) -> String {
    let [frames, particles] = reel.of;
    let kept = (reel.times.len(), reel.counts.first().copied().unwrap_or(0));
    let mut said = if kept.0 == frames {
        format!("All {frames} frames")
    } else {
        format!("{} of {frames} frames, evenly spread", kept.0)
    };
    said += &if reel.apart > 1 {
        format!(
            ", and of {} water particles {}, about {} dp apart",
            thousands(particles as u64),
            thousands(kept.1 as u64),
            reel.apart
        )
    } else {
        format!(" with all {} water particles", thousands(particles as u64))
    };
    // If particles enter thinned water, each frame shows other particles.
    said += match reel.alone.iter().skip(1).any(|alone| *alone) {
        true => ". The player shows one frame after the other, as they have different particles",
        false => ". Between two frames the player moves particles in straight lines",
    };
    said + ". Places are rounded to 1/48 dp, values to about 1/600 of their usual range; frames.pvd has all of it."
}

/// Returns the differences between the parameter values of several runs, with a row for each key.
pub(crate) fn differences(runs: &[RunData]) -> String {
    let mut keys: Vec<&str> = Vec::new();
    for value in runs.iter().flat_map(|run| &run.manifest.values) {
        if !keys.contains(&value.key.as_str()) {
            keys.push(&value.key);
        }
    }
    let value = |run: &RunData, key: &str| {
        run.manifest.values.iter().find(|v| v.key == key).map_or("–".to_string(), |v| v.value.clone())
    };
    let mut rows =
        vec![std::iter::once("key".to_string()).chain(runs.iter().map(|run| run.name.clone())).collect::<Vec<_>>()];
    for key in keys {
        let cells: Vec<String> = runs.iter().map(|run| value(run, key)).collect();
        if cells.iter().any(|cell| *cell != cells[0]) {
            rows.push(std::iter::once(key.to_string()).chain(cells).collect());
        }
    }
    if rows.len() == 1 {
        return "<p>All effective values are the same.</p>\n".into();
    }
    scrolling_table(&rows)
}

/// Returns the names of the runs that have the table `table` and, if given, the column `column`.
fn runs_with_series<'a>(runs: &'a [RunData], table: &str, column: Option<&str>) -> Vec<&'a str> {
    let holds =
        |t: &ProbeTable| t.name == table && column.is_none_or(|column| t.columns.iter().any(|own| own == column));
    runs.iter().filter(|run| run.tables.iter().any(holds)).map(|run| run.name.as_str()).collect()
}

/// Returns whether there are several runs and they have no common series.
pub(crate) fn no_common_series(runs: &[RunData]) -> bool {
    let common = |t: &ProbeTable| {
        t.columns.iter().any(|column| runs_with_series(runs, &t.name, Some(column)).len() == runs.len())
    };
    runs.len() > 1 && !runs[0].tables.iter().any(common)
}

/// Returns the series that some runs lack, with the runs that have each series, or an empty text if all runs have all
/// series.
pub(crate) fn missing_series(runs: &[RunData]) -> String {
    let mut groups: Vec<(Vec<&str>, Vec<String>)> = Vec::new();
    for table in runs.iter().flat_map(|run| &run.tables) {
        let whole = (table.name.clone(), runs_with_series(runs, &table.name, None));
        let column =
            |name: &String| (format!("{}.{name}", table.name), runs_with_series(runs, &table.name, Some(name)));
        let all =
            if whole.1.len() < runs.len() { vec![whole] } else { table.columns.iter().map(column).collect::<Vec<_>>() };
        for (name, who) in all.into_iter().filter(|(_, who)| who.len() < runs.len()) {
            match groups.iter_mut().find(|group| group.0 == who) {
                Some((_, names)) if names.contains(&name) => {}
                Some((_, names)) => names.push(name),
                None => groups.push((who, vec![name])),
            }
        }
    }
    let said: Vec<String> =
        groups.iter().map(|(who, names)| format!("only in {}: {}", who.join(", "), names.join(", "))).collect();
    match said.is_empty() {
        true => String::new(),
        false => format!("<p class=\"quiet\">Not every run has every series; {}.</p>\n", escape(&said.join("; "))),
    }
}

/// Returns the facts of several runs side by side.
pub(crate) fn facts_table(runs: &[RunData]) -> String {
    let all: Vec<Vec<(&str, String)>> = runs
        .iter()
        .map(|run| {
            let mut facts =
                vec![("Title", run.manifest.title.clone()), ("State", status_badge(&run.manifest).0.to_string())];
            facts.extend(self::facts(run));
            facts.push(("Folder", run.folder.display().to_string()));
            facts
        })
        .collect();
    let mut rows =
        vec![std::iter::once(String::new()).chain(runs.iter().map(|run| run.name.clone())).collect::<Vec<_>>()];
    for (key, _) in all.iter().max_by_key(|facts| facts.len()).into_iter().flatten() {
        let cell = |facts: &Vec<(&str, String)>| {
            facts.iter().find(|(k, _)| k == key).map_or(String::new(), |(_, x)| x.clone())
        };
        rows.push(std::iter::once(key.to_string()).chain(all.iter().map(cell)).collect());
    }
    scrolling_table(&rows)
}
