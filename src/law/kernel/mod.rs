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

    /// The same, weighed with the volume of particles `dp` (m) apart so that a lattice of them has the first moment
    /// −Σ V r_x ∂W r_x = 1: the gradient of what is linear is then exact on it. The support holds at most 12 dp.
    fn on_lattice(self, dp: f64, dimension: usize) -> Self {
        let volume = dp.powi(dimension as i32);
        let (n, layers) = (MOST, if dimension == 2 { 0..=0 } else { -MOST..=MOST });
        let mut moment = 0.0;
        for k in layers {
            for j in -n..=n {
                for i in -n..=n {
                    let r2 = f64::from(i * i + j * j + k * k) * dp * dp;
                    moment -= volume * f64::from(i * i) * dp * dp * self.slope(r2);
                }
            }
        }
        self.weighed(volume / moment)
    }

    /// ∂W = (dW/dr)/r (1/mᴰ⁺²) at squared distance `r2` (m²): ∇_a W = ∂W r_ab. Finite at r = 0.
    fn slope<N: Num>(&self, r2: N) -> N;
}

/// Most particles in a row within the support.
const MOST: i32 = 12;

/// Support radius over smoothing length, the same for every kernel here.
pub const REACH: f64 = 2.0;
