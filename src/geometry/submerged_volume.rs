//! Submerged part of a shape, by the divergence theorem over its surface.
//!
//! With z the height above the water level, the volume below the level is ∫ z n_z dA over the wetted surface. The
//! waterplane, at z = 0, contributes nothing. The first moments are ∫ xᵢ z n_z dA and, along the vertical, ∫ ½ z² n_z
//! dA.

use std::f64::consts::{PI, TAU};

use super::{Shape, moments::tank_outer_bounds, wall::wall_outline};
use crate::math::{Bounds, Pose, Vector};

/// A facet of the surface: in 2-D an edge with the solid on its left; in 3-D a triangle, counter-clockwise seen from
/// outside.
pub(super) type Facet<const D: usize> = [Vector<D>; D];

/// Number of edges of a full circle. After scaling to the exact volume, the error at any level is at most 1e-5 of the
/// volume.
const ROUND: usize = 256;

impl<const D: usize> Shape<D> {
    /// Returns the volume (m³; m² in 2-D) of the shape at `pose` below the horizontal plane at height `level` (m), and
    /// the world position of that volume's centroid. If the whole shape is dry, the position is the centroid of the
    /// shape.
    ///
    /// The result is exact for shapes with flat sides and for balls. The error for capsules and cylinders is 1e-5 of
    /// the volume.
    pub fn submerged_volume(&self, pose: &Pose<D>, level: f64) -> (f64, Vector<D>) {
        let (volume, first) = self.below(pose, level);
        if volume > 0.0 { (volume, first / volume) } else { (0.0, pose.point(&self.volume_properties().centroid)) }
    }

    /// Returns the volume and its first moment ∫ x dV below `level`.
    fn below(&self, pose: &Pose<D>, level: f64) -> (f64, Vector<D>) {
        match self {
            Shape::Ball { radius } => ball_below(*radius, pose, level),
            Shape::Compound(parts) => parts.iter().fold((0.0, Vector::zeros()), |sum, (inner, part)| {
                let (volume, first) = part.below(&pose.then(inner), level);
                (sum.0 + volume, sum.1 + first)
            }),
            _ => {
                let mut sum = (0.0, Vector::zeros());
                for facet in self.facets() {
                    let facet = facet.map(|x| pose.point(&x));
                    let height = facet.map(|x| x[D - 1] - level);
                    add_wet(facet, height, level, &mut sum);
                }
                sum
            }
        }
    }

    /// Returns the facets of the surface; none of a ball or a compound.
    pub(super) fn facets(&self) -> Vec<Facet<D>> {
        match self {
            Shape::Box { .. } => box_facets(&self.bounds()),
            Shape::Capsule { length, radius, axis } => {
                let steps = ROUND * 3 / 8; // a half circle takes finer ones than a hoop: its error does not cancel
                let profile = (0..=2 * steps + 1).map(|i| {
                    let side = if i > steps { 1.0 } else { -1.0 };
                    let turn = 0.5 * PI * (i - usize::from(i > steps)) as f64 / steps as f64;
                    (radius * turn.sin(), side * 0.5 * length - radius * turn.cos())
                });
                self.turned_facets(&profile.collect::<Vec<_>>(), *axis, ROUND)
            }
            Shape::Cylinder { length, radius, axis } => {
                self.turned_facets(&[(*radius, -0.5 * length), (*radius, 0.5 * length)], *axis, ROUND)
            }
            Shape::Polygon { points } => edges(points),
            Shape::Polyline { points, thickness } => edges(&wall_outline(points, *thickness)),
            Shape::Tank { size, thickness } => {
                let mut all = box_facets(&tank_outer_bounds(size, *thickness));
                let hollow = box_facets(&Bounds { min: Vector::zeros(), max: *size });
                all.extend(hollow.into_iter().map(|mut facet| {
                    facet.swap(0, 1);
                    facet
                }));
                all
            }
            Shape::Mesh { mesh, .. } => mesh.triangles(),
            Shape::Ball { .. } | Shape::Compound(_) => Vec::new(), // have their own way in `below`
        }
    }

    /// Returns the same facets, without the areas of a mesh where two lie back to back.
    pub(super) fn outer_facets(&self) -> Vec<Facet<D>> {
        if let Shape::Mesh { mesh, .. } = self { mesh.exposed_triangles() } else { self.facets() }
    }

    /// Returns the facets of a shape of revolution from its profile of (radius, height along `axis`), with `segments`
    /// edges of a circle. The function scales the facets across the axis so that they enclose the exact volume.
    pub(super) fn turned_facets(&self, profile: &[(f64, f64)], axis: usize, segments: usize) -> Vec<Facet<D>> {
        let mut all = if D == 2 { mirrored(profile, axis) } else { revolved(profile, axis, segments) };
        let top = self.bounds().max[D - 1];
        let mut enclosed = (0.0, Vector::zeros());
        all.iter().for_each(|facet| add_wet(*facet, facet.map(|x| x[D - 1] - top), top, &mut enclosed));
        let factor = (self.volume_properties().volume / enclosed.0).powf(1.0 / (D - 1) as f64);
        for x in all.iter_mut().flatten() {
            (0..D).filter(|i| *i != axis).for_each(|i| x[i] *= factor);
        }
        all
    }
}

/// Adds the wetted part of a facet to the sums. The function splits a facet that crosses the water level until no part
/// crosses it.
pub(super) fn add_wet<const D: usize>(facet: Facet<D>, height: [f64; D], level: f64, sum: &mut (f64, Vector<D>)) {
    let above = height.iter().position(|z| *z > 0.0);
    let below = height.iter().position(|z| *z < 0.0);
    match (above, below) {
        (Some(i), Some(j)) => {
            let cut = facet[i] + (facet[j] - facet[i]) * (height[i] / (height[i] - height[j]));
            for end in [i, j] {
                let (mut part, mut part_height) = (facet, height);
                (part[end], part_height[end]) = (cut, 0.0);
                add_wet(part, part_height, level, sum);
            }
        }
        (None, Some(_)) => {
            let z_sum: f64 = height.iter().sum();
            // The integral of a product over a simplex of D corners: A (Σf Σg + Σfg) / (D (D + 1)).
            let factor = upward_area(&facet) / (D * (D + 1)) as f64;
            sum.0 += upward_area(&facet) * z_sum / D as f64;
            let mut first = Vector::zeros();
            for (x, z) in facet.iter().zip(height) {
                first += x * (z_sum + z) * factor;
            }
            let z2: f64 = height.iter().map(|z| z * z).sum();
            // Along the vertical: ∫ (level + ½z) z n_z dA.
            first[D - 1] = level * upward_area(&facet) * z_sum / D as f64 + 0.5 * factor * (z_sum * z_sum + z2);
            sum.1 += first;
        }
        _ => (),
    }
}

/// Returns the facet's area times the upward component of its outward normal.
fn upward_area<const D: usize>(facet: &Facet<D>) -> f64 {
    if D == 2 {
        return facet[0][0] - facet[1][0];
    }
    let (a, b) = (facet[1] - facet[0], facet[2] - facet[0]);
    0.5 * (a[0] * b[1] - a[1] * b[0])
}

fn ball_below<const D: usize>(radius: f64, pose: &Pose<D>, level: f64) -> (f64, Vector<D>) {
    let t = ((level - pose.position[D - 1]) / radius).clamp(-1.0, 1.0);
    let c2 = 1.0 - t * t;
    let (volume, upward) = if D == 2 {
        (radius * radius * (0.5 * PI + t.asin() + t * c2.sqrt()), -2.0 / 3.0 * (radius * c2.sqrt()).powi(3))
    } else {
        (PI * radius.powi(3) * (2.0 / 3.0 + t - t.powi(3) / 3.0), -0.25 * PI * radius.powi(4) * c2 * c2)
    };
    let mut first = pose.position * volume;
    first[D - 1] += upward;
    (volume, first)
}

/// Returns the edges of a closed outline (2-D).
fn edges<const D: usize>(points: &[Vector<D>]) -> Vec<Facet<D>> {
    (0..points.len()).map(|i| facet(&[points[i], points[(i + 1) % points.len()]])).collect()
}

/// Returns the facet of the first D of `points`.
fn facet<const D: usize>(points: &[Vector<D>]) -> Facet<D> {
    std::array::from_fn(|i| points[i])
}

fn box_facets<const D: usize>(b: &Bounds<D>) -> Vec<Facet<D>> {
    let ring = |z: Option<f64>| -> Vec<Vector<D>> {
        let corners = [(b.min[0], b.min[1]), (b.max[0], b.min[1]), (b.max[0], b.max[1]), (b.min[0], b.max[1])];
        corners.map(|(x, y)| Vector::from_fn(|i, _| [x, y, z.unwrap_or(0.0)][i])).to_vec()
    };
    if D == 2 { edges(&ring(None)) } else { lofted(&[ring(Some(b.min[D - 1])), ring(Some(b.max[D - 1]))]) }
}

/// Returns the outline of which `profile` is one half (2-D).
fn mirrored<const D: usize>(profile: &[(f64, f64)], axis: usize) -> Vec<Facet<D>> {
    let point = |across: f64, along: f64| Vector::from_fn(|i, _| if i == axis { along } else { across });
    // The outline runs counter-clockwise: for a vertical axis up the right side, for a horizontal axis along the lower
    // side.
    let side = if axis == 1 { 1.0 } else { -1.0 };
    let there = profile.iter().map(|(r, s)| point(side * r, *s));
    let back = profile.iter().rev().map(|(r, s)| point(-side * r, *s));
    edges(&there.chain(back).collect::<Vec<_>>())
}

/// Returns the surface of revolution of `profile` about `axis`, with `segments` edges of a circle (3-D).
fn revolved<const D: usize>(profile: &[(f64, f64)], axis: usize, segments: usize) -> Vec<Facet<D>> {
    let (u, v) = ((axis + 1) % D, (axis + 2) % D);
    let ring = |&(radius, along): &(f64, f64)| {
        let point = |k: usize| {
            let (sin, cos) = (TAU * k as f64 / segments as f64).sin_cos();
            let mut x = Vector::zeros();
            (x[axis], x[u], x[v]) = (along, radius * cos, radius * sin);
            x
        };
        (0..segments).map(point).collect()
    };
    lofted(&profile.iter().map(ring).collect::<Vec<_>>())
}

/// Returns the closed surface through rings with equal numbers of points. Each ring is counter-clockwise seen from the
/// last ring (3-D).
fn lofted<const D: usize>(rings: &[Vec<Vector<D>>]) -> Vec<Facet<D>> {
    let mut all = Vec::new();
    for pair in rings.windows(2) {
        let (low, high) = (&pair[0], &pair[1]);
        for i in 0..low.len() {
            let j = (i + 1) % low.len();
            all.push(facet(&[low[i], low[j], high[j]]));
            all.push(facet(&[low[i], high[j], high[i]]));
        }
    }
    for (ring, top) in [(rings.first(), false), (rings.last(), true)] {
        let Some(ring) = ring else { continue };
        for pair in ring[1..].windows(2) {
            let (a, b) = if top { (pair[0], pair[1]) } else { (pair[1], pair[0]) };
            all.push(facet(&[ring[0], a, b]));
        }
    }
    all
}

#[cfg(test)]
#[path = "../../tests/unit/geometry/submerged_volume.rs"]
mod tests;
