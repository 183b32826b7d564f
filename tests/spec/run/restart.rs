//! Restart: a run that is interrupted twice and resumed on other numbers of threads writes the files of an uninterrupted run, byte
//! for byte. The scenes in `restart/` cover all components with state.

use std::{f64::consts::TAU, fs, path::Path};

use pontoon::{
    Result,
    error::ErrorKind,
    geometry::Shape,
    output::Checkpoint,
    run::{self, Progress, RunOptions},
    scene::Scene,
    simulation::{Dimension, Simulation},
    solid::{Dim, SolidSpec},
};

use crate::{
    common::{self, TestFolder},
    run_files::assert_same_files,
};

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
    // 20 rad/s for 0.6 s are 688 degrees, for 0.4 s 8 rad, less the acceleration phase. Both count whole turns.
    assert!((TAU..8.0).contains(&axle.position) && angle.is_some_and(|angle| angle > 540.0), "{axle:?}, {angle:?}");
    assert!(
        axle.absorbed_energy != 0.0 && sim.joint_reading(sim.find_joint("rail")?).absorbed_energy != 0.0,
        "the motors did work"
    );
    let rows = text(&home, "series/wheel.csv");
    let turned = rows.lines().last().and_then(|row| row.split(',').nth(5)).and_then(|x| x.parse::<f64>().ok());
    // The wheel turns by more than half a turn between two rows; the motion of the wheel is that of the axle to round-off.
    assert!(turned.zip(angle).is_some_and(|(turned, angle)| (turned - angle).abs() < 1e-9), "{turned:?}, {angle:?}");
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
fn water_beside_thin_parts_survives_a_restart() -> Result<()> {
    survives_restart::<3>("thin", [0.1, 0.18], |_| ())?;
    survives_restart::<2>("thin-sides", [0.08, 0.15], |_| ())?;
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
fn a_run_does_not_go_on_with_another_table() -> Result<()> {
    let home = TestFolder::new("restart-table");
    let table = "t_s,y_m\n0,0\n0.5,0.05\n";
    fs::write(home.join("gate.csv"), table).unwrap();
    let gate = "[[solid]]\nname = \"gate\"\nshape = { box = { size = [0.08, 0.2] } }\nat = { x = 1.0, bottom = 0.6 }\n\
                driven = { along = [0.0, -1.0], distance = { file = \"gate.csv\", column = \"y_m\" } }\n";
    fs::write(home.join("scene.toml"), crate_afloat(gate)).unwrap();
    let out = home.join("out");
    let options = RunOptions { out: Some(out.clone()), threads: Some(1), ..RunOptions::default() };
    run::run(&home.join("scene.toml"), &options, &mut |now: &Progress| now.time < 0.02)?;
    let kept = out.join("scene/gate.csv");
    let resume = || run::resume(&out, &[], Some(1), &mut |now: &Progress| now.time < 0.04);
    // The same name with other samples would move the gate at once.
    for other in [Some("t_s,y_m\n0,0\n0.5,0.06\n"), None] {
        match other {
            Some(text) => fs::write(&kept, text).unwrap(),
            None => fs::remove_file(&kept).unwrap(),
        }
        let refused = resume().expect_err("the table is another").to_string();
        assert!(refused.contains("gate.csv"), "{refused}");
    }
    fs::write(&kept, table).unwrap();
    resume().map(|_| ())
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

/// A crate afloat in a tank, with what `more` adds.
fn crate_afloat(more: &str) -> String {
    format!(
        r#"
dimension = 2
dp        = 0.05
until     = 1.0
[[water]]
fill = {{ box = {{ min = [0.0, 0.0], max = [1.0, 0.5] }} }}
[[solid]]
name  = "tank"
fixed = true
shape = {{ tank = {{ size = [1.0, 1.0] }} }}
[[solid]]
name  = "crate"
free  = {{ density = 500.0 }}
shape = {{ box = {{ size = [0.3, 0.2] }} }}
at    = {{ x = 0.6, draft = 0.12 }}
{more}"#
    )
}

/// A ball of `density` (kg/m³) under water, or one that stays there without a density.
fn ball(density: Option<f64>) -> SolidSpec<2> {
    let shape = Shape::Ball { radius: 0.08 };
    let ball = match density {
        Some(density) => SolidSpec::free("ball", shape, density),
        None => SolidSpec::fixed("ball", shape),
    };
    ball.at([0.2, 0.2])
}

#[test]
fn a_solid_that_comes_in_or_goes_after_a_restart_does_as_without_it() -> Result<()> {
    // A heavy, a light and a fixed ball: a light one has acoustic added mass, a fixed one no place in the engine's free bodies.
    for density in [Some(700.0), Some(20.0), None] {
        let mut whole = common::scene_simulation::<2>(&crate_afloat(""))?;
        common::steps(&mut whole, 25);
        let saved = whole.save()?;
        let mut fresh = common::scene_simulation::<2>(&crate_afloat(""))?;
        fresh.restore(&saved)?;
        // A simulation that goes back remembers the force pass of another state.
        let mut back = common::scene_simulation::<2>(&crate_afloat(""))?;
        common::steps(&mut back, 60);
        back.restore(&saved)?;
        let course = |sim: &mut Simulation<2>| -> Result<[Vec<u8>; 4]> {
            sim.add_solid(ball(density))?;
            let added = sim.save()?;
            common::steps(sim, 40);
            let later = sim.save()?;
            sim.remove_solid(2)?;
            let removed = sim.save()?;
            common::steps(sim, 40);
            Ok([added, later, removed, sim.save()?])
        };
        let told = course(&mut whole)?;
        assert!(course(&mut fresh)? == told, "{density:?}: restored in a new simulation");
        assert!(course(&mut back)? == told, "{density:?}: restored in a simulation that was ahead");
    }
    Ok(())
}

#[test]
fn a_solid_removed_after_a_restart_leaves_the_same_water_as_without_it() -> Result<()> {
    let with_ball = || -> Result<Simulation<2>> {
        let mut sim = common::scene_simulation::<2>(&crate_afloat(""))?;
        sim.add_solid(ball(Some(20.0)))?;
        common::steps(&mut sim, 25);
        Ok(sim)
    };
    let mut whole = with_ball()?;
    let mut resumed = common::scene_simulation::<2>(&crate_afloat(""))?;
    resumed.restore_with_added_solids(&whole.save()?, vec![ball(Some(20.0))])?;
    for sim in [&mut whole, &mut resumed] {
        sim.remove_solid(2)?;
        common::steps(sim, 40);
    }
    assert!(whole.save()? == resumed.save()?);
    Ok(())
}

#[test]
fn a_refused_state_changes_nothing() -> Result<()> {
    let own = |more: &str| -> Result<Simulation<2>> {
        let mut sim = common::scene_simulation::<2>(&crate_afloat(more))?;
        common::steps(&mut sim, 20);
        Ok(sim)
    };
    let rail =
        "[[joint]]\nname = \"rail\"\nkind = \"slider\"\nbetween = [\"crate\"]\nat = [0.6, 0.5]\nalong = [1.0, 0.0]\n";
    let line =
        "[[spring]]\nname = \"line\"\nbetween = [\"crate\"]\nfrom = [0.6, 0.6]\nto = [0.6, 0.9]\nstiffness = 10.0\n";
    let more_water = "[[water]]\nfill = { box = { min = [0.0, 0.5], max = [0.3, 0.6] } }\n";
    let other_ball = "[[solid]]\nname = \"ball\"\nfree = { density = 700.0 }\nshape = { ball = { radius = 0.08 } }\nat = { x = 0.2, y = 0.2 }\n";
    let leaving = "[[solid]]\nname = \"plate\"\nfixed = true\nuntil = 0.01\nshape = { box = { size = [0.1, 0.1] } }\nat = { x = 0.2, y = 0.2 }\n";
    let mut states: Vec<(&str, Vec<u8>)> = Vec::new();
    for (what, more) in [("water", more_water), ("joint", rail), ("spring", line), ("solid", other_ball)] {
        states.push((what, own(more)?.save()?));
    }
    let mut budgeted = common::scene_simulation::<2>(&crate_afloat(""))?;
    budgeted.enable_energy_budget();
    common::steps(&mut budgeted, 30);
    states.push(("energy budget", budgeted.save()?));
    let mut later = own("")?;
    common::steps(&mut later, 10);
    // Positions of the crate that are not finite, at each place where they stand in its state.
    let (whole, at) = (later.save()?, later.system().solids()[1].kinematics.pose.position[0].to_le_bytes());
    let places: Vec<usize> = (0..whole.len() - 8).filter(|&i| whole[i..i + 8] == at).collect();
    assert!(!places.is_empty(), "the crate has a position");
    let mut nowhere = whole.clone();
    places.iter().for_each(|&i| nowhere[i..i + 8].copy_from_slice(&f64::NAN.to_le_bytes()));
    states.push(("a solid that is nowhere", nowhere));
    states.push(("half of a state", whole[..whole.len() / 2].to_vec()));
    let (mut sim, mut twin) = (own("")?, own("")?);
    let before = sim.save()?;
    for (what, state) in &states {
        let refused = sim.restore(state).expect_err(what);
        assert_eq!(refused.kind, ErrorKind::Restart, "{what}: {refused}");
        assert!(sim.save()? == before, "{what}: the refusal changes nothing");
    }
    // A removal that is planned is not done for a state that is refused.
    let mut waiting = common::scene_simulation::<2>(&crate_afloat(leaving))?;
    let (boundary, start) = (waiting.system().boundary().len(), waiting.save()?);
    let mut gone = common::scene_simulation::<2>(&crate_afloat(&format!("{leaving}{line}")))?;
    common::run_to(&mut gone, 0.03)?;
    assert!(gone.system().solids()[2].boundary.is_empty(), "the plate has gone");
    assert!(waiting.restore(&gone.save()?).is_err());
    assert!(waiting.save()? == start && waiting.system().boundary().len() == boundary);
    common::steps(&mut sim, 30);
    common::steps(&mut twin, 30);
    assert!(sim.save()? == twin.save()?, "the run goes on as if nothing had been asked");
    Ok(())
}
