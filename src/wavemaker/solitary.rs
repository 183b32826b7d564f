//! The solitary wave: η = H sech² κ(ct − x), which a piston makes that goes with the water at its face.
//!
//!   X′ = c η/(d + η) at the piston's own place, so that with θ = κ(ct − X) the motion is known in closed form but for t:
//!   X = (H/κd)(tanh θ − tanh θ₀),   κct = θ − θ₀ + (H/d)(tanh θ − tanh θ₀)
//!
//! c = √(g(d + H)). Boussinesq: κ² = 3H/4d³ @goring1978; Rayleigh: κ² = 3H/4d²(d + H), whose wave keeps its height
//! better @guizien2002.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// −θ₀: the motion starts where the surface at the piston is H sech² 5, 2e-4 of the height.
const START: f64 = 5.0;

/// Whose wave it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum SolitaryTheory {
    /// Boussinesq's.
    Boussinesq,
    /// Rayleigh's.
    #[default]
    Rayleigh,
}

/// A solitary wave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SolitaryWave {
    /// H, m.
    pub height: f64,
    /// d, m.
    pub depth: f64,
    /// c, m/s.
    pub celerity: f64,
    /// κ, 1/m.
    pub kappa: f64,
}

impl SolitaryWave {
    /// The wave of `height` (m) in water `depth` (m) deep.
    pub(crate) fn new(height: f64, depth: f64, g: f64, theory: SolitaryTheory) -> Self {
        let total = match theory {
            SolitaryTheory::Boussinesq => depth,
            SolitaryTheory::Rayleigh => depth + height,
        };
        let kappa = (0.75 * height / total).sqrt() / depth;
        Self { height, depth, celerity: (g * (depth + height)).sqrt(), kappa }
    }

    /// How far (m) the piston goes: 2H/κd.
    pub(crate) fn stroke(&self) -> f64 {
        2.0 * self.height / (self.kappa * self.depth)
    }

    /// How long (s) it is on its way, to 2e-4 of its speed.
    pub(crate) fn duration(&self) -> f64 {
        2.0 * (START + self.height / self.depth) / (self.kappa * self.celerity)
    }

    /// The time (s) over which it is let in: its speed is then 2 % of the largest.
    pub(super) fn ramp_time(&self) -> f64 {
        0.5 * START / (self.kappa * self.celerity)
    }

    /// Length (m) between the points at which it is a hundredth of its height.
    pub(crate) fn length(&self) -> f64 {
        2.0 * 10f64.acosh() / self.kappa
    }

    /// When (s) the crest is at `x` (m) before the piston's place at the start.
    pub(crate) fn crest_time(&self, x: f64) -> f64 {
        let (d, tanh) = (self.depth, START.tanh());
        // θ = 0 at the piston's middle place, which the crest leaves at this time.
        let time = (START + self.height / d * tanh) / (self.kappa * self.celerity);
        time + (x - self.height / (self.kappa * d) * tanh) / self.celerity
    }

    /// The piston's displacement (m) and speed (m/s) at time `t` (s).
    pub(super) fn displacement(&self, t: f64) -> (f64, f64) {
        let steep = self.height / self.depth;
        let (low, wanted) = (-START - steep * START.tanh(), self.kappa * self.celerity * t);
        // θ + (H/d) tanh θ = wanted + low: rises at 1 to 1 + H/d, so that Newton from beyond the bend goes straight there.
        let sought = wanted + low;
        let mut theta = sought / (1.0 + steep);
        for _ in 0..50 {
            let tanh = theta.tanh();
            let next = theta - (theta + steep * tanh - sought) / (1.0 + steep * (1.0 - tanh * tanh));
            if (next - theta).abs() < 1e-15 * (1.0 + theta.abs()) {
                break;
            }
            theta = next;
        }
        let surface = self.height / theta.cosh().powi(2);
        let x = self.height / (self.kappa * self.depth) * (theta.tanh() + START.tanh());
        (x, self.celerity * surface / (self.depth + surface))
    }
}
