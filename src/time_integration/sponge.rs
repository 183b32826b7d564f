//! Sponge layers over a step: v → v exp(−β sⁿ Δt), exact, so that they limit no step.

use rayon::prelude::*;

use crate::{
    math::Vector,
    particles::PARTICLES_PER_TASK,
    system::{System, own_water},
};

/// Damps the water in the sponge layers over `dt` (s), and the velocities `before` from which a scheme continues. Returns the
/// energy (J) that the water lost, if that is `measured`.
pub(super) fn damp_velocities<const D: usize>(
    system: &mut System<D>,
    dt: f64,
    before: Option<&mut [Vector<D>]>,
    measured: bool,
) -> f64 {
    if system.sponge_layers().is_empty() {
        return 0.0;
    }
    let energy = if measured { system.kinetic_energy() } else { 0.0 };
    let mut v = std::mem::take(&mut system.fluid.particles.v);
    let (layers, planes, r) = (system.sponge_layers(), system.symmetry_planes(), &system.fluid.particles.r);
    let rate_at = |r: &Vector<D>| layers.iter().map(|layer| layer.rate(r)).sum::<f64>();
    let (own, _) = own_water::own(&system.neighbours, r.len());
    for v in [Some(&mut v[..]), before].into_iter().flatten() {
        let (v, r) = (&mut v[own.clone()], &r[own.clone()]);
        v.par_iter_mut().zip(r).with_min_len(PARTICLES_PER_TASK).for_each(|(v, r)| {
            let rate = if planes.any() { rate_at(&planes.folded(r)) } else { rate_at(r) };
            if rate > 0.0 {
                *v *= (-rate * dt).exp();
            }
        });
    }
    system.fluid.particles.v = v;
    if measured { energy - system.kinetic_energy() } else { 0.0 }
}
