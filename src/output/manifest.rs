//! The manifest: what ran, with what, and how it ended. `manifest.json` in the run's folder.

use std::{collections::BTreeMap, path::Path};

use serde::{Deserialize, Serialize};

use super::write_atomically;
use crate::{
    analysis::Verdict,
    error::{Error, ErrorCode, ErrorKind, Fault, Result},
    math::simd,
};

/// The manifest of a run. Its keys are read by other programs: add some, rename none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// How the run stands.
    pub status: RunStatus,
    /// Caption of the scene.
    pub title: String,
    /// Version of this crate.
    pub version: String,
    /// Commit of this crate's source, where the build could tell; "…, changed" if the source was not quite that.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub commit: Option<String>,
    /// Name and version of the engine that moves the bodies.
    pub engine: String,
    /// Threads used.
    pub threads: usize,
    /// How many particles of each sort.
    pub particles: ParticleCounts,
    /// Water particles that left the domain and were taken out.
    #[serde(default)]
    pub removed: usize,
    /// Steps done.
    pub steps: u64,
    /// Simulated time, s.
    pub simulated_s: f64,
    /// Simulated time asked for, s.
    pub until_s: f64,
    /// Wall time of the whole run, s.
    pub wall_s: f64,
    /// Processor time of the whole run, all threads together, s.
    #[serde(default)]
    pub cpu_s: f64,
    /// Water and boundary particles beside it × force passes, summed over the steps.
    #[serde(default)]
    pub particle_steps: u64,
    /// Water and boundary particles beside it × force passes ÷ wall time of stepping, 1/s.
    pub particle_steps_per_second: f64,
    /// The run against its references.
    pub checks: Vec<Verdict>,
    /// Files in the run's folder.
    pub files: Vec<String>,
    /// Frames that were kept.
    #[serde(default)]
    pub frames: FrameTotals,
    /// Why the run failed, in words.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub error: Option<String>,
    /// The identifier of the family of that error.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub error_code: Option<String>,
    /// With which particle or body the run failed.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub fault: Option<serde_json::Value>,
    /// Remarks made at the start.
    pub warnings: Vec<String>,
    /// The computer.
    pub machine: Machine,
    /// Keys of the scene changed for this run.
    pub set: BTreeMap<String, String>,
    /// Every value in force, the defaults too.
    pub values: Vec<ValueInForce>,
    /// The scene with those changes, as TOML.
    pub scene: String,
}

/// A value in force.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ValueInForce {
    /// The scene's key.
    pub key: String,
    /// Its value.
    pub value: String,
    /// Who said so: a line of the scene, the command line, or a default with its reason.
    pub source: String,
}

/// How a run stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RunStatus {
    /// It goes on, or was killed.
    Running,
    /// It reached its end.
    Finished,
    /// It was asked to stop, and left a checkpoint.
    Interrupted,
    /// It could not go on.
    Failed,
}

/// Numbers of particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ParticleCounts {
    /// Of the water.
    pub fluid: usize,
    /// Of all skins.
    pub boundary: usize,
}

/// Frames on the disk.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct FrameTotals {
    /// How many.
    pub count: usize,
    /// What they take, B.
    pub bytes: u64,
}

/// The computer that ran it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Machine {
    /// Operating system.
    pub os: String,
    /// Processor family.
    pub arch: String,
    /// Processor, where the system tells.
    #[serde(default)]
    pub processor: String,
    /// Instructions that the fast sweep uses; none if the processor has none for it.
    #[serde(default)]
    pub instructions: Option<String>,
    /// Processors that this program may use.
    pub cpus: usize,
}

impl Machine {
    /// This computer.
    pub fn current() -> Self {
        let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let model = info.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": ").map(|m| m.1));
        Self {
            os: std::env::consts::OS.into(),
            arch: std::env::consts::ARCH.into(),
            processor: model.unwrap_or_default().trim().into(),
            instructions: simd::best_instruction_set().map(simd::instruction_set_name),
            cpus: std::thread::available_parallelism().map_or(1, |n| n.get()),
        }
    }
}

impl Manifest {
    /// A number in force, by its key in the scene.
    pub fn numeric_value(&self, key: &str) -> Option<f64> {
        self.values.iter().find(|value| value.key == key)?.value.parse().ok()
    }

    /// Notes that the run failed with `error`.
    pub fn record_failure(&mut self, error: &Error) {
        self.status = RunStatus::Failed;
        self.error = Some(error.to_string());
        self.error_code = Some(error.code().to_string());
        self.fault = error.fault.as_deref().and_then(|fault: &Fault| serde_json::to_value(fault).ok());
    }

    /// Writes `manifest.json` into `folder`.
    ///
    /// # Errors
    /// `File` if it cannot be written.
    pub fn write(&self, folder: &Path) -> Result<()> {
        let path = folder.join("manifest.json");
        let text = serde_json::to_string_pretty(self).map_err(|e| Error::file(&path, e))?;
        write_atomically(&path, (text + "\n").as_bytes())
    }

    /// Reads `manifest.json` in `folder`.
    ///
    /// # Errors
    /// `Restart` if there is none or it is not one of this program's.
    pub fn read(folder: &Path) -> Result<Self> {
        let path = folder.join("manifest.json");
        let text = std::fs::read_to_string(&path).map_err(|why| {
            Error::new(ErrorKind::Restart, format!("{} holds no run: {}: {why}", folder.display(), path.display()))
                .with_code(ErrorCode::CheckpointNotFound)
                .help("name the folder of a run, as in `pontoon resume runs/raft`")
        })?;
        serde_json::from_str(&text).map_err(|why| {
            Error::new(ErrorKind::Restart, format!("{} is damaged, or of another version: {why}", path.display()))
                .help("put a whole one in its place, or start the run afresh with `pontoon run`")
        })
    }
}
