//! Gravity that changes with time: in the frame of a tank that is shaken, the acceleration of the frame belongs to it.

use super::System;
use crate::{math::Vector, solid::TimeFunction};

/// The acceleration of gravity (m/s²) by the components of `law` at time `t` (s).
pub(super) fn gravity_at<const D: usize>(law: &[TimeFunction], t: f64) -> Vector<D> {
    Vector::from_fn(|i, _| law.get(i).map_or(0.0, |component| component.value_and_rate(t).0))
}

impl<const D: usize> System<D> {
    /// Sets gravity to that of time `t` (s). Returns its change (m/s²); `None` if gravity is constant.
    pub(crate) fn set_gravity_at(&mut self, t: f64) -> Option<Vector<D>> {
        if self.gravity_law.is_empty() {
            return None;
        }
        let gravity = gravity_at(&self.gravity_law, t);
        let change = gravity - self.properties.gravity;
        self.properties.gravity = gravity;
        self.pair_loop.set_gravity(&self.properties);
        Some(change)
    }
}
