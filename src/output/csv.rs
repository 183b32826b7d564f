//! Series as CSV, written while the run goes on: a header with units, then a row for each look.

use std::{
    fs::{File, OpenOptions},
    io::{Seek, SeekFrom, Write},
    path::{Path, PathBuf},
};

use super::cannot_write;
use crate::{
    error::{Error, ErrorKind, Result},
    math::{table::TableReader, time_series::TimeSeries},
};

/// A CSV file that grows by whole rows.
///
/// Every row reaches the system at once, so a run that dies loses none; a row that fails half-way, as on a
/// full disk, is taken back. Numbers are written so that reading them gives the same bits; a number that
/// does not exist (NaN) is an empty field.
pub(crate) struct CsvTable {
    path: PathBuf,
    file: File,
    bytes: u64,
    columns: usize,
    first: Option<Vec<f64>>,
    last: Option<(f64, Vec<f64>)>,
}

impl CsvTable {
    /// A new table at `path` with the columns `t_s` and `columns`.
    ///
    /// # Errors
    /// `File` if it exists or cannot be written.
    pub(crate) fn create(path: &Path, columns: &[String]) -> Result<Self> {
        let file = OpenOptions::new().write(true).create_new(true).open(path).map_err(|e| cannot_write(path, &e))?;
        let mut table = Self { path: path.to_owned(), file, bytes: 0, columns: columns.len(), first: None, last: None };
        table.append(&format!("t_s,{}\n", columns.join(",")))?;
        Ok(table)
    }

    /// The table at `path` as it was when it had `bytes` bytes; what came after is cut off.
    ///
    /// # Errors
    /// `Restart` if it is shorter than that, has no whole row there or its header names other columns; `File` if it cannot be
    /// opened.
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

    /// Takes back all but the first `bytes` bytes, the header and whole rows.
    ///
    /// # Errors
    /// `File` if it cannot be read or cut.
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

    /// Adds the row of time `t` (s).
    ///
    /// # Errors
    /// `File` if it cannot be written; the rows before stay whole.
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

    /// Adds rows of time `t` (s), each of words and of values for the columns behind them: all rows or none.
    ///
    /// # Errors
    /// `File` if they cannot be written; the rows before stay whole.
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

    /// Values of the first row.
    pub(crate) fn first_row(&self) -> Option<&[f64]> {
        self.first.as_deref()
    }

    /// Time (s) and values of the last row.
    pub(crate) fn last_row(&self) -> Option<(f64, &[f64])> {
        self.last.as_ref().map(|(t, row)| (*t, row.as_slice()))
    }

    /// Length of the file, bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Where it is.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Waits until all rows are on the disk itself.
    ///
    /// # Errors
    /// `File` if the disk refuses.
    pub(crate) fn sync(&self) -> Result<()> {
        self.file.sync_data().map_err(|e| cannot_write(&self.path, &e))
    }

    fn append(&mut self, line: &str) -> Result<()> {
        if let Err(why) = self.file.write_all(line.as_bytes()) {
            // Cutting can fail only where writing did: the error to tell is the first.
            let _ = self.file.set_len(self.bytes);
            return Err(cannot_write(&self.path, &why));
        }
        self.bytes += line.len() as u64;
        Ok(())
    }
}

/// A table as it stands in its file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SeriesTable {
    /// Names of the columns after the time.
    pub columns: Vec<String>,
    /// Times, s.
    pub times: Vec<f64>,
    /// A row of numbers for each column; NaN where there was nothing to measure.
    pub values: Vec<Vec<f64>>,
}

impl SeriesTable {
    /// The table at `path`. A last row that is cut, as that of a killed run may be, is left out.
    ///
    /// # Errors
    /// `File` if it cannot be read.
    pub fn read(path: &Path) -> Result<Self> {
        let table = TableReader::open(path)?;
        let columns = table.header().iter().skip(1).cloned().collect();
        let mut values = table.all_columns()?.into_iter();
        Ok(Self { columns, times: values.next().unwrap_or_default(), values: values.collect() })
    }

    /// The numbers of the column called `name` from `from` to `until` (s); none if there are less than two.
    pub(crate) fn series(&self, name: &str, from: f64, until: f64) -> Option<TimeSeries> {
        let column = &self.values[self.columns.iter().position(|column| column == name)?];
        let known = self.times.iter().zip(column).filter(|(t, x)| x.is_finite() && (from..=until).contains(*t));
        let (t, x): (Vec<f64>, Vec<f64>) = known.unzip();
        TimeSeries::new(t, x).ok()
    }
}

/// The shortest text that reads back as `x`; nothing for NaN.
fn number(x: f64) -> String {
    if x.is_nan() { String::new() } else { format!("{x:?}") }
}

/// Time and values of a row, empty fields as NaN.
fn read_row(line: &str) -> Option<(f64, Vec<f64>)> {
    let mut fields = line.split(',').map(|x| x.parse().unwrap_or(f64::NAN));
    Some((fields.next()?, fields.collect()))
}

#[cfg(test)]
#[path = "../../tests/unit/output/csv.rs"]
mod tests;
