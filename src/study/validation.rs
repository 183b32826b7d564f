//! A validation consists of cases with references. This module creates its table and its page.

use std::{
    fs,
    path::{Path, PathBuf},
};

use super::{
    Job, JobResult, JobState, ResultRow, ValidationCase, cost_plot, html_page,
    result_rows::{check_labels, result_rows},
    rows_to_csv,
};
use crate::{
    analysis::{CheckCurves, Verdict, format_verdicts},
    error::{Error, Result},
    math::{format::unit, time_series::TimeSeries},
    output::{manifest::Machine, write_atomically},
    report::{LineStyle, PlotLine, line_plot},
};

/// A validation with its cases, quick or full.
pub struct Validation {
    command: String,
    out: PathBuf,
    cases: Vec<ValidationCase>,
    repeat: usize,
    /// The jobs, grouped by case; each group contains the repeats of the case.
    pub jobs: Vec<Job>,
}

impl Validation {
    /// Returns the validation of `cases`, each with the path of its scene, in the folder `out`. Each case runs `repeat`
    /// times.
    ///
    /// # Errors
    /// The errors of reading the scenes and of [`Job::repeated`].
    pub fn new(
        cases: Vec<(ValidationCase, &Path)>,
        full: bool,
        repeat: usize,
        out: PathBuf,
        command: String,
    ) -> Result<Self> {
        let jobs = cases.iter().map(|(case, scene)| case.job(full, scene, &out)?.repeated(repeat));
        let jobs = jobs.collect::<Result<Vec<_>>>()?.concat();
        Ok(Self { command, out, cases: cases.into_iter().map(|(case, _)| case).collect(), repeat, jobs })
    }

    /// Returns the files that [`Validation::write`] writes.
    pub fn files(&self) -> [PathBuf; 2] {
        ["validation.html", "validation.csv"].map(|name| self.out.join(name))
    }

    /// Returns the table of the first jobs, whose results are `ran`, with a header row.
    pub fn table(&self, ran: &[JobResult]) -> Vec<Vec<String>> {
        let names: Vec<[String; 1]> = self.jobs.iter().map(|job| [job.display_name()]).collect();
        let named: Vec<Vec<Verdict>> = ran.iter().map(labelled_verdicts).collect();
        let pairs: Vec<(&[String], &Verdict)> =
            names.iter().zip(&named).flat_map(|(name, all)| all.iter().map(move |v| (&name[..], v))).collect();
        let mut table = format_verdicts::verdict_rows(&pairs, &["case"]);
        let costs = ran.iter().flat_map(|ran| ran.verdicts.iter().map(|_| cost_cells(ran)));
        let heads = ["wall, s", "processors, s", "particle-steps"].map(String::from);
        table.iter_mut().zip(std::iter::once(heads).chain(costs)).for_each(|(row, costs)| row.extend(costs));
        for (name, ran) in names.iter().zip(ran) {
            if let JobState::Failed(why) = &ran.state {
                table.push(vec![name[0].clone(), format!("failed: {}", why.lines().next().unwrap_or(""))]);
            }
        }
        table
    }

    /// Returns a row for each check of the first jobs, whose results are `ran`.
    pub fn rows(&self, ran: &[JobResult]) -> Vec<ResultRow> {
        result_rows(&self.jobs[..ran.len()], ran, &[])
    }

    /// Writes the page and the table; `ran` contains the results of the first jobs.
    ///
    /// # Errors
    /// `File` if a file cannot be written; each file is replaced as a whole.
    pub fn write(&self, ran: &[JobResult]) -> Result<()> {
        fs::create_dir_all(&self.out).map_err(|why| Error::write(&self.out, "made", &why))?;
        let first = ran.iter().find_map(|r| r.manifest.as_ref());
        let (machine, threads) = (first.map_or_else(Machine::current, |m| m.machine.clone()), first.map(|m| m.threads));
        let mut body = html_page::provenance_table(&self.command, &machine, threads);
        body += &html_page::table(&self.table(ran));
        let rows = self.rows(ran);
        body += &html_page::repeats_section(&rows);
        body += &cost_plot::cost_figures(&self.jobs, &rows);
        for ((case, jobs), ran) in self.cases.iter().zip(self.jobs.chunks(self.repeat)).zip(ran.chunks(self.repeat)) {
            body += &section(case, jobs, ran)?;
        }
        let [html, table] = self.files();
        write_atomically(&html, &html_page::html_page("Validation", &body))?;
        write_atomically(&table, &rows_to_csv(&rows, &[])?)
    }
}

/// Returns the verdicts of a run, with numbers that distinguish verdicts of the same series.
fn labelled_verdicts(ran: &JobResult) -> Vec<Verdict> {
    let labels = check_labels(ran.verdicts.iter().map(|v| v.series.as_str()));
    labels.into_iter().zip(&ran.verdicts).map(|(series, verdict)| Verdict { series, ..verdict.clone() }).collect()
}

/// Returns the wall time, processor time and particle-steps of a run as text.
fn cost_cells(ran: &JobResult) -> [String; 3] {
    ran.manifest.as_ref().map_or_else(
        || ["–"; 3].map(String::from),
        |m| [format!("{:.1}", m.wall_s), format!("{:.1}", m.cpu_s), format!("{:.3e}", m.particle_steps as f64)],
    )
}

/// Returns the section of a case: its description, and the curves of its checks for all repeats that have run.
fn section(case: &ValidationCase, jobs: &[Job], ran: &[JobResult]) -> Result<String> {
    let mut text = format!("<h2>{}</h2>\n<p>{}</p>\n", html_page::escape(&case.name), html_page::escape(&case.about));
    if !case.note.is_empty() {
        text += &format!("<p>{}</p>\n", html_page::escape(&case.note));
    }
    let water = ran[0].manifest.as_ref().map_or(String::new(), |m| format!(", {} water particles", m.particles.fluid));
    text += &format!("<p>Scene <code>{}</code>, dp = {} m{water}.</p>\n", html_page::escape(&case.scene), jobs[0].dp);
    let finished = || jobs.iter().zip(ran).filter(|(_, ran)| ran.state == JobState::Finished);
    let curves = finished().map(|(job, _)| job.curves()).collect::<Result<Vec<_>>>()?;
    let verdicts: Vec<Vec<Verdict>> = finished().map(|(_, ran)| labelled_verdicts(ran)).collect();
    for check in 0..verdicts.first().map_or(0, Vec::len) {
        let known: Vec<&CheckCurves> = curves.iter().filter_map(|all| all.get(check)?.as_ref()).collect();
        let verdicts: Vec<&Verdict> = verdicts.iter().filter_map(|all| all.get(check)).collect();
        text += &match known.is_empty() {
            false => plot(&known, &verdicts),
            true => {
                format!(
                    "<p>{}: {}</p>\n",
                    html_page::escape(&verdicts[0].series),
                    html_page::escape(&format_verdicts::format_outcome(verdicts[0]))
                )
            }
        };
    }
    Ok(text)
}

/// Returns a plot of the curves `known` of the repeats of a case with their reference. The metrics of `verdicts` follow
/// the plot.
fn plot(known: &[&CheckCurves], verdicts: &[&Verdict]) -> String {
    let (reference, verdict) = (&known[0].reference, verdicts[0]);
    let (first, last) = reference.span();
    let room = 0.1 * (last - first);
    let points = |series: &TimeSeries| -> Vec<(f64, f64)> {
        let all = series.times().iter().copied().zip(series.values().iter().copied());
        all.filter(|(t, _)| (first - room..=last + room).contains(t)).collect()
    };
    // A formula appears as a line, a measurement as dots.
    let style = if known[0].exact { LineStyle::Plain } else { LineStyle::Dots };
    let runs = if known.len() > 1 { format!("{} runs", known.len()) } else { "run".into() };
    let run = |of: &&CheckCurves| PlotLine::new(runs.as_str(), 0, LineStyle::Plain, points(&of.sim));
    let mut lines: Vec<PlotLine> = known.iter().map(run).collect();
    if let Some(meaned) = verdict.meaned {
        let means = known.iter().filter_map(|of| of.running_mean.as_ref());
        let name = format!("the same, mean over {} ms", 1e3 * meaned.seconds);
        lines.extend(means.map(|series| PlotLine::new(name.as_str(), 2, LineStyle::Plain, points(series))));
    }
    lines.push(PlotLine::new("reference", 1, style, points(reference)));
    let svg = line_plot(["time, s", &format!("{}, {}", verdict.series, unit(&verdict.series))], &lines);
    let figures: Vec<String> = verdicts.iter().map(|verdict| metrics_line(verdict)).collect();
    html_page::plot_figure(&svg, &figures.join(". "))
}

/// Returns the metrics of a check in one line.
fn metrics_line(verdict: &Verdict) -> String {
    let head_and_row = format_verdicts::verdict_rows(&[(&[], verdict)], &[]);
    let pairs = head_and_row[0].iter().zip(&head_and_row[1]).skip(1).filter(|(_, figure)| !figure.is_empty());
    pairs.map(|(head, figure)| format!("{head} {figure}").trim().to_string()).collect::<Vec<_>>().join("; ")
}
