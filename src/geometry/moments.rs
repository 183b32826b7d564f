//! Exact bounds, volume, centroid, second moment and surface area of every shape.

use std::f64::consts::PI;

use super::{
    Shape, VolumeProperties,
    wall::{wall_outline, wall_perimeter},
};
use crate::math::{Bounds, Matrix, Pose, Vector, rotated_tensor};

impl<const D: usize> Shape<D> {
    /// Returns the smallest axis-aligned box around the shape in its own frame, m.
    pub fn bounds(&self) -> Bounds<D> {
        let around = |half: Vector<D>| Bounds { min: -half, max: half };
        match self {
            Shape::Box { size } => around(size * 0.5),
            Shape::Ball { radius } => around(Vector::repeat(*radius)),
            Shape::Capsule { length, radius, axis } => {
                let mut half = Vector::repeat(*radius);
                half[*axis] += 0.5 * length;
                around(half)
            }
            Shape::Cylinder { length, radius, axis } => {
                let mut half = Vector::repeat(*radius);
                half[*axis] = 0.5 * length;
                around(half)
            }
            Shape::Polygon { points } => Bounds::around(points),
            Shape::Polyline { points, thickness } => Bounds::around(&wall_outline(points, *thickness)),
            Shape::Tank { size, thickness } => tank_outer_bounds(size, *thickness),
            Shape::Mesh { mesh, .. } => {
                let Bounds { min, max } = mesh.bounds();
                Bounds { min: Vector::from_fn(|i, _| min[i]), max: Vector::from_fn(|i, _| max[i]) }
            }
            Shape::Compound(parts) => {
                parts.iter().map(|(pose, part)| part.bounds_at(pose)).fold(Bounds::empty(), |a, b| a.union(&b))
            }
        }
    }

    /// Returns an axis-aligned box around the shape at `pose`, m: the smallest such box if the pose has no rotation.
    pub fn bounds_at(&self, pose: &Pose<D>) -> Bounds<D> {
        let own = self.bounds();
        let centre = pose.point(&((own.min + own.max) * 0.5));
        let half = pose.rotation.abs() * (own.size() * 0.5);
        Bounds { min: centre - half, max: centre + half }
    }

    /// Returns the exact volume, centroid and second moment.
    pub fn volume_properties(&self) -> VolumeProperties<D> {
        match self {
            Shape::Box { size } => {
                let volume = size.product();
                centred(volume, Matrix::from_diagonal(&size.map(|s| volume * s * s / 12.0)))
            }
            Shape::Ball { radius } => {
                let volume = ball_volume(D, *radius);
                centred(volume, Matrix::identity() * (volume * radius * radius / (D + 2) as f64))
            }
            Shape::Capsule { length, radius, axis } => capsule(*length, *radius, *axis),
            Shape::Cylinder { length, radius, axis } => {
                let volume = PI * radius * radius * length;
                let mut moment = Matrix::identity() * (0.25 * volume * radius * radius);
                moment[(*axis, *axis)] = volume * length * length / 12.0;
                centred(volume, moment)
            }
            Shape::Polygon { points } => polygon(points),
            Shape::Polyline { points, thickness } => polygon(&wall_outline(points, *thickness)),
            Shape::Tank { size, thickness } => {
                let outside = tank_outer_bounds(size, *thickness);
                let solid = |size: Vector<D>| Shape::Box { size }.volume_properties();
                let middle = |b: &Bounds<D>| Pose::at((b.min + b.max) * 0.5);
                let hollow = Bounds { min: Vector::zeros(), max: *size };
                sum([(1.0, middle(&outside), solid(outside.size())), (-1.0, middle(&hollow), solid(*size))])
            }
            Shape::Mesh { mesh, .. } => {
                let VolumeProperties { volume, centroid, second_moment } = mesh.volume_properties();
                let second_moment = Matrix::from_fn(|i, j| second_moment[(i, j)]);
                VolumeProperties { volume, centroid: Vector::from_fn(|i, _| centroid[i]), second_moment }
            }
            Shape::Compound(parts) => sum(parts.iter().map(|(pose, part)| (1.0, *pose, part.volume_properties()))),
        }
    }

    /// Returns the area of the whole surface, m² (in 2-D the length of the outline, m). The area of a compound is the
    /// sum over its parts, including faces in contact.
    pub(crate) fn surface_area(&self) -> f64 {
        match self {
            Shape::Box { size } => (0..D).map(|i| 2.0 * size.product() / size[i]).sum(),
            Shape::Ball { radius } => ball_surface(D, *radius),
            Shape::Capsule { length, radius, .. } => ball_surface(D - 1, *radius) * length + ball_surface(D, *radius),
            Shape::Cylinder { length, radius, .. } => 2.0 * PI * radius * (length + radius),
            Shape::Polygon { points } => perimeter(points),
            Shape::Polyline { points, thickness } => wall_perimeter(points, *thickness),
            Shape::Tank { size, thickness } => {
                // The floor of the hollow has the same area as the opening at the top.
                let sides: f64 = (0..D - 1).map(|i| 2.0 * size.product() / size[i]).sum();
                Shape::Box { size: tank_outer_bounds(size, *thickness).size() }.surface_area() + sides
            }
            Shape::Mesh { mesh, .. } => mesh.surface_area(),
            Shape::Compound(parts) => parts.iter().map(|(_, part)| part.surface_area()).sum(),
        }
    }
}

/// Returns the volume of a ball in `n` dimensions, 1 to 3.
fn ball_volume(n: usize, radius: f64) -> f64 {
    match n {
        1 => 2.0 * radius,
        2 => PI * radius * radius,
        _ => 4.0 / 3.0 * PI * radius.powi(3),
    }
}

/// Returns the surface area of a ball in `n` dimensions, 1 to 3: n V / r.
fn ball_surface(n: usize, radius: f64) -> f64 {
    n as f64 * ball_volume(n, radius) / radius
}

fn centred<const D: usize>(volume: f64, second_moment: Matrix<D>) -> VolumeProperties<D> {
    VolumeProperties { volume, centroid: Vector::zeros(), second_moment }
}

fn capsule<const D: usize>(length: f64, radius: f64, axis: usize) -> VolumeProperties<D> {
    let (rod, ends, r2) = (ball_volume(D - 1, radius) * length, ball_volume(D, radius), radius * radius);
    // ∫|s| dV over the two half balls, s along the axis from the flat side of each.
    let first = if D == 2 { 4.0 / 3.0 * radius.powi(3) } else { 0.5 * PI * radius.powi(4) };
    let across = rod * r2 / (D + 1) as f64 + ends * r2 / (D + 2) as f64;
    let along =
        rod * length * length / 12.0 + ends * r2 / (D + 2) as f64 + length * first + 0.25 * ends * length * length;
    let mut moment = Matrix::identity() * across;
    moment[(axis, axis)] = along;
    centred(rod + ends, moment)
}

/// Returns the sum of volumes, each with its sign and its pose, by the parallel-axis theorem.
fn sum<const D: usize>(parts: impl IntoIterator<Item = (f64, Pose<D>, VolumeProperties<D>)>) -> VolumeProperties<D> {
    let (mut volume, mut first, mut second) = (0.0, Vector::zeros(), Matrix::zeros());
    for (sign, pose, part) in parts {
        let c = pose.point(&part.centroid);
        volume += sign * part.volume;
        first += c * (sign * part.volume);
        second += (rotated_tensor(&pose.rotation, &part.second_moment) + c * c.transpose() * part.volume) * sign;
    }
    let centroid = first / volume;
    VolumeProperties { volume, centroid, second_moment: second - centroid * centroid.transpose() * volume }
}

/// Returns the properties of a polygon, as the signed sum of the triangles between its edges and its first point.
fn polygon<const D: usize>(points: &[Vector<D>]) -> VolumeProperties<D> {
    let origin = points[0];
    let (mut volume, mut first, mut second) = (0.0, Vector::zeros(), Matrix::zeros());
    for ab in points[1..].windows(2) {
        let (a, b) = (ab[0] - origin, ab[1] - origin);
        let area = 0.5 * (a[0] * b[1] - a[1] * b[0]);
        let s = a + b;
        volume += area;
        first += s * (area / 3.0);
        second += (a * a.transpose() + b * b.transpose() + s * s.transpose()) * (area / 12.0);
    }
    let centroid = first / volume;
    VolumeProperties {
        volume,
        centroid: origin + centroid,
        second_moment: second - centroid * centroid.transpose() * volume,
    }
}

fn perimeter<const D: usize>(points: &[Vector<D>]) -> f64 {
    (0..points.len()).map(|i| (points[(i + 1) % points.len()] - points[i]).norm()).sum()
}

/// Returns the outer bounds of a tank: walls and bottom, open at the top at `size`.
pub(super) fn tank_outer_bounds<const D: usize>(size: &Vector<D>, thickness: f64) -> Bounds<D> {
    let mut max = size.add_scalar(thickness);
    max[D - 1] = size[D - 1];
    Bounds { min: Vector::repeat(-thickness), max }
}

#[cfg(test)]
#[path = "../../tests/unit/geometry/moments.rs"]
mod tests;
