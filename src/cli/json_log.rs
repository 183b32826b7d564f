//! `--log json`: what happens to a run, an object a line on standard error, for programs.

use std::{
    path::PathBuf,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    time::{Duration, Instant},
};

use crate::{
    error::Error,
    output::manifest::RunStatus,
    plan::ControlChange,
    run::{EnergyDrift, Progress, RunObserver, RunOutcome, RunStart},
    simulation::Rollback,
    solid::ConstraintEvent,
};
use serde_json::{Value, json};

use super::{print_error, progress::CliObserver};

/// From one line of progress to the next.
const PAUSE: Duration = Duration::from_secs(1);

/// What Ctrl-C is answered with.
pub const STOPPING: &str = "{\"event\":\"stopping\"}\n";

/// Writes what happens to a run.
pub struct JsonLog {
    quiet: bool,
    stop: Arc<AtomicBool>,
    folder: Option<PathBuf>,
    /// When it began, and at which simulated time (s).
    begun: Option<(Instant, f64)>,
    next: Option<Instant>,
    warnings: usize,
}

impl JsonLog {
    /// Writes nothing if `quiet`; asks the run to stop once `stop` is raised.
    pub fn new(quiet: bool, stop: Arc<AtomicBool>) -> Self {
        Self { quiet, stop, folder: None, begun: None, next: None, warnings: 0 }
    }
}

impl CliObserver for JsonLog {
    fn close(&mut self) -> Option<PathBuf> {
        self.folder.take()
    }

    fn live_address(&mut self, address: &str) {
        write_event(&json!({ "event": "live_page", "address": address }));
    }
}

impl RunObserver for JsonLog {
    fn start(&mut self, start: &RunStart) {
        let manifest = start.manifest;
        self.folder = Some(start.folder.to_owned());
        self.warnings = manifest.warnings.len();
        if self.quiet {
            return;
        }
        write_event(&json!({
            "event": "start", "folder": start.folder, "title": manifest.title, "water": manifest.particles.fluid,
            "boundary": manifest.particles.boundary, "threads": manifest.threads, "until_s": manifest.until_s,
        }));
        manifest.warnings.iter().for_each(|text| warn(text));
        for note in &manifest.notes {
            write_event(&json!({ "event": "note", "text": note }));
        }
        for name in start.renamed {
            write_event(&json!({ "event": "note", "text": name.to_string() }));
        }
    }

    fn rolled_back(&mut self, how: &Rollback) {
        self.warnings += 1;
        if !self.quiet {
            warn(&how.to_string());
        }
    }

    fn event(&mut self, event: &ConstraintEvent) {
        if !self.quiet {
            write_event(&json!({ "event": "note", "t_s": event.time, "text": event.to_string() }));
        }
    }

    fn control_changed(&mut self, change: &ControlChange) {
        if !self.quiet {
            write_event(&json!({ "event": "note", "t_s": change.time, "text": change.to_string() }));
        }
    }

    fn step(&mut self, now: &Progress) -> bool {
        let clock = Instant::now();
        let (begun, first) = *self.begun.get_or_insert((clock, now.time));
        if !self.quiet && (self.next.is_none_or(|next| clock >= next) || now.time >= now.until) {
            self.next = Some(clock + PAUSE);
            let (wall, done) = (begun.elapsed().as_secs_f64(), now.time - first);
            let left = (done > 0.0).then(|| wall * (now.until - now.time) / done);
            let mut event = json!({
                "event": "progress", "t_s": now.time, "until_s": now.until, "dt_s": now.dt, "steps": now.steps,
                "wall_s": now.wall, "left_s": left, "particle_steps_per_second": now.rate, "warnings": self.warnings,
            });
            match now.energy {
                Some(EnergyDrift::Unaccounted(share)) => event["energy_residual"] = json!(share),
                Some(EnergyDrift::Changed(energy, unit)) => {
                    event[if unit == "J" { "energy_change_J" } else { "energy_change_J_per_m" }] = json!(energy);
                }
                None => {}
            }
            write_event(&event);
        }
        !self.stop.load(Ordering::Relaxed)
    }
}

/// A warning.
pub fn warn(text: &str) {
    write_event(&json!({ "event": "warning", "text": text }));
}

/// How a run ended.
pub fn ended(outcome: &RunOutcome) {
    let manifest = &outcome.manifest;
    let status = match manifest.status {
        RunStatus::Finished => "finished",
        RunStatus::Interrupted => "interrupted",
        RunStatus::Running | RunStatus::Failed => "failed",
    };
    write_event(&json!({
        "event": "end", "status": status, "folder": outcome.folder, "t_s": manifest.simulated_s, "steps": manifest.steps,
        "wall_s": manifest.wall_s, "missed_checks": outcome.has_failed_checks(),
        "frames": manifest.frames.count, "frames_bytes": manifest.frames.bytes,
    }));
}

/// Why there is no end.
pub fn failed(error: &Error) {
    write_event(&json!({ "event": "error", "code": error.code(), "text": error.to_string() }));
}

fn write_event(event: &Value) {
    print_error(&format!("{event}\n"));
}
