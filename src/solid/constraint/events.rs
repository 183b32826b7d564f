//! Beginnings and ends of constraints during a run: at their times, and under loads above their strength.

use super::{
    assembly::Assembly,
    lifetime::{ConstraintChange, ConstraintEvent, Lifetime, Phase, Phases},
    links::Constraints,
};
use crate::solid::{Engine, Kinematics};

impl<const D: usize> Phases<D> {
    /// The phases at the start of a run.
    pub(super) fn at_start(links: &Constraints<D>) -> Self {
        Self {
            joints: links.joints.iter().map(|joint| Phase::at_start(&joint.lifetime)).collect(),
            springs: links.springs.iter().map(|spring| Phase::at_start(&spring.lifetime)).collect(),
            ropes: links.ropes.iter().map(|rope| Phase::at_start(&rope.lifetime)).collect(),
            joint_frames: vec![None; links.joints.len()],
            rope_lengths: vec![None; links.ropes.len()],
            events: Vec::new(),
        }
    }

    /// Whether both belong to the same numbers of constraints.
    pub(super) fn matches(&self, other: &Self) -> bool {
        let counts = |all: &Self| {
            let phases = [all.joints.len(), all.springs.len(), all.ropes.len()];
            (phases, all.joint_frames.len(), all.rope_lengths.len())
        };
        counts(self) == counts(other)
    }

    /// Ends spring number `i`, called `name`, at time `t` (s) under `tension` (N).
    pub(super) fn break_spring(&mut self, i: usize, name: &str, t: f64, tension: f64) {
        self.springs[i] = Phase::Ended;
        self.record(t, format!("spring {name:?}"), ConstraintChange::Broken(tension));
    }

    fn record(&mut self, time: f64, element: String, change: ConstraintChange) {
        self.events.push(ConstraintEvent { time, element, change, per_metre: D == 2 });
    }
}

impl<const D: usize> Assembly<D> {
    /// Connects and releases the constraints that begin or end in the step from time `t` (s) on, with the solids at `solids`.
    pub(super) fn update_phases(&mut self, engine: &mut dyn Engine<D>, solids: &[Kinematics<D>], t: f64) {
        let phases = &mut self.state.phases;
        for (i, joint) in self.joints.iter_mut().enumerate() {
            let Some(next) = changed(&mut phases.joints[i], &joint.spec.lifetime, t) else { continue };
            if next == Phase::Acting {
                joint.frames = joint.frames_at(solids);
                phases.joint_frames[i] = Some(joint.frames);
                self.state.joints[i].1.position = 0.0;
            }
            engine.set_joint(i, (next == Phase::Acting).then_some(&joint.frames));
            phases.record(t, format!("joint {:?}", joint.spec.name), change(next));
        }
        for (i, spring) in self.springs.iter().enumerate() {
            let Some(next) = changed(&mut phases.springs[i], &spring.lifetime, t) else { continue };
            let (elastic, reading) = &mut self.state.springs[i];
            if next == Phase::Acting && !spring.has_rest_length {
                elastic.rest_length = spring.line.length_and_jacobian(&spring.line.end_kinematics(solids)).0;
            }
            reading.tension = 0.0;
            phases.record(t, format!("spring {:?}", spring.name), change(next));
        }
        for (i, rope) in self.ropes.iter().enumerate() {
            let Some(next) = changed(&mut phases.ropes[i], &rope.lifetime, t) else { continue };
            let element = format!("rope {:?}", rope.name);
            if next == Phase::Ended {
                engine.set_rope(i, None);
                phases.record(t, element, ConstraintChange::Released);
                continue;
            }
            let distance = rope.line.length_and_jacobian(&rope.line.end_kinematics(solids)).0;
            let (length, change) = match rope.max_length {
                Some(given) if given < distance => (distance, ConstraintChange::Lengthened { given, length: distance }),
                Some(given) => (given, ConstraintChange::Connected),
                None => (distance, ConstraintChange::Connected),
            };
            phases.rope_lengths[i] = Some(length);
            engine.set_rope(i, Some(length));
            phases.record(t, element, change);
        }
    }

    /// Ends the joints and ropes that bore more than their strength in the step that ends at time `t` (s).
    pub(crate) fn break_overloaded(&mut self, engine: &mut dyn Engine<D>, t: f64) {
        let phases = &mut self.state.phases;
        for (i, (joint, (_, reading))) in self.joints.iter().zip(&self.state.joints).enumerate() {
            let (limits, force, torque) =
                (&joint.spec.lifetime, reading.force.norm(), (0.5 * reading.torque.0.norm_squared()).sqrt());
            let change = match (force > limits.strength, torque > limits.torque_strength) {
                (true, _) => ConstraintChange::Broken(force),
                (false, true) => ConstraintChange::BrokenByTorque(torque),
                (false, false) => continue,
            };
            if phases.joints[i] == Phase::Acting {
                phases.joints[i] = Phase::Ended;
                engine.set_joint(i, None);
                phases.record(t, format!("joint {:?}", joint.spec.name), change);
            }
        }
        for (i, (rope, reading)) in self.ropes.iter().zip(&self.state.ropes).enumerate() {
            if reading.tension > rope.lifetime.strength && phases.ropes[i] == Phase::Acting {
                phases.ropes[i] = Phase::Ended;
                engine.set_rope(i, None);
                phases.record(t, format!("rope {:?}", rope.name), ConstraintChange::Broken(reading.tension));
            }
        }
    }

    /// Records a change of the mooring line called `name` at time `t` (s).
    pub(crate) fn record_mooring(&mut self, name: &str, t: f64, change: ConstraintChange) {
        self.state.phases.record(t, format!("mooring {name:?}"), change);
    }

    /// Records that the solid called `name` was removed at time `t` (s).
    pub(crate) fn record_removal(&mut self, name: &str, t: f64) {
        self.state.phases.record(t, format!("solid {name:?}"), ConstraintChange::Removed);
    }

    /// Time (s) from `t` (s) to the next release, beginning or end; no step extends past it.
    pub(crate) fn next_event(&self, t: f64) -> f64 {
        let holds = self.holds.iter().filter(|hold| hold.is_active(t)).map(|hold| hold.until - t);
        let lifetimes = (self.joints.iter().map(|joint| &joint.spec.lifetime))
            .chain(self.springs.iter().map(|spring| &spring.lifetime))
            .chain(self.ropes.iter().map(|rope| &rope.lifetime))
            .chain(self.forces.iter().map(|force| &force.lifetime));
        let removals = self.removals.iter().map(|removal| Lifetime::default().until(removal.at).next_limit(t));
        holds.chain(lifetimes.map(|lifetime| lifetime.next_limit(t))).chain(removals).fold(f64::INFINITY, f64::min)
    }

    /// Numbers of the solids whose removal is due at time `t` (s).
    pub(crate) fn due_removals(&self, t: f64) -> impl Iterator<Item = usize> + '_ {
        let due = move |at: f64| Lifetime::default().until(at).is_over(t);
        self.removals.iter().filter(move |removal| due(removal.at)).map(|removal| removal.solid)
    }

    /// Whether the removal of solid number `solid` is part of the set-up.
    pub(crate) fn plans_removal(&self, solid: usize) -> bool {
        self.removals.iter().any(|removal| removal.solid == solid)
    }

    /// Takes the frames of the joints from the restored state.
    pub(super) fn restore_frames(&mut self) {
        for (joint, frames) in self.joints.iter_mut().zip(&self.state.phases.joint_frames) {
            joint.frames = frames.unwrap_or_else(|| joint.spec.frames(&self.start));
        }
    }

    /// Gives the engine the lengths of ropes that were connected during the run. Call it after the engine is restored.
    pub(crate) fn restore_ropes(&self, engine: &mut dyn Engine<D>) {
        for (i, length) in self.state.phases.rope_lengths.iter().enumerate() {
            if length.is_some() && self.state.phases.ropes[i] == Phase::Acting {
                engine.set_rope(i, *length);
            }
        }
    }
}

/// Sets the phase in the step from time `t` (s) on. Returns the new phase if it differs from the old one.
fn changed(phase: &mut Phase, lifetime: &Lifetime, t: f64) -> Option<Phase> {
    let next = phase.at(lifetime, t);
    (std::mem::replace(phase, next) != next).then_some(next)
}

/// The change into the phase `next`.
fn change(next: Phase) -> ConstraintChange {
    if next == Phase::Acting { ConstraintChange::Connected } else { ConstraintChange::Released }
}

#[cfg(all(test, feature = "dim2", feature = "dim3"))]
#[path = "../../../tests/unit/solid/constraint/events.rs"]
mod tests;
