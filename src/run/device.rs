//! A run whose water is on a device: what is fetched for the outputs, and when.

use super::outputs::Outputs;
#[cfg(not(feature = "gpu"))]
use crate::error::{Error, ErrorCode, ErrorKind};
#[cfg(feature = "gpu")]
use crate::{device::refused, probe::ProbeReads};
use crate::{error::Result, scene::Scene, simulation::Simulation};

/// Puts the water of `sim` on the device that `scene` names, if it names one.
#[cfg(feature = "gpu")]
pub(super) fn place_on_device<const D: usize>(
    scene: &Scene,
    sim: Simulation<D>,
    outputs: &Outputs<D>,
) -> Result<Simulation<D>> {
    let Some(name) = scene.device_name() else { return Ok(sim) };
    match outputs.boundary_force_probe() {
        Some(probe) => Err(refused(&format!("the force on a patch, which probe {probe:?} reads,"))),
        None => sim.on_device(name),
    }
}

/// Refuses a device: this program has none.
#[cfg(not(feature = "gpu"))]
pub(super) fn place_on_device<const D: usize>(
    scene: &Scene,
    sim: Simulation<D>,
    _outputs: &Outputs<D>,
) -> Result<Simulation<D>> {
    let Some(name) = scene.device_name() else { return Ok(sim) };
    Err(Error::new(ErrorKind::Usage, format!("this program cannot use the device {name:?}"))
        .with_code(ErrorCode::NoDevice)
        .help("build it with the feature gpu:  cargo build --release --features gpu;  or leave --device (model.device) out"))
}

/// Advances by a step, or on a device until an output is due, and fetches what the outputs then read; not past `until` (s).
pub(super) fn step<const D: usize>(sim: &mut Simulation<D>, outputs: &Outputs<D>, until: f64) -> Result<()> {
    #[cfg(feature = "gpu")]
    if sim.device().is_some() {
        sim.step_to_pause(outputs.next_due(), until)?;
        let reads = outputs.reads_at(sim.time());
        return match (reads.contains(&ProbeReads::Water), reads.is_empty()) {
            (true, _) => sim.fetch_from_device(),
            (_, false) => sim.fetch_loads(),
            (false, true) => Ok(()),
        };
    }
    let _ = outputs;
    sim.step_to(until)
}

/// Fetches the state from a device, if one has it.
pub(super) fn fetch<const D: usize>(sim: &mut Simulation<D>) -> Result<()> {
    #[cfg(feature = "gpu")]
    sim.fetch_from_device()?;
    let _ = sim;
    Ok(())
}
