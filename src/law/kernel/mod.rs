//! Kernels W(r, h), normalised to ∫ W dV = 1, zero from r = 2h on.

mod cubic;
mod wendland;

pub use cubic::Cubic;
pub use wendland::Wendland;

use super::Num;

/// A kernel for one smoothing length and dimension.
pub trait Kernel: Copy + Send + Sync {
    /// W (1/mᴰ) at squared distance `r2` (m²).
    fn w<N: Num>(&self, r2: N) -> N;

    /// The same with W and ∂W multiplied by `volume`.
    fn weighed(self, volume: f64) -> Self;

    /// ∂W = (dW/dr)/r (1/mᴰ⁺²) at squared distance `r2` (m²): ∇_a W = ∂W r_ab. Finite at r = 0.
    fn slope<N: Num>(&self, r2: N) -> N;
}

/// Support radius over smoothing length, the same for every kernel here.
pub const REACH: f64 = 2.0;
