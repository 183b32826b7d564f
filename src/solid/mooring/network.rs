//! Mooring lines that meet in points: joints of lines, with clump weights and buoys.
//!
//! The ends of lines that meet in a point have a common position and velocity, and the point carries their masses and loads. In
//! an inner step the nodes between the ends of each line are eliminated. To change the velocity of its first end by Δv₀, a line
//! needs the impulse M Δv₀ − b q (q·Δv₁). Δv₁ of the next node is linear in the changes Δv₀ and Δvₙ of both ends. One dense
//! system gives the changes of all points. It is symmetric and positive definite, so that damping of any strength is stable as in
//! a single line.

use std::ops::AddAssign;

use nalgebra::{DMatrix, DVector};

use super::{
    forces::{NodeBody, NodeSurroundings},
    line::{MooringLine, Workspace},
    specification::MooringSpec,
};
use crate::math::{Matrix, Vector};

/// Most iterations for the rest of the points.
const ITERATIONS: usize = 200;

/// Largest force on a point at rest over the weight of a node, –.
const TOLERANCE: f64 = 1e-6;

/// Displacement of a point for the derivative of the forces on it, over the length of the shortest segment.
const DIFFERENCE: f64 = 1e-5;

/// The ends of a line between which its nodes are eliminated.
struct CondensedEnds<const D: usize> {
    /// Resistance of each end to the change of each, kg.
    matrix: [[Matrix<D>; 2]; 2],
    /// Impulse on each end, N s.
    impulse: [Vector<D>; 2],
}

/// What a line needs for a step.
pub(crate) struct LineStep<const D: usize> {
    /// Places of its ends at the end of the step, m.
    pub(crate) ends: [Vector<D>; 2],
    /// What is around each node.
    pub(crate) around: Vec<NodeSurroundings<D>>,
}

impl<const D: usize> MooringLine<D> {
    /// Eliminates the nodes between the ends after [`MooringLine::assemble`].
    fn condense(&mut self) -> CondensedEnds<D> {
        let n = self.segments();
        let inner = [1, n - 1];
        self.work.eliminate(inner);
        self.work.solve(inner);
        let mut responses = std::mem::take(&mut self.work.responses);
        let sides = [(self.work.coupling[0], 1, 0), (self.work.coupling[n - 1], n - 1, n)];
        for (response, (coupling, beside, _)) in responses.iter_mut().zip(sides) {
            let mut unit = vec![Vector::zeros(); n + 1];
            unit[beside] = coupling.q * coupling.b;
            self.work.solve_for(&unit, inner, response);
        }
        let Workspace { matrix, impulse, change, .. } = &self.work;
        let block = |i: usize, j: usize| {
            let ((own, beside, end), (other, ..)) = (sides[i], sides[j]);
            let at_end = if i == j { matrix[end] + own.q * own.q.transpose() * own.b } else { Matrix::zeros() };
            at_end - own.along(&responses[j][beside]) * other.q.transpose()
        };
        let impulse = sides.map(|(coupling, beside, end)| impulse[end] + coupling.along(&change[beside]));
        let matrix = [[block(0, 0), block(0, 1)], [block(1, 0), block(1, 1)]];
        self.work.responses = responses;
        CondensedEnds { matrix, impulse }
    }

    /// Changes the velocities of all nodes for the changes `ends` (m/s) at the ends; adds the impulses (N s) on the supports of
    /// the ends.
    fn expand(&mut self, ends: [Vector<D>; 2], impulses: &mut [Vector<D>; 2]) {
        let n = self.segments();
        let Workspace { coupling, change, responses, .. } = &mut self.work;
        let along = [coupling[0].q.dot(&ends[0]), coupling[n - 1].q.dot(&ends[1])];
        for i in 1..n {
            change[i] += responses[0][i] * along[0] + responses[1][i] * along[1];
        }
        (change[0], change[n]) = (ends[0], ends[1]);
        self.state.v.iter_mut().zip(&*change).for_each(|(v, change)| *v += change);
        self.add_end_impulses(impulses);
        self.add_water_impulses();
    }
}

/// The points in which mooring lines meet.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Junctions {
    /// The lines that meet in each point, with the number of their end.
    points: Vec<Vec<(usize, usize)>>,
    /// The lines that have an end in a point.
    lines: Vec<usize>,
}

impl Junctions {
    /// The points of these lines.
    pub(crate) fn new<const D: usize>(specs: &[MooringSpec<D>]) -> Self {
        let ends = || specs.iter().enumerate().flat_map(|(i, spec)| [0, 1].map(|k| (i, k, spec.points[k])));
        let count = ends().filter_map(|(.., point)| point).max().map_or(0, |last| last + 1);
        let at = |p: usize| ends().filter(|(.., point)| *point == Some(p)).map(|(i, k, _)| (i, k)).collect();
        let joined = |i: &usize| specs[*i].is_joined();
        Self { points: (0..count).map(at).collect(), lines: (0..specs.len()).filter(joined).collect() }
    }

    /// Whether line number `i` has an end in a point.
    pub(crate) fn joins(&self, i: usize) -> bool {
        self.lines.contains(&i)
    }

    /// Whether no lines meet.
    pub(crate) fn is_empty(&self) -> bool {
        self.lines.is_empty()
    }

    /// Releases the ends in points. The first line at each point carries the point's body of `bodies`.
    pub(crate) fn attach<const D: usize>(&self, lines: &mut [&mut MooringLine<D>], bodies: &[NodeBody]) {
        for (point, body) in self.points.iter().zip(bodies) {
            for (first, &(i, k)) in point.iter().enumerate() {
                let node = lines[i].end_node(k);
                lines[i].held[k] = false;
                if first == 0 {
                    lines[i].bodies[node].add(body);
                }
            }
        }
    }

    /// Advances joined lines by `dt` (s). `steps` has the ends and the surroundings of each line, and `gravity` is in m/s².
    pub(crate) fn advance<const D: usize>(
        &self,
        lines: &mut [&mut MooringLine<D>],
        steps: &[LineStep<D>],
        dt: f64,
        gravity: &Vector<D>,
    ) {
        let begin = |i: &usize| lines[*i].begin_step(steps[*i].ends, dt, &steps[*i].around, gravity);
        let mut impulses: Vec<_> = self.lines.iter().map(begin).collect();
        let limit = self.lines.iter().map(|i| lines[*i].step_limit()).fold(f64::INFINITY, f64::min);
        let count = (dt / limit).ceil().max(1.0);
        let h = dt / count;
        for _ in 0..count as u64 {
            for &i in &self.lines {
                lines[i].drift(0.5 * h);
                lines[i].assemble(h, &steps[i].around, gravity);
            }
            self.kick(lines, &mut impulses);
            self.lines.iter().for_each(|i| lines[*i].drift(0.5 * h));
        }
        for (&i, impulses) in self.lines.iter().zip(impulses) {
            lines[i].end_step(steps[i].ends, dt, impulses, (&steps[i].around, gravity));
        }
    }

    /// Changes the velocities of all nodes of the lines that meet.
    fn kick<const D: usize>(&self, lines: &mut [&mut MooringLine<D>], impulses: &mut [[Vector<D>; 2]]) {
        let condensed: Vec<_> = self.lines.iter().map(|i| lines[*i].condense()).collect();
        let size = D * self.points.len();
        let (mut matrix, mut right) = (DMatrix::zeros(size, size), DVector::zeros(size));
        for (&i, line) in self.lines.iter().zip(&condensed) {
            let points = self.points_of(i);
            for (k, p) in points.iter().enumerate().filter_map(|(k, p)| Some((k, (*p)?))) {
                right.fixed_rows_mut::<D>(D * p).add_assign(&line.impulse[k]);
                for (l, q) in points.iter().enumerate().filter_map(|(l, q)| Some((l, (*q)?))) {
                    matrix.fixed_view_mut::<D, D>(D * p, D * q).add_assign(&line.matrix[k][l]);
                }
            }
        }
        let change = matrix.cholesky().map_or_else(|| DVector::zeros(size), |factors| factors.solve(&right));
        for (&i, impulses) in self.lines.iter().zip(impulses) {
            let of =
                |point: Option<usize>| point.map_or_else(Vector::zeros, |p| Vector::from_fn(|k, _| change[D * p + k]));
            lines[i].expand(self.points_of(i).map(of), impulses);
        }
    }

    /// The points at the ends of line number `i`.
    fn points_of(&self, i: usize) -> [Option<usize>; 2] {
        [0, 1].map(|k| self.points.iter().position(|point| point.contains(&(i, k))))
    }

    /// Finds the equilibrium of the active `lines`, together for those that meet. Returns for each line the largest residual
    /// force on a node or a point over the weight of a node. `around` returns the surroundings of a position (m), and `gravity`
    /// is in m/s².
    pub(crate) fn bring_to_rest<const D: usize>(
        &self,
        lines: &mut [&mut MooringLine<D>],
        around: &dyn Fn(&Vector<D>) -> NodeSurroundings<D>,
        gravity: &Vector<D>,
    ) -> Vec<f64> {
        let joined = if self.is_empty() { 0.0 } else { self.find_rest(lines, around, gravity) };
        let rest = |(i, line): (usize, &mut &mut MooringLine<D>)| match self.joins(i) {
            true => joined,
            false if line.state.acts => line.find_rest(around, gravity),
            false => 0.0,
        };
        lines.iter_mut().enumerate().map(rest).collect()
    }

    /// Finds the equilibrium of the lines that meet. Returns the largest residual force on a node or a point over the weight of a
    /// node.
    fn find_rest<const D: usize>(
        &self,
        lines: &mut [&mut MooringLine<D>],
        around: &dyn Fn(&Vector<D>) -> NodeSurroundings<D>,
        gravity: &Vector<D>,
    ) -> f64 {
        let size = D * self.points.len();
        let place = |lines: &[&mut MooringLine<D>], j: usize| {
            let (i, k) = self.points[j / D][0];
            lines[i].state.x[lines[i].end_node(k)][j % D]
        };
        let mut places = DVector::from_fn(size, |j, _| place(lines, j));
        let shortest = self.lines.iter().map(|i| lines[*i].state.segment).fold(f64::INFINITY, f64::min);
        let node = |i: &usize| lines[*i].material.mass * lines[*i].state.segment * gravity.norm();
        let weight = self.lines.iter().map(node).fold(f64::MIN_POSITIVE, f64::max);
        let (mut forces, mut left) = self.forces_on_points(lines, &places, around, gravity);
        let mut damping = 1e-6;
        for _ in 0..ITERATIONS {
            if forces.amax() <= TOLERANCE * weight {
                break;
            }
            let mut stiffness = DMatrix::zeros(size, size);
            let way = DIFFERENCE * shortest;
            for j in 0..size {
                let mut moved = places.clone();
                moved[j] += way;
                let change = &forces - self.forces_on_points(lines, &moved, around, gravity).0;
                stiffness.set_column(j, &(change / way));
            }
            let stiffness = (&stiffness + stiffness.transpose()) * 0.5;
            let scale = stiffness.diagonal().amax().max(weight / shortest);
            let better = loop {
                let damped = &stiffness + DMatrix::identity(size, size) * (damping * scale);
                let step = damped.cholesky().map(|factors| factors.solve(&forces));
                let tried = step.map(|step| {
                    let longest = step.amax();
                    let there = &places + step * (20.0 * shortest / longest).min(1.0);
                    let (forces, left) = self.forces_on_points(lines, &there, around, gravity);
                    (there, forces, left)
                });
                match tried.filter(|(_, tried, _)| tried.norm() < forces.norm()) {
                    Some(better) => break Some(better),
                    None if damping > 1e6 => break None,
                    None => damping *= 10.0,
                }
            };
            let Some(better) = better else { break };
            (places, forces, left) = better;
            damping = (0.1 * damping).max(1e-9);
        }
        let last = self.forces_on_points(lines, &places, around, gravity).0.amax();
        let over_stretch = self.lines.iter().map(|i| lines[*i].over_stretch(last)).fold(f64::INFINITY, f64::min);
        left.max((last / weight).min(over_stretch))
    }

    /// The forces (N) of the lines in equilibrium on the points at these `places` (m), and the largest residual force on a node
    /// over its weight.
    fn forces_on_points<const D: usize>(
        &self,
        lines: &mut [&mut MooringLine<D>],
        places: &DVector<f64>,
        around: &dyn Fn(&Vector<D>) -> NodeSurroundings<D>,
        gravity: &Vector<D>,
    ) -> (DVector<f64>, f64) {
        for (p, ends) in self.points.iter().enumerate() {
            for &(i, k) in ends {
                let node = lines[i].end_node(k);
                lines[i].state.x[node] = Vector::from_fn(|a, _| places[D * p + a]);
            }
        }
        let rests = self.lines.iter().map(|i| lines[*i].find_rest(around, gravity));
        let left = rests.fold(0.0, f64::max);
        let mut forces = DVector::zeros(places.len());
        for (p, ends) in self.points.iter().enumerate() {
            for &(i, k) in ends {
                forces.fixed_rows_mut::<D>(D * p).add_assign(&lines[i].state.end_forces[k]);
            }
        }
        (forces, left)
    }
}

#[cfg(all(test, feature = "dim2", feature = "dim3"))]
#[path = "../../../tests/unit/solid/mooring/network.rs"]
mod tests;
