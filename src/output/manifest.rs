//! The manifest, `manifest.json` in the run's folder: it records the run, its inputs and its result.

use std::{collections::BTreeMap, path::Path};

use serde::{Deserialize, Serialize};

use super::write_atomically;
use crate::{
    analysis::Verdict,
    error::{Error, ErrorCode, ErrorKind, Fault, Result},
    math::simd,
};

/// The manifest of a run. Other programs read its keys, so new versions may add keys but must not rename any.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// Status of the run.
    pub status: RunStatus,
    /// Caption of the scene.
    pub title: String,
    /// Version of this crate.
    pub version: String,
    /// Commit of this crate's source, if the build could determine it; "…, changed" if the source differs from the
    /// commit.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub commit: Option<String>,
    /// Name and version of the engine that moves the bodies.
    pub engine: String,
    /// Threads used, of each rank.
    pub threads: usize,
    /// Figures of the exchange between the ranks, if the run has several.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub ranks: Option<ExchangeFigures>,
    /// Numbers of particles of each kind.
    pub particles: ParticleCounts,
    /// Number of water particles that left the domain and were removed.
    #[serde(default)]
    pub removed: usize,
    /// Number of completed steps.
    pub steps: u64,
    /// Simulated time, s.
    pub simulated_s: f64,
    /// Requested simulated time, s.
    pub until_s: f64,
    /// Wall time of the whole run, s.
    pub wall_s: f64,
    /// Processor time of the whole run, summed over all threads, s.
    #[serde(default)]
    pub cpu_s: f64,
    /// (Water particles + boundary particles next to water) × force passes, summed over the steps.
    #[serde(default)]
    pub particle_steps: u64,
    /// (Water particles + boundary particles next to water) × force passes ÷ wall time of stepping, 1/s.
    pub particle_steps_per_second: f64,
    /// Verdicts on the run from its checks against references.
    pub checks: Vec<Verdict>,
    /// Files in the run's folder.
    pub files: Vec<String>,
    /// Frames on the disk.
    #[serde(default)]
    pub frames: FrameTotals,
    /// Reason for the failure of the run, as text.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub error: Option<String>,
    /// Error code of the family of that error.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub error_code: Option<String>,
    /// Particle or body that caused the failure.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub fault: Option<serde_json::Value>,
    /// Warnings at the start of the run.
    pub warnings: Vec<String>,
    /// Notes on the layout and the span of the tables that the scene names.
    #[serde(default)]
    pub notes: Vec<String>,
    /// Joints, springs, ropes and solids that began, ended or broke during the run, with the times.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub events: Vec<String>,
    /// The computer that executed the run.
    pub machine: Machine,
    /// Scene keys that were changed for this run, and their values.
    pub set: BTreeMap<String, String>,
    /// All values of the run, including defaults.
    pub values: Vec<ValueInForce>,
    /// The scene with the changed keys, as TOML.
    pub scene: String,
}

/// A value that the run uses.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ValueInForce {
    /// The scene's key.
    pub key: String,
    /// Its value.
    pub value: String,
    /// Source of the value: a line of the scene, the command line, or a default with its reason.
    pub source: String,
}

/// Status of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RunStatus {
    /// The run is active, or the process was killed.
    Running,
    /// The run reached its end time.
    Finished,
    /// The run stopped on request, and left a checkpoint.
    Interrupted,
    /// The run failed.
    Failed,
}

/// What the first rank exchanged with the others since the run began or was resumed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ExchangeFigures {
    /// Number of ranks.
    pub count: usize,
    /// Received from the others, B.
    pub received_bytes: u64,
    /// Share of the wall time in exchanges, with the wait for slower ranks, –.
    pub time_share: f64,
}

/// Numbers of particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ParticleCounts {
    /// Number of water particles.
    pub fluid: usize,
    /// Number of boundary particles of all solids.
    pub boundary: usize,
}

/// Frames on the disk.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct FrameTotals {
    /// Number of frames.
    pub count: usize,
    /// Size of all frames, B.
    pub bytes: u64,
}

/// The computer that executed the run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Machine {
    /// Operating system.
    pub os: String,
    /// Processor family.
    pub arch: String,
    /// Processor name, if the system reports it.
    #[serde(default)]
    pub processor: String,
    /// Instruction set that the fast particle sweep uses; `None` if the processor has no suitable instruction set.
    #[serde(default)]
    pub instructions: Option<String>,
    /// Number of processors available to this program.
    pub cpus: usize,
}

impl Machine {
    /// Returns a description of this computer.
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
    /// Returns the number of threads, and of ranks if there are several, as a text.
    #[cfg(feature = "cli")]
    pub(crate) fn workers(&self) -> String {
        let threads = format!("{} thread{}", self.threads, if self.threads == 1 { "" } else { "s" });
        match self.ranks {
            Some(ranks) => format!("{} ranks of {threads}", ranks.count),
            None => threads,
        }
    }

    /// Returns the numeric value with the scene key `key`, or `None` if the key has no numeric value.
    pub fn numeric_value(&self, key: &str) -> Option<f64> {
        self.values.iter().find(|value| value.key == key)?.value.parse().ok()
    }

    /// Records the failure of the run with `error`.
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

    /// Reads `manifest.json` from `folder`.
    ///
    /// # Errors
    /// `Restart` if the file does not exist or is not a manifest of this program.
    pub fn read(folder: &Path) -> Result<Self> {
        let path = folder.join("manifest.json");
        let text = std::fs::read_to_string(&path).map_err(|why| {
            Error::new(ErrorKind::Restart, format!("{} holds no run: {}: {why}", folder.display(), path.display()))
                .with_code(ErrorCode::CheckpointNotFound)
                .help("name the folder of a run, such as runs/raft")
        })?;
        serde_json::from_str(&text).map_err(|why| {
            Error::new(ErrorKind::Restart, format!("{} is damaged, or of another version: {why}", path.display()))
                .help("put a whole one in its place, or start the run afresh with `pontoon run`")
        })
    }
}
