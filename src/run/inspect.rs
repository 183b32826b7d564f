//! What a scene would run, without running it: the pre-flight's facts and findings, a short timing, every value in force.

use std::{path::Path, time::Instant};

use serde::Serialize;

use super::{missing_dimension, probe_factory, run_folder, with_threads};
use crate::{
    error::Result,
    geometry::Shape,
    math::Vector,
    model::Dimension,
    output::manifest::ValueInForce,
    preflight::{self, Finding, Preflight},
    probe,
    scene::{BuiltScene, Scene},
    simulation::Simulation,
    solid::Dim,
};

/// How long a timing lasts at most, s: no step is begun after it.
const LASTS: f64 = 1.0;

/// What an inspection is asked for beside its scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InspectOptions {
    /// Keys of the scene and the values that replace the scene's own.
    pub overrides: Vec<(String, String)>,
    /// Threads; by default one for each processor.
    pub threads: Option<usize>,
    /// Whether to step for up to a second, to tell how long a run will take on this machine.
    pub timing: bool,
}

/// What a scene would run.
#[derive(Clone, Debug, Serialize)]
pub struct InspectReport {
    /// Its caption.
    pub title: String,
    /// Simulated time at the end, s.
    pub until_s: f64,
    /// What it will cost and what looks wrong.
    #[serde(flatten)]
    pub preflight: Preflight,
    /// Where the speed of sound comes from: key, value and who said it.
    pub sound_from: Option<ValueInForce>,
    /// How fast this machine is, if it was asked for.
    pub timing: Option<StepTiming>,
    /// The solids.
    pub solids: Vec<SolidSummary>,
    /// Files of the probes, lists last.
    pub series: Vec<SeriesColumns>,
    /// Every value in force and where it comes from.
    pub values: Vec<ValueInForce>,
}

/// A solid and its boundary particles.
#[derive(Clone, Debug, Serialize)]
pub struct SolidSummary {
    /// Its name.
    pub name: String,
    /// `fixed`, `driven` or `free`.
    pub role: &'static str,
    /// Number of its boundary particles.
    pub particles: usize,
    /// What it is as a mesh, if it is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh: Option<MeshSummary>,
}

/// A solid from a mesh, measured.
#[derive(Clone, Debug, Serialize)]
pub struct MeshSummary {
    /// Number of its facets.
    pub facets: usize,
    /// Its volume, m³.
    pub volume_m3: f64,
    /// Its surface, m².
    pub surface_m2: f64,
    /// Its centroid in the file's frame, m.
    pub centroid_m: Vec<f64>,
    /// The edges of the box around it, m.
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
    /// Its columns beside the time.
    pub columns: Vec<String>,
}

/// Some steps of the scene, timed. Nothing was written.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct StepTiming {
    /// Threads.
    pub threads: usize,
    /// Steps timed.
    pub steps: usize,
    /// Wall time of a step, s.
    pub step_s: f64,
    /// Wall time of the whole run at that pace, s; outputs come on top.
    pub run_s: f64,
}

/// Reads, resolves and builds the scene at `path` with the changes of `asked`; writes nothing.
///
/// # Errors
/// Those that [`run`](super::run) would meet before its first step.
pub fn inspect(path: &Path, asked: &InspectOptions) -> Result<InspectReport> {
    let scene = Scene::read(&run_folder::scene_file(path), &asked.overrides)?;
    with_threads(asked.threads, || match scene.dimension {
        #[cfg(feature = "dim2")]
        2 => build_report::<2>(&scene, asked.timing),
        #[cfg(feature = "dim3")]
        3 => build_report::<3>(&scene, asked.timing),
        other => Err(missing_dimension(other)),
    })
}

fn build_report<const D: usize>(scene: &Scene, timed: bool) -> Result<InspectReport>
where
    Dim<D>: Dimension<D>,
{
    let values: Vec<ValueInForce> = scene.resolve()?.into_iter().map(ValueInForce::from).collect();
    let BuiltScene { setup, plan, removed_by_solids, still_water, .. } = scene.build::<D>()?;
    // The timing tells the first alarm, which a run would answer by going back.
    let mut sim = Simulation::new(setup).map_err(|e| scene.with_location(e))?.without_rollback();
    let probes = probe_factory::probes_from_plan(&plan, &mut sim)?;
    probe_factory::checks_from_plan(&plan, &probes)?;
    let columns: Vec<usize> = probes.iter().map(|p| p.columns().len()).collect();
    let mut preflight = preflight::preflight(&sim, &plan, still_water, removed_by_solids, &columns);
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
    // What was said wins over what follows from it.
    let of_sound = values.iter().filter(|v| v.key == "model.c0" || v.key == "model.c0_factor");
    let sound_from = of_sound.min_by_key(|v| v.source.starts_with("default")).cloned();
    Ok(InspectReport { title: plan.title, until_s: plan.until, preflight, sound_from, timing, solids, series, values })
}

/// Steps for up to a second, the first step left out unless it takes all the time: it begins with cold caches.
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
