//! Plots as SVG, for pages that stand alone.

use std::ops::Range;

use plotters::{
    coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter},
    prelude::*,
};

use crate::error::{Error, ErrorKind, Result};

/// Colours that are told apart by everyone (Okabe & Ito), the dark ones first.
const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
    RGBColor(0, 0, 0),
];

/// Twice the size at which a page shows it: the drawing knows whole pixels only.
const SIZE: (u32, u32) = (1520, 840);
const INK: RGBColor = RGBColor(60, 60, 60);

/// How a line is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineStyle {
    /// A line with a dot at each point.
    Dotted,
    /// Dots alone, as of a measurement.
    Dots,
    /// A line alone.
    Plain,
}

/// A line of a plot.
#[derive(Clone, Debug, PartialEq)]
pub struct PlotLine {
    /// Which colour: lines of one number share it.
    pub colour: usize,
    /// How it is drawn.
    pub style: LineStyle,
    /// Its points.
    pub points: Vec<(f64, f64)>,
    /// What stands beside each point; may be empty.
    pub labels: Vec<String>,
    /// From where to where each point is known, upright; may be empty.
    pub spans: Vec<(f64, f64)>,
}

impl PlotLine {
    /// A line without labels and spans.
    pub fn new(colour: usize, style: LineStyle, points: Vec<(f64, f64)>) -> Self {
        Self { colour, style, points, labels: vec![], spans: vec![] }
    }
}

/// The colour of number `i`, for a legend in HTML.
pub fn colour(i: usize) -> String {
    let RGBColor(r, g, b) = COLOURS[i % COLOURS.len()];
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// `lines` over linear axes, as SVG.
///
/// # Errors
/// `File` if the drawing fails.
pub fn line_plot(titles: [&str; 2], lines: &[PlotLine]) -> Result<String> {
    let (x, y) = (x_range(lines), y_range(lines));
    let room = 0.05 * (y.end - y.start);
    draw(titles, lines, PlotAxis::Linear(x), PlotAxis::Linear(y.start - room..y.end + room))
}

/// `lines` over logarithmic axes, as SVG; points that are not above 0 are left out.
///
/// # Errors
/// `File` if the drawing fails.
pub fn log_log_plot(titles: [&str; 2], lines: &[PlotLine]) -> Result<String> {
    let positive = |line: &PlotLine| {
        let keep: Vec<usize> =
            (0..line.points.len()).filter(|&i| line.points[i].0 > 0.0 && line.points[i].1 > 0.0).collect();
        let labels = keep.iter().filter_map(|&i| line.labels.get(i).cloned()).collect();
        let above = |(i, &(low, high)): (usize, &(f64, f64))| (if low > 0.0 { low } else { line.points[i].1 }, high);
        let all: Vec<(f64, f64)> = line.spans.iter().enumerate().map(above).collect();
        let spans = keep.iter().filter_map(|&i| all.get(i).copied()).collect();
        PlotLine { points: keep.iter().map(|&i| line.points[i]).collect(), labels, spans, ..line.clone() }
    };
    let lines: Vec<PlotLine> = lines.iter().map(positive).collect();
    let (x, y) = (x_range(&lines), y_range(&lines));
    draw(titles, &lines, PlotAxis::Log(x.start / 1.5..x.end * 2.0), PlotAxis::Log(y.start / 1.3..y.end * 1.3))
}

/// The range of all points along the first axis.
fn x_range(lines: &[PlotLine]) -> Range<f64> {
    range(lines.iter().flat_map(|line| &line.points).map(|p| p.0))
}

/// The range of all points and spans along the second axis.
fn y_range(lines: &[PlotLine]) -> Range<f64> {
    let points = lines.iter().flat_map(|line| &line.points).map(|p| p.1);
    range(points.chain(lines.iter().flat_map(|line| &line.spans).flat_map(|&(low, high)| [low, high])))
}

/// The least range that holds all of `values`; not empty.
fn range(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    match low < high {
        true => low..high,
        false if low.is_finite() && low != 0.0 => low - 0.5 * low.abs()..low + 0.5 * low.abs(),
        false => 0.1..1.0,
    }
}

fn draw(titles: [&str; 2], lines: &[PlotLine], x: PlotAxis, y: PlotAxis) -> Result<String> {
    let mut text = String::new();
    let failed = |why: String| Error::new(ErrorKind::File, format!("a plot cannot be drawn: {why}"));
    {
        let area = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        area.fill(&WHITE).map_err(|e| failed(e.to_string()))?;
        let mut chart = ChartBuilder::on(&area)
            .margin(24)
            .margin_right(48)
            .x_label_area_size(92)
            .y_label_area_size(140)
            .build_cartesian_2d(x, y)
            .map_err(|e| failed(e.to_string()))?;
        chart
            .configure_mesh()
            .x_desc(titles[0])
            .y_desc(titles[1])
            .axis_style(INK.stroke_width(2))
            .bold_line_style(RGBColor(225, 225, 225).stroke_width(2))
            .light_line_style(TRANSPARENT)
            .label_style(("sans-serif", 28, &INK))
            .axis_desc_style(("sans-serif", 30, &INK))
            .draw()
            .map_err(|e| failed(e.to_string()))?;
        for line in lines {
            let colour = COLOURS[line.colour % COLOURS.len()];
            if line.style != LineStyle::Dots {
                let path = LineSeries::new(line.points.iter().copied(), colour.stroke_width(3));
                chart.draw_series(path).map_err(|e| failed(e.to_string()))?;
            }
            let bars = line.points.iter().zip(&line.spans).filter(|(_, (low, high))| low < high);
            let bars = bars.map(|(p, s)| PathElement::new(vec![(p.0, s.0), (p.0, s.1)], colour.stroke_width(3)));
            chart.draw_series(bars).map_err(|e| failed(e.to_string()))?;
            if line.style != LineStyle::Plain {
                let dots = line.points.iter().map(|&p| Circle::new(p, 8, colour.filled()));
                chart.draw_series(dots).map_err(|e| failed(e.to_string()))?;
            }
            // Lines that lie on one another label their points above and below.
            let place = (14, if line.colour % 2 == 0 { -30 } else { 10 });
            let labels = line.points.iter().zip(&line.labels).map(|(&p, label)| {
                EmptyElement::at(p) + Text::new(label.clone(), place, ("sans-serif", 26).into_font().color(&colour))
            });
            chart.draw_series(labels).map_err(|e| failed(e.to_string()))?;
        }
        area.present().map_err(|e| failed(e.to_string()))?;
    }
    Ok(text)
}

/// An axis with round numbers at its marks: 1, 2, 5 and their tens.
#[derive(Clone)]
enum PlotAxis {
    Linear(Range<f64>),
    Log(Range<f64>),
}

impl Ranged for PlotAxis {
    type ValueType = f64;
    type FormatOption = NoDefaultFormatting;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let part = match self {
            Self::Linear(r) => (value - r.start) / (r.end - r.start),
            Self::Log(r) => (value / r.start).ln() / (r.end / r.start).ln(),
        };
        limit.0 + (part * f64::from(limit.1 - limit.0)).round() as i32
    }

    fn key_points<H: KeyPointHint>(&self, _: H) -> Vec<f64> {
        match self {
            Self::Linear(r) => {
                let step = round_step((r.end - r.start) / 6.0);
                let first = (r.start / step).ceil() as i64;
                let last = (r.end / step).floor() as i64;
                (first..=last).map(|i| i as f64 * step).collect()
            }
            Self::Log(r) => {
                let decades = (r.end / r.start).log10();
                let digits: &[f64] = match decades {
                    d if d < 0.8 => &[1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0],
                    d if d < 3.0 => &[1.0, 2.0, 5.0],
                    _ => &[1.0],
                };
                let tens = r.start.log10().floor() as i32..=r.end.log10().ceil() as i32;
                let all = tens.flat_map(|ten| digits.iter().map(move |digit| digit * 10f64.powi(ten)));
                all.filter(|x| r.contains(x)).collect()
            }
        }
    }

    fn range(&self) -> Range<f64> {
        match self {
            Self::Linear(r) | Self::Log(r) => r.clone(),
        }
    }
}

impl ValueFormatter<f64> for PlotAxis {
    fn format_ext(&self, value: &f64) -> String {
        match value.abs() {
            x if x != 0.0 && !(1e-4..1e6).contains(&x) => format!("{value:.0e}"),
            // Multiples of a step carry round-off in their last digits.
            _ => format!("{}", (value * 1e7).round() / 1e7),
        }
    }
}

/// The least of 1, 2, 5 times a power of ten that is not below `step`.
fn round_step(step: f64) -> f64 {
    let ten = 10f64.powf(step.log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|x| x * ten).find(|x| *x >= step * 0.999).unwrap_or(10.0 * ten)
}

#[cfg(test)]
#[path = "../../tests/unit/study/svg_plot.rs"]
mod tests;
