//! A running simulation: step limit, step, checks. No files.

mod accounting;
mod add_remove;
mod change_by_hand;
mod dimension;
mod external_bodies;
pub(crate) mod water_of_ranks;
#[cfg(feature = "gpu")]
mod on_device;
mod rollback;
mod state_bytes;
mod constraints;

use std::{
    borrow::Cow,
    io::{self, Write},
    path::Path,
    time::{Duration, Instant},
};

pub use crate::coupling::{BodyStep, EnergyBudget, LoadBreakdown};
pub use crate::system::{
    Current, Driving, Escape, FaceExchange, OpenBoundary, ParticleLimits, RemovedParticle, Setup, TowedFrame,
};
pub(crate) use constraints::find_by_name;
pub use rollback::Rollback;

use serde::{Deserialize, Serialize};

use accounting::change_gravity;
pub use add_remove::AddedSolid;
use dimension::OwnPairLoop;
pub use dimension::{Compiled, Dimension};
#[cfg(feature = "gpu")]
use on_device::OnDevice;
use rollback::{RollbackControl, StoredState};
use state_bytes::{bytes_of, read, write_to_the_end};

use crate::{
    coupling::{Accounting, AccountingState, AcousticAddedMass, Bodies, BodiesState, Hook, Interval, Moorings},
    error::{Error, ErrorCode, ErrorKind, Fault, Result},
    interaction::{PairLoop, RequestedSums},
    math::{Bivector, Vector},
    model::HasPairLoop as _,
    ranks::{Ranks, WaterShare},
    solid::{ContactForce, Dim, HasEngine as _, Role, SolidSpec, constraint::assembly::Assembly},
    system::{
        LimitViolation, SavedWater, System, SystemState,
        own_water::{self, OwnNames},
        set_buffer_time, set_gravity_at, update_buffer, update_current,
    },
    time_integration::{Stepper, step_size},
};
#[cfg(feature = "gpu")]
use crate::{
    device::Adapter,
    interaction::{PairSums, StepLimits},
};

/// Water and solids moving through time.
pub struct Simulation<const D: usize> {
    compiled: &'static Compiled<D>,
    system: System<D>,
    stepper: Stepper<D>,
    bodies: Bodies<D>,
    clock: Clock,
    rollback: RollbackControl,
    /// Removed particles, and the times of removal, s.
    removed: Vec<(f64, RemovedParticle<D>)>,
    stepping: Duration,
    #[cfg(feature = "gpu")]
    device: Option<OnDevice<D>>,
    /// Whether the pair loop has terms that the model does not name.
    #[cfg(feature = "gpu")]
    custom_terms: bool,
}

/// Wall time by part, since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TimeSpent {
    /// All steps.
    pub steps: Duration,
    /// Lists and sorting.
    pub lists: Duration,
    /// Sums over pairs.
    pub pairs: Duration,
    /// The rigid-body engine.
    pub bodies: Duration,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Clock {
    time: f64,
    dt: f64,
    steps: u64,
}

/// The state of a simulation in a checkpoint; what is large is borrowed where it is written.
#[derive(Serialize, Deserialize)]
struct SimulationState<'a, const D: usize> {
    system: SystemState<'a, D>,
    stepper: Cow<'a, Stepper<D>>,
    clock: Clock,
    bodies: BodiesState<D>,
    rollbacks: Cow<'a, [Rollback]>,
    removed: Cow<'a, [(f64, RemovedParticle<D>)]>,
    accounting: Option<AccountingState<D>>,
    /// Numbers of the solids that have been removed.
    removed_solids: Vec<u32>,
}

impl<const D: usize> Simulation<D> {
    /// Sets up a simulation at time 0 and computes the first force pass.
    ///
    /// # Errors
    /// `Scene` if a constant has no valid value, a solid cannot be made, or bodies overlap: says which.
    pub fn new(setup: Setup<D>) -> Result<Self>
    where
        Dim<D>: Dimension<D>,
    {
        Self::on_ranks(setup, &Ranks::default())
    }

    /// As [`Simulation::new`], on several ranks: each of them makes the simulation of the same setup and the same calls, in the same
    /// order.
    ///
    /// # Errors
    /// As [`Simulation::new`].
    pub fn on_ranks(setup: Setup<D>, ranks: &Ranks) -> Result<Self>
    where
        Dim<D>: Dimension<D>,
    {
        let mut simulation = Self::set_up(setup, ranks.with_all_water())?;
        simulation.gather_water(true);
        Ok(simulation)
    }

    /// As [`Simulation::on_ranks`], but `setup` has this rank's `share` of the water, and each rank may have its own alone after this.
    pub(crate) fn set_up(setup: Setup<D>, share: WaterShare<'_>) -> Result<Self>
    where
        Dim<D>: Dimension<D>,
    {
        (Dim::<D>::compiled().set_up)(setup, None, false, share)
    }

    /// As [`Simulation::new`], with a pair loop of your own terms: see [`Model::custom_pair_loop`](crate::model::Model).
    ///
    /// # Errors
    /// As [`Simulation::new`].
    pub fn with_pair_loop(setup: Setup<D>, pair_loop: Box<dyn PairLoop<D>>) -> Result<Self>
    where
        Dim<D>: Dimension<D>,
    {
        let simulation =
            (Dim::<D>::compiled().set_up)(setup, Some(pair_loop), false, Ranks::default().with_all_water())?;
        #[cfg(feature = "gpu")]
        let simulation = Self { custom_terms: true, ..simulation };
        Ok(simulation)
    }

    /// Sets up a simulation whose free solids the engine moves, or an `external` program, with its own pair loop or that of the model.
    fn with_bodies(
        mut setup: Setup<D>,
        pair_loop: OwnPairLoop<D>,
        external: bool,
        share: WaterShare<'_>,
    ) -> Result<Self>
    where
        Dim<D>: Dimension<D>,
    {
        let pair_loop = pair_loop.unwrap_or_else(|| Dim::<D>::pair_loop(&setup.model));
        setup.check()?;
        setup.apply_symmetry()?;
        let (solids, dp) = (&setup.solids, setup.model.dp);
        for solid in solids {
            solid.check()?;
        }
        let free = |s: &&SolidSpec<D>| matches!(s.role, Role::Free(_));
        let start: Vec<_> = solids.iter().map(SolidSpec::initial_kinematics).collect();
        let gravity = setup.initial_gravity();
        let engine = if !external && solids.iter().any(|s| free(&s)) {
            Some(Dim::<D>::engine(solids, &start, &setup.constraints, &gravity, dp)?)
        } else {
            None
        };
        let rig = Assembly::new(&setup.constraints, start.clone());
        let stepper = Stepper::new(&setup.model);
        let mut system = System::new(setup, pair_loop, share)?;
        let moorings = Moorings::new(&mut system, &start)?;
        let bodies = Bodies::new(engine, AcousticAddedMass::find_all(&mut system), rig, moorings, external);
        let clock = Clock { time: 0.0, dt: 0.0, steps: 0 };
        let (rescue, lost, stepping) = (RollbackControl::default(), Vec::new(), Duration::ZERO);
        let mut simulation = Self {
            compiled: Dim::<D>::compiled(),
            system,
            stepper,
            bodies,
            clock,
            rollback: rescue,
            removed: lost,
            stepping,
            #[cfg(feature = "gpu")]
            device: None,
            #[cfg(feature = "gpu")]
            custom_terms: false,
        };
        simulation.guard()?;
        Ok(simulation)
    }

    /// Advances by one step of the largest allowed length. If a guard raises an alarm, the simulation returns to a stored
    /// state, some hundreds of steps old, and takes half steps for a while: see [`Simulation::rollbacks`].
    ///
    /// # Errors
    /// `Fault` if a guard raises an alarm during the half steps, or for the fourth time in the run. The error names the particle or body,
    /// its place and the usual cause.
    pub fn step(&mut self) -> Result<()> {
        self.step_to(f64::INFINITY)
    }

    /// Advances by one step, not past time `end` (s).
    ///
    /// # Errors
    /// As [`Simulation::step`].
    pub fn step_to(&mut self, end: f64) -> Result<()> {
        (self.compiled.step_to)(self, end)
    }

    fn make_step_to(&mut self, end: f64) -> Result<()> {
        #[cfg(feature = "gpu")]
        if self.device.is_some() {
            on_device::steps(self, (1, end), end, None)?;
            return self.fetch_from_device();
        }
        let outcome = self.step_with_own_water(end);
        self.complete_water(true);
        outcome
    }

    /// Advances by one step, not past time `end` (s). Where ranks share the water, each has its own after that: see
    /// [`Simulation::gather_water`].
    pub(crate) fn step_with_own_water(&mut self, end: f64) -> Result<()> {
        self.make_step_with(end, &mut |_| Ok(()))
    }

    /// Advances by one step, calling `hook` when the water has moved and the bodies have not.
    /// Completes the water on the first rank, or on all if `everyone`, and its sums there. All ranks must call this.
    pub(crate) fn gather_water(&mut self, everyone: bool) {
        (self.compiled.gather_water)(self, everyone);
    }

    fn complete_water(&mut self, everyone: bool) {
        own_water::gather(&mut self.system, everyone);
    }

    fn make_step_with(&mut self, end: f64, hook: &mut Hook<D>) -> Result<()> {
        #[cfg(feature = "gpu")]
        if self.device.is_some() {
            on_device::steps(self, (1, end), end, Some(hook))?;
            return self.fetch_from_device();
        }
        let start = Instant::now();
        if self.needs_rollback_state() {
            self.rollback.drop_oldest_state();
            let state = self.rollback_state()?;
            self.rollback.store(self.clock.steps, self.clock.time, state);
        }
        let outcome = self.advance(end, hook).or_else(|error| self.roll_back(error));
        self.stepping += start.elapsed();
        outcome
    }

    /// Advances by one step, not past time `end` (s). On a device it makes steps until time `pause` (s) is reached, and leaves the
    /// state there: call [`Simulation::fetch_from_device`] to read the water.
    #[cfg(feature = "gpu")]
    #[doc(hidden)]
    pub fn step_to_pause(&mut self, pause: f64, end: f64) -> Result<()> {
        match self.device {
            Some(_) => on_device::steps(self, (u64::MAX, pause), end, None),
            None => self.step_with_own_water(end),
        }
    }

    /// The same simulation with its water on the device `name`: the number of an adapter, `gpu` for the first graphics card, or
    /// part of a name; see [`crate::device::adapters`].
    ///
    /// [`Simulation::step`] then brings the state back after each step. [`run`](crate::run) does so only where an output is due.
    ///
    /// # Errors
    /// `Usage` if there is no such device, or the simulation has something that no device computes yet: names both and the remedy.
    #[cfg(feature = "gpu")]
    pub fn on_device(self, name: &str) -> Result<Self> {
        on_device::place(self, name)
    }

    /// The device that has the water, if one has.
    #[cfg(feature = "gpu")]
    pub fn device(&self) -> Option<&Adapter> {
        self.device.as_ref().map(OnDevice::adapter)
    }

    /// Memory of the arrays on the device, B: all, and of these the neighbour lists.
    #[cfg(feature = "gpu")]
    pub fn device_memory(&self) -> Option<[u64; 2]> {
        self.device.as_ref().map(OnDevice::memory)
    }

    /// Makes a force pass on the device at the present state; returns acceleration (m/s²) and rate of the excess density (1/s) of each
    /// water particle, and the largest values that limit a step. For comparisons.
    #[cfg(feature = "gpu")]
    #[doc(hidden)]
    pub fn device_rates(&mut self) -> Result<Option<(Vec<PairSums<D>>, StepLimits)>> {
        on_device::rates(self)
    }

    /// Brings the state of the water and the forces on the boundary particles back from the device, if one has them.
    ///
    /// # Errors
    /// `Usage` if the device failed.
    #[cfg(feature = "gpu")]
    pub fn fetch_from_device(&mut self) -> Result<()> {
        on_device::fetch(self)?;
        on_device::fetch_boundary_sums(self)
    }

    /// The same, without the forces on the boundary particles.
    #[cfg(feature = "gpu")]
    pub(crate) fn fetch_water(&mut self) -> Result<()> {
        on_device::fetch(self)
    }

    /// Brings the loads on the solids back.
    #[cfg(feature = "gpu")]
    pub(crate) fn fetch_loads(&mut self) -> Result<()> {
        on_device::fetch_loads(self)
    }

    /// How often the processor has waited for the device. For comparisons.
    #[cfg(feature = "gpu")]
    #[doc(hidden)]
    pub fn device_waits(&self) -> Option<u64> {
        self.device.as_ref().map(OnDevice::waits)
    }

    /// The present state: in the folder for such states, or in memory if there is none or it cannot be written to. Of ranks that have
    /// water of their own each stores that; of others the first alone stores the state.
    fn rollback_state(&self) -> Result<StoredState> {
        let own = own_water::own_names(&self.system);
        if own.is_none() && own_water::ranks(&self.system).rank() > 0 {
            return Ok(StoredState::Memory(Vec::new()));
        }
        let state = (own, self.state(self.rollback.log.len(), SavedWater::Own)?);
        let write = |out: &mut dyn Write| postcard::to_io(&state, out).map(drop).map_err(io::Error::other);
        let stored = self.rollback.folder.as_ref().and_then(|folder| StoredState::in_folder(folder, write).ok());
        stored.map_or_else(|| bytes_of(&state).map(StoredState::Memory), Ok)
    }

    /// Rolls back to a good state after the alarm `error`, or returns it if there is none.
    fn roll_back(&mut self, error: Error) -> Result<()> {
        if error.kind != ErrorKind::Fault {
            return Err(error);
        }
        let ranks = own_water::ranks(&self.system);
        let shared = |own: Vec<u8>| rollback::shared_state(&ranks, own);
        let stored = self.rollback.state_before(&error.message, self.clock.steps, self.clock.time, shared);
        let Some(good) = stored else { return Err(error) };
        let rescue = std::mem::take(&mut self.rollback);
        let (own, kept): (Option<OwnNames>, SimulationState<'static, D>) = read(&good)?;
        drop(good);
        let planned =
            if own.is_some() { self.planned_removals(&kept.removed_solids) } else { self.check_state(&kept)? };
        self.take_state(kept, &planned, own)?;
        self.rollback = rescue;
        Ok(())
    }

    /// Disables the rollback: the first alarm ends the run.
    pub fn without_rollback(mut self) -> Self {
        self.rollback = RollbackControl::disabled();
        self
    }

    /// Stores the states for a rollback in `folder` from now on, in files without a name, and not in memory.
    pub(crate) fn store_rollback_states_in(&mut self, folder: &Path) {
        self.rollback.folder = Some(folder.to_owned());
    }

    /// Whether the next step first stores the state for a rollback.
    pub(crate) fn needs_rollback_state(&self) -> bool {
        #[cfg(feature = "gpu")]
        if let Some(own) = &self.device {
            return self.rollback.is_on() && own.needs_state(self.clock.steps);
        }
        self.rollback.needs_state(self.clock.steps)
    }

    /// Whether a state of `time` (s) is stored.
    pub(crate) fn has_rollback_state(&self, time: f64) -> bool {
        self.rollback.has_state_at(time)
    }

    /// The rollbacks so far, with their causes and times.
    pub fn rollbacks(&self) -> &[Rollback] {
        &self.rollback.log
    }

    /// The particles that left the domain and were removed ([`Escape::Remove`]), and the times of removal (s).
    pub fn removed_particles(&self) -> &[(f64, RemovedParticle<D>)] {
        &self.removed
    }

    fn advance(&mut self, end: f64, hook: &mut Hook<D>) -> Result<()> {
        let divided = own_water::may_be_divided(&self.system) && !self.bodies.read_all_water();
        own_water::divide(&mut self.system, divided);
        set_buffer_time(&mut self.system, self.clock.time);
        self.rebuild_neighbours();
        update_buffer(&mut self.system, self.clock.time, self.clock.dt);
        self.system.update_rates(self.stepper.sums_at_start());
        let allowed = self.step_limit();
        let left = end - self.clock.time;
        // The last two steps have equal lengths, so that none is far shorter than the others.
        let dt = if left <= allowed { left } else { allowed.min(0.5 * left) };
        if dt.is_nan() || dt <= 0.0 {
            own_water::tell_of(&mut self.system, 0);
            return Err(self.fault((0, ErrorCode::NoTimeStep, "time step of no length", NO_STEP)));
        }
        let over = Interval { t: self.clock.time, dt };
        self.system.update_absorption(over.t);
        change_gravity(&mut self.system, &mut self.bodies, over.t + 0.5 * dt);
        let weight = self.stepper.step(&mut self.system, over, self.bodies.accounting.as_mut());
        let transfers = self.bodies.advance(&mut self.system, over, weight, hook)?;
        self.stepper.add_transfers(&transfers);
        self.clock.dt = dt;
        self.clock.steps += 1;
        self.clock.time = if left <= allowed { end } else { self.clock.time + dt };
        update_current(&mut self.system, dt);
        change_gravity(&mut self.system, &mut self.bodies, self.clock.time);
        self.bodies.update_masses(&mut self.system, self.clock.time, dt)?;
        self.guard()?;
        self.remove_due()
    }

    /// Makes the neighbour lists anew where they may miss a pair, and removes the water that has left the domain then.
    fn rebuild_neighbours(&mut self) {
        if let Some(reordering) = self.system.rebuild_neighbours() {
            self.stepper.reorder(&reordering, self.system.properties().rho0);
            if let Some(accounting) = &mut self.bodies.accounting {
                accounting.add_removed(&self.system, &reordering.removed);
                accounting.add_displaced(-reordering.exchanged_energy);
            }
            self.removed.extend(reordering.removed.into_iter().map(|lost| (self.clock.time, lost)));
        }
    }

    /// The longest step (s) that the present rates, the springs and the model allow.
    pub fn step_limit(&self) -> f64 {
        let model = self.system.model();
        let water = step_size::fluid_step_limit(&self.system.step_limits(), self.system.properties(), model.cfl);
        let factor = self.rollback.step_factor(self.clock.time);
        (water * factor).min(self.host_step_limit())
    }

    /// The longest step (s) that all but the rates allow.
    fn host_step_limit(&self) -> f64 {
        let model = self.system.model();
        let events = self.bodies.constraints().next_event(self.clock.time);
        let ties = self.spring_step_limit().min(events).min(self.bodies.moorings.next_event(self.clock.time));
        model.viscosity.step_limit(model.h).min(model.dt_max).min(ties) * self.rollback.step_factor(self.clock.time)
    }

    /// Stops at the first particle that has left the valid range.
    fn guard(&mut self) -> Result<()> {
        match self.system.first_invalid_particle() {
            None => Ok(()),
            Some(violation) => Err(self.fault(violation)),
        }
    }

    /// The fault of water particle number `i`.
    fn fault(&self, (i, code, reason, cause): LimitViolation) -> Error {
        let fluid = &self.system.fluid.particles;
        let of = |x: Option<&Vector<D>>| x.map(|x| x.iter().copied().collect()).unwrap_or_default();
        Error::fault(Fault {
            code,
            reason: reason.into(),
            who: self.system.particle_name(i),
            step: self.clock.steps,
            time: self.clock.time,
            position: of(fluid.r.get(i)),
            velocity: of(fluid.v.get(i)),
            density: fluid.rho.get(i).copied(),
            cause: cause.into(),
        })
    }

    /// Computes the rates after the state was changed by hand.
    pub fn update_rates(&mut self) {
        (self.compiled.update_rates)(self);
    }

    fn compute_rates(&mut self) {
        self.system.update_rates(RequestedSums::All);
    }

    /// Water and solids now.
    pub fn system(&self) -> &System<D> {
        &self.system
    }

    /// Wall time by part; the remainder of the steps is moving and packing particles.
    pub fn time_spent(&self) -> TimeSpent {
        let (lists, pairs) = self.system.time_spent();
        TimeSpent { steps: self.stepping, lists, pairs, bodies: self.bodies.engine_time() }
    }

    /// Simulated time, s.
    pub fn time(&self) -> f64 {
        self.clock.time
    }

    /// Length of the last step, s.
    pub fn dt(&self) -> f64 {
        self.clock.dt
    }

    /// Steps so far.
    pub fn steps(&self) -> u64 {
        self.clock.steps
    }

    /// Force passes so far.
    pub(crate) fn force_passes(&self) -> u64 {
        self.system.force_passes()
    }

    /// Pushes free solid number `solid` with `force` (N; N/m in 2-D) at the world point `at` (m) during the
    /// next step. Without effect on a solid that is not free.
    pub fn push(&mut self, solid: usize, force: &Vector<D>, at: &Vector<D>) {
        if let Some(engine) = self.bodies.engine_mut() {
            engine.push(solid, force, at);
        }
    }

    /// Impulse (N s; N s/m in 2-D) of the water not yet applied to free solid number `solid`. Non-zero only for bodies with
    /// acoustic added mass.
    pub fn pending_impulse(&self, solid: usize) -> Vector<D> {
        self.bodies.pending_impulse(solid)
    }

    /// Gives free solid number `solid` a velocity of its centre of mass (m/s) and a spin (rad/s), at once; 0 along its locked motions.
    pub fn set_velocity(&mut self, solid: usize, velocity: &Vector<D>, spin: &Bivector<D>) {
        (self.compiled.set_velocity)(self, solid, velocity, spin);
    }

    /// Gives each water particle the velocity (m/s) that `field` says for its place (m).
    pub fn set_water_velocity(&mut self, field: impl Fn(&Vector<D>) -> Vector<D> + Sync) {
        (self.compiled.set_water_velocity)(self, &field);
    }

    /// Gives each water particle the density (kg/m³) that `field` says for its place (m).
    pub fn set_water_density(&mut self, field: impl Fn(&Vector<D>) -> f64 + Sync) {
        (self.compiled.set_water_density)(self, &field);
    }

    /// Contact forces in the last step, pair by pair.
    pub fn contacts(&self) -> Vec<ContactForce<D>> {
        self.bodies.engine().map(|e| e.contacts()).unwrap_or_default()
    }

    /// The state from which [`Simulation::restore`] continues with the same bits.
    ///
    /// # Errors
    /// `Restart` if the engine's state cannot be written.
    pub fn save(&self) -> Result<Vec<u8>> {
        (self.compiled.save)(self)
    }

    fn state_bytes(&self) -> Result<Vec<u8>> {
        bytes_of(&self.state(self.rollback.log.len(), SavedWater::All)?)
    }

    /// Writes the state of [`Simulation::save`] with the first `rollbacks` rollbacks only. Where each rank has its own water, all must
    /// call this: the first writes all water, and has a piece of that of the others at a time.
    pub(crate) fn write_state(&self, rollbacks: usize, out: &mut dyn Write) -> io::Result<()> {
        let state = self.state(rollbacks, SavedWater::All).map_err(|e| io::Error::other(e.message))?;
        write_to_the_end(&state, out)
    }

    /// The state with the first `rollbacks` rollbacks.
    fn state(&self, rollbacks: usize, water: SavedWater) -> Result<SimulationState<'_, D>> {
        Ok(SimulationState {
            system: self.system.save(water),
            stepper: Cow::Borrowed(&self.stepper),
            clock: self.clock,
            bodies: self.bodies.save()?,
            rollbacks: Cow::Borrowed(&self.rollback.log[..rollbacks]),
            removed: Cow::Borrowed(&self.removed),
            accounting: self.bodies.accounting.as_ref().map(Accounting::state),
            removed_solids: self.removed_solids(),
        })
    }

    /// Numbers of the solids that have been removed.
    fn removed_solids(&self) -> Vec<u32> {
        let solids = self.system.solids().iter().enumerate();
        solids.filter(|(_, solid)| solid.boundary.is_empty()).map(|(i, _)| i as u32).collect()
    }

    /// Returns to a state from [`Simulation::save`], in a simulation made from the same setup.
    ///
    /// # Errors
    /// `Restart` if the bytes are damaged or belong to another setup; nothing has changed then.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<()> {
        (self.compiled.restore)(self, bytes)
    }

    fn restore_state(&mut self, bytes: &[u8]) -> Result<()> {
        let kept = read::<SimulationState<'static, D>>(bytes)?;
        let planned = self.check_state(&kept)?;
        self.take_state(kept, &planned, None)
    }

    /// Takes the state `state` once the solids `planned` are removed; `own` are the names of its water, if that is this rank's alone.
    fn take_state(
        &mut self,
        state: SimulationState<'static, D>,
        planned: &[usize],
        own: Option<OwnNames>,
    ) -> Result<()> {
        self.delete_solids(planned);
        self.bodies.restore(state.bodies, state.clock.steps)?;
        self.system.restore(state.system, own);
        if let (Some(accounting), Some(state)) = (&mut self.bodies.accounting, state.accounting) {
            accounting.restore(state);
        }
        (self.stepper, self.clock) = (state.stepper.into_owned(), state.clock);
        self.removed = state.removed.into_owned();
        set_gravity_at(&mut self.system, self.clock.time);
        self.system.set_masses_at(self.clock.time);
        self.rollback.restart(state.rollbacks.into_owned());
        #[cfg(feature = "gpu")]
        on_device::restore(self)?;
        Ok(())
    }

    /// Checks that this simulation can return to the state `kept`; returns the solids whose planned removal comes before that.
    fn check_state(&self, kept: &SimulationState<D>) -> Result<Vec<usize>> {
        let planned = self.planned_removals(&kept.removed_solids);
        let mut removed = self.removed_solids();
        removed.extend(planned.iter().map(|solid| *solid as u32));
        removed.sort_unstable();
        removed.dedup();
        let other = |what: &str| Error::new(ErrorKind::Restart, what).with_code(ErrorCode::OtherSetup);
        if kept.removed_solids != removed {
            return Err(other("solids had been removed from the simulation whose state this is")
                .help("restore_with_added_solids restores it in a simulation made from the same setup"));
        }
        if !self.bodies.matches(&kept.bodies, &planned)? {
            return Err(other("the checkpoint holds other bodies"));
        }
        match (&self.bodies.accounting, &kept.accounting) {
            (Some(own), Some(state)) if own.matches(state) => {}
            (None, None) => {}
            _ => return Err(other("the checkpoint holds another load breakdown or energy budget")),
        }
        self.system.check_state(&kept.system, &planned)?;
        Ok(planned)
    }
}

const NO_STEP: &str = "The accelerations are not finite, or the end lies in the past.";
