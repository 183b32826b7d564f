//! What ranks exchange in a pass of the SIMD pair loop: packed water of a slab, rows of sums, sums of boundary particles.

use std::ops::Range;

use super::{
    PairSums,
    boundary_sums::{for_each_row, row_count},
    simd_layout::{PackedCluster, PackedParticles},
};
use crate::{
    math::Vector,
    math::simd::{LANES, LaneRow},
    neighbours::Clusters,
    sph::boundary::WallExtrapolation,
};

/// Takes the water of the first slab of the rank after this one, if ranks advance their own water only.
pub(super) fn receive_next_water<const D: usize>(packed: &mut PackedParticles<D>, clusters: &Clusters) {
    if !clusters.division.by_owner {
        return;
    }
    let ([before, after], own) = (clusters.division.adjacent(), clusters.own_slabs());
    let water = |slab: usize| clusters.slabs.get(slab).map_or(0..0, |slab| slab.first..slab.middle);
    let passed = ((before, water(own.start)), (after, water(own.end)));
    let width = PackedCluster::<D>::WORDS;
    clusters.division.ranks.pass_items(packed, passed, width, PackedParticles::give, PackedParticles::take);
}

/// Completes `sums`, of which slab s has `lengths[s]` rows, with those of other ranks. A rank that advances its own water only
/// receives what the slab before adds to its first slab; otherwise a rank receives the sums of all slabs.
pub(super) fn complete_sums(sums: &mut [LaneRow], clusters: &Clusters, lengths: &[usize]) {
    let division = &clusters.division;
    if !division.by_owner {
        return share_all_sums(sums, clusters, lengths);
    }
    let ([before, after], own) = (division.adjacent(), clusters.own_slabs());
    // What the last slab of this rank adds to the next one.
    let out = match after {
        None => 0..0,
        Some(_) => {
            let (last, next) = (&clusters.slabs[own.end - 1], &clusters.slabs[own.end]);
            let each = lengths[own.end - 1] / (next.end - last.first + 1);
            let start = lengths[..own.end - 1].iter().sum::<usize>() + (next.first - last.first) * each;
            start..start + (next.end - next.first) * each
        }
    };
    // Of the slab before there are no other rows.
    let theirs = if before.is_some() { 0..lengths[own.start - 1] } else { 0..0 };
    let give = |sums: &&mut [LaneRow], row: usize, words: &mut Vec<u32>| words.extend(sums[row].0.map(f32::to_bits));
    let take = |sums: &mut &mut [LaneRow], row: usize, words: &[u32]| {
        sums[row].0 = std::array::from_fn(|l| f32::from_bits(words[l]));
    };
    division.ranks.pass_items(&mut { sums }, ((after, out), (before, theirs)), LANES, give, take);
}

/// The sums of all water particles; `own(i)` are those of a particle of this rank. Empty if this rank has all sums already.
pub(super) fn gather_sums<const D: usize>(clusters: &Clusters, own: impl Fn(usize) -> PairSums<D>) -> Vec<PairSums<D>> {
    let division = &clusters.division;
    let Some((these, _)) = division.own_water() else { return Vec::new() };
    let mut all = vec![PairSums::zero(); clusters.fluid_slots.len()];
    these.iter().for_each(|i| all[i as usize] = own(i as usize));
    let give = |_: &Vec<PairSums<D>>, i: usize, numbers: &mut Vec<f64>| own(i).give(numbers);
    let take = |all: &mut Vec<PairSums<D>>, i: usize, numbers: &[f64]| all[i] = PairSums::taken(numbers);
    division.share_water(these, &mut all, D + 1, give, take);
    all
}

/// Completes `sums` with those of all slabs of other ranks.
fn share_all_sums(sums: &mut [LaneRow], clusters: &Clusters, lengths: &[usize]) {
    let mut end = 0;
    let rows = |slabs: &Range<usize>| {
        let start = end;
        end += lengths[slabs.clone()].iter().sum::<usize>();
        start..end
    };
    let parts: Vec<Range<usize>> = clusters.division.slabs.iter().map(rows).collect();
    clusters.division.ranks.share_rows(sums, &parts);
}

impl<const D: usize> PairSums<D> {
    /// Appends its numbers.
    fn give(&self, numbers: &mut Vec<f64>) {
        numbers.extend(self.acceleration.iter().chain([&self.compression_rate]));
    }

    /// The sums whose numbers [`PairSums::give`] appended.
    fn taken(numbers: &[f64]) -> Self {
        Self { acceleration: Vector::from_column_slice(&numbers[..D]), compression_rate: numbers[D] }
    }
}

/// Completes the sums of the boundary particles near water, if a rank has those of its own slabs only.
pub(super) fn share_boundary_sums<const D: usize>(sums: &mut [PairSums<D>], clusters: &Clusters) {
    if clusters.division.by_owner {
        let give = |sums: &&mut [PairSums<D>], k: usize, numbers: &mut Vec<f64>| sums[k].give(numbers);
        let take = |sums: &mut &mut [PairSums<D>], k: usize, numbers: &[f64]| sums[k] = PairSums::taken(numbers);
        clusters.division.share_boundary(&mut { sums }, D + 1, give, take);
    }
}

/// Completes the extrapolations to the boundary particles near water, with the velocity if `flow`, as [`share_boundary_sums`].
pub(super) fn share_extrapolations<const D: usize>(
    fits: &mut [WallExtrapolation<f64, D>],
    clusters: &Clusters,
    flow: bool,
) {
    if clusters.division.by_owner {
        let give = |fits: &&mut [WallExtrapolation<f64, D>], k: usize, numbers: &mut Vec<f64>| {
            let mut fit = fits[k];
            for_each_row(&mut fit, flow, |_, x| numbers.push(*x));
        };
        let take = |fits: &mut &mut [WallExtrapolation<f64, D>], k: usize, numbers: &[f64]| {
            for_each_row(&mut fits[k], flow, |row, x| *x = numbers[row]);
        };
        clusters.division.share_boundary(&mut { fits }, row_count(D, flow), give, take);
    }
}
