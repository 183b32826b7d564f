//! A lumped-mass line in motion.
//!
//! An inner step of length h drifts by h/2, changes the velocities, and drifts by h/2 again (Störmer and Verlet). Elastic forces
//! are those of the middle of the step; drag acts at the mean of the velocities before and after, and the resistance of a bed at
//! the velocity after it:
//!
//!   (M + h/2 C + h C_bed) Δv = h (f − (C + C_bed) v)
//!
//! Damping of any strength is therefore stable, and elasticity only requires h ω < 2. The step is h = 0.7/ω, with which a line
//! without losses keeps its energy within 1 %. M and C of the water change slowly: they are taken anew every eight inner steps.
//!
//! Axial damping acts at the velocity (1 − θ) v + θ (v + Δv). With the highest rate of decay κ = 4 BA/(m l₀²), θ is ½, or
//! 1 − 1/(h κ) if that is more: no motion then changes its sign in a step by damping, which a segment that cannot push would
//! take for slack.
//!
//! Axial damping couples neighbouring nodes along their segment. Its impulses λ on the segments are the unknowns: with the inverse
//! A of the matrix of each node, its other impulse r, and the damping b = θ h BA/l₀,
//!
//!   Δvᵢ = Aᵢ (rᵢ + qᵢ λᵢ − qᵢ₋₁ λᵢ₋₁),  λᵢ = bᵢ qᵢ·(Δvᵢ₊₁ − Δvᵢ)
//!
//! which is a tridiagonal system of numbers.

use serde::{Deserialize, Serialize};

use super::{
    forces::{
        LineMaterial, NodeBody, NodeHold, NodeSurroundings, WaterLoad, bed_load, bending_forces, friction, water_load,
    },
    segment::{SegmentPull, segment_pull, segment_pulls},
};
use crate::math::{Matrix, Vector};

/// Length of an inner step times the highest frequency of the line, –. Steps are stable up to 2, but at 1.2 a free line gains 1 % of energy.
const INNER_STEP: f64 = 0.7;

/// Inner steps for which mass and resistance of the water are constant. The fastest motion of a line takes nine.
const WATER_STEPS: usize = 8;

/// The state of a line in a checkpoint.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct LineState<const D: usize> {
    /// Places of the nodes, m.
    pub(crate) x: Vec<Vector<D>>,
    /// Their velocities, m/s.
    pub(crate) v: Vec<Vector<D>>,
    /// Mean force on the support of each end in the last step, N.
    pub(crate) end_forces: [Vector<D>; 2],
    /// Point from which a bed holds each node that lies on it, m.
    pub(crate) grips: Vec<Option<Vector<D>>>,
    /// Pull of each segment on its first node at the end of the last step, N.
    pub(crate) pulls: Vec<Vector<D>>,
    /// Number of the segment that has broken.
    pub(crate) broken: Option<u32>,
    /// Length of a segment without tension, m.
    pub(crate) segment: f64,
    /// Whether the line acts now.
    pub(crate) acts: bool,
}

/// A line of equal segments. Each end is held and moves as prescribed, or is free, or is joined to ends of other lines.
#[derive(Clone)]
pub(crate) struct MooringLine<const D: usize> {
    pub(super) material: LineMaterial,
    /// Point mass on each node.
    pub(super) bodies: Vec<NodeBody>,
    /// Whether each end is held.
    pub(super) held: [bool; 2],
    /// Impulse (N s) of drag and added mass on each node in the last step; `None` unless the line acts on the water.
    pub(super) water_impulses: Option<Vec<Vector<D>>>,
    pub(crate) state: LineState<D>,
    pub(super) work: Workspace<D>,
}

/// Arrays of an inner step, kept from one to the next.
#[derive(Clone, Default)]
pub(super) struct Workspace<const D: usize> {
    /// Inner steps since the begin of the step.
    inner_steps: usize,
    /// Pull of each segment.
    pub(super) pulls: Vec<SegmentPull<D>>,
    /// The water around each node.
    nodes: Vec<NodeInWater<D>>,
    /// Matrix M + h/2 C + h C_bed of each node, kg, and its inverse.
    pub(super) matrix: Vec<Matrix<D>>,
    inverse: Vec<Matrix<D>>,
    /// Impulse on each node without that of the axial damping by the change of the velocities, N s.
    pub(super) impulse: Vec<Vector<D>>,
    /// Coupling of the ends of each segment by its damping.
    pub(super) coupling: Vec<AxialCoupling<D>>,
    /// λ of each segment, N s.
    lambda: Vec<f64>,
    /// Change of the velocity of each node, m/s.
    pub(super) change: Vec<Vector<D>>,
    /// Change of the velocity of each node for a unit change of the velocity of each end along its segment, –; for joined lines.
    pub(super) responses: [Vec<Vector<D>>; 2],
    /// Impulse (N s) of the water on each node at constant velocity, and its decrease for a unit change of the velocity, kg;
    /// empty unless the line acts on the water.
    pub(super) from_water: Vec<(Vector<D>, Matrix<D>)>,
}

/// What the water does to a node for some inner steps.
#[derive(Clone, Copy)]
struct NodeInWater<const D: usize> {
    load: WaterLoad<D>,
    /// M + h/2 C, kg, and its inverse.
    matrix: Matrix<D>,
    inverse: Matrix<D>,
}

/// How the axial damping of a segment couples its ends.
#[derive(Clone, Copy)]
pub(super) struct AxialCoupling<const D: usize> {
    /// Direction of the segment.
    pub(super) q: Vector<D>,
    /// b, kg.
    pub(super) b: f64,
    /// A q of its first and its second node, 1/kg; zero at a node whose change of velocity is given.
    sides: [Vector<D>; 2],
    /// Coefficient of the λ before, inverse of the pivot, and coefficient of the λ behind, –.
    factors: [f64; 3],
}

impl<const D: usize> MooringLine<D> {
    /// A straight line at rest between two points (m), of `segments` segments and of this `length` (m) without tension.
    pub(crate) fn straight(material: LineMaterial, length: f64, segments: usize, ends: [Vector<D>; 2]) -> Self {
        let place = |i: usize| ends[0] + (ends[1] - ends[0]) * (i as f64 / segments as f64);
        Self {
            material,
            bodies: vec![NodeBody::default(); segments + 1],
            held: [true; 2],
            water_impulses: None,
            state: LineState {
                x: (0..=segments).map(place).collect(),
                v: vec![Vector::zeros(); segments + 1],
                end_forces: [Vector::zeros(); 2],
                grips: vec![None; segments + 1],
                pulls: vec![Vector::zeros(); segments],
                broken: None,
                segment: length / segments as f64,
                acts: true,
            },
            work: Workspace::default(),
        }
    }

    /// Number of segments.
    pub(crate) fn segments(&self) -> usize {
        self.bodies.len() - 1
    }

    /// Number of the node at end `k`.
    pub(crate) fn end_node(&self, k: usize) -> usize {
        k * self.segments()
    }

    /// Length without tension, m.
    pub(crate) fn length(&self) -> f64 {
        self.state.segment * self.segments() as f64
    }

    /// Length of the line that belongs to node `i`, m.
    pub(super) fn share(&self, i: usize) -> f64 {
        if i == 0 || i == self.segments() { 0.5 * self.state.segment } else { self.state.segment }
    }

    /// Unit vector along segment `s` and its length, m.
    pub(super) fn direction_and_length(&self, s: usize) -> (Vector<D>, f64) {
        let side = self.state.x[s + 1] - self.state.x[s];
        let length = side.norm();
        (if length > 0.0 { side / length } else { side }, length)
    }

    /// Tension of segment `s` at the end of the last step, N.
    pub(crate) fn tension(&self, s: usize) -> f64 {
        self.state.pulls[s].norm()
    }

    /// Damping (N s/m) of a segment that grows at `rate` (m/s): none where it would push.
    fn active_damping(&self, pull: &SegmentPull<D>, rate: f64) -> f64 {
        let damping = self.material.damping / self.state.segment;
        if pull.tension > 0.0 && pull.tension + damping * rate > 0.0 { damping } else { 0.0 }
    }

    /// Unit tangent at node `i`; zero where both neighbours lie in one place.
    fn tangent(&self, i: usize) -> Vector<D> {
        let x = &self.state.x;
        let side = x[(i + 1).min(x.len() - 1)] - x[i.saturating_sub(1)];
        side.try_normalize(f64::MIN_POSITIVE).unwrap_or_else(Vector::zeros)
    }

    /// Longest inner step, s.
    pub(crate) fn step_limit(&self) -> f64 {
        INNER_STEP / self.material.highest_frequency(self.state.segment)
    }

    /// Advances the line by `dt` (s). The held ends move evenly to the points `ends` (m), `around` are the surroundings of each
    /// node, and `gravity` is in m/s². Returns the mean force (N) on the support of each end; zero at a free end.
    pub(crate) fn advance(
        &mut self,
        ends: [Vector<D>; 2],
        dt: f64,
        around: &[NodeSurroundings<D>],
        gravity: &Vector<D>,
    ) -> [Vector<D>; 2] {
        let mut impulses = self.begin_step(ends, dt, around, gravity);
        let steps = (dt / self.step_limit()).ceil().max(1.0);
        let h = dt / steps;
        for _ in 0..steps as u64 {
            self.drift(0.5 * h);
            self.kick(h, around, gravity, &mut impulses);
            self.drift(0.5 * h);
        }
        self.end_step(ends, dt, impulses, (around, gravity));
        self.state.end_forces
    }

    /// Sets the velocities of the held ends, which move evenly to the points `ends` (m) in a step of length `dt` (s). Returns the
    /// impulses (N s) on the supports of the ends.
    pub(super) fn begin_step(
        &mut self,
        ends: [Vector<D>; 2],
        dt: f64,
        around: &[NodeSurroundings<D>],
        gravity: &Vector<D>,
    ) -> [Vector<D>; 2] {
        let mut impulses = [Vector::zeros(); 2];
        self.work.inner_steps = 0;
        self.work.pulls = segment_pulls(self, around, gravity);
        if let Some(from_water) = &mut self.water_impulses {
            from_water.fill(Vector::zeros());
        }
        for k in (0..2).filter(|k| self.held[*k]) {
            let i = self.end_node(k);
            let velocity = (ends[k] - self.state.x[i]) / dt;
            let (mass, change) = (self.water_load(i, &around[i], gravity).mass, velocity - self.state.v[i]);
            impulses[k] -= mass * change;
            self.state.v[i] = velocity;
            let added = mass - Matrix::identity() * self.dry_mass(i);
            if let Some(from_water) = &mut self.water_impulses {
                from_water[i] -= added * change;
            }
        }
        impulses
    }

    /// Ends a step of length `dt` (s) with the held ends at the points `ends` (m) and these `impulses` (N s) on their supports.
    pub(super) fn end_step(
        &mut self,
        ends: [Vector<D>; 2],
        dt: f64,
        impulses: [Vector<D>; 2],
        (around, gravity): (&[NodeSurroundings<D>], &Vector<D>),
    ) {
        for k in (0..2).filter(|k| self.held[*k]) {
            let node = self.end_node(k);
            self.state.x[node] = ends[k];
        }
        self.state.end_forces = impulses.map(|impulse| impulse / dt);
        self.store_pulls(around, gravity);
    }

    /// Stores the pulls of the segments where the nodes are, with their damping.
    pub(super) fn store_pulls(&mut self, around: &[NodeSurroundings<D>], gravity: &Vector<D>) {
        let damped = |(s, segment): (usize, SegmentPull<D>)| {
            let rate = segment.q.dot(&(self.state.v[s + 1] - self.state.v[s]));
            segment.pull + segment.q * (self.active_damping(&segment, rate) * rate)
        };
        self.state.pulls = segment_pulls(self, around, gravity).into_iter().enumerate().map(damped).collect();
    }

    pub(super) fn drift(&mut self, h: f64) {
        let LineState { x, v, .. } = &mut self.state;
        x.iter_mut().zip(v).for_each(|(x, v)| *x += *v * h);
    }

    /// Mass of node `i` without that of the water, kg.
    fn dry_mass(&self, i: usize) -> f64 {
        self.material.mass * self.share(i) + self.bodies[i].mass
    }

    /// The load of weight and water on node `i`.
    fn water_load(&self, i: usize, around: &NodeSurroundings<D>, gravity: &Vector<D>) -> WaterLoad<D> {
        let motion = (&self.state.v[i], &self.tangent(i));
        water_load(&self.material, (self.share(i), &self.bodies[i]), motion, around, gravity)
    }

    /// How node `i` is held near a bed, with the `pulls` of the segments.
    pub(super) fn hold(&self, i: usize, around: &NodeSurroundings<D>, pulls: &[SegmentPull<D>]) -> NodeHold<D> {
        let n = self.segments();
        match i {
            _ if around.bed.is_none() => NodeHold::Free,
            0 if self.held[0] => NodeHold::Held(pulls[0].pull),
            i if i == n && self.held[1] => NodeHold::Held(-pulls[n - 1].pull),
            i if (1..n).contains(&i) => NodeHold::Between((pulls[i - 1].pull + pulls[i].pull) * 0.5),
            _ => NodeHold::Free,
        }
    }

    /// Fills the matrices and the impulses of a step `h` (s) long.
    pub(super) fn assemble(&mut self, h: f64, around: &[NodeSurroundings<D>], gravity: &Vector<D>) {
        let n = self.segments();
        let mut work = std::mem::take(&mut self.work);
        let Workspace { inner_steps, nodes, pulls, matrix, inverse, impulse, coupling, from_water, .. } = &mut work;
        if *inner_steps % WATER_STEPS == 0 {
            let in_water = |i: usize| {
                let load = self.water_load(i, &around[i], gravity);
                let matrix = load.mass + load.drag * (0.5 * h);
                NodeInWater { load, matrix, inverse: inverted(matrix) }
            };
            nodes.clear();
            nodes.extend((0..=n).map(in_water));
        }
        *inner_steps += 1;
        for (s, pull) in pulls.iter_mut().enumerate() {
            *pull = segment_pull(self, s, around, gravity, pull.tension);
        }
        matrix.clear();
        inverse.clear();
        impulse.clear();
        coupling.clear();
        from_water.clear();
        for (i, NodeInWater { load, matrix: in_water, inverse: its_inverse }) in nodes.iter().enumerate() {
            let (x, v, share) = (&self.state.x[i], &self.state.v[i], self.share(i));
            if self.water_impulses.is_some() {
                let added = load.mass - Matrix::identity() * self.dry_mass(i);
                let steady = load.drag * (around[i].water_velocity - v) * h;
                from_water.push((steady, added + load.drag * (0.5 * h)));
            }
            let mut force = load.force - load.drag * v;
            let hold = self.hold(i, &around[i], pulls);
            let bed = bed_load(&self.material, share, (x, v), &around[i], (gravity, &hold));
            let damping = bed.map_or(0.0, |bed| bed.damping);
            if let Some(bed) = bed {
                force += bed.normal * (bed.reaction - damping * bed.normal.dot(v));
                if self.material.bed_friction > 0.0 {
                    force += friction(&self.material, share, x, around[i].bed, &mut self.state.grips[i]);
                }
            } else {
                self.state.grips[i] = None;
            }
            match bed.filter(|_| damping > 0.0) {
                Some(bed) => {
                    matrix.push(in_water + bed.normal * bed.normal.transpose() * (damping * h));
                    inverse.push(inverted(matrix[i]));
                }
                None => {
                    matrix.push(*in_water);
                    inverse.push(*its_inverse);
                }
            }
            impulse.push(force * h);
        }
        let share = (1.0 - 1.0 / (h * self.material.highest_decay(self.state.segment))).max(0.5);
        for (s, segment) in pulls.iter().enumerate() {
            let q = segment.q;
            let rate = q.dot(&(self.state.v[s + 1] - self.state.v[s]));
            let damping = self.active_damping(segment, rate);
            let pull = (segment.pull + q * (damping * rate)) * h;
            impulse[s] += pull;
            impulse[s + 1] -= pull;
            coupling.push(AxialCoupling { q, b: share * h * damping, sides: [Vector::zeros(); 2], factors: [0.0; 3] });
        }
        if self.material.bending > 0.0 {
            let energy = self.material.bending / self.state.segment;
            let whole = |s: usize| self.state.broken != Some(s as u32);
            for i in (1..n).filter(|i| whole(*i) && whole(i - 1)) {
                let x = &self.state.x;
                let forces = bending_forces([&x[i - 1], &x[i], &x[i + 1]], energy);
                forces.iter().zip(i - 1..).for_each(|(force, i)| impulse[i] += force * h);
            }
        }
        self.work = work;
    }

    /// Changes the velocities by the forces of a step of length `h` (s); adds the impulses (N s) on the supports of the ends.
    fn kick(&mut self, h: f64, around: &[NodeSurroundings<D>], gravity: &Vector<D>, impulses: &mut [Vector<D>; 2]) {
        self.assemble(h, around, gravity);
        let n = self.segments();
        let inner = [usize::from(self.held[0]), if self.held[1] { n - 1 } else { n }];
        self.work.eliminate(inner);
        self.work.solve(inner);
        self.state.v.iter_mut().zip(&self.work.change).for_each(|(v, change)| *v += change);
        self.add_end_impulses(impulses);
        self.add_water_impulses();
    }

    /// Adds the impulses of the water in the last change of the velocities.
    pub(super) fn add_water_impulses(&mut self) {
        let Some(sums) = &mut self.water_impulses else { return };
        for ((sum, (steady, resistance)), change) in sums.iter_mut().zip(&self.work.from_water).zip(&self.work.change) {
            *sum += steady - resistance * change;
        }
    }

    /// Adds the impulses (N s) of the last change of the velocities on the supports of the ends.
    pub(super) fn add_end_impulses(&self, impulses: &mut [Vector<D>; 2]) {
        let (n, Workspace { impulse, coupling, change, .. }) = (self.segments(), &self.work);
        let sides = [(0, 1, 0), (n - 1, n - 1, n)];
        for (k, (s, beside, end)) in sides.into_iter().enumerate().filter(|(k, _)| self.held[*k]) {
            impulses[k] += impulse[end] + coupling[s].along(&change[beside]);
        }
    }

    /// Energies of the dry line, J: motion, stretch and bending, height under `gravity` (m/s²).
    #[cfg(test)]
    pub(crate) fn energies(&self, around: &[NodeSurroundings<D>], gravity: &Vector<D>) -> [f64; 3] {
        let mass = |i: usize| self.material.mass * self.share(i) + self.bodies[i].mass;
        let nodes = || self.state.x.iter().zip(&self.state.v).enumerate();
        let stretch = |s: usize| {
            let SegmentPull { tension, sag, .. } = segment_pull(self, s, around, gravity, 0.0);
            // What sags has lost height.
            let lost = if sag > 0.0 { sag / (12.0 * tension) } else { 0.0 };
            self.state.segment * (0.5 * tension * tension / self.material.stiffness - lost)
        };
        let bend = |i: usize| {
            let cosine = self.direction_and_length(i - 1).0.dot(&self.direction_and_length(i).0);
            self.material.bending / self.state.segment * (1.0 - cosine)
        };
        [
            nodes().map(|(i, (_, v))| 0.5 * mass(i) * v.norm_squared()).sum(),
            (0..self.segments()).map(stretch).sum::<f64>() + (1..self.segments()).map(bend).sum::<f64>(),
            nodes().map(|(i, (x, _))| -mass(i) * gravity.dot(x)).sum(),
        ]
    }
}

/// The inverse of a node's `matrix`; zero if there is none.
fn inverted<const D: usize>(matrix: Matrix<D>) -> Matrix<D> {
    matrix.try_inverse().unwrap_or_else(Matrix::zeros)
}

impl<const D: usize> AxialCoupling<D> {
    /// The impulse (N s) on one end for the `change` of the velocity of the other, m/s.
    pub(super) fn along(&self, change: &Vector<D>) -> Vector<D> {
        self.q * (self.b * self.q.dot(change))
    }
}

impl<const D: usize> Workspace<D> {
    /// Factorises the system of λ. The velocities of the nodes from `first` to `last` change; those of the others are given.
    pub(super) fn eliminate(&mut self, [first, last]: [usize; 2]) {
        let Self { inverse, coupling, .. } = self;
        let times =
            |i: usize, q: &Vector<D>| if (first..=last).contains(&i) { inverse[i] * q } else { Vector::zeros() };
        for (s, own) in coupling.iter_mut().enumerate() {
            own.sides = [times(s, &own.q), times(s + 1, &own.q)];
        }
        let [mut before, mut behind] = [0.0; 2];
        for s in 0..coupling.len() {
            let AxialCoupling { q, b, sides: [low, high], .. } = coupling[s];
            let next = coupling.get(s + 1).map_or(0.0, |next| next.q.dot(&high));
            let pivot = 1.0 + b * (q.dot(&(low + high)) - before * behind);
            coupling[s].factors = [b * before, 1.0 / pivot, b * next / pivot];
            (before, behind) = (next, b * next / pivot);
        }
    }

    /// Solves for `change` by `impulse`, after [`Workspace::eliminate`] for the same nodes.
    pub(super) fn solve(&mut self, nodes: [usize; 2]) {
        let mut change = std::mem::take(&mut self.change);
        let impulse = std::mem::take(&mut self.impulse);
        self.solve_for(&impulse, nodes, &mut change);
        (self.change, self.impulse) = (change, impulse);
    }

    /// Solves for the changes of velocity `change` (m/s) of the nodes from `first` to `last` by the `impulse` (N s) on each node.
    pub(super) fn solve_for(&mut self, impulse: &[Vector<D>], [first, last]: [usize; 2], change: &mut Vec<Vector<D>>) {
        let Self { inverse, coupling, lambda, .. } = self;
        change.clear();
        change.resize(impulse.len(), Vector::zeros());
        for i in first..=last {
            change[i] = inverse[i] * impulse[i];
        }
        lambda.clear();
        let mut before = 0.0;
        for (own, ends) in coupling.iter().zip(change.windows(2)) {
            let [coefficient, inverse_pivot, _] = own.factors;
            before = (own.b * own.q.dot(&(ends[1] - ends[0])) + coefficient * before) * inverse_pivot;
            lambda.push(before);
        }
        let mut behind = 0.0;
        for (s, own) in coupling.iter().enumerate().rev() {
            behind = lambda[s] + own.factors[2] * behind;
            change[s] += own.sides[0] * behind;
            change[s + 1] -= own.sides[1] * behind;
        }
    }
}

#[cfg(all(test, feature = "dim2", feature = "dim3"))]
#[path = "../../../tests/unit/solid/mooring/line.rs"]
mod tests;
