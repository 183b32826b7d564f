//! The division of the slabs among ranks: which rank computes which slabs, and so which particles.

use std::ops::Range;

use bytemuck::Pod;

use super::clusters::{PAD, Slab};
use crate::{
    math::simd::LANES,
    math::{Bounds, Vector},
    ranks::{self, Ranks},
};

/// Particles of which the first rank gets the numbers at a time.
const PIECE: usize = 1 << 13;

/// Different indices in ascending order, stored as ranges: the water of a rank has few ranges once it is sorted.
#[derive(Clone, Debug, Default)]
pub(crate) struct IndexRanges(Vec<Range<u32>>);

impl IndexRanges {
    /// Stores indices that are in ascending order.
    pub(crate) fn new(ascending: impl IntoIterator<Item = u32>) -> Self {
        let mut all = Self::default();
        ascending.into_iter().for_each(|i| all.push(i));
        all
    }

    /// Adds an index above all others.
    fn push(&mut self, i: u32) {
        match self.0.last_mut().filter(|last| last.end == i) {
            Some(last) => last.end += 1,
            None => self.0.push(i..i + 1),
        }
    }

    /// The number of indices.
    pub(crate) fn len(&self) -> usize {
        self.0.iter().map(ExactSizeIterator::len).sum()
    }

    /// The indices in ascending order.
    pub(crate) fn iter(&self) -> impl Iterator<Item = u32> + Clone {
        self.0.iter().cloned().flatten()
    }

    /// The indices in `part`.
    pub(crate) fn within(&self, part: &Range<usize>) -> impl Iterator<Item = u32> + Clone {
        let (start, end) = (part.start as u32, part.end as u32);
        let ranges = self.0[self.0.partition_point(|range| range.end <= start)..].iter();
        let ranges = ranges.take_while(move |range| range.start < end);
        ranges.flat_map(move |range| range.start.max(start)..range.end.min(end))
    }

    /// The smallest range that contains all indices.
    fn around(&self) -> Range<usize> {
        match self.0.first().zip(self.0.last()) {
            Some((first, last)) => first.start as usize..last.end as usize,
            None => 0..0,
        }
    }
}

/// The division; of a single rank, which has everything, it is empty.
#[derive(Clone, Debug, Default)]
pub struct Division {
    pub(crate) ranks: Ranks,
    /// The slabs of each rank.
    pub(crate) slabs: Vec<Range<usize>>,
    /// Whether each rank advances its own water only. If not, every rank needs the sums of all.
    pub(crate) by_owner: bool,
    /// Whether ranks lack the present water of others, because each has advanced its own.
    pub(crate) is_apart: bool,
    /// Water particles of this rank.
    own: IndexRanges,
    /// Whether the water particle is this rank's; empty if all in its range are.
    is_own: Box<[bool]>,
    /// Boundary particles near water of each rank, by their place among all of these.
    boundary: Vec<IndexRanges>,
    /// Those of this rank.
    own_boundary: Box<[u32]>,
    /// Number of list entries of each slab.
    entries: Vec<u32>,
}

impl Division {
    /// Of `ranks`, which have no slabs yet.
    pub(crate) fn of(ranks: &Ranks) -> Self {
        Self { ranks: ranks.clone(), ..Self::default() }
    }

    /// The slabs that this rank computes.
    pub(crate) fn own_slabs(&self) -> Range<usize> {
        self.slabs.get(self.ranks.rank()).cloned().unwrap_or_default()
    }

    /// The slabs that the sums of this rank read, of `count`: its own and the next.
    pub(super) fn read_slabs(&self, count: usize) -> Range<usize> {
        let own = self.own_slabs();
        if own.is_empty() { own } else { own.start..(own.end + 1).min(count) }
    }

    /// The water particles that this rank advances, and for every particle whether it is this rank's, unless all in its range are;
    /// `None` if it advances all.
    pub(crate) fn own_water(&self) -> Option<(&IndexRanges, Option<&[bool]>)> {
        let is_own = (!self.is_own.is_empty()).then_some(&self.is_own[..]);
        self.by_owner.then_some((&self.own, is_own))
    }

    /// The water particles that this rank advances; none if it advances all.
    pub(crate) fn own_indices(&self) -> impl Iterator<Item = u32> + Clone {
        self.own_water().into_iter().flat_map(|(own, _)| own.iter())
    }

    /// The range of the water particles that this rank advances, of `count`; others may be among them.
    pub(crate) fn own_range(&self, count: usize) -> Range<usize> {
        if self.by_owner { self.own.around() } else { 0..count }
    }

    /// The places, among the boundary particles near water, of those that this rank advances, in ascending order; `None` if it advances
    /// all.
    pub(crate) fn own_boundary(&self) -> Option<&[u32]> {
        (self.by_owner && !self.boundary.is_empty()).then_some(&self.own_boundary[..])
    }

    /// Makes `own` the water of this rank, in ascending order, of `count` particles.
    pub(crate) fn set_own_water(&mut self, own: Vec<u32>, count: usize) {
        self.own = IndexRanges::new(own);
        self.is_own = vec![false; if self.own.0.len() > 1 { count } else { 0 }].into();
        if !self.is_own.is_empty() {
            self.own.iter().for_each(|i| self.is_own[i as usize] = true);
        }
    }

    /// The rank that computes `slab`.
    pub(crate) fn owner_of(&self, slab: usize) -> usize {
        self.slabs.partition_point(|slabs| slabs.end <= slab)
    }

    /// The ranks that have the slabs before and after those of this one.
    pub(crate) fn adjacent(&self) -> [Option<usize>; 2] {
        let own = self.own_slabs();
        if own.is_empty() {
            return [None; 2];
        }
        let after = self.owner_of(own.end);
        [own.start.checked_sub(1).map(|slab| self.owner_of(slab)), (after < self.ranks.count()).then_some(after)]
    }

    /// Shares out the slabs, which have so many `particles` of water: by the entries of the last lists, or by particles where the
    /// slabs are others.
    pub(super) fn share_out(&mut self, particles: &[u32]) {
        let weights = if self.entries.len() == particles.len() { &self.entries } else { particles };
        let weights: Vec<u64> = weights.iter().map(|&n| u64::from(n)).collect();
        self.slabs = ranks::equal_parts(&weights, self.ranks.count());
    }

    /// The smallest box around those of all ranks.
    pub(crate) fn union<const D: usize>(&self, own: &Bounds<D>) -> Bounds<D> {
        let mut ends: Vec<f64> = own.min.iter().chain(own.max.iter()).copied().collect();
        ends.resize(2 * D * self.ranks.count(), 0.0);
        ends.rotate_right(2 * D * self.ranks.rank());
        let parts: Vec<Range<usize>> = (0..self.ranks.count()).map(|rank| 2 * D * rank..2 * D * (rank + 1)).collect();
        self.ranks.share_doubles(&mut ends, &parts);
        let bounds = |ends: &[f64]| Bounds {
            min: Vector::from_column_slice(&ends[..D]),
            max: Vector::from_column_slice(&ends[D..]),
        };
        ends.chunks_exact(2 * D).map(bounds).fold(Bounds::empty(), |all, one| all.union(&one))
    }

    /// Completes the numbers of columns, of which each rank has those of its slabs; slab s has the `columns(s)`.
    pub(super) fn share_by_column(&self, numbers: &mut [f64], columns: impl Fn(usize) -> Range<usize>) {
        let of = |slabs: &Range<usize>| match slabs.is_empty() {
            true => 0..0,
            false => columns(slabs.start).start..columns(slabs.end - 1).end,
        };
        self.ranks.share_doubles(numbers, &self.slabs.iter().map(of).collect::<Vec<_>>());
    }

    /// Completes `touched` with the boundary particles that the lists of other ranks touch, and counts the entries of all lists.
    pub(super) fn combine_lists(&mut self, slabs: &[Slab], touched: &mut [u8]) {
        if self.ranks.count() == 1 {
            return;
        }
        // All ranks have the same clusters of boundary particles, but not those of all water.
        let clusters_of = |part: &Range<usize>| {
            let last = if part.is_empty() { part.start } else { (part.end + 1).min(slabs.len()) };
            slabs[part.start..last].iter().flat_map(|slab| slab.middle..slab.end)
        };
        let own: Vec<u8> = clusters_of(&self.own_slabs()).map(|c| touched[c]).collect();
        for (part, theirs) in self.slabs.iter().zip(self.ranks.gather_bytes(&own)) {
            clusters_of(part).zip(theirs).for_each(|(c, one)| touched[c] |= one);
        }
        self.entries = slabs.iter().map(|slab| slab.index.len() as u32).collect();
        self.ranks.share_numbers(&mut self.entries, &self.slabs);
    }

    /// Finds the particles of each rank, of `water` ones: `source` has the particle in each slot, `boundary_slots` the slots of the
    /// boundary particles near water.
    pub(super) fn find_owners(&mut self, slabs: &[Slab], source: &[u32], boundary_slots: &[u32], water: usize) {
        if self.ranks.count() == 1 {
            return;
        }
        let slots = |part: &Range<usize>| match slabs[part.clone()].first() {
            Some(slab) => slab.first * LANES..slabs[part.end - 1].end * LANES,
            None => 0..0,
        };
        if !self.is_apart {
            let own = slabs[self.own_slabs()].iter().flat_map(|slab| slab.first * LANES..slab.middle * LANES);
            let mut own: Vec<u32> = own.map(|slot| source[slot]).filter(|&i| i != PAD).collect();
            own.sort_unstable();
            self.set_own_water(own, water);
        }
        let ends: Vec<Range<usize>> = self.slabs.iter().map(slots).collect();
        self.boundary = vec![IndexRanges::default(); ends.len()];
        for (k, &slot) in boundary_slots.iter().enumerate() {
            if let Some(rank) = ends.iter().position(|slots| slots.contains(&(slot as usize))) {
                self.boundary[rank].push(k as u32);
            }
        }
        self.own_boundary = self.boundary[self.ranks.rank()].iter().collect();
    }

    /// Completes the numbers of boundary particles near water in `data`, `width` of each: `give` appends those of place k, `take`
    /// sets them. Every rank has those of its own slabs.
    pub(crate) fn share_boundary<C>(
        &self,
        data: &mut C,
        width: usize,
        give: impl Fn(&C, usize, &mut Vec<f64>),
        take: impl Fn(&mut C, usize, &[f64]),
    ) {
        let counts: Vec<usize> = self.boundary.iter().map(IndexRanges::len).collect();
        let mut rest: Vec<_> = self.boundary.iter().map(IndexRanges::iter).collect();
        let [mut given, mut taken] = [Vec::with_capacity(width), Vec::with_capacity(width)];
        let pack = |data: &C, k: usize, words: &mut Vec<u32>| {
            given.clear();
            give(data, self.own_boundary[k] as usize, &mut given);
            words.extend(given.iter().flat_map(|x| ranks::words_of(*x)));
        };
        let unpack = |data: &mut C, rank: usize, _: usize, words: &[u32]| {
            let Some(k) = rest[rank].next() else { return };
            taken.clear();
            taken.extend(ranks::doubles(words));
            take(data, k as usize, &taken);
        };
        self.ranks.share_items(data, (&counts, 2 * width), pack, unpack);
    }

    /// Gives `width` numbers of each of the water particles `these` of this rank to the others, which gives them theirs: `give`
    /// appends those of a particle, `take` gets those of another rank's.
    pub(crate) fn share_water<C>(
        &self,
        these: &IndexRanges,
        data: &mut C,
        width: usize,
        give: impl Fn(&C, usize, &mut Vec<f64>),
        mut take: impl FnMut(&mut C, usize, &[f64]),
    ) {
        let counts: Vec<usize> = self.ranks.counts(these.len());
        let [mut given, mut taken] = [Vec::with_capacity(width), Vec::with_capacity(width)];
        let mut rest = these.iter();
        let pack = |data: &C, _: usize, words: &mut Vec<u32>| {
            let Some(i) = rest.next() else { return };
            given.clear();
            give(data, i as usize, &mut given);
            words.push(i);
            words.extend(given.iter().flat_map(|x| ranks::words_of(*x)));
        };
        let unpack = |data: &mut C, _: usize, _: usize, words: &[u32]| {
            taken.clear();
            taken.extend(ranks::doubles(&words[1..]));
            take(data, words[0] as usize, &taken);
        };
        self.ranks.share_items(data, (&counts, 1 + 2 * width), pack, unpack);
    }

    /// Gives the first rank the items of `all`, of which each rank has those of its own water, in order and a piece at a time: `use_piece`
    /// gets the pieces there. All ranks must call this.
    pub(crate) fn collect<T: Pod>(&self, all: &[T], mut use_piece: impl FnMut(&[T])) {
        let (ranks, width) = (&self.ranks, size_of::<T>() / 4);
        let pieces: Vec<Range<usize>> =
            (0..all.len()).step_by(PIECE).map(|start| start..all.len().min(start + PIECE)).collect();
        let given: Vec<u32> = pieces.iter().map(|piece| self.own.within(piece).count() as u32).collect();
        let counts = ranks.gather_lists(&given);
        let (mut words, mut whole) = (Vec::<u32>::new(), Vec::new());
        for (k, piece) in pieces.into_iter().enumerate() {
            words.clear();
            if ranks.rank() > 0 {
                for i in self.own.within(&piece) {
                    words.push(i);
                    words.extend_from_slice(bytemuck::cast_slice(std::slice::from_ref(&all[i as usize])));
                }
                if !words.is_empty() {
                    ranks.pass((Some(0), &words), (None, &mut []));
                }
                continue;
            }
            whole.clear();
            whole.extend_from_slice(&all[piece.clone()]);
            for (rank, counts) in counts.chunks_exact(given.len()).enumerate().skip(1) {
                words.resize(counts[k] as usize * (1 + width), 0);
                if !words.is_empty() {
                    ranks.pass((None, &[]), (Some(rank), &mut words));
                }
                for words in words.chunks_exact(1 + width) {
                    whole[words[0] as usize - piece.start] =
                        bytemuck::pod_read_unaligned(bytemuck::cast_slice(&words[1..]));
                }
            }
            use_piece(&whole);
        }
    }
}

#[cfg(test)]
#[path = "../../tests/unit/neighbours/division.rs"]
mod tests;
