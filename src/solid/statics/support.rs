//! The effect that carries a body at rest, and the bodies that are tied to it.

use super::{JointKind, JointSpec, StaticSystem, merge, plan_area};

/// The effect that carries a body at rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Support {
    /// The water: the body, or the group that rises with it, cuts the surface.
    Water,
    /// Lines and forces: the body hangs in the air, or in the water below its surface.
    Lines,
    /// A joint or a lock holds its height.
    Held,
    /// The bottom, or a solid that it lies on.
    Bottom,
    /// A solid on which it stands in the air.
    Solid,
    /// None: its rim is below the surface, and water fills the hull.
    Floods,
    /// The water, at any depth: it is as dense as the water.
    Neutral,
}

impl<const D: usize> StaticSystem<'_, D> {
    /// Returns the effect that carries body `i` at rest.
    pub(crate) fn support(&self, i: usize) -> Support {
        if self.held[self.group[i]] {
            return Support::Held;
        }
        let (mass, carried) =
            self.group_of(i).fold((0.0, 0.0), |sum, j| (sum.0 + self.bodies[j].body.mass, sum.1 + self.displaced(j)));
        if carried < (1.0 - 1e-6) * mass && self.group_of(i).any(|j| self.lies_on_bottom(j)) {
            if self.is_in_air(i) && self.lies_on_bottom(i) {
                return Support::Solid;
            }
            let open = self.bodies[i].hull.rim_height(&self.bodies[i].pose).is_finite();
            return if open { Support::Floods } else { Support::Bottom };
        }
        let floods =
            |j: usize| self.bodies[j].hull.rim_height(&self.pose(j)) < self.bodies[j].level - 1e-6 * self.size(j);
        if self.group_of(i).any(floods) {
            return Support::Floods;
        }
        if self.is_neutral(i) {
            return Support::Neutral;
        }
        let floats = self.waterplane(i) > 1e-6 * plan_area(&self.bodies[i].hull, &self.bodies[i].pose);
        if floats { Support::Water } else { Support::Lines }
    }

    /// Returns whether body `i` is in the air, at the rise found so far.
    pub(super) fn is_in_air(&self, i: usize) -> bool {
        self.bodies[i].hull.shape.submerged_volume(&self.pose(i), self.bodies[i].level).0 <= 0.0
    }

    /// Returns whether body `i`, without ties, displaces just its mass when it is submerged.
    fn is_neutral(&self, i: usize) -> bool {
        let (hull, pose, mass) = (&self.bodies[i].hull, self.pose(i), self.bodies[i].body.mass);
        let most = self.water.rho0 * hull.volume_if_dry(&pose, hull.extent(&pose)[1]);
        self.floats_alone(i) && (most - mass).abs() < 1e-6 * mass
    }

    /// Returns the bodies between which and body `i` there are joints, ropes or springs, with it.
    pub(crate) fn tied_to(&self, i: usize) -> Vec<usize> {
        let mut part = self.assembly.clone();
        for line in &self.lines {
            if let [Some(a), Some(b)] = line.bodies {
                merge(&mut part, a, b);
            }
        }
        (0..part.len()).filter(|j| part[*j] == part[i]).collect()
    }

    /// Returns whether a rope, or a joint that leaves a motion free, ties body `i` or what is tied to it.
    pub(crate) fn has_loose_ties(&self, i: usize) -> bool {
        let own = self.tied_to(i);
        let is_own = |end: Option<usize>| end.is_some_and(|j| own.contains(&j));
        let is_loose = |joint: &JointSpec<D>| {
            let ends = joint.between.map(|end| end.and_then(|solid| self.number(solid)));
            joint.kind != JointKind::Fixed && ends.into_iter().any(is_own)
        };
        self.joints.iter().any(is_loose) || own.iter().any(|j| self.is_roped(*j))
    }

    /// Returns whether a rope ties body `i`.
    pub(crate) fn is_roped(&self, i: usize) -> bool {
        self.lines.iter().any(|line| line.is_rope && line.bodies.contains(&Some(i)))
    }
}
