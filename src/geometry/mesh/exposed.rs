//! The exposed surface of a mesh whose parts touch: its facets without the areas where two of them lie back to back.
//!
//! The water reaches neither side of such an area. The two facets cancel in volumes and moments, but they are no surface for
//! distances.

use rayon::prelude::*;

use super::{Mesh, facet_normal, shells};
use crate::math::Vector;

/// Facets are back to back if their normals are more than this angle apart (as −cosine; 177.4°).
const OPPOSED: f64 = 0.999;

/// Largest gap between two facets back to back, and least width of an area, over the size of the mesh: the distance within which
/// corners are joined.
const TOUCHING: f64 = 1e-6;

/// Largest overlap of two facets of the same shell, over the size of the mesh. Behind facets a larger distance apart is material.
const ROUND_OFF: f64 = 1e-9;

/// A flat convex polygon.
type Polygon = Vec<Vector<3>>;

/// The surface of a mesh without the areas back to back.
pub(super) struct Exposed {
    pub(super) triangles: Vec<[Vector<3>; 3]>,
    /// Number of facets that are hidden, in whole or in part.
    pub(super) hidden: usize,
    /// Distance (m) within which the edges of triangles meet.
    pub(super) reach: f64,
}

/// Returns the exposed surface, or `None` if no facets lie back to back. `overlap`: depth (m) by which parts may overlap.
pub(super) fn exposed(mesh: &Mesh, overlap: f64) -> Option<Exposed> {
    let size = mesh.bounds.size().max();
    let gap = TOUCHING * size;
    let overlap = overlap.max(gap);
    let normals: Vec<Option<Vector<3>>> =
        (0..mesh.facets.len()).map(|i| facet_normal(&mesh.facet_corners(i))).collect();
    let opposed = |a: usize, b: usize| {
        let shared = mesh.facets[a].iter().filter(|p| mesh.facets[b].contains(p)).count();
        let normals = normals[a].zip(normals[b]);
        shared < 2 && normals.is_some_and(|(a, b)| a.dot(&b) < -OPPOSED)
    };
    // Each pair in both orders: the search around a large facet is limited.
    let mut pairs: Vec<(usize, usize)> = (0..mesh.facets.len())
        .into_par_iter()
        .flat_map_iter(|a| mesh.tree.near(a as u32, overlap).filter(move |b| *b != a).map(move |b| (a, b)))
        .filter(|(a, b)| opposed(*a, *b))
        .flat_map_iter(|(a, b)| [(a, b), (b, a)])
        .collect();
    if pairs.is_empty() {
        return None;
    }
    pairs.par_sort_unstable();
    pairs.dedup();
    let shells = shells::shell_volumes(&mesh.points, &mesh.facets);
    let least = |a: usize, b: usize| {
        let ((one, volume), (other, other_volume)) = (shells[a], shells[b]);
        if one != other && volume > 0.0 && other_volume > 0.0 { -overlap } else { -ROUND_OFF * size }
    };
    let groups: Vec<&[(usize, usize)]> = pairs.chunk_by(|p, q| p.0 == q.0).collect();
    let cut: Vec<(usize, Vec<Polygon>)> = groups
        .into_par_iter()
        .filter_map(|group| {
            let a = group[0].0;
            let (corners, normal) = (mesh.facet_corners(a), normals[a]?);
            let covers = group.iter().filter_map(|&(_, b)| {
                let covered = covered_area(&corners, &normal, &mesh.facet_corners(b), least(a, b), gap);
                Some(covered).filter(|area| width(area) > gap)
            });
            let covers: Vec<Polygon> = covers.collect();
            let left = covers.iter().fold(vec![corners.to_vec()], |pieces, cover| {
                pieces.into_iter().flat_map(|piece| subtract(piece, cover, &normal, gap)).collect()
            });
            (!covers.is_empty()).then_some((a, left))
        })
        .collect();
    if cut.is_empty() {
        return None;
    }
    let mut whole = vec![true; mesh.facets.len()];
    cut.iter().for_each(|(facet, _)| whole[*facet] = false);
    let mut triangles: Vec<_> = (0..whole.len()).filter(|i| whole[*i]).map(|i| mesh.facet_corners(i)).collect();
    for piece in cut.iter().flat_map(|(_, pieces)| pieces) {
        let fan = (1..piece.len() - 1).map(|i| [piece[0], piece[i], piece[i + 1]]);
        triangles.extend(fan.filter(|triangle| width(triangle) > ROUND_OFF * size));
    }
    (!triangles.is_empty()).then_some(Exposed { triangles, hidden: cut.len(), reach: 2.0 * overlap })
}

/// Returns the area of the facet `a` with this normal that the facet `b` covers: where `b` is at heights from `least` to `most` (m)
/// over it. It runs counter-clockwise about the normal.
fn covered_area(a: &[Vector<3>; 3], normal: &Vector<3>, b: &[Vector<3>; 3], least: f64, most: f64) -> Polygon {
    let mut area = vec![b[2], b[1], b[0]];
    for i in 0..3 {
        let inward = normal.cross(&(a[(i + 1) % 3] - a[i]));
        area = clip(&area, &inward, inward.dot(&a[i]));
    }
    let height = normal.dot(&a[0]);
    area = clip(&clip(&area, normal, height + least), &-normal, -height - most);
    area.iter().map(|x| x - normal * (normal.dot(x) - height)).collect()
}

/// Returns the part of a polygon where the product with `normal` is at least `from`.
fn clip(polygon: &[Vector<3>], normal: &Vector<3>, from: f64) -> Polygon {
    let mut part = Vec::with_capacity(polygon.len() + 1);
    for (i, x) in polygon.iter().enumerate() {
        let y = &polygon[(i + 1) % polygon.len()];
        let (here, next) = (normal.dot(x) - from, normal.dot(y) - from);
        if here >= 0.0 {
            part.push(*x);
        }
        if here * next < 0.0 {
            part.push(x + (y - x) * (here / (here - next)));
        }
    }
    part
}

/// Returns the parts of `piece` outside `cover`, both counter-clockwise about `normal`. Parts narrower than `least` (m) are left out.
fn subtract(piece: Polygon, cover: &Polygon, normal: &Vector<3>, least: f64) -> Vec<Polygon> {
    let (mut rest, mut parts) = (piece.clone(), Vec::new());
    for (i, x) in cover.iter().enumerate() {
        let inward = normal.cross(&(cover[(i + 1) % cover.len()] - x));
        let outside = clip(&rest, &-inward, -inward.dot(x));
        rest = clip(&rest, &inward, inward.dot(x));
        if width(&outside) > least {
            parts.push(outside);
        }
        if width(&rest) <= least {
            return vec![piece];
        }
    }
    parts
}

/// Returns the area of a polygon over half its longest distance from a corner, m.
fn width(polygon: &[Vector<3>]) -> f64 {
    let Some((first, others)) = polygon.split_first() else { return 0.0 };
    let area: Vector<3> = others.windows(2).map(|pair| (pair[0] - first).cross(&(pair[1] - first))).sum();
    let longest = others.iter().map(|x| (x - first).norm()).fold(0.0, f64::max);
    if longest > 0.0 { area.norm() / longest } else { 0.0 }
}
