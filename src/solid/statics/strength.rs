//! Lines and joints that break before the bodies are at rest.

use super::{StaticSystem, merge, up};
use crate::{
    math::{Bivector, Vector},
    solid::{JointKind, JointSpec},
};

/// A line or a joint with more load at rest than it bears.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Overload {
    /// `spring`, `rope` or `joint`.
    pub(crate) kind: &'static str,
    pub(crate) name: String,
    /// Tension of the line, vertical force or torque of the joint, at rest, N or N m (N/m, N in 2-D).
    pub(crate) load: f64,
    /// Load at which it breaks.
    pub(crate) strength: f64,
    pub(crate) is_torque: bool,
}

impl<const D: usize> StaticSystem<'_, D> {
    /// Returns the lines and joints that break before the bodies are at rest.
    pub(crate) fn overloads(&self) -> Vec<Overload> {
        let lines = self.lines.iter().map(|line| Overload {
            kind: if line.is_rope { "rope" } else { "spring" },
            name: line.name.clone(),
            load: if line.bodies == [None; 2] { 0.0 } else { self.pull(line).0.norm() },
            strength: line.strength,
            is_torque: false,
        });
        let joints = self.joints.iter().flat_map(|joint| {
            let name = || joint.name.clone();
            let [force, torque] = [joint.lifetime.strength, joint.lifetime.torque_strength];
            let overload =
                |load, strength, is_torque| Overload { kind: "joint", name: name(), load, strength, is_torque };
            let by_force = || Some(overload(self.vertical_force(joint)?, force, false));
            let by_torque = || Some(overload(self.torque(joint)?, torque, true));
            let found = [force.is_finite().then(by_force), torque.is_finite().then(by_torque)];
            found.into_iter().flatten().flatten().collect::<Vec<_>>()
        });
        lines.chain(joints).filter(|own| own.load > own.strength).collect()
    }

    /// Returns the vertical force (N) of a joint at rest: the force that the bodies on one side of it need to float. `None` if
    /// the joint lets its ends rise relative to each other, or if another joint, a lock or the bottom bears part of the force.
    fn vertical_force(&self, joint: &JointSpec<D>) -> Option<f64> {
        let lack = |j: &usize| self.water.g * (self.bodies[*j].body.mass - self.displaced(*j)) + self.tie_load(*j);
        Some(self.borne_by(joint)?.iter().map(lack).sum::<f64>().abs())
    }

    /// Returns the torque (N m) of a fixed joint at rest, as [`Self::vertical_force`]: that of the weight and the buoyancy of the
    /// bodies on one side of it, and of lines and steady forces on them. `None` also if a lock keeps one of them from turning.
    fn torque(&self, joint: &JointSpec<D>) -> Option<f64> {
        let own = self.borne_by(joint).filter(|_| joint.kind == JointKind::Fixed)?;
        if own.iter().any(|j| self.bodies[*j].body.locked_rotations.contains(&true)) {
            return None;
        }
        let mut torque = Bivector::zero();
        let mut add = |at: Vector<D>, force: Vector<D>| torque = torque + Bivector::torque(&(at - joint.at), &force);
        let lifted = |j: usize, at: &Vector<D>| at + self.raised(j);
        for j in own.iter().copied() {
            let (body, pose) = (&self.bodies[j], self.pose(j));
            let (volume, centroid) = body.hull.submerged_volume(&pose, body.level);
            add(pose.point(&body.body.centre), up::<D>() * (-self.water.g * body.body.mass));
            add(centroid, up::<D>() * (self.water.g * self.water.rho0 * volume));
            for line in &self.lines {
                let pull = self.pull(line).0;
                let ends = [(0, 1.0), (1, -1.0)].into_iter().filter(|(end, _)| line.bodies[*end] == Some(j));
                ends.for_each(|(end, sign)| add(lifted(j, &line.at[end]), pull * sign));
            }
            self.forces.iter().filter(|own| own.body == j).for_each(|own| add(lifted(j, &own.at), own.force));
        }
        for force in self.forces.iter().filter(|force| own.contains(&force.body)) {
            torque = torque + force.torque;
        }
        Some(torque.axial().iter().map(|x| x * x).sum::<f64>().sqrt())
    }

    /// Returns the bodies on one side of a joint, whose load it bears alone. `None` if the joint lets its ends rise relative to each
    /// other, or if another joint, a lock or the bottom bears part of it.
    fn borne_by(&self, joint: &JointSpec<D>) -> Option<Vec<usize>> {
        let ends = |joint: &JointSpec<D>| joint.between.map(|end| end.and_then(|solid| self.number(solid)));
        let rises_along = match ends(joint) {
            [Some(a), Some(b)] => self.group[a] == self.group[b],
            [Some(a), None] | [None, Some(a)] => self.held[self.group[a]],
            [None, None] => false,
        };
        // The parts into which the other joints tie the bodies; the last number is that of the ground.
        let ground = self.bodies.len();
        let mut part: Vec<usize> = (0..=ground).collect();
        for other in self.joints.iter().filter(|other| other.name != joint.name) {
            let [a, b] = ends(other).map(|end| end.unwrap_or(ground));
            merge(&mut part, a, b);
        }
        let parts = ends(joint).map(|end| part[end.unwrap_or(ground)]);
        let has_all = |own: &usize| {
            let members = || (0..ground).filter(|j| part[*j] == *own);
            let is_carried = |j: usize| self.lies_on_bottom(j) || self.bodies[j].body.locked_translations[D - 1];
            *own != part[ground] && !members().any(is_carried)
        };
        let own = parts.into_iter().find(|own| rises_along && parts[0] != parts[1] && has_all(own))?;
        Some((0..ground).filter(|j| part[*j] == own).collect())
    }
}
