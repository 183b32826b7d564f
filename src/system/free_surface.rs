//! Where the surface of the water is: a height at which Σ V_b W, the share of the kernel's weight that water fills, falls
//! through ½. On flat water that is the surface itself.

use rayon::prelude::*;

use super::{System, known_water};
use crate::{
    math::{Bounds, Vector},
    particles::PARTICLES_PER_TASK,
    solid::{Role, Solid},
};

impl<const D: usize> System<D> {
    /// Heights (m) of the water surfaces at the horizontal position `at` (m; its last coordinate does not count), from the
    /// highest down, to a thousandth of dp. Spray that fills less than half of a kernel does not count.
    pub fn surface_heights(&self, at: &Vector<D>) -> impl Iterator<Item = f64> {
        let (dp, h, up) = (self.model.dp, self.model.h, D - 1);
        let beside = |r: &Vector<D>| (0..up).map(|i| (r[i] - at[i]).powi(2)).sum::<f64>() < (2.0 * h).powi(2);
        let nothing = || (f64::INFINITY, f64::NEG_INFINITY);
        let (r, known) = (self.fluid().r, self.neighbours.known_water());
        let count = known.map_or(r.len(), <[u32]>::len);
        let place = |k: usize| &r[known.map_or(k, |known| known[k] as usize)];
        let all = (0..count).into_par_iter().with_min_len(PARTICLES_PER_TASK).map(place);
        let heights = all.filter(|r| beside(r)).map(|r| (r[up], r[up]));
        let (low, high) = heights.reduce(nothing, |a, b| (a.0.min(b.0), a.1.max(b.1)));
        let at = *at;
        let filled = move |z: f64| {
            let mut x = at;
            x[up] = z;
            let mut sum = 0.0;
            self.visit_fluid_near(&x, &mut |b, _, w| sum += self.particle_mass() / self.fluid.particles.rho[b] * w);
            sum
        };
        half_crossings(filled, low, high + 2.0 * h, 0.5 * dp, 1e-3 * dp)
    }

    /// Updates the absorbing paddles for the surface in front of them at time `t` (s), the start of a step; the lists must hold.
    pub(crate) fn update_absorption(&mut self, t: f64) {
        known_water::know_within(self, &self.absorption_ranges(t));
        for i in 0..self.solids.len() {
            let solid = &self.solids[i];
            let Role::Driven(motion) = &solid.spec.role else { continue };
            let Some(gauge) = motion.gauge_position(&solid.absorption, t) else { continue };
            let level = self.surface_heights(&gauge).next();
            self.solids[i].absorption = motion.update_absorption(&solid.absorption, t, level);
        }
    }

    /// The boxes (m) in which absorbing paddles read the surface at time `t` (s), the start of a step.
    pub(crate) fn absorption_ranges(&self, t: f64) -> Vec<Bounds<D>> {
        let range = |solid: &Solid<D>| match &solid.spec.role {
            Role::Driven(motion) => Some(self.surface_range(&motion.gauge_position(&solid.absorption, t)?)),
            _ => None,
        };
        self.solids.iter().filter_map(range).collect()
    }

    /// The box (m) in which [`System::surface_heights`] reads the water.
    pub(crate) fn surface_range(&self, at: &Vector<D>) -> Bounds<D> {
        let mut range = Bounds { min: *at, max: *at }.grown(self.model.support_radius().max(2.0 * self.model.h));
        (range.min[D - 1], range.max[D - 1]) = (f64::NEG_INFINITY, f64::INFINITY);
        range
    }
}

/// The heights between `low` and `high` at which `filled` falls through ½ on the way up, from the highest down: found by
/// steps of `step` downwards and bisection to `tolerance`.
fn half_crossings(
    filled: impl Fn(f64) -> f64,
    low: f64,
    high: f64,
    step: f64,
    tolerance: f64,
) -> impl Iterator<Item = f64> {
    // Where the water of the surface before was met.
    let mut met: Option<f64> = None;
    std::iter::from_fn(move || {
        let mut dry = match met {
            None => high,
            Some(mut z) => {
                while filled(z) >= 0.5 {
                    z -= step;
                }
                z
            }
        };
        let mut wet = dry;
        while filled(wet) < 0.5 {
            (dry, wet) = (wet, wet - step);
            if wet.is_nan() || wet < low {
                return None;
            }
        }
        met = Some(wet);
        while dry - wet > tolerance {
            let middle = 0.5 * (wet + dry);
            if filled(middle) < 0.5 { dry = middle } else { wet = middle }
        }
        Some(0.5 * (wet + dry))
    })
}

#[cfg(test)]
#[path = "../../tests/unit/system/free_surface.rs"]
mod tests;
