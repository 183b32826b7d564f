//! Preflight: scenes with a single mistake that a run would show late, and what is said of bodies on lines, joints and other bodies.

use std::path::Path;

use pontoon::{
    preflight::{Finding, Preflight, Severity},
    scene::Scene,
};

use crate::common::preflight_report;

/// Water of 2 m × 0.6 m at dp = 0.02 m without any wall.
const WATER: &str = "dimension = 2\ndp = 0.02\nuntil = 1.0\nframes = \"off\"\n\
    water = [{ fill = { box = { min = [0.0, 0.0], max = [2.0, 0.6] } } }]\n";

const TANK: &str = "[[solid]]\nname = \"tank\"\nfixed = true\nshape = { tank = { size = [2.0, 1.0] } }\n";

/// Lines for [`line`].
const LINE_TYPE: &str = "[[line_type]]\nname = \"c\"\ndiameter = 0.005\nmass_per_length = 0.05\nstiffness = 2000.0\n";

fn report(text: &str) -> Preflight {
    preflight_report(&Scene::parse(text, Path::new(""), &[]).unwrap())
}

fn find<'a>(of: &'a Preflight, topic: &str) -> Option<&'a Finding> {
    of.findings.iter().find(|finding| finding.topic == topic)
}

#[track_caller]
fn finding(text: &str, topic: &str) -> Finding {
    let found = report(text);
    find(&found, topic).unwrap_or_else(|| panic!("{topic} is not among {:#?}", found.findings)).clone()
}

#[track_caller]
fn has_no(text: &str, topic: &str) {
    let found = report(text);
    assert!(find(&found, topic).is_none(), "{:#?}", found.findings);
}

fn body(name: &str, [wide, high]: [f64; 2], density: f64, at: &str) -> String {
    format!(
        "[[solid]]\nname = \"{name}\"\nshape = {{ box = {{ size = [{wide}, {high}] }} }}\nat = {{ {at} }}\n\
         free = {{ density = {density} }}\n"
    )
}

/// Two taut lines hold a float. Mooring lines with mass and springs of their stiffness give the same heave and roll, up to the weight
/// of the lines, 0.05 kg/m beside 36 kg/m.
#[test]
fn taut_mooring_lines_stiffen_heave_and_roll_as_springs_do() {
    let float = body("b", [0.4, 0.3], 300.0, "x = 1.0, draft = \"equilibrium\"");
    let line = |section: &str, x: f64, key: &str| {
        format!(
            "[[{section}]]\nname = \"m{:.0}\"\nbetween = [\"b\"]\nfrom = [{x}, 0.48]\nto = [{x}, 0.0]\nlength = 0.47\n{key}\n",
            100.0 * x
        )
    };
    let moorings = [0.85, 1.15].map(|x| line("mooring", x, "line = \"c\"")).concat();
    // EA/L of the lines.
    let springs = [0.85, 1.15].map(|x| line("spring", x, "stiffness = 4255.3")).concat();
    let rest = |ties: &str| report(&format!("{WATER}{TANK}{float}{ties}")).bodies.remove(0).afloat.unwrap();
    let (moored, sprung) = (rest(&format!("{LINE_TYPE}{moorings}")), rest(&springs));
    // 36 kg/m on ρ g A = 3924 N/m² and two lines of 4255 N/m each; the added mass is π/8 ρ b², 62.8 kg/m.
    let heave = |mass: f64| std::f64::consts::TAU * (mass / (3924.0 + 2.0 * 4255.3)).sqrt();
    assert!((moored.heave_s / heave(36.0) - 1.0).abs() < 0.01, "{} s of {} s", moored.heave_s, heave(36.0));
    assert!((moored.heave_with_added_s / heave(98.83) - 1.0).abs() < 0.01, "{} s", moored.heave_with_added_s);
    let [moored, sprung] = [&moored.tilts[0], &sprung.tilts[0]];
    assert!((moored.gm_m / sprung.gm_m - 1.0).abs() < 0.02, "GM {} m of {} m", moored.gm_m, sprung.gm_m);
    let [moored, sprung] = [moored.period_s.unwrap(), sprung.period_s.unwrap()];
    assert!((moored / sprung - 1.0).abs() < 0.02, "roll {moored} s of {sprung} s");
}

#[test]
fn the_touchdown_point_of_a_line_to_a_raised_anchor_is_on_the_bed() {
    let text = format!(
        "{WATER}{TANK}[[solid]]\nname = \"b\"\nshape = {{ box = {{ size = [0.4, 0.2] }} }}\nat = {{ x = 1.6, y = 0.6 }}\n\
         driven = {{ along = [1.0, 0.0], distance = {{ formula = \"0\" }} }}\n\
         [[line_type]]\nname = \"c\"\ndiameter = 0.01\nmass_per_length = 0.6\nstiffness = 2e4\n\
         [[mooring]]\nname = \"m\"\nbetween = [\"b\"]\nfrom = [1.4, 0.5]\nto = [0.4, 0.2]\nlength = 1.3\nline = \"c\"\n"
    );
    let line = report(&text).moorings.remove(0);
    let [x, y] = line.touchdown_m.as_ref().expect("part of it lies")[..] else { panic!("{line:?}") };
    // A node on the bed lies within the radius of the line above it, and sinks by less than that.
    assert!(y.abs() < 0.011, "{x} m, {y} m: {line:?}");
    let node = line.shape_m.iter().position(|node| node[..] == [x, y]).expect("a node");
    assert!(node > 0 && line.shape_m[..node].iter().all(|above| above[1] > y), "the line falls to it: {line:?}");
}

#[test]
fn a_fixed_joint_that_breaks_by_the_torque_at_rest_is_told() {
    // 10 kg/m with an arm of 0.3 m: 29.43 N m/m.
    let text = |torque: f64| {
        let body = body("b", [0.2, 0.2], 250.0, "x = 0.5, y = 1.9");
        format!(
            "{WATER}{TANK}{body}[[joint]]\nname = \"j\"\nkind = \"fixed\"\nbetween = [\"b\"]\nat = [0.2, 1.9]\n\
             breaks = {{ torque = {torque} }}\n"
        )
    };
    let found = finding(&text(25.0), "breaks_at_rest");
    assert!(found.what.contains("it has 29.4 N m/m then and bears 25 N m/m"), "{}", found.what);
    assert!(found.mend.contains("torque = 30"), "{}", found.mend);
    has_no(&text(30.0), "breaks_at_rest");
}

#[test]
fn the_torque_of_a_joint_at_rest_is_that_of_the_water_around_its_bodies() {
    // Two bodies afloat at their own drafts load the joint between them by nothing, also with higher water in another tank.
    let boxes =
        [("a", 0.8), ("b", 1.2)].map(|(name, x)| body(name, [0.2, 0.2], 500.0, &format!("x = {x}, y = 0.6"))).concat();
    let water = WATER.replace("} } }]", "} } }, { fill = { box = { min = [3.0, 0.0], max = [3.4, 1.0] } } }]");
    let other =
        "[[solid]]\nname = \"other\"\nfixed = true\nshape = { tank = { size = [0.4, 1.4] } }\nat = [3.0, 0.0]\n";
    let joint = "[[joint]]\nname = \"j\"\nkind = \"fixed\"\nbetween = [\"a\", \"b\"]\nat = [1.0, 0.6]\nbreaks = { torque = 5.0 }\n";
    has_no(&format!("{water}{TANK}{boxes}{other}{joint}"), "breaks_at_rest");
}

#[test]
fn water_without_walls_on_a_side_or_above_them_is_a_warning() {
    let tank = |height: f64| TANK.replace("1.0]", &format!("{height:?}]"));
    let side = "[[solid]]\nname = \"t\"\nfixed = true\nshape = { polyline = [[0.0, 1.0], [0.0, 0.0], [2.0, 0.0]] }\n";
    let bed = "[[solid]]\nname = \"bed\"\nfixed = true\nshape = { box = { size = [3.0, 0.2] } }\nat = { x = 1.0, y = -0.1 }\n";
    for (solids, place) in [(tank(0.4), "0.4"), (side.into(), "x = 2 m"), (bed.into(), "m high")] {
        let found = finding(&format!("{WATER}{solids}"), "open_side");
        assert!(found.severity == Severity::Warning && found.what.contains(place), "{solids}: {}", found.what);
    }
    has_no(&format!("{WATER}{TANK}"), "open_side");
    // Faces and periodic sides hold the water too.
    let ends = "inflow = [{ x = 0.0, velocity = 0.1 }]\noutflow = [{ x = 2.0, velocity = 0.1 }]\n";
    let long = bed.replace("[3.0", "[6.0");
    for ends in [ends, "periodic = { x = [0.0, 2.0] }\n"] {
        has_no(&format!("{ends}{WATER}{long}"), "open_side");
    }
    // A column of water that collapses in a tank has a wall before it.
    has_no(&format!("{}{TANK}", WATER.replace("max = [2.0", "max = [0.5")), "open_side");
}

#[test]
fn gravity_that_points_upwards_is_a_warning() {
    let found = finding(&format!("gravity = [0.0, 9.81]\n{WATER}{TANK}"), "gravity_direction");
    assert!(found.severity == Severity::Warning && found.mend == "write  gravity = [0.0, -9.81]", "{found:?}");
    has_no(&format!("gravity = [0.0, -9.81]\n{WATER}{TANK}"), "gravity_direction");
    has_no(&format!("gravity = [9.81, 0.0]\n{WATER}{TANK}"), "gravity_direction");
}

#[test]
fn water_at_rest_beside_faces_with_a_current_is_a_warning() {
    let text = |current: &str, water: &str| {
        format!(
            "inflow = [{{ x = 0.0, velocity = 0.8{current} }}]\noutflow = [{{ x = 2.0, velocity = 0.8{current} }}]\n{}\
             [[solid]]\nname = \"bed\"\nfixed = true\nshape = {{ box = {{ size = [6.0, 0.2] }} }}\nat = {{ x = 1.0, y = -0.1 }}\n",
            WATER.replace("} } }]", &format!("}} }}{water} }}]"))
        )
    };
    let found = finding(&text("", ""), "resting_water");
    // 0.8 m/s √(0.6 m / 9.81 m/s²).
    assert!(found.severity == Severity::Warning && found.what.contains("0.198 m high"), "{}", found.what);
    assert!(found.mend.contains("velocity = [0.8, 0.0]"), "{}", found.mend);
    has_no(&text("", ", velocity = [0.8, 0.0]"), "resting_water");
    has_no(&text(", factor = \"t\"", ""), "resting_water");
}

#[test]
fn an_outflow_that_absorbs_is_told_to_stop_by_itself() {
    let text = |absorb: &str| {
        format!(
            "outflow = [{{ x = 2.0, velocity = 0.1{absorb} }}]\n{WATER}\
             [[solid]]\nname = \"bed\"\nfixed = true\nshape = {{ box = {{ size = [6.0, 0.2] }} }}\nat = {{ x = 1.0, y = -0.1 }}\n\
             [[solid]]\nname = \"w\"\nfixed = true\nshape = {{ box = {{ size = [0.2, 1.0] }} }}\nat = {{ x = -0.1, y = 0.5 }}\n"
        )
    };
    let found = finding(&text(""), "unequal_discharges");
    assert!(found.what.contains("0.06 m²/s to leave; \"outflow\" absorbs"), "{}", found.what);
    assert!(found.mend.starts_with("absorb = false  keeps the discharge of \"outflow\""), "{}", found.mend);
    let exact = finding(&text(", absorb = false"), "unequal_discharges");
    assert!(!exact.what.contains("absorbs") && !exact.mend.contains("absorb"), "{exact:?}");
}

#[test]
fn a_body_as_dense_as_the_water_is_neutral() {
    for at in ["x = 1.0, y = 0.3", "x = 1.0, y = 0.3, angle_deg = 37.0"] {
        for size in [[0.4, 0.2], [0.4, 0.006]] {
            let found = report(&format!("{WATER}{TANK}{}", body("b", size, 1000.0, at)));
            assert_eq!(found.bodies[0].support, "neutral", "{size:?} at {at}");
            assert!(found.bodies[0].afloat.is_none() && find(&found, "hull_floods").is_none(), "{:?}", found.findings);
        }
    }
}

/// A ring of chords has a metacentric height of a few thousandths of its size, of either sign: it does not turn over.
#[test]
fn a_body_that_comes_to_rest_after_a_small_turn_does_not_turn_over() {
    let corner = |k: usize| {
        let angle = std::f64::consts::TAU * k as f64 / 24.0;
        format!("[{:.4}, {:.4}]", 0.25 * angle.cos(), 0.25 * angle.sin())
    };
    let points = (0..24).map(corner).collect::<Vec<_>>().join(", ");
    let found = report(&format!(
        "{WATER}{TANK}[[solid]]\nname = \"b\"\nshape = {{ polyline = {{ points = [{points}], thickness = 0.02, closed = true }} }}\n\
         at = {{ x = 1.0, draft = \"equilibrium\" }}\nfree = {{ density = 2000.0 }}\n"
    ));
    assert!(find(&found, "capsizes").is_none(), "{:#?}", found.findings);
}

#[test]
fn ballast_far_out_is_told_to_come_nearer() {
    let free = "free = { density = 400.0, ballast = [{ at = [3.0, 0.0], mass = \"5\" }] }";
    let text =
        body("b", [0.6, 0.3], 400.0, "x = 1.0, draft = \"equilibrium\"").replace("free = { density = 400 }", free);
    assert!(text.contains("ballast"), "{text}");
    let found = finding(&format!("{WATER}{TANK}{text}"), "large_inertia");
    assert_eq!(found.mend, "place its ballast nearer to it");
}

#[test]
fn a_body_that_carries_another_is_told() {
    let raft = body("raft", [0.6, 0.2], 300.0, "x = 1.0, draft = 0.1");
    let crate_on_it = body("crate", [0.2, 0.2], 600.0, "x = 1.0, bottom = 0.7");
    let found = report(&format!("{WATER}{TANK}{raft}{crate_on_it}"));
    assert_eq!((found.bodies[0].support, found.bodies[1].support), ("water", "solid"));
    let note = find(&found, "carried_body").expect("the crate stands on the raft");
    assert!(note.what.contains("\"crate\" stands on \"raft\""), "{}", note.what);
    // A stone that falls into the water sinks.
    let stone = report(&format!("{WATER}{TANK}{}", body("stone", [0.2, 0.2], 2000.0, "x = 1.0, bottom = 0.7")));
    assert_eq!(stone.bodies[0].support, "bottom");
}

#[test]
fn water_of_a_hull_off_the_lattice_or_above_its_rim_is_told() {
    // The floor at 0.45 m lies midway between two rows, and the rim at 0.95 m.
    let text = |top: f64, floor: f64| {
        format!(
            "dimension = 2\ndp = 0.02\nuntil = 1.0\nframes = \"off\"\n\
             [[water]]\nfill = {{ box = {{ min = [0.0, 0.0], max = [2.0, 0.6] }} }}\n\
             [[water]]\ninside = \"d\"\nfill = {{ box = {{ min = [0.5, 0.0], max = [1.5, {top}] }} }}\n{TANK}\
             [[solid]]\nname = \"d\"\nshape = {{ tank = {{ size = [1.0, 0.5], thickness = 0.1 }} }}\n\
             at = {{ x = 0.5, y = {floor} }}\ndry = true\nfree = {{ density = 400.0 }}\n"
        )
    };
    let over = finding(&text(1.2, 0.45), "hull_floods");
    assert!(over.what.contains("given to 1.2 m, above its rim at 0.9"), "{}", over.what);
    let off = finding(&text(1.2, 0.45), "surface_off_lattice");
    assert!(off.what.contains("kg, and its level gives 500 kg"), "{}", off.what);
    has_no(&text(0.8, 0.44), "surface_off_lattice");
    has_no(&text(0.8, 0.44), "hull_floods");
}

#[test]
fn an_equilibrium_draft_beside_a_load_that_a_joint_lets_through_is_noted() {
    let float = body("b", [0.8, 0.3], 300.0, "x = 1.0, draft = \"equilibrium\", angle_deg = 0.0");
    let hinge = "[[joint]]\nname = \"j\"\nkind = \"hinge\"\nbetween = [\"b\"]\nat = [0.6, 0.6]\n";
    let force = "[[force]]\nname = \"f\"\non = \"b\"\nforce = [0.0, -300.0]\n";
    let found = finding(&format!("{WATER}{TANK}{float}{hinge}{force}"), "off_draft");
    // 300 N/m.
    assert!(found.what.contains("without the load of 30.6 kg") && found.what.contains("\"j\""), "{}", found.what);
    has_no(&format!("{WATER}{TANK}{float}{hinge}"), "off_draft");
    has_no(&format!("{WATER}{TANK}{float}{}{force}", hinge.replace("hinge", "fixed")), "off_draft");
}

/// A float of 72 kg/m and 0.8 m² per metre of draft on a guide at 30°. A level force of 100 N/m lifts it by 100 cot 30° N/m, 17.66 kg/m; so
/// does one along an axis of a float that starts turned by 180°, with the opposite sign.
#[test]
fn an_equilibrium_draft_on_an_inclined_guide_includes_what_the_guide_lets_through() {
    let float = |more: &str| body("b", [0.8, 0.3], 300.0, &format!("x = 1.0, draft = \"equilibrium\"{more}"));
    let guide = "[[joint]]\nname = \"j\"\nkind = \"slider\"\nbetween = [\"b\"]\nat = [1.0, 0.6]\nalong = [0.8660254037844386, 0.5]\n";
    let force = "[[force]]\nname = \"f\"\non = \"b\"\nforce = [100.0, 0.0]\n";
    let lift = 100.0 * 3f64.sqrt() / 9.81;
    for (more, frame, load) in [("", "", -lift), (", angle_deg = 180.0", "frame = \"body\"\n", lift)] {
        let text = format!("{WATER}{TANK}{}{guide}{force}{frame}", float(more));
        let (found, exact) = (report(&text).bodies.remove(0), (72.0 + load) / 800.0);
        assert!((found.draft_m - exact).abs() < 1e-9, "{} m for {exact} m", found.draft_m);
        assert!((found.afloat.unwrap().draft_m - exact).abs() < 1e-9);
        has_no(&text, "off_draft");
    }
}

/// A buoy of 60 kg/m that displaces 120 kg/m floats alone with a draft of 0.1 m. A rope of 0.3 m to the bed, 0.6 m below the level, holds
/// its lower side at 0.3 m, with the whole of it under water: 60 g N/m.
#[test]
fn a_rope_to_the_bed_tells_its_tension_and_the_turn_to_rest() {
    let buoy = body("b", [0.6, 0.2], 500.0, "x = 1.0, bottom = 0.2");
    let rope = |from: f64, length: f64| {
        format!("[[rope]]\nname = \"r\"\nbetween = [\"b\"]\nfrom = [{from}, 0.2]\nto = [1.0, 0.0]\nlength = {length}\n")
    };
    let found = report(&format!("{WATER}{TANK}{buoy}{}", rope(1.0, 0.3)));
    assert!((found.bodies[0].load_kg - 60.0).abs() < 0.01 && found.bodies[0].support == "lines", "{:?}", found.bodies);
    assert!(find(&found, "lists").is_none(), "{:#?}", found.findings);
    // A square one, made fast at a corner, turns by 45°.
    let square = body("b", [0.2, 0.2], 500.0, "x = 1.0, bottom = 0.2");
    let turned = finding(&format!("{WATER}{TANK}{square}{}", rope(1.1, 0.3)), "lists").what;
    assert!(turned.contains("\"b\" by 45°"), "{turned}");
    // Long enough, it is slack, and the buoy floats as alone.
    let slack = report(&format!("{WATER}{TANK}{buoy}{}", rope(1.0, 0.55)));
    let free = slack.bodies[0].afloat.as_ref().unwrap().free_joints.as_ref().unwrap();
    assert!(free.tensions_n[0].1 == 0.0 && (free.drafts_m[0].1 - 0.1).abs() < 1e-6, "{free:?}");
}

/// The loads of dry walls of 1, 1.5 and 2 dp that a tester measured.
#[test]
fn a_thin_dry_wall_is_told_with_the_error_of_its_load() {
    let wall = |thickness: f64| {
        format!(
            "{WATER}{TANK}[[solid]]\nname = \"w\"\nfixed = true\nshape = {{ box = {{ size = [{thickness}, 0.8] }} }}\n\
             at = {{ x = 1.0, bottom = 0.0 }}\n"
        )
    };
    for (thickness, error) in [(0.02, "up to 40 %"), (0.03, "by 2 %")] {
        let found = finding(&wall(thickness), "thin_wall");
        assert!(found.what.contains(error), "{thickness} m: {}", found.what);
    }
    assert!(!finding(&wall(0.04), "thin_wall").what.contains('%'));
}

/// A raft of 36 kg/m and 0.6 m² per metre of draft with a crate of 12 kg/m: 48 kg/m need a draft of 0.08 m, the raft alone 0.06 m.
#[test]
fn a_raft_with_a_crate_on_its_deck_has_the_draft_of_both_weights() {
    let raft = |draft: &str| body("raft", [0.6, 0.2], 300.0, &format!("x = 1.0, draft = {draft}"));
    let crate_on_it = |bottom: f64| body("crate", [0.2, 0.1], 600.0, &format!("x = 1.0, bottom = {bottom}"));
    let found = |raft: &str, bottom: f64| report(&format!("{WATER}{TANK}{raft}{}", crate_on_it(bottom)));
    let draft = |found: &Preflight| found.bodies[0].afloat.as_ref().map_or(0.0, |afloat| afloat.draft_m);
    // The deck of both lies at 0.6 + 0.2 − 0.08 m. The bisection stops at 1e-14 of the height of the raft.
    let both = found(&raft("\"equilibrium\""), 0.72);
    assert!((both.bodies[0].draft_m - 0.08).abs() < 1e-9 && (draft(&both) - 0.08).abs() < 1e-9, "{:?}", both.bodies[0]);
    assert!(find(&both, "carried_body").expect("noted").what.contains("those of both"));
    assert!(find(&both, "off_draft").is_none(), "{:#?}", both.findings);
    // The same with the crate before its raft, and with two crates of half its height on one another.
    let upside_down = report(&format!("{WATER}{TANK}{}{}", crate_on_it(0.72), raft("\"equilibrium\"")));
    assert!((upside_down.bodies[1].draft_m - 0.08).abs() < 1e-9, "{:?}", upside_down.bodies[1]);
    let half = |name: &str, bottom: f64| body(name, [0.2, 0.05], 600.0, &format!("x = 1.0, bottom = {bottom}"));
    let stack = format!("{WATER}{TANK}{}{}{}", raft("\"equilibrium\""), half("upper", 0.77), half("lower", 0.72));
    assert!((report(&stack).bodies[0].draft_m - 0.08).abs() < 1e-9, "{:?}", report(&stack).bodies[0]);
    // A crate 5 dp above the deck falls: the raft starts at its own draft. So it does if only one of two crates stands.
    let falls = found(&raft("\"equilibrium\""), 0.84);
    assert!((falls.bodies[0].draft_m - 0.06).abs() < 1e-9, "{:?}", falls.bodies[0]);
    let one_falls = format!("{WATER}{TANK}{}{}{}", raft("\"equilibrium\""), crate_on_it(0.72), half("above", 0.95));
    assert!((report(&one_falls).bodies[0].draft_m - 0.08).abs() < 1e-9, "{:?}", report(&one_falls).bodies[0]);
    // On a raft at its own draft, inspect has the draft at which both rest.
    let alone = found(&raft("0.06"), 0.74);
    assert!((draft(&alone) - 0.08).abs() < 1e-9, "{:?}", alone.bodies[0]);
    // BM = B³/(12 V) = 0.6³/(12 0.048), above KB = 0.04 m; the centre of mass of both is at (36 0.1 + 12 0.25)/48 m above the keel.
    let centre = (36.0 * 0.1 + 12.0 * 0.25) / 48.0;
    let gm = 0.216 / (12.0 * 0.048) + 0.04 - centre;
    let afloat = both.bodies[0].afloat.as_ref().expect("afloat");
    // The finite turn from which the restoring moment is taken changes it by 1e-8.
    assert!((afloat.tilts[0].gm_m / gm - 1.0).abs() < 1e-6, "{} m for {gm} m", afloat.tilts[0].gm_m);
    // 48 kg/m heave on 0.6 m and roll with the inertia of both about their centre, I = Σ m ((b² + h²)/12 + r²).
    let heave = std::f64::consts::TAU * (48.0 / (1000.0 * 9.81 * 0.6f64)).sqrt();
    assert!((afloat.heave_s / heave - 1.0).abs() < 1e-6, "{} s for {heave} s", afloat.heave_s);
    let inertia = 36.0 * ((0.36 + 0.04) / 12.0 + (centre - 0.1).powi(2))
        + 12.0 * ((0.04 + 0.01) / 12.0 + (0.25 - centre).powi(2));
    let roll = std::f64::consts::TAU * (inertia / (48.0 * 9.81 * gm)).sqrt();
    assert!((afloat.tilts[0].period_s.expect("stable") / roll - 1.0).abs() < 1e-6, "{:?} for {roll} s", afloat.tilts);
}

#[test]
fn a_gangway_between_a_raft_and_a_quay_is_told_as_not_counted() {
    let raft = body("raft", [0.6, 0.2], 300.0, "x = 0.7, draft = \"equilibrium\"");
    let quay = "[[solid]]\nname = \"quay\"\nfixed = true\nshape = { box = { size = [0.4, 0.74] } }\nat = { x = 1.5, bottom = 0.0 }\n";
    let gangway = body("gangway", [0.8, 0.04], 600.0, "x = 1.1, bottom = 0.74");
    let found = report(&format!("{WATER}{TANK}{raft}{quay}{gangway}"));
    assert!((found.bodies[0].draft_m - 0.06).abs() < 1e-9, "{:?}", found.bodies[0]);
    let note = find(&found, "carried_body").expect("noted");
    assert!(
        note.what.contains("\"gangway\" stands on \"raft\", whose draft and GM are given without"),
        "{}",
        note.what
    );
}

#[test]
fn bodies_that_displace_the_same_water_are_told_with_its_volume() {
    let hull = body("hull", [0.6, 0.2], 300.0, "x = 1.0, draft = 0.1");
    let keel = |bottom: f64| body("keel", [0.1, 0.3], 800.0, &format!("x = 1.0, bottom = {bottom}"));
    let joint = "[[joint]]\nname = \"j\"\nkind = \"fixed\"\nbetween = [\"hull\", \"keel\"]\nat = [1.0, 0.5]\n";
    // The keel reaches from 0.26 to 0.56 m, the hull from 0.5 m: they have 0.1 m by 0.06 m in common below 0.6 m.
    let note = finding(&format!("{WATER}{TANK}{hull}{}{joint}", keel(0.26)), "overlapping_bodies");
    assert!(
        note.what.contains("\"hull\" and \"keel\" have 0.006 m² below") && note.what.contains("6 kg"),
        "{}",
        note.what
    );
    has_no(&format!("{WATER}{TANK}{hull}{}{joint}", keel(0.2)), "overlapping_bodies");
    // A mast in the dry hold of a hull has no water around it, and displaces none.
    let tub = "[[solid]]\nname = \"tub\"\nshape = { tank = { size = [0.6, 0.4], thickness = 0.1 } }\nat = { x = 0.7, y = 0.5 }\n\
               dry = true\nfree = { density = 400.0 }\n";
    let mast = body("mast", [0.1, 0.4], 100.0, "x = 1.0, bottom = 0.5");
    has_no(&format!("{WATER}{TANK}{tub}{mast}"), "overlapping_bodies");
}

/// A shape in a tank of water, free at its draft.
fn floating(shape: &str, more: &str) -> String {
    format!(
        "{WATER}{TANK}[[solid]]\nname = \"b\"\nshape = {shape}\nat = {{ x = 1.0, draft = 0.2 }}\nfree = {{ density = 500.0 }}\n{more}"
    )
}

#[test]
fn thin_parts_that_lie_flat_against_each_other_are_told() {
    let slabs = |count: usize, thickness: f64| {
        let part = |i| {
            format!(
                "{{ shape = {{ box = {{ size = [0.4, {thickness}] }} }}, at = {{ y = {} }} }}",
                i as f64 * thickness
            )
        };
        floating(&format!("{{ compound = [{}] }}", (0..count).map(part).collect::<Vec<_>>().join(", ")), "")
    };
    assert!(finding(&slabs(10, 0.018), "stacked_parts").what.starts_with("10 parts of \"b\""));
    has_no(&slabs(9, 0.02), "stacked_parts");
    // A keel touches its hull with an edge.
    let keel = "{ compound = [{ shape = { box = { size = [0.4, 0.2] } } }, { shape = { box = { size = [0.01, 0.1] } }, at = { y = -0.15 } }] }";
    has_no(&floating(keel, ""), "stacked_parts");
}

/// Water does not fill gaps between faces of one solid that are narrower than the kernel's reach, 3.4 dp, just as between two solids:
/// such a body turned by 3° for no reason. A gap of 0.75 dp holds no particle.
#[test]
fn a_narrow_gap_between_faces_of_one_solid_is_found() {
    let two = |gap: f64| {
        let part = |y: f64| format!("{{ shape = {{ box = {{ size = [0.4, 0.1] }} }}, at = {{ y = {y} }} }}");
        format!("{{ compound = [{}, {}] }}", part(0.0), part(0.1 + gap))
    };
    let neck = "{ polygon = [[-0.2, 0.0], [0.2, 0.0], [0.2, 0.1], [0.005, 0.1], [0.005, 0.115], [0.2, 0.115], [0.2, 0.3], \
                [-0.2, 0.3], [-0.2, 0.115], [-0.005, 0.115], [-0.005, 0.1], [-0.2, 0.1]] }";
    let slot = "{ polygon = [[-0.2, 0.0], [0.2, 0.0], [0.2, 0.3], [0.02, 0.3], [0.02, 0.05], [-0.02, 0.05], [-0.02, 0.3], \
                [-0.2, 0.3]] }";
    for (shape, words) in [
        (neck, ["0.015 m apart at [", "0.75 dp", "no water particle fits"]),
        (&two(0.008), ["0.008 m apart at [", "0.4 dp", "no water particle fits"]),
        (&two(0.03), ["0.03 m apart at [", "1.5 dp", "is not resolved"]),
        (slot, ["0.04 m apart at [1, ", "2 dp", "is not resolved"]),
    ] {
        let found = finding(&floating(shape, ""), "narrow_gap");
        assert_eq!(found.severity, Severity::Warning);
        words.iter().for_each(|word| assert!(found.what.contains(word), "{word}: {}", found.what));
    }
    // Between walls: of a channel and of a tank.
    let channel = "{ polyline = { points = [[0.2, 0.6], [0.2, 0.1], [0.25, 0.1], [0.25, 0.6]] } }";
    let well = "{ tank = { size = [0.05, 0.5] } }";
    for shape in [channel, well] {
        let walls = format!("{WATER}{TANK}[[solid]]\nname = \"b\"\nfixed = true\nshape = {shape}\nat = [0.6, 0.1]\n");
        assert!(finding(&walls, "narrow_gap").what.contains("0.05 m apart at ["), "{shape}");
        has_no(&walls.replace("0.25", "0.27").replace("[0.05, 0.5]", "[0.07, 0.5]"), "narrow_gap");
    }
    // 0.068 m is the reach; parts that touch have no gap; a hollow that stays dry holds no water; above the level there is none.
    has_no(&floating(&two(0.07), ""), "narrow_gap");
    has_no(&floating(&two(0.0), ""), "narrow_gap");
    has_no(&floating(slot, "dry = true\n"), "narrow_gap");
    has_no(&floating(&two(0.03), "").replace("draft = 0.2", "bottom = 0.65"), "narrow_gap");
    let notch =
        "{ polygon = [[-0.2, 0.0], [0.2, 0.0], [0.2, 0.3], [0.15, 0.3], [0.0, 0.1], [-0.15, 0.3], [-0.2, 0.3]] }";
    has_no(&floating(notch, ""), "narrow_gap");
}

/// A probe in the solid that carries it read the pressure 0 without a word, and a gauge through a floating body the height of its bottom.
#[test]
fn probes_in_the_solid_that_carries_them_are_found() {
    let shape = "{ box = { size = [0.4, 0.3] } }";
    let probe = |words: &str| floating(shape, &format!("[[probe]]\n{words}\n"));
    for (words, place) in [
        ("pressure = [0.05, 0.0]\non = \"b\"", "at [0.05, 0] m on \"b\" is inside solid \"b\""),
        (
            "velocity = { from = [0.0, -0.1], to = [0.0, -0.4], count = 2 }\non = \"b\"",
            "at [0, -0.1] m on \"b\" is inside",
        ),
        ("pressure = [1.0, -0.02]\non = \"tank\"", "at [1, -0.02] m on \"tank\" is inside solid \"tank\""),
    ] {
        let found = finding(&probe(words), "probe_inside_solid");
        assert!(found.severity == Severity::Warning && found.what.contains(place), "{}", found.what);
    }
    // In the frame of the body, whose middle is at 0.55 m: the water under its bottom.
    let found = finding(&probe("pressure = [0.05, 0.0]\non = \"b\""), "probe_inside_solid");
    assert_eq!(found.mend, "the nearest water is at [0.05, -0.16] m on \"b\"");
    for words in ["pressure = [0.0, -0.15]\non = \"b\"", "pressure = [0.3, 0.0]\non = \"b\""] {
        has_no(&probe(words), "probe_inside_solid");
    }
    for words in ["elevation = { x = 0.1, on = \"b\" }", "elevation = { x = 0.95 }"] {
        let found = finding(&probe(words), "gauge_under_solid");
        assert!(found.severity == Severity::Note && found.what.contains("stands in solid \"b\""), "{}", found.what);
    }
    for words in
        ["elevation = { x = 0.3, on = \"b\" }", "elevation = { x = 0.3 }", "elevation = { x = 1.0, on = \"tank\" }"]
    {
        let found = report(&probe(words));
        let is_under = find(&found, "gauge_under_solid").is_some();
        assert_eq!(is_under, words.contains("tank"), "{words}: {:#?}", found.findings);
    }
}

/// A body above the water that something holds to the end does not strike the water; one that is released does.
#[test]
fn the_fall_of_a_body_ends_where_joints_and_solids_hold_it() {
    let body = |more: &str| {
        let own = "[[solid]]\nname = \"b\"\nshape = { box = { size = [0.4, 0.4] } }\nat = { x = 1.0, y = 2.0 }\n";
        format!("{WATER}{TANK}{own}free = {{ density = 500.0 }}\n{more}")
    };
    let joint = |words: &str| body(&format!("[[joint]]\nname = \"j\"\nbetween = [\"b\"]\n{words}\n"));
    let table = "[[solid]]\nname = \"table\"\nfixed = true\nshape = { box = { size = [0.6, 0.2] } }\n";
    let on = |x: f64, more: &str| body(&format!("{table}at = {{ x = {x}, y = 1.7 }}\n{more}"));
    let locked = |words: &str| body("").replace("density = 500.0", &format!("density = 500.0, {words}"));
    for text in [
        joint("kind = \"fixed\"\nat = [1.0, 2.0]"),
        joint("kind = \"hinge\"\nat = [1.0, 2.0]"),
        joint("kind = \"slider\"\nalong = [1.0, 0.0]\nat = [1.0, 2.0]"),
        on(1.0, ""),
        locked("locked = [\"y\"]"),
        locked("release = 5.0"),
        body("").replace("x = 1.0, y = 2.0", "x = 5.0, y = 2.0"),
    ] {
        has_no(&text, "slow_sound");
    }
    for text in [
        body(""),
        joint("kind = \"fixed\"\nat = [1.0, 2.0]\nuntil = 0.5"),
        // The middle of the body falls by 2 m about the hinge below it, and the water is 1.2 m under the body.
        joint("kind = \"hinge\"\nat = [1.0, 1.0]"),
        joint("kind = \"slider\"\nalong = [0.0, 1.0]\nat = [1.0, 2.0]"),
        on(1.4, ""),
        on(1.0, "until = 0.5\n"),
        locked("release = 0.5"),
        body("[[rope]]\nname = \"r\"\nbetween = [\"b\"]\nfrom = [1.0, 2.2]\nto = [1.0, 3.0]\nuntil = 0.5\n"),
    ] {
        assert!(finding(&text, "slow_sound").what.contains("\"b\" after a fall"), "{text}");
    }
}

/// A bar 1 m from its hinge with a spin of 1 rad/s and no velocity: the point on the hinge has 1 m/s.
#[test]
fn a_motion_at_the_start_that_a_joint_forbids_is_a_warning() {
    let scene = |joint: &str, motion: &str| {
        format!(
            "{WATER}{TANK}[[solid]]\nname = \"b\"\nshape = {{ box = {{ size = [0.4, 0.2] }} }}\nat = [4.0, 2.0]\n\
             free = {{ mass = 50.0, {motion} }}\n[[joint]]\nname = \"j\"\nbetween = [\"b\"]\nat = [3.0, 2.0]\n{joint}\n"
        )
    };
    let hinge = "kind = \"hinge\"";
    let found = finding(&scene(hinge, "spin = 1.0"), "forbidden_motion");
    assert!(found.severity == Severity::Warning, "{found:?}");
    assert!(["\"b\"", "\"j\"", "takes away 1 m/s"].iter().all(|part| found.what.contains(part)), "{}", found.what);
    // v = ω × r along y, with r = 1 m.
    assert!(found.mend.contains("velocity = [0, 1]"), "{}", found.mend);
    let slider = "kind = \"slider\"\nalong = [1.0, 0.0]";
    let found = finding(&scene(slider, "velocity = [1.0, 0.5], spin = 0.2"), "forbidden_motion");
    assert!(found.what.contains("0.3 m/s and 0.2 rad/s"), "{}", found.what);
    for (joint, motion) in [
        (hinge, "spin = 1.0, velocity = [0.0, 1.0]"),
        // 0.9 % of the speed.
        (hinge, "spin = 1.0, velocity = [0.0, 1.018]"),
        (slider, "velocity = [1.0, 0.0]"),
        ("kind = \"hinge\"\nsince = 0.5", "spin = 1.0"),
    ] {
        has_no(&scene(joint, motion), "forbidden_motion");
    }
}

#[test]
fn a_section_that_a_symmetry_plane_cuts_has_water() {
    let scene = |probe: &str| format!("symmetry = {{ x = 1.0 }}\n{WATER}{TANK}[[probe]]\n{probe}\n");
    has_no(&scene("flow = { from = [0.5, 0.3], to = [1.5, 0.3] }"), "probe_outside");
    finding(&scene("flow = { from = [0.2, 0.3], to = [0.5, 0.3] }"), "probe_outside");
}

#[test]
fn a_gauge_beyond_a_periodic_side_is_a_warning() {
    let bed = "[[solid]]\nname = \"bed\"\nfixed = true\nshape = { box = { size = [6.0, 0.2] } }\nat = { x = 1.0, y = -0.1 }\n";
    let scene = |probe: &str| format!("periodic = {{ x = [0.0, 2.0] }}\n{WATER}{bed}[[probe]]\n{probe}\n");
    for probe in ["elevation = { x = 2.5 }", "pressure = [2.5, 0.2]", "elevation = { x = -1.5 }"] {
        let found = finding(&scene(probe), "probe_outside");
        assert!(found.what.contains("beyond the periodic side") && found.mend.ends_with("x = 0.5"), "{found:?}");
    }
    has_no(&scene("elevation = { x = 2.0 }"), "probe_outside");
}

#[test]
fn a_gravity_to_a_side_needs_its_pressure_at_the_start() {
    let closed = "[[solid]]\nname = \"t\"\nfixed = true\n\
                  shape = { polyline = { points = [[0.0, 0.0], [2.0, 0.0], [2.0, 0.6], [0.0, 0.6]], closed = true } }\n";
    let scene = |gravity: &str, pressure: &str| {
        format!(
            "gravity = {gravity}\n{}[model]\nc0 = 40.0\n{closed}",
            WATER.replace("} } }]", &format!("}} }}{pressure} }}]"))
        )
    };
    let found = finding(&scene("[9.81, 0.0]", ""), "sideways_gravity");
    // 1000 kg/m³ × 9.81 m/s² × 2 m
    assert!(found.what.contains("along x") && found.what.contains("19620 Pa"), "{}", found.what);
    has_no(&scene("[9.81, 0.0]", ", pressure = \"9810*x\""), "sideways_gravity");
    has_no(&scene("[0.0, -9.81]", ""), "sideways_gravity");
    // In a periodic channel gravity drives a current.
    let channel = format!("gravity = [9.81, 0.0]\nperiodic = {{ x = [0.0, 2.0] }}\n{WATER}[model]\nc0 = 40.0\n");
    has_no(&channel, "sideways_gravity");
}

/// Walls take the water of a closed tank along with a towed frame: nothing flows past what stands in it.
#[test]
fn a_towed_closed_tank_has_no_current() {
    let towed = "towed = { along = \"x\", velocity = \"0.3*t\" }\n";
    let post = "[[solid]]\nname = \"post\"\nfixed = true\nshape = { box = { size = [0.2, 0.6] } }\nat = { x = 1.0, y = 0.6 }\n";
    has_no(&format!("{towed}{WATER}{TANK}{post}"), "slow_current");
    let bed = "[[solid]]\nname = \"bed\"\nfixed = true\nshape = { box = { size = [6.0, 0.2] } }\nat = { x = 1.0, y = -0.1 }\n";
    finding(&format!("{towed}periodic = {{ x = [0.0, 2.0] }}\n{WATER}{bed}{post}"), "slow_current");
}

/// The first of two overlapping bodies of water has the water of both: a column on the floor stands on no layer that follows it, and on
/// one that precedes it. Water of a hull counts in the numbers.
#[test]
fn water_stands_on_other_water_only_where_that_is_below_it() {
    let water = |max: [f64; 2]| format!("[[water]]\nfill = {{ box = {{ min = [0.0, 0.0], max = {max:?} }} }}\n");
    let (column, layer) = (water([0.3, 0.5]), water([2.0, 0.1]));
    let start = "dimension = 2\ndp = 0.02\nuntil = 1.0\nframes = \"off\"\n";
    let hull = "[[solid]]\nname = \"hull\"\nfixed = true\nshape = { tank = { size = [0.4, 0.4] } }\nat = [1.0, 0.5]\n";
    let hold = "[[water]]\ninside = \"hull\"\nfill = { box = { min = [1.0, 0.5], max = [1.4, 0.7] } }\n";
    has_no(&format!("{start}{column}{layer}{TANK}"), "stacked_water");
    let found = finding(&format!("{start}{hold}{layer}{column}{TANK}{hull}"), "stacked_water");
    assert!(found.what.starts_with("water.2 stands to 0.5 m on water.1"), "{}", found.what);
}

/// A gauge on a face reads the level of the water in front of it.
#[test]
fn gauges_on_faces_stand_in_no_solid() {
    let wall = "[[solid]]\nname = \"wall\"\nfixed = true\nshape = { box = { size = [0.1, 1.0] } }\nat = { x = 0.35, bottom = 0.0 }\n";
    let gauges =
        |xs: &[f64]| -> String { xs.iter().map(|x| format!("[[probe]]\nelevation = {{ x = {x:?} }}\n")).collect() };
    has_no(&format!("{WATER}{TANK}{wall}{}", gauges(&[0.0, 0.3, 0.4, 2.0])), "probe_inside_solid");
    finding(&format!("{WATER}{TANK}{wall}{}", gauges(&[0.35])), "probe_inside_solid");
}

/// The buffers beyond faces do not count as water at rest in the frame.
#[test]
fn water_at_rest_over_the_ground_passes_a_carriage_between_faces_without_a_note() {
    let river = |speed: f64| {
        format!(
            "dimension = 2\ndp = 0.02\nuntil = 1.0\ntowed = {{ along = \"x\", velocity = 0.5 }}\n\
             inflow = [{{ x = 2.0, velocity = 0.5 }}]\noutflow = [{{ x = 0.0, velocity = 0.5 }}]\n\
             water = [{{ fill = {{ box = {{ min = [0.0, 0.0], max = [2.0, 0.3] }} }}, velocity = [{speed:?}, 0.0] }}]\n\
             [[solid]]\nname = \"bed\"\nfixed = true\nshape = {{ box = {{ size = [5.0, 0.1] }} }}\nat = [1.0, -0.05]\n"
        )
    };
    has_no(&river(-0.5), "towed_start");
    let found = finding(&river(-0.4), "towed_start");
    assert!(found.what.contains("the water at -0.4 m/s"), "{found:?}");
}

/// Water meets its image at a periodic side also where no solid reaches beyond the side.
#[test]
fn a_point_on_a_periodic_side_is_in_the_water() {
    let scene = |place: &str| {
        format!(
            "dimension = 2\ndp = 0.02\nuntil = 1.0\ngravity = 0.0\nperiodic = {{ x = [0.0, 1.0], y = [0.0, 0.4] }}\n\
             water = [{{ fill = {{ box = {{ min = [0.0, 0.0], max = [1.0, 0.4] }} }} }}]\nmodel = {{ c0 = 10.0 }}\n\
             probe = [{{ pressure = {place} }}]\n"
        )
    };
    has_no(&scene("[0.0, 0.2]"), "probe_outside");
    has_no(&scene("[0.5, 0.4]"), "probe_outside");
    finding(&scene("[1.2, 0.2]"), "probe_outside");
}

/// A solid fills the lowest part of the region of the water: its waves are made for the whole depth of the region, which is told.
#[test]
fn a_paddle_before_water_whose_region_reaches_into_the_bed_is_told_the_depth() {
    let flume = |bottom: f64| {
        format!(
            "dimension = 2\ndp = 0.02\nuntil = 5.0\n\
             water = [{{ fill = {{ box = {{ min = [0.0, {bottom:?}], max = [4.0, 0.3] }} }} }}]\n\
             [[solid]]\nname = \"bed\"\nfixed = true\nshape = {{ box = {{ size = [6.0, 0.3] }} }}\nat = [2.0, -0.15]\n\
             [[solid]]\nname = \"end\"\nfixed = true\nshape = {{ box = {{ size = [0.2, 0.6] }} }}\nat = [4.1, 0.3]\n\
             [[solid]]\nname = \"p\"\nshape = {{ box = {{ size = [0.1, 0.6] }} }}\nat = {{ x = -0.05, bottom = 0.0 }}\n\
             driven = {{ along = [1.0, 0.0], wave = {{ regular = {{ height = 0.05, period = 1.2 }} }} }}\n"
        )
    };
    has_no(&flume(0.0), "wrong_depth");
    let found = finding(&flume(-0.2), "wrong_depth");
    assert!(found.mend.contains("wave.depth = 0.3"), "{found:?}");
    assert!(find(&report(&flume(-0.2)), "lifted_paddle").is_none(), "the piston reaches the bed");
}
