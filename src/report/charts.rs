//! Converts the series of a run for the plots of the page: thins the rows, keeps the peaks and groups the columns into
//! charts.

use serde::Serialize;

use super::{
    encoding::BinaryData,
    run_data::{ProbeTable, RunData},
};
use crate::{
    analysis,
    analysis::Verdict,
    math::{
        format::{column_label, unit},
        readings::reading_times,
        time_series::TimeSeries,
    },
    run::RaoResult,
};

/// The number of rows above which a table is thinned.
const MOST_ROWS: usize = 6000;

/// The description of a table for the page. The position fields are positions in the binary data.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct TablePlots {
    /// The name of the probe.
    pub name: String,
    /// The measured quantity, as a short text.
    pub what: &'static str,
    /// The number of kept rows and the number of rows of the table.
    pub rows: [usize; 2],
    /// The position of the first time.
    pub t: usize,
    /// The columns of the table.
    pub columns: Vec<PlotColumn>,
    /// The charts, each with its columns.
    pub charts: Vec<Chart>,
    /// The kinds of a budget or balance that are 0 at all times; the page does not draw these kinds.
    pub idle: Vec<String>,
    /// The spectra of the oscillating columns that the page shows.
    pub spectra: Vec<ColumnSpectrum>,
}

/// A column of a table.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct PlotColumn {
    /// The name of the column in the table.
    pub name: String,
    /// The label of the column for the reader.
    pub label: String,
    /// The unit of the column.
    pub unit: &'static str,
    /// The position of the first value.
    pub x: usize,
}

/// A chart.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Chart {
    /// The numbers of the columns in the chart.
    pub columns: Vec<usize>,
    /// Whether the chart is initially collapsed.
    pub folded: bool,
    /// The title, if it differs from the names of the columns.
    pub title: Option<String>,
}

/// The spectrum of a column.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct ColumnSpectrum {
    /// The number of the column.
    pub column: usize,
    /// The number of frequencies.
    pub rows: usize,
    /// The position of the first frequency (Hz).
    pub f: usize,
    /// The position of the first spectral density.
    pub s: usize,
}

/// The response amplitude operator (RAO) of a motion in irregular waves.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct RaoPlot<'a> {
    /// The name of the statistic.
    pub name: &'a str,
    /// The label of the motion for the reader.
    pub label: String,
    /// The unit of the ratio.
    pub unit: &'a str,
    /// The number of frequencies.
    pub rows: usize,
    /// The position of the first frequency (Hz).
    pub f: usize,
    /// The position of the first ratio.
    pub rao: usize,
    /// The position of the first phase (degrees).
    pub phase: usize,
    /// The position of the first coherence.
    pub coherence: usize,
}

/// A check and its curves.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct CheckPlot {
    /// The series, as `probe.column`, with the time at which its value was set to zero.
    pub series: String,
    /// The label of the series for the reader.
    pub label: String,
    /// The unit of the series.
    pub unit: &'static str,
    /// The simulated curve without averaging.
    pub sim: CurveData,
    /// The simulated curve, averaged as the instrument averages it.
    pub meaned: Option<CurveData>,
    /// The reference curve.
    pub reference: CurveData,
    /// Whether the reference is a formula.
    pub exact: bool,
    /// The numbers of the verdict, as a caption.
    pub caption: String,
}

/// The positions of a curve in the binary data.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct CurveData {
    /// The number of samples.
    pub rows: usize,
    /// The position of the first time.
    pub t: usize,
    /// The position of the first value.
    pub x: usize,
}

/// Groups of columns by their names without units. The page shows the first groups and collapses the others.
const FAMILIES: [(&[&str], bool); 20] = [
    (&["surge", "sway", "heave"], false),
    (&["roll", "pitch", "yaw"], false),
    (&["fx", "fy", "fz"], false),
    (&["torque", "tx", "ty", "tz"], false),
    (&["eta"], false),
    (&["p"], false),
    (&["p mean", "p max"], false),
    (&["runup"], false),
    (&["flow"], false),
    (&["volume"], false),
    (&["front"], false),
    (&["fairlead", "anchor", "largest"], false),
    (&["entered", "left"], false),
    (&["water kinetic", "water potential", "water compression", "bodies kinetic", "bodies potential", "total"], false),
    (&["quarter", "middle", "three quarters"], true),
    (&["momentum x", "momentum y", "momentum z"], true),
    (&["level", "below 1", "below 2", "below 3"], true),
    (&["vx", "vy", "vz"], true),
    (&["spin", "spin x", "spin y", "spin z"], true),
    (&["x", "y", "z"], true),
];

/// Adds `table` to `blob`, and returns the description of the table for the page.
pub(crate) fn encode_table(table: &ProbeTable, blob: &mut BinaryData) -> TablePlots {
    let rows = thinned_rows(table);
    let has_means = table.are_means.contains(&true);
    let times = reading_times(&table.times, has_means);
    let t = blob.push_floats(rows.iter().map(|&i| times[i] as f32));
    let columns = table.columns.iter().enumerate().map(|(column, name)| {
        let x = &table.values[column];
        // Beside means, a total at the middle of the interval is that between two rows.
        let is_between = has_means && !table.are_means[column];
        let value = |i: usize| if is_between && i > 0 { 0.5 * (x[i - 1] + x[i]) } else { x[i] };
        let x = blob.push_floats(rows.iter().map(|&i| value(i) as f32));
        PlotColumn { name: name.clone(), label: column_label(name), unit: unit(name), x }
    });
    let columns = columns.collect();
    let (charts, idle) = match table.is_breakdown() {
        true => breakdown_charts(table),
        false => (group_columns(&table.columns), vec![]),
    };
    let charts = fold_empty_charts(charts, &table.values);
    TablePlots {
        name: table.name.clone(),
        what: table.what,
        rows: [rows.len(), table.times.len()],
        t,
        columns,
        idle,
        spectra: encode_spectra(table, &charts, blob),
        charts,
    }
}

/// Adds the spectra of the shown columns of `table` to `blob`, and returns their descriptions. A column needs enough
/// waves.
fn encode_spectra(table: &ProbeTable, charts: &[Chart], blob: &mut BinaryData) -> Vec<ColumnSpectrum> {
    let shown = charts.iter().filter(|chart| !chart.folded).flat_map(|chart| chart.columns.iter().copied());
    let of = |column: usize| {
        let spectrum = analysis::displayed_spectrum(&table.readings(column)?)?;
        let f = blob.push_floats(spectrum.frequencies().map(|f| f as f32));
        let s = blob.push_floats(spectrum.density.iter().map(|s| *s as f32));
        Some(ColumnSpectrum { column, rows: spectrum.density.len(), f, s })
    };
    shown.filter_map(of).collect()
}

/// Adds the response amplitude operators over frequency to `blob`, and returns their descriptions.
pub(crate) fn encode_raos<'a>(answers: &'a [RaoResult], blob: &mut BinaryData) -> Vec<RaoPlot<'a>> {
    let of = |rows: &'a [RaoResult]| {
        let (probe, column) = rows[0].series.split_once('.').unwrap_or(("", &rows[0].series));
        let mut put = |x: fn(&RaoResult) -> f64| blob.push_floats(rows.iter().map(|row| x(row) as f32));
        RaoPlot {
            name: &rows[0].name,
            label: format!("{probe} {}", column_label(column)),
            unit: &rows[0].unit,
            rows: rows.len(),
            f: put(|row| row.point.frequency),
            rao: put(|row| row.point.ratio),
            phase: put(RaoResult::phase_degrees),
            coherence: put(|row| row.point.coherence),
        }
    };
    answers.chunk_by(|a, b| (&a.name, &a.series) == (&b.name, &b.series)).map(of).collect()
}

/// Returns the rows of a table that the plots need: the minimum and maximum of every column in each of many equal
/// intervals.
fn thinned_rows(table: &ProbeTable) -> Vec<usize> {
    let all = table.times.len();
    if all <= MOST_ROWS {
        return (0..all).collect();
    }
    let stretch = all.div_ceil(MOST_ROWS / (2 * table.values.len()).clamp(1, 8));
    let mut rows = vec![0, all - 1];
    for from in (0..all).step_by(stretch) {
        let here = from..(from + stretch).min(all);
        for x in &table.values {
            let ends = [
                here.clone().min_by(|a, b| x[*a].total_cmp(&x[*b])),
                here.clone().max_by(|a, b| x[*a].total_cmp(&x[*b])),
            ];
            rows.extend(ends.into_iter().flatten());
        }
    }
    rows.sort_unstable();
    rows.dedup();
    rows
}

/// Returns the charts of the columns: first the groups of related columns, then a separate chart for each other column.
fn group_columns(columns: &[String]) -> Vec<Chart> {
    // All gauges of an array share one chart, wherever the gauges are.
    let names: Vec<String> =
        columns.iter().map(|name| column_label(name.split("_at_").next().unwrap_or(name))).collect();
    let mut left: Vec<usize> = (0..columns.len()).collect();
    let mut charts = Vec::new();
    for (family, folded) in FAMILIES {
        let own: Vec<usize> = left.iter().copied().filter(|&i| family.contains(&names[i].as_str())).collect();
        left.retain(|i| !own.contains(i));
        // The chart stays open if no other chart would be open.
        let folded = folded && (!charts.is_empty() || !left.is_empty());
        if !own.is_empty() {
            charts.push(Chart { columns: own, folded, title: None });
        }
    }
    charts.extend(left.into_iter().map(|i| Chart { columns: vec![i], folded: false, title: None }));
    if charts.iter().all(|chart| chart.folded) {
        charts.iter_mut().for_each(|chart| chart.folded = false);
    }
    charts
}

/// Returns the charts of a budget or balance, and the kinds that are 0 at all times. Each direction has one chart of
/// its non-zero kinds. The chart of the remainder is initially collapsed, because the remainder is too small to be
/// visible beside the other kinds.
fn breakdown_charts(table: &ProbeTable) -> (Vec<Chart>, Vec<String>) {
    let mut charts: Vec<Chart> = Vec::new();
    let mut kinds: Vec<(String, bool)> = Vec::new();
    for (i, name) in table.columns.iter().enumerate() {
        let (label, idle) = (column_label(name), table.is_zero(i));
        let (kind, way) = label.rsplit_once(' ').unwrap_or((&label, ""));
        match kinds.iter_mut().find(|known| known.0 == kind) {
            Some(known) => known.1 &= idle,
            None => kinds.push((kind.into(), idle)),
        }
        if idle {
            continue;
        }
        let folded = kind == "residual";
        let title = match (way, folded) {
            ("", false) => "energy by entry".into(),
            (way, false) => format!("{way} by kind"),
            (way, true) => format!("residual {way}").trim_end().into(),
        };
        match charts.iter_mut().find(|chart| chart.title.as_ref() == Some(&title)) {
            Some(chart) => chart.columns.push(i),
            None => charts.push(Chart { columns: vec![i], folded, title: Some(title) }),
        }
    }
    (charts, kinds.into_iter().filter(|kind| kind.1).map(|kind| kind.0).collect())
}

/// Collapses the charts of the columns `x` without numbers, such as those of a dry gauge; at least one chart stays
/// open.
fn fold_empty_charts(mut charts: Vec<Chart>, x: &[Vec<f64>]) -> Vec<Chart> {
    let empty = |chart: &Chart| chart.columns.iter().all(|&i| x[i].iter().all(|x| x.is_nan()));
    charts.iter_mut().for_each(|chart| chart.folded |= empty(chart));
    if charts.iter().all(|chart| chart.folded) {
        charts.iter_mut().for_each(|chart| chart.folded = empty(chart));
    }
    charts
}

/// Adds the checks of `run` that have curves to `blob`, and returns their descriptions; `caption` formats the numbers
/// of a verdict.
pub(crate) fn encode_checks(
    run: &RunData,
    caption: impl Fn(&Verdict) -> String,
    blob: &mut BinaryData,
) -> Vec<CheckPlot> {
    let verdicts = &run.manifest.checks;
    let mut line = |series: &TimeSeries| CurveData {
        rows: series.times().len(),
        t: blob.push_floats(series.times().iter().map(|t| *t as f32)),
        x: blob.push_floats(series.values().iter().map(|x| *x as f32)),
    };
    let mut held = Vec::new();
    for (i, (check, curves)) in run.checks.iter().enumerate() {
        let Some(curves) = curves else { continue };
        let series = check.plan().label();
        let column = series.split_once('.').map_or(series.as_str(), |(_, column)| column);
        held.push(CheckPlot {
            label: column_label(column.split(',').next().unwrap_or(column)),
            unit: unit(column),
            sim: line(&curves.sim),
            meaned: curves.running_mean.as_ref().map(&mut line),
            reference: line(&curves.reference),
            exact: curves.exact,
            caption: verdicts.get(i).map(&caption).unwrap_or_default(),
            series,
        });
    }
    held
}

#[cfg(test)]
#[path = "../../tests/unit/report/charts.rs"]
mod tests;
