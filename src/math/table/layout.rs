//! The layout of a text table: its separator and decimal sign, and the rows of names and units.

use super::{
    cell::{self, Decimal},
    unit,
};
use crate::error::{Error, Result};

/// Number of lines that are examined for the layout.
const EXAMINED: usize = 1000;

/// Beginnings of lines that are comments.
const COMMENTS: [&str; 4] = ["#", "%", "//", "!"];

/// The separator of the cells of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Separator {
    Tab,
    Semicolon,
    Comma,
    /// One or more blanks or tabs.
    Blanks,
}

impl Separator {
    /// All of them; one before that may stand between the numbers of one after.
    const ALL: [Self; 4] = [Self::Tab, Self::Semicolon, Self::Comma, Self::Blanks];

    fn is(self, c: char) -> bool {
        match self {
            Self::Tab => c == '\t',
            Self::Semicolon => c == ';',
            Self::Comma => c == ',',
            Self::Blanks => c.is_whitespace(),
        }
    }

    /// Its name in a message.
    fn name(self) -> &'static str {
        match self {
            Self::Tab => "tab",
            Self::Semicolon => "semicolon",
            Self::Comma => "comma",
            Self::Blanks => "blanks",
        }
    }

    /// Returns the cells of `line`, trimmed and without quotation marks. A separator in quotation marks separates nothing.
    pub(super) fn split(self, line: &str) -> Vec<&str> {
        let line = if self == Self::Blanks { line.trim() } else { line };
        let (mut cells, mut start, mut quote) = (Vec::new(), 0, None);
        for (i, c) in line.char_indices() {
            match quote {
                Some(mark) if c == mark => quote = None,
                Some(_) => {}
                None if (c == '"' || c == '\'') && line[start..i].trim().is_empty() => quote = Some(c),
                None if self.is(c) => {
                    if self != Self::Blanks || i > start {
                        cells.push(&line[start..i]);
                    }
                    start = i + c.len_utf8();
                }
                None => {}
            }
        }
        cells.push(&line[start..]);
        cells.into_iter().map(unquoted).collect()
    }
}

/// Returns a cell without blanks and quotation marks at its ends.
fn unquoted(cell: &str) -> &str {
    let cell = cell.trim();
    let inside = |mark| cell.strip_prefix(mark).and_then(|rest| rest.strip_suffix(mark));
    inside('"').or_else(|| inside('\'')).map_or(cell, str::trim)
}

/// The layout of a table.
#[derive(Debug)]
pub(super) struct Layout {
    pub(super) separator: Separator,
    pub(super) decimal: Decimal,
    /// Number of cells of a row.
    pub(super) count: usize,
    /// Names of the columns; empty if there is no row of names, or if their number is not that of the cells.
    pub(super) names: Vec<String>,
    /// Number of names of a row of names that does not fit the rows.
    pub(super) unfit: Option<usize>,
    /// Cells of a row of units; empty if there is none.
    pub(super) units: Vec<String>,
    /// Whether the names are one too few, and the first column numbers the rows.
    pub(super) counts_rows: bool,
    /// Line of the names, and the cells of the row above them.
    pub(super) above_names: Option<(usize, Vec<String>)>,
    /// Line of the first row of numbers, from 1.
    pub(super) first: usize,
    /// Differences from a table with commas, decimal points and names in its first line.
    pub(super) remarks: Vec<String>,
}

/// A line and its number, from 1.
#[derive(Clone, Copy)]
struct Line<'a> {
    number: usize,
    text: &'a str,
}

/// Returns the comment in `line` without its mark, if the line is one.
pub(super) fn comment(line: &str) -> Option<&str> {
    let line = line.trim_start().trim_start_matches('"');
    COMMENTS.iter().find(|mark| line.starts_with(**mark)).map(|mark| line.trim_start_matches(*mark).trim())
}

/// Returns the separator that Excel names in its first line, as in `sep=;`.
fn named_separator(line: &str) -> Option<Separator> {
    let mark = line.trim_matches(['"', ' ']).strip_prefix("sep=")?;
    Separator::ALL.into_iter().find(|separator| mark.chars().next().is_some_and(|c| separator.is(c)))
}

impl Layout {
    /// Returns the layout of `text`.
    ///
    /// # Errors
    /// `Scene` if the numbers may be read in more than one way.
    pub(super) fn of(text: &str) -> Result<Self> {
        let lines = text.lines().enumerate().map(|(i, text)| Line { number: i + 1, text });
        let lines: Vec<Line> = lines.filter(|line| !line.text.trim().is_empty()).take(EXAMINED).collect();
        let named = lines.first().and_then(|line| named_separator(line.text));
        let (comments, content): (Vec<Line>, Vec<Line>) =
            lines.iter().skip(usize::from(named.is_some())).partition(|line| comment(line.text).is_some());
        let (separator, decimal) = form(&content, named);
        let rows = Rows::of(&content, separator, decimal);
        if named.is_none() && rows.count <= 1 {
            refuse_bars(&content)?;
        }
        let mut layout = Self {
            separator,
            decimal,
            count: rows.count,
            names: Vec::new(),
            unfit: None,
            units: Vec::new(),
            counts_rows: false,
            above_names: None,
            first: content.get(rows.first).map_or(usize::MAX, |line| line.number),
            remarks: Vec::new(),
        };
        if separator != Separator::Comma {
            layout.remarks.push(format!("separator {}", separator.name()));
        }
        if decimal == Decimal::Comma {
            layout.remarks.push("decimal commas".into());
        }
        let marks = comments.iter().filter_map(|line| line.text.trim_start().chars().next()).find(|c| *c != '#');
        if let Some(mark) = marks {
            layout.remarks.push(format!("lines that begin with {mark} are comments"));
        }
        layout.read_names(&content, &rows);
        if layout.names.is_empty() && layout.unfit.is_none() {
            layout.read_names_in_comments(&comments);
        }
        layout.require_one_reading(&rows)?;
        Ok(layout)
    }

    /// Returns the cells of a row, without the empty one behind a separator at the end of the row.
    pub(super) fn cells<'a>(&self, line: &'a str) -> Vec<&'a str> {
        let mut cells = self.separator.split(line);
        if cells.len() == self.count + 1 && cells.last().is_some_and(|cell| cell.is_empty()) {
            cells.pop();
        }
        cells
    }

    /// Takes names and units from the lines above the first row of numbers.
    fn read_names(&mut self, content: &[Line], rows: &Rows) {
        let above = &content[..rows.first.min(content.len())];
        let mut fitting =
            above.iter().rev().take(2).map(|line| self.names_in(line.text).map(|names| (line.number, names)));
        let (lower, upper) = (fitting.next().flatten(), fitting.next().flatten());
        let mut end = self.first;
        match (lower, upper) {
            (Some((line, units)), Some((upper, names))) if unit::is_unit_row(&units) && !unit::is_unit_row(&names) => {
                self.remarks.push(format!("row of units in line {line}"));
                (self.names, self.units, end) = (names, units, upper);
            }
            (Some((line, names)), upper) => {
                self.above_names = upper.map(|(_, above)| (line, above));
                (self.names, end) = (names, line);
            }
            (None, _) => {
                if let Some(line) = above.last() {
                    end = self.read_unfit_names(line, &content[above.len()..], rows);
                }
            }
        }
        match above.iter().filter(|line| line.number < end).collect::<Vec<_>>()[..] {
            [] => {}
            [one] => self.remarks.push(format!("line {} skipped", one.number)),
            [first, .., last] => self.remarks.push(format!("lines {} to {} skipped", first.number, last.number)),
        }
    }

    /// Takes names from a line that has too few or too many. Returns the line of the names, or that of the first row. R leaves
    /// out the name of the first column, which has the numbers of the rows in quotation marks.
    fn read_unfit_names(&mut self, line: &Line, below: &[Line], rows: &Rows) -> usize {
        let names = self.separator.split(line.text);
        let is_one_less = names.len() + 1 == self.count && self.count > 2;
        let is_word = |name: &&str| !name.is_empty() && cell::number(name, self.decimal).is_none();
        let numbers_rows = |(i, cells): (usize, &Vec<&str>)| cells[0] == (i + 1).to_string();
        let counts = is_one_less && names.iter().all(is_word) && rows.data.iter().enumerate().all(numbers_rows);
        if counts && below.first().is_some_and(|row| row.text.trim_start().starts_with(['"', '\''])) {
            self.remarks.push(format!("line {} has no name for the first column, which numbers the rows", line.number));
            self.names = [""].into_iter().chain(names).map(String::from).collect();
            return line.number;
        }
        self.counts_rows = counts;
        let is_names = (self.separator != Separator::Blanks && names.len() > 1) || counts;
        self.unfit = is_names.then_some(names.len());
        self.first
    }

    /// Takes names, and units below them, from the last comments above the first row of numbers.
    fn read_names_in_comments(&mut self, comments: &[Line]) {
        let above = comments.iter().filter(|line| line.number < self.first).rev().take(2);
        let names_in = |line: &Line| Some((line.number, self.names_in(comment(line.text)?)?));
        let found = match above.map(names_in).collect::<Vec<_>>()[..] {
            [Some((_, ref units)), Some((line, ref names))]
                if unit::is_unit_row(units) && !unit::is_unit_row(names) =>
            {
                Some((line, names.clone(), units.clone()))
            }
            [Some((line, ref names)), ..] | [None, Some((line, ref names))] => Some((line, names.clone(), Vec::new())),
            _ => None,
        };
        match found {
            Some((line, names, units)) if self.count > 1 => {
                self.remarks.push(format!("names from the comment in line {line}"));
                (self.names, self.units) = (names, units);
            }
            _ if self.count > 0 && self.first < usize::MAX => self.remarks.push("no row of names".into()),
            _ => {}
        }
    }

    /// Returns the names in a line, if they are as many as the cells of a row. The line may have another separator
    /// than the rows; blanks separate names from their units in brackets, too.
    fn names_in(&self, line: &str) -> Option<Vec<String>> {
        let owned = |cells: Vec<&str>| cells.into_iter().map(String::from).collect::<Vec<String>>();
        let fits = |names: &Vec<String>| names.len() == self.count;
        let own = owned(self.cells(line));
        if fits(&own) && !(self.separator == Separator::Blanks && own.iter().any(|name| name.ends_with([',', ';']))) {
            return Some(own);
        }
        let words = || joined_units(&Separator::Blanks.split(line));
        let other = [Separator::Tab, Separator::Semicolon, Separator::Comma].map(|other| owned(other.split(line)));
        let has_blanks = matches!(self.separator, Separator::Blanks | Separator::Tab);
        let blanks = has_blanks.then(words);
        let has_unit = |name: &String| unit::split_name(name).1.is_some();
        let of_words = || Some(names_of_words(&Separator::Blanks.split(line))).filter(|_| has_blanks);
        let of_words = || of_words().filter(|names| fits(names) && names.iter().all(has_unit));
        let is_word = |name: &str| !name.is_empty() && !unit::split_name(name).0.contains(' ');
        let is_names = |names: &Vec<String>| {
            let number = |name: &String| cell::number(name, self.decimal).is_some();
            fits(names) && names.iter().all(|name| is_word(name) && !number(name))
        };
        other.into_iter().chain(blanks).find(is_names).or_else(of_words)
    }

    /// Refuses commas that may be decimal signs, separators of columns or of thousands.
    fn require_one_reading(&self, rows: &Rows) -> Result<()> {
        let cells = || rows.data.iter().flatten().copied();
        if self.decimal == Decimal::Comma {
            let commas: Vec<&str> = cells().filter(|cell| cell.contains(',')).collect();
            if commas.iter().all(|cell| cell::may_have_thousands(cell))
                && let Some(one) = commas.first()
            {
                let what = format!("\"{one}\" may be {} or {}", one.replace(',', "."), one.replace(',', ""));
                return Err(Error::scene(what).help("write decimal points and no separators of thousands"));
            }
        }
        let padded = |cell: &str| cell.len() > 1 && cell.bytes().all(|b| b.is_ascii_digit()) && cell.starts_with('0');
        let twice = self.unfit.is_some_and(|names| self.count == 2 * names);
        let is_digits = |cell: &&str| !cell.is_empty() && cell.bytes().all(|b| b.is_ascii_digit());
        let may_be_pairs =
            |row: &Vec<&str>| row.len().is_multiple_of(2) && row.iter().skip(1).step_by(2).all(is_digits);
        let has_halves = cells().any(padded) || rows.data.iter().all(may_be_pairs);
        let unnamed = self.names.is_empty() && self.unfit.is_none() && self.count >= 4 && has_halves;
        if self.separator == Separator::Comma && !cells().any(|cell| cell.contains('.')) && (twice || unnamed) {
            let what = "commas separate the columns and may be decimal commas as well";
            let help = "write decimal points, separate the columns by semicolons, or name every column";
            return Err(Error::scene(what).help(help));
        }
        Ok(())
    }
}

/// Refuses vertical bars between the cells of all rows.
fn refuse_bars(content: &[Line]) -> Result<()> {
    match content {
        [_, rows @ ..] if !rows.is_empty() && rows.iter().all(|line| line.text.contains('|')) => {
            Err(Error::scene("the character | separates the columns")
                .help("separate them by commas, semicolons, tabs or blanks"))
        }
        _ => Ok(()),
    }
}

/// Returns the cells of a row of names, each unit in brackets with the name before it.
fn joined_units(cells: &[&str]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for cell in cells {
        match names.last_mut() {
            Some(name) if unit::opens(cell) => *name += &format!(" {cell}"),
            _ => names.push((*cell).into()),
        }
    }
    names
}

/// Returns the names in a row of words, of which each ends with a unit in brackets.
fn names_of_words(words: &[&str]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for word in words {
        match names.last_mut() {
            Some(name) if unit::split_name(name).1.is_none() => *name += &format!(" {word}"),
            _ => names.push((*word).into()),
        }
    }
    names
}

/// The rows of the examined lines.
struct Rows<'a> {
    /// Number of cells of a row.
    count: usize,
    /// Index of the first row of numbers, or of the first row below the names.
    first: usize,
    /// Cells of the rows of numbers.
    data: Vec<Vec<&'a str>>,
}

impl<'a> Rows<'a> {
    fn of(content: &[Line<'a>], separator: Separator, decimal: Decimal) -> Self {
        let all: Vec<Vec<&str>> = content.iter().map(|line| separator.split(line.text)).collect();
        let is_number = |cell: &str| cell::number(cell, decimal).is_some();
        let numeric = |cells: &[&str]| cells.iter().any(|cell| is_number(cell));
        let starts = |cells: &[&str]| {
            let open = |cell: &&str| is_number(cell) || cell::is_missing(cell);
            cells.first().is_some_and(|cell| is_number(cell)) || (numeric(cells) && cells.iter().all(open))
        };
        // The most frequent number of cells; the first of several.
        let counts: Vec<usize> = all.iter().filter(|cells| starts(cells)).map(Vec::len).collect();
        let frequency = |n: usize| counts.iter().filter(|count| **count == n).count();
        let common = |a: usize, b: usize| if frequency(b) > frequency(a) { b } else { a };
        let raw = counts.iter().copied().reduce(common).unwrap_or_else(|| all.first().map_or(0, Vec::len));
        let first = all.iter().position(|cells| cells.len() == raw && starts(cells));
        let Some(mut first) = first else {
            let first = usize::from(all.first().is_some_and(|cells| !numeric(cells)));
            return Self { count: raw, first, data: Vec::new() };
        };
        let names = first.checked_sub(1).map(|i| &all[i]);
        let ends_empty = |cells: &Vec<&str>| cells.len() == raw && cells.last().is_some_and(|cell| cell.is_empty());
        let open = all[first..].iter().filter(|cells| starts(cells) && cells.len() == raw).all(ends_empty);
        let named = names.is_some_and(|names| names.len() == raw && !ends_empty(names));
        let count = if open && raw > 1 && !named { raw - 1 } else { raw };
        // A row of numbers whose first cell is none, below a row of names.
        let names_above =
            |i: usize| i.checked_sub(1).is_some_and(|i| all[i].len() == all[first].len() && !numeric(&all[i]));
        if first > 1 && all[first - 1].len() == raw && numeric(&all[first - 1]) && names_above(first - 1) {
            first -= 1;
        }
        let data = all.into_iter().skip(first).filter(|cells| cells.len() == raw).collect();
        Self { count, first, data }
    }
}

/// Returns the separator and the decimal sign with which most lines are rows of numbers.
fn form(content: &[Line], named: Option<Separator>) -> (Separator, Decimal) {
    let separators = Separator::ALL.into_iter().filter(|separator| named.is_none_or(|named| named == *separator));
    let forms: Vec<(Separator, Decimal)> = separators
        .flat_map(|separator| [(separator, Decimal::Point), (separator, Decimal::Comma)])
        .filter(|form| *form != (Separator::Comma, Decimal::Comma))
        .collect();
    let best = |is_row: fn(&[&str], Decimal) -> bool| {
        let rows = |(separator, decimal): (Separator, Decimal)| {
            content.iter().filter(|line| is_row(&separator.split(line.text), decimal)).count()
        };
        let better =
            |a: ((Separator, Decimal), usize), b| if matches!((a, b), ((_, n), (_, m)) if m > n) { b } else { a };
        let best = forms.iter().map(|form| (*form, rows(*form))).reduce(better);
        best.filter(|(_, rows)| *rows > 0).map(|(form, _)| form)
    };
    let numbers = |cells: &[&str], decimal: Decimal| {
        let known = |cell: &&str| cell::number(cell, decimal).is_some() || cell::is_missing(cell);
        let count = cells.iter().filter(|cell| cell::number(cell, decimal).is_some()).count();
        cells.len() > 1 && count > 0 && cells.iter().all(known)
    };
    let begins = |cells: &[&str], decimal: Decimal| cells.len() > 1 && cell::number(cells[0], decimal).is_some();
    best(numbers).or_else(|| best(begins)).unwrap_or_else(|| {
        let cells = |separator: Separator| content.first().map_or(0, |line| separator.split(line.text).len());
        let first = Separator::ALL[..3].iter().find(|separator| cells(**separator) > 1);
        (named.or(first.copied()).unwrap_or(Separator::Comma), Decimal::Point)
    })
}
