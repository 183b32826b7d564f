//! Neighbour lists: positions in, indices out.
//!
//! The lists reach beyond the kernel support by a margin, and hold while no particle has moved by half the margin.
//! Most steps therefore search nothing. The SIMD pair loop uses lists of clusters ([`Clusters`]), the reference pair loop lists
//! of particles (`ParticleLists`). Both record the boundary particles near water; all other boundary particles cost nothing until
//! the next rebuild.

mod clusters;
mod columns;
mod division;
mod grid;
mod lists;
mod search;

pub use clusters::{Clusters, ListPart, PAD};
pub(crate) use clusters::{Slab, fill_positions, occupied_lanes};
pub(crate) use columns::Columns;
pub(crate) use division::{Division, IndexRanges};
pub(crate) use grid::CellGrid;
pub use lists::CHUNK;
pub(crate) use lists::{ParticleListChunk, ParticleLists};

use std::{ops::Range, sync::OnceLock};

use crate::{
    math::simd::{LANES, Level},
    math::{Bounds, Matrix, Vector},
    particles::{Particles, zeros},
    ranks::Ranks,
};
use columns::Sorted;

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
    /// Around all water at the last build.
    bounds_at_build: Bounds<D>,
    /// The positions of water and boundary particles at the last build in grids, for queries at a point; made at the first query.
    grids: [OnceLock<CellGrid<D>>; 2],
    /// The water particles whose places are known, if a device or other ranks have told those of some alone.
    known: Option<Vec<u32>>,
    /// The water particles that this rank advances and their positions at the last build in a grid; made when first asked for.
    own_grid: OnceLock<(Vec<u32>, CellGrid<D>)>,
}

impl<const D: usize> NeighbourLists<D> {
    /// Makes empty lists for a kernel of support `reach` (m) and the particle spacing `dp` (m): lists of clusters, searched with
    /// the instructions of `level`, or lists of single neighbours if `level` is `None`.
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
            bounds_at_build: Bounds::empty(),
            grids: Default::default(),
            known: None,
            own_grid: OnceLock::new(),
        }
    }

    /// The same lists, whose pairs these ranks share. The lists of single neighbours are not shared: every rank has them all.
    pub fn on_ranks(mut self, ranks: Ranks) -> Self {
        if let PairLists::Clusters(clusters, _) = &mut self.pair_lists {
            clusters.division.ranks = ranks;
        }
        self
    }

    /// How ranks share the particles; `None` with lists of single neighbours, which every rank has.
    pub(crate) fn division(&self) -> Option<&Division> {
        match &self.pair_lists {
            PairLists::Clusters(clusters, _) => Some(&clusters.division),
            PairLists::Lists(_) => None,
        }
    }

    /// The same, for changes.
    pub(crate) fn division_mut(&mut self) -> Option<&mut Division> {
        match &mut self.pair_lists {
            PairLists::Clusters(clusters, _) => Some(&mut clusters.division),
            PairLists::Lists(_) => None,
        }
    }

    /// The unit of length in which positions are whole numbers, m.
    pub fn length_unit(reach: f64) -> f64 {
        reach / UNITS
    }

    /// Removes the boundary particles `gone`; the later ones are renumbered.
    pub(crate) fn remove_boundary(&mut self, gone: Range<usize>) {
        self.boundary_near_fluid.retain(|&i| !gone.contains(&(i as usize)));
        let later = self.boundary_near_fluid.partition_point(|&i| (i as usize) < gone.start);
        self.boundary_near_fluid[later..].iter_mut().for_each(|i| *i -= gone.len() as u32);
    }

    /// Margin of the lists beyond the support, m.
    pub fn margin(&self) -> f64 {
        MARGIN * self.support_radius
    }

    /// The order in which water at `r` (m) lies along the columns: `order[new] = old`.
    pub(crate) fn column_order(&self, r: &[Vector<D>]) -> Vec<u32> {
        self.columns(Bounds::around(r), r.len()).sort(r, &all_indices(r.len())).order
    }

    /// The columns of `count` particles of water within `bounds` (m).
    fn columns(&self, bounds: Bounds<D>, count: usize) -> Columns<D> {
        Columns::new(bounds, count, WIDTH * self.dp, self.list_radius())
    }

    /// The columns of the water of all ranks, of which this one has its own at the places `r` (m); shares the slabs out anew.
    pub(crate) fn share_out(&mut self, r: &[Vector<D>]) -> Columns<D> {
        let own: Vec<u32> = self.own_indices().collect();
        self.share_out_own(own.iter().map(|&i| &r[i as usize]), r.len())
    }

    /// As [`NeighbourLists::share_out`], where `own` are the places (m) of this rank's water, of `count` particles.
    pub(crate) fn share_out_own<'a>(
        &mut self,
        own: impl Iterator<Item = &'a Vector<D>> + Clone,
        count: usize,
    ) -> Columns<D> {
        let bounds = Bounds::around(own.clone());
        let columns = self.columns(self.division().map_or(bounds, |division| division.union(&bounds)), count);
        let mut particles = vec![0; columns.slab_count()];
        own.for_each(|r| particles[columns.slab_at(r)] += 1);
        if let Some(division) = self.division_mut() {
            division.ranks.add_numbers(&mut particles);
            division.share_out(&particles);
        }
        columns
    }

    /// The water particles that this rank advances; none if it advances all.
    fn own_indices(&self) -> impl Iterator<Item = u32> + Clone {
        self.division().into_iter().flat_map(Division::own_indices)
    }

    /// Search radius of the lists, m.
    fn list_radius(&self) -> f64 {
        self.support_radius + self.margin()
    }

    /// The order of this rank's water at `r` (m) in `columns`.
    pub(crate) fn own_order(&self, columns: &Columns<D>, r: &[Vector<D>]) -> Vec<u32> {
        columns.sort(r, &self.own_indices().collect::<Vec<_>>()).order
    }

    /// Builds the lists for these positions of water and boundary particles.
    pub fn build(&mut self, water: &[Vector<D>], skin: &[Vector<D>]) {
        self.positions_at_build.clear();
        self.positions_at_build.reserve_exact(water.len());
        self.positions_at_build.extend_from_slice(water);
        let columns = self.columns(Bounds::around(water), water.len());
        let sorted = columns.sort(water, &all_indices(water.len()));
        if let Some(division) = self.division_mut() {
            let start = |column: usize| sorted.start[column];
            let slabs = (0..columns.slab_count()).map(|slab| columns.columns_of_slab(slab));
            division.share_out(&slabs.map(|of| start(of.end) - start(of.start)).collect::<Vec<_>>());
        }
        self.build_sorted(&columns, (water, &sorted), skin);
    }

    /// Builds the lists in `columns` that [`NeighbourLists::share_out`] gave, where this rank has its own water and the particles
    /// `next` of the next rank's first slab.
    pub(crate) fn build_own(&mut self, columns: &Columns<D>, water: &[Vector<D>], next: &[u32], skin: &[Vector<D>]) {
        self.positions_at_build = zeros(water.len());
        let mut which: Vec<u32> = self.own_indices().collect();
        which.iter().for_each(|&i| self.positions_at_build[i as usize] = water[i as usize]);
        which.extend(next);
        self.build_sorted(columns, (water, &columns.sort(water, &which)), skin);
    }

    fn build_sorted(&mut self, columns: &Columns<D>, (water, sorted): (&[Vector<D>], &Sorted), skin: &[Vector<D>]) {
        self.forget_known();
        (self.bounds_at_build, self.own_grid) = (columns.bounds, OnceLock::new());
        let look = self.list_radius();
        let mut heights = columns.heights(water, sorted, look);
        if let Some(division) = self.division().filter(|division| division.is_apart) {
            let mut ends: Vec<f64> =
                heights.iter().flat_map(|h| h.map_or([f64::NAN; 2], |(low, high)| [low, high])).collect();
            let of_slab = |slab: usize| columns.columns_of_slab(slab);
            division.share_by_column(&mut ends, |slab| 2 * of_slab(slab).start..2 * of_slab(slab).end);
            heights = ends.chunks_exact(2).map(|ends| (!ends[0].is_nan()).then_some((ends[0], ends[1]))).collect();
        }
        let near = columns.near_fluid(&heights, skin);
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
                clusters.build(columns, (water, sorted), (skin, &skin_sorted), &sizes, *level)
            }
        };
    }

    /// Restricts queries at a point to `these` particles of water, in ascending order, which were at `places` (m) at the last build. The
    /// order of the results is the same as in a query of all particles.
    pub(crate) fn know(&mut self, these: Vec<u32>, places: &[Vector<D>]) {
        let all = (self.bounds_at_build, self.positions_at_build.len());
        let grid = CellGrid::of_part(places, all, self.list_radius());
        (self.grids[0], self.known) = (OnceLock::from(grid), Some(these));
    }

    /// The water particles of this rank that may be within one of the `ranges` (m), in ascending order.
    pub(crate) fn own_within(&self, ranges: &[Bounds<D>]) -> Vec<u32> {
        let (own, grid) = self.own_grid.get_or_init(|| {
            let own: Vec<u32> = self.own_indices().collect();
            let places: Vec<_> = own.iter().map(|&i| self.positions_at_build[i as usize]).collect();
            let grid = CellGrid::new(&places, self.list_radius());
            (own, grid)
        });
        let mut these = Vec::new();
        for range in ranges {
            let range = range.grown(self.margin());
            grid.visit_rows(&range, |row| these.extend(row.iter().map(|&k| own[k as usize])));
        }
        these.sort_unstable();
        these.dedup();
        these
    }

    /// Makes queries at a point use the positions `water` (m), for which the lists were built. This rank may lack some of the
    /// particles.
    pub(crate) fn find_at(&mut self, water: &[Vector<D>]) {
        (self.grids[0], self.known) = (OnceLock::from(CellGrid::new(water, self.list_radius())), None);
    }

    /// Lets queries at a point find all positions at the last build again.
    pub(crate) fn forget_known(&mut self) {
        (self.grids, self.known) = (Default::default(), None);
    }

    /// Gives the first rank, or all if `everyone`, all `water`, its positions at the last build, and its gradient `corrections` if
    /// there are any.
    pub(crate) fn share_water(
        &mut self,
        water: &mut Particles<D>,
        corrections: Option<&mut [Matrix<D>]>,
        everyone: bool,
    ) {
        let Self { pair_lists: PairLists::Clusters(clusters, _), positions_at_build, .. } = self else { return };
        let division = &clusters.division;
        let Some((own, _)) = division.own_water() else { return };
        let takes = everyone || division.ranks.rank() == 0;
        let numbers = Particles::<D>::NUMBERS;
        let width = numbers + D + if corrections.is_some() { D * D } else { 0 };
        type Data<'a, const D: usize> = (&'a mut Particles<D>, &'a mut [Vector<D>], Option<&'a mut [Matrix<D>]>);
        let give = |(water, then, corrections): &Data<'_, D>, i: usize, given: &mut Vec<f64>| {
            water.give(i, given);
            given.extend(then[i].iter());
            corrections.iter().for_each(|corrections| given.extend(corrections[i].iter()));
        };
        let take = |(water, then, corrections): &mut Data<'_, D>, i: usize, given: &[f64]| {
            if takes {
                water.take_changed(i, given);
                then[i] = Vector::from_column_slice(&given[numbers..numbers + D]);
                let correction = &given[numbers + D..];
                corrections.iter_mut().for_each(|all| all[i] = Matrix::from_column_slice(correction));
            }
        };
        division.share_water(own, &mut (water, &mut positions_at_build[..], corrections), width, give, take);
    }

    /// The water particles of a slab that this rank reads, in the order of their slots.
    pub(crate) fn water_of_slab(&self, slab: usize) -> impl Iterator<Item = usize> {
        let clusters = match &self.pair_lists {
            PairLists::Clusters(clusters, _) => Some(clusters),
            PairLists::Lists(_) => None,
        };
        let slots = |clusters: &Clusters| clusters.slabs[slab].first * LANES..clusters.slabs[slab].middle * LANES;
        let source = clusters.map_or(&[][..], |clusters| &clusters.source[slots(clusters)]);
        source.iter().filter(|&&i| i != PAD).map(|&i| i as usize)
    }

    /// Takes the positions (m) of water that a device has moved, for queries at a point. The lists of pairs stay as they are.
    #[cfg(feature = "gpu")]
    pub(crate) fn set_fluid_positions(&mut self, water: &[Vector<D>]) {
        (self.grids, self.known) = (Default::default(), None);
        self.positions_at_build.clear();
        self.positions_at_build.extend_from_slice(water);
    }

    /// Takes the positions (m) of `these` water particles alone, for queries at a point, until all are known again.
    #[cfg(feature = "gpu")]
    pub(crate) fn set_known_positions(&mut self, these: Vec<u32>, water: &[Vector<D>]) {
        self.grids[0] = OnceLock::from(CellGrid::new(water, self.list_radius()));
        self.known = Some(these);
    }

    /// The water particles whose places are known, if a device or other ranks have told those of some alone.
    pub(crate) fn known_water(&self) -> Option<&[u32]> {
        self.known.as_deref()
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
        match self.known_water() {
            None => self.visit_around(self.fluid_grid(), x, visit),
            Some(known) => self.visit_around(self.fluid_grid(), x, &mut |i| visit(known[i] as usize)),
        }
    }

    /// The indices of every water particle that may be within `bounds` (m), in order.
    pub(crate) fn fluid_within(&self, bounds: &Bounds<D>) -> Vec<usize> {
        let mut these = Vec::new();
        let bounds = bounds.grown(self.margin());
        self.fluid_grid().visit_rows(&bounds, |row| these.extend(row.iter().map(|&i| i as usize)));
        if let Some(known) = self.known_water() {
            these.iter_mut().for_each(|i| *i = known[*i] as usize);
        }
        these.sort_unstable();
        these
    }

    /// Calls `visit` with the index of every boundary particle that may be within the support of `x` (m). `at_build` returns the
    /// positions (m) of all boundary particles at the last build.
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

/// Returns `x` (m) in integer units, `inv_unit` to the metre, modulo 2³². Differences of near positions are exact up to 2⁵¹ units
/// from the origin.
#[inline(always)]
pub(crate) fn to_integer(x: f64, inv_unit: f64) -> i32 {
    // Added to 1.5·2⁵², the nearest whole number stands in the lowest bits.
    (x * inv_unit + 6_755_399_441_055_744.0).to_bits() as i32
}

#[cfg(test)]
#[path = "../../tests/unit/neighbours/known.rs"]
mod tests;
