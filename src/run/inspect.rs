//! What a scene would run, without running it.

use std::path::Path;

use super::{folder, not_built, outputs};
use crate::{
    error::Result,
    model::Dimension,
    record::manifest::Count,
    scene::{Built, Resolved, Scene},
    simulation::Simulation,
    solid::{Dim, Role},
};

/// What a scene would run.
pub struct Report {
    /// Its caption.
    pub title: String,
    /// 2 or 3.
    pub dimension: usize,
    /// Simulated time at the end, s.
    pub until: f64,
    /// How many particles of each sort.
    pub particles: Count,
    /// Name, role and number of skin particles of each solid.
    pub solids: Vec<(String, &'static str, usize)>,
    /// The largest time step that sound and the Courant number allow, CFL h/c₀ (s).
    pub dt: f64,
    /// Files of the probes, with their columns.
    pub series: Vec<(String, Vec<String>)>,
    /// Remarks: water removed from solids, and the like.
    pub warnings: Vec<String>,
    /// Every value in force and where it comes from.
    pub values: Vec<Resolved>,
}

/// Reads, resolves and builds the scene at `path` with the changes `sets`; runs nothing, writes nothing.
///
/// # Errors
/// Those that [`run`](super::run) would meet before its first step.
pub fn inspect(path: &Path, sets: &[(String, String)]) -> Result<Report> {
    let scene = Scene::read(&folder::scene_file(path), sets)?;
    match scene.dimension {
        #[cfg(feature = "dim2")]
        2 => report::<2>(&scene),
        #[cfg(feature = "dim3")]
        3 => report::<3>(&scene),
        other => Err(not_built(other)),
    }
}

fn report<const D: usize>(scene: &Scene) -> Result<Report>
where
    Dim<D>: Dimension<D>,
{
    let values = scene.resolve()?;
    let Built { setup, plan, warnings, .. } = scene.build::<D>()?;
    let dt = (setup.model.cfl * setup.model.h / setup.model.c0).min(setup.model.dt_max);
    let sim = Simulation::new(setup)?;
    let system = sim.system();
    let probes = outputs::probes(&plan, system)?;
    outputs::checks(&plan, &probes)?;
    let role = |role: &Role<D>| match role {
        Role::Fixed => "fixed",
        Role::Driven(_) => "driven",
        Role::Free(_) => "free",
    };
    Ok(Report {
        title: plan.title,
        dimension: D,
        until: plan.until,
        particles: Count { fluid: system.fluid().len(), boundary: system.skin().len() },
        solids: system.solids().iter().map(|s| (s.spec.name.clone(), role(&s.spec.role), s.skin.len())).collect(),
        dt,
        series: plan.probes.iter().zip(&probes).map(|(words, p)| (words.name.clone(), p.columns())).collect(),
        warnings,
        values,
    })
}
