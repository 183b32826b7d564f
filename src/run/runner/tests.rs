//! What a run leaves of a course that ended in an alarm: nothing.

use std::{collections::BTreeMap, fs, path::Path};

use super::*;
use crate::{math::Vector, output::SeriesTable, run::resume, simulation::Rollback};

/// Water that falls over, with a table of every kind: by step, of means, of many rows at one time.
const SCENE: &str = r#"
title     = "Dam break"
dimension = 2
dp        = 0.02
until     = 0.9
frames    = { every = 0.02 }
checkpoint = { every = 0.01 }

[[water]]
fill = { box = { min = [0.0, 0.0], max = [0.2, 0.2] } }

[[solid]]
name  = "tank"
fixed = true
shape = { tank = { size = [0.6, 0.4] } }

[[solid]]
name  = "block"
shape = { box = { size = [0.06, 0.06] } }
at    = { x = 0.4, bottom = 0.0 }
free  = { density = 2000.0 }

[[probe]]
name  = "every_step"
force = "tank"
every = 1e-9

[[probe]]
name    = "means"
force   = "tank"
every   = 0.05
average = true

[[probe]]
name     = "touch"
contacts = true
every    = 1e-9
"#;

/// Stops a run after so many steps, or once it was rescued.
struct Stop {
    steps: u64,
    rescued: bool,
}

impl RunObserver for Stop {
    fn rolled_back(&mut self, _: &Rollback) {
        self.rescued = true;
    }

    fn step(&mut self, now: &Progress) -> bool {
        now.steps < self.steps && !self.rescued
    }
}

/// Every table and frame below `folder`.
fn written(folder: &Path) -> Result<BTreeMap<String, Vec<u8>>> {
    let mut all = BTreeMap::new();
    for part in ["series", "lists", "frames"].map(|name| folder.join(name)) {
        for entry in fs::read_dir(&part).map_err(|e| Error::file(&part, e))?.flatten() {
            let bytes = fs::read(entry.path()).map_err(|e| Error::file(&part, e))?;
            all.insert(entry.path().strip_prefix(folder).unwrap_or(&part).display().to_string(), bytes);
        }
    }
    Ok(all)
}

#[test]
fn what_was_written_of_a_course_that_ended_in_an_alarm_is_taken_back() -> Result<()> {
    let home = std::env::temp_dir().join(format!("pontoon-course-{}", std::process::id()));
    let (file, out, copy) = (home.join("scene.toml"), home.join("run"), home.join("copy"));
    fs::create_dir_all(&home).and_then(|()| fs::write(&file, SCENE)).map_err(|e| Error::file(&file, e))?;
    let scene = Scene::read(&file, &[])?;
    let origin = RunOrigin::Fresh { file: &file, out: Some(&out), overrides: &[], text: None };
    let mut course = Runner::<2>::new(&scene, origin, &Ranks::default())?;
    course.manifest.write(&out)?;

    // Twice the speed of sound for all water: no flow does that.
    course.advance(&mut Stop { steps: 900, rescued: false })?;
    let (alarm, c0) = (course.sim.time(), course.sim.system().model().c0);
    course.sim.set_water_velocity(|_| Vector::from([2.0 * c0, 0.0]));
    course.advance(&mut Stop { steps: u64::MAX, rescued: false })?;
    let back_to = course.sim.time();
    assert_eq!(
        (course.sim.steps(), course.sim.rollbacks().len()),
        (500, 1),
        "the state kept of step 500 is old enough"
    );

    // Nothing later is left, in tables, frames or either checkpoint.
    let last = |name: &str| Ok::<_, Error>(SeriesTable::read(&out.join(name))?.times.last().copied().unwrap_or(0.0));
    for name in ["series/every_step.csv", "series/means.csv", "lists/touch.csv"] {
        let last = last(name)?;
        assert!(last <= back_to, "{name} reaches {last} s, the run {back_to} s after an alarm at {alarm} s");
    }
    let frames = fs::read_dir(out.join("frames")).map_err(|e| Error::file(&out, e))?.count();
    assert_eq!(frames, 2 * (1 + (back_to / 0.02) as usize), "water and boundaries of each frame up to {back_to} s");
    for name in [checkpoint::LAST, checkpoint::PREVIOUS] {
        assert_eq!(Checkpoint::read(&out.join(name))?.time, back_to, "{name}");
    }

    // A copy that is resumed there, and the run that goes on, end with the same bytes.
    fs::create_dir_all(&copy).map_err(|e| Error::file(&copy, e))?;
    for folder in ["series", "lists", "frames", "scene", "."].map(|name| (out.join(name), copy.join(name))) {
        fs::create_dir_all(&folder.1).map_err(|e| Error::file(&copy, e))?;
        for entry in fs::read_dir(&folder.0).map_err(|e| Error::file(&out, e))?.flatten() {
            if entry.path().is_file() && entry.file_name() != "run.lock" {
                fs::copy(entry.path(), folder.1.join(entry.file_name())).map_err(|e| Error::file(&copy, e))?;
            }
        }
    }
    let resumed = resume(&copy, &[], Some(1), &mut |_: &Progress| true)?;
    let status = course.advance(&mut Stop { steps: u64::MAX, rescued: false })?;
    assert_eq!([status, resumed.manifest.status], [RunStatus::Finished; 2]);
    let (through, again) = (written(&out)?, written(&copy)?);
    assert!(through.keys().eq(again.keys()), "{:?}\n{:?}", through.keys(), again.keys());
    for (name, bytes) in &through {
        assert!(*bytes == again[name], "{name} differs");
    }

    // A row for the start and for each step of the course that led to the end, those of half a step as well.
    let rows = SeriesTable::read(&out.join("series/every_step.csv"))?.times;
    assert_eq!(rows.len() as u64, 1 + course.sim.steps());
    assert!(rows.is_sorted_by(|a, b| a < b), "no time twice");
    fs::remove_dir_all(&home).map_err(|e| Error::file(&home, e))
}
