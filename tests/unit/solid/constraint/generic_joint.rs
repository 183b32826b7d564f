//! Generic joints: locked and free motions, stops and readings.

use crate::{
    math::{Bivector, Vector},
    solid::{
        Constraints, Dim, ForceSpec, HasEngine, JointKind, JointSpec, Lifetime, TimeFunction,
        constraint::assembly::tests::{DrySystem, G, bar, body, hinge, joined, point},
    },
};

/// Index of the pitch rotation.
fn pitch<const D: usize>() -> usize {
    if D == 2 { 2 } else { 4 }
}

fn guided<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    // Heave and pitch are free between stops. The weight moves the body to the lower stop, a torque to the forward one.
    let solids = vec![bar::<D>("float", 0.4, Vector::zeros(), true)];
    let guide = JointSpec::new("guide", JointKind::Generic, [None, Some(0)], Vector::zeros(), Vector::zeros())
        .free_mode(D - 1, Some([-0.05, 0.3]))
        .free_mode(pitch::<D>(), Some([-0.2, 0.1]));
    let torque =
        (0..D * (D - 1) / 2).map(|i| TimeFunction::constant(if D == 2 || i == 1 { 8.0 } else { 0.0 })).collect();
    let force = (0..D).map(|i| TimeFunction::constant(if i == 0 { 5.0 } else { 0.0 })).collect();
    let push = ForceSpec {
        name: "push".into(),
        solid: 0,
        at: None,
        force,
        torque,
        rotates_with_solid: false,
        lifetime: Lifetime::default(),
    };
    let mut air =
        DrySystem::new(solids, Constraints { joints: vec![guide], forces: vec![push], ..Constraints::default() }, G);
    air.run(1e-4, 0.05);
    // First order in the step: ½ g t Δt.
    let (free, fallen) = (air.assembly.joint_coordinates(0, &air.now()), 0.5 * G * 0.05 * 0.05);
    assert!((free[0] + fallen).abs() < 3e-5, "between its stops the body falls freely: {free:?} for {fallen}");
    air.run(1e-4, 1.0);
    let (at, now, weight) =
        (air.assembly.joint_coordinates(0, &air.now()), air.now()[0], body(&air.solids[0]).mass * G);
    // An active stop is a rigid constraint to round-off in each step.
    assert!((at[0] + 0.05).abs() < 1e-6 && (at[1] - 0.1).abs() < 1e-6, "{at:?}");
    assert!(now.centre[0].abs() < 1e-6 && now.velocity.norm() < 1e-6, "{now:?}");
    let reading = air.assembly.joint_reading(0);
    let carried = point::<D>(-5.0, weight);
    assert!((reading.force - carried).norm() < 1e-3 * weight, "{reading:?} for {carried:?}");
    let about = reading.torque.axial();
    assert!((about[if D == 2 { 0 } else { 1 }] + 8.0).abs() < 1e-3 * weight, "{about:?}");
}

#[test]
fn a_generic_joint_locks_its_other_motions_and_stops_the_free_ones_at_their_limits() {
    guided::<2>();
    guided::<3>();
}

fn hinged<const D: usize>()
where
    Dim<D>: HasEngine<D>,
{
    let run = |joint: JointSpec<D>| {
        let mut air = DrySystem::new(vec![bar("bar", 0.4, point(0.2, 0.0), true)], joined(joint), G);
        air.run(1e-4, 0.7);
        (air.now()[0], air.assembly.joint_reading(0).force)
    };
    let generic = JointSpec::new("joint", JointKind::Generic, [None, Some(0)], Vector::zeros(), Vector::zeros());
    let (free, hinged) = (run(generic.free_mode(pitch::<D>(), None)), run(hinge([None, Some(0)], Vector::zeros())));
    // The same constraints in other axes: only round-off differs.
    assert!((free.0.centre - hinged.0.centre).norm() < 1e-9, "{D}-D: {free:?} {hinged:?}");
    assert!((free.1 - hinged.1).norm() < 1e-6 * hinged.1.norm(), "{D}-D: {free:?} {hinged:?}");
}

#[test]
fn a_generic_joint_with_one_free_rotation_equals_a_hinge() {
    hinged::<2>();
    hinged::<3>();
}

#[test]
fn a_universal_joint_reads_the_torque_that_it_carries_at_any_angle() {
    // A cube, without gyroscopic torque, on a universal joint at its centre: only the locked rotation changes its angular
    // momentum.
    let solids = vec![bar::<3>("cube", 0.1, Vector::zeros(), false)];
    let inertia = body(&solids[0]).inertia[(0, 0)];
    let cardan = JointSpec::new("cardan", JointKind::Generic, [None, Some(0)], Vector::zeros(), Vector::zeros())
        .free_mode(4, None)
        .free_mode(5, None);
    let mut air = DrySystem::new(solids, joined(cardan), 0.0);
    let start = [0.0, 3.0, 2.0];
    air.engine.set_velocity(0, &Vector::zeros(), &Bivector::from_axial(&start));
    let momentum = |air: &DrySystem<3>| Vector::<3>::from_column_slice(&air.now()[0].spin.axial()) * inertia;
    let (dt, mut turned) = (1e-4, 0.0f64);
    while air.t < 0.4 {
        let before = momentum(&air);
        air.step(dt);
        let torque = Vector::<3>::from_column_slice(&air.assembly.joint_reading(0).torque.axial());
        let off = (momentum(&air) - before - torque * dt).norm();
        // Round-off of the momentum; the torque itself is of first order in the angles.
        assert!(off < 1e-12 * before.norm(), "{off} of {before:?} at {} s: {torque:?}", air.t);
        turned = turned.max(air.assembly.joint_coordinates(0, &air.now())[0].abs());
    }
    assert!(turned > 1.0, "the rotation is large: {turned} rad");
}
