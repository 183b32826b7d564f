//! `--set key=value`: puts a value into the TOML of a scene before it is deserialised.

use std::{borrow::Cow, ops::Range};

use serde::Deserialize;
use toml::{
    Spanned,
    de::{DeTable, DeValue, ValueDeserializer},
};

use super::diagnostics;
use crate::{
    error::{Error, ErrorCode, Result, suggestion},
    probe::ProbeConfig,
};

/// Keys whose value selects one of several laws.
pub(super) const CHOICES: [&str; 9] = [
    "model.kernel",
    "model.viscosity",
    "model.diffusion",
    "model.shifting",
    "model.walls",
    "model.gradient",
    "model.slip",
    "model.sweep",
    "time.scheme",
];

/// Returns the key `part` inside the key `path`.
pub(super) fn subkey(path: &str, part: impl std::fmt::Display) -> String {
    if path.is_empty() { part.to_string() } else { format!("{path}.{part}") }
}

/// The locations of the keys of `--set`. Each key has a location beyond the end of the text.
pub(super) struct OverrideLocations {
    /// The first location.
    first: usize,
    /// The keys, in the order of their locations.
    keys: Vec<String>,
}

impl OverrideLocations {
    /// Creates an empty list of locations for overrides of `text`.
    pub(crate) fn after(text: &str) -> Self {
        Self { first: text.len() + 1, keys: Vec::new() }
    }

    /// Returns a new location for `key`.
    pub(crate) fn place(&mut self, key: &str) -> Range<usize> {
        let place = self.first + self.keys.len();
        self.keys.push(key.into());
        place..place
    }

    /// Returns the key at a location, or `None` if the location is in the text.
    pub(crate) fn key(&self, place: usize) -> Option<String> {
        self.keys.get(place.checked_sub(self.first)?).cloned()
    }
}

/// Puts the value written as `text` at `key` and assigns locations from `marks` to its parts. A text that is not a TOML
/// value counts as a string, unless it begins as a list or a table. Returns the key with numbers in place of names.
///
/// # Errors
/// `Scene` if `key` is not a valid key, or names a list entry that does not exist, or if a list or table is not TOML.
pub(super) fn apply_override<'i>(
    root: &mut DeTable<'i>,
    key: &'i str,
    text: &'i str,
    marks: &mut OverrideLocations,
) -> Result<String> {
    let parts: Vec<&str> = key.split('.').collect();
    if parts.iter().any(|part| part.is_empty()) {
        return Err(Error::scene(format!("\"{key}\" is not a key"))
            .with_code(ErrorCode::UnknownKey)
            .help("write  --set model.h_over_dp=1.5"));
    }
    let value = match DeValue::parse(text) {
        Ok(value) => value.into_inner(),
        Err(e) if text.trim_start().starts_with(['[', '{']) => {
            return Err(Error::scene(format!("this is not TOML: {}", e.message()))
                .with_code(ErrorCode::InvalidToml)
                .help(diagnostics::toml_help(e.message())));
        }
        Err(_) => DeValue::String(Cow::Borrowed(text.trim())),
    };
    put_in(root, &parts, "", value, marks)
}

/// Puts `value` into the table at `path`. `parts` has at least one part.
fn put_in<'i>(
    table: &mut DeTable<'i>,
    parts: &[&'i str],
    path: &str,
    value: DeValue<'i>,
    marks: &mut OverrideLocations,
) -> Result<String> {
    let path = subkey(path, parts[0]);
    let place = marks.place(&path);
    let nothing = Spanned::new(place.clone(), DeValue::Table(DeTable::new()));
    let here = table.entry(Spanned::new(place, Cow::Borrowed(parts[0]))).or_insert_with(|| nothing);
    insert_value(here, &parts[1..], path, value, marks)
}

fn insert_value<'i>(
    here: &mut Spanned<DeValue<'i>>,
    parts: &[&'i str],
    path: String,
    value: DeValue<'i>,
    marks: &mut OverrideLocations,
) -> Result<String> {
    let Some(part) = parts.first() else {
        *here = with_locations(value, &path, marks);
        return Ok(path);
    };
    let choice = CHOICES.contains(&path.as_str());
    match here.get_mut() {
        DeValue::Array(items) => {
            let number = entry_index(&path, items, part)?;
            insert_value(&mut items.as_mut()[number], &parts[1..], subkey(&path, number), value, marks)
        }
        DeValue::Table(inner) if !choice || inner.contains_key(*part) => put_in(inner, parts, &path, value, marks),
        _ => {
            let mut inner = DeTable::new();
            let path = put_in(&mut inner, parts, &path, value, marks)?;
            *here.get_mut() = DeValue::Table(inner);
            Ok(path)
        }
    }
}

/// Returns the index of the list entry that `word` identifies by its `name` or by its number.
fn entry_index(path: &str, items: &[Spanned<DeValue>], word: &str) -> Result<usize> {
    let name = |item: &Spanned<DeValue>| {
        item.get_ref().as_table().and_then(|t| t.get("name")).and_then(|n| n.get_ref().as_str()).map(String::from)
    };
    let names: Vec<String> = match probe_names(path, items) {
        Some(names) => names,
        None => items.iter().enumerate().map(|(i, item)| name(item).unwrap_or(i.to_string())).collect(),
    };
    let by_number = || word.parse::<usize>().ok().filter(|i| *i < items.len());
    names.iter().position(|n| n == word).or_else(by_number).ok_or_else(|| {
        let guess = suggestion(word, names.iter().map(String::as_str));
        Error::scene(format!("no {path} is called \"{word}\"{guess}"))
            .with_code(ErrorCode::UnknownName)
            .help(format!("known: {}", names.join(", ")))
    })
}

/// Returns the names of the probes, with their default names; `None` for other lists or invalid probes.
fn probe_names(path: &str, items: &[Spanned<DeValue>]) -> Option<Vec<String>> {
    let items = items.iter().filter(|_| path == "probe");
    let probes = items.map(|item| ProbeConfig::deserialize(ValueDeserializer::from(item.clone())).ok());
    let probes: Vec<ProbeConfig> = probes.collect::<Option<_>>()?;
    (!probes.is_empty()).then(|| ProbeConfig::names(&probes))
}

/// Returns the value of `key` with a separate location for each of its parts.
fn with_locations<'i>(value: DeValue<'i>, key: &str, marks: &mut OverrideLocations) -> Spanned<DeValue<'i>> {
    let place = marks.place(key);
    let value = match value {
        DeValue::Array(items) => {
            let each = items.into_iter().enumerate();
            DeValue::Array(each.map(|(i, item)| with_locations(item.into_inner(), &subkey(key, i), marks)).collect())
        }
        DeValue::Table(table) => {
            let mut inner = DeTable::new();
            for (word, value) in table {
                let key = subkey(key, word.get_ref());
                let word = Spanned::new(marks.place(&key), word.into_inner());
                inner.insert(word, with_locations(value.into_inner(), &key, marks));
            }
            DeValue::Table(inner)
        }
        other => other,
    };
    Spanned::new(place, value)
}
