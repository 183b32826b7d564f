//! A simulation whose water is on a device.

use std::time::Instant;

use super::{Simulation, StoredState};
use crate::{
    coupling::{Hook, Interval, drift_half_step},
    device::{Adapter, Device, DeviceSteps, ShaderTexts, StepsEnd},
    error::{Error, ErrorCode, ErrorKind, Result},
    interaction::{PairSums, StepLimits},
    model::TimeScheme,
    solid::Role,
};

/// The water of a simulation on a device.
pub(super) struct OnDevice<const D: usize> {
    device: Device<D>,
    /// Whether the host has the device's state.
    host_is_current: bool,
    /// Whether the loads of the solids are those of the last force pass.
    loads_are_current: bool,
    /// Whether no solid moves.
    all_fixed: bool,
    /// Steps after which a state for a rollback is stored.
    next_state: u64,
}

impl<const D: usize> OnDevice<D> {
    /// Whether a state for a rollback is due after `steps` steps.
    pub(super) fn needs_state(&self, steps: u64) -> bool {
        steps >= self.next_state
    }

    fn refused(what: &str) -> Error {
        Error::new(ErrorKind::Usage, format!("a device does not compute {what} yet"))
            .with_code(ErrorCode::NoDevice)
            .help("leave --device (model.device) out: the processor computes all of this scene")
    }
}

/// Steps from one state for a rollback to the next.
const STATE_EVERY: u64 = 500;

impl<const D: usize> Simulation<D> {
    /// The same simulation with its water on the device `name`: the number of an adapter, `gpu` for the first graphics card, or
    /// part of a name; see [`crate::device::adapters`].
    ///
    /// [`Simulation::step`] then brings the state back after each step. [`run`](crate::run) does so only where an output is due.
    ///
    /// # Errors
    /// `Usage` if there is no such device, or the simulation has something that no device computes yet: names both and the remedy.
    pub fn on_device(mut self, name: &str) -> Result<Self> {
        let bodies = &self.bodies;
        let cases = [
            (!bodies.added_masses().is_empty(), "light bodies"),
            (!bodies.moorings.is_empty(), "mooring lines"),
            (bodies.accounting.is_some(), "load breakdowns and energy budgets"),
            (bodies.has_external_bodies(), "bodies that an external program moves"),
            (bodies.constraints().due_removals(f64::MAX).next().is_some(), "solids that are removed during the run"),
        ];
        if let Some((_, what)) = cases.into_iter().find(|(has, _)| *has) {
            return Err(OnDevice::<D>::refused(what));
        }
        let device = Device::new(name, &self.system, &self.stepper, self.clock.time)?;
        let all_fixed = self.system.solids().iter().all(|solid| matches!(solid.spec.role, Role::Fixed));
        self.system.set_on_device(true);
        self.device =
            Some(OnDevice { device, host_is_current: true, loads_are_current: true, all_fixed, next_state: 0 });
        Ok(self)
    }

    /// The device that has the water, if one has.
    pub fn device(&self) -> Option<&Adapter> {
        self.device.as_ref().map(|on_device| on_device.device.adapter())
    }

    /// Memory of the arrays on the device, B: all, and of these the neighbour lists.
    pub fn device_memory(&self) -> Option<[u64; 2]> {
        self.device.as_ref().map(|on_device| on_device.device.memory_bytes())
    }

    /// Makes a force pass on the device at the present state; returns acceleration (m/s²) and rate of the excess density (1/s) of each
    /// water particle, and the largest values that limit a step. For comparisons.
    #[doc(hidden)]
    pub fn device_rates(&mut self) -> Result<Option<(Vec<PairSums<D>>, StepLimits)>> {
        let Self { device: Some(own), system, .. } = self else { return Ok(None) };
        let rates = own.device.rates(system)?;
        let loads = own.device.loads(system)?;
        system.solids.iter_mut().zip(loads).for_each(|(solid, load)| solid.load = load);
        Ok(Some(rates))
    }

    /// The texts of the shaders of the device.
    #[doc(hidden)]
    pub fn shader_texts(&self) -> Option<&ShaderTexts> {
        self.device.as_ref().map(|own| own.device.texts())
    }

    /// Gives the state of the host, which was changed, to the device.
    pub(super) fn load_device(&mut self) -> Result<()> {
        let Self { device: Some(own), system, stepper, clock, .. } = self else { return Ok(()) };
        own.device.load(system, stepper, clock.time)?;
        (own.host_is_current, own.loads_are_current) = (true, true);
        own.next_state = own.next_state.min(clock.steps + STATE_EVERY);
        Ok(())
    }

    /// Brings the state of the water back from the device, if one has it.
    ///
    /// # Errors
    /// `Usage` if the device failed.
    pub fn fetch_from_device(&mut self) -> Result<()> {
        self.fetch_loads()?;
        let Self { device: Some(own), system, stepper, .. } = self else { return Ok(()) };
        if !std::mem::replace(&mut own.host_is_current, true) {
            own.device.fetch(system, stepper)?;
        }
        Ok(())
    }

    /// Brings the loads on the solids back.
    pub(crate) fn fetch_loads(&mut self) -> Result<()> {
        let Self { device: Some(own), system, .. } = self else { return Ok(()) };
        if !std::mem::replace(&mut own.loads_are_current, true) {
            let loads = own.device.loads(system)?;
            system.solids.iter_mut().zip(loads).for_each(|(solid, load)| solid.load = load);
        }
        Ok(())
    }

    /// Advances as [`Simulation::advance_on_device`], and goes back to a good state at the first alarm.
    pub(super) fn device_steps(&mut self, most: (u64, f64), end: f64, hook: &mut Hook<D>) -> Result<()> {
        let start = Instant::now();
        self.store_device_state()?;
        let outcome = self.advance_on_device(most, end, hook).or_else(|error| self.roll_back(error));
        self.stepping += start.elapsed();
        outcome
    }

    /// Advances by up to `most` steps until time `pause` (s) is reached, not past `end` (s); the state stays on the device.
    fn advance_on_device(&mut self, (most, pause): (u64, f64), end: f64, hook: &mut Hook<D>) -> Result<()> {
        let all_fixed = self.device.as_ref().is_some_and(|own| own.all_fixed);
        let longest = self.host_step_limit();
        let done = if all_fixed {
            let Some(own) = &mut self.device else { return Ok(()) };
            (own.host_is_current, own.loads_are_current) = (false, false);
            own.device.run(most, longest, pause, end)?
        } else {
            match self.body_step_on_device(longest, end, hook)? {
                Some(done) => done,
                None => return Ok(()),
            }
        };
        self.take_steps(&done)
    }

    /// One step of a scene whose solids move.
    fn body_step_on_device(&mut self, longest: f64, end: f64, hook: &mut Hook<D>) -> Result<Option<DeviceSteps>> {
        let Self { device: Some(own), system, bodies, clock, .. } = self else { return Ok(None) };
        (own.host_is_current, own.loads_are_current) = (false, true);
        let dt = match own.device.first_half(longest, end)? {
            Ok(dt) => dt,
            Err(done) => return Ok(Some(done)),
        };
        let over = Interval { t: clock.time, dt };
        if system.model().scheme == TimeScheme::Symplectic {
            drift_half_step(system, over);
        }
        let (done, loads) = own.device.second_half(system, end)?;
        system.solids.iter_mut().zip(loads).for_each(|(solid, load)| solid.load = load);
        if let StepsEnd::Fault(_) | StepsEnd::NoStep = done.end {
            return Ok(Some(done));
        }
        bodies.advance(system, over, done.weight, hook)?;
        own.device.move_solids(system);
        Ok(Some(done))
    }

    /// Counts the steps of a device, and stops at what it found.
    fn take_steps(&mut self, done: &DeviceSteps) -> Result<()> {
        self.clock.steps += done.steps;
        (self.clock.time, self.clock.dt) = (done.time, done.dt);
        self.system.count_device_passes(done.passes);
        match done.end {
            StepsEnd::Steps | StepsEnd::Time => self.remove_due(),
            StepsEnd::Fault(particle) => {
                self.fetch_from_device()?;
                self.guard()?;
                let cause = "The particle is at the rim of the valid range, which the device knows in single precision.";
                Err(self.fault((particle, ErrorCode::SpeedLimit, "a particle left the valid range", cause)))
            }
            StepsEnd::NoStep => {
                self.fetch_from_device()?;
                self.guard()?;
                Err(self.fault((0, ErrorCode::NoTimeStep, "time step of no length", super::NO_STEP)))
            }
        }
    }

    /// Stores a state for a rollback, if one is due.
    fn store_device_state(&mut self) -> Result<()> {
        if self.needs_rollback_state() {
            self.fetch_from_device()?;
            self.rollback.drop_oldest_state();
            let state: StoredState = self.rollback_state()?;
            self.rollback.store(self.clock.steps, self.clock.time, state);
            if let Some(own) = &mut self.device {
                own.next_state = self.clock.steps + STATE_EVERY;
            }
        }
        Ok(())
    }
}
