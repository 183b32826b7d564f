//! Force and torque on a solid.

use std::ops::{Add, AddAssign, Mul, Sub};

use serde::{Deserialize, Serialize};

use super::Kinematics;
use crate::math::{Bivector, Vector};

/// Force and torque on a solid.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Load<const D: usize> {
    /// Force, N (N/m in 2-D).
    pub force: Vector<D>,
    /// Torque about the solid's `centre`, N m (N m/m in 2-D).
    pub torque: Bivector<D>,
}

impl<const D: usize> Load<D> {
    /// None.
    pub fn zero() -> Self {
        Self { force: Vector::zeros(), torque: Bivector::zero() }
    }

    /// `force` (N) alone, at the arm `r` (m) from the centre.
    pub(crate) fn from_force_at(r: &Vector<D>, force: Vector<D>) -> Self {
        Self { force, torque: Bivector::torque(r, &force) }
    }

    /// Power (W) on a solid that moves so: F·V + T·Ω.
    pub(crate) fn power(&self, motion: &Kinematics<D>) -> f64 {
        self.force.dot(&motion.velocity) + self.torque.power(&motion.spin)
    }
}

/// The loads on all solids in a step, without those of constraints and contacts.
pub(crate) struct LoadContext<const D: usize> {
    /// Load of water and weight on each.
    pub(crate) loads: Vec<Load<D>>,
    /// Whether each is in contact with water.
    pub(crate) wet: Vec<bool>,
    /// How long sound takes to cross a smoothing length, h/c₀, s.
    pub(crate) sound_crossing_time: f64,
}

impl<const D: usize> Add for Load<D> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { force: self.force + other.force, torque: self.torque + other.torque }
    }
}

impl<const D: usize> AddAssign for Load<D> {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<const D: usize> Sub for Load<D> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + other * -1.0
    }
}

impl<const D: usize> Mul<f64> for Load<D> {
    type Output = Self;

    fn mul(self, by: f64) -> Self {
        Self { force: self.force * by, torque: self.torque * by }
    }
}

impl<const D: usize> std::iter::Sum for Load<D> {
    fn sum<I: Iterator<Item = Self>>(loads: I) -> Self {
        loads.fold(Self::zero(), Add::add)
    }
}
