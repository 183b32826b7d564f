//! Height of the free surface at a horizontal place.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    PointRowConfig, Probe, ProbeDefinition, ProbeLocation, ProbeRow, ProbeScope, column_at_place, empty_row,
    mounting::MountedPoint,
};
use crate::{
    error::Result,
    math::{Bounds, NumberOrArray},
    simulation::Simulation,
    system::System,
};

/// The surface that an elevation gauge measures if several surfaces lie above one another.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum GaugeSurface {
    /// The highest surface, as of the jet of a breaking wave or of water on a deck.
    #[default]
    Highest,
    /// The lowest surface, as of the water under the jet.
    Lowest,
    /// The highest surface and the surfaces below it.
    All,
}

/// The places of elevation gauges and the surface that they measure. A place is x in 2-D, x and y in 3-D, or a row of
/// places.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[non_exhaustive]
pub struct GaugeConfig {
    /// Coordinate x, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub x: Option<f64>,
    /// Coordinate y, m; 3-D only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub y: Option<f64>,
    /// First place of a row, m: one number in 2-D, two numbers in 3-D.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from: Option<NumberOrArray>,
    /// Last place of the row, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub to: Option<NumberOrArray>,
    /// Number of gauges in the row.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub count: Option<usize>,
    /// Distance between neighbouring gauges, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spacing: Option<f64>,
    /// The surface to measure if several surfaces lie above one another.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub surface: Option<GaugeSurface>,
    /// The solid that the gauge goes with; places are in the frame of the solid then.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub on: Option<String>,
}

impl GaugeConfig {
    /// Returns the row of gauges, or `None` for a single place.
    fn row(&self) -> Option<PointRowConfig> {
        let list = |numbers: &Option<NumberOrArray>| match numbers {
            Some(NumberOrArray::One(x)) => vec![*x],
            Some(NumberOrArray::List(list)) => list.clone(),
            _ => Vec::new(),
        };
        let given = self.from.is_some() || self.to.is_some() || self.count.is_some() || self.spacing.is_some();
        given.then(|| PointRowConfig {
            from: list(&self.from),
            to: list(&self.to),
            count: self.count,
            spacing: self.spacing,
        })
    }
}

/// Plan of elevation gauges at horizontal places.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ElevationPlan {
    /// Horizontal coordinates of each place, m: D − 1 numbers.
    pub places: Vec<Vec<f64>>,
    /// The surface that the gauges measure.
    pub surface: GaugeSurface,
    /// The solid that they go with, in whose frame they are.
    pub on: Option<String>,
}

impl ProbeDefinition for ElevationPlan {
    type Config = GaugeConfig;
    const LABEL: &'static str = "level of the water";
    const EXAMPLE: &'static str =
        "elevation = { x = 1.16 }, or a row:  elevation = { from = 1.0, to = 3.0, count = 5 }";

    const MOUNTABLE: bool = true;

    fn mount(&mut self, on: &str) {
        self.on = Some(on.into());
    }

    fn verify(config: &GaugeConfig, key: &str, scene: &dyn ProbeScope) -> Result<()> {
        if let Some(on) = &config.on {
            scene.require_solid(&format!("{key}.on"), on)?;
        }
        let single = config.x.is_some() || config.y.is_some();
        match config.row() {
            Some(_) if single => {
                let help = "write  elevation = { x = 1.16 }  or  elevation = { from = 1.0, to = 3.0, count = 5 }";
                Err(scene.error_with_help(key, "a gauge stands at one place or is a row of them, not both", help))
            }
            Some(row) => row.verify(key, scene, scene.dimension() - 1),
            None if config.x.is_none() || config.y.is_some() != (scene.dimension() == 3) => {
                let help = "write  elevation = { x = 1.16 } in 2-D, elevation = { x = 1.16, y = 0.3 } in 3-D";
                Err(scene.error_with_help(key, "a gauge stands at x in 2-D, at x and y in 3-D", help))
            }
            None => Ok(()),
        }
    }

    fn from_config(config: &GaugeConfig) -> Self {
        let places = match config.row() {
            Some(row) => row.places(),
            None => vec![[config.x, config.y].into_iter().flatten().collect()],
        };
        Self { places, surface: config.surface.unwrap_or_default(), on: config.on.clone() }
    }

    fn location(&self) -> Option<ProbeLocation<'_>> {
        Some(ProbeLocation::Columns(&self.places, self.on.as_deref()))
    }

    fn series(&self, _: usize) -> Vec<(String, Option<Vec<f64>>)> {
        let fixed = |at: &Vec<f64>| self.on.is_none().then(|| at.clone());
        match &self.places[..] {
            [at] => vec![("eta_m".into(), fixed(at))],
            places => places.iter().map(|at| (column_at_place("eta_m", at), fixed(at))).collect(),
        }
    }

    fn build<const D: usize>(&self, system: &System<D>) -> Result<Box<dyn Probe<D>>> {
        let gauge = |at: &[f64]| ElevationProbe::unread(system, at, self.surface, self.on.as_deref());
        ProbeRow::at_places(&self.places, |at| Ok(Box::new(gauge(at)?)))
    }
}

/// Number of surfaces below the highest surface that [`GaugeSurface::All`] measures.
const LOWER_SURFACES: usize = 3;

/// Measures the level of the water (m) at a horizontal place, and its change η (m) since the creation of the probe. A gauge on a
/// solid moves with a point of it, above which it measures both. Both values are NaN at a dry place. Spray that fills less
/// than half the kernel's weight does not count.
pub struct ElevationProbe<const D: usize> {
    at: MountedPoint<D>,
    surface: GaugeSurface,
    start: f64,
}

impl<const D: usize> ElevationProbe<D> {
    /// Creates the gauge of the highest surface at `at` (m; D − 1 horizontal coordinates). The present level counts as
    /// η = 0. At a dry place this level is NaN, and η stays NaN.
    ///
    /// # Errors
    /// `Usage` if the number of coordinates is not D − 1 or a coordinate is not finite.
    pub fn new(system: &System<D>, at: &[f64]) -> Result<Self> {
        Self::with_surface(system, at, GaugeSurface::Highest)
    }

    /// Creates the gauge as [`ElevationProbe::new`] does, for the given `surface`.
    ///
    /// # Errors
    /// The same errors as [`ElevationProbe::new`].
    pub fn with_surface(system: &System<D>, at: &[f64], surface: GaugeSurface) -> Result<Self> {
        Self::mounted(system, at, surface, None)
    }

    /// Creates the gauge of the highest surface at `at` (m; D − 1 coordinates) in the frame of the solid called `solid`, which
    /// carries the gauge. The level is a height above the gauge's point of the solid, and η the change of that.
    ///
    /// # Errors
    /// The errors of [`ElevationProbe::new`]; `Scene` if there is no such solid.
    pub fn on_solid(system: &System<D>, solid: &str, at: &[f64]) -> Result<Self> {
        Self::mounted(system, at, GaugeSurface::Highest, Some(solid))
    }

    fn mounted(system: &System<D>, at: &[f64], surface: GaugeSurface, on: Option<&str>) -> Result<Self> {
        let mut gauge = Self::unread(system, at, surface, on)?;
        gauge.read_start(system);
        Ok(gauge)
    }

    fn unread(system: &System<D>, at: &[f64], surface: GaugeSurface, on: Option<&str>) -> Result<Self> {
        Ok(Self { at: MountedPoint::in_world(at, D - 1)?.on(system, on)?, surface, start: f64::NAN })
    }

    /// The height (m) of the gauge's point of the solid; 0 for a gauge of the world.
    fn height(&self, system: &System<D>) -> f64 {
        if self.at.is_mounted() { self.at.position(system)[D - 1] } else { 0.0 }
    }

    /// Returns the heights (m) of the measured surfaces. The level comes first.
    fn surface_heights(&self, system: &System<D>) -> Vec<f64> {
        let at = self.at.position(system);
        let mut found = system.gauge_heights(&at);
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
    fn water_ranges(&self, system: &System<D>) -> Option<Vec<Bounds<D>>> {
        Some(vec![system.surface_range(&self.at.position(system))])
    }

    fn read_start(&mut self, system: &System<D>) {
        self.start = self.surface_heights(system)[0] - self.height(system);
    }

    fn columns(&self) -> Vec<String> {
        let below = if self.surface == GaugeSurface::All { LOWER_SURFACES } else { 0 };
        let below = (1..=below).map(|i| format!("below_{i}_m"));
        ["level_m", "eta_m"].map(String::from).into_iter().chain(below).collect()
    }

    fn sample(&self, sim: &Simulation<D>) -> Vec<f64> {
        if self.at.is_removed(sim.system()) {
            return empty_row(self);
        }
        let mut row = self.surface_heights(sim.system());
        let height = self.height(sim.system());
        row.iter_mut().for_each(|surface| *surface -= height);
        row.insert(1, row[0] - self.start);
        row
    }
}
