//! A mooring line on the solids of a running system.
//!
//! During a step an end on a driven solid moves to its position at the end of the step; an end on a free solid moves at the
//! velocity of its point at the start. The mean force of the step acts on the free solid in the same step, so that the impulses
//! are exact. The end of the line and its point on the solid then differ by the acceleration of the solid over one step, which
//! the next step corrects.

use super::{
    forces::BedPlane,
    line::{LineState, MooringLine},
    specification::MooringSpec,
};
use crate::{
    math::Vector,
    solid::{Kinematics, Lifetime, Load, Mobility},
};

/// Δt times the frequency of a body on the first segment, at most: the coupling is stable up to 0.8.
const COUPLING_STEP: f64 = 0.5;

/// Δt times the rate at which waves on a line slow a body, at most.
const RADIATION_STEP: f64 = 0.25;

/// Height of a held end above the bed up to which it is level with the bed, as a part of a segment.
const LEVEL: f64 = 1e-6;

/// Shape and tension of a mooring line.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct MooringReading<const D: usize> {
    /// World positions of its nodes, m; empty while it does not act.
    pub nodes: Vec<Vector<D>>,
    /// Tension of each segment, N (N/m in 2-D).
    pub tensions: Vec<f64>,
    /// Force on the support of each end, as a mean over the last step, N (N/m in 2-D).
    pub end_forces: [Vector<D>; 2],
    /// Length of line that lies on fixed solids, m.
    pub on_bed: f64,
    /// Angle of the last segment above the horizontal, rad.
    pub anchor_angle: f64,
    /// Number of the segment that has broken.
    pub broken: Option<usize>,
}

impl<const D: usize> Default for MooringReading<D> {
    /// Of a line that does not act.
    fn default() -> Self {
        let end_forces = [Vector::zeros(); 2];
        Self { nodes: Vec::new(), tensions: Vec::new(), end_forces, on_bed: 0.0, anchor_angle: 0.0, broken: None }
    }
}

/// A mooring line on the solids of a running system.
pub(crate) struct Mooring<const D: usize> {
    pub(crate) name: String,
    solids: [Option<usize>; 2],
    /// Its ends in the frames of their solids, m.
    local_ends: [Vector<D>; 2],
    spec: MooringSpec<D>,
    pub(crate) line: MooringLine<D>,
}

impl<const D: usize> Mooring<D> {
    /// The line, straight between the initial places of its ends, in water of density `water_density` (kg/m³).
    pub(crate) fn new(spec: &MooringSpec<D>, start: &[Kinematics<D>], water_density: f64) -> Self {
        let length = spec.length_at(0.0);
        let material = spec.line.material(spec.length / spec.segments as f64, water_density);
        let mut line = MooringLine::straight(material, length, spec.segments, spec.ends.map(|end| end.at));
        line.bodies = spec.node_bodies();
        line.state.acts = spec.lifetime.contains(0.0);
        line.water_impulses = spec.acts_on_water.then(|| vec![Vector::zeros(); spec.segments + 1]);
        let local = |k: usize| {
            let (end, at) = (spec.ends[k].solid, spec.ends[k].at);
            end.map_or(at, |solid| start[solid].pose.local(&at))
        };
        let local_ends = [local(0), local(1)];
        Self { name: spec.name.clone(), solids: spec.ends.map(|end| end.solid), local_ends, spec: spec.clone(), line }
    }

    /// When it acts.
    pub(crate) fn lifetime(&self) -> &Lifetime {
        &self.spec.lifetime
    }

    /// Sets the length to that of the winch in a step from time `t` (s) on, `dt` (s) long.
    pub(crate) fn pay_out(&mut self, t: f64, dt: f64) {
        if self.spec.paid_out.is_some() {
            self.line.state.segment = self.spec.length_at(t + 0.5 * dt) / self.spec.segments as f64;
        }
        if let Some(winch) = self.spec.winch.filter(|_| self.line.state.acts) {
            let (length, tension) = (self.line.length(), self.end_force(0).norm());
            let length = winch.next_length(length, tension, self.line.material.stiffness, dt);
            self.line.state.segment = length / self.spec.segments as f64;
        }
    }

    /// Lets the line act from now on, straight between its ends on the solids `now`, with velocities interpolated between those
    /// of the ends.
    pub(crate) fn begin(&mut self, now: &[Kinematics<D>]) {
        let ends = [0, 1].map(|k| self.end(k, now));
        let velocity = |k: usize| {
            let solid = self.solids[k].map(|solid| &now[solid]);
            solid.map_or_else(Vector::zeros, |solid| solid.velocity + solid.spin.velocity_at(&(ends[k] - solid.centre)))
        };
        let (velocities, n) = ([velocity(0), velocity(1)], self.line.segments());
        let state = &mut self.line.state;
        state.acts = true;
        for (i, (x, v)) in state.x.iter_mut().zip(&mut state.v).enumerate() {
            let share = i as f64 / n as f64;
            *x = ends[0] + (ends[1] - ends[0]) * share;
            *v = velocities[0] + (velocities[1] - velocities[0]) * share;
        }
    }

    /// Ends the line.
    pub(crate) fn end_lifetime(&mut self) {
        self.line.state.acts = false;
        self.line.state.end_forces = [Vector::zeros(); 2];
    }

    /// The solids at its ends.
    pub(crate) fn solids(&self) -> [Option<usize>; 2] {
        self.solids
    }

    /// World position of end `k` where the solids are, m.
    fn end(&self, k: usize, solids: &[Kinematics<D>]) -> Vector<D> {
        self.solids[k].map_or(self.local_ends[k], |solid| solids[solid].pose.point(&self.local_ends[k]))
    }

    /// World position (m) of end `k` after a step of length `dt` (s) from the solids `now`; `next` has the driven solids at its
    /// end.
    fn end_after(&self, k: usize, now: &[Kinematics<D>], next: &[Option<Kinematics<D>>], dt: f64) -> Vector<D> {
        let at = self.end(k, now);
        let Some(solid) = self.solids[k] else { return at };
        match &next[solid] {
            Some(next) => next.pose.point(&self.local_ends[k]),
            None => at + (now[solid].velocity + now[solid].spin.velocity_at(&(at - now[solid].centre))) * dt,
        }
    }

    /// World positions (m) of both ends after a step of length `dt` (s) from the solids `now`; `next` has the driven solids at
    /// its end.
    pub(crate) fn ends_after(&self, now: &[Kinematics<D>], next: &[Option<Kinematics<D>>], dt: f64) -> [Vector<D>; 2] {
        [0, 1].map(|k| self.end_after(k, now, next, dt))
    }

    /// The mean load of the last step on the solid at each end, about the centres of the solids `now` at the start of the step.
    pub(crate) fn loads(&self, now: &[Kinematics<D>]) -> [(Option<usize>, Load<D>); 2] {
        [0, 1].map(|k| match self.solids[k] {
            Some(solid) => {
                let arm = self.end(k, now) - now[solid].centre;
                (Some(solid), Load::from_force_at(&arm, self.line.state.end_forces[k]))
            }
            None => (None, Load::zero()),
        })
    }

    /// The impulse (N s) of drag and added mass on each node in the last step; `None` unless the line is active and acts on the
    /// water.
    pub(crate) fn water_impulses(&self) -> Option<&[Vector<D>]> {
        self.line.water_impulses.as_deref().filter(|_| self.line.state.acts)
    }

    /// Breaks the segment of the largest tension if that exceeds the strength; returns the tension, N.
    pub(crate) fn break_overloaded(&mut self) -> Option<f64> {
        let strength = self.spec.lifetime.strength;
        if strength.is_infinite() || self.line.state.broken.is_some() {
            return None;
        }
        let tensions = (0..self.line.segments()).map(|s| (s, self.line.tension(s)));
        let (segment, tension) = tensions.max_by(|a, b| a.1.total_cmp(&b.1))?;
        (tension > strength).then(|| {
            self.line.state.broken = Some(segment as u32);
            tension
        })
    }

    /// The longest step (s) with which the coupling to a solid of this `mobility` at end `k` is stable, where the solids are.
    pub(crate) fn step_limit(&self, k: usize, mobility: &Mobility<D>, solids: &[Kinematics<D>]) -> f64 {
        let Some(solid) = self.solids[k].filter(|_| self.line.state.acts) else { return f64::INFINITY };
        let arm = (self.end(k, solids) - solids[solid].centre).norm();
        let ease = mobility.linear.max() + arm * arm * mobility.angular.norm();
        if ease == 0.0 {
            return f64::INFINITY;
        }
        let (material, length) = (&self.line.material, self.line.state.segment);
        let swing = |length: f64| COUPLING_STEP / (material.stiffness / length * ease).sqrt();
        let radiation = RADIATION_STEP / ((material.stiffness * material.mass).sqrt() * ease);
        swing(length).max(radiation.min(swing(length * self.line.segments() as f64)))
    }

    /// Shape and tension; `beds` are what is below each node.
    pub(crate) fn reading(&self, beds: &[Option<BedPlane<D>>]) -> MooringReading<D> {
        let (line, state) = (&self.line, &self.line.state);
        if !state.acts {
            return MooringReading::default();
        }
        let anchor = state.pulls[line.segments() - 1];
        MooringReading {
            nodes: state.x.clone(),
            tensions: (0..line.segments()).map(|s| line.tension(s)).collect(),
            end_forces: [0, 1].map(|k| self.end_force(k)),
            // The sum of no numbers would be −0.
            on_bed: self.lying_nodes(beds).into_iter().map(|i| line.share(i)).fold(0.0, |sum, length| sum + length),
            anchor_angle: anchor.try_normalize(f64::MIN_POSITIVE).map_or(0.0, |q| (-q[D - 1]).clamp(-1.0, 1.0).asin()),
            broken: state.broken.map(|segment| segment as usize),
        }
    }

    /// The nodes that lie on fixed solids, in order; `beds` are what is below each node. A held end at the level of the bed lies
    /// where its neighbour lies: nothing presses it in.
    pub(crate) fn lying_nodes(&self, beds: &[Option<BedPlane<D>>]) -> Vec<usize> {
        let depth = |i: usize| beds[i].map(|bed| self.line.material.depth(&bed, &self.line.state.x[i]));
        let presses = |i: usize| depth(i).is_some_and(|depth| depth > 0.0);
        let last = beds.len() - 1;
        let level = -LEVEL * self.line.state.segment;
        let lies = |i: &usize| {
            let neighbour = if *i == 0 { 1 } else { last - 1 };
            let is_level_end = (*i == 0 || *i == last) && depth(*i).is_some_and(|depth| depth >= level);
            presses(*i) || is_level_end && presses(neighbour)
        };
        (0..beds.len()).filter(lies).collect()
    }

    /// The force (N) of the line on the solid or the ground at end `k`; at a mooring point, the pull of the last segment.
    fn end_force(&self, k: usize) -> Vector<D> {
        if self.spec.points[k].is_none() {
            return self.line.state.end_forces[k];
        }
        let segment = k * (self.line.segments() - 1);
        let sign = if k == 0 { 1.0 } else { -1.0 };
        self.line.state.pulls[segment] * sign
    }

    /// The state in a checkpoint.
    pub(crate) fn state(&self) -> &LineState<D> {
        &self.line.state
    }
}
