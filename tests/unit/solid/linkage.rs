//! Unit tests of `src/solid/statics/linkage.rs`.

use std::f64::consts::TAU;

use nalgebra::Matrix2;

use super::*;
use crate::{
    geometry::Shape,
    solid::{
        Constraints, ForceSpec, JointKind, LineEnd, Motor, Role, RopeSpec, SolidSpec, SpringSpec,
        hydrostatics::Hull,
        statics::{StaticBody, WaterAtRest},
    },
};

const WATER: WaterAtRest = WaterAtRest { rho0: 1000.0, g: 10.0, level: 0.0 };

/// The first assembly of these solids, with its joints free.
fn free<const D: usize>(solids: &[SolidSpec<D>], joints: Vec<JointSpec<D>>) -> Option<FreeRest> {
    tied(solids, Constraints { joints, ..Constraints::default() })
}

/// The first assembly of these solids with these ties.
fn tied<const D: usize>(solids: &[SolidSpec<D>], constraints: Constraints<D>) -> Option<FreeRest> {
    let body = |(solid, spec): (usize, &SolidSpec<D>)| StaticBody {
        solid,
        hull: Hull::new(&solids[solid].shape),
        body: match &solids[solid].role {
            Role::Free(body) => body,
            _ => panic!("free bodies"),
        },
        pose: spec.pose,
        bottom: -5.0,
        level: WATER.level,
    };
    let specs: Vec<&SolidSpec<D>> = solids.iter().collect();
    free_rest(&StaticSystem::new(solids.iter().enumerate().map(body).collect(), &specs, &constraints, WATER), 0)
}

/// Periods (s) of two degrees of freedom, from the longest.
fn periods(k: Matrix2<f64>, m: Matrix2<f64>) -> Vec<f64> {
    let root = m.cholesky().unwrap().l().try_inverse().unwrap();
    let squares = (root * k * root.transpose()).symmetric_eigenvalues();
    let mut all: Vec<f64> = squares.iter().map(|w| TAU / w.sqrt()).collect();
    all.sort_by(|a, b| b.total_cmp(a));
    all
}

const LENGTH: f64 = 2.0;
const HEIGHT: f64 = 0.4;

/// The periods of two barges of 2 m × 0.4 m, half as dense as water, on a hinge 0.1 m above the level. The heave z of the hinge and
/// the turn φ of both about it make two; the pitch of both as one body makes the third.
fn barge_periods() -> Vec<f64> {
    let (m, k, up) = (0.5 * HEIGHT * LENGTH * 1000.0, 1e4 * LENGTH, 0.1);
    let own = m * (LENGTH * LENGTH + HEIGHT * HEIGHT) / 12.0;
    // B lies 0.1 m below G, which is at the level.
    let turning = k * LENGTH * LENGTH / 3.0 - m * 10.0 * 0.1;
    let stiffness = Matrix2::new(2.0 * k, k * LENGTH, k * LENGTH, 2.0 * turning);
    let inertia = own + m * (0.25 * LENGTH * LENGTH + up * up);
    let mut all = periods(stiffness, Matrix2::new(2.0 * m, m * LENGTH, m * LENGTH, 2.0 * inertia));
    let pitch = 2.0 * (own + m * 0.25 * LENGTH * LENGTH) / (2.0 * turning);
    all.push(TAU * pitch.sqrt());
    all.sort_by(|a, b| b.total_cmp(a));
    all
}

#[test]
fn two_hinged_barges_have_the_periods_of_heave_pitch_and_flexing() {
    let shape = Shape::Box { size: Vector::from([LENGTH, HEIGHT]) };
    let barge = |x: f64| SolidSpec::free(format!("{x}"), shape.clone(), 500.0).at([x, 0.0]);
    let hinge =
        |x: f64| JointSpec::new("h", JointKind::Hinge, [Some(0), Some(1)], Vector::from([x, 0.1]), Vector::zeros());
    let found = free(&[barge(-1.0), barge(1.0)], vec![hinge(0.0)]).unwrap();
    let exact = barge_periods();
    assert_eq!(found.periods.len(), 3, "{found:?}");
    // The difference that gives K errs by the square of its step, 1e-10, and by round-off over it, 1e-11.
    for (found, exact) in found.periods.iter().zip(&exact) {
        assert!((found / exact - 1.0).abs() < 1e-6, "{found} s for {exact} s");
    }
    assert!(!found.is_unstable && found.turns.iter().all(|(_, turn)| *turn < 1e-6), "{found:?}");
}

#[test]
fn in_space_barges_of_unit_breadth_on_a_hinge_have_these_periods_too() {
    let shape = Shape::Box { size: Vector::from([LENGTH, 1.0, HEIGHT]) };
    let barge = |x: f64| SolidSpec::free(format!("{x}"), shape.clone(), 500.0).at([x, 0.0, 0.0]);
    for kind in [JointKind::Hinge, JointKind::Ball] {
        let axis = Vector::from([0.0, 2.0, 0.0]);
        let joint = JointSpec::new("h", kind, [Some(0), Some(1)], Vector::from([0.0, 0.0, 0.1]), axis);
        let found = free(&[barge(-1.0), barge(1.0)], vec![joint]).unwrap();
        // Roll besides, and on a ball joint that of each barge.
        assert_eq!(found.periods.len(), if kind == JointKind::Hinge { 4 } else { 5 }, "{found:?}");
        for exact in barge_periods() {
            assert!(found.periods.iter().any(|found| (found / exact - 1.0).abs() < 1e-6), "{exact} s of {found:?}");
        }
    }
}

/// A raft of 400 kg/m on 2 m, and on it 50 kg/m on a vertical slider with a spring of 5000 N/m: the spring gives by 0.1 m.
#[test]
fn a_weight_on_a_sprung_slider_heaves_against_its_raft() {
    let raft = SolidSpec::free("raft", Shape::Box { size: Vector::from([LENGTH, HEIGHT]) }, 500.0).at([0.0, 0.0]);
    let weight = SolidSpec::free("weight", Shape::Box { size: Vector::from([0.5, 0.1]) }, 1000.0).at([0.0, 1.0]);
    let spring = Motor::default().stiffness(5000.0);
    let guide =
        JointSpec::new("s", JointKind::Slider, [Some(0), Some(1)], Vector::from([0.0, 1.0]), Vector::from([0.0, 1.0]));
    let solids = [raft, weight];
    let found = free(&solids, vec![guide.clone().motor(spring.clone())]).unwrap();
    let exact = periods(Matrix2::new(2e4, 0.0, 0.0, 5e3), Matrix2::new(450.0, 50.0, 50.0, 50.0));
    for exact in exact {
        assert!(found.periods.iter().any(|found| (found / exact - 1.0).abs() < 1e-6), "{exact} s of {found:?}");
    }
    // An end stop that the spring reaches holds the weight: 450 kg/m heave as one.
    let held = free(&solids, vec![guide.clone().motor(spring.clone()).limits(-0.05, 0.05)]).unwrap();
    let exact = TAU * (450.0f64 / 2e4).sqrt();
    assert!(held.periods.iter().any(|found| (found / exact - 1.0).abs() < 1e-6), "{exact} s of {held:?}");
    assert_eq!(held.periods.len() + 1, found.periods.len(), "{held:?}");
    assert_eq!(free(&solids, vec![guide.motor(spring).limits(-0.2, 0.2)]).unwrap().periods.len(), found.periods.len());
}

#[test]
fn a_mast_on_a_hinge_has_no_stable_rest() {
    let raft = SolidSpec::free("raft", Shape::Box { size: Vector::from([LENGTH, HEIGHT]) }, 500.0).at([0.0, 0.0]);
    let mast = SolidSpec::free("mast", Shape::Box { size: Vector::from([0.1, 1.0]) }, 100.0).at([0.0, 0.7]);
    let hinge = JointSpec::new("h", JointKind::Hinge, [Some(0), Some(1)], Vector::from([0.0, 0.2]), Vector::zeros());
    assert!(free(&[raft, mast], vec![hinge]).unwrap().is_unstable);
}

/// The barges of [`barge_periods`] with a level spring of 1 kN/m from the hinge to the ground: it adds surge and nothing else, as the
/// barges are alike on both sides of the hinge.
#[test]
fn a_spring_to_the_ground_adds_its_period_and_a_rope_without_tension_none() {
    let shape = Shape::Box { size: Vector::from([LENGTH, HEIGHT]) };
    let solids = [-1.0, 1.0].map(|x| SolidSpec::free(format!("{x}"), shape.clone(), 500.0).at([x, 0.0]));
    let hinge = JointSpec::new("h", JointKind::Hinge, [Some(0), Some(1)], Vector::from([0.0, 0.0]), Vector::zeros());
    let ends = [LineEnd::on(0, [0.0, 0.0]), LineEnd::ground([5.0, 0.0])];
    let mut ties = Constraints { joints: vec![hinge], ..Constraints::default() };
    let alone = tied(&solids, ties.clone()).unwrap().periods;
    ties.springs.push(SpringSpec::new("s", ends, 1000.0));
    let found = tied(&solids, ties.clone()).unwrap().periods;
    assert_eq!((alone.len(), found.len()), (3, 4), "{alone:?} {found:?}");
    // 800 kg/m on 1 kN/m; at the hinge, in the still level with the centres of mass, the spring has no lever.
    for exact in alone.into_iter().chain([TAU * 0.8f64.sqrt()]) {
        assert!(found.iter().any(|found| (found / exact - 1.0).abs() < 1e-6), "{exact} s of {found:?}");
    }
    // A rope beside the spring, as long as it starts, bears nothing at rest.
    ties.ropes.push(RopeSpec::new("r", ends));
    let roped = tied(&solids, ties).unwrap();
    assert_eq!((roped.periods.len(), roped.tensions), (4, vec![("r".into(), 0.0)]));
}

/// 80 kg/m in 160 kg/m of water pull with 800 N/m: at rest the rope of 1 m stands upright on its anchor 3 m below the level.
fn moored_buoy<const D: usize>(size: [f64; D]) {
    let point = |x: f64, z: f64| {
        Vector::from_fn(|i, _| {
            if i == 0 {
                x
            } else if i == D - 1 {
                z
            } else {
                0.0
            }
        })
    };
    let buoy = SolidSpec::free("buoy", Shape::Box { size: Vector::from(size) }, 500.0).at(Pose::at(point(0.6, -2.1)));
    let line = RopeSpec::new("line", [LineEnd::ground(point(0.0, -3.0)), LineEnd::on(0, point(0.6, -2.2))]);
    // Slack by 0.2 m, and taut.
    for length in [1.2, 1.0] {
        let found = tied(
            std::slice::from_ref(&buoy),
            Constraints { ropes: vec![line.clone().max_length(length)], ..Constraints::default() },
        )
        .unwrap();
        let (draft, tension) = (found.drafts[0].1, found.tensions[0].1);
        assert!((draft - (3.0 - length)).abs() < 1e-6, "draft {draft} m of {found:?}");
        assert!((tension - 800.0).abs() < 1e-3, "{tension} N");
        assert!(!found.is_unstable && found.turns[0].1 < 1e-6, "{found:?}");
        // Two pendulums in a row: the rope by a, the buoy by b on its fastening 0.1 m below G. With net lift F = 800 N/m:
        // K = F [l, s], M = [m l², m l s; m l s, I + m s²], and the couples of buoyancy and weight vanish at G = B.
        let (m, f, s, own) = (80.0, 800.0, 0.1, 80.0 * 0.68 / 12.0);
        let mass = Matrix2::new(m * length * length, m * length * s, m * length * s, own + m * s * s);
        let exact = periods(Matrix2::new(f * length, 0.0, 0.0, f * s), mass);
        for exact in exact {
            assert!(found.periods.iter().any(|own| (own / exact - 1.0).abs() < 1e-5), "{exact} s of {found:?}");
        }
    }
    // A rope that reaches the surface is slack, and the buoy floats at half of its height.
    let found = tied(&[buoy], Constraints { ropes: vec![line.max_length(4.0)], ..Constraints::default() }).unwrap();
    assert!((found.drafts[0].1 - 0.1).abs() < 1e-6 && found.tensions[0].1 == 0.0, "{found:?}");
}

#[test]
fn a_rope_to_the_bed_holds_a_buoy_upright_over_its_anchor() {
    moored_buoy([0.8, 0.2]);
    moored_buoy([0.8, 1.0, 0.2]);
}

/// The barges of [`barge_periods`] with a load w on the middle of the right one. The hinge bears V = w/2/(1 + K/C): K = 20 kN/m against
/// heave, C = K L²/12 − m g/10 against a turn of a barge about its middle, and its two sides sink alike, V (1/K + 1/C) = (w − V)/K − V/C.
#[test]
fn a_load_on_one_of_two_hinged_barges_turns_both() {
    let shape = Shape::Box { size: Vector::from([LENGTH, HEIGHT]) };
    let solids = [-1.0, 1.0].map(|x| SolidSpec::free(format!("{x}"), shape.clone(), 500.0).at([x, 0.0]));
    let hinge = JointSpec::new("h", JointKind::Hinge, [Some(0), Some(1)], Vector::from([0.0, 0.1]), Vector::zeros());
    let w = 20.0;
    let load = ForceSpec::new("w", 1).force([0.0, -w]);
    let found =
        tied(&solids, Constraints { joints: vec![hinge], forces: vec![load], ..Constraints::default() }).unwrap();
    let (k, c) = (2e4, 2e4 * LENGTH * LENGTH / 12.0 - 400.0);
    let v = 0.5 * w / (1.0 + k / c);
    // The exact turn is 4e-4 rad; terms of second order are of that part.
    for (_, turn) in &found.turns {
        assert!((turn * c / v - 1.0).abs() < 1e-3, "{turn} rad, exact {}", v / c);
    }
    let corner = |number: usize, sinks: f64| found.drafts[number].1 - 0.2 - sinks - v / c;
    assert!(corner(0, v / k).abs() < 1e-6 && corner(1, (w - v) / k).abs() < 1e-6, "{found:?}");
}

/// A deck of 30 kg/m on two parallel links of 1 m and 10 kg/m each, from the ground: four hinges of three bodies leave one motion free.
/// The deck swings without a turn: T² = 4π² (M l² + 2 m l²/3)/(M g l + m g l).
#[test]
fn a_deck_on_two_links_swings_as_a_loop_of_four_bars_does() {
    let angle = 0.3f64;
    let (s, c) = angle.sin_cos();
    let rod = Shape::Box { size: Vector::from([0.01, 1.0]) };
    let link = |x: f64| {
        let pose = Pose::rotated(Vector::from([x + 0.5 * s, 3.0 - 0.5 * c]), &[angle]);
        SolidSpec::free(format!("{x}"), rod.clone(), 1000.0).at(pose)
    };
    let deck = SolidSpec::free("deck", Shape::Box { size: Vector::from([1.0, 0.3]) }, 100.0).at([s, 3.0 - c]);
    let hinge = |name: &str, between: [Option<usize>; 2], at: [f64; 2]| {
        JointSpec::new(name, JointKind::Hinge, between, Vector::from(at), Vector::zeros())
    };
    let joints = vec![
        hinge("a", [None, Some(0)], [-0.4, 3.0]),
        hinge("b", [None, Some(1)], [0.4, 3.0]),
        hinge("c", [Some(0), Some(2)], [-0.4 + s, 3.0 - c]),
        hinge("d", [Some(1), Some(2)], [0.4 + s, 3.0 - c]),
    ];
    let found = free(&[link(-0.4), link(0.4), deck], joints).unwrap();
    let turns: Vec<f64> = found.turns.iter().map(|(_, turn)| *turn).collect();
    assert!((turns[0] - angle).abs() < 1e-6 && (turns[1] - angle).abs() < 1e-6 && turns[2] < 1e-6, "{turns:?}");
    // The rods are 0.01 m thick, which adds 1e-4 of l² to their inertia.
    let exact = TAU * ((30.0f64 + 20.0 * (1.0 / 3.0 + 1e-4 / 12.0)) / (300.0 + 100.0)).sqrt();
    assert_eq!(found.periods.len(), 1, "{found:?}");
    assert!((found.periods[0] / exact - 1.0).abs() < 1e-6, "{} s, exact {exact} s", found.periods[0]);
}

/// A generic joint to the ground that leaves heave and the turn about y free is a slider with a hinge.
#[test]
fn a_generic_joint_leaves_its_modes_free() {
    let shape = Shape::Box { size: Vector::from([LENGTH, 1.0, HEIGHT]) };
    let barge = SolidSpec::free("b", shape, 500.0).at([0.0, 0.0, 0.0]);
    let joint = JointSpec::new("g", JointKind::Generic, [None, Some(0)], Vector::zeros(), Vector::zeros());
    let found = free(&[barge], vec![joint.free_mode(2, None).free_mode(4, None)]).unwrap();
    let turning = 2e4 * LENGTH * LENGTH / 12.0 - 400.0;
    let exact =
        [TAU * (400.0 / 2e4f64).sqrt(), TAU * (400.0 * (LENGTH * LENGTH + HEIGHT * HEIGHT) / 12.0 / turning).sqrt()];
    assert_eq!(found.periods.len(), 2, "{found:?}");
    for exact in exact {
        assert!(found.periods.iter().any(|own| (own / exact - 1.0).abs() < 1e-6), "{exact} s of {found:?}");
    }
}
