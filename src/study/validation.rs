//! A validation: cases with references, their table and their page.

use std::{
    fs,
    path::{Path, PathBuf},
};

use super::{
    Case, Job, Line, Ran, State, Style, cost, csv, curves,
    page::{self, unit},
    rows::{labels, rows},
};
use crate::{
    check::{Curves, Verdict, said},
    error::{Error, Result},
    record::{manifest::Machine, write_whole},
};

/// Cases that are run, quick or full.
pub struct Validation {
    command: String,
    out: PathBuf,
    cases: Vec<Case>,
    /// The runs, one for each case.
    pub jobs: Vec<Job>,
}

impl Validation {
    /// The validation of `cases`, each with the place of its scene, in the folder `out`.
    ///
    /// # Errors
    /// Those of the scenes' words.
    pub fn new(cases: Vec<(Case, &Path)>, full: bool, out: PathBuf, command: String) -> Result<Self> {
        let jobs = cases.iter().map(|(case, scene)| case.job(full, scene, &out)).collect::<Result<_>>()?;
        Ok(Self { command, out, cases: cases.into_iter().map(|(case, _)| case).collect(), jobs })
    }

    /// Files that [`Validation::write`] writes.
    pub fn files(&self) -> [PathBuf; 2] {
        ["validation.html", "validation.csv"].map(|name| self.out.join(name))
    }

    /// The table of the first cases, of which `ran` is known; its first row is its head.
    pub fn table(&self, ran: &[Ran]) -> Vec<Vec<String>> {
        let names: Vec<[String; 1]> = self.cases.iter().map(|case| [case.name.clone()]).collect();
        let named: Vec<Vec<Verdict>> = ran.iter().map(named).collect();
        let pairs: Vec<(&[String], &Verdict)> =
            names.iter().zip(&named).flat_map(|(name, all)| all.iter().map(move |v| (&name[..], v))).collect();
        let mut table = said::rows(&pairs, &["case"]);
        let costs = ran.iter().flat_map(|ran| ran.verdicts.iter().map(|_| costs(ran)));
        let heads = ["wall, s", "processors, s", "particle-steps"].map(String::from);
        table.iter_mut().zip(std::iter::once(heads).chain(costs)).for_each(|(row, costs)| row.extend(costs));
        for (name, ran) in names.iter().zip(ran) {
            if let State::Failed(why) = &ran.state {
                table.push(vec![name[0].clone(), format!("failed: {}", why.lines().next().unwrap_or(""))]);
            }
        }
        table
    }

    /// Writes page and table; `ran` are the first cases.
    ///
    /// # Errors
    /// `File` if one cannot be written; each is replaced as a whole.
    pub fn write(&self, ran: &[Ran]) -> Result<()> {
        fs::create_dir_all(&self.out).map_err(|why| Error::file(&self.out, format!("cannot be made: {why}")))?;
        let first = ran.iter().find_map(|r| r.manifest.as_ref());
        let (machine, threads) = (first.map_or_else(Machine::this, |m| m.machine.clone()), first.map(|m| m.threads));
        let mut body = page::origin(&self.command, &machine, threads);
        body += &page::table(&self.table(ran));
        let rows = rows(&self.jobs[..ran.len()], ran, &[]);
        body += &cost::figures(&self.jobs, &rows)?;
        for ((case, job), ran) in self.cases.iter().zip(&self.jobs).zip(ran) {
            body += &section(case, job, ran)?;
        }
        let [html, table] = self.files();
        write_whole(&html, &page::page("Validation", &body))?;
        write_whole(&table, &csv(&rows, &[])?)
    }
}

/// The verdicts of a run, those of one series told apart.
fn named(ran: &Ran) -> Vec<Verdict> {
    let labels = labels(ran.verdicts.iter().map(|v| v.series.as_str()));
    labels.into_iter().zip(&ran.verdicts).map(|(series, verdict)| Verdict { series, ..verdict.clone() }).collect()
}

/// Wall time, processor time and particle-steps of a run.
fn costs(ran: &Ran) -> [String; 3] {
    ran.manifest.as_ref().map_or_else(
        || ["–"; 3].map(String::from),
        |m| [format!("{:.1}", m.wall_s), format!("{:.1}", m.cpu_s), format!("{:.3e}", m.particle_steps as f64)],
    )
}

/// What a case is, and the curves of its checks.
fn section(case: &Case, job: &Job, ran: &Ran) -> Result<String> {
    let mut text = format!("<h2>{}</h2>\n<p>{}</p>\n", page::escape(&case.name), page::escape(&case.about));
    if !case.note.is_empty() {
        text += &format!("<p>{}</p>\n", page::escape(&case.note));
    }
    let water = ran.manifest.as_ref().map_or(String::new(), |m| format!(", {} water particles", m.particles.fluid));
    text += &format!("<p>Scene <code>{}</code>, dp = {} m{water}.</p>\n", page::escape(&case.scene), job.dp);
    if ran.state != State::Finished {
        return Ok(text);
    }
    for ((curves, verdict), named) in job.curves()?.iter().zip(&ran.verdicts).zip(named(ran)) {
        text += &match curves {
            Some(curves) => plot(curves, &named, unit(&verdict.series))?,
            None => format!("<p>{}: {}</p>\n", page::escape(&named.series), page::escape(&said::remark(verdict))),
        };
    }
    Ok(text)
}

/// The run over its reference, in `unit`.
fn plot(known: &Curves, verdict: &Verdict, unit: &str) -> Result<String> {
    let (first, last) = known.reference.span();
    let room = 0.1 * (last - first);
    let points = |series: &crate::series::Series| -> Vec<(f64, f64)> {
        let all = series.times().iter().copied().zip(series.values().iter().copied());
        all.filter(|(t, _)| (first - room..=last + room).contains(t)).collect()
    };
    // A formula is a line, a measurement its samples.
    let style = if known.exact { Style::Plain } else { Style::Dots };
    let mut lines = vec![Line::new(0, Style::Plain, points(&known.sim))];
    let mut keys = vec![(0, "run".to_string())];
    if let (Some(series), Some(meaned)) = (&known.meaned, verdict.meaned) {
        lines.push(Line::new(2, Style::Plain, points(series)));
        keys.push((2, format!("run, mean over {} ms", 1e3 * meaned.seconds)));
    }
    lines.push(Line::new(1, style, points(&known.reference)));
    keys.push((1, "reference".to_string()));
    let svg = curves(["time, s", &format!("{}, {unit}", verdict.series)], &lines)?;
    let head_and_row = said::rows(&[(&[], verdict)], &[]);
    let figures: Vec<String> = head_and_row[0]
        .iter()
        .zip(&head_and_row[1])
        .skip(1)
        .filter(|(_, figure)| !figure.is_empty())
        .map(|(head, figure)| format!("{head} {figure}").trim().to_string())
        .collect();
    Ok(page::figure(&svg, &keys, &figures.join("; ")))
}
