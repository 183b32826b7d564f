//! Columns of CSV tables: of the run's own and of references.
//!
//! Lines that open with `#` are comments. Empty fields are gaps. Several values at one instant, as digitised
//! figures have them, count as their mean.

use std::path::Path;

use crate::{
    error::{Error, ErrorCode, Result, nearest_name},
    math::time_series::TimeSeries,
};

/// The series of `column` over `time` of the table at `path`, its times moved by `delay` (s).
///
/// # Errors
/// `File` if it cannot be read; `Scene` if a column is missing (names the nearest), a field is no number, or
/// fewer than two rows have both.
pub fn read_series(path: &Path, time: &str, column: &str, delay: f64) -> Result<TimeSeries> {
    let mut rows = read_pairs(path, time, column)?;
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    let groups = rows.chunk_by(|a, b| a.0 == b.0);
    let (t, x): (Vec<f64>, Vec<f64>) =
        groups.map(|g| (g[0].0 + delay, g.iter().map(|row| row.1).sum::<f64>() / g.len() as f64)).unzip();
    TimeSeries::new(t, x).map_err(|e| e.at(path.display().to_string(), None, column))
}

/// The rows (time, value) in which both columns hold a number.
fn read_pairs(path: &Path, time: &str, column: &str) -> Result<Vec<(f64, f64)>> {
    let broken = |why: csv::Error| Error::table(path, &why);
    let mut reader =
        csv::ReaderBuilder::new().comment(Some(b'#')).trim(csv::Trim::All).from_path(path).map_err(broken)?;
    let header = reader.headers().map_err(broken)?.clone();
    let place = |name: &str| {
        header.iter().position(|h| h == name).ok_or_else(|| {
            let help = match nearest_name(name, &header) {
                Some(near) => format!("did you mean {near:?}?"),
                None => format!("its columns are: {}", header.iter().collect::<Vec<_>>().join(", ")),
            };
            Error::scene(format!("{} has no column {name:?}", path.display()))
                .with_code(ErrorCode::UnknownName)
                .help(help)
        })
    };
    let (t, x) = (place(time)?, place(column)?);
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(broken)?;
        let line = record.position().map_or(0, |p| p.line() as usize);
        let field = |i: usize| match record.get(i).unwrap_or("") {
            "" => Ok(None),
            word => word.parse::<f64>().map(Some).map_err(|_| {
                Error::scene(format!("{word:?} is not a number")).at(
                    path.display().to_string(),
                    Some((line, 1)),
                    &header[i],
                )
            }),
        };
        if let (Some(t), Some(x)) = (field(t)?, field(x)?) {
            rows.push((t, x));
        }
    }
    Ok(rows)
}
