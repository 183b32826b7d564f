//! Contacts of rolling capsules and cylinders; the module is compiled for each dimension with its world.
//!
//! The engine keeps the points of a contact while the bodies turn by less than a degree, and moves them along with the material. On a
//! round face the points then lag behind the place where it touches. Normal forces through points behind the axle drive a cylinder
//! forward, with 0.4 % of its weight. This module has the engine find the points of round faces anew in each step; balls have no kept
//! points.

use super::super::ROUND;
use super::super::rapier::{
    geometry::{ContactData, ContactManifold, ContactManifoldData},
    math::{Pose, Real, Vector},
    parry::{
        query::{
            ClosestPoints, Contact, ContactManifoldsWorkspace, DefaultQueryDispatcher, NonlinearRigidMotion,
            PersistentQueryDispatcher, QueryDispatcher, ShapeCastHit, ShapeDistance, ShapeIntersection, Unsupported,
            details::{NormalConstraints, ShapeCastOptions},
        },
        shape::{Compound, Shape},
    },
};

/// The geometric queries of the engine, without kept points of contact on capsules and cylinders.
pub(super) struct RollingContacts;

/// Returns whether a shape, or a part of it, has a face that is curved along the line on which it rolls.
fn is_round(shape: &dyn Shape) -> bool {
    let has_round_part = |parts: &Compound| parts.shapes().iter().any(|(_, part)| is_round(&**part));
    ROUND.contains(&shape.shape_type()) || shape.as_compound().is_some_and(has_round_part)
}

impl QueryDispatcher for RollingContacts {
    fn intersection_test(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
    ) -> Result<ShapeIntersection, Unsupported> {
        DefaultQueryDispatcher.intersection_test(pos12, g1, g2)
    }

    fn distance(&self, pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape) -> Result<ShapeDistance, Unsupported> {
        DefaultQueryDispatcher.distance(pos12, g1, g2)
    }

    fn contact(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        prediction: Real,
    ) -> Result<Option<Contact>, Unsupported> {
        DefaultQueryDispatcher.contact(pos12, g1, g2, prediction)
    }

    fn closest_points(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        max_dist: Real,
    ) -> Result<ClosestPoints, Unsupported> {
        DefaultQueryDispatcher.closest_points(pos12, g1, g2, max_dist)
    }

    fn cast_shapes(
        &self,
        pos12: &Pose,
        local_vel12: Vector,
        g1: &dyn Shape,
        g2: &dyn Shape,
        options: ShapeCastOptions,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        DefaultQueryDispatcher.cast_shapes(pos12, local_vel12, g1, g2, options)
    }

    fn cast_shapes_nonlinear(
        &self,
        motion1: &NonlinearRigidMotion,
        g1: &dyn Shape,
        motion2: &NonlinearRigidMotion,
        g2: &dyn Shape,
        start_time: Real,
        end_time: Real,
        stop_at_penetration: bool,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        let default = DefaultQueryDispatcher;
        default.cast_shapes_nonlinear(motion1, g1, motion2, g2, start_time, end_time, stop_at_penetration)
    }
}

impl PersistentQueryDispatcher<ContactManifoldData, ContactData> for RollingContacts {
    fn contact_manifolds(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        prediction: Real,
        manifolds: &mut Vec<ContactManifold>,
        workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> Result<(), Unsupported> {
        if is_round(g1) || is_round(g2) {
            manifolds.iter_mut().for_each(ContactManifold::mark_shapes_deformed);
        }
        DefaultQueryDispatcher.contact_manifolds(pos12, g1, g2, prediction, manifolds, workspace)
    }

    fn contact_manifold_convex_convex(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        normal_constraints1: Option<&dyn NormalConstraints>,
        normal_constraints2: Option<&dyn NormalConstraints>,
        prediction: Real,
        manifold: &mut ContactManifold,
    ) -> Result<(), Unsupported> {
        let (default, n1, n2) = (DefaultQueryDispatcher, normal_constraints1, normal_constraints2);
        default.contact_manifold_convex_convex(pos12, g1, g2, n1, n2, prediction, manifold)
    }
}
