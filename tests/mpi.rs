//! Runs on several processes by MPI, through the binary: the files of one process, one message for an error, and what is left when a
//! process ends. The same code with threads as ranks is in `tests/spec/run/ranks.rs`.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout, clippy::print_stderr, reason = "tests may")]
#![cfg(unix)]

#[path = "support/run_files.rs"]
mod support;

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
    thread::sleep,
    time::{Duration, Instant},
};

use support::assert_same_files;

/// A scene with bodies, a paddle that absorbs and a beach, and one in 3-D; coarse and short.
const SCENES: [(&str, &[&str]); 2] =
    [("raft", &["--dp", "0.02", "--until", "0.1"]), ("column", &["--dp", "0.04", "--until", "0.1"])];

/// An empty folder that is the working folder of a test.
struct TestFolder(PathBuf);

impl TestFolder {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("pontoon-mpi-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }

    /// The program on `count` processes, without mpiexec on one.
    fn command(&self, count: usize, arguments: &[&str]) -> Command {
        let program = env!("CARGO_BIN_EXE_pontoon");
        let mut command = match count {
            1 => Command::new(program),
            _ => {
                let mut command = Command::new("mpiexec");
                command.args(["-n", &count.to_string(), program]);
                command
            }
        };
        command.args(arguments).current_dir(&self.0).stdin(Stdio::null());
        command
    }

    fn output(&self, count: usize, arguments: &[&str]) -> Output {
        self.command(count, arguments).output().unwrap()
    }
}

impl Drop for TestFolder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Whether `mpiexec` is installed. Without it a test prints "skipped", and fails in CI.
fn mpiexec_is_missing() -> bool {
    let missing = !Command::new("mpiexec").arg("--version").output().is_ok_and(|result| result.status.success());
    if missing {
        assert!(std::env::var("CI").as_deref() != Ok("true"), "CI needs mpiexec to run several processes");
        eprintln!("skipped: mpiexec is not installed");
    }
    missing
}

#[test]
fn two_and_three_processes_write_the_files_of_one() {
    if mpiexec_is_missing() {
        return;
    }
    for (scene, short) in SCENES {
        let folder = TestFolder::new(scene);
        for count in [1, 2, 3] {
            let out = count.to_string();
            let arguments = [&["run", scene], short, &["--out", &out, "--threads", "1", "--no-report"]].concat();
            let run = folder.output(count, &arguments);
            assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
            if count > 1 {
                let (said, printed) = (String::from_utf8_lossy(&run.stderr), String::from_utf8_lossy(&run.stdout));
                assert!(said.contains(&format!("{count} ranks of 1 thread")), "{said}");
                assert!(printed.matches("the first rank exchanged data").count() == 1, "{printed}");
                assert_same_files(&folder.0.join("1"), &folder.0.join(&out), scene);
            }
        }
    }
}

#[test]
fn an_error_of_all_processes_is_said_once() {
    if mpiexec_is_missing() {
        return;
    }
    let folder = TestFolder::new("once");
    fs::create_dir_all(folder.0.join("taken/file")).unwrap();
    for (arguments, message) in [
        (&["run", "raft", "--set", "dpp=1"][..], "unknown key \"dpp\""),
        (&["run", "raaft"], "there is no scene \"raaft\""),
        (&["run", "raft", "--out", "taken"], "the folder taken is not empty"),
        (&["resume", "absent"], "absent"),
        (&["inspect", "raft"], "`run` and `resume` alone use several"),
        (&["run", "raft", "--device", "0"], "computes a run alone"),
    ] {
        let refused = folder.output(3, arguments);
        let said = String::from_utf8_lossy(&refused.stderr);
        assert_eq!(refused.status.code(), Some(2), "{arguments:?}: {said}");
        assert!(said.matches("error:").count() == 1 && said.contains(message), "{arguments:?}: {said}");
    }
}

/// The number of a process that is rank 1 of the run in `folder`.
fn second_process(folder: &Path) -> Option<String> {
    let of_folder = |process: &PathBuf| fs::read_link(process.join("cwd")).is_ok_and(|cwd| cwd == folder);
    let is_second = |process: &PathBuf| {
        let of = |name: &str| fs::read(process.join(name)).unwrap_or_default();
        let has = |text: &[u8], part: &[u8]| text.split(|&byte| byte == 0).any(|word| word == part);
        has(&of("environ"), b"PMI_RANK=1") || has(&of("environ"), b"OMPI_COMM_WORLD_RANK=1")
    };
    let processes = fs::read_dir("/proc").unwrap().flatten().map(|entry| entry.path());
    let found = processes.filter(of_folder).find(is_second)?;
    Some(found.file_name()?.to_string_lossy().into_owned())
}

fn signal(name: &str, process: &str) {
    assert!(Command::new("kill").args([name, process]).status().unwrap().success());
}

fn wait_until(what: &str, mut is_so: impl FnMut() -> bool) {
    let start = Instant::now();
    while !is_so() {
        assert!(start.elapsed() < Duration::from_secs(120), "{what} within two minutes");
        sleep(Duration::from_millis(20));
    }
}

/// A run of the raft that is interrupted goes on, and ends as one that was not.
#[test]
#[cfg(target_os = "linux")]
fn a_killed_process_and_ctrl_c_end_all_processes_and_leave_a_checkpoint() {
    if mpiexec_is_missing() {
        return;
    }
    let folder = TestFolder::new("killed");
    let home = fs::canonicalize(&folder.0).unwrap();
    let [short, often] = [["--dp", "0.02"], ["--set", "checkpoint.every=0.01"]];
    let common = [&["run", "raft", "--until", "0.2"][..], &short, &often, &["--threads", "1", "--no-report"]].concat();
    let whole = folder.output(1, &[&common[..], &["--out", "whole"]].concat());
    assert!(whole.status.success(), "{}", String::from_utf8_lossy(&whole.stderr));

    let begin = || folder.command(3, &[&common[..], &["--out", "parted"]].concat()).stderr(Stdio::piped()).spawn();
    let mut run = begin().unwrap();
    wait_until("a checkpoint", || home.join("parted/checkpoint.bin").exists());
    signal("-KILL", &second_process(&home).expect("a process of the second rank"));
    assert!(!run.wait().unwrap().success(), "mpiexec reports that a process was killed");
    let status = || fs::read_to_string(home.join("parted/manifest.json")).unwrap();
    assert!(status().contains("\"running\""), "the run was killed: {}", &status()[..40]);

    let mut resumed = folder.command(2, &["resume", "parted", "--threads", "1", "--no-report"]).spawn().unwrap();
    let before = fs::metadata(home.join("parted/checkpoint.bin")).unwrap().modified().unwrap();
    let newer = || fs::metadata(home.join("parted/checkpoint.bin")).is_ok_and(|now| now.modified().unwrap() > before);
    wait_until("a newer checkpoint", newer);
    signal("-INT", &resumed.id().to_string());
    resumed.wait().unwrap();
    wait_until("the end of the run", || status().contains("\"interrupted\""));

    let last = folder.output(1, &["resume", "parted", "--no-report"]);
    assert!(last.status.success(), "{}", String::from_utf8_lossy(&last.stderr));
    assert_same_files(&home.join("whole"), &home.join("parted"), "killed and interrupted");
}
