//! Bodies of the user's own rapier world: the module converts them to solids, applies water loads to them, and returns
//! their kinematics. It is compiled for each dimension with its engine.

use super::rapier::{
    dynamics::{RigidBody, RigidBodyHandle, RigidBodySet, RigidBodyType},
    geometry::{ColliderSet, Shape as Geometry, TypedShape},
};
use super::{D, arc, from_angular, inertia, of_this_dimension, to_angular, world};
use crate::{
    error::{Error, Result},
    geometry::Shape,
    math::{Bivector, Pose, Vector},
    solid::{FreeBody, Kinematics, Load, Role, SolidSpec},
};

/// Returns the solid that represents a body: fixed if the body is fixed, else free. The solid has the body's shape,
/// pose, mass, inertia, velocity and locks. Pass it to a setup for
/// [`Simulation::with_external_bodies`](crate::simulation::Simulation::with_external_bodies).
///
/// The shape consists of the body's colliders without its sensors. The water acts on its true faces, regardless of
/// contact skins.
///
/// # Errors
/// `Scene` if the body does not exist, has no collider, is kinematic, or has no mass yet. The error also occurs for a
/// collider shape that the water model does not support (a half-space, a height field, a cone, a round shape). In that
/// case, define the shape of the solid by hand.
pub fn solid_from_body(
    name: impl Into<String>,
    body: RigidBodyHandle,
    bodies: &RigidBodySet,
    colliders: &ColliderSet,
) -> Result<SolidSpec<D>> {
    let name = name.into();
    let refuse = |what: &str, help: &str| Err(Error::scene(format!("body {name:?} {what}")).help(help));
    let Some(body) = bodies.get(body) else {
        return refuse("is not in this set", "give the set that the handle comes from");
    };
    let mut parts = Vec::new();
    for collider in body.colliders().iter().filter_map(|&handle| colliders.get(handle)).filter(|c| !c.is_sensor()) {
        let place = collider.position_wrt_parent().map_or_else(Pose::identity, world::from_frame);
        parts.push((
            place,
            shape(collider.shape()).map_err(|e| Error { message: format!("{name}: {}", e.message), ..e })?,
        ));
    }
    let own = |place: &Pose<D>| *place == Pose::identity();
    let shape = match parts.pop() {
        None => return refuse("has no collider", "the water needs a shape: insert one, or make the solid by hand"),
        Some((place, only)) if parts.is_empty() && own(&place) => only,
        Some(last) => {
            parts.push(last);
            Shape::Compound(parts)
        }
    };
    let role = match body.body_type() {
        RigidBodyType::Fixed => Role::Fixed,
        RigidBodyType::Dynamic => Role::Free(free(body)),
        _ => {
            let help = "let a law of pontoon's drive it, Role::Driven, and take its pose from step.solids";
            return refuse("is kinematic", help);
        }
    };
    if body.is_dynamic() && body.mass() == 0.0 {
        let help = "rapier has it after a step, or after recompute_mass_properties_from_colliders; a body without any cannot float";
        return refuse("has no mass yet", help);
    }
    let pose = world::from_frame(body.position());
    Ok(SolidSpec {
        name,
        shape,
        pose,
        role,
        friction: 0.0,
        restitution: 0.0,
        contact_skin: 0.0,
        dry: None,
        ballast: Vec::new(),
    })
}

/// Replaces all forces and torques on a body by the load of the water. Rapier keeps forces until they are reset, so add
/// your own forces after this call.
pub fn apply_load(body: &mut RigidBody, load: &Load<D>) {
    body.reset_forces(false);
    body.reset_torques(false);
    body.add_force(world::to_point(&load.force), true);
    body.add_torque(to_angular(&load.torque), true);
}

/// Returns the pose and motion of a body, for `step.solids`.
pub fn kinematics(body: &RigidBody) -> Kinematics<D> {
    Kinematics {
        pose: world::from_frame(body.position()),
        centre: world::from_point(body.center_of_mass()),
        velocity: world::from_point(body.linvel()),
        spin: from_angular(body.angvel()),
    }
}

/// Sets the next pose of a kinematic body to the pose of a driven solid at the end of the step.
pub fn set_kinematic(body: &mut RigidBody, solid: &Kinematics<D>) {
    world::set_next_pose(body, &solid.pose);
}

fn free(body: &RigidBody) -> FreeBody<D> {
    let (own, locks) = (&body.mass_properties().local_mprops, body.locked_axes());
    FreeBody {
        mass: own.mass(),
        centre: world::from_point(own.local_com),
        inertia: inertia(own),
        velocity: world::from_point(body.linvel()),
        spin: from_angular(body.angvel()),
        locked_translations: std::array::from_fn(|i| world::is_locked(locks, i)),
        locked_rotations: std::array::from_fn(|i| i < Bivector::<D>::COMPONENTS && world::is_locked(locks, D + i)),
    }
}

/// Returns the shape of a collider, in the frame of the collider.
fn shape(geometry: &dyn Geometry) -> Result<Shape<D>> {
    Ok(match geometry.as_typed_shape() {
        TypedShape::Ball(ball) => Shape::Ball { radius: ball.radius },
        TypedShape::Cuboid(cuboid) => Shape::Box { size: world::from_point(cuboid.half_extents) * 2.0 },
        TypedShape::Capsule(capsule) => {
            let (a, b) = (world::from_point(capsule.segment.a), world::from_point(capsule.segment.b));
            let (length, along): (f64, Vector<D>) = ((b - a).norm(), b - a);
            let upright = Shape::Capsule { length, radius: capsule.radius, axis: 0 };
            let pose = Pose { position: 0.5 * (a + b), rotation: arc(&along) };
            Shape::Compound(vec![(pose, upright)])
        }
        TypedShape::Compound(compound) => {
            let part = |(place, part): &(_, super::rapier::geometry::SharedShape)| {
                Ok((world::from_frame(place), shape(&**part)?))
            };
            Shape::Compound(compound.shapes().iter().map(part).collect::<Result<_>>()?)
        }
        other => of_this_dimension(&other)?,
    })
}

/// Returns the error of a shape that the water model does not support.
pub(super) fn unsupported_shape(what: &TypedShape) -> Error {
    let name = format!("{what:?}");
    let name = name.split(['(', ' ']).next().unwrap_or_default();
    Error::scene(format!("a collider of the kind {name} has no shape that the water can feel"))
        .help("make the solid by hand: SolidSpec::with_body(name, shape, body), with its shape as a box, polygon, mesh or a compound of these")
}
