//! δ-diffusion of the dynamic density alone: as Molteni's, with ρ_b − ρ_a less the hydrostatic difference.
//!
//! Between two heights of water at rest dρ = ρ g·dr/c², c² = c₀² (ρ/ρ₀)^(γ−1), so that
//! x^H_b − x^H_a = g·(r_b − r_a)/c₀² (1 − (γ − 2) x̄) to second order, x̄ = (x_a + x_b)/2. Fourtakas et al. (2019)
//! integrate the equation of state from ρ₀ instead, which is the same at x = 0 but not antisymmetric and costs
//! a power a pair. This form holds for any direction of g.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::sph::{FluidProperties, Num, Pair, Term};

/// Fourtakas' diffusion @fourtakas2019: still water stays still.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Fourtakas {
    /// δ, –.
    pub delta: f64,
}

impl Default for Fourtakas {
    /// δ = 0.1, the paper's.
    fn default() -> Self {
        Self { delta: 0.1 }
    }
}

impl Fourtakas {
    /// The law in water of the given constants.
    pub fn term<const D: usize>(&self, medium: &FluidProperties<D>) -> FourtakasTerm<D> {
        let c2 = medium.c0 * medium.c0;
        FourtakasTerm {
            strength: 2.0 * self.delta * medium.h * medium.c0,
            slope: std::array::from_fn(|i| medium.gravity[i] / c2),
            c2,
            stiffening: 0.5 * (medium.gamma - 2.0),
        }
    }
}

/// The law of [`Fourtakas`].
#[derive(Clone, Copy, Debug)]
pub struct FourtakasTerm<const D: usize> {
    strength: f64,
    /// g/c₀², 1/m.
    slope: [f64; D],
    /// c₀², m²/s²; infinite where the hydrostatic part is not left out.
    pub(super) c2: f64,
    stiffening: f64,
}

impl<const D: usize> Term<D> for FourtakasTerm<D> {
    fn set_gravity(&mut self, gravity: &[f64; D]) {
        self.slope = std::array::from_fn(|i| gravity[i] / self.c2);
    }

    #[inline(always)]
    fn rate<N: Num>(&self, ab: &Pair<N, D>, sum: (N, N)) -> (N, N) {
        let slope = |i: usize| ab.r2.parameter("slope", i, self.slope[i]);
        let mut rise = slope(0) * ab.r_ab[0];
        for i in 1..D {
            rise = slope(i).fma(ab.r_ab[i], rise);
        }
        let stiffer = ab.constant(-self.stiffening).fma(ab.a.compression + ab.b.compression, ab.constant(1.0));
        let d = ab.constant(self.strength) * rise.fma(stiffer, ab.compression_difference);
        ((-d).fma(ab.b.specific_volume, sum.0), d.fma(ab.a.specific_volume, sum.1))
    }
}
