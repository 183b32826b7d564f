//! What is to be watched, kept and judged in a run, every default filled in: plain data, no files open.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::probe::{ContactListPlan, ProbePlan};

/// What a run does besides stepping.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Plan {
    /// Caption of the scene.
    pub title: String,
    /// Simulated time at which the run ends, s.
    pub until: f64,
    /// What is watched.
    pub probes: Vec<ProbePlan>,
    /// Lists of all contacts.
    pub contacts: Vec<ContactListPlan>,
    /// Frames for ParaView, if any.
    pub frames: Option<FramesPlan>,
    /// Simulated time from one checkpoint to the next, s; none if not asked for.
    pub checkpoint_every: Option<f64>,
    /// Wall time from one checkpoint to the next, s.
    pub checkpoint_wall: f64,
    /// What the run is held against.
    pub checks: Vec<CheckPlan>,
    /// What is said of its series besides what is said of all.
    pub statistics: Vec<StatisticPlan>,
    /// Folder of the scene file: where the tables it names lie.
    pub folder: PathBuf,
}

/// When frames are written, and with which fields.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct FramesPlan {
    /// Simulated time from one frame to the next, s.
    pub every: f64,
    /// Fields of the particles, by name.
    pub fields: Vec<String>,
    /// Lowest and highest corner (m) of the box whose water is kept; all if none.
    pub crop: Option<[Vec<f64>; 2]>,
}

/// What is said of series of the run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct StatisticPlan {
    /// Its name.
    pub name: String,
    /// What it is.
    pub what: StatisticKind,
    /// First time of the run that counts, s.
    pub from: Option<f64>,
    /// Last time of the run that counts, s.
    pub until: Option<f64>,
}

/// What is said of series. A series is `probe.column`, as in `box.heave_m`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum StatisticKind {
    /// Extremes, means, waves and spectrum.
    Waves {
        /// Of these.
        series: Vec<String>,
    },
    /// What comes and what goes back, from gauges in a row.
    Reflection {
        /// Elevations, and how far along the way of the waves that come, m.
        gauges: Vec<(String, f64)>,
        /// Depth of the water, m.
        depth: f64,
        /// Gravity, m/s².
        g: f64,
        /// Period of regular waves, s.
        period: Option<f64>,
    },
    /// How motions answer a wave.
    Rao {
        /// The motions.
        motions: Vec<String>,
        /// The wave.
        wave: String,
        /// Period of regular waves, s.
        period: Option<f64>,
    },
}

impl StatisticKind {
    /// The series that it is about.
    pub(crate) fn series(&self) -> Vec<&str> {
        match self {
            Self::Waves { series } => series.iter().map(String::as_str).collect(),
            Self::Reflection { gauges, .. } => gauges.iter().map(|(series, _)| series.as_str()).collect(),
            Self::Rao { motions, wave, .. } => motions.iter().chain([wave]).map(String::as_str).collect(),
        }
    }
}

/// A series of the run held against a reference.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct CheckPlan {
    /// `probe.column`, as in `box.heave_m`.
    pub series: String,
    /// What it is held against.
    pub reference: Reference,
    /// First time of the run that counts, s.
    pub from: Option<f64>,
    /// Last time of the run that counts, s.
    pub until: Option<f64>,
    /// Time of the run at which the instrument was set to zero, s.
    pub zero: Option<f64>,
    /// Time over which the instrument takes its mean, s.
    pub mean: Option<f64>,
    /// How the run is moved in time to lie on the reference.
    pub align: Option<Align>,
    /// What the paper reached.
    pub paper: Option<Score>,
    /// What the run must reach.
    pub bound: Option<Score>,
}

impl CheckPlan {
    /// The whole of `series`, named as in `box.heave_m`, against `reference`, without a bound.
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
        }
    }

    /// The same check from this time (s) of the run on.
    pub fn from(self, from: f64) -> Self {
        Self { from: Some(from), ..self }
    }

    /// The same check up to this time (s) of the run.
    pub fn until(self, until: f64) -> Self {
        Self { until: Some(until), ..self }
    }

    /// The same check of an instrument that was set to zero at this time (s) of the run.
    pub fn zero(self, zero: f64) -> Self {
        Self { zero: Some(zero), ..self }
    }

    /// The same check of an instrument that takes its mean over this time (s).
    pub fn mean(self, mean: f64) -> Self {
        Self { mean: Some(mean), ..self }
    }

    /// The same check of a run that is moved in time.
    pub fn align(self, align: Align) -> Self {
        Self { align: Some(align), ..self }
    }

    /// The same check with this bound.
    pub fn bound(self, bound: Score) -> Self {
        Self { bound: Some(bound), ..self }
    }

    /// The series in words, with when it was set to zero.
    pub(crate) fn label(&self) -> String {
        self.zero.map_or(self.series.clone(), |at| format!("{}, 0 at {at} s", self.series))
    }
}

/// What a series is held against.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Reference {
    /// A column of a table beside the scene.
    Table {
        /// The table.
        file: PathBuf,
        /// Its column of times, s.
        time: String,
        /// Its column of values.
        column: String,
        /// Time added to the table's, s: what it calls 0 happens `delay` into the run.
        delay: f64,
    },
    /// A formula in the run's time t (s).
    Formula(String),
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
}
