//! Dynamic boundary particles: they obey continuity as water does, but not momentum, and their density is
//! limited from below by ρ₀, or by the target of a relaxed wall, so that a wall exerts no suction.

/// Dynamic boundary condition @crespo2007.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DynamicBoundary;

impl DynamicBoundary {
    /// The density `rho` (kg/m³) of a boundary particle, limited from below by `least`, the density of a face without load.
    #[inline(always)]
    pub(crate) fn limited_density(&self, rho: f64, least: f64) -> f64 {
        rho.max(least)
    }
}
