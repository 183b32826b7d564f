//! Units in the names and the unit rows of tables.

use std::f64::consts::{PI, TAU};

use Ending::{Unit, Word};

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

/// The meaning of a unit's name at the end of the name of a column.
#[derive(Clone, Copy, PartialEq)]
enum Ending {
    /// It is the unit, as in `x_mm`.
    Unit,
    /// It is the unit in a column of its quantity, else a word: minutes in `time_min`, the least in `x_min`.
    Word,
}

/// Units, their size in the SI unit of the same quantity, the quantity, and their meaning at the end of a name. Others are
/// products, quotients and powers of these. A name of several quantities stands once for each.
const UNITS: [(&str, f64, Dimensions, Ending); 136] = [
    ("mm", 1e-3, LENGTH, Unit),
    ("cm", 1e-2, LENGTH, Unit),
    ("dm", 1e-1, LENGTH, Unit),
    ("km", 1e3, LENGTH, Unit),
    ("µm", 1e-6, LENGTH, Unit),
    ("m", 1.0, LENGTH, Unit),
    ("meter", 1.0, LENGTH, Word),
    ("meters", 1.0, LENGTH, Unit),
    ("metre", 1.0, LENGTH, Word),
    ("metres", 1.0, LENGTH, Unit),
    ("millimeter", 1e-3, LENGTH, Unit),
    ("millimeters", 1e-3, LENGTH, Unit),
    ("millimetre", 1e-3, LENGTH, Unit),
    ("millimetres", 1e-3, LENGTH, Unit),
    ("centimeter", 1e-2, LENGTH, Unit),
    ("centimeters", 1e-2, LENGTH, Unit),
    ("centimetre", 1e-2, LENGTH, Unit),
    ("centimetres", 1e-2, LENGTH, Unit),
    ("kilometer", 1e3, LENGTH, Unit),
    ("kilometers", 1e3, LENGTH, Unit),
    ("kilometre", 1e3, LENGTH, Unit),
    ("kilometres", 1e3, LENGTH, Unit),
    ("in", 0.0254, LENGTH, Word),
    ("inch", 0.0254, LENGTH, Unit),
    ("inches", 0.0254, LENGTH, Unit),
    ("ft", 0.3048, LENGTH, Unit),
    ("foot", 0.3048, LENGTH, Word),
    ("feet", 0.3048, LENGTH, Unit),
    ("yd", 0.9144, LENGTH, Word),
    ("s", 1.0, TIME, Unit),
    ("sec", 1.0, TIME, Word),
    ("secs", 1.0, TIME, Unit),
    ("second", 1.0, TIME, Word),
    ("seconds", 1.0, TIME, Unit),
    ("ms", 1e-3, TIME, Unit),
    ("msec", 1e-3, TIME, Unit),
    ("millisecond", 1e-3, TIME, Unit),
    ("milliseconds", 1e-3, TIME, Unit),
    ("us", 1e-6, TIME, Word),
    ("µs", 1e-6, TIME, Unit),
    ("usec", 1e-6, TIME, Unit),
    ("microseconds", 1e-6, TIME, Unit),
    ("min", 60.0, TIME, Word),
    ("mins", 60.0, TIME, Unit),
    ("minute", 60.0, TIME, Word),
    ("minutes", 60.0, TIME, Unit),
    ("h", 3600.0, TIME, Word),
    ("hr", 3600.0, TIME, Word),
    ("hrs", 3600.0, TIME, Unit),
    ("hour", 3600.0, TIME, Word),
    ("hours", 3600.0, TIME, Unit),
    ("d", 86400.0, TIME, Word),
    ("day", 86400.0, TIME, Word),
    ("days", 86400.0, TIME, Unit),
    ("ms", 1.0, SPEED, Unit),
    ("ms-1", 1.0, SPEED, Unit),
    ("ms^-1", 1.0, SPEED, Unit),
    ("knot", 1852.0 / 3600.0, SPEED, Word),
    ("knots", 1852.0 / 3600.0, SPEED, Unit),
    ("kn", 1852.0 / 3600.0, SPEED, Unit),
    ("kts", 1852.0 / 3600.0, SPEED, Unit),
    ("mph", 0.44704, SPEED, Unit),
    ("kmh", 1.0 / 3.6, SPEED, Unit),
    ("kph", 1.0 / 3.6, SPEED, Unit),
    ("fps", 0.3048, SPEED, Word),
    ("ms2", 1.0, ACCELERATION, Unit),
    ("ms-2", 1.0, ACCELERATION, Unit),
    ("ms^-2", 1.0, ACCELERATION, Unit),
    ("g", STANDARD_GRAVITY, ACCELERATION, Word),
    ("G", STANDARD_GRAVITY, ACCELERATION, Word),
    ("kg", 1.0, MASS, Unit),
    ("kilogram", 1.0, MASS, Unit),
    ("kilograms", 1.0, MASS, Unit),
    ("g", 1e-3, MASS, Word),
    ("gram", 1e-3, MASS, Unit),
    ("grams", 1e-3, MASS, Unit),
    ("lb", 0.453_592_37, MASS, Unit),
    ("lbs", 0.453_592_37, MASS, Unit),
    ("tonne", 1e3, MASS, Unit),
    ("tonnes", 1e3, MASS, Unit),
    ("N", 1.0, FORCE, Unit),
    ("newton", 1.0, FORCE, Unit),
    ("newtons", 1.0, FORCE, Unit),
    ("mN", 1e-3, FORCE, Unit),
    ("daN", 10.0, FORCE, Unit),
    ("kN", 1e3, FORCE, Unit),
    ("kn", 1e3, FORCE, Unit),
    ("kilonewton", 1e3, FORCE, Unit),
    ("kilonewtons", 1e3, FORCE, Unit),
    ("MN", 1e6, FORCE, Unit),
    ("kgf", STANDARD_GRAVITY, FORCE, Unit),
    ("kp", STANDARD_GRAVITY, FORCE, Word),
    ("gf", STANDARD_GRAVITY / 1e3, FORCE, Unit),
    ("tf", STANDARD_GRAVITY * 1e3, FORCE, Unit),
    ("lbf", 4.448_221_615_260_5, FORCE, Unit),
    ("kip", 4_448.221_615_260_5, FORCE, Word),
    ("Nm", 1.0, MOMENT, Unit),
    ("Nmm", 1e-3, MOMENT, Unit),
    ("Ncm", 1e-2, MOMENT, Unit),
    ("mNm", 1e-3, MOMENT, Unit),
    ("kNmm", 1.0, MOMENT, Unit),
    ("kNcm", 10.0, MOMENT, Unit),
    ("kNm", 1e3, MOMENT, Unit),
    ("MNm", 1e6, MOMENT, Unit),
    ("J", 1.0, MOMENT, Word),
    ("kJ", 1e3, MOMENT, Unit),
    ("Pa", 1.0, PRESSURE, Unit),
    ("pascal", 1.0, PRESSURE, Unit),
    ("hPa", 100.0, PRESSURE, Unit),
    ("kPa", 1e3, PRESSURE, Unit),
    ("MPa", 1e6, PRESSURE, Unit),
    ("mbar", 100.0, PRESSURE, Unit),
    ("bar", 1e5, PRESSURE, Word),
    ("psi", 6_894.757_293_168, PRESSURE, Unit),
    ("W", 1.0, POWER, Word),
    ("kW", 1e3, POWER, Unit),
    ("MW", 1e6, POWER, Unit),
    ("rad", 1.0, NUMBER, Unit),
    ("rads", 1.0, NUMBER, Unit),
    ("radian", 1.0, NUMBER, Unit),
    ("radians", 1.0, NUMBER, Unit),
    ("mrad", 1e-3, NUMBER, Unit),
    ("deg", PI / 180.0, NUMBER, Unit),
    ("degs", PI / 180.0, NUMBER, Unit),
    ("degree", PI / 180.0, NUMBER, Unit),
    ("degrees", PI / 180.0, NUMBER, Unit),
    ("°", PI / 180.0, NUMBER, Unit),
    ("rev", TAU, NUMBER, Word),
    ("turn", TAU, NUMBER, Word),
    ("%", 1e-2, NUMBER, Word),
    ("Hz", TAU, RATE, Unit),
    ("kHz", 1e3 * TAU, RATE, Unit),
    ("rpm", PI / 30.0, RATE, Unit),
    ("dps", PI / 180.0, RATE, Unit),
    ("degs", PI / 180.0, RATE, Unit),
    ("rads", 1.0, RATE, Unit),
];

/// Units of quantities that no law has, and tonnes, which are tonnes-force as well.
const OTHERS: [&str; 7] = ["t", "T", "V", "mV", "A", "mA", "°C"];

/// Longest text of a unit, in bytes.
const LONGEST: usize = 30;

/// Units that are names of columns as well: a row of units has them in brackets.
const NAMES: [&str; 4] = ["d", "G", "T", "A"];

/// Characters between the words of a name.
const SEPARATORS: [char; 7] = ['_', ' ', '.', '-', '/', '|', ','];

/// Pairs of brackets around a unit.
const BRACKETS: [(char, char); 4] = [('(', ')'), ('[', ']'), ('{', '}'), ('<', '>')];

/// Returns whether all cells of a row are units, some of them perhaps in other letters than usual, as in `S,MM`.
pub(super) fn is_unit_row(cells: &[String]) -> bool {
    let all = |is_unit: fn(&str) -> bool| cells.iter().all(|cell| cell.is_empty() || is_unit(cell));
    // `H` and `T` are names.
    let has_sure = || cells.iter().any(|cell| cell.len() > 1 && is_sure(&readings(cell)));
    all(is_unit) || (all(|cell| is_unit(cell) || !readings(cell).is_empty()) && has_sure())
}

/// Returns whether `cell` is a unit, in brackets or known.
pub(super) fn is_unit(cell: &str) -> bool {
    bracketed(cell).is_some() || (is_known(cell) && !NAMES.contains(&cell))
}

/// Returns the text in the brackets around `cell`.
fn bracketed(cell: &str) -> Option<&str> {
    let inside = |(open, close)| cell.strip_prefix(open).and_then(|rest: &str| rest.strip_suffix(close));
    BRACKETS.into_iter().find_map(inside).map(str::trim)
}

/// Returns whether `cell` begins with a bracket.
pub(super) fn opens(cell: &str) -> bool {
    cell.starts_with(BRACKETS.map(|(open, _)| open))
}

/// Returns a name without the unit in brackets at its end, and this unit.
pub(super) fn split_name(name: &str) -> (&str, Option<&str>) {
    match name.rfind(BRACKETS.map(|(open, _)| open)) {
        Some(at) if at > 0 && bracketed(&name[at..]).is_some() => (name[..at].trim_end(), bracketed(&name[at..])),
        _ => (name, None),
    }
}

/// Returns whether `unit` is a unit.
pub(super) fn is_known(unit: &str) -> bool {
    !Reading::all(unit, has_letters_of).is_empty() || OTHERS.contains(&unit)
}

/// A comparison of a unit's name with a text.
type Comparison = fn(&str, &str) -> bool;

/// Returns whether a `text` is the `name` of a unit.
fn has_letters_of(name: &str, text: &str) -> bool {
    name == text
}

/// Returns whether a `text` is the `name` of a unit in capital or small letters. A small m is never mega.
fn has_other_case_of(name: &str, text: &str) -> bool {
    name.eq_ignore_ascii_case(text) && !(name.starts_with('M') && text.starts_with('m'))
}

/// Returns the units that `text` may name: those with its letters, else those in other case.
fn readings(text: &str) -> Vec<Reading> {
    let exact = Reading::all(text, has_letters_of);
    if exact.is_empty() { Reading::all(text, has_other_case_of) } else { exact }
}

/// Returns whether one of the units is sure at the end of a name.
fn is_sure(readings: &[Reading]) -> bool {
    readings.iter().any(|reading| reading.ending == Unit)
}

/// A unit that a text names.
#[derive(Clone, Copy)]
struct Reading {
    /// Its size in the SI unit of the same quantity.
    size: f64,
    /// Its quantity.
    of: Dimensions,
    /// Whether it is a unit per another.
    is_quotient: bool,
    ending: Ending,
}

impl Reading {
    /// The number one.
    const ONE: Self = Self { size: 1.0, of: NUMBER, is_quotient: false, ending: Word };

    /// Returns the units that `text` names, with letters compared in this way.
    fn all(text: &str, is_same: Comparison) -> Vec<Self> {
        let all = |text: &str| Self::all(text.trim(), is_same);
        if text.len() > LONGEST {
            return Vec::new();
        }
        let simple = Self::simple(text, is_same);
        if !simple.is_empty() {
            return simple;
        }
        if let Some((above, below)) = ["/", "_per_", " per "].iter().find_map(|mark| text.rsplit_once(mark)) {
            return Self::products(&all(above), &all(below), -1);
        }
        let of_word = |one: Self| Self { ending: Word, ..one };
        // `v_mm_s` is in mm/s, and `lag_30_mm_s` in s.
        if let Some((above, below @ ("s" | "s2"))) = text.rsplit_once('_') {
            return Self::products(&all(above), &all(below), -1).into_iter().map(of_word).collect();
        }
        if let Some((at, mark)) = text.char_indices().rev().find(|(at, mark)| is_product(text, *at, *mark)) {
            return Self::products(&all(&text[..at]), &all(&text[at + mark.len_utf8()..]), 1);
        }
        // `mps2` is m/s².
        let quotients = text.match_indices('p').map(|(at, _)| {
            let parts = [&text[..at], &text[at + 1..]];
            let [above, below] = parts.map(|part| if ONES.contains(&part) { "" } else { part });
            let is_rate = text.ends_with("ps") || text.ends_with("ps2");
            let all = Self::products(&Self::simple(above, is_same), &Self::simple(below, is_same), -1);
            all.into_iter().map(|one| if is_rate { one } else { of_word(one) }).collect::<Vec<_>>()
        });
        quotients.into_iter().find(|all| !all.is_empty()).unwrap_or_default()
    }

    /// Returns the units of the table that `text` names, and powers of them.
    fn simple(text: &str, is_same: Comparison) -> Vec<Self> {
        if ONES.contains(&text) {
            return vec![Self::ONE];
        }
        let named = |text: &str| -> Vec<Self> {
            let rows = UNITS.iter().filter(|(name, ..)| is_same(name, text));
            rows.map(|(_, size, of, ending)| Self { size: *size, of: *of, ending: *ending, ..Self::ONE }).collect()
        };
        let all = named(text);
        match split_power(text) {
            Some((base, power)) if all.is_empty() => Self::products(&[Self::ONE], &named(base), power),
            _ => all,
        }
    }

    /// Returns the product of each of the units and a power of each of the `others`.
    fn products(units: &[Self], others: &[Self], power: i32) -> Vec<Self> {
        units.iter().flat_map(|unit| others.iter().map(move |other| unit.times(*other, power))).collect()
    }

    /// Returns the product of this unit and a power of `other`.
    fn times(self, other: Self, power: i32) -> Self {
        let of = std::array::from_fn(|i| self.of[i] + power * other.of[i]);
        // A quotient has one rounding.
        let size = if power == -1 { self.size / other.size } else { self.size * other.size.powi(power) };
        let is_quotient = self.is_quotient || other.is_quotient || power < 0;
        let ending = if power < 0 || other.ending == Unit { self.ending } else { Word };
        Self { size, of, is_quotient, ending }
    }

    /// Returns the relation of this unit to the unit `meant`, in 2-D also per metre of width.
    fn relation(&self, meant: &Self, dimension: usize) -> Conversion {
        let factor = self.size / meant.size;
        let over = |by: &Dimensions| -> Dimensions { std::array::from_fn(|i| meant.of[i] - self.of[i] - by[i]) };
        // Both units may be per metre of width, of the quantities with a mass.
        let may_be_per_width = dimension == 2 && meant.of[0] != 0 && self.is_quotient;
        let has_mass = self.of[0] == 1 && self.of[2] == 0;
        let is_same = |of: Dimensions| of == NUMBER || (may_be_per_width && of == LENGTH);
        match () {
            () if is_same(over(&NUMBER)) => Conversion::Factor(factor),
            () if has_mass && is_same(over(&ACCELERATION)) => Conversion::Weight(STANDARD_GRAVITY * factor),
            () => Conversion::OtherQuantity,
        }
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

/// Returns the size of `unit` in the SI unit of the same quantity; `None` if it has no or several meanings.
fn size(unit: &str) -> Option<f64> {
    match readings(unit)[..] {
        [one] => Some(one.size),
        _ => None,
    }
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
/// Of several meanings of `unit`, the one of the quantity counts.
pub(crate) fn conversion(unit: &str, meant: &str, dimension: usize) -> Option<Conversion> {
    let to = *Reading::all(meant, has_letters_of).first()?;
    if ONES.contains(&unit) {
        return Some(Conversion::Factor(1.0));
    }
    let all: Vec<Conversion> = readings(unit).iter().map(|from| from.relation(&to, dimension)).collect();
    let is_factor = |one: &&Conversion| matches!(one, Conversion::Factor(_));
    let best = all.iter().find(is_factor).or_else(|| all.iter().find(|one| **one != Conversion::OtherQuantity));
    let best = *best.or(all.first())?;
    // `MNM` may be mN m and MN m.
    let is_other = |one: &Conversion| matches!(one, Conversion::Factor(_)) && *one != best;
    let is_one = !matches!(best, Conversion::Factor(_)) || !all.iter().any(is_other);
    is_one.then_some(best)
}

/// Returns whether the meaning of `unit` is assumed: it has several, may be a word, or is written in other letters than usual.
pub(crate) fn is_assumed(unit: &str) -> bool {
    !matches!(Reading::all(unit, has_letters_of)[..], [Reading { ending: Unit, .. }])
}

/// Returns the unit at the end of the name of a series of a run, as in `b.vx_mps`.
pub(crate) fn of_series(name: &str) -> Option<&str> {
    tails(name, &['_']).find(|unit| !Reading::all(unit, has_letters_of).is_empty())
}

/// The unit in which the values of a column are meant, and the dimension of the scene.
pub(crate) type Meant<'a> = (&'a str, usize);

/// Returns the texts behind the `separators` in a `name`, the longest first.
fn tails<'a>(name: &'a str, separators: &'a [char]) -> impl Iterator<Item = &'a str> {
    let all = name.match_indices(separators).map(|(at, mark)| name[at + mark.len()..].trim());
    all.filter(|tail| !ONES.contains(tail))
}

/// Returns whether `text` is a unit of the quantity that is `meant`, or of a mass whose weight is.
fn is_of_quantity(text: &str, (meant, dimension): Meant) -> bool {
    let Some(to) = Reading::all(meant, has_letters_of).into_iter().next() else { return false };
    readings(text).iter().any(|from| match from.relation(&to, dimension) {
        Conversion::Factor(_) => true,
        Conversion::Weight(_) => from.ending == Unit,
        Conversion::OtherQuantity => false,
    })
}

/// Returns the unit at the end of the name of a column, as in `x_mm`, whatever the column is meant for.
fn suffix(name: &str) -> Option<&str> {
    tails(name, &['_', ' ']).find(|tail| is_sure(&Reading::all(tail, has_letters_of)))
}

/// Returns the unit in the name of a column, at its end if possible. A word of several meanings is a unit if its quantity is
/// `meant`.
fn in_name<'a>(name: &'a str, meant: Option<Meant>) -> Option<&'a str> {
    let is_meant = |text: &&str| meant.is_some_and(|meant| is_of_quantity(text, meant));
    let is_long = |text: &&str| text.chars().count() > 1;
    let is_exact = |text: &&str| is_sure(&Reading::all(text, has_letters_of));
    let whole = || Some(name).filter(|name| is_long(name) && is_sure(&readings(name)) && is_meant(name));
    // `zmm`, `Fxmm`
    let behind_symbol = || {
        let mut chars = name.char_indices();
        let first = chars.next().filter(|(_, c)| c.is_alphabetic())?.1.len_utf8();
        let second = chars.next().filter(|(_, c)| matches!(c, 'x' | 'y' | 'z' | '0'..='9')).map(|_| first + 1);
        let rests = [Some(first), second].into_iter().flatten().map(|at| &name[at..]);
        rests.filter(is_long).filter(is_exact).find(is_meant)
    };
    let words = || {
        let marks =
            |c: char| matches!(c, '_' | ' ' | '.' | '-' | '|' | ',' | '(' | ')' | '[' | ']' | '{' | '}' | '<' | '>');
        name.split(marks).filter(is_long).filter(is_exact).find(is_meant)
    };
    // The longest: `N_per_m` is not in metres.
    let ends = [tails(name, &SEPARATORS).find(is_meant), suffix(name)];
    let end = ends.into_iter().flatten().max_by_key(|unit| unit.len());
    end.or_else(whole).or_else(behind_symbol).or_else(words)
}

/// Returns the unit of the column `name` with the cell `row` of a unit row: of the row, else of the name.
pub(super) fn of_column<'a>(name: &'a str, row: Option<&'a str>, meant: Option<Meant>) -> Option<&'a str> {
    given(name, row).or_else(|| in_name(name, meant))
}

/// Returns the unit of the unit row, else the one in brackets.
fn given<'a>(name: &'a str, row: Option<&'a str>) -> Option<&'a str> {
    let row = row.filter(|cell| !cell.is_empty()).map(|cell| bracketed(cell).unwrap_or(cell));
    row.or(split_name(name).1)
}

/// Returns the two units of the column `name` with the cell `row` of a unit row, if they contradict each other.
pub(super) fn contradiction<'a>(name: &'a str, row: Option<&'a str>) -> Option<[&'a str; 2]> {
    let (suffix, given) = (suffix(split_name(name).0)?, given(name, row)?);
    let (one, other) = (readings(suffix), readings(given));
    let agree = |a: &Reading| other.iter().any(|b| (a.size / b.size - 1.0).abs() <= 1e-9);
    (!other.is_empty() && !one.iter().any(agree)).then_some([suffix, given])
}

/// Returns the size of `unit` in the SI unit of the same quantity; `None` for SI units and unknown ones.
pub(crate) fn si_factor(unit: &str) -> Option<f64> {
    size(unit).filter(|size| *size != 1.0)
}

/// Returns whether `unit` has no size in an SI unit, or several.
pub(crate) fn is_without_size(unit: &str) -> bool {
    size(unit).is_none()
}

/// Returns whether `unit` is the degree.
pub(crate) fn is_degree(unit: &str) -> bool {
    readings(unit).iter().any(|one| one.of == NUMBER && one.size == PI / 180.0)
}

/// Returns whether `unit` is one of time other than the second. Columns of other values have none: `min` is the least.
pub(crate) fn is_time_span(unit: &str) -> bool {
    let all = readings(unit);
    !all.is_empty() && all.iter().all(|one| one.of == TIME && one.size != 1.0)
}
