//! Sponge layers absorb waves, so that the end of a tank reflects little of them.
//!
//! dv/dt = −β sⁿ v, with s from 0 where the layer begins to 1 where it has its full strength. With n = 2 the strength rises
//! slowly at first and the layer reflects little. Time integration applies the exact solution, v → v exp(−β sⁿ Δt), which
//! limits no time step. Still water is unchanged.

use super::System;
use crate::{
    error::{Error, Result},
    math::Vector,
};

/// A layer: all water beyond a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpongeLayer<const D: usize> {
    /// A point (m) of the plane where it begins.
    pub from: Vector<D>,
    /// A point (m) of the plane from which it has its full strength; both planes are normal to the line between the points.
    pub to: Vector<D>,
    /// β, 1/s.
    pub strength: f64,
    /// n, –.
    pub power: f64,
}

impl<const D: usize> SpongeLayer<D> {
    /// Distance from the beginning to the full strength, m.
    pub(crate) fn length(&self) -> f64 {
        (self.to - self.from).norm()
    }

    /// β sⁿ (1/s) at `x` (m).
    pub fn rate(&self, x: &Vector<D>) -> f64 {
        let way = self.to - self.from;
        let s = ((x - self.from).dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
        // The usual one without a power, which costs as much as the exponential.
        if self.power == 2.0 { self.strength * s * s } else { self.strength * s.powf(self.power) }
    }

    /// Checks that length, strength and power of the layer are positive and finite.
    ///
    /// # Errors
    /// `Scene` if it has no length, no strength or no power.
    pub(crate) fn check(&self) -> Result<()> {
        let good = |x: f64| x > 0.0 && x.is_finite();
        match good(self.length()) && good(self.strength) && good(self.power) {
            true => Ok(()),
            false => Err(Error::scene("a damping zone has a length, a strength and a power")
                .help("its `from` and `to` lie apart, its strength (1/s) and its power are positive numbers")),
        }
    }
}

impl<const D: usize> System<D> {
    /// The sponge layers.
    pub(crate) fn sponge_layers(&self) -> &[SpongeLayer<D>] {
        &self.fluid_domain.sponge_layers
    }
}
