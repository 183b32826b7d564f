//! The convex parts with which a solid is touched, and who starts inside whom; compiled for each dimension with the world.

use super::super::{
    parts,
    rapier::{
        geometry::SharedShape,
        math::{Pose as Frame, Vector as Point},
        parry::{bounding_volume::BoundingVolume, query::contact, shape::Cuboid},
    },
};
use super::{D, to_frame, to_point};
use crate::{
    error::{Error, Result},
    shape::Shape,
    solid::{Kinematics, Links, Role, SolidSpec},
    space::{Pose, Vector},
};

/// A solid's convex parts in its own frame.
pub(super) type Parts = Vec<(Frame, SharedShape)>;

/// Adds the convex parts of `shape`, posed in the solid's frame; of a mesh that is `fixed` its surface.
pub(super) fn collect(shape: &Shape<D>, pose: &Pose<D>, fixed: bool, found: &mut Parts) -> Result<()> {
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
                collect(shape, &pose.then(place), fixed, found)?;
            }
        }
        Shape::Cylinder { .. } | Shape::Polygon { .. } | Shape::Polyline { .. } | Shape::Mesh { .. } => {
            found.extend(parts(shape, fixed)?.into_iter().map(|(inner, part)| (frame * inner, part)));
        }
    }
    Ok(())
}

/// Smallest edge of the box around the parts, m.
pub(super) fn thickness(parts: &Parts) -> f64 {
    let boxes = parts.iter().map(|(frame, part)| part.compute_aabb(frame));
    boxes.reduce(|a, b| a.merged(&b)).map_or(f64::INFINITY, |whole| whole.extents().min_element())
}

/// The error that one solid starts so deep (m) inside another.
fn inside(inner: &SolidSpec<D>, outer: &SolidSpec<D>, depth: f64, allowed: f64) -> Error {
    let mut help =
        format!("move one of them by that much or more, or make it smaller; {allowed:.5} m (0.05 dp) is let pass");
    if let Shape::Tank { size, .. } = &outer.shape {
        let own = inner.shape.bounds_at(&Pose { position: Vector::zeros(), ..inner.pose }).size();
        if let Some(axis) = (0..D - 1).find(|&axis| own[axis] > size[axis]) {
            help = format!(
                "\"{}\" is {:.4} m long along {} and \"{}\" has room for {:.4} m: make it smaller, or the tank larger",
                inner.name,
                own[axis],
                ["x", "y"][axis],
                outer.name,
                size[axis]
            );
        }
    }
    Error::scene(format!("\"{}\" starts {depth:.5} m inside \"{}\"", inner.name, outer.name)).help(help)
}

/// Refuses a free solid that starts deeper than `allowed` (m) inside another.
pub(super) fn refuse_overlap(
    solids: &[SolidSpec<D>],
    start: &[Kinematics<D>],
    parts: &[Parts],
    links: &Links<D>,
    allowed: f64,
) -> Result<()> {
    let free = |i: usize| matches!(solids[i].role, Role::Free(_));
    for a in 0..solids.len() {
        for b in a + 1..solids.len() {
            if !(free(a) || free(b)) || !links.touch(a, b) {
                continue;
            }
            let (frame_a, frame_b) = (to_frame(&start[a].pose), to_frame(&start[b].pose));
            let mut depth: f64 = 0.0;
            for (inner_a, part_a) in &parts[a] {
                for (inner_b, part_b) in &parts[b] {
                    let touch = contact(&(frame_a * *inner_a), &**part_a, &(frame_b * *inner_b), &**part_b, 0.0);
                    depth = touch.ok().flatten().map_or(depth, |touch| depth.max(-touch.dist));
                }
            }
            if depth > allowed {
                let (inner, outer) = if free(a) { (a, b) } else { (b, a) };
                return Err(inside(&solids[inner], &solids[outer], depth, allowed).at(
                    "",
                    None,
                    format!("solid.{inner}.at"),
                ));
            }
        }
    }
    Ok(())
}
