//! Filling with water: points on a lattice of spacing dp, each the centre of its cell, less the solids.
//!
//! A cell inside a solid goes; of the cells that a face cuts so many go that along each side of the solid as much
//! water is gone as it displaces. Where a solid then does not fit the lattice, the water around it is packed: it leaves no gap
//! to the face and comes no nearer to it than half a dp. Where everything fits, the lattice stays exact. A gap between two
//! solids that is too narrow for a row of particles stays dry.

use super::{
    Shape,
    boundary_points::for_each_index,
    fit::{Obstacle, pack_around_obstacles},
};
use crate::{
    error::{Error, Result},
    math::{Bounds, Matrix, Pose, Vector},
};

/// A body of water.
#[derive(Clone, Debug, PartialEq)]
pub struct WaterRegion<const D: usize> {
    /// What is filled; of an unturned box the lattice starts at the lowest corner.
    pub shape: Shape<D>,
    /// Where it is.
    pub pose: Pose<D>,
}

/// What the filling gave.
#[derive(Clone, Debug, PartialEq)]
pub struct FilledWater<const D: usize> {
    /// Positions, m.
    pub r: Vec<Vector<D>>,
    /// Lattice points that were dropped because they lay in a solid.
    pub removed_in_solids: usize,
    /// Lattice points that were dropped because they lay in an earlier region.
    pub removed_in_regions: usize,
}

/// Most points of a lattice: beyond, the spacing is a slip of the pen.
const MOST: f64 = 4e8;

/// Fills `regions` with water of spacing `dp` (m), less the `solids`.
///
/// Regions whose corners are a whole number of dp apart share one lattice. A box that is not a whole
/// number of dp wide has its lattice in the middle, the lowest row half a dp above the bottom.
///
/// # Errors
/// A scene error if `dp` is not positive, a region cannot exist or is thinner than half a dp, or its lattice
/// would have more than 4·10⁸ points.
pub fn fill<const D: usize>(
    regions: &[WaterRegion<D>],
    solids: &[(&Shape<D>, &Pose<D>)],
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
    let mut obstacles: Vec<_> = solids.iter().map(|(shape, pose)| Obstacle::new(shape, pose, dp)).collect();
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
    /// An unturned box holds all points of its lattice, any other shape those inside it.
    is_box: bool,
    origin: Vector<D>,
    low: [i64; D],
    high: [i64; D],
    dp: f64,
}

impl<'a, const D: usize> Lattice<'a, D> {
    /// The lattice of `region`, one with the lattice at `shared` if their corners allow.
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

    /// Visits the lattice points of the region's box, and of `margin` cells around it.
    pub fn for_each_point(&self, margin: i64, mut visit: impl FnMut(&Vector<D>)) {
        let (low, high) = (self.low.map(|i| i - margin), self.high.map(|i| i + margin));
        for_each_index(&low, &high, |at| {
            visit(&(self.origin + Vector::from_fn(|i, _| (at[i] as f64 + 0.5) * self.dp)));
        });
    }

    /// The cells of the lattice and of `margin` cells around it.
    pub fn bounds_with_margin(&self, margin: i64) -> Bounds<D> {
        let corner =
            |at: &[i64; D], more: i64| Vector::from_fn(|i, _| self.origin[i] + (at[i] + more) as f64 * self.dp);
        Bounds { min: corner(&self.low, -margin), max: corner(&self.high, 1 + margin) }
    }

    /// Whether the region holds the place `x`.
    pub fn contains(&self, x: &Vector<D>) -> bool {
        if self.is_box {
            return self.bounds_with_margin(0).grown(-1e-9 * self.dp).contains(x);
        }
        self.region.shape.signed_distance(&self.region.pose.local(x)) < -1e-9 * self.dp
    }

    /// Keeps `x` half a dp inside the sides of a box; its top is free and its bottom a solid's business.
    /// Returns how far (m) it may then go without leaving them.
    pub fn clamp_to_sides(&self, x: &mut Vector<D>) -> f64 {
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
mod tests {
    use super::*;

    fn pool<const D: usize>(size: [f64; D]) -> WaterRegion<D> {
        let size = Vector::from(size);
        WaterRegion { shape: Shape::Box { size }, pose: Pose::at(size * 0.5) }
    }

    /// The nearest water to the solid's face, and the barest place of the wetted face.
    fn clearance<const D: usize>(water: &[Vector<D>], shape: &Shape<D>, pose: &Pose<D>, dp: f64) -> (f64, f64) {
        let nearest = water.iter().map(|x| shape.signed_distance(&pose.local(x))).fold(f64::INFINITY, f64::min);
        let reach = |x: Vector<D>| water.iter().map(|w| (w - x).norm()).fold(f64::INFINITY, f64::min);
        // Places on the face: a fine skin of the shape, brought up to the face.
        let fine = shape.boundary_points(0.3 * dp, 1);
        let face = fine.iter().map(|p| p.r - shape.outward_normal(&p.r, 1e-3 * dp) * shape.signed_distance(&p.r));
        let top = water.iter().map(|w| w[D - 1]).fold(f64::NEG_INFINITY, f64::max);
        let bare = face.map(|x| pose.point(&x)).filter(|x| x[D - 1] < top - 1.5 * dp).map(reach).fold(0.0, f64::max);
        (nearest / dp, bare / dp)
    }

    fn fits<const D: usize>(filled: &FilledWater<D>, shape: &Shape<D>, pose: &Pose<D>, dp: f64) {
        let (nearest, bare) = clearance(&filled.r, shape, pose, dp);
        assert!(nearest >= 0.45, "{shape:?}: water {nearest} dp from the face");
        // Half a dp in front, half a spacing aside in D − 1 directions: 0.71 and 0.87 dp on a lattice that
        // fits; uneven places add a fifth.
        let most = if D == 2 { 0.85 } else { 1.04 };
        assert!(bare <= most, "{shape:?}: a gap of {bare} dp");
        let cells = crate::geometry::cells::spacing_flags(&filled.r, 0, 0.5 * dp);
        assert!(cells.iter().all(|kept| *kept), "{shape:?}: points nearer than half a dp");
    }

    #[test]
    fn a_fitting_tank_and_body_leave_the_lattice_exact() {
        let tank = Shape::Tank { size: Vector::from([4.0, 5.0]), thickness: 0.3 };
        let (block, at) = (Shape::Box { size: Vector::from([1.0, 0.5]) }, Pose::at(Vector::from([2.0, 1.25])));
        let solids = [(&tank, &Pose::identity()), (&block, &at)];
        let filled = fill(&[pool([4.0, 2.0])], &solids, 0.1).unwrap();
        assert_eq!((filled.r.len(), filled.removed_in_solids, filled.removed_in_regions), (750, 50, 0));
        for x in filled.r.iter().flat_map(|r| r.iter()) {
            assert!((x / 0.1 - 0.5 - (x / 0.1 - 0.5).round()).abs() < 1e-9);
        }
    }

    #[test]
    fn regions_share_a_lattice_and_never_fill_twice() {
        let film = pool([2.0, 0.2]);
        let mut column = pool([0.5, 1.0]);
        column.pose.position[0] += 0.3;
        let filled = fill(&[column, film], &[], 0.1).unwrap();
        assert_eq!((filled.r.len(), filled.removed_in_regions), (50 + 30, 10));
        assert!(fill(&[pool([1.0, 0.04])], &[], 0.1).is_err());
        assert!(fill(&[pool([1.0, 1.0])], &[], 1e-9).is_err());
    }

    #[test]
    fn water_displaced_by_a_disc_has_its_area() {
        let pool = [pool([4.0, 4.0])];
        for (x, y) in [(2.0, 2.0), (2.03, 1.97), (2.0 + 0.031, 2.0 + 0.047)] {
            let (disc, at) = (Shape::Ball { radius: 0.5 }, Pose::at(Vector::from([x, y])));
            let filled = fill(&pool, &[(&disc, &at)], 0.1).unwrap();
            // 78.5 cells; each of the four sides may be off by half a cell.
            assert!((filled.removed_in_solids as f64 - 78.54).abs() <= 2.0, "{}", filled.removed_in_solids);
            assert_eq!(filled.r.len() + filled.removed_in_solids, 1600);
            fits(&filled, &disc, &at, 0.1);
        }
    }

    #[test]
    fn boxes_off_the_lattice_or_tilted_have_no_gap() {
        let block = Shape::Box { size: Vector::from([1.0, 1.0]) };
        for (x, y, turn) in [(2.03, 2.0, 0.0), (2.05, 2.05, 0.0), (2.03, 1.98, 0.3), (2.0, 3.93, 0.0)] {
            let at = Pose::rotated(Vector::from([x, y]), &[turn]);
            let filled = fill(&[pool([4.0, 4.0])], &[(&block, &at)], 0.1).unwrap();
            let (wet, _) = block.submerged_volume(&at, 4.0);
            // Half a cell for each of the four sides, not half a row.
            assert!((filled.removed_in_solids as f64 - 100.0 * wet).abs() <= 2.0, "{}", filled.removed_in_solids);
            fits(&filled, &block, &at, 0.1);
        }
    }

    #[test]
    fn packing_round_a_float_leaves_the_surface_level() {
        let block = Shape::Box { size: Vector::from([1.0, 1.0]) };
        let at = Pose::at(Vector::from([2.03, 3.95]));
        let filled = fill(&[pool([4.0, 4.0])], &[(&block, &at)], 0.1).unwrap();
        let top = filled.r.iter().map(|x| (x[1] - 3.95) / 0.1).fold(f64::NEG_INFINITY, f64::max);
        // No mound: uneven places within a quarter of a spacing. A hollow would be a lack in the count.
        assert!(top < 0.25, "the top row rises to {top} dp above its height");
    }

    #[test]
    fn water_lies_on_a_slope_and_not_beneath_it() {
        let points = [[0.0, 0.0], [1.0, 0.0], [4.0, 1.2]].map(Vector::from).to_vec();
        let bed = Shape::Polyline { points, thickness: 0.2 };
        let filled = fill(&[pool([4.0, 1.0])], &[(&bed, &Pose::identity())], 0.05).unwrap();
        let area = 4.0 - 0.5 * 2.5 * 1.0 - 0.5; // the triangle under the slope up to x = 3.5, then the rest
        assert!((filled.r.len() as f64 * 0.0025 - area).abs() < 0.02, "{}", filled.r.len() as f64 * 0.0025);
        fits(&filled, &bed, &Pose::identity(), 0.05);
        // The lattice is as it was far from the slope.
        assert!(filled.r.iter().any(|x| (x - Vector::from([0.025, 0.975])).norm() < 1e-9));
    }

    #[test]
    fn water_closes_round_a_ball() {
        let (ball, at) = (Shape::Ball { radius: 0.4 }, Pose::at(Vector::from([1.013, 0.987, 1.03])));
        let filled = fill(&[pool([2.0, 2.0, 2.0])], &[(&ball, &at)], 0.1).unwrap();
        assert!((filled.removed_in_solids as f64 - 268.1).abs() < 8.0, "{}", filled.removed_in_solids);
        fits(&filled, &ball, &at, 0.1);
    }

    #[test]
    fn a_gap_too_narrow_for_a_row_of_particles_stays_dry() {
        let tank = Shape::Tank { size: Vector::from([2.1, 5.0]), thickness: 0.4 };
        let (block, at) = (Shape::Box { size: Vector::from([2.0, 1.0]) }, Pose::at(Vector::from([1.05, 1.5])));
        let filled = fill(&[pool([2.1, 3.0])], &[(&tank, &Pose::identity()), (&block, &at)], 0.1).unwrap();
        // Half a dp is left on either side: water would lie a quarter of dp from both faces.
        assert!(filled.r.iter().all(|x| x[1] <= 1.0 || x[1] >= 2.0));
        assert!(filled.r.len() >= 2 * 10 * 21 - 21, "what is below and above stays: {}", filled.r.len());
    }

    #[test]
    fn any_number_of_threads_fills_with_the_same_bits() {
        let (ball, at) = (Shape::Ball { radius: 0.4 }, Pose::at(Vector::from([1.013, 0.987, 1.03])));
        let filled = |threads: usize| {
            let workers = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            workers.install(|| fill(&[pool([2.0, 2.0, 2.0])], &[(&ball, &at)], 0.1).unwrap())
        };
        let one = filled(1);
        assert!([2, 3, 8].into_iter().all(|threads| filled(threads) == one));
    }
}
