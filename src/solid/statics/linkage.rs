//! Bodies that joints, ropes and springs tie together: their rest with every motion free that their ties leave free, and their natural
//! periods there.
//!
//! The coordinates x are the translations and rotations of all bodies. The locks of joints, the lengths of taut ropes and end stops in
//! contact are conditions C(x) = 0. With the forces f of buoyancy, weight, springs, mooring lines, steady forces and motors, and the
//! reactions λ, rest is
//!
//!   f + Jᵀ λ = 0,   C = 0,   J = ∂C/∂x
//!
//! Newton's method finds it by steps in the null space Z of J, with the stiffness Zᵀ K Z, K = −∂(f + Jᵀ λ)/∂x. A step along an axis
//! of negative stiffness has the sign of the force, and so leads to a minimum of the energy. A rope that would push, or a stop that would
//! pull, lets go. The natural frequencies are those of Zᵀ K Z φ = ω² Zᵀ M Z φ. M has no added mass of the water.
//!
//! Floats that are placed at rest keep their place: rows of J with C = 0 hold the horizontal place of the centre of mass of jointed
//! bodies, and in 3-D their common turn about the vertical. The reactions of these rows bear what would make them drift.

use nalgebra::{DMatrix, DVector, Dyn, SymmetricEigen};

use super::{Line, StaticBody, StaticSystem, up};
use crate::{
    math::{Bivector, Pose, Vector, rotated_tensor},
    solid::{
        JointSpec, Kinematics, Load,
        constraint::joint::{Joint, modes_rotations_first},
    },
};

/// Half of the difference of a coordinate (rad, or part of the size of the bodies) that gives K.
const STEP: f64 = 1e-5;

/// Largest change of a coordinate in an iteration (rad, or part of the size).
const LARGEST: f64 = 0.1;

/// Most iterations.
const ITERATIONS: usize = 400;

/// Change of all coordinates (rad, or part of the size) at which the iteration ends.
const CLOSE: f64 = 1e-9;

/// Part of the largest stiffness, and of the largest ω², below which one is 0; part of the weight times the size below which a moment
/// is.
const NEUTRAL: f64 = 1e-6;

/// Part of the weight times the size that a negative stiffness exceeds where the bodies are unstable: facets and round-off give a ball a
/// small one.
const UNSTABLE: f64 = 1e-4;

/// Turn (rad) away from an unstable rest.
const NUDGE: f64 = std::f64::consts::PI / 180.0;

/// Turn (rad) to rest beyond which bodies fall over.
const OVER: f64 = 0.5 * std::f64::consts::PI;

/// Turn (rad) to rest up to which bodies that start unstable do not fall over.
const SMALL_TURN: f64 = 10.0 * NUDGE;

/// Tied bodies at rest.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct FreeRest {
    /// Turn (rad) of each body's vertical from the start to rest.
    pub(crate) turns: Vec<(usize, f64)>,
    /// Depth (m) of the lowest point of each body at rest.
    pub(crate) drafts: Vec<(usize, f64)>,
    /// Tension (N; N/m in 2-D) of each rope at rest.
    pub(crate) tensions: Vec<(String, f64)>,
    /// Natural periods, s, from the longest.
    pub(crate) periods: Vec<f64>,
    /// Whether the bodies have no stable rest near their start.
    pub(crate) is_unstable: bool,
    /// Whether they start beside an unstable rest.
    starts_unstable: bool,
}

/// A condition C = 0, or C ≤ 0 of a rope or an end stop, with its reaction λ.
struct Condition<const D: usize> {
    /// C, over the size for a length, –.
    off: f64,
    /// Its loads on two solids for λ = 1.
    loads: [(Option<usize>, Load<D>); 2],
    /// Whether λ cannot be positive.
    is_one_sided: bool,
}

/// Tied bodies, with the number of each solid's pose.
struct TiedBodies<'a, const D: usize> {
    system: &'a StaticSystem<'a, D>,
    /// Numbers of the bodies.
    members: Vec<usize>,
    joints: Vec<Joint<D>>,
    ropes: Vec<&'a Line<D>>,
    springs: Vec<&'a Line<D>>,
    /// Place in `members` and axis of each coordinate: the translations come before the rotations.
    coordinates: Vec<(usize, usize)>,
    /// Greatest size of a body, m.
    size: f64,
    /// Weight times size, N m.
    scale: f64,
    /// Places in `members` of bodies between which there are joints, whose common centre of mass keeps its horizontal place and whose
    /// common turn about the vertical is held.
    staying: Vec<Vec<usize>>,
    /// Whether each of `members` stays where it is given.
    held: Vec<bool>,
}

/// The equations at a place.
struct Linearised {
    /// Reactions.
    reaction: DVector<f64>,
    /// Step that closes the conditions.
    closing: DVector<f64>,
    /// Motions that the conditions leave free, one a column.
    free: DMatrix<f64>,
    /// Forces along them after the closing step.
    force: DVector<f64>,
    /// Zᵀ K Z.
    stiffness: DMatrix<f64>,
}

/// Returns the rest of body `i` with all that is tied to it. `None` if a body comes to lie on the bottom, or if the search fails.
pub(crate) fn free_rest<const D: usize>(system: &StaticSystem<D>, i: usize) -> Option<FreeRest> {
    let tied = TiedBodies::of(system, i, &|_, _| false)?;
    let (found, _) = tied.rest(NUDGE)?;
    // A mast that a stay keeps from falling to one side falls to the other.
    let other = if found.starts_unstable && !found.is_unstable { tied.rest(-NUDGE) } else { None };
    Some(other.map(|(other, _)| other).filter(|other| other.is_unstable).unwrap_or(found))
}

/// Returns the poses at rest of body `i` and of all that is tied to it, by the number of the solid. The solids for which `stays` holds,
/// with those on joints to them, keep their horizontal place, and all keep the translations and, numbered from D on, the turns for
/// which `is_kept` holds. `None` if there is no stable rest near the start, if there are two, as for a body that heels to one side as
/// well as to the other, or if [`free_rest`] has none.
pub(crate) fn poses_at_rest<const D: usize>(
    system: &StaticSystem<D>,
    i: usize,
    stays: &dyn Fn(usize) -> bool,
    is_kept: &dyn Fn(usize, usize) -> bool,
) -> Option<Vec<(usize, Pose<D>)>> {
    let mut tied = TiedBodies::of(system, i, is_kept)?;
    tied.staying = tied.staying_bodies(stays);
    let stable = |nudge: f64| tied.rest(nudge).filter(|(found, _)| !found.is_unstable);
    let (found, at) = stable(NUDGE)?;
    if found.starts_unstable {
        let (_, other) = stable(-NUDGE)?;
        let differs = |k: usize| {
            let [one, two] = [&at, &other].map(|at| at[tied.solid(k)].pose);
            (one.rotation - two.rotation).amax() > NEUTRAL.sqrt()
        };
        if (0..tied.members.len()).any(differs) {
            return None;
        }
    }
    Some((0..tied.members.len()).map(|k| (tied.solid(k), at[tied.solid(k)].pose)).collect())
}

impl<'a, const D: usize> TiedBodies<'a, D> {
    /// Body `i` with all that is tied to it; `None` if nothing can move. `is_kept` tells along and, from D on, about which axes a solid
    /// does not move.
    fn of(system: &'a StaticSystem<'a, D>, i: usize, is_kept: &dyn Fn(usize, usize) -> bool) -> Option<Self> {
        let members = system.tied_to(i);
        let size = members.iter().map(|j| system.size(*j)).fold(0.0, f64::max);
        let weight: f64 = members.iter().map(|j| system.bodies[*j].body.mass * system.water.g).sum();
        let is_free = |k: usize, axis: usize| {
            let StaticBody { body, solid, .. } = &system.bodies[members[k]];
            let is_locked = match axis.checked_sub(D) {
                None => body.locked_translations[axis],
                Some(axis) => body.locked_rotations[axis],
            };
            !is_locked && !is_kept(*solid, axis)
        };
        let axes = D + Bivector::<D>::COMPONENTS;
        let coordinates: Vec<(usize, usize)> = (0..members.len())
            .flat_map(|k| (0..axes).map(move |axis| (k, axis)))
            .filter(|(k, axis)| is_free(*k, *axis))
            .collect();
        let is_member = |solid: usize| system.number(solid).is_some_and(|j| members.contains(&j));
        let touches = |joint: &&JointSpec<D>| joint.between.into_iter().flatten().any(is_member);
        let joints = system.joints.iter().filter(touches);
        let joints = joints.map(|joint| Joint::new(joint.clone(), &system.start)).collect();
        let holds = |line: &&Line<D>| line.bodies.into_iter().flatten().any(|j| members.contains(&j));
        let (ropes, springs) = system.lines.iter().filter(holds).partition(|line| line.is_rope);
        let (scale, staying) = (weight * size, Vec::new());
        let held = members.iter().map(|j| (0..axes).all(|axis| is_kept(system.bodies[*j].solid, axis))).collect();
        let made = Self { system, joints, ropes, springs, coordinates, size, scale, members, staying, held };
        (!made.coordinates.is_empty()).then_some(made)
    }

    /// Those between which there are joints, if `stays` holds for one of them and no joint ties them to a solid that is not free: such a
    /// joint holds the place, or leads along a guide.
    fn staying_bodies(&self, stays: &dyn Fn(usize) -> bool) -> Vec<Vec<usize>> {
        let assembly = |k: &usize| self.system.assembly[self.members[*k]];
        let number = |end: Option<usize>| end.and_then(|solid| self.system.number(solid));
        let is_grounded = |own: usize| {
            let ends = self.joints.iter().map(|joint| joint.spec.between.map(number));
            ends.into_iter()
                .any(|ends| ends.contains(&None) && ends.into_iter().flatten().any(|j| self.system.assembly[j] == own))
        };
        let mut all: Vec<usize> = (0..self.members.len()).map(|k| assembly(&k)).collect();
        all.sort_unstable();
        all.dedup();
        let bodies = |own: &usize| (0..self.members.len()).filter(|k| assembly(k) == *own).collect::<Vec<_>>();
        all.retain(|own| !is_grounded(*own) && bodies(own).iter().any(|k| stays(self.solid(*k))));
        all.iter().map(bodies).collect()
    }

    fn solid(&self, k: usize) -> usize {
        self.system.bodies[self.members[k]].solid
    }

    /// The solids at the start. Bodies that are not held are raised by as much as they rise to rest in their orientation.
    fn start(&self) -> Vec<Kinematics<D>> {
        let mut all = self.system.start.clone();
        for (k, j) in self.members.iter().enumerate() {
            let StaticBody { pose, body, .. } = &self.system.bodies[*j];
            let pose = if self.held[k] { *pose } else { self.system.pose(*j) };
            all[self.solid(k)] = Kinematics { pose, centre: pose.point(&body.centre), ..all[self.solid(k)] };
        }
        all
    }

    /// The solids after a step of the coordinates.
    fn moved(&self, solids: &[Kinematics<D>], step: &DVector<f64>) -> Vec<Kinematics<D>> {
        let mut all = solids.to_vec();
        for k in 0..self.members.len() {
            let (mut way, mut turn) = (Vector::zeros(), [0.0; 3]);
            for ((_, axis), own) in self.coordinates.iter().zip(step.iter()).filter(|((other, _), _)| *other == k) {
                if *axis < D { way[*axis] = own * self.size } else { turn[axis - D] = *own }
            }
            let (now, turn) = (&mut all[self.solid(k)], Bivector::<D>::from_axial(&turn).exp());
            let arm = turn * (now.pose.position - now.centre);
            now.centre += way;
            now.pose = Pose { position: now.centre + arm, rotation: turn * now.pose.rotation };
        }
        all
    }

    /// The place (m) of an end of a line, and its solid if that is free.
    fn end(&self, line: &Line<D>, end: usize, solids: &[Kinematics<D>]) -> (Vector<D>, Option<usize>) {
        let Some(body) = line.bodies[end].map(|j| &self.system.bodies[j]) else { return (line.at[end], None) };
        (solids[body.solid].pose.point(&body.pose.local(&line.at[end])), Some(body.solid))
    }

    /// The load of water and weight on a body.
    fn load_afloat(&self, k: usize, solids: &[Kinematics<D>]) -> Load<D> {
        let (own, now) = (&self.system.bodies[self.members[k]], &solids[self.solid(k)]);
        let weight = Load { force: up::<D>() * (-own.body.mass * self.system.water.g), torque: Bivector::zero() };
        let (volume, centroid) = own.hull.submerged_volume(&now.pose, own.level);
        if volume == 0.0 {
            return weight;
        }
        let lift = up::<D>() * (self.system.water.rho0 * volume * self.system.water.g);
        weight + Load::from_force_at(&(centroid - now.centre), lift)
    }

    /// The component of a load along a coordinate, N m.
    fn component(&self, load: &Load<D>, axis: usize) -> f64 {
        if axis < D { load.force[axis] * self.size } else { load.torque.axial()[axis - D] }
    }

    /// The forces (N m) along the coordinates, with these loads of water and weight.
    fn forces(&self, solids: &[Kinematics<D>], afloat: &[Load<D>]) -> DVector<f64> {
        let mut loads = vec![Load::zero(); solids.len()];
        (0..self.members.len()).for_each(|k| loads[self.solid(k)] = afloat[k]);
        let mut pull = |at: Vector<D>, solid: Option<usize>, force: Vector<D>| {
            if let Some(solid) = solid {
                loads[solid] += Load::from_force_at(&(at - solids[solid].centre), force);
            }
        };
        for line in &self.springs {
            let [(a, first), (b, second)] = [0, 1].map(|end| self.end(line, end, solids));
            let (length, stretch) = ((b - a).norm(), (b - a).norm() - line.length);
            if length > 0.0 && (stretch > 0.0 || line.pushes) {
                let force = (b - a) * (line.stiffness * stretch / length);
                pull(a, first, force);
                pull(b, second, -force);
            }
        }
        for own in &self.system.moored {
            let Some(body) = self.system.number(own.solid).map(|j| &self.system.bodies[j]) else { continue };
            let at = solids[own.solid].pose.point(&body.pose.local(&own.at));
            pull(at, Some(own.solid), own.stiffness * (own.at - at));
        }
        for own in &self.system.forces {
            let body = &self.system.bodies[own.body];
            let now = &solids[body.solid];
            let (mut force, mut torque) = (own.force, own.torque);
            if own.turns {
                let turn = now.pose.rotation * body.pose.rotation.transpose();
                (force, torque) = (turn * force, torque.rotated(&turn));
            }
            let arm = now.pose.point(&body.pose.local(&own.at)) - now.centre;
            loads[body.solid] += Load { torque, ..Load::zero() };
            loads[body.solid] += Load::from_force_at(&arm, force);
        }
        for joint in &self.joints {
            let ends = joint.end_kinematics(solids);
            let (Some(motor), Some(row)) = (&joint.spec.motor, joint.coordinate_jacobian(&ends)) else { continue };
            let command = motor.command_at(0.0);
            let drive = command.force + command.stiffness * (command.position - joint.position(&ends));
            let both = row.loads(drive.clamp(-motor.max_force, motor.max_force));
            for (end, load) in joint.spec.between.iter().zip(both) {
                end.iter().for_each(|solid| loads[*solid] += load);
            }
        }
        let along = self.coordinates.iter().map(|(k, axis)| self.component(&loads[self.solid(*k)], *axis));
        DVector::from_iterator(self.coordinates.len(), along)
    }

    /// All conditions: of the locks of joints, of end stops and of ropes, in this order.
    fn conditions(&self, solids: &[Kinematics<D>]) -> Vec<Condition<D>> {
        let (mut locks, mut others) = (Vec::new(), Vec::new());
        for joint in &self.joints {
            let ends = joint.end_kinematics(solids);
            let unit = |mode: usize| if mode < D { 1.0 / self.size } else { 1.0 };
            let between = |[a, b]: [Load<D>; 2]| [(joint.spec.between[0], a), (joint.spec.between[1], b)];
            let modes = modes_rotations_first::<D>().filter(|mode| joint.spec.is_locked(*mode));
            for (mode, row) in modes.zip(joint.lock_jacobians(&ends)) {
                // The row of a locked turn in 3-D is that of half of the angle.
                let part = if D == 3 && mode >= D { 0.5 } else { unit(mode) };
                let loads = between(row.loads(if mode < D { unit(mode) } else { 1.0 }));
                locks.push(Condition { off: joint.coordinate(mode, &ends) * part, loads, is_one_sided: false });
            }
            for (mode, [least, greatest]) in joint.spec.end_stops() {
                let (at, row) = (joint.coordinate(mode, &ends), joint.row(mode, &ends));
                for (past, sign) in [(least - at, -1.0), (at - greatest, 1.0)] {
                    let loads = between(row.loads(sign * unit(mode)));
                    others.push(Condition { off: past * unit(mode), loads, is_one_sided: true });
                }
            }
        }
        for line in &self.ropes {
            let [(a, first), (b, second)] = [0, 1].map(|end| self.end(line, end, solids));
            let length = (b - a).norm();
            let unit = if length > 0.0 { (b - a) / length } else { up() };
            let load = |at: Vector<D>, solid: Option<usize>, sign: f64| {
                let arm = solid.map_or_else(Vector::zeros, |solid| at - solids[solid].centre);
                (solid, Load::from_force_at(&arm, unit * (sign / self.size)))
            };
            let loads = [load(a, first, -1.0), load(b, second, 1.0)];
            others.push(Condition { off: (length - line.length) / self.size, loads, is_one_sided: true });
        }
        locks.extend(others);
        locks
    }

    /// J of the `active` ones of these conditions, and of those that keep the place.
    fn rows(&self, all: &[Condition<D>], active: &[bool]) -> DMatrix<f64> {
        let held: Vec<&Condition<D>> = all.iter().zip(active).filter(|(_, held)| **held).map(|(own, _)| own).collect();
        let mass = |k: &usize| self.system.bodies[self.members[*k]].body.mass;
        // The horizontal translations; in 3-D, the turn about the vertical.
        let axes: &[usize] = if D == 2 { &[0] } else { &[0, 1, 5] };
        let kept: Vec<_> =
            self.staying.iter().flat_map(|bodies| axes.iter().map(move |axis| (bodies, *axis))).collect();
        DMatrix::from_fn(held.len() + kept.len(), self.coordinates.len(), |row, c| {
            let (k, axis) = self.coordinates[c];
            match held.get(row) {
                Some(own) => {
                    let own = own.loads.iter().filter(|(solid, _)| *solid == Some(self.solid(k)));
                    own.map(|(_, load)| self.component(load, axis)).sum()
                }
                None => {
                    let (bodies, own) = kept[row - held.len()];
                    let share = || mass(&k) / bodies.iter().map(mass).sum::<f64>();
                    if own == axis && bodies.contains(&k) { share() } else { 0.0 }
                }
            }
        })
    }

    /// The equations with the solids there and these conditions.
    fn linearised(&self, solids: &[Kinematics<D>], all: &[Condition<D>], active: &[bool]) -> Linearised {
        let n = self.coordinates.len();
        let afloat: Vec<Load<D>> = (0..self.members.len()).map(|k| self.load_afloat(k, solids)).collect();
        let (force, rows) = (self.forces(solids, &afloat), self.rows(all, active));
        let held = all.iter().zip(active).filter(|(_, held)| **held).map(|(own, _)| own.off);
        let off = DVector::from_iterator(rows.nrows(), held.chain(std::iter::repeat(0.0)).take(rows.nrows()));
        // Conditions that repeat others, as those of a loop in space, have singular values of 0.
        let SymmetricEigen { eigenvectors, eigenvalues } = SymmetricEigen::new(rows.tr_mul(&rows));
        let least = 1e-10 * eigenvalues.amax();
        let is_held = |c: &usize| eigenvalues[*c] > least;
        let ways = |columns: Vec<usize>| eigenvectors.select_columns(&columns);
        let (held, free) = (ways((0..n).filter(is_held).collect()), ways((0..n).filter(|c| !is_held(c)).collect()));
        let inverse = DVector::from_iterator(held.ncols(), (0..n).filter(is_held).map(|c| 1.0 / eigenvalues[c]));
        let solve = |x: DVector<f64>| &held * held.tr_mul(&x).component_mul(&inverse);
        let closing = -solve(rows.tr_mul(&off));
        let reaction = -(&rows * solve(force.clone()));
        let mut stiffness = DMatrix::zeros(n, n);
        for (c, (k, _)) in self.coordinates.iter().enumerate() {
            let [back, ahead] = [-STEP, STEP].map(|way| {
                let mut step = DVector::zeros(n);
                step[c] = way;
                let (there, mut afloat) = (self.moved(solids, &step), afloat.clone());
                afloat[*k] = self.load_afloat(*k, &there);
                self.forces(&there, &afloat) + self.rows(&self.conditions(&there), active).tr_mul(&reaction)
            });
            stiffness.set_column(c, &((back - ahead) / (2.0 * STEP)));
        }
        let force = free.tr_mul(&(force - &stiffness * &closing));
        let stiffness = free.tr_mul(&(stiffness * &free));
        let stiffness = (&stiffness + stiffness.transpose()) * 0.5;
        Linearised { reaction, closing, free, force, stiffness }
    }

    /// The next step of the coordinates; `nudge` (rad) leads away from an unstable rest.
    fn step(&self, here: &Linearised, nudge: f64) -> DVector<f64> {
        let Some(SymmetricEigen { eigenvectors, eigenvalues }) = here.eigen() else { return here.closing.clone() };
        let floor = NEUTRAL * eigenvalues.amax().max(self.scale);
        let mut step = here.closing.clone();
        for (stiff, axis) in eigenvalues.iter().zip(eigenvectors.column_iter()) {
            let own = here.force.dot(&axis);
            let part = match *stiff {
                x if x < -UNSTABLE * self.scale && own.abs() < CLOSE * self.scale => nudge,
                x if x < -UNSTABLE * self.scale && own.abs() < -x * NUDGE => NUDGE.copysign(own),
                x if x < floor && own.abs() < NEUTRAL * self.scale => 0.0,
                x => own / x.abs().max(floor),
            };
            step += &here.free * axis * part.clamp(-LARGEST, LARGEST);
        }
        step
    }

    /// Finds the rest, with the solids there; `nudge` (rad) leads away from an unstable one.
    fn rest(&self, nudge: f64) -> Option<(FreeRest, Vec<Kinematics<D>>)> {
        let mut at = self.start();
        let mut active: Vec<bool> = self.conditions(&at).iter().map(|own| !own.is_one_sided).collect();
        let (mut longest, mut last) = (LARGEST, DVector::zeros(self.coordinates.len()));
        let mut is_unstable = None;
        for _ in 0..ITERATIONS {
            let all = self.conditions(&at);
            active.iter_mut().zip(&all).for_each(|(held, own)| *held |= own.off > CLOSE);
            let here = self.linearised(&at, &all, &active);
            let starts_unstable = *is_unstable.get_or_insert_with(|| here.is_unstable(self.scale));
            let mut step = self.step(&here, nudge);
            let most = step.amax();
            if !most.is_finite() {
                break;
            }
            if most < CLOSE {
                let held = (0..all.len()).filter(|own| active[*own]).zip(here.reaction.iter());
                let pushing = held.filter(|(own, _)| all[*own].is_one_sided);
                let worst = pushing.max_by(|a, b| a.1.total_cmp(b.1)).filter(|(_, push)| **push > CLOSE * self.scale);
                if let Some((own, _)) = worst {
                    active[own] = false;
                    continue;
                }
                let is_closed = all.iter().zip(&active).all(|(own, held)| !held || own.off.abs() < NEUTRAL);
                let found = if is_closed { self.found(&at, (&all, &active), &here, starts_unstable) } else { None };
                return found.map(|found| (found, at));
            }
            // Where the forces have a kink, steps to and fro become shorter.
            longest = if step.dot(&last) < 0.0 { 0.5 * longest.min(last.amax()) } else { LARGEST.min(1.5 * longest) };
            step *= (longest / most).min(1.0);
            at = self.moved(&at, &step);
            last = step;
        }
        let none = |is_unstable| FreeRest { is_unstable, starts_unstable: true, ..FreeRest::default() };
        is_unstable.filter(|is| *is).map(|is| (none(is), at))
    }

    /// The rest with the solids there; `None` if a body lies on the bottom.
    fn found(
        &self,
        at: &[Kinematics<D>],
        (all, active): (&[Condition<D>], &[bool]),
        here: &Linearised,
        starts_unstable: bool,
    ) -> Option<FreeRest> {
        let lowest = |j: usize| self.system.bodies[j].hull.extent(&at[self.system.bodies[j].solid].pose)[0];
        if self.members.iter().any(|j| lowest(*j) < self.system.bodies[*j].bottom - NEUTRAL * self.size) {
            return None;
        }
        let start = self.start();
        let turn = |(k, number): (usize, &usize)| {
            let turn = at[self.solid(k)].pose.rotation * start[self.solid(k)].pose.rotation.transpose();
            // Upwards, as it has turned.
            let across = (0..D - 1).map(|i| turn[(i, D - 1)].powi(2)).sum::<f64>().sqrt();
            (*number, across.atan2(turn[(D - 1, D - 1)]))
        };
        let turns: Vec<(usize, f64)> = self.members.iter().enumerate().map(turn).collect();
        let reactions = {
            let mut held = here.reaction.iter();
            active.iter().map(|is| if *is { held.next().copied().unwrap_or(0.0) } else { 0.0 }).collect::<Vec<f64>>()
        };
        let of_ropes = &reactions[all.len() - self.ropes.len()..];
        let tension = |(line, reaction): (&&Line<D>, &f64)| (line.name.clone(), (-reaction / self.size).max(0.0));
        let most = turns.iter().map(|(_, turn)| *turn).fold(0.0, f64::max);
        let falls = most > OVER || (starts_unstable && most > SMALL_TURN);
        Some(FreeRest {
            drafts: self.members.iter().map(|j| (*j, self.system.bodies[*j].level - lowest(*j))).collect(),
            tensions: self.ropes.iter().zip(of_ropes).map(tension).collect(),
            periods: self.periods(at, here)?,
            is_unstable: falls || here.is_unstable(self.scale),
            starts_unstable,
            turns,
        })
    }

    /// Natural periods (s) from the longest.
    fn periods(&self, at: &[Kinematics<D>], here: &Linearised) -> Option<Vec<f64>> {
        if here.free.ncols() == 0 {
            return Some(Vec::new());
        }
        let n = self.coordinates.len();
        let mass = DMatrix::from_fn(n, n, |a, b| {
            let ((k, first), (other, second)) = (self.coordinates[a], self.coordinates[b]);
            let body = self.system.bodies[self.members[k]].body;
            match (first.checked_sub(D), second.checked_sub(D)) {
                (None, None) if (k, first) == (other, second) => body.mass * self.size * self.size,
                (Some(_), Some(_)) if D == 2 && k == other => body.inertia[(0, 0)],
                (Some(i), Some(j)) if k == other => {
                    rotated_tensor(&at[self.solid(k)].pose.rotation, &body.inertia)[(i, j)]
                }
                _ => 0.0,
            }
        });
        let root = here.free.tr_mul(&(mass * &here.free)).cholesky()?.l();
        let half = root.solve_lower_triangular(&here.stiffness)?;
        let squares = root.solve_lower_triangular(&half.transpose())?.symmetric_eigenvalues();
        let least = NEUTRAL * squares.amax();
        let mut periods: Vec<f64> =
            squares.iter().filter(|w| **w > least).map(|w| std::f64::consts::TAU / w.sqrt()).collect();
        periods.sort_by(|a, b| b.total_cmp(a));
        Some(periods)
    }
}

impl Linearised {
    /// The axes of the free motions and their stiffness; `None` without any.
    fn eigen(&self) -> Option<SymmetricEigen<f64, Dyn>> {
        (self.stiffness.nrows() > 0).then(|| SymmetricEigen::new(self.stiffness.clone()))
    }

    /// Whether a stiffness is negative.
    fn is_unstable(&self, scale: f64) -> bool {
        self.eigen().is_some_and(|eigen| eigen.eigenvalues.iter().any(|x| *x < -UNSTABLE * scale))
    }
}

#[cfg(test)]
#[path = "../../../tests/unit/solid/linkage.rs"]
mod tests;
