//! Boundary layers of a shape that provides only its signed distance. The module spaces the points evenly over surfaces
//! of constant depth; each layer has as many points as its shell contains cells of dp.
//!
//! The candidate points are the centres of small cells near such a surface. The module moves each candidate onto the
//! surface along the distance gradient. If two opposite faces are too close, the module moves the candidate halfway
//! between them. The module selects the wanted number of candidates as far apart as possible, and spreads the selected
//! points until their spacing is even. Points for which a layer has no space move to the next layer outward. The layers
//! together then have the solid's volume. Where opposite faces leave no space for all layers, the points of all layers
//! finally spread together.

use rayon::prelude::*;

use super::{BoundaryPoint, Shape, boundary_points::MIN_SPACING, cells::spacing_flags, packing};
use crate::math::Vector;

/// Edge of the small cells, dp: eight candidates for each point (3-D).
const GRAIN: f64 = 0.5;
/// Largest deviation of a point from its depth, dp.
const OFF: f64 = 1e-4;
/// Largest lack of depth of a point between two opposite faces, dp; the first layer allows no such lack.
const SHORT: f64 = 0.25;
/// Distance over which the depth falls beyond the middle between two opposite faces, dp.
const MIDWAY: f64 = 0.1;
/// Two faces are opposite if their normals are more than 120 degrees apart: −cos 120°.
pub(super) const OPPOSITE: f64 = 0.5;

/// A cell: its centre (m) and the signed distance (m) of that centre.
type Cell<const D: usize> = (Vector<D>, f64);

/// The cells near the layers, and the volume below the layers.
#[derive(Default)]
struct Found<const D: usize> {
    cells: Vec<Cell<D>>,
    /// Volume below the layers, m³.
    inner: f64,
    /// The least signed distance found, m.
    deepest: f64,
}

/// Returns the boundary particles of `shape` in `layers` layers.
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
    levelled(shape, skin.concat(), dp, layers)
}

/// Spreads the points of all layers together where opposite faces leave no space for all `layers`. There the innermost
/// points, even among themselves, leave holes below the edges if the faces are no whole number of layers apart. The
/// first layer keeps its depth; the others become no less deep than their layers.
fn levelled<const D: usize>(
    shape: &Shape<D>,
    mut skin: Vec<BoundaryPoint<D>>,
    dp: f64,
    layers: usize,
) -> Vec<BoundaryPoint<D>> {
    let between_faces = |p: &BoundaryPoint<D>| at_depth(shape, p.r, layers as f64 * dp, OFF * dp, dp).is_none();
    let movable: Vec<bool> = skin.par_iter().map(between_faces).collect();
    let (mut order, fixed): (Vec<usize>, Vec<usize>) = (0..skin.len()).partition(|&i| movable[i]);
    let many = order.len();
    if many == 0 {
        return skin;
    }
    order.extend(fixed);
    let mut points: Vec<Vector<D>> = order.iter().map(|&i| skin[i].r).collect();
    packing::spread_points(&mut points, many, dp, |i, from, x| {
        let (depth, short) = place_of_layer(skin[order[i]].layer.into(), dp);
        *x = at_depth(shape, *x, depth, short, dp).filter(|x| is_settled(shape, x, depth, dp)).unwrap_or(*from);
        0.0
    });
    order.iter().zip(points).for_each(|(&i, r)| skin[i].r = r);
    skin
}

/// Returns the depth (m) of layer `k`, and how much of it (m) a point midway between two faces may lack.
fn place_of_layer(k: usize, dp: f64) -> (f64, f64) {
    ((k as f64 + 0.5) * dp, if k == 0 { OFF * dp } else { SHORT * dp })
}

/// Whether `x` has the depth `depth` (m), or lies midway between opposite faces: beside an edge a third face may be nearer.
fn is_settled<const D: usize>(shape: &Shape<D>, x: &Vector<D>, depth: f64, dp: f64) -> bool {
    let (distance, normal) = shape.distance_and_normal(x, 1e-3 * dp);
    distance + depth < OFF * dp || shape.signed_distance(&(x - normal * (MIDWAY * dp))) > distance
}

/// Returns the points of layer `k`: `wanted` points, or as many as the layer has space for.
fn layer<const D: usize>(shape: &Shape<D>, cells: &[Cell<D>], k: usize, wanted: usize, dp: f64) -> Vec<Vector<D>> {
    let (depth, short) = place_of_layer(k, dp);
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

/// Returns the least signed distance (m) around the deepest small cell, which need not be in the middle between two faces.
fn deepest<const D: usize>(shape: &Shape<D>, found: &Found<D>, dp: f64) -> f64 {
    let lowest = found.cells.iter().min_by(|a, b| a.1.total_cmp(&b.1));
    let halfway = lowest.and_then(|(x, d)| at_depth(shape, *x, GRAIN * dp - d, GRAIN * dp, dp));
    halfway.map_or(found.deepest, |x| shape.signed_distance(&x).min(found.deepest))
}

/// Returns the small cells no deeper than `depth` (m), and the volume below them. The function recursively halves a
/// cube of edge `edge` (m) around `middle` while the cube may contain such cells.
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

/// Returns the number of cells of dp in the shell of each layer. If the depth allows no further layer, the last layer
/// also receives the volume below it.
fn counts<const D: usize>(shape: &Shape<D>, found: &Found<D>, dp: f64, layers: usize) -> Vec<f64> {
    let grain = GRAIN * dp;
    let deeper = |depth: f64| {
        let share = |&(_, d): &Cell<D>| (0.5 - (d + depth) / grain).clamp(0.0, 1.0);
        found.inner + found.cells.iter().map(share).sum::<f64>() * grain.powi(D as i32)
    };
    let last = (-deepest(shape, found, dp) / dp - 0.5 + SHORT + OFF).floor().max(0.0) as usize;
    let mut volume = vec![shape.volume_properties().volume];
    volume.extend((1..=layers.min(last + 1)).map(|k| deeper(k as f64 * dp)));
    if last < layers
        && let Some(rest) = volume.last_mut()
    {
        *rest = 0.0;
    }
    volume.windows(2).map(|pair| (pair[0] - pair[1]) / dp.powi(D as i32)).collect()
}

/// Moves the point `x` along the gradient to the depth `depth` (m) and returns the new position. If the path first
/// meets the point halfway between two opposite faces, the function returns that point, provided that its depth is
/// short by less than `short` (m). Otherwise the function returns `None`.
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
            // The path moves away from the first face by `off` and towards the other by `turn * off`; `half` is equally
            // far from both.
            let half = x - normal * ((distance - beyond + off * turn) / (1.0 + turn));
            return (shape.signed_distance(&half) + depth < short + OFF * dp).then_some(half);
        }
        (x, distance, normal) = (next, beyond, facing);
    }
    ((distance + depth).abs() < OFF * dp).then_some(x)
}

/// Selects `wanted` of the `candidates` with an approximately even spacing, or fewer if there are fewer candidates. The
/// function first selects at the largest spacing that gives at most `wanted` points. It then adds the missing points as
/// far as possible from the selected points and from one another.
pub(super) fn chosen<const D: usize>(candidates: &[Vector<D>], wanted: usize, dp: f64) -> Vec<Vector<D>> {
    let (mut kept, _) = farthest(&[], candidates, wanted, dp);
    let lack = wanted - kept.len();
    let (_, more) = farthest(&kept, candidates, lack, dp);
    // Removes the surplus points at regular intervals of the list.
    let many = more.len();
    let stays = |i: usize| many <= lack || (i + 1) * lack / many > i * lack / many;
    kept.extend((0..many).filter(|&i| stays(i)).map(|i| more[i]));
    kept
}

/// Returns two selections of `candidates`, in order, spaced from one another and from `fixed`. The first has at most
/// `wanted` points at the largest possible spacing; the second has more points at the largest possible spacing.
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

/// Returns the `points` that are at least `distance` (m) from all `fixed` points and from all points selected earlier.
fn apart<const D: usize>(fixed: &[Vector<D>], points: &[Vector<D>], distance: f64) -> Vec<Vector<D>> {
    let kept = spacing_flags(&[fixed, points].concat(), fixed.len(), distance);
    points.iter().zip(&kept[fixed.len()..]).filter_map(|(x, keep)| keep.then_some(*x)).collect()
}
