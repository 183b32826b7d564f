//! Unit tests of `src/preflight/floating_bodies.rs`: bodies that are tied together, from the scene to the findings.

use std::path::Path;

use crate::{
    preflight::{Preflight, preflight},
    scene::{BuiltScene, Scene},
    simulation::Simulation,
};

/// The pre-flight of these sections in a tank of 1.6 m with water 0.7 m deep.
fn judged(sections: &str) -> Preflight {
    let text = format!(
        "dimension = 2\ndp = 0.02\nuntil = 1.0\n\
         [[water]]\nfill = {{ box = {{ min = [0.0, 0.0], max = [1.6, 0.7] }} }}\n\
         [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = [1.6, 1.2] }} }}\n{sections}"
    );
    let BuiltScene { setup, plan, initial_water, .. } =
        Scene::parse(&text, Path::new(""), &[]).unwrap().build::<2>().unwrap();
    preflight(&Simulation::new(setup).unwrap(), &plan, initial_water, &[])
}

fn solid(name: &str, [wide, high]: [f64; 2], density: f64, at: &str) -> String {
    format!(
        "[[solid]]\nname = \"{name}\"\nshape = {{ box = {{ size = [{wide}, {high}] }} }}\nat = {{ {at} }}\n\
         free = {{ density = {density} }}\n"
    )
}

#[track_caller]
fn assert_at_rest(found: &Preflight, body: usize, draft: f64) {
    let body = &found.bodies[body];
    let rest = body.afloat.as_ref().unwrap_or_else(|| panic!("\"{}\": {}", body.name, body.support));
    // A taut rope stretches by 1e-5 of the draft that its load causes.
    assert!((rest.draft_m - draft).abs() < 2e-5, "\"{}\" at {} m, {draft} m", body.name, rest.draft_m);
    assert!((body.draft_m - rest.draft_m).abs() < 2e-5, "it starts {} m deep", body.draft_m);
    let faults = ["capsizes", "off_draft", "lists"];
    assert!(!found.findings.iter().any(|finding| faults.contains(&finding.topic)), "{:#?}", found.findings);
}

#[test]
fn a_float_with_a_clump_on_its_rope_starts_at_the_draft_of_both() {
    let rope = "[[rope]]\nname = \"line\"\nbetween = [\"float\", \"clump\"]\nfrom = [0.6, 0.62]\nto = [0.6, 0.4]\n";
    let float = solid("float", [0.3, 0.15], 400.0, "x = 0.6, draft = \"equilibrium\"");
    let clump = solid("clump", [0.1, 0.08], 3000.0, "x = 0.6, y = 0.36");
    let found = judged(&format!("{float}{clump}{rope}"));
    // 18 kg/m, and 2000 kg/m³ × 0.008 m² = 16 kg/m.
    assert_at_rest(&found, 0, 34.0 / 300.0);
    assert!(found.bodies[1].support == "lines" && (found.bodies[0].load_kg - 16.0).abs() < 1e-3);
}

#[test]
fn a_deck_bolted_to_a_heavy_keel_is_one_body() {
    let joint = "[[joint]]\nname = \"bolt\"\nkind = \"fixed\"\nbetween = [\"deck\", \"keel\"]\nat = [0.8, 0.62]\n";
    let deck = solid("deck", [1.0, 0.2], 200.0, "x = 0.8, draft = \"equilibrium\"");
    let keel = solid("keel", [0.2, 0.4], 1500.0, "x = 0.8, bottom = 0.22");
    let found = judged(&format!("{deck}{keel}{joint}"));
    assert_at_rest(&found, 0, 0.08);
    assert_at_rest(&found, 1, 0.48);
    assert_eq!(found.bodies[0].tied_to, ["keel"]);
    let gm = |i: usize| found.bodies[i].afloat.as_ref().unwrap().tilts[0].gm_m;
    // KB = (80 · 0.2 + 80 · 0.44)/160, BM = 1/12/0.16, KG = (40 · 0.5 + 120 · 0.2)/160 m above the keel.
    let exact = 0.32 + 1.0 / 1.92 - 0.275;
    assert!((gm(0) - exact).abs() < 1e-4 && gm(0) == gm(1), "{} {} for {exact}", gm(0), gm(1));
    // By itself the keel sinks.
    assert_eq!(judged(&format!("{deck}{keel}")).bodies[1].support, "bottom");
}

#[test]
fn a_catamaran_of_two_hulls_and_a_bridge_floats_at_the_draft_of_all() {
    let joint = |name: &str, x: f64| {
        format!(
            "[[joint]]\nname = \"{name}_bolt\"\nkind = \"fixed\"\nbetween = [\"{name}\", \"bridge\"]\nat = [{x}, 0.8]\n"
        )
    };
    let hull = |name: &str, x: f64| solid(name, [0.2, 0.2], 300.0, &format!("x = {x}, draft = \"equilibrium\""));
    let bridge = solid("bridge", [0.9, 0.06], 200.0, "x = 0.8, bottom = 0.8");
    let found = judged(
        &[hull("port", 0.4), hull("starboard", 1.2), bridge, joint("port", 0.4), joint("starboard", 1.2)].concat(),
    );
    // 2 · 12 kg/m and 10.8 kg/m over 0.4 m.
    assert_at_rest(&found, 0, 0.087);
    assert_at_rest(&found, 1, 0.087);
    assert_eq!(found.bodies[2].support, "water");
}

#[test]
fn a_taut_mooring_pulls_a_buoy_deeper_and_a_hinge_holds_a_flap() {
    let spring = "[[spring]]\nname = \"mooring\"\nbetween = [\"buoy\"]\nfrom = [0.6, 0.6]\nto = [0.6, 0.0]\nlength = 0.5\n\
                  stiffness = 500.0\ntension_only = true\n";
    let found = judged(&format!("{}{spring}", solid("buoy", [0.2, 0.2], 500.0, "x = 0.6, draft = \"equilibrium\"")));
    // 50 N/m in addition to 20 kg/m.
    assert_at_rest(&found, 0, (20.0 + 50.0 / 9.81) / 200.0);
    let foot = "[[joint]]\nname = \"foot\"\nkind = \"hinge\"\nbetween = [\"flap\"]\nat = [0.8, 0.06]\n";
    let found = judged(&format!("{}{foot}", solid("flap", [0.1, 0.4], 1500.0, "x = 0.8, bottom = 0.06")));
    assert!(found.bodies[0].support == "held" && found.bodies[0].afloat.is_none());
}

#[test]
fn a_steady_force_is_part_of_the_balance() {
    let force = "[[force]]\nname = \"load\"\non = \"raft\"\nforce = [0.0, -98.1]\n";
    let found = judged(&format!("{}{force}", solid("raft", [0.5, 0.2], 300.0, "x = 0.8, draft = \"equilibrium\"")));
    assert_at_rest(&found, 0, 40.0 / 500.0);
}

#[test]
fn the_motor_of_a_slider_is_part_of_the_balance_and_of_heave() {
    let slider = |between: &str, motor: &str| {
        format!(
            "[[joint]]\nname = \"mast\"\nkind = \"slider\"\nbetween = [{between}]\nat = [0.8, 0.7]\nalong = [0.0, 1.0]\n\
             motor = {{ {motor} }}\n"
        )
    };
    let raft = solid("raft", [0.5, 0.2], 300.0, "x = 0.8, draft = \"equilibrium\"");
    let pushed = |between: &str, motor: &str| judged(&format!("{raft}{}", slider(between, motor)));
    // 30 kg/m, and 98.1 N/m downwards: 40 kg/m over 0.5 m.
    let found = pushed("\"raft\"", "force = -98.1, damping = 500.0");
    assert_at_rest(&found, 0, 0.08);
    assert!((found.bodies[0].load_kg - 10.0).abs() < 1e-6, "{}", found.bodies[0].load_kg);
    // The same of a stiffness to a target 0.1 m below the start, and of a force that its limit cuts.
    assert_at_rest(&pushed("\"raft\"", "stiffness = 981.0, position = -0.1"), 0, 0.08);
    assert_at_rest(&pushed("\"raft\"", "force = -1000.0, strongest = 98.1"), 0, 0.08);
    // T = 2π √(m/(ρ g A + k)) = 2π √(30/(4905 + 5000)).
    let found = pushed("\"raft\"", "stiffness = 5000.0");
    let heave = found.bodies[0].afloat.as_ref().unwrap().heave_s;
    let exact = std::f64::consts::TAU * (30f64 / 9905.0).sqrt();
    assert!((heave / exact - 1.0).abs() < 1e-6, "{heave} s, exact {exact} s");
    // A force that changes with time does not count.
    assert_at_rest(&pushed("\"raft\"", "force = \"-98.1*sin(t)\""), 0, 0.06);
    // Between two rafts the one gets what the other gives.
    let upper = solid("deck", [0.3, 0.1], 100.0, "x = 0.8, bottom = 0.9");
    let found = judged(&format!("{raft}{upper}{}", slider("\"raft\", \"deck\"", "force = 29.43")));
    assert!((found.bodies[0].load_kg - 3.0).abs() < 1e-3, "{}", found.bodies[0].load_kg);
}

fn finding<'a>(found: &'a Preflight, topic: &str) -> &'a crate::preflight::Finding {
    let own = found.findings.iter().find(|finding| finding.topic == topic);
    own.unwrap_or_else(|| panic!("{topic} is not among {:#?}", found.findings))
}

fn heel(found: &Preflight) -> f64 {
    found.bodies[0].afloat.as_ref().unwrap().heel_deg.unwrap()
}

#[test]
fn a_body_out_of_trim_is_told_the_turn_to_its_rest() {
    // The exact 2-D hydrostatics of polygons. A square of half the density of water rests on its edge.
    let square = |density: f64, turn: f64| {
        judged(&solid("box", [0.3, 0.3], density, &format!("x = 0.8, draft = \"equilibrium\", angle_deg = {turn}")))
    };
    let found = square(500.0, 30.0);
    assert!((heel(&found) - 15.0).abs() < 0.01, "{}", heel(&found));
    assert_eq!(finding(&found, "lists").what, "\"box\" turns by 15° to its rest");
    let found = square(500.0, 0.0);
    assert!(
        finding(&found, "capsizes").what.contains("to rest at 45° from its start: its metacentric height is -0.025 m")
    );
    let found = square(800.0, 10.0);
    assert!((heel(&found) - 10.0).abs() < 0.01, "{}", heel(&found));
    // A flat box rights itself from 60°, where its metacentric height is negative.
    let flat = judged(&solid("box", [0.6, 0.2], 500.0, "x = 0.8, draft = \"equilibrium\", angle_deg = 60.0"));
    assert!(
        (heel(&flat) - 60.0).abs() < 0.01 && finding(&flat, "lists").what.contains("by 60°"),
        "{:#?}",
        flat.findings
    );
    let off = solid("box", [0.6, 0.2], 400.0, "x = 0.8, draft = \"equilibrium\"")
        .replace("density = 400", "centre_offset = [0.1, 0.1], density = 400");
    let found = judged(&off);
    assert!((heel(&found) - 166.8).abs() < 0.1, "{}", heel(&found));
    let told = finding(&found, "capsizes");
    assert!(
        told.what.contains("to rest at 167° from its start") && told.mend.contains("under its buoyancy"),
        "{told:?}"
    );
}

#[test]
fn the_heel_of_tied_bodies_is_an_estimate_of_45_degrees_at_most() {
    let force = "[[force]]\nname = \"push\"\non = \"raft\"\nforce = [0.0, -20.0]\nat = [0.9, 0.75]\n";
    let raft = solid("raft", [0.6, 0.2], 300.0, "x = 0.8, draft = \"equilibrium\", angle_deg = 0.0");
    let rest = |found: &Preflight| found.bodies[0].afloat.clone().unwrap();
    let found = judged(&format!("{raft}{force}"));
    assert!(rest(&found).heel_is_estimate && finding(&found, "lists").what.contains("estimated for small angles"));
    assert!(!rest(&judged(&raft)).heel_is_estimate);
    let hard = judged(&format!("{raft}{}", force.replace("-20.0", "-600.0").replace("0.9,", "1.05,")));
    assert!(rest(&hard).heel_deg == Some(45.0) && finding(&hard, "lists").what.contains("more than 45°"), "{hard:#?}");
}

#[test]
fn a_float_that_lifts_a_clump_off_the_bed_rises_with_it() {
    // The clump has 0.015 m² × 100 kg/m³ = 1.5 kg/m of wet weight, and the float 0.02 m² × 800 kg/m³ = 16 kg/m of lift: 4 kg/m
    // and 1.5 kg/m of the water that it displaces at rest over 0.2 m.
    let rope = "[[rope]]\nname = \"line\"\nbetween = [\"clump\", \"float\"]\nfrom = [0.8, 0.1]\nto = [0.8, 0.2]\n";
    let clump = solid("clump", [0.15, 0.1], 1100.0, "x = 0.8, bottom = 0.0");
    let float = solid("float", [0.2, 0.1], 200.0, "x = 0.8, bottom = 0.2");
    let found = judged(&format!("{clump}{float}{rope}"));
    assert_eq!((found.bodies[0].support, found.bodies[1].support), ("lines", "water"), "{:#?}", found.findings);
    let rest = found.bodies[1].afloat.as_ref().unwrap().draft_m;
    assert!((rest - 0.0275).abs() < 1e-5, "draft {rest} m");
    assert!(finding(&found, "off_draft").what.contains("\"float\" starts"));
    // A clump of 20 kg/m of wet weight stays.
    let found = judged(&format!("{}{float}{rope}", clump.replace("1100", "2400")));
    assert_eq!((found.bodies[0].support, found.bodies[1].support), ("bottom", "lines"));
}

#[test]
fn a_spring_that_breaks_at_the_start_is_told_and_bears_nothing() {
    let spring = |strength: f64| {
        format!(
            "[[spring]]\nname = \"line\"\nbetween = [\"buoy\"]\nfrom = [0.6, 0.6]\nto = [0.6, 0.0]\nlength = 0.5\n\
             stiffness = 500.0\nbreaks = {{ tension = {strength} }}\n"
        )
    };
    let buoy = solid("buoy", [0.4, 0.1], 500.0, "x = 0.6, draft = \"equilibrium\"");
    // It has 500 · 0.1 = 50 N/m.
    let found = judged(&format!("{buoy}{}", spring(49.0)));
    assert!(finding(&found, "breaks_at_start").what.contains("it has 50 N/m and bears 49 N/m"));
    assert_at_rest(&found, 0, 0.05);
    assert_eq!(found.bodies[0].load_kg, 0.0);
    let found = judged(&format!("{buoy}{}", spring(51.0)));
    assert!(!found.findings.iter().any(|finding| finding.topic == "breaks_at_start"));
    assert_at_rest(&found, 0, (20.0 + 50.0 / 9.81) / 400.0);
}

#[test]
fn a_rope_that_breaks_before_the_bodies_are_at_rest_is_told() {
    // A clump of 0.01 m² with 2000 kg/m³ more than the water hangs on a rope that is slack at the start: 196.2 N/m.
    let assembly = |strength: f64| {
        let rope = format!(
            "[[rope]]\nname = \"line\"\nbetween = [\"float\", \"clump\"]\nfrom = [0.8, 0.5]\nto = [0.8, 0.4]\nlength = 0.2\n\
             breaks = {{ tension = {strength} }}\n"
        );
        let clump = solid("clump", [0.1, 0.1], 3000.0, "x = 0.8, bottom = 0.3");
        judged(&format!("{}{clump}{rope}", solid("float", [0.6, 0.2], 300.0, "x = 0.8, bottom = 0.5")))
    };
    let found = assembly(190.0);
    let told = &finding(&found, "breaks_at_rest").what;
    assert!(told.starts_with("rope \"line\"") && told.contains("it has 196 N/m then and bears 190 N/m"), "{told}");
    let found = assembly(200.0);
    assert!(!found.findings.iter().any(|finding| finding.topic == "breaks_at_rest"));
}

#[test]
fn a_release_after_the_run_and_ballast_that_capsizes_are_told() {
    let raft = |more: &str| {
        judged(
            &solid("raft", [0.6, 0.2], 300.0, "x = 0.8, draft = \"equilibrium\"")
                .replace("density = 300", &format!("{more}, density = 300")),
        )
    };
    let told = raft("release = 10.0");
    assert!(finding(&told, "event_after_end").what.contains("released at 10 s, and the run ends at 1 s"));
    assert!(!raft("release = 0.5").findings.iter().any(|finding| finding.topic == "event_after_end"));
    // 36 kg/m, and 20 kg/m at 1.2 m above the middle at the end: KG = 20 · 1.2/56 m above it; draft 0.0933 m, BM = 0.6²/12/0.0933,
    // KB = 0.0467 − 0.1: GM = −0.0533 + 0.321 − 0.429.
    let told = raft("ballast = [{ at = [0.0, 1.2], mass = \"20*t\" }]");
    assert!(finding(&told, "capsizes").what.contains("falls to -0.16"), "{:#?}", told.findings);
    assert!(!raft("ballast = [{ at = [0.0, 0.5], mass = \"20*t\" }]").findings.iter().any(|f| f.topic == "capsizes"));
}
