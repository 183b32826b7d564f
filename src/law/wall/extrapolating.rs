//! Extrapolating walls: a boundary particle shows the pressure that the water near it would have at its place,
//! with the gradient of water that moves with the wall.
//!
//!   P_w = [Σ_f V_f P_f W_wf + (g − a_w)·Σ_f m_f r_wf W_wf] / Σ_f V_f W_wf + ρ₀ min(β u, c₀) u,  never below 0,
//!
//! with r_wf = r_w − r_f and u ≥ 0 the speed at which the water comes towards the wall. So water at rest, and water that is
//! carried along, presses on the wall as on more water: nothing is left between. Water that strikes it meets the pressure
//! of the wall's Riemann problem, limited where the flow is slow.

use crate::{law::Num, space::Vector};

/// Limiter β of [@zhang2017], –.
const BETA: f64 = 3.0;

/// The sums of a boundary particle over the water near it [@adami2012].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit<N, const D: usize> {
    /// Σ V_f W_wf, –.
    pub weight: N,
    /// Σ V_f W_wf P_f/ρ₀, m²/s².
    pub head: N,
    /// Σ V₀ W_wf r_wf, m.
    pub arm: [N; D],
    /// Σ V_f W_wf v_f, m/s.
    pub flow: [N; D],
}

impl<N: Num, const D: usize> Fit<N, D> {
    /// All sums `zero`.
    #[inline(always)]
    pub fn all(zero: N) -> Self {
        Self { weight: zero, head: zero, arm: [zero; D], flow: [zero; D] }
    }

    /// Adds a water particle of pressure `p` (P/ρ₀, m²/s²), specific volume `s` (ρ₀/ρ) and velocity `v` (m/s) at
    /// r_w − `r_wf` (m), seen with kernel weight `w` (V₀ W).
    #[inline(always)]
    pub fn add(&mut self, w: N, p: N, s: N, v: [N; D], r_wf: [N; D]) {
        let share = w * s;
        self.weight = self.weight + share;
        self.head = share.fma(p, self.head);
        for (arm, r) in self.arm.iter_mut().zip(r_wf) {
            *arm = w.fma(r, *arm);
        }
        for (flow, v) in self.flow.iter_mut().zip(v) {
            *flow = share.fma(v, *flow);
        }
    }
}

/// A boundary particle as its own pressure needs it.
pub struct Place<const D: usize> {
    /// g − a_w, m/s².
    pub pull: Vector<D>,
    /// Its velocity, m/s.
    pub v: Vector<D>,
    /// Unit vector out of the solid.
    pub normal: Vector<D>,
}

impl<const D: usize> Fit<f64, D> {
    /// The pressure P/ρ₀ (m²/s²) of a boundary particle at `place` in water of sound speed `c0` (m/s).
    pub fn close(&self, place: &Place<D>, c0: f64) -> f64 {
        // At the rim of the support the weight is the square of a rounding: no water.
        if self.weight < 1e-9 {
            return 0.0;
        }
        let still = (self.head + place.pull.dot(&Vector::from(self.arm))) / self.weight;
        let u = (place.v - Vector::from(self.flow) / self.weight).dot(&place.normal).max(0.0);
        (still + (BETA * u).min(c0) * u).max(0.0)
    }
}
