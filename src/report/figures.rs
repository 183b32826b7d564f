//! Figures of series: extremes, means, and waves between one crossing of the mean upwards and the next.

use super::{kept::Table, words};

/// Figures of a column.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Figures {
    /// Least value and its time, s.
    pub least: (f64, f64),
    /// Largest value and its time, s.
    pub largest: (f64, f64),
    /// Mean over time.
    pub mean: f64,
    /// Standard deviation over time.
    pub deviation: f64,
    /// Last value.
    pub last: f64,
    /// Its waves, if there are two or more.
    pub waves: Option<Waves>,
}

/// Waves of a column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Waves {
    /// How many.
    pub count: usize,
    /// Mean time from one to the next, s.
    pub period: f64,
    /// Mean distance from the least to the largest value of a wave.
    pub height: f64,
    /// That of the largest.
    pub largest: f64,
}

/// The figures of `x` over `t` (s); none if it has less than two numbers.
///
/// Means are by the trapezoid over the samples.
pub fn figures(t: &[f64], x: &[f64]) -> Option<Figures> {
    let known: Vec<(f64, f64)> = t.iter().copied().zip(x.iter().copied()).filter(|(_, x)| x.is_finite()).collect();
    let (first, last) = (known.first()?, known.last()?);
    if last.0 <= first.0 {
        return None;
    }
    let integral = |f: &dyn Fn(f64) -> f64| {
        let parts = known.windows(2).map(|w| 0.5 * (f(w[0].1) + f(w[1].1)) * (w[1].0 - w[0].0));
        parts.sum::<f64>() / (last.0 - first.0)
    };
    let mean = integral(&|x| x);
    let deviation = integral(&|x| (x - mean).powi(2)).sqrt();
    let least = known.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
    let largest = known.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(Figures {
        least: (least.1, least.0),
        largest: (largest.1, largest.0),
        mean,
        deviation,
        last: last.1,
        waves: waves(&known, mean, deviation),
    })
}

/// Waves about `mean`. One counts only if it goes down below the mean and up above it by a third of the standard
/// `deviation`: what trembles about the mean is none.
fn waves(known: &[(f64, f64)], mean: f64, deviation: f64) -> Option<Waves> {
    let band = deviation / 3.0;
    let (mut below, mut crossing, mut ups) = (false, None, Vec::new());
    for (i, w) in known.windows(2).enumerate() {
        let (a, b) = (w[0].1 - mean, w[1].1 - mean);
        below |= a < -band;
        if a < 0.0 && b >= 0.0 {
            crossing = Some((w[0].0 + (w[1].0 - w[0].0) * a / (a - b), i + 1));
        }
        if below && b > band {
            ups.extend(crossing.take());
            below = false;
        }
    }
    let heights: Vec<f64> = ups
        .windows(2)
        .map(|w| {
            let wave = known[w[0].1..w[1].1].iter().map(|(_, x)| *x);
            wave.clone().fold(f64::NEG_INFINITY, f64::max) - wave.fold(f64::INFINITY, f64::min)
        })
        .collect();
    let count = heights.len();
    (count >= 2).then(|| Waves {
        count,
        period: (ups[count].0 - ups[0].0) / count as f64,
        height: heights.iter().sum::<f64>() / count as f64,
        largest: heights.iter().copied().fold(0.0, f64::max),
    })
}

/// The figures of all columns of `tables`, a row for each; the first row is the head.
pub fn rows(tables: &[Table]) -> Vec<Vec<String>> {
    let head = ["series", "unit", "least", "at, s", "largest", "at, s", "mean", "std", "last", "waves", "period, s"];
    let mut rows = vec![head.into_iter().chain(["mean height", "largest"]).map(String::from).collect::<Vec<_>>()];
    let digits = words::digits;
    let time = |t: f64| format!("{t:.3}");
    for table in tables {
        for (name, x) in table.columns.iter().zip(&table.x) {
            let Some(f) = figures(&table.t, x) else { continue };
            let mut row = vec![format!("{} · {}", table.name, words::bare(name)), words::unit(name).into()];
            row.extend([digits(f.least.0), time(f.least.1), digits(f.largest.0), time(f.largest.1)]);
            row.extend([digits(f.mean), digits(f.deviation), digits(f.last)]);
            row.extend(f.waves.map_or_else(
                || vec![String::new(); 4],
                |w| vec![w.count.to_string(), digits(w.period), digits(w.height), digits(w.largest)],
            ));
            rows.push(row);
        }
    }
    rows
}

/// The budget of an energy table: what each part was at the start and the end, and its extremes; and what it comes to
/// in words. None of any other table.
pub fn energy(table: &Table) -> Option<(Vec<Vec<String>>, String)> {
    if table.what != "energy" {
        return None;
    }
    let unit = words::unit(table.columns.first()?);
    let head = ["part", "start", "end", "change", "least", "largest"];
    let heads = head.iter().map(|h| if *h == "part" { h.to_string() } else { format!("{h}, {unit}") });
    let mut rows = vec![heads.collect::<Vec<String>>()];
    let digits = words::digits;
    let find = |part: &str| table.columns.iter().position(|name| words::bare(name) == part);
    for (name, x) in table.columns.iter().zip(&table.x) {
        let (first, f) = (*x.first()?, figures(&table.t, x)?);
        let cells = [first, f.last, f.last - first, f.least.0, f.largest.0];
        rows.push(std::iter::once(words::bare(name)).chain(cells.map(digits)).collect());
    }
    let total = &table.x[find("total")?];
    let change = total.last()? - total.first()?;
    let moving = find("water kinetic").and_then(|i| figures(&table.t, &table.x[i])).map_or(0.0, |f| f.largest.0);
    let mut said =
        format!("The total {} by {} {unit}", if change < 0.0 { "falls" } else { "rises" }, digits(change.abs()));
    if moving > 0.0 {
        said += &format!(", {:.1} % of the most kinetic energy that the water had", 100.0 * change.abs() / moving);
    }
    said += ". It changes by the work of driven and fixed solids and by dissipation.";
    Some((rows, said))
}

/// What a budget table comes to at the end: each entry, and its share of all that was turned over; and how well it closes, in
/// words. None of any other table.
pub fn budget(table: &Table) -> Option<(Vec<Vec<String>>, String)> {
    if table.what != "energy budget" {
        return None;
    }
    let unit = words::unit(table.columns.first()?);
    let last = table.x.iter().map(|x| x.last().copied()).collect::<Option<Vec<f64>>>()?;
    let (residual, entries) = last.split_last().and_then(|(residual, rest)| Some((residual, rest.get(1..)?)))?;
    let turned: f64 = entries.iter().map(|energy| energy.abs()).sum();
    let share = |energy: f64| if turned > 0.0 { 100.0 * energy / turned } else { 0.0 };
    let row = |(name, energy): (&String, &f64)| {
        vec![words::bare(name), words::digits(*energy), words::minus(&format!("{:.2}", share(*energy)))]
    };
    let head = vec!["gained by".to_string(), format!("energy, {unit}"), "of all turned over, %".into()];
    let rows = std::iter::once(head).chain(table.columns.iter().zip(&last).map(row)).collect();
    let said = format!(
        "All entries but {:.2} % of what was turned over add up to what water and bodies have stored.",
        share(residual.abs())
    );
    Some((rows, said))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sine_has_its_period_and_twice_its_amplitude() {
        let t: Vec<f64> = (0..=1000).map(|i| f64::from(i) * 0.01).collect();
        let x: Vec<f64> = t.iter().map(|t| 0.5 + 0.1 * (std::f64::consts::TAU * t / 1.25).sin()).collect();
        let found = figures(&t, &x).and_then(|f| f.waves);
        let waves = found.unwrap_or(Waves { count: 0, period: 0.0, height: 0.0, largest: 0.0 });
        // The crossings are linear between samples 0.01 s apart, the crests up to half of that off.
        assert_eq!(waves.count, 6, "8 periods: the first begins with the record, the last does not come up again");
        assert!((waves.period - 1.25).abs() < 1e-4 && (waves.height - 0.2).abs() < 1e-4, "{waves:?}");
    }

    #[test]
    fn a_series_that_trembles_has_no_waves_and_gaps_do_not_count() {
        let t: Vec<f64> = (0..100).map(f64::from).collect();
        let mut x: Vec<f64> = t.iter().map(|t| t + 0.1 * (t * 2.0).sin()).collect();
        x[50] = f64::NAN;
        let found = figures(&t, &x).unwrap_or_default();
        assert!(found.waves.is_none() && found.largest.1 == 99.0, "{found:?}");
        assert_eq!(figures(&[0.0, 1.0], &[f64::NAN, 1.0]), None);
    }
}
