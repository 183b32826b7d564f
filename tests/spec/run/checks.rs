//! Checks against references: metrics computed by hand, and verdicts.

use std::{f64::consts::TAU, fs, path::Path};

use pontoon::{
    analysis::{
        Align, CheckPlan, Reference, ReferenceCheck, ResponseReference, Score, Verdict, amplitude_ratio, best_delay,
        first_peak_error, format_verdicts, max_abs, relative_l2,
    },
    error::{ErrorKind, Result},
    math::time_series::{SampleScaling, TimeSeries},
    run::{self, Progress, RunOptions},
    scene::Scene,
};

use crate::common::TestFolder;

/// A folder with a table of a run and a reference.
fn folder(name: &str, sim: &str, reference: &str) -> std::io::Result<TestFolder> {
    let folder = TestFolder::new(&format!("checks-{name}"));
    fs::write(folder.join("box.csv"), sim)?;
    fs::write(folder.join("reference.csv"), reference)?;
    Ok(folder)
}

/// An upper bound of N.
fn bound(n: f64) -> Option<Score> {
    Some(Score { relative_l2: Some(n), ..Score::default() })
}

/// A check of `series` against `column` over `time` of `reference.csv`.
fn by_table(series: &str, [time, column]: [&str; 2], delay: f64, bound: Option<Score>) -> CheckPlan {
    let (time, column) = (time.into(), column.into());
    let scaling = SampleScaling { offset: delay, ..SampleScaling::default() };
    check(series, Reference::Table { file: "reference.csv".into(), time, column, scaling }, bound)
}

/// A check of `series` against a formula.
fn by_formula(series: &str, formula: &str, bound: Option<Score>) -> CheckPlan {
    check(series, Reference::Formula(formula.into()), bound)
}

fn check(series: &str, reference: Reference, bound: Option<Score>) -> CheckPlan {
    let check = CheckPlan::new(series, reference);
    match bound {
        Some(bound) => check.bound(bound),
        None => check,
    }
}

fn judge(plan: &CheckPlan, folder: &Path) -> Verdict {
    ReferenceCheck::new(plan, folder).unwrap_or_else(|e| panic!("{e}")).verdict(folder)
}

/// A table of x(t) at intervals of 0.01 s for 3 s.
fn table(x: impl Fn(f64) -> f64) -> String {
    let row = |i: usize| format!("{:?},{:?}\n", 0.01 * i as f64, x(0.01 * i as f64));
    std::iter::once("t_s,heave_m\n".to_string()).chain((0..=300).map(row)).collect()
}

const SIM: &str = "t_s,heave_m,gap_m\n0.0,0.0,\n1.0,2.0,5.0\n2.0,4.0,\n3.0,6.0,7.0\n";

#[test]
fn a_perfect_run_has_n_0_and_m_1_and_one_of_twice_the_amplitude_has_n_1_and_m_2() -> Result<()> {
    let reference = TimeSeries::new([0.0, 1.0, 2.5], [1.0, -3.0, 0.5])?;
    let twice = TimeSeries::new([0.0, 1.0, 2.5], [2.0, -6.0, 1.0])?;
    assert_eq!([relative_l2(&reference, &reference)?, amplitude_ratio(&reference, &reference)?], [0.0, 1.0]);
    assert_eq!([relative_l2(&twice, &reference)?, amplitude_ratio(&twice, &reference)?], [1.0, 2.0]);
    assert_eq!(first_peak_error(&twice, &reference)?, 1.0);
    Ok(())
}

#[test]
fn metrics_of_a_reference_outside_the_run_or_of_zero_are_refused() -> Result<()> {
    let sim = TimeSeries::new([0.0, 1.0], [1.0, 1.0])?;
    let late = TimeSeries::new([0.5, 1.5], [1.0, 1.0])?;
    let zero = TimeSeries::new([0.0, 1.0], [0.0, 0.0])?;
    assert!(relative_l2(&sim, &late).is_err_and(|e| e.message.contains("0.5 to 1.5 s")));
    assert!(amplitude_ratio(&sim, &zero).is_err() && first_peak_error(&sim, &zero).is_err());
    assert_eq!(max_abs(&sim, &zero)?, 1.0);
    Ok(())
}

#[test]
fn a_verdict_passes_within_its_bound_and_fails_beyond_it() -> std::io::Result<()> {
    // The error is 0.5 at each of two instants: N = √(0.5/(1.5² + 3.5²)) = 0.1857…
    let folder = folder("bound", SIM, "# a comment\nt,z\n1.0,1.5\n2.0,3.5\n")?;
    let verdict = |limit: f64| judge(&by_table("box.heave_m", ["t", "z"], 0.0, bound(limit)), &folder);
    let (passing, failing) = (verdict(0.186), verdict(0.185));
    assert_eq!((passing.passed, failing.passed), (Some(true), Some(false)));
    let no_figure = judge(&by_table("box.heave_m", ["t", "z"], 0.0, Some(Score::default())), &folder);
    assert_eq!((no_figure.bound, no_figure.passed), (None, None), "a bound without a figure judges nothing");
    let by_hand = (0.5_f64 / 14.5).sqrt();
    let n = passing.metrics.relative_l2;
    assert!(n.is_some_and(|n| (n - by_hand).abs() < 1e-15), "round-off; got {n:?}");
    Ok(())
}

#[test]
fn several_reference_values_at_an_instant_are_averaged_and_a_delay_shifts_them() -> std::io::Result<()> {
    let folder = folder("mean", SIM, "t,z\n1.5,4.5\n0.5,2.0\n1.5,3.5\n0.5,2.0\n")?;
    let verdict = judge(&by_table("box.heave_m", ["t", "z"], 0.5, bound(0.0)), &folder);
    assert_eq!(
        (verdict.metrics.relative_l2, verdict.metrics.amplitude_ratio, verdict.passed),
        (Some(0.0), Some(1.0), Some(true))
    );
    Ok(())
}

#[test]
fn a_run_shorter_than_its_reference_has_metrics_of_the_common_time_and_no_verdict() -> std::io::Result<()> {
    let folder = folder("short", SIM, "t,z\n0,1\n1,2\n5,0\n6,0\n7,0\n")?;
    let verdict = judge(&by_table("box.heave_m", ["t", "z"], 0.0, bound(9.0)), &folder);
    assert_eq!((verdict.covered, verdict.passed), (0.4, None));
    assert!(verdict.metrics.relative_l2.is_some() && verdict.note.is_some());
    let far = judge(&by_table("box.heave_m", ["t", "z"], 100.0, bound(9.0)), &folder);
    assert_eq!(far.passed, None);
    assert!(far.note.is_some_and(|note| note.contains("the run at 0 and 3 s")));
    Ok(())
}

#[test]
fn empty_fields_of_a_table_are_gaps_and_invalid_tables_are_refused() -> std::io::Result<()> {
    let folder = folder("gaps", SIM, "t,z\n1,5\n3,7\n2,\n")?;
    let reference = folder.join("reference.csv");
    let plan = |names: [&str; 2]| by_table("box.gap_m", names, 0.0, bound(0.0));
    assert_eq!(judge(&plan(["t", "z"]), &folder).passed, Some(true));
    let missing = ReferenceCheck::new(&plan(["x_m", "z"]), &folder).err();
    assert_eq!(missing.map(|e| e.kind), Some(ErrorKind::Scene));
    fs::write(&reference, "t,z\n1,5\n2,six\n")?;
    let word = ReferenceCheck::new(&plan(["t", "z"]), &folder).err();
    assert_eq!(word.and_then(|e| e.location).and_then(|p| p.line_column), Some((3, 1)));
    let absent = ReferenceCheck::new(&plan(["t", "z"]), &folder.join("nowhere")).err();
    assert_eq!(absent.map(|e| e.kind), Some(ErrorKind::File));
    Ok(())
}

#[test]
fn a_formula_reference_is_evaluated_at_the_times_of_the_run_within_the_window() -> std::io::Result<()> {
    // x = 2 t, and 0.1 more before 1 s.
    let folder = folder("formula", &table(|t| 2.0 * t + if t < 0.995 { 0.1 } else { 0.0 }), "")?;
    let limit = |off: f64| Some(Score { off: Some(off), ..Score::default() });
    let whole = judge(&by_formula("box.heave_m", "2*t", limit(0.05)), &folder);
    assert!(whole.metrics.off.is_some_and(|off| (off - 0.1).abs() < 1e-12) && whole.passed == Some(false));
    let late = by_formula("box.heave_m", "2*t", limit(0.05)).from(1.0);
    let late = judge(&late, &folder);
    assert!(late.metrics.relative_l2.is_some_and(|n| n < 1e-12) && late.passed == Some(true) && late.covered == 1.0);
    let early = by_formula("box.heave_m", "2*t", None).until(0.9);
    let n = judge(&early, &folder).metrics.relative_l2;
    let by_hand = {
        let t: Vec<f64> = (0..=90).map(|i| 0.01 * i as f64).collect();
        (0.01 * t.len() as f64 / t.iter().map(|t| 4.0 * t * t).sum::<f64>()).sqrt()
    };
    assert!(n.is_some_and(|n| (n - by_hand).abs() < 1e-12), "{n:?} against {by_hand}");
    // The run of 3 s covers a third of this window.
    let beyond = by_formula("box.heave_m", "2*t", limit(1.0)).from(2.0).until(5.0);
    let beyond = judge(&beyond, &folder);
    assert!((beyond.covered - 1.0 / 3.0).abs() < 1e-12 && beyond.passed.is_none());
    Ok(())
}

#[test]
fn a_zero_reference_has_a_maximum_error_but_no_n() -> std::io::Result<()> {
    let folder = folder("zero", &table(|t| 0.002 * (9.0 * t).sin()), "")?;
    let both = Score { relative_l2: Some(0.5), off: Some(0.003), ..Score::default() };
    let passing = judge(&by_formula("box.heave_m", "0", Some(Score { relative_l2: None, ..both })), &folder);
    assert!(
        passing.passed == Some(true)
            && passing.metrics.relative_l2.is_none()
            && passing.metrics.off.is_some_and(|x| x > 0.0019)
    );
    assert!(passing.note.is_some_and(|note| note.contains("zero throughout")));
    let failing = judge(&by_formula("box.heave_m", "0", Some(both)), &folder);
    assert_eq!(failing.passed, Some(false), "a bound on N fails without an N");
    let infinite = judge(&by_formula("box.heave_m", "1/t", Some(both)), &folder);
    assert!(infinite.passed == Some(false) && infinite.note.is_some_and(|note| note.contains("at t = 0 s")));
    let absent = judge(&by_formula("box.surge_m", "0", Some(both)), &folder);
    assert!(absent.passed == Some(false) && absent.note.is_some_and(|note| note.contains("no column")));
    Ok(())
}

#[test]
fn the_running_mean_keeps_a_line_and_averages_a_spike() -> Result<()> {
    let t: Vec<f64> = (0..=10).map(|i| 0.1 * i as f64).collect();
    let line = TimeSeries::new(t.clone(), t.clone())?.running_mean(0.3)?;
    // A centred mean of a line is the line. 0.15 s from either end there is no whole interval.
    assert_eq!(line.times(), &t[2..=8]);
    assert!(line.values().iter().zip(&t[2..=8]).all(|(x, t)| (x - t).abs() < 1e-12));
    // A triangle of height 1 and width 0.2 has the area 0.1; its mean over 0.4 s is 0.25.
    let spike: Vec<f64> = (0..=10).map(|i| f64::from(i == 5)).collect();
    let spike = TimeSeries::new(t, spike)?.running_mean(0.4)?;
    assert_eq!(spike.times().len(), 7, "from 0.2 to 0.8 s");
    assert!((spike.values()[3] - 0.25).abs() < 1e-12 && spike.values()[0] == 0.0);
    assert!(spike.running_mean(0.6).is_err(), "one time alone has a whole interval");
    Ok(())
}

#[test]
fn a_running_mean_has_its_own_metrics_in_addition_to_the_raw_ones() -> std::io::Result<()> {
    // Alternating noise, which a mean over several samples removes.
    let noisy = |t: f64| t + if (t * 100.0).round() as i64 % 2 == 0 { 0.1 } else { -0.1 };
    let folder = folder("noise", &table(noisy), "")?;
    let plan = by_formula("box.heave_m", "t", bound(0.01)).mean(0.2);
    let verdict = judge(&plan, &folder);
    let meaned = verdict.meaned.and_then(|m| m.metrics.relative_l2);
    assert!(verdict.metrics.relative_l2.is_some_and(|n| n > 0.05) && meaned.is_some_and(|n| n < 0.01));
    assert_eq!(verdict.passed, Some(false), "the bound is on the raw run");
    Ok(())
}

#[test]
fn a_series_with_a_zero_time_is_relative_to_its_value_at_that_time() -> std::io::Result<()> {
    // The run has an offset of 0.3, which the reference lacks.
    let folder = folder("zero-time", &table(|t| t * t + 0.3), "")?;
    let raw = by_formula("box.heave_m", "t^2 - 0.25", bound(1e-9));
    let set = raw.clone().zero(0.5);
    assert_eq!([judge(&raw, &folder).passed, judge(&set, &folder).passed], [Some(false), Some(true)]);
    assert_eq!(judge(&set, &folder).series, "box.heave_m, 0 at 0.5 s");
    let late = judge(&set.zero(1e3), &folder);
    assert!(late.passed.is_none() && late.note.is_some_and(|note| note.contains("before it is set to zero")));
    Ok(())
}

#[test]
fn the_delay_of_a_late_run_is_found_from_its_crossing_and_from_the_best_fit() -> std::io::Result<()> {
    let pulse = |t: f64| 10.0 * (-((t - 1.0) / 0.15).powi(2)).exp();
    let folder = folder("late", &table(|t| pulse(t - 0.05)), &table(pulse))?;
    let plan = by_table("box.heave_m", ["t_s", "heave_m"], 0.0, None);
    for align in [Align::Crossing(5.0), Align::Best] {
        let limits = Score { aligned_relative_l2: Some(0.01), delay: Some(0.06), ..Score::default() };
        let plan = plan.clone().align(align).bound(limits);
        let verdict = judge(&plan, &folder);
        // Crossings are interpolated linearly between samples; the curvature of the pulse causes an error of 8e-4 of its height.
        let aligned = verdict.aligned.unwrap_or_else(|| panic!("{align:?} is formed"));
        assert!((aligned.delay - 0.05).abs() < 2e-4 && aligned.relative_l2 < 0.003, "{align:?}: {aligned:?}");
        assert!(verdict.metrics.relative_l2.is_some_and(|n| n > 0.3), "alignment does not change the raw metric");
        assert_eq!(verdict.passed, Some(true));
        assert_eq!(verdict.arrival.is_some(), align != Align::Best);
        let strict = plan.clone().bound(Score { delay: Some(0.04), ..Score::default() });
        assert_eq!(judge(&strict, &folder).passed, Some(false));
    }
    let high = plan.clone().align(Align::Crossing(50.0)).bound(Score { relative_l2: Some(9.0), ..Score::default() });
    let never = judge(&high, &folder);
    assert!(never.aligned.is_none() && never.arrival.is_some_and(|a| a.run.is_none()));
    assert_eq!(never.passed, Some(true), "nothing aligned is asked for");
    let limit = Score { aligned_relative_l2: Some(9.0), ..Score::default() };
    assert_eq!(judge(&high.bound(limit), &folder).passed, Some(false));
    Ok(())
}

/// The run, 0.05 s late, is beyond the threshold when the time range begins or after the instrument is set to zero: its arrival
/// lies before, and a delay of 0 would be wrong.
#[test]
fn a_series_that_begins_beyond_the_threshold_has_no_arrival() -> std::io::Result<()> {
    let rise = |t: f64| 10.0 * (t - 1.0).max(0.0).powi(2);
    let folder = folder("beyond", &table(|t| rise(t - 0.05)), &table(rise))?;
    let limit = Score { delay: Some(0.01), ..Score::default() };
    let plan = by_table("box.heave_m", ["t_s", "heave_m"], 0.0, None).align(Align::Crossing(1.0)).bound(limit);
    for (late, why) in [(plan.clone().from(2.0), "from"), (plan.clone().zero(2.0), "zero")] {
        let verdict = judge(&late, &folder);
        assert!(verdict.aligned.is_none() && verdict.arrival.is_some_and(|a| a.run.is_none()), "{why}: {verdict:?}");
        assert_eq!(verdict.passed, Some(false), "{why}");
        assert!(verdict.note.is_some_and(|note| note.contains("beyond 1 from its first reading on")), "{why}");
    }
    let delay = judge(&plan.clone().from(0.5), &folder).aligned.map(|aligned| aligned.delay);
    // The curvature of the rise between two samples is 1e-4 of its slope.
    assert!(delay.is_some_and(|delay| (delay - 0.05).abs() < 2e-4), "{delay:?}");
    let clock = judge(&plan.align(Align::Start(1.0)).zero(2.0), &folder);
    assert!(clock.note.is_some_and(|note| note.contains("beyond 1 from its first reading on")));
    Ok(())
}

/// The run repeats the reference, whose record ends at 1.5 s, and has a peak three times as high at 2.5 s.
#[test]
fn a_peak_of_the_run_after_the_end_of_the_reference_does_not_count() -> std::io::Result<()> {
    let pulse = |t: f64, at: f64| (-((t - at) / 0.1).powi(2)).exp();
    let run = table(|t| pulse(t, 1.0) + 3.0 * pulse(t, 2.5));
    let record: String = table(|t| pulse(t, 1.0)).lines().take(152).map(|line| line.to_string() + "\n").collect();
    let folder = folder("later-peak", &run, &record)?;
    let limit = Score { peak: Some(1e-12), ..Score::default() };
    let plan = by_table("box.heave_m", ["t_s", "heave_m"], 0.0, Some(limit));
    let verdict = judge(&plan, &folder);
    assert_eq!((verdict.metrics.peak, verdict.passed), (Some(0.0), Some(true)), "{verdict:?}");
    Ok(())
}

/// A folder with a wave of 20 mm and 1.2 s over 12 s, and a body that drifts in it.
fn folder_with_drifting_body(name: &str) -> std::io::Result<TestFolder> {
    let folder = TestFolder::new(&format!("checks-{name}"));
    let table = |column: &str, x: &dyn Fn(f64) -> f64| {
        let row = |i: usize| format!("{:?},{:?}\n", 0.01 * i as f64, x(0.01 * i as f64));
        std::iter::once(format!("t_s,{column}\n")).chain((0..=1200).map(row)).collect::<String>()
    };
    fs::write(folder.join("gauge.csv"), table("eta_m", &|t| 0.02 * (TAU * t / 1.2).cos()))?;
    fs::write(folder.join("box.csv"), table("surge_m", &|t| 5.0 + 0.02 * t + 0.018 * (TAU * (t / 1.22 - 0.25)).cos()))?;
    Ok(folder)
}

#[test]
fn a_response_is_judged_without_its_drift_and_by_the_period_that_it_meets() -> std::io::Result<()> {
    let folder = folder_with_drifting_body("response")?;
    let limits = Score { amplitude_ratio: Some(0.001), period: Some(0.02), ..Score::default() };
    let response = |ratio, lag| ResponseReference {
        to: "gauge.eta_m".into(),
        period: 1.2,
        ratio,
        lag,
        from: Some(0.0),
        until: Some(6.0),
    };
    let plan = check("box.surge_m", Reference::Response(response(0.9, None)), Some(limits)).from(2.0).until(11.76);
    let verdict = judge(&plan, &folder);
    // 0.018/0.02 = 0.9, by construction; 1.22 s is 1.67 % above 1.2 s. The drift alone is 13 times the amplitude.
    assert_eq!((verdict.passed, verdict.series.as_str()), (Some(true), "box.surge_m, over gauge.eta_m"), "{verdict:?}");
    assert!(verdict.metrics.period.is_some_and(|x| (x - 0.02 / 1.2).abs() < 1e-6), "{verdict:?}");
    let strict = plan.clone().bound(Score { period: Some(0.01), ..Score::default() });
    assert_eq!(judge(&strict, &folder).passed, Some(false));
    let small = check("box.surge_m", Reference::Response(response(0.8, None)), Some(limits)).from(2.0).until(11.76);
    assert_eq!(judge(&small, &folder).passed, Some(false), "12.5 % too much");
    let curves = ReferenceCheck::new(&small, &folder).and_then(|check| check.curves(&folder));
    let curves = curves.unwrap_or_else(|e| panic!("{e}"));
    let [swing, run] = [&curves.reference, &curves.sim].map(|x| x.value_at(2.135) - x.value_at(2.745));
    // From trough to crest both drift by 12.2 mm; the run swings by 36 mm, the reference by 32 mm. Values between samples
    // are linear, which changes 4 parts in ten thousand.
    assert!(curves.exact && (swing / run - 44.2 / 48.2).abs() < 1e-3, "{swing} of {run}");
    Ok(())
}

#[test]
fn the_lag_of_a_response_is_that_in_the_middle_of_its_time() -> std::io::Result<()> {
    let folder = folder_with_drifting_body("lag")?;
    let at = |middle: f64, lag: f64| {
        let response = ResponseReference {
            to: "gauge.eta_m".into(),
            period: 1.2,
            ratio: 0.9,
            lag: Some(lag),
            from: None,
            until: None,
        };
        let limit = Some(Score { delay: Some(0.01), ..Score::default() });
        let plan = check("box.surge_m", Reference::Response(response), limit).from(middle - 3.0).until(middle + 3.0);
        judge(&plan, &folder)
    };
    // The wave is ahead by a quarter period at 0 s, and by t (1/1.2 − 1/1.22) more later.
    let lag = 0.25 + 6.0 * (1.0 / 1.2 - 1.0 / 1.22);
    assert_eq!(at(6.0, lag).passed, Some(true), "{:?}", at(6.0, lag));
    let late = at(6.0, lag - 0.1);
    assert!(late.passed == Some(false) && late.aligned.is_some_and(|a| (a.delay - 0.122).abs() < 1e-4), "{late:?}");
    Ok(())
}

#[test]
fn a_run_that_is_too_short_for_a_response_is_not_judged_and_one_at_rest_misses_its_bound() -> std::io::Result<()> {
    let folder = folder_with_drifting_body("short")?;
    let response = ResponseReference {
        to: "gauge.eta_m".into(),
        period: 1.2,
        ratio: 0.9,
        lag: None,
        from: Some(0.0),
        until: Some(6.0),
    };
    let limit = Some(Score { amplitude_ratio: Some(0.05), ..Score::default() });
    let plan = |response, until| check("box.surge_m", Reference::Response(response), limit).from(10.0).until(until);
    let short = judge(&plan(response.clone(), 20.0), &folder);
    assert!(short.passed.is_none() && short.note.is_some_and(|note| note.contains("does not swing")));
    fs::write(folder.join("still.csv"), "t_s,eta_m\n0.0,0.0\n12.0,0.0\n")?;
    let still = judge(&plan(ResponseReference { to: "still.eta_m".into(), ..response }, 12.0), &folder);
    assert_eq!(still.passed, Some(false), "{still:?}");
    Ok(())
}

#[test]
fn a_reference_with_its_own_clock_starts_at_the_crossing_of_the_run() -> std::io::Result<()> {
    // The run is at rest for a second and then rises at 2 m/s. The reference begins at the crossing of 1 m.
    let folder = folder("clock", &table(|t| (2.0 * (t - 1.0)).max(0.0)), &table(|t| 1.0 + 2.0 * t))?;
    let plan = by_table("box.heave_m", ["t_s", "heave_m"], 0.0, bound(0.01)).align(Align::Start(1.0)).until(0.8);
    let verdict = judge(&plan, &folder);
    // All values are linear: round-off.
    assert!(verdict.metrics.relative_l2.is_some_and(|n| n < 1e-12), "{verdict:?}");
    let arrival = verdict.arrival.expect("the run crosses 1 m");
    assert!(arrival.run.is_some_and(|t| (t - 1.5).abs() < 1e-12) && arrival.reference == Some(0.0), "{arrival:?}");
    assert!(verdict.aligned.is_none() && verdict.covered == 1.0);

    let formula = by_formula("box.heave_m", "1 + 2*t", bound(1e-9)).align(Align::Start(1.0)).from(0.1);
    assert_eq!(judge(&formula.until(0.8), &folder).passed, Some(true));
    let never = judge(&plan.align(Align::Start(9.0)), &folder);
    assert!(never.passed.is_none() && never.note.is_some_and(|note| note.contains("never passes 9")));
    Ok(())
}

#[test]
fn the_table_of_checks_contains_only_the_columns_in_use() -> std::io::Result<()> {
    let folder = folder("table", &table(|t| t), "")?;
    let plain = judge(&by_formula("box.heave_m", "t", bound(0.1)), &folder);
    let heads = |verdicts: &[&Verdict]| {
        let all: Vec<(&[String], &Verdict)> = verdicts.iter().map(|v| (&[][..], *v)).collect();
        format_verdicts::verdict_rows(&all, &[])[0].join("|")
    };
    assert_eq!(heads(&[&plain]), "check|N|M|bound|");
    let limit = Some(Score { off: Some(0.1), ..Score::default() });
    let rich = by_formula("box.heave_m", "t", limit).align(Align::Best).mean(0.1);
    let rich = judge(&rich, &folder);
    assert_eq!(heads(&[&plain, &rich]), "check|N|M|mean over|mean N|mean M|aligned N|aligned M|delay|off|bound|");
    // A load series has its first peak as an additional column.
    let load = Verdict { series: "wall.fx_N (2)".into(), bound: None, aligned: None, ..rich };
    assert_eq!(heads(&[&load]), "check|N|M|mean over|mean N|mean M|peak|mean peak|bound|");
    Ok(())
}

/// A response, as a scene has it.
const RESPONSE: &str = "response = { to = \"energy.water_kinetic_J_per_m\", period = 1.2, ratio = 0.9 }";

/// The error message of a scene with these keys in its check.
fn error_message(keys: &str) -> String {
    let text = format!(
        "dimension = 2\ndp = 0.1\nuntil = 1.0\nwater = [{{ fill = {{ box = {{ min = [0.0, 0.0], max = [1.0, 0.5] }} }} }}]\n\
         probe = [{{ energy = true }}]\n[[check]]\nseries = \"energy.total_J_per_m\"\n{keys}"
    );
    Scene::parse(&text, Path::new("."), &[]).and_then(|s| s.plan()).expect_err("this check is wrong").to_string()
}

#[test]
fn invalid_check_keys_are_refused_with_a_remedy() {
    for (keys, parts) in [
        ("", ["\"reference\" is missing", "write  reference = \"body.csv\""]),
        ("reference = \"a.csv\"", ["\"column\" is missing", "check.0.column"]),
        ("formula = \"0\"\ncolumn = \"x\"", ["a check by a formula has no column", "give either formula"]),
        ("formula = \"2*sinus(t)\"", ["did you mean \"sin", "check.0.formula"]),
        ("formula = \"0\"\nfrom = 2.0\nuntil = 1.0", ["nothing lies between from = 2 and until = 1", "later time"]),
        ("formula = \"0\"\nmean = 0.0", ["mean must be a positive number", "write  mean = 0.005"]),
        ("formula = \"0\"\nalign = \"bset\"", ["unknown align \"bset\"; did you mean \"best\"?", "crossing"]),
        ("formula = \"0\"\nalign = { crossing = -5.0 }", ["crossing must be a positive number", "align = {"]),
        ("formula = \"0\"\nalign = { start = 0.0 }", ["start must be a positive number", "align = {"]),
        ("formula = \"0\"\nbound = { aligned_N = 0.1 }", ["nothing is aligned", "align = \"best\""]),
        (
            "formula = \"0\"\nbound = { of = 0.1 }",
            ["unknown key \"of\"; did you mean \"off\"?", "write  off  in place of  of"],
        ),
        ("formula = \"0\"\nbound = { off = -0.1 }", ["the largest that passes", "check.0.bound.off"]),
        ("formula = \"0\"\nbound = { period = 0.1 }", ["only a response has", "remove it"]),
        (&format!("formula = \"0\"\n{RESPONSE}"), ["has a formula and a response", "remove one of them"]),
        (&format!("column = \"x\"\n{RESPONSE}"), ["a check by a response has no column", "give either response"]),
        (&format!("{RESPONSE}\nmean = 0.1"), ["has no mean", "remove it"]),
        (&format!("{RESPONSE}\nbound = {{ delay = 0.1 }}"), ["the response has no lag", "write  lag = 0.25"]),
        (&RESPONSE.replace("period = 1.2", "period = 0.0"), ["period must be a positive number", "period = 1.2"]),
        (&RESPONSE.replace("energy.", "enegry."), ["no probe is called \"enegry\"", "did you mean \"energy\""]),
        (&RESPONSE.replace("ratio", "ration"), ["unknown key \"ration\"", "did you mean \"ratio\""]),
    ] {
        let message = error_message(keys);
        assert!(parts.iter().all(|part| message.contains(part)), "{keys}: {message}");
    }
}

/// A run that is 0.1 s late, compared over its whole 0.5 s: beyond 0.05 s less than nine tenths of the reference are left, and N still
/// falls there. Such a delay is none. With a reference that leaves room, the delay is found.
#[test]
fn a_delay_at_the_edge_of_what_can_be_tried_is_none() -> Result<()> {
    let t: Vec<f64> = (0..=500).map(|i| 0.001 * f64::from(i)).collect();
    let late = |delay: f64| t.iter().map(|t| 0.1 * (t - delay).powi(2)).collect::<Vec<_>>();
    let (sim, reference) = (TimeSeries::new(t.clone(), late(0.1))?, TimeSeries::new(t.clone(), late(0.0))?);
    assert_eq!(best_delay(&sim, &reference), None);
    let found = best_delay(&sim, &reference.window(0.1, 0.35)?).expect("a delay");
    // The golden section ends within a microsecond.
    assert!((found - 0.1).abs() < 1e-5, "{found}");
    Ok(())
}

#[test]
fn a_crossing_that_is_never_reached_is_told() -> std::io::Result<()> {
    let home = folder("crossing", "t_s,x_m\n0,0\n1,1\n2,4\n", "t_s,x_m\n0,0\n1,1\n2,4\n")?;
    let verdict = |threshold: f64| {
        let mut plan = by_table("box.x_m", ["t_s", "x_m"], 0.0, None);
        plan.align = Some(Align::Crossing(threshold));
        ReferenceCheck::new(&plan, &home).unwrap().verdict(&home)
    };
    assert_eq!((verdict(2.0).note, verdict(2.0).aligned.map(|a| a.delay)), (None, Some(0.0)));
    assert_eq!(verdict(10.0).note.as_deref(), Some("the run never passes 10: not aligned"));
    Ok(())
}

#[test]
fn a_scene_with_checks_survives_writing_and_reading() -> Result<()> {
    let text = "dimension = 2\ndp = 0.1\nuntil = 1.0\nwater = [{ fill = { box = { min = [0.0, 0.0], max = [1.0, 0.5] } } }]\n\
        probe = [{ energy = true }]\n[[check]]\nseries = \"energy.total_J_per_m\"\nformula = \"t\"\nfrom = 0.1\nuntil = 0.9\n\
        mean = 0.01\nalign = { crossing = 5.0 }\nbound = { off = 0.1, peak = 0.2, aligned_N = 0.3, delay = 0.4 }\n\
        [[check]]\nseries = \"energy.total_J_per_m\"\nformula = \"t\"\nalign = \"best\"\n\
        [[check]]\nseries = \"energy.total_J_per_m\"\nbound = { M = 0.05, period = 0.05, delay = 0.1 }\n\
        response = { to = \"energy.total_J_per_m\", period = 0.1, ratio = 2.0, lag = 0.5, from = 0.2, until = 0.8 }\n";
    let scene = Scene::parse(text, Path::new("."), &[])?;
    assert_eq!(Scene::parse(&scene.to_toml()?, Path::new("."), &[])?, scene);
    let lines: Vec<String> = scene.resolve()?.iter().map(|v| v.to_string()).collect();
    assert!(lines.contains(&"check.0.align.crossing = 5.0  (scene line 12)".into()), "{}", lines.join("\n"));
    Ok(())
}

#[test]
fn an_interrupted_run_has_metrics_but_a_verdict_only_after_its_end() -> Result<()> {
    let home = TestFolder::new("checks-part");
    let (scene, out) = (home.join("scene.toml"), home.join("run"));
    let text = "dimension = 2\ndp = 0.05\nuntil = 0.2\nwater = [{ fill = { box = { min = [0.0, 0.0], max = [1.0, 0.5] } } }]\n\
        solid = [{ name = \"tank\", fixed = true, shape = { tank = { size = [1.0, 1.0] } } }]\n\
        probe = [{ name = \"tank\", force = \"tank\", every = 0.001 }]\n[[check]]\nseries = \"tank.fy_N_per_m\"\n\
        formula = \"-4905\"\nbound = { N = 0.1 }\n";
    fs::write(&scene, text).unwrap();
    let options = RunOptions { out: Some(out.clone()), threads: Some(1), ..RunOptions::default() };
    let part = run::run(&scene, &options, &mut |now: &Progress| now.time < 0.1)?;
    let verdict = &part.manifest.checks[0];
    assert!(verdict.metrics.relative_l2.is_some_and(|n| n < 0.1) && verdict.passed.is_none(), "{verdict:?}");
    assert!(verdict.note.as_ref().is_some_and(|note| note.contains("has not finished")), "{verdict:?}");
    let whole = run::resume(&out, &[], Some(1), &mut |_: &Progress| true)?;
    assert_eq!((whole.manifest.checks[0].passed, &whole.manifest.checks[0].note), (Some(true), &None));
    Ok(())
}
