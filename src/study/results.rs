//! Writes the results of a study after every run: `study.csv`, `study.json` and `study.html`.

use std::{fs, path::PathBuf};

use serde::Serialize;

use super::{
    Job, JobResult, ParameterGrid, ResultRow, convergence, html_page, least_squares,
    repeat_spread::{self, CostPoint, RepeatSpread, group_repeats, spread_of},
    result_rows::{MAX_ABS_METRIC, Metric, RELATIVE_METRICS, check_labels, result_rows},
    rows_to_csv,
};
use crate::{
    analysis::format_verdicts,
    error::{Error, Result},
    math::format::{decimals, unit},
    output::{manifest::Machine, write_atomically},
    report::{LineStyle, PlotLine, log_log_plot},
};

/// The table and the page of a study.
pub struct StudyResults {
    title: String,
    command: String,
    keys: Vec<String>,
    checks: Vec<String>,
    out: PathBuf,
    /// The jobs of the study.
    pub jobs: Vec<Job>,
}

/// The convergence of an error with the particle spacing, for one combination of values.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct OrderRow {
    check: String,
    /// The name of the error.
    error: String,
    /// The varied keys and their values.
    varied: String,
    /// The order by least squares over all spacings, –.
    least_squares: Option<f64>,
    /// The order from the three finest spacings, –.
    three_finest: Option<f64>,
    /// The grid-convergence index of the finest spacing, –.
    index: Option<f64>,
}

#[derive(Serialize)]
struct StudyJson<'a> {
    title: &'a str,
    command: &'a str,
    date: String,
    version: &'static str,
    machine: Machine,
    threads: Option<usize>,
    rows: &'a [ResultRow],
    orders: &'a [OrderRow],
    /// The spreads of the repeats; empty if no run has repeats.
    spreads: Vec<RepeatSpread>,
}

impl StudyResults {
    /// Returns the results of `grid` in the folder `out`; `command` is the command of the user.
    ///
    /// # Errors
    /// `Usage` for an invalid grid; the errors of reading the scene; `File` if the folder cannot be created.
    pub fn new(grid: &ParameterGrid, out: PathBuf, command: String) -> Result<Self> {
        let jobs = grid.jobs(&out)?;
        let mut checks = Vec::new();
        if let Some(job) = jobs.first() {
            checks = check_labels(job.checks()?.iter().map(|c| c.plan().label()));
        }
        let keys = grid.vary.iter().map(|vary| vary.key.clone()).collect();
        Ok(Self { title: format!("Study of {}", grid.name), command, keys, checks, out, jobs })
    }

    /// Returns a row for each run and check, including the runs that have not started.
    pub fn rows(&self, ran: &[JobResult]) -> Vec<ResultRow> {
        result_rows(&self.jobs, ran, &self.checks)
    }

    /// Returns the files that [`StudyResults::write`] writes.
    pub fn files(&self) -> [PathBuf; 3] {
        ["study.csv", "study.json", "study.html"].map(|name| self.out.join(name))
    }

    /// Writes all three files; `ran` contains the results of the first jobs.
    ///
    /// # Errors
    /// `File` if a file cannot be written; each file is replaced as a whole.
    pub fn write(&self, ran: &[JobResult]) -> Result<()> {
        fs::create_dir_all(&self.out).map_err(|why| Error::write(&self.out, "made", &why))?;
        let rows = self.rows(ran);
        let orders = self.orders(&rows);
        let first = ran.iter().find_map(|r| r.manifest.as_ref());
        let (machine, threads) = (first.map_or_else(Machine::current, |m| m.machine.clone()), first.map(|m| m.threads));
        let whole = StudyJson {
            title: &self.title,
            command: &self.command,
            date: html_page::timestamp(),
            version: env!("CARGO_PKG_VERSION"),
            machine: machine.clone(),
            threads,
            rows: &rows,
            orders: &orders,
            spreads: repeat_spread::repeat_spreads(&rows),
        };
        let [table, json, html] = self.files();
        write_atomically(&table, &rows_to_csv(&rows, &self.keys)?)?;
        let text = serde_json::to_string_pretty(&whole).map_err(|e| Error::file(&json, e))?;
        write_atomically(&json, (text + "\n").as_bytes())?;
        write_atomically(&html, &html_page::html_page(&self.title, &self.body(&rows, &orders, &machine, threads)))
    }

    /// Returns the error metrics that the rows of `check` contain: N, and N after removal of the delay. Without N,
    /// returns the largest distance.
    fn metrics(rows: &[ResultRow], check: &str) -> Vec<Metric> {
        let has = |metric: &Metric| rows.iter().any(|r| r.check == check && metric.1(r).is_some());
        let found: Vec<Metric> = RELATIVE_METRICS.into_iter().filter(has).collect();
        match found.is_empty() {
            true => std::iter::once(MAX_ABS_METRIC).filter(has).collect(),
            false => found,
        }
    }

    /// Returns the labels of the combinations.
    fn groups(&self) -> Vec<String> {
        let mut groups: Vec<String> = Vec::new();
        for job in &self.jobs {
            if !groups.contains(&job.group) {
                groups.push(job.group.clone());
            }
        }
        groups
    }

    /// Returns the finished rows of a check and combination, with one list of repeats for each spacing.
    fn finished_rows<'a>(&self, rows: &'a [ResultRow], check: &str, group: &str) -> Vec<Vec<&'a ResultRow>> {
        let own = |r: &ResultRow| self.jobs.iter().any(|job| job.name == r.run && job.group == group);
        group_repeats(rows).into_iter().filter(|of| of[0].check == check && own(of[0])).collect()
    }

    fn orders(&self, rows: &[ResultRow]) -> Vec<OrderRow> {
        let mut orders = Vec::new();
        for check in &self.checks {
            for (error, figure) in Self::metrics(rows, check) {
                for group in self.groups() {
                    let of = self.finished_rows(rows, check, &group);
                    let points: Vec<(f64, f64)> =
                        of.iter().filter_map(|of| Some((of[0].dp, spread_of(of, figure)?.mean))).collect();
                    let fine = convergence(&points);
                    orders.push(OrderRow {
                        check: check.clone(),
                        error: error.into(),
                        varied: group,
                        least_squares: least_squares(&points),
                        three_finest: fine.map(|c| c.order),
                        index: fine.map(|c| c.index),
                    });
                }
            }
        }
        orders
    }

    fn body(&self, rows: &[ResultRow], orders: &[OrderRow], machine: &Machine, threads: Option<usize>) -> String {
        let mut body = html_page::provenance_table(&self.command, machine, threads);
        for check in &self.checks {
            body += &format!("<h2>{}</h2>\n", html_page::escape(check));
            for (error, figure) in Self::metrics(rows, check) {
                body += &self.plot(rows, check, error, figure);
            }
            let own: Vec<&OrderRow> = orders.iter().filter(|o| o.check == *check).collect();
            body += &html_page::table(&self.order_rows(&own));
        }
        body += "<p>Order: q of error ∝ dp^q. By least squares over all spacings it is of the error itself; from the three finest, of \
                 the differences between them, and the index (Roache 1994, factor 1.25) is what the finest may still change \
                 by, relative to itself. Neither can be said (–) with fewer spacings or where the figure does not converge \
                 monotonically. Of repeats it is the mean.</p>\n";
        body += &html_page::repeats_section(rows);
        body += "<h2>Runs</h2>\n";
        body += &html_page::table(&self.run_rows(rows));
        body
    }

    /// Returns a plot of error over processor time.
    fn plot(&self, rows: &[ResultRow], check: &str, error: &str, figure: fn(&ResultRow) -> Option<f64>) -> String {
        let groups = self.groups();
        let line = |(i, group): (usize, &String)| {
            let mut points: Vec<CostPoint> =
                self.finished_rows(rows, check, group).iter().filter_map(|of| CostPoint::new(of, figure)).collect();
            points.retain(|p| p.place.0 > 0.0 && p.place.1 > 0.0);
            let labels = points.iter().map(|p| format!("{} mm", millimetres(p.dp))).collect();
            let spans = points.iter().map(|p| p.span).collect();
            let points = points.iter().map(|p| p.place).collect();
            PlotLine { labels, spans, ..PlotLine::new(group, i, LineStyle::Dotted, points) }
        };
        let lines: Vec<PlotLine> = groups.iter().enumerate().map(line).collect();
        let unit = if error == MAX_ABS_METRIC.0 { unit(check) } else { "–" };
        let svg = log_log_plot(["processor time, s", &format!("{error} of {check}, {unit}")], &lines);
        let bars = repeat_spread::error_bar_note(rows);
        let caption = format!("{error} over processor time; at each point its dp. Left and low is good.{bars}");
        html_page::plot_figure(&svg, &caption)
    }

    fn order_rows(&self, orders: &[&OrderRow]) -> Vec<Vec<String>> {
        let head = ["error", "varied", "order, least squares", "order, three finest", "index of the finest, %"];
        let mut rows = vec![head.map(String::from).to_vec()];
        rows.extend(orders.iter().map(|o| {
            let two = |x: Option<f64>| x.map_or("–".into(), |x| format!("{x:.2}"));
            let percent = o.index.map_or("–".into(), |x| format!("{:.1}", 100.0 * x));
            vec![o.error.clone(), o.varied.clone(), two(o.least_squares), two(o.three_finest), percent]
        }));
        rows
    }

    /// Returns the rows as a table of text, for a page or a terminal.
    pub fn run_rows(&self, rows: &[ResultRow]) -> Vec<Vec<String>> {
        let repeated = repeat_spread::has_repeats(rows);
        let mut head = vec!["dp, mm".to_string()];
        head.extend(self.keys.iter().cloned());
        head.extend(repeated.then(|| "repeat".to_string()));
        let rest = [
            "check",
            "N",
            "M",
            "peak",
            "off",
            "aligned N",
            "delay",
            "wall, s",
            "processors, s",
            "particle-steps",
            "status",
        ];
        head.extend(rest.map(String::from));
        let row = |r: &ResultRow| {
            let mut cells = vec![millimetres(r.dp)];
            cells.extend(r.varied.iter().map(|(_, value)| value.clone()));
            cells.extend(repeated.then(|| r.repeat.to_string()));
            cells.push(r.check.clone());
            cells.extend(
                [r.metrics.relative_l2, r.metrics.amplitude_ratio, r.metrics.peak].map(format_verdicts::format_metric),
            );
            cells.push(format_verdicts::format_value(r.metrics.off));
            cells.push(format_verdicts::format_metric(r.aligned_relative_l2));
            cells.push(r.delay_s.map_or("–".into(), format_verdicts::format_delay));
            cells.extend([r.wall_s, r.cpu_s].map(|s| s.map_or("–".into(), |s| format!("{s:.1}"))));
            cells.push(r.particle_steps.map_or("–".into(), |n| format!("{:.3e}", n as f64)));
            let why = r.reason.as_ref().and_then(|why| why.lines().next()).map(|why| format!(": {why}"));
            cells.push(format!("{}{}", r.status, why.unwrap_or_default()));
            cells
        };
        std::iter::once(head).chain(rows.iter().map(row)).collect()
    }
}

/// Returns a length (m) in millimetres as text, without round-off in the last digits.
fn millimetres(x: f64) -> String {
    decimals(1e3 * x, 6)
}
