//! Progress: a bar on a terminal, now and then a line elsewhere.

use std::{
    path::PathBuf,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    time::{Duration, Instant},
};

use crate::{
    math::format::{duration, metric_prefix, three_digits},
    plan::ControlChange,
    run::{Progress, RunObserver, RunStart},
    simulation::Rollback,
    solid::ConstraintEvent,
};
use crossterm::terminal::size;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::{console_text, print_error};

/// Columns of a line where nobody tells how wide the terminal is.
const WIDE: usize = 79;

/// Columns of the bar, and the space behind it.
const BAR: usize = 11;

/// From one line to the next where there is no terminal, s: at first, then so many times the last, and at most.
const PAUSE: (f64, f64, f64) = (5.0, 1.25, 300.0);

/// Follows a run for the user, and passes on the wish to stop.
pub struct ProgressDisplay {
    quiet: bool,
    stop: Arc<AtomicBool>,
    bar: ProgressBar,
    /// The folder of the run that has begun.
    folder: Option<PathBuf>,
    /// Since when, in wall and simulated time (s), and at which step.
    begun: Option<(Instant, f64, u64)>,
    next: Option<Instant>,
    /// From the last line to the next where there is no terminal, s.
    pause: f64,
    /// Warnings so far.
    warnings: usize,
}

/// Someone who follows a run for the user.
pub trait CliObserver: RunObserver {
    /// Ends what is shown; the folder of the run, if one has begun.
    fn close(&mut self) -> Option<PathBuf>;

    /// Says where the live page of the run is.
    fn live_address(&mut self, address: &str);
}

impl CliObserver for ProgressDisplay {
    fn close(&mut self) -> Option<PathBuf> {
        self.bar.finish_and_clear();
        self.folder.take()
    }

    fn live_address(&mut self, address: &str) {
        print_error(&format!("live page: {address}\n"));
    }
}

impl ProgressDisplay {
    /// Shows nothing if `quiet`; asks the run to stop once `stop` is raised.
    pub fn new(quiet: bool, stop: Arc<AtomicBool>) -> Self {
        let target = if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        let bar = ProgressBar::with_draw_target(Some(1000), target);
        if let Ok(style) = ProgressStyle::with_template("{bar:10} {msg}") {
            bar.set_style(style);
        }
        Self { quiet, stop, bar, folder: None, begun: None, next: None, pause: PAUSE.0, warnings: 0 }
    }

    /// How far the run is, in so many columns; what matters most comes first, and what does not fit is left out.
    fn line(&self, now: &Progress, room: usize) -> String {
        let (begun, first, steps) = self.begun.unwrap_or((Instant::now(), now.time, now.steps));
        let (wall, done) = (begun.elapsed().as_secs_f64(), now.time - first);
        let going = now.steps > steps && wall > 0.0;
        let left = || format!("{} left", duration(wall * (now.until - now.time) / done));
        let speed = || format!("{} steps/s", metric_prefix((now.steps - steps) as f64 / wall));
        let words = [
            (done > 0.0).then(left),
            (now.dt > 0.0).then(|| format!("dt {} s", three_digits(now.dt))),
            console_text::warnings(self.warnings),
            now.energy.map(|drift| drift.to_string()),
            Some(format!("step {}", now.steps)),
            going.then(speed),
            going.then(|| format!("{} particle-steps/s", metric_prefix(now.rate))),
        ];
        fit_to_width(format!("t = {:.3} of {} s", now.time, now.until), words.into_iter().flatten(), room)
    }

    /// How long until the next line (s) where there is no terminal. The first few lines come quickly, so that a user sees
    /// that it runs; a run of a night has a hundred.
    fn next_pause(&mut self, steps: u64) -> f64 {
        if steps < 10 {
            return 1.0;
        }
        let pause = self.pause;
        self.pause = (pause * PAUSE.1).min(PAUSE.2);
        pause
    }

    /// Says how far the run is, and when it is said next.
    fn print_progress(&mut self, now: &Progress, clock: Instant) {
        if self.bar.is_hidden() {
            print_error(&format!("{}\n", self.line(now, WIDE)));
            self.next = Some(clock + Duration::from_secs_f64(self.next_pause(now.steps)));
        } else {
            let columns = size().map_or(0, |(columns, _)| usize::from(columns));
            let room = if columns == 0 { WIDE } else { columns - 1 };
            self.bar.set_position((1000.0 * now.time / now.until) as u64);
            self.bar.set_message(self.line(now, room.saturating_sub(BAR)));
            self.next = Some(clock + Duration::from_millis(100));
        }
    }
}

impl RunObserver for ProgressDisplay {
    fn start(&mut self, start: &RunStart) {
        self.folder = Some(start.folder.to_owned());
        self.warnings = start.manifest.warnings.len();
        if !self.quiet {
            print_error(&console_text::start_text(start));
        }
    }

    fn rolled_back(&mut self, how: &Rollback) {
        self.warnings += 1;
        if !self.quiet {
            self.bar.suspend(|| print_error(&format!("warning: {how}\n")));
        }
    }

    fn event(&mut self, event: &ConstraintEvent) {
        if !self.quiet {
            self.bar.suspend(|| print_error(&format!("note: {event}\n")));
        }
    }

    fn control_changed(&mut self, change: &ControlChange) {
        if !self.quiet {
            self.bar.suspend(|| print_error(&format!("note: {change}\n")));
        }
    }

    fn step(&mut self, now: &Progress) -> bool {
        let clock = Instant::now();
        self.begun.get_or_insert((clock, now.time, now.steps));
        if !self.quiet && self.next.is_none_or(|next| clock >= next) {
            self.print_progress(now, clock);
        }
        !self.stop.load(Ordering::Relaxed)
    }
}

/// `line` and as many of the `words` as there is room for, in columns.
fn fit_to_width(line: String, words: impl Iterator<Item = String>, room: usize) -> String {
    words.fold(line, |line, word| {
        let longer = format!("{line}, {word}");
        if longer.chars().count() > room { line } else { longer }
    })
}

#[cfg(test)]
mod tests {
    use crate::run::EnergyDrift;

    use super::*;

    fn now() -> Progress {
        Progress { time: 1.25, until: 12.0, dt: 1.234e-4, steps: 10_234, wall: 0.0, rate: 1.234e7, energy: None }
    }

    #[test]
    fn a_line_tells_step_and_warnings_and_stays_a_line() {
        let mut follow = ProgressDisplay::new(true, Arc::default());
        let now = now();
        assert_eq!(follow.line(&now, WIDE), "t = 1.250 of 12 s, dt 0.000123 s, step 10234");
        follow.warnings = 2;
        follow.begun = Instant::now().checked_sub(Duration::from_secs(50)).map(|then| (then, 0.0, 0));
        let line = follow.line(&now, WIDE);
        assert!(
            line.contains("left, dt ") && line.contains(" s, 2 warnings") && line.chars().count() <= WIDE,
            "{line}"
        );
        assert!(follow.line(&now, 200).ends_with(" steps/s, 12.34 M particle-steps/s"));
        assert!(follow.line(&now, WIDE - BAR).chars().count() <= WIDE - BAR);
    }

    #[test]
    fn a_line_tells_what_became_of_the_energy_if_somebody_watches_it() {
        let follow = ProgressDisplay::new(true, Arc::default());
        let said = |energy| follow.line(&Progress { energy: Some(energy), ..now() }, WIDE);
        let residual = EnergyDrift::Unaccounted(1.234e-3);
        assert_eq!(said(residual), "t = 1.250 of 12 s, dt 0.000123 s, energy off 0.123 %, step 10234");
        assert!(said(EnergyDrift::Changed(0.5, "J/m")).contains(", energy +0.5 J/m, "));
        assert!(said(EnergyDrift::Changed(-0.5, "J")).contains(", energy -0.5 J, "));
    }

    #[test]
    fn lines_in_a_pipe_grow_rare() {
        let mut follow = ProgressDisplay::new(true, Arc::default());
        assert_eq!([0, 9, 10, 11].map(|steps| follow.next_pause(steps)), [1.0, 1.0, 5.0, 6.25]);
        let (mut wall, mut lines) = (0.0, 0);
        while wall < 8.0 * 3600.0 {
            wall += follow.next_pause(1000);
            lines += 1;
        }
        assert!((60..130).contains(&lines), "{lines} lines in eight hours");
        assert_eq!(follow.next_pause(1000), 300.0);
    }
}
