//! The coupling of water and bodies: the body step, the acoustic added mass, and the breakdown of loads and energy.

mod acoustic_added_mass;
mod body_step;
mod energy_budget;
mod load_breakdown;
mod mass_change;
mod moorings;
mod power_breakdown;

pub use acoustic_added_mass::stiffest_frequency;
pub(crate) use acoustic_added_mass::{AcousticAddedMass, AddedMassState};
pub use body_step::BodyStep;
pub(crate) use body_step::{Bodies, BodiesState, Hook};
#[cfg(feature = "gpu")]
pub(crate) use energy_budget::DevicePass;
pub use energy_budget::EnergyBudget;
pub(crate) use energy_budget::{Accounting, AccountingState};
pub use load_breakdown::LoadBreakdown;
pub(crate) use moorings::Moorings;
#[cfg(feature = "gpu")]
pub(crate) use power_breakdown::{PressurePass, pressure_models};

use crate::{
    math::{Pose, Vector},
    solid::{Kinematics, Role, Solid},
    system::System,
};

/// A time interval, s.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Interval {
    /// Time at the start of the interval, s.
    pub t: f64,
    /// Length of the interval, s.
    pub dt: f64,
}

/// Moves the solids to their positions half a step later: driven solids exactly, free solids at constant velocity and
/// spin.
pub(crate) fn drift_half_step<const D: usize>(system: &mut System<D>, over: Interval) {
    let half = 0.5 * over.dt;
    place(system, None, |_, solid| match &solid.spec.role {
        Role::Fixed => None,
        Role::Driven(motion) => Some(solid.prescribed_kinematics(motion, over.t + half)),
        Role::Free(_) => Some(drifted(&solid.kinematics, half)),
    });
}

/// Sets the kinematics of each solid to the value that `to` returns, if any, and places the boundary particles of the
/// solid. `over` is the length (s) of the step that ends at these kinematics.
fn place<const D: usize>(
    system: &mut System<D>,
    over: Option<f64>,
    to: impl Fn(usize, &Solid<D>) -> Option<Kinematics<D>>,
) {
    for i in 0..system.solids.len() {
        if let Some(kinematics) = to(i, &system.solids[i]) {
            match over {
                Some(dt) => system.solids[i].advance(kinematics, dt),
                None => system.solids[i].kinematics = kinematics,
            }
            system.place_boundary(i);
        }
    }
}

/// Returns the kinematics after a time `dt` (s) at constant velocity and spin.
fn drifted<const D: usize>(k: &Kinematics<D>, dt: f64) -> Kinematics<D> {
    let turn = (k.spin * dt).exp();
    let centre: Vector<D> = k.centre + k.velocity * dt;
    let pose = Pose { position: centre + turn * (k.pose.position - k.centre), rotation: turn * k.pose.rotation };
    Kinematics { pose, centre, ..*k }
}
