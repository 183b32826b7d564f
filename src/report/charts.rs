//! The series of a run as the page's plots take them: thinned without losing a peak, sorted into charts.

use serde::Serialize;

use super::{
    encoding::BinaryData,
    run_data::{ProbeTable, RunData},
    summary_tables::column_series,
};
use crate::{
    analysis,
    analysis::Verdict,
    math::{
        format::{column_label, unit},
        time_series::TimeSeries,
    },
    run::RaoResult,
};

/// Rows of a table above which it is thinned.
const MOST_ROWS: usize = 6000;

/// What the page says of a table; numbers are places in the blob.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct TablePlots {
    /// Name of the probe.
    pub name: String,
    /// What it watches, in a word.
    pub what: &'static str,
    /// Kept rows, and rows of the table.
    pub rows: [usize; 2],
    /// Where the times begin.
    pub t: usize,
    /// Its columns.
    pub columns: Vec<PlotColumn>,
    /// Which columns stand in one chart.
    pub charts: Vec<Chart>,
    /// Of a budget or a balance the kinds that are 0 throughout: they are not drawn.
    pub idle: Vec<String>,
    /// Spectra of what swings of the columns that are shown.
    pub spectra: Vec<ColumnSpectrum>,
}

/// A column.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct PlotColumn {
    /// Its name as in the table.
    pub name: String,
    /// Its name in words.
    pub label: String,
    /// Its unit.
    pub unit: &'static str,
    /// Where its numbers begin.
    pub x: usize,
}

/// A chart.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Chart {
    /// Numbers of its columns.
    pub columns: Vec<usize>,
    /// Whether it may wait behind a fold.
    pub folded: bool,
    /// What stands over it, where that is not the names of its columns.
    pub title: Option<String>,
}

/// The spectrum of a column.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct ColumnSpectrum {
    /// Number of the column.
    pub column: usize,
    /// Number of frequencies.
    pub rows: usize,
    /// Where the frequencies (Hz) begin.
    pub f: usize,
    /// Where the densities begin.
    pub s: usize,
}

/// How a motion answers irregular waves.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct RaoPlot<'a> {
    /// Name of the statistic.
    pub name: &'a str,
    /// The motion, in words.
    pub label: String,
    /// Unit of the ratio.
    pub unit: &'a str,
    /// Number of frequencies.
    pub rows: usize,
    /// Where the frequencies (Hz) begin.
    pub f: usize,
    /// Where the ratios begin.
    pub rao: usize,
    /// Where the phases (degrees) begin.
    pub phase: usize,
    /// Where the coherences begin.
    pub coherence: usize,
}

/// A check and its curves.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct CheckPlot {
    /// The series, as `probe.column`, with when it was set to zero.
    pub series: String,
    /// Its name in words.
    pub label: String,
    /// Its unit.
    pub unit: &'static str,
    /// The run as it is.
    pub sim: CurveData,
    /// The run as its instrument shows it.
    pub meaned: Option<CurveData>,
    /// What it is held against.
    pub reference: CurveData,
    /// Whether that is a formula.
    pub exact: bool,
    /// The figures in words.
    pub caption: String,
}

/// A curve in the blob.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct CurveData {
    /// Number of samples.
    pub rows: usize,
    /// Where the times begin.
    pub t: usize,
    /// Where the values begin.
    pub x: usize,
}

/// Columns that belong together, by their names without units. The first sets are shown, the others wait behind a fold.
const FAMILIES: [(&[&str], bool); 16] = [
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
    (&["water kinetic", "water potential", "water compression", "bodies kinetic", "bodies potential", "total"], false),
    (&["level", "below 1", "below 2", "below 3"], true),
    (&["vx", "vy", "vz"], true),
    (&["spin", "spin x", "spin y", "spin z"], true),
    (&["x", "y", "z"], true),
];

/// Adds `table` to `blob`.
pub(crate) fn encode_table(table: &ProbeTable, blob: &mut BinaryData) -> TablePlots {
    let rows = thinned_rows(table);
    let t = blob.push_floats(rows.iter().map(|&i| table.times[i] as f32));
    let columns = table.columns.iter().zip(&table.values).map(|(name, x)| PlotColumn {
        name: name.clone(),
        label: column_label(name),
        unit: unit(name),
        x: blob.push_floats(rows.iter().map(|&i| x[i] as f32)),
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

/// The spectra of the columns of `table` that are shown and have waves enough, added to `blob`.
fn encode_spectra(table: &ProbeTable, charts: &[Chart], blob: &mut BinaryData) -> Vec<ColumnSpectrum> {
    let shown = charts.iter().filter(|chart| !chart.folded).flat_map(|chart| chart.columns.iter().copied());
    let of = |column: usize| {
        let spectrum = analysis::displayed_spectrum(&column_series(&table.times, &table.values[column])?)?;
        let f = blob.push_floats(spectrum.frequencies().map(|f| f as f32));
        let s = blob.push_floats(spectrum.density.iter().map(|s| *s as f32));
        Some(ColumnSpectrum { column, rows: spectrum.density.len(), f, s })
    };
    shown.filter_map(of).collect()
}

/// The answers of motions over frequency, added to `blob`.
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

/// The rows of a table that its plots need: of each of many equal stretches the least and the largest of every column.
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

/// The columns as charts: those that belong together, then every other one by itself.
fn group_columns(columns: &[String]) -> Vec<Chart> {
    // A row of gauges is one chart, wherever they stand.
    let names: Vec<String> =
        columns.iter().map(|name| column_label(name.split("_at_").next().unwrap_or(name))).collect();
    let mut left: Vec<usize> = (0..columns.len()).collect();
    let mut charts = Vec::new();
    for (family, folded) in FAMILIES {
        let own: Vec<usize> = left.iter().copied().filter(|&i| family.contains(&names[i].as_str())).collect();
        left.retain(|i| !own.contains(i));
        // What is never shown otherwise is not folded away.
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

/// The charts of a budget or a balance, one for each direction with all kinds that are not 0 throughout, and those that are. What
/// is left over is too small to be seen beside the others, and waits behind a fold.
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

/// Folds away the charts of columns `x` that have no numbers, as at a gauge that was dry; something stays to be seen.
fn fold_empty_charts(mut charts: Vec<Chart>, x: &[Vec<f64>]) -> Vec<Chart> {
    let empty = |chart: &Chart| chart.columns.iter().all(|&i| x[i].iter().all(|x| x.is_nan()));
    charts.iter_mut().for_each(|chart| chart.folded |= empty(chart));
    if charts.iter().all(|chart| chart.folded) {
        charts.iter_mut().for_each(|chart| chart.folded = empty(chart));
    }
    charts
}

/// The checks of `run` that have curves, added to `blob`; `caption` says the figures of a verdict.
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
