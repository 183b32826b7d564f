//! The water of other ranks that a simulation gets.

use super::Simulation;
use crate::{
    math::Bounds,
    system::{known_water, own_water},
};

impl<const D: usize> Simulation<D> {
    /// Completes the water on the first rank, or on all if `everyone`, and its sums there. All ranks must call this.
    pub(crate) fn gather_water(&mut self, everyone: bool) {
        (self.compiled.gather_water)(self, everyone);
    }

    pub(super) fn complete_water(&mut self, everyone: bool) {
        own_water::gather(&mut self.system, everyone);
    }

    /// Gives all ranks the water within the boxes (m) that the first rank names, where they lack it. All ranks must call this.
    pub(crate) fn know_water_within(&mut self, ranges: &[Bounds<D>]) {
        let ranges = known_water::share_ranges(&self.system, ranges);
        known_water::know_within(&mut self.system, &ranges);
    }

    /// Gives the first rank the water that the checks before the first step read: places and velocities, with mooring lines all. All ranks
    /// must call this at the set-up.
    pub(crate) fn gather_for_checks(&mut self) {
        if self.bodies.moorings.is_empty() {
            known_water::gather_places(&mut self.system);
        } else {
            self.gather_water(false);
        }
    }

    /// Leaves the first rank the places of its own water, if it got those of all for the checks.
    pub(crate) fn forget_places(&mut self) {
        known_water::forget_places(&mut self.system);
    }
}
