//! Unit tests of `src/solid/statics/linkage.rs`.

use std::f64::consts::TAU;

use nalgebra::Matrix2;

use super::*;
use crate::{
    geometry::Shape,
    solid::{
        Constraints, LineEnd, Motor, Role, RopeSpec, SolidSpec, SpringSpec,
        hydrostatics::Hull,
        statics::{StaticBody, WaterAtRest},
    },
};

const WATER: WaterAtRest = WaterAtRest { rho0: 1000.0, g: 10.0, level: 0.0 };

/// The first assembly of these solids, with its joints free.
fn free<const D: usize>(solids: &[SolidSpec<D>], joints: Vec<JointSpec<D>>) -> Option<FreeJoints> {
    tied(solids, Constraints { joints, ..Constraints::default() })
}

/// The first assembly of these solids with these ties.
fn tied<const D: usize>(solids: &[SolidSpec<D>], constraints: Constraints<D>) -> Option<FreeJoints> {
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
    free_joints(&StaticSystem::new(solids.iter().enumerate().map(body).collect(), &specs, &constraints, WATER), 0)
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
    // A third barge on the second one and a joint back to the first make a loop, which is not judged.
    let loop_of = vec![
        hinge(0.0),
        JointSpec { between: [Some(1), Some(2)], ..hinge(2.0) },
        JointSpec { between: [Some(0), Some(2)], ..hinge(1.0) },
    ];
    assert_eq!(free(&[barge(-1.0), barge(1.0), barge(3.0)], loop_of), None);
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
    // End stops that the spring reaches hold the weight.
    assert_eq!(free(&solids, vec![guide.clone().motor(spring.clone()).limits(-0.05, 0.05)]), None);
    assert!(free(&solids, vec![guide.motor(spring).limits(-0.2, 0.2)]).is_some());
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
fn a_spring_to_the_ground_adds_its_period_and_a_rope_is_not_judged() {
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
    ties.ropes.push(RopeSpec::new("r", ends));
    assert_eq!(tied(&solids, ties), None);
}
