//! Robustness of runs: kills at random moments, damaged checkpoints, folders and disks that refuse writes. All tests run the binary.
//! The default is six kills; `KILLS=50 cargo test --release --test kill` makes fifty.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout, clippy::print_stderr, reason = "tests may")]
#![cfg(unix)]

#[path = "support/run_files.rs"]
mod support;

use std::{
    collections::BTreeMap,
    fs,
    io::{BufRead, BufReader},
    path::{Path, PathBuf},
    process::{Child, Command, Output, Stdio},
    thread::sleep,
    time::Duration,
};

use pontoon::output::Checkpoint;

use support::{assert_same_files, files};

const LAST: &str = "checkpoint.bin";
const PREVIOUS: &str = "checkpoint.previous.bin";

/// The raft scene with many checkpoints and frames, so that many kills happen during a write.
const RAFT: [&str; 9] = [
    "raft",
    "--until",
    "0.12",
    "--set",
    "checkpoint.every=0.002",
    "--set",
    "frames.every=0.01",
    "--set",
    "probe.0.every=0.0001",
];

/// An empty folder that is the working folder of a test.
struct TestFolder(PathBuf);

impl TestFolder {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("pontoon-kill-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_pontoon"));
        command.args(arguments).current_dir(&self.0).stdin(Stdio::null());
        command
    }

    /// Starts a run of [`RAFT`] in the folder `out`.
    fn start(&self, out: &str, threads: &str) -> Child {
        let arguments = [&["run"], &RAFT[..], &["--out", out, "--threads", threads, "--quiet", "--no-report"]].concat();
        self.command(&arguments).stderr(Stdio::piped()).spawn().unwrap()
    }

    fn resume(&self, out: &str) -> Output {
        self.command(&["resume", out, "--no-report"]).output().unwrap()
    }

    /// Number of rows of the longest table.
    fn rows(&self, out: &str) -> usize {
        let tables = fs::read_dir(self.path(out).join("series")).into_iter().flatten().flatten();
        tables.map(|t| fs::read(t.path()).unwrap_or_default()).map(|t| lines(&t)).max().unwrap_or(0)
    }

    /// Starts a run of [`RAFT`] and kills it some checkpoints after its start.
    fn kill_run(&self, out: &str) {
        let mut child = self.start(out, "2");
        self.wait_for(&mut child, out, 60);
        child.kill().unwrap();
        assert!(child.wait().unwrap().code().is_none(), "the run is killed before its end");
    }

    /// Waits until the tables of `out` have `rows` rows, or the run has ended.
    fn wait_for(&self, child: &mut Child, out: &str, rows: usize) {
        while self.rows(out) < rows && child.try_wait().unwrap().is_none() {
            sleep(Duration::from_micros(500));
        }
    }
}

impl Drop for TestFolder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn lines(bytes: &[u8]) -> usize {
    bytes.iter().filter(|&&b| b == b'\n').count()
}

fn error_text(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Asserts the exit code 2 and all of `parts` on standard error, without a panic.
#[track_caller]
fn assert_refused(output: &Output, parts: &[&str]) {
    let text = error_text(output);
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(!text.contains("panicked"), "{text}");
    for part in parts {
        assert!(text.contains(part), "\"{part}\" is not in:\n{text}");
    }
}

/// Asserts that two runs have the same state and the same files, byte for byte, without the files that contain wall time.
#[track_caller]
fn assert_same_bits(killed: &Path, uninterrupted: &Path) {
    let [a, b] = [killed, uninterrupted].map(|folder| files(folder).into_keys().collect::<Vec<_>>());
    assert_eq!(a, b, "the same files");
    assert_same_files(uninterrupted, killed, "killed");
    let [a, b] = [killed, uninterrupted].map(|folder| Checkpoint::read(&folder.join(LAST)).unwrap());
    assert!(a.state == b.state && a.outputs == b.outputs, "the states differ");
    assert_eq!((a.time, a.particle_steps), (b.time, b.particle_steps));
}

/// Reproducible pseudo-random numbers (SplitMix64).
struct Random(u64);

impl Random {
    fn below(&mut self, n: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) % n
    }
}

/// Counts of the states in which the kills left the run.
#[derive(Debug, Default)]
struct KillCounts {
    kills: u32,
    before_the_first_checkpoint: u32,
    in_a_write_of_a_checkpoint: u32,
    in_another_write: u32,
    between_two_renames: u32,
    runs: u32,
}

/// Starts or resumes the run in `killed` until it ends, and kills it at random moments.
fn run_with_kills(folder: &TestFolder, wanted: u32, random: &mut Random, counts: &mut KillCounts) {
    loop {
        let (killed, threads) = (folder.path("killed"), ["1", "2", "3"][counts.kills as usize % 3]);
        let resumable = [LAST, PREVIOUS].iter().any(|name| killed.join(name).exists());
        let mut child = if resumable {
            folder.command(&["resume", "killed", "--threads", threads, "--quiet", "--no-report"]).spawn().unwrap()
        } else {
            let _ = fs::remove_dir_all(&killed);
            folder.start("killed", threads)
        };
        if counts.kills == wanted {
            assert_eq!(child.wait().unwrap().code(), Some(0));
            return;
        }
        // Of five kills one is during the start, two are during the write of a checkpoint, and two are at any point of a step.
        let how = random.below(5);
        if how > 0 {
            let rows = folder.rows("killed") + random.below(40) as usize;
            folder.wait_for(&mut child, "killed", rows);
        }
        let part = killed.join("checkpoint.bin.part");
        while how > 2 && !part.exists() && child.try_wait().unwrap().is_none() {
            std::hint::spin_loop();
        }
        sleep(Duration::from_micros(random.below(if how > 2 { 2000 } else { 8000 })));
        child.kill().unwrap();
        if let Some(code) = child.wait().unwrap().code() {
            assert_eq!(code, 0, "the run fails without a kill");
            return;
        }
        counts.kills += 1;
        let names = if killed.exists() { files(&killed) } else { BTreeMap::new() };
        let there = |name: &str| names.contains_key(name);
        counts.before_the_first_checkpoint += u32::from(!there(LAST) && !there(PREVIOUS));
        counts.between_two_renames += u32::from(!there(LAST) && there(PREVIOUS));
        counts.in_a_write_of_a_checkpoint += u32::from(there("checkpoint.bin.part"));
        let other = names.keys().any(|name| name.ends_with(".part") && name != "checkpoint.bin.part");
        counts.in_another_write += u32::from(other);
        let whole = [LAST, PREVIOUS].iter().any(|name| Checkpoint::read(&killed.join(name)).is_ok());
        assert!(whole || !there(LAST), "no intact checkpoint remains");
    }
}

#[test]
fn a_killed_and_resumed_run_reaches_the_same_bits() {
    let wanted: u32 = std::env::var("KILLS").ok().and_then(|n| n.parse().ok()).unwrap_or(6);
    let folder = TestFolder::new("bits");
    assert_eq!(folder.start("uninterrupted", "2").wait().unwrap().code(), Some(0));
    let (mut random, mut counts) = (Random(1), KillCounts::default());
    while counts.kills < wanted || counts.runs == 0 {
        run_with_kills(&folder, wanted, &mut random, &mut counts);
        assert_same_bits(&folder.path("killed"), &folder.path("uninterrupted"));
        fs::remove_dir_all(folder.path("killed")).unwrap();
        counts.runs += 1;
    }
    println!("{counts:?}");
}

#[test]
fn a_damaged_checkpoint_is_reported_and_the_previous_one_leads_to_the_same_bits() {
    let folder = TestFolder::new("damaged");
    assert_eq!(folder.start("uninterrupted", "2").wait().unwrap().code(), Some(0));
    folder.kill_run("a");
    let good = fs::read(folder.path("a").join(LAST)).unwrap();
    // A sample of changed bytes and of lengths; each is read as on a restart.
    for place in (0..good.len()).step_by(good.len() / 400) {
        let mut bad = good.clone();
        bad[place] ^= 1 << (place % 8);
        assert!(Checkpoint::from_bytes(&bad).is_err(), "byte {place} changed");
        assert!(Checkpoint::from_bytes(&good[..place]).is_err(), "cut at {place}");
    }
    let put = |name: &str, bytes: &[u8]| fs::write(folder.path("a").join(name), bytes).unwrap();
    let mut flipped = good.clone();
    flipped[good.len() / 2] ^= 4;
    let previous = fs::read(folder.path("a").join(PREVIOUS)).unwrap();

    // Both checkpoints are unusable: the error contains both reasons, and no file changes.
    put(LAST, &flipped);
    put(PREVIOUS, &previous[..previous.len() / 2]);
    let before = files(&folder.path("a"));
    let both = ["a/checkpoint.bin: the checkpoint is damaged", "checkpoint.previous.bin: the checkpoint is cut short"];
    assert_refused(&folder.resume("a"), &both);
    let mut after = files(&folder.path("a"));
    after.remove("run.lock");
    assert!(before.iter().filter(|(name, _)| *name != "run.lock").eq(&after), "a file changed");

    // A table shorter than at both checkpoints is refused as well.
    put(LAST, &good);
    put(PREVIOUS, &previous);
    let table = folder
        .path("a/series")
        .join(&*fs::read_dir(folder.path("a/series")).unwrap().next().unwrap().unwrap().file_name());
    let rows = fs::read(&table).unwrap();
    fs::write(&table, &rows[..40]).unwrap();
    assert_refused(
        &folder.resume("a"),
        &[".csv has 40 bytes, fewer than the ", "of checkpoint.bin", "of checkpoint.previous.bin"],
    );
    fs::write(&table, &rows).unwrap();

    // The last checkpoint is missing, as after a kill between two renames, or unusable: the previous one is used, with a warning.
    folder.kill_run("b");
    fs::remove_file(folder.path("b").join(LAST)).unwrap();
    let output = folder.resume("b");
    assert_eq!(output.status.code(), Some(0), "{}", error_text(&output));
    assert!(
        error_text(&output).contains("warning: b/checkpoint.bin: there is no checkpoint; the run goes on from the")
    );
    assert_same_bits(&folder.path("b"), &folder.path("uninterrupted"));
    put(LAST, &flipped);
    let output = folder.resume("a");
    assert_eq!(output.status.code(), Some(0), "{}", error_text(&output));
    for word in
        ["warning: a/checkpoint.bin: the checkpoint is damaged; the run goes on from the checkpoint before", "t = "]
    {
        assert!(error_text(&output).contains(word), "{}", error_text(&output));
    }
    let manifest: serde_json::Value =
        serde_json::from_slice(&fs::read(folder.path("a/manifest.json")).unwrap()).unwrap();
    assert!(manifest["warnings"][0].as_str().is_some_and(|w| w.contains("damaged")), "{}", manifest["warnings"]);
    assert_same_bits(&folder.path("a"), &folder.path("uninterrupted"));
}

#[test]
fn a_moved_folder_or_a_full_disk_ends_the_run_without_loss_of_data() {
    let folder = TestFolder::new("away");
    assert_eq!(folder.start("uninterrupted", "2").wait().unwrap().code(), Some(0));

    let mut child = folder.start("a", "2");
    folder.wait_for(&mut child, "a", 30);
    fs::rename(folder.path("a"), folder.path("b")).unwrap();
    let output = child.wait_with_output().unwrap();
    assert_refused(&output, &["cannot be written", "the folder a", "is gone"]);
    assert!(
        !error_text(&output).contains("what could be kept"),
        "the error does not refer to data in a folder that is gone: {}",
        error_text(&output)
    );
    assert!(!folder.path("a").exists());
    let output = folder.resume("b");
    assert_eq!(output.status.code(), Some(0), "{}", error_text(&output));
    assert_same_bits(&folder.path("b"), &folder.path("uninterrupted"));

    if !Path::new("/dev/full").exists() {
        println!("there is no /dev/full: the test skips a full disk");
        return;
    }
    let mut child = folder.start("c", "2");
    folder.wait_for(&mut child, "c", 30);
    while std::os::unix::fs::symlink("/dev/full", folder.path("c/checkpoint.bin.part")).is_err() {
        sleep(Duration::from_micros(100));
    }
    let parts = ["c/checkpoint.bin: cannot be written: No space left", "is intact", "go on with `pontoon resume c`"];
    assert_refused(&child.wait_with_output().unwrap(), &parts);
    let output = folder.resume("c");
    assert_eq!(output.status.code(), Some(0), "{}", error_text(&output));
    assert_same_bits(&folder.path("c"), &folder.path("uninterrupted"));
}

#[test]
fn a_folder_without_write_permission_is_refused_and_left_unchanged() {
    use std::os::unix::fs::PermissionsExt;
    let folder = TestFolder::new("locked");
    folder.kill_run("a");
    let run = folder.path("a");
    // A folder in place of the lock file prevents writing for every user, including root.
    let _ = fs::remove_file(run.join("run.lock"));
    fs::create_dir(run.join("run.lock")).unwrap();
    let before = files(&run);
    assert_refused(&folder.resume("a"), &["a/run.lock: cannot be written"]);
    assert!(before == files(&run), "a file changed");
    fs::remove_dir(run.join("run.lock")).unwrap();

    fs::set_permissions(&run, fs::Permissions::from_mode(0o555)).unwrap();
    if fs::write(run.join("probe"), "").is_ok() {
        println!("permissions do not restrict this user: the test skips a read-only folder");
    } else {
        assert_refused(&folder.resume("a"), &["a/run.lock: cannot be written"]);
        assert!(before == files(&run), "a file changed");
    }
    fs::set_permissions(&run, fs::Permissions::from_mode(0o755)).unwrap();
}

#[test]
fn a_second_ctrl_c_stops_at_once_without_a_checkpoint() {
    let folder = TestFolder::new("twice");
    let interrupt = |child: &Child| {
        assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    };
    // A step takes so long that the second Ctrl-C arrives within the step of the first.
    let arguments = ["run", "still-tank", "--dp", "0.0012", "--set", "probe.0.every=1e-9", "--set", "frames=off"];
    let mut child = folder.command(&arguments).args(["--out", "a", "--quiet"]).stderr(Stdio::piped()).spawn().unwrap();
    folder.wait_for(&mut child, "a", 3);
    interrupt(&child);
    let mut messages = BufReader::new(child.stderr.take().unwrap()).lines().map_while(Result::ok);
    assert!(messages.any(|line| line.contains("Ctrl-C again stops at once")));
    interrupt(&child);
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let names: Vec<String> = files(&folder.path("a")).into_keys().collect();
    assert!(!names.iter().any(|name| name.contains("checkpoint")), "{names:?}");
    for (name, bytes) in files(&folder.path("a")).into_iter().filter(|(name, _)| name.ends_with(".csv")) {
        assert!(bytes.ends_with(b"\n"), "{name} ends within a row");
    }
    assert_refused(&folder.resume("a"), &["there is no checkpoint", "every ten minutes"]);
}
