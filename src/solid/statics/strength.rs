//! Lines and joints that break before the bodies are at rest.

use super::{StaticSystem, merge};
use crate::solid::JointSpec;

/// A line or a joint with more load at rest than it bears.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Overload {
    /// `spring`, `rope` or `joint`.
    pub(crate) kind: &'static str,
    pub(crate) name: String,
    /// Tension of the line, or vertical force of the joint, at rest, N (N/m in 2-D).
    pub(crate) load: f64,
    /// Load at which it breaks, N (N/m in 2-D).
    pub(crate) strength: f64,
}

impl<const D: usize> StaticSystem<'_, D> {
    /// Returns the lines and joints that break before the bodies are at rest.
    pub(crate) fn overloads(&self) -> Vec<Overload> {
        let lines = self.lines.iter().map(|line| Overload {
            kind: if line.is_rope { "rope" } else { "spring" },
            name: line.name.clone(),
            load: if line.bodies == [None; 2] { 0.0 } else { self.pull(line).0.norm() },
            strength: line.strength,
        });
        let joints = self.joints.iter().filter_map(|joint| {
            let strength = joint.lifetime.strength;
            let load = if strength.is_finite() { self.vertical_force(joint)? } else { 0.0 };
            Some(Overload { kind: "joint", name: joint.name.clone(), load, strength })
        });
        lines.chain(joints).filter(|own| own.load > own.strength).collect()
    }

    /// Returns the vertical force (N) of a joint at rest: the force that the bodies on one side of it need to float. `None` if
    /// the joint lets its ends rise relative to each other, or if another joint, a lock or the bottom bears part of the force.
    fn vertical_force(&self, joint: &JointSpec<D>) -> Option<f64> {
        let number = |solid: usize| self.bodies.iter().position(|body| body.solid == solid);
        let ends = |joint: &JointSpec<D>| joint.between.map(|end| end.and_then(number));
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
        let lack = |j: usize| self.water.g * (self.bodies[j].body.mass - self.displaced(j)) + self.tie_load(j);
        Some((0..ground).filter(|j| part[*j] == own).map(lack).sum::<f64>().abs())
    }
}
