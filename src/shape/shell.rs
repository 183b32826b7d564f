//! Layers of a shape that has only its signed distance: points spread evenly over the surfaces of equal depth, as many
//! in each layer as its shell holds cells of dp.
//!
//! Candidates are the middles of small cells near such a surface, moved onto it along the distance's gradient. Of these
//! as many as are wanted are kept, as far apart as they can be, and pushed apart until they lie evenly.

use rayon::prelude::*;

use super::{Shape, SkinPoint, cells::spaced, pack};
use crate::space::Vector;

/// Edge of the cells, dp: eight candidates for each point.
const GRAIN: f64 = 0.5;
/// How far from its depth a point may be left, dp.
const OFF: f64 = 1e-4;

/// A cell: its middle, m, and that middle's signed distance, m.
type Cell<const D: usize> = (Vector<D>, f64);

/// The cells near the layers, and what lies deeper.
#[derive(Default)]
struct Found<const D: usize> {
    cells: Vec<Cell<D>>,
    /// Volume of the deeper ones, m³.
    inner: f64,
    /// The least signed distance met, m.
    deepest: f64,
}

/// Boundary particles of `shape` in `layers` layers.
pub(super) fn shell_skin<const D: usize>(shape: &Shape<D>, dp: f64, layers: usize) -> Vec<SkinPoint<D>> {
    let bounds = shape.bounds();
    let grain = GRAIN * dp;
    let doublings = (bounds.size().max() / grain).log2().ceil().max(0.0) as i32;
    let middle = (bounds.min + bounds.max) * 0.5;
    let found = walk(shape, &middle, grain * 2f64.powi(doublings), grain, layers as f64 * dp);
    let wanted = counts(shape, &found, dp, layers);
    let layer = |(k, wanted): (usize, f64)| {
        let depth = (k as f64 + 0.5) * dp;
        let near = found.cells.par_iter().filter(|(_, d)| (d + depth).abs() <= grain);
        let candidates: Vec<_> = near.filter_map(|(x, _)| at_depth(shape, *x, depth, dp)).collect();
        let mut points = chosen(&candidates, wanted.round().max(0.0) as usize, dp);
        let many = points.len();
        pack::relax(&mut points, many, dp, |_, x| {
            *x = at_depth(shape, *x, depth, dp).unwrap_or(*x);
            0.0
        });
        points.into_iter().map(move |r| SkinPoint { r, layer: k as u8 })
    };
    wanted.into_iter().enumerate().flat_map(layer).collect()
}

/// The small cells no deeper than `depth` (m), by halving a cube of edge `edge` (m) about `middle` wherever it may hold
/// some.
fn walk<const D: usize>(shape: &Shape<D>, middle: &Vector<D>, edge: f64, grain: f64, depth: f64) -> Found<D> {
    let distance = shape.signed_distance(middle);
    let reach = 0.5 * edge * (D as f64).sqrt();
    let mut found = Found { deepest: distance, ..Found::default() };
    if distance > reach {
        return found;
    }
    if distance < -depth - reach - grain {
        found.inner = edge.powi(D as i32);
        return found;
    }
    if edge < 1.5 * grain {
        found.cells.push((*middle, distance));
        return found;
    }
    let child = |corner: usize| {
        let side = |i: usize| if corner >> i & 1 == 1 { 0.25 } else { -0.25 };
        let at = Vector::from_fn(|i, _| middle[i] + side(i) * edge);
        walk(shape, &at, 0.5 * edge, grain, depth)
    };
    let parts: Vec<Found<D>> = match edge > 16.0 * grain {
        true => (0..1usize << D).into_par_iter().map(child).collect(),
        false => (0..1usize << D).map(child).collect(),
    };
    for part in parts {
        found.cells.extend(part.cells);
        found.inner += part.inner;
        found.deepest = found.deepest.min(part.deepest);
    }
    found
}

/// How many cells of dp the shell of each layer holds. What lies deeper than the last surface of equal depth, too little
/// for a layer, goes to the last layer.
fn counts<const D: usize>(shape: &Shape<D>, found: &Found<D>, dp: f64, layers: usize) -> Vec<f64> {
    let grain = GRAIN * dp;
    let deeper = |depth: f64| {
        let share = |&(_, d): &Cell<D>| (0.5 - (d + depth) / grain).clamp(0.0, 1.0);
        found.inner + found.cells.iter().map(share).sum::<f64>() * grain.powi(D as i32)
    };
    let last = (-found.deepest / dp - 0.5).floor().max(0.0) as usize;
    let mut volume = vec![shape.volume().volume];
    volume.extend((1..=layers.min(last + 1)).map(|k| deeper(k as f64 * dp)));
    if last < layers
        && let Some(rest) = volume.last_mut()
    {
        *rest = 0.0;
    }
    volume.windows(2).map(|pair| (pair[0] - pair[1]) / dp.powi(D as i32)).collect()
}

/// The place at the depth `depth` (m) that the point `x` comes to along the gradient; `None` where there is none.
fn at_depth<const D: usize>(shape: &Shape<D>, mut x: Vector<D>, depth: f64, dp: f64) -> Option<Vector<D>> {
    for _ in 0..40 {
        let off = shape.signed_distance(&x) + depth;
        if off.abs() < 1e-9 * dp {
            return Some(x);
        }
        x -= shape.outward(&x, 1e-3 * dp) * off;
    }
    ((shape.signed_distance(&x) + depth).abs() < OFF * dp).then_some(x)
}

/// About evenly, `wanted` of `candidates`: as far apart as so many can be, taken in order.
fn chosen<const D: usize>(candidates: &[Vector<D>], wanted: usize, dp: f64) -> Vec<Vector<D>> {
    let (mut low, mut high) = (0.0, 1.5);
    let mut kept = candidates.to_vec();
    for _ in 0..8 {
        let apart = 0.5 * (low + high);
        let flags = spaced(candidates, apart * dp);
        if flags.iter().filter(|keep| **keep).count() >= wanted {
            kept = candidates.iter().zip(flags).filter_map(|(x, keep)| keep.then_some(*x)).collect();
            low = apart;
        } else {
            high = apart;
        }
    }
    // The few too many go here and there.
    let many = kept.len();
    let stays = |i: usize| (i + 1) * wanted / many > i * wanted / many;
    if many <= wanted { kept } else { (0..many).filter(|&i| stays(i)).map(|i| kept[i]).collect() }
}
