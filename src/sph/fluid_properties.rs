//! The constants of the water that the laws share.

use crate::math::Vector;

/// Constants of one run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FluidProperties<const D: usize> {
    /// Smoothing length h, m.
    pub h: f64,
    /// Particle spacing dp, m.
    pub dp: f64,
    /// Reference density ρ₀, kg/m³.
    pub rho0: f64,
    /// Speed of sound c₀, m/s.
    pub c0: f64,
    /// Exponent γ of the equation of state, –.
    pub gamma: f64,
    /// Acceleration of gravity, m/s².
    pub gravity: Vector<D>,
}

/// Units of length and time of the pair loop, so that single precision neither overflows nor underflows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    /// Unit of length, m.
    pub length: f64,
    /// Unit of time, s.
    pub time: f64,
}

impl Units {
    /// Metre and second.
    pub const SI: Self = Self { length: 1.0, time: 1.0 };
}

impl<const D: usize> FluidProperties<D> {
    /// The same constants in `units` (ρ₀ stays in kg/m³: no law reads it).
    pub fn in_units(&self, units: &Units) -> Self {
        let Units { length, time } = *units;
        Self {
            h: self.h / length,
            dp: self.dp / length,
            c0: self.c0 * time / length,
            gravity: self.gravity * (time * time / length),
            ..*self
        }
    }

    /// Volume of a particle at ρ₀, dpᴰ (m³; m² in 2-D): every particle's mass divided by ρ₀.
    pub(crate) fn particle_volume(&self) -> f64 {
        self.dp.powi(D as i32)
    }

    /// η² = 0.01 h² (m²), which keeps 1/(r² + η²) finite @monaghan1992.
    pub fn eta2(&self) -> f64 {
        0.01 * self.h * self.h
    }
}
