//! The level of the water above a place: the greatest height at which Σ V_b W, the share of the kernel's
//! weight that water fills, falls through ½. On a flat surface that is the surface itself.

use super::{Probe, point};
use crate::{error::Result, simulation::Simulation, space::Vector, system::System};

/// Watches the water's level (m) at a horizontal place, and its change η (m) since the probe was made;
/// NaN where there is no water. Spray lighter than half a kernel does not count.
pub struct Elevation<const D: usize> {
    at: Vector<D>,
    start: f64,
}

impl<const D: usize> Elevation<D> {
    /// The gauge above `at` (m; D − 1 horizontal coordinates); the level now counts as η = 0, and so does
    /// a dry place's NaN: η then stays empty.
    ///
    /// # Errors
    /// `Usage` if the count of coordinates is another or one is not finite.
    pub fn new(system: &System<D>, at: &[f64]) -> Result<Self> {
        let at = point(at, D - 1)?;
        Ok(Self { start: level(system, &at), at })
    }
}

impl<const D: usize> Probe<D> for Elevation<D> {
    fn columns(&self) -> Vec<String> {
        vec!["level_m".into(), "eta_m".into()]
    }

    fn look(&self, sim: &Simulation<D>) -> Vec<f64> {
        let now = level(sim.system(), &self.at);
        vec![now, now - self.start]
    }
}

/// Height (m) of the free surface above the horizontal place `at`, to a thousandth of the spacing.
fn level<const D: usize>(system: &System<D>, at: &Vector<D>) -> f64 {
    let (dp, h, up) = (system.model().dp, system.model().h, D - 1);
    let beside = |r: &Vector<D>| (0..up).map(|i| (r[i] - at[i]).powi(2)).sum::<f64>() < (2.0 * h).powi(2);
    let heights = system.fluid().r.iter().filter(|r| beside(r)).map(|r| r[up]);
    let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), z| (l.min(z), h.max(z)));
    let filled = |z: f64| {
        let mut x = *at;
        x[up] = z;
        let mut sum = 0.0;
        system.water_near(&x, &mut |b, _, w| sum += system.particle_mass() / system.fluid().rho[b] * w);
        sum
    };
    fall(filled, low, high + 2.0 * h, 0.5 * dp, 1e-3 * dp).unwrap_or(f64::NAN)
}

/// The greatest height between `low` and `high` at which `filled` falls through ½, found by steps of
/// `step` downwards and bisection to `tolerance`; `None` if it stays below.
fn fall(filled: impl Fn(f64) -> f64, low: f64, high: f64, step: f64, tolerance: f64) -> Option<f64> {
    let (mut wet, mut dry) = (high, high);
    while filled(wet) < 0.5 {
        (dry, wet) = (wet, wet - step);
        if wet.is_nan() || wet < low {
            return None;
        }
    }
    while dry - wet > tolerance {
        let middle = 0.5 * (wet + dry);
        if filled(middle) < 0.5 { dry = middle } else { wet = middle }
    }
    Some(0.5 * (wet + dry))
}

#[cfg(test)]
mod tests {
    use super::fall;

    #[test]
    fn the_level_is_the_highest_fall_through_a_half() {
        let two_layers = |z: f64| if (0.1..0.2).contains(&z) || z < 0.05 { 1.0 } else { 0.1 };
        let found = fall(two_layers, 0.0, 0.4, 0.01, 1e-5).unwrap_or(f64::NAN);
        assert!((found - 0.2).abs() <= 1e-5, "within the tolerance asked for; got {found}");
        assert_eq!(fall(|_| 0.4, 0.0, 1.0, 0.01, 1e-5), None);
        assert_eq!(fall(|_| 0.0, f64::INFINITY, f64::NEG_INFINITY, 0.01, 1e-5), None);
    }
}
