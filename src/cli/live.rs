//! `--live`: the page of a run in progress, served on the loopback address, with buttons that pause the run, let it go on
//! and write a checkpoint.
//!
//! Whoever asks needs the token of the address, has to name the loopback address as host, and may not come from a page of
//! another origin. The history is in the run's files, so that the memory of the server does not grow with the run.

mod http;
mod observer;
mod server;
mod token;

pub use observer::LiveObserver;
pub use server::LiveServer;

use std::{
    sync::{
        Arc, Condvar, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
    time::Duration,
};

use serde_json::{Value, json};

use crate::run::{Control, Progress, RunRequest};

/// How often a paused run looks whether Ctrl-C was pressed.
const LOOK: Duration = Duration::from_millis(100);

/// What a run and its live pages share.
pub struct LiveState {
    now: Mutex<LiveNow>,
    /// Notified when the page has something to show at once, or the run something to do.
    changed: Condvar,
    /// Whether the run is to stop, as Ctrl-C asks.
    stop: Arc<AtomicBool>,
}

/// The state of a run for its live pages.
#[derive(Default)]
struct LiveNow {
    progress: Option<Progress>,
    paused: bool,
    /// Whether the run waits between two steps.
    held: bool,
    requests: Vec<RunRequest>,
    /// The numbers that may be changed.
    controls: Vec<Control>,
    /// The number of rollbacks since the start.
    rollbacks: usize,
    /// The simulated time of the last checkpoint that a page asked for, s.
    checkpoint: Option<f64>,
    /// How the run ended.
    ended: Option<Value>,
}

impl LiveState {
    /// The state before a run, which Ctrl-C stops by `stop`.
    pub fn new(stop: Arc<AtomicBool>) -> Self {
        Self { now: Mutex::default(), changed: Condvar::new(), stop }
    }

    fn lock(&self) -> MutexGuard<'_, LiveNow> {
        self.now.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Changes the state by `change` and wakes whoever waits for that.
    fn change(&self, change: impl FnOnce(&mut LiveNow)) {
        change(&mut self.lock());
        self.changed.notify_all();
    }

    /// Waits for a change, at most so long.
    fn wait(&self, most: Duration) {
        drop(self.changed.wait_timeout(self.lock(), most));
    }

    /// Returns what the run is to do before its next step; waits while it is paused.
    fn next_request(&self) -> Option<RunRequest> {
        let mut now = self.lock();
        let request = loop {
            if self.stop.load(Ordering::Relaxed) {
                break now.paused.then_some(RunRequest::Stop);
            }
            if !now.requests.is_empty() {
                break Some(now.requests.remove(0));
            }
            if !now.paused {
                break None;
            }
            if !now.held {
                now.held = true;
                self.changed.notify_all();
            }
            now = self.changed.wait_timeout(now, LOOK).map_or_else(|poisoned| poisoned.into_inner().0, |(now, _)| now);
        };
        now.held = false;
        request
    }
}

impl LiveNow {
    /// Adds a request; one of the same kind that still waits is replaced, so that they do not gather.
    fn request(&mut self, request: RunRequest) {
        let same = |other: &RunRequest| match (other, &request) {
            (RunRequest::Set { control: a, .. }, RunRequest::Set { control: b, .. }) => a == b,
            (a, b) => a == b,
        };
        self.requests.retain(|other| !same(other));
        self.requests.push(request);
    }

    /// Returns the state for the scripts of the page.
    fn to_json(&self) -> Value {
        let control = |Control { plan, value }: &Control| json!({ "key": plan.key, "unit": plan.unit, "min": plan.min, "max": plan.max, "value": value });
        let controls: Vec<Value> = self.controls.iter().map(control).collect();
        let mut state = json!({
            "paused": self.paused, "held": self.held, "checkpoint": self.checkpoint, "controls": controls,
        });
        if let Some(now) = &self.progress {
            state["t"] = json!(now.time);
            state["until"] = json!(now.until);
            state["dt"] = json!(now.dt);
            state["steps"] = json!(now.steps);
            state["rate"] = json!(now.rate);
            state["energy"] = json!(now.energy.map(|drift| drift.to_string()));
        }
        state
    }
}
