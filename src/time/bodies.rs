//! Moving the solids: driven ones by their law, free ones by rapier, and then their skins.

use std::time::{Duration, Instant};

use super::{Books, Held, Interval, Light, books::Moved};
use crate::{
    error::{Error, Fault, Result},
    solid::{Engine, EngineFault, Kinematics, Load, Role, Solid, rig::Rig},
    space::{Pose, Vector},
    system::System,
};

/// The rigid-body side of a run. A scene without free bodies has no engine and steps none.
pub struct Bodies<const D: usize> {
    engine: Option<Box<dyn Engine<D>>>,
    light: Vec<Light<D>>,
    rig: Rig<D>,
    pub(crate) books: Option<Books<D>>,
    steps: u64,
    spent: Duration,
}

impl<const D: usize> Bodies<D> {
    /// The bodies that `engine` moves, at the start, those of them that are `light` with care, tied by `rig`.
    pub(crate) fn new(engine: Option<Box<dyn Engine<D>>>, light: Vec<Light<D>>, rig: Rig<D>) -> Self {
        Self { engine, light, rig, books: None, steps: 0, spent: Duration::ZERO }
    }

    /// What ties the bodies.
    pub(crate) fn rig(&self) -> &Rig<D> {
        &self.rig
    }

    /// What ties the bodies, to be changed.
    pub(crate) fn rig_mut(&mut self) -> &mut Rig<D> {
        &mut self.rig
    }

    /// The longest step (s) that springs and motors allow at time `t` (s).
    pub(crate) fn limit(&self, system: &System<D>, t: f64) -> f64 {
        match self.engine.as_deref().filter(|_| !self.rig.is_empty()) {
            Some(engine) => self.rig.limit(engine, &whereabouts(system, engine, t), t),
            None => f64::INFINITY,
        }
    }

    /// What of the light bodies must be kept to go on to the same bits.
    pub(crate) fn held(&self) -> Vec<Held> {
        self.light.iter().map(Light::held).collect()
    }

    /// Goes back to what was kept; says whether it is of these bodies.
    pub(crate) fn restore(&mut self, held: &[Held]) -> bool {
        self.light.iter_mut().zip(held).for_each(|(light, held)| light.restore(*held));
        self.light.len() == held.len()
    }

    /// Time spent in the engine so far.
    pub fn spent(&self) -> Duration {
        self.spent
    }

    /// Impulse (N s) that the water has given to `solid` and that it has yet to get.
    pub(crate) fn withheld(&self, solid: usize) -> Vector<D> {
        self.light.iter().find(|light| light.solid == solid).map_or_else(Vector::zeros, Light::withheld)
    }

    /// The engine, if there are free bodies.
    pub fn engine(&self) -> Option<&dyn Engine<D>> {
        self.engine.as_deref()
    }

    /// The engine to act on, if there are free bodies.
    pub fn engine_mut(&mut self) -> Option<&mut Box<dyn Engine<D>>> {
        self.engine.as_mut()
    }

    /// Books what the water does at a force pass whose rates hold for `dt` (s), if there are books.
    pub(super) fn book_water(&mut self, system: &mut System<D>, dt: f64) {
        if let Some(books) = &mut self.books {
            books.water(system, dt);
        }
    }

    /// Books that the water was moved by `shifts` (m), if there are books.
    pub(super) fn book_shifts(&mut self, system: &System<D>, shifts: &[Vector<D>]) {
        if let Some(books) = &mut self.books {
            books.shifted(system, shifts);
        }
    }

    /// Puts the solids where they will be half a step on: driven ones exactly, free ones as they drift.
    pub(super) fn drift(&self, system: &mut System<D>, over: Interval) {
        let half = 0.5 * over.dt;
        place(system, None, |_, solid| match &solid.spec.role {
            Role::Fixed => None,
            Role::Driven(motion) => Some(motion.kinematics(&solid.spec.pose, over.t + half)),
            Role::Free(_) => Some(drifted(&solid.kinematics, half)),
        });
    }

    /// Moves the solids over the whole step, under the loads of the last force pass and weights times `weight`.
    pub(super) fn advance(&mut self, system: &mut System<D>, over: Interval, weight: f64) -> Result<()> {
        let end = over.t + over.dt;
        let driven = |solid: &Solid<D>| match &solid.spec.role {
            Role::Driven(motion) => Some(motion.kinematics(&solid.spec.pose, end)),
            Role::Fixed | Role::Free(_) => None,
        };
        if let Some(engine) = &mut self.engine {
            let targets: Vec<_> = system.solids.iter().map(driven).collect();
            // The engine itself adds the weight once.
            let gravity = system.gravity() * (weight - 1.0);
            let weighed = |solid: &Solid<D>| {
                let mass = if let Role::Free(body) = &solid.spec.role { body.mass } else { 0.0 };
                Load { force: solid.load.force * weight + gravity * mass, torque: solid.load.torque * weight }
            };
            let mut loads: Vec<_> = system.solids.iter().map(weighed).collect();
            let (tied, told) = (!self.rig.is_empty(), self.books.is_some());
            let pushes: Vec<_> = (0..if told { loads.len() } else { 0 }).map(|i| engine.pushed(i)).collect();
            let began = if tied || told { whereabouts(system, &**engine, over.t) } else { Vec::new() };
            if tied {
                self.rig.act(&mut **engine, &began, over.t, over.dt);
            }
            let mut left = Vec::new();
            for light in &mut self.light {
                let push = engine.pushed(light.solid);
                left.push((light.solid, light.share(system, over.dt, &push, &mut loads[light.solid])));
            }
            for (solid, impulse) in left {
                let energy = system.give_back(solid, &impulse);
                self.books.iter_mut().for_each(|books| books.gave_back(energy));
            }
            let before: Vec<_> = self.light.iter().map(|light| engine.kinematics(light.solid)).collect();
            let step = self.steps;
            let start = Instant::now();
            engine.step(over.dt, &loads, &targets).map_err(|fault| stopped(system, fault, step, over.t))?;
            self.spent += start.elapsed();
            for (light, before) in self.light.iter_mut().zip(&before) {
                light.learn(system, over.dt, before, &engine.kinematics(light.solid));
            }
            let ended = if tied || told { whereabouts(system, &**engine, end) } else { Vec::new() };
            if tied {
                self.rig.learn(&**engine, &began, &ended, over.dt);
            }
            if let Some(books) = &mut self.books {
                let contacts = engine.contacts();
                for (i, (before, after)) in began.iter().zip(&ended).enumerate() {
                    let (given, pushes, tied) = (loads[i], pushes[i], self.rig.tied(i));
                    books.body(system, i, &contacts, &Moved { given, pushes, tied, before, after, dt: over.dt });
                }
            }
        }
        self.steps += 1;
        let engine = self.engine.as_deref();
        place(system, Some(over.dt), |i, solid| match &solid.spec.role {
            Role::Free(_) => engine.map(|e| e.kinematics(i)),
            _ => driven(solid),
        });
        Ok(())
    }
}

/// How each solid moves at time `t` (s), which is the engine's.
fn whereabouts<const D: usize>(system: &System<D>, engine: &dyn Engine<D>, t: f64) -> Vec<Kinematics<D>> {
    let one = |(i, solid): (usize, &Solid<D>)| match &solid.spec.role {
        Role::Fixed => solid.kinematics,
        Role::Driven(motion) => motion.kinematics(&solid.spec.pose, t),
        Role::Free(_) => engine.kinematics(i),
    };
    system.solids.iter().enumerate().map(one).collect()
}

/// Gives each solid the kinematics that `to` says, if any, and places its skin; `over` is the length (s) of a step that
/// ends there.
fn place<const D: usize>(
    system: &mut System<D>,
    over: Option<f64>,
    to: impl Fn(usize, &Solid<D>) -> Option<Kinematics<D>>,
) {
    for i in 0..system.solids.len() {
        if let Some(kinematics) = to(i, &system.solids[i]) {
            match over {
                Some(dt) => system.solids[i].go(kinematics, dt),
                None => system.solids[i].kinematics = kinematics,
            }
            system.place(i);
        }
    }
}

/// Where free motion at constant velocity and spin leads in `dt` (s).
fn drifted<const D: usize>(k: &Kinematics<D>, dt: f64) -> Kinematics<D> {
    let turn = (k.spin * dt).exp();
    let centre: Vector<D> = k.centre + k.velocity * dt;
    let pose = Pose { position: centre + turn * (k.pose.position - k.centre), rotation: turn * k.pose.rotation };
    Kinematics { pose, centre, ..*k }
}

fn stopped<const D: usize>(system: &System<D>, fault: EngineFault<D>, step: u64, time: f64) -> Error {
    Error::fault(Fault {
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
