//! Converts the shapes of solids to lines for drawing.

use std::f64::consts::{PI, TAU};

use serde::Serialize;

use super::mesh_edges::mesh_lines;
use crate::{
    geometry::{Shape, wall::wall_contours},
    math::{Pose, Vector},
};

/// The number of corners of the polygon that represents a circle.
const ROUND: usize = 48;

/// A line of a drawing.
///
/// The closed lines of a solid in 2-D enclose its area by their winding numbers: counter-clockwise around the solid,
/// clockwise around a hole.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Outline {
    /// Whether the last point joins the first point.
    pub closed: bool,
    /// The points, m, in the local frame of the solid; in 2-D the third coordinate is zero.
    pub points: Vec<[f64; 3]>,
}

/// Returns the lines of `shape`: its outline in 2-D, its edges in 3-D. The list is empty for a shape without lines; its
/// boundary particles represent such a shape.
pub(crate) fn outlines<const D: usize>(shape: &Shape<D>) -> Vec<Outline> {
    match shape {
        Shape::Box { size } => box_lines(&(size * -0.5), &(size * 0.5)),
        Shape::Ball { radius } => ball_outlines(&[0.0; 3], *radius, D),
        Shape::Capsule { length, radius, axis } => capsule::<D>(*length, *radius, *axis),
        Shape::Cylinder { length, radius, axis } if D == 3 => cylinder(*length, *radius, *axis),
        Shape::Polygon { points } => vec![closed(points.iter().map(to_3d))],
        Shape::Polyline { points, thickness } => {
            wall_contours(points, *thickness).iter().map(|line| closed(line.iter().map(to_3d))).collect()
        }
        Shape::Tank { size, thickness } if D == 2 => vec![tank(size[0], size[1], *thickness)],
        Shape::Tank { size, .. } => box_lines(&Vector::zeros(), size),
        Shape::Mesh { mesh, .. } => mesh_lines(mesh),
        Shape::Compound(parts) => parts.iter().flat_map(|(pose, part)| transformed(pose, outlines(part))).collect(),
        _ => Vec::new(),
    }
}

/// Returns the vector with three coordinates.
pub(crate) fn to_3d<const D: usize>(x: &Vector<D>) -> [f64; 3] {
    std::array::from_fn(|i| if i < D { x[i] } else { 0.0 })
}

/// Returns the lines of a part after the transformation by its pose in the solid.
fn transformed<const D: usize>(pose: &Pose<D>, mut lines: Vec<Outline>) -> Vec<Outline> {
    for x in lines.iter_mut().flat_map(|line| &mut line.points) {
        *x = to_3d(&pose.point(&Vector::from_fn(|i, _| x[i])));
    }
    lines
}

fn closed(points: impl IntoIterator<Item = [f64; 3]>) -> Outline {
    Outline { closed: true, points: points.into_iter().collect() }
}

/// Returns the edges of a box from `low` to `high`.
fn box_lines<const D: usize>(low: &Vector<D>, high: &Vector<D>) -> Vec<Outline> {
    let (a, b) = (to_3d(low), to_3d(high));
    let ring = |z: f64| closed([[a[0], a[1], z], [b[0], a[1], z], [b[0], b[1], z], [a[0], b[1], z]]);
    if D == 2 {
        return vec![ring(0.0)];
    }
    let upright = |x: f64, y: f64| Outline { closed: false, points: vec![[x, y, a[2]], [x, y, b[2]]] };
    let corners = [[a[0], a[1]], [b[0], a[1]], [b[0], b[1]], [a[0], b[1]]];
    [ring(a[2]), ring(b[2])].into_iter().chain(corners.map(|[x, y]| upright(x, y))).collect()
}

/// Returns the circle around `centre` in the plane of the axes `u` and `v`.
fn circle(centre: &[f64; 3], radius: f64, u: usize, v: usize) -> Outline {
    arc(centre, radius, (u, v), 0.0, TAU, ROUND, true)
}

fn arc(
    centre: &[f64; 3],
    radius: f64,
    (u, v): (usize, usize),
    from: f64,
    by: f64,
    parts: usize,
    closed: bool,
) -> Outline {
    let point = |k: usize| {
        let angle = from + by * k as f64 / parts as f64;
        let mut x = *centre;
        x[u] += radius * angle.cos();
        x[v] += radius * angle.sin();
        x
    };
    Outline { closed, points: (0..if closed { parts } else { parts + 1 }).map(point).collect() }
}

fn ball_outlines(centre: &[f64; 3], radius: f64, dimension: usize) -> Vec<Outline> {
    let planes: &[(usize, usize)] = if dimension == 2 { &[(0, 1)] } else { &[(0, 1), (0, 2), (1, 2)] };
    planes.iter().map(|&(u, v)| circle(centre, radius, u, v)).collect()
}

/// Returns the outline of a straight part with round ends, in the plane of its `axis` and the axis `v`.
fn stadium(length: f64, radius: f64, axis: usize, v: usize) -> Outline {
    let end = |centre: &[f64; 3], from: f64| arc(centre, radius, (axis, v), from, PI, ROUND / 2, false).points;
    let [low, high] = ends(length, axis);
    let mut points = end(&high, -0.5 * PI);
    points.extend(end(&low, 0.5 * PI));
    if v < axis {
        points.reverse(); // counter-clockwise
    }
    Outline { closed: true, points }
}

fn capsule<const D: usize>(length: f64, radius: f64, axis: usize) -> Vec<Outline> {
    let across: Vec<usize> = (0..D).filter(|&i| i != axis).collect();
    let mut lines: Vec<Outline> = across.iter().map(|&v| stadium(length, radius, axis, v)).collect();
    if let [u, v] = across[..] {
        lines.extend(ends(length, axis).map(|centre| circle(&centre, radius, u, v)));
    }
    lines
}

fn ends(length: f64, axis: usize) -> [[f64; 3]; 2] {
    [-0.5, 0.5].map(|side| {
        let mut centre = [0.0; 3];
        centre[axis] = side * length;
        centre
    })
}

fn cylinder(length: f64, radius: f64, axis: usize) -> Vec<Outline> {
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut lines: Vec<Outline> = ends(length, axis).iter().map(|centre| circle(centre, radius, u, v)).collect();
    for k in 0..4 {
        let angle = 0.25 * TAU * f64::from(k);
        let points = ends(length, axis).map(|mut x| {
            (x[u], x[v]) = (radius * angle.cos(), radius * angle.sin());
            x
        });
        lines.push(Outline { closed: false, points: points.to_vec() });
    }
    lines
}

/// Returns the cross-section of the walls and the bottom of a tank.
fn tank(width: f64, height: f64, wall: f64) -> Outline {
    let outer = [[-wall, height], [-wall, -wall], [width + wall, -wall], [width + wall, height]];
    let inner = [[width, height], [width, 0.0], [0.0, 0.0], [0.0, height]];
    closed(outer.iter().chain(&inner).map(|x| [x[0], x[1], 0.0]))
}

#[cfg(test)]
#[path = "../../tests/unit/report/outline.rs"]
mod tests;
