//! Dynamic boundary particles: they obey continuity as water does, but not momentum, and their density is
//! kept from falling below a least one, ρ₀ unless the wall settles, so that a wall never sucks.

/// Dynamic boundary condition @crespo2007.
#[derive(Clone, Copy, Debug)]
pub struct DynamicBoundary;

impl DynamicBoundary {
    /// The density (kg/m³) that a boundary particle of density `rho` shows, `least` being that at which its face bears nothing.
    #[inline(always)]
    pub fn limited_density(&self, rho: f64, least: f64) -> f64 {
        rho.max(least)
    }
}
