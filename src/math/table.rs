//! Tables of numbers in text files: rows of cells, usually below a row of names.
//!
//! Separators are commas, semicolons, tabs or blanks; decimal signs are points or commas. The reader detects these and
//! the rows of names and units. It refuses a file with several interpretations. It describes the layout in its remarks.

mod cell;
mod column_name;
mod encoding;
mod layout;
mod unit;

use std::{array, path::Path};

use super::time_series::TimeSeries;
use crate::error::{Error, ErrorCode, Result, suggestion};
pub use column_name::ColumnName;
use layout::Layout;
pub(crate) use unit::{
    Conversion, Meant, conversion, is_assumed, is_degree, is_time_span, is_without_size, of_series, si_factor,
};

/// The name of the column of times in the tables of a run.
const OWN_TIME: &str = "t_s";

/// Other names of a column of times, in lower case and without unit.
const TIMES: [&str; 8] = ["t", "t_s", "time", "times", "time_s", "time_ms", "t_ms", "zeit"];

/// Most columns that a remark lists.
const LISTED: usize = 8;

/// A table whose layout is known. The methods that return columns read its rows.
pub struct TableReader {
    file: String,
    text: String,
    layout: Layout,
    /// Remarks of the columns that were read.
    remarks: Vec<String>,
}

impl TableReader {
    /// The table at `path`.
    ///
    /// # Errors
    /// `File` if it cannot be read. `Scene` if it is not a text, or has more than one interpretation: the error names them.
    pub fn open(path: &Path) -> Result<Self> {
        let bytes = std::fs::read(path).map_err(|why| Error::read(path, &why))?;
        let (text, encoding) = encoding::decode(path, &bytes)?;
        let file = path.display().to_string();
        let mut layout = Layout::of(&text).map_err(|e| Error { message: format!("{file}: {}", e.message), ..e })?;
        layout.remarks.splice(0..0, encoding);
        Ok(Self { file, text, layout, remarks: Vec::new() })
    }

    /// The path of the table, for messages.
    pub fn file(&self) -> &str {
        &self.file
    }

    /// The names of the columns; empty if the table has no row of names that fits its rows.
    pub fn header(&self) -> &[String] {
        &self.layout.names
    }

    /// The names of the columns, or their numbers from 1 where the table has no names.
    pub(crate) fn column_names(&self) -> Vec<String> {
        match self.layout.names.is_empty() {
            true => (1..=self.layout.count).map(|number| number.to_string()).collect(),
            false => self.layout.names.clone(),
        }
    }

    /// How the table was read, as one sentence, if it is not a table with commas, decimal points and a header.
    pub fn remark(&self) -> Option<String> {
        let mut remarks = self.layout.remarks.clone();
        if !remarks.is_empty() && !self.layout.names.is_empty() {
            let names = self.layout.names.iter().take(LISTED).map(|name| format!("\"{name}\""));
            let more = if self.layout.names.len() > LISTED { ", .." } else { "" };
            remarks.push(format!("columns {}{more}", names.collect::<Vec<_>>().join(", ")));
        }
        remarks.extend(self.remarks.iter().cloned());
        (!remarks.is_empty()).then(|| remarks.join("; "))
    }

    /// The unit of a column, from the row of units or from its name; `None` if there is none.
    ///
    /// # Errors
    /// As [`TableReader::columns`], if there is no such column; `Scene` if it has two units that contradict each other.
    pub fn unit(&self, column: impl Into<ColumnName>) -> Result<Option<String>> {
        self.unit_as(column, None)
    }

    /// As [`TableReader::unit`], of a column whose values are meant in a known unit: more names have one then, as `x_in`.
    pub(crate) fn unit_as(&self, column: impl Into<ColumnName>, meant: Option<Meant>) -> Result<Option<String>> {
        let i = self.index(&column.into())?;
        let name = self.layout.names.get(i).map_or("", String::as_str);
        let row = self.layout.units.get(i).map(String::as_str);
        match unit::contradiction(name, row) {
            Some([one, other]) => {
                let what = format!("column \"{name}\" of {} has two units, {one} and {other}", self.file);
                Err(Error::scene(what).help("keep the one in which its values are"))
            }
            None => Ok(unit::of_column(name, row, meant).map(String::from)),
        }
    }

    /// Whether two names mean one column.
    pub(crate) fn is_one_column(&self, one: &ColumnName, other: &ColumnName) -> bool {
        matches!((self.index(one), self.index(other)), (Ok(one), Ok(other)) if one == other)
    }

    /// The columns `names`. Rows without a value in one of them are skipped.
    ///
    /// # Errors
    /// `Scene` if a column is missing or its name stands twice, a row is longer or shorter than the others, or a cell is not a
    /// finite number; in the last two cases the location is the line.
    pub fn columns<C: Into<ColumnName>, const N: usize>(&mut self, names: [C; N]) -> Result<[Vec<f64>; N]> {
        Ok(self.columns_and_lines(names.map(Into::into))?.0)
    }

    /// As [`TableReader::columns`], but a row without some of the values is refused.
    ///
    /// # Errors
    /// As [`TableReader::columns`]; `Scene` if a row has a value in one of the columns, and none in another.
    pub(crate) fn complete_columns<C: Into<ColumnName>, const N: usize>(
        &mut self,
        names: [C; N],
    ) -> Result<[Vec<f64>; N]> {
        let names = names.map(Into::into);
        let mut indices = [0; N];
        for (index, name) in indices.iter_mut().zip(&names) {
            *index = self.index(name)?;
        }
        for (line, cells) in self.rows().filter(|(_, cells)| cells.len() == self.layout.count) {
            let missing = indices.iter().position(|i| cell::is_missing(cells[*i]));
            if let Some(first) = missing.filter(|_| indices.iter().any(|i| !cells[*i].is_empty())) {
                let error = Error::scene("a row has no value").help("write the value, or remove the row");
                return Err(error.at(self.file.as_str(), Some((line, 1)), names[first].to_string()));
            }
        }
        self.columns(names)
    }

    /// The columns, and the lines of their rows.
    fn columns_and_lines<const N: usize>(&mut self, names: [ColumnName; N]) -> Result<([Vec<f64>; N], Vec<usize>)> {
        let mut indices = [0; N];
        for (index, name) in indices.iter_mut().zip(&names) {
            *index = self.index(name)?;
        }
        let mut columns = array::from_fn(|_| Vec::new());
        let (mut lines, mut missing) = (Vec::new(), Vec::new());
        for (line, cells) in self.rows() {
            let at = |error: Error, name: &str| error.at(self.file.as_str(), Some((line, 1)), name);
            if cells.len() != self.layout.count {
                return Err(at(self.wrong_length(&cells), ""));
            }
            let cells = indices.map(|i| cells[i]);
            if cells.iter().any(|cell| cell::is_missing(cell)) {
                // A blank cell is a common way to leave a value out; a remark names the other missing values.
                missing.extend(cells.iter().any(|cell| !cell.is_empty() && cell::is_missing(cell)).then_some(line));
                continue;
            }
            for ((column, cell), name) in columns.iter_mut().zip(cells).zip(&names) {
                let x = cell::number(cell, self.layout.decimal).filter(|x| x.is_finite());
                column.push(x.ok_or_else(|| at(cell::error(cell, self.layout.decimal), &name.to_string()))?);
            }
            lines.push(line);
        }
        match missing[..] {
            [] => {}
            [line] => self.remarks.push(format!("line {line} has no value and is skipped")),
            [line, ..] => {
                self.remarks.push(format!("{} rows, from line {line}, have no value and are skipped", missing.len()))
            }
        }
        Ok((columns, lines))
    }

    /// The columns of the coordinates of points: `x_m` and `y_m`, else `x` and `y`, else the two of a table without names.
    pub(crate) fn point_columns(&mut self) -> [ColumnName; 2] {
        let has = |names: [&str; 2]| names.iter().all(|name| self.index(&ColumnName::from(*name)).is_ok());
        let found = match (has(["x_m", "y_m"]), has(["x", "y"])) {
            (false, true) => [ColumnName::from("x"), ColumnName::from("y")],
            (false, false) if self.layout.names.is_empty() && self.layout.count == 2 => [1, 2].map(ColumnName::Number),
            _ => return ["x_m", "y_m"].map(ColumnName::from),
        };
        self.remarks.push(format!("x and y from the columns {} and {}", found[0], found[1]));
        found
    }

    /// All columns, NaN where a cell is blank or no number. Only complete rows with a number in the first column count,
    /// so the cut last row of a stopped run does not.
    pub fn all_columns(&self) -> Vec<Vec<f64>> {
        self.columns_and_damage().0
    }

    /// As [`TableReader::all_columns`], and the numbers of the lines where it leaves out a row or a cell that is no number. These
    /// exclude the last row: a stopped run may have cut it.
    pub(crate) fn columns_and_damage(&self) -> (Vec<Vec<f64>>, Vec<usize>) {
        let mut columns = vec![Vec::new(); self.layout.count];
        let number = |cell: &str| cell::number(cell, self.layout.decimal);
        // Lines, with the column of a cell that is no number.
        let (mut unread, mut last): (Vec<(usize, Option<usize>)>, usize) = (Vec::new(), 0);
        for (line, cells) in self.rows() {
            last = line;
            if cells.len() != columns.len() || !number(cells[0]).is_some_and(f64::is_finite) {
                unread.push((line, None));
                continue;
            }
            for (i, (column, cell)) in columns.iter_mut().zip(cells).enumerate() {
                let value = number(cell);
                column.push(value.unwrap_or(f64::NAN));
                if value.is_none() && !cell::is_missing(cell) {
                    unread.push((line, Some(i)));
                }
            }
        }
        let has_numbers: Vec<bool> = columns.iter().map(|column| column.iter().any(|x| !x.is_nan())).collect();
        unread.retain(|(line, column)| *line != last && column.is_none_or(|i| has_numbers[i]));
        unread.dedup_by_key(|(line, _)| *line);
        (columns, unread.into_iter().map(|(line, _)| line).collect())
    }

    /// The series of `column` over the column `time`. If the table has no column `"t_s"`, this name means the column with another
    /// name of a time. In a table without names, or beside a `column` given by its number, it means the first column.
    ///
    /// # Errors
    /// As [`TableReader::columns`]; `Scene` if the times do not increase: says in which line.
    pub fn series(&mut self, time: impl Into<ColumnName>, column: impl Into<ColumnName>) -> Result<TimeSeries> {
        let column = column.into();
        let time = self.time_column(&time.into(), &column);
        let ([t, x], lines) = self.columns_and_lines([time.clone(), column.clone()])?;
        if let Some(i) = (1..t.len()).find(|&i| t[i] <= t[i - 1]) {
            let what = format!("times must increase: {} follows {}", t[i], t[i - 1]);
            let help = match t[i] == t[i - 1] {
                true => "write the times with more digits, and give a jump two times, as in 1.0 and 1.001",
                false => "sort the rows",
            };
            return Err(Error::scene(what).help(help).at(self.file.as_str(), Some((lines[i], 1)), time.to_string()));
        }
        TimeSeries::new(t, x).map_err(|e| Error { message: format!("{}, {column}: {}", self.file, e.message), ..e })
    }

    /// The column of times that `time` means beside the values in `column`.
    pub(crate) fn time_column(&mut self, time: &ColumnName, column: &ColumnName) -> ColumnName {
        let names = &self.layout.names;
        if *time != ColumnName::Name(OWN_TIME.into()) || names.iter().any(|name| name == OWN_TIME) {
            return time.clone();
        }
        let is_numbered = matches!(column, ColumnName::Number(number) if *number > 1) && !self.layout.counts_rows;
        let found = match names.iter().filter(|name| is_time(name)).collect::<Vec<_>>()[..] {
            [name] => ColumnName::Name(name.clone()),
            _ if is_numbered || (names.is_empty() && self.layout.unfit.is_none() && self.layout.count > 0) => {
                ColumnName::Number(1)
            }
            _ => return time.clone(),
        };
        let told = match &found {
            ColumnName::Number(number) => format!("times from column {number}"),
            ColumnName::Name(name) => format!("times from column \"{name}\""),
        };
        if !self.remarks.contains(&told) {
            self.remarks.push(told);
        }
        found
    }

    /// The rows of numbers with their lines.
    fn rows(&self) -> impl Iterator<Item = (usize, Vec<&str>)> {
        let lines = self.text.lines().enumerate().skip(self.layout.first.saturating_sub(1));
        let lines = lines.filter(|(_, line)| !line.trim().is_empty() && layout::comment(line).is_none());
        lines.map(|(i, line)| (i + 1, self.layout.cells(line)))
    }

    /// The error of a row with these cells, which are too few or too many.
    fn wrong_length(&self, cells: &[&str]) -> Error {
        let header = if self.layout.names.is_empty() { "the others" } else { "its header" };
        let (count, plural) = (cells.len(), if cells.len() == 1 { "" } else { "s" });
        let error = Error::scene(format!("a row has {count} cell{plural}, {header} {}", self.layout.count));
        let is_text = !cells.iter().any(|cell| cell::number(cell, self.layout.decimal).is_some());
        error.help(match is_text {
            true => "write # before a line that is no row",
            false => "leave a cell blank where a value is missing",
        })
    }

    /// The error of a row that was taken for the names, if the column `name` is in the row above it.
    fn error_of_units(&self, name: &str) -> Option<Error> {
        let names = &self.layout.names;
        let (line, above) = self.layout.above_names.as_ref()?;
        above.iter().find(|above| *above == name || (name == OWN_TIME && is_time(above)))?;
        let known = "such as m, mm, N, kN, rad, deg, s";
        if !names.iter().any(|unit| unit::is_known(unit)) {
            let what = format!("{} has two rows of names, and line {line} is used", self.file);
            return Some(Error::scene(what).help(format!("remove one of them, or write known units, {known}")));
        }
        let unknown = names.iter().filter(|unit| !unit.is_empty() && !unit::is_unit(unit));
        let unknown: Vec<String> = unknown.map(|unit| format!("\"{unit}\"")).collect();
        let what = format!("{} has an unknown unit, {} in line {line}", self.file, unknown.join(", "));
        let error = Error::scene(what).help(format!("write a known one, {known}, or remove the line"));
        (!unknown.is_empty()).then_some(error)
    }

    /// The place of the column `name`.
    fn index(&self, name: &ColumnName) -> Result<usize> {
        let (names, count) = (&self.layout.names, self.layout.count);
        if count == 0 {
            let what = if self.text.trim().is_empty() { "is empty" } else { "has comments alone" };
            return Err(Error::scene(format!("{} {what}", self.file)).help("write its rows, or name another file"));
        }
        let missing = |what: String| Error::scene(format!("{} {what}", self.file)).with_code(ErrorCode::UnknownName);
        let name = match name {
            ColumnName::Number(number) => {
                let index = usize::try_from(*number).ok().and_then(|n| n.checked_sub(1)).filter(|i| *i < count);
                return index.ok_or_else(|| {
                    missing(format!("has no column {number}")).help(format!("it has {count}, counted from 1"))
                });
            }
            ColumnName::Name(name) => name,
        };
        let fitting = |fits: &dyn Fn(&str) -> bool| -> Vec<usize> {
            names.iter().enumerate().filter(|(_, column)| fits(column)).map(|(i, _)| i).collect()
        };
        let mut found = fitting(&|column| column == name);
        if found.is_empty() {
            found = fitting(&|column| unit::split_name(column).0 == name);
        }
        match found[..] {
            [one] => Ok(one),
            [] if names.is_empty() => Err(match self.layout.unfit {
                Some(unfit) => {
                    let first = if self.layout.counts_rows { ", the first of which numbers the rows" } else { "" };
                    missing(format!("has {unfit} names over rows of {count} cells{first}")).help(format!(
                        "name every column, or give the number of the column, from 1 to {count}, without quotation marks"
                    ))
                }
                None => missing(format!("has no row of names, so no column \"{name}\""))
                    .help(format!("give the number of the column, from 1 to {count}, as in  column = 2")),
            }),
            [] => {
                if let Some(error) = self.error_of_units(name) {
                    return Err(error);
                }
                let guess = suggestion(name, names.iter().map(String::as_str));
                let is_number = name.parse().is_ok_and(|number: usize| (1..=count).contains(&number));
                let number = if is_number { format!("write {name} without quotation marks; ") } else { String::new() };
                let help = format!("{number}its columns: {}", names.join(", "));
                Err(missing(format!("has no column \"{name}\"{guess}")).help(help))
            }
            [first, second, ..] => Err(missing(format!("has more than one column \"{name}\"")).help(format!(
                "give the number of the column: {} or {}",
                first + 1,
                second + 1
            ))),
        }
    }
}

/// Returns whether a column of this name has times.
fn is_time(name: &str) -> bool {
    TIMES.contains(&unit::split_name(name).0.to_lowercase().as_str())
}

#[cfg(test)]
#[path = "../../tests/unit/math/table.rs"]
mod tests;
