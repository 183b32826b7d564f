//! Films of water between solids if the water is on a device: the boundary particles that the host reads, and the loads from these
//! readings.

use std::collections::BTreeSet;

use super::{
    System,
    device_state::{has_free_solids, place_solid},
    film::{self, FilmLoads},
};
use crate::math::{Pose, Vector};

/// What the water does at a boundary particle near it, in a force pass.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct BoundaryWater<const D: usize> {
    /// Acceleration of the particle by the water and by the pressure across gaps, m/s².
    pub(crate) acceleration: Vector<D>,
    /// ρ/ρ₀ − 1 at the pressure that is extrapolated from the water, –.
    pub(crate) compression: f64,
    /// Unit vector from the water to the particle.
    pub(crate) away: Vector<D>,
}

/// Whether there may be films.
pub(crate) fn may_be<const D: usize>(system: &System<D>) -> bool {
    has_free_solids(system) && system.boundary.films.are_possible()
}

/// Places the boundary particles of solids with films on the host. Finds the films anew if a solid has moved by the margin of the
/// neighbour lists since the poses `then`, or without these; then returns the boundary particles that films read, in ascending order.
pub(crate) fn update<const D: usize>(system: &mut System<D>, then: &mut Option<Vec<Pose<D>>>) -> Option<Vec<u32>> {
    if !may_be(system) {
        return None;
    }
    let holds = |then: &Vec<Pose<D>>| system.solids_displacement(then) < system.neighbours.margin();
    if then.as_ref().is_some_and(holds) {
        place(system, system.boundary.films.solids().collect());
        return None;
    }
    let poses: Vec<Pose<D>> = system.solids.iter().map(|solid| solid.kinematics.pose).collect();
    place(system, film::touching(system, &poses).flatten().collect());
    let films = film::find(system, &poses, &system.boundary.particles.r);
    system.boundary.films.set(films);
    *then = Some(poses);
    Some(system.boundary.films.particles())
}

fn place<const D: usize>(system: &mut System<D>, solids: BTreeSet<usize>) {
    solids.into_iter().for_each(|solid| place_solid(system, solid));
}

/// What the films do, by the `water` at boundary particles, in ascending order of their indices.
pub(super) fn loads<const D: usize>(system: &mut System<D>, water: &[(u32, BoundaryWater<D>)]) -> FilmLoads<D> {
    let at = |i: u32| water.binary_search_by_key(&i, |(particle, _)| *particle).ok().map(|place| &water[place].1);
    film::update_water(system, |system, _, i| {
        at(i).map(|water| (system.equation_of_state.pressure(water.compression), water.away))
    });
    film::loads_by(system, |i| at(i).map(|water| water.acceleration))
}
