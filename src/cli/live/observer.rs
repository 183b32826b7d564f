//! An observer that passes a run on to its live pages, and their requests to the run.

use std::{path::PathBuf, sync::Arc};

use super::{LiveServer, LiveState};
use crate::{
    cli::{print_error, progress::CliObserver},
    plan::ControlChange,
    run::{Progress, RunObserver, RunRequest, RunStart},
    simulation::Rollback,
    solid::ConstraintEvent,
};

/// Follows a run for its live pages, beside the observer that follows it in the terminal.
pub struct LiveObserver {
    inner: Box<dyn CliObserver>,
    state: Arc<LiveState>,
    server: LiveServer,
    /// The folder of the run before the server answers.
    folder: Option<PathBuf>,
    /// The simulated time of the checkpoint that is being written, s.
    writing: Option<f64>,
}

impl LiveObserver {
    /// Passes everything on to `inner` and lets `server` answer once the run has begun.
    pub fn new(inner: Box<dyn CliObserver>, server: LiveServer) -> Self {
        Self { inner, state: server.state(), server, folder: None, writing: None }
    }
}

impl CliObserver for LiveObserver {
    fn close(&mut self) -> Option<PathBuf> {
        self.inner.close()
    }

    fn live_address(&mut self, address: &str) {
        self.inner.live_address(address);
    }
}

impl RunObserver for LiveObserver {
    fn start(&mut self, start: &RunStart) {
        self.inner.start(start);
        self.state.lock().controls = start.controls.to_vec();
        self.folder = Some(start.folder.to_owned());
        self.inner.live_address(&self.server.address());
    }

    fn rolled_back(&mut self, how: &Rollback) {
        self.state.change(|now| now.rollbacks += 1);
        self.inner.rolled_back(how);
    }

    fn event(&mut self, event: &ConstraintEvent) {
        self.inner.event(event);
    }

    fn control_changed(&mut self, change: &ControlChange) {
        self.state.change(|now| {
            if let Some(control) = now.controls.get_mut(change.control) {
                control.value = change.value;
            }
        });
        self.inner.control_changed(change);
    }

    fn step(&mut self, now: &Progress) -> bool {
        self.state.lock().progress = Some(*now);
        self.inner.step(now)
    }

    fn request(&mut self) -> Option<RunRequest> {
        // The first outputs are written before the first request.
        if let Some(folder) = self.folder.take()
            && let Err(why) = self.server.serve(&folder)
        {
            print_error(&format!("warning: the live page is not served: {why}\n"));
        }
        if let Some(t) = self.writing.take() {
            self.state.change(|now| now.checkpoint = Some(t));
        }
        let request = self.state.next_request();
        if request == Some(RunRequest::Checkpoint) {
            self.writing = self.state.lock().progress.map(|now| now.time);
        }
        request
    }
}
