//! Preflight: its values agree with theory and with the run. Each finding appears with its fault and disappears after the
//! correction that it proposes.

use std::{
    f64::consts::{PI, TAU},
    path::Path,
};

use pontoon::{
    preflight::{BodySummary, Finding, Preflight, Severity},
    run::{self, Inspection, Progress, RunOptions},
    scene::{Scene, bundled_scenes},
};

use crate::common::{TestFolder, preflight_report};

/// A valid scene: a floating box, a paddle and a sill.
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

fn report(sets: &[(&str, &str)]) -> Preflight {
    let sets: Vec<(String, String)> = sets.iter().map(|(k, v)| (k.to_string(), v.to_string())).collect();
    preflight_report(&Scene::parse(GOOD, Path::new(""), &sets).unwrap())
}

fn topics(of: &Preflight) -> Vec<&'static str> {
    of.findings.iter().map(|f| f.topic).collect()
}

/// The report of the body `solid` in a tank of water of 1.4 m × 1.4 m × 0.5 m.
fn body_summary(solid: &str) -> BodySummary {
    let text = format!(
        "dimension = 3\ndp = 0.05\nuntil = 1.0\nframes = \"off\"\n\
         [[water]]\nfill = {{ box = {{ min = [0.0, 0.0, 0.0], max = [1.4, 1.4, 0.5] }} }}\n\
         [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = [1.4, 1.4, 0.8] }} }}\n\
         [[solid]]\nname = \"float\"\n{solid}\n"
    );
    preflight_report(&Scene::parse(&text, Path::new(""), &[]).unwrap()).bodies.remove(0)
}

#[track_caller]
fn assert_close(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance * b.abs(), "{a} is not {b}");
}

#[test]
fn the_draft_periods_and_stability_of_a_box_agree_with_theory() {
    let box_ = report(&[]).bodies.remove(0);
    // Breadth 0.2 m, height 0.1 m, half of the water's density: 10 kg/m, draft 0.05 m.
    let (breadth, draft, mass, g) = (0.2, 0.05, 10.0, 9.81);
    let rest = box_.afloat.unwrap();
    assert_close(box_.mass_kg, mass, 1e-12);
    assert_close(box_.displaced_kg, mass, 1e-9);
    assert_close(rest.draft_m, draft, 1e-9);
    assert_close(rest.waterplane_m2, breadth, 1e-6);
    // The metacentric height is a difference over ±1e-4 rad, with 1e-7 of round-off and truncation.
    let gm = breadth * breadth / (12.0 * draft) + 0.5 * draft - 0.05;
    assert_close(rest.tilts[0].gm_m, gm, 1e-5);
    assert_close(rest.heave_s, 2.0 * PI * (draft / g).sqrt(), 1e-6);
    assert_close(rest.heave_added_kg, 1000.0 * PI * breadth * breadth / 8.0, 1e-5);
    assert_close(rest.heave_with_added_s, 2.0 * PI * ((mass + 5.0 * PI) / (1000.0 * g * breadth)).sqrt(), 1e-6);
    let inertia = mass * (breadth * breadth + 0.1 * 0.1) / 12.0;
    assert_close(rest.tilts[0].period_s.unwrap(), 2.0 * PI * (inertia / (mass * g * gm)).sqrt(), 1e-5);
    assert!(rest.heel_deg.unwrap() < 1e-6);
    // ½ C ρ₀ h over the wetted length of 0.2 m + 2·0.05 m. Boundary particles resolve it to one of 52.
    assert_close(box_.over_limit * 0.5 * 0.4 * 1000.0 * 0.017 * 0.3, mass, 0.04);
    assert_close(box_.thinnest_m, 0.1, 0.005);
}

#[test]
fn a_box_at_a_yaw_angle_rolls_and_pitches_about_its_own_axes() {
    // 0.6 m × 0.3 m × 0.2 m, half submerged: GM = b²/(12 T) + KB − KG for roll and pitch.
    let body = "shape = { box = { size = [0.6, 0.3, 0.2] } }\nfree = { density = 500.0 }";
    let at = "at = { x = 0.7, y = 0.7, draft = \"equilibrium\", turn_deg = [0.0, 0.0, 30.0] }";
    let rest = body_summary(&format!("{body}\n{at}")).afloat.unwrap();
    let gm = |breadth: f64| breadth * breadth / 1.2 - 0.05;
    assert_close(rest.tilts[0].gm_m, gm(0.3), 1e-4);
    assert_close(rest.tilts[1].gm_m, gm(0.6), 1e-4);
    // The roll axis is the long axis at 30° from x, with either sign.
    assert_close(rest.tilts[0].axis[0].abs(), (PI / 6.0).cos(), 1e-3);
    let period = |breadth: f64| 2.0 * PI * ((breadth * breadth + 0.04) / 12.0 / (9.81 * gm(breadth))).sqrt();
    assert_close(rest.tilts[0].period_s.unwrap(), period(0.3), 1e-3);
    assert_close(rest.tilts[1].period_s.unwrap(), period(0.6), 1e-3);
    assert_close(rest.heave_s, 2.0 * PI * (0.1_f64 / 9.81).sqrt(), 1e-6);
    // A locked rotation is left out, and a ball has no restoring moment.
    let locked = body.replace("500.0", "500.0, locked = [\"turn_x\"]");
    assert_eq!(body_summary(&format!("{locked}\n{}", at.replace("30.0", "0.0"))).afloat.unwrap().tilts.len(), 1);
    let ball = "shape = { ball = { radius = 0.2 } }\nat = { x = 0.7, y = 0.7, draft = \"equilibrium\" }";
    let ball = body_summary(&format!("{ball}\nfree = {{ density = 500.0 }}")).afloat.unwrap();
    assert!(ball.tilts.iter().all(|t| t.gm_m == 0.0 && t.period_s.is_none()));
    // Half of the 8/3 ρ a³ of a disc. The waterplane is a difference over 1e-4 of the height.
    assert_close(ball.heave_added_kg, 4.0 / 3.0 * 1000.0 * 0.2_f64.powi(3), 1e-4);
}

#[test]
fn a_valid_scene_has_no_findings() {
    assert_eq!(topics(&report(&[])), Vec::<&str>::new(), "{:#?}", report(&[]).findings);
}

#[test]
fn a_body_in_too_viscous_water_is_found_with_the_alpha_that_helps() {
    let found = report(&[("model.viscosity.artificial.alpha", "1.0")]);
    let warning = found.findings.iter().find(|f| f.topic == "viscous_body").expect("a finding");
    let alpha = warning.mend.split("alpha = ").nth(1).and_then(|rest| rest.split(' ').next()).expect("a value");
    let mended = report(&[("model.viscosity.artificial.alpha", alpha)]);
    // The value is that of one body; a body of a lower Reynolds number may keep its warning.
    let count = |p: &pontoon::preflight::Preflight| p.findings.iter().filter(|f| f.topic == "viscous_body").count();
    assert!(count(&mended) < count(&found), "{:#?}", mended.flows);
    for flow in &found.flows {
        let reynolds = flow.reynolds.expect("the water is viscous");
        assert!((reynolds * flow.viscosity_m2ps / (flow.speed_mps * flow.size_m) - 1.0).abs() < 1e-12);
    }
}

/// A finding, the settings that cause it, a part of its proposed correction, and the settings of that correction.
type Fault =
    (&'static str, &'static [(&'static str, &'static str)], &'static str, &'static [(&'static str, &'static str)]);

const FAULTS: [Fault; 33] = [
    ("slow_sound", &[("model.c0_factor", "5")], "c0 = 20 ", &[("model.c0", "20")]),
    // A plate with a single row of boundary particles moves water like a thick one: 0.4 m × 2π/s.
    (
        "slow_sound",
        &[
            ("solid.paddle.shape.box.size", "[0.01, 0.6]"),
            ("solid.paddle.driven.distance.formula", "0.4*(1-cos(2*pi*t))"),
        ],
        "c0 = 26 ",
        &[("solid.paddle.shape.box.size", "[0.01, 0.6]")],
    ),
    // A square, half submerged: GM = 0.2²/(12·0.1) + 0.05 − 0.1 = −1/60 m.
    (
        "capsizes",
        &[("solid.box.shape.box.size", "[0.2, 0.2]")],
        "by 0.017 m",
        &[("solid.box.shape.box.size", "[0.2, 0.2]"), ("solid.box.free.centre_offset", "[0.0, -0.017]")],
    ),
    (
        "lists",
        &[
            ("solid.box.free.centre_offset", "[0.005, 0.0]"),
            ("solid.box.at", "{ x = 1.0, draft = \"equilibrium\", angle_deg = 0.0 }"),
        ],
        "angle_deg",
        &[("solid.box.free.centre_offset", "[0.005, 0.0]")],
    ),
    ("turned_to_rest", &[("solid.box.free.centre_offset", "[0.005, 0.0]")], "angle_deg = 0.0", &[]),
    // It can displace 20 kg/m, and has 10 kg/m of its own.
    (
        "ballast_sinks",
        &[("solid.box.free.ballast", "[{ at = [0.0, 0.0], mass = \"6*t\" }]")],
        "less ballast",
        &[("solid.box.free.ballast", "[{ at = [0.0, 0.0], mass = \"4*t\" }]")],
    ),
    ("off_draft", &[("solid.box.at", "{ x = 1.0, bottom = 0.5 }")], "draft = \"equilibrium\"", &[]),
    ("beside_water", &[("solid.box.at", "{ x = 2.5, bottom = 0.3 }")], "over the water", &[]),
    ("beside_water", &[("solid.box.at", "{ x = 1.0, draft = 3.0 }")], "raise it", &[]),
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
        "thin_part",
        &[("solid.box.shape.box.size", "[0.2, 0.004]")],
        "make it dp thick",
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
    // Two fixed solids: the sill above the bed.
    ("narrow_gap", &[("solid.sill.at.bottom", "0.02")], "0.014 m further", &[("solid.sill.at.bottom", "0.034")]),
    // A free body beside the wall of the tank.
    ("narrow_gap", &[("solid.box.at.x", "1.88")], "0.014 m further", &[("solid.box.at.x", "1.865")]),
    (
        "probe_inside_solid",
        &[("probe.deep.pressure", "[1.57, 0.1]")],
        "[1.54",
        &[("probe.deep.pressure", "[1.54, 0.1]")],
    ),
    ("probe_inside_solid", &[("solid.sill.shape.box.size", "[0.1, 1.3]")], "nearest water", &[]),
    // A section may begin inside a solid but must leave it.
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
    ("event_after_end", &[("solid.sill.until", "3.0")], "run longer", &[("solid.sill.until", "1.0")]),
    (
        "empty_frames",
        &[("frames.box", "{ min = [5.0, 0.0], max = [6.0, 1.0] }")],
        "the water is from",
        &[("frames.box", "{ min = [1.0, 0.0], max = [2.0, 1.0] }")],
    ),
    ("large_frames", &[("until", "20.0"), ("frames.every", "0.0001")], "frames.every = 0.00", &[("until", "20.0")]),
];

#[test]
fn each_finding_appears_with_its_fault_and_disappears_after_its_correction() {
    for (topic, fault, correction, corrected) in FAULTS {
        let found = report(fault);
        let finding = found.findings.iter().find(|f| f.topic == topic);
        let finding = finding.unwrap_or_else(|| panic!("{topic} is not among {:#?}", found.findings));
        assert!(finding.mend.contains(correction), "{topic}: {:?} does not contain {correction:?}", finding.mend);
        assert!(!topics(&report(corrected)).contains(&topic), "{topic} remains after {corrected:?}");
    }
}

#[test]
fn walls_that_differ_at_periodic_sides_are_a_warning() {
    let found = |points: &str| {
        let text = format!(
            "dimension = 2\ndp = 0.02\nuntil = 1.0\nperiodic = {{ x = [0.0, 1.0] }}\n\
             [[water]]\nfill = {{ box = {{ min = [0.0, 0.0], max = [1.0, 0.3] }} }}\n\
             [[solid]]\nname = \"bed\"\nfixed = true\nshape = {{ polygon = {{ points = [{points}] }} }}\n"
        );
        preflight_report(&Scene::parse(&text, Path::new(""), &[]).unwrap())
    };
    let slope = found("[-0.3, -0.2], [1.3, -0.2], [1.3, 0.13], [-0.3, -0.03]");
    let finding = slope.findings.iter().find(|f| f.topic == "unequal_sides").expect("a bed 0.1 m higher at 1 m");
    assert!(finding.severity == Severity::Warning && finding.what.contains("x = 0 and 1 m"), "{finding:?}");
    for points in [
        "[-0.3, -0.2], [1.3, -0.2], [1.3, 0.0], [-0.3, 0.0]",
        "[-0.5, -0.2], [1.5, -0.2], [1.5, 0.1], [1.0, 0.0], [0.5, 0.1], [0.0, 0.0], [-0.5, 0.1]",
    ] {
        let even = found(points);
        assert!(!topics(&even).contains(&"unequal_sides"), "{points}: {:?}", even.findings);
    }
}

#[test]
fn faces_whose_discharges_do_not_cancel_are_a_warning() {
    let found = |inflow: &str, outflow: &str| {
        let text = format!(
            "dimension = 2\ndp = 0.05\nuntil = 1.0\ninflow = [{{ x = 0.0, {inflow} }}]\noutflow = [{{ x = 2.0, {outflow} }}]\n\
             [[water]]\nfill = {{ box = {{ min = [0.0, 0.0], max = [2.0, 0.5] }} }}\nvelocity = [0.6, 0.0]\n\
             [[solid]]\nname = \"bed\"\nfixed = true\nshape = {{ box = {{ size = [6.0, 0.3] }} }}\nat = {{ x = 1.0, y = -0.15 }}\n"
        );
        let report = preflight_report(&Scene::parse(&text, Path::new(""), &[]).unwrap());
        report.findings.into_iter().find(|f| f.topic == "unequal_discharges")
    };
    let less = found("velocity = 0.6", "velocity = 0.4").expect("0.1 m²/s stay");
    assert_eq!(less.severity, Severity::Warning);
    assert_eq!(
        less.what,
        "0.3 m²/s of water are to enter through the faces, and 0.2 m²/s to leave; \"outflow\" absorbs, and its discharge gives way \
         to the level until they agree"
    );
    let factor = "give \"outflow\" 1.5 times its velocity, or a level without a velocity";
    assert_eq!(
        less.mend,
        format!("absorb = false  keeps the discharge of \"outflow\", and the level changes; or {factor}")
    );
    let exact = found("velocity = 0.6", "velocity = 0.4, absorb = false").expect("0.1 m²/s stay");
    assert_eq!(exact.what, "0.3 m²/s of water enter through the faces, and 0.2 m²/s leave");
    assert_eq!(exact.mend, factor);
    let reversed = found("velocity = -0.6", "velocity = 0.6").expect("water leaves at both faces");
    assert!(reversed.mend.contains("positive in the sense of the flow"), "{}", reversed.mend);
    for (inflow, outflow) in [
        ("velocity = 0.6", "velocity = 0.6"),
        ("velocity = \"2.4*y\"", "velocity = 0.6"),
        ("velocity = 0.6", "level = 0.5"),
        ("velocity = 0.6, factor = \"1+0.1*t\"", "velocity = 0.6"),
    ] {
        assert_eq!(found(inflow, outflow), None, "{inflow}; {outflow}");
    }
}

#[test]
fn water_removed_by_solids_is_a_warning() {
    let wide = [("solid.sill.shape.box.size", "[1.1, 0.5]"), ("solid.sill.at.x", "1.45"), ("solid.box.at.x", "0.5")];
    let found = report(&wide);
    let finding = found.findings.iter().find(|f| f.topic == "water_removed").unwrap();
    // 1.1 m of 1.9 m of water, and half of the box.
    assert!(finding.severity == Severity::Warning && finding.what.contains("59.2 %"), "{finding:?}");
}

#[test]
fn warnings_precede_notes_and_a_run_prints_warnings_only() {
    let found = report(&[("model.c0_factor", "5"), ("solid.box.at", "{ x = 1.0, bottom = 0.5 }")]);
    assert!(found.findings.is_sorted_by_key(|f| f.severity), "{:?}", found.findings);
    let warnings = found.warnings();
    assert!(!warnings.is_empty() && warnings.len() < found.findings.len(), "{warnings:?}");
}

#[test]
fn more_than_four_findings_of_a_kind_are_shortened_to_three_and_a_count() {
    let mut found = report(&[("model.c0_factor", "5")]);
    let finding = found.findings[0].clone();
    for (count, expected) in [(3, 3), (4, 4), (5, 4), (1000, 4)] {
        found.findings = vec![finding.clone(); count];
        let brief = found.brief();
        assert_eq!(brief.len(), expected, "{count} findings");
        assert!(count <= 4 || brief[3].what == format!("{} more of this kind ({})", count - 3, finding.topic));
    }
    assert_eq!(found.warnings().len(), if finding.severity == Severity::Warning { 4 } else { 0 });
    // Each kind has its own count, in any order of the findings.
    let note = Finding { severity: Severity::Note, ..finding.clone() };
    found.findings = [finding, note].into_iter().cycle().take(12).collect();
    let brief = found.brief();
    let more: Vec<&str> = brief.iter().filter(|f| f.what.contains(" more of ")).map(|f| &f.what[..6]).collect();
    assert_eq!((brief.len(), more), (8, vec!["3 more"; 2]));
}

#[test]
fn touching_solids_have_no_gap_finding_and_a_lifted_gate_needs_no_higher_sound_speed() {
    // The box rests on the sill.
    let resting = [("solid.sill.shape.box.size", "[0.1, 0.45]"), ("solid.box.at", "{ x = 1.6, bottom = 0.45 }")];
    assert!(!topics(&report(&resting)).iter().any(|t| ["narrow_gap", "off_draft"].contains(t)));
    let lifted = [("solid.paddle.driven.along", "[0.0, 1.0]"), ("solid.paddle.driven.distance.formula", "4.0*t")];
    let found = report(&lifted);
    assert!(!topics(&found).contains(&"slow_sound") && found.waves.is_empty(), "{:?}", found.sound);
    // Motion to the side needs it.
    let pushed = report(&lifted[1..]);
    assert!(topics(&pushed).contains(&"slow_sound"), "{:?}", pushed.sound);
}

/// A disc under 0.4 m of water, which `motion` moves, and the topics of the findings with their remedies.
fn disc_findings(motion: &str, model: &str) -> Vec<(&'static str, String)> {
    let text = format!(
        "dimension = 2\ndp = 0.02\nuntil = 2.0\nwater = [{{ fill = {{ box = {{ min = [0.0, 0.0], max = [1.6, 1.0] }} }} }}]\n\
         [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = [1.6, 1.3] }} }}\n\
         [[solid]]\nname = \"disc\"\nshape = {{ ball = {{ radius = 0.1 }} }}\nat = [0.8, 0.6]\n{motion}\n[model]\n{model}\n"
    );
    let found = preflight_report(&Scene::parse(&text, Path::new(""), &[]).unwrap()).findings;
    found.into_iter().map(|finding| (finding.topic, finding.mend)).collect()
}

/// The particles resist a disc of ten rows under 0.4 m of water with 4 N/m, 0.5 % of pressure times diameter (measured), at 0.026 m/s as at
/// 0.08 m/s, without viscosity too: more than its drag below 0.2 m/s. Viscosity is not what to change first.
#[test]
fn a_slow_body_under_water_is_found_with_the_laws_that_help() {
    let driven = |law: &str| format!("driven = {{ along = [1.0, 0.0], distance = {{ formula = \"{law}\" }} }}");
    let topics = |found: &[(&'static str, String)]| found.iter().map(|(topic, _)| *topic).collect::<Vec<_>>();
    for model in ["", "viscosity = \"none\"", "viscosity = { artificial = { alpha = 0.02 } }"] {
        let found = disc_findings(&driven("0.01*(1-cos(2.56*t))"), model);
        let slow = found.iter().find(|(topic, _)| *topic == "slow_body").expect("a finding");
        assert!(slow.1.contains("h_over_dp = 2.0  and  gradient = \"corrected\""), "{}", slow.1);
        assert!(!topics(&found).contains(&"viscous_body"), "{found:?}");
    }
    // With the laws that help, a speed of 0.1 m/s is not slow any more.
    let law = driven("0.04*(1-cos(2.56*t))");
    assert!(topics(&disc_findings(&law, "")).contains(&"slow_body"));
    let with_help = disc_findings(&law, "gradient = \"corrected\"\nh_over_dp = 2.0");
    assert!(!topics(&with_help).contains(&"slow_body"), "{with_help:?}");
    // A ball finds 0.8 % of pressure times size squared (measured).
    let ball = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/measurements/slow-ball.toml");
    let found = preflight_report(&Scene::read(&ball, &[]).unwrap()).findings;
    assert!(
        found.iter().any(|finding| finding.topic == "slow_body" && finding.what.contains(" N, 0.8 %")),
        "{found:?}"
    );
    let fast = disc_findings(&driven("0.1*(1-cos(5*t))"), "");
    assert!(!topics(&fast).contains(&"slow_body"), "{fast:?}");
    // A tether keeps a light disc from rising; without it, buoyancy makes it fast.
    let rope = "free = { density = 500.0 }\n[[rope]]\nname = \"tether\"\nbetween = [\"disc\"]\nfrom = [0.8, 0.6]\nto = [0.8, 0.1]";
    assert!(topics(&disc_findings(rope, "")).contains(&"slow_body"));
    assert!(!topics(&disc_findings("free = { density = 500.0 }", "")).contains(&"slow_body"));
}

/// A box on a smooth bed under water stands still under a force that moves it a dp above the bed.
#[test]
fn a_force_that_pushes_a_body_along_the_bed_under_water_is_found() {
    let found = |bottom: f64| {
        let text = format!(
            "dimension = 2\ndp = 0.02\nuntil = 2.0\nwater = [{{ fill = {{ box = {{ min = [0.0, 0.0], max = [3.0, 0.6] }} }} }}]\n\
             [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = [3.0, 1.0] }} }}\n\
             [[solid]]\nname = \"box\"\nshape = {{ box = {{ size = [0.2, 0.1] }} }}\nat = {{ x = 0.6, bottom = {bottom:?} }}\n\
             free = {{ density = 3000.0 }}\n[[force]]\nname = \"push\"\non = \"box\"\nforce = [20.0, 0.0]\n"
        );
        preflight_report(&Scene::parse(&text, Path::new(""), &[]).unwrap())
            .findings
            .iter()
            .any(|finding| finding.topic == "sliding_body")
    };
    assert!(found(0.0) && !found(0.1));
}

/// A body that hangs on a line above the water does not fall into it; on a slack rope or a soft spring, and without any line, it does.
#[test]
fn the_fall_of_a_body_ends_where_its_lines_hold_it() {
    let found = |line: &str| {
        let text = format!(
            "dimension = 2\ndp = 0.02\nuntil = 2.0\nwater = [{{ fill = {{ box = {{ min = [0.0, 0.0], max = [1.2, 0.4] }} }} }}]\n\
             [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = [1.2, 0.8] }} }}\n\
             [[solid]]\nname = \"box\"\nshape = {{ box = {{ size = [0.1, 0.1] }} }}\nat = [0.6, 1.2]\nfree = {{ density = 500.0 }}\n{line}\n"
        );
        preflight_report(&Scene::parse(&text, Path::new(""), &[]).unwrap())
            .findings
            .iter()
            .any(|finding| finding.topic == "slow_sound")
    };
    let ends = "name = \"line\"\nbetween = [\"box\"]\nfrom = [0.6, 1.2]\nto = [0.6, 2.0]";
    // 49 N/m: 2000 N/m give way by 0.05 m, 100 N/m by 0.98 m; the water is 0.75 m below.
    for (line, falls) in [
        (String::new(), true),
        (format!("[[spring]]\n{ends}\nstiffness = 2000.0"), false),
        (format!("[[spring]]\n{ends}\nstiffness = 100.0"), true),
        (format!("[[rope]]\n{ends}"), false),
        (format!("[[rope]]\n{ends}\nlength = 1.7"), true),
    ] {
        assert_eq!(found(&line), falls, "{line}");
    }
}

/// Before a body in the surface a current slower than √(g dp), 0.70 m/s at a spacing of 0.05 m, is noted; a faster one, a submerged body
/// and walls beside the channel are not.
#[test]
fn a_current_too_slow_for_its_surface_is_noted() {
    let noted = |speed: f64, height: f64, size: &str| {
        let text = format!(
            "dimension = 2\ndp = 0.05\nuntil = 1.0\n\
             inflow = [{{ x = 0.0, velocity = {speed} }}]\noutflow = [{{ x = 2.0, velocity = {speed} }}]\n\
             water = [{{ fill = {{ box = {{ min = [0.0, 0.0], max = [2.0, 0.5] }} }} }}]\n\
             [[solid]]\nname = \"bed\"\nfixed = true\nshape = {{ box = {{ size = [6.0, 0.3] }} }}\nat = {{ x = 1.0, y = -0.15 }}\n\
             [[solid]]\nname = \"pier\"\nfixed = true\nshape = {{ box = {{ size = {size} }} }}\nat = {{ x = 1.0, y = {height} }}\n"
        );
        let scene = Scene::parse(&text, Path::new(""), &[]).unwrap();
        topics(&preflight_report(&scene)).contains(&"slow_current")
    };
    let size = "[0.4, 0.2]";
    assert_eq!([noted(0.6, 0.5, size), noted(0.8, 0.5, size), noted(0.6, 0.2, size)], [true, false, false]);
    assert!(!noted(0.6, 0.5, "[6.0, 0.2]"));
    // The same for a current that is held, 0.5 m deep, and for water past a towed body.
    let driven = |driving: &str| {
        let text = format!(
            "dimension = 2\ndp = 0.05\nuntil = 1.0\nperiodic = {{ x = [0.0, 2.0] }}\n{driving}\n\
             water = [{{ fill = {{ box = {{ min = [0.0, 0.0], max = [2.0, 0.5] }} }} }}]\n\
             [[solid]]\nname = \"pier\"\nfixed = true\nshape = {{ box = {{ size = [0.4, 0.2] }} }}\nat = {{ x = 1.0, y = 0.5 }}\n\
             [[solid]]\nname = \"bed\"\nfixed = true\nshape = {{ box = {{ size = [4.0, 0.3] }} }}\nat = {{ x = 1.0, y = -0.15 }}\n"
        );
        let scene = Scene::parse(&text, Path::new(""), &[]).unwrap();
        topics(&preflight_report(&scene)).contains(&"slow_current")
    };
    let held = |discharge: f64| driven(&format!("current = {{ along = \"x\", discharge = {discharge} }}"));
    let towed = |speed: f64| driven(&format!("towed = {{ along = \"x\", velocity = {speed} }}"));
    assert_eq!([held(0.3), held(0.4), towed(0.6), towed(0.8)], [true, false, true, false]);
}

/// Waves that enter through a face: their length and speeds are those of linear waves on the current, with which and against which
/// ω = k U + √(g k tanh kd).
#[test]
fn waves_through_a_face_are_told_with_their_length_on_the_current() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/spec/water/open_boundaries/entering_waves.toml");
    for current in ["0.3", "-0.3"] {
        let water = format!("[{current}, 0.0]");
        let sets =
            [("inflow.0.velocity", current), ("outflow.0.velocity", current), ("water.0.velocity", water.as_str())];
        let sets = sets.map(|(key, value)| (key.to_string(), value.to_string()));
        let found = preflight_report(&Scene::read(&path, &sets).unwrap());
        let [wave] = &found.face_waves[..] else { panic!("{:?}", found.face_waves) };
        let u: f64 = current.parse().unwrap();
        let (k, omega) = (TAU / wave.length_m, TAU / wave.period_s);
        assert_close(k * u + (9.81 * k * (k * wave.depth_m).tanh()).sqrt(), omega, 1e-9);
        assert_close(wave.celerity_mps, omega / k, 1e-9);
        assert_close(wave.kd, k * wave.depth_m, 1e-12);
        assert_close(wave.length_dp, wave.length_m / 0.025, 1e-12);
        assert!(wave.current_mps == u && wave.orbital_mps < 0.3 && wave.group_mps < wave.celerity_mps);
        // Two dp high.
        assert!(topics(&found).contains(&"low_waves"), "{:?}", found.findings);
    }
}

#[test]
fn the_bundled_scenes_have_no_warnings_except_documented_ones() {
    // Waves of two dp, as the README of the scene states.
    const KNOWN: [(&str, &str); 1] = [("ren-box", "low_waves")];
    for (name, ..) in bundled_scenes() {
        let scene = Scene::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name), &[]).unwrap();
        let found = preflight_report(&scene);
        let warnings = found.findings.iter().filter(|f| f.severity == Severity::Warning);
        let found_topics: Vec<(&str, &str)> = warnings.map(|f| (*name, f.topic)).collect();
        let known: Vec<(&str, &str)> = KNOWN.into_iter().filter(|(scene, _)| scene == name).collect();
        assert_eq!(found_topics, known, "{:#?}", found.findings);
    }
}

#[test]
fn a_scene_of_more_than_four_million_particles_is_estimated_without_particles() {
    let home = TestFolder::new("large");
    let scene = home.join("scene.toml");
    std::fs::write(&scene, GOOD).unwrap();
    let inspected = |sets: &[(&str, &str)]| {
        let overrides = sets.iter().map(|(k, v)| (k.to_string(), v.to_string())).collect();
        run::inspect(&scene, &run::InspectOptions { overrides, ..Default::default() })
    };
    let Inspection::Estimate(size) = inspected(&[("dp", "0.0004")]).unwrap() else { panic!("particles were created") };
    // 1.9 m × 0.4 m of water.
    assert_close(size.fluid, 0.76 / 0.0004_f64.powi(2), 1e-9);
    assert_eq!((size.title.as_str(), size.dimension, size.until_s), ("A box afloat", 2, 2.0));
    let report = inspected(&[]).unwrap().report().expect("10,000 particles are created");
    assert_eq!(report.preflight.size.dimension, 2);
    // Whole steps.
    assert!((size.steps - 2.0 / size.dt_s).abs() < 1.0, "{size:?}");
    // What a run would refuse is refused without particles too.
    let refused = inspected(&[("dp", "0.0004"), ("domain.min", "[0.0, 0.0]"), ("domain.max", "[1.0, 1.0]")]);
    assert!(refused.unwrap_err().to_string().contains("not wholly inside the domain"));
}

#[test]
fn the_estimated_output_size_agrees_with_a_run() {
    let home = TestFolder::new("preflight");
    let out = home.join("run");
    let sets = [("until", "0.05"), ("frames.every", "0.01"), ("checkpoint.every", "0.04")];
    let sets: Vec<(String, String)> = sets.iter().map(|(k, v)| (k.to_string(), v.to_string())).collect();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/raft");
    let report = run::inspect(&scene, &run::InspectOptions { overrides: sets.clone(), ..Default::default() })
        .unwrap()
        .report()
        .unwrap();
    assert_eq!(report.timing, None, "timing is off by default");
    let options = RunOptions { out: Some(out.clone()), overrides: sets, threads: None };
    run::run(&scene, &options, &mut |_: &Progress| true).unwrap();
    let bytes = |folder: &str| -> f64 {
        let entries = std::fs::read_dir(out.join(folder)).unwrap().flatten();
        entries.map(|e| e.metadata().unwrap().len() as f64).sum()
    };
    let estimate = &report.preflight.size.disk;
    // The length of a row depends on its numbers.
    assert_close(estimate.tables_bytes, bytes("series"), 0.2);
    // Frames and checkpoints are compressed. The ratio depends on the flow, and here the water is still at rest.
    let frames = bytes("frames") / estimate.frames_bytes;
    assert!((0.3..1.0).contains(&frames), "{frames} of the estimate");
    let packed = std::fs::metadata(out.join("checkpoint.bin")).unwrap().len() as f64 / estimate.checkpoint_bytes;
    assert!((0.6..1.0).contains(&packed), "{packed} of the estimate");
}

#[test]
fn a_finding_about_a_stiff_spring_contains_the_admissible_stiffness() {
    let moored = |stiffness: f64| {
        let spring = "[[spring]]\nname = \"line\"\nbetween = [\"box\"]\nfrom = [1.0, 0.35]\nto = [1.0, 0.0]";
        let text = format!("{GOOD}\n{spring}\nstiffness = {stiffness:?}\n");
        preflight_report(&Scene::parse(&text, Path::new(""), &[]).unwrap())
    };
    let stiff = moored(1e9);
    let finding = stiff.findings.iter().find(|f| f.topic == "stiff_spring").expect("1e9 N/m on 10 kg is stiff");
    assert_eq!(stiff.step.bound_by, "springs");
    let part: f64 = finding.mend.split(' ').next().unwrap().parse().unwrap();
    let soft = moored(1e9 * part);
    assert!(!topics(&soft).contains(&"stiff_spring") && soft.step.springs_s.unwrap() >= soft.step.sound_s);
    assert_eq!(report(&[]).step.springs_s, None);
}

#[test]
fn a_winch_that_does_not_start_with_its_tension_is_noted() {
    let moored = |tension: f64| {
        let line = "[[line_type]]\nname = \"chain\"\ndiameter = 0.004\nmass_per_length = 0.1\nstiffness = 500.0\n\
                    [[mooring]]\nname = \"hawser\"\nbetween = [\"box\"]\nfrom = [1.0, 0.35]\nto = [1.1, 0.0]\nlength = 0.4\nline = \"chain\"";
        let text = format!("{GOOD}\n{line}\nwinch = {{ hold_tension = {tension:?}, rate_limit = 0.1 }}\n");
        preflight_report(&Scene::parse(&text, Path::new(""), &[]).unwrap())
    };
    let other = moored(50.0);
    assert!(topics(&other).contains(&"winch_starts"));
    let rest = moored(other.moorings[0].fairlead_n);
    assert!(!topics(&rest).contains(&"winch_starts"), "{:?}", rest.findings);
}

#[test]
fn a_mooring_line_that_breaks_at_the_start_is_told() {
    let moored = |breaks: f64| {
        let line = "[[line_type]]\nname = \"chain\"\ndiameter = 0.004\nmass_per_length = 0.1\nstiffness = 500.0\n\
                    [[mooring]]\nname = \"hawser\"\nbetween = [\"box\"]\nfrom = [1.0, 0.35]\nto = [1.1, 0.0]\nlength = 0.4\nline = \"chain\"";
        let text = format!("{GOOD}\n{line}\nbreaks = {{ tension = {breaks:?} }}\n");
        preflight_report(&Scene::parse(&text, Path::new(""), &[]).unwrap())
    };
    let strong = moored(100.0);
    assert!(!topics(&strong).contains(&"breaks_at_start"), "{:?}", strong.findings);
    let rest = strong.moorings[0].fairlead_n.max(strong.moorings[0].anchor_n);
    let weak = moored(0.9 * rest);
    let found = weak.findings.iter().find(|finding| finding.topic == "breaks_at_start").expect("it is told");
    assert!(found.mend.starts_with("breaks = "), "{found:?}");
}

#[test]
fn a_paddle_with_a_list_of_motions_has_the_report_of_a_single_motion() {
    let alone = report(&[]);
    let half = "{ along = [1.0, 0.0], distance = { formula = \"0.02*(1-cos(2*pi*t))\" } }";
    let whole = "{ along = [1.0, 0.0], distance = { formula = \"0.04*(1-cos(2*pi*t))\" } }";
    let text = GOOD.replace(whole, &format!("{{ motions = [{half}, {half}] }}"));
    assert_ne!(text, GOOD);
    let listed = preflight_report(&Scene::parse(&text, Path::new(""), &[]).unwrap());
    assert_eq!(topics(&listed), topics(&alone));
    let [one, other] = [&alone, &listed].map(|found| found.waves.first().expect("the paddle generates waves"));
    // The motions are equal up to round-off.
    for (a, b) in [(one.stroke_m, other.stroke_m), (one.height_m, other.height_m), (one.paddle_mps, other.paddle_mps)] {
        assert!((a / b - 1.0).abs() < 1e-9, "{one:?} {other:?}");
    }
    assert_eq!((one.period_s, &one.answers), (other.period_s, &other.answers));
    assert_eq!(alone.sound.expected.len(), listed.sound.expected.len());
}

/// A run writes a frame at the start, at every multiple of the interval, and at the end. 0.3/0.1 is less than 3 in binary, and 1.1/0.1 more
/// than 11.
#[test]
fn frames_are_counted_as_the_run_writes_them() {
    for (until, count) in [("0.3", 4), ("0.35", 5), ("1.1", 12), ("0.05", 2)] {
        let found = report(&[("until", until), ("frames.every", "0.1")]);
        assert_eq!(found.size.disk.frames, count, "to {until} s");
    }
}
