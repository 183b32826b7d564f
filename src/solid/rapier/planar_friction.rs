//! Friction of bodies in 3-D that move in a plane, by their locks or because a symmetry plane cuts them.
//!
//! rapier solves both directions of friction at once, with the inverse of a 2 × 2 matrix. If a contact point can move in
//! one of the two directions only, this matrix is singular, and the engine takes the friction as zero. During the step of
//! the engine a joint to the ground therefore holds such a body in its plane, in place of the lock. Friction then has the
//! inverse mass 1/m across the plane, and no sliding to act against. Contacts and ropes oblique to the plane act on the
//! body as with the lock.

use super::{
    D,
    rapier::{
        dynamics::{GenericJoint, JointAxesMask, LockedAxes, RigidBodyBuilder, RigidBodyHandle, SpringCoefficients},
        math::Pose as Frame,
        pipeline::PhysicsWorld,
    },
};

/// Locks of translation and rotation along each axis, and of a joint.
const LOCKS: [(LockedAxes, LockedAxes, JointAxesMask); D] = [
    (LockedAxes::TRANSLATION_LOCKED_X, LockedAxes::ROTATION_LOCKED_X, JointAxesMask::LIN_X),
    (LockedAxes::TRANSLATION_LOCKED_Y, LockedAxes::ROTATION_LOCKED_Y, JointAxesMask::LIN_Y),
    (LockedAxes::TRANSLATION_LOCKED_Z, LockedAxes::ROTATION_LOCKED_Z, JointAxesMask::LIN_Z),
];

/// A body that a joint holds in its plane in the step of the engine.
pub(super) struct Freed {
    body: RigidBodyHandle,
    locks: LockedAxes,
    axis: usize,
    /// Coordinate of the centre of mass (m) and velocity (m/s) along the axis before the step.
    before: [f64; 2],
}

/// Returns the axis across the plane in which a body with these locks moves.
fn normal_axis(locks: LockedAxes) -> Option<usize> {
    let holds =
        |axis: usize| locks.contains(LOCKS[axis].0) && (0..D).all(|turn| turn == axis || locks.contains(LOCKS[turn].1));
    (0..D).find(|&axis| locks != LockedAxes::all() && holds(axis))
}

/// Adds the joint of a body that moves in a plane, as stiff as `lock`.
pub(super) fn hold_in_plane(world: &mut PhysicsWorld, handle: RigidBodyHandle, lock: SpringCoefficients<f64>) {
    let body = &world.bodies[handle];
    let Some(axis) = normal_axis(body.locked_axes()).filter(|_| body.is_dynamic()) else { return };
    let (place, centre) = (body.center_of_mass(), body.mass_properties().local_mprops.local_com);
    let ground = world.insert_body(RigidBodyBuilder::fixed().translation(place));
    let mut joint = GenericJoint::new(LOCKS[axis].2);
    joint.local_frame2 = Frame::from_translation(centre);
    joint.softness = lock;
    world.insert_impulse_joint(ground, handle, joint);
}

/// Takes the lock across its plane off each body that moves in a plane. `locks` are those of each body. What acts on the
/// body along this axis, the joint would take; it is left out.
pub(super) fn free_normals(world: &mut PhysicsWorld, bodies: &[RigidBodyHandle], locks: &[LockedAxes]) -> Vec<Freed> {
    let mut freed = Vec::new();
    for (&handle, &locks) in bodies.iter().zip(locks) {
        let Some(axis) = normal_axis(locks) else { continue };
        let weight = world.gravity[axis];
        let body = &mut world.bodies[handle];
        if body.locked_axes() != locks {
            continue;
        }
        freed.push(Freed { body: handle, locks, axis, before: [body.center_of_mass()[axis], body.linvel()[axis]] });
        let mut force = body.user_force();
        force[axis] = -weight * body.gravity_scale() * body.mass();
        body.reset_forces(false);
        body.add_force(force, false);
        body.set_locked_axes(locks.difference(LOCKS[axis].0), false);
    }
    freed
}

/// Locks the bodies again, and takes back what moved them across their planes.
pub(super) fn hold_normals(world: &mut PhysicsWorld, freed: &[Freed]) {
    for &Freed { body, locks, axis, before: [place, velocity] } in freed {
        let body = &mut world.bodies[body];
        body.set_locked_axes(locks, false);
        let (mut linear, mut translation) = (body.linvel(), body.translation());
        linear[axis] = velocity;
        translation[axis] += place - body.center_of_mass()[axis];
        body.set_linvel(linear, false);
        body.set_translation(translation, false);
    }
}
