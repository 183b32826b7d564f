//! Meshes of solids that an outline generates by revolution or by translation.
//!
//! Circles become regular polygons of equal area, so that cones, frusta and tori have their exact volume. Ellipsoids are
//! scaled to theirs. The facets lie within `tolerance` (m) of the surface, up to [`MOST_SEGMENTS`] segments of a circle.

use std::f64::consts::{PI, TAU};

use super::Mesh;
use crate::{
    error::{Error, Result},
    math::Vector,
};

/// Fewest and most segments of a circle.
const SEGMENTS: [f64; 2] = [24.0, MOST_SEGMENTS];

/// Most segments of a circle: a torus of as many in both directions has less than half of the facets that a mesh may have.
const MOST_SEGMENTS: f64 = 320.0;

/// Corners and facets.
type Facets = (Vec<Vector<3>>, Vec<[u32; 3]>);

/// Segments of a circle of `radius` (m) whose chords lie within `tolerance` (m) of it; a multiple of four.
pub(crate) fn segments(radius: f64, tolerance: f64) -> usize {
    let angle = (1.0 - (tolerance / radius).min(1.0)).acos();
    4 * ((PI / angle).clamp(SEGMENTS[0], SEGMENTS[1]) / 4.0).ceil() as usize
}

/// The ellipsoid with these half axes (m).
///
/// # Errors
/// Those of [`Mesh::new`].
pub(crate) fn ellipsoid(radii: Vector<3>, tolerance: f64) -> Result<Mesh> {
    let n = segments(radii.max(), tolerance);
    let profile: Vec<[f64; 2]> =
        (0..=n / 2).map(|i| (i as f64 / n as f64 * TAU).sin_cos()).map(|(s, c)| [s, -c]).collect();
    let (mut points, facets) = revolved(&profile, false, n);
    points.iter_mut().for_each(|p| *p = p.component_mul(&radii));
    to_volume(points, &facets, 4.0 / 3.0 * PI * radii.product())
}

/// The frustum of a cone with radii `bottom` and `top` (m; one may be 0) and `length` (m) along `axis`, centred on half its length.
///
/// # Errors
/// Those of [`Mesh::new`].
pub(crate) fn frustum(bottom: f64, top: f64, length: f64, axis: usize, tolerance: f64) -> Result<Mesh> {
    let half = 0.5 * length;
    let profile = [[0.0, -half], [bottom, -half], [top, half], [0.0, half]];
    let profile: Vec<[f64; 2]> =
        profile.into_iter().enumerate().filter(|(i, p)| [0, 3].contains(i) || p[0] > 0.0).map(|x| x.1).collect();
    let (points, facets) = revolved(&profile, false, segments(bottom.max(top), tolerance));
    Mesh::new(&along_axis(points, axis), &facets)
}

/// The torus around `axis` with a tube of radius `tube` (m) whose centre line has `radius` (m).
///
/// # Errors
/// Those of [`Mesh::new`].
pub(crate) fn torus(radius: f64, tube: f64, axis: usize, tolerance: f64) -> Result<Mesh> {
    let n = segments(tube, tolerance);
    let corner = tube * equal_area(n);
    // The middle of a side, not a corner, is nearest to the axis, and farther from it than the tube.
    let angles = (0..n).map(|i| (i as f64 + 0.5) / n as f64 * TAU);
    let profile: Vec<[f64; 2]> = angles.map(f64::sin_cos).map(|(s, c)| [radius + corner * c, corner * s]).collect();
    let (points, facets) = revolved(&profile, true, segments(radius + tube, tolerance));
    Mesh::new(&along_axis(points, axis), &facets)
}

/// The prism of `length` (m) along `axis`, centred on half its length, over the simple polygon `outline` (m), whose coordinates
/// are those of the other two axes in their order.
///
/// # Errors
/// `Scene` if the outline encloses no area or crosses itself; those of [`Mesh::new`].
pub(crate) fn prism(outline: &[[f64; 2]], length: f64, axis: usize) -> Result<Mesh> {
    let mut ring = without_collinear(outline);
    let area = signed_area(&ring);
    if area < 0.0 {
        ring.reverse();
    }
    let caps = triangulated(&ring).ok_or_else(|| {
        Error::scene("the outline of the prism encloses no area or crosses itself")
            .help("give three or more points of a simple polygon, in order along it")
    })?;
    let n = ring.len() as u32;
    let [u, v] = [[1, 2], [0, 2], [0, 1]][axis];
    let at = |p: &[f64; 2], along: f64| {
        let mut x = Vector::<3>::zeros();
        (x[u], x[v], x[axis]) = (p[0], p[1], along);
        x
    };
    let points: Vec<Vector<3>> =
        [-0.5, 0.5].iter().flat_map(|side| ring.iter().map(move |p| at(p, side * length))).collect();
    let mut facets: Vec<[u32; 3]> = caps.iter().flat_map(|&[a, b, c]| [[a, c, b], [n + a, n + b, n + c]]).collect();
    for a in 0..n {
        let b = (a + 1) % n;
        facets.extend([[a, b, n + b], [a, n + b, n + a]]);
    }
    // x and z, in this order, are a left-handed pair about y.
    if axis == 1 {
        facets.iter_mut().for_each(|f| f.swap(0, 1));
    }
    Mesh::new(&points, &facets)
}

/// Radius of the corners of a regular polygon of `n` sides over the radius of the circle of equal area.
pub(crate) fn equal_area(n: usize) -> f64 {
    let angle = TAU / n as f64;
    (angle / angle.sin()).sqrt()
}

/// Revolves the profile of radii and heights (m) about the z axis, in `n` parts. The profile runs upwards outside; it begins and
/// ends on the axis or, if `closed`, continues from its end to its beginning.
fn revolved(profile: &[[f64; 2]], closed: bool, n: usize) -> Facets {
    let (angle, equal_area) = (TAU / n as f64, equal_area(n));
    let (mut points, mut rows) = (Vec::new(), Vec::new());
    for (i, &[r, z]) in profile.iter().enumerate() {
        let first = points.len() as u32;
        if !closed && (i == 0 || i + 1 == profile.len()) {
            points.push(Vector::<3>::new(0.0, 0.0, z));
            rows.push(vec![first; n]);
        } else {
            let r = r * equal_area;
            points.extend((0..n).map(|k| (k as f64 * angle).sin_cos()).map(|(s, c)| Vector::<3>::new(r * c, r * s, z)));
            rows.push((0..n as u32).map(|k| first + k).collect());
        }
    }
    let last = if closed { rows.len() } else { rows.len() - 1 };
    let mut facets = Vec::new();
    for i in 0..last {
        let (low, high) = (&rows[i], &rows[(i + 1) % rows.len()]);
        for k in 0..n {
            let next = (k + 1) % n;
            let two = [[low[k], low[next], high[next]], [low[k], high[next], high[k]]];
            facets.extend(two.into_iter().filter(|[a, b, c]| a != b && b != c && c != a));
        }
    }
    (points, facets)
}

/// Turns the z axis to `axis`, the order of the axes kept.
fn along_axis(points: Vec<Vector<3>>, axis: usize) -> Vec<Vector<3>> {
    let turn = |p: Vector<3>| Vector::from_fn(|i, _| p[(i + 2 - axis) % 3]);
    points.into_iter().map(turn).collect()
}

/// The mesh scaled to `volume` (m³).
fn to_volume(mut points: Vec<Vector<3>>, facets: &[[u32; 3]], volume: f64) -> Result<Mesh> {
    let corner = |i: u32| points[i as usize];
    let six: f64 = facets.iter().map(|&[a, b, c]| corner(a).dot(&corner(b).cross(&corner(c)))).sum();
    let scale = (6.0 * volume / six).cbrt();
    points.iter_mut().for_each(|p| *p *= scale);
    Mesh::new(&points, facets)
}

fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn signed_area(ring: &[[f64; 2]]) -> f64 {
    (0..ring.len()).map(|i| (ring[i], ring[(i + 1) % ring.len()])).map(|(a, b)| 0.5 * (a[0] * b[1] - a[1] * b[0])).sum()
}

/// The ring without points that repeat or lie on the line between their neighbours.
fn without_collinear(ring: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let size = ring.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
    let mut ring = ring.to_vec();
    let mut i = 0;
    while ring.len() > 3 && i < ring.len() {
        let n = ring.len();
        if cross(ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]).abs() < 1e-14 * size * size {
            ring.remove(i);
            i = i.saturating_sub(1);
        } else {
            i += 1;
        }
    }
    ring
}

/// The triangles of a simple counter-clockwise polygon by ear clipping @meisters1975; `None` if it is not one.
fn triangulated(ring: &[[f64; 2]]) -> Option<Vec<[u32; 3]>> {
    let mut left: Vec<usize> = (0..ring.len()).collect();
    let mut triangles = Vec::new();
    while left.len() > 3 {
        let n = left.len();
        let ear = (0..n).find(|&i| {
            let [a, b, c] = [left[(i + n - 1) % n], left[i], left[(i + 1) % n]];
            let inside = |p: usize| {
                [(a, b), (b, c), (c, a)].iter().all(|&(from, to)| cross(ring[from], ring[to], ring[p]) >= 0.0)
            };
            cross(ring[a], ring[b], ring[c]) > 0.0 && !left.iter().any(|&p| ![a, b, c].contains(&p) && inside(p))
        })?;
        triangles.push([left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]].map(|i| i as u32));
        left.remove(ear);
    }
    let [a, b, c] = left[..] else { return None };
    (cross(ring[a], ring[b], ring[c]) > 0.0).then(|| {
        triangles.push([a, b, c].map(|i| i as u32));
        triangles
    })
}

#[cfg(all(test, feature = "dim3"))]
#[path = "../../tests/unit/geometry/solids_of_revolution.rs"]
mod tests;
