//! The closed surface of a hollow: the faces of the solid that border it, and the plane of its spill level.
//!
//! Facets of a part of a compound are cut along the planes of the other parts' facets, so that each piece is covered or free.

use super::{
    Shape,
    exposed::{OFFSET, area_vector, middle},
    projected_area::leaf_facets,
    submerged_volume::Facet,
};
use crate::math::{Pose, Vector};

/// Most pairs of facets of different parts of a compound.
const MOST_PAIRS: usize = 20_000_000;

/// Most pieces into which the planes of other parts divide a facet, and most pieces in all.
const MOST_PIECES: usize = 20_000;

/// Depths (cells) of the plane below the spill level that are tried: the grid gives the level of a rim that is not flat too high.
const LOWERED: [f64; 5] = [1e-6, 0.1, 0.25, 0.5, 1.0];

/// Distance (cells) from all faces, and below the plane, of the place before a face at which the space that it borders is looked up.
const APART: [f64; 2] = [1.0, 0.6];

/// Most steps to that place.
const STEPS: usize = 12;

/// Largest relative difference of two values that are equal for a closed surface.
const CLOSED: f64 = 1e-6;

/// What lies at a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Space {
    /// The hollow in question.
    Hollow,
    /// The solid.
    Material,
    /// Neither.
    Other,
}

/// The facets of the surface of `shape` without covered parts; `None` if they are too many.
pub(super) fn free_facets<const D: usize>(shape: &Shape<D>) -> Option<Vec<Facet<D>>> {
    let mut leaves = Vec::new();
    add_leaves(shape, &Pose::identity(), &mut leaves);
    let facets: Vec<Vec<Facet<D>>> = leaves
        .iter()
        .map(|(pose, leaf)| leaf_facets(leaf).into_iter().map(|facet| facet.map(|x| pose.point(&x))).collect())
        .collect();
    if leaves.len() == 1 {
        return facets.into_iter().next();
    }
    let count: usize = facets.iter().map(Vec::len).sum();
    if count.saturating_mul(count) > MOST_PAIRS {
        return None;
    }
    let offset = OFFSET * shape.bounds().size().max();
    let mut free = Vec::new();
    for (own, part) in facets.iter().enumerate() {
        let others = || (0..leaves.len()).filter(|i| *i != own);
        for facet in part {
            let step = area_vector(facet).try_normalize(0.0).unwrap_or_else(Vector::zeros) * offset;
            let mut pieces = vec![*facet];
            if free.len() > MOST_PIECES {
                return None;
            }
            for cut in others().flat_map(|i| &facets[i]) {
                let normal = area_vector(cut);
                if box_meets(facet, cut, offset) && normal.norm() > 0.0 {
                    pieces =
                        pieces.into_iter().flat_map(|piece| split(piece, cut, &normal.normalize(), offset)).collect();
                    if pieces.len() > MOST_PIECES {
                        return None;
                    }
                }
            }
            let is_free = |piece: &Facet<D>| {
                let x = middle(piece) + step;
                others().all(|i| leaves[i].1.signed_distance(&leaves[i].0.local(&x)) >= 0.0)
            };
            free.extend(pieces.into_iter().filter(is_free));
        }
    }
    Some(free)
}

/// Adds the parts of a shape that are no compound, with their poses.
fn add_leaves<'a, const D: usize>(shape: &'a Shape<D>, pose: &Pose<D>, into: &mut Vec<(Pose<D>, &'a Shape<D>)>) {
    match shape {
        Shape::Compound(parts) => parts.iter().for_each(|(inner, part)| add_leaves(part, &pose.then(inner), into)),
        _ => into.push((*pose, shape)),
    }
}

/// Whether the boxes around two facets are at most `slack` (m) apart.
fn box_meets<const D: usize>(a: &Facet<D>, b: &Facet<D>, slack: f64) -> bool {
    let range = |facet: &Facet<D>, i: usize| {
        facet.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x[i]), high.max(x[i])])
    };
    (0..D).all(|i| {
        let ([low, high], [from, to]) = (range(a, i), range(b, i));
        low <= to + slack && from <= high + slack
    })
}

/// The pieces of a facet on both sides of the plane of `cut`, if their boxes meet. Corners within `slack` (m) count as on the plane.
fn split<const D: usize>(facet: Facet<D>, cut: &Facet<D>, normal: &Vector<D>, slack: f64) -> Vec<Facet<D>> {
    let heights = facet.map(|x| {
        let height = normal.dot(&(x - cut[0]));
        if height.abs() < slack { 0.0 } else { height }
    });
    let mut pieces = Vec::new();
    if box_meets(&facet, cut, slack) {
        split_at(facet, heights, &mut |piece, _| pieces.push(piece));
    } else {
        pieces.push(facet);
    }
    pieces
}

/// Gives `each` the pieces of a facet with these heights of its corners, of which none crosses the height 0, and their heights.
fn split_at<const D: usize>(facet: Facet<D>, height: [f64; D], each: &mut impl FnMut(Facet<D>, [f64; D])) {
    let above = height.iter().position(|z| *z > 0.0);
    let below = height.iter().position(|z| *z < 0.0);
    let (Some(i), Some(j)) = (above, below) else { return each(facet, height) };
    let cut = facet[i] + (facet[j] - facet[i]) * (height[i] / (height[i] - height[j]));
    for end in [i, j] {
        let (mut part, mut part_height) = (facet, height);
        (part[end], part_height[end]) = (cut, 0.0);
        split_at(part, part_height, each);
    }
}

/// Returns the surface of the hollow that `space` tells, with normals out of it, from the free `surface` of `shape`. `lid`: a point of
/// the hollow, and its spill level (m) along the unit vector `up`; none if it is closed. `cell`: of the grid that `space` is looked up
/// in, m. Returns `None` if the faces do not close.
pub(super) fn hollow_facets<const D: usize>(
    shape: &Shape<D>,
    surface: &[Facet<D>],
    up: &Vector<D>,
    lid: Option<(Vector<D>, f64)>,
    cell: f64,
    space: impl Fn(&Vector<D>) -> Space,
) -> Option<Vec<Facet<D>>> {
    // In corners the place before a face lies too near to another one for the grid: it moves away from both.
    let borders = |piece: &Facet<D>, level: f64| {
        let Some(n) = area_vector(piece).try_normalize(0.0) else { return false };
        let below = |x: Vector<D>| x - up * (up.dot(&x) - level + APART[1] * cell).max(0.0);
        let first = space(&below(middle(piece) + n * (APART[1] * cell)));
        if first != Space::Material {
            return first == Space::Hollow;
        }
        let mut x = middle(piece) + n * (1e-2 * cell);
        for _ in 0..STEPS {
            let (distance, away) = shape.distance_and_normal(&x, 1e-3 * cell);
            x = below(x + away * (APART[0] * cell - distance).max(0.0));
        }
        space(&x) == Space::Hollow
    };
    let lowered = LOWERED.iter().take(if lid.is_some() { LOWERED.len() } else { 1 });
    lowered.map(|lowered| lowered * cell).find_map(|lowered| {
        let level = lid.map_or(f64::INFINITY, |(_, level)| level - lowered);
        let mut all = Vec::new();
        for facet in surface {
            let heights = facet.map(|x| if level.is_finite() { up.dot(&x) - level } else { -1.0 });
            split_at(*facet, heights, &mut |mut piece, heights| {
                if heights.iter().any(|height| *height > 0.0) || !borders(&piece, level) {
                    return;
                }
                let mut face = piece;
                face.swap(0, 1);
                all.push(face);
                // The edge at the plane bounds a piece of the plane, which reaches to a point common to all.
                let inner = heights.iter().position(|height| *height < 0.0);
                let ends = heights.iter().filter(|height| **height == 0.0).count();
                if let (Some(inner), Some((x, _)), true) = (inner, &lid, ends + 1 == D) {
                    piece[inner] = x + up * (level - up.dot(x));
                    all.push(piece);
                }
            });
        }
        (!all.is_empty() && is_closed(&all)).then_some(all)
    })
}

/// Whether the facets form a closed surface around a volume: their areas cancel, and their volume is the same along each axis.
fn is_closed<const D: usize>(facets: &[Facet<D>]) -> bool {
    let origin = facets[0][0];
    let (mut sum, mut all, mut volumes) = (Vector::<D>::zeros(), 0.0, Vector::<D>::zeros());
    for facet in facets {
        let area = area_vector(facet);
        sum += area;
        all += area.norm();
        volumes += area.component_mul(&(middle(facet) - origin));
    }
    let largest = volumes.max();
    sum.norm() <= CLOSED * all && largest > 0.0 && largest - volumes.min() <= CLOSED * largest
}
