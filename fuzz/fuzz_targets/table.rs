//! Any bytes as a table of a motion: read as a file beside a scene, then interpolated.
#![no_main]

use std::path::PathBuf;

use libfuzzer_sys::fuzz_target;
use pontoon::math::table::TableReader;

fuzz_target!(|bytes: &[u8]| {
    let path: PathBuf = std::env::temp_dir().join(format!("pontoon-fuzz-{}.csv", std::process::id()));
    std::fs::write(&path, bytes).expect("a file for the table");
    if let Ok(series) = TableReader::open(&path).and_then(|table| table.series("t_s", "x_m")) {
        assert_eq!(series.times().len(), series.values().len());
        assert!(series.values().iter().all(|x| x.is_finite()));
    }
});
