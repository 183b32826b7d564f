//! Unit tests of `src/solid/constraint/reactions.rs`.

use super::*;
use crate::math::Bivector;

#[test]
fn constraint_forces_are_recovered_from_the_loads_that_they_cause() {
    // Two bodies of 2 and 3 kg and 0.1, 0.2 kg m² on two ropes, to one another and to the ground.
    let body = |x: f64| Kinematics {
        pose: Pose::at(Vector::<2>::new(x, 0.0)),
        centre: Vector::<2>::new(x, 0.0),
        velocity: Vector::zeros(),
        spin: Bivector::zero(),
    };
    let mobility = |mass: f64, inertia: f64| {
        let mut mobility = Mobility::<2>::none();
        mobility.linear = Vector::<2>::repeat(1.0 / mass);
        mobility.angular[(0, 0)] = 1.0 / inertia;
        mobility
    };
    let (a, b, ground) = (mobility(2.0, 0.1), mobility(3.0, 0.2), Mobility::none());
    let row = |n: [f64; 2], at: [f64; 2], ends: [f64; 2]| {
        ConstraintJacobian::at_point(Vector::from(n), &Vector::from(at), &ends.map(body))
    };
    let reaction = |between, row, mobility, force| Reaction { between, jacobian: row, mobility, force };
    let mut reactions = [
        reaction([Some(0), Some(1)], row([0.8, 0.6], [0.3, 0.1], [0.0, 1.0]), [a, b], 40.0),
        reaction([Some(1), None], row([0.0, 1.0], [1.1, 0.0], [1.0, 0.0]), [b, ground], -7.0),
    ];
    let mut loads = [Load::zero(); 2];
    for reaction in &reactions {
        for (end, load) in reaction.between.iter().zip(reaction.loads()) {
            end.iter().for_each(|solid| loads[*solid] += load);
        }
    }
    reactions.iter_mut().for_each(|reaction| reaction.force = 1.0);
    project(&mut reactions, &loads);
    // The iteration converges; the remaining error of forces of 40 N is round-off.
    assert!((reactions[0].force - 40.0).abs() < 1e-9 && (reactions[1].force + 7.0).abs() < 1e-9);
}
