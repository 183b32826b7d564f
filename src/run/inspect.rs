//! Inspection of a scene without a run: the facts and findings of the pre-flight, a short timing and every effective value.

use std::{path::Path, time::Instant};

use serde::Serialize;

use super::{missing_dimension, probe_factory, run_folder, with_threads};
use crate::{
    error::Result,
    geometry::Shape,
    math::Vector,
    output::manifest::ValueInForce,
    preflight::{self, DEFAULT_SPEED, Finding, Preflight},
    probe,
    ranks::Ranks,
    scene::{BuiltScene, Scene, SizeEstimate},
    simulation::{Dimension, Simulation},
    solid::Dim,
};

/// Longest duration of a timing, s; no step begins after it.
const LASTS: f64 = 1.0;

/// Number of particles above which an inspection estimates the cost from areas and volumes.
pub const LARGE: f64 = 4e6;

/// Approximate memory of a particle, B, in 2-D and 3-D: the memory of bundled scenes over their particles, rounded up.
const PARTICLE_BYTES: [f64; 2] = [500.0, 700.0];

/// The options of an inspection in addition to its scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InspectOptions {
    /// Scene keys and the values that replace the values of the scene.
    pub overrides: Vec<(String, String)>,
    /// Number of threads; the default is one for each processor.
    pub threads: Option<usize>,
    /// Whether to step for up to a second, in order to estimate the duration of a run on this machine.
    pub timing: bool,
}

/// The results of an inspection.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub enum Inspection {
    /// The facts and findings about the particles of the scene.
    Report(Box<InspectReport>),
    /// The cost of a scene with more than [`LARGE`] particles.
    Estimate(CostEstimate),
}

/// The cost of a run, estimated from areas and volumes without particles.
#[derive(Clone, Debug, Serialize)]
pub struct CostEstimate {
    /// Caption of the scene.
    pub title: String,
    /// Always true: it distinguishes an estimate from a report.
    pub estimate: bool,
    /// 2 or 3.
    pub dimension: usize,
    /// Number of water particles.
    pub fluid: f64,
    /// Number of boundary particles.
    pub boundary: f64,
    /// Memory, B.
    pub memory_bytes: f64,
    /// The largest time step that sound allows, s.
    pub dt_s: f64,
    /// Number of steps; a run takes slightly more.
    pub steps: f64,
    /// Simulated time at the end, s.
    pub until_s: f64,
    /// Wall time of the run on one thread, s.
    pub thread_seconds: f64,
}

impl CostEstimate {
    fn new(scene: &Scene, size: &SizeEstimate) -> Self {
        let SizeEstimate { dimension, fluid, boundary, dt, steps, .. } = *size;
        Self {
            title: scene.title.clone().unwrap_or_else(|| "untitled".into()),
            estimate: true,
            dimension,
            fluid,
            boundary,
            memory_bytes: (fluid + boundary) * PARTICLE_BYTES[dimension - 2],
            dt_s: dt,
            steps,
            until_s: scene.until,
            thread_seconds: size.particle_passes() / DEFAULT_SPEED[dimension - 2],
        }
    }
}

impl Inspection {
    /// Returns the report, or `None` for an estimate.
    pub fn report(self) -> Option<InspectReport> {
        match self {
            Self::Report(report) => Some(*report),
            Self::Estimate(_) => None,
        }
    }
}

/// The facts and findings about a scene.
#[derive(Clone, Debug, Serialize)]
pub struct InspectReport {
    /// Caption of the scene.
    pub title: String,
    /// Simulated time at the end, s.
    pub until_s: f64,
    /// The expected cost of the run and the findings.
    #[serde(flatten)]
    pub preflight: Preflight,
    /// The key and the value that determine the speed of sound, and the source of the value.
    pub sound_from: Option<ValueInForce>,
    /// The timing on this machine, if the options ask for it.
    pub timing: Option<StepTiming>,
    /// The solids.
    pub solids: Vec<SolidSummary>,
    /// The files of the probes, followed by the contact lists.
    pub series: Vec<SeriesColumns>,
    /// Every effective value and its source.
    pub values: Vec<ValueInForce>,
}

/// A solid and its boundary particles.
#[derive(Clone, Debug, Serialize)]
pub struct SolidSummary {
    /// Name of the solid.
    pub name: String,
    /// `fixed`, `driven` or `free`.
    pub role: &'static str,
    /// Number of its boundary particles.
    pub particles: usize,
    /// The properties of its mesh, if the solid has a mesh.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh: Option<MeshSummary>,
}

/// The measured properties of a solid from a mesh.
#[derive(Clone, Debug, Serialize)]
pub struct MeshSummary {
    /// Number of facets.
    pub facets: usize,
    /// Volume, m³.
    pub volume_m3: f64,
    /// Surface area, m².
    pub surface_m2: f64,
    /// Centroid in the frame of the file, m.
    pub centroid_m: Vec<f64>,
    /// Edge lengths of the bounding box, m.
    pub size_m: Vec<f64>,
}

impl MeshSummary {
    fn of<const D: usize>(shape: &Shape<D>) -> Option<Self> {
        let Shape::Mesh { mesh, .. } = shape else { return None };
        let (facets, volume) = (mesh.facets().len(), mesh.volume_properties());
        let list = |x: &Vector<3>| x.iter().copied().collect();
        let (centroid_m, size_m) = (list(&volume.centroid), list(&mesh.bounds().size()));
        Some(Self { facets, volume_m3: volume.volume, surface_m2: mesh.surface_area(), centroid_m, size_m })
    }
}

/// The file of a probe.
#[derive(Clone, Debug, Serialize)]
pub struct SeriesColumns {
    /// Stem of the file.
    pub name: String,
    /// Names of its columns, except for the time.
    pub columns: Vec<String>,
}

/// A timing of some steps of the scene, without output.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct StepTiming {
    /// Number of threads.
    pub threads: usize,
    /// Number of timed steps.
    pub steps: usize,
    /// Wall time per step, s.
    pub step_s: f64,
    /// Wall time of the whole run at that rate, s, without the outputs.
    pub run_s: f64,
}

/// Reads, resolves and builds the scene at `path` with the options `asked`, and returns its inspection. Writes no file, and
/// creates no particles if the scene has more than [`LARGE`].
///
/// # Errors
/// The errors that [`run`](super::run) would return before its first step.
pub fn inspect(path: &Path, asked: &InspectOptions) -> Result<Inspection> {
    inspect_scene(&Scene::read(&run_folder::scene_file(path), &asked.overrides)?, asked)
}

/// Inspects a `scene` as [`inspect`] does. Ignores the overrides of `asked`.
///
/// # Errors
/// Those of [`inspect`].
pub fn inspect_scene(scene: &Scene, asked: &InspectOptions) -> Result<Inspection> {
    with_threads(asked.threads, || match scene.dimension {
        #[cfg(feature = "dim2")]
        2 => build_report::<2>(scene, asked.timing),
        #[cfg(feature = "dim3")]
        3 => build_report::<3>(scene, asked.timing),
        other => Err(missing_dimension(other)),
    })
}

fn build_report<const D: usize>(scene: &Scene, timed: bool) -> Result<Inspection>
where
    Dim<D>: Dimension<D>,
{
    let parts = scene.parts::<D>(1)?;
    let size = parts.estimated_size();
    if size.fluid + size.boundary > LARGE {
        return Ok(Inspection::Estimate(CostEstimate::new(scene, &size)));
    }
    let values: Vec<ValueInForce> = scene.resolve()?.into_iter().map(ValueInForce::from).collect();
    let BuiltScene { setup, plan, initial_water, file_notes, .. } = parts.fill(&Ranks::default())?;
    // The timing reports the first alarm; a run would return to an earlier state instead.
    let mut sim = Simulation::new(setup).map_err(|e| scene.with_location(e))?.without_rollback();
    let probes = probe_factory::probes_from_plan(&plan, &mut sim).map_err(|e| scene.with_location(e))?;
    probe_factory::checks_from_plan(&plan, &probes).map_err(|e| scene.with_location(e))?;
    let columns: Vec<usize> = probes.iter().map(|p| p.columns().len()).collect();
    let preflight = preflight::preflight(&sim, &plan, initial_water, &columns);
    let mut preflight = preflight.with_file_notes(&file_notes);
    preflight.findings.extend(scene.renamed_names().iter().map(Finding::renamed_name));
    let solids = sim.system().solids().iter().map(|s| SolidSummary {
        name: s.spec.name.clone(),
        role: preflight::role_name(&s.spec.role),
        particles: s.boundary.len(),
        mesh: MeshSummary::of(&s.spec.shape),
    });
    let solids = solids.collect();
    let series = plan.probes.iter().zip(&probes).map(|(words, p)| (&words.name, p.columns()));
    let lists = plan.contacts.iter().map(|words| (&words.name, probe::ContactList::columns::<D>()));
    let series = series.chain(lists).map(|(name, columns)| SeriesColumns { name: name.clone(), columns }).collect();
    let timing = if timed { time_steps(&mut sim, &mut preflight) } else { None };
    // A value that the scene sets takes precedence over a derived value.
    let of_sound = values.iter().filter(|v| v.key == "model.c0" || v.key == "model.c0_factor");
    let sound_from = of_sound.min_by_key(|v| v.source.starts_with("default")).cloned();
    let (title, until_s) = (plan.title, plan.until);
    let report = InspectReport { title, until_s, preflight, sound_from, timing, solids, series, values };
    Ok(Inspection::Report(Box::new(report)))
}

/// Times steps for up to a second. The result excludes the first step, which begins with cold caches, unless it is the only one.
fn time_steps<const D: usize>(sim: &mut Simulation<D>, preflight: &mut Preflight) -> Option<StepTiming> {
    let begun = Instant::now();
    let mut times = Vec::new();
    while begun.elapsed().as_secs_f64() < LASTS {
        let start = Instant::now();
        if let Err(error) = sim.step() {
            preflight.findings.insert(0, Finding::timing_stopped(&error, times.len()));
            break;
        }
        times.push(start.elapsed().as_secs_f64());
    }
    let warm = if times.len() > 1 { &times[1..] } else { &times[..] };
    let step_s = warm.iter().sum::<f64>() / warm.len() as f64;
    let run_s = step_s * preflight.step.steps;
    (!warm.is_empty()).then(|| StepTiming { threads: rayon::current_num_threads(), steps: warm.len(), step_s, run_s })
}
