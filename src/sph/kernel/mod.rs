//! Kernels W(r, h), normalised to ∫ W dV = 1, zero from r = 2h on.

mod cubic;
#[doc(hidden)]
pub mod lattice;
mod wendland;

pub use cubic::Cubic;
pub use wendland::Wendland;

use super::{FluidProperties, Num};

/// A kernel for one smoothing length and dimension.
pub trait Kernel: Copy + Send + Sync {
    /// W (1/mᴰ) at squared distance `r2` (m²).
    fn w<N: Num>(&self, r2: N) -> N;

    /// The same with W and ∂W multiplied by `volume`.
    fn times_volume(self, volume: f64) -> Self;

    /// The same, multiplied by a volume such that −Σ r_x ∂W r_x = 1 over a lattice of spacing dp: there the gradient of a linear
    /// field is exact.
    fn normalised_on_lattice<const D: usize>(self, medium: &FluidProperties<D>) -> Self {
        self.times_volume(1.0 / moment(&self, medium, |_| 1.0))
    }

    /// The factor (–) by which r²/(r² + η²) reduces a viscous force on a lattice.
    fn viscous_sum<const D: usize>(&self, medium: &FluidProperties<D>) -> f64 {
        let eta2 = medium.eta2();
        moment(self, medium, |r2| r2 / (r2 + eta2)) / moment(self, medium, |_| 1.0)
    }

    /// ∂W = (dW/dr)/r (1/mᴰ⁺²) at squared distance `r2` (m²): ∇_a W = ∂W r_ab. Finite at r = 0.
    fn slope<N: Num>(&self, r2: N) -> N;
}

/// −Σ r_x f(r²) ∂W r_x over a lattice of spacing dp around its middle.
fn moment<K: Kernel, const D: usize>(kernel: &K, medium: &FluidProperties<D>, f: impl Fn(f64) -> f64) -> f64 {
    let FluidProperties { h, dp, .. } = *medium;
    let most = (SUPPORT_RATIO * h / dp) as i32;
    let layers = if D == 2 { 0 } else { most };
    let mut moment = 0.0;
    for k in -layers..=layers {
        for j in -most..=most {
            for i in -most..=most {
                let [x, y, z] = [i, j, k].map(|n| f64::from(n) * dp);
                let r2 = x * x + y * y + z * z;
                moment -= x * x * f(r2) * kernel.slope(r2);
            }
        }
    }
    moment
}

/// Support radius over smoothing length, the same for every kernel here.
pub(crate) const SUPPORT_RATIO: f64 = 2.0;
