//! Panels of a 3-D shape for boundary-element methods: triangles of about equal size on the surface below the still water.
//!
//! Round shapes have as many segments as the panels need, scaled to the exact volume. Flat facets are halved across their longest
//! edge; facets of a mesh that are smaller than a panel stay.

use std::f64::consts::{PI, TAU};

use super::{
    Shape,
    exposed::{area_vector, exposed_facets, middle},
    submerged_volume::Facet,
};
use crate::math::{Pose, Vector};

/// Longest edge of a panel over its size: the diagonal of a square of two panels, with a tenth to spare.
const LONGEST: f64 = 1.55;

/// Fewest segments of a circle.
const FEWEST: usize = 12;

/// Distance from the still water within which a corner lies on it, over the size of a panel.
const SNAP: f64 = 1e-6;

/// Area below which a cut-off piece is no panel, over that of a panel.
const LEAST: f64 = 1e-4;

/// Returns the panels on the surface of `shape` at `pose` below the height `level` (m), counter-clockwise seen from the water, in
/// world coordinates. `size`: edge of a square that two panels fill, m. `is_wet` tells whether a point of the shape's own frame just
/// outside of a panel lies in the water around the solid.
pub(crate) fn wetted_panels(
    shape: &Shape<3>,
    pose: &Pose<3>,
    level: f64,
    size: f64,
    is_wet: impl Fn(&Vector<3>) -> bool,
) -> Vec<Facet<3>> {
    let facets = |part: &Shape<3>| {
        let mut halved = Vec::new();
        facets_of_size(part, size).into_iter().for_each(|facet| halve(facet, LONGEST * size, &mut halved));
        halved
    };
    let panels = exposed_facets(shape, &facets, &|cover, facet, into| cover.add_exposed_parts(facet, into));
    let is_wet = |facet: &Facet<3>| {
        let normal = area_vector(facet);
        let length = normal.norm();
        length > 0.0 && is_wet(&(middle(facet) + normal * (1e-3 * size / length)))
    };
    let mut wetted = Vec::new();
    for facet in panels.into_iter().filter(is_wet) {
        let snapped = facet.map(|x| {
            let mut x = pose.point(&x);
            if (x[2] - level).abs() < SNAP * size {
                x[2] = level;
            }
            x
        });
        add_below(snapped, level, LEAST * size * size, &mut wetted);
    }
    wetted
}

/// Returns the area of `panels`, m².
pub(crate) fn panel_area(panels: &[Facet<3>]) -> f64 {
    panels.iter().map(|panel| area_vector(panel).norm()).sum()
}

/// Returns the volume between `panels` and the plane at height `level` (m), m³.
pub(crate) fn panel_volume(panels: &[Facet<3>], level: f64) -> f64 {
    panels.iter().map(|panel| area_vector(panel)[2] * (middle(panel)[2] - level)).sum()
}

/// Returns the facets of a shape that is no compound, with round parts in steps of `size` (m).
fn facets_of_size(shape: &Shape<3>, size: f64) -> Vec<Facet<3>> {
    let segments = |radius: f64| (((TAU * radius / size).ceil() as usize).max(FEWEST)).next_multiple_of(4);
    let steps = |length: f64| ((length / size).ceil() as usize).max(1);
    match shape {
        Shape::Ball { radius } => facets_of_size(&Shape::Capsule { length: 0.0, radius: *radius, axis: 2 }, size),
        Shape::Capsule { length, radius, axis } => {
            let (round, straight) = (segments(*radius) / 4, if *length > 0.0 { steps(*length) } else { 0 });
            let arc = |i: usize| (0.5 * PI * i as f64 / round as f64).sin_cos();
            let low = (0..=round).map(|i| (radius * arc(i).0, -0.5 * length - radius * arc(i).1));
            let middle = (1..straight).map(|i| (*radius, length * (i as f64 / straight as f64 - 0.5)));
            let high =
                (usize::from(straight == 0)..=round).map(|i| (radius * arc(i).1, 0.5 * length + radius * arc(i).0));
            shape.turned_facets(&low.chain(middle).chain(high).collect::<Vec<_>>(), *axis, segments(*radius))
        }
        Shape::Cylinder { length, radius, axis } => {
            let (across, along) = (steps(*radius), steps(*length));
            let part = |i: usize, n: usize| i as f64 / n as f64;
            let low = (0..across).map(|i| (radius * part(i, across), -0.5 * length));
            let side = (0..=along).map(|i| (*radius, length * (part(i, along) - 0.5)));
            let high = (0..across).rev().map(|i| (radius * part(i, across), 0.5 * length));
            shape.turned_facets(&low.chain(side).chain(high).collect::<Vec<_>>(), *axis, segments(*radius))
        }
        _ => shape.outer_facets(),
    }
}

/// Adds the parts of a facet whose edges are at most `longest` (m), halved across the longest edge.
fn halve(facet: Facet<3>, longest: f64, into: &mut Vec<Facet<3>>) {
    let length = |i: usize| (facet[(i + 1) % 3] - facet[i]).norm();
    let i = (0..3).max_by(|&i, &j| length(i).total_cmp(&length(j))).unwrap_or(0);
    if length(i) <= longest {
        into.push(facet);
        return;
    }
    let (a, b, c) = (facet[i], facet[(i + 1) % 3], facet[(i + 2) % 3]);
    let half = (a + b) * 0.5;
    halve([a, half, c], longest, into);
    halve([half, b, c], longest, into);
}

/// Adds the parts of a facet below the height `level` (m) whose area is `least` (m²) or more.
fn add_below(facet: Facet<3>, level: f64, least: f64, into: &mut Vec<Facet<3>>) {
    let height = facet.map(|x| x[2] - level);
    let above = height.iter().position(|z| *z > 0.0);
    let below = height.iter().position(|z| *z < 0.0);
    match (above, below) {
        (Some(i), Some(j)) => {
            let mut cut = facet[i] + (facet[j] - facet[i]) * (height[i] / (height[i] - height[j]));
            cut[2] = level;
            for end in [i, j] {
                let mut part = facet;
                part[end] = cut;
                add_below(part, level, least, into);
            }
        }
        (None, Some(_)) if area_vector(&facet).norm() >= least => into.push(facet),
        _ => {}
    }
}

#[cfg(all(test, feature = "dim3"))]
#[path = "../../tests/unit/geometry/panels.rs"]
mod tests;
