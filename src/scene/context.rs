//! The properties of a scene that the validation and construction of its sections use. The file also defines errors
//! with their location and the record of the defaults.

use std::{cell::RefCell, collections::BTreeMap, path::Path};

use super::{
    diagnostics,
    section::gravity::{self, GravityValues},
    toml_source::{SceneSource, ValueSource},
};
use crate::error::{Error, ErrorCode, Result};

/// The properties of a scene that its sections use.
#[derive(Clone)]
pub(crate) struct Context<'a> {
    pub(super) origin: &'a SceneSource,
    /// 2 or 3.
    pub(crate) dimension: usize,
    /// Particle spacing, m.
    pub(crate) dp: f64,
    /// Smoothing length, m.
    pub(crate) h: f64,
    /// Simulated time at the end, s.
    pub(crate) until: f64,
    /// Acceleration of gravity, m/s²; `None` if the scene does not give it.
    pub(crate) gravity: Option<GravityValues>,
    /// Reference density, kg/m³; `None` if the scene does not give it.
    pub(crate) rho0: Option<f64>,
    /// Notes about the files that were read with this context.
    pub(super) file_notes: RefCell<Vec<FileNote>>,
}

/// A property of the scene or of a file that it names: an assumption of its reading, or a probable fault.
#[derive(Clone, Debug, PartialEq)]
pub struct FileNote {
    /// Whether the results are affected.
    pub is_warning: bool,
    /// Identifier of its kind, for programs.
    pub topic: &'static str,
    /// Description, as one sentence.
    pub what: String,
    /// The remedy.
    pub remedy: String,
}

impl FileNote {
    /// Creates a note about an assumption.
    pub(crate) fn note(topic: &'static str, what: String, remedy: String) -> Self {
        Self { is_warning: false, topic, what, remedy }
    }

    /// Creates a note about a probable fault.
    pub(crate) fn warning(topic: &'static str, what: String, remedy: String) -> Self {
        Self { is_warning: true, topic, what, remedy }
    }
}

impl Context<'_> {
    /// Returns the folder of the files that the scene names.
    pub(crate) fn folder(&self) -> &Path {
        &self.origin.folder
    }

    /// Records a note about a file. The same note is recorded once.
    pub(crate) fn add_note(&self, note: FileNote) {
        let mut all = self.file_notes.borrow_mut();
        if !all.contains(&note) {
            all.push(note);
        }
    }

    /// Records notes about a file.
    pub(crate) fn add_file_notes(&self, notes: Vec<FileNote>) {
        notes.into_iter().for_each(|note| self.add_note(note));
    }

    /// Returns `key` with the names of solids, for messages.
    pub(super) fn shown_key(&self, key: &str) -> String {
        self.origin.key_with_names(key)
    }

    /// Returns whether the scene writes `key`.
    pub(crate) fn is_written(&self, key: &str) -> bool {
        self.origin.source(key).is_some()
    }

    /// Returns the number of layers of boundary particles within the kernel radius.
    pub(crate) fn layers(&self) -> usize {
        (2.0 * self.h / self.dp - 1e-9).ceil() as usize
    }

    /// Returns whether gravity acts.
    pub(crate) fn has_gravity(&self) -> bool {
        self.gravity_norm() != 0.0
    }

    /// Returns `|g|`, m/s², or its largest value during the run if gravity changes.
    pub(crate) fn gravity_norm(&self) -> f64 {
        self.gravity.as_ref().map_or(0.0, |gravity| gravity.strongest)
    }

    /// Returns `|g|` at the start, m/s², or its largest value during the run if it is 0 at the start.
    pub(crate) fn initial_gravity_norm(&self) -> f64 {
        let initial = self.gravity.as_ref().map_or(0.0, |gravity| gravity::norm(gravity.initial.iter().copied()));
        if initial > 0.0 { initial } else { self.gravity_norm() }
    }

    /// Returns `error` with the location of `key` in the scene.
    pub(crate) fn with_location(&self, error: Error, key: &str) -> Error {
        self.origin.with_location(error, key)
    }

    /// Returns an error about `key` with the message `what`, the location of the key and an example.
    pub(crate) fn error_at(&self, key: &str, what: impl Into<String>) -> Error {
        let error = Error::scene(what);
        let error = match diagnostics::example(key) {
            Some(example) => error.help(example),
            None => error,
        };
        self.with_location(error, key)
    }

    /// Returns the error of [`Context::error_at`] with `help` in place of the example.
    pub(crate) fn error_with_help(&self, key: &str, what: impl Into<String>, help: impl Into<String>) -> Error {
        self.with_location(Error::scene(what).help(help), key)
    }

    /// Returns the error of [`Context::error_at`] for a number outside its valid range.
    fn out_of_range(&self, key: &str, what: String) -> Error {
        self.error_at(key, what).with_code(ErrorCode::OutOfRange)
    }

    /// Refuses a number that is present and not positive.
    pub(crate) fn require_positive(&self, key: &str, x: Option<f64>) -> Result<()> {
        match x {
            Some(x) if !(x > 0.0 && x.is_finite()) => {
                let word = last_part(key);
                let error = self.out_of_range(key, format!("{word} must be a positive number, not {x}"));
                let has_help = error.help.is_some();
                Err(if has_help { error } else { error.help(format!("give  {word}  a number above 0, or remove it")) })
            }
            _ => Ok(()),
        }
    }

    /// Refuses a constant of a law that is negative or not finite.
    pub(crate) fn require_not_negative(&self, key: &str, x: f64) -> Result<()> {
        if x >= 0.0 && x.is_finite() {
            return Ok(());
        }
        let word = last_part(key);
        let what = format!("{word} is {x}: below 0 the law would feed the water with energy, or it has no value");
        let help = format!("give  {word}  a number of 0 or more, or remove it for its default");
        Err(self.error_with_help(key, what, help).with_code(ErrorCode::OutOfRange))
    }

    /// Refuses a number that is present and not from 0 to `most`.
    pub(crate) fn require_range(&self, key: &str, x: Option<f64>, most: f64) -> Result<()> {
        match x.filter(|x| !(0.0..=most).contains(x)) {
            Some(x) => {
                let word = last_part(key);
                let help = format!("{word} is a number from 0 to {most}");
                Err(self.error_with_help(key, format!("{word} cannot be {x}"), help).with_code(ErrorCode::OutOfRange))
            }
            None => Ok(()),
        }
    }

    /// Refuses a vector if its length is not the dimension of the scene.
    pub(crate) fn require_dimension(&self, key: &str, x: &[f64]) -> Result<()> {
        self.require_dimension_of(key, last_part(key), x)
    }

    /// Refuses a vector called `name` at `key` if its length is not the dimension of the scene.
    pub(crate) fn require_dimension_of(&self, key: &str, name: &str, x: &[f64]) -> Result<()> {
        let (d, n) = (self.dimension, x.len());
        if n != d {
            let help = format!("a {d}-D scene has vectors of {d} numbers, as in [{}]", vec!["0.0"; d].join(", "));
            let numbers = if n == 1 { "number" } else { "numbers" };
            let error = self.error_with_help(key, format!("{name} has {n} {numbers}, not {d}"), help);
            return Err(error.with_code(ErrorCode::WrongType));
        }
        match x.iter().find(|x| !x.is_finite()) {
            Some(x) => Err(self.out_of_range(key, format!("{x} is not a finite number"))),
            None => Ok(()),
        }
    }

    /// Refuses a vector of zero length.
    pub(crate) fn require_direction(&self, key: &str, x: &[f64]) -> Result<()> {
        self.require_dimension(key, x)?;
        match x.iter().all(|x| x.abs() < 1e-12) {
            true => Err(self.out_of_range(key, format!("{} points nowhere", last_part(key)))),
            false => Ok(()),
        }
    }

    /// Refuses a name that is not a valid file name.
    pub(crate) fn require_file_name(&self, key: &str, name: &str) -> Result<()> {
        let good = |c: char| c.is_alphanumeric() || c == '_' || c == '-';
        if name.is_empty() || name.len() > 64 || !name.chars().all(good) {
            let help = "a name has letters, digits, _ and -, as in \"box_1\"; files are called after it";
            return Err(self.error_with_help(key, format!("\"{name}\" cannot be a name"), help));
        }
        Ok(())
    }

    /// Refuses an empty time interval of the run.
    pub(crate) fn require_interval(&self, key: &str, from: Option<f64>, until: Option<f64>, help: &str) -> Result<()> {
        match (from, until) {
            (Some(from), Some(until)) if from >= until => {
                let what = format!("nothing lies between from = {from} and until = {until}");
                Err(self.error_with_help(&format!("{key}.until"), what, help).with_code(ErrorCode::OutOfRange))
            }
            _ => Ok(()),
        }
    }
}

/// The defaults that were filled in, with their reasons, by key.
#[derive(Default)]
pub(crate) struct Defaults(BTreeMap<String, String>);

impl Defaults {
    /// Puts the default `value` into an empty `slot` and records the `reason`.
    pub(crate) fn fill<T>(
        &mut self,
        key: impl Into<String>,
        slot: &mut Option<T>,
        value: T,
        reason: impl Into<String>,
    ) {
        if slot.is_none() {
            *slot = Some(value);
            self.0.insert(key.into(), reason.into());
        }
    }

    /// Returns the default at `key` as a source, or `None` if `key` has no recorded default.
    pub(crate) fn source(&self, key: &str) -> Option<ValueSource> {
        self.0.get(key).map(|reason| ValueSource::Default(reason.clone()))
    }
}

/// Returns the names of the keys of `given` that are set.
pub(crate) fn set_keys<const N: usize>(given: [(&'static str, bool); N]) -> Vec<&'static str> {
    given.into_iter().filter(|(_, given)| *given).map(|(key, _)| key).collect()
}

/// Returns the keys as a list for a sentence.
pub(crate) fn quoted_list(keys: &[&str]) -> String {
    if keys.is_empty() { "nothing".into() } else { keys.join(" and ") }
}

/// Returns the last part of a key.
pub(crate) fn last_part(key: &str) -> &str {
    key.rsplit('.').next().unwrap_or(key)
}
