//! The equilibrium of a lumped-mass line between held ends.
//!
//! The potential energy of tension, weight and bed is convex in the places of the nodes, because no segment pushes. Newton's
//! method with a search along each step finds the minimum; it starts from the elastic catenary. The reaction of the bed where the
//! line leaves it also depends on the tension, which changes little in a step. The method neglects friction of the bed: the line
//! lies as it was laid, without tension across it.
//!
//! For a line that sinks, the surroundings of the nodes are read in a few rounds. A line that floats, or has floats, comes to
//! rest at the surface, where the buoyancy of a node falls as the node rises. Its surroundings are read in each iteration.

use nalgebra::DVector;

use super::{
    catenary::{Catenary, CatenarySpan},
    forces::{BedPlane, NodeSurroundings, bed_load, bed_reaction, bending_forces, water_load},
    line::MooringLine,
    segment::{SegmentPull, segment_pulls},
};
use crate::math::{Matrix, Vector};

/// Most iterations for given surroundings.
const ITERATIONS: usize = 200;

/// Most iterations in which the surroundings are read anew.
const LIVE_ITERATIONS: usize = 500;

/// Rounds in which the surroundings are read anew where the nodes have come to lie.
const ROUNDS: usize = 4;

/// Largest force on a node over its weight at which a line that may float counts as in equilibrium, –.
const SETTLED: f64 = 1e-4;

/// Resistance of the slow motion, over the weight of a node and the length of a segment, –.
const CREEP_RESISTANCE: f64 = 10.0;

/// Most iterations of the slow motion.
const CREEP_ITERATIONS: usize = 1000;

/// Longest way of a node in an iteration of the slow motion, over the length of a segment, –.
const LONGEST_CREEP: f64 = 0.25;

/// Factors on the damping for the next iteration: after a step that was cut to less than the share [`CUT`], and after any other
/// step.
const DAMPING: [f64; 2] = [10.0, 0.3];

/// Share of a step below which the next iteration is damped more.
const CUT: f64 = 0.2;

/// Largest depth of a node below its previous bed after an iteration, over the length of a segment.
const SINKING: f64 = 0.02;

/// Half of the height over which the change of the wet share is measured, over the length of a segment.
const DIFFERENCE: f64 = 0.01;

/// Largest force on a node at rest over its weight, –.
const TOLERANCE: f64 = 1e-9;

/// Shares of the tension and of the axial stiffness that stand for the weight of a node where this is less, as without gravity, –. A
/// thousandth of the second is the round-off of the stretch.
const SHARES: [f64; 2] = [1e-3, 1e-9];

impl<const D: usize> MooringLine<D> {
    /// Finds the equilibrium of the line between its held ends. `around` returns the surroundings of a position (m), and
    /// `gravity` is in m/s². Returns the largest residual force on a node over the weight of a node or, if this is less, over the
    /// [`SHARES`]. Without gravity a slack line rests straight, as it would in any shape.
    pub(crate) fn find_rest(&mut self, around: &dyn Fn(&Vector<D>) -> NodeSurroundings<D>, gravity: &Vector<D>) -> f64 {
        let left = if gravity.norm_squared() == 0.0 && self.rests_straight(around, gravity) {
            0.0
        } else if self.may_float() {
            self.find_rest_afloat(around, gravity)
        } else {
            self.find_rest_in_rounds(around, gravity)
        };
        self.state.v.iter_mut().for_each(|v| *v = Vector::zeros());
        let near: Vec<_> = self.state.x.iter().map(around).collect();
        let forces = self.forces(&near, gravity);
        let lies = |(x, here): (&Vector<D>, &NodeSurroundings<D>)| {
            here.bed.filter(|bed| self.material.depth(bed, x) > 0.0).map(|_| *x)
        };
        self.state.grips = self.state.x.iter().zip(&near).map(lies).collect();
        let last = self.segments();
        self.state.end_forces = [0, last].map(|i| forces[i]);
        self.store_pulls(&near, gravity);
        left.min(self.over_stretch(forces[1..last].iter().map(|force| force.norm()).fold(0.0, f64::max)))
    }

    /// Puts the nodes on the straight line between the ends. Returns whether they are at rest there, up to round-off of the stretch.
    fn rests_straight(&mut self, around: &dyn Fn(&Vector<D>) -> NodeSurroundings<D>, gravity: &Vector<D>) -> bool {
        let n = self.segments();
        let [first, last] = [0, n].map(|i| self.state.x[i]);
        for i in 1..n {
            self.state.x[i] = first + (last - first) * (i as f64 / n as f64);
        }
        let near: Vec<_> = self.state.x.iter().map(around).collect();
        let round_off = 1e-3 * SHARES[1] * self.material.stiffness;
        self.forces(&near, gravity)[1..n].iter().all(|force| force.norm() <= round_off)
    }

    /// A `force` (N) over the [`SHARES`] of the tension at the last rest and of the stiffness.
    pub(super) fn over_stretch(&self, force: f64) -> f64 {
        let tension = self.state.pulls.iter().map(|pull| pull.norm()).fold(0.0, f64::max);
        force / (SHARES[0] * tension).max(SHARES[1] * self.material.stiffness)
    }

    /// Finds the equilibrium of a line that may float, with the surroundings of each iteration: by Newton's method; where this
    /// does not settle, by slow motion and Newton's method, or in rounds, whichever leaves less. Returns the largest residual
    /// force on a node over the weight of a node.
    fn find_rest_afloat(&mut self, around: &dyn Fn(&Vector<D>) -> NodeSurroundings<D>, gravity: &Vector<D>) -> f64 {
        self.hang(around, gravity);
        let left = self.minimize(&Around::Live(around), gravity);
        if left <= SETTLED {
            return left;
        }
        self.hang(around, gravity);
        self.creep(around, gravity);
        let mut left = self.minimize(&Around::Live(around), gravity);
        if left > SETTLED {
            let crept = self.state.x.clone();
            self.find_rest_in_rounds(around, gravity);
            let near: Vec<_> = self.state.x.iter().map(around).collect();
            let in_rounds = self.residual(&self.forces(&near, gravity), gravity);
            if in_rounds < left {
                left = in_rounds;
            } else {
                self.state.x = crept;
            }
        }
        left
    }

    /// Moves the nodes by their forces against a large resistance until little is left. This reaches the rest of a slack line on
    /// the water, where many shapes are nearly at rest.
    fn creep(&mut self, around: &dyn Fn(&Vector<D>) -> NodeSurroundings<D>, gravity: &Vector<D>) {
        let (n, segment) = (self.segments(), self.state.segment);
        let resistance = CREEP_RESISTANCE * self.node_weight(gravity) / segment;
        for _ in 0..CREEP_ITERATIONS {
            let near: Vec<_> = self.state.x.iter().map(around).collect();
            let forces = self.forces(&near, gravity);
            if self.residual(&forces, gravity) <= SETTLED {
                break;
            }
            let mut step = DVector::from_iterator((n - 1) * D, forces[1..n].iter().flatten().copied());
            let float = self.float_stiffness(&Around::Live(around), &near, gravity);
            self.stiffness(&near, gravity, (resistance, &float)).solve(step.as_mut_slice());
            let part = (LONGEST_CREEP * segment / step.amax()).min(1.0);
            for (x, way) in self.state.x[1..n].iter_mut().zip(step.as_slice().chunks(D)) {
                *x += Vector::from_column_slice(way) * part;
            }
        }
    }

    /// The largest of the `forces` (N) on the nodes between the ends over the weight of a node.
    fn residual(&self, forces: &[Vector<D>], gravity: &Vector<D>) -> f64 {
        forces[1..self.segments()].iter().map(|f| f.norm()).fold(0.0, f64::max) / self.node_weight(gravity)
    }

    /// Finds the equilibrium from the elastic catenary; the surroundings of the nodes are read anew in a few rounds. Returns the
    /// largest residual force on a node, in the surroundings of the last round, over the weight of a node.
    fn find_rest_in_rounds(&mut self, around: &dyn Fn(&Vector<D>) -> NodeSurroundings<D>, gravity: &Vector<D>) -> f64 {
        if let Some(shape) = self.catenary(around, gravity) {
            self.place_on(shape);
        }
        let mut left = f64::INFINITY;
        for _ in 0..ROUNDS {
            let near: Vec<_> = self.state.x.iter().map(around).collect();
            left = self.minimize(&Around::Frozen(near), gravity);
        }
        left
    }

    /// Places the line in equilibrium between its held ends, as [`MooringLine::find_rest`] does, but keeps the velocities of its
    /// nodes.
    pub(crate) fn place_at_rest(&mut self, around: &dyn Fn(&Vector<D>) -> NodeSurroundings<D>, gravity: &Vector<D>) {
        let velocities = self.state.v.clone();
        self.find_rest(around, gravity);
        self.state.v = velocities;
    }

    /// Whether the line, or a body on it, is lighter than water.
    pub(crate) fn may_float(&self) -> bool {
        let density = self.material.water_density;
        self.material.mass < self.material.displaced() || self.bodies.iter().any(|b| b.mass < density * b.volume)
    }

    /// Weight of a node in air, N.
    fn node_weight(&self, gravity: &Vector<D>) -> f64 {
        self.material.mass * self.state.segment * gravity.norm().max(f64::MIN_POSITIVE)
    }

    /// The elastic catenary between the ends, in the plane of both ends and of gravity, with the wet share and the bed at the
    /// lower end.
    pub(crate) fn catenary(
        &self,
        around: &dyn Fn(&Vector<D>) -> NodeSurroundings<D>,
        gravity: &Vector<D>,
    ) -> Option<(Catenary, [Vector<D>; 2], bool)> {
        let (first, last) = (*self.state.x.first()?, *self.state.x.last()?);
        let up = -gravity.try_normalize(f64::MIN_POSITIVE)?;
        let below = around(&(if up.dot(&(last - first)) >= 0.0 { first } else { last }));
        let material = &self.material;
        let bodies: f64 = self.bodies.iter().map(|b| b.mass - below.wet * material.water_density * b.volume).sum();
        let net =
            material.mass - below.wet * material.displaced() + bodies / (self.state.segment * self.segments() as f64);
        self.catenary_of(net, &below, gravity)
    }

    /// The elastic catenary between the ends with the mass less displaced water `net` (kg/m); `below` are the surroundings of the
    /// lower end.
    fn catenary_of(
        &self,
        net: f64,
        below: &NodeSurroundings<D>,
        gravity: &Vector<D>,
    ) -> Option<(Catenary, [Vector<D>; 2], bool)> {
        let (first, last, material) = (*self.state.x.first()?, *self.state.x.last()?, &self.material);
        let up = -gravity.try_normalize(f64::MIN_POSITIVE)?;
        // A line that floats up is the mirror image of one that hangs.
        let up = if net < 0.0 { -up } else { up };
        let rises = up.dot(&(last - first)) >= 0.0;
        let (low, high) = if rises { (first, last) } else { (last, first) };
        let z = up.dot(&(high - low));
        let level = high - low - up * z;
        let x = level.norm();
        let ahead = if x > 0.0 { level / x } else { Vector::zeros() };
        let lies = |bed: &BedPlane<D>| bed.normal.dot(&up) > 0.7 && bed.depth(&low).abs() < 2.0 * self.state.segment;
        let weight = net.abs().max(1e-6 * material.mass) * gravity.norm();
        let length = self.state.segment * self.segments() as f64;
        let bed = below.bed.filter(|_| net > 0.0).filter(lies).map(|_| 0.0);
        let span = CatenarySpan { x, z, length, weight, stiffness: material.stiffness, bed };
        Some((span.solve(), [ahead, up], rises))
    }

    /// Puts the nodes on the elastic catenary. If part of a line that may float would then be above water, puts the nodes on
    /// the catenary of a sinking line without floats; they rise from there.
    fn hang(&mut self, around: &dyn Fn(&Vector<D>) -> NodeSurroundings<D>, gravity: &Vector<D>) {
        let Some(shape) = self.catenary(around, gravity) else { return };
        self.place_on(shape);
        let is_wet = |x: &Vector<D>| around(x).wet == 1.0;
        let inner = 1..self.segments();
        if self.may_float() && !self.state.x[inner].iter().all(is_wet) {
            let [first, last] = [0, self.segments()].map(|i| self.state.x[i]);
            let low = if gravity.dot(&(last - first)) <= 0.0 { first } else { last };
            let (material, below) = (&self.material, around(&low));
            let net = (material.mass - below.wet * material.displaced()).abs().max(1e-3 * material.mass);
            if let Some(shape) = self.catenary_of(net, &below, gravity) {
                self.place_on(shape);
            }
        }
    }

    /// Puts the nodes between the ends on a catenary.
    fn place_on(&mut self, (shape, [ahead, up], rises): (Catenary, [Vector<D>; 2], bool)) {
        let n = self.segments();
        let low = self.state.x[if rises { 0 } else { n }];
        for i in 1..n {
            let s = self.state.segment * if rises { i } else { n - i } as f64;
            let [x, z] = shape.position(s);
            self.state.x[i] = low + ahead * x + up * z;
        }
    }

    /// Forces (N) on the nodes at rest.
    fn forces(&self, around: &[NodeSurroundings<D>], gravity: &Vector<D>) -> Vec<Vector<D>> {
        let (still, n) = (Vector::zeros(), self.segments());
        let pulls = segment_pulls(self, around, gravity);
        let at = |i: usize| {
            let here = NodeSurroundings { water_velocity: still, ..around[i] };
            let (share, hold) = (self.share(i), self.hold(i, &here, &pulls));
            let water = water_load(&self.material, (share, &self.bodies[i]), (&still, &still), &here, gravity);
            let bed = bed_load(&self.material, share, (&self.state.x[i], &still), &here, (gravity, &hold));
            water.force + bed.map_or(still, |bed| bed.normal * bed.reaction)
        };
        let mut forces: Vec<Vector<D>> = (0..=n).map(at).collect();
        for s in 0..n {
            forces[s] += pulls[s].pull;
            forces[s + 1] -= pulls[s].pull;
        }
        if self.material.bending > 0.0 {
            let energy = self.material.bending / self.state.segment;
            for i in 1..n {
                let x = &self.state.x;
                let bent = bending_forces([&x[i - 1], &x[i], &x[i + 1]], energy);
                bent.iter().zip(i - 1..).for_each(|(force, i)| forces[i] += force);
            }
        }
        forces
    }

    /// The stiffness (N/m) of the nodes between the ends, plus `least` on its diagonal. `float` is the stiffness of their
    /// buoyancy along gravity.
    fn stiffness(
        &self,
        around: &[NodeSurroundings<D>],
        gravity: &Vector<D>,
        (least, float): (f64, &[f64]),
    ) -> BandMatrix {
        let (n, material) = (self.segments(), &self.material);
        let mut made = BandMatrix::new((n - 1) * D, 3 * D - 1);
        let identity = Matrix::<D>::identity();
        let mut add = |i: usize, j: usize, block: &Matrix<D>| {
            if (1..n).contains(&i) && (1..n).contains(&j) {
                (0..D).for_each(|a| (0..D).for_each(|b| made.add((i - 1) * D + a, (j - 1) * D + b, block[(a, b)])));
            }
        };
        let pulls = segment_pulls(self, around, gravity);
        for (s, &SegmentPull { q, length, tension, slope, .. }) in pulls.iter().enumerate() {
            if tension > 0.0 {
                let along = q * q.transpose();
                let block = along * (slope / self.state.segment) + (identity - along) * (tension / length);
                for (i, j, sign) in [(s, s, 1.0), (s + 1, s + 1, 1.0), (s + 1, s, -1.0)] {
                    add(i, j, &(block * sign));
                }
            }
        }
        let vertical = gravity.try_normalize(f64::MIN_POSITIVE).map_or_else(Matrix::zeros, |g| g * g.transpose());
        for (i, stiff) in float.iter().enumerate() {
            add(i, i, &(vertical * *stiff));
        }
        for (i, here) in around.iter().enumerate() {
            add(i, i, &(identity * least));
            let Some(bed) = &here.bed else { continue };
            let on_bed = (bed, material.depth(bed, &self.state.x[i]));
            let [_, stiff] =
                bed_reaction(material, self.share(i), on_bed, here.wet, (gravity, &self.hold(i, here, &pulls)));
            add(i, i, &(bed.normal * bed.normal.transpose() * stiff));
        }
        if material.bending > 0.0 {
            let stiff = material.bending / self.state.segment.powi(3);
            let second = [1.0, -2.0, 1.0];
            for i in 1..n {
                let q = (self.state.x[i + 1] - self.state.x[i - 1]).normalize();
                let across = (identity - q * q.transpose()) * stiff;
                for (a, x) in second.iter().enumerate() {
                    (0..=a).for_each(|b| add(i + a - 1, i + b - 1, &(across * (x * second[b]))));
                }
            }
        }
        made
    }

    /// Decrease of the buoyancy of each node as it rises, N/m, if the node is partly wet.
    fn float_stiffness(&self, around: &Around<'_, D>, near: &[NodeSurroundings<D>], gravity: &Vector<D>) -> Vec<f64> {
        let (Around::Live(around), Some(down)) = (around, gravity.try_normalize(f64::MIN_POSITIVE)) else {
            return Vec::new();
        };
        let way = DIFFERENCE * self.state.segment;
        let stiffness = |(i, here): (usize, &NodeSurroundings<D>)| {
            if here.wet == 0.0 || here.wet == 1.0 {
                return 0.0;
            }
            let [above, below] = [-way, way].map(|way| around(&(self.state.x[i] + down * way)).wet);
            let displaced =
                self.material.displaced() * self.share(i) + self.material.water_density * self.bodies[i].volume;
            displaced * gravity.norm() * (below - above).max(0.0) / (2.0 * way)
        };
        near.iter().enumerate().map(stiffness).collect()
    }

    /// Minimises the potential energy. Returns the largest residual force on a node over the weight of a node.
    fn minimize(&mut self, around: &Around<'_, D>, gravity: &Vector<D>) -> f64 {
        let n = self.segments();
        if n < 2 {
            return 0.0;
        }
        let weight = self.node_weight(gravity);
        let (softest, stiffest) = (1e-6 * weight / self.state.segment, 10.0 * weight / self.state.segment);
        let mut least = softest;
        let inner = |forces: &[Vector<D>]| DVector::from_iterator((n - 1) * D, forces[1..n].iter().flatten().copied());
        let mut near = around.of(&self.state.x);
        let mut forces = self.forces(&near, gravity);
        let is_live = matches!(around, Around::Live(_));
        let most = if is_live { LIVE_ITERATIONS } else { ITERATIONS };
        for _ in 0..most {
            if self.residual(&forces, gravity) <= TOLERANCE {
                break;
            }
            let mut step = inner(&forces);
            let uphill = step.clone();
            let float = self.float_stiffness(around, &near, gravity);
            self.stiffness(&near, gravity, (least, &float)).solve(step.as_mut_slice());
            let start = self.state.x.clone();
            let downhill = uphill.dot(&step);
            let longest = step.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
            let mut part = (self.state.segment / longest).min(1.0);
            let before = if is_live { near.clone() } else { Vec::new() };
            for _ in 0..30 {
                for i in 1..n {
                    self.state.x[i] = start[i] + Vector::from_fn(|k, _| part * step[(i - 1) * D + k]);
                }
                if is_live {
                    near = around.of(&self.state.x);
                }
                forces = self.forces(&near, gravity);
                // The energy is convex: past its minimum along the step the forces point back.
                if inner(&forces).dot(&step) > -0.5 * downhill && !self.sinks(&before, &start) {
                    break;
                }
                part *= 0.5;
            }
            if is_live {
                least = (least * DAMPING[usize::from(part >= CUT)]).clamp(softest, stiffest);
            }
        }
        self.residual(&forces, gravity)
    }

    /// Whether a node has moved too far from `start` (m) into its bed `before` the step: behind a thin wall it would find no bed.
    fn sinks(&self, before: &[NodeSurroundings<D>], start: &[Vector<D>]) -> bool {
        let sinks = |((here, from), to): ((&NodeSurroundings<D>, &Vector<D>), &Vector<D>)| {
            let allowed = |bed: &BedPlane<D>| self.material.depth(bed, from).max(0.0) + SINKING * self.state.segment;
            here.bed.is_some_and(|bed| self.material.depth(&bed, to) > allowed(&bed))
        };
        before.iter().zip(start).zip(&self.state.x).any(sinks)
    }
}

/// What is around the nodes as they move.
enum Around<'a, const D: usize> {
    /// The same.
    Frozen(Vec<NodeSurroundings<D>>),
    /// What is around a place (m).
    Live(&'a dyn Fn(&Vector<D>) -> NodeSurroundings<D>),
}

impl<const D: usize> Around<'_, D> {
    /// What is around nodes at these places (m).
    fn of(&self, places: &[Vector<D>]) -> Vec<NodeSurroundings<D>> {
        match self {
            Self::Frozen(near) => near.clone(),
            Self::Live(around) => places.iter().map(around).collect(),
        }
    }
}

/// A symmetric positive definite matrix whose entries lie near its diagonal; its lower half.
struct BandMatrix {
    size: usize,
    width: usize,
    rows: Vec<f64>,
}

impl BandMatrix {
    /// Zeros, with `width` entries beside the diagonal.
    fn new(size: usize, width: usize) -> Self {
        Self { size, width, rows: vec![0.0; size * (width + 1)] }
    }

    fn index(&self, i: usize, j: usize) -> usize {
        i * (self.width + 1) + self.width + j - i
    }

    /// Adds to entry (i, j) if it lies in the lower half.
    fn add(&mut self, i: usize, j: usize, x: f64) {
        if j <= i {
            let at = self.index(i, j);
            self.rows[at] += x;
        }
    }

    /// Replaces `right` by the solution, by Cholesky's decomposition.
    fn solve(mut self, right: &mut [f64]) {
        for i in 0..self.size {
            let first = i.saturating_sub(self.width);
            for j in first..=i {
                let common = first.max(j.saturating_sub(self.width))..j;
                let sum: f64 = common.map(|k| self.rows[self.index(i, k)] * self.rows[self.index(j, k)]).sum();
                let (at, diagonal) = (self.index(i, j), self.index(j, j));
                let rest = self.rows[at] - sum;
                self.rows[at] = if i == j { rest.max(f64::MIN_POSITIVE).sqrt() } else { rest / self.rows[diagonal] };
            }
            let sum: f64 = (first..i).map(|k| self.rows[self.index(i, k)] * right[k]).sum();
            right[i] = (right[i] - sum) / self.rows[self.index(i, i)];
        }
        for i in (0..self.size).rev() {
            let last = (i + self.width).min(self.size - 1);
            let sum: f64 = (i + 1..=last).map(|k| self.rows[self.index(k, i)] * right[k]).sum();
            right[i] = (right[i] - sum) / self.rows[self.index(i, i)];
        }
    }
}

#[cfg(all(test, feature = "dim2", feature = "dim3"))]
#[path = "../../../tests/unit/solid/mooring/equilibrium.rs"]
mod tests;
