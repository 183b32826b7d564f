//! `--set key=value`: puts a value into a scene that was read, before its words are understood.

use std::{borrow::Cow, ops::Range};

use toml::{
    Spanned,
    de::{DeTable, DeValue},
};

use super::document::{CHOICES, under};
use crate::error::{Error, Result, nearest};

/// Puts the value written as `text` at `key`, as if it had been written at `span`; what is no TOML value
/// is a word. Returns the key with numbers in place of names.
///
/// # Errors
/// `Scene` if `key` is no key, or names an entry of a list that is not there.
pub(super) fn set<'i>(root: &mut DeTable<'i>, key: &'i str, text: &'i str, span: Range<usize>) -> Result<String> {
    let parts: Vec<&str> = key.split('.').collect();
    if parts.iter().any(|part| part.is_empty()) {
        return Err(Error::scene(format!("\"{key}\" is not a key")).help("write  --set model.h_over_dp=1.5"));
    }
    let value = match DeValue::parse(text) {
        Ok(value) => moved(value.into_inner(), &span),
        Err(_) => Spanned::new(span, DeValue::String(Cow::Borrowed(text.trim()))),
    };
    put_in(root, &parts, String::new(), value)
}

/// Puts `value` into a table; `parts` has one part or more.
fn put_in<'i>(table: &mut DeTable<'i>, parts: &[&'i str], path: String, value: Spanned<DeValue<'i>>) -> Result<String> {
    let span = value.span();
    let nothing = Spanned::new(span.clone(), DeValue::Table(DeTable::new()));
    let here = table.entry(Spanned::new(span, Cow::Borrowed(parts[0]))).or_insert_with(|| nothing);
    put(here, &parts[1..], under(&path, parts[0]), value)
}

fn put<'i>(
    here: &mut Spanned<DeValue<'i>>,
    parts: &[&'i str],
    path: String,
    value: Spanned<DeValue<'i>>,
) -> Result<String> {
    let Some(part) = parts.first() else {
        *here = value;
        return Ok(path);
    };
    let choice = CHOICES.contains(&path.as_str());
    match here.get_mut() {
        DeValue::Array(items) => {
            let number = pick(&path, items, part)?;
            put(&mut items.as_mut()[number], &parts[1..], under(&path, number), value)
        }
        DeValue::Table(inner) if !choice || inner.contains_key(*part) => put_in(inner, parts, path, value),
        _ => {
            let mut inner = DeTable::new();
            let path = put_in(&mut inner, parts, path, value)?;
            *here.get_mut() = DeValue::Table(inner);
            Ok(path)
        }
    }
}

/// The number of the entry of a list that `word` names, by its `name` or by its number.
fn pick(path: &str, items: &[Spanned<DeValue>], word: &str) -> Result<usize> {
    let name = |item: &Spanned<DeValue>| {
        item.get_ref().as_table().and_then(|t| t.get("name")).and_then(|n| n.get_ref().as_str()).map(String::from)
    };
    let names: Vec<String> = items.iter().enumerate().map(|(i, item)| name(item).unwrap_or(i.to_string())).collect();
    let by_number = || word.parse::<usize>().ok().filter(|i| *i < items.len());
    names.iter().position(|n| n == word).or_else(by_number).ok_or_else(|| {
        let guess = nearest(word, names.iter().map(String::as_str));
        let guess = guess.map_or(String::new(), |n| format!("; did you mean \"{n}\"?"));
        Error::scene(format!("no {path} is called \"{word}\"{guess}")).help(format!("known: {}", names.join(", ")))
    })
}

/// The same value as if it had been written at `span`.
fn moved<'i>(value: DeValue<'i>, span: &Range<usize>) -> Spanned<DeValue<'i>> {
    let value = match value {
        DeValue::Array(items) => DeValue::Array(items.into_iter().map(|i| moved(i.into_inner(), span)).collect()),
        DeValue::Table(table) => {
            let rename = |(k, v): (Spanned<Cow<'i, str>>, Spanned<DeValue<'i>>)| {
                (Spanned::new(span.clone(), k.into_inner()), moved(v.into_inner(), span))
            };
            let mut inner = DeTable::new();
            for (key, value) in table.into_iter().map(rename) {
                inner.insert(key, value);
            }
            DeValue::Table(inner)
        }
        other => other,
    };
    Spanned::new(span.clone(), value)
}
