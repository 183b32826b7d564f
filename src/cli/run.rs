//! `pontoon run` and `pontoon resume`: who follows the run, and what is said at its end.

use std::path::PathBuf;

use crate::{
    error::{Error, Result},
    output::manifest::RunStatus,
    ranks::Ranks,
    run::{self, Progress, RunObserver, RunOptions, RunOutcome},
};
use clap::{Args, ValueEnum};

use super::{
    KeyValue, SceneArgs, console_text, exit_code,
    given_keys::GivenKeys,
    interrupt_flag, interrupt_flag_with_message,
    json_log::{self, JsonLog},
    live::{LiveObserver, LiveServer, LiveState},
    print_error, print_output,
    progress::{CliObserver, ProgressDisplay},
    ranks, report_page, scene_lookup, watch_interrupts,
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
    frames: Option<KeyValue>,
    /// Threads [default: one for each processor]
    #[arg(long, value_name = "N", value_parser = super::thread_count)]
    threads: Option<usize>,
    /// Device that computes the water: a number of bench --devices, gpu, or part of a name [default: the processor]
    #[arg(long, value_name = "DEVICE")]
    device: Option<String>,
    #[command(flatten)]
    log_args: LogArgs,
}

impl RunArgs {
    /// The scene keys that the arguments change.
    ///
    /// # Errors
    /// As [`GivenKeys::overrides`].
    fn overrides(&self) -> Result<Vec<KeyValue>> {
        let (key, every) = self.frames.clone().unzip();
        let device = self.device.as_ref().map(|name| format!("{name:?}"));
        let given = self.scene.given_keys().and("--frames ", &key.unwrap_or_default(), every);
        given.and("--device ", "model.device", device).overrides()
    }
}

/// What `--frames` changes.
fn frames(text: &str) -> std::result::Result<KeyValue, String> {
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
    #[arg(long, value_name = "KEY=VALUE", value_parser = super::key_value)]
    set: Vec<KeyValue>,
    /// Threads [default: one for each processor]
    #[arg(long, value_name = "N", value_parser = super::thread_count)]
    threads: Option<usize>,
    #[command(flatten)]
    log_args: LogArgs,
}

/// What is said of a run.
#[derive(Args, Clone, Copy)]
struct LogArgs {
    /// Leave out the page at the end, report.html
    #[arg(long)]
    no_report: bool,
    /// Say nothing but errors
    #[arg(long, short)]
    quiet: bool,
    /// How progress, warnings and errors are said on standard error
    #[arg(long, value_name = "FORMAT", default_value = "text")]
    log: LogFormat,
    /// Serve the page of the run during the run, to this machine alone; --live=PORT at this port [default: a free one]
    #[arg(long, value_name = "PORT", num_args = 0..=1, require_equals = true, default_missing_value = "0")]
    live: Option<u16>,
}

/// How progress is said.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum LogFormat {
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
    let find = || scene_lookup::find_scene(&args.scene.scene);
    on_all_processes(&args.log_args, args.threads, find, |ranks, threads, found, watch| {
        let options = RunOptions { out: args.out.clone(), overrides: args.overrides()?, threads };
        found.with_scene_name(run::run_on(ranks, found.path(), &options, watch))
    })
}

/// `pontoon resume`.
///
/// # Errors
/// As [`run::resume`].
pub fn resume(args: &ResumeArgs) -> Result<u8> {
    on_all_processes(
        &args.log_args,
        args.threads,
        || Ok(()),
        |ranks, threads, (), watch| {
            let guards = GivenKeys::of_set(&args.set).overrides()?;
            run::resume_on(ranks, &args.folder, &guards, threads, watch)
        },
    )
}

/// Finds what is run, and runs it on all processes that were started together. The first of them follows the run and says what came
/// of it; another one speaks only of a fault that is its own.
fn on_all_processes<T>(
    log_args: &LogArgs,
    threads: Option<usize>,
    find: impl FnOnce() -> Result<T>,
    run: impl FnOnce(&Ranks, Option<usize>, &T, &mut dyn RunObserver) -> Result<Option<RunOutcome>>,
) -> Result<u8> {
    let processes = match ranks::join() {
        Ok(processes) => processes,
        Err(error) if ranks::is_silent() => return Err(error),
        Err(error) => return report_outcome(Err(error), log_args),
    };
    let ranks = &processes.ranks;
    if ranks.rank() > 0 {
        // Ctrl-C stops the first, which stops the others.
        let prepared = watch_interrupts(|| {}).and_then(|()| find());
        let Ok(found) = ranks.agree(prepared, |_| String::new()) else { return Ok(0) };
        let threads = threads.or_else(|| ranks::default_threads(ranks));
        return run(ranks, threads, &found, &mut |_: &Progress| true)
            .map(|_| 0)
            .inspect_err(|error| print_error(&format!("error of rank {}: {error}\n", ranks.rank())));
    }
    let led = || {
        let prepared = find().and_then(|found| Ok((found, make_observer(log_args)?)));
        let (found, (mut watch, live)) = ranks.agree(prepared, |_| String::new())?;
        let threads = threads.or_else(|| ranks::default_threads(ranks));
        let outcome = run(ranks, threads, &found, &mut *watch).and_then(run::of_first_rank);
        finish(outcome, watch, live, log_args)
    };
    report_outcome(led(), log_args)
}

/// What comes of a run, its error said as the user wants it.
fn report_outcome(outcome: Result<u8>, said: &LogArgs) -> Result<u8> {
    match outcome {
        Err(error) if said.log == LogFormat::Json => {
            json_log::failed(&error);
            Ok(exit_code(&error))
        }
        outcome => outcome,
    }
}

/// Who follows a run, as the user wants it, and the server of its live page if there is one.
fn make_observer(log_args: &LogArgs) -> Result<(Box<dyn CliObserver>, Option<LiveServer>)> {
    let stop = match log_args.log {
        LogFormat::Text => interrupt_flag()?,
        LogFormat::Json => interrupt_flag_with_message(json_log::STOPPING)?,
    };
    let live = log_args.live.map(|port| LiveServer::bind(port, LiveState::new(stop.clone()))).transpose()?;
    let follow: Box<dyn CliObserver> = match log_args.log {
        LogFormat::Text => Box::new(ProgressDisplay::new(log_args.quiet, stop)),
        LogFormat::Json => Box::new(JsonLog::new(log_args.quiet, stop)),
    };
    Ok(match live {
        Some(live) => (Box::new(LiveObserver::new(follow, live.clone())), Some(live)),
        None => (follow, None),
    })
}

/// Closes the progress, prints the table, writes the page of the run if it is wanted, tells the live pages the end, chooses the
/// exit code.
fn finish(
    outcome: Result<RunOutcome>,
    mut follow: Box<dyn CliObserver>,
    live: Option<LiveServer>,
    log_args: &LogArgs,
) -> Result<u8> {
    let (folder, json) = (follow.close(), log_args.log == LogFormat::Json);
    let mut printed = Ok(());
    match &outcome {
        _ if log_args.quiet => {}
        Ok(outcome) if json => {
            outcome.end_warnings.iter().for_each(|text| json_log::warn(text));
            json_log::ended(outcome);
        }
        Ok(outcome) => {
            outcome.end_warnings.iter().for_each(|text| print_error(&format!("warning: {text}\n")));
            printed = print_output(&console_text::end_text(outcome));
        }
        Err(_) => {}
    }
    if let Some(folder) = folder.filter(|_| !log_args.no_report) {
        let told = |why: &Error| {
            let text = format!("the page of the run was not written: {why}");
            if json { json_log::warn(&text) } else { print_error(&format!("warning: {text}\n")) }
        };
        printed = printed.and(report_page::write_after_run(&folder, log_args.quiet || json, told));
    }
    if let Some(live) = live {
        live.close(&outcome, !log_args.no_report);
    }
    let outcome = outcome?;
    printed?;
    Ok(match outcome.manifest.status {
        RunStatus::Interrupted => 130,
        _ if outcome.has_failed_checks() => 3,
        _ => 0,
    })
}
