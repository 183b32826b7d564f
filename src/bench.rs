//! Standard works, timed: what a step costs, where it goes, and what each law adds.
//!
//! The work is a dam break in a closed box, two long, one across and 1.2 high with water 0.8 long and 0.6 deep, in boxes
//! of any number of particles. Processor time is counted beside wall time, as a shared machine moves the latter, and what is
//! compared is measured in turns within one run.

use std::time::Instant;

use rayon::ThreadPoolBuilder;
use serde::Serialize;

use crate::{
    error::{Error, Kind, Result},
    law::{
        diffusion::Molteni,
        shifting::Shift,
        viscosity::{Laminar, Sps},
    },
    model::{Diffusion, Dimension, Kernel, Model, Scheme, Shifting, Sweeping, Viscosity},
    shape::Shape,
    simulation::{Setup, Simulation, Spent},
    solid::{Dim, FreeBody, Role, SolidSpec},
    space::{Pose, Vector},
};

/// How long one timing lasts at least, s.
const LASTS: f64 = 0.5;

/// One work: so many particles of water, and what the model is.
#[derive(Clone, Debug)]
pub struct Work {
    /// What it is called.
    pub name: String,
    /// 2 or 3.
    pub dimension: usize,
    /// Water particles, about.
    pub water: usize,
    /// What differs from the standard model.
    pub change: fn(&mut Model),
    /// Whether a box floats in it.
    pub body: bool,
    /// How much longer the tank is than the standard one, all of it dry: 1 or more.
    pub dry: f64,
    /// Simulated before the timing, in units of √(depth/g).
    pub until: f64,
}

/// What a timing gave.
#[derive(Clone, Debug, Serialize)]
pub struct Timing {
    /// Name of the work.
    pub work: String,
    /// Dimensions.
    pub dimension: usize,
    /// Threads.
    pub threads: usize,
    /// Water particles.
    pub water: usize,
    /// Boundary particles with water near them.
    pub wet: usize,
    /// Boundary particles without.
    pub dry: usize,
    /// Steps timed.
    pub steps: usize,
    /// Wall time of a step, s.
    pub step_s: f64,
    /// Water and wet boundary particles moved on by a step in a second, 1/s.
    pub particle_steps_per_s: f64,
    /// Processor time per particle and step, ns.
    pub cpu_ns: f64,
    /// Pairs within the support, each from both sides, per particle.
    pub pairs: f64,
    /// Time of the pair sweep (all threads) per such pair, ns.
    pub pair_ns: f64,
    /// Shares of the step, %: lists and sorting, pairs, bodies; the rest moves and packs particles.
    pub lists_percent: f64,
    /// See above.
    pub pairs_percent: f64,
    /// See above.
    pub bodies_percent: f64,
    /// Making the first particles and lists, s.
    pub setup_s: f64,
    /// Largest memory of the program so far over the particles of this work, B.
    pub peak_bytes: f64,
}

impl Work {
    /// The standard work with the standard model.
    pub fn standard(dimension: usize, water: usize) -> Self {
        Self { name: "wendland".into(), dimension, water, change: |_| {}, body: false, dry: 1.0, until: 0.0 }
    }

    /// The same under another name with a change of the model.
    pub fn with(&self, name: &str, change: fn(&mut Model)) -> Self {
        Self { name: name.into(), change, ..self.clone() }
    }

    fn setup<const D: usize>(&self, sweep: Sweeping) -> Setup<D> {
        let depth = 0.6;
        let across = (1.0 / (0.8 * depth / self.water as f64).powf(1.0 / D as f64)).round().max(10.0);
        let dp = 1.0 / across;
        let cells = |x: f64| (x / dp).round();
        let size = |along: f64, up: f64| {
            Vector::from_fn(|i, _| {
                cells(if i == 0 {
                    along
                } else if i == D - 1 {
                    up
                } else {
                    1.0
                }) * dp
            })
        };
        let (pool, tank): (Vector<D>, Vector<D>) = (size(0.8, depth), size(2.0 * self.dry, 1.2));
        let count: [usize; D] = std::array::from_fn(|i| (pool[i] / dp).round() as usize);
        let mut water: Vec<Vector<D>> = (0..count.iter().product())
            .map(|mut k| {
                Vector::from_fn(|i, _| {
                    let at = k % count[i];
                    k /= count[i];
                    (at as f64 + 0.5) * dp
                })
            })
            .collect();
        let mut model = Model::water(D, dp, depth);
        model.h = 3f64.sqrt() * dp;
        (model.scheme, model.cfl, model.sweep) = (Scheme::Verlet { euler_every: 50 }, 0.2, sweep);
        (self.change)(&mut model);
        let thickness = model.layers() as f64 * dp;
        let mut solids = vec![solid("tank", Shape::Tank { size: tank, thickness }, Pose::identity(), Role::Fixed)];
        if self.body {
            let edge = (0.2 / dp).round() * dp;
            let shape = Shape::Box { size: Vector::repeat(edge) };
            let centre = Vector::from_fn(|i, _| if i == D - 1 { cells(depth) * dp } else { cells(0.4) * dp });
            water.retain(|r| (0..D).any(|i| (r[i] - centre[i]).abs() > 0.5 * edge));
            let body = FreeBody::from_density(&shape, 500.0);
            solids.push(solid("float", shape, Pose::at(centre), Role::Free(body)));
        }
        let levels = vec![pool[D - 1]; water.len()];
        Setup { model, water, levels, solids, domain: None }
    }
}

fn solid<const D: usize>(name: &str, shape: Shape<D>, pose: Pose<D>, role: Role<D>) -> SolidSpec<D> {
    SolidSpec { name: name.into(), shape, pose, role, friction: 0.0, restitution: 0.0 }
}

/// Makes every work ready and times them in turns, `rounds` times, on `threads` threads; gives for each the round of
/// least processor time.
///
/// # Errors
/// Whatever stops a simulation, and `Usage` if threads cannot be had.
pub fn time(works: &[Work], sweep: Sweeping, threads: usize, rounds: usize) -> Result<Vec<Timing>> {
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|why| Error::new(Kind::Usage, format!("{threads} threads cannot be had: {why}")))?;
    pool.install(|| {
        let mut timed: Vec<Box<dyn Timed>> = Vec::new();
        for work in works {
            timed.push(ready_in(work, sweep, threads)?);
        }
        let mut best: Vec<Option<Timing>> = vec![None; works.len()];
        for _ in 0..rounds {
            for (timed, best) in timed.iter_mut().zip(&mut best) {
                let timing = timed.time()?;
                if best.as_ref().is_none_or(|b| timing.cpu_ns < b.cpu_ns) {
                    *best = Some(timing);
                }
            }
        }
        Ok(best.into_iter().flatten().collect())
    })
}

/// A work made ready, whatever its dimension.
trait Timed {
    fn step(&mut self) -> Result<()>;
    fn time(&mut self) -> Result<Timing>;
}

fn ready_in(work: &Work, sweep: Sweeping, threads: usize) -> Result<Box<dyn Timed>> {
    match work.dimension {
        #[cfg(feature = "dim2")]
        2 => ready::<2>(work, sweep, threads),
        #[cfg(feature = "dim3")]
        3 => ready::<3>(work, sweep, threads),
        n => Err(Error::new(Kind::Usage, format!("this program was built without {n}-D"))),
    }
}

struct Ready<const D: usize> {
    sim: Simulation<D>,
    name: String,
    threads: usize,
    setup_s: f64,
    pairs: f64,
}

fn ready<const D: usize>(work: &Work, sweep: Sweeping, threads: usize) -> Result<Box<dyn Timed>>
where
    Dim<D>: Dimension<D>,
{
    let start = Instant::now();
    let mut sim = Simulation::new(work.setup::<D>(sweep))?;
    let setup_s = start.elapsed().as_secs_f64();
    let until = work.until * (0.6f64 / 9.81).sqrt();
    for _ in 0..3 {
        sim.step()?;
    }
    while sim.time() < until {
        sim.step()?;
    }
    let system = sim.system();
    let mut pairs = 0usize;
    for (i, r) in system.fluid().r.iter().enumerate() {
        system.water_near(r, &mut |j, _| pairs += usize::from(j != i));
        // A pair with a boundary particle is seen from it as well.
        system.solid_near(r, &mut |_, _| pairs += 2);
    }
    let pairs = pairs as f64 / (system.fluid().len() + system.wet()) as f64;
    Ok(Box::new(Ready { sim, name: work.name.clone(), threads, setup_s, pairs }))
}

impl<const D: usize> Timed for Ready<D> {
    fn step(&mut self) -> Result<()> {
        self.sim.step()
    }

    fn time(&mut self) -> Result<Timing> {
        let (before, cpu, start) = (self.sim.spent(), cpu_seconds(), Instant::now());
        let mut steps = 0;
        while start.elapsed().as_secs_f64() < LASTS || steps < 3 {
            self.sim.step()?;
            steps += 1;
        }
        let wall = start.elapsed().as_secs_f64();
        let cpu = cpu.zip(cpu_seconds()).map_or(wall, |(a, b)| b - a);
        let Spent { steps: all, lists, pairs, bodies } = self.sim.spent();
        let all = (all - before.steps).as_secs_f64();
        let (lists, bodies) = ((lists - before.lists).as_secs_f64(), (bodies - before.bodies).as_secs_f64());
        let pairs = (pairs - before.pairs).as_secs_f64();
        let system = self.sim.system();
        let (water, wet) = (system.fluid().len(), system.wet());
        let particle_steps = (steps * (water + wet)) as f64;
        Ok(Timing {
            work: self.name.clone(),
            dimension: D,
            threads: self.threads,
            water,
            wet,
            dry: system.skin().len() - wet,
            steps,
            step_s: wall / steps as f64,
            particle_steps_per_s: particle_steps / wall,
            cpu_ns: cpu / particle_steps * 1e9,
            pairs: self.pairs,
            pair_ns: pairs * self.threads as f64 / (particle_steps * self.pairs) * 1e9,
            lists_percent: lists / all * 100.0,
            pairs_percent: pairs / all * 100.0,
            bodies_percent: bodies / all * 100.0,
            setup_s: self.setup_s,
            peak_bytes: peak_memory() / (water + wet) as f64,
        })
    }
}

/// The laws and other things that a scene may name, each against the standard work (the first).
pub fn terms(dimension: usize, water: usize) -> Vec<Work> {
    let base = Work::standard(dimension, water);
    let mut works = vec![
        base.clone(),
        base.with("without viscosity", |m| m.viscosity = Viscosity::None),
        base.with("without diffusion", |m| m.diffusion = Diffusion::None),
        base.with("without both", |m| (m.viscosity, m.diffusion) = (Viscosity::None, Diffusion::None)),
        base.with("molteni", |m| m.diffusion = Diffusion::Molteni(Molteni::default())),
        base.with("laminar", |m| m.viscosity = Viscosity::Laminar(Laminar::default())),
        base.with("sps", |m| m.viscosity = Viscosity::Sps(Sps::default())),
        base.with("shifting", |m| m.shifting = Shifting::AwayFromSolids(Shift::default())),
        base.with("sps, shifting", |m| {
            (m.viscosity, m.shifting) = (Viscosity::Sps(Sps::default()), Shifting::AwayFromSolids(Shift::default()));
        }),
        base.with("cubic", |m| m.kernel = Kernel::Cubic { tensile: false }),
        base.with("cubic, tensile", |m| m.kernel = Kernel::Cubic { tensile: true }),
        base.with("symplectic", |m| m.scheme = Scheme::Symplectic),
    ];
    works.push(Work { name: "a floating box".into(), body: true, ..base.clone() });
    works.push(Work { name: "twice the tank, dry".into(), dry: 2.0, ..base.clone() });
    works.push(Work { name: "four times the tank, dry".into(), dry: 4.0, ..base });
    works
}

/// A small work for counting instructions: so many steps of the work `name` of [`terms`] in 2-D and in 3-D on one
/// thread, of 3,000 water particles each.
///
/// # Errors
/// `Usage` if there is no such work, and whatever stops a simulation.
pub fn fixed(steps: usize, name: &str) -> Result<()> {
    let work = |dimension| terms(dimension, 3000).into_iter().find(|w| w.name == name);
    let (Some(plane), Some(space)) = (work(2), work(3)) else {
        let names: Vec<String> = terms(2, 3000).into_iter().map(|w| w.name).collect();
        return Err(Error::new(Kind::Usage, format!("no work {name:?}; there are {}", names.join("; "))));
    };
    let pool = ThreadPoolBuilder::new().num_threads(1).build();
    let pool = pool.map_err(|why| Error::new(Kind::Usage, format!("no thread can be had: {why}")))?;
    pool.install(|| {
        let mut plane = ready_in(&plane, Sweeping::Fast, 1)?;
        let mut space = ready_in(&space, Sweeping::Fast, 1)?;
        (0..steps).try_for_each(|_| {
            plane.step()?;
            space.step()
        })
    })
}

/// Processor time of all threads so far, s, where the system tells.
fn cpu_seconds() -> Option<f64> {
    let mut total = 0.0;
    for task in std::fs::read_dir("/proc/self/task").ok()?.flatten() {
        let text = std::fs::read_to_string(task.path().join("schedstat")).ok()?;
        total += text.split(' ').next()?.parse::<f64>().ok()?;
    }
    Some(total * 1e-9)
}

/// Largest memory of the program so far, B, where the system tells.
fn peak_memory() -> f64 {
    let text = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|l| l.split_whitespace().next()?.parse::<f64>().ok()).map_or(f64::NAN, |kib| kib * 1024.0)
}
