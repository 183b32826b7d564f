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
