//! Words of HTML, and numbers as they are set in print. For all pages of the program.

pub(crate) use crate::math::format::{bytes, column_label, duration, unit};

/// `text` with the signs that HTML means otherwise written out.
pub(crate) fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// A table; the first row is its head.
pub(crate) fn table(rows: &[Vec<String>]) -> String {
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

/// A number with four digits that count.
pub(crate) fn four_digits(x: f64) -> String {
    match x.abs() {
        _ if !x.is_finite() => "–".into(),
        0.0 => "0".into(),
        size if (1e-3..1e5).contains(&size) => {
            let places = (3 - size.log10().floor() as i32).clamp(0, 6) as usize;
            with_minus_sign(&format!("{x:.places$}"))
        }
        _ => with_minus_sign(&format!("{x:.3e}")),
    }
}

/// A number as it is set in print: with a minus, not a hyphen.
pub(crate) fn with_minus_sign(number: &str) -> String {
    number.replace('-', "−")
}

/// A whole number with thin spaces between its thousands.
pub(crate) fn thousands(n: u64) -> String {
    let digits = n.to_string();
    let groups: Vec<&str> = digits.as_bytes().rchunks(3).rev().filter_map(|g| std::str::from_utf8(g).ok()).collect();
    groups.join("\u{202f}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_said_as_in_print() {
        assert_eq!(
            [four_digits(-0.0123449), four_digits(1234.4), four_digits(0.0), four_digits(1e-7)],
            ["−0.01234", "1234", "0", "1.000e−7"]
        );
        assert_eq!([thousands(999), thousands(1234567)], ["999", "1\u{202f}234\u{202f}567"]);
    }
}
