//! Scenes: reading scene, mesh and drawing files, checking, filling in the defaults, building.
//!
//! `toml_source` reads a [`Scene`] from TOML, `overrides` puts the values of `--set` into it and `diagnostics` explains the
//! errors of the parser. Each file of `section` contains the configuration, validation, defaults and construction of a section of
//! the scene. `resolve`, `build` and `constraints` combine the sections.
//!
//! An absent key is `None`; [`resolve`](Scene::resolve) returns its default and the reason. A vector is a list of two
//! numbers in 2-D and three numbers in 3-D. Units are SI; keys that end in `_deg` are in degrees.
//! `docs/reference/scene.md` explains every key.

mod afloat;
mod at_rest;
mod build;
mod bundled;
mod constraints;
mod context;
mod diagnostics;
pub(crate) mod file_content;
mod file_units;
pub(crate) mod files;
mod finite_law;
mod mesh;
#[cfg(any(feature = "cli", test))]
pub(crate) mod moordyn;
mod overrides;
mod potential_flow;
mod record;
mod resolve;
mod schema;
mod svg;
mod toml_source;
mod untagged;
mod value_reader;
mod verify_probes;

/// The sections of a scene.
mod section {
    pub(crate) mod analysis;
    pub(crate) mod ballast;
    pub(crate) mod contact;
    pub(crate) mod control;
    pub(crate) mod domain;
    pub(crate) mod driving;
    pub(crate) mod force_element;
    pub(crate) mod gravity;
    pub(crate) mod joint;
    pub(crate) mod meshed_shape;
    pub(crate) mod lifetime;
    pub(crate) mod model;
    pub(crate) mod mooring;
    pub(crate) mod motion;
    pub(crate) mod open_boundary;
    pub(crate) mod outline;
    pub(crate) mod output;
    pub(crate) mod shape;
    pub(crate) mod solid;
    pub(crate) mod sponge_layer;
    pub(crate) mod water;
    pub(crate) mod wave;
    pub(crate) mod wavemaker;
    pub(crate) mod winch;
    pub(crate) mod wind;
}

use std::{
    io::Read,
    path::{Path, PathBuf},
};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use toml_source::SceneSource;

pub use context::FileNote;
#[cfg(feature = "cli")]
pub(crate) use resolve::MOST_JITTER;
pub(crate) use section::water::{basin, level_at};
pub use {
    crate::probe::ProbeConfig,
    build::{BuiltScene, InitialWater},
    bundled::{BundledScene, bundled_scenes},
    schema::schema,
    section::ballast::BallastConfig,
    section::contact::ContactConfig,
    section::control::ControlConfig,
    section::driving::{CurrentConfig, TowedConfig},
    section::force_element::{ForceConfig, RopeConfig, SpringConfig},
    section::joint::{JointConfig, JointKindConfig, MotorConfig},
    section::model::ModelConfig,
    section::mooring::{ClumpConfig, LineTypeConfig, MooringConfig, MooringPointConfig},
    section::motion::DrivenConfig,
    section::open_boundary::{FaceWaveConfig, OpenBoundaryConfig},
    section::output::FramesChoice,
    section::shape::{CompoundPartConfig, PlacementConfig, ShapeConfig},
    section::solid::{FreeBodyConfig, SolidConfig},
    section::sponge_layer::SpongeLayerConfig,
    section::water::WaterConfig,
    section::wave::WaveConfig,
    section::winch::WinchConfig,
    section::wind::WindConfig,
    untagged::TimeValueConfig,
};
// Parts of the configuration that the constructors of the types above fill in.
#[doc(hidden)]
pub use {
    crate::math::{BoxConfig, NumberOrArray, table::ColumnName},
    crate::plan::{
        Align, CheckPlan, ControlChange, ControlPlan, ControlTarget, FramesPlan, MotorQuantity, Plan, Reference,
        ResponseReference, Score, StatisticKind, StatisticPlan,
    },
    crate::probe::{GaugeConfig, GaugeSurface, PatchConfig, PointRowConfig, PointsConfig, ProbePlan, SectionConfig},
    build::SceneLayout,
    build::SizeEstimate,
    potential_flow::{PanelledBody, PanelledScene, WaterForPanels},
    resolve::ResolvedValue,
    section::analysis::{CheckConfig, RaoConfig, ResponseConfig, StatisticConfig},
    section::domain::{GuardConfig, PeriodicConfig, SymmetryConfig},
    section::force_element::ForceFrame,
    section::joint::LimitsConfig,
    section::lifetime::StrengthConfig,
    section::meshed_shape::{ConeConfig, EllipsoidConfig, FrustumConfig, PrismConfig, TorusConfig, WedgeConfig},
    section::model::TimeSteppingConfig,
    section::output::{CheckpointConfig, FramesConfig},
    section::shape::{AxisName, MeshConfig},
    section::solid::MotionMode,
    section::water::{FillConfig, StillWaterLevel},
    section::wave::{
        AbsorbChoice, AbsorptionConfig, FocusedWaveConfig, IrregularWaveConfig, MeasuredElevationConfig,
        RegularWaveConfig, SolitaryWaveConfig, WaveComponentsConfig,
    },
    toml_source::current_key,
    toml_source::{RenamedName, ValueSource},
    untagged::{
        AxesConfig, DraftChoice, FieldFormulaConfig, LengthUnit, PolylineConfig, TimeFunctionConfig, TimeVectorConfig,
    },
};

/// The value of `model.device` for the processor.
const PROCESSOR: &str = "cpu";

/// Largest size of the text of a scene, B. The longest bundled scene has 3,000 B.
const MOST_TEXT: u64 = 1 << 20;

/// A scene, as `scene.toml` describes it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Caption.
    pub title: Option<String>,
    /// 2 or 3.
    pub dimension: usize,
    /// Particle spacing, m.
    pub dp: f64,
    /// Simulated time at which the run ends, s.
    pub until: f64,
    /// Acceleration of gravity, m/s²: a vector, or a number downwards; of numbers, formulas in t (s) or tables.
    pub gravity: Option<TimeVectorConfig>,
    /// Largest random offset of a water particle from its lattice point at the start, in each direction, over dp.
    #[schemars(extend("also" = "scatter"))]
    pub jitter: Option<f64>,
    /// Box that water and moving solids must not leave.
    pub domain: Option<BoxConfig>,
    /// Periodic sides.
    pub periodic: Option<PeriodicConfig>,
    /// Symmetry planes, of which one side is computed.
    pub symmetry: Option<SymmetryConfig>,
    /// The valid range of water particles.
    pub guard: Option<GuardConfig>,
    /// Bodies of water.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub water: Vec<WaterConfig>,
    /// Sponge layers.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub damping: Vec<SpongeLayerConfig>,
    /// Faces through which water enters.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub inflow: Vec<OpenBoundaryConfig>,
    /// Faces through which water leaves.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub outflow: Vec<OpenBoundaryConfig>,
    /// A current along a periodic axis.
    pub current: Option<CurrentConfig>,
    /// The motion of the frame of the scene.
    pub towed: Option<TowedConfig>,
    /// Solids.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub solid: Vec<SolidConfig>,
    /// Joints of the solids.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub joint: Vec<JointConfig>,
    /// Springs, and mooring lines without mass.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub spring: Vec<SpringConfig>,
    /// Ropes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rope: Vec<RopeConfig>,
    /// Materials of mooring lines.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub line_type: Vec<LineTypeConfig>,
    /// Points in which mooring lines meet.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub mooring_point: Vec<MooringPointConfig>,
    /// Mooring lines with mass.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub mooring: Vec<MooringConfig>,
    /// Prescribed forces.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub force: Vec<ForceConfig>,
    /// Winds on the dry part of solids.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub wind: Vec<WindConfig>,
    /// Rules for pairs of solids that touch.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub contact: Vec<ContactConfig>,
    /// Numbers of motors and forces that may be changed during a run.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub control: Vec<ControlConfig>,
    /// The equations of the water.
    #[serde(default)]
    pub model: ModelConfig,
    /// The time scheme.
    #[serde(default)]
    pub time: TimeSteppingConfig,
    /// Probes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub probe: Vec<ProbeConfig>,
    /// Frames for ParaView.
    pub frames: Option<FramesChoice>,
    /// Checkpoints.
    pub checkpoint: Option<CheckpointConfig>,
    /// Comparisons with references.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub check: Vec<CheckConfig>,
    /// Statistics of series.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub statistic: Vec<StatisticConfig>,
    /// Source location of each key.
    #[serde(skip)]
    origin: SceneSource,
}

impl Scene {
    /// Creates a scene of `dimension` 2 or 3 with particle spacing `dp` (m) that ends at `until` (s), without water and
    /// solids. Keys that are not set have the defaults of a TOML scene.
    ///
    /// ```
    /// use pontoon::scene::{PlacementConfig, ProbeConfig, Scene, ShapeConfig, SolidConfig, SpringConfig};
    ///
    /// let scene = Scene::new(2, 0.02, 5.0)
    ///     .water_box([0.0, 0.0], [2.0, 0.4])
    ///     .solid(SolidConfig::fixed("tank", ShapeConfig::tank([2.0, 0.8])))
    ///     .solid(SolidConfig::free("buoy", ShapeConfig::ball(0.1), 500.0).at(PlacementConfig::afloat(&[1.0])).friction(0.4))
    ///     .spring(SpringConfig::mooring("line", "buoy", [1.0, 0.3], [1.0, 0.0], 200.0).damping(5.0))
    ///     .probe(ProbeConfig::motion("buoy"));
    /// assert_eq!(scene.build::<2>()?.setup.solids.len(), 2);
    /// # Ok::<(), pontoon::Error>(())
    /// ```
    pub fn new(dimension: usize, dp: f64, until: f64) -> Self {
        Self { dimension, dp, until, ..Self::default() }
    }

    /// Returns the same scene with a caption.
    pub fn title(mut self, title: impl Into<String>) -> Self {
        self.title = Some(title.into());
        self
    }

    /// Returns the scene with an additional box of water from corner `min` to corner `max` (m).
    pub fn water_box(mut self, min: impl Into<Vec<f64>>, max: impl Into<Vec<f64>>) -> Self {
        let corners = Some(BoxConfig { min: min.into(), max: max.into() });
        let fill = FillConfig { corners, ..FillConfig::default() };
        self.water.push(WaterConfig { fill, level: None, inside: None, velocity: None, pressure: None });
        self
    }

    /// Returns the same scene with one more solid.
    pub fn solid(mut self, solid: SolidConfig) -> Self {
        self.solid.push(solid);
        self
    }

    /// Returns the scene with the given model.
    pub fn model(mut self, model: ModelConfig) -> Self {
        self.model = model;
        self
    }

    /// Returns the same scene with one more probe.
    pub fn probe(mut self, probe: ProbeConfig) -> Self {
        self.probe.push(probe);
        self
    }

    /// Returns the same scene without frames.
    pub fn without_frames(mut self) -> Self {
        self.frames = Some(FramesChoice::Off);
        self
    }

    /// Returns the same scene with one more sponge layer.
    pub fn damping(mut self, layer: SpongeLayerConfig) -> Self {
        self.damping.push(layer);
        self
    }

    /// Returns the same scene with one more face through which water enters.
    pub fn inflow(mut self, face: OpenBoundaryConfig) -> Self {
        self.inflow.push(face);
        self
    }

    /// Returns the same scene with one more face through which water leaves.
    pub fn outflow(mut self, face: OpenBoundaryConfig) -> Self {
        self.outflow.push(face);
        self
    }

    /// Returns the same scene with one more joint.
    pub fn joint(mut self, joint: JointConfig) -> Self {
        self.joint.push(joint);
        self
    }

    /// Returns the same scene with one more spring or mooring line without mass.
    pub fn spring(mut self, spring: SpringConfig) -> Self {
        self.spring.push(spring);
        self
    }

    /// Returns the same scene with one more rope.
    pub fn rope(mut self, rope: RopeConfig) -> Self {
        self.rope.push(rope);
        self
    }

    /// Returns the same scene with one more line type.
    pub fn line_type(mut self, line_type: LineTypeConfig) -> Self {
        self.line_type.push(line_type);
        self
    }

    /// The objects to which a mooring line may refer.
    fn mooring_scope(&self) -> section::mooring::MooringScope<'_> {
        section::mooring::MooringScope { solids: &self.solid, points: &self.mooring_point, types: &self.line_type }
    }

    /// Returns the same scene with one more point in which mooring lines meet.
    pub fn mooring_point(mut self, point: MooringPointConfig) -> Self {
        self.mooring_point.push(point);
        self
    }

    /// Returns the same scene with one more mooring line with mass.
    pub fn mooring(mut self, mooring: MooringConfig) -> Self {
        self.mooring.push(mooring);
        self
    }

    /// Returns the same scene with one more prescribed force.
    pub fn force(mut self, force: ForceConfig) -> Self {
        self.force.push(force);
        self
    }

    /// Returns the same scene with contact properties of one more pair.
    pub fn contact(mut self, contact: ContactConfig) -> Self {
        self.contact.push(contact);
        self
    }

    /// Returns the same scene with one more number that may be changed during a run.
    pub fn control(mut self, control: ControlConfig) -> Self {
        self.control.push(control);
        self
    }

    /// Reads the scene at `path`, a file or a folder that contains `scene.toml`. `sets` are keys with values that
    /// replace the values of the file, as in `("model.viscosity", "none")` or `("solid.box.free.density", "500")`.
    ///
    /// # Errors
    /// `File` if no scene can be read at `path`; `Scene` with line, column and advice if a key or value is wrong.
    pub fn read(path: &Path, sets: &[(String, String)]) -> Result<Self> {
        let file = if path.is_dir() { path.join("scene.toml") } else { path.to_path_buf() };
        let mut bytes = Vec::new();
        let opened = std::fs::File::open(&file);
        opened.and_then(|opened| opened.take(MOST_TEXT + 1).read_to_end(&mut bytes)).map_err(|e| {
            Error::read(&file, &e)
                .help("name a scene file, or a folder that holds scene.toml; `pontoon scenes` lists some")
        })?;
        if bytes.len() as u64 > MOST_TEXT {
            return Err(Error::scene(format!("{} has more than {MOST_TEXT} bytes", file.display())).help(
                "points and motions of that size belong into tables beside the scene, as in { file = \"hull.csv\" }",
            ));
        }
        let text = utf8_text(&file, bytes)?;
        let folder = file.parent().map_or_else(PathBuf::new, Path::to_path_buf);
        Self::from_toml(&text, &file.display().to_string(), &folder, sets)
    }

    /// Reads a scene from `text`. The files that the scene names must be in `folder`.
    ///
    /// # Errors
    /// `Scene`, as in [`Scene::read`].
    pub fn parse(text: &str, folder: &Path, sets: &[(String, String)]) -> Result<Self> {
        Self::from_toml(text, "scene.toml", folder, sets)
    }

    /// Reads a scene from `text`. Error messages use the file name `file`.
    fn from_toml(text: &str, file: &str, folder: &Path, sets: &[(String, String)]) -> Result<Self> {
        let (mut scene, origin): (Self, SceneSource) = toml_source::read(text, file, folder, sets)?;
        scene.origin = origin;
        scene.require_known_dimension().map(|()| scene)
    }

    /// Returns the name of the device that computes the water, or `None` for the processor.
    pub(crate) fn device_name(&self) -> Option<&str> {
        self.model.device.as_deref().filter(|name| *name != PROCESSOR)
    }

    /// Returns the keys that replaced those of the file, in their order, with numbers in place of names.
    #[cfg(feature = "cli")]
    pub(crate) fn override_keys(&self) -> &[String] {
        &self.origin.sets
    }

    /// Returns the keys and values for which the scene uses an old name.
    pub fn renamed_names(&self) -> &[RenamedName] {
        &self.origin.renamed
    }

    /// Returns an error of a simulation of this scene with the file and the line of the key that the error names, if
    /// any.
    pub fn with_location(&self, mut error: Error) -> Error {
        match error.location.take() {
            Some(place) if place.file.is_empty() => self.origin.with_location(error, &self.numbered(place.key)),
            place => Error { location: place, ..error },
        }
    }

    /// Returns the key of a probe by its number in place of its name; other keys unchanged.
    fn numbered(&self, key: String) -> String {
        let name = key.strip_prefix("probe.").filter(|name| name.parse::<usize>().is_err());
        let number = name.and_then(|name| self.probe_names().iter().position(|own| own == name));
        number.map_or(key.clone(), |number| format!("probe.{number}"))
    }

    /// Returns the scene as TOML, for a file or a manifest.
    ///
    /// # Errors
    /// `Scene` if a number cannot be written.
    pub fn to_toml(&self) -> Result<String> {
        toml::to_string(self).map_err(|e| Error::scene(format!("this scene cannot be written: {e}")))
    }
}

/// Returns the text of a scene file.
///
/// # Errors
/// `Scene` if it is not UTF-8: says the encoding, and of single wrong bytes the place.
fn utf8_text(file: &Path, bytes: Vec<u8>) -> Result<String> {
    let is_utf16 = bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) || bytes.contains(&0);
    if is_utf16 {
        let what = format!("{} is in UTF-16, and a scene is in UTF-8", file.display());
        return Err(Error::scene(what).help("save it as UTF-8"));
    }
    String::from_utf8(bytes).map_err(|why| {
        let before = why.utf8_error().valid_up_to();
        let bytes = why.as_bytes();
        let line = bytes[..before].iter().filter(|byte| **byte == b'\n').count() + 1;
        let begin = bytes[..before].iter().rposition(|byte| *byte == b'\n').map_or(0, |at| at + 1);
        let column = String::from_utf8_lossy(&bytes[begin..before]).chars().count() + 1;
        let what = "a character is not in UTF-8, as in a file in Windows-1252";
        let place = file.display().to_string();
        Error::scene(what).help("save the scene as UTF-8").at(place, Some((line, column)), "")
    })
}
