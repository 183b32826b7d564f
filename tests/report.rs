//! The report of a run in a browser and as a file. Without Chromium the browser tests print "skipped" and pass. Screenshots remain
//! in the folder `tmp` of the build for inspection.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout, clippy::print_stderr, reason = "tests may")]

#[path = "support/chromium.rs"]
mod support;

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
};

use pontoon::{
    error::{Error, ErrorCode, ErrorKind, Fault},
    output::{Manifest, manifest::RunStatus},
    report,
};
use serde_json::Value;
use support::chromium;
use tiny_skia::{Pixmap, PremultipliedColorU8};

/// A floating box in a small tank; the title contains HTML that must be escaped.
const BAY: &str = r#"
title     = "A box & a gauge </script><script>nothing()</script>"
dimension = 2
dp        = 0.02
until     = 0.2

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

[[probe]]
name      = "gauge"
elevation = { x = 0.2 }

[[probe]]
energy = true

[frames]
every = 0.02

[[check]]
series  = "box.heave_m"
formula = "0"
bound   = { off = 0.05 }
"#;

const DEEP: &str = r#"
title     = "A ball in a tub"
dimension = 3
dp        = 0.05
until     = 0.1

[[water]]
fill = { box = { min = [0.0, 0.0, 0.0], max = [0.6, 0.4, 0.3] } }

[[solid]]
name  = "tub"
fixed = true
shape = { tank = { size = [0.6, 0.4, 0.45] } }

[[solid]]
name  = "ball"
shape = { ball = { radius = 0.1 } }
at    = { x = 0.3, y = 0.2, draft = "equilibrium" }
free  = { density = 500.0 }

[[probe]]
motion = "ball"

[frames]
every = 0.05
"#;

/// An empty folder for the test `name`.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("report-{name}"));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// Runs `scene` by the program with the arguments `more` and returns the folder of the run.
fn run_scene(folder: &Path, name: &str, scene: &str, more: &[&str]) -> PathBuf {
    let file = format!("{name}.toml");
    fs::write(folder.join(&file), scene).unwrap();
    let arguments = [&["run", &file, "--out", name, "--quiet"], more].concat();
    let result = pontoon(folder, &arguments);
    assert!(result.status.success(), "{}", String::from_utf8_lossy(&result.stderr));
    folder.join(name)
}

fn pontoon(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pontoon"))
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::null())
        .output()
        .unwrap()
}

/// Opens `page` in the browser with the arguments `more`, asserts an empty console, and returns the printed text.
fn browse(page: &Path, profile: &str, more: &[&str]) -> String {
    let profile = page.with_extension(profile);
    let result = Command::new(chromium().unwrap())
        .args(["--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--enable-logging=stderr"])
        .args(["--allow-file-access-from-files", "--virtual-time-budget=30000"])
        .arg(format!("--user-data-dir={}", profile.display()))
        .args(more)
        .arg(format!("file://{}", page.display()))
        .output()
        .unwrap();
    let _ = fs::remove_dir_all(&profile);
    let errors = String::from_utf8_lossy(&result.stderr).into_owned();
    let console: Vec<&str> = errors.lines().filter(|line| line.contains("CONSOLE")).collect();
    assert!(console.is_empty(), "{}: {console:#?}", page.display());
    String::from_utf8_lossy(&result.stdout).into_owned()
}

/// Runs `script` in the open `page` and returns its object `result`. The players are in `deck`.
fn evaluate(page: &Path, script: &str) -> Value {
    let text = fs::read_to_string(page).unwrap();
    let driver = format!(
        "<script>pontoon.ready.then(async () => {{ const result = {{}}, {{ deck, films, charts }} = pontoon;\n\
         const wait = ms => new Promise(go => setTimeout(go, ms));\n{script}\n\
         const note = document.createElement('pre'); note.id = 'result'; note.textContent = JSON.stringify(result);\n\
         document.body.append(note); }});</script></body>"
    );
    let file = page.with_extension("evaluated.html");
    fs::write(&file, text.replace("</body>", &driver)).unwrap();
    let dom = browse(&file, "profile", &["--window-size=1280,6000", "--dump-dom"]);
    fs::remove_file(&file).unwrap();
    let result = dom.split("<pre id=\"result\">").nth(1).and_then(|rest| rest.split("</pre>").next());
    let result =
        result.expect("the scripts of the page end").replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&");
    serde_json::from_str(&result).unwrap()
}

/// Takes a screenshot of the open `page` and asserts that it is not blank.
fn screenshot(page: &Path, name: &str, more: &[&str]) {
    let file = page.with_file_name(name);
    let picture = format!("--screenshot={}", file.display());
    browse(page, name, &[&[picture.as_str()], more].concat());
    let pixels = Pixmap::load_png(&file).unwrap();
    assert!(colours(&pixels) > 50, "{} is almost blank", file.display());
}

/// The number of colours in a picture.
fn colours(picture: &Pixmap) -> usize {
    let mut all: Vec<[u8; 4]> = picture.data().as_chunks::<4>().0.to_vec();
    all.sort_unstable();
    all.dedup();
    all.len()
}

/// The number after `word` in `text`.
fn number(text: &str, word: &str) -> f64 {
    let rest = text.split(word).nth(1).unwrap_or_else(|| panic!("{word:?} is not in {text:?}")).trim_start();
    let sign = if rest.starts_with('−') { -1.0 } else { 1.0 };
    let digits: String =
        rest.chars().skip_while(|c| *c == '−').take_while(|c| c.is_ascii_digit() || *c == '.').collect();
    sign * digits.parse::<f64>().unwrap()
}

#[test]
fn the_report_plays_and_shows_the_value_under_the_pointer() {
    let folder = folder("plays");
    let scene = format!("{BAY}\n[[probe]]\nbudget = true\n");
    let page = run_scene(&folder, "bay", &scene, &[]).join(report::REPORT_FILE);
    assert!(page.is_file(), "a run writes its report");
    if chromium().is_none() {
        return;
    }
    let script = "const view = deck.views[0], { canvas } = view;
         deck.button.click(); for (let n = 0; n < 20 && !(deck.t > 0); n++) await wait(500); result.played = deck.t; deck.pause();
         const key = key => canvas.dispatchEvent(new KeyboardEvent('keydown', { key, bubbles: true }));
         key('End'); result.end = deck.t; key('Home'); result.home = deck.t; key('ArrowRight'); result.next = deck.t; key('Home');
         key('+'); result.zoom = deck.look.zoom; key('0'); key('d'); key('w'); result.pan = deck.look.pan; key('0');
         const point = ([x, y]) => { const box = canvas.getBoundingClientRect();
           canvas.dispatchEvent(new PointerEvent('pointermove', { clientX: box.left + x, clientY: box.top + y, bubbles: true }));
           return view.tip.hidden ? '' : view.tip.textContent; };
         result.water = point(view.pixel([0.21, 0.11])); result.box = point(view.pixel([0.5, 0.3])); result.air = point(view.pixel([0.2, 0.45]));
         result.titles = charts.all.map(chart => chart.what.title); result.idle = document.querySelector('#charts').textContent;
         result.frames = films[0].times.length; result.charts = document.querySelectorAll('.uplot').length;
         result.moved = films[0].pose(1)[1]; deck.seek(0.1); result.later = films[0].pose(1)[1];
         document.querySelectorAll('details').forEach(fold => fold.open = true); await wait(500);
         result.wide = document.documentElement.scrollWidth - innerWidth; result.title = document.title;";
    // The progress depends on the drawing rate of the browser. On a busy machine it can be zero in its virtual time, hence three attempts.
    let plays = |result: &Value| result["played"].as_f64().unwrap() > 0.0;
    let result = (0..3).map(|_| evaluate(&page, script)).find(plays).expect("the page plays");
    assert!(result["home"] == 0.0 && result["end"].as_f64().unwrap() >= 0.2 - 1e-9, "{result}");
    let next = result["next"].as_f64().unwrap();
    assert!((0.02..0.03).contains(&next), "the second frame is the first step at or past 0.02 s: {result}");
    assert_eq!(result["zoom"], 1.4);
    assert!([0, 1].iter().all(|i| result["pan"][i].as_f64().unwrap() > 0.0), "keys pan to the right and up: {result}");
    // Still water: P = ρ g (0.3 − y). The lattice adds 2 % at most, and values are rounded to 1/600 of the range.
    let water = result["water"].as_str().unwrap();
    let still = 1000.0 * 9.81 * (0.3 - number(water, "y "));
    assert!((number(water, "pressure ") / still - 1.0).abs() < 0.03, "{water}, hydrostatic {still} Pa");
    assert!(result["box"].as_str().unwrap().starts_with("box (free)"), "{result}");
    assert_eq!(result["air"], "");
    assert_eq!(result["frames"], 11);
    assert!(result["charts"].as_u64().unwrap() >= 5, "{result}");
    let entries = result["titles"].as_array().unwrap().iter().filter(|title| *title == "energy by entry").count();
    let idle = result["idle"].as_str().unwrap();
    assert!(entries == 1 && idle.contains("0 throughout: ") && idle.contains("motors, springs, forces"), "{result}");
    assert_ne!(result["moved"], result["later"], "the box moves");
    assert!(result["wide"].as_f64().unwrap() <= 0.0, "no content overflows at the right: {result}");
    assert!(result["title"].as_str().unwrap().contains("</script>"), "the title is unchanged: {result}");
}

#[test]
fn the_report_renders_in_light_and_dark_mode_and_at_phone_width() {
    let folder = folder("screenshots");
    let run = run_scene(&folder, "bay", BAY, &[]);
    if chromium().is_none() {
        return;
    }
    let page = run.join(report::REPORT_FILE);
    screenshot(&page, "light.png", &["--window-size=1280,2600"]);
    screenshot(&page, "dark.png", &["--window-size=1280,2600", "--blink-settings=preferredColorScheme=0"]);
    // A window is at least 500 pixels wide, so a frame in it has the width of a phone.
    let frame = run.join("phone.html");
    let text = format!(
        "<style>body{{margin:0}}</style><iframe style=\"border:0;width:390px;height:3600px\" src=\"{}\"></iframe>",
        report::REPORT_FILE
    );
    fs::write(&frame, text).unwrap();
    screenshot(&frame, "phone.png", &["--window-size=500,3600"]);
}

#[test]
fn the_report_of_a_3d_run_rotates_and_shows_a_cut() {
    let folder = folder("deep");
    let run = run_scene(&folder, "tub", DEEP, &[]);
    if chromium().is_none() {
        return;
    }
    let result = evaluate(
        &run.join(report::REPORT_FILE),
        "const view = deck.views[0], seen = () => { const who = new Set(view.raster.who); return [...who].filter(k => k >= 0).length; };
         result.all = films[0].n; result.seen = seen(); deck.look.yaw += 1.2; deck.draw(); result.turned = seen();
         deck.look.mode = 'y'; deck.fit(); result.cut = view.water.near.slice(0, view.water.n).filter(near => near >= 0.45).length;
         const [x, y] = view.pixel([0.12, 0.12]), box = view.canvas.getBoundingClientRect();
         view.canvas.dispatchEvent(new PointerEvent('pointermove', { clientX: box.left + x, clientY: box.top + y }));
         result.tip = view.tip.textContent;",
    );
    let figure = |name: &str| result[name].as_u64().unwrap();
    assert!(figure("seen") > 100 && figure("seen") < figure("all"), "hidden particles are not drawn: {result}");
    assert!(figure("turned") > 100, "{result}");
    assert!(figure("cut") >= 40 && figure("cut") < figure("all") / 3, "the cut shows two layers of eight: {result}");
    assert!(number(result["tip"].as_str().unwrap(), "pressure ") > 500.0, "{result}");
}

#[test]
fn the_report_draws_mooring_lines_from_fairlead_to_anchor() {
    let folder = folder("moored");
    let line = "\n[[line_type]]\nname = \"chain\"\ndiameter = 0.004\nmass_per_length = 0.1\nstiffness = 500.0\n\
                [[mooring]]\nname = \"bow\"\nbetween = [\"box\"]\nfrom = [0.5, 0.3]\nto = [0.1, 0.0]\nlength = 0.55\nline = \"chain\"\n\
                [[mooring]]\nname = \"stern\"\nsince = 0.09\nbetween = [\"box\"]\nfrom = [0.5, 0.3]\nto = [0.7, 0.0]\nlength = 0.4\nline = \"chain\"\n";
    let run = run_scene(&folder, "bay", &format!("{BAY}{line}"), &[]);
    if chromium().is_none() {
        return;
    }
    let result = evaluate(
        &run.join(report::REPORT_FILE),
        "const view = deck.views[0], shown = () => { const { canvas } = view, [width, height] = [canvas.width, canvas.height];
           const copy = Object.assign(document.createElement('canvas'), { width, height }).getContext('2d', { willReadFrequently: true });
           copy.drawImage(canvas, 0, 0); return copy.getImageData(0, 0, width, height).data; };
         result.lines = []; for (const t of [0, 0.05, 0.2]) { deck.seek(t); result.lines.push(films[0].lines().map(line => [line.length, line[0], line.at(-1)])); }
         const drawn = shown(), none = (films[0].moorings = null, deck.draw(), shown());
         result.pixels = none.filter((x, i) => x !== drawn[i]).length;",
    );
    let count = |k: usize| result["lines"][k].as_array().unwrap().len();
    assert_eq!([count(0), count(1), count(2)], [1, 1, 2], "the second line begins at 0.09 s: {result}");
    let place = |line: &Value, end: usize| [0, 1].map(|c| line[end][c].as_f64().unwrap());
    for (k, line) in [(0, 0), (1, 0), (2, 0)] {
        let line = &result["lines"][k][line];
        let [fairlead, anchor] = [1, 2].map(|end| place(line, end));
        // Positions are rounded to dp/48, and the box moves by less than a spacing.
        let off = |at: [f64; 2], x: f64, y: f64| (at[0] - x).hypot(at[1] - y);
        assert!(off(fairlead, 0.5, 0.3) < 0.02 && off(anchor, 0.1, 0.0) < 0.001, "{line}");
    }
    assert!(result["pixels"].as_u64().unwrap() > 300, "the lines are drawn: {}", result["pixels"]);
    screenshot(&run.join(report::REPORT_FILE), "moored.png", &["--window-size=1280,900"]);
}

#[test]
fn a_picture_shows_mooring_lines() {
    let folder = folder("moored-picture");
    let line = "\n[[line_type]]\nname = \"chain\"\ndiameter = 0.004\nmass_per_length = 0.1\nstiffness = 500.0\n\
                [[mooring]]\nname = \"bow\"\nbetween = [\"box\"]\nfrom = [0.5, 0.3]\nto = [0.1, 0.0]\nlength = 0.55\nline = \"chain\"\n";
    // Pixels in the dark grey of outlines and lines.
    let dark = |name: &str, scene: &str| {
        run_scene(&folder, name, scene, &["--no-report"]);
        let picture = format!("{name}.png");
        let result = pontoon(&folder, &["report", name, "--png", &picture, "--by", "speed", "--range", "0,1"]);
        assert!(result.status.success(), "{}", String::from_utf8_lossy(&result.stderr));
        let pixels = Pixmap::load_png(folder.join(picture)).unwrap();
        let grey = |p: &&PremultipliedColorU8| (60..90).contains(&p.red()) && p.red().abs_diff(p.blue()) < 25;
        pixels.pixels().iter().filter(grey).count()
    };
    let (with, without) = (dark("with", &format!("{BAY}{line}")), dark("without", BAY));
    assert!(with > without + 300, "{with} pixels, {without} without the line");
}

#[test]
fn water_that_enters_is_in_the_player() {
    let folder = folder("river");
    let scene = "title = \"River\"\ndimension = 2\ndp = 0.02\nuntil = 0.4\n\
                 inflow = [{ x = 0.0, velocity = 1.0 }]\noutflow = [{ x = 0.6, velocity = 1.0 }]\n\
                 [[water]]\nfill = { box = { min = [0.0, 0.0], max = [0.6, 0.2] } }\nvelocity = [1.0, 0.0]\n\
                 [[solid]]\nname = \"bed\"\nfixed = true\nshape = { box = { size = [2.0, 0.1] } }\nat = { x = 0.3, y = -0.05 }\n\
                 [frames]\nevery = 0.1\n";
    let run = run_scene(&folder, "river", scene, &[]);
    if chromium().is_none() {
        return;
    }
    let result = evaluate(
        &run.join(report::REPORT_FILE),
        "result.first = films[0].frames[0][0].length; result.last = films[0].frames.at(-1)[0].length;",
    );
    let (first, last) = (result["first"].as_f64().unwrap(), result["last"].as_f64().unwrap());
    assert!(
        first == 300.0 && (last / first - 1.0).abs() < 0.1,
        "{first} and {last} particles, of which many have entered"
    );
}

#[test]
fn compared_runs_share_time_and_colour_range() {
    let folder = folder("compare");
    run_scene(&folder, "a", BAY, &["--no-report"]);
    run_scene(&folder, "b", BAY, &["--set", "solid.box.free.density=250", "--no-report"]);
    assert!(!folder.join("a").join(report::REPORT_FILE).exists(), "--no-report writes no report");
    let result = pontoon(&folder, &["compare", "a", "b", "--out", "both.html"]);
    assert!(result.status.success(), "{}", String::from_utf8_lossy(&result.stderr));
    let page = folder.join("both.html");
    let text = fs::read_to_string(&page).unwrap();
    assert!(text.contains("solid.box.free.density") && text.contains("What differs"), "the page lists the differences");
    if chromium().is_none() {
        return;
    }
    let result = evaluate(
        &page,
        "deck.seek(0.1); result.times = deck.views.map(view => view.t); result.ranges = deck.views.map(view => view.look.range);
         result.lines = charts.all[0].what.lines.map(line => line.label);",
    );
    assert_eq!((&result["times"][0], &result["times"][1]), (&Value::from(0.1), &Value::from(0.1)));
    assert_eq!(result["ranges"][0], result["ranges"][1], "equal colour ranges");
    assert!(result["lines"].as_array().unwrap().iter().any(|line| line == "b"), "{result}");
    screenshot(&page, "both.png", &["--window-size=1280,2000"]);
}

#[test]
fn a_comparison_of_different_scenes_states_the_series_of_each_run() {
    let folder = folder("unlike");
    run_scene(&folder, "a", BAY, &["--no-report"]);
    let fronted = BAY.replace("[[probe]]\nenergy = true", "[[probe]]\nfront = true");
    run_scene(&folder, "b", &fronted, &["--no-report"]);
    run_scene(&folder, "tub", &DEEP.replace("[[probe]]", "[[probe]]\nname = \"box\""), &["--no-report"]);
    let compare = |names: &[&str], out: &str| {
        let result = pontoon(&folder, &[&["compare"][..], names, &["--out", out]].concat());
        assert!(result.status.success(), "{}", String::from_utf8_lossy(&result.stderr));
        (fs::read_to_string(folder.join(out)).unwrap(), String::from_utf8_lossy(&result.stderr).into_owned())
    };
    let (text, result) = compare(&["a", "b"], "ab.html");
    assert!(
        text.contains("Not every run has every series; only in a: energy; only in b: front."),
        "series of each run"
    );
    assert!(!result.contains("in common"), "{result}");
    let (text, _) = compare(&["a", "tub"], "flat.html");
    assert!(
        text.contains("only in a: box.spin_radps, gauge, energy; only in tub: box.z_m, box.sway_m, box.roll_deg"),
        "columns of each run"
    );
    run_scene(&folder, "ball", DEEP, &["--no-report"]);
    let (_, result) = compare(&["a", "ball"], "none.html");
    assert!(result.contains("the runs have no series in common"), "{result}");
    if chromium().is_none() {
        return;
    }
    // Series that the first run lacks are drawn as well.
    let result = evaluate(
        &folder.join("flat.html"),
        "result.charts = charts.all.map(chart => [chart.what.title, chart.what.said ?? '', chart.what.lines.length]);",
    );
    let chart = |title: &str| {
        let all = result["charts"].as_array().unwrap();
        all.iter().find(|chart| chart[0] == title).unwrap_or_else(|| panic!("{title}: {result}")).clone()
    };
    assert_eq!(chart("heave"), serde_json::json!(["heave", "", 2]));
    assert_eq!(chart("sway"), serde_json::json!(["sway", "only in tub", 1]));
    assert_eq!(chart("eta"), serde_json::json!(["eta", "only in a", 1]));
}

#[test]
fn the_rao_of_a_body_is_drawn_over_frequency() {
    let folder = folder("answers");
    let scene = format!("{BAY}\n[[statistic]]\nrao = {{ motion = \"box.heave_m\", wave = \"gauge\" }}\n");
    let run = run_scene(&folder, "bay", &scene, &["--no-report"]);
    let sections = |run: &Path| fs::read_to_string(report::write(run).unwrap().path).unwrap();
    assert!(!sections(&run).contains("<div id=\"answers\">"), "0.2 s have no waves");
    // A hundred waves of three periods; the heave of the box is twice the elevation.
    let mut tables = [
        ("gauge", String::from("t_s,level_m,eta_m")),
        ("box", String::from("t_s,x_m,y_m,surge_m,heave_m,pitch_deg,vx_mps,vy_mps,spin_radps")),
    ];
    for i in 0..4000 {
        let t = 0.05 * f64::from(i);
        let eta: f64 = [0.4, 0.5, 0.6].iter().map(|f| 0.01 * (std::f64::consts::TAU * f * t).sin()).sum();
        tables[0].1 += &format!("\n{t:?},{:?},{eta:?}", 0.3 + eta);
        tables[1].1 += &format!("\n{t:?},0.5,0.3,0.0,{:?},0.0,0.0,0.0,0.0", 2.0 * eta);
    }
    for (name, text) in tables {
        fs::write(run.join(format!("series/{name}.csv")), text + "\n").unwrap();
    }
    assert!(sections(&run).contains("<div id=\"answers\">"));
    if chromium().is_none() {
        return;
    }
    let result = evaluate(
        &run.join(report::REPORT_FILE),
        "result.all = charts.all.filter(chart => chart.what.title.startsWith('rao'))
           .map(({ what }) => [what.title, what.unit, what.lines[0].label, Math.min(...what.lines[0].x), Math.max(...what.lines[0].x)]);",
    );
    let expected = [("ratio", "m/m", 2.0), ("phase", "°", 0.0), ("coherence", "–", 1.0)];
    for ((what, unit, value), chart) in expected.into_iter().zip(result["all"].as_array().unwrap()) {
        assert_eq!(chart[0], format!("rao · {what}"));
        assert!(chart[1] == unit && chart[2] == "box heave", "{chart}");
        // Heave is a multiple of the wave, so the RAO is that multiple at every frequency, in single precision.
        let off = |end: usize| (chart[end].as_f64().unwrap() - value).abs();
        assert!(off(3) < 1e-5 && off(4) < 1e-5, "{chart}");
    }
    assert_eq!(result["all"].as_array().unwrap().len(), 3);
}

#[test]
fn a_picture_has_a_column_for_each_run_and_a_row_for_each_time() {
    let folder = folder("picture");
    run_scene(&folder, "a", BAY, &["--no-report"]);
    let result = pontoon(&folder, &["compare", "a", "a", "--png", "fields.png", "--time", "0,0.2", "--width", "900"]);
    assert!(result.status.success(), "{}", String::from_utf8_lossy(&result.stderr));
    let (two, path) = (Pixmap::load_png(folder.join("fields.png")).unwrap(), folder.join("one.png"));
    assert_eq!(two.width(), 900);
    let result = pontoon(&folder, &["report", "a", "--png", "one.png", "--by", "speed", "--range", "0,1"]);
    assert!(result.status.success() && path.is_file(), "{}", String::from_utf8_lossy(&result.stderr));
    // The same run twice: both columns show the same water.
    let dark = |from: u32, to: u32| {
        let inside = (from..to).flat_map(|x| (0..two.height()).map(move |y| (x, y)));
        inside
            .filter(|&(x, y)| two.pixel(x, y).is_some_and(|p| p.blue() > 70 && p.red() < 80 && p.green() < 160))
            .count()
    };
    let (left, right) = (dark(0, 450), dark(450, 900));
    assert!(left > 5000 && (left as f64 / right as f64 - 1.0).abs() < 0.15, "{left} and {right} pixels of water");
    let result = pontoon(&folder, &["report", "a", "--time", "1"]);
    assert!(!result.status.success(), "--time needs --png");
}

#[test]
fn a_study_draws_the_fields_of_its_variants_side_by_side() {
    let folder = folder("study");
    fs::write(folder.join("bay.toml"), BAY).unwrap();
    let plain = ["study", "bay.toml", "--vary", "model.diffusion=none,fourtakas", "--out", "s", "--quiet"];
    let study = |more: &[&str]| {
        let result = pontoon(&folder, &[&plain[..], more].concat());
        assert!(result.status.success(), "{}", String::from_utf8_lossy(&result.stderr));
        String::from_utf8(result.stdout).unwrap()
    };
    let run = folder.join("s/runs/dp-0.02_diffusion-none");
    study(&[]);
    assert!(!run.join("frames.pvd").exists(), "a study writes no frames by default");
    // A run without frames is repeated with frames and has the same readings.
    let series = |run: &str| fs::read(folder.join(run).join("series/box.csv")).unwrap();
    let result = study(&["--png", "s/both.png", "--time", "0.1,0.2", "--width", "900"]);
    let both = Pixmap::load_png(folder.join("s/both.png")).unwrap();
    assert!(result.contains(&format!("both.png: 900 × {} pixels", both.height())), "{result}");
    assert_eq!(series("s/runs/dp-0.02_diffusion-none"), series("s/runs/dp-0.02_diffusion-none.old"));
    // A column for each variant: both halves show the same amount of water.
    let coloured = |from: u32, to: u32| {
        let inside = (from..to).flat_map(|x| (0..both.height()).map(move |y| (x, y)));
        let grey = |p: PremultipliedColorU8| p.red().abs_diff(p.blue()) < 40 && p.red().abs_diff(p.green()) < 40;
        inside.filter(|&(x, y)| both.pixel(x, y).is_some_and(|p| !grey(p))).count() as f64
    };
    let (left, right) = (coloured(0, 450), coloured(450, 900));
    assert!(left > 5000.0 && (left / right - 1.0).abs() < 0.15, "{left} and {right} pixels of water");
    // A row for each time; existing frames are drawn without another run.
    study(&["--png", "s/one.png", "--time", "0.2", "--width", "900"]);
    let one = Pixmap::load_png(folder.join("s/one.png")).unwrap();
    assert!(one.height() < both.height() && !folder.join("s/runs/dp-0.02_diffusion-none.old-2").exists());
    for (file, time, part) in [("no/x.png", "0.1", "no folder"), ("x.png", "0.3", "end at 0.2 s")] {
        let result = pontoon(&folder, &[&plain[..], &["--png", file, "--time", time]].concat());
        assert!(!result.status.success() && String::from_utf8_lossy(&result.stderr).contains(part), "{result:?}");
    }
}

/// A fault as a step check reports it.
fn fault() -> Error {
    let fault = Fault {
        code: ErrorCode::LeftDomain,
        reason: "the water has left".into(),
        who: "water particle 12".into(),
        step: 7,
        time: 0.01,
        position: vec![0.1, 0.2],
        velocity: vec![30.0, 0.0],
        density: Some(1010.0),
        cause: "too long a step: shorten the step".into(),
    };
    let mut error = Error::new(ErrorKind::Fault, "the water has left the domain");
    error.fault = Some(Box::new(fault));
    error
}

#[test]
fn the_report_of_a_failed_or_unfinished_run_states_its_status() {
    let folder = folder("fails");
    let run = run_scene(&folder, "bay", BAY, &["--no-report"]);
    let mut manifest = Manifest::read(&run).unwrap();
    manifest.status = RunStatus::Running;
    manifest.write(&run).unwrap();
    let page_text = |run: &Path| {
        let page = report::write(run).unwrap();
        assert!(page.bytes < report::MAX_PAGE_BYTES);
        fs::read_to_string(page.path).unwrap()
    };
    assert!(page_text(&run).contains("This run has not finished"));
    let result = pontoon(&folder, &["report", "nowhere"]);
    assert!(!result.status.success() && String::from_utf8_lossy(&result.stderr).contains("holds no run"));
    manifest.record_failure(&fault());
    manifest.notes = vec!["waves.csv is read so: separator tab".into()];
    manifest.events = vec!["rope \"line\" breaks at 0.5 s".into()];
    manifest.write(&run).unwrap();
    let text = page_text(&run);
    let words = ["This run could not go on", "the water has left", "shorten the step", "separator tab"];
    for word in words.into_iter().chain(["rope &quot;line&quot; breaks at 0.5 s"]) {
        assert!(text.contains(word), "{word:?} is not on the page");
    }
}

#[test]
fn a_report_loads_no_external_resource_and_a_missing_scene_is_a_remark() {
    let folder = folder("lost");
    let run = run_scene(&folder, "bay", BAY, &["--no-report"]);
    fs::remove_dir_all(run.join("scene")).unwrap();
    let page = report::write(&run).unwrap();
    assert!(page.remarks.iter().any(|remark| remark.contains("bodies and gauges are not drawn")), "{:?}", page.remarks);
    let text = fs::read_to_string(page.path).unwrap();
    for word in ["src=", "@import", "url(", "fetch(", "XMLHttpRequest", "href=\"http"] {
        assert!(!text.contains(word), "{word:?} is on the page");
    }
}
