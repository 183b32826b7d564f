//! Second-order theory of a regular wave: the paddle motion of twice the frequency that prevents a free wave.
//!
//! To first order, the paddle motion X = Re A e^{iωt} gives Φ = Σ bⱼ Zⱼ(z) e^{i(ωt − kⱼx)}, Z = cosh k(z + d)/cosh kd.
//! The mode j = 0 is the progressive wave; the others (kⱼ = −iκⱼ) are evanescent modes at the paddle. To second order,
//! the terms in e^{2iωt} satisfy:
//!
//!   at the surface   φ_tt + g φ_z = −∂t |∇Φ|² − η ∂z(Φ_tt + g Φ_z)
//!   at the paddle    φ_x = f X₂′ − f X Φ_xx + f′ X Φ_z
//!
//! The surface forcing has the bound solution Σ Bⱼₗ cosh (kⱼ + kₗ)(z + d)/cosh (kⱼ + kₗ)d e^{−i(kⱼ + kₗ)x}. This
//! solution and the paddle's displacement leave a residual at x = 0. X₂ follows from the condition that the residual's
//! projection on the free wave of frequency 2ω vanishes. The problem is that of @schaffer1996; in shallow water the
//! solution becomes that of @madsen1971.

use nalgebra::Complex;

use super::{
    LinearWave, Paddle,
    train::{evanescent_wave_numbers, wave_number},
};

/// Number of evanescent modes in the sum: the correction is then accurate to 1 % up to kd = 3.
const MODES: usize = 100;

/// kd above which the code omits the correction: an SPH tank resolves no wave so short.
const DEEPEST: f64 = 30.0;

/// Returns the amplitude A₂ (m) of X₂ = Re A₂ e^{2iωt}. The paddle moves as X = Re A e^{iωt} at the still level, where
/// A is `amplitude` (m).
pub(super) fn correction(paddle: &Paddle, train: &LinearWave, amplitude: f64) -> Complex<f64> {
    let (d, omega, g) = (train.depth, train.omega, train.g);
    if train.kd() > DEEPEST {
        return Complex::from(0.0);
    }
    let free = Complex::from(wave_number(2.0 * omega, d, g));
    let standing = evanescent_wave_numbers(omega, d, g, MODES).into_iter().map(|kappa| Complex::new(0.0, -kappa));
    let modes: Vec<Mode> = [Complex::from(train.k)]
        .into_iter()
        .chain(standing)
        .map(|k| {
            let norm = ((k * d * 2.0).sinh() + k * d * 2.0) / (k * 4.0);
            Mode { k, b: -(k * d).cosh() * paddle.shape_integral(k, d) * (omega * amplitude) / (k * norm) }
        })
        .collect();
    // Integrals of products with cosh K(z + d), where K belongs to the free wave: half the sum of the integrals for k +
    // K and k − K.
    let both = |k: Complex<f64>, of: &dyn Fn(Complex<f64>) -> Complex<f64>| (of(k + free) + of(k - free)) * 0.5;
    let shape = |k| paddle.shape_integral(k, d);
    let foot = paddle.hinge_above_bed(d);
    let slope = |k: Complex<f64>| ((k * d).cosh() - (k * foot).cosh()) * paddle.inverse_arm() / k;
    let moved: Complex<f64> = modes
        .iter()
        .map(|m| m.b / (m.k * d).cosh() * (m.k * m.k * both(m.k, &shape) + m.k * both(m.k, &slope)))
        .sum::<Complex<f64>>()
        * (0.5 * amplitude);
    let level = |k: Complex<f64>| (k * d).sinh() / k;
    let mut bound = Complex::from(0.0);
    for (i, one) in modes.iter().enumerate() {
        for (j, other) in modes[i..].iter().enumerate() {
            let k = one.k + other.k;
            let part = -Complex::<f64>::i() * k * one.bound(other, train) * both(k, &level) / (k * d).cosh();
            bound += if j == 0 { part } else { part * 2.0 };
        }
    }
    (bound - moved) / (Complex::<f64>::i() * (2.0 * omega) * shape(free))
}

/// A mode of the first-order potential.
struct Mode {
    k: Complex<f64>,
    b: Complex<f64>,
}

impl Mode {
    /// Returns B of the product of two modes:
    /// iω b b′ (k k′ + (k² + k′²)/4 − 3ω⁴/2g²)/(g(k + k′) tanh (k + k′)d − 4ω²).
    fn bound(&self, other: &Self, train: &LinearWave) -> Complex<f64> {
        let (k, l, omega, g) = (self.k, other.k, train.omega, train.g);
        let forcing = k * l + (k * k + l * l) * 0.25 - 1.5 * omega.powi(4) / (g * g);
        let sum = k + l;
        let answer = sum * (sum * train.depth).tanh() * g - 4.0 * omega * omega;
        Complex::<f64>::i() * omega * self.b * other.b * forcing / answer
    }
}
