//! The surface of a mesh file before it is a solid: joins corners, removes doubled facets, and turns facets outward.
//! Each change is recorded as a note.

use std::collections::HashMap;

use super::{LARGEST, MAX_FACETS, Mesh, completion, moments, shells, welding};
use crate::{
    error::{Error, Result},
    math::{Bounds, Vector},
};

/// Distance below which corners are joined, over the size of the mesh: the round-off of a file in single precision.
const JOINED: f64 = 1e-6;

/// Number of open edges that are searched for corners of other facets.
const MOST_EDGES: usize = 100;

/// Depth below which a crossing of the surface with itself is tolerated, over the size of the mesh.
const TOLERATED: f64 = 1e-4;

/// Triangles as a file contains them. A part is a set of facets that the file keeps apart from the others.
#[derive(Clone, Default)]
pub(crate) struct Surface {
    pub(crate) points: Vec<Vector<3>>,
    pub(crate) facets: Vec<[u32; 3]>,
    /// The part of each facet.
    pub(crate) parts: Vec<u32>,
}

/// The completion of a surface that is not closed, and the tolerance of crossings.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Completion {
    /// Whether the surface is mirrored at 0 along each axis.
    pub(crate) mirror: [bool; 3],
    /// The number of the axis normal to the plane in which open edges are closed.
    pub(crate) cap: Option<usize>,
    /// Thickness (m) of a plate around the surface.
    pub(crate) thickness: Option<f64>,
    /// Largest tolerated depth (m) of a crossing.
    pub(crate) crossing: f64,
}

impl Surface {
    /// Returns the solid inside the surface, and a sentence for each change.
    ///
    /// # Errors
    /// The errors of [`Mesh::new`], except for facets that can be turned, and for crossings that are tolerated; `Scene`
    /// if a completion does not apply to the surface.
    pub(crate) fn into_solid(self, completion: &Completion) -> Result<(Mesh, Vec<String>)> {
        check_input(&self.points, &self.facets)?;
        let mut notes = Vec::new();
        let mut surface = self.joined_as_needed(&mut notes)?;
        let size = surface.bounds().size().max();
        let mut turned = surface.unify_orientation();
        if *completion != (Completion { crossing: completion.crossing, ..Completion::default() }) {
            if let Some(sentence) = reversed_facets(&turned) {
                notes.push(sentence);
            }
            surface.complete(completion, &mut notes)?;
            turned = vec![false; surface.facets.len()];
        }
        welding::check_closed(&surface.points, &surface.facets).map_err(|e| surface.completion_help(e))?;
        let reversed = shells::turn_outward(&surface.points, &mut surface.facets, &turned)?;
        turned.iter_mut().zip(reversed).for_each(|(a, b)| *a ^= b);
        notes.extend(reversed_facets(&turned));
        let tolerance = completion.crossing.min(TOLERATED * size);
        let (mesh, crossings) =
            Mesh::checked(surface.points, surface.facets, tolerance).map_err(|e| match completion.thickness {
                Some(thickness) => {
                    let sizes = format!("thickness = {thickness} is in m, and the mesh is {size:.4} m large");
                    let help = e.help.clone().map_or_else(|| sizes.clone(), |help| format!("{sizes}; {help}"));
                    e.help(help)
                }
                None => e,
            })?;
        notes.extend(crossings);
        Ok((mesh, notes))
    }

    /// Mirrors, caps and thickens the surface, in this order.
    fn complete(&mut self, completion: &Completion, notes: &mut Vec<String>) -> Result<()> {
        for axis in (0..3).filter(|axis| completion.mirror[*axis]) {
            completion::mirror(self, axis, notes)?;
            self.unify_orientation();
        }
        if let Some(axis) = completion.cap {
            completion::cap(self, axis, notes)?;
            self.unify_orientation();
        }
        completion.thickness.map_or(Ok(()), |thickness| completion::thicken(self, thickness, notes))
    }

    /// Adds the key that would close the surface to the remedy of an error about it.
    fn completion_help(&self, error: Error) -> Error {
        let open = completion::open_edges(self);
        if open.is_empty() {
            return error;
        }
        let closes = |axis: &usize| {
            let mut capped = self.clone();
            completion::cap(&mut capped, *axis, &mut Vec::new()).is_ok() && capped.is_closed() && capped.has_volume()
        };
        let key = if let Some(corner) = self.corner_on_edge(&open) {
            let at = welding::format_position(&corner);
            format!("the corner {at} m lies on the edge of another facet: divide that edge there")
        } else if let Some(axis) = (0..3).find(closes) {
            let name = completion::AXES[axis];
            format!(
                "its open edges lie in a plane: write  cap = \"{name}\"  to close them, or  mirror = \"{name}\"  for a half"
            )
        } else {
            "a sheet becomes a plate by  thickness = 0.01  (m)".into()
        };
        let help = error.help.clone().map_or_else(|| key.clone(), |help| format!("{help}; {key}"));
        error.help(help)
    }

    /// Returns a corner of the open edges that lies inside one of the first of them.
    fn corner_on_edge(&self, open: &[[u32; 2]]) -> Option<Vector<3>> {
        let tolerance = JOINED * self.bounds().size().max();
        let corners = || open.iter().flatten().map(|&p| self.points[p as usize]);
        let inside = |x: &Vector<3>, [a, b]: &[Vector<3>; 2]| {
            let side = b - a;
            let along = (x - a).dot(&side) / side.norm();
            let off = (x - a - side * (along / side.norm())).norm();
            off <= tolerance && along > tolerance && along < side.norm() - tolerance
        };
        let edges = open.iter().take(MOST_EDGES).map(|edge| edge.map(|p| self.points[p as usize]));
        edges.into_iter().find_map(|edge| corners().find(|x| inside(x, &edge)))
    }

    pub(super) fn bounds(&self) -> Bounds<3> {
        Bounds::around(&self.points)
    }

    /// Returns the surface with the fewest joined corners that is closed, or the one with the most if none is closed.
    fn joined_as_needed(self, notes: &mut Vec<String>) -> Result<Self> {
        let tolerance = JOINED * self.bounds().size().max();
        let (exact, _) = self.join(0.0, false);
        if exact.is_closed() {
            return Ok(exact);
        }
        let (mut near, count) = self.join(tolerance, false);
        if near.is_double_sided() {
            let what = "the mesh is double-sided: each facet occurs twice, once for each side";
            return Err(Error::scene(what).help(
                "export one side: of a closed surface the facets that face outward; one side of a sheet becomes a plate by  \
                 thickness",
            ));
        }
        let mut changes = Vec::new();
        if count > 0 {
            changes.push(format!(
                "{} joined to others within {tolerance:.1e} m, which is {JOINED:.0e} of the size",
                counted(count, "corner is", "corners are")
            ));
        }
        changes.extend(near.remove_doubled_facets());
        if !near.is_closed() {
            let (broad, removed) = near.without_lines(tolerance);
            if broad.is_closed() {
                near = broad;
                changes
                    .push(format!("{} removed", counted(removed, "facet without area is", "facets without area are")));
            }
        }
        if !near.is_closed() {
            // Parts that touch along edges are closed only if each keeps its corners.
            let (apart, count) = self.join(tolerance, true);
            if apart.is_closed() {
                if count > 0 {
                    notes.push(format!(
                        "{} joined to others of its part within {tolerance:.1e} m",
                        counted(count, "corner is", "corners are")
                    ));
                }
                return Ok(apart);
            }
        }
        notes.extend(changes);
        Ok(near)
    }

    /// Returns the surface without facets whose corners lie on a line within `tolerance` (m), and their number.
    fn without_lines(&self, tolerance: f64) -> (Self, usize) {
        let is_line = |facet: usize| {
            let corners = self.facets[facet].map(|p| self.points[p as usize]);
            let longest = (0..3).map(|i| (corners[(i + 1) % 3] - corners[i]).norm()).fold(0.0, f64::max);
            2.0 * self.facet_area(facet) <= tolerance * longest
        };
        let mut broad = Self { points: self.points.clone(), ..Self::default() };
        for i in (0..self.facets.len()).filter(|i| !is_line(*i)) {
            broad.facets.push(self.facets[i]);
            broad.parts.push(self.parts[i]);
        }
        let removed = self.facets.len() - broad.facets.len();
        (broad, removed)
    }

    /// Returns whether each edge has as many facets in one direction as in the other, some have several, and the facets enclose
    /// nothing.
    fn is_double_sided(&self) -> bool {
        let edges = sorted_edges(&self.facets);
        let groups = || edges.chunk_by(|a, b| (a.low, a.high) == (b.low, b.high));
        let balanced = |group: &[Edge]| 2 * group.iter().filter(|edge| edge.up).count() == group.len();
        groups().all(balanced) && groups().any(|group| group.len() > 2) && !self.has_volume()
    }

    /// Returns whether the facets enclose more than round-off.
    fn has_volume(&self) -> bool {
        let area: f64 = (0..self.facets.len()).map(|i| self.facet_area(i)).sum();
        moments(&self.points, &self.facets).volume.abs() > JOINED * area * self.bounds().size().max()
    }

    /// Returns the surface with corners within `tolerance` (m) joined, without facets whose corners coincide, and the
    /// number of joined positions. If `by_part`, corners of different parts stay apart. The first corner keeps its
    /// position.
    fn join(&self, tolerance: f64, by_part: bool) -> (Self, usize) {
        let (mut points, mut count) = (Vec::new(), 0);
        let mut exact: HashMap<([u64; 3], u32), u32> = HashMap::new();
        let mut cells: HashMap<([i64; 3], u32), Vec<u32>> = HashMap::new();
        let width = 4.0 * tolerance;
        let cell = |x: f64| (x / width).floor() as i64;
        let mut index = |p: u32, part: u32| {
            // −0 and 0 are the same position.
            let x: Vector<3> = self.points[p as usize].add_scalar(0.0);
            *exact.entry(([x[0].to_bits(), x[1].to_bits(), x[2].to_bits()], part)).or_insert_with(|| {
                if tolerance > 0.0 {
                    let range = |i: usize| cell(x[i] - tolerance)..=cell(x[i] + tolerance);
                    let around = range(0).flat_map(|i| range(1).map(move |j| (i, j)));
                    let around = around.flat_map(|(i, j)| range(2).map(move |k| [i, j, k]));
                    let others = around.filter_map(|key| cells.get(&(key, part))).flatten();
                    let distance = |q: u32| -> f64 { (x - points[q as usize] as Vector<3>).norm() };
                    let nearest = others.copied().min_by(|a, b| distance(*a).total_cmp(&distance(*b)));
                    if let Some(q) = nearest.filter(|q| distance(*q) <= tolerance) {
                        count += 1;
                        return q;
                    }
                    let key = [cell(x[0]), cell(x[1]), cell(x[2])];
                    cells.entry((key, part)).or_default().push(points.len() as u32);
                }
                points.push(x);
                points.len() as u32 - 1
            })
        };
        let mut joined = Self::default();
        for (facet, &part) in self.facets.iter().zip(&self.parts) {
            let facet = facet.map(|p| index(p, if by_part { part } else { 0 }));
            if !has_repeated_corner(&facet) {
                joined.facets.push(facet);
                joined.parts.push(part);
            }
        }
        joined.points = points;
        (joined, count)
    }

    /// Returns whether each edge has two facets.
    fn is_closed(&self) -> bool {
        let edges = sorted_edges(&self.facets);
        !edges.is_empty() && edges.chunk_by(|a, b| (a.low, a.high) == (b.low, b.high)).all(|group| group.len() == 2)
    }

    /// Keeps one of several equal facets, and removes facets that lie back to back. Returns a sentence for each kind.
    fn remove_doubled_facets(&mut self) -> Vec<String> {
        let mut order: Vec<([u32; 3], usize)> = Vec::with_capacity(self.facets.len());
        for (i, facet) in self.facets.iter().enumerate() {
            let mut corners = *facet;
            corners.sort_unstable();
            order.push((corners, i));
        }
        order.sort_unstable();
        let even = |facet: &[u32; 3]| {
            // Of three different numbers in a cycle, one or two are less than the next.
            (0..3).filter(|i| facet[*i] < facet[(i + 1) % 3]).count() == 2
        };
        let (mut equal, mut opposite) = (0, 0);
        let mut removed = vec![false; self.facets.len()];
        for group in order.chunk_by(|a, b| a.0 == b.0).filter(|group| group.len() > 1) {
            let (one, other): (Vec<usize>, Vec<usize>) =
                group.iter().map(|(_, i)| *i).partition(|i| even(&self.facets[*i]));
            if one.is_empty() || other.is_empty() {
                equal += group.len() - 1;
                group[1..].iter().for_each(|(_, i)| removed[*i] = true);
            } else if one.len() == other.len() {
                opposite += group.len();
                group.iter().for_each(|(_, i)| removed[*i] = true);
            }
        }
        let mut sentences = Vec::new();
        if equal > 0 {
            sentences.push(format!("{} others; each counts once", counted(equal, "facet repeats", "facets repeat")));
        }
        if opposite > 0 {
            sentences.push(format!("{opposite} facets lie back to back, as walls without thickness; they are removed"));
        }
        let mut number = 0..;
        self.facets.retain(|_| number.next().is_none_or(|i| !removed[i]));
        let mut number = 0..;
        self.parts.retain(|_| number.next().is_none_or(|i| !removed[i]));
        sentences
    }

    /// Reverses facets so that neighbours have the same orientation: in each connected part the orientation that has
    /// the larger area remains. Returns whether each facet was reversed.
    fn unify_orientation(&mut self) -> Vec<bool> {
        let n = self.facets.len();
        let edges = sorted_edges(&self.facets);
        let mut neighbours: Vec<Vec<(usize, bool)>> = vec![Vec::new(); n];
        for pair in edges.chunk_by(|a, b| (a.low, a.high) == (b.low, b.high)).filter(|group| group.len() == 2) {
            let differ = pair[0].up == pair[1].up;
            neighbours[pair[0].facet].push((pair[1].facet, differ));
            neighbours[pair[1].facet].push((pair[0].facet, differ));
        }
        let mut reversed: Vec<Option<bool>> = vec![None; n];
        for first in 0..n {
            if reversed[first].is_some() {
                continue;
            }
            reversed[first] = Some(false);
            let (mut part, mut next) = (vec![first], 0);
            while let Some(&facet) = part.get(next) {
                next += 1;
                let own = reversed[facet] == Some(true);
                for &(other, differ) in &neighbours[facet] {
                    if reversed[other].is_none() {
                        reversed[other] = Some(own ^ differ);
                        part.push(other);
                    }
                }
            }
            let area = |reverse: bool| -> f64 {
                part.iter().filter(|&&i| reversed[i] == Some(reverse)).map(|&i| self.facet_area(i)).sum()
            };
            if area(true) > area(false) {
                part.iter().for_each(|&i| reversed[i] = reversed[i].map(|reverse| !reverse));
            }
        }
        let reversed: Vec<bool> = reversed.into_iter().map(|reverse| reverse == Some(true)).collect();
        for (facet, _) in self.facets.iter_mut().zip(&reversed).filter(|(_, reverse)| **reverse) {
            facet.swap(0, 1);
        }
        reversed
    }

    fn facet_area(&self, facet: usize) -> f64 {
        let [a, b, c] = self.facets[facet].map(|p| self.points[p as usize]);
        0.5 * (b - a).cross(&(c - a)).norm()
    }
}

/// Refuses facets and corners that do not exist, and a mesh that is too large.
pub(super) fn check_input(points: &[Vector<3>], facets: &[[u32; 3]]) -> Result<()> {
    if facets.len() > MAX_FACETS {
        return Err(Error::scene(format!("a mesh of {} facets; the most is {MAX_FACETS}", facets.len()))
            .help("thin it out (\"decimate\"): what is finer than dp cannot be seen"));
    }
    if let Some(i) = points.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
        return Err(Error::scene(format!("corner {} of a mesh is not a number", i + 1))
            .help("give finite coordinates: export the mesh again"));
    }
    if let Some(i) = facets.iter().position(|f| f.iter().any(|&p| p as usize >= points.len())) {
        return Err(Error::scene(format!("facet {} of a mesh has a corner that is not there", i + 1))
            .help(format!("corners are counted from 0, and there are {}", points.len())));
    }
    let used = Bounds::around(facets.iter().flatten().map(|&p| &points[p as usize]));
    let size = if facets.is_empty() { 0.0 } else { used.size().max() };
    if size > LARGEST {
        return Err(Error::scene(format!("a mesh {size:.1e} m long; the most is {LARGEST:.0e} m"))
            .help("in which unit is the file? Write, say,  unit = \"mm\""));
    }
    Ok(())
}

/// Merges corners at the same position. Returns the corners that facets use, and the facets with three distinct
/// corners.
pub(super) fn joined(points: &[Vector<3>], facets: &[[u32; 3]]) -> (Vec<Vector<3>>, Vec<[u32; 3]>) {
    let surface = Surface { points: points.to_vec(), facets: facets.to_vec(), parts: vec![0; facets.len()] };
    let (joined, _) = surface.join(0.0, false);
    (joined.points, joined.facets)
}

/// Returns a sentence about the facets that are reversed, or `None` if none is.
fn reversed_facets(reversed: &[bool]) -> Option<String> {
    match reversed.iter().filter(|reversed| **reversed).count() {
        0 => None,
        n if n == reversed.len() => Some("the surface is inside out; all its facets are reversed".into()),
        n => Some(format!("{n} of {} facets are inverted; they are reversed", reversed.len())),
    }
}

/// Returns a number and its noun, in the singular or plural.
pub(super) fn counted(n: usize, one: &str, more: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { more })
}

fn has_repeated_corner([a, b, c]: &[u32; 3]) -> bool {
    a == b || b == c || c == a
}

/// A side of a facet. `up` is true if the facet traverses it from the lower to the higher corner.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Edge {
    pub(super) low: u32,
    pub(super) high: u32,
    pub(super) up: bool,
    pub(super) facet: usize,
}

/// Returns the sides of all facets, with equal edges next to one another.
pub(super) fn sorted_edges(facets: &[[u32; 3]]) -> Vec<Edge> {
    let sides = |(facet, &[a, b, c]): (usize, &[u32; 3])| {
        [(a, b), (b, c), (c, a)].map(|(p, q): (u32, u32)| Edge { low: p.min(q), high: p.max(q), up: p < q, facet })
    };
    let mut edges: Vec<Edge> = facets.iter().enumerate().flat_map(sides).collect();
    edges.sort_unstable();
    edges
}
