//! The level of the water above a place: a surface is a height at which Σ V_b W, the share of the kernel's
//! weight that water fills, falls through ½. On flat water that is the surface itself.

use super::{Probe, point};
use crate::{error::Result, plan::Surface, simulation::Simulation, space::Vector, system::System};

/// How many surfaces below the highest are told.
const BELOW: usize = 3;

/// Watches the water's level (m) at a horizontal place, and its change η (m) since the probe was made;
/// NaN where there is no water. Spray lighter than half a kernel does not count.
pub struct Elevation<const D: usize> {
    at: Vector<D>,
    surface: Surface,
    start: f64,
}

impl<const D: usize> Elevation<D> {
    /// The gauge above `at` (m; D − 1 horizontal coordinates) that tells the highest surface; the level now counts
    /// as η = 0, and so does a dry place's NaN: η then stays empty.
    ///
    /// # Errors
    /// `Usage` if the count of coordinates is another or one is not finite.
    pub fn new(system: &System<D>, at: &[f64]) -> Result<Self> {
        Self::of(system, at, Surface::Highest)
    }

    /// As [`Elevation::new`], of another surface: the lowest, as under a breaker's jet, or of all the highest and three
    /// below it.
    ///
    /// # Errors
    /// As [`Elevation::new`].
    pub fn of(system: &System<D>, at: &[f64], surface: Surface) -> Result<Self> {
        let mut gauge = Self { at: point(at, D - 1)?, surface, start: f64::NAN };
        gauge.start = gauge.levels(system)[0];
        Ok(gauge)
    }

    /// Heights (m) of the surfaces that are told, the one that counts as the level first.
    fn levels(&self, system: &System<D>) -> Vec<f64> {
        let mut found = surfaces(system, &self.at);
        let all: Vec<f64> = match self.surface {
            Surface::Highest => found.next().into_iter().collect(),
            Surface::Lowest => found.last().into_iter().collect(),
            Surface::All => found.take(1 + BELOW).collect(),
        };
        let count = if self.surface == Surface::All { 1 + BELOW } else { 1 };
        (0..count).map(|i| all.get(i).copied().unwrap_or(f64::NAN)).collect()
    }
}

impl<const D: usize> Probe<D> for Elevation<D> {
    fn columns(&self) -> Vec<String> {
        let below = if self.surface == Surface::All { BELOW } else { 0 };
        let below = (1..=below).map(|i| format!("below_{i}_m"));
        ["level_m", "eta_m"].map(String::from).into_iter().chain(below).collect()
    }

    fn look(&self, sim: &Simulation<D>) -> Vec<f64> {
        let mut row = self.levels(sim.system());
        row.insert(1, row[0] - self.start);
        row
    }
}

/// Heights (m) of the surfaces above the horizontal place `at`, from the highest down, to a thousandth of the spacing.
fn surfaces<const D: usize>(system: &System<D>, at: &Vector<D>) -> impl Iterator<Item = f64> {
    let (dp, h, up) = (system.model().dp, system.model().h, D - 1);
    let beside = |r: &Vector<D>| (0..up).map(|i| (r[i] - at[i]).powi(2)).sum::<f64>() < (2.0 * h).powi(2);
    let heights = system.fluid().r.iter().filter(|r| beside(r)).map(|r| r[up]);
    let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), z| (l.min(z), h.max(z)));
    let filled = move |z: f64| {
        let mut x = *at;
        x[up] = z;
        let mut sum = 0.0;
        system.water_near(&x, &mut |b, _, w| sum += system.particle_mass() / system.fluid().rho[b] * w);
        sum
    };
    falls(filled, low, high + 2.0 * h, 0.5 * dp, 1e-3 * dp)
}

/// The heights between `low` and `high` at which `filled` falls through ½ on the way up, from the highest down: found by
/// steps of `step` downwards and bisection to `tolerance`.
fn falls(filled: impl Fn(f64) -> f64, low: f64, high: f64, step: f64, tolerance: f64) -> impl Iterator<Item = f64> {
    // Where the water of the surface before was met.
    let mut met: Option<f64> = None;
    std::iter::from_fn(move || {
        let mut dry = match met {
            None => high,
            Some(mut z) => {
                while filled(z) >= 0.5 {
                    z -= step;
                }
                z
            }
        };
        let mut wet = dry;
        while filled(wet) < 0.5 {
            (dry, wet) = (wet, wet - step);
            if wet.is_nan() || wet < low {
                return None;
            }
        }
        met = Some(wet);
        while dry - wet > tolerance {
            let middle = 0.5 * (wet + dry);
            if filled(middle) < 0.5 { dry = middle } else { wet = middle }
        }
        Some(0.5 * (wet + dry))
    })
}

#[cfg(test)]
mod tests {
    use super::falls;

    #[test]
    fn surfaces_are_the_falls_through_a_half_from_the_highest_down() {
        let two_layers = |z: f64| if (0.1..0.2).contains(&z) || (0.0..0.05).contains(&z) { 1.0 } else { 0.1 };
        let found: Vec<f64> = falls(two_layers, 0.0, 0.4, 0.01, 1e-5).collect();
        assert_eq!(found.len(), 2);
        for (found, expected) in found.iter().zip([0.2, 0.05]) {
            assert!((found - expected).abs() <= 1e-5, "within the tolerance asked for; got {found}");
        }
        assert_eq!(falls(|_| 0.4, 0.0, 1.0, 0.01, 1e-5).next(), None);
        assert_eq!(falls(|_| 0.0, f64::INFINITY, f64::NEG_INFINITY, 0.01, 1e-5).next(), None);
    }
}
