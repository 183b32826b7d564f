//! Reads the source as text and checks the rules of docs/explanation/architecture.md that lints cannot express.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout, clippy::print_stderr, reason = "tests may")]

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

/// The modules of the library in dependency order: each uses only those before it.
const MODULES: [&str; 27] = [
    "error",
    "math",
    "ranks",
    "sph",
    "particles",
    "geometry",
    "neighbours",
    "wavemaker",
    "solid",
    "interaction",
    "model",
    "system",
    "coupling",
    "time_integration",
    "device",
    "simulation",
    "probe",
    "plan",
    "analysis",
    "output",
    "scene",
    "preflight",
    "run",
    "report",
    "study",
    "bench",
    "prelude",
];

/// Names that the glossary replaced: they may not come back as names of types, functions, fields or modules.
const BANNED: [&str; 40] = [
    "hem",
    "gifts",
    "goals",
    "ousted",
    "oust",
    "renew",
    "relist",
    "dismiss",
    "whirl",
    "burden",
    "rescue",
    "booked",
    "hosted",
    "withheld",
    "rig",
    "swallowed",
    "strangers",
    "easel",
    "ink",
    "shelf",
    "journal",
    "obey",
    "complain",
    "said",
    "told",
    "astray",
    "stands",
    "faces",
    "looks",
    "kept",
    "course",
    "books",
    "ledger",
    "handover",
    "draught",
    "wedge",
    "seen",
    "yielding",
    "barrier",
    "settling",
];

/// Uses of banned names that remain, with their number. The list may only shrink.
const REMAINING: &str = "tests/golden/banned.txt";

/// Most lines of code of a file, tests not counted.
const FILE_LINES: usize = 500;

/// Most fields of a struct.
const FIELDS: usize = 15;

/// Most files with inherent `impl` blocks of one type.
const IMPL_FILES: usize = 3;

fn home() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

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
    collect(&home().join("src"), &mut all);
    all.sort();
    assert!(all.len() > 30, "source files were found");
    all
}

/// The module that a file belongs to; none for `lib.rs` and the binary.
fn module(path: &Path) -> Option<usize> {
    let inside = path.strip_prefix(home().join("src")).unwrap();
    let first = inside.components().next().unwrap().as_os_str().to_str().unwrap();
    MODULES.iter().position(|r| *r == first.trim_end_matches(".rs"))
}

/// The text without its tests at the end and without comments.
fn code(text: &str) -> String {
    let end = text.find("#[cfg(test)]\nmod ").unwrap_or(text.len());
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
fn files_begin_with_a_module_comment_and_have_at_most_500_lines_of_code() {
    findings(|_, text| {
        let mut found = Vec::new();
        if !text.starts_with("//!") {
            found.push("does not begin with //!".into());
        }
        let lines = code(text).lines().filter(|line| !line.trim().is_empty()).count();
        if lines > FILE_LINES {
            found.push(format!("{lines} lines of code, at most {FILE_LINES}"));
        }
        found
    });
}

#[test]
fn modules_use_only_modules_before_them() {
    findings(|path, text| {
        let Some(own) = module(path) else { return Vec::new() };
        let text = code(text);
        // Both `crate::module` and the first names of `use crate::{…}` blocks count.
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
            .filter_map(|name| MODULES.iter().position(|r| *r == name))
            .filter(|&other| other > own)
            .map(|other| format!("{} uses {}, a module after it", MODULES[own], MODULES[other]))
            .collect()
    });
}

#[test]
fn external_crates_and_printing_are_used_in_their_modules_only() {
    let places: [(&str, &[&str]); 7] = [
        ("rapier", &["solid"]),
        ("parry", &["solid", "geometry"]),
        (
            "rayon",
            &[
                "math",
                "neighbours",
                "interaction",
                "system",
                "coupling",
                "time_integration",
                "simulation",
                "geometry",
                "run",
            ],
        ),
        ("fearless_simd", &["math", "sph", "neighbours", "interaction"]),
        ("realfft", &["analysis"]),
        ("zip::", &["output"]),
        ("println!", &[]),
    ];
    findings(|path, text| {
        let Some(own) = module(path) else { return Vec::new() };
        let text = code(text).replace("solid::rapier", "").replace("mod rapier", "");
        places
            .iter()
            .filter(|(word, modules)| text.contains(word) && !modules.contains(&MODULES[own]))
            .map(|(word, _)| format!("{word} is not allowed in {}", MODULES[own]))
            .collect()
    });
}

#[test]
fn the_library_has_at_most_20_direct_dependencies_and_the_program_34() {
    let manifest: String = fs::read_to_string(home().join("Cargo.toml")).unwrap();
    let dependencies = manifest.split("[dependencies]\n").nth(1).and_then(|rest| rest.split("\n[").next()).unwrap();
    let all: Vec<&str> = dependencies.lines().filter(|line| line.contains(" = ")).collect();
    // An engine has two crates for each dimension; all other optional crates belong to `cli`, `surface` or `gpu`.
    let required = all.iter().filter(|line| !line.contains("optional = true")).count();
    assert!(required + 2 <= 20, "{required} required crates and two of an engine");
    let others = ["splashsurf_lib", "mpi ", "bytemuck", "naga", "pollster", "wgpu"];
    let program = all.iter().filter(|line| !others.iter().any(|name| line.starts_with(name))).count();
    assert!(program <= 34, "{program} crates of the program");
}

#[test]
fn no_struct_of_the_physics_has_more_than_15_fields() {
    let physics = MODULES.iter().position(|name| *name == "plan");
    findings(|path, text| {
        // Types of output files and of TOML sections have a field for each of their entries.
        if module(path).is_none_or(|own| Some(own) >= physics) || path.ends_with("model.rs") {
            return Vec::new();
        }
        let text = code(text);
        let mut found = Vec::new();
        for rest in text.split("struct ").skip(1) {
            let Some((head, body)) = rest.split_once('{') else { continue };
            if head.contains(';') || head.contains('(') {
                continue;
            }
            let body = body.split("\n}").next().unwrap_or("");
            let fields = body.lines().filter(|line| {
                let line = line.trim_start().trim_start_matches("pub ").trim_start_matches("pub(crate) ");
                let line = line.trim_start_matches("pub(super) ");
                let name: String = line.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
                !name.is_empty() && line[name.len()..].starts_with(": ")
            });
            let count = fields.count();
            if count > FIELDS {
                found.push(format!("{} has {count} fields", head.trim()));
            }
        }
        found
    });
}

#[test]
fn the_methods_of_a_type_are_in_at_most_three_files() {
    let mut files: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (path, text) in sources() {
        let Some(own) = module(&path) else { continue };
        for line in code(&text).lines().filter(|line| line.starts_with("impl") && !line.contains(" for ")) {
            let line = line.trim_start_matches("impl");
            let line = if line.starts_with('<') { line.split_once("> ").map_or("", |(_, rest)| rest) } else { line };
            let name: String = line.trim().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
            let of = files.entry(format!("{}::{name}", MODULES[own])).or_default();
            let file = path.display().to_string();
            if !of.contains(&file) {
                of.push(file);
            }
        }
    }
    let allowed: BTreeMap<&str, usize> = IMPL_EXCEPTIONS.into_iter().collect();
    let many: Vec<_> = files
        .iter()
        .filter(|(name, files)| files.len() > allowed.get(name.as_str()).copied().unwrap_or(IMPL_FILES))
        .map(|(name, files)| format!("{name}: {} files", files.len()))
        .collect();
    assert!(many.is_empty(), "\n{}", many.join("\n"));
}

/// Types with methods in more files. The list may only shrink.
const IMPL_EXCEPTIONS: [(&str, usize); 5] = [
    ("geometry::Shape", 6),
    ("preflight::PreflightContext", 13),
    ("scene::Scene", 4),
    ("simulation::Simulation", 5),
    ("system::System", 10),
];

#[test]
fn cited_keys_are_in_the_bibliography() {
    let bib = fs::read_to_string(home().join("docs/references.bib")).unwrap();
    findings(|_, text| {
        // A cited key is `@`, a name and a year.
        text.split('@')
            .skip(1)
            .map(|rest| rest.chars().take_while(|c| c.is_ascii_lowercase() || c.is_ascii_digit()).collect::<String>())
            .filter(|key| key.len() > 5 && key.chars().any(|c| c.is_ascii_digit()))
            .filter(|key| !bib.contains(&format!("{{{key},")))
            .map(|key| format!("cites {key}, which docs/references.bib does not have"))
            .collect()
    });
}

#[test]
fn the_documented_tree_equals_the_source_tree() {
    let page = fs::read_to_string(home().join("docs/explanation/architecture.md")).unwrap();
    let block = page.split("```text\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap_or("");
    let mut documented: Vec<String> =
        block.lines().filter_map(|line| line.split_whitespace().next()).map(str::to_string).collect();
    documented.retain(|name| name != "src/");
    documented.sort();
    let mut real: Vec<String> = fs::read_dir(home().join("src"))
        .unwrap()
        .flatten()
        .map(|entry| entry.file_name().into_string().unwrap() + if entry.path().is_dir() { "/" } else { "" })
        .collect();
    // A folder of submodules beside its file is one module.
    let files: Vec<String> = real.iter().filter(|name| name.ends_with(".rs")).cloned().collect();
    real.retain(|name| !name.ends_with('/') || !files.contains(&name.replace('/', ".rs")));
    real.sort();
    assert_eq!(documented, real, "the tree in docs/explanation/architecture.md");
}

/// Names that `text` declares: types, functions, fields, constants and modules.
fn declared(text: &str) -> Vec<String> {
    let text = code(text);
    let mut names = Vec::new();
    for word in ["struct ", "enum ", "trait ", "fn ", "mod ", "type ", "const "] {
        for rest in text.split(word).skip(1) {
            names.push(rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>());
        }
    }
    for line in text.lines() {
        let line = line.trim_start().trim_start_matches("pub ").trim_start_matches("pub(crate) ");
        let name: String = line.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
        if !name.is_empty() && line[name.len()..].starts_with(": ") && line.ends_with(',') {
            names.push(name);
        }
    }
    names.into_iter().map(|name| name.to_lowercase()).collect()
}

#[test]
fn names_that_the_glossary_replaced_do_not_come_back() {
    let mut uses: BTreeMap<&str, usize> = BTreeMap::new();
    for (_, text) in sources() {
        for name in declared(&text) {
            if let Some(banned) = BANNED.iter().find(|banned| name == **banned) {
                *uses.entry(banned).or_default() += 1;
            }
        }
    }
    let allowed = fs::read_to_string(home().join(REMAINING)).unwrap_or_default();
    let allowed: BTreeMap<&str, usize> =
        allowed.lines().filter_map(|line| line.split_once(' ')).map(|(name, n)| (name, n.parse().unwrap())).collect();
    let more: Vec<_> = uses.iter().filter(|(name, n)| **n > allowed.get(**name).copied().unwrap_or(0)).collect();
    assert!(more.is_empty(), "declared again: {more:?}");
    let fewer: Vec<_> = allowed.iter().filter(|(name, n)| uses.get(**name).copied().unwrap_or(0) < **n).collect();
    assert!(fewer.is_empty(), "fewer than in {REMAINING}, so lower the numbers there: {fewer:?}");
}
