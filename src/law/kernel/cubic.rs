//! Cubic spline:  W = α_D {1 − 3/2 q² + 3/4 q³ (q ≤ 1); 1/4 (2 − q)³ (q ≤ 2); 0},  q = r/h,
//! α_D = 10/(7πh²) in 2-D, 1/(πh³) in 3-D.

use std::f64::consts::PI;

use super::{Kernel, Num};

/// The cubic spline [@monaghan1985]; eq. (3) of [@pirkhalili2023].
#[derive(Clone, Copy, Debug)]
pub struct Cubic {
    inv_h: f64,
    amplitude: f64,
    slope: f64,
}

impl Cubic {
    /// The kernel of smoothing length `h` (m) in `dimension` 2 or 3.
    pub fn new(h: f64, dimension: usize) -> Self {
        let amplitude = if dimension == 2 { 10.0 / (7.0 * PI * h * h) } else { 1.0 / (PI * h * h * h) };
        Self { inv_h: 1.0 / h, amplitude, slope: amplitude / (h * h) }
    }
}

impl Kernel for Cubic {
    fn weighed(self, volume: f64) -> Self {
        Self { amplitude: self.amplitude * volume, slope: self.slope * volume, ..self }
    }

    #[inline(always)]
    fn w<N: Num>(&self, r2: N) -> N {
        let q = r2.sqrt() * r2.of(self.inv_h);
        let rest = (r2.of(2.0) - q).max(r2.of(0.0));
        let inner = r2.of(1.0) - q * q * (r2.of(1.5) - r2.of(0.75) * q);
        let outer = r2.of(0.25) * rest * rest * rest;
        r2.of(self.amplitude) * q.if_below(r2.of(1.0), inner, outer)
    }

    #[inline(always)]
    fn slope<N: Num>(&self, r2: N) -> N {
        let q = r2.sqrt() * r2.of(self.inv_h);
        let rest = (r2.of(2.0) - q).max(r2.of(0.0));
        let inner = r2.of(2.25) * q - r2.of(3.0);
        let outer = r2.of(-0.75) * rest * rest / q;
        r2.of(self.slope) * q.if_below(r2.of(1.0), inner, outer)
    }
}
