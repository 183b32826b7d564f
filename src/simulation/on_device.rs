//! A simulation whose water is on a device.

use std::time::Instant;

use super::{Simulation, accounting::change_gravity_of_bodies};
use crate::{
    coupling::{Accounting, AcousticAddedMass, Bodies, DevicePass, Hook, Interval, drift_half_step},
    device::{Adapter, Device, DeviceSteps, MeasuredPowers, SecondHalf, StepRequest, StepsEnd, WaterReads, refused},
    error::{ErrorCode, Result},
    interaction::{PairSums, StepLimits},
    math::{Bounds, Pose, Vector},
    model::TimeScheme,
    solid::{Role, Solid},
    system::{
        System, device_films, device_state, has_water_beside, squeezed_water,
        thin_faces::{self, has_thin_faces},
    },
};

/// The water of a simulation on a device.
pub(super) struct OnDevice<const D: usize> {
    device: Device<D>,
    /// Whether the host has the device's state.
    host_is_current: bool,
    /// Whether the loads of the solids are those of the last force pass.
    loads_are_current: bool,
    /// Whether the host has the sums of the boundary particles in the last force pass.
    sums_are_current: bool,
    /// Whether the host changes nothing between two outputs: no solid moves, no thin part pushes water, and gravity is constant.
    runs_alone: bool,
    /// Numbers of the solids whose boundary particles the host places too.
    watched_solids: Vec<usize>,
    /// Boxes (m) around the thin parts of each solid, in its frame, whose faces push water.
    thin_boxes: Vec<Vec<Bounds<D>>>,
    /// Poses of the solids at which films were found; `None` if they are to be found.
    poses_of_films: Option<Vec<Pose<D>>>,
    /// Steps after which a state for a rollback is stored.
    next_state: u64,
    /// Whether the state of the host was changed by hand, and must go to the device.
    pub(super) host_changed: bool,
    /// Whether solids were added or removed, so that the device needs other arrays.
    solids_changed: bool,
}

impl<const D: usize> OnDevice<D> {
    /// The device.
    pub(super) fn adapter(&self) -> &Adapter {
        self.device.adapter()
    }

    /// How often the host has waited for the device.
    pub(super) fn waits(&self) -> u64 {
        self.device.waits()
    }

    /// The host's state is no longer that of the device.
    fn leave_host_behind(&mut self) {
        (self.host_is_current, self.loads_are_current, self.sums_are_current) = (false, false, false);
    }

    /// Memory of its arrays, B: all, and of these the neighbour lists.
    pub(super) fn memory(&self) -> [u64; 2] {
        self.device.memory_bytes()
    }

    /// Places the solids with films on the host, and lets the device read the boundary particles of these films in the next force pass.
    fn update_films(&mut self, system: &mut System<D>) -> Result<()> {
        match device_films::update(system, &mut self.poses_of_films) {
            Some(particles) => self.device.set_film_particles(particles),
            None => Ok(()),
        }
    }

    /// Whether a state for a rollback is due after `steps` steps.
    pub(super) fn needs_state(&self, steps: u64) -> bool {
        steps >= self.next_state
    }
}

/// Steps from one state for a rollback to the next.
const STATE_EVERY: u64 = 500;

/// Places the water of the simulation on the device `name`: the number of an adapter, `gpu` for the first graphics card, or part
/// of an adapter's name; see [`crate::device::adapters`].
///
/// [`Simulation::step`] then brings the state back after each step, [`run`](crate::run) only when an output is due.
///
/// # Errors
/// `Usage` if there is no such device, or if the simulation has something that no device computes yet: the message says which,
/// and the remedy.
pub(super) fn place<const D: usize>(mut sim: Simulation<D>, name: &str) -> Result<Simulation<D>> {
    refuse_unsupported(&sim)?;
    let own = own_device(&sim, name)?;
    device_state::leave_to_device(&mut sim.system);
    sim.device = Some(own);
    Ok(sim)
}

/// The water of `sim` on the device `name`.
fn own_device<const D: usize>(sim: &Simulation<D>, name: &str) -> Result<OnDevice<D>> {
    let light = sim.bodies.added_masses().iter().flat_map(AcousticAddedMass::outer_particles);
    let mut watched: Vec<u32> = light.chain(device_state::thin_particles(&sim.system)).collect();
    watched.sort_unstable();
    watched.dedup();
    let mut watched_solids: Vec<usize> =
        watched.iter().map(|i| device_state::solid_of_boundary(&sim.system, *i as usize)).collect();
    watched_solids.dedup();
    let absorbs = |solid: &Solid<D>| matches!(&solid.spec.role, Role::Driven(motion) if motion.absorber().is_some());
    let moored = !sim.bodies.moorings.is_empty();
    let pushes = has_thin_faces(&sim.system) || device_films::may_be(&sim.system);
    let near = moored || pushes || !sim.bodies.added_masses().is_empty() || sim.system.solids().iter().any(absorbs);
    let offset_rows = if device_state::has_hollows(&sim.system) { D } else { 0 };
    let powers = sim.bodies.accounting.as_ref().is_some_and(Accounting::reads_water);
    let reads = WaterReads { near, watched, offset_rows, powers };
    let device = Device::new(name, &sim.system, &sim.stepper, sim.clock.time, reads)?;
    let all_fixed = sim.system.solids().iter().all(|solid| matches!(solid.spec.role, Role::Fixed));
    let runs_alone = !moored && !pushes && all_fixed && !device_state::gravity_changes(&sim.system);
    Ok(OnDevice {
        device,
        host_is_current: true,
        loads_are_current: true,
        sums_are_current: true,
        runs_alone,
        watched_solids,
        thin_boxes: thin_faces::boxes(&sim.system),
        poses_of_films: None,
        next_state: 0,
        host_changed: false,
        solids_changed: false,
    })
}

/// Refuses a simulation with something that no device computes yet.
fn refuse_unsupported<const D: usize>(sim: &Simulation<D>) -> Result<()> {
    if sim.custom_terms { Err(refused("pair terms of your own")) } else { Ok(()) }
}

/// Makes a force pass on the device at the present state; returns acceleration (m/s²) and rate of the excess density (1/s) of each
/// water particle, and the largest values that limit a step. For comparisons.
pub(super) fn rates<const D: usize>(sim: &mut Simulation<D>) -> Result<Option<(Vec<PairSums<D>>, StepLimits)>> {
    let Simulation { device: Some(own), system, .. } = sim else { return Ok(None) };
    own.update_films(system)?;
    let rates = own.device.rates(system)?;
    let loads = own.device.loads(system)?;
    device_state::set_loads(system, loads);
    own.sums_are_current = false;
    Ok(Some(rates))
}

/// Gives a restored state of the host to the device.
pub(super) fn restore<const D: usize>(sim: &mut Simulation<D>) -> Result<()> {
    device_state::set_boundary_sums(&mut sim.system, None);
    load(sim)
}

/// Notes that a solid was added or removed on the host.
pub(super) fn note_other_solids<const D: usize>(sim: &mut Simulation<D>) {
    if let Some(own) = &mut sim.device {
        (own.host_changed, own.solids_changed) = (true, true);
        device_state::set_boundary_sums(&mut sim.system, None);
    }
}

/// Gives the state of the host, which was changed, to the device.
fn load<const D: usize>(sim: &mut Simulation<D>) -> Result<()> {
    if sim.device.as_ref().is_some_and(|own| own.solids_changed) {
        return replace_device(sim);
    }
    let Simulation { device: Some(own), system, stepper, clock, .. } = sim else { return Ok(()) };
    device_state::place_solids(system);
    own.device.load(system, stepper, clock.time)?;
    (own.host_is_current, own.loads_are_current, own.sums_are_current) = (true, true, true);
    own.host_changed = false;
    own.poses_of_films = None;
    own.next_state = own.next_state.min(clock.steps + STATE_EVERY);
    Ok(())
}

/// Gives the state of the host to new arrays on the device.
fn replace_device<const D: usize>(sim: &mut Simulation<D>) -> Result<()> {
    if let Some(number) = sim.device.as_ref().map(|own| own.adapter().number) {
        device_state::place_solids(&mut sim.system);
        sim.device = Some(own_device(sim, &number.to_string())?);
    }
    Ok(())
}

/// Brings the state of the water back from the device, if one has it.
///
/// # Errors
/// `Usage` if the device failed.
pub(super) fn fetch<const D: usize>(sim: &mut Simulation<D>) -> Result<()> {
    fetch_loads(sim)?;
    let Simulation { device: Some(own), system, stepper, .. } = sim else { return Ok(()) };
    if !std::mem::replace(&mut own.host_is_current, true) {
        own.device.fetch(system, stepper)?;
    }
    Ok(())
}

/// Brings the sums of the boundary particles in the last force pass back.
pub(super) fn fetch_boundary_sums<const D: usize>(sim: &mut Simulation<D>) -> Result<()> {
    let Simulation { device: Some(own), system, .. } = sim else { return Ok(()) };
    if !std::mem::replace(&mut own.sums_are_current, true) {
        device_state::set_boundary_sums(system, Some(own.device.boundary_sums()?));
    }
    Ok(())
}

/// Brings the loads on the solids back.
pub(super) fn fetch_loads<const D: usize>(sim: &mut Simulation<D>) -> Result<()> {
    let Simulation { device: Some(own), system, .. } = sim else { return Ok(()) };
    if !std::mem::replace(&mut own.loads_are_current, true) {
        let loads = own.device.loads(system)?;
        device_state::set_loads(system, loads);
    }
    Ok(())
}

/// Advances as [`advance`], and rolls back to a valid state at the first alarm.
pub(super) fn steps<const D: usize>(
    sim: &mut Simulation<D>,
    most: (u64, f64),
    end: f64,
    hook: Option<&mut Hook<D>>,
) -> Result<()> {
    let start = Instant::now();
    refuse_unsupported(sim)?;
    measure_powers(sim)?;
    if sim.device.as_ref().is_some_and(|own| own.host_changed) {
        load(sim)?;
    }
    store_state(sim)?;
    let outcome = advance(sim, most, end, hook).or_else(|error| sim.roll_back(error));
    sim.stepping += start.elapsed();
    outcome
}

/// Lets the device measure powers, if an accounting that reads the water has begun since the water went to the device.
fn measure_powers<const D: usize>(sim: &mut Simulation<D>) -> Result<()> {
    let reads_water = sim.bodies.accounting.as_ref().is_some_and(Accounting::reads_water);
    if !reads_water || sim.device.as_ref().is_none_or(|own| own.device.measures_powers()) {
        return Ok(());
    }
    fetch(sim)?;
    fetch_boundary_sums(sim)?;
    replace_device(sim)
}

/// The powers that the next step of `bodies` measures.
fn due_powers<const D: usize>(bodies: &Bodies<D>) -> MeasuredPowers {
    match &bodies.accounting {
        Some(accounting) if accounting.needs_breakdown() => MeasuredPowers::Breakdown,
        Some(accounting) if accounting.has_energy_budget() => MeasuredPowers::Total,
        _ => MeasuredPowers::None,
    }
}

/// The sum of the places (m) of the water, if the energy budget reads it when gravity changes; else zero.
fn place_sum<const D: usize>(device: &Device<D>, system: &System<D>, bodies: &Bodies<D>) -> Result<Vector<D>> {
    let is_read = bodies.accounting.as_ref().is_some_and(Accounting::has_energy_budget);
    if is_read && device_state::gravity_changes(system) { device.place_sum() } else { Ok(Vector::zeros()) }
}

/// Sets gravity to that of time `t` (s), if it changes; the places of the water add up to `places` (m).
fn change_gravity<const D: usize>(system: &mut System<D>, bodies: &mut Bodies<D>, t: f64, places: &Vector<D>) {
    let Some(change) = change_gravity_of_bodies(system, bodies, t) else { return };
    if let Some(accounting) = &mut bodies.accounting {
        accounting.add_gravity_change(system, &change, || system.non_periodic(&change).dot(places));
    }
}

/// Advances by up to `most` steps until time `pause` (s) is reached, not past `end` (s); the state stays on the device. Makes
/// only one step if the host has a part in it, or there is a `hook` or an accounting.
fn advance<const D: usize>(
    sim: &mut Simulation<D>,
    (most, pause): (u64, f64),
    end: f64,
    hook: Option<&mut Hook<D>>,
) -> Result<()> {
    let runs_alone = sim.device.as_ref().is_some_and(|own| own.runs_alone);
    let factor = sim.rollback.step_factor(sim.clock.time);
    let request = StepRequest { longest: sim.host_step_limit(), factor, pause, end };
    let done = if runs_alone && hook.is_none() && sim.bodies.accounting.is_none() {
        // A solid that is removed ends the last step before.
        let event = sim.clock.time + sim.bodies.constraints().next_event(sim.clock.time);
        let Some(own) = &mut sim.device else { return Ok(()) };
        own.leave_host_behind();
        own.device.run(most, &StepRequest { end: end.min(event), ..request })?
    } else {
        let request = StepRequest { pause: f64::INFINITY, ..request };
        let done = match hook {
            Some(hook) => body_step(sim, &request, hook)?,
            None => body_step(sim, &request, &mut |_| Ok(()))?,
        };
        let Some(done) = done else { return Ok(()) };
        done
    };
    take_steps(sim, &done)
}

/// One step between whose halves the host acts: solids move, thin parts push water, gravity changes, or powers are measured.
fn body_step<const D: usize>(
    sim: &mut Simulation<D>,
    request: &StepRequest,
    hook: &mut Hook<D>,
) -> Result<Option<DeviceSteps>> {
    let Simulation { device: Some(own), system, bodies, clock, stepper, .. } = sim else { return Ok(None) };
    own.leave_host_behind();
    own.loads_are_current = true;
    let start: Vec<_> = system.solids.iter().map(|solid| solid.kinematics).collect();
    let gauges = device_state::with_originals(system, system.absorption_ranges(clock.time));
    let measured = due_powers(bodies);
    let places = place_sum(&own.device, system, bodies)?;
    let (over, SecondHalf { done, loads, powers, near }) = loop {
        let first = match own.device.first_half(request, &gauges)? {
            Ok(first) => first,
            Err(done) => return Ok(Some(done)),
        };
        let over = Interval { t: clock.time, dt: first.dt };
        if !gauges.is_empty() {
            device_state::take_near(system, first.near);
            system.update_absorption(over.t);
        }
        change_gravity(system, bodies, over.t + 0.5 * over.dt, &places);
        if system.model().scheme == TimeScheme::Symplectic {
            drift_half_step(system, over);
            own.device.write_gravity(system);
        }
        own.watched_solids.iter().for_each(|solid| device_state::place_solid(system, *solid));
        own.update_films(system)?;
        let mut ranges = bodies.water_ranges(system, over);
        ranges.extend(thin_faces::ranges_beside(system, &own.thin_boxes));
        ranges.extend(squeezed_water::ranges(system));
        let ranges = device_state::with_originals(system, ranges);
        if let Some(second) = own.device.second_half(system, request.end, &ranges, measured)? {
            break (over, second);
        }
        system.solids.iter_mut().zip(&start).for_each(|(solid, start)| solid.kinematics = *start);
        change_gravity(system, bodies, over.t, &places);
        own.device.move_solids(system);
    };
    let films = device_state::set_loads(system, loads);
    if let StepsEnd::Fault(_) | StepsEnd::NoStep = done.end {
        return Ok(Some(done));
    }
    if let Some(accounting) = &mut bodies.accounting {
        let mut pass = powers.unwrap_or_else(DevicePass::unmeasured);
        let pressure = pass.pressure.iter_mut().chain(&mut pass.plain);
        pressure.for_each(|(_, loads)| device_state::complete_loads(system, &films, loads));
        accounting.add_device_pass(system, over.dt, pass);
    }
    let pushes = has_thin_faces(system) || squeezed_water::flows(system);
    if bodies.read_water() || pushes {
        device_state::take_near(system, near);
        if pushes {
            thin_faces::find_known_water(system);
            if let Some((pushed, impulses)) = thin_faces::repel(system, over.dt, done.weight) {
                let accounting = bodies.accounting.iter_mut();
                accounting.for_each(|accounting| accounting.add_repelled(system, pushed.energy, &impulses));
                own.device.change_velocities(&device_state::velocity_changes(system, &[pushed]))?;
            }
        }
        if reads_all_water(system, bodies) {
            own.device.fetch(system, stepper)?;
        }
    }
    let transfers = bodies.advance(system, over, done.weight, hook)?;
    own.device.change_velocities(&device_state::velocity_changes(system, &transfers))?;
    if device_state::holds_current(system) {
        let sum = own.device.velocity_sum()?;
        device_state::adapt_current(system, &sum, over.dt);
    }
    let places = place_sum(&own.device, system, bodies)?;
    change_gravity(system, bodies, done.time, &places);
    bodies.update_masses(system, done.time, over.dt)?;
    own.device.write_gravity(system);
    own.device.move_solids(system);
    Ok(Some(done))
}

/// Whether bodies read water outside the boxes of [`Bodies::water_ranges`]: a light body that has left the water returns its pending
/// impulse to it.
fn reads_all_water<const D: usize>(system: &System<D>, bodies: &Bodies<D>) -> bool {
    bodies.added_masses().iter().any(|own| own.was_wet() && !has_water_beside(system, own.solid()))
}

/// Removes the water that has left the domain on the host, and loads the remaining water onto the device.
fn remove_escaped<const D: usize>(sim: &mut Simulation<D>) -> Result<()> {
    fetch(sim)?;
    fetch_boundary_sums(sim)?;
    device_state::ask_for_lists(&mut sim.system);
    sim.rebuild_neighbours();
    load(sim)
}

/// Removes the solids whose time is over on the host, and gives the rest to the device.
fn remove_due<const D: usize>(sim: &mut Simulation<D>) -> Result<()> {
    let is_there = |solid: usize| !sim.system.solids()[solid].boundary.is_empty();
    if sim.bodies.constraints().due_removals(sim.clock.time).any(is_there) {
        fetch(sim)?;
        sim.remove_due()?;
        load(sim)?;
    }
    Ok(())
}

/// Counts the steps of a device, and handles the event that ended them.
fn take_steps<const D: usize>(sim: &mut Simulation<D>, done: &DeviceSteps) -> Result<()> {
    sim.clock.steps += done.steps;
    (sim.clock.time, sim.clock.dt) = (done.time, done.dt);
    device_state::count_device_passes(&mut sim.system, done.passes);
    match done.end {
        StepsEnd::Steps | StepsEnd::Time => remove_due(sim),
        StepsEnd::Escape => {
            remove_escaped(sim)?;
            remove_due(sim)
        }
        StepsEnd::Fault(particle) => {
            fetch(sim)?;
            sim.guard()?;
            let cause = "The particle is at the rim of the valid range, which the device knows in single precision.";
            Err(sim.fault((particle, ErrorCode::SpeedLimit, "a particle left the valid range", cause)))
        }
        StepsEnd::NoStep => {
            fetch(sim)?;
            sim.guard()?;
            Err(sim.fault((0, ErrorCode::NoTimeStep, "time step of no length", super::NO_STEP)))
        }
    }
}

/// Stores a state for a rollback, if one is due.
fn store_state<const D: usize>(sim: &mut Simulation<D>) -> Result<()> {
    if sim.needs_rollback_state() {
        fetch(sim)?;
        sim.rollback.drop_oldest_state();
        let state = sim.rollback_state()?;
        sim.rollback.store(sim.clock.steps, sim.clock.time, state);
        if let Some(own) = &mut sim.device {
            own.next_state = sim.clock.steps + STATE_EVERY;
        }
    }
    Ok(())
}
