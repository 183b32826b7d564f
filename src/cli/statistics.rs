//! `pontoon stats`: what is said of a run's series, in tables or as JSON.

use std::path::PathBuf;

use crate::{
    error::{Error, ErrorKind, Result},
    math::format::three_digits,
    run::{RaoResult, RunStatistics, Statistic, StatisticsFilter, statistics},
};
use clap::Args;
use serde::Serialize;

use super::{console_text::table, print_error};

/// Which run, and which part of it.
#[derive(Args)]
pub struct StatsArgs {
    /// Folder of the run
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Only this probe, or this series, as in gauge.eta_m
    #[arg(long, value_name = "NAME[.COLUMN]")]
    series: Option<String>,
    /// First time that counts, s
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    from: Option<f64>,
    /// Last time that counts, s
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    until: Option<f64>,
    /// Print only how motions answer irregular waves over frequency, as in rao.csv
    #[arg(long)]
    rao: bool,
    /// Print the figures as JSON, with --rao the answers over frequency
    #[arg(long)]
    json: bool,
}

/// The figures of every series, a column for each.
const FIGURES: [&str; 12] =
    ["mean", "std", "min", "max", "waves", "H_mean", "H_third", "H_max", "T_z", "H_m0", "T_p", "T_m02"];

/// The tables, or the JSON.
pub fn stats(args: &StatsArgs) -> Result<String> {
    let asked = StatisticsFilter { series: args.series.clone(), from: args.from, until: args.until };
    let told = statistics(&args.folder, &asked)?;
    told.remarks.iter().for_each(|remark| print_error(&format!("warning: {remark}\n")));
    if args.rao && told.raos.is_empty() {
        return Err(no_rao(args));
    }
    match (args.rao, args.json) {
        (true, true) => json(&told.raos),
        (true, false) => Ok(table(&rao_rows(&told.raos))),
        (false, true) => json(&told.rows),
        (false, false) => Ok(tables(&told)),
    }
}

/// That no motion answers irregular waves in what is asked for.
fn no_rao(args: &StatsArgs) -> Error {
    let of = args.series.as_ref().map_or(String::new(), |series| format!(" of {series:?}"));
    let what = format!("there is no answer{of} to irregular waves over frequency in {}", args.folder.display());
    Error::new(ErrorKind::Usage, what).help(
        "a [[statistic]] with  rao = { motion = \"box\", wave = \"gauge\" }  and without  period  asks for it, \
         and 32 waves or more at the gauge tell it",
    )
}

fn json<T: Serialize>(rows: &[T]) -> Result<String> {
    let text = serde_json::to_string_pretty(rows).map_err(|why| Error::new(ErrorKind::Usage, why.to_string()))?;
    Ok(text + "\n")
}

/// All tables that have rows.
fn tables(told: &RunStatistics) -> String {
    let (plain, declared): (Vec<_>, Vec<_>) = told.rows.iter().partition(|row| row.name.is_empty());
    let mut text = table(&series_rows(&plain));
    if !declared.is_empty() {
        text += &format!("\n{}", table(&declared_rows(&declared)));
    }
    if !told.raos.is_empty() {
        text += &format!("\n{}", table(&rao_rows(&told.raos)));
    }
    text
}

/// A row for each series; what none of them has is left out.
fn series_rows(rows: &[&Statistic]) -> Vec<Vec<String>> {
    let figures: Vec<&str> = FIGURES.into_iter().filter(|f| rows.iter().any(|row| row.quantity == *f)).collect();
    let head = ["series", "unit"].into_iter().chain(figures.iter().copied());
    let mut lines = vec![head.map(String::from).collect::<Vec<_>>()];
    for of in rows.chunk_by(|a, b| a.series == b.series) {
        let value =
            |f: &&str| of.iter().find(|row| row.quantity == *f).map_or(String::new(), |row| three_digits(row.value));
        let mut line = vec![of[0].series.clone(), of[0].unit.clone()];
        line.extend(figures.iter().map(value));
        lines.push(line);
    }
    lines
}

/// A row for each figure that the scene asks for.
fn declared_rows(rows: &[&Statistic]) -> Vec<Vec<String>> {
    let mut lines =
        vec![["statistic", "series", "figure", "value", "unit", "from (s)", "until (s)"].map(String::from).to_vec()];
    lines.extend(rows.iter().map(|row| {
        let span = [row.from_s, row.until_s].map(|t| format!("{t:.3}"));
        let [from, until] = span;
        vec![
            row.name.clone(),
            row.series.clone(),
            row.quantity.into(),
            three_digits(row.value),
            row.unit.clone(),
            from,
            until,
        ]
    }));
    lines
}

/// A row for each frequency of each motion that answers irregular waves.
fn rao_rows(answers: &[RaoResult]) -> Vec<Vec<String>> {
    let head = ["statistic", "series", "frequency (Hz)", "period (s)", "rao", "unit", "phase (°)", "coherence"];
    let row = |answer: &RaoResult| {
        let RaoResult { name, series, unit, point } = answer;
        let (frequency, period) = (format!("{:.4}", point.frequency), format!("{:.3}", 1.0 / point.frequency));
        let [ratio, phase, coherence] = [point.ratio, answer.phase_degrees(), point.coherence].map(three_digits);
        vec![name.clone(), series.clone(), frequency, period, ratio, unit.clone(), phase, coherence]
    };
    [head.map(String::from).to_vec()].into_iter().chain(answers.iter().map(row)).collect()
}
