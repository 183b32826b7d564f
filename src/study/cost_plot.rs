//! Plots the errors of the cases of one scene over processor time.

use super::{
    Job, ResultRow,
    html_page::{self, escape},
    repeat_spread::{self, CostPoint, group_repeats},
    result_rows::RELATIVE_METRICS,
};
use crate::report::{LineStyle, PlotLine, log_log_plot};

/// The scene key of the model that determines the colours.
const LAW: &str = "model.viscosity";

/// Returns plots over processor time for each scene with at least two finished `jobs` and each check with N. The plots
/// show N, and N after removal of the delay.
pub(crate) fn cost_figures(jobs: &[Job], rows: &[ResultRow]) -> String {
    let mut text = String::new();
    for scene in unique(jobs.iter().map(|job| job.group.as_str())) {
        let own: Vec<&Job> = jobs.iter().filter(|job| job.group == scene).collect();
        let known: Vec<(&Job, Vec<&ResultRow>)> = group_repeats(rows)
            .into_iter()
            .filter_map(|of| Some((*own.iter().find(|job| job.name == of[0].run)?, of)))
            .collect();
        let mut drawn = Vec::new();
        for check in unique(known.iter().map(|(_, of)| of[0].check.as_str())) {
            for (error, figure) in RELATIVE_METRICS {
                let points: Vec<(&Job, CostPoint)> = known
                    .iter()
                    .filter(|(_, of)| of[0].check == check)
                    .filter_map(|(job, of)| Some((*job, CostPoint::new(of, figure)?)))
                    .collect();
                // Two checks of one series differ only in their averaging.
                if points.len() > 1 && !drawn.contains(&points) {
                    text += &plot(scene, check, error, &points, repeat_spread::error_bar_note(rows));
                    drawn.push(points);
                }
            }
        }
    }
    match text.is_empty() {
        true => text,
        false => format!("<h2>Error against run time</h2>\n{text}"),
    }
}

/// Returns a plot with one point for each case, in the colour of its viscosity; `bars` describes the error bars.
fn plot(scene: &str, check: &str, error: &str, points: &[(&Job, CostPoint)], bars: &str) -> String {
    let laws = unique(points.iter().map(|(job, _)| viscosity(job)));
    let line = |(i, law_of_line): (usize, &&str)| {
        let own: Vec<_> = points.iter().filter(|(job, _)| viscosity(job) == *law_of_line).collect();
        let labels = own.iter().map(|(job, _)| short_name(&job.name, scene).to_string()).collect();
        let spans = own.iter().map(|(_, point)| point.span).collect();
        let points = own.iter().map(|(_, point)| point.place).collect();
        PlotLine { labels, spans, ..PlotLine::new(format!("{LAW} = {law_of_line}"), i, LineStyle::Dots, points) }
    };
    let lines: Vec<PlotLine> = laws.iter().enumerate().map(line).collect();
    let svg = log_log_plot(["processor time, s", &format!("{error} of {check}, –")], &lines);
    let title = format!("<h3>{}: {error} of {}</h3>\n", escape(scene), escape(check));
    let caption = format!("A point for each case, with its name. Left and low is good.{bars}");
    title + &html_page::plot_figure(&svg, &caption)
}

/// Returns the viscosity of a case.
fn viscosity(job: &Job) -> &str {
    job.overrides.iter().rev().find(|(key, _)| key == LAW).map_or("that of the scene", |(_, value)| value)
}

/// Returns the name of a case, without the name of its scene if the case name starts with it.
fn short_name<'a>(name: &'a str, scene: &str) -> &'a str {
    name.strip_prefix(scene).and_then(|rest| rest.strip_prefix('-')).unwrap_or(name)
}

/// Returns the distinct `words` in their original order.
fn unique<'a>(words: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut found = Vec::new();
    for word in words {
        if !found.contains(&word) {
            found.push(word);
        }
    }
    found
}

#[cfg(test)]
#[path = "../../tests/unit/study/cost_plot.rs"]
mod tests;
