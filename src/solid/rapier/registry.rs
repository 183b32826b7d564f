//! Registration of solids in the engine: the module makes bodies and colliders from solids, adds them before or during
//! a run, and removes them. The module is compiled for each dimension with its world.

use super::super::rapier::{
    dynamics::{RigidBodyBuilder, RigidBodyHandle, SpringCoefficients},
    geometry::ColliderBuilder,
    math::Vector as Point,
    parry::query::contact,
    pipeline::{ActiveHooks, PhysicsWorld},
};
use super::{
    D, HOOKS, RapierWorld,
    colliders::{ConvexParts, collect_parts, thickness},
    joints::LOCK,
    lock, mass_properties, to_angular, to_frame, to_point, translation_locks,
};
use crate::{
    error::Result,
    math::{Bivector, Pose},
    solid::{Kinematics, Role, SolidSpec, rapier::engine::iterations_for_masses as for_masses},
};

impl RapierWorld {
    /// Returns the solid that `solid` would overlap most, and the depth (m) including contact skins.
    pub(super) fn find_deepest_overlap(
        &self,
        solid: &SolidSpec<D>,
        start: &Kinematics<D>,
    ) -> Result<Option<(usize, f64)>> {
        let (parts, frame) = (parts(solid)?, to_frame(&start.pose));
        let mut deepest: Option<(usize, f64)> = None;
        for (_, other) in self.world.colliders.iter() {
            let owner = other.user_data as usize;
            let still = |role: &Role<D>| !matches!(role, Role::Free(_));
            if self.gone[owner] || (still(&solid.role) && !self.body(owner).is_dynamic()) {
                continue;
            }
            for (inner, part) in &parts {
                let skins = solid.contact_skin + other.contact_skin();
                let touch = contact(&(frame * *inner), &**part, other.position(), other.shape(), skins);
                let depth = touch.ok().flatten().map_or(0.0, |touch| skins - touch.dist);
                if depth > deepest.map_or(0.0, |(_, depth)| depth) {
                    deepest = Some((owner, depth));
                }
            }
        }
        Ok(deepest)
    }

    /// Adds a solid after all others.
    pub(super) fn append_solid(&mut self, solid: &SolidSpec<D>, start: &Kinematics<D>) -> Result<()> {
        solid.check_locks()?;
        let parts = parts(solid)?;
        let pairs = !self.ties.contact_pairs.is_empty();
        let body = insert_solid(&mut self.world, self.bodies.len(), solid, start, &parts, pairs);
        if let Role::Free(_) = solid.role {
            self.reach = self.reach.min(0.1 * thickness(&parts));
        }
        self.bodies.push(body);
        self.locks.push(self.world.bodies[body].locked_axes());
        self.ties.contact_pairs.restitution.push(solid.restitution);
        self.bounces |= solid.restitution > 0.0;
        self.gone.push(false);
        self.when_near = iterations_in_contact(&self.world);
        Ok(())
    }

    /// Removes a solid.
    pub(super) fn disable_solid(&mut self, solid: usize) {
        let body = &mut self.world.bodies[self.bodies[solid]];
        if body.is_dynamic() {
            body.set_linvel(Point::ZERO, false);
            body.set_angvel(to_angular(&Bivector::zero()), false);
        }
        body.set_enabled(false);
        self.gone[solid] = true;
        self.pushes.retain(|push| push.0 != solid);
        self.when_near = iterations_in_contact(&self.world);
    }
}

/// Returns the convex parts of `solid`, which other solids touch.
fn parts(solid: &SolidSpec<D>) -> Result<ConvexParts> {
    let mut parts = ConvexParts::new();
    collect_parts(&solid.shape, &Pose::identity(), matches!(solid.role, Role::Fixed), &mut parts)?;
    Ok(parts)
}

/// Returns the number of iterations for the masses of the bodies in the world.
pub(super) fn iterations_in_contact(world: &PhysicsWorld) -> usize {
    let free = world.bodies.iter().filter(|(_, body)| body.is_dynamic() && body.is_enabled());
    for_masses(free.map(|(_, body)| body.mass()))
}

/// Adds solid number `index` to `world`. `pairs` tells whether pairs of solids have contact properties of their own.
pub(super) fn insert_solid(
    world: &mut PhysicsWorld,
    index: usize,
    solid: &SolidSpec<D>,
    start: &Kinematics<D>,
    parts: &ConvexParts,
    pairs: bool,
) -> RigidBodyHandle {
    let hooks = match solid.restitution {
        _ if pairs => ActiveHooks::all(),
        0.0 => HOOKS,
        _ => HOOKS | ActiveHooks::MODIFY_SOLVER_CONTACTS,
    };
    let builder = match (&solid.role, solid.initial_body()) {
        (Role::Driven(_), _) => RigidBodyBuilder::kinematic_position_based(),
        (_, None) => RigidBodyBuilder::fixed(),
        (_, Some(body)) => lock(RigidBodyBuilder::dynamic(), &body)
            .additional_mass_properties(mass_properties(&body, &start.pose.rotation))
            .linvel(to_point(&start.velocity))
            .angvel(to_angular(&start.spin)),
    };
    let handle = world.insert_body(builder.pose(to_frame(&start.pose)).can_sleep(false));
    for (frame, part) in parts {
        let collider = ColliderBuilder::new(part.clone())
            .position(*frame)
            .density(0.0)
            .contact_skin(solid.contact_skin)
            .friction(solid.friction)
            .restitution(0.0)
            .active_hooks(hooks)
            .user_data(index as u128);
        world.insert_collider(collider, Some(handle));
    }
    world.bodies[handle].recompute_mass_properties_from_colliders(&world.colliders);
    translation_locks::add_joint(world, handle, SpringCoefficients::new(LOCK, 1.0));
    handle
}
