//! Inputs that once gave wrong results without a word are refused at their key, or are findings.

use std::fs;

use pontoon::{
    preflight::Severity,
    run::{self, InspectOptions},
};

use crate::common::TestFolder;

/// A valid scene of a free box, a gate above the water and a tank; it takes further sections.
const GOOD: &str = "dimension = 2\ndp = 0.05\nuntil = 2.0\nframes = \"off\"\n\
    [[water]]\nfill = { box = { min = [0.0, 0.0], max = [2.0, 0.5] } }\n\
    [[solid]]\nname = \"tank\"\nfixed = true\nshape = { tank = { size = [2.0, 1.0] } }\n\
    [[solid]]\nname = \"box\"\nshape = { box = { size = [0.5, 0.3] } }\nat = { x = 1.0, draft = \"equilibrium\" }\n\
    free = { density = 500.0 }\n\
    [[solid]]\nname = \"gate\"\nshape = { box = { size = [0.2, 0.2] } }\nat = { x = 1.0, bottom = 1.2 }\n\
    driven = { along = [0.0, 1.0], distance = LAW }\n";

/// A law that does nothing.
const REST: &str = "{ formula = \"0*t\" }";

/// The message of the scene with this text and these files beside it, or its findings.
fn inspected(name: &str, scene: &str, files: &[(&str, &str)]) -> Result<Vec<(Severity, String)>, String> {
    let folder = TestFolder::new(&format!("silent-{name}"));
    fs::write(folder.join("scene.toml"), scene).unwrap();
    files.iter().for_each(|(file, text)| fs::write(folder.join(file), text).unwrap());
    let options = InspectOptions { threads: Some(1), ..InspectOptions::default() };
    let inspected = run::inspect(&folder.join("scene.toml"), &options).map_err(|e| e.to_string())?;
    let findings = inspected.report().unwrap().preflight.findings;
    Ok(findings.into_iter().map(|f| (f.severity, format!("{}\n{}", f.what, f.mend))).collect())
}

/// Asserts that the scene is refused with a message of all these words.
fn assert_refused(name: &str, scene: &str, files: &[(&str, &str)], words: &[&str]) {
    let message = inspected(name, scene, files).expect_err(&format!("{name} is refused"));
    words.iter().for_each(|word| assert!(message.contains(word), "{name}: {word} is not in\n{message}"));
}

/// Asserts that the scene has a finding of all these words.
fn assert_found(name: &str, scene: &str, files: &[(&str, &str)], words: &[&str]) {
    let findings = inspected(name, scene, files).unwrap_or_else(|e| panic!("{name}: {e}"));
    let found = findings.iter().any(|(_, text)| words.iter().all(|word| text.contains(word)));
    assert!(found, "{name}: {words:?} are not in one of {findings:#?}");
}

/// Asserts that no finding of the scene has this word.
fn assert_not_found(name: &str, scene: &str, files: &[(&str, &str)], word: &str) {
    let findings = inspected(name, scene, files).unwrap_or_else(|e| panic!("{name}: {e}"));
    assert!(!findings.iter().any(|(_, text)| text.contains(word)), "{name}: {word} is in {findings:#?}");
}

/// The valid scene with this law of the gate and these sections.
fn scene(law: &str, more: &str) -> String {
    GOOD.replace("LAW", law) + more
}

#[test]
fn a_formula_without_a_value_during_the_run_is_refused_with_its_time() {
    let root = "sqrt(1-t)";
    let of_gate = scene(&format!("{{ formula = \"{root}\" }}"), "");
    assert_refused("driven", &of_gate, &[], &["scene.toml:20", "driven.distance", "t = 1 s", "sqrt(max("]);
    let chain = "[[line_type]]\nname = \"c\"\ndiameter = 0.01\nmass_per_length = 0.5\nstiffness = 1e4\n[[mooring]]\n\
                 name = \"m\"\nbetween = [\"box\"]\nfrom = [1.0, 0.4]\nto = [0.2, 0.0]\nlength = 1.2\nline = \"c\"\n\
                 paid_out = { formula = \"sqrt(1-t)-1\" }\n";
    let slider =
        "[[joint]]\nname = \"j\"\nkind = \"slider\"\nbetween = [\"box\"]\nalong = [0.0, 1.0]\nat = [1.0, 0.5]\n";
    let force = "[[force]]\nname = \"f\"\non = \"box\"\nforce = [\"sqrt(1-t)\", 0.0]\n";
    let motor = format!("{slider}motor = {{ force = \"sqrt(1-t)\" }}\n");
    for (name, more, key) in [
        ("moor", chain, "mooring.0.paid_out"),
        ("force", force, "force.0.force"),
        ("wind", "[[wind]]\non = [\"box\"]\nvelocity = [\"sqrt(1-t)\", 0.0]\n", "wind.0.velocity"),
        ("joint", &motor, "joint.0.motor.force"),
    ] {
        assert_refused(name, &scene(REST, more), &[], &[key, "t = 1 s"]);
    }
    // A check is computed after the run, whose time would be lost.
    let check = "[[probe]]\nmotion = \"box\"\n[[check]]\nseries = \"box.heave_m\"\nformula = \"sqrt(1-t)\"\n";
    assert_refused("check", &scene(REST, check), &[], &["check.0.formula", "t = 1 s"]);
    assert_not_found("early", &scene(REST, &format!("{check}until = 0.9\n")), &[], "no value");
    // A force that has ended, and a time that no step meets, need no value.
    for (name, more) in [("ended", format!("{force}until = 1.0\n")), ("hole", force.replace(root, "(t-1)/(t-1)"))] {
        assert_not_found(name, &scene(REST, &more), &[], "no value");
    }
}

/// Between its samples such a law gave a body a speed without a meaning. The message gives the place of the pole, and a peak of the same
/// height is accepted.
#[test]
fn a_law_that_grows_without_bound_during_the_run_is_refused_with_its_time() {
    let slider =
        "[[joint]]\nname = \"j\"\nkind = \"slider\"\nbetween = [\"box\"]\nalong = [0.0, 1.0]\nat = [1.0, 0.5]\n";
    let force = "[[force]]\nname = \"f\"\non = \"box\"\nforce = [\"LAW\", 0.0]\n";
    let motor = format!("{slider}motor = {{ force = \"LAW\" }}\n");
    let wind = "[[wind]]\non = [\"box\"]\nvelocity = [\"LAW\", 0.0]\n";
    for (name, more, key) in
        [("force", force, "force.0.force"), ("wind", wind, "wind.0.velocity"), ("joint", &motor, "joint.0.motor.force")]
    {
        for (law, t) in [("1/(t-0.5)", "0.5"), ("1/(t-0.50037)", "0.5004"), ("tan(pi*t/4)", "2")] {
            let words = [key, "grows without bound", &format!("t = {t} s")];
            assert_refused(&format!("pole-{name}"), &scene(REST, &more.replace("LAW", law)), &[], &words);
        }
        let peak = scene(REST, &more.replace("LAW", "20/(1+(1e3*(t-0.5))^2)"));
        assert_not_found(&format!("peak-{name}"), &peak, &[], "without bound");
    }
    let gravity = scene(REST, "").replace("until", "gravity = [\"1/(t-0.5)\", -9.81]\nuntil");
    assert_refused("pole-gravity", &gravity, &[], &["scene.toml:3", "gravity", "grows without bound at t = 0.5 s"]);
}

/// A line of less than a hundredth of its length is not computed: the winch would stop there without a word.
#[test]
fn a_winch_that_takes_in_the_whole_line_is_refused_with_the_time() {
    let line = "[[line_type]]\nname = \"c\"\ndiameter = 0.01\nmass_per_length = 0.5\nstiffness = 1e4\n[[mooring]]\n\
                name = \"m\"\nbetween = [\"box\"]\nfrom = [1.0, 0.4]\nto = [0.2, 0.0]\nlength = 1.2\nline = \"c\"\n";
    let winch = format!("{line}paid_out = {{ formula = \"-t\" }}\n");
    assert_refused("winch", &scene(REST, &winch), &[], &["mooring.0.paid_out", "t = 1.19 s", "-1.19 m or more"]);
    assert_not_found("released", &scene(REST, &format!("{winch}until = 1.0\n")), &[], "winch");
}

#[test]
fn negative_constants_of_the_laws_are_refused_with_their_key() {
    for (law, key) in [
        ("viscosity = { riemann = { eta = -1.0 } }", "viscosity.riemann.eta"),
        ("viscosity = { artificial = { alpha = -0.01 } }", "viscosity.artificial.alpha"),
        ("viscosity = { laminar = { nu0 = -1e-6 } }", "viscosity.laminar.nu0"),
        ("viscosity = { sps = { nu0 = 1e-6, smagorinsky = -0.1 } }", "viscosity.sps.smagorinsky"),
        ("viscosity = { sps = { nu0 = 1e-6, isotropic = -0.1 } }", "viscosity.sps.isotropic"),
        ("diffusion = { fourtakas = { delta = -0.1 } }", "diffusion.fourtakas.delta"),
        ("diffusion = { molteni = { delta = -0.1 } }", "diffusion.molteni.delta"),
        ("shifting = { everywhere = { a = -2.0 } }", "shifting.everywhere.a"),
    ] {
        assert_refused("model", &scene(REST, &format!("[model]\n{law}\n")), &[], &["scene.toml:22", key, "0 or more"]);
    }
    for (more, key) in [
        ("[model]\ngamma = -1.0\n", "model.gamma"),
        ("[model]\nrho0 = 0.0\n", "model.rho0"),
        ("[time]\ndt_max = -1.0\n", "time.dt_max"),
        ("[checkpoint]\nwall = -1.0\n", "checkpoint.wall"),
        ("[[probe]]\nmotion = \"box\"\nevery = -1.0\n", "probe.0.every"),
    ] {
        assert_refused("positive", &scene(REST, more), &[], &["scene.toml:2", key, "above 0"]);
    }
    let four = scene(REST, "").replace("dimension = 2", "dimension = 4");
    assert_refused("dimension", &four, &[], &["scene.toml:1", "2 or 3"]);
}

/// The record `x` (in the second column) of a force.
fn with_force(table: &str, column: &str) -> (String, [(&'static str, String); 1]) {
    let force =
        format!("[[force]]\nname = \"f\"\non = \"box\"\nforce = [{{ file = \"w.csv\", column = {column} }}, 0.0]\n");
    (scene(REST, &force), [("w.csv", table.into())])
}

#[test]
fn a_unit_that_is_not_of_the_si_is_a_warning_with_its_factor() {
    // Standard values: g = 9.80665 m/s², 1 lb = 0.45359237 kg, 1 ft = 0.3048 m.
    for (column, words) in [
        ("F (kgf)", Some("9.80665")),
        ("F (lbf)", Some("4.4482216152605")),
        ("F (tf)", Some("9806.65")),
        ("F (daN)", Some("scale = 10")),
        ("F [mN]", Some("0.001")),
        ("F kN", Some("1000")),
        ("F (N.mm)", Some("another quantity than N")),
        ("F (lbf.ft)", Some("another quantity than N")),
        ("F (knots)", Some("another quantity than N")),
        ("F (mrad)", Some("another quantity than N")),
        ("F (s)", Some("another quantity than N")),
        ("F_m_per_s", Some("another quantity than N")),
        ("F (lb)", Some("the weight of 1 lb is 4.45 N")),
        ("F (g)", Some("the weight of 1 g is 0.00981 N")),
        ("F (kn)", Some("scale = 1000  beside the column; 1 kn is taken as 1000 N")),
        ("F (N)", None),
        ("F (kg m/s^2)", None),
    ] {
        let (scene, [(file, table)]) = with_force(&format!("t_s,{column}\n0,0\n5,1\n"), "2");
        match words {
            Some(words) => assert_found("unit", &scene, &[(file, &table)], &["is in", words]),
            None => assert_not_found("unit", &scene, &[(file, &table)], "unit"),
        }
    }
    for (time, factor) in [("t (h)", "3600"), ("t (hr)", "3600"), ("t (d)", "86400"), ("t (min)", "60")] {
        let (scene, [(file, table)]) = with_force(&format!("{time},F\n0,0\n5,1\n"), "\"F\"");
        assert_found("time", &scene, &[(file, &table)], &["as if in s", &format!("time_factor = {factor}")]);
    }
    for unit in ["t", "furlong"] {
        let (scene, [(file, table)]) = with_force(&format!("t_s,F ({unit})\n0,0\n5,1\n"), "2");
        assert_found("unknown", &scene, &[(file, &table)], &[&format!("\"{unit}\""), "scale = "]);
    }
    let angle = scene(REST, "").replace(
        "driven = { along = [0.0, 1.0], distance = { formula = \"0*t\" } }",
        "driven = { hinge = [1.0, 1.3], angle = { file = \"w.csv\", column = \"a\" } }",
    );
    assert_found("rev", &angle, &[("w.csv", "t_s,a\ns,rev\n0,0\n5,0.1\n")], &["rev", "scale = 6.283185307"]);
    assert_refused("grad", &angle, &[("w.csv", "t_s,a\ns,Grad\n0,0\n5,0.1\n")], &["unknown unit", "Grad", "line 2"]);
}

#[test]
fn names_and_comments_of_records_are_told_apart() {
    let (times, [(file, table)]) = with_force("0 0\n1 0.2\n2 0.2\n", "1");
    assert_found("times", &times, &[(file, &table)], &["column of times"]);
    let (comment, [(file, table)]) = with_force("t_s,y_m\n0,0\n1,0.2 # top\n2,0.2\n", "\"y_m\"");
    assert_refused("comment", &comment, &[(file, &table)], &["comment behind it", "line 3"]);
    let (case, [(file, table)]) = with_force("T_S,Y_M\n0,0\n2,0.2\n", "\"y_m\"");
    assert_refused("case", &case, &[(file, &table)], &["did you mean \"Y_M\""]);
    let (two, [(file, table)]) = with_force("t_s,y_mm (m)\n0,0\n2,0.2\n", "2");
    assert_refused("two-units", &two, &[(file, &table)], &["two units, mm and m"]);
}

#[test]
fn components_that_say_a_number_twice_are_refused() {
    let paddle = scene(REST, "")
        .replace("at = { x = 1.0, bottom = 1.2 }", "at = { x = -0.1, bottom = 0.0 }")
        .replace("size = [0.2, 0.2]", "size = [0.2, 0.9]")
        .replace("distance = { formula = \"0*t\" }", "wave = { components = { file = \"c.csv\" } }")
        .replace("along = [0.0, 1.0]", "along = [1.0, 0.0]");
    for (header, row, words) in [
        ("amplitude_m,period_s,frequency_hz,phase_deg", "0.01,1.5,1.0,0", ["period_s", "frequency_hz"]),
        ("amplitude_m,period_s,phase_deg,phase_rad", "0.01,1.5,90,0", ["phase_deg", "phase_rad"]),
        ("amplitude_m (mm),period_s,phase_deg", "0.01,1.5,90", ["two units", "m and mm"]),
    ] {
        assert_refused("components", &paddle, &[("c.csv", &format!("{header}\n{row}\n"))], &words);
    }
    let blank = "amplitude_m,period_s,phase_deg\n0.01,1.2,\n0.02,1.3,10\n";
    assert_refused("blank", &paddle, &[("c.csv", blank)], &["no value", "line 2", "phase_deg", "components.file"]);
    let good = "amplitude_m,period_s,phase_deg\n0.01,1.5,90\n";
    assert_not_found("components", &paddle, &[("c.csv", good)], "two units");
}

#[test]
fn the_valid_scene_has_no_warning() {
    let findings = inspected("good", &scene(REST, ""), &[]).unwrap();
    assert!(findings.iter().all(|(severity, _)| *severity != Severity::Warning), "{findings:#?}");
}

/// The valid scene with the words of each pair replaced.
fn changed(pairs: &[(&str, &str)]) -> String {
    pairs.iter().fold(scene(REST, ""), |text, (from, to)| {
        assert!(text.contains(from), "{from} is not in the scene");
        text.replace(from, to)
    })
}

/// The box that touches nothing: contacts do not act across periodic sides.
const UNTOUCHED: &str = "free = { density = 500.0 }\n[[contact]]\nbetween = [\"box\"]\ntouch = false\n";

/// The region of the water of the valid scene.
const REGION: &str = "min = [0.0, 0.0], max = [2.0, 0.5] } }";

#[test]
fn a_paddle_apart_from_the_water_is_found() {
    let wave = "wave = { regular = { height = 0.1, period = 1.5 }, ramp = 0.5 }";
    let paddle = |x: f64, wave: &str| {
        let at = format!("at = {{ x = {x}, bottom = 0.0 }}");
        changed(&[
            ("at = { x = 1.0, bottom = 1.2 }", &at),
            ("size = [0.2, 0.2]", "size = [0.2, 0.9]"),
            ("along = [0.0, 1.0], distance = { formula = \"0*t\" }", &format!("along = [1.0, 0.0], {wave}")),
            ("tank = { size = [2.0, 1.0] } }", "tank = { size = [4.0, 1.0] } }\nat = { x = 0.0 }"),
        ])
    };
    // Its face is 0.1 m before its middle.
    for x in [-1.0, -0.2, -0.15] {
        assert_found("dry-paddle", &paddle(x, wave), &[], &["face of \"gate\"", "cross the gap"]);
    }
    assert_not_found("wet-paddle", &paddle(-0.1, wave), &[], "cross the gap");
    let shallow = wave.replace("ramp = 0.5", "ramp = 0.5, depth = 0.2");
    assert_found("shallow", &paddle(-0.1, &shallow), &[], &["made for 0.2 m", "wave.depth = 0.5"]);
    assert_not_found("deep", &paddle(-0.1, wave), &[], "made for");
    let focus = |time: f64| {
        let wave =
            format!("wave = {{ focused = {{ crest = 0.05, peak_period = 1.5, distance = 1.0, time = {time} }} }}");
        paddle(-0.1, &wave)
    };
    assert_found("focus", &focus(50.0), &[], &["comes at 50 s", "until = 50"]);
    let eta: String =
        (0..40).map(|i| format!("{},{}\n", 0.1 * f64::from(i), 0.02 * (0.42 * f64::from(i)).sin())).collect();
    let table = format!("t_s,eta_m\n{eta}");
    for (distance, found) in [(-1.0, true), (100.0, true), (1.0, false)] {
        let wave =
            format!("wave = {{ elevation = {{ file = \"c.csv\", column = \"eta_m\", distance = {distance} }} }}");
        let (scene, files) = (paddle(-0.1, &wave), [("c.csv", table.as_str())]);
        match found {
            true => assert_found("distance", &scene, &files, &["elevation.distance", "reaches"]),
            false => assert_not_found("distance", &scene, &files, "elevation.distance"),
        }
    }
}

#[test]
fn a_level_above_its_region_is_refused_and_one_between_two_rows_noted() {
    let with_level = |level: &str| changed(&[(REGION, &format!("{REGION}\nlevel = {level}"))]);
    assert_refused("high-level", &with_level("0.6"), &[], &["water.0.level", "0.6 m", "0.5 m"]);
    assert_not_found("level", &with_level("0.4"), &[], "whole number of dp");
    assert_found("between", &changed(&[("max = [2.0, 0.5]", "max = [2.0, 0.52]")]), &[], &["reach 0.5 m", "0.52 m"]);
    let shape = "fill = { shape = { box = { size = [2.0, 0.6] } }, at = { x = 1.0, y = 0.3 } }\nlevel = 0.425";
    let between = changed(&[(&format!("fill = {{ box = {{ {REGION}"), shape)]);
    assert_found("between-shape", &between, &[], &["its level is 0.425 m"]);
}

#[test]
fn water_that_nothing_carries_or_that_lies_on_other_water_is_found() {
    let raised = changed(&[("min = [0.0, 0.0]", "min = [0.0, 0.1]")]);
    assert_found("raised", &raised, &[], &["water.0 begins at 0.1 m", "it falls"]);
    let stacked = format!("{REGION}\n[[water]]\nfill = {{ box = {{ min = [0.0, 0.1], max = [2.0, 0.6] }} }}");
    assert_found("stacked", &changed(&[(REGION, &stacked)]), &[], &["water.1 stands to 0.6 m on water.0"]);
    let beside =
        "min = [0.0, 0.0], max = [1.0, 0.5] } }\n[[water]]\nfill = { box = { min = [1.0, 0.0], max = [2.0, 0.4] } }";
    for word in ["falls", "stands to"] {
        assert_not_found("beside", &changed(&[(REGION, beside)]), &[], word);
    }
}

#[test]
fn a_period_of_another_length_than_the_water_is_found() {
    let periodic = |sides: &str| {
        changed(&[
            ("frames = \"off\"", &format!("frames = \"off\"\nperiodic = {{ x = {sides} }}")),
            ("free = { density = 500.0 }\n", UNTOUCHED),
            (
                "shape = { tank = { size = [2.0, 1.0] } }",
                "shape = { box = { size = [9.0, 0.3] } }\nat = { x = 1.0, y = -0.15 }",
            ),
        ])
    };
    assert_found("long", &periodic("[0.3, 1.8]"), &[], &["overlaps its periodic image", "periodic.x = [0, 2]"]);
    assert_found("short", &periodic("[-0.5, 2.5]"), &[], &["does not meet its periodic image"]);
    assert_not_found("period", &periodic("[0.0, 2.0]"), &[], "periodic image");
}

#[test]
fn a_draft_under_another_gravity_is_found() {
    for (gravity, name) in [("[9.81, 0.0]", "sideways"), ("[0.0, 9.81]", "upwards")] {
        let turned = changed(&[("frames = \"off\"", &format!("frames = \"off\"\ngravity = {gravity}"))]);
        assert_found(name, &turned, &[], &["gravity is", "downwards"]);
    }
}

#[test]
fn a_carriage_that_starts_at_speed_with_the_water_is_noted() {
    let towed = |water: &str| {
        changed(&[
            (
                "frames = \"off\"",
                "frames = \"off\"\ntowed = { along = \"x\", velocity = 0.3 }\nperiodic = { x = [0.0, 2.0] }",
            ),
            (REGION, &format!("{REGION}\n{water}")),
            ("free = { density = 500.0 }\n", UNTOUCHED),
            (
                "shape = { tank = { size = [2.0, 1.0] } }",
                "shape = { box = { size = [9.0, 0.3] } }\nat = { x = 1.0, y = -0.15 }",
            ),
        ])
    };
    assert_found("along", &towed(""), &[], &["carriage starts at 0.3 m/s", "velocity of -0.3"]);
    assert_not_found("at-rest", &towed("velocity = [-0.3, 0.0]"), &[], "carriage starts");
}

#[test]
fn a_check_that_the_run_does_not_reach_is_found() {
    let check = |words: &str| {
        scene(REST, &format!("[[probe]]\nmotion = \"box\"\n[[check]]\nseries = \"box.heave_m\"\n{words}\n"))
    };
    for (words, key) in [
        ("formula = \"0\"\nfrom = 30.0", "from = 30 s"),
        ("formula = \"0\"\nzero = 3.0", "zero = 3 s"),
        ("response = { to = \"box.surge_m\", period = 1.0, ratio = 1.0, from = 4.0 }", "response.from = 4 s"),
    ] {
        assert_found(
            "check-after",
            &check(words),
            &[],
            &["\"box.heave_m\"", key, "the run ends at 2 s", "they judge nothing"],
        );
    }
    assert_not_found("check-within", &check("formula = \"0\"\nfrom = 1.0"), &[], "judge");
    // The probe reads every 2 ms.
    for (name, range) in
        [("check-before", "from = -5.0\nuntil = -1.0"), ("check-between", "from = 1.0005\nuntil = 1.0015")]
    {
        let words = ["\"box.heave_m\" has less than two readings", "from 0 to 2 s", "every 0.002 s"];
        assert_found(name, &check(&format!("formula = \"0\"\n{range}")), &[], &words);
    }
    // A mean over 1 s belongs to 0.5 s before its row.
    let means = check("formula = \"0\"\nfrom = 0.5")
        .replace("motion = \"box\"", "motion = \"box\"\nevery = 1.0\naverage = true");
    assert_not_found("check-means", &means, &[], "two readings");
    assert_found("check-mean", &means.replace("from = 0.5", "from = 0.6"), &[], &["two readings", "every 1 s"]);
    assert_not_found("check-two", &check("formula = \"0\"\nfrom = 1.0\nuntil = 1.003"), &[], "two readings");
    let table = [("r.csv", "t_s,z_m\n10,0\n11,0\n12,0\n")];
    let by_table = |words: &str| check(&format!("reference = \"r.csv\"\ncolumn = \"z_m\"\n{words}"));
    let words = ["\"box.heave_m\" is not judged", "from 0 to 2 s", "0 of the 3 samples of r.csv", "from 10 to 12 s"];
    assert_found("reference-after", &by_table(""), &table, &words);
    assert_not_found("reference-moved", &by_table("offset = -10.0"), &table, "judge");
    // A bound is judged over half of its reference or more.
    let long = [("r.csv", "t_s,z_m\n0,0\n1,0\n2,0\n3,0\n4,0\n5,0\n6,0\n")];
    assert_found("reference-longer", &by_table("bound = { off = 0.1 }"), &long, &["3 of the 7 samples", "until"]);
    assert_not_found("reference-until", &by_table("until = 4.0\nbound = { off = 0.1 }"), &long, "judge");
    assert_not_found("reference-free", &by_table(""), &long, "judge");
}

#[test]
fn lists_in_place_of_tables_and_longer_lists_are_refused_with_the_form() {
    let free = "free = { density = 500.0 }";
    let box_shape = "{ box = { size = [0.5, 0.3] } }";
    let shaped = |shape: &str| scene(REST, "").replace(box_shape, shape);
    let probed = |probe: &str| scene(REST, &format!("[[probe]]\n{probe}\n"));
    let check = "motion = \"box\"\n[[check]]\nseries = \"box.heave_m\"\nformula = \"0\"\n";
    let solid_at = |at: &str| format!("[[solid]]\nname = \"sill\"\nfixed = true\nshape = {box_shape}\nat = {at}\n");
    for (text, words) in [
        (scene(REST, "").replace(free, "free = [500]"), ["free must be a table, not a list", "free = { density"]),
        // The position alone may be a list.
        (scene(REST, &solid_at("[1.0, 0.4, 0.0, 0.1]")), ["a place is a list of 2 numbers in 2-D", "at = { x"]),
        (probed(&format!("{check}bound = [0.1]")), ["bound must be a table, not a list", "bound = { N"]),
        (scene(REST, "").replacen("[[water]]", "model = []\n[[water]]", 1), ["model must be a table", "[model]"]),
        (shaped("{ ball = [0.1] }"), ["ball must be a table, not a list", "{ ball = { radius"]),
        (shaped("{ capsule = [0.1, 0.03] }"), ["capsule must be a table, not a list", "{ capsule = { length"]),
        (shaped("{ wedge = [[0.1, 0.1]] }"), ["wedge must be a table, not a list", "{ wedge = { size"]),
        (shaped("{ box = [[0.2, 0.1]] }"), ["box must be a table, not a list", "{ box = { size"]),
        (shaped("{ box = [0.2, 0.1] }"), ["box must be a table, not a list", "{ box = { size"]),
        (shaped("{ box = [] }"), ["box must be a table, not a list", "{ box = { size"]),
        (shaped("[0.2]"), ["shape must be a word, or a table with one key, not a list", "shape = { box"]),
        (scene(REST, "[model]\nviscosity = { artificial = [0.01] }"), ["artificial must be a table", "alpha = "]),
        (probed("elevation = [0.2]"), ["elevation must be a table, not a list", "elevation = { x"]),
        (probed("contact = [\"box\", \"gate\", \"tank\"]"), ["contact must be a list of 2, not of 3", "contact = ["]),
        (probed("contact = [\"box\"]"), ["contact must be a list of 2, not of 1", "contact = ["]),
        (
            scene(REST, "[guard]\ndensity = [0.5, 1.5, 2.0]"),
            ["density must be a list of 2, not of 3", "density = [0.5"],
        ),
    ] {
        assert_refused("form", &text, &[], &["scene.toml:", words[0], words[1]]);
    }
}

#[test]
fn a_table_of_points_without_names_has_two_columns() {
    let shape = scene(REST, "").replace("{ box = { size = [0.5, 0.3] } }", "{ polygon = { file = \"r.csv\" } }");
    let message = inspected("points", &shape, &[("r.csv", "1,0,0\n2,.2,0\n3,.2,.1\n")]).unwrap_err();
    assert!(message.contains("no row of names") && message.contains("two columns, x and y"), "{message}");
    assert!(!message.contains("column = 2"), "{message}");
}

#[test]
fn names_of_other_programs_propose_those_of_a_scene() {
    let shaped = |shape: &str| scene(REST, "").replace("{ box = { size = [0.5, 0.3] } }", shape);
    let driven = |wave: &str| {
        scene(REST, "").replace(
            "driven = { along = [0.0, 1.0], distance = { formula = \"0*t\" } }",
            &format!("driven = {{ wave = {wave} }}"),
        )
    };
    for (text, words) in [
        (shaped("{ sphere = { radius = 0.1 } }"), ["did you mean \"ball\"?", "{ ball = { radius"]),
        (shaped("{ ellipse = { radii = [0.2, 0.1] } }"), ["did you mean \"ellipsoid\"?", "radii = [0.2, 0.1] } }"]),
        (
            shaped("{ mesh = { file = \"a.stl\", contact = \"convex\" } }"),
            ["did you mean \"hull\"?", "contact = \"hull\""],
        ),
        (driven("{ regular = { H = 0.1, T = 1.2 } }"), ["did you mean \"height\"?", "height = 0.1"]),
        (driven("{ regular = { height = 0.1, T = 1.2 } }"), ["did you mean \"period\"?", "period = 1.2"]),
        (driven("{ jonswap = { Hs = 0.1, Tp = 1.2 } }"), ["did you mean \"height\"?", "height"]),
        (driven("{ jonswap = { height = 0.1, Tp = 1.2 } }"), ["did you mean \"peak_period\"?", "peak_period = 1.4"]),
        (
            scene(REST, "").replace("free =", "fixed = false\nfree ="),
            ["fixed = false says nothing beside free", "remove"],
        ),
    ] {
        assert_refused("names", &text, &[], &["scene.toml:", words[0], words[1]]);
    }
}

#[test]
fn a_statistic_after_the_run_is_found_and_a_crate_on_a_raft_does_not_capsize() {
    let statistic = "[[probe]]\nmotion = \"box\"\n[[statistic]]\nwaves = \"box\"\nfrom = 20.0\n";
    assert_found("statistic", &scene(REST, statistic), &[], &["statistic", "20 s", "ends at 2 s"]);
    // The box floats with half its height of 0.3 m above the level of 0.5 m. A square crate of half the density of water
    // has a negative metacentric height, but it stands on the box.
    let on_top = "[[solid]]\nname = \"crate\"\nshape = { box = { size = [0.15, 0.15] } }\nat = { x = 1.0, bottom = 0.65 }\n\
                  free = { density = 500.0 }\n";
    assert_not_found("crate", &scene(REST, on_top), &[], "\"crate\" will turn over");
    let afloat = on_top.replace("x = 1.0, bottom = 0.65", "x = 0.3, draft = \"equilibrium\"");
    assert_found("afloat", &scene(REST, &afloat), &[], &["\"crate\" will turn over"]);
}

/// The pressure is that of a plane sound wave, ρ c₀ V with c₀ = 10 √(9.81 × 0.5) = 22.1 m/s. Water that moves along feels nothing, and
/// neither does the air.
#[test]
fn a_driven_solid_that_sets_out_with_a_speed_in_water_is_a_finding() {
    let plate = |law: &str| {
        let plate =
            "[[solid]]\nname = \"plate\"\nshape = { box = { size = [0.2, 0.2] } }\nat = { x = 0.4, y = 0.25 }\n";
        scene(REST, &format!("{plate}driven = {{ along = [1.0, 0.0], distance = {{ formula = \"{law}\" }} }}\n"))
    };
    let sudden = plate("0.3*t");
    assert_found("sudden", &sudden, &[], &["\"plate\" sets out at 0.3 m/s", "6644 Pa", "rate 0 at the start"]);
    let along = sudden.replace("[2.0, 0.5] } }", "[2.0, 0.5] } }\nvelocity = [0.3, 0.0]");
    assert_not_found("along", &along, &[], "sets out");
    assert_not_found("smooth", &plate("0.05*(1-cos(2*pi*t))"), &[], "sets out");
    assert_not_found("in-air", &scene("{ formula = \"0.3*t\" }", ""), &[], "sets out");
}

/// A current of 1.2 m²/s in water 0.3 m deep goes at 4 m/s, whatever the water does at the start; c₀ from the depth is 17 m/s.
#[test]
fn the_target_of_a_current_counts_as_a_speed() {
    let channel = |discharge: f64| {
        format!(
            "dimension = 2\ndp = 0.05\nuntil = 2.0\nframes = \"off\"\nperiodic = {{ x = [0.0, 2.0] }}\n\
             current = {{ along = \"x\", discharge = {discharge} }}\n\
             [[water]]\nfill = {{ box = {{ min = [0.0, 0.0], max = [2.0, 0.3] }} }}\nvelocity = [0.4, 0.0]\n\
             [[solid]]\nname = \"bed\"\nfixed = true\nshape = {{ box = {{ size = [5.0, 0.3] }} }}\nat = {{ x = 1.0, y = -0.15 }}\n"
        )
    };
    assert_found("current", &channel(1.2), &[], &["that of the current, 4 m/s", "c0 = 40"]);
    assert_not_found("slow-current", &channel(0.12), &[], "speed of sound");
}

/// A damping zone that begins behind a paddle damps its waves, and one in a current brings the current to rest.
#[test]
fn damping_zones_over_a_paddle_or_in_a_current_are_findings() {
    let flume = |zone: &str| {
        format!(
            "dimension = 2\ndp = 0.02\nuntil = 4.0\nframes = \"off\"\n\
             [[water]]\nfill = {{ box = {{ min = [0.0, 0.0], max = [6.0, 0.3] }} }}\n\
             [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = [6.4, 0.6] }} }}\nat = {{ x = -0.4 }}\n\
             [[solid]]\nname = \"p\"\nshape = {{ box = {{ size = [0.1, 0.6] }} }}\nat = {{ x = -0.05, bottom = 0.0 }}\n\
             driven = {{ along = [1, 0], wave = {{ regular = {{ height = 0.1, period = 1.3 }} }} }}\n[[damping]]\n{zone}\n"
        )
    };
    // 0.2/1.2 of the zone, squared.
    let behind = flume("from = [-0.2, 0]\nto = [1.0, 0]");
    assert_found("behind", &behind, &[], &["0.0278 of its strength at \"p\"", "ahead of the paddle"]);
    let across = flume("from = [1.0, 0]\nto = [-0.2, 0]");
    assert_found("across", &across, &[], &["0.694 of its strength at \"p\"", "ahead of the paddle"]);
    assert_not_found("far-zone", &flume("from = [3.0, 0]\nto = [6.0, 0]"), &[], "which makes waves");
    let channel = |from: f64| {
        format!(
            "dimension = 2\ndp = 0.05\nuntil = 2.0\nframes = \"off\"\n\
             [[water]]\nfill = {{ box = {{ min = [0.0, 0.0], max = [2.0, 0.3] }} }}\nvelocity = [0.4, 0.0]\n\
             [[solid]]\nname = \"bed\"\nfixed = true\nshape = {{ box = {{ size = [5.0, 0.3] }} }}\nat = {{ x = 1.0, y = -0.15 }}\n\
             [[inflow]]\nx = 0.0\nvelocity = 0.4\n[[outflow]]\nx = 2.0\nvelocity = 0.4\n[[damping]]\nfrom = [{from}, 0]\nto = [5.0, 0]\n"
        )
    };
    assert_found("outflow", &channel(1.0), &[], &["takes the current of 0.4 m/s"]);
    assert_not_found("beyond", &channel(4.0), &[], "takes the current");
}

/// The same as in gravity that changes: the water is not at rest, and theory has no waves for it.
#[test]
fn waves_in_a_carriage_of_changing_velocity_are_refused() {
    let flume = |velocity: &str| {
        format!(
            "dimension = 2\ndp = 0.05\nuntil = 4.0\nframes = \"off\"\ntowed = {{ along = \"x\", velocity = {velocity} }}\n\
             [[water]]\nfill = {{ box = {{ min = [0.0, 0.0], max = [6.0, 0.5] }} }}\n\
             [[solid]]\nname = \"p\"\nshape = {{ box = {{ size = [0.2, 1.0] }} }}\nat = {{ x = -0.1, bottom = 0.0 }}\n\
             driven = {{ along = [1, 0], wave = {{ regular = {{ height = 0.1, period = 1.3 }} }} }}\n"
        )
    };
    assert_refused("towed-waves", &flume("\"0.3*sin(t)\""), &[], &["towed.velocity", "constant velocity"]);
    assert_not_found("steady-tow", &flume("0.3"), &[], "constant velocity");
}

/// A reflection in water ten times as deep as that of the scene had a wave number that says nothing of its waves.
#[test]
fn a_reflection_for_another_depth_is_a_finding() {
    let scene = |depth: f64| {
        let statistic = format!("[[statistic]]\nreflection = [\"row\"]\nperiod = 1.3\ndepth = {depth}\n");
        scene(
            REST,
            &format!("[[probe]]\nname = \"row\"\nelevation = {{ from = 0.2, to = 0.6, count = 3 }}\n{statistic}"),
        )
    };
    assert_found("deep", &scene(5.0), &[], &["statistic.0", "5 m deep", "0.5 m deep"]);
    assert_not_found("own-depth", &scene(0.5), &[], "m deep, and that of the scene");
}

/// A triangle of 0.4 ms has an impulse that a step of some ms does not meet; with four steps it does.
#[test]
fn a_pulse_of_a_force_that_is_shorter_than_the_steps_is_a_finding() {
    let force = |half: &str| {
        let law = format!("2e4*max(0,1-abs(t-0.5003)/{half})");
        scene(REST, &format!("[[force]]\nname = \"f\"\non = \"box\"\nforce = [\"{law}\", 0.0]\n"))
    };
    assert_found("pulse", &force("2e-4"), &[], &["force \"f\"", "at t = 0.5 s", "dt_max"]);
    assert_not_found("long-pulse", &force("0.02"), &[], "has a pulse");
}

#[test]
fn a_law_that_takes_a_solid_out_of_the_scene_is_a_finding() {
    // The gate is 0.7 m above the water. The tank has walls of 4 dp: with the gate the scene is about 2.4 × 1.6 m.
    let law = |law: &str| GOOD.replace("LAW", law);
    let file = |text: &'static str| [("r.csv", text)];
    let record = "{ file = \"r.csv\", column = \"x_m\" }";
    let marked = file("t_s,x_m\n0,0\n0.2,0.002\n0.4,-9999\n0.6,0.005\n2,0.007\n");
    assert_found("jump", &law(record), &marked, &["\"gate\"", "away from its start at 0.4 s", "m large"]);
    assert_found("missing", &law(record), &marked, &["-9999 at 1 of its 5 times, the first 0.4", "missing value"]);
    // 30 m/s × 0.1 m to and fro, within the scene; c₀ = 10 √(9.81 × 0.5) = 22 m/s.
    assert_found(
        "fast",
        &law("{ formula = \"0.1*sin(300*t)\" }"),
        &[],
        &["\"gate\"", "30 m/s", "sound goes at 22.1 m/s"],
    );
    // 0.1 m in 1 µs, between two of the times at which the law is looked at.
    let jump = law("{ formula = \"0.1*max(0,min(1,(t-0.50003)*1e6))\" }");
    assert_found("jump-in-formula", &jump, &[], &["\"gate\"", "100000 m/s at 0.5 s", "sound goes at 22.1 m/s"]);
    let slow = inspected("slow", &law("{ formula = \"0.1*sin(30*t)\" }"), &[]).unwrap();
    assert!(!slow.iter().any(|(_, text)| text.contains("the law of")), "{slow:?}");
    // Values of the same size are values.
    let large = file("t_s,x_m\n0,-990\n1,-999\n2,-995\n");
    let scaled = "{ file = \"r.csv\", column = \"x_m\", scale = 1e-6 }";
    let found = inspected("large", &law(scaled), &large).unwrap();
    assert!(!found.iter().any(|(_, text)| text.contains("missing value")), "{found:?}");
}

#[test]
fn a_fault_of_a_measured_elevation_is_told_at_the_key_with_the_fault() {
    let paddle = |record: &str| {
        format!(
            "{}[[solid]]\nname = \"paddle\"\nshape = {{ box = {{ size = [0.2, 0.8] }} }}\nat = {{ x = 0.0, bottom = 0.0 }}\n\
             driven = {{ along = [1.0, 0.0], wave = {{ elevation = {{ {record} }} }} }}\n",
            GOOD.replace("LAW", REST)
        )
    };
    let table = "t_s,eta_m\n0,0\n0.5,0.01\n1,0\n";
    let key = |word: &str| format!("solid.paddle.driven.wave.elevation.{word}");
    for (word, record, part) in [
        ("file", "file = \"eta.csv\", column = \"eta_m\"", "no file \"eta.csv\""),
        ("column", "file = \"g.csv\", column = \"eta\"", "no column \"eta\"; did you mean \"eta_m\"?"),
        ("time", "file = \"g.csv\", column = \"eta_m\", time = \"t\"", "no column \"t\""),
        ("column", "file = \"g.csv\"", "\"column\" is missing"),
    ] {
        assert_refused("elevation", &paddle(record), &[("g.csv", table)], &[&key(word), part, "scene.toml:"]);
    }
    let check =
        "[[probe]]\nmotion = \"box\"\n[[check]]\nseries = \"box.heave_m\"\nreference = \"g.csv\"\ncolumn = \"eta\"\n";
    let scene = GOOD.replace("LAW", REST) + check;
    assert_refused("check", &scene, &[("g.csv", table)], &["no column \"eta\"", "check.0.column", "eta_m"]);
}

#[test]
fn a_fault_of_an_outline_is_told_at_its_point_or_its_file() {
    let outline = |shape: &str| GOOD.replace("LAW", REST).replace("{ box = { size = [0.5, 0.3] } }", shape);
    let point = ["point 2 of 3 has 1 number, not 2", "solid.box.shape.polygon"];
    let plain = outline("{ polygon = [[0.0, 0.0], [0.3], [0.3, 0.2]] }");
    assert_refused("point", &plain, &[], &[point[0], &format!("{}.1", point[1])]);
    let table = outline("{ polygon = { points = [[0.0, 0.0], [0.3], [0.3, 0.2]] } }");
    assert_refused("points", &table, &[], &[point[0], &format!("{}.points.1", point[1])]);
    let file = outline("{ polygon = { file = \"hull.csv\" } }");
    let names = "solid.box.shape.polygon.file";
    assert_refused("outline", &file, &[], &["no file \"hull.csv\"", names]);
    assert_refused("outline", &file, &[("hull.csv", "a,b,c\n0,0,0\n1,0,0\n1,1,0\n")], &["no column \"x_m\"", names]);
    let part = outline("{ compound = [{ shape = { polygon = { file = \"hull.csv\" } } }] }");
    assert_refused("part", &part, &[], &["solid.box.shape.compound.0.shape.polygon.file"]);
}

#[test]
fn a_tie_that_begins_after_the_removal_of_its_solid_is_refused_with_both() {
    let scene =
        GOOD.replace("LAW", REST).replace("free = { density = 500.0 }", "free = { density = 500.0 }\nuntil = 0.5");
    for (word, section) in [
        ("joint", "[[joint]]\nkind = \"hinge\"\nbetween = [\"box\"]\nat = [1.0, 0.5]\nsince = 1.0\n"),
        (
            "spring",
            "[[spring]]\nbetween = [\"box\"]\nfrom = [1.0, 0.6]\nto = [1.0, 1.0]\nstiffness = 9.0\nsince = 1.0\n",
        ),
        ("force", "[[force]]\non = \"box\"\nforce = [0.0, 1.0]\nsince = 0.5\n"),
    ] {
        let named = section.replace("]]\n", "]]\nname = \"tie\"\n");
        let words = ["solid \"box\" is removed at 0.5 s", &format!("{word}.0.since"), "its  until"];
        assert_refused(word, &format!("{scene}{named}"), &[], &words);
    }
}

/// A corner without one of its coordinates was left out, and the outline became another one.
#[test]
fn an_outline_with_a_corner_without_a_coordinate_is_refused() {
    let shape = "[[solid]]\nname = \"hull\"\nfixed = true\nat = { x = 1.0, bottom = 1.5 }\nshape = { polygon = { file = \"a.csv\" } }\n";
    let polygon = scene(REST, shape);
    let file = |rows: &str| format!("x_m,y_m\n0,0\n0.4,0\n{rows}0.4,0.4\n0,0.4\n");
    for rows in ["0.6,\n", ",0.2\n", "0.6,NaN\n", "NaN,NaN\n"] {
        let words = ["a row has no value", "line 4", "solid.hull.shape.polygon.file", "remove the row"];
        assert_refused("corner", &polygon, &[("a.csv", &file(rows))], &words);
    }
    assert_not_found("corners", &polygon, &[("a.csv", &file(",\n"))], "no value");
    // Many tables repeat the first point at the end.
    assert_not_found("closed", &polygon, &[("a.csv", &(file("") + "0,0\n"))], "the same");
    let scaled = polygon.replace("\"a.csv\"", "\"a.csv\", scale = 0.001");
    assert_refused("scaled", &scaled, &[("a.csv", &file(""))], &["belongs to a drawing", "in metres"]);
}

/// An error that follows from the values of a record names what is strange about them.
#[test]
fn an_error_of_a_body_comes_with_the_warnings_about_its_records() {
    let ballast =
        "free = { density = 500.0, ballast = [{ at = [0.0, 0.0], mass = { file = \"m.csv\", column = \"m_g\" } }] }";
    let heavy = scene(REST, "").replace("free = { density = 500.0 }", ballast);
    let grams = "t_s,m_g\n0,2000\n1,2000\n2,2000\n";
    assert_refused(
        "grams",
        &heavy,
        &[("m.csv", grams)],
        &["sinks", "is in g, and is used as if in kg", "scale = 0.001"],
    );
    // A code for a missing value makes a wave that breaks.
    let paddle = "{ formula = \"0*t\" }";
    let wave = scene(REST, "").replace(
        &format!("driven = {{ along = [0.0, 1.0], distance = {paddle} }}"),
        "driven = { along = [1.0, 0.0], wave = { elevation = { file = \"e.csv\", column = \"eta_m\" } } }",
    );
    let wave = wave.replace("at = { x = 1.0, bottom = 1.2 }", "at = { x = -0.1, bottom = 0.0 }");
    let wave = wave
        .replace("size = [0.2, 0.2]", "size = [0.2, 0.8]")
        .replace("tank = { size = [2.0, 1.0] }", "polyline = [[-0.5, 0.0], [2.0, 0.0], [2.0, 1.0]]");
    let eta = |i: usize| if i == 30 { -999.0 } else { 0.02 * (4.2 * 0.05 * i as f64).sin() };
    let rows: String = (0..80).map(|i| format!("{},{}\n", 0.05 * i as f64, eta(i))).collect();
    let record = format!("t_s,eta_m\n{rows}");
    assert_refused("code", &wave, &[("e.csv", &record)], &["breaks", "has the value -999", "remove the lines with it"]);
}

/// Errors of probes had neither line nor key.
#[test]
fn an_error_of_a_probe_names_its_line_and_its_key() {
    let patch = "[[probe]]\ncontacts = true\n[[probe]]\npatch = { solid = \"box\", box = { min = [0.0, 0.0], max = [0.1, 0.1] } }\n";
    assert_refused("patch", &scene(REST, patch), &[], &["no face of solid \"box\"", "scene.toml:23", "probe.1"]);
}

/// Limits in degrees that are written as radians are told with the key for degrees.
#[test]
fn limits_of_more_than_a_turn_propose_degrees() {
    let hinge = |limits: &str| {
        let joint = "[[joint]]\nname = \"j\"\nkind = \"hinge\"\nbetween = [\"box\"]\nat = [1.0, 0.5]\n";
        scene(REST, &format!("{joint}limits = {limits}\n"))
    };
    let words = ["from -30 to 30 rad it would turn all the way round", "joint.0.limits", "limits_deg"];
    assert_refused("turn", &hinge("[-30, 30]"), &[], &words);
    assert_not_found("part", &hinge("[-3.0, 3.0]"), &[], "rad");
    // A slider may move by metres.
    let slider = hinge("[-30, 30]").replace("kind = \"hinge\"", "kind = \"slider\"\nalong = [0.0, 1.0]");
    assert_not_found("slider", &slider, &[], "all the way round");
    let generic = hinge("{ turn = [-10, 10] }").replace("kind = \"hinge\"", "kind = \"generic\"\nfree = [\"turn\"]");
    assert_refused("generic", &generic, &[], &["all the way round", "limits_deg"]);
}

#[test]
fn a_statistic_in_a_scene_without_probes_is_refused_with_the_remedy() {
    let statistic = scene(REST, "[[statistic]]\nwaves = \"g\"\n");
    assert_refused("no-probe", &statistic, &[], &["no probe is called \"g\"", "the scene has no probe", "[[probe]]"]);
}
