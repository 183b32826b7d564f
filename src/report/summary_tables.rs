//! Creates tables of statistics of series (extremes, means, waves) and of the energy budget.

use super::run_data::ProbeTable;
use crate::{
    analysis::{moments_of_readings, waves_of_readings},
    math::format::{self, four_digits},
    probe::relative_residual,
};

/// Returns the statistics of all columns of `tables`, with a header row and a row for each column. The table omits the
/// entries of a budget or balance that are 0 at all times.
pub(crate) fn summary_rows(tables: &[ProbeTable]) -> Vec<Vec<String>> {
    let head = ["series", "unit", "least", "at, s", "largest", "at, s", "mean", "std", "last", "waves", "period, s"];
    let mut rows =
        vec![head.into_iter().chain(["mean height", "highest third", "highest"]).map(String::from).collect::<Vec<_>>()];
    let digits = four_digits;
    let time = |t: f64| format!("{t:.3}");
    for table in tables {
        for (i, name) in table.columns.iter().enumerate() {
            if table.is_breakdown() && table.is_zero(i) {
                continue;
            }
            let Some(readings) = table.readings(i) else { continue };
            let f = moments_of_readings(&readings);
            let mut row = vec![format!("{} · {}", table.name, format::column_label(name)), format::unit(name).into()];
            row.extend([digits(f.min.0), time(f.min.1), digits(f.max.0), time(f.max.1)]);
            row.extend([digits(f.mean), digits(f.standard_deviation), digits(f.last)]);
            row.extend(waves_of_readings(&readings).map_or_else(
                || vec![String::new(); 5],
                |w| {
                    vec![
                        w.count.to_string(),
                        digits(w.mean_period),
                        digits(w.mean_height),
                        digits(w.significant_height),
                        digits(w.max_height),
                    ]
                },
            ));
            rows.push(row);
        }
    }
    rows
}

/// Returns the summary of an energy table: each energy at the start and the end with its extremes, and a sentence on
/// the result. Returns `None` for any other table.
pub(crate) fn energy_summary(table: &ProbeTable) -> Option<(Vec<Vec<String>>, String)> {
    if table.what != "energy" {
        return None;
    }
    let unit = format::unit(table.columns.first()?);
    let head = ["part", "start", "end", "change", "least", "largest"];
    let heads = head.iter().map(|h| if *h == "part" { h.to_string() } else { format!("{h}, {unit}") });
    let mut rows = vec![heads.collect::<Vec<String>>()];
    let digits = four_digits;
    let find = |part: &str| table.columns.iter().position(|name| format::column_label(name) == part);
    for (i, name) in table.columns.iter().enumerate() {
        let (first, f) = (*table.values[i].first()?, moments_of_readings(&table.readings(i)?));
        let cells = [first, f.last, f.last - first, f.min.0, f.max.0];
        rows.push(std::iter::once(format::column_label(name)).chain(cells.map(digits)).collect());
    }
    let total = &table.values[find("total")?];
    let change = total.last()? - total.first()?;
    let moving = find("water kinetic")
        .and_then(|i| table.readings(i))
        .map_or(0.0, |readings| moments_of_readings(&readings).max.0);
    let mut said =
        format!("The total {} by {} {unit}", if change < 0.0 { "falls" } else { "rises" }, digits(change.abs()));
    if moving > 0.0 {
        said += &format!(", {:.1} % of the most kinetic energy that the water had", 100.0 * change.abs() / moving);
    }
    said += ". It changes by the work of driven and fixed solids and by dissipation.";
    Some((rows, said))
}

/// Returns the summary of a budget table at the end: each entry with its share of the total turnover, and a sentence on
/// the closure error. Returns `None` for any other table.
pub(crate) fn budget_summary(table: &ProbeTable) -> Option<(Vec<Vec<String>>, String)> {
    if table.what != "energy budget" {
        return None;
    }
    let unit = format::unit(table.columns.first()?);
    let last = table.values.iter().map(|x| x.last().copied()).collect::<Option<Vec<f64>>>()?;
    let entries = last.get(1..last.len().checked_sub(1)?)?;
    let turned: f64 = entries.iter().map(|energy| energy.abs()).sum();
    let share = |energy: f64| if turned > 0.0 { 100.0 * energy / turned } else { 0.0 };
    let row = |(name, energy): (&String, &f64)| {
        vec![
            format::column_label(name),
            four_digits(*energy),
            format::with_minus_sign(&format!("{:.2}", share(*energy))),
        ]
    };
    let head = vec!["gained by".to_string(), format!("energy, {unit}"), "of all turned over, %".into()];
    let rows = std::iter::once(head).chain(table.columns.iter().zip(&last).map(row)).collect();
    let said = format!(
        "The entries add up to what water and bodies have stored, but for {} % of all that was turned over.",
        four_digits(100.0 * relative_residual(&last).unwrap_or_default())
    );
    Some((rows, said))
}
