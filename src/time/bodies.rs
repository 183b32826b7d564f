//! Moving the solids: driven ones by their law, free ones by rapier or by whoever hosts them, and then their skins.

use std::time::{Duration, Instant};

use super::{
    Books, Held, Interval, Light,
    books::{Moved, Shares, touching},
};
use crate::{
    error::{Error, Fault, Kind, Result},
    solid::{
        Contact, Engine, EngineFault, Kinematics, Load, Role, Solid,
        rig::{Rig, Tied},
    },
    space::{Pose, Vector, Wedge},
    system::System,
};

/// The rigid-body side of a run. A scene without free bodies has no engine and steps none.
pub struct Bodies<const D: usize> {
    engine: Option<Box<dyn Engine<D>>>,
    light: Vec<Light<D>>,
    rig: Rig<D>,
    pub(crate) books: Option<Books<D>>,
    /// Whether somebody else moves the free bodies.
    hosted: bool,
    steps: u64,
    spent: Duration,
}

impl<const D: usize> Bodies<D> {
    /// The bodies that `engine` moves, at the start, those of them that are `light` with care, tied by `rig`; if they are
    /// `hosted`, somebody else moves them.
    pub(crate) fn new(engine: Option<Box<dyn Engine<D>>>, light: Vec<Light<D>>, rig: Rig<D>, hosted: bool) -> Self {
        Self { engine, light, rig, books: None, hosted, steps: 0, spent: Duration::ZERO }
    }

    /// Whether somebody else moves the free bodies.
    pub(crate) fn hosted(&self) -> bool {
        self.hosted
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
            Some(engine) => self.rig.limit(engine, &self.whereabouts(system, t, true), t),
            None => f64::INFINITY,
        }
    }

    /// How each solid moves at time `t` (s), which is the engine's; nothing unless that is `wanted`.
    fn whereabouts(&self, system: &System<D>, t: f64, wanted: bool) -> Vec<Kinematics<D>> {
        let Some(engine) = self.engine.as_deref().filter(|_| wanted) else { return Vec::new() };
        let one = |(i, solid): (usize, &Solid<D>)| match &solid.spec.role {
            Role::Fixed => solid.kinematics,
            Role::Driven(motion) => solid.driven(motion, t),
            Role::Free(_) => engine.kinematics(i),
        };
        system.solids.iter().enumerate().map(one).collect()
    }

    /// What of the light bodies must be kept to go on to the same bits.
    pub(crate) fn held(&self) -> Vec<Held> {
        self.light.iter().map(Light::held).collect()
    }

    /// Goes back to what was kept after so many `steps`; says whether it is of these bodies.
    pub(crate) fn restore(&mut self, held: &[Held], steps: u64) -> bool {
        self.light.iter_mut().zip(held).for_each(|(light, held)| light.restore(*held));
        self.steps = steps;
        self.light.len() == held.len()
    }

    /// Takes up an engine, the first free body having come.
    pub(crate) fn found(&mut self, engine: Box<dyn Engine<D>>) {
        self.engine = Some(engine);
    }

    /// Takes up a solid that has come as `start`, and may be light.
    pub(crate) fn admit(&mut self, light: Option<Light<D>>, start: Kinematics<D>) {
        self.light.extend(light);
        self.rig.admit(start);
        self.books.iter_mut().for_each(Books::admit);
    }

    /// Takes out a solid, and its `skin` boundary particles.
    pub(crate) fn oust(&mut self, solid: usize, skin: u32) {
        if let Some(engine) = &mut self.engine {
            engine.oust(solid);
        }
        self.light.retain(|light| light.solid != solid);
        self.light.iter_mut().for_each(|light| light.shift(solid, skin));
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

    /// Moves the solids over the whole step, under the loads of the last force pass and weights times `weight`, but for what no water
    /// touches, which has nothing to keep in step with; `between` may do what it likes at the moment when the water hands over to them.
    pub(crate) fn advance(
        &mut self,
        system: &mut System<D>,
        over: Interval,
        weight: f64,
        between: &mut Between<D>,
    ) -> Result<()> {
        let end = over.t + over.dt;
        // The engine itself adds the weight once.
        let gravity = system.gravity() * (weight - 1.0);
        let weighed = |solid: &Solid<D>| {
            let mass = if let Role::Free(body) = &solid.spec.role { body.mass } else { 0.0 };
            match solid.load == Load::zero() {
                true => solid.load,
                false => Load { force: solid.load.force * weight + gravity * mass, torque: solid.load.torque * weight },
            }
        };
        let loads: Vec<_> = system.solids.iter().map(weighed).collect();
        let hosted = self.hosted;
        let at_end = |solid: &Solid<D>| match &solid.spec.role {
            Role::Fixed => solid.kinematics,
            Role::Driven(motion) => solid.driven(motion, end),
            Role::Free(_) if hosted => nowhere(),
            Role::Free(_) => solid.kinematics,
        };
        let solids = system.solids.iter().map(at_end).collect();
        let mut handover = Handover { bodies: self, system, over, loads, solids, done: false };
        if hosted {
            handover.lighten();
        }
        between(&mut handover)?;
        let solids = handover.finish()?;
        self.steps += 1;
        place(system, Some(over.dt), |i, solid| match &solid.spec.role {
            Role::Fixed => None,
            Role::Driven(_) | Role::Free(_) => Some(solids[i]),
        });
        Ok(())
    }
}

/// What may be done at the moment when the water hands over to the bodies.
pub(crate) type Between<'a, const D: usize> = dyn FnMut(&mut Handover<D>) -> Result<()> + 'a;

/// The moment of a step when the water has moved and the bodies are about to: see
/// [`Simulation::step_with`](crate::simulation::Simulation::step_with).
///
/// Solids have the numbers that they have in [`System::solids`].
pub struct Handover<'a, const D: usize> {
    bodies: &'a mut Bodies<D>,
    system: &'a mut System<D>,
    over: Interval,
    loads: Vec<Load<D>>,
    /// How each solid moves at the end of the step. Fixed and driven ones are there already; free ones are there after
    /// [`Handover::go`], or in a hosted simulation when you have put them there.
    pub solids: Vec<Kinematics<D>>,
    done: bool,
}

impl<const D: usize> Handover<'_, D> {
    /// Time at the start of the step, s.
    pub fn time(&self) -> f64 {
        self.over.t
    }

    /// Length of the step, s.
    pub fn dt(&self) -> f64 {
        self.over.dt
    }

    /// Force (N; N/m in 2-D) and torque about its centre (N m; N m/m in 2-D) that the water gives each solid over the step, a
    /// constant. Weight is not in it.
    pub fn loads(&self) -> &[Load<D>] {
        &self.loads
    }

    /// Adds `load` (N, N m) about the centre of free solid number `solid` in this step, before [`Handover::go`]. Without effect in
    /// a hosted simulation, where forces are your world's.
    pub fn push(&mut self, solid: usize, load: &Load<D>) {
        if let Some(engine) = &mut self.bodies.engine {
            engine.burden(solid, load);
        }
    }

    /// How the solids pressed on one another, pair by pair: after [`Handover::go`] in this step, before it in the last.
    pub fn contacts(&self) -> Vec<Contact<D>> {
        self.bodies.engine().map(|engine| engine.contacts()).unwrap_or_default()
    }

    /// Lets the bodies make their step, unless they have made it. Whoever does not call it has it called when he is done.
    ///
    /// # Errors
    /// `Usage` in a hosted simulation; `Fault` if a body leaves the valid range.
    pub fn go(&mut self) -> Result<()> {
        if self.bodies.hosted {
            return Err(Error::new(Kind::Usage, "a hosted simulation has no bodies of its own to step")
                .help("step your own world, and write where its bodies are into handover.solids"));
        }
        if std::mem::replace(&mut self.done, true) || self.bodies.engine.is_none() {
            return Ok(());
        }
        let Interval { t, dt } = self.over;
        let tied = !self.bodies.rig.is_empty();
        let told = self.bodies.books.is_some() || self.bodies.rig.pulls_on_any();
        let began = self.bodies.whereabouts(self.system, t, tied || told);
        let mut pushes = Vec::new();
        if let Some(engine) = &mut self.bodies.engine {
            pushes.extend((0..if told { began.len() } else { 0 }).map(|i| engine.pushed(i)));
            if tied {
                self.bodies.rig.act(&mut **engine, &began, &self.system.around(&self.loads), [t, dt]);
            }
        }
        self.lighten();
        let driven = |(solid, target): (&Solid<D>, &Kinematics<D>)| {
            matches!(solid.spec.role, Role::Driven(_)).then_some(*target)
        };
        let targets: Vec<_> = self.system.solids.iter().zip(&self.solids).map(driven).collect();
        let Bodies { engine: Some(engine), light, steps, spent, rig, books, .. } = &mut *self.bodies else {
            return Ok(());
        };
        let before: Vec<_> = light.iter().map(|light| engine.kinematics(light.solid)).collect();
        let start = Instant::now();
        engine.step(dt, &self.loads, &targets).map_err(|fault| stopped(self.system, fault, *steps, t))?;
        *spent += start.elapsed();
        for (i, solid) in self.system.solids.iter().enumerate() {
            if let Role::Free(_) = solid.spec.role {
                self.solids[i] = engine.kinematics(i);
                if !self.system.domain().contains(&self.solids[i].centre) {
                    return Err(stopped(self.system, gone(i, &self.solids[i]), *steps, t));
                }
            }
        }
        for (light, before) in light.iter_mut().zip(&before) {
            light.learn(self.system, dt, before, &self.solids[light.solid]);
        }
        let touching = if told { touching(&engine.contacts(), began.len()) } else { Vec::new() };
        let iterated = engine.iterations() > 1;
        let moved = |i: usize, tied: Tied<D>| Moved {
            given: self.loads[i],
            pushes: pushes[i],
            touching: touching[i],
            tied,
            before: &began[i],
            after: &self.solids[i],
            turned: engine.turned(i),
            dt,
            iterated,
        };
        let of = |i: usize| Shares::of(self.system, i, &moved(i, rig.tied(i)));
        let shares: Vec<_> = (0..touching.len()).map(of).collect();
        if tied {
            let unexplained: Vec<_> = shares.iter().map(Shares::residual).collect();
            rig.learn(&**engine, [&began, &self.solids], dt, Some(&unexplained));
        }
        if let Some(books) = books {
            for (i, shares) in shares.into_iter().enumerate() {
                books.body(self.system, i, shares, &moved(i, rig.tied(i)));
            }
        }
        Ok(())
    }

    /// Turns the loads on light bodies into what those are to be given.
    fn lighten(&mut self) {
        let engine = &self.bodies.engine;
        let mut left = Vec::new();
        for light in &mut self.bodies.light {
            let push = engine.as_ref().map_or_else(Load::zero, |engine| engine.pushed(light.solid));
            left.push((light.solid, light.share(self.system, self.over.dt, &push, &mut self.loads[light.solid])));
        }
        for (solid, impulse) in left {
            let energy = self.system.give_back(solid, &impulse);
            self.bodies.books.iter_mut().for_each(|books| books.gave_back(energy));
        }
    }

    /// What is left to be done; gives where the solids are then.
    fn finish(mut self) -> Result<Vec<Kinematics<D>>> {
        if !self.bodies.hosted {
            self.go()?;
            return Ok(self.solids);
        }
        let finite = |k: &Kinematics<D>| {
            let sum = k.pose.position.norm() + k.pose.rotation.norm() + k.centre.norm();
            (sum + k.velocity.norm() + k.spin.0.norm()).is_finite()
        };
        if let Some(solid) = self.solids.iter().position(|k| !finite(k)) {
            return Err(Error::new(
                Kind::Usage,
                format!(
                    "nobody said where body {:?} is after the step, or what was said is not finite",
                    self.system.solids[solid].spec.name
                ),
            )
            .help("a hosted simulation is stepped by step_with, and each free body written into handover.solids"));
        }
        for light in &mut self.bodies.light {
            // Its drift of half a step changed neither velocity nor spin.
            let before = self.system.solids[light.solid].kinematics;
            light.learn(self.system, self.over.dt, &before, &self.solids[light.solid]);
        }
        Ok(self.solids)
    }
}

/// What is not known yet.
fn nowhere<const D: usize>() -> Kinematics<D> {
    let no = Vector::repeat(f64::NAN);
    Kinematics { pose: Pose::at(no), centre: no, velocity: no, spin: Wedge::zero() }
}

/// Puts the solids where they will be half a step on: driven ones exactly, free ones as they drift.
pub(super) fn drift<const D: usize>(system: &mut System<D>, over: Interval) {
    let half = 0.5 * over.dt;
    place(system, None, |_, solid| match &solid.spec.role {
        Role::Fixed => None,
        Role::Driven(motion) => Some(solid.driven(motion, over.t + half)),
        Role::Free(_) => Some(drifted(&solid.kinematics, half)),
    });
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

/// That solid number `solid` has left the domain.
fn gone<const D: usize>(solid: usize, now: &Kinematics<D>) -> EngineFault<D> {
    EngineFault {
        solid,
        reason: "escape from the domain".into(),
        cause: "Usual cause: it starts beside the tank, a blow threw it over a wall, or nothing holds it up. If it is to go there, set \
                domain.min and domain.max wider.",
        position: now.centre,
        velocity: now.velocity,
    }
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
