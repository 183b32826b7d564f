//! Unit tests of `src/output/csv.rs`.

use super::*;

fn columns() -> Vec<String> {
    vec!["a_m".into(), "b_N".into()]
}

#[test]
fn a_resumed_table_equals_the_uninterrupted_one_byte_for_byte() -> Result<()> {
    let folder = std::env::temp_dir().join(format!("pontoon-table-{}", std::process::id()));
    std::fs::create_dir_all(&folder).map_err(|e| Error::file(&folder, e))?;
    let path = folder.join("x.csv");
    let mut table = CsvTable::create(&path, &columns())?;
    table.append_row(0.0, &[1.0 / 3.0, f64::NAN])?;
    let bytes = table.bytes();
    table.append_row(0.1, &[-1e-9, 2.0])?;
    let whole = std::fs::read(&path).map_err(|e| Error::file(&path, e))?;
    assert!(CsvTable::create(&path, &columns()).is_err(), "an existing table is never overwritten");

    let mut again = CsvTable::resume(&path, &columns(), bytes)?;
    let (t, row) = again.last_row().map(|(t, row)| (t, row.to_vec())).unwrap_or_default();
    assert!(t == 0.0 && row[0] == 1.0 / 3.0 && row[1].is_nan(), "the same bits; got {t} {row:?}");
    again.append_row(0.1, &[-1e-9, 2.0])?;
    again.append_row(0.2, &[0.0, 0.0])?;
    again.truncate(whole.len() as u64)?;
    assert_eq!(again.last_row(), Some((0.1, &[-1e-9, 2.0][..])), "the last row after the truncation");
    assert!(again.first_row().is_some_and(|row| row[0] == 1.0 / 3.0), "the first row remains: {:?}", again.first_row());
    assert_eq!(std::fs::read(&path).map_err(|e| Error::file(&path, e))?, whole);
    assert_eq!(whole, b"t_s,a_m,b_N\n0.0,0.3333333333333333,\n0.1,-1e-9,2.0\n");
    assert!(CsvTable::resume(&path, &columns(), 10_000).is_err(), "shorter than at the checkpoint");
    assert!(CsvTable::resume(&path, &columns()[..1], bytes).is_err(), "other columns");
    assert!(CsvTable::resume(&path, &columns(), bytes - 1).is_err(), "an incomplete row");
    std::fs::remove_dir_all(&folder).map_err(|e| Error::file(&folder, e))
}
