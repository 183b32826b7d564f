//! The texts that are printed: at the start, at the end, for `scenes`.

use std::fmt::Write;

use crate::{
    analysis::{Verdict, format_verdicts},
    math::format::{bytes, duration, metric_prefix, without_control},
    output::manifest::{FrameTotals, RunStatus},
    run::{FinalBodyState, RunOutcome, RunStart},
};

use super::scene_lookup::BundledSceneInfo;

/// A table with its columns aligned, two spaces in; the first row is its header.
pub fn table(rows: &[Vec<String>]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |i: usize| rows.iter().filter_map(|r| r.get(i)).map(|x| x.chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut text = String::new();
    for row in rows {
        let cells = row.iter().zip(&widths).map(|(x, &w)| format!("{x:w$}"));
        text += &format!("  {}", cells.collect::<Vec<_>>().join("  "));
        text.truncate(text.trim_end().len());
        text.push('\n');
    }
    text
}

/// A number of threads as a user says it.
pub fn threads(n: usize) -> String {
    if n == 1 { "1 thread".into() } else { format!("{n} threads") }
}

/// How many warnings there are, if there are any.
pub fn warnings(count: usize) -> Option<String> {
    match count {
        0 => None,
        1 => Some("1 warning".into()),
        n => Some(format!("{n} warnings")),
    }
}

/// Said when a run begins.
pub fn start_text(start: &RunStart) -> String {
    let (manifest, count) = (start.manifest, start.manifest.particles);
    let mut text = format!("{}\n", without_control(&manifest.title));
    for warning in &manifest.warnings {
        let _ = writeln!(text, "warning: {warning}");
    }
    for note in &manifest.notes {
        let _ = writeln!(text, "note: {note}");
    }
    for name in start.renamed {
        let _ = writeln!(text, "note: {name}");
    }
    let _ = writeln!(
        text,
        "{} water and {} boundary particles, {}, results in {}",
        count.fluid,
        count.boundary,
        manifest.workers(),
        start.folder.display()
    );
    text
}

/// Said when a run ends.
pub fn end_text(outcome: &RunOutcome) -> String {
    let manifest = &outcome.manifest;
    let how = match manifest.status {
        RunStatus::Finished => "finished",
        RunStatus::Interrupted => "interrupted",
        RunStatus::Running | RunStatus::Failed => "failed",
    };
    let mut text = format!("\n{}: {how}\n", without_control(&manifest.title));
    text += &table(&[
        vec![
            "simulated".into(),
            format!("{:.6} of {} s in {} steps", manifest.simulated_s, manifest.until_s, manifest.steps),
        ],
        vec![
            "wall time".into(),
            format!(
                "{} with {}, {} of {}",
                duration(manifest.wall_s),
                manifest.workers(),
                duration(manifest.cpu_s),
                if manifest.ranks.is_some() { "the first rank's processors" } else { "processors" }
            ),
        ],
        vec!["speed".into(), format!("{} particle-steps/s", metric_prefix(manifest.particle_steps_per_second))],
    ]);
    if let Some(ranks) = manifest.ranks {
        let (share, size) = (100.0 * ranks.time_share, bytes(ranks.received_bytes as f64));
        let _ = writeln!(text, "\nthe first rank exchanged data for {share:.0} % of the time, and received {size}");
    }
    if manifest.removed > 0 {
        let what = if manifest.removed == 1 { "particle" } else { "particles" };
        let _ = writeln!(text, "\n{} water {what} left the domain and went: removed.csv", manifest.removed);
    }
    if !outcome.bodies.is_empty() {
        let _ = write!(text, "\n{}", bodies(&outcome.bodies));
    }
    if !manifest.checks.is_empty() {
        let _ = write!(text, "\n{}", checks(&manifest.checks));
    }
    let _ = writeln!(text, "\nfiles in {}", outcome.folder.display());
    for file in &manifest.files {
        let _ = writeln!(text, "  {file}");
    }
    match manifest.frames {
        FrameTotals { count: 0, .. } => {}
        FrameTotals { count: 1, bytes: size } => text += &format!("  1 frame, {}, in frames/\n", bytes(size as f64)),
        FrameTotals { count, bytes: size } => {
            text += &format!("  {count} frames, {}, in frames/\n", bytes(size as f64))
        }
    }
    if manifest.status == RunStatus::Interrupted {
        let _ = writeln!(text, "\ngo on with: pontoon resume {}", outcome.folder.display());
    } else if manifest.files.iter().any(|file| file.starts_with("series/")) {
        let _ = writeln!(text, "means, waves, spectra: pontoon stats {}", outcome.folder.display());
    }
    text
}

fn bodies(bodies: &[FinalBodyState]) -> String {
    let axes = ["x", "y", "z"].iter().take(bodies[0].position.len()).map(|a| format!("{a} (m)"));
    let mut rows = vec![vec!["body".to_string()]];
    rows[0].extend(axes.chain(["speed (m/s)".into(), "turn (deg)".into()]));
    for body in bodies {
        let mut row = vec![body.name.clone()];
        row.extend(body.position.iter().map(|x| format!("{x:.4}")));
        row.push(format!("{:.4}", body.speed));
        row.push(body.rotation_deg.iter().map(|x| format!("{x:.2}")).collect::<Vec<_>>().join(" "));
        rows.push(row);
    }
    table(&rows)
}

fn checks(checks: &[Verdict]) -> String {
    let all: Vec<(&[String], &Verdict)> = checks.iter().map(|v| (&[][..], v)).collect();
    table(&format_verdicts::verdict_rows(&all, &[]))
}

/// What `scenes` prints.
pub fn scene_list(scenes: &[BundledSceneInfo]) -> String {
    let mut text = String::new();
    for scene in scenes {
        let place = scene.folder.as_ref().map_or("built in".into(), |folder| folder.display().to_string());
        let _ = writeln!(text, "{}  ({place})\n  {}", scene.name, scene.title);
        if !scene.about.is_empty() {
            let _ = writeln!(text, "  {}", scene.about);
        }
    }
    text + "\nrun one with: pontoon run NAME\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_aligned() {
        let rows = [["a", "b"], ["long", "x"]].map(|r| r.map(String::from).to_vec());
        assert_eq!(table(&rows), "  a     b\n  long  x\n");
    }
}
