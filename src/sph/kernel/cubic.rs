//! Cubic spline:  W = α_D {1 − 3/2 q² + 3/4 q³ (q ≤ 1); 1/4 (2 − q)³ (q ≤ 2); 0},  q = r/h,
//! α_D = 10/(7πh²) in 2-D, 1/(πh³) in 3-D.
//!
//! Both branches are one: W = α_D (2u³ − t³) with u = max(1 − q/2, 0) and t = max(1 − q, 0).

use std::f64::consts::PI;

use super::{Kernel, Num};

/// The cubic spline @monaghan1985; eq. (3) of @pirkhalili2023.
#[derive(Clone, Copy, Debug)]
pub struct Cubic {
    half_inv_h: f64,
    amplitude: f64,
    slope: f64,
}

impl Cubic {
    /// The kernel of smoothing length `h` (m) in `dimension` 2 or 3.
    pub fn new(h: f64, dimension: usize) -> Self {
        let amplitude = if dimension == 2 { 10.0 / (7.0 * PI * h * h) } else { 1.0 / (PI * h * h * h) };
        // dW/dq = −3 α (u² − t²), so (dW/dr)/r = −3/2 α (u² − t²)/(q/2)/h².
        Self { half_inv_h: 0.5 / h, amplitude, slope: -1.5 * amplitude / (h * h) }
    }

    /// q/2, u and t; q/2 above zero, so that it can divide.
    #[inline(always)]
    fn rests<N: Num>(&self, r2: N) -> (N, N, N) {
        let half = (r2.sqrt() * r2.constant(self.half_inv_h)).max(r2.constant(1e-6));
        let u = (r2.constant(1.0) - half).max(r2.constant(0.0));
        let t = half.fma(r2.constant(-2.0), r2.constant(1.0)).max(r2.constant(0.0));
        (half, u, t)
    }
}

impl Kernel for Cubic {
    fn times_volume(self, volume: f64) -> Self {
        Self { amplitude: self.amplitude * volume, slope: self.slope * volume, ..self }
    }

    #[inline(always)]
    fn w<N: Num>(&self, r2: N) -> N {
        let (_, u, t) = self.rests(r2);
        r2.constant(self.amplitude) * (r2.constant(2.0) * u * (u * u) - t * (t * t))
    }

    #[inline(always)]
    fn slope<N: Num>(&self, r2: N) -> N {
        let (half, u, t) = self.rests(r2);
        r2.constant(self.slope) * u.fma(u, -(t * t)) / half
    }
}
