//! Error messages of wrong scenes, compared with `tests/golden/errors/`. A golden file detects a change of a message, not an error.
//! `UPDATE_GOLDEN=1` updates the files; the commit states the reason.

use std::path::{Path, PathBuf};

use pontoon::{
    Error,
    error::ErrorCode,
    scene::{FramesChoice, Scene},
    simulation::{Dimension, Simulation},
    solid::Dim,
};
use proptest::prelude::*;

/// A valid scene.
const GOOD: &str = r#"title     = "A box afloat"
dimension = 2
dp        = 0.05
until     = 1.0

[[water]]
fill = { box = { min = [0.0, 0.0], max = [1.0, 0.5] } }

[[solid]]
name  = "tank"
fixed = true
shape = { tank = { size = [1.0, 1.0] } }

[[solid]]
name  = "box"
shape = { box = { size = [0.2, 0.1] } }
at    = { x = 0.5, draft = "equilibrium" }
free  = { density = 500.0 }

[[solid]]
name   = "paddle"
shape  = { box = { size = [0.05, 0.5] } }
at     = { x = 0.025, bottom = 0.0 }
driven = { along = [1.0, 0.0], distance = { formula = "0.05*(1-cos(2*pi*t))" } }

[model]
viscosity = { artificial = { alpha = 0.02 } }

[[probe]]
motion = "box"
"#;

fn golden(name: &str, message: &str) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/golden/errors").join(format!("{name}.txt"));
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(&path, format!("{message}\n")).unwrap();
    }
    let expected = std::fs::read_to_string(&path).unwrap_or_default();
    assert_eq!(message, expected.trim_end(), "the message \"{name}\" changed; update with UPDATE_GOLDEN=1");
}

fn folder() -> &'static Path {
    Path::new("tests/golden/errors")
}

/// Reads, resolves and builds a scene, as a run does before its first step.
fn try_scene(text: &str, sets: &[(&str, &str)]) -> Result<(), Error> {
    let sets: Vec<(String, String)> = sets.iter().map(|(k, v)| (k.to_string(), v.to_string())).collect();
    let scene = Scene::parse(text, folder(), &sets)?;
    scene.resolve()?;
    match scene.dimension {
        2 => try_build::<2>(&scene),
        _ => try_build::<3>(&scene),
    }
}

fn try_build<const D: usize>(scene: &Scene) -> Result<(), Error>
where
    Dim<D>: Dimension<D>,
{
    Simulation::new(scene.build::<D>()?.setup).map(|_| ()).map_err(|error| scene.with_location(error))
}

/// Compares the error message of the valid scene with `from` replaced by `to` with the golden file `name`.
fn wrong(name: &str, from: &str, to: &str) {
    assert!(GOOD.contains(from), "\"{from}\" is not in the valid scene");
    let message = try_scene(&GOOD.replacen(from, to, 1), &[]).expect_err("this scene is wrong").to_string();
    golden(name, &message);
}

fn wrong_set(name: &str, key: &str, value: &str) {
    golden(name, &try_scene(GOOD, &[(key, value)]).expect_err("this setting is wrong").to_string());
}

#[test]
fn a_former_name_is_still_read_and_noted_with_the_new_name() {
    let parse = |text: &str, sets: &[(&str, &str)]| {
        let sets: Vec<(String, String)> = sets.iter().map(|(k, v)| (k.to_string(), v.to_string())).collect();
        Scene::parse(text, folder(), &sets)
    };
    let old = GOOD
        .replacen("until     = 1.0", "until     = 1.0\nscatter   = 0.01", 1)
        .replacen("free  = { density = 500.0 }", "free  = { density = 500.0 }\nskin  = 0.01", 1)
        .replacen("[model]", "[model]\nwalls = \"settling\"", 1);
    let new = old.replace("scatter", "jitter").replace("skin", "contact_skin").replace("settling", "relaxed_adami");
    let both = old.replace("scatter ", "jitter = 0.01\nscatter ");
    let (old, new) = (parse(&old, &[]).unwrap(), parse(&new, &[]).unwrap());
    assert!(old == new && new.renamed_names().is_empty());
    let notes: Vec<String> = old.renamed_names().iter().map(ToString::to_string).collect();
    let expected = [
        "scatter (scene line 5): \"scatter\" is called \"jitter\" now",
        "solid.box.skin (scene line 20): \"skin\" is called \"contact_skin\" now",
        "model.walls (scene line 29): \"settling\" is called \"relaxed_adami\" now",
    ];
    assert_eq!(notes, expected);
    let set = parse(GOOD, &[("scatter", "0.01"), ("solid.box.skin", "0.01"), ("model.walls", "settling")]).unwrap();
    assert!(set == new);
    let notes: Vec<String> = set.renamed_names().iter().map(ToString::to_string).collect();
    assert_eq!(notes[1], "solid.box.skin (--set): \"skin\" is called \"contact_skin\" now");
    // An override with either name replaces the value of the text.
    assert_eq!(parse(&both.replace("scatter   = 0.01\n", ""), &[("scatter", "0.02")]).unwrap().jitter, Some(0.02));
    let error = parse(&both, &[]).expect_err("two names of one value").to_string();
    assert!(error.contains("scatter and jitter say the same thing twice") && error.contains(":6:1"), "{error}");
}

#[test]
fn the_valid_scene_is_accepted() {
    try_scene(GOOD, &[]).unwrap();
}

#[test]
fn errors_of_unknown_names_suggest_the_nearest_known_name() {
    wrong("unknown_key", "viscosity =", "viscocity =");
    wrong("unknown_key_in_a_solid", "density =", "densty =");
    wrong("unknown_section", "[model]", "[modle]");
    wrong("unknown_choice", "{ artificial = { alpha = 0.02 } }", "\"artifical\"");
    wrong("unknown_shape", "{ box = { size = [0.2", "{ bx = { size = [0.2");
    wrong("unknown_parameter", "alpha = 0.02", "alfa = 0.02");
    wrong("wrong_type", "0.05\nuntil", "\"small\"\nuntil");
    wrong("wrong_type_of_a_solid", "fixed = true", "fixed = \"yes\"");
    wrong("missing_dp", "dp        = 0.05\n", "");
    wrong("two_choices", "artificial = { alpha = 0.02 }", "artificial = {}, laminar = {}");
    wrong("not_toml", "fixed = true", "fixed = yes");
    wrong("not_a_number", "density = 500.0", "density = nan");
}

#[test]
fn invalid_values_are_refused() {
    wrong("negative_dp", "dp        = 0.05", "dp        = -0.05");
    wrong("four_dimensions", "dimension = 2", "dimension = 4");
    wrong("two_roles", "fixed = true", "fixed = true\nfree = { density = 500.0 }");
    wrong("no_role", "fixed = true\n", "");
    wrong("two_densities", "density = 500.0", "density = 500.0, mass = 10.0");
    wrong("unknown_solid", "motion = \"box\"", "motion = \"bocks\"");
    wrong("wrong_vector", "min = [0.0, 0.0]", "min = [0.0, 0.0, 0.0]");
    wrong("same_name", "name  = \"box\"", "name  = \"tank\"");
    wrong("name_of_a_path", "name  = \"box\"", "name  = \"../box\"");
    wrong("two_heights", "draft = \"equilibrium\"", "y = 0.5, draft = \"equilibrium\"");
    wrong("two_smoothing_lengths", "[model]", "[model]\nh_over_dp = 1.7\nc_h = 1.2");
    wrong("empty_box_of_water", "max = [1.0, 0.5]", "max = [1.0, 0.0]");
    wrong("too_many_particles", "dp        = 0.05", "dp        = 1e-5");
    wrong("period_between_free_bodies", "until     = 1.0", "until     = 1.0\nperiodic = { x = [0.0, 1.0] }");
    wrong("period_of_nothing", "until     = 1.0", "until     = 1.0\nperiodic = { x = [1.0, 0.0] }");
    wrong("period_in_a_third_axis", "until     = 1.0", "until     = 1.0\nperiodic = { z = [0.0, 1.0] }");
    let water = "max = [1.0, 0.5] } }";
    wrong("misspelt_velocity", water, &format!("{water}\nvelocty = [0.1, 0.0]"));
    wrong("velocity_of_one", water, &format!("{water}\nvelocity = [0.1]"));
    wrong("velocity_in_time", water, &format!("{water}\nvelocity = [\"sin(t)\", 0.0]"));
    wrong("water_far_away", "min = [0.0, 0.0], max = [1.0, 0.5]", "min = [1e9, 0.0], max = [1000000001.0, 0.5]");
    wrong("checkpoints_of_no_wall_time", "[model]", "[checkpoint]\nwall = 0.0\n\n[model]");
    wrong("small_and_light", "density = 500.0", "density = 50.0");
    wrong(
        "thin_and_light",
        "size = [0.2, 0.1] } }\nat    = { x = 0.5, draft = \"equilibrium\" }\nfree  = { density = 500.0",
        "size = [0.6, 0.05] } }\nat    = { x = 0.5, draft = \"equilibrium\" }\nfree  = { density = 100.0",
    );
    wrong("balance_of_a_tank", "motion = \"box\"", "balance = \"tank\"");
    wrong("contact_of_nobody", "motion = \"box\"", "contact = [\"box\", \"tnk\"]");
    wrong("kernel_that_lets_the_lattice_go", "[model]", "[model]\nkernel = \"cubic\"\nh_over_dp = 1.5");
    wrong("water_within_one_kernel", "max = [1.0, 0.5]", "max = [1.0, 0.1]");
    wrong("no_sound", "until     = 1.0", "until     = 1.0\ngravity = [0.0, 0.0]");
}

#[test]
fn invalid_shapes_motions_and_files_are_refused() {
    let box_shape = "{ box = { size = [0.2, 0.1] } }";
    wrong("bad_polygon", box_shape, "{ polygon = [[0.0, 0.0], [0.1, 0.1], [0.1, 0.0], [0.0, 0.1]] }");
    wrong("polygon_of_two_points", box_shape, "{ polygon = [[0.0, 0.0], [0.1, 0.1]] }");
    wrong("cylinder_in_2d", box_shape, "{ cylinder = { length = 0.1, radius = 0.1 } }");
    wrong("sinking_draft", "density = 500.0", "density = 1500.0");
    wrong("bad_formula", "0.05*(1-cos(2*pi*t))", "0.05*(1-cos(2*pi*t)");
    wrong("unknown_function", "0.05*(1-cos(2*pi*t))", "0.05*(1-cosinus(2*pi*t))");
    let formula = "formula = \"0.05*(1-cos(2*pi*t))\"";
    wrong("missing_file", formula, "file = \"tabel.csv\", column = \"x_m\"");
    wrong("path_outside", formula, "file = \"../secret.csv\", column = \"x_m\"");
    wrong("absolute_path", formula, "file = \"/etc/passwd\", column = \"x_m\"");
    wrong("missing_column", formula, "file = \"table.csv\", column = \"x\"");
    wrong("bad_cell", formula, "file = \"table.csv\", column = \"bad_m\"");
    wrong("body_outside_the_domain", "[model]", "[domain]\nmin = [0.0, 0.0]\nmax = [1.0, 0.52]\n\n[model]");
}

#[test]
fn impossible_bodies_are_refused() {
    // The face of the paddle is at 0.05 m; the box extends to 0.02 m.
    wrong("overlapping_start", "at    = { x = 0.5,", "at    = { x = 0.12,");
    wrong("negative_inertia", "density = 500.0", "density = 500.0, inertia = -0.1");
    // 3-D: the largest principal moment of a body is at most the sum of the other two.
    let deep = "dimension = 3\ndp = 0.05\nuntil = 1.0\nwater = [{ fill = { box = { min = [0, 0, 0], max = [0.4, 0.4, 0.2] } } }]\n\
        [[solid]]\nname = \"tank\"\nfixed = true\nshape = { tank = { size = [0.4, 0.4, 0.4] } }\n\
        [[solid]]\nname = \"box\"\nshape = { box = { size = [0.2, 0.2, 0.1] } }\nat = { x = 0.2, y = 0.2, draft = \"equilibrium\" }\n\
        free = { density = 500.0, inertia = [0.005, 0.005, 0.02] }\n";
    golden("inertia_of_no_body", &try_scene(deep, &[]).expect_err("an impossible inertia").to_string());
    try_scene(&deep.replace("0.02]", "0.009]"), &[]).expect("a possible inertia");
}

#[test]
fn wrong_overrides_are_refused_like_wrong_scenes() {
    wrong_set("set_unknown_key", "model.viscocity", "none");
    wrong_set("set_unknown_choice", "model.viscosity", "viscous");
    wrong_set("set_unknown_solid", "solid.bos.free.density", "500");
    wrong_set("set_wrong_type", "dp", "small");
    wrong_set("set_negative", "solid.box.free.density", "-1");
    wrong_set("set_no_key", "model..viscosity", "none");
}

#[test]
fn overrides_replace_values_of_the_scene() {
    let sets = [
        ("model.viscosity", "none"),
        ("model.diffusion.molteni.delta", "0.2"),
        ("solid.box.free.density", "600"),
        ("probe.0.every", "0.5"),
        ("frames", "off"),
    ];
    let sets: Vec<(String, String)> = sets.iter().map(|(k, v)| (k.to_string(), v.to_string())).collect();
    let scene = Scene::parse(GOOD, folder(), &sets).unwrap();
    assert_eq!(scene.solid[1].free.as_ref().unwrap().density, Some(600.0));
    assert_eq!(scene.probe[0].every, Some(0.5));
    assert_eq!(scene.frames, Some(FramesChoice::Off));
    let lines: Vec<String> = scene.resolve().unwrap().iter().map(ToString::to_string).collect();
    for line in [
        "dp = 0.05  (scene line 3)",
        "model.viscosity = \"none\"  (--set)",
        "model.diffusion.molteni.delta = 0.2  (--set)",
        "solid.box.free.density = 600.0  (--set)",
        "model.rho0 = 1000.0  (default: fresh water, kg/m³)",
    ] {
        assert!(lines.iter().any(|l| l == line), "no line \"{line}\" in\n{}", lines.join("\n"));
    }
}

#[test]
fn a_field_of_the_frames_that_is_named_twice_is_refused() {
    let sets = [("frames".to_string(), "{ fields = [\"velocity\", \"pressure\", \"velocity\"] }".to_string())];
    let told = Scene::parse(GOOD, folder(), &sets).and_then(|scene| scene.plan()).unwrap_err().to_string();
    assert!(told.contains("\"velocity\" is named twice") && told.contains("frames.fields"), "{told}");
}

/// The second solid of the scene is the box.
#[test]
fn a_key_given_by_the_name_and_by_the_number_of_a_solid_is_refused() {
    let density = |solid: &str| format!("solid.{solid}.free.density");
    let error =
        try_scene(GOOD, &[(&density("box"), "400"), (&density("1"), "600")]).expect_err("one value wins").to_string();
    assert!(error.contains("\"solid.box.free.density\" and \"solid.1.free.density\" are the same key"), "{error}");
    try_scene(GOOD, &[(&density("box"), "400"), ("solid.1.contact_skin", "0.01")]).unwrap();
}

#[test]
fn a_list_or_table_of_an_override_without_quotes_is_no_text() {
    for (key, value) in [("probe", "[{motion=box}]"), ("model.viscosity", "{laminar={nu0=1e-6}"), ("title", "[x")] {
        let error = try_scene(GOOD, &[(key, value)]).expect_err(value).to_string();
        assert!(error.contains("this is not TOML") && error.contains("words need quotes"), "{error}");
    }
    try_scene(GOOD, &[("title", "x [y]")]).unwrap();
}

/// A value is said to be set only if `--set` wrote it, or an element of it.
#[test]
fn a_value_set_in_part_and_a_table_set_empty_have_the_right_source() {
    let source = |key: &str, value: &str, of: &str| {
        let scene = Scene::parse(GOOD, folder(), &[(key.into(), value.into())]).unwrap();
        let values = scene.resolve().unwrap();
        let found = values.iter().find(|found| found.key == of).unwrap_or_else(|| panic!("no {of}"));
        format!("{} ({})", found.value, found.source)
    };
    let set = source("water.0.fill.box.max.0", "0.9", "water.0.fill.box.max");
    assert!(set.starts_with("[0.9, ") && set.ends_with("(--set)"), "{set}");
    let beside = source("water.0.fill.box.max.0", "0.9", "water.0.fill.box.min");
    assert!(beside.contains("(scene line "), "{beside}");
    for of in ["model.rho0", "model.h_over_dp", "model.kernel"] {
        let default = source("model", "{}", of);
        assert!(default.contains("(default: "), "{of} = {default}");
    }
}

#[test]
fn a_choice_by_name_alone_has_its_default_parameters() {
    let bare = GOOD.replace("{ artificial = { alpha = 0.02 } }", "\"artificial\"");
    let read = |text: &str| Scene::parse(text, folder(), &[]).unwrap();
    assert_eq!(read(&bare), read(GOOD));
}

#[test]
fn a_bundled_scene_survives_writing_and_reading() {
    for (name, text, _) in pontoon::scene::bundled_scenes() {
        let folder = Path::new("scenes").join(name);
        let scene = Scene::parse(text, &folder, &[]).unwrap();
        let again = Scene::parse(&scene.to_toml().unwrap(), &folder, &[]).unwrap();
        assert_eq!(scene, again, "{name}");
        assert!(scene.resolve().unwrap().len() > 30, "{name}: all values are listed");
    }
}

#[test]
fn every_bundled_scene_is_built() {
    for (name, _, files) in pontoon::scene::bundled_scenes() {
        assert!(files.iter().any(|(file, _)| *file == "README.md"), "{name} has a README");
        let scene = Scene::read(&Path::new("scenes").join(name), &[]).unwrap();
        let water = match scene.dimension {
            2 => scene.build::<2>().map(|b| b.setup.water.len()).unwrap(),
            _ => scene.build::<3>().map(|b| b.setup.water.len()).unwrap(),
        };
        assert!(water > 500, "{name}: {water} particles of water");
    }
}

#[test]
fn an_error_about_an_override_shows_its_key_as_written() {
    for (key, value, shown) in [
        ("modle.walls", "1", "modle"),
        ("modle.walls.modle", "1", "modle"),
        ("model.wals", "1", "model.wals"),
        ("model.kernal.cubic", "1", "model.kernal"),
        ("model.viscosity.artifical.alpha", "1", "model.viscosity"),
        ("solid.2.driven.stroke", "1", "solid.paddle.driven.stroke"),
        // Keys inside the value of an override.
        ("model.viscosity", "{ artificial = { alpah = 1 } }", "model.viscosity.artificial.alpah"),
        ("solid.paddle.driven", "{ stroke = 1 }", "solid.paddle.driven.stroke"),
        ("statistic", "[{ roa = 1 }]", "statistic.0.roa"),
        ("contact", "[{ contact = 1 }]", "contact.0.contact"),
        ("solid", "[{ name = 'raft', sahpe = 1 }]", "solid.raft.sahpe"),
    ] {
        let error = try_scene(GOOD, &[(key, value)]).unwrap_err().to_string();
        assert!(error.contains(&format!("in --set, {shown}\n")), "{key}: {error}");
    }
}

#[test]
fn an_error_about_an_unknown_key_of_a_solid_contains_its_full_path() {
    for (from, to, shown) in [
        ("distance = {", "stroke = 1.0, distance = {", "24:32, solid.paddle.driven.stroke"),
        ("formula = ", "formla = ", "24:45, solid.paddle.driven.distance.formla"),
    ] {
        let error = try_scene(&GOOD.replacen(from, to, 1), &[]).unwrap_err().to_string();
        assert!(error.contains(&format!("in scene.toml:{shown}\n")), "{error}");
    }
}

proptest! {
    // Takes some seconds; `bad_input` changes the text itself.
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_overrides_cause_no_panic(key in "[a-z_.0-9]{0,24}", value in "\\PC{0,12}") {
        if let Ok(scene) = Scene::parse(GOOD, folder(), &[(key, value)]) {
            let _ = scene.resolve();
        }
    }
}

#[test]
fn every_family_of_errors_has_its_code() {
    let code = |from: &str, to: &str| try_scene(&GOOD.replacen(from, to, 1), &[]).unwrap_err().code();
    for (from, to, expected) in [
        ("dp        = 0.05", "dp = = 0.05", ErrorCode::InvalidToml),
        ("title ", "titel ", ErrorCode::UnknownKey),
        ("motion = \"box\"", "motion = \"bxo\"", ErrorCode::UnknownName),
        ("artificial = {", "artifical = {", ErrorCode::UnknownName),
        ("until     = 1.0", "", ErrorCode::MissingKey),
        ("free  = { density = 500.0 }", "", ErrorCode::MissingKey),
        ("free  = { density = 500.0 }", "free = { density = 500.0, mass = 1.0 }", ErrorCode::ConflictingKeys),
        ("fixed = true", "fixed = true\nfree = { density = 500.0 }", ErrorCode::ConflictingKeys),
        ("dp        = 0.05", "dp = \"fine\"", ErrorCode::WrongType),
        ("along = [1.0, 0.0]", "along = [1.0]", ErrorCode::WrongType),
        ("dp        = 0.05", "dp = -0.05", ErrorCode::OutOfRange),
    ] {
        assert_eq!(code(from, to), expected, "{from} -> {to}");
    }
    let nowhere = Scene::read("no/such/scene.toml".as_ref(), &[]).unwrap_err();
    assert_eq!(nowhere.code(), ErrorCode::FileNotFound);
    let full = Error::write("a.csv".as_ref(), "written", &std::io::ErrorKind::StorageFull.into());
    assert_eq!((full.code(), full.message.starts_with("a.csv: cannot be written: ")), (ErrorCode::DiskFull, true));
}

/// The output of a program whose `main` returns the error, as in `examples/`.
#[test]
fn an_error_returned_from_main_prints_message_and_help() {
    let error = Error::scene("nothing is called \"narow\"").help("write narrow");
    assert_eq!(format!("{error:?}"), "nothing is called \"narow\"\n  write narrow");
}

/// A place as a list has as many numbers as the scene has dimensions, for solids, parts of compounds and water.
#[test]
fn a_place_as_a_list_has_all_coordinates() {
    let head = |d: usize| {
        let (min, max) = (vec![0.0; d], vec![1.0; d]);
        let pool = format!("[[water]]\nfill = {{ box = {{ min = {min:?}, max = {max:?} }} }}\n");
        format!("dimension = {d}\ndp = 0.05\nuntil = 1.0\n{pool}")
    };
    let ball = |at: &str| {
        format!("[[solid]]\nname = \"s\"\nfixed = true\nshape = {{ ball = {{ radius = 0.2 }} }}\nat = {at}\n")
    };
    let part = |at: &str| {
        let part = format!("{{ shape = {{ ball = {{ radius = 0.2 }} }}, at = {at} }}");
        format!("[[solid]]\nname = \"s\"\nfixed = true\nshape = {{ compound = [{part}] }}\n")
    };
    let water = |at: &str| format!("[[water]]\nfill = {{ shape = {{ ball = {{ radius = 0.2 }} }}, at = {at} }}\n");
    let places: [&dyn Fn(&str) -> String; 3] = [&ball, &part, &water];
    for (place, key) in places.into_iter().zip(["solid.s.at", "solid.s.shape.compound.0.at", "water.1.fill.at"]) {
        let message = |d: usize, at: &str| {
            let read = Scene::parse(&format!("{}{}", head(d), place(at)), Path::new(""), &[]);
            read.and_then(|scene| scene.plan()).map_or_else(|e| e.to_string(), |_| String::new())
        };
        for (d, at, what) in [
            (3, "[0.5, 0.5]", "at has 2 numbers, not 3"),
            (2, "[0.5, 0.5, 0.1]", "at has 3 numbers, not 2"),
            (3, "[0.5]", "not of 1"),
            (3, "[]", "not of 0"),
            (3, "[0.5, 0.5, 0.1, 0.2]", "not of 4"),
        ] {
            let found = message(d, at);
            assert!(found.contains(what) && found.contains(key), "{key} = {at}: {found}");
        }
        assert_eq!(message(3, "[0.5, 0.5, 0.1]"), "");
    }
}

#[test]
fn the_coordinates_of_a_list_have_the_line_of_the_list_as_their_source() {
    let text = GOOD.replace("at    = { x = 0.5, draft = \"equilibrium\" }", "at    = [0.5, 0.45]");
    let source = |sets: &[(String, String)], key: &str| {
        let values = Scene::parse(&text, Path::new("s.toml"), sets).and_then(|scene| scene.resolve()).expect("a scene");
        values
            .iter()
            .find(|value| value.key == key)
            .unwrap_or_else(|| panic!("{key} among {values:?}"))
            .source
            .to_string()
    };
    assert_eq!(source(&[], "solid.box.at.y"), "scene line 17");
    assert_eq!(source(&[("solid.box.at".into(), "[0.4, 0.5]".into())], "solid.box.at.x"), "--set");
}
