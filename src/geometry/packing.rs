//! Packing of water around solids that do not fit its lattice: the points spread until they fill their space evenly.
//!
//! Each movable point moves down the gradient of the concentration C = Σ V W of all points around it, both water and
//! boundary layers: δ = −β dp² ∇C, V = dp^D. If every face has boundary layers behind it, the even packing ends half a
//! dp from the face.

use std::{f64::consts::PI, ops::Range};

use rayon::prelude::*;

use super::cells::PointCells;
use crate::{math::Vector, ranks::Ranks};

/// Smoothing length, dp. Tests from 1.0 to 1.5 on boxes, discs, balls and slopes show the smallest gaps at this value.
const H: f64 = 1.0;
/// Radius of the kernel's support, dp.
pub(super) const SUPPORT_RADIUS_DP: f64 = 2.0 * H;
/// Longest displacement of a point in a pass, dp.
const STEP: f64 = 0.15;
/// The passes end if the longest displacement is below this limit, dp.
const REST: f64 = 0.01;
/// Least number of points per parallel task.
const CHUNK: usize = 256;
/// Number of tasks per thread, if there are many points. Each task makes one neighbour list; the allocator returns the memory of long
/// lists to the system, and that of short ones not.
const TASKS: usize = 16;

/// Parameters of the passes, by dimension.
struct Pace {
    /// Largest number of passes.
    passes: usize,
    /// Drift factor β, –.
    drift: f64,
    /// Margin of the neighbour lists beyond the kernel's support, dp. The lists are valid until a point has moved half
    /// the margin.
    margin: f64,
}

impl Pace {
    /// Returns the parameters for `dimension`. Rows of a cubic lattice oscillate from β = 0.42, rows of a square
    /// lattice from 0.47: β = 2 over the stiffness of a wave two rows long. In 2-D, where most packed points are not on
    /// a square lattice, β = 0.5 is stable. The few points of 2-D do not justify lists with a margin.
    fn of(dimension: usize) -> Self {
        match dimension {
            2 => Self { passes: 60, drift: 0.5, margin: 0.0 },
            _ => Self { passes: 20, drift: 0.35, margin: 0.3 },
        }
    }
}

/// Moves the first `movable` of `points` until these points are evenly spaced among all `points`.
///
/// `confine(i, from, x)` may move point `i`, which has moved from `from` to `x`, back into its permitted space. It
/// returns the distance (m) that the point can move before the next call of `confine`.
pub(super) fn spread_points<const D: usize>(
    points: &mut [Vector<D>],
    movable: usize,
    dp: f64,
    confine: impl Fn(usize, &Vector<D>, &mut Vector<D>) -> f64 + Sync,
) {
    spread_points_on(&Ranks::default(), points, movable, dp, confine);
}

/// As [`spread_points`], with the work and the neighbour lists shared among `ranks`, which have the same points.
pub(super) fn spread_points_on<const D: usize>(
    ranks: &Ranks,
    points: &mut [Vector<D>],
    movable: usize,
    dp: f64,
    confine: impl Fn(usize, &Vector<D>, &mut Vector<D>) -> f64 + Sync,
) {
    let pace = Pace::of(D);
    let end = |rank: usize| (movable.div_ceil(CHUNK) * rank / ranks.count() * CHUNK).min(movable);
    let own = end(ranks.rank())..end(ranks.rank() + 1);
    let chunk = CHUNK.max(own.len() / (TASKS * rayon::current_num_threads()));
    let parts: Vec<Range<usize>> = (0..ranks.count()).map(|rank| D * end(rank)..D * end(rank + 1)).collect();
    let (mut next, mut room) = (points[own.clone()].to_vec(), vec![0.0; own.len()]);
    let (mut lists, mut travelled) = (Vec::new(), f64::INFINITY);
    for _ in 0..pace.passes {
        if 2.0 * travelled >= pace.margin * dp {
            // The old lists go first: lists are most of the memory here.
            lists.clear();
            List::append_all(&mut lists, points, (own.clone(), chunk), (SUPPORT_RADIUS_DP + pace.margin) * dp);
            travelled = 0.0;
        }
        let chunks = lists.par_iter().zip(next.par_chunks_mut(chunk)).zip(room.par_chunks_mut(chunk)).enumerate();
        let moves = chunks.map(|(c, ((list, next), room))| {
            let (mut weight, mut moved) = (Vec::new(), 0.0_f64);
            for (k, (x, room)) in next.iter_mut().zip(room).enumerate() {
                let at = *x;
                let drift = drift(points, &at, list.of(k), pace.drift, dp, &mut weight);
                *x = at + drift / (drift.norm() / (STEP * dp)).max(1.0);
                *room -= (*x - at).norm();
                if *room <= 0.0 {
                    // The factor is slightly below 1, because the sum of the moves has rounding errors.
                    *room = 0.999 * confine(own.start + c * chunk + k, &at, x);
                }
                moved = moved.max((*x - at).norm());
            }
            moved
        });
        let moved = ranks.max(moves.reduce(|| 0.0, f64::max));
        points[own.clone()].copy_from_slice(&next);
        ranks.share_doubles(bytemuck::cast_slice_mut(&mut points[..movable]), &parts);
        if moved < REST * dp {
            return;
        }
        travelled += moved;
    }
}

/// Returns the displacement (m) by which the points `near` repel a point at `at`, for a drift factor `beta`. `weight`
/// is scratch memory.
fn drift<const D: usize>(
    points: &[Vector<D>],
    at: &Vector<D>,
    near: &[u32],
    beta: f64,
    dp: f64,
    weight: &mut Vec<f64>,
) -> Vector<D> {
    let reach = SUPPORT_RADIUS_DP * dp;
    // Wendland C2: ∇W = norm · (−5 q / h) (1 − q/2)³ r/|r|, times V = dp^D.
    let norm = if D == 2 { 7.0 / (4.0 * PI) } else { 21.0 / (16.0 * PI) } / H.powi(D as i32);
    let factor = 5.0 * norm * beta / (H * H);
    weight.clear();
    weight.extend(near.iter().map(|&j| (at - points[j as usize]).norm_squared()));
    for weight in weight.iter_mut() {
        let tail = (1.0 - weight.sqrt() / reach).max(0.0);
        *weight = tail * tail * tail * factor;
    }
    // The list includes the point itself, which adds nothing.
    near.iter().zip(weight).fold(Vector::zeros(), |sum, (&j, weight)| sum + (at - points[j as usize]) * *weight)
}

/// Neighbour lists of a chunk of points; each list includes the point itself.
struct List {
    end: Box<[u32]>,
    index: Box<[u32]>,
}

impl List {
    /// Appends to `lists` the neighbour lists of `these` of the `points`, `chunk` points in each list, with all points within `reach` (m).
    fn append_all<const D: usize>(
        lists: &mut Vec<Self>,
        points: &[Vector<D>],
        (these, chunk): (Range<usize>, usize),
        reach: f64,
    ) {
        let cells = PointCells::new(points, reach);
        let list = |(row, index): &mut (Vec<f64>, Vec<u32>), points: &[Vector<D>]| {
            index.clear();
            let end = points.iter().map(|at| {
                cells.append_within(at, reach, row, index);
                index.len() as u32
            });
            Self { end: end.collect(), index: index.as_slice().into() }
        };
        lists.par_extend(points[these].par_chunks(chunk).map_init(Default::default, list));
    }

    /// Returns the indices of the neighbours of the `k`-th point.
    fn of(&self, k: usize) -> &[u32] {
        let start = k.checked_sub(1).map_or(0, |before| self.end[before]);
        &self.index[start as usize..self.end[k] as usize]
    }
}

#[cfg(test)]
#[path = "../../tests/unit/geometry/packing.rs"]
mod tests;
