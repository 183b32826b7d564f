//! Neighbours: positions in, indices out.
//!
//! A cell grid finds, for each water particle, the water and the boundary particles within the kernel's
//! support and a margin; and for each boundary particle the water. The lists hold while nothing has moved by
//! half the margin, so most steps search nothing.

mod grid;
mod lists;

pub use grid::Grid;
pub use lists::{CHUNK, Chunk, Lists, Span};

use rayon::prelude::*;

use crate::{
    particles::PER_TASK,
    space::{Bounds, Vector},
};

/// Neighbour lists of the water and of the skin, and the positions for which they were made.
#[derive(Clone, Debug)]
pub struct Near<const D: usize> {
    /// Kernel support, m.
    reach: f64,
    /// How far beyond the support the lists look, m.
    margin: f64,
    water: Grid<D>,
    skin: Grid<D>,
    lists: Lists,
    /// Positions of water and skin at the last build, m.
    built: (Vec<Vector<D>>, Vec<Vector<D>>),
}

impl<const D: usize> Near<D> {
    /// No lists yet, for a kernel of support `reach` (m).
    pub fn new(reach: f64) -> Self {
        // A tenth of the support: a rebuild every ten steps or so, for a fifth more candidates.
        Self {
            reach,
            margin: 0.1 * reach,
            water: Grid::default(),
            skin: Grid::default(),
            lists: Lists::default(),
            built: (Vec::new(), Vec::new()),
        }
    }

    /// Whether something has moved so far that a pair may be missing. Numbers differ after adding or
    /// removing particles: due too. A non-finite position is due as well.
    pub fn due(&self, water: &[Vector<D>], skin: &[Vector<D>]) -> bool {
        if self.built.0.len() != water.len() || self.built.1.len() != skin.len() {
            return true;
        }
        let far = |now: &[Vector<D>], then: &[Vector<D>]| {
            now.par_iter()
                .zip(then)
                .with_min_len(PER_TASK)
                .map(|(a, b)| (a - b).norm_squared())
                // The larger of two, and NaN if either is.
                .reduce(|| 0.0, |a, b| if a.is_nan() || a > b { a } else { b })
                .sqrt()
        };
        let moved = far(water, &self.built.0) + far(skin, &self.built.1);
        moved.is_nan() || moved >= self.margin
    }

    /// The order in which water at `r` lies along the cells: `order[new] = old`.
    pub fn order(&self, r: &[Vector<D>]) -> Vec<u32> {
        Grid::new(r, self.reach + self.margin).into_order()
    }

    /// Makes the lists for these positions.
    pub fn build(&mut self, water: &[Vector<D>], skin: &[Vector<D>]) {
        self.rebuild((water.to_vec(), skin.to_vec()));
    }

    /// Makes the lists for the positions of an earlier build, as [`Near::built`] gave them.
    pub fn rebuild(&mut self, built: (Vec<Vector<D>>, Vec<Vector<D>>)) {
        let cell = self.reach + self.margin;
        self.water = Grid::new(&built.0, cell);
        self.skin = Grid::new(&built.1, cell);
        self.lists.build(&self.water, &self.skin, &built.0, &built.1, cell);
        self.built = built;
    }

    /// The positions for which the lists were made: water and skin, m.
    pub fn built(&self) -> &(Vec<Vector<D>>, Vec<Vector<D>>) {
        &self.built
    }

    /// The lists.
    pub fn lists(&self) -> &Lists {
        &self.lists
    }

    /// Calls `visit` with the index of every water particle that may be within the support of `x`.
    pub fn water_around(&self, x: &Vector<D>, visit: &mut dyn FnMut(usize)) {
        Self::around(&self.water, x, self.reach + self.margin, visit);
    }

    /// Calls `visit` with the index of every boundary particle that may be within the support of `x`.
    pub fn skin_around(&self, x: &Vector<D>, visit: &mut dyn FnMut(usize)) {
        Self::around(&self.skin, x, self.reach + self.margin, visit);
    }

    fn around(grid: &Grid<D>, x: &Vector<D>, reach: f64, visit: &mut dyn FnMut(usize)) {
        let box_ = Bounds { min: *x, max: *x }.grown(reach);
        grid.rows(&box_, |row| row.iter().for_each(|&i| visit(i as usize)));
    }
}
