//! Zones in which water loses its motion, so that waves do not come back from the end of a tank.
//!
//! dv/dt = −β sⁿ v, s from 0 where the zone begins to 1 where it is full. With n = 2 it is so gentle at first that little
//! is thrown back. It is taken exactly over a step, v → v exp(−β sⁿ Δt), and bounds none. Still water stays as it is.

use rayon::prelude::*;

use super::System;
use crate::{
    error::{Error, Result},
    particles::PER_TASK,
    space::Vector,
};

/// A zone: the water from one plane on, as far as there is any.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Damping<const D: usize> {
    /// A point (m) of the plane on which it begins.
    pub from: Vector<D>,
    /// A point (m) of the plane from which on it is full; the planes lie across the line between the two.
    pub to: Vector<D>,
    /// β, 1/s.
    pub strength: f64,
    /// n, –.
    pub power: f64,
}

impl<const D: usize> Damping<D> {
    /// How far it is from where the zone begins to where it is full, m.
    pub fn length(&self) -> f64 {
        (self.to - self.from).norm()
    }

    /// β sⁿ (1/s) at `x` (m).
    pub fn rate(&self, x: &Vector<D>) -> f64 {
        let way = self.to - self.from;
        let s = ((x - self.from).dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
        // The usual one without a power, which costs as much as the exponential.
        if self.power == 2.0 { self.strength * s * s } else { self.strength * s.powf(self.power) }
    }

    /// Whether it can be meant.
    ///
    /// # Errors
    /// `Scene` if it has no length, no strength or no power.
    pub fn check(&self) -> Result<()> {
        let good = |x: f64| x > 0.0 && x.is_finite();
        match good(self.length()) && good(self.strength) && good(self.power) {
            true => Ok(()),
            false => Err(Error::scene("a damping zone has a length, a strength and a power")
                .help("its `from` and `to` lie apart, its strength (1/s) and its power are positive numbers")),
        }
    }
}

impl<const D: usize> System<D> {
    /// Where water loses its motion.
    pub fn damping(&self) -> &[Damping<D>] {
        &self.damping
    }

    /// Takes motion from the water in the zones over `dt` (s), and from the velocities `before` that a scheme goes on from. Says
    /// what energy (J) the water lost, if that is `told`.
    pub(crate) fn damp(&mut self, dt: f64, before: Option<&mut [Vector<D>]>, told: bool) -> f64 {
        if self.damping.is_empty() {
            return 0.0;
        }
        let had = if told { self.kinetic() } else { 0.0 };
        let (zones, r) = (&self.damping, &self.fluid.r);
        for v in [Some(&mut self.fluid.v[..]), before].into_iter().flatten() {
            v.par_iter_mut().zip(r).with_min_len(PER_TASK).for_each(|(v, r)| {
                let rate: f64 = zones.iter().map(|zone| zone.rate(r)).sum();
                if rate > 0.0 {
                    *v *= (-rate * dt).exp();
                }
            });
        }
        if told { had - self.kinetic() } else { 0.0 }
    }
}
