//! `pontoon run` and `pontoon resume`: who follows the run, and what is said at its end.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use pontoon::{
    error::{Error, Result},
    output::manifest::RunStatus,
    run::{self, RunOptions, RunOutcome},
};

use super::{
    SceneArgs, code, complain,
    journal::{self, Journal},
    page,
    progress::{Follow, Follower},
    report, say, shelf, stopper, stopper_saying,
};

/// Which scene is run, and how.
#[derive(Args)]
pub struct RunArgs {
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Folder for the results, new or empty [default: runs/<scene>, numbered if taken]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Simulated time from one frame to the next, s, or off: short for --set frames.every=EVERY, frames=off
    #[arg(long, value_name = "EVERY|off", allow_negative_numbers = true, value_parser = frames)]
    frames: Option<Pair>,
    /// Threads [default: one for each processor]
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
    #[command(flatten)]
    said: SaidArgs,
}

/// A key of the scene and its value.
type Pair = (String, String);

impl RunArgs {
    /// The scene keys that the arguments change.
    fn sets(&self) -> Vec<Pair> {
        self.scene.sets().into_iter().chain(self.frames.clone()).collect()
    }
}

/// What `--frames` changes.
fn frames(text: &str) -> std::result::Result<Pair, String> {
    match text.parse::<f64>() {
        _ if text == "off" => Ok(("frames".into(), "off".into())),
        Ok(every) => Ok(("frames.every".into(), format!("{every:?}"))),
        Err(_) => Err("write seconds, as in --frames 0.05, or off".into()),
    }
}

/// Which run is gone on with, and how.
#[derive(Args)]
pub struct ResumeArgs {
    /// Folder of the run
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Change a key of [guard] from here on; may be given several times
    #[arg(long, value_name = "KEY=VALUE", value_parser = super::pair)]
    set: Vec<Pair>,
    /// Threads [default: one for each processor]
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
    #[command(flatten)]
    said: SaidArgs,
}

/// What is said of a run.
#[derive(Args, Clone, Copy)]
struct SaidArgs {
    /// Leave out the page at the end, report.html
    #[arg(long)]
    no_report: bool,
    /// Say nothing but errors
    #[arg(long, short)]
    quiet: bool,
    /// How progress, warnings and errors are said on standard error
    #[arg(long, value_name = "FORMAT", default_value = "text")]
    log: Log,
}

/// How progress is said.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Log {
    /// For people
    Text,
    /// An object a line, for programs
    Json,
}

/// `pontoon run`.
///
/// # Errors
/// As [`run::run`].
pub fn run(args: &RunArgs) -> Result<u8> {
    let started = |args: &RunArgs| {
        let found = shelf::find(&args.scene.scene)?;
        let options = RunOptions { out: args.out.clone(), overrides: args.sets(), threads: args.threads };
        let mut follow = follower(&args.said)?;
        let outcome = found.named(run::run(found.path(), &options, &mut *follow));
        end(outcome, follow, &args.said)
    };
    told(started(args), &args.said)
}

/// `pontoon resume`.
///
/// # Errors
/// As [`run::resume`].
pub fn resume(args: &ResumeArgs) -> Result<u8> {
    let mut follow = follower(&args.said)?;
    let outcome = run::resume(&args.folder, &args.set, args.threads, &mut *follow);
    told(end(outcome, follow, &args.said), &args.said)
}

/// What comes of a run, its error said as the user wants it.
fn told(outcome: Result<u8>, said: &SaidArgs) -> Result<u8> {
    match outcome {
        Err(error) if said.log == Log::Json => {
            journal::failed(&error);
            Ok(code(&error))
        }
        outcome => outcome,
    }
}

/// Who follows a run, as the user wants it.
fn follower(said: &SaidArgs) -> Result<Box<dyn Follower>> {
    Ok(match said.log {
        Log::Text => Box::new(Follow::new(said.quiet, stopper()?)),
        Log::Json => Box::new(Journal::new(said.quiet, stopper_saying(journal::STOPPING)?)),
    })
}

/// Closes the progress, prints the table, writes the page of the run if it is wanted, chooses the exit code.
fn end(outcome: Result<RunOutcome>, mut follow: Box<dyn Follower>, said: &SaidArgs) -> Result<u8> {
    let (folder, json) = (follow.close(), said.log == Log::Json);
    match &outcome {
        _ if said.quiet => {}
        Ok(outcome) if json => {
            outcome.end_warnings.iter().for_each(|text| journal::warn(text));
            journal::ended(outcome);
        }
        Ok(outcome) => {
            outcome.end_warnings.iter().for_each(|text| complain(&format!("warning: {text}\n")));
            say(&report::ended(outcome));
        }
        Err(_) => {}
    }
    if let Some(folder) = folder.filter(|_| !said.no_report) {
        let told = |why: &Error| {
            let text = format!("the page of the run was not written: {why}");
            if json { journal::warn(&text) } else { complain(&format!("warning: {text}\n")) }
        };
        page::at_end(&folder, said.quiet || json, told);
    }
    let outcome = outcome?;
    Ok(match outcome.manifest.status {
        RunStatus::Interrupted => 130,
        _ if outcome.has_failed_checks() => 3,
        _ => 0,
    })
}
