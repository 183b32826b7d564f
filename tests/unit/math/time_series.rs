//! Unit tests of `src/math/time_series.rs`.

use std::{f64::consts::TAU, path::Path};

use super::*;
use crate::math::table::TableReader;

/// Points of each interval at which a curve is examined.
const POINTS: usize = 64;

fn series<const N: usize>(samples: [(f64, f64); N]) -> TimeSeries {
    let (t, x): (Vec<f64>, Vec<f64>) = samples.into_iter().unzip();
    TimeSeries::new(t, x).unwrap()
}

/// Calls `f` with the number of the interval and a time in it.
fn visit(series: &TimeSeries, mut f: impl FnMut(usize, f64)) {
    for i in 0..series.t.len() - 1 {
        let step = series.t[i + 1] - series.t[i];
        (0..=POINTS).for_each(|k| f(i, series.t[i] + step * k as f64 / POINTS as f64));
    }
}

/// The largest distance of the curve from the range between the two samples of its interval.
fn overshoot(series: &TimeSeries) -> f64 {
    let mut most: f64 = 0.0;
    visit(series, |i, t| {
        let (a, b) = (series.x[i], series.x[i + 1]);
        let x = series.value_and_rate(t).0;
        most = most.max(x - a.max(b)).max(a.min(b) - x);
    });
    most
}

/// The curve of the parabolas, without limits.
fn parabolas(series: &TimeSeries, t: f64) -> f64 {
    let (i, s) = series.locate(t);
    let slope = |i: usize| match i {
        0 => 0.0,
        i if i + 1 == series.t.len() => 0.0,
        i => {
            let ((h0, d0), (h1, d1)) = (series.interval(i - 1), series.interval(i));
            (h1 * d0 + h0 * d1) / (h0 + h1)
        }
    };
    let step = series.t[i + 1] - series.t[i];
    let (x0, x1, m0, m1) = (series.x[i], series.x[i + 1], slope(i) * step, slope(i + 1) * step);
    x0 + s * (m0 + s * (3.0 * (x1 - x0) - 2.0 * m0 - m1 + s * (2.0 * (x0 - x1) + m0 + m1)))
}

#[test]
fn the_curve_of_a_record_that_is_not_dense_stays_between_its_samples() {
    let records = [
        // A gate, a step, a gust: round-off is the only overshoot.
        series([(0.0, 0.0), (0.1, 0.0), (0.3, 0.5), (10.0, 0.5)]),
        series([(0.0, 0.0), (0.5, 0.0), (0.51, 0.02), (3.0, 0.02)]),
        series([(0.0, 0.0), (1.0, 0.0), (1.1, 10.0), (1.5, 0.0), (20.0, 0.0)]),
        series([(0.0, 0.0), (1.0, 0.0), (1.1, 10.0), (1.2, 10.0), (20.0, 9.9)]),
        series([(0.0, 0.0), (1.0, 0.0), (2.0, 0.3), (3.0, 10.0), (3.1, 10.1)]),
        series([(0.0, 0.0), (1.0, 1.0), (2.0, 1.0), (3.0, 0.0), (4.0, 0.0), (5.0, 1.0)]),
        series([(0.0, 5.0), (0.001, -5.0), (100.0, -4.0), (100.001, 3.0), (101.0, -2.0)]),
        series([(0.0, 1.0), (1.0, 2.0)]),
    ];
    for record in records {
        assert!(overshoot(&record) <= 1e-12 * record.range, "{record:?}: {}", overshoot(&record));
        let other = record.scaled(&SampleScaling { scale: -3.0, time_factor: 0.5, offset: 7.0 }).unwrap();
        assert!(overshoot(&other) <= 1e-12 * other.range, "{other:?}");
    }
}

#[test]
fn a_dense_ramp_leaves_the_values_that_it_holds_by_less_than_a_thousandth() {
    for count in [10, 20, 40, 100] {
        let ramp = |i: usize| (i.clamp(20, 20 + count) - 20) as f64 / count as f64;
        let t: Vec<f64> = (0..60 + count).map(|i| 0.01 * i as f64).collect();
        let record = TimeSeries::new(t, (0..60 + count).map(ramp).collect::<Vec<f64>>()).unwrap();
        assert!(overshoot(&record) <= 1.001 * HOLD_OVERSHOOT, "{count} samples: {}", overshoot(&record));
    }
}

#[test]
fn no_record_leaves_its_samples_by_more_than_a_hundredth_of_its_range() {
    // A generator of Lehmer (1951): walks of small and large steps at uneven times.
    let mut state: u64 = 1;
    let mut random = || {
        state = state * 48_271 % 2_147_483_647;
        state as f64 / 2_147_483_647.0
    };
    for _ in 0..300 {
        let (mut t, mut x, mut v, rough) = (vec![0.0], vec![0.0], 0.0, random());
        for i in 0..40 {
            v += (random() - 0.5) * rough;
            t.push(t[i] + 0.01 + random().powi(8));
            x.push(if random() < 0.2 { x[i] } else { x[i] + v });
        }
        let record = TimeSeries::new(t, x).unwrap();
        // Both ends of an interval: 2 · 4/27 · 1/32.
        assert!(overshoot(&record) <= 0.0093 * record.range, "{record:?}: {}", overshoot(&record) / record.range);
    }
}

#[test]
fn value_and_rate_are_continuous_and_the_rate_is_the_derivative() {
    let record = series([(0.0, 0.0), (0.1, 0.0), (0.3, 0.5), (0.5, 0.9), (0.6, 0.2), (10.0, 0.5)]);
    let near = 1e-9;
    for &t in &record.t[..] {
        let ((x0, v0), (x1, v1)) = (record.value_and_rate(t - near), record.value_and_rate(t + near));
        // The rate changes by the second derivative times 2e-9 s: about 1e-6 m/s here.
        assert!((x0 - x1).abs() < 1e-7 && (v0 - v1).abs() < 1e-5, "at {t} s: {x0} {x1}, {v0} {v1}");
    }
    let h = 1e-5;
    visit(&record, |_, t| {
        let t = t + 1.1 * h;
        let slope = (record.value_and_rate(t + h).0 - record.value_and_rate(t - h).0) / (2.0 * h);
        assert!((slope - record.value_and_rate(t).1).abs() < 1e-2, "at {t} s");
    });
}

#[test]
fn a_record_begins_and_ends_at_rest_and_holds_its_end_values() {
    let record = series([(1.0, 2.0), (1.5, 2.7), (2.0, 4.0)]);
    for (t, x) in [(0.0, 2.0), (1.0, 2.0), (2.0, 4.0), (9.0, 4.0)] {
        assert_eq!(record.value_and_rate(t), (x, 0.0), "at {t} s");
    }
    let near = 1e-7;
    assert!(record.value_and_rate(1.0 + near).1.abs() < 1e-5 && record.value_and_rate(2.0 - near).1.abs() < 1e-5);
}

#[test]
fn a_sine_of_20_samples_a_period_keeps_the_accuracy_of_its_parabolas() {
    for phase in 0..20 {
        let shift = TAU / 400.0 * f64::from(phase);
        let t: Vec<f64> = (0..=100).map(|i| TAU / 20.0 * f64::from(i)).collect();
        let x: Vec<f64> = t.iter().map(|t| (t + shift).sin()).collect();
        let record = TimeSeries::new(t, x).unwrap();
        // The tangent of the parabola is sin(h)/h, 1.6 % too small, which gives 5e-4 at h/4 from a crest.
        let mut most: f64 = 0.0;
        visit(&record, |i, t| {
            if (2..98).contains(&i) {
                most = most.max((record.value_and_rate(t).0 - (t + shift).sin()).abs());
            }
        });
        assert!(most < 6e-4, "{most} at a shift of {shift}");
    }
}

#[test]
fn the_records_of_the_flume_and_the_piston_change_by_less_than_a_thousandth_of_their_range() -> Result<()> {
    let records = [("flume-box/flap.csv", "angle_deg"), ("ciem-piston/flume.csv", "x_piston_m")];
    for (file, column) in records {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(file);
        let record = TableReader::open(&path)?.series("t_s", column)?;
        let mut most: f64 = 0.0;
        visit(&record, |_, t| most = most.max((record.value_and_rate(t).0 - parabolas(&record, t)).abs()));
        assert!(most < 1e-3 * record.range, "{file}: {most} of {}", record.range);
    }
    Ok(())
}
