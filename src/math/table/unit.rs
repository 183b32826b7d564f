//! Units in the names and the unit rows of tables.

use std::f64::consts::{PI, TAU};

/// Units, and their size in the SI unit of the same quantity. Others are products, quotients and powers of these.
const UNITS: [(&str, f64); 88] = [
    ("m", 1.0),
    ("meter", 1.0),
    ("meters", 1.0),
    ("metre", 1.0),
    ("metres", 1.0),
    ("µm", 1e-6),
    ("mm", 1e-3),
    ("cm", 1e-2),
    ("dm", 1e-1),
    ("km", 1e3),
    ("in", 0.0254),
    ("inch", 0.0254),
    ("ft", 0.3048),
    ("feet", 0.3048),
    ("yd", 0.9144),
    ("s", 1.0),
    ("sec", 1.0),
    ("second", 1.0),
    ("seconds", 1.0),
    ("ms", 1e-3),
    ("msec", 1e-3),
    ("us", 1e-6),
    ("µs", 1e-6),
    ("min", 60.0),
    ("minute", 60.0),
    ("minutes", 60.0),
    ("h", 3600.0),
    ("hr", 3600.0),
    ("hrs", 3600.0),
    ("hour", 3600.0),
    ("hours", 3600.0),
    ("d", 86400.0),
    ("day", 86400.0),
    ("days", 86400.0),
    ("knot", 1852.0 / 3600.0),
    ("knots", 1852.0 / 3600.0),
    ("kts", 1852.0 / 3600.0),
    ("mph", 0.44704),
    ("kmh", 1.0 / 3.6),
    ("kg", 1.0),
    ("lb", 0.453_592_37),
    ("lbs", 0.453_592_37),
    ("tonne", 1e3),
    ("tonnes", 1e3),
    ("N", 1.0),
    ("mN", 1e-3),
    ("daN", 10.0),
    ("kN", 1e3),
    ("MN", 1e6),
    ("kgf", 9.806_65),
    ("kp", 9.806_65),
    ("gf", 9.806_65e-3),
    ("tf", 9806.65),
    ("lbf", 4.448_221_615_260_5),
    ("kip", 4_448.221_615_260_5),
    ("Nm", 1.0),
    ("Nmm", 1e-3),
    ("kNm", 1e3),
    ("MNm", 1e6),
    ("Pa", 1.0),
    ("hPa", 100.0),
    ("kPa", 1e3),
    ("MPa", 1e6),
    ("mbar", 100.0),
    ("bar", 1e5),
    ("psi", 6_894.757_293_168),
    ("rad", 1.0),
    ("mrad", 1e-3),
    ("deg", PI / 180.0),
    ("degree", PI / 180.0),
    ("degrees", PI / 180.0),
    ("°", PI / 180.0),
    ("rev", TAU),
    ("turn", TAU),
    ("Hz", 1.0),
    ("kHz", 1e3),
    ("rpm", PI / 30.0),
    ("J", 1.0),
    ("kJ", 1e3),
    ("W", 1.0),
    ("kW", 1e3),
    ("MW", 1e6),
    ("%", 1e-2),
    ("-", 1.0),
    ("–", 1.0),
    ("—", 1.0),
    ("--", 1.0),
    ("1", 1.0),
];

/// Units of more than one meaning, or of quantities that no law has: grams or the acceleration of gravity, knots or
/// kilonewtons, tonnes or tonnes-force, volts.
const OTHERS: [&str; 11] = ["g", "G", "kn", "KN", "t", "T", "V", "mV", "A", "mA", "°C"];

/// Suffixes of names that are units: `x_mm`. Others, such as `x_min`, may be words.
const SUFFIXES: [&str; 26] = [
    "mm", "cm", "km", "ft", "m", "ms", "kN", "MN", "mN", "daN", "N", "kNm", "Nm", "kPa", "deg", "rad", "mrad", "kgf",
    "lbf", "tf", "s", "rpm", "knots", "kts", "kn", "rev",
];

/// Units that are names of columns as well: a row of units has them in brackets.
const NAMES: [&str; 4] = ["d", "G", "T", "A"];

/// Returns whether `cell` is a unit, in brackets or known.
pub(super) fn is_unit(cell: &str) -> bool {
    bracketed(cell).is_some() || (is_known(cell) && !NAMES.contains(&cell))
}

/// Returns the text in the brackets around `cell`.
fn bracketed(cell: &str) -> Option<&str> {
    let inside = |open, close| cell.strip_prefix(open).and_then(|rest| rest.strip_suffix(close));
    inside('(', ')').or_else(|| inside('[', ']')).map(str::trim)
}

/// Returns a name without the unit in brackets at its end, and this unit.
pub(super) fn split_name(name: &str) -> (&str, Option<&str>) {
    match name.rfind(['(', '[']) {
        Some(at) if at > 0 && bracketed(&name[at..]).is_some() => (name[..at].trim_end(), bracketed(&name[at..])),
        _ => (name, None),
    }
}

/// Returns whether `unit` is a unit.
pub(super) fn is_known(unit: &str) -> bool {
    size(unit).is_some() || OTHERS.contains(&unit)
}

/// Returns the size of `unit` in the SI unit of the same quantity; `None` if it is not known.
fn size(unit: &str) -> Option<f64> {
    if let Some((_, size)) = UNITS.iter().find(|(name, _)| *name == unit) {
        return Some(*size);
    }
    if let Some((above, below)) = unit.rsplit_once('/') {
        return Some(size(above.trim())? / size(below.trim())?);
    }
    if let Some((one, other)) = unit.rsplit_once(['·', '*', '×', '.', ' ', '-']) {
        return Some(size(one.trim())? * size(other.trim())?);
    }
    let powers = [("^2", 2), ("²", 2), ("2", 2), ("^3", 3), ("³", 3), ("3", 3)];
    powers.iter().find_map(|(mark, power)| Some(size(unit.strip_suffix(mark)?)?.powi(*power)))
}

/// Returns the unit at the end of the name of a column, as in `x_mm`.
fn suffix(name: &str) -> Option<&str> {
    name.rsplit_once(['_', ' ']).map(|(_, suffix)| suffix).filter(|suffix| SUFFIXES.contains(suffix))
}

/// Returns the unit of the column `name` with the cell `row` of a unit row: of the row, else of the name.
pub(super) fn of_column(name: &str, row: Option<&str>) -> Option<String> {
    given(name, row).or_else(|| suffix(name)).map(String::from)
}

/// Returns the unit of the unit row, else the one in brackets.
fn given<'a>(name: &'a str, row: Option<&'a str>) -> Option<&'a str> {
    let row = row.filter(|cell| !cell.is_empty()).map(|cell| bracketed(cell).unwrap_or(cell));
    row.or(split_name(name).1)
}

/// Returns the two units of the column `name` with the cell `row` of a unit row, if they contradict each other.
pub(super) fn contradiction<'a>(name: &'a str, row: Option<&'a str>) -> Option<[&'a str; 2]> {
    let (suffix, given) = (suffix(split_name(name).0)?, given(name, row)?);
    let (a, b) = (size(suffix)?, size(given)?);
    // `v_ms` is a speed.
    (suffix != "ms" && (a / b - 1.0).abs() > 1e-9).then_some([suffix, given])
}

/// Returns the size of `unit` in the SI unit of the same quantity; `None` for SI units and unknown ones.
pub(crate) fn si_factor(unit: &str) -> Option<f64> {
    size(unit).filter(|size| *size != 1.0)
}

/// Returns whether `unit` has no size in an SI unit.
pub(crate) fn is_without_size(unit: &str) -> bool {
    size(unit).is_none()
}

/// Returns whether `unit` is the degree.
pub(crate) fn is_degree(unit: &str) -> bool {
    matches!(unit, "deg" | "degree" | "degrees" | "°")
}

/// Returns whether `unit` is one of angles.
pub(crate) fn is_angle(unit: &str) -> bool {
    is_degree(unit) || matches!(unit, "rad" | "mrad" | "rev" | "turn")
}
