//! Impulses that bodies and mooring lines give to the water around them, outside the sums over pairs.

use std::collections::BTreeMap;

use super::{System, periodic::Images, reflected};
use crate::math::Vector;

/// A momentum that some water particles and their images have received.
pub(crate) struct MomentumTransfer<const D: usize> {
    /// The water particles and their images, each with the change of its velocity, m/s.
    pub(crate) changes: Vec<(usize, Vector<D>)>,
    /// Energy that the water gained, J (J/m in 2-D).
    pub(crate) energy: f64,
}

/// Gives each of these impulses (N s) at its place (m) to the water around it, in shares V W of the kernel W as those of a mean over
/// the water there. So what the impulse takes from the mean velocity is what all particles receive. A place without water gives none.
pub(crate) fn spread_impulses<const D: usize>(
    system: &mut System<D>,
    given: &[(Vector<D>, Vector<D>)],
) -> Option<MomentumTransfer<D>> {
    let mass = system.particle_mass();
    let mut changes = BTreeMap::<usize, Vector<D>>::new();
    let mut shares = Vec::new();
    for (x, impulse) in given.iter().filter(|(_, impulse)| impulse.norm_squared() > 0.0) {
        shares.clear();
        let rho = system.fluid().rho;
        system.visit_fluid_near(&system.wrapped(x), &mut |i, _, w| shares.push((i, w / rho[i])));
        let sum: f64 = shares.iter().map(|(_, share)| share).sum();
        for (i, share) in shares.iter().filter(|_| sum > 0.0) {
            *changes.entry(*i).or_insert_with(Vector::zeros) += impulse * (share / (sum * mass));
        }
    }
    if changes.is_empty() {
        return None;
    }
    let real = system.own_count();
    let water = &mut system.fluid.particles;
    let gained: f64 = changes.iter().map(|(&i, change)| change.dot(&(water.v[i] + change * 0.5))).sum();
    let Images { originals, reflections, .. } = &system.fluid.images;
    let of_image = |(k, i): (usize, &u32)| {
        let change = changes.get(&(*i as usize))?;
        Some((real + k, reflected(reflections.get(k).copied().unwrap_or(0), *change)))
    };
    let images: Vec<_> = originals.iter().enumerate().filter_map(of_image).collect();
    let changes: Vec<_> = changes.into_iter().chain(images).collect();
    changes.iter().for_each(|(i, change)| water.v[*i] += change);
    Some(MomentumTransfer { changes, energy: gained * mass })
}
