//! What generic joints promise: what they lock, what they leave, and what they tell.

use crate::{
    math::{Bivector, Vector},
    solid::{
        Constraints, Dim, ForceSpec, HasEngine, JointKind, JointSpec, TimeFunction,
        constraint::assembly::tests::{Air, G, bar, body, hinge, joined, point},
    },
};

/// The number of the turn about the axis across.
fn pitch<const D: usize>() -> usize {
    if D == 2 { 2 } else { 4 }
}

fn guided<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    // Free to go up and down and to pitch, between stops: its weight takes it to the lower one, a torque to the one ahead.
    let solids = vec![bar::<D>("float", 0.4, Vector::zeros(), true)];
    let guide = JointSpec::new("guide", JointKind::Generic, [None, Some(0)], Vector::zeros(), Vector::zeros())
        .free_mode(D - 1, Some([-0.05, 0.3]))
        .free_mode(pitch::<D>(), Some([-0.2, 0.1]));
    let torque =
        (0..D * (D - 1) / 2).map(|i| TimeFunction::constant(if D == 2 || i == 1 { 8.0 } else { 0.0 })).collect();
    let force = (0..D).map(|i| TimeFunction::constant(if i == 0 { 5.0 } else { 0.0 })).collect();
    let push = ForceSpec { name: "push".into(), solid: 0, at: None, force, torque, rotates_with_solid: false };
    let mut air =
        Air::new(solids, Constraints { joints: vec![guide], forces: vec![push], ..Constraints::default() }, G);
    air.run(1e-4, 0.05);
    // First order in the step: ½ g t Δt.
    let (free, fallen) = (air.rig.joint_coordinates(0, &air.now()), 0.5 * G * 0.05 * 0.05);
    assert!((free[0] + fallen).abs() < 3e-5, "between its stops it falls freely: {free:?} for {fallen}");
    air.run(1e-4, 1.0);
    let (at, now, weight) = (air.rig.joint_coordinates(0, &air.now()), air.now()[0], body(&air.solids[0]).mass * G);
    // Stops are a lock while they are met: rigid to round-off, and met again in each step.
    assert!((at[0] + 0.05).abs() < 1e-6 && (at[1] - 0.1).abs() < 1e-6, "{at:?}");
    assert!(now.centre[0].abs() < 1e-6 && now.velocity.norm() < 1e-6, "{now:?}");
    let reading = air.rig.joint_reading(0);
    let carried = point::<D>(-5.0, weight);
    assert!((reading.force - carried).norm() < 1e-3 * weight, "{reading:?} for {carried:?}");
    let about = reading.torque.axial();
    assert!((about[if D == 2 { 0 } else { 1 }] + 8.0).abs() < 1e-3 * weight, "{about:?}");
}

#[test]
fn a_generic_joint_holds_what_it_does_not_leave_free_and_stops_the_rest() {
    guided::<2>();
    guided::<3>();
}

fn hinged<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    let run = |joint: JointSpec<D>| {
        let mut air = Air::new(vec![bar("bar", 0.4, point(0.2, 0.0), true)], joined(joint), G);
        air.run(1e-4, 0.7);
        (air.now()[0], air.rig.joint_reading(0).force)
    };
    let generic = JointSpec::new("joint", JointKind::Generic, [None, Some(0)], Vector::zeros(), Vector::zeros());
    let (free, hinged) = (run(generic.free_mode(pitch::<D>(), None)), run(hinge([None, Some(0)], Vector::zeros())));
    // The same locks in other axes: round-off alone parts them.
    assert!((free.0.centre - hinged.0.centre).norm() < 1e-9, "{D}-D: {free:?} {hinged:?}");
    assert!((free.1 - hinged.1).norm() < 1e-6 * hinged.1.norm(), "{D}-D: {free:?} {hinged:?}");
}

#[test]
fn a_generic_joint_that_leaves_one_turn_is_a_hinge() {
    hinged::<2>();
    hinged::<3>();
}

#[test]
fn a_universal_joint_tells_the_torque_that_it_carries_at_any_angle() {
    // A cube, which has no gyroscopic torque, on a Cardan joint at its centre: nothing but the lock of its first turn changes its
    // angular momentum.
    let solids = vec![bar::<3>("cube", 0.1, Vector::zeros(), false)];
    let inertia = body(&solids[0]).inertia[(0, 0)];
    let cardan = JointSpec::new("cardan", JointKind::Generic, [None, Some(0)], Vector::zeros(), Vector::zeros())
        .free_mode(4, None)
        .free_mode(5, None);
    let mut air = Air::new(solids, joined(cardan), 0.0);
    let start = [0.0, 3.0, 2.0];
    air.engine.set_velocity(0, &Vector::zeros(), &Bivector::from_axial(&start));
    let momentum = |air: &Air<3>| Vector::<3>::from_column_slice(&air.now()[0].spin.axial()) * inertia;
    let (dt, mut turned) = (1e-4, 0.0f64);
    while air.t < 0.4 {
        let before = momentum(&air);
        air.step(dt);
        let told = Vector::<3>::from_column_slice(&air.rig.joint_reading(0).torque.axial());
        let off = (momentum(&air) - before - told * dt).norm();
        // Round-off of the momentum: the torque itself is of first order in the angles.
        assert!(off < 1e-12 * before.norm(), "{off} of {before:?} at {} s: {told:?}", air.t);
        turned = turned.max(air.rig.joint_coordinates(0, &air.now())[0].abs());
    }
    assert!(turned > 1.0, "it has turned far: {turned} rad");
}
