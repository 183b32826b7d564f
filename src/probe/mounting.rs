//! Points at which probes measure: fixed in the world, or moving with a solid.

use super::{find_solid, point};
use crate::{
    error::Result,
    math::{Matrix, Vector},
    system::System,
};

/// A point of the world or of a solid.
pub(super) struct MountedPoint<const D: usize> {
    /// Coordinates in the world, or in the frame of the solid, m.
    at: Vector<D>,
    /// Number of the solid.
    solid: Option<usize>,
}

impl<const D: usize> MountedPoint<D> {
    /// The point of the world whose first `count` coordinates are `at` (m).
    ///
    /// # Errors
    /// `Usage` if `at` does not have `count` finite numbers.
    pub(super) fn in_world(at: &[f64], count: usize) -> Result<Self> {
        Ok(Self { at: point(at, count)?, solid: None })
    }

    /// The same point in the frame of the solid called `on`, if a name is given.
    ///
    /// # Errors
    /// `Scene` if there is no such solid.
    pub(super) fn on(self, system: &System<D>, on: Option<&str>) -> Result<Self> {
        Ok(Self { solid: on.map(|name| find_solid(system, name)).transpose()?, ..self })
    }

    /// Whether it goes with a solid.
    pub(super) fn is_mounted(&self) -> bool {
        self.solid.is_some()
    }

    /// Whether it was a point of a solid that is removed.
    pub(super) fn is_removed(&self, system: &System<D>) -> bool {
        self.solid.is_some_and(|solid| system.solids()[solid].is_removed())
    }

    /// Its place in the world, between periodic sides, m.
    pub(super) fn position(&self, system: &System<D>) -> Vector<D> {
        let on_solid = |solid: usize| system.wrapped(&system.solids()[solid].kinematics.pose.point(&self.at));
        self.solid.map_or(self.at, on_solid)
    }

    /// The velocity (m/s) of the point and the rotation of its axes: zero and the identity for a point of the world.
    pub(super) fn velocity_and_axes(&self, system: &System<D>) -> (Vector<D>, Matrix<D>) {
        let Some(solid) = self.solid else { return (Vector::zeros(), Matrix::identity()) };
        let now = &system.solids()[solid].kinematics;
        (now.velocity + now.spin.velocity_at(&(now.pose.point(&self.at) - now.centre)), now.pose.rotation)
    }
}
