//! Unit tests of `src/math/table.rs`.

use std::{
    f64::consts::PI,
    path::PathBuf,
    sync::atomic::{AtomicUsize, Ordering},
};

use super::*;

/// A file with these bytes, which is removed at the end of a test.
struct TestFile(PathBuf);

impl TestFile {
    fn new(name: &str, bytes: impl AsRef<[u8]>) -> Self {
        static COUNT: AtomicUsize = AtomicUsize::new(0);
        let (process, number) = (std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(format!("pontoon-table-{name}-{process}-{number}.csv"));
        std::fs::write(&path, bytes).unwrap();
        Self(path)
    }

    fn open(&self) -> Result<TableReader> {
        TableReader::open(&self.0)
    }
}

impl Drop for TestFile {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

/// The series of column `x` over the times of a table, and the remark.
fn read(name: &str, bytes: impl AsRef<[u8]>, x: impl Into<ColumnName>) -> Result<(Vec<f64>, Vec<f64>, String)> {
    let mut table = TestFile::new(name, bytes).open()?;
    let series = table.series(OWN_TIME, x)?;
    Ok((series.times().to_vec(), series.values().to_vec(), table.remark().unwrap_or_default()))
}

/// `text` in UTF-16 with this order of bytes.
fn utf16(text: &str, order: fn(u16) -> [u8; 2]) -> Vec<u8> {
    text.encode_utf16().flat_map(order).collect()
}

#[test]
fn columns_skip_comments_blank_cells_and_spaces() -> Result<()> {
    let file = TestFile::new("columns", "# m and N\nt_s, x_m ,f_N\n0.0, 1.0,\n# gap\n0.5,,2.0\n\n1.0,3e0,nothing\n");
    assert_eq!(file.open()?.header(), ["t_s", "x_m", "f_N"]);
    assert_eq!(file.open()?.columns(["x_m", "t_s"])?, [vec![1.0, 3.0], vec![0.0, 1.0]]);
    assert_eq!(file.open()?.series("t_s", "x_m")?.span(), (0.0, 1.0));
    assert_eq!(file.open()?.remark(), None, "a table as the program writes it needs no remark");
    Ok(())
}

#[test]
fn errors_name_the_file_the_line_and_the_column() -> Result<()> {
    let file = TestFile::new("errors", "t_s,x_m\n0.0,o.1\n0.1,inf\n");
    let refused = |names: [&str; 2]| file.open().and_then(|mut table| table.columns(names)).unwrap_err().to_string();
    let name = file.0.display();
    assert_eq!(refused(["t_s", "x_m"]), format!("\"o.1\" is not a number\n  in {name}:2:1, x_m"));
    let missing = format!("{name} has no column \"x_mm\"; did you mean \"x_m\"?\n  its columns: t_s, x_m");
    assert_eq!(refused(["t_s", "x_mm"]), missing);
    std::fs::write(&file.0, "t_s,x_m\n0.0,inf\n").unwrap();
    assert!(refused(["t_s", "x_m"]).contains("\"inf\" is not a number"));
    std::fs::write(&file.0, "t_s,x_m\n0.0,1.0\n0.1\n").unwrap();
    assert!(refused(["t_s", "x_m"]).contains(&format!("a row has 1 cell, its header 2\n  in {name}:3:1")));
    std::fs::write(&file.0, "t_s,x_m\n# two\n0.1,1.0\n0.1,2.0\n").unwrap();
    let error = file.open()?.series("t_s", "x_m").unwrap_err().to_string();
    assert!(error.starts_with(&format!("times must increase: 0.1 follows 0.1\n  in {name}:4:1, t_s")), "{error}");
    Ok(())
}

#[test]
fn complete_columns_refuse_a_row_without_a_value_and_skip_blank_rows() -> Result<()> {
    let file = TestFile::new("complete", "a,b,note\n1,2,x\n,,\n3,,y\n");
    let error = file.open()?.complete_columns(["a", "b"]).unwrap_err().to_string();
    assert!(error.contains(&format!("a row has no value\n  in {}:4:1, b", file.0.display())), "{error}");
    std::fs::write(&file.0, "a,b,note\n1,2,\n,,\n3,4,y\n").unwrap();
    assert_eq!(file.open()?.complete_columns(["a", "b"])?, [vec![1.0, 3.0], vec![2.0, 4.0]]);
    Ok(())
}

#[test]
fn all_columns_leave_out_a_cut_row() -> Result<()> {
    let file = TestFile::new("cut", "t_s,x_m,f_N\n0.0,1.0,\n0.1,what,2.0\n0.2,3");
    let columns = file.open()?.all_columns();
    assert_eq!(columns[0], [0.0, 0.1]);
    assert!(columns[1][0] == 1.0 && columns[1][1].is_nan() && columns[2][0].is_nan() && columns[2][1] == 2.0);
    std::fs::write(&file.0, "").unwrap();
    assert!(file.open()?.all_columns().is_empty());
    std::fs::write(&file.0, "t_s,x_m\n").unwrap();
    assert_eq!(file.open()?.all_columns(), [vec![], vec![]] as [Vec<f64>; 2]);
    std::fs::write(&file.0, "t_s,a,b,f_N\n0.0,box,tank,1.5\n0.1,box,sill,2.5\n").unwrap();
    assert_eq!(file.open()?.all_columns()[3], [1.5, 2.5], "columns of words among those of numbers");
    Ok(())
}

#[test]
fn tables_of_other_programs_are_read_and_the_remark_names_the_layout() -> Result<()> {
    let by_name = [
        // Name, text, column, parts of the remark.
        ("semicolon", "t_s;x_m\n0.0;1.5\n0.5;2.5\n", "x_m", "separator semicolon"),
        ("tab", "t_s\tx_m\n0.0\t1.5\n0.5\t2.5\n", "x_m", "separator tab"),
        ("blanks", "t_s   x_m\n0.0   1.5\n 0.5  2.5\n", "x_m", "separator blanks"),
        ("units", "t_s,x_m\ns,m\n0.0,1.5\n0.5,2.5\n", "x_m", "row of units in line 2"),
        ("brackets", "Time,Surge\n(s),(m)\n0.0,1.5\n0.5,2.5\n", "Surge", "times from column \"Time\""),
        ("german", "Zeit;Weg\n0,0;1,5\n0,5;2,5\n", "Weg", "decimal commas"),
        ("german-blanks", "t x\n0,0 1,5\n0,5 2,5\n", "x", "decimal commas"),
        ("excel", "sep=;\nt_s;x_m\n0,0;1,5\n0,5;2,5\n", "x_m", "separator semicolon"),
        ("comment", "# time(s) displ(m)\n0.0   1.5\n0.5   2.5\n", "displ(m)", "names from the comment in line 1"),
        ("bare", "# time (s) displ (m)\n0.0   1.5\n0.5   2.5\n", "displ", "names from the comment in line 1"),
        ("matlab", "% t x\n  0.0000000e+00   1.5D+00\n  5.0000000e-01   2.5D+00\n", "x", "begin with % are comments"),
        ("slashes", "// made by a logger\nt_s,x_m\n0.0,1.5\n0.5,2.5\n", "x_m", "begin with / are comments"),
        ("bom", "\u{feff}t_s,x_m\n0.0,1.5\n0.5,2.5\n", "x_m", "byte order mark"),
        ("mac", "t_s;x_m\r0.0;1.5\r0.5;2.5\r", "x_m", "separator semicolon"),
        ("quotes", "\"t_s\";'x_m'\r\n\"0.0\";\"1.5\"\r\n\"0.5\";\"2.5\"\r\n", "x_m", "separator semicolon"),
        ("trailing", "t_s;x_m;\n0.0;1.5;\n0.5;2.5;\n", "x_m", "separator semicolon"),
        ("trailing-rows", "t_s;x_m\n0.0;1.5;\n0.5;2.5;\n", "x_m", "separator semicolon"),
        ("nan", "t_s,x_m\n0.0,1.5\n0.2,NaN\n0.5,2.5\n", "x_m", "line 3 has no value and is skipped"),
        (
            "openfast",
            "\nPredictions were generated on 05-Dec-2019 at 10:10:10 using FAST, v8\nlinked with NWTC (v2, 64)\n\n\
             Description: 5 m flume\n\nTime \tWave1Elev \tB1Surge\n(s)\t(m)\t(m)\n 0.0\t 9.0\t 1.5\n 0.5\t 9.0\t 2.5\n",
            "B1Surge",
            "row of units in line 8; lines 2 to 5 skipped",
        ),
        ("upper-units", "t,x\nS,MM\n0.0,1.5\n0.5,2.5\n", "x", "row of units in line 2"),
        ("words-as-units", "t,x\nsecs,millimetre\n0.0,1.5\n0.5,2.5\n", "x", "row of units in line 2"),
        ("names-of-words", "Time (s)  Surge motion (m)\n0.0 1.5\n0.5 2.5\n", "Surge motion", "separator blanks"),
        ("r-csv", "\"t_s\",\"x_m\"\n\"1\",0.0,1.5\n\"2\",0.5,2.5\n", "x_m", "no name for the first column"),
        ("r-blanks", "\"t_s\" \"x_m\"\n\"1\" 0.0 1.5\n\"2\" 0.5 2.5\n", "x_m", "which numbers the rows"),
        (
            "openfast-blanks",
            "Test 3\nTime  Elev  Surge\n (s)   (m)   (m)\n 0.0  9.0  1.5\n 0.5  9.0  2.5\n",
            "Surge",
            "line 1 skipped",
        ),
        (
            "dualsphysics",
            " ;PosX [m]:;1.2\n ;PosY [m]:;0\nPart;Time [s];swlz [m]\n0;0.0;1.5\n1;0.5;2.5\n",
            "swlz",
            "times from column \"Time [s]\"",
        ),
        ("gauges", "t_s;1.38;x_m\n0.0;0;1.5\n0.5;0;2.5\n", "x_m", "separator semicolon"),
        ("title", "Test 12 of the flume\nt_s,x_m\n0.0,1.5\n0.5,2.5\n", "x_m", "line 1 skipped"),
        ("column-of-words", "t_s;state;x_m\n0,0;on;1,5\n0,5;on;2,5\n", "x_m", "decimal commas"),
        ("two-comments", "# time displ\n# s m\n0.0 1.5\n0.5 2.5\n", "displ", "names from the comment in line 1"),
        ("other-separator", "t_s x_m\n0.0\t1.5\n0.5\t2.5\n", "x_m", "separator tab"),
        ("comma-over-blanks", "t_s, x_m\n0.0 1.5\n0.5 2.5\n", "x_m", "separator blanks"),
        ("excel-tab", "sep=\t\nt_s\tx_m\n0.0\t1.5\n0.5\t2.5\n", "x_m", "separator tab"),
        ("padded", "t_s, x_m\n 0.0,\t1.5\n 0.5,\t2.5\n", "x_m", ""),
        ("minus", "t_s;x_m\n−0.5;0\n0.0;1.5\n0.5;2.5\n", "x_m", "semicolon"),
        ("three-decimals", "t_s;x_m\n0,000;1,500\n0,500;2,500\n", "x_m", "decimal commas"),
    ];
    for (name, text, column, parts) in by_name {
        let (t, x, remark) = read(name, text, column).unwrap_or_else(|e| panic!("{name}: {e}"));
        let last = |x: &[f64]| x[x.len() - 2..].to_vec();
        assert_eq!((last(&t), last(&x)), (vec![0.0, 0.5], vec![1.5, 2.5]), "{name}");
        assert!(remark.contains(parts) && remark.is_empty() == parts.is_empty(), "{name}: {remark}");
    }
    let text = "t_s\tx_m\r\n0,0\t1,5\r\n0,5\t2,5\r\n";
    let mut marked = vec![0xff, 0xfe];
    marked.extend(utf16(text, u16::to_le_bytes));
    let mut big = vec![0xfe, 0xff];
    big.extend(utf16(text, u16::to_be_bytes));
    for (name, bytes) in [("le", marked), ("be", big), ("no-mark", utf16(text, u16::to_le_bytes))] {
        let (t, x, remark) = read(name, bytes, "x_m")?;
        assert_eq!((t, x), (vec![0.0, 0.5], vec![1.5, 2.5]), "{name}");
        assert!(remark.starts_with("UTF-16; separator tab; decimal commas; columns \"t_s\", \"x_m\""), "{remark}");
    }
    let (_, x, remark) = read("latin", b"t_s,x_m,T_\xb0C\n0.0,1.5,20\n0.5,2.5,20\n", "x_m")?;
    assert!(x == [1.5, 2.5] && remark.contains("Windows-1252"), "{remark}");
    Ok(())
}

#[test]
fn columns_go_by_number_with_and_without_names() -> Result<()> {
    let by_number = [
        ("no-names", "0.0,1.5\n0.5,2.5\n", "no row of names; times from column 1"),
        ("no-names-blanks", "  0.0 1.5\n  0.5 2.5\n", "separator blanks; no row of names; times from column 1"),
        ("no-names-comma", "0,0;1,5\n0,5;2,5\n", "decimal commas; no row of names"),
        ("preamble", "A record of the flume, 5 m\n0.0\t1.5\n0.5\t2.5\n", "no row of names"),
        ("names", "t_s,x_m\n0.0,1.5\n0.5,2.5\n", ""),
    ];
    for (name, text, parts) in by_number {
        let (t, x, remark) = read(name, text, ColumnName::Number(2)).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!((t, x), (vec![0.0, 0.5], vec![1.5, 2.5]), "{name}");
        assert!(remark.contains(parts), "{name}: {remark}");
    }
    let refused = |text: &str, column: ColumnName| read("number", text, column).unwrap_err().to_string();
    let no_names = refused("0.0,1.5\n0.5,2.5\n", "x_m".into());
    assert!(
        no_names.contains("no row of names, so no column \"x_m\"") && no_names.contains("column = 2"),
        "{no_names}"
    );
    assert!(refused("0.0,1.5\n0.5,2.5\n", ColumnName::Number(3)).contains("has no column 3\n  it has 2"));
    let twice = refused("t_s,x_m,x_m\n0.0,1.5,9\n0.5,2.5,9\n", "x_m".into());
    assert!(twice.contains("more than one column \"x_m\"") && twice.contains("2 or 3"), "{twice}");
    assert_eq!(read("twice", "t_s,x_m,x_m\n0.0,1.5,9\n0.5,2.5,9\n", ColumnName::Number(3))?.1, [9.0, 9.0]);
    let unfit = refused("t_s;x_m\n0.0;1.5;2\n0.5;2.5;2\n", "x_m".into());
    assert!(unfit.contains("2 names over rows of 3 cells") && unfit.contains("without quotation marks"), "{unfit}");
    // The numbers of the rows are no times.
    let counted = refused("t_s x_m\n1 0.0 1.5\n2 0.5 2.5\n", ColumnName::Number(3));
    assert!(counted.contains("the first of which numbers the rows"), "{counted}");
    let rows = "\"t_s\" \"x_m\"\n\"1\" 0 1.5\n\"2\" 0.5 2.5\n";
    assert_eq!(read("r", rows, ColumnName::Number(3))?.0, [0.0, 0.5]);
    let quoted = refused("t_s,x_m\n0.0,1.5\n0.5,2.5\n", "2".into());
    assert!(quoted.contains("write 2 without quotation marks; its columns: t_s, x_m"), "{quoted}");
    Ok(())
}

#[test]
fn numbers_with_several_readings_and_other_cells_are_refused_with_the_reason() {
    let refused = [
        ("thousands", "t_s;x_m\n1,234;5,678\n2,345;6,789\n", "\"1,234\" may be 1.234 or 1234", "decimal points"),
        ("both", "t_s;x_m\n0,5;1.234,5\n1,0;1.234,5\n", "has a separator of thousands", "1234.5"),
        ("mixed", "t_s;x_m\n0.5;1,5\n1.0;1,5\n2.0;3\n", "has a decimal comma or a separator of thousands", "1234.5"),
        ("commas", "t_s,x_m\n0,0,0,5\n0,1,0,6\n", "separate the columns and may be decimal commas", "semicolons"),
        ("commas-no-names", "0,00,0,50\n0,01,0,60\n", "separate the columns and may be decimal commas", "semicolons"),
        ("commas-pairs", "1,0,0,25\n2,0,0,75\n3,0,0,95\n", "may be decimal commas as well", "name every column"),
        ("empty", "\n", "is empty", "name another file"),
        ("comments", "# t_s,x_m\n", "has comments alone", "name another file"),
        ("rounded", "t_s,x_m\n0.00,1\n0.00,2\n0.01,3\n", "0 follows 0", "more digits"),
        ("two-names", "t,x_m\nWert,Weg\n0.0,1\n0.5,2\n", "has two rows of names, and line 2 is used", "remove one"),
        ("unquoted", "t_s x_m\n1 0.0 1\n2 0.5 2\n", "2 names over rows of 3 cells, the first", "name every column"),
        ("date", "t_s,x_m\n2021-05-03 12:00:00,1\n2021-05-03 12:00:01,2\n", "is a date or a time of day", "seconds"),
        ("german-date", "t_s;x_m\n03.05.2021;1\n04.05.2021;2\n", "is a date or a time of day", "seconds"),
        ("clock", "t_s,x_m\n12:00:00.5,1\n12:00:01.5,2\n", "is a date or a time of day", "seconds"),
        ("unit", "t_s,x_m\n0.0,1.2 m\n0.5,1.3 m\n", "\"1.2 m\" is a number with a unit", "write 1.2 alone"),
        ("back", "t_s,x_m\n0.0,1\n0.5,2\n0.2,3\n", "times must increase: 0.2 follows 0.5", "sort the rows"),
        ("zip", "PK\u{3}\u{4}x", "is not a table: it is a zip archive", "CSV"),
        ("html", "<!DOCTYPE html>\n<html></html>", "a web page", "download"),
        ("lfs", "version https://git-lfs.github.com/spec/v1\noid sha256:1\nsize 3\n", "Git LFS", "git lfs pull"),
        ("binary", "t\0\0\0\0x", "it is binary", "text"),
        ("footer", "t_s,x_m\n0.0,1\n0.5,2\nend of record\n", "a row has 1 cell, its header 2", "write # before"),
        ("short", "t_s,x_m\n0.0,1\n0.5\n", "a row has 1 cell, its header 2", "blank"),
        ("long", "t_s,x_m\n0.0,1\n0.5,2,\"x\"\n", "a row has 3 cells, its header 2", "blank"),
        ("bars", "t_s|x_m\n0.0|1\n0.5|2\n", "the character | separates the columns", "semicolons, tabs or blanks"),
        ("bars-wide", "| t_s | x_m |\n| --- | --- |\n| 0.0 | 1 |\n", "the character | separates", "semicolons"),
    ];
    for (name, text, what, help) in refused {
        let error = read(name, text, "x_m").map(|read| format!("{read:?}")).unwrap_err().to_string();
        assert!(error.contains(what) && error.contains(help), "{name}: {error}");
    }
}

/// A bar in a name or in a comment separates nothing.
#[test]
fn bars_in_names_are_part_of_them() -> Result<()> {
    assert_eq!(read("bar", "t_s,|x|_m\n# a | b\n0.0,1.5\n0.5,2.5\n", "|x|_m")?.1, [1.5, 2.5]);
    Ok(())
}

#[test]
fn units_come_from_the_row_of_units_or_the_name() -> Result<()> {
    let unit = |text: &str, column: &str| TestFile::new("unit", text).open()?.unit(column);
    let some = |unit: &str| Some(unit.to_string());
    assert_eq!(unit("t_s,x_mm\n0,1\n1,2\n", "x_mm")?, some("mm"));
    assert_eq!(unit("t_s,x [mm]\n0,1\n1,2\n", "x [mm]")?, some("mm"));
    assert_eq!(unit("t_s,x\ns,mm\n0,1\n1,2\n", "x")?, some("mm"));
    assert_eq!(unit("t_s,x_min\n0,1\n1,2\n", "x_min")?, None, "a least value is not in minutes");
    assert_eq!(unit("t_s,w_degps\n0,1\n1,2\n", "w_degps")?, some("degps"));
    assert_eq!(unit("t_s,U_kmh\n0,1\n1,2\n", "U_kmh")?, some("kmh"));
    assert_eq!(unit("t_s,n_steps\n0,1\n1,2\n", "n_steps")?, None);
    assert!(si_factor("mm") == Some(1e-3) && si_factor("m").is_none() && is_degree("deg"));
    Ok(())
}

/// The unit of a column of this name whose values are meant in a unit, in 2-D.
fn unit_as(name: &str, meant: &str) -> Option<String> {
    let file = TestFile::new("meant", format!("i,\"{name}\"\n0,1\n1,2\n"));
    file.open().unwrap().unit_as(ColumnName::Number(2), Some((meant, 2))).unwrap()
}

#[test]
fn names_hold_units_of_the_quantity_that_is_meant() {
    for (name, meant, unit, factor) in [
        ("time_min", "s", "min", 60.0),
        ("time_h", "s", "h", 3600.0),
        ("time_hours", "s", "hours", 3600.0),
        ("hours", "s", "hours", 3600.0),
        ("time_days", "s", "days", 86400.0),
        ("t_d", "s", "d", 86400.0),
        ("time_us", "s", "us", 1e-6),
        ("T_MS", "s", "MS", 1e-3),
        ("tms", "s", "ms", 1e-3),
        ("q_Nmm", "N m", "Nmm", 1e-3),
        ("q_Ncm", "N m", "Ncm", 1e-2),
        ("m_g", "kg", "g", 1e-3),
        ("gravity_g", "m/s²", "g", 9.806_65),
        ("f_gf", "N", "gf", 9.806_65e-3),
        ("z_in", "m", "in", 0.0254),
        ("z_inch", "m", "inch", 0.0254),
        ("z_MM", "m", "MM", 1e-3),
        ("zmm", "m", "mm", 1e-3),
        ("Fxmm", "m", "mm", 1e-3),
        ("z.mm", "m", "mm", 1e-3),
        ("z-mm", "m", "mm", 1e-3),
        ("z {mm}", "m", "mm", 1e-3),
        ("z / mm", "m", "mm", 1e-3),
        ("z_millimetres", "m", "millimetres", 1e-3),
        ("Fx (kN) filtered", "N", "kN", 1e3),
        ("fx_kN_filt", "N", "kN", 1e3),
        ("kN_fx", "N", "kN", 1e3),
        ("kN", "N", "kN", 1e3),
        ("FX_KN", "N", "KN", 1e3),
        ("force_kn", "N", "kn", 1e3),
        ("u_kn", "m/s", "kn", 1852.0 / 3600.0),
        ("fx.kN", "N", "kN", 1e3),
        ("fx-kN", "N", "kN", 1e3),
        ("Fx <kN>", "N", "kN", 1e3),
        ("Fx in kN", "N", "kN", 1e3),
        ("Force, kN", "N", "kN", 1e3),
        ("fx_N_per_m", "N", "N_per_m", 1.0),
        ("fx (N per m)", "N", "N per m", 1.0),
        ("fx_kN_per_m", "N", "kN_per_m", 1e3),
        ("fx_kNpm", "N", "kNpm", 1e3),
        ("deg", "rad", "deg", PI / 180.0),
        ("pitch_DEG", "rad", "DEG", PI / 180.0),
        ("pitch (Deg)", "rad", "Deg", PI / 180.0),
        ("pitch (degs)", "rad", "degs", PI / 180.0),
        ("w (degs)", "rad/s", "degs", PI / 180.0),
        ("v_mm_s", "m/s", "mm_s", 1e-3),
        ("lag_30_mm_s", "s", "s", 1.0),
        ("v_mm/s", "m/s", "mm/s", 1e-3),
        ("v_ms", "m/s", "ms", 1.0),
        ("a_ms2", "m/s²", "ms2", 1.0),
    ] {
        assert_eq!(unit_as(name, meant).as_deref(), Some(unit), "{name} in {meant}");
        let Some(Conversion::Factor(found)) = conversion(unit, meant, 2) else { panic!("{unit} in {meant}") };
        assert!((found / factor - 1.0).abs() < 1e-12, "{unit} in {meant}: {found}");
    }
    for (name, meant) in [("v_ms", "m"), ("v_mps", "m"), ("a_ms2", "m"), ("v_m_s", "m"), ("fx_N_per_m", "m")] {
        let unit = unit_as(name, meant).unwrap();
        assert_eq!(conversion(&unit, meant, 2), Some(Conversion::OtherQuantity), "{name} in {meant}");
    }
    assert!(
        is_degree("DEG")
            && is_degree("degs")
            && !is_degree("rad")
            && is_assumed("degs")
            && is_assumed("in")
            && !is_assumed("deg")
    );
    assert_eq!(conversion("MNM", "N m", 2), None, "mN m or MN m");
    assert_eq!(conversion("kN_per_m", "N", 3), Some(Conversion::OtherQuantity));
}

#[test]
fn words_and_symbols_in_names_are_no_units() {
    for (name, meant) in [
        ("z_min", "m"),
        ("z_max", "m"),
        ("t_in", "kg"),
        ("u_in", "m/s"),
        ("F_in", "N"),
        ("F_t", "N"),
        ("F_g", "N"),
        ("x_t", "m"),
        ("x_d", "m"),
        ("x_h", "m"),
        ("p_1", "Pa"),
        ("pitch_1", "rad"),
        ("x_bar", "m"),
        ("x_rev", "m"),
        ("eta_m2", "m"),
        ("x_s2", "m"),
        ("H/d", "rad"),
        ("in", "m"),
        ("min", "s"),
        ("left", "m"),
        ("rms", "m"),
        ("max_steps", "m"),
        ("stroke_spm", "m"),
        ("f_mpa", "Pa"),
        ("pppppppppppppppppppppppppppppppppppppppppppppppppppppppppppp", "m"),
        ("pppppppppppppppppppppppppp_ppp", "m"),
    ] {
        assert_eq!(unit_as(name, meant), None, "{name} in {meant}");
    }
    assert_eq!(of_series("b.fx_N_per_m"), Some("N_per_m"));
    assert_eq!(of_series("g.eta_at_1.5_m"), Some("m"));
}

#[test]
fn products_powers_and_rates_are_units() {
    // Size in the SI by hand.
    let kilometre_per_hour = 1000.0 / 3600.0;
    for (unit, size) in [
        ("km h-1", kilometre_per_hour),
        ("km h^-1", kilometre_per_hour),
        ("km·h⁻¹", kilometre_per_hour),
        ("km h−1", kilometre_per_hour),
        ("kmh", kilometre_per_hour),
        ("kmph", kilometre_per_hour),
        ("m min-1", 1.0 / 60.0),
        ("m/min", 1.0 / 60.0),
        ("mm s-2", 1e-3),
        ("mm s**-2", 1e-3),
        ("cm/s^2", 1e-2),
        ("cmps2", 1e-2),
        ("l", f64::NAN),
        ("dm3 s-1", 1e-3),
        ("kN-m", 1e3),
        ("kN m-1", 1e3),
        ("ft-lbf", 0.3048 * 4.448_221_615_260_5),
        ("degps", PI / 180.0),
        ("°/s", PI / 180.0),
        ("rpm", PI / 30.0),
        ("kg cm-2", 1e4),
        ("d1", f64::NAN),
        ("m-", f64::NAN),
        ("-2", f64::NAN),
    ] {
        let found = si_factor(unit);
        let is_right = found.map_or(size.is_nan(), |found| (found / size - 1.0).abs() < 1e-12);
        assert!(is_right && is_without_size(unit) == size.is_nan(), "{unit}: {found:?}");
    }
    assert!(
        ["m s-1", "m s^-1", "m·s⁻¹", "m3 s-1", "mps", "m3ps", "s-1", "kg m s-2"]
            .iter()
            .all(|unit| { si_factor(unit).is_none() && !is_without_size(unit) })
    );
}

#[test]
fn a_unit_is_converted_to_one_of_its_quantity_alone() {
    let factor = |unit: &str, meant: &str| match conversion(unit, meant, 3) {
        Some(Conversion::Factor(factor)) => factor,
        _ => f64::NAN,
    };
    let weight = |unit: &str, meant: &str| match conversion(unit, meant, 3) {
        Some(Conversion::Weight(factor)) => factor,
        _ => f64::NAN,
    };
    for (found, right) in [
        (factor("rad", "deg"), 180.0 / PI),
        (factor("mrad", "deg"), 0.18 / PI),
        (factor("deg/s", "radps"), PI / 180.0),
        (factor("mbar", "Pa"), 100.0),
        (factor("mm", "m"), 1e-3),
        (factor("-", "deg"), 1.0),
        (factor("Hz", "rad/s"), 2.0 * PI),
        (weight("lb", "N"), 4.448_221_615_260_5),
        (weight("kg", "N"), 9.806_65),
        (weight("ft-lb", "N m"), 1.355_817_948_331_400_4),
        (weight("kg/cm²", "Pa"), 98_066.5),
        (factor("lb", "kg"), 0.453_592_37),
    ] {
        assert!((found / right - 1.0).abs() < 1e-12, "{found}, not {right}");
    }
    for (unit, meant) in
        [("m/s", "m"), ("m/s²", "m"), ("m", "rad"), ("m", "deg"), ("Pa", "m"), ("m", "Pa"), ("rad", "m"), ("N/m", "N")]
    {
        assert_eq!(conversion(unit, meant, 3), Some(Conversion::OtherQuantity), "{unit} as {meant}");
    }
    // In 2-D per metre of width.
    assert_eq!(conversion("kN/m", "N", 2), Some(Conversion::Factor(1e3)));
    assert_eq!(conversion("kg/m", "kg", 2), Some(Conversion::Factor(1.0)));
    assert_eq!(conversion("N", "N m", 2), Some(Conversion::OtherQuantity));
    assert_eq!(conversion("m/s", "m", 2), Some(Conversion::OtherQuantity));
    assert_eq!((of_series("b.pitch_deg"), of_series("b.count")), (Some("deg"), None));
}
