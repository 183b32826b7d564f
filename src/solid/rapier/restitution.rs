//! Impacts: two bodies separate with e times their approach speed, at every contact point at once.
//!
//! The module applies Newton's law (Principia, 1687) with Coulomb friction, v_n⁺ = −e v_n⁻ and |J_t| ≤ μ J_n, before
//! the step in which the bodies would touch. Where friction and restitution together would create energy, it omits
//! friction. Joints transmit the impulses at the same instant. The engine's own contacts are springs without restitution,
//! which support resting bodies. The module is compiled for each dimension as part of the world: `super` names the engine.

use serde::{Deserialize, Serialize};

use super::{
    super::{
        Angular,
        rapier::{
            geometry::Collider,
            parry::query::{ContactManifold, DefaultQueryDispatcher, PersistentQueryDispatcher},
        },
    },
    Frame, PhysicsWorld, Point, RigidBodyHandle,
};

/// An impact of two solids at a point.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct Impact {
    /// Numbers of both solids.
    pub(super) between: [usize; 2],
    /// Position of the impact, m.
    pub(super) position: Point,
    /// Vectors from the centres of mass to the point of impact, m.
    pub(super) arms: [Point; 2],
    /// Impulse along the normal, N s.
    pub(super) normal_impulse: f64,
    /// Total impulse on the second solid, N s.
    pub(super) impulse: Point,
}

/// Time over which the module predicts contact, in steps: loads change the approach speed meanwhile.
const AHEAD: f64 = 1.5;

/// Distance at which the engine finds contacts, over the way of the fastest body in a step: [`AHEAD`] and the step of the search,
/// for two bodies of this speed.
pub(super) const SEARCH: f64 = 2.0 * (AHEAD + 1.0);

/// Smallest impact speed, relative to the change of speed by gravity in a step: slower contacts count as rest.
const SLOWEST: f64 = 4.0;

/// Largest number of sweeps over all points; a flat face needs several tens.
const SWEEPS: usize = 400;

/// A change of the velocities of a body.
pub(super) struct Gain {
    pub(super) body: RigidBodyHandle,
    pub(super) velocity: Point,
    pub(super) spin: Angular,
}

/// A point at which two bodies are about to touch.
pub(super) struct Touch {
    /// Numbers of both solids.
    pub(super) owners: [usize; 2],
    bodies: [RigidBodyHandle; 2],
    /// Position, m.
    pub(super) at: Point,
    /// For each axis, the gains by an impulse of 1 N s along it on the second body and the opposite one on the first, if a joint
    /// holds one of both; else empty.
    pub(super) linked: Vec<Vec<Gain>>,
    /// Normal from the first to the second body.
    normal: Point,
    /// Approach speed, negative, m/s.
    meeting: f64,
    restitution: f64,
    friction: f64,
    /// Change of speed along the normal for each unit of normal impulse, 1/kg.
    response: f64,
    /// Accumulated impulses, N s.
    along: f64,
    across: Point,
}

impl Touch {
    /// Returns the bodies that an impulse moves.
    fn moved(&self) -> impl Iterator<Item = RigidBodyHandle> {
        self.bodies.into_iter().chain(self.linked.iter().flatten().map(|gain| gain.body))
    }
}

/// Makes the bodies of `world` that are about to touch at `touches` separate again. Returns the impacts, point by point.
pub(super) fn apply_impacts(world: &mut PhysicsWorld, mut touches: Vec<Touch>) -> Vec<Impact> {
    for touch in &mut touches {
        touch.response = response(world, touch, touch.normal);
    }
    // No impulse moves a held body.
    touches.retain(|touch| touch.response > 0.0);
    if touches.is_empty() {
        return Vec::new();
    }
    let before = Motions::of(world, &touches);
    solve(world, &mut touches);
    if before.energy(world) > before.energy * (1.0 + 1e-12) {
        before.put_back(world);
        for touch in &mut touches {
            (touch.friction, touch.along, touch.across) = (0.0, 0.0, Point::ZERO);
        }
        solve(world, &mut touches);
    }
    let met = |touch: &Touch| Impact {
        between: touch.owners,
        position: touch.at,
        arms: touch.bodies.map(|body| touch.at - world.bodies[body].center_of_mass()),
        normal_impulse: touch.along,
        impulse: touch.normal * touch.along + touch.across,
    };
    touches.iter().map(met).collect()
}

/// Returns the smallest approach speed of an impact, m/s.
pub(super) fn slowest_impact(world: &PhysicsWorld, dt: f64) -> f64 {
    SLOWEST * world.gravity.length() * dt
}

/// Returns the points of all pairs of `world` with at least one point of sufficient approach speed for a step of `dt` (s). `law`
/// returns the restitution and friction of two solids from their numbers and mean friction.
pub(super) fn find(world: &PhysicsWorld, dt: f64, law: impl Fn(usize, usize, f64) -> (f64, f64)) -> Vec<Touch> {
    let slowest = slowest_impact(world, dt);
    let mut touches = Vec::new();
    for pair in world.narrow_phase.contact_pairs() {
        let colliders = [&world.colliders[pair.collider1], &world.colliders[pair.collider2]];
        let owners = colliders.map(|c| c.user_data as usize);
        let friction = 0.5 * (colliders[0].friction() + colliders[1].friction());
        let (restitution, friction) = law(owners[0], owners[1], friction);
        let (Some(first), Some(second)) = (colliders[0].parent(), colliders[1].parent()) else { continue };
        if restitution == 0.0 {
            continue;
        }
        // The engine's points are those of the poses before its last step: a body that slides has left them behind.
        if pair.manifolds().iter().all(|manifold| manifold.points.is_empty()) {
            continue;
        }
        let bodies = [first, second];
        let skins = colliders.map(|c| c.contact_skin());
        let reach = world.integration_parameters.prediction_distance() + skins[0] + skins[1];
        let (mut close, mut struck) = (Vec::new(), false);
        for manifold in present_contacts(colliders, reach) {
            let poses = [
                colliders[0].position() * manifold.subshape_pos1().copied().unwrap_or(Frame::IDENTITY),
                colliders[1].position() * manifold.subshape_pos2().copied().unwrap_or(Frame::IDENTITY),
            ];
            let normal = poses[0].rotation * manifold.local_n1;
            for point in &manifold.points {
                let (p1, p2) = (poses[0] * point.local_p1, poses[1] * point.local_p2);
                // The gap is between the skins, and the point of impact is in the middle of the gap.
                let gap = (p2 - p1).dot(normal) - skins[0] - skins[1];
                let at = 0.5 * (p1 + p2) + normal * (0.5 * (skins[0] - skins[1]));
                let meeting = parting(world, bodies, at).dot(normal);
                struck |= meeting < -slowest && gap + AHEAD * meeting * dt < 0.0;
                if meeting < 0.0 && gap + 2.0 * AHEAD * meeting * dt < 0.0 {
                    let (along, across) = (0.0, Point::ZERO);
                    let (linked, response) = (Vec::new(), 0.0);
                    close.push(Touch {
                        owners,
                        bodies,
                        at,
                        linked,
                        normal,
                        meeting,
                        restitution,
                        friction,
                        response,
                        along,
                        across,
                    });
                }
            }
        }
        if struck {
            touches.extend(close);
        }
    }
    touches
}

/// Returns the contacts of two colliders in their present poses, up to the distance `reach` (m).
fn present_contacts([first, second]: [&Collider; 2], reach: f64) -> Vec<ContactManifold<(), ()>> {
    let (mut manifolds, between) = (Vec::new(), first.position().inv_mul(second.position()));
    let shapes = [first.shape(), second.shape()];
    // Shapes without contacts have none in the engine either.
    let _ = DefaultQueryDispatcher.contact_manifolds(&between, shapes[0], shapes[1], reach, &mut manifolds, &mut None);
    manifolds
}

/// Returns the velocity (m/s) of the second body less that of the first at a point.
fn parting(world: &PhysicsWorld, [a, b]: [RigidBodyHandle; 2], at: Point) -> Point {
    world.bodies[b].velocity_at_point(at) - world.bodies[a].velocity_at_point(at)
}

/// Applies the `impulse` (N s) to the second body of a contact point, and the opposite impulse to the first.
fn give(world: &mut PhysicsWorld, touch: &Touch, impulse: Point) {
    for (axis, gains) in touch.linked.iter().enumerate() {
        for gain in gains {
            let body = &mut world.bodies[gain.body];
            body.set_linvel(body.linvel() + gain.velocity * impulse[axis], false);
            body.set_angvel(body.angvel() + gain.spin * impulse[axis], false);
        }
    }
    if !touch.linked.is_empty() {
        return;
    }
    let [a, b] = touch.bodies;
    world.bodies[a].apply_impulse_at_point(-impulse, touch.at, false);
    world.bodies[b].apply_impulse_at_point(impulse, touch.at, false);
}

/// Returns the change of speed along `direction` for each unit of impulse along it at a contact point, 1/kg.
fn response(world: &mut PhysicsWorld, touch: &Touch, direction: Point) -> f64 {
    let motion = |body: RigidBodyHandle| (body, world.bodies[body].linvel(), world.bodies[body].angvel());
    let held: Vec<_> = touch.moved().map(motion).collect();
    let before = parting(world, touch.bodies, touch.at);
    give(world, touch, direction);
    let gained = (parting(world, touch.bodies, touch.at) - before).dot(direction);
    for (body, velocity, spin) in held {
        set(world, body, velocity, spin);
    }
    gained
}

fn set(world: &mut PhysicsWorld, body: RigidBodyHandle, velocity: Point, spin: Angular) {
    if world.bodies[body].is_dynamic() {
        world.bodies[body].set_linvel(velocity, false);
        world.bodies[body].set_angvel(spin, false);
    }
}

/// Finds the impulses by iteration over the points until they no longer change, and applies them.
fn solve(world: &mut PhysicsWorld, touches: &mut [Touch]) {
    for _ in 0..SWEEPS {
        let mut change: f64 = 0.0;
        for touch in touches.iter_mut() {
            let wanted = -touch.restitution * touch.meeting;
            let lacks = wanted - parting(world, touch.bodies, touch.at).dot(touch.normal);
            let along = (touch.along + lacks / touch.response).max(0.0);
            change = change.max((along - touch.along).abs() * touch.response / wanted);
            give(world, touch, touch.normal * (along - touch.along));
            touch.along = along;
            if touch.friction > 0.0 {
                rub(world, touch);
            }
        }
        if change < 1e-10 {
            break;
        }
    }
}

/// Applies the friction impulse that stops the sliding at a contact point, within the limit that the normal impulse
/// sets.
fn rub(world: &mut PhysicsWorld, touch: &mut Touch) {
    let velocity = parting(world, touch.bodies, touch.at);
    let sliding = velocity - touch.normal * velocity.dot(touch.normal);
    let speed = sliding.length();
    if speed <= 1e-12 * touch.meeting.abs() {
        return;
    }
    let stop = touch.across - sliding / response(world, touch, sliding / speed);
    let most = touch.friction * touch.along;
    let across = if stop.length() > most { stop * (most / stop.length()) } else { stop };
    give(world, touch, across - touch.across);
    touch.across = across;
}

/// The velocities of the bodies in the impacts, and their energy, J.
struct Motions {
    bodies: Vec<(RigidBodyHandle, Point, Angular)>,
    energy: f64,
}

impl Motions {
    fn of(world: &PhysicsWorld, touches: &[Touch]) -> Self {
        let mut handles: Vec<_> = touches.iter().flat_map(Touch::moved).collect();
        handles.sort_by_key(|handle| handle.into_raw_parts());
        handles.dedup();
        handles.retain(|&handle| world.bodies[handle].is_dynamic());
        let motion = |handle: RigidBodyHandle| (handle, world.bodies[handle].linvel(), world.bodies[handle].angvel());
        let mut motions = Self { bodies: handles.into_iter().map(motion).collect(), energy: 0.0 };
        motions.energy = motions.energy(world);
        motions
    }

    fn energy(&self, world: &PhysicsWorld) -> f64 {
        self.bodies.iter().map(|(handle, ..)| world.bodies[*handle].kinetic_energy()).sum()
    }

    fn put_back(&self, world: &mut PhysicsWorld) {
        for &(body, velocity, spin) in &self.bodies {
            set(world, body, velocity, spin);
        }
    }
}
