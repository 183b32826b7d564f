use super::*;
use crate::solid::mooring::{
    forces::LineMaterial,
    sample::{self, air, down},
};

/// A damped line in air.
fn material() -> LineMaterial {
    LineMaterial { damping: 0.4, ..sample::material() }
}

fn step<const D: usize>(line: &MooringLine<D>, ends: [Vector<D>; 2]) -> LineStep<D> {
    LineStep { ends, around: line.state.x.iter().map(air).collect() }
}

const WEIGHT: NodeBody = NodeBody { mass: 0.05, volume: 0.0, drag_area: 0.0, added_mass: 0.0 };

/// Two lines that meet in a weight are one line with a clump: at rest, and while an end swings, to round-off of the statics.
#[test]
fn two_lines_in_a_point_are_one_line() {
    let [a, b] = [Vector::from([0.0, 0.0]), Vector::from([1.0, 0.3])];
    let mut whole = MooringLine::<2>::straight(material(), 1.2, 12, [a, b]);
    whole.bodies[4] = WEIGHT;
    assert!(whole.find_rest(&air, &down()) < 1e-6);

    let middle = Vector::from([0.4, 0.0]);
    // The point is at the second end of one line and at the second end of the other.
    let mut first = MooringLine::<2>::straight(material(), 0.4, 4, [a, middle]);
    let mut second = MooringLine::<2>::straight(material(), 0.8, 8, [b, middle]);
    let junctions = Junctions { points: vec![vec![(0, 1), (1, 1)]], lines: vec![0, 1] };
    let mut lines = [&mut first, &mut second];
    junctions.attach(&mut lines, &[WEIGHT]);
    let left = junctions.find_rest(&mut lines, &air, &down());
    assert!(left < 1e-5, "{left} of a node's weight remains");
    let gap = (lines[0].state.x[4] - whole.state.x[4]).norm();
    assert!(gap < 1e-7, "the point is {gap} m from the node of one line");

    for k in 1..=400 {
        let t = f64::from(k) * 1e-3;
        let end = b + Vector::from([0.05 * (9.0 * t).sin(), 0.04 * (7.0 * t).sin()]);
        whole.advance([a, end], 1e-3, &vec![NodeSurroundings::air(); 13], &down());
        let steps = [step(lines[0], [a, middle]), step(lines[1], [end, middle])];
        junctions.advance(&mut lines, &steps, 1e-3, &down());
    }
    assert_eq!(lines[0].state.x[4], lines[1].state.x[8], "the ends stay in one place");
    for i in 0..=12 {
        let own = if i <= 4 { lines[0].state.x[i] } else { lines[1].state.x[12 - i] };
        assert!((own - whole.state.x[i]).norm() < 1e-6, "node {i}: {own} and {}", whole.state.x[i]);
    }
    let forces = [lines[0].state.end_forces[0], lines[1].state.end_forces[0]];
    for (own, one) in forces.iter().zip(whole.state.end_forces) {
        assert!((own - one).norm() < 1e-4 * one.norm(), "{own} and {one}");
    }
}

/// Three lines that meet in a buoy: what their held ends bear is the weight of all and what changes their momentum, to round-off.
#[test]
fn a_bridle_balances_weight_and_momentum() {
    let held = [[0.0, 0.0, 0.0], [1.0, 0.1, 0.0], [0.4, 0.9, 0.1]].map(Vector::<3>::from);
    let middle = Vector::from([0.45, 0.3, -0.2]);
    let stiff = LineMaterial { damping: 40.0, ..material() };
    let mut all = held.map(|end| MooringLine::<3>::straight(stiff.clone(), 0.7, 7, [end, middle]));
    let [first, second, third] = &mut all;
    let mut lines = [first, second, third];
    let junctions = Junctions { points: vec![vec![(0, 1), (1, 1), (2, 1)]], lines: vec![0, 1, 2] };
    junctions.attach(&mut lines, &[WEIGHT]);
    let left = junctions.find_rest(&mut lines, &air, &down());
    assert!(left < 1e-5, "{left} of a node's weight remains");
    let momentum = |lines: &[&mut MooringLine<3>]| {
        let of = |line: &&mut MooringLine<3>| {
            let node = |(i, v): (usize, &Vector<3>)| *v * (0.1 * line.share(i) + line.bodies[i].mass);
            line.state.v.iter().enumerate().map(node).sum::<Vector<3>>()
        };
        lines.iter().map(of).sum::<Vector<3>>()
    };
    let weight = down::<3>() * (0.1 * 2.1 + WEIGHT.mass);
    let borne: Vector<3> = lines.iter().map(|line| line.state.end_forces[0]).sum();
    assert!((borne - weight).norm() < 1e-6 * weight.norm(), "{borne} at rest, and {weight} weigh");
    let (start, mut impulse) = (momentum(&lines), Vector::zeros());
    for k in 1..=300 {
        let t = f64::from(k) * 1e-3;
        let end = held[1] + Vector::from([0.05 * (9.0 * t).sin(), 0.0, 0.04 * (7.0 * t).sin()]);
        let steps = [held[0], end, held[2]].map(|end| [end, middle]);
        let steps: Vec<_> = steps.iter().zip(&lines).map(|(ends, line)| step(line, *ends)).collect();
        junctions.advance(&mut lines, &steps, 1e-3, &down());
        let forces: Vector<3> = lines.iter().map(|line| line.state.end_forces[0]).sum();
        impulse += (weight - forces) * 1e-3;
    }
    let gap = momentum(&lines) - start - impulse;
    assert!(gap.norm() < 1e-12, "impulse and momentum differ by {gap}");
    assert!(lines[0].state.v.iter().all(|v| v.norm() < 2.0), "damping 100 times the critical one is stable");
}
