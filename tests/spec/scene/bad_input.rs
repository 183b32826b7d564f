//! Invalid and malicious input: it is refused with a message, without panics, hangs or excessive memory. `fuzz/` tries millions of
//! such inputs.

use std::path::Path;

use pontoon::{
    Error,
    math::table::TableReader,
    scene::{Scene, bundled_scenes},
};
use proptest::prelude::*;

use crate::common::TestFolder;

/// A tank of water, a float, a wall and a paddle, with every kind of number.
const SCENE: &str = r#"dimension = 2
dp        = 0.1
until     = 1.0
gravity   = [0.0, -9.81]
jitter    = 0.01

[domain]
min = [-3.0, -2.0]
max = [4.0, 5.0]

[[water]]
fill  = { box = { min = [0.0, 0.0], max = [1.0, 0.8] } }
level = 0.5

[[solid]]
name  = "tank"
fixed = true
shape = { tank = { size = [1.0, 1.0], thickness = 0.4 } }

[[solid]]
name  = "box"
shape = { polygon = [[-0.2, -0.2], [0.2, -0.2], [0.2, 0.2]] }
at    = { x = 0.5, y = 0.6, angle_deg = 30.0 }
free  = { mass = 20.0, inertia = 1.5, centre_offset = [0.01, 0.0], velocity = [0.1, 0.0], spin = 0.2 }
friction = 0.3
restitution = 0.5

[[solid]]
name   = "paddle"
shape  = { capsule = { length = 0.3, radius = 0.05 } }
at     = { x = -0.5, bottom = 0.1 }
driven = { hinge = [-0.5, 0.0], angle_deg = { formula = "5*sin(2*t)" } }

[[solid]]
name  = "bed"
fixed = true
shape = { polyline = { points = [[-1.0, -0.5], [2.0, -0.6]], thickness = 0.3 } }

[model]
h_over_dp = 1.7
c0        = 30.0
rho0      = 1000.0
gamma     = 7.0
viscosity = { artificial = { alpha = 0.02 } }
diffusion = { fourtakas = { delta = 0.1 } }
shifting  = { everywhere = { a = 2.0 } }

[time]
cfl    = 0.4
dt_max = 0.01

[frames]
every = 0.1

[checkpoint]
every = 0.5
wall  = 600.0

[[probe]]
motion = "box"
every  = 0.1

[[probe]]
pressure = [0.5, 0.2]
"#;

/// Extreme numbers and numbers that are not finite.
const NUMBERS: [&str; 12] =
    ["0.0", "-0.0", "-1.0", "1e300", "-1e300", "1e-300", "5e-324", "1e18", "1e-18", "1e9", "nan", "-inf"];

/// Largest number of particles for which a test builds the scene.
const SMALL: f64 = 4000.0;

/// Reads and resolves a scene and estimates its size; builds it if it is small.
fn try_scene(text: &str, folder: &Path) -> Result<(), Error> {
    let scene = Scene::parse(text, folder, &[])?;
    scene.resolve()?;
    let size = scene.estimate_size()?;
    if size.fluid + size.boundary > SMALL {
        return Ok(());
    }
    match scene.dimension {
        2 => scene.build::<2>().map(|_| ()),
        _ => scene.build::<3>().map(|_| ()),
    }
}

/// The start and end of each number in a text.
fn numbers(text: &str) -> Vec<(usize, usize)> {
    let part = |c: char| c.is_ascii_digit() || c == '.' || c == '-';
    let mut found = Vec::new();
    let mut at = 0;
    while let Some(start) = text[at..].find(|c: char| c.is_ascii_digit()).map(|i| at + i) {
        let start = if text[..start].ends_with('-') { start - 1 } else { start };
        let end = text[start..].find(|c| !part(c)).map_or(text.len(), |i| start + i);
        found.push((start, end));
        at = end;
    }
    found
}

#[test]
fn extreme_numbers_at_any_position_cause_no_panic_or_hang() {
    assert_eq!(try_scene(SCENE, Path::new(".")), Ok(()));
    for (start, end) in numbers(SCENE) {
        for number in NUMBERS {
            let text = [&SCENE[..start], number, &SCENE[end..]].concat();
            // Any result is admissible, but a panic is not.
            let _ = try_scene(&text, Path::new("."));
        }
    }
}

#[test]
fn a_scene_with_1e12_particles_is_refused_with_the_calculation() {
    let assert_refused = |text: &str, parts: &[&str]| {
        let message = try_scene(text, Path::new(".")).expect_err("too many").to_string();
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
    };
    let water = SCENE.replace("level = 0.5", "").replace("[domain]\nmin = [-3.0, -2.0]\nmax = [4.0, 5.0]", "");
    let large = water.replace("max = [1.0, 0.8]", "max = [100000.0, 100000.0]");
    assert_refused(
        &large,
        &["asks for 1.0e12 particles", "10000000000 m² of water / dp²", "the most is 2e8", "write  dp ="],
    );
    let walls = SCENE.replace("tank = { size = [1.0, 1.0]", "tank = { size = [1.0, 1e10]");
    assert_refused(&walls, &["e12 particles", "m of solids × 4 layers / dp", "the most is 2e8"]);
    let fine = SCENE.replace("dp        = 0.1", "dp        = 7e-7");
    assert_refused(&fine, &["e12 particles", "write  dp ="]);
    let far =
        SCENE.replace("min = [0.0, 0.0]", "min = [1e9, 0.0]").replace("max = [1.0, 0.8]", "max = [1000000001.0, 0.8]");
    assert_refused(
        &far.replace("max = [4.0, 5.0]", "max = [2e9, 5.0]"),
        &["1.0e9 m from the origin", "move the scene"],
    );
}

#[test]
fn a_scene_of_20000_probes_is_read_and_one_above_1_mib_is_refused() {
    // 20,000 probes and 9,000 points: an algorithm of quadratic cost would take hours.
    let probes: String = (0..20_000).map(|i| format!("[[probe]]\npressure = [0.5, 0.{i:05}]\n")).collect();
    let points: Vec<String> = (0..9_000).map(|i| format!("[{}.0, {}.0]", i % 2, i)).collect();
    let text = SCENE.replace("[[-1.0, -0.5], [2.0, -0.6]]", &format!("[{}]", points.join(","))) + &probes;
    let scene = Scene::parse(&text, Path::new("."), &[]).unwrap();
    assert!(scene.resolve().unwrap().len() > 60_000);
    let folder = TestFolder::new("bad-input-long");
    std::fs::write(folder.join("scene.toml"), SCENE.to_string() + &"# far too long\n".repeat(100_000)).unwrap();
    let what = Scene::read(&folder, &[]).unwrap_err().to_string();
    assert!(what.contains("has more than 1048576 bytes") && what.contains("tables beside the scene"), "{what}");
}

#[test]
fn a_table_that_is_a_folder_or_too_large_is_refused_before_it_is_read() {
    let home = TestFolder::new("bad-input-tables");
    let with = |file: &str| {
        let law = format!("{{ file = \"{file}\", column = \"x_m\" }}");
        let error = try_scene(&SCENE.replace("{ formula = \"5*sin(2*t)\" }", &law), &home).expect_err(file);
        error.to_string()
    };
    std::fs::create_dir_all(home.join("folder.csv")).unwrap();
    assert!(with("folder.csv").contains("\"folder.csv\" beside the scene is no file"), "{}", with("folder.csv"));
    // A sparse file of 1 GiB, which uses no space on the disk.
    std::fs::File::create(home.join("large.csv")).and_then(|file| file.set_len(1 << 30)).unwrap();
    assert!(with("large.csv").contains("has more than 256 MiB"), "{}", with("large.csv"));
}

#[cfg(unix)]
#[test]
fn a_link_out_of_the_folder_of_the_scene_is_refused() {
    let home = TestFolder::new("bad-input-link");
    let bay = home.join("bay");
    std::fs::create_dir_all(&bay).unwrap();
    std::fs::write(home.join("secret.csv"), "t_s,x_m\n0,0\n1,1\n").unwrap();
    std::fs::copy(home.join("secret.csv"), bay.join("own.csv")).unwrap();
    std::os::unix::fs::symlink("../secret.csv", bay.join("out.csv")).unwrap();
    std::os::unix::fs::symlink("own.csv", bay.join("within.csv")).unwrap();
    let with = |file: &str| {
        let law = format!("{{ file = \"{file}\", column = \"x_m\" }}");
        try_scene(&SCENE.replace("{ formula = \"5*sin(2*t)\" }", &law), &bay)
    };
    assert!(
        with("out.csv")
            .is_err_and(|e| e.message.contains("\"out.csv\" is a link that leads out of the scene's folder"))
    );
    assert_eq!(with("within.csv"), Ok(()), "a link within the folder is accepted");
}

/// Text fragments that are inserted into a scene.
const PIECES: [&str; 30] = [
    "",
    "[",
    "]",
    "{",
    "}",
    "=",
    "\"",
    ",",
    "\n",
    "-",
    "9",
    "0.0",
    "1e300",
    "1e-300",
    "5e-324",
    "1e18",
    "true",
    "[[solid]]",
    "at = { x = 1 }",
    "box",
    "\u{e9}",
    "polygon",
    "file",
    "e",
    ".",
    "nan",
    "inf",
    "-1",
    "[[]]",
    "999999999999999999999",
];

proptest! {
    // Takes some seconds; `fuzz/` tries many more.
    #![proptest_config(ProptestConfig { cases: 600, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_changes_of_a_bundled_scene_cause_no_panic(
        which in any::<prop::sample::Index>(),
        changes in prop::collection::vec((any::<prop::sample::Index>(), 0usize..5, 0usize..PIECES.len()), 1..5)
    ) {
        let all = bundled_scenes();
        let (name, text, _) = &all[which.index(all.len())];
        let mut text: Vec<char> = text.chars().collect();
        for (at, length, piece) in changes {
            let at = at.index(text.len());
            let end = (at + length).min(text.len());
            text.splice(at..end, PIECES[piece].chars());
        }
        let _ = try_scene(&text.into_iter().collect::<String>(), &Path::new("scenes").join(name));
    }

    #[test]
    fn random_tables_cause_no_panic_and_no_value_that_is_not_finite(text in "(t_s|x_m|,|\n|[0-9]{1,3}|-|\\.|nan|1e400|#|\"|\\PC){0,60}") {
        let folder = TestFolder::new("bad-input-table");
        let path = folder.join("table.csv");
        std::fs::write(&path, format!("t_s,x_m\n{text}")).unwrap();
        if let Ok(series) = TableReader::open(&path).and_then(|mut table| table.series("t_s", "x_m")) {
            prop_assert!(series.values().iter().all(|x| x.is_finite()));
        }
    }
}

#[test]
fn a_motion_at_the_start_along_a_locked_motion_is_refused() {
    let plane = |keys: &str| SCENE.replace("velocity = [0.1, 0.0], spin = 0.2", keys);
    let space = |keys: &str| {
        format!(
            "dimension = 3\ndp = 0.05\nuntil = 1.0\n\
             [[water]]\nfill = {{ box = {{ min = [0.0, 0.0, 0.0], max = [0.2, 0.2, 0.2] }} }}\n\
             [[solid]]\nname = \"box\"\nshape = {{ box = {{ size = [0.2, 0.2, 0.2] }} }}\nat = [0.0, 0.0, 2.0]\n\
             free = {{ mass = 8.0, {keys} }}\n"
        )
    };
    for (text, key, mode) in [
        (plane("velocity = [1.0, 0.0], spin = 2.0, locked = [\"x\"]"), "velocity", "\"x\""),
        (plane("velocity = [1.0, 0.0], spin = 2.0, locked = [\"y\", \"turn\"]"), "spin", "\"turn\""),
        (space("spin = [1.0, 0.0, 2.0], locked = [\"turn_x\"]"), "spin", "\"turn_x\""),
        (space("velocity = [0.0, 0.0, 2.0], locked = [\"z\"]"), "velocity", "\"z\""),
    ] {
        let error = try_scene(&text, Path::new("")).unwrap_err();
        let location = error.location.as_ref().unwrap();
        assert!(error.message.contains(mode) && location.key.ends_with(key), "{error}");
        assert!(location.line_column.is_some() && error.help.as_ref().unwrap().contains("remove"), "{error}");
    }
    for text in [
        plane("velocity = [0.0, 0.1], locked = [\"x\", \"turn\"]"),
        space("velocity = [1.0, 0.0, 0.0], spin = [0.0, 2.0, 1.0], locked = [\"turn_x\", \"y\"]"),
    ] {
        try_scene(&text, Path::new("")).unwrap();
    }
}

/// The place of each message is the key that has the fault, and the message states the fault.
#[test]
fn a_message_is_about_the_key_that_has_the_fault() {
    let wave = |keys: &str| {
        let angle = "driven = { hinge = [-0.5, 0.0], angle_deg = { formula = \"5*sin(2*t)\" } }";
        SCENE.replace(angle, &format!("driven = {{ along = [1.0, 0.0], wave = {{ {keys} }} }}"))
    };
    let space = "dimension = 3\ndp = 0.05\nuntil = 1.0\n[[solid]]\nname = \"box\"\nshape = { box = { size = [0.2, 0.2, 0.2] } }\n\
                 at = { x = 0.0, y = 0.0, z = 2.0, turn_deg = [1e300, 0.0, 0.0] }\nfree = { mass = 8.0 }\n\
                 [[water]]\nfill = { box = { min = [0.0, 0.0, 0.0], max = [0.2, 0.2, 0.2] } }\n";
    let sea = "height = 0.05, peak_period = 1.0, components = 0";
    for (text, key, what) in [
        ("[[water]]\nfill = { box = { min = [0.0, 0.0], max = [1.0, 0.8] } }\n".into(), "dimension", "missing"),
        (
            SCENE.replace("max = [1.0, 0.8]", "max = [1e308, 1e308]").replace("c0        = 30.0\n", ""),
            "water.0.fill",
            "from the origin",
        ),
        (
            wave(&format!("jonswap = {{ {sea} }}")),
            "solid.paddle.driven.wave.jonswap.components",
            "1 to 2000 components",
        ),
        (wave(&format!("bretschneider = {{ {sea} }}")), "solid.paddle.driven.wave.bretschneider.components", "not 0"),
        (
            wave("focused = { crest = 0.05, peak_period = 1.0, distance = 0.5, time = 0.5, components = 3000 }"),
            "solid.paddle.driven.wave.focused.components",
            "not 3000",
        ),
        (space.into(), "solid.box.at.turn_deg", "1e300"),
        (SCENE.replace("angle_deg = 30.0 }", "angle_deg = -1e300 }"), "solid.box.at.angle_deg", "1e300"),
    ] {
        let error = try_scene(&text, Path::new("")).unwrap_err();
        assert!(error.message.contains(what), "{key}: {error}");
        assert_eq!(error.location.as_ref().unwrap().key, key, "{error}");
    }
}
