//! The command line: arguments, output and exit codes.
//!
//! Exit codes: 0 success; 1 the computation could not continue; 2 an error in the command, the scene or a file; 3 a
//! check exceeds its bound; 130 interrupted.

#![allow(rustdoc::invalid_html_tags, reason = "comments of arguments are the help of the command line")]

mod bench;
mod export;
mod given_keys;
mod import_moordyn;
mod inspect;
mod json_log;
mod live;
mod report_page;
mod progress;
mod ranks;
mod console_text;
mod run;
pub mod scene_lookup;
mod statistics;
mod stress;
mod study;
mod validate;
mod watch;

use std::{
    ffi::OsString,
    io::Write,
    path::PathBuf,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
};

use crate::{
    error::{Error, ErrorKind, Result},
    run::MOST_THREADS,
};
use clap::{Args, CommandFactory, Parser, Subcommand};
use given_keys::GivenKeys;

/// Rigid bodies that float, collide and are driven in water.
#[derive(Parser)]
#[command(
    version,
    max_term_width = 100,
    arg_required_else_help = true,
    after_help = "\
Try:
  pontoon scenes                      what is there to run
  pontoon run raft                    several floats, a paddle, a tank
  pontoon run raft --dp 0.01          the same, finer
  pontoon inspect raft                what it costs, what looks wrong, every effective value
Results go to runs/<scene>: open report.html first; frames.pvd is for ParaView, series/*.csv for
anything."
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Run a scene to its end
    #[command(after_help = "\
Examples:
  pontoon run scenes/raft                           a folder with a scene.toml
  pontoon run my-bay.toml --until 2 --dp 0.02       a scene file, shorter and coarser
  pontoon run raft --set model.viscosity=none       one key of the scene changed
  pontoon run raft --set solid.box.free.density=500
Ctrl-C stops after the present step with a checkpoint; `pontoon resume` continues from there to
the same bits. The number of threads changes the speed, never the result.
Exit codes: 0 all well; 1 the computation could not go on; 2 something in the command, the scene
or a file is wrong; 3 a check misses its bound; 130 interrupted.")]
    Run(run::RunArgs),
    /// Go on with an interrupted run, to the same bits as an unbroken one
    #[command(after_help = "Example:\n  pontoon resume runs/raft")]
    Resume(run::ResumeArgs),
    /// Tell what a scene would cost and what looks wrong with it, and print every effective value
    #[command(after_help = "\
Examples:
  pontoon inspect raft --dp 0.01
  pontoon inspect my-bay.toml --no-timing --json
What looks wrong comes first, each with the number that would mend it; `run` prints the warnings
too. Nothing is written. The scene is stepped for a second to tell how long a run takes on
this machine.")]
    Inspect(inspect::InspectArgs),
    /// Run a scene at several spacings, with several laws: errors against processor time, orders
    #[command(after_help = "\
Examples:
  pontoon study still-tank --dp 0.04,0.02,0.01 --dry-run
  pontoon study column --dp 0.03,0.02 --vary model.kernel=wendland,cubic --until 1
  pontoon study flume-box --vary \"model.viscosity={ artificial = { alpha = 0.02 } },none\"
  pontoon study dam-break --vary model.diffusion=none,fourtakas --png fields.png --time 0.3,0.5
  pontoon study flume-box --vary model.viscosity=laminar,none --repeat 5
Every spacing is run with every combination of values, one run after the other, each with all
threads, without frames. Results are in DIR/study.html, .csv and .json, whole after every run; the
runs in DIR/runs. A run that has finished is not run again; after Ctrl-C the same command continues.
With --repeat each run is made several times from starts that differ by a millionth of dp; mean,
standard deviation, least and greatest error say what of a difference between laws is chance.
With --png the runs keep frames at the times of --time, and are drawn at the end: a column for each
run, a row for each time, equal colours.
Exit codes: 0 all well; 1 a run failed; 2 something in the command, the scene or a file is wrong;
3 a check misses its bound; 130 interrupted.")]
    Study(study::StudyArgs),
    /// Run cases with references and judge them: errors, the paper's errors, bounds
    #[command(after_help = "\
Examples:
  pontoon validate                    the usual cases, coarse: some minutes
  pontoon validate --list             what there is
  pontoon validate column-3 column-9  two of them, coarse
  pontoon validate column --full      as fine as the paper: about an hour
  pontoon validate flume-box flume-box-b --repeat 5
                                      which is better, and what of it is chance
Results are in DIR/validation.html and .csv, whole after every run; the runs in DIR/runs. A run that
has finished is not run again; after Ctrl-C the same command continues.
Exit codes: 0 all bounds are kept; 1 a run failed; 2 something in the command or a file is wrong;
3 a bound is missed; 130 interrupted.")]
    Validate(validate::ValidateArgs),
    /// Run maps of hard cases and judge each by physics: right, stopped with a reason, or wrong
    #[command(after_help = "\
Examples:
  pontoon stress --list               what there is
  pontoon stress --quick              the ends of every axis: some minutes
  pontoon stress                      everything
  pontoon stress float courant        two maps
  pontoon stress --maps my-maps.toml  maps of your own
Cases run in memory, several side by side, each on one thread. Results are in DIR/stress.json, whole
after every case, and a picture of each map in DIR/MAP.svg. A case that has been run with the same
scene by the same version is not run again; Ctrl-C stops after the cases in hand.
Exit codes: 0 none is wrong; 2 something in the command or a file is wrong; 3 a case is wrong;
130 interrupted.")]
    Stress(stress::StressArgs),
    /// Write the page of a run: a player, plots, tables, in one file that opens anywhere
    #[command(after_help = "\
Examples:
  pontoon report runs/raft                          runs/raft/report.html
  pontoon report runs/raft --png raft.png --time 1.2
  pontoon report runs/raft --png raft.png --time 0.5,1,1.5 --by speed --range 0,1.5
`run` and `resume` write the page at their end. It needs no network and no server.")]
    Report(report_page::ReportArgs),
    /// Lay several runs over one another: a page with their players side by side, or a picture
    #[command(after_help = "\
Examples:
  pontoon compare runs/raft runs/raft-2 --out rafts.html
  pontoon compare runs/plain runs/delta runs/shifted --png fields.png --time 0.5,1.0
Players go at equal times, with equal colours; pictures have a column for each run and a row for
each time.")]
    Compare(report_page::CompareArgs),
    /// Write the series of a run, or the bodies of a scene, for other programs
    #[command(after_help = "\
Examples:
  pontoon export runs/raft --npz                    runs/raft/series.npz
  pontoon export runs/raft --npz raft.npz
  pontoon export wigley --capytaine hull            hull/bodies.json, hull/hull.gdf
In Python: numpy.load(\"raft.npz\")[\"box.heave_m\"], and \"box.t_s\" for its times. For pandas the
tables are as they should be: pandas.read_csv(\"runs/raft/series/box.csv\").")]
    Export(export::ExportArgs),
    /// Print the lines, points and line types of a MoorDyn v2 deck as sections of a scene
    #[command(after_help = "\
Examples:
  pontoon import-moordyn lines.txt --solid float --level 50 >> my-float/scene.toml
  pontoon import-moordyn lines.txt                  looks at the sections first
Coupled points are on the solid of --solid, free points become [[mooring_point]], and z grows by
--level. What a scene has in another form, such as the depth, is named in comments.")]
    ImportMoordyn(import_moordyn::ImportMoordynArgs),
    /// Watch a run's latest curves in the terminal, running or finished
    #[command(after_help = "\
Examples:
  pontoon watch runs/raft
  pontoon watch runs/raft --series box.heave_m --once
q or Ctrl-C closes the view; the run continues. In a pipe it prints once.")]
    Watch(watch::WatchArgs),
    /// Print the JSON schema of scenes, for editors
    #[command(after_help = "\
Example:
  pontoon schema > scene.schema.json
An editor with a TOML language server checks and completes a scene that begins with the line
  #:schema scene.schema.json")]
    Schema,
    /// Print the completions of a shell
    #[command(after_help = "\
Examples:
  pontoon completions bash > ~/.local/share/bash-completion/completions/pontoon
  pontoon completions fish > ~/.config/fish/completions/pontoon.fish")]
    Completions {
        /// Which shell
        #[arg(value_name = "SHELL")]
        shell: clap_complete::Shell,
    },
    /// Tell the figures of a run's series: means, waves, spectra, reflection, RAOs
    #[command(after_help = "\
Examples:
  pontoon stats runs/raft
  pontoon stats runs/raft --series gauge --from 5 --until 20
  pontoon stats runs/raft --json
  pontoon stats runs/buoy --rao --json
A run writes them at its end, to statistics.csv; [[statistic]] in the scene asks for more. H_third
is the mean of the highest third of the waves, H_m0 four standard deviations. How motions answer
irregular waves over frequency, as in rao.csv, is the last table, or with --rao the only one.")]
    Stats(statistics::StatsArgs),
    /// List the scenes that come with the program
    Scenes,
    /// Time standard cases on this machine: particle-steps per second, where a step goes, memory
    #[command(
        after_help = "Examples:\n  pontoon bench\n  pontoon bench --terms\n  pontoon bench --size 20000,2000000 --json"
    )]
    Bench(bench::BenchArgs),
}

#[derive(Args)]
struct SceneArgs {
    /// A folder with a scene.toml, a scene file, or the name of a scene of `pontoon scenes`
    #[arg(value_name = "SCENE")]
    scene: PathBuf,
    /// Particle spacing, m: half of it costs about 8 times as much in 2-D, 16 times in 3-D
    #[arg(long, value_name = "METRES", allow_negative_numbers = true)]
    dp: Option<f64>,
    /// Simulated time at the end, s
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    until: Option<f64>,
    /// How pairs are added up: fast (default) or reference (double precision, one after the other)
    #[arg(long, value_name = "SWEEP")]
    sweep: Option<String>,
    /// Change a key of the scene; may be given several times
    #[arg(long, value_name = "KEY=VALUE", value_parser = key_value)]
    set: Vec<KeyValue>,
}

impl SceneArgs {
    /// Returns the scene keys that the arguments change.
    fn given_keys(&self) -> GivenKeys {
        GivenKeys::of_set(&self.set)
            .and("--dp ", "dp", self.dp.map(|dp| format!("{dp:?}")))
            .and("--until ", "until", self.until.map(|until| format!("{until:?}")))
            .and("--sweep ", "model.sweep", self.sweep.as_ref().map(|sweep| format!("{sweep:?}")))
    }
}

/// A key of the scene and its value.
type KeyValue = (String, String);

/// Parses `key=value` as a pair.
fn key_value(text: &str) -> std::result::Result<KeyValue, String> {
    match text.split_once('=') {
        Some((key, value)) if !key.trim().is_empty() => Ok((key.trim().into(), value.trim().into())),
        _ => Err("write key=value, as in --set model.h_over_dp=1.7".into()),
    }
}

/// Parses a number of threads.
fn thread_count(text: &str) -> std::result::Result<usize, String> {
    let count = text.parse().ok().filter(|count| (1..=MOST_THREADS).contains(count));
    count.ok_or_else(|| format!("threads are from 1 to {MOST_THREADS}"))
}

/// Parses `arguments`, the first of which is the name of the program, runs the command, prints its result and returns
/// the exit code.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    let cli = match Cli::try_parse_from(&arguments) {
        Ok(cli) => cli,
        Err(told) => {
            let printed = told.print().and_then(|()| std::io::stdout().flush());
            return match check_output(printed) {
                Err(error) if !told.use_stderr() => fail(&error),
                _ => told.exit_code() as u8,
            };
        }
    };
    dispatch(cli.command, &command_line(&arguments)).unwrap_or_else(|error| fail(&error))
}

/// Prints an error and returns its exit code.
fn fail(error: &Error) -> u8 {
    if !ranks::is_silent() {
        print_error(&format!("error: {error}\n"));
    }
    exit_code(error)
}

/// Returns the exit code of an error.
fn exit_code(error: &Error) -> u8 {
    if error.kind == ErrorKind::Fault { 1 } else { 2 }
}

/// Runs `command`. Studies record `command_line`.
fn dispatch(command: Command, command_line: &str) -> Result<u8> {
    if !matches!(command, Command::Run(_) | Command::Resume(_)) {
        ranks::require_one_process()?;
    }
    match command {
        Command::Run(args) => run::run(&args),
        Command::Resume(args) => run::resume(&args),
        Command::Inspect(args) => print_output(&inspect::inspect(&args)?).map(|()| 0),
        Command::Validate(args) => validate::validate(args, command_line),
        Command::Study(args) => study::study(args, command_line),
        Command::Stress(args) => stress::stress(args),
        Command::Bench(args) => print_output(&bench::bench(&args)?).map(|()| 0),
        Command::Report(args) => report_page::report(&args),
        Command::Compare(args) => report_page::compare(&args),
        Command::Export(args) => print_output(&export::export(&args)?).map(|()| 0),
        Command::ImportMoordyn(args) => print_output(&import_moordyn::import(&args)?).map(|()| 0),
        Command::Watch(args) => watch::watch(&args),
        Command::Schema => print_output(&format!("{:#}\n", crate::scene::schema())).map(|()| 0),
        Command::Completions { shell } => {
            let mut text = Vec::new();
            clap_complete::generate(shell, &mut Cli::command(), "pontoon", &mut text);
            print_output(&String::from_utf8_lossy(&text)).map(|()| 0)
        }
        Command::Stats(args) => print_output(&statistics::stats(&args)?).map(|()| 0),
        Command::Scenes => print_output(&console_text::scene_list(&scene_lookup::scene_infos())).map(|()| 0),
    }
}

/// Returns the command line as typed, for records.
fn command_line(arguments: &[OsString]) -> String {
    let quoted = |word: &OsString| {
        let word = word.to_string_lossy();
        if word.contains([' ', '{', '"', '*']) { format!("'{word}'") } else { word.into_owned() }
    };
    let words: Vec<String> = arguments.iter().skip(1).map(quoted).collect();
    format!("pontoon {}", words.join(" "))
}

/// Returns a flag that Ctrl-C sets; a second Ctrl-C ends the program immediately.
fn interrupt_flag() -> Result<Arc<AtomicBool>> {
    interrupt_flag_with_message("\nstopping after this step, with a checkpoint; Ctrl-C again stops at once, without\n")
}

/// Returns the flag of [`interrupt_flag`] and prints `words` at the first Ctrl-C.
fn interrupt_flag_with_message(words: &'static str) -> Result<Arc<AtomicBool>> {
    let flag = Arc::new(AtomicBool::new(false));
    let raised = flag.clone();
    let handler = move || {
        if raised.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
        print_error(words);
    };
    watch_interrupts(handler)?;
    Ok(flag)
}

/// Calls `handler` at every Ctrl-C and SIGTERM.
fn watch_interrupts(handler: impl FnMut() + Send + 'static) -> Result<()> {
    ctrlc::set_handler(handler).map_err(|why| Error::new(ErrorKind::Usage, format!("Ctrl-C cannot be watched: {why}")))
}

/// Prints results. A closed output, as after `head`, is no error.
///
/// # Errors
/// `File` if the output cannot be written, as on a full disk.
fn print_output(text: &str) -> Result<()> {
    let mut output = std::io::stdout().lock();
    check_output(output.write_all(text.as_bytes()).and_then(|()| output.flush()))
}

/// Returns the error of a write to the standard output, unless its reader has closed it.
fn check_output(written: std::io::Result<()>) -> Result<()> {
    match written {
        Err(why) if why.kind() != std::io::ErrorKind::BrokenPipe => {
            let help = "send the output to a file on a disk with space, or to a pipe";
            Err(Error::write(std::path::Path::new("standard output"), "written", &why).help(help))
        }
        _ => Ok(()),
    }
}

/// Prints text other than results: progress, warnings, errors.
fn print_error(text: &str) {
    let _ = std::io::stderr().write_all(text.as_bytes());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_arguments_are_sound() {
        Cli::command().debug_assert();
    }

    #[test]
    fn what_is_said_in_arguments_becomes_keys_of_the_scene() {
        let words = ["pontoon", "run", "raft", "--set", "a.b = [1, 2]", "--dp", "0.02", "--until", "3"];
        let Ok(Cli { command: Command::Run(args) }) = Cli::try_parse_from(words) else { panic!("is a run") };
        let pairs = [("a.b", "[1, 2]"), ("dp", "0.02"), ("until", "3.0")];
        assert_eq!(args.scene.given_keys().overrides().unwrap(), pairs.map(|(k, v)| (k.to_string(), v.to_string())));
        assert!(Cli::try_parse_from(["pontoon", "run", "raft", "--set", "dp"]).is_err());
    }
}
