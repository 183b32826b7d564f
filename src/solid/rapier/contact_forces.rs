//! Contact forces of the engine in the last step; the module is compiled for each dimension with its world.
//!
//! The normal n of a contact points from the first solid to the second. The contact applies the impulse λ n − Σ τ t to
//! the second solid and the opposite impulse to the first. λ and τ are the engine's sums over its iterations, and t are
//! its tangents for the direction −n.

use std::collections::BTreeMap;

use super::{
    super::{friction, rapier::geometry::ContactData},
    D, Impact, PhysicsWorld, Point, RigidBody, RigidBodyHandle, from_point,
};
use crate::{
    math::Vector,
    solid::{ContactForce, Load},
};

/// Returns the forces of the pairs with normal force, in order of the solids' numbers.
pub(super) fn pair_forces(world: &PhysicsWorld, bodies: &[RigidBodyHandle], met: &[Impact]) -> Vec<ContactForce<D>> {
    let mut pairs = Pairs(BTreeMap::new());
    let rate = 1.0 / world.integration_parameters.dt;
    for met in met {
        let (at, force) = (from_point(met.position), from_point(met.impulse) * rate);
        pairs.add(met.between, met.normal_impulse * rate, &at, met.arms.map(from_point), force);
    }
    for pair in world.narrow_phase.contact_pairs() {
        let between = [pair.collider1, pair.collider2].map(|c| world.colliders[c].user_data as usize);
        let [first, second] = between.map(|solid| &world.bodies[bodies[solid]]);
        for manifold in pair.solver_manifolds() {
            let normal = manifold.data.normal;
            for contact in manifold.data.solver_contacts.iter() {
                let data = &manifold.points[contact.contact_indices()[0] as usize].data;
                if data.impulse > 0.0 {
                    let force = from_point(impulse(normal, data)) * rate;
                    let (at, other) = (place(first, data.solver_dp1), place(second, data.solver_dp2));
                    let arms = [(first, at), (second, other)].map(|(body, at)| from_point(at - body.center_of_mass()));
                    // The engine applies the impulse at the face of the second solid, with both contact skins before
                    // it; the reported point is between the skins.
                    let meet = at - normal * world.colliders[pair.collider2].contact_skin();
                    pairs.add(between, data.impulse * rate, &from_point(meet), arms, force);
                }
            }
        }
    }
    let mean = |(between, mut contact): ([usize; 2], ContactForce<D>)| {
        contact.at /= contact.normal_force;
        ContactForce { between, ..contact }
    };
    pairs.0.into_iter().map(mean).collect()
}

/// Returns the position of a contact from the `arm` on `body` that the engine stores (m); for a fixed body the engine
/// stores the position itself.
fn place(body: &RigidBody, arm: Point) -> Point {
    if body.is_fixed() { arm } else { body.center_of_mass() + arm }
}

/// Returns the impulse of a contact on its second solid, N s.
fn impulse(normal: Point, data: &ContactData) -> Point {
    normal * data.impulse - friction(-normal, data)
}

struct Pairs(BTreeMap<[usize; 2], ContactForce<D>>);

impl Pairs {
    /// Adds a contact of the solids `between`, at `arms` (m) from their centres. `pressing` (N) is the normal force,
    /// and `force` (N) is the total force on the second solid.
    fn add(&mut self, between: [usize; 2], pressing: f64, at: &Vector<D>, arms: [Vector<D>; 2], force: Vector<D>) {
        let [first, second] = arms;
        let mut loads = [Load::from_force_at(&first, -force), Load::from_force_at(&second, force)];
        let [a, b] = between;
        if a > b {
            loads.reverse();
        }
        let none = ContactForce { between, normal_force: 0.0, at: Vector::zeros(), loads: [Load::zero(); 2] };
        let sum = self.0.entry([a.min(b), a.max(b)]).or_insert(none);
        sum.normal_force += pressing;
        sum.at += at * pressing;
        sum.loads.iter_mut().zip(loads).for_each(|(sum, load)| *sum += load);
    }
}
