//! Unit tests of `src/study/result_rows.rs`.

use super::*;

#[test]
fn several_checks_of_one_series_have_distinct_labels() {
    assert_eq!(check_labels(["a.x_m", "b.y_m", "a.x_m"]), ["a.x_m", "b.y_m", "a.x_m (2)"]);
}

#[test]
fn values_with_commas_and_messages_of_several_lines_stay_in_one_cell() -> Result<()> {
    let row = ResultRow {
        run: "dp-0.01".into(),
        dp: 0.01,
        varied: vec![("gravity".into(), "[0.0, -9.81]".into())],
        metrics: ErrorMetrics { relative_l2: Some(0.25), ..ErrorMetrics::default() },
        status: "failed",
        reason: Some("too fast\n  usual cause".into()),
        ..ResultRow::default()
    };
    let text = rows_to_csv(&[row], &["gravity".into()])?;
    let mut reader = csv::Reader::from_reader(text.as_slice());
    let record = reader.records().next().and_then(|r| r.ok()).unwrap_or_default();
    assert_eq!((&record[3], &record[5], record.len()), ("[0.0, -9.81]", "0.25", 20));
    assert_eq!(&record[19], "too fast   usual cause");
    Ok(())
}
