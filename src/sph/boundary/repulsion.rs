//! Repulsion: keeps water out of a face where pressure alone does not, as in a film under a heavy body.
//!
//! Water nearer than r₀ = ¾ dp to a boundary particle is pushed away from it with (A c₀²/dp²)(1 − r²/r₀²)² r, at any pressure.
//! The first row of water lies dp from the boundary particles and half a dp from the face. It meets this force only if it is
//! pressed a quarter of dp towards the face.

use crate::sph::{FluidProperties, Num, Pair, Term, kernel::Kernel};

/// The repulsion under one kernel.
#[derive(Clone, Copy, Debug)]
pub struct Repulsion {
    /// 1/r₀², 1/m².
    inv_range2: f64,
    /// A c₀²/dp² over −V₀ ∂W at half of r₀, m²/s².
    strength: f64,
}

impl Repulsion {
    /// r₀/dp, –.
    pub(crate) const RANGE: f64 = 0.75;

    /// A, –. It stops water that approaches with a third of the speed of sound or is pressed with a tenth of ρ₀ c₀², and it requires
    /// no shorter time step than sound does.
    pub(crate) const STRENGTH: f64 = 2.0;

    /// The repulsion under `kernel`.
    pub fn new<K: Kernel, const D: usize>(kernel: K, medium: &FluidProperties<D>) -> Self {
        let range2 = (Self::RANGE * medium.dp).powi(2);
        let slope: f64 = kernel.normalised_on_lattice(medium).slope(0.25 * range2);
        Self { inv_range2: 1.0 / range2, strength: Self::STRENGTH * (medium.c0 / medium.dp).powi(2) / -slope }
    }
}

impl<const D: usize> Term<D> for Repulsion {
    #[inline(always)]
    fn along_r<N: Num>(&self, ab: &Pair<N, D>, sum: N) -> N {
        let inside = ab.r2.fma(ab.constant(-self.inv_range2), ab.constant(1.0)).max(ab.constant(0.0));
        (inside * inside).fma(ab.constant(-self.strength), sum)
    }
}
