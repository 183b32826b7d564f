//! Whether water that starts on a lattice stays there under its own pressure.
//!
//! The particles of a lattice under the pressure P are displaced by u exp(ik·r). Sound pulls them back, and so does the
//! acceleration (2P/ρ₀) H(k) u, with H(k) = Σ V ∇∇W (1 − cos k·r): the pressure force at the displaced places with the former
//! densities. Sound acts along S = Σ V ∇W sin k·r. If H is negative across S, a shear of the lattice grows like
//! exp(t √(2 P |μ|/ρ₀)/dp), with μ = dp² H, and the water rearranges itself @monaghan2000. Pairing is one such mode.

use nalgebra::{Matrix3, Vector3};

use super::{Kernel, SUPPORT_RATIO};
use crate::sph::FluidProperties;

/// Compression P/ρ₀c₀² (–) for which the stiffness by sound is added to that by pressure: the one at the bed with c₀ =
/// 10 √(g depth).
const COMPRESSION: f64 = 0.01;

/// The wave numbers that are tried are multiples of π/12 per dp.
const PARTS: usize = 12;

/// μ (–), the least stiffness of a square (cubic) lattice of the medium's spacing against any wave under `kernel`: 0 if the
/// lattice is stable, negative if a wave grows.
pub fn lattice_stiffness<const D: usize>(kernel: impl Kernel, medium: &FluidProperties<D>) -> f64 {
    let neighbours = neighbours(kernel.normalised_on_lattice(medium), medium);
    let sines: Vec<f64> = (0..2 * PARTS).map(|i| (i as f64 * std::f64::consts::PI / PARTS as f64).sin()).collect();
    let mut least = 0.0_f64;
    // Symmetry gives the other wave numbers.
    for a in 1..=PARTS {
        for b in 0..=a {
            for c in 0..=if D == 2 { 0 } else { b } {
                least = least.min(lowest_stiffness::<D>(&neighbours, &[a, b, c].map(|n| n as i64), &sines));
            }
        }
    }
    least
}

/// One neighbour of the particle in the middle: its place, V ∇W and V ∇∇W, in spacings.
type LatticeNeighbour = ([i64; 3], Vector3<f64>, Matrix3<f64>);

fn neighbours<const D: usize>(kernel: impl Kernel, medium: &FluidProperties<D>) -> Vec<LatticeNeighbour> {
    let (reach, spacing2) = (SUPPORT_RATIO * medium.h / medium.dp, medium.dp.powi(2));
    let slope = |r2: f64| spacing2 * kernel.slope(spacing2 * r2);
    let most = reach as i64;
    let layers = if D == 2 { 0 } else { most };
    let mut all = Vec::new();
    for i in -most..=most {
        for j in -most..=most {
            for k in -layers..=layers {
                let r = Vector3::new(i as f64, j as f64, k as f64);
                let r2 = r.norm_squared();
                if r2 == 0.0 || r2 >= reach.powi(2) {
                    continue;
                }
                let (first, step) = (slope(r2), 1e-4);
                // d(slope)/d(r²).
                let bend = (slope(r2 + step) - slope(r2 - step)) / (2.0 * step);
                all.push(([i, j, k], r * first, Matrix3::identity() * first + r * r.transpose() * (2.0 * bend)));
            }
        }
    }
    all
}

/// The least stiffness against the waves k = `wave` π/12.
fn lowest_stiffness<const D: usize>(neighbours: &[LatticeNeighbour], wave: &[i64; 3], sines: &[f64]) -> f64 {
    let (mut pull, mut sound) = (Matrix3::zeros(), Vector3::zeros());
    for (place, gradient, hessian) in neighbours {
        let turn: i64 = place.iter().zip(wave).map(|(x, k)| x * k).sum();
        let at = |n: i64| sines[n.rem_euclid(2 * PARTS as i64) as usize];
        pull += hessian * (1.0 - at(turn + PARTS as i64 / 2));
        sound += gradient * at(turn);
    }
    let both = pull + sound * sound.transpose() * (0.5 / COMPRESSION);
    both.view((0, 0), (D, D)).clone_owned().symmetric_eigenvalues().min()
}
