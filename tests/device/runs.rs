//! Runs whose water is on a device: the files of a run on the processor, from which either goes on; refusals.

use std::{
    fs,
    path::{Path, PathBuf},
};

use pontoon::{
    error::{Error, ErrorKind},
    output::SeriesTable,
    ranks::Ranks,
    run::{self, Progress, RunOptions},
};

use super::device;

/// A tank with a float that a wave moves, and every kind of output that fetches other data.
const SCENE: &str = r#"
dimension = 2
dp = 0.02
until = 0.3
[[water]]
fill = { box = { min = [0.0, 0.0], max = [0.8, 0.3] } }
velocity = ["0.2*sin(3.9*x)", "0"]
[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [0.8, 0.6] } }
[[solid]]
name = "box"
shape = { box = { size = [0.2, 0.2] } }
at = { x = 0.4, draft = "equilibrium" }
free = { density = 500.0 }
[[probe]]
motion = "box"
every = 0.01
[[probe]]
force = "box"
every = 0.01
[[probe]]
patch = { solid = "tank", box = { min = [-0.01, 0.0], max = [0.01, 0.4] } }
every = 0.01
[[probe]]
name = "mean"
pressure = [0.1, 0.05]
every = 0.05
average = true
[[probe]]
elevation = { x = 0.1 }
every = 0.01
[frames]
every = 0.1
"#;

/// A folder of a test, which ends with it.
struct TestFolder(PathBuf);

impl TestFolder {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("pontoon-device-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        fs::write(folder.join("scene.toml"), SCENE).unwrap();
        Self(folder)
    }

    /// Runs the scene into the folder `out` while `goes_on`.
    fn run(
        &self,
        out: &str,
        device: Option<&str>,
        goes_on: impl Fn(&Progress) -> bool + Sync,
    ) -> pontoon::Result<PathBuf> {
        let folder = self.0.join(out);
        let overrides = device.map(|name| ("model.device".into(), format!("{name:?}"))).into_iter().collect();
        let options = RunOptions { out: Some(folder.clone()), overrides, threads: Some(2) };
        run::run(&self.0.join("scene.toml"), &options, &mut |now: &Progress| goes_on(now)).map(|_| folder)
    }
}

impl Drop for TestFolder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn table(run: &Path, name: &str) -> SeriesTable {
    SeriesTable::read(&run.join(format!("series/{name}.csv"))).unwrap()
}

/// The names of all files below `folder`, in order.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().flatten().map(|entry| entry.path());
    let mut all: Vec<_> = entries.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] }).collect();
    all.sort();
    all
}

/// The names of the files of a run, without checkpoints, which a run has if it was interrupted.
fn names(run: &Path) -> Vec<PathBuf> {
    let mut names: Vec<_> = files(run).iter().map(|path| path.strip_prefix(run).unwrap().to_owned()).collect();
    names.retain(|name| !name.to_string_lossy().starts_with("checkpoint"));
    names
}

/// Asserts that each table of a run has the readings of another: at the same times, and within 10⁻³ of the largest of a column.
fn assert_same_series(one: &Path, other: &Path, what: &str) {
    for name in ["box", "box_force", "tank_patch", "mean", "elevation"] {
        let [here, there] = [one, other].map(|run| table(run, name));
        assert_eq!(here.columns, there.columns, "{what}: {name}");
        assert_eq!(here.times.len(), there.times.len(), "{what}: {name}");
        // A reading is that of the first step at or after its time, and steps are of other lengths by rounding.
        let apart = here.times.iter().zip(&there.times).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-5, "{what}: {name}: times {apart} s apart");
        for (column, (here, there)) in there.columns.iter().zip(here.values.iter().zip(&there.values)) {
            let most = there.iter().filter(|x| x.is_finite()).fold(0.0f64, |most, x| most.max(x.abs()));
            let off = here.iter().zip(there).filter(|(_, b)| b.is_finite()).map(|(a, b)| (a - b).abs());
            let off = off.fold(0.0, f64::max);
            println!("{what}: {name}.{column}: {off:.1e} off, of {most:.1e}");
            // The bound of loads; a degree, a millimetre and a newton count as nothing where more than these do not occur.
            assert!(off <= 1e-3 * most.max(1.0), "{what}: {name}.{column} is {off} off, of {most}");
        }
    }
}

#[test]
fn a_run_on_a_device_writes_the_files_of_a_run_on_the_processor() {
    let home = TestFolder::new("runs");
    let name = device();
    let [on_device, on_processor] = [("device", Some(name.as_str())), ("processor", None)]
        .map(|(out, device)| home.run(out, device, |_| true).expect("a sound run"));
    assert_eq!(names(&on_device), names(&on_processor), "the same files");
    assert_same_series(&on_device, &on_processor, "whole");
    // Interrupted runs go on on the other.
    for (from, to) in [(Some(name.as_str()), "cpu"), (None, name.as_str())] {
        let what = format!("resumed on {to}");
        let half = home.run(&what.replace(' ', "-"), from, |now| now.time < 0.15).unwrap();
        run::resume(&half, &[("model.device".into(), format!("{to:?}"))], Some(2), &mut |_: &Progress| true).unwrap();
        assert_eq!(names(&half), names(&on_processor), "{what}: the same files");
        assert_same_series(&half, &on_processor, &what);
    }
}

/// A software driver has the memory of the machine.
#[cfg(target_os = "linux")]
#[test]
fn the_list_of_devices_has_their_memory() {
    for adapter in pontoon::device::adapters() {
        assert!(adapter.memory_bytes.is_some_and(|memory| memory > 100_000_000), "{adapter:?}");
    }
}

#[test]
fn a_device_that_cannot_compute_a_run_is_an_error_with_the_remedy() {
    let home = TestFolder::new("refused");
    let refused = |error: Error, what: &str, remedy: &str| {
        assert_eq!(error.kind, ErrorKind::Usage, "{error}");
        assert!(error.message.contains(what), "{error}");
        assert!(error.help.as_deref().unwrap_or_default().contains(remedy), "{error}");
    };
    let error = home.run("unknown", Some("no such card"), |_| true).map(|_| ()).unwrap_err();
    refused(error, "there is no device \"no such card\"", "bench --devices");
    assert!(!home.0.join("unknown").exists(), "no folder is left");
    let options = RunOptions {
        out: Some(home.0.join("ranks")),
        overrides: vec![("model.device".into(), format!("{:?}", device()))],
        threads: Some(1),
    };
    let scene = home.0.join("scene.toml");
    let outcomes = std::thread::scope(|scope| {
        let threads: Vec<_> = Ranks::in_threads(2)
            .into_iter()
            .map(|ranks| {
                let (scene, options) = (&scene, &options);
                scope.spawn(move || run::run_on(&ranks, scene, options, &mut |_: &Progress| true).map(|_| ()))
            })
            .collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).collect::<Vec<_>>()
    });
    let error = outcomes.into_iter().find_map(std::result::Result::err).expect("a refusal");
    refused(error, "this one has 2 ranks", "start one process");
}
