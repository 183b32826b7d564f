//! Locked translations of bodies in 3-D, by their locks or because a symmetry plane cuts them.
//!
//! rapier solves both directions of friction at once, with the inverse of a 2 × 2 matrix. If a contact point can move in
//! one of the two directions only, as on a body that moves in a plane, this matrix is singular, and the engine takes the
//! friction as zero. During the step of the engine a joint of the centre of mass to the ground therefore takes the place
//! of the locked translations. Friction then has the inverse mass 1/m along a locked axis, and no sliding to act against.

use super::{
    D,
    rapier::{
        dynamics::{
            GenericJoint, ImpulseJointHandle, JointAxesMask, LockedAxes, RigidBody, RigidBodyBuilder, RigidBodyHandle,
            SpringCoefficients,
        },
        math::{Pose as Frame, Vector as Point},
        pipeline::PhysicsWorld,
    },
};

/// Mark of the joints of this module.
const MARK: u128 = 1;

/// Locks of translation along each axis, of a body and of a joint.
const LOCKS: [(LockedAxes, JointAxesMask); D] = [
    (LockedAxes::TRANSLATION_LOCKED_X, JointAxesMask::LIN_X),
    (LockedAxes::TRANSLATION_LOCKED_Y, JointAxesMask::LIN_Y),
    (LockedAxes::TRANSLATION_LOCKED_Z, JointAxesMask::LIN_Z),
];

/// A body that a joint holds in the step of the engine.
pub(super) struct Freed {
    body: RigidBodyHandle,
    locks: LockedAxes,
    /// Centre of mass (m) and velocity (m/s) before the step.
    before: [Point; 2],
}

/// Returns the axes along which a body with these locks cannot move, none if it cannot turn either.
fn locked_axes(locks: LockedAxes) -> impl Iterator<Item = usize> {
    (0..D).filter(move |&axis| locks != LockedAxes::all() && locks.contains(LOCKS[axis].0))
}

/// Adds the joint of a body with locked translations, as stiff as `lock`.
pub(super) fn add_joint(world: &mut PhysicsWorld, handle: RigidBodyHandle, lock: SpringCoefficients<f64>) {
    let body = &world.bodies[handle];
    let axes = locked_axes(body.locked_axes()).fold(JointAxesMask::empty(), |axes, axis| axes | LOCKS[axis].1);
    if axes.is_empty() || !body.is_dynamic() {
        return;
    }
    let ground = world.insert_body(RigidBodyBuilder::fixed());
    let mut joint = GenericJoint::new(axes);
    (joint.softness, joint.user_data) = (lock, MARK);
    world.insert_impulse_joint(ground, handle, joint);
}

/// Replaces the locked translations of each body by its joint. `locks` are those of each body. The joint would take what
/// acts on the body along these axes; the function leaves it out.
pub(super) fn free(world: &mut PhysicsWorld, bodies: &[RigidBodyHandle], locks: &[LockedAxes]) -> Vec<Freed> {
    let mut freed = Vec::new();
    for (&handle, &locks) in bodies.iter().zip(locks) {
        let gravity = world.gravity;
        let body = &mut world.bodies[handle];
        if locked_axes(locks).next().is_none() || body.locked_axes() != locks {
            continue;
        }
        let centre = body.center_of_mass();
        freed.push(Freed { body: handle, locks, before: [centre, body.linvel()] });
        let mut force = body.user_force();
        for axis in locked_axes(locks) {
            force[axis] = -gravity[axis] * body.gravity_scale() * body.mass();
        }
        body.reset_forces(false);
        body.add_force(force, false);
        body.set_locked_axes(locked_axes(locks).fold(locks, |left, axis| left.difference(LOCKS[axis].0)), false);
        let frames = [centre, body.mass_properties().local_mprops.local_com].map(Frame::from_translation);
        if let Some(joint) = joint_of(world, handle).and_then(|joint| world.impulse_joints.get_mut(joint, false)) {
            [joint.data.local_frame1, joint.data.local_frame2] = frames;
        }
    }
    freed
}

fn joint_of(world: &PhysicsWorld, body: RigidBodyHandle) -> Option<ImpulseJointHandle> {
    world.impulse_joints.attached_joints(body).find(|joint| joint.3.data.user_data == MARK).map(|joint| joint.2)
}

/// Locks the bodies again, and takes back what moved them along the locked axes.
pub(super) fn lock(world: &mut PhysicsWorld, freed: &[Freed]) {
    for &Freed { body, locks, before: [centre, velocity] } in freed {
        let body: &mut RigidBody = &mut world.bodies[body];
        body.set_locked_axes(locks, false);
        let (mut linear, mut translation) = (body.linvel(), body.translation());
        for axis in locked_axes(locks) {
            linear[axis] = velocity[axis];
            translation[axis] += centre[axis] - body.center_of_mass()[axis];
        }
        body.set_linvel(linear, false);
        body.set_translation(translation, false);
    }
}
