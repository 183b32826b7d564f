//! Numbers in sentences: three digits to read, two to write into a scene, rounded to the side that helps.

/// `x` to three digits, without trailing zeros.
pub fn three_digits(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 {
        return "0".into();
    }
    if !x.is_finite() {
        return format!("{x}");
    }
    if !(1e-4..1e6).contains(&size) {
        return format!("{x:.2e}");
    }
    let places = (2.0 - size.log10().floor()).max(0.0) as usize;
    let text = format!("{x:.places$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

/// A place (m) as a scene writes it: `[0.42, 0.1]`.
pub(crate) fn place<'a>(x: impl IntoIterator<Item = &'a f64>) -> String {
    let numbers: Vec<String> = x.into_iter().map(|x| three_digits(1e-6 * (x * 1e6).round())).collect();
    format!("[{}]", numbers.join(", "))
}

/// The largest number of two digits that is not above `x` > 0.
pub(crate) fn two_digits_down(x: f64) -> String {
    two_digits(x, f64::floor)
}

/// The smallest number of two digits that is not below `x` > 0.
pub(crate) fn two_digits_up(x: f64) -> String {
    two_digits(x, f64::ceil)
}

fn two_digits(x: f64, round: fn(f64) -> f64) -> String {
    let places = 1 - x.log10().floor() as i32;
    let unit = 10f64.powi(-places);
    // A number of two digits may lie a last bit beside itself.
    let near = (x / unit).round();
    let whole = if (x / unit - near).abs() < 1e-9 * near { near } else { round(x / unit) };
    let text = format!("{:.*}", places.max(0) as usize, whole * unit);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

#[cfg(test)]
#[path = "../../tests/unit/preflight/rounding.rs"]
mod tests;
