//! Records: columns of tables as laws and references of a run, with notes on their layout, units and span.

use super::{
    context::{Context, FileNote},
    files,
    untagged::CoordinateUnit,
};
use crate::{
    error::{Error, ErrorCode, Result},
    math::{
        format::three_digits,
        table::{self, ColumnName, Conversion, TableReader},
        time_series::{SampleScaling, TimeSeries},
    },
};

/// A record is probably not in seconds if its part outside the run is this many times as long as the run.
const MUCH_LONGER: f64 = 20.0;

/// Largest difference between the spacings of even samples, over their mean, –.
const UNEVEN: f64 = 0.01;

/// Largest difference between a given factor and that of a unit, over it, –: 0.0175 is that from degrees to radians.
const SAME_FACTOR: f64 = 0.005;

/// Values by which loggers mark missing ones.
const MISSING: [f64; 6] = [-999.0, -9999.0, -99999.0, 999.0, 9999.0, 99999.0];

/// A value that marks a missing one is at least this many times larger than all others.
const FAR_OFF: f64 = 10.0;

/// The law outside the span of its record.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Outside {
    /// It holds the end values.
    Holds,
    /// It repeats the waves of the record before the span, and is at rest after it.
    Waves,
}

/// A column of a table that a run uses.
pub(super) struct Record<'a> {
    pub(super) ctx: &'a Context<'a>,
    /// The key of the scene with the file.
    pub(super) key: &'a str,
    /// Name of the file.
    pub(super) file: &'a str,
    pub(super) table: TableReader,
    pub(super) time: ColumnName,
    pub(super) column: ColumnName,
    pub(super) scaling: SampleScaling,
    /// The unit in which the values are meant; `None` if it is not known.
    pub(super) unit: Option<&'a str>,
}

/// Returns the scaling with these values of `scale`, `time_factor` and `offset`.
pub(super) fn scaling([scale, time_factor, offset]: [Option<f64>; 3]) -> SampleScaling {
    let usual = SampleScaling::default();
    SampleScaling {
        scale: scale.unwrap_or(usual.scale),
        time_factor: time_factor.unwrap_or(usual.time_factor),
        offset: offset.unwrap_or(usual.offset),
    }
}

/// Refuses a scale of zero or infinity, a time factor that is not positive and an infinite offset.
pub(super) fn verify_scaling(ctx: &Context, key: &str, [scale, factor, offset]: [Option<f64>; 3]) -> Result<()> {
    ctx.require_positive(&format!("{key}.time_factor"), factor)?;
    if let Some(scale) = scale.filter(|x| !x.is_finite() || *x == 0.0) {
        let what = format!("scale is a factor other than 0, not {scale}");
        return Err(ctx.error_with_help(&format!("{key}.scale"), what, "write  scale = 1.0, or remove the law"));
    }
    match offset.filter(|x| !x.is_finite()) {
        Some(offset) => Err(ctx.error_at(&format!("{key}.offset"), format!("offset is a time, s, not {offset}"))),
        None => Ok(()),
    }
}

/// Returns the advice to name a column of this file, with its columns if it can be read.
pub(super) fn column_help(ctx: &Context, file: &str) -> String {
    let table = files::open_table(ctx.folder(), file).ok();
    let names = table.as_ref().map(TableReader::column_names).unwrap_or_default();
    match &names[..] {
        [] => "write  column = ..,  the name or the number of a column".into(),
        [.., last] if table.is_some_and(|table| table.header().is_empty()) => {
            format!("write  column = {last},  or another of its columns: {}", names.join(", "))
        }
        [.., last] => format!("write  column = \"{last}\",  or another of its columns: {}", names.join(", ")),
    }
}

/// Adds the note that the table at `key` was not read as a table with commas, decimal points and a header.
pub(super) fn note_layout(ctx: &Context, key: &str, file: &str, table: &TableReader) {
    let Some(remark) = table.remark() else { return };
    ctx.add_note(FileNote {
        is_warning: false,
        topic: "table_layout",
        what: format!("{file} ({}) is read so: {remark}", ctx.shown_key(key)),
        remedy: "a table with commas, decimal points and the names in its first line needs no such note".into(),
    });
}

impl Context<'_> {
    /// Returns the error of placed or connected solids, with the warnings about the values of records, which may be its cause.
    pub(super) fn with_warnings(&self, error: Error) -> Error {
        let help = error.help.clone().unwrap_or_default();
        let notes = self.file_notes.borrow();
        let of_values =
            |note: &&FileNote| note.is_warning && note.topic.starts_with("record_") && !help.contains(&note.what);
        let mut lines: Vec<String> = help.lines().map(String::from).collect();
        lines.extend(notes.iter().filter(of_values).map(|note| format!("warning: {}: {}", note.what, note.remedy)));
        if lines.is_empty() { error } else { error.help(lines.join("\n")) }
    }
}

/// Returns the error of a law from the record at `key`, with the remedies of the notes on the record's units.
pub(super) fn with_unit_notes(ctx: &Context, key: &str, error: Error) -> Error {
    let place = format!("({})", ctx.shown_key(key));
    let is_of_unit = |note: &&FileNote| match note.topic {
        "record_unit" | "record_missing" => note.is_warning,
        "record_span" => note.remedy.contains("time_factor"),
        _ => false,
    };
    let notes = ctx.file_notes.borrow();
    let found = notes.iter().filter(|note| note.what.contains(&place)).filter(is_of_unit);
    let mut help: Vec<String> = found.map(|note| format!("{}: {}", note.what, note.remedy)).collect();
    if help.is_empty() {
        return error;
    }
    help.extend(error.help.clone());
    error.help(help.join("; else "))
}

impl Record<'_> {
    /// Returns the samples of the table in its own scale and on its own clock. Adds notes on layout and units.
    ///
    /// # Errors
    /// The errors of [`TableReader::series`], at the key of the column.
    pub(super) fn read(&mut self) -> Result<TimeSeries> {
        self.require_time()?;
        self.samples().map_err(|e| self.at("column", files::with_line_in_message(e)))
    }

    /// Returns `error` with the location of a key of the record.
    fn at(&self, word: &str, error: Error) -> Error {
        self.ctx.with_location(error, &format!("{}.{word}", self.key))
    }

    /// Returns the samples of the table, with notes on its layout, its units and missing values.
    fn samples(&mut self) -> Result<TimeSeries> {
        let time = self.table.time_column(&self.time, &self.column);
        let series = self.table.series(time.clone(), self.column.clone())?;
        note_layout(self.ctx, self.key, self.file, &self.table);
        self.note_missing(&series);
        let unit = self.table.unit_as(time.clone(), Some(("s", self.ctx.dimension)))?;
        self.note_factor(&time, unit.as_deref(), Some("s"), ("time_factor", self.scaling.time_factor));
        let unit = self.table.unit_as(self.column.clone(), self.unit.map(|unit| (unit, self.ctx.dimension)))?;
        let value = unit.as_deref().filter(|unit| !table::is_time_span(unit));
        self.note_factor(&self.column, value, self.unit, ("scale", self.scaling.scale));
        if self.table.is_one_column(&time, &self.column) {
            self.ctx.add_note(FileNote::note(
                "record_unit",
                format!(
                    "column \"{}\" of {} ({}) is the column of times: the value at each time is the time itself",
                    self.column,
                    self.file,
                    self.ctx.shown_key(self.key)
                ),
                "name the column of values with  column = ..".into(),
            ));
        }
        Ok(series)
    }

    /// Adds a warning if samples have a value by which loggers mark missing values, far from all other samples.
    fn note_missing(&self, series: &TimeSeries) {
        let values = series.values();
        let Some(code) = MISSING.into_iter().find(|code| values.contains(code)) else { return };
        let others = values.iter().filter(|x| **x != code).fold(0.0, |most: f64, x| most.max(x.abs()));
        let marked: Vec<f64> =
            series.times().iter().zip(values).filter(|(_, x)| **x == code).map(|(t, _)| *t).collect();
        if code.abs() <= FAR_OFF * others || marked.len() == values.len() {
            return;
        }
        self.ctx.add_note(FileNote {
            is_warning: true,
            topic: "record_missing",
            what: format!(
                "column \"{}\" of {} ({}) has the value {code} at {} of its {} times, the first {}: loggers write it for a missing \
                 value, and it is used as it is",
                self.column,
                self.file,
                self.ctx.shown_key(self.key),
                marked.len(),
                values.len(),
                rounded(marked[0]),
            ),
            remedy: "remove the lines with it: the law goes on between those around them".into(),
        });
    }

    /// Refuses a column of times that the table does not have.
    ///
    /// # Errors
    /// `Scene` at the key of the column of times, with a column that may be meant.
    fn require_time(&mut self) -> Result<()> {
        let time = self.table.time_column(&self.time, &self.column);
        let names = self.table.header();
        let value = self.column.to_string();
        let Err(error) = self.table.unit(time) else { return Ok(()) };
        let is_missing = self.time == ColumnName::from("t_s") && error.code() == ErrorCode::UnknownName;
        let is_other = |name: &&String| **name != value && !name.is_empty();
        let other = names.iter().find(is_other).filter(|_| is_missing);
        let error = match other {
            Some(name) => {
                let all = names.join(", ");
                let help = format!("name the column of times, as in  time = \"{name}\"; its columns: {all}");
                error.help(help)
            }
            None => error,
        };
        Err(self.at("time", files::with_line_in_message(error)))
    }

    /// Takes the unit in which a law is meant, and returns the factor from the column's values to those of the run. The name or
    /// the row of units shows that a column is in degrees. Adds notes on their conversion.
    ///
    /// # Errors
    /// `Scene` at the key of the column, if there is no such column.
    pub(super) fn take_unit(&mut self, law: CoordinateUnit) -> Result<f64> {
        if let CoordinateUnit::Si(unit) = law {
            self.unit = Some(unit);
            return Ok(1.0);
        }
        let meant = if law == CoordinateUnit::Degrees { "deg" } else { "rad" };
        self.require_time()?;
        let unit = self.table.unit_as(self.column.clone(), Some((meant, self.ctx.dimension)));
        let unit = unit.map_err(|e| self.at("column", e))?;
        let named = unit.as_deref().filter(|unit| table::is_degree(unit));
        if law == CoordinateUnit::Radians && named.is_none() {
            self.unit = Some("rad");
            return Ok(1.0);
        }
        self.unit = Some("deg");
        let factor = 1f64.to_radians();
        let (scale, column) = (self.scaling.scale, self.named_column());
        if (scale.abs() / factor - 1.0).abs() < SAME_FACTOR {
            self.ctx.add_note(FileNote::warning(
                "record_unit",
                format!("{column} is converted from degrees to radians, and again by scale = {scale}"),
                "remove scale".into(),
            ));
        }
        if let Some(unit) = named.filter(|unit| law == CoordinateUnit::Radians && table::is_assumed(unit)) {
            self.ctx.add_note(FileNote::note(
                "record_unit",
                format!("{column} is in \"{unit}\", which is taken as degrees"),
                "give values in radians a name that ends in _rad".into(),
            ));
        }
        Ok(factor)
    }

    /// Returns the column with its file and key, for messages.
    fn named_column(&self) -> String {
        format!("column \"{}\" of {} ({})", self.column, self.file, self.ctx.shown_key(self.key))
    }

    /// Adds the warning that the `factor` of a column does not fit its `unit`.
    fn note_factor(&self, column: &ColumnName, unit: Option<&str>, meant: Option<&str>, (key, factor): (&str, f64)) {
        if factor == 1.0 {
            self.note_unit(column, unit, meant, key);
        } else {
            self.note_inverse(column, unit, meant, (key, factor));
        }
    }

    /// Adds the warning that a column is in another `unit` than the one in which its values are `meant`.
    fn note_unit(&self, column: &ColumnName, unit: Option<&str>, meant: Option<&str>, key: &str) {
        let Some(unit) = unit else { return };
        let write = |factor: f64| format!("write  {key} = {factor}  beside the column");
        let conversion = meant.and_then(|meant| Some((meant, table::conversion(unit, meant, self.ctx.dimension)?)));
        let (used, remedy) = match conversion {
            Some((_, Conversion::Factor(factor))) if (factor - 1.0).abs() < 1e-9 => return,
            Some((meant, Conversion::Factor(factor))) => {
                let assumed = format!("; 1 {unit} is taken as {} {meant}", three_digits(factor));
                let assumed = if table::is_assumed(unit) { assumed } else { String::new() };
                (format!("used as if in {meant}"), write(factor) + &assumed)
            }
            Some((meant, Conversion::Weight(factor))) => {
                let weight = format!("; the weight of 1 {unit} is {} {meant}", three_digits(factor));
                (format!("a mass, where {meant} is meant"), write(factor) + &weight)
            }
            Some((meant, Conversion::OtherQuantity)) => {
                let remedy = format!("name a column in {meant}, or write the factor to {meant} as  {key} = ..");
                (format!("another quantity than {meant}, in which its values are used"), remedy)
            }
            None => match table::si_factor(unit) {
                Some(factor) => ("used as if in another unit".into(), write(factor)),
                None => return self.note_unknown_unit(column, unit, meant, key),
            },
        };
        self.ctx.add_note(FileNote::warning(
            "record_unit",
            format!(
                "column \"{column}\" of {} ({}) is in {unit}, and is {used}",
                self.file,
                self.ctx.shown_key(self.key)
            ),
            remedy,
        ));
    }

    /// Adds the warning that the given `factor` of a column is the inverse of that from its `unit` to the one `meant`.
    fn note_inverse(&self, column: &ColumnName, unit: Option<&str>, meant: Option<&str>, (key, factor): (&str, f64)) {
        let Some((unit, meant)) = unit.zip(meant) else { return };
        let Some(Conversion::Factor(right)) = table::conversion(unit, meant, self.ctx.dimension) else { return };
        let is_same = |ratio: f64| (ratio.abs() - 1.0).abs() < SAME_FACTOR;
        if !is_same(factor * right) || is_same(factor / right) {
            return;
        }
        let (file, shown) = (self.file, self.ctx.shown_key(self.key));
        self.ctx.add_note(FileNote::warning(
            "record_unit",
            format!(
                "column \"{column}\" of {file} ({shown}) is in {unit}, and {key} = {factor} is the inverse of the factor to \
                 {meant}"
            ),
            format!("write  {key} = {}  beside the column", right.copysign(factor)),
        ));
    }

    /// Adds the note that a column is in a `unit` whose size is not known.
    fn note_unknown_unit(&self, column: &ColumnName, unit: &str, meant: Option<&str>, key: &str) {
        if !table::is_without_size(unit) {
            return;
        }
        let (file, shown) = (self.file, self.ctx.shown_key(self.key));
        let si = meant.unwrap_or("SI units");
        self.ctx.add_note(FileNote::note(
            "record_unit",
            format!(
                "column \"{column}\" of {file} ({shown}) is in \"{unit}\", which has no one meaning as a unit; its \
                     values are taken as if in {si}"
            ),
            match meant {
                Some(meant) => format!("write the size of the unit in {meant} as  {key} = ..  beside the column"),
                None => format!("write the size of the unit, as in  {key} = 0.001,  beside the column"),
            },
        ));
    }

    /// Adds a note if the samples of `series` are not evenly spaced, of a record that is read at even times.
    pub(super) fn note_uneven(&self, series: &TimeSeries) {
        let gaps: Vec<f64> = series.times().windows(2).map(|ab| (ab[1] - ab[0]) * self.scaling.time_factor).collect();
        let (least, most) = gaps.iter().fold((f64::INFINITY, 0.0), |(a, b): (f64, f64), x| (a.min(*x), b.max(*x)));
        let mean = gaps.iter().sum::<f64>() / gaps.len() as f64;
        if gaps.is_empty() || most - least <= UNEVEN * mean {
            return;
        }
        self.ctx.add_note(FileNote::note(
            "record_uneven",
            format!(
                "record {}, column \"{}\" ({}), has samples {} to {} s apart: its waves are those of the curve through \
                 them, read every {} s",
                self.file,
                self.column,
                self.ctx.shown_key(self.key),
                three_digits(least),
                three_digits(most),
                three_digits(mean),
            ),
            "give evenly spaced samples, or check the sea with a gauge".into(),
        ));
    }

    /// Adds a note if the record, with the samples `series` on its own clock, does not cover the run.
    pub(super) fn note_span(&self, series: &TimeSeries, outside: Outside) {
        let SampleScaling { scale, time_factor, offset } = self.scaling;
        let until = self.ctx.until;
        let times = series.times();
        let on_run = |t: f64| t * time_factor + offset;
        let (first, last) = (on_run(times[0]), on_run(times[times.len() - 1]));
        let round_off = 1e-9 * until.max(first.abs()).max(last.abs());
        let values = series.values();
        let (begin, end) = (values[0] * scale, values[values.len() - 1] * scale);
        let holds = outside == Outside::Holds;
        let late = (first > round_off).then(|| match holds {
            true => format!("begins after the run starts and holds its first value, {begin}, until then"),
            false => "begins after the run starts, with waves of its periodic continuation until then".into(),
        });
        let early = (last < until - round_off).then(|| match holds {
            true => format!("ends within the run and holds its last value, {end}, from then on"),
            false => "ends within the run, and the paddle rests from then on".into(),
        });
        let apart = first >= until - round_off || last <= round_off;
        let long = last - first > MUCH_LONGER * until
            && times.iter().filter(|t| (0.0..=until).contains(&on_run(**t))).count() < 3;
        let start = format!("write  offset = {}  to begin the record with the run", rounded(offset - first));
        let milliseconds = format!("if its times are in ms, write  time_factor = {}", 1e-3 * time_factor);
        let (what, remedy) = match (late, early) {
            _ if apart && holds => {
                let value = if first > 0.0 { begin } else { end };
                (format!("has no time in common with the run, which has its value {value} throughout"), start)
            }
            _ if apart => ("has no time in common with the run".into(), start),
            _ if long => ("has fewer than three samples within the run".into(), milliseconds.clone()),
            (Some(late), Some(early)) => (format!("{late}; it {early}"), start),
            (Some(late), None) => (late, start),
            (None, Some(early)) => {
                (early, format!("end the run with  until = {}, or lengthen the record", rounded(last)))
            }
            (None, None) => return,
        };
        let remedy =
            if apart && last - first > MUCH_LONGER * until { format!("{remedy}; {milliseconds}") } else { remedy };
        self.ctx.add_note(FileNote {
            is_warning: apart,
            topic: "record_span",
            what: format!(
                "record {}, column \"{}\" ({}), from {} to {} s of a run from 0 to {until} s, {what}",
                self.file,
                self.column,
                self.ctx.shown_key(self.key),
                rounded(first),
                rounded(last),
            ),
            remedy,
        });
    }
}

/// Returns a time (s) without the round-off of sums.
fn rounded(t: f64) -> f64 {
    let unit = 1e9;
    if t.abs() < 1e5 { (t * unit).round() / unit + 0.0 } else { t }
}
