//! Time series as CSV, written during the run: a header with units, then a row for each sample.

use std::{
    fs::{File, OpenOptions},
    io::{Seek, SeekFrom, Write},
    path::{Path, PathBuf},
};

use super::cannot_write;
use crate::{
    error::{Error, ErrorKind, Result},
    math::{readings::Readings, table::TableReader},
};

/// A CSV file to which the program appends complete rows.
///
/// The operating system receives each row at once, so that no row is lost if the process is killed. If the write of a
/// row fails, for example on a full disk, the table removes the partial row. The text of a number reads back to the
/// same bits; NaN is an empty field.
pub(crate) struct CsvTable {
    path: PathBuf,
    file: File,
    bytes: u64,
    columns: usize,
    first: Option<Vec<f64>>,
    last: Option<(f64, Vec<f64>)>,
}

impl CsvTable {
    /// Creates a table at `path` with the columns `t_s` and `columns`.
    ///
    /// # Errors
    /// `File` if the file exists or cannot be written.
    pub(crate) fn create(path: &Path, columns: &[String]) -> Result<Self> {
        let file = OpenOptions::new().write(true).create_new(true).open(path).map_err(|e| cannot_write(path, &e))?;
        let mut table = Self { path: path.to_owned(), file, bytes: 0, columns: columns.len(), first: None, last: None };
        table.append(&format!("t_s,{}\n", columns.join(",")))?;
        Ok(table)
    }

    /// Reopens the table at `path` with its first `bytes` bytes, and removes all later data.
    ///
    /// # Errors
    /// `Restart` if the file is shorter than `bytes`, has no complete row at that position, or has other columns in its
    /// header; `File` if it cannot be opened.
    pub(crate) fn resume(path: &Path, columns: &[String], bytes: u64) -> Result<Self> {
        let text = std::fs::read(path).map_err(|e| Error::read(path, &e))?;
        let header = format!("t_s,{}\n", columns.join(","));
        let kept = usize::try_from(bytes).ok().and_then(|n| text.get(..n));
        if kept.is_none_or(|k| !k.starts_with(header.as_bytes()) || !k.ends_with(b"\n")) {
            let what = format!("{} is shorter than at the checkpoint, or has other columns", path.display());
            return Err(Error::new(ErrorKind::Restart, what).help("start the run afresh with `pontoon run`"));
        }
        let file = OpenOptions::new().write(true).open(path).map_err(|e| cannot_write(path, &e))?;
        let mut table = Self { path: path.to_owned(), file, bytes, columns: columns.len(), first: None, last: None };
        table.truncate(bytes)?;
        Ok(table)
    }

    /// Removes everything after the first `bytes` bytes, which contain the header and complete rows.
    ///
    /// # Errors
    /// `File` if the file cannot be read or truncated.
    pub(crate) fn truncate(&mut self, bytes: u64) -> Result<()> {
        let text = std::fs::read(&self.path).map_err(|e| Error::read(&self.path, &e))?;
        let kept = usize::try_from(bytes).map_or(&text[..], |n| &text[..n.min(text.len())]);
        let kept = String::from_utf8_lossy(kept);
        let rows = kept.split_once('\n').map_or("", |(_, rows)| rows);
        self.first = rows.lines().next().and_then(read_row).map(|(_, row)| row);
        self.last = rows.lines().next_back().and_then(read_row);
        let cut = self.file.set_len(bytes).and_then(|()| self.file.seek(SeekFrom::Start(bytes)));
        cut.map_err(|e| cannot_write(&self.path, &e))?;
        self.bytes = bytes;
        Ok(())
    }

    /// Appends the row of time `t` (s).
    ///
    /// # Errors
    /// `File` if the row cannot be written; the earlier rows remain complete.
    pub(crate) fn append_row(&mut self, t: f64, values: &[f64]) -> Result<()> {
        assert_eq!(values.len(), self.columns, "a value for each column");
        let mut line = number(t);
        for &x in values {
            line.push(',');
            line.push_str(&number(x));
        }
        line.push('\n');
        self.append(&line)?;
        self.first.get_or_insert_with(|| values.to_vec());
        self.last = Some((t, values.to_vec()));
        Ok(())
    }

    /// Appends several rows of time `t` (s), or no row on failure. Each row has text fields, followed by values for the
    /// remaining columns.
    ///
    /// # Errors
    /// `File` if the rows cannot be written; the earlier rows remain complete.
    pub(crate) fn append_rows(&mut self, t: f64, rows: &[([&str; 2], Vec<f64>)]) -> Result<()> {
        let mut lines = String::new();
        for (words, values) in rows {
            assert_eq!(words.len() + values.len(), self.columns, "a word or a value for each column");
            let numbers = values.iter().map(|&x| number(x));
            let fields = [number(t)].into_iter().chain(words.map(String::from)).chain(numbers);
            lines += &(fields.collect::<Vec<_>>().join(",") + "\n");
        }
        self.append(&lines)?;
        if let Some((_, values)) = rows.last() {
            self.last = Some((t, values.clone()));
        }
        Ok(())
    }

    /// Returns the values of the first row, or `None` if the table has no rows.
    pub(crate) fn first_row(&self) -> Option<&[f64]> {
        self.first.as_deref()
    }

    /// Returns the time (s) and values of the last row, or `None` if the table has no rows.
    pub(crate) fn last_row(&self) -> Option<(f64, &[f64])> {
        self.last.as_ref().map(|(t, row)| (*t, row.as_slice()))
    }

    /// Returns the length of the file, bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Returns the path of the file.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Waits until all rows are on the disk.
    ///
    /// # Errors
    /// `File` if the operating system reports an error.
    pub(crate) fn sync(&self) -> Result<()> {
        self.file.sync_data().map_err(|e| cannot_write(&self.path, &e))
    }

    fn append(&mut self, line: &str) -> Result<()> {
        if let Err(why) = self.file.write_all(line.as_bytes()) {
            // Truncation can fail only after a failed write: the function returns the error of the write.
            let _ = self.file.set_len(self.bytes);
            return Err(cannot_write(&self.path, &why));
        }
        self.bytes += line.len() as u64;
        Ok(())
    }
}

/// The content of a table file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SeriesTable {
    /// Names of the columns after the time.
    pub columns: Vec<String>,
    /// Times, s.
    pub times: Vec<f64>,
    /// Lines of the file with cells that could not be read; the incomplete last row is none of them.
    pub damaged: Vec<usize>,
    /// One row for each time, with a number for each column; NaN where no measurement exists.
    pub values: Vec<Vec<f64>>,
    /// Names of the columns whose readings are means since the previous row; the file does not tell.
    pub mean_columns: Vec<String>,
}

impl SeriesTable {
    /// Reads the table at `path`. The function ignores an incomplete last row, which a killed run may leave.
    ///
    /// # Errors
    /// `File` if it cannot be read.
    pub fn read(path: &Path) -> Result<Self> {
        let table = TableReader::open(path)?;
        let columns = table.column_names().into_iter().skip(1).collect();
        let (values, damaged) = table.columns_and_damage();
        let mut values = values.into_iter();
        let times = values.next().unwrap_or_default();
        Ok(Self { columns, times, damaged, values: values.collect(), mean_columns: Vec::new() })
    }

    /// Returns this table with means in the columns for which `is_mean` holds.
    pub(crate) fn with_means(self, is_mean: impl Fn(&str) -> bool) -> Self {
        let mean_columns = self.columns.iter().filter(|column| is_mean(column)).cloned().collect();
        Self { mean_columns, ..self }
    }

    /// Returns the remark that rows of the table `name` are damaged, if some are.
    pub(crate) fn damage(&self, name: &str) -> Option<String> {
        let first = self.damaged.first()?;
        let rows = match self.damaged.len() {
            1 => format!("1 row of series/{name}.csv is damaged, in line {first}"),
            count => format!("{count} rows of series/{name}.csv are damaged, the first in line {first}"),
        };
        Some(format!("{rows}: what is no number there is left out"))
    }

    /// Returns the readings of the column `name` from `from` to `until` (s), or `None` if there are fewer than two.
    pub(crate) fn readings(&self, name: &str, from: f64, until: f64) -> Option<Readings> {
        let column = &self.values[self.columns.iter().position(|column| column == name)?];
        let are_means = self.mean_columns.iter().any(|mean| mean == name);
        Readings::new(&self.times, column, are_means, [from, until])
    }
}

/// Returns the shortest text that reads back as `x`, or an empty text for NaN.
fn number(x: f64) -> String {
    if x.is_nan() { String::new() } else { format!("{x:?}") }
}

/// Returns the time and the values of a row, with NaN for empty fields.
fn read_row(line: &str) -> Option<(f64, Vec<f64>)> {
    let mut fields = line.split(',').map(|x| x.parse().unwrap_or(f64::NAN));
    Some((fields.next()?, fields.collect()))
}

#[cfg(test)]
#[path = "../../tests/unit/output/csv.rs"]
mod tests;
