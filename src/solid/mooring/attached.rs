//! A mooring line on the solids of a running system.
//!
//! During a step the ends on driven solids move to where the solids will be, those on free solids on at the velocity that they
//! have. The mean force of the step acts on the free solid in that step, so that the impulses are exact. The two sides differ by
//! the acceleration of the solid over one step, which the next step makes up for.

use super::{
    forces::NodeSurroundings,
    line::{LineState, MooringLine},
    specification::MooringSpec,
};
use crate::{
    math::Vector,
    solid::{Kinematics, Load, Mobility},
};

/// Δt times the frequency of a body on the first segment, at most: the coupling is stable up to 0.8.
const COUPLING_STEP: f64 = 0.5;

/// Δt times the rate at which waves on a line slow a body, at most.
const RADIATION_STEP: f64 = 0.25;

/// Shape and tension of a mooring line.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct MooringReading<const D: usize> {
    /// World positions of its nodes, m.
    pub nodes: Vec<Vector<D>>,
    /// Tension of each segment, N (N/m in 2-D).
    pub tensions: Vec<f64>,
    /// Force on what holds each end, the mean over the last step, N (N/m in 2-D).
    pub end_forces: [Vector<D>; 2],
    /// Length of line that lies on fixed solids, m.
    pub on_bed: f64,
    /// Angle of the second end above the horizontal, rad.
    pub anchor_angle: f64,
}

/// A mooring line on the solids of a running system.
pub(crate) struct Mooring<const D: usize> {
    pub(crate) name: String,
    solids: [Option<usize>; 2],
    /// Its ends in the frames of their solids, m.
    local_ends: [Vector<D>; 2],
    strength: f64,
    pub(crate) line: MooringLine<D>,
}

impl<const D: usize> Mooring<D> {
    /// The line between the places where its ends start, straight, in water of the density `water_density` (kg/m³).
    pub(crate) fn new(spec: &MooringSpec<D>, start: &[Kinematics<D>], water_density: f64) -> Self {
        let segment = spec.length / spec.segments as f64;
        let material = spec.line.material(segment, water_density);
        let mut line = MooringLine::straight(material, spec.length, spec.segments, spec.ends.map(|end| end.at));
        line.bodies = spec.node_bodies();
        let local = |k: usize| {
            let (end, at) = (spec.ends[k].solid, spec.ends[k].at);
            end.map_or(at, |solid| start[solid].pose.local(&at))
        };
        let local_ends = [local(0), local(1)];
        Self {
            name: spec.name.clone(),
            solids: spec.ends.map(|end| end.solid),
            local_ends,
            strength: spec.strength,
            line,
        }
    }

    /// The solids at its ends.
    pub(crate) fn solids(&self) -> [Option<usize>; 2] {
        self.solids
    }

    /// World position of end `k` where the solids are, m.
    fn end(&self, k: usize, solids: &[Kinematics<D>]) -> Vector<D> {
        self.solids[k].map_or(self.local_ends[k], |solid| solids[solid].pose.point(&self.local_ends[k]))
    }

    /// World position (m) to which end `k` goes in a step `dt` (s) long from `now` on; `next` is the end of the step of driven solids.
    fn end_after(&self, k: usize, now: &[Kinematics<D>], next: &[Option<Kinematics<D>>], dt: f64) -> Vector<D> {
        let at = self.end(k, now);
        let Some(solid) = self.solids[k] else { return at };
        match &next[solid] {
            Some(next) => next.pose.point(&self.local_ends[k]),
            None => at + (now[solid].velocity + now[solid].spin.velocity_at(&(at - now[solid].centre))) * dt,
        }
    }

    /// Advances the line by `dt` (s) from the solids `now` on; `next` is where driven solids go. Returns the load on the solid at each
    /// end, and the tension (N) of a segment that breaks.
    pub(crate) fn advance(
        &mut self,
        now: &[Kinematics<D>],
        next: &[Option<Kinematics<D>>],
        dt: f64,
        around: &[NodeSurroundings<D>],
        gravity: &Vector<D>,
    ) -> ([(Option<usize>, Load<D>); 2], Option<f64>) {
        let ends = [0, 1].map(|k| self.end_after(k, now, next, dt));
        let forces = self.line.advance(ends, dt, around, gravity);
        let load = |k: usize| match self.solids[k] {
            Some(solid) => {
                let arm = self.end(k, now) - now[solid].centre;
                (Some(solid), Load::from_force_at(&arm, forces[k]))
            }
            None => (None, Load::zero()),
        };
        let loads = [load(0), load(1)];
        (loads, self.break_overloaded())
    }

    /// Breaks the segment of the largest tension if that exceeds the strength; returns the tension, N.
    fn break_overloaded(&mut self) -> Option<f64> {
        if self.strength.is_infinite() || self.line.state.broken.is_some() {
            return None;
        }
        let tensions = (0..self.line.segments()).map(|s| (s, self.line.tension(s)));
        let (segment, tension) = tensions.max_by(|a, b| a.1.total_cmp(&b.1))?;
        (tension > self.strength).then(|| {
            self.line.state.broken = Some(segment as u32);
            tension
        })
    }

    /// The longest step (s) with which the coupling to a solid of this `mobility` at end `k` is stable, where the solids are.
    pub(crate) fn step_limit(&self, k: usize, mobility: &Mobility<D>, solids: &[Kinematics<D>]) -> f64 {
        let Some(solid) = self.solids[k] else { return f64::INFINITY };
        let arm = (self.end(k, solids) - solids[solid].centre).norm();
        let ease = mobility.linear.max() + arm * arm * mobility.angular.norm();
        if ease == 0.0 {
            return f64::INFINITY;
        }
        let (material, length) = (&self.line.material, self.line.segment);
        let swing = |length: f64| COUPLING_STEP / (material.stiffness / length * ease).sqrt();
        let radiation = RADIATION_STEP / ((material.stiffness * material.mass).sqrt() * ease);
        swing(length).max(radiation.min(swing(length * self.line.segments() as f64)))
    }

    /// Shape and tension, where `around` is what is around each node.
    pub(crate) fn reading(&self, around: &[NodeSurroundings<D>]) -> MooringReading<D> {
        let (line, state) = (&self.line, &self.line.state);
        let lies = |i: &usize| around[*i].bed.is_some_and(|bed| line.material.depth(&bed, &state.x[*i]) > 0.0);
        let (q, _) = line.direction_and_length(line.segments() - 1);
        MooringReading {
            nodes: state.x.clone(),
            tensions: (0..line.segments()).map(|s| line.tension(s)).collect(),
            end_forces: state.end_forces,
            on_bed: (0..around.len()).filter(lies).map(|i| line.share(i)).sum(),
            anchor_angle: (-q[D - 1]).clamp(-1.0, 1.0).asin(),
        }
    }

    /// The state in a checkpoint.
    pub(crate) fn state(&self) -> &LineState<D> {
        &self.line.state
    }
}
