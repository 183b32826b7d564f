//! Draws plots as SVG: lines, points, error bars and labels on linear or logarithmic axes, with a legend above.

use std::ops::Range;

use super::html::escape;
use crate::math::format::{decimals, with_minus_sign};

/// Colours that remain distinct for colour-blind readers (Okabe & Ito), with the dark colours first.
const COLOURS: [&str; 7] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#000000"];

/// The colour of the axes and their text.
const AXIS_COLOUR: &str = "#3c3c3c";

/// The width of a plot, and the height of the part below the legend.
const SIZE: [f64; 2] = [760.0, 420.0];

/// The margins around the axes: left, right, above and below.
const MARGINS: [f64; 4] = [82.0, 24.0, 14.0, 58.0];

/// The height of a row of the legend.
const LEGEND_ROW: f64 = 22.0;

/// The text size of the axis numbers and of the legend.
const TICK_SIZE: f64 = 14.0;

/// The text size of the axis titles.
const TITLE_SIZE: f64 = 15.0;

/// The text size of the point labels.
const LABEL_SIZE: f64 = 13.0;

/// The approximate width of a letter divided by the text size.
const LETTER_WIDTH: f64 = 0.56;

/// The style of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineStyle {
    /// A line with a dot at each point.
    Dotted,
    /// Dots without a line, for measurements.
    Dots,
    /// A line without dots.
    Plain,
}

/// A line of a plot.
#[derive(Clone, Debug, PartialEq)]
pub struct PlotLine {
    /// The name in the legend; a line with an empty name has no legend entry.
    pub name: String,
    /// The colour number; lines with the same number share a colour.
    pub colour: usize,
    /// The drawing style.
    pub style: LineStyle,
    /// The points; a point that is not finite interrupts the line.
    pub points: Vec<(f64, f64)>,
    /// The labels of the points; may be empty.
    pub labels: Vec<String>,
    /// The lower and upper ends of the error bars; may be empty.
    pub spans: Vec<(f64, f64)>,
}

impl PlotLine {
    /// Returns a line without labels or error bars.
    pub fn new(name: impl Into<String>, colour: usize, style: LineStyle, points: Vec<(f64, f64)>) -> Self {
        Self { name: name.into(), colour, style, points, labels: vec![], spans: vec![] }
    }

    fn colour(&self) -> &'static str {
        COLOURS[self.colour % COLOURS.len()]
    }
}

/// Returns a plot of `lines` on linear axes with `titles`, as SVG.
pub fn line_plot(titles: [&str; 2], lines: &[PlotLine]) -> String {
    let (x, y) = (x_range(lines).unwrap_or(0.0..1.0), y_range(lines).unwrap_or(0.0..1.0));
    let margin = 0.05 * (y.end - y.start);
    draw(titles, lines, &[PlotAxis::Linear(x), PlotAxis::Linear(y.start - margin..y.end + margin)])
}

/// Returns a plot of `lines` on logarithmic axes with `titles`, as SVG. The plot omits points with a coordinate of 0 or
/// below.
pub fn log_log_plot(titles: [&str; 2], lines: &[PlotLine]) -> String {
    let lines: Vec<PlotLine> = lines.iter().map(positive).collect();
    let (x, y) = (x_range(&lines).unwrap_or(0.1..1.0), y_range(&lines).unwrap_or(0.1..1.0));
    draw(titles, &lines, &[PlotAxis::Log(x.start / 1.5..x.end * 1.5), PlotAxis::Log(y.start / 1.3..y.end * 1.3)])
}

/// Returns `line` without the points that have a coordinate of 0 or below. An error bar that reaches 0 ends at its
/// point.
fn positive(line: &PlotLine) -> PlotLine {
    let kept = |i: &usize| line.points[*i].0 > 0.0 && line.points[*i].1 > 0.0;
    let kept: Vec<usize> = (0..line.points.len()).filter(kept).collect();
    let span = |&i: &usize| {
        let (low, high) = *line.spans.get(i)?;
        Some((if low > 0.0 { low } else { line.points[i].1 }, high))
    };
    PlotLine {
        points: kept.iter().map(|&i| line.points[i]).collect(),
        labels: kept.iter().filter_map(|&i| line.labels.get(i).cloned()).collect(),
        spans: kept.iter().filter_map(span).collect(),
        ..line.clone()
    }
}

/// Returns the range of all points along the first axis.
fn x_range(lines: &[PlotLine]) -> Option<Range<f64>> {
    range(lines.iter().flat_map(|line| &line.points).map(|p| p.0))
}

/// Returns the range of all points and error bars along the second axis.
fn y_range(lines: &[PlotLine]) -> Option<Range<f64>> {
    let points = lines.iter().flat_map(|line| &line.points).map(|p| p.1);
    range(points.chain(lines.iter().flat_map(|line| &line.spans).flat_map(|&(low, high)| [low, high])))
}

/// Returns the smallest range of the finite `values`, with a margin around a single value, or `None` if no value is
/// finite.
fn range(values: impl Iterator<Item = f64>) -> Option<Range<f64>> {
    let (low, high) = values
        .filter(|x| x.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    match low == high {
        true if low == 0.0 => Some(-1.0..1.0),
        true => Some(low - 0.5 * low.abs()..low + 0.5 * low.abs()),
        false => (low < high).then_some(low..high),
    }
}

/// An axis with round numbers at its ticks: 1, 2, 5 and their multiples by powers of ten.
enum PlotAxis {
    Linear(Range<f64>),
    Log(Range<f64>),
}

impl PlotAxis {
    /// Returns the relative position of `value`: 0 at the start of the axis, 1 at its end.
    fn fraction(&self, value: f64) -> f64 {
        match self {
            Self::Linear(r) => (value - r.start) / (r.end - r.start),
            Self::Log(r) => (value / r.start).ln() / (r.end / r.start).ln(),
        }
    }

    fn ticks(&self) -> Vec<f64> {
        match self {
            Self::Linear(r) => {
                let step = round_step((r.end - r.start) / 6.0);
                let (first, last) = ((r.start / step).ceil() as i64, (r.end / step).floor() as i64);
                (first..=last).map(|i| i as f64 * step).collect()
            }
            Self::Log(r) => {
                let digits: &[f64] = match (r.end / r.start).log10() {
                    decades if decades < 0.8 => &[1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0],
                    decades if decades < 3.0 => &[1.0, 2.0, 5.0],
                    _ => &[1.0],
                };
                let tens = r.start.log10().floor() as i32..=r.end.log10().ceil() as i32;
                let all = tens.flat_map(|ten| digits.iter().map(move |digit| digit * 10_f64.powi(ten)));
                all.filter(|x| r.contains(x)).collect()
            }
        }
    }
}

/// Returns the smallest product of 1, 2 or 5 and a power of ten that is at least `step`.
pub(super) fn round_step(step: f64) -> f64 {
    let ten = 10_f64.powf(step.log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|x| x * ten).find(|x| *x >= step * 0.999).unwrap_or(10.0 * ten)
}

/// Returns the label of a tick.
fn tick_label(value: f64) -> String {
    with_minus_sign(&match value.abs() {
        x if x != 0.0 && !(1e-4..1e6).contains(&x) => format!("{value:.0e}"),
        // The last digits of multiples of a step contain round-off errors.
        _ => decimals(value, 7),
    })
}

/// Returns a plot of `lines` on the `axes`, which contain all points.
fn draw(titles: [&str; 2], lines: &[PlotLine], axes: &[PlotAxis; 2]) -> String {
    let (legend, legend_height) = legend(lines);
    let [left, right, above, below] = MARGINS;
    let [width, height] = [SIZE[0], SIZE[1] + legend_height];
    let area = Area { x: left..width - right, y: height - below..above + legend_height };
    let mut body = axes_svg(titles, axes, &area);
    for line in lines {
        body += &line_svg(line, axes, &area);
    }
    svg_document([width, height], &(body + &legend))
}

/// The rectangle between the axes, as the coordinates of both ends of each axis.
struct Area {
    x: Range<f64>,
    y: Range<f64>,
}

impl Area {
    fn x(&self, axis: &PlotAxis, value: f64) -> f64 {
        self.x.start + axis.fraction(value) * (self.x.end - self.x.start)
    }

    fn y(&self, axis: &PlotAxis, value: f64) -> f64 {
        self.y.start + axis.fraction(value) * (self.y.end - self.y.start)
    }
}

/// Returns the axes with their grid, numbers and titles.
fn axes_svg(titles: [&str; 2], axes: &[PlotAxis; 2], area: &Area) -> String {
    let [(left, right), (bottom, top)] = [(area.x.start, area.x.end), (area.y.start, area.y.end)];
    let (mut grid, mut text) = (String::new(), String::new());
    for value in axes[0].ticks() {
        let x = area.x(&axes[0], value);
        grid += &format!("M{x:.1} {bottom:.1}V{top:.1}");
        text += &svg_text([x, bottom + 20.0], "middle", TICK_SIZE, AXIS_COLOUR, &tick_label(value));
    }
    for value in axes[1].ticks() {
        let y = area.y(&axes[1], value);
        grid += &format!("M{left:.1} {y:.1}H{right:.1}");
        text += &svg_text([left - 8.0, y + 5.0], "end", TICK_SIZE, AXIS_COLOUR, &tick_label(value));
    }
    text += &svg_text([0.5 * (left + right), bottom + 46.0], "middle", TITLE_SIZE, AXIS_COLOUR, titles[0]);
    let upright = svg_text([0.0, 0.0], "middle", TITLE_SIZE, AXIS_COLOUR, titles[1]);
    text += &format!("<g transform=\"translate(20 {:.1}) rotate(-90)\">{upright}</g>\n", 0.5 * (bottom + top));
    path(&grid, "#e1e1e1", 1.0)
        + &path(&format!("M{left:.1} {top:.1}V{bottom:.1}H{right:.1}"), AXIS_COLOUR, 1.0)
        + &text
}

/// Returns a line with its error bars, points and labels.
fn line_svg(line: &PlotLine, axes: &[PlotAxis; 2], area: &Area) -> String {
    let place = |p: &(f64, f64)| (area.x(&axes[0], p.0), area.y(&axes[1], p.1));
    let places: Vec<(f64, f64)> = line.points.iter().map(place).collect();
    let finite = |p: &&(f64, f64)| p.0.is_finite() && p.1.is_finite();
    let mut svg = String::new();
    if line.style != LineStyle::Dots {
        let parts = places.split(|p| !finite(&p)).filter(|part| part.len() > 1);
        let part = |part: &[(f64, f64)]| {
            let mut corners: Vec<String> = part.iter().map(|(x, y)| format!("{x:.1} {y:.1}")).collect();
            corners.dedup();
            format!("M{}", corners.join("L"))
        };
        svg += &path(&parts.map(part).collect::<String>(), line.colour(), 1.6);
    }
    let bars =
        places.iter().zip(&line.spans).filter(|((x, y), (low, high))| low < high && (x + y + low + high).is_finite());
    let bar = |((x, _), (low, high)): (&(f64, f64), &(f64, f64))| {
        let [low, high] = [*low, *high].map(|end| area.y(&axes[1], end));
        format!("M{0:.1} {low:.1}H{1:.1}M{x:.1} {low:.1}V{high:.1}M{0:.1} {high:.1}H{1:.1}", x - 4.0, x + 4.0)
    };
    svg += &path(&bars.map(bar).collect::<String>(), line.colour(), 1.4);
    if line.style != LineStyle::Plain {
        let dots: String = places.iter().filter(finite).map(|(x, y)| dot([*x, *y])).collect();
        svg += &format!("<g fill=\"{}\">{dots}</g>\n", line.colour());
    }
    // Successive lines have their labels alternately above and below.
    let shift = if line.colour.is_multiple_of(2) { -8.0 } else { 17.0 };
    for ((x, y), label) in places.iter().zip(&line.labels).filter(|(p, _)| finite(p)) {
        let fits = x + 8.0 + text_width(label, LABEL_SIZE) < area.x.end + MARGINS[1];
        let (x, anchor) = if fits { (x + 7.0, "start") } else { (x - 7.0, "end") };
        svg += &svg_text([x, y + shift], anchor, LABEL_SIZE, line.colour(), label);
    }
    svg
}

/// Returns the legend and its height. The legend has an entry for each pair of name and colour, arranged in rows.
fn legend(lines: &[PlotLine]) -> (String, f64) {
    let (mut svg, mut x, mut row) = (String::new(), MARGINS[0], 0.0);
    let mut named: Vec<&PlotLine> = Vec::new();
    for line in lines {
        if !line.name.is_empty() && !named.iter().any(|other| (&other.name, other.colour) == (&line.name, line.colour))
        {
            named.push(line);
        }
    }
    for line in &named {
        let width = 34.0 + text_width(&line.name, TICK_SIZE) + 22.0;
        if x > MARGINS[0] && x + width > SIZE[0] {
            (x, row) = (MARGINS[0], row + 1.0);
        }
        let y = 20.0 + LEGEND_ROW * row;
        if line.style != LineStyle::Dots {
            svg += &path(&format!("M{x:.1} {y:.1}h26"), line.colour(), 2.0);
        }
        if line.style != LineStyle::Plain {
            svg += &format!("<g fill=\"{}\">{}</g>\n", line.colour(), dot([x + 13.0, y]));
        }
        svg += &svg_text([x + 34.0, y + 5.0], "start", TICK_SIZE, AXIS_COLOUR, &line.name);
        x += width;
    }
    (svg, if named.is_empty() { 0.0 } else { 12.0 + LEGEND_ROW * (row + 1.0) })
}

fn path(steps: &str, colour: &str, width: f64) -> String {
    match steps.is_empty() {
        true => String::new(),
        false => format!("<path d=\"{steps}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\"/>\n"),
    }
}

fn dot([x, y]: [f64; 2]) -> String {
    format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\"/>")
}

/// Returns the approximate width of a text.
fn text_width(words: &str, size: f64) -> f64 {
    LETTER_WIDTH * size * words.chars().count() as f64
}

/// Returns a text at a position; `anchor` is the point of the text at that position: start, middle or end.
pub(crate) fn svg_text([x, y]: [f64; 2], anchor: &str, size: f64, colour: &str, words: &str) -> String {
    format!(
        "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" font-size=\"{size}\" fill=\"{colour}\">{}</text>\n",
        escape(words)
    )
}

/// Returns an SVG document of the given width and height on a white background.
pub(crate) fn svg_document([width, height]: [f64; 2], body: &str) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"sans-serif\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n{body}</svg>\n"
    )
}

#[cfg(test)]
#[path = "../../tests/unit/report/plot.rs"]
mod tests;
