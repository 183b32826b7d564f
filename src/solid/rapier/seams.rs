//! Seams of flush parts. Each collider is convex. A body that slides from one part to the next is pressed into both a little, and so
//! meets the edge or the hidden side of the next one as an obstacle. These contacts are left out: those whose normal leads into
//! another part, or less far away from it than from the own one, where the two meet flush. The module is compiled for each dimension
//! with its world.

use super::super::rapier::{
    dynamics::{RigidBody, RigidBodySet},
    geometry::{Collider, ColliderHandle, ColliderSet},
    math::Vector as Point,
    parry::bounding_volume::BoundingVolume,
};

/// Part of a step along a normal by which another part is nearer than the own one; a slope of 1.4e-3 makes it.
const NEARER: f64 = 1e-6;

/// Least cosine of the angle between the normals of two parts whose edge is a seam, and not a corner between floor and wall.
const ALIKE: f64 = 0.5;

/// Returns whether another part of the same solid, or of the fixed ones, hides the place `at` (m) of collider `own` with the outward
/// normal `out`. `step` (m) is the length that counts as flush. Parts count of which `supports` holds.
pub(super) fn is_hidden(
    (bodies, colliders): (&RigidBodySet, &ColliderSet),
    own: ColliderHandle,
    (at, out): (Point, Point),
    step: f64,
    supports: impl Fn(&Collider) -> bool,
) -> bool {
    let (this, x) = (&colliders[own], at + out * step);
    let is_fixed = |c: &Collider| c.parent().and_then(|body| bodies.get(body)).is_none_or(RigidBody::is_fixed);
    let is_other = |handle: ColliderHandle, other: &Collider| {
        handle != own
            && other.is_enabled()
            && (other.parent() == this.parent() || (is_fixed(this) && is_fixed(other)))
            && other.shape().is_convex()
            && supports(other)
    };
    colliders.iter().filter(|(handle, other)| is_other(*handle, other)).any(|(_, other)| {
        if !other.compute_aabb().loosened(step).contains_local_point(x) {
            return false;
        }
        let near = other.shape().project_point(other.position(), x, false);
        let way = x - near.point;
        let distance = way.length();
        if !near.is_inside {
            return distance < step * (1.0 - NEARER) && way.dot(out) > ALIKE * distance;
        }
        // A wall goes on where the place is out of the other part.
        let exit = at - way * (1.0 + step / distance);
        distance > 0.0 && this.shape().distance_to_point(this.position(), exit, true) > 0.5 * step
    })
}
