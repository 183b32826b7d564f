//! The page of a run as a reader meets it: in a real browser (Chromium; without one those tests say so and pass), and as
//! a file. Screenshots are left in the folder `tmp` of the build, to be looked at.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout, clippy::print_stderr, reason = "tests may")]

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
    sync::OnceLock,
};

use pontoon::{
    error::{Error, ErrorCode, ErrorKind, Fault},
    output::{Manifest, manifest::RunStatus},
    report,
};
use serde_json::Value;
use tiny_skia::{Pixmap, PremultipliedColorU8};

/// A box afloat in a small tank; its title is one that could break a page.
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

/// A folder for the test `name`, empty.
fn desk(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("report-{name}"));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// Runs `scene` by the program as a stranger would, with the words `more`; the run's folder.
fn ran(desk: &Path, name: &str, scene: &str, more: &[&str]) -> PathBuf {
    let file = format!("{name}.toml");
    fs::write(desk.join(&file), scene).unwrap();
    let words = [&["run", &file, "--out", name, "--quiet"], more].concat();
    let said = pontoon(desk, &words);
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    desk.join(name)
}

fn pontoon(desk: &Path, words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pontoon")).args(words).current_dir(desk).stdin(Stdio::null()).output().unwrap()
}

/// Chromium, if it is installed. Without it a test prints "skipped", and fails in CI.
fn chromium() -> Option<&'static str> {
    static FOUND: OnceLock<Option<&'static str>> = OnceLock::new();
    *FOUND.get_or_init(|| {
        let answers =
            |name: &&str| Command::new(name).arg("--version").output().is_ok_and(|said| said.status.success());
        let found = ["chromium", "chromium-browser", "google-chrome"].into_iter().find(answers);
        if found.is_none() {
            assert!(std::env::var("CI").as_deref() != Ok("true"), "CI needs Chromium to open the page of a run");
            eprintln!("skipped: Chromium is not installed, so the page was not opened in a browser");
        }
        found
    })
}

/// Opens `page` in the browser with the arguments `more`; nothing may be said on its console. What it prints.
fn browse(page: &Path, profile: &str, more: &[&str]) -> String {
    let profile = page.with_extension(profile);
    let said = Command::new(chromium().unwrap())
        .args(["--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--enable-logging=stderr"])
        .args(["--allow-file-access-from-files", "--virtual-time-budget=30000"])
        .arg(format!("--user-data-dir={}", profile.display()))
        .args(more)
        .arg(format!("file://{}", page.display()))
        .output()
        .unwrap();
    let _ = fs::remove_dir_all(&profile);
    let errors = String::from_utf8_lossy(&said.stderr).into_owned();
    let console: Vec<&str> = errors.lines().filter(|line| line.contains("CONSOLE")).collect();
    assert!(console.is_empty(), "{}: {console:#?}", page.display());
    String::from_utf8_lossy(&said.stdout).into_owned()
}

/// What `script` says of the open `page`: it fills the object `said`, with the players in `deck`.
fn asked(page: &Path, script: &str) -> Value {
    let text = fs::read_to_string(page).unwrap();
    let driver = format!(
        "<script>pontoon.ready.then(async () => {{ const said = {{}}, {{ deck, films, charts }} = pontoon;\n\
         const wait = ms => new Promise(go => setTimeout(go, ms));\n{script}\n\
         const note = document.createElement('pre'); note.id = 'said'; note.textContent = JSON.stringify(said);\n\
         document.body.append(note); }});</script></body>"
    );
    let asking = page.with_extension("asked.html");
    fs::write(&asking, text.replace("</body>", &driver)).unwrap();
    let dom = browse(&asking, "profile", &["--window-size=1280,6000", "--dump-dom"]);
    fs::remove_file(&asking).unwrap();
    let said = dom.split("<pre id=\"said\">").nth(1).and_then(|rest| rest.split("</pre>").next());
    let said = said
        .expect("the page's scripts ran to their end")
        .replace("&lt;", "<")
        .replace("&gt;", ">")
        .replace("&amp;", "&");
    serde_json::from_str(&said).unwrap()
}

/// A picture of the open `page`; it shows something.
fn shot(page: &Path, name: &str, more: &[&str]) {
    let file = page.with_file_name(name);
    let picture = format!("--screenshot={}", file.display());
    browse(page, name, &[&[picture.as_str()], more].concat());
    let pixels = Pixmap::load_png(&file).unwrap();
    assert!(colours(&pixels) > 50, "{} is almost blank", file.display());
}

/// How many colours a picture has.
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
fn the_page_plays_and_tells_the_value_under_the_pointer() {
    let desk = desk("plays");
    let scene = format!("{BAY}\n[[probe]]\nbudget = true\n");
    let page = ran(&desk, "bay", &scene, &[]).join(report::REPORT_FILE);
    assert!(page.is_file(), "a run leaves its page");
    if chromium().is_none() {
        return;
    }
    let script = "const view = deck.views[0], { canvas } = view;
         deck.button.click(); for (let n = 0; n < 20 && !(deck.t > 0); n++) await wait(500); said.played = deck.t; deck.pause();
         const key = key => canvas.dispatchEvent(new KeyboardEvent('keydown', { key, bubbles: true }));
         key('End'); said.end = deck.t; key('Home'); said.home = deck.t; key('ArrowRight'); said.next = deck.t; key('Home');
         key('+'); said.zoom = deck.look.zoom; key('0'); key('d'); key('w'); said.pan = deck.look.pan; key('0');
         const point = ([x, y]) => { const box = canvas.getBoundingClientRect();
           canvas.dispatchEvent(new PointerEvent('pointermove', { clientX: box.left + x, clientY: box.top + y, bubbles: true }));
           return view.tip.hidden ? '' : view.tip.textContent; };
         said.water = point(view.pixel([0.21, 0.11])); said.box = point(view.pixel([0.5, 0.3])); said.air = point(view.pixel([0.2, 0.45]));
         said.titles = charts.all.map(chart => chart.what.title); said.idle = document.querySelector('#charts').textContent;
         said.frames = films[0].times.length; said.charts = document.querySelectorAll('.uplot').length;
         said.moved = films[0].pose(1)[1]; deck.seek(0.1); said.later = films[0].pose(1)[1];
         document.querySelectorAll('details').forEach(fold => fold.open = true); await wait(500);
         said.wide = document.documentElement.scrollWidth - innerWidth; said.title = document.title;";
    // How far depends on how often the browser draws, which on a busy machine may be never in its virtual time: then it is asked again.
    let plays = |said: &Value| said["played"].as_f64().unwrap() > 0.0;
    let said = (0..3).map(|_| asked(&page, script)).find(plays).expect("it plays");
    assert!(said["home"] == 0.0 && said["end"].as_f64().unwrap() >= 0.2 - 1e-9, "{said}");
    let next = said["next"].as_f64().unwrap();
    assert!((0.02..0.03).contains(&next), "the second frame is the first step at or past 0.02 s: {said}");
    assert_eq!(said["zoom"], 1.4);
    assert!([0, 1].iter().all(|i| said["pan"][i].as_f64().unwrap() > 0.0), "to the right and up by keys alone: {said}");
    // Still water: P = ρ g (0.3 − y); that of the lattice is 2 % more at most, and values are rounded to 1/600 of the range.
    let water = said["water"].as_str().unwrap();
    let still = 1000.0 * 9.81 * (0.3 - number(water, "y "));
    assert!((number(water, "pressure ") / still - 1.0).abs() < 0.03, "{water}, where still water has {still} Pa");
    assert!(said["box"].as_str().unwrap().starts_with("box (free)"), "{said}");
    assert_eq!(said["air"], "");
    assert_eq!(said["frames"], 11);
    assert!(said["charts"].as_u64().unwrap() >= 5, "{said}");
    let entries = said["titles"].as_array().unwrap().iter().filter(|title| *title == "energy by entry").count();
    let idle = said["idle"].as_str().unwrap();
    assert!(entries == 1 && idle.contains("0 throughout: ") && idle.contains("motors, springs, forces"), "{said}");
    assert_ne!(said["moved"], said["later"], "the box moves");
    assert!(said["wide"].as_f64().unwrap() <= 0.0, "nothing sticks out at the right: {said}");
    assert!(said["title"].as_str().unwrap().contains("</script>"), "the title is as it was written: {said}");
}

#[test]
fn the_page_is_looked_at_in_light_and_dark_and_on_a_phone() {
    let desk = desk("looks");
    let run = ran(&desk, "bay", BAY, &[]);
    if chromium().is_none() {
        return;
    }
    let page = run.join(report::REPORT_FILE);
    shot(&page, "light.png", &["--window-size=1280,2600"]);
    shot(&page, "dark.png", &["--window-size=1280,2600", "--blink-settings=preferredColorScheme=0"]);
    // A window is never narrower than 500 pixels; a frame in it is.
    let frame = run.join("phone.html");
    let text = format!(
        "<style>body{{margin:0}}</style><iframe style=\"border:0;width:390px;height:3600px\" src=\"{}\"></iframe>",
        report::REPORT_FILE
    );
    fs::write(&frame, text).unwrap();
    shot(&frame, "phone.png", &["--window-size=500,3600"]);
}

#[test]
fn a_deep_tank_turns_and_is_cut() {
    let desk = desk("deep");
    let run = ran(&desk, "tub", DEEP, &[]);
    if chromium().is_none() {
        return;
    }
    let said = asked(
        &run.join(report::REPORT_FILE),
        "const view = deck.views[0], seen = () => { const who = new Set(view.raster.who); return [...who].filter(k => k >= 0).length; };
         said.all = films[0].n; said.seen = seen(); deck.look.yaw += 1.2; deck.draw(); said.turned = seen();
         deck.look.mode = 'y'; deck.fit(); said.cut = view.water.near.slice(0, view.water.n).filter(near => near >= 0.45).length;
         const [x, y] = view.pixel([0.12, 0.12]), box = view.canvas.getBoundingClientRect();
         view.canvas.dispatchEvent(new PointerEvent('pointermove', { clientX: box.left + x, clientY: box.top + y }));
         said.tip = view.tip.textContent;",
    );
    let figure = |name: &str| said[name].as_u64().unwrap();
    assert!(figure("seen") > 100 && figure("seen") < figure("all"), "what is behind is not seen: {said}");
    assert!(figure("turned") > 100, "{said}");
    assert!(figure("cut") >= 40 && figure("cut") < figure("all") / 3, "two layers of eight: {said}");
    assert!(number(said["tip"].as_str().unwrap(), "pressure ") > 500.0, "{said}");
}

#[test]
fn a_contact_skin_in_space_is_dashed_in_the_whole_and_dotted_in_a_cut() {
    let desk = desk("skin");
    let run = ran(&desk, "tub", &DEEP.replace("free  = {", "contact_skin = 0.03\nfree  = {"), &[]);
    if chromium().is_none() {
        return;
    }
    let said = asked(
        &run.join(report::REPORT_FILE),
        "const view = deck.views[0], on = view.context, stroke = on.stroke.bind(on), { lines, dots } = films[0].solids[1].rim;
         let dashed = 0; on.stroke = (...what) => { if (on.getLineDash().length) dashed++; stroke(...what); };
         const drawn = mode => { dashed = 0; deck.look.mode = mode; deck.draw(); return dashed; };
         said.dashed = ['turn', 'y'].map(drawn); said.dots = dots.length; said.lines = lines.length;
         said.far = lines.flatMap(line => line.points.map(x => Math.hypot(...x)));",
    );
    assert_eq!(said["dashed"], serde_json::json!([1, 0]), "the ball's alone: {said}");
    assert!(said["lines"] == 3 && said["dots"].as_u64() > Some(10), "three circles: {said}");
    // Rounded to a thousandth of dp in each coordinate.
    let off = |x: &Value| (x.as_f64().unwrap() - 0.13).abs();
    assert!(said["far"].as_array().unwrap().iter().all(|x| off(x) < 1e-4), "0.03 m outside its face: {said}");
}

#[test]
fn runs_are_laid_over_one_another_locked_in_time() {
    let desk = desk("compare");
    ran(&desk, "a", BAY, &["--no-report"]);
    ran(&desk, "b", BAY, &["--set", "solid.box.free.density=250", "--no-report"]);
    assert!(!desk.join("a").join(report::REPORT_FILE).exists(), "--no-report leaves the page out");
    let said = pontoon(&desk, &["compare", "a", "b", "--out", "both.html"]);
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    let page = desk.join("both.html");
    let text = fs::read_to_string(&page).unwrap();
    assert!(text.contains("solid.box.free.density") && text.contains("What differs"), "the difference is told");
    if chromium().is_none() {
        return;
    }
    let said = asked(
        &page,
        "deck.seek(0.1); said.times = deck.views.map(view => view.t); said.ranges = deck.views.map(view => view.look.range);
         said.lines = charts.all[0].what.lines.map(line => line.label);",
    );
    assert_eq!((&said["times"][0], &said["times"][1]), (&Value::from(0.1), &Value::from(0.1)));
    assert_eq!(said["ranges"][0], said["ranges"][1], "equal colours");
    assert!(said["lines"].as_array().unwrap().iter().any(|line| line == "b"), "{said}");
    shot(&page, "both.png", &["--window-size=1280,2000"]);
}

#[test]
fn runs_of_unlike_scenes_are_drawn_with_who_has_what() {
    let desk = desk("unlike");
    ran(&desk, "a", BAY, &["--no-report"]);
    let fronted = BAY.replace("[[probe]]\nenergy = true", "[[probe]]\nfront = true");
    ran(&desk, "b", &fronted, &["--no-report"]);
    ran(&desk, "tub", &DEEP.replace("[[probe]]", "[[probe]]\nname = \"box\""), &["--no-report"]);
    let compare = |names: &[&str], out: &str| {
        let said = pontoon(&desk, &[&["compare"][..], names, &["--out", out]].concat());
        assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
        (fs::read_to_string(desk.join(out)).unwrap(), String::from_utf8_lossy(&said.stderr).into_owned())
    };
    let (text, said) = compare(&["a", "b"], "ab.html");
    assert!(text.contains("Not every run has every series; only in a: energy; only in b: front."), "who has what");
    assert!(!said.contains("in common"), "{said}");
    let (text, _) = compare(&["a", "tub"], "flat.html");
    assert!(
        text.contains("only in a: box.spin_radps, gauge, energy; only in tub: box.z_m, box.sway_m, box.roll_deg"),
        "columns, too"
    );
    ran(&desk, "ball", DEEP, &["--no-report"]);
    let (_, said) = compare(&["a", "ball"], "none.html");
    assert!(said.contains("the runs have no series in common"), "{said}");
    if chromium().is_none() {
        return;
    }
    // What the first run lacks is drawn, too.
    let said = asked(
        &desk.join("flat.html"),
        "said.charts = charts.all.map(chart => [chart.what.title, chart.what.said ?? '', chart.what.lines.length]);",
    );
    let chart = |title: &str| {
        let all = said["charts"].as_array().unwrap();
        all.iter().find(|chart| chart[0] == title).unwrap_or_else(|| panic!("{title}: {said}")).clone()
    };
    assert_eq!(chart("heave"), serde_json::json!(["heave", "", 2]));
    assert_eq!(chart("sway"), serde_json::json!(["sway", "only in tub", 1]));
    assert_eq!(chart("eta"), serde_json::json!(["eta", "only in a", 1]));
}

#[test]
fn the_answer_of_a_body_to_waves_is_drawn_over_frequency() {
    let desk = desk("answers");
    let scene = format!("{BAY}\n[[statistic]]\nrao = {{ motion = \"box.heave_m\", wave = \"gauge\" }}\n");
    let run = ran(&desk, "bay", &scene, &["--no-report"]);
    let sections = |run: &Path| fs::read_to_string(report::write(run).unwrap().path).unwrap();
    assert!(!sections(&run).contains("<div id=\"answers\">"), "0.2 s have no waves");
    // A hundred waves of three periods, to which the box rises twice as high.
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
    let said = asked(
        &run.join(report::REPORT_FILE),
        "said.all = charts.all.filter(chart => chart.what.title.startsWith('rao'))
           .map(({ what }) => [what.title, what.unit, what.lines[0].label, Math.min(...what.lines[0].x), Math.max(...what.lines[0].x)]);",
    );
    let expected = [("ratio", "m/m", 2.0), ("phase", "°", 0.0), ("coherence", "–", 1.0)];
    for ((what, unit, value), chart) in expected.into_iter().zip(said["all"].as_array().unwrap()) {
        assert_eq!(chart[0], format!("rao · {what}"));
        assert!(chart[1] == unit && chart[2] == "box heave", "{chart}");
        // A multiple of the wave is that multiple at every frequency, in single precision.
        let off = |end: usize| (chart[end].as_f64().unwrap() - value).abs();
        assert!(off(3) < 1e-5 && off(4) < 1e-5, "{chart}");
    }
    assert_eq!(said["all"].as_array().unwrap().len(), 3);
}

#[test]
fn a_picture_has_a_column_for_each_run_and_a_row_for_each_time() {
    let desk = desk("picture");
    ran(&desk, "a", BAY, &["--no-report"]);
    let said = pontoon(&desk, &["compare", "a", "a", "--png", "fields.png", "--time", "0,0.2", "--width", "900"]);
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    let (two, path) = (Pixmap::load_png(desk.join("fields.png")).unwrap(), desk.join("one.png"));
    assert_eq!(two.width(), 900);
    let said = pontoon(&desk, &["report", "a", "--png", "one.png", "--by", "speed", "--range", "0,1"]);
    assert!(said.status.success() && path.is_file(), "{}", String::from_utf8_lossy(&said.stderr));
    // The same run twice: what stands in the left column stands in the right one.
    let dark = |from: u32, to: u32| {
        let inside = (from..to).flat_map(|x| (0..two.height()).map(move |y| (x, y)));
        inside
            .filter(|&(x, y)| two.pixel(x, y).is_some_and(|p| p.blue() > 70 && p.red() < 80 && p.green() < 160))
            .count()
    };
    let (left, right) = (dark(0, 450), dark(450, 900));
    assert!(left > 5000 && (left as f64 / right as f64 - 1.0).abs() < 0.15, "{left} and {right} pixels of water");
    let said = pontoon(&desk, &["report", "a", "--time", "1"]);
    assert!(!said.status.success(), "a time belongs to a picture");
}

#[test]
fn one_command_runs_the_laws_and_draws_their_fields_side_by_side() {
    let desk = desk("study");
    fs::write(desk.join("bay.toml"), BAY).unwrap();
    let plain = ["study", "bay.toml", "--vary", "model.diffusion=none,fourtakas", "--out", "s", "--quiet"];
    let asked = |more: &[&str]| {
        let said = pontoon(&desk, &[&plain[..], more].concat());
        assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
        String::from_utf8(said.stdout).unwrap()
    };
    let run = desk.join("s/runs/dp-0.02_diffusion-none");
    asked(&[]);
    assert!(!run.join("frames.pvd").exists(), "a study keeps no frames");
    // What was run without frames is run again with them, to the same readings.
    let series = |folder: &str| fs::read(desk.join(folder).join("series/box.csv")).unwrap();
    let said = asked(&["--png", "s/both.png", "--time", "0.1,0.2", "--width", "900"]);
    let both = Pixmap::load_png(desk.join("s/both.png")).unwrap();
    assert!(said.contains(&format!("both.png: 900 × {} pixels", both.height())), "{said}");
    assert_eq!(series("s/runs/dp-0.02_diffusion-none"), series("s/runs/dp-0.02_diffusion-none.old"));
    // A column for each law: the laws differ, but as much water stands in the left half as in the right one.
    let coloured = |from: u32, to: u32| {
        let inside = (from..to).flat_map(|x| (0..both.height()).map(move |y| (x, y)));
        let grey = |p: PremultipliedColorU8| p.red().abs_diff(p.blue()) < 40 && p.red().abs_diff(p.green()) < 40;
        inside.filter(|&(x, y)| both.pixel(x, y).is_some_and(|p| !grey(p))).count() as f64
    };
    let (left, right) = (coloured(0, 450), coloured(450, 900));
    assert!(left > 5000.0 && (left / right - 1.0).abs() < 0.15, "{left} and {right} pixels of water");
    // A row for each time; frames that are there are drawn without another run.
    asked(&["--png", "s/one.png", "--time", "0.2", "--width", "900"]);
    let one = Pixmap::load_png(desk.join("s/one.png")).unwrap();
    assert!(one.height() < both.height() && !desk.join("s/runs/dp-0.02_diffusion-none.old-2").exists());
    for (word, time, told) in [("no/x.png", "0.1", "no folder"), ("x.png", "0.3", "end at 0.2 s")] {
        let said = pontoon(&desk, &[&plain[..], &["--png", word, "--time", time]].concat());
        assert!(!said.status.success() && String::from_utf8_lossy(&said.stderr).contains(told), "{said:?}");
    }
}

/// A fault as the guard would report it.
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
fn a_run_that_failed_or_has_not_finished_says_so_on_its_page() {
    let desk = desk("fails");
    let run = ran(&desk, "bay", BAY, &["--no-report"]);
    let mut manifest = Manifest::read(&run).unwrap();
    manifest.status = RunStatus::Running;
    manifest.write(&run).unwrap();
    let words = |run: &Path| {
        let page = report::write(run).unwrap();
        assert!(page.bytes < report::MAX_PAGE_BYTES);
        fs::read_to_string(page.path).unwrap()
    };
    assert!(words(&run).contains("This run has not finished"));
    let said = pontoon(&desk, &["report", "nowhere"]);
    assert!(!said.status.success() && String::from_utf8_lossy(&said.stderr).contains("holds no run"));
    manifest.record_failure(&fault());
    manifest.write(&run).unwrap();
    let text = words(&run);
    for word in ["This run could not go on", "the water has left", "shorten the step"] {
        assert!(text.contains(word), "{word:?} is not on the page");
    }
}

#[test]
fn a_page_loads_nothing_and_a_scene_that_is_lost_is_a_remark() {
    let desk = desk("lost");
    let run = ran(&desk, "bay", BAY, &["--no-report"]);
    fs::remove_dir_all(run.join("scene")).unwrap();
    let page = report::write(&run).unwrap();
    assert!(page.remarks.iter().any(|remark| remark.contains("bodies and gauges are not drawn")), "{:?}", page.remarks);
    let text = fs::read_to_string(page.path).unwrap();
    for word in ["src=", "@import", "url(", "fetch(", "XMLHttpRequest", "href=\"http"] {
        assert!(!text.contains(word), "{word:?} is on the page");
    }
}
