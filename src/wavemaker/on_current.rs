//! Regular waves on a uniform current by linear theory.
//!
//! In the frame of the current U the wave has the relative frequency σ = ω − k U with σ² = g k tanh kd @dean1991. With the
//! phase θ = ω t − k s, s along the current, and ζ = z + d above the bed,
//!
//!   η = a cos θ,   u = a σ cosh kζ/sinh kd cos θ,   w = −a σ sinh kζ/sinh kd sin θ,   p = ρ a σ²/k cosh kζ/sinh kd cos θ.

use crate::error::{Error, Result};

/// Iterations of Newton's method, which doubles the digits each time.
const ITERATIONS: usize = 60;

/// A regular wave on a current.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WaveOnCurrent {
    /// a, m.
    amplitude: f64,
    /// ω, rad/s.
    omega: f64,
    /// k, 1/m.
    k: f64,
    /// σ, rad/s.
    sigma: f64,
    /// d, m.
    depth: f64,
    /// Time in which the wave rises to its height, s.
    ramp: f64,
}

/// The motion of the water in a wave at one place and time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct OrbitalMotion {
    /// Velocity along the direction of the wave, m/s.
    pub(crate) along: f64,
    /// Velocity upwards, m/s.
    pub(crate) up: f64,
    /// Displacement upwards, m.
    pub(crate) rise: f64,
    /// p/ρ, m²/s².
    pub(crate) pressure: f64,
}

impl WaveOnCurrent {
    /// The wave of this height (m) and period (s) on water of this depth (m) that flows with `current` (m/s) in the direction of
    /// the wave, under gravity `g` (m/s²).
    ///
    /// # Errors
    /// `Scene` if an opposing current stops the wave.
    pub(crate) fn new(height: f64, period: f64, (depth, current, g): (f64, f64, f64), ramp: f64) -> Result<Self> {
        let omega = std::f64::consts::TAU / period;
        match relative_wave_number(omega, depth, current, g) {
            Some(k) => Ok(Self { amplitude: 0.5 * height, omega, k, sigma: omega - k * current, depth, ramp }),
            None => {
                // In deep water a wave is stopped by a current of a quarter of its speed without current.
                let least = period * current.abs() * 8.0 * std::f64::consts::PI / (g * period);
                Err(Error::scene(format!(
                    "a wave of {period} s cannot travel against a current of {:.3} m/s",
                    -current
                ))
                .help(format!("write  period = {:.2}  or more, or a slower current", 1.05 * least)))
            }
        }
    }

    /// Phase speed relative to the current, σ/k, m/s.
    pub(crate) fn relative_speed(&self) -> f64 {
        self.sigma / self.k
    }

    /// The motion at the distance `s` (m) along the wave, `height` (m) above the bed and time `t` (s).
    pub(crate) fn motion(&self, s: f64, height: f64, t: f64) -> OrbitalMotion {
        let Self { amplitude, omega, k, sigma, depth, ramp } = *self;
        let share = if t < ramp { (0.5 * std::f64::consts::PI * t / ramp).sin().powi(2) } else { 1.0 };
        let (sin, cos) = (omega * t - k * s).sin_cos();
        let depth_factor = amplitude * share / (k * depth).sinh();
        let (sinh, cosh) = ((k * height).sinh(), (k * height).cosh());
        OrbitalMotion {
            along: depth_factor * sigma * cosh * cos,
            up: -depth_factor * sigma * sinh * sin,
            rise: depth_factor * sinh * cos,
            pressure: depth_factor * sigma * sigma / k * cosh * cos,
        }
    }
}

/// Returns the wave number k (1/m) of a wave of angular frequency `omega` (rad/s) on water of depth `depth` (m) with a `current` (m/s) in
/// its direction: the smallest solution of ω = k U + √(g k tanh kd), or `None` if an opposing current is too fast.
pub(crate) fn relative_wave_number(omega: f64, depth: f64, current: f64, g: f64) -> Option<f64> {
    let frequency = |k: f64| {
        let tanh = (k * depth).tanh();
        let sigma = (g * k * tanh).sqrt();
        let group = 0.5 * g * (tanh + k * depth * (1.0 - tanh * tanh)) / sigma;
        (k * current + sigma, current + group)
    };
    // Below the solution the frequency is too low, and its slope falls with k: Newton's method from below never overshoots.
    let mut k = omega / (current.max(0.0) + (g * depth).sqrt());
    for _ in 0..ITERATIONS {
        let (now, slope) = frequency(k);
        if slope.is_nan() || slope <= 0.0 {
            return None;
        }
        k += (omega - now) / slope;
    }
    let (now, slope) = frequency(k);
    (slope > 0.0 && (now - omega).abs() < 1e-9 * omega).then_some(k)
}

#[cfg(test)]
#[path = "../../tests/unit/wavemaker/on_current.rs"]
mod tests;
