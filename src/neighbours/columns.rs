//! Columns two particles wide, grouped into slabs at least as thick as the search radius, and particles sorted into
//! them.
//!
//! Slabs follow one another along the longest axis of the water, columns stand along the second longest. A
//! particle then finds its neighbours in its own slab and the two beside it, and a thread takes whole slabs.

use rayon::prelude::*;

use crate::{
    math::{Bounds, Vector},
    particles::PARTICLES_PER_TASK,
};

/// Most columns per particle: where particles lie far apart the columns are made wider.
const COLUMNS_PER_PARTICLE: f64 = 4.0;

/// The division of space into columns.
#[derive(Clone, Debug)]
pub(crate) struct Columns<const D: usize> {
    /// Around the water.
    pub(super) bounds: Bounds<D>,
    /// Around all places within reach of the water.
    around: Bounds<D>,
    inv_width: f64,
    /// Axis along which slabs follow one another.
    along: usize,
    /// Axis across; in 2-D there is none, and one column across.
    across: usize,
    /// Axis along which a column's particles are sorted.
    pub(super) up: usize,
    /// Columns along and across.
    count: [usize; 2],
    /// How many columns away, along and across, a neighbour may be; also the thickness of a slab.
    pub(super) ring: usize,
    /// Height at which the sort key is 0, m: as low as a neighbour may be.
    lowest: f64,
    /// Steps of the sort key in a metre.
    fine: f64,
}

/// Particles sorted by column and, within, by height.
#[derive(Clone, Debug, Default)]
pub(super) struct Sorted {
    /// Indices.
    pub(super) order: Vec<u32>,
    /// First entry of each column in `order`, and the end.
    pub(super) start: Vec<u32>,
}

impl<const D: usize> Columns<D> {
    /// Divides the space of `count` particles within `bounds` (m) into columns at least `width` (m) wide, for neighbours
    /// within `reach` (m).
    pub(super) fn new(bounds: Bounds<D>, count: usize, width: f64, reach: f64) -> Self {
        let bounds = if count == 0 { Bounds { min: Vector::zeros(), max: Vector::zeros() } } else { bounds };
        let size = bounds.size();
        let mut axes: Vec<usize> = (0..D).collect();
        axes.sort_by(|&a, &b| size[b].total_cmp(&size[a]));
        let (along, up, across) = (axes[0], axes[1], axes[D - 1]);
        let wanted = |axis: usize, width: f64| (size[axis] / width).floor() + 1.0;
        let cross = |width: f64| if D == 2 { 1.0 } else { wanted(across, width) };
        let mut width = width;
        while wanted(along, width) * cross(width) > 1000.0 + COLUMNS_PER_PARTICLE * count as f64 {
            width *= 2.0;
        }
        Self {
            around: bounds.grown(reach),
            inv_width: 1.0 / width,
            along,
            across,
            up,
            count: [wanted(along, width) as usize, cross(width) as usize],
            ring: (reach / width).ceil().max(1.0) as usize,
            lowest: bounds.min[up] - reach,
            fine: u32::MAX as f64 / (size[up] + 2.0 * reach),
            bounds,
        }
    }

    /// Number of columns.
    pub(super) fn len(&self) -> usize {
        self.count[0] * self.count[1]
    }

    /// Number of slabs.
    pub(super) fn slab_count(&self) -> usize {
        self.count[0].div_ceil(self.ring)
    }

    /// The slab of a column.
    pub(super) fn slab_of_column(&self, column: usize) -> usize {
        column / (self.count[1] * self.ring)
    }

    /// The slab of the place `x` (m).
    pub(crate) fn slab_at(&self, x: &Vector<D>) -> usize {
        self.slab_of_column(self.column_at(x))
    }

    /// The columns of a slab.
    pub(super) fn columns_of_slab(&self, slab: usize) -> std::ops::Range<usize> {
        let columns = self.count[1] * self.ring;
        slab * columns..((slab + 1) * columns).min(self.len())
    }

    /// The columns in which a particle of `column` may have neighbours, in order.
    pub(super) fn neighbouring_columns(&self, column: usize) -> impl Iterator<Item = usize> + use<D> {
        let [along, across] = self.count;
        let (i, j, ring) = (column / across, column % across, self.ring);
        let rows = i.saturating_sub(ring)..=(i + ring).min(along - 1);
        rows.flat_map(move |i| (j.saturating_sub(ring)..=(j + ring).min(across - 1)).map(move |j| i * across + j))
    }

    /// The column that a place is in, or the nearest.
    pub(super) fn column_at(&self, x: &Vector<D>) -> usize {
        let place =
            |axis: usize, count: usize| (((x[axis] - self.bounds.min[axis]) * self.inv_width) as usize).min(count - 1);
        let across = if D == 2 { 0 } else { place(self.across, self.count[1]) };
        place(self.along, self.count[0]) * self.count[1] + across
    }

    /// Sorts the particles `which` of those at `r` (m) by column, height and index.
    pub(super) fn sort(&self, r: &[Vector<D>], which: &[u32]) -> Sorted {
        let columns: Vec<u32> =
            which.par_iter().with_min_len(PARTICLES_PER_TASK).map(|&i| self.column_at(&r[i as usize]) as u32).collect();
        let mut start = vec![0u32; self.len() + 1];
        for &c in &columns {
            start[c as usize + 1] += 1;
        }
        for c in 1..start.len() {
            start[c] += start[c - 1];
        }
        let mut next = start.clone();
        let mut keys = vec![0u64; which.len()];
        for (&i, &c) in which.iter().zip(&columns) {
            let height = ((r[i as usize][self.up] - self.lowest) * self.fine) as u32;
            keys[next[c as usize] as usize] = (u64::from(height) << 32) | u64::from(i);
            next[c as usize] += 1;
        }
        let mut rest = keys.as_mut_slice();
        let mut slabs = Vec::with_capacity(self.slab_count());
        for slab in 0..self.slab_count() {
            let of = self.columns_of_slab(slab);
            let (these, others) = rest.split_at_mut((start[of.end] - start[of.start]) as usize);
            slabs.push((of, these));
            rest = others;
        }
        slabs.into_par_iter().for_each(|(of, keys)| {
            let first = start[of.start];
            for c in of {
                keys[(start[c] - first) as usize..(start[c + 1] - first) as usize].sort_unstable();
            }
        });
        Sorted { order: keys.into_par_iter().with_min_len(PARTICLES_PER_TASK).map(|key| key as u32).collect(), start }
    }

    /// Returns the indices of the places `skin` (m) that may be within reach of the water, in ascending order. `heights` are
    /// those of [`Self::heights`].
    pub(super) fn near_fluid(&self, heights: &[Option<(f64, f64)>], skin: &[Vector<D>]) -> Vec<u32> {
        let around = |c: usize| {
            let heights = self.neighbouring_columns(c).filter_map(|c| heights[c]);
            heights.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
        };
        let heights: Vec<Option<(f64, f64)>> = (0..self.len()).map(around).collect();
        let may = |x: &Vector<D>| {
            let within = |(low, high)| low <= x[self.up] && x[self.up] <= high;
            self.around.contains(x) && heights[self.column_at(x)].is_some_and(within)
        };
        (0..skin.len() as u32)
            .into_par_iter()
            .with_min_len(PARTICLES_PER_TASK)
            .filter(|&i| may(&skin[i as usize]))
            .collect()
    }

    /// For each column, the lowest and the highest height (m) of places that may lie within `reach` (m) of its sorted water;
    /// `None` for a column without water.
    pub(super) fn heights(&self, r: &[Vector<D>], sorted: &Sorted, reach: f64) -> Vec<Option<(f64, f64)>> {
        let height = |k: u32| r[sorted.order[k as usize] as usize][self.up];
        let of = |c: usize| {
            let (from, to) = (sorted.start[c], sorted.start[c + 1]);
            (from < to).then(|| (height(from) - reach, height(to - 1) + reach))
        };
        (0..self.len()).map(of).collect()
    }
}
