//! The effect that carries a body at rest.

use super::{StaticSystem, plan_area};

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
}
