//! Units in the names and the unit rows of tables.

/// Units that are not of the SI, and their size in the SI unit of the same quantity.
const FACTORS: [(&str, f64); 28] = [
    ("mm", 1e-3),
    ("cm", 1e-2),
    ("km", 1e3),
    ("in", 0.0254),
    ("inch", 0.0254),
    ("ft", 0.3048),
    ("mm/s", 1e-3),
    ("cm/s", 1e-2),
    ("km/h", 1.0 / 3.6),
    ("ft/s", 0.3048),
    ("kN", 1e3),
    ("MN", 1e6),
    ("kNm", 1e3),
    ("kN-m", 1e3),
    ("kN*m", 1e3),
    ("kN·m", 1e3),
    ("kN m", 1e3),
    ("MNm", 1e6),
    ("kPa", 1e3),
    ("MPa", 1e6),
    ("mbar", 100.0),
    ("bar", 1e5),
    ("ms", 1e-3),
    ("msec", 1e-3),
    ("us", 1e-6),
    ("µs", 1e-6),
    ("min", 60.0),
    ("deg/s", std::f64::consts::PI / 180.0),
];

/// Other units that a unit row may have.
const UNITS: [&str; 44] = [
    "s", "sec", "second", "seconds", "h", "m", "meter", "meters", "metre", "metres", "N", "Nm", "N-m", "N*m", "N·m",
    "N m", "Pa", "kg", "g", "t", "rad", "deg", "degree", "degrees", "°", "m/s", "m/s2", "m/s^2", "m/s²", "rad/s",
    "rad/s^2", "rad/s2", "Hz", "1/s", "rpm", "W", "kW", "V", "mV", "%", "-", "–", "--", "1",
];

/// Suffixes of names that are units: `x_mm`. Others, such as `x_min`, may be words.
const SUFFIXES: [&str; 10] = ["mm", "cm", "km", "kN", "MN", "kNm", "kPa", "ms", "deg", "rad"];

/// Returns whether `cell` is a unit, in brackets or known.
pub(super) fn is_unit(cell: &str) -> bool {
    let known = |unit: &str| UNITS.contains(&unit) || FACTORS.iter().any(|(name, _)| *name == unit);
    bracketed(cell).is_some() || known(cell)
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

/// Returns the unit of the column `name` with the cell `row` of a unit row: of the row, else of the name.
pub(super) fn of_column(name: &str, row: Option<&str>) -> Option<String> {
    let suffix = || name.rsplit_once('_').map(|(_, suffix)| suffix).filter(|suffix| SUFFIXES.contains(suffix));
    let row = row.filter(|cell| !cell.is_empty()).map(|cell| bracketed(cell).unwrap_or(cell));
    row.or(split_name(name).1).or_else(suffix).map(String::from)
}

/// Returns the size of `unit` in the SI unit of the same quantity; `None` for SI units and unknown ones.
pub(crate) fn si_factor(unit: &str) -> Option<f64> {
    FACTORS.iter().find(|(name, _)| *name == unit).map(|(_, factor)| *factor)
}

/// Returns whether `unit` is the degree.
pub(crate) fn is_degree(unit: &str) -> bool {
    matches!(unit, "deg" | "degree" | "degrees" | "°")
}
