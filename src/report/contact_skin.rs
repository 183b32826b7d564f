//! The contact skin of a solid as it is drawn: where others touch it.

use std::f64::consts::TAU;

use serde::Serialize;

use super::outline::{Outline, outlines, to_3d, transformed};
use crate::{geometry::Shape, math::Vector, preflight::surface_samples};

/// Largest turn from one point of a round corner to the next, rad.
const STEP: f64 = TAU / 48.0;

/// Cosine of half the turn of an inner corner, –, beyond which its parallels meet too far off to be looked for.
const LEAST_COSINE: f64 = 0.25;

/// Most steps from an edge to the outer side: in the sharpest inner corner each leaves three quarters of the way.
const MOST_STEPS: usize = 32;

/// How near to the outer side the steps end, in thicknesses of the skin, –.
const NEAR: f64 = 1e-4;

/// What is nearer to other faces than this part of the skin lies in theirs, –.
const OUTSIDE: f64 = 0.98;

/// The outer side of a contact skin, in the frame of the solid; nothing if it has none.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub(crate) struct ContactSkinOutline {
    /// In 2-D its lines; in 3-D those of the solid, moved out to it.
    pub lines: Vec<Outline>,
    /// In 3-D places on it, m, about dp apart.
    pub dots: Vec<[f64; 3]>,
}

impl ContactSkinOutline {
    /// That of `shape` with a contact skin so thick (m), in a scene of spacing `dp` (m).
    pub(crate) fn of_shape<const D: usize>(shape: &Shape<D>, skin: f64, dp: f64) -> Self {
        if skin == 0.0 {
            return Self::default();
        }
        if D == 2 {
            return Self { lines: skin_lines_2d(shape, skin), dots: Vec::new() };
        }
        let outside = |x: &Vector<D>| shape.signed_distance(x) > OUTSIDE * skin;
        let places =
            surface_samples::of_shape(shape, dp).into_iter().map(|face| face.x + face.n * skin).filter(outside);
        // Rounded to a thousandth of dp: many of them stand on a page.
        let round = |x: f64| (x / (1e-3 * dp)).round() * 1e-3 * dp;
        let mut lines = skin_lines_3d(shape, skin, dp);
        lines.iter_mut().flat_map(|line| &mut line.points).for_each(|x| *x = x.map(round));
        Self { lines, dots: places.map(|x| to_3d(&x).map(round)).collect() }
    }
}

/// The lines of a contact skin in 3-D: those of the solid, about `step` (m) fine, each point moved outwards by the skin. What lies
/// within the solid or in a corner between two parts, as lines of a compound's parts may, is left out.
fn skin_lines_3d<const D: usize>(shape: &Shape<D>, skin: f64, step: f64) -> Vec<Outline> {
    let moved = |line: Outline| {
        let found: Vec<Option<[f64; 3]>> =
            refined(&line, step).iter().map(|x| skin_point(shape, x, skin, step)).collect();
        let closed = line.closed && found.iter().all(Option::is_some);
        let runs = found.split(Option::is_none).filter(|run| run.len() > 1);
        runs.map(|run| Outline { closed, points: run.iter().flatten().copied().collect() }).collect::<Vec<_>>()
    };
    outlines(shape).into_iter().flat_map(moved).collect()
}

/// Where the outer side of the skin is above the point `x` (m) of the faces, in the direction in which the distance from `shape`
/// grows: at an edge between the normals of both its faces. None above what is inside, or where that is too far off.
fn skin_point<const D: usize>(shape: &Shape<D>, x: &[f64; 3], skin: f64, step: f64) -> Option<[f64; 3]> {
    let from = Vector::<D>::from_fn(|i, _| x[i]);
    if shape.signed_distance(&from) < -NEAR * skin {
        return None;
    }
    // By differences, of a mesh too: on one of its edges round-off chooses a facet.
    let slope = Vector::<D>::from_fn(|i, _| {
        let mut e = Vector::zeros();
        e[i] = 0.05 * step;
        shape.signed_distance(&(from + e)) - shape.signed_distance(&(from - e))
    });
    let normal = slope.try_normalize(1e-9 * step)?;
    let mut far = skin;
    for _ in 0..MOST_STEPS {
        let there = from + normal * far;
        let left = skin - shape.signed_distance(&there);
        if left < NEAR * skin {
            return Some(to_3d(&there));
        }
        // No part of the outer side is nearer than what is left, so that none is passed by.
        far += left;
        if far > skin / LEAST_COSINE {
            return None;
        }
    }
    None
}

/// The lines of a contact skin in 2-D: of a compound those of its parts, where they lie in no other's skin.
fn skin_lines_2d<const D: usize>(shape: &Shape<D>, skin: f64) -> Vec<Outline> {
    let Shape::Compound(parts) = shape else {
        let around = |line: Outline| Outline { closed: true, points: offset_polygon(&line.points, skin) };
        return outlines(shape).into_iter().map(around).collect();
    };
    let mut found = Vec::new();
    for (i, (pose, part)) in parts.iter().enumerate() {
        let outside = |x: &[f64; 3]| {
            let x = Vector::from_fn(|k, _| x[k]);
            let mut others = parts.iter().enumerate().filter(|(j, _)| *j != i);
            others.all(|(_, (there, other))| other.signed_distance(&there.local(&x)) > OUTSIDE * skin)
        };
        found.extend(
            transformed(pose, skin_lines_2d(part, skin)).into_iter().flat_map(|line| clipped(line, skin, outside)),
        );
    }
    found
}

/// The closed line `by` (m) outside the closed line through `points`, round about its corners.
fn offset_polygon(points: &[[f64; 3]], by: f64) -> Vec<[f64; 3]> {
    let n = points.len();
    let edge = |i: usize| {
        let (a, b) = (points[i % n], points[(i + 1) % n]);
        [b[0] - a[0], b[1] - a[1]]
    };
    let area: f64 = (0..n).map(|i| points[i][0] * points[(i + 1) % n][1] - points[i][1] * points[(i + 1) % n][0]).sum();
    let round = area.signum();
    // From one edge to the next, counter-clockwise as the line goes round.
    let turn = |a: [f64; 2], b: [f64; 2]| (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1]);
    let mut line = Vec::new();
    for i in 0..n {
        let (before, after, corner) = (edge(i), edge(i + 1), points[(i + 1) % n]);
        let (turn, start) = (round * turn(before, after), (-round * before[0]).atan2(round * before[1]));
        // Outer corners are round; at inner ones the parallels of both edges meet.
        let (steps, far) = match turn > 0.0 {
            true => ((turn / STEP).ceil() as usize, by),
            false => (0, by / (0.5 * turn).cos().max(LEAST_COSINE)),
        };
        let first = if turn > 0.0 { start } else { start + 0.5 * round * turn };
        line.extend((0..=steps).map(|k| {
            let angle = first + round * turn * k as f64 / steps.max(1) as f64;
            [corner[0] + far * angle.cos(), corner[1] + far * angle.sin(), 0.0]
        }));
    }
    line
}

/// The parts of a line that are `kept`, to about `step` (m).
fn clipped(line: Outline, step: f64, kept: impl Fn(&[f64; 3]) -> bool) -> Vec<Outline> {
    let fine = refined(&line, step);
    let Some(gap) = fine.iter().position(|x| !kept(x)) else { return vec![line] };
    let from = if line.closed { gap } else { 0 };
    let round: Vec<[f64; 3]> = fine[from..].iter().chain(&fine[..from]).copied().collect();
    let runs = round.split(|x| !kept(x)).filter(|run| run.len() > 1);
    runs.map(|run| Outline { closed: false, points: run.to_vec() }).collect()
}

/// The points of a line and others between them, about `step` (m) apart.
fn refined(line: &Outline, step: f64) -> Vec<[f64; 3]> {
    let (first, last) = (line.points.first(), line.points.last());
    let sides = line.points.iter().zip(line.points.iter().skip(1).chain(first.filter(|_| line.closed)));
    let between = sides.flat_map(|(a, b)| subdivided(a, b, step));
    between.chain(last.filter(|_| !line.closed).copied()).collect()
}

/// Points from `a` to before `b`, about `step` (m) apart, but not more than a thousand.
fn subdivided(a: &[f64; 3], b: &[f64; 3], step: f64) -> Vec<[f64; 3]> {
    let length = (b[0] - a[0]).hypot(b[1] - a[1]).hypot(b[2] - a[2]);
    let count = (length / step).ceil().clamp(1.0, 1000.0);
    (0..count as usize).map(|k| std::array::from_fn(|i| a[i] + (b[i] - a[i]) * k as f64 / count)).collect()
}

#[cfg(test)]
#[path = "../../tests/unit/report/contact_skin.rs"]
mod tests;
