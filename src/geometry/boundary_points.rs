//! Boundary particles: evenly spaced layers one dp apart, with the first layer half a dp inside the true face.

use std::f64::consts::{PI, TAU};

use super::{
    BoundaryPoint, Shape,
    cells::spacing_flags,
    offset::{polygon_points, polyline_points},
    shell::points_by_distance,
    thin::{has_thin_parts, middle_points, thin_place},
};
use crate::math::{Pose, Vector};

/// Least distance between two particles of the same solid, dp.
pub(super) const MIN_SPACING: f64 = 0.7;

impl<const D: usize> Shape<D> {
    /// Returns the boundary particles in `layers` layers, with a spacing of about `dp` (m).
    ///
    /// Layer k lies (k + ½) dp inside the face. A box has round(size/dp) cells along each edge, so a box whose size is
    /// a multiple of dp reproduces the lattice. Round shapes have rings and shells, and outlines have parallel curves.
    /// Meshes have evenly spaced points on surfaces of constant depth; if two faces are too close, the innermost points
    /// lack up to a quarter dp of that depth. Walls of tanks and polylines have layers from both faces, and from the rim
    /// or the ends; walls thinner than twice `layers` dp are filled. Parts of
    /// polygons and meshes that are thinner than dp have a single layer in their middle. A tip between faces that are
    /// not nearly parallel has no particles where it is thinner than dp.
    pub fn boundary_points(&self, dp: f64, layers: usize) -> Vec<BoundaryPoint<D>> {
        let layers = layers.min(u8::MAX as usize);
        let points = match self {
            Shape::Box { size } => return box_skin(size, dp, layers),
            Shape::Tank { size, thickness } => return tank_skin(size, *thickness, dp, layers),
            Shape::Cylinder { length, radius, axis } => return cylinder_skin(*length, *radius, *axis, dp, layers),
            Shape::Ball { radius } => capsule_skin(0.0, *radius, D - 1, dp, layers),
            Shape::Capsule { length, radius, axis } => capsule_skin(*length, *radius, *axis, dp, layers),
            Shape::Polygon { points } => self.with_thin_parts(polygon_points(points, dp, layers), dp),
            Shape::Polyline { points, thickness } => polyline_points(points, *thickness, dp, layers),
            Shape::Mesh { .. } => self.with_thin_parts(points_by_distance(self, dp, layers), dp),
            Shape::Compound(parts) => return compound_skin(parts, dp, layers),
        };
        thinned(points, MIN_SPACING * dp)
    }

    /// Returns the particles with those in the middle of parts thinner than `dp` (m), which replace all others there.
    fn with_thin_parts(&self, mut points: Vec<BoundaryPoint<D>>, dp: f64) -> Vec<BoundaryPoint<D>> {
        if !has_thin_parts(self, dp, dp) {
            return points;
        }
        let in_thick = |p: &&BoundaryPoint<D>| thin_place(self, &p.r, dp, 1e-3 * dp).is_none();
        let thick: Vec<Vector<D>> = points.iter().filter(in_thick).map(|p| p.r).collect();
        let middle = middle_points(self, &thick, dp, dp);
        if !middle.is_empty() {
            points.retain(|p| in_thick(&p));
            points.extend(middle.into_iter().map(|r| BoundaryPoint { r, layer: 0 }));
        }
        points
    }
}

/// Returns the points that are at least `distance` from all earlier points.
fn thinned<const D: usize>(points: Vec<BoundaryPoint<D>>, distance: f64) -> Vec<BoundaryPoint<D>> {
    let kept = spacing_flags(&points.iter().map(|p| p.r).collect::<Vec<_>>(), 0, distance);
    points.into_iter().zip(kept).filter_map(|(p, keep)| keep.then_some(p)).collect()
}

/// Visits every index vector from `low` to `high` (inclusive), the first axis fastest.
pub(super) fn for_each_index<const D: usize>(low: &[i64; D], high: &[i64; D], mut visit: impl FnMut(&[i64; D])) {
    if (0..D).any(|i| low[i] > high[i]) {
        return;
    }
    let mut at = *low;
    loop {
        visit(&at);
        let Some(axis) = (0..D).find(|&i| at[i] < high[i]) else { return };
        at[axis] += 1;
        at[..axis].copy_from_slice(&low[..axis]);
    }
}

/// Visits the same index vectors as [`for_each_index`], but skips most of the vectors that lie `layers` or more cells
/// inside the faces. In a large tank the function skips nearly all vectors.
fn each_outer<const D: usize>(low: &[i64; D], high: &[i64; D], layers: i64, mut visit: impl FnMut(&[i64; D])) {
    let mut rows = *high;
    rows[0] = low[0];
    for_each_index(low, &rows, |row| {
        let inside = (1..D).all(|i| row[i] - low[i] >= layers && high[i] - row[i] >= layers);
        let leaps = inside && high[0] - low[0] >= 2 * layers;
        let mut at = *row;
        while at[0] <= high[0] {
            visit(&at);
            at[0] = if leaps && at[0] == low[0] + layers - 1 { high[0] - layers + 1 } else { at[0] + 1 };
        }
    });
}

/// Returns the number of cells of about `dp` along `length`; at least one cell.
fn parts(length: f64, dp: f64) -> i64 {
    ((length / dp).round() as i64).max(1)
}

/// The rows of boundary particles across a box.
#[derive(Clone, Copy)]
enum Rows {
    /// In the middle of `count` equal cells of a `length` (m), so that the lattice goes on.
    Cells { count: i64, length: f64 },
    /// `count` rows, the outer ones `span` (m) apart.
    Spread { count: i64, span: f64 },
}

/// Lengths of a box, dp, between which its rows are placed by the water that they displace. Shorter ones have one row. In longer ones
/// equal cells err by up to 3.5 %, and their outer rows lie nearer to half a dp from the faces, as in a wall with water on one side.
const THIN_BOX: [f64; 2] = [1.45, 3.0];

/// Share of the distance of the outer faces of the rows' cells in the thickness that n rows displace, –; the rest is n dp. Plates of one
/// to three rows in still water, 0.25 to 1.25 dp apart, displace this within 0.06 dp (2-D, h = 1.7 dp).
const BY_DISTANCE: f64 = 0.71;

impl Rows {
    /// The rows across a `length` (m). Equal cells of a thin box that is no whole number of dp would displace up to a sixth too much or
    /// too little.
    fn across(length: f64, dp: f64) -> Self {
        let (count, ratio) = (parts(length, dp), length / dp);
        if !(THIN_BOX[0]..=THIN_BOX[1]).contains(&ratio) || (ratio - count as f64).abs() < 1e-6 {
            return Self::Cells { count, length };
        }
        let count = count.max(2);
        let by_count = (1.0 - BY_DISTANCE) * count as f64 * dp;
        Self::Spread { count, span: (length - by_count) / BY_DISTANCE - dp }
    }

    fn count(self) -> i64 {
        let (Self::Cells { count, .. } | Self::Spread { count, .. }) = self;
        count
    }

    /// The place (m) of row number `at` from the middle.
    fn place(self, at: i64) -> f64 {
        match self {
            Self::Cells { count, length } => ((at as f64 + 0.5) / count as f64 - 0.5) * length,
            Self::Spread { count, span } => (at as f64 / (count - 1) as f64 - 0.5) * span,
        }
    }
}

fn box_skin<const D: usize>(size: &Vector<D>, dp: f64, layers: usize) -> Vec<BoundaryPoint<D>> {
    let rows: [Rows; D] = std::array::from_fn(|i| Rows::across(size[i], dp));
    let n = rows.map(Rows::count);
    let mut skin = Vec::new();
    each_outer(&[0; D], &n.map(|n| n - 1), layers as i64, |at| {
        let depth = (0..D).map(|i| at[i].min(n[i] - 1 - at[i])).min().unwrap_or(0) as usize;
        if depth < layers {
            let r = Vector::from_fn(|i, _| rows[i].place(at[i]));
            skin.push(BoundaryPoint { r, layer: depth as u8 });
        }
    });
    skin
}

/// Largest distance between the outer face of a tank and the lattice of the water, dp, at which its walls continue that
/// lattice.
const OFF_LATTICE: f64 = 0.1;

/// Generates the boundary particles of a tank. A wall has round(thickness/dp) cells across: the cells of the hollow's
/// lattice if those end at the outer face, else cells that divide the thickness evenly.
fn tank_skin<const D: usize>(size: &Vector<D>, thickness: f64, dp: f64, layers: usize) -> Vec<BoundaryPoint<D>> {
    let n: [i64; D] = std::array::from_fn(|i| parts(size[i], dp));
    let (wall, layers) = (parts(thickness, dp), layers as i64);
    let place = |i: usize, at: i64| {
        let (cell, outside) = (size[i] / n[i] as f64, at < 0 || at >= n[i]);
        if !outside || (wall as f64 * cell - thickness).abs() <= OFF_LATTICE * dp {
            return (at as f64 + 0.5) * size[i] / n[i] as f64;
        }
        let start = if at < 0 { 0.0 } else { size[i] };
        start + ((at - if at < 0 { 0 } else { n[i] }) as f64 + 0.5) * thickness / wall as f64
    };
    // The number of cells from the hollow, one for a cell beside it, and the number of cells from the outer face.
    let from_hollow = |i: usize, at: i64| (-at).max(at - (n[i] - 1));
    let from_outside = |i: usize, at: i64| (at + wall).min(n[i] - 1 - at + if i == D - 1 { 0 } else { wall });
    let mut rows: [i64; D] = std::array::from_fn(|i| if i == D - 1 { n[i] - 1 } else { n[i] - 1 + wall });
    rows[0] = -wall;
    let mut skin = Vec::new();
    for_each_index(&[-wall; D], &rows, |row| {
        let inner = (1..D).map(|i| from_hollow(i, row[i])).max().unwrap_or(0);
        let outer = (1..D).map(|i| from_outside(i, row[i])).min().unwrap_or(0);
        let crosses_floor = inner > 0 && inner.min(outer + 1) <= layers;
        let beside_hollow = if crosses_floor { 0..n[0] } else { 0..0 };
        for at in (-wall..0).chain(beside_hollow).chain(n[0]..n[0] + wall) {
            let depth = (inner.max(from_hollow(0, at)) - 1).min(outer).min(from_outside(0, at));
            if depth < layers {
                let r = Vector::from_fn(|i, _| place(i, if i == 0 { at } else { row[i] }));
                skin.push(BoundaryPoint { r, layer: depth as u8 });
            }
        }
    });
    skin
}

/// Returns evenly spaced points, about `dp` apart, on a circle of radius r around the origin, as (x, y).
fn ring(r: f64, dp: f64) -> Vec<(f64, f64)> {
    let mut n = parts(TAU * r.max(0.0), dp);
    while n > 1 && 2.0 * r * (PI / n as f64).sin() < MIN_SPACING * dp {
        n -= 1;
    }
    if n == 1 {
        return vec![(0.0, 0.0)];
    }
    let at = |i: i64| (TAU * i as f64 / n as f64).sin_cos();
    (0..n).map(|i| (r * at(i).1, r * at(i).0)).collect()
}

/// Returns the concentric layers as (layer, radius); the last layer may be a core of radius zero.
fn shells(radius: f64, dp: f64) -> impl Iterator<Item = (usize, f64)> {
    (0..)
        .map(move |k| (k, radius - (k as f64 + 0.5) * dp))
        .take_while(move |&(k, r)| r > -0.15 * dp || k == 0)
        .map(|(k, r)| (k, r.max(0.0)))
}

/// Generates the boundary particles of a cylinder: slices across the axis, each a disc of rings.
fn cylinder_skin<const D: usize>(
    length: f64,
    radius: f64,
    axis: usize,
    dp: f64,
    layers: usize,
) -> Vec<BoundaryPoint<D>> {
    let n = parts(length, dp);
    let mut skin = Vec::new();
    for i in 0..n {
        let depth = i.min(n - 1 - i) as usize;
        let along = ((i as f64 + 0.5) / n as f64 - 0.5) * length;
        for (k, r) in shells(radius, dp).filter(|(k, _)| depth.min(*k) < layers) {
            let layer = depth.min(k) as u8;
            skin.extend(ring(r, dp).into_iter().map(|(x, y)| BoundaryPoint { r: around(axis, along, x, y), layer }));
        }
    }
    skin
}

/// Returns the point at `along` on the axis, with the coordinates `x` and `y` across the axis.
fn around<const D: usize>(axis: usize, along: f64, x: f64, y: f64) -> Vector<D> {
    let mut r = Vector::zeros();
    r[(axis + 1) % D] = x;
    r[(axis + 2) % D] = y;
    r[axis] = along;
    r
}

/// Generates the boundary particles of a capsule; a ball is a capsule of length zero.
fn capsule_skin<const D: usize>(
    length: f64,
    radius: f64,
    axis: usize,
    dp: f64,
    layers: usize,
) -> Vec<BoundaryPoint<D>> {
    let mut skin = Vec::new();
    for (k, r) in shells(radius, dp).take(layers) {
        let mut push = |p: Vector<D>| skin.push(BoundaryPoint { r: p, layer: k as u8 });
        if r < 0.3 * dp {
            let n = parts(length, dp);
            (0..n).for_each(|i| push(around(axis, ((i as f64 + 0.5) / n as f64 - 0.5) * length, 0.0, 0.0)));
        } else if D == 2 {
            let outline = 2.0 * length + TAU * r;
            let n = parts(outline, dp);
            for i in 0..n {
                let s = outline * i as f64 / n as f64;
                // The profile runs down along one side and up along the other.
                let half = 0.5 * outline;
                let (side, s) = if s < half { (1.0, s) } else { (-1.0, s - half) };
                let (along, across) = profile(s, length, r);
                let mut p = Vector::zeros();
                (p[axis], p[1 - axis]) = (side * along, side * across);
                push(p);
            }
        } else {
            hoops(length, r, axis, dp, &mut push);
        }
    }
    skin
}

/// Returns the point of a capsule's profile at arc length `s` from its top, as (along the axis, across the axis).
fn profile(s: f64, length: f64, r: f64) -> (f64, f64) {
    let quarter = 0.5 * PI * r;
    if s < quarter {
        let (sin, cos) = (s / r).sin_cos();
        (0.5 * length + r * cos, r * sin)
    } else if s < quarter + length {
        (0.5 * length - (s - quarter), r)
    } else {
        let (sin, cos) = ((s - length) / r).sin_cos();
        (r * cos - 0.5 * length, r * sin)
    }
}

/// Generates hoops around the axis of a capsule of radius `r`, one dp apart from pole to pole. The number of points in
/// each hoop keeps the running total at one point per dp² of surface.
fn hoops<const D: usize>(length: f64, r: f64, axis: usize, dp: f64, push: &mut impl FnMut(Vector<D>)) {
    let arc = PI * r + length;
    let m = parts(arc, dp);
    let (mut placed, mut turn) = (0, 0.0);
    for j in 0..m {
        let (along, across) = profile(arc * (j as f64 + 0.5) / m as f64, length, r);
        // Archimedes' theorem: a zone of a sphere has the same area as the zone of the cylinder around the sphere.
        let (end, _) = profile(arc * (j + 1) as f64 / m as f64, length, r);
        let area = TAU * r * (0.5 * length + r - end);
        let n = ((area / (dp * dp)).round() as i64 - placed).max(1);
        placed += n;
        for i in 0..n {
            let (sin, cos) = (turn + TAU * i as f64 / n as f64).sin_cos();
            push(around(axis, along, across * cos, across * sin));
        }
        turn += PI / n as f64; // stagger the next hoop
    }
}

fn compound_skin<const D: usize>(parts: &[(Pose<D>, Shape<D>)], dp: f64, layers: usize) -> Vec<BoundaryPoint<D>> {
    let mut skin = Vec::new();
    for (i, (pose, part)) in parts.iter().enumerate() {
        for p in part.boundary_points(dp, layers) {
            let r = pose.point(&p.r);
            let depth = (p.layer as f64 + 0.5) * dp;
            let buried = parts
                .iter()
                .enumerate()
                .any(|(j, (at, other))| j != i && other.signed_distance(&at.local(&r)) < -depth * (1.0 + 1e-6));
            if !buried {
                skin.push(BoundaryPoint { r, layer: p.layer });
            }
        }
    }
    thinned(skin, 0.5 * dp)
}

#[cfg(test)]
#[path = "../../tests/unit/geometry/boundary_points.rs"]
mod tests;
