//! Memory of the arrays of a system, from their lengths.

use super::System;
use crate::{math::Vector, model::TimeScheme, sph::boundary::WallExtrapolation};

/// Memory of an array of `T`, B.
pub(super) fn bytes<T>(array: &[T]) -> usize {
    size_of_val(array)
}

/// Memory of an array that there may be, B.
pub(super) fn optional_bytes<T>(array: &Option<Vec<T>>) -> usize {
    array.as_deref().map_or(0, bytes)
}

impl<const D: usize> System<D> {
    /// Memory of the arrays between two steps, B: particles, lists, and the buffers of a force pass.
    pub(crate) fn memory_bytes(&self) -> usize {
        let (fluid, water) = (&self.fluid.particles, self.fluid.particles.len());
        let tensors = optional_bytes(&self.fluid.stress) + optional_bytes(&self.fluid.gradient_correction);
        let particles = bytes(&fluid.r) + bytes(&fluid.v) + bytes(&fluid.rho) + bytes(&fluid.id);
        let before = match self.model.scheme {
            TimeScheme::Verlet { .. } => water * size_of::<(Vector<D>, f64)>() + bytes(&self.boundary.particles.rho),
            TimeScheme::Symplectic => 0,
        };
        particles
            + tensors
            + bytes(&self.fluid.images.originals)
            + bytes(self.neighbours.positions_at_build())
            + before
            + self.neighbours.memory_bytes()
            + self.pair_loop.memory_bytes()
            + self.boundary.memory_bytes()
            + bytes(&self.rates.boundary)
    }

    /// Memory that a step takes beside [`System::memory_bytes`] for a while, B: the start of a symplectic step, shifts, and the
    /// extrapolation of the water to the walls.
    pub(crate) fn step_memory_bytes(&self) -> usize {
        let (water, wet) = (self.fluid.particles.len(), self.boundary_near_fluid_count());
        let start = match self.model.scheme {
            TimeScheme::Verlet { .. } => 0,
            TimeScheme::Symplectic => {
                water * size_of::<(Vector<D>, Vector<D>, f64)>() + bytes(&self.boundary.particles.rho)
            }
        };
        let shifts = if self.model.shift().is_some() { water * size_of::<Vector<D>>() } else { 0 };
        start + shifts + wet * size_of::<WallExtrapolation<f64, D>>()
    }
}
