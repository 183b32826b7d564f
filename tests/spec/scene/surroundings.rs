//! Preflight: bodies beside several waters and in dry hollows have the draft, the support and the wind of their own surroundings.

use std::path::Path;

use pontoon::{
    preflight::{BodySummary, Finding, Preflight},
    scene::Scene,
};

use crate::common::preflight_report;

/// A tank of 1.6 m at dp = 0.02 m.
const TANK: &str = "dimension = 2\ndp = 0.02\nuntil = 1.0\nframes = \"off\"\n\
    [[solid]]\nname = \"tank\"\nfixed = true\nshape = { tank = { size = [1.6, 0.9] } }\n";

/// Water over the whole tank to 0.4 m.
const SEA: &str = "[[water]]\nfill = { box = { min = [0.0, 0.0], max = [1.6, 0.4] } }\n";

/// A bulkhead between water to 0.4 m and water to 0.2 m.
const BASINS: &str = "[[solid]]\nname = \"bulkhead\"\nfixed = true\nshape = { box = { size = [0.08, 0.8] } }\n\
    at = { x = 0.8, bottom = 0.0 }\n\
    [[water]]\nfill = { box = { min = [0.0, 0.0], max = [0.76, 0.4] } }\n\
    [[water]]\nfill = { box = { min = [0.84, 0.0], max = [1.6, 0.2] } }\n";

fn scene(text: &str) -> Scene {
    Scene::parse(text, Path::new(""), &[]).unwrap()
}

fn report(text: &str) -> Preflight {
    preflight_report(&scene(text))
}

fn find<'a>(of: &'a Preflight, topic: &str) -> Option<&'a Finding> {
    of.findings.iter().find(|finding| finding.topic == topic)
}

fn summary<'a>(of: &'a Preflight, name: &str) -> &'a BodySummary {
    of.bodies.iter().find(|body| body.name == name).unwrap()
}

/// A dry barge of the inner size 0.6 m × 0.4 m with walls of 0.08 m, which is 0.76 m wide.
fn barge(role: &str, at: &str) -> String {
    format!(
        "[[solid]]\nname = \"barge\"\nshape = {{ tank = {{ size = [0.6, 0.4], thickness = 0.08 }} }}\nat = {{ {at} }}\n{role}\n\
         dry = true\n"
    )
}

fn block(name: &str, [wide, high]: [f64; 2], at: &str, free: &str) -> String {
    format!(
        "[[solid]]\nname = \"{name}\"\nshape = {{ box = {{ size = [{wide}, {high}] }} }}\nat = {{ {at} }}\nfree = {{ {free} }}\n"
    )
}

/// The barge of 100 kg/m and its cargo of 30 kg/m displace 130 kg/m over 0.76 m: a draft of 0.17105 m. The cargo in the hold displaces
/// nothing, although it lies below the sea.
#[test]
fn cargo_that_is_fixed_in_a_dry_hold_displaces_no_water() {
    let joint = "[[joint]]\nname = \"j\"\nkind = \"fixed\"\nbetween = [\"barge\", \"b\"]\nat = [0.8, 0.34]\n";
    for wide in [0.2, 0.4] {
        let cargo = block("b", [wide, 0.1], "x = 0.8, bottom = 0.34", "mass = 30.0");
        let barge = barge("free = { mass = 100.0 }", "x = 0.5, draft = \"equilibrium\"");
        let found = report(&format!("{TANK}{SEA}{barge}{cargo}{joint}"));
        let own = summary(&found, "barge");
        // The bisection stops at 1e-14 of the height.
        assert!((own.draft_m - 130.0 / 760.0).abs() < 1e-9, "placed at {} m", own.draft_m);
        assert!((own.afloat.as_ref().unwrap().draft_m - 130.0 / 760.0).abs() < 1e-9, "{own:?}");
        assert_eq!(summary(&found, "b").displaced_kg, 0.0);
        // BM = B³/(12 V) with B = 0.76 m, V = 0.13 m²; KB is half the draft. Above the keel the barge has its centre at that of its
        // walls and floor, and the cargo, 0.1 m high, starts 0.34 m over the tank's floor with the keel at 0.4 m − draft.
        let draft = 130.0 / 760.0;
        let [floor, walls] = [0.76 * 0.08, 2.0 * 0.08 * 0.4];
        let barge_centre = (floor * 0.04 + walls * 0.28) / (floor + walls);
        let cargo_centre = 0.39 - (0.4 - draft);
        let gm = 0.76f64.powi(3) / (12.0 * 0.13) + 0.5 * draft - (100.0 * barge_centre + 30.0 * cargo_centre) / 130.0;
        let told = own.afloat.as_ref().unwrap().tilts[0].gm_m;
        // The turn from which the restoring moment is taken changes it by 2e-4.
        assert!((told / gm - 1.0).abs() < 1e-3, "{told} m for {gm} m");
    }
}

#[test]
fn loose_cargo_in_a_dry_hold_stands_there_and_is_noted() {
    let keel = 0.4 - 100.0 / 760.0;
    let cargo = block("b", [0.2, 0.1], &format!("x = 0.8, bottom = {}", keel + 0.08), "mass = 30.0");
    let barge = barge("free = { mass = 100.0 }", "x = 0.5, draft = \"equilibrium\"");
    let found = report(&format!("{TANK}{SEA}{barge}{cargo}"));
    let own = summary(&found, "b");
    assert!(own.support == "solid" && own.displaced_kg == 0.0 && own.afloat.is_none(), "{own:?}");
    assert!(find(&found, "carried_body").unwrap().what.contains("\"b\" stands on \"barge\""));
    // At the height at which the barge floats with it, it counts as if it were bolted there: 130 kg/m on 0.76 m.
    let floor = 0.4 - 130.0 / 760.0 + 0.08;
    let laden = block("b", [0.2, 0.1], &format!("x = 0.8, bottom = {floor}"), "mass = 30.0");
    let found = report(&format!(
        "{TANK}{SEA}{}{laden}",
        self::barge("free = { mass = 100.0 }", "x = 0.5, draft = \"equilibrium\"")
    ));
    let own = summary(&found, "barge");
    // The bisection stops at 1e-14 of the height.
    assert!((own.draft_m - 130.0 / 760.0).abs() < 1e-9, "placed at {} m", own.draft_m);
    assert!((own.afloat.as_ref().unwrap().draft_m - 130.0 / 760.0).abs() < 1e-9, "{own:?}");
    // A light body on the floor of a dock below the level of the sea.
    let dock = |bottom: &str| {
        let light = block("b", [0.2, 0.1], &format!("x = 0.8, {bottom}"), "density = 500.0");
        report(&format!("{TANK}{SEA}{}{light}", self::barge("fixed = true", "x = 0.5, y = 0.3")))
    };
    let on_floor = dock("bottom = 0.3");
    assert!(summary(&on_floor, "b").support == "solid" && find(&on_floor, "beside_water").is_none());
    let falls = dock("draft = \"equilibrium\"");
    assert!(find(&falls, "beside_water").unwrap().what.contains("\"b\" starts where no water is"), "{falls:#?}");
}

/// Beside water to 0.4 m a piston in water to 0.2 m makes waves for 0.2 m: by linear theory those of 1 s are 1.212 m long there, and
/// 1.464 m in 0.4 m.
#[test]
fn a_paddle_in_the_lower_of_two_basins_makes_waves_for_its_depth() {
    let wave = "driven = { along = [1.0, 0.0], wave = { regular = { height = 0.02, period = 1.0 } } }";
    let paddle = |x: f64, top: f64| {
        format!(
            "[[solid]]\nname = \"paddle\"\nshape = {{ box = {{ size = [0.08, {top}] }} }}\nat = {{ x = {x}, bottom = 0.0 }}\n{wave}\n"
        )
    };
    let lower = BASINS.replace("min = [0.84, 0.0]", "min = [1.0, 0.0]");
    let found = report(&format!("{TANK}{lower}{}", paddle(0.96, 0.35)));
    let own = &found.waves[0];
    assert!((own.depth_m - 0.2).abs() < 1e-9 && (own.length_m - 1.212).abs() < 0.001, "{own:?}");
    assert!(find(&found, "drowned_paddle").is_none() && find(&found, "wrong_depth").is_none(), "{found:#?}");
}

/// A box of half the density of water and 0.1 m high floats 0.05 m deep in its own basin, with its bottom at 0.15 m.
#[test]
fn a_body_in_the_lower_of_two_basins_has_its_draft_there() {
    for at in ["x = 1.2, bottom = 0.15", "x = 1.2, draft = \"equilibrium\"", "x = 1.2, draft = 0.05"] {
        let text = format!("{TANK}{BASINS}{}", block("b", [0.3, 0.1], at, "density = 500.0"));
        let found = report(&text);
        let own = summary(&found, "b");
        assert!((own.draft_m - 0.05).abs() < 1e-9 && (own.displaced_kg - 15.0).abs() < 1e-6, "{at}: {own:?}");
        assert!((own.afloat.as_ref().unwrap().draft_m - 0.05).abs() < 1e-9, "{at}: {own:?}");
        assert!(find(&found, "off_draft").is_none(), "{at}: {:#?}", found.findings);
        let bottom = scene(&text).build::<2>().unwrap().setup.solids[2].pose.position[1] - 0.05;
        assert!((bottom - 0.15).abs() < 1e-9, "{at}: {bottom} m");
    }
    let high =
        report(&format!("{TANK}{BASINS}{}", block("b", [0.3, 0.1], "x = 1.2, bottom = 0.35", "density = 500.0")));
    assert!(find(&high, "off_draft").unwrap().what.contains("starts 0.2 m, 10 dp, above its draft of 0.05 m"));
}

#[test]
fn a_body_in_the_water_of_a_hull_has_its_draft_there() {
    let dock = "[[water]]\ninside = \"barge\"\nfill = { box = { min = [0.5, 0.08], max = [1.1, 0.24] } }\n";
    let found = |bottom: f64| {
        let boat = block("b", [0.3, 0.1], &format!("x = 0.8, bottom = {bottom}"), "density = 500.0");
        report(&format!("{TANK}{SEA}{dock}{}{boat}", barge("fixed = true", "x = 0.5, y = 0.08")))
    };
    let rests = found(0.19);
    let own = summary(&rests, "b");
    assert!((own.draft_m - 0.05).abs() < 1e-9 && (own.displaced_kg - 15.0).abs() < 1e-6, "{own:?}");
    assert!(find(&rests, "off_draft").is_none() && find(&rests, "other_level").is_none(), "{:#?}", rests.findings);
    let high = found(0.25);
    let note = find(&high, "off_draft").unwrap();
    assert!(note.what.contains("above its draft of 0.05 m") && note.mend.contains("bottom = 0.19"), "{note:?}");
}

#[test]
fn water_without_a_particle_is_refused() {
    let refused = |more: &str, words: &[&str]| {
        let error = scene(&format!("{TANK}{SEA}{more}")).build::<2>().map(drop).expect_err("refused").to_string();
        words.iter().for_each(|word| assert!(error.contains(word), "{word} is not in\n{error}"));
    };
    let block = "[[solid]]\nname = \"k\"\nfixed = true\nshape = { box = { size = [0.4, 0.2] } }\nat = { x = 0.8, bottom = 0.1 }\n";
    // In a block, below the floor, and inside an earlier water.
    for [min, max] in [["0.7, 0.12", "0.9, 0.28"], ["0.3, -0.06", "0.9, -0.02"], ["0.1, 0.1", "0.3, 0.3"]] {
        let water = format!("[[water]]\nfill = {{ box = {{ min = [{min}], max = [{max}] }} }}\n");
        refused(&format!("{block}{water}"), &["water.1.fill", "no particle of this water is left"]);
    }
    // Beside the hull that it names.
    let dry = barge("fixed = true", "x = 0.5, y = 0.3");
    let inside = "[[water]]\ninside = \"barge\"\nfill = { box = { min = [1.3, 0.3], max = [1.5, 0.36] } }\n";
    refused(&format!("{dry}{inside}"), &["water.1.fill", "meets no hollow of \"barge\""]);
}

/// The dock holds 0.6 m × 0.16 m of its own water, 240 particles, and none of the sea around it.
#[test]
fn a_hull_with_water_of_its_own_keeps_the_sea_out() {
    let dock = barge("fixed = true", "x = 0.5, y = 0.08").replace("dry = true\n", "");
    let own = "[[water]]\ninside = \"barge\"\nlevel = 0.24\nfill = { box = { min = [0.5, 0.08], max = [1.1, 0.4] } }\n";
    let built = scene(&format!("{TANK}{SEA}{own}{dock}")).build::<2>().unwrap();
    let within = built.setup.water.iter().filter(|x| x[0] > 0.5 && x[0] < 1.1 && x[1] > 0.08);
    let (count, top) = within.fold((0, 0.0f64), |(count, top), x| (count + 1, top.max(x[1])));
    assert!(count == 240 && top < 0.24, "{count} particles to {top} m");
}

#[test]
fn a_probe_beyond_a_symmetry_plane_is_told_with_its_mirror_image() {
    let probes = "[[probe]]\nname = \"p\"\npressure = [0.3, 0.1]\n[[probe]]\nname = \"e\"\nelevation = { x = 1.3 }\n\
                  [[probe]]\nname = \"s\"\nflow = { from = [0.3, 0.0], to = [0.3, 0.5] }\n";
    let found = report(&format!("symmetry = {{ x = 0.8 }}\n{TANK}{SEA}{probes}"));
    let told: Vec<_> = found.findings.iter().filter(|finding| finding.topic == "probe_outside").collect();
    assert_eq!(told.len(), 2, "{told:#?}");
    for (finding, name) in told.iter().zip(["\"p\"", "\"s\""]) {
        assert!(finding.what.contains(name) && finding.mend.contains("x = 1.3"), "{finding:?}");
    }
}

#[test]
fn a_mast_on_a_hinge_falls_unless_a_motor_or_stays_on_both_sides_hold_it() {
    let joined = |kind: &str, more: &str| {
        let raft = block("b", [0.4, 0.2], "x = 0.8, draft = \"equilibrium\"", "density = 400.0");
        let mast = block("m", [0.08, 0.3], "x = 0.8, bottom = 0.55", "density = 200.0");
        let joint = format!("[[joint]]\nname = \"j\"\nkind = \"{kind}\"\nbetween = [\"b\", \"m\"]\nat = [0.8, 0.55]\n");
        report(&format!("{TANK}{SEA}{raft}{mast}{joint}{more}"))
    };
    let falls = joined("hinge", "");
    assert!(
        find(&falls, "capsizes").unwrap().what.contains("\"b\" with \"m\" will fall over"),
        "{:#?}",
        falls.findings
    );
    assert!(find(&falls, "loose_joint").is_none());
    // A motor of 100 N m/rad holds the mast, whose weight of 4.8 kg 0.15 m above the hinge turns it by 7 N m/rad.
    let held = joined("hinge", "motor = { stiffness = 100.0 }\n");
    assert!(find(&held, "capsizes").is_none() && find(&held, "loose_joint").is_none(), "{:#?}", held.findings);
    // One stay lets it fall to its own side; stays on both sides hold it.
    let stay = |name: &str, foot: f64| {
        format!("[[rope]]\nname = \"{name}\"\nbetween = [\"b\", \"m\"]\nfrom = [{foot}, 0.55]\nto = [0.8, 0.8]\n")
    };
    for foot in [0.7, 0.9] {
        assert!(find(&joined("hinge", &stay("s", foot)), "capsizes").is_some());
    }
    let stayed = joined("hinge", &(stay("s", 0.7) + &stay("t", 0.9)));
    assert!(find(&stayed, "capsizes").is_none() && find(&stayed, "loose_joint").is_none(), "{:#?}", stayed.findings);
    assert!(find(&joined("fixed", ""), "loose_joint").is_none());
}

/// Two barges of 0.6 m × 0.2 m, half as dense as water, on a hinge between them at the deck. With the centres of mass 4 mm further
/// out, each sinks at its outer end. The heave z of the hinge and the turn φ of each barge about it are at rest where
/// K (z, φ) = (0, −2 m g e), K = [[2 k, k L], [k L, 2 (k L²/3 + m g (z_B − z_G))]] with k = ρ g L.
#[test]
fn hinged_barges_are_told_with_the_trim_of_each_part() {
    let (length, mass, g, out) = (0.6, 60.0, 9.81, 0.004);
    let barge = |name: &str, x: f64, shift: f64| {
        let free = format!("density = 500.0, centre_offset = [{shift}, 0.0]");
        block(name, [length, 0.2], &format!("x = {x}, draft = \"equilibrium\", angle_deg = 0.0"), &free)
    };
    let barges = |out: f64| {
        let joint = "[[joint]]\nname = \"j\"\nkind = \"hinge\"\nbetween = [\"left\", \"right\"]\nat = [0.8, 0.5]\n";
        report(&format!("{TANK}{SEA}{}{}{joint}", barge("left", 0.5, -out), barge("right", 1.1, out)))
    };
    let k = 1000.0 * g * length;
    // B is 0.05 m below the level, G at the level.
    let [zz, zp, pp] = [2.0 * k, k * length, 2.0 * (k * length * length / 3.0 - mass * g * 0.05)];
    let turn = (2.0 * mass * g * out * zz / (zz * pp - zp * zp)).to_degrees();
    let found = barges(out);
    let free = summary(&found, "left").afloat.as_ref().unwrap().free_joints.clone().unwrap();
    for (name, told) in &free.turns_deg {
        // Turns of 0.02 rad: second-order terms are of this share.
        assert!((told / turn - 1.0).abs() < 0.03, "{name}: {told}° for {turn}°");
    }
    assert!(
        find(&found, "lists").unwrap().what.contains("turn to their rest with free ties: \"left\" by"),
        "{found:#?}"
    );
    assert!(find(&barges(0.0), "lists").is_none());
}

/// A box of 0.4 m × 0.2 m, half as dense as water, hinged 0.4 m beside its middle at the still level. About the hinge the waterplane
/// gives the stiffness ρ g (0.6³ − 0.2³)/3 N m, less that of the buoyancy of 40 kg, 0.05 m below the hinge. With its mass 0.1 m off the
/// middle the moment is −40 g · 0.1 N m. With a motor of 10 N m it is 10 N m.
#[test]
fn a_body_on_a_hinge_out_of_balance_is_told_with_its_turn() {
    let hinged = |free: &str, motor: &str| {
        let joint = format!("[[joint]]\nname = \"j\"\nkind = \"hinge\"\nbetween = [\"b\"]\nat = [0.4, 0.4]\n{motor}\n");
        report(&format!(
            "{TANK}{SEA}{}{joint}",
            block("b", [0.4, 0.2], "x = 0.8, draft = \"equilibrium\", angle_deg = 0.0", free)
        ))
    };
    let stiffness = 9.81 * (1000.0 * (0.6f64.powi(3) - 0.2f64.powi(3)) / 3.0 - 40.0 * 0.05);
    let off_centre = ("density = 500.0, centre_offset = [0.1, 0.0]", "", -40.0 * 9.81 * 0.1);
    for (free, motor, moment) in [off_centre, ("density = 500.0", "motor = { torque = 10.0 }", 10.0)] {
        let found = hinged(free, motor);
        let note = find(&found, "lists").unwrap_or_else(|| panic!("{:#?}", found.findings));
        let words: Vec<f64> = note.what.split([' ', '°']).filter_map(|word| word.parse().ok()).collect();
        // Three digits are printed.
        assert!((words[0] / moment - 1.0).abs() < 5e-3, "{}", note.what);
        let degrees = (moment / stiffness).abs().to_degrees();
        assert!((words[1] / degrees - 1.0).abs() < 5e-3, "{} for {degrees}", note.what);
    }
    assert!(find(&hinged("density = 500.0", ""), "lists").is_none());
}

/// A floor of a quarter of dp carries the water on it; without a floor the water falls.
#[test]
fn a_thin_floor_carries_the_water() {
    let tank = |points: &str| {
        format!(
            "dimension = 2\ndp = 0.02\nuntil = 1.0\nframes = \"off\"\n[[water]]\n\
             fill = {{ box = {{ min = [0.0, 0.0], max = [1.0, 0.4] }} }}\n[[solid]]\nname = \"wall\"\nfixed = true\n\
             shape = {{ polyline = {{ points = [{points}], thickness = 0.005 }} }}\n"
        )
    };
    let with_floor = report(&tank("[0.0, 0.7], [0.0, 0.0], [1.0, 0.0], [1.0, 0.7]"));
    assert!(find(&with_floor, "water_in_air").is_none(), "{:#?}", with_floor.findings);
    assert!(find(&report(&tank("[0.0, 0.7], [0.0, -0.2]")), "water_in_air").is_some());
}

#[test]
fn a_release_after_the_removal_is_refused_at_its_key() {
    let body = block("b", [0.4, 0.2], "x = 0.8, draft = \"equilibrium\"", "density = 500.0, release = 0.8");
    let refused = |until: &str| {
        let scene = Scene::parse(&format!("{TANK}{SEA}{body}until = {until}\n"), Path::new(""), &[])?;
        scene.build::<2>().map(drop)
    };
    let error = refused("0.5").expect_err("refused").to_string();
    assert!(error.contains("free.release") && error.contains("after its removal at 0.5 s"), "{error}");
    assert!(refused("0.9").is_ok());
}

/// The U-shaped hull of 0.18 m² in half a model floats as in the whole model, with the water inside it.
#[test]
fn the_water_in_a_hull_that_a_symmetry_plane_cuts_counts_whole() {
    let hull = |symmetry: &str, dry: &str| {
        report(&format!(
            "{symmetry}dimension = 2\ndp = 0.02\nuntil = 1.0\nframes = \"off\"\n\
             [[water]]\nfill = {{ box = {{ min = [-1.2, -1.0], max = [1.2, 0.0] }} }}\n\
             [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = [2.4, 1.4] }} }}\nat = [-1.2, -1.0]\n\
             [[solid]]\nname = \"b\"\nat = {{ x = 0.0, draft = \"equilibrium\" }}\nfree = {{ density = 900.0 }}\n{dry}\n\
             shape = {{ polygon = [[-0.5, 0], [0.5, 0], [0.5, 0.4], [0.4, 0.4], [0.4, 0.1], [-0.4, 0.1], [-0.4, 0.4], [-0.5, 0.4]] }}\n"
        ))
    };
    let plane = "symmetry = { x = 0.0 }\n";
    for dry in ["dry = false", "dry = true", ""] {
        let [whole, half] = ["", plane].map(|symmetry| hull(symmetry, dry));
        let [a, b] = [&whole, &half].map(|found| summary(found, "b"));
        assert!(
            (a.draft_m - b.draft_m).abs() < 1e-9 && (a.displaced_kg - b.displaced_kg).abs() < 1e-6,
            "{dry}: {a:?} {b:?}"
        );
        let [a, b] = [a, b].map(|body| body.afloat.as_ref().unwrap());
        // The plane leaves no turn, so only the whole model has a metacentric height.
        assert!((a.draft_m - b.draft_m).abs() < 1e-9, "{dry}: {a:?} {b:?}");
        let topics = |found: &Preflight| -> Vec<_> { found.findings.iter().map(|finding| finding.topic).collect() };
        let beyond: Vec<_> = topics(&half).into_iter().filter(|topic| !topics(&whole).contains(topic)).collect();
        assert!(beyond.is_empty(), "{dry}: {beyond:?}");
    }
}

#[test]
fn a_body_longer_than_half_of_the_water_floats_in_a_half_model() {
    let tank = TANK.replace("at = [", "").replace("size = [1.6, 0.9] } }", "size = [1.6, 0.9] } }\nat = [-0.8, 0.0]");
    let sea = "[[water]]\nfill = { box = { min = [-0.8, 0.0], max = [0.8, 0.4] } }\n";
    let body = |wide: f64| block("b", [wide, 0.3], "x = 0.0, draft = \"equilibrium\"", "density = 500.0");
    let half = |wide: f64| report(&format!("symmetry = {{ x = 0.0 }}\n{tank}{sea}{}", body(wide)));
    assert!(find(&half(1.0), "larger_than_water").is_none(), "{:#?}", half(1.0).findings);
}

/// The water is 0.6 m or 0.36 m deep, a whole number of dp. Beside the beach and the ball some packed particles stand above the highest row.
#[test]
fn packed_particles_above_their_row_do_not_put_the_level_off_the_lattice() {
    let head = "dimension = 2\ndp = 0.02\nuntil = 1.0\nframes = \"off\"\n";
    let beach = |level: f64| {
        format!(
            "{head}[[solid]]\nname = \"bed\"\nfixed = true\n\
             shape = {{ polyline = {{ points = [[-2, 0.8], [-2, 0], [0, 0], [4.5, 0.75]] }} }}\n\
             [[water]]\nfill = {{ box = {{ min = [-2.0, 0.0], max = [3.6, {level}] }} }}\n"
        )
    };
    let ball = |level: f64| {
        format!(
            "{TANK}[[water]]\nfill = {{ box = {{ min = [0.0, 0.0], max = [1.6, {level}] }} }}\n\
             [[solid]]\nname = \"b\"\nshape = {{ ball = {{ radius = 0.2 }} }}\nat = {{ x = 0.8, draft = \"equilibrium\" }}\n\
             free = {{ density = 500.0 }}\n"
        )
    };
    for text in [beach(0.6), ball(0.36)] {
        let found = report(&text);
        assert!(find(&found, "surface_off_lattice").is_none(), "{:#?}", found.findings);
    }
    for text in [beach(0.61), ball(0.37)] {
        assert!(find(&report(&text), "surface_off_lattice").is_some(), "half a dp off");
    }
}
