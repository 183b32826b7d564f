//! Viscosities, with one in each file. The rest of the program uses them through this module only: their terms in the pair loop,
//! the time steps that they allow, their stress and their damping. A new viscosity needs its file and its lines in this one.

mod artificial;
mod laminar;
mod riemann;
mod sps;

pub use artificial::Artificial;
pub use laminar::{Laminar, LaminarTerm};
pub use riemann::{Riemann, RiemannTerm};
pub use sps::{Sps, SpsTerm};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{FluidProperties, Term, Units};
pub use artificial::ArtificialTerm;

/// The viscosity. Scene key `model.viscosity`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Viscosity {
    /// None: the ideal fluid.
    None,
    /// Artificial viscosity (Monaghan 1992).
    Artificial(Artificial),
    /// Dissipation of a limited Riemann solver (Zhang, Hu & Adams 2017).
    Riemann(Riemann),
    /// Laminar viscosity (Lo & Shao 2002; Morris 1997).
    Laminar(Laminar),
    /// Laminar viscosity with sub-particle-scale turbulence (Dalrymple & Rogers 2006).
    Sps(Sps),
}

/// Continues with the terms of a viscosity: `fluid` between water particles, `wall` between water and solids.
pub(crate) trait TermConsumer<const D: usize> {
    /// The result.
    type Output;
    /// Continues.
    fn with_terms<T: Term<D> + 'static, W: Term<D> + 'static>(self, fluid: T, wall: W) -> Self::Output;
}

impl Viscosity {
    /// Calls `next` with the terms in the given units. `wall_share` (–) is the part of the viscosity that acts between water and
    /// solids. `viscous_sum` (–) is the factor by which η² reduces a viscous force on the lattice.
    pub(crate) fn terms<const D: usize, N: TermConsumer<D>>(
        self,
        properties: &FluidProperties<D>,
        units: &Units,
        wall_share: f64,
        viscous_sum: impl Fn() -> f64,
        next: N,
    ) -> N::Output {
        match self {
            // Without viscosity α is 0, which adds an exact 0 and needs no pair loop of its own.
            Self::None => {
                Self::Artificial(Artificial { alpha: 0.0 }).terms(properties, units, wall_share, viscous_sum, next)
            }
            Self::Artificial(law) => {
                let wall = Artificial { alpha: law.alpha * wall_share };
                next.with_terms(law.term(properties), wall.term(properties))
            }
            Self::Riemann(law) => next.with_terms(law.term(properties, 1.0), law.term(properties, wall_share)),
            Self::Laminar(law) => {
                let wall = Laminar { nu0: law.nu0 * wall_share };
                next.with_terms(law.term(units, viscous_sum()), wall.term(units, viscous_sum()))
            }
            Self::Sps(law) => {
                let wall = Sps { nu0: law.nu0 * wall_share, ..law };
                next.with_terms(law.terms(units, viscous_sum()), wall.terms(units, viscous_sum()))
            }
        }
    }

    /// The longest stable step (s) at smoothing length `h` (m), h²/(8 ν₀); infinite without a kinematic viscosity @morris1997.
    pub fn step_limit(&self, h: f64) -> f64 {
        let nu0 = match self {
            Self::Laminar(law) => law.nu0,
            Self::Sps(law) => law.nu0,
            Self::None | Self::Artificial(_) | Self::Riemann(_) => 0.0,
        };
        h * h / (8.0 * nu0)
    }

    /// The effective kinematic viscosity ν (m²/s) of a flow with the shear rate `shear` (1/s), in water with speed of sound `c0`
    /// (m/s), smoothing length `h` (m) and the acceleration of gravity `g` (m/s²), in `dimension` D. It is ν₀ of a laminar
    /// viscosity, α c₀ h/(4 (D + 2)) of the artificial viscosity, which acts on approaching pairs only @monaghan2005, and
    /// [`Riemann::effective`] of the Riemann dissipation. It excludes the eddy viscosity of SPS.
    pub fn effective(&self, c0: f64, h: f64, g: f64, dimension: usize, shear: f64) -> f64 {
        match self {
            Self::None => 0.0,
            Self::Riemann(law) => law.effective(h, g, dimension, shear),
            Self::Artificial(law) => law.alpha * c0 * h / (4.0 * (dimension as f64 + 2.0)),
            Self::Laminar(law) => law.nu0,
            Self::Sps(law) => law.nu0,
        }
    }

    /// Whether it hardly damps waves: laminar viscosities, and the Riemann dissipation with the threshold of waves.
    pub(crate) fn spares_waves(&self) -> bool {
        match self {
            Self::Riemann(law) => law.threshold >= Some(Riemann::WAVES_THRESHOLD),
            Self::Artificial(_) => false,
            Self::None | Self::Laminar(_) | Self::Sps(_) => true,
        }
    }

    /// The stress law, if the viscosity keeps a stress tensor for each particle.
    pub(crate) fn stress(&self) -> Option<Sps> {
        if let Self::Sps(law) = self { Some(*law) } else { None }
    }

    /// λ h/c₀ (–), where λ is the rate (1/s) at which the viscosity damps the shortest waves: 3.5 α.
    pub(crate) fn damping(&self) -> f64 {
        if let Self::Artificial(law) = self { 3.5 * law.alpha } else { 0.0 }
    }
}
