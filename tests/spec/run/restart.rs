//! Restart: a run that is interrupted twice and resumed on other numbers of threads writes the files of an uninterrupted run, byte
//! for byte. The scenes in `restart/` cover all components with state.

use std::{f64::consts::PI, fs, path::Path};

use pontoon::{
    Result,
    model::Dimension,
    output::Checkpoint,
    run::{self, Progress, RunOptions},
    scene::Scene,
    simulation::Simulation,
    solid::Dim,
};

use crate::{common::TestFolder, run_files::assert_same_files};

/// Asserts that the scene `name` writes the same files without interruption and with two interruptions (s). Returns the folder of both
/// runs and the simulation at the second interruption, on which `enable` has switched on its budgets.
fn survives_restart<const D: usize>(
    name: &str,
    [first, second]: [f64; 2],
    enable: impl Fn(&mut Simulation<D>),
) -> Result<(TestFolder, Simulation<D>)>
where
    Dim<D>: Dimension<D>,
{
    let home = TestFolder::new(&format!("restart-{name}"));
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/spec/run/restart/{name}.toml"));
    let options = |out: &str| RunOptions { out: Some(home.join(out)), threads: Some(1), ..RunOptions::default() };
    run::run(&scene, &options("whole"), &mut |_: &Progress| true)?;
    let (whole, interrupted) = (home.join("whole"), home.join("interrupted"));
    run::run(&scene, &options("interrupted"), &mut |now: &Progress| now.time < first)?;
    run::resume(&interrupted, &[], Some(2), &mut |now: &Progress| now.time < second)?;
    run::resume(&interrupted, &[], Some(3), &mut |_: &Progress| true)?;
    assert_same_files(&whole, &interrupted, name);
    let mut sim = Simulation::new(Scene::read(&scene, &[])?.build::<D>()?.setup)?;
    enable(&mut sim);
    let saved = Checkpoint::read(&interrupted.join("checkpoint.bin"))?;
    sim.restore(&saved.state)?;
    assert!((second..second + 0.01).contains(&sim.time()), "the interruption is at {} s", sim.time());
    assert!(sim.save()? == saved.state, "a restored state saves to the same bytes");
    Ok((home, sim))
}

/// The text of a file of the uninterrupted run.
fn text(home: &TestFolder, name: &str) -> String {
    fs::read_to_string(home.join("whole").join(name)).unwrap()
}

#[test]
fn a_sea_with_absorption_damping_means_statistics_and_a_light_body_survives_a_restart() -> Result<()> {
    let (home, sim) = survives_restart("sea", [0.15, 0.3], Simulation::<2>::enable_energy_budget)?;
    assert!(sim.pending_impulse(2).norm() > 0.0, "the foam has a pending impulse");
    assert!(text(&home, "statistics.csv").contains("reflection"), "the statistics contain the reflection");
    Ok(())
}

#[test]
fn constraints_motors_stops_a_release_rebounds_and_budgets_survive_a_restart() -> Result<()> {
    let enable = |sim: &mut Simulation<2>| {
        sim.enable_energy_budget();
        sim.enable_load_breakdown();
    };
    let (home, sim) = survives_restart("ties", [0.15, 0.4], enable)?;
    let axle = sim.joint_reading(sim.find_joint("axle")?);
    let rows = text(&home, "series/axle.csv");
    let angle = rows.lines().last().and_then(|row| row.split(',').nth(4)).and_then(|x| x.parse::<f64>().ok());
    // 20 rad/s for 0.6 s are 688 degrees, less the acceleration phase. The table counts whole turns; the joint does not.
    assert!(axle.position.abs() <= PI && angle.is_some_and(|angle| angle > 540.0), "{axle:?}, {angle:?}");
    assert!(
        axle.absorbed_energy != 0.0 && sim.joint_reading(sim.find_joint("rail")?).absorbed_energy != 0.0,
        "the motors did work"
    );
    let pulled = |name: &str| {
        let rows = text(&home, &format!("series/{name}.csv"));
        let tension = |row: &str| row.rsplit(',').next().and_then(|x| x.parse::<f64>().ok());
        rows.lines().filter_map(tension).any(|x| x > 1.0)
    };
    assert!(pulled("leash") && pulled("line"), "rope and line are taut at some time");
    assert!(text(&home, "lists/contacts.csv").contains("lift,ball"), "the ball touches the lift");
    Ok(())
}

#[test]
fn a_three_dimensional_run_with_corrected_gradients_survives_a_restart() -> Result<()> {
    let enable = |sim: &mut Simulation<3>| {
        sim.enable_energy_budget();
        sim.enable_load_breakdown();
    };
    let (home, sim) = survives_restart("three", [0.1, 0.18], enable)?;
    assert!(sim.pending_impulse(2).norm() > 0.0, "the foam has a pending impulse");
    assert!(text(&home, "lists/contacts.csv").contains("foam,bob"), "the bob touches the foam");
    Ok(())
}

#[test]
fn periodic_water_with_particle_shifting_survives_a_restart() -> Result<()> {
    let (_, sim) = survives_restart::<2>("vortices", [0.1, 0.25], |_| ())?;
    assert_eq!(sim.system().fluid().len(), 400, "periodic images are not part of the water");
    Ok(())
}

#[test]
fn the_list_of_removed_particles_survives_a_restart() -> Result<()> {
    let (home, sim) = survives_restart("spill", [0.2, 0.4], Simulation::<2>::enable_energy_budget)?;
    let (then, all) = (sim.removed_particles().len(), text(&home, "removed.csv").lines().count() - 1);
    assert!(then > 0 && all > then, "{then} before the second interruption, {all} in all");
    assert!(sim.energy_budget().is_some_and(|budget| budget.removed != 0.0), "the removed particles had energy");
    Ok(())
}

#[test]
fn water_that_enters_and_leaves_survives_a_restart() -> Result<()> {
    let (home, sim) = survives_restart("stream", [0.2, 0.4], Simulation::<2>::enable_energy_budget)?;
    assert!(sim.system().face_exchange().iter().all(|face| face.entered + face.left > 50), "water passes both faces");
    assert!(text(&home, "series/inflow.csv").lines().count() > 50, "the face has its table");
    Ok(())
}

#[test]
fn a_run_stopped_by_a_step_check_can_be_resumed_with_another_limit() -> Result<()> {
    let home = TestFolder::new("restart-guard");
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/spec/run/restart/spill.toml");
    let set = |key: &str, value: &str| (key.to_owned(), value.to_owned());
    let run = |out: &str, escape: &str| {
        let sets = vec![set("guard.escape", escape), set("checkpoint.every", "0.05")];
        let options = RunOptions { out: Some(home.join(out)), overrides: sets, threads: Some(1) };
        run::run(&scene, &options, &mut |_: &Progress| true)
    };
    run("whole", "remove")?;
    let stopped = run("interrupted", "stop").expect_err("the water leaves the domain");
    assert!(stopped.to_string().contains("--set guard.escape=remove"), "{stopped}");
    let interrupted = home.join("interrupted");
    let resume =
        |key: &str, value: &str| run::resume(&interrupted, &[set(key, value)], Some(1), &mut |_: &Progress| true);
    // A restart cannot change the model, a misspelt key is refused, and a refusal changes nothing.
    for (key, value, expected_message) in [
        ("time.cfl", "0.1", "time.cfl cannot be changed in a run that has begun"),
        ("guard.escpae", "remove", "did you mean \"escape\"?"),
        ("guard.speed", "2.0", "a largest speed of 2 c0"),
    ] {
        let refused = resume(key, value).expect_err("no such change").to_string();
        assert!(refused.contains(expected_message), "{refused}");
    }
    resume("guard.escape", "remove")?;
    // The checkpoint is older than the first alarm, so both runs are equal.
    assert_same_files(&home.join("whole"), &interrupted, "with another limit");
    Ok(())
}

#[test]
fn mooring_lines_survive_a_restart() -> Result<()> {
    let (home, sim) = survives_restart("moorings", [0.15, 0.35], |sim: &mut Simulation<2>| {
        sim.enable_load_breakdown();
        sim.enable_energy_budget();
    })?;
    let reading = sim.mooring_reading(0);
    assert!(reading.on_bed > 0.0 && reading.end_forces[0].norm() > 0.0, "{reading:?}");
    assert!(home.join("whole/frames/moorings_00003.vtu").exists(), "frames have the lines");
    Ok(())
}
