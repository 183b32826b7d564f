//! The outputs and checks of a run, with every default filled in. A plan is plain data and opens no files.

use std::{fmt, path::PathBuf};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{
    math::{table::ColumnName, time_series::SampleScaling},
    probe::{ContactListPlan, ProbePlan},
};

/// The outputs, checks and end time of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Plan {
    /// Caption of the scene.
    pub title: String,
    /// Simulated time at which the run ends, s.
    pub until: f64,
    /// The probes.
    pub probes: Vec<ProbePlan>,
    /// The lists of all contacts.
    pub contacts: Vec<ContactListPlan>,
    /// The frames for ParaView, if the scene asks for frames.
    pub frames: Option<FramesPlan>,
    /// Simulated interval between checkpoints, s; absent if the scene sets no interval.
    pub checkpoint_every: Option<f64>,
    /// Wall time between checkpoints, s.
    pub checkpoint_wall: f64,
    /// The comparisons with references.
    pub checks: Vec<CheckPlan>,
    /// The statistics that the scene declares, in addition to the statistics of every series.
    pub statistics: Vec<StatisticPlan>,
    /// The numbers that may be changed during the run.
    #[serde(default)]
    pub controls: Vec<ControlPlan>,
    /// Folder of the scene file, which also holds the tables that the scene names.
    pub folder: PathBuf,
}

/// A number of a motor or force that may be changed during the run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ControlPlan {
    /// Key of the number in the scene.
    pub key: String,
    /// Its unit.
    pub unit: String,
    /// Least value.
    pub min: f64,
    /// Greatest value.
    pub max: f64,
    /// What it changes.
    pub target: ControlTarget,
}

/// What a control changes.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum ControlTarget {
    /// A number of a motor.
    Motor {
        /// Name of the joint.
        joint: String,
        /// The number.
        quantity: MotorQuantity,
    },
    /// A component of a force or torque.
    Force {
        /// Name of the force.
        force: String,
        /// Whether it is the torque.
        torque: bool,
        /// Number of the component.
        component: usize,
    },
}

/// A number of a motor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum MotorQuantity {
    /// Force or torque F₀.
    Force,
    /// Set point x*.
    Position,
    /// Set point x* of a hinge in degrees.
    Degrees,
    /// Set point v*.
    Velocity,
    /// Stiffness k.
    Stiffness,
    /// Damping c.
    Damping,
}

impl MotorQuantity {
    /// All keys of a motor with their quantities, and their units on a slider and on a hinge.
    pub(crate) const ALL: [(&'static str, Self, [&'static str; 2]); 7] = [
        ("force", Self::Force, ["N", "N m"]),
        ("torque", Self::Force, ["N", "N m"]),
        ("position", Self::Position, ["m", "rad"]),
        ("position_deg", Self::Degrees, ["m", "deg"]),
        ("velocity", Self::Velocity, ["m/s", "rad/s"]),
        ("stiffness", Self::Stiffness, ["N/m", "N m/rad"]),
        ("damping", Self::Damping, ["N s/m", "N m s/rad"]),
    ];
}

/// A change of a control.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ControlChange {
    /// Number of the control in the scene.
    pub control: usize,
    /// Key of the number in the scene.
    pub key: String,
    /// The value from then on.
    pub value: f64,
    /// Its unit.
    pub unit: String,
    /// Simulated time of the change, s.
    pub time: f64,
    /// Number of steps before the change.
    pub steps: u64,
}

impl fmt::Display for ControlChange {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { key, value, unit, time, steps, .. } = self;
        write!(f, "control: {key} is {value} {unit} from t = {time:?} s on, after step {steps}")
    }
}

/// The interval and the fields of the frames.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct FramesPlan {
    /// Simulated time between frames, s.
    pub every: f64,
    /// Names of the particle fields.
    pub fields: Vec<String>,
    /// Lowest and highest corner (m) of the box whose water is written; without a box, all water is written.
    pub crop: Option<[Vec<f64>; 2]>,
    /// Whether frames have mooring lines.
    #[serde(default)]
    pub moorings: bool,
}

/// A statistic of one or several series of the run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct StatisticPlan {
    /// Name of the statistic.
    pub name: String,
    /// Kind of the statistic.
    pub what: StatisticKind,
    /// First time of the run that is evaluated, s.
    pub from: Option<f64>,
    /// Last time of the run that is evaluated, s.
    pub until: Option<f64>,
}

/// The kind of a statistic. A series is named `probe.column`, as in `box.heave_m`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum StatisticKind {
    /// Extremes, means, waves and spectrum of each series.
    Waves {
        /// The series.
        series: Vec<String>,
    },
    /// Incident and reflected waves, from a row of gauges.
    Reflection {
        /// Elevation series and the position of each gauge in the direction of the incident waves, m.
        gauges: Vec<(String, f64)>,
        /// Depth of the water, m.
        depth: f64,
        /// Gravity, m/s².
        g: f64,
        /// Period of regular waves, s.
        period: Option<f64>,
    },
    /// Response amplitude operators (RAOs) of motions in a wave.
    Rao {
        /// Series of the motions.
        motions: Vec<String>,
        /// Series of the wave.
        wave: String,
        /// Period of regular waves, s.
        period: Option<f64>,
    },
}

impl StatisticKind {
    /// Returns the names of the series that the statistic evaluates.
    pub(crate) fn series(&self) -> Vec<&str> {
        match self {
            Self::Waves { series } => series.iter().map(String::as_str).collect(),
            Self::Reflection { gauges, .. } => gauges.iter().map(|(series, _)| series.as_str()).collect(),
            Self::Rao { motions, wave, .. } => motions.iter().chain([wave]).map(String::as_str).collect(),
        }
    }
}

/// A comparison of a series of the run with a reference.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct CheckPlan {
    /// `probe.column`, as in `box.heave_m`.
    pub series: String,
    /// The reference.
    pub reference: Reference,
    /// First time of the run that is compared, s.
    pub from: Option<f64>,
    /// Last time of the run that is compared, s.
    pub until: Option<f64>,
    /// Time of the run at which the instrument was set to zero, s.
    pub zero: Option<f64>,
    /// Length of the interval over which the instrument averages, s.
    pub mean: Option<f64>,
    /// Method by which the run is shifted in time to match the reference.
    pub align: Option<Align>,
    /// The scores that the paper reports.
    pub paper: Option<Score>,
    /// The bounds that the run must satisfy.
    pub bound: Option<Score>,
    /// Those of the compared series whose readings are means since the previous row.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub means: Vec<String>,
}

impl CheckPlan {
    /// Creates a check of the whole of `series`, named as in `box.heave_m`, against `reference`, without a bound.
    pub fn new(series: impl Into<String>, reference: Reference) -> Self {
        Self {
            series: series.into(),
            reference,
            from: None,
            until: None,
            zero: None,
            mean: None,
            align: None,
            paper: None,
            bound: None,
            means: Vec::new(),
        }
    }

    /// Returns the same check, starting at the time `from` (s) of the run.
    pub fn from(self, from: f64) -> Self {
        Self { from: Some(from), ..self }
    }

    /// Returns the same check, ending at the time `until` (s) of the run.
    pub fn until(self, until: f64) -> Self {
        Self { until: Some(until), ..self }
    }

    /// Returns the same check for an instrument that was set to zero at the time `zero` (s) of the run.
    pub fn zero(self, zero: f64) -> Self {
        Self { zero: Some(zero), ..self }
    }

    /// Returns the same check for an instrument that averages over the time `mean` (s).
    pub fn mean(self, mean: f64) -> Self {
        Self { mean: Some(mean), ..self }
    }

    /// Returns the same check with the run shifted in time by the method `align`.
    pub fn align(self, align: Align) -> Self {
        Self { align: Some(align), ..self }
    }

    /// Returns the same check with this bound.
    pub fn bound(self, bound: Score) -> Self {
        Self { bound: Some(bound), ..self }
    }

    /// Returns the same check of a run in which the readings of `series` are means since the previous row.
    pub fn means(mut self, series: impl Into<String>) -> Self {
        self.means.push(series.into());
        self
    }

    /// Returns the names of the series of the run that the check evaluates.
    pub(crate) fn series_names(&self) -> impl Iterator<Item = &String> {
        let wave = match &self.reference {
            Reference::Response(response) => Some(&response.to),
            _ => None,
        };
        [&self.series].into_iter().chain(wave)
    }

    /// Returns a label with the name of the series, and the series to which it responds or the time at which the
    /// instrument was set to zero.
    pub(crate) fn label(&self) -> String {
        if let Reference::Response(response) = &self.reference {
            return format!("{}, over {}", self.series, response.to);
        }
        self.zero.map_or(self.series.clone(), |at| format!("{}, 0 at {at} s", self.series))
    }
}

/// The reference of a check.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Reference {
    /// A column of a table beside the scene.
    Table {
        /// The table.
        file: PathBuf,
        /// Its column of times, s.
        time: ColumnName,
        /// Its column of values.
        column: ColumnName,
        /// How its samples become those of the run.
        scaling: SampleScaling,
    },
    /// A formula in the run's time t (s).
    Formula(String),
    /// A response to a regular wave.
    Response(ResponseReference),
}

/// What the fundamental of a series is to that of another series of the run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ResponseReference {
    /// The other series, such as the wave, as `gauge.eta_m`.
    pub to: String,
    /// Period of the wave, s.
    pub period: f64,
    /// Amplitude over that of the other series, in the units of both.
    pub ratio: f64,
    /// Lag behind the other series, in periods; absent if the reference has none.
    pub lag: Option<f64>,
    /// First time of the other series that counts, s; absent if it is that of the check.
    pub from: Option<f64>,
    /// Last time of the other series that counts, s; absent if it is that of the check.
    pub until: Option<f64>,
}

/// How a run is moved in time, as a whole, to lie on its reference.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Align {
    /// So that |x| of both first passes this threshold at one time. In the unit of the series.
    Crossing(f64),
    /// The reference has a clock of its own, which starts as |x| of the run first passes this threshold. In the unit of the series.
    Start(f64),
    /// By the delay of least N.
    Best,
}

/// Figures of a comparison; one that is not given is not judged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Score {
    /// Relative deviation N, –: 0 is perfect. As a bound: the largest that passes.
    #[serde(rename = "N", skip_serializing_if = "Option::is_none")]
    pub relative_l2: Option<f64>,
    /// Amplitude ratio M, –: 1 is perfect. As a bound: the largest |M − 1| that passes.
    #[serde(rename = "M", skip_serializing_if = "Option::is_none")]
    pub amplitude_ratio: Option<f64>,
    /// Relative error of the first peak, –.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub peak: Option<f64>,
    /// Largest |run − reference|, in the unit of the series.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub off: Option<f64>,
    /// Relative deviation N once the delay is taken out, –.
    #[serde(rename = "aligned_N", skip_serializing_if = "Option::is_none")]
    pub aligned_relative_l2: Option<f64>,
    /// The largest delay of either sign that passes, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub delay: Option<f64>,
    /// The largest relative error of the period of a response that passes, –.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub period: Option<f64>,
}
