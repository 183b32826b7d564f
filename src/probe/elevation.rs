//! The level of the water above a place.

use super::{Probe, point};
use crate::{error::Result, math::Vector, plan::GaugeSurface, simulation::Simulation, system::System};

/// How many surfaces below the highest are told.
const LOWER_SURFACES: usize = 3;

/// Watches the water's level (m) at a horizontal place, and its change η (m) since the probe was made;
/// NaN where there is no water. Spray lighter than half a kernel does not count.
pub struct ElevationProbe<const D: usize> {
    at: Vector<D>,
    surface: GaugeSurface,
    start: f64,
}

impl<const D: usize> ElevationProbe<D> {
    /// The gauge above `at` (m; D − 1 horizontal coordinates) that tells the highest surface; the level now counts
    /// as η = 0, and so does a dry place's NaN: η then stays empty.
    ///
    /// # Errors
    /// `Usage` if the count of coordinates is another or one is not finite.
    pub fn new(system: &System<D>, at: &[f64]) -> Result<Self> {
        Self::with_surface(system, at, GaugeSurface::Highest)
    }

    /// As [`ElevationProbe::new`], of another surface: the lowest, as under a breaker's jet, or of all the highest and three
    /// below it.
    ///
    /// # Errors
    /// As [`ElevationProbe::new`].
    pub fn with_surface(system: &System<D>, at: &[f64], surface: GaugeSurface) -> Result<Self> {
        let mut gauge = Self { at: point(at, D - 1)?, surface, start: f64::NAN };
        gauge.start = gauge.surface_heights(system)[0];
        Ok(gauge)
    }

    /// Heights (m) of the surfaces that are told, the one that counts as the level first.
    fn surface_heights(&self, system: &System<D>) -> Vec<f64> {
        let mut found = system.surface_heights(&self.at);
        let all: Vec<f64> = match self.surface {
            GaugeSurface::Highest => found.next().into_iter().collect(),
            GaugeSurface::Lowest => found.last().into_iter().collect(),
            GaugeSurface::All => found.take(1 + LOWER_SURFACES).collect(),
        };
        let count = if self.surface == GaugeSurface::All { 1 + LOWER_SURFACES } else { 1 };
        (0..count).map(|i| all.get(i).copied().unwrap_or(f64::NAN)).collect()
    }
}

impl<const D: usize> Probe<D> for ElevationProbe<D> {
    fn columns(&self) -> Vec<String> {
        let below = if self.surface == GaugeSurface::All { LOWER_SURFACES } else { 0 };
        let below = (1..=below).map(|i| format!("below_{i}_m"));
        ["level_m", "eta_m"].map(String::from).into_iter().chain(below).collect()
    }

    fn sample(&self, sim: &Simulation<D>) -> Vec<f64> {
        let mut row = self.surface_heights(sim.system());
        row.insert(1, row[0] - self.start);
        row
    }
}
