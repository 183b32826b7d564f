//! The bundled scenes: complete in the program, valid, and able to run.

use std::path::{Path, PathBuf};

use pontoon::{
    output::frame::particle_bytes,
    scene::{BuiltScene, Scene, bundled_scenes},
    simulation::{Dimension, Simulation},
    solid::Dim,
};

use crate::common;

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

#[test]
fn every_bundled_scene_is_in_the_program_with_all_its_files_and_a_readme() {
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
fn every_bundled_scene_survives_writing_and_reading_from_its_folder() {
    for name in names() {
        let scene = Scene::read(&home().join(&name), &[]).unwrap();
        let again = Scene::parse(&scene.to_toml().unwrap(), &home().join(&name), &[]).unwrap();
        assert!(again == scene, "{name}");
        assert_eq!(again.to_toml().unwrap(), scene.to_toml().unwrap(), "{name}");
    }
}

#[test]
fn the_resumed_raft_scene_reaches_the_same_bits() {
    let scene = Scene::read(&home().join("raft"), &[]).unwrap();
    let mut whole = simulation::<2>(&scene);
    common::steps(&mut whole, 25);
    let saved = whole.save().unwrap();
    common::steps(&mut whole, 25);
    let mut resumed = simulation::<2>(&scene);
    resumed.restore(&saved).unwrap();
    common::steps(&mut resumed, 25);
    assert!(resumed.save().unwrap() == whole.save().unwrap());
}

#[test]
fn jitter_displaces_particles_reproducibly_by_at_most_its_value() {
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
    // The displacements are uniform in ±1e-3; the standard deviation of the mean of n of them is 6e-4/√n, here 1e-5.
    assert!((0.99e-3..=1e-3 * (1.0 + 1e-9)).contains(&most) && mean.abs() < 5e-5, "{most} {mean}");
}

#[test]
fn the_water_in_the_frames_of_a_bundled_scene_takes_at_most_200_mb() {
    for name in names() {
        let scene = Scene::read(&home().join(&name), &[]).unwrap();
        let (size, plan) = (scene.estimate_size().unwrap(), scene.plan().unwrap());
        let Some(frames) = plan.frames else { continue };
        let bytes = (plan.until / frames.every).floor() * size.fluid * particle_bytes(&frames.fields).0;
        assert!(bytes < 200e6, "{name}: {bytes:.2e} B");
    }
}
