//! Wendland C2:  W = α_D (1 − q/2)⁴ (2q + 1),  q = r/h,  α_D = 7/(4πh²) in 2-D, 21/(16πh³) in 3-D.

use std::f64::consts::PI;

use super::{Kernel, Num};

/// Wendland's C2 kernel @wendland1995: particles do not pair under it at any h.
#[derive(Clone, Copy, Debug)]
pub struct Wendland {
    half_inv_h: f64,
    amplitude: f64,
    slope: f64,
}

impl Wendland {
    /// The kernel of smoothing length `h` (m) in `dimension` 2 or 3.
    pub fn new(h: f64, dimension: usize) -> Self {
        let amplitude = if dimension == 2 { 7.0 / (4.0 * PI * h * h) } else { 21.0 / (16.0 * PI * h * h * h) };
        // dW/dq = −5 α q (1 − q/2)³, so (dW/dr)/r = −5 α (1 − q/2)³/h².
        Self { half_inv_h: 0.5 / h, amplitude, slope: -5.0 * amplitude / (h * h) }
    }

    /// max(1 − q/2, 0).
    #[inline(always)]
    fn rest<N: Num>(&self, r2: N) -> N {
        r2.sqrt().fma(r2.constant(-self.half_inv_h), r2.constant(1.0)).max(r2.constant(0.0))
    }
}

impl Kernel for Wendland {
    fn times_volume(self, volume: f64) -> Self {
        Self { amplitude: self.amplitude * volume, slope: self.slope * volume, ..self }
    }

    #[inline(always)]
    fn w<N: Num>(&self, r2: N) -> N {
        let t = self.rest(r2);
        let t2 = t * t;
        // 2q + 1 = 5 − 4t inside the support.
        r2.constant(self.amplitude) * (t2 * t2) * t.fma(r2.constant(-4.0), r2.constant(5.0))
    }

    #[inline(always)]
    fn slope<N: Num>(&self, r2: N) -> N {
        let t = self.rest(r2);
        r2.constant(self.slope) * (t * t) * t
    }
}
