//! How motions answer irregular waves over frequency, at a run's end: `rao.csv`, a row for each frequency of each motion.

use std::{f64::consts::PI, path::Path};

use crate::{error::Result, record::write_whole, stats::Band};

/// The file, in the run's folder.
pub const RAO: &str = "rao.csv";

/// How a motion answers the waves at a frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// Name of the `[[statistic]]`.
    pub name: String,
    /// The motion, as `probe.column`.
    pub series: String,
    /// Unit of the ratio, as `m/m`.
    pub unit: String,
    /// The answer.
    pub band: Band,
}

impl Answer {
    /// Phase of the motion less that of the wave, degrees.
    pub fn degrees(&self) -> f64 {
        self.band.phase * 180.0 / PI
    }
}

/// Writes `answers` into the run's `folder`; no file if there are none.
///
/// # Errors
/// `File` if it cannot be written.
pub fn write(folder: &Path, answers: &[Answer]) -> Result<()> {
    if answers.is_empty() {
        return Ok(());
    }
    let mut text = String::from("name,series,frequency_hz,period_s,rao,unit,phase_deg,coherence\n");
    for answer in answers {
        let Answer { name, series, unit, band } = answer;
        let (f, ratio, phase, coherence) = (band.frequency, band.ratio, answer.degrees(), band.coherence);
        text += &format!("{name},{series},{f:?},{:?},{ratio:?},{unit},{phase:?},{coherence:?}\n", 1.0 / f);
    }
    write_whole(&folder.join(RAO), text.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Error;

    #[test]
    fn each_frequency_of_each_motion_has_a_row_and_no_answer_no_file() -> Result<()> {
        let folder = std::env::temp_dir().join(format!("pontoon-rao-rows-{}", std::process::id()));
        let failed = |why| Error::file(&folder, why);
        std::fs::create_dir_all(&folder).map_err(failed)?;
        write(&folder, &[])?;
        assert!(!folder.join(RAO).exists());
        let answer = |frequency, phase| Answer {
            name: "rao".into(),
            series: "buoy.pitch_deg".into(),
            unit: "°/m".into(),
            band: Band { frequency, ratio: 1.5, phase, coherence: 0.75 },
        };
        write(&folder, &[answer(0.5, 0.0), answer(0.625, -0.5 * PI)])?;
        let text = std::fs::read_to_string(folder.join(RAO)).map_err(failed)?;
        let rows = [
            "name,series,frequency_hz,period_s,rao,unit,phase_deg,coherence",
            "rao,buoy.pitch_deg,0.5,2.0,1.5,°/m,0.0,0.75",
            "rao,buoy.pitch_deg,0.625,1.6,1.5,°/m,-90.0,0.75",
        ];
        assert_eq!(text.lines().collect::<Vec<_>>(), rows);
        std::fs::remove_dir_all(&folder).map_err(failed)
    }
}
