//! All constraints of a running system: the loads that they apply in a step, and their readings.

use serde::{Deserialize, Serialize};

use super::{
    jacobian::{ConstraintJacobian, Mobility},
    joint::Joint,
    lifetime::{ConstraintEvent, Lifetime, Phase, Phases},
    lines::{AttachedLine, RopeSpec, SpringInput, SpringParameters, SpringSpec, start_length},
    links::{Constraints, InitialHold, TimedRemoval},
    motor::MotorCommand,
    reactions::{Reaction, project},
};
use crate::{
    math::{Bivector, Vector},
    solid::{Engine, ForceCommand, ForceSpec, Kinematics, Load, LoadContext, WindSpec},
};

/// Δt times the highest frequency of the springs, at most: their period is right within 0.2 %.
const SPRING_STEP: f64 = 0.2;

/// Loads and coordinate of a joint in the last step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct JointReading<const D: usize> {
    /// Force of its locks and end stops on the second solid, N (N/m in 2-D), without the motor.
    pub force: Vector<D>,
    /// Their torque on it about the joint, N m (N m/m in 2-D).
    pub torque: Bivector<D>,
    /// Its coordinate relative to the start, m or rad (continuous past a turn); 0 if the joint has no coordinate.
    pub position: f64,
    /// Its rate, m/s or rad/s.
    pub rate: f64,
    /// Force of its motor, N or N m.
    pub motor_force: f64,
    /// Energy that its motor has taken from the solids since the start, J (J/m in 2-D).
    pub absorbed_energy: f64,
}

impl<const D: usize> JointReading<D> {
    /// Power that its motor takes from the solids now, −F ẋ, W (W/m in 2-D).
    pub fn absorbed_power(&self) -> f64 {
        -self.motor_force * self.rate
    }
}

/// Tension and length of a spring or a rope.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LineReading {
    /// Its length, m.
    pub length: f64,
    /// Its tension, N (N/m in 2-D); negative where it pushes. That of a spring belongs to its length; that of a rope is the mean
    /// over the last step, 0 before the first step.
    pub tension: f64,
}

/// Loads of the constraints on a solid in the last step, by kind.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ConstraintLoads<const D: usize> {
    pub(crate) joints: Load<D>,
    pub(crate) ropes: Load<D>,
    pub(crate) springs: Load<D>,
    pub(crate) motors: Load<D>,
    pub(crate) forces: Load<D>,
    /// Whether it was held at rest.
    pub(crate) is_held: bool,
}

impl<const D: usize> ConstraintLoads<D> {
    /// Nothing.
    pub(crate) fn zero() -> Self {
        let none = Load::zero();
        Self { joints: none, ropes: none, springs: none, motors: none, forces: none, is_held: false }
    }
}

/// Its state in a checkpoint.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct AssemblyState<const D: usize> {
    pub(super) joints: Vec<(Option<MotorCommand>, JointReading<D>)>,
    pub(super) springs: Vec<(SpringParameters, LineReading)>,
    pub(super) ropes: Vec<LineReading>,
    /// What a program has set of each force.
    pub(super) forces: Vec<Option<ForceCommand>>,
    pub(super) phases: Phases<D>,
}

pub(super) struct Spring<const D: usize> {
    pub(super) name: String,
    pub(super) line: AttachedLine<D>,
    tension_only: bool,
    /// Whether the specification gives its length without tension.
    pub(super) has_rest_length: bool,
    pub(super) lifetime: Lifetime,
}

pub(super) struct Rope<const D: usize> {
    pub(super) name: String,
    pub(super) line: AttachedLine<D>,
    pub(super) max_length: Option<f64>,
    pub(super) lifetime: Lifetime,
}

/// All ties at work.
pub(crate) struct Assembly<const D: usize> {
    pub(super) start: Vec<Kinematics<D>>,
    pub(super) joints: Vec<Joint<D>>,
    pub(super) springs: Vec<Spring<D>>,
    pub(super) ropes: Vec<Rope<D>>,
    pub(super) forces: Vec<ForceSpec<D>>,
    winds: Vec<WindSpec<D>>,
    pub(super) holds: Vec<InitialHold>,
    pub(super) removals: Vec<TimedRemoval>,
    /// Rows of each joint's locks and of its coordinate in the present step.
    rows: Vec<Vec<ConstraintJacobian<D>>>,
    /// Loads on each solid in the last step.
    tied: Vec<ConstraintLoads<D>>,
    pub(super) state: AssemblyState<D>,
}

impl<const D: usize> Assembly<D> {
    /// The constraints of solids that start as `start`.
    pub(crate) fn new(links: &Constraints<D>, start: Vec<Kinematics<D>>) -> Self {
        let none = JointReading {
            force: Vector::zeros(),
            torque: Bivector::zero(),
            position: 0.0,
            rate: 0.0,
            motor_force: 0.0,
            absorbed_energy: 0.0,
        };
        let spring = |(s, spring): (&SpringSpec<D>, &Spring<D>)| {
            let length = start_length(&s.ends);
            let elastic = SpringParameters {
                stiffness: s.stiffness,
                damping: s.damping,
                rest_length: s.rest_length.unwrap_or(length),
            };
            let ends = spring.line.end_kinematics(&start);
            let rate = spring.line.length_and_jacobian(&ends).1.map_or(0.0, |row| row.rate(&ends));
            let acts = s.lifetime.contains(0.0);
            let tension = if acts { elastic.tension_at([length, rate], s.tension_only) } else { 0.0 };
            (elastic, LineReading { length, tension })
        };
        let rope = |r: &RopeSpec<D>| LineReading { length: start_length(&r.ends), tension: 0.0 };
        let attached_spring = |s: &SpringSpec<D>| Spring {
            name: s.name.clone(),
            line: AttachedLine::new(&s.ends, &start),
            tension_only: s.tension_only,
            has_rest_length: s.rest_length.is_some(),
            lifetime: s.lifetime,
        };
        let attached_rope = |r: &RopeSpec<D>| Rope {
            name: r.name.clone(),
            line: AttachedLine::new(&r.ends, &start),
            max_length: r.max_length,
            lifetime: r.lifetime,
        };
        let joints: Vec<Joint<D>> = links.joints.iter().map(|joint| Joint::new(joint.clone(), &start)).collect();
        let start_reading = |joint: &Joint<D>| {
            let ends = joint.end_kinematics(&start);
            let rate = joint.coordinate_jacobian(&ends).map_or(0.0, |row| row.rate(&ends));
            JointReading { position: joint.spec.coordinate_at_start(&start), rate, ..none }
        };
        let springs: Vec<Spring<D>> = links.springs.iter().map(attached_spring).collect();
        Self {
            ropes: links.ropes.iter().map(attached_rope).collect(),
            forces: links.forces.clone(),
            winds: links.winds.clone(),
            holds: links.holds.clone(),
            removals: links.removals.clone(),
            rows: Vec::new(),
            tied: vec![ConstraintLoads::zero(); start.len()],
            state: AssemblyState {
                joints: joints.iter().map(|joint| (None, start_reading(joint))).collect(),
                springs: links.springs.iter().zip(&springs).map(spring).collect(),
                ropes: links.ropes.iter().map(rope).collect(),
                forces: vec![None; links.forces.len()],
                phases: Phases::at_start(links),
            },
            joints,
            springs,
            start,
        }
    }

    /// Adds a solid that starts as `start`.
    pub(crate) fn add_body(&mut self, start: Kinematics<D>) {
        self.start.push(start);
        self.tied.push(ConstraintLoads::zero());
    }

    /// Whether there is no constraint.
    pub(crate) fn is_empty(&self) -> bool {
        self.joints.is_empty()
            && self.springs.is_empty()
            && self.ropes.is_empty()
            && self.forces.is_empty()
            && self.winds.is_empty()
            && self.holds.is_empty()
    }

    /// Applies motors, springs and forces to the engine's solids in the step of length `dt` (s) from time `t` (s) on. `solids`
    /// are their kinematics at the start of the step, and `around` describes the water.
    pub(crate) fn apply_loads(
        &mut self,
        engine: &mut dyn Engine<D>,
        solids: &[Kinematics<D>],
        around: &LoadContext<D>,
        [t, dt]: [f64; 2],
    ) {
        self.tied.fill(ConstraintLoads::zero());
        self.update_phases(engine, solids, t);
        for hold in &self.holds {
            self.tied[hold.solid].is_held = hold.is_active(t);
            engine.set_held(hold.solid, hold.is_active(t));
        }
        let forces = self.forces.iter().zip(&self.state.forces).map(|(force, set)| {
            (force.solid, force.load_at(&self.start[force.solid], &solids[force.solid], set.as_ref(), t + 0.5 * dt))
        });
        let winds = self.winds.iter().flat_map(|wind| wind.loads_at(solids, t + 0.5 * dt));
        let forces: Vec<(usize, Load<D>)> = forces.chain(winds).collect();
        let (mut known, mut reactions) = (Vec::new(), Vec::new());
        let has_motor = |(joint, (set, _)): (&Joint<D>, &(Option<MotorCommand>, _))| joint.has_motor(set.as_ref());
        if !self.springs.is_empty() || self.joints.iter().zip(&self.state.joints).any(has_motor) {
            known.clone_from(&around.loads);
            forces.iter().for_each(|(solid, load)| known[*solid] += *load);
            reactions = self.last_reactions(engine, solids);
        }
        let phases = &mut self.state.phases;
        for (i, (spring, (elastic, reading))) in self.springs.iter().zip(&mut self.state.springs).enumerate() {
            if phases.springs[i] != Phase::Acting {
                continue;
            }
            let (ends, mobility) = (spring.line.end_kinematics(solids), spring.line.mobility(engine));
            let (length, row) = spring.line.length_and_jacobian(&ends);
            if let Some(row) = row {
                let ease = row.inverse_effective_mass(&row, &mobility);
                let wet = spring.line.solids().into_iter().flatten().any(|i| around.wet[i]);
                let elastic = if wet { elastic.damped_in_water(around.sound_crossing_time, ease) } else { *elastic };
                let between = spring.line.solids();
                let acceleration = |load: &dyn Fn(usize) -> Load<D>| {
                    row.acceleration(&between.map(|end| end.map_or_else(Load::zero, load)), &mobility)
                };
                let input = SpringInput {
                    length,
                    rate: row.rate(&ends),
                    known_acceleration: acceleration(&|i| known[i] + engine.applied_push(i)),
                    reaction: (t > 0.0).then(|| acceleration(&|i| reactions[i])),
                    g: ease,
                    dt,
                };
                reading.tension = elastic.tension(&input, spring.tension_only);
                if reading.tension > spring.lifetime.strength {
                    phases.break_spring(i, &spring.name, t, reading.tension);
                    reading.tension = 0.0;
                    continue;
                }
                give(engine, spring.line.solids(), &row.loads(-reading.tension));
                note(&mut self.tied, spring.line.solids(), &row.loads(-reading.tension), |tied| &mut tied.springs);
            }
        }
        for (solid, load) in forces {
            engine.add_load(solid, &load);
            self.tied[solid].forces += load;
        }
        // Last, so that they include the loads of the others.
        self.rows.clear();
        for (i, (joint, (set, reading))) in self.joints.iter().zip(&mut self.state.joints).enumerate() {
            if phases.joints[i] != Phase::Acting {
                reading.motor_force = 0.0;
                self.rows.push(Vec::new());
                continue;
            }
            let (ends, mobility) = (joint.end_kinematics(solids), joint.mobility(engine));
            let ((rows, _), free) = (joint.jacobians(&ends, &mobility), joint.coordinate_jacobian(&ends));
            let drive = joint.motor_command(*set, t + 0.5 * dt);
            // A joint that is given back to no motor has no force of one.
            reading.motor_force = 0.0;
            if let (Some(drive), Some(free), Some(own)) = (drive, free, rows.last()) {
                let acceleration = |load: &dyn Fn(usize) -> Load<D>| {
                    own.acceleration(&joint.spec.between.map(|end| end.map_or_else(Load::zero, load)), &mobility)
                };
                let known = acceleration(&|i| around.loads[i] + engine.applied_push(i));
                let reaction = acceleration(&|i| reactions[i]);
                let going = [free.rate(&ends), known, reaction, own.inverse_effective_mass(own, &mobility)];
                let position = joint.position_after(reading.position, &ends);
                reading.motor_force = Joint::<D>::motor_force(&drive, position, going, dt);
                give(engine, joint.spec.between, &free.loads(reading.motor_force));
                note(&mut self.tied, joint.spec.between, &free.loads(reading.motor_force), |tied| &mut tied.motors);
            }
            self.rows.push(rows);
        }
    }

    /// The loads of joints, ropes and contacts on each solid in the last step, at the present positions `solids`.
    fn last_reactions(&self, engine: &dyn Engine<D>, solids: &[Kinematics<D>]) -> Vec<Load<D>> {
        let mut sum = vec![Load::zero(); solids.len()];
        let mut add = |ends: [Option<usize>; 2], loads: [Load<D>; 2]| {
            for (end, load) in ends.into_iter().zip(loads) {
                end.into_iter().for_each(|solid| sum[solid] += load);
            }
        };
        let phases = &self.state.phases;
        let joints = self.joints.iter().zip(&self.state.joints).zip(&phases.joints);
        for ((joint, (_, reading)), _) in joints.filter(|(_, phase)| **phase == Phase::Acting) {
            let ends = joint.end_kinematics(solids);
            let at = joint.position_on_second(&ends);
            let load = |k: usize, sign: f64| {
                let own = Load::from_force_at(&(at - ends[k].centre), reading.force * sign);
                Load { torque: own.torque + reading.torque * sign, ..own }
            };
            add(joint.spec.between, [load(0, -1.0), load(1, 1.0)]);
        }
        let ropes = self.ropes.iter().zip(&self.state.ropes).zip(&phases.ropes);
        for ((rope, reading), _) in ropes.filter(|(_, phase)| **phase == Phase::Acting) {
            let row = rope.line.length_and_jacobian(&rope.line.end_kinematics(solids)).1;
            row.iter().for_each(|row| add(rope.line.solids(), row.loads(-reading.tension)));
        }
        for contact in engine.contacts() {
            add(contact.between.map(Some), contact.loads);
        }
        sum
    }

    /// Updates the readings of all constraints after the step of length `dt` (s) from `before` to `after`. If the engine reports
    /// only part of its impulses, `told` has the rate of change of momentum of each solid that no other load explains (N, N m).
    pub(crate) fn update_reactions(
        &mut self,
        engine: &dyn Engine<D>,
        [before, after]: [&[Kinematics<D>]; 2],
        dt: f64,
        told: Option<&[Load<D>]>,
    ) {
        let pulls = self.pulls(engine, before, dt, told);
        for (i, (joint, (_, reading))) in self.joints.iter().zip(&mut self.state.joints).enumerate() {
            let (was, is) = (joint.end_kinematics(before), joint.end_kinematics(after));
            let held: Load<D> = pulls[i].iter().map(|pull| pull.loads()[1]).sum();
            let arm = joint.position_on_second(&was) - was[1].centre;
            (reading.force, reading.torque) = (held.force, held.torque + Bivector::torque(&arm, &held.force) * -1.0);
            reading.position = joint.position_after(reading.position, &is);
            let rate = |ends: &[Kinematics<D>; 2]| joint.coordinate_jacobian(ends).map_or(0.0, |row| row.rate(ends));
            reading.absorbed_energy -= reading.motor_force * 0.5 * (rate(&was) + rate(&is)) * dt;
            reading.rate = rate(&is);
        }
        let springs = self.springs.iter().zip(&mut self.state.springs).zip(&self.state.phases.springs);
        for ((spring, (elastic, reading)), phase) in springs {
            let [was, is] =
                [before, after].map(|solids| spring.line.length_and_jacobian(&spring.line.end_kinematics(solids)).0);
            if *phase == Phase::Acting {
                reading.tension = elastic.tension_after(reading.tension, [was, is], spring.tension_only);
            }
            reading.length = is;
        }
        let (of_joints, of_ropes) = pulls.split_at(self.joints.len());
        for ((rope, reading), pull) in self.ropes.iter().zip(&mut self.state.ropes).zip(of_ropes) {
            let length = rope.line.length_and_jacobian(&rope.line.end_kinematics(after)).0;
            *reading = LineReading { length, tension: pull.first().map_or(0.0, |pull| -pull.force) };
        }
        for pull in of_joints.iter().flatten() {
            note(&mut self.tied, pull.between, &pull.loads(), |tied| &mut tied.joints);
        }
        for pull in of_ropes.iter().flatten() {
            note(&mut self.tied, pull.between, &pull.loads(), |tied| &mut tied.ropes);
        }
    }

    /// The reactions of each joint and then of each rope in a step `dt` (s) long.
    fn pulls(
        &self,
        engine: &dyn Engine<D>,
        before: &[Kinematics<D>],
        dt: f64,
        told: Option<&[Load<D>]>,
    ) -> Vec<Vec<Reaction<D>>> {
        let of_joint = |(i, joint): (usize, &Joint<D>)| {
            let (between, mobility) = (joint.spec.between, joint.mobility(engine));
            let rows = self.rows[i].iter().zip(engine.joint_impulses(i));
            rows.map(|(row, impulse)| Reaction { between, jacobian: *row, mobility, force: impulse / dt }).collect()
        };
        let of_rope = |(i, rope): (usize, &Rope<D>)| {
            if self.state.phases.ropes[i] != Phase::Acting {
                return Vec::new();
            }
            let rope = &rope.line;
            let (between, mobility) = (rope.solids(), rope.mobility(engine));
            let force = -engine.rope_impulse(i) / dt;
            let pull = |row| Reaction { between, jacobian: row, mobility, force };
            rope.length_and_jacobian(&rope.end_kinematics(before)).1.map(pull).into_iter().collect()
        };
        let joints = self.joints.iter().enumerate().map(of_joint);
        let ropes = self.ropes.iter().enumerate().map(of_rope);
        let mut pulls: Vec<Vec<Reaction<D>>> = joints.chain(ropes).collect();
        if let Some(told) = told {
            let sizes: Vec<usize> = pulls.iter().map(Vec::len).collect();
            let mut all: Vec<Reaction<D>> = pulls.into_iter().flatten().collect();
            project(&mut all, told);
            let mut all = all.into_iter();
            pulls = sizes.into_iter().map(|size| all.by_ref().take(size).collect()).collect();
        }
        pulls
    }

    /// The longest step (s) that the springs and the stiffness of the motors allow where the solids are at time `t` (s).
    ///
    /// ω² is at most the largest sum Σ k A (A + B) of any solid, over the springs of this solid (Gershgorin's bound). k is the
    /// stiffness of a spring, A² the inverse effective mass (1/kg) of its end on the solid, and B² that of its other end.
    pub(crate) fn step_limit(&self, engine: &dyn Engine<D>, solids: &[Kinematics<D>], t: f64) -> f64 {
        let mut squares = vec![0.0; solids.len()];
        let mut stiffen =
            |ends: [Option<usize>; 2], row: &ConstraintJacobian<D>, mobility: &[Mobility<D>; 2], stiffness: f64| {
                let own = row.inverse_effective_mass_of_ends(mobility).map(f64::sqrt);
                for (solid, ease) in ends.iter().zip(own) {
                    if let Some(solid) = solid {
                        squares[*solid] += stiffness * ease * (own[0] + own[1]);
                    }
                }
            };
        let phases = &self.state.phases;
        for (i, (joint, (set, _))) in self.joints.iter().zip(&self.state.joints).enumerate() {
            if phases.joints[i].at(&joint.spec.lifetime, t) != Phase::Acting {
                continue;
            }
            let Some(drive) = joint.motor_command(*set, t).filter(|drive| drive.stiffness > 0.0) else { continue };
            let (ends, mobility) = (joint.end_kinematics(solids), joint.mobility(engine));
            if let (rows, locks) = joint.jacobians(&ends, &mobility)
                && let Some(row) = rows.get(locks)
            {
                stiffen(joint.spec.between, row, &mobility, drive.stiffness);
            }
        }
        for (i, (spring, (elastic, _))) in self.springs.iter().zip(&self.state.springs).enumerate() {
            if phases.springs[i].at(&spring.lifetime, t) != Phase::Acting {
                continue;
            }
            let (ends, mobility) = (spring.line.end_kinematics(solids), spring.line.mobility(engine));
            if let Some(row) = spring.line.length_and_jacobian(&ends).1 {
                stiffen(spring.line.solids(), &row, &mobility, elastic.stiffness);
            }
        }
        SPRING_STEP / squares.into_iter().fold(0.0, f64::max).sqrt()
    }

    /// Whether there is a joint or a rope.
    pub(crate) fn has_reactions(&self) -> bool {
        !(self.joints.is_empty() && self.ropes.is_empty())
    }

    /// Loads of the constraints on solid number `i` in the last step.
    pub(crate) fn loads_on(&self, i: usize) -> ConstraintLoads<D> {
        self.tied[i]
    }

    /// Reading of joint number `i` in the last step.
    pub(crate) fn joint_reading(&self, i: usize) -> JointReading<D> {
        self.state.joints[i].1
    }

    /// Whether joint number `i` acted in the last step.
    pub(crate) fn joint_acts(&self, i: usize) -> bool {
        self.state.phases.joints[i] == Phase::Acting
    }

    /// The coordinates of the free modes of generic joint number `i`, m or rad (−π to π), with the solids at `solids`.
    pub(crate) fn joint_coordinates(&self, i: usize, solids: &[Kinematics<D>]) -> Vec<f64> {
        let joint = &self.joints[i];
        let ends = joint.end_kinematics(solids);
        joint.spec.free_modes.iter().map(|free| joint.coordinate(free.mode, &ends)).collect()
    }

    /// Distance (m) and angle (rad) by which joint number `i` is violated; 0 where it does not act.
    pub(crate) fn joint_gap(&self, i: usize, solids: &[Kinematics<D>]) -> [f64; 2] {
        if !self.joint_acts(i) {
            return [0.0; 2];
        }
        self.joints[i].gap(&self.joints[i].end_kinematics(solids))
    }

    /// Present reading of spring number `i`.
    pub(crate) fn spring_reading(&self, i: usize) -> LineReading {
        self.state.springs[i].1
    }

    /// Whether rope number `i` acted in the last step.
    pub(crate) fn rope_acts(&self, i: usize) -> bool {
        self.state.phases.ropes[i] == Phase::Acting
    }

    /// Reading of rope number `i` in the last step.
    pub(crate) fn rope_reading(&self, i: usize) -> LineReading {
        self.state.ropes[i]
    }

    /// Parameters of spring number `i`, to be changed.
    pub(crate) fn spring_parameters(&mut self, i: usize) -> &mut SpringParameters {
        &mut self.state.springs[i].0
    }

    /// Sets the motor command of joint number `i` from now on; `None` restores its own motor.
    pub(crate) fn set_motor(&mut self, i: usize, drive: Option<MotorCommand>) {
        self.state.joints[i].0 = drive;
    }

    /// The motor command of joint number `i` at time `t` (s), if it has one.
    pub(crate) fn motor_command(&self, i: usize, t: f64) -> Option<MotorCommand> {
        self.joints[i].motor_command(self.state.joints[i].0, t)
    }

    /// Sets the components of force number `i` from now on; `None` restores its own.
    pub(crate) fn set_force(&mut self, i: usize, command: Option<ForceCommand>) {
        self.state.forces[i] = command;
    }

    /// The components of force number `i` at time `t` (s).
    pub(crate) fn force_command(&self, i: usize, t: f64) -> ForceCommand {
        self.state.forces[i].clone().unwrap_or_else(|| self.forces[i].command_at(t))
    }

    /// Beginnings and ends of constraints and solids so far.
    pub(crate) fn events(&self) -> &[ConstraintEvent] {
        &self.state.phases.events
    }

    /// The state in a checkpoint.
    pub(crate) fn save(&self) -> AssemblyState<D> {
        self.state.clone()
    }

    /// Whether a saved state belongs to these constraints.
    pub(crate) fn matches(&self, kept: &AssemblyState<D>) -> bool {
        kept.joints.len() == self.joints.len()
            && kept.springs.len() == self.springs.len()
            && kept.ropes.len() == self.ropes.len()
            && kept.forces.len() == self.forces.len()
            && kept.phases.matches(&self.state.phases)
    }

    /// Restores a saved state that [`Assembly::matches`] has accepted.
    pub(crate) fn restore(&mut self, kept: AssemblyState<D>) {
        self.state = kept;
        self.restore_frames();
    }
}

/// Applies a load to the solid at each end; without effect on solids that are not free.
fn give<const D: usize>(engine: &mut dyn Engine<D>, ends: [Option<usize>; 2], loads: &[Load<D>; 2]) {
    for (end, load) in ends.iter().zip(loads) {
        if let Some(solid) = end {
            engine.add_load(*solid, load);
        }
    }
}

/// Records a load for the solid at each end.
fn note<const D: usize>(
    tied: &mut [ConstraintLoads<D>],
    ends: [Option<usize>; 2],
    loads: &[Load<D>; 2],
    kind: impl Fn(&mut ConstraintLoads<D>) -> &mut Load<D>,
) {
    for (end, load) in ends.iter().zip(loads) {
        if let Some(solid) = end {
            *kind(&mut tied[*solid]) += *load;
        }
    }
}

#[cfg(all(test, feature = "dim2", feature = "dim3"))]
#[path = "../../../tests/unit/solid/constraint/assembly.rs"]
pub(in crate::solid) mod tests;
