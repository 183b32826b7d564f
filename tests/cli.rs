//! The command line program: commands, exit codes, messages and files. All tests run the binary.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout, clippy::print_stderr, reason = "tests may")]

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
    thread::sleep,
    time::{Duration, Instant},
};

/// An empty folder that is the working folder of a test.
struct TestFolder(PathBuf);

impl TestFolder {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("pontoon-cli-{name}-{}", std::process::id()));
        // A killed test with the same process number may have left the folder.
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_pontoon"));
        command.args(arguments).current_dir(&self.0).stdin(Stdio::null());
        command
    }

    fn pontoon(&self, arguments: &[&str]) -> ProgramOutput {
        ProgramOutput::from(self.command(arguments).output().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    fn manifest(&self, run: &str) -> serde_json::Value {
        serde_json::from_str(&self.read(&format!("{run}/manifest.json"))).unwrap()
    }

    /// Names and texts of the tables of a run.
    fn series(&self, run: &str) -> Vec<(String, String)> {
        let entries = fs::read_dir(self.path(run).join("series")).unwrap().flatten();
        let mut names: Vec<String> = entries.map(|e| e.file_name().into_string().unwrap()).collect();
        names.sort();
        names.into_iter().map(|name| (name.clone(), self.read(&format!("{run}/series/{name}")))).collect()
    }
}

impl Drop for TestFolder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Exit code and output of the program.
struct ProgramOutput {
    code: Option<i32>,
    out: String,
    err: String,
}

impl From<Output> for ProgramOutput {
    fn from(output: Output) -> Self {
        let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).expect("UTF-8");
        Self { code: output.status.code(), out: text(&output.stdout), err: text(&output.stderr) }
    }
}

impl ProgramOutput {
    /// Asserts the exit code `code` and all of `parts` on standard error, without a panic.
    #[track_caller]
    fn assert_refused(&self, code: i32, parts: &[&str]) {
        assert_eq!(self.code, Some(code), "{}", self.err);
        assert!(!self.err.contains("panicked"), "{}", self.err);
        for part in parts {
            assert!(self.err.contains(part), "\"{part}\" is not in:\n{}", self.err);
        }
    }
}

/// Asserts that every row of a table has as many fields as its header and that the last row is complete.
#[track_caller]
fn assert_complete(name: &str, table: &str) {
    assert!(table.ends_with('\n'), "{name} ends within a row");
    let count = |line: &str| line.split(',').count();
    let header = table.lines().next().map_or(0, count);
    assert!(table.lines().all(|line| count(line) == header), "{name} has rows of different lengths");
}

#[test]
fn a_run_writes_the_files_of_its_manifest_and_every_column_has_a_unit() {
    let folder = TestFolder::new("run");
    let output = folder.pontoon(&["run", "still-tank", "--until", "0.05", "--out", "a"]);
    assert_eq!(output.code, Some(0), "{}", output.err);
    for word in ["finished", "simulated", "particle-steps/s", "files in a", "series/low.csv", "frames.pvd"] {
        assert!(output.out.contains(word), "\"{word}\" is not in:\n{}", output.out);
    }
    let lines: Vec<&str> = output.err.lines().filter(|line| line.starts_with("t = ")).collect();
    assert!(!lines.is_empty() && lines.iter().all(|line| line.chars().count() <= 79), "{}", output.err);
    let manifest = folder.manifest("a");
    assert_eq!(manifest["status"], "finished");
    assert_eq!(manifest["simulated_s"], 0.05);
    for key in
        ["/threads", "/particles/fluid", "/particles/boundary", "/steps", "/wall_s", "/particle_steps_per_second"]
    {
        let figure = manifest.pointer(key).and_then(serde_json::Value::as_f64);
        assert!(figure.is_some_and(|x| x > 0.0), "{key}: {figure:?}");
    }
    assert!(manifest["checks"].is_array());
    assert!(manifest["engine"].as_str().is_some_and(|e| e.starts_with("rapier")));
    for file in manifest["files"].as_array().unwrap() {
        assert!(
            folder.path("a").join(file.as_str().unwrap()).is_file(),
            "{file} is in the manifest but does not exist"
        );
    }
    assert!(!folder.path("a/run.lock").exists(), "the run removes its lock");
    const UNITS: [&str; 6] = ["_s", "_m", "_mps", "_Pa", "_N_per_m", "_Nm_per_m"];
    for (name, table) in folder.series("a") {
        assert_complete(&name, &table);
        for column in table.lines().next().unwrap().split(',') {
            assert!(UNITS.iter().any(|unit| column.ends_with(unit)), "{name}: {column}");
        }
    }
}

#[test]
fn a_misspelt_key_is_refused_with_its_location_and_a_suggestion() {
    let folder = TestFolder::new("misspelt");
    let scene = include_str!("../scenes/buoyancy/scene.toml").replace("free  = { density", "free  = { densty");
    fs::write(folder.path("bay.toml"), scene).unwrap();
    let output = folder.pontoon(&["run", "bay.toml"]);
    output
        .assert_refused(2, &["unknown key \"densty\"; did you mean \"density\"?", "bay.toml:18:11", "solid.box.free"]);
    assert!(!folder.path("runs").exists(), "the program writes nothing before the scene is valid");
}

#[test]
fn wrong_commands_are_refused_with_a_remedy() {
    let folder = TestFolder::new("wrong");
    folder.pontoon(&["run", "raff"]).assert_refused(2, &["there is no scene \"raff\"", "did you mean \"raft\"?"]);
    folder.pontoon(&["run", "bathtub"]).assert_refused(2, &["\"bathtub\"", "pontoon scenes"]);
    folder.pontoon(&["run", "raft", "--dp", "-1"]).assert_refused(2, &["dp must be a positive number, not -1"]);
    let twice = ["run", "raft", "--until", "0.1", "--set", "until=0.2"];
    folder.pontoon(&twice).assert_refused(2, &["\"until\" is given twice", "--until 0.1", "--set until=0.2"]);
    let study = ["study", "raft", "--vary", "model.kernel=wendland,cubic", "--set", "model.kernel=cubic"];
    folder.pontoon(&study).assert_refused(2, &["\"model.kernel\" is given twice"]);
    folder.pontoon(&["run", "raft", "--until", "0"]).assert_refused(2, &["until"]);
    folder.pontoon(&["run", "raft", "--threads", "0"]).assert_refused(2, &["threads are from 1 to 1024"]);
    folder.pontoon(&["inspect", "raft", "--threads", "1025"]).assert_refused(2, &["threads are from 1 to 1024"]);
    folder.pontoon(&["study", "raft", "--threads", "1000000"]).assert_refused(2, &["threads are from 1 to 1024"]);
    folder.pontoon(&["run", "raft", "--set", "dp"]).assert_refused(2, &["write key=value"]);
    folder.pontoon(&["run", "raft", "--set", "solid.boot.free.density=1"]).assert_refused(2, &["boot", "boat"]);
    folder.pontoon(&["run", "still-tank", "--dp", "1e-6"]).assert_refused(2, &["particles", "or more"]);
    folder.pontoon(&["resume", "nowhere"]).assert_refused(2, &["nowhere holds no run", "such as runs/raft"]);
    let told = folder.pontoon(&["stats", "nowhere"]);
    told.assert_refused(2, &["nowhere holds no run", "such as runs/raft"]);
    assert!(!told.err.contains("resume"), "{}", told.err);
    fs::write(folder.path("file"), "").unwrap();
    folder.pontoon(&["run", "raft", "--out", "file/x"]).assert_refused(2, &["file/x: cannot be made", "--out"]);
    folder.pontoon(&["run", "raft", "--out", "."]).assert_refused(2, &["is not empty"]);
    if cfg!(not(feature = "gpu")) {
        let told = ["cannot use the device \"gpu\"", "--features gpu", "leave --device (model.device) out"];
        folder.pontoon(&["run", "raft", "--device", "gpu"]).assert_refused(2, &told);
        folder.pontoon(&["bench", "--devices"]).assert_refused(2, &["built without devices", "--features gpu"]);
    }
    assert!(!folder.path("runs").exists());
}

#[test]
fn sections_of_a_moordyn_deck_complete_a_scene() {
    let folder = TestFolder::new("moordyn");
    let deck = "--- LINE TYPES ---\nTypeName Diam MassDen EA BA/-zeta EI Cd Ca CdAx CaAx\n(name) (m) (kg/m) (N) (N-s/-) (N-m2) (-) (-) (-) (-)\n\
                chain 0.008 0.3 2e3 -1.0 0.0 1.2 1.0 0.0 0.0\n\
                --- POINTS ---\nID Attachment X Y Z M V CdA CA\n(#) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)\n\
                1 Fixed 0.1 0.24 -0.24 0 0 0 0\n2 Coupled 0.28 0.24 0.0 0 0 0 0\n\
                --- LINES ---\nID LineType AttachA AttachB UnstrLen NumSegs LineOutputs\n(#) (name) (#) (#) (m) (-) (-)\n1 chain 1 2 0.35 10 -\n\
                --- need this line ---\n";
    fs::write(folder.path("lines.txt"), deck).unwrap();
    folder.pontoon(&["import-moordyn", "nowhere.txt"]).assert_refused(2, &["nowhere.txt"]);
    let output =
        folder.command(&["import-moordyn", "lines.txt", "--solid", "box", "--level", "0.24"]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let sections = String::from_utf8(output.stdout).unwrap();
    let scene = "dimension = 3\ndp = 0.04\nuntil = 0.01\nwater = [{ fill = { box = { min = [0.0, 0.0, 0.0], max = [0.8, 0.48, 0.24] } } }]\n\
                 [[solid]]\nname = \"tank\"\nfixed = true\nshape = { tank = { size = [0.8, 0.48, 0.48] } }\n\
                 [[solid]]\nname = \"box\"\nshape = { box = { size = [0.24, 0.2, 0.12] } }\nat = { x = 0.4, y = 0.24, bottom = 0.18 }\n\
                 free = { density = 500.0 }\n";
    fs::write(folder.path("scene.toml"), format!("{scene}{sections}")).unwrap();
    let report = folder.command(&["inspect", "scene.toml", "--json"]).output().unwrap();
    assert!(report.status.success(), "{}", String::from_utf8_lossy(&report.stderr));
    let report: serde_json::Value = serde_json::from_slice(&report.stdout).unwrap();
    assert_eq!(report["moorings"][0]["name"], "line1", "{sections}");
}

#[test]
fn a_body_wider_than_its_tank_is_refused_before_the_run() {
    let folder = TestFolder::new("wide");
    for command in ["run", "inspect"] {
        let output = folder.pontoon(&[command, "buoyancy", "--set", "solid.box.shape.box.size=[1.4, 0.2]"]);
        output.assert_refused(2, &["\"box\" starts ", " m inside \"tank\"", "make it smaller"]);
    }
    let table = "solid.box.at.draft=0.1";
    let file = "solid.tank.shape={polygon={file=\"../hull.csv\"}}";
    folder
        .pontoon(&["run", "buoyancy", "--set", table, "--set", file])
        .assert_refused(2, &["leads out of the scene's folder"]);
}

#[test]
fn a_failed_run_names_the_particle_and_keeps_all_recorded_data() {
    let folder = TestFolder::new("blow");
    let output = folder.pontoon(&["run", "still-tank", "--set", "guard.speed=1e-4", "--out", "a", "--quiet"]);
    output.assert_refused(1, &["of water particle ", "step ", "Usual cause", "everything recorded so far is in a"]);
    let failure: serde_json::Value = serde_json::from_str(&folder.read("a/failure.json")).unwrap();
    assert!(failure["who"].as_str().is_some_and(|who| who.starts_with("water particle ")));
    assert!(failure["step"].as_u64().is_some() && failure["position"].as_array().is_some_and(|x| x.len() == 2));
    let manifest = folder.manifest("a");
    assert_eq!(manifest["status"], "failed");
    assert_eq!(manifest["fault"]["who"], failure["who"]);
    assert_eq!(manifest["error_code"], failure["code"]);
    for (name, table) in folder.series("a") {
        assert_complete(&name, &table);
        assert!(table.lines().count() >= 2, "{name} has the row of the start");
    }
    assert!(folder.read("a/frames.pvd").ends_with("</VTKFile>\n"));
}

#[test]
fn help_and_lists_contain_commands_options_and_examples() {
    let folder = TestFolder::new("help");
    let shows = |arguments: &[&str], expected: &[&str]| {
        let output = folder.pontoon(arguments);
        assert_eq!(output.code, Some(0), "{}", output.err);
        for word in expected {
            assert!(output.out.contains(word), "{arguments:?} does not print \"{word}\":\n{}", output.out);
        }
    };
    shows(&["--help"], &["pontoon run raft", "pontoon scenes", "resume", "inspect", "frames.pvd"]);
    shows(
        &["run", "--help"],
        &["--dp", "--until", "--out", "--frames", "--threads", "--set", "Examples:", "Ctrl-C", "Exit codes"],
    );
    shows(&["resume", "--help"], &["pontoon resume runs/raft"]);
    shows(&["study", "--help"], &["--dp", "--vary", "--repeat", "--dry-run", "Examples:", "study.html"]);
    shows(&["validate", "--help"], &["--quick", "--full", "--list", "Examples:", "validation.html"]);
    shows(&["stress", "--help"], &["--quick", "--list", "--maps", "Examples:", "stress.json"]);
    shows(&["stress", "--list"], &["float", "courant", "impact-water", "cases"]);
    shows(&["scenes"], &["raft", "still-tank", "flume-box", "column", "dam-break", "buoyancy-3d", "pontoon run NAME"]);
    shows(&["inspect", "raft", "--dp", "0.02"], &["particles", "paddle", "driven", "scene line", "--set", "default: "]);
    shows(&["inspect", "raft", "--dp", "0.0003"], &["estimate from areas", "than 4 million", "on one thread"]);
    shows(&["inspect", "raft", "--dp", "0.0003", "--json"], &["\"estimate\": true", "thread_seconds"]);
    assert_eq!(fs::read_dir(&folder.0).unwrap().count(), 0, "none of these commands writes a file");
    assert_eq!(folder.pontoon(&[]).code, Some(2));
}

#[test]
fn inspect_prints_cost_and_findings_before_the_values() {
    let folder = TestFolder::new("inspect");
    // The reference pair loop, because the memory of the SIMD lists depends on the processor.
    let output = folder.pontoon(&["inspect", "raft", "--no-timing", "--sweep", "reference"]);
    assert_eq!(output.code, Some(0), "{}", output.err);
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/inspect/raft.txt");
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, &output.out).unwrap();
    }
    let expected = fs::read_to_string(&path).unwrap_or_default();
    assert!(output.out == expected, "the output changed; update with UPDATE_GOLDEN=1:\n{}", output.out);
    // The same data as JSON, with a timing.
    let output = folder.pontoon(&["inspect", "still-tank", "--json", "--threads", "1"]);
    let json: serde_json::Value = serde_json::from_str(&output.out).unwrap();
    for key in ["/size/fluid", "/size/memory_bytes", "/sound/c0_mps", "/step/dt_s", "/timing/run_s"] {
        assert!(json.pointer(key).and_then(serde_json::Value::as_f64).is_some_and(|x| x > 0.0), "{key}");
    }
    assert!(json["findings"].as_array().is_some_and(Vec::is_empty), "{}", json["findings"]);
    assert_eq!(fs::read_dir(&folder.0).unwrap().count(), 0, "inspect writes no file");
}

#[test]
fn a_run_prints_warnings_but_no_notes_and_records_them_in_the_manifest() {
    let folder = TestFolder::new("warnings");
    let sets = ["--set", "model.c0_factor=5", "--set", "solid.apple.at.bottom=0.5"];
    let run = ["run", "raft", "--until", "0.002", "--set", "frames=off", "--out", "a"];
    let output = folder.pontoon(&[&run[..], &sets].concat());
    assert_eq!(output.code, Some(0), "{}", output.err);
    let parts = ["warning: the speed of sound, 7.83 m/s, is only ", "c0 = "];
    assert!(parts.iter().all(|word| output.err.contains(word)) && !output.err.contains("draft"), "{}", output.err);
    let warnings = folder.manifest("a")["warnings"].clone();
    assert_eq!(warnings.as_array().map(Vec::len), Some(1), "{warnings}");
    assert!(warnings[0].as_str().is_some_and(|w| w.contains("7.83 m/s")), "{warnings}");
}

#[test]
fn warnings_from_the_end_of_a_run_are_printed_and_logged_at_its_end() {
    let folder = TestFolder::new("late");
    // A statistic from 1.999 ms on has at most the last reading of a run of 2 ms. One that begins after the run is told before it.
    let late = "statistic=[{name=\"late\",waves=\"elevation\",from=0.001999}]";
    let run = ["run", "raft", "--until", "0.002", "--set", "frames=off", "--no-report", "--set", late, "--out"];
    let text = folder.pontoon(&[&run[..], &["a"]].concat());
    assert_eq!(text.code, Some(0), "{}", text.err);
    let warning_text = "statistic late: a series has no two readings in its time";
    assert_eq!(text.err.matches(&format!("warning: {warning_text}\n")).count(), 1, "{}", text.err);
    assert!(text.out.contains("pontoon stats a\n"), "the summary names the command for statistics: {}", text.out);
    let json = folder.pontoon(&[&run[..], &["b", "--log", "json"]].concat());
    let events: Vec<serde_json::Value> = json.err.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let [.., warning, end] = &events[..] else { panic!("{}", json.err) };
    assert!(warning["event"] == "warning" && warning["text"] == warning_text && end["event"] == "end", "{}", json.err);
    assert_eq!(folder.manifest("b")["warnings"].as_array().map(Vec::len), Some(1));
}

/// Three cases: one passes, one stops, and one exceeds an unattainable bound.
const PLANTED: &str = r#"
[judge.energy]
within = 0.05
why    = "Nothing makes energy."

[part]
tank = """
dimension = 2
dp        = 0.02
until     = 0.1
water     = [{ fill = { box = { min = [0.0, 0.0], max = [0.2, 0.2] } } }]
[[solid]]
name  = "tank"
fixed = true
shape = { tank = { size = [${0.2*y}, 0.4] } }"""

[[map]]
name  = "collapse"
about = "A column collapses, soundly and with a step far too long."
x     = { label = "Courant number", unit = "–", values = [0.4, 6.0] }
y     = { label = "room", unit = "columns", values = [2] }
scene = '''
${tank}
[time]
cfl = ${x}'''

[[map]]
name  = "still"
about = "Still water that is asked to be stiller than still."
x     = { label = "α", unit = "–", values = [0.02] }
y     = { label = "room", unit = "columns", values = [1] }
scene = '''
${tank}
[model]
viscosity = { artificial = { alpha = ${x} } }'''

[map.judge.quiet]
within = -1.0
why    = "No speed is below 0: planted."
"#;

#[test]
fn stress_reports_right_stopped_and_wrong_cases_and_repeats_no_run() {
    let folder = TestFolder::new("stress");
    fs::write(folder.path("maps.toml"), PLANTED).unwrap();
    let arguments = ["stress", "--maps", "maps.toml", "--out", "s", "--threads", "2"];
    let output = folder.pontoon(&arguments);
    assert_eq!(output.code, Some(3), "{}\n{}", output.out, output.err);
    for word in ["still 0.02, 1: wrong: quiet ", "> -1", "all", "s/stress.json"] {
        assert!(output.out.contains(word), "\"{word}\" is not in:\n{}", output.out);
    }
    let report: serde_json::Value = serde_json::from_str(&folder.read("s/stress.json")).unwrap();
    assert_eq!(report["counts"], serde_json::json!({ "right": 1, "stopped": 1, "wrong": 1 }));
    let stopped = report["trials"].as_array().unwrap().iter().find(|row| row["outcome"] == "stopped").unwrap();
    assert_eq!(stopped["values"][0], "6.0");
    assert!(stopped["end"]["refused"].as_str().is_some_and(|why| why.contains("Courant number of 6")), "{stopped}");
    let picture = folder.read("s/collapse.svg");
    assert!(["●", "■", "Courant number, –", "</svg>"].iter().all(|sign| picture.contains(sign)), "{picture}");

    // A changed bound is judged from the stored measurements; a changed scene is run again.
    fs::write(folder.path("maps.toml"), PLANTED.replace("-1.0", "1.0")).unwrap();
    let output = folder.pontoon(&[&arguments[..], &["--dry-run"]].concat());
    assert!(
        output.out.contains("still 0.02, 1: right") && output.out.contains("3 cases, 0 to be run"),
        "{}",
        output.out
    );
    assert_eq!(folder.pontoon(&arguments).code, Some(0));
    fs::write(folder.path("maps.toml"), PLANTED.replace("0.02]", "0.03]")).unwrap();
    assert!(folder.pontoon(&[&arguments[..], &["--dry-run"]].concat()).out.contains("3 cases, 1 to be run"));

    let assert_refused = |from: &str, to: &str, parts: &[&str]| {
        fs::write(folder.path("maps.toml"), PLANTED.replace(from, to)).unwrap();
        folder.pontoon(&["stress", "--maps", "maps.toml", "--out", "t"]).assert_refused(2, parts);
    };
    assert_refused("cfl = ${x}", "cfl = ${x", &["collapse at 0.4, 2", "not closed"]);
    assert_refused("cfl = ${x}", "clf = ${x}", &["collapse at 0.4, 2", "did you mean \"cfl\"?"]);
    assert_refused("quiet]", "quite]", &["maps.toml:", "quite"]);
    folder.pontoon(&["stress", "flaot"]).assert_refused(2, &["there is no map \"flaot\"", "did you mean \"float\"?"]);
    assert!(!folder.path("t").exists());
}

#[cfg(unix)]
#[test]
fn an_interrupted_and_resumed_run_writes_the_tables_of_an_uninterrupted_one() {
    let folder = TestFolder::new("resume");
    let run = ["run", "raft", "--until", "0.15", "--set", "frames.every=0.03", "--quiet"];
    let mut running = folder.command(&run).args(["--out", "interrupted"]).spawn().unwrap();
    // The interruption comes some steps after the start and long before the end.
    let (begun, table) = (Instant::now(), folder.path("interrupted/series/energy.csv"));
    while fs::read_to_string(&table).map_or(0, |text| text.lines().count()) < 20 {
        assert!(begun.elapsed() < Duration::from_secs(60), "the run does not reach its 20th step");
        sleep(Duration::from_millis(5));
    }
    folder.pontoon(&["resume", "interrupted"]).assert_refused(2, &["the run in interrupted still goes on: process "]);
    Command::new("kill").args(["-INT", &running.id().to_string()]).status().unwrap();
    assert_eq!(running.wait().unwrap().code(), Some(130));
    assert_eq!(folder.manifest("interrupted")["status"], "interrupted");

    let (checkpoint, scene) = (folder.path("interrupted/checkpoint.bin"), folder.path("interrupted/scene/scene.toml"));
    let (bytes, scene_text) = (fs::read(&checkpoint).unwrap(), fs::read_to_string(&scene).unwrap());
    fs::write(&checkpoint, &bytes[..bytes.len() / 2]).unwrap();
    folder.pontoon(&["resume", "interrupted"]).assert_refused(2, &["the checkpoint is cut short", "pontoon run"]);
    fs::write(&checkpoint, &bytes).unwrap();
    fs::write(&scene, scene_text.replace("density = 300.0", "density = 310.0")).unwrap();
    folder.pontoon(&["resume", "interrupted"]).assert_refused(2, &["is not the one that this run began with"]);
    fs::write(&scene, &scene_text).unwrap();

    // The resumed run uses another number of threads.
    let output = folder.pontoon(&["resume", "interrupted", "--threads", "1"]);
    assert_eq!(output.code, Some(0), "{}", output.err);
    assert_eq!(folder.pontoon(&[&run[..], &["--out", "uninterrupted"]].concat()).code, Some(0));
    let (interrupted, uninterrupted) = (folder.manifest("interrupted"), folder.manifest("uninterrupted"));
    assert_eq!(interrupted["steps"], uninterrupted["steps"]);
    assert_eq!(interrupted["particle_steps"], uninterrupted["particle_steps"]);
    assert!(folder.series("interrupted") == folder.series("uninterrupted"), "the tables differ");
    assert_eq!(folder.read("interrupted/frames.pvd"), folder.read("uninterrupted/frames.pvd"));
    folder.pontoon(&["resume", "interrupted"]).assert_refused(2, &["has finished: there is nothing to go on with"]);
}

/// Arguments of a study of small still tanks, and `more` of them.
fn study<'a>(more: &[&'a str]) -> Vec<&'a str> {
    let arguments = ["study", "still-tank", "--dp", "0.1,0.05,0.025", "--until", "0.06", "--out", "s", "--quiet"];
    [&arguments[..], more].concat()
}

#[test]
fn a_study_runs_every_spacing_with_every_value_once() {
    let folder = TestFolder::new("study");
    let vary = ["--vary", "model.viscosity={ artificial = { alpha = 0.02 } },none", "--set", "check.4.bound={}"];
    let dry = folder.pontoon(&study(&[&vary[..], &["--dry-run"]].concat()));
    assert_eq!(dry.code, Some(0), "{}", dry.err);
    assert!(!folder.path("s").exists(), "a dry run writes nothing");
    for word in ["dp-0.025_viscosity-none", "at the usual speed", "in all about"] {
        assert!(dry.out.contains(word), "\"{word}\" is not in:\n{}", dry.out);
    }
    let output = folder.pontoon(&study(&vary));
    assert_eq!(output.code, Some(0), "{}", output.err);
    assert!(output.out.contains("{ artificial = { alpha = 0.02 } }") && output.out.contains("elevation.level_m"));
    let table = folder.read("s/study.csv");
    // Five checks of six runs, and the header.
    assert_eq!(table.lines().count(), 31, "{table}");
    let rows: Vec<&str> = table.lines().filter(|line| line.contains("elevation.level_m")).collect();
    assert!(rows.iter().all(|row| row.contains(",finished,")), "{table}");
    let json: serde_json::Value = serde_json::from_str(&folder.read("s/study.json")).unwrap();
    assert_eq!(json["rows"].as_array().map(Vec::len), Some(30));
    assert!(json["command"].as_str().is_some_and(|c| c.starts_with("pontoon study still-tank --dp 0.1,0.05,0.025")));
    let page = folder.read("s/study.html");
    for word in ["<svg", "processor time, s", "order, least squares", "Roache", "25 mm", "model.viscosity = none"] {
        assert!(page.contains(word), "\"{word}\" is not on the page");
    }
    let manifest = folder.manifest("s/runs/dp-0.05_viscosity-none");
    assert!(manifest["cpu_s"].as_f64().is_some_and(|x| x > 0.0) && manifest["particle_steps"].as_u64() > Some(0));
    // Without a change no run is repeated, so the measured times are identical.
    let again = folder.pontoon(&study(&[&vary[..], &["--dry-run"]].concat()));
    assert_eq!(again.out.matches("has been run").count(), 6, "{}", again.out);
    assert_eq!(folder.pontoon(&study(&vary)).code, Some(0));
    assert_eq!(folder.read("s/study.csv"), table);
    // A changed check is judged again without a run. A changed model is run again, and the old run is renamed.
    let strict = study(&[&vary[..], &["--set", "check.4.bound.off=0.0"]].concat());
    assert_eq!(folder.pontoon(&strict).code, Some(3));
    assert_eq!(folder.manifest("s/runs/dp-0.05_viscosity-none"), manifest);
    let other = study(&[&vary[..], &["--set", "time.cfl=0.3"]].concat());
    assert_eq!(folder.pontoon(&other).code, Some(0));
    assert_eq!(folder.manifest("s/runs/dp-0.05_viscosity-none.old"), manifest);
}

#[test]
fn repeats_of_a_study_estimate_the_random_part_of_an_error() {
    let folder = TestFolder::new("repeats");
    let arguments = ["study", "still-tank", "--dp", "0.1,0.05", "--until", "0.06", "--out", "s", "--quiet"];
    let run_study = |more: &[&str]| folder.pontoon(&[&arguments[..], &["--set", "check.4.bound={}"], more].concat());
    let once = run_study(&[]);
    assert_eq!(once.code, Some(0), "{}", once.err);
    assert!(!once.out.contains('±') && !folder.read("s/study.html").contains("Repeats"), "{}", once.out);
    let first = folder.manifest("s/runs/dp-0.05");
    let output = run_study(&["--repeat", "3"]);
    assert_eq!(output.code, Some(0), "{}", output.err);
    assert_eq!(folder.manifest("s/runs/dp-0.05"), first, "the first repeat is the existing run");
    // A jitter of a millionth of dp changes the level by far less than dp: the repeats agree in three digits.
    let row =
        output.out.lines().find(|line| line.contains("elevation.level_m") && line.contains('±')).unwrap_or_default();
    assert!(row.contains(" 3 ") && output.out.contains("chance"), "{}", output.out);
    // Five checks of six runs, and the header; each run has its own folder and row.
    let table = folder.read("s/study.csv");
    assert!(table.starts_with("run,repeat,dp_m,check,N,") && table.lines().count() == 31, "{table}");
    assert_eq!(table.lines().filter(|line| line.starts_with("dp-0.05,3,0.05,")).count(), 5, "{table}");
    let scene = folder.manifest("s/runs/dp-0.05_repeat-3")["scene"].to_string();
    assert!(scene.contains("jitter = 0.000002"), "{scene}");
    let json: serde_json::Value = serde_json::from_str(&folder.read("s/study.json")).unwrap();
    let spreads = json["spreads"].as_array().unwrap();
    let level = |of: &&serde_json::Value| of["run"] == "dp-0.05" && of["check"] == "elevation.level_m";
    let level: Vec<_> = spreads.iter().filter(level).filter(|of| of["figure"] == "largest distance").collect();
    let [level] = level[..] else { panic!("{spreads:?}") };
    let figure = |key: &str| level[key].as_f64().unwrap();
    assert!(level["runs"] == 3 && figure("least") <= figure("mean") && figure("mean") <= figure("greatest"));
    assert!(figure("deviation") < 0.01 * 0.05, "below a hundredth of dp: {level}");
    assert!(folder.read("s/study.html").contains("<h2>Repeats</h2>"));
    run_study(&["--repeat", "0"]).assert_refused(2, &["0 repeats run nothing"]);
    run_study(&["--repeat", "2", "--vary", "scatter=1e-7,1e-6"]).assert_refused(2, &["jitter tells repeats apart"]);
}

#[test]
fn a_study_repeats_a_run_after_a_change_of_a_motion_table_but_not_of_a_reference() {
    let folder = TestFolder::new("study-tables");
    fs::create_dir(folder.path("bay")).unwrap();
    let scene = "dimension = 2\ndp = 0.1\nuntil = 0.05\n[[water]]\nfill = { box = { min = [0.0, 0.0], max = [1.0, 0.5] } }\n\
        [[solid]]\nname = \"tank\"\nfixed = true\nshape = { tank = { size = [1.0, 0.8] } }\n\
        [[solid]]\nname = \"lid\"\nshape = { box = { size = [0.2, 0.2] } }\nat = { x = 0.5, bottom = 0.9 }\n\
        driven = { along = [1.0, 0.0], distance = { file = \"lid.csv\", column = \"x_m\" } }\n\
        [[probe]]\nmotion = \"lid\"\n[[check]]\nseries = \"lid.surge_m\"\nreference = \"known.csv\"\ncolumn = \"x_m\"\n";
    let write = |name: &str, x: &str| fs::write(folder.path("bay").join(name), format!("t_s,x_m\n0.0,0.0\n0.05,{x}\n"));
    fs::write(folder.path("bay/scene.toml"), scene).unwrap();
    write("lid.csv", "0.1").and(write("known.csv", "0.1")).unwrap();
    let arguments = ["study", "bay", "--dp", "0.1", "--out", "s", "--quiet"];
    assert_eq!(folder.pontoon(&arguments).code, Some(0));
    let first = folder.manifest("s/runs/dp-0.1");
    write("known.csv", "0.2").unwrap();
    let output = folder.pontoon(&arguments);
    assert!(output.out.contains("0.500"), "the check is judged again with half the amplitude ratio:\n{}", output.out);
    assert_eq!(folder.manifest("s/runs/dp-0.1"), first);
    write("lid.csv", "0.2").unwrap();
    assert_eq!(folder.pontoon(&arguments).code, Some(0));
    assert_eq!(folder.manifest("s/runs/dp-0.1.old"), first);
}

#[test]
fn a_study_continues_after_a_failed_run_and_reports_the_reason() {
    let folder = TestFolder::new("study-fails");
    let output = folder.pontoon(&study(&["--vary", "guard.speed=1e-4,0.5", "--set", "check.4.bound={}"]));
    output.assert_refused(1, &["dp-0.025_speed-1e-4 failed: ", "of water particle "]);
    let table = folder.read("s/study.csv");
    let count = |word: &str| table.lines().filter(|line| line.contains(word)).count();
    assert!(count(",failed,") >= 5 && count(",finished,") >= 15, "{table}");
    folder.pontoon(&study(&["--vary", "time.clf=6,0.4"])).assert_refused(2, &["did you mean \"cfl\"?"]);
    folder.pontoon(&study(&["--vary", "time.cfl=0.4,"])).assert_refused(2, &["a list of values has nothing in it"]);
    folder.pontoon(&study(&["--vary", "time.cfl=0.4,0.4"])).assert_refused(2, &["two runs would be called"]);
}

#[cfg(unix)]
#[test]
fn an_interrupted_study_continues_with_the_same_command() {
    let folder = TestFolder::new("study-stops");
    let arguments = ["study", "raft", "--dp", "0.02,0.01", "--until", "0.15", "--out", "s", "--quiet"];
    let mut running = folder.command(&arguments).spawn().unwrap();
    let (begun, table) = (Instant::now(), folder.path("s/runs/dp-0.01/series/energy.csv"));
    while fs::read_to_string(&table).map_or(0, |text| text.lines().count()) < 20 {
        assert!(begun.elapsed() < Duration::from_secs(60), "the study does not reach its second run");
        sleep(Duration::from_millis(5));
    }
    Command::new("kill").args(["-INT", &running.id().to_string()]).status().unwrap();
    assert_eq!(running.wait().unwrap().code(), Some(130));
    assert!(folder.read("s/study.csv").contains(",interrupted,"));
    let first = folder.manifest("s/runs/dp-0.02");
    assert_eq!(folder.pontoon(&arguments).code, Some(0));
    assert_eq!(folder.manifest("s/runs/dp-0.02"), first, "a finished run is not repeated");
    assert_eq!(folder.manifest("s/runs/dp-0.01")["status"], "finished");
    assert!(!folder.path("s/runs/dp-0.01.old").exists());
}

#[test]
fn validate_judges_cases_and_writes_a_page() {
    let folder = TestFolder::new("validate");
    let output = folder.pontoon(&["validate", "dam-break", "--quiet"]);
    assert!(matches!(output.code, Some(0 | 3)), "{}", output.err);
    for word in ["case", "dam-break", "front.front_m", "N ≤ 0.14", "particle-steps", "validation/validation.html"] {
        assert!(output.out.contains(word), "\"{word}\" is not in:\n{}", output.out);
    }
    assert_eq!(output.code == Some(3), output.out.contains("MISSED"), "{}", output.out);
    let page = folder.read("validation/validation.html");
    assert_eq!(page.matches("<svg").count(), 2, "a plot for each check");
    // Repeats share a plot and have separate verdicts.
    let twice = folder.pontoon(&["validate", "dam-break", "--quiet", "--repeat", "2"]);
    let page = folder.read("validation/validation.html");
    assert!(page.matches("<svg").count() == 2 && page.contains("2 runs"), "a plot for each check");
    assert!(twice.out.contains("dam-break, repeat 2") && twice.out.contains(" ± "), "{}", twice.out);
    let list = folder.pontoon(&["validate", "--list"]);
    assert!(list.out.contains("column-18") && list.out.contains("flume-box-c"), "{}", list.out);
    folder.pontoon(&["validate", "colum-18"]).assert_refused(2, &["did you mean \"column-18\"?", "--list"]);
    folder.pontoon(&["validate", "--quick", "--full"]).assert_refused(2, &["cannot be used with"]);
    let plan = folder.pontoon(&["validate", "--full", "--dry-run"]);
    assert!(plan.code == Some(0) && plan.out.contains("flume-box-a") && plan.out.contains("in all about"));
}

/// A file size limit of 20 kB in place of a full disk.
#[cfg(unix)]
#[test]
fn a_run_on_a_full_disk_ends_with_complete_rows() {
    let folder = TestFolder::new("full");
    let program = Path::new(env!("CARGO_BIN_EXE_pontoon")).display().to_string();
    let arguments = "run still-tank --until 0.3 --set frames=off --out a --quiet";
    let limited = format!("trap '' XFSZ; ulimit -f 40; exec '{program}' {arguments}");
    let output =
        ProgramOutput::from(Command::new("sh").args(["-c", &limited]).current_dir(&folder.0).output().unwrap());
    output.assert_refused(2, &["a/series/energy.csv: cannot be written", "what was written before is intact"]);
    assert_eq!(folder.manifest("a")["status"], "failed");
    for (name, table) in folder.series("a") {
        assert_complete(&name, &table);
        assert!(table.lines().count() > 50, "{name} keeps the earlier rows");
    }
}

#[test]
fn stats_watch_and_export_read_a_finished_run() {
    let folder = TestFolder::new("figures");
    let output = folder.pontoon(&["run", "still-tank", "--until", "0.05", "--out", "a", "--quiet", "--no-report"]);
    assert_eq!(output.code, Some(0), "{}", output.err);
    let figures = folder.read("a/statistics.csv");
    assert!(figures.starts_with("name,series,quantity,value,unit,from_s,until_s\n"));
    assert_complete("statistics.csv", &figures);
    let stats = folder.pontoon(&["stats", "a", "--series", "low"]);
    assert!(stats.code == Some(0) && stats.out.contains("low.p_Pa") && !stats.out.contains("tank"), "{}", stats.out);
    let json = folder.pontoon(&["stats", "a", "--json", "--from", "0.01"]);
    let rows: serde_json::Value = serde_json::from_str(&json.out).unwrap();
    assert!(rows.as_array().is_some_and(|rows| rows.iter().all(|row| row["from_s"].as_f64() >= Some(0.01))));
    folder.pontoon(&["stats", "a", "--series", "lo"]).assert_refused(2, &["nothing to tell", "low"]);
    folder.pontoon(&["stats", "a", "--series", "low.p"]).assert_refused(2, &["did you mean \"low.p_Pa\"?"]);
    folder.pontoon(&["stats", "b"]).assert_refused(2, &["b"]);
    folder.pontoon(&["report", "a", "--png", "x.jpg"]).assert_refused(2, &["ends in .png"]);
    folder.pontoon(&["report", "a", "--png", "x.png", "--width", "0"]).assert_refused(2, &["200"]);
    folder.pontoon(&["stats", "a", "--from", "9"]).assert_refused(2, &["from 9 s", "between 0 and 0.05 s", "--from"]);
    folder.pontoon(&["stats", "a", "--from", "0.04", "--until", "0.01"]).assert_refused(2, &["there is no time"]);

    let watched = folder.pontoon(&["watch", "a", "--series", "low.p_Pa"]);
    assert_eq!(watched.code, Some(0), "{}", watched.err);
    for word in ["finished: t = 0.050 of 0.05 s", " at the last frame, energy ", " J/m\n", "low.p_Pa", "now"] {
        assert!(watched.out.contains(word), "\"{word}\" is not in:\n{}", watched.out);
    }
    assert!(watched.out.chars().any(|c| ('\u{2801}'..='\u{28ff}').contains(&c)), "a curve in dots:\n{}", watched.out);
    folder
        .pontoon(&["watch", "a", "--once", "--series", "low.p_pa"])
        .assert_refused(2, &["did you mean \"low.p_Pa\"?"]);

    let rows = "low.p_Pa,0.0,1.5,Pa²/Hz\nlow.p_Pa,0.5,2.5,Pa²/Hz\n";
    fs::write(folder.path("a/spectra.csv"), format!("series,f_Hz,S,unit\n{rows}")).unwrap();
    // Two statistics of the same name are both exported.
    let row = |f: f64, ratio: f64| format!("sea,low.p_Pa,{f:?},{:?},{ratio:?},Pa/m,-90.0,0.75\n", 1.0 / f);
    let rows = [row(0.5, 1.5), row(0.625, 1.25), row(0.5, 3.5)].concat();
    let head = "name,series,frequency_hz,period_s,rao,unit,phase_deg,coherence\n";
    fs::write(folder.path("a/rao.csv"), format!("{head}{rows}")).unwrap();
    let exported = folder.pontoon(&["export", "a", "--npz", "b.npz"]);
    assert_eq!(exported.code, Some(0), "{}", exported.err);
    let bytes = fs::read(folder.path("b.npz")).unwrap();
    let holds = |word: &[u8]| bytes.windows(word.len()).any(|w| w == word);
    assert!(bytes.starts_with(b"PK") && holds(b"low.t_s.npy") && holds(b"low.p_Pa.npy"));
    assert!(
        holds(b"spectra.low.p_Pa.f_Hz.npy") && holds(b"spectra.low.p_Pa.S.npy") && exported.out.contains("1 spectra")
    );
    for column in ["frequency_hz", "period_s", "rao", "phase_deg", "coherence"] {
        assert!(holds(format!("rao.sea.low.p_Pa.{column}.npy").as_bytes()), "{column}");
    }
    let pair = |numbers: [f64; 2]| numbers.map(f64::to_le_bytes).concat();
    assert!(
        holds(&pair([0.5, 0.625])) && holds(&pair([2.0, 1.6])) && holds(&pair([1.5, 1.25])),
        "the numbers are contiguous"
    );
    assert!(holds(b"rao.sea_2.low.p_Pa.rao.npy") && exported.out.contains("2 RAOs"), "{}", exported.out);
    for arguments in [&["export", "a", "--npz", "no/b.npz"][..], &["report", "a", "--png", "no/b.png"]] {
        folder.pontoon(arguments).assert_refused(2, &["there is no folder no", "make it first"]);
    }
    folder.pontoon(&["export", "a"]).assert_refused(2, &["--npz"]);
}

const BUOY: &str = r#"
dimension = 2
dp = 0.05
until = 0.01
frames = "off"
[[water]]
fill = { box = { min = [0.0, 0.0], max = [2.0, 0.4] } }
[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [2.0, 0.8] } }
[[solid]]
name = "buoy"
shape = { box = { size = [0.4, 0.4] } }
at = { x = 1.0, bottom = 0.2 }
free = { density = 500.0 }
[[probe]]
name = "gauge"
elevation = { x = 0.5 }
[[probe]]
motion = "buoy"
[[statistic]]
name = "sea"
rao = { motion = "buoy.heave_m", wave = "gauge" }
"#;

#[test]
fn damaged_and_missing_tables_of_a_run_are_told() {
    let folder = TestFolder::new("damaged");
    let output = folder.pontoon(&["run", "still-tank", "--until", "0.2", "--out", "a", "--quiet", "--no-report"]);
    assert_eq!(output.code, Some(0), "{}", output.err);
    let table = folder.0.join("a/series/low.csv");
    let mut lines: Vec<String> = fs::read_to_string(&table).unwrap().lines().map(String::from).collect();
    lines[2] = lines[2].replacen(',', ";", 1);
    lines[4] = "nothing".into();
    fs::write(&table, lines.join("\n") + "\n").unwrap();
    let stats = folder.pontoon(&["stats", "a"]);
    let told = "2 rows of series/low.csv are damaged, the first in line 3";
    assert!(stats.code == Some(0) && stats.err.contains(told), "{}", stats.err);
    let export = folder.pontoon(&["export", "a", "--npz"]);
    assert!(export.code == Some(0) && export.err.contains(told), "{}", export.err);
    let watch = folder.pontoon(&["watch", "a", "--once"]);
    assert!(watch.code == Some(0) && watch.out.contains(told), "{}", watch.out);
    fs::remove_file(&table).unwrap();
    let stats = folder.pontoon(&["stats", "a"]);
    assert!(stats.code == Some(0) && stats.err.contains("series/low.csv is missing"), "{}", stats.err);
    let report = folder.pontoon(&["report", "a"]);
    assert!(report.code == Some(0) && report.err.contains("series/low.csv is missing"), "{}", report.err);
    for entry in fs::read_dir(folder.0.join("a/series")).unwrap() {
        fs::remove_file(entry.unwrap().path()).unwrap();
    }
    folder.pontoon(&["stats", "a"]).assert_refused(2, &["has none of the tables of the run", "low", "pontoon run"]);
    folder.pontoon(&["stats", "a", "--json"]).assert_refused(2, &["has none of the tables of the run"]);
}

#[test]
fn raos_over_frequency_are_printed_in_addition_to_the_unchanged_statistics() {
    let folder = TestFolder::new("answers");
    fs::write(folder.path("buoy.toml"), BUOY).unwrap();
    let output = folder.pontoon(&["run", "buoy.toml", "--out", "a", "--quiet", "--no-report"]);
    assert_eq!(output.code, Some(0), "{}", output.err);
    let plain = folder.pontoon(&["stats", "a"]);
    assert!(plain.code == Some(0) && !plain.out.contains("coherence"), "0.01 s have no waves: {}", plain.out);
    folder.pontoon(&["stats", "a", "--rao"]).assert_refused(2, &["irregular waves", "[[statistic]]", "32 waves"]);
    // A hundred waves of three periods; the heave of the buoy is twice the elevation.
    let (mut gauge, mut buoy) = (String::from("t_s,level_m,eta_m\n"), String::from("t_s,heave_m\n"));
    for i in 0..4000 {
        let t = 0.05 * f64::from(i);
        let eta: f64 = [0.4, 0.5, 0.6].iter().map(|f| 0.01 * (std::f64::consts::TAU * f * t).sin()).sum();
        gauge += &format!("{t:?},{:?},{eta:?}\n", 0.4 + eta);
        buoy += &format!("{t:?},{:?}\n", 2.0 * eta);
    }
    fs::write(folder.path("a/series/gauge.csv"), gauge).unwrap();
    fs::write(folder.path("a/series/buoy.csv"), buoy).unwrap();

    let all = folder.pontoon(&["stats", "a"]);
    let tables: Vec<&str> = all.out.split("\n\n").collect();
    assert!(tables.len() == 3 && tables[1].contains("from (s)"), "series, statistics and RAOs: {}", all.out);
    for word in ["statistic", "frequency (Hz)", "period (s)", "rao", "unit", "phase (°)", "coherence", "sea", "m/m"] {
        assert!(tables[2].contains(word), "\"{word}\" is not in:\n{}", tables[2]);
    }
    assert_eq!(folder.pontoon(&["stats", "a", "--rao"]).out, tables[2], "the RAO table by itself");
    let rows = |arguments: &[&str]| -> Vec<serde_json::Value> {
        serde_json::from_str(&folder.pontoon(arguments).out).unwrap()
    };
    let figures = rows(&["stats", "a", "--json"]);
    assert!(figures.iter().all(|row| row.as_object().is_some_and(|row| row.len() == 7) && row["value"].is_number()));
    let answers = rows(&["stats", "a", "--rao", "--json"]);
    assert_eq!(answers.len(), tables[2].lines().count() - 1);
    for row in answers {
        assert!(row["name"] == "sea" && row["series"] == "buoy.heave_m" && row["unit"] == "m/m", "{row}");
        let number = |key: &str| row[key].as_f64().unwrap();
        assert!((number("frequency_hz") * number("period_s") - 1.0).abs() < 1e-12, "{row}");
        // Heave is a multiple of the wave, so the RAO is that multiple at every frequency up to round-off.
        let off = [number("rao") - 2.0, number("phase_deg"), number("coherence") - 1.0];
        assert!(off.iter().all(|off| off.abs() < 1e-6), "{row}");
    }
    let none = folder.pontoon(&["stats", "a", "--rao", "--until", "20"]);
    none.assert_refused(2, &["irregular waves"]);
}

#[test]
fn watch_distinguishes_a_running_from_a_killed_run() {
    let folder = TestFolder::new("alive");
    let output = folder.pontoon(&["run", "still-tank", "--until", "0.05", "--out", "a", "--quiet", "--no-report"]);
    assert_eq!(output.code, Some(0), "{}", output.err);
    let finished = folder.read("a/manifest.json");
    let replacements = [
        ("\"finished\"", "\"running\""),
        ("\"until_s\": 0.05", "\"until_s\": 0.1"),
        ("\"warnings\": []", "\"warnings\": [\"a\"]"),
    ];
    let running = replacements.iter().fold(finished, |text, (from, to)| text.replace(from, to));
    fs::write(folder.path("a/manifest.json"), running).unwrap();
    let watched = folder.pontoon(&["watch", "a"]).out;
    for word in ["running, or killed: t = 0.050 of 0.1 s", "1 warning\n", "a simulated second takes ", " left\n"] {
        assert!(watched.contains(word), "\"{word}\" is not in:\n{watched}");
    }
    if cfg!(target_os = "linux") {
        let mut gone = folder.command(&["scenes"]).stdout(Stdio::null()).spawn().unwrap();
        gone.wait().unwrap();
        let lock = |id: u32| {
            fs::write(folder.path("a/run.lock"), format!("{id}\n")).map(|()| folder.pontoon(&["watch", "a"]).out)
        };
        assert!(lock(gone.id()).unwrap().contains(&format!("killed (process {} is gone): t = ", gone.id())));
        assert!(lock(std::process::id()).unwrap().contains(&format!("running (process {}): t = ", std::process::id())));
    }
}

#[test]
fn the_frames_option_sets_the_interval_and_the_summary_counts_the_frames() {
    let folder = TestFolder::new("frames");
    let run = |every: &str, out: &str| {
        let arguments = ["run", "still-tank", "--until", "0.02", "--frames", every, "--out", out, "--no-report"];
        folder.pontoon(&arguments)
    };
    let output = run("0.01", "a");
    assert!(
        output.code == Some(0) && output.out.contains("  3 frames, ") && output.out.contains(", in frames/\n"),
        "{}",
        output.out
    );
    let bytes: u64 =
        fs::read_dir(folder.path("a/frames")).unwrap().map(|file| file.unwrap().metadata().unwrap().len()).sum();
    assert_eq!(folder.manifest("a")["frames"], serde_json::json!({ "count": 3, "bytes": bytes }));
    let output = run("off", "b");
    assert!(output.code == Some(0) && !output.out.contains("frames"), "{}{}", output.out, output.err);
    assert_eq!(folder.manifest("b")["frames"]["count"], 0);
    run("-1", "c").assert_refused(2, &["every must be a positive number, not -1"]);
    run("of", "c").assert_refused(2, &["--frames 0.05, or off"]);
}

#[test]
fn an_error_in_a_bundled_scene_names_the_scene() {
    let folder = TestFolder::new("built-in");
    for arguments in
        [&["run", "raft", "--dp", "0.5"][..], &["inspect", "raft", "--dp", "0.5"], &["study", "raft", "--dp", "0.5"]]
    {
        let output = folder.pontoon(arguments);
        output.assert_refused(2, &["in raft/scene.toml:"]);
        assert!(!output.err.contains("pontoon-"), "{}", output.err);
    }
}

#[test]
fn bodies_are_exported_for_a_panel_method_from_a_scene_and_from_its_run() {
    let folder = TestFolder::new("panels");
    let scene = r#"dimension = 3
dp = 0.1
until = 0.01
[[water]]
fill = { box = { min = [0.0, 0.0, 0.0], max = [1.0, 0.6, 0.5] } }
[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [1.0, 0.6, 1.0] } }
[[solid]]
name = "crate"
free = { density = 500.0 }
shape = { box = { size = [0.4, 0.3, 0.2] } }
at = { x = 0.5, y = 0.3, draft = "equilibrium" }
"#;
    fs::write(folder.path("scene.toml"), scene).unwrap();
    let exported = folder.pontoon(&["export", ".", "--capytaine", "a", "--panels", "100"]);
    assert_eq!(exported.code, Some(0), "{}", exported.err);
    assert!(exported.out.contains("crate with ") && !exported.out.contains("note"), "{}", exported.out);
    let json: serde_json::Value = serde_json::from_str(&folder.read("a/bodies.json")).unwrap();
    let body = &json["bodies"][0];
    let close = |value: &serde_json::Value, exact: f64| (value.as_f64().unwrap() / exact - 1.0).abs() < 1e-6;
    assert!(close(&json["water"]["depth_m"], 0.5) && close(&json["water"]["density_kg_m3"], 1000.0));
    assert!(close(&body["mass_kg"], 12.0) && close(&body["displaced_volume_m3"], 0.012));
    assert!(close(&body["hydrostatic_stiffness"][2][2], 1000.0 * 9.81 * 0.12));
    let mesh = folder.read("a/crate.gdf");
    let lines: Vec<&str> = mesh.lines().collect();
    let count: usize = lines[3].parse().unwrap();
    assert!(lines.len() == 4 + 4 * count && body["panel_count"].as_u64() == Some(count as u64));

    // A run has the scene with its changed keys; the crate then displaces more than its mass where it starts.
    let run = folder.pontoon(&[
        "run",
        ".",
        "--set",
        "solid.crate.at={ x = 0.5, y = 0.3, z = 0.45 }",
        "--out",
        "run",
        "--quiet",
        "--no-report",
    ]);
    assert_eq!(run.code, Some(0), "{}", run.err);
    let exported = folder.pontoon(&["export", "run", "--capytaine", "b"]);
    assert_eq!(exported.code, Some(0), "{}", exported.err);
    assert!(exported.out.contains("note: \"crate\" displaces 18.0000 kg"), "{}", exported.out);
    folder
        .pontoon(&["export", ".", "--capytaine", "c", "--solid", "crat"])
        .assert_refused(2, &["did you mean \"crate\"?"]);
    // Panels of another volume are another body: the coarsest of this hull enclose a quarter of it.
    folder
        .pontoon(&["export", "wigley", "--capytaine", "d", "--panels", "10"])
        .assert_refused(2, &["hull", "volume", "--panels "]);
    assert!(!folder.path("d").exists(), "nothing is written");
    folder.pontoon(&["export", "raft", "--capytaine", "c"]).assert_refused(2, &["2-D", "3-D scene"]);
    folder.pontoon(&["export", ".", "--npz", "--panels", "9"]).assert_refused(2, &["--capytaine"]);
    assert!(!folder.path("c").exists());
}

#[test]
#[cfg(not(feature = "surface"))]
fn exporting_surfaces_without_the_feature_is_refused_with_the_remedy() {
    let folder = TestFolder::new("no-surface");
    folder
        .pontoon(&["export", ".", "--surface"])
        .assert_refused(2, &["built without meshes of the free surface", "cargo install --path . --features surface"]);
}

#[test]
#[cfg(feature = "surface")]
fn the_surface_of_a_3d_run_is_exported_as_meshes_and_that_of_a_2d_run_is_refused() {
    let folder = TestFolder::new("surface");
    for (scene, run) in [("still-tank", "flat"), ("still-tank-3d", "deep")] {
        let arguments = ["run", scene, "--until", "0.02", "--set", "frames.every=0.01", "--out", run, "--no-report"];
        let output = folder.pontoon(&arguments);
        assert_eq!(output.code, Some(0), "{}", output.err);
    }
    let output = folder.pontoon(&["export", "deep", "--surface", "--npz"]);
    assert!(output.code == Some(0) && output.out.contains("surface.pvd: 3 meshes"), "{}{}", output.out, output.err);
    assert!(folder.read("deep/surface.pvd").contains("file=\"surface/surface_00002.vtu\""));
    let mesh = fs::read(folder.path("deep/surface/surface_00002.vtu")).unwrap();
    assert!(String::from_utf8_lossy(&mesh).contains("Name=\"velocity\"") && folder.path("deep/series.npz").exists());
    folder.pontoon(&["export", "flat", "--surface"]).assert_refused(2, &["2-D", "pontoon report"]);
}

#[test]
fn a_json_log_has_one_object_per_line_from_start_to_end_or_error() {
    let folder = TestFolder::new("log");
    let run = |more: &[&str]| folder.pontoon(&[&["run", "still-tank", "--log", "json"], more].concat());
    let events = |output: &ProgramOutput| -> Vec<serde_json::Value> {
        output.err.lines().map(|line| serde_json::from_str(line).unwrap_or_else(|e| panic!("{e}: {line}"))).collect()
    };
    let output = run(&["--until", "0.02", "--out", "a"]);
    assert_eq!((output.code, output.out.as_str()), (Some(0), ""), "{}", output.err);
    let log = events(&output);
    assert_eq!((&log[0]["event"], &log[log.len() - 1]["event"]), (&"start".into(), &"end".into()));
    assert_eq!(log[log.len() - 1]["status"], "finished");
    assert!(log[log.len() - 1]["frames"].as_u64().is_some_and(|count| count > 0));
    let last = log.iter().rfind(|event| event["event"] == "progress").unwrap();
    assert_eq!(last["warnings"], 0);
    assert!(
        last["energy_change_J_per_m"].is_number() && last["energy_residual"].is_null(),
        "from the energy probe: {last}"
    );
    assert_eq!((last["t_s"].as_f64(), last["until_s"].as_f64()), (Some(0.02), Some(0.02)));
    let wrong = run(&["--dp", "-1"]);
    assert_eq!(wrong.code, Some(2));
    assert_eq!((&events(&wrong)[0]["event"], &events(&wrong)[0]["code"]), (&"error".into(), &"out-of-range".into()));
    assert!(events(&wrong)[0]["text"].as_str().is_some_and(|text| text.contains("dp must be a positive number")));
    let quiet = run(&["--until", "0.02", "--out", "b", "--quiet"]);
    assert_eq!((quiet.code, quiet.out.as_str(), quiet.err.as_str()), (Some(0), "", ""));
    assert_eq!(events(&run(&["--dp", "-1", "--quiet"]))[0]["event"], "error");
}

/// A page shows what can be read: a frame that is missing or damaged is left out with a remark. A picture of a frame without water names
/// the cause. A terminal gets no control characters of a title.
#[test]
fn a_page_leaves_out_frames_that_cannot_be_read() {
    let folder = TestFolder::new("lost_frames");
    let frames = "frames = { every = 0.002, box = { min = [0.0, 0.0], max = [2.0, 1.0] } }";
    let scene = format!("title = \"\\u001b[31mred\"\n{}", BUOY.replace("frames = \"off\"", frames));
    fs::write(folder.path("scene.toml"), &scene).unwrap();
    let run = folder.pontoon(&["run", "scene.toml", "--out", "run"]);
    assert!(run.code == Some(0) && run.out.contains("\\u{1b}[31mred: finished"), "{}{}", run.err, run.out);
    assert!(![&run.out, &run.err].iter().any(|text| text.contains('\u{1b}')), "{}{}", run.err, run.out);
    let frame = |part: &str, number: usize| {
        let mut names: Vec<PathBuf> =
            fs::read_dir(folder.path("run/frames")).unwrap().map(|e| e.unwrap().path()).collect();
        names.retain(|path| path.file_name().unwrap().to_string_lossy().starts_with(part));
        names.sort();
        names[number].clone()
    };
    fs::remove_file(frame("water", 1)).unwrap();
    fs::write(frame("solids", 2), "cut short").unwrap();
    let page = folder.pontoon(&["report", "run"]);
    assert_eq!(page.code, Some(0), "{}", page.err);
    for number in [1, 2] {
        assert!(page.err.contains(&format!("warning: frame {number} is left out: ")), "{}", page.err);
    }
    assert!(folder.read("run/report.html").contains("frame 1 is left out"), "the page says so too");

    let empty = scene.replace("min = [0.0, 0.0], max = [2.0, 1.0]", "min = [5.0, 0.0], max = [6.0, 1.0]");
    fs::write(folder.path("empty.toml"), empty).unwrap();
    let run = folder.pontoon(&["run", "empty.toml", "--out", "empty", "--no-report"]);
    assert_eq!(run.code, Some(0), "{}", run.err);
    folder.pontoon(&["report", "empty", "--png", "a.png"]).assert_refused(2, &["holds no water", "frames.box"]);
}

/// Output that a full disk does not take is an error: a file without it looks like a result. A reader that closes its pipe, as
/// `head` does, has all that it wants.
#[test]
#[cfg(target_os = "linux")]
fn output_that_is_lost_is_an_error() {
    let folder = TestFolder::new("full");
    fs::write(folder.path("scene.toml"), BUOY).unwrap();
    for arguments in [
        &["schema"][..],
        &["scenes"],
        &["completions", "bash"],
        &["--help"],
        &["inspect", "scene.toml", "--no-timing"],
        &["run", "scene.toml", "--until", "0.01", "--out", "run"],
        &["stats", "run", "--json"],
        &["report", "run"],
        &["watch", "run", "--once"],
    ] {
        let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let output = ProgramOutput::from(folder.command(arguments).stdout(full).output().unwrap());
        output.assert_refused(2, &["standard output", "cannot be written"]);
        let (reader, closed) = std::io::pipe().unwrap();
        drop(reader);
        let arguments = if arguments[0] == "run" { &["scenes"][..] } else { arguments };
        let output = ProgramOutput::from(folder.command(arguments).stdout(closed).output().unwrap());
        assert_eq!(output.code, Some(0), "{arguments:?}: {}", output.err);
    }
    assert_eq!(folder.manifest("run")["status"], "finished", "the run itself is whole");
}

#[test]
fn the_program_prints_the_schema_and_shell_completions() {
    let folder = TestFolder::new("schema");
    let schema: serde_json::Value = serde_json::from_str(&folder.pontoon(&["schema"]).out).unwrap();
    assert_eq!(schema["title"], "A scene of pontoon");
    assert!(schema["properties"]["water"].is_object());
    for shell in ["bash", "zsh", "fish"] {
        let output = folder.pontoon(&["completions", shell]);
        assert!(output.code == Some(0) && output.out.contains("inspect"), "{shell}: {}", output.err);
    }
    folder.pontoon(&["completions", "dos"]).assert_refused(2, &["bash"]);
}
