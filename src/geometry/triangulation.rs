//! Triangles of plane polygons with holes, by ear clipping. Every corner of the polygon becomes a corner of a triangle.

/// Largest number of corners of a polygon: the time grows with its square.
pub(crate) const MOST_CORNERS: usize = 20_000;

/// A position in the plane.
type Position = [f64; 2];

/// Returns triangles that fill the polygon inside `outer` and outside `holes`. The rings contain indices of `points`.
/// `outer` runs counter-clockwise and each hole clockwise; so the triangles run counter-clockwise. Returns `None` if the
/// rings cross or have more than [`MOST_CORNERS`] corners.
pub(crate) fn triangulate(points: &[Position], outer: &[u32], holes: &[Vec<u32>]) -> Option<Vec<[u32; 3]>> {
    if outer.len() + holes.iter().map(Vec::len).sum::<usize>() > MOST_CORNERS {
        return None;
    }
    let mut ring = outer.to_vec();
    let mut left: Vec<&Vec<u32>> = holes.iter().collect();
    // A hole is joined to the ring through its rightmost corner, the rightmost hole first.
    let rightmost = |hole: &[u32]| (0..hole.len()).max_by(|&i, &j| x(points, hole[i]).total_cmp(&x(points, hole[j])));
    let reach = |hole: &[u32]| rightmost(hole).map_or(f64::NEG_INFINITY, |i| x(points, hole[i]));
    left.sort_by(|a, b| reach(b).total_cmp(&reach(a)));
    while !left.is_empty() {
        let hole = left.remove(0);
        let from = rightmost(hole)?;
        let at = bridge(points, &ring, hole, from, &left)?;
        let inserted = (0..=hole.len()).map(|i| hole[(from + i) % hole.len()]).chain([ring[at]]);
        let inserted: Vec<u32> = inserted.collect();
        ring.splice(at + 1..at + 1, inserted);
    }
    clip_ears(points, ring)
}

fn x(points: &[Position], corner: u32) -> f64 {
    points[corner as usize][0]
}

/// Returns twice the area of the triangle, positive if it runs counter-clockwise.
fn cross(a: Position, b: Position, c: Position) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Returns the number of the corner of `ring` that is nearest to corner `from` of `hole` among those visible from it.
fn bridge(points: &[Position], ring: &[u32], hole: &[u32], from: usize, others: &[&Vec<u32>]) -> Option<usize> {
    let at = |corner: u32| points[corner as usize];
    let start = at(hole[from]);
    let n = ring.len();
    let opens_to_start = |i: usize| {
        let (before, here, after) = (at(ring[(i + n - 1) % n]), at(ring[i]), at(ring[(i + 1) % n]));
        if cross(before, here, after) >= 0.0 {
            cross(here, start, before) > 0.0 && cross(start, here, after) > 0.0
        } else {
            !(cross(here, start, after) >= 0.0 && cross(start, here, before) >= 0.0)
        }
    };
    let distance = |i: usize| (at(ring[i])[0] - start[0]).hypot(at(ring[i])[1] - start[1]);
    let mut candidates: Vec<usize> = (0..n).filter(|&i| opens_to_start(i)).collect();
    candidates.sort_by(|&i, &j| distance(i).total_cmp(&distance(j)));
    let crosses = |end: Position, a: Position, b: Position| {
        let touches_end = [a, b].iter().any(|p| *p == start || *p == end);
        !touches_end
            && cross(start, end, a) * cross(start, end, b) <= 0.0
            && cross(a, b, start) * cross(a, b, end) <= 0.0
    };
    let blocked = |end: Position, ring: &[u32]| {
        (0..ring.len()).any(|i| crosses(end, at(ring[i]), at(ring[(i + 1) % ring.len()])))
    };
    candidates.into_iter().find(|&i| {
        let end = at(ring[i]);
        !blocked(end, ring) && !blocked(end, hole) && others.iter().all(|other| !blocked(end, other))
    })
}

/// Cuts triangles off the ring, the best-shaped one first.
fn clip_ears(points: &[Position], ring: Vec<u32>) -> Option<Vec<[u32; 3]>> {
    let mut ring = ring;
    let mut triangles = Vec::with_capacity(ring.len().saturating_sub(2));
    let mut shapes: Vec<Option<f64>> = (0..ring.len()).map(|i| ear_shape(points, &ring, i)).collect();
    while ring.len() > 3 {
        let best = (0..ring.len()).filter(|&i| shapes[i].is_some());
        let i = best.max_by(|&i, &j| shapes[i].unwrap_or(0.0).total_cmp(&shapes[j].unwrap_or(0.0)))?;
        let n = ring.len();
        triangles.push([ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]]);
        ring.remove(i);
        shapes.remove(i);
        let n = ring.len();
        for j in [(i + n - 1) % n, i % n] {
            shapes[j] = ear_shape(points, &ring, j);
        }
    }
    if let [a, b, c] = ring[..] {
        triangles.push([a, b, c]);
    }
    Some(triangles)
}

/// Returns the shape of the triangle at corner `i` of the ring, its area over the square of its longest side (–), or
/// `None` if the triangle does not lie in the polygon. A triangle without area is allowed, as the last choice.
fn ear_shape(points: &[Position], ring: &[u32], i: usize) -> Option<f64> {
    let n = ring.len();
    let at = |i: usize| points[ring[i % n] as usize];
    let (a, b, c) = (at(i + n - 1), at(i), at(i + 1));
    let area = cross(a, b, c);
    let longest =
        [(a, b), (b, c), (c, a)].map(|(p, q)| (p[0] - q[0]).hypot(p[1] - q[1])).into_iter().fold(0.0, f64::max);
    let shape = if longest > 0.0 { area / (longest * longest) } else { 0.0 };
    if shape < -1e-12 {
        return None;
    }
    let inside = |p: Position| {
        let corner = p == a || p == b || p == c;
        !corner && cross(a, b, p) >= 0.0 && cross(b, c, p) >= 0.0 && cross(c, a, p) >= 0.0
    };
    // A triangle without area encloses no point.
    let flat = shape < 1e-12;
    (flat || (0..n).all(|j| !inside(at(j)))).then_some(shape.max(0.0))
}

#[cfg(test)]
#[path = "../../tests/unit/geometry/triangulation.rs"]
mod tests;
