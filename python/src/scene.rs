//! A scene: its origin, its changed keys and its properties.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use pontoon::{
    Result,
    cli::scene_lookup::{FoundScene, find_scene},
    plan::Plan,
    run::{InspectOptions, RunObserver, RunOptions, RunOutcome, copy_text_scene, inspect_scene, run, run_text},
    scene::{PanelledScene, Scene, bundled_scenes},
};
use pyo3::prelude::*;

use crate::{
    error::{OrRaise, usage},
    run::{Ended, watched},
    simulation::{NativeSimulation, hash},
    threads::with_threads,
};

/// The origin of a scene.
#[derive(Clone)]
enum Origin {
    /// A file, or a bundled scene in a temporary folder, and the word with which it was found.
    Found(Arc<FoundScene>, PathBuf),
    /// A text, and the folder of the files that it names.
    Text(String, PathBuf),
}

/// A scene with changed keys. A change returns another scene.
#[pyclass(frozen, module = "pontoon._pontoon")]
pub struct NativeScene {
    origin: Origin,
    overrides: Vec<(String, String)>,
    scene: Scene,
}

impl Origin {
    fn read(&self, overrides: &[(String, String)]) -> Result<Scene> {
        match self {
            Self::Found(found, _) => found.with_scene_name(Scene::read(found.path(), overrides)),
            Self::Text(text, folder) => Scene::parse(text, folder, overrides),
        }
    }

    fn named<T>(&self, outcome: Result<T>) -> Result<T> {
        match self {
            Self::Found(found, _) => found.with_scene_name(outcome),
            Self::Text(..) => outcome,
        }
    }
}

impl NativeScene {
    fn new(origin: Origin, overrides: Vec<(String, String)>) -> Result<Self> {
        let scene = origin.read(&overrides)?;
        Ok(Self { origin, overrides, scene })
    }

    /// Returns the plan of its probes and outputs.
    ///
    /// # Errors
    /// As [`Scene::plan`].
    pub fn plan(&self) -> Result<Plan> {
        self.origin.named(self.scene.plan())
    }

    /// Returns a hash of the effective values without those of outputs, end and guard, which do not change states.
    ///
    /// # Errors
    /// As [`Scene::resolve`].
    fn mark(&self) -> Result<u64> {
        let values = self.origin.named(self.scene.resolve())?;
        let counts = |key: &str| {
            let section = key.split('.').next().unwrap_or_default();
            !["title", "until", "frames", "probe", "check", "statistic", "checkpoint", "control", "guard"]
                .contains(&section)
        };
        let texts = values.iter().filter(|value| counts(&value.key)).flat_map(|value| [&value.key, &value.value]);
        Ok(hash(&texts.map(|text| text.as_bytes()).collect::<Vec<_>>()))
    }

    /// Returns the scene with another solid at its end, written as the keys of a `[[solid]]` section.
    pub fn with_solid(&self, solid: &str) -> Result<Scene> {
        let text = self.text_with([solid])?;
        self.origin.named(Scene::parse(&text, self.folder(), &[]))
    }

    /// Returns the text of the scene with more solids at its end, each written as the keys of a `[[solid]]` section.
    fn text_with<'a>(&self, solids: impl IntoIterator<Item = &'a str>) -> Result<String> {
        let more = solids.into_iter().map(|solid| format!("\n[[solid]]\n{solid}\n"));
        Ok(self.scene.to_toml()? + &more.collect::<String>())
    }

    /// Returns the folder of the files that the scene names.
    fn folder(&self) -> &Path {
        match &self.origin {
            Origin::Found(found, _) if found.path().is_dir() => found.path(),
            Origin::Found(found, _) => found.path().parent().unwrap_or(Path::new("")),
            Origin::Text(_, folder) => folder,
        }
    }
}

#[pymethods]
impl NativeScene {
    /// Reads the scene that `word` means, with changed keys.
    #[staticmethod]
    fn find(py: Python<'_>, word: PathBuf, overrides: Vec<(String, String)>) -> PyResult<Self> {
        let found = find_scene(&word).or_raise(py)?;
        Self::new(Origin::Found(Arc::new(found), word), overrides).or_raise(py)
    }

    /// Reads a scene from `text` with changed keys; the files that it names are in `folder`.
    #[staticmethod]
    fn parse(py: Python<'_>, text: String, folder: PathBuf, overrides: Vec<(String, String)>) -> PyResult<Self> {
        Self::new(Origin::Text(text, folder), overrides).or_raise(py)
    }

    /// Returns the scene with more changed keys.
    fn with_overrides(&self, py: Python<'_>, changes: Vec<(String, String)>) -> PyResult<Self> {
        let mut overrides = self.overrides.clone();
        overrides.retain(|(known, _)| changes.iter().all(|(key, _)| key != known));
        overrides.extend(changes);
        Self::new(self.origin.clone(), overrides).or_raise(py)
    }

    /// Returns the scene with more solids at its end, each written as the keys of a `[[solid]]` section.
    fn with_solids(&self, py: Python<'_>, solids: Vec<String>) -> PyResult<Self> {
        let text = self.text_with(solids.iter().map(String::as_str)).or_raise(py)?;
        Self::new(Origin::Text(text, self.folder().to_owned()), Vec::new()).or_raise(py)
    }

    /// Returns kind ("found" or "text"), word or text, folder, and changed keys: what `find` or `parse` takes.
    fn origin(&self) -> (&'static str, String, String, Vec<(String, String)>) {
        let (kind, content, folder) = match &self.origin {
            Origin::Found(found, word) => {
                let bundled = bundled_scenes().iter().any(|(name, ..)| Path::new(name) == word);
                let there =
                    if found.path().exists() && !bundled { std::fs::canonicalize(found.path()).ok() } else { None };
                ("found", there.unwrap_or_else(|| word.clone()).display().to_string(), String::new())
            }
            Origin::Text(text, folder) => ("text", text.clone(), folder.display().to_string()),
        };
        (kind, content, folder, self.overrides.clone())
    }

    /// Caption.
    #[getter]
    fn title(&self) -> Option<&str> {
        self.scene.title.as_deref()
    }

    /// Dimension, 2 or 3.
    #[getter]
    fn dimension(&self) -> usize {
        self.scene.dimension
    }

    /// Particle spacing, m.
    #[getter]
    fn dp(&self) -> f64 {
        self.scene.dp
    }

    /// Simulated time at the end, s.
    #[getter]
    fn until(&self) -> f64 {
        self.scene.until
    }

    /// Returns the scene as TOML.
    fn to_toml(&self, py: Python<'_>) -> PyResult<String> {
        self.scene.to_toml().or_raise(py)
    }

    /// Returns key, value as TOML, and source of each effective value.
    fn values(&self, py: Python<'_>) -> PyResult<Vec<(String, String, String)>> {
        let values = self.origin.named(self.scene.resolve()).or_raise(py)?;
        Ok(values.into_iter().map(|value| (value.key, value.value, value.source.to_string())).collect())
    }

    /// Checks the scene with the tables that it names, without particles.
    fn check(&self, py: Python<'_>) -> PyResult<()> {
        self.plan().map(drop).or_raise(py)
    }

    /// Writes a scene from a text, without its changed keys, to `folder/scene`, with the files that it names; returns its path.
    /// A scene that was found in a file stays there; returns its file or name.
    fn file(&self, py: Python<'_>, folder: PathBuf) -> PyResult<PathBuf> {
        match &self.origin {
            Origin::Found(..) => Ok(self.origin().1.into()),
            Origin::Text(text, from) => copy_text_scene(text, from, &self.scene, &folder).or_raise(py),
        }
    }

    /// Returns the inspection as JSON.
    fn inspect(&self, py: Python<'_>, threads: Option<usize>, timing: bool) -> PyResult<String> {
        let asked = InspectOptions { overrides: Vec::new(), threads, timing };
        let inspect = || self.origin.named(inspect_scene(&self.scene, &asked));
        let inspection = py.detach(|| with_threads(inspect)).or_raise(py)?;
        serde_json::to_string(&inspection).map_err(|why| usage(py, &why.to_string(), ""))
    }

    /// Writes `bodies.json` and the panels of the solids `solids`, or of all free ones, into the folder `out`; returns the path of
    /// `bodies.json`.
    fn export_bodies(&self, py: Python<'_>, out: PathBuf, solids: Vec<String>, panels: usize) -> PyResult<PathBuf> {
        let export =
            || self.origin.named(PanelledScene::new(&self.scene, &solids, panels)).and_then(|all| all.write(&out));
        py.detach(|| with_threads(export)).or_raise(py)
    }

    /// Builds a simulation.
    fn build(&self, py: Python<'_>, hosted: bool, threads: Option<usize>) -> PyResult<NativeSimulation> {
        let build = || self.origin.named(crate::world::build(&self.scene, hosted));
        py.detach(|| NativeSimulation::new(build, threads, self.mark()?)).or_raise(py)
    }

    /// Runs the scene with its files; `progress` gets folder, time, end, step, number of steps and wall time.
    fn run(
        &self,
        py: Python<'_>,
        out: Option<PathBuf>,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Ended> {
        let options = RunOptions { out, overrides: self.overrides.clone(), threads };
        let job = |watch: &mut dyn RunObserver| -> Result<RunOutcome> {
            self.origin.named(match &self.origin {
                Origin::Found(found, _) => run(found.path(), &options, watch),
                Origin::Text(text, folder) => run_text(text, folder, &options, watch),
            })
        };
        watched(py, job, progress)
    }
}
