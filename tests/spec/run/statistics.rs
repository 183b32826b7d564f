//! Statistics of the series of a run: from the keys of a scene to the rows of `statistics.csv`.

use std::{f64::consts::TAU, fs};

use pontoon::{
    Result,
    run::{self, Progress, RunOptions, Statistic, StatisticsFilter},
    scene::Scene,
};

use crate::common::TestFolder;

const SCENE: &str = r#"
dimension = 2
dp = 0.05
until = 0.01
frames = "off"
[[water]]
fill = { box = { min = [0.0, 0.0], max = [4.0, 0.4] } }
[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [4.0, 0.8] } }
[[solid]]
name = "buoy"
shape = { box = { size = [0.4, 0.4] } }
at = { x = 3.0, bottom = 0.2 }
free = { density = 500.0 }
[[probe]]
name = "row"
elevation = { from = 1.0, to = 1.5, spacing = 0.25 }
[[probe]]
name = "gauge"
elevation = { x = 1.0 }
[[probe]]
motion = "buoy"
[[statistic]]
reflection = ["row"]
period = 1.25
from = 2.0
[[statistic]]
rao = { motion = "buoy", wave = "gauge" }
period = 1.25
[[statistic]]
name = "late"
waves = "gauge"
from = 5.0
"#;

/// A finished run with the tables of waves 0.1 m high and a reflection coefficient of a quarter. `more` are further sections.
fn run_of_waves(name: &str, more: &str) -> Result<TestFolder> {
    let home = TestFolder::with_scene(&format!("statistics-{name}"), &format!("{SCENE}{more}"));
    let out = home.join("run");
    let options = RunOptions { out: Some(out.clone()), threads: Some(1), ..RunOptions::default() };
    run::run(&home.join("scene.toml"), &options, &mut |_: &Progress| true)?;
    assert!(
        fs::read_to_string(out.join("statistics.csv"))
            .unwrap()
            .starts_with("name,series,quantity,value,unit,from_s,until_s\n")
    );
    // ω² = g k tanh kd at T = 1.25 s and d = 0.4 m.
    let (omega, k) = (TAU / 1.25, 3.062_179_329_547_653);
    let eta = |x: f64, t: f64| 0.05 * (omega * t - k * x).cos() + 0.0125 * (omega * t + k * x + 0.4).cos();
    let mut tables = [
        ("row", "t_s,level_at_1_m,eta_at_1_m,level_at_1.25_m,eta_at_1.25_m,level_at_1.5_m,eta_at_1.5_m".to_string()),
        ("gauge", "t_s,level_m,eta_m".to_string()),
        ("buoy", "t_s,x_m,y_m,surge_m,heave_m,pitch_deg,vx_mps,vy_mps,spin_radps".to_string()),
    ];
    for i in 0..1000 {
        let t = 0.02 * f64::from(i);
        let at = |x: f64| format!("{:?},{:?}", 0.4 + eta(x, t), eta(x, t));
        let heave = 0.03 * (omega * t - k).cos();
        let rows = [
            format!("\n{t:?},{},{},{}", at(1.0), at(1.25), at(1.5)),
            format!("\n{t:?},{}", at(1.0)),
            format!("\n{t:?},0.0,0.0,{:?},{heave:?},{:?},0.0,0.0,0.0", -heave, 100.0 * heave),
        ];
        tables.iter_mut().zip(rows).for_each(|((_, text), row)| *text += &row);
    }
    for (name, text) in tables {
        fs::write(out.join(format!("series/{name}.csv")), text + "\n").unwrap();
    }
    Ok(home)
}

fn value(rows: &[Statistic], name: &str, series: &str, quantity: &str) -> f64 {
    let found = rows.iter().find(|row| row.name == name && row.series == series && row.quantity == quantity);
    found.unwrap_or_else(|| panic!("{name} {series} {quantity} is missing")).value
}

#[test]
fn the_statistics_of_a_run_contain_exact_heights_periods_reflection_and_raos() -> Result<()> {
    let home = run_of_waves("all", "")?;
    let statistics = run::statistics(&home.join("run"), &StatisticsFilter::default())?;
    assert_eq!(statistics.remarks, Vec::<String>::new());
    let of = |name: &str, series: &str, quantity: &str| value(&statistics.rows, name, series, quantity);
    // The separation of incident and reflected waves is exact.
    assert!((of("reflection", "row.eta_at_1_m", "reflection") - 0.25).abs() < 1e-6);
    assert!((of("reflection", "row.eta_at_1_m", "H_incident") - 0.1).abs() < 1e-7);
    // At x = 1 m the phase difference of the two waves is 2k + 0.4.
    let at_one =
        (0.05_f64.powi(2) + 0.0125_f64.powi(2) + 2.0 * 0.05 * 0.0125 * (2.0 * 3.062_179_329_547_653 + 0.4_f64).cos())
            .sqrt();
    assert!((of("rao", "buoy.heave_m", "rao") - 0.03 / at_one).abs() < 1e-9);
    assert!((of("rao", "buoy.pitch_deg", "rao") - 3.0 / at_one).abs() < 1e-7);
    let late = statistics.rows.iter().find(|row| row.name == "late").map(|row| (row.from_s, row.until_s));
    assert_eq!(late, Some((5.0, 19.98)));
    // Samples at 0.02 s miss a crest by 0.01 s at most: 1 − cos(0.05) of the height.
    assert!((of("late", "gauge.eta_m", "H_max") / (2.0 * at_one) - 1.0).abs() < 2e-3);
    assert!((of("", "gauge.eta_m", "T_z") - 1.25).abs() < 1e-3);
    assert!((of("", "buoy.heave_m", "std") - 0.03 / 2.0_f64.sqrt()).abs() < 1e-4);
    Ok(())
}

#[test]
fn statistics_of_a_selected_series_and_time_are_computed_and_an_unknown_series_is_refused() -> Result<()> {
    let home = run_of_waves("part", "")?;
    let ask = |series: &str| StatisticsFilter { series: Some(series.into()), from: Some(3.0), until: Some(9.0) };
    let statistics = run::statistics(&home.join("run"), &ask("buoy"))?;
    assert!(
        statistics.rows.iter().all(|row| row.series.starts_with("buoy.") && row.from_s >= 3.0 && row.until_s <= 9.0)
    );
    assert!(
        statistics.rows.iter().any(|row| row.quantity == "rao"),
        "statistics of the scene for this series are included"
    );
    let refused = run::statistics(&home.join("run"), &ask("booy")).err().and_then(|e| e.help);
    assert_eq!(refused.as_deref(), Some("the probes are: row, gauge, buoy"));
    Ok(())
}

/// Gauges in the reverse order measure the inverse of the reflection, 4. A harmonic needs its period: 0.5 s of 1.25 s tell nothing.
#[test]
fn gauges_in_the_wrong_order_and_spans_below_a_period_are_remarked() -> Result<()> {
    let gauge = "[[probe]]\nname = \"far\"\nelevation = { x = 1.25 }\n";
    let late = "period = 1.25\nfrom = 6.0\n";
    let home = run_of_waves(
        "order",
        &format!(
            "{gauge}[[statistic]]\nname = \"back\"\nreflection = [\"far\", \"gauge\"]\n{late}\
             [[statistic]]\nname = \"short\"\nreflection = [\"row\"]\n{late}until = 6.5\n\
             [[statistic]]\nname = \"part\"\nrao = {{ motion = \"buoy\", wave = \"gauge\" }}\n{late}until = 6.5\n"
        ),
    )?;
    let (series, row) = (home.join("run/series"), 4);
    let all = fs::read_to_string(series.join("row.csv")).unwrap();
    let far = all.lines().skip(1).map(|line| line.split(',').collect::<Vec<_>>());
    let far: String = far.map(|x| format!("{},{},{}\n", x[0], x[row - 1], x[row])).collect();
    fs::write(series.join("far.csv"), format!("t_s,level_m,eta_m\n{far}")).unwrap();
    let statistics = run::statistics(&home.join("run"), &StatisticsFilter::default())?;
    assert!((value(&statistics.rows, "back", "far.eta_m", "reflection") - 4.0).abs() < 1e-4);
    let remark = |words: &str| statistics.remarks.iter().any(|remark| remark.contains(words));
    assert!(remark("back: the reflected waves are 4 times as high"), "{:?}", statistics.remarks);
    for short in ["short", "part"] {
        assert!(statistics.rows.iter().all(|row| row.name != short), "{short}");
        assert!(remark(&format!("{short}: its readings span 0.5 s")), "{:?}", statistics.remarks);
    }
    Ok(())
}

#[test]
fn invalid_statistics_are_refused_with_the_reason() {
    for (keys, expected) in [
        ("reflection = [\"gauge\"]", "1 gauge cannot tell"),
        ("reflection = [\"buoy\", \"gauge\"]", "one of these is none"),
        ("rao = { motion = \"booy\", wave = \"gauge\" }", "did you mean \"buoy\"?"),
        ("rao = { motion = \"buoy\", wave = \"row\" }", "more than one series"),
        ("waves = \"gauge\"\nperiod = 1.0", "waves needs no period"),
        ("waves = \"gauge\"\nreflection = [\"row\"]", "a statistic is of one kind"),
        ("waves = \"gauge\"\nfrom = 2.0\nuntil = 1.0", "nothing lies between"),
    ] {
        let text = format!("{SCENE}\n[[statistic]]\n{keys}\n");
        let message =
            Scene::parse(&text, ".".as_ref(), &[]).and_then(|scene| scene.plan()).err().map(|e| e.to_string());
        assert!(message.as_ref().is_some_and(|message| message.contains(expected)), "{keys}: {message:?}");
    }
}
