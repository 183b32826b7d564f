//! Measures the figures of a running simulation after each step, without changing the simulation.

use super::{
    StressCase,
    criteria::{Energies, EnergyBalance, MeasuredFigures, draft_figure, max_or_invalid, motion_figure},
};
use crate::{
    error::Result,
    geometry::Shape,
    math::{Vector, expression::Formula},
    probe::{EnergyProbe, MotionProbe, Probe, find_solid},
    simulation::Simulation,
    solid::{Kinematics, Load, Role, Solid, hydrostatics::equilibrium_height},
    system::{System, film},
};

/// The number of energy samples in a run. A temporary excess of energy lasts for many sound crossings, so these
/// samples detect it.
const LOOKS: f64 = 200.0;

/// The measurements of one run.
pub(super) struct Measurements<'a, const D: usize> {
    case: &'a StressCase,
    energy: EnergyProbe,
    energy_balance: EnergyBalance,
    known_motions: Vec<KnownMotion<D>>,
    before: Vec<Kinematics<D>>,
    /// The initial momentum (kg m/s), and the initial momentum scale Σ m |v|.
    momentum: (Vector<D>, f64),
    depth: f64,
    level: f64,
    next: f64,
    figures: MeasuredFigures,
}

/// A motion with an exact solution.
struct KnownMotion<const D: usize> {
    probe: MotionProbe<D>,
    /// The last reading, whose angles count turns.
    row: Vec<f64>,
    /// The column that the solution is of.
    column: usize,
    solution: Formula,
}

impl<'a, const D: usize> Measurements<'a, D> {
    /// Starts the measurements of a simulation at its initial state; `level` is the height of the still water, m.
    pub(super) fn new(case: &'a StressCase, sim: &Simulation<D>, level: f64) -> Result<Self> {
        let system = sim.system();
        let energy = EnergyProbe::new(system);
        let mut courses = Vec::new();
        for course in &case.criteria.motion {
            let probe = MotionProbe::new(system, &course.solid)?;
            let columns = Probe::<D>::columns(&probe);
            let Some(column) = columns.iter().position(|name| *name == course.column) else {
                let what = format!("a motion has no column {:?}; it has {}", course.column, columns.join(", "));
                return Err(crate::Error::scene(what));
            };
            let row = probe.sample(sim);
            courses.push(KnownMotion { probe, row, column, solution: Formula::parse(&course.formula)? });
        }
        let lowest = system.fluid().r.iter().map(|r| r[D - 1]).fold(f64::INFINITY, f64::min);
        let lift = masses(system) * system.gravity().norm() * system.model().dp;
        let mut measure = Self {
            case,
            energy_balance: EnergyBalance::new(energies(&energy, sim), lift),
            energy,
            known_motions: courses,
            before: Vec::new(),
            momentum: (momentum(sim), momentum_scale(system)),
            depth: level - lowest + 0.5 * system.model().dp,
            level,
            next: 0.0,
            figures: MeasuredFigures::new(),
        };
        measure.store_kinematics(sim);
        measure.sample(sim)?;
        Ok(measure)
    }

    /// Updates the measurements after a step of length `dt` (s).
    pub(super) fn step(&mut self, sim: &Simulation<D>, dt: f64) -> Result<()> {
        let driven: f64 =
            self.before.iter().zip(sim.system().solids()).map(|(then, now)| driven_work(then, now, dt)).sum();
        let by_solids = driven + constraint_work(sim, &self.before, dt);
        self.energy_balance.add_work(by_solids + film_work(sim, &self.before, dt));
        self.store_kinematics(sim);
        for motion in &mut self.known_motions {
            let mut row = motion.probe.sample(sim);
            motion.probe.continue_from(&motion.row, &mut row, dt);
            motion.row = row;
        }
        let until = self.case.scene.until;
        if sim.time() < self.next && sim.time() < until {
            return Ok(());
        }
        self.next = sim.time() + until / LOOKS;
        self.sample(sim)
    }

    /// Returns the measured figures.
    pub(super) fn figures(mut self) -> MeasuredFigures {
        self.figures.insert("energy".into(), self.energy_balance.relative_excess());
        self.figures
    }

    fn store_kinematics(&mut self, sim: &Simulation<D>) {
        self.before = sim.system().solids().iter().map(|solid| solid.kinematics).collect();
    }

    fn sample(&mut self, sim: &Simulation<D>) -> Result<()> {
        self.energy_balance.update(energies(&self.energy, sim));
        let (judge, system) = (&self.case.criteria, sim.system());
        for (name, figure) in ["walls", "bodies", "outside"].into_iter().zip(wall_violations(system)) {
            self.record_max(name, figure);
        }
        if judge.momentum.is_some() {
            let pushed = system.gravity() * (masses(system) * sim.time());
            let off = (momentum(sim) - self.momentum.0 - pushed).norm();
            self.record_max("momentum", off / self.momentum.1.max(pushed.norm()).max(f64::MIN_POSITIVE));
        }
        let courses = self.known_motions.iter().zip(&judge.motion).map(|(motion, course)| {
            let off = motion.row[motion.column] - motion.solution.value_and_rate(sim.time()).0;
            (motion_figure(course), off.abs())
        });
        for (name, off) in courses.collect::<Vec<_>>() {
            self.record_max(&name, off);
        }
        if sim.time() < 0.5 * self.case.scene.until {
            return Ok(());
        }
        if judge.quiet.is_some() {
            let fastest = system.fluid().v.iter().map(|v| v.norm()).fold(0.0, max_or_invalid);
            self.record_max("quiet", fastest / (system.gravity().norm() * self.depth).sqrt());
        }
        for of in &judge.draft {
            let solid = &system.solids()[find_solid(system, &of.solid)?];
            let Some(body) = &solid.body else { continue };
            let (shape, pose) = (&solid.spec.shape, &solid.kinematics.pose);
            let off = equilibrium_height(shape, pose, body.mass, system.model().rho0, self.level)?;
            self.record_max(&draft_figure(&of.solid), off.abs() / system.model().dp);
        }
        Ok(())
    }

    fn record_max(&mut self, name: &str, figure: f64) {
        let entry = self.figures.entry(name.into()).or_insert(0.0);
        *entry = max_or_invalid(*entry, figure);
    }
}

fn energies<const D: usize>(probe: &EnergyProbe, sim: &Simulation<D>) -> Energies {
    // The columns of the probe are the kinetic, potential and compression energy of the water, the kinetic and
    // potential energy of the bodies, and the sum.
    let row = probe.sample(sim);
    Energies { kinetic: row[0] + row[3], potential: row[1] + row[4], compression: row[2] }
}

/// Returns the work (J) of `load` in a step, at the mean of the motions before and after it.
fn work<const D: usize>(load: &Load<D>, then: &Kinematics<D>, now: &Kinematics<D>, dt: f64) -> f64 {
    let (velocity, spin) = ((then.velocity + now.velocity) * 0.5, (then.spin + now.spin) * 0.5);
    dt * load.power(&Kinematics { velocity, spin, ..*now })
}

/// Returns the work (J) of a driven solid on the water in a step: minus the work of the water's load on the solid. The load is
/// that of the last force pass, which is at mid-step if a step has two passes.
fn driven_work<const D: usize>(then: &Kinematics<D>, now: &Solid<D>, dt: f64) -> f64 {
    let Role::Driven(_) = &now.spec.role else { return 0.0 };
    -work(&now.load, then, &now.kinematics, dt)
}

/// Returns the work of springs, motors and forces on the free bodies in a step (J). The work is zero without a load breakdown.
fn constraint_work<const D: usize>(sim: &Simulation<D>, before: &[Kinematics<D>], dt: f64) -> f64 {
    let one = |(i, then): (usize, &Kinematics<D>)| {
        let shares = sim.load_breakdown(i)?;
        let load = shares.springs + shares.motors + shares.forces;
        Some(work(&load, then, &sim.system().solids()[i].kinematics, dt))
    };
    before.iter().enumerate().filter_map(one).sum()
}

/// Returns the work (J) in a step of the films of water between solids: the motion that opens a gap raises the water around it by
/// the same energy, which is lost when the gap fills.
fn film_work<const D: usize>(sim: &Simulation<D>, before: &[Kinematics<D>], dt: f64) -> f64 {
    let loads = film::loads(sim.system(), &sim.system().rates.boundary).loads;
    let moved = before.iter().zip(sim.system().solids());
    loads.iter().zip(moved).map(|(load, (then, now))| work(load, then, &now.kinematics, dt)).sum()
}

/// Returns the mass of water and free bodies, kg.
fn masses<const D: usize>(system: &System<D>) -> f64 {
    let bodies: f64 = free_bodies(system).map(|(_, mass)| mass).sum();
    system.particle_mass() * system.fluid().len() as f64 + bodies
}

/// Returns the momentum of water and free bodies, kg m/s, including the pending impulses on light bodies.
fn momentum<const D: usize>(sim: &Simulation<D>) -> Vector<D> {
    let system = sim.system();
    let water = system.fluid().v.iter().sum::<Vector<D>>() * system.particle_mass();
    let on_the_way = (0..system.solids().len()).fold(water, |sum, i| sum + sim.pending_impulse(i));
    free_bodies(system).fold(on_the_way, |sum, (solid, mass)| sum + solid.kinematics.velocity * mass)
}

/// Returns the momentum scale Σ m |v| of water and free bodies, kg m/s.
fn momentum_scale<const D: usize>(system: &System<D>) -> f64 {
    let water: f64 = system.fluid().v.iter().map(|v| v.norm()).sum();
    free_bodies(system)
        .fold(water * system.particle_mass(), |sum, (solid, mass)| sum + solid.kinematics.velocity.norm() * mass)
}

/// Returns the free solids and their masses.
fn free_bodies<const D: usize>(system: &System<D>) -> impl Iterator<Item = (&Solid<D>, f64)> {
    system.solids().iter().filter_map(|solid| Some((solid, solid.body?.mass)))
}

/// Returns three figures: the depth (dp) of water inside a solid, the depth (dp) of the face of a free body inside
/// another solid, and the amount of water outside a tank. Water that left the tank over its rim does not count.
fn wall_violations<const D: usize>(system: &System<D>) -> [f64; 3] {
    let (dp, skin) = (system.model().dp, system.boundary());
    let [mut deepest, mut pressed, mut outside] = [0.0; 3];
    for (i, solid) in system.solids().iter().enumerate() {
        let (shape, pose) = (&solid.spec.shape, &solid.kinematics.pose);
        let depth = |r: &Vector<D>| -shape.signed_distance(&pose.local(r)) / dp;
        deepest = system.fluid().r.iter().map(depth).fold(deepest, max_or_invalid);
        for (k, body) in system.solids().iter().enumerate() {
            if k != i && matches!(body.spec.role, Role::Free(_)) {
                // The outermost boundary particles of the body lie dp/2 behind its face.
                pressed = skin.r[body.boundary.clone()].iter().map(|r| depth(r) + 0.5).fold(pressed, max_or_invalid);
            }
        }
        if let Shape::Tank { size, thickness } = shape {
            let beside = |r: &&Vector<D>| {
                let x = pose.local(r);
                let below = x[D - 1] < -thickness;
                below || (x[D - 1] < size[D - 1] && (0..D - 1).any(|i| x[i] < -thickness || x[i] > size[i] + thickness))
            };
            outside += system.fluid().r.iter().filter(beside).count() as f64;
        }
    }
    [deepest, pressed, outside]
}
