//! The motor on a joint's coordinate, a load on both solids:
//!
//!   F = F₀ + k (x* − x) + c (v* − ẋ)
//!
//! The stiffness limits the time step, as that of a spring does. The damping does not, because it acts at the rate at the end of
//! the step. g = J M⁻¹ Jᵀ is the inverse effective mass of the pair along the coordinate, with the joint's locks. The damping
//! force is
//!
//!   c (v* − ẋ − Δt ẍ)/(1 + Δt c g),
//!
//! where ẍ is the acceleration of the coordinate by water, weight, pushes and F₀, and by what joints, ropes and contacts bore of
//! these in the last step. Without the term Δt ẍ the rate would miss v* by Δt ẍ, however strong the brake is: by 0.2 m/s for a
//! light body. A motor with a stiffness omits the term, because a stiffness finds its equilibrium under any load.

use serde::{Deserialize, Serialize};

use super::reactions::borne;
use crate::solid::TimeFunction;

/// A motor, brake or power take-off. Forces are in N (N m for a hinge; per metre of width in 2-D). A positive force drives the
/// second solid in the direction in which the coordinate grows.
///
/// ```
/// use pontoon::solid::Motor;
///
/// let take_off = Motor::default().damping(20.0); // F = −c ẋ
/// let drive = Motor::default().velocity(2.0).damping(500.0).max_force(30.0); // towards 2 rad/s
/// assert_eq!(take_off.max_force, f64::INFINITY);
/// assert_eq!(drive.command_at(0.0).velocity, 2.0);
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Motor {
    /// F₀, N or N m.
    pub force: TimeFunction,
    /// x*, m or rad from the start.
    pub position: TimeFunction,
    /// v*, m/s or rad/s; by default the rate of `position`.
    pub velocity: Option<TimeFunction>,
    /// k, N/m or N m/rad.
    pub stiffness: TimeFunction,
    /// c, N s/m or N m s/rad.
    pub damping: TimeFunction,
    /// Largest force, N or N m.
    pub max_force: f64,
}

impl Default for Motor {
    /// None at all.
    fn default() -> Self {
        let none = || TimeFunction::constant(0.0);
        Self {
            force: none(),
            position: none(),
            velocity: None,
            stiffness: none(),
            damping: none(),
            max_force: f64::INFINITY,
        }
    }
}

impl Motor {
    /// The same motor with the force F₀ (N or N m).
    pub fn force(self, force: impl Into<TimeFunction>) -> Self {
        Self { force: force.into(), ..self }
    }

    /// The same motor with the set point x* (m or rad from the start) of its stiffness.
    pub fn position(self, position: impl Into<TimeFunction>) -> Self {
        Self { position: position.into(), ..self }
    }

    /// The same motor with the set point v* (m/s or rad/s) of its damping.
    pub fn velocity(self, velocity: impl Into<TimeFunction>) -> Self {
        Self { velocity: Some(velocity.into()), ..self }
    }

    /// The same motor with the stiffness k (N/m or N m/rad).
    pub fn stiffness(self, stiffness: impl Into<TimeFunction>) -> Self {
        Self { stiffness: stiffness.into(), ..self }
    }

    /// The same motor with the damping c (N s/m or N m s/rad); alone it is a linear power take-off, F = −c ẋ.
    pub fn damping(self, damping: impl Into<TimeFunction>) -> Self {
        Self { damping: damping.into(), ..self }
    }

    /// The same motor with this largest force (N or N m).
    pub fn max_force(self, max_force: f64) -> Self {
        Self { max_force, ..self }
    }

    /// The motor's force (N or N m) at the coordinate 0, F₀ + k x*, and its stiffness k (N/m or N m/rad), if both are constant in
    /// time. At rest, the damping bears no load.
    pub(in crate::solid) fn steady_force(&self) -> Option<(f64, f64)> {
        let stiffness = self.stiffness.steady_value()?;
        // Without a stiffness the target does not matter.
        let pull = if stiffness == 0.0 { 0.0 } else { stiffness * self.position.steady_value()? };
        Some((self.force.steady_value()? + pull, stiffness))
    }

    /// The command at time `t` (s).
    pub fn command_at(&self, t: f64) -> MotorCommand {
        let (position, rate) = self.position.value_and_rate(t);
        MotorCommand {
            force: self.force.value_and_rate(t).0,
            position,
            velocity: self.velocity.as_ref().map_or(rate, |law| law.value_and_rate(t).0),
            stiffness: self.stiffness.value_and_rate(t).0,
            damping: self.damping.value_and_rate(t).0,
            max_force: self.max_force,
        }
    }
}

/// The command of a motor at an instant; the fields are those of [`Motor`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MotorCommand {
    /// F₀, N or N m.
    pub force: f64,
    /// x*, m or rad.
    pub position: f64,
    /// v*, m/s or rad/s.
    pub velocity: f64,
    /// k, N/m or N m/rad.
    pub stiffness: f64,
    /// c, N s/m or N m s/rad.
    pub damping: f64,
    /// Largest force, N or N m.
    pub max_force: f64,
}

/// State of a joint's coordinate for which a motor computes its force.
pub(in crate::solid) struct MotorInput {
    /// Its value, m or rad.
    pub(in crate::solid) position: f64,
    /// Its rate, m/s or rad/s.
    pub(in crate::solid) rate: f64,
    /// Its acceleration by the known loads, m/s² or rad/s².
    pub(in crate::solid) known_acceleration: f64,
    /// Its acceleration by the joints, ropes and contacts of the last step, m/s² or rad/s².
    pub(in crate::solid) reaction: f64,
    /// g, the inverse effective mass of the pair, 1/kg or 1/(kg m²).
    pub(in crate::solid) inverse_effective_mass: f64,
    /// The step, s.
    pub(in crate::solid) dt: f64,
}

impl MotorCommand {
    /// Its force over a step, N or N m.
    pub(in crate::solid) fn force(&self, going: &MotorInput) -> f64 {
        let off = self.position - going.position;
        let stiff = going.dt * self.damping * going.inverse_effective_mass;
        let known = going.known_acceleration + going.inverse_effective_mass * self.force;
        let gained = if self.stiffness > 0.0 { 0.0 } else { going.dt * (known + borne(known, going.reaction)) };
        let damped = self.damping * (self.velocity - going.rate - gained) / (1.0 + stiff);
        (self.force + self.stiffness * off + damped).clamp(-self.max_force, self.max_force)
    }
}
