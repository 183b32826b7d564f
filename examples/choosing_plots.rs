//! Draws plots of the documents from the figures in docs/plots/choosing.toml, into the same folder.
//!
//! `cargo run --release --example choosing_plots`

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program prints and a demonstration may panic"
)]

use std::{error::Error, fs, path::Path};

use pontoon::report::{LineStyle, PlotLine, line_plot, log_log_plot};
use serde::Deserialize;

/// Folder of the figures and of the plots.
pub const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/plots");

/// All plots.
#[derive(Deserialize)]
pub struct Sheet {
    /// The plots in the order of the file.
    pub plot: Vec<Plot>,
}

/// A plot.
#[derive(Deserialize)]
pub struct Plot {
    /// Its file in [`FOLDER`].
    pub file: String,
    /// The page that shows it, relative to `docs/`; by default how-to/choosing-parameters.md.
    #[serde(default = "choosing")]
    pub page: String,
    /// The page or table that holds its figures, relative to `docs/`.
    pub source: String,
    /// Titles of its axes.
    pub axes: [String; 2],
    /// Whether the axes are logarithmic.
    #[serde(default)]
    pub log: bool,
    /// Its lines.
    pub lines: Vec<Curve>,
}

/// A line of a plot.
#[derive(Deserialize)]
pub struct Curve {
    /// Its name in the caption of the plot.
    pub name: String,
    /// Its points.
    pub points: Vec<(f64, f64)>,
    /// Labels of the points; may be omitted.
    #[serde(default)]
    pub labels: Vec<String>,
}

fn choosing() -> String {
    "how-to/choosing-parameters.md".into()
}

impl Sheet {
    /// Reads the figures.
    pub fn read() -> Result<Self, Box<dyn Error>> {
        Ok(toml::from_str(&fs::read_to_string(Path::new(FOLDER).join("choosing.toml"))?)?)
    }
}

impl Plot {
    /// The plot as SVG.
    pub fn svg(&self) -> String {
        let line = |(colour, of): (usize, &Curve)| PlotLine {
            labels: of.labels.clone(),
            ..PlotLine::new(of.name.as_str(), colour, LineStyle::Dotted, of.points.clone())
        };
        let lines: Vec<PlotLine> = self.lines.iter().enumerate().map(line).collect();
        let draw = if self.log { log_log_plot } else { line_plot };
        draw([&self.axes[0], &self.axes[1]], &lines)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    for plot in Sheet::read()?.plot {
        fs::write(Path::new(FOLDER).join(&plot.file), plot.svg())?;
        println!("docs/plots/{}", plot.file);
    }
    Ok(())
}
