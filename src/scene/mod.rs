//! What the user says: the words of a scene, read, checked and made into a simulation.
//!
//! [`format`], [`bodies`] and [`links`] are the words, [`document`] reads them from TOML, `verify`, `solids` and `checks`
//! hold them against one another, [`resolve`] fills in the defaults, [`build`] opens the files that they name.

mod absorb;
pub mod bodies;
pub mod build;
mod build_links;
mod build_solids;
mod build_waves;
mod checks;
mod damping;
mod document;
mod drawing;
mod driven;
pub mod flexible;
pub mod flow;
pub mod format;
mod geometry;
mod guard;
mod mesh;
pub mod links;
pub mod resolve;
mod schema;
mod sets;
pub mod shipped;
mod size;
mod solids;
pub mod statistics;
pub mod table;
pub mod values;
mod verify;
mod verify_links;
mod waves;
mod verify_probes;
mod wording;

pub use crate::plan::{Align, CheckPlan, FramesPlan, Plan, Reference, Score, StatisticKind, StatisticPlan};
pub use crate::{
    math::{BoxConfig, NumberOrArray},
    probe::{
        GaugeConfig, GaugeSurface, PatchConfig, PointRowConfig, PointsConfig, ProbeConfig, ProbeKind, ProbePlan,
        SectionConfig,
    },
};
pub use absorb::{AbsorbChoice, AbsorptionConfig};
pub use bodies::{
    AxisName, CompoundPartConfig, DrivenConfig, FreeBodyConfig, MeshConfig, MotionMode, PlacementConfig, ShapeConfig,
    SolidConfig, TimeFunctionConfig,
};
pub(crate) use build::SceneLayout;
pub use build::{BuiltScene, StillWaterLevel};
pub use damping::DampingConfig;
pub use document::ValueSource;
pub use flexible::{
    DraftChoice, FieldFormulaConfig, FramesChoice, FramesConfig, LengthUnit, LimitsConfig, PolylineConfig,
};
pub use flow::PeriodicConfig;
pub use format::{CheckConfig, CheckpointConfig, FillConfig, ModelConfig, Scene, TimeSteppingConfig, WaterConfig};
pub(crate) use geometry::world_bounds;
pub use guard::GuardConfig;
pub use links::{
    ContactConfig, ForceConfig, ForceFrame, JointConfig, JointKindConfig, MotorConfig, RopeConfig, SpringConfig,
};
pub use resolve::ResolvedValue;
pub use schema::schema;
pub use shipped::{BundledScene, bundled_scenes};
pub use size::SizeEstimate;
pub use statistics::{RaoConfig, StatisticConfig};
pub use values::{TimeValueConfig, TimeVectorConfig};
pub use waves::{
    FocusedWaveConfig, IrregularWaveConfig, MeasuredElevationConfig, RegularWaveConfig, SolitaryWaveConfig,
    WaveComponentsConfig, WaveConfig,
};

use std::{
    io::Read,
    path::{Path, PathBuf},
};

use crate::error::{Error, Result};

/// Most bytes of a scene's text; the longest of those shipped has 3,000.
const MOST_TEXT: u64 = 1 << 20;

impl Scene {
    /// Reads the scene at `path`, a file or a folder that holds `scene.toml`; `sets` are keys and values
    /// that win over the file, as in `("model.viscosity", "none")` or `("solid.box.free.density", "500")`.
    ///
    /// # Errors
    /// `File` if nothing can be read there; `Scene` with line, column and advice if the words are wrong.
    pub fn read(path: &Path, sets: &[(String, String)]) -> Result<Self> {
        let file = if path.is_dir() { path.join("scene.toml") } else { path.to_path_buf() };
        let mut text = String::new();
        let opened = std::fs::File::open(&file);
        opened.and_then(|opened| opened.take(MOST_TEXT + 1).read_to_string(&mut text)).map_err(|e| {
            Error::file(&file, e)
                .help("name a scene file, or a folder that holds scene.toml; `pontoon scenes` lists some")
        })?;
        if text.len() as u64 > MOST_TEXT {
            return Err(Error::scene(format!("{} has more than {MOST_TEXT} bytes", file.display())).help(
                "points and motions of that size belong into tables beside the scene, as in { file = \"hull.csv\" }",
            ));
        }
        let folder = file.parent().map_or_else(PathBuf::new, Path::to_path_buf);
        document::read(&text, &file.display().to_string(), &folder, sets)
    }

    /// Reads a scene from `text`; the files that it names are looked for in `folder`.
    ///
    /// # Errors
    /// `Scene`, as [`Scene::read`].
    pub fn parse(text: &str, folder: &Path, sets: &[(String, String)]) -> Result<Self> {
        document::read(text, "scene.toml", folder, sets)
    }

    /// An error of a simulation that this scene was built into, with the file and the line of the key that it speaks of, if it
    /// speaks of one.
    pub fn with_location(&self, mut error: Error) -> Error {
        match error.place.take() {
            Some(place) if place.file.is_empty() => self.origin.with_location(error, &place.key),
            place => Error { place, ..error },
        }
    }

    /// The scene as TOML, for a file or a manifest.
    ///
    /// # Errors
    /// `Scene` if a number cannot be written.
    pub fn to_toml(&self) -> Result<String> {
        toml::to_string(self).map_err(|e| Error::scene(format!("this scene cannot be written: {e}")))
    }
}
