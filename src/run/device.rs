//! A run whose water is on a device, or on several ranks: what is fetched for the outputs, and when.

use super::{
    orders::{Leader, Order},
    outputs::Outputs,
};
#[cfg(not(feature = "gpu"))]
use crate::error::ErrorCode;
#[cfg(feature = "gpu")]
use crate::probe::ProbeReads;
use crate::{
    error::{Error, ErrorKind, Result},
    math::Bounds,
    ranks::Ranks,
    scene::Scene,
    simulation::{Simulation, water_of_ranks},
};

/// Refuses a device for a run on several `ranks`.
///
/// # Errors
/// `Usage` if the scene names one.
pub(super) fn check_ranks(scene: &Scene, ranks: &Ranks) -> Result<()> {
    match scene.device_name() {
        Some(name) if ranks.count() > 1 => {
            let what = format!("the device {name:?} computes a run alone, and this one has {} ranks", ranks.count());
            Err(Error::new(ErrorKind::Usage, what).help("leave --device (model.device) out, or start one process"))
        }
        _ => Ok(()),
    }
}

/// Puts the water of `sim` on the device that `scene` names, if it names one.
#[cfg(feature = "gpu")]
pub(super) fn place_on_device<const D: usize>(scene: &Scene, sim: Simulation<D>) -> Result<Simulation<D>> {
    match scene.device_name() {
        Some(name) => sim.on_device(name),
        None => Ok(sim),
    }
}

/// Refuses a device: this program has none.
#[cfg(not(feature = "gpu"))]
pub(super) fn place_on_device<const D: usize>(scene: &Scene, sim: Simulation<D>) -> Result<Simulation<D>> {
    let Some(name) = scene.device_name() else { return Ok(sim) };
    Err(Error::new(ErrorKind::Usage, format!("this program cannot use the device {name:?}"))
        .with_code(ErrorCode::NoDevice)
        .help("build it with the feature gpu:  cargo build --release --features gpu;  or leave --device (model.device) out"))
}

/// Takes a step or, on a device, steps until an output is due, but not past `until` (s). Fetches the data that the due outputs
/// read. The ranks that `leader` leads take the step too.
pub(super) fn step<const D: usize>(
    sim: &mut Simulation<D>,
    outputs: &Outputs<D>,
    leader: &Leader,
    until: f64,
) -> Result<()> {
    #[cfg(feature = "gpu")]
    if sim.device().is_some() {
        sim.step_to_pause(outputs.next_due(), until)?;
        let reads = outputs.reads_at(sim.time());
        return if reads.contains(&ProbeReads::BoundaryForces) {
            sim.fetch_from_device()
        } else if reads.contains(&ProbeReads::Water) {
            sim.fetch_water()
        } else if !reads.is_empty() {
            sim.fetch_loads()
        } else {
            Ok(())
        };
    }
    leader.order(Order::Step, sim.time())?;
    sim.step_with_own_water(until)?;
    let ranges = outputs.water_ranges(sim.system(), sim.time());
    fetch(sim, leader, ranges)
}

/// Fetches the data that the last readings need.
pub(super) fn fetch_for_last_readings<const D: usize>(
    sim: &mut Simulation<D>,
    outputs: &Outputs<D>,
    leader: &Leader,
) -> Result<()> {
    #[cfg(feature = "gpu")]
    if outputs.reads_at(f64::INFINITY).contains(&ProbeReads::BoundaryForces) {
        sim.fetch_from_device()?;
    }
    let ranges = outputs.water_ranges(sim.system(), f64::INFINITY);
    fetch(sim, leader, ranges)
}

/// Fetches the state from a device, if it is on one. Also fetches the water of other ranks, if it is on them: that within the boxes
/// `ranges` (m), or all without a list of boxes.
pub(super) fn fetch<const D: usize>(
    sim: &mut Simulation<D>,
    leader: &Leader,
    ranges: Option<Vec<Bounds<D>>>,
) -> Result<()> {
    #[cfg(feature = "gpu")]
    sim.fetch_water()?;
    match ranges {
        _ if sim.system().status.has_all_water => {}
        Some(ranges) if ranges.is_empty() => {}
        Some(ranges) => {
            leader.order(Order::GatherNear, sim.time())?;
            water_of_ranks::know_within(sim, &ranges);
        }
        None => {
            leader.order(Order::Gather, sim.time())?;
            sim.gather_water(false);
        }
    }
    Ok(())
}
