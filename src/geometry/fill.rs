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
    hollow::{Enclosure, Place},
};
use crate::{
    error::{Error, Result},
    math::{Bounds, Matrix, Pose, Vector},
    ranks::{self, Ranks},
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

/// The hollows of a solid, and how water enters them.
pub(crate) struct EnclosedSpace<'a, const D: usize> {
    /// Number of the solid.
    pub(crate) solid: usize,
    pub(crate) shape: &'a Shape<D>,
    pub(crate) pose: &'a Pose<D>,
    pub(crate) enclosure: &'a Enclosure<D>,
    /// Whether a region of water that reaches around the solid stays out of each hollow.
    pub(crate) keeps_out: Vec<bool>,
}

/// A filling with water.
pub(crate) struct Filling<'a, const D: usize> {
    pub(crate) regions: &'a [WaterRegion<D>],
    /// The solid whose hollows each region fills, if it fills nothing else; an empty list: none does.
    pub(crate) inside: Vec<Option<usize>>,
    /// The height (m) at which the water of each region ends, if that lies below its top; an empty list: at the tops of all.
    pub(crate) levels: Vec<Option<f64>>,
    /// Shapes, poses, and whether open polylines are beds, with ground below.
    pub(crate) solids: &'a [(&'a Shape<D>, &'a Pose<D>, bool)],
    pub(crate) spaces: &'a [EnclosedSpace<'a, D>],
    /// Those that make the same filling and share its work.
    pub(crate) ranks: &'a Ranks,
    /// Those of which each gets a part of the water; a single one gets all.
    pub(crate) owners: &'a Ranks,
}

/// Water with its origin.
pub(crate) struct Filled<const D: usize> {
    /// The water of this rank. Each owner has a part, in the order of the ranks.
    pub(crate) water: FilledWater<D>,
    /// Number of the region of each particle.
    pub(crate) home: Vec<u32>,
    /// Whether a region of water lies in each enclosed space without reaching around the solid.
    pub(crate) has_own_water: Vec<bool>,
}

/// How a region of water meets an enclosed space.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Entry {
    /// The region lies within the solid.
    Within,
    /// The region reaches around the solid.
    Around,
    /// The region fills the hollows and nothing else.
    Only,
}

impl<const D: usize> EnclosedSpace<'_, D> {
    fn place(&self, x: &Vector<D>) -> Place {
        self.enclosure.place(self.shape, &self.pose.local(x))
    }

    /// Returns whether the space keeps the point `x` of a region dry.
    fn excludes(&self, x: &Vector<D>, entry: Entry) -> bool {
        match entry {
            Entry::Within => false,
            Entry::Around => matches!(self.place(x), Place::Hollow(hollow) if self.keeps_out[hollow]),
            Entry::Only => !matches!(self.place(x), Place::Hollow(_)),
        }
    }
}

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
    let alone = &Ranks::default();
    let levels = Vec::new();
    Ok(Filling { regions, inside: Vec::new(), levels, solids, spaces: &[], ranks: alone, owners: alone }
        .fill(dp)?
        .water)
}

impl<const D: usize> Filling<'_, D> {
    /// Fills the regions with water of spacing `dp` (m) as [`fill`], but for the hollows that stay dry.
    ///
    /// # Errors
    /// The same errors as [`fill`].
    pub(crate) fn fill(&self, dp: f64) -> Result<Filled<D>> {
        if !(dp > 0.0 && dp.is_finite()) {
            return Err(
                Error::scene(format!("the particle spacing dp is {dp}")).help("give a length above zero, in metres")
            );
        }
        let mut lattices: Vec<Lattice<D>> = Vec::new();
        for region in self.regions {
            lattices.push(Lattice::new(region, lattices.first().map(|l| l.origin), dp)?);
        }
        let mut obstacles: Vec<_> =
            self.solids.iter().map(|(shape, pose, ground)| Obstacle::new(shape, pose, *ground, dp)).collect();
        let mut filled = FilledWater { r: Vec::new(), removed_in_solids: 0, removed_in_regions: 0 };
        let mut home = Vec::new();
        let entries: Vec<Vec<Entry>> = lattices.iter().enumerate().map(|(k, l)| self.entries(k, l)).collect();
        let excludes = |k: usize, x: &Vector<D>| {
            self.spaces.iter().zip(&entries[k]).any(|(space, entry)| space.excludes(x, *entry))
        };
        let claims = |k: usize, x: &Vector<D>| lattices[k].contains(x) && !excludes(k, x);
        let is_water = |k: usize, x: &Vector<D>| self.is_below_level(k, x) && claims(k, x);
        let is_free = |x: &Vector<D>| {
            let near =
                |(shape, pose, _): &(&Shape<D>, &Pose<D>, bool)| shape.signed_distance(&pose.local(x)) < 0.5 * dp;
            !self.solids.iter().any(near)
        };
        // Buffers of open boundaries, whose beds end at the face, have no levels.
        let without_buffers = if self.levels.is_empty() { lattices.len() } else { self.levels.len() };
        let opens = |x: &Vector<D>| (0..without_buffers).any(|k| is_water(k, x)) && is_free(x);
        obstacles.iter_mut().for_each(|o| o.keep_beds(opens));
        let own = ranks::equal_part(lattices.iter().map(Lattice::point_count).sum(), self.owners);
        let mut point = 0;
        for (k, lattice) in lattices.iter().enumerate() {
            lattice.for_each_point(0, |x| {
                let is_own = own.contains(&point);
                point += 1;
                if !claims(k, x) {
                    return;
                }
                let is_below = self.is_below_level(k, x);
                if (0..k).any(|i| is_water(i, x)) {
                    filled.removed_in_regions += usize::from(is_below);
                } else if !is_below && ((0..k).any(|i| claims(i, x)) || (k + 1..lattices.len()).any(|i| is_water(i, x)))
                {
                    // The packing treats a region as full up to its top, but for what is water of another.
                } else if obstacles.iter_mut().any(|o| o.claims_cell(x)) {
                    filled.removed_in_solids += 1;
                } else {
                    obstacles.iter_mut().for_each(|o| o.check_fit(x, |cell| lattice.contains(cell)));
                    if is_own {
                        filled.r.push(*x);
                        home.push(k as u32);
                    }
                }
            });
        }
        pack_around_obstacles((self.ranks, self.owners), (&mut filled.r, &home), &lattices, &mut obstacles, dp);
        if obstacles.iter().any(Obstacle::needs_packing) {
            let before = filled.r.len();
            let keep = |(x, k): (&Vector<D>, &u32)| {
                !obstacles.iter().any(|o| o.is_in_narrow_gap(x)) && !excludes(*k as usize, x)
            };
            let keep: Vec<bool> = filled.r.iter().zip(&home).map(keep).collect();
            let mut flags = keep.iter();
            filled.r.retain(|_| flags.next() == Some(&true));
            let mut flags = keep.iter();
            home.retain(|_| flags.next() == Some(&true));
            filled.removed_in_solids += self.owners.counts(before - filled.r.len()).iter().sum::<usize>();
        }
        if self.levels.iter().any(Option::is_some) {
            let below = |(x, k): &(Vector<D>, u32)| self.is_below_level(*k as usize, x);
            (filled.r, home) = filled.r.into_iter().zip(home).filter(below).unzip();
        }
        let has_own_water = (0..self.spaces.len()).map(|s| self.has_own_water(s, &lattices, &entries)).collect();
        Ok(Filled { water: filled, home, has_own_water })
    }

    /// Returns whether `x` (m) is below the surface of region number `k`.
    fn is_below_level(&self, k: usize, x: &Vector<D>) -> bool {
        self.levels.get(k).copied().flatten().is_none_or(|level| x[D - 1] < level)
    }

    /// Returns how region number `k` meets each enclosed space.
    fn entries(&self, k: usize, lattice: &Lattice<D>) -> Vec<Entry> {
        let only = self.inside.get(k).copied().flatten();
        let entry = |space: &EnclosedSpace<D>| {
            if only.is_some() {
                return if only == Some(space.solid) { Entry::Only } else { Entry::Within };
            }
            let mut around = false;
            lattice.for_each_point(0, |x| {
                around =
                    around || (lattice.contains(x) && self.is_below_level(k, x) && space.place(x) == Place::Outside);
            });
            if around { Entry::Around } else { Entry::Within }
        };
        self.spaces.iter().map(entry).collect()
    }

    /// Returns whether a region of water that does not reach around the solid enters enclosed space number `s`.
    fn has_own_water(&self, s: usize, lattices: &[Lattice<D>], entries: &[Vec<Entry>]) -> bool {
        let space = &self.spaces[s];
        (0..lattices.len()).filter(|k| entries[*k][s] != Entry::Around).any(|k| {
            let (mut enters, lattice) = (false, &lattices[k]);
            lattice.for_each_point(0, |x| {
                let is_water = || lattice.contains(x) && self.is_below_level(k, x);
                enters = enters || (is_water() && matches!(space.place(x), Place::Hollow(_)));
            });
            enters
        })
    }
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

    /// Number of points in the region's box.
    fn point_count(&self) -> usize {
        (0..D).map(|i| (self.high[i] + 1 - self.low[i]).max(0) as usize).product()
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
