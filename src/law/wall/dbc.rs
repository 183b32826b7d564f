//! Dynamic boundary particles: they obey continuity as water does, but not momentum, and their density is
//! kept at ρ₀ or above, so that a wall never sucks.

/// Dynamic boundary condition [@crespo2007].
#[derive(Clone, Copy, Debug)]
pub struct Dbc;

impl Dbc {
    /// The density (kg/m³) that a boundary particle of density `rho` shows.
    #[inline(always)]
    pub fn close(&self, rho: f64, rho0: f64) -> f64 {
        rho.max(rho0)
    }
}
