//! Settling walls: a boundary particle obeys continuity as a dynamic one does, and its density settles to that of the
//! pressure that the water near it would have at its place:
//!
//!   P_w = [Σ_f V_f P_f W_wf + (g − a_w)·Σ_f m_f r_wf W_wf] / Σ_f V_f W_wf,   r_wf = r_w − r_f,  never below 0,
//!   dρ_w/dt = continuity + (ρ(P_w) − ρ_w)/τ,   τ = 10 h/c₀.
//!
//! Water that strikes it meets the dynamic wall; water at rest, or carried along, presses on it as on more water, and no gap
//! is remembered.

use crate::{law::Num, space::Vector};

/// τ over h/c₀, –: at 40 a gap of 0.05 to 0.07 dp stays, at 0 water strays into the faces.
const TIME: f64 = 10.0;

/// The part of the way (–) to its goal that a boundary particle goes in `dt` (s), with h (m) and c₀ (m/s).
pub fn settled(dt: f64, h: f64, c0: f64) -> f64 {
    1.0 - (-dt * c0 / (TIME * h)).exp()
}

/// The sums of a boundary particle over the water near it [@adami2012].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit<N, const D: usize> {
    /// Σ V_f W_wf, –.
    pub weight: N,
    /// Σ V_f W_wf P_f/ρ₀, m²/s².
    pub head: N,
    /// Σ V₀ W_wf r_wf, m.
    pub arm: [N; D],
    /// Σ V_f W_wf v_f, m/s; summed where the wall's [`Slip`](super::Slip) asks for it.
    pub flow: [N; D],
}

impl<N: Num, const D: usize> Fit<N, D> {
    /// All sums `zero`.
    #[inline(always)]
    pub fn all(zero: N) -> Self {
        Self { weight: zero, head: zero, arm: [zero; D], flow: [zero; D] }
    }

    /// Adds a water particle of pressure `p` (P/ρ₀, m²/s²) and specific volume `s` (ρ₀/ρ) at r_w − `r_wf` (m), seen with
    /// kernel weight `w` (V₀ W).
    #[inline(always)]
    pub fn add(&mut self, w: N, p: N, s: N, r_wf: [N; D]) {
        let share = w * s;
        self.weight = self.weight + share;
        self.head = share.fma(p, self.head);
        for (arm, r) in self.arm.iter_mut().zip(r_wf) {
            *arm = w.fma(r, *arm);
        }
    }

    /// Adds its velocity `v` (m/s) too.
    #[inline(always)]
    pub fn add_flow(&mut self, w: N, s: N, v: [N; D]) {
        let share = w * s;
        for (flow, v) in self.flow.iter_mut().zip(v) {
            *flow = share.fma(v, *flow);
        }
    }
}

impl<const D: usize> Fit<f64, D> {
    /// The pressure P_w/ρ₀ (m²/s²) of a boundary particle that feels `pull` = g − a_w (m/s²).
    pub fn close(&self, pull: &Vector<D>) -> f64 {
        // At the rim of the support the weight is the square of a rounding: no water.
        if self.weight < 1e-9 {
            return 0.0;
        }
        ((self.head + pull.dot(&Vector::from(self.arm))) / self.weight).max(0.0)
    }
}
