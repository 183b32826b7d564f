//! Static equilibrium of free bodies that joints, ropes, springs, motors of sliders and steady forces tie together, in their
//! initial orientation.
//!
//! Bodies that a joint keeps from rising against one another rise together. Each such group has one unknown, its rise; an inclined
//! guide to a solid that is not free shifts it sideways as it rises. Newton's method finds the rises at which buoyancy, weight, lines and
//! forces balance. `linkage` finds the rest with the turns that the ties leave free. A rope is a stiff spring that only pulls; the
//! bottom of the water is a stiff spring that only pushes.

mod linkage;
mod strength;
mod support;
mod ties;

use nalgebra::{DMatrix, DVector};

use super::{
    Constraints, FreeBody, JointKind, JointSpec, Kinematics, LineEnd, SolidSpec,
    constraint::lines::start_length,
    hydrostatics::Hull,
    joint_groups::{JointGroups, merge, rise_directions},
    mooring::forces_at_rest,
};
use crate::math::{Bivector, Bounds, Pose, Vector};

pub(crate) use linkage::{FreeRest, free_rest, poses_at_rest};
pub(crate) use strength::Overload;
pub(crate) use support::Support;
pub(crate) use ties::MooredEnd;
use ties::{Drive, Line, LineStiffness, SteadyForce, tension_towards};

/// Stiffness of a taut rope and of the bottom over that of the largest waterplane.
const STIFF: f64 = 1e5;
/// Most iterations of Newton's method.
const ITERATIONS: usize = 200;
/// Half of the angle (rad) of the difference that gives a metacentric height.
const TILT: f64 = 1e-4;

/// Height (m) of the surface around a body without water: far below all bodies.
pub(crate) const NO_WATER: f64 = -1e30;

/// The still water.
#[derive(Clone, Copy)]
pub(crate) struct WaterAtRest {
    /// Density, kg/m³.
    pub(crate) rho0: f64,
    /// Gravity, m/s².
    pub(crate) g: f64,
    /// Height of the highest surface, m.
    pub(crate) level: f64,
}

/// A free body of a static system.
pub(crate) struct StaticBody<'a, const D: usize> {
    /// Number of the solid.
    pub(crate) solid: usize,
    pub(crate) hull: Hull<'a, D>,
    pub(crate) body: &'a FreeBody<D>,
    /// Initial pose.
    pub(crate) pose: Pose<D>,
    /// Height (m) below which its lowest point cannot sink.
    pub(crate) bottom: f64,
    /// Height (m) of the still surface around it; [`NO_WATER`] if there is none.
    pub(crate) level: f64,
}

/// Free bodies with their ties.
pub(crate) struct StaticSystem<'a, const D: usize> {
    pub(crate) bodies: Vec<StaticBody<'a, D>>,
    /// Number of the group of each body that rises together.
    group: Vec<usize>,
    /// Number of the assembly of each body: bodies between which there are joints.
    assembly: Vec<usize>,
    /// Whether a joint or a lock holds each group.
    held: Vec<bool>,
    joints: Vec<JointSpec<D>>,
    lines: Vec<Line<D>>,
    forces: Vec<SteadyForce<D>>,
    drives: Vec<Drive<D>>,
    /// Stiffness of mooring lines at their ends; the rises at rest leave it out.
    moored: Vec<MooredEnd<D>>,
    water: WaterAtRest,
    /// All solids at the start.
    start: Vec<Kinematics<D>>,
    /// Displacement of each group for each metre of its rise.
    way: Vec<Vector<D>>,
    /// Rise of each group from the start to rest, m.
    rise: Vec<f64>,
}

/// The upward unit vector.
fn up<const D: usize>() -> Vector<D> {
    Vector::from_fn(|i, _| if i == D - 1 { 1.0 } else { 0.0 })
}

/// The pose, displaced by `way` (m).
fn displaced<const D: usize>(pose: &Pose<D>, way: Vector<D>) -> Pose<D> {
    Pose { position: pose.position + way, ..*pose }
}

impl<'a, const D: usize> StaticSystem<'a, D> {
    /// The system of these free bodies among `solids`, at rest.
    pub(crate) fn new(
        bodies: Vec<StaticBody<'a, D>>,
        solids: &[&SolidSpec<D>],
        constraints: &Constraints<D>,
        water: WaterAtRest,
    ) -> Self {
        let groups = JointGroups::of(solids, constraints);
        let number = |solid: Option<usize>| bodies.iter().position(|body| Some(body.solid) == solid);
        let of = |by: &[usize]| bodies.iter().map(|body| by[body.solid]).collect::<Vec<_>>();
        let (group, assembly) = (of(&groups.rising), of(&groups.jointed));
        let stiff = bodies.iter().map(|body| plan_area(&body.hull, &body.pose)).fold(0.0, f64::max);
        let stiff = STIFF * water.rho0 * water.g * stiff;
        let line = |ends: &[LineEnd<D>; 2], length: Option<f64>, name: &str, strength: f64| Line {
            name: name.into(),
            strength,
            bodies: ends.map(|end| number(end.solid)),
            at: ends.map(|end| end.at),
            stiffness: stiff,
            length: length.unwrap_or_else(|| start_length(ends)),
            pushes: false,
            is_rope: true,
            hangs: false,
        };
        let springs = constraints.springs.iter().map(|s| Line {
            stiffness: s.stiffness,
            pushes: !s.tension_only,
            is_rope: false,
            ..line(&s.ends, s.rest_length, &s.name, s.lifetime.strength)
        });
        let ropes = constraints.ropes.iter().map(|r| line(&r.ends, r.max_length, &r.name, r.lifetime.strength));
        let mut lines: Vec<Line<D>> = springs.chain(ropes).collect();
        // A slack line of a body that has no other tie comes to hang.
        let ties = |i: usize| lines.iter().flat_map(|line| line.bodies).filter(|end| *end == Some(i)).count();
        let alone = |i: usize| {
            let jointed = assembly.iter().filter(|number| **number == assembly[i]).count() > 1;
            !jointed && ties(i) == 1 && !groups.held[bodies[i].solid] && !bodies[i].body.locked_translations[0]
        };
        let alone: Vec<bool> = (0..bodies.len()).map(alone).collect();
        for line in &mut lines {
            let slack = !line.pushes && (line.at[1] - line.at[0]).norm() < line.length * (1.0 - 1e-6);
            line.hangs = slack && line.bodies.iter().flatten().any(|i| alone[*i]);
        }
        let force = |force: &super::ForceSpec<D>| {
            let body = number(Some(force.solid))?;
            let own = &bodies[body];
            let at = force.at.unwrap_or_else(|| own.pose.point(&own.body.centre));
            let (turns, (force, torque)) = (force.rotates_with_solid, force.steady_load(&own.pose.rotation)?);
            Some(SteadyForce { body, at, force, torque, turns })
        };
        let pulls = forces_at_rest((&constraints.moorings, &constraints.mooring_points), solids, &water);
        let moored = constraints.moorings.iter().zip(pulls).flat_map(|(spec, forces)| {
            let pull = |(end, force): (&LineEnd<D>, Vector<D>)| {
                let body = number(Some(end.solid?))?;
                Some(SteadyForce { body, at: end.at, force, torque: Bivector::zero(), turns: false })
            };
            spec.ends.iter().zip(forces).filter_map(pull).collect::<Vec<_>>()
        });
        let forces = constraints.forces.iter().filter_map(force).chain(moored).collect();
        let start: Vec<Kinematics<D>> = solids.iter().map(|solid| solid.initial_kinematics()).collect();
        let drive = |joint: &JointSpec<D>| {
            let (along, force, stiffness, largest) = joint.steady_drive()?;
            let (bodies, force) = (joint.between.map(number), force - stiffness * joint.coordinate_at_start(&start));
            (force != 0.0 || stiffness != 0.0).then_some(Drive { bodies, along, force, stiffness, largest })
        };
        let drives = constraints.joints.iter().filter_map(drive).collect();
        let way = rise_directions(solids, constraints, &groups);
        let (rise, held) = (vec![0.0; solids.len()], groups.held);
        let joints = constraints.joints.clone();
        let moored = Vec::new();
        let mut made =
            Self { bodies, group, assembly, held, joints, lines, forces, drives, moored, water, start, way, rise };
        made.find_rest();
        made
    }

    /// The same system, with mooring lines of this stiffness.
    pub(crate) fn with_mooring_stiffness(self, moored: Vec<MooredEnd<D>>) -> Self {
        Self { moored, ..self }
    }

    /// Returns the number of the body that is this solid.
    fn number(&self, solid: usize) -> Option<usize> {
        self.bodies.iter().position(|body| body.solid == solid)
    }

    /// Returns the stiffness (N/m) of mooring lines against a rise of body `i`.
    fn mooring_stiffness(&self, i: usize) -> f64 {
        let rises = |own: &&MooredEnd<D>| self.number(own.solid).is_some_and(|j| self.group[j] == self.group[i]);
        self.moored.iter().filter(rises).map(|own| own.stiffness[(D - 1, D - 1)]).sum()
    }

    /// Finds the rises of all groups, those that lines connect at once.
    fn find_rest(&mut self) {
        let mut linked: Vec<usize> = (0..self.rise.len()).collect();
        let pairs = self.lines.iter().map(|line| line.bodies).chain(self.drives.iter().map(|drive| drive.bodies));
        for pair in pairs {
            if let [Some(a), Some(b)] = pair {
                merge(&mut linked, self.group[a], self.group[b]);
            }
        }
        let mut groups: Vec<usize> = self.group.iter().copied().filter(|g| !self.held[*g]).collect();
        groups.sort_unstable();
        groups.dedup();
        while let Some(first) = groups.first().copied() {
            let (own, rest): (Vec<usize>, Vec<usize>) = groups.into_iter().partition(|g| linked[*g] == linked[first]);
            groups = rest;
            self.solve(&own);
        }
    }

    /// Returns the upward forces (N) on `groups` and their derivatives by the rises (N/m).
    fn forces(&self, groups: &[usize]) -> (Vec<f64>, Vec<Vec<f64>>) {
        let n = groups.len();
        let (mut force, mut slope) = (vec![0.0; n], vec![vec![0.0; n]; n]);
        let place = |body: usize| groups.iter().position(|g| *g == self.group[body]);
        let WaterAtRest { rho0, g, .. } = self.water;
        for (i, body) in self.bodies.iter().enumerate() {
            let Some(k) = place(i) else { continue };
            let pose = self.pose(i);
            let area = plan_area(&body.hull, &pose);
            let step = 1e-6 * self.size(i);
            let volume = |rise: f64| body.hull.volume_if_dry(&displaced(&pose, up::<D>() * rise), body.level);
            force[k] += g * (rho0 * volume(0.0) - body.body.mass);
            slope[k][k] += rho0 * g * (volume(step) - volume(-step)) / (2.0 * step);
            let sunk = body.bottom - body.hull.extent(&pose)[0];
            if sunk > 0.0 {
                force[k] += STIFF * rho0 * g * area * sunk;
                slope[k][k] -= STIFF * rho0 * g * area;
            }
        }
        for own in &self.forces {
            if let Some(k) = place(own.body) {
                force[k] += own.force.dot(self.way(own.body));
            }
        }
        for line in &self.lines {
            let (pull, stiffness) = self.pull(line);
            let ends = line.bodies.map(|end| end.and_then(place));
            let ways = line.bodies.map(|body| body.map_or_else(Vector::zeros, |i| *self.way(i)));
            for (own, other, sign) in [(0, 1, 1.0), (1, 0, -1.0)] {
                let Some(k) = ends[own] else { continue };
                force[k] += sign * pull.dot(&ways[own]);
                slope[k][k] -= stiffness.between(&ways[own], &ways[own]);
                if let Some(other_group) = ends[other] {
                    slope[k][other_group] += stiffness.between(&ways[own], &ways[other]);
                }
            }
        }
        for drive in &self.drives {
            let ([first, second], stiffness) = self.lift(drive);
            let ends = drive.bodies.map(|end| end.and_then(place));
            for (end, other, own, far) in [(ends[0], ends[1], first, second), (ends[1], ends[0], second, first)] {
                let Some(k) = end else { continue };
                force[k] += own.0;
                slope[k][k] -= stiffness * own.1 * own.1;
                if let Some(other) = other {
                    slope[k][other] -= stiffness * own.1 * far.1;
                }
            }
        }
        (force, slope)
    }

    /// Returns the lifting force (N) of a motor on each of its bodies with the change of its coordinate for each metre that the body
    /// rises, and its stiffness (N/m) against a change of the coordinate.
    fn lift(&self, drive: &Drive<D>) -> ([(f64, f64); 2], f64) {
        let [first, second] = drive.bodies.map(|end| end.map_or(0.0, |i| drive.along.dot(self.way(i))));
        let rise = drive.bodies.map(|end| end.map_or(0.0, |i| self.rise[self.group[i]]));
        let force = drive.force - drive.stiffness * (second * rise[1] - first * rise[0]);
        let stiffness = if force.abs() < drive.largest { drive.stiffness } else { 0.0 };
        let force = force.clamp(-drive.largest, drive.largest);
        ([(-force * first, -first), (force * second, second)], stiffness)
    }

    /// Returns the displacement of body `i` for each metre of its rise.
    fn way(&self, i: usize) -> &Vector<D> {
        &self.way[self.bodies[i].solid]
    }

    /// Returns the displacement (m) of body `i` from the start to rest.
    fn raised(&self, i: usize) -> Vector<D> {
        self.way(i) * self.rise[self.group[i]]
    }

    /// Returns the force (N) of a line on its first end, and its stiffness.
    fn pull(&self, line: &Line<D>) -> (Vector<D>, LineStiffness<D>) {
        let [a, b] = [0, 1].map(|k| line.at[k] + line.bodies[k].map_or_else(Vector::zeros, |i| self.raised(i)));
        let mut along = b - a;
        if line.hangs {
            along = up::<D>() * along[D - 1];
        }
        let length = along.norm();
        let stretch = length - line.length;
        if length == 0.0 || (stretch <= 0.0 && !line.pushes) {
            return (Vector::zeros(), LineStiffness { unit: up(), along: 0.0, across: 0.0 });
        }
        let (unit, tension) = (along / length, line.stiffness * stretch);
        (unit * tension, LineStiffness { unit, along: line.stiffness, across: (tension / length).max(0.0) })
    }

    /// Finds the rises of `groups` that lines connect.
    fn solve(&mut self, groups: &[usize]) {
        if let &[group] = groups
            && let Some(i) = self.untied(group)
        {
            let body = &self.bodies[i];
            let sinks = body.bottom - body.hull.extent(&body.pose)[0];
            // In the air, on a solid.
            if sinks >= 0.0 && self.is_in_air(i) {
                return;
            }
            self.rise[group] =
                body.hull.equilibrium_height(&body.pose, body.body.mass, self.water.rho0, body.level).unwrap_or(sinks);
            return;
        }
        let members = || (0..self.bodies.len()).filter(|i| groups.contains(&self.group[*i]));
        let size = members().map(|i| self.size(i)).fold(0.0, f64::max);
        let weight: f64 = members().map(|i| self.bodies[i].body.mass * self.water.g).sum();
        let area: f64 = members().map(|i| plan_area(&self.bodies[i].hull, &self.bodies[i].pose)).sum();
        let least = 1e-3 * self.water.rho0 * self.water.g * area;
        for _ in 0..ITERATIONS {
            let (force, mut slope) = self.forces(groups);
            if force.iter().all(|f| f.abs() < 1e-9 * weight) {
                break;
            }
            slope.iter_mut().flatten().for_each(|x| *x = -*x);
            // Lines couple groups, but leave the common rise of groups in deep water free. Row sums of `least` or more make the
            // matrix invertible.
            for (k, row) in slope.iter_mut().enumerate() {
                let others: f64 = row.iter().enumerate().filter(|(l, _)| *l != k).map(|(_, x)| x).sum();
                row[k] = row[k].max(least - others);
            }
            let matrix = DMatrix::from_fn(groups.len(), groups.len(), |k, l| slope[k][l]);
            let Some(mut step) = matrix.lu().solve(&DVector::from_vec(force)) else { break };
            let longest = step.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
            if longest < 1e-13 * size {
                break;
            }
            step.iter_mut().for_each(|x| *x *= (0.25 * size / longest).min(1.0));
            let start: Vec<f64> = groups.iter().map(|g| self.rise[*g]).collect();
            // The energy is convex: past its minimum along the step the forces point back.
            let (mut part, mut low, mut high) = (1.0, 0.0, 1.0);
            for _ in 0..12 {
                groups.iter().enumerate().for_each(|(k, g)| self.rise[*g] = start[k] + part * step[k]);
                let ahead: f64 = self.forces(groups).0.iter().zip(&step).map(|(f, x)| f * x).sum();
                if ahead >= 0.0 {
                    low = part;
                } else {
                    high = part;
                }
                if low == 1.0 {
                    break;
                }
                part = 0.5 * (low + high);
            }
        }
    }

    /// Returns the only body of a group, if nothing is tied to it.
    fn untied(&self, group: usize) -> Option<usize> {
        let mut own = (0..self.bodies.len()).filter(|i| self.group[*i] == group);
        let i = own.next()?;
        let tied = own.next().is_some()
            || self.lines.iter().any(|line| line.bodies.contains(&Some(i)))
            || self.forces.iter().any(|force| force.body == i)
            || self.drives.iter().any(|drive| drive.bodies.contains(&Some(i)));
        (!tied).then_some(i)
    }

    /// Returns whether body `i` floats alone: no joint to another body, no line and no steady force.
    pub(crate) fn floats_alone(&self, i: usize) -> bool {
        self.assembly_of(i).count() == 1 && self.untied(self.group[i]).is_some()
    }

    fn size(&self, i: usize) -> f64 {
        self.bodies[i].hull.shape.bounds().size().max()
    }

    /// Pose of body `i` at rest.
    pub(crate) fn pose(&self, i: usize) -> Pose<D> {
        displaced(&self.bodies[i].pose, self.raised(i))
    }

    /// Returns whether a lock of a body, or a joint to a solid that is not free, holds the assembly of body `i` against
    /// tilts about this axis.
    pub(crate) fn is_tilt_locked(&self, i: usize, axis: &[f64]) -> bool {
        let locked = |j: usize| (0..axis.len()).all(|k| axis[k] == 0.0 || self.bodies[j].body.locked_rotations[k]);
        let number = |solid: usize| self.bodies.iter().position(|body| body.solid == solid);
        let member = |end: Option<usize>| end.and_then(number).map(|j| self.assembly[j]);
        let grounded = self.joints.iter().any(|joint| {
            let ends = joint.between.map(member);
            ends.contains(&Some(self.assembly[i])) && ends.contains(&None) && !joint.frees_rotation(axis)
        });
        grounded || self.assembly_of(i).any(locked)
    }

    /// Returns the names of the joints in the assembly of body `i` that leave a motion of its bodies free.
    pub(crate) fn loose_joints(&self, i: usize) -> Vec<&str> {
        let member = |end: Option<usize>| {
            end.and_then(|solid| self.number(solid)).is_some_and(|j| self.assembly[j] == self.assembly[i])
        };
        let loose = |joint: &&JointSpec<D>| joint.kind != JointKind::Fixed && joint.between.into_iter().all(member);
        self.joints.iter().filter(loose).map(|joint| &joint.name[..]).collect()
    }

    /// Returns whether two bodies rise together.
    pub(crate) fn rise_together(&self, i: usize, j: usize) -> bool {
        self.group[i] == self.group[j]
    }

    /// Returns the bodies between which and body `i` there are joints, with it.
    pub(crate) fn assembly_of(&self, i: usize) -> impl Iterator<Item = usize> {
        let own = self.assembly[i];
        (0..self.bodies.len()).filter(move |j| self.assembly[*j] == own)
    }

    /// Returns the bodies that rise with body `i`, with it.
    fn group_of(&self, i: usize) -> impl Iterator<Item = usize> {
        let own = self.group[i];
        (0..self.bodies.len()).filter(move |j| self.group[*j] == own)
    }

    /// Returns the load (N, downward) of lines, motors and steady forces on body `i` at rest.
    pub(crate) fn tie_load(&self, i: usize) -> f64 {
        let mut load = 0.0;
        for line in &self.lines {
            let pull = self.pull(line).0[D - 1];
            load -=
                if line.bodies[0] == Some(i) { pull } else { 0.0 } - if line.bodies[1] == Some(i) { pull } else { 0.0 };
        }
        for drive in &self.drives {
            let lift = self.lift(drive).0;
            load -= (0..2).filter(|end| drive.bodies[*end] == Some(i)).map(|end| lift[end].0).sum::<f64>();
        }
        load - self.forces.iter().filter(|own| own.body == i).map(|own| own.force[D - 1]).sum::<f64>()
    }

    /// Returns the mass (kg) of the water that body `i` displaces at rest.
    fn displaced(&self, i: usize) -> f64 {
        self.water.rho0 * self.bodies[i].hull.volume_if_dry(&self.pose(i), self.bodies[i].level)
    }

    /// Returns whether body `i` lies on the bottom, or on a solid.
    fn lies_on_bottom(&self, i: usize) -> bool {
        self.bodies[i].hull.extent(&self.pose(i))[0] <= self.bodies[i].bottom + 1e-6 * self.size(i)
    }

    /// Returns the area (m²; m in 2-D) of the waterplane of the bodies that rise with body `i`.
    pub(crate) fn waterplane(&self, i: usize) -> f64 {
        let area = |j: usize| {
            let pose = self.pose(j);
            let [low, high] = self.bodies[j].hull.extent(&pose);
            let step = 1e-4 * (high - low);
            let (level, volume) = (self.bodies[j].level, |level: f64| self.bodies[j].hull.volume_if_dry(&pose, level));
            (volume(level + step) - volume(level - step)) / (2.0 * step)
        };
        self.group_of(i).map(area).sum()
    }

    /// Returns the mass (kg) of the water of its own in the hollows of body `i`.
    pub(crate) fn enclosed_water(&self, i: usize) -> f64 {
        self.water.rho0 * self.bodies[i].hull.enclosed_volume(&self.pose(i))
    }

    /// Returns the mass (kg) that heaves with body `i`, and the stiffness (N/m) of lines and motors to the ground. The mass is
    /// that of the bodies that rise with body `i`, of the water inside, and of the bodies on ropes or springs below.
    pub(crate) fn heaving_mass_and_stiffness(&self, i: usize) -> (f64, f64) {
        let with_water = |j: usize| self.bodies[j].body.mass + self.enclosed_water(j);
        let (mut mass, mut stiffness) = (self.group_of(i).map(with_water).sum::<f64>(), 0.0);
        for line in &self.lines {
            let (pull, stiff) = self.pull(line);
            for (own, other) in [(0, 1), (1, 0)] {
                if line.bodies[own].is_none_or(|j| self.group[j] != self.group[i]) || pull.norm() == 0.0 {
                    continue;
                }
                match line.bodies[other] {
                    None => stiffness += stiff.between(self.way(i), self.way(i)),
                    Some(j) if self.group[j] != self.group[i] && self.support(j) == Support::Lines => {
                        mass += with_water(j);
                    }
                    Some(_) => (),
                }
            }
        }
        for drive in &self.drives {
            match drive.bodies {
                [Some(j), None] | [None, Some(j)] if self.group[j] == self.group[i] => {
                    stiffness += self.lift(drive).1 * drive.along.dot(self.way(i)).powi(2);
                }
                _ => (),
            }
        }
        (mass * self.way(i).norm_squared(), stiffness + self.mooring_stiffness(i))
    }

    /// Returns the righting lever (m, axial components) of the assembly of body `i`, turned from rest by `angle` (rad)
    /// about the horizontal `axis` and afloat again. Water inside adds to the weight, and flows to the lower side.
    pub(crate) fn lever(&self, i: usize, axis: &[f64], angle: f64) -> Vec<f64> {
        let WaterAtRest { rho0, g, .. } = self.water;
        let members: Vec<usize> = self.assembly_of(i).collect();
        let rest: Vec<Pose<D>> = members.iter().map(|j| self.pose(*j)).collect();
        let mass: f64 = members.iter().map(|j| self.bodies[*j].body.mass).sum();
        let masses = members
            .iter()
            .zip(&rest)
            .map(|(j, pose)| pose.point(&self.bodies[*j].body.centre) * self.bodies[*j].body.mass);
        let centre = masses.fold(Vector::zeros(), |a, b| a + b) / mass;
        let turn = (Bivector::from_axial(axis) * angle).exp();
        let turned = |x: &Vector<D>, rise: f64| centre + turn * (x - centre) + up::<D>() * rise;
        let displaced = |rise: f64| -> (f64, Vector<D>) {
            members.iter().zip(&rest).fold((0.0, Vector::zeros()), |sum, (j, pose)| {
                let pose = Pose { position: turned(&pose.position, rise), rotation: turn * pose.rotation };
                let (volume, centroid) = self.bodies[*j].hull.submerged_volume(&pose, self.bodies[*j].level);
                (sum.0 + volume, sum.1 + centroid * volume)
            })
        };
        let below =
            |(j, pose): (&usize, &Pose<D>)| self.bodies[*j].hull.submerged_volume(pose, self.bodies[*j].level).0;
        let whole: f64 = members.iter().zip(&rest).map(below).sum();
        let size = members.iter().map(|j| self.size(*j)).fold(0.0, f64::max);
        let step = 1e-6 * size;
        let mut rise = 0.0;
        for _ in 0..20 {
            let slope = (displaced(rise + step).0 - displaced(rise - step).0) / (2.0 * step);
            let lack = whole - displaced(rise).0;
            if slope >= 0.0 || lack.abs() < 1e-13 * whole {
                break;
            }
            rise += (lack / slope).clamp(-0.1 * size, 0.1 * size);
        }
        let (volume, first) = displaced(rise);
        let middle = centre + up::<D>() * rise;
        let mut torque = Bivector::torque(&(first - middle * volume), &(up::<D>() * (rho0 * g)));
        let member = |end: Option<usize>| end.filter(|j| self.assembly[*j] == self.assembly[i]);
        let mut add = |at: &Vector<D>, force: &Vector<D>| torque = torque + Bivector::torque(&(at - middle), force);
        for line in &self.lines {
            let ends = line.bodies.map(member);
            for (own, sign) in [(0, 1.0), (1, -1.0)] {
                let (Some(j), None) = (ends[own], ends[1 - own]) else { continue };
                let at = turned(&(line.at[own] + self.raised(j)), rise);
                let force = match line.bodies[1 - own] {
                    // The other body follows, and its weight or lift stays.
                    Some(_) => self.pull(line).0 * sign,
                    None => tension_towards(line, &at, &line.at[1 - own], self.pull(line).0.norm()),
                };
                add(&at, &force);
            }
        }
        for own in self.forces.iter().filter(|own| self.assembly[own.body] == self.assembly[i]) {
            let at = own.at + self.raised(own.body);
            add(&turned(&at, rise), &if own.turns { turn * own.force } else { own.force });
        }
        for own in self.moored.iter().filter(|own| member(self.number(own.solid)).is_some()) {
            let Some(j) = self.number(own.solid) else { continue };
            let rest = own.at + self.raised(j);
            let at = turned(&rest, rise);
            add(&at, &(own.stiffness * (rest - at)));
        }
        for own in self.forces.iter().filter(|own| self.assembly[own.body] == self.assembly[i]) {
            torque = torque + own.torque;
        }
        let enclosed: f64 = members.iter().map(|j| self.enclosed_water(*j)).sum();
        torque.axial().iter().map(|t| t / (g * (rho0 * whole + enclosed))).collect()
    }

    /// Returns the metacentric height (m) of the assembly of body `i` for tilts about the horizontal `axis`.
    pub(crate) fn metacentric_height(&self, i: usize, axis: &[f64]) -> f64 {
        let along = |angle: f64| self.lever(i, axis, angle).iter().zip(axis).map(|(t, a)| t * a).sum::<f64>();
        -(along(TILT) - along(-TILT)) / (2.0 * TILT)
    }

    /// Returns the inertia (kg m²) of the assembly of body `i` about the horizontal `axis` through its centre of mass,
    /// without water inside, and the displaced mass (kg) with it.
    pub(crate) fn inertia_and_displacement(&self, i: usize, axis: &[f64]) -> (f64, f64) {
        let members: Vec<(usize, Pose<D>)> = self.assembly_of(i).map(|j| (j, self.pose(j))).collect();
        let centre_of = |(j, pose): &(usize, Pose<D>)| pose.point(&self.bodies[*j].body.centre);
        let mass: f64 = members.iter().map(|(j, _)| self.bodies[*j].body.mass).sum();
        let sum = members.iter().map(|own| centre_of(own) * self.bodies[own.0].body.mass);
        let centre = sum.fold(Vector::zeros(), |a, b| a + b) / mass;
        let axis = Vector::<D>::from_fn(|i, _| axis.get(i).copied().unwrap_or(0.0));
        let (mut inertia, mut displaced) = (0.0, 0.0);
        for own in &members {
            let body = self.bodies[own.0].body;
            let arm = centre_of(own) - centre;
            let local = own.1.rotation.transpose() * axis;
            inertia += match D {
                2 => body.inertia[(0, 0)] + body.mass * arm.norm_squared(),
                _ => local.dot(&(body.inertia * local)) + body.mass * (arm.norm_squared() - arm.dot(&axis).powi(2)),
            };
            displaced += self.water.rho0 * self.bodies[own.0].hull.submerged_volume(&own.1, self.bodies[own.0].level).0;
            displaced += self.enclosed_water(own.0);
        }
        (inertia, displaced)
    }
}

/// Returns the area (m²; m in 2-D) of the horizontal box around a hull.
fn plan_area<const D: usize>(hull: &Hull<D>, pose: &Pose<D>) -> f64 {
    let Bounds { min, max } = hull.shape.bounds_at(pose);
    (0..D - 1).map(|i| max[i] - min[i]).product()
}

#[cfg(test)]
#[path = "../../tests/unit/solid/statics.rs"]
mod tests;
