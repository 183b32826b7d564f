//! Pressure across the water in a narrow gap between a free solid and another solid.
//!
//! In open water the force across a plane is the sum over all pairs on its two sides. In a gap of one or two rows some of these
//! pairs are boundary particles of both solids, which the pair loop leaves out: a row of water would carry little more than half of
//! its pressure, and a light body a row above the bed would sink onto it. With p = P/ρ₀, and e the unit vector of r_ij,
//!
//!   dv_i/dt = −Σ_j (p_i + p_j) G(n_i·e) G(−n_j·e) V₀ ∂W r_ij,   G(x) = 3x between 0 and 1,
//!
//! acts between boundary particles i and j of two solids, as between particles of water. n points from the water near a particle to
//! it, so that pairs count only across water: solids side by side in the same water, or whose water is behind them, do not push
//! each other. The forces are opposite, bit for bit.

use rayon::prelude::*;

use super::System;
use crate::{
    geometry::cells::PointCells,
    interaction::PairSums,
    math::{Bounds, Vector},
    model::{Model, Walls},
    particles::PARTICLES_PER_TASK,
    solid::Role,
    sph::boundary::WallExtrapolation,
};

/// Slope of G, –: pairs at 20° and more to the face count whole.
const GATE_SLOPE: f64 = 3.0;

/// A boundary particle with particles of other solids in its support.
struct GapParticle<const D: usize> {
    /// Its place among those near water.
    place: usize,
    /// Unit vector from the water near it to it; zero without water.
    away: Vector<D>,
    /// Indices of the gap particles of other solids around it, in ascending order.
    partners: Vec<u32>,
}

/// The boundary particles on both sides of narrow gaps.
pub(super) struct GapPressure<const D: usize> {
    particles: Vec<GapParticle<D>>,
    /// V₀ ∂W (1/m²) of the squared distance (m²).
    slope: Box<dyn Fn(f64) -> f64 + Send + Sync>,
}

impl<const D: usize> GapPressure<D> {
    pub(super) fn new(model: &Model) -> Self {
        Self { particles: Vec::new(), slope: model.kernel_slope::<D>() }
    }

    /// Reads from `fits`, one for each boundary particle near water, where the water is.
    pub(super) fn update_directions(&mut self, fits: &[WallExtrapolation<f64, D>]) {
        for particle in &mut self.particles {
            particle.away = fits[particle.place].direction().unwrap_or_else(Vector::zeros);
        }
    }
}

impl<const D: usize> System<D> {
    /// Finds the boundary particles on both sides of narrow gaps, at the positions `r` (m) of all boundary particles at which the
    /// neighbour lists were built.
    pub(super) fn find_gaps(&mut self, r: &[Vector<D>]) {
        self.gap_pressure.particles.clear();
        if self.model.walls != Walls::RelaxedAdami {
            return;
        }
        // Until the next rebuild either solid moves by the margin at most.
        let reach = self.model.support_radius() + 2.0 * self.neighbours.margin();
        let wet = self.neighbours.boundary_near_fluid();
        let around: Vec<Bounds<D>> =
            self.solids.iter().map(|solid| Bounds::around(&r[solid.boundary.clone()])).collect();
        let is_free = |i: usize| matches!(self.solids[i].spec.role, Role::Free(_));
        let faces = |i: usize, j: usize| i != j && (is_free(i) || is_free(j));
        // Candidates: near the box around a solid with which their own can have a gap.
        let mut candidates: Vec<(usize, usize)> = Vec::new();
        for (i, solid) in self.solids.iter().enumerate() {
            let own = around[i].grown(reach);
            let others: Vec<Bounds<D>> = (0..self.solids.len())
                .filter(|&j| faces(i, j) && !self.solids[j].boundary.is_empty() && own.meets(&around[j]))
                .map(|j| around[j].grown(reach))
                .collect();
            if !others.is_empty() {
                let place = |end: usize| wet.partition_point(|&w| (w as usize) < end);
                let places = place(solid.boundary.start)..place(solid.boundary.end);
                let near = |&k: &usize| others.iter().any(|bounds| bounds.contains(&r[wet[k] as usize]));
                candidates.extend(places.filter(near).map(|k| (k, i)));
            }
        }
        if candidates.is_empty() {
            return;
        }
        let points: Vec<Vector<D>> = candidates.iter().map(|&(k, _)| r[wet[k] as usize]).collect();
        let cells = PointCells::new(&points, reach);
        let partners = |(n, &(_, solid)): (usize, &(usize, usize))| {
            let mut partners = Vec::new();
            cells.visit_near(&points[n], reach, |m, x| {
                if faces(solid, candidates[m].1) && (x - points[n]).norm_squared() < reach * reach {
                    partners.push(m as u32);
                }
            });
            partners.sort_unstable();
            partners
        };
        let partners: Vec<Vec<u32>> =
            candidates.par_iter().enumerate().with_min_len(PARTICLES_PER_TASK).map(partners).collect();
        self.gap_pressure.particles = candidates
            .iter()
            .zip(partners)
            .map(|(&(place, _), partners)| GapParticle { place, away: Vector::zeros(), partners })
            .collect();
    }

    /// Adds the accelerations by the pressure across gaps to `sums`, one for each boundary particle near water.
    pub(super) fn add_gap_pressure(&self, sums: &mut [PairSums<D>]) {
        let GapPressure { particles, slope } = &self.gap_pressure;
        let (wet, support2) = (self.neighbours.boundary_near_fluid(), self.model.support_radius().powi(2));
        let (r, rho) = (&self.boundary.particles.r, &self.boundary.particles.rho);
        let pressure = |i: usize| self.equation_of_state.pressure(rho[i] / self.properties.rho0 - 1.0);
        let gate = |x: f64| (GATE_SLOPE * x).clamp(0.0, 1.0);
        let acceleration = |own: &GapParticle<D>| {
            let i = wet[own.place] as usize;
            let (x, p) = (r[i], pressure(i));
            let mut sum = Vector::zeros();
            for &partner in &own.partners {
                let other = &particles[partner as usize];
                let j = wet[other.place] as usize;
                let arm = x - r[j];
                let r2 = arm.norm_squared();
                if r2 < support2 && r2 > 0.0 {
                    let inv = 1.0 / r2.sqrt();
                    let across = gate(own.away.dot(&arm) * inv) * gate(-other.away.dot(&arm) * inv);
                    if across > 0.0 {
                        sum -= arm * ((p + pressure(j)) * across * slope(r2));
                    }
                }
            }
            sum
        };
        let accelerations: Vec<Vector<D>> =
            particles.par_iter().with_min_len(PARTICLES_PER_TASK).map(acceleration).collect();
        for (particle, acceleration) in particles.iter().zip(accelerations) {
            sums[particle.place].acceleration += acceleration;
        }
    }
}
