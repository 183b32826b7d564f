//! The arrays of the water: declared, reordered, saved and restored here and nowhere else.

use rayon::prelude::*;

use super::{Images, System, open_boundary::Buffer};
use crate::{
    math::{Matrix, Vector},
    model::{Model, PressureGradient},
    particles::{PARTICLES_PER_TASK, Particles, zeros},
};

/// The water: its particles, then the buffer particles of open boundaries, then the images of particles near periodic sides, and
/// the quantities that the laws store for each particle.
pub(crate) struct Fluid<const D: usize> {
    pub(crate) particles: Particles<D>,
    pub(super) buffer: Buffer<D>,
    pub(super) images: Images<D>,
    /// Stress from the last pass, m²/s²; `None` unless the viscosity has one.
    pub(super) stress: Option<Vec<Matrix<D>>>,
    /// B − 1 of the corrected gradients at the positions of the neighbour lists, –; `None` unless gradients are corrected.
    pub(super) gradient_correction: Option<Vec<Matrix<D>>>,
    /// Which particles a new solid displaces: they are removed when the lists are rebuilt.
    pub(super) displaced: Option<Vec<bool>>,
}

impl<const D: usize> Fluid<D> {
    /// Water at `r` (m), with velocities `v` (m/s; at rest where there is none) and densities `rho` (kg/m³).
    pub(super) fn new(
        model: &Model,
        r: Vec<Vector<D>>,
        mut v: Vec<Vector<D>>,
        rho: Vec<f64>,
        images: Images<D>,
    ) -> Self {
        if v.is_empty() {
            v = zeros(r.len());
        }
        let tensors = |needed: bool| needed.then(|| zeros(r.len()));
        Self {
            stress: tensors(model.viscosity.stress().is_some()),
            gradient_correction: tensors(model.gradient != PressureGradient::Plain),
            buffer: Buffer::default(),
            particles: Particles { id: (0..r.len() as u32).collect(), r, v, rho },
            images,
            displaced: None,
        }
    }

    /// Puts the particles into `order`: the new i-th is the old `order[i]`-th.
    pub(super) fn permute(&mut self, order: &[u32]) {
        let Self { particles: Particles { r, v, rho, id }, stress, gradient_correction, .. } = self;
        permute(r, order);
        permute(v, order);
        permute(rho, order);
        permute(id, order);
        stress.iter_mut().chain(gradient_correction).for_each(|tensors| permute(tensors, order));
    }
}

impl<const D: usize> System<D> {
    /// Number of water particles, buffers of open boundaries and images not counted.
    pub(crate) fn particle_count(&self) -> usize {
        self.own_count() - self.fluid.buffer.tags.len()
    }

    /// Number of particles that are no images: the water, and then the buffers of open boundaries.
    pub(super) fn own_count(&self) -> usize {
        self.fluid.particles.len() - self.fluid.images.originals.len()
    }
}

/// Puts `array` into `order`: the new i-th is the old `order[i]`-th. An empty array stays empty.
pub(crate) fn permute<T: Copy + Send + Sync>(array: &mut Vec<T>, order: &[u32]) {
    if !array.is_empty() {
        *array = order.par_iter().with_min_len(PARTICLES_PER_TASK).map(|&i| array[i as usize]).collect();
    }
}
