//! Joints and ropes of the engine; the module is compiled for each dimension with its world.
//!
//! A rope limits the distance between two points. The engine enforces the limit at the end of each step, along the line
//! between the points at the start of the step. For a relative speed u across the rope, on bodies with spin ω about centres at
//! distance r, the length may exceed the limit by (u² + L Σ ω² r) Δt²/2L. The limit of a step is shorter by this length, with the
//! velocities that the other loads give. With those at its start the rope would be slack by u Δu Δt²/L after it, for longer than a
//! short step.
//!
//! An end stop of the engine acts once the coordinate is at it or beyond. A body that rests on a stop is short of it by round-off: it would
//! fall freely for a step, and the next step would bear twice the load. Therefore a stop acts at the coordinate where it is, if the
//! known loads of the step carry the coordinate past the stop.

use super::super::rapier::{
    dynamics::{
        GenericJoint, ImpulseJoint, ImpulseJointHandle, JointAxesMask, JointLimits, RigidBody, RigidBodyBuilder,
        RigidBodyHandle, SpringCoefficients,
    },
    geometry::{ColliderHandle, ColliderSet, SolverFlags},
    math::{Pose as Frame, Vector as Point},
    pipeline::{ContactModificationContext, PairFilterContext, PhysicsHooks, PhysicsWorld},
};
use super::{
    super::align,
    D, from_angular, from_frame, from_point, kinematics_of, mobility_of,
    restitution::{Gain, Touch},
    to_angular, to_frame, to_point,
};
use crate::{
    math::{Bivector, Pose, Vector},
    solid::{
        Kinematics, Load, Mobility,
        constraint::{
            joint::{Joint, modes_rotations_first},
            lines::{AttachedLine, start_length},
            links::{Constraints, ContactPairs, ContactSpec},
            series::{SeriesRow, series_forces, sum_loads},
        },
    },
};

/// Frequency of the spring that represents a lock, Hz: the lock is rigid at any step, with a relative error of 1/(2π f
/// Δt)².
pub(super) const LOCK: f64 = 1e9;

/// Sweeps of the engine over all rows in a step.
pub(super) const SWEEPS: usize = 4;

/// Sweeps if joints or ropes are in series. They remove the position error that the motion in a step leaves. Of a light body between
/// ropes with 20 times its mass below, each sweep leaves 20/21.
const SWEEPS_IN_SERIES: usize = 200;

/// Handles of the joints and ropes, in order, and the pairs with their own contact properties.
pub(super) struct RapierJoints {
    joints: Vec<ImpulseJointHandle>,
    /// Handle and largest length (m) of each rope.
    ropes: Vec<(ImpulseJointHandle, f64)>,
    /// The joints and ropes, for their rows.
    specs: (Vec<Joint<D>>, Vec<AttachedLine<D>>),
    /// Impulses (N s, N m s) of the last step along the rows of joints and then of ropes, beside those of the engine.
    added_impulses: Vec<Vec<f64>>,
    pub(super) contact_pairs: ContactPairHooks,
}

impl RapierJoints {
    /// Adds the joints and ropes of `links` to `world`, in which `bodies` represent the solids with starting kinematics
    /// `start` and `restitution` (–).
    pub(super) fn new(
        world: &mut PhysicsWorld,
        bodies: &[RigidBodyHandle],
        links: &Constraints<D>,
        start: &[Kinematics<D>],
        restitution: Vec<f64>,
    ) -> Self {
        let on_ground = links.joints.iter().any(|joint| joint.between.contains(&None))
            || links.ropes.iter().any(|rope| rope.ends.iter().any(|end| end.solid.is_none()));
        let ground = on_ground.then(|| world.insert_body(RigidBodyBuilder::fixed()));
        // An end without a body is attached to the ground, which exists in that case.
        let body = |end: Option<usize>| end.map(|solid| bodies[solid]).or(ground).unwrap_or_default();
        let mut joints = Vec::new();
        for spec in &links.joints {
            let frames = spec.frames(start).each_ref().map(to_frame);
            let bits = modes_rotations_first::<D>()
                .filter(|&mode| spec.is_locked(mode))
                .fold(0, |bits, mode| bits | 1 << mode);
            let mut joint = GenericJoint::new(JointAxesMask::from_bits_truncate(bits));
            (joint.local_frame1, joint.local_frame2, joint.contacts_enabled) =
                (frames[0], frames[1], spec.contacts_enabled);
            joint.softness = SpringCoefficients::new(LOCK, 1.0);
            joint.set_enabled(spec.lifetime.has_begun(0.0));
            for (mode, limits) in spec.end_stops() {
                joint.limit_axes |= JointAxesMask::from_bits_truncate(1 << mode);
                joint.limits[mode] = JointLimits::from(limits);
            }
            let [first, second] = spec.between.map(body);
            joints.push(world.insert_impulse_joint(first, second, joint));
        }
        let mut ropes = Vec::new();
        for spec in &links.ropes {
            let longest = spec.max_length.unwrap_or_else(|| start_length(&spec.ends));
            let local = AttachedLine::new(&spec.ends, start).local_ends;
            let mut joint = GenericJoint::new(JointAxesMask::empty());
            (joint.coupled_axes, joint.limit_axes) = (JointAxesMask::LIN_AXES, JointAxesMask::LIN_X);
            joint.limits[0] = JointLimits::from([0.0, longest]);
            joint.softness = SpringCoefficients::new(LOCK, 1.0);
            joint.set_enabled(spec.lifetime.has_begun(0.0));
            [joint.local_frame1, joint.local_frame2] = local.each_ref().map(|x| to_frame(&Pose::at(*x)));
            let [first, second] = spec.ends.map(|end| body(end.solid));
            ropes.push((world.insert_impulse_joint(first, second, joint), longest));
        }
        let specs = (
            links.joints.iter().map(|joint| Joint::new(joint.clone(), start)).collect(),
            links.ropes.iter().map(|rope| AttachedLine::new(&rope.ends, start)).collect(),
        );
        let contact_pairs = ContactPairHooks { own: links.contacts.clone(), restitution, slowest: 0.0 };
        Self { joints, ropes, specs, added_impulses: Vec::new(), contact_pairs }
    }

    /// Connects joint number `i` with these frames, or disconnects it.
    pub(super) fn set_joint(&self, world: &mut PhysicsWorld, i: usize, frames: Option<&[Pose<D>; 2]>) {
        let Some(joint) = world.impulse_joints.get_mut(self.joints[i], true) else { return };
        joint.data.set_enabled(frames.is_some());
        if let Some(frames) = frames {
            [joint.data.local_frame1, joint.data.local_frame2] = frames.each_ref().map(to_frame);
        }
    }

    /// Connects rope number `i` with this length (m), or disconnects it.
    pub(super) fn set_rope(&mut self, world: &mut PhysicsWorld, i: usize, max_length: Option<f64>) {
        let (handle, longest) = &mut self.ropes[i];
        *longest = max_length.unwrap_or(*longest);
        if let Some(rope) = world.impulse_joints.get_mut(*handle, true) {
            rope.data.set_enabled(max_length.is_some());
        }
    }

    /// Sets the length limit of each connected rope for a step of `dt` (s).
    pub(super) fn update_rope_limits(&self, world: &mut PhysicsWorld, dt: f64) {
        for (handle, longest) in &self.ropes {
            let rope = world.impulse_joints.get_mut(*handle, false).filter(|rope| rope.data.is_enabled());
            let Some(rope) = rope else { continue };
            // Motion of the end after the other loads of the step; the rope itself takes what is along it.
            let end = |body: RigidBodyHandle, frame: &Frame| {
                let body = &world.bodies[body];
                let (now, ease, load) = (kinematics_of(body), mobility_of(body), load_on(world.gravity, body));
                let spin = now.spin + ease.spin_change(&load.torque) * dt;
                let arm = from_point(*body.position() * frame.translation) - now.centre;
                let velocity = now.velocity + ease.linear.component_mul(&load.force) * dt + spin.velocity_at(&arm);
                (now.centre + arm, velocity, 0.5 * spin.0.norm_squared() * arm.norm())
            };
            let (a, va, turned_a) = end(rope.body1(), &rope.data.local_frame1);
            let (b, vb, turned_b) = end(rope.body2(), &rope.data.local_frame2);
            let along = (b - a).try_normalize(0.0).unwrap_or_else(Vector::zeros);
            let across = (vb - va) - along * along.dot(&(vb - va));
            let further = (across.norm_squared() + *longest * (turned_a + turned_b)) * dt * dt;
            rope.data.limits[0].max = (longest * longest - further).max(0.0).sqrt();
        }
    }

    /// Sets the end stops of each connected joint for a step of `dt` (s) in which driven solids move as `driven`.
    pub(super) fn update_end_stops(
        &mut self,
        world: &mut PhysicsWorld,
        bodies: &[RigidBodyHandle],
        driven: &[Option<Kinematics<D>>],
        dt: f64,
    ) {
        if self.specs.0.iter().all(|joint| joint.spec.end_stops().is_empty()) {
            return;
        }
        let at_start: Vec<_> = bodies.iter().map(|&body| kinematics_of(&world.bodies[body])).collect();
        let loaded = |(i, now): (usize, &Kinematics<D>)| {
            if let Some(to) = driven[i] {
                return moved_towards(now, &to, dt);
            }
            let body = &world.bodies[bodies[i]];
            let (ease, load) = (mobility_of(body), load_on(world.gravity, body));
            let velocity = now.velocity + ease.linear.component_mul(&load.force) * dt;
            Kinematics { velocity, spin: now.spin + ease.spin_change(&load.torque) * dt, ..*now }
        };
        let loaded: Vec<_> = at_start.iter().enumerate().map(loaded).collect();
        for (joint, &handle) in self.specs.0.iter_mut().zip(&self.joints) {
            let tie = world.impulse_joints.get_mut(handle, false).filter(|tie| tie.data.is_enabled());
            let Some(tie) = tie else { continue };
            joint.frames = [&tie.data.local_frame1, &tie.data.local_frame2].map(from_frame);
            let ends = [&at_start, &loaded].map(|solids| joint.end_kinematics(solids));
            for (mode, [min, max]) in joint.spec.end_stops() {
                let (at, row) = (joint.coordinate(mode, &ends[0]), joint.row(mode, &ends[0]));
                let [before, after] = ends.each_ref().map(|ends| row.rate(ends) * dt);
                let limits = [
                    min + acts_short_of(Joint::<D>::distance(mode, min, at), [-before, -after]),
                    max - acts_short_of(Joint::<D>::distance(mode, at, max), [before, after]),
                ];
                tie.data.limits[mode] = JointLimits { min: limits[0], max: limits[1], ..tie.data.limits[mode] };
            }
        }
    }

    /// Applies the loads of joints and ropes in series as forces on `bodies`, for a step of `dt` (s) in which driven solids
    /// move as `driven`.
    pub(super) fn apply_series_loads(
        &mut self,
        world: &mut PhysicsWorld,
        bodies: &[RigidBodyHandle],
        driven: &[Option<Kinematics<D>>],
        dt: f64,
    ) {
        self.added_impulses = vec![Vec::new(); self.joints.len() + self.ropes.len()];
        world.integration_parameters.num_internal_pgs_iterations = SWEEPS;
        if self.added_impulses.len() < 2 {
            return;
        }
        let free = |end: Option<usize>| end.filter(|&solid| world.bodies[bodies[solid]].is_dynamic());
        let mut count = vec![0; bodies.len()];
        for i in (0..self.added_impulses.len()).filter(|&i| self.enabled(world, i).is_some()) {
            self.ends(i).into_iter().filter_map(free).for_each(|solid| count[solid] += 1);
        }
        if count.iter().all(|&count| count < 2) {
            return;
        }
        let motion = |(body, target): (&RigidBodyHandle, &Option<Kinematics<D>>)| {
            let now = kinematics_of(&world.bodies[*body]);
            target.map_or(now, |to| moved_towards(&now, &to, dt))
        };
        let solids: Vec<_> = bodies.iter().zip(driven).map(motion).collect();
        let loads: Vec<Load<D>> = bodies.iter().map(|body| load_on(world.gravity, &world.bodies[*body])).collect();
        let in_series = |i: usize| self.ends(i).into_iter().filter_map(free).any(|solid| count[solid] > 1);
        let chosen: Vec<_> = (0..self.added_impulses.len()).map(|i| in_series(i).then_some(0.0)).collect();
        let (rows, sizes) = self.rows(world, bodies, &solids, &chosen, dt);
        world.integration_parameters.num_internal_pgs_iterations = SWEEPS_IN_SERIES;
        let forces = series_forces(&rows, &solids, &loads, dt);
        give(world, bodies, &sum_loads(&rows, &forces, bodies.len()), |body, load| {
            body.add_force(to_point(&load.force), false);
            body.add_torque(to_angular(&load.torque), false);
        });
        self.record(&sizes, &forces, dt);
    }

    /// Changes the velocities of `bodies` after a step of `dt` (s), at whose end driven solids move as `driven`, so that they
    /// keep the locks, and the ropes that pulled, where these are now. The engine keeps them where they were before the step.
    /// Without this change the next step would make it, and its loads would be wrong by the ratio of the two steps.
    pub(super) fn turn_velocities(
        &mut self,
        world: &mut PhysicsWorld,
        bodies: &[RigidBodyHandle],
        driven: &[Option<Kinematics<D>>],
        dt: f64,
    ) {
        if self.added_impulses.is_empty() {
            return;
        }
        let motion = |(body, target): (&RigidBodyHandle, &Option<Kinematics<D>>)| {
            target.unwrap_or_else(|| kinematics_of(&world.bodies[*body]))
        };
        let solids: Vec<_> = bodies.iter().zip(driven).map(motion).collect();
        let iterations = world.integration_parameters.num_solver_iterations;
        let is_driven = |i: usize| self.ends(i).into_iter().flatten().any(|solid| driven[solid].is_some());
        // Only behind a driven solid that slows down do ends of taut ropes approach each other.
        let share = if (0..self.added_impulses.len()).any(is_driven) { 1.0 } else { 0.0 };
        let pull = |i: usize| match i.checked_sub(self.joints.len()) {
            None => Some(0.0),
            Some(rope) => {
                let pull = self.rope_impulse(world, rope, iterations) / dt;
                (pull > 0.0).then_some(share * pull)
            }
        };
        let chosen: Vec<_> = (0..self.added_impulses.len()).map(pull).collect();
        let (rows, sizes) = self.rows(world, bodies, &solids, &chosen, dt);
        let forces = series_forces(&rows, &solids, &vec![Load::zero(); solids.len()], dt);
        give(world, bodies, &sum_loads(&rows, &forces, bodies.len()), |body, load| {
            body.apply_impulse(to_point(&(load.force * dt)), false);
            body.apply_torque_impulse(to_angular(&(load.torque * dt)), false);
        });
        self.record(&sizes, &forces, dt);
    }

    /// Adds to each of `touches` what an impulse there gives to `bodies` through the locks of joints, if a joint holds one of both
    /// bodies.
    pub(super) fn link(&mut self, world: &PhysicsWorld, bodies: &[RigidBodyHandle], touches: &mut [Touch]) {
        if touches.is_empty() {
            return;
        }
        let joints = self.joints.len();
        let acting = (0..joints).filter(|&i| self.enabled(world, i).is_some());
        let joined: Vec<usize> = acting.flat_map(|i| self.ends(i)).flatten().collect();
        let is_joined = |touch: &Touch| touch.owners.iter().any(|solid| joined.contains(solid));
        if !touches.iter().any(is_joined) {
            return;
        }
        let at_rest = |&body: &RigidBodyHandle| {
            let (velocity, spin) = (Vector::zeros(), Bivector::zero());
            Kinematics { velocity, spin, ..kinematics_of(&world.bodies[body]) }
        };
        let solids: Vec<_> = bodies.iter().map(at_rest).collect();
        let chosen: Vec<_> = (0..joints + self.ropes.len()).map(|i| (i < joints).then_some(0.0)).collect();
        let (rows, _) = self.rows(world, bodies, &solids, &chosen, 1.0);
        let gains = |touch: &Touch, axis: usize| {
            let (mut loads, unit) = (vec![Load::zero(); bodies.len()], Vector::ith(axis, 1.0));
            for (solid, impulse) in touch.owners.into_iter().zip([-unit, unit]) {
                loads[solid] = Load::from_force_at(&(from_point(touch.at) - solids[solid].centre), impulse);
            }
            let forces = series_forces(&rows, &solids, &loads, 1.0);
            sum_loads(&rows, &forces, bodies.len()).into_iter().zip(&mut loads).for_each(|(held, load)| *load += held);
            let gain = |(&body, load): (&RigidBodyHandle, &Load<D>)| {
                let own = world.bodies.get(body).filter(|own| own.is_dynamic() && *load != Load::zero())?;
                let ease = mobility_of(own);
                let velocity = to_point(&ease.linear.component_mul(&load.force));
                Some(Gain { body, velocity, spin: to_angular(&ease.spin_change(&load.torque)) })
            };
            bodies.iter().zip(&loads).filter_map(gain).collect()
        };
        for touch in touches.iter_mut().filter(|touch| is_joined(touch)) {
            touch.linked = (0..D).map(|axis| gains(touch, axis)).collect();
        }
    }

    /// Returns tie number `i`, joints before ropes, if it acts.
    fn enabled<'a>(&self, world: &'a PhysicsWorld, i: usize) -> Option<&'a ImpulseJoint> {
        let handle = match i.checked_sub(self.joints.len()) {
            None => self.joints[i],
            Some(rope) => self.ropes[rope].0,
        };
        world.impulse_joints.get(handle).filter(|joint| joint.data.is_enabled())
    }

    /// Returns the solids of tie number `i`.
    fn ends(&self, i: usize) -> [Option<usize>; 2] {
        match i.checked_sub(self.joints.len()) {
            None => self.specs.0[i].spec.between,
            Some(rope) => self.specs.1[rope].solids(),
        }
    }

    /// Returns the rows of the locks and ropes of the `chosen` ties that act, with `bodies` at `solids` in a step of `dt` (s),
    /// and the number of rows of each tie. A chosen rope can give way by that much of its pull, N.
    fn rows(
        &mut self,
        world: &PhysicsWorld,
        bodies: &[RigidBodyHandle],
        solids: &[Kinematics<D>],
        chosen: &[Option<f64>],
        dt: f64,
    ) -> (Vec<SeriesRow<D>>, Vec<usize>) {
        let (mut rows, mut sizes) = (Vec::new(), Vec::new());
        for (i, chosen) in chosen.iter().enumerate() {
            let (between, before) = (self.ends(i), rows.len());
            if let (Some(pull), Some(tie)) = (*chosen, self.enabled(world, i)) {
                let mobility =
                    between.map(|end| end.map_or_else(Mobility::none, |i| mobility_of(&world.bodies[bodies[i]])));
                let row = |jacobian, limit| SeriesRow { between, jacobian, mobility, limit, pull };
                if let Some(own) = self.specs.0.get_mut(i) {
                    own.frames = [&tie.data.local_frame1, &tie.data.local_frame2].map(from_frame);
                    let (all, locks) = own.jacobians(&own.end_kinematics(solids), &mobility);
                    rows.extend(all.into_iter().take(locks).map(|jacobian| row(jacobian, None)));
                } else {
                    let line = &self.specs.1[i - self.joints.len()];
                    let (length, jacobian) = line.length_and_jacobian(&line.end_kinematics(solids));
                    let limit = (tie.data.limits[0].max - length).max(0.0) / dt;
                    rows.extend(jacobian.map(|jacobian| row(jacobian, Some(limit))));
                }
            }
            sizes.push(rows.len() - before);
        }
        (rows, sizes)
    }

    /// Adds the impulses of `forces` along the rows, of which tie number i has `sizes[i]`, in a step of `dt` (s).
    fn record(&mut self, sizes: &[usize], forces: &[f64], dt: f64) {
        let mut forces = forces.iter();
        for (impulses, &size) in self.added_impulses.iter_mut().zip(sizes) {
            impulses.resize(impulses.len().max(size), 0.0);
            impulses.iter_mut().zip(forces.by_ref().take(size)).for_each(|(impulse, force)| *impulse += force * dt);
        }
    }

    /// Returns the impulse (N s, N m s) that row number `row` of tie number `i` has beside that of the engine.
    fn added_impulse(&self, i: usize, row: usize) -> f64 {
        self.added_impulses.get(i).and_then(|rows| rows.get(row)).copied().unwrap_or(0.0)
    }

    /// Returns the impulses (N s, N m s) of joint number `i` on its second solid in the last step: of its locks in
    /// order, then of its end stops.
    pub(super) fn joint_impulses(&self, world: &PhysicsWorld, i: usize, iterations: usize) -> Vec<f64> {
        let Some(joint) = world.impulse_joints.get(self.joints[i]) else { return Vec::new() };
        let (locked, limited) = (joint.data.locked_axes.bits(), joint.data.limit_axes.bits());
        let locks = modes_rotations_first::<D>().filter(|i| locked >> i & 1 == 1).map(|i| joint.impulses[i]);
        let stops =
            modes_rotations_first::<D>().filter(|i| limited >> i & 1 == 1).map(|i| joint.data.limits[i].impulse);
        // The engine stores the impulses of its last iteration only.
        let all = locks.chain(stops).map(|impulse| -impulse * iterations as f64).enumerate();
        all.map(|(row, impulse)| impulse + self.added_impulse(i, row)).collect()
    }

    /// Returns the impulse (N s) of rope number `i` in the last step.
    pub(super) fn rope_impulse(&self, world: &PhysicsWorld, i: usize, iterations: usize) -> f64 {
        let rest = |rope: &ImpulseJoint| rope.data.limits[0].impulse * iterations as f64;
        let rest = world.impulse_joints.get(self.ropes[i].0).map_or(0.0, rest);
        rest - self.added_impulse(self.joints.len() + i, 0)
    }
}

/// Returns the motion in a step of `dt` (s) of a driven solid from the kinematics `now` of its body to those at the end. These may have
/// another centre, the hinge; that of its body is the origin of its frame.
fn moved_towards(now: &Kinematics<D>, to: &Kinematics<D>, dt: f64) -> Kinematics<D> {
    Kinematics { velocity: (to.pose.position - now.pose.position) / dt, spin: to.spin, ..*now }
}

/// Gives each of `bodies` that is free its load (N, N m) of `loads`, as `act` does.
fn give(
    world: &mut PhysicsWorld,
    bodies: &[RigidBodyHandle],
    loads: &[Load<D>],
    act: impl Fn(&mut RigidBody, &Load<D>),
) {
    for (load, &body) in loads.iter().zip(bodies) {
        let body = &mut world.bodies[body];
        if body.is_dynamic() {
            act(body, load);
        }
    }
}

/// Returns the distance (m or rad) before an end stop at which it acts, of a coordinate that is `left` short of it and moves towards
/// it by `before` in a step without the known loads and by `after` with them.
fn acts_short_of(left: f64, [before, after]: [f64; 2]) -> f64 {
    let by_loads = after - before;
    if left > 0.0 && left < after && left < by_loads { left * (1.0 + 1e-9) + 1e-14 } else { 0.0 }
}

/// Returns the load of the step on a body, with its weight, without joints, ropes and contacts.
fn load_on(gravity: Point, body: &RigidBody) -> Load<D> {
    let force = from_point(body.user_force() + gravity * body.mass());
    Load { force, torque: from_angular(body.user_torque()) }
}

/// Contact properties of pairs of solids.
pub(super) struct ContactPairHooks {
    /// The pairs that have properties of their own.
    own: ContactPairs,
    /// Restitution of each solid, –.
    pub(super) restitution: Vec<f64>,
    /// Approach speed above which bodies with restitution meet by impulses, m/s.
    pub(super) slowest: f64,
}

impl ContactPairHooks {
    /// Returns whether no pair has its own contact properties.
    pub(super) fn is_empty(&self) -> bool {
        self.own.is_empty()
    }

    /// Returns the restitution and friction of two solids. `friction` is the mean of both solids' values.
    pub(super) fn restitution_and_friction(&self, a: usize, b: usize, friction: f64) -> (f64, f64) {
        let own = self.own.find(a, b);
        let usual = 0.5 * (self.restitution[a] + self.restitution[b]);
        (own.and_then(|spec| spec.restitution).unwrap_or(usual), own.and_then(|spec| spec.friction).unwrap_or(friction))
    }

    /// Returns the contact properties of the pair of solids that own two colliders.
    fn of(&self, colliders: &ColliderSet, pair: [ColliderHandle; 2]) -> Option<&ContactSpec> {
        let [a, b] = pair.map(|collider| colliders[collider].user_data as usize);
        self.own.find(a, b)
    }

    /// Removes the points of a contact whose bodies do not touch yet and will meet by impulses. The engine would slow them before.
    fn leave_to_impacts(&self, context: &mut ContactModificationContext) {
        let [a, b] = [context.collider1, context.collider2].map(|i| context.colliders[i].user_data as usize);
        if self.restitution_and_friction(a, b, 0.0).0 == 0.0 {
            return;
        }
        let bodies = context.bodies;
        let [first, second] = [context.rigid_body1, context.rigid_body2].map(|body| body.and_then(|i| bodies.get(i)));
        let velocity = |body: Option<&RigidBody>, at| body.map_or(Point::ZERO, |body| body.velocity_at_point(at));
        if let Some(contact) = context.rigid_mut() {
            let (normal, slowest) = (*contact.normal, self.slowest);
            contact.solver_contacts.retain(|point| {
                let approach = velocity(first, point.anchor1) - velocity(second, point.anchor2);
                point.dist <= 0.0 || approach.dot(normal) <= slowest
            });
        }
    }
}

impl PhysicsHooks for ContactPairHooks {
    fn filter_contact_pair(&self, context: &PairFilterContext) -> Option<SolverFlags> {
        let own = self.of(context.colliders, [context.collider1, context.collider2]);
        own.is_none_or(|spec| spec.can_touch).then(SolverFlags::default)
    }

    fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
        let own = self.of(context.colliders, [context.collider1, context.collider2]).and_then(|spec| spec.friction);
        if let (Some(friction), Some(contact)) = (own, context.rigid_mut()) {
            *contact.friction = friction;
        }
        self.leave_to_impacts(context);
        align(context);
    }
}
