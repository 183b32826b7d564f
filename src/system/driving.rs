//! Uniform body forces beside gravity: one that holds the discharge of a periodic channel, and that of a towed frame.
//!
//! The force of a channel with the length L along its axis acts on water and bodies alike, as the slope of a river does. With the
//! discharge Q = Σ V₀ u/L, the mean velocity U of the water, its value U₀ at the start and U_s at the discharge to be held,
//!
//!   a = s − (2/τ) (U − U₀),   ds/dt = (U_s − U)/τ²,
//!
//! so that U follows U_s without overshoot, as exp(−t/τ) (1 + t/τ), and a becomes the resistance of the channel per mass.
//!
//! In a frame that is towed with the velocity U_t(t) everything has the acceleration −dU_t/dt.

use serde::{Deserialize, Serialize};

use super::{System, setup};
use crate::{
    error::{Error, Result},
    math::Vector,
    solid::TimeFunction,
};

/// A current along a periodic axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Current {
    /// Number of the axis.
    pub axis: usize,
    /// Discharge in the sense of the axis, m³/s (m²/s in 2-D).
    pub discharge: f64,
    /// τ, s.
    pub response: f64,
}

impl Current {
    /// A current along axis number `axis` with this `discharge` (m³/s; m²/s in 2-D), followed within the time `response` (s).
    pub fn new(axis: usize, discharge: f64, response: f64) -> Self {
        Self { axis, discharge, response }
    }
}

/// A frame that moves along an axis.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct TowedFrame {
    /// Number of the axis.
    pub axis: usize,
    /// Velocity of the frame over the ground, m/s.
    pub velocity: TimeFunction,
}

impl TowedFrame {
    /// A frame that moves with `velocity` (m/s) along axis number `axis`.
    pub fn new(axis: usize, velocity: impl Into<TimeFunction>) -> Self {
        Self { axis, velocity: velocity.into() }
    }
}

/// What drives water and bodies beside gravity.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Driving {
    /// A current in a periodic channel.
    pub current: Option<Current>,
    /// The motion of the frame.
    pub towed: Option<TowedFrame>,
}

impl Driving {
    /// Refuses forces that have no meaning in a scene that is `periodic` along some axes.
    pub(super) fn check<const D: usize>(&self, periodic: &super::Periodic<D>) -> Result<()> {
        if let Some(Current { axis, discharge, response }) = self.current {
            if periodic.get(axis).is_none_or(Option::is_none) {
                let help =
                    "write  periodic.x = [from, to], or let the water enter and leave by [[inflow]] and [[outflow]]";
                return Err(Error::scene("a current is held along a periodic axis").help(help));
            }
            if !(discharge.is_finite() && response > 0.0 && response.is_finite()) {
                return Err(Error::scene("a current has a discharge and a positive response time"));
            }
        }
        match &self.towed {
            Some(frame) if frame.axis >= D || !frame.velocity.value_and_rate(0.0).1.is_finite() => {
                Err(Error::scene("a towed frame moves along an axis, with a velocity that has a rate at the start"))
            }
            _ => Ok(()),
        }
    }
}

/// What drives water and bodies, and its state.
pub(super) struct DrivingState<const D: usize> {
    pub(super) driving: Driving,
    /// Acceleration (m/s²) beside gravity, as last set.
    pub(super) acceleration: Vector<D>,
    /// Mean velocity (m/s) at the start along the axis of the current.
    start: f64,
    /// State of the current in a checkpoint.
    pub(super) current: CurrentState,
}

/// The state of the force that holds a current.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct CurrentState {
    /// s, m/s².
    integral: f64,
    /// a, m/s².
    pub(super) acceleration: f64,
}

impl CurrentState {
    /// Whether the numbers are finite.
    pub(super) fn is_finite(&self) -> bool {
        self.integral.is_finite() && self.acceleration.is_finite()
    }
}

impl<const D: usize> DrivingState<D> {
    /// Of what has not begun to act.
    pub(super) fn new(driving: Driving) -> Self {
        Self { driving, acceleration: Vector::zeros(), start: 0.0, current: CurrentState::default() }
    }

    /// Whether nothing but gravity acts.
    pub(super) fn is_none(&self) -> bool {
        self.driving.current.is_none() && self.driving.towed.is_none()
    }

    /// The acceleration (m/s²) beside gravity at time `t` (s).
    fn acceleration_at(&self, t: f64) -> Vector<D> {
        let mut sum = Vector::zeros();
        if let Some(current) = &self.driving.current {
            sum[current.axis] += self.current.acceleration;
        }
        if let Some(frame) = &self.driving.towed {
            sum[frame.axis] -= frame.velocity.value_and_rate(t).1;
        }
        sum
    }
}

/// Speeds (m/s) of the current that is held, and of the water past a towed frame at time `t` (s).
pub(crate) fn driven_speeds<const D: usize>(system: &System<D>, t: f64) -> impl Iterator<Item = f64> {
    held_speed(system).into_iter().chain(towing_speed(system, t).map(|(_, speed)| speed))
}

/// Those of [`driven_speeds`] with which water passes: walls take the water of a closed tank along with a towed frame.
pub(crate) fn passing_speeds<const D: usize>(system: &System<D>, t: f64) -> impl Iterator<Item = f64> {
    let past = towing_speed(system, t).filter(|(axis, _)| system.is_open(*axis));
    held_speed(system).into_iter().chain(past.map(|(_, speed)| speed))
}

/// Speed (m/s) of the current that is held.
fn held_speed<const D: usize>(system: &System<D>) -> Option<f64> {
    let current = system.driving.driving.current?;
    Some((current.discharge / mean_section(system, current.axis)).abs())
}

/// Axis and speed (m/s) of a towed frame at time `t` (s).
fn towing_speed<const D: usize>(system: &System<D>, t: f64) -> Option<(usize, f64)> {
    let frame = system.driving.driving.towed.as_ref()?;
    Some((frame.axis, frame.velocity.value_and_rate(t).0.abs()))
}

/// Discharge (m³/s; m²/s in 2-D) of water that moves at 1 m/s along `axis`, m² (m).
fn mean_section<const D: usize>(system: &System<D>, axis: usize) -> f64 {
    let length = system.periodic()[axis].map_or(1.0, |[from, to]| to - from);
    system.fluid().len() as f64 * system.properties.particle_volume() * system.water_multiplicity() / length
}

/// Starts the force that holds the current from the present motion.
pub(super) fn start_current<const D: usize>(system: &mut System<D>) {
    if let Some(current) = system.driving.driving.current {
        let discharge = system.discharge(current.axis).unwrap_or(0.0);
        system.driving.start = discharge / mean_section(system, current.axis);
    }
}

/// Adapts the force that holds the current after a step `dt` (s).
pub(crate) fn update_current<const D: usize>(system: &mut System<D>, dt: f64) {
    if let Some(current) = system.driving.driving.current {
        let found = system.discharge(current.axis).unwrap_or(0.0);
        adapt_current(system, found, dt);
    }
}

/// The same after a step with the discharge `found` (m³/s; m²/s in 2-D).
pub(super) fn adapt_current<const D: usize>(system: &mut System<D>, found: f64, dt: f64) {
    let Some(Current { axis, discharge, response }) = system.driving.driving.current else { return };
    let section = mean_section(system, axis);
    let now = found / section;
    let DrivingState { start, current, .. } = &mut system.driving;
    current.integral += (discharge / section - now) * dt / (response * response);
    current.acceleration = current.integral - 2.0 / response * (now - *start);
}

/// Sets gravity and the other uniform body forces to their values at time `t` (s). Returns the change of gravity
/// alone (m/s²); `None` if all are constant.
pub(crate) fn set_gravity_at<const D: usize>(system: &mut System<D>, t: f64) -> Option<Vector<D>> {
    if system.gravity_law.is_empty() && system.driving.is_none() {
        return None;
    }
    let base = if system.gravity_law.is_empty() {
        Vector::from_fn(|i, _| system.model.gravity.get(i).copied().unwrap_or(0.0))
    } else {
        setup::gravity_at(&system.gravity_law, t)
    };
    let change = base - system.potential_gravity();
    system.driving.acceleration = system.driving.acceleration_at(t);
    system.properties.gravity = base + system.driving.acceleration;
    system.pair_loop.set_gravity(&system.properties);
    Some(change)
}
