//! Draws the plots of docs/how-to/choosing-parameters.md and docs/explanation/stability.md from the figures in docs/plots/choosing.toml, beside which it puts them.
//!
//! `cargo run --release --example choosing_plots`, at once.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program prints and a demonstration may panic"
)]

use std::{error::Error, fs, path::Path};

use pontoon::study::{LineStyle, PlotLine, line_plot, log_log_plot};
use serde::Deserialize;

/// Where the figures are, and the plots.
pub const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/plots");

/// All plots.
#[derive(Deserialize)]
pub struct Sheet {
    /// Each of them.
    pub plot: Vec<Plot>,
}

/// A plot.
#[derive(Deserialize)]
pub struct Plot {
    /// Its file in [`FOLDER`].
    pub file: String,
    /// The page that shows it; docs/how-to/choosing-parameters.md unless it is said.
    #[serde(default = "choosing")]
    pub page: String,
    /// The page that has its figures.
    pub source: String,
    /// What stands at its axes.
    pub axes: [String; 2],
    /// Whether they are logarithmic.
    #[serde(default)]
    pub log: bool,
    /// Its lines.
    pub lines: Vec<Curve>,
}

/// A line of a plot.
#[derive(Deserialize)]
pub struct Curve {
    /// What it is called where the plot is shown.
    pub name: String,
    /// Its points.
    pub points: Vec<(f64, f64)>,
    /// What stands beside each point; may be left out.
    #[serde(default)]
    pub labels: Vec<String>,
}

fn choosing() -> String {
    "choosing.md".into()
}

impl Sheet {
    /// The figures as they are kept.
    pub fn read() -> Result<Self, Box<dyn Error>> {
        Ok(toml::from_str(&fs::read_to_string(Path::new(FOLDER).join("choosing.toml"))?)?)
    }
}

impl Plot {
    /// The plot as SVG.
    pub fn svg(&self) -> pontoon::Result<String> {
        let line = |(colour, of): (usize, &Curve)| PlotLine {
            labels: of.labels.clone(),
            ..PlotLine::new(colour, LineStyle::Dotted, of.points.clone())
        };
        let lines: Vec<PlotLine> = self.lines.iter().enumerate().map(line).collect();
        let draw = if self.log { log_log_plot } else { line_plot };
        draw([&self.axes[0], &self.axes[1]], &lines)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    for plot in Sheet::read()?.plot {
        fs::write(Path::new(FOLDER).join(&plot.file), plot.svg()?)?;
        println!("docs/plots/{}", plot.file);
    }
    Ok(())
}
