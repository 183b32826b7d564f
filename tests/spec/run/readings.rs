//! Evaluation of readings: means over intervals, gaps, and time ranges without readings.

use std::{f64::consts::TAU, fs, path::Path};

use pontoon::{
    analysis::{CheckPlan, Reference, ReferenceCheck, Score, Verdict, first_peak_error},
    error::Result,
    math::time_series::{SampleScaling, TimeSeries},
    run::{self, Progress, RunOptions, Statistic, StatisticsFilter},
    scene::Scene,
};

use crate::common::TestFolder;

/// A folder with the table `box.csv` of these rows.
fn folder(name: &str, rows: impl Iterator<Item = (f64, Option<f64>)>) -> TestFolder {
    let folder = TestFolder::new(&format!("readings-{name}"));
    let row = |(t, x): (f64, Option<f64>)| format!("{t:?},{}\n", x.map_or(String::new(), |x| format!("{x:?}")));
    fs::write(folder.join("box.csv"), "t_s,heave_m\n".to_string() + &rows.map(row).collect::<String>()).unwrap();
    folder
}

fn by_formula(formula: &str, bound: Score) -> CheckPlan {
    CheckPlan::new("box.heave_m", Reference::Formula(formula.into())).bound(bound)
}

fn judge(plan: &CheckPlan, folder: &Path) -> Verdict {
    ReferenceCheck::new(plan, folder).unwrap().verdict(folder)
}

/// An upper bound of N.
fn n_bound() -> Score {
    Score { relative_l2: Some(0.1), ..Score::default() }
}

/// The mean of cos 2πt over t ± Δ/2 is cos 2πt · sin(πΔ)/(πΔ): with Δ = 0.1 s the amplitude is 1.6 % lower, and nothing is late.
#[test]
fn a_check_compares_a_mean_in_the_middle_of_its_interval() {
    let step = 0.1;
    let mean = |t: f64| ((TAU * t).sin() - (TAU * (t - step)).sin()) / (TAU * step);
    let rows = (0..=100).map(|i| step * f64::from(i)).map(|t| (t, Some(if t == 0.0 { 1.0 } else { mean(t) })));
    let folder = folder("mean", rows);
    let plan = by_formula("cos(2*pi*t)", n_bound());
    let lower = 1.0 - (0.5 * TAU * step).sin() / (0.5 * TAU * step);
    let n = judge(&plan.clone().means("box.heave_m"), &folder).metrics.relative_l2.unwrap();
    // The first reading, at 0 s, is none: of 101 readings it has no error.
    assert!((n - lower).abs() < 0.02 * lower, "{n}, {lower}");
    // At the end of the interval the means would be half an interval late: N = 2 sin(π/20) = 0.31.
    assert!(judge(&plan, &folder).metrics.relative_l2.is_some_and(|n| n > 0.3));
}

#[test]
fn a_bound_is_missed_where_the_run_has_no_reading_and_kept_open_where_it_ends_before() {
    // Readings every 0.5 s until 10 s, none from 4 to 8 s.
    let known = |t: f64| !(4.0..=8.0).contains(&t);
    let folder = folder("empty", (0..=20).map(|i| 0.5 * f64::from(i)).map(|t| (t, known(t).then_some(5.0))));
    let passed = |from: f64, until: f64| judge(&by_formula("5", n_bound()).from(from).until(until), &folder).passed;
    assert_eq!(passed(0.0, 3.0), Some(true));
    for (from, until, why) in [(-5.0, -1.0, "before the run"), (1.1, 1.4, "between readings"), (4.5, 7.5, "in a gap")] {
        assert_eq!(passed(from, until), Some(false), "{why}: N is not defined");
    }
    // The run ends before half of the time range.
    assert_eq!([passed(8.0, 13.0), passed(11.0, 12.0)], [None, None]);
}

/// The run has the value 1 until 4 s and 9 from 6 s on, and no readings between. A line across the gap would be 3 to 7 off there.
#[test]
fn samples_of_a_reference_in_a_gap_of_the_run_do_not_count() {
    let value = |t: f64| {
        if t <= 4.0 {
            Some(1.0)
        } else if t < 6.0 {
            None
        } else {
            Some(9.0)
        }
    };
    let folder = folder("reference-gap", (0..=20).map(|i| 0.5 * f64::from(i)).map(|t| (t, value(t))));
    let reference = |times: &[f64]| {
        let row = |t: &f64| format!("{t:?},{:?}\n", if *t < 5.5 { 1.0 } else { 9.0 });
        fs::write(folder.join("r.csv"), "t_s,z_m\n".to_string() + &times.iter().map(row).collect::<String>()).unwrap();
        let (time, column) = ("t_s".into(), "z_m".into());
        let table = Reference::Table { file: "r.csv".into(), time, column, scaling: SampleScaling::default() };
        judge(&CheckPlan::new("box.heave_m", table).bound(n_bound()), &folder)
    };
    let verdict = reference(&[3.0, 4.0, 5.0, 5.5, 6.0, 7.0]);
    assert_eq!((verdict.metrics.relative_l2, verdict.passed), (Some(0.0), Some(true)), "{verdict:?}");
    // Half of a reference is half of its time: this one has a sample within the run, which ends at 10 s.
    assert_eq!(reference(&[4.0, 50.0]).passed, None);
    let hidden = reference(&[4.0, 4.5, 5.0, 5.5, 5.8]);
    assert_eq!(hidden.passed, Some(false), "{hidden:?}");
}

#[test]
fn a_maximum_at_the_edge_of_the_window_is_no_first_peak() -> Result<()> {
    let series = |x: &[f64]| TimeSeries::new((0..x.len()).map(|i| i as f64).collect::<Vec<_>>(), x);
    let reference = series(&[0.0, 2.0, 0.0])?;
    let error = |x: &[f64]| first_peak_error(&series(x)?, &reference);
    // The window begins on the falling side of a crest of unknown height; the first peak in it is 3.
    assert_eq!(error(&[3.5, 2.0, 0.0, 3.0, 0.0, 5.0, 0.0])?, 0.5);
    // At the end the series still rises.
    assert!(error(&[0.0, 1.0, 2.0]).is_err_and(|e| e.message.contains("the run has no peak")));
    assert!(first_peak_error(&reference, &series(&[2.0, 1.0, 0.0])?).is_err());
    // The window begins on the rising side.
    assert_eq!(error(&[1.5, 2.0, 0.0])?, 0.0);
    Ok(())
}

/// The delay of an instrument with a mean over 0.2 s: at the ends no interval is whole, and a line is its own mean.
#[test]
fn a_running_mean_is_compared_where_its_interval_is_whole() {
    let folder = folder("centred", (0..=100).map(|i| 0.1 * f64::from(i)).map(|t| (t, Some(t * t))));
    let verdict = judge(&by_formula("t^2", n_bound()).mean(2.0), &folder);
    // The mean of t² over t ± 1 s is t² + 1/3; the trapezoidal rule over 0.1 s adds 0.1²/6.
    let off = verdict.meaned.unwrap().metrics.off.unwrap();
    assert!((off - (1.0 / 3.0 + 0.01 / 6.0)).abs() < 1e-9, "{off}");
    let short = judge(&by_formula("t^2", n_bound()).mean(20.0), &folder);
    assert!(short.meaned.is_none() && short.note.is_some_and(|note| note.contains("a mean over 20 s")));
}

const SCENE: &str = r#"
dimension = 2
dp = 0.1
until = 0.02
frames = "off"
[[water]]
fill = { box = { min = [0.0, 0.0], max = [1.0, 0.4] } }
[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [1.0, 0.8] } }
[[probe]]
name = "g"
elevation = { x = 0.5 }
average = true
[[probe]]
name = "h"
elevation = { x = 0.5 }
[[statistic]]
rao = { motion = "g", wave = "h" }
period = 1.25
from = 2.0
until = 9.0
"#;

/// A finished run with these rows of the elevations `g` (means over 0.1 s) and `h`.
fn run_of(name: &str, g: impl Fn(f64) -> Option<f64>, h: impl Fn(f64) -> Option<f64>) -> Result<TestFolder> {
    let home = TestFolder::with_scene(&format!("readings-{name}"), SCENE);
    let options = RunOptions { out: Some(home.join("run")), threads: Some(1), ..RunOptions::default() };
    run::run(&home.join("scene.toml"), &options, &mut |_: &Progress| true)?;
    let cell = |x: Option<f64>| x.map_or(String::new(), |x| format!("{x:?}"));
    let table = |eta: &dyn Fn(f64) -> Option<f64>| {
        let row = |t: f64| format!("{t:?},{},{}\n", cell(eta(t).map(|eta| 0.4 + eta)), cell(eta(t)));
        "t_s,level_m,eta_m\n".to_string() + &(0..=300).map(|i| row(0.1 * f64::from(i))).collect::<String>()
    };
    fs::write(home.join("run/series/g.csv"), table(&g)).unwrap();
    fs::write(home.join("run/series/h.csv"), table(&h)).unwrap();
    Ok(home)
}

fn value(rows: &[Statistic], name: &str, series: &str, quantity: &str) -> Option<f64> {
    let found = rows.iter().find(|row| row.name == name && row.series == series && row.quantity == quantity);
    found.map(|row| row.value)
}

/// `g` holds the means of the wave of `h`: they have its phase. At the end of the interval they would lag by 0.05/1.25 of a period,
/// 14.4°. The amplitude is that of the wave times sin(πΔ/T)/(πΔ/T).
#[test]
fn an_rao_of_means_has_the_phase_of_the_motion() -> Result<()> {
    let omega = TAU / 1.25;
    let mean = |t: f64| 0.05 * ((omega * t).sin() - (omega * (t - 0.1)).sin()) / (omega * 0.1);
    let home = run_of("rao", |t| Some(if t == 0.0 { 0.05 } else { mean(t) }), |t| Some(0.05 * (omega * t).cos()))?;
    let statistics = run::statistics(&home.join("run"), &StatisticsFilter::default())?;
    let [rao, phase] = ["rao", "phase"].map(|of| value(&statistics.rows, "rao", "g.eta_m", of).unwrap());
    assert!(phase.abs() < 1e-6, "{phase}");
    let lower = (0.05 * omega).sin() / (0.05 * omega);
    assert!((rao - lower).abs() < 1e-9, "{rao}, {lower}");
    // A narrower filter restricts the statistic, and a wider one does not widen it.
    let span = |from: f64, until: f64| -> Result<(f64, f64)> {
        let asked = StatisticsFilter { series: None, from: Some(from), until: Some(until) };
        let rows = run::statistics(&home.join("run"), &asked)?.rows;
        Ok(rows.iter().find(|row| row.name == "rao").map(|row| (row.from_s, row.until_s)).unwrap())
    };
    let ((first, last), (narrow, _)) = (span(0.0, 30.0)?, span(4.0, 30.0)?);
    assert!((first - 2.05).abs() < 1e-9 && (last - 8.95).abs() < 1e-9, "{first} {last}");
    assert!((narrow - 4.05).abs() < 1e-9, "{narrow}");
    Ok(())
}

#[test]
fn a_time_range_without_readings_is_named_as_the_cause() -> Result<()> {
    let home = run_of("range", |_| Some(0.1), |_| Some(0.1))?;
    let refusal = |series: Option<&str>, from: f64, until: f64| {
        let asked = StatisticsFilter { series: series.map(String::from), from: Some(from), until: Some(until) };
        run::statistics(&home.join("run"), &asked).err().map(|e| e.message).unwrap_or_default()
    };
    for series in [None, Some("h"), Some("h.eta_m")] {
        let told = refusal(series, 5.0, 5.0);
        assert!(told.contains("two readings from 5 s until 5 s") && !told.contains("did you mean"), "{told}");
    }
    assert!(refusal(Some("h.eta_m"), 40.0, 50.0).contains("the readings in"), "the end of the readings is named");
    assert!(refusal(Some("h.eta"), 5.0, 5.0).contains("did you mean \"h.eta_m\"?"));
    Ok(())
}

/// Of `h` a third is missing, from 10 to 20 s, where it changes from 1 to 3 m; readings lie at both sides in equal number.
#[test]
fn gaps_are_remarked_and_left_out_of_means_and_hide_waves() -> Result<()> {
    let wave = |t: f64| 0.05 * (TAU * t / 1.25).cos();
    let known = |t: f64| !(10.05..19.95).contains(&t);
    let home = run_of("gaps", |t| known(t).then(|| wave(t)), |t| known(t).then_some(if t < 15.0 { 1.0 } else { 3.0 }))?;
    let told = run::statistics(&home.join("run"), &StatisticsFilter::default())?;
    assert!((value(&told.rows, "", "h.eta_m", "mean").unwrap() - 2.0).abs() < 1e-12);
    assert!((value(&told.rows, "", "h.eta_m", "std").unwrap() - 1.0).abs() < 1e-12);
    let remark = |word: &str| told.remarks.iter().find(|remark| remark.contains(word)).cloned().unwrap_or_default();
    assert!(remark("h.").contains("32.9 % of its readings are missing"), "{:?}", told.remarks);
    assert!(remark("g.").contains("waves and spectra are not given"), "{:?}", told.remarks);
    for quantity in ["waves", "T_z", "H_m0"] {
        assert_eq!(value(&told.rows, "", "g.eta_m", quantity), None, "{quantity}");
    }
    Ok(())
}

#[test]
fn statistics_of_one_name_are_refused() {
    let twice = format!("{SCENE}\n[[statistic]]\nname = \"rao\"\nwaves = \"h\"\n");
    let told = Scene::parse(&twice, Path::new("."), &[]).and_then(|scene| scene.plan()).unwrap_err().to_string();
    assert!(told.contains("two statistics are called \"rao\"") && told.contains("statistic.1.name"), "{told}");
}

/// Totals since the start stay readings of one instant, so that differences between rows and sums of a budget hold.
#[test]
fn a_probe_that_averages_takes_no_means_of_totals() -> Result<()> {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/cylinder/scene.toml");
    let probes = "[[probe]]\nname = \"face\"\nface = \"inflow\"\naverage = true\n\
        [[probe]]\nname = \"budget\"\nbudget = true\naverage = true\n\
        [[probe]]\nname = \"flow\"\nflow = { from = [0.5, 0.0], to = [0.5, 0.4] }\naverage = true\n";
    let text = fs::read_to_string(scene).unwrap() + probes;
    let plan = Scene::parse(&text, Path::new("."), &[])?.plan()?;
    let is_mean = |(probe, column): (&str, &str)| {
        plan.probes.iter().find(|known| known.name == probe).is_some_and(|probe| probe.is_mean(column))
    };
    let face = [("face", "entered_kg_per_m"), ("face", "momentum_x_Ns_per_m"), ("face", "water_kg_per_m")];
    assert_eq!(face.map(is_mean), [false, false, true]);
    let others =
        [("budget", "stored_J_per_m"), ("budget", "residual_J_per_m"), ("flow", "flow_m2ps"), ("flow", "volume_m2")];
    assert_eq!(others.map(is_mean), [false, false, true, false]);
    Ok(())
}

/// A driven wheel turns at 9 rad/s, a vane on its pivot at 12 rad/s, and rows are 0.5 s apart: 0.7 and 1 turn.
const WHEEL: &str = r#"
dimension = 2
dp = 0.05
until = 1.0
frames = "off"
[[water]]
fill = { box = { min = [0.0, 0.0], max = [0.5, 0.3] } }
[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [0.5, 0.6] } }
[[solid]]
name = "wheel"
shape = { ball = { radius = 0.2 } }
at = [3.0, 2.0]
driven = { hinge = [3.0, 2.0], angle = { formula = "9*t" } }
[[solid]]
name = "vane"
shape = { box = { size = [0.3, 0.3] } }
at = [6.0, 2.0]
free = { density = 500.0, spin = 12.0 }
[[joint]]
name = "pivot"
kind = "generic"
between = ["vane"]
at = [6.0, 2.0]
free = ["turn"]
[[probe]]
motion = "wheel"
every = 0.5
[[probe]]
joint = "pivot"
every = 0.5
"#;

#[test]
fn angles_count_all_turns_between_two_rows_and_after_a_restart() -> Result<()> {
    let home = TestFolder::with_scene("readings-turns", WHEEL);
    let options = |out: &str| RunOptions { out: Some(home.join(out)), threads: Some(1), ..RunOptions::default() };
    run::run(&home.join("scene.toml"), &options("whole"), &mut |_: &Progress| true)?;
    run::run(&home.join("scene.toml"), &options("broken"), &mut |now: &Progress| now.time < 0.8)?;
    run::resume(&home.join("broken"), &[], Some(1), &mut |_: &Progress| true)?;
    for (table, column, rate, share) in [("wheel", "pitch_deg", 9.0_f64, 1e-12), ("pivot", "turn_deg", 12.0, 1e-3)] {
        let texts = ["whole", "broken"].map(|run| {
            let path = home.join(format!("{run}/series/{table}.csv"));
            fs::read_to_string(path).unwrap()
        });
        assert_eq!(texts[0], texts[1], "{table}");
        let rows: Vec<Vec<&str>> = texts[0].lines().map(|line| line.split(',').collect()).collect();
        let i = rows[0].iter().position(|name| *name == column).unwrap();
        for row in &rows[1..] {
            let [t, angle] = [0, i].map(|i| row[i].parse::<f64>().unwrap());
            // The rotation of the wheel is exact; that of the rigid-body engine is 2e-4 slow in each turn.
            let exact = (rate * t).to_degrees();
            assert!((angle - exact).abs() <= share * exact.abs() + 1e-9, "{table}: {angle} at {t} s, not {exact}");
        }
    }
    Ok(())
}
