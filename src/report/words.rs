//! Words of HTML, and units by the names of columns. For all pages of the program.

/// `text` with the signs that HTML means otherwise written out.
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// A table; the first row is its head.
pub fn table(rows: &[Vec<String>]) -> String {
    let row = |cells: &Vec<String>, tag: &str| {
        let cells = cells.iter().map(|cell| {
            let class = if cell == "MISSED" || cell == "failed" { " class=\"missed\"" } else { "" };
            format!("<{tag}{class}>{}</{tag}>", escape(cell))
        });
        format!("<tr>{}</tr>\n", cells.collect::<String>())
    };
    let mut rows = rows.iter();
    let head = rows.next().map(|cells| row(cells, "th")).unwrap_or_default();
    format!("<table>\n{head}{}</table>\n", rows.map(|cells| row(cells, "td")).collect::<String>())
}

/// Ends of the names of columns, and the units that they mean.
const UNITS: [(&str, &str); 15] = [
    ("_Nm_per_m", "N m/m"),
    ("_N_per_m", "N/m"),
    ("_J_per_m", "J/m"),
    ("_radps", "rad/s"),
    ("_mps", "m/s"),
    ("_deg", "°"),
    ("_rad", "rad"),
    ("_kg", "kg"),
    ("_Pa", "Pa"),
    ("_Nm", "N m"),
    ("_N", "N"),
    ("_J", "J"),
    ("_m3", "m³"),
    ("_m", "m"),
    ("_s", "s"),
];

/// The unit of a column by the end of its name, as in `fx_N_per_m`; what follows a comma is no part of it.
pub fn unit(column: &str) -> &'static str {
    let column = column.split(',').next().unwrap_or(column);
    UNITS.iter().find(|(end, _)| column.ends_with(end)).map_or("–", |(_, unit)| unit)
}

/// The name of a column without its unit, in words: `water_kinetic_J` is "water kinetic".
pub fn bare(column: &str) -> String {
    let end = UNITS.iter().find(|(end, _)| column.ends_with(end)).map_or("", |(end, _)| end);
    column[..column.len() - end.len()].replace('_', " ")
}

/// A number with four digits that count.
pub fn digits(x: f64) -> String {
    match x.abs() {
        _ if !x.is_finite() => "–".into(),
        0.0 => "0".into(),
        size if (1e-3..1e5).contains(&size) => {
            let places = (3 - size.log10().floor() as i32).clamp(0, 6) as usize;
            minus(&format!("{x:.places$}"))
        }
        _ => minus(&format!("{x:.3e}")),
    }
}

/// A number as it is set in print: with a minus, not a hyphen.
pub fn minus(number: &str) -> String {
    number.replace('-', "−")
}

/// A number of bytes as a user says it.
pub fn bytes(count: u64) -> String {
    match count as f64 {
        n if n >= 1e9 => format!("{:.1} GB", n / 1e9),
        n if n >= 1e6 => format!("{:.1} MB", n / 1e6),
        n if n >= 1e3 => format!("{:.0} kB", n / 1e3),
        n => format!("{n:.0} B"),
    }
}

/// A wall time (s) as a user says it.
pub fn duration(seconds: f64) -> String {
    let whole = seconds.round() as u64;
    match whole {
        0..=59 => format!("{seconds:.1} s"),
        60..=3599 => format!("{} min {:02} s", whole / 60, whole % 60),
        _ => format!("{} h {:02} min", whole / 3600, whole % 3600 / 60),
    }
}

/// A whole number with thin spaces between its thousands.
pub fn thousands(n: u64) -> String {
    let digits = n.to_string();
    let groups: Vec<&str> = digits.as_bytes().rchunks(3).rev().filter_map(|g| std::str::from_utf8(g).ok()).collect();
    groups.join("\u{202f}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_tell_their_units_and_their_names() {
        assert_eq!(["fx_N_per_m", "fx_N", "heave_m, 0 at 2 s", "vx_mps", "x"].map(unit), ["N/m", "N", "m", "m/s", "–"]);
        assert_eq!(["fx_N_per_m", "water_kinetic_J", "x"].map(bare), ["fx", "water kinetic", "x"]);
    }

    #[test]
    fn numbers_are_said_as_in_print() {
        assert_eq!(
            [digits(-0.0123449), digits(1234.4), digits(0.0), digits(1e-7)],
            ["−0.01234", "1234", "0", "1.000e−7"]
        );
        assert_eq!([thousands(999), thousands(1234567)], ["999", "1\u{202f}234\u{202f}567"]);
        assert_eq!([bytes(12), bytes(1_500_000)], ["12 B", "1.5 MB"]);
        assert_eq!([duration(3.21), duration(125.0), duration(7260.0)], ["3.2 s", "2 min 05 s", "2 h 01 min"]);
    }
}
