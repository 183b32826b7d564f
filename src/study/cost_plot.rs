//! What the cases of one scene cost, beside what they are worth: error over processor time.

use super::{
    Job, ResultRow,
    html_page::{self, escape},
    repeat_spread::{self, CostPoint, group_repeats},
    result_rows::RELATIVE_METRICS,
};
use crate::report::{LineStyle, PlotLine, log_log_plot};

/// The law that tells the colours apart.
const LAW: &str = "model.viscosity";

/// For every scene of which two or more of `jobs` have finished, and every check with N: N, and N with the
/// delay taken out, over processor time.
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
                // Two checks of one series differ in their means alone.
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

/// One point for each case, in the colour of its viscosity; `bars` says what its bar is.
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

/// The viscosity of a case.
fn viscosity(job: &Job) -> &str {
    job.overrides.iter().rev().find(|(key, _)| key == LAW).map_or("that of the scene", |(_, value)| value)
}

/// The name of a case without that of its scene, where it starts with it.
fn short_name<'a>(name: &'a str, scene: &str) -> &'a str {
    name.strip_prefix(scene).and_then(|rest| rest.strip_prefix('-')).unwrap_or(name)
}

/// Each of `words` once, in their order.
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
