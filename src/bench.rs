//! Standard benchmark cases: the cost of a step, the distribution of its time, and the cost added by each term, body and
//! probe.
//!
//! The case is a dam break in a closed box, two long, one across and 1.2 high with water 0.8 long and 0.6 deep, with
//! any number of particles. Processor time is measured beside wall time, because other load on a shared machine changes
//! the wall time. Cases to be compared are measured in turns within one run.

#[cfg(feature = "gpu")]
mod device;

#[cfg(feature = "gpu")]
pub use device::{DeviceTiming, adapters, time_on_device};

use std::{
    path::{Path, PathBuf},
    time::Instant,
};

use cpu_time::ProcessTime;
use serde::Serialize;

use crate::{
    error::{Error, ErrorKind, Result},
    ranks::Ranks,
    run::{orders::Leader, outputs, probe_factory, thread_pool},
    scene::{BuiltScene, Scene},
    simulation::{Dimension, Simulation, TimeSpent},
    solid::Dim,
};

/// Least duration of one timing, s.
const LASTS: f64 = 0.5;

/// Depth of the water, m.
const DEPTH: f64 = 0.6;

/// A benchmark case: its number of water particles and its changes of the scene.
#[derive(Clone, Debug)]
pub struct BenchCase {
    /// Name of the case.
    pub name: String,
    /// Dimension, 2 or 3.
    pub dimension: usize,
    /// Approximate number of water particles.
    pub water: usize,
    /// Scene keys that differ from the standard model, and their values.
    pub overrides: Vec<(&'static str, &'static str)>,
    /// Whether a box floats in the water.
    pub with_body: bool,
    /// The probes, as TOML entries of a scene.
    pub probes_toml: String,
    /// Length of the tank relative to the standard tank, 1 or more; the additional length is dry.
    pub dry: f64,
    /// Simulated time before the timing, in units of √(depth/g).
    pub spin_up: f64,
    /// Whether the model is the shipped default, and not the standard one.
    pub default_model: bool,
}

/// The result of a timing.
#[derive(Clone, Debug, Serialize)]
pub struct BenchTiming {
    /// Name of the case.
    pub work: String,
    /// Dimension.
    pub dimension: usize,
    /// Number of threads.
    pub threads: usize,
    /// Number of water particles.
    pub water: usize,
    /// Number of boundary particles near water.
    pub wet: usize,
    /// Number of boundary particles without water near them.
    pub dry: usize,
    /// Number of timed steps.
    pub steps: usize,
    /// Wall time per step, s.
    pub step_s: f64,
    /// Water and wet boundary particles times steps per second of wall time, 1/s.
    pub particle_steps_per_s: f64,
    /// Processor time per particle and step, ns.
    pub cpu_ns: f64,
    /// Interacting pairs per particle; each pair is counted from both sides.
    pub pairs: f64,
    /// Time of the pair sweep, summed over all threads, per pair as counted in `pairs`, ns.
    pub pair_ns: f64,
    /// Share of the step's time for lists and sorting, %. The remaining time moves and packs particles.
    pub lists_percent: f64,
    /// Share of the step's time for the pairs, %.
    pub pairs_percent: f64,
    /// Share of the step's time for the bodies, %.
    pub bodies_percent: f64,
    /// Time to create the first particles and lists, s, with the largest number of threads of any timing of the case.
    pub setup_s: f64,
    /// Peak memory of the program since it began this case, divided by the number of particles of the case, B.
    pub peak_bytes: f64,
}

/// The effective kinematic viscosity of the shipped default model in the water of the standard case.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DefaultViscosity {
    /// Dimension.
    pub dimension: usize,
    /// Particle spacing, m.
    pub dp_m: f64,
    /// Depth of the water, m.
    pub depth_m: f64,
    /// Speed of sound, m/s.
    pub c0_mps: f64,
    /// Smoothing length, m.
    pub h_m: f64,
    /// Effective kinematic viscosity of a shear flow, m²/s.
    pub viscosity_m2ps: f64,
}

impl BenchCase {
    /// Returns the standard case with the standard model.
    pub fn standard(dimension: usize, water: usize) -> Self {
        let (sets, watched) = (Vec::new(), String::new());
        Self {
            name: "wendland".into(),
            dimension,
            water,
            overrides: sets,
            with_body: false,
            probes_toml: watched,
            dry: 1.0,
            spin_up: 0.0,
            default_model: false,
        }
    }

    /// Returns the same case under another name with other scene keys.
    pub fn with_overrides(&self, name: &str, sets: &[(&'static str, &'static str)]) -> Self {
        Self { name: name.into(), overrides: sets.to_vec(), ..self.clone() }
    }

    /// Returns the particle spacing, m; its inverse is a whole number per metre.
    fn dp(&self) -> f64 {
        1.0 / (1.0 / (0.8 * DEPTH / self.water as f64).powf(1.0 / self.dimension as f64)).round().max(10.0)
    }

    /// Returns the scene of the case.
    fn scene(&self) -> Result<Scene> {
        if self.default_model {
            return self.scene_with("");
        }
        self.scene_with(&format!(
            "model = {{ h_over_dp = {:?}, walls = \"dbc\", slip = \"partial\", c0_factor = 20.0 }}\n\
             time = {{ scheme = {{ verlet = {{ euler_every = 50 }} }}, cfl = 0.2 }}",
            3f64.sqrt()
        ))
    }

    /// Returns the scene of the case with the entries `model` of its sections `model` and `time`.
    fn scene_with(&self, model: &str) -> Result<Scene> {
        let dp = self.dp();
        let cells = |x: f64| (x / dp).round() * dp;
        let size = |along: f64, up: f64| match self.dimension {
            2 => vec![cells(along), cells(up)],
            _ => vec![cells(along), 1.0, cells(up)],
        };
        let (origin, pool, tank) = (vec![0.0; self.dimension], size(0.8, DEPTH), size(2.0 * self.dry, 1.2));
        let mut text = format!(
            "dimension = {}\ndp = {dp:?}\nuntil = 1000.0\n{}
             {model}
             water = [{{ fill = {{ box = {{ min = {origin:?}, max = {pool:?} }} }} }}]
             [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = {tank:?} }} }}\n",
            self.dimension,
            if self.probes_toml.contains("[frames]") { "" } else { "frames = \"off\"" },
        );
        if self.with_body {
            let axes = ["x = ", "y = ", "z = "];
            let middle = if self.dimension == 2 { vec![0.4, DEPTH] } else { vec![0.4, 0.5, DEPTH] };
            let at: Vec<String> = axes.iter().zip(&middle).map(|(axis, x)| format!("{axis}{:?}", cells(*x))).collect();
            text += &format!(
                "[[solid]]\nname = \"float\"\nfree = {{ density = 500.0 }}\nshape = {{ box = {{ size = {:?} }} }}\n\
                 at = {{ {} }}\n",
                vec![cells(0.2); self.dimension],
                at.join(", ")
            );
        }
        text += &self.probes_toml;
        let sets: Vec<_> = self.overrides.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
        Scene::parse(&text, Path::new(""), &sets)
    }
}

/// Returns the viscosity of the shipped default in the standard case of `water` particles.
///
/// # Errors
/// `Usage` if this program was built without the dimension.
pub fn default_viscosity(dimension: usize, water: usize) -> Result<DefaultViscosity> {
    let case = BenchCase { default_model: true, ..BenchCase::standard(dimension, water) };
    let scene = case.scene()?;
    let (model, depth_m) = match dimension {
        #[cfg(feature = "dim2")]
        2 => scene.layout::<2>().map(|layout| (layout.model, layout.still_water.depth))?,
        #[cfg(feature = "dim3")]
        3 => scene.layout::<3>().map(|layout| (layout.model, layout.still_water.depth))?,
        n => return Err(missing_dimension(n)),
    };
    let (c0_mps, h_m) = (model.c0, model.h);
    let viscosity_m2ps = model.viscosity.effective(c0_mps, h_m, 9.81, dimension, 1.0);
    Ok(DefaultViscosity { dimension, dp_m: case.dp(), depth_m, c0_mps, h_m, viscosity_m2ps })
}

fn missing_dimension(dimension: usize) -> Error {
    Error::new(ErrorKind::Usage, format!("this program was built without {dimension}-D"))
}

/// Prepares every case. Then, for each number of `threads`, times all cases one after another, in `rounds` rounds. Returns for each
/// number of threads and each case the timing of the round with the least processor time.
///
/// # Errors
/// Any error of a simulation, and `Usage` if the threads cannot be created.
pub fn time(works: &[BenchCase], threads: &[usize], rounds: usize) -> Result<Vec<BenchTiming>> {
    let pools = threads.iter().map(|&n| Ok((n, thread_pool(Some(n))?))).collect::<Result<Vec<_>>>()?;
    let Some((_, largest)) = pools.iter().max_by_key(|(n, _)| n) else { return Ok(Vec::new()) };
    let mut ready = largest.install(|| works.iter().map(prepare).collect::<Result<Vec<_>>>())?;
    let mut timings = Vec::new();
    for (threads, pool) in &pools {
        timings.extend(pool.install(|| {
            let mut best: Vec<Option<BenchTiming>> = vec![None; works.len()];
            for _ in 0..rounds {
                for (ready, best) in ready.iter_mut().zip(&mut best) {
                    let timing = ready.time(*threads)?;
                    if best.as_ref().is_none_or(|b| timing.cpu_ns < b.cpu_ns) {
                        *best = Some(timing);
                    }
                }
            }
            Ok::<_, Error>(best.into_iter().flatten().collect::<Vec<_>>())
        })?);
    }
    Ok(timings)
}

/// A prepared case of either dimension.
trait TimedCase: Send {
    fn step(&mut self) -> Result<()>;
    fn time(&mut self, threads: usize) -> Result<BenchTiming>;
}

fn prepare(work: &BenchCase) -> Result<Box<dyn TimedCase>> {
    match work.dimension {
        #[cfg(feature = "dim2")]
        2 => Ok(Box::new(PreparedCase::<2>::new(work)?)),
        #[cfg(feature = "dim3")]
        3 => Ok(Box::new(PreparedCase::<3>::new(work)?)),
        n => Err(missing_dimension(n)),
    }
}

struct PreparedCase<const D: usize> {
    sim: Simulation<D>,
    /// The outputs and their folder.
    outputs: Option<(outputs::Outputs<D>, TemporaryFolder)>,
    name: String,
    setup_s: f64,
    peak: f64,
    pairs: f64,
}

/// A folder that is removed when the value is dropped.
struct TemporaryFolder(PathBuf);

impl Drop for TemporaryFolder {
    fn drop(&mut self) {
        // A folder that cannot be removed stays among the temporary files, which the operating system removes.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

impl<const D: usize> PreparedCase<D>
where
    Dim<D>: Dimension<D>,
{
    fn new(work: &BenchCase) -> Result<Self> {
        reset_peak_memory();
        let start = Instant::now();
        let BuiltScene { setup, plan, .. } = work.scene()?.build::<D>()?;
        let mut sim = Simulation::new(setup)?;
        let setup_s = start.elapsed().as_secs_f64();
        let until = work.spin_up * (DEPTH / 9.81).sqrt();
        for _ in 0..3 {
            sim.step()?;
        }
        while sim.time() < until {
            sim.step()?;
        }
        let peak = peak_memory();
        let outputs = if work.probes_toml.is_empty() {
            None
        } else {
            let name = work.name.replace([' ', ','], "-");
            let name = format!("pontoon-bench-{}-{D}d-{name}", std::process::id());
            let folder = TemporaryFolder(std::env::temp_dir().join(name));
            Some((
                outputs::Outputs::new(&plan, probe_factory::probes_from_plan(&plan, &mut sim)?, &folder.0, None)?,
                folder,
            ))
        };
        let system = sim.system();
        let mut pairs = 0usize;
        for (i, r) in system.fluid().r.iter().enumerate() {
            system.visit_fluid_near(r, &mut |j, _, _| pairs += usize::from(j != i));
            // The boundary particle counts the same pair as well.
            system.visit_boundary_near(r, &mut |_, _, _| pairs += 2);
        }
        let pairs = pairs as f64 / (system.fluid().len() + system.boundary_near_fluid_count()) as f64;
        Ok(Self { sim, outputs, name: work.name.clone(), setup_s, peak, pairs })
    }
}

impl<const D: usize> TimedCase for PreparedCase<D> {
    fn step(&mut self) -> Result<()> {
        self.sim.step()?;
        if let Some((outputs, _)) = &mut self.outputs {
            outputs.write_due(&self.sim, &Leader::new(Ranks::default()))?;
        }
        Ok(())
    }

    fn time(&mut self, threads: usize) -> Result<BenchTiming> {
        let (before, cpu, start) = (self.sim.time_spent(), ProcessTime::try_now().ok(), Instant::now());
        let mut steps = 0;
        while start.elapsed().as_secs_f64() < LASTS || steps < 3 {
            self.step()?;
            steps += 1;
        }
        let wall = start.elapsed().as_secs_f64();
        let spent = cpu.and_then(|cpu| cpu.try_elapsed().ok());
        let cpu = spent.map_or(wall * threads as f64, |spent| spent.as_secs_f64());
        let TimeSpent { steps: all, lists, pairs, bodies } = self.sim.time_spent();
        let all = (all - before.steps).as_secs_f64();
        let (lists, bodies) = ((lists - before.lists).as_secs_f64(), (bodies - before.bodies).as_secs_f64());
        let pairs = (pairs - before.pairs).as_secs_f64();
        let system = self.sim.system();
        let (water, wet) = (system.fluid().len(), system.boundary_near_fluid_count());
        let particle_steps = (steps * (water + wet)) as f64;
        Ok(BenchTiming {
            work: self.name.clone(),
            dimension: D,
            threads,
            water,
            wet,
            dry: system.boundary().len() - wet,
            steps,
            step_s: wall / steps as f64,
            particle_steps_per_s: particle_steps / wall,
            cpu_ns: cpu / particle_steps * 1e9,
            pairs: self.pairs,
            pair_ns: pairs * threads as f64 / (particle_steps * self.pairs) * 1e9,
            lists_percent: lists / all * 100.0,
            pairs_percent: pairs / all * 100.0,
            bodies_percent: bodies / all * 100.0,
            setup_s: self.setup_s,
            peak_bytes: self.peak / (water + wet) as f64,
        })
    }
}

/// Returns the cases that each add a term or another option of a scene to the standard case, which is the first entry.
pub fn term_cases(dimension: usize, water: usize) -> Vec<BenchCase> {
    let base = BenchCase::standard(dimension, water);
    let mut works = vec![
        base.clone(),
        base.with_overrides("without viscosity", &[("model.viscosity", "none")]),
        base.with_overrides("without diffusion", &[("model.diffusion", "none")]),
        base.with_overrides("without both", &[("model.viscosity", "none"), ("model.diffusion", "none")]),
        base.with_overrides("molteni", &[("model.diffusion", "molteni")]),
        base.with_overrides("laminar", &[("model.viscosity", "laminar")]),
        base.with_overrides("sps", &[("model.viscosity", "sps")]),
        base.with_overrides("shifting", &[("model.shifting", "away_from_solids")]),
        base.with_overrides("corrected gradients", &[("model.gradient", "corrected")]),
        base.with_overrides("sps, shifting", &[("model.viscosity", "sps"), ("model.shifting", "away_from_solids")]),
        base.with_overrides("cubic", &[("model.kernel", "{ cubic = { tensile = false } }")]),
        base.with_overrides("cubic, tensile", &[("model.kernel", "cubic")]),
        base.with_overrides("symplectic", &[("time.scheme", "symplectic")]),
    ];
    let named = |name: &str| base.with_overrides(name, &[]);
    works.extend([
        BenchCase { with_body: true, ..named("a floating box") },
        BenchCase { dry: 2.0, ..named("twice the tank, dry") },
        BenchCase { dry: 4.0, ..named("four times the tank, dry") },
    ]);
    let place = if dimension == 2 { "[0.4, 0.1]" } else { "[0.4, 0.5, 0.1]" };
    let surface = if dimension == 2 { "{ x = 0.4 }" } else { "{ x = 0.4, y = 0.5 }" };
    let probes =
        [("force", "\"tank\""), ("energy", "true"), ("elevation", surface), ("velocity", place), ("pressure", place)];
    works.extend(probes.map(|(kind, what)| BenchCase {
        probes_toml: format!("[[probe]]\n{kind} = {what}\nevery = 1e-9\n"),
        ..named(&format!("{kind} at every step"))
    }));
    // This time gives the same number of steps if the speed of sound alone limits them.
    let steps = 20.0 * 0.2 * 3f64.sqrt() * base.dp() / (20.0 * (9.81 * DEPTH).sqrt());
    works.push(BenchCase { probes_toml: format!("[frames]\nevery = {steps:?}\n"), ..named("a frame every 20 steps") });
    works
}

/// Makes `steps` steps of the case `name` of [`term_cases`] in 2-D and in 3-D on one thread, with 3,000 water particles
/// each. This small case is meant for counting instructions.
///
/// # Errors
/// `Usage` if no case has this name, and any error of a simulation.
pub fn run_fixed_steps(steps: usize, name: &str) -> Result<()> {
    let work = |dimension| term_cases(dimension, 3000).into_iter().find(|w| w.name == name);
    let (Some(plane), Some(space)) = (work(2), work(3)) else {
        let names: Vec<String> = term_cases(2, 3000).into_iter().map(|w| w.name).collect();
        return Err(Error::new(ErrorKind::Usage, format!("no work {name:?}; there are {}", names.join("; "))));
    };
    thread_pool(Some(1))?.install(|| {
        let mut plane = prepare(&plane)?;
        let mut space = prepare(&space)?;
        (0..steps).try_for_each(|_| {
            plane.step()?;
            space.step()
        })
    })
}

/// Returns the peak memory of the program since [`reset_peak_memory`], B, if the operating system reports it.
fn peak_memory() -> f64 {
    let text = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|l| l.split_whitespace().next()?.parse::<f64>().ok()).map_or(f64::NAN, |kib| kib * 1024.0)
}

/// Resets the peak memory if the operating system can do so; otherwise the peak is that of the whole program.
fn reset_peak_memory() {
    let _ = std::fs::write("/proc/self/clear_refs", "5");
}
