//! The program as a stranger meets it: commands, exit codes, messages, files. All through the binary.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout, clippy::print_stderr, reason = "tests may")]

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
    thread::sleep,
    time::{Duration, Instant},
};

/// A fresh folder that is the working folder of a test.
struct Desk(PathBuf);

impl Desk {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("pontoon-cli-{name}-{}", std::process::id()));
        // Left over from a killed test of the same number, if at all.
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }

    fn command(&self, words: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_pontoon"));
        command.args(words).current_dir(&self.0).stdin(Stdio::null());
        command
    }

    fn pontoon(&self, words: &[&str]) -> Said {
        Said::from(self.command(words).output().unwrap())
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

    /// The tables of a run by name, whole.
    fn series(&self, run: &str) -> Vec<(String, String)> {
        let entries = fs::read_dir(self.path(run).join("series")).unwrap().flatten();
        let mut names: Vec<String> = entries.map(|e| e.file_name().into_string().unwrap()).collect();
        names.sort();
        names.into_iter().map(|name| (name.clone(), self.read(&format!("{run}/series/{name}")))).collect()
    }
}

impl Drop for Desk {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// What the program answered.
struct Said {
    code: Option<i32>,
    out: String,
    err: String,
}

impl From<Output> for Said {
    fn from(output: Output) -> Self {
        let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).expect("UTF-8");
        Self { code: output.status.code(), out: text(&output.stdout), err: text(&output.stderr) }
    }
}

impl Said {
    /// Ended with `code` and said all of `words` on standard error, without a panic.
    #[track_caller]
    fn refused(&self, code: i32, words: &[&str]) {
        assert_eq!(self.code, Some(code), "{}", self.err);
        assert!(!self.err.contains("panicked"), "{}", self.err);
        for word in words {
            assert!(self.err.contains(word), "\"{word}\" is not in:\n{}", self.err);
        }
    }
}

/// Every row of a table has as many fields as its header, and the last row is whole.
#[track_caller]
fn whole(name: &str, table: &str) {
    assert!(table.ends_with('\n'), "{name} ends within a row");
    let count = |line: &str| line.split(',').count();
    let header = table.lines().next().map_or(0, count);
    assert!(table.lines().all(|line| count(line) == header), "{name} has rows of different lengths");
}

#[test]
fn a_run_leaves_what_its_manifest_says_and_every_column_has_its_unit() {
    let desk = Desk::new("run");
    let said = desk.pontoon(&["run", "still-tank", "--until", "0.05", "--out", "a"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    for word in ["finished", "simulated", "particle-steps/s", "files in a", "series/low.csv", "frames.pvd"] {
        assert!(said.out.contains(word), "\"{word}\" is not in:\n{}", said.out);
    }
    let lines: Vec<&str> = said.err.lines().filter(|line| line.starts_with("t = ")).collect();
    assert!(!lines.is_empty() && lines.iter().all(|line| line.chars().count() <= 79), "{}", said.err);
    let manifest = desk.manifest("a");
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
        assert!(desk.path("a").join(file.as_str().unwrap()).is_file(), "{file} is named, but not there");
    }
    assert!(!desk.path("a/run.lock").exists(), "the lock goes with the run");
    const UNITS: [&str; 6] = ["_s", "_m", "_mps", "_Pa", "_N_per_m", "_Nm_per_m"];
    for (name, table) in desk.series("a") {
        whole(&name, &table);
        for column in table.lines().next().unwrap().split(',') {
            assert!(UNITS.iter().any(|unit| column.ends_with(unit)), "{name}: {column}");
        }
    }
}

#[test]
fn a_misspelt_key_is_told_where_it_stands_and_what_was_meant() {
    let desk = Desk::new("misspelt");
    let scene = include_str!("../scenes/buoyancy/scene.toml").replace("free  = { density", "free  = { densty");
    fs::write(desk.path("bay.toml"), scene).unwrap();
    let said = desk.pontoon(&["run", "bay.toml"]);
    said.refused(2, &["unknown key \"densty\"; did you mean \"density\"?", "bay.toml:18:11", "solid.box.free"]);
    assert!(!desk.path("runs").exists(), "nothing is written before the scene is known to be right");
}

#[test]
fn wrong_commands_are_told_what_to_do() {
    let desk = Desk::new("wrong");
    desk.pontoon(&["run", "raff"]).refused(2, &["there is no scene \"raff\"", "did you mean \"raft\"?"]);
    desk.pontoon(&["run", "bathtub"]).refused(2, &["\"bathtub\"", "pontoon scenes"]);
    desk.pontoon(&["run", "raft", "--dp", "-1"]).refused(2, &["dp must be a positive number, not -1"]);
    desk.pontoon(&["run", "raft", "--until", "0"]).refused(2, &["until"]);
    desk.pontoon(&["run", "raft", "--threads", "0"]).refused(2, &["0 threads cannot run anything"]);
    desk.pontoon(&["run", "raft", "--set", "dp"]).refused(2, &["write key=value"]);
    desk.pontoon(&["run", "raft", "--set", "solid.boot.free.density=1"]).refused(2, &["boot", "boat"]);
    desk.pontoon(&["run", "still-tank", "--dp", "1e-6"]).refused(2, &["particles", "or more"]);
    desk.pontoon(&["resume", "nowhere"]).refused(2, &["nowhere holds no run", "pontoon resume runs/raft"]);
    fs::write(desk.path("file"), "").unwrap();
    desk.pontoon(&["run", "raft", "--out", "file/x"]).refused(2, &["file/x: cannot be made", "--out"]);
    desk.pontoon(&["run", "raft", "--out", "."]).refused(2, &["is not empty"]);
    assert!(!desk.path("runs").exists());
}

#[test]
fn a_body_wider_than_its_tank_is_refused_before_the_run() {
    let desk = Desk::new("wide");
    for command in ["run", "inspect"] {
        let said = desk.pontoon(&[command, "buoyancy", "--set", "solid.box.shape.box.size=[1.4, 0.2]"]);
        said.refused(2, &["\"box\" starts ", " m inside \"tank\"", "make it smaller"]);
    }
    let table = "solid.box.at.draft=0.1";
    let file = "solid.tank.shape={polygon={file=\"../hull.csv\"}}";
    desk.pontoon(&["run", "buoyancy", "--set", table, "--set", file]).refused(2, &["leads out of the scene's folder"]);
}

#[test]
fn a_blow_up_names_the_particle_and_keeps_everything_recorded() {
    let desk = Desk::new("blow");
    let said = desk.pontoon(&["run", "still-tank", "--set", "guard.speed=1e-4", "--out", "a", "--quiet"]);
    said.refused(1, &["of water particle ", "step ", "Usual cause", "everything recorded so far is in a"]);
    let failure: serde_json::Value = serde_json::from_str(&desk.read("a/failure.json")).unwrap();
    assert!(failure["who"].as_str().is_some_and(|who| who.starts_with("water particle ")));
    assert!(failure["step"].as_u64().is_some() && failure["position"].as_array().is_some_and(|x| x.len() == 2));
    let manifest = desk.manifest("a");
    assert_eq!(manifest["status"], "failed");
    assert_eq!(manifest["fault"]["who"], failure["who"]);
    assert_eq!(manifest["error_code"], failure["code"]);
    for (name, table) in desk.series("a") {
        whole(&name, &table);
        assert!(table.lines().count() >= 2, "{name} has the row of the start");
    }
    assert!(desk.read("a/frames.pvd").ends_with("</VTKFile>\n"));
}

#[test]
fn help_and_lists_teach() {
    let desk = Desk::new("help");
    let shows = |words: &[&str], expected: &[&str]| {
        let said = desk.pontoon(words);
        assert_eq!(said.code, Some(0), "{}", said.err);
        for word in expected {
            assert!(said.out.contains(word), "{words:?} does not say \"{word}\":\n{}", said.out);
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
    assert_eq!(fs::read_dir(&desk.0).unwrap().count(), 0, "none of these writes anything");
    assert_eq!(desk.pontoon(&[]).code, Some(2));
}

#[test]
fn inspect_says_what_a_run_costs_and_what_looks_wrong_before_every_value() {
    let desk = Desk::new("inspect");
    // The reference sweep, as the memory of lists depends on the processor's lanes.
    let said = desk.pontoon(&["inspect", "raft", "--no-timing", "--sweep", "reference"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/inspect/raft.txt");
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, &said.out).unwrap();
    }
    let kept = fs::read_to_string(&path).unwrap_or_default();
    assert!(said.out == kept, "the page changed; renew with UPDATE_GOLDEN=1:\n{}", said.out);
    // The same as JSON, with a timing.
    let said = desk.pontoon(&["inspect", "still-tank", "--json", "--threads", "1"]);
    let json: serde_json::Value = serde_json::from_str(&said.out).unwrap();
    for key in ["/size/fluid", "/size/memory_bytes", "/sound/c0_mps", "/step/dt_s", "/timing/run_s"] {
        assert!(json.pointer(key).and_then(serde_json::Value::as_f64).is_some_and(|x| x > 0.0), "{key}");
    }
    assert!(json["findings"].as_array().is_some_and(Vec::is_empty), "{}", json["findings"]);
    assert_eq!(fs::read_dir(&desk.0).unwrap().count(), 0, "nothing is written");
}

#[test]
fn a_run_prints_its_warnings_and_keeps_them_in_the_manifest_and_no_notes() {
    let desk = Desk::new("warnings");
    let sets = ["--set", "model.c0_factor=5", "--set", "solid.apple.at.bottom=0.5"];
    let run = ["run", "raft", "--until", "0.002", "--set", "frames=off", "--out", "a"];
    let said = desk.pontoon(&[&run[..], &sets].concat());
    assert_eq!(said.code, Some(0), "{}", said.err);
    let words = ["warning: the speed of sound, 7.83 m/s, is only ", "c0 = "];
    assert!(words.iter().all(|word| said.err.contains(word)) && !said.err.contains("draft"), "{}", said.err);
    let warnings = desk.manifest("a")["warnings"].clone();
    assert_eq!(warnings.as_array().map(Vec::len), Some(1), "{warnings}");
    assert!(warnings[0].as_str().is_some_and(|w| w.contains("7.83 m/s")), "{warnings}");
}

#[test]
fn what_only_the_end_of_a_run_can_tell_is_told_at_its_end() {
    let desk = Desk::new("late");
    // Of 0.002 s a statistic from 5 s on has no reading.
    let late = "statistic=[{name=\"late\",waves=\"elevation\",from=5.0}]";
    let run = ["run", "raft", "--until", "0.002", "--set", "frames=off", "--no-report", "--set", late, "--out"];
    let text = desk.pontoon(&[&run[..], &["a"]].concat());
    assert_eq!(text.code, Some(0), "{}", text.err);
    let words = "statistic late: a series has no two readings in its time";
    assert_eq!(text.err.matches(&format!("warning: {words}\n")).count(), 1, "{}", text.err);
    assert!(text.out.contains("pontoon stats a\n"), "the end says where figures are: {}", text.out);
    let json = desk.pontoon(&[&run[..], &["b", "--log", "json"]].concat());
    let events: Vec<serde_json::Value> = json.err.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let [.., warning, end] = &events[..] else { panic!("{}", json.err) };
    assert!(warning["event"] == "warning" && warning["text"] == words && end["event"] == "end", "{}", json.err);
    assert_eq!(desk.manifest("b")["warnings"].as_array().map(Vec::len), Some(1));
}

/// Three cases that are known to be right, to stop, and to miss a bound that nothing can keep.
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
fn stress_tells_right_stopped_and_wrong_and_runs_nothing_twice() {
    let desk = Desk::new("stress");
    fs::write(desk.path("maps.toml"), PLANTED).unwrap();
    let words = ["stress", "--maps", "maps.toml", "--out", "s", "--threads", "2"];
    let said = desk.pontoon(&words);
    assert_eq!(said.code, Some(3), "{}\n{}", said.out, said.err);
    for word in ["still 0.02, 1: wrong: quiet ", "> -1", "all", "s/stress.json"] {
        assert!(said.out.contains(word), "\"{word}\" is not in:\n{}", said.out);
    }
    let kept: serde_json::Value = serde_json::from_str(&desk.read("s/stress.json")).unwrap();
    assert_eq!(kept["counts"], serde_json::json!({ "right": 1, "stopped": 1, "wrong": 1 }));
    let stopped = kept["trials"].as_array().unwrap().iter().find(|row| row["outcome"] == "stopped").unwrap();
    assert_eq!(stopped["values"][0], "6.0");
    assert!(stopped["end"]["refused"].as_str().is_some_and(|why| why.contains("Courant number of 6")), "{stopped}");
    let picture = desk.read("s/collapse.svg");
    assert!(["●", "■", "Courant number, –", "</svg>"].iter().all(|sign| picture.contains(sign)), "{picture}");

    // Another bound is judged from what was measured; another scene is run.
    fs::write(desk.path("maps.toml"), PLANTED.replace("-1.0", "1.0")).unwrap();
    let said = desk.pontoon(&[&words[..], &["--dry-run"]].concat());
    assert!(said.out.contains("still 0.02, 1: right") && said.out.contains("3 cases, 0 to be run"), "{}", said.out);
    assert_eq!(desk.pontoon(&words).code, Some(0));
    fs::write(desk.path("maps.toml"), PLANTED.replace("0.02]", "0.03]")).unwrap();
    assert!(desk.pontoon(&[&words[..], &["--dry-run"]].concat()).out.contains("3 cases, 1 to be run"));

    let tell = |from: &str, to: &str, words: &[&str]| {
        fs::write(desk.path("maps.toml"), PLANTED.replace(from, to)).unwrap();
        desk.pontoon(&["stress", "--maps", "maps.toml", "--out", "t"]).refused(2, words);
    };
    tell("cfl = ${x}", "cfl = ${x", &["collapse at 0.4, 2", "not closed"]);
    tell("cfl = ${x}", "clf = ${x}", &["collapse at 0.4, 2", "did you mean \"cfl\"?"]);
    tell("quiet]", "quite]", &["maps.toml:", "quite"]);
    desk.pontoon(&["stress", "flaot"]).refused(2, &["there is no map \"flaot\"", "did you mean \"float\"?"]);
    assert!(!desk.path("t").exists());
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_ends_as_an_unbroken_one_to_the_byte() {
    let desk = Desk::new("resume");
    let run = ["run", "raft", "--until", "0.15", "--set", "frames.every=0.03", "--quiet"];
    let mut running = desk.command(&run).args(["--out", "broken"]).spawn().unwrap();
    // Some steps into the run, and long before its end.
    let (begun, table) = (Instant::now(), desk.path("broken/series/energy.csv"));
    while fs::read_to_string(&table).map_or(0, |text| text.lines().count()) < 20 {
        assert!(begun.elapsed() < Duration::from_secs(60), "the run does not come to its 20th step");
        sleep(Duration::from_millis(5));
    }
    desk.pontoon(&["resume", "broken"]).refused(2, &["the run in broken still goes on: process "]);
    Command::new("kill").args(["-INT", &running.id().to_string()]).status().unwrap();
    assert_eq!(running.wait().unwrap().code(), Some(130));
    assert_eq!(desk.manifest("broken")["status"], "interrupted");

    let (checkpoint, scene) = (desk.path("broken/checkpoint.bin"), desk.path("broken/scene/scene.toml"));
    let (bytes, words) = (fs::read(&checkpoint).unwrap(), fs::read_to_string(&scene).unwrap());
    fs::write(&checkpoint, &bytes[..bytes.len() / 2]).unwrap();
    desk.pontoon(&["resume", "broken"]).refused(2, &["the checkpoint is cut short", "pontoon run"]);
    fs::write(&checkpoint, &bytes).unwrap();
    fs::write(&scene, words.replace("density = 300.0", "density = 310.0")).unwrap();
    desk.pontoon(&["resume", "broken"]).refused(2, &["is not the one that this run began with"]);
    fs::write(&scene, &words).unwrap();

    // Another number of threads makes no difference.
    let said = desk.pontoon(&["resume", "broken", "--threads", "1"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert_eq!(desk.pontoon(&[&run[..], &["--out", "unbroken"]].concat()).code, Some(0));
    let (broken, unbroken) = (desk.manifest("broken"), desk.manifest("unbroken"));
    assert_eq!(broken["steps"], unbroken["steps"]);
    assert_eq!(broken["particle_steps"], unbroken["particle_steps"]);
    assert!(desk.series("broken") == desk.series("unbroken"), "the tables differ");
    assert_eq!(desk.read("broken/frames.pvd"), desk.read("unbroken/frames.pvd"));
    desk.pontoon(&["resume", "broken"]).refused(2, &["has finished: there is nothing to go on with"]);
}

/// A study of small still tanks, with these words besides.
fn study<'a>(more: &[&'a str]) -> Vec<&'a str> {
    let words = ["study", "still-tank", "--dp", "0.1,0.05,0.025", "--until", "0.06", "--out", "s", "--quiet"];
    [&words[..], more].concat()
}

#[test]
fn a_study_runs_every_spacing_with_every_value_and_nothing_twice() {
    let desk = Desk::new("study");
    let vary = ["--vary", "model.viscosity={ artificial = { alpha = 0.02 } },none", "--set", "check.4.bound={}"];
    let dry = desk.pontoon(&study(&[&vary[..], &["--dry-run"]].concat()));
    assert_eq!(dry.code, Some(0), "{}", dry.err);
    assert!(!desk.path("s").exists(), "a dry run writes nothing");
    for word in ["dp-0.025_viscosity-none", "at the usual speed", "in all about"] {
        assert!(dry.out.contains(word), "\"{word}\" is not in:\n{}", dry.out);
    }
    let said = desk.pontoon(&study(&vary));
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert!(said.out.contains("{ artificial = { alpha = 0.02 } }") && said.out.contains("elevation.level_m"));
    let table = desk.read("s/study.csv");
    // Five checks of six runs, and the head.
    assert_eq!(table.lines().count(), 31, "{table}");
    let rows: Vec<&str> = table.lines().filter(|line| line.contains("elevation.level_m")).collect();
    assert!(rows.iter().all(|row| row.contains(",finished,")), "{table}");
    let json: serde_json::Value = serde_json::from_str(&desk.read("s/study.json")).unwrap();
    assert_eq!(json["rows"].as_array().map(Vec::len), Some(30));
    assert!(json["command"].as_str().is_some_and(|c| c.starts_with("pontoon study still-tank --dp 0.1,0.05,0.025")));
    let page = desk.read("s/study.html");
    for word in ["<svg", "processor time, s", "order, least squares", "Roache", "25 mm", "model.viscosity = none"] {
        assert!(page.contains(word), "\"{word}\" is not on the page");
    }
    let manifest = desk.manifest("s/runs/dp-0.05_viscosity-none");
    assert!(manifest["cpu_s"].as_f64().is_some_and(|x| x > 0.0) && manifest["particle_steps"].as_u64() > Some(0));
    // Nothing has changed, so nothing is run, and the times stay to the last digit.
    let again = desk.pontoon(&study(&[&vary[..], &["--dry-run"]].concat()));
    assert_eq!(again.out.matches("has been run").count(), 6, "{}", again.out);
    assert_eq!(desk.pontoon(&study(&vary)).code, Some(0));
    assert_eq!(desk.read("s/study.csv"), table);
    // A check that changes is judged anew without a run; a law that changes is run anew, the old run set aside.
    let strict = study(&[&vary[..], &["--set", "check.4.bound.off=0.0"]].concat());
    assert_eq!(desk.pontoon(&strict).code, Some(3));
    assert_eq!(desk.manifest("s/runs/dp-0.05_viscosity-none"), manifest);
    let other = study(&[&vary[..], &["--set", "time.cfl=0.3"]].concat());
    assert_eq!(desk.pontoon(&other).code, Some(0));
    assert_eq!(desk.manifest("s/runs/dp-0.05_viscosity-none.old"), manifest);
}

#[test]
fn repeats_tell_what_of_an_error_is_chance() {
    let desk = Desk::new("repeats");
    let words = ["study", "still-tank", "--dp", "0.1,0.05", "--until", "0.06", "--out", "s", "--quiet"];
    let asked = |more: &[&str]| desk.pontoon(&[&words[..], &["--set", "check.4.bound={}"], more].concat());
    let once = asked(&[]);
    assert_eq!(once.code, Some(0), "{}", once.err);
    assert!(!once.out.contains('±') && !desk.read("s/study.html").contains("Repeats"), "{}", once.out);
    let first = desk.manifest("s/runs/dp-0.05");
    let said = asked(&["--repeat", "3"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert_eq!(desk.manifest("s/runs/dp-0.05"), first, "the first repeat is what has been run");
    // A millionth of dp moves the level by far less than dp: the repeats agree in three digits, and the table says so.
    let told =
        said.out.lines().find(|line| line.contains("elevation.level_m") && line.contains('±')).unwrap_or_default();
    assert!(told.contains(" 3 ") && said.out.contains("chance"), "{}", said.out);
    // Five checks of six runs, and the head; each run has a folder and a row of its own.
    let table = desk.read("s/study.csv");
    assert!(table.starts_with("run,repeat,dp_m,check,N,") && table.lines().count() == 31, "{table}");
    assert_eq!(table.lines().filter(|line| line.starts_with("dp-0.05,3,0.05,")).count(), 5, "{table}");
    let scene = desk.manifest("s/runs/dp-0.05_repeat-3")["scene"].to_string();
    assert!(scene.contains("jitter = 0.000002"), "{scene}");
    let json: serde_json::Value = serde_json::from_str(&desk.read("s/study.json")).unwrap();
    let spreads = json["spreads"].as_array().unwrap();
    let level = |of: &&serde_json::Value| of["run"] == "dp-0.05" && of["check"] == "elevation.level_m";
    let level: Vec<_> = spreads.iter().filter(level).filter(|of| of["figure"] == "largest distance").collect();
    let [level] = level[..] else { panic!("{spreads:?}") };
    let figure = |key: &str| level[key].as_f64().unwrap();
    assert!(level["runs"] == 3 && figure("least") <= figure("mean") && figure("mean") <= figure("greatest"));
    assert!(figure("deviation") < 0.01 * 0.05, "a hundredth of dp: {level}");
    assert!(desk.read("s/study.html").contains("<h2>Repeats</h2>"));
    asked(&["--repeat", "0"]).refused(2, &["0 repeats run nothing"]);
    asked(&["--repeat", "2", "--vary", "scatter=1e-7,1e-6"]).refused(2, &["jitter tells repeats apart"]);
}

#[test]
fn a_study_runs_anew_when_a_table_that_drives_a_body_changes_but_not_for_a_reference() {
    let desk = Desk::new("study-tables");
    fs::create_dir(desk.path("bay")).unwrap();
    let scene = "dimension = 2\ndp = 0.1\nuntil = 0.05\n[[water]]\nfill = { box = { min = [0.0, 0.0], max = [1.0, 0.5] } }\n\
        [[solid]]\nname = \"tank\"\nfixed = true\nshape = { tank = { size = [1.0, 0.8] } }\n\
        [[solid]]\nname = \"lid\"\nshape = { box = { size = [0.2, 0.2] } }\nat = { x = 0.5, bottom = 0.9 }\n\
        driven = { along = [1.0, 0.0], distance = { file = \"lid.csv\", column = \"x_m\" } }\n\
        [[probe]]\nmotion = \"lid\"\n[[check]]\nseries = \"lid.surge_m\"\nreference = \"known.csv\"\ncolumn = \"x_m\"\n";
    let write = |name: &str, x: &str| fs::write(desk.path("bay").join(name), format!("t_s,x_m\n0.0,0.0\n0.05,{x}\n"));
    fs::write(desk.path("bay/scene.toml"), scene).unwrap();
    write("lid.csv", "0.1").and(write("known.csv", "0.1")).unwrap();
    let words = ["study", "bay", "--dp", "0.1", "--out", "s", "--quiet"];
    assert_eq!(desk.pontoon(&words).code, Some(0));
    let first = desk.manifest("s/runs/dp-0.1");
    write("known.csv", "0.2").unwrap();
    let said = desk.pontoon(&words);
    assert!(said.out.contains("0.500"), "judged anew, half as far as the reference:\n{}", said.out);
    assert_eq!(desk.manifest("s/runs/dp-0.1"), first);
    write("lid.csv", "0.2").unwrap();
    assert_eq!(desk.pontoon(&words).code, Some(0));
    assert_eq!(desk.manifest("s/runs/dp-0.1.old"), first);
}

#[test]
fn a_study_goes_on_when_a_run_fails_and_says_why() {
    let desk = Desk::new("study-fails");
    let said = desk.pontoon(&study(&["--vary", "guard.speed=1e-4,0.5", "--set", "check.4.bound={}"]));
    said.refused(1, &["dp-0.025_speed-1e-4 failed: ", "of water particle "]);
    let table = desk.read("s/study.csv");
    let count = |word: &str| table.lines().filter(|line| line.contains(word)).count();
    assert!(count(",failed,") >= 5 && count(",finished,") >= 15, "{table}");
    desk.pontoon(&study(&["--vary", "time.clf=6,0.4"])).refused(2, &["did you mean \"cfl\"?"]);
    desk.pontoon(&study(&["--vary", "time.cfl=0.4,"])).refused(2, &["a list of values has nothing in it"]);
    desk.pontoon(&study(&["--vary", "time.cfl=0.4,0.4"])).refused(2, &["two runs would be called"]);
}

#[cfg(unix)]
#[test]
fn an_interrupted_study_goes_on_by_the_same_command() {
    let desk = Desk::new("study-stops");
    let words = ["study", "raft", "--dp", "0.02,0.01", "--until", "0.15", "--out", "s", "--quiet"];
    let mut running = desk.command(&words).spawn().unwrap();
    let (begun, table) = (Instant::now(), desk.path("s/runs/dp-0.01/series/energy.csv"));
    while fs::read_to_string(&table).map_or(0, |text| text.lines().count()) < 20 {
        assert!(begun.elapsed() < Duration::from_secs(60), "the study does not come to its second run");
        sleep(Duration::from_millis(5));
    }
    Command::new("kill").args(["-INT", &running.id().to_string()]).status().unwrap();
    assert_eq!(running.wait().unwrap().code(), Some(130));
    assert!(desk.read("s/study.csv").contains(",interrupted,"));
    let first = desk.manifest("s/runs/dp-0.02");
    assert_eq!(desk.pontoon(&words).code, Some(0));
    assert_eq!(desk.manifest("s/runs/dp-0.02"), first, "what has finished is not run again");
    assert_eq!(desk.manifest("s/runs/dp-0.01")["status"], "finished");
    assert!(!desk.path("s/runs/dp-0.01.old").exists());
}

#[test]
fn validate_judges_cases_and_keeps_a_page() {
    let desk = Desk::new("validate");
    let said = desk.pontoon(&["validate", "dam-break", "--quiet"]);
    assert!(matches!(said.code, Some(0 | 3)), "{}", said.err);
    for word in ["case", "dam-break", "front.front_m", "N ≤ 0.14", "particle-steps", "validation/validation.html"] {
        assert!(said.out.contains(word), "\"{word}\" is not in:\n{}", said.out);
    }
    assert_eq!(said.code == Some(3), said.out.contains("MISSED"), "{}", said.out);
    let page = desk.read("validation/validation.html");
    assert_eq!(page.matches("<svg").count(), 2, "a plot for each check");
    // Its repeats are drawn together, and judged one by one.
    let twice = desk.pontoon(&["validate", "dam-break", "--quiet", "--repeat", "2"]);
    let page = desk.read("validation/validation.html");
    assert!(page.matches("<svg").count() == 2 && page.contains("2 runs"), "a plot for each check");
    assert!(twice.out.contains("dam-break, repeat 2") && twice.out.contains(" ± "), "{}", twice.out);
    let list = desk.pontoon(&["validate", "--list"]);
    assert!(list.out.contains("column-18") && list.out.contains("flume-box-c"), "{}", list.out);
    desk.pontoon(&["validate", "colum-18"]).refused(2, &["did you mean \"column-18\"?", "--list"]);
    desk.pontoon(&["validate", "--quick", "--full"]).refused(2, &["cannot be used with"]);
    let plan = desk.pontoon(&["validate", "--full", "--dry-run"]);
    assert!(plan.code == Some(0) && plan.out.contains("flume-box-a") && plan.out.contains("in all about"));
}

/// A full disk, as far as a test can make one: files longer than 20 kB cannot be written.
#[cfg(unix)]
#[test]
fn a_full_disk_ends_the_run_with_whole_rows() {
    let desk = Desk::new("full");
    let program = Path::new(env!("CARGO_BIN_EXE_pontoon")).display().to_string();
    let words = "run still-tank --until 0.3 --set frames=off --out a --quiet";
    let limited = format!("trap '' XFSZ; ulimit -f 40; exec '{program}' {words}");
    let said = Said::from(Command::new("sh").args(["-c", &limited]).current_dir(&desk.0).output().unwrap());
    said.refused(2, &["a/series/energy.csv: cannot be written", "what was written before is intact"]);
    assert_eq!(desk.manifest("a")["status"], "failed");
    for (name, table) in desk.series("a") {
        whole(&name, &table);
        assert!(table.lines().count() > 50, "{name} keeps the rows before");
    }
}

#[test]
fn a_run_is_told_in_figures_watched_and_exported() {
    let desk = Desk::new("figures");
    let said = desk.pontoon(&["run", "still-tank", "--until", "0.05", "--out", "a", "--quiet", "--no-report"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let figures = desk.read("a/statistics.csv");
    assert!(figures.starts_with("name,series,quantity,value,unit,from_s,until_s\n"));
    whole("statistics.csv", &figures);
    let stats = desk.pontoon(&["stats", "a", "--series", "low"]);
    assert!(stats.code == Some(0) && stats.out.contains("low.p_Pa") && !stats.out.contains("tank"), "{}", stats.out);
    let json = desk.pontoon(&["stats", "a", "--json", "--from", "0.01"]);
    let rows: serde_json::Value = serde_json::from_str(&json.out).unwrap();
    assert!(rows.as_array().is_some_and(|rows| rows.iter().all(|row| row["from_s"].as_f64() >= Some(0.01))));
    desk.pontoon(&["stats", "a", "--series", "lo"]).refused(2, &["nothing to tell", "low"]);
    desk.pontoon(&["stats", "b"]).refused(2, &["b"]);
    desk.pontoon(&["stats", "a", "--from", "9"]).refused(2, &["the readings in a end at 0.05 s", "--from"]);
    desk.pontoon(&["stats", "a", "--from", "0.04", "--until", "0.01"]).refused(2, &["there is no time"]);

    let watched = desk.pontoon(&["watch", "a", "--series", "low.p_Pa"]);
    assert_eq!(watched.code, Some(0), "{}", watched.err);
    for word in ["finished: t = 0.050 of 0.05 s", " at the last frame, energy ", " J/m\n", "low.p_Pa", "now"] {
        assert!(watched.out.contains(word), "\"{word}\" is not in:\n{}", watched.out);
    }
    assert!(watched.out.chars().any(|c| ('\u{2801}'..='\u{28ff}').contains(&c)), "a curve in dots:\n{}", watched.out);
    desk.pontoon(&["watch", "a", "--once", "--series", "low.p_pa"]).refused(2, &["did you mean \"low.p_Pa\"?"]);

    let rows = "low.p_Pa,0.0,1.5,Pa²/Hz\nlow.p_Pa,0.5,2.5,Pa²/Hz\n";
    fs::write(desk.path("a/spectra.csv"), format!("series,f_Hz,S,unit\n{rows}")).unwrap();
    // Two statistics of one name: both are kept.
    let row = |f: f64, ratio: f64| format!("sea,low.p_Pa,{f:?},{:?},{ratio:?},Pa/m,-90.0,0.75\n", 1.0 / f);
    let rows = [row(0.5, 1.5), row(0.625, 1.25), row(0.5, 3.5)].concat();
    let head = "name,series,frequency_hz,period_s,rao,unit,phase_deg,coherence\n";
    fs::write(desk.path("a/rao.csv"), format!("{head}{rows}")).unwrap();
    let exported = desk.pontoon(&["export", "a", "--npz", "b.npz"]);
    assert_eq!(exported.code, Some(0), "{}", exported.err);
    let bytes = fs::read(desk.path("b.npz")).unwrap();
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
        "the numbers, in a row"
    );
    assert!(holds(b"rao.sea_2.low.p_Pa.rao.npy") && exported.out.contains("2 RAOs"), "{}", exported.out);
    for words in [&["export", "a", "--npz", "no/b.npz"][..], &["report", "a", "--png", "no/b.png"]] {
        desk.pontoon(words).refused(2, &["there is no folder no", "make it first"]);
    }
    desk.pontoon(&["export", "a"]).refused(2, &["--npz"]);
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
fn answers_to_irregular_waves_are_printed_beside_the_figures_which_stay_as_they_are() {
    let desk = Desk::new("answers");
    fs::write(desk.path("buoy.toml"), BUOY).unwrap();
    let said = desk.pontoon(&["run", "buoy.toml", "--out", "a", "--quiet", "--no-report"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let plain = desk.pontoon(&["stats", "a"]);
    assert!(plain.code == Some(0) && !plain.out.contains("coherence"), "0.01 s have no waves: {}", plain.out);
    desk.pontoon(&["stats", "a", "--rao"]).refused(2, &["irregular waves", "[[statistic]]", "32 waves"]);
    // A hundred waves of three periods, to which the buoy rises twice as high.
    let (mut gauge, mut buoy) = (String::from("t_s,level_m,eta_m\n"), String::from("t_s,heave_m\n"));
    for i in 0..4000 {
        let t = 0.05 * f64::from(i);
        let eta: f64 = [0.4, 0.5, 0.6].iter().map(|f| 0.01 * (std::f64::consts::TAU * f * t).sin()).sum();
        gauge += &format!("{t:?},{:?},{eta:?}\n", 0.4 + eta);
        buoy += &format!("{t:?},{:?}\n", 2.0 * eta);
    }
    fs::write(desk.path("a/series/gauge.csv"), gauge).unwrap();
    fs::write(desk.path("a/series/buoy.csv"), buoy).unwrap();

    let all = desk.pontoon(&["stats", "a"]);
    let tables: Vec<&str> = all.out.split("\n\n").collect();
    assert!(tables.len() == 3 && tables[1].contains("from (s)"), "series, statistics, answers: {}", all.out);
    for word in ["statistic", "frequency (Hz)", "period (s)", "rao", "unit", "phase (°)", "coherence", "sea", "m/m"] {
        assert!(tables[2].contains(word), "\"{word}\" is not in:\n{}", tables[2]);
    }
    assert_eq!(desk.pontoon(&["stats", "a", "--rao"]).out, tables[2], "alone");
    let rows = |words: &[&str]| -> Vec<serde_json::Value> { serde_json::from_str(&desk.pontoon(words).out).unwrap() };
    let figures = rows(&["stats", "a", "--json"]);
    assert!(figures.iter().all(|row| row.as_object().is_some_and(|row| row.len() == 7) && row["value"].is_number()));
    let answers = rows(&["stats", "a", "--rao", "--json"]);
    assert_eq!(answers.len(), tables[2].lines().count() - 1);
    for row in answers {
        assert!(row["name"] == "sea" && row["series"] == "buoy.heave_m" && row["unit"] == "m/m", "{row}");
        let number = |key: &str| row[key].as_f64().unwrap();
        assert!((number("frequency_hz") * number("period_s") - 1.0).abs() < 1e-12, "{row}");
        // A multiple of the wave is that multiple at every frequency, but for round-off.
        let off = [number("rao") - 2.0, number("phase_deg"), number("coherence") - 1.0];
        assert!(off.iter().all(|off| off.abs() < 1e-6), "{row}");
    }
    let none = desk.pontoon(&["stats", "a", "--rao", "--until", "20"]);
    none.refused(2, &["irregular waves"]);
}

#[test]
fn a_run_under_way_is_told_from_a_killed_one() {
    let desk = Desk::new("alive");
    let said = desk.pontoon(&["run", "still-tank", "--until", "0.05", "--out", "a", "--quiet", "--no-report"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let finished = desk.read("a/manifest.json");
    let words = [
        ("\"finished\"", "\"running\""),
        ("\"until_s\": 0.05", "\"until_s\": 0.1"),
        ("\"warnings\": []", "\"warnings\": [\"a\"]"),
    ];
    let running = words.iter().fold(finished, |text, (from, to)| text.replace(from, to));
    fs::write(desk.path("a/manifest.json"), running).unwrap();
    let watched = desk.pontoon(&["watch", "a"]).out;
    for word in ["running, or killed: t = 0.050 of 0.1 s", "1 warning\n", "a simulated second takes ", " left\n"] {
        assert!(watched.contains(word), "\"{word}\" is not in:\n{watched}");
    }
    if cfg!(target_os = "linux") {
        let mut gone = desk.command(&["scenes"]).stdout(Stdio::null()).spawn().unwrap();
        gone.wait().unwrap();
        let lock =
            |id: u32| fs::write(desk.path("a/run.lock"), format!("{id}\n")).map(|()| desk.pontoon(&["watch", "a"]).out);
        assert!(lock(gone.id()).unwrap().contains(&format!("killed (process {} is gone): t = ", gone.id())));
        assert!(lock(std::process::id()).unwrap().contains(&format!("running (process {}): t = ", std::process::id())));
    }
}

#[test]
fn frames_are_chosen_on_the_command_line_and_counted_at_the_end() {
    let desk = Desk::new("frames");
    let run = |every: &str, out: &str| {
        let words = ["run", "still-tank", "--until", "0.02", "--frames", every, "--out", out, "--no-report"];
        desk.pontoon(&words)
    };
    let said = run("0.01", "a");
    assert!(
        said.code == Some(0) && said.out.contains("  3 frames, ") && said.out.contains(", in frames/\n"),
        "{}",
        said.out
    );
    let there: u64 =
        fs::read_dir(desk.path("a/frames")).unwrap().map(|file| file.unwrap().metadata().unwrap().len()).sum();
    assert_eq!(desk.manifest("a")["frames"], serde_json::json!({ "count": 3, "bytes": there }));
    let said = run("off", "b");
    assert!(said.code == Some(0) && !said.out.contains("frames"), "{}{}", said.out, said.err);
    assert_eq!(desk.manifest("b")["frames"]["count"], 0);
    run("-1", "c").refused(2, &["every must be a positive number, not -1"]);
    run("of", "c").refused(2, &["--frames 0.05, or off"]);
}

#[test]
fn an_error_in_a_built_in_scene_names_the_scene() {
    let desk = Desk::new("built-in");
    for words in
        [&["run", "raft", "--dp", "0.5"][..], &["inspect", "raft", "--dp", "0.5"], &["study", "raft", "--dp", "0.5"]]
    {
        let said = desk.pontoon(words);
        said.refused(2, &["in raft/scene.toml:"]);
        assert!(!said.err.contains("pontoon-"), "{}", said.err);
    }
}

#[test]
#[cfg(not(feature = "surface"))]
fn an_export_of_surfaces_by_a_program_without_them_names_the_remedy() {
    let desk = Desk::new("no-surface");
    desk.pontoon(&["export", ".", "--surface"])
        .refused(2, &["built without meshes of the free surface", "cargo install --path . --features surface"]);
}

#[test]
#[cfg(feature = "surface")]
fn the_surface_of_a_run_in_space_is_exported_as_meshes_and_that_of_a_section_is_refused() {
    let desk = Desk::new("surface");
    for (scene, folder) in [("still-tank", "flat"), ("still-tank-3d", "deep")] {
        let words = ["run", scene, "--until", "0.02", "--set", "frames.every=0.01", "--out", folder, "--no-report"];
        let said = desk.pontoon(&words);
        assert_eq!(said.code, Some(0), "{}", said.err);
    }
    let said = desk.pontoon(&["export", "deep", "--surface", "--npz"]);
    assert!(said.code == Some(0) && said.out.contains("surface.pvd: 3 meshes"), "{}{}", said.out, said.err);
    assert!(desk.read("deep/surface.pvd").contains("file=\"surface/surface_00002.vtu\""));
    let mesh = fs::read(desk.path("deep/surface/surface_00002.vtu")).unwrap();
    assert!(String::from_utf8_lossy(&mesh).contains("Name=\"velocity\"") && desk.path("deep/series.npz").exists());
    desk.pontoon(&["export", "flat", "--surface"]).refused(2, &["2-D", "pontoon report"]);
}

#[test]
fn a_log_for_programs_is_an_object_a_line_from_start_to_end_or_error() {
    let desk = Desk::new("log");
    let run = |more: &[&str]| desk.pontoon(&[&["run", "still-tank", "--log", "json"], more].concat());
    let events = |said: &Said| -> Vec<serde_json::Value> {
        said.err.lines().map(|line| serde_json::from_str(line).unwrap_or_else(|e| panic!("{e}: {line}"))).collect()
    };
    let said = run(&["--until", "0.02", "--out", "a"]);
    assert_eq!((said.code, said.out.as_str()), (Some(0), ""), "{}", said.err);
    let told = events(&said);
    assert_eq!((&told[0]["event"], &told[told.len() - 1]["event"]), (&"start".into(), &"end".into()));
    assert_eq!(told[told.len() - 1]["status"], "finished");
    assert!(told[told.len() - 1]["frames"].as_u64().is_some_and(|count| count > 0));
    let last = told.iter().rfind(|event| event["event"] == "progress").unwrap();
    assert_eq!(last["warnings"], 0);
    assert!(last["energy_change_J_per_m"].is_number() && last["energy_residual"].is_null(), "by its probe: {last}");
    assert_eq!((last["t_s"].as_f64(), last["until_s"].as_f64()), (Some(0.02), Some(0.02)));
    let wrong = run(&["--dp", "-1"]);
    assert_eq!(wrong.code, Some(2));
    assert_eq!((&events(&wrong)[0]["event"], &events(&wrong)[0]["code"]), (&"error".into(), &"out-of-range".into()));
    assert!(events(&wrong)[0]["text"].as_str().is_some_and(|text| text.contains("dp must be a positive number")));
    let quiet = run(&["--until", "0.02", "--out", "b", "--quiet"]);
    assert_eq!((quiet.code, quiet.out.as_str(), quiet.err.as_str()), (Some(0), "", ""));
    assert_eq!(events(&run(&["--dp", "-1", "--quiet"]))[0]["event"], "error");
}

#[test]
fn editors_and_shells_are_told_what_there_is() {
    let desk = Desk::new("schema");
    let schema: serde_json::Value = serde_json::from_str(&desk.pontoon(&["schema"]).out).unwrap();
    assert_eq!(schema["title"], "A scene of pontoon");
    assert!(schema["properties"]["water"].is_object());
    for shell in ["bash", "zsh", "fish"] {
        let said = desk.pontoon(&["completions", shell]);
        assert!(said.code == Some(0) && said.out.contains("inspect"), "{shell}: {}", said.err);
    }
    desk.pontoon(&["completions", "dos"]).refused(2, &["bash"]);
}
