//! A polyline wall, 2-D only: its side of the water, its far side with mitred corners, and distances to both.
//!
//! A corner that turns by more than 143° away from the far side is rounded there: the far side keeps its distance from the corner.
//!
//! A line whose last point equals its first is closed: the wall has no ends, and its first point is a corner.

use super::distance::nearest_on_segment;
use crate::math::Vector;

/// Least 1 + cos of the angle by which a corner turns (143°) with a mitre outside.
const SHARPEST: f64 = 0.2;

/// Largest angle (rad) between the points of a rounded corner.
const ROUNDING: f64 = 0.15;

/// Returns whether the line returns to its first point.
pub(crate) fn is_closed<const D: usize>(points: &[Vector<D>]) -> bool {
    points.len() > 3 && points.first() == points.last()
}

/// Returns the unit normal to the right of the direction from `a` to `b`: into the solid of a polyline.
pub(super) fn right_normal<const D: usize>(a: &Vector<D>, b: &Vector<D>) -> Vector<D> {
    let mut n = Vector::<D>::zeros();
    (n[0], n[1]) = (b[1] - a[1], a[0] - b[0]);
    n / n.norm()
}

/// Returns the right normals of the edges before and after point `i`; at the end of an open line both are the same.
fn normals_at<const D: usize>(points: &[Vector<D>], i: usize) -> (Vector<D>, Vector<D>) {
    let last = points.len() - 1;
    let edge = |i: usize| right_normal(&points[i], &points[i + 1]);
    match (i, is_closed(points)) {
        (0, true) => (edge(last - 1), edge(0)),
        (i, true) if i == last => (edge(last - 1), edge(0)),
        _ => (edge(i.max(1) - 1), edge(i.min(last - 1))),
    }
}

/// Returns the far side of a wall at a distance of `thickness` (m) to the right: for each point of the line its corner, or the points
/// of a rounded corner. The rounding of the first point of a closed line is at its last point.
pub(crate) fn far_corners<const D: usize>(points: &[Vector<D>], thickness: f64) -> Vec<Vec<Vector<D>>> {
    let edge = |i: usize| (points[i + 1] - points[i]).norm();
    let corner = |(i, p): (usize, &Vector<D>)| {
        let (a, b) = normals_at(points, i);
        let (span, turn) = (1.0 + a.dot(&b), a[0] * b[1] - a[1] * b[0]);
        let mitre = (a + b) * (thickness / span);
        if span >= SHARPEST {
            return vec![p + mitre];
        }
        if turn < 0.0 {
            // The far sides of both edges meet inside the corner, unless an edge is too short.
            let [before, after] = if i == 0 { [points.len() - 2, 0] } else { [i - 1, i % (points.len() - 1)] };
            let way = thickness * ((1.0 - a.dot(&b)) / span).sqrt();
            return vec![p + mitre * (edge(before).min(edge(after)) / way).min(1.0)];
        }
        let angle = turn.atan2(a.dot(&b)).rem_euclid(std::f64::consts::TAU);
        let count = (angle / ROUNDING).ceil().max(1.0);
        let at = |k: f64| {
            let (sine, cosine) = (angle * k / count).sin_cos();
            let mut n = Vector::<D>::zeros();
            (n[0], n[1]) = (a[0] * cosine - a[1] * sine, a[0] * sine + a[1] * cosine);
            p + n * thickness
        };
        (0..=count as usize).map(|k| at(k as f64)).collect()
    };
    let mut corners: Vec<_> = points.iter().enumerate().map(corner).collect();
    if is_closed(points) {
        let rounding = corners[0].len() - 1;
        corners[0].drain(..rounding);
    }
    corners
}

/// Returns the outline of a wall, counter-clockwise: the line in reverse, then the far side. The outline of a closed
/// wall is one ring after the other; it passes the cut between them once in each direction.
pub(crate) fn wall_outline<const D: usize>(points: &[Vector<D>], thickness: f64) -> Vec<Vector<D>> {
    points.iter().rev().copied().chain(far_corners(points, thickness).into_iter().flatten()).collect()
}

/// Returns the closed lines around a wall, counter-clockwise around the solid: one around an open wall, two around a
/// closed wall.
#[cfg(feature = "cli")]
pub(crate) fn wall_contours<const D: usize>(points: &[Vector<D>], thickness: f64) -> Vec<Vec<Vector<D>>> {
    if !is_closed(points) {
        return vec![wall_outline(points, thickness)];
    }
    vec![points[1..].iter().rev().copied().collect(), far_corners(points, thickness)[1..].concat()]
}

/// Returns the convex parts of a wall, counter-clockwise: one quadrilateral for each edge, mitred at the corners, then a fan for
/// each rounded corner.
pub(crate) fn wall_parts<const D: usize>(points: &[Vector<D>], thickness: f64) -> Vec<Vec<Vector<D>>> {
    let far = far_corners(points, thickness);
    let side = |(near, far): (&[Vector<D>], &[Vec<Vector<D>>])| {
        let mut corners = vec![near[0]];
        corners.extend(far[0].last().into_iter().chain(far[1].first()));
        corners.push(near[1]);
        corners
    };
    let sides = points.windows(2).zip(far.windows(2)).map(side);
    let fans = points.iter().zip(&far).filter(|(_, far)| far.len() > 1);
    sides.chain(fans.map(|(p, far)| std::iter::once(*p).chain(far.iter().copied()).collect())).collect()
}

/// Returns the length (m) of the outline of a wall.
pub(super) fn wall_perimeter<const D: usize>(points: &[Vector<D>], thickness: f64) -> f64 {
    let length = |line: &[Vector<D>]| line.windows(2).map(|ab| (ab[1] - ab[0]).norm()).sum::<f64>();
    let ends = if is_closed(points) { 0.0 } else { 2.0 * thickness };
    length(points) + length(&far_corners(points, thickness).concat()) + ends
}

/// Position of a point relative to a line.
pub(super) enum LineSide {
    /// The point is on the water's side of the line, or on the line.
    Left(f64),
    /// The point is on the solid's side of the line, at this depth (m).
    Right(f64),
    /// The point is before the first point of the line.
    BeforeStart,
    /// The point is beyond the last point of the line.
    AfterEnd,
}

pub(super) fn side_of_line<const D: usize>(x: &Vector<D>, points: &[Vector<D>]) -> LineSide {
    side_and_corner(x, points).0
}

/// Returns the side of the line on which `x` is, and the index of the point of the line that is nearest to `x`, unless
/// an edge is nearer.
fn side_and_corner<const D: usize>(x: &Vector<D>, points: &[Vector<D>]) -> (LineSide, Option<usize>) {
    let (segments, closed) = (points.len() - 1, is_closed(points));
    let (mut d2, mut right, mut before, mut after, mut corner) = (f64::INFINITY, 0.0, false, false, None);
    for (i, ab) in points.windows(2).enumerate() {
        let (nearest, u) = nearest_on_segment(x, &ab[0], &ab[1]);
        let r = x - nearest;
        let r2 = r.norm_squared();
        if r2 > d2 {
            continue;
        }
        if r2 < d2 {
            (d2, right) = (r2, 0.0);
            before = i == 0 && u < 0.0 && !closed;
            after = i + 1 == segments && u > 1.0 && !closed;
            corner = if u <= 0.0 { Some(i) } else { (u >= 1.0).then_some(i + 1) };
        }
        right += r.dot(&right_normal(&ab[0], &ab[1])); // both sides of a corner vote
    }
    let side = match (before, after) {
        (true, _) => LineSide::BeforeStart,
        (_, true) => LineSide::AfterEnd,
        _ if right > 0.0 => LineSide::Right(d2.sqrt()),
        _ => LineSide::Left(d2.sqrt()),
    };
    (side, corner)
}

/// Returns the signed distance (m) from `x` to the surface of a wall of `thickness` (m).
pub(super) fn distance_to_wall<const D: usize>(x: &Vector<D>, points: &[Vector<D>], thickness: f64) -> f64 {
    let n = points.len();
    let to_cap = |end: &Vector<D>, a: &Vector<D>, b: &Vector<D>| match is_closed(points) {
        true => f64::INFINITY,
        false => (x - nearest_on_segment(x, end, &(end + right_normal(a, b) * thickness)).0).norm(),
    };
    let to_start = || to_cap(&points[0], &points[0], &points[1]);
    let to_end = || to_cap(&points[n - 1], &points[n - 2], &points[n - 1]);
    match side_and_corner(x, points) {
        (LineSide::BeforeStart, _) => to_start(),
        (LineSide::AfterEnd, _) => to_end(),
        (LineSide::Left(d), _) => d,
        (LineSide::Right(d), corner) => {
            let outside = corner.and_then(|i| beyond_mitre(x, points, i, thickness)).unwrap_or(d - thickness);
            if outside > 0.0 { outside } else { -d.min(-outside).min(to_start()).min(to_end()) }
        }
    }
}

/// Returns the signed distance (m) from `x` to the far side of the wall at its corner `i`, or `None` if the far side is
/// not a full mitre there.
fn beyond_mitre<const D: usize>(x: &Vector<D>, points: &[Vector<D>], i: usize, thickness: f64) -> Option<f64> {
    let ((a, b), p) = (normals_at(points, i), &points[i]);
    let span = 1.0 + a.dot(&b);
    if span < SHARPEST || a == b {
        return None;
    }
    let r = x - p;
    let inside = r.dot(&a).max(r.dot(&b)) - thickness;
    if inside <= 0.0 {
        return Some(inside);
    }
    let tip = p + (a + b) * (thickness / span);
    let to = |n: &Vector<D>| (x - nearest_on_segment(x, &(p + n * thickness), &tip).0).norm();
    Some(to(&a).min(to(&b)))
}

#[cfg(test)]
#[path = "../../tests/unit/geometry/wall.rs"]
mod tests;
