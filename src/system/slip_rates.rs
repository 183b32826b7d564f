//! The velocity with which faces drag the water does not compress it.
//!
//! Without slip, a boundary particle b acts on the water with a velocity u_b that differs along the face from the velocity v_b of its
//! solid. Viscosity reads u_b, but volumes change by v_b, as in Morris et al. (1997) and Adami et al. (2012). The pair loop has one
//! velocity for both, so that this module adds, to the rates of x = ρ/ρ₀ − 1 of a water particle a and of b,
//!
//!   dx_a/dt += (ρ_a/ρ₀) Σ_b V_b (u_b − v_b)·∇_a W  and  dx_b/dt += (ρ_b/ρ₀) Σ_a V_a (u_b − v_b)·∇_a W.
//!
//! Beside a plane face the sums are nearly zero. At edges and corners they are not: the pressure of still water did work on any flow
//! there, until the run failed (`docs/measurements/no-slip-corner.toml`).

use rayon::prelude::*;

use super::{Boundary, System};
use crate::{
    interaction::PairSums,
    math::Vector,
    model::{Model, Slip},
    particles::{PARTICLES_PER_TASK, Particles},
};

/// A particle, and those of the other kind that may come within its support before the next lists, in ascending order.
struct Neighbourhood {
    particle: u32,
    others: Vec<u32>,
}

/// The rates of density by the slip of boundary particles.
pub(super) struct SlipRates {
    /// V₀ ∂W (1/m²) at a squared distance (m²).
    slope: Box<dyn Fn(f64) -> f64 + Send + Sync>,
    /// Radius of the support, m.
    support: f64,
    /// Water, and the boundary particles beside it.
    water: Vec<Neighbourhood>,
    /// Boundary particles by their place among those near water, and the water beside them.
    boundary: Vec<Neighbourhood>,
    /// Rate of x of each water particle at the last pass, 1/s.
    rates: Vec<f64>,
}

impl SlipRates {
    /// `None` unless water sticks to faces.
    pub(super) fn new<const D: usize>(model: &Model) -> Option<Self> {
        (model.slip == Slip::None).then(|| Self {
            slope: model.kernel_slope::<D>(),
            support: model.support_radius(),
            water: Vec::new(),
            boundary: Vec::new(),
            rates: Vec::new(),
        })
    }

    /// Rate of x of water particle `i`, 1/s.
    #[inline]
    pub(super) fn of(&self, i: usize) -> f64 {
        self.rates[i]
    }

    /// Memory, B.
    pub(super) fn memory_bytes(&self) -> usize {
        let all = self.water.iter().chain(&self.boundary);
        let lists = all.map(|these| size_of::<Neighbourhood>() + size_of_val(&these.others[..]));
        size_of_val(&self.rates[..]) + lists.sum::<usize>()
    }

    /// Computes the rates of the `water` at its present state, and adds those of the boundary particles `near` it to their `sums`.
    pub(super) fn update<const D: usize>(
        &mut self,
        water: &Particles<D>,
        boundary: &Boundary<D>,
        (near, sums): (&[u32], &mut [PairSums<D>]),
    ) {
        let Some(acting) = &boundary.extrapolated_velocity else { return };
        let (Particles { r, v, rho, .. }, support2) = (&boundary.particles, self.support * self.support);
        // V₀ (u_b − v_b)·∇_a W.
        let pair = |a: usize, b: usize| {
            let arm = water.r[a] - r[b];
            let r2 = arm.norm_squared();
            if r2 < support2 { (self.slope)(r2) * (acting[b] - v[b]).dot(&arm) } else { 0.0 }
        };
        let of_water = |Neighbourhood { particle, others }: &Neighbourhood| {
            let a = *particle as usize;
            let sum: f64 = others.iter().map(|&b| pair(a, b as usize) / rho[b as usize]).sum();
            water.rho[a] * sum
        };
        let of_boundary = |Neighbourhood { particle, others }: &Neighbourhood| {
            let b = near[*particle as usize] as usize;
            let sum: f64 = others.iter().map(|&a| pair(a as usize, b) / water.rho[a as usize]).sum();
            rho[b] * sum
        };
        let task = PARTICLES_PER_TASK;
        let water_rates: Vec<f64> = self.water.par_iter().with_min_len(task).map(of_water).collect();
        let boundary_rates: Vec<f64> = self.boundary.par_iter().with_min_len(task).map(of_boundary).collect();
        self.water.iter().zip(water_rates).for_each(|(these, rate)| self.rates[these.particle as usize] = rate);
        for (these, rate) in self.boundary.iter().zip(boundary_rates) {
            sums[these.particle as usize].compression_rate += rate;
        }
    }
}

/// Finds the water beside the boundary particles of `system`, which were at `r` (m) when the present lists were built.
pub(super) fn find<const D: usize>(system: &mut System<D>, r: &[Vector<D>]) {
    let Some(slip) = &mut system.rates.slip else { return };
    let (water, neighbours) = (system.neighbours.positions_at_build(), &system.neighbours);
    let reach = slip.support + neighbours.margin();
    let beside = |i: usize| {
        let mut others = Vec::new();
        let mut add = |b: usize| {
            if (water[i] - r[b]).norm_squared() < reach * reach {
                others.push(b as u32);
            }
        };
        neighbours.visit_boundary_around(|| r.to_vec(), &water[i], &mut add);
        others.sort_unstable();
        (!others.is_empty()).then_some(Neighbourhood { particle: i as u32, others })
    };
    let all = (0..water.len()).into_par_iter().with_min_len(PARTICLES_PER_TASK);
    slip.water = all.filter_map(beside).collect();
    slip.rates = vec![0.0; water.len()];
    let near = neighbours.boundary_near_fluid();
    let mut waters = vec![Vec::new(); near.len()];
    for Neighbourhood { particle, others } in &slip.water {
        let places = others.iter().filter_map(|b| near.binary_search(b).ok());
        places.for_each(|place| waters[place].push(*particle));
    }
    let filled = waters.into_iter().enumerate().filter(|(_, others)| !others.is_empty());
    slip.boundary = filled.map(|(place, others)| Neighbourhood { particle: place as u32, others }).collect();
}
