//! Whatever remembers outlives a restart: runs that are interrupted twice, resumed on other numbers of threads and ended leave
//! the files of unbroken ones, byte for byte. The scenes, one for each company of what remembers, are in `restart/`.

use std::{collections::BTreeMap, f64::consts::PI, fs, path::Path};

use pontoon::{
    Result,
    model::Dimension,
    output::Checkpoint,
    run::{self, Progress, RunOptions},
    scene::Scene,
    simulation::Simulation,
    solid::Dim,
};

use crate::common::TestFolder;

/// Every file below `folder`, by its name from there, but for those that tell wall time.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    fn collect(folder: &Path, name: &str, into: &mut BTreeMap<String, Vec<u8>>) {
        for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            let name = format!("{name}/{}", path.file_name().unwrap().to_string_lossy());
            match path.is_dir() {
                true => collect(&path, &name, into),
                false => drop(into.insert(name, fs::read(&path).unwrap())),
            }
        }
    }
    let mut all = BTreeMap::new();
    collect(folder, "", &mut all);
    all.retain(|name, _| name != "/manifest.json" && !name.starts_with("/checkpoint"));
    all
}

/// Runs the scene `name` unbroken, and broken at two moments (s): the same files. Gives the home of both, and the simulation as
/// it was at the second moment, whose books are as `keep` says.
fn outlives<const D: usize>(
    name: &str,
    [first, second]: [f64; 2],
    keep: impl Fn(&mut Simulation<D>),
) -> Result<(TestFolder, Simulation<D>)>
where
    Dim<D>: Dimension<D>,
{
    let home = TestFolder::new(&format!("restart-{name}"));
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/spec/run/restart/{name}.toml"));
    let options = |out: &str| RunOptions { out: Some(home.join(out)), threads: Some(1), ..RunOptions::default() };
    run::run(&scene, &options("whole"), &mut |_: &Progress| true)?;
    let (whole, broken) = (home.join("whole"), home.join("broken"));
    run::run(&scene, &options("broken"), &mut |now: &Progress| now.time < first)?;
    run::resume(&broken, &[], Some(2), &mut |now: &Progress| now.time < second)?;
    run::resume(&broken, &[], Some(3), &mut |_: &Progress| true)?;
    let (unbroken, mended) = (files(&whole), files(&broken));
    assert!(unbroken.keys().eq(mended.keys()), "{:?}\n{:?}", unbroken.keys(), mended.keys());
    for (file, bytes) in &unbroken {
        assert!(*bytes == mended[file], "{name}: {file} differs");
    }
    let mut sim = Simulation::new(Scene::read(&scene, &[])?.build::<D>()?.setup)?;
    keep(&mut sim);
    let kept = Checkpoint::read(&broken.join("checkpoint.bin"))?;
    sim.restore(&kept.state)?;
    assert!((second..second + 0.01).contains(&sim.time()), "it was broken at {} s", sim.time());
    assert!(sim.save()? == kept.state, "what was kept comes back whole");
    Ok((home, sim))
}

/// The text of a file of the unbroken run.
fn text(home: &TestFolder, name: &str) -> String {
    fs::read_to_string(home.join("whole").join(name)).unwrap()
}

#[test]
fn a_sea_its_absorption_its_damping_means_statistics_and_a_light_body_outlive_a_restart() -> Result<()> {
    let (home, sim) = outlives("sea", [0.15, 0.3], Simulation::<2>::enable_energy_budget)?;
    assert!(sim.pending_impulse(2).norm() > 0.0, "the foam has yet to get some of its impulse");
    assert!(text(&home, "statistics.csv").contains("reflection"), "gauges were read as reflection");
    Ok(())
}

#[test]
fn ties_motors_stops_a_hold_bounces_and_their_books_outlive_a_restart() -> Result<()> {
    let keep = |sim: &mut Simulation<2>| {
        sim.enable_energy_budget();
        sim.enable_load_breakdown();
    };
    let (home, sim) = outlives("ties", [0.15, 0.4], keep)?;
    let axle = sim.joint_reading(sim.find_joint("axle")?);
    let rows = text(&home, "series/axle.csv");
    let angle = rows.lines().last().and_then(|row| row.split(',').nth(4)).and_then(|x| x.parse::<f64>().ok());
    // 20 rad/s for 0.6 s are 688 degrees, less what it takes to get there: the table counts whole turns, the joint does not.
    assert!(axle.position.abs() <= PI && angle.is_some_and(|angle| angle > 540.0), "{axle:?}, {angle:?}");
    assert!(
        axle.absorbed_energy != 0.0 && sim.joint_reading(sim.find_joint("rail")?).absorbed_energy != 0.0,
        "motors have worked"
    );
    let pulled = |name: &str| {
        let rows = text(&home, &format!("series/{name}.csv"));
        let tension = |row: &str| row.rsplit(',').next().and_then(|x| x.parse::<f64>().ok());
        rows.lines().filter_map(tension).any(|x| x > 1.0)
    };
    assert!(pulled("leash") && pulled("line"), "rope and line were taut");
    assert!(text(&home, "lists/contacts.csv").contains("lift,ball"), "the ball lay on the lift");
    Ok(())
}

#[test]
fn a_run_in_three_dimensions_with_corrected_gradients_outlives_a_restart() -> Result<()> {
    let keep = |sim: &mut Simulation<3>| {
        sim.enable_energy_budget();
        sim.enable_load_breakdown();
    };
    let (home, sim) = outlives("three", [0.1, 0.18], keep)?;
    assert!(sim.pending_impulse(2).norm() > 0.0, "the foam has yet to get some of its impulse");
    assert!(text(&home, "lists/contacts.csv").contains("foam,bob"), "the bob struck the foam");
    Ok(())
}

#[test]
fn water_between_periodic_sides_that_is_shifted_outlives_a_restart() -> Result<()> {
    let (_, sim) = outlives::<2>("vortices", [0.1, 0.25], |_| ())?;
    assert_eq!(sim.system().fluid().len(), 400, "images are none of the water");
    Ok(())
}

#[test]
fn who_was_taken_out_is_known_after_a_restart() -> Result<()> {
    let (home, sim) = outlives("spill", [0.2, 0.4], Simulation::<2>::enable_energy_budget)?;
    let (then, all) = (sim.removed_particles().len(), text(&home, "removed.csv").lines().count() - 1);
    assert!(then > 0 && all > then, "{then} before the second moment, {all} in all");
    assert!(sim.energy_budget().is_some_and(|ledger| ledger.removed != 0.0), "they took energy along");
    Ok(())
}

#[test]
fn a_run_that_a_guard_stopped_goes_on_with_another() -> Result<()> {
    let home = TestFolder::new("restart-guard");
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/spec/run/restart/spill.toml");
    let set = |key: &str, value: &str| (key.to_owned(), value.to_owned());
    let run = |out: &str, escape: &str| {
        let sets = vec![set("guard.escape", escape), set("checkpoint.every", "0.05")];
        let options = RunOptions { out: Some(home.join(out)), overrides: sets, threads: Some(1) };
        run::run(&scene, &options, &mut |_: &Progress| true)
    };
    run("whole", "remove")?;
    let stopped = run("broken", "stop").expect_err("the water leaves the domain");
    assert!(stopped.to_string().contains("--set guard.escape=remove"), "{stopped}");
    let broken = home.join("broken");
    let resume = |key: &str, value: &str| run::resume(&broken, &[set(key, value)], Some(1), &mut |_: &Progress| true);
    // No law may change on the way, a misspelt key is told, and a refusal leaves all as it was.
    for (key, value, said) in [
        ("time.cfl", "0.1", "time.cfl cannot be changed in a run that has begun"),
        ("guard.escpae", "remove", "did you mean \"escape\"?"),
        ("guard.speed", "2.0", "a largest speed of 2 c0"),
    ] {
        let refused = resume(key, value).expect_err("no such change").to_string();
        assert!(refused.contains(said), "{refused}");
    }
    resume("guard.escape", "remove")?;
    let (unbroken, mended) = (files(&home.join("whole")), files(&broken));
    assert!(unbroken.keys().eq(mended.keys()), "{:?}\n{:?}", unbroken.keys(), mended.keys());
    // The checkpoint was made before the first alarm, so the two runs are one.
    for (file, bytes) in unbroken.iter().filter(|(file, _)| *file != "/report.html") {
        assert!(*bytes == mended[file], "{file} differs");
    }
    Ok(())
}
