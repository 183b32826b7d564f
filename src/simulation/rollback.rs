//! Rollback: after the first alarm of a guard the simulation returns to a stored valid state and halves its steps for a while. If
//! an alarm occurs in this time, the run stops and reports this alarm.
//!
//! Without an alarm no bit of the results changes: the states are only stored.

use std::{
    fmt,
    fs::{self, File},
    io::{self, BufWriter, Read as _, Seek as _, Write},
    path::{Path, PathBuf},
    sync::atomic::{AtomicUsize, Ordering},
};

use serde::{Deserialize, Serialize};

use crate::ranks::Ranks;

/// Steps between two stored states. Storing a state takes about as long as a step, so this costs less than 1 %.
const EVERY: u64 = 500;

/// Steps that a state must be older than the alarm; a younger one may already be wrong.
const AGE: u64 = 100;

/// Largest number of rollbacks of a run; at the next alarm the run stops.
const MOST: usize = 3;

/// Number of files made so far: ranks on one machine share a folder, and ranks in one process a process number.
static CREATED: AtomicUsize = AtomicUsize::new(0);

/// One time that a run was rescued.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rollback {
    /// What the guard said.
    pub alarm: String,
    /// When it said so, s.
    pub at: f64,
    /// To when the run went back, s.
    pub back_to: f64,
    /// Until when the step is halved, s.
    pub halved_until: f64,
}

impl fmt::Display for Rollback {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { alarm, back_to, halved_until, .. } = self;
        write!(f, "{alarm}: went back to {back_to:.6} s, and takes half the step until {halved_until:.6} s")
    }
}

/// Bytes that gather before they are written.
const BUFFER: usize = 1 << 16;

/// The bytes of a stored state.
pub(super) enum StoredState {
    /// In memory.
    Memory(Vec<u8>),
    /// In a file without a name, which the system deletes with its handle, even if the program is killed.
    File(File),
}

impl StoredState {
    /// Stores in `folder` the state that `write` writes.
    pub(super) fn in_folder(folder: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<Self> {
        let number = CREATED.fetch_add(1, Ordering::Relaxed);
        let path = folder.join(format!("rollback-{}-{number}.part", std::process::id()));
        let file = File::options().read(true).write(true).create(true).truncate(true).open(&path)?;
        fs::remove_file(&path)?;
        let mut out = BufWriter::with_capacity(BUFFER, file);
        write(&mut out)?;
        Ok(Self::File(out.into_inner().map_err(io::IntoInnerError::into_error)?))
    }

    /// The bytes.
    fn into_bytes(self) -> io::Result<Vec<u8>> {
        match self {
            Self::Memory(bytes) => Ok(bytes),
            Self::File(mut file) => {
                let mut bytes = Vec::new();
                file.rewind()?;
                file.read_to_end(&mut bytes)?;
                Ok(bytes)
            }
        }
    }
}

/// The state to go back to. If the first rank has a state of all water, every rank gets that state; otherwise each rank keeps its
/// `own`, if all ranks could read theirs. Empty if there is no state. A state of the water of one rank begins with the byte 1.
pub(super) fn shared_state(ranks: &Ranks, own: Vec<u8>) -> Vec<u8> {
    let all = ranks.gather_words([u32::from(!own.is_empty()), u32::from(own.first() == Some(&1))]);
    match all[0][1] {
        0 => ranks.gather_bytes(&own).swap_remove(0),
        _ if all.iter().all(|[is_there, _]| *is_there == 1) => own,
        _ => Vec::new(),
    }
}

/// The stored states, and the rollbacks so far.
#[derive(Default)]
pub(super) struct RollbackControl {
    off: bool,
    /// Where the states are stored; in memory if there is no folder.
    pub(super) folder: Option<PathBuf>,
    /// The last two states, the older first: step, time, bytes.
    states: Vec<(u64, f64, StoredState)>,
    /// What happened so far.
    pub(super) log: Vec<Rollback>,
}

impl RollbackControl {
    /// None, ever.
    pub(super) fn disabled() -> Self {
        Self { off: true, ..Self::default() }
    }

    /// Whether a state must be stored after `steps` steps.
    pub(super) fn needs_state(&self, steps: u64) -> bool {
        !self.off && (self.states.is_empty() || steps.is_multiple_of(EVERY))
    }

    /// Whether states are stored at all.
    #[cfg(feature = "gpu")]
    pub(super) fn is_on(&self) -> bool {
        !self.off
    }

    /// Whether a state of `time` (s) is stored.
    pub(super) fn has_state_at(&self, time: f64) -> bool {
        self.states.iter().any(|(_, at, _)| *at == time)
    }

    /// Discards the stored states of another course of the run; `log` has the rollbacks before.
    pub(super) fn restart(&mut self, log: Vec<Rollback>) {
        (self.states, self.log) = (Vec::new(), log);
    }

    /// Makes room for another state: at most two are in memory at a time.
    pub(super) fn drop_oldest_state(&mut self) {
        if self.states.len() == 2 {
            self.states.remove(0);
        }
    }

    /// Keeps the `state` of `steps` steps and `time` (s).
    pub(super) fn store(&mut self, steps: u64, time: f64, state: StoredState) {
        self.states.push((steps, time, state));
    }

    /// The state to go back to after an `alarm` at time `time` (s), `steps` steps into the run: the result of `shared` for the
    /// stored state, which is empty if its file cannot be read. `None` if the result is empty, or if no further rollback is
    /// allowed.
    pub(super) fn state_before(
        &mut self,
        alarm: &str,
        steps: u64,
        time: f64,
        shared: impl FnOnce(Vec<u8>) -> Vec<u8>,
    ) -> Option<Vec<u8>> {
        let again = self.log.last().is_some_and(|last| time <= last.halved_until);
        if again || self.log.len() >= MOST {
            return None;
        }
        let old = self.states.iter().rposition(|(at, ..)| at + AGE <= steps).unwrap_or(0);
        self.states.truncate(old + 1);
        let (_, back_to, state) = self.states.pop()?;
        let bytes = shared(state.into_bytes().unwrap_or_default());
        if bytes.is_empty() {
            return None;
        }
        // As long again beyond the alarm as the way back.
        let halved_until = time + (time - back_to);
        self.log.push(Rollback { alarm: alarm.into(), at: time, back_to, halved_until });
        Some(bytes)
    }

    /// What part of the step is taken at `time` (s), –.
    pub(super) fn step_factor(&self, time: f64) -> f64 {
        if self.log.last().is_some_and(|last| time < last.halved_until) { 0.5 } else { 1.0 }
    }
}

#[cfg(test)]
#[path = "../../tests/unit/simulation/rollback.rs"]
mod tests;
