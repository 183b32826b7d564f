//! Progress: a bar on a terminal, now and then a line elsewhere.

use std::{
    path::PathBuf,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    time::{Duration, Instant},
};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use pontoon::{
    run::{Progress, Start, Watch},
    simulation::Rescued,
};

use super::{complain, report};

/// Follows a run for the user, and passes on the wish to stop.
pub struct Follow {
    quiet: bool,
    stop: Arc<AtomicBool>,
    bar: ProgressBar,
    /// The folder of the run that has begun.
    folder: Option<PathBuf>,
    /// Since when, in wall and simulated time (s), and at which step.
    begun: Option<(Instant, f64, u64)>,
    next: Option<Instant>,
}

/// Someone who follows a run for the user.
pub trait Follower: Watch {
    /// Ends what is shown; the folder of the run, if one has begun.
    fn close(&mut self) -> Option<PathBuf>;
}

impl Follower for Follow {
    fn close(&mut self) -> Option<PathBuf> {
        self.bar.finish_and_clear();
        self.folder.take()
    }
}

impl Follow {
    /// Shows nothing if `quiet`; asks the run to stop once `stop` is raised.
    pub fn new(quiet: bool, stop: Arc<AtomicBool>) -> Self {
        let target = if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        let bar = ProgressBar::with_draw_target(Some(1000), target);
        if let Ok(style) = ProgressStyle::with_template("{bar:24} {percent:>3} %  {msg}") {
            bar.set_style(style);
        }
        Self { quiet, stop, bar, folder: None, begun: None, next: None }
    }

    fn line(&self, now: &Progress) -> String {
        let (begun, first, steps) = self.begun.unwrap_or((Instant::now(), now.time, now.steps));
        let (wall, done) = (begun.elapsed().as_secs_f64(), now.time - first);
        let mut line = format!("t = {:.3} of {} s, step {}", now.time, now.until, now.steps);
        if now.steps > steps && wall > 0.0 {
            line += &format!(", {} steps/s", report::short((now.steps - steps) as f64 / wall));
            line += &format!(", {} particle-steps/s", report::short(now.rate));
        }
        if done > 0.0 {
            line += &format!(", {} left", report::duration(wall * (now.until - now.time) / done));
        }
        line
    }
}

impl Watch for Follow {
    fn start(&mut self, start: &Start) {
        self.folder = Some(start.folder.to_owned());
        if !self.quiet {
            complain(&report::started(start));
        }
    }

    fn rescued(&mut self, how: &Rescued) {
        if !self.quiet {
            self.bar.suspend(|| complain(&format!("warning: {how}\n")));
        }
    }

    fn step(&mut self, now: &Progress) -> bool {
        let clock = Instant::now();
        self.begun.get_or_insert((clock, now.time, now.steps));
        if !self.quiet && self.next.is_none_or(|next| clock >= next) {
            if self.bar.is_hidden() {
                complain(&format!("{}\n", self.line(now)));
                // The first few lines come quickly, so that a user sees that it runs.
                let pause = if now.steps < 10 { 1 } else { 5 };
                self.next = Some(clock + Duration::from_secs(pause));
            } else {
                self.bar.set_position((1000.0 * now.time / now.until) as u64);
                self.bar.set_message(self.line(now));
                self.next = Some(clock + Duration::from_millis(100));
            }
        }
        !self.stop.load(Ordering::Relaxed)
    }
}
