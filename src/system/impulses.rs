//! Impulses that bodies and mooring lines give to the water around them, outside the sums over pairs.

use std::collections::BTreeMap;

use super::{System, known_water, periodic::Images, reflected};
use crate::math::{Bounds, Vector};

/// A momentum that some water particles and their images have received.
pub(crate) struct MomentumTransfer<const D: usize> {
    /// The water particles and their images, each with the change of its velocity, m/s.
    pub(crate) changes: Vec<(usize, Vector<D>)>,
    /// Energy that the water gained, J (J/m in 2-D).
    pub(crate) energy: f64,
}

/// Returns the `impulse` (N s) to the water nearest to `solid`, in equal shares. If a symmetry plane cuts the solid, the images
/// of that water get their share.
pub(crate) fn return_impulse<const D: usize>(
    system: &mut System<D>,
    solid: usize,
    impulse: &Vector<D>,
) -> Option<MomentumTransfer<D>> {
    if impulse.norm_squared() == 0.0 {
        return None;
    }
    let mass = system.particle_mass() * system.symmetry_planes().multiplicity(!system.solids[solid].division.cut);
    let images_of_all = system.solid_multiplicity(solid);
    let mut distance = system.model.support_radius();
    loop {
        let particles = water_beside(system, solid, distance);
        if !particles.is_empty() {
            let velocity = impulse / (particles.len() as f64 * mass);
            let changes = particles.into_iter().map(|i| (i, velocity)).collect();
            return Some(change_velocities(system, changes, mass * images_of_all));
        }
        distance *= 2.0;
        if !distance.is_finite() {
            return None;
        }
        let range = bounds_beside(system, solid, distance);
        known_water::know_within(system, &[range]);
    }
}

/// Returns the box around `solid`, grown by `distance` (m).
pub(crate) fn bounds_beside<const D: usize>(system: &System<D>, solid: usize, distance: f64) -> Bounds<D> {
    Bounds::around(&system.boundary.particles.r[system.home_boundary(solid)]).grown(distance)
}

/// Whether there is water within the support of solid number `solid`.
#[cfg(feature = "gpu")]
pub(crate) fn has_water_beside<const D: usize>(system: &System<D>, solid: usize) -> bool {
    !water_beside(system, solid, system.model.support_radius()).is_empty()
}

/// Returns the water particles in the box around `solid`, grown by `distance` (m).
fn water_beside<const D: usize>(system: &System<D>, solid: usize, distance: f64) -> Vec<usize> {
    let around = bounds_beside(system, solid, distance);
    let mut particles = system.neighbours.fluid_within(&around);
    let count = system.particle_count();
    particles.retain(|&i| i < count && around.contains(&system.fluid.particles.r[i]));
    particles
}

/// Distributes each of these impulses (N s) at its position (m) over the water around it, in the shares V W/Σ V W of a kernel
/// mean of the water there. An impulse at a position without water, or with buffer water only, is omitted.
pub(crate) fn spread_impulses<const D: usize>(
    system: &mut System<D>,
    given: &[(Vector<D>, Vector<D>)],
) -> Option<MomentumTransfer<D>> {
    let (mass, count) = (system.particle_mass(), system.particle_count());
    let mut changes = BTreeMap::<usize, Vector<D>>::new();
    let mut shares = Vec::new();
    for (x, impulse) in given.iter().filter(|(_, impulse)| impulse.norm_squared() > 0.0) {
        shares.clear();
        let rho = system.fluid().rho;
        let mut add = |i: usize, w: f64| shares.extend((i < count).then(|| (i, w / rho[i])));
        system.visit_fluid_near(&system.wrapped(x), &mut |i, _, w| add(i, w));
        let sum: f64 = shares.iter().map(|(_, share)| share).sum();
        for (i, share) in shares.iter().filter(|_| sum > 0.0) {
            *changes.entry(*i).or_insert_with(Vector::zeros) += impulse * (share / (sum * mass));
        }
    }
    (!changes.is_empty()).then(|| change_velocities(system, changes.into_iter().collect(), mass))
}

/// Changes the velocities (m/s) of these water particles, which are sorted by number, and of their images. Each particle stands
/// for the mass `mass` (kg).
pub(super) fn change_velocities<const D: usize>(
    system: &mut System<D>,
    mut changes: Vec<(usize, Vector<D>)>,
    mass: f64,
) -> MomentumTransfer<D> {
    let real = system.own_count();
    let water = &mut system.fluid.particles;
    let gained: f64 = changes.iter().map(|(i, change)| change.dot(&(water.v[*i] + change * 0.5))).sum();
    let Images { originals, reflections, .. } = &system.fluid.images;
    let of_image = |(k, original): (usize, &u32)| {
        let found = changes.binary_search_by_key(&(*original as usize), |(i, _)| *i).ok()?;
        Some((real + k, reflected(reflections.get(k).copied().unwrap_or(0), changes[found].1)))
    };
    let images: Vec<_> = originals.iter().enumerate().filter_map(of_image).collect();
    changes.extend(images);
    changes.iter().for_each(|(i, change)| water.v[*i] += change);
    MomentumTransfer { changes, energy: gained * mass }
}
