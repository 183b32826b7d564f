//! Runs that are killed at any moment, and go on to the same bits; checkpoints that are damaged; folders and disks that
//! refuse. All through the binary. Six kills by default; `KILLS=50 cargo test --release --test kill` makes fifty.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout, clippy::print_stderr, reason = "tests may")]
#![cfg(unix)]

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

const LAST: &str = "checkpoint.bin";
const PREVIOUS: &str = "checkpoint.previous.bin";

/// A float, two more and a paddle, with many checkpoints and frames, so that many moments lie in a write.
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

/// A fresh folder that is the working folder of a test.
struct Desk(PathBuf);

impl Desk {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("pontoon-kill-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    fn command(&self, words: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_pontoon"));
        command.args(words).current_dir(&self.0).stdin(Stdio::null());
        command
    }

    /// Starts a run of [`RAFT`] in the folder `out`.
    fn start(&self, out: &str, threads: &str) -> Child {
        let words = [&["run"], &RAFT[..], &["--out", out, "--threads", threads, "--quiet", "--no-report"]].concat();
        self.command(&words).stderr(Stdio::piped()).spawn().unwrap()
    }

    fn resume(&self, out: &str) -> Output {
        self.command(&["resume", out, "--no-report"]).output().unwrap()
    }

    /// Rows of the table that is written most often.
    fn rows(&self, out: &str) -> usize {
        let tables = fs::read_dir(self.path(out).join("series")).into_iter().flatten().flatten();
        tables.map(|t| fs::read(t.path()).unwrap_or_default()).map(|t| lines(&t)).max().unwrap_or(0)
    }

    /// A run of [`RAFT`] that was interrupted by a kill some checkpoints after its start.
    fn killed(&self, out: &str) {
        let mut child = self.start(out, "2");
        self.wait_for(&mut child, out, 60);
        child.kill().unwrap();
        assert!(child.wait().unwrap().code().is_none(), "it was killed before its end");
    }

    /// Waits until the tables of `out` have `rows` rows, or the run has ended.
    fn wait_for(&self, child: &mut Child, out: &str, rows: usize) {
        while self.rows(out) < rows && child.try_wait().unwrap().is_none() {
            sleep(Duration::from_micros(500));
        }
    }
}

impl Drop for Desk {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn lines(bytes: &[u8]) -> usize {
    bytes.iter().filter(|&&b| b == b'\n').count()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Ended with code 2 and said all of `words`, without a panic.
#[track_caller]
fn refused(output: &Output, words: &[&str]) {
    let text = said(output);
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(!text.contains("panicked"), "{text}");
    for word in words {
        assert!(text.contains(word), "\"{word}\" is not in:\n{text}");
    }
}

/// Every file below `folder`, by its name from there.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    fn collect(folder: &Path, from: &Path, into: &mut BTreeMap<String, Vec<u8>>) {
        for path in fs::read_dir(folder).unwrap().flatten().map(|entry| entry.path()) {
            match path.is_dir() {
                true => collect(&path, from, into),
                false => {
                    let name = path.strip_prefix(from).unwrap().display().to_string();
                    into.insert(name, fs::read(&path).unwrap());
                }
            }
        }
    }
    let mut all = BTreeMap::new();
    collect(folder, folder, &mut all);
    all
}

/// Two runs have the same files, each with the same bytes, but for what tells wall time; and the same state.
#[track_caller]
fn same_bits(broken: &Path, unbroken: &Path) {
    let (a, b) = (files(broken), files(unbroken));
    assert!(a.keys().eq(b.keys()), "{:?}\n{:?}", a.keys(), b.keys());
    for (name, bytes) in &a {
        let times = [LAST, PREVIOUS, "manifest.json"].contains(&name.as_str());
        assert!(times || *bytes == b[name], "{name} differs");
    }
    let [a, b] = [broken, unbroken].map(|folder| Checkpoint::read(&folder.join(LAST)).unwrap());
    assert!(a.state == b.state && a.outputs == b.outputs, "the states differ");
    assert_eq!((a.time, a.particle_steps), (b.time, b.particle_steps));
}

/// Pseudo-random numbers (SplitMix64), the same at every run.
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

/// What the kills met, to be told at the end.
#[derive(Debug, Default)]
struct Met {
    kills: u32,
    before_the_first_checkpoint: u32,
    in_a_write_of_a_checkpoint: u32,
    in_another_write: u32,
    between_the_names: u32,
    runs: u32,
}

/// Starts or resumes the run in `broken` until it comes to its end, and kills it at random moments meanwhile.
fn run_with_kills(desk: &Desk, wanted: u32, random: &mut Random, met: &mut Met) {
    loop {
        let (broken, threads) = (desk.path("broken"), ["1", "2", "3"][met.kills as usize % 3]);
        let resumable = [LAST, PREVIOUS].iter().any(|name| broken.join(name).exists());
        let mut child = if resumable {
            desk.command(&["resume", "broken", "--threads", threads, "--quiet", "--no-report"]).spawn().unwrap()
        } else {
            let _ = fs::remove_dir_all(&broken);
            desk.start("broken", threads)
        };
        if met.kills == wanted {
            assert_eq!(child.wait().unwrap().code(), Some(0));
            return;
        }
        // One in five is killed while it starts, two within a write of a checkpoint, two at any point of a step.
        let how = random.below(5);
        if how > 0 {
            let rows = desk.rows("broken") + random.below(40) as usize;
            desk.wait_for(&mut child, "broken", rows);
        }
        let part = broken.join("checkpoint.bin.part");
        while how > 2 && !part.exists() && child.try_wait().unwrap().is_none() {
            std::hint::spin_loop();
        }
        sleep(Duration::from_micros(random.below(if how > 2 { 2000 } else { 8000 })));
        child.kill().unwrap();
        if let Some(code) = child.wait().unwrap().code() {
            assert_eq!(code, 0, "the run failed by itself");
            return;
        }
        met.kills += 1;
        let names = if broken.exists() { files(&broken) } else { BTreeMap::new() };
        let there = |name: &str| names.contains_key(name);
        met.before_the_first_checkpoint += u32::from(!there(LAST) && !there(PREVIOUS));
        met.between_the_names += u32::from(!there(LAST) && there(PREVIOUS));
        met.in_a_write_of_a_checkpoint += u32::from(there("checkpoint.bin.part"));
        let other = names.keys().any(|name| name.ends_with(".part") && name != "checkpoint.bin.part");
        met.in_another_write += u32::from(other);
        let whole = [LAST, PREVIOUS].iter().any(|name| Checkpoint::read(&broken.join(name)).is_ok());
        assert!(whole || !there(LAST), "no whole checkpoint is left");
    }
}

#[test]
fn a_killed_run_goes_on_to_the_same_bits() {
    let wanted: u32 = std::env::var("KILLS").ok().and_then(|n| n.parse().ok()).unwrap_or(6);
    let desk = Desk::new("bits");
    assert_eq!(desk.start("unbroken", "2").wait().unwrap().code(), Some(0));
    let (mut random, mut met) = (Random(1), Met::default());
    while met.kills < wanted || met.runs == 0 {
        run_with_kills(&desk, wanted, &mut random, &mut met);
        same_bits(&desk.path("broken"), &desk.path("unbroken"));
        fs::remove_dir_all(desk.path("broken")).unwrap();
        met.runs += 1;
    }
    println!("{met:?}");
}

#[test]
fn a_damaged_checkpoint_is_told_and_the_one_before_goes_on_to_the_same_bits() {
    let desk = Desk::new("damaged");
    assert_eq!(desk.start("unbroken", "2").wait().unwrap().code(), Some(0));
    desk.killed("a");
    let good = fs::read(desk.path("a").join(LAST)).unwrap();
    // Any byte, any length: sampled, each file read as a resume reads it.
    for place in (0..good.len()).step_by(good.len() / 400) {
        let mut bad = good.clone();
        bad[place] ^= 1 << (place % 8);
        assert!(Checkpoint::from_bytes(&bad).is_err(), "byte {place} changed");
        assert!(Checkpoint::from_bytes(&good[..place]).is_err(), "cut at {place}");
    }
    let put = |name: &str, bytes: &[u8]| fs::write(desk.path("a").join(name), bytes).unwrap();
    let mut flipped = good.clone();
    flipped[good.len() / 2] ^= 4;
    let previous = fs::read(desk.path("a").join(PREVIOUS)).unwrap();

    // Both are of no use: both reasons are told, and nothing is written.
    put(LAST, &flipped);
    put(PREVIOUS, &previous[..previous.len() / 2]);
    let before = files(&desk.path("a"));
    let both = ["a/checkpoint.bin: the checkpoint is damaged", "checkpoint.previous.bin: the checkpoint is cut short"];
    refused(&desk.resume("a"), &both);
    let mut after = files(&desk.path("a"));
    after.remove("run.lock");
    assert!(before.iter().filter(|(name, _)| *name != "run.lock").eq(&after), "something was overwritten");

    // A table that is shorter than at both checkpoints is told too.
    put(LAST, &good);
    put(PREVIOUS, &previous);
    let table =
        desk.path("a/series").join(&*fs::read_dir(desk.path("a/series")).unwrap().next().unwrap().unwrap().file_name());
    let rows = fs::read(&table).unwrap();
    fs::write(&table, &rows[..40]).unwrap();
    refused(
        &desk.resume("a"),
        &[".csv has 40 bytes, fewer than the ", "of checkpoint.bin", "of checkpoint.previous.bin"],
    );
    fs::write(&table, &rows).unwrap();

    // The last is missing, as after a kill between two names, or of no use: the one before is taken, with a warning.
    desk.killed("b");
    fs::remove_file(desk.path("b").join(LAST)).unwrap();
    let output = desk.resume("b");
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    assert!(said(&output).contains("warning: b/checkpoint.bin: there is no checkpoint; the run goes on from the"));
    same_bits(&desk.path("b"), &desk.path("unbroken"));
    put(LAST, &flipped);
    let output = desk.resume("a");
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    for word in
        ["warning: a/checkpoint.bin: the checkpoint is damaged; the run goes on from the checkpoint before", "t = "]
    {
        assert!(said(&output).contains(word), "{}", said(&output));
    }
    let manifest: serde_json::Value = serde_json::from_slice(&fs::read(desk.path("a/manifest.json")).unwrap()).unwrap();
    assert!(manifest["warnings"][0].as_str().is_some_and(|w| w.contains("damaged")), "{}", manifest["warnings"]);
    same_bits(&desk.path("a"), &desk.path("unbroken"));
}

#[test]
fn a_folder_that_is_taken_away_or_a_disk_that_refuses_ends_the_run_and_loses_nothing() {
    let desk = Desk::new("away");
    assert_eq!(desk.start("unbroken", "2").wait().unwrap().code(), Some(0));

    let mut child = desk.start("a", "2");
    desk.wait_for(&mut child, "a", 30);
    fs::rename(desk.path("a"), desk.path("b")).unwrap();
    let output = child.wait_with_output().unwrap();
    refused(&output, &["cannot be written", "the folder a", "is gone"]);
    assert!(
        !said(&output).contains("what could be kept"),
        "nothing is kept in a folder that is gone: {}",
        said(&output)
    );
    assert!(!desk.path("a").exists());
    let output = desk.resume("b");
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    same_bits(&desk.path("b"), &desk.path("unbroken"));

    if !Path::new("/dev/full").exists() {
        println!("there is no /dev/full here: a full disk was not tried");
        return;
    }
    let mut child = desk.start("c", "2");
    desk.wait_for(&mut child, "c", 30);
    while std::os::unix::fs::symlink("/dev/full", desk.path("c/checkpoint.bin.part")).is_err() {
        sleep(Duration::from_micros(100));
    }
    let words = ["c/checkpoint.bin: cannot be written: No space left", "is intact", "go on with `pontoon resume c`"];
    refused(&child.wait_with_output().unwrap(), &words);
    let output = desk.resume("c");
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    same_bits(&desk.path("c"), &desk.path("unbroken"));
}

#[test]
fn a_folder_that_may_not_be_written_is_told_and_left_as_it_is() {
    use std::os::unix::fs::PermissionsExt;
    let desk = Desk::new("locked");
    desk.killed("a");
    let folder = desk.path("a");
    // A folder in place of the file is refused to everybody, root too.
    let _ = fs::remove_file(folder.join("run.lock"));
    fs::create_dir(folder.join("run.lock")).unwrap();
    let before = files(&folder);
    refused(&desk.resume("a"), &["a/run.lock: cannot be written"]);
    assert!(before == files(&folder), "something was overwritten");
    fs::remove_dir(folder.join("run.lock")).unwrap();

    fs::set_permissions(&folder, fs::Permissions::from_mode(0o555)).unwrap();
    if fs::write(folder.join("probe"), "").is_ok() {
        println!("permissions do not bind this user: a read-only folder was not tried");
    } else {
        refused(&desk.resume("a"), &["a/run.lock: cannot be written"]);
        assert!(before == files(&folder), "something was overwritten");
    }
    fs::set_permissions(&folder, fs::Permissions::from_mode(0o755)).unwrap();
}

#[test]
fn a_second_ctrl_c_stops_at_once_without_a_checkpoint() {
    let desk = Desk::new("twice");
    let interrupt = |child: &Child| {
        assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    };
    // Steps so long that the second one comes within the step of the first.
    let words = ["run", "still-tank", "--dp", "0.0012", "--set", "probe.0.every=1e-9", "--set", "frames=off"];
    let mut child = desk.command(&words).args(["--out", "a", "--quiet"]).stderr(Stdio::piped()).spawn().unwrap();
    desk.wait_for(&mut child, "a", 3);
    interrupt(&child);
    let mut answer = BufReader::new(child.stderr.take().unwrap()).lines().map_while(Result::ok);
    assert!(answer.any(|line| line.contains("Ctrl-C again stops at once")));
    interrupt(&child);
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let names: Vec<String> = files(&desk.path("a")).into_keys().collect();
    assert!(!names.iter().any(|name| name.contains("checkpoint")), "{names:?}");
    for (name, bytes) in files(&desk.path("a")).into_iter().filter(|(name, _)| name.ends_with(".csv")) {
        assert!(bytes.ends_with(b"\n"), "{name} ends within a row");
    }
    refused(&desk.resume("a"), &["there is no checkpoint", "every ten minutes"]);
}
