//! What each body got in the last step, by kind, and where energy went since the start.
//!
//! A load that acts over a step does work at the mean of the velocities at its two ends, ½ (V₀ + V₁), so that the works of all
//! add up to the change of kinetic energy. The water gave its share at the velocity that it saw; what the body got and the water
//! did not give is named `coupling`, and with it what the engine's step, which moves by V₁, makes of weight.

use serde::{Deserialize, Serialize};

use crate::{
    solid::{Contact, FreeBody, Kinematics, Load, Role, rig::Tied},
    space::{Matrix, Vector, Wedge},
    system::{Lost, Powers, System},
};

/// The loads on a free body in the last step, about its centre of mass, by what they come from.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shares<const D: usize> {
    /// Of the water's pressure.
    pub pressure: Load<D>,
    /// Of its viscosity.
    pub viscous: Load<D>,
    /// What the body gets later, or gets now from before: of bodies that answer with the inertia of the water around them, and
    /// of Verlet's steps.
    pub delayed: Load<D>,
    /// Its weight.
    pub weight: Load<D>,
    /// Contacts, friction included.
    pub contacts: Load<D>,
    /// Locks and end stops of joints.
    pub joints: Load<D>,
    /// Ropes.
    pub ropes: Load<D>,
    /// Springs and mooring lines.
    pub springs: Load<D>,
    /// Motors of joints.
    pub motors: Load<D>,
    /// The scene's forces.
    pub forces: Load<D>,
    /// A program's pushes.
    pub pushes: Load<D>,
    /// What holds its locked motions: by definition what the others come to there.
    pub locks: Load<D>,
    /// Rate at which its momentum and angular momentum changed; of a body in space that is in a joint, on a rope or partly locked the
    /// latter as the engine steps it, I(R₀) ΔΩ/Δt + Ω ∧ I Ω.
    pub change: Load<D>,
}

impl<const D: usize> Shares<D> {
    /// None.
    pub fn zero() -> Self {
        let none = Load::zero();
        Self {
            pressure: none,
            viscous: none,
            delayed: none,
            weight: none,
            contacts: none,
            joints: none,
            ropes: none,
            springs: none,
            motors: none,
            forces: none,
            pushes: none,
            locks: none,
            change: none,
        }
    }

    /// All kinds with their names, without the change of momentum.
    pub fn kinds(&self) -> [(&'static str, Load<D>); 12] {
        [
            ("pressure", self.pressure),
            ("viscous", self.viscous),
            ("delayed", self.delayed),
            ("weight", self.weight),
            ("contacts", self.contacts),
            ("joints", self.joints),
            ("ropes", self.ropes),
            ("springs", self.springs),
            ("motors", self.motors),
            ("forces", self.forces),
            ("pushes", self.pushes),
            ("locks", self.locks),
        ]
    }

    /// The sum of all kinds.
    pub fn sum(&self) -> Load<D> {
        self.kinds().into_iter().map(|(_, load)| load).sum()
    }

    /// What the body did beyond the sum.
    pub fn residual(&self) -> Load<D> {
        self.change - self.sum()
    }

    /// Gives what is left over to the ties that pull hardest: from one iteration of a step to the next they turn, and the rows along which
    /// their pulls are told do not.
    fn give_ties_the_rest(&mut self) {
        let rest = self.residual();
        let ties = if self.joints.force.norm() >= self.ropes.force.norm() { &mut self.joints } else { &mut self.ropes };
        if *ties != Load::zero() {
            *ties += rest;
        }
    }

    /// Those on solid number `i` in a step, all of the water's as pressure, without what joints, ropes and locks did; none but on
    /// a free one.
    pub(super) fn of(system: &System<D>, i: usize, moved: &Moved<'_, D>) -> Self {
        let solid = &system.solids()[i];
        let Role::Free(body) = &solid.spec.role else { return Self::zero() };
        let Moved { given, pushes, touching, tied, before, after, turned, dt, .. } = *moved;
        let change = (momentum(body, after) - momentum(body, before)) * (1.0 / dt);
        Self {
            pressure: solid.load,
            delayed: given - solid.load,
            weight: Load { force: system.gravity() * body.mass, torque: Wedge::zero() },
            contacts: touching,
            springs: tied.springs,
            motors: tied.motors,
            forces: tied.forces,
            pushes,
            change: Load { torque: turned.unwrap_or(change.torque), ..change },
            ..Self::zero()
        }
    }
}

/// Energies since the start, J (J/m in 2-D): positive is what water and bodies have gained.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Ledger {
    /// Work of driven solids on the water, and of gravity along periodic sides.
    pub driven: f64,
    /// Work of motors.
    pub motors: f64,
    /// Work of springs: what they store or damp is negative.
    pub springs: f64,
    /// Work of the scene's forces and of a program's pushes.
    pub forces: f64,
    /// Work of contacts, of driven solids through them too.
    pub contacts: f64,
    /// Work of joints, end stops and ropes.
    pub joints: f64,
    /// What viscosity gives: negative.
    pub viscous: f64,
    /// What the diffusion of density gives.
    pub diffusion: f64,
    /// What the correction of gradients gives.
    pub gradient: f64,
    /// What shifting gives.
    pub shifting: f64,
    /// What damping zones give: negative.
    pub damping: f64,
    /// What the boundary particles give.
    pub walls: f64,
    /// What bodies got beyond what the water gave.
    pub coupling: f64,
    /// What particles had that were taken out, with the sign changed.
    pub removed: f64,
    /// What free solids had that came, less what those had that went.
    pub solids: f64,
}

impl Ledger {
    /// All entries with their names.
    pub fn entries(&self) -> [(&'static str, f64); 15] {
        [
            ("driven", self.driven),
            ("motors", self.motors),
            ("springs", self.springs),
            ("forces", self.forces),
            ("contacts", self.contacts),
            ("joints", self.joints),
            ("viscous", self.viscous),
            ("diffusion", self.diffusion),
            ("gradient", self.gradient),
            ("shifting", self.shifting),
            ("damping", self.damping),
            ("walls", self.walls),
            ("coupling", self.coupling),
            ("removed", self.removed),
            ("solids", self.solids),
        ]
    }
}

/// The books of a run.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Books<const D: usize> {
    /// Steps from one telling apart of the water's laws to the next; none if nobody needs it.
    pub(crate) every: Option<u32>,
    since: u32,
    /// Whether energy is asked for.
    pub(crate) energy: bool,
    powers: Powers,
    /// Loads of the viscosity on the solids when they were last told apart.
    viscous: Vec<Load<D>>,
    /// Work (J) that the water did on each solid in the present step.
    work: Vec<f64>,
    pub(crate) shares: Vec<Shares<D>>,
    pub(crate) ledger: Ledger,
}

/// What moved a free body in a step, but for the water.
pub(super) struct Moved<'a, const D: usize> {
    pub(super) given: Load<D>,
    pub(super) pushes: Load<D>,
    pub(super) touching: Load<D>,
    pub(super) tied: Tied<D>,
    pub(super) before: &'a Kinematics<D>,
    pub(super) after: &'a Kinematics<D>,
    /// What it did against torques, if the engine turns it by its spin.
    pub(super) turned: Option<Wedge<D>>,
    pub(super) dt: f64,
    /// Whether the engine took the step in several iterations.
    pub(super) iterated: bool,
}

impl<const D: usize> Books<D> {
    /// Empty books of so many solids, of `energy` too, for which the water's laws are told apart every so many steps.
    pub(crate) fn new(solids: usize, energy: bool, every: Option<u32>) -> Self {
        Self {
            every,
            since: 0,
            energy,
            powers: Powers::default(),
            viscous: vec![Load::zero(); solids],
            work: vec![0.0; solids],
            shares: vec![Shares::zero(); solids],
            ledger: Ledger::default(),
        }
    }

    /// Takes up a solid that has come.
    pub(super) fn admit(&mut self) {
        self.viscous.push(Load::zero());
        self.work.push(0.0);
        self.shares.push(Shares::zero());
    }

    /// Books of as many solids, with entries as full.
    pub(crate) fn like(&self, other: &Self) -> bool {
        self.every == other.every && self.energy == other.energy && self.shares.len() == other.shares.len()
    }

    /// Books what the water does at a force pass whose rates hold for `dt` (s).
    pub(super) fn water(&mut self, system: &mut System<D>, dt: f64) {
        if let Some(every) = self.every {
            if self.since == 0
                && let Some((powers, pressure)) = system.tell_apart()
            {
                self.powers = powers;
                let solids = system.solids().iter().zip(pressure);
                self.viscous = solids.map(|(solid, pressure)| solid.load - pressure).collect();
            }
            self.since = (self.since + 1) % every;
        }
        if self.energy {
            let Powers { viscous, diffusion, gradient } = self.powers;
            self.ledger.viscous += viscous * dt;
            self.ledger.diffusion += diffusion * dt;
            self.ledger.gradient += gradient * dt;
            self.ledger.walls += (system.unworked() - viscous - diffusion - gradient) * dt;
            self.ledger.driven += system.periodic_power() * dt;
        }
        for (solid, work) in system.solids().iter().zip(&mut self.work) {
            *work = solid.load.power(&solid.kinematics) * dt;
            if let Role::Driven(_) = solid.spec.role {
                self.ledger.driven -= *work;
            }
        }
    }

    /// Books that the water was moved by `shifts` (m).
    pub(super) fn shifted(&mut self, system: &System<D>, shifts: &[Vector<D>]) {
        self.ledger.shifting -= system.particle_mass() * shifts.iter().map(|s| system.gravity().dot(s)).sum::<f64>();
    }

    /// Books particles that were taken out.
    pub(crate) fn removed(&mut self, system: &System<D>, lost: &[Lost<D>]) {
        self.displaced(lost.iter().map(|p| system.particle_energy(&p.r, &p.v, p.rho)).sum());
    }

    /// Books the energy (J) of water that was taken out.
    pub(crate) fn displaced(&mut self, energy: f64) {
        self.ledger.removed -= energy;
    }

    /// Books the energy (J) that a solid has which came; of one that goes, less than nothing.
    pub(crate) fn came(&mut self, energy: f64) {
        self.ledger.solids += energy;
    }

    /// Books energy (J) that damping zones took.
    pub(super) fn damped(&mut self, taken: f64) {
        self.ledger.damping -= taken;
    }

    /// Books energy (J) that the water got back for a body.
    pub(crate) fn gave_back(&mut self, energy: f64) {
        self.ledger.coupling += energy;
    }

    /// Books a step of solid number `i` of `system`, if it is free, under `shares` but for joints, ropes and locks.
    pub(super) fn body(&mut self, system: &System<D>, i: usize, mut shares: Shares<D>, moved: &Moved<'_, D>) {
        let Role::Free(body) = &system.solids()[i].spec.role else { return };
        let Moved { given, tied, before, after, dt, iterated, .. } = *moved;
        (shares.viscous, shares.pressure) = (self.viscous[i], shares.pressure - self.viscous[i]);
        (shares.joints, shares.ropes) = (tied.joints, tied.ropes);
        shares.locks = locked(body, tied.held, &shares.residual());
        if iterated {
            shares.give_ties_the_rest();
        }
        let mean = Kinematics {
            velocity: 0.5 * (before.velocity + after.velocity),
            spin: (before.spin + after.spin) * 0.5,
            ..*after
        };
        let work = |load: Load<D>| load.power(&mean) * dt;
        let ledger = &mut self.ledger;
        ledger.motors += work(shares.motors);
        ledger.springs += work(shares.springs);
        ledger.forces += work(shares.forces + shares.pushes);
        ledger.contacts += work(shares.contacts);
        ledger.joints += work(shares.joints + shares.ropes);
        let sunk = shares.weight.force.dot(&(after.centre - before.centre));
        ledger.coupling += work(given + shares.weight) - sunk - self.work[i];
        self.shares[i] = shares;
    }
}

/// What all `contacts` do to each of so many solids.
pub(super) fn touching<const D: usize>(contacts: &[Contact<D>], solids: usize) -> Vec<Load<D>> {
    let mut sums = vec![Load::zero(); solids];
    for (solid, load) in contacts.iter().flat_map(|contact| contact.between.into_iter().zip(contact.loads)) {
        sums[solid] += load;
    }
    sums
}

/// Momentum, kg m/s, and angular momentum about the centre of mass, kg m²/s.
fn momentum<const D: usize>(body: &FreeBody<D>, motion: &Kinematics<D>) -> Load<D> {
    Load { force: motion.velocity * body.mass, torque: turned(&body.inertia, &motion.pose.rotation, &motion.spin) }
}

/// I Ω in the world's axes, with the inertia in the body's.
fn turned<const D: usize>(inertia: &Matrix<D>, rotation: &Matrix<D>, spin: &Wedge<D>) -> Wedge<D> {
    if D == 2 {
        return *spin * inertia[(0, 0)];
    }
    let world = rotation * inertia * rotation.transpose() * Vector::<D>::from_iterator(spin.axial());
    Wedge::from_axial(world.as_slice())
}

/// The part of `load` along what is locked of `body`: all of it if it is `held`.
fn locked<const D: usize>(body: &FreeBody<D>, held: bool, load: &Load<D>) -> Load<D> {
    let force = Vector::from_fn(|i, _| if held || body.locked_translations[i] { load.force[i] } else { 0.0 });
    let turns = load.torque.axial().into_iter().enumerate();
    let torque: Vec<f64> = turns.map(|(i, t)| if held || body.locked_rotations[i] { t } else { 0.0 }).collect();
    Load { force, torque: Wedge::from_axial(&torque) }
}
