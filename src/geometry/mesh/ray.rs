//! Intersection test of two facets.

use crate::math::Vector;

/// Least penetration of one facet through another that counts as an intersection, over the size of the smaller facet. A
/// smaller value is the round-off of a file in single precision.
const THROUGH: f64 = 1e-5;

/// Returns whether an edge of either facet passes through the other facet.
pub(crate) fn facets_cross(a: &[Vector<3>; 3], b: &[Vector<3>; 3]) -> bool {
    pierces(a, b) || pierces(b, a)
}

/// Returns whether an edge of `a` passes through the interior of `b`, by more than round-off.
fn pierces(a: &[Vector<3>; 3], b: &[Vector<3>; 3]) -> bool {
    let normal = (b[1] - b[0]).cross(&(b[2] - b[0]));
    let longest = |f: &[Vector<3>; 3]| (0..3).map(|i| (f[(i + 1) % 3] - f[i]).norm()).fold(0.0, f64::max);
    let least = THROUGH * longest(a).min(longest(b)) * normal.norm();
    let height = a.map(|x| normal.dot(&(x - b[0])));
    (0..3).map(|i| (i, (i + 1) % 3)).any(|(i, j)| {
        let through = height[i].min(height[j]) < -least && height[i].max(height[j]) > least;
        through && {
            let x = a[i] + (a[j] - a[i]) * (height[i] / (height[i] - height[j]));
            let inside =
                |p: &Vector<3>, q: &Vector<3>| (q - p).cross(&(x - p)).dot(&normal) > THROUGH * normal.norm_squared();
            inside(&b[0], &b[1]) && inside(&b[1], &b[2]) && inside(&b[2], &b[0])
        }
    })
}
