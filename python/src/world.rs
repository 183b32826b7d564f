//! A simulation of either dimension behind one trait, without Python.
//!
//! Vectors have three components here, of which a 2-D simulation uses two; axial vectors (spin, torque) have one in
//! 2-D and three in 3-D; rotations are row-major D×D matrices.

use std::{
    cell::RefCell,
    sync::atomic::{AtomicBool, Ordering},
    time::{Duration, Instant},
};

use pontoon::{
    Result,
    error::{Error, ErrorKind},
    math::{Bivector, Matrix, Pose, Vector},
    plan::Plan,
    probe::{MotionProbe, Probe, ProbeKind},
    scene::Scene,
    simulation::{AddedSolid, BodyStep, Dimension, Setup, Simulation},
    solid::{Dim, Kinematics, Load, MotorCommand, Role, Solid, SolidSpec, SpringParameters},
};

/// Position, motion and load of a solid.
#[derive(Clone, Copy, Debug, Default)]
pub struct BodyData {
    /// World position of the origin of its frame, m.
    pub position: [f64; 3],
    /// Rotation matrix of its frame.
    pub rotation: [f64; 9],
    /// World position of its centre, m.
    pub centre: [f64; 3],
    /// Velocity of its centre, m/s.
    pub velocity: [f64; 3],
    /// Spin, rad/s.
    pub spin: [f64; 3],
    /// Force of the water, N (N/m in 2-D), without weight.
    pub force: [f64; 3],
    /// Torque of the water about the centre, N m (N m/m in 2-D).
    pub torque: [f64; 3],
}

/// A force and a torque on a solid.
#[derive(Clone, Copy, Debug, Default)]
pub struct Push {
    /// Number of the solid.
    pub solid: usize,
    /// Force, N (N/m in 2-D).
    pub force: [f64; 3],
    /// Torque about its centre, N m (N m/m in 2-D).
    pub torque: [f64; 3],
}

/// The part of a step in which the bodies move, as a callback gets it.
#[derive(Clone, Debug, Default)]
pub struct StepData {
    /// Time at the start of the step, s.
    pub time: f64,
    /// Length of the step, s.
    pub dt: f64,
    /// The solids at the start of the step with the loads of the step.
    pub bodies: Vec<BodyData>,
    /// Coordinate, rate, motor force and energy that the motor took of each joint in the last step.
    pub joints: Vec<[f64; 4]>,
    /// Length (m), tension (N; N/m in 2-D), stiffness (N/m), damping (N s/m) and rest length (m) of each spring.
    pub springs: Vec<[f64; 5]>,
}

/// The commands that a callback returns.
#[derive(Clone, Debug, Default)]
pub struct Commands {
    /// Forces that act until the next call.
    pub pushes: Vec<Push>,
    /// Motors from the next step on, by number of the joint.
    pub motors: Vec<(usize, Option<MotorCommand>)>,
    /// Stiffness (N/m), damping (N s/m) and rest length (m) of springs from the next step on, by their numbers.
    pub springs: Vec<(usize, [Option<f64>; 3])>,
    /// Motion of bodies of another program at the end of the step; loads are not used.
    pub motions: Vec<(usize, BodyData)>,
    /// Whether the callback failed.
    pub failed: bool,
}

impl Commands {
    /// Removes all commands and keeps their memory.
    pub fn clear(&mut self) {
        self.pushes.clear();
        self.motors.clear();
        self.springs.clear();
        self.motions.clear();
        self.failed = false;
    }
}

/// A callback of a step: reads the step and writes its commands, which are empty before. It may leave other memory in their place.
pub type Callback<'a> = dyn FnMut(&mut StepData, &mut Commands) + Send + 'a;

/// A callback and the interval of its calls, s; 0 for each step.
pub struct Control<'a> {
    /// The function.
    pub call: &'a mut Callback<'a>,
    /// Interval, s.
    pub every: f64,
}

/// The arrays of the water: pointers to the numbers of `count` particles. They are valid until the next change.
#[derive(Clone, Copy)]
pub struct WaterArrays {
    /// Number of particles.
    pub count: usize,
    /// Positions, m: count × D.
    pub position: *const f64,
    /// Velocities, m/s: count × D.
    pub velocity: *const f64,
    /// Densities, kg/m³.
    pub density: *const f64,
    /// Names of the particles for life.
    pub id: *const u32,
}

/// Names of a world's solids, joints and springs.
#[derive(Clone, Debug, Default)]
pub struct Names {
    /// Solids and their roles: fixed, driven or free.
    pub solids: Vec<(String, &'static str)>,
    /// Joints.
    pub joints: Vec<String>,
    /// Springs.
    pub springs: Vec<String>,
    /// Dimension, 2 or 3.
    pub dimension: usize,
    /// Whether another program moves the free solids.
    pub hosted: bool,
}

/// A contact of two solids: their numbers, the normal force (N; N/m in 2-D), and the point of action (m).
pub type Contact = ([usize; 2], f64, [f64; 3]);

/// The reading of a probe: its name, its columns and their values.
pub type ProbeReading = (String, Vec<String>, Vec<f64>);

/// A running simulation of either dimension.
pub trait World: Send {
    /// Returns time (s), length of the last step (s), number of steps, and longest next step (s).
    fn clock(&self) -> (f64, f64, u64, f64);
    /// Returns the names of the solids.
    fn names(&self) -> Names;
    /// Goes on to time `end` (s), by one step if `single`; stops after a step when `stop` is set or a callback fails. The
    /// callback is called in the first step.
    fn advance(&mut self, end: f64, single: bool, stop: &AtomicBool, control: Option<Control<'_>>) -> Result<()>;
    /// Returns the solids with the loads of the last force pass.
    fn bodies(&self) -> Vec<BodyData>;
    /// Returns the mass (kg; kg/m in 2-D) of solid number `solid`, if it is free.
    fn mass(&self, solid: usize) -> Option<f64>;
    /// Returns the arrays of the water.
    fn water(&self) -> WaterArrays;
    /// Returns the pressures of the water, Pa.
    fn pressures(&self) -> Vec<f64>;
    /// Returns the accelerations of the water at the last force pass, m/s²: count × D.
    fn accelerations(&self) -> Vec<f64>;
    /// Returns columns and readings of the probes of `plan` now.
    fn read(&self, plan: &Plan) -> Result<Vec<ProbeReading>>;
    /// Returns columns and readings of the scene's own probes now.
    fn read_own(&self) -> Vec<ProbeReading>;
    /// Returns the contacts of the last step.
    fn contacts(&self) -> Vec<Contact>;
    /// Returns the descriptions of beginnings and ends of joints, springs, ropes and solids, and of rollbacks.
    fn events(&self) -> Vec<String>;
    /// Returns the wall time (s) of steps, neighbour lists, pairs, bodies and callbacks.
    fn time_spent(&self) -> [f64; 5];
    /// Returns the state.
    fn save(&self) -> Result<Vec<u8>>;
    /// Returns to a saved state.
    fn restore(&mut self, state: &[u8]) -> Result<()>;
    /// Adds the last solid of `scene` and returns the number of displaced particles.
    fn add_solid(&mut self, scene: &Scene) -> Result<usize>;
    /// Restores a state to whose simulation the last solid of each of `scenes` had been added.
    fn restore_with_added(&mut self, state: &[u8], scenes: &[Scene]) -> Result<()>;
    /// Removes a solid.
    fn remove_solid(&mut self, solid: usize) -> Result<()>;
    /// Pushes a free solid at a world point during the next step.
    fn push(&mut self, solid: usize, force: [f64; 3], at: Option<[f64; 3]>);
    /// Sets velocity (m/s) and spin (rad/s) of a free solid.
    fn set_velocity(&mut self, solid: usize, velocity: [f64; 3], spin: [f64; 3]);
    /// Returns coordinate, rate, motor force and energy that the motor took of joint number `joint`.
    fn joint(&self, joint: usize) -> [f64; 4];
    /// Drives a joint, or gives it back to its own motor.
    fn set_motor(&mut self, joint: usize, command: Option<MotorCommand>);
    /// Returns length (m) and tension (N; N/m in 2-D) of spring number `spring`.
    fn spring(&self, spring: usize) -> [f64; 2];
    /// Changes those of stiffness (N/m), damping (N s/m) and rest length (m) of spring number `spring` that are given, and
    /// returns all three.
    fn set_spring(&mut self, spring: usize, changes: [Option<f64>; 3]) -> [f64; 3];
}

/// A simulation with the probes of its scene.
struct Running<const D: usize> {
    sim: Simulation<D>,
    /// The scene, of which another probe reads the start.
    scene: Scene,
    /// The probes of the scene with their names.
    probes: Vec<(String, StartedProbe<D>)>,
    /// Probes that were read, and whose readings count from the start of the simulation.
    from_start: RefCell<Vec<StartedProbe<D>>>,
    /// Probes of the motion of each solid of the scene, whose displacements count from the start.
    motions: Vec<(String, MotionProbe<D>)>,
    /// Names of the joints and of the springs.
    constraints: [Vec<String>; 2],
    /// Whether the scene has a probe of load balances, of the energy budget.
    accounted: [bool; 2],
    pushes: Vec<Push>,
    /// What a callback sees, and its commands. All steps use the same memory.
    data: StepData,
    commands: Commands,
    /// When the callback was called last in this advance, and when it is due again, s.
    called: Option<[f64; 2]>,
    calls: Duration,
}

/// A probe that has read the start of the simulation, and its kind.
type StartedProbe<const D: usize> = (ProbeKind, Box<dyn Probe<D>>);

/// Builds the scene for bodies of the program, or of another program if `hosted`.
///
/// # Errors
/// As [`Scene::build`] and [`Simulation::new`].
pub fn build(scene: &Scene, hosted: bool) -> Result<Box<dyn World>> {
    match scene.dimension {
        2 => Ok(Box::new(Running::<2>::new(scene, hosted)?)),
        _ => Ok(Box::new(Running::<3>::new(scene, hosted)?)),
    }
}

/// Returns a vector of `D` components.
fn vector<const D: usize>(x: [f64; 3]) -> Vector<D> {
    Vector::from_fn(|i, _| x[i])
}

/// Returns three components, those beyond `D` zero.
fn three<const D: usize>(x: &Vector<D>) -> [f64; 3] {
    std::array::from_fn(|i| if i < D { x[i] } else { 0.0 })
}

/// Returns the axial components, at the start of three.
fn axial<const D: usize>(turn: &Bivector<D>) -> [f64; 3] {
    let mut all = [0.0; 3];
    all.iter_mut().zip(turn.axial()).for_each(|(to, from)| *to = from);
    all
}

fn body_data<const D: usize>(now: &Kinematics<D>, load: &Load<D>) -> BodyData {
    let mut rotation = [0.0; 9];
    (0..D * D).for_each(|k| rotation[k] = now.pose.rotation[(k / D, k % D)]);
    BodyData {
        position: three(&now.pose.position),
        rotation,
        centre: three(&now.centre),
        velocity: three(&now.velocity),
        spin: axial(&now.spin),
        force: three(&load.force),
        torque: axial(&load.torque),
    }
}

fn kinematics<const D: usize>(body: &BodyData) -> Kinematics<D> {
    Kinematics {
        pose: Pose { position: vector(body.position), rotation: Matrix::from_fn(|i, j| body.rotation[i * D + j]) },
        centre: vector(body.centre),
        velocity: vector(body.velocity),
        spin: Bivector::from_axial(&body.spin),
    }
}

fn role<const D: usize>(solid: &Solid<D>) -> &'static str {
    match solid.spec.role {
        Role::Fixed => "fixed",
        Role::Driven(_) => "driven",
        _ => "free",
    }
}

/// Coordinate, rate, motor force and energy that the motor took of joint number `joint`.
fn joint_numbers<const D: usize>(sim: &Simulation<D>, joint: usize) -> [f64; 4] {
    let reading = sim.joint_reading(joint);
    [reading.position, reading.rate, reading.motor_force, reading.absorbed_energy]
}

/// Length (m) and tension (N; N/m in 2-D) of spring number `spring`.
fn spring_numbers<const D: usize>(sim: &Simulation<D>, spring: usize) -> [f64; 2] {
    let reading = sim.spring_reading(spring);
    [reading.length, reading.tension]
}

/// Changes those of stiffness, damping and rest length that are given.
fn change_spring(now: &mut SpringParameters, [stiffness, damping, rest_length]: [Option<f64>; 3]) {
    now.stiffness = stiffness.unwrap_or(now.stiffness);
    now.damping = damping.unwrap_or(now.damping);
    now.rest_length = rest_length.unwrap_or(now.rest_length);
}

/// Returns the last solid of `scene`, in its place.
fn last_solid<const D: usize>(scene: &Scene) -> Result<SolidSpec<D>> {
    let mut solids = scene.layout::<D>()?.solids;
    solids.pop().ok_or_else(|| Error::new(ErrorKind::Usage, "the scene has no solid"))
}

impl<const D: usize> Running<D>
where
    Dim<D>: Dimension<D>,
{
    fn new(scene: &Scene, hosted: bool) -> Result<Self> {
        let built = scene.build::<D>()?;
        let ties = &built.setup.constraints;
        let joints = ties.joints.iter().map(|joint| joint.name.clone()).collect();
        let constraints = [joints, ties.springs.iter().map(|spring| spring.name.clone()).collect()];
        let mut sim = simulation(scene, built.setup, hosted)?;
        let kinds = || built.plan.probes.iter().map(|probe| &probe.kind);
        kinds().for_each(|kind| kind.enable_records(&mut sim));
        let accounted = [
            kinds().any(|kind| matches!(kind, ProbeKind::Balance(_))),
            kinds().any(|kind| matches!(kind, ProbeKind::Budget(_))),
        ];
        let started = |kind: &ProbeKind| Ok((kind.clone(), kind.build(sim.system())?));
        let probes = built.plan.probes.iter().map(|probe| Ok((probe.name.clone(), started(&probe.kind)?)));
        let probes = probes.collect::<Result<_>>()?;
        let names = sim.system().solids().iter().map(|solid| solid.spec.name.clone());
        let motions = names.map(|name| Ok((name.clone(), MotionProbe::new(sim.system(), &name)?)));
        let motions = motions.collect::<Result<_>>()?;
        let (scene, from_start) = (scene.clone(), RefCell::default());
        let (pushes, data, commands) = (Vec::new(), StepData::default(), Commands::default());
        let (called, calls) = (None, Duration::ZERO);
        Ok(Self {
            sim,
            scene,
            probes,
            from_start,
            motions,
            constraints,
            accounted,
            pushes,
            data,
            commands,
            called,
            calls,
        })
    }

    /// Returns whether readings of this kind refer to the start of the simulation: to a level, an energy or the place of a patch.
    /// Motions do so too; each solid of the scene has a probe of its own. A solid that was added later is not there at the start.
    fn counts_from_start(&self, kind: &ProbeKind) -> bool {
        let solid = match kind {
            ProbeKind::Energy(_) => None,
            ProbeKind::Elevation(plan) => plan.on.as_ref(),
            ProbeKind::Runup(plan) => Some(&plan.solid),
            ProbeKind::Patch(plan) => Some(&plan.solid),
            _ => return false,
        };
        solid.is_none_or(|solid| self.motions.iter().any(|(name, _)| name == solid))
    }

    /// Returns columns and readings now of a probe of this kind, whose readings count from the start of the simulation. If no
    /// such probe has read the start, it reads that of the scene, which is built anew.
    fn read_from_start(&self, kind: &ProbeKind) -> Result<(Vec<String>, Vec<f64>)> {
        if let Some((_, (_, probe))) = self.probes.iter().find(|(_, (known, _))| known == kind) {
            return Ok((probe.columns(), probe.sample(&self.sim)));
        }
        let mut known = self.from_start.borrow_mut();
        let i = match known.iter().position(|(known, _)| known == kind) {
            Some(i) => i,
            None => {
                let probe = match self.sim.steps() {
                    0 => kind.build(self.sim.system())?,
                    _ => {
                        let setup = self.scene.build::<D>()?.setup;
                        kind.build(simulation(&self.scene, setup, self.sim.has_external_bodies())?.system())?
                    }
                };
                known.push((kind.clone(), probe));
                known.len() - 1
            }
        };
        let probe = &known[i].1;
        Ok((probe.columns(), probe.sample(&self.sim)))
    }
}

/// Returns the simulation of `setup`, which is that of the scene.
fn simulation<const D: usize>(scene: &Scene, setup: Setup<D>, hosted: bool) -> Result<Simulation<D>>
where
    Dim<D>: Dimension<D>,
{
    let made = if hosted { Simulation::with_external_bodies(setup) } else { Simulation::new(setup) };
    made.map_err(|error| scene.with_location(error))
}

impl<const D: usize> Running<D>
where
    Dim<D>: Dimension<D>,
{
    /// Writes what a callback sees at the start of a step, without time and loads. In the step itself the solids are already half
    /// a step on.
    fn read_start(&mut self) {
        let Self { sim, data, constraints: [joints, springs], .. } = self;
        data.bodies.clear();
        data.bodies.extend(sim.system().solids().iter().map(|solid| body_data(&solid.kinematics, &solid.load)));
        data.joints.clear();
        data.joints.extend((0..joints.len()).map(|i| joint_numbers(sim, i)));
        data.springs.clear();
        data.springs.extend((0..springs.len()).map(|i| {
            let ([length, tension], now) = (spring_numbers(sim, i), sim.spring_parameters(i));
            [length, tension, now.stiffness, now.damping, now.rest_length]
        }));
    }

    /// Calls the callback with the loads of the step, and takes the motions of bodies that another program moves.
    fn call(step: &mut BodyStep<D>, data: &mut StepData, commands: &mut Commands, call: &mut Callback<'_>) {
        for (body, load) in data.bodies.iter_mut().zip(step.loads()) {
            (body.force, body.torque) = (three(&load.force), axial(&load.torque));
        }
        (data.time, data.dt) = (step.time(), step.dt());
        call(data, commands);
        for (solid, motion) in &commands.motions {
            step.solids[*solid] = kinematics(motion);
        }
    }

    /// Goes one step on with a callback; returns whether the callback failed.
    fn step_with(&mut self, end: f64, control: &mut Control<'_>) -> Result<bool> {
        let now = self.sim.time();
        // A rollback takes the clock back, and a call is due again.
        let begun = self.called.filter(|[last, _]| now >= *last);
        let mut due = begun.is_none_or(|[_, next]| now >= next - 1e-9 * control.every);
        if due {
            // Calls are due at multiples of the interval after the first one; those within this step are left out.
            let passed = begun.map_or(0.0, |[_, next]| ((now - next) / control.every).max(0.0).floor());
            let first = begun.map_or(now, |[_, next]| next);
            self.called = Some([now, first + control.every * (1.0 + if passed.is_finite() { passed } else { 0.0 })]);
            self.read_start();
        }
        self.commands.clear();
        let Self { sim, data, commands, pushes, calls, .. } = self;
        let hosted = sim.has_external_bodies();
        sim.step_with(end, |step| {
            let begun = due.then(Instant::now);
            if std::mem::take(&mut due) {
                Self::call(step, data, commands, control.call);
                std::mem::swap(pushes, &mut commands.pushes);
            }
            for push in pushes.iter() {
                let load = Load { force: vector(push.force), torque: Bivector::from_axial(&push.torque) };
                step.push(push.solid, &load);
            }
            *calls += begun.map_or(Duration::ZERO, |begun| begun.elapsed());
            if commands.failed && hosted {
                return Err(Error::new(ErrorKind::Usage, "the callback failed: the bodies have no motion"));
            }
            Ok(())
        })?;
        for (joint, command) in commands.motors.drain(..) {
            sim.set_motor(joint, command);
        }
        for (spring, changes) in commands.springs.drain(..) {
            change_spring(sim.spring_parameters(spring), changes);
        }
        Ok(commands.failed)
    }
}

impl<const D: usize> World for Running<D>
where
    Dim<D>: Dimension<D>,
{
    fn clock(&self) -> (f64, f64, u64, f64) {
        (self.sim.time(), self.sim.dt(), self.sim.steps(), self.sim.step_limit())
    }

    fn names(&self) -> Names {
        let solids = self.sim.system().solids().iter().map(|solid| (solid.spec.name.clone(), role(solid))).collect();
        let [joints, springs] = self.constraints.clone();
        Names { solids, joints, springs, dimension: D, hosted: self.sim.has_external_bodies() }
    }

    fn advance(&mut self, end: f64, single: bool, stop: &AtomicBool, control: Option<Control<'_>>) -> Result<()> {
        let mut control = control;
        self.called = None;
        self.pushes.clear();
        while self.sim.time() < end && !stop.load(Ordering::Relaxed) {
            let failed = match &mut control {
                Some(control) => self.step_with(end, control)?,
                None => self.sim.step_to(end).map(|()| false)?,
            };
            if single || failed {
                break;
            }
        }
        Ok(())
    }

    fn bodies(&self) -> Vec<BodyData> {
        self.sim.system().solids().iter().map(|solid| body_data(&solid.kinematics, &solid.load)).collect()
    }

    fn mass(&self, solid: usize) -> Option<f64> {
        self.sim.system().solids().get(solid)?.body.map(|body| body.mass)
    }

    fn water(&self) -> WaterArrays {
        let fluid = self.sim.system().fluid();
        WaterArrays {
            count: fluid.len(),
            position: fluid.r.as_ptr().cast(),
            velocity: fluid.v.as_ptr().cast(),
            density: fluid.rho.as_ptr(),
            id: fluid.id.as_ptr(),
        }
    }

    fn pressures(&self) -> Vec<f64> {
        let system = self.sim.system();
        system.fluid().rho.iter().map(|rho| system.pressure(*rho)).collect()
    }

    fn accelerations(&self) -> Vec<f64> {
        let system = self.sim.system();
        (0..system.fluid().len()).flat_map(|i| three(&system.fluid_acceleration(i)).into_iter().take(D)).collect()
    }

    fn read(&self, plan: &Plan) -> Result<Vec<ProbeReading>> {
        let read = |probe: &pontoon::scene::ProbePlan| {
            let missing = match probe.kind {
                ProbeKind::Balance(_) => !self.accounted[0],
                ProbeKind::Budget(_) => !self.accounted[1],
                _ => false,
            };
            if missing {
                let key = probe.kind.key();
                let what = format!("a probe of {key} reads records that this simulation does not keep");
                let help = "put the probe into the scene before it is built: its records begin with the simulation";
                return Err(Error::new(ErrorKind::Usage, what).help(help));
            }
            let from_start = match &probe.kind {
                ProbeKind::Motion(plan) => self.motions.iter().find(|(solid, _)| *solid == plan.solid),
                _ => None,
            };
            let (columns, values) = match from_start {
                Some((_, motion)) => (motion.columns(), motion.sample(&self.sim)),
                None if self.counts_from_start(&probe.kind) => self.read_from_start(&probe.kind)?,
                None => {
                    let built = probe.kind.build(self.sim.system())?;
                    (built.columns(), built.sample(&self.sim))
                }
            };
            Ok((probe.name.clone(), columns, values))
        };
        plan.probes.iter().map(read).collect()
    }

    fn read_own(&self) -> Vec<ProbeReading> {
        let read =
            |(name, (_, probe)): &(String, StartedProbe<D>)| (name.clone(), probe.columns(), probe.sample(&self.sim));
        self.probes.iter().map(read).collect()
    }

    fn contacts(&self) -> Vec<Contact> {
        self.sim.contacts().iter().map(|contact| (contact.between, contact.normal_force, three(&contact.at))).collect()
    }

    fn events(&self) -> Vec<String> {
        let rollbacks = self.sim.rollbacks().iter().map(ToString::to_string);
        self.sim.events().iter().map(ToString::to_string).chain(rollbacks).collect()
    }

    fn time_spent(&self) -> [f64; 5] {
        let spent = self.sim.time_spent();
        [spent.steps, spent.lists, spent.pairs, spent.bodies, self.calls].map(|time| time.as_secs_f64())
    }

    fn save(&self) -> Result<Vec<u8>> {
        self.sim.save()
    }

    fn restore(&mut self, state: &[u8]) -> Result<()> {
        self.sim.restore(state)
    }

    fn add_solid(&mut self, scene: &Scene) -> Result<usize> {
        let AddedSolid { displaced, .. } = self.sim.add_solid(last_solid(scene)?)?;
        Ok(displaced)
    }

    fn restore_with_added(&mut self, state: &[u8], scenes: &[Scene]) -> Result<()> {
        let added = scenes.iter().map(last_solid).collect::<Result<_>>()?;
        self.sim.restore_with_added_solids(state, added)
    }

    fn remove_solid(&mut self, solid: usize) -> Result<()> {
        self.sim.remove_solid(solid)
    }

    fn push(&mut self, solid: usize, force: [f64; 3], at: Option<[f64; 3]>) {
        let at = at.map_or_else(|| self.sim.system().solids()[solid].kinematics.centre, vector);
        self.sim.push(solid, &vector(force), &at);
    }

    fn set_velocity(&mut self, solid: usize, velocity: [f64; 3], spin: [f64; 3]) {
        self.sim.set_velocity(solid, &vector(velocity), &Bivector::from_axial(&spin));
    }

    fn joint(&self, joint: usize) -> [f64; 4] {
        joint_numbers(&self.sim, joint)
    }

    fn set_motor(&mut self, joint: usize, command: Option<MotorCommand>) {
        self.sim.set_motor(joint, command);
    }

    fn spring(&self, spring: usize) -> [f64; 2] {
        spring_numbers(&self.sim, spring)
    }

    fn set_spring(&mut self, spring: usize, changes: [Option<f64>; 3]) -> [f64; 3] {
        let now = self.sim.spring_parameters(spring);
        change_spring(now, changes);
        [now.stiffness, now.damping, now.rest_length]
    }
}
