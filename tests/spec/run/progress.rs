//! What is told of a run while it goes on: of its energy, by the latest reading of a probe.

use std::path::Path;

use pontoon::{
    Result,
    output::SeriesTable,
    run::{self, EnergyDrift, Progress, RunOptions},
};

use crate::common::TestFolder;

/// A box dropped by half a draft, which moves the water within a few steps.
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

/// A folder with the scene and `more` words of it.
fn home(name: &str, more: &str) -> TestFolder {
    TestFolder::with_scene(&format!("progress-{name}"), &format!("{SCENE}{more}"))
}

/// Runs the scene in `home`; what was told of the energy at each step.
fn told(home: &Path) -> Result<Vec<Option<EnergyDrift>>> {
    let mut told = Vec::new();
    let options = RunOptions { out: Some(home.join("run")), threads: Some(1), ..RunOptions::default() };
    run::run(&home.join("scene.toml"), &options, &mut |now: &Progress| {
        told.push(now.energy);
        true
    })?;
    Ok(told)
}

fn table(home: &Path, name: &str) -> SeriesTable {
    SeriesTable::read(&home.join(format!("run/series/{name}.csv"))).unwrap()
}

/// The numbers of row `i`.
fn row(table: &SeriesTable, i: usize) -> Vec<f64> {
    table.values.iter().map(|x| x[i]).collect()
}

#[test]
fn a_run_tells_the_share_of_its_energy_that_its_budget_cannot_account_for() -> Result<()> {
    // A budget tells more than the energy beside it.
    let home = home("budget", "[[probe]]\nenergy = true\n[[probe]]\nbudget = true\nevery = 1e-9\n");
    let told = told(&home)?;
    let budget = table(&home, "budget");
    let residual = budget.columns.len() - 1;
    assert!(budget.columns[residual].starts_with("residual_J"));
    let share = |i: usize| {
        let row = row(&budget, i);
        EnergyDrift::Unaccounted(row[residual].abs() / row[1..residual].iter().map(|x| x.abs()).sum::<f64>())
    };
    // Read at every step: what is told is of that step, to the bit, and nothing before anything was turned over.
    assert_eq!(told.len(), budget.times.len());
    assert_eq!(told[0], None);
    assert!((1..told.len()).all(|i| told[i] == Some(share(i))), "{told:?}");
    Ok(())
}

#[test]
fn a_run_without_a_budget_tells_how_its_energy_changed_and_one_without_either_nothing() -> Result<()> {
    let with = home("energy", "[[probe]]\nenergy = true\nevery = 1e-9\n");
    let said = told(&with)?;
    let energy = table(&with, "energy");
    let total = energy.values.last().unwrap();
    let change = |i: usize| Some(EnergyDrift::Changed(total[i] - total[0], "J/m"));
    assert_eq!(said.len(), energy.times.len());
    assert!((0..said.len()).all(|i| said[i] == change(i)), "{said:?}");
    let without = home("neither", "[[probe]]\nmotion = \"box\"\n");
    assert!(told(&without)?.iter().all(Option::is_none));
    Ok(())
}

#[test]
fn a_resumed_run_tells_the_change_since_its_start() -> Result<()> {
    let home = home("resumed", "[[probe]]\nenergy = true\nevery = 1e-9\n");
    let options = RunOptions { out: Some(home.join("run")), threads: Some(1), ..RunOptions::default() };
    run::run(&home.join("scene.toml"), &options, &mut |now: &Progress| now.time < 0.05)?;
    let mut first = None;
    run::resume(&home.join("run"), &[], Some(1), &mut |now: &Progress| {
        first.get_or_insert((now.time, now.energy));
        true
    })?;
    let energy = table(&home, "energy");
    let total = energy.values.last().unwrap();
    let (time, said) = first.unwrap();
    let i = energy.times.iter().position(|t| *t == time).unwrap();
    assert!(i > 3, "it was interrupted on its way");
    assert_eq!(said, Some(EnergyDrift::Changed(total[i] - total[0], "J/m")));
    Ok(())
}
