//! Unit tests of `src/math/table.rs`.

use std::path::PathBuf;

use super::*;

/// A file with this text; its name holds `name`.
fn file(name: &str, text: &str) -> PathBuf {
    let path = std::env::temp_dir().join(format!("pontoon-table-{name}-{}.csv", std::process::id()));
    std::fs::write(&path, text).unwrap();
    path
}

#[test]
fn columns_skip_comments_blank_cells_and_spaces() -> Result<()> {
    let path = file("columns", "# m and N\nt_s, x_m ,f_N\n0.0, 1.0,\n# gap\n0.5,,2.0\n\n1.0,3e0,nothing\n");
    assert_eq!(TableReader::open(&path)?.header(), ["t_s", "x_m", "f_N"]);
    assert_eq!(TableReader::open(&path)?.columns(["x_m", "t_s"])?, [vec![1.0, 3.0], vec![0.0, 1.0]]);
    assert_eq!(TableReader::open(&path)?.series("t_s", "x_m")?.span(), (0.0, 1.0));
    std::fs::remove_file(&path).map_err(|e| Error::file(&path, e))
}

#[test]
fn errors_name_the_file_the_line_and_the_column() -> Result<()> {
    let path = file("errors", "t_s,x_m\n0.0,o.1\n0.1,inf\n");
    let refused =
        |names: [&str; 2]| TableReader::open(&path).and_then(|table| table.columns(names)).unwrap_err().to_string();
    let name = path.display();
    assert_eq!(refused(["t_s", "x_m"]), format!("\"o.1\" is not a number\n  in {name}:2:1, x_m"));
    let missing = format!("{name} has no column \"x_mm\"; did you mean \"x_m\"?\n  its columns: t_s, x_m");
    assert_eq!(refused(["t_s", "x_mm"]), missing);
    std::fs::write(&path, "t_s,x_m\n0.0,inf\n").unwrap();
    assert!(refused(["t_s", "x_m"]).contains("\"inf\" is not a number"));
    std::fs::write(&path, "t_s,x_m\n0.0,1.0\n0.1\n").unwrap();
    assert!(refused(["t_s", "x_m"]).contains(&format!("a row has 1 cells, its header 2\n  in {name}:3:1")));
    std::fs::write(&path, "t_s,x_m\n0.1,1.0\n0.1,2.0\n").unwrap();
    let error = TableReader::open(&path)?.series("t_s", "x_m").unwrap_err().message;
    assert!(error.starts_with(&format!("{name}, x_m: times must increase")), "{error}");
    std::fs::remove_file(&path).map_err(|e| Error::file(&path, e))
}

#[test]
fn all_columns_leave_out_a_cut_row() -> Result<()> {
    let path = file("cut", "t_s,x_m,f_N\n0.0,1.0,\n0.1,what,2.0\n0.2,3");
    let columns = TableReader::open(&path)?.all_columns()?;
    assert_eq!(columns[0], [0.0, 0.1]);
    assert!(columns[1][0] == 1.0 && columns[1][1].is_nan() && columns[2][0].is_nan() && columns[2][1] == 2.0);
    std::fs::write(&path, "").unwrap();
    assert!(TableReader::open(&path)?.all_columns()?.is_empty());
    std::fs::remove_file(&path).map_err(|e| Error::file(&path, e))
}
