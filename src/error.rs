//! Errors as help: what is wrong, where, the nearest valid name, what to do. Nothing here prints.

use std::fmt;

use serde::Serialize;

/// Result with this crate's [`Error`].
pub type Result<T> = std::result::Result<T, Error>;

/// What sort of trouble it is; decides the exit code and which report is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The scene, or a file that it names, says something that cannot be meant.
    Scene,
    /// A command line or call asks for something that is not there.
    Usage,
    /// A file or folder cannot be read or written.
    File,
    /// The computation left the valid range: see [`Error::fault`].
    Fault,
    /// A checkpoint is damaged, or of another version or scene.
    Restart,
}

/// Where in a text file the trouble lies.
#[derive(Clone, Debug, PartialEq)]
pub struct SourceLocation {
    /// The file, as the user named it; empty where only the key is known yet.
    pub file: String,
    /// Line and column, both from 1, if known.
    pub line_column: Option<(usize, usize)>,
    /// The key, as in `model.viscosity`; may be empty.
    pub key: String,
}

/// The particle or body with which a run failed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fault {
    /// What was seen, in words: "speed above the speed of sound".
    pub reason: String,
    /// "fluid particle 1234", "body \"buoy\"".
    pub who: String,
    /// Steps done before the failed one.
    pub step: u64,
    /// Simulated time, s.
    pub time: f64,
    /// Position, m.
    pub position: Vec<f64>,
    /// Velocity, m/s.
    pub velocity: Vec<f64>,
    /// Density, kg/m³, of a particle.
    pub density: Option<f64>,
    /// What usually causes this, and what to try.
    pub cause: String,
}

/// An error that says what, where, and what to do.
#[derive(Clone, PartialEq)]
pub struct Error {
    /// Sort of trouble.
    pub kind: ErrorKind,
    /// One sentence: what is wrong.
    pub message: String,
    /// Where it is wrong, if in a file.
    pub location: Option<Box<SourceLocation>>,
    /// What to do about it.
    pub help: Option<String>,
    /// The failed particle or body, for [`ErrorKind::Fault`].
    pub fault: Option<Box<Fault>>,
}

impl Error {
    /// An error of `kind` saying `what`.
    pub fn new(kind: ErrorKind, what: impl Into<String>) -> Self {
        Self { kind, message: what.into(), location: None, help: None, fault: None }
    }

    /// A [`ErrorKind::Scene`] error.
    pub fn scene(what: impl Into<String>) -> Self {
        Self::new(ErrorKind::Scene, what)
    }

    /// A [`ErrorKind::File`] error about `path`, with the system's own words.
    pub fn file(path: &std::path::Path, why: impl fmt::Display) -> Self {
        Self::new(ErrorKind::File, format!("{}: {why}", path.display()))
    }

    /// A [`ErrorKind::Fault`] error: a run that cannot go on.
    pub fn fault(fault: Fault) -> Self {
        let at: Vec<String> = fault.position.iter().map(|x| format!("{x:.6}")).collect();
        let what = format!(
            "{} of {} at ({}) m, step {}, t = {:.6} s",
            fault.reason,
            fault.who,
            at.join(", "),
            fault.step,
            fault.time
        );
        let help = Some(fault.cause.clone());
        Self { kind: ErrorKind::Fault, message: what, location: None, help, fault: Some(Box::new(fault)) }
    }

    /// The same error with advice on what to do.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// The same error with its place; a place that is already known is kept.
    pub fn at(mut self, file: impl Into<String>, line_column: Option<(usize, usize)>, key: impl Into<String>) -> Self {
        self.location
            .get_or_insert_with(|| Box::new(SourceLocation { file: file.into(), line_column, key: key.into() }));
        self
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.message)?;
        if let Some(place) = self.location.as_ref().filter(|place| !place.file.is_empty()) {
            write!(f, "\n  in {}", place.file)?;
            if let Some((line, column)) = place.line_column {
                write!(f, ":{line}:{column}")?;
            }
            if !place.key.is_empty() {
                write!(f, ", {}", place.key)?;
            }
        }
        if let Some(help) = &self.help {
            for line in help.lines() {
                write!(f, "\n  {line}")?;
            }
        }
        Ok(())
    }
}

/// The same words: a program whose `main` returns an error prints them so.
impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for Error {}

/// Words longer than this are no slips of the pen, and would take long to compare.
const LONG: usize = 100;

/// The entry of `known` nearest to `word`, if it is near enough to be what was meant.
pub fn nearest_name<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    known
        .into_iter()
        .filter(|k| word.len().max(k.len()) <= LONG)
        .map(|k| (strsim::normalized_damerau_levenshtein(word, k), k))
        .filter(|(likeness, _)| *likeness >= 0.5)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, k)| k)
}
