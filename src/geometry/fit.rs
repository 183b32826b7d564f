//! Fit of water to solids: which points lie in a solid and which are too near to its face. The module packs the water
//! around the solids that do not fit the lattice.

use rayon::prelude::*;

use super::{
    Shape,
    fill::Lattice,
    hollow::may_enclose,
    packing,
    thin::{has_thin_parts, thin_place},
    wall::is_closed,
};
use crate::{
    math::{Bounds, Pose, Vector},
    particles::PARTICLES_PER_TASK,
    ranks::Ranks,
};

/// Water moves up to this distance from a solid that does not fit, dp: enough to distribute half a row of particles.
const ZONE: f64 = 6.0;
/// Boundary layers in the packing: as many as the kernel's support covers.
const LAYERS: usize = 2;
/// The widest accepted gap between a face and its water, in excess of half a dp, dp.
const GAP: f64 = 0.1;
/// Least distance of packed water from a face, dp: a nearer point lies in a narrow gap between two faces.
const NARROW: f64 = 0.35;

/// Distance from a face, dp, within which a thin part displaces water as a part dp thick does.
const NEAR: f64 = 1.5;

/// A solid that displaces water. Parts thinner than dp have a single layer of boundary particles, which keeps water off as a part dp
/// thick does; their faces are taken where those of such a part would be. This does not apply to solids with hollows, whose water is a
/// fixed amount.
pub(super) struct Obstacle<'a, const D: usize> {
    shape: &'a Shape<D>,
    pose: &'a Pose<D>,
    dp: f64,
    /// Bounds of the solid, extended by one dp.
    close: Bounds<D>,
    /// Bounds of all points that the packing around this solid involves.
    around: Bounds<D>,
    /// The lines of the solid's open polyline walls, in world coordinates, if they may be beds.
    lines: Vec<Vec<Vector<D>>>,
    /// Whether the solid has polyline walls.
    has_walls: bool,
    /// Whether it has parts thinner than dp, and no hollow.
    is_thin: bool,
    /// Volume of the solid less the volume of the cells taken so far, on each side, in cells.
    owed: Vec<f64>,
    /// Whether water on the lattice would be too near to the solid's face, or too far from it.
    needs_packing: bool,
}

impl<'a, const D: usize> Obstacle<'a, D> {
    pub(crate) fn new(shape: &'a Shape<D>, pose: &'a Pose<D>, has_ground: bool, dp: f64) -> Self {
        let bounds = shape.bounds_at(pose);
        let mut lines = Vec::new();
        let has_walls = collect_lines(shape, pose, &mut lines);
        lines.truncate(if has_ground { lines.len() } else { 0 });
        let is_thin = !may_enclose(shape, true)
            && match shape {
                Shape::Polygon { .. } | Shape::Compound(_) => has_thin_parts(shape, dp, dp),
                _ => shape.bounds().size().min() < dp,
            };
        let around = bounds.grown((ZONE + packing::SUPPORT_RADIUS_DP + 1.0) * dp);
        Self {
            shape,
            pose,
            dp,
            close: bounds.grown(dp),
            around,
            lines,
            has_walls,
            is_thin,
            owed: vec![0.0; 2 * D],
            needs_packing: false,
        }
    }

    fn distance(&self, x: &Vector<D>) -> f64 {
        let x = self.pose.local(x);
        let distance = self.shape.signed_distance(&x);
        if !self.is_thin || distance > NEAR * self.dp {
            return distance;
        }
        let thin = thin_place(self.shape, &x, self.dp, 1e-3 * self.dp);
        distance - thin.map_or(0.0, |thin| 0.5 * (self.dp - thin.thickness))
    }

    fn outward(&self, x: &Vector<D>) -> Vector<D> {
        self.pose.rotation * self.shape.outward_normal(&self.pose.local(x), 1e-3 * self.dp)
    }

    /// Returns whether the solid takes the cell at `x`, or whether the cell lies in the ground below a bed. On each
    /// side, the solid takes as many of the cut cells as its volume requires, without an excess or a lack of half a
    /// row.
    pub(crate) fn claims_cell(&mut self, x: &Vector<D>) -> bool {
        // A line of length one dp has the second moment of a cubic cell along any normal. The shares therefore add up
        // to the volume at a curved face too.
        let share = if self.close.contains(x) { 0.5 - self.distance(x) / self.dp } else { 0.0 };
        if share <= 0.0 || share >= 1.0 {
            return share >= 1.0 || self.buries(x);
        }
        let n = self.outward(x);
        // A cell that the bed's own face cuts is not ground; a cell that the bed's underside cuts is ground.
        self.buries(&(x + n * self.dp)) || self.settle(share, &n)
    }

    /// Adds the solid's `share` of a cell to the side that faces along `n`. Returns whether the solid takes the whole
    /// cell.
    fn settle(&mut self, share: f64, n: &Vector<D>) -> bool {
        let axis = n.iamax();
        let owed = &mut self.owed[2 * axis + usize::from(n[axis] > 0.0)];
        *owed += share;
        let taken = *owed >= 0.5;
        if taken {
            *owed -= 1.0;
        }
        taken
    }

    /// Keeps as beds only the lines with no water (`is_water`) before and below their ends: under a shelf that ends in the water there is
    /// water, and under a line whose ends are at walls, at the bed or beside the water there is ground.
    pub(crate) fn keep_beds(&mut self, is_water: impl Fn(&Vector<D>) -> bool) {
        let way = 1.5 * self.dp;
        let beyond = |end: &Vector<D>, inner: &Vector<D>| {
            let along = end[0] - inner[0];
            let mut at = *end;
            at[0] += if along.abs() > 1e-9 * self.dp { way * along.signum() } else { 0.0 };
            at[D - 1] -= way;
            at
        };
        self.lines.retain(|line| {
            let ends = [line.first().zip(line.get(1)), line.last().zip(line.iter().nth_back(1))];
            !ends.into_iter().flatten().any(|(end, inner)| is_water(&beyond(end, inner)))
        });
    }

    /// Returns whether `x` lies in the ground below a bed.
    fn buries(&self, x: &Vector<D>) -> bool {
        self.lines.iter().any(|line| below_bed(x, line))
    }

    /// Records that the solid needs packing if the water point `x` is too near to the face, or if it leaves a gap at
    /// the face. A gap below the solid (face downwards) counts only if it belongs to the water (`in_water`).
    pub(crate) fn check_fit(&mut self, x: &Vector<D>, in_water: impl Fn(&Vector<D>) -> bool) {
        if self.needs_packing || !self.close.contains(x) {
            return;
        }
        let distance = self.distance(x) / self.dp;
        self.needs_packing = distance < 0.5 - 1e-6;
        if distance > 0.5 + GAP && distance < 1.0 {
            // This applies only to a face parallel to the lattice: at a corner this distance is correct.
            let n = self.outward(x);
            let is_above = n[D - 1] < -0.5;
            self.needs_packing = n.amax() > 1.0 - 1e-6 && (!is_above || in_water(&(x - n * self.dp)));
        }
    }

    /// Returns whether water on the lattice does not fit the solid.
    pub(crate) fn needs_packing(&self) -> bool {
        self.needs_packing
    }

    /// Returns whether the water point `x` is so near to the face that it lies in a gap too narrow for a row of
    /// particles.
    pub(crate) fn is_in_narrow_gap(&self, x: &Vector<D>) -> bool {
        self.close.contains(x) && self.distance(x) < NARROW * self.dp
    }

    /// Moves `x` out to half a dp from the face if it is nearer. Returns the distance (m) that `x` can then move
    /// without becoming nearer than that.
    fn push_out(&self, x: &mut Vector<D>) -> f64 {
        if !self.close.contains(x) {
            return 0.5 * self.dp;
        }
        let lack = 0.5 * self.dp - self.distance(x);
        if lack > 0.0 {
            *x += self.outward(x) * lack;
        }
        // Behind a thin wall the distance may be discontinuous.
        if self.has_walls { 0.0 } else { -lack }
    }
}

/// Adds the open polyline walls of a shape to `lines`, in world coordinates. Returns whether the shape has any polyline
/// walls.
fn collect_lines<const D: usize>(shape: &Shape<D>, pose: &Pose<D>, lines: &mut Vec<Vec<Vector<D>>>) -> bool {
    match shape {
        Shape::Polyline { points, .. } => {
            if !is_closed(points) {
                lines.push(points.iter().map(|x| pose.point(x)).collect());
            }
            true
        }
        Shape::Compound(parts) => {
            parts.iter().fold(false, |found, (inner, part)| collect_lines(part, &pose.then(inner), lines) || found)
        }
        _ => false,
    }
}

/// Returns whether the line segment next above `x` is a bed: a segment that runs towards +x, with the water above it.
fn below_bed<const D: usize>(x: &Vector<D>, line: &[Vector<D>]) -> bool {
    let (mut lowest, mut bed) = (f64::INFINITY, false);
    for ab in line.windows(2) {
        let (a, b) = (&ab[0], &ab[1]);
        if (a[0] > x[0]) != (b[0] > x[0]) {
            let height = a[1] + (x[0] - a[0]) * (b[1] - a[1]) / (b[0] - a[0]);
            if height > x[1] && height < lowest {
                (lowest, bed) = (height, b[0] > a[0]);
            }
        }
    }
    bed
}

/// Packs the water around the solids that do not fit the lattice; `home` contains the lattice index of each point. The `ranks` share
/// the work; each of the `owners` has a part of the water.
pub(super) fn pack_around_obstacles<const D: usize>(
    (ranks, owners): (&Ranks, &Ranks),
    (water, home): (&mut [Vector<D>], &[u32]),
    lattices: &[Lattice<D>],
    obstacles: &mut [Obstacle<D>],
    dp: f64,
) {
    if obstacles.iter().all(|o| !o.needs_packing) {
        return;
    }
    let (moving, still) = ghosts(lattices, obstacles);
    let misfits: Vec<_> = obstacles.iter().filter(|o| o.needs_packing).collect();
    let to_misfit = |x: &Vector<D>| {
        let near = misfits.iter().filter(|o| o.around.contains(x));
        near.map(|o| o.distance(x)).fold(f64::INFINITY, f64::min) / dp
    };
    let (mut movable, mut held) = (Vec::new(), Vec::new());
    // Whether a point near a misfit can move.
    let moves = |x: &Vector<D>| match to_misfit(x) {
        d if d < ZONE => Some(true),
        d if d < ZONE + packing::SUPPORT_RADIUS_DP + 1.0 => Some(false),
        _ => None,
    };
    let near: Vec<Option<bool>> = water.par_iter().with_min_len(PARTICLES_PER_TASK).map(moves).collect();
    for (i, (x, near)) in water.iter().zip(near).enumerate() {
        match near {
            Some(true) => movable.push(i),
            Some(false) => held.push(*x),
            None => (),
        }
    }
    // Temporary points continue the water beyond its regions, so that the water does not spread out of them.
    let first = owners.part(movable.len()).first;
    let homes: Vec<u32> = owners.concat(movable.iter().map(|&i| home[i]).collect());
    let all_movable = homes.len() + moving.len();
    let mut points = owners.concat(movable.iter().map(|&i| water[i]).collect());
    points.extend(moving.into_iter().chain(owners.concat(held)).chain(still));
    let near = Bounds::around(&points).grown(packing::SUPPORT_RADIUS_DP * dp);
    for o in &*obstacles {
        let skin = o.shape.boundary_points(dp, LAYERS);
        points.extend(skin.iter().map(|p| o.pose.point(&p.r)).filter(|x| near.contains(x)));
    }
    packing::spread_points_on(ranks, &mut points, all_movable, dp, |i, _, x| {
        let room = homes.get(i).map_or(f64::INFINITY, |&home| lattices[home as usize].clamp_to_sides(x));
        // Two passes: a point that moves out of one face of a corner may move into the other face.
        (0..2).flat_map(|_| &*obstacles).fold(room, |room, o| room.min(o.push_out(x)))
    });
    movable.iter().zip(&points[first..]).for_each(|(&i, x)| water[i] = *x);
}

/// Returns the lattice points in a margin around the regions, near the solids that do not fit. The first list contains
/// the movable points; the second contains the outermost points, which are fixed and hold the others.
fn ghosts<const D: usize>(lattices: &[Lattice<D>], obstacles: &mut [Obstacle<D>]) -> (Vec<Vector<D>>, Vec<Vector<D>>) {
    const MARGIN: i64 = 8;
    const RIM: i64 = 3;
    let (mut moving, mut still) = (Vec::new(), Vec::new());
    for (k, lattice) in lattices.iter().enumerate() {
        let inner = lattice.bounds_with_margin(MARGIN - RIM);
        lattice.for_each_point(MARGIN, |x| {
            if obstacles.iter().any(|o| o.needs_packing && o.around.contains(x))
                && !lattices.iter().any(|l| l.contains(x))
                && !lattices[..k].iter().any(|l| l.bounds_with_margin(MARGIN).contains(x))
                && !obstacles.iter_mut().any(|o| o.claims_cell(x))
            {
                let zone = obstacles.iter().any(|o| o.needs_packing && o.distance(x) < ZONE * o.dp);
                if zone && inner.contains(x) { &mut moving } else { &mut still }.push(*x);
            }
        });
    }
    (moving, still)
}
