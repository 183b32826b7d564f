//! Bodies with `draft = "equilibrium"` start at rest: turned, with taut ropes, together with all that is tied to them.

use std::path::Path;

use nalgebra::{Matrix3, Vector3};
use pontoon::{
    Result,
    math::{Pose, Vector},
    preflight::Preflight,
    scene::Scene,
    solid::{SolidSpec, hydrostatics::equilibrium_height},
};

use crate::common::{preflight_report, run_to, scene_simulation};

const G: f64 = 9.81;
const DP: f64 = 0.02;

/// A tank of 2.4 m with water 0.4 m deep, and the sections `more`.
fn flat(more: &str) -> String {
    format!(
        "dimension = 2\ndp = {DP}\nuntil = 10.0\nmodel.viscosity.artificial.alpha = 0.1\n\
         [[water]]\nfill = {{ box = {{ min = [0.0, 0.0], max = [2.4, 0.4] }} }}\n\
         [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = [2.4, 0.8] }} }}\n{more}"
    )
}

/// A box of this size at its equilibrium, with the role `free` and more keys of its place.
fn barge(name: &str, [wide, high]: [f64; 2], x: f64, free: &str, at: &str) -> String {
    format!(
        "[[solid]]\nname = \"{name}\"\nshape = {{ box = {{ size = [{wide}, {high}] }} }}\n\
         at = {{ x = {x}, draft = \"equilibrium\"{at} }}\nfree = {{ {free} }}\n"
    )
}

/// The solids of a scene at the start.
fn placed<const D: usize>(text: &str) -> Vec<SolidSpec<D>> {
    Scene::parse(text, Path::new(""), &[]).unwrap().layout::<D>().unwrap().solids
}

fn inspected(text: &str) -> Preflight {
    preflight_report(&Scene::parse(text, Path::new(""), &[]).unwrap())
}

fn tilt(solid: &SolidSpec<2>) -> f64 {
    solid.pose.rotation_vector()[0]
}

/// tan φ of a wall-sided box of this breadth at the `draft` (m), with its centre of mass `kg` above its keel and `aside` beside its middle:
/// tan φ (GM + ½ BM tan² φ) = aside.
fn wall_sided(breadth: f64, draft: f64, [aside, kg]: [f64; 2]) -> f64 {
    let bm = breadth * breadth / (12.0 * draft);
    let gm = 0.5 * draft + bm - kg;
    (0..200).fold(0.0, |tan: f64, _| aside / (gm + 0.5 * bm * tan * tan))
}

#[test]
fn a_box_with_ballast_beside_its_middle_starts_at_the_heel_of_a_wall_sided_box() {
    let free = "density = 500.0, ballast = [{ at = [0.1, -0.05], mass = 4.0 }]";
    let body = &placed::<2>(&flat(&barge("barge", [0.5, 0.2], 1.2, free, "")))[1];
    // 54 kg/m: 50 in the middle, and 4 at 0.1 m from it, 0.05 m above the keel.
    let draft = 54.0 / 500.0;
    let exact = wall_sided(0.5, draft, [4.0 * 0.1 / 54.0, (50.0 * 0.1 + 4.0 * 0.05) / 54.0]);
    // The search ends at steps of 1e-9 rad.
    assert!((tilt(body).tan() + exact).abs() < 1e-8, "{} for {}", tilt(body).tan(), -exact);
    // The waterline of a wall-sided box turns about its middle. The centre of mass keeps its horizontal place.
    let middle = body.pose.point(&Vector::from([0.0, draft - 0.1]));
    assert!((middle[1] - 0.4).abs() < 1e-9, "{middle}");
    let centre = body.initial_kinematics().centre;
    assert!((centre[0] - 1.2 - 4.0 * 0.1 / 54.0).abs() < 1e-9, "{centre}");
}

#[test]
fn two_hinged_barges_with_a_load_on_one_start_at_the_rest_of_both() {
    let (load, length, arm) = (0.05, 0.5, 0.3);
    let fore = barge(
        "fore",
        [length, 0.2],
        0.9,
        &format!("density = 500.0, ballast = [{{ at = [-0.2, 0.0], mass = {load} }}]"),
        "",
    );
    let aft = barge("aft", [length, 0.2], 1.5, "density = 500.0", "");
    let hinge = "[[joint]]\nname = \"hinge\"\nkind = \"hinge\"\nbetween = [\"fore\", \"aft\"]\nat = [1.2, 0.4]\n\
                 limits_deg = [-30.0, 30.0]\n";
    let text = flat(&format!("{fore}{aft}{hinge}"));
    let solids = placed::<2>(&text);
    // The heave z of the hinge, and the turns of both barges about it, against heave and pitch of each about its middle.
    let heave = 1000.0 * G * length;
    let pitch = |draft: f64| 1000.0 * G * (length.powi(3) / 12.0 + length * draft * (0.5 * draft - 0.1));
    let drafts = [(100.0 * length + load) / (1000.0 * length), 0.1];
    let couple = arm * heave;
    let stiffness = Matrix3::new(
        2.0 * heave,
        -couple,
        couple,
        -couple,
        pitch(drafts[0]) + couple * arm,
        0.0,
        couple,
        0.0,
        pitch(drafts[1]) + couple * arm,
    );
    let exact = stiffness.lu().solve(&Vector3::new(0.0, load * G * 0.2, 0.0)).unwrap();
    // Terms of the second order in turns of 1e-3.
    for (solid, exact) in [(1, exact[1]), (2, exact[2])] {
        let found = tilt(&solids[solid]);
        assert!((found / exact - 1.0).abs() < 5e-3 && exact.abs() > 1e-4, "{found} for {exact}");
    }
    let at_hinge = |i: usize, x: f64, draft: f64| solids[i].pose.point(&Vector::from([x, draft - 0.1]));
    let [one, two] = [at_hinge(1, 0.3, drafts[0]), at_hinge(2, -0.3, drafts[1])];
    assert!((one - two).norm() < 1e-9, "the hinge is closed: {one} and {two}");
    assert!((one[1] - 0.4 - exact[0]).abs() < 5e-3 * exact[0].abs(), "{} for {}", one[1] - 0.4, exact[0]);
    // End stops and readings count from the straight raft.
    let mut sim = scene_simulation::<2>(&text).unwrap();
    let between = tilt(&solids[2]) - tilt(&solids[1]);
    let at_start = sim.joint_reading(0).position;
    assert!((at_start - between).abs() < 1e-9, "{at_start} before the first step for {between}");
    sim.step().unwrap();
    assert!((sim.joint_reading(0).position - between).abs() < 1e-5, "{}", sim.joint_reading(0).position);
}

#[test]
fn a_buoy_under_a_short_rope_starts_with_the_rope_taut_and_its_tension_is_the_excess_of_buoyancy() {
    // Free, it floats 0.06 m deep; the rope of 0.3 m from its bottom holds it 0.1 m deep.
    let free = "density = 300.0, centre_offset = [0.0, -0.04]";
    let rope = |length: f64| {
        format!(
            "[[rope]]\nname = \"tether\"\nbetween = [\"buoy\"]\nfrom = [1.2, 0.34]\nto = [1.2, 0.0]\nlength = {length}\n"
        )
    };
    let text = flat(&format!("{}{}", barge("buoy", [0.2, 0.2], 1.2, free, ""), rope(0.3)));
    let body = &placed::<2>(&text)[1];
    assert!((body.pose.position - Vector::from([1.2, 0.4])).norm() < 1e-8, "{}", body.pose.position);
    assert!(tilt(body).abs() < 1e-8, "{}", tilt(body));
    let report = inspected(&text);
    let rest = report.bodies[0].afloat.as_ref().unwrap().free_joints.as_ref().unwrap();
    // (1000 · 0.1 m − 300 · 0.2 m) · 0.2 m.
    assert!((rest.tensions_n[0].1 - 8.0 * G).abs() < 1e-4, "{rest:?}");
    assert!(report.findings.iter().any(|own| own.topic == "turned_to_rest" && own.what.contains("0.04 m lower")));
    // A rope that holds it under water; a slack one.
    let under = &placed::<2>(&flat(&format!("{}{}", barge("buoy", [0.2, 0.2], 1.2, free, ""), rope(0.15))))[1];
    assert!((under.pose.position[1] - 0.25).abs() < 1e-8, "{}", under.pose.position);
    let slack = &placed::<2>(&flat(&format!("{}{}", barge("buoy", [0.2, 0.2], 1.2, free, ""), rope(0.35))))[1];
    assert!((slack.pose.position[1] - 0.44).abs() < 1e-12 && tilt(slack) == 0.0, "{}", slack.pose.position);
}

/// The same water 1 m deeper, in another tank on the left.
const DEEPER: &str = "[[water]]\nfill = { box = { min = [-1.0, -1.0], max = [-0.5, 0.4] } }\n\
     [[solid]]\nname = \"deep\"\nfixed = true\nshape = { tank = { size = [0.5, 1.8] } }\nat = [-1.0, -1.0]\n";

#[test]
fn the_bed_under_a_body_is_that_of_its_own_basin() {
    // A weight on the bed, on a rope with 0.1 m of slack from a barge above it.
    let weight = "[[solid]]\nname = \"weight\"\nshape = { box = { size = [0.1, 0.06] } }\nat = { x = 1.2, bottom = 0.01 }\n\
                  free = { density = 2000.0 }\n\
                  [[rope]]\nname = \"line\"\nbetween = [\"barge\", \"weight\"]\nfrom = [1.2, 0.4]\nto = [1.2, 0.07]\nlength = 0.43\n";
    let barge = barge("barge", [0.3, 0.2], 1.2, "density = 300.0", ", angle_deg = 0.0");
    let start = |more: &str| {
        let text = flat(&format!("{barge}{weight}{more}"));
        let body = placed::<2>(&text).iter().find(|solid| solid.name == "barge").unwrap().pose.position[1];
        (body, inspected(&text))
    };
    let [(alone, one), (beside, two)] = [start(""), start(DEEPER)];
    // Free, it floats 0.06 m deep.
    assert!((alone - 0.44).abs() < 1e-9 && (beside - 0.44).abs() < 1e-9, "{alone} m, {beside} m");
    let told = |report: &Preflight| report.findings.iter().map(|own| own.what.clone()).collect::<Vec<_>>();
    assert_eq!(told(&one), told(&two));
    let rest = |report: &Preflight| report.bodies[0].afloat.as_ref().unwrap().heave_s;
    assert_eq!(rest(&one), rest(&two));
}

#[test]
fn a_steady_load_sinks_a_body_by_its_part_of_the_gravity_at_the_start() {
    let barge = barge("barge", [0.3, 0.2], 1.2, "density = 500.0, locked = [\"turn\"]", "");
    let load = "[[force]]\nname = \"load\"\non = \"barge\"\nforce = [0.0, -98.1]\n";
    for gravity in ["-9.81", "\"-9.81*(1+0.5*sin(2*pi*t))\"", "\"-4.905*(2-cos(2*pi*t))\""] {
        let text = format!("gravity = [0.0, {gravity}]\n{}", flat(&format!("{barge}{load}")));
        // 30 kg/m and a load of 10 kg/m, or 20 kg/m at half of the gravity, on 300 kg/m².
        let borne = if gravity.contains("4.905") { 20.0 } else { 10.0 };
        let exact = 0.4 - (30.0 + borne) / 300.0 + 0.1;
        let found = placed::<2>(&text)[1].pose.position[1];
        assert!((found - exact).abs() < 1e-9, "{found} m for {exact} m with {gravity}");
    }
}

#[test]
fn a_taut_spring_to_the_bed_sinks_a_buoy_and_turns_it_if_it_pulls_beside_its_middle() {
    let free = "density = 300.0, centre_offset = [0.0, -0.04]";
    for aside in [0.0, 0.03] {
        let x = 1.2 + aside;
        let spring = format!(
            "[[spring]]\nname = \"tether\"\nbetween = [\"buoy\"]\nfrom = [{x}, 0.35]\nto = [{x}, 0.0]\nlength = 0.3\nstiffness = 500.0\n"
        );
        let body = &placed::<2>(&flat(&format!("{}{spring}", barge("buoy", [0.2, 0.2], 1.2, free, ""))))[1];
        // The spring bears 25 N/m where it is given.
        let lifted = Pose::<2>::rotated(Vector::from([1.2, 0.4 - (60.0 + 125.0 / G) / 1000.0 + 0.1]), &[0.0]);
        let end = body.pose.point(&lifted.local(&Vector::from([x, 0.35])));
        let pull = (Vector::from([x, 0.0]) - end) * (500.0 * (1.0 - 0.3 / (end - Vector::from([x, 0.0])).norm()));
        let (volume, middle) = body.shape.submerged_volume(&body.pose, 0.4);
        let centre = body.initial_kinematics().centre;
        let up = 1000.0 * G * volume - 12.0 * G + pull[1];
        let arm = end - centre;
        let turning = 1000.0 * G * volume * (middle - centre)[0] + arm[0] * pull[1] - arm[1] * pull[0];
        assert!(up.abs() < 1e-5 && turning.abs() < 1e-5, "{up} N/m, {turning} N");
        assert!(if aside == 0.0 { tilt(body) == 0.0 } else { tilt(body) < -0.05 }, "{}", tilt(body));
    }
}

#[test]
fn a_box_with_a_load_off_both_axes_starts_at_its_heel_and_trim() -> Result<()> {
    let text = |turn: &str| {
        format!(
            "dimension = 3\ndp = 0.05\nuntil = 1.0\n[[water]]\nfill = {{ box = {{ min = [0, 0, 0], max = [0.9, 0.8, 0.35] }} }}\n\
             [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = [0.9, 0.8, 0.56] }} }}\n\
             [[solid]]\nname = \"hull\"\nshape = {{ box = {{ size = [0.6, 0.5, 0.3] }} }}\n\
             at = {{ x = 0.45, y = 0.4, draft = \"equilibrium\"{turn} }}\n\
             free = {{ density = 500, centre_offset = [0.02, 0.0125, -0.03] }}\n"
        )
    };
    let hull = &placed::<3>(&text(""))[1];
    let body = hull.initial_body().unwrap();
    // An iteration with the centre of buoyancy alone.
    let (mut turn, mut pose) = ([0.0; 3], Pose::identity());
    for _ in 0..200 {
        pose = Pose::rotated(Vector::zeros(), &turn);
        pose.position[2] += equilibrium_height(&hull.shape, &pose, body.mass, 1000.0, 0.35)?;
        let lever = hull.shape.submerged_volume(&pose, 0.35).1 - pose.point(&body.centre);
        turn = [turn[0] + 5.0 * lever[1], turn[1] - 5.0 * lever[0], 0.0];
    }
    let ups = |pose: &Pose<3>| pose.rotation.row(2).into_owned();
    assert!((ups(&pose) - ups(&hull.pose)).norm() < 1e-7, "{} for {}", ups(&hull.pose), ups(&pose));
    assert!((hull.pose.point(&body.centre)[2] - pose.point(&body.centre)[2]).abs() < 1e-7);
    assert!(1.0 - hull.pose.rotation[(2, 2)] > 0.01, "{}", hull.pose.rotation);
    // A heading is not a tilt: the body turns to the same rest. A given tilt stays.
    let headed = &placed::<3>(&text(", turn_deg = [0.0, 0.0, 30.0]"))[1];
    assert!((ups(&headed.pose) - ups(&hull.pose)).norm() < 1e-7, "{}", headed.pose.rotation);
    assert!((headed.pose.rotation[(1, 0)].atan2(headed.pose.rotation[(0, 0)]) - 30f64.to_radians()).abs() < 0.02);
    for turn in ["[0.0, 0.0, 0.0]", "[3.0, 0.0, 0.0]"] {
        let given = &placed::<3>(&text(&format!(", turn_deg = {turn}")))[1];
        let about: Vec<f64> = if turn == "[3.0, 0.0, 0.0]" { vec![3f64.to_radians(), 0.0, 0.0] } else { vec![0.0; 3] };
        assert_eq!(given.pose.rotation, Pose::<3>::rotated(Vector::zeros(), &about).rotation);
    }
    Ok(())
}

#[test]
fn a_body_that_need_not_turn_or_may_not_or_would_turn_over_keeps_its_orientation() {
    let off = "density = 500.0, centre_offset = [0.01, -0.02]";
    let kept = [
        ("symmetric", [0.5, 0.2], "density = 500.0", "", 0.0),
        ("tall", [0.1, 0.3], "density = 500.0", "", 0.0),
        ("high load", [0.5, 0.2], "density = 400.0, centre_offset = [0.1, 0.1]", "", 0.0),
        ("locked", [0.5, 0.2], "density = 500.0, centre_offset = [0.01, -0.02], locked = [\"turn\"]", "", 0.0),
        ("given", [0.5, 0.2], off, ", angle_deg = 4.0", 4.0),
        ("upright", [0.5, 0.2], off, ", angle_deg = 0.0", 0.0),
    ];
    for (what, size, free, at, angle) in kept {
        let solid = &placed::<2>(&flat(&barge("b", size, 1.2, free, at)))[1];
        assert_eq!(
            solid.pose.rotation,
            Pose::<2>::rotated(Vector::zeros(), &[f64::to_radians(angle)]).rotation,
            "{what}"
        );
    }
    assert!(tilt(&placed::<2>(&flat(&barge("b", [0.5, 0.2], 1.2, off, "")))[1]) < -0.02);
    // What would turn over is told.
    let tall = inspected(&flat(&barge("b", [0.1, 0.3], 1.2, "density = 500.0", "")));
    assert!(tall.findings.iter().any(|own| own.topic == "capsizes"), "{:?}", tall.findings);
    let turned = inspected(&flat(&barge("b", [0.5, 0.2], 1.2, off, "")));
    let note = turned.findings.iter().find(|own| own.topic == "turned_to_rest").unwrap();
    assert!(
        note.what.starts_with("\"b\" starts at rest, turned by -") && note.mend.contains("angle_deg = 0.0"),
        "{note:?}"
    );
    assert!(!turned.findings.iter().any(|own| ["lists", "off_draft"].contains(&own.topic)), "{:?}", turned.findings);
}

#[test]
fn a_slack_line_moves_no_body_and_a_post_in_the_way_keeps_the_orientation() {
    let floats = barge("a", [0.5, 0.2], 0.8, "density = 500.0", "");
    // A tilted box 0.3 m above its draft, on a painter of 1.5 m over a distance of 0.8 m.
    let other = "[[solid]]\nname = \"b\"\nshape = { box = { size = [0.2, 0.1] } }\nat = { x = 1.6, y = 0.7, angle_deg = 8.0 }\n\
                 free = { density = 500.0 }\n";
    let line =
        "[[rope]]\nname = \"line\"\nbetween = [\"a\", \"b\"]\nfrom = [0.8, 0.45]\nto = [1.6, 0.7]\nlength = 1.5\n";
    let alone = placed::<2>(&flat(&format!("{floats}{other}")));
    let tied = placed::<2>(&flat(&format!("{floats}{other}{line}")));
    assert_eq!(alone[2].pose, tied[2].pose);
    // A deck that would turn by 3° into the corner of a post starts upright.
    let off = "density = 500.0, ballast = [{ at = [0.1, -0.05], mass = 4.0 }]";
    let post = "[[solid]]\nname = \"post\"\nfixed = true\nshape = { box = { size = [0.06, 0.2] } }\nat = { x = 1.02, bottom = 0.495 }\n";
    let beside = placed::<2>(&flat(&format!("{}{post}", barge("b", [0.5, 0.2], 1.2, off, ""))));
    assert_eq!(tilt(&beside[1]), 0.0);
}

#[test]
fn what_stands_on_a_deck_or_hangs_from_it_turns_and_moves_along() {
    let raft = barge("raft", [0.6, 0.1], 1.2, "density = 400.0", "");
    let crate_on = "[[solid]]\nname = \"crate\"\nshape = { box = { size = [0.1, 0.08] } }\nat = { x = 1.3, bottom = 0.46 }\n\
                    free = { mass = 2.0 }\n";
    let solids = placed::<2>(&flat(&format!("{raft}{crate_on}")));
    // 24 kg/m, and 2 kg/m with its middle at a height of 0.5 m, where the keel is at 0.4 m less the draft.
    let draft = 26.0 / 600.0;
    let exact = wall_sided(0.6, draft, [2.0 * 0.1 / 26.0, (24.0 * 0.05 + 2.0 * (0.1 + draft)) / 26.0]);
    assert!((tilt(&solids[1]).tan() + exact).abs() < 1e-8, "{} for {}", tilt(&solids[1]).tan(), -exact);
    let on_deck = solids[1].pose.local(&solids[2].pose.position);
    assert!(
        (on_deck - Vector::from([0.1, 0.05 + draft])).norm() < 1e-8 && tilt(&solids[1]) == tilt(&solids[2]),
        "{on_deck}"
    );
    // A weight on a rope from the end of the raft hangs as far below it as before.
    let clump = "[[solid]]\nname = \"clump\"\nshape = { box = { size = [0.06, 0.06] } }\nat = { x = 1.4, y = 0.2 }\n\
                 free = { density = 1500.0 }\n\
                 [[rope]]\nname = \"line\"\nbetween = [\"raft\", \"clump\"]\nfrom = [1.4, 0.37]\nto = [1.4, 0.23]\n";
    let solids = placed::<2>(&flat(&format!("{raft}{clump}")));
    // The weight in water, 1.8 kg/m at 0.2 m: a load that does not turn with the raft.
    let draft = 25.8 / 600.0;
    let at = Vector::from([1.2, 0.45 - draft]);
    let end = solids[1].pose.point(&(Vector::from([1.4, 0.37]) - at));
    let top = solids[2].pose.point(&Vector::from([0.0, 0.03]));
    assert!(((end - top).norm() - 0.14).abs() < 1e-8, "{end} and {top}");
    let (volume, middle) = solids[1].shape.submerged_volume(&solids[1].pose, 0.4);
    let centre = solids[1].pose.position;
    let turning = volume * 1000.0 * (middle - centre)[0] - 1.8 * (end - centre)[0];
    assert!((volume * 1000.0 - 25.8).abs() < 1e-6 && turning.abs() < 1e-6, "{volume} m², {turning} kg");
    assert!(tilt(&solids[1]) < -0.01, "{}", tilt(&solids[1]));
}

#[test]
fn a_guide_keeps_its_body_and_a_symmetric_mooring_its_place() {
    let off = "density = 500.0, centre_offset = [0.01, -0.02]";
    let slider =
        "[[joint]]\nname = \"rail\"\nkind = \"slider\"\nbetween = [\"b\"]\nat = [1.2, 0.4]\nalong = [0.3, 1.0]\n";
    let solid = &placed::<2>(&flat(&format!("{}{slider}", barge("b", [0.5, 0.2], 1.2, off, ""))))[1];
    assert!(tilt(solid) == 0.0 && (solid.pose.position - Vector::from([1.2, 0.4])).norm() < 1e-9, "{solid:?}");
    // With the turn free, it turns on the rail.
    let pin = slider.replace("slider", "generic").replace("along", "free = [\"x\", \"turn\"]\nalong");
    let solid = &placed::<2>(&flat(&format!("{}{pin}", barge("b", [0.5, 0.2], 1.2, off, ""))))[1];
    let on_rail = solid.pose.position - Vector::from([1.2, 0.4]);
    assert!(tilt(solid) < -0.02 && (on_rail[0] - 0.3 * on_rail[1]).abs() < 1e-9, "{solid:?}");
    // A line of chain on one side pulls its side down. The line starts at rest from there.
    let chain = "[[line_type]]\nname = \"chain\"\ndiameter = 0.02\nmass_per_length = 2.0\nstiffness = 2e4\ndrag = 1.6\n\
                 [[mooring]]\nname = \"bow\"\nbetween = [\"b\"]\nfrom = [0.95, 0.37]\nto = [0.3, 0.0]\nlength = 0.9\nline = \"chain\"\n";
    let text =
        flat(&format!("{}{chain}", barge("b", [0.5, 0.2], 1.2, "density = 500.0, centre_offset = [0.0, -0.02]", "")));
    let mut sim = scene_simulation::<2>(&text).unwrap();
    let start = sim.system().solids()[1].kinematics;
    let [fairlead, _] = sim.mooring_readings()[0].end_forces;
    let bow = sim.mooring_readings()[0].nodes[0];
    let (volume, middle) = sim.system().solids()[1].spec.shape.submerged_volume(&start.pose, 0.4);
    let arm = bow - start.centre;
    let up = 1000.0 * G * volume - 50.0 * G + fairlead[1];
    let turning = 1000.0 * G * volume * (middle - start.centre)[0] + arm[0] * fairlead[1] - arm[1] * fairlead[0];
    // Before there are particles, the pull of the line is known to 2e-3.
    assert!(up.abs() < 0.02 && turning.abs() < 0.01 && fairlead[1] < -3.0, "{up} N/m, {turning} N, {fairlead}");
    assert!(start.pose.rotation_vector()[0] > 0.005 && (start.centre[0] - 1.2).abs() < 1e-9);
    sim.step().unwrap();
}

#[test]
fn what_has_no_rest_is_refused() {
    let refused = |sections: &str, what: &str| {
        let error = scene_simulation::<2>(&flat(sections)).err().unwrap_or_else(|| panic!("{what}")).to_string();
        assert!(error.contains(what), "{error}");
    };
    // On a vertical rail the rope is too short at every height.
    let rail =
        "[[joint]]\nname = \"rail\"\nkind = \"slider\"\nbetween = [\"b\"]\nat = [1.2, 0.4]\nalong = [0.0, 1.0]\n";
    let rope = "[[rope]]\nname = \"short\"\nbetween = [\"b\"]\nfrom = [1.2, 0.35]\nto = [0.6, 0.0]\nlength = 0.5\n";
    let buoy = barge("b", [0.2, 0.2], 1.2, "density = 500.0", "");
    refused(&format!("{buoy}{rail}{rope}"), "rope \"short\" is 0.5 m long, and its ends start 0.69");
    let lift = "[[spring]]\nname = \"lift\"\nbetween = [\"b\"]\nfrom = [1.2, 0.5]\nto = [1.2, 1.0]\nlength = 0.1\n\
                stiffness = 2000.0\n";
    refused(&format!("{buoy}{lift}"), "the body leaves the water: with its loads its mass is −61");
}

#[test]
fn a_body_that_touches_another_or_would_turn_into_it_keeps_its_orientation_and_is_told_its_list() {
    let off = "density = 500.0, centre_offset = [-0.05, -0.04]";
    let beside = flat(&barge("b", [0.5, 0.2], 0.26, off, ""));
    assert_eq!(tilt(&placed::<2>(&beside)[1]), 0.0);
    assert!(inspected(&beside).findings.iter().any(|own| own.topic == "lists"));
    // Fenders in touch bear what the line between the boats pulls.
    let line = "[[spring]]\nname = \"line\"\nbetween = [\"a\", \"b\"]\nfrom = [1.0, 0.45]\nto = [1.4, 0.45]\nlength = 0.35\n\
                stiffness = 200.0\n";
    let boats = |gap: f64| {
        let boat = |name: &str, x: f64| barge(name, [0.4, 0.2], x, "density = 500.0", "");
        placed::<2>(&flat(&format!("{}{}{line}", boat("a", 1.0), boat("b", 1.4 + gap))))
    };
    assert!(boats(0.0)[1..].iter().all(|boat| tilt(boat) == 0.0));
    // Apart, each heels, and keeps its place.
    let apart = boats(0.05);
    let centre = |i: usize| apart[i].initial_kinematics().centre[0];
    assert!(tilt(&apart[1]) < -0.001 && (tilt(&apart[1]) + tilt(&apart[2])).abs() < 1e-3, "{:?}", apart[1].pose);
    assert!((centre(1) - 1.0).abs() < 1e-9 && (centre(2) - 1.45).abs() < 1e-9, "{} {}", centre(1), centre(2));
}

#[test]
fn a_body_that_starts_at_rest_stays_there() -> Result<()> {
    let text = |at: &str| {
        let free = "density = 500.0, ballast = [{ at = [0.1, -0.05], mass = 4.0 }]";
        flat(&barge("barge", [0.5, 0.2], 1.2, free, at)).replace("2.4", "1.4").replace("x = 1.2", "x = 0.7")
    };
    let swing = |at: &str| -> Result<[f64; 2]> {
        let mut sim = scene_simulation::<2>(&text(at))?;
        let start = sim.system().solids()[1].kinematics.pose;
        let (mut turn, mut rise): (f64, f64) = (0.0, 0.0);
        while sim.time() < 1.5 {
            sim.step_to(1.5)?;
            let now = sim.system().solids()[1].kinematics.pose;
            turn = turn.max((now.rotation_vector()[0] - start.rotation_vector()[0]).abs().to_degrees());
            rise = rise.max((now.position[1] - start.position[1]).abs() / DP);
        }
        Ok([turn, rise])
    };
    let [at_rest, upright] = [swing("")?, swing(", angle_deg = 0.0")?];
    // It heels by 2.8°; half of the quarter of a dp over 25 dp to which such heels are resolved is 0.3°.
    assert!(at_rest[0] < 0.3 && at_rest[1] < 0.15, "{at_rest:?}");
    assert!(upright[0] > 2.5, "{upright:?}");
    Ok(())
}

#[test]
fn the_water_is_cut_around_the_turned_body_and_a_restart_keeps_the_bits() -> Result<()> {
    let hull = "[[solid]]\nname = \"hull\"\ndry = true\nshape = { tank = { size = [0.5, 0.2], thickness = 0.04 } }\n\
                at = { x = 0.6, draft = \"equilibrium\" }\n\
                free = { mass = 40.0, centre_offset = [0.0, -0.02], ballast = [{ at = [0.35, 0.05], mass = 4.0 }] }\n";
    let solid = barge("barge", [0.5, 0.2], 1.7, "density = 500.0, centre_offset = [0.015, -0.02]", "");
    let text = flat(&format!("{hull}{solid}"));
    let mut sim = scene_simulation::<2>(&text)?;
    for body in &sim.system().solids()[1..] {
        assert!(body.kinematics.pose.rotation_vector()[0].abs() > 0.02, "{:?}", body.kinematics.pose);
        let distance = |x: &Vector<2>| body.spec.shape.signed_distance(&body.kinematics.pose.local(x));
        let least = sim.system().fluid().r.iter().map(distance).fold(f64::INFINITY, f64::min);
        // Rows of water begin half a dp from faces.
        assert!((0.3 * DP..0.7 * DP).contains(&least), "\"{}\": {least} m", body.spec.name);
    }
    let pose = sim.system().solids()[1].kinematics.pose;
    let inside = |x: &&Vector<2>| {
        let own = pose.local(x);
        (0.0..0.5).contains(&own[0]) && (0.0..0.2).contains(&own[1])
    };
    assert_eq!(sim.system().fluid().r.iter().filter(inside).count(), 0, "the hull is dry");
    run_to(&mut sim, 0.05)?;
    let state = sim.save()?;
    let mut again = scene_simulation::<2>(&text)?;
    again.restore(&state)?;
    run_to(&mut sim, 0.1)?;
    run_to(&mut again, 0.1)?;
    assert!(sim.save()? == again.save()?, "the states differ");
    Ok(())
}
