//! Distance of a point from the surface of a shape: exact for every single shape.

use super::{Shape, wall::distance_to_wall};
use crate::math::Vector;

impl<const D: usize> Shape<D> {
    /// Returns the distance from `x` (m, own frame) to the surface, m: negative inside the solid.
    ///
    /// The inside of a tank or a polyline is the material of its walls. For a compound the function returns the least
    /// distance of all parts. That distance is exact outside, but too shallow inside near the joint of two parts.
    pub fn signed_distance(&self, x: &Vector<D>) -> f64 {
        match self {
            Shape::Box { size } => to_box(x, &(size * 0.5)),
            Shape::Ball { radius } => x.norm() - radius,
            Shape::Capsule { length, radius, axis } => {
                let mut y = *x;
                y[*axis] -= y[*axis].clamp(-0.5 * length, 0.5 * length);
                y.norm() - radius
            }
            Shape::Cylinder { length, radius, axis } => {
                let radial = (x.norm_squared() - x[*axis] * x[*axis]).max(0.0).sqrt();
                to_box(&Vector::from([radial, x[*axis]]), &Vector::from([*radius, 0.5 * length]))
            }
            Shape::Polygon { points } => to_polygon(x, points),
            Shape::Polyline { points, thickness } => distance_to_wall(x, points, *thickness),
            Shape::Tank { size, thickness } => to_tank(x, size, *thickness),
            Shape::Mesh { mesh, .. } => mesh.distance_and_normal(&in_space(x)).0,
            Shape::Compound(parts) => {
                parts.iter().map(|(pose, part)| part.signed_distance(&pose.local(x))).fold(f64::INFINITY, f64::min)
            }
        }
    }

    /// Returns the direction in which the signed distance grows at `x` (m, own frame), as a unit vector: the outward
    /// normal of the nearest face. The function uses central differences over `step` (m); the result for a mesh is
    /// exact.
    pub(crate) fn outward_normal(&self, x: &Vector<D>, step: f64) -> Vector<D> {
        if let Shape::Mesh { mesh, .. } = self {
            let n = mesh.distance_and_normal(&in_space(x)).1;
            return Vector::from_fn(|i, _| n[i]);
        }
        let mut n = Vector::<D>::zeros();
        for i in 0..D {
            let mut e = Vector::zeros();
            e[i] = step;
            n[i] = self.signed_distance(&(x + e)) - self.signed_distance(&(x - e));
        }
        n.try_normalize(1e-9 * step).unwrap_or_else(Vector::zeros)
    }

    /// Returns the signed distance (m) at `x` and the outward normal. A mesh needs only a single search for both
    /// values.
    pub(super) fn distance_and_normal(&self, x: &Vector<D>, step: f64) -> (f64, Vector<D>) {
        match self {
            Shape::Mesh { mesh, .. } => {
                let (distance, n) = mesh.distance_and_normal(&in_space(x));
                (distance, Vector::from_fn(|i, _| n[i]))
            }
            _ => (self.signed_distance(x), self.outward_normal(x, step)),
        }
    }
}

/// Returns `x` as a point in 3-D, for any `D`.
fn in_space<const D: usize>(x: &Vector<D>) -> Vector<3> {
    Vector::from_fn(|i, _| if i < D { x[i] } else { 0.0 })
}

fn to_box<const N: usize>(x: &Vector<N>, half: &Vector<N>) -> f64 {
    let q = x.abs() - half;
    q.map(|c| c.max(0.0)).norm() + q.max().min(0.0)
}

fn to_tank<const D: usize>(x: &Vector<D>, size: &Vector<D>, thickness: f64) -> f64 {
    let (up, top) = (D - 1, size[D - 1]);
    let in_hollow = x[up] > 0.0 && (0..up).all(|i| x[i] > 0.0 && x[i] < size[i]);
    if in_hollow {
        let over = (x[up] - top).max(0.0);
        return (0..up).map(|i| x[i].min(size[i] - x[i]).hypot(over)).fold(x[up], f64::min);
    }
    let mut half = size * 0.5;
    half.iter_mut().take(up).for_each(|h| *h += thickness);
    half[up] += 0.5 * thickness;
    let mut centre = size * 0.5;
    centre[up] -= 0.5 * thickness;
    let outer = to_box(&(x - centre), &half);
    if outer > 0.0 {
        return outer;
    }
    let to_hollow =
        (0..D).map(|i| if i == up { -x[i] } else { (-x[i]).max(x[i] - size[i]) }.max(0.0).powi(2)).sum::<f64>();
    outer.max(-to_hollow.sqrt())
}

/// Returns the point of the segment a-b nearest to `x`, and the projection of `x` on the line a-b (0 at a, 1 at b).
pub(super) fn nearest_on_segment<const D: usize>(x: &Vector<D>, a: &Vector<D>, b: &Vector<D>) -> (Vector<D>, f64) {
    let along = b - a;
    let u = (x - a).dot(&along) / along.norm_squared();
    // The function returns the ends unchanged, so that two segments tie exactly at their shared point.
    let nearest = if u <= 0.0 {
        *a
    } else if u >= 1.0 {
        *b
    } else {
        a + along * u
    };
    (nearest, u)
}

fn to_polygon<const D: usize>(x: &Vector<D>, points: &[Vector<D>]) -> f64 {
    let (mut d2, mut inside) = (f64::INFINITY, false);
    for (i, a) in points.iter().enumerate() {
        let b = &points[(i + 1) % points.len()];
        d2 = d2.min((x - nearest_on_segment(x, a, b).0).norm_squared());
        if (a[1] > x[1]) != (b[1] > x[1]) && x[0] < a[0] + (x[1] - a[1]) * (b[0] - a[0]) / (b[1] - a[1]) {
            inside = !inside;
        }
    }
    if inside { -d2.sqrt() } else { d2.sqrt() }
}

#[cfg(test)]
#[path = "../../tests/unit/geometry/distance.rs"]
mod tests;
