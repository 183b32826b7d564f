//! Neighbour lists: positions in, indices out.
//!
//! The lists reach beyond the kernel support by a margin, and hold while no particle has moved by half the margin.
//! Most steps therefore search nothing. The SIMD pair loop has lists of clusters ([`Clusters`]), the reference of particles
//! (`ParticleLists`). Both record the boundary particles near water; the others cost nothing until the next rebuild.

mod clusters;
mod columns;
mod grid;
mod lists;
mod search;

pub use clusters::{Clusters, ListPart, PAD};
pub(crate) use clusters::{Slab, fill_positions, occupied_lanes};
pub(crate) use grid::CellGrid;
pub use lists::CHUNK;
pub(crate) use lists::{ParticleListChunk, ParticleLists};

use std::sync::OnceLock;

use crate::{
    math::simd::Level,
    math::{Bounds, Vector},
};
use columns::Columns;

/// Margin of the lists beyond the support, over the support: they are rebuilt about every ten steps.
const MARGIN: f64 = 0.1;

/// Width of a column over dp.
const WIDTH: f64 = 2.0;

/// Integer units in the kernel support: a difference of two positions within it is exact in single precision.
const UNITS: f64 = (1 << 24) as f64;

/// The pairs.
#[derive(Clone, Debug)]
pub enum PairLists {
    /// Lists of single neighbours.
    Lists(ParticleLists),
    /// Lists of later clusters, searched with those instructions.
    Clusters(Clusters, Level),
}

/// The neighbour lists of water and boundary particles, and the positions at which they were built.
#[derive(Clone, Debug)]
pub struct NeighbourLists<const D: usize> {
    /// Kernel support, m.
    support_radius: f64,
    /// Particle spacing, m.
    dp: f64,
    pair_lists: PairLists,
    /// Boundary particles with water within the lists' reach, in ascending order.
    boundary_near_fluid: Vec<u32>,
    /// Positions of the water at the last build, m.
    positions_at_build: Vec<Vector<D>>,
    /// The positions of water and boundary particles at the last build in grids, for queries at a point; made at the first query.
    grids: [OnceLock<CellGrid<D>>; 2],
}

impl<const D: usize> NeighbourLists<D> {
    /// No lists yet, for a kernel of support `reach` (m) and particles `dp` (m) apart: of clusters, searched with
    /// the instructions of `level`, or else of single neighbours.
    pub fn new(reach: f64, dp: f64, level: Option<Level>) -> Self {
        let pairs = match level {
            Some(level) => PairLists::Clusters(Clusters::default(), level),
            None => PairLists::Lists(ParticleLists::default()),
        };
        Self {
            support_radius: reach,
            dp,
            pair_lists: pairs,
            boundary_near_fluid: Vec::new(),
            positions_at_build: Vec::new(),
            grids: Default::default(),
        }
    }

    /// The unit of length in which positions are whole numbers, m.
    pub fn length_unit(reach: f64) -> f64 {
        reach / UNITS
    }

    /// Removes the boundary particles `gone`; the later ones are renumbered.
    pub(crate) fn remove_boundary(&mut self, gone: std::ops::Range<usize>) {
        self.boundary_near_fluid.retain(|&i| !gone.contains(&(i as usize)));
        let later = self.boundary_near_fluid.partition_point(|&i| (i as usize) < gone.start);
        self.boundary_near_fluid[later..].iter_mut().for_each(|i| *i -= gone.len() as u32);
    }

    /// Margin of the lists beyond the support, m.
    pub fn margin(&self) -> f64 {
        MARGIN * self.support_radius
    }

    /// The order in which water at `r` lies along the columns: `order[new] = old`.
    pub(crate) fn column_order(&self, r: &[Vector<D>]) -> Vec<u32> {
        let columns = Columns::new(r, WIDTH * self.dp, self.list_radius());
        columns.sort(r, &all_indices(r.len())).order
    }

    /// Search radius of the lists, m.
    fn list_radius(&self) -> f64 {
        self.support_radius + self.margin()
    }

    /// Builds the lists for these positions of water and boundary particles.
    pub fn build(&mut self, water: &[Vector<D>], skin: &[Vector<D>]) {
        self.grids = Default::default();
        self.positions_at_build.clear();
        self.positions_at_build.reserve_exact(water.len());
        self.positions_at_build.extend_from_slice(water);
        let look = self.list_radius();
        let columns = Columns::new(water, WIDTH * self.dp, look);
        let water_sorted = columns.sort(water, &all_indices(water.len()));
        let near = columns.near_fluid(water, &water_sorted, skin, look);
        self.boundary_near_fluid = match &mut self.pair_lists {
            PairLists::Lists(lists) => {
                let (grid, skin_grid) = (CellGrid::new(water, look), CellGrid::new(skin, look));
                lists.build((&grid, water), (&skin_grid, skin), &near, look)
            }
            PairLists::Clusters(clusters, level) => {
                let sizes = search::SearchSizes {
                    reach: look,
                    width: WIDTH * self.dp,
                    inv_unit: 1.0 / Self::length_unit(self.support_radius),
                };
                let skin_sorted = columns.sort(skin, &near);
                clusters.build(&columns, (water, &water_sorted), (skin, &skin_sorted), &sizes, *level)
            }
        };
    }

    /// Takes the positions (m) of water that a device has moved, for queries at a point. The lists of pairs stay as they are.
    #[cfg(feature = "gpu")]
    pub(crate) fn set_fluid_positions(&mut self, water: &[Vector<D>]) {
        self.grids = Default::default();
        self.positions_at_build.copy_from_slice(water);
    }

    /// The positions of the water for which the lists were made, m.
    pub(crate) fn positions_at_build(&self) -> &[Vector<D>] {
        &self.positions_at_build
    }

    /// The pairs.
    pub fn pair_lists(&self) -> &PairLists {
        &self.pair_lists
    }

    /// The boundary particles that have water within the lists' reach, in ascending order.
    pub fn boundary_near_fluid(&self) -> &[u32] {
        &self.boundary_near_fluid
    }

    /// Memory of the lists, B.
    pub(crate) fn memory_bytes(&self) -> usize {
        let pairs = match &self.pair_lists {
            PairLists::Lists(lists) => lists.memory_bytes(),
            PairLists::Clusters(clusters, _) => clusters.memory_bytes(),
        };
        pairs + size_of_val(&self.boundary_near_fluid[..])
    }

    /// Calls `visit` with the index of every water particle that may be within the support of `x`.
    pub(crate) fn visit_fluid_around(&self, x: &Vector<D>, visit: &mut dyn FnMut(usize)) {
        self.visit_around(self.fluid_grid(), x, visit);
    }

    /// The indices of every water particle that may be within `bounds` (m), in order.
    pub(crate) fn fluid_within(&self, bounds: &Bounds<D>) -> Vec<usize> {
        let mut these = Vec::new();
        let bounds = bounds.grown(self.margin());
        self.fluid_grid().visit_rows(&bounds, |row| these.extend(row.iter().map(|&i| i as usize)));
        these.sort_unstable();
        these
    }

    /// Calls `visit` with the index of every boundary particle that may be within the support of `x`. `at_build` says where they
    /// were (m) at the last build.
    pub(crate) fn visit_boundary_around(
        &self,
        at_build: impl FnOnce() -> Vec<Vector<D>>,
        x: &Vector<D>,
        visit: &mut dyn FnMut(usize),
    ) {
        let grid = self.grids[1].get_or_init(|| CellGrid::new(&at_build(), self.list_radius()));
        self.visit_around(grid, x, visit);
    }

    fn fluid_grid(&self) -> &CellGrid<D> {
        self.grids[0].get_or_init(|| CellGrid::new(&self.positions_at_build, self.list_radius()))
    }

    fn visit_around(&self, grid: &CellGrid<D>, x: &Vector<D>, visit: &mut dyn FnMut(usize)) {
        let box_ = Bounds { min: *x, max: *x }.grown(self.list_radius());
        grid.visit_rows(&box_, |row| row.iter().for_each(|&i| visit(i as usize)));
    }
}

fn all_indices(n: usize) -> Vec<u32> {
    (0..n as u32).collect()
}

/// `x` (m) in integer units of which `inv_unit` are a metre, modulo 2³²: differences of near positions are
/// exact up to 2⁵¹ units from the origin.
#[inline(always)]
pub(crate) fn to_integer(x: f64, inv_unit: f64) -> i32 {
    // Added to 1.5·2⁵², the nearest whole number stands in the lowest bits.
    (x * inv_unit + 6_755_399_441_055_744.0).to_bits() as i32
}
