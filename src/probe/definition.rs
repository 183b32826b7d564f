//! The functions that each kind of probe provides, and those of a scene that its validation uses.

use super::Probe;
use crate::{
    error::{Error, Result},
    math::BoxConfig,
    simulation::{Dimension, Simulation},
    solid::Dim,
    system::System,
};

/// A kind of probe, implemented by its resolved plan.
pub(crate) trait ProbeDefinition: Sized {
    /// The value of the key of this kind in a `[[probe]]` section.
    type Config;

    /// Name of the table of this kind in a report.
    const LABEL: &'static str;

    /// A valid line of a scene file, for the documentation and for error messages.
    const EXAMPLE: &'static str;

    /// Checks `config` at `key` against `scene`.
    ///
    /// # Errors
    /// `Scene`, with the key.
    fn verify(config: &Self::Config, key: &str, scene: &dyn ProbeScope) -> Result<()>;

    /// Returns the plan for `config`, with defaults filled in.
    fn from_config(config: &Self::Config) -> Self;

    /// Returns the file stem of a probe without a name. If it returns `None`, the stem is the key with a number.
    fn default_name(_config: &Self::Config) -> Option<String> {
        None
    }

    /// Whether the probe can go with a solid.
    const MOUNTABLE: bool = false;

    /// Attaches the probe to the solid called `on`; its places are then in the frame of this solid.
    fn mount(&mut self, on: &str) {
        let _ = on;
    }

    /// Returns the place of measurement, or `None` if the place is not fixed.
    fn location(&self) -> Option<ProbeLocation<'_>> {
        None
    }

    /// Returns the columns that a statistic evaluates if it names only the probe. Each column has its place (m), if any.
    fn series(&self, _dimension: usize) -> Vec<(String, Option<Vec<f64>>)> {
        Vec::new()
    }

    /// Returns the kind of energy in the last column of the rows, if any.
    fn energy_reading(&self) -> Option<EnergyReading> {
        None
    }

    /// Returns whether `column` adds up from the start of the run. The program takes no time mean of such a column.
    fn is_cumulative(&self, _column: &str) -> bool {
        false
    }

    /// Enables the records of the simulation that the probe reads.
    fn enable_records<const D: usize>(&self, _sim: &mut Simulation<D>)
    where
        Dim<D>: Dimension<D>,
    {
    }

    /// Builds the probe. [`Probe::read_start`](super::Probe::read_start) is called next, when the water is known.
    ///
    /// # Errors
    /// `Scene` or `Usage` if the system lacks an object that the probe names.
    fn build<const D: usize>(&self, system: &System<D>) -> Result<Box<dyn Probe<D>>>;
}

/// The functions of a scene that the validation of a probe uses. A key has the form `probe.0.flow.from`.
pub(crate) trait ProbeScope {
    /// Returns the dimension of the scene, 2 or 3.
    fn dimension(&self) -> usize;

    /// Returns whether the solid called `name` is free.
    fn is_free(&self, name: &str) -> bool;

    /// Returns whether the scene holds a current.
    fn has_current(&self) -> bool;

    /// Returns an error about `key`, with an example of the key.
    fn error_at(&self, key: &str, what: &str) -> Error;

    /// Returns an error about `key`, with the advice `help`.
    fn error_with_help(&self, key: &str, what: &str, help: &str) -> Error;

    /// Requires a solid called `name`.
    ///
    /// # Errors
    /// `Scene` if the scene has no object with this name.
    fn require_solid(&self, key: &str, name: &str) -> Result<()>;

    /// Requires a joint, spring, rope, mooring or open boundary (`kind`) called `name`.
    ///
    /// # Errors
    /// `Scene` if the scene has no object with this name.
    fn require_constraint(&self, key: &str, kind: &str, name: &str) -> Result<()>;

    /// Requires that the two solids can touch.
    ///
    /// # Errors
    /// `Scene` if they never touch.
    fn require_contact(&self, key: &str, between: &[String; 2]) -> Result<()>;

    /// Requires a vector with a finite number for each dimension.
    ///
    /// # Errors
    /// `Scene` if `x` is not such a vector.
    fn require_vector(&self, key: &str, x: &[f64]) -> Result<()>;

    /// Requires that `x` is positive if it is present.
    ///
    /// # Errors
    /// `Scene` if `x` is not positive.
    fn require_positive(&self, key: &str, x: Option<f64>) -> Result<()>;

    /// Requires that the box has a positive volume.
    ///
    /// # Errors
    /// `Scene` if the box has no volume.
    fn require_box(&self, key: &str, corners: &BoxConfig) -> Result<()>;
}

/// The place at which a probe measures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ProbeLocation<'a> {
    /// At points (m) in the frame of the solid of this name, or of the world.
    Points(&'a [Vec<f64>], Option<&'a str>),
    /// On vertical lines through horizontal places (m) in the frame of the solid of this name, or of the world.
    Columns(&'a [Vec<f64>], Option<&'a str>),
    /// Over a section between two points, m.
    Section([&'a [f64]; 2]),
}

/// The kind of energy in the last column of the rows of a probe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum EnergyReading {
    /// The residual of the energy budget.
    Budget,
    /// The total energy.
    Total,
}
