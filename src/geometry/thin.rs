//! Parts of polygons and meshes between two nearly parallel faces less than a particle spacing apart: a single layer of
//! boundary particles in their middle, one for each dp² of the part (each dp of length in 2-D).

use std::f64::consts::PI;

use super::{
    Shape,
    cells::PointCells,
    packing,
    shell::{OPPOSITE, chosen},
};
use crate::math::{Bounds, Vector};

/// Faces are parallel if their normals are more than 160 degrees apart: −cos 160°. A blunter wedge is a tip.
const PARALLEL: f64 = 0.94;
/// Step of the search for the opposite face, limits of the thickness.
const SEARCH: f64 = 0.02;
/// Least distance of a particle from the rim of a thin part, dp.
const RIM: f64 = 0.45;
/// Least distance of a particle from those of thicker parts, dp.
const CLEAR: f64 = 0.75;
/// Edge of the small cells, dp.
const GRAIN: f64 = 0.5;

/// The two faces at a place of a thin part.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ThinPlace<const D: usize> {
    /// The point midway between the faces, m.
    pub middle: Vector<D>,
    /// Outward unit normal of one of the faces.
    pub normal: Vector<D>,
    /// Distance of the faces, m.
    pub thickness: f64,
}

/// Returns the faces on both sides of the part next to `x` (m), or `None` if they are `limit` (m) or more apart, or not
/// nearly parallel. `step` (m) is that of the differences for normals.
pub(crate) fn thin_place<const D: usize>(
    shape: &Shape<D>,
    x: &Vector<D>,
    limit: f64,
    step: f64,
) -> Option<ThinPlace<D>> {
    faces_around(shape, x, limit, step, PARALLEL)
}

/// Whether `x` (m) is beside a part with opposite faces, which are nearly parallel or form a wedge below 60°, less than `limit` (m)
/// apart. `step` (m) is that of the differences for normals.
pub(crate) fn is_between_opposite_faces<const D: usize>(
    shape: &Shape<D>,
    x: &Vector<D>,
    limit: f64,
    step: f64,
) -> bool {
    faces_around(shape, x, limit, step, OPPOSITE).is_some()
}

/// The faces on both sides of the part next to `x` (m) if they are less than `limit` (m) apart and the cosine between their outward
/// normals is below −`facing`. `step` (m) is that of the differences for normals.
fn faces_around<const D: usize>(
    shape: &Shape<D>,
    x: &Vector<D>,
    limit: f64,
    step: f64,
    facing: f64,
) -> Option<ThinPlace<D>> {
    let (distance, mut normal) = shape.distance_and_normal(x, step);
    if normal.norm() < 0.5 {
        normal = across(shape, x, step, facing)?;
    }
    let face = x - normal * distance;
    if shape.signed_distance(&(face - normal * limit)) <= 0.0 {
        return None;
    }
    let mut way = SEARCH * limit;
    // The first point outside may lie a step beyond the opposite face.
    while way < (1.0 + 2.0 * SEARCH) * limit {
        let exit = face - normal * way;
        let outside = shape.signed_distance(&exit);
        if outside > 1e-9 * limit {
            let thickness = way - outside;
            let opposite = shape.outward_normal(&exit, step);
            let is_thin = thickness > 0.0 && thickness < limit && normal.dot(&opposite) < -facing;
            return is_thin.then(|| ThinPlace { middle: face - normal * (0.5 * thickness), normal, thickness });
        }
        way += (-outside).max(SEARCH * limit);
    }
    None
}

/// Returns the normal at a point midway between two faces, where the gradient of the distance is zero.
fn across<const D: usize>(shape: &Shape<D>, x: &Vector<D>, step: f64, facing: f64) -> Option<Vector<D>> {
    (0..D).find_map(|axis| {
        let mut aside = Vector::zeros();
        aside[axis] = 2.0 * step;
        let [a, b] = [x + aside, x - aside].map(|x| shape.outward_normal(&x, step));
        (a.dot(&b) < -facing).then_some(a)
    })
}

/// Returns whether the part extends at least `distance` (m) from its middle in every direction along its faces.
fn clear_of_rim<const D: usize>(shape: &Shape<D>, place: &ThinPlace<D>, distance: f64) -> bool {
    let axis = place.normal.iamin();
    let mut e = Vector::zeros();
    e[axis] = 1.0;
    let u = (e - place.normal * place.normal[axis]).normalize();
    let inside = |way: &Vector<D>| shape.signed_distance(&(place.middle + way * distance)) < 0.0;
    if D == 2 {
        return inside(&u) && inside(&-u);
    }
    let [a, b] = [&place.normal, &u];
    let v = Vector::from_fn(|i, _| a[(i + 1) % D] * b[(i + 2) % D] - a[(i + 2) % D] * b[(i + 1) % D]);
    (0..8).all(|k| {
        let (sin, cos) = (0.25 * PI * f64::from(k)).sin_cos();
        inside(&(u * cos + v * sin))
    })
}

/// Returns the centres of the cells of edge `grain` (m) no farther than about `grain` from the faces of a shape.
pub(crate) fn face_cells<const D: usize>(shape: &Shape<D>, grain: f64) -> Vec<Vector<D>> {
    let bounds = shape.bounds();
    let doublings = (bounds.size().max() / grain).log2().ceil().max(0.0) as i32;
    let mut found = Vec::new();
    walk(shape, &((bounds.min + bounds.max) * 0.5), grain * 2f64.powi(doublings), grain, &mut found);
    found
}

/// Adds the small cells of a cube of edge `edge` (m) around `middle` that are near the faces.
fn walk<const D: usize>(shape: &Shape<D>, middle: &Vector<D>, edge: f64, grain: f64, found: &mut Vec<Vector<D>>) {
    let reach = 0.5 * edge * (D as f64).sqrt();
    if shape.signed_distance(middle).abs() > reach + grain {
        return;
    }
    if edge < 1.5 * grain {
        found.push(*middle);
        return;
    }
    for corner in 0..1usize << D {
        let side = |i: usize| if corner >> i & 1 == 1 { 0.25 } else { -0.25 };
        walk(shape, &(middle + Vector::from_fn(|i, _| side(i) * edge)), 0.5 * edge, grain, found);
    }
}

/// Returns whether a part of the shape is thinner than `limit` (m).
pub(super) fn has_thin_parts<const D: usize>(shape: &Shape<D>, limit: f64, dp: f64) -> bool {
    face_cells(shape, dp).iter().any(|x| thin_place(shape, x, limit, 1e-3 * dp).is_some())
}

/// Returns the particles of the parts that are thinner than `limit` (m); `others` are the particles of the shape's
/// thicker parts.
pub(super) fn middle_points<const D: usize>(
    shape: &Shape<D>,
    others: &[Vector<D>],
    limit: f64,
    dp: f64,
) -> Vec<Vector<D>> {
    let place = |x: &Vector<D>| thin_place(shape, x, limit, 1e-3 * dp);
    let near = PointCells::new(others, dp);
    let is_free = |x: &Vector<D>| {
        let mut free = true;
        near.visit_near(x, CLEAR * dp, |_, y| free &= (x - y).norm() >= CLEAR * dp);
        free
    };
    let (mut area, mut candidates) = (0.0, Vec::new());
    for x in face_cells(shape, GRAIN * dp) {
        let Some(found) = place(&x) else { continue };
        // The weights of the cells along a normal add up to one.
        area += (1.0 - (x - found.middle).norm() / (GRAIN * dp)).max(0.0);
        if is_free(&found.middle) && clear_of_rim(shape, &found, RIM * dp) {
            candidates.push(found.middle);
        }
    }
    if candidates.is_empty() {
        return Vec::new();
    }
    let wanted = (area * GRAIN.powi(D as i32 - 1)).round().max(1.0) as usize;
    let mut points = chosen(&candidates, wanted, dp);
    let many = points.len();
    let bounds = Bounds::around(&points).grown(packing::SUPPORT_RADIUS_DP * dp);
    points.extend(others.iter().copied().filter(|x| bounds.contains(x)));
    packing::spread_points(&mut points, many, dp, |_, from, x| {
        let moved = place(x).filter(|found| clear_of_rim(shape, found, RIM * dp));
        *x = moved.map_or(*from, |found| found.middle);
        0.0
    });
    points.truncate(many);
    points
}

#[cfg(test)]
#[path = "../../tests/unit/geometry/thin.rs"]
mod tests;
