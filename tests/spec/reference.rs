//! The reference of a scene's words, `docs/scene.md`, against the types that read them: no key there that is none, no default
//! that is another, no fragment that is not read. That every key and word is there is in `schema`.

use std::{collections::BTreeSet, fs, path::Path};

use pontoon::scene::{Scene, schema};

use crate::schema::known;

/// A row of a table of the reference.
struct Row {
    /// The heading that it stands under.
    section: String,
    /// Its first key.
    head: String,
    /// Its cells: keys, unit, default, meaning.
    cells: Vec<String>,
}

/// The reference, without its program.
fn page() -> String {
    let text = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/scene.md")).unwrap();
    text.split("## From Rust").next().unwrap().to_string()
}

/// What stands between back-quotes.
fn code(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2)
}

/// The names in a piece of code that are not quoted.
fn names(code: &str) -> Vec<&str> {
    let open = code.split('"').step_by(2);
    let names = open.flat_map(|part| part.split(|c: char| !c.is_alphanumeric() && c != '_'));
    names.filter(|name| name.starts_with(|c: char| c.is_alphabetic())).collect()
}

/// The rows that are of keys.
fn rows() -> Vec<Row> {
    let (mut rows, mut section) = (Vec::new(), String::new());
    for line in page().lines() {
        if let Some(heading) = line.strip_prefix("## ") {
            section = heading.to_string();
        }
        if line.starts_with("| `") {
            let cells: Vec<String> = line.trim_matches('|').split('|').map(|cell| cell.trim().to_string()).collect();
            let first = code(&cells[0]).next().unwrap();
            let head = first.split(|c: char| !c.is_alphanumeric() && c != '_' && c != '.').next().unwrap().to_string();
            rows.push(Row { section: section.clone(), head, cells });
        }
    }
    rows
}

#[test]
fn every_key_of_the_reference_is_a_key_of_a_scene() {
    let mut words = BTreeSet::new();
    known(&schema(), &mut words);
    let rows = rows();
    assert!(rows.len() > 120, "{} rows were found", rows.len());
    for row in rows {
        for name in code(&row.cells[0]).flat_map(names) {
            assert!(words.contains(name), "{name}, under {}, is no key of a scene", row.section);
        }
    }
}

/// A scene in which nearly nothing is said.
const SCENE: &str = r#"
dimension = 2
dp = 0.02
until = 1.0
[[water]]
fill = { box = { min = [0.0, 0.0], max = [3.0, 0.4] } }
[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [3.2, 0.8] } }
at = { x = -0.2 }
[[solid]]
name = "paddle"
shape = { box = { size = [0.1, 0.8] } }
at = { x = -0.05, bottom = 0.0 }
driven = { along = [1.0, 0.0], wave = { WAVE } }
[[damping]]
from = [2.0, 0.0]
to = [3.0, 0.0]
[[solid]]
name = "buoy"
shape = { box = { size = [0.4, 0.2] } }
at = { x = 1.0, bottom = 0.3 }
free = { density = 500.0 }
[[spring]]
name = "line"
between = ["buoy"]
from = [1.0, 0.3]
to = [1.0, 0.0]
stiffness = 10.0
[[probe]]
motion = "buoy"
"#;

/// Sections, what the keys there are called in a list of values in force, and whether all of them have to be in the reference.
const SECTIONS: [(&str, &str, bool); 8] = [
    ("`[model]`", "model.", true),
    ("`[time]`", "time.", true),
    ("`[guard]`", "guard.", true),
    ("`[[damping]]`", "damping.0.", true),
    ("`[frames]`", "", false),
    ("`[[solid]]`", "solid.paddle.driven.wave.", false),
    ("`[[solid]]`", "solid.buoy.", false),
    ("`[[joint]]`", "spring.line.", false),
];

/// Defaults that follow from other values, and have no number of their own.
const DERIVED: [&str; 6] = [
    "model.h",
    "model.c0",
    "damping.0.strength",
    "frames.every",
    "solid.paddle.driven.wave.ramp",
    "spring.line.length",
];

/// The numbers in a text.
fn numbers(text: &str) -> Vec<f64> {
    let parts = text.split(|c: char| !c.is_ascii_digit() && c != '.');
    parts.filter_map(|part| part.trim_end_matches('.').parse().ok()).collect()
}

#[test]
fn every_default_of_the_reference_is_that_of_a_scene() {
    let (rows, mut count) = (rows(), 0);
    for wave in [
        "regular = { height = 0.06, period = 1.2 }",
        "jonswap = { height = 0.06, peak_period = 1.2 }",
        "solitary = { height = 0.06 }",
    ] {
        let scene = Scene::parse(&SCENE.replace("WAVE", wave), Path::new(""), &[]).unwrap();
        for value in scene.resolve().unwrap() {
            let unsaid = value.source.to_string().starts_with("default") && !DERIVED.contains(&value.key.as_str());
            for (section, prefix, all) in SECTIONS.iter().filter(|_| unsaid) {
                let Some(key) = value.key.strip_prefix(prefix) else { continue };
                let of = |row: &&Row| {
                    row.section.starts_with(section) && (row.head == key || key.starts_with(&format!("{}.", row.head)))
                };
                let Some(row) = rows.iter().find(of) else {
                    assert!(!all, "{} has no row under {section}", value.key);
                    continue;
                };
                count += 1;
                let (line, default) = (row.cells.join(" | "), &row.cells[2]);
                let told = numbers(default);
                let same = numbers(&value.value).iter().all(|x| told.contains(x));
                let named = key.split('.').all(|part| line.contains(part));
                let word = names(&value.value.replace('"', " ")).into_iter().all(|word| default.contains(word));
                assert!(same && named && word, "{value}, but the reference says: {line}");
            }
        }
    }
    assert!(count > 50, "{count} defaults were compared");
}

#[test]
fn every_fragment_of_the_reference_is_read() {
    let page = page();
    let blocks = page.split("```toml\n").skip(1).map(|rest| rest.split("```").next().unwrap());
    // Each begins with a word of its own, such as `driven`, at the start of a line.
    let fragments: Vec<String> = blocks
        .flat_map(|block| block.split("\ndriven"))
        .map(|part| format!("driven{}", part.trim_start_matches("driven")))
        .collect();
    assert!(fragments.len() >= 3, "{fragments:?}");
    for fragment in fragments {
        let driven = "driven = { along = [1.0, 0.0], wave = { WAVE } }";
        let text = SCENE.replace(driven, &fragment);
        let said = Scene::parse(&text, Path::new(""), &[]).and_then(|scene| scene.resolve()).err();
        assert!(said.is_none(), "{fragment}: {}", said.unwrap());
    }
}
