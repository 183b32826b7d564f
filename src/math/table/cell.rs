//! Numbers in the cells of text tables.

use crate::error::Error;

/// The decimal sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Decimal {
    Point,
    Comma,
}

/// Texts of a value that is missing, in lower case.
const MISSING: [&str; 13] =
    ["", "nan", "-nan", "+nan", "nan(ind)", "-nan(ind)", "1.#qnan", "na", "n/a", "#n/a", "null", "-", "--"];

/// Returns whether a cell has no value.
pub(super) fn is_missing(cell: &str) -> bool {
    MISSING.iter().any(|missing| cell.eq_ignore_ascii_case(missing))
}

/// Returns the number in a cell, which may have the exponent of FORTRAN, as in `1.5D-3`. It may be infinite.
pub(super) fn number(cell: &str, decimal: Decimal) -> Option<f64> {
    let text = match decimal {
        Decimal::Point => cell.parse().ok(),
        Decimal::Comma if cell.contains('.') => None,
        Decimal::Comma => cell.replace(',', ".").parse().ok(),
    };
    let digits = |c: char| c.is_ascii_digit();
    let other = || {
        let plain = cell.replace(['d', 'D'], "e").replace('−', "-");
        if decimal == Decimal::Comma { plain.replace(',', ".") } else { plain }
    };
    let special = |c: char| matches!(c, 'd' | 'D' | '−');
    let is_other =
        || cell.contains(digits) && cell.contains(special) && !(decimal == Decimal::Comma && cell.contains('.'));
    text.or_else(|| is_other().then(other)?.parse().ok()).filter(|x: &f64| !x.is_nan())
}

/// Returns whether the comma of a cell may separate thousands, as in `1,234`.
pub(super) fn may_have_thousands(cell: &str) -> bool {
    let Some((whole, rest)) = cell.trim_start_matches(['+', '-']).split_once(',') else { return false };
    let digits = |text: &str| text.bytes().all(|b| b.is_ascii_digit());
    (1..=3).contains(&whole.len()) && !whole.starts_with('0') && rest.len() == 3 && digits(whole) && digits(rest)
}

/// Returns the error of a cell that is not a number, with the probable reason and the remedy.
pub(super) fn error(cell: &str, decimal: Decimal) -> Error {
    let starts = cell.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.'));
    let digits = |c: char| c.is_ascii_digit();
    let parts = |marks: &[char]| cell.split(marks).filter(|part| !part.is_empty() && part.chars().all(digits)).count();
    let tidy: String = cell.chars().filter(|c| !matches!(c, '\'' | '’' | ' ' | '\u{a0}' | '\u{202f}')).collect();
    if starts
        && (parts(&['-', '/', ':', ' ', 'T', '.']) >= 3 || (cell.contains(':') && parts(&[':', '.']) >= 2))
        && (cell.contains(['/', ':']) || parts(&['-']) >= 2 || parts(&['.']) >= 3)
        && !cell.contains(',')
    {
        return Error::scene(format!("\"{cell}\" is a date or a time of day, not a number"))
            .help("add a column of seconds from the start of the record, and name it with  time = \"..\"");
    }
    if starts && (cell.contains(',') || tidy.len() != cell.len()) && !cell.contains(char::is_alphabetic) {
        let mixed = cell.contains('.') || tidy.len() != cell.len() || cell.matches(',').count() > 1;
        let what = match (mixed, decimal) {
            (true, _) => format!("\"{cell}\" has a separator of thousands"),
            (false, _) => format!("\"{cell}\" has a decimal comma or a separator of thousands"),
        };
        return Error::scene(what).help("write numbers such as 1234.5: a decimal point, nothing between thousands");
    }
    if starts && decimal == Decimal::Comma && cell.contains('.') && cell.replace(',', "").parse::<f64>().is_ok() {
        return Error::scene(format!("\"{cell}\" has a point, and other cells have decimal commas"))
            .help("write decimal points in all cells");
    }
    let mark = ["#", "!", "//"].into_iter().find_map(|mark| cell.find(mark));
    if mark.is_some_and(|at| number(cell[..at].trim(), decimal).is_some()) {
        return Error::scene(format!("\"{cell}\" is a number with a comment behind it"))
            .help("put the comment on a line of its own");
    }
    let end = cell.rfind(digits).map_or(0, |i| i + 1);
    let (value, unit) = cell.split_at(end);
    if number(value, decimal).is_some() && !unit.trim().is_empty() {
        let what = format!("\"{cell}\" is a number with a unit, not a number");
        return Error::scene(what).help(format!("write {value} alone; the unit belongs into the name of the column"));
    }
    Error::scene(format!("\"{cell}\" is not a number"))
}
