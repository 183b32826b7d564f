//! `--live`: the protocol of the live page, and the page in a browser. All tests run the binary. Without Chromium the browser test
//! prints "skipped" and passes; CI needs it. `LIVE_SECONDS=3600 cargo test --release --test live` watches the memory for an hour.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout, clippy::print_stderr, reason = "tests may")]
#![cfg(unix)]

#[path = "support/chromium.rs"]
mod support;

use std::{
    fs::{self, File},
    io::{BufRead, BufReader, Read, Write},
    net::{TcpListener, TcpStream},
    path::{Path, PathBuf},
    process::{Child, Command, Output, Stdio},
    thread::{self, sleep},
    time::{Duration, Instant},
};

use pontoon::{
    output::{Checkpoint, Manifest, SeriesTable, manifest::RunStatus},
    report,
};
use serde_json::{Value, json};
use support::chromium;

/// A floating box in a small tank, for as long as it is asked.
const BAY: &str = r#"
title     = "A box & a gauge"
dimension = 2
dp        = 0.02
until     = 1000.0

[[water]]
fill = { box = { min = [0.0, 0.0], max = [0.8, 0.3] } }

[[solid]]
name  = "tank"
fixed = true
shape = { tank = { size = [0.8, 0.5] } }

[[solid]]
name  = "box"
shape = { box = { size = [0.16, 0.12] } }
at    = { x = 0.5, draft = "equilibrium", angle_deg = 5.0 }
free  = { density = 500.0 }

[[probe]]
motion = "box"
every  = 0.005

[[probe]]
name      = "gauge"
elevation = { x = 0.2 }

[frames]
every = 0.02
"#;

/// An empty folder for the test `name`, with the scene.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("live-{name}"));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    fs::write(folder.join("bay.toml"), BAY).unwrap();
    folder
}

fn pontoon(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pontoon"));
    command.args(arguments).current_dir(folder).stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// A run with a live page. It is killed when this is dropped.
struct LiveRun {
    child: Child,
    folder: PathBuf,
    port: u16,
    token: String,
}

impl LiveRun {
    /// Runs the scene of `folder` in its folder `out` with the arguments `more`.
    fn start(folder: &Path, out: &str, more: &[&str]) -> Self {
        Self::from_command(folder, out, &[&["run", "bay.toml", "--out", out, "--live", "--quiet"], more].concat())
    }

    fn from_command(folder: &Path, out: &str, arguments: &[&str]) -> Self {
        let mut child = pontoon(folder, arguments).spawn().unwrap();
        let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
        let address =
            lines.find_map(|line| Some(line.unwrap().strip_prefix("live page: http://127.0.0.1:")?.to_string()));
        let address = address.expect("the address is printed");
        let (port, token) = address.split_once("/?token=").unwrap();
        // Nothing the run says may block it.
        thread::spawn(move || lines.for_each(drop));
        Self { child, folder: folder.join(out), port: port.parse().unwrap(), token: token.into() }
    }

    /// Sends `text` and returns the status and the body of the answer; 0 if there is none.
    fn send(&self, text: &str) -> (u16, String) {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        // A refused request may be cut short.
        let _ = stream.write_all(text.as_bytes());
        let mut answer = Vec::new();
        let _ = stream.read_to_end(&mut answer);
        let answer = String::from_utf8_lossy(&answer).into_owned();
        let status = answer.split(' ').nth(1).map_or(0, |status| status.parse().unwrap());
        (status, answer.split_once("\r\n\r\n").map(|(_, body)| body.to_string()).unwrap_or_default())
    }

    /// A head for this server without the empty line at its end; `path` has no token yet.
    fn head(&self, method: &str, path: &str) -> String {
        format!("{method} {path}?token={} HTTP/1.1\r\nHost: 127.0.0.1:{}", self.token, self.port)
    }

    /// Presses a button and returns the state of the run.
    fn post(&self, path: &str) -> Value {
        let (status, body) = self.send(&(self.head("POST", path) + "\r\n\r\n"));
        assert_eq!(status, 200, "{body}");
        serde_json::from_str(&body).unwrap()
    }

    /// Pauses the run and returns its state between two steps.
    fn hold(&self) -> Value {
        let until = Instant::now() + Duration::from_secs(20);
        loop {
            let state = self.post("/pause");
            if state["held"] == true {
                return state;
            }
            assert!(Instant::now() < until, "the run is held after its step: {state}");
            sleep(Duration::from_millis(20));
        }
    }

    /// Lets the run go on from the state `held` until it has taken a step.
    fn advance(&self, held: &Value) {
        let until = Instant::now() + Duration::from_secs(20);
        while self.post("/resume")["t"].as_f64() <= held["t"].as_f64() {
            assert!(Instant::now() < until, "the run takes a step after {held}");
        }
    }

    /// The data of the scripts of the page.
    fn page_data(&self) -> Value {
        let (status, page) = self.send(&(self.head("GET", "/") + "\r\n\r\n"));
        assert_eq!(status, 200, "{page}");
        let data = page.split("id=\"told\">").nth(1).and_then(|rest| rest.split("</script>").next()).unwrap();
        serde_json::from_str(data).unwrap()
    }

    /// Where the events after the page begin.
    fn position(&self) -> String {
        let live = &self.page_data()["live"];
        format!("{}.{}", live["rollbacks"], live["position"].as_str().unwrap())
    }

    /// The events from `position` on.
    fn events(&self, position: &str) -> Events {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        let head = self.head("GET", "/events").replace(" HTTP", &format!("&from={position} HTTP"));
        stream.write_all((head + "\r\n\r\n").as_bytes()).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
        Events(BufReader::new(stream))
    }

    /// Presses Ctrl-C.
    fn interrupt(&self) {
        let id = self.child.id().to_string();
        assert!(Command::new("kill").args(["-INT", &id]).status().unwrap().success());
    }

    /// Waits for the end and returns the exit code.
    fn wait(&mut self) -> Option<i32> {
        self.child.wait().unwrap().code()
    }

    /// The memory of the process, kB, where the system tells.
    fn memory(&self) -> Option<u64> {
        let status = fs::read_to_string(format!("/proc/{}/status", self.child.id())).ok()?;
        status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?.trim().trim_end_matches(" kB").parse().ok()
    }
}

impl Drop for LiveRun {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A stream of events.
struct Events(BufReader<TcpStream>);

impl Events {
    /// The next event: its kind, its identifier and its data.
    fn next(&mut self) -> (String, String, Value) {
        let mut event = <[String; 3]>::default();
        loop {
            let mut line = String::new();
            assert!(self.0.read_line(&mut line).unwrap() > 0, "the stream goes on");
            for (part, name) in event.iter_mut().zip(["event: ", "id: ", "data: "]) {
                if let Some(rest) = line.strip_prefix(name) {
                    *part = rest.trim_end().into();
                }
            }
            if line == "\n" && !event[0].is_empty() {
                let [kind, id, data] = event;
                return (kind, id, serde_json::from_str(&data).unwrap());
            }
        }
    }
}

#[test]
fn requests_without_the_token_or_from_elsewhere_are_refused() {
    let run = LiveRun::start(&folder("refused"), "a", &[]);
    let (port, good) = (run.port, run.head("POST", "/pause"));
    let (own, other) =
        (format!("http://127.0.0.1:{port}"), run.token.replace(['0', '1', '2', '3', '4', '5', '6', '7'], "8"));
    let with = |more: &str| format!("{good}\r\n{more}\r\n\r\n");
    let hosted = |host: &str| good.replace(&format!("Host: 127.0.0.1:{port}"), &format!("Host: {host}")) + "\r\n\r\n";
    let tokened = |token: &str| good.replace(&run.token, token) + "\r\n\r\n";
    let cases = [
        (200, with("X: y")),
        (200, with(&format!("Origin: {own}"))),
        (200, hosted(&format!("localhost:{port}"))),
        (403, tokened("")),
        (403, tokened(&other)),
        (403, tokened(&run.token[..31])),
        (403, format!("POST /pause HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n")),
        (403, hosted("evil.example")),
        (403, hosted("127.0.0.1")),
        (403, hosted(&format!("evil.example:{port}"))),
        (400, good.replace("\r\nHost", "\r\nGuest") + "\r\n\r\n"),
        (400, with(&format!("Host: 127.0.0.1:{port}"))),
        (403, with("Origin: http://evil.example")),
        (403, with("Origin: null")),
        (403, with(&format!("Origin: https://127.0.0.1:{port}"))),
        (403, with(&format!("Origin: http://localhost:{port}"))),
        (404, good.replace("/pause", "/other") + "\r\n\r\n"),
        (405, good.replace("POST", "GET") + "\r\n\r\n"),
        (400, good.replace("POST", "GET").replace("/pause", "/events") + "\r\n\r\n"),
        (400, "nonsense\r\n\r\n".into()),
        (400, good.replace(" HTTP/1.1", "") + "\r\n\r\n"),
        (431, with(&format!("X: {}", "y".repeat(9000)))),
        (413, with("Content-Length: 5000")),
        (400, with("Content-Length: many")),
        (411, with("Transfer-Encoding: chunked")),
    ];
    for (status, request) in cases {
        let answer = run.send(&request);
        assert_eq!(answer.0, status, "{request:?}: {answer:?}");
    }
    // A request that stops half way is answered after some seconds, and does not stop others.
    let mut slow = TcpStream::connect(("127.0.0.1", port)).unwrap();
    slow.write_all(b"POST /pause").unwrap();
    assert_eq!(run.post("/resume")["paused"], false);
    let mut answer = String::new();
    slow.read_to_string(&mut answer).unwrap();
    assert!(answer.starts_with("HTTP/1.1 408 "), "{answer}");
    // The page names no other host.
    let (_, page) = run.send(&(run.head("GET", "/") + "\r\n\r\n"));
    for word in ["src=", "@import", "url(", "XMLHttpRequest", "href=\"http"] {
        assert!(!page.contains(word), "{word:?} is on the page");
    }
}

#[test]
fn a_paused_run_waits_writes_a_checkpoint_and_goes_on_to_the_same_bits() {
    let folder = folder("pause");
    let short = ["--until", "1"];
    let mut run = LiveRun::start(&folder, "a", &short);
    let held = run.hold();
    sleep(Duration::from_millis(600));
    assert_eq!(run.post("/pause")["steps"], held["steps"], "no step is taken");
    assert!(!run.folder.join("checkpoint.bin").exists() && held["checkpoint"].is_null());
    let mut written = run.post("/checkpoint");
    for _ in 0..500 {
        if written["checkpoint"] == held["t"] {
            break;
        }
        sleep(Duration::from_millis(20));
        written = run.post("/pause");
    }
    assert_eq!((&written["checkpoint"], &written["steps"]), (&held["t"], &held["steps"]), "{written}");
    assert_eq!(json!(Checkpoint::read(&run.folder.join("checkpoint.bin")).unwrap().time), held["t"]);
    assert_eq!(Manifest::read(&run.folder).unwrap().steps, held["steps"]);
    run.advance(&held);
    let later = run.hold();
    run.interrupt();
    assert_eq!(run.wait(), Some(130), "Ctrl-C ends a paused run");
    let manifest = Manifest::read(&run.folder).unwrap();
    assert_eq!((manifest.status, json!(manifest.simulated_s)), (RunStatus::Interrupted, later["t"].clone()));

    let mut resumed = LiveRun::from_command(&folder, "a", &["resume", "a", "--live", "--quiet"]);
    assert_eq!(resumed.wait(), Some(0));
    let plain = pontoon(&folder, &["run", "bay.toml", "--out", "b", "--quiet", "--until", "1"]).output().unwrap();
    assert!(plain.status.success());
    for name in ["series/box.csv", "series/gauge.csv", "frames.pvd"] {
        assert!(
            fs::read(folder.join("a").join(name)).unwrap() == fs::read(folder.join("b").join(name)).unwrap(),
            "{name}"
        );
    }
}

#[test]
fn events_hold_every_row_and_the_end_and_the_report_is_that_of_any_run() {
    let folder = folder("events");
    let mut run = LiveRun::start(&folder, "a", &["--until", "2"]);
    run.hold();
    let (data, position) = (run.page_data(), run.position());
    let runs = &data["runs"][0];
    assert!(runs["reel"]["times"].as_array().is_some_and(|times| !times.is_empty()), "the page has frames");
    let mut events = run.events(&position);
    run.post("/resume");
    let (mut times, mut frames, mut ticks) = (Vec::new(), Vec::new(), 0);
    let end = loop {
        let (kind, id, data) = events.next();
        if kind == "end" {
            break data;
        }
        assert_eq!(kind, "tick");
        ticks += 1;
        times.extend(data["added"]["rows"]["box"][0].as_array().into_iter().flatten().map(|t| t.as_f64().unwrap()));
        frames.extend(data["added"]["reel"]["times"].as_array().into_iter().flatten().map(|t| t.as_f64().unwrap()));
        // After an interruption the stream goes on where it was.
        if ticks == 2 {
            run.hold();
            events = run.events(&id);
            run.post("/resume");
        }
    };
    assert_eq!(run.wait(), Some(0));
    let series = SeriesTable::read(&run.folder.join("series/box.csv")).unwrap();
    let before = series.times.len() - times.len();
    assert!(
        times == series.times[before..] && ticks > 2,
        "{ticks} events, {} of {} rows",
        times.len(),
        series.times.len()
    );
    let newest = frames.iter().copied().fold(0.0, f64::max);
    assert!(newest >= 2.0 - 1e-9 && frames.len() > 5, "{} frames up to {newest} s", frames.len());
    assert_eq!((&end["status"], &end["error"]), (&json!("finished"), &Value::Null));
    let page = run.folder.join(report::REPORT_FILE);
    assert!(page.ends_with("a/report.html") && end["report"].as_str().unwrap().ends_with("a/report.html"), "{end}");
    let written = fs::read(&page).unwrap();
    report::write(&run.folder).unwrap();
    assert!(written == fs::read(&page).unwrap(), "the report of a live run is that of its folder");
    assert!(!String::from_utf8_lossy(&written).contains("EventSource"));
}

#[test]
fn a_taken_port_is_refused_before_anything_is_written() {
    let folder = folder("port");
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port();
    let refused =
        |more: &str| -> Output { pontoon(&folder, &["run", "bay.toml", "--out", "a", more]).output().unwrap() };
    let output = refused(&format!("--live={port}"));
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(text.contains(&format!("port {port} of 127.0.0.1")) && text.contains("choose another port"), "{text}");
    assert!(!folder.join("a").exists());
    assert_eq!(refused("--live=70000").status.code(), Some(2));
}

/// A box on a slider with a motor, and a thruster on it; both may be changed.
const CONTROLLED: &str = r#"
[[joint]]
name    = "rail"
kind    = "slider"
between = ["box"]
at      = [0.5, 0.3]
along   = [1.0, 0.0]
motor   = { velocity = 0.0, damping = 200.0 }

[[force]]
name  = "thruster"
on    = "box"
force = [0.0, 0.0]

[[probe]]
joint = "rail"
every = 0.001

[[control]]
key = "joint.rail.motor.velocity"
min = -0.5
max = 0.5

[[control]]
key = "force.thruster.force.0"
min = 0.0
max = 20.0
"#;

#[test]
fn a_control_changes_a_motor_and_a_resumed_run_keeps_the_change() {
    let folder = folder("control");
    fs::write(folder.join("bay.toml"), format!("{BAY}{CONTROLLED}")).unwrap();
    let mut run = LiveRun::start(&folder, "a", &["--until", "0.5"]);
    let set = |body: &str| {
        let head = run.head("POST", "/set");
        run.send(&format!("{head}\r\nContent-Length: {}\r\n\r\n{body}", body.len()))
    };
    let held = run.hold();
    let controls = held["controls"].as_array().unwrap();
    assert_eq!(
        controls[0],
        json!({ "key": "joint.rail.motor.velocity", "unit": "m/s", "min": -0.5, "max": 0.5, "value": 0.0 })
    );
    assert_eq!(controls.len(), 2);
    let refused = [
        ("{\"key\": \"joint.rail.motor.velocity\", \"value\": 0.6}", "from min to max"),
        ("{\"key\": \"joint.rail.motor.velocity\", \"value\": null}", "from min to max"),
        ("{\"key\": \"joint.rail.motor.damping\", \"value\": 1.0}", "no such [[control]]"),
        ("{}", "no such [[control]]"),
        ("velocity = 1", "no JSON"),
    ];
    for (body, part) in refused {
        let (status, text) = set(body);
        assert!(status == 400 && text.contains(part), "{body}: {status} {text}");
    }
    for (key, value) in [("joint.rail.motor.velocity", 0.4), ("force.thruster.force.0", 5.0)] {
        assert_eq!(set(&json!({ "key": key, "value": value }).to_string()).0, 200);
    }
    run.post("/checkpoint");
    let until = Instant::now() + Duration::from_secs(20);
    while run.post("/pause")["checkpoint"] != held["t"] {
        assert!(Instant::now() < until, "the checkpoint is written");
        sleep(Duration::from_millis(20));
    }
    let state = run.post("/pause");
    assert_eq!([&state["controls"][0]["value"], &state["controls"][1]["value"]], [&json!(0.4), &json!(5.0)]);
    // A copy of the folder goes on from the checkpoint to the same bits as the run itself.
    assert!(Command::new("cp").args(["-r", "a", "b"]).current_dir(&folder).status().unwrap().success());
    run.post("/resume");
    assert_eq!(run.wait(), Some(0));
    let resumed = pontoon(&folder, &["resume", "b", "--quiet"]).output().unwrap();
    assert!(resumed.status.success(), "{}", String::from_utf8_lossy(&resumed.stderr));
    let series = |name: &str| fs::read(folder.join(name).join("series/rail.csv")).unwrap();
    assert!(series("a") == series("b"));
    let table = SeriesTable::read(&folder.join("a/series/rail.csv")).unwrap();
    let rate = &table.values[table.columns.iter().position(|name| name.contains("mps")).unwrap()];
    assert!((rate[rate.len() - 1] - 0.4).abs() < 0.1, "the box goes at {} m/s", rate[rate.len() - 1]);
    for name in ["a", "b"] {
        let manifest = Manifest::read(&folder.join(name)).unwrap();
        let notes: Vec<&String> = manifest.notes.iter().filter(|note| note.starts_with("control: ")).collect();
        let step = format!("after step {}", held["steps"]);
        assert!(notes.len() == 2 && notes.iter().all(|note| note.ends_with(&step)), "{notes:?}");
        assert!(notes[0].starts_with("control: joint.rail.motor.velocity is 0.4 m/s from t = "), "{notes:?}");
    }
}

#[test]
fn a_control_of_what_cannot_be_changed_is_refused_with_a_reason() {
    let folder = folder("bad-control");
    let cases = [
        ("joint.rail.motor.velocity", "solid.box.free.density", "cannot be changed during a run"),
        ("joint.rail.motor.velocity", "joint.rail.motor.velocty", "did you mean \"velocity\"?"),
        ("joint.rail.motor.velocity", "joint.rail.motor.torque", "no number \"torque\""),
        ("joint.rail.motor.velocity", "joint.rail.motor.stiffness", "the scene has no joint.rail.motor.stiffness"),
        ("joint.rail.motor.velocity", "joint.rial.motor.velocity", "did you mean \"rail\"?"),
        ("force.thruster.force.0", "force.thruster.force.2", "has 2"),
        ("force.thruster.force.0", "force.thruster.torque.0", "has 0"),
        ("force.thruster.force.0", "force.wind.force.0", "no force is called \"wind\""),
        ("force.thruster.force.0", "joint.rail.motor.velocity", "controlled twice"),
        ("velocity = 0.0", "velocity = \"sin(t)\"", "changes with time by itself"),
        ("min = 0.0", "min = 1.0", "is 0, which is not from min = 1"),
        ("max = 20.0", "max = -1.0", "nothing lies between"),
    ];
    for (from, to, part) in cases {
        let scene = format!("{BAY}{CONTROLLED}").replace(&format!("key = \"{from}\""), &format!("key = \"{to}\""));
        let scene = if from.starts_with(['v', 'm']) { scene.replace(from, to) } else { scene };
        fs::write(folder.join("bay.toml"), scene).unwrap();
        let output = pontoon(&folder, &["inspect", "bay.toml", "--no-timing"]).output().unwrap();
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(2) && text.contains(part), "{to}: {part:?} is not in\n{text}");
    }
}

#[test]
fn a_client_that_reads_nothing_costs_no_memory_and_is_dropped() {
    let folder = folder("slow");
    // A row of many columns for each step, and many frames.
    let many = ["--set", "probe.0.every=1e-9", "--set", "probe.1.every=1e-9", "--frames", "0.002"];
    let run = LiveRun::start(&folder, "a", &many);
    let position = run.position();
    let stuck: Vec<Events> = (0..6).map(|_| run.events(&position)).collect();
    let mut reader = run.events(&position);
    let seconds = std::env::var("LIVE_SECONDS").map_or(20, |text| text.parse().unwrap());
    let (begun, mut memory, mut ticks) = (Instant::now(), Vec::new(), 0);
    while begun.elapsed() < Duration::from_secs(seconds) {
        assert_eq!(reader.next().0, "tick");
        ticks += 1;
        if begun.elapsed() > Duration::from_secs(5) {
            memory.extend(run.memory());
        }
    }
    assert!(ticks > 20, "{ticks} events");
    // The run itself reads and writes frames: what grows is less than a tenth of what was sent.
    if let (Some(first), Some(last)) = (memory.first(), memory.last()) {
        println!("{ticks} events; memory {first} kB after 5 s, {last} kB after {seconds} s");
        assert!(*last < first + 40_000, "memory grows from {first} kB to {last} kB");
    }
    drop(stuck);
}

/// A page in Chromium, which runs in real time and is driven through two pipes.
struct Browser {
    child: Child,
    to: File,
    from: BufReader<File>,
    calls: u64,
    session: Option<String>,
    /// What the browser said without being asked.
    events: Vec<Value>,
}

impl Browser {
    /// Opens `address`, with a profile in `folder`.
    fn open(folder: &Path, address: &str) -> Option<Self> {
        let name = chromium()?;
        let pipes = ["to", "from"].map(|name| folder.join(name));
        assert!(Command::new("mkfifo").args(&pipes).status().unwrap().success());
        // The browser reads from descriptor 3 and writes to descriptor 4.
        let child = Command::new("sh")
            .args(["-c", "exec \"$@\" 3<to 4>from", "sh", name, "--headless=new", "--no-sandbox", "--disable-gpu"])
            .args(["--remote-debugging-pipe", "--user-data-dir=profile", "--window-size=1280,2600", "about:blank"])
            .current_dir(folder)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let to = File::options().write(true).open(&pipes[0]).unwrap();
        let from = BufReader::new(File::open(&pipes[1]).unwrap());
        let mut browser = Self { child, to, from, calls: 0, session: None, events: Vec::new() };
        let target = browser.call("Target.createTarget", json!({ "url": "about:blank" }))["targetId"].clone();
        let session = browser.call("Target.attachToTarget", json!({ "targetId": target, "flatten": true }));
        browser.session = session["sessionId"].as_str().map(String::from);
        for domain in ["Runtime", "Log", "Page", "Performance"] {
            browser.call(&format!("{domain}.enable"), json!({}));
        }
        browser.call("Page.navigate", json!({ "url": address }));
        Some(browser)
    }

    /// Calls a method of the browser and returns its result.
    fn call(&mut self, method: &str, parameters: Value) -> Value {
        self.calls += 1;
        let mut message = json!({ "id": self.calls, "method": method, "params": parameters });
        if let Some(session) = &self.session {
            message["sessionId"] = json!(session);
        }
        self.to.write_all(format!("{message}\0").as_bytes()).unwrap();
        loop {
            let mut bytes = Vec::new();
            assert!(self.from.read_until(0, &mut bytes).unwrap() > 0, "the browser goes on");
            bytes.pop();
            let answer: Value = serde_json::from_slice(&bytes).unwrap();
            if answer["id"] == self.calls {
                assert!(answer["error"].is_null(), "{method}: {answer}");
                return answer["result"].clone();
            }
            self.events.push(answer);
        }
    }

    /// The value of an expression in the page.
    fn evaluate(&mut self, expression: &str) -> Value {
        let parameters = json!({ "expression": expression, "awaitPromise": true, "returnByValue": true });
        self.call("Runtime.evaluate", parameters)["result"]["value"].clone()
    }

    /// Waits until an expression is true in the page.
    #[track_caller]
    fn wait_for(&mut self, expression: &str) {
        let until = Instant::now() + Duration::from_secs(120);
        while self.evaluate(expression) != true {
            assert!(Instant::now() < until, "never true: {expression}; console: {:?}", self.console());
            sleep(Duration::from_millis(100));
        }
    }

    /// What is on the console, and errors.
    fn console(&self) -> Vec<&Value> {
        let shown = ["Runtime.consoleAPICalled", "Runtime.exceptionThrown", "Log.entryAdded"];
        self.events.iter().filter(|event| shown.iter().any(|method| event["method"] == **method)).collect()
    }

    /// The memory of the scripts after everything unused was released, bytes.
    fn heap(&mut self) -> f64 {
        self.call("HeapProfiler.collectGarbage", json!({}));
        self.call("Runtime.getHeapUsage", json!({}))["usedSize"].as_f64().unwrap()
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The numbers of rows, points of a drawn curve, frames, the last time of each, and the time of the player.
const SIZES: &str = "(() => { const { live, charts, films: [film], deck } = pontoon, chart = charts.all.find(chart => chart.u && chart.what.lines[0].of);
    return { rows: live.tables.get('box').t.length, row: live.tables.get('box').t.at(-1), drawn: chart.u.data[0].length, drawnTo: chart.u.data[0].at(-1),
      frames: film.times.length, frame: film.times.at(-1), player: deck.t, links: film.alone.filter(x => !x).length, steps: live.state.steps }; })()";

/// The value of the input of control number `i`, what the run says of it, and the largest rate (m/s) of the rail so far.
fn control_on_page(i: usize) -> String {
    format!(
        "(() => {{ const {{ live }} = pontoon, of = live.told.runs[0].tables.find(table => table.name === 'rail');
        const rate = live.tables.get('rail').columns.get(of.columns.findIndex(column => column.name.endsWith('mps')));
        return {{ input: +live.controls[{i}].input.value, value: live.state.controls[{i}].value, message: live.message.textContent,
          rate: Math.max(...rate.map(Math.abs)) }}; }})()"
    )
}

#[test]
fn a_control_changed_in_a_browser_reaches_the_run_and_its_series_and_is_kept_by_a_checkpoint() {
    let folder = folder("browser-control");
    fs::write(folder.join("bay.toml"), format!("{BAY}{CONTROLLED}")).unwrap();
    let mut run = LiveRun::start(&folder, "a", &["--set", "until=1e6"]);
    let address = format!("http://127.0.0.1:{}/?token={}", run.port, run.token);
    let Some(mut browser) = Browser::open(&folder, &address) else { return };
    browser.wait_for("!!window.pontoon?.live && pontoon.live.events > 0");
    let labels = browser.evaluate("[...document.querySelectorAll('.live label')].map(label => label.textContent)");
    assert_eq!(labels, json!(["joint.rail.motor.velocitym/s", "force.thruster.force.0N"]));
    let before = browser.evaluate(&control_on_page(0));
    assert_eq!([&before["input"], &before["value"]], [&json!(0), &json!(0)], "{before}");
    // The box lies still but for the settling of the water: the motor holds it.
    assert!(before["rate"].as_f64().is_some_and(|rate| rate < 0.05), "{before}");

    // A value beyond the range is refused on the page, and the run hears nothing of it.
    let type_in = |i: usize, value: f64| {
        format!(
            "(() => {{ const {{ input }} = pontoon.live.controls[{i}]; input.focus(); input.value = '{value}';
              input.dispatchEvent(new Event('change')); input.blur(); }})()"
        )
    };
    browser.evaluate(&type_in(0, 0.6));
    let refused = browser.evaluate("pontoon.live.message.textContent");
    assert_eq!(refused, "joint.rail.motor.velocity is a number from −0.5 to 0.5 m/s.");
    browser.evaluate(&type_in(0, 0.2));
    browser.wait_for("pontoon.live.state.controls[0].value === 0.2");
    let told = browser.evaluate("pontoon.live.message.textContent");
    assert!(told.as_str().unwrap().starts_with("joint.rail.motor.velocity is 0.2"), "{told}");
    // The motor of 200 N s/m brings the box of 9.6 kg/m to its speed in 0.05 s, less the drag of the water. The peak stays in the
    // series when the box has reached the wall.
    browser.wait_for(&format!("(c => c.rate > 0.15 && c.input === 0.2)({})", control_on_page(0)));

    // Ctrl-C: the checkpoint has the value, and the run that goes on from it offers it.
    run.interrupt();
    assert_eq!(run.wait(), Some(130));
    browser.wait_for("pontoon.live.ended === 'interrupted' && pontoon.live.controls.every(c => c.input.disabled)");
    assert!(browser.console().is_empty(), "{:#?}", browser.console());
    drop(browser);
    let reached = Manifest::read(&run.folder).unwrap();
    let notes = |manifest: &Manifest| manifest.notes.iter().filter(|note| note.starts_with("control: ")).count();
    assert_eq!(notes(&reached), 1, "{:?}", reached.notes);
    let resumed = LiveRun::from_command(&folder, "a", &["resume", "a", "--live", "--quiet"]);
    let state = resumed.hold();
    assert_eq!([&state["controls"][0]["value"], &state["controls"][1]["value"]], [&json!(0.2), &json!(0.0)]);
    assert_eq!(notes(&Manifest::read(&resumed.folder).unwrap()), 1);
}

#[test]
fn the_live_page_grows_pauses_and_hears_of_the_end_in_a_browser() {
    let folder = folder("browser");
    let mut run = LiveRun::start(&folder, "a", &["--set", "until=1e6"]);
    let address = format!("http://127.0.0.1:{}/?token={}", run.port, run.token);
    let Some(mut browser) = Browser::open(&folder, &address) else { return };
    let size = |sizes: &Value, name: &str| sizes[name].as_f64().unwrap_or_else(|| panic!("{name}: {sizes}"));

    // Curves and frames grow, and the player shows the newest frame.
    browser.wait_for("!!window.pontoon?.live && pontoon.live.events > 0 && pontoon.charts.all.some(chart => chart.u && chart.what.lines[0].of)");
    let first = browser.evaluate(SIZES);
    browser.wait_for(&format!(
        "(s => s.rows > {} && s.drawn > {} + 20 && s.frames > {} + 5)({SIZES})",
        first["rows"], first["drawn"], first["frames"]
    ));
    let later = browser.evaluate(SIZES);
    for name in ["rows", "row", "drawnTo", "frame", "steps"] {
        assert!(size(&later, name) > size(&first, name), "{name} grows: {first}, then {later}");
    }
    assert_eq!(later["player"], later["frame"], "the player follows: {later}");
    assert!(size(&later, "links") > 3.0, "the player moves particles between frames: {later}");
    let text =
        browser.evaluate("document.querySelector('.badge').textContent + ' | ' + pontoon.live.figures.textContent");
    assert!(text.as_str().unwrap().starts_with("running | t = "), "{text}");

    // The pause holds everything; a checkpoint is written meanwhile.
    browser.evaluate("pontoon.live.pause.click()");
    browser.wait_for("document.querySelector('.badge').textContent === 'paused'");
    sleep(Duration::from_millis(800));
    let held = browser.evaluate(SIZES);
    browser.evaluate("pontoon.live.checkpoint.click()");
    browser.wait_for("pontoon.live.message.textContent.startsWith('A checkpoint was written at ')");
    assert!(run.folder.join("checkpoint.bin").exists());
    sleep(Duration::from_millis(800));
    assert_eq!(browser.evaluate(SIZES), held, "nothing moves");
    browser.evaluate("pontoon.live.pause.click()");
    browser.wait_for(&format!("(s => s.rows > {} && s.frames > {})({SIZES})", held["rows"], held["frames"]));

    // The page can be loaded again, and keeps a bounded number of frames and rows.
    browser.call("Page.reload", json!({}));
    browser.wait_for("!!window.pontoon?.live && pontoon.live.events > 0");
    browser.evaluate("Object.assign(MOST, { frames: 8, rows: 60 })");
    let begin = browser.evaluate(SIZES);
    browser.wait_for(&format!("(s => s.frame > {} + 0.3 && s.row > {} + 0.3)({SIZES})", begin["frame"], begin["row"]));
    let bounded = browser.evaluate(SIZES);
    assert!(size(&bounded, "frames") <= 8.0 && size(&bounded, "rows") <= 60.0, "{bounded}");
    browser
        .evaluate("(async () => { for (const t of [0, 0.3, 0.6, 1]) pontoon.deck.seek(t * pontoon.deck.until); })()");

    // For as long as is asked, the memory of both sides stays.
    let seconds = std::env::var("LIVE_SECONDS").map_or(0, |text| text.parse().unwrap());
    browser.evaluate("Object.assign(MOST, { frames: 600, rows: 12000 })");
    let (begun, mut seen) = (Instant::now(), Vec::new());
    while begun.elapsed() < Duration::from_secs(seconds) {
        sleep(Duration::from_secs(seconds.min(60)));
        seen.push((browser.heap(), run.memory().unwrap_or(0)));
        let (heap, memory) = seen[seen.len() - 1];
        println!(
            "{:.0} s: scripts {:.1} MB, program {memory} kB, {}",
            begun.elapsed().as_secs_f64(),
            heap / 1e6,
            browser.evaluate(SIZES)
        );
    }
    if let (Some(middle), Some(last)) = (seen.get(seen.len() / 2), seen.last()) {
        assert!(last.0 < 1.5 * middle.0 + 2e7 && last.1 < middle.1 + 40_000, "memory grows: {seen:?}");
    }

    // The end is on the page.
    run.interrupt();
    assert_eq!(run.wait(), Some(130));
    browser.wait_for("pontoon.live.ended === 'interrupted' && pontoon.live.pause.disabled && document.querySelector('.badge').textContent === 'interrupted'");
    let message = browser.evaluate("pontoon.live.message.textContent");
    assert!(
        message.as_str().unwrap().contains("pontoon resume") && message.as_str().unwrap().contains("report.html"),
        "{message}"
    );
    assert!(browser.console().is_empty(), "{:#?}", browser.console());
}
