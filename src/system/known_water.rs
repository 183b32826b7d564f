//! Water of other ranks that a rank knows for a while: that beside its own, that within some boxes, and the places of all for the checks
//! before the first step.

use super::{
    Fluid, System,
    own_water::{divided, ranks},
};
use crate::{
    math::{Bounds, Vector},
    neighbours::IndexRanges,
    particles::{Particles, zeros},
    ranks::{doubles, words_of},
};

/// Gives the first rank the places and velocities of all water, for which the lists have just been made, until
/// [`forget_places`]. It has no sums of the water then: each step begins with a pass.
pub(crate) fn gather_places<const D: usize>(system: &mut System<D>) {
    let Some(division) = divided(&system.neighbours) else { return };
    if division.ranks.rank() == 0 {
        system.pair_loop.free_buffers();
        system.rates.current = false;
    }
    let (is_first, own) = (division.ranks.rank() == 0, IndexRanges::new(division.own_indices()));
    let give = |water: &&mut Particles<D>, i: usize, numbers: &mut Vec<f64>| {
        numbers.extend(water.r[i].iter().chain(water.v[i].iter()));
    };
    let take = |water: &mut &mut Particles<D>, i: usize, numbers: &[f64]| {
        if is_first {
            water.take_motion(i, numbers);
        }
    };
    division.share_water(&own, &mut (&mut system.fluid.particles), 2 * D, give, take);
    if is_first {
        system.neighbours.find_at(&system.fluid.particles.r);
    }
}

/// Frees the memory of what [`gather_places`] gave.
pub(crate) fn forget_places<const D: usize>(system: &mut System<D>) {
    let count = system.fluid.particles.len();
    let Some(division) = divided(&system.neighbours).filter(|division| division.ranks.rank() == 0) else { return };
    if system.status.has_all_water {
        return;
    }
    let own = division.own_range(count);
    let Particles { r, v, .. } = &mut system.fluid.particles;
    for vectors in [r, v] {
        let mut kept = zeros(count);
        kept[own.clone()].copy_from_slice(&vectors[own.clone()]);
        *vectors = kept;
    }
    system.neighbours.forget_known();
}

/// Takes places and densities of the water in the slabs beside those of this rank, and lets queries at a point find these and its own.
pub(super) fn know_adjacent_slabs<const D: usize>(system: &mut System<D>) {
    let System { neighbours, fluid: Fluid { particles: Particles { r, rho, .. }, .. }, .. } = system;
    let Some(division) = divided(neighbours) else { return };
    let ([before, after], slabs) = (division.adjacent(), division.own_slabs());
    let mut known: Vec<u32> = division.own_indices().collect();
    let width = 1 + 2 * (D + 1);
    for (to, from, slab) in [(before, after, slabs.start), (after, before, slabs.end.saturating_sub(1))] {
        let mut out = Vec::new();
        for i in to.iter().flat_map(|_| neighbours.water_of_slab(slab)) {
            out.push(i as u32);
            out.extend(r[i].iter().chain([&rho[i]]).flat_map(|&x| words_of(x)));
        }
        let counts = division.ranks.counts(out.len());
        let mut into = vec![0; from.map_or(0, |rank| counts[rank])];
        division.ranks.pass((to, &out), (from, &mut into));
        for words in into.chunks_exact(width) {
            let (i, numbers): (_, Vec<f64>) = (words[0] as usize, doubles(&words[1..]).collect());
            (r[i], rho[i]) = (Vector::from_column_slice(&numbers[..D]), numbers[D]);
            known.push(words[0]);
        }
    }
    known.sort_unstable();
    let places: Vec<_> = known.iter().map(|&i| r[i as usize]).collect();
    neighbours.know(known, &places);
}

/// The boxes (m) of the first rank.
pub(crate) fn share_ranges<const D: usize>(system: &System<D>, own: &[Bounds<D>]) -> Vec<Bounds<D>> {
    let numbers: Vec<f64> = own.iter().flat_map(|range| range.min.iter().chain(range.max.iter())).copied().collect();
    let all = ranks(system).gather_bytes(bytemuck::cast_slice(&numbers));
    let numbers: Vec<f64> = bytemuck::pod_collect_to_vec(&all[0]);
    let range = |ends: &[f64]| Bounds {
        min: Vector::from_column_slice(&ends[..D]),
        max: Vector::from_column_slice(&ends[D..]),
    };
    numbers.chunks_exact(2 * D).map(range).collect()
}

/// Gives all ranks the present water of all within `ranges` (m), the same on all of them, where ranks lack the water of others. Until
/// the next lists are made, queries at a point find this water alone.
pub(crate) fn know_within<const D: usize>(system: &mut System<D>, ranges: &[Bounds<D>]) {
    let System { neighbours, fluid: Fluid { particles, .. }, .. } = system;
    let Some(division) = divided(neighbours).filter(|_| !ranges.is_empty()) else { return };
    let is_within = |i: &u32| ranges.iter().any(|range| range.contains(&particles.r[*i as usize]));
    let own: Vec<u32> = neighbours.own_within(ranges).into_iter().filter(is_within).collect();
    let then = neighbours.positions_at_build();
    let mut known: Vec<(u32, Vector<D>)> = own.iter().map(|&i| (i, then[i as usize])).collect();
    let numbers = Particles::<D>::NUMBERS;
    let give = |(water, _): &(&mut Particles<D>, &mut Vec<(u32, Vector<D>)>), i: usize, given: &mut Vec<f64>| {
        water.give(i, given);
        given.extend(then[i].iter());
    };
    let take = |(water, known): &mut (&mut Particles<D>, &mut Vec<(u32, Vector<D>)>), i: usize, given: &[f64]| {
        water.take(i, given);
        known.push((i as u32, Vector::from_column_slice(&given[numbers..])));
    };
    division.share_water(&IndexRanges::new(own), &mut (particles, &mut known), numbers + D, give, take);
    known.sort_unstable_by_key(|(i, _)| *i);
    let (these, places): (Vec<_>, Vec<_>) = known.into_iter().unzip();
    neighbours.know(these, &places);
}
