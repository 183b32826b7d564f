//! Area of the part of a shape above a level, projected along a direction: the area of its silhouette.
//!
//! For a flow along the unit vector u it is ∫ max(−n·u, 0) dA over the surface above the level, where a part that another one hides
//! counts once. That of a convex shape is the sum over its facets. Of others it is the union of the projections: exact in 2-D, along
//! lines across the flow in 3-D.

use super::{
    Shape,
    exposed::{OFFSET, area_vector, exposed_facets, middle},
    submerged_volume::Facet,
};
use crate::math::{Pose, Vector};

/// Number of lines across the flow on which shadows are found in 3-D, at least.
const LINES: usize = 128;

/// Most facets of a shape that is tested for convexity: the test takes the square of their number.
const MOST_CONVEX: usize = 10_000;

/// The facets of the surface of `shape` in its own frame, without those that other parts cover. One that is covered in part is whole:
/// its covered part lies in the shadow of what covers it.
fn surface_facets<const D: usize>(shape: &Shape<D>) -> Vec<Facet<D>> {
    exposed_facets(shape, &leaf_facets, &|cover, facet, into| cover.add_unless_covered(facet, into))
}

/// The facets of a shape that is no compound, in its own frame.
pub(super) fn leaf_facets<const D: usize>(shape: &Shape<D>) -> Vec<Facet<D>> {
    match shape {
        Shape::Ball { radius } => Shape::Capsule { length: 0.0, radius: *radius, axis: D - 1 }.facets(),
        _ => shape.outer_facets(),
    }
}

/// The surface of a shape in a flow.
#[derive(Clone, Debug)]
pub(crate) struct Silhouette<const D: usize> {
    /// Facets in the frame of the shape, m.
    facets: Vec<Facet<D>>,
    is_convex: bool,
}

impl<const D: usize> Silhouette<D> {
    /// The surface of `shape`.
    pub(crate) fn new(shape: &Shape<D>) -> Self {
        let facets = surface_facets(shape);
        let is_convex = match shape {
            Shape::Box { .. } | Shape::Ball { .. } | Shape::Capsule { .. } | Shape::Cylinder { .. } => true,
            _ => is_convex(&facets, OFFSET * shape.bounds().size().max()),
        };
        Self { facets, is_convex }
    }

    /// The area (m²; m in 2-D) at `pose` above the height `level` (m), projected along the unit vector `way` of a flow, and its
    /// centroid (m). The centroid of no area is the position of the pose.
    pub(crate) fn projected_area(&self, pose: &Pose<D>, level: f64, way: &Vector<D>) -> (f64, Vector<D>) {
        let mut sum = (0.0, Vector::zeros());
        let mut windward = Vec::new();
        for facet in &self.facets {
            split_dry(facet.map(|x| pose.point(&x)), level, &mut |facet| {
                let area = -area_vector(&facet).dot(way);
                if area > 0.0 && self.is_convex {
                    sum.0 += area;
                    sum.1 += middle(&facet) * area;
                } else if area > 0.0 {
                    windward.push(facet);
                }
            });
        }
        if !self.is_convex {
            sum = union_of_projections(&windward, way);
            // No torque depends on the place along the way.
            sum.1 += way * (way.dot(&pose.position) * sum.0);
        }
        if sum.0 > 0.0 { (sum.0, sum.1 / sum.0) } else { (0.0, pose.position) }
    }
}

/// Whether all facets lie on or behind the plane of each of them, up to `slack` (m).
fn is_convex<const D: usize>(facets: &[Facet<D>], slack: f64) -> bool {
    let has_all_behind = |facet: &Facet<D>| {
        let normal = area_vector(facet);
        let most = slack * normal.norm();
        facets.iter().flatten().all(|x| (x - facet[0]).dot(&normal) <= most)
    };
    facets.len() <= MOST_CONVEX && facets.iter().all(has_all_behind)
}

/// The area (m²; m in 2-D) of the union of the projections of `facets` along the unit vector `way`, and its first moment across the
/// way.
fn union_of_projections<const D: usize>(facets: &[Facet<D>], way: &Vector<D>) -> (f64, Vector<D>) {
    // The axis nearest to the vertical of those that are well across the way.
    let axis = if D == 3 && way[D - 1].abs() < 0.9 { D - 1 } else { way.iamin() };
    let unit = Vector::from_fn(|i, _| if i == axis { 1.0 } else { 0.0 });
    let up: Vector<D> = (unit - way * way[axis]).normalize();
    if D == 2 {
        let mut shadows: Vec<[f64; 2]> =
            facets.iter().map(|facet| sorted([facet[0], facet[1]].map(|x| x.dot(&up)))).collect();
        let [length, moment] = union(&mut shadows);
        return (length, up * moment);
    }
    let side = Vector::from_fn(|i, _| {
        let (j, k) = ((i + 1) % D, (i + 2) % D);
        way[j] * up[k] - way[k] * up[j]
    });
    let flat: Vec<[[f64; 2]; 3]> =
        facets.iter().map(|f| [0, 1, 2].map(|k| [f[k % D].dot(&side), f[k % D].dot(&up)])).collect();
    let lines = lines_between(flat.iter().flatten().map(|x| x[1]).collect());
    let mut shadows = vec![Vec::new(); lines.len()];
    for corners in &flat {
        let [least, most] = [f64::min, f64::max].map(|of| corners[1..].iter().map(|x| x[1]).fold(corners[0][1], of));
        let first = lines.partition_point(|[v, _]| *v < least);
        for (own, [v, _]) in shadows.iter_mut().zip(&lines).skip(first).take_while(|(_, [v, _])| *v <= most) {
            let crossings = [[0, 1], [1, 2], [2, 0]].map(|[i, j]| crossing(&corners[i], &corners[j], *v));
            let crossings = || crossings.iter().flatten().copied();
            own.push([crossings().fold(f64::INFINITY, f64::min), crossings().fold(f64::NEG_INFINITY, f64::max)]);
        }
    }
    let mut sum = (0.0, Vector::zeros());
    for (own, [v, width]) in shadows.iter_mut().zip(&lines) {
        let [length, moment] = union(own);
        sum.0 += length * width;
        sum.1 += (side * moment + up * (v * length)) * *width;
    }
    sum
}

/// Lines across the flow between the lowest and the highest of these `heights` (m): the height of each and the width (m) for which it
/// stands. If the heights are few, as those of boxes, no width reaches across one of them.
fn lines_between(mut heights: Vec<f64>) -> Vec<[f64; 2]> {
    heights.sort_by(f64::total_cmp);
    let [Some(low), Some(high)] = [heights.first().copied(), heights.last().copied()] else { return Vec::new() };
    let widest = (high - low) / LINES as f64;
    heights.dedup_by(|next, last| *next - *last < OFFSET * (high - low));
    if heights.len() > LINES {
        heights = vec![low, high];
    }
    let slab = |ends: &[f64]| {
        let count = ((ends[1] - ends[0]) / widest).ceil().max(1.0);
        let (start, width) = (ends[0], (ends[1] - ends[0]) / count);
        (0..count as usize).map(move |i| [start + (i as f64 + 0.5) * width, width])
    };
    heights.windows(2).flat_map(slab).collect()
}

/// Where the edge from `a` to `b` crosses the height `v`.
fn crossing(a: &[f64; 2], b: &[f64; 2], v: f64) -> Option<f64> {
    let is_between = (a[1] - v) * (b[1] - v) <= 0.0 && a[1] != b[1];
    is_between.then(|| a[0] + (b[0] - a[0]) * (v - a[1]) / (b[1] - a[1]))
}

fn sorted([a, b]: [f64; 2]) -> [f64; 2] {
    [a.min(b), a.max(b)]
}

/// The length of the union of intervals and its first moment.
fn union(intervals: &mut [[f64; 2]]) -> [f64; 2] {
    intervals.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let (mut sum, mut reached) = ([0.0; 2], f64::NEG_INFINITY);
    for [from, to] in intervals.iter() {
        let from = from.max(reached);
        if *to <= from {
            continue;
        }
        sum[0] += to - from;
        sum[1] += 0.5 * (to + from) * (to - from);
        reached = *to;
    }
    sum
}

/// Gives `each` the part of a facet above the level. It splits a facet that crosses the level.
fn split_dry<const D: usize>(facet: Facet<D>, level: f64, each: &mut impl FnMut(Facet<D>)) {
    let height = facet.map(|x| x[D - 1] - level);
    let above = height.iter().position(|z| *z > 0.0);
    let below = height.iter().position(|z| *z < 0.0);
    match (above, below) {
        (Some(i), Some(j)) => {
            let mut cut = facet[i] + (facet[j] - facet[i]) * (height[i] / (height[i] - height[j]));
            cut[D - 1] = level;
            for end in [i, j] {
                let mut part = facet;
                part[end] = cut;
                split_dry(part, level, each);
            }
        }
        (Some(_), None) => each(facet),
        (None, _) => {}
    }
}

#[cfg(test)]
#[path = "../../tests/unit/geometry/projected_area.rs"]
mod tests;
