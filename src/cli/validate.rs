//! `pontoon validate`: cases with references, run and judged.

use std::path::{Path, PathBuf};

use crate::{
    error::Result,
    study::{JobState, Validation, ValidationCase, select_cases, validation_cases},
};
use clap::Args;

use super::{
    console_text::table,
    interrupt_flag, print_error, print_output, scene_lookup,
    study::{JobList, list_exit_code, repeats_text},
};

/// Cases and how they are run.
#[derive(Args)]
pub struct ValidateArgs {
    /// Cases of `--list` [default: the usual ones if quick, all if full]
    #[arg(value_name = "NAME")]
    names: Vec<String>,
    /// Coarse and short: minutes (default)
    #[arg(long, conflicts_with = "full")]
    quick: bool,
    /// As fine and as long as the paper: hours to days
    #[arg(long)]
    full: bool,
    /// Run each N times, with its water moved by a millionth of dp more each time: what differs is chance
    #[arg(long, value_name = "N", default_value_t = 1)]
    repeat: usize,
    /// Threads of each run [default: one for each processor]
    #[arg(long, value_name = "N", value_parser = super::thread_count)]
    threads: Option<usize>,
    /// Folder for runs and results
    #[arg(long, value_name = "DIR", default_value = "validation")]
    out: PathBuf,
    /// List the cases; run nothing
    #[arg(long)]
    list: bool,
    /// Say what would be run and how long it would take; run nothing
    #[arg(long)]
    dry_run: bool,
    /// Say nothing but errors and the table
    #[arg(long, short)]
    quiet: bool,
}

/// Runs the cases, or lists them.
pub fn validate(args: ValidateArgs, command_line: &str) -> Result<u8> {
    if args.list {
        return print_output(&case_list(&validation_cases()?)).map(|()| 0);
    }
    let cases = select_cases(&args.names, args.full)?;
    let scenes =
        cases.iter().map(|case| scene_lookup::find_scene(Path::new(&case.scene))).collect::<Result<Vec<_>>>()?;
    let placed = cases.into_iter().zip(scenes.iter().map(scene_lookup::FoundScene::path)).collect();
    let validation = Validation::new(placed, args.full, args.repeat, args.out.clone(), command_line.to_owned())?;
    let list = JobList { jobs: &validation.jobs, threads: args.threads, quiet: args.quiet };
    list.announce(args.dry_run)?;
    if args.dry_run {
        return Ok(0);
    }
    let done = list.run_all(&interrupt_flag()?, |ran| validation.write(ran))?;
    print_output(&format!("\n{}", table(&validation.table(&done.ran))))?;
    print_output(&repeats_text(&validation.rows(&done.ran)))?;
    for file in validation.files() {
        print_output(&format!("{}\n", file.display()))?;
    }
    if done.ran.iter().any(|r| matches!(r.state, JobState::Failed(_))) {
        print_error("a case could not be run to its end\n");
    }
    Ok(list_exit_code(&done))
}

/// The list of cases.
fn case_list(cases: &[ValidationCase]) -> String {
    let mut rows = vec![["case", "quick", "scene", "about"].map(String::from).to_vec()];
    rows.extend(cases.iter().map(|case| {
        let usual = if case.quick.usual { "usual" } else { "" };
        vec![case.name.clone(), usual.into(), case.scene.clone(), case.about.clone()]
    }));
    table(&rows) + "\nrun one with: pontoon validate NAME; without a name the usual ones are run\n"
}
