//! Ratio of wave amplitude to paddle amplitude, by linear theory.
//!
//! A paddle makes waves of amplitude a = c X if its face moves by f(z) X at height z above the still level:
//!
//!   c = 4k sinh kd ∫ f cosh k(z + d) dz/(sinh 2kd + 2kd)
//!
//! A piston has f = 1, so c = 2 (cosh 2kd − 1)/(sinh 2kd + 2kd). A flap has f = (z + l)/l above its hinge, which lies l
//! below the still level, and f = 0 below the hinge. @biesel1951, @dean1991 ch. 6.

use nalgebra::Complex;

use super::LinearWave;

/// Type of paddle motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Paddle {
    /// The whole face moves by the same displacement.
    Piston,
    /// The face turns about a hinge.
    Flap {
        /// Depth of the hinge below the still level, m. The hinge may lie above, at or below the bed. If the hinge lies
        /// above the bed, the wall below the hinge is fixed.
        arm: f64,
    },
}

/// Largest kd for which the code evaluates the bed's effect: beyond, the effect is negligible and cosh 2kd nears
/// overflow.
const DEEPEST: f64 = 300.0;

impl Paddle {
    /// Returns the ratio of the wave's amplitude to the paddle's amplitude at the still level, –.
    pub(crate) fn transfer_function(&self, train: &LinearWave) -> f64 {
        let kd = train.kd();
        if kd > DEEPEST {
            return 2.0 * (1.0 - self.inverse_arm() / train.k);
        }
        let shape = self.shape_integral(Complex::from(train.k), train.depth).re;
        4.0 * train.k * kd.sinh() * shape / ((2.0 * kd).sinh() + 2.0 * kd)
    }

    /// Returns 1/l, 1/m; 0 for a piston.
    pub(super) fn inverse_arm(&self) -> f64 {
        match self {
            Self::Piston => 0.0,
            Self::Flap { arm } => 1.0 / arm,
        }
    }

    /// Returns the height (m) of the hinge above the bed, or 0 if the hinge lies below the bed.
    pub(super) fn hinge_above_bed(&self, depth: f64) -> f64 {
        match self {
            Self::Piston => 0.0,
            Self::Flap { arm } => (depth - arm).max(0.0),
        }
    }

    /// Returns ∫ f cosh k(z + d) dz from the bed to the still level, m.
    pub(super) fn shape_integral(&self, k: Complex<f64>, depth: f64) -> Complex<f64> {
        let lean = ((k * depth).cosh() - (k * self.hinge_above_bed(depth)).cosh()) * self.inverse_arm() / (k * k);
        (k * depth).sinh() / k - lean
    }
}
