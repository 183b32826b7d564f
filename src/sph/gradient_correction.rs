//! Corrected gradients: where neighbours are unevenly arranged or missing, Σ V_b f_b ∇_a W is not the gradient of a linear field. With
//!
//!   M_a = −Σ V₀ r_ab ⊗ ∇_a W,   B_a = M_a⁻¹,
//!
//! B_a ∇_a W does, exactly @bonet1999. V₀ = dpᴰ and not m/ρ, so that water at rest on its lattice, however deep, has B = 1.
//! The pressure force of a pair is then
//!
//!   dv_a/dt = −Σ m_b (P_a B_a + P_b B_b)/(ρ_a ρ_b) ∇_a W,
//!
//! which changes its sign when a and b swap, so that momentum is kept @zhang2024; angular momentum is no longer, to the extent to
//! which M differs from 1. It acts among water alone: at faces it would count boundary particles above a waterline as neighbours,
//! and bodies would float a tenth of dp too deep. Where few neighbours are left, as in spray, the correction fades:
//! B = 1 + w (M⁻¹ − 1), w = min(1, 2ᴰ⁻¹ det M) @ren2023, by half at a flat free surface, where det M = 2⁻ᴰ. B belongs to the
//! positions for which the neighbour lists were built: particles move by less than a tenth of the support until the next lists.
//!
//! The pair force has the power −Σ V_a P_a (B_a − 1) : (∇v)_a, which no compression takes up. It stirs still water, the more the
//! higher the pressure. Near the surface alone, where waves need the correction (Schulze et al. 2025), it does not:
//!
//!   B = 1 + s w (M⁻¹ − 1),   s = min(max(2 − P_a/(n ρ₀ |g| dp), 0), 1),   n = 4.

use super::{AuxiliarySums, Num, Pair, Term};

/// det M, –, below which there is nothing to tell a slope from.
const SINGULAR: f64 = 1e-9;

/// Force passes after which corrections are made anew.
pub(crate) const PASSES: u64 = 20;

/// n: from twice this depth over dp on, –, gradients are not corrected in [`near_surface`].
const SURFACE_DEPTH: f64 = 4.0;

/// s (–) of water with pressure `p` (P/ρ₀, m²/s²), where one dp of water weighs `weight` (|g| dp, m²/s²).
pub fn near_surface(p: f64, weight: f64) -> f64 {
    if weight > 0.0 { (2.0 - p / (SURFACE_DEPTH * weight)).clamp(0.0, 1.0) } else { 1.0 }
}

/// C = B − 1 (–) from the `moment` M of a particle (`[i][j]` with j ≤ i is read).
pub fn correction<const D: usize>(moment: &[[f64; D]; D]) -> [[f64; D]; D] {
    // Gauss and Jordan without a search for pivots: M is symmetric and positive, or else there is no correction.
    let mut left: [[f64; D]; D] = std::array::from_fn(|i| std::array::from_fn(|j| moment[i.max(j)][i.min(j)]));
    let mut inverse: [[f64; D]; D] = std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j))));
    let mut det = 1.0;
    for k in 0..D {
        let pivot = left[k][k];
        det *= pivot;
        if !(pivot > 0.0 && det > SINGULAR) {
            return [[0.0; D]; D];
        }
        let (row, of) = (left[k].map(|x| x / pivot), inverse[k].map(|x| x / pivot));
        for i in 0..D {
            let factor = left[i][k];
            for j in 0..D {
                left[i][j] = if i == k { row[j] } else { left[i][j] - factor * row[j] };
                inverse[i][j] = if i == k { of[j] } else { inverse[i][j] - factor * of[j] };
            }
        }
    }
    let weight = (det * (1 << (D - 1)) as f64).min(1.0);
    std::array::from_fn(|i| std::array::from_fn(|j| weight * (inverse[i][j] - f64::from(u8::from(i == j)))))
}

/// The moments M of the neighbours, water and solids alike.
#[derive(Clone, Copy, Debug)]
pub struct RenormalizationTerm;

impl<const D: usize> Term<D> for RenormalizationTerm {
    const RENORMALIZATION: bool = true;

    #[inline(always)]
    fn auxiliary<N: Num>(&self, ab: &Pair<N, D>, factor: N, a: &mut AuxiliarySums<N, D>, b: &mut AuxiliarySums<N, D>) {
        for i in 0..D {
            for j in 0..=i {
                let share = -factor * ab.r_ab[i] * ab.r_ab[j];
                a.renormalization[i][j] = a.renormalization[i][j] + share;
                b.renormalization[i][j] = b.renormalization[i][j] + share;
            }
        }
    }
}

/// The share of the correction in the pressure force among water.
#[derive(Clone, Copy, Debug)]
pub struct CorrectedGradientTerm;

impl<const D: usize> Term<D> for CorrectedGradientTerm {
    const GRADIENT_CORRECTION: bool = true;

    #[inline(always)]
    fn vector<N: Num>(&self, ab: &Pair<N, D>, mut sum: [N; D]) -> [N; D] {
        let volumes = -(ab.a.specific_volume * ab.b.specific_volume);
        let (of_a, of_b) = (volumes * ab.a.p, volumes * ab.b.p);
        for (i, sum) in sum.iter_mut().enumerate() {
            for j in 0..D {
                let (row, column) = (i.max(j), i.min(j));
                let (a, b) =
                    (of_a * ab.a.gradient_correction[row][column], of_b * ab.b.gradient_correction[row][column]);
                *sum = (a + b).fma(ab.r_ab[j], *sum);
            }
        }
        sum
    }
}

#[cfg(test)]
#[path = "../../tests/unit/sph/gradient_correction.rs"]
mod tests;
