//! Sub-particle-scale stress:  dv_a/dt += Σ m_b (τ_a/ρ_a² + τ_b/ρ_b²)·∇_a W,
//! τ_ij = ρ[ν_t(2 S_ij − ⅔ S_kk δ_ij) − ⅔ C_I Δ² |S|² δ_ij],  ν_t = (C_s Δ)² |S|,  |S| = √(2 S_ij S_ij),  Δ = dp/√D.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Laminar, LaminarTerm};
use crate::sph::{AuxiliarySums, FluidProperties, Num, Pair, Term, Units};

/// Laminar viscosity with a Smagorinsky stress @dalrymple2006; eqs. (6)–(8) of @pirkhalili2023. The
/// paper's k is the trace S_kk: only so do its units agree with 2 S_ij beside it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Sps {
    /// Kinematic viscosity ν₀, m²/s.
    pub nu0: f64,
    /// Smagorinsky constant C_s, –.
    pub smagorinsky: f64,
    /// Constant C_I of the isotropic part, –.
    pub isotropic: f64,
}

impl Default for Sps {
    /// Water with the constants of @dalrymple2006.
    fn default() -> Self {
        Self { nu0: 1e-6, smagorinsky: 0.12, isotropic: 0.0066 }
    }
}

impl Sps {
    /// The laws, in those units: laminar part, as [`Laminar::term`], and stress.
    pub(crate) fn terms(&self, units: &Units, damped: f64) -> (LaminarTerm, SpsTerm) {
        (Laminar { nu0: self.nu0 }.term(units, damped), SpsTerm)
    }

    /// ρ₀ τ/ρ² (m²/s²) from the strain rate (1/s; `[i][j]` with j ≤ i is read) and the specific volume `s` = ρ₀/ρ of
    /// a particle.
    #[inline]
    pub fn stress<N: Num, const D: usize>(
        &self,
        strain: &[[N; D]; D],
        s: N,
        medium: &FluidProperties<D>,
    ) -> [[N; D]; D] {
        let of = |x: f64| s.constant(x);
        let strain: [[N; D]; D] = std::array::from_fn(|i| std::array::from_fn(|j| strain[i.max(j)][i.min(j)]));
        let length2 = medium.dp * medium.dp / D as f64;
        let norm2 = of(2.0) * strain.iter().flatten().fold(of(0.0), |sum, &x| sum + x * x);
        let nu_t = of(self.smagorinsky * self.smagorinsky * length2) * norm2.sqrt();
        let trace = (0..D).fold(of(0.0), |sum, i| sum + strain[i][i]);
        let isotropic = of(2.0 / 3.0) * (nu_t * trace + of(self.isotropic * length2) * norm2);
        std::array::from_fn(|i| {
            std::array::from_fn(|j| s * (of(2.0) * nu_t * strain[i][j] - if i == j { isotropic } else { of(0.0) }))
        })
    }
}

/// The stress of [`Sps`], and the strain rate for that of the next step: S_ij = ½(∂_j v_i + ∂_i v_j) with
/// ∂_j v_i = Σ V_b (v_b − v_a)_i ∂_j W. Strain is summed once a step, so that the stress that acts is that of the step before.
#[derive(Clone, Copy, Debug)]
pub struct SpsTerm;

impl<const D: usize> Term<D> for SpsTerm {
    const STRESS: bool = true;

    #[inline(always)]
    fn vector<N: Num>(&self, ab: &Pair<N, D>, mut sum: [N; D]) -> [N; D] {
        for (i, sum) in sum.iter_mut().enumerate() {
            for j in 0..D {
                let (row, column) = (i.max(j), i.min(j));
                *sum = (ab.a.stress[row][column] + ab.b.stress[row][column]).fma(ab.r_ab[j], *sum);
            }
        }
        sum
    }

    #[inline(always)]
    fn auxiliary<N: Num>(&self, ab: &Pair<N, D>, factor: N, a: &mut AuxiliarySums<N, D>, b: &mut AuxiliarySums<N, D>) {
        let half = ab.constant(-0.5) * factor;
        let (of_b, of_a) = (half * ab.b.specific_volume, half * ab.a.specific_volume);
        for i in 0..D {
            for j in 0..D {
                if j <= i {
                    let s = ab.v_ab[i].fma(ab.r_ab[j], ab.v_ab[j] * ab.r_ab[i]);
                    a.strain[i][j] = of_b.fma(s, a.strain[i][j]);
                    b.strain[i][j] = of_a.fma(s, b.strain[i][j]);
                }
            }
        }
    }
}
