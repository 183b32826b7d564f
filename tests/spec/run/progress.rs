//! Progress of a run: the reported energy drift, from the latest reading of a probe.

use std::path::Path;

use pontoon::{
    Result,
    output::SeriesTable,
    run::{self, EnergyDrift, Progress, RunOptions},
};

use crate::common::TestFolder;

/// A box released half a draft above equilibrium, which moves the water within a few steps.
const SCENE: &str = r#"
dimension = 2
dp = 0.05
until = 0.1
frames = "off"
[[water]]
fill = { box = { min = [0.0, 0.0], max = [1.0, 0.4] } }
[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [1.0, 0.8] } }
[[solid]]
name = "box"
shape = { box = { size = [0.3, 0.2] } }
at = { x = 0.5, bottom = 0.35 }
free = { density = 500.0 }
"#;

/// A folder with the scene and the sections `more`.
fn scene_folder(name: &str, more: &str) -> TestFolder {
    TestFolder::with_scene(&format!("progress-{name}"), &format!("{SCENE}{more}"))
}

/// Runs the scene in `home` and returns the energy drift that each step reports.
fn energy_drifts(home: &Path) -> Result<Vec<Option<EnergyDrift>>> {
    let mut drifts = Vec::new();
    let options = RunOptions { out: Some(home.join("run")), threads: Some(1), ..RunOptions::default() };
    run::run(&home.join("scene.toml"), &options, &mut |now: &Progress| {
        drifts.push(now.energy);
        true
    })?;
    Ok(drifts)
}

fn table(home: &Path, name: &str) -> SeriesTable {
    SeriesTable::read(&home.join(format!("run/series/{name}.csv"))).unwrap()
}

/// The numbers of row `i`.
fn row(table: &SeriesTable, i: usize) -> Vec<f64> {
    table.values.iter().map(|x| x[i]).collect()
}

#[test]
fn a_run_with_a_budget_reports_its_relative_energy_residual() -> Result<()> {
    // The budget takes precedence over the energy probe.
    let home = scene_folder("budget", "[[probe]]\nenergy = true\n[[probe]]\nbudget = true\nevery = 1e-9\n");
    let drifts = energy_drifts(&home)?;
    let budget = table(&home, "budget");
    let residual = budget.columns.len() - 1;
    assert!(budget.columns[residual].starts_with("residual_J"));
    let share = |i: usize| {
        let row = row(&budget, i);
        EnergyDrift::Unaccounted(row[residual].abs() / row[1..residual].iter().map(|x| x.abs()).sum::<f64>())
    };
    // The probe reads at every step, so each report equals the reading of its step. Without any energy transfer there is no report.
    assert_eq!(drifts.len(), budget.times.len());
    assert_eq!(drifts[0], None);
    assert!((1..drifts.len()).all(|i| drifts[i] == Some(share(i))), "{drifts:?}");
    Ok(())
}

#[test]
fn a_run_without_a_budget_reports_its_energy_change_and_one_without_energy_probes_reports_nothing() -> Result<()> {
    let with = scene_folder("energy", "[[probe]]\nenergy = true\nevery = 1e-9\n");
    let drifts = energy_drifts(&with)?;
    let energy = table(&with, "energy");
    let total = energy.values.last().unwrap();
    let change = |i: usize| Some(EnergyDrift::Changed(total[i] - total[0], "J/m"));
    assert_eq!(drifts.len(), energy.times.len());
    assert!((0..drifts.len()).all(|i| drifts[i] == change(i)), "{drifts:?}");
    let without = scene_folder("neither", "[[probe]]\nmotion = \"box\"\n");
    assert!(energy_drifts(&without)?.iter().all(Option::is_none));
    Ok(())
}

#[test]
fn a_resumed_run_reports_the_energy_change_since_its_start() -> Result<()> {
    let home = scene_folder("resumed", "[[probe]]\nenergy = true\nevery = 1e-9\n");
    let options = RunOptions { out: Some(home.join("run")), threads: Some(1), ..RunOptions::default() };
    run::run(&home.join("scene.toml"), &options, &mut |now: &Progress| now.time < 0.05)?;
    let mut first = None;
    run::resume(&home.join("run"), &[], Some(1), &mut |now: &Progress| {
        first.get_or_insert((now.time, now.energy));
        true
    })?;
    let energy = table(&home, "energy");
    let total = energy.values.last().unwrap();
    let (time, drift) = first.unwrap();
    let i = energy.times.iter().position(|t| *t == time).unwrap();
    assert!(i > 3, "the interruption is not at the start");
    assert_eq!(drift, Some(EnergyDrift::Changed(total[i] - total[0], "J/m")));
    Ok(())
}
