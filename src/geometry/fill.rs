//! Filling with water: points on a lattice of spacing dp, each at the centre of its cell, outside the solids.
//!
//! The module removes each cell inside a solid. Of the cells that a face cuts, the module removes as many as the
//! displaced volume requires along each side of the solid. If a solid does not fit the lattice, the module packs the
//! water around it. The packed water leaves no gap at the face and stays at least half a dp from it. If all solids fit,
//! the lattice stays exact. A gap between two solids that is too narrow for a row of particles stays dry.

use super::{
    Shape,
    boundary_points::for_each_index,
    fit::{Obstacle, pack_around_obstacles},
};
use crate::{
    error::{Error, Result},
    math::{Bounds, Matrix, Pose, Vector},
};

/// A region of water.
#[derive(Clone, Debug, PartialEq)]
pub struct WaterRegion<const D: usize> {
    /// Shape of the region. For an unturned box, the lattice starts at the lowest corner.
    pub shape: Shape<D>,
    /// Pose of the region.
    pub pose: Pose<D>,
}

/// Result of the filling.
#[derive(Clone, Debug, PartialEq)]
pub struct FilledWater<const D: usize> {
    /// Positions, m.
    pub r: Vec<Vector<D>>,
    /// Number of lattice points removed because they lie in a solid.
    pub removed_in_solids: usize,
    /// Number of lattice points removed because they lie in an earlier region.
    pub removed_in_regions: usize,
}

/// Largest number of points of a lattice: a larger number indicates a mistyped spacing.
const MOST: f64 = 4e8;

/// Fills `regions` with water of spacing `dp` (m) outside the `solids`, and returns the filling.
///
/// Regions share a lattice if their corners are a whole number of dp apart. If a box is not a whole number of dp wide,
/// its lattice is centred, with the lowest row half a dp above the bottom.
///
/// # Errors
/// A scene error if `dp` is not positive, a region is not valid or is thinner than half a dp, or its lattice would have
/// more than 4·10⁸ points.
pub fn fill<const D: usize>(
    regions: &[WaterRegion<D>],
    solids: &[(&Shape<D>, &Pose<D>)],
    dp: f64,
) -> Result<FilledWater<D>> {
    let ground: Vec<_> = solids.iter().map(|(shape, pose)| (*shape, *pose, true)).collect();
    fill_around(regions, &ground, dp)
}

/// Fills as [`fill()`] does. Of each solid the third value is whether its open polylines are beds, with ground below.
pub(crate) fn fill_around<const D: usize>(
    regions: &[WaterRegion<D>],
    solids: &[(&Shape<D>, &Pose<D>, bool)],
    dp: f64,
) -> Result<FilledWater<D>> {
    if !(dp > 0.0 && dp.is_finite()) {
        return Err(
            Error::scene(format!("the particle spacing dp is {dp}")).help("give a length above zero, in metres")
        );
    }
    let mut lattices: Vec<Lattice<D>> = Vec::new();
    for region in regions {
        lattices.push(Lattice::new(region, lattices.first().map(|l| l.origin), dp)?);
    }
    let mut obstacles: Vec<_> =
        solids.iter().map(|(shape, pose, ground)| Obstacle::new(shape, pose, *ground, dp)).collect();
    let mut filled = FilledWater { r: Vec::new(), removed_in_solids: 0, removed_in_regions: 0 };
    let mut home = Vec::new();
    for (k, lattice) in lattices.iter().enumerate() {
        lattice.for_each_point(0, |x| {
            if !lattice.contains(x) {
                return;
            }
            if lattices[..k].iter().any(|earlier| earlier.contains(x)) {
                filled.removed_in_regions += 1;
            } else if obstacles.iter_mut().any(|o| o.claims_cell(x)) {
                filled.removed_in_solids += 1;
            } else {
                obstacles.iter_mut().for_each(|o| o.check_fit(x, |cell| lattice.contains(cell)));
                filled.r.push(*x);
                home.push(k);
            }
        });
    }
    pack_around_obstacles(&mut filled.r, &home, &lattices, &mut obstacles, dp);
    if obstacles.iter().any(Obstacle::needs_packing) {
        let before = filled.r.len();
        filled.r.retain(|x| !obstacles.iter().any(|o| o.is_in_narrow_gap(x)));
        filled.removed_in_solids += before - filled.r.len();
    }
    Ok(filled)
}

/// The lattice of a region: point i lies at origin + (i + ½) dp.
pub(super) struct Lattice<'a, const D: usize> {
    region: &'a WaterRegion<D>,
    /// Whether the region is an unturned box. Such a box contains all points of its lattice; any other shape contains
    /// only the points inside it.
    is_box: bool,
    origin: Vector<D>,
    low: [i64; D],
    high: [i64; D],
    dp: f64,
}

impl<'a, const D: usize> Lattice<'a, D> {
    /// Returns the lattice of `region`, aligned with the lattice at `shared` if their corners permit.
    fn new(region: &'a WaterRegion<D>, shared: Option<Vector<D>>, dp: f64) -> Result<Self> {
        region.shape.check()?;
        let bounds = region.shape.bounds_at(&region.pose);
        if (bounds.size() / dp).map(|n| n + 1.0).product() > MOST {
            return Err(Error::scene("a body of water would need more than 400 million particles")
                .help("make dp larger, or the region smaller"));
        }
        let unturned = (region.pose.rotation - Matrix::identity()).norm() < 1e-12;
        let is_box = unturned && matches!(region.shape, Shape::Box { .. });
        let mut made = Self { region, is_box, origin: Vector::zeros(), low: [0; D], high: [0; D], dp };
        if !is_box {
            made.origin = shared.unwrap_or_else(Vector::zeros);
            let cell = |x: f64, i: usize| (x - made.origin[i]) / dp;
            made.low = std::array::from_fn(|i| cell(bounds.min[i], i).floor() as i64);
            made.high = std::array::from_fn(|i| cell(bounds.max[i], i).ceil() as i64);
            return Ok(made);
        }
        let n: [i64; D] = std::array::from_fn(|i| (bounds.size()[i] / dp + 1e-6).round() as i64);
        if let Some(i) = n.iter().position(|n| *n < 1) {
            let what = format!("a body of water is {} m thin, less than half a particle spacing", bounds.size()[i]);
            return Err(Error::scene(what).help(format!("make it at least {} m, or dp smaller", 0.5 * dp)));
        }
        let spare = |i: usize| if i == D - 1 { 0.0 } else { 0.5 * (bounds.size()[i] - n[i] as f64 * dp) };
        let start = Vector::from_fn(|i, _| bounds.min[i] + spare(i));
        let steps = |from: Vector<D>| (start - from) / dp;
        made.origin = shared.filter(|s| steps(*s).iter().all(|c| (c - c.round()).abs() < 1e-6)).unwrap_or(start);
        made.low = std::array::from_fn(|i| steps(made.origin)[i].round() as i64);
        made.high = std::array::from_fn(|i| made.low[i] + n[i] - 1);
        Ok(made)
    }

    /// Visits the lattice points of the region's box and of a margin of `margin` cells around it.
    pub(crate) fn for_each_point(&self, margin: i64, mut visit: impl FnMut(&Vector<D>)) {
        let (low, high) = (self.low.map(|i| i - margin), self.high.map(|i| i + margin));
        for_each_index(&low, &high, |at| {
            visit(&(self.origin + Vector::from_fn(|i, _| (at[i] as f64 + 0.5) * self.dp)));
        });
    }

    /// Returns the bounds of the lattice cells and of a margin of `margin` cells around them.
    pub(crate) fn bounds_with_margin(&self, margin: i64) -> Bounds<D> {
        let corner =
            |at: &[i64; D], more: i64| Vector::from_fn(|i, _| self.origin[i] + (at[i] + more) as f64 * self.dp);
        Bounds { min: corner(&self.low, -margin), max: corner(&self.high, 1 + margin) }
    }

    /// Returns whether the region contains the point `x`.
    pub(crate) fn contains(&self, x: &Vector<D>) -> bool {
        if self.is_box {
            return self.bounds_with_margin(0).grown(-1e-9 * self.dp).contains(x);
        }
        self.region.shape.signed_distance(&self.region.pose.local(x)) < -1e-9 * self.dp
    }

    /// Keeps `x` at least half a dp inside the sides of a box; the top and the bottom do not constrain `x`. Returns the
    /// distance (m) that `x` can then move without leaving the sides.
    pub(crate) fn clamp_to_sides(&self, x: &mut Vector<D>) -> f64 {
        let mut room = f64::INFINITY;
        if let (true, Shape::Box { size }) = (self.is_box, &self.region.shape) {
            for i in 0..D - 1 {
                let half = (0.5 * (size[i] - self.dp)).max(0.0);
                let middle = self.region.pose.position[i];
                x[i] = x[i].clamp(middle - half, middle + half);
                room = room.min(half - (x[i] - middle).abs());
            }
        }
        room
    }
}

#[cfg(test)]
#[path = "../../tests/unit/geometry/fill.rs"]
mod tests;
