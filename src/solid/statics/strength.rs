//! Lines and joints that break before the bodies are at rest.

use super::StaticSystem;
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

    /// Returns the vertical force (N) of a joint at rest: what the bodies on one side of it lack to float by themselves. `None` if it
    /// lets its ends rise against one another, or if another joint, a lock or the bottom has part of the force.
    fn vertical_force(&self, joint: &JointSpec<D>) -> Option<f64> {
        let number = |solid: usize| self.bodies.iter().position(|body| body.solid == solid);
        let ends = |joint: &JointSpec<D>| joint.between.map(|end| end.and_then(number));
        let rises_along = match ends(joint) {
            [Some(a), Some(b)] => self.group[a] == self.group[b],
            [Some(a), None] | [None, Some(a)] => self.held[self.group[a]],
            [None, None] => false,
        };
        let others: Vec<[Option<usize>; 2]> =
            self.joints.iter().filter(|other| other.name != joint.name).map(ends).collect();
        let side = |from: usize| -> Option<Vec<usize>> {
            let mut members = vec![from];
            let mut next = 0;
            while let Some(&own) = members.get(next) {
                next += 1;
                for pair in others.iter().filter(|pair| pair.contains(&Some(own))) {
                    let other = if pair[0] == Some(own) { pair[1] } else { pair[0] };
                    let other = other?;
                    if !members.contains(&other) {
                        members.push(other);
                    }
                }
            }
            let carried = |j: &usize| {
                let own = &self.bodies[*j];
                let on_bottom = own.hull.extent(&self.pose(*j))[0] <= own.bottom + 1e-6 * self.size(*j);
                on_bottom || own.body.locked_translations[D - 1]
            };
            let has_both_ends = ends(joint).iter().all(|end| end.is_some_and(|j| members.contains(&j)));
            (!has_both_ends && !members.iter().any(carried)).then_some(members)
        };
        let members = ends(joint).into_iter().flatten().filter(|_| rises_along).find_map(side)?;
        let lack = |j: &usize| {
            let own = &self.bodies[*j];
            let lift = self.water.rho0 * own.hull.volume_if_dry(&self.pose(*j), self.water.level);
            self.water.g * (own.body.mass - lift) + self.tie_load(*j)
        };
        Some(members.iter().map(lack).sum::<f64>().abs())
    }
}
