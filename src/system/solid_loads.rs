//! The loads of the water on the solids, from the sums over pairs.

use std::ops::Range;

use rayon::prelude::*;

use super::{System, film, thin_layers};
use crate::{
    interaction::{PairLoop, PairSums, RequestedSums},
    math::Vector,
    neighbours::CHUNK,
    solid::{Load, Solid},
};

/// Computes the sums of another pair loop at the state of the last force pass; returns the loads that they give on the solids.
pub(crate) fn of_pair_loop<const D: usize>(system: &System<D>, pair_loop: &mut dyn PairLoop<D>) -> Vec<Load<D>> {
    let (medium, state) = (&system.properties, &system.equation_of_state);
    let input = System::pair_input(&system.neighbours, &system.fluid, &system.boundary, medium, state);
    let mut boundary = vec![PairSums::zero(); system.rates.boundary.len()];
    // It has not been told what has changed since its last pass.
    pair_loop.inputs_changed();
    pair_loop.rates(&input, RequestedSums::Rates, &mut boundary);
    System::add_gap_pressure(&system.gap_pressure, &input, &mut boundary);
    of_pass(system, &boundary, &film::loads(system, &boundary).loads)
}

/// The load on each solid by `films`, by thin parts and by the `sums` of the wet boundary particles, which are added up in
/// chunks of fixed size, in order.
pub(super) fn of_pass<const D: usize>(system: &System<D>, sums: &[PairSums<D>], films: &[Load<D>]) -> Vec<Load<D>> {
    let (mass, wet, r) =
        (system.particle_mass(), system.neighbours.boundary_near_fluid(), &system.boundary.particles.r);
    let thin = thin_layers::loads(system);
    let place = |end: usize| wet.partition_point(|&i| (i as usize) < end);
    let of_copy = |solid: &Solid<D>, (range, way): (Range<usize>, Vector<D>)| {
        let centre = solid.kinematics.centre + way;
        let own = place(range.start)..place(range.end);
        let chunks = wet[own.clone()].par_chunks(CHUNK).zip(sums[own].par_chunks(CHUNK));
        let part = |(wet, sums): (&[u32], &[PairSums<D>])| {
            // Beyond a periodic side the water is an image, and its load has been counted; beyond a face it is a buffer.
            let own = wet.iter().map(|&i| &r[i as usize]).zip(sums);
            let own = own.filter(|(r, _)| system.is_in_counted_water(r));
            if solid.division.cut == 0 {
                return own.map(|(r, s)| Load::from_force_at(&(r - centre), s.acceleration * mass)).sum();
            }
            let force = |r: &Vector<D>, s: &PairSums<D>| s.acceleration * (mass * system.computed_share(solid, r));
            own.map(|(r, s)| Load::from_force_at(&(r - centre), force(r, s))).sum()
        };
        let parts: Vec<Load<D>> = chunks.map(part).collect();
        parts.into_iter().sum()
    };
    let of = |numbered: (usize, &Solid<D>)| {
        let copies = system.boundary.copies(&system.fluid.images, numbered, &numbered.1.kinematics.pose);
        let load = copies.map(|copy| of_copy(numbered.1, copy)).sum::<Load<D>>();
        let load = [films, &thin].iter().filter_map(|loads| loads.get(numbered.0)).fold(load, |sum, load| sum + *load);
        if numbered.1.division.cut == 0 { load } else { system.load_on_whole(numbered.1, load) }
    };
    system.solids.iter().enumerate().map(of).collect()
}
