//! The search for pairs of a particle and a later cluster, eight particles at a time.

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

/// Data that all slabs share in a search.
struct Search<'a, const D: usize> {
    columns: &'a Columns<D>,
    bounds: &'a [[usize; 3]],
    source: &'a [u32],
    x: &'a [[[i32; LANES]; D]],
    extents: &'a [ClusterExtent<D>],
    ranges: &'a [Ranges; 2],
    reach: f64,
    /// Square of the reach in units, with room for rounding.
    reach2: f32,
}

/// Fills the lists of all slabs; returns for each cluster which of its lanes have a pair.
#[allow(clippy::too_many_arguments, reason = "one caller; a struct would be filled and emptied again")]
pub(super) fn fill_lists<const D: usize>(
    columns: &Columns<D>,
    slabs: &mut [Slab],
    source: &[u32],
    x: &[[[i32; LANES]; D]],
    extents: &[ClusterExtent<D>],
    ranges: &[Ranges; 2],
    sizes: &SearchSizes,
    level: Level,
) -> Vec<u8> {
    let bounds: Vec<[usize; 3]> = slabs.iter().map(|s| [s.first, s.middle, s.end]).collect();
    let reach2 = (sizes.reach * sizes.inv_unit * (1.0 + 1e-6)).powi(2) as f32;
    let search = Search { columns, bounds: &bounds, source, x, extents, ranges, reach: sizes.reach, reach2 };
    let parts: Vec<Vec<u8>> = slabs
        .par_iter_mut()
        .enumerate()
        .with_max_len(1)
        .map(|(s, slab)| simd::dispatch(level, OfSlab { search: &search, s, slab }))
        .collect();
    // A slab's part covers itself and the next.
    let mut touched = vec![0; x.len()];
    for (part, [first, ..]) in parts.iter().zip(&bounds) {
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
                let (start, pad) = (used, search.source[c * LANES + l] == PAD);
                let most = used + later.len() + 1;
                if slab.index.len() < most {
                    // Lists are the larger part of the memory: an eighth to spare, not as much again.
                    slab.index.reserve_exact(most + most / 8 - slab.index.len());
                    slab.index.resize(most + most / 8, 0);
                }
                let at: [i32x8<S>; D] = std::array::from_fn(|k| i32x8::splat(simd, search.x[c][k][l]));
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
        let own = self.extents[c].column as usize;
        let is_water = c < self.bounds[s][1];
        for column in self.columns.neighbouring_columns(own) {
            let fits = if is_water { column >= own } else { self.columns.slab_of_column(column) > s };
            if fits {
                self.column(c, &self.ranges[0][column], later);
            }
        }
        let middle = later.len();
        if is_water {
            for column in
                self.columns.neighbouring_columns(own).filter(|&column| self.columns.slab_of_column(column) >= s)
            {
                self.column(c, &self.ranges[1][column], later);
            }
        }
        middle
    }

    /// Appends those of the clusters `range` of a column that come after `c` and whose box is near its box.
    #[inline(always)]
    fn column(&self, c: usize, range: &std::ops::Range<u32>, later: &mut Vec<u32>) {
        let me = &self.extents[c];
        let these = &self.extents[range.start as usize..range.end as usize];
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

    /// Writes to `list` those of `clusters`, counted from `base`, that have a particle within reach of `at`, and says to `note`
    /// which lanes; returns how many.
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
            let x = &self.x[j as usize];
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
