//! Unit tests of `src/report/ties.rs`.

use std::path::Path;

use super::*;
use crate::{
    math::{Pose, Vector},
    report::placement::Placement,
    solid::{ConstraintChange, ConstraintEvent},
};

const SCENE: &str = r#"
dimension = 2
dp        = 0.05
until     = 1.0

[[water]]
fill = { box = { min = [0.0, 0.0], max = [2.0, 0.5] } }

[[solid]]
name  = "tank"
fixed = true
shape = { tank = { size = [2.0, 1.0] } }

[[solid]]
name  = "box"
shape = { box = { size = [0.4, 0.2] } }
at    = { x = 1.0, y = 0.5 }
free  = { density = 500.0 }

[[spring]]
name      = "line"
between   = ["box"]
from      = [0.8, 0.5]
to        = [0.1, 0.0]
stiffness = 100.0
until     = 0.8

[[rope]]
name    = "rope"
between = ["box"]
from    = [1.2, 0.5]
to      = [1.9, 0.0]
"#;

/// The ties of the scene, of a run with these events, and the place of the box.
fn drawn(events: &[String]) -> (Vec<Tie>, Placement) {
    let scene = Scene::parse(SCENE, Path::new(""), &[]).unwrap();
    let start = [[0.0, 0.0], [1.0, 0.5]].map(|at| Placement::from_pose(&Pose::<2>::at(Vector::from(at))));
    let solids = start.map(|start| DrawnSolid { name: String::new(), role: "free", lines: Vec::new(), start });
    (ties::<2>(&scene, &solids, events), start[1])
}

#[test]
fn springs_and_ropes_go_with_their_solids() {
    let (ties, start) = drawn(&[]);
    let solids: Vec<_> = ties.iter().map(|tie| tie.solids).collect();
    assert_eq!(solids, [[Some(1), None]; 2]);
    // Turned by a right angle about its middle, the left side of the box points down.
    let turned = Placement { turn: [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]], ..start };
    for (tie, expected) in ties.iter().zip([[1.0, 0.3], [1.0, 0.7]]) {
        let at = turned.to_world(&tie.ends[0]);
        // Places in frames have single precision.
        assert!((0..2).all(|i| (at[i] - expected[i]).abs() < 1e-6), "{at:?}, not {expected:?}");
    }
    assert_eq!(ties[0].ends[1], [0.1, 0.0, 0.0], "the ground does not move");
}

#[test]
fn a_line_is_drawn_while_it_acts() {
    let broken = |element: &str, time| {
        let (element, change) = (element.to_string(), ConstraintChange::Broken(30.0));
        ConstraintEvent { time, element, change, per_metre: true }.to_string()
    };
    let acts = |events: &[String]| {
        drawn(events).0.iter().map(|tie| [0.3, 0.7, 0.9].map(|t| tie.acts_at(t))).collect::<Vec<_>>()
    };
    assert_eq!(acts(&[]), [[true, true, false], [true, true, true]], "the spring ends at 0.8 s");
    let events = [broken("spring \"line\"", 0.5), broken("rope \"rope\"", 0.75)];
    assert_eq!(acts(&events), [[true, false, false], [true, true, false]], "they break at 0.5 s and 0.75 s");
}
