//! Layers of polygons and polyline walls, 2-D only: curves parallel to the outline. The module cuts the curves where
//! another part of the outline is nearer, mitres them at the outer corners of a wall, and divides them evenly.

use super::{
    BoundaryPoint, Shape,
    wall::{LineSide, distance_to_wall, is_closed, right_normal, side_of_line},
};
use crate::math::Vector;

/// A curve at constant depth. The ends of the curve are points of the layer unless the curve ends at the end of the
/// wall.
struct Curve<const D: usize> {
    points: Vec<Vector<D>>,
    open_start: bool,
    open_end: bool,
}

/// Corners that turn by less than this angle (as cosine; 30°) are smooth: a curve continues through them.
const SMOOTH: f64 = 0.866;

/// Returns the layers inside a counter-clockwise polygon.
pub(super) fn polygon_points<const D: usize>(points: &[Vector<D>], dp: f64, layers: usize) -> Vec<BoundaryPoint<D>> {
    // In reverse order the solid is on the right of the outline, as for a wall.
    let line: Vec<_> = points.iter().chain(points.first()).rev().copied().collect();
    let shape = Shape::Polygon { points: points.to_vec() };
    layered(&line, true, dp, layers, |x| -shape.signed_distance(x))
}

/// Returns the layers of a wall on the right of a line. The wall has round(thickness/dp) curves across; of those, the
/// points no deeper than `layers` dp below a face or an end are boundary particles.
pub(super) fn polyline_points<const D: usize>(
    points: &[Vector<D>],
    thickness: f64,
    dp: f64,
    layers: usize,
) -> Vec<BoundaryPoint<D>> {
    let across = (thickness / dp).round().max(1.0);
    let even = thickness / across;
    let step = if (even - dp).abs() < 1e-9 * dp { dp } else { even };
    let across = across as usize;
    let depth_at = |x: &Vector<D>| match side_of_line(x, points) {
        LineSide::Right(depth) => depth,
        _ => 0.0,
    };
    let mut skin = Vec::new();
    for k in 0..across {
        let depth = (k as f64 + 0.5) * step;
        let inner = k >= layers && across - k > layers;
        let lines = if inner { near_ends(points, 2.0 * thickness + layers as f64 * dp) } else { vec![points.to_vec()] };
        for line in lines {
            let curves = curves_at(&line, is_closed(&line), depth, dp, &depth_at);
            let found = curves.iter().flat_map(|curve| divided(curve, dp));
            skin.extend(found.filter_map(|r| {
                let layer = (-distance_to_wall(&r, points, thickness) / step).floor().clamp(0.0, k as f64) as usize;
                (layer < layers).then_some(BoundaryPoint { r, layer: layer as u8 })
            }));
        }
    }
    skin
}

/// Returns the parts of an open line within about `distance` (m) of its ends, or the whole line if it is short; nothing
/// for a closed line.
fn near_ends<const D: usize>(points: &[Vector<D>], distance: f64) -> Vec<Vec<Vector<D>>> {
    let length: f64 = points.windows(2).map(|ab| (ab[1] - ab[0]).norm()).sum();
    let start = |points: &mut dyn Iterator<Item = &Vector<D>>| {
        let mut part: Vec<Vector<D>> = Vec::new();
        let mut first = None;
        for x in points {
            let first = *first.get_or_insert(*x);
            if let Some(last) = part.last().filter(|_| (x - first).norm() > distance) {
                let along = x - last;
                part.push(last + along * (distance / along.norm()).min(1.0));
                break;
            }
            part.push(*x);
        }
        part
    };
    if is_closed(points) {
        return Vec::new();
    }
    if length < 4.0 * distance {
        return vec![points.to_vec()];
    }
    let mut end = start(&mut points.iter().rev());
    end.reverse();
    vec![start(&mut points.iter()), end]
}

fn layered<const D: usize>(
    line: &[Vector<D>],
    closed: bool,
    dp: f64,
    layers: usize,
    depth_at: impl Fn(&Vector<D>) -> f64,
) -> Vec<BoundaryPoint<D>> {
    let mut skin = Vec::new();
    for k in 0..layers {
        for curve in curves_at(line, closed, (k as f64 + 0.5) * dp, dp, &depth_at) {
            skin.extend(divided(&curve, dp).into_iter().map(|r| BoundaryPoint { r, layer: k as u8 }));
        }
    }
    skin
}

/// Returns the curves parallel to the line at `depth`, without the parts where another part of the line is nearer.
fn curves_at<const D: usize>(
    line: &[Vector<D>],
    closed: bool,
    depth: f64,
    dp: f64,
    depth_at: &impl Fn(&Vector<D>) -> f64,
) -> Vec<Curve<D>> {
    // The tolerance admits points that lie on the parallel itself.
    let valid = |x: &Vector<D>| depth_at(x) >= depth * (1.0 - 1e-7);
    joined(parallels(line, closed, depth, dp, &valid), closed, dp)
}

/// Returns the valid pieces of the parallel at `depth`, in the order of the line.
fn parallels<const D: usize>(
    line: &[Vector<D>],
    closed: bool,
    depth: f64,
    dp: f64,
    valid: &impl Fn(&Vector<D>) -> bool,
) -> Vec<Curve<D>> {
    let edges = line.len() - 1;
    let normal: Vec<_> = line.windows(2).map(|ab| right_normal(&ab[0], &ab[1])).collect();
    // Length by which the parallel extends beyond corner i, which lies between edge i − 1 and edge i.
    let past = |i: usize| -> Option<f64> {
        let (a, b) = match (i == 0 || i == edges, closed) {
            (true, false) => return None,
            (true, true) => (normal[edges - 1], normal[0]),
            _ => (normal[i - 1], normal[i]),
        };
        let turns_left = a[0] * b[1] - a[1] * b[0] > 0.0;
        // The mitre's length is d tan(θ/2), up to θ = 100°; sharper corners have an arc.
        let half = ((1.0 - a.dot(&b)) / (1.0 + a.dot(&b)).max(1e-12)).sqrt();
        Some(if turns_left && half < 1.2 { depth * half } else { 0.0 })
    };
    let mut pieces = Vec::new();
    for (i, ab) in line.windows(2).enumerate() {
        let along = (ab[1] - ab[0]).normalize();
        let shift = normal[i] * depth;
        let a = ab[0] + shift - along * past(i).unwrap_or(0.0);
        let b = ab[1] + shift + along * past(i + 1).unwrap_or(0.0);
        for (from, to) in valid_spans(&a, &b, dp, valid) {
            let open_start = from == a && past(i).is_none();
            let open_end = to == b && past(i + 1).is_none();
            pieces.push(Curve { points: vec![from, to], open_start, open_end });
        }
        if i + 1 < edges || closed {
            let next = normal[(i + 1) % edges];
            pieces.extend(arc(&ab[1], &normal[i], &next, depth, dp, valid));
        }
    }
    pieces
}

/// Returns the arc of the parallel around a sharp outer corner, or `None` if the corner is not sharp, not an outer
/// corner, or the arc has no valid part.
fn arc<const D: usize>(
    corner: &Vector<D>,
    from: &Vector<D>,
    to: &Vector<D>,
    depth: f64,
    dp: f64,
    valid: &impl Fn(&Vector<D>) -> bool,
) -> Option<Curve<D>> {
    let sine = from[0] * to[1] - from[1] * to[0];
    let turn = sine.atan2(from.dot(to));
    if turn <= 0.0 || (0.5 * turn).tan() < 1.2 {
        return None;
    }
    let steps = (8.0 * turn * depth / dp).ceil().max(8.0);
    let at = |i: usize| {
        let (sin, cos) = (turn * i as f64 / steps).sin_cos();
        let mut n = Vector::zeros();
        (n[0], n[1]) = (cos * from[0] - sin * from[1], sin * from[0] + cos * from[1]);
        corner + n * depth
    };
    let points: Vec<_> = (0..=steps as usize).map(at).filter(valid).collect();
    (points.len() > 1).then_some(Curve { points, open_start: false, open_end: false })
}

/// Returns the parts of the segment a-b where `valid` holds; the function finds the ends of the parts by bisection.
fn valid_spans<const D: usize>(
    a: &Vector<D>,
    b: &Vector<D>,
    dp: f64,
    valid: &impl Fn(&Vector<D>) -> bool,
) -> Vec<(Vector<D>, Vector<D>)> {
    let steps = (8.0 * (b - a).norm() / dp).ceil().max(8.0) as usize;
    let at = |u: f64| a + (b - a) * u;
    let edge = |mut inside: f64, mut outside: f64| {
        for _ in 0..40 {
            let middle = 0.5 * (inside + outside);
            *(if valid(&at(middle)) { &mut inside } else { &mut outside }) = middle;
        }
        at(inside)
    };
    let (mut spans, mut start) = (Vec::new(), valid(a).then_some(*a));
    for i in 1..=steps {
        let (before, here) = ((i - 1) as f64 / steps as f64, i as f64 / steps as f64);
        match (start, valid(&at(here))) {
            (None, true) => start = Some(edge(here, before)),
            (Some(from), false) => {
                spans.push((from, edge(before, here)));
                start = None;
            }
            _ => (),
        }
    }
    spans.extend(start.map(|from| (from, *b)));
    spans
}

/// Joins pieces that continue smoothly from one to the next.
fn joined<const D: usize>(pieces: Vec<Curve<D>>, closed: bool, dp: f64) -> Vec<Curve<D>> {
    let smooth = |a: &Curve<D>, b: &Curve<D>| {
        let (p, q) = (&a.points, &b.points);
        let (end, before) = (p[p.len() - 1], p[p.len() - 2]);
        let turn = (end - before).normalize().dot(&(q[1] - q[0]).normalize());
        (end - q[0]).norm() < 1e-3 * dp && turn > SMOOTH
    };
    let mut curves: Vec<Curve<D>> = Vec::new();
    for piece in pieces.into_iter().filter(|c| (c.points[1] - c.points[0]).norm() > 1e-6 * dp) {
        match curves.last_mut() {
            Some(last) if smooth(last, &piece) => {
                last.points.extend(&piece.points);
                last.open_end = piece.open_end;
            }
            _ => curves.push(piece),
        }
    }
    let wraps = closed && curves.len() > 1 && smooth(&curves[curves.len() - 1], &curves[0]);
    if wraps && let Some(mut last) = curves.pop() {
        last.points.extend(&curves[0].points);
        curves[0].points = last.points;
    }
    curves
}

/// Returns points about one dp apart along the curve. If an end is not itself a point, it lies half a step from the
/// nearest point.
fn divided<const D: usize>(curve: &Curve<D>, dp: f64) -> Vec<Vector<D>> {
    let length: f64 = curve.points.windows(2).map(|ab| (ab[1] - ab[0]).norm()).sum();
    let spare = 0.5 * (f64::from(curve.open_start) + f64::from(curve.open_end));
    let steps = (length / dp - spare).round().max(if spare > 0.0 { 0.0 } else { 1.0 });
    let step = length / (steps + spare);
    let first = if curve.open_start { 0.5 * step } else { 0.0 };
    let mut places = (0..=steps as usize).map(|i| first + i as f64 * step).peekable();
    let (mut points, mut walked) = (Vec::new(), 0.0);
    for (i, ab) in curve.points.windows(2).enumerate() {
        let long = (ab[1] - ab[0]).norm();
        let is_last = i + 2 == curve.points.len();
        while let Some(s) = places.next_if(|s| is_last || *s <= walked + long) {
            points.push(ab[0] + (ab[1] - ab[0]) * ((s - walked) / long).min(1.0));
        }
        walked += long;
    }
    points
}

#[cfg(test)]
#[path = "../../tests/unit/geometry/offset.rs"]
mod tests;
