//! Errors that name the fault, its location, the nearest valid name and the remedy. This module prints nothing.

use std::{fmt, io, path::Path};

use serde::{Serialize, Serializer};

/// A result with this crate's [`Error`].
pub type Result<T> = std::result::Result<T, Error>;

/// The kind of an error. It determines the exit code and the report that the program writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The scene, or a file that it names, has invalid content.
    Scene,
    /// A command line or call asks for an object that does not exist.
    Usage,
    /// A file or folder cannot be read or written.
    File,
    /// The computation left the valid range; see [`Error::fault`].
    Fault,
    /// A checkpoint is damaged, or belongs to another version or scene.
    Restart,
}

/// Declares [`ErrorCode`] with the text and the meaning of each code.
macro_rules! error_codes {
    ($($(#[$meaning:meta])+ $code:ident = $text:literal,)+) => {
        /// A stable identifier of a family of errors, for programs. `docs/reference/command-line.md` lists the codes.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum ErrorCode {
            $($(#[$meaning])+ $code,)+
        }

        impl ErrorCode {
            /// All codes.
            pub const ALL: &[Self] = &[$(Self::$code,)+];

            /// The identifier, in kebab case.
            pub const fn as_str(self) -> &'static str {
                match self {
                    $(Self::$code => $text,)+
                }
            }
        }
    };
}

error_codes! {
    /// The text of a scene is not TOML.
    InvalidToml = "invalid-toml",
    /// A key that the scene format does not have.
    UnknownKey = "unknown-key",
    /// An unknown name of a solid, series, choice or scene.
    UnknownName = "unknown-name",
    /// A required key is absent.
    MissingKey = "missing-key",
    /// A value of the wrong type, or a list of the wrong length.
    WrongType = "wrong-type",
    /// A number outside its valid range.
    OutOfRange = "out-of-range",
    /// Keys that exclude one another.
    ConflictingKeys = "conflicting-keys",
    /// Any other error of a scene, or of a file that it names.
    InvalidScene = "invalid-scene",
    /// A command line or call that cannot be carried out.
    InvalidUsage = "invalid-usage",
    /// A file or folder that does not exist.
    FileNotFound = "file-not-found",
    /// A file that cannot be read.
    FileUnreadable = "file-unreadable",
    /// A file or folder that cannot be written, made or removed.
    FileUnwritable = "file-unwritable",
    /// No space is left on the disk.
    DiskFull = "disk-full",
    /// A file whose content is not of the expected format.
    InvalidFile = "invalid-file",
    /// A device that does not exist, or a feature that the device path does not have.
    NoDevice = "no-device",
    /// A device or its driver failed.
    DeviceFailed = "device-failed",
    /// A folder without a run or a checkpoint.
    CheckpointNotFound = "checkpoint-not-found",
    /// A damaged checkpoint or manifest.
    BadCheckpoint = "bad-checkpoint",
    /// A checkpoint of another version of the program.
    OtherVersion = "other-version",
    /// A checkpoint of another scene or setup.
    OtherSetup = "other-setup",
    /// The stable time step is not positive.
    NoTimeStep = "no-time-step",
    /// A position, velocity, density or load that is not finite.
    NonFiniteState = "non-finite-state",
    /// A water particle faster than `guard.speed`.
    SpeedLimit = "speed-limit",
    /// A water particle outside `guard.density`.
    DensityLimit = "density-limit",
    /// A water particle or body outside the domain.
    LeftDomain = "left-domain",
}

impl ErrorCode {
    /// Returns the general code of errors of `kind`.
    const fn of_kind(kind: ErrorKind) -> Self {
        match kind {
            ErrorKind::Scene => Self::InvalidScene,
            ErrorKind::Usage => Self::InvalidUsage,
            ErrorKind::File => Self::InvalidFile,
            ErrorKind::Fault => Self::NonFiniteState,
            ErrorKind::Restart => Self::BadCheckpoint,
        }
    }
}

impl fmt::Display for ErrorCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

impl Serialize for ErrorCode {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        serializer.serialize_str(self.as_str())
    }
}

/// The position of an error in a text file.
#[derive(Clone, Debug, PartialEq)]
pub struct SourceLocation {
    /// The file name as given by the user; empty while only the key is known.
    pub file: String,
    /// Line and column, both counted from 1, if they are known.
    pub line_column: Option<(usize, usize)>,
    /// The key, as in `model.viscosity`; may be empty.
    pub key: String,
}

/// The particle or body with which a run failed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fault {
    /// The code of this error.
    pub code: ErrorCode,
    /// The observation, for example "speed above the speed of sound".
    pub reason: String,
    /// The particle or body, for example "fluid particle 1234" or "body \"buoy\"".
    pub who: String,
    /// Number of steps completed before the failed step.
    pub step: u64,
    /// Simulated time, s.
    pub time: f64,
    /// Position, m.
    pub position: Vec<f64>,
    /// Velocity, m/s.
    pub velocity: Vec<f64>,
    /// Density, kg/m³; absent for a body.
    pub density: Option<f64>,
    /// The usual cause and the remedy to try.
    pub cause: String,
}

/// An error with its message, its location and its remedy.
#[derive(Clone, PartialEq)]
pub struct Error {
    /// Kind of the error.
    pub kind: ErrorKind,
    pub(crate) code: ErrorCode,
    /// One sentence that describes the fault.
    pub message: String,
    /// Location of the fault, if the fault lies in a file.
    pub location: Option<Box<SourceLocation>>,
    /// The remedy, if one is known.
    pub help: Option<String>,
    /// The failed particle or body, for [`ErrorKind::Fault`].
    pub fault: Option<Box<Fault>>,
}

impl Error {
    /// Creates an error of `kind` with the message `what` and the general code of `kind`.
    pub fn new(kind: ErrorKind, what: impl Into<String>) -> Self {
        Self { kind, code: ErrorCode::of_kind(kind), message: what.into(), location: None, help: None, fault: None }
    }

    /// Creates a [`ErrorKind::Scene`] error.
    pub fn scene(what: impl Into<String>) -> Self {
        Self::new(ErrorKind::Scene, what)
    }

    /// Creates a [`ErrorKind::File`] error about the content of `path`.
    pub fn file(path: &Path, why: impl fmt::Display) -> Self {
        Self::new(ErrorKind::File, format!("{}: {why}", path.display()))
    }

    /// Creates a [`ErrorKind::File`] error for a `path` that cannot be read.
    pub fn read(path: &Path, why: &io::Error) -> Self {
        Self::file(path, why).with_code(match why.kind() {
            io::ErrorKind::NotFound => ErrorCode::FileNotFound,
            _ => ErrorCode::FileUnreadable,
        })
    }

    /// Creates a [`ErrorKind::File`] error for a `path` that cannot be changed; `verb` completes "cannot be", as in
    /// "written" or "made".
    pub fn write(path: &Path, verb: &str, why: &io::Error) -> Self {
        Self::file(path, format!("cannot be {verb}: {why}")).with_code(match why.kind() {
            io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => ErrorCode::DiskFull,
            _ => ErrorCode::FileUnwritable,
        })
    }

    /// Returns the stable identifier of the error's family, for programs.
    ///
    /// ```
    /// use pontoon::{error::ErrorCode, scene::Scene};
    ///
    /// let text = "dimension = 2\ndp = 0.05\nuntil = 1.0\ntitel = \"Tank\"";
    /// let error = Scene::parse(text, "".as_ref(), &[]).unwrap_err();
    /// assert_eq!(error.code(), ErrorCode::UnknownKey);
    /// assert_eq!(error.code().as_str(), "unknown-key");
    /// ```
    pub fn code(&self) -> ErrorCode {
        self.code
    }

    /// Returns the same error with another code.
    pub fn with_code(mut self, code: ErrorCode) -> Self {
        self.code = code;
        self
    }

    /// Creates a [`ErrorKind::Fault`] error for a run that cannot continue.
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
        let error = Self::new(ErrorKind::Fault, what).with_code(fault.code).help(fault.cause.clone());
        Self { fault: Some(Box::new(fault)), ..error }
    }

    /// Returns the same error with advice for the user.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Returns the same error with its location inside the part `key` of a value whose place is not known yet.
    pub(crate) fn in_part(mut self, key: impl Into<String>) -> Self {
        let mut key = key.into();
        if let Some(inner) = self.location.take_if(|location| location.file.is_empty()) {
            key = format!("{key}.{}", inner.key);
        }
        self.at("", None, key)
    }

    /// Returns the same error with this location; a location that is already known is kept.
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

/// Prints the same text as `Display`, because a program whose `main` returns an error prints its `Debug` form.
impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for Error {}

/// Returns the end of an error message that names the entry of `known` nearest to `word`: `; did you mean "x"?`, or nothing.
pub(crate) fn suggestion<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    nearest_name(word, known).map_or(String::new(), |name| format!("; did you mean \"{name}\"?"))
}

/// Longest name, in bytes, that is compared: longer names are no typing errors, and the comparison would be slow.
const LONG: usize = 100;

/// Returns the entry of `known` nearest to `word`, if it is near enough to be the intended name.
pub fn nearest_name<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let known: Vec<&str> = known.into_iter().collect();
    if let Some(same) = known.iter().find(|k| k.to_lowercase() == word.to_lowercase()) {
        return Some(same);
    }
    known
        .into_iter()
        .filter(|k| word.len().max(k.len()) <= LONG)
        .map(|k| (strsim::normalized_damerau_levenshtein(word, k), k))
        .filter(|(likeness, _)| *likeness >= 0.5)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, k)| k)
}
