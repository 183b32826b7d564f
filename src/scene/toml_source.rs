//! Reads TOML, applies `--set`, and records where every key was written, so that each error names its place.
//!
//! A choice that is a bare word, `viscosity = "artificial"`, is read as the choice with its defaults,
//! `viscosity = { artificial = {} }`.

use std::{
    borrow::Cow,
    collections::{BTreeMap, BTreeSet},
    fmt,
    ops::Range,
    path::{Path, PathBuf},
    sync::Arc,
};

use serde::de::DeserializeOwned;
use toml::{
    Spanned,
    de::{DeTable, DeValue},
};

use super::{
    diagnostics,
    overrides::{self, CHOICES, OverrideLocations, subkey},
    value_reader::ValueReader,
};
use crate::error::{Error, ErrorCode, Result};

/// Where the keys of a scene were written. Scenes of equal content are equal wherever they were written.
#[derive(Clone, Debug, Default)]
pub(super) struct SceneSource {
    /// The file as the user named it; empty if a program built the scene.
    pub file: String,
    /// Where the files that the scene names are looked for.
    pub folder: PathBuf,
    /// The text.
    text: Arc<str>,
    /// Where each of its lines begins.
    lines: Vec<usize>,
    /// Where every key begins in it.
    places: BTreeMap<String, usize>,
    /// Keys set on the command line.
    pub sets: Vec<String>,
    /// All keys that the scene has at these keys and below them.
    set_values: BTreeSet<String>,
    /// Names of the solids, in order, so that a key can say `solid.box` for `solid.2`.
    names: Vec<String>,
    /// Keys and values that are written with an old name.
    pub renamed: Vec<RenamedName>,
}

/// A key or a value that is written with an old name, which still works.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RenamedName {
    /// The key, with the names of solids.
    pub key: String,
    /// The old name.
    pub old: &'static str,
    /// The name that replaces it.
    pub new: &'static str,
    /// Where it is written.
    pub source: ValueSource,
}

impl fmt::Display for RenamedName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { key, old, new, source } = self;
        write!(f, "{key} ({source}): \"{old}\" is called \"{new}\" now")
    }
}

/// Old names of keys: their section, empty at the top level, the old key, the new one.
const RENAMED_KEYS: [(&str, &str, &str); 3] =
    [("", "scatter", "jitter"), ("solid", "skin", "contact_skin"), ("check", "delay", "offset")];

/// Old names of values: the key, the old value, the new one.
const RENAMED_VALUES: [(&str, &str, &str); 1] = [("model.walls", "settling", "relaxed_adami")];

impl PartialEq for SceneSource {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// The source of a value.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ValueSource {
    /// The default, with its reason.
    Default(String),
    /// This line of the scene.
    Line(usize),
    /// `--set` on the command line.
    Set,
    /// The program that built the scene.
    Program,
}

impl fmt::Display for ValueSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Default(reason) => write!(f, "default: {reason}"),
            Self::Line(line) => write!(f, "scene line {line}"),
            Self::Set => write!(f, "--set"),
            Self::Program => write!(f, "program"),
        }
    }
}

impl SceneSource {
    /// Adds to `error` the place of `key`, or of the nearest key above it that was written. A check of the domain may have named
    /// a part of `key`.
    pub(crate) fn with_location(&self, mut error: Error, key: &str) -> Error {
        let part = error.location.take_if(|location| location.file.is_empty());
        let key = &part.map_or(key.to_string(), |part| subkey(key, &part.key));
        if self.is_set(key) {
            return error.at("--set", None, self.key_with_names(key));
        }
        if self.file.is_empty() {
            return error.at("a scene built by a program", None, self.key_with_names(key));
        }
        let mut above = key.as_str();
        while !self.places.contains_key(above) && above.contains('.') {
            above = above.rsplit_once('.').map_or("", |(parent, _)| parent);
        }
        let at = self.places.get(above).map(|&start| line_column(&self.text, start));
        error.at(self.file.clone(), at, self.key_with_names(key))
    }

    /// The source of `key`; `None` if it is not written.
    pub(crate) fn source(&self, key: &str) -> Option<ValueSource> {
        if self.set_values.contains(key) || self.has_set_element(key) {
            return Some(ValueSource::Set);
        }
        // A table that is set replaces all that the text has in it.
        if self.is_set(key) || self.file.is_empty() {
            return None;
        }
        self.places.get(key).map(|start| ValueSource::Line(self.lines.partition_point(|line| line <= start)))
    }

    /// Notes that `old` stands at the byte `start` of the text, or in an override, in place of `new`.
    fn note(&mut self, key: &str, old: &'static str, new: &'static str, start: usize) {
        let source = match start < self.text.len() {
            true => ValueSource::Line(line_column(&self.text, start).0),
            false => ValueSource::Set,
        };
        self.renamed.push(RenamedName { key: key.into(), old, new, source });
    }

    /// Whether `key`, or one above it, was set on the command line.
    fn is_set(&self, key: &str) -> bool {
        self.sets.iter().any(|set| key == set || key.starts_with(&format!("{set}.")))
    }

    /// Whether an element of the list `key` was set on the command line.
    fn has_set_element(&self, key: &str) -> bool {
        let is_element = |set: &String| {
            let number = set.strip_prefix(key).and_then(|rest| rest.strip_prefix('.'));
            number.is_some_and(|number| number.parse::<usize>().is_ok())
        };
        self.sets.iter().any(is_element)
    }

    /// `key` with the names of solids in place of their numbers.
    pub(crate) fn key_with_names(&self, key: &str) -> String {
        let mut parts: Vec<&str> = key.split('.').collect();
        if let ["solid", number, ..] = parts[..]
            && let Some(name) = number.parse::<usize>().ok().and_then(|i| self.names.get(i))
            && !name.contains(['.', '/'])
        {
            parts[1] = name;
        }
        parts.join(".")
    }
}

/// Reads a `T` and the places of its keys from `text`; `file` is its name for messages, `sets` the keys and values of
/// `--set`, which replace those of the text.
pub(super) fn read<T: DeserializeOwned>(
    text: &str,
    file: &str,
    folder: &Path,
    sets: &[(String, String)],
) -> Result<(T, SceneSource)> {
    let mut origin = SceneSource { file: file.into(), folder: folder.into(), ..SceneSource::default() };
    let sets = current_names(sets, &mut origin);
    let mut root = DeTable::parse(text).map_err(|e| {
        let at = e.span().map(|span| line_column(text, span.start));
        Error::scene(format!("this is not TOML: {}", e.message()))
            .with_code(ErrorCode::InvalidToml)
            .at(file, at, "")
            .help(diagnostics::toml_help(e.message()))
    })?;
    origin.text = text.into();
    origin.lines = std::iter::once(0).chain(text.match_indices('\n').map(|(i, _)| i + 1)).collect();
    rename(root.get_mut(), &mut origin)?;
    let mut entries = Vec::new();
    walk(root.get_ref(), "", &mut entries);
    origin.places = entries.iter().map(|e| (e.path.clone(), e.key.start)).collect();
    expand_bare_choices(root.get_mut());
    let mut marks = OverrideLocations::after(text);
    for (i, (key, value)) in sets.iter().enumerate() {
        let place = overrides::apply_override(root.get_mut(), key, value, &mut marks)
            .map_err(|e| e.at("--set", None, key.clone()))?;
        // An entry of a list has a name and a number.
        let earlier = sets[..i].iter().zip(&origin.sets).find(|((other, _), before)| **before == place && other != key);
        if let Some(((other, _), _)) = earlier {
            return Err(Error::scene(format!("\"{other}\" and \"{key}\" are the same key"))
                .with_code(ErrorCode::ConflictingKeys)
                .at("--set", None, key.clone())
                .help("leave one of the two out"));
        }
        origin.sets.push(place);
    }
    rename(root.get_mut(), &mut origin)?;
    expand_bare_choices(root.get_mut());
    let mut entries_now = Vec::new();
    walk(root.get_ref(), "", &mut entries_now);
    origin.set_values = entries_now.into_iter().map(|e| e.path).filter(|path| origin.is_set(path)).collect();
    origin.names = solid_names(root.get_ref());
    for i in 0..origin.renamed.len() {
        origin.renamed[i].key = origin.key_with_names(&origin.renamed[i].key);
    }
    require_finite(root.get_ref(), "", &origin)?;
    let whole = root.span();
    let scene = T::deserialize(ValueReader::from(root)).map_err(|e| {
        let span = e.span.unwrap_or(0..0);
        let start = span.start;
        // The first section may begin where the scene does.
        let written = || if span == whole { String::new() } else { key_at(&entries, &span) };
        let key = marks.key(start).unwrap_or_else(written);
        let (error, key) = diagnostics::explain(&e.message, &key);
        let shown = origin.key_with_names(&key);
        match start > text.len() {
            true => error.at("--set", None, shown),
            false => error.at(file, Some(line_column(text, start)), shown),
        }
    })?;
    Ok((scene, origin))
}

/// Line and column, from 1, of the byte `at`.
fn line_column(text: &str, at: usize) -> (usize, usize) {
    let mut at = at.min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    let before = &text[..at];
    let start = before.rfind('\n').map_or(0, |i| i + 1);
    (before.matches('\n').count() + 1, before[start..].chars().count() + 1)
}

/// A key that was written.
struct WrittenKey {
    path: String,
    key: Range<usize>,
    value: Range<usize>,
}

fn walk(table: &DeTable, path: &str, entries: &mut Vec<WrittenKey>) {
    for (key, value) in table {
        let path = subkey(path, key.get_ref());
        entries.push(WrittenKey { path: path.clone(), key: key.span(), value: value.span() });
        walk_value(value, &path, entries);
    }
}

fn walk_value(value: &Spanned<DeValue>, path: &str, entries: &mut Vec<WrittenKey>) {
    match value.get_ref() {
        DeValue::Table(inner) => walk(inner, path, entries),
        DeValue::Array(items) => {
            for (i, item) in items.iter().enumerate() {
                let path = subkey(path, i);
                entries.push(WrittenKey { path: path.clone(), key: item.span(), value: item.span() });
                walk_value(item, &path, entries);
            }
        }
        _ => {}
    }
}

/// The key that was written at `span`, or whose value encloses it most closely.
fn key_at(entries: &[WrittenKey], span: &Range<usize>) -> String {
    let exact = entries.iter().find(|e| e.key == *span);
    let enclosing = || {
        let holds = |e: &&WrittenKey| e.value.start <= span.start && span.end <= e.value.end;
        entries.iter().filter(holds).min_by_key(|e| e.value.end - e.value.start)
    };
    exact.or_else(enclosing).map(|e| e.path.clone()).unwrap_or_default()
}

fn solid_names(root: &DeTable) -> Vec<String> {
    let solids = root.get("solid").and_then(|s| s.get_ref().as_array());
    let name = |solid: &Spanned<DeValue>| {
        let name = solid.get_ref().as_table()?.get("name")?.get_ref().as_str()?;
        Some(name.to_string())
    };
    solids.into_iter().flat_map(|s| s.iter()).enumerate().map(|(i, s)| name(s).unwrap_or(i.to_string())).collect()
}

/// Replaces every choice that is a bare word by a table.
fn expand_bare_choices(root: &mut DeTable) {
    for choice in CHOICES {
        let Some((section, key)) = choice.split_once('.') else { continue };
        let Some(DeValue::Table(section)) = root.get_mut(section).map(Spanned::get_mut) else { continue };
        let Some(value) = section.get_mut(key) else { continue };
        let span = value.span();
        let DeValue::String(word) = value.get_ref() else { continue };
        let mut table = DeTable::new();
        let nothing = Spanned::new(span.clone(), DeValue::Table(DeTable::new()));
        table.insert(Spanned::new(span, Cow::Owned(word.to_string())), nothing);
        *value.get_mut() = DeValue::Table(table);
    }
}

/// The overrides with the current names of their keys and values.
fn current_names(sets: &[(String, String)], origin: &mut SceneSource) -> Vec<(String, String)> {
    let current = |(key, value): &(String, String)| {
        let mut note = |key: &str, old, new| {
            origin.renamed.push(RenamedName { key: key.into(), old, new, source: ValueSource::Set });
        };
        if let Some((old, new)) = renamed_key(key) {
            note(key, old, new);
        }
        let plain = value.trim().trim_matches(['"', '\'']);
        match RENAMED_VALUES.into_iter().find(|(of, old, _)| key == of && plain == *old) {
            Some((_, old, new)) => {
                note(key, old, new);
                (key.clone(), new.into())
            }
            None => (current_key(key), value.clone()),
        }
    };
    sets.iter().map(current).collect()
}

/// The old and the current name of the last part of `key`; `None` if it was not renamed.
fn renamed_key(key: &str) -> Option<(&'static str, &'static str)> {
    let parts: Vec<&str> = key.split('.').collect();
    let renamed = RENAMED_KEYS.into_iter().find(|(section, old, _)| match parts[..] {
        [word] => section.is_empty() && word == *old,
        [first, _, word] => first == *section && word == *old,
        _ => false,
    });
    renamed.map(|(_, old, new)| (old, new))
}

/// `key`, an override's, with the current name of its last part.
pub fn current_key(key: &str) -> String {
    match renamed_key(key) {
        Some((old, new)) => format!("{}{new}", key.strip_suffix(old).unwrap_or(key)),
        None => key.into(),
    }
}

/// Puts the current names of keys and values in place of old ones, and notes each.
fn rename(root: &mut DeTable, origin: &mut SceneSource) -> Result<()> {
    for (section, old, new) in RENAMED_KEYS {
        if section.is_empty() {
            rename_key(root, section, old, new, origin)?;
        } else if let Some(DeValue::Array(items)) = root.get_mut(section).map(Spanned::get_mut) {
            for (i, item) in items.as_mut().iter_mut().enumerate() {
                if let DeValue::Table(table) = item.get_mut() {
                    rename_key(table, &subkey(section, i), old, new, origin)?;
                }
            }
        }
    }
    for (key, old, new) in RENAMED_VALUES {
        let Some((section, word)) = key.split_once('.') else { continue };
        let Some(DeValue::Table(section)) = root.get_mut(section).map(Spanned::get_mut) else { continue };
        let Some(value) = section.get_mut(word) else { continue };
        let start = value.span().start;
        match value.get_mut() {
            DeValue::String(text) if text.as_ref() == old => {
                *text = Cow::Borrowed(new);
                origin.note(key, old, new, start);
            }
            DeValue::Table(choice) => rename_key(choice, key, old, new, origin)?,
            _ => {}
        }
    }
    Ok(())
}

/// Renames the key `old` of the table at `path` to `new`.
fn rename_key(
    table: &mut DeTable,
    path: &str,
    old: &'static str,
    new: &'static str,
    origin: &mut SceneSource,
) -> Result<()> {
    let Some(span) = table.keys().find(|key| key.get_ref() == old).map(Spanned::span) else { return Ok(()) };
    let start = span.start;
    if table.contains_key(new) {
        let what = format!("{old} and {new} say the same thing twice");
        let help = format!("{old} is the old name of {new}: remove it");
        let at = (start < origin.text.len()).then(|| line_column(&origin.text, start));
        return Err(Error::scene(what).with_code(ErrorCode::ConflictingKeys).help(help).at(
            origin.file.clone(),
            at,
            subkey(path, old),
        ));
    }
    if let Some(value) = table.remove(old) {
        table.insert(Spanned::new(span, Cow::Borrowed(new)), value);
        origin.note(&subkey(path, old), old, new, start);
    }
    Ok(())
}

/// Refuses numbers that are not numbers.
fn require_finite(table: &DeTable, path: &str, origin: &SceneSource) -> Result<()> {
    table.iter().try_for_each(|(key, value)| require_finite_value(value, &subkey(path, key.get_ref()), origin))
}

fn require_finite_value(value: &Spanned<DeValue>, path: &str, origin: &SceneSource) -> Result<()> {
    match value.get_ref() {
        DeValue::Float(x) if !x.as_str().replace('_', "").parse::<f64>().is_ok_and(f64::is_finite) => {
            let error = Error::scene(format!("{} is not a finite number", x.as_str()))
                .with_code(ErrorCode::OutOfRange)
                .help("write a number; where you mean \"no limit\", leave the line out");
            Err(origin.with_location(error, path))
        }
        DeValue::Table(inner) => require_finite(inner, path, origin),
        DeValue::Array(items) => {
            items.iter().enumerate().try_for_each(|(i, item)| require_finite_value(item, &subkey(path, i), origin))
        }
        _ => Ok(()),
    }
}
