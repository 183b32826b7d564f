//! Places where a surface passes through itself, or where two facets cover the same area: their number and depth.

use std::collections::{BTreeSet, HashMap};

use rayon::prelude::*;

use super::{Mesh, facet_normal, shells::solid_angle, tree::FacetTree, welding::format_position};
use crate::{
    error::{Error, Result},
    math::Vector,
};

/// Least penetration of one facet through another that counts, over the size of the smaller facet. A smaller value is
/// the round-off of a file in single precision.
const THROUGH: f64 = 1e-5;

/// The same over the size of the mesh.
const THROUGH_OF_MESH: f64 = 1e-7;

/// Largest number of solid angles that the search for the deepest buried facet computes.
const MOST_ANGLES: usize = 200_000_000;

/// Largest number of crossing pairs that are stored.
const MOST_PAIRS: usize = 100_000;

/// Two facets that pass through each other or cover the same area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Crossing {
    /// Distance (m) by which one of the facets has to move until they are apart.
    depth: f64,
    /// Whether both lie in one plane and have the same orientation.
    overlaps: bool,
}

/// All crossings of a mesh.
#[derive(Default)]
pub(crate) struct Crossings {
    count: usize,
    overlapping: usize,
    deepest: Option<(f64, usize, usize)>,
    pairs: Vec<(usize, usize)>,
}

impl Crossings {
    /// Adds the crossing of the facets `a` and `b`.
    pub(crate) fn add(mut self, a: usize, b: usize, crossing: Crossing) -> Self {
        self.count += 1;
        self.overlapping += usize::from(crossing.overlaps);
        if self.deepest.is_none_or(|(depth, ..)| crossing.depth > depth) {
            self.deepest = Some((crossing.depth, a, b));
        }
        if self.pairs.len() < MOST_PAIRS {
            self.pairs.push((a, b));
        }
        self
    }

    /// Returns the crossings of both; those of `self` come first.
    pub(crate) fn and(mut self, other: Self) -> Self {
        self.count += other.count;
        self.overlapping += other.overlapping;
        if let Some(deepest) = other.deepest
            && self.deepest.is_none_or(|(depth, ..)| deepest.0 > depth)
        {
            self.deepest = other.deepest;
        }
        let room = MOST_PAIRS - self.pairs.len();
        self.pairs.extend(other.pairs.into_iter().take(room));
        self
    }
}

/// Refuses crossings deeper than `tolerance` (m). Returns a sentence about those that remain.
pub(super) fn check(mesh: &Mesh, tolerance: f64) -> Result<Option<String>> {
    let found = mesh.tree.find_crossings(mesh);
    let Some((mut depth, a, b)) = found.deepest else { return Ok(None) };
    let mut by = String::new();
    if depth <= tolerance {
        match buried_depth(mesh, &found) {
            Some(buried) => depth = depth.max(buried),
            None => {
                depth = f64::INFINITY;
                by = format!("by more than {tolerance:.1e} m");
            }
        }
    }
    if by.is_empty() {
        by = format!("by {depth:.1e} m at most");
    }
    let places = if found.count == 1 { "1 place".to_string() } else { format!("{} places", found.count) };
    if depth <= tolerance {
        return Ok(Some(format!("the surface passes through itself at {places}, {by}; this is tolerated")));
    }
    let middle = |f: usize| format_position(&(mesh.facet_corners(f).iter().sum::<Vector<3>>() / 3.0));
    let (first, second) = (middle(a), middle(b));
    let limit = if tolerance > 0.0 { format!("; {tolerance:.1e} m is tolerated here") } else { String::new() };
    let what = match found.overlapping {
        0 => format!("the mesh passes through itself at {places}, {by}: its facets about {first} and {second} m cross"),
        _ => format!(
            "parts of the mesh share volume, which counts twice: facets cross or cover the same area at {places}, {by}, \
             as about {first} and {second} m"
        ),
    };
    let help = format!("unite its parts (a \"boolean union\") in the program that made it: volume counts once{limit}");
    Err(Error::scene(what).help(help))
}

/// Returns the crossing of two facets, or `None` if they are apart, touch, or share an edge.
pub(crate) fn crossing(mesh: &Mesh, size: f64, one: usize, other: usize) -> Option<Crossing> {
    let (f, g) = (mesh.facets[one], mesh.facets[other]);
    let shared = f.map(|p| g.contains(&p));
    if shared.iter().filter(|shared| **shared).count() > 1 {
        return None;
    }
    let (a, b) = (mesh.facet_corners(one), mesh.facet_corners(other));
    let longest = |f: &[Vector<3>; 3]| (0..3).map(|i| (f[(i + 1) % 3] - f[i]).norm()).fold(0.0, f64::max);
    // The normal of a facet that is as narrow as round-off is noise. What passes through it passes through its neighbours.
    let width = |f: &[Vector<3>; 3]| (f[1] - f[0]).cross(&(f[2] - f[0])).norm() / longest(f);
    if width(&a).min(width(&b)) <= THROUGH_OF_MESH * size {
        return None;
    }
    let least = (THROUGH * longest(&a).min(longest(&b))).max(THROUGH_OF_MESH * size);
    let (na, nb) = (facet_normal(&a)?, facet_normal(&b)?);
    // A shared corner lies in both planes, without round-off.
    let heights = |corners: &[Vector<3>; 3], facet: &[u32; 3], other: &[u32; 3], n: &Vector<3>, x: &Vector<3>| {
        [0, 1, 2].map(|i| if other.contains(&facet[i]) { 0.0 } else { n.dot(&(corners[i] - x)) })
    };
    let (ha, hb) = (heights(&a, &f, &g, &nb, &b[0]), heights(&b, &g, &f, &na, &a[0]));
    let (la, lb) = (through(&ha), through(&hb));
    if ha.iter().chain(&hb).all(|h| h.abs() <= least) {
        let depth = overlap_in_plane(&a, &b, &na);
        return (na.dot(&nb) > 0.0 && depth > least).then_some(Crossing { depth, overlaps: true });
    }
    if la <= least || lb <= least {
        return None;
    }
    let line = na.cross(&nb).try_normalize(1e-12)?;
    let ((a0, a1), (b0, b1)) = (interval(&a, &ha, &line)?, interval(&b, &hb, &line)?);
    (a1.min(b1) - a0.max(b0) > least).then_some(Crossing { depth: la.min(lb), overlaps: false })
}

/// Returns how far a facet with these heights over a plane reaches through the plane; negative if it does not.
fn through(heights: &[f64; 3]) -> f64 {
    let (low, high) = heights.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(*x), h.max(*x)));
    high.min(-low)
}

/// Returns the part of `line` inside a facet whose corners have these heights over a plane through the line.
fn interval(corners: &[Vector<3>; 3], heights: &[f64; 3], line: &Vector<3>) -> Option<(f64, f64)> {
    let at = |i: usize| line.dot(&corners[i]);
    let crossed = (0..3).map(|i| (i, (i + 1) % 3)).filter(|&(i, j)| heights[i] * heights[j] < 0.0);
    let between = crossed.map(|(i, j)| at(i) + (at(j) - at(i)) * (heights[i] / (heights[i] - heights[j])));
    let touching = (0..3).filter(|&i| heights[i] == 0.0).map(at);
    let ends: Vec<f64> = between.chain(touching).collect();
    let low = ends.iter().copied().fold(f64::INFINITY, f64::min);
    let high = ends.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    (ends.len() > 1).then_some((low, high))
}

/// Returns the least distance (m) in which two facets in the plane normal to `n` have to move until they are apart.
fn overlap_in_plane(a: &[Vector<3>; 3], b: &[Vector<3>; 3], n: &Vector<3>) -> f64 {
    let range = |f: &[Vector<3>; 3], axis: &Vector<3>| {
        f.iter().map(|x| axis.dot(x)).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)))
    };
    let sides = [a, b].into_iter().flat_map(|f| (0..3).map(move |i| f[(i + 1) % 3] - f[i]));
    let axes = sides.filter_map(|side| n.cross(&side).try_normalize(0.0));
    let depth = |axis: Vector<3>| {
        let ((a0, a1), (b0, b1)) = (range(a, &axis), range(b, &axis));
        (a1 - b0).min(b1 - a0)
    };
    axes.map(depth).fold(f64::INFINITY, f64::min)
}

/// Returns the largest distance (m) from the middle of a facet that lies inside another part of the solid to the rest of
/// the surface. Crossings of the rim of a part can be shallow although the part lies deep in another. Returns `None` if
/// too many facets lie inside.
fn buried_depth(mesh: &Mesh, found: &Crossings) -> Option<f64> {
    let all = mesh.facets.len();
    let mut around: HashMap<u32, Vec<usize>> = HashMap::new();
    for (i, facet) in mesh.facets.iter().enumerate() {
        facet.iter().for_each(|&p| around.entry(p).or_default().push(i));
    }
    let middle = |f: usize| mesh.facet_corners(f).iter().sum::<Vector<3>>() / 3.0;
    let is_buried = |f: usize| {
        let x = middle(f);
        let others = (0..all).filter(|&g| g != f).map(|g| solid_angle(&mesh.facet_corners(g), &x));
        // The facet itself contributes a half turn; facets through its middle contribute nothing.
        let turns = others.filter(|angle| angle.is_finite()).sum::<f64>() / (4.0 * std::f64::consts::PI);
        !(-0.01..=1.01).contains(&turns)
    };
    let mut visited: BTreeSet<usize> = found.pairs.iter().flat_map(|&(a, b)| [a, b]).collect();
    let (mut next, mut buried): (Vec<usize>, Vec<usize>) = (visited.iter().copied().collect(), Vec::new());
    if found.count > MOST_PAIRS {
        return None;
    }
    while !next.is_empty() {
        if visited.len().saturating_mul(all) > MOST_ANGLES {
            return None;
        }
        let inside: Vec<usize> = next.into_par_iter().filter(|&f| is_buried(f)).collect();
        let beside = inside.iter().flat_map(|&f| mesh.facets[f]).flat_map(|p| around[&p].iter().copied());
        next = beside.filter(|f| visited.insert(*f)).collect();
        buried.extend(inside);
    }
    if buried.is_empty() {
        return Some(0.0);
    }
    let inner: BTreeSet<usize> = buried.iter().copied().collect();
    let rest: Vec<[u32; 3]> = (0..all).filter(|f| !inner.contains(f)).map(|f| mesh.facets[f]).collect();
    let rest = FacetTree::new(&mesh.points, &rest).ok()?;
    Some(buried.iter().map(|&f| rest.distance_and_normal(&middle(f)).0.abs()).fold(0.0, f64::max))
}
