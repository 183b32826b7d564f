//! The world of rigid bodies, from one source that is compiled for each dimension: `super` names the engine (`rapier`)
//! and provides the parts that differ.
//!
//! The settings result from measurements with this version of rapier:
//!
//! - The solver makes one iteration. More iterations keep the load constant over sub-steps, which adds energy to
//!   oscillations. If bodies of unlike mass are about to touch, the solver makes more iterations, which stiffen their
//!   contacts.
//! - Contacts are critically damped springs of min(0.05/dt, 1000) Hz for each iteration; the weight of the lighter body
//!   compresses them by g/(2πf)². While bodies touch, f follows dt slowly: after a jump, a spring that is compressed for
//!   another f would press with another force.
//! - Contact recycling is off, because it leaves small bodies hanging on ledges. Sleep is off.
//! - Continuous collision detection is off, because no body passes through a wall in one step of the water.
//!
//! The module `restitution` makes bodies rebound; the springs do not. Colliders have the true faces; other bodies touch them
//! there, or at the contact skin that the solid sets. The friction and restitution of a pair are the means of both solids'
//! values. Only this module applies weight. Mass and inertia belong to the body; colliders have no mass.

#[allow(clippy::duplicate_mod, reason = "one source, compiled against each engine")]
#[path = "colliders.rs"]
mod colliders;
#[allow(clippy::duplicate_mod, reason = "one source, compiled against each engine")]
#[path = "restitution.rs"]
mod restitution;
#[allow(clippy::duplicate_mod, reason = "one source, compiled against each engine")]
#[path = "registry.rs"]
mod registry;
#[allow(clippy::duplicate_mod, reason = "one source, compiled against each engine")]
#[path = "joints.rs"]
mod joints;
#[allow(clippy::duplicate_mod, reason = "one source, compiled against each engine")]
#[path = "contact_forces.rs"]
mod contact_forces;
#[allow(clippy::duplicate_mod, reason = "one source, compiled against each engine")]
#[path = "rolling.rs"]
mod rolling;

use super::rapier::{
    dynamics::{LockedAxes, RigidBody, RigidBodyHandle, SpringCoefficients},
    math::{Pose as Frame, Vector as Point},
    pipeline::PhysicsWorld,
};
use super::{
    Angular, D, ENGINE, HOOKS, from_angular, from_rotation, inverse_inertia, lock, mass_properties, nearest_form,
    to_angular, to_rotation, translation_locks, tune, unwind, wind,
};
use crate::{
    error::{ErrorCode, Result},
    math::{Bivector, Matrix, Pose, Vector},
    solid::{
        Constraints, FreeBody, Kinematics, Load, Mobility, Role, SolidSpec,
        rapier::engine::{ContactForce, Engine, EngineFault, restart_error},
    },
};
use colliders::{ConvexParts, check_overlap, collect_parts, thickness};
use joints::{RapierJoints, SWEEPS};
use restitution::Impact;
use rolling::RollingContacts;

/// Largest overlap at the start, in dp: it allows for round-off of the placement.
const OVERLAP_MAX: f64 = 0.05;

/// Damping ratio of a contact, –: critical damping.
const CONTACT_DAMPING: f64 = 1.0;

/// Decrease of the step for which pressing contacts are tuned, over the time passed, –. A contact of the frequency f follows with a lag
/// of 2/(2πf), in which f grows by 2 %; its force errs by twice as much.
const TUNING: f64 = 0.01 * 0.05 * std::f64::consts::TAU;

/// Tolerance of the test for a body under its weight alone: the relative difference in speed from free fall, –.
const ALONE: f64 = 1e-12;

/// A world of rigid bodies in this dimension.
pub(in crate::solid) struct RapierWorld {
    world: PhysicsWorld,
    bodies: Vec<RigidBodyHandle>,
    /// Whether any pair of solids can have a restitution.
    bounces: bool,
    /// Iterations of a step in which bodies may touch.
    when_near: usize,
    /// Iterations of the last step.
    iterations: usize,
    /// Impacts of the last step, with their impulses, N s.
    met: Vec<Impact>,
    /// A tenth of the smallest thickness of a free body, m: the distance at which the engine begins to predict
    /// contacts.
    reach: f64,
    /// Duration of an iteration for which the contact stiffness was last set, s; 0 before the first step, and negative if the
    /// number of iterations has changed since.
    tuned_for: f64,
    pushes: Vec<Push>,
    ties: RapierJoints,
    /// Locked axes of each solid while it is not held.
    locks: Vec<LockedAxes>,
    /// Whether each solid is removed.
    gone: Vec<bool>,
    /// Gyroscopic rates in the last step of the solids that the engine turns by their spin, N m.
    turned: Vec<Option<Bivector<D>>>,
}

/// A load on a solid in the next step.
type Push = (usize, Load<D>);

/// What a checkpoint holds of a [`RapierWorld`]: its world, `tuned_for`, `met` and `pushes`.
type SavedWorld = (PhysicsWorld, f64, Vec<Impact>, Vec<Push>);

impl RapierWorld {
    pub(in crate::solid) fn new(
        solids: &[SolidSpec<D>],
        start: &[Kinematics<D>],
        links: &Constraints<D>,
        gravity: &Vector<D>,
        dp: f64,
    ) -> Result<Self> {
        assert_eq!(solids.len(), start.len(), "every solid needs a start");
        links.check(solids)?;
        let mut all_parts = Vec::new();
        for (i, solid) in solids.iter().enumerate() {
            solid.check_role()?;
            solid.check_locks()?;
            let mut parts = ConvexParts::new();
            let fixed = matches!(solid.role, Role::Fixed);
            collect_parts(&solid.shape, &Pose::identity(), fixed, &mut parts)
                .map_err(|e| e.at("", None, format!("solid.{i}.shape")))?;
            all_parts.push(parts);
        }
        check_overlap(solids, start, &all_parts, links, OVERLAP_MAX * dp)?;
        let mut world = PhysicsWorld { gravity: to_point(gravity), ..PhysicsWorld::default() };
        let free = solids.iter().zip(&all_parts).filter(|(solid, _)| matches!(solid.role, Role::Free(_)));
        let reach = 0.1 * free.map(|(_, parts)| thickness(parts)).fold(0.2, f64::min);
        settle(&mut world, reach);
        let pairs = !links.contacts.is_empty();
        let insert = |i: usize| registry::insert_solid(&mut world, i, &solids[i], &start[i], &all_parts[i], pairs);
        let bodies: Vec<_> = (0..solids.len()).map(insert).collect();
        let restitution = solids.iter().map(|solid| solid.restitution).collect();
        let ties = RapierJoints::new(&mut world, &bodies, links, start, restitution);
        let locks = bodies.iter().map(|&body| world.bodies[body].locked_axes()).collect();
        let rebounds = |a, b| links.contacts.find(a, b).and_then(|pair| pair.restitution).is_some_and(|e| e > 0.0);
        let bounces = solids.iter().any(|solid| solid.restitution > 0.0)
            || (0..solids.len()).any(|b| (0..b).any(|a| rebounds(a, b)));
        let (when_near, met, pushes) = (registry::iterations_in_contact(&world), Vec::new(), Vec::new());
        let gone = vec![false; bodies.len()];
        Ok(Self {
            world,
            bodies,
            bounces,
            when_near,
            iterations: 1,
            met,
            reach,
            tuned_for: 0.0,
            pushes,
            ties,
            locks,
            gone,
            turned: Vec::new(),
        })
    }

    /// Reads a saved state of the same solids.
    fn read_state(&self, bytes: &[u8]) -> Result<SavedWorld> {
        let (engine, rest): (&str, &[u8]) = postcard::take_from_bytes(bytes).map_err(restart_error)?;
        if engine != ENGINE {
            return Err(restart_error(format!("they were written by {engine}, this is {ENGINE}")));
        }
        let saved: SavedWorld = postcard::from_bytes(rest).map_err(restart_error)?;
        let (world, _, _, pushes) = &saved;
        let same = world.bodies.len() == self.world.bodies.len()
            && world.impulse_joints.len() == self.world.impulse_joints.len()
            && self.bodies.iter().all(|&h| world.bodies.contains(h))
            && pushes.iter().all(|push| push.0 < self.bodies.len());
        if !same {
            let (there, own) = (world.bodies.len(), self.bodies.len());
            return Err(restart_error(format!("{there} solids, where the scene has {own}")));
        }
        Ok(saved)
    }

    fn body(&self, solid: usize) -> &RigidBody {
        &self.world.bodies[self.bodies[solid]]
    }

    /// Sets the time step and the contact parameters that depend on it.
    fn pace(&mut self, dt: f64) {
        assert!(dt > 0.0 && dt.is_finite(), "a step takes time");
        let fastest = self.world.bodies.iter().map(|(_, body)| body.linvel().length()).fold(0.0, f64::max);
        let parameters = &mut self.world.integration_parameters;
        parameters.dt = dt;
        let ahead = if self.bounces { restitution::SEARCH } else { 2.0 };
        parameters.normalized_prediction_distance = self.reach.max(ahead * fastest * dt);
        let iterations = parameters.num_solver_iterations as f64;
        let (step, tuned_for) = (dt / iterations, self.tuned_for.abs());
        if (0.5..=2.0).contains(&(step / tuned_for)) {
            self.tuned_for = tuned_for;
            return;
        }
        let presses = self.tuned_for > 0.0 && self.has_contact_points();
        let gradual = tuned_for.clamp(0.5 * step, 2.0 * step).max(tuned_for - TUNING * dt);
        let (tuned_for, of_step) = if presses { (gradual, gradual * iterations) } else { (step, dt) };
        self.tuned_for = tuned_for;
        let frequency = (0.05 / of_step).min(1000.0) * iterations;
        let parameters = &mut self.world.integration_parameters;
        parameters.contact_softness = SpringCoefficients::new(frequency, CONTACT_DAMPING);
        parameters.static_contact_softness = parameters.contact_softness;
    }

    /// Chooses the number of iterations of the next step. A change of the number disturbs pressing contacts, so it
    /// takes place before any bodies touch.
    fn foresee(&mut self) {
        let number = if self.has_contact_points() { self.when_near } else { 1 };
        let parameters = &mut self.world.integration_parameters;
        if number != parameters.num_solver_iterations {
            parameters.num_solver_iterations = number;
            self.tuned_for = -self.tuned_for.abs();
        }
    }

    /// Returns whether the engine has a point of contact, or of a contact that it predicts.
    fn has_contact_points(&self) -> bool {
        self.world.narrow_phase.contact_pairs().any(|pair| pair.manifolds().iter().any(|m| !m.points.is_empty()))
    }

    /// Replaces the forces on the free bodies by `loads` and the user's forces.
    fn load(&mut self, loads: &[Load<D>]) -> std::result::Result<(), EngineFault<D>> {
        assert_eq!(loads.len(), self.bodies.len(), "every solid needs a load");
        let mut total = loads.to_vec();
        for (solid, push) in self.pushes.drain(..) {
            total[solid] += push;
        }
        for (solid, load) in total.iter().enumerate() {
            if !self.body(solid).is_dynamic() {
                continue;
            }
            if !(load.force.norm_squared() + load.torque.0.norm_squared()).is_finite() {
                let cause = "a pressure or velocity nearby blew up: try a smaller CFL number, a higher speed of \
                             sound or a finer dp; or a push was not finite";
                return Err(self.fault(solid, "load not finite", cause));
            }
            let body = &mut self.world.bodies[self.bodies[solid]];
            body.reset_forces(false);
            body.reset_torques(false);
            body.add_force(to_point(&load.force), true);
            body.add_torque(to_angular(&load.torque), true);
        }
        Ok(())
    }

    /// Sets the poses of the driven bodies at the end of the step in rapier.
    fn drive(&mut self, driven: &[Option<Kinematics<D>>]) -> std::result::Result<(), EngineFault<D>> {
        for (solid, kinematics) in driven.iter().enumerate() {
            let Some(Kinematics { pose, .. }) = kinematics else { continue };
            if !(pose.position.norm_squared() + pose.rotation.norm_squared()).is_finite() {
                let cause = "its law of motion is not finite at this time: check the formula or table";
                return Err(self.fault(solid, "prescribed position not finite", cause));
            }
            set_next_pose(&mut self.world.bodies[self.bodies[solid]], pose);
        }
        Ok(())
    }

    /// Moves each body on which only its weight acted, in the step of `dt` (s), by the mean of its velocities before
    /// and after. This position lies on the parabola of free fall; rapier uses the velocity after the step, in each of
    /// its iterations.
    fn fall(&mut self, dt: f64, before: &[Point]) {
        let gained = self.world.gravity * dt;
        let ahead = gained * (0.5 * dt / self.iterations as f64);
        for (&handle, velocity) in self.bodies.iter().zip(before) {
            let body = &self.world.bodies[handle];
            let other = (body.linvel() - *velocity - gained).length();
            if body.is_dynamic() && other <= ALONE * (velocity.length() + gained.length()) {
                let place = body.translation() - ahead;
                self.world.bodies[handle].set_translation(place, false);
            }
        }
    }

    /// Checks that the state of every solid is valid after the step. Rapier disables a body with an invalid state and
    /// returns it to its last valid position.
    fn examine(&self, before: &[Point]) -> std::result::Result<(), EngineFault<D>> {
        for (solid, velocity) in before.iter().enumerate().filter(|(solid, _)| !self.gone[*solid]) {
            let body = self.body(solid);
            let whole = body.is_enabled() && body.colliders().iter().all(|&c| self.world.colliders[c].is_enabled());
            if !(whole && body.position().is_finite() && body.linvel().length_squared().is_finite()) {
                let cause = "a load or a contact was too strong for the step: try a smaller CFL number or dt_max, \
                             and look for bodies pressed into one another";
                let fault = self.fault(solid, "position or velocity not finite", cause);
                return Err(EngineFault { velocity: from_point(*velocity), ..fault });
            }
        }
        Ok(())
    }

    fn fault(&self, solid: usize, reason: &str, cause: &'static str) -> EngineFault<D> {
        let body = self.body(solid);
        EngineFault {
            code: ErrorCode::NonFiniteState,
            solid,
            reason: reason.into(),
            cause,
            position: from_point(body.translation()),
            velocity: from_point(body.linvel()),
        }
    }
}

impl Engine<D> for RapierWorld {
    fn kinematics(&self, solid: usize) -> Kinematics<D> {
        kinematics_of(self.body(solid))
    }

    fn step(
        &mut self,
        dt: f64,
        loads: &[Load<D>],
        driven: &[Option<Kinematics<D>>],
    ) -> std::result::Result<(), EngineFault<D>> {
        self.pace(dt);
        self.load(loads)?;
        self.drive(driven)?;
        let before: Vec<Point> = (0..self.bodies.len()).map(|i| self.body(i).linvel()).collect();
        let spins: Vec<Angular> = (0..self.bodies.len()).map(|i| self.body(i).angvel()).collect();
        self.ties.contact_pairs.slowest = restitution::slowest_impact(&self.world, dt);
        let pairs = &self.ties.contact_pairs;
        let mut touches = restitution::find(&self.world, dt, |a, b, mu| pairs.restitution_and_friction(a, b, mu));
        self.ties.link(&self.world, &self.bodies, &mut touches);
        self.met = restitution::apply_impacts(&mut self.world, touches);
        self.ties.update_rope_limits(&mut self.world, dt);
        self.ties.update_end_stops(&mut self.world, &self.bodies, driven, dt);
        self.ties.apply_series_loads(&mut self.world, &self.bodies, driven, dt);
        let turnings = wind(&mut self.world, &self.bodies, dt);
        let freed = translation_locks::free(&mut self.world, &self.bodies, &self.locks);
        self.world.step_with_events(&self.ties.contact_pairs, &());
        translation_locks::lock(&mut self.world, &freed);
        self.ties.turn_velocities(&mut self.world, &self.bodies, driven, dt);
        self.turned = unwind(&mut self.world, &self.bodies, turnings, &spins, dt);
        self.iterations = self.world.integration_parameters.num_solver_iterations;
        self.fall(dt, &before);
        self.foresee();
        self.examine(&before)
    }

    fn push(&mut self, solid: usize, force: &Vector<D>, at: &Vector<D>) {
        let torque = Bivector::torque(&(at - from_point(self.body(solid).center_of_mass())), force);
        self.pushes.push((solid, Load { force: *force, torque }));
    }

    fn add_load(&mut self, solid: usize, load: &Load<D>) {
        self.pushes.push((solid, *load));
    }

    fn applied_push(&self, solid: usize) -> Load<D> {
        self.pushes.iter().filter(|push| push.0 == solid).map(|push| push.1).sum()
    }

    fn set_velocity(&mut self, solid: usize, velocity: &Vector<D>, spin: &Bivector<D>) {
        let body = &mut self.world.bodies[self.bodies[solid]];
        let locks = body.locked_axes();
        let free = |mode: usize, rate: f64| if is_locked(locks, mode) { 0.0 } else { rate };
        let turns: Vec<f64> = spin.axial().iter().enumerate().map(|(i, rate)| free(D + i, *rate)).collect();
        body.set_linvel(to_point(&Vector::from_fn(|i, _| free(i, velocity[i]))), true);
        body.set_angvel(to_angular(&Bivector::from_axial(&turns)), true);
    }

    fn deepest_overlap(&self, solid: &SolidSpec<D>, start: &Kinematics<D>) -> Result<Option<(usize, f64)>> {
        self.find_deepest_overlap(solid, start)
    }

    fn add_body(&mut self, solid: &SolidSpec<D>, start: &Kinematics<D>) -> Result<()> {
        self.append_solid(solid, start)
    }

    fn remove_body(&mut self, solid: usize) {
        self.disable_solid(solid);
    }

    fn contacts(&self) -> Vec<ContactForce<D>> {
        contact_forces::pair_forces(&self.world, &self.bodies, &self.met)
    }

    fn set_held(&mut self, solid: usize, held: bool) {
        let body = &mut self.world.bodies[self.bodies[solid]];
        if held {
            body.set_linvel(Point::ZERO, true);
            body.set_angvel(to_angular(&Bivector::zero()), true);
        }
        body.set_locked_axes(if held { LockedAxes::all() } else { self.locks[solid] }, true);
    }

    fn set_mass(&mut self, solid: usize, body: &FreeBody<D>, start: &Matrix<D>) {
        let PhysicsWorld { bodies, colliders, .. } = &mut self.world;
        let own = &mut bodies[self.bodies[solid]];
        let before = own.center_of_mass();
        own.set_additional_mass_properties(mass_properties(body, start), false);
        own.recompute_mass_properties_from_colliders(colliders);
        let shift = from_point(own.center_of_mass() - before);
        let change = from_angular(own.angvel()).velocity_at(&shift);
        let unlocked = |i: usize| if body.locked_translations[i] { 0.0 } else { change[i] };
        let velocity = from_point(own.linvel()) + Vector::from_fn(|i, _| unlocked(i));
        own.set_linvel(to_point(&velocity), false);
        self.when_near = registry::iterations_in_contact(&self.world);
    }

    fn set_gravity(&mut self, gravity: &Vector<D>) {
        self.world.gravity = to_point(gravity);
    }

    fn set_joint(&mut self, joint: usize, frames: Option<&[Pose<D>; 2]>) {
        self.ties.set_joint(&mut self.world, joint, frames);
    }

    fn set_rope(&mut self, rope: usize, max_length: Option<f64>) {
        self.ties.set_rope(&mut self.world, rope, max_length);
    }

    fn gyroscopic_rate(&self, solid: usize) -> Option<Bivector<D>> {
        self.turned.get(solid).copied().flatten()
    }

    fn mobility(&self, solid: usize) -> Mobility<D> {
        mobility_of(self.body(solid))
    }

    fn joint_impulses(&self, joint: usize) -> Vec<f64> {
        self.ties.joint_impulses(&self.world, joint, self.iterations)
    }

    fn rope_impulse(&self, rope: usize) -> f64 {
        self.ties.rope_impulse(&self.world, rope, self.iterations)
    }

    fn save(&self) -> Result<Vec<u8>> {
        postcard::to_stdvec(&(ENGINE, &self.world, self.tuned_for, &self.met, &self.pushes)).map_err(restart_error)
    }

    fn check(&self, bytes: &[u8]) -> Result<()> {
        self.read_state(bytes).map(drop)
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<()> {
        (self.world, self.tuned_for, self.met, self.pushes) = self.read_state(bytes)?;
        self.world.narrow_phase.set_query_dispatcher(RollingContacts);
        self.when_near = registry::iterations_in_contact(&self.world);
        Ok(())
    }
}

fn kinematics_of(body: &RigidBody) -> Kinematics<D> {
    Kinematics {
        pose: from_frame(body.position()),
        centre: from_point(body.center_of_mass()),
        velocity: from_point(body.linvel()),
        spin: from_angular(body.angvel()),
    }
}

fn mobility_of(body: &RigidBody) -> Mobility<D> {
    let mass = body.mass_properties();
    Mobility {
        linear: from_point(mass.effective_inv_mass),
        angular: inverse_inertia(&mass.effective_world_inv_inertia),
    }
}

/// Returns whether `locks` hold a mode of motion: 0 to D − 1 are translations, from D on rotations.
pub(super) fn is_locked(locks: LockedAxes, mode: usize) -> bool {
    const LINES: [LockedAxes; 3] =
        [LockedAxes::TRANSLATION_LOCKED_X, LockedAxes::TRANSLATION_LOCKED_Y, LockedAxes::TRANSLATION_LOCKED_Z];
    const TURNS: [LockedAxes; 3] =
        [LockedAxes::ROTATION_LOCKED_X, LockedAxes::ROTATION_LOCKED_Y, LockedAxes::ROTATION_LOCKED_Z];
    locks.contains(match mode.checked_sub(D) {
        None => LINES[mode],
        // In 2-D, bodies rotate about z.
        Some(_) if D == 2 => TURNS[2],
        Some(axis) => TURNS[axis],
    })
}

/// Sets the parameters that stay constant during the whole run.
fn settle(world: &mut PhysicsWorld, reach: f64) {
    let parameters = &mut world.integration_parameters;
    parameters.num_solver_iterations = 1;
    parameters.num_internal_pgs_iterations = SWEEPS;
    parameters.num_internal_stabilization_iterations = 4;
    parameters.contact_recycling = false;
    parameters.length_unit = 1.0;
    parameters.normalized_prediction_distance = reach;
    parameters.normalized_max_corrective_velocity = 100.0;
    parameters.normalized_max_linear_velocity = f64::MAX;
    parameters.max_ccd_substeps = 0;
    tune(parameters);
    world.narrow_phase.set_query_dispatcher(RollingContacts);
}

pub(super) fn to_point(x: &Vector<D>) -> Point {
    Point::from_array((*x).into())
}

pub(super) fn from_point(x: Point) -> Vector<D> {
    Vector::from(x.to_array())
}

pub(super) fn to_frame(pose: &Pose<D>) -> Frame {
    Frame::from_parts(to_point(&pose.position), to_rotation(&pose.rotation))
}

/// Sets the pose of a kinematic body at the end of the step.
pub(super) fn set_next_pose(body: &mut RigidBody, pose: &Pose<D>) {
    let mut next = to_frame(pose);
    next.rotation = nearest_form(next.rotation, &body.position().rotation);
    body.set_next_kinematic_position(next);
}

pub(super) fn from_frame(frame: &Frame) -> Pose<D> {
    Pose { position: from_point(frame.translation), rotation: from_rotation(&frame.rotation) }
}
