//! Buoyancy of parts of solids thinner than dp.
//!
//! A single layer of boundary particles in the middle of a part of thickness t keeps the water off as a part dp thick does. The
//! volume (dp − t) dpᴰ⁻¹ of each particle is too much, and its buoyancy −ρ₀ g times this volume is taken from the load of the solid,
//! as far as water is around: by the weight of the water over that on both sides of a layer under water. So a plate has half of it
//! with water on one side, and nothing in air. Only the buoyancy in water at rest is corrected; the added mass of a plate hardly
//! depends on its thickness.

use super::System;
use crate::{
    geometry::{Shape, thin::thin_place},
    math::Vector,
    model::{Model, Walls},
    solid::{Load, Solid},
};

/// Depth of a particle below its face, dp, from which on its part is not thinner than dp.
const THICK: f64 = 0.499;

/// A boundary particle in the middle of a thin part.
#[derive(Clone, Copy)]
struct ThinParticle {
    /// Its place among the particles of a copy of its solid.
    place: u32,
    /// Volume (m³; m² in 2-D) for which the water makes way in excess.
    excess: f64,
}

/// The boundary particles in the middle of thin parts.
pub(super) struct ThinLayers {
    of_solid: Vec<Vec<ThinParticle>>,
    /// Share of the surroundings that is water, of each particle of each copy, at the last force pass.
    wet: Vec<f64>,
    /// Whether walls have the weight of the water before them.
    possible: bool,
}

impl ThinLayers {
    pub(super) fn new(model: &Model) -> Self {
        Self { of_solid: Vec::new(), wet: Vec::new(), possible: model.walls == Walls::RelaxedAdami }
    }

    /// Whether no part is thin.
    pub(super) fn is_empty(&self) -> bool {
        self.of_solid.iter().all(Vec::is_empty)
    }

    /// Adds a solid of this `shape` with boundary particles at `places` (m, in its frame), `depths` (m) below its face.
    pub(super) fn append<const D: usize>(&mut self, shape: &Shape<D>, places: &[Vector<D>], depths: &[f64], dp: f64) {
        let thin = |(place, (x, depth)): (usize, (&Vector<D>, &f64))| {
            let candidate = self.possible && *depth < THICK * dp;
            let found = candidate.then(|| thin_place(shape, x, dp, 1e-3 * dp)).flatten()?;
            Some(ThinParticle { place: place as u32, excess: (dp - found.thickness) * dp.powi(D as i32 - 1) })
        };
        let found = places.iter().zip(depths).enumerate().filter_map(thin).collect();
        self.of_solid.push(found);
    }

    /// Forgets the particles of solid number `solid`.
    pub(super) fn remove(&mut self, solid: usize) {
        if let Some(particles) = self.of_solid.get_mut(solid) {
            particles.clear();
        }
        self.wet.clear();
    }

    /// Number of the solid, index and excess volume of each particle of each copy.
    fn each<'a, const D: usize>(&'a self, solids: &'a [Solid<D>]) -> impl Iterator<Item = (usize, usize, f64)> + 'a {
        self.of_solid.iter().zip(solids).enumerate().flat_map(|(number, (particles, solid))| {
            let starts = (0..solid.copies()).map(|copy| solid.boundary_of_copy(copy).start);
            starts.flat_map(move |start| particles.iter().map(move |p| (number, start + p.place as usize, p.excess)))
        })
    }
}

/// The boundary particles in the middle of thin parts.
#[cfg(feature = "gpu")]
pub(super) fn particles<const D: usize>(system: &System<D>) -> impl Iterator<Item = u32> + '_ {
    system.boundary.thin.each(&system.solids).map(|(_, i, _)| i as u32)
}

/// Reads the water around the thin parts from the `weight` (–) of that around a boundary particle, if there is any.
pub(super) fn update_water<const D: usize>(system: &mut System<D>, weight: impl Fn(&System<D>, u32) -> Option<f64>) {
    let thin = &system.boundary.thin;
    let both_sides = 2.0 * system.boundary.coverage.full_weight(0.5 * system.model.dp);
    let share = |i: usize| weight(system, i as u32).map_or(0.0, |weight| (weight / both_sides).min(1.0));
    let wet = thin.each(&system.solids).map(|(_, i, _)| share(i)).collect();
    system.boundary.thin.wet = wet;
}

/// The loads that take the buoyancy in excess off the computed part of each solid, about its centre; an empty list without thin parts.
pub(super) fn loads<const D: usize>(system: &System<D>) -> Vec<Load<D>> {
    let thin = &system.boundary.thin;
    if thin.wet.is_empty() {
        return Vec::new();
    }
    let weight = system.properties.gravity * system.properties.rho0;
    let mut loads = vec![Load::zero(); system.solids.len()];
    for ((number, i, excess), wet) in thin.each(&system.solids).zip(&thin.wet) {
        let (solid, r) = (&system.solids[number], &system.boundary.particles.r[i]);
        if system.is_between_sides(r) {
            let arm = system.place_on_solid(number, i) - solid.kinematics.centre;
            loads[number] += Load::from_force_at(&arm, weight * (excess * wet * system.computed_share(solid, r)));
        }
    }
    loads
}
