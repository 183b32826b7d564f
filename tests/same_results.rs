//! Every bundled scene holds its water over 50 steps, and its results have the bits recorded in `tests/golden/results.txt`.
//!
//! The test hashes the state through the public interface of a simulation, so that the record does not depend on the
//! layout of a checkpoint. It hashes the series as files. On a mismatch it prints the new table, which replaces the
//! record after an intended change.
//!
//! Each scene has the same bits on two, three and five ranks, or on as many as the environment variable `PONTOON_TEST_RANKS` says, as in
//! `3,5`.
//!
//! `.ci/without-slp` repeats the test in a build with `-C no-vectorize-slp`: a compiler fault in one of the builds, in this crate
//! or in its dependencies, changes bits of only one of them (decision record 0130).

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout, clippy::print_stderr, reason = "tests may")]

use std::{fmt::Write as _, path::Path};

use pontoon::{
    ranks::Ranks,
    run::{self, Progress, RunOptions},
    scene::{BuiltScene, Scene},
    simulation::{Dimension, Simulation},
    solid::Dim,
    system::System,
};

/// Steps of each run.
const STEPS: u64 = 50;

/// Scenes with a coarser spacing in this test, because their own takes minutes.
const COARSER: [(&str, &str); 7] = [
    ("added-mass-3d", "0.04"),
    ("buoyancy-3d", "0.04"),
    ("column", "0.04"),
    ("column-gate", "0.04"),
    ("cylinder", "0.01"),
    ("flume-box", "0.02"),
    ("wigley", "0.045"),
];

/// Largest number of water particles for a run with the reference pair loop, which takes ten times as long.
const REFERENCE: usize = 8_000;

/// Numbers of ranks unless the environment says others.
const RANKS: &str = "2,3,5";

/// FNV-1a, 64 bits.
struct Hash(u64);

impl Hash {
    fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    fn bytes(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    fn number(&mut self, x: f64) {
        self.bytes(&x.to_bits().to_le_bytes());
    }
}

/// Hash of water, boundary particles, bodies and their loads after the steps, on one of several ranks or alone.
fn state<const D: usize>(scene: &Scene, ranks: Ranks) -> u64
where
    Dim<D>: Dimension<D>,
{
    let BuiltScene { setup, .. } = scene.build::<D>().unwrap();
    let mut sim = Simulation::on_ranks(setup, &ranks).unwrap();
    let count = sim.system().fluid().len();
    for _ in 0..STEPS {
        sim.step().unwrap();
    }
    let (mut hash, system) = (Hash::new(), sim.system());
    let (water, boundary) = (system.fluid(), system.boundary());
    let numbers: Vec<u32> = (0..boundary.len() as u32).collect();
    for (particles, id) in [(water, water.id), (boundary, &numbers)] {
        particles.r.iter().chain(particles.v).flat_map(|x| x.iter()).for_each(|&x| hash.number(x));
        particles.rho.iter().for_each(|&x| hash.number(x));
        id.iter().for_each(|id| hash.bytes(&id.to_le_bytes()));
    }
    for solid in system.solids() {
        let now = &solid.kinematics;
        let vectors = [&now.centre, &now.velocity, &now.pose.position, &solid.load.force];
        vectors.into_iter().flat_map(|x| x.iter()).for_each(|&x| hash.number(x));
        let turning = [&now.pose.rotation, &now.spin.0, &solid.load.torque.0];
        turning.into_iter().flat_map(|m| m.iter()).for_each(|&x| hash.number(x));
    }
    hash.number(sim.time());
    assert_holds_water(scene, count, system);
    hash.0
}

/// Asserts that each of several ranks, which share the pairs, has the state `alone`, for each number of ranks.
fn assert_same_on_ranks<const D: usize>(name: &str, scene: &Scene, alone: u64)
where
    Dim<D>: Dimension<D>,
{
    let of_rank = |ranks| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        pool.install(|| state::<D>(scene, ranks))
    };
    let counts = std::env::var("PONTOON_TEST_RANKS").unwrap_or_else(|_| RANKS.into());
    for count in counts.split(',').map(|count| count.parse().unwrap()) {
        let states: Vec<u64> = std::thread::scope(|scope| {
            let threads: Vec<_> =
                Ranks::in_threads(count).into_iter().map(|ranks| scope.spawn(move || of_rank(ranks))).collect();
            threads.into_iter().map(|thread| thread.join().unwrap()).collect()
        });
        assert_eq!(states, vec![alone; count], "{name} on {count} ranks");
    }
}

/// Asserts that no water is lost or inside a solid.
fn assert_holds_water<const D: usize>(scene: &Scene, count: usize, system: &System<D>) {
    let exchanged: i64 = system.face_exchange().iter().map(|face| face.entered as i64 - face.left as i64).sum();
    assert_eq!(system.fluid().len() as i64, count as i64 + exchanged);
    for solid in system.solids() {
        let depth = |x| -solid.spec.shape.signed_distance(&solid.kinematics.pose.local(x));
        let deepest = system.fluid().r.iter().map(depth).fold(f64::NEG_INFINITY, f64::max);
        // The outermost boundary particles are half a dp inside the face; water at that depth leaks through.
        assert!(deepest < 0.5 * scene.dp, "water {deepest} m inside \"{}\"", solid.spec.name);
    }
}

/// Hash of the series files that a run of these steps writes.
fn series(path: &Path, sets: &[(String, String)], out: &Path) -> u64 {
    let options = RunOptions { out: Some(out.into()), overrides: sets.to_vec(), threads: None };
    run::run(path, &options, &mut |now: &Progress| now.steps < STEPS).unwrap();
    let mut hash = Hash::new();
    let mut files: Vec<_> = std::fs::read_dir(out.join("series")).into_iter().flatten().flatten().collect();
    files.sort_by_key(|file| file.file_name());
    for file in files {
        hash.bytes(&std::fs::read(file.path()).unwrap());
    }
    std::fs::remove_dir_all(out).unwrap();
    hash.0
}

#[test]
fn every_bundled_scene_holds_its_water_and_has_the_recorded_bits_after_fifty_steps() {
    let home = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folders = std::fs::read_dir(home.join("scenes")).unwrap().flatten().filter(|entry| entry.path().is_dir());
    let mut names: Vec<String> = folders.map(|entry| entry.file_name().into_string().unwrap()).collect();
    names.sort();
    let folder = std::env::temp_dir().join(format!("pontoon-results-{}", std::process::id()));
    let mut table = String::from("# scene sweep state series\n");
    for name in &names {
        let path = home.join("scenes").join(name);
        for pair_loop in ["fast", "reference"] {
            let dp = COARSER.iter().find(|(of, _)| of == name).map(|(_, dp)| ("dp".to_string(), dp.to_string()));
            let sets: Vec<_> = dp.into_iter().chain([("model.sweep".to_string(), pair_loop.to_string())]).collect();
            let scene = Scene::read(&path, &sets).unwrap_or_else(|e| panic!("{name}: {e}"));
            assert!(scene.resolve().unwrap().iter().any(|value| value.key == "model.kernel"), "{name}");
            let few = scene.estimate_size().unwrap().fluid < REFERENCE as f64;
            if pair_loop == "reference" && !few {
                continue;
            }
            let (flat, alone) = (scene.dimension == 2, Ranks::default());
            let state = if flat { state::<2>(&scene, alone) } else { state::<3>(&scene, alone) };
            match (pair_loop, flat) {
                ("fast", true) => assert_same_on_ranks::<2>(name, &scene, state),
                ("fast", false) => assert_same_on_ranks::<3>(name, &scene, state),
                _ => {}
            }
            let series = series(&path, &sets, &folder.join(format!("{name}-{pair_loop}")));
            writeln!(table, "{name} {pair_loop} {state:016x} {series:016x}").unwrap();
        }
    }
    let _ = std::fs::remove_dir_all(&folder);
    let recorded = std::fs::read_to_string(home.join("tests/golden/results.txt")).unwrap_or_default();
    assert!(table == recorded, "the results differ from the record; new table:\n{table}");
}
