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
    let out = if before.is_some() { packed.words(water(own.start)) } else { Vec::new() };
    let next = if after.is_some() { water(own.end) } else { 0..0 };
    let mut into = vec![0; next.len() * PackedCluster::<D>::WORDS];
    clusters.division.ranks.pass((before, &out), (after, &mut into));
    packed.set_words(next, &into);
}

/// Completes `sums`, of which slab s has `lengths[s]` rows, with those of other ranks. A rank that advances its own water only
/// receives what the slab before adds to its first slab; otherwise a rank receives the sums of all slabs.
pub(super) fn complete_sums(sums: &mut [LaneRow], clusters: &Clusters, lengths: &[usize]) {
    let division = &clusters.division;
    if !division.by_owner {
        return share_all_sums(sums, clusters, lengths);
    }
    let ([before, after], own) = (division.adjacent(), clusters.own_slabs());
    // What slab s adds to the next one.
    let rows = |s: usize| {
        let (slab, next) = (&clusters.slabs[s], &clusters.slabs[s + 1]);
        let each = lengths[s] / (next.end - slab.first + 1);
        let start = lengths[..s].iter().sum::<usize>() + (next.first - slab.first) * each;
        start..start + (next.end - next.first) * each
    };
    let bits = |row: &LaneRow| row.0.map(f32::to_bits);
    let out: Vec<u32> =
        if after.is_some() { sums[rows(own.end - 1)].iter().flat_map(bits).collect() } else { Vec::new() };
    let theirs = if before.is_some() { rows(own.start - 1) } else { 0..0 };
    let mut into = vec![0; theirs.len() * LANES];
    division.ranks.pass((after, &out), (before, &mut into));
    for (row, words) in sums[theirs].iter_mut().zip(into.chunks_exact(LANES)) {
        row.0 = std::array::from_fn(|l| f32::from_bits(words[l]));
    }
}

/// The sums of all water particles; `own(i)` are those of a particle of this rank. Empty if this rank has all sums already.
pub(super) fn gather_sums<const D: usize>(clusters: &Clusters, own: impl Fn(usize) -> PairSums<D>) -> Vec<PairSums<D>> {
    let division = &clusters.division;
    let Some((these, _)) = division.own_water() else { return Vec::new() };
    let mut all = vec![PairSums::zero(); clusters.fluid_slots.len()];
    these.iter().for_each(|&i| all[i as usize] = own(i as usize));
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
