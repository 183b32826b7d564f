//! The solitary wave η = H sech² κ(ct − x), and the motion of the piston that makes it.
//!
//! The piston moves with the water at its face: X′ = c η/(d + η), with η at the piston's current position. With θ =
//! κ(ct − X), the motion has a closed form in terms of θ instead of t:
//!   X = (H/κd)(tanh θ − tanh θ₀),   κct = θ − θ₀ + (H/d)(tanh θ − tanh θ₀)
//!
//! c = √(g(d + H)). Boussinesq: κ² = 3H/4d³ @goring1978. Rayleigh: κ² = 3H/4d²(d + H); this wave keeps its height
//! better @guizien2002.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// −θ₀: at the start of the motion, the elevation at the piston is H sech² 5, about 2e-4 of the height.
const START: f64 = 5.0;

/// Theory of the solitary wave.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum SolitaryTheory {
    /// Boussinesq's theory.
    Boussinesq,
    /// Rayleigh's theory.
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
    /// Returns the solitary wave of `height` (m) in water of depth `depth` (m).
    pub(crate) fn new(height: f64, depth: f64, g: f64, theory: SolitaryTheory) -> Self {
        let total = match theory {
            SolitaryTheory::Boussinesq => depth,
            SolitaryTheory::Rayleigh => depth + height,
        };
        let kappa = (0.75 * height / total).sqrt() / depth;
        Self { height, depth, celerity: (g * (depth + height)).sqrt(), kappa }
    }

    /// Returns the stroke of the piston, m: 2H/κd.
    pub(crate) fn stroke(&self) -> f64 {
        2.0 * self.height / (self.kappa * self.depth)
    }

    /// Returns the duration (s) of the motion; at its ends the speed is 2e-4 of the largest speed.
    pub(crate) fn duration(&self) -> f64 {
        2.0 * (START + self.height / self.depth) / (self.kappa * self.celerity)
    }

    /// Returns the duration (s) of the ramp; at its end the piston's speed is 2 % of the largest speed.
    pub(super) fn ramp_time(&self) -> f64 {
        0.5 * START / (self.kappa * self.celerity)
    }

    /// Returns the distance (m) between the two points where the elevation is a hundredth of the height.
    pub(crate) fn length(&self) -> f64 {
        2.0 * 10f64.acosh() / self.kappa
    }

    /// Returns the time (s) at which the crest is at `x` (m) from the piston's initial position.
    pub(crate) fn crest_time(&self, x: f64) -> f64 {
        let (d, tanh) = (self.depth, START.tanh());
        // θ = 0 when the piston is at the middle of its stroke: the crest leaves the piston at this time.
        let time = (START + self.height / d * tanh) / (self.kappa * self.celerity);
        time + (x - self.height / (self.kappa * d) * tanh) / self.celerity
    }

    /// Returns the piston's displacement (m) and speed (m/s) at time `t` (s).
    pub(super) fn displacement(&self, t: f64) -> (f64, f64) {
        let steep = self.height / self.depth;
        let (low, wanted) = (-START - steep * START.tanh(), self.kappa * self.celerity * t);
        // Newton's method solves θ + (H/d) tanh θ = wanted + low. The slope lies between 1 and 1 + H/d, so the
        // iteration converges directly from a start beyond the bend.
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
