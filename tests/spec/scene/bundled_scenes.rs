//! The scenes that come with the program: found by their folder, sound, and able to run.

use std::path::{Path, PathBuf};

use pontoon::{
    model::Dimension,
    output::frame::particle_bytes,
    scene::{BuiltScene, Scene, bundled_scenes},
    simulation::Simulation,
    solid::Dim,
};

/// Scenes that are run coarser here: their own spacing takes minutes.
const COARSER: [(&str, &str); 6] = [
    ("added-mass-3d", "0.04"),
    ("buoyancy-3d", "0.04"),
    ("column", "0.04"),
    ("column-gate", "0.04"),
    ("flume-box", "0.02"),
    ("wigley", "0.045"),
];

fn home() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes")
}

/// Names of the folders in `scenes/`.
fn names() -> Vec<String> {
    let folders = std::fs::read_dir(home()).unwrap().flatten().filter(|entry| entry.path().is_dir());
    let mut names: Vec<String> = folders.map(|entry| entry.file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn simulation<const D: usize>(scene: &Scene) -> Simulation<D>
where
    Dim<D>: Dimension<D>,
{
    let BuiltScene { setup, .. } = scene.build().expect("a scene that can be built");
    Simulation::new(setup).expect("a sound setup")
}

fn steps<const D: usize>(sim: &mut Simulation<D>, n: usize) {
    for _ in 0..n {
        sim.step().expect("a sound step");
    }
}

/// Runs 50 steps and looks where the water is.
fn holds_water<const D: usize>(scene: &Scene)
where
    Dim<D>: Dimension<D>,
{
    let mut sim = simulation::<D>(scene);
    let count = sim.system().fluid().len();
    steps(&mut sim, 50);
    let system = sim.system();
    assert_eq!(system.fluid().len(), count);
    for solid in system.solids() {
        let depth = |x| -solid.spec.shape.signed_distance(&solid.kinematics.pose.local(x));
        let deepest = system.fluid().r.iter().map(depth).fold(f64::NEG_INFINITY, f64::max);
        // The outermost skin is half a dp inside the face: water that is deeper than that is on its way through.
        assert!(deepest < 0.5 * scene.dp, "water {deepest} m inside \"{}\"", solid.spec.name);
    }
}

#[test]
fn every_scene_has_a_readme_and_is_built_into_the_program_with_all_its_files() {
    let names = names();
    assert!(names.len() >= 7);
    let mut known: Vec<&str> = bundled_scenes().iter().map(|scene| scene.0).collect();
    known.sort();
    assert_eq!(names, known);
    for (name, text, files) in bundled_scenes() {
        let mut expected: Vec<(String, String)> =
            files.iter().chain([&("scene.toml", *text)]).map(|(f, t)| (f.to_string(), t.to_string())).collect();
        expected.sort();
        let there = std::fs::read_dir(home().join(name)).unwrap().flatten().map(|entry| entry.path());
        let mut found: Vec<(String, String)> = there
            .map(|path| {
                (path.file_name().unwrap().to_string_lossy().into_owned(), std::fs::read_to_string(path).unwrap())
            })
            .collect();
        found.sort();
        assert!(found == expected, "the files of {name}");
        assert!(files.iter().any(|(file, text)| *file == "README.md" && text.starts_with("# ")), "{name}: README.md");
    }
}

#[test]
fn every_scene_runs_fifty_steps_and_holds_its_water() {
    for name in names() {
        let coarser = COARSER.iter().find(|(of, _)| *of == name);
        let sets: Vec<_> = coarser.iter().map(|(_, dp)| ("dp".to_string(), dp.to_string())).collect();
        let scene = Scene::read(&home().join(&name), &sets).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(scene.resolve().unwrap().iter().any(|value| value.key == "model.kernel"), "{name}");
        match scene.dimension {
            2 => holds_water::<2>(&scene),
            _ => holds_water::<3>(&scene),
        }
    }
}

#[test]
fn a_scene_that_is_printed_and_read_again_is_the_same() {
    for name in names() {
        let scene = Scene::read(&home().join(&name), &[]).unwrap();
        let again = Scene::parse(&scene.to_toml().unwrap(), &home().join(&name), &[]).unwrap();
        assert!(again == scene, "{name}");
        assert_eq!(again.to_toml().unwrap(), scene.to_toml().unwrap(), "{name}");
    }
}

#[test]
fn the_raft_resumed_goes_on_to_the_same_bits() {
    let scene = Scene::read(&home().join("raft"), &[]).unwrap();
    let mut whole = simulation::<2>(&scene);
    steps(&mut whole, 25);
    let kept = whole.save().unwrap();
    steps(&mut whole, 25);
    let mut resumed = simulation::<2>(&scene);
    resumed.restore(&kept).unwrap();
    steps(&mut resumed, 25);
    assert!(resumed.save().unwrap() == whole.save().unwrap());
}

#[test]
fn jitter_moves_every_particle_by_no_more_than_it_says_and_always_the_same() {
    let water = |jitter: Option<&str>| {
        let sets: Vec<_> = jitter.into_iter().map(|s| ("jitter".to_string(), s.to_string())).collect();
        let scene = Scene::read(&home().join("still-tank"), &sets).unwrap();
        (scene.build::<2>().unwrap().setup.water, scene.dp)
    };
    let ((still, dp), (moved, _)) = (water(None), water(Some("1e-3")));
    assert!(moved == water(Some("1e-3")).0);
    let off: Vec<f64> =
        still.iter().zip(&moved).flat_map(|(a, b)| ((b - a) / dp).iter().copied().collect::<Vec<_>>()).collect();
    let (most, mean) = (off.iter().fold(0.0, |m: f64, x| m.max(x.abs())), off.iter().sum::<f64>() / off.len() as f64);
    // Evenly spread between ±1e-3: the mean of n of them is 6e-4/√n, here 1e-5.
    assert!((0.99e-3..=1e-3 * (1.0 + 1e-9)).contains(&most) && mean.abs() < 5e-5, "{most} {mean}");
}

#[test]
fn the_water_in_the_frames_of_a_scene_takes_200_mb_at_most_whoever_says_how_many() {
    for name in names() {
        let scene = Scene::read(&home().join(&name), &[]).unwrap();
        let (size, plan) = (scene.estimate_size().unwrap(), scene.plan().unwrap());
        let Some(frames) = plan.frames else { continue };
        let bytes = (plan.until / frames.every).floor() * size.fluid * particle_bytes(&frames.fields).0;
        assert!(bytes < 200e6, "{name}: {bytes:.2e} B");
    }
}
