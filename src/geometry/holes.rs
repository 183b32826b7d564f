//! Holes between boundary layers: the points around a hole move towards its centre until no hole is wider than those
//! of an even packing.
//!
//! A hole is a place from which the nearest points are farther than from all places around it. The search for holes
//! climbs from given places to such maxima; between two searches the code follows the holes found.

use rayon::prelude::*;

use super::cells::{PointCells, spacing_flags};
use crate::math::Vector;

/// Radius of a hole, dp, above which the points around it move.
const WIDE: f64 = 0.87;
/// Excess of a point's distance over the radius, dp, up to which the point moves.
const RIM: f64 = 0.1;
/// Displacement of a point at the radius over the excess of the radius, –.
const PULL: f64 = 0.8;
/// Distance, dp, below which two points move apart.
const CLOSE: f64 = 0.74;
/// Radius, dp, from which on a hole is followed: it may become too wide.
const FOLLOWED: f64 = WIDE - 0.1;
/// Distance, dp, of a place from the nearest point from which on a hole may be near: cells of half a dp have their centres up
/// to 0.43 dp from the hole.
const NEAR_HOLE: f64 = WIDE - 0.35;
/// Distance, dp, at which two holes are one.
const SAME: f64 = 0.2;
/// First and last step of the climb, dp.
const STEPS: [f64; 2] = [0.16, 0.01];
/// Largest distance, dp, at which a point is searched.
const SIGHT: f64 = 1.3;
/// Number of searches.
const SEARCHES: usize = 2;
/// Number of displacements after each search.
const DISPLACEMENTS: usize = 30;

/// A hole: its centre and its radius, m.
type Hole<const D: usize> = (Vector<D>, f64);

/// Moves the first `movable` of `points` until the holes near the `places` are no wider than [`WIDE`], as far as there is space.
///
/// `inside` moves a place where no hole counts to the next place where one does; `confine(i, from, x)` moves point `i`, which has
/// moved from `from` to `x`, back into its permitted space.
pub(super) fn close_holes<const D: usize>(
    points: &mut [Vector<D>],
    movable: usize,
    places: &[Vector<D>],
    dp: f64,
    inside: impl Fn(Vector<D>) -> Option<Vector<D>> + Sync,
    confine: impl Fn(usize, &Vector<D>, &mut Vector<D>) + Sync,
) {
    for _ in 0..SEARCHES {
        let mut starts = places.to_vec();
        for _ in 0..DISPLACEMENTS {
            let holes = holes(points, &starts, dp, &inside);
            starts = holes.iter().map(|(centre, _)| *centre).collect();
            let wide: Vec<Hole<D>> = holes.into_iter().filter(|(_, radius)| *radius > WIDE * dp).collect();
            if wide.is_empty() {
                break;
            }
            let next = displaced(points, &wide, dp);
            points[..movable].par_iter_mut().zip(next).enumerate().for_each(|(i, (x, mut next))| {
                if next != *x {
                    confine(i, x, &mut next);
                    *x = next;
                }
            });
        }
    }
}

/// Returns the holes to which the climb from the places `starts` leads, each once.
fn holes<const D: usize>(
    points: &[Vector<D>],
    starts: &[Vector<D>],
    dp: f64,
    inside: impl Fn(Vector<D>) -> Option<Vector<D>> + Sync,
) -> Vec<Hole<D>> {
    let cells = PointCells::new(points, 0.5 * SIGHT * dp);
    let nearest = |x: &Vector<D>| {
        let mut nearest = None;
        cells.visit_near(x, SIGHT * dp, |_, y| {
            let distance = (x - y).norm();
            if distance < nearest.map_or(SIGHT * dp, |(_, least)| least) {
                nearest = Some((*y, distance));
            }
        });
        nearest
    };
    let climb = |start: &Vector<D>| {
        let (mut x, mut step) = (*start, STEPS[0] * dp);
        let (mut point, mut radius) = nearest(&x).filter(|(_, distance)| *distance > NEAR_HOLE * dp)?;
        while step > STEPS[1] * dp {
            let next = inside(x + (x - point) * (step / radius));
            match next.and_then(|next| Some((next, nearest(&next)?))) {
                Some((next, (nearer, distance))) if distance > radius + 1e-3 * step => {
                    (x, point, radius) = (next, nearer, distance);
                }
                _ => step *= 0.5,
            }
        }
        (radius > FOLLOWED * dp).then_some((x, radius))
    };
    let found: Vec<Hole<D>> = starts.par_iter().filter_map(climb).collect();
    let centres: Vec<Vector<D>> = found.iter().map(|(centre, _)| *centre).collect();
    let kept = spacing_flags(&centres, 0, SAME * dp);
    found.into_iter().zip(kept).filter_map(|(hole, keep)| keep.then_some(hole)).collect()
}

/// Returns the points, those around `wide` holes nearer to the centres, and then those too close to one another farther apart.
fn displaced<const D: usize>(points: &[Vector<D>], wide: &[Hole<D>], dp: f64) -> Vec<Vector<D>> {
    let cells = PointCells::new(points, 0.5 * SIGHT * dp);
    let mut pulled = points.to_vec();
    for (centre, radius) in wide {
        let reach = radius + RIM * dp;
        cells.visit_near(centre, reach, |i, x| {
            let (way, distance) = (centre - x, (centre - x).norm());
            let share = (reach - distance) / (RIM * dp);
            if share > 0.0 {
                pulled[i] += way * (PULL * share * (radius - WIDE * dp) / distance);
            }
        });
    }
    let cells = PointCells::new(&pulled, CLOSE * dp);
    let apart = |x: &Vector<D>| {
        let mut push = Vector::zeros();
        cells.visit_near(x, CLOSE * dp, |_, y| {
            let (way, distance) = (x - y, (x - y).norm());
            // The point itself is at no distance.
            if distance > 0.0 && distance < CLOSE * dp {
                push += way * (0.5 * (CLOSE * dp - distance) / distance);
            }
        });
        x + push
    };
    pulled.par_iter().map(apart).collect()
}

#[cfg(test)]
#[path = "../../tests/unit/geometry/holes.rs"]
mod tests;
