//! Unit tests of `src/solid/decks.rs`.

use super::*;
use crate::{geometry::Shape, math::Vector};

const DP: f64 = 0.02;

/// The solid under solid number 0, with the solids where they start.
fn deck<const D: usize>(solids: &[SolidSpec<D>]) -> Option<usize> {
    let specs: Vec<&SolidSpec<D>> = solids.iter().collect();
    let poses: Vec<Pose<D>> = solids.iter().map(|solid| solid.pose).collect();
    deck_of(&specs, &poses, &Constraints::default(), 0, DP)
}

fn block(at: [f64; 2], size: [f64; 2]) -> SolidSpec<2> {
    SolidSpec::free(format!("{at:?}"), Shape::Box { size: Vector::from(size) }, 500.0).at(at)
}

#[test]
fn a_body_stands_on_the_body_half_a_dp_under_it() {
    let raft = || block([0.0, 0.0], [1.0, 0.2]);
    let over = |gap: f64| deck(&[block([0.3, 0.2 + gap], [0.2, 0.2]), raft()]);
    // Half a dp, 0.01 m, both ways; the distance errs by 1e-5 m.
    assert_eq!([-0.02, -0.009, 0.0, 0.009, 0.02].map(over), [None, Some(1), Some(1), Some(1), None]);
    // Beside the deck, and under it.
    assert_eq!(deck(&[block([0.6, 0.2], [0.2, 0.2]), raft()]), None);
    assert_eq!(deck(&[block([0.0, -0.2], [0.2, 0.2]), raft()]), None);
}

#[test]
fn the_shapes_count_and_not_their_boxes() {
    // A disc over the middle of a roof: the deck under it rises to 0.1 m, lower than the ridge beside it.
    let shape = Shape::Polygon { points: [[-0.4, 0.0], [0.4, 0.0], [0.0, 0.2]].map(Vector::from).to_vec() };
    let roof = || SolidSpec::free("roof", shape.clone(), 500.0);
    let disc = |y: f64| SolidSpec::free("disc", Shape::Ball { radius: 0.05 }, 500.0).at([0.2, y]);
    // The side falls by 0.2 m in 0.4 m, and the disc touches it where its centre is 0.05 √(1 + ½²) m above it.
    let touches = 0.1 + 0.05 * 1.25f64.sqrt();
    assert_eq!([touches, touches + 0.02].map(|y| deck(&[disc(y), roof()])), [Some(1), None]);
}

#[test]
fn a_body_on_two_solids_or_on_a_fixed_one_has_no_deck() {
    let (left, right) = (block([-0.4, 0.0], [0.4, 0.2]), block([0.4, 0.0], [0.4, 0.2]));
    let plank = block([0.0, 0.11], [1.0, 0.02]);
    assert_eq!(deck(&[plank.clone(), left.clone(), right.clone()]), None);
    assert_eq!(deck(&[plank.clone(), left.clone()]), Some(1));
    let fixed = SolidSpec::fixed("quay", Shape::Box { size: Vector::from([0.4, 0.2]) }).at([0.4, 0.0]);
    assert_eq!(deck(&[plank.clone(), left, fixed.clone()]), None);
    assert_eq!(deck(&[plank, fixed]), None);
}

#[test]
fn in_space_a_ball_stands_on_a_plate() {
    let plate = SolidSpec::free("plate", Shape::Box { size: Vector::from([1.0, 1.0, 0.1]) }, 500.0);
    let ball = |z: f64| SolidSpec::free("ball", Shape::Ball { radius: 0.1 }, 500.0).at([0.3, 0.2, z]);
    assert_eq!([0.15, 0.2].map(|z| deck(&[ball(z), plate.clone()])), [Some(1), None]);
}
