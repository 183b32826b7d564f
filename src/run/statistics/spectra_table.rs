//! The spectra of a run's series at its end: `spectra.csv`, a row for each frequency of each series.

use std::path::Path;

use super::{ProbeTables, readings_in_window};
use crate::{analysis::displayed_spectrum, error::Result, math::format::unit, output::write_atomically};

/// The file, in the run's folder.
pub const SPECTRA_FILE: &str = "spectra.csv";

/// Writes the spectra of all oscillating series of `tables` into the run's `folder`; no file if none oscillates.
///
/// # Errors
/// `File` if it cannot be written.
pub(crate) fn write(folder: &Path, tables: &ProbeTables) -> Result<()> {
    let mut text = String::new();
    for (probe, table) in tables {
        for column in &table.columns {
            let name = format!("{probe}.{column}");
            let all = readings_in_window(tables, &name, (f64::NEG_INFINITY, f64::INFINITY));
            let Some(spectrum) = all.and_then(|readings| displayed_spectrum(&readings)) else { continue };
            let of = density_unit(unit(&name));
            for (f, s) in spectrum.frequencies().zip(&spectrum.density) {
                text += &format!("{name},{f:?},{s:?},{of}\n");
            }
        }
    }
    if text.is_empty() {
        return Ok(());
    }
    write_atomically(&folder.join(SPECTRA_FILE), format!("series,f_Hz,S,unit\n{text}").as_bytes())
}

/// The unit of the spectral density of a quantity in `unit`.
fn density_unit(unit: &str) -> String {
    match unit {
        "–" => "1/Hz".into(),
        unit if unit.contains(['/', ' ']) => format!("({unit})²/Hz"),
        unit => format!("{unit}²/Hz"),
    }
}

#[cfg(test)]
#[path = "../../../tests/unit/run/statistics/spectra_table.rs"]
mod tests;
