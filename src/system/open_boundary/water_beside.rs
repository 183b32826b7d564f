//! The velocity of the water beside a face that prescribes none.
//!
//! A kernel mean would be the velocity at the centroid of the particles, which near a wall lies further from the wall than the
//! place itself. In Poiseuille flow 20 dp high it would be more than twice the velocity of the first row. The module instead fits
//! a linear function to the velocities, with the kernel as weight; its value is exact in any linear shear.

use super::System;
use crate::math::{Matrix, Vector};

/// Part of h² that is added to the variances of the places, so that a fit to few particles, or to particles in a row, tends to their mean.
const FLOOR: f64 = 1e-3;

/// The velocity (m/s) of the water at `place` (m), where Σ W/ρ is `weight` (1/kg) and the mean with the kernel is `mean` (m/s).
pub(super) fn linear_velocity<const D: usize>(
    system: &System<D>,
    place: &Vector<D>,
    weight: f64,
    mean: &Vector<D>,
) -> Vector<D> {
    let (mut centroid, mut places, mut shears) = (Vector::<D>::zeros(), Matrix::<D>::zeros(), Matrix::<D>::zeros());
    system.visit_fluid_near(place, &mut |b, x, w| {
        let share = w / (system.fluid.particles.rho[b] * weight);
        let away = x - place;
        centroid += away * share;
        places += away * away.transpose() * share;
        shears += (system.velocity_seen_at(b, x) - mean) * away.transpose() * share;
    });
    let floor = Matrix::<D>::identity() * (FLOOR * system.model.h.powi(2));
    let variances = places - centroid * centroid.transpose() + floor;
    variances.try_inverse().map_or(*mean, |inverse| mean - shears * inverse * centroid)
}
