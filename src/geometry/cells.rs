//! Search for the points near a position, on a grid of cells that the code fills once.

#[cfg(feature = "gpu")]
use std::collections::BTreeMap;
use std::ops::Range;

use rayon::prelude::*;

use crate::{
    math::{Bounds, Vector},
    particles::PARTICLES_PER_TASK,
};

/// Points sorted into cubic cells.
pub(crate) struct PointCells<const D: usize> {
    min: Vector<D>,
    size: f64,
    count: [usize; D],
    /// Start index of each cell's points in `order`.
    start: Vec<u32>,
    order: Vec<u32>,
    /// Coordinates of the points in the sequence of `order`, axis by axis.
    along: [Vec<f64>; D],
}

impl<const D: usize> PointCells<D> {
    /// Returns a grid over `points`, with cells at least `size` (m) wide.
    pub(crate) fn new(points: &[Vector<D>], size: f64) -> Self {
        let bounds = Bounds::around(points);
        let along = std::array::from_fn(|_| Vec::new());
        let mut grid = Self { min: bounds.min, size, count: [0; D], start: vec![0], order: Vec::new(), along };
        if points.is_empty() {
            return grid;
        }
        let cells = |size: f64| bounds.size().map(|s| (s / size).floor() + 1.0);
        // If few points occupy a large space, the grid uses wider cells instead of many empty cells.
        while cells(grid.size).product() > 4.0 * points.len() as f64 + 64.0 {
            grid.size *= 1.5;
        }
        grid.count = cells(grid.size).map(|n| n as usize).into();
        let home = |x: &Vector<D>| grid.index(&grid.place(x).map(|c| c as usize)) as u32;
        let home: Vec<u32> = points.par_iter().with_min_len(PARTICLES_PER_TASK).map(home).collect();
        grid.start = vec![0; grid.count.iter().product::<usize>() + 1];
        home.iter().for_each(|&c| grid.start[c as usize + 1] += 1);
        for c in 1..grid.start.len() {
            grid.start[c] += grid.start[c - 1];
        }
        let mut next = grid.start.clone();
        grid.order = vec![0; points.len()];
        for (i, &c) in home.iter().enumerate() {
            let place = &mut next[c as usize];
            grid.order[*place as usize] = i as u32;
            *place += 1;
        }
        let sorted = |axis: usize| {
            grid.order.par_iter().with_min_len(PARTICLES_PER_TASK).map(move |&i| points[i as usize][axis])
        };
        grid.along = std::array::from_fn(|axis| sorted(axis).collect());
        grid
    }

    fn place(&self, x: &Vector<D>) -> [isize; D] {
        std::array::from_fn(|i| ((x[i] - self.min[i]) / self.size).floor() as isize)
    }

    /// Returns the index of a cell. The first axis varies fastest, so that neighbours along it are adjacent in memory.
    fn index(&self, place: &[usize; D]) -> usize {
        (0..D).rev().fold(0, |sum, i| sum * self.count[i] + place[i])
    }

    /// Visits every point within `distance` (m) of `x`, and some points beyond, in an order that depends only on the
    /// points.
    pub(crate) fn visit_near(&self, x: &Vector<D>, distance: f64, mut visit: impl FnMut(usize, &Vector<D>)) {
        self.rows_near(x, distance, |places| {
            let at = |k| Vector::from_fn(|axis, _| self.along[axis][k]);
            places.for_each(|k| visit(self.order[k] as usize, &at(k)));
        });
    }

    /// Appends to `found` every point nearer than `distance` (m) to `x`, in an order that depends only on the points.
    /// `r2` is scratch memory.
    pub(crate) fn append_within(&self, x: &Vector<D>, distance: f64, r2: &mut Vec<f64>, found: &mut Vec<u32>) {
        let mut n = found.len();
        self.rows_near(x, distance, |places| {
            r2.clear();
            r2.resize(places.len(), 0.0);
            for (x, along) in x.iter().zip(&self.along) {
                r2.iter_mut().zip(&along[places.clone()]).for_each(|(r2, y)| *r2 += (x - y) * (x - y));
            }
            found.resize(n + places.len(), 0);
            // Only a few in a dozen points are near enough, so the loop has no branch, which the processor would
            // mispredict.
            for (&i, &r2) in self.order[places].iter().zip(&*r2) {
                found[n] = i;
                n += usize::from(r2 < distance * distance);
            }
        });
        found.truncate(n);
    }

    /// Returns a box around the points in each cube of edge `size` (m) that has any.
    #[cfg(feature = "gpu")]
    pub(crate) fn boxes(&self, size: f64) -> Vec<Bounds<D>> {
        let mut boxes = BTreeMap::<[i64; D], Bounds<D>>::new();
        for k in 0..self.order.len() {
            let x = Vector::from_fn(|axis, _| self.along[axis][k]);
            let cube = std::array::from_fn(|axis| ((x[axis] - self.min[axis]) / size).floor() as i64);
            let own = boxes.entry(cube).or_insert_with(Bounds::empty);
            *own = own.union(&Bounds::around([&x]));
        }
        boxes.into_values().collect()
    }

    /// Visits ranges of indices in `order`, each with the points of a row of cells.
    fn rows_near(&self, x: &Vector<D>, distance: f64, mut visit: impl FnMut(Range<usize>)) {
        if self.order.is_empty() {
            return;
        }
        let low: [isize; D] = self.place(&x.add_scalar(-distance)).map(|c| c.max(0));
        let high = self.place(&x.add_scalar(distance));
        let high: [isize; D] = std::array::from_fn(|i| high[i].min(self.count[i] as isize - 1));
        if (0..D).any(|i| low[i] > high[i]) {
            return;
        }
        let mut row = low.map(|c| c as usize);
        loop {
            let first = self.index(&row);
            let last = first + (high[0] - low[0]) as usize;
            let places = self.start[first] as usize..self.start[last + 1] as usize;
            if !places.is_empty() {
                visit(places);
            }
            // Advance to the next row by incrementing the axes after the first.
            let Some(axis) = (1..D).find(|&i| (row[i] as isize) < high[i]) else { return };
            row[axis] += 1;
            (1..axis).for_each(|i| row[i] = low[i] as usize);
        }
    }
}

/// Returns for each point whether it is at least `distance` (m) from every earlier point with a true flag. The first
/// `given` points always have a true flag.
pub(super) fn spacing_flags<const D: usize>(points: &[Vector<D>], given: usize, distance: f64) -> Vec<bool> {
    let cells = PointCells::new(points, distance);
    let mut kept = vec![false; points.len()];
    for (i, x) in points.iter().enumerate() {
        let mut free = true;
        cells.visit_near(x, distance, |j, y| free &= !(kept[j] && (x - y).norm_squared() < distance * distance));
        kept[i] = i < given || free;
    }
    kept
}
