//! Friction of bodies in 3-D that move in a plane, by their locks or because a symmetry plane cuts them.
//!
//! rapier solves both directions of friction at once, with the inverse of a 2 × 2 matrix. If a contact point can move in
//! one of the two directions only, this matrix is singular, and the engine takes the friction as zero. This is so where
//! the normal of the contact lies in the plane of motion. There the direction across this plane does not act on the
//! others: the body gets back its translation across the plane for the step of the engine, without a load along it.
//! Friction then has the inverse mass 1/m in this direction, and no sliding to act against. Where a contact oblique to the
//! plane presses as well, the body stays locked, and its contacts in the plane have no friction.

use super::{
    D,
    rapier::{
        dynamics::{LockedAxes, RigidBody, RigidBodyHandle},
        geometry::ColliderHandle,
        pipeline::PhysicsWorld,
    },
};

/// Largest component of a unit vector across the plane of motion at which the vector counts as one in the plane, –. Its square is
/// the error of what acts along the vector.
const IN_PLANE: f64 = 1e-3;

/// Locks of translation and rotation along each axis.
const LOCKS: [[LockedAxes; 2]; D] = [
    [LockedAxes::TRANSLATION_LOCKED_X, LockedAxes::ROTATION_LOCKED_X],
    [LockedAxes::TRANSLATION_LOCKED_Y, LockedAxes::ROTATION_LOCKED_Y],
    [LockedAxes::TRANSLATION_LOCKED_Z, LockedAxes::ROTATION_LOCKED_Z],
];

/// A body that may move across its plane of motion in the step of the engine.
pub(super) struct Freed {
    body: RigidBodyHandle,
    locks: LockedAxes,
    axis: usize,
    /// Coordinate of the centre of mass (m) and velocity (m/s) along the axis before the step.
    before: [f64; 2],
}

/// Returns the axis across the plane in which a body with these locks moves.
fn normal_axis(locks: LockedAxes) -> Option<usize> {
    let holds = |axis: usize| {
        let turns = (0..D).filter(|&turn| turn != axis).map(|turn| LOCKS[turn][1]);
        locks.contains(LOCKS[axis][0]) && turns.into_iter().all(|turn| locks.contains(turn))
    };
    (0..D).find(|&axis| locks != LockedAxes::all() && holds(axis))
}

/// Frees the translation of each body across its plane of motion, if all contacts and ropes of the body lie in this plane.
/// `locks` are those of each body. A contact that begins in this step shows its normal in the next.
pub(super) fn free_normals(world: &mut PhysicsWorld, bodies: &[RigidBodyHandle], locks: &[LockedAxes]) -> Vec<Freed> {
    let mut freed = Vec::new();
    for (&handle, &locks) in bodies.iter().zip(locks) {
        let Some(axis) = normal_axis(locks) else { continue };
        let body = &world.bodies[handle];
        if body.locked_axes() != locks || !touches_in_plane(world, body, axis) || !is_tied_in_plane(world, handle, axis)
        {
            continue;
        }
        let weight = world.gravity[axis] * body.gravity_scale() * body.mass();
        let before = [body.center_of_mass()[axis], body.linvel()[axis]];
        freed.push(Freed { body: handle, locks, axis, before });
        let body = &mut world.bodies[handle];
        let mut force = body.user_force();
        force[axis] = -weight;
        body.reset_forces(false);
        body.add_force(force, false);
        body.set_locked_axes(locks.difference(LOCKS[axis][0]), false);
    }
    freed
}

/// Locks the bodies again, and takes back what round-off moved them across their planes.
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

/// Returns whether all contacts of a body after the last step act in its plane of motion. A face beside the plane does
/// not act until it is pressed into the body, an oblique face not until it touches.
fn touches_in_plane(world: &PhysicsWorld, body: &RigidBody, axis: usize) -> bool {
    let pairs = |&collider: &ColliderHandle| world.narrow_phase.contact_pairs_with(collider);
    body.colliders().iter().flat_map(pairs).all(|pair| {
        let skins = [pair.collider1, pair.collider2].map(|collider| world.colliders[collider].contact_skin());
        let may_overlap = world.integration_parameters.allowed_linear_error();
        pair.manifolds().iter().all(|manifold| {
            let across = manifold.data.normal[axis].abs();
            let allowed = if across >= 1.0 - IN_PLANE { may_overlap } else { 0.0 };
            across <= IN_PLANE || manifold.points.iter().all(|point| point.dist - skins[0] - skins[1] > -allowed)
        })
    })
}

/// Returns whether both ends of each rope of a body are at the same coordinate across its plane of motion.
fn is_tied_in_plane(world: &PhysicsWorld, handle: RigidBodyHandle, axis: usize) -> bool {
    world.impulse_joints.attached_joints(handle).all(|(_, _, _, joint)| {
        let ends = [(joint.body1(), joint.data.local_frame1), (joint.body2(), joint.data.local_frame2)];
        let [a, b] = ends.map(|(body, frame)| (world.bodies[body].position() * frame).translation);
        joint.data.coupled_axes.is_empty() || (a - b)[axis].abs() <= IN_PLANE * (a - b).length()
    })
}
