//! Checks: figures by hand, and verdicts that fail when they must.

use std::{fs, path::PathBuf};

use pontoon::{
    check::{Check, Score, amplitude, deviation, peak},
    error::{Kind, Result},
    series::Series,
};

/// A folder with a run's table and a reference.
fn folder(name: &str, sim: &str, reference: &str) -> std::io::Result<PathBuf> {
    let folder = std::env::temp_dir().join(format!("pontoon-checks-{name}-{}", std::process::id()));
    fs::create_dir_all(&folder)?;
    fs::write(folder.join("box.csv"), sim)?;
    fs::write(folder.join("reference.csv"), reference)?;
    Ok(folder)
}

fn bound(n: f64) -> [Option<Score>; 2] {
    [None, Some(Score { n: Some(n), m: None })]
}

const SIM: &str = "t_s,heave_m,gap_m\n0.0,0.0,\n1.0,2.0,5.0\n2.0,4.0,\n3.0,6.0,7.0\n";

#[test]
fn a_perfect_run_has_no_deviation_and_a_run_twice_too_large_has_n_1_and_m_2() -> Result<()> {
    let reference = Series::new([0.0, 1.0, 2.5], [1.0, -3.0, 0.5])?;
    let twice = Series::new([0.0, 1.0, 2.5], [2.0, -6.0, 1.0])?;
    assert_eq!([deviation(&reference, &reference)?, amplitude(&reference, &reference)?], [0.0, 1.0]);
    assert_eq!([deviation(&twice, &reference)?, amplitude(&twice, &reference)?], [1.0, 2.0]);
    assert_eq!(peak(&twice, &reference)?, 1.0);
    Ok(())
}

#[test]
fn a_reference_outside_the_run_or_zero_is_refused() -> Result<()> {
    let sim = Series::new([0.0, 1.0], [1.0, 1.0])?;
    let late = Series::new([0.5, 1.5], [1.0, 1.0])?;
    let zero = Series::new([0.0, 1.0], [0.0, 0.0])?;
    assert!(deviation(&sim, &late).is_err_and(|e| e.what.contains("0.5 to 1.5 s")));
    assert!(amplitude(&sim, &zero).is_err() && peak(&sim, &zero).is_err());
    Ok(())
}

#[test]
fn a_verdict_fails_when_the_bound_is_missed_and_only_then() -> std::io::Result<()> {
    // Off by −0.5 at each of two instants: N = √(0.5/(1.5² + 3.5²)) = 0.1857…
    let folder = folder("bound", SIM, "# a comment\nt,z\n1.0,1.5\n2.0,3.5\n")?;
    let reference = folder.join("reference.csv");
    let judge =
        |limit: f64| Check::new("box.heave_m", &reference, ["t", "z"], 0.0, bound(limit)).map(|c| c.judge(&folder));
    let kept = judge(0.186).map_err(std::io::Error::other)?;
    let missed = judge(0.185).map_err(std::io::Error::other)?;
    assert_eq!((kept.passed, missed.passed), (Some(true), Some(false)));
    let by_hand = (0.5_f64 / 14.5).sqrt();
    assert!(kept.n.is_some_and(|n| (n - by_hand).abs() < 1e-15), "round-off; got {:?}", kept.n);
    fs::remove_dir_all(folder)
}

#[test]
fn several_readings_at_an_instant_count_as_their_mean_and_delay_moves_them() -> std::io::Result<()> {
    let folder = folder("mean", SIM, "t,z\n1.5,4.5\n0.5,2.0\n1.5,3.5\n0.5,2.0\n")?;
    let reference = folder.join("reference.csv");
    let check = Check::new("box.heave_m", &reference, ["t", "z"], 0.5, bound(0.0)).map_err(std::io::Error::other)?;
    let verdict = check.judge(&folder);
    assert_eq!((verdict.n, verdict.m, verdict.passed), (Some(0.0), Some(1.0), Some(true)));
    fs::remove_dir_all(folder)
}

#[test]
fn a_run_shorter_than_its_reference_is_compared_where_it_can_be_but_not_judged() -> std::io::Result<()> {
    let folder = folder("short", SIM, "t,z\n0,1\n1,2\n5,0\n6,0\n7,0\n")?;
    let reference = folder.join("reference.csv");
    let check = Check::new("box.heave_m", &reference, ["t", "z"], 0.0, bound(9.0)).map_err(std::io::Error::other)?;
    let verdict = check.judge(&folder);
    assert_eq!((verdict.covered, verdict.passed), (0.4, None));
    assert!(verdict.n.is_some() && verdict.note.is_some());
    let far = Check::new("box.heave_m", &reference, ["t", "z"], 100.0, bound(9.0)).map_err(std::io::Error::other)?;
    assert!(far.judge(&folder).note.is_some_and(|note| note.contains("the run at 0 and 3 s")));
    fs::remove_dir_all(folder)
}

#[test]
fn empty_fields_are_gaps_and_wrong_tables_say_what_is_wrong() -> std::io::Result<()> {
    let folder = folder("gaps", SIM, "t,z\n1,5\n3,7\n2,\n")?;
    let reference = folder.join("reference.csv");
    let check = Check::new("box.gap_m", &reference, ["t", "z"], 0.0, bound(0.0)).map_err(std::io::Error::other)?;
    assert_eq!(check.judge(&folder).passed, Some(true));
    let missing = Check::new("box.gap_m", &reference, ["t_s", "z"], 0.0, bound(0.0)).err();
    assert_eq!(missing.map(|e| e.kind), Some(Kind::Scene));
    fs::write(&reference, "t,z\n1,5\n2,six\n")?;
    let word = Check::new("box.gap_m", &reference, ["t", "z"], 0.0, bound(0.0)).err();
    assert_eq!(word.and_then(|e| e.place).and_then(|p| p.line_column), Some((3, 1)));
    let absent = Check::new("box.gap_m", &folder.join("no.csv"), ["t", "z"], 0.0, bound(0.0)).err();
    assert_eq!(absent.map(|e| e.kind), Some(Kind::File));
    fs::remove_dir_all(folder)
}
