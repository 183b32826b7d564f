//! Timings of whole steps on a device.

use std::time::Instant;

use serde::Serialize;

use super::{BenchCase, missing_dimension};
use crate::{
    device::Adapter,
    error::{Error, ErrorCode, ErrorKind, Result},
    scene::BuiltScene,
    simulation::{Dimension, Simulation},
    solid::Dim,
};

/// Least duration of a timing, s.
const LASTS: f64 = 2.0;

/// The timing of steps on a device.
#[derive(Clone, Debug, Serialize)]
pub struct DeviceTiming {
    /// Name of the case.
    pub work: String,
    /// Name of the device.
    pub device: String,
    /// Dimension.
    pub dimension: usize,
    /// Number of water particles.
    pub water: usize,
    /// Number of boundary particles.
    pub boundary: usize,
    /// Number of timed steps.
    pub steps: u64,
    /// Wall time per step, s.
    pub step_s: f64,
    /// Water particles times steps per second of wall time, 1/s.
    pub particle_steps_per_s: f64,
    /// Water particles times force passes per second of wall time, 1/s.
    pub particle_passes_per_s: f64,
    /// Memory on the device per particle, without the neighbour lists and with them, B.
    pub bytes: [f64; 2],
    /// Time to make the first particles on the host, and to bring them to the device, s.
    pub setup_s: [f64; 2],
}

/// Returns the adapters of this machine.
pub fn adapters() -> Vec<Adapter> {
    crate::device::adapters()
}

impl BenchCase {
    /// Returns the standard case with the shipped defaults.
    pub fn with_defaults(dimension: usize, water: usize) -> Self {
        Self { name: "defaults".into(), default_model: true, ..Self::standard(dimension, water) }
    }
}

/// Times a case on the device `name`.
///
/// # Errors
/// `Usage` if there is no such device, or it failed.
pub fn time_on_device(case: &BenchCase, name: &str) -> Result<DeviceTiming> {
    match case.dimension {
        #[cfg(feature = "dim2")]
        2 => time_in_dimension::<2>(case, name),
        #[cfg(feature = "dim3")]
        3 => time_in_dimension::<3>(case, name),
        n => Err(missing_dimension(n)),
    }
}

fn time_in_dimension<const D: usize>(case: &BenchCase, name: &str) -> Result<DeviceTiming>
where
    Dim<D>: Dimension<D>,
{
    let start = Instant::now();
    let BuiltScene { setup, .. } = case.scene()?.build::<D>()?;
    let sim = Simulation::new(setup)?.without_rollback();
    let on_host = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let mut sim = sim.on_device(name)?;
    let to_device = start.elapsed().as_secs_f64();
    let none = || Error::new(ErrorKind::Usage, "no device").with_code(ErrorCode::NoDevice);
    for _ in 0..4 {
        sim.step_to_pause(f64::INFINITY, f64::INFINITY)?;
    }
    let (before, passes, start) = (sim.steps(), sim.force_passes(), Instant::now());
    while start.elapsed().as_secs_f64() < LASTS {
        sim.step_to_pause(f64::INFINITY, f64::INFINITY)?;
    }
    let wall = start.elapsed().as_secs_f64();
    let (steps, passes) = (sim.steps() - before, sim.force_passes() - passes);
    let (water, boundary) = (sim.system().fluid().len(), sim.system().boundary().len());
    let [all, lists] = sim.device_memory().ok_or_else(none)?;
    let particles = (water + boundary) as f64;
    Ok(DeviceTiming {
        work: case.name.clone(),
        device: sim.device().ok_or_else(none)?.name.clone(),
        dimension: D,
        water,
        boundary,
        steps,
        step_s: wall / steps as f64,
        particle_steps_per_s: water as f64 * steps as f64 / wall,
        particle_passes_per_s: water as f64 * passes as f64 / wall,
        bytes: [(all - lists) as f64 / particles, all as f64 / particles],
        setup_s: [on_host, to_device],
    })
}
