//! `pontoon stress`: maps of hard cases, each judged by physics.

use std::{path::PathBuf, sync::atomic::Ordering};

use crate::{
    error::Result,
    math::format::duration,
    study::stress::{CaseOutcome, CaseResult, StressMap, StressResults, maps, select_maps, summary_line},
};
use clap::Args;

use super::{console_text::table, interrupt_flag_with_message, print_error, print_output};

/// Maps and how they are run.
#[derive(Args)]
pub struct StressArgs {
    /// Maps of `--list` [default: all; if quick, all but the slow ones]
    #[arg(value_name = "MAP")]
    names: Vec<String>,
    /// The ends of every axis alone: some minutes
    #[arg(long)]
    quick: bool,
    /// Maps of your own in place of the program's
    #[arg(long, value_name = "FILE")]
    maps: Option<PathBuf>,
    /// Cases that run side by side [default: one for each processor]
    #[arg(long, value_name = "N", value_parser = super::thread_count)]
    threads: Option<usize>,
    /// Folder for results
    #[arg(long, value_name = "DIR", default_value = "stress")]
    out: PathBuf,
    /// List the maps; run nothing
    #[arg(long)]
    list: bool,
    /// Say which cases would be run; run nothing
    #[arg(long)]
    dry_run: bool,
    /// Say nothing but errors, the table and what is wrong
    #[arg(long, short)]
    quiet: bool,
}

/// Runs the maps, or lists them.
pub fn stress(args: StressArgs) -> Result<u8> {
    let all = maps(args.maps.as_deref())?;
    if args.list {
        return print_output(&map_list(&all)).map(|()| 0);
    }
    let mut ledger = StressResults::open(select_maps(all, &args.names, args.quick)?, args.quick, args.out.clone())?;
    let due = ledger.entries.iter().filter(|entry| entry.run.is_none()).count();
    if args.dry_run {
        let lines: String = ledger.entries.iter().map(case_line).collect();
        return print_output(&format!("{lines}{} cases, {due} to be run\n", ledger.entries.len())).map(|()| 0);
    }
    let stop =
        interrupt_flag_with_message("\nstopping after the cases in hand; Ctrl-C again stops at once, without them\n")?;
    let threads = args.threads.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, |n| n.get()));
    let mut done = 0;
    ledger.run_missing(threads, &stop, |entry| {
        done += 1;
        if !args.quiet {
            print_error(&format!("{done}/{due} {}", case_line(entry)));
        }
    })?;
    let pictures = ledger.write()?;
    let wrong = |entry: &&CaseResult| entry.verdict().is_some_and(|(outcome, _)| outcome == CaseOutcome::Wrong);
    let wrong_lines: String = ledger.entries.iter().filter(wrong).map(case_line).collect();
    print_output(&format!(
        "\n{}{wrong_lines}processor time {}\n{}\n{} pictures, as {}\n",
        table(&ledger.table()),
        duration(ledger.cpu_seconds()),
        ledger.file().display(),
        pictures.len(),
        pictures.first().map_or(String::new(), |p| p.display().to_string())
    ))?;
    Ok(if stop.load(Ordering::Relaxed) {
        print_error("interrupted: the same command continues\n");
        130
    } else if ledger.entries.iter().any(|entry| wrong(&entry)) {
        3
    } else {
        0
    })
}

/// A case in a line.
fn case_line(entry: &CaseResult) -> String {
    format!("{} {}\n", entry.case.map, summary_line(entry))
}

/// The list of maps.
fn map_list(all: &[StressMap]) -> String {
    let mut rows = vec![["map", "cases", "along", "about"].map(String::from).to_vec()];
    rows.extend(all.iter().map(|map| {
        let axes: Vec<&str> = std::iter::once(&map.x).chain(&map.y).map(|axis| axis.label.as_str()).collect();
        vec![map.name.clone(), map.count().to_string(), axes.join(" × "), map.about.clone()]
    }));
    let sum: usize = all.iter().map(StressMap::count).sum();
    format!("{}\n{sum} cases; run one map with: pontoon stress MAP; without a name all are run\n", table(&rows))
}
