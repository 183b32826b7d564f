//! Tables of numbers in text files: a header row, then a row of cells a line. Lines that begin with `#` are comments.

use std::{array, fs::File, path::Path};

use super::time_series::TimeSeries;
use crate::error::{Error, ErrorCode, Result, suggestion};

/// A table whose header is read. The methods that return columns read its rows.
pub struct TableReader {
    file: String,
    header: Vec<String>,
    reader: csv::Reader<File>,
}

impl TableReader {
    /// The table at `path`.
    ///
    /// # Errors
    /// `File` if it cannot be read.
    pub fn open(path: &Path) -> Result<Self> {
        let mut options = csv::ReaderBuilder::new();
        // The rows are held against the header here, with errors that name the line.
        options.comment(Some(b'#')).trim(csv::Trim::All).flexible(true);
        let broken = |why: csv::Error| Error::table(path, &why);
        let mut reader = options.from_path(path).map_err(broken)?;
        let header = reader.headers().map_err(broken)?.iter().map(String::from).collect();
        Ok(Self { file: path.display().to_string(), header, reader })
    }

    /// The path of the table, for messages.
    pub fn file(&self) -> &str {
        &self.file
    }

    /// The names of the columns.
    pub fn header(&self) -> &[String] {
        &self.header
    }

    /// The columns `names`. Rows with a blank cell among them are skipped.
    ///
    /// # Errors
    /// `File` if the table cannot be read. `Scene` if a column is missing, a row is longer or shorter than the header, or
    /// a cell is not a finite number; the location of the last two is their line.
    pub fn columns<const N: usize>(mut self, names: [&str; N]) -> Result<[Vec<f64>; N]> {
        let mut indices = [0; N];
        for (index, name) in indices.iter_mut().zip(names) {
            *index = self.index(name)?;
        }
        let mut columns = array::from_fn(|_| Vec::new());
        let (file, count) = (&self.file, self.header.len());
        for record in self.reader.records() {
            let record = record.map_err(|why| Error::table(file.as_ref(), &why))?;
            let line = record.position().map_or(0, |place| place.line() as usize);
            let at = |error: Error, name: &str| error.at(file.as_str(), Some((line, 1)), name);
            if record.len() != count {
                let error = Error::scene(format!("a row has {} cells, its header {count}", record.len()));
                return Err(at(error.help("leave a cell blank where a value is missing"), ""));
            }
            let cells = indices.map(|i| &record[i]);
            if cells.contains(&"") {
                continue;
            }
            for ((column, cell), name) in columns.iter_mut().zip(cells).zip(names) {
                let x = number(cell).filter(|x| x.is_finite());
                column.push(x.ok_or_else(|| at(Error::scene(format!("\"{cell}\" is not a number")), name))?);
            }
        }
        Ok(columns)
    }

    /// All columns, NaN where a cell is blank or no number. Only rows as long as the header with a number in the first
    /// column count, so the cut last row of a stopped run does not.
    ///
    /// # Errors
    /// `File` if the table cannot be read.
    pub fn all_columns(mut self) -> Result<Vec<Vec<f64>>> {
        let mut columns = vec![Vec::new(); self.header.len()];
        for record in self.reader.records() {
            let record = record.map_err(|why| Error::table(self.file.as_ref(), &why))?;
            if record.len() == columns.len() && number(&record[0]).is_some_and(f64::is_finite) {
                let cells = record.iter().map(|cell| number(cell).unwrap_or(f64::NAN));
                columns.iter_mut().zip(cells).for_each(|(column, x)| column.push(x));
            }
        }
        Ok(columns)
    }

    /// The series of `column` over the column `time`.
    ///
    /// # Errors
    /// As [`TableReader::columns`] and [`TimeSeries::new`].
    pub fn series(self, time: &str, column: &str) -> Result<TimeSeries> {
        let file = self.file.clone();
        let [t, x] = self.columns([time, column])?;
        TimeSeries::new(t, x).map_err(|e| Error::scene(format!("{file}, {column}: {}", e.message)))
    }

    /// The place of the column `name`.
    fn index(&self, name: &str) -> Result<usize> {
        self.header.iter().position(|column| column == name).ok_or_else(|| {
            let guess = suggestion(name, self.header.iter().map(String::as_str));
            Error::scene(format!("{} has no column \"{name}\"{guess}", self.file))
                .with_code(ErrorCode::UnknownName)
                .help(format!("its columns: {}", self.header.join(", ")))
        })
    }
}

/// The number in a cell.
fn number(cell: &str) -> Option<f64> {
    cell.parse().ok()
}

#[cfg(test)]
#[path = "../../tests/unit/math/table.rs"]
mod tests;
