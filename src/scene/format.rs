//! The words of a scene, as plain data: what `scene.toml` may say, and what a program may build.
//!
//! A missing word is `None` here; its default is filled in by [`resolve`](super::resolve), which also
//! says why. Vectors are lists of as many numbers as the scene has dimensions. Units are SI; keys that
//! end in `_deg` are in degrees. `docs/scene.md` explains every key.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    BoxConfig, ProbeConfig,
    bodies::{PlacementConfig, ShapeConfig, SolidConfig},
    damping::DampingConfig,
    document::SceneSource,
    flexible::{FieldFormulaConfig, FramesChoice},
    flow::PeriodicConfig,
    guard::GuardConfig,
    links::{ContactConfig, ForceConfig, JointConfig, RopeConfig, SpringConfig},
    statistics::StatisticConfig,
};
use crate::{
    model::{Diffusion, Gradient, Kernel, PairLoopKind, Scheme, Shifting, Slip, Viscosity, Walls},
    plan::{Align, Score},
};

/// A scene: the caption of an experiment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Caption.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// 2 or 3.
    pub dimension: usize,
    /// Particle spacing, m.
    pub dp: f64,
    /// Simulated time at which the run ends, s.
    pub until: f64,
    /// Acceleration of gravity, m/s².
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gravity: Option<Vec<f64>>,
    /// How far off its place each water particle starts at most, in each direction, over dp.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scatter: Option<f64>,
    /// Box that nothing may leave.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub domain: Option<BoxConfig>,
    /// Periodic sides.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub periodic: Option<PeriodicConfig>,
    /// What the guards let pass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub guard: Option<GuardConfig>,
    /// Bodies of water.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub water: Vec<WaterConfig>,
    /// Where water loses its motion.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub damping: Vec<DampingConfig>,
    /// Solids.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub solid: Vec<SolidConfig>,
    /// Joints between them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub joint: Vec<JointConfig>,
    /// Springs and mooring lines.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub spring: Vec<SpringConfig>,
    /// Ropes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rope: Vec<RopeConfig>,
    /// Forces after a law of time.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub force: Vec<ForceConfig>,
    /// Pairs that touch in their own way.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub contact: Vec<ContactConfig>,
    /// The chosen laws.
    #[serde(default)]
    pub model: ModelConfig,
    /// The time scheme.
    #[serde(default)]
    pub time: TimeSteppingConfig,
    /// What is watched.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub probe: Vec<ProbeConfig>,
    /// Frames for ParaView.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frames: Option<FramesChoice>,
    /// Checkpoints.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub checkpoint: Option<CheckpointConfig>,
    /// What the run is held against.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub check: Vec<CheckConfig>,
    /// What is said of its series.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub statistic: Vec<StatisticConfig>,
    /// Where each word was written.
    #[serde(skip)]
    pub(super) origin: SceneSource,
}

/// A body of water.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WaterConfig {
    /// What it fills, minus the solids.
    pub fill: FillConfig,
    /// Height of its surface, m, where that lies below the top of `fill`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub level: Option<f64>,
    /// Velocity at the start, m/s: a formula in the place or a number for each axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub velocity: Option<Vec<FieldFormulaConfig>>,
    /// Pressure at the start beyond that of water at rest, Pa: a formula in the place or a number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pressure: Option<FieldFormulaConfig>,
}

/// What a body of water fills: a box by its corners, or any shape somewhere.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FillConfig {
    /// A box by its corners.
    #[serde(default, rename = "box", skip_serializing_if = "Option::is_none")]
    pub corners: Option<BoxConfig>,
    /// Any shape.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shape: Option<ShapeConfig>,
    /// Where that shape is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<PlacementConfig>,
}

/// The chosen laws.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ModelConfig {
    /// Kernel.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub kernel: Option<Kernel>,
    /// Smoothing length over particle spacing, –.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub h_over_dp: Option<f64>,
    /// Smoothing length over the spacing's diagonal √D·dp, –.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub c_h: Option<f64>,
    /// The pressure's gradient.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gradient: Option<Gradient>,
    /// Viscosity.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub viscosity: Option<Viscosity>,
    /// Density diffusion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub diffusion: Option<Diffusion>,
    /// Particle shifting.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shifting: Option<Shifting>,
    /// Walls.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub walls: Option<Walls>,
    /// How water slips along solids.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slip: Option<Slip>,
    /// Which sweep adds up the pairs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sweep: Option<PairLoopKind>,
    /// Speed of sound, m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub c0: Option<f64>,
    /// Speed of sound over √(g · depth), –.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub c0_factor: Option<f64>,
    /// Reference density, kg/m³.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rho0: Option<f64>,
    /// Exponent of the equation of state, –.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gamma: Option<f64>,
}

/// The time scheme.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct TimeSteppingConfig {
    /// Scheme.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scheme: Option<Scheme>,
    /// Courant number, –.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cfl: Option<f64>,
    /// Longest step, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dt_max: Option<f64>,
}

/// Checkpoints.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct CheckpointConfig {
    /// Simulated time between them, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub every: Option<f64>,
    /// Wall time between them, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wall: Option<f64>,
}

/// One `[[check]]`: a column of a probe held against a column of a reference table, or against a formula.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CheckConfig {
    /// `probe.column`, as in `box.heave_m`.
    pub series: String,
    /// The reference table, beside the scene.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference: Option<String>,
    /// Its column of values.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub column: Option<String>,
    /// Its column of times, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time: Option<String>,
    /// Time added to the reference's, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub delay: Option<f64>,
    /// The reference as a formula in the run's time t (s), in place of a table.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub formula: Option<String>,
    /// First time of the run that counts, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<f64>,
    /// Last time of the run that counts, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub until: Option<f64>,
    /// Time of the run at which the instrument was set to zero, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub zero: Option<f64>,
    /// Time over which the instrument takes its mean, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean: Option<f64>,
    /// How the run is moved in time to lie on its reference.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub align: Option<Align>,
    /// What the paper reached.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub paper: Option<Score>,
    /// What the run must reach.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bound: Option<Score>,
}

impl Scene {
    /// A scene of `dimension` 2 or 3, particle spacing `dp` (m), that ends at `until` (s).
    pub fn new(dimension: usize, dp: f64, until: f64) -> Self {
        Self {
            title: None,
            dimension,
            dp,
            until,
            gravity: None,
            scatter: None,
            domain: None,
            periodic: None,
            guard: None,
            water: Vec::new(),
            damping: Vec::new(),
            solid: Vec::new(),
            joint: Vec::new(),
            spring: Vec::new(),
            rope: Vec::new(),
            force: Vec::new(),
            contact: Vec::new(),
            model: ModelConfig::default(),
            time: TimeSteppingConfig::default(),
            probe: Vec::new(),
            frames: None,
            checkpoint: None,
            check: Vec::new(),
            statistic: Vec::new(),
            origin: SceneSource::default(),
        }
    }

    /// The same scene with a caption.
    pub fn title(mut self, title: impl Into<String>) -> Self {
        self.title = Some(title.into());
        self
    }

    /// The same scene with water in the box from corner `min` to corner `max` (m) too.
    pub fn water_box(mut self, min: impl Into<Vec<f64>>, max: impl Into<Vec<f64>>) -> Self {
        let corners = Some(BoxConfig { min: min.into(), max: max.into() });
        let fill = FillConfig { corners, ..FillConfig::default() };
        self.water.push(WaterConfig { fill, level: None, velocity: None, pressure: None });
        self
    }

    /// The same scene with a solid more.
    pub fn solid(mut self, solid: SolidConfig) -> Self {
        self.solid.push(solid);
        self
    }

    /// The same scene with these laws.
    pub fn model(mut self, model: ModelConfig) -> Self {
        self.model = model;
        self
    }

    /// The same scene with a probe more.
    pub fn probe(mut self, probe: ProbeConfig) -> Self {
        self.probe.push(probe);
        self
    }

    /// The same scene without frames.
    pub fn without_frames(mut self) -> Self {
        self.frames = Some(FramesChoice::Off);
        self
    }
}
