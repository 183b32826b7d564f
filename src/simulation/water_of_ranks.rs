//! The water of other ranks that a simulation gets at the set-up and for its probes.

use super::Simulation;
use crate::{math::Bounds, system::known_water};

/// Gives all ranks the water within the boxes (m) that the first rank names, where they lack it. All ranks must call this.
pub(crate) fn know_within<const D: usize>(sim: &mut Simulation<D>, ranges: &[Bounds<D>]) {
    let ranges = known_water::share_ranges(&sim.system, ranges);
    known_water::know_within(&mut sim.system, &ranges);
}

/// Gives the first rank the water that the checks before the first step read: places and velocities, with mooring lines all. All ranks must
/// call this at the set-up.
pub(crate) fn gather_for_checks<const D: usize>(sim: &mut Simulation<D>) {
    if sim.bodies.moorings.is_empty() {
        known_water::gather_places(&mut sim.system);
    } else {
        sim.gather_water(false);
    }
}

/// Leaves the first rank the places of its own water, if it got those of all for the checks.
pub(crate) fn forget_places<const D: usize>(sim: &mut Simulation<D>) {
    known_water::forget_places(&mut sim.system);
}
