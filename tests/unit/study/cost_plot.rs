//! Unit tests of `src/study/cost_plot.rs`.

use super::*;
use crate::analysis::ErrorMetrics;

fn job(name: &str, scene: &str, law: &str) -> Job {
    Job {
        name: name.into(),
        repeat: 1,
        scene: scene.into(),
        overrides: vec![(LAW.into(), law.into())],
        folder: name.into(),
        group: scene.into(),
        dp: 0.01,
        varied: vec![],
    }
}

fn row(run: &str, n: f64, cpu_s: f64, status: &'static str) -> ResultRow {
    let figures = ErrorMetrics { relative_l2: Some(n), ..ErrorMetrics::default() };
    ResultRow {
        run: run.into(),
        check: "force.fx_N".into(),
        metrics: figures,
        cpu_s: Some(cpu_s),
        status,
        ..ResultRow::default()
    }
}

#[test]
fn cases_of_a_scene_share_a_cost_plot() {
    let jobs = [job("column-1", "column", "none"), job("column-3", "column", "sps"), job("tank", "tank", "none")];
    let rows = [
        row("column-1", 0.5, 100.0, "finished"),
        row("column-3", 0.4, 150.0, "finished"),
        ResultRow { check: "force.fx_N (2)".into(), ..row("column-1", 0.5, 100.0, "finished") },
        ResultRow { check: "force.fx_N (2)".into(), ..row("column-3", 0.4, 150.0, "finished") },
        row("tank", 0.1, 2.0, "finished"),
    ];
    let text = cost_figures(&jobs, &rows);
    for word in ["column: N of force.fx_N", ">1<", ">3<", "model.viscosity = none", "model.viscosity = sps"] {
        assert!(text.contains(word), "\"{word}\" is not in\n{text}");
    }
    assert!(!text.contains("tank"), "a single case has no plot");
    assert_eq!(text.matches("<svg").count(), 1, "a second check of the series has the same N");
    assert!(!text.contains("aligned"), "a metric that no case has is not drawn");
}

#[test]
fn unfinished_runs_are_not_drawn() {
    let jobs = [job("column-1", "column", "none"), job("column-3", "column", "sps")];
    let rows = [row("column-1", 0.5, 100.0, "finished"), row("column-3", 0.4, 150.0, "failed")];
    assert!(cost_figures(&jobs, &rows).is_empty());
}
