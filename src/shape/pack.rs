//! Fitting water to solids off its lattice: points spread until they fill their space evenly.
//!
//! Each movable point drifts down the gradient of the concentration C = Σ V W of all points around it,
//! water and skins alike: δ = −β dp² ∇C, V = dp^D. Where every face has its skin behind it, the even
//! packing ends half a dp before the face.

use std::f64::consts::PI;

use super::cells::Cells;
use crate::space::Vector;

/// Smoothing length, dp. Of 1.0 to 1.5, tried on boxes, discs, balls and slopes, it leaves the smallest gaps.
const H: f64 = 1.0;
/// Reach of the kernel, dp.
pub(super) const REACH: f64 = 2.0 * H;
/// Drift factor β, –; above about 0.9 the pairs start to swing.
const DRIFT: f64 = 0.5;
/// Longest move in one pass, dp.
const STEP: f64 = 0.15;
/// Most passes, and the longest move, in dp, that counts as rest.
const PASSES: usize = 60;
const REST: f64 = 0.01;

/// Moves the first `movable` of `points` until they are evenly spread among all of them. After each pass
/// `confine(i, x)` may put point `i` back where it is allowed to be.
pub(super) fn relax<const D: usize>(
    points: &mut [Vector<D>],
    movable: usize,
    dp: f64,
    confine: impl Fn(usize, &mut Vector<D>),
) {
    let reach = REACH * dp;
    // Wendland C2: ∇W = norm · (−5 q / h) (1 − q/2)³ r/|r|, times V = dp^D.
    let norm = if D == 2 { 7.0 / (4.0 * PI) } else { 21.0 / (16.0 * PI) } / H.powi(D as i32);
    let factor = 5.0 * norm * DRIFT / (H * H);
    for _ in 0..PASSES {
        let cells = Cells::new(points, reach);
        let mut moved: f64 = 0.0;
        let mut next: Vec<Vector<D>> = points[..movable].to_vec();
        for (i, x) in next.iter_mut().enumerate() {
            let at = points[i];
            let mut drift = Vector::zeros();
            cells.near(&at, |j, y| {
                let r = at - y;
                let r2 = r.norm_squared();
                if r2 < reach * reach && j != i {
                    let tail = 1.0 - r2.sqrt() / reach;
                    drift += r * (tail * tail * tail * factor);
                }
            });
            let longest = drift.norm() / (STEP * dp);
            *x = at + drift / longest.max(1.0);
            confine(i, x);
            moved = moved.max((*x - at).norm());
        }
        points[..movable].copy_from_slice(&next);
        if moved < REST * dp {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_disturbed_lattice_becomes_even_again() {
        let mut points: Vec<Vector<2>> = Vec::new();
        let cell = |i: i32, j: i32| Vector::from([i as f64, j as f64]);
        for (i, j) in (0..49).map(|k| (k % 7 - 3, k / 7 - 3)) {
            points.push(cell(i, j) + Vector::from([(3.0 * i as f64).sin(), (5.0 * j as f64).cos()]) * 0.2);
        }
        let movable = points.len();
        let outer = (0..225_i32).map(|k| (k % 15 - 7, k / 15 - 7)).filter(|(i, j)| i.abs() > 3 || j.abs() > 3);
        points.extend(outer.map(|(i, j)| cell(i, j)));
        relax(&mut points, movable, 1.0, |_, _| ());
        for (k, x) in points.iter().enumerate() {
            let nearest = points.iter().enumerate().filter(|(j, _)| *j != k).map(|(_, y)| (x - y).norm());
            let gap = nearest.fold(f64::INFINITY, f64::min);
            assert!((0.85..=1.01).contains(&gap), "{k}: {gap}");
        }
    }
}
