//! The water around each solid: its draft, its support and its buoyancy are those in this water, not in the highest one.

use super::{PreflightContext, hollows::particles_around};
use crate::{geometry::world_bounds, scene::level_at};

/// The still water around a solid at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Surroundings {
    /// Water in the open with this level, m.
    Open(f64),
    /// The water of a hull, with this level, m.
    Hull(f64),
    /// None: it is in a dry hollow, or beside all water.
    Dry,
}

/// Returns the surroundings of each solid. `inside` has the level (m) of the water of each hull by its number.
pub(super) fn find_surroundings<const D: usize>(
    context: &PreflightContext<D>,
    inside: &[(usize, f64)],
) -> Vec<Surroundings> {
    let solids = context.solids();
    let around = |i: usize| {
        let hulls = || (0..solids.len()).filter_map(|j| Some((j, particles_around(context, i, j)?)));
        if hulls().any(|(_, particles)| particles == 0) {
            return Surroundings::Dry;
        }
        let own = |(hull, _)| inside.iter().find(|(named, _)| *named == hull).map(|(_, level)| *level);
        if let Some(level) = hulls().find_map(own) {
            return Surroundings::Hull(level);
        }
        let bounds = world_bounds(&solids[i].spec.shape, &solids[i].kinematics.pose);
        // Without open water the highest level is that of all.
        let boxes = &context.open_water;
        let open = if boxes.is_empty() { Some(context.still_water.level) } else { level_at(boxes, &bounds) };
        open.map_or(Surroundings::Dry, Surroundings::Open)
    };
    (0..solids.len()).map(around).collect()
}
