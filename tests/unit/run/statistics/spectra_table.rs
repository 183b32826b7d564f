//! Unit tests of `src/run/statistics/spectra_table.rs`.

use super::*;
use crate::{error::Error, output::SeriesTable};

#[test]
fn the_spectra_table_contains_oscillating_series_and_has_no_file_without_them() -> Result<()> {
    let folder = std::env::temp_dir().join(format!("pontoon-spectra-{}", std::process::id()));
    let failed = |why| Error::file(&folder, why);
    std::fs::create_dir_all(&folder).map_err(failed)?;
    let t: Vec<f64> = (0..2000).map(|i| f64::from(i) * 0.01).collect();
    let wave: Vec<f64> = t.iter().map(|t| 0.05 * (std::f64::consts::TAU * 1.25 * t).sin()).collect();
    let mut table =
        SeriesTable { columns: vec!["front_m".into()], times: t.clone(), values: vec![t], ..SeriesTable::default() };
    write(&folder, &ProbeTables::from([("gauge".into(), table.clone())]))?;
    assert!(!folder.join(SPECTRA_FILE).exists(), "a rising series has no spectrum");
    table.columns.push("eta_m".into());
    table.values.push(wave);
    write(&folder, &ProbeTables::from([("gauge".into(), table)]))?;
    let text = std::fs::read_to_string(folder.join(SPECTRA_FILE)).map_err(failed)?;
    assert!(text.starts_with("series,f_Hz,S,unit\ngauge.eta_m,0.0,"), "{text}");
    let rows: Vec<Vec<&str>> = text.lines().skip(1).map(|line| line.split(',').collect()).collect();
    assert!(rows.iter().all(|row| row.len() == 4 && row[3] == "m²/Hz"), "{text}");
    let number = |row: &[&str], i: usize| row[i].parse::<f64>().unwrap_or(f64::NAN);
    let sum: f64 = rows.iter().map(|row| number(row, 2)).sum();
    let variance = sum * (number(&rows[1], 1) - number(&rows[0], 1));
    // The table contains all but a thousandth of the variance; that of 25 whole periods is half the square of their amplitude.
    assert!((variance / 0.00125 - 1.0).abs() < 2e-3, "{variance}");
    std::fs::remove_dir_all(&folder).map_err(failed)
}

#[test]
fn spectral_densities_have_the_squared_unit_per_hertz() {
    assert_eq!(["m", "N/m", "–"].map(density_unit), ["m²/Hz", "(N/m)²/Hz", "1/Hz"]);
}
