//! Reads the source as text and holds it to the habits of docs/architecture.md.

use std::{
    fs,
    path::{Path, PathBuf},
};

/// The rooms in the order in which they depend on one another.
const ROOMS: [&str; 26] = [
    "error",
    "words",
    "series",
    "space",
    "lanes",
    "law",
    "particles",
    "shape",
    "near",
    "solid",
    "sweep",
    "model",
    "system",
    "time",
    "simulation",
    "plan",
    "probe",
    "check",
    "stats",
    "record",
    "scene",
    "preflight",
    "run",
    "report",
    "study",
    "bench",
];

/// Every Rust file of the library and the binary, with its text.
fn sources() -> Vec<(PathBuf, String)> {
    fn collect(folder: &Path, into: &mut Vec<(PathBuf, String)>) {
        for entry in fs::read_dir(folder).unwrap().flatten() {
            let path = entry.path();
            if path.is_dir() {
                collect(&path, into);
            } else if path.extension().is_some_and(|e| e == "rs") {
                let text = fs::read_to_string(&path).unwrap();
                into.push((path, text));
            }
        }
    }
    let mut all = Vec::new();
    collect(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), &mut all);
    all.sort();
    assert!(all.len() > 30, "the source was found");
    all
}

/// The room that a file belongs to; none for `lib.rs` and the binary.
fn room(path: &Path) -> Option<usize> {
    let inside = path.strip_prefix(Path::new(env!("CARGO_MANIFEST_DIR")).join("src")).unwrap();
    let first = inside.components().next().unwrap().as_os_str().to_str().unwrap();
    ROOMS.iter().position(|r| *r == first.trim_end_matches(".rs"))
}

/// The text without its tests at the end and without comments.
fn code(text: &str) -> String {
    let end = text.find("#[cfg(test)]\nmod tests").unwrap_or(text.len());
    text[..end].lines().map(|line| line.split("//").next().unwrap_or("")).collect::<Vec<_>>().join("\n")
}

fn findings(check: impl Fn(&Path, &str) -> Vec<String>) {
    let found: Vec<String> = sources()
        .iter()
        .flat_map(|(path, text)| check(path, text).into_iter().map(move |what| format!("{}: {what}", path.display())))
        .collect();
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

#[test]
fn files_open_with_what_and_why_and_end_before_line_400() {
    findings(|_, text| {
        let mut found = Vec::new();
        if !text.starts_with("//!") {
            found.push("does not open with //!".into());
        }
        if text.lines().count() > 400 {
            found.push(format!("{} lines: is it one room?", text.lines().count()));
        }
        found
    });
}

#[test]
fn rooms_import_only_from_rooms_above() {
    findings(|path, text| {
        let Some(own) = room(path) else { return Vec::new() };
        let text = code(text);
        // Both `crate::room` and the first names of `use crate::{…}` blocks count.
        let mut named: Vec<String> = text
            .split("crate::")
            .skip(1)
            .map(|rest| rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect())
            .collect();
        for block in text.split("use crate::{").skip(1) {
            let mut depth = 0;
            let mut word = String::new();
            for c in block.chars() {
                match c {
                    '{' => depth += 1,
                    '}' if depth == 0 => break,
                    '}' => depth -= 1,
                    c if depth == 0 && (c.is_alphanumeric() || c == '_') => {
                        word.push(c);
                        continue;
                    }
                    _ => {}
                }
                if depth <= 1 && !word.is_empty() {
                    named.push(std::mem::take(&mut word));
                }
            }
        }
        named
            .into_iter()
            .filter_map(|name| ROOMS.iter().position(|r| *r == name))
            .filter(|&other| other > own)
            .map(|other| format!("{} imports from {}, a room below it", ROOMS[own], ROOMS[other]))
            .collect()
    });
}

#[test]
fn engines_threads_and_printing_stay_in_their_rooms() {
    let places: [(&str, &[&str]); 8] = [
        ("rapier", &["solid"]),
        ("parry", &["solid", "shape"]),
        ("rayon", &["near", "sweep", "system", "time", "simulation", "shape", "run"]),
        ("fearless_simd", &["lanes", "law", "near", "sweep"]),
        ("vtkio", &["record"]),
        ("realfft", &["stats"]),
        ("zip::", &["record"]),
        ("println!", &[]),
    ];
    findings(|path, text| {
        let Some(own) = room(path) else { return Vec::new() };
        let text = code(text);
        places
            .iter()
            .filter(|(word, rooms)| text.contains(word) && !rooms.contains(&ROOMS[own]))
            .map(|(word, _)| format!("{word} is not at home in {}", ROOMS[own]))
            .collect()
    });
}

#[test]
fn the_library_neither_panics_on_purpose_nor_leaves_notes() {
    findings(|path, text| {
        // A file of its own that holds the tests of a room may say what it likes.
        if room(path).is_none() || path.file_name().is_some_and(|name| name == "tests.rs") {
            return Vec::new();
        }
        let text = code(text);
        [".unwrap()", ".expect(", "todo!", "unimplemented!", "dbg!", "TODO", "FIXME", "unsafe "]
            .iter()
            .filter(|word| text.contains(**word))
            .map(|word| format!("has {word}"))
            .collect()
    });
}

#[test]
fn cited_keys_are_in_the_bibliography() {
    let bib = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/references.bib")).unwrap();
    findings(|_, text| {
        text.split("[@")
            .skip(1)
            .filter_map(|rest| rest.split(']').next())
            .filter(|key| !bib.contains(&format!("{{{key},")))
            .map(|key| format!("cites {key}, which docs/references.bib does not have"))
            .collect()
    });
}
