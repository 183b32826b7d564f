//! The response amplitude operators (RAO) of motions in irregular waves, at a run's end: `rao.csv`, a row for each frequency of
//! each motion.

use std::{f64::consts::PI, path::Path};

use serde::{Serialize, Serializer};

use crate::{analysis::RaoPoint, error::Result, output::write_atomically};

/// The file, in the run's folder.
pub const RAO_FILE: &str = "rao.csv";

/// The RAO of a motion at a frequency. Its keys in JSON are the columns of [`RAO_FILE`].
#[derive(Clone, Debug, PartialEq)]
pub struct RaoResult {
    /// Name of the `[[statistic]]`.
    pub name: String,
    /// The motion, as `probe.column`.
    pub series: String,
    /// Unit of the ratio, as `m/m`.
    pub unit: String,
    /// The RAO at the frequency.
    pub point: RaoPoint,
}

impl RaoResult {
    /// Phase of the motion less that of the wave, degrees.
    pub fn phase_degrees(&self) -> f64 {
        self.point.phase * 180.0 / PI
    }

    fn row(&self) -> RaoRow<'_> {
        let RaoPoint { frequency, ratio, coherence, .. } = self.point;
        RaoRow {
            name: &self.name,
            series: &self.series,
            frequency_hz: frequency,
            period_s: 1.0 / frequency,
            rao: ratio,
            unit: &self.unit,
            phase_deg: self.phase_degrees(),
            coherence,
        }
    }
}

impl Serialize for RaoResult {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        self.row().serialize(serializer)
    }
}

/// An RAO with the columns of the file.
#[derive(Serialize)]
struct RaoRow<'a> {
    name: &'a str,
    series: &'a str,
    frequency_hz: f64,
    period_s: f64,
    rao: f64,
    unit: &'a str,
    phase_deg: f64,
    coherence: f64,
}

/// Writes `answers` into the run's `folder`; no file if there are none.
///
/// # Errors
/// `File` if it cannot be written.
pub(crate) fn write(folder: &Path, answers: &[RaoResult]) -> Result<()> {
    if answers.is_empty() {
        return Ok(());
    }
    let mut text = String::from("name,series,frequency_hz,period_s,rao,unit,phase_deg,coherence\n");
    for answer in answers {
        let RaoRow { name, series, frequency_hz, period_s, rao, unit, phase_deg, coherence } = answer.row();
        text += &format!("{name},{series},{frequency_hz:?},{period_s:?},{rao:?},{unit},{phase_deg:?},{coherence:?}\n");
    }
    write_atomically(&folder.join(RAO_FILE), text.as_bytes())
}

#[cfg(test)]
#[path = "../../../tests/unit/run/statistics/rao_table.rs"]
mod tests;
