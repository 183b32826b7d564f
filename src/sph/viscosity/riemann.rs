//! Dissipation of a limited Riemann solver:  dv_a/dt = −Σ m_b (q_ab/ρ₀) ∇_a W,  q_ab = min(η (u² − β² g h), c₀²) for particles that
//! approach with u = −v_ab·r_ab/|r_ab| > β √(g h), else 0.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::sph::{FluidProperties, Num, Pair, Term};

/// The dissipation of the low-dissipation Riemann solver, limiter η @zhang2017: quadratic in the approach, so that it stops
/// impacts. The source goes on with the linear c₀ u from u = c₀/η on; here q stays quadratic up to the c₀² that the source reaches
/// at u = c₀, which needs no root.
///
/// The threshold is ours. In a wave of amplitude a and wave number k, particles at the distance r approach with up to k a √(g k) r. At
/// r = h, with k a = 0.25 and a length of 30 h, that is 0.11 √(g h); with a length of 10 h and k a = 0.44, where waves break, it is
/// 0.35 √(g h). Therefore waves hardly pass β = 0.3, while impacts, at some metres a second, do.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Riemann {
    /// η, –.
    pub eta: f64,
    /// β, –: particles that approach more slowly than β √(g h) are not damped. Without a value 0; in a scene 0.3 where a paddle or a
    /// face has a `wave`, else 0.
    pub threshold: Option<f64>,
}

impl Default for Riemann {
    /// η = 3, that of the source, without a threshold.
    fn default() -> Self {
        Self { eta: 3.0, threshold: None }
    }
}

impl Riemann {
    /// Default threshold (–) of scenes that generate waves. In other scenes there is none: still water, which the default h disturbs,
    /// comes to rest by this dissipation.
    pub const WAVES_THRESHOLD: f64 = 0.3;

    fn threshold(&self) -> f64 {
        self.threshold.unwrap_or(0.0)
    }

    /// The kinematic viscosity ν (m²/s) of a flow with the shear rate γ = `shear` (1/s), for the smoothing length `h` (m) and the
    /// acceleration of gravity `g` (m/s²): without a threshold 0.0295 η γ h² in 2-D, 0.0243 η γ h² in 3-D. Half of the pairs
    /// approach, with u = γ r |n_x n_y|. The stress over ρ is ½ η γ² ⟨|n_x n_y|³⟩/2 (D + 2) ⟨r²⟩ in `dimension` D. Here
    /// ⟨|n_x n_y|³⟩ is 1/(6π) in 2-D and 0.0243 in 3-D; ⟨r²⟩ of the Wendland kernel is 5/9 h² in 2-D and 4/5 h² in 3-D.
    ///
    /// With s = β √(g h)/(γ h), the threshold leaves the share exp(−(s/0.41)²) in 2-D and exp(−(s/0.385)²) in 3-D of this, a fit of the
    /// integral to 0.04, and nothing from s = 1 on, where no pair is fast enough.
    pub fn effective(&self, h: f64, g: f64, dimension: usize, shear: f64) -> f64 {
        let (constant, width) = if dimension == 3 { (0.0243, 0.385) } else { (0.0295, 0.41) };
        let slow = self.threshold() * (g / h).sqrt() / shear;
        if slow < 1.0 { self.eta * constant * shear * h * h * (-(slow / width).powi(2)).exp() } else { 0.0 }
    }

    /// The law in water of the given constants; `share` (–) of it acts.
    pub fn term<const D: usize>(&self, properties: &FluidProperties<D>, share: f64) -> RiemannTerm {
        let eta = self.eta * share;
        RiemannTerm {
            eta,
            spared: eta * self.threshold() * self.threshold() * properties.gravity.norm() * properties.h,
            most: share * properties.c0 * properties.c0,
        }
    }
}

/// The law of [`Riemann`].
#[derive(Clone, Copy, Debug)]
pub struct RiemannTerm {
    eta: f64,
    /// η β² g h, m²/s².
    spared: f64,
    /// c₀², m²/s².
    most: f64,
}

impl<const D: usize> Term<D> for RiemannTerm {
    #[inline(always)]
    fn along_r<N: Num>(&self, ab: &Pair<N, D>, sum: N) -> N {
        // u = −v_ab·r_ab/|r_ab|, so that u² = (v_ab·r_ab)²/r².
        let approach = ab.velocity_along_r.min(ab.constant(0.0));
        let mut q = approach * approach * ab.inv_r2 * ab.constant(self.eta);
        // A law without a threshold takes no operation more.
        if self.spared > 0.0 {
            q = (q - ab.constant(self.spared)).max(ab.constant(0.0));
        }
        sum - q.min(ab.constant(self.most))
    }
}
