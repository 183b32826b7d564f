//! `pontoon study` and what it shares with `validate`: a list of runs, one after the other.

use std::{
    path::{Path, PathBuf},
    sync::{Arc, atomic::AtomicBool},
};

use crate::{
    error::{Error, ErrorKind, Result},
    math::format::{duration, metric_prefix},
    output::require_parent_folder,
    preflight::DEFAULT_SPEED,
    report::PictureOptions,
    scene::Scene,
    study::{
        Job, JobResult, JobState, ParameterGrid, REPEATS_NOTE, ResultRow, StudyResults, TimeEstimate, VariedKey,
        distinguishing_labels, estimate_times, frame_interval, split_values, spread_table,
    },
};
use clap::Args;

use super::{
    KeyValue,
    console_text::table,
    given_keys::GivenKeys,
    interrupt_flag, key_value, print_error, print_output,
    progress::{CliObserver, ProgressDisplay},
    report_page::{PictureStyleArgs, draw_picture},
    scene_lookup,
};

/// A grid of runs.
#[derive(Args)]
pub struct StudyArgs {
    /// A folder with a scene.toml, a scene file, or the name of a scene of `pontoon scenes`
    #[arg(value_name = "SCENE")]
    scene: PathBuf,
    /// Particle spacings, m, separated by commas [default: the scene's]
    #[arg(long, value_name = "METRES,..", value_delimiter = ',')]
    dp: Vec<f64>,
    /// A key of the scene and its values, separated by commas; may be given several times
    #[arg(long, value_name = "KEY=VALUE,..", value_parser = key_value)]
    vary: Vec<(String, String)>,
    /// Change a key of the scene in all runs; may be given several times
    #[arg(long, value_name = "KEY=VALUE", value_parser = key_value)]
    set: Vec<(String, String)>,
    /// Run each N times, with its water moved by a millionth of dp more each time: what differs is chance
    #[arg(long, value_name = "N", default_value_t = 1)]
    repeat: usize,
    /// Simulated time at the end, s
    #[arg(long, value_name = "SECONDS")]
    until: Option<f64>,
    /// Threads of each run [default: one for each processor]
    #[arg(long, value_name = "N", value_parser = super::thread_count)]
    threads: Option<usize>,
    /// Folder for runs and results [default: studies/<scene>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Say what would be run and how long it would take; run nothing
    #[arg(long)]
    dry_run: bool,
    /// Draw the runs side by side to FILE at the end, a column for each
    #[arg(long, value_name = "FILE", value_parser = super::report_page::png_file)]
    png: Option<PathBuf>,
    #[command(flatten)]
    look: PictureStyleArgs,
    /// Say nothing but errors and the table
    #[arg(long, short)]
    quiet: bool,
}

/// How a list of runs ended.
pub struct JobListResult {
    /// What came out, of the first runs if it was interrupted.
    pub ran: Vec<JobResult>,
    /// Whether Ctrl-C ended it.
    pub interrupted: bool,
}

/// A list of runs and how it is to be worked off.
pub struct JobList<'a> {
    /// The runs.
    pub jobs: &'a [Job],
    /// Threads of each.
    pub threads: Option<usize>,
    /// Whether to say nothing.
    pub quiet: bool,
}

impl JobList<'_> {
    /// Says what is to come, even to who wants quiet if nothing else will be said. Nothing is written.
    pub fn announce(&self, alone: bool) -> Result<()> {
        let ran = self.jobs.iter().map(Job::existing_result).collect::<Result<Vec<JobResult>>>()?;
        let planned = estimate_times(self.jobs, &ran, self.count())?;
        if alone || !self.quiet {
            print_output(&planned_table(self.jobs, &ran, &planned))?;
        }
        Ok(())
    }

    /// Runs what is to be run; `after` is told after every run.
    pub fn run_all(
        &self,
        stop: &Arc<AtomicBool>,
        mut after: impl FnMut(&[JobResult]) -> Result<()>,
    ) -> Result<JobListResult> {
        let mut ran: Vec<JobResult> = Vec::new();
        for (i, job) in self.jobs.iter().enumerate() {
            let known = job.existing_result()?;
            if known.state == JobState::Finished {
                ran.push(known);
                continue;
            }
            if !self.quiet {
                print_error(&format!("\nrun {} of {}: {}\n", i + 1, self.jobs.len(), job.display_name()));
            }
            let mut follow = Box::new(ProgressDisplay::new(self.quiet, stop.clone()));
            let outcome = job.run_or_resume(self.threads, &mut *follow);
            follow.close();
            let outcome = outcome?;
            if let JobState::Failed(why) = &outcome.state {
                print_error(&format!("{} failed: {why}\n", job.display_name()));
            }
            let interrupted = outcome.state == JobState::Interrupted;
            ran.push(outcome);
            after(&ran)?;
            if interrupted {
                return Ok(JobListResult { ran, interrupted });
            }
        }
        after(&ran)?;
        Ok(JobListResult { ran, interrupted: false })
    }

    fn count(&self) -> usize {
        self.threads.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, |n| n.get()))
    }
}

/// The table of runs to come.
fn planned_table(jobs: &[Job], ran: &[JobResult], planned: &[TimeEstimate]) -> String {
    let mut rows =
        vec![["run", "water", "boundary, at most", "steps, at least", "time", ""].map(String::from).to_vec()];
    for ((job, ran), planned) in jobs.iter().zip(ran).zip(planned) {
        let standing = match &ran.state {
            JobState::Finished => "has been run",
            JobState::Failed(_) => "failed before",
            JobState::Interrupted => "continues",
            JobState::Planned if planned.measured => "",
            JobState::Planned => "at the usual speed",
        };
        rows.push(vec![
            job.display_name(),
            metric_prefix(planned.size.fluid),
            metric_prefix(planned.size.boundary),
            metric_prefix(planned.size.steps),
            if ran.state == JobState::Finished {
                String::new()
            } else {
                format!("about {}", duration(planned.seconds))
            },
            standing.into(),
        ]);
    }
    let total: f64 = planned.iter().map(|p| p.seconds).sum();
    let mut text = format!("{}in all about {}\n", table(&rows), duration(total));
    if planned.iter().any(|p| !p.measured && p.seconds > 0.0) {
        let [plane, space] = DEFAULT_SPEED.map(metric_prefix);
        text += &format!(
            "the usual speed: {plane} water particles × force passes a second and thread in 2-D, {space} in 3-D\n"
        );
    }
    text
}

impl StudyArgs {
    /// Returns the scene keys that the arguments change in all runs.
    ///
    /// # Errors
    /// As [`GivenKeys::overrides`]; a varied key counts as given.
    fn overrides(&self) -> Result<Vec<KeyValue>> {
        let until = self.until.map(|until| format!("{until:?}"));
        let all = || GivenKeys::of_set(&self.set).and("--until ", "until", until.clone());
        let spacings: Vec<String> = self.dp.iter().map(|dp| format!("{dp:?}")).collect();
        let spacings = Some(spacings.join(",")).filter(|_| !self.dp.is_empty());
        let vary = |given: GivenKeys, (key, values): &KeyValue| {
            given.and(&format!("--vary {key}="), key, Some(values.clone()))
        };
        self.vary.iter().fold(all().and("--dp ", "dp", spacings), vary).overrides()?;
        all().overrides()
    }
}

/// Runs the grid, or says what it would run.
pub fn study(args: StudyArgs, command_line: &str) -> Result<u8> {
    let found = scene_lookup::find_scene(&args.scene)?;
    let sets = args.overrides()?;
    let scene = found.with_scene_name(Scene::read(found.path(), &sets))?;
    let name = scene_name(&args.scene);
    let out = args.out.clone().unwrap_or_else(|| PathBuf::from("studies").join(&name));
    let shot = args.png.as_deref().map(|png| picture_options(&args.look, png, &out, scene.until)).transpose()?;
    let grid = ParameterGrid {
        dp: if args.dp.is_empty() { vec![scene.dp] } else { args.dp.clone() },
        vary: args
            .vary
            .iter()
            .map(|(key, values)| VariedKey { key: key.clone(), values: split_values(values) })
            .collect(),
        scene: found.path().to_owned(),
        overrides: sets,
        name: name.clone(),
        frames: shot.as_ref().map(|shot| frame_interval(&shot.times, scene.until)),
        repeat: args.repeat,
    };
    let sheet = found.with_scene_name(StudyResults::new(&grid, out, command_line.to_owned()))?;
    let list = JobList { jobs: &sheet.jobs, threads: args.threads, quiet: args.quiet };
    found.with_scene_name(list.announce(args.dry_run))?;
    if args.dry_run {
        return Ok(0);
    }
    let done = list.run_all(&interrupt_flag()?, |ran| sheet.write(ran))?;
    let rows = sheet.rows(&done.ran);
    print_output(&format!("\n{}", table(&sheet.run_rows(&rows))))?;
    print_output(&repeats_text(&rows))?;
    for file in sheet.files() {
        print_output(&format!("{}\n", file.display()))?;
    }
    if let (Some(png), Some(shot), false) = (&args.png, shot, done.interrupted) {
        draw_runs(&sheet.jobs, &done.ran, shot, png)?;
    }
    Ok(list_exit_code(&done))
}

/// How far repeats lie apart; nothing if no run is repeated.
pub fn repeats_text(rows: &[ResultRow]) -> String {
    let told = spread_table(rows);
    if told.is_empty() { String::new() } else { format!("\n{}{REPEATS_NOTE}\n\n", table(&told)) }
}

/// The picture that is to be drawn to `png` of runs that end at `until` (s), the folder `out` being made by them: what is wrong
/// with it is told before anything is run.
fn picture_options(look: &PictureStyleArgs, png: &Path, out: &Path, until: f64) -> Result<PictureOptions> {
    if png.parent() != Some(out) {
        require_parent_folder(png)?;
    }
    let shot = look.picture_options()?;
    match shot.times.iter().find(|t| !(0.0..=until).contains(*t)) {
        Some(t) => {
            Err(Error::new(ErrorKind::Usage, format!("--time {t} is not within the runs, which end at {until} s"))
                .help("give times from 0 to the end, or a later end with --until"))
        }
        None => Ok(shot),
    }
}

/// Draws the runs that came to have frames, what is varied over their columns.
fn draw_runs(jobs: &[Job], ran: &[JobResult], mut shot: PictureOptions, png: &Path) -> Result<()> {
    let mut folders = Vec::new();
    for ((job, head), ran) in jobs.iter().zip(distinguishing_labels(jobs)).zip(ran) {
        if ran.manifest.as_ref().is_some_and(|manifest| manifest.frames.count > 0) {
            folders.push(job.folder.clone());
            shot.column_titles.push(head);
        } else {
            print_error(&format!("warning: {} has no frames: it is not in the picture\n", job.display_name()));
        }
    }
    if folders.is_empty() {
        return Err(Error::new(ErrorKind::Usage, "no run has frames to be drawn").help("take frames=off out of --set"));
    }
    draw_picture(&folders, &shot, png)
}

/// The exit code of a list of runs.
pub fn list_exit_code(done: &JobListResult) -> u8 {
    if done.interrupted {
        print_error("interrupted: the same command continues\n");
        130
    } else if done.ran.iter().any(|r| matches!(r.state, JobState::Failed(_))) {
        1
    } else if done.ran.iter().flat_map(|r| &r.verdicts).any(|v| v.passed == Some(false)) {
        3
    } else {
        0
    }
}

/// A short name for what the user called a scene.
fn scene_name(scene: &Path) -> String {
    let whole = std::fs::canonicalize(scene).unwrap_or_else(|_| scene.to_owned());
    let own = if whole.ends_with("scene.toml") { whole.parent().unwrap_or(&whole).to_owned() } else { whole };
    own.file_stem().map_or_else(|| "scene".into(), |stem| stem.to_string_lossy().into_owned())
}
