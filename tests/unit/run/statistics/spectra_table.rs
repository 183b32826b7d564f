//! Unit tests of `src/run/statistics/spectra_table.rs`.

use super::*;
use crate::{error::Error, output::SeriesTable};

#[test]
fn what_swings_has_its_spectrum_in_rows_and_what_does_not_has_no_file() -> Result<()> {
    let folder = std::env::temp_dir().join(format!("pontoon-spectra-{}", std::process::id()));
    let failed = |why| Error::file(&folder, why);
    std::fs::create_dir_all(&folder).map_err(failed)?;
    let t: Vec<f64> = (0..2000).map(|i| f64::from(i) * 0.01).collect();
    let wave: Vec<f64> = t.iter().map(|t| 0.05 * (std::f64::consts::TAU * 1.25 * t).sin()).collect();
    let mut table = SeriesTable { columns: vec!["front_m".into()], times: t.clone(), values: vec![t] };
    write(&folder, &ProbeTables::from([("gauge".into(), table.clone())]))?;
    assert!(!folder.join(SPECTRA_FILE).exists(), "what only rises has none");
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
    // All but a thousandth of it is told; 25 whole periods have half the square of their amplitude.
    assert!((variance / 0.00125 - 1.0).abs() < 2e-3, "{variance}");
    std::fs::remove_dir_all(&folder).map_err(failed)
}

#[test]
fn densities_have_the_square_of_the_unit_a_hertz() {
    assert_eq!(["m", "N/m", "–"].map(density_unit), ["m²/Hz", "(N/m)²/Hz", "1/Hz"]);
}
