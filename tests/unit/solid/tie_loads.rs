//! Unit tests of `src/solid/tie_loads.rs`.

use super::*;
use crate::{
    geometry::Shape,
    math::Vector,
    solid::{ForceSpec, JointKind, JointSpec, RopeSpec, SpringSpec},
};

/// Loads of bodies of these masses (kg), each displacing 1 kg, 2 m above the bottom; the first `afloat` ones float.
fn loads(masses: &[f64], afloat: usize, ties: &Constraints<2>) -> TieLoads {
    let body = |(i, mass): (usize, &f64)| {
        SolidSpec::free(format!("{i}"), Shape::Box { size: Vector::from([1.0, 1.0]) }, *mass)
    };
    let solids: Vec<SolidSpec<2>> = masses.iter().enumerate().map(body).collect();
    let specs: Vec<&SolidSpec<2>> = solids.iter().collect();
    let afloat: Vec<bool> = (0..masses.len()).map(|i| i < afloat).collect();
    let state = StartState {
        specs: &specs,
        afloat: &afloat,
        displaced: &|_| 1.0,
        above_bottom: &|_| 2.0,
        moored: &|_| Vector::zeros(),
        g: 10.0,
    };
    TieLoads::at_start(&state, ties)
}

fn rope(upper: LineEnd<2>, lower: LineEnd<2>) -> RopeSpec<2> {
    RopeSpec::new("rope", [upper, lower])
}

#[test]
fn a_chain_of_weights_hangs_on_the_float_above_it() {
    let mut ties = Constraints::default();
    // In any order, and with any end first.
    ties.ropes.push(rope(LineEnd::on(2, [0.0, 1.0]), LineEnd::on(1, [0.0, 2.0])));
    ties.ropes.push(rope(LineEnd::on(0, [0.0, 4.0]), LineEnd::on(1, [0.0, 3.0])));
    let found = loads(&[5.0, 4.0, 3.0], 1, &ties);
    assert_eq!((found.on(0), found.of_group(0)), (5.0, 0.0));
    // A rope so long that the last weight reaches the bottom.
    ties.ropes[0].max_length = Some(4.0);
    assert_eq!(loads(&[5.0, 4.0, 3.0], 1, &ties).on(0), 3.0);
    // A light body does not push on a rope.
    assert_eq!(
        loads(&[5.0, 0.5], 1, &Constraints { ropes: vec![ties.ropes[1].clone()], ..Constraints::default() }).on(0),
        0.0
    );
}

#[test]
fn a_weight_between_two_floats_loads_each_with_half() {
    let mut ties = Constraints::default();
    ties.ropes.push(rope(LineEnd::on(0, [-1.0, 4.0]), LineEnd::on(2, [0.0, 3.0])));
    ties.ropes.push(rope(LineEnd::on(1, [1.0, 4.0]), LineEnd::on(2, [0.0, 3.0])));
    assert_on(&loads(&[5.0, 5.0, 3.0], 2, &ties), &[1.0, 1.0]);
}

/// Asserts the loads (kg) on the first solids, to round-off.
fn assert_on(found: &TieLoads, exact: &[f64]) {
    for (i, exact) in exact.iter().enumerate() {
        assert!((found.on(i) - exact).abs() < 1e-9, "{i}: {} kg of {exact} kg", found.on(i));
    }
}

#[test]
fn a_beam_on_two_floats_loads_them_by_its_lever() {
    let mut ties = Constraints::default();
    // The centre of the beam is a quarter of the way from the first rope to the second.
    ties.ropes.push(rope(LineEnd::on(0, [-1.0, 4.0]), LineEnd::on(2, [-1.0, 0.5])));
    ties.ropes.push(rope(LineEnd::on(1, [3.0, 4.0]), LineEnd::on(2, [3.0, 0.5])));
    assert_on(&loads(&[5.0, 5.0, 5.0], 2, &ties), &[3.0, 1.0]);
    // A weight on its middle and one below the second rope: 4·3/4 + 2·3/4 + 0 and 4/4 + 2/4 + 6.
    ties.ropes.push(rope(LineEnd::on(2, [0.0, 0.0]), LineEnd::on(3, [0.0, -1.0])));
    ties.ropes.push(rope(LineEnd::on(2, [3.0, 0.0]), LineEnd::on(4, [3.0, -1.0])));
    assert_on(&loads(&[5.0, 5.0, 5.0, 3.0, 7.0], 2, &ties), &[4.5, 7.5]);
}

#[test]
fn a_weight_on_slanted_ropes_loads_its_floats_by_their_slopes() {
    let mut ties = Constraints::default();
    // The horizontal parts of the tensions are equal: the vertical ones go as the slopes, 2 and 1.
    ties.ropes.push(rope(LineEnd::on(0, [-1.0, 2.0]), LineEnd::on(2, [0.0, 0.0])));
    ties.ropes.push(rope(LineEnd::on(1, [2.0, 2.0]), LineEnd::on(2, [0.0, 0.0])));
    assert_on(&loads(&[5.0, 5.0, 4.0], 2, &ties), &[2.0, 1.0]);
}

#[test]
fn three_equal_ropes_of_a_beam_bear_what_equal_stiffness_gives() {
    let mut ties = Constraints::default();
    // Ropes at −2, 0 and 2 m of a beam whose centre is at 1 m: T = W (1/3 + x x_c/Σx²), with x_c = 1 and Σx² = 8.
    for (float, x) in [(0, -2.0), (1, 0.0), (2, 2.0)] {
        ties.ropes.push(rope(LineEnd::on(float, [x - 1.0, 4.0]), LineEnd::on(3, [x - 1.0, 0.5])));
    }
    assert_on(&loads(&[5.0, 5.0, 5.0, 25.0], 3, &ties), &[2.0, 8.0, 14.0]);
}

#[test]
fn what_hangs_below_a_bolted_pair_on_a_spring_loads_the_float() {
    let bolt = |between| JointSpec::new("bolt", JointKind::Fixed, between, Vector::zeros(), Vector::zeros());
    let mut ties = Constraints::default();
    // Float, spring, two bolted weights, rope, weight: all wet weights add up.
    ties.springs.push(SpringSpec::new("line", [LineEnd::on(0, [0.0, 4.0]), LineEnd::on(1, [0.0, 3.0])], 1e4));
    ties.joints.push(bolt([Some(1), Some(2)]));
    ties.ropes.push(rope(LineEnd::on(2, [0.0, 2.0]), LineEnd::on(3, [0.0, 1.0])));
    assert_on(&loads(&[9.0, 3.0, 4.0, 2.5], 1, &ties), &[2.0 + 3.0 + 1.5]);
    // One of them on the ground carries everything.
    ties.joints.push(bolt([None, Some(2)]));
    assert_on(&loads(&[9.0, 3.0, 4.0, 2.5], 1, &ties), &[0.0]);
}

#[test]
fn a_bolted_keel_loads_its_group_and_a_ground_joint_carries_all() {
    let bolt = |between| JointSpec::new("bolt", JointKind::Fixed, between, Vector::zeros(), Vector::zeros());
    let mut ties = Constraints::default();
    ties.joints.push(bolt([Some(0), Some(1)]));
    let found = loads(&[5.0, 4.0], 1, &ties);
    assert_eq!((found.on(0), found.of_group(0)), (0.0, 3.0));
    assert_eq!(found.groups(), [vec![0, 1]]);
    ties.joints.push(bolt([None, Some(1)]));
    let found = loads(&[5.0, 4.0], 1, &ties);
    assert_eq!((found.on(0), found.of_group(0)), (0.0, 0.0));
}

#[test]
fn a_tense_mooring_and_a_steady_force_load_a_buoy() {
    let mut ties = Constraints::default();
    let ends = [LineEnd::on(0, [3.0, 4.0]), LineEnd::ground([0.0, 0.0])];
    ties.springs.push(SpringSpec::new("line", ends, 100.0).rest_length(4.0).tension_only());
    // 100 N along 3-4-5: 80 N down.
    assert!((loads(&[5.0], 1, &ties).on(0) - 8.0).abs() < 1e-12);
    ties.springs[0].rest_length = Some(6.0);
    assert_eq!(loads(&[5.0], 1, &ties).on(0), 0.0, "slack");
    ties.forces.push(ForceSpec::new("crane", 0).force([0.0, 30.0]));
    assert_eq!(loads(&[5.0], 1, &ties).on(0), -3.0);
}

/// On a guide at 30° to the horizontal a level force F takes F cot 30° of the load, one along the guide F/sin 30°; g is 10 m/s².
#[test]
fn an_inclined_slider_to_the_ground_passes_on_what_acts_along_it() {
    let (sin, cos) = 30f64.to_radians().sin_cos();
    let guide = JointSpec::new("g", JointKind::Slider, [None, Some(0)], Vector::zeros(), Vector::from([cos, sin]));
    for (force, exact) in [([20.0, 0.0], -2.0 * cos / sin), ([20.0 * cos, 20.0 * sin], -2.0 / sin), ([0.0, -20.0], 2.0)]
    {
        let forces = vec![ForceSpec::new("f", 0).force(force)];
        let found = loads(&[5.0], 1, &Constraints { joints: vec![guide.clone()], forces, ..Constraints::default() });
        assert_on(&found, &[exact]);
    }
}
