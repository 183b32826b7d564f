//! The smallest box around a posed shape.

use super::{Shape, wall::wall_outline};
use crate::math::{Bounds, Pose, Vector};

/// The smallest box around the posed shape, m.
pub(crate) fn world_bounds<const D: usize>(shape: &Shape<D>, pose: &Pose<D>) -> Bounds<D> {
    let extent = |i: usize, sign: f64| {
        let mut direction = Vector::<D>::zeros();
        direction[i] = sign;
        sign * pose.position[i] + support(shape, &(pose.rotation.transpose() * direction))
    };
    Bounds { min: Vector::from_fn(|i, _| -extent(i, -1.0)), max: Vector::from_fn(|i, _| extent(i, 1.0)) }
}

/// The largest x·`way` of the posed shape, m; `way` is a unit vector.
pub(crate) fn farthest_along<const D: usize>(shape: &Shape<D>, pose: &Pose<D>, way: &Vector<D>) -> f64 {
    pose.position.dot(way) + support(shape, &(pose.rotation.transpose() * way))
}

/// The greatest length (m) of the shape along a line in any orientation: exact for round shapes, else that of the diagonal of its
/// box.
pub(crate) fn greatest_length<const D: usize>(shape: &Shape<D>) -> f64 {
    match shape {
        Shape::Ball { radius } => 2.0 * radius,
        Shape::Capsule { length, radius, .. } => length + 2.0 * radius,
        Shape::Cylinder { length, radius, .. } => length.hypot(2.0 * radius),
        _ => shape.bounds().size().norm(),
    }
}

/// The support function: how far the shape reaches in the direction `n`, a unit vector of its own frame, m.
fn support<const D: usize>(shape: &Shape<D>, n: &Vector<D>) -> f64 {
    let farthest = |points: &[Vector<D>]| points.iter().map(|p| p.dot(n)).fold(f64::NEG_INFINITY, f64::max);
    match shape {
        Shape::Box { size } => 0.5 * n.abs().dot(size),
        Shape::Ball { radius } => *radius,
        Shape::Capsule { length, radius, axis } => 0.5 * n[*axis].abs() * length + radius,
        Shape::Cylinder { length, radius, axis } => {
            0.5 * n[*axis].abs() * length + radius * (1.0 - n[*axis] * n[*axis]).max(0.0).sqrt()
        }
        Shape::Polygon { points } => farthest(points),
        Shape::Polyline { points, thickness } => farthest(&wall_outline(points, *thickness)),
        Shape::Mesh { mesh, .. } => {
            let along = |p: &Vector<3>| (0..D).map(|i| p[i] * n[i]).sum();
            mesh.points().iter().map(along).fold(f64::NEG_INFINITY, f64::max)
        }
        Shape::Compound(parts) => parts
            .iter()
            .map(|(pose, part)| pose.position.dot(n) + support(part, &(pose.rotation.transpose() * n)))
            .fold(f64::NEG_INFINITY, f64::max),
        Shape::Tank { .. } => {
            let bounds = shape.bounds();
            (0..D).map(|i| (n[i] * bounds.min[i]).max(n[i] * bounds.max[i])).sum()
        }
    }
}

#[cfg(test)]
#[path = "../../tests/unit/geometry/support.rs"]
mod tests;
