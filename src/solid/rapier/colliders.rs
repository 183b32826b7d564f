//! The convex parts of a solid for contacts, and the check for solids that overlap at the start; the module is compiled
//! for each dimension with its world.

use super::super::{
    parts,
    rapier::{
        geometry::SharedShape,
        math::{Pose as Frame, Vector as Point},
        parry::{bounding_volume::BoundingVolume, query::contact, shape::Cuboid},
    },
};
use super::{D, from_point, to_frame, to_point};
use crate::{
    error::{Error, Result},
    geometry::{Shape, wall::is_closed},
    math::{Bounds, Pose, Vector, format::three_digits},
    solid::{
        Constraints, Kinematics, Role, SolidSpec,
        containment::{PlacedSolid, depth_inside_mesh},
    },
};

/// Convex parts of a solid in the frame of the solid.
pub(super) type ConvexParts = Vec<(Frame, SharedShape)>;

/// Adds the convex parts of `shape`, posed in the solid's frame, to `found`; a mesh that is `fixed` contributes its
/// surface.
pub(super) fn collect_parts(shape: &Shape<D>, pose: &Pose<D>, fixed: bool, found: &mut ConvexParts) -> Result<()> {
    let frame = to_frame(pose);
    let mut cuboid = |min: Vector<D>, max: Vector<D>| {
        let centre = Frame::from_translation(to_point(&(0.5 * (min + max))));
        found.push((frame * centre, SharedShape::new(Cuboid::new(to_point(&(0.5 * (max - min)))))));
    };
    match shape {
        Shape::Box { size } => cuboid(-0.5 * size, 0.5 * size),
        Shape::Tank { size, thickness } => {
            let (low, mut high) = (Vector::repeat(-thickness), size.add_scalar(*thickness));
            high[D - 1] = size[D - 1];
            for axis in 0..D {
                let (mut min, mut max) = (low, high);
                max[axis] = 0.0;
                cuboid(min, max);
                if axis < D - 1 {
                    (min[axis], max[axis]) = (size[axis], high[axis]);
                    cuboid(min, max);
                }
            }
        }
        Shape::Ball { radius } => found.push((frame, SharedShape::ball(*radius))),
        Shape::Capsule { length, radius, axis } => {
            let end = Point::AXES[*axis] * (0.5 * length);
            found.push((frame, SharedShape::capsule(-end, end, *radius)));
        }
        Shape::Compound(inner) => {
            for (place, shape) in inner {
                collect_parts(shape, &pose.then(place), fixed, found)?;
            }
        }
        Shape::Cylinder { .. } | Shape::Polygon { .. } | Shape::Polyline { .. } | Shape::Mesh { .. } => {
            found.extend(parts(shape, fixed)?.into_iter().map(|(inner, part)| (frame * inner, part)));
        }
    }
    Ok(())
}

/// Returns the lowest and highest corner (m) of the box around the parts at `frame`, or `None` if there are no parts.
fn around(parts: &ConvexParts, frame: &Frame) -> Option<(Vector<D>, Vector<D>)> {
    let boxes = parts.iter().map(|(inner, part)| part.compute_aabb(&(*frame * *inner)));
    boxes.reduce(|a, b| a.merged(&b)).map(|whole| (from_point(whole.mins), from_point(whole.maxs)))
}

/// Returns the smallest edge of the box around the parts, m.
pub(super) fn thickness(parts: &ConvexParts) -> f64 {
    around(parts, &Frame::IDENTITY).map_or(f64::INFINITY, |(min, max)| (max - min).min())
}

/// Returns the lowest and highest corner (m) of the interior of a tank, or of an open polyline with two rising ends.
fn room(shape: &Shape<D>, pose: &Pose<D>) -> Option<(Vector<D>, Vector<D>)> {
    let corners: Vec<Vector<D>> = match shape {
        Shape::Tank { size, .. } => Bounds { min: Vector::zeros(), max: *size }.corners().collect(),
        Shape::Polyline { points, .. } if !is_closed(points) => points.clone(),
        Shape::Compound(parts) => return parts.iter().find_map(|(inner, part)| room(part, &pose.then(inner))),
        _ => return None,
    };
    let corners: Vec<Vector<D>> = corners.iter().map(|x| pose.point(x)).collect();
    let Bounds { min, max } = Bounds::around(&corners);
    let rises = |x: &Vector<D>| x[D - 1] > min[D - 1];
    let basin =
        matches!(shape, Shape::Tank { .. }) || corners.first().is_some_and(rises) && corners.last().is_some_and(rises);
    basin.then_some((min, max))
}

/// Returns the advice for a body that does not fit into a tank or basin.
fn cramped(
    (inner, here): PlacedSolid<D>,
    parts: &ConvexParts,
    (outer, there): PlacedSolid<D>,
    allowed: f64,
) -> Option<String> {
    let ((min, max), own) = (room(&outer.shape, there)?, around(parts, &to_frame(here))?);
    let (body, tank, size, space) = (&inner.name, &outer.name, own.1 - own.0, max - min);
    if let Some(axis) = (0..D - 1).find(|&axis| size[axis] > space[axis]) {
        let (size, space, axis) = (size[axis], space[axis], ["x", "y"][axis]);
        return Some(format!(
            "\"{body}\" is {size:.4} m long along {axis} and \"{tank}\" has room for {space:.4} m: make it smaller, or the \
             tank larger"
        ));
    }
    let (low, floor) = (own.0[D - 1], min[D - 1]);
    (low < floor - allowed).then(|| {
        format!(
            "\"{body}\" is {:.4} m high and reaches {:.4} m below the floor of \"{tank}\": move it up, or, if it floats so \
             deep, make it smaller or lighter, or the water deeper",
            size[D - 1],
            floor - low
        )
    })
}

/// Refuses a free solid that starts deeper than `allowed` (m) inside another solid, including contact skins.
pub(super) fn check_overlap(
    solids: &[SolidSpec<D>],
    start: &[Kinematics<D>],
    parts: &[ConvexParts],
    links: &Constraints<D>,
    allowed: f64,
) -> Result<()> {
    let free = |i: usize| matches!(solids[i].role, Role::Free(_));
    for a in 0..solids.len() {
        for b in a + 1..solids.len() {
            if !(free(a) || free(b)) || !links.can_touch(a, b) {
                continue;
            }
            let (frame_a, frame_b) = (to_frame(&start[a].pose), to_frame(&start[b].pose));
            let skins = solids[a].contact_skin + solids[b].contact_skin;
            let mut depth: f64 = 0.0;
            for (inner_a, part_a) in &parts[a] {
                for (inner_b, part_b) in &parts[b] {
                    let touch = contact(&(frame_a * *inner_a), &**part_a, &(frame_b * *inner_b), &**part_b, skins);
                    depth = touch.ok().flatten().map_or(depth, |touch| depth.max(skins - touch.dist));
                }
            }
            let (inner, outer) = if free(a) { (a, b) } else { (b, a) };
            let (body, other) = ((&solids[inner], &start[inner].pose), (&solids[outer], &start[outer].pose));
            let within = [depth_inside_mesh(body, other, allowed), depth_inside_mesh(other, body, allowed)];
            depth = within.into_iter().flatten().fold(depth, f64::max);
            if depth > allowed {
                let help = cramped(body, &parts[inner], other, allowed);
                let help = help.unwrap_or_else(|| {
                    let less = if skins > 0.0 { "a skin thinner" } else { "it smaller" };
                    let past = format!("{allowed:.5} m (0.05 dp) is let pass");
                    format!("move one of them by that much or more, or make {less}; {past}")
                });
                let what = format!("\"{}\" starts {depth:.5} m inside \"{}\"", body.0.name, other.0.name);
                let padded = if skins > 0.0 { ", contact skins counted" } else { "" };
                // It may have turned to its rest.
                let turn = body.1.rotation_vector().iter().map(|x| x * x).sum::<f64>().sqrt().to_degrees();
                let turned = if turn > 1e-3 { format!(", turned by {}°", three_digits(turn)) } else { String::new() };
                return Err(Error::scene(what + padded + &turned).help(help).at("", None, format!("solid.{inner}.at")));
            }
        }
    }
    Ok(())
}

#[cfg(test)]
#[path = "../../../tests/unit/solid/rapier/colliders.rs"]
mod tests;
