//! Pre-flight: what is told before the first step is what the books and the run itself say; each finding comes with
//! its fault and goes with what it says mends it.

use std::{f64::consts::PI, path::Path};

use pontoon::{
    model::Dimension,
    preflight::{self, BodySummary, Preflight, Severity},
    run::{self, Progress, RunOptions},
    scene::{BuiltScene, Scene, bundled_scenes},
    simulation::Simulation,
    solid::Dim,
};

/// A scene with which nothing is wrong: a box afloat, a paddle, a sill.
const GOOD: &str = r#"title     = "A box afloat"
dimension = 2
dp        = 0.01
until     = 2.0

[[water]]
fill = { box = { min = [0.1, 0.0], max = [2.0, 0.4] } }

[[solid]]
name  = "tank"
fixed = true
shape = { tank = { size = [2.0, 0.8] } }

[[solid]]
name  = "sill"
fixed = true
shape = { box = { size = [0.1, 0.2] } }
at    = { x = 1.6, bottom = 0.0 }

[[solid]]
name   = "paddle"
shape  = { box = { size = [0.1, 0.6] } }
at     = { x = 0.05, bottom = 0.0 }
driven = { along = [1.0, 0.0], distance = { formula = "0.04*(1-cos(2*pi*t))" } }

[[solid]]
name  = "box"
shape = { box = { size = [0.2, 0.1] } }
at    = { x = 1.0, draft = "equilibrium" }
free  = { density = 500.0 }

[[probe]]
name     = "deep"
pressure = [1.3, 0.1]

[[probe]]
name      = "gauge"
elevation = { x = 1.6 }

[frames]
every = 0.01
"#;

fn look<const D: usize>(scene: &Scene) -> Preflight
where
    Dim<D>: Dimension<D>,
{
    let BuiltScene { setup, plan, removed_by_solids, still_water, .. } = scene.build::<D>().unwrap();
    let sim = Simulation::new(setup).unwrap();
    preflight::preflight(&sim, &plan, still_water, removed_by_solids, &[1, 2])
}

fn with(sets: &[(&str, &str)]) -> Preflight {
    let sets: Vec<(String, String)> = sets.iter().map(|(k, v)| (k.to_string(), v.to_string())).collect();
    look::<2>(&Scene::parse(GOOD, Path::new(""), &sets).unwrap())
}

fn topics(of: &Preflight) -> Vec<&'static str> {
    of.findings.iter().map(|f| f.topic).collect()
}

/// The body afloat of a tank of one cubic metre of water 0.5 m deep that holds this solid only.
fn afloat(solid: &str) -> BodySummary {
    let text = format!(
        "dimension = 3\ndp = 0.05\nuntil = 1.0\nframes = \"off\"\n\
         [[water]]\nfill = {{ box = {{ min = [0.0, 0.0, 0.0], max = [1.4, 1.4, 0.5] }} }}\n\
         [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = [1.4, 1.4, 0.8] }} }}\n\
         [[solid]]\nname = \"float\"\n{solid}\n"
    );
    look::<3>(&Scene::parse(&text, Path::new(""), &[]).unwrap()).bodies.remove(0)
}

#[track_caller]
fn near(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance * b.abs(), "{a} is not {b}");
}

#[test]
fn a_box_floats_as_the_books_say() {
    let box_ = with(&[]).bodies.remove(0);
    // Breadth 0.2 m, height 0.1 m, half of the water's density: 10 kg/m, draft 0.05 m.
    let (breadth, draft, mass, g) = (0.2, 0.05, 10.0, 9.81);
    let rest = box_.afloat.unwrap();
    near(box_.mass_kg, mass, 1e-12);
    near(box_.displaced_kg, mass, 1e-9);
    near(rest.draft_m, draft, 1e-9);
    near(rest.waterplane_m2, breadth, 1e-6);
    // The metacentre's difference over ±1e-4 rad: 1e-7 of round-off and truncation.
    let gm = breadth * breadth / (12.0 * draft) + 0.5 * draft - 0.05;
    near(rest.tilts[0].gm_m, gm, 1e-5);
    near(rest.heave_s, 2.0 * PI * (draft / g).sqrt(), 1e-6);
    near(rest.heave_added_kg, 1000.0 * PI * breadth * breadth / 8.0, 1e-5);
    near(rest.heave_with_added_s, 2.0 * PI * ((mass + 5.0 * PI) / (1000.0 * g * breadth)).sqrt(), 1e-6);
    let inertia = mass * (breadth * breadth + 0.1 * 0.1) / 12.0;
    near(rest.tilts[0].period_s.unwrap(), 2.0 * PI * (inertia / (mass * g * gm)).sqrt(), 1e-5);
    assert!(rest.heel_deg.unwrap() < 1e-6);
    // ½ C ρ₀ h over the wetted 0.2 m + 2·0.05 m; what is wet is counted in boundary particles, of 52 one.
    near(box_.over_limit * 0.5 * 0.4 * 1000.0 * 0.017 * 0.3, mass, 0.04);
    near(box_.thinnest_m, 0.1, 0.005);
}

#[test]
fn a_box_turned_about_the_vertical_rolls_and_pitches_about_its_own_axes() {
    // 0.6 m × 0.3 m × 0.2 m, half sunk: GM = b²/(12 T) + KB − KG along and across.
    let body = "shape = { box = { size = [0.6, 0.3, 0.2] } }\nfree = { density = 500.0 }";
    let at = "at = { x = 0.7, y = 0.7, draft = \"equilibrium\", turn_deg = [0.0, 0.0, 30.0] }";
    let rest = afloat(&format!("{body}\n{at}")).afloat.unwrap();
    let gm = |breadth: f64| breadth * breadth / 1.2 - 0.05;
    near(rest.tilts[0].gm_m, gm(0.3), 1e-4);
    near(rest.tilts[1].gm_m, gm(0.6), 1e-4);
    // The roll is about the long axis, 30° off x, whichever way round.
    near(rest.tilts[0].axis[0].abs(), (PI / 6.0).cos(), 1e-3);
    let period = |breadth: f64| 2.0 * PI * ((breadth * breadth + 0.04) / 12.0 / (9.81 * gm(breadth))).sqrt();
    near(rest.tilts[0].period_s.unwrap(), period(0.3), 1e-3);
    near(rest.tilts[1].period_s.unwrap(), period(0.6), 1e-3);
    near(rest.heave_s, 2.0 * PI * (0.1_f64 / 9.81).sqrt(), 1e-6);
    // A locked tilt is none, and a ball has neither.
    let locked = body.replace("500.0", "500.0, locked = [\"turn_x\"]");
    assert_eq!(afloat(&format!("{locked}\n{}", at.replace("30.0", "0.0"))).afloat.unwrap().tilts.len(), 1);
    let ball = "shape = { ball = { radius = 0.2 } }\nat = { x = 0.7, y = 0.7, draft = \"equilibrium\" }";
    let ball = afloat(&format!("{ball}\nfree = {{ density = 500.0 }}")).afloat.unwrap();
    assert!(ball.tilts.iter().all(|t| t.gm_m == 0.0 && t.period_s.is_none()));
    // Half of the disc's 8/3 ρ a³; the waterplane is the difference over 1e-4 of the height.
    near(ball.heave_added_kg, 4.0 / 3.0 * 1000.0 * 0.2_f64.powi(3), 1e-4);
}

#[test]
fn nothing_is_said_of_a_sound_scene() {
    assert_eq!(topics(&with(&[])), Vec::<&str>::new(), "{:#?}", with(&[]).findings);
}

/// A finding, the settings that plant its fault, words of what mends it, and the settings that those words say.
type Fault =
    (&'static str, &'static [(&'static str, &'static str)], &'static str, &'static [(&'static str, &'static str)]);

const FAULTS: [Fault; 27] = [
    ("slow_sound", &[("model.c0_factor", "5")], "c0 = 20 ", &[("model.c0", "20")]),
    // A plate of a single row of boundary particles pushes water as a thick one does: 0.4 m × 2π/s.
    (
        "slow_sound",
        &[
            ("solid.paddle.shape.box.size", "[0.01, 0.6]"),
            ("solid.paddle.driven.distance.formula", "0.4*(1-cos(2*pi*t))"),
        ],
        "c0 = 26 ",
        &[("solid.paddle.shape.box.size", "[0.01, 0.6]")],
    ),
    // The square half sunk: GM = 0.2²/(12·0.1) + 0.05 − 0.1 = −1/60 m.
    (
        "capsizes",
        &[("solid.box.shape.box.size", "[0.2, 0.2]")],
        "by 0.017 m",
        &[("solid.box.shape.box.size", "[0.2, 0.2]"), ("solid.box.free.centre_offset", "[0.0, -0.017]")],
    ),
    ("lists", &[("solid.box.free.centre_offset", "[0.005, 0.0]")], "angle_deg", &[]),
    ("off_draft", &[("solid.box.at", "{ x = 1.0, bottom = 0.5 }")], "draft = \"equilibrium\"", &[]),
    ("beside_water", &[("solid.box.at", "{ x = 2.5, bottom = 0.3 }")], "over the water", &[]),
    (
        "larger_than_water",
        &[("solid.box.shape.box.size", "[2.4, 0.1]"), ("solid.box.at", "{ x = 1.0, bottom = 0.85 }")],
        "longer by 0.5",
        &[],
    ),
    ("large_inertia", &[("solid.box.free.inertia", "100.0")], "leave inertia out", &[]),
    (
        "far_tie",
        &[("joint", "[{ name = \"arm\", kind = \"hinge\", between = [\"box\"], at = [1.0, 5.0] }]")],
        "0.224 m large",
        &[("joint", "[{ name = \"arm\", kind = \"hinge\", between = [\"box\"], at = [1.0, 0.5] }]")],
    ),
    ("light_body", &[("solid.box.free.density", "20.0")], "density = 37", &[("solid.box.free.density", "37.0")]),
    (
        "thin_body",
        &[("solid.box.shape.box.size", "[0.2, 0.03]")],
        "0.034 m",
        &[("solid.box.shape.box.size", "[0.2, 0.034]")],
    ),
    (
        "thin_body",
        &[("solid.box.shape.box.size", "[0.2, 0.01]")],
        "0.034 m",
        &[("solid.box.shape.box.size", "[0.2, 0.034]")],
    ),
    (
        "slender_body",
        &[("solid.box.shape.box.size", "[0.2, 0.05]")],
        "dp = 0.0073",
        &[("solid.box.shape.box.size", "[0.2, 0.05]"), ("dp", "0.0073")],
    ),
    (
        "thin_wall",
        &[("solid.sill.shape.box.size", "[0.02, 0.2]")],
        "0.034 m",
        &[("solid.sill.shape.box.size", "[0.034, 0.2]")],
    ),
    (
        "thin_wall",
        &[("solid.sill.shape.box.size", "[0.01, 0.2]")],
        "0.034 m",
        &[("solid.sill.shape.box.size", "[0.034, 0.2]")],
    ),
    (
        "narrow_gap",
        &[("solid.box.at.x", "1.6"), ("solid.sill.shape.box.size", "[0.1, 0.33]")],
        "0.014 m further",
        &[("solid.box.at.x", "1.6"), ("solid.sill.shape.box.size", "[0.1, 0.315]")],
    ),
    // Two that stand: the sill over the bed.
    ("narrow_gap", &[("solid.sill.at.bottom", "0.02")], "0.014 m further", &[("solid.sill.at.bottom", "0.034")]),
    // The body beside the wall of the tank.
    ("narrow_gap", &[("solid.box.at.x", "1.88")], "0.014 m further", &[("solid.box.at.x", "1.865")]),
    (
        "probe_inside_solid",
        &[("probe.deep.pressure", "[1.57, 0.1]")],
        "[1.54",
        &[("probe.deep.pressure", "[1.54, 0.1]")],
    ),
    ("probe_inside_solid", &[("solid.sill.shape.box.size", "[0.1, 1.3]")], "nearest water", &[]),
    // A section may begin in a solid, but has to come out of it.
    (
        "probe_inside_solid",
        &[("probe", "[{ flow = { from = [1.57, 0.0], to = [1.57, 0.15] } }]")],
        "[1.54",
        &[("probe", "[{ flow = { from = [1.57, 0.0], to = [1.57, 0.3] } }]")],
    ),
    ("probe_outside", &[("probe.deep.pressure", "[2.5, 0.1]")], "[1.99", &[("probe.deep.pressure", "[1.99, 0.1]")]),
    ("probe_outside", &[("probe.gauge.elevation.x", "-1.0")], "nearest water", &[]),
    ("probe_above", &[("probe.deep.pressure", "[1.3, 2.5]")], "nearest water", &[]),
    ("shallow", &[("dp", "0.05")], "dp = 0.04", &[("dp", "0.04")]),
    (
        "low_waves",
        &[("solid.paddle.driven.distance.formula", "0.004*(1-cos(2*pi*t))")],
        "dp = 0.0",
        &[("solid.paddle.driven.distance.formula", "0.02*(1-cos(2*pi*t))")],
    ),
    ("large_frames", &[("until", "20.0"), ("frames.every", "0.0001")], "frames.every = 0.00", &[("until", "20.0")]),
];

#[test]
fn each_finding_comes_with_its_fault_and_goes_with_what_mends_it() {
    for (topic, fault, words, mended) in FAULTS {
        let found = with(fault);
        let finding = found.findings.iter().find(|f| f.topic == topic);
        let finding = finding.unwrap_or_else(|| panic!("{topic} is not among {:#?}", found.findings));
        assert!(finding.mend.contains(words), "{topic}: {:?} does not say {words:?}", finding.mend);
        assert!(!topics(&with(mended)).contains(&topic), "{topic} stays after {mended:?}");
    }
}

#[test]
fn water_that_solids_take_is_told() {
    let wide = [("solid.sill.shape.box.size", "[1.1, 0.5]"), ("solid.sill.at.x", "1.45"), ("solid.box.at.x", "0.5")];
    let found = with(&wide);
    let finding = found.findings.iter().find(|f| f.topic == "water_removed").unwrap();
    // 1.1 m of 1.9 m, and half of the box.
    assert!(finding.severity == Severity::Warning && finding.what.contains("59.2 %"), "{finding:?}");
}

#[test]
fn what_comes_first_is_a_warning_and_a_run_is_told_nothing_else() {
    let found = with(&[("model.c0_factor", "5"), ("solid.box.at", "{ x = 1.0, bottom = 0.5 }")]);
    assert!(found.findings.is_sorted_by_key(|f| f.severity), "{:?}", found.findings);
    let warnings = found.warnings();
    assert!(!warnings.is_empty() && warnings.len() < found.findings.len(), "{warnings:?}");
}

#[test]
fn a_crowd_is_told_of_by_its_first_three_and_a_number() {
    let mut found = with(&[("model.c0_factor", "5")]);
    let finding = found.findings[0].clone();
    for (count, told) in [(3, 3), (4, 4), (5, 4), (1000, 4)] {
        found.findings = vec![finding.clone(); count];
        let brief = found.brief();
        assert_eq!(brief.len(), told, "{count} findings");
        assert!(count <= 4 || brief[3].what == format!("{} more of this kind ({})", count - 3, finding.topic));
    }
    assert_eq!(found.warnings().len(), if finding.severity == Severity::Warning { 4 } else { 0 });
    // Each kind is counted by itself, wherever its findings stand.
    let note = preflight::Finding { severity: Severity::Note, ..finding.clone() };
    found.findings = [finding, note].into_iter().cycle().take(12).collect();
    let brief = found.brief();
    let more: Vec<&str> = brief.iter().filter(|f| f.what.contains(" more of ")).map(|f| &f.what[..6]).collect();
    assert_eq!((brief.len(), more), (8, vec!["3 more"; 2]));
}

#[test]
fn solids_in_touch_have_no_gap_and_a_gate_that_is_lifted_pushes_no_water() {
    // The box stands on the sill.
    let stands = [("solid.sill.shape.box.size", "[0.1, 0.45]"), ("solid.box.at", "{ x = 1.6, bottom = 0.45 }")];
    assert!(!topics(&with(&stands)).iter().any(|t| ["narrow_gap", "off_draft"].contains(t)));
    let lifted = [("solid.paddle.driven.along", "[0.0, 1.0]"), ("solid.paddle.driven.distance.formula", "4.0*t")];
    let found = with(&lifted);
    assert!(!topics(&found).contains(&"slow_sound") && found.waves.is_empty(), "{:?}", found.sound);
    // To the side it would.
    let pushed = with(&lifted[1..]);
    assert!(topics(&pushed).contains(&"slow_sound"), "{:?}", pushed.sound);
}

#[test]
fn the_shipped_scenes_give_no_false_alarm() {
    // Waves of two dp: as coarse as its README says.
    const KNOWN: [(&str, &str); 1] = [("ren-box", "low_waves")];
    for (name, ..) in bundled_scenes() {
        let scene = Scene::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name), &[]).unwrap();
        let found = if scene.dimension == 2 { look::<2>(&scene) } else { look::<3>(&scene) };
        let warnings = found.findings.iter().filter(|f| f.severity == Severity::Warning);
        let told: Vec<(&str, &str)> = warnings.map(|f| (*name, f.topic)).collect();
        let known: Vec<(&str, &str)> = KNOWN.into_iter().filter(|(scene, _)| scene == name).collect();
        assert_eq!(told, known, "{:#?}", found.findings);
    }
}

#[test]
fn a_run_writes_as_much_as_was_told() {
    let out = std::env::temp_dir().join(format!("pontoon-preflight-{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&out);
    let sets = [("until", "0.05"), ("frames.every", "0.01"), ("checkpoint.every", "0.04")];
    let sets: Vec<(String, String)> = sets.iter().map(|(k, v)| (k.to_string(), v.to_string())).collect();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/raft");
    let report = run::inspect(&scene, &run::InspectOptions { overrides: sets.clone(), ..Default::default() }).unwrap();
    assert_eq!(report.timing, None, "nothing is timed unless asked for");
    let options = RunOptions { out: Some(out.clone()), overrides: sets, threads: None };
    run::run(&scene, &options, &mut |_: &Progress| true).unwrap();
    let bytes = |folder: &str| -> f64 {
        let entries = std::fs::read_dir(out.join(folder)).unwrap().flatten();
        entries.map(|e| e.metadata().unwrap().len() as f64).sum()
    };
    let told = &report.preflight.size.disk;
    // Rows are as long as their numbers happen to be.
    near(told.tables_bytes, bytes("series"), 0.2);
    // Frames and checkpoints are packed; how well hangs on the flow, and here water still rests.
    let frames = bytes("frames") / told.frames_bytes;
    assert!((0.3..1.0).contains(&frames), "{frames} of what was told");
    let packed = std::fs::metadata(out.join("checkpoint.bin")).unwrap().len() as f64 / told.checkpoint_bytes;
    assert!((0.6..1.0).contains(&packed), "{packed} of what was told");
    std::fs::remove_dir_all(&out).unwrap();
}

#[test]
fn a_spring_that_slows_the_run_is_told_with_how_soft_it_may_be() {
    let moored = |stiffness: f64| {
        let spring = "[[spring]]\nname = \"line\"\nbetween = [\"box\"]\nfrom = [1.0, 0.35]\nto = [1.0, 0.0]";
        let text = format!("{GOOD}\n{spring}\nstiffness = {stiffness:?}\n");
        look::<2>(&Scene::parse(&text, Path::new(""), &[]).unwrap())
    };
    let stiff = moored(1e9);
    let finding = stiff.findings.iter().find(|f| f.topic == "stiff_spring").expect("1e9 N/m on 10 kg is stiff");
    assert_eq!(stiff.step.bound_by, "springs");
    let part: f64 = finding.mend.split(' ').next().unwrap().parse().unwrap();
    let soft = moored(1e9 * part);
    assert!(!topics(&soft).contains(&"stiff_spring") && soft.step.springs_s.unwrap() >= soft.step.sound_s);
    assert_eq!(with(&[]).step.springs_s, None);
}

#[test]
fn a_paddle_in_a_list_of_motions_is_a_paddle() {
    let alone = with(&[]);
    let half = "{ along = [1.0, 0.0], distance = { formula = \"0.02*(1-cos(2*pi*t))\" } }";
    let whole = "{ along = [1.0, 0.0], distance = { formula = \"0.04*(1-cos(2*pi*t))\" } }";
    let text = GOOD.replace(whole, &format!("{{ motions = [{half}, {half}] }}"));
    assert_ne!(text, GOOD);
    let listed = look::<2>(&Scene::parse(&text, Path::new(""), &[]).unwrap());
    assert_eq!(topics(&listed), topics(&alone));
    let [one, other] = [&alone, &listed].map(|found| found.waves.first().expect("it makes waves"));
    // The same way but for round-off.
    for (a, b) in [(one.stroke_m, other.stroke_m), (one.height_m, other.height_m), (one.paddle_mps, other.paddle_mps)] {
        assert!((a / b - 1.0).abs() < 1e-9, "{one:?} {other:?}");
    }
    assert_eq!((one.period_s, &one.answers), (other.period_s, &other.answers));
    assert_eq!(alone.sound.expected.len(), listed.sound.expected.len());
}
