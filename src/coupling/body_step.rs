//! The motion of the solids over a step. Driven solids follow their prescribed motion; the engine or an external
//! program moves the free solids. The boundary particles follow their solids.

use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use super::{
    Accounting, AcousticAddedMass, AddedMassState, Interval, Moorings,
    load_breakdown::{BodyLoads, LoadBreakdown, contact_sums},
    place,
};
use crate::{
    error::{Error, ErrorCode, ErrorKind, Fault, Result},
    math::{Bivector, Bounds, Pose, Vector},
    solid::{
        ContactForce, Engine, EngineFault, Kinematics, Load, Role, Solid,
        constraint::assembly::{Assembly, AssemblyState, ConstraintLoads},
        mooring::LineState,
    },
    system::{MomentumTransfer, System, bounds_beside, face_reached, known_water, return_impulse, spread_impulses},
};

/// The rigid bodies of a run with their engine. A scene without free bodies has no engine.
pub(crate) struct Bodies<const D: usize> {
    pub(super) engine: Option<Box<dyn Engine<D>>>,
    pub(super) added_masses: Vec<AcousticAddedMass<D>>,
    constraints: Assembly<D>,
    pub(crate) moorings: Moorings<D>,
    pub(crate) accounting: Option<Accounting<D>>,
    /// Whether an external program moves the free bodies.
    external: bool,
    pub(super) steps: u64,
    spent: Duration,
}

/// The state of [`Bodies`] in a checkpoint.
#[derive(Serialize, Deserialize)]
pub(crate) struct BodiesState<const D: usize> {
    engine: Option<Vec<u8>>,
    added_masses: Vec<AddedMassState>,
    constraints: AssemblyState<D>,
    moorings: Vec<LineState<D>>,
}

impl<const D: usize> Bodies<D> {
    /// Creates the bodies at the start of a run, with their constraints, mooring lines and the added masses of the light
    /// bodies. `engine` moves the bodies, or an external program if `external`.
    pub(crate) fn new(
        engine: Option<Box<dyn Engine<D>>>,
        added_masses: Vec<AcousticAddedMass<D>>,
        constraints: Assembly<D>,
        moorings: Moorings<D>,
        external: bool,
    ) -> Self {
        let (steps, spent) = (0, Duration::ZERO);
        Self { engine, added_masses, constraints, moorings, accounting: None, external, steps, spent }
    }

    /// Whether the bodies read or change the water itself, besides its loads.
    #[cfg(feature = "gpu")]
    pub(crate) fn read_water(&self) -> bool {
        !self.added_masses.is_empty() || !self.moorings.is_empty()
    }

    /// Whether an external program or the accounting may read all water.
    pub(crate) fn read_all_water(&self) -> bool {
        self.external || self.accounting.as_ref().is_some_and(Accounting::reads_water)
    }

    /// The boxes (m) in which light bodies and mooring lines read the water at the end of a step, before they move.
    pub(crate) fn water_ranges(&self, system: &System<D>, over: Interval) -> Vec<Bounds<D>> {
        let of_body = |added_mass: &AcousticAddedMass<D>| {
            let way = system.solids[added_mass.solid].kinematics.velocity.norm() * over.dt;
            bounds_beside(system, added_mass.solid, system.model().support_radius() + way)
        };
        let lines = self.moorings.water_ranges(system, over.t);
        self.added_masses.iter().map(of_body).chain(lines).collect()
    }

    /// Whether an external program moves the free bodies.
    pub(crate) fn has_external_bodies(&self) -> bool {
        self.external
    }

    /// Returns the added masses of the light bodies.
    #[cfg(feature = "gpu")]
    pub(crate) fn added_masses(&self) -> &[AcousticAddedMass<D>] {
        &self.added_masses
    }

    /// Returns the constraints.
    pub(crate) fn constraints(&self) -> &Assembly<D> {
        &self.constraints
    }

    /// Returns the constraints for changes.
    pub(crate) fn constraints_mut(&mut self) -> &mut Assembly<D> {
        &mut self.constraints
    }

    /// Returns the longest step (s) that springs, mooring lines and motors allow at time `t` (s).
    pub(crate) fn step_limit(&self, system: &System<D>, t: f64) -> f64 {
        let tied = !(self.constraints.is_empty() && self.moorings.is_empty());
        let Some(engine) = self.engine.as_deref().filter(|_| tied) else { return f64::INFINITY };
        let now = self.kinematics(system, t, true);
        let moorings = self.moorings.step_limit(&|solid| engine.mobility(solid), &now);
        self.constraints.step_limit(engine, &now, t).min(moorings)
    }

    /// Returns the kinematics of each solid at the engine's time `t` (s) if `wanted`, or else an empty list.
    fn kinematics(&self, system: &System<D>, t: f64, wanted: bool) -> Vec<Kinematics<D>> {
        if !wanted {
            return Vec::new();
        }
        let one = |(i, solid): (usize, &Solid<D>)| match (&solid.spec.role, &self.engine) {
            (Role::Driven(motion), _) => solid.prescribed_kinematics(motion, t),
            (Role::Free(_), Some(engine)) => engine.kinematics(i),
            _ => solid.kinematics,
        };
        system.solids.iter().enumerate().map(one).collect()
    }

    /// Whether the saved state belongs to these bodies without the solids `gone`.
    ///
    /// # Errors
    /// `Restart` if the state of the engine is damaged or belongs to other solids.
    pub(crate) fn matches(&self, state: &BodiesState<D>, gone: &[usize]) -> Result<bool> {
        let engines = match (&self.engine, &state.engine) {
            (Some(engine), Some(bytes)) => engine.check(bytes).map(|()| true)?,
            (engine, bytes) => engine.is_none() && bytes.is_none(),
        };
        let added_masses = self.added_masses.iter().filter(|own| !gone.contains(&own.solid)).count();
        Ok(engines
            && added_masses == state.added_masses.len()
            && self.constraints.matches(&state.constraints)
            && self.moorings.matches(&state.moorings))
    }

    /// Returns the state for a checkpoint.
    ///
    /// # Errors
    /// `Restart` if the state of the engine cannot be written.
    pub(crate) fn save(&self) -> Result<BodiesState<D>> {
        Ok(BodiesState {
            engine: self.engine.as_ref().map(|engine| engine.save()).transpose()?,
            added_masses: self.added_masses.iter().map(AcousticAddedMass::state).collect(),
            constraints: self.constraints.save(),
            moorings: self.moorings.states(),
        })
    }

    /// Restores a saved state, taken after `steps` steps, that [`Bodies::matches`] has accepted.
    ///
    /// # Errors
    /// `Restart` if the state of the engine is damaged.
    pub(crate) fn restore(&mut self, state: BodiesState<D>, steps: u64) -> Result<()> {
        if let (Some(engine), Some(bytes)) = (&mut self.engine, &state.engine) {
            engine.restore(bytes)?;
        }
        self.added_masses.iter_mut().zip(state.added_masses).for_each(|(own, state)| own.restore(state));
        self.steps = steps;
        self.constraints.restore(state.constraints);
        if let Some(engine) = self.engine.as_deref_mut() {
            self.constraints.restore_ropes(engine);
        }
        self.moorings.restore(state.moorings);
        Ok(())
    }

    /// Sets the engine, when the first free body is added.
    pub(crate) fn set_engine(&mut self, engine: Box<dyn Engine<D>>) {
        self.engine = Some(engine);
    }

    /// Adds a solid with the initial kinematics `start`, and its added mass if the solid is light.
    pub(crate) fn add_body(&mut self, added_mass: Option<AcousticAddedMass<D>>, start: Kinematics<D>) {
        self.added_masses.extend(added_mass);
        self.constraints.add_body(start);
        self.accounting.iter_mut().for_each(Accounting::add_body);
    }

    /// Removes a solid with `count` boundary particles.
    pub(crate) fn remove_body(&mut self, solid: usize, count: u32) {
        if let Some(engine) = &mut self.engine {
            engine.remove_body(solid);
        }
        self.added_masses.retain(|added_mass| added_mass.solid != solid);
        self.added_masses.iter_mut().for_each(|added_mass| added_mass.renumber(solid, count));
    }

    /// Returns the computing time that the engine has used so far.
    pub(crate) fn engine_time(&self) -> Duration {
        self.spent
    }

    /// Returns the impulse (N s) that the water has given to `solid` and that no step has applied yet.
    pub(crate) fn pending_impulse(&self, solid: usize) -> Vector<D> {
        let own = self.added_masses.iter().find(|added_mass| added_mass.solid == solid);
        own.map_or_else(Vector::zeros, AcousticAddedMass::pending_impulse)
    }

    /// Returns the engine, or `None` if the scene has no free bodies.
    pub(crate) fn engine(&self) -> Option<&dyn Engine<D>> {
        self.engine.as_deref()
    }

    /// Returns the engine for changes, or `None` if the scene has no free bodies.
    pub(crate) fn engine_mut(&mut self) -> Option<&mut Box<dyn Engine<D>>> {
        self.engine.as_mut()
    }

    /// Moves the solids over the whole step, under the loads of the last force pass and the weights, both times `weight`. The
    /// factor `weight` does not apply to a body that no water touches. Calls `hook` after the water has moved and before the
    /// bodies move. Returns the impulses that bodies and mooring lines gave to the water.
    pub(crate) fn advance(
        &mut self,
        system: &mut System<D>,
        over: Interval,
        weight: f64,
        hook: &mut Hook<D>,
    ) -> Result<Vec<MomentumTransfer<D>>> {
        let end = over.t + over.dt;
        known_water::know_within(system, &self.water_ranges(system, over));
        // The engine itself adds the weight once.
        let gravity = system.gravity() * (weight - 1.0);
        let weighed = |solid: &Solid<D>| {
            let mass = solid.body.map_or(0.0, |body| body.mass);
            match solid.load == Load::zero() {
                true => solid.load,
                false => Load { force: solid.load.force * weight + gravity * mass, torque: solid.load.torque * weight },
            }
        };
        let loads: Vec<_> = system.solids.iter().map(weighed).collect();
        let external = self.external;
        let at_end = |solid: &Solid<D>| match &solid.spec.role {
            Role::Fixed => solid.kinematics,
            Role::Driven(motion) => solid.prescribed_kinematics(motion, end),
            Role::Free(_) if external => unset(),
            Role::Free(_) => solid.kinematics,
        };
        let solids = system.solids.iter().map(at_end).collect();
        let (transfers, advanced, advance) = (Vec::new(), false, BodyStep::advance_once);
        let mut step = BodyStep { bodies: self, system, over, loads, solids, transfers, advanced, advance };
        if external {
            step.apply_added_mass();
        }
        hook(&mut step)?;
        let (solids, transfers) = step.finish()?;
        if let Some(fault) = out_of_place(system, &solids) {
            return Err(fault_error(system, fault, self.steps, over.t));
        }
        self.steps += 1;
        place(system, Some(over.dt), |i, solid| match &solid.spec.role {
            Role::Fixed => None,
            Role::Driven(_) | Role::Free(_) => Some(solids[i]),
        });
        Ok(transfers)
    }
}

/// A function that the simulation calls in each step, after the water has moved and before the bodies move.
pub(crate) type Hook<'a, const D: usize> = dyn FnMut(&mut BodyStep<D>) -> Result<()> + 'a;

/// The part of a step in which the bodies move: see [`Simulation::step_with`](crate::simulation::Simulation::step_with).
///
/// Solids have the numbers that they have in [`System::solids`].
pub struct BodyStep<'a, const D: usize> {
    bodies: &'a mut Bodies<D>,
    system: &'a mut System<D>,
    over: Interval,
    loads: Vec<Load<D>>,
    /// Kinematics of each solid at the end of the step. The entries of fixed and driven solids are set already.
    /// [`BodyStep::advance_bodies`] sets the entries of free solids; your program sets them if the bodies are external.
    pub solids: Vec<Kinematics<D>>,
    transfers: Vec<MomentumTransfer<D>>,
    advanced: bool,
    /// [`BodyStep::advance_once`], as this library compiles it.
    advance: fn(&mut Self) -> Result<()>,
}

impl<const D: usize> BodyStep<'_, D> {
    /// Returns the time at the start of the step, s.
    pub fn time(&self) -> f64 {
        self.over.t
    }

    /// Returns the length of the step, s.
    pub fn dt(&self) -> f64 {
        self.over.dt
    }

    /// Returns the force (N; N/m in 2-D) of the water on each solid, and the torque about the centre of the solid (N m;
    /// N m/m in 2-D). Both are constant over the step and exclude the weight.
    pub fn loads(&self) -> &[Load<D>] {
        &self.loads
    }

    /// Adds `load` (N, N m) about the centre of free solid number `solid` in this step, before [`BodyStep::advance_bodies`].
    /// The call has no effect if the bodies are external, because your program then applies the forces.
    pub fn push(&mut self, solid: usize, load: &Load<D>) {
        if let Some(engine) = &mut self.bodies.engine {
            engine.add_load(solid, load);
        }
    }

    /// Returns the contact forces of each pair: those of this step after [`BodyStep::advance_bodies`], otherwise those of the
    /// last step.
    pub fn contacts(&self) -> Vec<ContactForce<D>> {
        self.bodies.engine().map(|engine| engine.contacts()).unwrap_or_default()
    }

    /// Advances the free bodies by the step, unless an earlier call has advanced them. If the hook does not call this function,
    /// the simulation does so afterwards.
    ///
    /// # Errors
    /// `Usage` if the bodies are external; `Fault` if a body leaves the valid range.
    pub fn advance_bodies(&mut self) -> Result<()> {
        (self.advance)(self)
    }

    fn advance_once(&mut self) -> Result<()> {
        if self.bodies.external {
            return Err(Error::new(
                ErrorKind::Usage,
                "a simulation with external bodies has none of its own to advance",
            )
            .help("step your own world, and write the poses of its bodies into step.solids"));
        }
        let moored = !self.bodies.moorings.is_empty();
        if std::mem::replace(&mut self.advanced, true) || (self.bodies.engine.is_none() && !moored) {
            return Ok(());
        }
        let Interval { t, dt } = self.over;
        let driven = |(solid, target): (&Solid<D>, &Kinematics<D>)| {
            matches!(solid.spec.role, Role::Driven(_)).then_some(*target)
        };
        let targets: Vec<_> = self.system.solids.iter().zip(&self.solids).map(driven).collect();
        let constrained = !self.bodies.constraints.is_empty();
        let accounted = self.bodies.accounting.is_some() || self.bodies.constraints.has_reactions();
        let start = self.bodies.kinematics(self.system, t, constrained || accounted || moored);
        if moored {
            let changes = self.bodies.moorings.advance(self.system, &start, &targets, self.over);
            changes.into_iter().for_each(|(name, change)| self.bodies.constraints.record_mooring(&name, t, change));
            let transfer = spread_impulses(self.system, self.bodies.moorings.impulses_on_water());
            self.add_transfer(transfer);
        }
        let mut pushes = Vec::new();
        if let Some(engine) = &mut self.bodies.engine {
            pushes.extend((0..if accounted { start.len() } else { 0 }).map(|i| engine.applied_push(i)));
            for i in 0..if moored { start.len() } else { 0 } {
                engine.add_load(i, &self.bodies.moorings.load_on(i));
            }
            if constrained {
                self.bodies.constraints.apply_loads(
                    &mut **engine,
                    &start,
                    &self.system.load_context(&self.loads),
                    [t, dt],
                );
            }
        }
        self.apply_added_mass();
        let Bodies { engine: Some(engine), added_masses, steps, spent, constraints, moorings, accounting, .. } =
            &mut *self.bodies
        else {
            return Ok(());
        };
        let before: Vec<_> = added_masses.iter().map(|added_mass| engine.kinematics(added_mass.solid)).collect();
        let clock = Instant::now();
        engine.step(dt, &self.loads, &targets).map_err(|fault| fault_error(self.system, fault, *steps, t))?;
        *spent += clock.elapsed();
        for (i, solid) in self.system.solids.iter().enumerate() {
            if let Role::Free(_) = solid.spec.role {
                self.solids[i] = engine.kinematics(i);
                if !self.system.domain().contains(&self.system.wrapped(&self.solids[i].centre)) {
                    return Err(fault_error(self.system, escaped(i, &self.solids[i]), *steps, t));
                }
            }
        }
        for (added_mass, before) in added_masses.iter_mut().zip(&before) {
            added_mass.update_contacts(self.system, dt, before, &self.solids[added_mass.solid]);
        }
        let contacts = if accounted { contact_sums(&engine.contacts(), start.len()) } else { Vec::new() };
        let body_loads = |i: usize, constraints: ConstraintLoads<D>| BodyLoads {
            water: self.loads[i],
            pushes: pushes[i],
            contacts: contacts[i],
            constraints,
            moorings: moorings.load_on(i),
            before: &start[i],
            after: &self.solids[i],
            gyroscopic: engine.gyroscopic_rate(i),
            dt,
        };
        let of = |i: usize| LoadBreakdown::of(self.system, i, &body_loads(i, constraints.loads_on(i)));
        let breakdowns: Vec<_> = (0..contacts.len()).map(of).collect();
        if constrained {
            let unexplained: Vec<_> = breakdowns.iter().map(LoadBreakdown::residual).collect();
            constraints.update_reactions(&**engine, [&start, &self.solids], dt, Some(&unexplained));
        }
        if let Some(accounting) = accounting {
            for (i, breakdown) in breakdowns.into_iter().enumerate() {
                accounting.add_body_step(self.system, i, breakdown, &body_loads(i, constraints.loads_on(i)));
            }
        }
        if constrained {
            constraints.break_overloaded(&mut **engine, t + dt);
        }
        Ok(())
    }

    /// Replaces the loads on light bodies by the loads corrected for acoustic added mass.
    fn apply_added_mass(&mut self) {
        let engine = &self.bodies.engine;
        let mut returned = Vec::new();
        for added_mass in &mut self.bodies.added_masses {
            let solid = added_mass.solid;
            let push = engine.as_ref().map_or_else(Load::zero, |engine| engine.applied_push(solid));
            returned.push((solid, added_mass.apply(self.system, self.over.dt, &push, &mut self.loads[solid])));
        }
        for (solid, impulse) in returned {
            let transfer = return_impulse(self.system, solid, &impulse);
            self.add_transfer(transfer);
        }
    }

    /// Records impulse and energy that the water has received.
    fn add_transfer(&mut self, transfer: Option<MomentumTransfer<D>>) {
        let energy = transfer.as_ref().map_or(0.0, |transfer| transfer.energy);
        self.bodies.accounting.iter_mut().for_each(|accounting| accounting.add_returned(energy));
        self.transfers.extend(transfer);
    }

    /// Completes the step. Returns the kinematics of the solids at the end of the step, and the impulses that the
    /// bodies returned to the water.
    fn finish(mut self) -> Result<(Vec<Kinematics<D>>, Vec<MomentumTransfer<D>>)> {
        if !self.bodies.external {
            self.advance_bodies()?;
            return Ok((self.solids, self.transfers));
        }
        let finite = |k: &Kinematics<D>| {
            let sum = k.pose.position.norm() + k.pose.rotation.norm() + k.centre.norm();
            (sum + k.velocity.norm() + k.spin.0.norm()).is_finite()
        };
        if let Some(solid) = self.solids.iter().position(|k| !finite(k)) {
            let name = &self.system.solids[solid].spec.name;
            let what = format!("the kinematics of body {name:?} after the step are not set, or are not finite");
            return Err(Error::new(ErrorKind::Usage, what).help(
                "advance a simulation with external bodies by step_with, and write each free body into step.solids",
            ));
        }
        for added_mass in &mut self.bodies.added_masses {
            // The drift of half a step changed neither velocity nor spin.
            let before = self.system.solids[added_mass.solid].kinematics;
            added_mass.update_contacts(self.system, self.over.dt, &before, &self.solids[added_mass.solid]);
        }
        Ok((self.solids, self.transfers))
    }
}

/// Returns the placeholder for kinematics that an external program has not set yet.
fn unset<const D: usize>() -> Kinematics<D> {
    let none = Vector::repeat(f64::NAN);
    Kinematics { pose: Pose::at(none), centre: none, velocity: none, spin: Bivector::zero() }
}

/// Returns the fault of solid number `solid`, which has left the domain.
fn escaped<const D: usize>(solid: usize, now: &Kinematics<D>) -> EngineFault<D> {
    EngineFault {
        code: ErrorCode::LeftDomain,
        solid,
        reason: "escape from the domain".into(),
        cause: "Usual cause: it starts beside the tank, an impact threw it over a wall, or nothing supports it. If it may go \
                there, set domain.min and domain.max wider.",
        position: now.centre,
        velocity: now.velocity,
    }
}

/// Usual cause and remedy of a solid that meets its image at a symmetry plane.
const AT_PLANE: &str = "Contacts do not act across symmetry planes. Start it further from the plane, hold it with a line or a \
                        lock, or compute both sides:  leave symmetry out.";

/// Usual cause and remedy of a driven solid that ends at a periodic side.
const AT_SIDE: &str = "Too long a solid is not repeated. Let it reach 2.5 kernel supports or more beyond both sides during its \
                       whole motion, or start it between the sides, shorter than the period less 5 supports.";

/// Usual cause and remedy of a solid that ends in the buffer of an open boundary.
const AT_FACE: &str = "The water beyond a face is prescribed and carries no body. Hold it with a mooring or  free.locked,  move the \
                       face further away, or end the run earlier:  until.";

/// Returns the fault of the first of `solids` that, at the end of a step, touches its image across a symmetry plane or reaches a
/// periodic side or the buffer of an open boundary.
fn out_of_place<const D: usize>(system: &System<D>, solids: &[Kinematics<D>]) -> Option<EngineFault<D>> {
    let fault = |(solid, now): (usize, &Kinematics<D>)| {
        let (reason, cause) = if system.meets_its_image(solid, &now.pose) {
            ("contact with its mirror image at a symmetry plane".to_string(), AT_PLANE)
        } else if let Some(axis) = system.side_reached(solid, now) {
            (format!("an end at a periodic side along {axis}"), AT_SIDE)
        } else {
            let face = face_reached(system, solid, &now.pose)?;
            let (name, axis, at) = (&face.name, ["x", "y"][face.axis], face.at);
            (format!("an end in the buffer of open boundary {name:?} at {axis} = {at}"), AT_FACE)
        };
        let (position, velocity) = (now.centre, now.velocity);
        Some(EngineFault { code: ErrorCode::LeftDomain, solid, reason, cause, position, velocity })
    };
    solids.iter().enumerate().find_map(fault)
}

pub(super) fn fault_error<const D: usize>(system: &System<D>, fault: EngineFault<D>, step: u64, time: f64) -> Error {
    Error::fault(Fault {
        code: fault.code,
        reason: fault.reason,
        who: format!("body {:?}", system.solids[fault.solid].spec.name),
        step,
        time,
        position: fault.position.iter().copied().collect(),
        velocity: fault.velocity.iter().copied().collect(),
        density: None,
        cause: fault.cause.into(),
    })
}
