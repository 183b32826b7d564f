//! Pressure across the water in a narrow gap between a free solid and another solid.
//!
//! In open water the force across a plane is the sum over all pairs on its two sides. In a gap of one or two rows some of these
//! pairs are boundary particles of both solids, which the pair loop leaves out: a row of water would carry little more than half of
//! its pressure, and a light body a row above the bed would sink onto it. With p = P/ρ₀, and e the unit vector of r_ij,
//!
//!   dv_i/dt = −Σ_j (p_i + p_j) G(3 n_i·e) G(−3 n_j·e) G(−3 n_i·n_j) V₀ ∂W r_ij,   G(x) = min(1, max(0, x)),
//!
//! acts between boundary particles i and j of two solids, as between particles of water. n points from the water near a particle
//! to the particle, so that a pair counts only across water and between faces that look at each other. Solids with the water
//! behind them, solids side by side in the same water, and solids that meet in a corner do not push each other. The forces are
//! opposite, bit for bit.

use rayon::prelude::*;

use crate::{
    geometry::cells::PointCells,
    interaction::PairSums,
    math::{Bounds, Vector},
    model::{Model, Walls},
    particles::PARTICLES_PER_TASK,
    solid::Solid,
    sph::boundary::WallExtrapolation,
};

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
    /// Radius of the kernel's support, m; `None` if walls have no pressure of the water before them.
    support: Option<f64>,
    /// V₀ ∂W (1/m²) of the squared distance (m²).
    pub(super) slope: Box<dyn Fn(f64) -> f64 + Send + Sync>,
}

impl<const D: usize> GapPressure<D> {
    pub(super) fn new(model: &Model) -> Self {
        let support = (model.walls == Walls::RelaxedAdami).then(|| model.support_radius());
        Self { particles: Vec::new(), support, slope: model.kernel_slope::<D>() }
    }

    /// Whether there is no narrow gap.
    pub(super) fn is_empty(&self) -> bool {
        self.particles.is_empty()
    }

    /// Reads from `fits`, one for each boundary particle near water, where the water is.
    pub(super) fn update_directions(&mut self, fits: &[WallExtrapolation<f64, D>]) {
        for particle in &mut self.particles {
            particle.away = fits[particle.place].direction().into();
        }
    }

    /// Finds the boundary particles on both sides of narrow gaps, at the positions `r` (m) of all boundary particles at which the
    /// neighbour lists were built. `wet` are those near water, and no solid moves by more than `margin` (m) until the next lists.
    pub(super) fn find(&mut self, solids: &[Solid<D>], r: &[Vector<D>], wet: &[u32], margin: f64) {
        self.particles.clear();
        let Some(support) = self.support.filter(|_| solids.iter().any(Solid::is_free)) else { return };
        let reach = support + 2.0 * margin;
        // The images of a solid across symmetry planes are other solids.
        let whole = solids.iter().map(|solid| (solid, solid.boundary_of_whole()));
        let images = solids.iter().map(|solid| (solid, solid.boundary_of_whole().end..solid.boundary.end));
        let groups: Vec<_> = whole.chain(images.filter(|(_, range)| !range.is_empty())).collect();
        let around: Vec<Bounds<D>> = groups.iter().map(|(_, range)| Bounds::around(&r[range.clone()])).collect();
        let faces = |i: usize, j: usize| i != j && (groups[i].0.is_free() || groups[j].0.is_free());
        // Candidates, by place and group: near the box around a group with which their own can have a gap.
        let mut candidates: Vec<(usize, usize)> = Vec::new();
        for (i, (_, range)) in groups.iter().enumerate() {
            let own = around[i].grown(reach);
            let others = (0..groups.len()).filter(|&j| faces(i, j) && own.meets(&around[j]));
            let others: Vec<Bounds<D>> = others.map(|j| around[j].grown(reach)).collect();
            if !others.is_empty() {
                let place = |end: usize| wet.partition_point(|&w| (w as usize) < end);
                let near = |&k: &usize| others.iter().any(|bounds| bounds.contains(&r[wet[k] as usize]));
                let places = place(range.start)..place(range.end);
                candidates.extend(places.filter(near).map(|k| (k, i)));
            }
        }
        let points: Vec<Vector<D>> = candidates.iter().map(|&(k, _)| r[wet[k] as usize]).collect();
        let cells = PointCells::new(&points, reach);
        let with_partners = |(n, &(place, group)): (usize, &(usize, usize))| {
            let mut partners = Vec::new();
            cells.visit_near(&points[n], reach, |m, x| {
                if faces(group, candidates[m].1) && (x - points[n]).norm_squared() < reach * reach {
                    partners.push(m as u32);
                }
            });
            partners.sort_unstable();
            GapParticle { place, away: Vector::zeros(), partners }
        };
        let all = candidates.par_iter().enumerate().with_min_len(PARTICLES_PER_TASK);
        all.map(with_partners).collect_into_vec(&mut self.particles);
    }

    /// Adds the accelerations by the pressure across gaps to `sums`, one for each boundary particle of `wet`. `r` are the positions
    /// (m) of all boundary particles, `pressure` is P/ρ₀ (m²/s²) by their index.
    pub(super) fn add_to(
        &self,
        sums: &mut [PairSums<D>],
        wet: &[u32],
        r: &[Vector<D>],
        pressure: impl Fn(usize) -> f64 + Sync,
    ) {
        let Self { particles, slope, support } = self;
        let support2 = support.map_or(0.0, |support| support * support);
        let gate = |x: f64| x.clamp(0.0, 1.0);
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
                    let through = gate(3.0 * own.away.dot(&arm) * inv) * gate(-3.0 * other.away.dot(&arm) * inv);
                    let across = through * gate(-3.0 * own.away.dot(&other.away));
                    if across > 0.0 {
                        sum -= arm * ((p + pressure(j)) * across * slope(r2));
                    }
                }
            }
            sum
        };
        let particles = particles.par_iter().with_min_len(PARTICLES_PER_TASK);
        let accelerations: Vec<Vector<D>> = particles.map(acceleration).collect();
        for (particle, acceleration) in self.particles.iter().zip(accelerations) {
            sums[particle.place].acceleration += acceleration;
        }
    }
}
