//! Units in the names and the unit rows of tables.

use std::f64::consts::{PI, TAU};

/// Powers of kg, m and s. Angles are numbers.
type Dimensions = [i32; 3];

const NUMBER: Dimensions = [0, 0, 0];
const LENGTH: Dimensions = [0, 1, 0];
const TIME: Dimensions = [0, 0, 1];
const RATE: Dimensions = [0, 0, -1];
const SPEED: Dimensions = [0, 1, -1];
const ACCELERATION: Dimensions = [0, 1, -2];
const MASS: Dimensions = [1, 0, 0];
const FORCE: Dimensions = [1, 1, -2];
const MOMENT: Dimensions = [1, 2, -2];
const PRESSURE: Dimensions = [1, -1, -2];
const POWER: Dimensions = [1, 2, -3];

/// Acceleration of gravity that makes a kilogram a kilogram-force, m/s².
const STANDARD_GRAVITY: f64 = 9.806_65;

/// Names of the number one, as of columns without a unit.
const ONES: [&str; 5] = ["-", "–", "—", "--", "1"];

/// Units, their size in the SI unit of the same quantity, and the quantity. Others are products, quotients and powers of these.
const UNITS: [(&str, f64, Dimensions); 86] = [
    ("m", 1.0, LENGTH),
    ("meter", 1.0, LENGTH),
    ("meters", 1.0, LENGTH),
    ("metre", 1.0, LENGTH),
    ("metres", 1.0, LENGTH),
    ("µm", 1e-6, LENGTH),
    ("mm", 1e-3, LENGTH),
    ("cm", 1e-2, LENGTH),
    ("dm", 1e-1, LENGTH),
    ("km", 1e3, LENGTH),
    ("in", 0.0254, LENGTH),
    ("inch", 0.0254, LENGTH),
    ("ft", 0.3048, LENGTH),
    ("feet", 0.3048, LENGTH),
    ("yd", 0.9144, LENGTH),
    ("s", 1.0, TIME),
    ("sec", 1.0, TIME),
    ("second", 1.0, TIME),
    ("seconds", 1.0, TIME),
    ("ms", 1e-3, TIME),
    ("msec", 1e-3, TIME),
    ("us", 1e-6, TIME),
    ("µs", 1e-6, TIME),
    ("min", 60.0, TIME),
    ("minute", 60.0, TIME),
    ("minutes", 60.0, TIME),
    ("h", 3600.0, TIME),
    ("hr", 3600.0, TIME),
    ("hrs", 3600.0, TIME),
    ("hour", 3600.0, TIME),
    ("hours", 3600.0, TIME),
    ("d", 86400.0, TIME),
    ("day", 86400.0, TIME),
    ("days", 86400.0, TIME),
    ("knot", 1852.0 / 3600.0, SPEED),
    ("knots", 1852.0 / 3600.0, SPEED),
    ("kts", 1852.0 / 3600.0, SPEED),
    ("mph", 0.44704, SPEED),
    ("kmh", 1.0 / 3.6, SPEED),
    ("kph", 1.0 / 3.6, SPEED),
    ("fps", 0.3048, SPEED),
    ("kg", 1.0, MASS),
    ("lb", 0.453_592_37, MASS),
    ("lbs", 0.453_592_37, MASS),
    ("tonne", 1e3, MASS),
    ("tonnes", 1e3, MASS),
    ("N", 1.0, FORCE),
    ("mN", 1e-3, FORCE),
    ("daN", 10.0, FORCE),
    ("kN", 1e3, FORCE),
    ("MN", 1e6, FORCE),
    ("kgf", STANDARD_GRAVITY, FORCE),
    ("kp", STANDARD_GRAVITY, FORCE),
    ("gf", STANDARD_GRAVITY / 1e3, FORCE),
    ("tf", STANDARD_GRAVITY * 1e3, FORCE),
    ("lbf", 4.448_221_615_260_5, FORCE),
    ("kip", 4_448.221_615_260_5, FORCE),
    ("Nm", 1.0, MOMENT),
    ("Nmm", 1e-3, MOMENT),
    ("kNm", 1e3, MOMENT),
    ("MNm", 1e6, MOMENT),
    ("Pa", 1.0, PRESSURE),
    ("hPa", 100.0, PRESSURE),
    ("kPa", 1e3, PRESSURE),
    ("MPa", 1e6, PRESSURE),
    ("mbar", 100.0, PRESSURE),
    ("bar", 1e5, PRESSURE),
    ("psi", 6_894.757_293_168, PRESSURE),
    ("rad", 1.0, NUMBER),
    ("mrad", 1e-3, NUMBER),
    ("deg", PI / 180.0, NUMBER),
    ("degree", PI / 180.0, NUMBER),
    ("degrees", PI / 180.0, NUMBER),
    ("°", PI / 180.0, NUMBER),
    ("rev", TAU, NUMBER),
    ("turn", TAU, NUMBER),
    ("Hz", TAU, RATE),
    ("kHz", 1e3 * TAU, RATE),
    ("rpm", PI / 30.0, RATE),
    ("dps", PI / 180.0, RATE),
    ("J", 1.0, MOMENT),
    ("kJ", 1e3, MOMENT),
    ("W", 1.0, POWER),
    ("kW", 1e3, POWER),
    ("MW", 1e6, POWER),
    ("%", 1e-2, NUMBER),
];

/// Units of more than one meaning, or of quantities that no law has: grams or the acceleration of gravity, knots or
/// kilonewtons, tonnes or tonnes-force, volts.
const OTHERS: [&str; 11] = ["g", "G", "kn", "KN", "t", "T", "V", "mV", "A", "mA", "°C"];

/// Suffixes of names that are units: `x_mm`. Others, such as `x_min`, may be words.
const SUFFIXES: [&str; 40] = [
    "mm", "cm", "km", "ft", "m", "ms", "kN", "MN", "mN", "daN", "N", "kNm", "Nm", "Pa", "hPa", "kPa", "MPa", "mbar",
    "bar", "psi", "deg", "rad", "mrad", "kgf", "lbf", "tf", "s", "rpm", "knots", "kts", "kn", "rev", "kmh", "kph",
    "mph", "kg", "lb", "lbs", "Hz", "kW",
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

/// A unit: its size in the SI unit of the same quantity, and this quantity.
#[derive(Clone, Copy)]
struct Unit {
    size: f64,
    of: Dimensions,
}

impl Unit {
    /// Returns the unit that `text` names; `None` if it is not known.
    fn parse(text: &str) -> Option<Self> {
        let one = Self { size: 1.0, of: NUMBER };
        if ONES.contains(&text) {
            return Some(one);
        }
        if let Some((_, size, of)) = UNITS.iter().find(|(name, ..)| *name == text) {
            return Some(Self { size: *size, of: *of });
        }
        if let Some((above, below)) = text.rsplit_once('/').or_else(|| text.rsplit_once("_per_")) {
            return Some(Self::parse(above.trim())?.times(Self::parse(below.trim())?, -1));
        }
        if let Some((at, mark)) = text.char_indices().rev().find(|(at, mark)| is_product(text, *at, *mark)) {
            let (one, other) = (&text[..at], &text[at + mark.len_utf8()..]);
            return Some(Self::parse(one.trim())?.times(Self::parse(other.trim())?, 1));
        }
        // `mps2` is m/s².
        let quotient = text.match_indices('p').find_map(|(at, _)| {
            let parts = [&text[..at], &text[at + 1..]];
            let [above, below] = parts.iter().all(|part| !ONES.contains(part)).then_some(parts)?;
            Some(Self::parse(above)?.times(Self::parse(below)?, -1))
        });
        quotient.or_else(|| split_power(text).and_then(|(base, power)| Some(one.times(Self::parse(base)?, power))))
    }

    /// Returns the product of this unit and a power of `other`.
    fn times(self, other: Self, power: i32) -> Self {
        let of = std::array::from_fn(|i| self.of[i] + power * other.of[i]);
        // A quotient has one rounding.
        let size = if power == -1 { self.size / other.size } else { self.size * other.size.powi(power) };
        Self { size, of }
    }
}

/// Returns whether the `mark` at this place of `text` stands between two factors. A hyphen before a digit is the sign
/// of an exponent.
fn is_product(text: &str, at: usize, mark: char) -> bool {
    let next = text[at + mark.len_utf8()..].chars().next();
    match mark {
        '-' => !text[..at].ends_with('^') && next.is_some_and(|next| !next.is_ascii_digit()),
        '*' => next.is_some_and(|next| next != '*') && !text[..at].ends_with('*'),
        '·' | '×' | '.' | ' ' => next.is_some(),
        _ => false,
    }
}

/// Returns the base and the exponent of a power, as in `s-1`, `s^-1`, `s⁻¹` or `m3`.
fn split_power(text: &str) -> Option<(&str, i32)> {
    const RAISED: [char; 4] = ['¹', '²', '³', '⁴'];
    let digit = text.chars().next_back()?;
    let raised = RAISED.iter().position(|raised| *raised == digit);
    let value = raised.map(|i| i as i32 + 1).or_else(|| digit.to_digit(5).map(|x| x as i32)).filter(|x| *x > 0)?;
    let rest = &text[..text.len() - digit.len_utf8()];
    let unsigned = rest.strip_suffix(['-', '−', '⁻']);
    let base = unsigned.unwrap_or(rest);
    let base = base.strip_suffix('^').or_else(|| base.strip_suffix("**")).unwrap_or(base);
    // `d1` is a name.
    let is_power =
        !base.is_empty() && (unsigned.is_some() || base != rest || raised.is_some() || matches!(value, 2 | 3));
    is_power.then_some((base, if unsigned.is_some() { -value } else { value }))
}

/// Returns the size of `unit` in the SI unit of the same quantity; `None` if it is not known.
fn size(unit: &str) -> Option<f64> {
    Some(Unit::parse(unit)?.size)
}

/// The relation of the unit of a column to the unit in which its values are meant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Conversion {
    /// The unit has this size in the other.
    Factor(f64),
    /// The unit is one of mass; its weight has this size in the other.
    Weight(f64),
    /// The two units are of different quantities.
    OtherQuantity,
}

/// Returns the relation of `unit` to the unit `meant`, in 2-D also per metre of width; `None` if one of them is not known.
pub(crate) fn conversion(unit: &str, meant: &str, dimension: usize) -> Option<Conversion> {
    let (from, to) = (Unit::parse(unit)?, Unit::parse(meant)?);
    let factor = from.size / to.size;
    let over = |by: &Dimensions| -> Dimensions { std::array::from_fn(|i| to.of[i] - from.of[i] - by[i]) };
    // Both units may be per metre of width, of the quantities with a mass.
    let may_be_per_width = dimension == 2 && to.of[0] != 0 && unit.contains(['/', '-', '−', '⁻']);
    let has_mass = from.of[0] == 1 && from.of[2] == 0;
    let is_same = |of: Dimensions| of == NUMBER || (may_be_per_width && of == LENGTH);
    Some(match () {
        () if ONES.contains(&unit) => Conversion::Factor(1.0),
        () if is_same(over(&NUMBER)) => Conversion::Factor(factor),
        () if has_mass && is_same(over(&ACCELERATION)) => Conversion::Weight(STANDARD_GRAVITY * factor),
        () => Conversion::OtherQuantity,
    })
}

/// Returns the unit at the end of the name of a series of a run, as in `b.vx_mps`.
pub(crate) fn of_series(name: &str) -> Option<&str> {
    name.rsplit_once('_').map(|(_, unit)| unit).filter(|unit| Unit::parse(unit).is_some())
}

/// Returns the unit at the end of the name of a column, as in `x_mm`.
fn suffix(name: &str) -> Option<&str> {
    // `u_m_per_s`
    if let Some((above, _)) = name.rsplit_once("_per_") {
        let unit = &name[above.rfind(['_', ' ']).map_or(0, |at| at + 1)..];
        return Some(unit).filter(|unit| Unit::parse(unit).is_some());
    }
    name.rsplit_once(['_', ' ']).map(|(_, suffix)| suffix).filter(|suffix| SUFFIXES.contains(suffix) || is_rate(suffix))
}

/// Returns whether `suffix` is a unit per second or second squared, as in `w_degps`.
fn is_rate(suffix: &str) -> bool {
    (suffix.ends_with("ps") || suffix.ends_with("ps2")) && Unit::parse(suffix).is_some()
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
