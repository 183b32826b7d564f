//! Corrected gradients: where neighbours are unevenly arranged or missing, Σ V_b f_b ∇_a W is not the gradient of a linear field. With
//!
//!   M_a = −Σ V₀ r_ab ⊗ ∇_a W,   B_a = M_a⁻¹,
//!
//! B_a ∇_a W does, exactly @bonet1999. V₀ = dpᴰ and not m/ρ, so that water at rest on its lattice, however deep, has B = 1.
//! The pressure force of a pair is then
//!
//!   dv_a/dt = −Σ m_b (P_a B_a + P_b B_b)/(ρ_a ρ_b) ∇_a W,
//!
//! which changes its sign when a and b swap. So it conserves momentum @zhang2024, but not angular momentum where M is not the
//! unit matrix. It acts between water particles only: at faces it would count boundary particles above a waterline as neighbours,
//! and bodies would float a tenth of dp too deep. Where a particle has few neighbours, as in spray, the correction fades:
//! B = 1 + w (M⁻¹ − 1), w = min(1, 2ᴰ⁻¹ det M) @ren2023. At a flat free surface det M = 2⁻ᴰ, and w = ½. B is computed for new
//! neighbour lists and at every 20th force pass: particles move by less than a tenth of the support in between.
//!
//! The correction adds the power −Σ V_a P_a (B_a − 1) : (∇v)_a, which no compression takes up. This power stirs still water, and
//! more so at a higher pressure. A correction near the surface only, where waves need it (Schulze et al. 2025), does not stir the
//! water:
//!
//!   B = 1 + s w (M⁻¹ − 1),   s = min(max(2 − P_a/(n ρ₀ |g| dp), 0), 1),   n = 4.

use super::{AuxiliarySums, Num, Pair, Term};

/// det M, –, below which the neighbours do not determine a gradient.
const SINGULAR: f64 = 1e-9;

/// Number of force passes after which the corrections are computed again.
pub(crate) const PASSES: u64 = 20;

/// n, –: below the depth 2 n dp, [`near_surface`] leaves gradients uncorrected.
const SURFACE_DEPTH: f64 = 4.0;

/// s (–) of water with pressure `p` (P/ρ₀, m²/s²), where one dp of water weighs `weight` (|g| dp, m²/s²).
pub fn near_surface<N: Num>(p: N, weight: N) -> N {
    let of = |x: f64| p.constant(x);
    let share = (of(2.0) - p / (of(SURFACE_DEPTH) * weight)).max(of(0.0)).min(of(1.0));
    weight.select_below(of(1e-30), of(1.0), share)
}

/// C = B − 1 (–) from the `moment` M of a particle (`[i][j]` with j ≤ i is read).
pub fn correction<N: Num, const D: usize>(moment: &[[N; D]; D]) -> [[N; D]; D] {
    // Gauss–Jordan elimination without a search for pivots: M is symmetric and positive definite; otherwise there is no
    // correction.
    let of = |x: f64| moment[0][0].constant(x);
    let unit = |i: usize, j: usize| of(f64::from(u8::from(i == j)));
    let mut left: [[N; D]; D] = std::array::from_fn(|i| std::array::from_fn(|j| moment[i.max(j)][i.min(j)]));
    let mut inverse: [[N; D]; D] = std::array::from_fn(|i| std::array::from_fn(|j| unit(i, j)));
    let (mut det, mut regular) = (of(1.0), of(1.0));
    for k in 0..D {
        let pivot = left[k][k];
        det = det * pivot;
        regular = of(0.0).select_below(pivot, regular, of(0.0));
        regular = of(SINGULAR).select_below(det, regular, of(0.0));
        let (row, inverse_row) = (left[k].map(|x| x / pivot), inverse[k].map(|x| x / pivot));
        for i in 0..D {
            let factor = left[i][k];
            for j in 0..D {
                left[i][j] = if i == k { row[j] } else { left[i][j] - factor * row[j] };
                inverse[i][j] = if i == k { inverse_row[j] } else { inverse[i][j] - factor * inverse_row[j] };
            }
        }
    }
    let weight = (det * of((1 << (D - 1)) as f64)).min(of(1.0));
    let entry = |i: usize, j: usize| of(0.5).select_below(regular, weight * (inverse[i][j] - unit(i, j)), of(0.0));
    std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)))
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
