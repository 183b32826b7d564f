//! Which points lie near a place: a grid of cells, filled once.

use crate::space::{Bounds, Vector};

/// Points sorted into cubic cells.
pub(super) struct Cells<const D: usize> {
    min: Vector<D>,
    size: f64,
    count: [usize; D],
    /// Where each cell's points start in `order`.
    start: Vec<usize>,
    order: Vec<usize>,
    /// The points in that order, side by side in memory.
    points: Vec<Vector<D>>,
}

impl<const D: usize> Cells<D> {
    /// A grid over `points` in which everything within `reach` (m) of a place lies in the cells around it.
    pub fn new(points: &[Vector<D>], reach: f64) -> Self {
        let bounds = Bounds::around(points);
        let mut grid =
            Self { min: bounds.min, size: reach, count: [0; D], start: vec![0], order: Vec::new(), points: Vec::new() };
        if points.is_empty() {
            return grid;
        }
        let cells = |size: f64| bounds.size().map(|s| (s / size).floor() + 1.0);
        // Few points in much space: wider cells rather than many empty ones.
        while cells(grid.size).product() > 4.0 * points.len() as f64 + 64.0 {
            grid.size *= 1.5;
        }
        grid.count = cells(grid.size).map(|n| n as usize).into();
        let home: Vec<usize> = points.iter().map(|x| grid.index(&grid.place(x).map(|c| c as usize))).collect();
        grid.start = vec![0; grid.count.iter().product::<usize>() + 1];
        home.iter().for_each(|&c| grid.start[c + 1] += 1);
        for c in 1..grid.start.len() {
            grid.start[c] += grid.start[c - 1];
        }
        let mut next = grid.start.clone();
        grid.order = vec![0; points.len()];
        for (i, &c) in home.iter().enumerate() {
            grid.order[next[c]] = i;
            next[c] += 1;
        }
        grid.points = grid.order.iter().map(|&i| points[i]).collect();
        grid
    }

    fn place(&self, x: &Vector<D>) -> [isize; D] {
        std::array::from_fn(|i| ((x[i] - self.min[i]) / self.size).floor() as isize)
    }

    /// The first axis runs fastest, so that neighbours along it lie side by side.
    fn index(&self, place: &[usize; D]) -> usize {
        (0..D).rev().fold(0, |sum, i| sum * self.count[i] + place[i])
    }

    /// Visits every point within the reach of `x`, and some farther ones, in an order fixed by the points.
    pub fn near(&self, x: &Vector<D>, mut visit: impl FnMut(usize, &Vector<D>)) {
        if self.order.is_empty() {
            return;
        }
        let place = self.place(x);
        let low: [isize; D] = place.map(|c| c.saturating_sub(1).max(0));
        let high: [isize; D] = std::array::from_fn(|i| place[i].saturating_add(1).min(self.count[i] as isize - 1));
        if (0..D).any(|i| low[i] > high[i]) {
            return;
        }
        let mut row = low.map(|c| c as usize);
        loop {
            let first = self.index(&row);
            let last = first + (high[0] - low[0]) as usize;
            let run = self.start[first]..self.start[last + 1];
            self.order[run.clone()].iter().zip(&self.points[run]).for_each(|(&i, y)| visit(i, y));
            // The next row: count up the axes after the first.
            let Some(axis) = (1..D).find(|&i| (row[i] as isize) < high[i]) else { return };
            row[axis] += 1;
            (1..axis).for_each(|i| row[i] = low[i] as usize);
        }
    }
}

/// The points that keep `distance` (m) from every earlier point that was kept, as flags.
pub(super) fn spaced<const D: usize>(points: &[Vector<D>], distance: f64) -> Vec<bool> {
    let cells = Cells::new(points, distance);
    let mut kept = vec![false; points.len()];
    for (i, x) in points.iter().enumerate() {
        let mut free = true;
        cells.near(x, |j, y| free &= !(kept[j] && (x - y).norm_squared() < distance * distance));
        kept[i] = free;
    }
    kept
}
