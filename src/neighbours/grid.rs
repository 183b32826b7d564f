//! Particles sorted into the cells of a grid.

use crate::math::{Bounds, Vector};

/// Most cells per particle: where particles lie far apart the cells are made larger.
const CELLS_PER_PARTICLE: f64 = 64.0;

/// Indices of particles by cell; the cells of a row along axis 0 follow one another.
#[derive(Clone, Debug)]
pub(crate) struct CellGrid<const D: usize> {
    min: Vector<D>,
    inv_cell: f64,
    cells: [usize; D],
    /// First entry of each cell in `order`, and the end.
    start: Vec<u32>,
    order: Vec<u32>,
}

impl<const D: usize> Default for CellGrid<D> {
    fn default() -> Self {
        Self { min: Vector::zeros(), inv_cell: 1.0, cells: [0; D], start: vec![0], order: Vec::new() }
    }
}

impl<const D: usize> CellGrid<D> {
    /// Sorts the finite positions `r` (m) into cells at least `cell` (m) wide; within a cell the order of `r` stays.
    pub(crate) fn new(r: &[Vector<D>], cell: f64) -> Self {
        if r.is_empty() {
            return Self::default();
        }
        Self::of_part(r, (Bounds::around(r), r.len()), cell)
    }

    /// As [`CellGrid::new`] for a part `r` of `count` positions within `bounds` (m), in the cells of all of these.
    pub(super) fn of_part(r: &[Vector<D>], (bounds, count): (Bounds<D>, usize), cell: f64) -> Self {
        if r.is_empty() {
            return Self::default();
        }
        let size = bounds.size();
        let wanted = |cell: f64| (0..D).map(|i| (size[i] / cell).floor() + 1.0).product::<f64>();
        let mut cell = cell;
        while wanted(cell) > 1000.0 + CELLS_PER_PARTICLE * count as f64 {
            cell *= 2.0;
        }
        let cells = std::array::from_fn(|i| (size[i] / cell).floor() as usize + 1);
        let mut grid = Self { min: bounds.min, inv_cell: 1.0 / cell, cells, start: Vec::new(), order: Vec::new() };
        let cell_of = |x: &Vector<D>| grid.index(&grid.cell(x));
        let mut start = vec![0u32; cells.iter().product::<usize>() + 1];
        for x in r {
            start[cell_of(x) + 1] += 1;
        }
        for c in 1..start.len() {
            start[c] += start[c - 1];
        }
        let mut next = start.clone();
        let mut order = vec![0u32; r.len()];
        for (i, x) in r.iter().enumerate() {
            let place = &mut next[cell_of(x)];
            order[*place as usize] = i as u32;
            *place += 1;
        }
        (grid.start, grid.order) = (start, order);
        grid
    }

    /// Calls `visit` with the particles of each row of cells that meets `bounds`.
    #[inline]
    pub(crate) fn visit_rows<'a>(&'a self, bounds: &Bounds<D>, mut visit: impl FnMut(&'a [u32])) {
        if self.order.is_empty() {
            return;
        }
        let (mut low, mut high) = ([0usize; D], [0usize; D]);
        for i in 0..D {
            let from = ((bounds.min[i] - self.min[i]) * self.inv_cell).floor();
            let to = ((bounds.max[i] - self.min[i]) * self.inv_cell).floor();
            if !(to >= 0.0 && from < self.cells[i] as f64) {
                return;
            }
            low[i] = from.max(0.0) as usize;
            high[i] = (to as usize).min(self.cells[i] - 1);
        }
        let mut at = low;
        loop {
            let row = self.index(&at);
            let (from, to) = (self.start[row] as usize, self.start[row + high[0] - low[0] + 1] as usize);
            if from < to {
                visit(&self.order[from..to]);
            }
            // The next row: count up axes 1, 2, … like an odometer.
            let Some(axis) = (1..D).find(|&i| at[i] < high[i]) else { return };
            at[1..axis].copy_from_slice(&low[1..axis]);
            at[axis] += 1;
        }
    }

    fn cell(&self, x: &Vector<D>) -> [usize; D] {
        std::array::from_fn(|i| (((x[i] - self.min[i]) * self.inv_cell) as usize).min(self.cells[i] - 1))
    }

    fn index(&self, at: &[usize; D]) -> usize {
        (0..D).rev().fold(0, |index, i| index * self.cells[i] + at[i])
    }
}

#[cfg(test)]
#[path = "../../tests/unit/neighbours/grid.rs"]
mod tests;
