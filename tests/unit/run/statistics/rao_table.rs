//! Unit tests of `src/run/statistics/rao_table.rs`.

use super::*;
use crate::error::Error;

#[test]
fn the_rao_table_has_a_row_for_each_frequency_and_no_file_without_results() -> Result<()> {
    let folder = std::env::temp_dir().join(format!("pontoon-rao-rows-{}", std::process::id()));
    let failed = |why| Error::file(&folder, why);
    std::fs::create_dir_all(&folder).map_err(failed)?;
    write(&folder, &[])?;
    assert!(!folder.join(RAO_FILE).exists());
    let result = |frequency, phase| RaoResult {
        name: "rao".into(),
        series: "buoy.pitch_deg".into(),
        unit: "°/m".into(),
        point: RaoPoint { frequency, ratio: 1.5, phase, coherence: 0.75 },
    };
    write(&folder, &[result(0.5, 0.0), result(0.625, -0.5 * PI)])?;
    let text = std::fs::read_to_string(folder.join(RAO_FILE)).map_err(failed)?;
    let rows = [
        "name,series,frequency_hz,period_s,rao,unit,phase_deg,coherence",
        "rao,buoy.pitch_deg,0.5,2.0,1.5,°/m,0.0,0.75",
        "rao,buoy.pitch_deg,0.625,1.6,1.5,°/m,-90.0,0.75",
    ];
    assert_eq!(text.lines().collect::<Vec<_>>(), rows);
    let json = serde_json::to_string(&result(0.625, -0.5 * PI)).map_err(|why| Error::file(&folder, why))?;
    let expected = r#"{"name":"rao","series":"buoy.pitch_deg","frequency_hz":0.625,"period_s":1.6,"rao":1.5,"unit":"°/m","phase_deg":-90.0,"coherence":0.75}"#;
    assert_eq!(json, expected, "the JSON keys are the columns of the file");
    std::fs::remove_dir_all(&folder).map_err(failed)
}
