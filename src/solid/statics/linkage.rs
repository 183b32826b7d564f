//! Bodies on hinges, ball joints and sliders between them: their trim at rest and their natural periods with these joints free.
//!
//! The coordinates q are the motions of the first body and those of the joints. With the forces Q(q) of buoyancy, weight, steady
//! forces and motors on them, rest is Q = 0, and the natural frequencies are those of K φ = ω² M φ with K = −∂Q/∂q. M has no added
//! mass of the water.

use nalgebra::{DMatrix, DVector};

use super::{Line, StaticSystem, lifted, up};
use crate::{
    math::{Bivector, Pose, Vector},
    solid::{JointKind, JointSpec},
};

/// Half of the difference of a coordinate (rad, or part of the size of the assembly) that gives K.
const STEP: f64 = 1e-5;

/// Largest change of a coordinate in an iteration (rad, or part of the size).
const LARGEST: f64 = 0.1;

/// Most iterations of Newton's method.
const ITERATIONS: usize = 60;

/// Change of all coordinates (rad, or part of the size) at which the iteration ends.
const CLOSE: f64 = 1e-9;

/// Part of the largest stiffness, and of the largest ω², below which one is 0.
const NEUTRAL: f64 = 1e-6;

/// An assembly at rest, with its joints free.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FreeJoints {
    /// Turn (rad) of each body of the assembly from the start to rest.
    pub(crate) turns: Vec<(usize, f64)>,
    /// Natural periods, s, from the longest.
    pub(crate) periods: Vec<f64>,
    /// Whether the assembly moves away from this rest.
    pub(crate) is_unstable: bool,
}

/// A coordinate: a translation along an axis, or a rotation about one.
struct Coordinate<const D: usize> {
    /// Whether each body of the assembly moves with it.
    moves: Vec<bool>,
    turns: bool,
    /// Axis: axial components of a rotation.
    axis: Vec<f64>,
    /// A point of the axis.
    at: Vector<D>,
    /// The body that carries the axis; `None` if the axis is fixed in the world.
    carrier: Option<usize>,
    /// The joint, and whether the coordinate is the motion of its second body.
    joint: Option<(usize, bool)>,
    /// Size (m) of a unit of a translation; 1 of a rotation.
    unit: f64,
}

/// An assembly of bodies whose joints make a tree.
struct Linkage<'a, const D: usize> {
    system: &'a StaticSystem<'a, D>,
    /// Numbers of the bodies.
    members: Vec<usize>,
    /// The poses at the start, raised by as much as the first body rises to rest.
    start: Vec<Pose<D>>,
    coordinates: Vec<Coordinate<D>>,
    /// Size of the assembly, m.
    size: f64,
}

/// Returns the rest of the assembly of body `i` with its joints free. `None` if it has a joint of another kind, a loop of joints, a
/// rope, a mooring line, a lock or a joint to the ground, if it rests at an end stop, or if the search for its rest fails.
pub(crate) fn free_joints<const D: usize>(system: &StaticSystem<D>, i: usize) -> Option<FreeJoints> {
    let members: Vec<usize> = system.assembly_of(i).collect();
    let member = |end: Option<usize>| end.and_then(|solid| system.number(solid)).filter(|j| members.contains(j));
    let touches = |joint: &&JointSpec<D>| joint.between.into_iter().any(|end| member(end).is_some());
    let joints: Vec<&JointSpec<D>> = system.joints.iter().filter(touches).collect();
    let is_known = |kind: JointKind| !matches!(kind, JointKind::Tow | JointKind::Generic);
    let is_own =
        |joint: &&JointSpec<D>| is_known(joint.kind) && joint.between.into_iter().all(|end| member(end).is_some());
    let is_member = |end: &Option<usize>| end.is_some_and(|j| members.contains(&j));
    // A spring to the ground or between two bodies of the assembly is known by its ends.
    let is_known_line =
        |line: &&Line<D>| !line.is_rope && line.bodies.iter().all(|end| end.is_none() || is_member(end));
    let is_roped = system.lines.iter().any(|line| line.bodies.iter().any(is_member) && !is_known_line(&line));
    let moored = system.moored.iter().filter_map(|own| system.number(own.solid));
    let is_locked = |j: &usize| {
        let body = system.bodies[*j].body;
        body.locked_translations.contains(&true) || body.locked_rotations.contains(&true)
    };
    let is_tied = is_roped || moored.into_iter().any(|j| members.contains(&j)) || members.iter().any(is_locked);
    if is_tied || !joints.iter().all(is_own) || joints.len() + 1 != members.len() {
        return None;
    }
    let linkage = Linkage::new(system, members, &joints)?;
    linkage.rest(&joints)
}

/// Returns the pose moved by `way` (m or rad) along or about an axis.
fn moved<const D: usize>(pose: &Pose<D>, turns: bool, (axis, at): (&[f64], &Vector<D>), way: f64) -> Pose<D> {
    let along = Vector::from_fn(|k, _| axis.get(k).copied().unwrap_or(0.0) * way);
    if !turns {
        return Pose { position: pose.position + along, ..*pose };
    }
    let turn = Bivector::<D>::from_axial(&axis.iter().map(|a| a * way).collect::<Vec<_>>()).exp();
    Pose { position: at + turn * (pose.position - at), rotation: turn * pose.rotation }
}

impl<'a, const D: usize> Linkage<'a, D> {
    /// The linkage of these bodies; `None` if their joints make a loop.
    fn new(system: &'a StaticSystem<'a, D>, members: Vec<usize>, joints: &[&JointSpec<D>]) -> Option<Self> {
        let n = members.len();
        // All rise alike, so that the joints are where they start.
        let rise = system.rise[system.group[members[0]]];
        let start: Vec<Pose<D>> = members.iter().map(|j| lifted(&system.bodies[*j].pose, rise)).collect();
        let size = members.iter().map(|j| system.size(*j)).fold(0.0, f64::max);
        let place = |end: Option<usize>| members.iter().position(|j| Some(system.bodies[*j].solid) == end);
        let ends: Vec<[usize; 2]> = joints
            .iter()
            .map(|joint| Some([place(joint.between[0])?, place(joint.between[1])?]))
            .collect::<Option<_>>()?;
        let rotations = if D == 2 { 1 } else { 3 };
        let unit = |axis: usize, count: usize| (0..count).map(|k| f64::from(k == axis)).collect::<Vec<f64>>();
        let centre = start[0].point(&system.bodies[members[0]].body.centre);
        let free = |turns: bool, axis: Vec<f64>| Coordinate {
            moves: vec![true; n],
            turns,
            axis,
            at: centre,
            carrier: None,
            joint: None,
            unit: if turns { 1.0 } else { size },
        };
        let mut coordinates: Vec<Coordinate<D>> = (0..D).map(|axis| free(false, unit(axis, D))).collect();
        coordinates.extend((0..rotations).map(|axis| free(true, unit(axis, rotations))));
        // From the first body outwards: the bodies beyond a joint move with it.
        let beyond = |joint: usize| {
            let mut side = vec![false; n];
            side[0] = true;
            let others = || ends.iter().enumerate().filter(|(other, _)| *other != joint);
            while let Some((_, [a, b])) = others().find(|(_, [a, b])| side[*a] != side[*b]) {
                (side[*a], side[*b]) = (true, true);
            }
            side.iter().map(|near| !near).collect::<Vec<bool>>()
        };
        for (number, joint) in joints.iter().enumerate() {
            let (moves, [first, second]) = (beyond(number), ends[number]);
            if moves[first] == moves[second] {
                return None;
            }
            let (carrier, is_second) = if moves[second] { (first, true) } else { (second, false) };
            let axis = || joint.axis.normalize().iter().copied().collect::<Vec<f64>>();
            let axes: Vec<(bool, Vec<f64>)> = match joint.kind {
                JointKind::Hinge if D == 2 => vec![(true, vec![1.0])],
                JointKind::Hinge => vec![(true, axis())],
                JointKind::Slider => vec![(false, axis())],
                JointKind::Ball => (0..3).map(|axis| (true, unit(axis, 3))).collect(),
                JointKind::Fixed | JointKind::Tow | JointKind::Generic => Vec::new(),
            };
            let single = axes.len() == 1;
            coordinates.extend(axes.into_iter().map(|(turns, axis)| Coordinate {
                moves: moves.clone(),
                turns,
                axis,
                at: joint.at + up::<D>() * rise,
                carrier: Some(carrier),
                joint: single.then_some((number, is_second)),
                unit: if turns { 1.0 } else { size },
            }));
        }
        Some(Self { system, members, start, coordinates, size })
    }

    /// Returns the axis of a coordinate and a point of it, with the bodies at `poses`.
    fn axis(&self, own: &Coordinate<D>, poses: &[Pose<D>]) -> (Vec<f64>, Vector<D>) {
        let Some(carrier) = own.carrier else {
            let at = poses[0].point(&self.system.bodies[self.members[0]].body.centre);
            return (own.axis.clone(), at);
        };
        let (from, to) = (&self.start[carrier], &poses[carrier]);
        let at = to.point(&from.local(&own.at));
        if own.turns && D == 2 {
            return (own.axis.clone(), at);
        }
        let axis = Vector::<D>::from_fn(|k, _| own.axis[k]);
        let axis = to.rotation * (from.rotation.transpose() * axis);
        (axis.iter().copied().collect(), at)
    }

    /// Returns the poses after a motion of `way` along a coordinate.
    fn displaced(&self, poses: &[Pose<D>], own: &Coordinate<D>, way: f64) -> Vec<Pose<D>> {
        let (axis, at) = self.axis(own, poses);
        let one = |(pose, moves): (&Pose<D>, &bool)| {
            if *moves { moved(pose, own.turns, (&axis, &at), way * own.unit) } else { *pose }
        };
        poses.iter().zip(&own.moves).map(one).collect()
    }

    /// Returns the place (m) of an end of a line with the bodies at `poses`.
    fn end(&self, line: &Line<D>, end: usize, poses: &[Pose<D>]) -> Vector<D> {
        let at = line.at[end];
        let body = line.bodies[end].and_then(|j| Some((j, self.members.iter().position(|own| *own == j)?)));
        body.map_or(at, |(j, k)| poses[k].point(&self.system.bodies[j].pose.local(&at)))
    }

    /// Returns the force (N m) on each coordinate with the bodies at `poses` and the joints' coordinates at `q`.
    fn forces(&self, poses: &[Pose<D>], q: &DVector<f64>, joints: &[&JointSpec<D>]) -> DVector<f64> {
        let g = self.system.water.g;
        // The forces on each body with their points, and a torque.
        let loads = |k: usize| {
            let (number, pose) = (self.members[k], &poses[k]);
            let own = &self.system.bodies[number];
            let (volume, centroid) = own.hull.submerged_volume(pose, own.level);
            let mut all = vec![(pose.point(&own.body.centre), up::<D>() * (-own.body.mass * g))];
            all.extend((volume != 0.0).then(|| (centroid, up::<D>() * (self.system.water.rho0 * volume * g))));
            let mut torque = Bivector::zero();
            for force in self.system.forces.iter().filter(|force| force.body == number) {
                all.push((pose.point(&own.pose.local(&force.at)), force.force));
                torque = torque + force.torque;
            }
            for line in &self.system.lines {
                let ends = [0, 1].map(|end| self.end(line, end, poses));
                let along = ends[1] - ends[0];
                let (length, stretch) = (along.norm(), along.norm() - line.length);
                if length > 0.0 && (stretch > 0.0 || line.pushes) {
                    let pull = along * (line.stiffness * stretch / length);
                    let own = |(end, body): (usize, &Option<usize>)| {
                        (*body == Some(number)).then(|| (ends[end], if end == 0 { pull } else { -pull }))
                    };
                    all.extend(line.bodies.iter().enumerate().filter_map(own));
                }
            }
            (all, torque)
        };
        let loads: Vec<_> = (0..poses.len()).map(loads).collect();
        let force = |(c, own): (usize, &Coordinate<D>)| {
            let (axis, at) = self.axis(own, poses);
            let along = |x: &[f64]| x.iter().zip(&axis).map(|(x, a)| x * a).sum::<f64>();
            let of_body = |(forces, torque): &(Vec<(Vector<D>, Vector<D>)>, Bivector<D>)| match own.turns {
                true => forces.iter().fold(*torque, |sum, (x, f)| sum + Bivector::torque(&(x - at), f)).axial(),
                false => forces.iter().map(|(_, f)| f).sum::<Vector<D>>().iter().copied().collect(),
            };
            let moving = loads.iter().zip(&own.moves).filter(|(_, moves)| **moves);
            let of_water: f64 = moving.map(|(load, _)| along(&of_body(load))).sum();
            let of_motor = own.joint.and_then(|(number, is_second)| {
                let motor = joints[number].motor.as_ref()?;
                let (sign, command) = (if is_second { 1.0 } else { -1.0 }, motor.command_at(0.0));
                let drive = command.force + command.stiffness * (command.position - sign * q[c] * own.unit);
                Some(sign * drive.clamp(-motor.max_force, motor.max_force))
            });
            (of_water + of_motor.unwrap_or_default()) * own.unit
        };
        DVector::from_iterator(self.coordinates.len(), self.coordinates.iter().enumerate().map(force))
    }

    /// Returns the stiffness matrix (N m) of the coordinates.
    fn stiffness(&self, poses: &[Pose<D>], q: &DVector<f64>, joints: &[&JointSpec<D>]) -> DMatrix<f64> {
        let n = self.coordinates.len();
        let mut all = DMatrix::zeros(n, n);
        for (c, own) in self.coordinates.iter().enumerate() {
            let [back, ahead] = [-STEP, STEP].map(|way| {
                let mut there = q.clone();
                there[c] += way;
                self.forces(&self.displaced(poses, own, way), &there, joints)
            });
            all.set_column(c, &((back - ahead) / (2.0 * STEP)));
        }
        (&all + all.transpose()) * 0.5
    }

    /// Returns the mass matrix (kg m²) of the coordinates.
    fn mass(&self, poses: &[Pose<D>]) -> DMatrix<f64> {
        let n = self.coordinates.len();
        let centre = |k: usize, pose: &Pose<D>| pose.point(&self.system.bodies[self.members[k]].body.centre);
        // Velocities of the centres, and spins in the frames of the bodies.
        let rates: Vec<Vec<(Vector<D>, Vec<f64>)>> = self
            .coordinates
            .iter()
            .map(|own| {
                let [back, ahead] = [-STEP, STEP].map(|way| self.displaced(poses, own, way));
                let axis = self.axis(own, poses).0;
                let rate = |k: usize| {
                    let velocity = (centre(k, &ahead[k]) - centre(k, &back[k])) / (2.0 * STEP);
                    let spin = match own.turns && own.moves[k] {
                        true if D == 2 => axis.clone(),
                        true => {
                            let axis = Vector::<D>::from_fn(|i, _| axis[i]);
                            (poses[k].rotation.transpose() * axis).iter().copied().collect()
                        }
                        false => vec![0.0; axis.len()],
                    };
                    (velocity, spin)
                };
                (0..poses.len()).map(rate).collect()
            })
            .collect();
        DMatrix::from_fn(n, n, |a, b| {
            let of_body = |k: usize| {
                let body = self.system.bodies[self.members[k]].body;
                let ((v, spin), (w, other)) = (&rates[a][k], &rates[b][k]);
                let turning: f64 = match D {
                    2 => spin[0] * other[0] * body.inertia[(0, 0)],
                    _ => (0..D)
                        .flat_map(|i| (0..D).map(move |j| (i, j)))
                        .map(|(i, j)| spin[i] * body.inertia[(i, j)] * other[j])
                        .sum(),
                };
                body.mass * v.dot(w) + turning
            };
            (0..poses.len()).map(of_body).sum()
        })
    }

    /// Returns the rest of the linkage, its natural periods there, and whether it is stable.
    fn rest(&self, joints: &[&JointSpec<D>]) -> Option<FreeJoints> {
        let (mut poses, mut q) = (self.start.clone(), DVector::zeros(self.coordinates.len()));
        let mut is_at_rest = false;
        for _ in 0..ITERATIONS {
            let stiffness = self.stiffness(&poses, &q, joints);
            let largest = stiffness.amax();
            let step = stiffness.svd(true, true).solve(&self.forces(&poses, &q, joints), NEUTRAL * largest).ok()?;
            let most = step.amax();
            let part = (LARGEST / most).min(1.0);
            for (own, way) in self.coordinates.iter().zip(step.iter()) {
                poses = self.displaced(&poses, own, way * part);
            }
            q += step * part;
            is_at_rest = most < CLOSE;
            if is_at_rest || !most.is_finite() {
                break;
            }
        }
        let within = |(own, q): (&Coordinate<D>, &f64)| {
            let Some((number, is_second)) = own.joint else { return true };
            let way = if is_second { q * own.unit } else { -q * own.unit };
            joints[number].limits.is_none_or(|[min, max]| (min..=max).contains(&way))
        };
        let (force, weight) = (self.forces(&poses, &q, joints), self.weight());
        let is_balanced = force.amax() < NEUTRAL * weight * self.size;
        if !is_at_rest || !is_balanced || !self.coordinates.iter().zip(q.iter()).all(within) {
            return None;
        }
        let root = self.mass(&poses).cholesky()?.l();
        let half = root.solve_lower_triangular(&self.stiffness(&poses, &q, joints))?;
        let squares = root.solve_lower_triangular(&half.transpose())?.symmetric_eigenvalues();
        let least = NEUTRAL * squares.amax();
        let mut periods: Vec<f64> =
            squares.iter().filter(|w| **w > least).map(|w| std::f64::consts::TAU / w.sqrt()).collect();
        periods.sort_by(|a, b| b.total_cmp(a));
        let turn = |(k, number): (usize, &usize)| {
            let turn = poses[k].rotation * self.start[k].rotation.transpose();
            let turned = Pose { rotation: turn, position: Vector::zeros() }.rotation_vector();
            (*number, turned.iter().map(|a| a * a).sum::<f64>().sqrt())
        };
        let turns = self.members.iter().enumerate().map(turn).collect();
        Some(FreeJoints { turns, periods, is_unstable: squares.iter().any(|w| *w < -least) })
    }

    /// Weight of the assembly, N.
    fn weight(&self) -> f64 {
        self.members.iter().map(|j| self.system.bodies[*j].body.mass * self.system.water.g).sum()
    }
}

#[cfg(test)]
#[path = "../../../tests/unit/solid/linkage.rs"]
mod tests;
