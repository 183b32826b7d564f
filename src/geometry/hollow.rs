//! Space that a solid encloses: closed hollows, and open ones below their rim.
//!
//! A grid covers the solid. A flood from outside in the order of height gives each free cell its spill level: the least
//! level at which water outside reaches it @barnes2014. Free cells below their spill level are enclosed. Closed hollows
//! have no spill level. The volume of a hollow is that of columns of cells if the solid's faces fit the grid, and otherwise that within
//! its surface ([`super::hollow_surface`]).

use std::{cmp::Reverse, collections::BinaryHeap};

use super::{
    Shape,
    exposed::area_vector,
    hollow_surface::{Space, free_facets, hollow_facets},
    submerged_volume::{Facet, add_wet},
    support::world_bounds,
};
use crate::math::{Bounds, Matrix, Pose, Vector};

/// Edge of a cell, dp.
const CELL: f64 = 0.5;
/// Largest number of cells; a larger solid has larger cells.
const MOST_CELLS: f64 = 2e6;
/// Least depth of an open hollow below its rim, dp: a shallower one holds no water that particles resolve.
const LEAST_DEPTH: f64 = 2.0;
/// Distance from a face, cells, below which a cell counts as material: parts of a compound touch with round-off.
const TOUCH: f64 = 0.05;

/// Marks of cells that belong to no hollow.
const OUTSIDE: u32 = u32::MAX;
const MATERIAL: u32 = u32::MAX - 1;

/// The enclosed space of a solid in one orientation.
#[derive(Clone, Debug)]
pub(crate) struct Enclosure<const D: usize> {
    /// The hollows, in the order of their first cell.
    pub(crate) hollows: Vec<Hollow<D>>,
    min: Vector<D>,
    cell: f64,
    count: [usize; D],
    /// Number of each cell's hollow, or one of the marks.
    hollow_of: Vec<u32>,
}

/// A hollow of a solid, in the solid's frame.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Hollow<const D: usize> {
    /// Places over which water can come in, m: on each side of the opening, the highest place on the way. The lowest of them is
    /// at the spill level in the orientation of the search. Empty if the hollow is closed.
    rim: Vec<Vector<D>>,
    /// Unit vector along the columns, upward.
    along: Vector<D>,
    columns: Vec<Column<D>>,
    /// Its closed surface, with normals out of it; empty if the columns are exact, or if the surface was not found.
    facets: Vec<Facet<D>>,
}

/// A vertical or oblique column of the space in a hollow.
#[derive(Clone, Debug, PartialEq)]
struct Column<const D: usize> {
    /// Lower end, m.
    low: Vector<D>,
    length: f64,
    /// Cross-section, m² (m in 2-D).
    area: f64,
}

/// The place of a point relative to a solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// Outside of the solid and of its hollows.
    Outside,
    /// In the material, away from hollows.
    Material,
    /// In the hollow of this number, or in the material at its face.
    Hollow(usize),
}

impl<const D: usize> Hollow<D> {
    /// Returns the volume (m³; m² in 2-D) of the hollow at `pose` below the height `level` (m), and its first moment.
    pub(crate) fn volume_and_moment_below(&self, pose: &Pose<D>, level: f64) -> (f64, Vector<D>) {
        if !self.facets.is_empty() {
            let mut sum = (0.0, Vector::zeros());
            for facet in &self.facets {
                let facet = facet.map(|x| pose.point(&x));
                add_wet(facet, facet.map(|x| x[D - 1] - level), level, &mut sum);
            }
            return sum;
        }
        let along = pose.rotation * self.along;
        let (mut volume, mut first) = (0.0, Vector::zeros());
        for column in &self.columns {
            let low = pose.point(&column.low);
            let depth = level - low[D - 1];
            if depth > 0.0 {
                let wet = column.length.min(depth / along[D - 1].max(1e-9));
                volume += wet * column.area;
                first += (low + along * (0.5 * wet)) * (wet * column.area);
            }
        }
        (volume, first)
    }

    /// Returns the height (m) of the surface of a `volume` of water (m³; m² in 2-D) in the hollow at `pose`.
    pub(crate) fn level_of(&self, pose: &Pose<D>, volume: f64) -> f64 {
        let along = pose.rotation * self.along;
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for column in self.columns.iter().filter(|_| self.facets.is_empty()) {
            let end = pose.point(&column.low)[D - 1];
            low = low.min(end);
            high = high.max(end + along[D - 1].max(0.0) * column.length);
        }
        for height in self.facets.iter().flatten().map(|x| pose.point(x)[D - 1]) {
            (low, high) = (low.min(height), high.max(height));
        }
        // Faces above the level and below it cancel, with more round-off than columns.
        let accuracy = if self.facets.is_empty() { 1e-14 } else { 1e-12 };
        let size = high - low;
        let mut level = 0.5 * (low + high);
        for _ in 0..50 {
            let excess = self.volume_and_moment_below(pose, level).0 - volume;
            if excess.abs() <= accuracy * volume {
                break;
            }
            if excess < 0.0 {
                low = level
            } else {
                high = level
            }
            // Newton's method, with the area of the surface, and bisection where it leaves the bounds.
            let step = level - excess / self.surface_area(pose, level, size);
            level = if low < step && step < high { step } else { 0.5 * (low + high) };
        }
        level
    }

    /// Returns the area (m²; m in 2-D) of the horizontal plane at `level` (m) in the hollow, which is `size` (m) high, at `pose`.
    fn surface_area(&self, pose: &Pose<D>, level: f64, size: f64) -> f64 {
        if !self.facets.is_empty() {
            let step = 1e-6 * size;
            let [more, less] = [step, -step].map(|step| self.volume_and_moment_below(pose, level + step).0);
            return (more - less) / (2.0 * step);
        }
        let along = (pose.rotation * self.along)[D - 1].max(1e-9);
        let cut = self.columns.iter().filter(|column| {
            let low = pose.point(&column.low)[D - 1];
            low < level && level < low + along * column.length
        });
        cut.map(|column| column.area / along).sum()
    }

    /// The places over which water can come in, m in the solid's frame; none if the hollow is closed.
    pub(crate) fn rim(&self) -> &[Vector<D>] {
        &self.rim
    }

    /// Whether no water can come in.
    pub(crate) fn is_closed(&self) -> bool {
        self.rim.is_empty()
    }

    /// Returns the height (m) of the lowest place of the rim at `pose`; infinity if the hollow is closed.
    pub(crate) fn rim_height(&self, pose: &Pose<D>) -> f64 {
        let up = pose.rotation.row(D - 1);
        let heights = self.rim.iter().map(|x| up.tr_dot(x));
        pose.position[D - 1] + heights.fold(f64::INFINITY, f64::min)
    }

    /// Returns the middle of each column's part below the height `level` (m) at `pose`, m.
    pub(crate) fn middles_below(&self, pose: &Pose<D>, level: f64) -> impl Iterator<Item = Vector<D>> {
        let along = pose.rotation * self.along;
        self.columns.iter().filter_map(move |column| {
            let low = pose.point(&column.low);
            let wet = column.length.min((level - low[D - 1]) / along[D - 1].max(1e-9));
            (wet > 0.0).then(|| low + along * (0.5 * wet))
        })
    }
}

/// Returns whether `shape` can enclose space in any orientation, without a search; open hollows count if `open` is true.
pub(crate) fn may_enclose<const D: usize>(shape: &Shape<D>, open: bool) -> bool {
    match shape {
        Shape::Box { .. } | Shape::Ball { .. } | Shape::Capsule { .. } | Shape::Cylinder { .. } => false,
        Shape::Polygon { points } => open && !is_convex(points),
        Shape::Polyline { points, .. } => open || points.first() == points.last(),
        Shape::Tank { .. } => open,
        Shape::Mesh { mesh, .. } => open || has_several_shells(mesh.facets(), mesh.points().len()),
        Shape::Compound(parts) => parts.len() > 1 || parts.iter().any(|(_, part)| may_enclose(part, open)),
    }
}

/// Returns whether facets form more than one connected surface.
fn has_several_shells(facets: &[[u32; 3]], points: usize) -> bool {
    // Each corner refers to an earlier corner of its surface; the first corner refers to itself.
    let mut first: Vec<u32> = (0..points as u32).collect();
    let root = |first: &mut Vec<u32>, mut i: u32| {
        while first[i as usize] != i {
            first[i as usize] = first[first[i as usize] as usize];
            i = first[i as usize];
        }
        i
    };
    for &[a, b, c] in facets {
        let (a, b, c) = (root(&mut first, a), root(&mut first, b), root(&mut first, c));
        let least = a.min(b).min(c);
        [a, b, c].into_iter().for_each(|i| first[i as usize] = least);
    }
    (0..points as u32).filter(|&i| root(&mut first, i) == i).count() > 1
}

/// Returns whether no corner of a counter-clockwise outline turns inward.
fn is_convex<const D: usize>(points: &[Vector<D>]) -> bool {
    let n = points.len();
    (0..n).all(|i| {
        let (a, b) = (points[(i + 1) % n] - points[i], points[(i + 2) % n] - points[(i + 1) % n]);
        a[0] * b[1] - a[1] * b[0] >= -1e-9 * a.norm() * b.norm()
    })
}

/// The cells during the search.
struct Search<'a, const D: usize> {
    shape: &'a Shape<D>,
    min: Vector<D>,
    cell: f64,
    count: [usize; D],
    /// Distance of each centre from the surface, m: exact within a cell from it, else a bound with the right sign.
    distance: Vec<f32>,
    /// Upward direction in the solid's frame.
    up: Vector<D>,
}

impl<const D: usize> Search<'_, D> {
    fn index(&self, at: &[usize; D]) -> usize {
        (0..D).rev().fold(0, |sum, i| sum * self.count[i] + at[i])
    }

    fn cell_at(&self, mut index: usize) -> [usize; D] {
        std::array::from_fn(|i| {
            let at = index % self.count[i];
            index /= self.count[i];
            at
        })
    }

    fn centre(&self, index: usize) -> Vector<D> {
        let at = self.cell_at(index);
        self.min + Vector::from_fn(|i, _| (at[i] as f64 + 0.5) * self.cell)
    }

    fn height(&self, index: usize) -> f64 {
        self.up.dot(&self.centre(index))
    }

    fn is_free(&self, index: usize) -> bool {
        f64::from(self.distance[index]) > TOUCH * self.cell
    }

    /// Computes the distances of the cells from `low` to below `high`, of a whole block at once where no face is near.
    fn measure(&mut self, low: [usize; D], high: [usize; D]) {
        let middle = |i: usize| self.min[i] + 0.5 * (low[i] + high[i]) as f64 * self.cell;
        let distance = self.shape.signed_distance(&Vector::from_fn(|i, _| middle(i)));
        let extent = |i: usize| (high[i] - low[i] - 1) as f64 * self.cell;
        let radius = 0.5 * (0..D).map(|i| extent(i).powi(2)).sum::<f64>().sqrt();
        let bound = distance.abs() - radius;
        if radius == 0.0 || bound > 1.5 * self.cell {
            let value = bound.copysign(distance) as f32;
            let mut at = low;
            loop {
                let first = self.index(&at);
                self.distance[first..first + high[0] - low[0]].fill(value);
                let Some(axis) = (1..D).find(|&i| at[i] + 1 < high[i]) else { return };
                at[axis] += 1;
                (1..axis).for_each(|i| at[i] = low[i]);
            }
        }
        let axis = (0..D).max_by_key(|&i| high[i] - low[i]).unwrap_or(0);
        let (mut end, mut start) = (high, low);
        end[axis] = low[axis] + (high[axis] - low[axis]) / 2;
        start[axis] = end[axis];
        self.measure(low, end);
        self.measure(start, high);
    }

    /// Visits the free neighbours of a cell that no wall parts from it.
    fn for_each_neighbour(&self, index: usize, mut visit: impl FnMut(usize)) {
        let (at, mut stride) = (self.cell_at(index), 1);
        for (place, count) in at.into_iter().zip(self.count) {
            if place > 0 && self.are_joined(index, index - stride) {
                visit(index - stride);
            }
            if place + 1 < count && self.are_joined(index, index + stride) {
                visit(index + stride);
            }
            stride *= count;
        }
    }

    /// Returns whether both cells are free and no wall lies between their centres.
    fn are_joined(&self, a: usize, b: usize) -> bool {
        let (near, far) = (f64::from(self.distance[a]), f64::from(self.distance[b]));
        let touch = TOUCH * self.cell;
        if near <= touch || far <= touch || near + far > self.cell {
            return near > touch && far > touch;
        }
        let (from, to) = (self.centre(a), self.centre(b));
        let mut part = near / self.cell;
        while part < 1.0 {
            let distance = self.shape.signed_distance(&(from + (to - from) * part));
            if distance <= 0.2 * touch {
                return false;
            }
            part += (distance / self.cell).max(0.2 * TOUCH);
        }
        true
    }

    /// Returns the height (m) above which water can pass through a cell: that of a face in the cell, or below it.
    fn passage(&self, index: usize) -> f64 {
        self.height(index) - f64::from(self.distance[index]).min(self.cell)
    }

    /// Returns the spill level of each cell, m; infinity where no water comes.
    fn spill_levels(&self) -> Vec<f64> {
        let n = self.distance.len();
        let mut spill = vec![f64::INFINITY; n];
        // Whole numbers as keys: cells at the same height up to round-off come in the order of their index.
        let key = |height: f64| (height / self.cell * 1e6).round() as i64;
        let mut queue = BinaryHeap::new();
        for (index, spill) in spill.iter_mut().enumerate() {
            let at = self.cell_at(index);
            if (0..D).any(|i| at[i] == 0 || at[i] + 1 == self.count[i]) && self.is_free(index) {
                // Water outside is there up to its level.
                *spill = self.height(index);
                queue.push(Reverse((key(*spill), index as u32)));
            }
        }
        while let Some(Reverse((_, index))) = queue.pop() {
            let level = spill[index as usize];
            self.for_each_neighbour(index as usize, |next| {
                let over = level.max(self.passage(next));
                if over < spill[next] {
                    spill[next] = over;
                    queue.push(Reverse((key(spill[next]), next as u32)));
                }
            });
        }
        spill
    }

    /// Returns the index of the neighbour of a cell along an axis, forward or back; `None` beyond the grid.
    fn neighbour(&self, index: usize, axis: usize, forward: bool) -> Option<usize> {
        let (place, stride) = (self.cell_at(index)[axis], self.count[..axis].iter().product::<usize>());
        match forward {
            true => (place + 1 < self.count[axis]).then_some(index + stride),
            false => (place > 0).then(|| index - stride),
        }
    }

    /// Returns the rim (m) of the hollow with this number and `cells`, whose spill level (m) is `level`.
    ///
    /// On each side of the opening, the way leads up the column until no wall is beside it, and over the top of the wall. A side
    /// under a deck has no such way.
    fn rim(&self, cells: &[u32], mark: &[u32], number: u32, level: f64) -> Vec<Vector<D>> {
        let axis = self.up.iamax();
        let upward = self.up[axis] > 0.0;
        let above = |cell: usize| self.neighbour(cell, axis, upward).filter(|next| self.are_joined(cell, *next));
        let opens = |cell: usize| above(cell).is_some_and(|next| mark[next] == OUTSIDE);
        let lifted = |x: Vector<D>, height: f64| x + self.up * (height - self.up.dot(&x));
        let over = |cell: usize, side: usize, forward: bool| {
            let mut inner = cell;
            loop {
                let outer = self.neighbour(inner, side, forward)?;
                if self.are_joined(inner, outer) {
                    let half = if forward { 0.5 * self.cell } else { -0.5 * self.cell };
                    let mut x = self.centre(inner);
                    x[side] += half;
                    let top = self.passage(inner).max(self.passage(outer)).max(level);
                    return (mark[outer] != number).then(|| lifted(x, top));
                }
                inner = above(inner)?;
            }
        };
        let openings: Vec<usize> = cells.iter().map(|cell| *cell as usize).filter(|cell| opens(*cell)).collect();
        let sides = || (0..D).filter(|side| *side != axis).flat_map(|side| [(side, false), (side, true)]);
        let rim_beside =
            |cell: &usize| sides().filter_map(|(side, forward)| over(*cell, side, forward)).collect::<Vec<_>>();
        let mut rim: Vec<Vector<D>> = openings.iter().flat_map(rim_beside).collect();
        if rim.is_empty() {
            // A way around corners, such as that of a pipe: its end at the hollow stands for the rim.
            let end = openings.last().copied().or(cells.last().map(|cell| *cell as usize));
            rim = end.map(|cell| lifted(self.centre(cell), level)).into_iter().collect();
        }
        let excess = rim.iter().map(|x| self.up.dot(x)).fold(f64::INFINITY, f64::min) - level;
        rim.iter_mut().for_each(|x| *x -= self.up * excess);
        rim
    }

    /// Returns the cells of each hollow, and the mark of every cell.
    fn hollows(&self, spill: &[f64], least_depth: f64) -> (Vec<Vec<u32>>, Vec<u32>) {
        let n = self.distance.len();
        let enclosed = |i: usize| spill[i] > self.height(i) + 1e-6 * self.cell;
        let mut mark: Vec<u32> = (0..n).map(|i| if self.is_free(i) { OUTSIDE } else { MATERIAL }).collect();
        let mut visited = vec![false; n];
        let mut hollows: Vec<Vec<u32>> = Vec::new();
        for first in 0..n {
            if visited[first] || mark[first] == MATERIAL || !enclosed(first) {
                continue;
            }
            visited[first] = true;
            let (mut cells, mut next) = (vec![first as u32], 0);
            while next < cells.len() {
                self.for_each_neighbour(cells[next] as usize, |i| {
                    if !visited[i] && enclosed(i) {
                        visited[i] = true;
                        cells.push(i as u32);
                    }
                });
                next += 1;
            }
            let floor = cells.iter().map(|&i| self.height(i as usize)).fold(f64::INFINITY, f64::min);
            if cells.len() >= 1 << D && spill[first] - floor > least_depth - 0.501 * self.cell {
                cells.sort_unstable();
                cells.iter().for_each(|&i| mark[i as usize] = hollows.len() as u32);
                hollows.push(cells);
            }
        }
        (hollows, mark)
    }
}

impl<const D: usize> Enclosure<D> {
    /// Returns the space that `shape`, turned by `rotation`, encloses, resolved for particles of spacing `dp` (m).
    /// Returns `None` if it encloses none.
    pub(crate) fn of(shape: &Shape<D>, rotation: &Matrix<D>, dp: f64) -> Option<Self> {
        let bounds = shape.bounds();
        let mut cell = CELL * dp;
        let cells = |cell: f64| bounds.size().map(|size| (size / cell - 1e-9).ceil() + 2.0);
        while cells(cell).product() > MOST_CELLS {
            cell *= 1.1;
        }
        let count: [usize; D] = cells(cell).map(|n| n as usize).into();
        let up = rotation.row(D - 1).transpose();
        let distance = vec![0.0; count.iter().product()];
        let mut search = Search { shape, min: bounds.min.add_scalar(-cell), cell, count, distance, up };
        search.measure([0; D], count);
        let spill = search.spill_levels();
        let (found, mark) = search.hollows(&spill, LEAST_DEPTH * dp.max(cell / CELL));
        if found.is_empty() {
            return None;
        }
        let axis = up.iamax();
        let mut along = Vector::zeros();
        along[axis] = up[axis].signum();
        let hollow = |(number, cells): (usize, &Vec<u32>)| {
            let level = spill[cells[0] as usize];
            let rim = if level.is_finite() { search.rim(cells, &mark, number as u32, level) } else { Vec::new() };
            Hollow { rim, along, columns: Vec::new(), facets: Vec::new() }
        };
        let hollows = found.iter().enumerate().map(hollow).collect();
        let mut made = Self { hollows, min: search.min, cell, count, hollow_of: mark };
        made.make_columns(&search, axis);
        made.find_surfaces(&search, found.iter().map(|cells| (cells[0] as usize, spill[cells[0] as usize])));
        Some(made)
    }

    /// Returns the place of the point `x` (m, the solid's frame) of a `shape`: the number of the hollow that it lies in,
    /// or next to if it lies in the material at a face.
    pub(crate) fn place(&self, shape: &Shape<D>, x: &Vector<D>) -> Place {
        match self.mark(x) {
            OUTSIDE => Place::Outside,
            MATERIAL => {
                let (distance, n) = shape.distance_and_normal(x, 1e-2 * self.cell);
                if distance < -4.0 * self.cell {
                    return Place::Material;
                }
                let steps = [0.5, 1.0, 1.5].into_iter();
                let mut places = steps.map(|step| self.mark(&(x + n * (step * self.cell - distance))));
                match places.find(|mark| *mark != MATERIAL) {
                    Some(OUTSIDE) | None => Place::Material,
                    Some(hollow) => Place::Hollow(hollow as usize),
                }
            }
            hollow => Place::Hollow(hollow as usize),
        }
    }

    /// Returns the number of the hollow of `shape` at `pose` in which the middle of the box `other` lies, if the box does not reach
    /// beyond the sides of the shape.
    pub(crate) fn number_around(&self, shape: &Shape<D>, pose: &Pose<D>, other: &Bounds<D>) -> Option<usize> {
        let around = world_bounds(shape, pose);
        let is_between = (0..D - 1).all(|k| around.min[k] <= other.min[k] && other.max[k] <= around.max[k]);
        match self.place(shape, &pose.local(&((other.min + other.max) * 0.5))) {
            Place::Hollow(hollow) if is_between => Some(hollow),
            _ => None,
        }
    }

    /// Returns the mark of the cell with the point `x` (m, the solid's frame).
    fn mark(&self, x: &Vector<D>) -> u32 {
        let (mut index, mut stride) = (0, 1);
        for i in 0..D {
            let at = ((x[i] - self.min[i]) / self.cell).floor();
            if !(at >= 0.0 && at < self.count[i] as f64) {
                return OUTSIDE;
            }
            index += at as usize * stride;
            stride *= self.count[i];
        }
        self.hollow_of[index]
    }

    /// Finds the surface of each hollow, which has a cell of the grid and a spill level (m), unless its columns are exact.
    fn find_surfaces(&mut self, search: &Search<D>, hollows: impl Iterator<Item = (usize, f64)>) {
        let (cell, full) = (self.cell, self.cell.powi(D as i32 - 1));
        let Some(surface) = free_facets(search.shape) else { return };
        for (number, (first, level)) in hollows.enumerate() {
            let space = |x: &Vector<D>| match self.mark(x) {
                MATERIAL => Space::Material,
                mark if mark as usize == number => Space::Hollow,
                _ => Space::Other,
            };
            let lid = level.is_finite().then(|| (search.centre(first), level));
            let Some(facets) = hollow_facets(search.shape, &surface, &search.up, lid, cell, space) else { continue };
            let hollow = &self.hollows[number];
            let is_along_axis = |facet: &Facet<D>| {
                let area = area_vector(facet);
                area.amax() > (1.0 - 1e-12) * area.norm()
            };
            let fit = hollow.columns.iter().all(|column| (column.area / full - 1.0).abs() < 1e-9);
            if fit && facets.iter().all(is_along_axis) {
                continue;
            }
            let (at, high) =
                (Pose::identity(), self.min.amax() + 2.0 * (self.cell * self.count.iter().sum::<usize>() as f64));
            let by_columns = hollow.volume_and_moment_below(&at, high).0;
            let exact = Hollow { facets, ..hollow.clone() };
            let area: f64 = exact.facets.iter().map(|facet| area_vector(facet).norm()).sum();
            if (exact.volume_and_moment_below(&at, high).0 - by_columns).abs() < 0.5 * cell * area {
                self.hollows[number] = exact;
            }
        }
    }

    /// Adds the columns of all hollows: runs of whole cells, and the part of each cell that a face cuts.
    fn make_columns(&mut self, search: &Search<D>, axis: usize) {
        let (cell, area) = (self.cell, self.cell.powi(D as i32 - 1));
        let stride: usize = self.count[..axis].iter().product();
        for start in (0..self.hollow_of.len()).filter(|&i| search.cell_at(i)[axis] == 0) {
            let mut run: Option<(usize, Vector<D>, f64)> = None;
            for k in 0..self.count[axis] {
                let index = start + k * stride;
                let distance = f64::from(search.distance[index]);
                let share = 0.5 + distance / cell;
                let found = if share > 0.0 { self.hollow_at(search, index, distance) } else { None };
                let mut first = search.centre(index);
                first[axis] -= 0.5 * cell;
                match (&mut run, found) {
                    (Some((hollow, _, length)), Some((near, _))) if share >= 1.0 && *hollow == near => *length += cell,
                    _ => {
                        if let Some((hollow, first, length)) = run.take() {
                            self.hollows[hollow].add_column(first, axis, length, area);
                        }
                        match found {
                            Some((hollow, _)) if share >= 1.0 => run = Some((hollow, first, cell)),
                            // A floor or a ceiling cuts the length of a column, a wall its cross-section.
                            Some((hollow, n)) if n.iamax() == axis => {
                                first[axis] += if n[axis] > 0.0 { (1.0 - share) * cell } else { 0.0 };
                                self.hollows[hollow].add_column(first, axis, share * cell, area);
                            }
                            Some((hollow, _)) => self.hollows[hollow].add_column(first, axis, cell, share * area),
                            None => (),
                        }
                    }
                }
            }
        }
    }

    /// Returns the hollow that the cell belongs to, or touches if its centre is in the material, and the outward normal
    /// of the face that cuts the cell.
    fn hollow_at(&self, search: &Search<D>, index: usize, distance: f64) -> Option<(usize, Vector<D>)> {
        let own = self.hollow_of[index];
        if own == OUTSIDE {
            return None;
        }
        if own != MATERIAL && distance >= 0.5 * self.cell {
            return Some((own as usize, Vector::zeros()));
        }
        let x = search.centre(index);
        let n = search.shape.outward_normal(&x, 1e-2 * self.cell);
        let near = if own == MATERIAL { self.mark(&(x + n * (0.6 * self.cell - distance))) } else { own };
        (near < MATERIAL).then_some((near as usize, n))
    }
}

impl<const D: usize> Hollow<D> {
    /// Adds the column from `first` (m) along `axis`.
    fn add_column(&mut self, first: Vector<D>, axis: usize, length: f64, area: f64) {
        let mut low = first;
        low[axis] += if self.along[axis] < 0.0 { length } else { 0.0 };
        self.columns.push(Column { low, length, area });
    }
}

#[cfg(test)]
#[path = "../../tests/unit/geometry/hollow.rs"]
mod tests;
