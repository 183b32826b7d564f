//! Layers of a shape that has only its signed distance: points spread evenly over the surfaces of equal depth, as many
//! in each layer as its shell holds cells of dp.
//!
//! Candidates are the middles of small cells near such a surface, moved onto it along the distance's gradient, or, where
//! the faces on either side are too near each other for it, halfway between them. Of these as many as are wanted are
//! kept, as far apart as they can be, and pushed apart until they lie evenly. What a layer has no room for goes to the
//! next one outward, so that the whole skin has the solid's volume.

use rayon::prelude::*;

use super::{BoundaryPoint, Shape, boundary_points::MIN_SPACING, cells::spacing_flags, packing};
use crate::math::Vector;

/// Edge of the cells, dp: eight candidates for each point.
const GRAIN: f64 = 0.5;
/// How far from its depth a point may be left, dp.
const OFF: f64 = 1e-4;
/// How far from its depth a point between two faces may be, dp; not in the first layer.
const SHORT: f64 = 0.25;
/// The faces on either side of a place are held to be opposite where their normals are more than 120 degrees apart: this
/// is −cos 120°.
const OPPOSITE: f64 = 0.5;

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
pub(super) fn points_by_distance<const D: usize>(shape: &Shape<D>, dp: f64, layers: usize) -> Vec<BoundaryPoint<D>> {
    let bounds = shape.bounds();
    let grain = GRAIN * dp;
    let doublings = (bounds.size().max() / grain).log2().ceil().max(0.0) as i32;
    let middle = (bounds.min + bounds.max) * 0.5;
    let found = walk(shape, &middle, grain * 2f64.powi(doublings), grain, layers as f64 * dp);
    let (mut skin, mut owed) = (Vec::new(), 0.0);
    for (k, cells) in counts(shape, &found, dp, layers).into_iter().enumerate().rev() {
        owed += cells;
        let points = layer(shape, &found.cells, k, owed.round().max(0.0) as usize, dp);
        owed -= points.len() as f64;
        skin.push(points.into_iter().map(|r| BoundaryPoint { r, layer: k as u8 }).collect::<Vec<_>>());
    }
    skin.reverse();
    skin.concat()
}

/// The points of layer `k`: `wanted` of them, or as many as it has room for.
fn layer<const D: usize>(shape: &Shape<D>, cells: &[Cell<D>], k: usize, wanted: usize, dp: f64) -> Vec<Vector<D>> {
    let depth = (k as f64 + 0.5) * dp;
    let short = if k == 0 { OFF * dp } else { SHORT * dp };
    let near = cells.par_iter().filter(|(_, d)| (d + depth).abs() <= GRAIN * dp);
    let candidates: Vec<_> = near.filter_map(|(x, _)| at_depth(shape, *x, depth, short, dp)).collect();
    let mut points = chosen(&candidates, wanted, dp);
    let many = points.len();
    packing::spread_points(&mut points, many, dp, |_, from, x| {
        *x = at_depth(shape, *x, depth, short, dp).unwrap_or(*from);
        0.0
    });
    apart(&[], &points, MIN_SPACING * dp)
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

/// How many cells of dp the shell of each layer holds. What lies deeper than the last layer, too little for one more, goes
/// to that.
fn counts<const D: usize>(shape: &Shape<D>, found: &Found<D>, dp: f64, layers: usize) -> Vec<f64> {
    let grain = GRAIN * dp;
    let deeper = |depth: f64| {
        let share = |&(_, d): &Cell<D>| (0.5 - (d + depth) / grain).clamp(0.0, 1.0);
        found.inner + found.cells.iter().map(share).sum::<f64>() * grain.powi(D as i32)
    };
    let last = (-found.deepest / dp - 0.5 + SHORT).floor().max(0.0) as usize;
    let mut volume = vec![shape.volume_properties().volume];
    volume.extend((1..=layers.min(last + 1)).map(|k| deeper(k as f64 * dp)));
    if last < layers
        && let Some(rest) = volume.last_mut()
    {
        *rest = 0.0;
    }
    volume.windows(2).map(|pair| (pair[0] - pair[1]) / dp.powi(D as i32)).collect()
}

/// The place at the depth `depth` (m) that the point `x` comes to along the gradient; or the place halfway between two
/// opposite faces, if it meets that first and no more than `short` (m) is missing there. `None` where there is none.
fn at_depth<const D: usize>(shape: &Shape<D>, mut x: Vector<D>, depth: f64, short: f64, dp: f64) -> Option<Vector<D>> {
    let slope = |x: &Vector<D>| shape.distance_and_normal(x, 1e-3 * dp);
    let (mut distance, mut normal) = slope(&x);
    for _ in 0..40 {
        let off = distance + depth;
        if off.abs() < 1e-9 * dp {
            return Some(x);
        }
        let next = x - normal * off;
        let (beyond, facing) = slope(&next);
        let turn = -normal.dot(&facing);
        if off > 0.0 && turn > OPPOSITE {
            // One face is left by `off` on this way and the other neared by `turn * off`: where they are equally far.
            let half = x - normal * ((distance - beyond + off * turn) / (1.0 + turn));
            return (shape.signed_distance(&half) + depth < short).then_some(half);
        }
        (x, distance, normal) = (next, beyond, facing);
    }
    ((distance + depth).abs() < OFF * dp).then_some(x)
}

/// About evenly, `wanted` of `candidates`, if there are so many: as far apart as the most can be that are not too many,
/// and as far from these and one another as those that lack then can be.
fn chosen<const D: usize>(candidates: &[Vector<D>], wanted: usize, dp: f64) -> Vec<Vector<D>> {
    let (mut kept, _) = farthest(&[], candidates, wanted, dp);
    let lack = wanted - kept.len();
    let (_, more) = farthest(&kept, candidates, lack, dp);
    // The few too many go here and there.
    let many = more.len();
    let stays = |i: usize| many <= lack || (i + 1) * lack / many > i * lack / many;
    kept.extend((0..many).filter(|&i| stays(i)).map(|i| more[i]));
    kept
}

/// The farthest apart that at most `wanted` of `candidates` can be, from `fixed` too, taken in order; and the farthest
/// apart that more can be.
fn farthest<const D: usize>(
    fixed: &[Vector<D>],
    candidates: &[Vector<D>],
    wanted: usize,
    dp: f64,
) -> (Vec<Vector<D>>, Vec<Vector<D>>) {
    let (mut few, mut many) = (Vec::new(), candidates.to_vec());
    let (mut low, mut high) = (0.0, 1.5);
    for _ in 0..8 {
        let middle = 0.5 * (low + high);
        let some = apart(fixed, candidates, middle * dp);
        match some.len() > wanted {
            true => (low, many) = (middle, some),
            false => (high, few) = (middle, some),
        }
    }
    (few, many)
}

/// Those of `points` that keep `distance` (m) from all of `fixed` and from all earlier ones.
fn apart<const D: usize>(fixed: &[Vector<D>], points: &[Vector<D>], distance: f64) -> Vec<Vector<D>> {
    let kept = spacing_flags(&[fixed, points].concat(), fixed.len(), distance);
    points.iter().zip(&kept[fixed.len()..]).filter_map(|(x, keep)| keep.then_some(*x)).collect()
}
