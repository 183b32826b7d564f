//! The search for pairs of a particle and a later cluster, eight particles at a time.

use std::ops::Range;

use rayon::prelude::*;

use fearless_simd::{SimdBase, SimdCvtFloat, SimdMask};

use super::{
    clusters::{ClusterExtent, PAD, PART, Ranges, Slab},
    columns::Columns,
};
use crate::math::simd::{self, LANES, Level, Simd, SimdTask, f32x8, i32x8};

/// The sizes that a search needs.
pub(super) struct SearchSizes {
    /// Search radius of the lists, m.
    pub(super) reach: f64,
    /// Width of a column, m.
    pub(super) width: f64,
    /// Whole units in a metre.
    pub(super) inv_unit: f64,
}

/// What a search reads.
pub(super) struct SearchInput<'a, const D: usize> {
    pub(super) columns: &'a Columns<D>,
    /// The particle in each slot.
    pub(super) source: &'a [u32],
    /// The positions of each cluster in units.
    pub(super) x: &'a [[[i32; LANES]; D]],
    /// The first cluster that has an extent, and the extents from there on.
    pub(super) extents: (usize, &'a [ClusterExtent<D>]),
    /// The clusters of water and of boundary particles in each column.
    pub(super) ranges: &'a [Ranges; 2],
}

/// Data that all slabs share in a search.
struct Search<'a, const D: usize> {
    given: SearchInput<'a, D>,
    bounds: &'a [[usize; 3]],
    reach: f64,
    /// Square of the reach in units, with room for rounding.
    reach2: f32,
}

/// Fills the lists of the slabs `own` and empties those of the others; returns for each cluster which of its lanes have a pair.
pub(super) fn fill_lists<const D: usize>(
    given: SearchInput<'_, D>,
    slabs: &mut [Slab],
    own: Range<usize>,
    sizes: &SearchSizes,
    level: Level,
) -> Vec<u8> {
    let bounds: Vec<[usize; 3]> = slabs.iter().map(|s| [s.first, s.middle, s.end]).collect();
    let reach2 = (sizes.reach * sizes.inv_unit * (1.0 + 1e-6)).powi(2) as f32;
    let search = Search { given, bounds: &bounds, reach: sizes.reach, reach2 };
    for (s, slab) in slabs.iter_mut().enumerate().filter(|(s, _)| !own.contains(s)) {
        let [first, middle, end] = bounds[s];
        *slab = Slab { first, middle, end, ..Slab::default() };
    }
    let parts: Vec<Vec<u8>> = slabs[own.clone()]
        .par_iter_mut()
        .enumerate()
        .with_max_len(1)
        .map(|(k, slab)| simd::dispatch(level, OfSlab { search: &search, s: own.start + k, slab }))
        .collect();
    // A slab's part covers itself and the next.
    let mut touched = vec![0; search.given.x.len()];
    for (part, [first, ..]) in parts.iter().zip(&bounds[own]) {
        touched[*first..].iter_mut().zip(part).for_each(|(all, one)| *all |= one);
    }
    touched
}

/// The search of one slab.
struct OfSlab<'a, 'b, const D: usize> {
    search: &'a Search<'b, D>,
    s: usize,
    slab: &'a mut Slab,
}

impl<const D: usize> SimdTask for OfSlab<'_, '_, D> {
    type Output = Vec<u8>;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> Vec<u8> {
        let Self { search, s, slab } = self;
        let [first, middle_of_slab, end] = search.bounds[s];
        let last = search.bounds.get(s + 1).map_or(end, |next| next[2]);
        let mut touched = vec![0u8; last - first];
        let (mut later, mut used) = (Vec::new(), 0);
        slab.spans.clear();
        slab.parts = (last - first).div_ceil(PART).max(1);
        for c in first..end {
            later.clear();
            let middle = search.candidates(s, c, &mut later);
            let kinds = [&later[..middle], &later[middle..]];
            for l in 0..LANES {
                let (start, pad) = (used, search.given.source[c * LANES + l] == PAD);
                let most = used + later.len() + 1;
                if slab.index.len() < most {
                    // Lists are the larger part of the memory: an eighth to spare, not as much again.
                    slab.index.reserve_exact(most + most / 8 - slab.index.len());
                    slab.index.resize(most + most / 8, 0);
                }
                let at: [i32x8<S>; D] = std::array::from_fn(|k| i32x8::splat(simd, search.given.x[c][k][l]));
                for base in (0..slab.parts).map(|part| first + part * PART) {
                    let [water, skin] = kinds.map(|clusters| if pad { &[][..] } else { part_from(base, clusters) });
                    let begin = used;
                    if !pad && c < middle_of_slab && (base..base + PART).contains(&c) {
                        slab.index[used] = (c - base) as u16;
                        used += 1;
                    }
                    used += search.meet(simd, &at, base, water, &mut slab.index[used..], |_, _| {});
                    slab.spans.push([begin as u32, used as u32]);
                    used += search.meet(simd, &at, base, skin, &mut slab.index[used..], |j, lanes| {
                        touched[j as usize - first] |= lanes;
                    });
                }
                touched[c - first] |= u8::from(used > start) << l;
            }
        }
        slab.spans.push([used as u32; 2]);
        slab.index.truncate(used);
        touched
    }
}

/// Those of the ascending `clusters` that entries of the part from cluster `base` on can number.
#[inline(always)]
fn part_from(base: usize, clusters: &[u32]) -> &[u32] {
    let within = |clusters: &[u32]| clusters.last().is_none_or(|&j| (j as usize) < base + PART);
    if clusters.first().is_none_or(|&j| j as usize >= base) && within(clusters) {
        return clusters;
    }
    let start = clusters.partition_point(|&j| (j as usize) < base);
    &clusters[start..clusters.partition_point(|&j| (j as usize) < base + PART)]
}

impl<const D: usize> Search<'_, D> {
    /// Appends the later clusters that cluster `c` of slab `s` may have pairs with, water first; returns how many of
    /// them are water.
    fn candidates(&self, s: usize, c: usize, later: &mut Vec<u32>) -> usize {
        let (first, extents) = self.given.extents;
        let own = extents[c - first].column as usize;
        let is_water = c < self.bounds[s][1];
        for column in self.given.columns.neighbouring_columns(own) {
            let fits = if is_water { column >= own } else { self.given.columns.slab_of_column(column) > s };
            if fits {
                self.column(c, &self.given.ranges[0][column], later);
            }
        }
        let middle = later.len();
        if is_water {
            for column in self
                .given
                .columns
                .neighbouring_columns(own)
                .filter(|&column| self.given.columns.slab_of_column(column) >= s)
            {
                self.column(c, &self.given.ranges[1][column], later);
            }
        }
        middle
    }

    /// Appends those of the clusters `range` of a column that come after `c` and whose box is near its box.
    #[inline(always)]
    fn column(&self, c: usize, range: &Range<u32>, later: &mut Vec<u32>) {
        let (first, extents) = self.given.extents;
        let me = &extents[c - first];
        let these = &extents[range.start as usize - first..range.end as usize - first];
        let skip = these.partition_point(|e| e.high < me.low - self.reach);
        for (k, e) in these.iter().enumerate().skip(skip) {
            if e.low > me.high + self.reach {
                break;
            }
            let mut gap2 = 0.0;
            for i in 0..D {
                let apart = me.centre[i].wrapping_sub(e.centre[i]) as f32;
                let gap = (apart.abs() - (me.half[i] + e.half[i])).max(0.0);
                gap2 += gap * gap;
            }
            let j = range.start + k as u32;
            if gap2 < self.reach2 && j as usize > c {
                later.push(j);
            }
        }
    }

    /// Writes to `list` those of `clusters`, counted from `base`, that have a particle within reach of `at`, and passes the lanes
    /// of such particles to `note`. Returns the number of these clusters.
    #[inline(always)]
    fn meet<S: Simd>(
        &self,
        simd: S,
        at: &[i32x8<S>; D],
        base: usize,
        clusters: &[u32],
        list: &mut [u16],
        mut note: impl FnMut(u32, u8),
    ) -> usize {
        let reach2 = f32x8::splat(simd, self.reach2);
        let mut met = 0;
        for &j in clusters {
            let x = &self.given.x[j as usize];
            let mut r2 = f32x8::splat(simd, 0.0);
            for k in 0..D {
                let d: f32x8<S> = f32x8::float_from(at[k] - simd::load_integers(simd, &x[k]));
                r2 += d * d;
            }
            let near = r2.simd_lt(reach2).to_bitmask() as u8;
            list[met] = (j as usize - base) as u16;
            met += usize::from(near != 0);
            note(j, near);
        }
        met
    }
}
