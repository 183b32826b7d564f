//! How much wave a paddle makes, by linear theory.
//!
//! A paddle whose face at height z over the still level moves by f(z) X makes waves of amplitude a = c X,
//!
//!   c = 4k sinh kd ∫ f cosh k(z + d) dz/(sinh 2kd + 2kd)
//!
//! A piston has f = 1, which gives 2 (cosh 2kd − 1)/(sinh 2kd + 2kd); a flap f = (z + l)/l above its hinge, l below the
//! still level, and 0 under it. @biesel1951, @dean1991 ch. 6.

use nalgebra::Complex;

use super::LinearWave;

/// How a paddle moves.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Paddle {
    /// All of it alike.
    Piston,
    /// It turns about a hinge.
    Flap {
        /// Depth of the hinge below the still level, m; over, at or under the bed. Over it the wall below stands still.
        arm: f64,
    },
}

/// kd beyond which the bed is not felt, and cosh 2kd is near the largest number.
const DEEPEST: f64 = 300.0;

impl Paddle {
    /// Amplitude of the wave over that of the paddle at the still level, –.
    pub fn transfer_function(&self, train: &LinearWave) -> f64 {
        let kd = train.kd();
        if kd > DEEPEST {
            return 2.0 * (1.0 - self.inverse_arm() / train.k);
        }
        let shape = self.shape_integral(Complex::from(train.k), train.depth).re;
        4.0 * train.k * kd.sinh() * shape / ((2.0 * kd).sinh() + 2.0 * kd)
    }

    /// 1/l, 1/m; 0 of a piston.
    pub(super) fn inverse_arm(&self) -> f64 {
        match self {
            Self::Piston => 0.0,
            Self::Flap { arm } => 1.0 / arm,
        }
    }

    /// Height (m) of the hinge over the bed, 0 if it is under it.
    pub(super) fn hinge_above_bed(&self, depth: f64) -> f64 {
        match self {
            Self::Piston => 0.0,
            Self::Flap { arm } => (depth - arm).max(0.0),
        }
    }

    /// ∫ f cosh k(z + d) dz from the bed to the still level, m.
    pub(super) fn shape_integral(&self, k: Complex<f64>, depth: f64) -> Complex<f64> {
        let lean = ((k * depth).cosh() - (k * self.hinge_above_bed(depth)).cosh()) * self.inverse_arm() / (k * k);
        (k * depth).sinh() / k - lean
    }
}
