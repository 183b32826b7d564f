//! Unit tests of `src/report/live.rs`.

use super::*;

#[test]
fn a_position_is_read_as_it_is_written() {
    for (text, frames, tables) in [("3.10.0", 3, vec![10, 0]), ("0", 0, vec![])] {
        let position = FeedPosition { frames, tables };
        assert_eq!((position.to_string().as_str(), text.parse()), (text, Ok(position)));
    }
    assert!(
        ["", "a", "1.x", "-1.2", "1.99999999999999999999"].iter().all(|text| text.parse::<FeedPosition>().is_err())
    );
}

#[test]
fn rows_are_read_whole_and_a_shortened_table_is_found() {
    let path = std::env::temp_dir().join(format!("pontoon-live-rows-{}.csv", std::process::id()));
    std::fs::write(&path, "t_s,a,b\n0.0,1.0,\n0.5,2.0,3.0\n1.0,4").unwrap();
    let mut offset = 0;
    let text = read_rows(&path, &mut offset).unwrap().unwrap();
    assert_eq!(offset, 29, "the last row is not complete");
    let columns = parse_rows(&text).unwrap();
    assert_eq!((&columns[0], &columns[1]), (&vec![0.0, 0.5], &vec![1.0, 2.0]));
    assert!(columns[2][0].is_nan() && columns[2][1] == 3.0);
    assert_eq!(read_rows(&path, &mut offset).unwrap().as_deref(), Some(""));
    assert_eq!(parse_rows(""), None);
    std::fs::write(&path, "t_s,a,b\n").unwrap();
    assert_eq!(read_rows(&path, &mut offset).unwrap(), None);
    std::fs::remove_file(&path).unwrap();
}

#[test]
fn a_long_table_is_read_in_parts() {
    let path = std::env::temp_dir().join(format!("pontoon-live-long-{}.csv", std::process::id()));
    let rows: String = (0..40_000).map(|i| format!("{i}.0,1.0\n")).collect();
    std::fs::write(&path, format!("t_s,a\n{rows}")).unwrap();
    let (mut offset, mut parts, mut times) = (0, 0, Vec::new());
    while let Some(columns) = parse_rows(&read_rows(&path, &mut offset).unwrap().unwrap()) {
        times.extend_from_slice(&columns[0]);
        parts += 1;
    }
    assert!(parts > 2 && times.iter().enumerate().all(|(i, t)| *t == i as f64) && times.len() == 40_000);
    std::fs::remove_file(&path).unwrap();
}
