//! Numbers as text, and the units and labels of columns. For pages, tables, messages and terminals alike.

use std::ops::Range;

/// Ends of the names of columns, and the units that they mean.
const UNITS: [(&str, &str); 24] = [
    ("_Nm_per_m", "N m/m"),
    ("_Ns_per_m", "N s/m"),
    ("_N_per_m", "N/m"),
    ("_J_per_m", "J/m"),
    ("_W_per_m", "W/m"),
    ("_kg_per_m", "kg/m"),
    ("_m3ps", "m³/s"),
    ("_m2ps", "m²/s"),
    ("_radps", "rad/s"),
    ("_mps2", "m/s²"),
    ("_mps", "m/s"),
    ("_deg", "°"),
    ("_rad", "rad"),
    ("_kg", "kg"),
    ("_Pa", "Pa"),
    ("_Nm", "N m"),
    ("_Ns", "N s"),
    ("_N", "N"),
    ("_J", "J"),
    ("_W", "W"),
    ("_m3", "m³"),
    ("_m2", "m²"),
    ("_m", "m"),
    ("_s", "s"),
];

/// The unit of a column by the end of its name, as in `fx_N_per_m`; what follows a comma or a space is no part of it.
pub fn unit(column: &str) -> &'static str {
    let column = column.split([',', ' ']).next().unwrap_or(column);
    UNITS.iter().find(|(end, _)| column.ends_with(end)).map_or("–", |(_, unit)| unit)
}

/// The name of a column without its unit, in words: `water_kinetic_J` is "water kinetic", `vx_at_1_0.2_mps` of a row of
/// gauges "vx at 1, 0.2 m".
pub fn column_label(column: &str) -> String {
    let end = UNITS.iter().find(|(end, _)| column.ends_with(end)).map_or("", |(end, _)| end);
    let name = &column[..column.len() - end.len()];
    match name.split_once("_at_") {
        Some((what, place)) => format!("{} at {} m", what.replace('_', " "), place.replace('_', ", ")),
        None => name.replace('_', " "),
    }
}

/// `x` to `digits` significant digits: with at most nine decimals if its size is in `range`, else with an exponent.
pub fn significant_digits(x: f64, digits: usize, range: Range<f64>) -> String {
    match x.abs() {
        0.0 => "0".into(),
        size if range.contains(&size) => {
            let places = digits as i32 - 1 - size.log10().floor() as i32;
            format!("{x:.*}", places.clamp(0, 9) as usize)
        }
        _ => format!("{x:.*e}", digits - 1),
    }
}

/// `x` to three digits, without trailing zeros.
pub fn three_digits(x: f64) -> String {
    without_trailing_zeros(significant_digits(x, 3, 1e-4..1e6))
}

/// `x` to four digits as in print; a dash if it is not finite.
pub fn four_digits(x: f64) -> String {
    if x.is_finite() { with_minus_sign(&significant_digits(x, 4, 1e-3..1e5)) } else { "–".into() }
}

/// The largest number of two digits that is not above `x` > 0.
pub fn two_digits_down(x: f64) -> String {
    rounded(x, 2, f64::floor)
}

/// The largest number of three digits that is not above `x` > 0.
pub fn three_digits_down(x: f64) -> String {
    rounded(x, 3, f64::floor)
}

/// The smallest number of two digits that is not below `x` > 0.
pub fn two_digits_up(x: f64) -> String {
    rounded(x, 2, f64::ceil)
}

fn rounded(x: f64, digits: i32, round: fn(f64) -> f64) -> String {
    let places = digits - 1 - x.log10().floor() as i32;
    let unit = 10f64.powi(-places);
    // For a number of two digits, `x / unit` may differ from a whole number by round-off.
    let near = (x / unit).round();
    let whole = if (x / unit - near).abs() < 1e-9 * near { near } else { round(x / unit) };
    without_trailing_zeros(format!("{:.*}", places.max(0) as usize, whole * unit))
}

/// `x` rounded to `places` decimals, without trailing zeros.
pub fn decimals(x: f64, places: i32) -> String {
    let unit = 10f64.powi(places);
    // The sum turns −0 into 0.
    format!("{}", (x * unit).round() / unit + 0.0)
}

/// Coordinates (m) as a scene writes them: `[0.42, 0.1]`.
pub fn coordinates<'a>(x: impl IntoIterator<Item = &'a f64>) -> String {
    let numbers: Vec<String> = x.into_iter().map(|x| three_digits(1e-6 * (x * 1e6).round())).collect();
    format!("[{}]", numbers.join(", "))
}

/// `n` with a metric prefix: 1.23 M.
pub fn metric_prefix(n: f64) -> String {
    match n {
        n if n >= 1e9 => format!("{:.2} G", n / 1e9),
        n if n >= 1e6 => format!("{:.2} M", n / 1e6),
        n if n >= 1e4 => format!("{:.1} k", n / 1e3),
        n if n >= 100.0 => format!("{n:.0}"),
        n => format!("{n:.2}"),
    }
}

/// A whole number with thin spaces between its thousands.
pub fn thousands(n: u64) -> String {
    let digits = n.to_string();
    let groups: Vec<&str> = digits.as_bytes().rchunks(3).rev().filter_map(|g| std::str::from_utf8(g).ok()).collect();
    groups.join("\u{202f}")
}

/// A number as in print: with a minus, not a hyphen.
pub fn with_minus_sign(number: &str) -> String {
    number.replace('-', "−")
}

/// The text of a number without the zeros at the end of its decimals.
fn without_trailing_zeros(text: String) -> String {
    match text.contains('.') && !text.contains('e') {
        true => text.trim_end_matches('0').trim_end_matches('.').into(),
        false => text,
    }
}

/// A number of bytes, in kB, MB or GB.
pub fn bytes(count: f64) -> String {
    match count {
        n if n >= 1e9 => format!("{:.1} GB", n / 1e9),
        n if n >= 1e6 => format!("{:.1} MB", n / 1e6),
        n if n >= 1e3 => format!("{:.0} kB", n / 1e3),
        // The sum of no numbers is -0.
        n => format!("{:.0} B", n + 0.0),
    }
}

/// A wall time (s), in minutes and hours where it is long.
pub fn duration(seconds: f64) -> String {
    let whole = seconds.round() as u64;
    match whole {
        0..=59 => format!("{seconds:.1} s"),
        60..=3599 => format!("{} min {:02} s", whole / 60, whole % 60),
        _ => format!("{} h {:02} min", whole / 3600, whole % 3600 / 60),
    }
}

/// `text` with control characters other than line ends as escapes, so that a terminal does not obey them.
pub fn without_control(text: &str) -> String {
    let escape = |c: char| match c.is_control() && c != '\n' {
        true => c.escape_default().to_string(),
        false => c.to_string(),
    };
    text.chars().map(escape).collect()
}

#[cfg(test)]
#[path = "../../tests/unit/math/format.rs"]
mod tests;
