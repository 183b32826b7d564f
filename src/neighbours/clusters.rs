//! Clusters of eight particles of one kind, and for each particle the later clusters with which it has pairs.
//!
//! A column is cut into runs of eight. The clusters of a slab follow one another, water first, then boundary particles. The list
//! of a particle holds every later cluster of its own slab or the next slab that has a particle within the lists' reach. Each
//! pair of particles therefore occurs once, and the results of a slab belong to this slab and the next. The list of a water
//! particle begins with its own cluster; pairs of boundary particles are not listed.

use std::ops::Range;

use rayon::prelude::*;

use super::{
    columns::{Columns, Sorted},
    division::Division,
    search::{self, SearchInput, SearchSizes},
    to_integer,
};
use crate::{
    math::Vector,
    math::simd::{LANES, Level},
};

/// No particle: a pad that fills up a cluster.
pub const PAD: u32 = u32::MAX;

/// Distance of a pad from its cluster, in integer units: larger than any kernel support, and small enough that no difference
/// overflows.
pub(crate) const FAR_POSITION: i32 = 1 << 30;

/// Widths of a column that a cluster may span.
const SPAN: f64 = 2.0;

/// The clusters of one slab and their lists; a thread computes whole slabs.
#[derive(Clone, Debug, Default)]
pub struct Slab {
    /// First cluster of water.
    pub first: usize,
    /// End of the water, first cluster of boundary particles.
    pub middle: usize,
    /// End of the slab's clusters.
    pub end: usize,
    /// Number of parts of each list: one, unless the slab and the next have more clusters than an entry can number.
    pub(super) parts: usize,
    /// For each part of the list of each slot: its first entry in `index`, and its first entry of a cluster of boundary
    /// particles. A part ends where the next begins.
    pub(super) spans: Vec<[u32; 2]>,
    /// The clusters in the lists, numbered from the slab's first cluster and the start of the part.
    pub(super) index: Vec<u16>,
}

/// Clusters that the entries of one part of a list can number.
pub(super) const PART: usize = 1 << 16;

/// A part of the list of a slot.
pub struct ListPart<'a> {
    /// Number, in the slab, of the cluster of an entry 0.
    pub base: usize,
    /// Clusters of water.
    pub water: &'a [u16],
    /// Clusters of boundary particles.
    pub boundary: &'a [u16],
}

impl Slab {
    /// The list of a slot of this slab, in parts.
    #[inline(always)]
    pub fn list(&self, slot: usize) -> impl Iterator<Item = ListPart<'_>> {
        (0..self.parts).map(move |part| {
            let at = slot * self.parts + part;
            let [start, middle] = self.spans[at].map(|k| k as usize);
            let end = self.spans[at + 1][0] as usize;
            ListPart { base: part * PART, water: &self.index[start..middle], boundary: &self.index[middle..end] }
        })
    }

    /// Whether a slot of this slab has no list.
    #[inline(always)]
    pub(crate) fn is_unpaired(&self, slot: usize) -> bool {
        self.spans[slot * self.parts][0] == self.spans[(slot + 1) * self.parts][0]
    }
}

/// All clusters.
#[derive(Clone, Debug, Default)]
pub struct Clusters {
    /// The particle in each slot, eight slots a cluster: an index of a water or boundary particle, or [`PAD`].
    pub source: Vec<u32>,
    /// The slabs in order.
    pub slabs: Vec<Slab>,
    /// The slot of each water particle.
    pub fluid_slots: Vec<u32>,
    /// The slot of each wet boundary particle, in the order of [`super::NeighbourLists::boundary_near_fluid`].
    pub boundary_slots: Vec<u32>,
    /// What each rank computes.
    pub(crate) division: Division,
}

/// The extent of a cluster, for the search for pairs.
pub(super) struct ClusterExtent<const D: usize> {
    pub(super) column: u32,
    /// Lowest and highest particle along the columns, m.
    pub(super) low: f64,
    pub(super) high: f64,
    /// Middle and half of its box, in units.
    pub(super) centre: [i32; D],
    pub(super) half: [f32; D],
}

/// The clusters of one kind in each column.
pub(super) type Ranges = Vec<std::ops::Range<u32>>;

impl Clusters {
    /// Number of clusters.
    pub(crate) fn len(&self) -> usize {
        self.source.len() / LANES
    }

    /// Memory of the clusters and their lists, B.
    pub(super) fn memory_bytes(&self) -> usize {
        let slab = |slab: &Slab| 8 * slab.spans.capacity() + 2 * slab.index.capacity();
        4 * (self.source.len() + self.fluid_slots.len() + self.boundary_slots.len())
            + self.slabs.iter().map(slab).sum::<usize>()
    }

    /// Makes clusters and lists of the water and of the boundary particles that may be near it. Returns the boundary particles
    /// near water, in ascending order. Water that this rank lacks has no clusters, so cluster numbers differ between ranks.
    pub(super) fn build<const D: usize>(
        &mut self,
        columns: &Columns<D>,
        (water_r, water): (&[Vector<D>], &Sorted),
        (skin_r, skin): (&[Vector<D>], &Sorted),
        sizes: &SearchSizes,
        level: Level,
    ) -> Vec<u32> {
        self.source.clear();
        self.slabs.resize_with(columns.slab_count(), Slab::default);
        let (up, span, read) = (columns.up, SPAN * sizes.width, self.read_slabs());
        // Lists are made of the slabs that this rank reads, and only their clusters need an extent.
        let [mut extents, mut unread] = [Vec::with_capacity(self.source.capacity() / LANES), Vec::new()];
        let (mut ranges, mut end) = ([vec![0..0; columns.len()], vec![0..0; columns.len()]], 0);
        for (s, slab) in self.slabs.iter_mut().enumerate() {
            slab.first = end;
            let extents = if read.contains(&s) { &mut extents } else { &mut unread };
            for (kind, (r, sorted)) in [(water_r, water), (skin_r, skin)].into_iter().enumerate() {
                for column in columns.columns_of_slab(s) {
                    let before = (self.source.len() / LANES) as u32;
                    let particles = &sorted.order[sorted.start[column] as usize..sorted.start[column + 1] as usize];
                    cut(particles, r, up, span, column as u32, &mut self.source, extents);
                    ranges[kind][column] = before..(self.source.len() / LANES) as u32;
                }
                if kind == 0 {
                    slab.middle = self.source.len() / LANES;
                }
            }
            unread.clear();
            end = self.source.len() / LANES;
            slab.end = end;
        }
        self.source.shrink_to_fit();
        let x = self.places(water_r, skin_r, &mut extents, sizes.inv_unit);
        let (own, first) = (self.own_slabs(), self.slabs.get(read.start).map_or(0, |slab| slab.first));
        let given = SearchInput { columns, source: &self.source, x: &x, extents: (first, &extents), ranges: &ranges };
        let mut touched = search::fill_lists(given, &mut self.slabs, own, sizes, level);
        self.division.combine_lists(&self.slabs, &mut touched);
        let wet = self.maps(water_r.len(), &touched);
        self.division.find_owners(&self.slabs, &self.source, &self.boundary_slots, water_r.len());
        wet
    }

    /// The slabs that this rank computes.
    pub(crate) fn own_slabs(&self) -> Range<usize> {
        self.division.own_slabs()
    }

    /// The slabs that the sums of this rank read: its own and the next.
    pub(crate) fn read_slabs(&self) -> Range<usize> {
        self.division.read_slabs(self.slabs.len())
    }

    /// The positions of the slots of the read slabs in integer units, and the boxes around their clusters.
    fn places<const D: usize>(
        &self,
        water: &[Vector<D>],
        skin: &[Vector<D>],
        extents: &mut [ClusterExtent<D>],
        inv_unit: f64,
    ) -> Vec<[[i32; LANES]; D]> {
        let mut x = vec![[[0; LANES]; D]; self.len()];
        let read = self.read_slabs();
        let these = self.clusters_of(read.clone());
        let places = self.split_by_slab(read.clone(), &mut x[these], 1);
        let places: Vec<_> = places.into_iter().zip(self.split_by_slab(read, extents, 1)).collect();
        places.into_par_iter().for_each(|((slab, x), (_, extents))| {
            for ((c, x), extent) in (slab.first..).zip(x).zip(extents) {
                let source = &self.source[c * LANES..(c + 1) * LANES];
                fill_positions(x, source, if c < slab.middle { water } else { skin }, inv_unit);
                let n = occupied_lanes(source);
                for (k, x) in x.iter().enumerate() {
                    let apart = |i: &i32| i.wrapping_sub(x[0]);
                    let low = x[..n].iter().map(apart).min().unwrap_or(0);
                    let high = x[..n].iter().map(apart).max().unwrap_or(0);
                    extent.centre[k] = x[0].wrapping_add(low).wrapping_add((high - low) / 2);
                    // One more for the half that the division may drop.
                    extent.half[k] = ((high - low) / 2 + 1) as f32;
                }
            }
        });
        x
    }

    /// The clusters of these slabs.
    pub(crate) fn clusters_of(&self, slabs: Range<usize>) -> Range<usize> {
        match &self.slabs[slabs] {
            [] => 0..0,
            [first, .., last] => first.first..last.end,
            [slab] => slab.first..slab.end,
        }
    }

    /// `items` of these slabs, of which each cluster has `each`, slab by slab.
    pub(crate) fn split_by_slab<'a, T>(
        &'a self,
        slabs: Range<usize>,
        items: &'a mut [T],
        each: usize,
    ) -> Vec<(&'a Slab, &'a mut [T])> {
        let mut rest = items;
        let mut parts = Vec::with_capacity(slabs.len());
        for slab in &self.slabs[slabs] {
            let (these, others) = rest.split_at_mut((slab.end - slab.first) * each);
            parts.push((slab, these));
            rest = others;
        }
        parts
    }

    /// Records the slot of each particle; returns the boundary particles near water in ascending order.
    fn maps(&mut self, water: usize, touched: &[u8]) -> Vec<u32> {
        self.fluid_slots = vec![0; water];
        let mut wet = Vec::new();
        for slab in &self.slabs {
            for slot in slab.first * LANES..slab.middle * LANES {
                if self.source[slot] != PAD {
                    self.fluid_slots[self.source[slot] as usize] = slot as u32;
                }
            }
            for slot in slab.middle * LANES..slab.end * LANES {
                if touched[slot / LANES] >> (slot % LANES) & 1 == 1 {
                    wet.push((self.source[slot], slot as u32));
                }
            }
        }
        wet.par_sort_unstable();
        self.boundary_slots = wet.iter().map(|w| w.1).collect();
        wet.into_iter().map(|w| w.0).collect()
    }
}

/// The positions of a cluster in integer units, pads far away.
#[inline(always)]
pub(crate) fn fill_positions<const D: usize>(
    x: &mut [[i32; LANES]; D],
    source: &[u32],
    r: &[Vector<D>],
    inv_unit: f64,
) {
    let n = occupied_lanes(source);
    for (l, &i) in source[..n].iter().enumerate() {
        for (x, r) in x.iter_mut().zip(r[i as usize].iter()) {
            x[l] = to_integer(*r, inv_unit);
        }
    }
    for x in x {
        let away = x[0].wrapping_add(FAR_POSITION);
        x[n..].fill(away);
    }
}

/// How many lanes of a cluster hold a particle: the first ones.
#[inline(always)]
pub(crate) fn occupied_lanes(source: &[u32]) -> usize {
    if source[LANES - 1] == PAD { source.iter().take_while(|&&i| i != PAD).count() } else { LANES }
}

/// Cuts a column's particles into clusters.
fn cut<const D: usize>(
    particles: &[u32],
    r: &[Vector<D>],
    up: usize,
    span: f64,
    column: u32,
    source: &mut Vec<u32>,
    extents: &mut Vec<ClusterExtent<D>>,
) {
    let height = |i: u32| r[i as usize][up];
    for these in runs(particles, r, up, span) {
        source.extend(these);
        source.extend(std::iter::repeat_n(PAD, LANES - these.len()));
        let low = height(these[0]);
        let high = these.iter().map(|&i| height(i)).fold(low, f64::max);
        let low = these.iter().map(|&i| height(i)).fold(low, f64::min);
        extents.push(ClusterExtent { column, low, high, centre: [0; D], half: [0.0; D] });
    }
}

/// The particles of a column in runs of at most a cluster, none higher than `span` (m).
fn runs<'a, const D: usize>(
    particles: &'a [u32],
    r: &'a [Vector<D>],
    up: usize,
    span: f64,
) -> impl Iterator<Item = &'a [u32]> {
    let (height, mut rest) = (move |i: u32| r[i as usize][up], particles);
    std::iter::from_fn(move || {
        let low = height(*rest.first()?);
        let n = 1 + rest[1..].iter().take(LANES - 1).take_while(|&&i| height(i) - low <= span).count();
        let (these, others) = rest.split_at(n);
        rest = others;
        Some(these)
    })
}
